/* SPDX-License-Identifier: GPL-3.0-or-later
 * The passes over pairs: matrices, forces, signal speeds. */
#include <stdlib.h>

#include "line.h"
#include "pass.h"
#include "specialise.h"
#include "state.h"

/* True if velocities never decrease with position. In ranges where they do, the first vector
 * usually shows it. */
static bool never_falls(const double *v, ptrdiff_t count)
{
    for (ptrdiff_t i = 0; i < count; i += 8) {
        const ptrdiff_t end = i + 8 < count ? 8 : count - i;
        int falls = 0;
        for (ptrdiff_t l = 0; l < end; l++) falls |= !(v[i + l + 1] >= v[i + l]);
        if (falls) return false;
    }
    return true;
}

/* Sets the reach of a range's pairs, and whether all of them recede: particles are sorted, so this
 * holds if velocities never decrease from one to the next. */
static void look_at_pairs(const struct simulation *simulation, struct range *range)
{
    const ptrdiff_t reach = range->force_reach = reach_of_pairs(simulation, range);
    const double *v = simulation->particles.v[0] + range->first - reach;
    range->recedes = simulation->plan.quiet && never_falls(v, range->len + 2 * reach - 1);
}

static void matrix_pass(struct simulation *simulation, struct range *range, struct tally *tally)
{
    const struct loops *loops = &line_of(simulation)->loops;
    matrix_loop *loop = loops->matrix;
    if (simulation->plan.slope) {
        look_at_pairs(simulation, range);
        if (range->recedes) loop = loops->matrix_receding;
        tally->without_slope += range->recedes ? (uint64_t)range->len : 0;
    }
    if (loop)
        loop(&simulation->scheme.kernel, &simulation->particles, range->first, range->len,
             range->reach);
}

void forces_matrix(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    const ptrdiff_t count = line_of(simulation)->reach + 1;
    simulation->cost.without_slope += pass_all(simulation, matrix_pass).without_slope;
    ghosts_set(simulation, a->g, count, GHOST_SCALAR);
    if (simulation->plan.slope) ghosts_set(simulation, a->dv, count, GHOST_SCALAR);
}

enum status forces_reserve_scratch(struct simulation *simulation, ptrdiff_t reach,
                                   struct error *error)
{
    struct line *line = line_of(simulation);
    const size_t size = loop_force_scratch(reach);
    if (size <= line->scratch_size) return STATUS_OK;
    free(line->scratch);
    line->scratch_size = 2 * size;
    line->scratch = malloc(line->scratch_size * (size_t)simulation->team.most * sizeof(double));
    if (line->scratch) return STATUS_OK;
    line->scratch_size = 0;
    return error_set(error, STATUS_ENVIRONMENT, "no memory for pairs %td apart", reach);
}

static void force_pass(struct simulation *simulation, struct range *range, struct tally *tally)
{
    const struct line *line = line_of(simulation);
    const struct particles *a = &simulation->particles;
    double *scratch = line->scratch + line->scratch_size * (size_t)tally->thread;
    if (!simulation->plan.slope) range->force_reach = reach_of_pairs(simulation, range);
    force_loop *const loop = range->recedes ? line->loops.force_receding : line->loops.force;
    const double rate =
        loop(&line->loops, a, range->first, range->len, range->force_reach, scratch);
    tally->without_viscosity += range->recedes ? (uint64_t)range->len : 0;
    tally->rate = largest(tally->rate, rate);
    /* pair evaluations: sums with a particle's own h visit each pair from both sides, forces once
     */
    const int sums = 1 + (line->loops.matrix != NULL);
    tally->pairs += (uint64_t)(range->len * (2 * sums * range->reach + range->force_reach));
    if (simulation->plan.alpha) state_dalpha(a, range->first, range->len, &simulation->scheme);
}

enum status forces_sum(struct simulation *simulation, double *rate, struct error *error)
{
    const enum status status =
        forces_reserve_scratch(simulation, line_of(simulation)->reach, error);
    if (status) return status;
    const struct tally found = pass_all(simulation, force_pass);
    simulation->cost.pair_interactions += found.pairs;
    simulation->cost.without_viscosity += found.without_viscosity;
    *rate = found.rate;
    return STATUS_OK;
}

static void signal_pass(struct simulation *simulation, struct range *range, struct tally *tally)
{
    const struct particles *a = &simulation->particles;
    loops_signal(a, range->first, range->len, range->force_reach);
    tally->rate = largest(tally->rate, state_rate(a, range->first, range->len));
}

double forces_signal(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    ghosts_set(simulation, a->v[0], line_of(simulation)->reach + 1, GHOST_VECTOR);
    return pass_all(simulation, signal_pass).rate;
}
