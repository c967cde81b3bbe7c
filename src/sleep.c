/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sleep.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "loop.h"
#include "range.h"
#include "solver.h"

static int group_len(const struct simulation *simulation, ptrdiff_t group)
{
    const ptrdiff_t left = simulation->particles.n - group * SLEEP_GROUP;
    return left < SLEEP_GROUP ? (int)left : SLEEP_GROUP;
}

/* Above the rounding of a lattice of n points: positions of order 1 are known to eps, spacings to
 * n eps. */
static double tolerance(const struct simulation *simulation)
{
    return fmax(1e-11, 30 * DBL_EPSILON * (double)simulation->particles.n);
}

static bool group_disturbed(const struct simulation *simulation, ptrdiff_t group)
{
    const struct particles *a = &simulation->particles;
    const double limit = tolerance(simulation);
    const ptrdiff_t first = group * SLEEP_GROUP;
    bool disturbed = false;
    for (ptrdiff_t i = first; i < first + group_len(simulation, group); i++) {
        disturbed |= !(fabs(a->F[i]) <= limit * a->P[i]);
        disturbed |= !(fabs(a->de[i]) <= limit * a->P[i] * (a->c[i] + fabs(a->v[i])));
        if (simulation->plan.alpha) disturbed |= !(fabs(a->dalpha[i]) * a->h[i] <= limit * a->c[i]);
    }
    return disturbed;
}

/* Groups around a disturbed one that must be awake: a disturbance passes through density and forces
 * in one step, so it comes twice the reach of pairs closer. */
static ptrdiff_t margin(ptrdiff_t reach)
{
    return (2 * reach + 2 + SLEEP_GROUP - 1) / SLEEP_GROUP;
}

static void wake_groups(struct sleep *sleep, ptrdiff_t first, ptrdiff_t count)
{
    memset(sleep->awake + first, 1, (size_t)count);
    memset(sleep->group_rate + first, 0, (size_t)count * sizeof *sleep->group_rate);
}

/* A group and its neighbours, across the ends of the box. */
static void wake(struct sleep *sleep, ptrdiff_t group, ptrdiff_t reach)
{
    const ptrdiff_t count = 2 * reach + 1;
    if (count >= sleep->groups) {
        wake_groups(sleep, 0, sleep->groups);
        return;
    }
    const ptrdiff_t first = (group - reach + sleep->groups) % sleep->groups;
    const ptrdiff_t before_end = sleep->groups - first < count ? sleep->groups - first : count;
    wake_groups(sleep, first, before_end);
    wake_groups(sleep, 0, count - before_end);
}

/* The next group from the given one on that is awake, or asleep; their number where there is none.
 */
static ptrdiff_t find_group(const struct sleep *sleep, ptrdiff_t from, bool awake)
{
    const unsigned char *found = memchr(sleep->awake + from, awake, (size_t)(sleep->groups - from));
    return found ? found - sleep->awake : sleep->groups;
}

/* Spans from the groups, ranges from the spans. */
static void lay_out(struct simulation *simulation)
{
    struct sleep *sleep = &simulation->sleep;
    const ptrdiff_t n = simulation->particles.n;
    sleep->span_count = sleep->awake_count = simulation->range_count = 0;
    sleep->rate = largest_of(sleep->group_rate, (sleep->groups + 7) / 8 * 8);
    for (ptrdiff_t begin, end = 0; (begin = find_group(sleep, end, true)) < sleep->groups;) {
        end = find_group(sleep, begin, false);
        const ptrdiff_t first = begin * SLEEP_GROUP;
        const ptrdiff_t last = end * SLEEP_GROUP < n ? end * SLEEP_GROUP : n;
        sleep->spans[sleep->span_count++] = (struct span){first, last - first};
        sleep->awake_count += last - first;
    }
    for (ptrdiff_t s = 0; s < sleep->span_count; s++)
        for (ptrdiff_t done = 0; done < sleep->spans[s].len; done += RANGE_MAX) {
            const ptrdiff_t left = sleep->spans[s].len - done;
            simulation->ranges[simulation->range_count++] =
                (struct range){.first = sleep->spans[s].first + done,
                               .len = (int)(left < RANGE_MAX ? left : RANGE_MAX),
                               .reach = 1};
        }
    sleep->on = sleep->awake_count < simulation->particles.n;
}

