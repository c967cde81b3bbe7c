/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gas on a lattice in 2D and 3D with a plain scheme, which tests may change before they make a
 * simulation. Include after test.h. */
#pragma once

#include "integrator.h"
#include "simulation.h"

/* Textbook SPH with Newton's method for h: cubic spline at eta 2, standard gradient, constant
 * viscosity. */
static inline struct scheme plain_scheme(void)
{
    struct scheme scheme = {
        .gradient = GRADIENT_STANDARD,
        .viscosity = VISCOSITY_CONSTANT,
        .h_method = H_NEWTON,
        .integrator = (const struct integrator *)family_find(&integrator_family, "leapfrog"),
        .alpha = 1,
        .beta = 2,
        .alpha_min = 0.1,
        .alpha_max = 1.5,
        .eta = 2,
        .cfl = 0.2,
        .h_tolerance = 1e-12};
    assert_int_equal(kernel_select(&scheme.kernel, "cubic_spline", 5, NULL), STATUS_OK);
    return scheme;
}

/* The caller frees it with simulation_destroy. */
static inline struct simulation *simulation_of(const struct setup *setup)
{
    struct simulation *simulation = NULL;
    struct error error = {0};
    if (simulation_create(setup, &simulation, &error)) fail_msg("%s", error.message);
    return simulation;
}

enum { N = 1024 };

static double x[3][N], v[3][N], m[N], u[N];

/* side^dim particles in a periodic box of side 1, at rest, of equal masses, u = 1; particle i is
 * displaced by `displaced` sin(7 i + a) spacings along axis a. */
static inline struct setup lattice_of(int dim, size_t side, double displaced,
                                      const struct scheme *scheme)
{
    struct setup setup = {.dim = dim,
                          .hi = {1, 1, 1},
                          .gamma = 1.4,
                          .t_end = 1,
                          .n = dim == 2 ? side * side : side * side * side,
                          .m = m,
                          .u = u,
                          .scheme = *scheme,
                          .threads = 1};
    assert_true(setup.n <= N);
    for (size_t i = 0, at = 0; i < setup.n; at = ++i) {
        m[i] = 1. / (double)setup.n, u[i] = 1;
        for (int a = 0; a < dim; a++, at /= side) {
            x[a][i] =
                ((double)(at % side) + 0.5 + displaced * sin(7. * (double)i + a)) / (double)side;
            v[a][i] = 0;
        }
    }
    for (int a = 0; a < dim; a++) setup.x[a] = x[a], setup.v[a] = v[a];
    return setup;
}

/* In 2D, 8 particles wide and 128 long; particles at rest may be inactive. */
static inline struct setup long_box_of(const struct scheme *scheme)
{
    struct setup setup = lattice_of(2, 8, 0, scheme);
    setup.n = 1024, setup.hi[1] = 16, setup.skip = true;
    for (size_t i = 0; i < setup.n; i++) {
        x[0][i] = ((double)(i % 8) + 0.5) / 8, x[1][i] = ((double)(i / 8) + 0.5) / 8;
        m[i] = 1. / 64, u[i] = 1, v[0][i] = v[1][i] = 0;
    }
    return setup;
}
