/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests which settings must agree before `diff` compares two runs. */
#include "test.h"

#include "sample_diff.h"
#include "settings.h"

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

/* Settings that define the problem must agree; those of the scheme may differ, because schemes are
 * compared, and so may those that lay the particles otherwise, and the path of a file. */
TEST(settings_of_a_problem)
{
    static const enum setting free_to_differ[] = {
        SETTING_file,        SETTING_lattice,    SETTING_equal_masses, SETTING_grade,
        SETTING_grade_ratio, SETTING_mass_ratio, SETTING_skip};
    for (int key = 0; key < SETTINGS; key++) {
        bool counts = strcmp(setting_keys[key].section, "scheme") != 0;
        for (size_t k = 0; k < sizeof free_to_differ / sizeof *free_to_differ; k++)
            counts = counts && key != (int)free_to_differ[k];
        problem_is("run", "settings", setting_keys[key].name, counts);
    }
    problem_is("run", "settings", "nonsense", false);
}

/* Members of a document that define the problem; for a run only its case and mode. */
TEST(members_of_a_problem)
{
    static const struct {
        const char *command, *members[6];
    } rows[] = {{"run", {"case", "mode"}},
                {"kernel", {"kernel", "dim", "h", "case"}},
                {"gradient", {"dim", "operator", "kernel"}},
                {"riemann", {"left", "right", "gamma", "time", "x0"}},
                {"judge", {"n", "time", "window", "case"}}};
    static const char *const others[] = {"kernel", "dim", "h", "operator", "left", "time", "n"};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++)
        for (int k = 0; rows[r].members[k]; k++)
            problem_is(rows[r].command, NULL, rows[r].members[k], true);
    for (size_t k = 0; k < sizeof others / sizeof *others; k++)
        problem_is("run", NULL, others[k], false);
}
