/* SPDX-License-Identifier: GPL-3.0-or-later
 * What others read of a simulation: positions in the box, rates, cost. */
#include <math.h>
#include <string.h>

#include "simulation.h"
#include "solver.h"

void simulation_asleep(const struct simulation *simulation, bool *asleep)
{
    for (ptrdiff_t i = 0; i < simulation->particles.n; i++)
        asleep[i] = simulation->plan.sums->sleeps(simulation, i);
}

void simulation_snapshot(const struct simulation *simulation, struct snapshot *snapshot)
{
    const struct particles *a = &simulation->particles;
    for (int k = 0; k < a->dim; k++) {
        const double lo = simulation->lo[k], period = a->period[k];
        if (simulation->boundary[k] != BOUNDARY_PERIODIC) {
            memcpy(simulation->wrapped[k], a->x[k], (size_t)a->n * sizeof(double));
            continue;
        }
        for (ptrdiff_t i = 0; i < a->n; i++) {
            const double x = a->x[k][i] - lo;
            const double wrapped = x - period * floor(x / period);
            simulation->wrapped[k][i] = lo + (wrapped < period ? wrapped : 0);
        }
    }
    double *specific_energy = a->spare;
    for (ptrdiff_t i = 0; i < a->n; i++) specific_energy[i] = a->U[i] * a->m_inverse[i];
    *snapshot = (struct snapshot){
        .n = (size_t)a->n,
        .x = {simulation->wrapped[0], simulation->wrapped[1], simulation->wrapped[2]},
        .v = {a->v[0], a->v[1], a->v[2]},
        .m = a->m,
        .rho = a->rho,
        .u = specific_energy,
        .P = a->P,
        .h = a->h,
        .volume = a->V,
        .id = a->id,
        .time = simulation->time,
    };
}

void simulation_rates(const struct simulation *simulation, struct rates *rates)
{
    const struct particles *a = &simulation->particles;
    const double dt = simulation->time_step;
    const int depth =
        simulation->steps.depth < STEPS_DEPTH ? simulation->steps.depth + 1 : STEPS_DEPTH;
    *rates = (struct rates){.force = {a->F[0], a->F[1], a->F[2]},
                            .energy = a->de,
                            .alpha = simulation->plan.alpha ? a->dalpha : NULL,
                            .time_step = dt,
                            .furthest = simulation->plan.local ? ldexp(dt, depth) : dt};
    if (!simulation->plan.shift) return;
    rates->shift.mass = a->dm;
    rates->shift.energy = a->de_shift;
    for (int k = 0; k < a->dim; k++) {
        rates->shift.velocity[k] = a->shift[k];
        rates->shift.momentum[k] = a->dp_shift[k];
    }
}

void simulation_cost(const struct simulation *simulation, struct simulation_cost *cost)
{
    *cost = simulation->cost;
}
