/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "lattice_waves.h"

#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_eigen.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "rate_table.h"

/* A displacement in spacings: differences of forces lose 1e-12/STEP to round-off and STEP^2 to
 * nonlinearity. */
static const double step = 1e-5;

enum status lattice_waves_begin(struct lattice_waves *lattice, const struct run_settings *settings,
                                struct error *error)
{
    *lattice = (struct lattice_waves){.dim = settings->file.dimension};
    if (run_resolve(&lattice->run, settings, error) ||
        initial_create(&lattice->at_rest, &lattice->run.problem, &lattice->run.settings, error))
        return error->status;
    const struct scheme *scheme = &lattice->run.scheme;
    if (scheme->viscosity != VISCOSITY_NONE || scheme->energy != ENERGY_INTERNAL)
        return error_set(error, STATUS_BAD_INPUT,
                         "waves of a lattice are known without viscosity, for energy = internal");
    double volume = 1;
    for (int d = 0; d < lattice->dim; d++) volume *= domain_length(&lattice->run.problem.domain, d);
    const double gamma = lattice->run.problem.gamma;
    lattice->spacing = pow(volume / (double)lattice->at_rest.n, 1. / lattice->dim);
    lattice->c = sqrt(gamma * (gamma - 1) * lattice->at_rest.u[0]);
    return STATUS_OK;
}

void lattice_waves_free(struct lattice_waves *lattice)
{
    initial_free(&lattice->at_rest);
}

/* Evaluates a copy of the lattice, displaced along `axis` by `shift` times the wave, moving with
 * `speed` times the wave, and with internal energies changed by `heat` times the power of that
 * motion. wave: n values; power: n, or NULL. */
struct disturbed {
    int axis;
    double shift, speed, heat;
    const double *wave, *power;
};

static enum status evaluate(const struct lattice_waves *lattice, const struct disturbed *by,
                            struct rate_table *table, struct error *error)
{
    const struct initial *from = &lattice->at_rest;
    const struct domain *domain = &lattice->run.problem.domain;
    const size_t n = from->n;
    double *arrays = calloc(3 * n, sizeof *arrays);
    if (!arrays) return error_set(error, STATUS_ENVIRONMENT, "no memory for a lattice");
    double *x = arrays, *v = x + n, *u = v + n;
    const double lo = domain->lo[by->axis], length = domain_length(domain, by->axis);
    for (size_t i = 0; i < n; i++) {
        x[i] = from->x[by->axis][i] + by->shift * by->wave[i];
        x[i] -= length * floor((x[i] - lo) / length);
        v[i] = by->speed * by->wave[i];
        u[i] = from->u[i] + (by->power ? by->heat * by->power[i] / from->m[i] : 0);
    }
    struct setup setup = run_setup(&lattice->run, from);
    setup.x[by->axis] = x;
    setup.v[by->axis] = v;
    setup.u = u;
    const enum status status = rate_table_make(table, &setup, error);
    free(arrays);
    return status;
}

/* The column of D for displacements along `axis`. */
static enum status column(const struct lattice_waves *lattice, const double *wave, int axis,
                          double D[3], struct error *error)
{
    const size_t n = lattice->at_rest.n;
    const double shift = step * lattice->spacing;
    struct rate_table moving = {0}, ahead = {0}, back = {0};
    struct disturbed by = {.axis = axis, .speed = shift, .wave = wave};
    double square = 0;
    enum status status = evaluate(lattice, &by, &moving, error);
    by = (struct disturbed){axis, shift, 0, 1, wave, moving.dU};
    if (!status) status = evaluate(lattice, &by, &ahead, error);
    by.shift = -shift;
    by.heat = -1;
    if (!status) status = evaluate(lattice, &by, &back, error);
    for (int a = 0; a < 3; a++) D[a] = 0;
    for (size_t i = 0; i < n && !status; i++) {
        square += wave[i] * wave[i];
        for (int a = 0; a < lattice->dim; a++)
            D[a] -= wave[i] * (ahead.force[a][i] - back.force[a][i]) /
                    (2 * shift * lattice->at_rest.m[i]);
    }
    for (int a = 0; a < 3 && square > 0; a++) D[a] /= square;
    rate_table_free(&moving);
    rate_table_free(&ahead);
    rate_table_free(&back);
    return status;
}

