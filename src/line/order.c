/* SPDX-License-Identifier: GPL-3.0-or-later
 * Keeps particles sorted by position. */
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

/* Moves all particles into the period that starts at the first one. */
static void bring_round(struct particles *particles)
{
    const double period = particles->period[0];
    double *x = particles->x[0], *x_old = particles->x_old[0];
    const double start = x[0];
    for (ptrdiff_t i = 0; i < particles->n; i++) {
        const double shift = -period * floor((x[i] - start) / period);
        x[i] += shift;
        x_old[i] += shift;
    }
}

/* Replaces particles that have passed a wall by their mirror images inside. */
static void bring_back(const struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    const double lo = simulation->lo[0], length = a->period[0];
    double *const vectors[] = {a->p[0], a->p_old[0], a->v[0], a->F[0], a->F_mean[0], a->impulse[0]};
    for (ptrdiff_t i = 0; i < a->n; i++) {
        const double x = a->x[0][i], box = floor((x - lo) / length);
        if (x >= lo && x <= lo + length) continue;
        const bool mirrored = fmod(box, 2) != 0;
        if (mirrored) {
            const double wall = 2 * lo + (box + 1) * length;
            a->x[0][i] = fmin(fmax(wall - x, lo), lo + length);
            a->x_old[0][i] = wall - a->x_old[0][i];
            for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++)
                vectors[k][i] = -vectors[k][i];
        } else {
            a->x[0][i] = fmin(fmax(x - box * length, lo), lo + length);
            a->x_old[0][i] -= box * length;
        }
    }
}

static bool all_finite(const struct particles *particles)
{
    for (ptrdiff_t i = 0; i < particles->n; i++)
        if (!isfinite(particles->x[0][i])) return false;
    return true;
}

static void sort_by_position(struct particles *particles)
{
    for (ptrdiff_t i = 0; i < particles->n; i++) particles->order[i] = (size_t)i;
    _Static_assert(sizeof(size_t) <= sizeof(double), "an array of numbers can hold indices");
    sort_indices(particles->x[0], (size_t)particles->n, particles->order, (void *)particles->spare);
    particles_permute(particles);
}

bool order_sort(struct particles *particles)
{
    if (!all_finite(particles)) return false;
    bring_round(particles);
    sort_by_position(particles);
    return true;
}

/* Sorts, for any boundary. */
static bool sort_inside_ends(struct simulation *simulation)
{
    struct particles *a = &simulation->particles;
    if (simulation->boundary[0] == BOUNDARY_PERIODIC) return order_sort(a);
    if (!all_finite(a)) return false;
    if (simulation->boundary[0] == BOUNDARY_REFLECTING) bring_back(simulation);
    sort_by_position(a);
    return true;
}

/* Separates coincident particles by a thousandth of their spacing, if their own terms alone exceed
 * the limit of a narrow kernel, so that h has no root. Positions are sorted. */
static void separate(struct simulation *simulation)
{
    struct particles *a = &simulation->particles;
    const struct scheme *scheme = &simulation->scheme;
    const bool periodic = simulation->boundary[0] == BOUNDARY_PERIODIC;
    const bool open = simulation->boundary[0] == BOUNDARY_OPEN;
    const double lo = open ? -HUGE_VAL : simulation->lo[0];
    const double hi = open ? HUGE_VAL : lo + a->period[0];
    const double least_eta = kernel_least_eta(&scheme->kernel, 1);
    double *x = a->x[0];
    for (ptrdiff_t first = 0, end; first < a->n; first = end) {
        for (end = first + 1; end < a->n && x[end] == x[first];) end++;
        const ptrdiff_t count = end - first;
        if (count == 1 || (double)count * least_eta < scheme->eta) continue;
        const double before = first > 0 ? x[first - 1] : periodic ? x[a->n - 1] - a->period[0] : lo;
        const double after = end < a->n ? x[end] : periodic ? x[0] + a->period[0] : hi;
        const double space = fmin(x[first] - before, after - x[first]);
        const double gap = fmin(1e-3 * a->h[first] / scheme->eta, 0.5 * space / (double)count);
        for (ptrdiff_t k = 0; k < count; k++)
            x[first + k] += ((double)k - 0.5 * (double)(count - 1)) * gap;
        for (ptrdiff_t i = first; i < end; i++) a->x_old[0][i] = x[i];
    }
}

void order_begin(struct simulation *simulation)
{
    sort_inside_ends(simulation);
    separate(simulation);
}

/* Tests the adjacent pairs of a range, including the one with the previous range. */
static void order_pass(struct simulation *simulation, struct range *range, struct tally *tally)
{
    const struct particles *a = &simulation->particles;
    const ptrdiff_t first = range->first > 0 ? range->first - 1 : 0;
    const ptrdiff_t end = range->first + range->len;
    tally->crossings += order_crossings(a, first, (end < a->n ? end : a->n - 1) - first);
}

/* True if all particles are within one period, or between the walls. */
static bool inside_ends(const struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    const double first = a->x[0][0], last = a->x[0][a->n - 1], lo = simulation->lo[0];
    if (simulation->boundary[0] == BOUNDARY_PERIODIC) return last <= first + a->period[0];
    return simulation->boundary[0] != BOUNDARY_REFLECTING ||
           (first >= lo && last <= lo + a->period[0]);
}

/* Tests only particles that move. */
static bool in_order(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    const struct sleep *sleep = &simulation->sleep;
    if (!inside_ends(simulation)) return false;
    if (sleep->on && !sleep->at_rest) return order_crossings(a, 0, a->n - 1) <= 0;
    return pass_all(simulation, order_pass).crossings <= 0;
}

enum status order_arrange(struct simulation *simulation, struct error *error)
{
    struct particles *a = &simulation->particles;
    if (in_order(simulation)) return STATUS_OK;
    if (!sort_inside_ends(simulation))
        for (ptrdiff_t i = 0; i < a->n; i++)
            if (!isfinite(a->x[0][i]))
                return breakdown_of(simulation, i, "position", a->x[0][i], error);
    line_of(simulation)->ghosts_filled = 0; /* ghosts of the masses */
    if (simulation->sleep.on) groups_wake_all(simulation);
    return STATUS_OK;
}
