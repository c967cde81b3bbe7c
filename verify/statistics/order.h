/* SPDX-License-Identifier: GPL-3.0-or-later
 * Orders of convergence with their uncertainty: least-squares slope of log(error) against
 * log(spacing) with its 95 % interval (Student t), pairwise orders, gates, and for scalar
 * functionals Richardson extrapolation and Roache's grid convergence index (Roache 1994; for
 * unequal ratios Celik et al. 2008). Spacing is any length that falls as the resolution grows:
 * N^(-1/d), h, dt. */
#ifndef SPHPROOF_ORDER_H
#define SPHPROOF_ORDER_H

#include <stdbool.h>
#include <stddef.h>

#include "status.h"

enum { ORDER_LEVELS_MIN = 4, ORDER_LEVELS_MAX = 64 };

#define ORDER_CLASS_LIST(CLASS)                                                                    \
    CLASS(ASYMPTOTIC, "asymptotic")       /* falls from level to level */                          \
    CLASS(FLOOR_LIMITED, "floor-limited") /* fell, and then stopped falling */                     \
    CLASS(OSCILLATING, "oscillating")     /* falls on the whole, not from level to level */        \
    CLASS(DIVERGING, "diverging")         /* does not fall, or is not finite */

enum order_class {
#define CLASS(name, text) ORDER_##name,
    ORDER_CLASS_LIST(CLASS)
#undef CLASS
};

/* The class as results and reports write it. */
const char *order_class_name(enum order_class class);

struct order_fit {
    double order, low, high; /* slope and its 95 % interval; NaN if an error is 0 or not finite */
    size_t n;                /* levels, coarsest first */
    double pairwise[ORDER_LEVELS_MAX - 1]; /* between levels i and i + 1 */
    double finest;                         /* error at the finest level */
    enum order_class class;
};

struct order_gate {
    double low, high; /* allowed order */
    double bound;     /* of the error at the finest level */
};

enum { ORDER_GATE_TEXT = 160 };
/* The widest interval with which an order still says something: half of its width. */
#define ORDER_HALF_WIDTH_MAX 0.15

/* spacing, error: n >= 4 levels, spacing strictly falling. variance: of log(error) at each level,
 * from replicates, > 0; NULL: equal weights. STATUS_BAD_INPUT: too few levels, spacings not
 * falling. */
enum status order_fit(size_t n, const double *spacing, const double *error, const double *variance,
                      struct order_fit *fit, struct error *failure);

/* Inside the gate AND half-width <= ORDER_HALF_WIDTH_MAX AND finest error <= bound. why (may be
 * NULL, else ORDER_GATE_TEXT bytes): the first condition that fails, "" if none does. */
bool order_passes(const struct order_fit *fit, const struct order_gate *gate, char *why);

struct order_extrapolation {
    double order;                /* observed; NaN unless the class is asymptotic */
    double value;                /* extrapolated to spacing 0; NaN likewise */
    double gci_fine, gci_coarse; /* fractions of the value, safety factor 1.25 */
    enum order_class class;      /* asymptotic, oscillating or diverging */
};

/* Of a functional at three levels, coarsest first, spacings strictly falling. */
struct order_extrapolation order_extrapolate(const double spacing[3], const double value[3]);

#endif
