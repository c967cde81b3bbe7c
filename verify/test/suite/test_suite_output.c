/* SPDX-License-Identifier: GPL-3.0-or-later
 * What `verify` says of figures: table, JSON, JUnit file and headlines of a suite in which every
 * count is another one, word for word as written down in data/suite. */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "headline.h"
#include "suite_output.h"

static const char *folder;
static bool writing; /* the files anew, to be read before they are believed */

static const struct check_mutant minus = {"minus", "a sign", NULL},
                                 plus = {"plus", "<no> sign", NULL};
static const struct check
    sign = {.group = "kernels",
            .rank = 150,
            .says = "is negative or rises",
            .name = "sign",
            .property = "W >= 0"},
    moments = {.group = "kernels",
               .rank = 150,
               .name = "moments",
               .property = "sums",
               .slow = true},
    normalisation = {.group = "kernels", .rank = 100, .name = "normalisation", .property = "one"},
    continuity = {.group = "kernels", .rank = 150, .name = "continuity", .property = "smooth"},
    rates = {.group = "hydro", .rank = 708, .name = "rates", .property = "equal \"rates\""},
    idle = {.group = "hydro", .rank = 750, .name = "idle", .property = "none"};

#define FIGURE(check, subject, value, bound, floor, seconds, status)                               \
    {                                                                                              \
        &check, (char *)(uintptr_t)subject, value, bound, floor, seconds, status                   \
    }
static struct figure figures[] = {
    FIGURE(sign, "cubic, 1D: q < 1", 0.5, 1, 0.01, 0.25, FINDING_PASS),
    FIGURE(sign, "cubic, 2D: q > 1", 3, 1, 0.02, 0.5, FINDING_FAIL),
    FIGURE(sign, "cubic, 3D: q = 1", 2, 1, 0.03, 1, FINDING_FAIL),
    FIGURE(sign, "not here", 0, 0, 0, 2, FINDING_SKIP),
    FIGURE(sign, "other: all", 5, 4, 0.04, 4, FINDING_FAIL),
    FIGURE(moments, "cubic, 1D", 1, 0.125, 0.05, 8, FINDING_FAIL),
    FIGURE(moments, "other, 2D", (double)NAN, 0.5, 0.06, 16, FINDING_FAIL),
    FIGURE(normalisation, "cubic, 1D", 0.75, 0.25, 0.07, 32, FINDING_FAIL),
    FIGURE(continuity, "cubic", 7, 2, 0, 64, FINDING_FAIL),
    FIGURE(rates, "all\tof it", 0, 1, 0, 128, FINDING_PASS),
    FIGURE(rates, "some", 0.125, 0.5, 0.1, 256, FINDING_PASS),
    FIGURE(rates, "a & b", 0.25, 4, 0.1, 512, FINDING_PASS),
    FIGURE(idle, "why not", 0, 0, 0, 1024, FINDING_SKIP),
};
static struct mutant_outcome outcomes[] = {
    {&sign, &minus, 8, 2, true},
    {&sign, &plus, 0.5, 2, false},
    {&rates, &minus, 3, 2, true},
    {&rates, &plus, 5, 2, true},
};
static double x[] = {1, 2, 3}, y[] = {4, 5, (double)INFINITY};
static char label[] = "data";
static struct series series[] = {
    {&moments, label, 3, x, y}, {&moments, label, 2, y, x}, {&sign, label, 1, x, y}};
static const struct suite suite = {.figures = figures,
                                   .outcomes = outcomes,
                                   .series = series,
                                   .figure_count = sizeof figures / sizeof *figures,
                                   .outcome_count = sizeof outcomes / sizeof *outcomes,
                                   .series_count = sizeof series / sizeof *series,
                                   .passed = 4,
                                   .failed = 6,
                                   .skipped = 2,
                                   .mutants = 2,
                                   .mutants_detected = 1,
                                   .seconds = 12.25};

/* The text is that of the file; where it is not, says from where on. */
static void compare(const char *text, const char *name)
{
    static char expected[1 << 16];
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, writing ? "w+" : "r");
    assert_non_null(file);
    if (writing) fputs(text, file), rewind(file);
    expected[fread(expected, 1, sizeof expected - 1, file)] = 0;
    fclose(file);
    size_t at = 0;
    while (text[at] && text[at] == expected[at]) at++;
    if (text[at] != expected[at])
        fail_msg("%s, byte %zu: expected\n%.200s\nfound\n%.200s", name, at, expected + at,
                 text + at);
}

static void table_is(const struct suite *of, bool color, bool details, const char *name)
{
    char *text = NULL;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    assert_non_null(stream);
    suite_output_table(of, stream, color, details);
    fclose(stream);
    compare(text, name);
    free(text);
}

TEST(table)
{
    table_is(&suite, false, true, "table.txt");
    table_is(&suite, true, false, "colours.txt");
    struct suite well = suite; /* the last check but one, without mutants */
    well.figures += 9, well.figure_count = 3, well.outcome_count = 0;
    well.failed = 0, well.mutants_detected = well.mutants = 0;
    table_is(&well, true, true, "well.txt");
    well.mutants = 1; /* one that was not noticed */
    table_is(&well, false, true, "missed.txt");
}

