/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stamp.h"

#if SPHPROOF_CLONES && defined __x86_64__
#include <immintrin.h>
#endif

#ifdef _OPENMP
#include <omp.h>
#endif

enum {
    TILE = 8,          /* columns of a tile, each way */
    PART = 256,        /* slots of a part at most, but for a cell that holds more */
    SAMPLE = 1000,     /* radii that choose the size of the cells */
    CHUNK = 1 << 18,   /* entries of lists that a thread asks for at once */
    CELLS_A_POINT = 2, /* at most */
    BEYOND = 16        /* entries that a vector may write after the end of a list */
};

/* Memory for lists, in chunks that never move. */
struct pool {
    int32_t **chunks;
    size_t *sizes;
    size_t count, used_chunks, used; /* chunks there are; in use; entries used of the last one */
};

/* What one thread needs for the cell that it works on: candidates of its points. */
struct candidates {
    size_t capacity;
    float *x[3], *radius2;
    int32_t *slot;
    uint8_t *near;
};

/* The slots of the candidates that are near a point but s itself. Returns how many; the list has
 * room for all and BEYOND. */
typedef int32_t find_loop(int dim, const struct candidates *candidates, size_t count,
                          const float at[3], float radius2, int32_t s, int32_t *list);

struct grid {
    struct grid_box box;
    int threads;
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
    unsigned char *marks; /* two of each cell, for grid_wake */
    uint32_t *order;
    double (*position)[4];
    float *radius;             /* of each slot */
    float *place[3], *radius2; /* of each slot: from the middle of its cell; radius squared */
    struct grid_list *lists;
    uint32_t *part_begin, *part_cell;
    size_t parts;
    int longest;
    size_t active;               /* points that may have lists */
    const unsigned char *asleep; /* of the last search */
    struct pool *pools;
    struct candidates *candidates;
    find_loop *find;
};

static void free_all(struct grid *grid)
{
    free(grid->cell_of);
    free(grid->order);
    free(grid->position);
    free(grid->radius);
    free(grid->radius2);
    for (int a = 0; a < 3; a++) free(grid->place[a]);
    free(grid->lists);
    free(grid->part_begin);
    free(grid->part_cell);
}

static bool reserve_points(struct grid *grid, size_t n)
{
    if (n + 1 <= grid->capacity) return true;
    free_all(grid);
    const size_t capacity = n + n / 4 + 64;
    grid->capacity = capacity;
    grid->cell_of = malloc(capacity * sizeof *grid->cell_of);
    grid->order = malloc(capacity * sizeof *grid->order);
    grid->position = aligned_alloc(64, (capacity * sizeof *grid->position + 63) / 64 * 64);
    grid->radius = malloc(capacity * sizeof *grid->radius);
    bool floats = (grid->radius2 = malloc(capacity * sizeof(float)));
    for (int a = 0; a < 3; a++)
        floats &= (grid->place[a] = malloc(capacity * sizeof(float))) != NULL;
    grid->lists = malloc(capacity * sizeof *grid->lists);
    grid->part_begin = malloc((capacity + 1) * sizeof *grid->part_begin);
    grid->part_cell = malloc((capacity + 1) * sizeof *grid->part_cell);
    if (floats && grid->cell_of && grid->order && grid->position && grid->radius && grid->lists &&
        grid->part_begin && grid->part_cell)
        return true;
    grid->capacity = 0;
    return false;
}

void grid_destroy(struct grid *grid)
{
    if (!grid) return;
    for (int t = 0; t < grid->threads; t++) {
        for (size_t c = 0; grid->pools && c < grid->pools[t].count; c++)
            free(grid->pools[t].chunks[c]);
        if (grid->pools) free(grid->pools[t].chunks), free(grid->pools[t].sizes);
        if (grid->candidates) free(grid->candidates[t].slot);
    }
    free(grid->pools);
    free(grid->candidates);
    free_all(grid);
    free(grid->column);
    free(grid->column_at);
    free(grid->start);
    free(grid->widest);
    free(grid->reach);
    free(grid->marks);
    free(grid);
}

/* --- cells ------------------------------------------------------------------------------------ */

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Three quarters of the points reach no further than this: cells of that size are searched with
 * their next neighbours only, wider points look through more of them. */
