/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file
 * Error norms, orders of convergence and gates. */
#ifndef SPHPROOF_PUBLIC_CONVERGENCE_H
#define SPHPROOF_PUBLIC_CONVERGENCE_H

#include <sphproof/common.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Norms of value - exact, in the unit of value; a NaN among the values makes each NaN. */
struct sphproof_norms {
    double l1;   /**< sum V |value - exact| / sum V */
    double l2;   /**< sqrt(sum V (value - exact)^2 / sum V) */
    double linf; /**< max |value - exact| */
    double mean; /**< sum |value - exact| / n */
};

/** Of n values and the exact ones at their places; volume: n weights V, or NULL for equal ones.
 * SPHPROOF_BAD_INPUT: n = 0. */
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

/** Of n >= 4 errors, coarsest first; spacing (a length: n^(-1/d), h, dt) falls strictly.
 * SPHPROOF_BAD_INPUT: too few, or they do not fall. */
enum sphproof_status sphproof_convergence_order(size_t n, const double *spacing,
                                                const double *error_at,
                                                struct sphproof_order *order,
                                                struct sphproof_error *error);

/** What is asked of an order. */
struct sphproof_gate {
    double low;   /**< order at least */
    double high;  /**< order at most: too good is suspicious, too */
    double bound; /**< of the error at the finest level */
};

/** Is the order inside the gate, its 95 % interval no wider than 0.15 either way and the finest
 * error within its bound? SPHPROOF_CHECK_FAILED: no; the error says which condition fails first. */
enum sphproof_status sphproof_convergence_gate(const struct sphproof_order *order,
                                               const struct sphproof_gate *gate,
                                               struct sphproof_error *error);

#ifdef __cplusplus
}
#endif

#endif
