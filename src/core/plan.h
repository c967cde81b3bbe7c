/* SPDX-License-Identifier: GPL-3.0-or-later
 * The plan: which passes a setup needs, derived once from it. The work of an omitted pass is unused
 * or exactly zero. */
#ifndef SPHPROOF_PLAN_H
#define SPHPROOF_PLAN_H

#include <stdbool.h>

#include "scheme.h"
#include "sums.h"

struct plan {
    int dim;
    const struct sums *sums; /* neighbour sums for dim; NULL: none */
    bool specialised;  /* loops compiled for the choices; otherwise choices at run time (oracle) */
    bool newton;       /* h by Newton's method at every evaluation; otherwise predicted */
    bool energy_sum;   /* second kernel sum, of U */
    bool grad_h;       /* grad-h factors */
    bool matrix;       /* moment matrix of the Integral Approach */
    bool own_gradient; /* standard gradients at each particle's own h */
    bool slope;        /* linear_exact velocity gradient, for reconstruction */
    bool balsara;      /* Balsara factor of viscosity, from velocity gradients */
    bool viscosity;    /* artificial viscosity in the pair expression */
    bool alpha;        /* evolution of alpha, with div v */
    bool jump;         /* alpha by a switch, once per step */
    bool local;        /* local steps */
    bool shift;        /* particle shifting, with fluxes of mass, momentum and energy */
    bool closed;       /* pair gradients that vanish for a constant */
    bool gravity;      /* a constant acceleration */
    bool signal_pass;  /* separate pass for the time step */
    bool sleep;        /* skip particles that no signal has reached */
    bool quiet;        /* skip vanishing terms of pairs without relative motion */
};

struct setup; /* see simulation.h */

/* The plan of a setup. */
struct plan plan_of_setup(const struct setup *setup);

/* The plan of a scheme in dim dimensions. skip: allow sleep (sleep.h) and quiet. */
struct plan plan_make(const struct scheme *scheme, int dim, bool skip, bool specialised);

#endif
