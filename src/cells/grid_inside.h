/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to the grid: shared by its cells (grid.c), its lists (grid_lists.c) and the distance
 * loops (grid_near.c). */
#ifndef SPHPROOF_GRID_INSIDE_H
#define SPHPROOF_GRID_INSIDE_H

#include <math.h>

#include "grid.h"
#include "team.h"

enum {
    TILE = 8,             /* columns of a tile, in y and in z */
    PART = 256,           /* maximum slots of a part, unless one cell has more */
    SAMPLE = 1000,        /* radii sampled for the cell size */
    CHUNK = 1 << 18,      /* words of a thread's first chunk of lists */
    CHUNK_NEXT = 1 << 19, /* words of each further chunk: a large page */
    CELLS_A_POINT = 2,    /* maximum */
    COPIED = 16,          /* points copied at once; arrays by slot are that much longer */
    AHEAD = 256,          /* distance of prefetching, in words of lists */
    BEYOND = 16           /* entries that may be written after the end of a list */
};

/* Memory of lists, in chunks that never move. */
struct grid_pool {
    _Alignas(TEAM_APART) int32_t **chunks;
    size_t *sizes;
    size_t count, used_chunks, used; /* chunks allocated; in use; words used of the last one */
};

/* Work arrays of one thread: candidates for the lists of one cell's points. */
struct candidates {
    _Alignas(TEAM_APART) size_t capacity, most; /* most: points around a cell */
    size_t seen;                                /* points of the surrounding cells */
    float *x[3], *radius2;
    uint8_t *near;
    uint16_t *marks;
    int32_t *slots; /* 2D: of the points of the surrounding cells */
};

/* Bounding box of a cell's points and their largest squared radius. images: the nearest image of
 * each candidate counts. side: the periods in units; HUGE_VALF along axes that are not periodic,
 * and along all axes without images. */
struct surroundings {
    float lo[3], hi[3], radius2;
    bool images;
    float side[3];
};

struct grid;

/* 3D: appends those points of a cell to the `count` candidates that may be near the box `around`,
 * shifted by `moved`, the offset of the cell from the one that searches. Sets their bits in
 * to->marks, where the cell's first point has number `at`. Returns the new number of candidates. */
typedef size_t take_loop(const struct grid *grid, size_t cell, const float moved[3],
                         const struct surroundings *around, struct candidates *to, size_t count,
                         size_t at);

/* Marks the candidates near a point. Returns their number. side: NULL; or, in a box hardly wider
 * than the radii, where the nearest image of each candidate counts, the periods in units, HUGE_VALF
 * if not periodic. */
typedef int32_t find_loop(int dim, const struct candidates *candidates, size_t count,
                          const float at[3], float radius2, const float *side, uint16_t *marks);

/* Writes the slots of the marked candidates to list, which has space for all and BEYOND. Returns
 * their number. */
typedef int32_t read_loop(const int32_t *candidates, const uint16_t *marks, size_t count,
                          int32_t *list);

struct grid {
    struct grid_box box;
    int threads, team; /* maximum; in use */
    size_t n, capacity;
    double lo[3], side[3], size[3], cell_inverse[3]; /* side: period, or extent of the points */
    double unit; /* unit of length of all floats: the usual radius */
    ptrdiff_t cells[3];
    size_t cell_count, cell_capacity, column_capacity;
    uint32_t *column;             /* y + cells[1] z -> rank of the column of cells along x */
    uint32_t *column_at;          /* inverse of column */
    uint32_t *start;              /* first slot of each cell, and the end */
    uint32_t *cell_of;            /* of each point */
    float *widest;                /* largest radius of each cell's points */
    float *reach;                 /* largest radius that matters for each cell (find_reaches) */
    ptrdiff_t within[3];          /* cells covered by the reach; -1: differs between cells */
    unsigned char *marks;         /* four arrays by cell: sleeping, rim, listed, seen */
    unsigned char *listed, *seen; /* by cell: it has a listed point; a listed cell searches it */
    struct grid_run *runs;
    size_t run_count, run_capacity;
    uint16_t **reached; /* 3D, for each cell with lists: marks of the points of the surrounding
                           cells that are candidates; NULL: all are */
    uint32_t *order;
    double (*position)[3];
    float *in_cell[3], *radius2; /* by slot: position in its cell; radius squared */
    struct grid_list *lists;
    uint32_t *part_begin, *part_cell;
    size_t parts;
    int longest;
    size_t candidates_most;     /* largest number around a cell */
    size_t active;              /* number of points that may have lists */
    const unsigned char *flags; /* of the last search */
    struct grid_pool *pools;
    struct candidates *candidates;
    take_loop *take;
    find_loop *find;
    read_loop *read;
};

static inline bool grid_wraps(const struct grid *grid, int axis)
{
    return axis < grid->box.dim && grid->box.periodic[axis];
}

static inline size_t grid_cell_at(const struct grid *grid, const ptrdiff_t c[3])
{
    return (size_t)grid->column[c[1] + grid->cells[1] * c[2]] * (size_t)grid->cells[0] +
           (size_t)c[0];
}

/* Coordinates of a cell from its number. */
static inline void grid_cell_coordinates(const struct grid *grid, size_t cell, ptrdiff_t c[3])
{
    const uint32_t column = grid->column_at[cell / (size_t)grid->cells[0]];
    c[0] = (ptrdiff_t)(cell % (size_t)grid->cells[0]);
    c[1] = (ptrdiff_t)column % grid->cells[1];
    c[2] = (ptrdiff_t)column / grid->cells[1];
}

/* Number of cells on either side along an axis that a radius, in units, covers. */
static inline ptrdiff_t grid_cells_within(const struct grid *grid, int axis, double radius)
{
    if (!(grid->size[axis] > 0)) return 0;
    const double k = ceil(radius * grid->unit * grid->cell_inverse[axis]);
    return k < (double)grid->cells[axis] ? (ptrdiff_t)k : grid->cells[axis];
}

/* The cells along one axis that are searched for the points of a cell: `count` cells from `from`;
 * across: the range crosses the edge of a periodic box; all: the axis has fewer cells than the
 * range, so that each pair needs its nearest image. */
struct look {
    ptrdiff_t from, count;
    bool across, all;
};

static inline struct look grid_look_along(const struct grid *grid, int axis, ptrdiff_t at,
                                          double radius)
{
    const ptrdiff_t within = grid->within[axis], cells = grid->cells[axis],
                    k = within >= 0 ? within : grid_cells_within(grid, axis, radius);
    struct look look = {at - k, 2 * k + 1, false, false};
    if (grid_wraps(grid, axis)) {
        look.all = look.count > cells;
        look.across = look.all || look.from < 0 || at + k >= cells;
        if (look.all) look = (struct look){0, cells, true, true};
        return look;
    }
    if (look.from < 0) look.from = 0;
    const ptrdiff_t end = at + k + 1 < cells ? at + k + 1 : cells;
    look.count = end - look.from;
    return look;
}

static inline ptrdiff_t grid_folded(const struct grid *grid, int axis, ptrdiff_t c)
{
    return c < 0 ? c + grid->cells[axis] : c >= grid->cells[axis] ? c - grid->cells[axis] : c;
}

/* --- grid_near.c ------------------------------------------------------------------------------ */

/* The fastest loops that this processor supports. */
take_loop *grid_take_choose(void);
find_loop *grid_find_choose(void);
read_loop *grid_read_choose(void);

/* --- grid_lists.c ----------------------------------------------------------------------------- */

/* Makes the lists of all active points. STATUS_ENVIRONMENT: no memory. */
enum status grid_make_lists(struct grid *grid, struct error *error);

#endif
