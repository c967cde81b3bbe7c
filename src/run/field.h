/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fields of a gas, the norms of their errors, the domain of the gas, and the window in which errors
 * are measured. Code units. */
#pragma once

#include <math.h>
#include <stdbool.h>

#include "family.h"

enum field { FIELD_DENSITY, FIELD_VELOCITY, FIELD_PRESSURE, FIELD_INTERNAL_ENERGY, FIELDS };
enum norm { NORM_L1, NORM_L2, NORM_LINF, NORM_PARTICLE_MEAN, NORM_L1_WHOLE, NORMS };
extern const struct family field_family, field_norm_family;

/* In code units; densities are per length, area or volume according to dim. */
const char *field_unit(enum field field, int dim);

/* A box, periodic in each direction; lo < hi for d < dim. */
struct domain {
    int dim;
    double lo[3], hi[3];
};

static inline double domain_length(const struct domain *domain, int direction)
{
    return domain->hi[direction] - domain->lo[direction];
}

/* Length, area or volume of the box. */
static inline double domain_volume(const struct domain *domain)
{
    double volume = 1;
    for (int d = 0; d < domain->dim; d++) volume *= domain_length(domain, d);
    return volume;
}

/* Mean spacing of n particles. */
static inline double domain_spacing(const struct domain *domain, size_t n)
{
    return pow(domain_volume(domain) / (double)n, 1. / domain->dim);
}

static inline double domain_shortest(const struct domain *domain)
{
    double shortest = HUGE_VAL;
    for (int d = 0; d < domain->dim; d++) shortest = fmin(shortest, domain_length(domain, d));
    return shortest;
}

/* Position of the periodic image in the box; after rounding it may be the upper end. */
static inline double domain_wrap(const struct domain *domain, int direction, double x)
{
    const double lo = domain->lo[direction], length = domain_length(domain, direction);
    return lo + (x - lo - length * floor((x - lo) / length));
}

/* Position relative to the lower corner of the box, as most codes expect it. For x in the box the
 * result is smaller than the box length even after rounding. */
static inline double domain_offset(const struct domain *domain, int direction, double x)
{
    const double from = x - domain->lo[direction], length = domain_length(domain, direction);
    return from >= length && x < domain->hi[direction] ? nextafter(length, 0) : from;
}

/* Where errors are measured: an interval, rectangle or box including its sides (radius 0), or a
 * disc or ball. */
struct window {
    int dim;
    double lo[3], hi[3]; /* of a ball: its bounding box */
    double centre[3], radius;
};

static inline bool window_contains(const struct window *window, const double x[3])
{
    double square = 0;
    for (int d = 0; d < window->dim; d++) {
        if (!(x[d] >= window->lo[d] && x[d] <= window->hi[d])) return false;
        square += (x[d] - window->centre[d]) * (x[d] - window->centre[d]);
    }
    return window->radius == 0 || square <= window->radius * window->radius;
}
