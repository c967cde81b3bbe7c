/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the neighbours of particles make of their gradients: how many there are, how well the moment
 * matrix T of gradient=ia and gradient=corrected can be inverted, and how far C x, C = T^-1, along
 * which two particles push, points away from x, the line between them (CONVENTIONS eqs. 4.3 to
 * 4.7): beyond a right angle they attract. For reports, not a fast loop. */
#ifndef SPHPROOF_DESCRIPTION_H
#define SPHPROOF_DESCRIPTION_H

#include <stddef.h>

struct simulation;

/* Beyond this condition number of a moment matrix, in the 2-norm, its inverse points anywhere. */
#define DESCRIPTION_CONDITION 1e3

struct description {
    double neighbours; /* within h, the particle itself and images included */
    double condition;  /* of T in the 2-norm: beyond that the standard gradient stands in; NaN: the
                          gradient needs no matrix */
    double angle; /* largest one between C x and x of a neighbour, degrees; NaN: C is not used, or
                     there is no neighbour */
};

/* particle: its place in the snapshot. */
typedef void description_visit(void *context, size_t particle, const struct description *of);

/* Of all particles, in any order, right after simulation_create; later those that sleep have lost
 * their neighbours. */
void description_each(const struct simulation *simulation, description_visit *visit, void *context);

/* Over the particles whose matrix is used; NaN where there are none. */
struct description_sums {
    double condition_max, condition_mean, angle_max, angle_mean; /* degrees */
    size_t fallen_back; /* particles whose matrix is not: their pairs use the standard gradient */
};

/* Of the present state, after simulation_create or simulation_run. */
struct description_sums description_sum(struct simulation *simulation);

#endif
