/* SPDX-License-Identifier: GPL-3.0-or-later
 * Growth rate of an amplitude during a run: the slope of its logarithm over time, by least squares
 * over the values between two times. */
#pragma once

#include <stddef.h>

/* Sums over the values added so far; starts as {0}. */
struct growth {
    size_t n;
    double t, y, tt, ty; /* y: ln amplitude */
};

void growth_see(struct growth *growth, double time, double amplitude);

/* NaN with fewer than three values, or if an amplitude was not positive. */
double growth_rate(const struct growth *growth);
