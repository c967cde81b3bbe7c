/* SPDX-License-Identifier: GPL-3.0-or-later
 * The passes of an evaluation, over the ranges of the plan. Ranges are independent of each other:
 * a particle's sums are gathered by its own range in a fixed order, so results do not depend on
 * the number of threads. */
#include <math.h>
#include <string.h>
#include <stdlib.h>

#include "loop.h"
#include "pass.h"
#include "range.h"
#include "solver.h"

enum { NEWTON_MAX = 200, NO_GHOSTS = -2, RESERVE = 8 };

enum status broke_down(const struct simulation *simulation, ptrdiff_t i, const char *quantity,
                       double value, struct error *error)
{
    const struct particles *a = &simulation->particles;
    return error_set(error, STATUS_BROKE_DOWN,
                     "broke down at t = %.9g: %s of particle %zu at x = %.9g is %.9g",
                     simulation->time, quantity, a->id[i], a->x[i], value);
}

/* --- order and the primitive state ------------------------------------------------------------ */

/* Neighbours in a range, the end of the one before included. */
static void order_pass(struct simulation *simulation, struct range *range, struct tally *tally)
{
    const struct particles *a = &simulation->particles;
    const ptrdiff_t first = range->first > 0 ? range->first - 1 : 0;
    const ptrdiff_t end = range->first + range->len;
    tally->crossings += range_crossings(a, first, (end < a->n ? end : a->n - 1) - first);
}

/* Only what moves can get out of order. */
static bool in_order(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    const struct sleep *sleep = &simulation->sleep;
    if (!(a->x[a->n - 1] <= a->x[0] + a->period)) return false;
    if (sleep->on && !sleep->at_rest) return range_crossings(a, 0, a->n - 1) <= 0;
    return pass_all(simulation, order_pass).crossings <= 0;
}

static enum status restore_order(struct simulation *simulation, struct error *error)
{
    struct particles *a = &simulation->particles;
    if (in_order(simulation)) return STATUS_OK;
    if (!particles_sort(a))
        for (ptrdiff_t i = 0; i < a->n; i++)
            if (!isfinite(a->x[i])) return broke_down(simulation, i, "position", a->x[i], error);
    simulation->ghosts_filled = 0; /* of the masses */
    if (simulation->sleep.on) sleep_end(simulation);
    return STATUS_OK;
}

/* v and U from p and e. */
static enum status find_primitives(struct simulation *simulation, struct error *error)
{
    const struct particles *a = &simulation->particles;
    const double kinetic = simulation->scheme.energy == ENERGY_TOTAL ? 0.5 : 0;
    if (range_primitives(a, 0, a->n, kinetic) <= 0) return STATUS_OK;
    ptrdiff_t i = 0;
    while (a->U[i] > 0) i++;
    return broke_down(simulation, i, "internal energy", a->U[i], error);
}

/* --- density and smoothing length ------------------------------------------------------------- */

/* Raises the range's reach until it covers the widths h; false where that takes more ghosts than
 * are filled. */
static bool cover(const struct simulation *simulation, struct range *range)
{
    if (range->reach < 1) range->reach = 1;
    while (range->reach + 1 <= simulation->ghosts_filled) {
        if (range_inside(&simulation->particles, range->first, range->len, range->reach + 1) <= 0)
            return true;
        range->reach++;
    }
    return false;
}

/* Lowers a reach that has become larger than needed. */
static void tighten(const struct simulation *simulation, struct range *range)
{
    while (range->reach > 1 &&
           range_inside(&simulation->particles, range->first, range->len, range->reach) <= 0)
        range->reach--;
}

/* h = eta m/rho(h) of a range: Newton inside a bracket; a particle that has converged keeps its h
 * while the others go on. Returns the first particle without a root, -1 if all is well, NO_GHOSTS
 * for lack of ghosts. */
