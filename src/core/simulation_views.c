/* SPDX-License-Identifier: GPL-3.0-or-later
 * What others read of a simulation: positions in the box, rates, conserved sums, cost. */
#include <math.h>
#include <string.h>

#include "simulation.h"
#include "solver.h"
#include "width.h"

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

/* Adds up r x p, |r x p| and |r| m c. */
static void add_turning(const struct simulation *simulation, struct conservation *sums)
{
    const struct particles *a = &simulation->particles;
    long double turning[3] = {0}, scale = 0, sound = 0;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        double r[3] = {0}, p[3] = {0}, square = 0;
        for (int k = 0; k < a->dim; k++) {
            const double x = a->x[k][i] - simulation->lo[k], period = a->period[k];
            const bool wraps = simulation->boundary[k] == BOUNDARY_PERIODIC;
            r[k] = x - period * ((wraps ? floor(x / period) : 0) + 0.5);
            p[k] = a->p[k][i];
            square += r[k] * r[k];
        }
        const double L[3] = {r[1] * p[2] - r[2] * p[1], r[2] * p[0] - r[0] * p[2],
                             r[0] * p[1] - r[1] * p[0]};
        for (int k = 0; k < 3; k++) turning[k] += L[k];
        scale += sqrt(L[0] * L[0] + L[1] * L[1] + L[2] * L[2]);
        sound += sqrt(square) * a->m[i] * a->c[i];
    }
    for (int k = 0; k < 3; k++) sums->angular_momentum[k] = (double)turning[k];
    sums->angular_scale = (double)scale;
    sums->turning_scale = (double)sound;
}

static void add_straight(const struct simulation *simulation, struct conservation *sums)
{
    const struct particles *a = &simulation->particles;
    const bool total = simulation->scheme.energy == ENERGY_TOTAL;
    /* long double, so that round-off of the sums does not count as a lack of conservation */
    long double mass = 0, momentum[3] = {0}, momentum_scale = 0, sound = 0, energy = 0, kinetic = 0;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        mass += a->m[i];
        momentum_scale += particles_norm(a, a->p, i);
        sound += (long double)a->m[i] * a->c[i];
        energy += a->e[i];
        long double square = 0;
        for (int k = 0; k < a->dim; k++) {
            const long double p = a->p[k][i];
            momentum[k] += p;
            energy -= (long double)a->m[i] * simulation->gravity[k] * a->x[k][i];
            square += p * p;
        }
        const long double motion = 0.5L * square / a->m[i]; /* a division takes long */
        if (!total) energy += motion;
        kinetic += motion;
    }
    for (int k = 0; k < 3; k++) sums->momentum[k] = (double)momentum[k];
    sums->mass = (double)mass;
    sums->momentum_scale = (double)momentum_scale;
    sums->sound_scale = (double)sound;
    sums->energy = (double)energy;
    sums->kinetic = (double)kinetic;
}

/* Two threads compute whole sums each, so that the order of addition is the same as with one. */
void simulation_conservation(const struct simulation *simulation, struct conservation *sums)
{
    const struct particles *a = &simulation->particles;
    const bool shared = simulation->team.size > 1 && a->n >= WORTH_A_THREAD * BATCH_MAX;
    *sums = (struct conservation){0};
#pragma omp parallel sections num_threads(2) if (shared && a->dim > 1)
    {
        add_straight(simulation, sums);
#pragma omp section
        if (a->dim > 1) add_turning(simulation, sums);
    }
}

void simulation_cost(const struct simulation *simulation, struct simulation_cost *cost)
{
    *cost = simulation->cost;
}
