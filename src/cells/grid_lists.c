/* SPDX-License-Identifier: GPL-3.0-or-later
 * The neighbour lists of a grid: the points of the surrounding cells are copied next to each other,
 * in single precision and relative to the cell, and tested together. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "grid_inside.h"
#include "pages.h"
#include "specialise.h"
#include "team.h"

static int32_t *pool_take(struct grid_pool *pool, size_t most)
{
    if (pool->used_chunks == 0 || pool->used + most > pool->sizes[pool->used_chunks - 1]) {
        while (pool->used_chunks < pool->count && pool->sizes[pool->used_chunks] < most)
            pool->used_chunks++;
        if (pool->used_chunks == pool->count) {
            /* the first chunk is small: most runs need no more */
            const size_t usual = pool->count > 0 ? CHUNK_NEXT : CHUNK,
                         size = most > usual ? most : usual;
            int32_t **chunks = realloc(pool->chunks, (pool->count + 1) * sizeof *chunks);
            if (!chunks) return NULL;
            pool->chunks = chunks;
            size_t *sizes = realloc(pool->sizes, (pool->count + 1) * sizeof *sizes);
            if (!sizes) return NULL;
            pool->sizes = sizes;
            pool->chunks[pool->count] = pages_allocate(size * sizeof **chunks);
            if (!pool->chunks[pool->count]) return NULL;
            pool->sizes[pool->count++] = size;
        }
        pool->used_chunks++;
        pool->used = 0;
    }
    return pool->chunks[pool->used_chunks - 1] + pool->used;
}

/* Ensures capacity for n more candidates and their marks; keeps the first `count`. */
static bool reserve_candidates(struct candidates *candidates, size_t count, size_t n)
{
    if (count + n <= candidates->capacity) return true;
    const size_t capacity = (2 * (count + n) + 127) / 64 * 64;
    float *next = aligned_alloc(64, capacity * (5 * sizeof(float) + sizeof(int32_t)));
    if (!next) return false;
    struct candidates grown = {.capacity = capacity};
    for (int a = 0; a < 3; a++, next += capacity) grown.x[a] = next;
    grown.radius2 = next;
    grown.slots = (int32_t *)(void *)(next += capacity);
    grown.marks = (uint16_t *)(void *)(next += capacity);
    grown.near = (uint8_t *)(void *)(next + capacity / 2);
    for (int a = 0; a < 3 && count; a++)
        memcpy(grown.x[a], candidates->x[a], count * sizeof(float));
    if (count) {
        memcpy(grown.radius2, candidates->radius2, count * sizeof(float));
        memcpy(grown.marks, candidates->marks, (count / 16 + 1) * sizeof *grown.marks);
    }
    free(candidates->x[0]);
    *candidates = grown;
    return true;
}

/* Appends all points of a cell, in whole vectors; the next cell overwrites the excess. */
CLONES static size_t take_all(const struct grid *grid, size_t cell, const float moved[3],
                              struct candidates *to, size_t count)
{
    const size_t first = grid->start[cell], n = grid->start[cell + 1] - first;
    const int dim = grid->box.dim;
    for (size_t begin = 0; begin < n; begin += COPIED) {
        for (int a = 0; a < dim; a++) {
            const float *restrict in_cell = grid->in_cell[a] + first + begin, along = moved[a];
            float *restrict x = to->x[a] + count + begin;
#pragma omp simd
            for (int k = 0; k < COPIED; k++) x[k] = in_cell[k] + along;
        }
        memcpy(to->radius2 + count + begin, grid->radius2 + first + begin, COPIED * sizeof(float));
    }
    return count + n;
}

/* Fills the last group of 16 with candidates that are near no point. Returns the total number. */
static size_t fill_up(const struct candidates *candidates, size_t count)
{
    const size_t whole = (count + COPIED - 1) / COPIED * COPIED;
    for (size_t k = count; k < whole; k++) {
        candidates->x[0][k] = 1e18f;
        candidates->x[1][k] = candidates->x[2][k] = 0;
        candidates->radius2[k] = 0;
    }
    return whole;
}

