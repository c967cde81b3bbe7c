/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "clouds.h"

#include <gsl/gsl_qrng.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>

#include "summation.h"

const char *clouds_name(enum clouds_kind kind)
{
    static const char *const names[] = {
#define KIND(name, key, text) key,
        CLOUDS_LIST(KIND)
#undef KIND
    };
    return names[kind];
}

/* One-sided: points with normal . x <= DISTANCE stay. */
static const double normal[3] = {0.8385, 0.4327, 0.3318};
static double cut(int dim, const double *x, double *length)
{
    double s = 0, n2 = 0;
    for (int a = 0; a < dim; a++) s += normal[a] * x[a], n2 += normal[a] * normal[a];
    *length = sqrt(n2);
    return s - 0.62 * *length;
}

/* Clustered: x = u + A u (u - 1), so that dx/du = 1 + A (2 u - 1) runs from 1 - A to 1 + A. */
#define CLUSTERED_A 0.75

static bool place(const struct clouds_settings *settings, const size_t *cell, const gsl_rng *rng,
                  const gsl_qrng *qrng, double *x, double *volume)
{
    const double spacing = 1 / (double)settings->side;
    double length;
    if (settings->kind == CLOUDS_SOBOL) gsl_qrng_get(qrng, x);
    for (int a = 0; a < settings->dim; a++) {
        *volume *= spacing;
        if (settings->kind == CLOUDS_SOBOL) continue;
        x[a] = ((double)cell[a] + 0.5) * spacing;
        if (settings->kind != CLOUDS_LATTICE)
            x[a] += settings->jitter * spacing * (2 * gsl_rng_uniform(rng) - 1);
        if (settings->kind == CLOUDS_CLUSTERED) {
            *volume *= 1 + CLUSTERED_A * (2 * x[a] - 1);
            x[a] += CLUSTERED_A * x[a] * (x[a] - 1);
        }
    }
    return settings->kind != CLOUDS_ONE_SIDED || cut(settings->dim, x, &length) <= 0;
}

enum status clouds_make(const struct clouds_settings *settings, struct clouds_cloud *out,
                        struct error *error)
{
    const int dim = settings->dim;
    size_t n = 1, kept = 0;
    for (int a = 0; a < dim; a++) n *= settings->side;
    *out = (struct clouds_cloud){.spacing = 1 / (double)settings->side};
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_qrng *qrng = gsl_qrng_alloc(gsl_qrng_sobol, (unsigned)dim);
    bool ok = rng && qrng;
    for (int a = 0; a < dim; a++) ok = (out->x[a] = malloc(n * sizeof(double))) && ok;
    ok = (out->volume = malloc(n * sizeof(double))) && ok;
    ok = (out->h = malloc(n * sizeof(double))) && ok;
    if (ok) gsl_rng_set(rng, settings->seed);
    for (unsigned long k = 0; ok && k < 64 + settings->seed;
         k++) { /* the first points are too regular */
        double skipped[3];
        gsl_qrng_get(qrng, skipped);
    }
    for (size_t i = 0; ok && i < n; i++) {
        const size_t cell[3] = {i % settings->side, i / settings->side % settings->side,
                                i / settings->side / settings->side};
        double x[3], volume = 1;
        if (!place(settings, cell, rng, qrng, x, &volume)) continue;
        for (int a = 0; a < dim; a++) out->x[a][kept] = x[a];
        out->volume[kept] = volume;
        out->h[kept] = settings->eta * pow(volume, 1. / dim);
        kept++;
    }
    if (qrng) gsl_qrng_free(qrng);
    if (rng) gsl_rng_free(rng);
    if (!ok) return error_set(error, STATUS_ENVIRONMENT, "no memory for a cloud of %zu points", n);
    out->cloud =
        (struct cloud){.points = {.dim = dim, .n = kept, .x = {out->x[0], out->x[1], out->x[2]}},
                       .volume = out->volume,
                       .h = out->h};
    return STATUS_OK;
}

void clouds_free(struct clouds_cloud *cloud)
{
    for (int a = 0; a < 3; a++) free(cloud->x[a]);
    free(cloud->volume), free(cloud->h);
    *cloud = (struct clouds_cloud){0};
}

enum status clouds_sum_volumes(const struct clouds_settings *settings, const struct kernel *kernel,
                               struct clouds_cloud *cloud, struct error *error)
{
    const size_t n = cloud->cloud.points.n;
    double *rho = malloc(n * sizeof *rho);
    if (!rho) return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu densities", n);
    /* the exact volume as mass: density 1 up to the kernel sum's error, and edges */
    const struct summation sum = {cloud->cloud.points, kernel, cloud->volume,
                                  settings->eta,       1e-12,  1};
    const enum status status = summation_solve(&sum, cloud->h, rho, error);
    for (size_t i = 0; !status && i < n; i++) cloud->volume[i] /= rho[i];
    free(rho);
    return status;
}

void clouds_transform(struct clouds_cloud *cloud, const double *rotation, const double *shift)
{
    const int dim = cloud->cloud.points.dim;
    for (size_t i = 0; i < cloud->cloud.points.n; i++) {
        double y[3] = {0};
        for (int a = 0; a < dim; a++)
            for (int b = 0; b < dim; b++) y[a] += rotation[a * dim + b] * cloud->x[b][i];
        for (int a = 0; a < dim; a++) cloud->x[a][i] = y[a] + shift[a];
    }
}

bool clouds_interior(const struct clouds_settings *settings, const struct clouds_cloud *cloud,
                     size_t i)
{
    double x[3], length;
    const double h = cloud->h[i];
    for (int a = 0; a < settings->dim; a++) {
        x[a] = cloud->x[a][i];
        if (!(x[a] >= h && x[a] <= 1 - h)) return false;
    }
    return settings->kind != CLOUDS_ONE_SIDED || -cut(settings->dim, x, &length) >= h * length;
}
