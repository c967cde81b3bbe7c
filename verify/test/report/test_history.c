/* SPDX-License-Identifier: GPL-3.0-or-later
 * The history of a report: lines as they are added, cut off, mixed; what changed since last night
 * and where figures moved. */
#include "test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "history.h"
#include "near.h"
#include "result.h"
#include "value.h"

/* A report whose one study has this error and order. */
static json_t *report(const char *mode, const char *git, double error, double order)
{
    json_t *results = result_new("report");
    json_object_set_new(results, "git", json_string(git));
    json_object_set_new(results, "mode", json_string(mode));
    json_object_set_new(results, "verdict", json_pack("{s:s, s:[]}", "status", "pass", "failures"));
    json_object_set_new(
        results, "studies",
        json_pack("[{s:s, s:s, s:s, s:[{s:i, s:{s:{s:f, s:f}}, s:f}], s:[{s:s, s:s, s:f, s:f, "
                  "s:f}], s:[s,s]}]",
                  "case", "sod", "label", "ia", "status", "pass", "levels", "n", 400, "errors",
                  "density", "l1", error, "l2", 2 * error, "cpu_s", 5 * error, "orders", "field",
                  "density", "norm", "l1", "order", order, "low", order - 0.01, "high",
                  order + 0.01, "measured", "mode_amplitude", "density"));
    json_object_set_new(
        results, "verify",
        json_pack("{s:[{s:s, s:s, s:s, s:f, s:f, s:f, s:s}, {s:s, s:s, s:s, s:f, s:f, s:f, s:s}]}",
                  "checks", "group", "norms", "name", "sum", "subject", "a", "value", 1e-15,
                  "bound", 1e-13, "floor", 1e-16, "status", "pass", "group", "norms", "name", "sum",
                  "subject", "b", "value", 5e-14, "bound", 1e-13, "floor", 1e-16, "status",
                  "pass"));
    return results;
}

static const char error_path[] = "studies[sod, ia].levels[n 400].errors.density.l1";

/* Tells the history of a night, adds its line, and returns what it told. */
static json_t *night(const char *path, const char *mode, const char *git, double l1, double order)
{
    json_t *results = report(mode, git, l1, order), *told;
    struct error error = {0};
    assert_int_equal(history_tell(results, path, &told, &error), STATUS_OK);
    assert_int_equal(history_append(results, path, &error), STATUS_OK);
    json_decref(results);
    return told;
}

static double number(const json_t *object, const char *name)
{
    return value_real(json_object_get(object, name));
}

static void new_file(char *path)
{
    strcpy(path, "history.XXXXXX");
    const int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    unlink(path);
}

TEST(since_last_night)
{
    char path[32];
    new_file(path);
    json_t *told = night(path, "quick", "one", 1e-3, 0.95);
    assert_int_equal(json_array_size(json_object_get(told, "nights")), 1);
    assert_true(json_is_null(json_object_get(told, "since")));
    json_decref(told);

    told = night(path, "quick", "two", 1.0001e-3, 0.951); /* within the noise */
    json_t *since = json_object_get(told, "since");
    assert_string_equal(json_string_value(json_object_get(since, "git")), "one");
    near_absolute(number(since, "worse"), 0, 0);
    near_absolute(number(since, "better"), 0, 0);
    assert_true(number(since, "same") >= 3);
    json_decref(told);

    told = night(path, "nightly", "three", 9e-4, 0.9); /* another mode has another history */
    assert_true(json_is_null(json_object_get(told, "since")));
    json_decref(told);

    told = night(path, "quick", "four", 1.3e-3, 0.9);
    since = json_object_get(told, "since");
    near_absolute(number(since, "worse"), 2, 0);
    const json_t *figures = json_object_get(since, "figures"), *figure;
    size_t i, seen = 0;
    json_array_foreach(figures, i, figure) {
        if (strcmp(json_string_value(json_object_get(figure, "path")), error_path)) continue;
        seen++;
        near_relative(number(figure, "old"), 1.0001e-3, 1e-12);
        near_relative(number(figure, "new"), 1.3e-3, 1e-12);
        assert_string_equal(json_string_value(json_object_get(figure, "verdict")), "worse");
    }
    assert_int_equal(seen, 1);
    json_decref(told);
    unlink(path);
}

/* A line that was cut off, and others that are none, neither count nor harm what comes next. */
TEST(broken_lines)
{
    char path[32];
    new_file(path);
    json_decref(night(path, "quick", "one", 1e-3, 0.95));
    FILE *file = fopen(path, "a");
    fputs("no JSON\n[1, 2]\n{\"schema\": \"other\"}\n\n{\"schema\": \"sphproof-hist", file);
    fclose(file);
    json_decref(night(path, "quick", "two", 1e-3, 0.95));
    json_t *told = night(path, "quick", "three", 1e-3, 0.95);
    assert_int_equal(json_array_size(json_object_get(told, "nights")), 3);
    near_absolute(number(told, "unreadable"), 4, 0);
    json_decref(told);
    unlink(path);
}

TEST(moves_are_dated)
{
    char path[32], git[16];
    json_t *told = NULL;
    new_file(path);
    for (int i = 0; i < 12; i++) {
        json_decref(told);
        snprintf(git, sizeof git, "rev%d", i);
        told = night(path, "quick", git, i < 7 ? 1e-3 : 1.2e-3, 0.95);
    }
    const json_t *changes = json_object_get(told, "changes"),
                 *trend = json_array_get(json_object_get(told, "trends"), 0);
    assert_int_equal(json_array_size(changes), 1);
    const json_t *change = json_array_get(changes, 0);
    assert_string_equal(json_string_value(json_object_get(change, "path")), error_path);
    assert_string_equal(json_string_value(json_object_get(change, "git")), "rev7");
    assert_string_equal(json_string_value(json_object_get(change, "git_before")), "rev6");
    assert_string_equal(json_string_value(json_object_get(change, "verdict")), "worse");
    near_relative(number(change, "ratio"), 1.2, 1e-9);
    /* of what the study is judged by, the first that has errors and orders */
    assert_string_equal(json_string_value(json_object_get(trend, "field")), "density");
    assert_int_equal(json_array_size(json_object_get(told, "trends")), 1);
    assert_int_equal(json_array_size(json_object_get(trend, "error")), 12);
    near_relative(value_real(json_array_get(json_object_get(trend, "error"), 11)), 1.2e-3, 1e-12);
    near_relative(value_real(json_array_get(json_object_get(trend, "order"), 0)), 0.95, 1e-12);
    json_decref(told);
    unlink(path);
}

/* Every check has one figure, its worst; what is no headline is not there. */
TEST(one_line)
{
    char path[32];
    new_file(path);
    json_decref(night(path, "quick", "one", 1e-3, 0.95));
    json_error_t fault;
    json_t *line = json_load_file(path, 0, &fault);
    assert_non_null(line);
    const json_t *figures = json_object_get(line, "figures");
    near_relative(number(figures, "verify[norms, sum].value_over_bound"), 0.5, 1e-12);
    near_relative(number(figures, error_path), 1e-3, 1e-12);
    assert_null(json_object_get(figures, "studies[sod, ia].levels[n 400].errors.density.l2"));
    json_decref(line);
    unlink(path);
}

TEST(cannot_write)
{
    struct error error = {0};
    json_t *results = report("quick", "one", 1e-3, 1), *told;
    assert_int_equal(history_append(results, "missing/history", &error), STATUS_ENVIRONMENT);
    assert_int_equal(history_tell(results, "missing/history", &told, &error), STATUS_OK);
    json_decref(told);
    json_decref(results);
}
