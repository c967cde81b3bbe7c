/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gradient operators on a cloud of points: an estimate of grad f at r_i from f_j and V_j of the
 * points with |r_j - r_i| < h_i, in 1, 2 and 3 dimensions. With x = r_j - r_i, W = W(|x|, h_i):
 *
 *   grad f = A sum_j V_j (f_j - [f_i]) p_j,   A = 1 or (sum_j V_j p_j (x) x)^-1,
 *
 * where the pair vector p_j is grad_i W, x W, or the gradient of the kernel normalised by
 * S = sum V W; all sums include j = i. The operators are such choices (operators.def);
 * the factor of W cancels where A is an inverse. For f linear with slope a, sum V (f_j - f_i) p =
 * (sum V p (x) x) a, which places the indices of A: the row belongs to x, the column to p. */
#ifndef SPHPROOF_OPERATOR_H
#define SPHPROOF_OPERATOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "families.h"
#include "family.h"
#include "kernel.h"
#include "neighbours.h"

/* VECTOR(symbol, tag): a list like those of families.h, for the enum and for tables of loops. */
#define VECTOR_LIST(VECTOR, ...)                                                                   \
    VECTOR(VECTOR_GRADIENT, gradient, __VA_ARGS__)     /* grad_i W = -(x/|x|) dW/dr */             \
    VECTOR(VECTOR_POSITION, position, __VA_ARGS__)     /* x W */                                   \
    VECTOR(VECTOR_NORMALISED, normalised, __VA_ARGS__) /* (grad_i W - (W/S) sum V grad W)/S */
enum pair_vector { VECTOR_LIST(FAMILY_SYMBOL, ) };
enum { PAIR_VECTORS = 0 VECTOR_LIST(FAMILY_COUNTED, ) };

struct operator_form {
    struct member member;
    enum pair_vector pair_vector;
    bool difference; /* f_j - f_i; with normalised vectors, which sum to 0, it only saves digits */
    bool corrected;  /* A is the inverse matrix */
    /* properties for the checks: polynomials of lower degree are exact everywhere; in the interior
     * of a lattice with its cells as volumes */
    int exact, exact_on_lattice;
};

extern const struct family operator_family;

enum operator_state {
    OPERATOR_OK,
    OPERATOR_TOO_FEW_NEIGHBOURS, /* fewer than dim + 1, the point itself included */
    OPERATOR_ILL_CONDITIONED,    /* condition above OPERATOR_CONDITION_MAX */
    OPERATOR_SINGULAR,           /* no inverse in double precision */
    OPERATOR_OVERFLOW,           /* a gradient is not a finite number */
    OPERATOR_UNDERFLOW,          /* a gradient is too small for a normal number: digits are lost */
};
#define OPERATOR_CONDITION_MAX 1e6 /* above it, fewer than ten digits remain */

struct operator_point {
    uint32_t neighbours; /* points with |x| < h, including itself and periodic images */
    enum operator_state state;
    double condition; /* 2-norm, of sum V p (x) x; uncorrected operators: of T = sum V W x (x) x */
};

struct cloud { /* arrays of n; the caller owns them */
    struct points points;
    const double *volume; /* > 0 */
    const double *h;      /* support radius, > 0 */
};

struct operator_settings {
    const struct operator_form *form;
    const struct kernel *kernel;
    bool generic; /* call the kernel's function pointers: the oracle of the specialised loops */
    int threads;  /* >= 1; the result does not depend on it */
};

/* Gradients of `fields` fields at once: component a of the gradient of f[k] at point i goes to
 * gradient[k * dim + a][i]. Any units are allowed (units.h). A point without the inverse matrix
 * that the operator needs gets NaN. point: array of n, or NULL, which is faster; pairs: receives
 * the number of pairs summed, or NULL. STATUS_BAD_INPUT: h, volume or a coordinate out of range
 * (the message names the point); STATUS_ENVIRONMENT: no memory. */
enum status operator_apply(const struct operator_settings *settings, const struct cloud *cloud,
                           size_t fields, const double *const *f, double *const *gradient,
                           struct operator_point *point, uint64_t *pairs, struct error *error);

/* "ok", "too_few_neighbours", "ill_conditioned", "singular", "overflow", "underflow" */
const char *operator_state_name(enum operator_state state);

#endif
