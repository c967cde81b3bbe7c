/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sleep.h"

#include <float.h>
#include <math.h>

#include "solver.h"

enum { DUE_EVERY = 16 /* steps between two checks of all awake particles */ };

bool sleep_due(const struct simulation *simulation)
{
    return simulation->cost.steps % DUE_EVERY == DUE_EVERY - 1;
}

/* Positions of order 1 are accurate to eps, spacings to n^(1/d) eps. */
double sleep_least_tolerance(const struct simulation *simulation)
{
    const double n = (double)simulation->particles.n;
    const double across = simulation->plan.dim == 1 ? n : pow(n, 1. / simulation->plan.dim);
    return fmax(1e-11, 30 * DBL_EPSILON * across);
}

static void find_sound(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    const double gamma = simulation->gamma;
    const bool total = simulation->scheme.energy == ENERGY_TOTAL;
    double mass = 0, energy = 0, momentum[3] = {0};
    for (ptrdiff_t i = 0; i < a->n; i++) {
        mass += a->m[i];
        energy += a->e[i];
        for (int k = 0; k < a->dim; k++) {
            momentum[k] += a->p[k][i];
            if (!total) energy += 0.5 * a->p[k][i] * a->p[k][i] * a->m_inverse[i];
        }
    }
    for (int k = 0; k < a->dim; k++) energy -= 0.5 * momentum[k] * momentum[k] / mass;
    simulation->sleep.sound = energy > 0 ? sqrt(gamma * (gamma - 1) * energy / mass) : 0;
}

/* Tolerance over the largest rate at the start, in units of the state; a jump has rate 1. */
static const double of_start = 1e-8;

void sleep_scale(struct simulation *simulation)
{
    struct sleep *sleep = &simulation->sleep;
    find_sound(simulation);
    sleep->tolerance = sleep_least_tolerance(simulation);
    if (simulation->plan.dim == 1) return;
    const double start =
        sleep->tolerance * sleep_disturbance(simulation, 0, simulation->particles.n);
    sleep->tolerance = fmax(sleep->tolerance, of_start * fmin(start, 1));
}

double sleep_disturbance(const struct simulation *simulation, ptrdiff_t first, ptrdiff_t len)
{
    const struct particles *a = &simulation->particles;
    const double sound = simulation->sleep.sound, in_tolerances = 1 / simulation->sleep.tolerance;
    double worst = 0;
    for (ptrdiff_t i = first; i < first + len; i++) {
        const double c = a->c[i] < sound ? sound : a->c[i]; /* keeps NaN */
        const double rate = c / a->h[i], force = a->m[i] * c * rate;
        const double rates[4] = {
            particles_norm(a, a->F, i) / force,
            fabs(a->de[i]) / (force * (c + particles_norm(a, a->v, i))),
            simulation->plan.alpha ? fabs(a->dalpha[i]) / rate : 0,
            simulation->plan.shift ? particles_norm(a, a->shift, i) / c : 0,
        };
        for (int k = 0; k < 4; k++)
            if (!(rates[k] <= worst || isnan(worst))) worst = rates[k];
    }
    return worst * in_tolerances;
}

void sleep_begin(struct simulation *simulation, ptrdiff_t first, ptrdiff_t len)
{
    const struct particles *a = &simulation->particles;
    for (ptrdiff_t i = first; i < first + len; i++) {
        const bool shifts = simulation->plan.shift;
        a->de[i] = a->dalpha[i] = 0;
        if (shifts) a->dm[i] = a->de_shift[i] = 0;
        for (int k = 0; k < a->dim; k++) {
            a->F[k][i] = 0;
            if (shifts) a->shift[k][i] = a->dp_shift[k][i] = 0;
            simulation->sleep.at_rest &= a->p[k][i] == 0;
        }
    }
}

/* Sums over all awake particles: the rates of mass, momentum and total energy, whose opposites the
 * sleeping particles lack, and the weights for distributing these. In long double, so that
 * round-off is not distributed. The maxima are sums over sleeping particles: the tolerance of each.
 */