static double usual_radius(size_t n, const double *radius)
{
    double sample[SAMPLE];
    const size_t count = n < SAMPLE ? n : SAMPLE;
    for (size_t k = 0; k < count; k++) sample[k] = radius[k * n / count];
    qsort(sample, count, sizeof *sample, compare_doubles);
    return sample[count * 3 / 4];
}

static enum status find_extent(struct grid *grid, size_t n, const double *const x[],
                               const double *radius, struct error *error)
{
    const struct grid_box *box = &grid->box;
    for (size_t i = 0; i < n; i++)
        if (!(isfinite(radius[i]) && radius[i] > 0))
            return error_set(error, STATUS_BAD_INPUT, "search radius of particle %zu is %g", i,
                             radius[i]);
    for (int a = 0; a < box->dim; a++) {
        double lo = x[a][0], hi = x[a][0];
        bool sound = true;
        for (size_t i = 0; i < n; i++) {
            sound &= isfinite(x[a][i]);
            lo = x[a][i] < lo ? x[a][i] : lo;
            hi = x[a][i] > hi ? x[a][i] : hi;
        }
        for (size_t i = 0; !sound && i < n; i++)
            if (!isfinite(x[a][i]))
                return error_set(error, STATUS_BAD_INPUT, "position of particle %zu is %g", i,
                                 x[a][i]);
        grid->lo[a] = box->periodic[a] ? box->lo[a] : lo;
        grid->side[a] = box->periodic[a] ? box->hi[a] - box->lo[a] : hi - lo;
        for (size_t i = 0; box->periodic[a] && i < n; i++)
            if (!(radius[i] <= 0.5 * grid->side[a]))
                return error_set(error, STATUS_BAD_INPUT,
                                 "particle %zu reaches as far as %g, beyond half the box (%g): "
                                 "more particles or a smaller eta are needed",
                                 i, radius[i], 0.5 * grid->side[a]);
    }
    return STATUS_OK;
}

/* Cells at least as large as the usual radius, and not many more of them than points. */
static enum status lay_cells(struct grid *grid, size_t n, const double *radius, struct error *error)
{
    const int dim = grid->box.dim;
    double size = usual_radius(n, radius) * (1 + 1e-5);
    grid->unit = size;
    for (;; size *= 1.3) {
        double count = 1;
        for (int a = 0; a < dim; a++) count *= fmax(1, floor(grid->side[a] / size));
        if (count <= (double)(CELLS_A_POINT * n + 64)) break;
    }
    grid->cell_count = 1;
    for (int a = 0; a < 3; a++) {
        grid->cells[a] = a < dim ? (ptrdiff_t)fmax(1, floor(grid->side[a] / size)) : 1;
        grid->size[a] = a < dim ? grid->side[a] / (double)grid->cells[a] : 0;
        grid->cell_inverse[a] = grid->size[a] > 0 ? 1 / grid->size[a] : 0;
        grid->cell_count *= (size_t)grid->cells[a];
    }
    const size_t columns = (size_t)(grid->cells[1] * grid->cells[2]);
    if (columns > grid->column_capacity) {
        free(grid->column);
        free(grid->column_at);
        grid->column_capacity = 2 * columns;
        grid->column = malloc(grid->column_capacity * sizeof *grid->column);
        grid->column_at = malloc(grid->column_capacity * sizeof *grid->column_at);
        if (!grid->column || !grid->column_at) grid->column_capacity = 0;
    }
    if (grid->cell_count + 1 > grid->cell_capacity) {
        free(grid->start);
        free(grid->widest);
        free(grid->reach);
        grid->cell_capacity = 2 * grid->cell_count + 1;
        free(grid->marks);
        grid->marks = malloc(2 * grid->cell_capacity);
        grid->start = malloc(grid->cell_capacity * sizeof *grid->start);
        grid->widest = malloc(grid->cell_capacity * sizeof *grid->widest);
        grid->reach = malloc(grid->cell_capacity * sizeof *grid->reach);
        if (!grid->start || !grid->widest || !grid->reach || !grid->marks) grid->cell_capacity = 0;
    }
    if (!grid->column_capacity || !grid->cell_capacity)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu cells", grid->cell_count);
    uint32_t rank = 0;
    for (ptrdiff_t tz = 0; tz < grid->cells[2]; tz += TILE)
        for (ptrdiff_t ty = 0; ty < grid->cells[1]; ty += TILE)
            for (ptrdiff_t z = tz; z < tz + TILE && z < grid->cells[2]; z++)
                for (ptrdiff_t y = ty; y < ty + TILE && y < grid->cells[1]; y++) {
                    grid->column_at[rank] = (uint32_t)(y + grid->cells[1] * z);
                    grid->column[y + grid->cells[1] * z] = rank++;
                }
    return STATUS_OK;
}

