/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the table that `sphproof calibrate` prints of given gates and faults, and the options that
 * it refuses. (The transcripts and other_codes.py test whole calls.) */
#include "test.h"

#include "printed.h"
/* the command itself, because its static functions are tested */
#include "../../command/calibrate.c"

static const char *values[8];
static struct options options = {.command = &command_calibrate, .values = values};

TEST(printed_tables)
{
    static const char markup[] =
        "[*sod]: Sod, 3 runs, at n = 70\n"
        "[*gate                          value     floor        least       bound  smallest fault "
        "that is seen]\n"
        "density_l1               1.2500e-01   1.0e-03   1.0000e-01  1.5000e-01  viscous 2.0e-02, "
        "order in [0.5, 1.5], [-not all runs have the order that was asked for: left out]\n"
        "velocity_l1              2.5000e-01   2.0e-03  [-sees no fault]\n"
        "mass                     5.0000e-01   3.0e-03   2.0000e-01  3.0000e-01  [.no fault was "
        "planted]\n"
        "energy                   7.5000e-01   4.0e-03   3.0000e-01  4.5000e-01  first 1.0e-02\n"
        "fault first            [+seen by] density_l1 energy\n"
        "fault viscous          [-seen by no gate]\n"
        "fault broken           its runs fail: it went away\n"
        "%s\n";
    static const char trouble[] =
        "[-a report fails whatever the gates are: an error is exactly 0]\n";
    static struct code code = {.fault_count = 3};
    static struct calibrate calibrate = {.code = &code, .runs = 3};
    static struct code_case of;
    static struct study studies[6];
    static struct study_result results[1];
    static struct calibrate_case one = {.of = &of, .studies = studies, .gate_count = 4};
    char text[4096], expected[4096], whole[4096];
    strcpy(code.faults[0].name, "first");
    strcpy(code.faults[1].name, "viscous");
    strcpy(code.faults[2].name, "broken");
    strcpy(of.file.asked, "sod");
    strcpy(of.file.title, "Sod");
    of.file.ladder_count = 2, of.file.ladder[0] = 50, of.file.ladder[1] = 70;
    studies[5].results = results;
    strcpy(results[0].message, "it went away");
    one.breaks[2] = one.seen[0] = true;
    one.gates[0] = (struct calibrate_gate){.name = "density_l1",
                                           .value = 0.125,
                                           .floor = 1e-3,
                                           .least = 0.1,
                                           .bound = 0.15,
                                           .low = 0.5,
                                           .high = 1.5,
                                           .order_lost = true,
                                           .change = {0.5, 0.02},
                                           .sees = {true},
                                           .smallest = 1};
    one.gates[1] = (struct calibrate_gate){.name = "velocity_l1",
                                           .value = 0.25,
                                           .floor = 2e-3,
                                           .low = NAN,
                                           .smallest = -1,
                                           .sight = CALIBRATE_BLIND};
    one.gates[2] = (struct calibrate_gate){.name = "mass",
                                           .value = 0.5,
                                           .floor = 3e-3,
                                           .least = 0.2,
                                           .bound = 0.3,
                                           .low = NAN,
                                           .smallest = -1,
                                           .sight = CALIBRATE_FREE};
    one.gates[3] = (struct calibrate_gate){.name = "energy",
                                           .value = 0.75,
                                           .floor = 4e-3,
                                           .least = 0.3,
                                           .bound = 0.45,
                                           .low = NAN,
                                           .change = {0.01},
                                           .sees = {true}};
    for (int color = 0; color < 2; color++)
        for (int troubled = 0; troubled < 2; troubled++) {
            strcpy(one.trouble, troubled ? "an error is exactly 0" : "");
            options.color = color;
            const struct printed printed = printed_begin();
            print_case(&calibrate, &one, &options);
            printed_end(&printed, text, sizeof text);
            snprintf(whole, sizeof whole, markup, troubled ? trouble : "");
            printed_dress(whole, color, expected);
            assert_string_equal(text, expected);
        }
}

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
