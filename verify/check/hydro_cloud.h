/* SPDX-License-Identifier: GPL-3.0-or-later
 * States and schemes in 2D and 3D that the checks of group hydro run the solver on. */
#pragma once

#include "simulation.h"

enum { CLOUD_MAX = 2600, CLOUD_TEXT = 240 };

struct hydro_cloud {
    int dim;
    size_t n;
    double lo[3], hi[3], gamma;
    double x[3][CLOUD_MAX], v[3][CLOUD_MAX], m[CLOUD_MAX], u[CLOUD_MAX];
};

/* side^dim particles on a lattice whose spacing varies by a factor of 5/3 and whose points are
 * displaced at random; unequal masses, random velocities and energies, in random order; the sides
 * of the box differ, and none begins at 0. */
void hydro_cloud_disordered(struct hydro_cloud *cloud, int dim, size_t side);

/* The same with velocities that are mostly smooth, shear and compression: limiters and projectors
 * are neither 0 nor 1. */
void hydro_cloud_sheared(struct hydro_cloud *cloud, int dim, size_t side);

/* A setup of this state: the arrays stay the cloud's; threads 1, no skips. */
struct setup hydro_cloud_setup(const struct hydro_cloud *cloud, const struct scheme *scheme);

/* cubic_spline standard vanilla_ice mass, constant viscosity, mean width, modified leapfrog, h to
 * 1e-15, with parameters that differ from all defaults. */
struct scheme hydro_cloud_scheme(int dim);

/* Choices: the gradient, formulation, volume element and width of a pair; those of its viscosity
 * and energy. Scheme c of so many; the rest of the scheme stays. Some exclude each other
 * (scheme_check). */
size_t hydro_cloud_geometries(void);
void hydro_cloud_geometry(struct scheme *scheme, size_t c);
size_t hydro_cloud_physics(void);
void hydro_cloud_physic(struct scheme *scheme, size_t c);

/* What tells a scheme from hydro_cloud_scheme(). */
void hydro_cloud_describe(const struct scheme *scheme, int dim, char text[CLOUD_TEXT]);
