/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "regularity.h"

#include <math.h>
#include <stdlib.h>

#include "grid.h"
#include "shapes.h"

/* Sums over the points so far. The mean distance to the nearest neighbour and the sum of squared
 * deviations are updated point by point (Welford 1962), because on a lattice the mean square minus
 * the squared mean is mere round-off. */
struct sums {
    const struct regularity_cloud *cloud;
    struct shapes shapes;
    size_t points, whole; /* whole: points whose support lies in the box */
    double distance, squares, density, gradient;
    size_t paired;
};

/* One point and the sums over its neighbours so far. */
struct point {
    size_t i;
    double nearest, sum, to[3];
};

/* A batch of neighbours of one point: the vectors from the nearest image of each to the point, and
 * the volumes. */
enum { PART = 64 };

struct part {
    size_t count;
    double delta[3][PART], volume[PART];
};

static struct point sums_of_point(const struct regularity_cloud *cloud, size_t i, double widest)
{
    const double self = kernel_value(cloud->kernel, 0, cloud->h[i], cloud->box.dim);
    return (struct point){.i = i, .nearest = widest, .sum = cloud->volume[i] * self};
}

static void add_pairs(const struct sums *sums, struct point *point, const struct part *part)
{
    const struct regularity_cloud *cloud = sums->cloud;
    const struct kernel *kernel = cloud->kernel;
    const int dim = cloud->box.dim;
    const double h = cloud->h[point->i], constant = kernel->constant[dim],
                 volume = dim == 1   ? h
                          : dim == 2 ? h * h
                                     : h * h * h;
    double r[PART], q[PART], w[PART], dw[PART];
    for (size_t k = 0; k < part->count; k++) {
        double square = 0;
        for (int d = 0; d < dim; d++) square += part->delta[d][k] * part->delta[d][k];
        r[k] = sqrt(square);
        q[k] = r[k] / h;
        if (r[k] < point->nearest) point->nearest = r[k];
    }
    sums->shapes.w(kernel, part->count, q, w);
    sums->shapes.dw(kernel, part->count, q, dw);
    for (size_t k = 0; k < part->count; k++) {
        if (!(r[k] < h)) continue;
        const double V = part->volume[k] * (constant / volume),
                     slope = r[k] > 0 ? V * dw[k] / r[k] : 0;
        point->sum += V * w[k];
        for (int d = 0; d < dim; d++) point->to[d] += slope * part->delta[d][k];
    }
}

static bool is_whole(const struct regularity_cloud *cloud, size_t i)
{
    for (int d = 0; d < cloud->box.dim; d++)
        if (!cloud->periodic[d] && !(cloud->x[d][i] - cloud->box.lo[d] >= cloud->h[i] &&
                                     cloud->box.hi[d] - cloud->x[d][i] >= cloud->h[i]))
            return false;
    return true;
}

static void add_point(struct sums *sums, const struct point *point)
{
    const struct regularity_cloud *cloud = sums->cloud;
    const int dim = cloud->box.dim;
    const double distance = point->nearest / pow(cloud->volume[point->i], 1. / dim);
    const double off = distance - sums->distance;
    sums->distance += off / (double)++sums->points;
    sums->squares += off * (distance - sums->distance);
    sums->paired += distance < 0.5;
    if (!is_whole(cloud, point->i)) return;
    sums->whole++;
    sums->density += (point->sum - 1) * (point->sum - 1);
    for (int d = 0; d < dim; d++) sums->gradient += point->to[d] * point->to[d];
}

/* ---- neighbours in 2D and 3D ---- */