TEST(json)
{
    json_t *document = json_object();
    suite_output_json(&suite, document);
    json_object_set_new(document, "headlines", headline_list(&suite));
    char *text = json_dumps(document, JSON_INDENT(1) | JSON_SORT_KEYS | JSON_REAL_PRECISION(12));
    compare(text, "suite.json");
    free(text);
    json_decref(document);
}

static void read_all(const char *path, char *text, size_t size)
{
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    text[fread(text, 1, size - 1, file)] = '\0';
    fclose(file);
    unlink(path);
}

TEST(junit)
{
    static char text[1 << 15];
    char path[] = "sphproof-junit-XXXXXX";
    const int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    assert_int_equal(suite_output_junit(&suite, path, NULL), STATUS_OK);
    read_all(path, text, sizeof text);
    compare(text, "junit.xml");
    assert_int_equal(suite_output_junit(&suite, "/nowhere/junit.xml", NULL), STATUS_ENVIRONMENT);
}

/* A file for each check that fails, with its series; one of an earlier failure goes. */
TEST(failures)
{
    char place[] = "sphproof-failures-XXXXXX", path[128];
    static char text[1 << 14];
    static const struct {
        const char *name;
        size_t checks, series;
    } rows[] = {{"kernels-sign", 5, 1},          {"kernels-moments", 2, 2},
                {"kernels-normalisation", 1, 0}, {"kernels-continuity", 1, 0},
                {"hydro-rates", 0, 0},           {"hydro-idle", 0, 0}};
    assert_non_null(mkdtemp(place));
    snprintf(path, sizeof path, "%s/hydro-rates.json", place);
    FILE *old = fopen(path, "w");
    assert_non_null(old);
    fclose(old);
    char *told = NULL, line[256];
    size_t size;
    FILE *stream = open_memstream(&told, &size);
    assert_non_null(stream);
    assert_int_equal(suite_output_failures(&suite, place, stream, NULL), STATUS_OK);
    fclose(stream);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        snprintf(path, sizeof path, "%s/%s.json", place, rows[i].name);
        assert_int_equal(access(path, F_OK) == 0, rows[i].checks > 0);
        snprintf(line, sizeof line, "figures and data: %s\n", path);
        assert_int_equal(strstr(told, line) != NULL, rows[i].checks > 0);
        if (!rows[i].checks) continue;
        read_all(path, text, sizeof text);
        json_t *document = json_loads(text, 0, NULL);
        const json_t *checks = json_object_get(document, "checks"),
                     *curves = json_object_get(document, "series");
        assert_int_equal(json_array_size(checks), rows[i].checks);
        assert_int_equal(json_array_size(curves), rows[i].series);
        for (size_t k = 0; k < rows[i].series; k++) {
            const json_t *curve = json_array_get(curves, k);
            assert_string_equal(json_string_value(json_object_get(curve, "label")), "data");
            const size_t n = rows[i].series == 1 ? 1 : 3 - k;
            assert_int_equal(json_array_size(json_object_get(curve, "x")), n);
            assert_int_equal(json_array_size(json_object_get(curve, "y")), n);
        }
        json_decref(document);
        snprintf(path, sizeof path, "%s/%s.svg", place, rows[i].name);
        snprintf(line, sizeof line, "plot:             %s\n", path);
        assert_int_equal(strstr(told, line) != NULL, unlink(path) == 0); /* without gnuplot none */
    }
    free(told);
    assert_int_equal(rmdir(place), 0);
}

/* Six other checks that fail on the same member are named, the rest is counted. */
TEST(many)
{
    struct check checks[9];
    struct figure fails[9];
    char names[9][16], subject[] = "cubic";
    struct suite of = {.figures = fails, .figure_count = 9, .failed = 9};
    for (int i = 0; i < 9; i++) {
        snprintf(names[i], sizeof names[i], "c%d", i);
        checks[i] = (struct check){.group = "kernels", .name = names[i], .property = "p"};
        fails[i] = (struct figure){&checks[i], subject, 20 - i, 1, 0, 0, FINDING_FAIL};
    }
    for (int others = 6; others <= 8; others++) {
        char *text = NULL;
        size_t size;
        FILE *stream = open_memstream(&text, &size);
        assert_non_null(stream);
        of.figure_count = of.failed = (size_t)others + 1;
        json_t *headlines = headline_list(&of);
        assert_int_equal(json_array_size(headlines), 1);
        headline_print(headlines, stream, false);
        fclose(stream);
        const char *const ends[] = {"c5, c6\n", "c5, c6 and 1 more checks\n",
                                    "c5, c6 and 2 more checks\n"};
        assert_non_null(strstr(text, ends[others - 6]));
        assert_non_null(strstr(text, "; also: c1, c2, c3, "));
        json_decref(headlines);
        free(text);
    }
}

int main(int argc, char **argv)
{
    folder = argc > 1 ? argv[1] : "";
    writing = argc > 2 && strcmp(argv[2], "--write") == 0;
    return test_run(NULL, NULL);
}
