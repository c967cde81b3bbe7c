/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "estimate.h"

#include <math.h>

#include "allowance.h"
#include "integrator.h"
#include "memory.h"
#include "width.h"

/* The program with its libraries, and what does not grow with n. */
static const double base = 1.2e7;

enum { START = 4 }; /* evaluations: the first widths are looked for */

struct estimate estimate_size(const struct scene *scene)
{
    const double n = (double)scene->n;
    /* arrays of the snapshot, more than particles start with; in 2D and 3D the solver gives them
     * the memory of the neighbours, of which there is more */
    const int kept = scene->dim == 1 ? 2 * scene->dim + 6 : 0;
    return (struct estimate){.memory = base + memory_bytes(scene) + 8 * n * kept};
}

/* CPU time of a particle's part in a step, ns: measured on one core of 3.7 GHz, which was busy. */
static double step_ns(const struct scene *scene)
{
    const struct scheme *scheme = &scene->scheme;
    const double neighbours = width_neighbours(scene->dim, scheme->eta);
    const bool slopes =
        scheme->viscosity == VISCOSITY_RECONSTRUCTED || scheme->viscosity == VISCOSITY_PROJECTED ||
        scheme->viscosity == VISCOSITY_CULLEN_DEHNEN || scheme->balsara == BALSARA_ON;
    if (scene->dim == 1) return 5 + neighbours;
    double pair = 12; /* search, density, force */
    if (scheme->gradient != GRADIENT_STANDARD) pair += 6;
    if (slopes) pair += 6;
    if (scheme->h_method == H_NEWTON) pair += 12;
    return 100 + pair * neighbours;
}

/* 1/s: signal speed over h, the largest. */
static double fastest(const struct scene *scene)
{
    const double g = scene->gamma, d = scene->dim;
    double mean[3] = {0}, rate = 0;
    for (int a = 0; a < scene->dim; a++)
        for (size_t i = 0; i < scene->n; i++) mean[a] += scene->v[a][i] / (double)scene->n;
    for (size_t i = 0; i < scene->n; i++) {
        double v2 = 0;
        for (int a = 0; a < scene->dim; a++)
            v2 += (scene->v[a][i] - mean[a]) * (scene->v[a][i] - mean[a]);
        const double sound = sqrt(g * (g - 1) * (scene->u[i] + 0.5 * v2));
        const double h = scene->scheme.eta * pow(scene->m[i] / scene->rho[i], 1 / d);
        rate = fmax(rate, 2 * sound / h);
    }
    return rate;
}

struct estimate estimate_run(const struct scene *scene)
{
    struct estimate estimate = estimate_size(scene);
    const double evaluations = scene->scheme.integrator->evaluations, n = (double)scene->n;
    if (scene->n == 0 || !scene->rho) return estimate;
    estimate.steps = ceil(scene->t_end * fastest(scene) / scene->scheme.cfl);
    estimate.cpu_s = 1e-9 * n * step_ns(scene) * (START + estimate.steps * fmax(1, evaluations));
    return estimate;
}

enum status estimate_check(const struct estimate *estimate, size_t n, struct error *error)
{
    const double there = allowance_memory("");
    if (estimate->memory <= there) return STATUS_OK;
    return error_set(error, STATUS_ENVIRONMENT,
                     "n=%zu takes about %.3g GB of memory, more than the %.3g GB that there are", n,
                     1e-9 * estimate->memory, 1e-9 * there);
}