static struct point sums_of_slot(const struct sums *sums, const struct grid *grid,
                                 struct grid_reader *reader, size_t slot, double widest)
{
    const struct regularity_cloud *cloud = sums->cloud;
    const struct grid_list *lists = grid_lists(grid);
    const int32_t count = lists[slot].count, *slots = grid_neighbours(grid, reader, lists, slot);
    const double(*position)[3] = grid_positions(grid);
    const uint32_t *order = grid_order(grid);
    double side[3];
    for (int d = 0; d < cloud->box.dim; d++)
        side[d] = lists[slot].wrapped && grid_side(grid, d) > 0 ? grid_side(grid, d) : HUGE_VAL;
    struct point point = sums_of_point(cloud, order[slot], widest);
    struct part part;
    for (int32_t from = 0; from < count; from += PART) {
        part.count = count - from < PART ? (size_t)(count - from) : PART;
        for (size_t k = 0; k < part.count; k++) {
            const size_t other = (size_t)slots[(size_t)from + k];
            for (int d = 0; d < cloud->box.dim; d++)
                part.delta[d][k] = grid_nearest(position[slot][d] - position[other][d], side[d]);
            part.volume[k] = cloud->volume[order[other]];
        }
        add_pairs(sums, &point, &part);
    }
    return point;
}

enum { BLOCK = 65536 };

/* Threads share the points of the block that begins at `first`. The results are added in the order
 * of the slots, so that they do not depend on the number of threads. */
static bool walk_block(struct sums *sums, const struct grid *grid, size_t first,
                       const unsigned char *asleep, double widest, int threads,
                       struct point *points)
{
    const size_t n = sums->cloud->n;
    const uint32_t *order = grid_order(grid);
    bool enough = true;
#pragma omp parallel num_threads(threads) if (threads > 1) reduction(&& : enough)
    {
        struct grid_reader reader = {0};
        const bool reads = enough = grid_reader_reserve(grid, &reader);
#pragma omp for schedule(dynamic, 256)
        for (size_t slot = 0; slot < n; slot++)
            if (reads && !asleep[order[slot]])
                points[order[slot] - first] = sums_of_slot(sums, grid, &reader, slot, widest);
        grid_reader_free(&reader);
    }
    for (size_t slot = 0; enough && slot < n; slot++)
        if (!asleep[order[slot]]) add_point(sums, &points[order[slot] - first]);
    return enough;
}

/* Searches neighbours for one block of points at a time, since the lists of all points would take
 * too much memory. */
static enum status walk_blocks(struct sums *sums, struct grid *grid, unsigned char *asleep,
                               double widest, int threads, struct point *points,
                               struct error *error)
{
    const struct regularity_cloud *cloud = sums->cloud;
    enum status status = STATUS_OK;
    for (size_t first = 0; !status && first < cloud->n; first += BLOCK) {
        for (size_t i = 0; i < cloud->n; i++) asleep[i] = i < first || i - first >= BLOCK;
        status = grid_search(grid, cloud->n, cloud->n, cloud->x, cloud->h, asleep, error);
        if (!status && !walk_block(sums, grid, first, asleep, widest, threads, points))
            status = error_set(error, STATUS_ENVIRONMENT, "no memory for %zu points", cloud->n);
    }
    return status;
}

static enum status walk_grid(struct sums *sums, double widest, struct error *error)
{
    const struct regularity_cloud *cloud = sums->cloud;
    struct grid_box box = {.dim = cloud->box.dim};
    const int threads = cloud->threads > 1 ? cloud->threads : 1;
    for (int d = 0; d < box.dim; d++) {
        box.lo[d] = cloud->box.lo[d];
        box.hi[d] = cloud->box.hi[d];
        box.periodic[d] = cloud->periodic[d];
    }
    struct grid *grid = grid_create(&box, cloud->n, threads);
    unsigned char *asleep = malloc(cloud->n);
    struct point *points = malloc((cloud->n < BLOCK ? cloud->n : BLOCK) * sizeof *points);
    const enum status status =
        grid && asleep && points
            ? walk_blocks(sums, grid, asleep, widest, threads, points, error)
            : error_set(error, STATUS_ENVIRONMENT, "no memory for %zu points", cloud->n);
    free(points);
    free(asleep);
    grid_destroy(grid);
    return status;
}

