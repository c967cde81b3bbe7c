/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "clock.h"

#include <time.h>

static double seconds(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

struct clock_taken clock_now(void)
{
    return (struct clock_taken){seconds(CLOCK_MONOTONIC), seconds(CLOCK_PROCESS_CPUTIME_ID)};
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
