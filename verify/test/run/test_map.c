/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares maps of a state with counts by hand: cells and their edges, slices, means, empty cells.
 */
#include "test.h"

#include "map.h"

/* So wide that every cell is within some particle's h. */
static double wide[200];

static struct map made(const struct domain *domain, const struct snapshot *s, size_t most)
{
    struct map map;
    struct error error = {0};
    for (size_t i = 0; i < sizeof wide / sizeof *wide; i++) wide[i] = 99;
    assert_int_equal(map_create(&map, domain, s, most, &error), STATUS_OK);
    return map;
}

/* 4 x 2 cells of width 1; a cell contains its lower edges, the last one also its upper edge. */
TEST(cells_of_a_plane)
{
    enum { N = 8, NONE = 8 };
    const struct domain domain = {2, {-1, 2}, {3, 4}};
    const double x[N] = {-1, 3, 0, 0.999, 2.5, -1.001, 1, 2},
                 y[N] = {2, 4, 3, 2.999, 4.001, 3, 2.5, 3};
    const size_t cell[N] = {0, 7, 5, 1, NONE, NONE, 2, 7};
    const struct snapshot s = {.n = N, .x = {x, y}, .h = wide};
    struct map map = made(&domain, &s, MAP_CELLS);
    assert_true(map.nx == 4 && map.ny == 2 && map.n == N);
    assert_int_equal(map.seen, 6);
    for (int d = 0; d < 2; d++) assert_true(map.lo[d] == domain.lo[d] && map.hi[d] == domain.hi[d]);
    for (size_t i = 0; i < N; i++) assert_int_equal(map.cell[i], cell[i]);
    const size_t count[] = {1, 1, 1, 0, 0, 1, 0, 2};
    for (size_t k = 0; k < 8; k++) assert_int_equal(map.count[k], count[k]);
    for (size_t k = 0; k < 4; k++) assert_true(map.x[k] == -0.5 + (double)k);
    for (size_t k = 0; k < 2; k++) assert_true(map.y[k] == 2.5 + (double)k);
    const double values[N] = {10, 3, 20, 30, 1e3, 1e4, 40, 6};
    /* cell 3: of cells 2 and 7; cell 4: of 0, 1, 5; cell 6: of 1, 2, 5, 7 */
    const double mean[9] = {10, 30, 40, 22.25, 20, 20, 23.625, 4.5, -77};
    double z[9] = {7, 7, 7, 7, 7, 7, 7, 7, -77}; /* the last one lies outside of the map */
    map_mean(&map, values, z);
    for (size_t k = 0; k < 9; k++) near_relative(z[k], mean[k], 1e-15);
    assert_true(map.x >= (double *)map.storage && map.y >= map.x + 4);
    map_free(&map);
    assert_null(map.storage);
    map = made(&domain, &s, 3);
    assert_true(map.nx == 3 && map.ny == 2);
    map_free(&map);
    /* one particle in a flat box: the number of cells follows from its spacing, and is at least
     * one */
    const struct domain flat = {2, {0, 0}, {4, 0.1}};
    const struct snapshot one = {.n = 1, .x = {x + 6, y}, .h = wide};
    map = made(&flat, &one, MAP_CELLS);
    assert_true(map.nx == 6 && map.ny == 1 && map.y[0] == 0.05);
    map_free(&map);
}

/* A slice of two spacings contains its lower face and not its upper one. */
TEST(slice_of_a_box)
{
    enum { N = 32 };
    const struct domain domain = {3, {0, 0, 1}, {4, 2, 5}};
    double x[N], y[N], z[N];
    for (int i = 0; i < N; i++) x[i] = 99, y[i] = z[i] = 3;
    const double heights[] = {2, 1.999, 4, 3.999, 3};
    for (int i = 0; i < 5; i++) x[i] = 0.5 + i / 2, y[i] = 0.5, z[i] = heights[i];
    const struct snapshot s = {.n = N, .x = {x, y, z}, .h = wide};
    struct map map = made(&domain, &s, MAP_CELLS);
    assert_true(map.nx == 4 && map.ny == 2 && map.slice[0] == 2 && map.slice[1] == 4);
    assert_int_equal(map.seen, 3);
    assert_true(map.cell[0] == 0 && map.cell[1] == 8 && map.cell[2] == 8 && map.cell[3] == 1 &&
                map.cell[4] == 2);
    map_free(&map);
    const struct snapshot few = {.n = 5, .x = {x, y, z}, .h = wide};
    map = made(&domain, &few, MAP_CELLS);
    near_relative(map.slice[0], 3 - cbrt(32. / 5), 1e-14);
    near_relative(map.slice[1], 3 + cbrt(32. / 5), 1e-14);
    map_free(&map);
}

