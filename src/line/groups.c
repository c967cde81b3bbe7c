/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sleep in 1D: groups of consecutive particles, spans of awake groups, ranges of the spans. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "line.h"
#include "specialise.h"
#include "state.h"

static int group_len(const struct simulation *simulation, ptrdiff_t group)
{
    const ptrdiff_t left = simulation->particles.n - group * GROUP;
    return left < GROUP ? (int)left : GROUP;
}

/* The velocity of the next particle beyond the outermost particle i; in a periodic box that of
 * particle `other` at the other end. */
static double beyond_end(const struct simulation *simulation, ptrdiff_t i, ptrdiff_t other)
{
    const double *v = simulation->particles.v[0];
    if (simulation->boundary[0] == BOUNDARY_PERIODIC) return v[other];
    return simulation->boundary[0] == BOUNDARY_REFLECTING ? -v[i] : v[i];
}

/* Relative speed of a particle and its right neighbour, in units of the tolerance. */
static double against_right(const struct simulation *simulation, ptrdiff_t i, double in_tolerances)
{
    const struct particles *a = &simulation->particles;
    const double sound = simulation->sleep.sound;
    const double right = i + 1 < a->n ? a->v[0][i + 1] : beyond_end(simulation, i, 0);
    return in_tolerances * fabs(right - a->v[0][i]) / (a->c[i] < sound ? sound : a->c[i]);
}

/* The same for its image in the wall on its left; 0 if there is none. */
static double against_wall(const struct simulation *simulation, ptrdiff_t i, double in_tolerances)
{
    const struct particles *a = &simulation->particles;
    const double sound = simulation->sleep.sound;
    if (i > 0 || simulation->boundary[0] != BOUNDARY_REFLECTING) return 0;
    return in_tolerances * fabs(2 * a->v[0][i]) / (a->c[i] < sound ? sound : a->c[i]);
}

/* The largest disturbance of these particles, in units of the tolerance: from their rates and their
 * speeds relative to the right neighbours. Cold gas that streams apart has no rates, but its
 * density changes. NaN if a value is NaN. */
static double disturbance_of(const struct simulation *simulation, ptrdiff_t first, ptrdiff_t len)
{
    const double in_tolerances = 1 / simulation->sleep.tolerance;
    double worst = sleep_disturbance(simulation, first, len);
    for (ptrdiff_t i = first; i < first + len; i++) {
        const double right = against_right(simulation, i, in_tolerances);
        const double against =
            i > 0 ? right : largest(right, against_wall(simulation, i, in_tolerances));
        if (!(against <= worst || isnan(worst))) worst = against;
    }
    return worst;
}

static bool group_disturbed(const struct simulation *simulation, ptrdiff_t group)
{
    return !(disturbance_of(simulation, group * GROUP, group_len(simulation, group)) <= 1);
}

/* Tests one velocity first, which settles it for most awake gas. */
static bool group_calm(const struct simulation *simulation, ptrdiff_t group)
{
    const ptrdiff_t first = group * GROUP;
    return against_right(simulation, first, 1 / simulation->sleep.tolerance) <= SLEEP_CALM &&
           disturbance_of(simulation, first, group_len(simulation, group)) <= SLEEP_CALM;
}

/* Number of groups kept awake on either side of a disturbed one: within one step a disturbance
 * passes through the density sum and the force sum, each of which carries it by the reach of pairs.
 */
static ptrdiff_t margin(ptrdiff_t reach)
{
    return 2 * reach / GROUP + 1;
}

/* Wakes a group and `reach` groups on either side of it, also across the ends of a periodic box. */
static void wake(struct groups *groups, ptrdiff_t group, ptrdiff_t reach)
{
    const ptrdiff_t count = groups->count;
    for (ptrdiff_t k = -reach; k <= reach; k++) {
        const ptrdiff_t at = ((group + k) % count + count) % count;
        groups->awake[at] = 1;
        groups->rate[at] = 0;
    }
}

/* The first awake (or, with awake = false, sleeping) group at or after `from`; the number of groups
 * if there is none. */
