/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the summary of matrices after a run: sums over particles, matrices that belong to the final
 * state, and the text and JSON, with and without matrices. */
#include "test.h"

#include "run_output.h"
#include "solver.h"

static const struct description *described; /* the list ends at a condition below 0 */
static int made;

static void describe(const struct simulation *simulation, description_visit *visit, void *context)
{
    (void)simulation;
    for (size_t i = 0; described[i].condition >= 0 || isnan(described[i].condition); i++)
        visit(context, i, &described[i]);
}

static void make(struct simulation *simulation)
{
    made++;
    simulation->cost.pair_interactions += 99;
}

static const struct sums known = {.describe = describe, .matrix = make};

/* Largest values and means over the matrices that are used, some of which have no angle; the others
 * are counted. */
TEST(sums_over_particles)
{
    static const struct description mixed[] = {{5, 3, 20},
                                               {5, DESCRIPTION_CONDITION, (double)NAN},
                                               {5, 1000.0001, (double)NAN},
                                               {5, (double)NAN, 40},
                                               {5, 2, 10},
                                               {5, 2.5, 12},
                                               {5, HUGE_VAL, 170},
                                               {5, -1, 0}},
                                    bad[] = {{5, HUGE_VAL, 170}, {5, -1, 0}};
    const struct integrator plain = {0};
    struct simulation s = {.plan = {.dim = 2, .sums = &known, .matrix = true},
                           .scheme.integrator = &plain};
    described = mixed;
    struct description_sums sums = description_sum(&s);
    assert_true(sums.condition_max == 1000 && sums.condition_mean == 1007.5 / 4);
    assert_true(sums.angle_max == 20 && sums.angle_mean == 14 && sums.fallen_back == 3);
    described = bad;
    sums = description_sum(&s);
    assert_true(isnan(sums.condition_max) && isnan(sums.condition_mean));
    assert_true(isnan(sums.angle_max) && isnan(sums.angle_mean) && sums.fallen_back == 1);
    s.plan.matrix = false;
    described = mixed;
    sums = description_sum(&s);
    assert_true(isnan(sums.condition_max) && isnan(sums.condition_mean));
    assert_true(isnan(sums.angle_max) && isnan(sums.angle_mean) && sums.fallen_back == 0);
    assert_int_equal(made, 0);
}

/* Matrices are computed again if a step has ended with an evaluation of another kind than of rates;
 * that is not counted as cost. */
TEST(matrices_of_the_state)
{
    static const struct description one[] = {{5, 3, 20}, {5, -1, 0}};
    described = one;
    for (uint64_t steps = 0; steps < 2; steps++)
        for (int ends = 0; ends < 2; ends++) {
            const struct integrator integrator = {.ends_evaluated = ends};
            struct simulation s = {.plan = {.dim = 2, .sums = &known, .matrix = true},
                                   .cost = {.steps = steps, .pair_interactions = 7},
                                   .scheme.integrator = &integrator};
            made = 0;
            assert_true(description_sum(&s).condition_max == 3);
            assert_int_equal(made, steps && !ends);
            assert_int_equal(s.cost.pair_interactions, 7);
        }
}

TEST(words_and_documents)
{
    static const struct {
        struct description_sums sums;
        const char *text, *json; /* "": null */
    } rows[] = {
        {{(double)NAN, (double)NAN, (double)NAN, (double)NAN, 0}, "", ""},
        {{2.5, 1.25, 12, 3.5, 0},
         "condition number 2.5 (mean 1.25); angle between C x and x 12 deg (mean 3.5)",
         "{\"condition\": {\"max\": 2.5, \"mean\": 1.25}, \"angle\": {\"max\": 12.0, \"mean\": "
         "3.5}, "
         "\"fallen_back\": 0}"},
        {{2.5, 1.25, 12, 3.5, 1},
         "condition number 2.5 (mean 1.25); angle between C x and x 12 deg (mean 3.5); 1 of 9 "
         "particles with the standard gradient instead",
         "{\"condition\": {\"max\": 2.5, \"mean\": 1.25}, \"angle\": {\"max\": 12.0, \"mean\": "
         "3.5}, "
         "\"fallen_back\": 1}"},
        {{(double)NAN, (double)NAN, (double)NAN, (double)NAN, 9},
         "9 of 9 particles with the standard gradient instead",
         "{\"condition\": {\"max\": null, \"mean\": null}, \"angle\": {\"max\": null, \"mean\": "
         "null}, \"fallen_back\": 9}"},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char text[DESCRIPTION_TEXT] = "before";
        json_t *json = description_json(&rows[k].sums), *want = json_loads(rows[k].json, 0, NULL);
        description_text(&rows[k].sums, 9, text);
        assert_string_equal(text, rows[k].text);
        assert_true(want ? json_equal(json, want) : json_is_null(json));
        json_decref(json);
        json_decref(want);
    }
}
