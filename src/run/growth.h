/* SPDX-License-Identifier: GPL-3.0-or-later
 * The rate at which an amplitude grows in a run: the slope of its logarithm over time, by least
 * squares over what is seen of it between two times. */
#pragma once

#include <stddef.h>

/* Begins as {0}: sums over what was seen. */
struct growth {
    size_t n;
    double t, y, tt, ty; /* y: ln amplitude */
};

void growth_see(struct growth *growth, double time, double amplitude);

/* NaN with fewer than three times, or where an amplitude was not positive. */
double growth_rate(const struct growth *growth);
