/* SPDX-License-Identifier: GPL-3.0-or-later
 * Inside of a grid, on setups drawn at random: its cells, their order in memory, how far they are
 * looked through, parts, lists with their order, and who is woken, each once more in plain loops.
 */
#include "test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cells/grid_inside.h"
#include "draw.h"
#include "near.h"

enum { POINTS_MAX = 3000 };

static struct setup {
    struct grid_box box;
    size_t n, active;
    double x[3][POINTS_MAX], radius[POINTS_MAX];
    unsigned char asleep[POINTS_MAX];
} setup;

/* Beyond the last point nothing is anybody's. */
static void end_setup(void)
{
    for (size_t i = setup.n; i < POINTS_MAX; i++) {
        setup.radius[i] = 1e30;
        for (int a = 0; a < 3; a++) setup.x[a][i] = i % 2 ? (double)NAN : a % 2 ? 1e9 : -1e9;
    }
}

/* Boxes of any shape; wide and narrow radii; some points in one place or in one plane. */
static void make(int trial)
{
    struct setup *s = &setup;
    memset(s, 0, sizeof *s);
    s->box.dim = 2 + trial % 2;
    s->n = 1 + draw_bits() % (trial % 5 ? 700 : POINTS_MAX - 1);
    const double unit = trial % 7 == 6 ? 1e-6 : 1, wide = trial % 3 ? 1 : draw(1, 4);
    double least = HUGE_VAL;
    for (int a = 0; a < s->box.dim; a++) {
        const double side = unit * draw(1, trial % 4 ? 2 : 9);
        s->box.periodic[a] = draw(0, 1) < 0.6;
        s->box.lo[a] = unit * draw(-5, 5);
        s->box.hi[a] = s->box.lo[a] + side;
        least = fmin(least, side);
        const bool flat = draw(0, 1) < 0.1 && !s->box.periodic[a];
        for (size_t i = 0; i < s->n; i++)
            s->x[a][i] = s->box.lo[a] + side * (flat ? 0.3 : draw(0, 1)) +
                         (s->box.periodic[a] ? side * ((double)(draw_bits() % 3) - 1) : 0);
    }
    const double radius = least * draw(0.03, 0.49) / wide;
    for (size_t i = 0; i < s->n; i++) {
        s->radius[i] = radius * draw(0.8, 1) * (draw(0, 1) < 0.1 ? wide : 1);
        s->asleep[i] = draw(0, 1) < 0.3;
    }
    end_setup();
    s->active = trial % 4 ? s->n : 1 + draw_bits() % s->n;
}

