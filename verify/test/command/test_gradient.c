/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests `sphproof gradient` on files: points without a gradient, and files that are refused. (The
 * transcripts test options and results, test_csv.c files that are no tables.) Argument: a folder to
 * write to. */
#include "test.h"

#include <jansson.h>
#include <unistd.h>

#include "command.h"
#include "point_cloud.h"

static char file[64] = "gradient_cloud.csv", result[64] = "gradient_result.json";

static void write_text(const char *text, size_t length)
{
    FILE *stream = fopen(file, "w");
    assert_non_null(stream);
    fwrite(text, 1, length, stream);
    fclose(stream);
}

/* Runs sphproof gradient FILE ARGUMENTS and returns its exit status; *document is its document or
 * NULL. */
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

/* A missing gradient is null, an infinite condition number is "inf", and both leave exit status
 * 0. */
TEST(points_without_gradient)
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

TEST(bad_files)
{
    static const struct {
        const char *text, *place; /* what the message must contain */
    } bad[] = {
        {"x,volume,f\n", "no points"},
        {"x,f,volume\n1,1,1\n", "column 2 is 'f'"},
        {"x\n1\n", "column 2 is 'nothing'"},
        {"x,volume,f\n1,0,1\n", ":2: volume 0"},
        {"x,volume,f,h\n1,1,1,1\n2,1,1,-3\n", ":3: support radius h = -3"},
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
}

static int go_there(void **state)
{
    (void)state;
    return chdir(test_word(1));
}

TEST_BETWEEN(go_there, NULL);
