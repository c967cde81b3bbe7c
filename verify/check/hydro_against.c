/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "hydro_against.h"

#include <math.h>
#include <string.h>

#include "integrator.h"
#include "oracle.h"
#include "solver.h"
#include "worst.h"

/* --- one evaluation --------------------------------------------------------------------------- */

/* Largest |got - want| over the particles, relative to the largest |want|. */
struct comparison {
    double error, scale;
};

static void compare(struct comparison *c, double got, long double want)
{
    worst_keep(&c->error, (double)fabsl(got - want));
    c->scale = fmax(c->scale, (double)fabsl(want));
}

static void report(struct check_run *run, const struct comparison *c, double bound, double floor,
                   const char *quantity, const char *where)
{
    check_measure(run, c->scale > 0 ? c->error / c->scale : c->error, bound, floor, "%s, %s",
                  quantity, where);
}

static void judge_rates(struct check_run *run, const struct simulation *simulation,
                        const struct oracle *oracle, const char *where)
{
    struct snapshot got;
    struct rates rates;
    simulation_snapshot(simulation, &got);
    simulation_rates(simulation, &rates);
    struct comparison h = {0}, rho = {0}, P = {0}, V = {0}, F = {0}, de = {0}, dalpha = {0};
    struct comparison shift = {0}, mass = {0}, momentum = {0}, energy = {0};
    const bool shifts = oracle->scheme.shifting != SHIFTING_NONE;
    for (size_t i = 0; i < got.n; i++) {
        const struct oracle_particle *want = &oracle->particles[got.id[i]];
        compare(&h, got.h[i], want->h);
        compare(&rho, got.rho[i], want->rho);
        compare(&P, got.P[i], want->P);
        compare(&V, got.volume[i], want->V);
        for (int a = 0; a < oracle->dim; a++) compare(&F, rates.force[a][i], want->F[a]);
        compare(&de, rates.energy[i], want->de);
        if (rates.alpha) compare(&dalpha, rates.alpha[i], want->dalpha);
        if (!shifts || !rates.shift.mass) continue;
        compare(&mass, rates.shift.mass[i], want->dm);
        compare(&energy, rates.shift.energy[i], want->de_shift);
        for (int a = 0; a < oracle->dim; a++) {
            compare(&shift, rates.shift.velocity[a][i], want->shift[a]);
            compare(&momentum, rates.shift.momentum[a][i], want->dp_shift[a]);
        }
    }
    if (shifts != (rates.shift.mass != NULL)) mass.error = (double)NAN;
    if (got.n != oracle->n) h.error = (double)NAN;
    /* src damps close pairs by a series with a relative error up to 8e-7 */
    const bool series = oracle->scheme.viscosity == VISCOSITY_RECONSTRUCTED ||
                        oracle->scheme.viscosity == VISCOSITY_PROJECTED;
    const double bound = series ? 1e-10 : 1e-12, floor = series ? 1e-12 : 2e-14;
    report(run, &h, 1e-13, 2e-15, "smoothing length", where);
    report(run, &rho, 1e-13, 2e-15, "density", where);
    report(run, &P, 1e-13, 2e-15, "pressure", where);
    report(run, &V, 1e-13, 2e-15, "volume", where);
    report(run, &F, bound, floor, "force", where);
    report(run, &de, bound, floor, "rate of energy", where);
    const struct comparison *const exchange[] = {&shift, &mass, &momentum, &energy};
    static const char *const names[] = {"shift", "mass exchanged", "momentum exchanged",
                                        "energy exchanged"};
    for (int k = 0; shifts && k < 4; k++) report(run, exchange[k], 1e-12, 2e-14, names[k], where);
    if (oracle->scheme.viscosity == VISCOSITY_TIME_DEPENDENT)
        report(run, &dalpha, 1e-12, 2e-14, "rate of alpha", where);
    const double step = (double)oracle_time_step(oracle);
    check_measure(run, fabs(rates.time_step / step - 1), 1e-13, 2e-15, "time step, %s", where);
}

/* --- after some steps
 * --------------------------------------------------------------------------- */

/* True if a position is outside the box; *worst: the largest distance from the correct one. */
static bool judge_position(const double *const *x, size_t i, const struct oracle *oracle,
                           const struct oracle_particle *want, double *worst)
{
    bool outside = false;
    for (int a = 0; a < oracle->dim; a++) {
        const long double away = x[a][i] - want->x[a], period = oracle->period[a];
        worst_keep(worst, (double)fabsl(away - period * roundl(away / period)));
        outside |= !(x[a][i] >= (double)oracle->lo[a] &&
                     x[a][i] < (double)(oracle->lo[a] + oracle->period[a]));
    }
    return outside;
}

