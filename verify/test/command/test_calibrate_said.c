/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the numbers of runs that `sphproof calibrate` accepts, and the name of the file that it
 * writes. (The transcripts and other_codes.py test whole calls.) */
#include "test.h"

/* the command itself, because its static functions are tested */
#include "../../command/calibrate.c"

static const char *values[8];
static struct options options = {.command = &command_calibrate, .values = values};

static const char **value_called(const char *name)
{
    for (size_t i = 0; own_options[i].name; i++)
        if (!strcmp(own_options[i].name, name)) return &values[i];
    fail_msg("no option %s", name);
    return NULL;
}

TEST(accepted_numbers_of_runs)
{
    static const struct {
        const char *text;
        size_t runs; /* 0: the file is refused */
    } rows[] = {{"2", 2}, {"16", 16}, {"1", 0}, {"17", 0}, {"2.5", 0}, {"x", 0}, {NULL, RUNS}};
    const char **value = value_called("runs");
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct error error = {0};
        size_t found = 0;
        *value = rows[k].text;
        assert_int_equal(take_runs(&options, &found, &error),
                         rows[k].runs ? STATUS_OK : STATUS_BAD_INPUT);
        assert_int_equal(found, rows[k].runs);
    }
}

/* The calibrated file is written beside the code file, under its name without the ending. */
TEST(name_of_the_calibrated_file)
{
    static const struct {
        const char *code, *said, *out; /* NULL: refused */
    } rows[] = {{"a.ini", NULL, "a.calibrated.ini"},
                {"a", NULL, "a.calibrated.ini"},
                {"a.b.ini", NULL, "a.b.calibrated.ini"},
                {".ini", NULL, ".ini.calibrated.ini"},
                {"./a", NULL, "./a.calibrated.ini"},
                {"./.a", NULL, "./.calibrated.ini"},
                {"a.ini", "b.ini", "b.ini"},
                {"a.ini", "./b.ini", "./b.ini"},
                {"a.ini", "/b.ini", NULL},
                {"a.ini", "no_such/b.ini", NULL}};
    static struct code code;
    char *here = realpath(".", NULL), out[CODE_PATH];
    const char **value = value_called("out");
    snprintf(code.folder, sizeof code.folder, "%s", here);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct error error = {0};
        snprintf(code.path, sizeof code.path, "%s", rows[k].code);
        *value = rows[k].said;
        const enum status status = take_out(&options, &code, out, &error);
        if (status != (rows[k].out ? STATUS_OK : STATUS_BAD_INPUT) ||
            (rows[k].out && strcmp(out, rows[k].out) != 0))
            fail_msg("%s: %d, %s, %s", rows[k].code, status, out, error.message);
    }
    *value = NULL;
    free(here);
}