struct region {
    struct look along[3];
    bool across, all; /* the region crosses a periodic edge; each pair needs its nearest image */
    bool few;         /* skip cells without listed points */
};

/* The cells to be searched for the points of the cell at c. */
static struct region find_region(const struct grid *grid, const ptrdiff_t c[3], size_t cell)
{
    struct region region = {.few = grid->flags && !grid->listed[cell]};
    for (int a = 0; a < 3; a++) {
        region.along[a] = grid_look_along(grid, a, c[a], grid->reach[cell]);
        region.across |= region.along[a].across;
        region.all |= region.along[a].all;
    }
    return region;
}

/* Gathers the candidates of the cell at c: all points of the surrounding cells, or, unless `around`
 * is NULL, those that may be near it, with a mark for each point in the order of find_slots. own:
 * index of the cell's own first point among them. Returns their number, a multiple of 16 with
 * fillings; SIZE_MAX: no memory. */
static size_t find_candidates(const struct grid *grid, const ptrdiff_t c[3],
                              const struct region *region, const struct surroundings *around,
                              struct candidates *candidates, size_t *own)
{
    const struct look *l = region->along;
    const double scale = 1 / grid->unit;
    const size_t at = grid_cell_at(grid, c);
    size_t count = 0, seen = 0;
    for (ptrdiff_t kz = 0; kz < l[2].count; kz++)
        for (ptrdiff_t ky = 0; ky < l[1].count; ky++) {
            const size_t row =
                grid_cell_at(grid, (ptrdiff_t[3]){0, grid_folded(grid, 1, l[1].from + ky),
                                                  grid_folded(grid, 2, l[2].from + kz)});
            float moved[3] = {0, (float)((double)(l[1].from + ky - c[1]) * grid->size[1] * scale),
                              (float)((double)(l[2].from + kz - c[2]) * grid->size[2] * scale)};
            for (ptrdiff_t kx = 0; kx < l[0].count; kx++) {
                const size_t cell = row + (size_t)grid_folded(grid, 0, l[0].from + kx);
                const size_t n = grid->start[cell + 1] - grid->start[cell];
                if (region->few && !grid->listed[cell]) continue;
                if (!reserve_candidates(candidates, seen, n + 64)) return SIZE_MAX;
                moved[0] = (float)((double)(l[0].from + kx - c[0]) * grid->size[0] * scale);
                if (cell == at) *own = count;
                count = around ? grid->take(grid, cell, moved, around, candidates, count, seen)
                               : take_all(grid, cell, moved, candidates, count);
                seen += n;
            }
        }
    candidates->seen = seen;
    return fill_up(candidates, count);
}

/* Writes n consecutive numbers from first on, in whole vectors. */
CLONES static void count_up(size_t n, int32_t first, int32_t *restrict to)
{
    for (size_t from = 0; from < n; from += COPIED)
#pragma omp simd
        for (int k = 0; k < COPIED; k++) to[from + (size_t)k] = first + (int32_t)from + k;
}

/* For a cell that is not empty. */
static struct surroundings find_surroundings(const struct grid *grid, size_t cell, bool images)
{
    const uint32_t begin = grid->start[cell];
    struct surroundings around = {.radius2 = grid->radius2[begin], .images = images};
    float *lo = around.lo, *hi = around.hi;
    for (int a = 0; a < 3; a++) {
        lo[a] = hi[a] = grid->in_cell[a][begin];
        around.side[a] =
            images && grid_wraps(grid, a) ? (float)(grid->side[a] / grid->unit) : HUGE_VALF;
    }
    if (grid->box.dim == 2) return around; /* in 2D all points around a cell are candidates */
    for (uint32_t s = begin; s < grid->start[cell + 1]; s++) {
        for (int a = 0; a < 3; a++) {
            lo[a] = grid->in_cell[a][s] < lo[a] ? grid->in_cell[a][s] : lo[a];
            hi[a] = grid->in_cell[a][s] > hi[a] ? grid->in_cell[a][s] : hi[a];
        }
        around.radius2 = grid->radius2[s] > around.radius2 ? grid->radius2[s] : around.radius2;
    }
    return around;
}

