/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a run leaves of itself through time ends with what the run says of its end, and knows what
 * jittered particles that come to rest do. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* after the four that it needs */
#include <cmocka.h>

#include <math.h>

#include "run.h"
#include "value.h"

static void run(struct run_result *result, struct trace *trace, const char *name, int n,
                char *const *arguments)
{
    struct run_settings settings;
    struct run run;
    struct error error;
    if (run_prepare(&settings, name, n, arguments, &error) || run_resolve(&run, &settings, &error))
        fail_msg("%s", error.message);
    run.asked.threads = 1;
    run.asked.trace = trace;
    if (run_execute(&run, result, &error)) fail_msg("%s", error.message);
}

static void same(double a, double b)
{
    if (!(fabs(a - b) <= 1e-9 * fabs(a))) fail_msg("%.17g is not %.17g", a, b);
}

static double last(const json_t *list)
{
    return value_real(json_array_get(list, json_array_size(list) - 1));
}

static void ends_with_the_run(void **state)
{
    char *const keys[] = {"n=12^2", "t_end=0.5"};
    struct trace trace = {0};
    struct run_result result;
    (void)state;
    run(&result, &trace, "rest_2d", 2, keys);
    const struct regularity *start = &trace.seen[0], *end = &trace.seen[trace.looks - 1];
    assert_true(trace.looks >= 8 && trace.looks <= TRACE_LOOKS + 2);
    same(trace.looked[trace.looks - 1], result.time);
    for (size_t k = 1; k < trace.looks; k++) assert_true(trace.looked[k] > trace.looked[k - 1]);
    same(end->nearest, result.regularity.nearest);
    same(end->spread, result.regularity.spread);
    same(end->gradient, result.regularity.gradient);
    /* what the jitter of 0.2 has done is undone */
    assert_true(start->spread > 0.1 && end->spread < 0.5 * start->spread);
    json_t *through = trace_json(&trace, 2);
    same(last(json_object_get(through, "angular_momentum")), result.angular_momentum);
    same(last(json_object_get(json_object_get(through, "regularity"), "gradient")), end->gradient);
    assert_int_equal(json_array_size(json_object_get(through, "time")), trace.count);
    json_decref(through);
    run_free(&result);
}

static void on_a_line(void **state)
{
    char *const keys[] = {"n=40", "t_end=0.02"};
    struct trace trace = {0};
    struct run_result result;
    (void)state;
    run(&result, &trace, "sod", 2, keys);
    json_t *through = trace_json(&trace, 1);
    assert_true(json_is_null(json_object_get(through, "angular_momentum")));
    /* of few steps each is seen once */
    assert_true(trace.looks >= 2 && trace.looks <= result.cost.steps + 1);
    for (size_t k = 1; k < trace.looks; k++) assert_true(trace.looked[k] > trace.looked[k - 1]);
    json_decref(through);
    run_free(&result);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ends_with_the_run),
        cmocka_unit_test(on_a_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
