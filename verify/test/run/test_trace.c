/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the trace of a run through time: it ends with the run's final figures, and shows how
 * jittered particles come to rest. */
#include "test.h"

#include "keyed.h"
#include "run_output.h"
#include "value.h"

static struct run_result traced(struct trace *trace, const char *name, const char *keys)
{
    struct run run = keyed_run(name, keys);
    run.asked.trace = trace;
    return keyed_result(&run);
}

static void same(double a, double b)
{
    if (!(fabs(a - b) <= 1e-9 * fabs(a))) fail_msg("%.17g is not %.17g", a, b);
}

static double last(const json_t *list)
{
    return value_real(json_array_get(list, json_array_size(list) - 1));
}

TEST(ends_with_the_run)
{
    struct trace trace = {0};
    struct run_result result = traced(&trace, "rest_2d", "n=12^2 t_end=0.5");
    const struct regularity *start = &trace.seen[0], *end = &trace.seen[trace.looks - 1];
    assert_true(trace.looks >= 8 && trace.looks <= TRACE_LOOKS + 2);
    same(trace.looked[trace.looks - 1], result.time);
    for (size_t k = 1; k < trace.looks; k++) assert_true(trace.looked[k] > trace.looked[k - 1]);
    same(end->nearest, result.regularity.nearest);
    same(end->spread, result.regularity.spread);
    same(end->gradient, result.regularity.gradient);
    /* relaxation has removed the jitter of 0.2 */
    assert_true(start->spread > 0.1 && end->spread < 0.5 * start->spread);
    json_t *through = trace_json(&trace, 2);
    same(last(json_object_get(through, "angular_momentum")), result.drift.angular_momentum);
    same(last(json_object_get(json_object_get(through, "regularity"), "gradient")), end->gradient);
    assert_int_equal(json_array_size(json_object_get(through, "time")), trace.count);
    json_decref(through);
    run_free(&result);
}

TEST(drift_in_1d)
{
    struct trace trace = {0};
    struct run_result result = traced(&trace, "sod", "n=40 t_end=0.02");
    json_t *through = trace_json(&trace, 1);
    assert_true(json_is_null(json_object_get(through, "angular_momentum")));
    /* a run of few steps samples each step once */
    assert_true(trace.looks >= 2 && trace.looks <= result.cost.steps + 1);
    for (size_t k = 1; k < trace.looks; k++) assert_true(trace.looked[k] > trace.looked[k - 1]);
    json_decref(through);
    run_free(&result);
}

/* ---- artificial sums ---- */

static struct conservation sums_at(double k)
{
    return (struct conservation){.mass = 2 - 0.25 * k,
                                 .momentum = {1 + k, 2, 3},
                                 .momentum_scale = 100 + k,
                                 .sound_scale = 7,
                                 .energy = -4 - k,
                                 .kinetic = 3 - 0.5 * k,
                                 .angular_momentum = {0, 5, 6 - 2 * k},
                                 .angular_scale = 1000,
                                 .turning_scale = 9};
}

/* At first every step is kept, then every second one, and so on. Entries are evenly spaced, begin
 * with the start, and keep values of the same time together. */
TEST(thins_evenly)
{
    static struct trace trace;
    trace = (struct trace){0};
    assert_true(trace_wants(&trace, 0) && trace_wants(&trace, 7));
    for (uint64_t step = 0; step <= 5 * TRACE_MAX; step++) {
        const struct conservation sums = sums_at((double)step);
        const uint64_t stride = step <= TRACE_MAX       ? 1
                                : step <= 2 * TRACE_MAX ? 2
                                : step <= 4 * TRACE_MAX ? 4
                                                        : 8;
        if (step) assert_true(trace_wants(&trace, step) == (step % trace.stride == 0));
        if (!trace_wants(&trace, step)) continue;
        trace_add(&trace, 0.5 * (double)step, &sums);
        if (step < TRACE_MAX) assert_true(trace.stride == 1 && trace.count == step + 1);
        if (step % TRACE_MAX) assert_true(trace.stride == stride);
        assert_true(trace.count <= TRACE_MAX);
        for (size_t k = 0; k < trace.count; k++) {
            const double at = (double)(k * trace.stride);
            assert_true(trace.time[k] == 0.5 * at && trace.sums[k].mass == sums_at(at).mass &&
                        trace.sums[k].energy == sums_at(at).energy);
        }
    }
    assert_int_equal(trace.stride, 8);
    assert_int_equal(trace.count, 5 * TRACE_MAX / 8 + 1);
}

