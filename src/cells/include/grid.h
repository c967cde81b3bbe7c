/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points in 2 and 3 dimensions sorted into cells of a regular grid, and for each point the list of
 * the others within the larger of the two search radii. Cells are numbered along x first, in tiles
 * of 8 x 8 columns, so that the neighbours of a cell lie in a few contiguous runs that stay in the
 * cache. Within a cell points keep their order: lists depend on the points alone, not on the number
 * of threads. Allen & Tildesley 2017, ch. 5. */
#ifndef SPHPROOF_GRID_H
#define SPHPROOF_GRID_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "status.h"

/* A list is read in whole vectors; the rest of the last one is filled with the sentinel, an extra
 * slot at the end of every array in slot order. */
enum { GRID_LANES = 8 };

struct grid_box {
    int dim; /* 2 or 3 */
    double lo[3], hi[3];
    bool periodic[3];
};

/* Neighbour lists are stored as slots in 2D. In 3D, where they take most of the memory, they are
 * bit masks over the points of the surrounding cells: about six bits for each neighbour. */
struct grid_list {
    const void *kept; /* slots or marks; NULL: no list */
    int32_t count;
    bool wrapped; /* differences of positions need the nearest image */
    bool marked;  /* `kept` holds marks, otherwise slots */
};

/* Work arrays of one thread for reading lists; zero-initialise. */
struct grid_reader {
    size_t capacity, longest; /* capacity of candidates and of slots */
    size_t cell, begin, end;  /* the cell whose candidates are loaded, and its slots; end 0: none */
    ptrdiff_t at[3];          /* coordinates of the cell */
    size_t slot, count;       /* the slot whose list is loaded; number of candidates */
    int32_t *candidates, *slots;
};

struct grid; /* opaque */

/* Points whose lists a search finds. */
enum grid_flag {
    GRID_LISTED,     /* list wanted */
    GRID_UNLISTED,   /* no list; so for every other value */
    GRID_BESIDE = 16 /* list wanted if a listed point may be near */
};

/* For up to n points at first; grows when needed. threads >= 1. NULL: no memory. */
struct grid *grid_create(const struct grid_box *box, size_t n, int threads);
void grid_destroy(struct grid *grid);

/* Sets the number of threads. */
void grid_team(struct grid *grid, int size);

/* Sorts n points, and finds the lists of those of the first `active` points that are flagged; the
 * other points only appear in lists. flags: an enum grid_flag for each of the first `active`
 * points, or NULL: lists for all. x: dim arrays of n, any real positions on periodic axes; radius:
 * n search radii. STATUS_BAD_INPUT: a position or a radius is not finite, or a radius exceeds half
 * a periodic side (the message names the point); STATUS_ENVIRONMENT: no memory. */
enum status grid_search(struct grid *grid, size_t n, size_t active, const double *const x[],
                        const double *radius, const unsigned char *flags, struct error *error);

/* Results of the last search. Slots number the points in the order of their cells; the sentinel is
 * slot n. position: slot -> {x, y, z (0 in 2D)}, wrapped into the box on periodic axes. */
const uint32_t *grid_order(const struct grid *grid); /* slot -> point, n of them */
const double (*grid_positions(const struct grid *grid))[3];
const struct grid_list *grid_lists(const struct grid *grid); /* of each slot */
double grid_side(const struct grid *grid, int axis);         /* period, 0: open */
/* grid_find_rim finds the cells whose points may have a neighbour that sleeps or is not active;
 * grid_in_rim tells whether a slot is in one of these cells. */
void grid_find_rim(struct grid *grid, const unsigned char *asleep);
bool grid_in_rim(const struct grid *grid, size_t slot);
int grid_longest(const struct grid *grid); /* length of the longest list, in whole vectors */

/* Allocates for the lists of the last search, with half as much again to spare; required after
 * every search. false: no memory. */
bool grid_reader_reserve(const struct grid *grid, struct grid_reader *reader);
void grid_reader_free(struct grid_reader *reader);

/* The list of a slot of grid_lists: `count` slots, then sentinels up to whole vectors. Valid until
 * the reader reads another list. Reading the slots of a cell in order is fastest. */
const int32_t *grid_read(const struct grid *grid, struct grid_reader *reader, size_t slot);

/* The periodic image nearest to 0 of d, the difference of two positions in the box: exactly odd, so
 * that both particles of a pair agree. side: the period, HUGE_VAL if not periodic. */
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

/* The slots that may appear in lists of the last search, in runs for sharing among threads, each at
 * most 256 slots, or one cell if that holds more. */
const struct grid_run *grid_runs(const struct grid *grid, size_t *count);

/* Parts of the slots for sharing among threads: at most 256 slots each, independent of the number
 * of threads. begin: parts + 1 slots. */
size_t grid_parts(const struct grid *grid, const uint32_t **begin);

/* Memory needed for n points with `neighbours` each, in bytes. */
double grid_bytes(int dim, double n, double neighbours);

#endif
