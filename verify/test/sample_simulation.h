/* SPDX-License-Identifier: GPL-3.0-or-later
 * A small simulation on a periodic line with distinct particles, for tests to which its physics
 * does not matter. Include after test.h. */
#pragma once

#include "keyed.h"

/* n particles on [0, 1]. The caller frees it with simulation_destroy. */
static inline struct simulation *sample_simulation(size_t n)
{
    double *storage = malloc(4 * n * sizeof *storage);
    double *place = storage, *velocity = place + n, *mass = velocity + n, *energy = mass + n;
    struct simulation *simulation = NULL;
    struct error error = {0};
    for (size_t i = 0; i < n; i++) {
        place[i] = ((double)i + 0.5) / (double)n;
        velocity[i] = 0.1 * sin(2 * M_PI * place[i]);
        mass[i] = (1 + 0.1 * cos(2 * M_PI * place[i])) / (double)n;
        energy[i] = 1 + 0.2 * sin(4 * M_PI * place[i]);
    }
    struct setup setup = {.dim = 1,
                          .lo = {0},
                          .hi = {1, 1, 1},
                          .gamma = 1.4,
                          .t_end = 1,
                          .n = n,
                          .x = {place},
                          .v = {velocity},
                          .m = mass,
                          .u = energy,
                          .threads = 1};
    setup.scheme = keyed_scheme(1, "");
    if (simulation_create(&setup, &simulation, &error)) fail_msg("%s", error.message);
    free(storage);
    return simulation;
}

/* progress: NULL, or a function that is called with the simulation as its context. */
static inline void run_until(struct simulation *simulation, double t_end,
                             simulation_progress *progress)
{
    struct error error;
    if (simulation_run(simulation, t_end, progress, simulation, &error))
        fail_msg("%s", error.message);
}

/* True if both have the same state, to the last bit. */
static inline bool same_state(const struct simulation *a, const struct simulation *b)
{
    struct snapshot s, t;
    simulation_snapshot(a, &s);
    simulation_snapshot(b, &t);
    bool alike = s.n == t.n && s.time == t.time;
    for (size_t i = 0; i < s.n && alike; i++) {
        alike = s.id[i] == t.id[i] && s.m[i] == t.m[i] && s.u[i] == t.u[i] && s.h[i] == t.h[i] &&
                s.rho[i] == t.rho[i];
        for (int k = 0; k < 3 && s.x[k]; k++)
            alike &= s.x[k][i] == t.x[k][i] && s.v[k][i] == t.v[k][i];
    }
    return alike;
}
