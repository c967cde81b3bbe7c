/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file
 * Exact solutions for an ideal gas. Each function computes density rho, velocity v and pressure P,
 * n values each, at n positions. SPHPROOF_BAD_INPUT: a parameter is invalid, a position is not
 * finite, or a radius is negative; nothing is filled then. */
#ifndef SPHPROOF_PUBLIC_SOLUTIONS_H
#define SPHPROOF_PUBLIC_SOLUTIONS_H

#include <sphproof/common.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The Riemann problem left | right, each density, velocity, pressure (Toro 2009, chapter 4), with
 * the diaphragm at x0, at time t >= 0. gamma > 1. Either side may be a vacuum (0, any, 0), and a
 * vacuum may open between them; v is NaN in a vacuum. */
enum sphproof_status sphproof_solutions_riemann(double gamma, const double left[3],
                                                const double right[3], double x0, double t,
                                                size_t n, const double *x, double *rho, double *v,
                                                double *P, struct sphproof_error *error);

/** The star region of a Riemann problem. */
struct sphproof_star {
    double P;         /**< pressure; 0 with vacuum */
    double v;         /**< velocity of the contact; NaN with vacuum */
    double rho_left;  /**< density left of the contact */
    double rho_right; /**< density right of the contact */
    double speed[5];  /**< left head, left tail, contact, right tail, right head; NaN: none */
};

/** The star region of left | right. */
enum sphproof_status sphproof_solutions_star(double gamma, const double left[3],
                                             const double right[3], struct sphproof_star *star,
                                             struct sphproof_error *error);

/** Sedov's explosion of energy E in cold gas of density rho0 in dim dimensions (Sedov 1959; Kamm &
 * Timmes 2007) at radii r >= 0 and time t > 0; v: radial. shock: receives the radius of the shock;
 * may be NULL. */
enum sphproof_status sphproof_solutions_sedov(double gamma, int dim, double rho0, double E,
                                              double t, size_t n, const double *r, double *rho,
                                              double *v, double *P, double *shock,
                                              struct sphproof_error *error);

/** Noh's implosion: cold gas of density 1 that falls with speed 1 onto a plane, an axis or a point
 * (Noh 1987), at radii r >= 0 and time t >= 0; v: radial. */
enum sphproof_status sphproof_solutions_noh(double gamma, int dim, double t, size_t n,
                                            const double *r, double *rho, double *v, double *P,
                                            struct sphproof_error *error);

/** Gresho's vortex (Gresho & Chan 1990; Liska & Wendroff 2003) at radii r >= 0; v: azimuthal,
 * counter-clockwise. */
enum sphproof_status sphproof_solutions_gresho(size_t n, const double *r, double *rho, double *v,
                                               double *P, struct sphproof_error *error);

/** The isentropic vortex of strength beta (Yee, Sandham & Djomehri 1999) at radii r >= 0; v:
 * azimuthal. */
enum sphproof_status sphproof_solutions_yee(double gamma, double beta, size_t n, const double *r,
                                            double *rho, double *v, double *P,
                                            struct sphproof_error *error);

/** An isentropic simple wave that travels to the right (Landau & Lifshitz, section 101): at t = 0
 * the density is rho0 (1 + amplitude sin(2 pi x/length)) in gas of pressure P0 and velocity v0.
 * Valid until the wave breaks. */
enum sphproof_status sphproof_solutions_wave(double gamma, double rho0, double v0, double P0,
                                             double amplitude, double length, double t, size_t n,
                                             const double *x, double *rho, double *v, double *P,
                                             struct sphproof_error *error);

#ifdef __cplusplus
}
#endif

#endif
