/* SPDX-License-Identifier: GPL-3.0-or-later
 * States and schemes that the checks of groups hydro and clouds run the solver on. */
#pragma once

#include "simulation.h"

enum { HYDRO_MAX = 2600, HYDRO_TEXT = 240 };

struct hydro_state {
    int dim;
    size_t n;
    double lo[3], hi[3], gamma;
    double x[3][HYDRO_MAX], v[3][HYDRO_MAX], m[HYDRO_MAX], u[HYDRO_MAX];
};

/* A setup of this state, which keeps ownership of the arrays; threads 1, no skips. */
struct setup hydro_setup(const struct hydro_state *state, const struct scheme *scheme);
/* Finds an integrator by name. */
const struct integrator *hydro_integrator(const char *name);
/* Sets the kernel and its default width; the name is a built-in one. */
void hydro_set_kernel(struct scheme *scheme, const char *name);

/* The largest difference of two fields, relative to the largest value of the first. */
double hydro_difference(size_t n, const double *a, const double *b);

/* ---- in 1D ---- */

/* Unequal masses and spacings (8:1), random velocities and energies; the order is not that of x,
 * the box neither symmetric nor of length 2, and particles sit close to its ends. */
void hydro_disordered(struct hydro_state *state, size_t n);
/* 64 adjacent particles at 20 times the density of the rest: neighbourhoods are one-sided. */
void hydro_contact(struct hydro_state *state, size_t n);
/* Gas expands from the dense middle, which limits the time step, except at the cold ends. */
void hydro_expanding(struct hydro_state *state, size_t n);
/* hydro_disordered with two coincident particles. */
void hydro_coincident(struct hydro_state *state, size_t n);
/* A smooth wave of 10 % in all fields, on [0, 1]. */
void hydro_wave(struct hydro_state *state, size_t n);
/* A tube 1 0 1 | 0.125 0 0.1 with its mirror image, on [-1, 1]. */
void hydro_tube(struct hydro_state *state, size_t n);

/* cubic_spline standard vanilla_ice mass, constant viscosity, modified leapfrog, h to 1e-14. */
struct scheme hydro_scheme(void);
/* Number of combinations of gradient, formulation, volume element, energy and viscosity; sets those
 * of number c and leaves the rest. Some exclude each other, see scheme_check. */
size_t hydro_combinations(void);
void hydro_combine(struct scheme *scheme, size_t c);
/* "cubic_spline 2 ia lagrangian ...": the differences from hydro_scheme(). */
void hydro_describe(const struct scheme *scheme, char text[HYDRO_TEXT]);

/* ---- in 2D and 3D ---- */

/* side^dim disordered particles with mostly smooth velocities, shear and compression, so that
 * limiters and projectors are neither 0 nor 1. */
void hydro_cloud_sheared(struct hydro_state *state, int dim, size_t side);

/* cubic_spline standard vanilla_ice mass, constant viscosity, mean width, modified leapfrog, h to
 * 1e-15, with parameters that differ from all defaults. */
struct scheme hydro_cloud_scheme(int dim);

/* Two numbered families of schemes: gradient, formulation, volume element and width of a pair;
 * viscosity and energy. Sets the choices of number c and leaves the rest. Some exclude each other
 * (scheme_check). */
size_t hydro_cloud_geometries(void);
void hydro_cloud_geometry(struct scheme *scheme, size_t c);
size_t hydro_cloud_physics(void);
void hydro_cloud_physic(struct scheme *scheme, size_t c);

/* The differences of a scheme from hydro_cloud_scheme(). */
void hydro_cloud_describe(const struct scheme *scheme, int dim, char text[HYDRO_TEXT]);
