/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks that the solver starts from difficult states: coincident particles, light particles at
 * rest beside a high pressure, and a density that falls steeply within one smoothing length. */
#include <math.h>

#include "check.h"
#include "hydro_setup.h"
#include "simulation.h"
#include "worst.h"

enum { PARTICLES = 24 };

/* Parameters that mutants change: the widths of the two kernels, and the mass of a light
 * particle. */
struct start {
    double narrow, wide, light;
};

static const struct start right = {1.5, 4.8, 1e-3};

static struct scheme scheme_of(const char *kernel, double eta)
{
    struct scheme scheme = hydro_scheme();
    hydro_set_kernel(&scheme, kernel);
    scheme.eta = eta;
    return scheme;
}

/* Pairs of coincident particles, two spacings apart. */
static void coincident(struct hydro_state *state)
{
    *state = (struct hydro_state){.dim = 1, .n = PARTICLES, .hi = {PARTICLES}, .gamma = 1.4};
    for (int i = 0; i < PARTICLES; i++) {
        state->x[0][i] = i - i % 2 + 1;
        state->m[i] = 1;
        state->u[i] = 1;
    }
}

/* Distance between the particles of a pair, the same for all pairs, in thousandths of the spacing;
 * NaN if the solver did not start. */
static double distance(const struct scheme *scheme)
{
    static struct hydro_state state;
    struct simulation *simulation;
    struct snapshot s;
    struct error error;
    coincident(&state);
    const struct setup setup = hydro_setup(&state, scheme);
    if (simulation_create(&setup, &simulation, &error)) return (double)NAN;
    simulation_snapshot(simulation, &s);
    double least = HUGE_VAL, most = 0;
    for (size_t i = 0; i < s.n; i += 2) {
        least = fmin(least, s.x[0][i + 1] - s.x[0][i]);
        most = fmax(most, s.x[0][i + 1] - s.x[0][i]);
    }
    simulation_destroy(simulation);
    return most - least <= 1e-9 ? 1e3 * least : (double)NAN;
}

/* The number of steps up to t = 1.5 cfl sqrt(h/a), from rest, in a tube with a pressure ratio of
 * 1e9.
 */
static double steps_to(double light)
{
    static struct hydro_state state;
    const struct scheme scheme = scheme_of("cubic_spline", 2);
    struct simulation *simulation;
    struct snapshot s;
    struct rates rates;
    struct simulation_cost cost;
    struct error error;
    state = (struct hydro_state){.dim = 1, .n = PARTICLES, .hi = {PARTICLES}, .gamma = 1.4};
    for (int i = 0; i < PARTICLES; i++) {
        state.x[0][i] = i + 0.5;
        state.m[i] = i < PARTICLES / 2 ? 1 : light;
        state.u[i] = i < PARTICLES / 2 || light >= 1 ? 1 : 1e-6;
    }
    const struct setup setup = hydro_setup(&state, &scheme);
    if (simulation_create(&setup, &simulation, &error)) return (double)NAN;
    simulation_snapshot(simulation, &s);
    simulation_rates(simulation, &rates);
    double pull = 0;
    for (size_t i = 0; i < s.n; i++) worst_keep(&pull, fabs(rates.force[0][i]) / (s.m[i] * s.h[i]));
    const double end = fmin(1.5 * scheme.cfl / sqrt(pull), rates.time_step);
    const enum status status = simulation_run(simulation, end, NULL, NULL, &error);
    simulation_cost(simulation, &cost);
    simulation_destroy(simulation);
    return status ? (double)NAN : (double)cost.steps;
}

/* Where the density falls by a factor of 200 within one smoothing length, the iteration
 * h -> eta m/rho(h) leaves its root. The result compares the speed of the first particle beyond the
 * fall, after some steps with predicted h, with that in a run whose h are roots. */
static double lost_push(void)
{
    enum { DENSE = 400, THIN = 4 };
    static struct hydro_state state;
    double speed[2] = {NAN, NAN};
    for (int method = 0; method < 2; method++) {
        struct scheme scheme = scheme_of("quadratic_spline", 1.5);
        struct simulation *simulation;
        struct snapshot s;
        struct error error;
        scheme.integrator = hydro_integrator("predicted_midpoint");
        scheme.cfl = 0.5;
        scheme.h_method = method ? H_PREDICTED : H_NEWTON;
        state = (struct hydro_state){.dim = 1, .n = DENSE + THIN, .hi = {4}, .gamma = 5. / 3};
        for (int i = 0; i < DENSE + THIN; i++) {
            state.x[0][i] = i < DENSE ? 2 * (i + 0.5) / DENSE : 2 + 0.5 * (i - DENSE + 0.5);
            state.m[i] = 2. / DENSE;
            state.u[i] = i < DENSE ? 0.1 : 1e-4;
        }
        const struct setup setup = hydro_setup(&state, &scheme);
        if (simulation_create(&setup, &simulation, &error)) return (double)NAN;
        if (!simulation_run(simulation, 0.2, NULL, NULL, &error)) {
            simulation_snapshot(simulation, &s);
            speed[method] = s.v[0][DENSE];
        }
        simulation_destroy(simulation);
    }
    return fabs(speed[1] / speed[0] - 1);
}

static void measure(struct check_run *run, const void *subject)
{
    const struct start *start = subject ? subject : &right;
    const struct scheme narrow = scheme_of("quadratic_spline", start->narrow),
                        wide = scheme_of("cubic_spline", start->wide);
    check_measure(run, fabs(distance(&narrow) - 1), 1e-9, 1e-12,
                  "coincident pairs, quadratic eta %g: a thousandth of the spacing apart",
                  start->narrow);
    check_measure(run, distance(&wide), 0, 0, "coincident pairs, cubic eta %g: left where they are",
                  start->wide);
    check_measure(run, 2 / steps_to(start->light), 1, 0,
                  "light particles (%g) at rest: steps to 1.5 cfl sqrt(h/a), two at least",
                  start->light);
    check_measure(run, steps_to(1), 1, 0, "equal particles: the first step is not cut");
    check_measure(run, lost_push(), 0.2, 1e-6,
                  "density falls 200 times within a width: speed beyond, h predicted");
}

static const struct start stays = {4.8, 4.8, 1e-3}, moves = {1.5, 1.5, 1e-3}, heavy = {1.5, 4.8, 1};
static const struct check_mutant mutants[] = {
    {"start_not_separated", "coincident particles stay although they have no h", &stays},
    {"start_separated", "coincident particles are moved although they have an h", &moves},
    {"start_full_step", "a first step that does not know accelerations", &heavy},
    {0},
};

CHECK_DEFINE(
    stability, start, 950,
    .property =
        "coincident particles get an h; the first step is at most cfl sqrt(h/a); h stays a root",
    .measure = measure, .mutants = mutants);
