/* SPDX-License-Identifier: GPL-3.0-or-later
 * Quality of the gradients of particles: the number of neighbours, the condition number of the
 * moment matrix T of gradient=ia and gradient=corrected, and the largest angle between C x, C =
 * T^-1, the direction of the pair force, and x, the line between the two particles (CONVENTIONS
 * eqs. 4.3 to 4.7): beyond a right angle they attract. For reports, not for fast loops. */
#ifndef SPHPROOF_DESCRIPTION_H
#define SPHPROOF_DESCRIPTION_H

#include <stddef.h>

struct simulation;

/* Largest condition number of a usable moment matrix, in the 2-norm; beyond it the direction of C x
 * is arbitrary. */
#define DESCRIPTION_CONDITION 1e3

struct description {
    double neighbours; /* number within h, including the particle itself and images */
    double condition;  /* of T in the 2-norm; above DESCRIPTION_CONDITION the standard gradient
                          replaces it; NaN: the gradient needs no matrix */
    double angle; /* largest angle between C x and x over the neighbours, degrees; NaN: C is not
                     used, or there is no neighbour */
};

/* particle: its index in the snapshot. */
typedef void description_visit(void *context, size_t particle, const struct description *of);

/* Calls visit for all particles, in any order. Call it right after simulation_create: later,
 * sleeping particles have no neighbour lists. */
void description_each(const struct simulation *simulation, description_visit *visit, void *context);

/* Over the particles with a usable matrix; NaN if there are none. */
struct description_sums {
    double condition_max, condition_mean, angle_max, angle_mean; /* degrees */
    size_t fallen_back; /* particles without a usable matrix: standard gradient instead */
};

/* For the current state, after simulation_create or simulation_run. */
struct description_sums description_sum(struct simulation *simulation);

#endif