/* omega^2 -> growth and frequency, in c/spacing. */
static enum status solve(const struct lattice_waves *lattice, double D[3][3],
                         struct lattice_wave *wave, struct error *error)
{
    const size_t dim = (size_t)lattice->dim;
    const double unit = lattice->c / lattice->spacing;
    double entries[9];
    for (size_t a = 0; a < dim; a++)
        for (size_t b = 0; b < dim; b++) entries[a * dim + b] = D[b][a] / (unit * unit);
    gsl_matrix_view matrix = gsl_matrix_view_array(entries, dim, dim);
    gsl_vector_complex *values = gsl_vector_complex_alloc(dim);
    gsl_eigen_nonsymm_workspace *workspace = gsl_eigen_nonsymm_alloc(dim);
    enum status status =
        values && workspace && !gsl_eigen_nonsymm(&matrix.matrix, values, workspace)
            ? STATUS_OK
            : error_set(error, STATUS_ENVIRONMENT, "no eigenvalues of a wave");
    *wave = (struct lattice_wave){0};
    for (size_t k = 0; k < dim && !status; k++) {
        const gsl_complex omega = gsl_complex_sqrt(gsl_vector_complex_get(values, k));
        wave->growth = fmax(wave->growth, fabs(GSL_IMAG(omega)));
        wave->frequency = fmax(wave->frequency, fabs(GSL_REAL(omega)));
    }
    if (values) gsl_vector_complex_free(values);
    if (workspace) gsl_eigen_nonsymm_free(workspace);
    return status;
}

enum status lattice_waves_at(const struct lattice_waves *lattice, const int whole[3],
                             struct lattice_wave *wave, struct error *error)
{
    const struct domain *domain = &lattice->run.problem.domain;
    const size_t n = lattice->at_rest.n;
    double D[3][3] = {{0}}, *shape = calloc(n, sizeof *shape);
    enum status status = STATUS_OK;
    if (!shape) return error_set(error, STATUS_ENVIRONMENT, "no memory for a wave");
    for (size_t i = 0; i < n; i++) {
        double phase = 0;
        for (int d = 0; d < lattice->dim; d++)
            phase += 2 * M_PI * whole[d] * (lattice->at_rest.x[d][i] - lattice->at_rest.x[d][0]) /
                     domain_length(domain, d);
        shape[i] = cos(phase);
    }
    for (int axis = 0; axis < lattice->dim && !status; axis++)
        status = column(lattice, shape, axis, D[axis], error);
    if (!status) status = solve(lattice, D, wave, error);
    free(shape);
    return status;
}

enum status lattice_waves_worst(const struct lattice_waves *lattice, struct lattice_wave *worst,
                                int where[3], struct error *error)
{
    const int kind = settings_choice(&lattice->run.settings, SETTING_lattice);
    const struct domain *domain = &lattice->run.problem.domain;
    const bool even = kind == LATTICE_SQUARE || kind == LATTICE_CUBIC;
    const bool symmetric = even || kind == LATTICE_FCC || kind == LATTICE_BCC;
    int most[3] = {0};
    for (int d = 0; d < lattice->dim; d++) {
        const double rows = domain_length(domain, d) / lattice->spacing;
        most[d] = (int)ceil(even ? rows / 2 - 1e-9 : rows);
    }
    *worst = (struct lattice_wave){0};
    for (int i = 0; i <= most[0]; i++)
        for (int j = 0; j <= (symmetric ? i : most[1]); j++)
            for (int k = 0; k <= (lattice->dim < 3 ? 0 : symmetric ? j : most[2]); k++) {
                const int whole[3] = {i, j, k};
                struct lattice_wave wave;
                if (!i && !j && !k) continue;
                if (lattice_waves_at(lattice, whole, &wave, error)) return error->status;
                worst->frequency = fmax(worst->frequency, wave.frequency);
                if (!(wave.growth > worst->growth)) continue;
                worst->growth = wave.growth;
                memcpy(where, whole, sizeof whole);
            }
    return STATUS_OK;
}
