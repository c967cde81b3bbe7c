/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests that checks which ran separately can be joined into one suite. */
#include "test.h"

#include "sample_checks.h"

/* The document of a suite without times. */
static json_t *reported(const struct suite *suite)
{
    json_t *document = suite_keep(suite), *checks = json_object_get(document, "checks");
    for (size_t i = 0; i < json_array_size(checks); i++)
        json_object_del(json_array_get(checks, i), "seconds");
    json_object_del(document, "seconds");
    return document;
}

/* Checks that ran separately give, joined, the document of one suite. */
TEST(joined_documents)
{
    enum { PARTS = 4 };
    const struct check *const checks[PARTS] = {&good, &failing, &leaky, &vacuous};
    const struct suite_choice choice = {.mutants = true};
    struct suite suite, joined;
    struct error error;
    json_t *documents[PARTS];
    for (size_t i = 0; i < PARTS; i++) {
        suite_run(&suite, &checks[i], 1, &choice, NULL);
        documents[i] = suite_keep(&suite);
        suite_free(&suite);
        char *text = json_dumps(documents[i], JSON_REAL_PRECISION(17));
        json_decref(documents[i]);
        documents[i] = json_loads(text, 0, NULL);
        free(text);
    }
    const json_t *const *from = (const json_t *const *)documents;
    assert_int_equal(suite_run(&suite, checks, PARTS, &choice, NULL), STATUS_CHECK_FAILED);
    assert_int_equal(suite_join(&joined, checks, from, PARTS, &error), STATUS_CHECK_FAILED);
    json_t *one = reported(&suite), *other = reported(&joined);
    assert_true(json_equal(one, other));
    assert_int_equal(joined.failed, 3);
    assert_int_equal(joined.series_count, suite.series_count);
    assert_true(joined.series_count > 0 && joined.series[0].check == &failing);
    assert_true(isnan(joined.figures[3].value) && joined.figures[3].status == FINDING_FAIL);
    suite_free(&joined);
    assert_int_equal(suite_join(&joined, checks, from, 1, &error), STATUS_OK);
    suite_free(&joined);
    assert_int_equal(suite_join(&joined, checks + 1, from, 1, &error), STATUS_ENVIRONMENT);
    assert_null(joined.figures);
    /* the total time is the sum over all parts */
    for (size_t i = 0; i < PARTS; i++)
        json_object_set_new(documents[i], "seconds", json_real(1 << i));
    assert_int_equal(suite_join(&joined, checks, from, PARTS, &error), STATUS_CHECK_FAILED);
    assert_true(joined.seconds == 15);
    json_t *again = suite_keep(&joined);
    assert_true(json_real_value(json_object_get(again, "seconds")) == 15);
    json_decref(again);
    suite_free(&joined);
    /* a series has its own length */
    const json_t *curve = json_array_get(json_object_get(documents[1], "series"), 0);
    assert_int_equal(json_array_size(json_object_get(curve, "x")), 2);
    assert_true(json_real_value(json_array_get(json_object_get(curve, "y"), 0)) == 3);
    /* words that this program does not use */
    static const char *const lists[] = {"checks",  "checks",  "checks",
                                        "mutants", "mutants", "checks"},
                             *const keys[] = {"status", "name",  "group",
                                              "mutant", "check", "status"};
    for (size_t k = 0; k < 6; k++) {
        json_t *entry = json_array_get(json_object_get(documents[0], lists[k]), 0);
        json_t *right = json_incref(json_object_get(entry, keys[k]));
        json_object_set_new(entry, keys[k], json_string(k < 5 ? "other" : "known"));
        assert_int_equal(suite_join(&joined, checks, from, 1, &error), STATUS_ENVIRONMENT);
        assert_string_equal(error.message, "verify: what is kept of a/good is not of this program, "
                                           "or there is no memory for it");
        json_object_set_new(entry, keys[k], right);
    }
    struct check harmless = good; /* the same check without its mutants */
    harmless.mutants = NULL;
    assert_int_equal(suite_join(&joined, (const struct check *const[]){&harmless}, from, 1, &error),
                     STATUS_ENVIRONMENT);
    json_array_clear(json_object_get(documents[0], "checks")); /* a check without figures */
    assert_int_equal(suite_join(&joined, checks, from, 1, &error), STATUS_ENVIRONMENT);
    json_decref(one);
    json_decref(other);
    suite_free(&suite);
    for (size_t i = 0; i < PARTS; i++) json_decref(documents[i]);
}
