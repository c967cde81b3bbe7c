/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "clock.h"

#include <sys/resource.h>
#include <time.h>

static double seconds(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* CPU time of all threads. CLOCK_PROCESS_CPUTIME_ID advances in ticks of 4 ms once a process has a
 * CPU time limit (ulimit -t). */
static double cpu_seconds(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

struct clock_taken clock_now(void)
{
    return (struct clock_taken){seconds(CLOCK_MONOTONIC), cpu_seconds()};
}

void clock_add(struct clock_taken *taken, const struct clock_taken *start)
{
    const struct clock_taken now = clock_now();
    taken->wall_s += now.wall_s - start->wall_s;
    taken->cpu_s += now.cpu_s - start->cpu_s;
}

double clock_wall(void)
{
    return seconds(CLOCK_MONOTONIC);
}

double clock_thread(void)
{
    return seconds(CLOCK_THREAD_CPUTIME_ID);
}
