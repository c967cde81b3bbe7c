/* SPDX-License-Identifier: GPL-3.0-or-later
 * A plain scheme in 2D and 3D, for tests that change one thing of it. Include after cmocka.h. */
#ifndef MADE_SCHEME_H
#define MADE_SCHEME_H

#include "integrator.h"
#include "simulation.h"

/* Textbook SPH with Newton's method for h: cubic spline at eta 2, standard gradient, constant
 * viscosity. */
static inline struct scheme made_scheme(void)
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

/* simulation_destroy it. */
static inline struct simulation *made_of(const struct setup *setup)
{
    struct simulation *simulation = NULL;
    struct error error = {0};
    if (simulation_create(setup, &simulation, &error)) fail_msg("%s", error.message);
    return simulation;
}

#endif
