/* SPDX-License-Identifier: GPL-3.0-or-later
 * Storage of the solver: structure of arrays, vectors by component. In 1D they are sorted by
 * position, with ghost copies of images at both ends, so that no inner loop knows of a boundary
 * (ghosts is 0 where none are kept). Every array has indices -ghosts .. n-1+ghosts.
 * Positions are unwrapped: x may leave the box. */
#ifndef SPHPROOF_PARTICLES_H
#define SPHPROOF_PARTICLES_H

#include <math.h>
#include <stddef.h>

#include "serialiser.h"
#include "status.h"

/* SCALAR(name, meaning) or VECTOR(name, meaning). The first group is the state, the rest is derived
 * in an evaluation or belongs to the integrator; a change of order permutes them all. */
#define PARTICLE_FIELDS(SCALAR, VECTOR)                                                            \
    VECTOR(x, "position")                                                                          \
    VECTOR(x_old, "position kept by the integrator")                                               \
    SCALAR(m, "mass")                                                                              \
    SCALAR(m_inverse, "1/m")                                                                       \
    VECTOR(p, "momentum")                                                                          \
    SCALAR(e, "energy that is integrated: U = m u, or E = U + p^2/2m")                             \
    SCALAR(alpha, "viscosity of the particle")                                                     \
    VECTOR(p_old, "momentum kept by the integrator")                                               \
    SCALAR(e_old, "energy kept by the integrator")                                                 \
    SCALAR(alpha_old, "viscosity kept by the integrator")                                          \
    VECTOR(v, "velocity")                                                                          \
    SCALAR(U, "internal energy")                                                                   \
    SCALAR(h, "smoothing length = support radius")                                                 \
    SCALAR(h_inverse, "1/h")                                                                       \
    SCALAR(h_inverse_found, "1/h by a Newton step from the last density sum")                      \
    SCALAR(h_inverse_old, "and of the one before")                                                 \
    SCALAR(grad_h, "1 - f of the grad-h factor")                                                   \
    SCALAR(V, "volume Z/y")                                                                        \
    SCALAR(rho, "density of the equation of state")                                                \
    SCALAR(P, "pressure")                                                                          \
    SCALAR(c, "sound speed")                                                                       \
    SCALAR(b, "lagrangian: Z P/y^2")                                                               \
    SCALAR(g, "scale of the pair gradient: C/h^(d+1) (standard); 1D: 1/sum V x^2 w (ia)")          \
    SCALAR(dv, "1D: velocity gradient, linear_exact")                                              \
    VECTOR(F, "dp/dt")                                                                             \
    SCALAR(de, "de/dt")                                                                            \
    SCALAR(dalpha, "dalpha/dt")                                                                    \
    SCALAR(div_v, "divergence of v")                                                               \
    SCALAR(signal, "largest signal speed")                                                         \
    SCALAR(level, "local steps: of the particle")                                                  \
    SCALAR(pace, "inverse of the time step that is asked for, times cfl")                          \
    SCALAR(near_pace, "the largest one of its neighbours")                                         \
    SCALAR(before, "its last step")                                                                \
    SCALAR(ratio, "time since its last density sum, over that between the last two")               \
    SCALAR(span, "from its last density sum but one to its last one")                              \
    VECTOR(F_mean, "mean dp/dt, for predictions")                                                  \
    SCALAR(de_mean, "mean de/dt")                                                                  \
    VECTOR(impulse, "from pairs of finer levels, since the step began")                            \
    SCALAR(heat, "and the energy")

struct particles {
    int dim; /* components of vectors; the others are NULL */
    ptrdiff_t n;
    ptrdiff_t ghosts; /* images at each end */
    double period[3]; /* lengths of the box */
#define SCALAR(name, meaning) double *name;
#define VECTOR(name, meaning) double *name[3];
    PARTICLE_FIELDS(SCALAR, VECTOR)
#undef SCALAR
#undef VECTOR
    size_t *id;    /* index in the setup */
    double *block; /* what the arrays live in */
    double *spare; /* one array, for permutations and snapshots */
    size_t *order; /* likewise: where the particle that belongs at place i stands */
};

/* Allocates everything (zeros). STATUS_ENVIRONMENT without memory. */
enum status particles_create(struct particles *particles, int dim, ptrdiff_t n, ptrdiff_t ghosts,
                             struct error *error);
void particles_destroy(struct particles *particles);

/* Makes room for more ghosts, keeping all values. Invalidates pointers to arrays. */
enum status particles_grow_ghosts(struct particles *particles, ptrdiff_t ghosts,
                                  struct error *error);

/* All values, those of ghosts included. Back: may invalidate pointers to arrays; fails without
 * memory for as many ghosts. */
void particles_serialise(struct particles *particles, struct serialiser *serialiser);

/* Puts the particle at place order[i] to place i, all of its values. Ghosts are not touched. */
void particles_permute(struct particles *particles);

/* Size of the vector of particle i; in 1D exactly |vector[0][i]|. */
static inline double particles_norm(const struct particles *particles, double *const vector[3],
                                    ptrdiff_t i)
{
    if (particles->dim == 1) return fabs(vector[0][i]);
    double squares = 0;
    for (int k = 0; k < particles->dim; k++) squares += vector[k][i] * vector[k][i];
    return sqrt(squares);
}

#endif
