/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sums in 1D: particles are sorted by position, so that neighbours are a contiguous range; images
 * beyond the ends of the box are ghost copies; loops run over neighbour offsets d = 1..reach and
 * vectorise over the particles of a range. For the files of this folder (and measurements of its
 * loops). */
#pragma once

#include "loops.h"
#include "solver.h"

/* A batch of up to BATCH_MAX consecutive particles. */
struct range {
    ptrdiff_t first;
    int len;
    ptrdiff_t reach;       /* largest neighbour offset within the particles' own h */
    ptrdiff_t force_reach; /* the same for pairs within max(h_i, h_j) */
    bool recedes;          /* no pair approaches, so viscosity is exactly 0 */
    uint64_t done;         /* number of the last density pass that found its h */
    uint64_t predicted;    /* number of the last density pass that predicted its h */
};

enum { GROUP = 8 }; /* particles of a group: they sleep and wake together */

struct groups {
    ptrdiff_t count;
    unsigned char *awake;   /* of each group */
    unsigned char *stirred; /* of each group: awake and not calm; work array */
    double *rate;           /* signal speed / h of each sleeping group; 0 if awake */
};

/* The workspace of a simulation in 1D. */
struct line {
    struct loops loops;
    struct range *ranges; /* of the awake particles */
    ptrdiff_t range_count;
    ptrdiff_t ghosts_filled;
    ptrdiff_t reach;         /* largest reach of the ranges */
    bool newton;             /* of the current density pass: h by Newton's method, else predicted */
    double predict_ratio;    /* of the current density pass */
    uint64_t density_passes; /* number so far; see range.done and range.predicted */
    double *scratch;         /* work array, scratch_size for each thread */
    size_t scratch_size;
    struct groups groups;
};

static inline struct line *line_of(const struct simulation *simulation)
{
    return simulation->workspace;
}

/* --- order.c ---------------------------------------------------------------------------------- */

/* Sorts by position; a periodic box is unwrapped into one period that starts at the first particle.
 * false: a position is not finite, and nothing has been changed. */
bool order_sort(struct particles *particles);
/* Number of adjacent pairs out of order among the len + 1 particles from first (NaN counts). */
double order_crossings(const struct particles *particles, ptrdiff_t first, ptrdiff_t len);
/* Members of struct sums. */
void order_begin(struct simulation *simulation);
enum status order_arrange(struct simulation *simulation, struct error *error);

/* --- ghosts.c --------------------------------------------------------------------------------- */

/* Copies the periodic images of count particles to both ends of an array; shift: added for each
 * period (the period for x, otherwise 0). */
void ghosts_fill(const struct particles *particles, double *array, ptrdiff_t count, double shift);
enum ghost_value { GHOST_SCALAR, GHOST_VECTOR, GHOST_POSITION };

/* The same for any boundary of the box: periodic images; mirror images, with vectors reversed; or
 * distant copies of the outermost particles (open ends, and fixed ones, whose layers are
 * particles). */
void ghosts_set(const struct simulation *simulation, double *array, ptrdiff_t count,
                enum ghost_value value);
/* Sets at least count ghosts of the inputs of density sums; allocates if needed. */
enum status ghosts_of_density(struct simulation *simulation, ptrdiff_t count, struct error *error);
/* Sets the ghosts of the inputs of pair sums, as many as the reach requires. */
void ghosts_of_pairs(struct simulation *simulation);

/* --- reach.c ---------------------------------------------------------------------------------- */

/* Number of particles of the range with a neighbour at offset d within their own h. */
double reach_inside(const struct particles *particles, ptrdiff_t first, int len, ptrdiff_t d);
/* Raises the range's reach until it covers h; false if that requires more ghosts than are set. */
bool reach_cover(const struct simulation *simulation, struct range *range);
/* Lowers a reach that is larger than needed. */
void reach_tighten(const struct simulation *simulation, struct range *range);
/* The reach of pairs within max(h_i, h_j): the largest reach of all ranges whose own reach touches
 * this range. */
ptrdiff_t reach_of_pairs(const struct simulation *simulation, const struct range *range);

/* --- the passes: widths.c, forces.c, groups.c; members of struct sums ------------------------- */

enum status widths_find(struct simulation *simulation, bool newton, double ratio,
                        struct error *error);
void forces_matrix(struct simulation *simulation);
enum status forces_sum(struct simulation *simulation, double *rate, struct error *error);
double forces_signal(struct simulation *simulation);
enum status forces_reserve_scratch(struct simulation *simulation, ptrdiff_t reach,
                                   struct error *error);
enum status groups_begin(struct simulation *simulation, struct error *error);
void groups_update(struct simulation *simulation);
bool groups_sleep(const struct simulation *simulation, ptrdiff_t i);
/* Wakes all groups, because the order of particles, and so the members of the groups, have changed.
 */
void groups_wake_all(struct simulation *simulation);
