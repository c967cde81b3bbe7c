/* SPDX-License-Identifier: GPL-3.0-or-later
 * The oracle: a second implementation of the equations of density, smoothing length, force, energy
 * and time stepping in 1D to 3D, straight from the text, in long double, with loops over all pairs
 * and images. Deliberately slow and simple; shares types with src, but no code. */
#pragma once

#include "oracle_kernel.h"
#include "simulation.h"

typedef long double oracle_vector[3]; /* components beyond the dimension are 0 */

struct oracle_matrix {
    oracle_vector row[3];
};

struct oracle_particle {
    /* state: position (unwrapped), mass, momentum, energy (U or E as the scheme says), viscosity */
    oracle_vector x, p;
    long double m, e, alpha;
    /* of the state */
    oracle_vector v;
    long double U, h, width, rho_sum, y, V, rho, P, c;
    long double found, found_before;  /* 1/h of the last two density sums */
    long double grad_h_rho, grad_h_y; /* h/(d rho_sum) times d rho_sum/dh, dy/dh */
    struct oracle_matrix C;           /* inverse of the moments of the gradient in use */
    long double condition;            /* of those moments, in the 2-norm; standard: 0 */
    bool ill;                       /* condition above the bound: pairs use the standard gradient */
    long double steep;              /* blended: the standard gradient's share */
    struct oracle_matrix L;         /* linear_exact gradient of v: d v_a/d x_b at [a][b] */
    struct oracle_matrix projector; /* onto the direction of the local shear */
    long double balsara;
    struct oracle_matrix slope_C;   /* inverse of the moments of L; 0 where they are ill */
    long double alpha_local, decay; /* of the switch: target of alpha, and decay rate */
    /* rates dp/dt, dU/dt, d(e)/dt, dalpha/dt; divergence of v; signal speed */
    oracle_vector F;
    long double dU, de, dalpha, div_v, signal;
    /* particle shifting: velocity relative to the flow, and rates of the exchange, which the rates
     * above do not include */
    oracle_vector shift, potential, of_one, dp_shift;
    long double dm, de_shift;
    size_t neighbours; /* other particles with r < h */
};

struct oracle {
    struct scheme scheme;
    struct oracle_kernel kernel;
    int dim;
    oracle_vector lo, period;
    long double gamma, time;
    bool without_grad_h; /* deliberately wrong; set after oracle_create */
    long double last_dt,
        ahead; /* h_method predicted: number of last changes of 1/h to extrapolate */
    size_t n, steps;
    struct oracle_particle *particles; /* in the setup's order */
    struct oracle_particle *start;     /* n, workspace of the integrators */
    long double *distance;             /* n n 3: of each pair and image, from the last evaluation */
};

/* Creates an oracle, which must not move in memory. STATUS_ENVIRONMENT: no memory. Free with
 * oracle_free. */
enum status oracle_create(struct oracle *oracle, const struct setup *setup, struct error *error);
void oracle_free(struct oracle *oracle);

/* Density, h, pressure, rates of the present state. STATUS_BROKE_DOWN: no sound state. */
enum status oracle_evaluate(struct oracle *oracle, struct error *error);

/* Computes the signal speeds of the present momenta; oracle_evaluate does this as well. */
void oracle_signals(struct oracle *oracle);

/* The time step of the present signal speeds. */
long double oracle_time_step(const struct oracle *oracle);

/* True if the oracle has its own implementation of everything that an evaluation with this scheme
 * needs; of the steps of this integrator. */
bool oracle_covers(const struct scheme *scheme);
bool oracle_covers_step(const struct integrator *integrator);

/* Evaluates, steps to t_end, and evaluates again if the last step does not end with it: the derived
 * fields belong to the state at t_end. */
enum status oracle_run(struct oracle *oracle, long double t_end, struct error *error);
