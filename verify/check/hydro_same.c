/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks that threads, specialised loops and skipped work do not change results. */
#include <math.h>

#include "check.h"
#include "hydro_setup.h"
#include "integrator.h"
#include "worst.h"

static bool stop(void *context, double time, uint64_t steps)
{
    (void)context, (void)time;
    return steps % 32 != 0;
}

/* Runs to t_end, at once or with a stop at every possible time. */
static enum status run_on(struct simulation *simulation, double t_end, bool stops,
                          struct error *error)
{
    struct snapshot now = {0};
    enum status status = STATUS_OK;
    while (!status && now.time < t_end) {
        status = simulation_run(simulation, t_end, stops ? stop : NULL, NULL, error);
        simulation_snapshot(simulation, &now);
    }
    return status;
}

/* Runs two setups for the same time, the second one with stops if asked; the largest difference of
 * any state variable relative to its largest value; NaN if one did not run. */
static double difference(const struct setup *a, const struct setup *b, bool stops, double t_end,
                         struct error *error)
{
    const struct setup *setups[] = {a, b};
    struct simulation *simulations[2] = {NULL, NULL};
    struct snapshot s[2];
    struct rates r[2];
    double worst = (double)NAN;
    for (int k = 0; k < 2; k++) {
        if (simulation_create(setups[k], &simulations[k], error)) goto done;
        if (run_on(simulations[k], t_end, k && stops, error)) goto done;
        simulation_snapshot(simulations[k], &s[k]);
        simulation_rates(simulations[k], &r[k]);
    }
    const double *const pairs[][2] = {
        {s[0].x[0], s[1].x[0]},         {s[0].v[0], s[1].v[0]},    {s[0].u, s[1].u},
        {s[0].rho, s[1].rho},           {s[0].h, s[1].h},          {s[0].P, s[1].P},
        {r[0].force[0], r[1].force[0]}, {r[0].energy, r[1].energy}};
    worst = r[0].time_step == r[1].time_step ? 0 : fabs(r[0].time_step / r[1].time_step - 1);
    for (size_t f = 0; f < sizeof pairs / sizeof *pairs; f++)
        worst_keep(&worst, hydro_difference(s[0].n, pairs[f][0], pairs[f][1]));
    if (s[0].n == 0 || s[0].n != s[1].n) worst = (double)NAN;
done:
    simulation_destroy(simulations[0]);
    simulation_destroy(simulations[1]);
    return worst;
}

/* A further change of the second setup. */
typedef void spoiler(struct setup *setup, struct hydro_state *state);

static void one_ulp(struct setup *setup, struct hydro_state *state)
{
    (void)setup;
    state->u[state->n / 2] = nextafter(state->u[state->n / 2], 10);
}

static void one_ulp_mass(struct setup *setup, struct hydro_state *state)
{
    (void)setup;
    state->m[0] = nextafter(state->m[0], 10);
}

static void ia_for_standard(struct setup *setup, struct hydro_state *state)
{
    (void)state;
    setup->scheme.gradient = !setup->scheme.gradient;
}

static void swapped_kernel(struct setup *setup, struct hydro_state *state)
{
    (void)state;
    const double eta = setup->scheme.eta;
    const bool cubic = setup->scheme.kernel.w == hydro_scheme().kernel.w;
    hydro_set_kernel(&setup->scheme, cubic ? "quadratic_spline" : "cubic_spline");
    setup->scheme.eta = eta;
}

static void swapped_forms(struct setup *setup, struct hydro_state *state)
{
    (void)state;
    if (setup->scheme.formulation == FORMULATION_VANILLA_ICE)
        setup->scheme.pair_width =
            setup->scheme.pair_width == PAIR_WIDTH_MAX ? PAIR_WIDTH_MEAN : PAIR_WIDTH_MAX;
}

struct same_subject {
    spoiler *spoil;
};
static const struct same_subject with_one_ulp = {one_ulp}, with_one_ulp_mass = {one_ulp_mass},
                                 with_other_gradient = {ia_for_standard},
                                 with_swapped_kernel = {swapped_kernel},
                                 with_swapped_forms = {swapped_forms};

/* A run, and the same run computed differently. */
struct same_run {
    const struct scheme *scheme;
    const struct hydro_state *state;
    double t_end, bound;
    int threads; /* threads of the second run */
    bool generic, skip;
    const char *what;
};

