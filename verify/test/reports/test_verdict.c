/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests verdicts on results with nothing checked or with a single figure, and truncated headlines.
 * (test_page_drawn.c tests whole verdicts, JUnit files and summaries.) */
#include "test.h"

#include "result.h"
#include "verdict.h"

/* Results that suffice for a verdict: one figure that passed, one order, one run; faults alone do
 * not. */
TEST(least_results_for_a_verdict)
{
    static const struct {
        const char *text, *status, *headline;
    } rows[] = {
        {"{}", "fail", "Nothing was checked"},
        {"{'verify': {'checks': [{'status': 'pass', 'name': 'a'}]}}", "pass", "All is well"},
        {"{'verify': {'checks': [{'status': 'skip', 'name': 'a'}]}}", "fail",
         "Nothing was checked"},
        {"{'verify': {'mutants': [{'detected': true}]}}", "fail", "Nothing was checked"},
        {"{'studies': [{'orders': [{'status': 'pass'}]}]}", "pass", "All is well"},
        {"{'studies': [{'orders': [{'status': 'none'}]}]}", "fail", "Nothing was checked"},
        {"{'studies': [{'budgets': [{'still_gas': {'status': 'pass'}}]}]}", "pass", "All is well"},
        {"{'runs': [{'status': 'ok'}]}", "pass", "All is well"},
        {"{'runs': [{'status': 'ok', 'gates': [{'status': 'pass'}, {'status': 'known'}]}]}", "pass",
         "All that could be judged is well: 1 judged, 1 known weakness"},
        {"{'runs': [{'status': 'ok', 'gates': [{'status': 'smoke'}, {'status': 'smoke'}, "
         "{'status': 'pass'}]}], 'studies': [{'orders': [{'status': 'undetermined'}, "
         "{'status': 'known'}, {'status': 'known'}, {'status': 'none'}]}]}",
         "pass",
         "All that could be judged is well: 1 judged, 2 too coarse to judge, 1 undetermined, "
         "2 known weaknesses"},
        {"{'runs': [{'status': 'ok', 'gates': [{'status': 'smoke'}, {'status': 'pass'}]}]}", "pass",
         "All that could be judged is well: 1 judged, 1 too coarse to judge"},
        {"{'studies': [{'orders': [{'status': 'undetermined'}, {'status': 'pass'}]}]}", "pass",
         "All that could be judged is well: 1 judged, 1 undetermined"},
        {"{'studies': [{'orders': [{'status': 'undetermined'}]}]}", "fail", "Nothing was checked"},
        {"{'studies': [{'orders': [{'status': 'smoke'}]}]}", "fail", "Nothing was checked"},
        {"{'runs': [{'status': 'ok', 'case': 'c', 'label': 'l', 'gates': [{'status': 'fail', "
         "'name': 'energy', 'value': 'nan', 'bound': 1}]}]}",
         "fail", "1 failure: gate c, l: energy"},
        {"{'faults': {'faults': [{'status': 'pass'}]}}", "fail", "Nothing was checked"},
        {"{'runs': [{'status': 'ok'}], 'faults': {}}", "fail", "1 failure: harness faults.json"},
        {"{'verify': {'checks': [{'status': 'pass', 'name': 'a'}], 'mutants': [{'detected': false, "
         "'group': 'g', 'check': 'c', 'mutant': 'm'}]}}",
         "fail", "1 failure: detection c, m"},
        {"{'trouble': [{'name': 'a', 'message': 'b'}]}", "fail", "1 failure: harness a"},
        {"{'studies': [{'case': 'c', 'label': 'l', 'floors': [{}, {'suspicion': 'equal'}]}]}",
         "fail", "1 failure: suspicion c, l"},
        {"{'runs': [{'status': 'ok'}], 'stress': {'failures': [{'name': 'far', 'command': "
         "'sphproof stress', 'detail': 'worse'}]}}",
         "fail", "1 failure: stress far"},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char text[256];
        snprintf(text, sizeof text, "%s", rows[k].text);
        for (char *c = text; *c; c++)
            if (*c == '\'') *c = '"';
        json_t *results = json_loads(text, 0, NULL);
        assert_non_null(results);
        json_t *made = verdict_make(results);
        assert_string_equal(json_string_value(json_object_get(made, "status")), rows[k].status);
        assert_string_equal(json_string_value(json_object_get(made, "headline")), rows[k].headline);
        json_decref(made);
        json_decref(results);
    }
}

/* By how much a failed figure exceeds its bound; an equal one that failed is given as it is. */
TEST(words_on_an_excess)
{
    static const struct {
        double value, floor;
        const char *detail;
    } rows[] = {{2, 0, "s: 2 is not <= 1 (2 times the bound)"},
                {1, 0, "s: 1 is not <= 1"},
                {0.5, 1.5, "s: the floor 1.5 is not <= 1 (1.5 times the bound)"},
                {3, 1.5, "s: 3 is not <= 1 (3 times the bound)"},
                {(double)INFINITY, 0, "s: ∞ is not <= 1"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        json_t *results =
            json_pack("{s:{s:[{s:s, s:s, s:s, s:s, s:o, s:i, s:f}]}}", "verify", "checks", "group",
                      "g", "name", "c", "subject", "s", "status", "fail", "value",
                      result_number(rows[k].value), "bound", 1, "floor", rows[k].floor);
        json_t *made = verdict_make(results);
        const json_t *failure = json_array_get(json_object_get(made, "failures"), 0);
        assert_string_equal(json_string_value(json_object_get(failure, "detail")), rows[k].detail);
        json_decref(made);
        json_decref(results);
    }
}

/* A long subject is cut at the end of a word, and the comma after it is removed. */
TEST(long_subjects_are_cut)
{
    static const struct {
        const char *subject, *printed;
    } rows[] = {
        {"short", "1 failure: g: c (short)"},
        {"x broke down", "1 failure: g: c"},
        {"0123456789 123456789 123456789 123456789 123456789 123456789 abcd",
         "1 failure: g: c (0123456789 123456789 123456789 123456789 123456789 123456789 …)"},
        {"0123456789 123456789 123456789 123456789 123456789 123456789 abc",
         "1 failure: g: c (0123456789 123456789 123456789 123456789 123456789 123456789 abc)"},
        {"0123456789 123456789 123456789 123456789 123456789 1234567, 9 abcdef",
         "1 failure: g: c (0123456789 123456789 123456789 123456789 123456789 1234567, 9 …)"},
        {"0123456789 123456789 123456789 123456789 123456789 12345678, abcdefgh",
         "1 failure: g: c (0123456789 123456789 123456789 123456789 123456789 12345678 …)"},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        json_t *results = json_pack("{s:{s:[{s:s, s:s, s:s, s:s, s:i, s:i}]}}", "verify", "checks",
                                    "group", "g", "name", "c", "subject", rows[k].subject, "status",
                                    "fail", "value", 2, "bound", 1);
        json_t *made = verdict_make(results);
        const char *printed = json_string_value(json_object_get(made, "headline"));
        assert_string_equal(printed, rows[k].printed);
        json_decref(made);
        json_decref(results);
    }
}
