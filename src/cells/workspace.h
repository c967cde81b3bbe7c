/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to the sums in 2D and 3D: the data of a simulation beside its particles. Memory
 * (workspace.c), neighbours and smoothing lengths (workspace_widths.c), sleep (workspace_sleep.c).
 * The sums themselves and their table are in cells_sums.c. */
#ifndef SPHPROOF_WORKSPACE_H
#define SPHPROOF_WORKSPACE_H

#include "cells.h"
#include "solver.h"

/* Search radius over first guess of h: larger roots need a second search. */
static const double workspace_margin = 1.1;

struct workspace {
    struct cells *cells;
    struct cells_fields fields;
    double *block; /* memory of the arrays that the workspace owns */
    double *radius, *balsara, *balsara_before;
    double *sum_m, *sum_m_dh, *sum_Z, *sum_Z_dh;
    size_t arrays, stride; /* number of arrays in block, and distance between them */
    unsigned char *outcome;
    double *disturbance, *arriving; /* if particles may sleep: see struct cells_quiet */
    unsigned char *parts;  /* local steps: role of each particle in the evaluation of a level */
    unsigned char *woken;  /* local steps: new level of a particle that wakes; 0: none */
    unsigned char *asleep; /* of each particle; NULL: no particle ever sleeps */
    double *kept;          /* 1/h of sleeping particles; may be NULL likewise */
    uint64_t sorted_at;    /* number of steps at the last sort */
    bool sorted;
};

static inline struct workspace *workspace_of(const struct simulation *simulation)
{
    return simulation->workspace;
}

/* Number of particles in the batch that begins with particle `first`. */
static inline int workspace_batch(const struct particles *particles, ptrdiff_t first)
{
    return (int)(particles->n - first < BATCH_MAX ? particles->n - first : BATCH_MAX);
}

/* The settings of the simulation's cells; threads and box must be known. */
struct cells_method workspace_method(const struct simulation *simulation);

/* Frees the arrays of sleep. */
void workspace_forget_sleep(struct workspace *workspace);

/* Members of struct sums. */
enum status workspace_create(struct simulation *simulation, ptrdiff_t n, struct error *error);
double workspace_bytes(const struct simulation *simulation, double n);
void workspace_free(struct simulation *simulation);
void workspace_begin(struct simulation *simulation);
void workspace_end(struct simulation *simulation);
void workspace_serialise(struct simulation *simulation, struct serialiser *serialiser);
enum status workspace_arrange(struct simulation *simulation, struct error *error);
enum status workspace_widths(struct simulation *simulation, bool newton, double ratio,
                             struct error *error);
void workspace_close(struct simulation *simulation);
enum status workspace_begin_sleep(struct simulation *simulation, struct error *error);
void workspace_update_sleep(struct simulation *simulation);
bool workspace_sleeps(const struct simulation *simulation, ptrdiff_t i);

#endif
