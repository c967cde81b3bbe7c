/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cold gas of density 1 that falls with speed 1 onto a plane, an axis or a point (Noh 1987, J.
 * Comput. Phys. 72, 78): a shock of infinite Mach number runs outwards with (gamma - 1)/2 and
 * leaves gas at rest behind. Exact for any gamma > 1 in d = 1, 2, 3 dimensions. Other densities and
 * speeds by scaling. No function here allocates or keeps state. */
#pragma once

/* At a distance r from the centre; v: outwards. */
struct noh_state {
    double rho, v, P;
};

/* r >= 0, t >= 0. At t = 0 and ahead of the shock P = 0; at r = 0 ahead of it v = 0. */
struct noh_state noh_sample(double gamma, int d, double r, double t);

/* Radius of the shock. */
double noh_shock(double gamma, double t);