static void compare(struct check_run *run, const struct same_subject *subject,
                    const struct same_run *same)
{
    static struct hydro_state other;
    struct error error = {0};
    char where[HYDRO_TEXT];
    other = *same->state;
    const struct setup first = hydro_setup(same->state, same->scheme);
    struct setup second = hydro_setup(&other, same->scheme);
    second.threads = same->threads;
    second.generic = same->generic;
    second.skip = same->skip;
    if (subject) subject->spoil(&second, &other);
    hydro_describe(same->scheme, where);
    check_measure(run, difference(&first, &second, false, same->t_end, &error), same->bound, 0,
                  "%s, %s%s%s", same->what, where, error.message[0] ? ": " : "", error.message);
}

static void measure_threads(struct check_run *run, const void *subject)
{
    static struct hydro_state state;
    const struct scheme standard = hydro_scheme();
    struct scheme fancy = standard;
    fancy.gradient = GRADIENT_IA;
    fancy.formulation = FORMULATION_LAGRANGIAN;
    fancy.volume_element = VOLUME_ENERGY;
    fancy.viscosity = VISCOSITY_RECONSTRUCTED;
    fancy.integrator = hydro_integrator("predicted_midpoint");
    fancy.energy = ENERGY_TOTAL;
    /* odd, and enough particles for several threads: src/core/solver.h, WORTH_A_THREAD */
    hydro_disordered(&state, 2113);
    for (int threads = 2; threads <= 7; threads += 5) {
        struct same_run same = {.scheme = &standard,
                                .state = &state,
                                .t_end = 2e-4,
                                .threads = threads,
                                .what = "n 2113"};
        compare(run, subject, &same);
        same.scheme = &fancy;
        compare(run, subject, &same);
    }
}

static const struct check_mutant threads_mutants[] = {
    {"same_one_ulp", "one particle's energy differs in its last bit", &with_one_ulp},
    {"same_one_ulp_mass", "one particle's mass differs in its last bit", &with_one_ulp_mass},
    {0},
};

CHECK_DEFINE(hydro, threads, 750, .cost = 0.9, .property = "the same bits with 1, 2 and 7 threads",
             .measure = measure_threads, .mutants = threads_mutants);

/* A run with skips must omit some work and conserve momentum. */
static void measure_skipped_run(struct check_run *run, const struct hydro_state *state,
                                const struct scheme *scheme, double t_end)
{
    struct simulation *simulation;
    struct simulation_cost cost;
    struct conservation before, after;
    struct error error = {0};
    struct setup setup = hydro_setup(state, scheme);
    setup.skip = true;
    if (simulation_create(&setup, &simulation, &error)) {
        check_measure(run, 1, 0, 0, "the run with skips: %s", error.message);
        return;
    }
    conservation_sums(simulation, &before);
    if (simulation_run(simulation, t_end, NULL, NULL, &error)) {
        check_measure(run, 1, 0, 0, "the run with skips: %s", error.message);
    } else {
        simulation_cost(simulation, &cost);
        conservation_sums(simulation, &after);
        check_measure(run, !(cost.skipped_particle_updates > 0), 0, 0, "some work was left out");
        check_measure(run, fabs(after.momentum[0] - before.momentum[0]) / after.momentum_scale,
                      1e-12, 1e-14, "momentum of the run with skips");
    }
    simulation_destroy(simulation);
}

static void measure_skip(struct check_run *run, const void *subject)
{
    static struct hydro_state state;
    const double t_end = 0.06, bound = 2e-10;
    for (int c = 0; c < 8; c++) {
        struct scheme scheme = hydro_scheme();
        hydro_tube(&state, c == 7 ? 451 : 900);
        if (c & 1)
            for (size_t i = 0; i < state.n; i++) state.v[0][i] = 0.37; /* sleeping gas drifts */
        if (c & 2) {
            hydro_set_kernel(&scheme, "quadratic_spline");
            scheme.integrator = hydro_integrator("predicted_midpoint");
            scheme.energy = ENERGY_TOTAL;
            scheme.cfl = 0.8 / scheme.eta;
            scheme.h_method = H_PREDICTED;
            scheme.pair_width = PAIR_WIDTH_MAX;
        }
        if (c == 4 || c == 6) scheme.viscosity = VISCOSITY_TIME_DEPENDENT;
        if (c == 4) { /* a wide kernel, and a separate pass for the time step */
            hydro_set_kernel(&scheme, "wendland_c4");
            scheme.integrator = hydro_integrator("leapfrog");
        }
        if (c == 5) {
            scheme.gradient = GRADIENT_IA;
            scheme.viscosity = VISCOSITY_RECONSTRUCTED;
        }
        compare(run, subject,
                &(struct same_run){.scheme = &scheme,
                                   .state = &state,
                                   .t_end = t_end,
                                   .bound = bound,
                                   .threads = 1,
                                   .skip = true,
                                   .what = c & 1 ? "moving tube" : "tube at rest"});
        measure_skipped_run(run, &state, &scheme, t_end);
    }
}