static size_t cell_at(const struct grid *grid, const ptrdiff_t c[3])
{
    return (size_t)grid->column[c[1] + grid->cells[1] * c[2]] * (size_t)grid->cells[0] +
           (size_t)c[0];
}

/* Into the box: round-off may end at the upper edge, which is the lower one. */
static double wrapped(double x, double lo, double side)
{
    const double y = x - side * floor((x - lo) / side);
    return y < lo + side ? y : lo;
}

/* The coordinates of a cell from its number. */
static void cell_coordinates(const struct grid *grid, size_t cell, ptrdiff_t c[3])
{
    const uint32_t column = grid->column_at[cell / (size_t)grid->cells[0]];
    c[0] = (ptrdiff_t)(cell % (size_t)grid->cells[0]);
    c[1] = (ptrdiff_t)column % grid->cells[1];
    c[2] = (ptrdiff_t)column / grid->cells[1];
}

/* Single precision is enough for the search where it starts at the middle of a cell. */
static void place_in_cells(struct grid *grid)
{
    const double scale = 1 / grid->unit;
    for (size_t cell = 0; cell < grid->cell_count; cell++) {
        ptrdiff_t c[3];
        if (grid->start[cell] == grid->start[cell + 1]) continue;
        cell_coordinates(grid, cell, c);
        for (int a = 0; a < 3; a++) {
            const double middle = grid->lo[a] + ((double)c[a] + 0.5) * grid->size[a];
            for (uint32_t s = grid->start[cell]; s < grid->start[cell + 1]; s++)
                grid->place[a][s] =
                    a < grid->box.dim ? (float)((grid->position[s][a] - middle) * scale) : 0;
        }
    }
}

/* A counting sort: stable, so that points of a cell keep their order. */
static void sort_points(struct grid *grid, size_t n, const double *const x[], const double *radius)
{
    const int dim = grid->box.dim;
    memset(grid->start, 0, (grid->cell_count + 1) * sizeof *grid->start);
    for (size_t i = 0; i < n; i++) {
        ptrdiff_t c[3] = {0};
        for (int a = 0; a < dim; a++) {
            const double at =
                grid->box.periodic[a] ? wrapped(x[a][i], grid->lo[a], grid->side[a]) : x[a][i];
            const ptrdiff_t k = (ptrdiff_t)((at - grid->lo[a]) * grid->cell_inverse[a]);
            c[a] = k < grid->cells[a] ? k : grid->cells[a] - 1;
        }
        grid->cell_of[i] = (uint32_t)cell_at(grid, c);
        grid->start[grid->cell_of[i] + 1]++;
    }
    for (size_t c = 0; c < grid->cell_count; c++) grid->start[c + 1] += grid->start[c];
    for (size_t i = 0; i < n; i++) grid->order[grid->start[grid->cell_of[i]]++] = (uint32_t)i;
    memmove(grid->start + 1, grid->start, grid->cell_count * sizeof *grid->start);
    grid->start[0] = 0;
    for (size_t s = 0; s < n; s++) {
        const size_t i = grid->order[s];
        for (int a = 0; a < 3; a++)
            grid->position[s][a] = a >= dim ? 0
                                   : grid->box.periodic[a]
                                       ? wrapped(x[a][i], grid->lo[a], grid->side[a])
                                       : x[a][i];
        grid->position[s][3] = 0;
        grid->radius[s] = (float)(radius[i] / grid->unit * (1 + 1e-5));
        grid->radius2[s] = grid->radius[s] * grid->radius[s];
    }
    place_in_cells(grid);
    /* the sentinel: far from everything, at any image */
    for (int a = 0; a < 3; a++) grid->position[n][a] = 0;
    double far = 0;
    for (int a = 0; a < dim; a++) far = fmax(far, fabs(grid->lo[a]) + grid->side[a]);
    for (size_t i = 0; i < n; i++) far = fmax(far, radius[i]);
    grid->position[n][0] = 64 * far;
    grid->position[n][3] = 0;
}

