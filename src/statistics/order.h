/* SPDX-License-Identifier: GPL-3.0-or-later
 * Orders of convergence with their uncertainty: least-squares slope of log(error) against
 * log(spacing) with its 95 % interval (Student t), pairwise orders, gates, and for scalar
 * functionals Richardson extrapolation and Roache's grid convergence index (Roache 1994; for
 * unequal ratios Celik et al. 2008). Spacing is any length that falls as the resolution grows:
 * N^(-1/d), h, dt. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "status.h"

enum { ORDER_LEVELS_MIN = 4, ORDER_LEVELS_MAX = 64 };

#define ORDER_CLASS_LIST(CLASS)                                                                    \
    CLASS(ASYMPTOTIC, "asymptotic")        /* decreases from level to level */                     \
    CLASS(FLOOR_LIMITED, "floor-limited")  /* does not decrease any more, or never did */          \
    CLASS(PREASYMPTOTIC, "pre-asymptotic") /* decreases, but not yet towards the exact value */    \
    CLASS(OSCILLATING, "oscillating")      /* decreases on the whole, not from level to level */   \
    CLASS(DIVERGING, "diverging")          /* does not decrease, or is not finite */

enum order_class {
#define CLASS(name, text) ORDER_##name,
    ORDER_CLASS_LIST(CLASS)
#undef CLASS
};

/* The name of a class in results and reports. */
const char *order_class_name(enum order_class class);

struct order_fit {
    double order, low, high; /* slope and its 95 % interval; NaN if an error is 0 or not finite */
    size_t n;                /* levels, coarsest first */
    double pairwise[ORDER_LEVELS_MAX - 1]; /* between levels i and i + 1 */
    double coarsest, finest;               /* errors at the ends */
    enum order_class class;
};

struct order_gate {
    double low, high; /* allowed order */
    double bound;     /* of the error at the finest level */
};

enum { ORDER_GATE_TEXT = 160 };
/* Largest half-width of the interval of a meaningful order. */
#define ORDER_HALF_WIDTH_MAX 0.15

/* An order closer to 0 than this over all levels counts as none: the error is at a floor. */
#define ORDER_FLAT 0.1

/* Noise from replicates: variance of the mean log(error) at each level (the variance of the
 * replicates divided by their number, >= 2 at each level). */
struct order_noise {
    const double *variance;
    size_t replicates;
};

/* spacing, error: n >= 4 levels, spacing strictly falling. With noise (error: geometric means of
 * the replicates) levels weigh by their variances, and the interval comes from these, unless the
 * levels do not lie on a line; without (NULL) weights are equal and the interval comes from the
 * scatter about the line. STATUS_BAD_INPUT: too few levels, spacings not falling. */
enum status order_fit(size_t n, const double *spacing, const double *error,
                      const struct order_noise *noise, struct order_fit *fit,
                      struct error *failure);

/* Inside the gate AND half-width <= ORDER_HALF_WIDTH_MAX AND finest error <= bound. why (may be
 * NULL, else ORDER_GATE_TEXT bytes): the first condition that fails, "" if none does. */
bool order_passes(const struct order_fit *fit, const struct order_gate *gate, char *why);

struct order_extrapolation {
    double order;                /* observed; NaN unless the class is asymptotic */
    double value;                /* extrapolated to spacing 0; NaN unless the class is asymptotic */
    double gci_fine, gci_coarse; /* fractions of the value, safety factor 1.25 */
    enum order_class class;
};

/* For a functional at three levels, coarsest first, spacings strictly decreasing. exact: its exact
 * value, NaN if unknown; a sequence that converges to another value, or whose error does not
 * decrease at the finest level, is not called asymptotic. */
struct order_extrapolation order_extrapolate(const double spacing[3], const double value[3],
                                             double exact);
