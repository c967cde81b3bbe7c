/* SPDX-License-Identifier: GPL-3.0-or-later
 * Time stepping of the oracle: each integrator in its textbook form. y stands for the state
 * (x, p, e, alpha), L(y) for its rates (p/m, F, de, dalpha). */

#include <math.h>
#include <string.h>

#include "integrator.h"
#include "oracle_parts.h"

/* result = a + rates * dt with the rates now in the particles; a and result may be the particles
 * themselves. */
static void advance(struct oracle *oracle, const struct oracle_particle *a, long double dt)
{
    for (size_t i = 0; i < oracle->n; i++) {
        struct oracle_particle *b = &oracle->particles[i];
        for (int k = 0; k < 3; k++) {
            b->x[k] = a[i].x[k] + b->p[k] / b->m * dt;
            b->p[k] = a[i].p[k] + b->F[k] * dt;
        }
        b->e = a[i].e + b->de * dt;
        b->alpha = a[i].alpha + b->dalpha * dt;
    }
}

static void remember(struct oracle *oracle)
{
    memcpy(oracle->start, oracle->particles, oracle->n * sizeof *oracle->particles);
}

/* y = (weight) start + (1 - weight) y */
static void mix(struct oracle *oracle, long double weight)
{
    for (size_t i = 0; i < oracle->n; i++) {
        struct oracle_particle *b = &oracle->particles[i];
        const struct oracle_particle *a = &oracle->start[i];
        for (int k = 0; k < 3; k++) {
            b->x[k] = weight * a->x[k] + (1 - weight) * b->x[k];
            b->p[k] = weight * a->p[k] + (1 - weight) * b->p[k];
        }
        b->e = weight * a->e + (1 - weight) * b->e;
        b->alpha = weight * a->alpha + (1 - weight) * b->alpha;
    }
}

/* Kicks half a step, drifts a step with the kicked velocity, evaluates with everything else
 * predicted to the end of the step, and kicks the half-kicked values half a step. */
static enum status leapfrog(struct oracle *oracle, long double dt, struct error *error)
{
    struct oracle_particle *half = oracle->start;
    remember(oracle);
    for (size_t i = 0; i < oracle->n; i++) {
        struct oracle_particle *a = &oracle->particles[i];
        for (int k = 0; k < 3; k++) {
            half[i].p[k] += a->F[k] * dt / 2;
            a->x[k] += half[i].p[k] / a->m * dt;
            a->p[k] += a->F[k] * dt;
        }
        half[i].e += a->de * dt / 2;
        half[i].alpha += a->dalpha * dt / 2;
        a->e += a->de * dt;
        a->alpha += a->dalpha * dt;
    }
    const enum status status = oracle_evaluate(oracle, error);
    for (size_t i = 0; i < oracle->n; i++) {
        struct oracle_particle *a = &oracle->particles[i];
        for (int k = 0; k < 3; k++) a->p[k] = half[i].p[k] + a->F[k] * dt / 2;
        a->e = half[i].e + a->de * dt / 2;
        a->alpha = half[i].alpha + a->dalpha * dt / 2;
    }
    oracle_signals(oracle);
    return status;
}

/* The leapfrog keeps the rates of the predicted end; this integrator replaces them by those of the
 * end. */
static enum status modified_leapfrog(struct oracle *oracle, long double dt, struct error *error)
{
    const enum status status = leapfrog(oracle, dt, error);
    return status ? status : oracle_evaluate(oracle, error);
}

static enum status symplectic_euler(struct oracle *oracle, long double dt, struct error *error)
{
    for (size_t i = 0; i < oracle->n; i++) {
        struct oracle_particle *a = &oracle->particles[i];
        for (int k = 0; k < 3; k++) {
            a->p[k] += a->F[k] * dt;
            a->x[k] += a->p[k] / a->m * dt;
        }
        a->e += a->de * dt;
        a->alpha += a->dalpha * dt;
    }
    return oracle_evaluate(oracle, error);
}

/* Heun: y1 = y + dt L(y); y = (y + y1 + dt L(y1))/2 */
static enum status rk2(struct oracle *oracle, long double dt, struct error *error)
{
    remember(oracle);
    advance(oracle, oracle->start, dt);
    enum status status = oracle_evaluate(oracle, error);
    if (status) return status;
    advance(oracle, oracle->particles, dt);
    mix(oracle, 0.5L);
    return oracle_evaluate(oracle, error);
}

/* y1 = y + dt/2 L(y); y = y + dt L(y1) */
static enum status vl2(struct oracle *oracle, long double dt, struct error *error)
{
    remember(oracle);
    advance(oracle, oracle->start, dt / 2);
    const enum status status = oracle_evaluate(oracle, error);
    if (status) return status;
    advance(oracle, oracle->start, dt);
    return oracle_evaluate(oracle, error);
}

/* Shu & Osher 1988: y1 = y + dt L(y); y2 = 3/4 y + 1/4 (y1 + dt L(y1));
 * y = 1/3 y + 2/3 (y2 + dt L(y2)) */
