/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares the grid's neighbour lists with a search over all pairs, on random setups: any
 * dimension, number and boundary, equal and very different radii, clumps, coincident points. */
#include "test.h"

#include <gsl/gsl_rng.h>

#include "cube_root.h"
#include "cells/gather.h"
#include "grid.h"

enum { DRAWS = 120, POINTS_MAX = 600 };

struct points {
    struct grid_box box;
    size_t n;
    double x[3][POINTS_MAX], radius[POINTS_MAX];
};

static void draw(gsl_rng *rng, struct points *p)
{
    *p = (struct points){.box.dim = 2 + (int)gsl_rng_uniform_int(rng, 2)};
    p->n = 1 + gsl_rng_uniform_int(rng, POINTS_MAX - 1);
    const double scale = pow(10, 20 * gsl_rng_uniform(rng) - 10);
    const double contrast = gsl_rng_uniform(rng) < 0.5 ? 1 : 1 + 9 * gsl_rng_uniform(rng);
    const double clump = gsl_rng_uniform(rng) < 0.3 ? 1e-3 : 1;
    double least_side = HUGE_VAL;
    for (int a = 0; a < p->box.dim; a++) {
        p->box.periodic[a] = gsl_rng_uniform(rng) < 0.6;
        p->box.lo[a] = scale * (gsl_rng_uniform(rng) - 0.5) * 4;
        const double side = scale * (0.5 + gsl_rng_uniform(rng));
        p->box.hi[a] = p->box.lo[a] + side;
        if (p->box.periodic[a] && side < least_side) least_side = side;
    }
    if (!isfinite(least_side)) least_side = scale;
    const double usual = least_side * (0.02 + 0.47 * gsl_rng_uniform(rng)) / contrast;
    for (size_t i = 0; i < p->n; i++) {
        const bool clumped = gsl_rng_uniform(rng) < 0.5;
        for (int a = 0; a < p->box.dim; a++) {
            const double side = p->box.hi[a] - p->box.lo[a];
            const double at =
                clumped ? 0.5 + clump * (gsl_rng_uniform(rng) - 0.5) : gsl_rng_uniform(rng);
            p->x[a][i] = p->box.lo[a] + side * at;
            /* positions need not lie in a periodic box */
            if (p->box.periodic[a]) p->x[a][i] += side * ((double)gsl_rng_uniform_int(rng, 5) - 2);
            /* just below the lower edge: in round-off, the upper one */
            if (p->box.periodic[a] && gsl_rng_uniform(rng) < 0.02)
                p->x[a][i] = p->box.lo[a] - 1e-18 * side;
        }
        p->radius[i] = usual * (gsl_rng_uniform(rng) < 0.1 ? contrast : 1);
    }
    for (int a = 0; a < p->box.dim && p->n > 3; a++) p->x[a][1] = p->x[a][0];
}

static double distance2(const struct points *p, size_t i, size_t j)
{
    double r2 = 0;
    for (int a = 0; a < p->box.dim; a++) {
        const double side = p->box.hi[a] - p->box.lo[a];
        double d = p->x[a][i] - p->x[a][j];
        if (p->box.periodic[a]) d -= side * round(d / side);
        r2 += d * d;
    }
    return r2;
}

/* A reader that has read other lists before finds the same neighbours as a new reader. */
static void read_again(const struct grid *grid, struct grid_reader *reader, size_t s)
{
    const struct grid_list *lists = grid_lists(grid);
    struct grid_reader other = {0};
    if (!lists[s].kept) return;
    assert_true(grid_reader_reserve(grid, &other));
    const size_t bytes = (size_t)lists[s].count * sizeof(int32_t);
    assert_memory_equal(grid_neighbours(grid, reader, lists, s),
                        grid_neighbours(grid, &other, lists, s), bytes);
    grid_reader_free(&other);
}

