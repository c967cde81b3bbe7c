/* SPDX-License-Identifier: GPL-3.0-or-later
 * Claims of a report: every run of theirs can be made, by day and by night, both runs of a row
 * differ in one key only, and the verdict follows from the figures, here made up ones. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
/* after the four that it needs */
#include <cmocka.h>

#include "claims.h"
#include "value.h"

/* Errors of the runs without and with what is claimed, over and over. */
static void invent(struct pool *pool, const double *values)
{
    for (size_t i = 0; i < pool->count; i++) {
        const double value = values[i % 2];
        pool->jobs[i].document = json_pack(
            "{s:s, s:{s:f, s:f}, s:{s:f, s:f}}", "status", value < 9 ? "ok" : "broke_down",
            "functionals", "growth_rate", 2 * (1 - value), "velocity_rms", value,
            "functionals_exact", "growth_rate", 2., "velocity_rms", 0.);
        assert_non_null(pool->jobs[i].document);
    }
}

/* What is said of every claim, and of its rows, with such errors. */
static void expect(double without, double with, const char *word)
{
    struct claims claims = {0};
    struct pool pool = {0};
    struct error error;
    assert_int_equal(claims_plan(&claims, false, &pool, &error), STATUS_OK);
    invent(&pool, (double[]){without, with});
    json_t *judged = claims_judge(&claims, &pool), *claim, *row;
    size_t c, r, rows = 0;
    json_array_foreach(judged, c, claim)
    {
        assert_string_equal(value_text(claim, "verdict"),
                            strcmp(word, "no difference") == 0 ? "does not hold" : word);
        json_array_foreach(json_object_get(claim, "rows"), r, row)
        {
            assert_string_equal(value_text(row, "verdict"), word);
            if (with < 9) assert_true(fabs(value_member(row, "with") - with) <= 1e-12);
            rows++;
        }
    }
    assert_true(c >= 3);
    assert_int_equal(2 * rows, pool.count);
    json_decref(judged);
    claims_free(&claims);
    pool_free(&pool);
}

static void verdicts_follow_from_figures(void **state)
{
    (void)state;
    expect(0.2, 0.1, "holds");
    expect(0.1, 0.2, "does not hold");
    expect(0.11, 0.1, "no difference");
    expect(0.1, 0.11, "no difference");
    expect(9, 0.1, "holds");
    expect(0.1, 9, "does not hold");
}

static void runs_can_be_made(void **state)
{
    (void)state;
    for (int nightly = 0; nightly < 2; nightly++) {
        struct claims claims = {0};
        struct pool pool = {0};
        struct error error;
        if (claims_plan(&claims, nightly, &pool, &error)) fail_msg("%s", error.message);
        for (size_t i = 0; i + 1 < pool.count; i += 2)
            if (strcmp(pool.jobs[i].key, pool.jobs[i + 1].key) == 0)
                fail_msg("both runs of %s are the same", pool.jobs[i].name);
        claims_free(&claims);
        pool_free(&pool);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(verdicts_follow_from_figures),
        cmocka_unit_test(runs_can_be_made),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
