/* SPDX-License-Identifier: GPL-3.0-or-later
 * Density, smoothing length, force and heating of disordered states against the oracle, for
 * every combination of the families that stand in the sums. */
#include <math.h>

#include "check.h"
#include "hydro_against.h"
#include "hydro_setup.h"
#include "solver.h"
#include "worst.h"

enum { PARTICLES = 82 };

/* A state and a scheme of it, and what a mutant does to the solver's setup; the oracle keeps the
 * right one. A mutant names no state: hydro_scheme() on hydro_disordered(). */
struct rates_subject {
    hydro_spoil *spoil;
    void (*state)(struct hydro_state *state, size_t n);
    struct scheme scheme;
};

static void add(struct check_run *run, struct scheme scheme,
                void (*state)(struct hydro_state *state, size_t n))
{
    const struct rates_subject subject = {NULL, state, scheme};
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
        s.eta = 4.8; /* at 2 coincident particles have no h */
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
    hydro_against_rates(run, hydro_setup(&state, &scheme), s->spoil, where);
}

static void wrong_constant(struct setup *setup)
{
    setup->scheme.kernel.constant[1] *= 1 + 1e-9;
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

static void other_eta(struct setup *setup)
{
    setup->scheme.eta *= 1 + 1e-9;
}

static void loose_h(struct setup *setup)
{
    setup->scheme.h_tolerance = 1e-4;
}

static void other_gradient(struct setup *setup)
{
    setup->scheme.gradient = GRADIENT_IA;
}

static void other_formulation(struct setup *setup)
{
    setup->scheme.formulation = FORMULATION_LAGRANGIAN;
}

static void other_element(struct setup *setup)
{
    setup->scheme.volume_element = VOLUME_ENERGY;
}

static void float_alpha(struct setup *setup)
{
    setup->scheme.alpha = (double)(1 + 1.2e-7F);
}

static void beta_of_alpha(struct setup *setup)
{
    setup->scheme.beta = setup->scheme.alpha;
}

static void other_gamma(struct setup *setup)
{
    setup->gamma = 5. / 3;
}

static void other_width(struct setup *setup)
{
    setup->scheme.pair_width = PAIR_WIDTH_HARMONIC;
}

#define SPOIL(how) (&(const struct rates_subject){.spoil = how})
static const struct check_mutant mutants[] = {
    {"hydro_kernel_constant", "kernel's constant off by 1e-9", SPOIL(wrong_constant)},
    {"hydro_kernel_slope", "dW/dr off by 1e-7 beyond the knot", SPOIL(wrong_slope)},
    {"hydro_eta", "h too large by 1e-9", SPOIL(other_eta)},
    {"hydro_loose_h", "h solved to 1e-4 only", SPOIL(loose_h)},
    {"hydro_other_gradient", "ia where standard is asked for", SPOIL(other_gradient)},
    {"hydro_other_formulation", "lagrangian where vanilla_ice is asked for",
     SPOIL(other_formulation)},
    {"hydro_other_element", "energy element where mass is asked for", SPOIL(other_element)},
    {"hydro_alpha_float", "alpha off in the seventh digit", SPOIL(float_alpha)},
    {"hydro_beta", "beta = alpha for 2 alpha", SPOIL(beta_of_alpha)},
    {"hydro_gamma", "gamma 5/3 for 1.4", SPOIL(other_gamma)},
    {"hydro_pair_width", "harmonic mean of widths for mean of gradients", SPOIL(other_width)},
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
    hydro_disordered(&state, HYDRO_MAX);
    for (int digits = 3; digits <= 13; digits++) {
        struct scheme scheme = hydro_scheme();
        scheme.h_tolerance = pow(10, -digits);
        struct setup setup = hydro_setup(&state, &scheme);
        if (s) s->spoil(&setup);
        struct simulation *simulation;
        if (simulation_create(&setup, &simulation, &error)) {
            check_measure(run, 1, 0, 0, "%s", error.message);
            continue;
        }
        struct snapshot got;
        double worst = 0;
        simulation_snapshot(simulation, &got);
        for (size_t i = 0; i < got.n; i++) {
            /* the width of the sum itself: the snapshot's h is the next better one */
            const double h_inverse = simulation->particles.h_inverse[i];
            const double residual = fabs(scheme.eta * got.m[i] / got.rho[i] * h_inverse - 1);
            worst_keep(&worst, residual);
        }
        simulation_destroy(simulation);
        check_measure(run, worst, scheme.h_tolerance * 1.01, 1e-15, "h_tolerance 1e-%d", digits);
    }
}

static void four_times(struct setup *setup)
{
    setup->scheme.h_tolerance *= 4;
}

static void once_more(struct setup *setup)
{
    setup->scheme.eta *= 1 + 1e-12;
}

static const struct check_mutant residual_mutants[] = {
    {"h_four_times_too_loose", "seed program: the iteration's measure 4 times too loose",
     SPOIL(four_times)},
    {"h_other_eta", "eta off by 1e-12", SPOIL(once_more)},
    {0},
};

CHECK_DEFINE(
    hydro, h_residual, 709,
    .property = "|eta m/rho(h) - h| <= h_tolerance h for every particle, whatever the tolerance",
    .measure = measure_residual, .mutants = residual_mutants);
