/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "particle_file.h"

#include <stdio.h>
#include <string.h>

static const char *const places[] = {"x", "y", "z"}, *const velocities[] = {"vx", "vy", "vz"};

/* The column of that name; NULL and an error where there is none. */
static const double *find(const struct particle_file *file, const char *path, const char *name,
                          struct error *error)
{
    const int k = csv_column(&file->csv, name);
    if (k >= 0) return file->csv.values[k];
    error_set(error, STATUS_BAD_INPUT,
              "%.200s:1: no column '%s': allowed: x[,y[,z]], vx[,vy[,vz]], m, u, in any order",
              path, name);
    return NULL;
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

static void name_ignored(struct particle_file *file)
{
    size_t used = 0;
    for (size_t k = 0; k < file->csv.columns; k++) {
        const double *values = file->csv.values[k];
        bool read = values == file->m || values == file->u;
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
    file->dim = csv_column(&file->csv, "z") >= 0 || csv_column(&file->csv, "vz") >= 0   ? 3
                : csv_column(&file->csv, "y") >= 0 || csv_column(&file->csv, "vy") >= 0 ? 2
                                                                                        : 1;
    for (int a = 0; a < file->dim; a++)
        if (!(file->x[a] = find(file, path, places[a], error)) ||
            !(file->v[a] = find(file, path, velocities[a], error)))
            return error->status;
    if (!(file->m = find(file, path, "m", error)) || !(file->u = find(file, path, "u", error)))
        return error->status;
    if (file->csv.rows < 2)
        return error_set(error, STATUS_BAD_INPUT, "%.200s: %zu particles: allowed: 2 or more", path,
                         file->csv.rows);
    name_ignored(file);
    return check_values(file, path, error);
}

void particle_file_free(struct particle_file *file)
{
    csv_free(&file->csv);
}

/* A box around the particles, a little wider. */
static void surround(const struct particle_file *file, int a, struct scene *scene)
{
    double lo = file->x[a][0], hi = lo;
    for (size_t i = 1; i < file->csv.rows; i++) {
        lo = file->x[a][i] < lo ? file->x[a][i] : lo;
        hi = file->x[a][i] > hi ? file->x[a][i] : hi;
    }
    const double margin = hi > lo ? 0.01 * (hi - lo) : 1;
    scene->lo[a] = lo - margin;
    scene->hi[a] = hi + margin;
}

enum status particle_file_fill(const struct particle_file *file, const char *path,
                               struct scene *scene, struct error *error)
{
    scene->dim = file->dim;
    scene->n = file->csv.rows;
    scene->m = file->m;
    scene->u = file->u;
    for (int a = 0; a < file->dim; a++) {
        scene->x[a] = file->x[a];
        scene->v[a] = file->v[a];
        if (scene->boundary[a] == BOUNDARY_OPEN && scene->lo[a] == scene->hi[a])
            surround(file, a, scene);
        for (size_t i = 0; i < scene->n; i++)
            if (!(scene->x[a][i] >= scene->lo[a] && scene->x[a][i] <= scene->hi[a]))
                return error_set(error, STATUS_BAD_INPUT,
                                 "%.200s:%zu: %s = %.9g: allowed: inside of the box, %.9g to %.9g",
                                 path, file->csv.line[i], places[a], scene->x[a][i], scene->lo[a],
                                 scene->hi[a]);
    }
    return STATUS_OK;
}
