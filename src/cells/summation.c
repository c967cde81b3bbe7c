/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "summation.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "shapes.h"
#include "units.h"
#include "width.h"

enum { REACHES_MAX = 200 };

struct work {
    struct candidates candidates;
    size_t capacity;
    double *r, *m, *q, *value; /* r owns the memory of all four */
};

struct task {
    const struct summation *of;
    const struct neighbours *neighbours;
    struct shapes shapes;
    double *h, *rho;
};

static bool work_reserve(struct work *work)
{
    if (work->candidates.n <= work->capacity) return true;
    const size_t n = work->candidates.capacity;
    free(work->r);
    work->capacity = 0;
    if (!(work->r = malloc(4 * n * sizeof(double)))) return false;
    work->m = work->r + n, work->q = work->r + 2 * n, work->value = work->r + 3 * n;
    work->capacity = n;
    return true;
}

/* Selects the distances and masses of the points within reach of the one at sorted index s. */
static size_t select_near(const struct task *task, struct work *work, size_t s, double reach)
{
    const struct candidates *c = &work->candidates;
    const struct neighbours *nb = task->neighbours;
    size_t n = 0;
    for (size_t k = 0; k < c->n; k++) {
        double r2 = 0;
        for (int a = 0; a < nb->dim; a++)
            r2 += (c->x[a][k] - nb->x[a][s]) * (c->x[a][k] - nb->x[a][s]);
        if (!(r2 < reach * reach)) continue; /* also skips fillings */
        work->r[n] = sqrt(r2);
        work->m[n++] = task->of->m[nb->order[c->j[k]]];
    }
    return n;
}

/* Sums over the n selected points, at smoothing length h. */
static void sum_near(const struct task *task, struct work *work, size_t n, double h,
                     struct density_sums *sums)
{
    const struct kernel *kernel = task->of->kernel;
    double sum = 0, slope = 0;
    for (size_t k = 0; k < n; k++) work->q[k] = work->r[k] / h;
    task->shapes.w(kernel, n, work->q, work->value);
    for (size_t k = 0; k < n; k++) sum += work->m[k] * work->value[k];
    task->shapes.dw(kernel, n, work->q, work->value);
    for (size_t k = 0; k < n; k++) slope += work->m[k] * work->value[k] * work->q[k];
    sums->m[0] = sum;
    sums->m_dh[0] = task->neighbours->dim * sum + slope;
}

/* Solves for h of one point; *found stays false if the root exceeds reach. */
static enum status solve_point(const struct task *task, struct work *work, size_t s, double reach,
                               bool *found, struct error *error)
{
    const int dim = task->neighbours->dim;
    const size_t i = task->neighbours->order[s];
    const struct kernel *kernel = task->of->kernel;
    const struct width_rule rule = {dim, task->of->eta, kernel->constant[dim], task->of->tolerance};
    const double m = task->of->m[i], wanted = m * pow(rule.eta, dim) / rule.constant;
    const size_t n = select_near(task, work, s, reach);
    struct density_sums sums;
    struct width_bracket bracket;
    double h = 0.7 * reach, h_inverse = 1 / h, together = 0;
    sum_near(task, work, n, reach, &sums);
    if (sums.m[0] < wanted) return STATUS_OK;
    for (size_t k = 0; k < n; k++) together += work->r[k] > 0 ? 0 : work->m[k];
    if (kernel->w(kernel, 0, dim) * together >= wanted)
        return error_set(error, STATUS_BROKE_DOWN,
                         "point %zu: no smoothing length: it coincides with others (mass %g there, "
                         "own %g)",
                         i, together, m);
    width_begin(&bracket, 1, reach);
    bool open = true;
    for (int step = 0; open && step < WIDTH_STEPS_MAX; step++) {
        sum_near(task, work, n, h, &sums);
        open = width_step(&rule, 1, &m, &sums, &bracket, &h, &h_inverse);
    }
    task->h[i] = h;
    task->rho[i] = m * pow(task->of->eta / h, dim);
    *found = true;
    return STATUS_OK;
}

/* A first guess of the largest root of a block, whose box holds NEIGHBOURS_BLOCK points. */
static double first_reach(const struct task *task, size_t block)
{
    const struct neighbours *nb = task->neighbours;
    const size_t dim = (size_t)nb->dim;
    double side = 0, whole = 0;
    for (size_t a = 0; a < dim; a++) {
        const size_t at = a * nb->stride[0] + block, top = a * nb->stride[nb->levels - 1];
        side = fmax(side, nb->hi[0][at] - nb->lo[0][at]);
        whole = fmax(whole, nb->hi[nb->levels - 1][top] - nb->lo[nb->levels - 1][top]);
    }
    if (nb->periodic && !(whole > 0)) whole = nb->length[0];
    const double spacing = side > 0 ? side / (pow(NEIGHBOURS_BLOCK, 1. / nb->dim) - 0.5)
                                    : whole * pow((double)nb->n, -1. / nb->dim);
    return 1.3 * task->of->eta * (spacing > 0 ? spacing : 1);
}

