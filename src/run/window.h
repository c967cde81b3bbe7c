/* SPDX-License-Identifier: GPL-3.0-or-later
 * Where errors are measured. Code units. */
#ifndef SPHPROOF_WINDOW_H
#define SPHPROOF_WINDOW_H

#include <jansson.h>
#include <stdbool.h>

/* An interval, a rectangle or a box, sides included (radius 0), or else a disc or a ball. */
struct window {
    int dim;
    double lo[3], hi[3]; /* of a ball: the box around it */
    double centre[3], radius;
};

bool window_contains(const struct window *window, const double x[3]);

/* [lo, hi] of an interval, {"lo", "hi"} of a box, {"centre", "radius"} of a ball. New reference. */
json_t *window_json(const struct window *window);

#endif
