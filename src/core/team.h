/* SPDX-License-Identifier: GPL-3.0-or-later
 * Chooses how many of a run's threads work. If other programs use the same processors, threads wait
 * for each other at the end of every pass for longer than sharing the work saves, and one thread
 * alone can be several times faster. Results do not depend on the number of threads, so both are
 * timed now and then for a few milliseconds, and less often the longer the answer has been the
 * same. */
#ifndef SPHPROOF_TEAM_H
#define SPHPROOF_TEAM_H

#include <stdbool.h>
#include <stddef.h>
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

/* Zeroed memory, for free(), of a struct of `size` bytes for each thread; its first member is
 * aligned to TEAM_APART. NULL: there is none left. */
void *team_allocate(int threads, size_t size);

/* How the threads of a parallel region share `parts` pieces of work. Each has a range of its own,
 * in order and the same in every region, so that its core's cache still has what it wrote before;
 * with that done it takes what others have not begun. */
enum {
    TEAM_SHARES = 64, /* further threads have no range of their own */
    TEAM_APART = 128  /* alignment of what one thread writes: no two ever share a cache line */
};

struct team_shares {
    size_t count; /* of ranges */
    struct team_share {
        _Alignas(TEAM_APART) size_t next, end;
    } share[TEAM_SHARES];
};

static inline void team_share(struct team_shares *shares, int team, size_t parts)
{
    const size_t count = team < TEAM_SHARES ? (size_t)team : TEAM_SHARES;
    shares->count = count;
    for (size_t t = 0; t < count; t++)
        shares->share[t].next = parts * t / count, shares->share[t].end = parts * (t + 1) / count;
}

/* Hands the next piece of work to the calling thread. Returns false when there is none left. */
static inline bool team_next(struct team_shares *shares, size_t *part)
{
    const size_t own = (size_t)team_thread();
    for (size_t k = 0; k < shares->count; k++) {
        struct team_share *share = &shares->share[(own + k) % shares->count];
        size_t next;
#pragma omp atomic read
        next = share->next;
        if (next >= share->end) continue;
#pragma omp atomic capture
        next = share->next++;
        *part = next;
        if (next < share->end) return true;
    }
    return false;
}

#endif
