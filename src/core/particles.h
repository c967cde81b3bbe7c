/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particle storage: structure of arrays, vectors by component. In 1D particles are sorted by
 * position, with ghost copies of images at both ends, so that inner loops need no boundary
 * conditions (otherwise ghosts is 0). Every array has indices -ghosts .. n-1+ghosts. Positions are
 * unwrapped: x may leave the box. */
#ifndef SPHPROOF_PARTICLES_H
#define SPHPROOF_PARTICLES_H

#include <math.h>
#include <stddef.h>

#include "serialiser.h"
#include "status.h"

/* Uses of an array. An array that a run does not use is never touched, and so takes no memory:
 * reading it may allocate memory, and written values are lost. */
enum particle_use {
    USE_ALWAYS = 1 << 0,
    USE_START = 1 << 1, /* the start of a step, kept by the integrator */
    USE_PREDICTED_WIDTH = 1 << 2,
    USE_GRAD_H = 1 << 3,
    USE_ALPHA = 1 << 4,
    USE_ALPHA_RATE = 1 << 5,
    USE_PAIR_SCALE = 1 << 6,
    USE_SLOPE = 1 << 7,
    USE_SIGNAL = 1 << 8,
    USE_LOCAL_STEPS = 1 << 9,
    USE_SHIFT = 1 << 10,
    USE_ALL = (1 << 11) - 1,
};

/* SCALAR(name, use, meaning) or VECTOR(name, use, meaning). The first group is the state; the
 * others are computed in an evaluation or belong to the integrator. A change of order permutes all.
 */
#define PARTICLE_FIELDS(SCALAR, VECTOR)                                                            \
    VECTOR(x, USE_ALWAYS, "position")                                                              \
    VECTOR(x_old, USE_ALWAYS, "position kept by the integrator")                                   \
    SCALAR(m, USE_ALWAYS, "mass")                                                                  \
    SCALAR(m_inverse, USE_ALWAYS, "1/m")                                                           \
    VECTOR(p, USE_ALWAYS, "momentum")                                                              \
    SCALAR(e, USE_ALWAYS, "energy that is integrated: U = m u, or E = U + p^2/2m")                 \
    SCALAR(alpha, USE_ALPHA, "viscosity of the particle")                                          \
    VECTOR(p_old, USE_START, "momentum kept by the integrator")                                    \
    SCALAR(e_old, USE_START, "energy kept by the integrator")                                      \
    SCALAR(alpha_old, USE_ALPHA, "viscosity kept by the integrator")                               \
    VECTOR(v, USE_ALWAYS, "velocity")                                                              \
    SCALAR(U, USE_ALWAYS, "internal energy")                                                       \
    SCALAR(h, USE_ALWAYS, "smoothing length = support radius")                                     \
    SCALAR(h_inverse, USE_ALWAYS, "1/h")                                                           \
    SCALAR(h_inverse_found, USE_ALWAYS, "1/h by a Newton step from the last density sum")          \
    SCALAR(h_inverse_old, USE_PREDICTED_WIDTH, "and of the one before")                            \
    SCALAR(grad_h, USE_GRAD_H, "1 - f of the grad-h factor")                                       \
    SCALAR(V, USE_ALWAYS, "volume Z/y")                                                            \
    SCALAR(rho, USE_ALWAYS, "density of the equation of state")                                    \
    SCALAR(P, USE_ALWAYS, "pressure")                                                              \
    SCALAR(c, USE_ALWAYS, "sound speed")                                                           \
    SCALAR(b, USE_GRAD_H, "lagrangian: Z P/y^2")                                                   \
    SCALAR(g, USE_PAIR_SCALE,                                                                      \
           "scale of the pair gradient: C/h^(d+1) (standard); 1D: 1/sum V x^2 w (ia)")             \
    SCALAR(dv, USE_SLOPE, "1D: velocity gradient, linear_exact")                                   \
    VECTOR(F, USE_ALWAYS, "dp/dt")                                                                 \
    SCALAR(de, USE_ALWAYS, "de/dt")                                                                \
    SCALAR(dalpha, USE_ALPHA_RATE, "dalpha/dt")                                                    \
    SCALAR(div_v, USE_ALPHA_RATE, "divergence of v")                                               \
    SCALAR(signal, USE_SIGNAL, "largest signal speed")                                             \
    SCALAR(level, USE_LOCAL_STEPS, "local steps: of the particle")                                 \
    SCALAR(pace, USE_LOCAL_STEPS, "inverse of the time step that is asked for, times cfl")         \
    SCALAR(near_pace, USE_LOCAL_STEPS, "the largest one of its neighbours")                        \
    SCALAR(before, USE_LOCAL_STEPS, "its last step")                                               \
    SCALAR(ratio, USE_LOCAL_STEPS,                                                                 \
           "time since its last density sum, over that between the last two")                      \
    SCALAR(span, USE_LOCAL_STEPS, "from its last density sum but one to its last one")             \
    VECTOR(F_mean, USE_LOCAL_STEPS, "mean dp/dt, for predictions")                                 \
    SCALAR(de_mean, USE_LOCAL_STEPS, "mean de/dt")                                                 \
    VECTOR(impulse, USE_LOCAL_STEPS, "from pairs of finer levels, since the step began")           \
    SCALAR(heat, USE_LOCAL_STEPS, "and the energy")                                                \
    VECTOR(shift, USE_SHIFT, "velocity relative to the flow")                                      \
    VECTOR(potential, USE_SHIFT, "closed pair gradients: what closes them")                        \
    SCALAR(dm, USE_SHIFT, "mass that the shift exchanges, dm/dt")                                  \
    VECTOR(dp_shift, USE_SHIFT, "momentum that goes with it, not in F")                            \
    SCALAR(de_shift, USE_SHIFT, "and energy, not in de")

