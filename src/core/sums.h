/* SPDX-License-Identifier: GPL-3.0-or-later
 * The neighbour sums of an evaluation, one descriptor for each way to find neighbours: line/ (1D:
 * sorted particles, ranges) and cells/ (2D and 3D: grid, lists). The plan chooses one for the
 * dimension; evaluate.c, simulation.c and sleep.c call it and contain no geometry.
 *
 * The data of an implementation (order, reach, ghosts, lists, work arrays) are in
 * simulation->workspace. Steps allocate no memory unless neighbours come closer than `reserve`
 * has provided for. Results do not depend on the number of threads. */
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
    int dim_min, dim_max; /* supported dimensions */

    /* Allocates the workspace and simulation->particles (n, dim, zeroed). */
    enum status (*create)(struct simulation *simulation, ptrdiff_t n, struct error *error);
    void (*free)(struct simulation *simulation); /* also after a failed create */
    /* Memory of a workspace for n particles in bytes; reads only scheme and plan. See memory_bytes.
     */
    double (*bytes)(const struct simulation *simulation, double n);

    /* Called once after the state and a first guess of h have been set: sorts the particles, and
     * separates coincident particles that have no h. */
    void (*begin)(struct simulation *simulation);
    /* Called after the first rates: allocates what the run may need. */
    enum status (*reserve)(struct simulation *simulation, struct error *error);

    /* Called after positions have changed: restores the order and finds neighbours.
     * STATUS_BROKE_DOWN: a position is not finite. */
    enum status (*arrange)(struct simulation *simulation, struct error *error);
    /* Computes density, smoothing length and equation of state (h, h_inverse, h_inverse_found, V,
     * rho, P, c; g, b and grad_h if the plan needs them) from x, m, U. newton: solves for h by
     * Newton's method; otherwise 1/h is extrapolated by ratio times its last change. */
    enum status (*widths)(struct simulation *simulation, bool newton, double ratio,
                          struct error *error);
    /* Repeats widths for unchanged positions and a changed U, if density is not a sum of U: h and
     * rho are kept. NULL: widths has to be called again. */
    void (*close)(struct simulation *simulation);
    /* Computes moment matrices and velocity gradients; called if the plan needs either. */
    void (*matrix)(struct simulation *simulation);
    /* Computes F, de and, if the plan needs it, dalpha. Raises *rate to the largest signal speed /
     * h. */
    enum status (*forces)(struct simulation *simulation, double *rate, struct error *error);
    /* Computes signal of every awake particle from v, c, h; returns the largest signal speed / h.
     */
    double (*signal)(struct simulation *simulation);
    /* The switch of viscosity=cullen_dehnen, called if the plan needs it. find_switch, after the
     * rates, computes the values that alpha jumps up to and decays to; apply_switch, after the
     * step, sets alpha. */
    void (*find_switch)(struct simulation *simulation);
    void (*apply_switch)(struct simulation *simulation, double dt);
    /* Calls visit for each particle once the matrices are known; see description_each. */
    void (*describe)(const struct simulation *simulation, description_visit *visit, void *context);

    /* Choose the sleeping particles, after the first rates and after every step. They set
     * simulation->sleep. */
    enum status (*sleep_begin)(struct simulation *simulation, struct error *error);
    void (*sleep_update)(struct simulation *simulation);
    /* True if particle i sleeps. */
    bool (*sleeps)(const struct simulation *simulation, ptrdiff_t i);

    /* Called after the last evaluation: frees large memory such as lists. NULL: nothing to free. */
    void (*end)(struct simulation *simulation);

    /* Saves or restores the data that the workspace keeps from step to step. */
    void (*serialise)(struct simulation *simulation, struct serialiser *serialiser);
};

extern const struct sums line_sums, cells_sums;

/* The sums for dim dimensions, or NULL. */
const struct sums *sums_find(int dim);

#endif