/* Cells on either side along an axis that a radius, in units, covers. */
static ptrdiff_t cells_within(const struct grid *grid, int axis, double radius)
{
    if (!(grid->size[axis] > 0)) return 0;
    const double k = ceil(radius * grid->unit * grid->cell_inverse[axis]);
    return k < (double)grid->cells[axis] ? (ptrdiff_t)k : grid->cells[axis];
}

/* The cells that the points of a cell look through on one axis: from, count; across: the edge of a
 * periodic box lies between; all: the axis has no more cells, so that images must be compared. */
struct look {
    ptrdiff_t from, count;
    bool across, all;
};

static struct look look_along(const struct grid *grid, int axis, ptrdiff_t at, double radius)
{
    const ptrdiff_t k = cells_within(grid, axis, radius), cells = grid->cells[axis];
    struct look look = {at - k, 2 * k + 1, false, false};
    if (axis < grid->box.dim && grid->box.periodic[axis]) {
        look.all = look.count >= cells;
        look.across = look.all || look.from < 0 || at + k >= cells;
        if (look.all) look = (struct look){0, cells, true, true};
        return look;
    }
    if (look.from < 0) look.from = 0;
    const ptrdiff_t end = at + k + 1 < cells ? at + k + 1 : cells;
    look.count = end - look.from;
    return look;
}

static ptrdiff_t folded(const struct grid *grid, int axis, ptrdiff_t c)
{
    return c < 0 ? c + grid->cells[axis] : c >= grid->cells[axis] ? c - grid->cells[axis] : c;
}

/* A cell's reach: the largest radius among its own points and those of the cells whose points reach
 * as far as this one. */
static void find_reaches(struct grid *grid)
{
    float least = INFINITY, most = 0;
    for (size_t c = 0; c < grid->cell_count; c++) {
        float widest = 0;
        for (uint32_t s = grid->start[c]; s < grid->start[c + 1]; s++)
            widest = grid->radius[s] > widest ? grid->radius[s] : widest;
        grid->widest[c] = grid->reach[c] = widest;
        if (widest > 0 && widest < least) least = widest;
        most = widest > most ? widest : most;
    }
    bool same = true;
    for (int a = 0; a < grid->box.dim; a++)
        same &= cells_within(grid, a, least) == cells_within(grid, a, most);
    if (same) {
        for (size_t c = 0; c < grid->cell_count; c++) grid->reach[c] = most;
        return;
    }
    for (ptrdiff_t z = 0; z < grid->cells[2]; z++)
        for (ptrdiff_t y = 0; y < grid->cells[1]; y++)
            for (ptrdiff_t x = 0; x < grid->cells[0]; x++) {
                const float widest = grid->widest[cell_at(grid, (ptrdiff_t[3]){x, y, z})];
                if (!(widest > 0)) continue;
                const struct look lx = look_along(grid, 0, x, widest),
                                  ly = look_along(grid, 1, y, widest),
                                  lz = look_along(grid, 2, z, widest);
                for (ptrdiff_t kz = 0; kz < lz.count; kz++)
                    for (ptrdiff_t ky = 0; ky < ly.count; ky++) {
                        const size_t row =
                            cell_at(grid, (ptrdiff_t[3]){0, folded(grid, 1, ly.from + ky),
                                                         folded(grid, 2, lz.from + kz)});
                        for (ptrdiff_t kx = 0; kx < lx.count; kx++) {
                            float *reach =
                                &grid->reach[row + (size_t)folded(grid, 0, lx.from + kx)];
                            *reach = widest > *reach ? widest : *reach;
                        }
                    }
            }
}

/* Whole cells, of about PART points. */
static void cut_parts(struct grid *grid)
{
    size_t parts = 0;
    uint32_t begun = 0;
    grid->part_begin[0] = 0;
    grid->part_cell[0] = 0;
    for (size_t c = 0; c < grid->cell_count; c++) {
        const uint32_t end = grid->start[c + 1];
        if (end - begun < PART / 2 && c + 1 < grid->cell_count) continue;
        if (end == begun && c + 1 < grid->cell_count) continue;
        parts++;
        grid->part_begin[parts] = begun = end;
        grid->part_cell[parts] = (uint32_t)(c + 1);
    }
    grid->parts = parts;
}

/* --- lists ------------------------------------------------------------------------------------ */

