/* SPDX-License-Identifier: GPL-3.0-or-later
 * Two ways of computing one thing, each drawn several times: is one's error smaller by more than
 * draws scatter? */
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum paired_verdict {
    PAIRED_NONE, /* no difference can be told */
    PAIRED_BETTER,
    PAIRED_WORSE,
    PAIRED_UNKNOWN, /* a single draw does not say how much of a difference is chance */
    PAIRED_VERDICTS
};
extern const char *const paired_verdicts[PAIRED_VERDICTS];

struct paired {
    size_t n;      /* draws that count: both errors are above 0 and finite */
    double a, b;   /* geometric means; NaN: no draw counts */
    double change; /* b/a - 1, of the geometric mean of the ratios */
    double half;   /* of its interval at the level, in the units of change; NaN: one draw */
    enum paired_verdict verdict; /* of b */
};

/* a, b: errors of n draws, those of one place drawn alike. The interval is Student's about the mean
 * of log(b/a), which pairs scatter about less than either side does. single: one side is a single
 * draw, repeated n times, that scatters as the other does. level: of all intervals that are looked
 * at together divided by their number, such as 0.05/4. A change below 0.1 % is none. */
struct paired paired_compare(size_t n, const double *a, const double *b, bool single, double level);
