/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "slab.h"

#include <math.h>

#include "problem_prepare.h"
#include "text.h"

enum { LAYERS_MAX = 10000 };

int slab_layers(const char *text)
{
    double number = 0;
    const bool sound =
        text_real(text, &number) && number == floor(number) && number >= 1 && number <= LAYERS_MAX;
    return sound ? (int)number : 0;
}

enum status slab_ask(struct run_settings *asked, const char *layers, const char *where,
                     struct error *error)
{
    if (!slab_layers(layers))
        return error_set(error, STATUS_BAD_INPUT,
                         "%.300s '%.40s': allowed: a number of layers, 1 to %d", where, layers,
                         LAYERS_MAX);
    if (asked->file.dimension != 2)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.300s %s: the case %.60s is in %dD; allowed: cases in 2D", where, layers,
                         asked->file.name, asked->file.dimension);
    asked->layers = slab_layers(layers);
    return STATUS_OK;
}

/* Layers must be thicker than twice the largest support radius, that of a cube with the area of the
 * largest particle and the height of a layer; equality would leave the decision to round-off. At
 * jumps of density some particles reach slightly further, and the neighbour search refuses them. */
static enum status check_reach(const struct initial *plane, int layers, double apart,
                               const struct scheme *scheme, struct error *error)
{
    double largest = 0;
    for (size_t i = 0; i < plane->n; i++)
        largest = fmax(largest, cbrt(plane->m[i] / plane->rho[i] * apart));
    const double least = floor(2 * scheme->eta * largest / apart * (1 + 1e-9)) + 1;
    if (layers >= least) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "%d layers are %g thick, no more than twice the largest smoothing length, %g: "
                     "at least %.0f layers or a smaller eta are needed",
                     layers, layers * apart, scheme->eta * largest, least);
}

static enum status stack(struct initial *initial, int layers, double lo, double apart,
                         struct error *error)
{
    struct initial slab;
    const size_t n = initial->n;
    if (initial_allocate(&slab, 3, n * (size_t)layers, error)) return error->status;
    for (size_t k = 0; k < slab.n; k++) {
        const size_t i = k % n;
        for (int d = 0; d < 2; d++)
            slab.x[d][k] = initial->x[d][i], slab.v[d][k] = initial->v[d][i];
        slab.x[2][k] = lo + apart * ((double)(k / n) + 0.5);
        slab.v[2][k] = 0;
        slab.m[k] = apart * initial->m[i];
        slab.u[k] = initial->u[i];
        slab.rho[k] = initial->rho[i];
    }
    initial_free(initial);
    *initial = slab;
    return STATUS_OK;
}

enum status slab_lay(struct run *run, struct initial *initial, struct error *error)
{
    struct domain *box = &run->problem.domain;
    const int layers = run->asked.layers;
    const double area = domain_length(box, 0) * domain_length(box, 1);
    const double apart = sqrt(area / (double)initial->n);
    struct settings settings = run->asked.settings; /* automatic values differ in 3D */
    struct prepared plane;
    if (problem_prepare(&plane, &settings, 2, error) ||
        settings_scheme(&settings, 3, &run->scheme, error) ||
        check_reach(initial, layers, apart, &run->scheme, error))
        return error->status;
    box->dim = run->problem.window.dim = 3;
    box->lo[2] = 0;
    box->hi[2] = apart * layers;
    run->problem.boundary[2] = BOUNDARY_PERIODIC;
    return stack(initial, layers, box->lo[2], apart, error);
}