/* A group falls asleep: it has no rates, and a limit of the time step that stays. */
static void fall_asleep(struct simulation *simulation, ptrdiff_t group, ptrdiff_t reach)
{
    const struct particles *a = &simulation->particles;
    const ptrdiff_t first = group * SLEEP_GROUP;
    const int len = group_len(simulation, group);
    loops_signal(a, first, len, reach);
    simulation->sleep.group_rate[group] = range_rate(a, first, len);
    for (ptrdiff_t i = first; i < first + len; i++) {
        a->F[i] = a->de[i] = a->dalpha[i] = 0;
        simulation->sleep.at_rest &= a->p[i] == 0;
    }
}

enum status sleep_begin(struct simulation *simulation, bool allowed, struct error *error)
{
    struct sleep *sleep = &simulation->sleep;
    const struct particles *a = &simulation->particles;
    sleep->groups = (a->n + SLEEP_GROUP - 1) / SLEEP_GROUP;
    sleep->awake = malloc((size_t)sleep->groups);
    sleep->spans = malloc((size_t)(sleep->groups / 2 + 1) * sizeof *sleep->spans);
    /* whole vectors; 0 of those who are awake */
    sleep->group_rate = calloc((size_t)(sleep->groups + 7), sizeof *sleep->group_rate);
    if (!sleep->awake || !sleep->spans || !sleep->group_rate)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %td particles", a->n);
    sleep->at_rest = true;
    if (!allowed) {
        sleep_end(simulation);
        return STATUS_OK;
    }
    memset(sleep->awake, 0, (size_t)sleep->groups);
    ptrdiff_t reach = 0;
    for (ptrdiff_t b = 0; b < simulation->range_count; b++)
        if (simulation->ranges[b].force_reach > reach) reach = simulation->ranges[b].force_reach;
    for (ptrdiff_t group = 0; group < sleep->groups; group++)
        if (group_disturbed(simulation, group)) wake(sleep, group, margin(reach));
    for (ptrdiff_t group = 0; group < sleep->groups; group++)
        if (!sleep->awake[group]) fall_asleep(simulation, group, reach);
    lay_out(simulation);
    return STATUS_OK;
}

void sleep_end(struct simulation *simulation)
{
    wake_groups(&simulation->sleep, 0, simulation->sleep.groups);
    lay_out(simulation);
}

/* Disturbances come from inside: looks from one end of a span inwards, in the direction step, for
 * the outermost disturbed group. Returns whether it woke anybody. */
static bool wake_beyond(struct simulation *simulation, ptrdiff_t end, ptrdiff_t step,
                        ptrdiff_t reach, ptrdiff_t groups)
{
    for (ptrdiff_t k = 0; k < reach && k < groups; k++)
        if (group_disturbed(simulation, end + step * k)) {
            wake(&simulation->sleep, end + step * k, reach);
            return true;
        }
    return false;
}

void sleep_update(struct simulation *simulation)
{
    struct sleep *sleep = &simulation->sleep;
    if (!sleep->on) return;
    bool woken = false;
    const struct range *range = simulation->ranges;
    for (ptrdiff_t s = 0; s < sleep->span_count; s++) {
        const struct span *span = &sleep->spans[s];
        const ptrdiff_t first = span->first / SLEEP_GROUP;
        const ptrdiff_t last = (span->first + span->len - 1) / SLEEP_GROUP;
        woken |= wake_beyond(simulation, first, 1, margin(range->force_reach), last - first + 1);
        range += (span->len + RANGE_MAX - 1) / RANGE_MAX - 1; /* the last one of the span */
        woken |= wake_beyond(simulation, last, -1, margin(range->force_reach), last - first + 1);
        range++;
    }
    if (woken) lay_out(simulation);
}

void sleep_free(struct sleep *sleep)
{
    free(sleep->awake);
    free(sleep->group_rate);
    free(sleep->spans);
}
