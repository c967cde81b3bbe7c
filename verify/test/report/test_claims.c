/* SPDX-License-Identifier: GPL-3.0-or-later
 * Claims of a report: every run of theirs can be made, by day and by night, both runs of a row
 * differ in one key only, and the verdict follows from the figures, here made up ones. */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
/* after the four that it needs */

#include "claims.h"
#include "value.h"

/* Errors of the runs without and with what is claimed, over and over; 9: broke down, NaN: a
 * document without the figure. */
static void invent(struct pool *pool, const double *values)
{
    for (size_t i = 0; i < pool->count; i++) {
        const double value = values[i % 2];
        json_decref(pool->jobs[i].document);
        pool->jobs[i].document =
            isnan(value) ? json_pack("{s:s, s:[]}", "status", "ok", "functionals")
                         : json_pack("{s:s, s:[{s:s, s:f, s:f}, {s:s, s:f, s:f}]}", "status",
                                     value < 9 ? "ok" : "broke_down", "functionals", "name",
                                     "growth_rate", "value", 2 * (1 - value), "reference", 2.,
                                     "name", "velocity_rms", "value", value, "reference", 0.);
        assert_non_null(pool->jobs[i].document);
    }
}

struct planned {
    struct claims claims;
    struct pool pool;
};

/* What is said of every claim, and of its rows, with such errors. */
static void expect(struct planned *planned, double without, double with, const char *word)
{
    invent(&planned->pool, (double[]){without, with});
    json_t *judged = claims_judge(&planned->claims, &planned->pool), *claim, *row;
    size_t c, r, rows = 0;
    json_array_foreach(judged, c, claim) {
        assert_string_equal(value_text(claim, "verdict"), strcmp(word, "no difference") == 0
                                                              ? "does not hold"
                                                          : strcmp(word, "nothing to compare") == 0
                                                              ? "not shown: nothing to compare"
                                                              : word);
        json_array_foreach(json_object_get(claim, "rows"), r, row) {
            assert_string_equal(value_text(row, "verdict"), word);
            if (with < 9) assert_true(fabs(value_member(row, "with") - with) <= 1e-12);
            rows++;
        }
    }
    assert_true(c >= 3);
    assert_int_equal(2 * rows, planned->pool.count);
    json_decref(judged);
}

TEST(verdicts_follow_from_figures)
{
    struct planned planned = {0};
    struct error error;
    if (claims_plan(&planned.claims, true, &planned.pool, &error)) fail_msg("%s", error.message);
    expect(&planned, 0.2, 0.1, "holds");
    expect(&planned, 0.1, 0.2, "does not hold");
    expect(&planned, 0.11, 0.1, "no difference");
    expect(&planned, 0.1, 0.11, "no difference");
    expect(&planned, 9, 0.1, "holds");
    expect(&planned, 0.1, 9, "does not hold");
    expect(&planned, 9, 9, "nothing to compare");
    expect(&planned, (double)NAN, 0.1, "nothing to compare");
    expect(&planned, 0.1, (double)NAN, "nothing to compare");
    claims_free(&planned.claims);
    pool_free(&planned.pool);
}

TEST(runs_can_be_made)
{
    struct planned planned = {0};
    const struct pool *pool = &planned.pool;
    struct error error;
    if (claims_plan(&planned.claims, false, &planned.pool, &error)) fail_msg("%s", error.message);
    for (size_t i = 0; i + 1 < pool->count; i += 2)
        if (strcmp(pool->jobs[i].key, pool->jobs[i + 1].key) == 0)
            fail_msg("both runs of %s are the same", pool->jobs[i].name);
    claims_free(&planned.claims);
    pool_free(&planned.pool);
}