static ptrdiff_t find_group(const struct groups *groups, ptrdiff_t from, bool awake)
{
    const unsigned char *found =
        memchr(groups->awake + from, awake, (size_t)(groups->count - from));
    return found ? found - groups->awake : groups->count;
}

/* Makes the spans from the groups. */
static void find_spans(struct simulation *simulation)
{
    const struct groups *groups = &line_of(simulation)->groups;
    struct sleep *sleep = &simulation->sleep;
    const ptrdiff_t n = simulation->particles.n;
    sleep->span_count = sleep->awake_count = 0;
    sleep->rate = largest_of(groups->rate, (groups->count + 7) / 8 * 8);
    for (ptrdiff_t begin, end = 0; (begin = find_group(groups, end, true)) < groups->count;) {
        end = find_group(groups, begin, false);
        const ptrdiff_t first = begin * GROUP;
        const ptrdiff_t last = end * GROUP < n ? end * GROUP : n;
        sleep->spans[sleep->span_count++] = (struct span){first, last - first};
        sleep->awake_count += last - first;
    }
    sleep->on = sleep->awake_count < n;
}

/* Makes the spans from the groups and the ranges from the spans. */
static void lay_out(struct simulation *simulation)
{
    struct line *line = line_of(simulation);
    const struct sleep *sleep = &simulation->sleep;
    find_spans(simulation);
    line->range_count = 0;
    for (ptrdiff_t s = 0; s < sleep->span_count; s++)
        for (ptrdiff_t done = 0; done < sleep->spans[s].len; done += BATCH_MAX) {
            const ptrdiff_t left = sleep->spans[s].len - done;
            line->ranges[line->range_count++] =
                (struct range){.first = sleep->spans[s].first + done,
                               .len = (int)(left < BATCH_MAX ? left : BATCH_MAX),
                               .reach = 1};
        }
}

/* Puts a group to sleep and keeps its signal speed / h, which limits the time step and does not
 * change while it sleeps. Ghosts of positions and velocities must be up to date. */
static void fall_asleep(struct simulation *simulation, ptrdiff_t group, ptrdiff_t reach)
{
    const struct particles *a = &simulation->particles;
    const ptrdiff_t first = group * GROUP;
    const int len = group_len(simulation, group);
    loops_signal(a, first, len, reach);
    line_of(simulation)->groups.rate[group] = state_rate(a, first, len);
    sleep_begin(simulation, first, len);
}

static enum status allocate(struct simulation *simulation, struct error *error)
{
    struct groups *groups = &line_of(simulation)->groups;
    struct sleep *sleep = &simulation->sleep;
    const ptrdiff_t n = simulation->particles.n;
    groups->count = (n + GROUP - 1) / GROUP;
    groups->awake = calloc((size_t)groups->count, 1);
    groups->stirred = calloc((size_t)groups->count, 1);
    /* padded to whole vectors */
    groups->rate = calloc((size_t)(groups->count + 7), sizeof *groups->rate);
    sleep->spans = malloc((size_t)groups->count * sizeof *sleep->spans);
    return groups->awake && groups->stirred && groups->rate && sleep->spans
               ? STATUS_OK
               : error_set(error, STATUS_ENVIRONMENT, "no memory for %td particles", n);
}

enum status groups_begin(struct simulation *simulation, struct error *error)
{
    struct line *line = line_of(simulation);
    const enum status status = allocate(simulation, error);
    if (status) return status;
    simulation->sleep.at_rest = true;
    if (!simulation->plan.sleep) {
        groups_wake_all(simulation);
        return STATUS_OK;
    }
    struct groups *groups = &line->groups;
    sleep_scale(simulation);
    for (ptrdiff_t group = 0; group < groups->count; group++)
        if (group_disturbed(simulation, group)) wake(groups, group, margin(line->reach));
    for (ptrdiff_t group = 0; group < groups->count; group++)
        if (!groups->awake[group]) fall_asleep(simulation, group, line->reach);
    lay_out(simulation);
    return STATUS_OK;
}