/* The slots of the candidates, in the same order; slots has space for COPIED more. Returns their
 * number. */
static size_t find_slots(const struct grid *grid, const struct region *region, int32_t *slots)
{
    const struct look *l = region->along;
    /* cells of a row, and so their slots, are numbered consecutively */
    const bool runs = !region->few && l[0].from >= 0 && l[0].from + l[0].count <= grid->cells[0];
    const ptrdiff_t cells = runs ? l[0].count : 1;
    size_t count = 0;
    for (ptrdiff_t kz = 0; kz < l[2].count; kz++)
        for (ptrdiff_t ky = 0; ky < l[1].count; ky++) {
            const size_t row =
                grid_cell_at(grid, (ptrdiff_t[3]){0, grid_folded(grid, 1, l[1].from + ky),
                                                  grid_folded(grid, 2, l[2].from + kz)});
            for (ptrdiff_t kx = 0; kx < l[0].count; kx += cells) {
                const size_t cell = row + (size_t)grid_folded(grid, 0, l[0].from + kx);
                const uint32_t begin = grid->start[cell], end = grid->start[cell + (size_t)cells];
                if (region->few && !grid->listed[cell]) continue;
                count_up(end - begin, (int32_t)begin, slots + count);
                count += end - begin;
            }
        }
    return count;
}

/* True if the slot gets a list. beside: a listed point may be near. */
static bool is_listed(const struct grid *grid, uint32_t slot, bool beside)
{
    const uint32_t point = grid->order[slot];
    if (point >= grid->active) return false;
    const unsigned char flag = grid->flags ? grid->flags[point] : GRID_LISTED;
    return flag == GRID_LISTED || (beside && flag == GRID_BESIDE);
}

/* Marks the cells with listed points, and the cells that are searched for these. Points beyond the
 * active ones are images, which count as listed because only the caller knows their particles. */
static void mark_cells(struct grid *grid)
{
    unsigned char *listed = grid->listed = grid->marks + 2 * grid->cell_capacity;
    unsigned char *seen = grid->seen = grid->marks + 3 * grid->cell_capacity;
    memset(seen, grid->flags == NULL, grid->cell_count);
    memset(listed, grid->flags == NULL, grid->cell_count);
    for (size_t cell = 0; grid->flags && cell < grid->cell_count; cell++) {
        for (uint32_t s = grid->start[cell]; s < grid->start[cell + 1]; s++)
            listed[cell] |=
                grid->order[s] >= grid->active || grid->flags[grid->order[s]] == GRID_LISTED;
        if (!listed[cell]) continue;
        ptrdiff_t c[3];
        grid_cell_coordinates(grid, cell, c);
        const struct region region = find_region(grid, c, cell);
        const struct look *l = region.along;
        for (ptrdiff_t kz = 0; kz < l[2].count; kz++)
            for (ptrdiff_t ky = 0; ky < l[1].count; ky++) {
                const size_t row =
                    grid_cell_at(grid, (ptrdiff_t[3]){0, grid_folded(grid, 1, l[1].from + ky),
                                                      grid_folded(grid, 2, l[2].from + kz)});
                for (ptrdiff_t kx = 0; kx < l[0].count; kx++)
                    seen[row + (size_t)grid_folded(grid, 0, l[0].from + kx)] = 1;
            }
    }
}

