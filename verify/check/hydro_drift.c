/* SPDX-License-Identifier: GPL-3.0-or-later
 * Measures conservation over a run of a shock tube, for every combination of the families, and the
 * order of each integrator against dt on a smooth problem without viscosity. */
#include <math.h>
#include <string.h>

#include "check.h"
#include "hydro_setup.h"
#include "integrator.h"
#include "order.h"
#include "solver.h" /* the integrator's state, for mutants only */

enum { TUBE = 99 };

/* NULL, or a mutant's integrator with changed rates. */
struct drift_subject {
    enum status (*step)(struct simulation *simulation, double dt, struct error *error);
};

static struct scheme combination(size_t c, const struct integrator *integrator)
{
    struct scheme s = hydro_scheme();
    s.h_tolerance = 1e-10;
    s.integrator = integrator;
    s.cfl = integrator->cfl_per_width ? integrator->cfl / s.eta : integrator->cfl;
    hydro_combine(&s, c);
    return s;
}

/* Bound of the energy drift with internal energy, from the integrator's order; measured 2e-6 to
 * 5e-4. */
static double drift_bound(const struct scheme *scheme)
{
    if (scheme->energy == ENERGY_TOTAL) return 1e-13;
    return scheme->integrator->order == 1 ? 2e-2 : 4e-3;
}

static void drift(struct check_run *run, const struct scheme *scheme,
                  const struct hydro_state *state)
{
    const struct setup setup = hydro_setup(state, scheme);
    struct simulation *simulation = NULL;
    struct conservation before, after;
    struct error error = {0};
    char where[HYDRO_TEXT];
    hydro_describe(scheme, where);
    enum status status = simulation_create(&setup, &simulation, &error);
    if (!status) {
        conservation_sums(simulation, &before);
        status = simulation_run(simulation, 0.1, NULL, NULL, &error);
        conservation_sums(simulation, &after);
        simulation_destroy(simulation);
    }
    if (status) {
        check_measure(run, 1, 0, 0, "%s: %s", where, error.message);
        return;
    }
    check_measure(run, fabs(after.momentum[0] - before.momentum[0]) / after.momentum_scale, 1e-13,
                  2e-15, "momentum, %s", where);
    check_measure(run, fabs(after.energy / before.energy - 1), drift_bound(scheme), 2e-15,
                  "energy, %s", where);
    check_measure(run, fabs(after.mass / before.mass - 1), 1e-15, 2e-16, "mass, %s", where);
    check_measure(run, !(after.momentum_scale > 1e-3), 0, 0, "something moved, %s", where);
}

static void measure_drift(struct check_run *run, const void *subject)
{
    static struct hydro_state state;
    const struct drift_subject *s = subject;
    hydro_tube(&state, TUBE);
    for (size_t i = 0; i < integrator_family.n; i++)
        for (size_t c = 0; c < hydro_combinations() && !check_decided(run); c++) {
            struct scheme scheme =
                combination(c, (const struct integrator *)integrator_family.members[i]);
            struct integrator wrapped = *scheme.integrator;
            if (s) {
                wrapped.step = s->step;
                scheme.integrator = &wrapped;
            }
            drift(run, &scheme, &state);
        }
}

static enum status drags(struct simulation *simulation, double dt, struct error *error)
{
    const enum status status = hydro_integrator("modified_leapfrog")->step(simulation, dt, error);
    simulation->particles.p[0][85] *= 1 + 1e-10;
    return status;
}

static enum status heats(struct simulation *simulation, double dt, struct error *error)
{
    const enum status status = hydro_integrator("modified_leapfrog")->step(simulation, dt, error);
    simulation->particles.e[85] *= 1 + 1e-9;
    return status;
}

static const struct check_mutant drift_mutants[] = {
    {"drift_momentum", "one particle gains 1e-10 of its momentum a step",
     &(struct drift_subject){drags}},
    {"drift_energy", "one particle gains 1e-9 of its energy a step",
     &(struct drift_subject){heats}},
    {0},
};

CHECK_DEFINE(
    hydro, conservation, 750, .cost = 0.3,
    .property = "momentum and mass to round-off, energy to round-off (total) or the order in dt",
    .measure = measure_drift, .mutants = drift_mutants);

/* --- order against dt ------------------------------------------------------------------------- */

enum { WAVE = 24, LADDER = 5 };

