/* SPDX-License-Identifier: GPL-3.0-or-later
 * The descriptor of the sums in 1D, and their workspace. */
#include "line.h"

#include <math.h>
#include <stdlib.h>

enum { GHOSTS_AT_START = 64, RESERVE = 8 };

static enum status create(struct simulation *simulation, ptrdiff_t n, struct error *error)
{
    struct line *line = simulation->workspace = calloc(1, sizeof *line);
    if (!line) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    loops_choose(&simulation->plan, &simulation->scheme, &line->loops);
    /* enough for spans of any length, each of which may end with a partial range */
    const ptrdiff_t groups = (n + GROUP - 1) / GROUP;
    line->range_count = (n + BATCH_MAX - 1) / BATCH_MAX;
    line->ranges = calloc((size_t)(groups + 1), sizeof *line->ranges);
    if (!line->ranges)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %td particles", n);
    for (ptrdiff_t b = 0; b < line->range_count; b++) {
        struct range *range = &line->ranges[b];
        range->first = b * BATCH_MAX;
        range->len = (int)(n - range->first < BATCH_MAX ? n - range->first : BATCH_MAX);
        range->reach = 1;
    }
    return particles_create(&simulation->particles, 1, n, GHOSTS_AT_START, error);
}

static double bytes(const struct simulation *simulation, double n)
{
    (void)simulation;
    return n * sizeof(struct range) / GROUP;
}

static void free_workspace(struct simulation *simulation)
{
    struct line *line = line_of(simulation);
    if (!line) return;
    free(line->ranges);
    free(line->scratch);
    free(line->groups.awake);
    free(line->groups.stirred);
    free(line->groups.rate);
    free(line);
}

/* Allocates for neighbours RESERVE times as far apart in the order as at the start, which is more
 * than a shock needs. Only beyond that does a step allocate memory, at least half as much again
 * each time. */
static enum status reserve(struct simulation *simulation, struct error *error)
{
    struct line *line = line_of(simulation);
    const ptrdiff_t reach = RESERVE * line->reach;
    if (reach + 8 > simulation->particles.ghosts) {
        enum status status = particles_grow_ghosts(&simulation->particles, reach + 8, error);
        /* The groups that fall asleep next read ghosts, so these are set at once. */
        line->ghosts_filled = 0;
        if (!status) status = ghosts_of_density(simulation, line->reach + 2, error);
        if (status) return status;
        ghosts_of_pairs(simulation);
    }
    return forces_reserve_scratch(simulation, reach, error);
}

static double count_within(const struct particles *a, ptrdiff_t i, ptrdiff_t step)
{
    double count = 0;
    for (ptrdiff_t j = i + step; j >= -a->ghosts && j < a->n + a->ghosts; j += step, count++)
        if (!(fabs(a->x[0][j] - a->x[0][i]) * a->h_inverse[i] < 1)) break;
    return count;
}

/* In 1D the matrix is a number. */
static void describe(const struct simulation *simulation, description_visit *visit, void *context)
{
    const struct particles *a = &simulation->particles;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        const struct description of = {
            .neighbours = 1 + count_within(a, i, -1) + count_within(a, i, 1),
            .condition = simulation->plan.matrix ? 1 : nan(""),
            .angle = simulation->plan.matrix ? 0 : nan(""),
        };
        visit(context, (size_t)i, &of);
    }
}

static void serialise_line(struct simulation *simulation, struct serialiser *serialiser)
{
    struct line *line = line_of(simulation);
    struct groups *groups = &line->groups;
    SERIALISE(serialiser, line->range_count);
    serialise(serialiser, line->ranges, (size_t)line->range_count * sizeof *line->ranges);
    SERIALISE(serialiser, line->ghosts_filled);
    SERIALISE(serialiser, line->reach);
    SERIALISE(serialiser, line->predict_ratio);
    SERIALISE(serialiser, line->density_passes);
    serialise(serialiser, groups->awake, (size_t)groups->count);
    serialise(serialiser, groups->rate, (size_t)groups->count * sizeof *groups->rate);
}

const struct sums line_sums = {
    .name = "line",
    .dim_min = 1,
    .dim_max = 1,
    .create = create,
    .free = free_workspace,
    .bytes = bytes,
    .begin = order_begin,
    .reserve = reserve,
    .arrange = order_arrange,
    .widths = widths_find,
    .matrix = forces_matrix,
    .forces = forces_sum,
    .signal = forces_signal,
    .describe = describe,
    .sleep_begin = groups_begin,
    .sleep_update = groups_update,
    .sleeps = groups_sleep,
    .serialise = serialise_line,
};
