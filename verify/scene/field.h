/* SPDX-License-Identifier: GPL-3.0-or-later
 * What errors are measured of, in which norms, and where: the fields of a gas, the domain that it
 * fills, and the window that is looked at. Code units. */
#ifndef SPHPROOF_FIELD_H
#define SPHPROOF_FIELD_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

#include "family.h"

enum field { FIELD_DENSITY, FIELD_VELOCITY, FIELD_PRESSURE, FIELD_INTERNAL_ENERGY, FIELDS };
enum norm { NORM_L1, NORM_L2, NORM_LINF, NORM_PARTICLE_MEAN, NORMS };
extern const struct family field_family, norm_family;

/* The box, periodic in each direction; lo < hi where d < dim. */
struct domain {
    int dim;
    double lo[3], hi[3];
};

double domain_length(const struct domain *domain, int direction);

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
