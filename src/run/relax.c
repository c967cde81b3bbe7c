/* SPDX-License-Identifier: GPL-3.0-or-later
 * Repels each point from those within `reach` times the mean of their spacings, more strongly the
 * nearer they are. A point moves by a fraction of its spacing that decreases with each sweep. The
 * force is that of Diehl et al. 2015, modified to vanish at its reach. */
#include "relax.h"

#include <math.h>
#include <stdlib.h>

#include "cache.h"
#include "grid.h"
#include "kernel.h"

enum { SWEEPS = 60 };
static const double reach = 2.5;                      /* spacings */
static const double first_step = 0.06, fading = 0.95; /* spacings per force; per sweep */
static const double longest = 0.3;                    /* in spacings per sweep */
static const double judge_eta = 3.6;

/* Points and their smoothing lengths. */
struct cloud {
    int dim;
    size_t n;
    double *const *x;
    double *width; /* n: radius of the sums */
    double *to[3]; /* n each: sums over neighbours of force times direction */
    double *storage;
    struct grid *grid;
    struct grid_reader reader;
};

static enum status cloud_make(struct cloud *cloud, const struct domain *box, size_t n,
                              double *const x[3], struct error *error)
{
    struct grid_box periodic = {.dim = box->dim};
    for (int d = 0; d < box->dim; d++) {
        periodic.lo[d] = box->lo[d];
        periodic.hi[d] = box->hi[d];
        periodic.periodic[d] = true;
    }
    *cloud = (struct cloud){.dim = box->dim, .n = n, .x = x};
    cloud->storage = malloc(4 * n * sizeof(double));
    cloud->grid = grid_create(&periodic, n, 1);
    if (!cloud->storage || !cloud->grid)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for a glass of %zu points", n);
    cloud->width = cloud->storage;
    for (int d = 0; d < 3; d++) cloud->to[d] = cloud->storage + (size_t)(d + 1) * n;
    return STATUS_OK;
}

static void cloud_free(struct cloud *cloud)
{
    grid_destroy(cloud->grid);
    grid_reader_free(&cloud->reader);
    free(cloud->storage);
}

static enum status find(struct cloud *cloud, struct error *error)
{
    const double *const x[3] = {cloud->x[0], cloud->x[1], cloud->x[2]};
    struct error reason = {0};
    if (!grid_search(cloud->grid, cloud->n, cloud->n, x, cloud->width, NULL, &reason)) {
        if (grid_reader_reserve(cloud->grid, &cloud->reader)) return STATUS_OK;
        return error_set(error, STATUS_ENVIRONMENT, "no memory for a glass of %zu points",
                         cloud->n);
    }
    if (reason.status != STATUS_BAD_INPUT) {
        *error = reason;
        return reason.status;
    }
    return error_set(error, STATUS_BAD_INPUT,
                     "n=%zu: a glass needs more particles across the box: the neighbours of one "
                     "would reach beyond half of it",
                     cloud->n);
}

/* Vector to the point of a slot from the nearest image of another point. */
static double step_to(const struct cloud *cloud, size_t slot, int32_t other, double delta[3])
{
    const double(*position)[3] = grid_positions(cloud->grid);
    double square = 0;
    for (int d = 0; d < cloud->dim; d++) {
        const double side = grid_side(cloud->grid, d);
        delta[d] = position[slot][d] - position[other][d];
        delta[d] -= side * round(delta[d] / side);
        square += delta[d] * delta[d];
    }
    return sqrt(square);
}

/* Repulsion: 0 for q >= 1, about 3 between neighbours. */
static double push(double q)
{
    const double soft = 0.1, edge = 1 / ((1 + soft) * (1 + soft));
    return q < 1 ? 1 / ((q + soft) * (q + soft)) - edge : 0;
}

