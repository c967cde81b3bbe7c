/* SPDX-License-Identifier: GPL-3.0-or-later
 * Clocks, in seconds; only differences are meaningful. */
#pragma once

/* Durations, or the values of both clocks. */
struct clock_taken {
    double wall_s, cpu_s; /* cpu_s: of all threads of the process */
};

struct clock_taken clock_now(void);

/* Adds to *taken the time since start, a value of clock_now(). */
void clock_add(struct clock_taken *taken, const struct clock_taken *start);

double clock_wall(void);
double clock_thread(void); /* CPU time of the calling thread */
