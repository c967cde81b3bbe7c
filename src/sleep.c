/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sleep.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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
    return fmax(1e-10, 1e3 * DBL_EPSILON * (double)simulation->particles.n);
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

/* Groups around a disturbed one that must be awake: twice the reach of pairs, and some. */
static ptrdiff_t margin(const struct simulation *simulation)
{
    ptrdiff_t reach = 0;
    for (ptrdiff_t b = 0; b < simulation->range_count; b++)
        if (simulation->ranges[b].force_reach > reach) reach = simulation->ranges[b].force_reach;
    return (2 * reach + 6) / SLEEP_GROUP + 2;
}

static void wake(struct sleep *sleep, ptrdiff_t group, ptrdiff_t reach)
{
    if (2 * reach + 1 >= sleep->groups) {
        memset(sleep->awake, 1, (size_t)sleep->groups);
        return;
    }
    for (ptrdiff_t k = -reach; k <= reach; k++)
        sleep->awake[(group + k + sleep->groups) % sleep->groups] = 1;
}

/* Spans from the groups, ranges from the spans, and what the sleepers leave behind: no rates, and a
 * limit of the time step. */
static void lay_out(struct simulation *simulation)
{
    struct sleep *sleep = &simulation->sleep;
    struct particles *a = &simulation->particles;
    sleep->span_count = sleep->awake_count = simulation->range_count = 0;
    sleep->rate = 0;
    for (ptrdiff_t group = 0; group < sleep->groups; group++) {
        const ptrdiff_t first = group * SLEEP_GROUP;
        const int len = group_len(simulation, group);
        if (!sleep->awake[group]) {
            memset(a->F + first, 0, (size_t)len * sizeof(double));
            memset(a->de + first, 0, (size_t)len * sizeof(double));
            memset(a->dalpha + first, 0, (size_t)len * sizeof(double));
            sleep->rate = fmax(sleep->rate, range_rate(a, first, len));
            continue;
        }
        sleep->awake_count += len;
        struct span *last = sleep->span_count ? &sleep->spans[sleep->span_count - 1] : NULL;
        if (last && last->first + last->len == first)
            last->len += len;
        else
            sleep->spans[sleep->span_count++] = (struct span){first, len};
    }
    for (ptrdiff_t s = 0; s < sleep->span_count; s++)
        for (ptrdiff_t done = 0; done < sleep->spans[s].len; done += RANGE_MAX) {
            const ptrdiff_t left = sleep->spans[s].len - done;
            simulation->ranges[simulation->range_count++] =
                (struct range){.first = sleep->spans[s].first + done,
                               .len = (int)(left < RANGE_MAX ? left : RANGE_MAX),
                               .reach = 1};
        }
    sleep->on = sleep->awake_count < a->n;
}

enum status sleep_begin(struct simulation *simulation, bool allowed, struct error *error)
{
    struct sleep *sleep = &simulation->sleep;
    const struct particles *a = &simulation->particles;
    sleep->groups = (a->n + SLEEP_GROUP - 1) / SLEEP_GROUP;
    sleep->awake = malloc((size_t)sleep->groups);
    sleep->spans = malloc((size_t)(sleep->groups / 2 + 1) * sizeof *sleep->spans);
    if (!sleep->awake || !sleep->spans)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %td particles", a->n);
    memset(sleep->awake, !allowed, (size_t)sleep->groups);
    sleep->at_rest = true;
    if (allowed) {
        const ptrdiff_t reach = margin(simulation);
        for (ptrdiff_t group = 0; group < sleep->groups; group++)
            if (group_disturbed(simulation, group)) wake(sleep, group, reach);
        for (ptrdiff_t i = 0; i < a->n; i++)
            sleep->at_rest &= sleep->awake[i / SLEEP_GROUP] || a->p[i] == 0;
        lay_out(simulation);
    } else {
        sleep_end(simulation);
    }
    return STATUS_OK;
}

void sleep_end(struct simulation *simulation)
{
    memset(simulation->sleep.awake, 1, (size_t)simulation->sleep.groups);
    lay_out(simulation);
}

void sleep_update(struct simulation *simulation)
{
    struct sleep *sleep = &simulation->sleep;
    if (!sleep->on) return;
    const ptrdiff_t reach = margin(simulation);
    bool woken = false;
    for (ptrdiff_t s = 0; s < sleep->span_count; s++) {
        const ptrdiff_t first = sleep->spans[s].first / SLEEP_GROUP;
        const ptrdiff_t last = (sleep->spans[s].first + sleep->spans[s].len - 1) / SLEEP_GROUP;
        /* disturbances come from inside: the outermost one at each end decides */
        for (ptrdiff_t k = 0; k < reach && first + k <= last; k++)
            if (group_disturbed(simulation, first + k)) {
                wake(sleep, first + k, reach);
                woken = true;
                break;
            }
        for (ptrdiff_t k = 0; k < reach && last - k >= first; k++)
            if (group_disturbed(simulation, last - k)) {
                wake(sleep, last - k, reach);
                woken = true;
                break;
            }
    }
    if (woken) lay_out(simulation);
}

void sleep_free(struct sleep *sleep)
{
    free(sleep->awake);
    free(sleep->spans);
}
