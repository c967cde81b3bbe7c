/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a gradient or a viscosity asks of a run. Defaults, plan, estimate, records of the neighbours
 * and the sums of 2D and 3D read these tables, so that none of them lists members by name. The
 * formulae stand in pair.h and, for gradients, in src/line/loop_gradient.c and src/cells. */
#ifndef SPHPROOF_TRAITS_H
#define SPHPROOF_TRAITS_H

#include <stdbool.h>

#include "families.h"

struct gradient_traits {
    bool matrix;   /* needs the inverse of a moment matrix */
    bool by_slope; /* the weight of that matrix is -W'/r, else W */
    bool blends;   /* takes the standard gradient's share from the gradient of h */
};

/* A viscosity for which nothing is said has fixed alpha and beta and needs nothing of its own. */
struct viscosity_traits {
    bool none;     /* adds no term to the pairs */
    bool midpoint; /* extrapolates velocities to the midpoint of the pair */
    bool noise;    /* adds the term that damps noise but not shear; has the signal form alone */
    bool evolves;  /* alpha of each particle follows div v */
    bool jumps;    /* alpha of each particle is set by a switch, once a step */
    bool slope;    /* needs the linear_exact velocity gradient, for the midpoint or the switch */
};

extern const struct gradient_traits traits_gradient[GRADIENTS];
extern const struct viscosity_traits traits_viscosity[VISCOSITIES];

#endif
