/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares linear theory with the solver: the linearised rates and time steps of the stability
 * atlas are differences of the solver's own, and its limits of eta are the known ones. */
#include <math.h>
#include <string.h>

#include "check.h"
#include "hydro_setup.h"
#include "integrator.h"
#include "simulation.h"
#include "stability.h"
#include "worst.h"

enum { PARTICLES = 24, STEPS = 32 };

/* A scheme, or what a mutant changes in the theory of lattice_scheme(). */
struct theory {
    void (*spoil)(struct stability *lattice);
    struct scheme scheme;
};

enum component { DISPLACEMENT, VELOCITY, HEAT };

/* A lattice of unit spacing with one wave in one component. */
static void set_wave(struct hydro_state *state, const struct stability *lattice, double kappa,
                     enum component component, double amplitude)
{
    *state = (struct hydro_state){.dim = 1, .n = PARTICLES, .hi = {PARTICLES}, .gamma = 1.4};
    for (int i = 0; i < PARTICLES; i++) {
        const double wave = amplitude * cos(kappa * i);
        state->x[0][i] = i + 0.5 + (component == DISPLACEMENT ? wave : 0);
        state->v[0][i] = component == VELOCITY ? wave : 0;
        state->m[i] = 1;
        state->u[i] = lattice->u + (component == HEAT ? amplitude * sin(kappa * i) : 0);
    }
}

static double project(const double *values, const struct snapshot *s, double kappa, double phase)
{
    double sum = 0;
    for (size_t i = 0; i < s->n; i++)
        sum += values[i] * cos(kappa * (double)s->id[i] - phase) * 2 / (double)s->n;
    return sum;
}

/* Force and heating of a wave by the solver, per amplitude. */
static enum status solver_response(const struct stability *lattice, double kappa,
                                   enum component component, double *force, double *heat,
                                   struct error *error)
{
    static struct hydro_state state;
    const double amplitude = 3e-5;
    *force = *heat = 0;
    for (int sign = -1; sign <= 1; sign += 2) {
        struct simulation *simulation;
        struct snapshot s;
        struct rates rates;
        set_wave(&state, lattice, kappa, component, sign * amplitude);
        const struct setup setup = hydro_setup(&state, &lattice->scheme);
        if (simulation_create(&setup, &simulation, error)) return error->status;
        simulation_snapshot(simulation, &s);
        simulation_rates(simulation, &rates);
        *force += sign * project(rates.force[0], &s, kappa, 0) / (2 * amplitude);
        *heat += sign * project(rates.energy, &s, kappa, 0.5 * M_PI) / (2 * amplitude);
        simulation_destroy(simulation);
    }
    return STATUS_OK;
}

/* --- rates ------------------------------------------------------------------------------------ */

static struct scheme lattice_scheme(void)
{
    struct scheme s = hydro_scheme();
    s.eta = 3.37; /* no neighbour on a knot, where the kernel has no second derivative */
    s.beta = 0;   /* quadratic */
    return s;
}

static void add(struct check_run *run, const char *kernel, enum viscosity viscosity)
{
    struct theory theory = {NULL, lattice_scheme()};
    struct scheme *s = &theory.scheme;
    kernel_select(&s->kernel, kernel, 5, NULL);
    s->viscosity = viscosity;
    for (size_t e = 0; e < scheme_members(&scheme_volume_element_family, 1); e++)
        for (size_t f = 0; f < scheme_formulation_family.n; f++)
            for (size_t g = 0; g < scheme_members(&scheme_gradient_family, 1); g++) {
                s->volume_element = (enum volume_element)e;
                s->formulation = (enum formulation)f;
                s->gradient = (enum gradient)g;
                check_subject(run, &theory, sizeof theory);
            }
}

/* Viscosity does not depend on the kernel. */
static void subjects(struct check_run *run)
{
    for (size_t k = 0; k < kernel_family.n; k++) {
        const char *name = kernel_family.members[k]->name;
        add(run, name, VISCOSITY_NONE);
        if (strcmp(name, "cubic_spline") == 0) add(run, name, VISCOSITY_CONSTANT);
    }
}

