/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gradients of the equations of motion. A gradient is one file in gradient/ (its formula and its
 * descriptor) and one line in gradients.def. With x = r_j - r_i the pair gradient is G_i = x times
 * a weight, times either the inverse C_i of the moments sum_j V_j x x^T weight, or the number C_d
 * h^-(d+2). Plan, sums, records and estimates use only the descriptors and name no gradient. */
#ifndef SPHPROOF_GRADIENT_H
#define SPHPROOF_GRADIENT_H

#include "families.h"
#include "family.h"
#include "specialise.h"

/* Arguments of the weight. */
enum gradient_weight {
    WEIGHT_NONE,  /* no matrix: the gradient of the kernel itself */
    WEIGHT_W,     /* w(q); velocity gradients can use the same moments */
    WEIGHT_SLOPE, /* a function of -w'(q)/q */
    WEIGHT_BOTH   /* a function of w(q) and -w'(q)/q */
};

struct gradient_descriptor {
    struct member member;
    int least_dim; /* lowest dimension that it is defined in */
    enum gradient_weight weight;
    /* Weight of the standard gradient at a particle, from steepness = |grad h|; NULL: none. */
    double (*share)(double steepness);
};

#define GRADIENT(name, ...)
#include "gradient/gradients.def"
#undef GRADIENT

/* By enum gradient; constant, for specialised loops. */
static const struct gradient_descriptor gradient_of[GRADIENTS] = {
#define GRADIENT(name, ...) {__VA_ARGS__},
#include "gradient/gradients.def"
#undef GRADIENT
};

/* The weight of x; slope: -w'(q)/q. Arguments that the descriptor does not need may be anything. */
ALWAYS_INLINE double gradient_weight(enum gradient gradient, double w, double slope)
{
    switch (gradient) {
#define GRADIENT_CASE(symbol, name, ...)                                                           \
    case symbol:                                                                                   \
        return name##_weight(w, slope);
        GRADIENT_LIST(GRADIENT_CASE, )
#undef GRADIENT_CASE
    }
    return 0;
}

#endif
