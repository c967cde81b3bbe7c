/* SPDX-License-Identifier: GPL-3.0-or-later
 * Linear stability of a scheme on a uniform 1D lattice at rest: the growth rate of every wave of
 * the semi-discrete equations (smoothing length, density, energy and force linearised together),
 * and the largest time step of an integrator from the eigenvalues of its amplification matrix.
 * Units: spacing, particle mass and sound speed are 1; kappa is the phase from one particle to the
 * next, 0 < kappa <= pi. */
#pragma once

#include <stdbool.h>

#include "scheme.h"

enum { STABILITY_REACH_MAX = 128 };

/* W and its derivatives at one neighbour offset, width h. */
struct stability_pair {
    double W, r, rr, h, rh, hh;
};

struct stability {
    struct scheme scheme;
    double gamma, h, rho, u, P;
    double approaching; /* fraction of pairs on which viscosity acts: 1/2 on average */
    int reach;
    struct stability_pair pair[STABILITY_REACH_MAX + 1]; /* at offsets 0 .. reach */
};

/* True if the theory covers this gradient. */
bool stability_covers(enum gradient gradient);

/* The lattice of a scheme; pair_width max is linearised as mean (it has no derivative). Viscosity
 * none or constant. STATUS_BAD_INPUT: another viscosity or gradient, no root h, or a width beyond
 * STABILITY_REACH_MAX spacings. */
enum status stability_begin(struct stability *lattice, const struct scheme *scheme, double gamma,
                            struct error *error);

/* Response to a wave x = X cos, v = V cos, U = U0 + E sin, h = h0 + H sin (of kappa j): dV/dt =
 * force_x X + force_v V + force_u E + force_h H, dE/dt = energy_v V; the density sum at these
 * widths gives 1/h = 1/h0 + (found_x X + found_h H) sin. */
struct stability_response {
    double force_x, force_v, force_u, force_h, energy_v, found_x, found_h;
};
void stability_response(const struct stability *lattice, double kappa,
                        struct stability_response *response);

/* The same with h that follows the density at once: dV/dt = x X + v V + u E, dE/dt = energy V. */
struct stability_rates {
    double x, v, u, energy;
};
void stability_rates(const struct stability *lattice, double kappa, struct stability_rates *rates);

/* Largest real part of the eigenvalues of the rates: growth per time, <= 0 if the wave is stable.
 * frequency (may be NULL): |Im|, the sound wave's omega. */
double stability_growth(const struct stability *lattice, double kappa, double *frequency);

/* The fastest growth over all waves; kappa (may be NULL): its wavenumber. */
double stability_worst(const struct stability *lattice, double *kappa);

/* Stable intervals of eta between the existence limit of h and `to`, in rising order, at most max;
 * scheme->eta is not used. Returns their number. */
struct stability_interval {
    double from, to;
};
int stability_intervals(const struct scheme *scheme, double gamma, double to,
                        struct stability_interval *intervals, int max);

/* True if the theory has the steps of this integrator; the three functions below return NaN, NaN
 * and 0 for others. */
bool stability_knows(const struct integrator *integrator);

/* Displacement and velocity of a wave after `count` steps dt of the scheme's integrator, from X = 1
 * at rest with U uniform. */
void stability_follow(const struct stability *lattice, double kappa, double dt, int count,
                      double *x, double *v);

/* The largest stable c dt/dx, searched up to `to`. */
double stability_time_step(const struct stability *lattice, double to);
