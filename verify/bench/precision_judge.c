/* SPDX-License-Identifier: GPL-3.0-or-later
 * Finds schemes worth their time: Pareto front, cheapest ways to an error, figures of merit. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "precision.h"

const double precision_targets[PRECISION_TARGETS] = {0.01, 0.003, 0.001};

double precision_target(const struct precision *precision, size_t t)
{
    return (precision->dim > 1 ? 10 : 1) * precision_targets[t];
}

void precision_front(size_t n, const double *cost, const double *error, bool *on_front)
{
    for (size_t i = 0; i < n; i++) {
        on_front[i] = isfinite(cost[i]) && isfinite(error[i]);
        for (size_t j = 0; j < n && on_front[i]; j++)
            if (cost[j] <= cost[i] && error[j] <= error[i] &&
                (cost[j] < cost[i] || error[j] < error[i]))
                on_front[i] = false;
    }
}

double precision_cost_of(size_t n, const double *cost, const double *error, double target)
{
    double least = NAN;
    if (n && error[0] <= target) least = cost[0];
    for (size_t i = 1; i < n; i++) {
        if (!(error[i] <= target)) continue;
        double here = cost[i];
        if (error[i - 1] > target && error[i] > 0) {
            const double part = log(error[i - 1] / target) / log(error[i - 1] / error[i]);
            here = cost[i - 1] * pow(cost[i] / cost[i - 1], part);
        }
        if (!(least <= here)) least = here;
    }
    return least;
}

double precision_merit(const struct precision *precision, double error, double cpu_s)
{
    return pow(error, (1. + precision->dim) / precision->order) * cpu_s;
}

bool precision_competes(const struct precision_scheme *scheme)
{
    return scheme->reference == REFERENCE_NONE || scheme->reference == REFERENCE_GRADED;
}

static bool same_processor(const struct precision_point *a, const struct precision_point *b)
{
    return a->processor == b->processor ||
           (a->processor && b->processor && strcmp(a->processor, b->processor) == 0);
}

static bool of_one_processor(const struct precision *precision,
                             const struct precision_scheme *scheme)
{
    const struct precision_point *first = &precision->points[0];
    for (size_t i = 0; i < scheme->count; i++)
        if (!same_processor(first, &precision->points[scheme->first + i])) return false;
    return true;
}

/* One front per processor, because times of two are not comparable. front: space for n. */
static void fronts(struct precision *precision, const double *cost, double *wrong, bool *front)
{
    const size_t n = precision->point_count;
    struct precision_point *points = precision->points;
    for (size_t first = 0; first < n; first++) {
        bool seen = false;
        double *own = malloc(n * sizeof *own);
        for (size_t i = 0; i < first; i++) seen |= same_processor(&points[i], &points[first]);
        for (size_t i = 0; own && i < n; i++)
            own[i] = same_processor(&points[i], &points[first]) ? wrong[i] : (double)NAN;
        if (own && !seen) precision_front(n, cost, own, front);
        for (size_t i = 0; own && !seen && i < n; i++)
            if (same_processor(&points[i], &points[first])) points[i].on_front = front[i];
        free(own);
    }
}

enum status precision_judge(struct precision *precision, struct error *error)
{
    const size_t n = precision->point_count;
    double *cost = malloc(2 * n * sizeof *cost), *wrong = cost ? cost + n : NULL;
    bool *front = malloc(n * sizeof *front);
    if (!cost || !front) {
        free(cost), free(front);
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu points", n);
    }
    for (size_t i = 0; i < n; i++) {
        cost[i] = precision->points[i].time.cpu_s;
        wrong[i] = precision_competes(&precision->schemes[precision->points[i].scheme])
                       ? precision->points[i].error
                       : (double)NAN;
    }
    fronts(precision, cost, wrong, front);
    for (size_t i = 0; i < n; i++) wrong[i] = precision->points[i].error;
    for (size_t t = 0; t < PRECISION_TARGETS; t++)
        precision->cheapest[t] =
            (struct precision_way){precision_target(precision, t) * precision->signal, NAN, 0};
    double plain = NAN;
    for (size_t i = precision->scheme_count; i-- > 0;) {
        struct precision_scheme *scheme = &precision->schemes[i];
        const size_t last = scheme->first + scheme->count - 1;
        scheme->merit =
            scheme->count ? precision_merit(precision, wrong[last], cost[last]) : (double)NAN;
        const bool cloud = precision->dim > 1;
        if (scheme->reference == (cloud ? REFERENCE_SEED : REFERENCE_SEED_PLAIN))
            plain = scheme->merit;
        scheme->gain = plain / scheme->merit;
        const bool compared = precision_competes(scheme) && of_one_processor(precision, scheme);
        for (size_t t = 0; t < PRECISION_TARGETS && compared; t++) {
            struct precision_way *way = &precision->cheapest[t];
            const double here = precision_cost_of(scheme->count, cost + scheme->first,
                                                  wrong + scheme->first, way->error);
            if (here <= way->cpu_s || isnan(way->cpu_s)) way->cpu_s = here, way->scheme = i;
        }
    }
    free(cost), free(front);
    return STATUS_OK;
}
