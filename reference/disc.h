/* SPDX-License-Identifier: GPL-3.0-or-later
 * A disc of gas that turns like a solid body and flies apart into a vacuum (Ovsyannikov 1956; Dyson
 * 1968): density 1 and radius 1 at t = 0, pressure Pc (1 - r^2), angular speed `spin`. Forces are
 * linear in r and stay so: all lengths grow with
 *   a(t), a'' = (spin^2 + 2 Pc)/a^3, hence a = sqrt(1 + (spin^2 + 2 Pc) t^2) for gamma = 2,
 * the gamma of gas whose molecules know two directions. Nothing shears, so that no viscosity may
 * act. Any consistent units. No function here allocates or keeps state. */
#pragma once

/* At a distance r from the centre; outwards and along the circle, counter-clockwise. Beyond the
 * edge at r = a(t): rho = P = 0, and the velocity that joins the edge's. */
struct disc_state {
    double rho, v_out, v_along, P;
};

struct disc_state disc_sample(double spin, double Pc, double r, double t);

/* a(t), the radius. */
double disc_radius(double spin, double Pc, double t);