static int32_t *pool_take(struct pool *pool, size_t most)
{
    if (pool->used_chunks == 0 || pool->used + most > pool->sizes[pool->used_chunks - 1]) {
        while (pool->used_chunks < pool->count && pool->sizes[pool->used_chunks] < most)
            pool->used_chunks++;
        if (pool->used_chunks == pool->count) {
            const size_t size = most > CHUNK ? most : CHUNK;
            int32_t **chunks = realloc(pool->chunks, (pool->count + 1) * sizeof *chunks);
            if (!chunks) return NULL;
            pool->chunks = chunks;
            size_t *sizes = realloc(pool->sizes, (pool->count + 1) * sizeof *sizes);
            if (!sizes) return NULL;
            pool->sizes = sizes;
            pool->chunks[pool->count] = malloc(size * sizeof **chunks);
            if (!pool->chunks[pool->count]) return NULL;
            pool->sizes[pool->count++] = size;
        }
        pool->used_chunks++;
        pool->used = 0;
    }
    return pool->chunks[pool->used_chunks - 1] + pool->used;
}

/* Room for n more after count, which are kept. */
static bool reserve_candidates(struct candidates *candidates, size_t count, size_t n)
{
    if (count + n <= candidates->capacity) return true;
    const size_t capacity = (2 * (count + n) + 127) / 64 * 64;
    char *block = aligned_alloc(64, capacity * (5 * 4 + 4));
    if (!block) return false;
    struct candidates grown = {.capacity = capacity, .slot = (int32_t *)(void *)block};
    float *next = (float *)(void *)(block + 4 * capacity);
    for (int a = 0; a < 3; a++, next += capacity) grown.x[a] = next;
    grown.radius2 = next;
    grown.near = (uint8_t *)(void *)(next + capacity);
    for (int a = 0; a < 3 && count; a++)
        memcpy(grown.x[a], candidates->x[a], count * sizeof(float));
    if (count) {
        memcpy(grown.radius2, candidates->radius2, count * sizeof(float));
        memcpy(grown.slot, candidates->slot, count * sizeof *grown.slot);
    }
    free(candidates->slot);
    *candidates = grown;
    return true;
}

/* Which candidates are near the point at x? `near` gets 0 or 1; count in whole 64s. */
#define NEAR(name, dim)                                                                            \
    CLONES static void name(size_t count, const float at[3], float radius2,                        \
                            const float *restrict x, const float *restrict y,                      \
                            const float *restrict z, const float *restrict other,                  \
                            uint8_t *restrict near)                                                \
    {                                                                                              \
        const float x0 = at[0], y0 = at[1], z0 = at[2];                                            \
        _Pragma("omp simd") for (size_t k = 0; k < count; k++)                                     \
        {                                                                                          \
            const float dx = x[k] - x0, dy = y[k] - y0, dz = dim == 3 ? z[k] - z0 : 0;             \
            const float r2 = dim == 3 ? dx * dx + dy * dy + dz * dz : dx * dx + dy * dy;           \
            const float most = other[k] > radius2 ? other[k] : radius2;                            \
            near[k] = r2 < most;                                                                   \
        }                                                                                          \
    }
NEAR(near_2, 2)
NEAR(near_3, 3)

/* The difference of two positions that is nearest to 0. */
static double nearest(double d, double side)
{
    return d > 0.5 * side ? d - side : d < -0.5 * side ? d + side : d;
}

/* Copies the points of a cell, moved by what lies between the two cells. */
static void copy_cell(const struct grid *grid, struct candidates *to, size_t count, size_t cell,
                      const float moved[3])
{
    const uint32_t begin = grid->start[cell];
    const size_t n = grid->start[cell + 1] - begin;
    for (int a = 0; a < 3; a++) {
        const float *from = grid->place[a] + begin;
        float *x = to->x[a] + count;
        for (size_t k = 0; k < n; k++) x[k] = from[k] + moved[a];
    }
    memcpy(to->radius2 + count, grid->radius2 + begin, n * sizeof(float));
    for (size_t k = 0; k < n; k++) to->slot[count + k] = (int32_t)(begin + k);
}

struct region {
    struct look along[3];
    bool across, all; /* images matter; a pair's image must be found for each pair */
};

/* Gathers the candidates of the cell at c. Returns how many, in whole 64s the last of which never
 * match; SIZE_MAX: no memory. */
