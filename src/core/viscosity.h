/* SPDX-License-Identifier: GPL-3.0-or-later
 * Artificial viscosities. A viscosity is one file in viscosity/ (formula, parameters, defaults,
 * paper: its descriptor) and one line in viscosities.def. A file says what its viscosity sees of a
 * pair, NAME_viscous; pair.h makes the term of CONVENTIONS eq. 5.7 or 6.2 of it, in 1D, 2D and 3D.
 * Defaults, plan, sums, records and estimates read the descriptors: none of them names a viscosity.
 */
#ifndef SPHPROOF_VISCOSITY_H
#define SPHPROOF_VISCOSITY_H

#include <math.h>

#include "families.h"
#include "family.h"
#include "particles.h"
#include "specialise.h"

/* What one particle brings into a pair; a term reads what it needs, and what none reads costs
 * nothing, as everything here is inlined. */
struct pair_side {
    double m, Z;      /* mass; what the density sum adds up: m, or U with the energy element */
    double V;         /* volume Z/y */
    double h_inverse; /* 1/h */
    double P, rho, c; /* pressure, density of the equation of state, sound speed */
    double alpha;     /* viscosity of the particle, where each has its own */
    double b, grad_h; /* lagrangian: Z P/y^2 and 1 - f */
    double slope;     /* midpoint: e . (grad v) e along the pair; in 1D dv/dx */
};

/* The numbers of the viscosity, the same for all pairs. */
struct pair_numbers {
    double alpha, beta; /* where all particles share them */
    double beta_ratio;  /* beta/alpha, where each particle has its own alpha */
    double near;        /* 1/eta */
    double noise;       /* nu */
};

/* A pair as a viscosity meets it. */
struct viscosity_pair {
    double r, closing; /* distance; -v_ij . e_ij, positive where the pair approaches */
    double factor;     /* Balsara's, the mean of both particles */
    double noise;      /* how fast noise closes: of descriptors that ask for it */
};

/* What it sees of it. */
struct viscosity_seen {
    double closing, scale;   /* closing/scale: the closing speed, at least 0 */
    double alpha_half, beta; /* half of the pair's alpha, for the sum of both sound speeds */
    double c_sum;            /* that sum */
    double factor;           /* of the term that alpha and beta make */
    double extra;            /* added to a_i and a_j for G = 1, whatever the term is */
};

/* A particle before the switch of its alpha, in 2D and 3D. */
struct viscosity_flow {
    int dim;
    const double *L;   /* grad v: d v_a/d x_b at a dim + b */
    double divergence; /* its trace */
    double change;     /* d(div v)/dt */
    double R;          /* mean of sign(div v), weighted by the kernel */
    double rate;       /* signal speed/h */
    double alpha_min, alpha_max;
};

struct viscosity_goal {
    double alpha, decay; /* what alpha jumps up to and decays to, and the rate of that */
};

struct viscosity_descriptor {
    struct member member;
    int least_dim;          /* of space, that it has a form in */
    const char *parameters; /* the keys of a run that it reads */
    struct {
        enum volume_element volume_element;
        enum balsara balsara;
        enum viscosity_form cloud_form; /* in 2D and 3D */
        enum pair_width predicted;      /* with integrators that predict */
    } defaults;
    bool none;     /* adds no term to the pairs */
    bool midpoint; /* closing is a quotient, from pair_side.slope: needs velocity gradients */
    bool noise;    /* reads viscosity_pair.noise; has the signal form alone */
    /* Alpha of each particle: sets dalpha of len particles, from div v; or is a switch, once a
     * step. NULL: neither. */
    void (*evolve)(const struct particles *particles, ptrdiff_t first, int len, double alpha_min,
                   double alpha_max);
    struct viscosity_goal (*find_goal)(const struct viscosity_flow *flow);
};

#define VISCOSITY(name, ...)
#include "viscosity/viscosities.def"
#undef VISCOSITY

/* By enum viscosity; constant for loops that are specialised. */
static const struct viscosity_descriptor viscosity_of[VISCOSITIES] = {
#define VISCOSITY(name, ...) {__VA_ARGS__},
#include "viscosity/viscosities.def"
#undef VISCOSITY
};

/* Has each particle an alpha of its own? */
ALWAYS_INLINE bool viscosity_varies(enum viscosity viscosity)
{
    return viscosity_of[viscosity].evolve || viscosity_of[viscosity].find_goal;
}

/* Does it need velocity gradients? */
ALWAYS_INLINE bool viscosity_needs_slope(enum viscosity viscosity)
{
    return viscosity_of[viscosity].midpoint || viscosity_of[viscosity].noise ||
           viscosity_of[viscosity].find_goal;
}

ALWAYS_INLINE struct viscosity_seen viscosity_sees(enum viscosity viscosity,
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
    return (struct viscosity_seen){0};
}

#endif
