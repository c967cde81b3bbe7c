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
    int evaluations;  /* of the rates, a step */
    double cfl;       /* default of the key cfl, in support radii; see the member's comment */
    double cloud_cfl; /* the same in 2D and 3D, unless viscosity takes the form mu; 0: cfl */
    double
        closed_cfl; /* in its place with shifting=closed: vortices then gain from shorter steps */
    bool cfl_per_width; /* the default is cfl / eta: in particle spacings */
    /* Density is summed at even distances in time, and energy is not conserved to a high order: h
     * may be predicted, and total energy should be integrated (see scheme_default). */
    bool predicts;
    /* where h is predicted: P = P(rho, U) (1 - follow (gamma - 1)(V/V_predicted - 1)), 0 for none;
     * see predicted_midpoint.h */
    double follow;
    double first_step; /* length of the first step over the usual one; 0: 1 */
    bool signal_pass;  /* velocities change after the last rates: time step by a pass of its own */
    bool keeps_start;  /* of p, e and alpha in a step: uses p_old, e_old, alpha_old */
    bool ends_evaluated; /* the derived fields at the end of a step belong to its state */
    bool local;          /* has a form for steps=local, see steps.h */
    bool shifts;         /* and for particle shifting, where masses change */
    /* Each in its own file; 0 where an integrator keeps nothing from step to step. Arrays that
     * follow the particles when their order changes are fields of struct particles (x_old ...). */
    /* Bytes of simulation->integrator_state, without pointers in it, zero before the first step. */
    size_t keeps;
    /* Advances the state (x, p, e, alpha) by dt; rates of the state are there when it begins. */
    enum status (*step)(struct simulation *simulation, double dt, struct error *error);
    /* Brings the state to the present time if it is not there; called when no step follows. */
    void (*synchronise)(struct simulation *simulation);
};

#endif