/* ---- neighbours in 1D ---- */

struct stand {
    double x;
    size_t i;
};

static int by_position(const void *a, const void *b)
{
    const double p = ((const struct stand *)a)->x, q = ((const struct stand *)b)->x;
    return (p > q) - (p < q);
}

/* Adds the neighbours on one side of point k in the sorted row within its h, and at least one. */
static void walk_side(const struct sums *sums, const struct stand *row, size_t k, bool right,
                      struct point *point)
{
    const struct regularity_cloud *cloud = sums->cloud;
    const double side = domain_length(&cloud->box, 0);
    const size_t n = cloud->n;
    for (size_t away = 1; away < n; away++) {
        const bool wraps = right ? k + away >= n : away > k;
        if (wraps && !cloud->periodic[0]) return;
        const size_t other = (right ? k + away : k + n - away) % n;
        const double image = !wraps ? 0 : right ? side : -side;
        const struct part part = {.count = 1,
                                  .delta[0][0] = row[k].x - row[other].x - image,
                                  .volume[0] = cloud->volume[row[other].i]};
        add_pairs(sums, point, &part);
        if (!(fabs(part.delta[0][0]) < cloud->h[point->i])) return;
    }
}

static enum status walk_line(struct sums *sums, double widest, struct error *error)
{
    const struct regularity_cloud *cloud = sums->cloud;
    struct stand *row = malloc(cloud->n * sizeof *row);
    if (!row) return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu points", cloud->n);
    const double lo = cloud->box.lo[0], side = domain_length(&cloud->box, 0);
    for (size_t i = 0; i < cloud->n; i++) {
        const double x = cloud->x[0][i];
        row[i] = (struct stand){cloud->periodic[0] ? x - side * floor((x - lo) / side) : x, i};
    }
    qsort(row, cloud->n, sizeof *row, by_position);
    for (size_t k = 0; k < cloud->n; k++) {
        struct point point = sums_of_point(cloud, row[k].i, widest);
        walk_side(sums, row, k, true, &point);
        walk_side(sums, row, k, false, &point);
        add_point(sums, &point);
    }
    free(row);
    return STATUS_OK;
}

enum status regularity_measure(const struct regularity_cloud *cloud, struct regularity *regularity,
                               struct error *error)
{
    struct sums sums = {.cloud = cloud, .shapes = shapes_of(cloud->kernel, cloud->box.dim, true)};
    double widest = 0;
    for (size_t i = 0; i < cloud->n; i++) widest = fmax(widest, cloud->h[i]);
    const enum status status =
        cloud->box.dim == 1 ? walk_line(&sums, widest, error) : walk_grid(&sums, widest, error);
    if (status) return status;
    const double n = (double)cloud->n, whole = (double)sums.whole;
    *regularity = (struct regularity){
        .nearest = sums.distance,
        .spread = sqrt(sums.squares / n) / sums.distance,
        .paired = (double)sums.paired / n,
        .density = sqrt(sums.density / whole),
        .gradient = sqrt(sums.gradient / whole),
    };
    return STATUS_OK;
}

struct regularity regularity_of(const struct prepared *p, const struct kernel *kernel,
                                const struct snapshot *s, int threads)
{
    struct regularity_cloud cloud = {.box = p->domain,
                                     .n = s->n,
                                     .x = {s->x[0], s->x[1], s->x[2]},
                                     .volume = s->volume,
                                     .h = s->h,
                                     .kernel = kernel,
                                     .threads = threads};
    struct regularity found;
    struct error error;
    for (int d = 0; d < p->domain.dim; d++) cloud.periodic[d] = p->boundary[d] == BOUNDARY_PERIODIC;
    if (s->n && !regularity_measure(&cloud, &found, &error)) return found;
    return (struct regularity){(double)NAN, (double)NAN, (double)NAN, (double)NAN, (double)NAN};
}
