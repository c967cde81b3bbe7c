/* SPDX-License-Identifier: GPL-3.0-or-later
 * The equations of motion as pair forces (CONVENTIONS eqs. 5.1 to 5.4) on random disordered states
 * in 1D, 2D and 3D, straight from their formulas, with gradients G_ij that are src's operators
 * applied to fields which are 1 at one point. For rates of change of conserved sums without time
 * stepping. */
#pragma once

#include "gradient_study.h"
#include "scheme.h"

enum pair_fault {
    FORCES_RIGHT,
    FORCES_GATHER,        /* G(h_i) for the mean */
    FORCES_HALF_IN_FORCE, /* mean without the 1/2 in the force, with it in the heating */
    FORCES_PLUS,          /* difference for sum of the two gradients */
    FORCES_OWN_F,         /* f_i in both terms of the Lagrangian force */
    FORCES_NO_F,          /* no f in the heating */
    FORCES_OWN_PRESSURE,  /* P_i for P_i + P_j */
    FORCES_HEATING_SIGN,  /* v_j - v_i in the heating of one of ten points */
    FORCES_OWN_MATRIX,    /* G(h_j) of particle j divided by the volume of i */
};

struct pair_forces_subject {
    struct gradient_subject gradient; /* a difference form: rho dv/dt = -grad P, no pair forces */
    enum formulation formulation;
    enum pair_fault fault;
};

enum { FORCES_MAX = 64 };

struct pair_forces_state {
    int dim;
    size_t n;
    struct clouds_cloud cloud; /* volume = m/rho, h = eta volume^(1/dim) */
    double m[FORCES_MAX], v[3][FORCES_MAX], P[FORCES_MAX], rho[FORCES_MAX];
    double f[FORCES_MAX];                /* grad-h factors */
    double G[FORCES_MAX][FORCES_MAX][3]; /* G_ij(h_i) */
    double condition;                    /* largest */
};

struct pair_forces_rates { /* of total momentum, angular momentum, energy, over sums of |terms| */
    double momentum, angular, energy;
};

/* A jittered cloud of at most FORCES_MAX points with random masses, pressures and velocities;
 * free its cloud with clouds_free. False: no memory. */
bool pair_forces_state(struct pair_forces_state *state, const struct kernel *kernel, int dim,
                       unsigned long seed);

/* Fills G and condition. */
bool pair_forces_gradients(struct pair_forces_state *state, const struct gradient_subject *subject,
                           const struct kernel *kernel);

/* Makes a state and returns its rates. */
bool pair_forces_rates(const struct pair_forces_subject *subject, int dim, unsigned long seed,
                       struct pair_forces_rates *rates);
