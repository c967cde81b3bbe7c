/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests what `sphproof verify` makes of checks that fail: its status, its document, and files of
 * failures, of checks one after another and side by side. (The program's own checks pass.) */
#define _GNU_SOURCE /* asprintf */
#include "test.h"

#include <fcntl.h>

#include "own_folder.h"
/* the command itself, because its checks are replaced */
#define check_registry       planted_checks
#define check_registry_count planted_count
#include "../../command/verify.c"

static void measure(struct check_run *of, const void *value)
{
    check_measure(of, value ? *(const double *)value : 3, 2, 0, "the number");
}

static const double small = 1, large = 3;
static void subject_small(struct check_run *of)
{
    check_subject(of, &small, 0);
}
static void subject_large(struct check_run *of)
{
    check_subject(of, &large, 0);
}

static const struct check_mutant mutants[] = {{"larger", "it is too large", &large},
                                              {NULL, NULL, NULL}};
static const struct check good = {.group = "a",
                                  .name = "good",
                                  .property = "n < 2",
                                  .subjects = subject_small,
                                  .measure = measure,
                                  .mutants = mutants},
                          bad = {.group = "a",
                                 .name = "bad",
                                 .property = "n < 2",
                                 .subjects = subject_large,
                                 .measure = measure,
                                 .mutants = mutants},
                          unnamed = {.group = "\xff",
                                     .name = "slow",
                                     .property = "n < 2",
                                     .slow = true,
                                     .subjects = subject_small,
                                     .measure = measure,
                                     .mutants = mutants};
const struct check *const planted_checks[] = {&good, &bad, &unnamed};
const size_t planted_count = 3;

static const char *values[sizeof verify_options / sizeof *verify_options];
static struct options options = {
    .command = &command_verify, .threads = 1, .quiet = 1, .values = values};

static void set(const char *name, const char *value)
{
    for (size_t i = 0; verify_options[i].name; i++)
        if (!strcmp(verify_options[i].name, name)) values[i] = value;
}

/* Runs the checks, and compares what is said on standard error. */
static void verify(const char *said)
{
    char text[1000], *path = path_of("said");
    struct error error = {0};
    const int usual = dup(STDERR_FILENO), file = open(path, O_RDWR | O_CREAT | O_TRUNC, 0600);
    dup2(file, STDERR_FILENO);
    const enum status status = run(&options, 0, NULL, &error);
    dup2(usual, STDERR_FILENO);
    const ssize_t length = pread(file, text, sizeof text - 1, 0);
    text[length > 0 ? length : 0] = '\0';
    close(usual), close(file);
    assert_int_equal(status, STATUS_CHECK_FAILED);
    assert_string_equal(text, said);
}

TEST(checks_that_fail)
{
    static const char *const jobs[] = {NULL, "1", "2"};
    for (size_t k = 0; k < sizeof jobs / sizeof *jobs; k++) {
        char folder[300], document[300], file[400], said[700];
        struct error error = {0};
        json_t *results = NULL;
        snprintf(folder, sizeof folder, "%s", path_of("failures"));
        snprintf(document, sizeof document, "%s", path_of("results.json"));
        set("jobs", jobs[k]), set("failures", folder);
        options.json = document;
        verify("");
        assert_int_equal(access(path_of("failures/a-bad.json"), R_OK), 0);
        assert_int_not_equal(access(path_of("failures/a-good.json"), R_OK), 0);
        assert_int_equal(result_load(&results, document, &error), STATUS_OK);
        assert_int_equal(json_array_size(json_object_get(results, "failures")), 1);
        json_decref(results);
        options.json = NULL;
        /* the status is that of the checks where failures cannot be kept */
        snprintf(file, sizeof file, "%s/below", document);
        set("failures", file);
        snprintf(said, sizeof said,
                 "sphproof: verify: cannot make the folder '%s': Not a directory\n", file);
        verify(said);
    }
}

/* A check whose name is not UTF-8 is part of no pool, as if there were no memory for it. */
TEST(check_without_a_place)
{
    const struct suite_choice choice = {.slow = true};
    struct pool pool = {0};
    struct part parts[4] = {0};
    struct error error = {0};
    assert_int_equal(plan(&pool, parts, &choice, &error), STATUS_ENVIRONMENT);
    assert_string_equal(error.message, "verify: no memory for a check");
    pool_free(&pool);
}

/* Files of failures are beside the program unless --failures says otherwise. */
TEST(folder_of_failures)
{
    char *program = realpath("/proc/self/exe", NULL), *expected, folder[FOLDER_LENGTH];
    assert_non_null(program);
    *strrchr(program, '/') = '\0';
    assert_true(asprintf(&expected, "%s/failures", program) > 0);
    default_folder(folder, sizeof folder);
    assert_string_equal(folder, access(program, W_OK) ? "failures" : expected);
    free(expected), free(program);
}