/* Compares pairs within the wider of two radii with those of the list. */
static void compare(const struct points *p, const struct grid *grid, size_t active,
                    size_t *compared)
{
    struct grid_reader reader = {0};
    const uint32_t *order = grid_order(grid);
    char listed[POINTS_MAX];
    assert_true(grid_reader_reserve(grid, &reader));
    for (size_t s = 0; s < p->n; s++) {
        const size_t i = order[s];
        const struct grid_list *list = &grid_lists(grid)[s];
        if (i >= active) {
            assert_null(list->kept);
            continue;
        }
        const int32_t *slots = grid_neighbours(grid, &reader, grid_lists(grid), s);
        memset(listed, 0, sizeof listed);
        for (int32_t k = 0; k < list->count; k++) {
            const size_t j = order[slots[k]];
            assert_false(listed[j]); /* once */
            assert_int_not_equal(j, i);
            listed[j] = 1;
        }
        for (int32_t k = list->count; k % GRID_LANES; k++) assert_int_equal(slots[k], p->n);
        for (size_t j = 0; j < p->n; j++) {
            if (j == i) continue;
            const double r = sqrt(distance2(p, i, j)), reach = fmax(p->radius[i], p->radius[j]);
            if (r < reach * (1 - 1e-9)) assert_true(listed[j]);
            if (r > reach * (1 + 1e-3)) assert_false(listed[j]);
            *compared += listed[j] != 0;
        }
    }
    for (size_t s = p->n; s-- > 0;) read_again(grid, &reader, s);
    grid_reader_free(&reader);
}

TEST(lists_hold_every_pair)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    struct points *p = malloc(sizeof *p);
    size_t compared = 0, sound = 0;
    assert_non_null(p);
    gsl_rng_set(rng, 2385);
    for (int k = 0; k < DRAWS; k++) {
        struct error error = {0};
        draw(rng, p);
        struct grid *grid = grid_create(&p->box, p->n / 2 + 1, 1 + k % 3);
        assert_non_null(grid);
        const double *const x[] = {p->x[0], p->x[1], p->x[2]};
        const size_t active = k % 4 ? p->n : p->n / 2 + 1;
        const enum status status = grid_search(grid, p->n, active, x, p->radius, NULL, &error);
        if (status) fail_msg("draw %d: %s", k, error.message);
        compare(p, grid, active, &compared);
        sound++;
        grid_destroy(grid);
    }
    assert_int_equal(sound, DRAWS);
    assert_true(compared > 100000);
    free(p);
    gsl_rng_free(rng);
}

/* Points so close together, or so much closer than others, that cells are 10 to 1e9 times as large
 * as their radii: in single precision positions are no more precise than that. */
TEST(lists_of_clumps_hold_every_pair)
{
    struct points *p = calloc(1, sizeof *p);
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    size_t compared = 0;
    assert_non_null(p);
    gsl_rng_set(rng, 2385);
    for (int k = 0; k < 36; k++) {
        struct error error = {0};
        const double scale = pow(10, -1 - k / 4.); /* 0.1 to 2e-10 of the box */
        p->n = 60;
        p->box = (struct grid_box){.dim = 2 + k % 2, .hi = {1, 1, 1}};
        for (int a = 0; a < p->box.dim; a++) {
            const double middle = gsl_rng_uniform(rng);
            p->box.periodic[a] = k % 3 > 0;
            for (size_t i = 0; i < p->n; i++) p->x[a][i] = middle + scale * gsl_rng_uniform(rng);
            p->x[a][0] = 0, p->x[a][1] = 1 - 1e-9;
        }
        /* alternately all radii are small, and most are large */
        for (size_t i = 0; i < p->n; i++)
            p->radius[i] = k % 4 == 3 && i % 2 ? 0.3 : scale * (0.2 + 0.1 * gsl_rng_uniform(rng));
        struct grid *grid = grid_create(&p->box, p->n, 1);
        assert_non_null(grid);
        const double *const x[] = {p->x[0], p->x[1], p->x[2]};
        assert_int_equal(grid_search(grid, p->n, p->n, x, p->radius, NULL, &error), STATUS_OK);
        struct grid_reader reader = {0};
        assert_true(grid_reader_reserve(grid, &reader));
        const uint32_t *order = grid_order(grid);
        for (size_t s = 0; s < p->n; s++) {
            const int32_t count = grid_lists(grid)[s].count, *slots;
            char listed[POINTS_MAX] = {0};
            slots = grid_neighbours(grid, &reader, grid_lists(grid), s);
            for (int32_t m = 0; m < count; m++) listed[order[slots[m]]] = 1;
            for (size_t j = 0; j < p->n; j++) {
                const size_t i = order[s];
                const double r = sqrt(distance2(p, i, j)), reach = fmax(p->radius[i], p->radius[j]);
                if (j == i) continue;
                if (r < reach * (1 - 1e-9) - 1e-15) assert_true(listed[j]);
                if (r > reach * (1 + 1e-3) + 1e-6) assert_false(listed[j]);
                compared += listed[j] != 0;
            }
        }
        grid_reader_free(&reader);
        grid_destroy(grid);
    }
    assert_in_range(compared, 10000, 60 * 60 * 36);
    gsl_rng_free(rng);
    free(p);
}

