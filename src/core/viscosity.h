/* SPDX-License-Identifier: GPL-3.0-or-later
 * Artificial viscosities. A viscosity is one file in viscosity/ (formula, parameters, defaults,
 * paper: its descriptor) and one line in viscosities.def. The file's function NAME_viscous computes
 * struct viscosity_terms of a pair, from which pair.h forms the term of CONVENTIONS eq. 5.7 or 6.2,
 * in 1D, 2D and 3D. Defaults, plan, sums, records and estimates use only the descriptors and name
 * no viscosity. */
#ifndef SPHPROOF_VISCOSITY_H
#define SPHPROOF_VISCOSITY_H

#include <math.h>

#include "families.h"
#include "family.h"
#include "particles.h"
#include "specialise.h"

/* The values of one particle of a pair. Everything here is inlined, so unused fields cost nothing.
 */
struct pair_side {
    double m, Z;      /* mass; summand of the density sum: m, or U with the energy element */
    double V;         /* volume Z/y */
    double h_inverse; /* 1/h */
    double P, rho, c; /* pressure, density of the equation of state, sound speed */
    double alpha;     /* if each particle has its own alpha */
    double b, grad_h; /* lagrangian: Z P/y^2 and 1 - f */
    double slope;     /* midpoint: e . (grad v) e along the pair; in 1D dv/dx */
};

/* Parameters of the viscosity, the same for all pairs. */
struct pair_numbers {
    double alpha, beta; /* if common to all particles */
    double beta_ratio;  /* beta/alpha, if each particle has its own alpha */
    double near;        /* 1/eta */
    double noise;       /* nu */
};

/* Input of a viscosity for one pair. */
struct viscosity_pair {
    double r, closing; /* distance; -v_ij . e_ij, positive if the pair approaches */
    double factor;     /* mean Balsara factor of both particles */
    double noise;      /* closing speed of noise; only if the descriptor has noise */
};

/* Output of a viscosity for one pair. */
struct viscosity_terms {
    double closing, scale;   /* closing/scale: the closing speed, at least 0 */
    double alpha_half, beta; /* half of the pair's alpha, as c_sum is a sum */
    double c_sum;            /* sum of both sound speeds */
    double factor;           /* multiplies the term of alpha and beta */
    double extra;            /* added to a_i and a_j for G = 1, in addition to that term */
};

/* Input of a switch for one particle, in 2D and 3D. */
struct viscosity_flow {
    int dim;
    const double *L;   /* grad v: d v_a/d x_b at a dim + b */
    double divergence; /* its trace */
    double change;     /* d(div v)/dt */
    double R;          /* kernel-weighted mean of sign(div v) */
    double rate;       /* signal speed/h */
    double alpha_min, alpha_max;
};

struct viscosity_goal {
    double alpha, decay; /* value that alpha jumps up to and decays to, and the decay rate */
};

struct viscosity_descriptor {
    struct member member;
    int least_dim;          /* lowest dimension that it is defined in */
    const char *parameters; /* keys of a run that it uses */
    struct {
        enum volume_element volume_element;
        enum balsara balsara;
        enum viscosity_form cloud_form; /* in 2D and 3D */
        enum pair_width predicted;      /* with integrators that predict h */
    } defaults;
    bool none;     /* no viscosity */
    bool midpoint; /* closing/scale is a quotient that uses pair_side.slope: needs velocity
                      gradients */
    bool noise;    /* uses viscosity_pair.noise; signal form only */
    /* For viscosities with an alpha of each particle: evolve sets dalpha of len particles from div
     * v; find_goal is a switch, called once per step. NULL: neither. */
    void (*evolve)(const struct particles *particles, ptrdiff_t first, int len, double alpha_min,
                   double alpha_max);
    struct viscosity_goal (*find_goal)(const struct viscosity_flow *flow);
};

#define VISCOSITY(name, ...)
#include "viscosity/viscosities.def"
#undef VISCOSITY

/* By enum viscosity; constant, for specialised loops. */
static const struct viscosity_descriptor viscosity_of[VISCOSITIES] = {
#define VISCOSITY(name, ...) {__VA_ARGS__},
#include "viscosity/viscosities.def"
#undef VISCOSITY
};

/* True if each particle has its own alpha. */
ALWAYS_INLINE bool viscosity_varies(enum viscosity viscosity)
{
    return viscosity_of[viscosity].evolve || viscosity_of[viscosity].find_goal;
}

/* True if the viscosity needs velocity gradients. */
ALWAYS_INLINE bool viscosity_needs_slope(enum viscosity viscosity)
{
    return viscosity_of[viscosity].midpoint || viscosity_of[viscosity].noise ||
           viscosity_of[viscosity].find_goal;
}

ALWAYS_INLINE struct viscosity_terms viscosity_terms_of(enum viscosity viscosity,
                                                        const struct pair_numbers *numbers,
                                                        const struct pair_side *i,
                                                        const struct pair_side *j,
                                                        const struct viscosity_pair *pair)
{
    switch (viscosity) {
#define VISCOSITY_CASE(symbol, name, ...)                                                          \
    case symbol:                                                                                   \
        return name##_viscous(numbers, i, j, pair);
        VISCOSITY_LIST(VISCOSITY_CASE, )
#undef VISCOSITY_CASE
    }
    return (struct viscosity_terms){0};
}

#endif
