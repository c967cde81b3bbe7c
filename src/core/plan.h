/* SPDX-License-Identifier: GPL-3.0-or-later
 * The plan: derived once from a setup, it says which passes the setup needs. A pass that it leaves
 * out is work whose result is unused or exactly zero. */
#ifndef SPHPROOF_PLAN_H
#define SPHPROOF_PLAN_H

#include <stdbool.h>

#include "scheme.h"
#include "sums.h"

struct plan {
    int dim;
    const struct sums *sums; /* the way to sum over neighbours; NULL: none for the dimension */
    bool specialised;        /* loops compiled for the choices; else all is looked up (oracle) */
    bool newton;             /* h by Newton at every evaluation; else predicted */
    bool energy_sum;         /* second kernel sum, of U */
    bool grad_h;             /* grad-h factors */
    bool matrix;             /* moment matrix of the Integral Approach */
    bool own_gradient;       /* standard gradients at each particle's own h */
    bool slope;              /* linear_exact velocity gradient, for reconstruction */
    bool balsara;            /* factor of the viscosity, from velocity gradients */
    bool viscosity;          /* artificial viscosity in the pair expression */
    bool alpha;              /* evolution of alpha, with div v */
    bool jump;               /* alpha by a switch, once a step */
    bool local;              /* local steps */
    bool shift;              /* particle shifting, with fluxes of mass, momentum and energy */
    bool closed;             /* and pair gradients that make nothing of a constant */
    bool gravity;            /* a constant acceleration */
    bool signal_pass;        /* a pass of its own for the time step */
    bool sleep;              /* leave out particles that no signal has reached */
    bool quiet;              /* leave out what vanishes of pairs at rest against each other */
};

struct setup; /* see simulation.h */

/* What a setup needs. */
struct plan plan_of_setup(const struct setup *setup);

/* What the scheme needs in dim dimensions; skip: leave out work: sleep.h, and quiet. */
struct plan plan_make(const struct scheme *scheme, int dim, bool skip, bool specialised);

#endif
