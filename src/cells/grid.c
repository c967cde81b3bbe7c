/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "grid_inside.h"
#include "pages.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void free_all(struct grid *grid)
{
    free(grid->cell_of);
    free(grid->order);
    free(grid->position);
    free(grid->radius2);
    for (int a = 0; a < 3; a++) free(grid->in_cell[a]);
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
    grid->cell_of = pages_allocate(capacity * sizeof *grid->cell_of);
    grid->order = pages_allocate(capacity * sizeof *grid->order);
    grid->position = pages_allocate(capacity * sizeof *grid->position);
    /* read in whole vectors, beyond the last point as well */
    bool floats = (grid->radius2 = calloc(capacity + COPIED, sizeof(float)));
    for (int a = 0; a < 3; a++)
        floats &= (grid->in_cell[a] = calloc(capacity + COPIED, sizeof(float))) != NULL;
    grid->lists = pages_allocate(capacity * sizeof *grid->lists);
    grid->part_begin = malloc(capacity * sizeof *grid->part_begin);
    grid->part_cell = malloc(capacity * sizeof *grid->part_cell);
    if (floats && grid->cell_of && grid->order && grid->position && grid->lists &&
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
        if (grid->candidates) free(grid->candidates[t].x[0]);
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
    free(grid->reached);
    free(grid->runs);
    free(grid);
}

/* --- cells ------------------------------------------------------------------------------------ */

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The cell size: the widest radius, if little less than that is needed by at least a quarter of the
 * points. If cells were slightly smaller than the radius of a few points, all points near these
 * would search 5^d cells instead of 3^d. If only few points have a much wider radius, the size
 * follows the others. */
static double usual_radius(size_t n, const double *radius)
{
    double sample[SAMPLE], widest = 0;
    const size_t count = n < SAMPLE ? n : SAMPLE;
    for (size_t i = 0; i < n; i++) widest = radius[i] > widest ? radius[i] : widest;
    size_t wide = 0;
    for (size_t k = 0; k < count; k++) {
        sample[k] = radius[k * n / count];
        wide += widest <= 1.2 * sample[k];
    }
    if (wide >= count - count * 3 / 4) return widest; /* the usual case, without sorting */
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

/* Chooses cells at least as large as the usual radius, and limits their number in relation to n. */
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
        grid->marks = malloc(4 * grid->cell_capacity);
        free(grid->reached);
        grid->reached = malloc(grid->cell_capacity * sizeof *grid->reached);
        grid->start = malloc(grid->cell_capacity * sizeof *grid->start);
        grid->widest = malloc(grid->cell_capacity * sizeof *grid->widest);
        grid->reach = malloc(grid->cell_capacity * sizeof *grid->reach);
        if (!grid->start || !grid->widest || !grid->reach || !grid->marks || !grid->reached)
            grid->cell_capacity = 0;
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

/* Wraps x into the box; round-off may give the upper edge, which is the lower one. */
static double wrapped(double x, double lo, double side)
{
    if (x >= lo && x < lo + side) return x; /* the usual case: no division, no call */
    const double y = x - side * floor((x - lo) / side);
    return y < lo + side ? y : lo;
}

/* Round-off of a distance in single precision, in units: positions are at most half a cell, shifted
 * by whole cells. It matters if cells are many radii large, as for points in a small part of a
 * periodic box: lists then hold more points than necessary, never fewer. */
static double rounding_of(const struct grid *grid)
{
    double largest = 0;
    for (int a = 0; a < grid->box.dim; a++) largest = fmax(largest, grid->size[a]);
    return 4e-7 * largest / grid->unit;
}

/* A counting sort; stable, so that points of a cell keep their order. */
static void sort_points(struct grid *grid, size_t n, const double *const x[])
{
    const int dim = grid->box.dim;
#pragma omp parallel for num_threads(grid->team) if (grid->team > 1)
    for (size_t i = 0; i < n; i++) {
        ptrdiff_t c[3] = {0};
        for (int a = 0; a < dim; a++) {
            const double at =
                grid->box.periodic[a] ? wrapped(x[a][i], grid->lo[a], grid->side[a]) : x[a][i];
            const ptrdiff_t k = (ptrdiff_t)((at - grid->lo[a]) * grid->cell_inverse[a]);
            c[a] = k < grid->cells[a] ? k : grid->cells[a] - 1;
        }
        grid->cell_of[i] = (uint32_t)grid_cell_at(grid, c);
    }
    memset(grid->start, 0, (grid->cell_count + 1) * sizeof *grid->start);
    for (size_t i = 0; i < n; i++) grid->start[grid->cell_of[i] + 1]++;
    for (size_t c = 0; c < grid->cell_count; c++) grid->start[c + 1] += grid->start[c];
    for (size_t i = 0; i < n; i++) grid->order[grid->start[grid->cell_of[i]]++] = (uint32_t)i;
    memmove(grid->start + 1, grid->start, grid->cell_count * sizeof *grid->start);
    grid->start[0] = 0;
}

/* Sets the positions and radii of the points by slot, and the widest radius of each cell. Single
 * precision is enough for the search because its origin is the middle of a cell. */
static void place_in_cells(struct grid *grid, const double *const x[], const double *radius)
{
    const int dim = grid->box.dim;
    const double scale = 1 / grid->unit, rounding = rounding_of(grid);
#pragma omp parallel for num_threads(grid->team) if (grid->team > 1)
    for (size_t cell = 0; cell < grid->cell_count; cell++) {
        ptrdiff_t c[3];
        double middle[3];
        float widest = grid->widest[cell] = 0;
        if (grid->start[cell] == grid->start[cell + 1]) continue;
        grid_cell_coordinates(grid, cell, c);
        for (int a = 0; a < 3; a++) middle[a] = grid->lo[a] + ((double)c[a] + 0.5) * grid->size[a];
        for (uint32_t s = grid->start[cell]; s < grid->start[cell + 1]; s++) {
            const size_t i = grid->order[s];
            for (int a = 0; a < 3; a++) {
                grid->position[s][a] = a >= dim ? 0
                                       : grid->box.periodic[a]
                                           ? wrapped(x[a][i], grid->lo[a], grid->side[a])
                                           : x[a][i];
                grid->in_cell[a][s] =
                    a < dim ? (float)((grid->position[s][a] - middle[a]) * scale) : 0;
            }
            const double units = radius[i] / grid->unit;
            const float reach = (float)fmax(units * (1 + 1e-5), units + rounding);
            grid->radius2[s] = reach * reach;
            widest = reach > widest ? reach : widest;
        }
        grid->widest[cell] = widest;
    }
}

/* Places the sentinel far from all points and their images. */
static void place_sentinel(struct grid *grid, size_t n, const double *radius)
{
    double far = 0;
    for (int a = 0; a < 3; a++) grid->position[n][a] = 0;
    for (int a = 0; a < grid->box.dim; a++) far = fmax(far, fabs(grid->lo[a]) + grid->side[a]);
    for (size_t i = 0; i < n; i++) far = radius[i] > far ? radius[i] : far;
    grid->position[n][0] = 64 * far;
}

/* Sets the reach of each cell: the largest radius among its own points and the points whose radius
 * extends into this cell. */
static void find_reaches(struct grid *grid)
{
    float least = INFINITY, most = 0;
    for (size_t c = 0; c < grid->cell_count; c++) {
        const float widest = grid->reach[c] = grid->widest[c];
        if (widest > 0 && widest < least) least = widest;
        most = widest > most ? widest : most;
    }
    bool same = true;
    for (int a = 0; a < 3; a++)
        same &= grid_cells_within(grid, a, least) == grid_cells_within(grid, a, most);
    for (int a = 0; a < 3; a++) grid->within[a] = same ? grid_cells_within(grid, a, most) : -1;
    if (same) {
        for (size_t c = 0; c < grid->cell_count; c++) grid->reach[c] = most;
        return;
    }
    for (ptrdiff_t z = 0; z < grid->cells[2]; z++)
        for (ptrdiff_t y = 0; y < grid->cells[1]; y++)
            for (ptrdiff_t x = 0; x < grid->cells[0]; x++) {
                const float widest = grid->widest[grid_cell_at(grid, (ptrdiff_t[3]){x, y, z})];
                const struct look lx = grid_look_along(grid, 0, x, widest),
                                  ly = grid_look_along(grid, 1, y, widest),
                                  lz = grid_look_along(grid, 2, z, widest);
                for (ptrdiff_t kz = 0; kz < lz.count; kz++)
                    for (ptrdiff_t ky = 0; ky < ly.count; ky++) {
                        const size_t row =
                            grid_cell_at(grid, (ptrdiff_t[3]){0, grid_folded(grid, 1, ly.from + ky),
                                                              grid_folded(grid, 2, lz.from + kz)});
                        for (ptrdiff_t kx = 0; kx < lx.count; kx++) {
                            float *reach =
                                &grid->reach[row + (size_t)grid_folded(grid, 0, lx.from + kx)];
                            *reach = widest > *reach ? widest : *reach;
                        }
                    }
            }
}

/* Cuts the slots into parts of whole cells with about PART points. */
static void cut_parts(struct grid *grid)
{
    size_t parts = 0;
    uint32_t begun = 0;
    grid->part_begin[0] = 0;
    grid->part_cell[0] = 0;
    for (size_t c = 0; c < grid->cell_count; c++) {
        const uint32_t end = grid->start[c + 1];
        if (end - begun < PART / 2 && c + 1 < grid->cell_count) continue;
        parts++;
        grid->part_begin[parts] = begun = end;
        grid->part_cell[parts] = (uint32_t)(c + 1);
    }
    grid->parts = parts;
}

struct grid *grid_create(const struct grid_box *box, size_t n, int threads)
{
    struct grid *grid = calloc(1, sizeof *grid);
    if (!grid) return NULL;
    grid->box = *box;
    grid->threads = grid->team = threads;
    grid->take = grid_take_choose();
    grid->find = grid_find_choose();
    grid->read = grid_read_choose();
    grid->pools = team_allocate(threads, sizeof *grid->pools);
    grid->candidates = team_allocate(threads, sizeof *grid->candidates);
    if (grid->pools && grid->candidates && reserve_points(grid, n)) return grid;
    grid_destroy(grid);
    return NULL;
}

void grid_team(struct grid *grid, int size)
{
    grid->team = size;
}

enum status grid_search(struct grid *grid, size_t n, size_t active, const double *const x[],
                        const double *radius, const unsigned char *flags, struct error *error)
{
    if (n == 0 || n >= INT32_MAX)
        return error_set(error, STATUS_BAD_INPUT, "%zu particles: allowed are 1 to 2^31 - 2", n);
    if (!reserve_points(grid, n))
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu particles", n);
    enum status status = find_extent(grid, n, x, radius, error);
    if (!status) status = lay_cells(grid, n, radius, error);
    if (status) return status;
    grid->n = n;
    sort_points(grid, n, x);
    place_in_cells(grid, x, radius);
    place_sentinel(grid, n, radius);
    find_reaches(grid);
    cut_parts(grid);
    grid->flags = flags;
    grid->active = active;
    return grid_make_lists(grid, error);
}

static bool any_asleep(const struct grid *grid, size_t cell, const unsigned char *asleep)
{
    for (uint32_t s = grid->start[cell]; s < grid->start[cell + 1]; s++)
        if (grid->order[s] >= grid->active || asleep[grid->order[s]]) return true;
    return false;
}

/* True if one of the cells that are searched for this cell's points is marked. */
static bool looks_at_mark(const struct grid *grid, size_t cell)
{
    ptrdiff_t c[3];
    struct look l[3];
    grid_cell_coordinates(grid, cell, c);
    for (int a = 0; a < 3; a++) l[a] = grid_look_along(grid, a, c[a], grid->reach[cell]);
    for (ptrdiff_t kz = 0; kz < l[2].count; kz++)
        for (ptrdiff_t ky = 0; ky < l[1].count; ky++) {
            const size_t row =
                grid_cell_at(grid, (ptrdiff_t[3]){0, grid_folded(grid, 1, l[1].from + ky),
                                                  grid_folded(grid, 2, l[2].from + kz)});
            for (ptrdiff_t kx = 0; kx < l[0].count; kx++)
                if (grid->marks[row + (size_t)grid_folded(grid, 0, l[0].from + kx)]) return true;
        }
    return false;
}

void grid_find_rim(struct grid *grid, const unsigned char *asleep)
{
    unsigned char *const rim = grid->marks + grid->cell_count;
    for (size_t cell = 0; cell < grid->cell_count; cell++)
        grid->marks[cell] = any_asleep(grid, cell, asleep);
    for (size_t cell = 0; cell < grid->cell_count; cell++) rim[cell] = looks_at_mark(grid, cell);
}

bool grid_in_rim(const struct grid *grid, size_t slot)
{
    return grid->marks[grid->cell_count + grid->cell_of[grid->order[slot]]];
}

const uint32_t *grid_order(const struct grid *grid)
{
    return grid->order;
}

const double (*grid_positions(const struct grid *grid))[3]
{
    return (const double(*)[3])grid->position;
}

const struct grid_list *grid_lists(const struct grid *grid)
{
    return grid->lists;
}

double grid_side(const struct grid *grid, int axis)
{
    return grid_wraps(grid, axis) ? grid->side[axis] : 0;
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

const struct grid_run *grid_runs(const struct grid *grid, size_t *count)
{
    *count = grid->run_count;
    return grid->runs;
}

double grid_bytes(int dim, double n, double neighbours)
{
    /* cell_of, order; position; radius2 and in_cell; lists */
    const double point =
        2 * sizeof(uint32_t) + 3 * sizeof(double) + 4 * sizeof(float) + sizeof(struct grid_list);
    /* 2D: lists end with half a vector of sentinels on average. 3D: a bit for each point within the
     * radius of a cell as wide, whose volume is 20.6 radii cubed (a ball has 4 pi/3), and for each
     * cell a bit for each point in its 3 x 3 x 3 cells. */
    const double list = dim == 2 ? (neighbours + 0.5 * GRID_LANES) * sizeof(int32_t)
                                 : (neighbours * 20.6 / 4.19 + COPIED + 27) / 8;
    return n * (point + list);
}