static ptrdiff_t solve_range(struct simulation *simulation, struct range *range,
                             struct density_sums *sums)
{
    const struct particles *a = &simulation->particles;
    const struct scheme *scheme = &simulation->scheme;
    const double tolerance = scheme->h_tolerance, constant = scheme->kernel.constant[1];
    double *h = a->h + range->first, *h_inverse = a->h_inverse + range->first;
    const double *m = a->m + range->first;
    double low[RANGE_MAX], high[RANGE_MAX];
    for (int i = 0; i < range->len; i++) {
        low[i] = 0;
        high[i] = INFINITY;
        h_inverse[i] = 1 / h[i];
    }
    for (int iteration = 0; iteration < NEWTON_MAX; iteration++) {
        if (!cover(simulation, range)) return NO_GHOSTS;
        simulation->loops.density_newton(&scheme->kernel, a, range->first, range->len, range->reach,
                                         h_inverse, sums);
        ptrdiff_t open = -1;
        for (int i = 0; i < range->len; i++) {
            const double target = scheme->eta * m[i] / (constant * h_inverse[i] * sums->m[i]);
            const double residual = h[i] - target;
            if (fabs(residual) <= tolerance * h[i]) continue;
            open = range->first + i;
            if (residual < 0)
                low[i] = h[i];
            else
                high[i] = h[i];
            const double slope = 1 - target / h[i] * (sums->m_dh[i] / sums->m[i]);
            double next = h[i] - residual / slope;
            if (!(slope > 0 && next > low[i] && next < high[i]))
                next = isinf(high[i]) ? 2 * h[i] : 0.5 * (low[i] + high[i]);
            /* a bracket of two neighbouring numbers is a root, too */
            if (next == low[i] || next == high[i]) low[i] = high[i] = next;
            h[i] = least(next, 2 * h[i]);
            h_inverse[i] = 1 / h[i];
        }
        if (open < 0) return -1;
    }
    for (int i = 0; i < range->len; i++) {
        const double target = scheme->eta * m[i] / (constant * h_inverse[i] * sums->m[i]);
        if (!(fabs(h[i] - target) <= 1e-6 * h[i])) return range->first + i;
    }
    return -1;
}

/* One density sum at a predicted h. Returns as solve_range does. */
static ptrdiff_t sum_range(struct simulation *simulation, struct range *range,
                           struct density_sums *sums)
{
    const struct particles *a = &simulation->particles;
    const struct scheme *scheme = &simulation->scheme;
    if (range->predicted != simulation->density_passes)
        range_predict_width(a, range->first, range->len, simulation->predict_ratio);
    range->predicted = simulation->density_passes;
    if (!cover(simulation, range)) return NO_GHOSTS;
    if (simulation->cost.steps % 8 == 0) tighten(simulation, range);
    simulation->loops.density(&scheme->kernel, a, range->first, range->len, range->reach,
                              a->h_inverse + range->first, sums);
    return -1;
}

/* Ghosts of what the density sums read, at least count of them. */
static enum status fill_density_ghosts(struct simulation *simulation, ptrdiff_t count,
                                       struct error *error)
{
    struct particles *a = &simulation->particles;
    /* loops in whole vectors read a little beyond, and drop it */
    if (count + 8 > a->ghosts) {
        const enum status status = particles_grow_ghosts(a, count + count / 2 + 8, error);
        if (status) return status;
    }
    if (count > simulation->ghosts_filled) particles_fill_ghosts(a, a->m, count, 0);
    simulation->ghosts_filled = count;
    particles_fill_ghosts(a, a->x, count, a->period);
    if (simulation->plan.energy_sum) particles_fill_ghosts(a, a->U, count, 0);
    return STATUS_OK;
}

static double close_range(struct simulation *simulation, const struct range *range,
                          const struct density_sums *sums)
{
    const struct gas gas = {
        simulation->gamma, simulation->scheme.kernel.constant[1], simulation->scheme.eta,
        range->predicted == simulation->density_passes ? simulation->scheme.integrator->follow : 0};
    return range_close(&simulation->particles, range->first, range->len, &simulation->plan, &gas,
                       sums);
}

