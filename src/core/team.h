/* SPDX-License-Identifier: GPL-3.0-or-later
 * Chooses how many of a run's threads work. If other programs use the same processors, threads wait
 * for each other at the end of every pass for longer than sharing the work saves, and one thread
 * alone can be several times faster. Results do not depend on the number of threads, so both are
 * timed now and then for a few milliseconds, and less often the longer the answer has been the
 * same. */
#ifndef SPHPROOF_TEAM_H
#define SPHPROOF_TEAM_H

#include <stdbool.h>
#include <stdint.h>

#ifdef _OPENMP
#include <omp.h>
#endif

struct team {
    int most;       /* threads there are, >= 1 */
    int size;       /* at work: most or 1 */
    double pace[2]; /* seconds a step that were measured last: of one thread, of most; 0: none */
    double begun;   /* when the present stretch of steps did; 0: none has */
    double stretch; /* until the other size is tried: in trials */
    uint64_t steps; /* of the present stretch */
    bool trying;    /* the present stretch is a trial */
};

/* Begins with all threads at work; later steps try whether fewer are faster. */
void team_begin(struct team *team, int most);

/* A step ends at `now`, in seconds of a clock that never goes back. Decides on the size of the team
 * for the next one. */
void team_step(struct team *team, double now);

/* Excludes the time from here to the next step from the measurement. */
void team_pause(struct team *team);

/* The number of the calling thread among those of a parallel region, from 0. */
static inline int team_thread(void)
{
#ifdef _OPENMP
    return omp_get_thread_num();
#else
    return 0;
#endif
}

#endif