static size_t find_candidates(const struct grid *grid, const ptrdiff_t c[3],
                              const struct region *region, struct candidates *candidates)
{
    const struct look *l = region->along;
    const double scale = 1 / grid->unit;
    size_t count = 0;
    for (ptrdiff_t kz = 0; kz < l[2].count; kz++)
        for (ptrdiff_t ky = 0; ky < l[1].count; ky++) {
            const size_t row = cell_at(grid, (ptrdiff_t[3]){0, folded(grid, 1, l[1].from + ky),
                                                            folded(grid, 2, l[2].from + kz)});
            float moved[3] = {0, (float)((double)(l[1].from + ky - c[1]) * grid->size[1] * scale),
                              (float)((double)(l[2].from + kz - c[2]) * grid->size[2] * scale)};
            for (ptrdiff_t kx = 0; kx < l[0].count; kx++) {
                const size_t cell = row + (size_t)folded(grid, 0, l[0].from + kx);
                const size_t n = grid->start[cell + 1] - grid->start[cell];
                if (!reserve_candidates(candidates, count, n + 64)) return SIZE_MAX;
                moved[0] = (float)((double)(l[0].from + kx - c[0]) * grid->size[0] * scale);
                copy_cell(grid, candidates, count, cell, moved);
                count += n;
            }
        }
    const size_t whole = (count + 63) / 64 * 64;
    for (size_t k = count; k < whole; k++) {
        candidates->x[0][k] = 1e18f;
        candidates->x[1][k] = candidates->x[2][k] = 0;
        candidates->radius2[k] = 0;
        candidates->slot[k] = 0;
    }
    return whole;
}

/* In a box hardly wider than the radii: the nearest image pair by pair. */
static void near_images(const struct grid *grid, uint32_t s, size_t count,
                        const struct candidates *candidates, uint8_t *near)
{
    for (size_t k = 0; k < count; k++) {
        const bool filling = !(candidates->x[0][k] < 1e17f);
        const int32_t j = filling ? (int32_t)s : candidates->slot[k];
        double r2 = 0;
        for (int a = 0; a < grid->box.dim; a++) {
            double d = grid->position[j][a] - grid->position[s][a];
            if (grid->box.periodic[a]) d = nearest(d, grid->side[a]);
            r2 += d * d;
        }
        const double radius = fmax(grid->radius[s], grid->radius[j]) * grid->unit;
        near[k] = !filling && r2 < radius * radius;
    }
}

/* Slots of the marked candidates but s itself. Returns how many. */
static int32_t collect(const uint8_t *near, size_t count, const int32_t *slot, int32_t s,
                       int32_t *list)
{
    int32_t found = 0;
    for (size_t k = 0; k < count; k += 8) {
        uint64_t marks;
        memcpy(&marks, near + k, 8);
        while (marks) {
            const int32_t j = slot[k + (size_t)__builtin_ctzll(marks) / 8];
            marks &= marks - 1;
            list[found] = j;
            found += j != s;
        }
    }
    return found;
}

static int32_t find_plainly(int dim, const struct candidates *candidates, size_t count,
                            const float at[3], float radius2, int32_t s, int32_t *list)
{
    (dim == 2 ? near_2 : near_3)(count, at, radius2, candidates->x[0], candidates->x[1],
                                 candidates->x[2], candidates->radius2, candidates->near);
    return collect(candidates->near, count, candidates->slot, s, list);
}

#if SPHPROOF_CLONES && defined __x86_64__

/* The same list: lanes that match are moved together in a register. */
__attribute__((target("avx512f,popcnt"))) static int32_t
find_by_compressing(int dim, const struct candidates *candidates, size_t count, const float at[3],
                    float radius2, int32_t s, int32_t *list)
{
    const __m512 x0 = _mm512_set1_ps(at[0]), y0 = _mm512_set1_ps(at[1]), z0 = _mm512_set1_ps(at[2]),
                 own = _mm512_set1_ps(radius2);
    const __m512i self = _mm512_set1_epi32(s);
    int32_t found = 0;
    for (size_t k = 0; k < count; k += 16) {
        const __m512 dx = _mm512_sub_ps(_mm512_loadu_ps(candidates->x[0] + k), x0),
                     dy = _mm512_sub_ps(_mm512_loadu_ps(candidates->x[1] + k), y0);
        __m512 r2 = _mm512_add_ps(_mm512_mul_ps(dx, dx), _mm512_mul_ps(dy, dy));
        if (dim == 3) {
            const __m512 dz = _mm512_sub_ps(_mm512_loadu_ps(candidates->x[2] + k), z0);
            r2 = _mm512_add_ps(r2, _mm512_mul_ps(dz, dz));
        }
        const __m512 most = _mm512_max_ps(_mm512_loadu_ps(candidates->radius2 + k), own);
        const __m512i slot = _mm512_loadu_si512(candidates->slot + k);
        const __mmask16 near =
            _mm512_cmp_ps_mask(r2, most, _CMP_LT_OQ) & _mm512_cmpneq_epi32_mask(slot, self);
        _mm512_storeu_si512(list + found, _mm512_maskz_compress_epi32(near, slot));
        found += _mm_popcnt_u32(near);
    }
    return found;
}