/* The end replaces an entry of the same time, and no other one. */
TEST(end_replaces_an_entry)
{
    static struct trace trace;
    const struct regularity a = {.nearest = 1}, b = {.nearest = 2};
    trace = (struct trace){0};
    for (int k = 0; k < 3; k++) {
        const struct conservation sums = sums_at(k);
        trace_add(&trace, k < 2 ? k : 1, &sums);
    }
    assert_int_equal(trace.count, 2);
    assert_true(trace.time[0] == 0 && trace.time[1] == 1);
    assert_true(trace.sums[0].mass == 2 && trace.sums[1].mass == 1.5);
    trace_see(&trace, 0, &a);
    trace_see(&trace, 1, &a);
    trace_see(&trace, 1, &b);
    assert_int_equal(trace.looks, 2);
    assert_true(trace.looked[0] == 0 && trace.looked[1] == 1);
    assert_true(trace.seen[0].nearest == 1 && trace.seen[1].nearest == 2);
}

/* Entries are made at the start, and at the first time at or after each sixteenth of the run. */
TEST(looks_at_even_times)
{
    static struct trace trace;
    const struct regularity any = {0};
    trace = (struct trace){0};
    for (size_t k = 0; k <= TRACE_LOOKS; k++) {
        const double due = 2 * (double)k / TRACE_LOOKS;
        if (k) assert_false(trace_looks(&trace, nextafter(due, 0), 2));
        assert_true(trace_looks(&trace, due, 2) && trace_looks(&trace, due + 0.01, 2));
        trace_see(&trace, due, &any);
    }
    assert_false(trace_looks(&trace, 2, 2) || trace_looks(&trace, 100, 2));
    trace_see(&trace, 3, &any); /* the end always adds an entry */
    assert_int_equal(trace.looks, TRACE_LOOKS + 2);
}

TEST(drifts)
{
    struct conservation start = sums_at(0), now = sums_at(1), end = sums_at(2);
    struct trace_drift drift;
    now.momentum[1] = 4, now.momentum[2] = 5; /* changes of 1, 2, 2 */
    now.angular_momentum[0] = 2, now.angular_momentum[1] = 4, now.angular_momentum[2] = 4;
    drift = trace_drift(&start, &now, &end);
    near_relative(drift.mass, 0.125, 1e-15);
    near_relative(drift.momentum, 3 / 102., 1e-15);
    near_relative(drift.angular_momentum, 3 / 1000., 1e-15);
    near_relative(drift.energy, 0.25, 1e-15);
    /* in 1D the absolute difference, however small */
    for (int sign = -1; sign <= 1; sign += 2) {
        now.momentum[0] = start.momentum[0] + sign * 0.5;
        now.momentum[1] = start.momentum[1], now.momentum[2] = start.momentum[2];
        near_relative(trace_drift(&start, &now, &end).momentum, 0.5 / 102, 1e-15);
    }
    start.momentum[0] = 0, now.momentum[0] = 1e-200;
    near_relative(trace_drift(&start, &now, &end).momentum, 1e-200 / 102, 1e-15);
    /* sound_scale and turning_scale replace negligible scales of momentum */
    end.momentum_scale = nextafter(1e-12 * end.sound_scale, 1);
    near_relative(trace_drift(&start, &now, &end).momentum, 1e-200 / 7e-12, 1e-12);
    end.momentum_scale = 1e-12 * end.sound_scale;
    near_relative(trace_drift(&start, &now, &end).momentum, 1e-200 / 7, 1e-15);
    end.angular_scale = 1e-12 * end.turning_scale;
    near_relative(trace_drift(&start, &now, &end).angular_momentum, 3 / 9., 1e-15);
}

static void is(const json_t *lists, const char *name, size_t k, double value)
{
    const double got = value_real(json_array_get(json_object_get(lists, name), k));
    if (!(fabs(got - value) <= 1e-14 * fabs(value)))
        fail_msg("%s %zu: %.17g, not %.17g", name, k, got, value);
}

