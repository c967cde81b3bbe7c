/* SPDX-License-Identifier: GPL-3.0-or-later
 * The verdict, the JUnit file and the summary of results in which every count is another one and
 * every way to fail is there: word for word as written down in data/verdict. And nothing checked,
 * or one thing alone. */
#include "test.h"

#include <stdio.h>
#include <string.h>

#include "findings.h"
#include "summary.h"
#include "verdict.h"

static const char *folder;

static json_t *load(const char *name)
{
    char path[4096];
    json_error_t error;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    json_t *document = json_load_file(path, 0, &error);
    if (!document) fail_msg("%s:%d: %s", path, error.line, error.text);
    return document;
}

/* The text is that of the file; where it is not, says from where on. */
static void compare(const char *text, const char *name)
{
    static char expected[1 << 16];
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    expected[fread(expected, 1, sizeof expected - 1, file)] = 0;
    fclose(file);
    size_t at = 0;
    while (text[at] && text[at] == expected[at]) at++;
    if (text[at] != expected[at])
        fail_msg("%s, byte %zu: expected\n%.200s\nfound\n%.200s", name, at, expected + at,
                 text + at);
}

static json_t *judged(void)
{
    json_t *results = load("results.json");
    json_object_set_new(results, "verdict", verdict_make(results));
    return results;
}

TEST(verdict)
{
    json_t *results = judged(), *expected = load("verdict.json");
    char *text = json_dumps(json_object_get(results, "verdict"), JSON_INDENT(1) | JSON_SORT_KEYS),
         *same = json_dumps(expected, JSON_INDENT(1) | JSON_SORT_KEYS);
    assert_string_equal(text, same);
    free(text);
    free(same);
    json_decref(expected);
    json_decref(results);
}

TEST(junit)
{
    json_t *results = judged();
    char *text = findings_junit(findings_of_report, results);
    compare(text, "junit.xml");
    free(text);
    json_decref(results);
}

TEST(summary)
{
    json_t *results = judged();
    char *text = summary_text(results);
    compare(text, "summary.md");
    free(text);
    json_decref(results);
}

/* A run whose gate fails is a failure of the report and of its JUnit file, and of a rank of its
 * own. */
TEST(gates_in_junit)
{
    json_t *results =
        json_pack("{s:[{s:s, s:s, s:s, s:[{s:s, s:s, s:f, s:f}, {s:s, s:s, s:f, s:f}]}]}", "runs",
                  "status", "ok", "case", "sod", "label", "mine", "gates", "name", "density_l1",
                  "status", "fail", "value", 0.25, "bound", 0.125, "name", "energy", "status",
                  "pass", "value", 0., "bound", 1.);
    json_object_set_new(results, "verdict", verdict_make(results));
    char *text = findings_junit(findings_of_report, results);
    assert_non_null(strstr(text, "<testsuite name=\"gate\" tests=\"2\" failures=\"1\""));
    assert_non_null(
        strstr(text, "name=\"mine: density_l1\"><failure message=\"the error of the run, 0.25,"));
    free(text);
    json_decref(results);
    /* one that breaks down says less than the bound that another exceeds */
    results = json_pack("{s:[{s:s, s:s}, {s:s, s:s, s:[{s:s, s:s}]}]}", "runs", "status",
                        "broke_down", "case", "noh_2d", "status", "ok", "case", "sod", "gates",
                        "name", "density_l1", "status", "fail");
    json_t *made = verdict_make(results),
           *first = json_array_get(json_object_get(made, "failures"), 0);
    assert_string_equal(json_string_value(json_object_get(first, "area")), "gate");
    json_decref(made);
    json_decref(results);
}

/* Twenty failures are listed, the rest is counted. */
TEST(long_summary)
{
    for (size_t count = 20; count <= 22; count++) {
        json_t *results = json_pack("{s:{s:s, s:[]}}", "verdict", "headline", "bad", "failures");
        json_t *list = json_object_get(json_object_get(results, "verdict"), "failures");
        for (size_t i = 0; i < count; i++)
            json_array_append_new(
                list, json_pack("{s:s, s:s, s:s}", "name", "n", "detail", "d", "command", "c"));
        char *text = summary_text(results), more[64];
        size_t lines = 0;
        for (const char *at = text; (at = strstr(at, "\n- **n** d (`c`)")); at++) lines++;
        assert_int_equal(lines, 20);
        snprintf(more, sizeof more, "\n- … and %zu more\n\n", count - 20);
        assert_int_equal(strstr(text, more) != NULL, count > 20);
        assert_int_equal(strstr(text, "more") != NULL, count > 20);
        assert_null(strstr(text, "| case |")); /* no table of no studies */
        free(text);
        json_decref(results);
    }
}

/* What alone makes a verdict: one figure that passed, one order, one run; faults do not. */
TEST(alone)
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
        {"{'trouble': [{'name': 'a', 'message': 'b'}]}", "fail", "1 failure: harness a"},
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

