/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests options that several commands share: kernels by name, names that are refused, and what a
 * command gets that is given none. */
#include "test.h"

#include "command.h"
#include "kernel.h"

static const struct command_option list[] = {
    {"eta", "ETA", ""}, {"kernel", "NAME", ""}, {NULL, NULL, NULL}};

static struct options got;

static enum status keep(const struct options *options, int n, char **arguments, struct error *error)
{
    (void)n, (void)arguments, (void)error;
    got = *options;
    return STATUS_OK;
}

/* in place of the program's */
extern const struct command command_cache;
const struct command command_cache = {.name = "cache", .run = keep, .options = list};
static const struct command command = {.name = "judge", .synopsis = "FILE", .options = list};

TEST(values_by_name)
{
    const char *values[] = {"2.385", "sinc"}, *none[] = {NULL, NULL};
    const struct options given = {.command = &command, .values = values},
                         absent = {.command = &command, .values = none};
    assert_string_equal(options_value(&given, "eta"), "2.385");
    assert_string_equal(options_value(&given, "kernel"), "sinc");
    assert_null(options_value(&given, "kern"));
    assert_null(options_value(&given, "kernels"));
    assert_null(options_value(&absent, "kernel"));
}

TEST(kernels_by_name)
{
    const char *values[] = {"2.385", NULL};
    const struct options options = {.command = &command, .values = values};
    struct error error = {0};
    int index = 7;
    assert_int_equal(options_kernel(&options, &index, &error), STATUS_OK);
    assert_int_equal(index, -1);
    for (size_t k = 0; k < kernel_family.n; k++) {
        values[1] = kernel_family.members[k]->name;
        assert_int_equal(options_kernel(&options, &index, &error), STATUS_OK);
        assert_int_equal(index, k);
    }
    static const char *const wrong[] = {"cubic", "", "Sinc", "cubic_spline ",
                                        "./no_such_kernel.so"};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        values[1] = wrong[k];
        assert_int_equal(options_kernel(&options, &index, &error), STATUS_BAD_INPUT);
        assert_non_null(strstr(error.message, wrong[k]));
    }
}

TEST(no_options)
{
    char *words[] = {"sphproof", "cache", NULL};
    assert_int_equal(command_main(2, words), STATUS_OK);
    assert_true(got.command == &command_cache && got.speak && !got.quiet && !got.json);
    assert_int_equal(got.threads, 1);
    assert_int_equal(got.count, 0);
}
