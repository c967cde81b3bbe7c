/* SPDX-License-Identifier: GPL-3.0-or-later
 * Exact solution of the one-dimensional Riemann problem of an ideal gas, for any two states:
 * shocks, rarefactions, contact, vacuum that opens between them or lies on a side, and cold gas
 * (P = 0, rho > 0). Toro, Riemann Solvers and Numerical Methods for Fluid Dynamics (2009), ch. 4.
 * Units: any consistent set. No function here allocates, prints or keeps state. */
#pragma once

#include <stdbool.h>

/* Density, velocity, pressure. Vacuum is rho = 0 and P = 0, whatever v. */
struct riemann_state {
    double rho, v, P;
};

/* A wave of zero strength is a rarefaction whose head and tail coincide; RIEMANN_NONE is the side
 * of a vacuum, and both sides where the two states are equal. */
enum riemann_wave { RIEMANN_NONE, RIEMANN_SHOCK, RIEMANN_RAREFACTION };

struct riemann_solution {
    double gamma;
    struct riemann_state left, right;     /* as given */
    bool vacuum;                          /* somewhere, hence no star region and no contact */
    double p_star, v_star;                /* between the waves; 0 and NaN with vacuum */
    double rho_star_left, rho_star_right; /* either side of the contact; 0 with vacuum */
    bool underflow; /* p* or a rho* is no vacuum, but below DBL_MIN: 0, or with few digits */
    enum riemann_wave left_wave, right_wave;
    double left_head, left_tail; /* speeds; equal for a shock, NaN where there is no wave; */
    double contact;              /* a tail beside vacuum is the gas's edge */
    double right_tail, right_head;
};

/* "none", "shock" or "rarefaction". */
const char *riemann_wave_name(enum riemann_wave wave);

/* Solves the problem left | right. gamma > 1, rho >= 0, P >= 0, P = 0 where rho = 0, all finite.
 * Star values are right to 1e-14 relative, speeds to 1e-14 of the largest of |v|, c; close to
 * vacuum p* and rho* lose what their problem loses, (2 gamma/(gamma-1))/(1 - dv/dv_vacuum) times
 * the rounding of long double; values below DBL_MIN lose digits, which `underflow` says. Returns
 * NULL, or a text that says what is wrong with the input, or that the result is beyond the range of
 * double (solution is then untouched). */
const char *riemann_solve(double gamma, const struct riemann_state *left,
                          const struct riemann_state *right, struct riemann_solution *solution);

/* The state at x and time t >= 0 of the problem that starts at x0. t = 0: the initial states.
 * On the contact and at x = x0, t = 0: the left one. In vacuum at t > 0 rho = P = 0 and v is NaN:
 * nothing is there to move. */
struct riemann_state riemann_sample(const struct riemann_solution *solution, double x, double x0,
                                    double t);