/* What runs have to keep is counted, and told with the run that does not keep it. */
TEST(gates_of_runs)
{
    json_t *results = json_pack(
        "{s:[{s:s, s:s, s:s, s:s, s:[{s:s}, {s:s}, {s:s}, {s:s}, {s:s}, {s:s, s:s, s:f, s:f}, "
        "{s:s, s:s, s:s, s:f}]}]}",
        "runs", "status", "ok", "case", "tube", "label", "n=100", "reproduce", "sphproof run tube",
        "gates", "status", "pass", "status", "pass", "status", "pass", "status", "known", "status",
        "none", "status", "fail", "name", "energy", "value", 0.5, "bound", 0.25, "status", "fail",
        "name", "momentum", "value", "nan", "bound", 0.125);
    json_t *made = verdict_make(results);
    const json_t *failures = json_object_get(made, "failures");
    assert_int_equal(json_integer_value(json_object_get(made, "gates_passed")), 3);
    assert_int_equal(json_integer_value(json_object_get(made, "gates_failed")), 2);
    assert_int_equal(json_array_size(failures), 2);
    static const char *const names[] = {"tube, n=100: energy", "tube, n=100: momentum"},
                             *const details[] = {"the error of the run, 0.5, is not <= 0.25",
                                                 "the error of the run, nan, is not <= 0.125"};
    for (size_t k = 0; k < 2; k++) {
        const json_t *failure = json_array_get(failures, k);
        assert_string_equal(json_string_value(json_object_get(failure, "name")), names[k]);
        assert_string_equal(json_string_value(json_object_get(failure, "detail")), details[k]);
        assert_string_equal(json_string_value(json_object_get(failure, "command")),
                            "sphproof run tube");
    }
    json_decref(made);
    json_decref(results);
    /* a word that is none is told with the case that has it */
    results = json_pack("{s:[{s:s, s:s, s:[{s:s}]}]}", "runs", "status", "ok", "case", "tube",
                        "gates", "status", "odd");
    made = verdict_make(results);
    assert_string_equal(json_string_value(json_object_get(made, "headline")),
                        "1 failure: harness tube");
    const json_t *trouble = json_array_get(json_object_get(made, "failures"), 0);
    assert_non_null(strstr(json_string_value(json_object_get(trouble, "detail")), "none"));
    assert_int_equal(json_integer_value(json_object_get(made, "gates_failed")), 0);
    json_decref(made);
    json_decref(results);
}

/* A check is told by the figure that is farthest beyond its bound, in units of it; no number is
 * farther than any. And passed, failed and skipped ones are different numbers. */
TEST(farthest)
{
    static const struct {
        const char *last, *told;
    } rows[] = {{"'value': 0.5, 'bound': 0.125", "c"},
                {"'value': 0.5, 'bound': 0.5", "b"},
                {"'value': 'nan', 'bound': 1", "c"},
                {"'value': 1, 'bound': 0", "c"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char text[1024];
        snprintf(text, sizeof text,
                 "{'verify': {'checks': ["
                 "{'group': 'g', 'name': 'n', 'subject': 'a', 'status': 'pass'},"
                 "{'group': 'g', 'name': 'n', 'subject': 'b', 'status': 'fail', 'value': 3, "
                 "'bound': 1}, {'group': 'g', 'name': 'n', 'subject': 'c', 'status': 'fail', %s}]},"
                 "'faults': {'faults': [{'status': 'pass'}, {'status': 'fail'}, {'status': 'fail'},"
                 "{'status': 'skip'}]}}",
                 rows[k].last);
        for (char *c = text; *c; c++)
            if (*c == '\'') *c = '"';
        json_t *results = json_loads(text, 0, NULL);
        assert_non_null(results);
        json_t *made = verdict_make(results);
        const json_t *first = json_array_get(json_object_get(made, "failures"), 0);
        assert_string_equal(json_string_value(json_object_get(first, "subject")), rows[k].told);
        assert_int_equal(json_integer_value(json_object_get(made, "figures_passed")), 1);
        assert_int_equal(json_integer_value(json_object_get(made, "figures_failed")), 2);
        assert_int_equal(json_integer_value(json_object_get(made, "faults_right")), 1);
        assert_int_equal(json_integer_value(json_object_get(made, "faults")), 3);
        json_decref(made);
        json_decref(results);
    }
}

/* A long subject is cut at the end of a word, whose comma goes as well. */
TEST(cut)
{
    static const struct {
        const char *subject, *told;
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
        const char *told = json_string_value(json_object_get(made, "headline"));
        assert_string_equal(told, rows[k].told);
        json_decref(made);
        json_decref(results);
    }
}

int main(int argc, char **argv)
{
    folder = argc > 1 ? argv[1] : "";
    return test_run(NULL, NULL);
}