/* Velocities after time T in equal steps of a scheme's integrator, sorted by position. */
static enum status wave_after(const struct scheme *scheme, int steps, double T, double *v,
                              struct error *error)
{
    static struct hydro_state state;
    hydro_wave(&state, WAVE);
    const struct setup setup = hydro_setup(&state, scheme);
    struct simulation *simulation = NULL;
    enum status status = simulation_create(&setup, &simulation, error);
    for (int k = 1; k <= steps && !status; k++)
        status = simulation_run(simulation, T * k / steps, NULL, NULL, error);
    if (!status) {
        struct snapshot snapshot;
        simulation_snapshot(simulation, &snapshot);
        for (size_t i = 0; i < WAVE; i++) v[snapshot.id[i]] = snapshot.v[0][i];
    }
    simulation_destroy(simulation);
    return status;
}

static void measure_order(struct check_run *run, const void *subject)
{
    static const int steps[LADDER] = {16, 24, 36, 54, 81};
    const struct drift_subject *s = subject;
    const double T = 0.2;
    double exact[WAVE], v[WAVE], error[LADDER], dt[LADDER];
    struct error failure = {0};
    struct scheme scheme = hydro_scheme();
    scheme.viscosity = VISCOSITY_NONE;
    scheme.cfl = 50; /* the ladder sets the time step */
    scheme.integrator = hydro_integrator("rk3");
    enum status status = wave_after(&scheme, 1000, T, exact, &failure);
    for (size_t i = 0; i < integrator_family.n && !status; i++) {
        struct integrator tried = *(const struct integrator *)integrator_family.members[i];
        if (s) tried.step = s->step;
        scheme.integrator = &tried;
        for (int l = 0; l < LADDER && !status; l++) {
            status = wave_after(&scheme, steps[l], T, v, &failure);
            dt[l] = T / steps[l];
            error[l] = 0;
            for (int k = 0; k < WAVE; k++) error[l] += fabs(v[k] - exact[k]) / WAVE;
        }
        struct order_fit fit;
        if (status || order_fit(LADDER, dt, error, NULL, &fit, &failure)) break;
        check_series(run, tried.member.name, LADDER, dt, error);
        check_measure(run, fabs(fit.order - tried.order), 0.25, 0.02,
                      "order %.3f of %s against dt, declared %d", fit.order, tried.member.name,
                      tried.order);
        check_measure(run, (fit.high - fit.low) / 2, ORDER_HALF_WIDTH_MAX, 0.005,
                      "its interval, %s", tried.member.name);
        check_measure(run, fit.finest, tried.order == 1 ? 2e-3 : 2e-4, 1e-9,
                      "its error at the finest dt, %s", tried.member.name);
    }
    if (failure.message[0]) check_measure(run, 1, 0, 0, "%s", failure.message);
}

static enum status first_order(struct simulation *simulation, double dt, struct error *error)
{
    return hydro_integrator("symplectic_euler")->step(simulation, dt, error);
}

static enum status second_order(struct simulation *simulation, double dt, struct error *error)
{
    return hydro_integrator("rk2")->step(simulation, dt, error);
}

/* Heun's second stage with the weights 0.49 and 0.51. */
static enum status unbalanced(struct simulation *simulation, double dt, struct error *error)
{
    const enum status status = hydro_integrator("rk2")->step(simulation, 0.98 * dt, error);
    struct particles *a = &simulation->particles;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        a->x[0][i] += 0.02 * dt * a->p[0][i] * a->m_inverse[i];
        a->p[0][i] += 0.02 * dt * a->F[0][i];
        a->e[i] += 0.02 * dt * a->de[i] * 0.9;
    }
    return status ? status : evaluate_rates(simulation, error);
}

static const struct check_mutant order_mutants[] = {
    {"integrator_first_order", "every integrator is symplectic Euler",
     &(struct drift_subject){first_order}},
    {"integrator_second_order", "every integrator is rk2", &(struct drift_subject){second_order}},
    {"integrator_unbalanced", "weights of the last stage wrong by 2 %",
     &(struct drift_subject){unbalanced}},
    {0},
};

CHECK_DEFINE(hydro, integrator_order, 750,
             .property = "error at a fixed time falls as dt^order on a smooth wave",
             .measure = measure_order, .mutants = order_mutants);