/* What has become of a range's widths, as solve_range returns it. */
static void conclude(const struct simulation *simulation, struct range *range, ptrdiff_t result,
                     struct tally *tally)
{
    if (result == -1) range->done = simulation->density_passes;
    if (result == NO_GHOSTS) tally->short_of_ghosts = true;
    if (result >= 0 && result < tally->without_root) tally->without_root = result;
    if (range->reach > tally->reach) tally->reach = range->reach;
}

static void newton_pass(struct simulation *simulation, struct range *range, struct tally *tally)
{
    struct density_sums sums;
    ptrdiff_t result = -1;
    if (range->done != simulation->density_passes) {
        result = solve_range(simulation, range, &sums);
        if (result == -1) close_range(simulation, range, &sums);
        if (result == -1 && simulation->cost.steps % 8 == 0) tighten(simulation, range);
    }
    conclude(simulation, range, result, tally);
}

/* h -> eta m/rho(h) is no contraction where the density changes by orders of magnitude within a
 * width: predictions there diverge. Where one has failed the root is looked for, from the predicted
 * width on; the pressure follows what U was predicted with all the same. A root twice as far away
 * or more (particles that all but meet in a first half step) is none to jump to. Each particle
 * decides for itself, so that nothing depends on its range. Returns as solve_range does. */
static ptrdiff_t solve_surprised(struct simulation *simulation, struct range *range,
                                 struct density_sums *sums)
{
    const struct particles *a = &simulation->particles;
    const ptrdiff_t first = range->first;
    const double follow = simulation->scheme.integrator->follow * (simulation->gamma - 1);
    struct density_sums roots;
    double predicted[RANGE_MAX];
    bool jumps[RANGE_MAX];
    for (int i = 0; i < range->len; i++) {
        predicted[i] = a->h_inverse[first + i];
        jumps[i] = range_surprised(a, first + i);
        a->h[first + i] = 1 / predicted[i];
    }
    const ptrdiff_t result = solve_range(simulation, range, &roots);
    for (int i = 0; i < range->len; i++) {
        const double ratio = a->h[first + i] * predicted[i];
        jumps[i] &= result == -1 && ratio > 0.5 && ratio < 2;
        if (!jumps[i]) {
            a->h_inverse[first + i] = predicted[i];
            continue;
        }
        sums->m[i] = roots.m[i];
        sums->m_dh[i] = roots.m_dh[i];
        sums->Z[i] = roots.Z[i];
        sums->Z_dh[i] = roots.Z_dh[i];
    }
    if (result == NO_GHOSTS) return result;
    close_range(simulation, range, sums);
    for (ptrdiff_t i = first; i < first + range->len; i++) {
        if (!jumps[i - first]) continue;
        const double factor = largest(0.5, 1 + follow * (1 - a->h[i] * predicted[i - first]));
        a->h_inverse_old[i] = a->h_inverse_found[i];
        if (simulation->plan.energy_sum) continue;
        a->P[i] *= factor;
        if (simulation->plan.grad_h) a->b[i] *= factor;
    }
    return -1;
}

static void predicted_pass(struct simulation *simulation, struct range *range, struct tally *tally)
{
    struct density_sums sums;
    ptrdiff_t result = -1;
    if (range->done != simulation->density_passes) {
        result = sum_range(simulation, range, &sums);
        if (result == -1 && close_range(simulation, range, &sums) > 0)
            result = solve_surprised(simulation, range, &sums);
    }
    conclude(simulation, range, result, tally);
}

/* A width that covers more of the box's images than any root would has run away. */
static enum status too_wide(const struct simulation *simulation, struct error *error)
{
    const struct particles *a = &simulation->particles;
    ptrdiff_t widest = 0;
    for (ptrdiff_t i = 1; i < a->n; i++)
        if (!(a->h_inverse[i] >= a->h_inverse[widest])) widest = i;
    return broke_down(simulation, widest, "smoothing length", 1 / a->h_inverse[widest], error);
}

