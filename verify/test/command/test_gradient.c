/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof gradient on files: results against brute force, the judgement of given gradients, and
 * every way in which a file or an option can be wrong. Argument: a folder to write to. */
#include "test.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "clouds.h"
#include "command.h"
#include "naive.h"
#include "near.h"
#include "point_cloud.h"

enum { DIM = 2, SIDE = 9 };
static char file[64] = "gradient_cloud.csv", result[64] = "gradient_result.json";

static void write_text(const char *text, size_t length)
{
    FILE *stream = fopen(file, "w");
    assert_non_null(stream);
    fwrite(text, 1, length, stream);
    fclose(stream);
}

/* sphproof gradient FILE ARGUMENTS: the exit status; the document goes to *document, NULL if none.
 */
static int gradient(const char *arguments, json_t **document)
{
    char text[512], *argv[32] = {(char[]){"sphproof"}, (char[]){"gradient"}, file,
                                 (char[]){"--quiet"},  (char[]){"--json"},   result};
    int argc = 6;
    snprintf(text, sizeof text, "%s", arguments);
    for (char *word = strtok(text, " "); word; word = strtok(NULL, " ")) argv[argc++] = word;
    unlink(result);
    const int status = command_main(argc, argv);
    json_t *read = json_load_file(result, 0, NULL);
    if (document)
        *document = read;
    else
        json_decref(read);
    return status;
}

/* A cloud with f, g and the brute-force gradient of f; factor spoils one value of it. */
static void write_cloud(struct clouds_cloud *cloud, const struct operator_form *form, double factor)
{
    struct kernel kernel;
    FILE *stream = fopen(file, "w");
    double f[SIDE * SIDE];
    assert_non_null(stream);
    assert_int_equal(kernel_select(&kernel, "wendland_c4", 5, NULL), STATUS_OK);
    fprintf(stream, "\xef\xbb\xbf x , y,volume,f,fx,h,fy\r\n# a comment\r\n\r\n");
    for (size_t i = 0; i < cloud->cloud.points.n; i++)
        f[i] = 2.385 * sin(4 * cloud->x[0][i]) - 0.7 * cloud->x[1][i] * cloud->x[1][i];
    for (size_t i = 0; i < cloud->cloud.points.n; i++) {
        double g[DIM];
        naive_gradient(form, &kernel, NAIVE_NONE, &cloud->cloud, f, i, g);
        fprintf(stream, "%.17g, %.17g,%.17g,%.17g,%.17g,%.17g,%.17g\r\n", cloud->x[0][i],
                cloud->x[1][i], cloud->volume[i], f[i], g[0], cloud->h[i],
                g[1] * (i == 40 ? factor : 1));
    }
    fclose(stream);
}

TEST(test_judgement)
{
    for (size_t o = 0; o < operator_family.n; o++) {
        const struct clouds_settings how = {CLOUDS_JITTERED, DIM, SIDE, 0.35, 3.3, 7};
        const struct operator_form *form = (const struct operator_form *)operator_family.members[o];
        struct clouds_cloud cloud;
        char arguments[256];
        assert_int_equal(clouds_make(&how, &cloud, NULL), STATUS_OK);
        snprintf(arguments, sizeof arguments,
                 "--operator %s --kernel wendland_c4 --dim 2 --h 1 --check f=fx,fy",
                 form->member.name);
        write_cloud(&cloud, form, 1);
        json_t *document;
        assert_int_equal(gradient(arguments, &document), STATUS_OK);
        const json_t *points = json_object_get(document, "points");
        assert_int_equal(json_array_size(points), cloud.cloud.points.n);
        const json_t *point = json_array_get(points, 40);
        near_relative(json_real_value(json_object_get(point, "h")), cloud.h[40], 1e-15);
        assert_string_equal(json_string_value(json_object_get(point, "state")), "ok");
        assert_int_equal(json_array_size(json_object_get(json_object_get(point, "gradients"), "f")),
                         DIM);
        assert_null(json_object_get(json_object_get(point, "gradients"), "fx"));
        json_decref(document);

        write_cloud(&cloud, form, 1 + 1e-7);
        assert_int_equal(gradient(arguments, &document), STATUS_CHECK_FAILED);
        const json_t *judgement = json_array_get(json_object_get(document, "judgements"), 0);
        assert_int_equal(json_integer_value(json_object_get(judgement, "failed")), 1);
        assert_int_equal(json_integer_value(json_object_get(judgement, "worst_row")), 41);
        json_decref(document);
        strcat(arguments, " --tolerance 1e-5");
        assert_int_equal(gradient(arguments, NULL), STATUS_OK);
        clouds_free(&cloud);
    }
}

/* No gradient is null, an infinite condition number is "inf", and both leave exit status 0. */
TEST(test_flagged)
{
    static const char text[] = "x,y,volume,f\n0,0,1,3\n0.5,0.5,1,2\n1,1,1,1\n9,9,1,0\n";
    json_t *document;
    write_text(text, sizeof text - 1);
    assert_int_equal(
        gradient("--operator linear_exact --kernel cubic_spline --dim 2 --eta 2", &document),
        STATUS_OK);
    const json_t *points = json_object_get(document, "points");
    const json_t *middle = json_array_get(points, 1), *alone = json_array_get(points, 3);
    assert_string_equal(json_string_value(json_object_get(middle, "state")), "singular");
    assert_string_equal(json_string_value(json_object_get(alone, "state")), "too_few_neighbours");
    assert_string_equal(json_string_value(json_object_get(alone, "condition")), "inf");
    assert_int_equal(json_integer_value(json_object_get(alone, "neighbours")), 1);
    assert_true(json_is_null(
        json_array_get(json_object_get(json_object_get(middle, "gradients"), "f"), 0)));
    json_decref(document);
    assert_int_equal(
        gradient("--operator standard --kernel cubic_spline --dim 2 --eta 2", &document),
        STATUS_OK);
    points = json_object_get(document, "points");
    for (size_t i = 0; i < 4; i++)
        assert_true(json_is_real(json_array_get(
            json_object_get(json_object_get(json_array_get(points, i), "gradients"), "f"), 0)));
    json_decref(document);
}

