/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares two ways of computing the same thing, each drawn several times: whether the error of one
 * is smaller by more than the scatter of the draws. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum paired_verdict {
    PAIRED_NONE, /* no significant difference */
    PAIRED_BETTER,
    PAIRED_WORSE,
    PAIRED_UNKNOWN, /* a single draw cannot separate a difference from chance */
    PAIRED_VERDICTS
};
extern const char *const paired_verdicts[PAIRED_VERDICTS];

struct paired {
    size_t n;                    /* number of draws with both errors positive and finite */
    double a, b;                 /* geometric means; NaN: no such draw */
    double change;               /* b/a - 1, of the geometric mean of the ratios */
    double half;                 /* half-width of its interval, in the same units; NaN: one draw */
    enum paired_verdict verdict; /* about b */
};

/* a, b: errors of n draws, those with the same index drawn alike. The interval is Student's for the
 * mean of log(b/a), which scatters less than either error because the draws are paired. single: one
 * side is a single draw, repeated n times, assumed to scatter like the other. level: of all
 * intervals considered together divided by their number, such as 0.05/4. A change below 0.1 %
 * counts as none. */
struct paired paired_compare(size_t n, const double *a, const double *b, bool single, double level);