static find_loop *find_choose(void)
{
    return __builtin_cpu_supports("avx512f") ? find_by_compressing : find_plainly;
}

#else

static find_loop *find_choose(void)
{
    return find_plainly;
}

#endif

struct grid *grid_create(const struct grid_box *box, size_t n, int threads)
{
    struct grid *grid = calloc(1, sizeof *grid);
    if (!grid) return NULL;
    grid->box = *box;
    grid->threads = threads;
    grid->find = find_choose();
    grid->pools = calloc((size_t)threads, sizeof *grid->pools);
    grid->candidates = calloc((size_t)threads, sizeof *grid->candidates);
    if (grid->pools && grid->candidates && reserve_points(grid, n)) return grid;
    grid_destroy(grid);
    return NULL;
}

static bool is_active(const struct grid *grid, uint32_t slot)
{
    const uint32_t point = grid->order[slot];
    return point < grid->active && !(grid->asleep && grid->asleep[point]);
}

/* The lists of a cell's points. Returns the longest one, -1: no memory. */
static int search_cell(struct grid *grid, const ptrdiff_t c[3], struct candidates *candidates,
                       struct pool *pool)
{
    const size_t cell = cell_at(grid, c);
    if (grid->start[cell] == grid->start[cell + 1]) return 0;
    struct region region = {0};
    for (int a = 0; a < 3; a++) {
        region.along[a] = look_along(grid, a, c[a], grid->reach[cell]);
        region.across |= region.along[a].across;
        region.all |= region.along[a].all;
    }
    bool any = false;
    for (uint32_t s = grid->start[cell]; s < grid->start[cell + 1]; s++) {
        grid->lists[s] = (struct grid_list){NULL, 0, region.across};
        any |= is_active(grid, s);
    }
    if (!any) return 0;
    const size_t count = find_candidates(grid, c, &region, candidates);
    if (count == SIZE_MAX) return -1;
    int longest = 0;
    for (uint32_t s = grid->start[cell]; s < grid->start[cell + 1]; s++) {
        struct grid_list *list = &grid->lists[s];
        if (!is_active(grid, s)) continue;
        int32_t *slots = pool_take(pool, count + BEYOND);
        if (!slots) return -1;
        list->slots = slots;
        if (region.all) {
            near_images(grid, s, count, candidates, candidates->near);
            list->count = collect(candidates->near, count, candidates->slot, (int32_t)s, slots);
        } else {
            const float at[3] = {grid->place[0][s], grid->place[1][s], grid->place[2][s]};
            list->count = grid->find(grid->box.dim, candidates, count, at, grid->radius2[s],
                                     (int32_t)s, slots);
        }
        int32_t end = list->count;
        while (end % GRID_LANES) slots[end++] = (int32_t)grid->n;
        pool->used += (size_t)end;
        if (end > longest) longest = end;
    }
    return longest;
}

static int thread_number(void)
{
#ifdef _OPENMP
    return omp_get_thread_num();
#else
    return 0;
#endif
}

static enum status make_lists(struct grid *grid, struct error *error)
{
    for (int t = 0; t < grid->threads; t++) grid->pools[t].used_chunks = grid->pools[t].used = 0;
    int longest = 0;
    bool enough = true;
#pragma omp parallel for num_threads(grid->threads) schedule(dynamic) reduction(max : longest) \
    reduction(&& : enough) if (grid->threads > 1)
    for (size_t p = 0; p < grid->parts; p++) {
        const int t = thread_number();
        for (size_t cell = grid->part_cell[p]; cell < grid->part_cell[p + 1]; cell++) {
            ptrdiff_t c[3];
            cell_coordinates(grid, cell, c);
            const int found = search_cell(grid, c, &grid->candidates[t], &grid->pools[t]);
            enough = enough && found >= 0;
            longest = found > longest ? found : longest;
        }
    }
    grid->longest = longest;
    return enough ? STATUS_OK : error_set(error, STATUS_ENVIRONMENT, "no memory for neighbours");
}