struct leak {
    long double flow, force[3], power, mass, momentum[3], kinetic, heat;
    double most_flow, most_force, most_power;
};

static void add_sleeper(const struct simulation *simulation, ptrdiff_t i, struct leak *leak)
{
    const struct particles *a = &simulation->particles;
    const double c = fmax(a->c[i], simulation->sleep.sound), speed = c + particles_norm(a, a->v, i);
    const double flow = simulation->sleep.tolerance * a->m[i] * c / a->h[i];
    leak->most_flow += flow;
    leak->most_force += flow * (simulation->plan.shift ? c + speed : c);
    leak->most_power += flow * (simulation->plan.shift ? c + speed : c) * speed;
}

static void add_awake(const struct simulation *simulation, ptrdiff_t i, struct leak *leak)
{
    const struct particles *a = &simulation->particles;
    const bool total = simulation->scheme.energy == ENERGY_TOTAL, shifts = simulation->plan.shift;
    leak->mass += a->m[i];
    leak->heat += a->U[i];
    leak->power += a->de[i];
    if (shifts) leak->flow += a->dm[i], leak->power += a->de_shift[i];
    for (int k = 0; k < a->dim; k++) {
        const long double momentum = (long double)a->m[i] * a->v[k][i];
        leak->force[k] += a->F[k][i];
        if (shifts) leak->force[k] += a->dp_shift[k][i];
        leak->momentum[k] += momentum;
        leak->kinetic += 0.5L * momentum * a->v[k][i];
        if (!total) leak->power += (long double)a->v[k][i] * a->F[k][i];
    }
}

static struct leak find_leak(const struct simulation *simulation)
{
    struct leak leak = {0};
    for (ptrdiff_t i = 0; i < simulation->particles.n; i++)
        (simulation->plan.sums->sleeps(simulation, i) ? add_sleeper : add_awake)(simulation, i,
                                                                                 &leak);
    return leak;
}

/* A sleeping particle lacks at most so many tolerances. `test_skipped_setups 10` finds momentum
 * lost where this is 1: below free surfaces, and in other gas now and then. */
static const double lacking = 100;

/* The part of a leak that sleep can explain; the rest remains visible in the sums, where errors of
 * forces are detected. Keeps NaN. */
static long double within(long double leak, double most)
{
    most *= lacking;
    return leak > most ? most : leak < -most ? -most : leak;
}

/* Mass carries its momentum and kinetic energy, so that uniform velocity stays uniform. */
void sleep_balance(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    const bool total = simulation->scheme.energy == ENERGY_TOTAL;
    const ptrdiff_t awake = simulation->sleep.awake_count;
    if (awake == a->n || awake == 0) return;
    const struct leak leak = find_leak(simulation);
    const double flow = (double)(within(leak.flow, leak.most_flow) / leak.mass);
    long double power = within(leak.power, leak.most_power) + flow * leak.kinetic;
    double g[3] = {0};
    for (int k = 0; k < a->dim; k++) {
        if (simulation->boundary[k] == BOUNDARY_FIXED) return;        /* layers absorb both */
        if (simulation->boundary[k] == BOUNDARY_REFLECTING) continue; /* walls absorb momentum */
        g[k] = (double)(-within(leak.force[k], leak.most_force) / leak.mass);
        power += g[k] * leak.momentum[k];
    }
    const double part = (double)(power / leak.heat); /* of U, which stays positive */
    for (ptrdiff_t i = 0; i < a->n; i++) {
        if (simulation->plan.sums->sleeps(simulation, i)) continue;
        a->de[i] -= part * a->U[i];
        if (flow != 0) a->dm[i] -= flow * a->m[i];
        for (int k = 0; k < a->dim; k++) {
            a->F[k][i] += a->m[i] * g[k];
            if (total) a->de[i] += a->m[i] * (g[k] + 0.5 * flow * a->v[k][i]) * a->v[k][i];
        }
    }
}