static enum status rk3(struct oracle *oracle, long double dt, struct error *error)
{
    static const long double weights[] = {0, 0.75L, 1 / 3.0L};
    remember(oracle);
    for (int stage = 0; stage < 3; stage++) {
        advance(oracle, oracle->particles, dt);
        mix(oracle, weights[stage]);
        const enum status status = oracle_evaluate(oracle, error);
        if (status) return status;
    }
    return STATUS_OK;
}

/* One evaluation at the midpoint, predicted with the rates of the last midpoint; the predicted
 * internal energy not below half of that at the start. */
static enum status predicted_midpoint(struct oracle *oracle, long double dt, struct error *error)
{
    const bool total = oracle->scheme.energy == ENERGY_TOTAL;
    remember(oracle);
    advance(oracle, oracle->start, dt / 2);
    for (size_t i = 0; i < oracle->n; i++) {
        struct oracle_particle *b = &oracle->particles[i];
        const struct oracle_particle *a = &oracle->start[i];
        const long double before = total ? oracle_dot(a->p, a->p) / (2 * a->m) : 0;
        const long double now = total ? oracle_dot(b->p, b->p) / (2 * b->m) : 0;
        if (b->e - now < (a->e - before) / 2) b->e = (a->e - before) / 2 + now;
    }
    const enum status status = oracle_evaluate(oracle, error);
    for (size_t i = 0; i < oracle->n; i++) {
        struct oracle_particle *b = &oracle->particles[i];
        const struct oracle_particle *a = &oracle->start[i];
        for (int k = 0; k < 3; k++) {
            b->p[k] = a->p[k] + b->F[k] * dt;
            b->x[k] = a->x[k] + (a->p[k] + b->p[k]) / (2 * b->m) * dt;
        }
        b->e = a->e + b->de * dt;
        b->alpha = a->alpha + b->dalpha * dt;
    }
    return status;
}

typedef enum status step_function(struct oracle *oracle, long double dt, struct error *error);

static const struct {
    const char *name;
    step_function *step;
} table[] = {
    {"leapfrog", leapfrog},
    {"modified_leapfrog", modified_leapfrog},
    {"symplectic_euler", symplectic_euler},
    {"rk2", rk2},
    {"vl2", vl2},
    {"rk3", rk3},
    {"predicted_midpoint", predicted_midpoint},
};

static step_function *find_step(const struct integrator *integrator)
{
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (strcmp(integrator->member.name, table[i].name) == 0) return table[i].step;
    return NULL;
}

bool oracle_covers_step(const struct integrator *integrator)
{
    return find_step(integrator) != NULL;
}

/* Advances by dt; needs rates and leaves those of the new state. STATUS_BAD_INPUT: an unknown
 * integrator. */
static enum status take_step(struct oracle *oracle, long double dt, struct error *error)
{
    step_function *step = find_step(oracle->scheme.integrator);
    if (!step)
        return error_set(error, STATUS_BAD_INPUT, "oracle: no integrator %s",
                         oracle->scheme.integrator->member.name);
    /* density sums are made in the middle of the steps */
    oracle->ahead = oracle->last_dt > 0 ? (oracle->last_dt + dt) / (2 * oracle->last_dt) : 0;
    oracle->last_dt = dt;
    const enum status status = step(oracle, dt, error);
    if (oracle->scheme.viscosity == VISCOSITY_CULLEN_DEHNEN) oracle_apply_switch(oracle, dt);
    oracle->time += dt;
    oracle->steps++;
    return status;
}

long double oracle_time_step(const struct oracle *oracle)
{
    long double least = INFINITY;
    for (size_t i = 0; i < oracle->n; i++) {
        const struct oracle_particle *a = &oracle->particles[i];
        least = fminl(least, a->width / a->signal);
    }
    return oracle->scheme.cfl * least;
}

/* The first step: a fraction of the time step, limited by accelerations. */
static long double first_step(const struct oracle *oracle)
{
    const double part = oracle->scheme.integrator->first_step;
    long double dt = oracle_time_step(oracle) * (part > 0 ? part : 1);
    for (size_t i = 0; i < oracle->n; i++) {
        const struct oracle_particle *a = &oracle->particles[i];
        const long double pull = sqrtl(oracle_dot(a->F, a->F)) / a->m;
        dt = fminl(dt, oracle->scheme.cfl * sqrtl(a->width / pull));
    }
    return dt;
}

/* If the last evaluation was not at the end: density, pressure and h there, by Newton's method. */
static enum status find_end(struct oracle *oracle, struct error *error)
{
    const enum h_method method = oracle->scheme.h_method;
    oracle->scheme.h_method = H_NEWTON;
    const enum status status = oracle_evaluate(oracle, error);
    oracle->scheme.h_method = method;
    return status;
}

enum status oracle_run(struct oracle *oracle, long double t_end, struct error *error)
{
    enum status status = oracle_evaluate(oracle, error);
    while (!status && oracle->time < t_end) {
        const long double left = t_end - oracle->time;
        long double dt = oracle->steps ? oracle_time_step(oracle) : first_step(oracle);
        if (dt >= left)
            dt = left;
        else if (2 * dt >= left)
            dt = left / 2;
        status = take_step(oracle, dt, error);
        if (dt == left) oracle->time = t_end;
    }
    if (!status && !oracle->scheme.integrator->ends_evaluated) status = find_end(oracle, error);
    return status;
}
