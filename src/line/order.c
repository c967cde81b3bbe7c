/* SPDX-License-Identifier: GPL-3.0-or-later
 * The order of positions. */
#include <math.h>

#include "breakdown.h"
#include "line.h"
#include "pass.h"
#include "sort.h"
#include "specialise.h"

CLONES static double crossings_in(const struct particles *particles, ptrdiff_t first, ptrdiff_t len)
{
    const double *restrict x = particles->x[0] + first;
    double crossings = 0;
#pragma omp simd reduction(+ : crossings)
    for (ptrdiff_t i = 0; i < len; i++) crossings += x[i] <= x[i + 1] ? 0. : 1.;
    return crossings;
}

double order_crossings(const struct particles *particles, ptrdiff_t first, ptrdiff_t len)
{
    return crossings_in(particles, first, len);
}

bool order_sort(struct particles *particles)
{
    const ptrdiff_t n = particles->n;
    const double period = particles->period[0];
    double *x = particles->x[0], *x_old = particles->x_old[0];
    for (ptrdiff_t i = 0; i < n; i++)
        if (!isfinite(x[i])) return false;

    const double start = x[0];
    for (ptrdiff_t i = 0; i < n; i++) {
        const double shift = -period * floor((x[i] - start) / period);
        x[i] += shift;
        x_old[i] += shift;
        particles->order[i] = (size_t)i;
    }
    _Static_assert(sizeof(size_t) <= sizeof(double), "an array of numbers has room for indices");
    sort_indices(x, (size_t)n, particles->order, (void *)particles->spare);
    particles_permute(particles);
    return true;
}

/* Particles at one place whose own terms alone exceed what a narrow kernel allows have no root h:
 * they are moved apart by a thousandth of their spacing. Sorted positions. */
static void separate(struct particles *a, const struct scheme *scheme)
{
    const double least_eta = kernel_least_eta(&scheme->kernel, 1);
    double *x = a->x[0];
    for (ptrdiff_t first = 0, end; first < a->n; first = end) {
        for (end = first + 1; end < a->n && x[end] == x[first];) end++;
        const ptrdiff_t count = end - first;
        if (count == 1 || (double)count * least_eta < scheme->eta) continue;
        const double before = first > 0 ? x[first - 1] : x[a->n - 1] - a->period[0];
        const double after = end < a->n ? x[end] : x[0] + a->period[0];
        const double room = fmin(x[first] - before, after - x[first]);
        const double gap = fmin(1e-3 * a->h[first] / scheme->eta, 0.5 * room / (double)count);
        for (ptrdiff_t k = 0; k < count; k++)
            x[first + k] += ((double)k - 0.5 * (double)(count - 1)) * gap;
        for (ptrdiff_t i = first; i < end; i++) a->x_old[0][i] = x[i];
    }
}

void order_begin(struct simulation *simulation)
{
    order_sort(&simulation->particles);
    separate(&simulation->particles, &simulation->scheme);
}

/* Neighbours in a range, the end of the one before included. */
static void order_pass(struct simulation *simulation, struct range *range, struct tally *tally)
{
    const struct particles *a = &simulation->particles;
    const ptrdiff_t first = range->first > 0 ? range->first - 1 : 0;
    const ptrdiff_t end = range->first + range->len;
    tally->crossings += order_crossings(a, first, (end < a->n ? end : a->n - 1) - first);
}

/* Only what moves can get out of order. */
static bool in_order(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    const struct sleep *sleep = &simulation->sleep;
    if (!(a->x[0][a->n - 1] <= a->x[0][0] + a->period[0])) return false;
    if (sleep->on && !sleep->at_rest) return order_crossings(a, 0, a->n - 1) <= 0;
    return pass_all(simulation, order_pass).crossings <= 0;
}

enum status order_arrange(struct simulation *simulation, struct error *error)
{
    struct particles *a = &simulation->particles;
    if (in_order(simulation)) return STATUS_OK;
    if (!order_sort(a))
        for (ptrdiff_t i = 0; i < a->n; i++)
            if (!isfinite(a->x[0][i]))
                return breakdown_of(simulation, i, "position", a->x[0][i], error);
    line_of(simulation)->ghosts_filled = 0; /* of the masses */
    if (simulation->sleep.on) groups_wake_all(simulation);
    return STATUS_OK;
}
