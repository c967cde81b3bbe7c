/* SPDX-License-Identifier: GPL-3.0-or-later
 * A small simulation on a periodic line, whose particles are all different: for tests of what is
 * done with a simulation, whatever it computes. Include after cmocka.h. */
#ifndef MADE_SIMULATION_H
#define MADE_SIMULATION_H

#include <math.h>
#include <stdlib.h>

#include "settings.h"
#include "simulation.h"

/* Of n particles on [0, 1]; simulation_destroy it. */
static inline struct simulation *made_simulation(size_t n)
{
    double *storage = malloc(4 * n * sizeof *storage);
    double *x = storage, *v = x + n, *m = v + n, *u = m + n;
    struct settings settings;
    struct simulation *simulation = NULL;
    struct error error = {0};
    for (size_t i = 0; i < n; i++) {
        x[i] = ((double)i + 0.5) / (double)n;
        v[i] = 0.1 * sin(2 * M_PI * x[i]);
        m[i] = (1 + 0.1 * cos(2 * M_PI * x[i])) / (double)n;
        u[i] = 1 + 0.2 * sin(4 * M_PI * x[i]);
    }
    struct setup setup = {.dim = 1,
                          .lo = {0},
                          .hi = {1, 1, 1},
                          .gamma = 1.4,
                          .t_end = 1,
                          .n = n,
                          .x = {x},
                          .v = {v},
                          .m = m,
                          .u = u,
                          .threads = 1};
    settings_init(&settings);
    if (settings_scheme(&settings, 1, &setup.scheme, &error) ||
        simulation_create(&setup, &simulation, &error))
        fail_msg("%s", error.message);
    free(storage);
    return simulation;
}

static inline void made_run(struct simulation *simulation, double t_end)
{
    struct error error;
    if (simulation_run(simulation, t_end, NULL, NULL, &error)) fail_msg("%s", error.message);
}

/* Are both in the same state, to the last bit? */
static inline bool made_alike(const struct simulation *a, const struct simulation *b)
{
    struct snapshot s, t;
    simulation_snapshot(a, &s);
    simulation_snapshot(b, &t);
    bool alike = s.n == t.n && s.time == t.time;
    for (size_t i = 0; i < s.n && alike; i++)
        alike = s.x[0][i] == t.x[0][i] && s.v[0][i] == t.v[0][i] && s.u[i] == t.u[i] &&
                s.h[i] == t.h[i] && s.rho[i] == t.rho[i];
    return alike;
}

#endif
