/* SPDX-License-Identifier: GPL-3.0-or-later
 * The properties that every kernel must have (CONVENTIONS section 2), each measured by one function
 * in property/. The certificate of a kernel and the checks of group `kernels` read the same list,
 * properties.def. */
#pragma once

#include <stddef.h>

#include "finding.h"
#include "pieces.h"

/* Receives the figures of a property: of a finding the subject (position, or why there is none),
 * value, bound and floor as in check.h, and whether it passes, fails or was skipped. */
struct property_sink {
    void (*take)(struct property_sink *sink, const struct finding *figure);
};

struct property {
    const char *name;
    const char *formula; /* one line */
    void (*measure)(const struct pieces *pieces, struct property_sink *sink);
};

#define PROPERTY(name, rank, says, formula)                                                        \
    void property_##name(const struct pieces *pieces, struct property_sink *sink);
#include "properties.def"
#undef PROPERTY

extern const struct property property_list[];
extern const size_t property_count;

/* Passes a figure on; where is printf-like. */
void property_take(struct property_sink *sink, double value, double bound, double floor,
                   const char *where, ...) __attribute__((format(printf, 5, 6)));
void property_skip(struct property_sink *sink, const char *why, ...)
    __attribute__((format(printf, 2, 3)));

/* Judges the figure as that of a kernel that computes in float. */
struct finding property_single(const struct finding *figure);

/* The worst of many figures: the one with the largest value/bound (a NaN is worst of all). */
struct property_worst {
    double value, bound, floor;
    char where[96];
};

void property_keep(struct property_worst *worst, double value, double bound, double floor,
                   const char *where, ...) __attribute__((format(printf, 5, 6)));
/* Passes the worst figure on; without one NaN, a failure. */
void property_take_worst(struct property_sink *sink, const struct property_worst *worst);

/* Smoothing lengths at which all properties are measured. */
enum { PROPERTY_WIDTHS = 4 };
extern const double property_width[PROPERTY_WIDTHS];

/* Bound of a figure that vanishes up to quadrature and rounding: base if the floor is far below it,
 * else 20 floors, at most `PROPERTY_BOUND_MAX`. */
#define PROPERTY_BOUND_MAX 1e-9
double property_bound(double base, double floor);