/* Repeats the pass over ranges that were short of ghosts. */
static enum status find_density(struct simulation *simulation, range_pass *pass,
                                struct error *error)
{
    ptrdiff_t ghosts = simulation->ghosts_filled > 8 ? simulation->ghosts_filled : 8;
    if (simulation->reach + 2 > ghosts) ghosts = simulation->reach + 2;
    /* no root lies beyond eta times the box; a search may go twice as far */
    const double most = 64 + (2 * simulation->scheme.eta + 2) * (double)simulation->particles.n;
    simulation->density_passes++;
    for (;;) {
        const enum status status = fill_density_ghosts(simulation, ghosts, error);
        if (status) return status;
        const struct tally found = pass_all(simulation, pass);
        if (found.without_root < PTRDIFF_MAX)
            return broke_down(simulation, found.without_root,
                              "smoothing length (no root was found)",
                              simulation->particles.h[found.without_root], error);
        simulation->reach = found.reach;
        if (!found.short_of_ghosts) return STATUS_OK;
        if ((double)ghosts > most) return too_wide(simulation, error);
        ghosts *= 2;
    }
}

static enum status reserve_scratch(struct simulation *simulation, ptrdiff_t reach,
                                   struct error *error)
{
    const size_t size = force_scratch(reach);
    if (size <= simulation->scratch_size) return STATUS_OK;
    free(simulation->scratch);
    simulation->scratch_size = 2 * size;
    simulation->scratch =
        malloc(simulation->scratch_size * (size_t)simulation->threads * sizeof(double));
    if (simulation->scratch) return STATUS_OK;
    simulation->scratch_size = 0;
    return error_set(error, STATUS_ENVIRONMENT, "no memory for pairs %td apart", reach);
}

/* --- the evaluations -------------------------------------------------------------------------- */

/* Pairs reach as far as the wider of the two: the reach of a range for forces is the largest of all
 * ranges whose own reach touches it. */
static ptrdiff_t force_reach(const struct simulation *simulation, const struct range *range)
{
    const struct range *ranges = simulation->ranges;
    const ptrdiff_t count = simulation->range_count, n = simulation->particles.n,
                    b = range - ranges;
    ptrdiff_t reach = range->reach, gap = 0; /* particles between the two ranges */
    for (ptrdiff_t k = 1; k < count && gap < simulation->reach && gap < n; k++) {
        const struct range *right = &ranges[(b + k) % count],
                           *left = &ranges[(b - k + count) % count];
        if (gap < right->reach && right->reach > reach) reach = right->reach;
        if (gap < left->reach && left->reach > reach) reach = left->reach;
        gap += right->len < left->len ? right->len : left->len;
    }
    return reach;
}

static enum status prepare(struct simulation *simulation, bool newton, struct error *error)
{
    const enum status status = restore_order(simulation, error);
    return status ? status : find_density(simulation, newton ? newton_pass : predicted_pass, error);
}

enum status evaluate_state(struct simulation *simulation, struct error *error)
{
    const enum status status = find_primitives(simulation, error);
    return status ? status : prepare(simulation, true, error);
}

static void fill_rate_ghosts(struct simulation *simulation, ptrdiff_t count)
{
    const struct particles *a = &simulation->particles;
    const struct plan *plan = &simulation->plan;
    double *const always[] = {a->v, a->h, a->h_inverse, a->V, a->P, a->c};
    for (size_t k = 0; k < sizeof always / sizeof *always; k++)
        particles_fill_ghosts(a, always[k], count, 0);
    if (plan->own_gradient) particles_fill_ghosts(a, a->g, count, 0);
    if (plan->viscosity) {
        particles_fill_ghosts(a, a->rho, count, 0);
        particles_fill_ghosts(a, a->alpha, count, 0);
    }
    if (plan->grad_h) {
        particles_fill_ghosts(a, a->b, count, 0);
        particles_fill_ghosts(a, a->grad_h, count, 0);
    }
}