static void judge_steps(struct check_run *run, const struct simulation *simulation,
                        const struct oracle *oracle, const char *where)
{
    struct snapshot got;
    struct rates rates;
    struct simulation_cost cost;
    double x = 0, v = 0, u = 0, rho = 0, P = 0, h = 0, volume = 0, alpha = 0, outside = 0;
    const long double kinetic = oracle->scheme.energy == ENERGY_TOTAL ? 0.5L : 0;
    simulation_snapshot(simulation, &got);
    simulation_rates(simulation, &rates);
    simulation_cost(simulation, &cost);
    for (size_t i = 0; i < got.n; i++) {
        const struct oracle_particle *want = &oracle->particles[got.id[i]];
        long double p2 = 0;
        outside += judge_position(got.x, i, oracle, want, &x);
        for (int a = 0; a < oracle->dim; a++) {
            worst_keep(&v, (double)fabsl(got.v[a][i] - want->p[a] / want->m));
            p2 += want->p[a] * want->p[a];
        }
        worst_keep(&u, (double)fabsl(got.u[i] - (want->e - kinetic * p2 / want->m) / want->m));
        worst_keep(&rho, (double)fabsl(got.rho[i] - want->rho));
        worst_keep(&P, (double)fabsl(got.P[i] - want->P));
        worst_keep(&h, (double)fabsl(got.h[i] - want->h));
        worst_keep(&volume, (double)fabsl(got.volume[i] - want->V));
        if (rates.alpha) worst_keep(&alpha, (double)fabsl(rates.alpha[i] - want->dalpha));
    }
    if (got.n != oracle->n) x = (double)NAN;
    const double bound = 1e-11, floor = 2e-13;
    check_measure(run, x, bound, floor, "position, %s", where);
    check_measure(run, outside, 0, 0, "positions outside the box, %s", where);
    check_measure(run, v, bound, floor, "velocity, %s", where);
    check_measure(run, u, bound, floor, "internal energy, %s", where);
    /* of the state at t_end, not of the last step's evaluation */
    check_measure(run, rho, bound, floor, "density, %s", where);
    check_measure(run, P, bound, floor, "pressure, %s", where);
    check_measure(run, h, bound, floor, "smoothing length, %s", where);
    check_measure(run, volume, bound, floor, "volume, %s", where);
    if (rates.alpha && oracle->scheme.viscosity == VISCOSITY_TIME_DEPENDENT &&
        oracle->scheme.integrator->ends_evaluated)
        check_measure(run, alpha, 100 * bound, 10 * floor, "rate of alpha, %s", where);
    check_measure(run, fabs((double)cost.steps - (double)oracle->steps), 0, 0,
                  "number of steps (%zu), %s", oracle->steps, where);
    check_measure(run, fabs(got.time - (double)oracle->time), 0, 0, "time, %s", where);
}

/* --- solver and oracle
 * -------------------------------------------------------------------------- */

void hydro_put_fault(const struct hydro_fault *fault, struct setup *setup)
{
    char *member = (char *)setup + fault->at;
    int choice = (int)fault->plus;
    double number;
    if (fault->size == sizeof number) {
        memcpy(&number, member, sizeof number);
        number = fault->times * number + fault->plus;
        memcpy(member, &number, sizeof number);
    } else if (fault->size == sizeof choice) {
        memcpy(member, &choice, sizeof choice);
    }
    if (fault->spoil) fault->spoil(setup);
}

/* steps: 0 for one evaluation. */
static enum status run_both(struct check_run *run, struct setup *setup,
                            const struct hydro_fault *fault, double steps, const char *where,
                            struct error *error)
{
    struct oracle oracle;
    struct simulation *simulation = NULL;
    enum status status = oracle_create(&oracle, setup, error);
    if (status) return status;
    status = oracle_evaluate(&oracle, error);
    const double t_end = (double)oracle_time_step(&oracle) * steps;
    if (!status && steps > 0) status = oracle_run(&oracle, t_end, error);
    if (fault) hydro_put_fault(fault, setup);
    if (!status) status = simulation_create(setup, &simulation, error);
    if (!status && steps > 0) status = simulation_run(simulation, t_end, NULL, NULL, error);
    if (!status) (steps > 0 ? judge_steps : judge_rates)(run, simulation, &oracle, where);
    simulation_destroy(simulation);
    oracle_free(&oracle);
    return status;
}

static void against(struct check_run *run, struct setup *setup, const struct hydro_fault *fault,
                    double steps, const char *where)
{
    struct error error = {0};
    const struct scheme *scheme = &setup->scheme;
    if (scheme_check(scheme, setup->dim, &error))
        check_skip(run, "%s: %s", where, error.message);
    else if (!oracle_covers(scheme) || (steps > 0 && !oracle_covers_step(scheme->integrator)))
        check_skip(run, "%s: the oracle lacks one of these choices", where);
    else if (run_both(run, setup, fault, steps, where, &error))
        check_measure(run, 1, 0, 0, "%s: %s", where, error.message);
}

void hydro_against_rates(struct check_run *run, struct setup setup, const struct hydro_fault *fault,
                         const char *where)
{
    against(run, &setup, fault, 0, where);
}

void hydro_against_steps(struct check_run *run, struct setup setup, const struct hydro_fault *fault,
                         double steps, const char *where)
{
    against(run, &setup, fault, steps, where);
}
