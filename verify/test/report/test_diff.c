/* SPDX-License-Identifier: GPL-3.0-or-later
 * Which documents can be compared: optional fields absent, odd or unlike, on either side. */
#include "test.h"

#include <stdio.h>

#include "made_diff.h"

/* ---- two processors ---- */

/* Times are left out only where both documents name a processor, and not the same. */
TEST(processors)
{
    static const char *const machines[] = {
        NULL,
        "null",
        "\"A\"",
        "[]",
        "{}",
        "{\"processor\": null}",
        "{\"processor\": 3}",
        "{\"processor\": \"\"}",
        "{\"processor\": \"A\"}",
        "{\"processor\": \"A\", \"cores\": 2}",
        "{\"processor\": \"B\"}",
    };
    static const char *const named[] = {"", "", "", "", "", "", "", "", "A", "A", "B"};
    enum { MACHINES = sizeof machines / sizeof *machines };
    for (int i = 0; i < MACHINES; i++)
        for (int k = 0; k < MACHINES; k++) {
            json_t *old = run_with(1e-3, 1), *new = run_with(1e-3, 10);
            struct diff diff;
            if (machines[i])
                json_object_set_new(old, "machine", json_loads(machines[i], JSON_DECODE_ANY, NULL));
            if (machines[k])
                json_object_set_new(new, "machine", json_loads(machines[k], JSON_DECODE_ANY, NULL));
            const bool two = *named[i] && *named[k] && strcmp(named[i], named[k]) != 0;
            assert_int_equal(differ(old, new, &diff), STATUS_OK);
            assert_int_equal(diff.left_out_times, two ? 2 : 0);
            assert_int_equal(find(&diff, "cost.cpu_s") == NULL, two);
            assert_int_equal(find(&diff, "cost.wall_s") == NULL, two);
            assert_non_null(find(&diff, "errors.density.l1"));
            assert_int_equal(diff.verdicts[VERDICT_WORSE], two ? 0 : 2);
            diff_free(&diff);
            json_decref(old), json_decref(new);
        }
    /* also what one document does not have at all */
    json_t *old = json_pack("{s:s, s:{s:s}, s:{s:f}, s:f}", "command", "run", "machine",
                            "processor", "A", "cost", "cpu_s", 1., "error", 1.),
           *new = json_pack("{s:s, s:{s:s}, s:{s:f}, s:f}", "command", "run", "machine",
                            "processor", "B", "cost", "wall_s", 1., "error", 1.);
    struct diff diff;
    assert_int_equal(differ(old, new, &diff), STATUS_OK);
    assert_int_equal(diff.left_out_times, 2);
    diff_free(&diff);
    json_decref(old), json_decref(new);
}

/* ---- two problems ---- */

static void problem_is(const char *command, const char *inside, const char *name, bool counts)
{
    static const char *const texts[] = {NULL, "\"one\"", "\"two\"", "[1, 2]", "[1, 3]"};
    for (size_t i = 0; i < 5; i++)
        for (size_t k = 0; k < 5; k++) {
            json_t *old = run_with(1e-3, 1), *new = run_with(1e-3, 1);
            struct diff diff;
            char text[100];
            json_object_set_new(old, "command", json_string(command));
            json_object_set_new(new, "command", json_string(command));
            put(old, inside, name, texts[i]);
            put(new, inside, name, texts[k]);
            const bool two = counts && i && k && i != k;
            snprintf(text, sizeof text, "the documents differ in %s: two problems", name);
            assert_int_equal(differ(old, new, &diff), two ? STATUS_CHECK_FAILED : STATUS_OK);
            assert_int_equal(strncmp(diff.problem, text, strlen(text)) == 0, two);
            assert_int_equal(*diff.problem != '\0', two);
            assert_int_equal(diff.compared, two ? 0 : 3);
            assert_int_equal(diff.verdicts[VERDICT_INCOMPARABLE], two ? 3 : 0);
            assert_int_equal(diff.regressions, 0);
            assert_int_equal(diff.well, !two);
            diff_free(&diff);
            json_decref(old), json_decref(new);
        }
}

TEST(members_of_a_problem)
{
    static const struct {
        const char *command, *member;
        bool counts;
    } rows[] = {
        {"run", "case", true},      {"converge", "case", true},   {"report", "mode", true},
        {"kernel", "kernel", true}, {"run", "kernel", false},     {"gradient", "operator", true},
        {"run", "operator", false}, {"gradient", "kernel", true}, {"riemann", "left", true},
        {"riemann", "right", true}, {"run", "left", false},       {"kernel", "dim", true},
        {"gradient", "dim", true},  {"kernel", "h", true},        {"riemann", "gamma", true},
        {"riemann", "time", true},  {"riemann", "x0", true},      {"run", "x0", false},
        {"run", "label", false},    {"gradient", "h", false},     {"kernel", "operator", false},
        {"run", "version", false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        problem_is(rows[i].command, NULL, rows[i].member, rows[i].counts);
}

/* Of a run's settings those that say what is computed; a scheme is what one wants to compare. */
TEST(settings_of_a_problem)
{
    static const char *const scheme[] = {
        "kernel",         "sinc_n",        "eta",       "gradient",   "formulation",
        "volume_element", "integrator",    "cfl",       "energy",     "viscosity",
        "balsara",        "balsara_floor", "noise",     "alpha_u",    "alpha",
        "viscosity_form", "alpha_min",     "alpha_max", "pair_width", "h_method",
        "beta",           "h_tolerance",   "skip",      "shifting",   "nonsense"};
    static const char *const problem[] = {"lo",     "hi",   "boundary", "gravity",   "kind",
                                          "jitter", "seed", "gamma",    "n",         "t_end",
                                          "window", "left", "right",    "background"};
    for (size_t i = 0; i < sizeof scheme / sizeof *scheme; i++)
        problem_is("run", "settings", scheme[i], false);
    for (size_t i = 0; i < sizeof problem / sizeof *problem; i++)
        problem_is("run", "settings", problem[i], true);
}

/* The command itself: of two there is no comparison. */
TEST(two_commands)
{
    static const char *const commands[] = {NULL, "\"run\"", "\"bench\"", "3", "null"};
    for (size_t i = 0; i < 5; i++)
        for (size_t k = 0; k < 5; k++) {
            json_t *old = run_with(1e-3, 1), *new = run_with(1e-3, 1);
            struct diff diff;
            json_object_del(old, "command"), json_object_del(new, "command");
            put(old, NULL, "command", commands[i]);
            put(new, NULL, "command", commands[k]);
            const bool one = i == k && (i == 1 || i == 2);
            assert_int_equal(differ(old, new, &diff), one ? STATUS_OK : STATUS_BAD_INPUT);
            diff_free(&diff);
            json_decref(old), json_decref(new);
        }
}

/* A figure that nobody knows, in either document: which one is said. */
TEST(unknown_figures)
{
    for (int which = 1; which < 4; which++) {
        json_t *old = run_with(1e-3, 1), *new = run_with(1e-3, 1);
        struct diff diff;
        struct error error = {0};
        if (which & 1) json_object_set_new(old, "surprise", json_real(1));
        if (which & 2) json_object_set_new(new, "wonder", json_real(1));
        assert_int_equal(diff_documents(old, new, DIFF_THRESHOLD, &diff, &error), STATUS_BAD_INPUT);
        const char *said = which & 1 ? "old document: surprise: " : "new document: wonder: ";
        assert_int_equal(strncmp(error.message, said, strlen(said)), 0);
        diff_free(&diff);
        json_decref(old), json_decref(new);
    }
}
