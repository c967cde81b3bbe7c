/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points in 2 and 3 dimensions sorted into cells of a regular grid, and for each of them the list
 * of the others that are nearer than the wider of two search radii. Cells are numbered along x
 * first, in tiles of 8 x 8 columns, so that the neighbours of a cell lie in a few contiguous runs
 * that stay in the cache. Within a cell points keep their order: lists depend on the points alone,
 * not on threads. Allen & Tildesley 2017, ch. 5. */
#ifndef SPHPROOF_GRID_H
#define SPHPROOF_GRID_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "status.h"

/* A list is read in whole vectors; the rest of the last one is filled with the sentinel, a slot of
 * its own at the end of every array in slot order. */
enum { GRID_LANES = 8 };

struct grid_box {
    int dim; /* 2 or 3 */
    double lo[3], hi[3];
    bool periodic[3];
};

/* Neighbour lists are stored as slots in 2D. In 3D, where they take most of the memory, they are
 * bit masks over the points of the surrounding cells: about six bits for each neighbour. */
struct grid_list {
    const void *kept; /* NULL: not active */
    int32_t count;
    bool wrapped; /* differences of positions need the nearest image */
    bool marked;  /* kept are marks, else slots */
};

/* What one thread reads lists with, zero at first. */
struct grid_reader {
    size_t room, longest;    /* candidates and entries of lists that there is room for */
    size_t cell, begin, end; /* whose candidates are there, and its slots; end 0: none yet */
    ptrdiff_t at[3];         /* the cell's place */
    size_t slot, count;      /* whose list is there; candidates */
    int32_t *candidates, *slots;
};

struct grid; /* private to grid.c but for what the functions below give */

/* Which lists a search finds. */
enum grid_flag {
    GRID_LISTED,     /* this one */
    GRID_UNLISTED,   /* not this one; as every other value */
    GRID_BESIDE = 16 /* this one where a listed point may be near */
};

/* For n points at most at first; grows with the points. threads >= 1. NULL: no memory. */
struct grid *grid_create(const struct grid_box *box, size_t n, int threads);
void grid_destroy(struct grid *grid);

/* So many of them search from here on. */
void grid_team(struct grid *grid, int size);

/* Sorts n points and finds the list of each of the first `active` ones (the others are only found)
 * that is flagged so; flags: an enum
 * grid_flag of each of those, or NULL: all are listed. x: dim arrays of n, any real
 * positions on periodic axes; radius: n search radii.
 * STATUS_BAD_INPUT: a position or a radius is not finite, or a radius exceeds half a periodic side
 * (the message names the point); STATUS_ENVIRONMENT: no memory. */
enum status grid_search(struct grid *grid, size_t n, size_t active, const double *const x[],
                        const double *radius, const unsigned char *flags, struct error *error);

/* Of the last search. Slots run over the points in the order of their cells; the sentinel is slot
 * n. position: slot -> {x, y, z (0 in 2D)}, wrapped into the box on periodic axes. */
const uint32_t *grid_order(const struct grid *grid); /* slot -> point, n of them */
const double (*grid_positions(const struct grid *grid))[3];
const struct grid_list *grid_lists(const struct grid *grid); /* of each slot */
double grid_side(const struct grid *grid, int axis);         /* period, 0: open */
/* Finds the cells whose points may have a point that sleeps, or is not active, in their lists;
 * then: is the slot in one of them? */
void grid_find_rim(struct grid *grid, const unsigned char *asleep);
bool grid_in_rim(const struct grid *grid, size_t slot);
int grid_longest(const struct grid *grid); /* list, in whole vectors */

/* Makes room for the lists of the last search, half as much again as they need; needed after every
 * search. false: no memory. */
bool grid_reader_reserve(const struct grid *grid, struct grid_reader *reader);
void grid_reader_free(struct grid_reader *reader);

/* The list of an active slot, of grid_lists: its count of slots, then sentinels up to whole
 * vectors. Until the reader reads another one; slots of a cell are fastest one after the other. */
const int32_t *grid_read(const struct grid *grid, struct grid_reader *reader, size_t slot);

/* The difference of two positions in the box, or of its image, that is nearest to 0: exactly odd,
 * so that both sides of a pair agree. side: the period, HUGE_VAL where there is none. */
static inline double grid_nearest(double d, double side)
{
    const double half = 0.5 * side;
    return d > half ? d - side : d < -half ? d + side : d;
}

static inline const int32_t *grid_neighbours(const struct grid *grid, struct grid_reader *reader,
                                             const struct grid_list *lists, size_t slot)
{
    return lists[slot].marked ? grid_read(grid, reader, slot) : lists[slot].kept;
}

/* Slots begin .. end-1. */
struct grid_run {
    uint32_t begin, end;
};

/* The slots that lists of the last search may hold, in runs for threads to share, of at most 256
 * but for a cell that holds more. */
const struct grid_run *grid_runs(const struct grid *grid, size_t *count);

/* Parts of the slots for threads to share: at most 256 slots each, independent of the number of
 * threads. begin: parts + 1 slots. */
size_t grid_parts(const struct grid *grid, const uint32_t **begin);

/* Bytes that a grid of n points with lists of `neighbours` each comes to use. */
double grid_bytes(int dim, double n, double neighbours);

#endif