TEST(test_bad_files)
{
    static const struct {
        const char *text, *place; /* what the message must contain */
    } bad[] = {
        {"", "empty"},
        {"\n# only a comment\r\n", "empty"},
        {"x,volume,f\n", "no points"},
        {"x,volume,f\n1,1\n", ":2:3: 2 values; there are 3"},
        {"x,volume,f\n1,1,1,1\n", ":2:7: more than 3"},
        {"x,volume,f\n1,1,nan\n", ":2:5: 'nan' in column 'f'"},
        {"x,volume,f\n1,1,1e400\n", "'1e400'"},
        {"x,volume,f\n1,1,0x10\n", "'0x10'"},
        {"x,volume,f\n1,1,1 2\n", "'1 2'"},
        {"x,volume,f\n1,,1\n", ":2:3: ''"},
        {"x,volume,f,f\n1,1,1,1\n", ":1:12: second column named 'f'"},
        {"x,volume,\n1,1,1\n", "column 3 has no name"},
        {"1,2,3\n1,1,1\n", "is a number; the first line"},
        {"x,f,volume\n1,1,1\n", "column 2 is 'f'"},
        {"x\n1\n", "column 2 is 'nothing'"},
        {"x,volume,f\n1,0,1\n", ":2: volume 0"},
        {"x,volume,f,h\n1,1,1,1\n2,1,1,-3\n", ":3: support radius h = -3"},
        {"x,volume,f\n1,1,\001\n", "binary"},
        {"x,volume,f\r1,1,1\r", "carriage return"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct point_cloud cloud;
        struct error error = {0};
        write_text(bad[i].text, strlen(bad[i].text));
        assert_int_equal(point_cloud_read(file, 1, 2, 0, &cloud, &error), STATUS_BAD_INPUT);
        if (!strstr(error.message, bad[i].place)) fail_msg("%s\n%s", bad[i].text, error.message);
        assert_non_null(strstr(error.message, file));
        point_cloud_free(&cloud);
        assert_int_equal(gradient("--operator ia --kernel cubic_spline --dim 1 --eta 2", NULL),
                         STATUS_BAD_INPUT);
        assert_int_equal(access(result, F_OK), -1); /* nothing written */
    }
    struct csv csv;
    struct error error;
    char *line = malloc(CSV_LINE_MAX + 2);
    assert_non_null(line);
    memset(line, '1', CSV_LINE_MAX + 2);
    write_text(line, CSV_LINE_MAX + 2);
    free(line);
    assert_int_equal(csv_read(file, &csv, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "line too long"));
    csv_free(&csv);
    assert_int_equal(csv_read(".", &csv, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "directory"));
    csv_free(&csv);
    assert_int_equal(csv_read("no_such_file.csv", &csv, &error), STATUS_BAD_INPUT);
    csv_free(&csv);
}

TEST(test_bad_options)
{
    static const char text[] = "x,volume,f,g\n0,1,3,1\n1,1,2,1\n";
    static const char *const bad[] = {
        "--operator iaa --kernel cubic_spline --dim 1 --eta 2",
        "--operator ia --kernel cubic --dim 1 --eta 2",
        "--operator ia --kernel cubic_spline --dim 4 --eta 2",
        "--operator ia --kernel cubic_spline --dim 1.5 --eta 2",
        "--operator ia --kernel cubic_spline --dim 2 --eta 2",
        "--operator ia --kernel cubic_spline --eta 2",
        "--operator ia --dim 1 --eta 2",
        "--kernel cubic_spline --dim 1 --eta 2",
        "--operator ia --kernel cubic_spline --dim 1",
        "--operator ia --kernel cubic_spline --dim 1 --eta 0",
        "--operator ia --kernel cubic_spline --dim 1 --h nan",
        "--operator ia --kernel cubic_spline --dim 1 --h 1 --eta 2",
        "--operator ia --kernel cubic_spline --dim 1 --h 1 --check f",
        "--operator ia --kernel cubic_spline --dim 1 --h 1 --check f=",
        "--operator ia --kernel cubic_spline --dim 1 --h 1 --check f=g,g",
        "--operator ia --kernel cubic_spline --dim 1 --h 1 --check f=f",
        "--operator ia --kernel cubic_spline --dim 1 --h 1 --check q=g",
        "--operator ia --kernel cubic_spline --dim 1 --h 1 --check f=g --tolerance 0",
        "--operator ia --kernel cubic_spline --dim 1 --h 1 --tolerance 1",
        "another.csv --operator ia --kernel cubic_spline --dim 1 --h 1",
    };
    write_text(text, sizeof text - 1);
    assert_int_equal(gradient("--operator ia --kernel cubic_spline --dim 1 --h 2", NULL),
                     STATUS_OK);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        if (gradient(bad[i], NULL) != STATUS_BAD_INPUT) fail_msg("accepted: %s", bad[i]);
        assert_int_equal(access(result, F_OK), -1);
    }
}

int main(int argc, char **argv)
{
    if (argc > 1 && chdir(argv[1])) return EXIT_FAILURE;
    return test_run(NULL, NULL);
}