/* A point that cannot be searched is refused with its number. */
TEST(unsearchable_points_are_refused)
{
    const struct grid_box box = {2, {0, 0}, {1, 1}, {true, true}};
    double x[] = {0.1, 0.2, 0.3}, y[] = {0.1, 0.5, 0.9}, radius[] = {0.1, 0.1, 0.1};
    const double *const at[] = {x, y};
    struct error error = {0};
    struct grid *grid = grid_create(&box, 3, 1);
    assert_non_null(grid);
    assert_int_equal(grid_search(grid, 3, 3, at, radius, NULL, &error), STATUS_OK);
    radius[2] = 0.51;
    assert_int_equal(grid_search(grid, 3, 3, at, radius, NULL, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "particle 2 reaches as far as 0.51"));
    radius[2] = NAN;
    assert_int_equal(grid_search(grid, 3, 3, at, radius, NULL, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "search radius of particle 2 is nan"));
    radius[2] = 0.1;
    y[1] = INFINITY;
    assert_int_equal(grid_search(grid, 3, 3, at, radius, NULL, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "position of particle 1"));
    assert_int_equal(grid_search(grid, 0, 0, at, radius, NULL, &error), STATUS_BAD_INPUT);
    assert_string_equal(error.message, "0 particles: allowed are 1 to 2^31 - 2");
    grid_destroy(grid);
}

/* Records of every size that has a specialised loop, and of one that has none. */
TEST(records_are_gathered)
{
    enum { RECORDS = 37, LARGEST = 56, COUNT = 24, STRIDE = 40 };
    static _Alignas(64) double records[RECORDS * LARGEST], out[LARGEST * STRIDE];
    int32_t slots[COUNT];
    for (int k = 0; k < RECORDS * LARGEST; k++) records[k] = 2.385 * k;
    for (int k = 0; k < COUNT; k++) slots[k] = k * 17 % RECORDS;
    for (int size = GATHER_GROUP; size <= LARGEST; size += GATHER_GROUP) {
        for (int k = 0; k < LARGEST * STRIDE; k++) out[k] = -1;
        gather_choose(size)(records, size, slots, COUNT, out, STRIDE);
        for (int f = 0; f < LARGEST; f++)
            for (int k = 0; k < STRIDE; k++)
                assert_true(out[f * STRIDE + k] ==
                            (f < size && k < COUNT ? records[slots[k] * size + f] : -1));
    }
}

/* Arguments of every magnitude, because densities have any magnitude in extreme units. */
TEST(cube_roots)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int k = 0; k < 20000; k++) {
        const double x = ldexp(1 + gsl_rng_uniform(rng), k % 2000 - 1000);
        near_relative(cube_root(x), (double)cbrtl(x), 4.5e-16); /* cbrt errs by more */
    }
    assert_true(isnan(cube_root(NAN)));
    gsl_rng_free(rng);
}

/* The estimate of bytes per point and list agrees with the memory allocated. */
TEST(bytes_per_point)
{
    const double point = 4 + 4 + 24 + 4 + 12 + 16;
    near_relative(grid_bytes(2, 1000, 50), 1000 * (point + 4 * (50 + 4.)), 1e-15);
    near_relative(grid_bytes(2, 3, 0), 3 * (point + 16), 1e-15);
    near_relative(grid_bytes(3, 1000, 50), 1000 * (point + (50 * 20.6 / 4.19 + 43) / 8), 1e-15);
    near_relative(grid_bytes(3, 3, 0), 3 * (point + 43. / 8), 1e-15);
}
