/* SPDX-License-Identifier: GPL-3.0-or-later
 * Smoothing lengths, densities and the equation of state, range by range: by Newton's method, or
 * with one sum at a predicted h. */
#include <math.h>

#include "breakdown.h"
#include "line.h"
#include "pass.h"
#include "state.h"

/* Result for a range: solved, or more ghosts needed, or (>= 0) the first particle without a root.
 */
enum { SOLVED = -1, NO_GHOSTS = -2 };

/* Solves h = eta m/rho(h) for a range; converged particles keep their h while the others continue.
 */
static ptrdiff_t solve_range(struct simulation *simulation, struct range *range,
                             struct density_sums *sums)
{
    const struct line *line = line_of(simulation);
    const struct particles *a = &simulation->particles;
    const struct width_rule rule = width_rule_of(simulation);
    double *h = a->h + range->first, *h_inverse = a->h_inverse + range->first;
    const double *m = a->m + range->first;
    struct width_bracket bracket;
    width_begin(&bracket, range->len, INFINITY);
    for (int i = 0; i < range->len; i++) h_inverse[i] = 1 / h[i];
    for (int step = 0; step < WIDTH_STEPS_MAX; step++) {
        if (!reach_cover(simulation, range)) return NO_GHOSTS;
        line->loops.density(&simulation->scheme.kernel, a, range->first, range->len, range->reach,
                            h_inverse, sums);
        if (!width_step(&rule, range->len, m, sums, &bracket, h, h_inverse)) return SOLVED;
    }
    const int without_root = width_without_root(&rule, range->len, m, sums, h, h_inverse);
    return without_root < 0 ? SOLVED : range->first + without_root;
}

/* Computes one density sum at a predicted h. */
static ptrdiff_t sum_range(struct simulation *simulation, struct range *range,
                           struct density_sums *sums)
{
    const struct line *line = line_of(simulation);
    const struct particles *a = &simulation->particles;
    if (range->predicted != line->density_passes)
        width_predict(a, range->first, range->len, line->predict_ratio);
    range->predicted = line->density_passes;
    if (!reach_cover(simulation, range)) return NO_GHOSTS;
    if (simulation->cost.steps % 8 == 0) reach_tighten(simulation, range);
    line->loops.density(&simulation->scheme.kernel, a, range->first, range->len, range->reach,
                        a->h_inverse + range->first, sums);
    return SOLVED;
}

/* The equation of state of a range. */
static void close_range(struct simulation *simulation, const struct range *range,
                        const struct density_sums *sums)
{
    const bool predicted = range->predicted == line_of(simulation)->density_passes;
    const struct gas gas = {.gamma = simulation->gamma,
                            .constant = simulation->scheme.kernel.constant[1],
                            .eta = simulation->scheme.eta,
                            .follow = predicted ? simulation->scheme.integrator->follow : 0};
    state_close(&simulation->particles, range->first, range->len, &simulation->plan, &gas, sums);
}

/* Finds the widths of a range that has none yet in this density pass. */
static void width_pass(struct simulation *simulation, struct range *range, struct tally *tally)
{
    const struct line *line = line_of(simulation);
    struct density_sums sums;
    if (range->done != line->density_passes) {
        const ptrdiff_t result = (line->newton ? solve_range : sum_range)(simulation, range, &sums);
        if (result == SOLVED) {
            close_range(simulation, range, &sums);
            range->done = line->density_passes;
            if (line->newton && simulation->cost.steps % 8 == 0) reach_tighten(simulation, range);
        }
        if (result == NO_GHOSTS) tally->short_of_ghosts = true;
        if (result >= 0 && result < tally->without_root) tally->without_root = result;
    }
    if (range->reach > tally->reach) tally->reach = range->reach;
}

/* Reports an h that exceeds any possible root. */
static enum status too_wide(const struct simulation *simulation, struct error *error)
{
    const struct particles *a = &simulation->particles;
    ptrdiff_t widest = 0;
    for (ptrdiff_t i = 1; i < a->n; i++)
        if (!(a->h_inverse[i] >= a->h_inverse[widest])) widest = i;
    return breakdown_of(simulation, widest, "smoothing length", 1 / a->h_inverse[widest], error);
}

/* Repeats the pass for ranges that need more ghosts. */
enum status widths_find(struct simulation *simulation, bool newton, double ratio,
                        struct error *error)
{
    struct line *line = line_of(simulation);
    ptrdiff_t ghosts = line->ghosts_filled > 8 ? line->ghosts_filled : 8;
    if (line->reach + 2 > ghosts) ghosts = line->reach + 2;
    /* no root exceeds eta times the box; a search may go twice as far */
    const double most = 64 + (2 * simulation->scheme.eta + 2) * (double)simulation->particles.n;
    line->density_passes++;
    line->newton = newton;
    line->predict_ratio = ratio;
    for (;;) {
        const enum status status = ghosts_of_density(simulation, ghosts, error);
        if (status) return status;
        const struct tally found = pass_all(simulation, width_pass);
        if (found.without_root < PTRDIFF_MAX)
            return breakdown_of(simulation, found.without_root,
                                "smoothing length (no root was found)",
                                simulation->particles.h[found.without_root], error);
        line->reach = found.reach;
        if (!found.short_of_ghosts) break;
        if ((double)ghosts > most) return too_wide(simulation, error);
        ghosts *= 2;
    }
    ghosts_of_pairs(simulation);
    return STATUS_OK;
}