/* Kinetic energies and momenta at uneven times, and the figures computed from them by hand. */
TEST(figures_of_motion)
{
    static const struct {
        double kinetic[5], momentum[5], rebound, asymmetry, centre;
    } rows[] = {
        {{8, 8, 8, 8, 8}, {1, 1, 1, 1, 1}, 0, 0, 0},
        {{8, 7, 6, 5, 4}, {0, 0, 0, 0, 0}, 0, 0.5, 0}, /* dissipation is not a rebound */
        {{8, 6, 7, 5, 5.5}, {1, 1, 1, 1, 1}, 0.125, 0.3125, 0},
        {{8, 9, 10, 9, 8}, {0, 2, 0, -2, 0}, 0.25, 0, 1}, /* forth and back */
        {{8, 8, 8, 8, 9}, {2, 2, 2, 2, 3}, 0.125, 0.125, 0.25},
        {{0, 1, 2, 3, 4}, {0, 1, 2, 3, 4}, (double)NAN, (double)NAN, 4},
    };
    static const double times[] = {0, 1, 2, 3, 4};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        static struct trace trace;
        trace = (struct trace){0};
        assert_true(isnan(trace_motion(&trace).centre));
        for (size_t k = 0; k < 5; k++) {
            const struct conservation sums = {.mass = 2,
                                              .momentum = {0, rows[r].momentum[k], 0},
                                              .momentum_scale = 1,
                                              .energy = 10 + 1e-3 * (double)(k == 2),
                                              .kinetic = rows[r].kinetic[k]};
            trace_add(&trace, times[k], &sums);
        }
        const struct trace_motion motion = trace_motion(&trace);
        if (isnan(rows[r].rebound)) {
            assert_true(isnan(motion.rebound) && isnan(motion.asymmetry));
        } else {
            near_absolute(motion.rebound, rows[r].rebound, 1e-14);
            near_absolute(motion.asymmetry, rows[r].asymmetry, 1e-14);
        }
        near_absolute(motion.centre, rows[r].centre, 1e-14);
        /* of all entries, not only of the last */
        near_relative(trace_worst(&trace).energy, 1e-4, 1e-10);
        assert_true(trace_worst(&trace).mass == 0);
    }
}

/* A run of a steady vortex reports how its motion decays. A boost does not count as motion, and a
 * tube has no such figures. */
TEST(motion_of_a_vortex)
{
    struct run_result result = traced(NULL, "gresho", "n=12^2 t_end=0.5"),
                      moving = traced(NULL, "gresho", "n=12^2 t_end=0.5 boost=1,0.5"),
                      tube = traced(NULL, "sod", "n=40");
    assert_true(result.motion.rebound >= 0 && result.motion.asymmetry > 1e-4);
    assert_true(result.motion.centre < 1e-12 && result.motion.asymmetry < 1);
    /* the boost is not motion of the flow */
    assert_true(fabs(moving.motion.asymmetry / result.motion.asymmetry - 1) < 0.2);
    assert_true(isnan(tube.motion.rebound));
    run_free(&result);
    run_free(&moving);
    run_free(&tube);
}

TEST(document_of_a_trace)
{
    static struct trace trace;
    trace = (struct trace){0};
    for (int k = 0; k < 3; k++) {
        const struct conservation sums = sums_at(k);
        trace_add(&trace, 0.25 * k, &sums);
    }
    for (int k = 0; k < 2; k++) {
        const struct regularity seen = {k + 1, k + 2, k + 3, k + 4, k + 5};
        trace_see(&trace, 0.5 * k, &seen);
    }
    json_t *json = trace_json(&trace, 2);
    const json_t *regularity = json_object_get(json, "regularity");
    assert_int_equal(json_object_size(json), 8);
    assert_int_equal(json_object_size(regularity), 6);
    for (size_t k = 0; k < 3; k++) {
        const double x = (double)k;
        is(json, "time", k, 0.25 * x);
        is(json, "mass", k, 0.125 * x);
        is(json, "momentum", k, x / 102);
        is(json, "angular_momentum", k, 2 * x / 1000);
        is(json, "energy", k, x / 4);
        is(json, "kinetic", k, -0.125 * x);
        is(json, "potential", k, -0.125 * x);
    }
    static const char *const names[] = {"nearest", "spread", "paired", "density", "gradient"};
    for (size_t k = 0; k < 2; k++) {
        is(regularity, "time", k, 0.5 * (double)k);
        for (size_t i = 0; i < 5; i++) is(regularity, names[i], k, (double)(k + 1 + i));
    }
    static const char *const lists[] = {"time", "mass", "momentum", "angular_momentum", "energy"};
    for (size_t i = 0; i < 5; i++) {
        assert_int_equal(json_array_size(json_object_get(json, lists[i])), 3);
        assert_int_equal(json_array_size(json_object_get(regularity, names[i])), 2);
    }
    json_decref(json);
    json = trace_json(&trace, 1);
    assert_true(json_is_null(json_object_get(json, "angular_momentum")));
    json_decref(json);
    json = trace_json(&trace, 3);
    assert_true(json_is_array(json_object_get(json, "angular_momentum")));
    json_decref(json);
    trace = (struct trace){0};
    json = trace_json(&trace, 2);
    assert_int_equal(json_array_size(json_object_get(json, "time")), 0);
    assert_int_equal(json_object_size(json_object_get(json, "regularity")), 1);
    json_decref(json);
}
