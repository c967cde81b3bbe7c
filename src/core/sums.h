/* SPDX-License-Identifier: GPL-3.0-or-later
 * The sums over neighbours that an evaluation is made of, as one descriptor per way to find
 * neighbours: line/ (1D: sorted particles, ranges) and whatever serves 2D and 3D. The plan chooses
 * one for the dimension; evaluate.c, simulation.c and sleep.c call through it and know no geometry.
 *
 * What the sums keep for themselves (order, reach, ghosts, lists, scratch) hangs on
 * simulation->workspace. No function asks for memory in a step unless neighbours have come closer
 * than what reserve has set aside for. Results do not depend on the number of threads. */
#ifndef SPHPROOF_SUMS_H
#define SPHPROOF_SUMS_H

#include <stdbool.h>
#include <stddef.h>

#include "description.h"
#include "serialiser.h"
#include "status.h"

struct simulation;

struct sums {
    const char *name;
    int dim_min, dim_max; /* the dimensions that it serves */

    /* Allocates the workspace and simulation->particles (n, dim, empty). */
    enum status (*create)(struct simulation *simulation, ptrdiff_t n, struct error *error);
    void (*free)(struct simulation *simulation); /* the workspace; after a failed create, too */
    /* What a workspace for n particles comes to, in bytes, by scheme and plan alone (the rest of
     * the simulation is 0); see memory_bytes. */
    double (*bytes)(const struct simulation *simulation, double n);

    /* Once, after the state has been set, with h a first guess: orders it, and moves apart
     * particles in one place that have no h. */
    void (*begin)(struct simulation *simulation);
    /* After the first rates: sets memory aside for what a run may come to. */
    enum status (*reserve)(struct simulation *simulation, struct error *error);

    /* Call it after positions have changed: restores the order and finds neighbours.
     * STATUS_BROKE_DOWN: a position is not finite. */
    enum status (*arrange)(struct simulation *simulation, struct error *error);
    /* Computes density, smoothing length and equation of state (h, h_inverse, h_inverse_found, V,
     * rho, P, c; g, b and grad_h if the plan needs them) from x, m, U. newton: solves for h by
     * Newton's method; otherwise 1/h is extrapolated by ratio times its last change. */
    enum status (*widths)(struct simulation *simulation, bool newton, double ratio,
                          struct error *error);
    /* Computes what widths does, of particles that are where they were then, with other U, where
     * density is no sum of U: h and rho stay. NULL: widths has to be called again. */
    void (*close)(struct simulation *simulation);
    /* Computes moment matrices and velocity gradients; called if the plan needs either. */
    void (*matrix)(struct simulation *simulation);
    /* Computes F, de and, if the plan needs it, dalpha. *rate becomes at least the largest signal
     * speed / h. */
    enum status (*forces)(struct simulation *simulation, double *rate, struct error *error);
    /* signal of every awake particle from v, c, h; returns the largest signal speed / h. */
    double (*signal)(struct simulation *simulation);
    /* The switch of viscosity=cullen_dehnen, called if the plan needs it. find_switch, after the
     * rates, computes the values that alpha jumps up to and decays to; apply_switch, after the
     * step, sets alpha. */
    void (*find_switch)(struct simulation *simulation);
    void (*apply_switch)(struct simulation *simulation, double dt);
    /* Visits each particle after the matrices are known; see description_each. */
    void (*describe)(const struct simulation *simulation, description_visit *visit, void *context);

    /* Choose the inactive particles, from the first rates and after every step. They fill
     * simulation->sleep. */
    enum status (*sleep_begin)(struct simulation *simulation, struct error *error);
    void (*sleep_update)(struct simulation *simulation);
    /* Whether particle i sleeps. */
    bool (*sleeps)(const struct simulation *simulation, ptrdiff_t i);

    /* No evaluation is to follow: frees what is as large as lists. NULL: there is nothing. */
    void (*end)(struct simulation *simulation);

    /* What the workspace keeps from one step to the next. */
    void (*serialise)(struct simulation *simulation, struct serialiser *serialiser);
};

extern const struct sums line_sums, cells_sums;

/* The sums for dim dimensions, or NULL. */
const struct sums *sums_find(int dim);

#endif
