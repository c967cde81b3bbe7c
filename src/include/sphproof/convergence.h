/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file
 * Error norms, orders of convergence and gates. */
#ifndef SPHPROOF_PUBLIC_CONVERGENCE_H
#define SPHPROOF_PUBLIC_CONVERGENCE_H

#include <sphproof/common.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Norms of value - exact, in the unit of value; any NaN makes all of them NaN. */
struct sphproof_norms {
    double l1;   /**< sum V |value - exact| / sum V */
    double l2;   /**< sqrt(sum V (value - exact)^2 / sum V) */
    double linf; /**< max |value - exact| */
    double mean; /**< sum |value - exact| / n */
};

/** Norms of n values against the exact values at the same positions; volume: n weights V, finite
 * and 0 or more, not all 0, or NULL for equal weights. SPHPROOF_BAD_INPUT: n = 0, or such a weight.
 */
enum sphproof_status sphproof_convergence_norms(size_t n, const double *volume, const double *value,
                                                const double *exact, struct sphproof_norms *norms,
                                                struct sphproof_error *error);

/** An order of convergence. */
struct sphproof_order {
    double order;  /**< slope of log(error) against log(spacing), least squares */
    double low;    /**< of its 95 % interval (Student t) */
    double high;   /**< of its 95 % interval; all NaN where an error is 0 or not finite */
    double finest; /**< error at the finest level */
    const char
        *kind; /**< "asymptotic", "floor-limited", "pre-asymptotic", "oscillating", "diverging" */
};

/** Fits the order of n = 4 to 64 errors, coarsest first; spacing (a length: n^(-1/d), h, dt) must
 * decrease strictly. SPHPROOF_BAD_INPUT: too few or too many errors, or spacings that do not
 * decrease. */
enum sphproof_status sphproof_convergence_order(size_t n, const double *spacing,
                                                const double *error_at,
                                                struct sphproof_order *order,
                                                struct sphproof_error *error);

/** Requirements on an order. */
struct sphproof_gate {
    double low;   /**< least order */
    double high;  /**< largest order, since an order that is too high is suspicious */
    double bound; /**< largest error at the finest level */
};

/** Checks that the order is inside the gate, that its 95 % interval is at most 0.15 wide to either
 * side, and that the finest error is within its bound. SPHPROOF_CHECK_FAILED: the error names the
 * first condition that fails. */
enum sphproof_status sphproof_convergence_gate(const struct sphproof_order *order,
                                               const struct sphproof_gate *gate,
                                               struct sphproof_error *error);

#ifdef __cplusplus
}
#endif

#endif
