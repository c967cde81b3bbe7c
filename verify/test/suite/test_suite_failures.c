/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the plots of failed checks: the numbers that gnuplot gets (a program of that name stores
 * them), and files that are created and removed. */
#include "test.h"

#include <sys/stat.h>

#include "own_folder.h"
#include "suite_output.h"

static const struct check first = {.group = "a", .name = "first", .property = "one is one"},
                          second = {.group = "a", .name = "second", .property = "p"};

static const char *text_of(const char *name)
{
    static char text[1 << 15];
    FILE *file = fopen(path_of(name), "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    return text;
}

#define FIGURE(check, value, bound, status)                                                        \
    {                                                                                              \
        check, (char *)(uintptr_t) "figure", value, bound, 0, 0, status                            \
    }

/* A gnuplot that records its input and always draws the same. */
static void make_gnuplot(void)
{
    FILE *file = fopen(path_of("gnuplot"), "w");
    assert_non_null(file);
    fprintf(file, "#!/bin/sh\ncat > %s/script\necho '<svg>drawn</svg>'\n", own_folder);
    fclose(file);
    assert_int_equal(chmod(path_of("gnuplot"), 0700), 0);
}

/* Compares the data block of the script, between its first and last line. */
static void numbers_are(const char *expected)
{
    const char *text = text_of("script"), *begin = strstr(text, "END_OF_DATA\n");
    assert_non_null(begin);
    begin += strlen("END_OF_DATA\n");
    const char *end = strstr(begin, "END_OF_DATA");
    assert_non_null(end);
    if (strlen(expected) != (size_t)(end - begin) ||
        strncmp(begin, expected, strlen(expected)) != 0)
        fail_msg("'%.*s' is not '%s'", (int)(end - begin), begin, expected);
}

/* The first check has no curves; of the second one's nine eight are drawn. Values are clipped to
 * 1e-6 and 1e12. */
TEST(plots_of_failures)
{
    enum { CURVES = 9 };
    struct figure figures[] = {
        FIGURE(&first, 0.5, 1, FINDING_PASS), FIGURE(&first, 1e-7, 1, FINDING_PASS),
        FIGURE(&first, 3, 0.5, FINDING_FAIL), FIGURE(&first, (double)NAN, 1, FINDING_FAIL),
        FIGURE(&first, 2, 1, FINDING_SKIP),   FIGURE(&second, 3, 1, FINDING_FAIL),
        FIGURE(&second, 9, 1, FINDING_FAIL), /* not part of the suite */
    };
    double x[] = {1, 2, 3}, y[CURVES][3];
    char label[CURVES][16];
    struct series series[CURVES + 2] = {{&first, label[0], 3, x, x}};
    for (int k = 0; k < CURVES; k++) {
        for (int i = 0; i < 3; i++) y[k][i] = 10 * k + i;
        snprintf(label[k], sizeof label[k], "c%d", k);
        series[k + 1] = (struct series){&second, label[k], 2, x, y[k]};
    }
    series[CURVES + 1] = series[0]; /* not part of the suite */
    const struct suite suite = {.figures = figures,
                                .figure_count = 6,
                                .series = series + 1,
                                .series_count = CURVES,
                                .failed = 3};
    char *before = strdup(getenv("PATH") ? getenv("PATH") : ""), path[4096], printed[1024];
    snprintf(path, sizeof path, "%s:%s", own_folder, before);
    make_gnuplot();
    setenv("PATH", path, 1);
    struct suite one = suite;
    one.figure_count = 5; /* the first check alone */
    char out[256];
    snprintf(out, sizeof out, "%s/out", own_folder);
    assert_int_equal(suite_output_failures(&one, out, NULL, NULL), STATUS_OK);
    numbers_are("# x y: pass\n 1 0.5\n 2 1e-06\n 3 NaN\n 4 NaN\n 5 NaN\n\n\n"
                "# x y: fail\n 1 NaN\n 2 NaN\n 3 6\n 4 1e+12\n 5 NaN\n\n\n");
    assert_non_null(strstr(text_of("script"), "'one is one'"));
    assert_non_null(
        strstr(text_of("script"), "set arrow from graph 0, first 1 to graph 1, first 1"));
    assert_null(strstr(text_of("script"), "label 'first'"));
    const char *svg = text_of("out/a-first.svg");
    assert_string_equal(strstr(svg, "drawn"), "drawn</svg>\n");
    struct stat is;
    assert_true(stat(path_of("out/a-first.svg"), &is) == 0 && (size_t)is.st_size == strlen(svg));
    const mode_t mask = umask(0);
    umask(mask);
    assert_true(stat(out, &is) == 0 && (is.st_mode & 0777) == (0777 & ~mask));
    /* of the second one, with curves */
    one.figures += 5, one.figure_count = 1;
    FILE *stream = fopen(path_of("printed"), "w");
    assert_non_null(stream);
    assert_int_equal(suite_output_failures(&one, out, stream, NULL), STATUS_OK);
    fclose(stream);
    snprintf(printed, sizeof printed,
             "figures and data: %s/a-second.json\nplot:             %s/a-second.svg\n", out, out);
    assert_string_equal(text_of("printed"), printed);
    numbers_are("# x y: c0\n 1 0\n 2 1\n\n\n# x y: c1\n 1 10\n 2 11\n\n\n"
                "# x y: c2\n 1 20\n 2 21\n\n\n# x y: c3\n 1 30\n 2 31\n\n\n"
                "# x y: c4\n 1 40\n 2 41\n\n\n# x y: c5\n 1 50\n 2 51\n\n\n"
                "# x y: c6\n 1 60\n 2 61\n\n\n# x y: c7\n 1 70\n 2 71\n\n\n"
                "# x y: pass\n 1 NaN\n\n\n# x y: fail\n 1 3\n\n\n");
    assert_non_null(strstr(text_of("script"), "label 'second'"));
    setenv("PATH", before, 1);
    free(before);
    json_t *document = json_load_file(path_of("out/a-second.json"), 0, NULL);
    const json_t *kept = json_object_get(document, "series");
    assert_int_equal(json_array_size(kept), CURVES); /* the file has all curves */
    assert_true(json_real_value(json_array_get(json_object_get(json_array_get(kept, 8), "y"), 1)) ==
                81);
    json_decref(document);
    /* after success nothing is left, not even the folder */
    for (int k = 0; k < 6; k++) figures[k].status = FINDING_PASS;
    one = suite;
    one.failed = 0;
    assert_int_equal(suite_output_failures(&one, out, NULL, NULL), STATUS_OK);
    assert_int_equal(access(out, F_OK), -1);
}
