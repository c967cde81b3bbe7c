/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sums in 1D: particles sorted by position, so that neighbours are a contiguous stretch; images in
 * what is at the ends of the box are ghost copies there; loops run over neighbour offsets d
 * = 1..reach and vectorise over the particles of a range. For the files of this folder (and
 * measurements of its loops). */
#pragma once

#include "loops.h"
#include "solver.h"

/* Up to BATCH_MAX neighbouring particles that are worked on together. */
struct range {
    ptrdiff_t first;
    int len;
    ptrdiff_t reach;       /* neighbour offsets that suffice for the particles' own h */
    ptrdiff_t force_reach; /* and for pairs within max(h_i, h_j) */
    bool recedes;          /* none of its pairs approaches: viscosity is exactly 0 */
    uint64_t done;         /* the density pass in which the widths were found */
    uint64_t predicted;    /* the one in which they were predicted */
};

enum { GROUP = 8 }; /* particles that sleep and wake together */

struct groups {
    ptrdiff_t count;
    unsigned char *awake;   /* of each group */
    unsigned char *stirred; /* of each group: awake and not calm; scratch */
    double *rate;           /* signal speed / h of each group when it fell asleep, 0 awake */
};

/* The workspace of a simulation in 1D. */
struct line {
    struct loops loops;
    struct range *ranges; /* of the awake particles */
    ptrdiff_t range_count;
    ptrdiff_t ghosts_filled;
    ptrdiff_t reach;         /* largest of the ranges */
    double predict_ratio;    /* of the present pass */
    uint64_t density_passes; /* so far; ranges know by it what belongs to this one */
    double *scratch;         /* scratch_size of each thread */
    size_t scratch_size;
    struct groups groups;
};

static inline struct line *line_of(const struct simulation *simulation)
{
    return simulation->workspace;
}

/* --- order.c ---------------------------------------------------------------------------------- */

/* Sorts by position, also across the ends of a periodic box (all into one period that starts at the
 * first particle). false: a position is not finite, and nothing has been done. */
bool order_sort(struct particles *particles);
/* Neighbours out of order among the first len + 1 particles from first (NaN counts). */
double order_crossings(const struct particles *particles, ptrdiff_t first, ptrdiff_t len);
/* Members of struct sums. */
void order_begin(struct simulation *simulation);
enum status order_arrange(struct simulation *simulation, struct error *error);

/* --- ghosts.c --------------------------------------------------------------------------------- */

/* Copies the periodic images of count particles to both ends of an array; shift: what is added per
 * period (the period for x, 0 for the rest). */
void ghosts_fill(const struct particles *particles, double *array, ptrdiff_t count, double shift);
enum ghost_value { GHOST_SCALAR, GHOST_VECTOR, GHOST_PLACE };

/* The same with whatever is at the ends of the simulation's box: periodic images; mirror images,
 * whose vectors point the other way; or copies of the outermost particles far away (open ends, and
 * fixed ones, whose layers are particles). */
void ghosts_set(const struct simulation *simulation, double *array, ptrdiff_t count,
                enum ghost_value value);
/* Ghosts of what the density sums read, at least count of them; grows their memory. */
enum status ghosts_of_density(struct simulation *simulation, ptrdiff_t count, struct error *error);
/* Ghosts of what the pair sums read, as many as the reach asks for. */
void ghosts_of_pairs(struct simulation *simulation);

/* --- reach.c ---------------------------------------------------------------------------------- */

/* Particles of the range with the neighbour at offset d inside their own width. */
double reach_inside(const struct particles *particles, ptrdiff_t first, int len, ptrdiff_t d);
/* Raises the range's reach until it covers the widths h; false where that takes more ghosts than
 * are filled. */
bool reach_cover(const struct simulation *simulation, struct range *range);
/* Lowers a reach that has become larger than needed. */
void reach_tighten(const struct simulation *simulation, struct range *range);
/* Pairs reach as far as the wider of the two: the largest reach of all ranges whose own reach
 * touches this one. */
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
/* Wakes all groups: the order of particles has changed, and groups are others now. */
void groups_wake_all(struct simulation *simulation);
