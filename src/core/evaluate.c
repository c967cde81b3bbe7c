/* SPDX-License-Identifier: GPL-3.0-or-later
 * The passes of an evaluation, in order; struct sums handles the geometry. */
#include <math.h>

#include "breakdown.h"
#include "fixed.h"
#include "shifting.h"
#include "solver.h"
#include "specialise.h"
#include "state.h"

/* Computes v and U from p and e. */
static enum status find_primitives(struct simulation *simulation, struct error *error)
{
    const struct particles *a = &simulation->particles;
    const double kinetic = simulation->scheme.energy == ENERGY_TOTAL ? 0.5 : 0;
    if (state_primitives(a, kinetic) <= 0) return STATUS_OK;
    ptrdiff_t i = 0;
    while (a->U[i] > 0) i++;
    return breakdown_of(simulation, i, "internal energy", a->U[i], error);
}

/* Time from the last density sum to this one over the time between the last two; sums are at the
 * middle of steps. */
static double prediction(const struct simulation *simulation)
{
    const double before = simulation->dt_before;
    return before > 0 ? 0.5 * (before + simulation->dt) / before : 0;
}

static enum status prepare(struct simulation *simulation, bool newton, struct error *error)
{
    const struct sums *sums = simulation->plan.sums;
    enum status status = sums->arrange(simulation, error);
    if (!status) status = sums->widths(simulation, newton, prediction(simulation), error);
    if (!status) fixed_state(simulation);
    return status;
}

enum status evaluate_state(struct simulation *simulation, struct error *error)
{
    const enum status status = find_primitives(simulation, error);
    return status ? status : prepare(simulation, true, error);
}

enum status evaluate_rates(struct simulation *simulation, struct error *error)
{
    const enum status status = find_primitives(simulation, error);
    return status ? status : evaluate_rates_of_primitives(simulation, error);
}

/* Adds the force m g, and its power to the rate of total energy: m g . v, where v is the velocity
 * with which the particle moves. An integrator that advances the whole step from its midpoint moves
 * it with the mean velocity of the step, (p + F dt/2)/m, so that no energy is lost in falling. */
static void fall(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    const bool total = simulation->scheme.energy == ENERGY_TOTAL;
    const bool midpoint = simulation->scheme.integrator->predicts && simulation->steps.level < 0;
    const double half = 0.5 * simulation->dt;
    for (int k = 0; k < a->dim; k++) {
        const double g = simulation->gravity[k];
        for (ptrdiff_t i = 0; i < a->n; i++) {
            if (!simulation_evaluates(simulation, i)) continue;
            a->F[k][i] += a->m[i] * g;
            const double moved = midpoint ? a->p[k][i] + half * a->F[k][i] : a->m[i] * a->v[k][i];
            if (total) a->de[i] += g * moved;
        }
    }
}

static void limit_time_step(struct simulation *simulation, double rate)
{
    simulation->time_step = simulation->scheme.cfl / largest(rate, simulation->sleep.rate);
}

/* True if closed gradients do not yet vanish for a constant. On a lattice they always do. */
static bool unsettled(const struct particles *a)
{
    for (int k = 0; k < a->dim; k++)
        for (ptrdiff_t i = 0; i < a->n; i++)
            if (fabs(a->potential[k][i]) > 1e-9 * a->h_inverse[i]) return true;
    return false;
}

/* Computes the forces; for the first state with closed gradients repeatedly, until its potentials
 * have converged. */
static enum status find_forces(struct simulation *simulation, double *rate, struct error *error)
{
    const struct plan *plan = &simulation->plan;
    const bool first = simulation->dt <= 0;
    enum status status = plan->sums->forces(simulation, rate, error);
    for (int k = 1; first && plan->closed && k < SHIFTING_START && !status; k++) {
        if (!unsettled(&simulation->particles)) break;
        status = plan->sums->forces(simulation, rate, error);
    }
    return status;
}

/* Computes the rates of a state whose neighbours, smoothing lengths and densities are known. */
static enum status find_rates(struct simulation *simulation, struct error *error)
{
    const struct plan *plan = &simulation->plan;
    double rate;
    if (plan->matrix || plan->slope) plan->sums->matrix(simulation);
    const enum status status = find_forces(simulation, &rate, error);
    if (status == STATUS_OK && plan->gravity) fall(simulation);
    if (status == STATUS_OK) fixed_rates(simulation);
    if (status == STATUS_OK && plan->jump) plan->sums->find_switch(simulation);
    if (status == STATUS_OK) limit_time_step(simulation, rate);
    return status;
}

enum status evaluate_rates_of_primitives(struct simulation *simulation, struct error *error)
{
    const struct plan *plan = &simulation->plan;
    const struct particles *a = &simulation->particles;
    /* there are no earlier smoothing lengths to predict the first ones from */
    const bool newton = plan->newton || simulation->dt <= 0;
    const enum status status = prepare(simulation, newton, error);
    if (status) return status;
    if (newton && !plan->newton)
        for (ptrdiff_t i = 0; i < a->n; i++) a->h_inverse_old[i] = a->h_inverse_found[i];
    return find_rates(simulation, error);
}

enum status evaluate_rates_in_place(struct simulation *simulation, struct error *error)
{
    const struct plan *plan = &simulation->plan;
    /* predicted smoothing lengths would be predicted twice, and the sum of energies has changed */
    if (!plan->newton || plan->energy_sum || !plan->sums->close)
        return evaluate_rates(simulation, error);
    const enum status status = find_primitives(simulation, error);
    if (status) return status;
    plan->sums->close(simulation);
    fixed_state(simulation);
    return find_rates(simulation, error);
}

void evaluate_signal(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    for (int k = 0; k < a->dim; k++)
        for (ptrdiff_t i = 0; i < a->n; i++) a->v[k][i] = a->p[k][i] * a->m_inverse[i];
    limit_time_step(simulation, simulation->plan.sums->signal(simulation));
}