void groups_wake_all(struct simulation *simulation)
{
    struct groups *groups = &line_of(simulation)->groups;
    memset(groups->awake, 1, (size_t)groups->count);
    memset(groups->rate, 0, (size_t)groups->count * sizeof *groups->rate);
    if (simulation->plan.sleep) simulation->sleep.at_rest = true; /* no particle sleeps */
    lay_out(simulation);
}

/* Disturbances reach sleeping groups from inside the awake spans. Searches from one end of a span
 * inwards, in the direction `step`, for the outermost disturbed group, and wakes the groups around
 * it. Returns whether there was one. */
static bool wake_beyond(struct simulation *simulation, ptrdiff_t end, ptrdiff_t step,
                        ptrdiff_t reach, ptrdiff_t count)
{
    for (ptrdiff_t k = 0; k < reach && k < count; k++)
        if (group_disturbed(simulation, end + step * k)) {
            wake(&line_of(simulation)->groups, end + step * k, reach);
            return true;
        }
    return false;
}

/* Wakes the sleeping groups that a disturbance inside an awake span is about to reach. */
static bool wake_ahead(struct simulation *simulation)
{
    const struct sleep *sleep = &simulation->sleep;
    bool woken = false;
    const struct range *range = line_of(simulation)->ranges;
    for (ptrdiff_t s = 0; s < sleep->span_count; s++) {
        const struct span *span = &sleep->spans[s];
        const ptrdiff_t first = span->first / GROUP;
        const ptrdiff_t last = (span->first + span->len - 1) / GROUP;
        woken |= wake_beyond(simulation, first, 1, margin(range->force_reach), last - first + 1);
        range += (span->len + BATCH_MAX - 1) / BATCH_MAX - 1; /* last range of the span */
        woken |= wake_beyond(simulation, last, -1, margin(range->force_reach), last - first + 1);
        range++;
    }
    return woken;
}

/* True if a group within the margin of this one is stirred, also across the ends of a periodic box.
 */
static bool stirred_near(const struct groups *groups, ptrdiff_t group, ptrdiff_t around)
{
    const ptrdiff_t count = groups->count;
    if (groups->stirred[group]) return true;
    for (ptrdiff_t k = -around; k <= around; k++)
        if (groups->stirred[((group + k) % count + count) % count]) return true;
    return false;
}

/* Integrators skip sleeping particles only while all of them have zero velocity. Groups that fall
 * asleep again usually have a velocity, so they stay awake if they are fewer than one in FEW. */
enum { FEW = 16 };

/* Puts every awake group to sleep that has only calm groups within the margin; the limit of calm is
 * well below that of waking. Returns whether there was one. */
static bool sleep_again(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    struct line *line = line_of(simulation);
    struct groups *groups = &line->groups;
    const ptrdiff_t around = margin(line->reach);
    ptrdiff_t found = 0;
    for (ptrdiff_t group = 0; group < groups->count; group++)
        groups->stirred[group] = groups->awake[group] && !group_calm(simulation, group);
    for (ptrdiff_t group = 0; group < groups->count; group++)
        found += groups->awake[group] && !stirred_near(groups, group, around);
    if (!found ||
        (simulation->sleep.on && simulation->sleep.at_rest && found * FEW < groups->count))
        return false;
    /* particles have moved since the last sums */
    ghosts_set(simulation, a->x[0], line->reach + 1, GHOST_POSITION);
    ghosts_set(simulation, a->v[0], line->reach + 1, GHOST_VECTOR);
    for (ptrdiff_t group = 0; group < groups->count; group++)
        if (groups->awake[group] && !stirred_near(groups, group, around)) {
            groups->awake[group] = 0;
            fall_asleep(simulation, group, line->reach);
        }
    return true;
}

bool groups_sleep(const struct simulation *simulation, ptrdiff_t i)
{
    return !line_of(simulation)->groups.awake[i / GROUP];
}

void groups_update(struct simulation *simulation)
{
    bool changed = simulation->sleep.on && wake_ahead(simulation);
    if (simulation->plan.sleep && sleep_due(simulation)) changed |= sleep_again(simulation);
    if (changed) lay_out(simulation);
}