static enum status solve_block(const struct task *task, struct work *work, size_t block,
                               struct error *error)
{
    const struct neighbours *nb = task->neighbours;
    const size_t first = block * NEIGHBOURS_BLOCK;
    bool found[NEIGHBOURS_BLOCK] = {false}, all = false;
    double reach = first_reach(task, block);
    for (int k = 0; !all && k < REACHES_MAX; k++, reach *= k < 8 ? 1.5 : 4) {
        enum status status = neighbours_gather(nb, block, reach, &work->candidates, error);
        if (!status && !work_reserve(work))
            status = error_set(error, STATUS_ENVIRONMENT, "no memory for neighbours");
        if (status) return status;
        all = true;
        for (size_t s = first; s < first + NEIGHBOURS_BLOCK && s < nb->n; s++) {
            if (!found[s - first])
                status = solve_point(task, work, s, reach, &found[s - first], error);
            if (status) return status;
            all = all && found[s - first];
        }
    }
    return all ? STATUS_OK
               : error_set(error, STATUS_BROKE_DOWN, "point %u: no smoothing length found",
                           nb->order[first]);
}

static enum status check(const struct summation *of, struct error *error)
{
    const int dim = of->points.dim;
    const double least = kernel_least_eta(of->kernel, dim);
    double heaviest = 0, total = 0;
    size_t where = 0;
    if (!(of->eta > least && isfinite(of->eta)))
        return error_set(error, STATUS_BAD_INPUT,
                         "eta = %g; with kernel %s in %dD it must be above %.6g", of->eta,
                         of->kernel->member.name, dim, least);
    for (size_t i = 0; i < of->points.n; i++) {
        if (!(of->m[i] > 0 && isfinite(of->m[i])))
            return error_set(error, STATUS_BAD_INPUT, "point %zu: mass %g; it must be positive", i,
                             of->m[i]);
        total += of->m[i];
        if (of->m[i] > heaviest) heaviest = of->m[i], where = i;
    }
    /* for large h the sum approaches C w(0) times the total mass */
    if (of->points.n > 0 && !of->points.periodic &&
        !(pow(least, dim) * total > heaviest * pow(of->eta, dim)))
        return error_set(error, STATUS_BROKE_DOWN,
                         "point %zu: no smoothing length: the cloud's mass is %g, eta = %g needs "
                         "more than %g",
                         where, total, of->eta, heaviest * pow(of->eta / least, dim));
    return STATUS_OK;
}

static enum status solve(const struct summation *summation, double *h, double *rho,
                         struct error *error)
{
    struct neighbours *nb;
    struct task task = {.of = summation, .h = h, .rho = rho};
    enum status status = check(summation, error);
    if (status) return status;
    if ((status = neighbours_create(&summation->points, &nb, error))) return status;
    task.neighbours = nb;
    task.shapes = shapes_of(summation->kernel, nb->dim, true);
    const ptrdiff_t blocks = (ptrdiff_t)nb->blocks;
#pragma omp parallel num_threads(summation->threads)
    {
        struct work work = {0};
#pragma omp for schedule(dynamic, 16)
        for (ptrdiff_t b = 0; b < blocks; b++) {
            struct error here;
            const enum status outcome = solve_block(&task, &work, (size_t)b, &here);
            if (outcome) {
#pragma omp critical
                {
                    status = outcome;
                    if (error) *error = here;
                }
            }
        }
        neighbours_candidates_free(&work.candidates);
        free(work.r);
    }
    neighbours_destroy(nb);
    return status;
}

/* Extents of the cloud, or of its periodic box. */
static void extents(const struct points *points, double extent[3])
{
    for (int a = 0; a < points->dim; a++) {
        double lo = points->lo[a], hi = points->hi[a];
        for (size_t i = 0; i < points->n && !points->periodic; i++) {
            lo = i ? fmin(lo, points->x[a][i]) : points->x[a][i];
            hi = i ? fmax(hi, points->x[a][i]) : points->x[a][i];
        }
        extent[a] = points->n || points->periodic ? hi - lo : 0;
    }
}

/* Converts h and rho back to the caller's units. */
static enum status give_back(const struct summation *of, int length, int weight, double *h,
                             double *rho, struct error *error)
{
    for (size_t i = 0; i < of->points.n; i++) {
        h[i] = ldexp(h[i], length);
        rho[i] = ldexp(rho[i], weight - of->points.dim * length);
        if (!(h[i] >= DBL_MIN && h[i] <= DBL_MAX && rho[i] >= DBL_MIN && rho[i] <= DBL_MAX))
            return error_set(error, STATUS_BROKE_DOWN,
                             "point %zu: h = %g, density = %g: beyond the range of double "
                             "precision; other units help",
                             i, h[i], rho[i]);
    }
    return STATUS_OK;
}

enum status summation_solve(const struct summation *summation, double *h, double *rho,
                            struct error *error)
{
    const struct points *points = &summation->points;
    double extent[3] = {0};
    extents(points, extent);
    if (units_ordinary((size_t)points->dim, extent) && units_ordinary(points->n, summation->m))
        return solve(summation, h, rho, error);
    const int length = units_exponent((size_t)points->dim, extent);
    const int weight = units_exponent(points->n, summation->m);
    struct summation copy = *summation;
    double *m = units_copy(points->n, summation->m, weight);
    copy.m = m;
    const bool sound = m && units_points(points, length, &copy.points);
    enum status status =
        sound ? solve(&copy, h, rho, error)
              : error_set(error, STATUS_ENVIRONMENT, "no memory for %zu points", points->n);
    if (!status) status = give_back(summation, length, weight, h, rho, error);
    if (sound) units_points_free(&copy.points);
    free(m);
    return status;
}