static void measure_rates(struct check_run *run, const void *subject)
{
    const struct theory *theory = subject;
    const struct scheme scheme = theory->spoil ? lattice_scheme() : theory->scheme;
    struct stability lattice;
    struct error error = {0};
    char where[HYDRO_TEXT];
    double worst = 0;
    hydro_describe(&scheme, where);
    if (!stability_covers(scheme.gradient)) {
        check_skip(run, "%s: no theory of this gradient (stability/stability.c)", where);
        return;
    }
    enum status status = stability_begin(&lattice, &scheme, 1.4, &error);
    for (int p = 1; p <= 11 && !status; p += 5) {
        const double kappa = 2 * M_PI * p / PARTICLES;
        double x = 0, v = 0, u = 0, heat = 0, ignored;
        struct stability_rates r;
        if (theory->spoil) theory->spoil(&lattice);
        stability_rates(&lattice, kappa, &r);
        lattice.scheme = scheme;
        status = solver_response(&lattice, kappa, DISPLACEMENT, &x, &ignored, &error);
        if (!status) status = solver_response(&lattice, kappa, VELOCITY, &v, &heat, &error);
        if (!status) status = solver_response(&lattice, kappa, HEAT, &u, &ignored, &error);
        /* viscous heating has no linear term, and a quadratic one that the differences do not
         * remove */
        if (scheme.viscosity != VISCOSITY_NONE) heat = r.energy;
        const double off[] = {x - r.x, v - r.v, u - r.u, heat - r.energy};
        for (size_t i = 0; i < sizeof off / sizeof *off; i++) worst_keep(&worst, fabs(off[i]));
    }
    if (status)
        check_measure(run, 1, 0, 0, "%s: %s", where, error.message);
    else
        check_measure(run, worst, 1e-7, 1e-8, "%s", where);
}

static void frozen_width(struct stability *lattice)
{
    for (int k = 0; k <= lattice->reach; k++) lattice->pair[k].h = 0;
}

static void frozen_gradient(struct stability *lattice)
{
    for (int k = 0; k <= lattice->reach; k++) lattice->pair[k].rh = 0;
}

static void bent_kernel(struct stability *lattice)
{
    lattice->pair[1].rr *= 1 + 1e-6;
}

static void all_pairs(struct stability *lattice)
{
    lattice->approaching = 1;
}

static void other_form(struct stability *lattice)
{
    lattice->scheme.formulation = FORMULATION_LAGRANGIAN;
}

static void other_element(struct stability *lattice)
{
    lattice->scheme.volume_element = VOLUME_ENERGY;
}

static void hotter(struct stability *lattice)
{
    lattice->u *= 1 + 1e-6;
}

#define SPOIL(how) (&(const struct theory){.spoil = how})
static const struct check_mutant rates_mutants[] = {
    {"stability_frozen_width", "smoothing length does not follow density", SPOIL(frozen_width)},
    {"stability_frozen_gradient", "gradient does not follow the smoothing length",
     SPOIL(frozen_gradient)},
    {"stability_curvature", "second derivative of the kernel off by 1e-6", SPOIL(bent_kernel)},
    {"stability_all_pairs", "viscosity also on pairs that part", SPOIL(all_pairs)},
    {"stability_formulation", "theory of lagrangian for vanilla_ice", SPOIL(other_form)},
    {"stability_element", "theory of the energy element for mass", SPOIL(other_element)},
    {"stability_energy", "internal energy off by 1e-6", SPOIL(hotter)},
    {0},
};

CHECK_DEFINE(stability, rates, 908,
             .property = "linearised rates of a wave equal differences of the solver's, c/dx = 1",
             .subjects = subjects, .measure = measure_rates, .mutants = rates_mutants);

/* --- time steps ------------------------------------------------------------------------------- */

struct stepping {
    const char *followed; /* the integrator of the theory; NULL: the solver's own */
    bool newton;          /* the theory ignores predicted smoothing lengths */
};

static bool stop(void *context, double time, uint64_t steps)
{
    (void)context, (void)time;
    return steps < STEPS;
}

/* The wave after the solver's first STEPS steps, and the length of these steps. */
static enum status run_wave(const struct stability *lattice, double kappa, double *dt, double *x,
                            double *v, struct error *error)
{
    static struct hydro_state state;
    const double amplitude = 1e-6;
    struct simulation *simulation;
    struct snapshot s;
    double moved[PARTICLES];
    set_wave(&state, lattice, kappa, DISPLACEMENT, amplitude);
    const struct setup setup = hydro_setup(&state, &lattice->scheme);
    if (simulation_create(&setup, &simulation, error)) return error->status;
    const enum status status = simulation_run(simulation, 1e9, stop, NULL, error);
    simulation_snapshot(simulation, &s);
    for (size_t i = 0; i < s.n; i++) moved[i] = s.x[0][i] - ((double)s.id[i] + 0.5);
    *dt = s.time / STEPS;
    *x = project(moved, &s, kappa, 0) / amplitude;
    *v = project(s.v[0], &s, kappa, 0) / amplitude;
    simulation_destroy(simulation);
    return status;
}

