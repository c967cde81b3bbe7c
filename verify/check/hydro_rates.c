/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares density, smoothing length, force and heating of disordered states with the oracle, for
 * every combination of the families that enter the sums. */
#include <math.h>

#include "check.h"
#include "hydro_against.h"
#include "hydro_setup.h"
#include "solver.h"
#include "worst.h"

enum { PARTICLES = 82 };

/* A state and a scheme, or a mutant's change of the solver's setup, while the oracle keeps the
 * right one. A mutant names no state: it runs hydro_scheme() on hydro_disordered(). */
struct rates_subject {
    struct hydro_fault fault;
    void (*state)(struct hydro_state *state, size_t n);
    struct scheme scheme;
};

static void add(struct check_run *run, struct scheme scheme,
                void (*state)(struct hydro_state *state, size_t n))
{
    const struct rates_subject subject = {{0}, state, scheme};
    check_subject(run, &subject, sizeof subject);
}

/* Every combination with the cubic spline; every gradient, formulation and pair width with the
 * other kernels. */
static void subjects(struct check_run *run)
{
    struct scheme s = hydro_scheme();
    for (size_t c = 0; c < hydro_combinations(); c++) {
        hydro_combine(&s, c);
        add(run, s, hydro_disordered);
        const bool internal = s.energy == ENERGY_INTERNAL;
        if (s.viscosity == VISCOSITY_TIME_DEPENDENT && internal) add(run, s, hydro_expanding);
        s.eta = 4.8; /* coincident particles have no h at eta = 2 */
        if (s.viscosity == VISCOSITY_RECONSTRUCTED && internal) add(run, s, hydro_coincident);
        s.eta = 2;
    }
    for (size_t k = 0; k < kernel_family.n; k++)
        for (size_t p = 0; p < scheme_pair_width_family.n; p++)
            for (size_t f = 0; f < scheme_formulation_family.n; f++)
                for (size_t g = 0; g < scheme_members(&scheme_gradient_family, 1); g++) {
                    s = hydro_scheme();
                    hydro_set_kernel(&s, kernel_family.members[k]->name);
                    s.pair_width = (enum pair_width)p;
                    s.formulation = (enum formulation)f;
                    s.gradient = (enum gradient)g;
                    add(run, s, hydro_disordered);
                }
}

static void measure(struct check_run *run, const void *subject)
{
    const struct rates_subject *s = subject;
    const struct scheme scheme = s->state ? s->scheme : hydro_scheme();
    static struct hydro_state state;
    (s->state ? s->state : hydro_disordered)(&state, PARTICLES);
    char where[HYDRO_TEXT];
    hydro_describe(&scheme, where);
    hydro_against_rates(run, hydro_setup(&state, &scheme), &s->fault, where);
}

static double knot_off(const struct kernel *kernel, double q, int dim)
{
    struct kernel right;
    (void)kernel;
    kernel_select(&right, "cubic_spline", 5, NULL);
    return right.dw(&right, q, dim) + (q > 0.5 && q < 1 ? 1e-6 * (1 - q) * (q - 0.5) : 0);
}

static void wrong_slope(struct setup *setup)
{
    setup->scheme.kernel.dw = knot_off;
    setup->generic = true;
}

#define FAULT(...) (&(const struct rates_subject){.fault = __VA_ARGS__})
static const struct check_mutant mutants[] = {
    {"hydro_kernel_constant", "kernel's constant off by 1e-9",
     FAULT(HYDRO_TIMES(scheme.kernel.constant[1], 1 + 1e-9))},
    {"hydro_kernel_slope", "dW/dr off by 1e-7 beyond the knot", FAULT({.spoil = wrong_slope})},
    {"hydro_eta", "h too large by 1e-9", FAULT(HYDRO_TIMES(scheme.eta, 1 + 1e-9))},
    {"hydro_loose_h", "h solved to 1e-4 only", FAULT(HYDRO_SET(scheme.h_tolerance, 1e-4))},
    {"hydro_other_gradient", "ia where standard is asked for",
     FAULT(HYDRO_SET(scheme.gradient, GRADIENT_IA))},
    {"hydro_other_formulation", "lagrangian where vanilla_ice is asked for",
     FAULT(HYDRO_SET(scheme.formulation, FORMULATION_LAGRANGIAN))},
    {"hydro_other_element", "energy element where mass is asked for",
     FAULT(HYDRO_SET(scheme.volume_element, VOLUME_ENERGY))},
    {"hydro_alpha_float", "alpha off in the seventh digit",
     FAULT(HYDRO_SET(scheme.alpha, (double)(1 + 1.2e-7F)))},
    {"hydro_beta", "beta = alpha for 2 alpha", FAULT(HYDRO_TIMES(scheme.beta, 0.5))},
    {"hydro_gamma", "gamma 5/3 for 1.4", FAULT(HYDRO_SET(gamma, 5. / 3))},
    {"hydro_pair_width", "harmonic mean of widths for mean of gradients",
     FAULT(HYDRO_SET(scheme.pair_width, PAIR_WIDTH_HARMONIC))},
    {0},
};

CHECK_DEFINE(
    hydro, rates, 708, .cost = 0.8,
    .property = "rho, h, P, dp/dt, de/dt, dalpha/dt, dt equal the oracle's, all pairs, long double",
    .subjects = subjects, .measure = measure, .mutants = mutants);

/* --- residual of the smoothing length --------------------------------------------------------- */

static void measure_residual(struct check_run *run, const void *subject)
{
    static struct hydro_state state;
    const struct rates_subject *s = subject;
    struct error error = {0};
    hydro_disordered(&state, 2200);
    for (int digits = 3; digits <= 13; digits++) {
        struct scheme scheme = hydro_scheme();
        scheme.h_tolerance = pow(10, -digits);
        struct setup setup = hydro_setup(&state, &scheme);
        if (s) hydro_put_fault(&s->fault, &setup);
        struct simulation *simulation;
        if (simulation_create(&setup, &simulation, &error)) {
            check_measure(run, 1, 0, 0, "%s", error.message);
            continue;
        }
        struct snapshot got;
        double worst = 0;
        simulation_snapshot(simulation, &got);
        for (size_t i = 0; i < got.n; i++) {
            /* h of the sum itself; the snapshot has the next iterate */
            const double h_inverse = simulation->particles.h_inverse[i];
            const double residual = fabs(scheme.eta * got.m[i] / got.rho[i] * h_inverse - 1);
            worst_keep(&worst, residual);
        }
        simulation_destroy(simulation);
        check_measure(run, worst, scheme.h_tolerance * 1.01, 1e-15, "h_tolerance 1e-%d", digits);
    }
}

static const struct check_mutant residual_mutants[] = {
    {"h_four_times_too_loose", "seed program: the iteration's measure 4 times too loose",
     FAULT(HYDRO_TIMES(scheme.h_tolerance, 4))},
    {"h_other_eta", "eta off by 1e-12", FAULT(HYDRO_TIMES(scheme.eta, 1 + 1e-12))},
    {0},
};

CHECK_DEFINE(
    hydro, h_residual, 709,
    .property = "|eta m/rho(h) - h| <= h_tolerance h for every particle, whatever the tolerance",
    .measure = measure_residual, .mutants = residual_mutants);
