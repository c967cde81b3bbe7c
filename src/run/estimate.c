/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "estimate.h"

#include <math.h>

#include "allowance.h"
#include "gradient.h"
#include "integrator.h"
#include "memory.h"
#include "viscosity.h"
#include "width.h"

/* Memory of the program and its libraries that does not depend on n. */
static const double base = 7e6;

enum { START = 4 }; /* evaluations to find the initial smoothing lengths */

struct estimate estimate_size(const struct setup *setup)
{
    const double n = (double)setup->n;
    /* arrays of the snapshot in addition to the initial particles; in 2D and 3D the snapshot reuses
     * the memory of the neighbour lists, which is larger */
    const int kept = setup->dim == 1 ? 2 * setup->dim + 6 : 0;
    return (struct estimate){.memory = base + memory_bytes(setup) + 8 * n * kept};
}

/* CPU time per particle and step in ns, measured on a busy core of 3.7 GHz. */
static double step_ns(const struct setup *setup)
{
    const struct scheme *scheme = &setup->scheme;
    const double neighbours = width_neighbours(setup->dim, scheme->eta);
    const bool slopes = viscosity_needs_slope(scheme->viscosity) || scheme->balsara == BALSARA_ON;
    if (setup->dim == 1) return 5 + neighbours;
    double pair = 12; /* search, density, force */
    if (gradient_of[scheme->gradient].weight != WEIGHT_NONE) pair += 6;
    if (slopes) pair += 6;
    if (scheme->h_method == H_NEWTON) pair += 12;
    return 100 + pair * neighbours;
}

/* The smoothing length of a particle's initial density. */
static double width_at_start(const struct setup *setup, size_t i)
{
    return setup->scheme.eta * pow(setup->m[i] / setup->rho[i], 1. / setup->dim);
}

/* Largest ratio of signal speed to h, if all kinetic energy became heat. */
static double fastest(const struct setup *setup)
{
    const double g = setup->gamma;
    double mean[3] = {0}, rate = 0;
    for (int a = 0; a < setup->dim; a++)
        for (size_t i = 0; i < setup->n; i++) mean[a] += setup->v[a][i] / (double)setup->n;
    for (size_t i = 0; i < setup->n; i++) {
        double v2 = 0;
        for (int a = 0; a < setup->dim; a++)
            v2 += (setup->v[a][i] - mean[a]) * (setup->v[a][i] - mean[a]);
        const double sound = sqrt(g * (g - 1) * (setup->u[i] + 0.5 * v2));
        rate = fmax(rate, 2 * sound / width_at_start(setup, i));
    }
    return rate;
}

struct estimate estimate_run(const struct setup *setup)
{
    struct estimate estimate = estimate_size(setup);
    const double evaluations = setup->scheme.integrator->evaluations, n = (double)setup->n;
    if (setup->n == 0 || !setup->rho) return estimate;
    estimate.steps = ceil(setup->t_end * fastest(setup) / setup->scheme.cfl);
    estimate.cpu_s = 1e-9 * n * step_ns(setup) * (START + estimate.steps * fmax(1, evaluations));
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

enum status estimate_check_reach(const struct setup *setup, struct error *error)
{
    for (int a = 0; setup->dim > 1 && setup->rho && a < setup->dim; a++) {
        const double half = 0.5 * (setup->hi[a] - setup->lo[a]);
        for (size_t i = 0; setup->boundary[a] == BOUNDARY_PERIODIC && i < setup->n; i++)
            if (!(width_at_start(setup, i) <= half))
                return error_set(error, STATUS_BAD_INPUT,
                                 "particle %zu reaches as far as %g, beyond half the box (%g): "
                                 "more particles or a smaller eta are needed",
                                 i, width_at_start(setup, i), half);
    }
    return STATUS_OK;
}