enum status grid_search(struct grid *grid, size_t n, size_t active, const double *const x[],
                        const double *radius, const unsigned char *asleep, struct error *error)
{
    if (n == 0 || n >= INT32_MAX)
        return error_set(error, STATUS_BAD_INPUT, "%zu particles: allowed are 1 to 2^31 - 2", n);
    if (!reserve_points(grid, n))
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu particles", n);
    enum status status = find_extent(grid, n, x, radius, error);
    if (!status) status = lay_cells(grid, n, radius, error);
    if (status) return status;
    grid->n = n;
    sort_points(grid, n, x, radius);
    find_reaches(grid);
    cut_parts(grid);
    grid->asleep = asleep;
    grid->active = active;
    return make_lists(grid, error);
}

/* Marks the cells within k cells along one axis of a marked one. */
static void spread(const struct grid *grid, int axis, ptrdiff_t k, const unsigned char *from,
                   unsigned char *to)
{
    ptrdiff_t c[3];
    for (c[2] = 0; c[2] < grid->cells[2]; c[2]++)
        for (c[1] = 0; c[1] < grid->cells[1]; c[1]++)
            for (c[0] = 0; c[0] < grid->cells[0]; c[0]++) {
                if (!from[cell_at(grid, c)]) continue;
                ptrdiff_t near[3] = {c[0], c[1], c[2]};
                const ptrdiff_t most = k < grid->cells[axis] ? k : grid->cells[axis] - 1;
                for (ptrdiff_t step = -most; step <= most; step++) {
                    near[axis] = c[axis] + step;
                    if (grid->box.periodic[axis])
                        near[axis] = folded(grid, axis, near[axis]);
                    else if (near[axis] < 0 || near[axis] >= grid->cells[axis])
                        continue;
                    to[cell_at(grid, near)] = 1;
                }
            }
}

void grid_wake(const struct grid *grid, const unsigned char *disturbed, int layers,
               unsigned char *asleep)
{
    float most = 0;
    unsigned char *from = grid->marks, *to = grid->marks + grid->cell_count;
    memset(from, 0, grid->cell_count);
    for (size_t cell = 0; cell < grid->cell_count; cell++) {
        most = grid->reach[cell] > most ? grid->reach[cell] : most;
        for (uint32_t s = grid->start[cell]; s < grid->start[cell + 1]; s++)
            if (grid->order[s] < grid->active && disturbed[grid->order[s]]) from[cell] = 1;
    }
    for (int a = 0; a < grid->box.dim; a++) {
        memset(to, 0, grid->cell_count);
        spread(grid, a, layers * cells_within(grid, a, most), from, to);
        unsigned char *const next = from;
        from = to;
        to = next;
    }
    for (size_t cell = 0; cell < grid->cell_count; cell++)
        for (uint32_t s = grid->start[cell]; from[cell] && s < grid->start[cell + 1]; s++)
            if (grid->order[s] < grid->active) asleep[grid->order[s]] = 0;
}

const uint32_t *grid_order(const struct grid *grid)
{
    return grid->order;
}

const double (*grid_positions(const struct grid *grid))[4]
{
    return (const double(*)[4])grid->position;
}

const struct grid_list *grid_lists(const struct grid *grid)
{
    return grid->lists;
}

double grid_side(const struct grid *grid, int axis)
{
    return axis < grid->box.dim && grid->box.periodic[axis] ? grid->side[axis] : 0;
}

int grid_longest(const struct grid *grid)
{
    return grid->longest;
}

size_t grid_parts(const struct grid *grid, const uint32_t **begin)
{
    *begin = grid->part_begin;
    return grid->parts;
}

double grid_bytes(size_t n, double neighbours, int dim)
{
    (void)dim;
    const double point = 2 * sizeof(uint32_t) + 4 * sizeof(double) + sizeof(float) +
                         sizeof(struct grid_list) + 2 * sizeof(uint32_t);
    return (double)n * (1.25 * point + (neighbours + 4) * sizeof(int32_t)) +
           2.0 * CELLS_A_POINT * (double)n;
}