static void add_pushes(struct cloud *cloud)
{
    const struct grid_list *lists = grid_lists(cloud->grid);
    const uint32_t *order = grid_order(cloud->grid);
    for (size_t slot = 0; slot < cloud->n; slot++) {
        const uint32_t i = order[slot];
        const int32_t *slots = grid_neighbours(cloud->grid, &cloud->reader, lists, slot);
        double sum[3] = {0};
        for (int32_t k = 0; k < lists[slot].count; k++) {
            const int32_t other = slots[k];
            double delta[3];
            const double r = step_to(cloud, slot, other, delta);
            const double width = 0.5 * (cloud->width[i] + cloud->width[order[other]]);
            const double part = r > 0 ? push(r / width) / r : 0;
            for (int d = 0; d < cloud->dim; d++) sum[d] += part * delta[d];
        }
        for (int d = 0; d < cloud->dim; d++) cloud->to[d][i] = sum[d];
    }
}

static void move(struct cloud *cloud, const struct domain *box, double step)
{
    for (size_t i = 0; i < cloud->n; i++) {
        const double spacing = cloud->width[i] / reach;
        double size = 0;
        for (int d = 0; d < cloud->dim; d++) size += cloud->to[d][i] * cloud->to[d][i];
        const double part = spacing * fmin(step, longest / fmax(sqrt(size), 1e-300));
        for (int d = 0; d < cloud->dim; d++) {
            const double to = domain_wrap(box, d, cloud->x[d][i] + part * cloud->to[d][i]);
            cloud->x[d][i] = fmin(to, nextafter(box->hi[d], box->lo[d]));
        }
    }
}

static double root(double volume, int dim)
{
    return dim == 2 ? sqrt(volume) : cbrt(volume);
}

/* Hash of everything that determines the result: the box, the initial positions, and the volumes
 * there, which stand for the whole volume function. */
static uint64_t content_of(const struct relax_region *region, size_t n, double *const x[3])
{
    const size_t dim = (size_t)region->box.dim;
    uint64_t hash = cache_hash(CACHE_HASH, region->box.lo, dim * sizeof(double));
    hash = cache_hash(hash, region->box.hi, dim * sizeof(double));
    for (size_t d = 0; d < dim; d++) hash = cache_hash(hash, x[d], n * sizeof(double));
    for (size_t i = 0; i < n; i++) {
        double at[3] = {0};
        for (size_t d = 0; d < dim; d++) at[d] = x[d][i];
        const double volume = region->volume(region->context, at);
        hash = cache_hash(hash, &volume, sizeof volume);
    }
    return hash;
}

static enum status relax(const struct relax_region *region, size_t n, double *const x[3],
                         struct error *error)
{
    struct cloud cloud;
    const int dim = region->box.dim;
    double step = first_step;
    enum status status = cloud_make(&cloud, &region->box, n, x, error);
    for (int sweep = 0; !status && sweep < SWEEPS; sweep++, step *= fading) {
        for (size_t i = 0; i < n; i++) {
            double at[3] = {0};
            for (int d = 0; d < dim; d++) at[d] = x[d][i];
            cloud.width[i] = reach * root(region->volume(region->context, at), dim);
        }
        if ((status = find(&cloud, error))) break;
        add_pushes(&cloud);
        move(&cloud, &region->box, step);
    }
    cloud_free(&cloud);
    return status;
}

enum status relax_points(const struct relax_region *region, size_t n, double *const x[3],
                         struct error *error)
{
    const uint64_t content = content_of(region, n, x);
    if (relax_store_find(content, region->box.dim, n, x)) return STATUS_OK;
    const enum status status = relax(region, n, x, error);
    if (!status) relax_store_keep(content, region->box.dim, n, x);
    return status;
}

enum status relax_measure(const struct domain *box, size_t n, const double *const x[3],
                          const double *volume, struct regularity *quality, struct error *error)
{
    struct kernel kernel;
    double *width = malloc(n * sizeof *width);
    if (!width) return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu points", n);
    for (size_t i = 0; i < n; i++) width[i] = judge_eta * root(volume[i], box->dim);
    const struct regularity_cloud cloud = {.box = *box,
                                           .periodic = {true, true, true},
                                           .n = n,
                                           .x = {x[0], x[1], x[2]},
                                           .volume = volume,
                                           .h = width,
                                           .kernel = &kernel};
    enum status status = kernel_select(&kernel, "wendland_c4", 0, error);
    if (!status) status = regularity_measure(&cloud, quality, error);
    free(width);
    return status;
}
