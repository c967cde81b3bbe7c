/* SPDX-License-Identifier: GPL-3.0-or-later
 * Clocks, in seconds; differences mean something, the values do not. */
#pragma once

/* What something took, or two metrics. */
struct clock_taken {
    double wall_s, cpu_s; /* cpu_s: of all threads of the process */
};

struct clock_taken clock_now(void);

/* Adds to *taken what has passed since start, a clock_now(). */
void clock_add(struct clock_taken *taken, const struct clock_taken *start);

double clock_wall(void);
double clock_thread(void); /* CPU time of the calling thread */
