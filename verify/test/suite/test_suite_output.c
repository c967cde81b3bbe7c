/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares what `verify` prints (table, JSON, JUnit file and headlines) of a suite in which all
 * counts differ with data/suite, word for word. */
#include "test.h"

#include <unistd.h>

#include "buffer.h"
#include "suite_output.h"

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

/* Compares the text with the file; a difference is reported from where it begins. */
static void compare(const char *text, const char *name)
{
    static char expected[1 << 16];
    char path[4096];
    const bool writing = test_word(2) != NULL; /* new files, to be checked by a reader */
    snprintf(path, sizeof path, "%s/%s", test_word(1), name);
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
    well.mutants = 1; /* one missed mutant */
    table_is(&well, false, true, "missed.txt");
}

/* One object per line. */
TEST(json)
{
    struct buffer lines = {0};
    json_t *document = json_object();
    suite_output_json(&suite, document);
    json_object_set_new(document, "headlines", headline_list(&suite));
    char *text = json_dumps(document, JSON_SORT_KEYS | JSON_REAL_PRECISION(12)), *all;
    for (const char *c = text; *c; c++)
        buffer_add_bytes(&lines, *c == ' ' && c[1] == '{' ? "\n" : c, 1);
    all = buffer_take(&lines);
    compare(all, "suite.json");
    free(all);
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