/* dalpha/dt = max(-div v, 0)(alpha_max - alpha) - (alpha - alpha_min)/tau, tau = h/(0.2 c). */
static void range_dalpha(const struct simulation *simulation, const struct range *range)
{
    const struct particles *a = &simulation->particles;
    const struct scheme *scheme = &simulation->scheme;
    for (ptrdiff_t i = range->first; i < range->first + range->len; i++) {
        const double growth =
            largest(-a->div_v[i], 0) * largest(scheme->alpha_max - a->alpha[i], 0);
        a->dalpha[i] = growth - (a->alpha[i] - scheme->alpha_min) * 0.2 * a->c[i] / a->h[i];
    }
}

static void matrix_pass(struct simulation *simulation, struct range *range, struct tally *tally)
{
    (void)tally;
    simulation->loops.matrix(&simulation->scheme.kernel, &simulation->particles, range->first,
                             range->len, range->reach);
}

static void force_pass(struct simulation *simulation, struct range *range, struct tally *tally)
{
    double *scratch = simulation->scratch + simulation->scratch_size * (size_t)tally->thread;
    range->force_reach = force_reach(simulation, range);
    const double rate =
        simulation->loops.force(&simulation->loops, &simulation->particles, range->first,
                                range->len, range->force_reach, scratch);
    tally->rate = largest(tally->rate, rate);
    /* visited: both sides of every sum in the own-width sums, each pair once in the forces */
    const int sums = 1 + (simulation->loops.matrix != NULL);
    tally->pairs += (uint64_t)(range->len * (2 * sums * range->reach + range->force_reach));
    if (simulation->plan.alpha) range_dalpha(simulation, range);
}

static void signal_pass(struct simulation *simulation, struct range *range, struct tally *tally)
{
    loops_signal(&simulation->particles, range->first, range->len, range->force_reach);
    const double rate = range_rate(&simulation->particles, range->first, range->len);
    tally->rate = largest(tally->rate, rate);
}

static void limit_time_step(struct simulation *simulation, const struct tally *found)
{
    simulation->time_step = simulation->scheme.cfl / largest(found->rate, simulation->sleep.rate);
}

enum status evaluate_rates(struct simulation *simulation, struct error *error)
{
    const enum status status = find_primitives(simulation, error);
    return status ? status : evaluate_rates_of_primitives(simulation, error);
}

enum status evaluate_rates_of_primitives(struct simulation *simulation, struct error *error)
{
    const bool newton = simulation->plan.newton || simulation->last_dt <= 0;
    enum status status = prepare(simulation, newton, error);
    if (status) return status;
    const struct particles *a = &simulation->particles;
    if (newton && !simulation->plan.newton)
        for (ptrdiff_t i = 0; i < a->n; i++) a->h_inverse_old[i] = a->h_inverse_found[i];
    const ptrdiff_t reach = simulation->reach;
    fill_rate_ghosts(simulation, reach + 1);
    if (simulation->loops.matrix) {
        pass_all(simulation, matrix_pass);
        particles_fill_ghosts(a, a->g, reach + 1, 0);
        if (simulation->plan.slope) particles_fill_ghosts(a, a->dv, reach + 1, 0);
    }
    status = reserve_scratch(simulation, reach, error);
    if (status) return status;
    const struct tally found = pass_all(simulation, force_pass);
    limit_time_step(simulation, &found);
    simulation->cost.pair_interactions += found.pairs;
    return STATUS_OK;
}

enum status evaluate_reserve(struct simulation *simulation, struct error *error)
{
    const ptrdiff_t reach = RESERVE * simulation->reach;
    if (reach + 8 > simulation->particles.ghosts) {
        const enum status status = particles_grow_ghosts(&simulation->particles, reach + 8, error);
        if (status) return status;
        simulation->ghosts_filled = 0;
    }
    return reserve_scratch(simulation, reach, error);
}

void evaluate_signal(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    for (ptrdiff_t i = 0; i < a->n; i++) a->v[i] = a->p[i] * a->m_inverse[i];
    particles_fill_ghosts(a, a->v, simulation->reach + 1, 0);
    const struct tally found = pass_all(simulation, signal_pass);
    limit_time_step(simulation, &found);
}
