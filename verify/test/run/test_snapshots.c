/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests snapshots during a run: number, times, files, and the state that is restored after each. */
#include "test.h"

#include "sample_simulation.h"
#include "snapshot_file.h"
#include "snapshot_writer.h"
#include "snapshots.h"

/* Intervals from 1e-4 of the run to all of it, both included. */
TEST(intervals)
{
    const double least = 1. / 1024, t_end = SNAPSHOTS_MOST * least;
    const struct {
        double every;
        bool allowed;
    } rows[] = {{t_end, true}, {nextafter(t_end, HUGE_VAL), false},
                {least, true}, {least * (1 - 1e-12), false},
                {1, true},     {0, false},
                {-1, false},   {(double)NAN, false}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct snapshots snapshots = {.every = rows[k].every};
        struct error error = {0};
        assert_int_equal(snapshots_check(&snapshots, t_end, &error),
                         rows[k].allowed ? STATUS_OK : STATUS_BAD_INPUT);
        if (!rows[k].allowed)
            assert_string_equal(error.message,
                                "allowed: a time from t_end/10000 to t_end = 9.76562");
    }
}

/* Snapshots are made at the start and at each multiple of the interval until 1e-9 of the run before
 * the end, where the run's final snapshot is made. */
TEST(number_of_snapshots)
{
    const struct snapshots quarter = {.every = 0.25}, third = {.every = 0.3};
    const double more = 1 + 1e-9;
    assert_int_equal(snapshots_count(&quarter, 1), 4);
    assert_int_equal(snapshots_count(&third, 1), 4);
    assert_int_equal(snapshots_count(&quarter, 0.25), 1);
    assert_int_equal(snapshots_count(&quarter, more * (1 - 5e-16)), 4);
    assert_int_equal(snapshots_count(&quarter, more * (1 + 5e-16)), 5);
    assert_true(snapshots_time(&quarter, 0) == 0 && snapshots_time(&quarter, 3) == 0.75);
}

TEST(files)
{
    static const struct {
        const char *path;
        size_t number;
        const char *want;
    } rows[] = {{"a/b.csv", 3, "a/b_0003.csv"},
                {"a.d/b", 0, "a.d/b_0000"},
                {"b", 9999, "b_9999"},
                {"b.c.h5", 12, "b.c_0012.h5"},
                {".csv", 123, "_0123.csv"},
                {"a/.csv", 1, "a/_0001.csv"},
                {"a.d/b.hdf5", 1, "a.d/b_0001.hdf5"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct snapshots snapshots = {.path = rows[k].path};
        assert_string_equal(snapshots_path(&snapshots, rows[k].number).text, rows[k].want);
    }
}

TEST(memory)
{
    static const double bytes[] = {0, 180, 350, 480};
    for (int dim = 1; dim <= 3; dim++)
        assert_true(snapshots_memory(dim, 1000) == 1000 * bytes[dim]);
    assert_true(snapshot_writer_memory("a.csv") == 0 && snapshot_writer_memory("a.h5") == 250);
    assert_true(snapshot_writer_memory("a.vtu") == 90 && snapshot_writer_memory("a.") == 0);
}

/* A resumed run repeats neither snapshots due up to its time nor those of earlier processes. */
TEST(first_snapshot_of_a_resumed_run)
{
    static const struct {
        double time, last;
        size_t next;
        double made;
    } rows[] = {{0, -1, 0, -1},      {0.25, -1, 2, 0.25}, {0.24, -1, 1, 0},  {0.5, 0.75, 4, 0.75},
                {0.5, 0.25, 3, 0.5}, {0.5, 0.8, 4, 0.75}, {1e-300, -1, 1, 0}};
    struct snapshots tenth = {.every = 0.1};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct snapshots snapshots = {.every = 0.25};
        snapshots_begin(&snapshots, rows[k].time, rows[k].last, 2);
        assert_int_equal(snapshots.count, 8);
        assert_int_equal(snapshots.next, rows[k].next);
        assert_true(snapshots_last(&snapshots) == rows[k].made);
    }
    struct snapshots four = {.every = 4};
    snapshots_begin(&four, 9, -1, 20);
    assert_int_equal(four.next, 3);
    /* 0.3/0.1 is less than 3, and 3 0.1 more than 0.3 */
    snapshots_begin(&tenth, 3 * 0.1, -1, 1);
    assert_int_equal(tenth.next, 4);
    snapshots_begin(&tenth, 0.3, -1, 1);
    assert_int_equal(tenth.next, 3);
}

static double step_of(const struct simulation *simulation)
{
    struct rates rates;
    simulation_rates(simulation, &rates);
    return rates.time_step;
}

/* The state is kept if a snapshot is due within four steps and before the next stop, and can be
 * restored to the last bit any number of times. */
TEST(state_is_set_aside_and_restored)
{
    struct simulation *self = sample_simulation(40), *other = sample_simulation(40);
    struct snapshots snapshots = {.path = "a.csv", .every = 1};
    run_until(self, 0.05, NULL);
    run_until(other, 0.05, NULL);
    const double reach = 0.05 + 4 * step_of(self);
    snapshots_begin(&snapshots, 0.05, -1, 10);
    assert_int_equal(snapshots.next, 1);
    snapshots.every = nextafter(reach, 1);
    assert_false(snapshots_keep(&snapshots, self, 0.05, 9));
    assert_true(snapshots.reach == reach && !snapshots.state);
    snapshots.every = reach;
    assert_false(snapshots_keep(&snapshots, self, 0.05, nextafter(reach, 0)));
    snapshots.count = 1;
    assert_false(snapshots_keep(&snapshots, self, 0.05, 9));
    snapshots.count = 2;
    assert_true(snapshots_keep(&snapshots, self, 0.05, reach));
    assert_true(snapshots.reach == reach && snapshots.state);
    assert_int_equal(snapshots.next, 1);
    for (int k = 0; k < 2; k++) {
        run_until(self, 0.08 + 0.01 * k, NULL);
        assert_false(same_state(self, other));
        snapshots_return(&snapshots, self);
        assert_true(same_state(self, other));
    }
    snapshots_go_on(&snapshots);
    assert_null(snapshots.state);
    run_until(self, 0.2, NULL);
    run_until(other, 0.2, NULL);
    assert_true(same_state(self, other));
    simulation_destroy(self);
    simulation_destroy(other);
}

TEST(first_error_is_reported)
{
    struct snapshots snapshots = {0};
    const struct error errors[] = {{.status = STATUS_ENVIRONMENT, .message = "no space"},
                                   {.status = STATUS_BAD_INPUT, .message = "later"}};
    for (int k = 0; k < 2; k++) snapshots_fail(&snapshots, &errors[k]);
    assert_int_equal(snapshots.trouble.status, STATUS_ENVIRONMENT);
    assert_string_equal(snapshots.trouble.message, "no space");
}

/* A snapshot has periods only if it has a box, and only along directions that are periodic. */
TEST(periods)
{
    static const struct {
        const char *boundary;
        double period[3];
    } rows[] = {{"", {2, 3, 5}},
                {"periodic", {2, 3, 5}},
                {"reflecting", {0, 0, 0}},
                {"periodic reflecting", {2, 0, 0}},
                {"open periodic fixed", {0, 3, 0}}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int boxed = 0; boxed < 2; boxed++) {
            struct snapshot_file file = {.boxed = boxed, .box = {2, 3, 5}};
            strcpy(file.boundary, rows[k].boundary);
            for (int d = 0; d < 3; d++)
                assert_true(snapshot_period(&file, d) == boxed * rows[k].period[d]);
        }
}