static struct grid *search(int trial, int threads)
{
    struct error error;
    const double *const x[] = {setup.x[0], setup.x[1], setup.x[2]};
    struct grid *grid = grid_create(&setup.box, trial % 2 ? setup.n : setup.n / 3, threads);
    assert_non_null(grid);
    if (grid_search(grid, setup.n, setup.active, x, setup.radius, trial % 3 ? NULL : setup.asleep,
                    &error))
        fail_msg("%s", error.message);
    return grid;
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* As many cells as the widest radius allows or, where it is more than 1.2 times as wide as three of
 * four, as these do; no more than two a point and 64, of one shape each way; an open box has the
 * extent of its points. */
static void check_cells(const struct grid *grid)
{
    double sample[POINTS_MAX];
    const size_t count = setup.n < 1000 ? setup.n : 1000;
    for (size_t k = 0; k < count; k++) sample[k] = setup.radius[k * setup.n / count];
    qsort(sample, count, sizeof *sample, compare_doubles);
    double widest = 0, cells = 0;
    for (size_t i = 0; i < setup.n; i++) widest = fmax(widest, setup.radius[i]);
    const double usual = sample[count * 3 / 4];
    double size = (widest <= 1.2 * usual ? widest : usual) * (1 + 1e-5);
    assert_true(grid->unit == size);
    for (;; size *= 1.3) {
        cells = 1;
        for (int a = 0; a < grid->box.dim; a++) {
            const double k = floor(grid->side[a] / size);
            cells *= k > 1 ? k : 1;
        }
        if (cells <= 2 * (double)setup.n + 64) break;
    }
    assert_true((double)grid->cell_count == cells);
    for (int a = 0; a < 3; a++) {
        double lo = HUGE_VAL, hi = -HUGE_VAL;
        for (size_t i = 0; i < setup.n; i++)
            lo = fmin(lo, setup.x[a][i]), hi = fmax(hi, setup.x[a][i]);
        const bool periodic = setup.box.periodic[a];
        if (a >= grid->box.dim) {
            assert_int_equal(grid->cells[a], 1);
            assert_true(grid->size[a] == 0 && grid->cell_inverse[a] == 0);
            assert_true(!grid_wraps(grid, a) && grid_side(grid, a) == 0);
            continue;
        }
        assert_true(grid->lo[a] == (periodic ? setup.box.lo[a] : lo));
        assert_true(grid->side[a] == (periodic ? setup.box.hi[a] - setup.box.lo[a] : hi - lo));
        assert_true(grid_wraps(grid, a) == periodic);
        assert_true(grid_side(grid, a) == (periodic ? grid->side[a] : 0));
        const double k = floor(grid->side[a] / size);
        assert_true((double)grid->cells[a] == (k > 1 ? k : 1));
        assert_true(grid->size[a] == grid->side[a] / (double)grid->cells[a]);
        assert_true(grid->cell_inverse[a] == (grid->size[a] > 0 ? 1 / grid->size[a] : 0));
    }
}

/* Columns of cells in tiles of 8 x 8, cells along x; numbers of cells there and back. */
static void check_order_of_cells(const struct grid *grid)
{
    ptrdiff_t last[4] = {-1, 0, 0, 0};
    for (size_t cell = 0; cell < grid->cell_count; cell++) {
        ptrdiff_t c[3];
        grid_cell_coordinates(grid, cell, c);
        for (int a = 0; a < 3; a++) assert_true(c[a] >= 0 && c[a] < grid->cells[a]);
        assert_int_equal(grid_cell_at(grid, c), cell);
        if (c[0] > 0) continue;
        const ptrdiff_t key[4] = {c[2] / 8, c[1] / 8, c[2], c[1]};
        int differs = 0;
        while (cell > 0 && differs < 3 && key[differs] == last[differs]) differs++;
        if (cell > 0) assert_true(key[differs] > last[differs]);
        memcpy(last, key, sizeof last);
    }
}

/* The search radius of a slot, in units, a little more. */
static float reach_of(const struct grid *grid, size_t slot)
{
    return (float)(setup.radius[grid->order[slot]] / grid->unit * (1 + 1e-5));
}

/* Every point once, in its cell, where it came before others with higher numbers. */
static void check_points(const struct grid *grid)
{
    char met[POINTS_MAX] = {0};
    const uint32_t *order = grid_order(grid);
    const double(*at)[3] = grid_positions(grid);
    assert_int_equal(grid->start[0], 0);
    assert_int_equal(grid->start[grid->cell_count], setup.n);
    double far = 0;
    for (size_t cell = 0; cell < grid->cell_count; cell++) {
        ptrdiff_t c[3];
        grid_cell_coordinates(grid, cell, c);
        assert_true(grid->start[cell] <= grid->start[cell + 1]);
        for (uint32_t s = grid->start[cell]; s < grid->start[cell + 1]; s++) {
            const uint32_t i = order[s];
            assert_false(met[i]++);
            assert_int_equal(grid->cell_of[i], cell);
            if (s > grid->start[cell]) assert_true(order[s - 1] < i);
            for (int a = 0; a < 3; a++) {
                if (a >= grid->box.dim) {
                    assert_true(at[s][a] == 0 && grid->place[a][s] == 0);
                    continue;
                }
                const double k = (at[s][a] - grid->lo[a]) * grid->cell_inverse[a];
                assert_true(c[a] == (ptrdiff_t)k ||
                            (c[a] == grid->cells[a] - 1 && (double)c[a] < k));
                const double middle = grid->lo[a] + ((double)c[a] + 0.5) * grid->size[a];
                near_below(fabs((at[s][a] - middle) / grid->unit - (double)grid->place[a][s]),
                           1e-7 * fmax(1, grid->size[a] / grid->unit));
                if (!grid->box.periodic[a]) assert_true(at[s][a] == setup.x[a][i]);
                assert_true(at[s][a] >= grid->lo[a] &&
                            (at[s][a] < grid->lo[a] + grid->side[a] || !grid->box.periodic[a]));
                const double turns = (setup.x[a][i] - at[s][a]) / fmax(grid->side[a], 1e-300);
                near_below(fabs(turns - round(turns)), 1e-14);
            }
            const float reach = reach_of(grid, s);
            assert_true(grid->radius2[s] == reach * reach);
        }
    }
    /* the sentinel is further away than anybody sees, also by way of images */
    for (int a = 0; a < grid->box.dim; a++) far = fmax(far, fabs(grid->lo[a]) + grid->side[a]);
    for (size_t i = 0; i < setup.n; i++) far = fmax(far, setup.radius[i]);
    assert_true(at[setup.n][0] == 64 * far);
    for (int a = 1; a < 3; a++) assert_true(at[setup.n][a] == 0);
}

/* Cells that lie within a radius, in units, of any point of a cell, along one axis. */
static bool is_near(const struct grid *grid, int a, ptrdiff_t from, ptrdiff_t to, double radius)
{
    ptrdiff_t apart = from < to ? to - from : from - to;
    if (grid_wraps(grid, a) && grid->cells[a] - apart < apart) apart = grid->cells[a] - apart;
    return (double)apart * grid->size[a] < (radius + 1e-12) * grid->unit + grid->size[a] ||
           apart == 0;
}

static bool cells_are_near(const struct grid *grid, size_t one, size_t other, double radius)
{
    ptrdiff_t c[3], d[3];
    grid_cell_coordinates(grid, one, c);
    grid_cell_coordinates(grid, other, d);
    for (int a = 0; a < grid->box.dim; a++)
        if (!is_near(grid, a, c[a], d[a], radius)) return false;
    return true;
}

/* No more than the widest point needs, no less than any point of the cell or its surroundings. */
static void check_reaches(const struct grid *grid)
{
    float most = 0, least = INFINITY;
    for (size_t cell = 0; cell < grid->cell_count; cell++) {
        float widest = 0;
        for (uint32_t s = grid->start[cell]; s < grid->start[cell + 1]; s++)
            widest = fmaxf(widest, reach_of(grid, s));
        assert_true(grid->widest[cell] == widest);
        most = fmaxf(most, widest);
        if (widest > 0) least = fminf(least, widest);
    }
    bool same = true;
    for (int a = 0; a < grid->box.dim; a++)
        same = same && grid_cells_within(grid, a, least) == grid_cells_within(grid, a, most);
    for (int a = 0; a < 3; a++)
        assert_int_equal(grid->within[a], same ? grid_cells_within(grid, a, most) : -1);
    for (size_t cell = 0; cell < grid->cell_count; cell++) {
        float reach = grid->widest[cell];
        for (size_t other = 0; other < grid->cell_count; other++)
            if (grid->widest[other] > reach &&
                cells_are_near(grid, cell, other, grid->widest[other]))
                reach = grid->widest[other];
        assert_true(grid->reach[cell] == (same ? most : reach));
    }
}

/* How many cells a radius covers; where the look through them begins, and whether it meets an edge
 * of the box or itself. */
static void check_looks(const struct grid *grid)
{
    for (int a = 0; a < 3; a++)
        for (int k = 0; k < 12; k++) {
            const double radius = k == 11 ? 1e9 : draw(0.01, 4),
                         wide = grid->size[a] > 0 ? radius * grid->unit / grid->size[a] : 0;
            const ptrdiff_t cells = grid->cells[a];
            ptrdiff_t within = grid_cells_within(grid, a, radius);
            assert_true(within <= cells);
            if (within < cells)
                assert_true((double)within >= wide * (1 - 1e-14) &&
                            (double)within - 1 < wide * (1 + 1e-14) + (wide == 0));
            else
                assert_true(wide > (double)cells - 1 - 1e-12);
            const ptrdiff_t at = (ptrdiff_t)(draw_bits() % (uint64_t)cells);
            const struct look look = grid_look_along(grid, a, at, radius);
            if (grid->within[a] >= 0) within = grid->within[a]; /* all reaches cover as many */
            if (!grid_wraps(grid, a)) {
                assert_false(look.across || look.all);
                assert_int_equal(look.from, at > within ? at - within : 0);
                assert_int_equal(look.from + look.count,
                                 at + within < cells ? at + within + 1 : cells);
                continue;
            }
            assert_true(look.all == (2 * within + 1 > cells));
            assert_true(look.across == (look.all || at < within || at + within >= cells));
            assert_int_equal(look.from, look.all ? 0 : at - within);
            assert_int_equal(look.count, look.all ? cells : 2 * within + 1);
            for (ptrdiff_t c = -cells; c < 2 * cells; c++)
                assert_int_equal(grid_folded(grid, a, c), (c + cells) % cells);
        }
}

/* Whole cells that hold 128 points, as few as can be; the last one what is left. */
static void check_parts(const struct grid *grid)
{
    const uint32_t *begin;
    const size_t parts = grid_parts(grid, &begin);
    assert_true(parts > 0 && begin[0] == 0 && begin[parts] == setup.n);
    assert_int_equal(grid->part_cell[0], 0);
    assert_int_equal(grid->part_cell[parts], grid->cell_count);
    for (size_t p = 0; p < parts; p++) {
        const uint32_t end = grid->part_cell[p + 1];
        assert_int_equal(begin[p + 1], grid->start[end]);
        if (p + 1 < parts) assert_true(begin[p + 1] - begin[p] >= 128);
        assert_true(grid->start[end - 1] - begin[p] < 128);
    }
}

static float nearest_image(float d, float side)
{
    const float half = 0.5f * side;
    return d > half ? d - side : d < -half ? d + side : d;
}

/* In single precision, cell by cell around: the same slots in the same order. Returns their number.
 */
static size_t check_lists(const struct grid *grid)
{
    const double scale = 1 / grid->unit;
    size_t compared = 0;
    int longest = 0;
    struct grid_reader reader = {0};
    assert_true(grid_reader_reserve(grid, &reader));
    for (size_t s = 0; s < setup.n; s++) {
        ptrdiff_t c[3];
        struct look look[3];
        bool across = false, all = false;
        const struct grid_list *list = &grid_lists(grid)[s];
        const uint32_t i = grid->order[s];
        const size_t cell = grid->cell_of[i];
        grid_cell_coordinates(grid, cell, c);
        for (int a = 0; a < 3; a++) {
            look[a] = grid_look_along(grid, a, c[a], grid->reach[cell]);
            across |= look[a].across, all |= look[a].all;
        }
        assert_true(list->wrapped == across);
        if (i >= setup.active || (grid->flags && setup.asleep[i])) {
            assert_true(!list->kept && !list->count);
            continue;
        }
        const int32_t *slots = grid_neighbours(grid, &reader, grid_lists(grid), s);
        int32_t found = 0;
        for (ptrdiff_t z = look[2].from; z < look[2].from + look[2].count; z++)
            for (ptrdiff_t y = look[1].from; y < look[1].from + look[1].count; y++)
                for (ptrdiff_t x = look[0].from; x < look[0].from + look[0].count; x++) {
                    const ptrdiff_t at[3] = {x, y, z},
                                    in[3] = {grid_folded(grid, 0, x), grid_folded(grid, 1, y),
                                             grid_folded(grid, 2, z)};
                    const size_t from = grid_cell_at(grid, in);
                    for (uint32_t t = grid->start[from]; t < grid->start[from + 1]; t++) {
                        float r2 = 0;
                        for (int a = 0; a < grid->box.dim; a++) {
                            const float moved =
                                (float)((double)(at[a] - c[a]) * grid->size[a] * scale);
                            float d = grid->place[a][t] + moved - grid->place[a][s];
                            if (all && grid_wraps(grid, a))
                                d = nearest_image(d, (float)(grid->side[a] / grid->unit));
                            r2 += d * d;
                        }
                        if (t == s || !(r2 < fmaxf(grid->radius2[s], grid->radius2[t]))) continue;
                        assert_true(found < list->count);
                        assert_int_equal(slots[found++], t);
                    }
                }
        assert_int_equal(list->count, found);
        compared += (size_t)found;
        for (; found % GRID_LANES; found++) assert_int_equal(slots[found], setup.n);
        longest = found > longest ? found : longest;
    }
    assert_int_equal(grid_longest(grid), longest);
    grid_reader_free(&reader);
    assert_true(!reader.candidates && !reader.slots && !reader.room);
    return compared;
}

/* The rim is where lists may have somebody who sleeps, or is not active. */
static void check_rim(struct grid *grid)
{
    static unsigned char asleep[POINTS_MAX];
    memset(asleep, 0, sizeof asleep);
    for (int k = 0; k < 3; k++) asleep[draw_bits() % setup.active] = 1;
    grid_find_rim(grid, asleep);
    for (size_t s = 0; s < setup.n; s++) {
        const size_t cell = grid->cell_of[grid->order[s]];
        ptrdiff_t c[3], d[3];
        bool rim = false;
        grid_cell_coordinates(grid, cell, c);
        for (size_t j = 0; j < setup.n && !rim; j++) {
            rim = j >= setup.active || asleep[j];
            if (!rim) continue;
            grid_cell_coordinates(grid, grid->cell_of[j], d);
            for (int a = 0; a < grid->box.dim; a++) {
                ptrdiff_t apart = c[a] < d[a] ? d[a] - c[a] : c[a] - d[a];
                const ptrdiff_t within = grid->within[a] >= 0
                                             ? grid->within[a]
                                             : grid_cells_within(grid, a, grid->reach[cell]);
                if (grid_wraps(grid, a) && grid->cells[a] - apart < apart)
                    apart = grid->cells[a] - apart;
                rim = rim && apart <= within;
            }
        }
        assert_int_equal(grid_in_rim(grid, s), rim);
    }
}

TEST(test_setups)
{
    size_t compared = 0;
    for (int trial = 0; trial < 40; trial++) {
        make(trial);
        struct grid *grid = search(trial, 1 + trial % 2);
        check_cells(grid);
        check_order_of_cells(grid);
        check_points(grid);
        check_looks(grid);
        check_reaches(grid);
        check_parts(grid);
        compared += check_lists(grid);
        check_rim(grid);
        grid_destroy(grid);
    }
    assert_true(compared > 100000);
}

/* n points spread over a box of these sides, with radii for cells of size 1. */
static struct grid *spread_over(int dim, size_t n, double x, double y, bool periodic)
{
    const double sides[] = {x, y, 1.5};
    memset(&setup, 0, sizeof setup);
    setup.box.dim = dim;
    setup.n = setup.active = n;
    for (int a = 0; a < dim; a++) {
        setup.box.periodic[a] = periodic, setup.box.hi[a] = sides[a];
        for (size_t i = 0; i < n; i++)
            setup.x[a][i] = i == 1 ? sides[a] : i ? draw(0, sides[a]) : 0;
    }
    for (size_t i = 0; i < n; i++) setup.radius[i] = 1 / (1 + 1e-5);
    end_setup();
    return search(1, 1);
}

/* Twice as many cells as points and 64 more, to the last one; else cells 1.3 times as large. */
TEST(test_number_of_cells)
{
    for (int dim = 2; dim <= 3; dim++) {
        struct grid *grid = spread_over(dim, 18, 100.5, 1.5, false);
        assert_int_equal(grid->cell_count, 100);
        grid_destroy(grid);
        grid = spread_over(dim, 18, 101.5, 1.5, false);
        assert_int_equal(grid->cell_count, 78); /* 101.5/1.3 */
        grid_destroy(grid);
    }
    static const double more[] = {3e-7, -3e-7};
    for (int k = 0; k < 2; k++) {
        const double side = 9 * 1.3 * (1 + more[k]);
        struct grid *grid = spread_over(2, 18, side, side, false);
        assert_int_equal(grid->cells[0], k ? 8 : 9);
        grid_destroy(grid);
    }
}

/* Cells that the points of a cell look through, at most. */
static ptrdiff_t cells_looked_through(const struct grid *grid)
{
    ptrdiff_t most = 0;
    for (size_t s = 0; s < setup.n; s++) {
        const size_t cell = grid->cell_of[grid->order[s]];
        ptrdiff_t c[3], count = 1;
        grid_cell_coordinates(grid, cell, c);
        for (int a = 0; a < 3; a++)
            count *= grid_look_along(grid, a, c[a], grid->reach[cell]).count;
        most = count > most ? count : most;
    }
    return most;
}

/* Radii that differ by a tenth, as those of a gas with little contrast, cost no more cells than
 * equal ones, wherever their width falls between the spacings: 3^d. One point of twice the radius
 * leaves those who are far from it as they were. */
TEST(test_cells_looked_through)
{
    static const double spreads[] = {0, 0.01, 0.02, 0.05, 0.1};
    for (int dim = 2; dim <= 3; dim++)
        for (int trial = 0; trial < 50; trial++) {
            const ptrdiff_t side = dim == 2 ? 50 : 14;
            const double eta = draw(2.3, 2.7), spread = spreads[trial % 5];
            memset(&setup, 0, sizeof setup);
            setup.box.dim = dim;
            setup.n = setup.active = (size_t)(dim == 2 ? side * side : side * side * side);
            for (size_t i = 0; i < setup.n; i++) {
                size_t rest = i;
                for (int a = 0; a < dim; a++, rest /= (size_t)side)
                    setup.x[a][i] = (double)(rest % (size_t)side) + draw(0.4, 0.6);
                setup.radius[i] = eta * (1 + spread * draw(-1, 1));
            }
            for (int a = 0; a < dim; a++)
                setup.box.periodic[a] = true, setup.box.hi[a] = (double)side;
            end_setup();
            struct grid *grid = search(1, 1);
            assert_int_equal(cells_looked_through(grid), dim == 2 ? 9 : 27);
            grid_destroy(grid);
            setup.radius[0] *= 2;
            grid = search(1, 1);
            near_below(grid->unit, eta * (1 + spread) * 1.0001);
            grid_destroy(grid);
        }
}

/* Radii wider than an open box: who is nobody is far from them all the same. */
TEST(test_wide)
{
    struct grid *grid = spread_over(2, 30, 0.1, 0.2, false);
    check_points(grid);
    assert_int_equal(check_lists(grid), 30 * 29);
    grid_destroy(grid);
}

/* Nobody has a neighbour: alone, and two who are far apart. */
TEST(test_nobody_near)
{
    for (size_t n = 1; n <= 2; n++) {
        struct grid *grid = spread_over(2, n, 60.5, 1.5, false);
        check_cells(grid);
        check_points(grid);
        assert_int_equal(check_lists(grid), 0);
        assert_int_equal(grid_longest(grid), 0);
        grid_destroy(grid);
    }
}

/* Lists that fill more than one piece of memory, found again and again. */
TEST(test_long_lists)
{
    struct grid *grid = spread_over(2, POINTS_MAX - 1, 7.5, 7.5, true);
    const double *const x[] = {setup.x[0], setup.x[1]};
    for (int k = 0; k < 3; k++) {
        assert_true(check_lists(grid) > 300000);
        assert_int_equal(grid_search(grid, setup.n, setup.active, x, setup.radius, NULL, NULL),
                         STATUS_OK);
    }
    grid_destroy(grid);
}

/* A second search has as many cells as its own radii ask for, whatever size they had before. */
TEST(test_searched_again)
{
    for (int dim = 2; dim <= 3; dim++) {
        struct grid *grid = spread_over(dim, 100, 10.5, 1.5, false);
        const double *const x[] = {setup.x[0], setup.x[1], setup.x[2]};
        for (int k = 0; k < 3; k++) {
            static const double radii[] = {0.3, 0.7, 0.1};
            for (size_t i = 0; i < setup.n; i++)
                setup.radius[i] = radii[k] * (1 + 0.1 * (i % 7 == 0));
            assert_int_equal(grid_search(grid, setup.n, setup.active, x, setup.radius, NULL, NULL),
                             STATUS_OK);
            check_cells(grid);
            check_order_of_cells(grid);
            check_points(grid);
            check_reaches(grid);
            assert_true(check_lists(grid) > 0);
            check_rim(grid);
        }
        grid_destroy(grid);
    }
}

static void refused(struct grid *grid, size_t n, const char *message)
{
    struct error error;
    const double *const x[] = {setup.x[0], setup.x[1], setup.x[2]};
    assert_int_equal(grid_search(grid, n, n, x, setup.radius, NULL, &error), STATUS_BAD_INPUT);
    assert_string_equal(error.message, message);
}

TEST(test_refused)
{
    make(1);
    setup.n = 5;
    for (int a = 0; a < 3; a++) {
        setup.box.periodic[a] = true, setup.box.lo[a] = 0, setup.box.hi[a] = 2.469128 + a;
        for (int i = 0; i < 5; i++) setup.x[a][i] = 0.1 * i, setup.radius[i] = 1;
    }
    struct grid *grid = search(1, 1); /* half a box is not too far */
    refused(grid, 0, "0 particles: allowed are 1 to 2^31 - 2");
    refused(grid, INT32_MAX, "2147483647 particles: allowed are 1 to 2^31 - 2");
    setup.radius[0] = 1.75;
    refused(grid, 5,
            "particle 0 reaches as far as 1.75, beyond half the box (1.23456): more particles "
            "or a smaller eta are needed");
    setup.radius[0] = 1, setup.radius[4] = 1.25;
    refused(grid, 5,
            "particle 4 reaches as far as 1.25, beyond half the box (1.23456): more particles "
            "or a smaller eta are needed");
    setup.radius[4] = 0;
    refused(grid, 5, "search radius of particle 4 is 0");
    setup.radius[4] = 0.5, setup.radius[0] = HUGE_VAL;
    refused(grid, 5, "search radius of particle 0 is inf");
    setup.radius[0] = 0.5, setup.x[2][4] = HUGE_VAL;
    refused(grid, 5, "position of particle 4 is inf");
    setup.x[1][0] = -HUGE_VAL;
    refused(grid, 5, "position of particle 0 is -inf");
    grid_destroy(grid);
    grid_destroy(NULL);
}

/* Bytes of a point and of its list, by what is allocated for them. */
TEST(test_bytes)
{
    const double point = 4 + 4 + 24 + 4 + 12 + 16;
    near_relative(grid_bytes(2, 1000, 50), 1000 * (point + 4 * (50 + 4.)), 1e-15);
    near_relative(grid_bytes(2, 3, 0), 3 * (point + 16), 1e-15);
    near_relative(grid_bytes(3, 1000, 50), 1000 * (point + (50 * 20.6 / 4.19 + 43) / 8), 1e-15);
    near_relative(grid_bytes(3, 3, 0), 3 * (point + 43. / 8), 1e-15);
}