struct particles {
    int dim; /* number of components of vectors; the other pointers are NULL */
    ptrdiff_t n;
    ptrdiff_t ghosts; /* images at each end */
    unsigned uses;    /* mask of enum particle_use; initially all */
    double period[3]; /* side lengths of the box */
#define SCALAR(name, use, meaning) double *name;
#define VECTOR(name, use, meaning) double *name[3];
    PARTICLE_FIELDS(SCALAR, VECTOR)
#undef SCALAR
#undef VECTOR
    size_t *id;    /* index in the setup */
    double *block; /* memory of the arrays */
    double *spare; /* work array, for permutations and snapshots */
    size_t *order; /* work array: current index of the particle to be moved to index i */
};

/* Allocates all arrays, zeroed. STATUS_ENVIRONMENT: no memory. */
enum status particles_create(struct particles *particles, int dim, ptrdiff_t n, ptrdiff_t ghosts,
                             struct error *error);
void particles_destroy(struct particles *particles);

/* Number of arrays with these uses. */
size_t particles_arrays(int dim, unsigned uses);

/* Enlarges the space for ghosts and keeps all values. Invalidates pointers to arrays. */
enum status particles_grow_ghosts(struct particles *particles, ptrdiff_t ghosts,
                                  struct error *error);

/* Serialises all values in use, including those of ghosts. Restoring needs particles with the same
 * uses, may invalidate pointers to arrays, and fails without memory for the ghosts. */
void particles_serialise(struct particles *particles, struct serialiser *serialiser);

/* Moves the particle with index order[i] to index i, with all its values. Ghosts are not moved. */
void particles_permute(struct particles *particles);

/* Length of the vector of particle i; in 1D exactly |vector[0][i]|. */
static inline double particles_norm(const struct particles *particles, double *const vector[3],
                                    ptrdiff_t i)
{
    if (particles->dim == 1) return fabs(vector[0][i]);
    double squares = 0;
    for (int k = 0; k < particles->dim; k++) squares += vector[k][i] * vector[k][i];
    return sqrt(squares);
}

#endif