static const struct check_mutant skip_mutants[] = {
    {"skip_changes_gradient", "another gradient where work is left out", &with_other_gradient},
    {"skip_changes_kernel", "another kernel where work is left out", &with_swapped_kernel},
    {0},
};

CHECK_DEFINE(
    hydro, skip, 750, .cost = 0.2,
    .property = "the same answer, to round-off, with and without leaving out idle particles",
    .measure = measure_skip, .mutants = skip_mutants);

/* A stop iterates h again, so bits may differ. */
static void measure_stops(struct check_run *run, const void *subject)
{
    static struct hydro_state state, other;
    struct error error = {0};
    char where[HYDRO_TEXT];
    for (size_t k = 0; k < integrator_family.n; k++) {
        struct scheme scheme = hydro_scheme();
        scheme.integrator = (const struct integrator *)integrator_family.members[k];
        scheme.viscosity = VISCOSITY_TIME_DEPENDENT;
        hydro_tube(&state, 200);
        other = state;
        const struct setup first = hydro_setup(&state, &scheme);
        struct setup second = hydro_setup(&other, &scheme);
        if (subject) ((const struct same_subject *)subject)->spoil(&second, &other);
        hydro_describe(&scheme, where);
        check_measure(run, difference(&first, &second, true, 0.1, &error), 1e-10, 0, "%s%s%s",
                      where, error.message[0] ? ": " : "", error.message);
    }
}

static const struct check_mutant stops_mutants[] = {
    {"stops_change_gradient", "another gradient in the run that stops", &with_other_gradient},
    {0},
};

CHECK_DEFINE(
    hydro, stops, 750,
    .property =
        "the same answer, to the tolerance of h, whether a run is stopped in between or not",
    .measure = measure_stops, .mutants = stops_mutants);

/* Every entry of the tables of specialised loops: kernel x gradient x form, formulation x viscosity
 * x energy, and the volume element's terms in the density sum. */
static void measure_specialised(struct check_run *run, const void *subject)
{
    static struct hydro_state state;
    struct error error;
    hydro_disordered(&state, 150);
    for (size_t k = 0; k < kernel_family.n; k++)
        for (size_t p = 0; p < scheme_pair_width_family.n; p++) {
            size_t excluded = 0;
            for (size_t c = 0; c < hydro_combinations() && !check_decided(run); c++) {
                struct scheme s = hydro_scheme();
                s.h_tolerance = 1e-10;
                hydro_set_kernel(&s, kernel_family.members[k]->name);
                hydro_combine(&s, c);
                s.pair_width = (enum pair_width)p;
                const struct same_run same = {.scheme = &s,
                                              .state = &state,
                                              .t_end = 1e-4,
                                              .bound = 1e-12,
                                              .threads = 1,
                                              .generic = true,
                                              .what = "generic"};
                if (scheme_check(&s, 1, &error))
                    excluded++;
                else
                    compare(run, subject, &same);
            }
            if (excluded)
                check_skip(run, "%s, width %s: %zu of %zu schemes: %s",
                           kernel_family.members[k]->name,
                           scheme_pair_width_family.members[p]->name, excluded,
                           hydro_combinations(), error.message);
        }
}

static const struct check_mutant specialised_mutants[] = {
    {"specialisation_gradients_swapped", "the specialisations of standard and ia exchanged",
     &with_other_gradient},
    {"specialisation_kernel_swapped", "one kernel's specialisation in the others' places",
     &with_swapped_kernel},
    {"specialisation_form_swapped", "the specialisation of width max in the place of mean",
     &with_swapped_forms},
    {0},
};

CHECK_DEFINE(hydro, specialised, 750, .cost = 0.7,
             .property = "specialised loops = generic loops, for every entry of every table",
             .measure = measure_specialised, .mutants = specialised_mutants);
