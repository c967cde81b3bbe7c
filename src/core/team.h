/* SPDX-License-Identifier: GPL-3.0-or-later
 * Chooses how many of a run's threads work. If other programs use the same processors, threads may
 * wait for each other at the end of every pass for longer than sharing the work saves, and a single
 * thread can be several times faster. Results do not depend on the number of threads, so both are
 * timed from time to time for a few milliseconds, less often the longer the answer stays the same.
 */
#ifndef SPHPROOF_TEAM_H
#define SPHPROOF_TEAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef _OPENMP
#include <omp.h>
#endif

struct team {
    int most;       /* maximum number of threads, >= 1 */
    int size;       /* threads in use: most or 1 */
    double pace[2]; /* last measured seconds per step, with one thread and with most; 0: none */
    double begun;   /* start of the current stretch of steps; 0: none */
    double stretch; /* length of a stretch between trials, in trials */
    uint64_t steps; /* in the current stretch */
    bool trying;    /* the current stretch is a trial */
};

/* Starts with all threads; later steps try whether one is faster. */
void team_begin(struct team *team, int most);

/* To be called at the end of a step; now: seconds of a monotonic clock. Chooses the size for the
 * next step. */
void team_step(struct team *team, double now);

/* Excludes the time from here to the next step from the measurement. */
void team_pause(struct team *team);

/* Number of the calling thread in a parallel region, from 0. */
static inline int team_thread(void)
{
#ifdef _OPENMP
    return omp_get_thread_num();
#else
    return 0;
#endif
}

/* Allocates a zeroed struct of `size` bytes for each thread, aligned to TEAM_APART, in one array;
 * release with free(). NULL: no memory. */
void *team_allocate(int threads, size_t size);

/* Shares `parts` pieces of work among the threads of a parallel region. Each thread has its own
 * range, in order and the same in every region, so that its core's cache still holds the data it
 * wrote before; after that it takes pieces that others have not begun. */
enum {
    TEAM_SHARES = 64, /* maximum number of ranges; further threads have none */
    TEAM_APART = 128  /* alignment that keeps threads from sharing cache lines */
};

struct team_shares {
    size_t count; /* number of ranges */
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

/* Gives the calling thread its next piece of work. Returns false when there is none left. */
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