/* Collects the slots of `seen` cells in runs. */
static bool find_runs(struct grid *grid)
{
    const unsigned char *seen = grid->seen;
    const size_t most = grid->n / PART + grid->cell_count + 1;
    if (most > grid->run_capacity) {
        free(grid->runs);
        grid->run_capacity = 2 * most;
        grid->runs = malloc(grid->run_capacity * sizeof *grid->runs);
        if (!grid->runs) grid->run_capacity = 0;
        if (!grid->runs) return false;
    }
    struct grid_run *last = NULL;
    grid->run_count = 0;
    for (size_t cell = 0; cell < grid->cell_count; cell++) {
        const uint32_t begin = grid->start[cell], end = grid->start[cell + 1];
        if (!seen[cell] || begin == end) continue;
        if (last && last->end == begin && end - last->begin <= PART) {
            last->end = end;
            continue;
        }
        last = &grid->runs[grid->run_count++];
        *last = (struct grid_run){begin, end};
    }
    return true;
}

/* Prefetches the memory of the next lists, so that vector stores do not wait for it. */
static void fetch(const int32_t *words, size_t count)
{
    for (size_t k = 0; k < count; k += 16) __builtin_prefetch(words + k, 1);
}

/* Writes the slots of the marked candidates, then sentinels up to whole vectors. */
static void read_list(const struct grid *grid, const int32_t *candidates, const uint16_t *marks,
                      size_t count, int32_t *list)
{
    const int32_t end = grid->read(candidates, marks, count, list);
    for (int k = 0; k < GRID_LANES; k++) list[end + k] = (int32_t)grid->n;
}

/* Makes the lists of a cell's points. Returns the longest length, or -1: no memory. */
static int search_cell(struct grid *grid, const ptrdiff_t c[3], struct candidates *candidates,
                       struct grid_pool *pool)
{
    const size_t cell = grid_cell_at(grid, c);
    if (grid->start[cell] == grid->start[cell + 1]) return 0;
    const struct region region = find_region(grid, c, cell);
    const bool marked = grid->box.dim == 3;
    const bool beside = grid->seen[cell];
    bool any = false;
    for (uint32_t s = grid->start[cell]; s < grid->start[cell + 1]; s++) {
        grid->lists[s] = (struct grid_list){NULL, 0, region.across, marked};
        any |= is_listed(grid, s, beside);
    }
    if (!any) return 0;
    size_t own = SIZE_MAX; /* own points are not candidates */
    const struct surroundings around = find_surroundings(grid, cell, region.all);
    const size_t count =
        find_candidates(grid, c, &region, marked ? &around : NULL, candidates, &own);
    if (count == SIZE_MAX) return -1;
    if (candidates->seen > candidates->most) candidates->most = candidates->seen;
    if (!marked) {
        find_slots(grid, &region, candidates->slots);
    } else {
        const size_t words = (candidates->seen + 31) / 32;
        int32_t *marks = pool_take(pool, words);
        if (!marks) return -1;
        pool->used += words;
        grid->reached[cell] = memcpy(marks, candidates->marks, words * sizeof *marks);
    }
    int longest = 0;
    for (uint32_t s = grid->start[cell]; s < grid->start[cell + 1]; s++) {
        struct grid_list *list = &grid->lists[s];
        if (!is_listed(grid, s, beside)) continue;
        int32_t *kept = pool_take(pool, marked ? (count + 31) / 32 : count + BEYOND);
        if (!kept) return -1;
        uint16_t *marks = marked ? (uint16_t *)(void *)kept : candidates->marks;
        const float at[3] = {grid->in_cell[0][s], grid->in_cell[1][s], grid->in_cell[2][s]};
        list->count = grid->find(grid->box.dim, candidates, count, at, grid->radius2[s],
                                 around.images ? around.side : NULL, marks);
        if (own != SIZE_MAX) {
            const size_t at_own = own + (s - grid->start[cell]);
            const uint16_t self = (uint16_t)(1u << at_own % 16);
            list->count -= (marks[at_own / 16] & self) != 0;
            marks[at_own / 16] &= (uint16_t)~self;
        }
        list->kept = kept;
        size_t words = (count + 31) / 32;
        if (!marked) {
            read_list(grid, candidates->slots, marks, count, kept);
            words = ((size_t)list->count + GRID_LANES - 1) / GRID_LANES * GRID_LANES;
            fetch(kept + words + AHEAD, words);
        }
        pool->used += words;
        if (list->count > longest) longest = list->count;
    }
    return longest;
}

