/* SPDX-License-Identifier: GPL-3.0-or-later
 * Neighbour search in 1, 2 or 3 dimensions, in an open or a periodic domain. Points are sorted
 * along a Hilbert curve and cut into blocks of NEIGHBOURS_BLOCK; the bounding boxes of blocks, of
 * eight blocks, and so on form a tree. There is no cell width to choose as in a grid: clustered
 * clouds, coincident points, any support radius and coordinates far from the origin need no special
 * case. */
#ifndef SPHPROOF_NEIGHBOURS_H
#define SPHPROOF_NEIGHBOURS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "status.h"

enum { NEIGHBOURS_BLOCK = 8, NEIGHBOURS_LEVELS = 12 };

struct points { /* the caller owns the arrays */
    int dim;    /* 1, 2, 3 */
    size_t n;
    const double *x[3]; /* n each */
    bool periodic;      /* in all dim directions, lo <= x < hi; points outside are wrapped */
    double lo[3], hi[3];
};

struct neighbours {
    int dim;
    size_t n, blocks;
    double *x[3];    /* blocks * NEIGHBOURS_BLOCK each: sorted positions, then infinity */
    uint32_t *order; /* n: sorted index -> the caller's index */
    int levels;      /* level 0: the blocks; the last level has one box */
    size_t count[NEIGHBOURS_LEVELS]; /* of boxes */
    size_t
        stride[NEIGHBOURS_LEVELS]; /* count rounded up to a multiple of 8; excess boxes are empty */
    double *lo[NEIGHBOURS_LEVELS], *hi[NEIGHBOURS_LEVELS]; /* corners: axis * stride + box */
    bool periodic;
    double length[3]; /* of the periodic box */
};

/* Whole blocks that may contain points within a radius of some block; grows as needed.
 * Zero-initialise. */
struct candidates {
    size_t n, capacity;    /* points, NEIGHBOURS_BLOCK for each block; fillings are at infinity */
    double *x[3];          /* periodic images are already shifted */
    uint32_t *j;           /* sorted indices */
    double *lo[3], *hi[3]; /* n / NEIGHBOURS_BLOCK: the blocks' boxes */
};

/* STATUS_BAD_INPUT: a coordinate is not finite (the message names the point), the box is empty or
 * there are more than 2^31 points; STATUS_ENVIRONMENT: no memory. *neighbours is NULL then. */
enum status neighbours_create(const struct points *points, struct neighbours **neighbours,
                              struct error *error);
void neighbours_destroy(struct neighbours *neighbours);

/* Replaces the candidates by all blocks (and their periodic images) whose box is within radius of
 * the box of the given block, in an order that depends on the points alone. STATUS_BAD_INPUT: the
 * radius exceeds eight periodic boxes. */
enum status neighbours_gather(const struct neighbours *neighbours, size_t block, double radius,
                              struct candidates *candidates, struct error *error);
void neighbours_candidates_free(struct candidates *candidates);

#endif