/* Empty cells have the mean of the nearest ring with particles, up to MAP_REACH. */
TEST(empty_cells_take_the_nearest_ring)
{
    enum { SIDE_X = 14, SIDE_Y = 11, CELLS = SIDE_X * SIDE_Y };
    const struct domain domain = {2, {0, 0}, {SIDE_X, SIDE_Y}};
    static const int at[][2] = {{1, 0}, {1, 0}, {0, 5}, {4, 3}, {5, 3}, {4, 4}, {13, 9}, {2, 10}};
    enum { N = sizeof at / sizeof *at };
    double x[CELLS], y[CELLS], values[CELLS], z[CELLS + 1], direct[CELLS] = {0}, held[CELLS] = {0};
    for (int i = 0; i < CELLS; i++) {
        x[i] = i < N ? at[i][0] + 0.5 : -1;
        y[i] = i < N ? at[i][1] + 0.5 : -1;
        values[i] = 2.385 + i * i;
        if (i < N)
            direct[at[i][1] * SIDE_X + at[i][0]] += values[i], held[at[i][1] * SIDE_X + at[i][0]]++;
    }
    const struct snapshot s = {.n = CELLS, .x = {x, y}, .h = wide};
    struct map map = made(&domain, &s, MAP_CELLS);
    assert_true(map.nx == SIDE_X && map.ny == SIDE_Y && map.seen == N);
    z[CELLS] = 5;
    map_mean(&map, values, z);
    assert_true(z[CELLS] == 5);
    int voids = 0;
    for (int k = 0; k < CELLS; k++) {
        double sum = 0, n = 0;
        int nearest = 99;
        for (int other = 0; other < CELLS; other++) {
            const int dx = abs(other % SIDE_X - k % SIDE_X), dy = abs(other / SIDE_X - k / SIDE_X);
            const int away = dx > dy ? dx : dy;
            if (!(held[other] > 0) || away > nearest) continue;
            if (away < nearest) sum = n = 0;
            nearest = away;
            sum += direct[other] / held[other];
            n++;
        }
        voids += nearest > MAP_REACH;
        if (nearest > MAP_REACH)
            assert_true(isnan(z[k]));
        else
            near_relative(z[k], sum / n, 1e-14);
    }
    assert_true(voids > 5);
    map_free(&map);
}

/* Empty cells beyond every h are void; distances are those of cell centres, in the plane. */
TEST(cells_beyond_every_h)
{
    enum { SIDE = 12, N = SIDE * SIDE };
    const struct domain domain = {2, {0, 0}, {SIDE, SIDE}};
    double x[N], y[N], h[N], values[N], z[N];
    for (int i = 0; i < N; i++) x[i] = -1, y[i] = 5, h[i] = 3, values[i] = 7;
    const double at[][3] = {{3.5, 3.5, 2.236}, {9.25, 6.5, 1.6}, {11.5, 0.5, 0.4}};
    for (int i = 0; i < 3; i++) x[i] = at[i][0], y[i] = at[i][1], h[i] = at[i][2];
    const struct snapshot s = {.n = N, .x = {x, y}, .h = h};
    struct map map = made(&domain, &s, MAP_CELLS);
    assert_true(map.nx == SIDE && map.ny == SIDE);
    map_mean(&map, values, z);
    int filled = 0;
    for (int k = 0; k < N; k++) {
        size_t covered = 0;
        for (int i = 0; i < 3; i++)
            covered += hypot(k % SIDE + 0.5 - x[i], k / SIDE + 0.5 - y[i]) <= h[i];
        assert_int_equal(map.covered[k], covered);
        assert_true(covered ? z[k] == 7 : isnan(z[k]));
        filled += covered > 0;
    }
    assert_int_equal(filled, 13 + 7 + 1);
    map_free(&map);
}
