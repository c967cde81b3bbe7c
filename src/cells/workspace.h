/* SPDX-License-Identifier: GPL-3.0-or-later
 * Inside of the sums in 2D and 3D: what a simulation has beside its particles, and what is found
 * with it: memory (workspace.c), neighbours and widths (workspace_widths.c), who sleeps
 * (workspace_sleep.c). The sums themselves and their table are in cells_sums.c. */
#ifndef SPHPROOF_WORKSPACE_H
#define SPHPROOF_WORKSPACE_H

#include "cells.h"
#include "solver.h"

/* How far beyond a first guess the search for a root may go without a second search. */
static const double workspace_margin = 1.1;

struct workspace {
    struct cells *cells;
    struct cells_fields fields;
    double *block; /* what the workspace's own arrays live in */
    double *radius, *balsara, *balsara_before;
    double *sum_m, *sum_m_dh, *sum_Z, *sum_Z_dh;
    size_t arrays, stride; /* that lie in block, and from one to the next */
    unsigned char *outcome;
    double *disturbance, *arriving; /* where particles may sleep: struct cells_quiet */
    unsigned char *parts;  /* local steps: of each particle, in the evaluation of a level; */
    unsigned char *woken;  /* and the level that it wakes to, 0: none */
    unsigned char *asleep; /* of each particle; NULL: no particle ever sleeps */
    double *kept;          /* 1/h of particles that sleep; likewise */
    uint64_t sorted_at;    /* steps */
    bool sorted;
};

static inline struct workspace *workspace_of(const struct simulation *simulation)
{
    return simulation->workspace;
}

/* Particles of the batch that begins with the first one. */
static inline int workspace_batch(const struct particles *particles, ptrdiff_t first)
{
    return (int)(particles->n - first < BATCH_MAX ? particles->n - first : BATCH_MAX);
}

/* What the simulation asks of its cells; threads and box as they are known by now. */
struct cells_method workspace_method(const struct simulation *simulation);

/* Forgets that particles may sleep. */
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
