/* SPDX-License-Identifier: GPL-3.0-or-later
 * Storage of the solver: structure of arrays, in 1D sorted by position, with ghost copies of the
 * periodic images at both ends, so that no inner loop knows of a boundary. Every array has indices
 * -ghosts .. n-1+ghosts. Positions are unwrapped: x may leave the box, the cyclic order counts. */
#ifndef SPHPROOF_PARTICLES_H
#define SPHPROOF_PARTICLES_H

#include <stdbool.h>
#include <stddef.h>

#include "status.h"

/* FIELD(name, meaning). The first group is the state, the rest is derived in an evaluation or
 * belongs to the integrator; a change of order permutes them all. */
#define PARTICLE_FIELDS(FIELD)                                                                     \
    FIELD(x, "position")                                                                           \
    FIELD(x_old, "position kept by the integrator")                                                \
    FIELD(m, "mass")                                                                               \
    FIELD(m_inverse, "1/m")                                                                        \
    FIELD(p, "momentum")                                                                           \
    FIELD(e, "energy that is integrated: U = m u, or E = U + p^2/2m")                              \
    FIELD(alpha, "viscosity of the particle")                                                      \
    FIELD(p_old, "momentum kept by the integrator")                                                \
    FIELD(e_old, "energy kept by the integrator")                                                  \
    FIELD(alpha_old, "viscosity kept by the integrator")                                           \
    FIELD(v, "velocity")                                                                           \
    FIELD(U, "internal energy")                                                                    \
    FIELD(h, "smoothing length = support radius")                                                  \
    FIELD(h_inverse, "1/h")                                                                        \
    FIELD(h_inverse_found, "1/h = rho/(eta m) of the last density sum")                            \
    FIELD(h_inverse_old, "and of the one before")                                                  \
    FIELD(grad_h, "1 - f of the grad-h factor")                                                    \
    FIELD(V, "volume Z/y")                                                                         \
    FIELD(rho, "density of the equation of state")                                                 \
    FIELD(P, "pressure")                                                                           \
    FIELD(c, "sound speed")                                                                        \
    FIELD(b, "lagrangian: Z P/y^2")                                                                \
    FIELD(g, "scale of the pair gradient: C/h^2 (standard), 1/sum V x^2 w (ia)")                   \
    FIELD(dv, "velocity gradient, linear_exact")                                                   \
    FIELD(F, "dp/dt")                                                                              \
    FIELD(de, "de/dt")                                                                             \
    FIELD(dalpha, "dalpha/dt")                                                                     \
    FIELD(div_v, "divergence of v")                                                                \
    FIELD(signal, "largest signal speed")

struct particles {
    ptrdiff_t n;
    ptrdiff_t ghosts; /* images at each end */
    double period;    /* length of the box */
#define FIELD(name, meaning) double *name;
    PARTICLE_FIELDS(FIELD)
#undef FIELD
    size_t *id;    /* index in the scene */
    double *block; /* what the arrays live in */
    double *spare; /* one array, for permutations */
    size_t *order; /* likewise */
};

/* Allocates everything (zeros). STATUS_ENVIRONMENT without memory. */
enum status particles_create(struct particles *particles, ptrdiff_t n, ptrdiff_t ghosts,
                             struct error *error);
void particles_destroy(struct particles *particles);

/* Makes room for more ghosts, keeping all values. Invalidates pointers to arrays. */
enum status particles_grow_ghosts(struct particles *particles, ptrdiff_t ghosts,
                                  struct error *error);

/* Copies the periodic images of count particles to both ends of an array; shift: what is added per
 * period (the period for x, 0 for the rest). */
void particles_fill_ghosts(const struct particles *particles, double *array, ptrdiff_t count,
                           double shift);

/* Restores the order of positions, also across the ends of the box. false: a position is not
 * finite, and nothing has been done. */
bool particles_sort(struct particles *particles);

#endif
