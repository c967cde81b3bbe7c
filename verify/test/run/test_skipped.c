/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares the share of a run that is skipped with the gas that the exact solution leaves
 * undisturbed. */
#include "test.h"

#include "bench_possible.h"
#include "keyed.h"

static struct bench_shares shares_of(const char *name, const char *words)
{
    const struct run run = keyed_run(name, words);
    struct bench_shares shares;
    struct error error;
    if (bench_possible(&run, &shares, &error)) fail_msg("%s %s: %s", name, words, error.message);
    print_message("%s %s: skipped %.3f of %.3f allowed, %.3f by the waves alone\n", name, words,
                  shares.skipped, shares.allowed, shares.possible);
    return shares;
}

/* Of the particles that may be inactive at least four fifths are inactive, and no others are. */
TEST(shares_of_inactive_particles)
{
    static const struct {
        const char *name, *keys;
        double allowed;
    } cases[] = {{"sod", "n=800", 0.5},
                 {"sod_2d", "n=5600", 0.3},
                 {"sedov_2d", "n=64^2 t_end=0.02", 0.7},
                 {"sedov_3d", "n=24^3 t_end=0.01", 0.3}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const struct bench_shares shares = shares_of(cases[k].name, cases[k].keys);
        near_inside(shares.allowed, cases[k].allowed, 1);
        assert_true(bench_shares_enough(&shares));
        assert_true((shares.spacing > 0) == !strpbrk(cases[k].name, "23")); /* 1D alone */
        near_inside(shares.skipped / shares.allowed, 0.8, 1.05);
        /* particles that may be inactive are, or the reason is counted (a step counts particles
         * after it) */
        assert_true(shares.reached >= 0 && shares.layers >= 0);
        near_inside(shares.possible - shares.reached - shares.layers, 0, shares.skipped + 0.03);
    }
}

/* The bound itself: half of the possible share is too little, unless layers of few particles
 * explain it; a hundredth of all updates does not count. */
TEST(bound_of_skipped_updates)
{
    static const struct {
        double skipped, allowed, layers, spacing;
        bool enough;
    } cases[] = {{0.4, 0.8, 0, 0, false},
                 {0.6, 0.8, 0, 0, false},
                 {0.63, 0.8, 0, 0, true},
                 {0.8, 0.8, 0, 0, true},
                 {0, 0.02, 0, 0, true},
                 {0, 0.1, 0, 0, false},
                 {0, NAN, 0, 0, true},
                 /* case lax with 200 particles; with fewer layers, with 1000 particles */
                 {0.265, 0.456, 0.204, 0.005, true},
                 {0.265, 0.456, 0.07, 0.005, false},
                 {0.265, 0.456, 0.204, 0.001, false},
                 /* no particles, or far too few, are inactive */
                 {0, 0.456, 0.456, 0.005, false},
                 {0.1, 0.456, 0.356, 0.005, false}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const struct bench_shares shares = {.skipped = cases[k].skipped,
                                            .allowed = cases[k].allowed,
                                            .layers = cases[k].layers,
                                            .spacing = cases[k].spacing};
        assert_true(bench_shares_enough(&shares) == cases[k].enough);
    }
}

/* The map has no empty stripes: 20 of 20^2 and 12 of 12^3 particles lie along x. */
TEST(skipped_columns)
{
    static const struct {
        const char *name, *keys;
        int columns;
    } cases[] = {{"rest_2d", "n=20^2 jitter=0 t_end=0.01 lattice=square", 20},
                 {"sedov_3d", "n=12^3 t_end=0.001", 12},
                 {"sound_wave", "n=1000 t_end=0.01", BENCH_COLUMNS}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const struct bench_shares shares = shares_of(cases[k].name, cases[k].keys);
        assert_int_equal(shares.columns, cases[k].columns);
        for (int row = 0; row < BENCH_ROWS; row++)
            for (int c = 0; c < shares.columns; c++) assert_true(shares.asleep[row][c] >= 0);
    }
}

/* Without an exact front, gas that hardly changes could be inactive: in a box at rest all of it, in
 * a converging flow none. The map then shows every particle inactive, or none. */
TEST(gas_without_a_front)
{
    static const struct {
        const char *name, *keys;
        double share;
    } cases[] = {{"rest_2d", "n=400 jitter=0 t_end=0.1", 1}, {"noh_2d", "n=400 t_end=0.1", 0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const struct bench_shares shares = shares_of(cases[k].name, cases[k].keys);
        assert_true(shares.coarse && shares.possible == cases[k].share);
        assert_true(shares.skipped == cases[k].share);
        size_t gas = 0;
        for (int row = 0; row < BENCH_ROWS; row++)
            for (int c = 0; c < shares.columns; c++) {
                if (isnan(shares.asleep[row][c])) continue;
                assert_true(shares.asleep[row][c] == cases[k].share);
                gas++;
            }
        assert_true(gas >= BENCH_ROWS * 10);
    }
}
