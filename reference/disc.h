/* SPDX-License-Identifier: GPL-3.0-or-later
 * A rigidly rotating disc of gas that expands into a vacuum (Ovsyannikov 1956; Dyson 1968): density
 * 1 and radius 1 at t = 0, pressure Pc (1 - r^2), angular speed `spin`. Forces are and remain
 * linear in r: all lengths grow with a(t), a'' = (spin^2 + 2 Pc)/a^3, hence a = sqrt(1 + (spin^2 +
 * 2 Pc) t^2) for gamma = 2, the gamma of a gas with two degrees of freedom. There is no shear, so
 * viscosity should not act. Any consistent units. No function here allocates or keeps state. */
#pragma once

/* At a distance r from the centre; velocities outwards and along the circle, counter-clockwise.
 * Beyond the edge at r = a(t): rho = P = 0, and the velocity continues that of the edge. */
struct disc_state {
    double rho, v_out, v_along, P;
};

struct disc_state disc_sample(double spin, double Pc, double r, double t);

/* The radius a(t). */
double disc_radius(double spin, double Pc, double t);
