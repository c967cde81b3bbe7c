/* SPDX-License-Identifier: GPL-3.0-or-later
 * Steady vortices in a plane: the pressure gradient balances the centrifugal force, dP/dR = rho
 * v^2/R. Any consistent units. No function here allocates or keeps state. */
#pragma once

/* At the distance R from the centre; v: along the circle, counter-clockwise. */
struct vortex_state {
    double rho, v, P;
};

/* Gresho & Chan 1990, with the background of Liska & Wendroff 2003: rho = 1, v rises to 1 at R =
 * 0.2 and falls to 0 at 0.4. Its kinks keep second-order methods at an order of about 1.4. */
struct vortex_state vortex_gresho(double R);

/* The isentropic vortex of Yee, Sandham & Djomehri 1999, of strength beta: v = beta R/(2 pi)
 * exp((1 - R^2)/2), T = P/rho = 1 - (gamma - 1) beta^2/(8 gamma pi^2) exp(1 - R^2), P = rho^gamma.
 * Smooth everywhere. beta so small that T > 0 at the centre. */
struct vortex_state vortex_yee(double R, double beta, double gamma);
