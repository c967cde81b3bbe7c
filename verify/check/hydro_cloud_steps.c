/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares whole runs over a few natural time steps in 2D and 3D, with particles that cross the
 * ends of the box, with the oracle: every integrator, with the choices that its steps depend on. */
#include "check.h"
#include "hydro_against.h"
#include "hydro_setup.h"
#include "integrator.h"

enum { STEPS = 2 };

struct cloud_steps_subject {
    struct hydro_fault fault;
    int dim; /* 0: a mutant */
    struct scheme scheme;
};

static struct scheme scheme_of(int dim, const struct integrator *integrator, int c)
{
    struct scheme s = hydro_cloud_scheme(dim);
    s.integrator = integrator;
    s.cfl = integrator->cfl_per_width ? 0.4 : integrator->cfl;
    s.viscosity = c == 0 ? VISCOSITY_TIME_DEPENDENT : VISCOSITY_CONSTANT;
    s.energy = c ? ENERGY_TOTAL : ENERGY_INTERNAL;
    s.gradient = c == 1 ? GRADIENT_IA : c == 2 ? GRADIENT_CORRECTED : GRADIENT_STANDARD;
    s.volume_element = c == 1 ? VOLUME_NUMBER : c == 2 ? VOLUME_ENERGY : VOLUME_MASS;
    s.h_method = c == 1 ? H_PREDICTED : c == 2 ? H_PREDICTED : H_NEWTON;
    if (c == 0) s.balsara = BALSARA_ON;
    if (c == 3) { /* a switch sets alpha once a step */
        s.viscosity = VISCOSITY_CULLEN_DEHNEN;
        s.viscosity_form = VISCOSITY_FORM_SIGNAL;
        s.gradient = GRADIENT_IA;
        s.h_method = H_PREDICTED;
    }
    if (c == 2) s.alpha_u = 0.71, s.shock_conductivity = 1.3;
    return s;
}

static void subjects(struct check_run *run)
{
    for (int dim = 2; dim <= 3; dim++)
        for (size_t i = 0; i < integrator_family.n; i++)
            for (int c = 0; c < 4; c++) {
                const struct integrator *integrator =
                    (const struct integrator *)integrator_family.members[i];
                if (dim == 3 && (size_t)c != i % 4) continue;
                const struct cloud_steps_subject subject = {
                    {0}, dim, scheme_of(dim, integrator, c)};
                check_subject(run, &subject, sizeof subject);
            }
}

static void measure(struct check_run *run, const void *subject)
{
    const struct cloud_steps_subject *given = subject;
    struct cloud_steps_subject s = *given;
    static struct hydro_state cloud;
    if (!given->dim) {
        s.dim = 2;
        s.scheme =
            scheme_of(2, hydro_integrator("predicted_midpoint"), given->scheme.viscosity ? 3 : 1);
    }
    hydro_cloud_sheared(&cloud, s.dim, s.dim == 2 ? 8 : 6);
    for (size_t i = 0; i < cloud.n; i++) cloud.v[0][i] -= 1.1; /* across the end of the box */
    char where[HYDRO_TEXT];
    hydro_cloud_describe(&s.scheme, s.dim, where);
    hydro_against_steps(run, hydro_setup(&cloud, &s.scheme), &s.fault, STEPS + 0.3, where);
}

static void end_taken_for_evaluated(struct setup *setup)
{
    static struct integrator replaced;
    replaced = *setup->scheme.integrator;
    replaced.ends_evaluated = true;
    setup->scheme.integrator = &replaced;
}

#define FAULT(...) (&(const struct cloud_steps_subject){.fault = __VA_ARGS__})
#define FAULT_SWITCH(...)                                                                          \
    (&(const struct cloud_steps_subject){.fault = __VA_ARGS__,                                     \
                                         .scheme.viscosity = VISCOSITY_CULLEN_DEHNEN})
static const struct check_mutant mutants[] = {
    {"cloud_steps_newton", "h by Newton where it is to be predicted",
     FAULT(HYDRO_SET(scheme.h_method, H_NEWTON))},
    {"cloud_steps_end_not_evaluated", "derived fields of the last midpoint, not of the end",
     FAULT({.spoil = end_taken_for_evaluated})},
    {"cloud_steps_eta", "eta too large by 1e-6", FAULT(HYDRO_TIMES(scheme.eta, 1 + 1e-6))},
    {"cloud_steps_cfl", "cfl too large by 1e-6", FAULT(HYDRO_TIMES(scheme.cfl, 1 + 1e-6))},
    {"cloud_steps_alpha_max", "what alpha jumps up to too low by 1e-6",
     FAULT_SWITCH(HYDRO_TIMES(scheme.alpha_max, 1 - 1e-6))},
    {0},
};

CHECK_DEFINE(
    clouds, time_stepping, 810, .cost = 2,
    .property = "the state at t_end and the number of steps in 2D and 3D equal the oracle's",
    .subjects = subjects, .measure = measure, .mutants = mutants);
