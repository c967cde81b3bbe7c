/* SPDX-License-Identifier: GPL-3.0-or-later
 * The blast of an energy E that is set free at t = 0 in a plane, on a line or at a point of cold
 * gas of density rho at rest (Sedov 1959; Taylor 1950; Landau & Lifshitz 1987, section 106), exact
 * for a strong shock. E: of both sides of a plane, per length of a line, or in all. The closed form
 * with a parameter V as Kamm & Timmes 2007 write it, LA-UR-07-2849; the energy, hence the shock's
 * place, by quadrature. Any consistent units. No function here keeps state. */
#pragma once

struct sedov {
    double gamma, rho, E;
    int d;
    double xi0; /* the shock is at xi0 (E t^2/rho)^(1/(d + 2)) */
};

/* At a distance r from the centre; v: outwards. */
struct sedov_state {
    double rho, v, P;
};

/* Fills sedov: NULL, or what is wrong with its input: rho, E > 0; d = 1, 2, 3; gamma above 1 and
 * below (3 d - 2)/(d - 2) = 7 in 3D (below 100 elsewhere), but no nearer to 2 than 1e-3, where the
 * closed form has a singularity that the solution has not. */
const char *sedov_solve(double gamma, int d, double rho, double E, struct sedov *sedov);

double sedov_shock(const struct sedov *sedov, double t);

/* r >= 0, t > 0. Towards the centre rho falls to 0, and below the range of double it is 0. */
struct sedov_state sedov_sample(const struct sedov *sedov, double r, double t);

/* Integral over the ball of radius r (a disc; both sides of a plane) of the function `of` of the
 * distance from the centre and the state there. NaN: no memory, or no convergence to 1e-10. */
double sedov_integral(const struct sedov *sedov, double r, double t,
                      double (*of)(double r, const struct sedov_state *state));