static void measure_wave(struct check_run *run, const struct stepping *stepping,
                         const struct integrator *integrator, enum h_method method)
{
    struct scheme scheme = lattice_scheme();
    struct stability lattice;
    struct error error = {0};
    double dt = 0, x = 0, v = 0, x_theory, v_theory;
    struct integrator even = *integrator;
    even.first_step = 0; /* equal steps, as in the theory */
    scheme.integrator = &even;
    scheme.viscosity = VISCOSITY_NONE;
    scheme.h_method = method;
    const double kappa = 2 * M_PI * 5 / PARTICLES;
    enum status status = stability_begin(&lattice, &scheme, 1.4, &error);
    if (!status) status = run_wave(&lattice, kappa, &dt, &x, &v, &error);
    if (stepping->followed) lattice.scheme.integrator = hydro_integrator(stepping->followed);
    if (stepping->newton) lattice.scheme.h_method = H_NEWTON;
    stability_follow(&lattice, kappa, dt, STEPS, &x_theory, &v_theory);
    const double size = hypot(x_theory, v_theory);
    check_measure(run, status ? 1 : hypot(x - x_theory, v - v_theory) / size, 1e-4, 1e-5,
                  "%s, h %s, c dt/dx %.3f", integrator->member.name,
                  scheme_h_method_family.members[method]->name, dt);
}

static void measure_steps(struct check_run *run, const void *subject)
{
    static const struct stepping right;
    for (size_t k = 0; k < integrator_family.n; k++) {
        const struct integrator *integrator =
            (const struct integrator *)integrator_family.members[k];
        if (!stability_knows(integrator)) {
            check_skip(run, "%s: no theory of its steps (stability/stability_steps.c)",
                       integrator->member.name);
            continue;
        }
        for (size_t method = 0; method < scheme_h_method_family.n; method++)
            measure_wave(run, subject ? subject : &right, integrator, (enum h_method)method);
    }
}

static const struct stepping heun = {.followed = "rk2"},
                             reevaluated = {.followed = "modified_leapfrog"},
                             solved = {.newton = true};
static const struct check_mutant steps_mutants[] = {
    {"stability_all_heun", "the theory of rk2 for every integrator", &heun},
    {"stability_all_modified", "the theory of modified_leapfrog for every integrator",
     &reevaluated},
    {"stability_not_predicted", "theory without predicted widths", &solved},
    {0},
};

CHECK_DEFINE(stability, steps, 950,
             .property = "a wave after 32 steps is where the amplification matrix puts it",
             .measure = measure_steps, .mutants = steps_mutants);

/* --- limits of eta ---------------------------------------------------------------------------- */

/* The eta at which a wave first grows, as the kernel's descriptor declares it; above it the plan
 * warns. */
struct limit {
    const char *kernel;
    enum gradient gradient;
    double eta; /* 0: none */
};

static void measure_limit(struct check_run *run, const struct limit *limit)
{
    struct scheme scheme = hydro_scheme();
    struct stability_interval intervals[4];
    kernel_select(&scheme.kernel, limit->kernel, 5, NULL);
    scheme.gradient = limit->gradient;
    scheme.viscosity = VISCOSITY_NONE;
    const double to = limit->eta > 0 ? limit->eta + 0.5 : 9;
    const int count = stability_intervals(&scheme, 1.4, to, intervals, 4);
    const double want = limit->eta > 0 ? limit->eta : to;
    /* limits are declared to three digits */
    check_measure(run, count > 0 ? fabs(intervals[0].to / want - 1) : 1, 2e-3, 0,
                  limit->eta > 0 ? "%s %s, unstable from eta = %g" : "%s %s, stable up to 9",
                  limit->kernel, scheme_gradient_family.members[limit->gradient]->name, limit->eta);
}

static void measure_limits(struct check_run *run, const void *subject)
{
    if (subject) {
        measure_limit(run, subject);
        return;
    }
    for (size_t k = 0; k < kernel_family.n; k++) {
        struct kernel kernel;
        kernel_select(&kernel, kernel_family.members[k]->name, 5, NULL);
        for (size_t g = 0; g < scheme_members(&scheme_gradient_family, 1); g++) {
            const struct limit limit = {kernel.member.name, (enum gradient)g, kernel.stable_eta[g]};
            if (stability_covers(limit.gradient)) measure_limit(run, &limit);
        }
    }
}

static const struct limit swapped = {"cubic_spline", GRADIENT_STANDARD, 4},
                          narrow = {"wendland_c2", GRADIENT_IA, 3.55},
                          undeclared = {"sinc", GRADIENT_STANDARD, 0};
static const struct check_mutant limit_mutants[] = {
    {"stability_limit_gradient", "the limit of ia declared for the standard gradient", &swapped},
    {"stability_limit_window", "edge of the second stable window taken for the limit", &narrow},
    {"stability_limit_missing", "no limit declared where there is one", &undeclared},
    {0},
};

CHECK_DEFINE(stability, limits, 950, .cost = 0.9,
             .property = "first unstable eta of a lattice, gamma 1.4, no viscosity",
             .measure = measure_limits, .mutants = limit_mutants);
