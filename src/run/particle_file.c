/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "particle_file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "initial.h"
#include "problem.h"

static const char *const positions[] = {"x", "y", "z"}, *const velocities[] = {"vx", "vy", "vz"};

/* Finds a column by name; NULL in a file without rows. Fails if there is no such column. */
static enum status find(const struct particle_file *file, const char *path, const char *name,
                        const double **column, struct error *error)
{
    const int k = csv_column(&file->csv, name);
    if (k >= 0) {
        *column = file->csv.values[k];
        return STATUS_OK;
    }
    return error_set(
        error, STATUS_BAD_INPUT,
        "%.200s:1: no column '%s': allowed: x[,y[,z]], vx[,vy[,vz]], m, u, in any order", path,
        name);
}

static enum status check_values(const struct particle_file *file, const char *path,
                                struct error *error)
{
    for (size_t i = 0; i < file->csv.rows; i++) {
        const bool heavy = file->m[i] > 0;
        if (heavy && file->u[i] > 0) continue;
        return error_set(error, STATUS_BAD_INPUT, "%.200s:%zu: %s = %g: allowed: above 0", path,
                         file->csv.line[i], heavy ? "u" : "m", heavy ? file->u[i] : file->m[i]);
    }
    return STATUS_OK;
}

static enum status check_inside(const struct particle_file *file, const char *path, int d,
                                double lo, double hi, struct error *error)
{
    for (size_t i = 0; i < file->csv.rows; i++)
        if (!(file->x[d][i] >= lo && file->x[d][i] <= hi))
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s:%zu: %s = %.9g: allowed: inside of the box, %.9g to %.9g",
                             path, file->csv.line[i], positions[d], file->x[d][i], lo, hi);
    return STATUS_OK;
}

static void name_ignored(struct particle_file *file, bool rho_is_read)
{
    size_t used = 0;
    file->ignored[0] = '\0';
    for (size_t k = 0; k < file->csv.columns; k++) {
        const double *values = file->csv.values[k];
        bool read = values == file->m || values == file->u || (rho_is_read && values == file->rho);
        for (int a = 0; a < file->dim; a++) read |= values == file->x[a] || values == file->v[a];
        if (read || used >= sizeof file->ignored) continue;
        used += (size_t)snprintf(file->ignored + used, sizeof file->ignored - used, "%s%s",
                                 used ? " " : "", file->csv.names[k]);
    }
}

enum status particle_file_read(const char *path, struct particle_file *file, struct error *error)
{
    *file = (struct particle_file){0};
    if (csv_read(path, &file->csv, error)) return error->status;
    return particle_file_of(path, file, error);
}

enum status particle_file_of(const char *path, struct particle_file *file, struct error *error)
{
    file->dim = csv_column(&file->csv, "z") >= 0 || csv_column(&file->csv, "vz") >= 0   ? 3
                : csv_column(&file->csv, "y") >= 0 || csv_column(&file->csv, "vy") >= 0 ? 2
                                                                                        : 1;
    for (int a = 0; a < file->dim; a++)
        if (find(file, path, positions[a], &file->x[a], error) ||
            find(file, path, velocities[a], &file->v[a], error))
            return error->status;
    if (find(file, path, "m", &file->m, error) || find(file, path, "u", &file->u, error))
        return error->status;
    if (file->csv.rows < 2)
        return error_set(error, STATUS_BAD_INPUT, "%.200s: %zu particles: allowed: 2 or more", path,
                         file->csv.rows);
    const int rho = csv_column(&file->csv, "rho");
    file->rho = rho >= 0 ? file->csv.values[rho] : NULL;
    name_ignored(file, false);
    return check_values(file, path, error);
}

void particle_file_free(struct particle_file *file)
{
    csv_free(&file->csv);
}

/* Sets a box slightly larger than the extent of the particles. */
static void surround(const struct particle_file *file, int a, struct setup *setup)
{
    double lo = (double)INFINITY, hi = -(double)INFINITY;
    for (size_t i = 0; i < file->csv.rows; i++) {
        lo = fmin(lo, file->x[a][i]);
        hi = fmax(hi, file->x[a][i]);
    }
    const double margin = hi > lo ? 0.01 * (hi - lo) : 1;
    setup->lo[a] = lo - margin;
    setup->hi[a] = hi + margin;
}

enum status particle_file_fill(const struct particle_file *file, const char *path,
                               struct setup *setup, struct error *error)
{
    setup->dim = file->dim;
    setup->n = file->csv.rows;
    setup->m = file->m;
    setup->u = file->u;
    for (int a = 0; a < file->dim; a++) {
        setup->x[a] = file->x[a];
        setup->v[a] = file->v[a];
        if (setup->boundary[a] == BOUNDARY_OPEN && setup->lo[a] == setup->hi[a])
            surround(file, a, setup);
        if (check_inside(file, path, a, setup->lo[a], setup->hi[a], error)) return error->status;
    }
    return STATUS_OK;
}

/* ---- initial state of a run ---- */

/* Particles must be inside the box, except along open directions. */
static enum status check_positions(const struct particle_file *file, const char *path,
                                   const struct prepared *p, struct error *error)
{
    const int dim = p->domain.dim;
    if (file->dim != dim)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s:1: particles in %dD, but the case has dimension = %d", path,
                         file->dim, dim);
    for (int d = 0; d < dim; d++) {
        if (p->boundary[d] == BOUNDARY_FIXED && !file->rho)
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s:1: no column 'rho': boundary=fixed keeps particles at their "
                             "density",
                             path);
        if (p->boundary[d] != BOUNDARY_OPEN &&
            check_inside(file, path, d, p->domain.lo[d], p->domain.hi[d], error))
            return error->status;
    }
    for (size_t i = 0; file->rho && i < file->csv.rows; i++)
        if (!(file->rho[i] > 0))
            return error_set(error, STATUS_BAD_INPUT, "%.200s:%zu: rho = %g: allowed: above 0",
                             path, file->csv.line[i], file->rho[i]);
    return STATUS_OK;
}

/* Initial guesses of densities from the problem, the file, or the mean. The solver finds smoothing
 * lengths from these. */
static void guess_densities(const struct particle_file *file, const struct prepared *p,
                            struct initial *initial)
{
    double mass = 0;
    for (size_t i = 0; i < initial->n; i++) mass += initial->m[i];
    for (size_t i = 0; i < initial->n; i++) {
        struct problem_state state;
        double x[3] = {0};
        for (int d = 0; d < p->domain.dim; d++) x[d] = initial->x[d][i];
        problem_sample_start(p, x, &state);
        initial->rho[i] = state.rho > 0 ? state.rho
                          : file->rho   ? file->rho[i]
                                        : mass / domain_volume(&p->domain);
    }
}

enum status particle_file_start(const char *path, const struct prepared *p, struct initial *initial,
                                struct error *error)
{
    struct particle_file file;
    enum status status = particle_file_read(path, &file, error);
    if (!status) status = check_positions(&file, path, p, error);
    if (!status) status = initial_allocate(initial, file.dim, file.csv.rows, error);
    if (!status) {
        const size_t bytes = initial->n * sizeof(double);
        for (int d = 0; d < file.dim; d++) {
            memcpy(initial->x[d], file.x[d], bytes);
            memcpy(initial->v[d], file.v[d], bytes);
        }
        memcpy(initial->m, file.m, bytes);
        memcpy(initial->u, file.u, bytes);
        guess_densities(&file, p, initial);
        name_ignored(&file, true);
        snprintf(initial->ignored, sizeof initial->ignored, "%s", file.ignored);
    }
    particle_file_free(&file);
    return status;
}
