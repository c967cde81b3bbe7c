/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares runs over a few natural time steps, with particles that cross the ends of the box, with
 * the oracle: every integrator, each with its own choice of time steps, the last one shortened. */
#include "check.h"
#include "hydro_against.h"
#include "hydro_setup.h"
#include "integrator.h"

enum { PARTICLES = 34, FAR_PARTICLES = 150, STEPS = 5 };

/* Gas that crosses the left end of the box; cold gas whose outermost particles pass each other
 * there in the first step; a contact with one-sided neighbourhoods. */
enum start { RUNNING, PASSING, CONTACT };

/* A run, or a mutant's change of the solver's setup, where the right one is hydro_scheme() with
 * this integrator and viscosity. */
struct steps_subject {
    struct hydro_fault fault;
    const char *integrator; /* of a mutant */
    struct scheme scheme;
    double part; /* t_end = (STEPS + part) first steps */
    enum start start;
};

static void subjects(struct check_run *run)
{
    struct steps_subject subject = {.start = RUNNING};
    for (size_t i = 0; i < integrator_family.n; i++)
        for (int c = 0; c < 9; c++) {
            struct scheme s = hydro_scheme();
            s.integrator = (const struct integrator *)integrator_family.members[i];
            s.cfl = s.integrator->cfl_per_width ? 0.4 : s.integrator->cfl;
            s.viscosity = c % 3 == 0 ? VISCOSITY_TIME_DEPENDENT : VISCOSITY_CONSTANT;
            s.energy = c % 2 ? ENERGY_TOTAL : ENERGY_INTERNAL;
            if (c == 2 || c == 3) s.gradient = GRADIENT_IA;
            if (c >= 7) { /* predicted smoothing lengths, once as by default */
                s.h_method = H_PREDICTED;
                s.pair_width = c == 7 ? PAIR_WIDTH_MAX : PAIR_WIDTH_HARMONIC;
                if (c == 7) hydro_set_kernel(&s, "quadratic_spline");
                if (c == 8) s.gradient = GRADIENT_IA, s.viscosity = VISCOSITY_RECONSTRUCTED;
            }
            if (c == 6)
                s.viscosity = VISCOSITY_NONE,
                s.eta = 4.8; /* so that coincident particles have an h */
            if (c == 4 || c == 5) {
                s.formulation = FORMULATION_LAGRANGIAN;
                s.volume_element = c == 5 ? VOLUME_ENERGY : VOLUME_MASS;
            }
            subject.scheme = s;
            subject.part = c % 2 ? 0.3 : 0.8;
            subject.start = c == 6 ? PASSING : RUNNING;
            check_subject(run, &subject, sizeof subject);
        }
    subject = (struct steps_subject){.scheme = hydro_scheme(), .part = 0.3, .start = CONTACT};
    check_subject(run, &subject, sizeof subject);
}

static struct steps_subject of_mutant(const struct steps_subject *mutant)
{
    struct steps_subject subject = {
        .fault = mutant->fault, .scheme = hydro_scheme(), .part = 0.3, .start = RUNNING};
    subject.scheme.integrator = hydro_integrator(mutant->integrator);
    subject.scheme.viscosity = mutant->scheme.viscosity;
    subject.scheme.cfl = subject.scheme.integrator->cfl;
    return subject;
}

static void prepare(struct hydro_state *state, enum start start)
{
    if (start == CONTACT) {
        hydro_contact(state, FAR_PARTICLES);
        return;
    }
    if (start == PASSING)
        hydro_wave(state, PARTICLES);
    else
        hydro_disordered(state, PARTICLES);
    for (size_t i = 0; i < state->n; i++) {
        state->v[0][i] = 0.3 * state->v[0][i] - (state->x[0][i] < state->lo[0] + 0.1 ? 1.5 : 0.2);
        if (start == PASSING) state->v[0][i] *= 0.01, state->u[i] *= 1e-3;
    }
    if (start != PASSING) return;
    state->x[0][0] = state->lo[0] + 5e-4;
    state->x[0][PARTICLES - 1] = state->hi[0] - 5e-4;
    state->v[0][0] = -1;
    state->v[0][PARTICLES - 1] = 1;
}

static void measure(struct check_run *run, const void *subject)
{
    const struct steps_subject *given = subject;
    const struct steps_subject s = given->integrator ? of_mutant(given) : *given;
    static struct hydro_state state;
    prepare(&state, s.start);
    char where[HYDRO_TEXT];
    hydro_describe(&s.scheme, where);
    hydro_against_steps(run, hydro_setup(&state, &s.scheme), &s.fault, STEPS + s.part, where);
}

static struct integrator replaced;

static void replace(struct setup *setup, const char *name)
{
    replaced = *setup->scheme.integrator;
    replaced.step = hydro_integrator(name)->step;
    setup->scheme.integrator = &replaced;
}

static void never_evaluated_again(struct setup *setup)
{
    replace(setup, "leapfrog");
}

static void heun_for_midpoint(struct setup *setup)
{
    replace(setup, "rk2");
}

static enum status long_step(struct simulation *simulation, double dt, struct error *error)
{
    return hydro_integrator("rk3")->step(simulation, dt * (1 + 1e-9), error);
}

static void step_too_long(struct setup *setup)
{
    replace(setup, "rk3");
    replaced.step = long_step;
}

static void alpha_stands_still(struct setup *setup)
{
    setup->scheme.viscosity = VISCOSITY_CONSTANT;
    setup->scheme.alpha = setup->scheme.alpha_min;
    setup->scheme.beta = 2 * setup->scheme.alpha;
}

static void end_taken_for_evaluated(struct setup *setup)
{
    replace(setup, "predicted_midpoint");
    replaced.ends_evaluated = true;
}

#define FAULT(name, kind, ...)                                                                     \
    (&(const struct steps_subject){                                                                \
        .fault = __VA_ARGS__, .integrator = name, .scheme = {.viscosity = VISCOSITY_##kind}})
static const struct check_mutant mutants[] = {
    {"hydro_no_second_evaluation", "leapfrog where modified_leapfrog is asked for",
     FAULT("modified_leapfrog", CONSTANT, {.spoil = never_evaluated_again})},
    {"hydro_heun_for_vl2", "rk2 where vl2 is asked for",
     FAULT("vl2", CONSTANT, {.spoil = heun_for_midpoint})},
    {"hydro_step_too_long", "every step too long by 1e-9",
     FAULT("rk3", CONSTANT, {.spoil = step_too_long})},
    {"hydro_cfl", "cfl too large by 1e-6",
     FAULT("rk2", CONSTANT, HYDRO_TIMES(scheme.cfl, 1 + 1e-6))},
    {"hydro_alpha_constant", "alpha does not evolve",
     FAULT("symplectic_euler", TIME_DEPENDENT, {.spoil = alpha_stands_still})},
    {"hydro_alpha_max", "alpha_max off in the sixth digit",
     FAULT("rk2", TIME_DEPENDENT, HYDRO_SET(scheme.alpha_max, (double)1.49999F))},
    {"hydro_end_not_evaluated", "derived fields of the last midpoint, not of the end",
     FAULT("predicted_midpoint", CONSTANT, {.spoil = end_taken_for_evaluated})},
    {"hydro_h_predicted", "h predicted where Newton is asked for",
     FAULT("leapfrog", CONSTANT, HYDRO_SET(scheme.h_method, H_PREDICTED))},
    {0},
};

CHECK_DEFINE(hydro, time_stepping, 710, .cost = 0.8,
             .property = "the state at t_end and the number of steps equal the oracle's",
             .subjects = subjects, .measure = measure, .mutants = mutants);