enum status grid_make_lists(struct grid *grid, struct error *error)
{
    for (int t = 0; t < grid->threads; t++) {
        grid->pools[t].used_chunks = grid->pools[t].used = 0;
        grid->candidates[t].most = 0;
    }
    grid->candidates_most = 0;
    mark_cells(grid);
    if (!find_runs(grid)) return error_set(error, STATUS_ENVIRONMENT, "no memory for neighbours");
    int longest = 0;
    bool enough = true;
    struct team_shares shares;
    team_share(&shares, grid->team, grid->parts);
#pragma omp parallel num_threads(grid->team) reduction(max : longest) reduction(&& : enough) \
    if (grid->team > 1)
    for (size_t p; team_next(&shares, &p);) {
        const int t = team_thread();
        for (size_t cell = grid->part_cell[p]; cell < grid->part_cell[p + 1]; cell++) {
            ptrdiff_t c[3];
            grid_cell_coordinates(grid, cell, c);
            const int found = search_cell(grid, c, &grid->candidates[t], &grid->pools[t]);
            enough = enough && found >= 0;
            longest = found > longest ? found : longest;
        }
    }
    grid->longest = (longest + GRID_LANES - 1) / GRID_LANES * GRID_LANES;
    for (int t = 0; t < grid->threads; t++)
        if (grid->candidates[t].most > grid->candidates_most)
            grid->candidates_most = grid->candidates[t].most;
    return enough ? STATUS_OK : error_set(error, STATUS_ENVIRONMENT, "no memory for neighbours");
}

/* --- reading ---------------------------------------------------------------------------------- */

bool grid_reader_reserve(const struct grid *grid, struct grid_reader *reader)
{
    const size_t candidates = grid->candidates_most + COPIED,
                 longest = (size_t)grid->longest + BEYOND;
    reader->begin = reader->end = 0;
    reader->slot = SIZE_MAX;
    if (candidates > reader->capacity) {
        free(reader->candidates);
        reader->capacity = candidates + candidates / 2;
        reader->candidates = malloc(reader->capacity * sizeof *reader->candidates);
        if (!reader->candidates) reader->capacity = 0;
    }
    if (longest > reader->longest) {
        free(reader->slots);
        reader->longest = longest + longest / 2;
        reader->slots = malloc(reader->longest * sizeof *reader->slots);
        if (!reader->slots) reader->longest = 0;
    }
    return reader->candidates && reader->slots;
}

void grid_reader_free(struct grid_reader *reader)
{
    free(reader->candidates);
    free(reader->slots);
    *reader = (struct grid_reader){0};
}

/* Loads the candidates of a slot's cell, which is usually the next one along x. */
static void enter_cell(const struct grid *grid, struct grid_reader *reader, size_t slot)
{
    size_t cell = reader->cell + 1;
    if (slot == reader->end && slot > 0 && ++reader->at[0] < grid->cells[0] &&
        grid->start[cell + 1] > slot) {
        reader->cell = cell;
    } else {
        reader->cell = cell = grid->cell_of[grid->order[slot]];
        grid_cell_coordinates(grid, cell, reader->at);
    }
    const struct region region = find_region(grid, reader->at, cell);
    reader->count = find_slots(grid, &region, reader->candidates);
    reader->count = (size_t)grid->read(reader->candidates, grid->reached[cell], reader->count,
                                       reader->candidates);
    reader->begin = grid->start[cell];
    reader->end = grid->start[cell + 1];
}

const int32_t *grid_read(const struct grid *grid, struct grid_reader *reader, size_t slot)
{
    if (slot == reader->slot) return reader->slots;
    if (slot < reader->begin || slot >= reader->end) enter_cell(grid, reader, slot);
    read_list(grid, reader->candidates, grid->lists[slot].kept, reader->count, reader->slots);
    reader->slot = slot;
    return reader->slots;
}
