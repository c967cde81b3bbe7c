/* SPDX-License-Identifier: GPL-3.0-or-later
 * Integrators: one file in integrator/ and one line in integrators.def each. */
#ifndef SPHPROOF_INTEGRATOR_H
#define SPHPROOF_INTEGRATOR_H

#include <stdbool.h>

#include "family.h"
#include "status.h"

struct simulation;

extern const struct family integrator_family;

struct integrator {
    struct member member;
    int order;
    int evaluations;  /* of the rates, for each step */
    double cfl;       /* default of the key cfl, in support radii; see the integrator's file */
    double cloud_cfl; /* the same in 2D and 3D, unless viscosity has the mu form; 0: cfl */
    double
        closed_cfl; /* replaces cloud_cfl with shifting=closed: vortices gain from shorter steps */
    bool cfl_per_width; /* the default is cfl / eta, i.e. in particle spacings */
    /* Density sums are equally spaced in time, and energy is not conserved to high order: h may be
     * predicted, and total energy should be integrated (see scheme_default). */
    bool predicts;
    /* if h is predicted: P = P(rho, U) (1 - follow (gamma - 1)(V/V_predicted - 1)); 0: no
     * correction; see predicted_midpoint.h */
    double follow;
    double first_step; /* length of the first step in units of the usual one; 0 means 1 */
    bool signal_pass; /* velocities change after the last rates: the time step needs a separate pass
                       */
    bool keeps_start; /* keeps the p, e and alpha of the step's start in p_old, e_old, alpha_old */
    bool ends_evaluated; /* the derived fields at the end of a step belong to its state */
    bool local;          /* supports steps=local, see steps.h */
    bool shifts;         /* supports particle shifting, which changes masses */
    /* 0 if the integrator keeps nothing from step to step. Arrays that must follow the particles
     * when their order changes are fields of struct particles (x_old ...). */
    /* Bytes of simulation->integrator_state, which contains no pointers and is zero before the
     * first step. */
    size_t keeps;
    /* Advances the state (x, p, e, alpha) by dt; the rates of the state are known at the start. */
    enum status (*step)(struct simulation *simulation, double dt, struct error *error);
    /* Brings the state to the current time if needed; called when no step follows. */
    void (*synchronise)(struct simulation *simulation);
};

#endif
