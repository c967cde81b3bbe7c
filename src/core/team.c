/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "team.h"

#include <stdlib.h>
#include <string.h>

/* Minimum length of a trial in seconds: longer than the time slice of schedulers. A stretch between
 * trials is STRETCH_MIN to STRETCH_MAX times as long, in time and in steps, so that a trial of the
 * worse size costs little. */
static const double trial = 4e-3;
enum { STRETCH_MIN = 16, STRETCH_MAX = 256 };

/* The ratio of paces below which the size changes; otherwise noise would decide. */
static const double worth = 0.95;

/* A stretch slower than the last one by this factor ends early, with a trial of the other size. */
static const double slower = 1.5;

void team_begin(struct team *team, int most)
{
    *team = (struct team){.most = most, .size = most, .stretch = STRETCH_MIN, .trying = true};
}

void team_pause(struct team *team)
{
    team->begun = 0;
}

static void begin_stretch(struct team *team, int size, bool trying, double now)
{
    team->size = size;
    team->trying = trying;
    team->begun = now;
    team->steps = 0;
}

/* Both sizes have been measured: the faster one gets the next stretch, which doubles in length each
 * time the answer is the same. */
static void choose(struct team *team, double now)
{
    const int tried = team->size, other = tried == 1 ? team->most : 1;
    const double mine = team->pace[tried > 1], theirs = team->pace[other > 1];
    const bool change = mine < worth * theirs;
    team->stretch = change ? STRETCH_MIN : 2 * team->stretch;
    if (team->stretch > STRETCH_MAX) team->stretch = STRETCH_MAX;
    begin_stretch(team, change ? tried : other, false, now);
}

void team_step(struct team *team, double now)
{
    if (!(team->begun > 0)) {
        begin_stretch(team, team->size, team->trying, now);
        return;
    }
    double *pace = &team->pace[team->size > 1], times = team->trying ? 1 : team->stretch;
    const double taken = now - team->begun, present = taken / (double)++team->steps;
    if (present > slower * *pace) times = 1;
    if (!((double)team->steps >= times && taken >= times * trial)) return;
    *pace = present;
    const int other = team->size == 1 ? team->most : 1;
    if (team->trying && team->pace[0] > 0) /* the first trial uses all threads */
        choose(team, now);
    else
        begin_stretch(team, other, true, now);
}

void *team_allocate(int threads, size_t size)
{
    void *block = aligned_alloc(TEAM_APART, (size_t)threads * size);
    if (block) memset(block, 0, (size_t)threads * size);
    return block;
}
