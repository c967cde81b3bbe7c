/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file
 * The solver: advances particles with a given scheme to a later time. */
#ifndef SPHPROOF_PUBLIC_SIMULATIONS_H
#define SPHPROOF_PUBLIC_SIMULATIONS_H

#include <sphproof/common.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The input, copied by the library. Members may be zero or NULL unless stated otherwise. */
struct sphproof_setup {
    int dim;                 /**< 1, 2, 3 */
    size_t n;                /**< particles, 2 or more */
    const double *x[3];      /**< n each: positions, in the box, any order */
    const double *v[3];      /**< n each: velocities; NULL: at rest */
    const double *m;         /**< n: masses, > 0 */
    const double *u;         /**< n: specific internal energies, > 0 */
    double lo[3];            /**< of the box */
    double hi[3];            /**< of the box */
    const char *boundary[3]; /**< "periodic" (NULL: the same), "open", "reflecting" */
    double gravity[3];       /**< constant acceleration; 2D, 3D */
    double gamma;            /**< of the ideal gas, > 1 */
    const char *const
        *keys;   /**< "KEY=VALUE" of the scheme (`sphproof list keys`); NULL at the end */
    int threads; /**< 0: one; results do not depend on it */
};

/** A simulation. */
struct sphproof_simulation;

/** Creates a simulation. SPHPROOF_BAD_INPUT: a particle, the box, gamma or a key is out of range;
 * the message names it. Free with sphproof_simulations_free. */
enum sphproof_status sphproof_simulations_create(const struct sphproof_setup *setup,
                                                 struct sphproof_simulation **simulation,
                                                 struct sphproof_error *error);

/** Advances to t, which must not be before the current time. SPHPROOF_BROKE_DOWN: the message names
 * particle, time and quantity; the state is the last valid one. */
enum sphproof_status sphproof_simulations_run(struct sphproof_simulation *simulation, double t,
                                              struct sphproof_error *error);

/** Output arrays: n values each, in the order of the setup; NULL: not needed. */
struct sphproof_state {
    double *x[3]; /**< positions, wrapped into a periodic box */
    double *v[3]; /**< velocities */
    double *rho;  /**< densities */
    double *u;    /**< specific internal energies */
    double *P;    /**< pressures */
    double *h;    /**< support radii */
};

/** Fills the arrays of the state; returns the time. */
double sphproof_simulations_state(const struct sphproof_simulation *simulation,
                                  const struct sphproof_state *state);

/** Sums over all particles. */
struct sphproof_sums {
    double mass;        /**< total */
    double momentum[3]; /**< total */
    double energy;      /**< kinetic and internal, and with gravity potential */
};

/** Conserved sums at the current time. */
struct sphproof_sums sphproof_simulations_sums(const struct sphproof_simulation *simulation);

/** Frees the simulation; may be NULL. */
void sphproof_simulations_free(struct sphproof_simulation *simulation);

#ifdef __cplusplus
}
#endif

#endif
