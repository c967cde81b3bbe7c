/* SPDX-License-Identifier: GPL-3.0-or-later
 * Inside of a grid: shared by its cells (grid.c), its lists (grid_lists.c) and
 * the loops that tell who is near (grid_near.c). */
#ifndef SPHPROOF_GRID_INSIDE_H
#define SPHPROOF_GRID_INSIDE_H

#include <math.h>

#include "grid.h"
#include "team.h"

enum {
    TILE = 8,             /* columns of a tile, each way */
    PART = 256,           /* slots of a part at most, but for a cell that holds more */
    SAMPLE = 1000,        /* radii that choose the size of the cells */
    CHUNK = 1 << 18,      /* words of lists that a thread asks for at once */
    CHUNK_NEXT = 1 << 19, /* words of each chunk after the first: a large page */
    CELLS_A_POINT = 2,    /* at most */
    COPIED = 16,          /* points that are copied at once; arrays of slots are that much longer */
    AHEAD = 256,          /* words of lists that are fetched before they are written */
    BEYOND = 16           /* entries that a vector may write after the end of a list */
};

/* Memory for lists, in chunks that never move. */
struct grid_pool {
    _Alignas(TEAM_APART) int32_t **chunks;
    size_t *sizes;
    size_t count, used_chunks, used; /* chunks there are; in use; words used of the last one */
};

/* What one thread needs for the cell that it works on: candidates of its points. */
struct candidates {
    _Alignas(TEAM_APART) size_t capacity, most; /* most: points around a cell in this search */
    size_t seen; /* points of the cells around, that it has candidates of */
    float *x[3], *radius2;
    uint8_t *near;
    uint16_t *marks;
    int32_t *slots; /* 2D: of the points of the cells around */
};

/* What the points of a cell lie in, and the largest of their radii squared. */
struct surroundings {
    float lo[3], hi[3], radius2;
};

struct grid;

/* 3D: appends the points of a cell, moved by what lies between it and the cell that looks, to the
 * count candidates that there are, if they may be near; marks them, the first one as number at.
 * Returns how many candidates there are then. */
typedef size_t take_loop(const struct grid *grid, size_t cell, const float moved[3],
                         const struct surroundings *around, struct candidates *to, size_t count,
                         size_t at);

/* Marks the candidates that are near a point. Returns how many. */
typedef int32_t find_loop(int dim, const struct candidates *candidates, size_t count,
                          const float at[3], float radius2, uint16_t *marks);

/* The slots of the marked candidates; the list has room for all and BEYOND. Returns how many. */
typedef int32_t read_loop(const int32_t *candidates, const uint16_t *marks, size_t count,
                          int32_t *list);

struct grid {
    struct grid_box box;
    int threads, team; /* there are; at work */
    size_t n, capacity;
    double lo[3], side[3], size[3], cell_inverse[3]; /* side: period or extent */
    double unit; /* what single precision is used in: the usual radius */
    ptrdiff_t cells[3];
    size_t cell_count, cell_capacity, column_capacity;
    uint32_t *column;     /* y + cells[1] z -> rank of the column of cells along x */
    uint32_t *column_at;  /* and back */
    uint32_t *start;      /* first slot of each cell, and the end */
    uint32_t *cell_of;    /* of each point */
    float *widest;        /* largest radius of the cell's points; in units, as all floats here */
    float *reach;         /* how far its points and those of others reach across it */
    ptrdiff_t within[3];  /* cells that every reach covers; -1: not all the same */
    unsigned char *marks; /* two of each cell, for the rim */
    unsigned char *listed, *seen; /* of each cell in a search: has it a listed point; is it near a
                                     cell that has? */
    struct grid_run *runs;
    size_t run_count, run_capacity;
    uint16_t **reached; /* 3D, of each cell with lists: marks of the points of the cells around
                           that its own may be near; NULL: of none is it known that they are not */
    uint32_t *order;
    double (*position)[3];
    float *place[3], *radius2; /* of each slot: from the middle of its cell; radius squared */
    struct grid_list *lists;
    uint32_t *part_begin, *part_cell;
    size_t parts;
    int longest;
    size_t candidates_most;     /* of a cell */
    size_t active;              /* points that may have lists */
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

/* The coordinates of a cell from its number. */
static inline void grid_cell_coordinates(const struct grid *grid, size_t cell, ptrdiff_t c[3])
{
    const uint32_t column = grid->column_at[cell / (size_t)grid->cells[0]];
    c[0] = (ptrdiff_t)(cell % (size_t)grid->cells[0]);
    c[1] = (ptrdiff_t)column % grid->cells[1];
    c[2] = (ptrdiff_t)column / grid->cells[1];
}

/* Cells on either side along an axis that a radius, in units, covers. */
static inline ptrdiff_t grid_cells_within(const struct grid *grid, int axis, double radius)
{
    if (!(grid->size[axis] > 0)) return 0;
    const double k = ceil(radius * grid->unit * grid->cell_inverse[axis]);
    return k < (double)grid->cells[axis] ? (ptrdiff_t)k : grid->cells[axis];
}

/* The cells that the points of a cell look through on one axis: from, count; across: the edge of a
 * periodic box lies between; all: the axis has fewer cells, so that images must be compared. */
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

/* The fastest loops that this processor runs. */
take_loop *grid_take_choose(void);
find_loop *grid_find_choose(void);
read_loop *grid_read_choose(void);

/* What a find_loop does in a box hardly wider than the radii: of all images the nearest one; side:
 * period in units, HUGE_VALF where there is none. */
int32_t grid_find_images(int dim, const struct candidates *candidates, size_t count,
                         const float at[3], float radius2, const float side[3], uint16_t *marks);

/* --- grid_lists.c ----------------------------------------------------------------------------- */

/* Lists of all active points, from the cells. STATUS_ENVIRONMENT: no memory. */
enum status grid_make_lists(struct grid *grid, struct error *error);

#endif
