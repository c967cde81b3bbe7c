/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the harness that runs checks: what fails, what is vacuous, what is counted; and that the
 * registry is in order. Arguments: the groups that meson runs, one test each. */
#include "test.h"

#include "check_registry.h"
#include "sample_checks.h"
#include "worst.h"

static struct suite run(const struct check *check, bool mutants, enum status expected)
{
    struct suite suite;
    const struct suite_choice choice = {.mutants = mutants};
    assert_int_equal(suite_run(&suite, &check, 1, &choice, NULL), expected);
    return suite;
}

TEST(counts)
{
    static const struct {
        const struct check *check;
        bool mutants;
        enum status status;
        size_t passed, failed, mutant_count, detected, series;
    } rows[] = {{&good, true, STATUS_OK, 1, 0, 2, 2, 0},
                {&failing, false, STATUS_CHECK_FAILED, 1, 2, 0, 0, 3},
                {&leaky, true, STATUS_CHECK_FAILED, 1, 0, 2, 1, 0},
                {&vacuous, true, STATUS_CHECK_FAILED, 1, 1, 1, 0, 0},
                {&bare, true, STATUS_CHECK_FAILED, 1, 1, 0, 0, 0},
                {&bare, false, STATUS_OK, 1, 0, 0, 0, 0}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct suite suite = run(rows[k].check, rows[k].mutants, rows[k].status);
        assert_int_equal(suite.passed, rows[k].passed);
        assert_int_equal(suite.failed, rows[k].failed);
        assert_int_equal(suite.mutants, rows[k].mutant_count);
        assert_int_equal(suite.mutants_detected, rows[k].detected);
        assert_int_equal(suite.series_count, rows[k].series);
        suite_free(&suite);
    }
}

static const double nothing = 0.25, something = 0.5;

static void nothing_subject(struct check_run *run)
{
    check_subject(run, &nothing, 0);
}

static void something_and_nothing(struct check_run *run)
{
    check_subject(run, &something, sizeof something);
    check_subject(run, &nothing, sizeof nothing);
}

static void no_subjects(struct check_run *run)
{
    (void)run;
}

static void skips(struct check_run *run, const void *subject)
{
    (void)subject;
    check_skip(run, "not today");
}

/* Figures of the harness itself have the value 1 and the bound 0. */
static void expect_one_failure(const struct check *check, bool mutants, const char *says)
{
    struct suite suite = run(check, mutants, STATUS_CHECK_FAILED);
    assert_int_equal(suite.failed, 1);
    const struct figure *last = &suite.figures[suite.figure_count - 1];
    assert_int_equal(last->status, FINDING_FAIL);
    assert_true(last->value == 1 && last->bound == 0 && last->floor == 0);
    assert_memory_equal(last->subject, "harness: ", 9);
    assert_non_null(strstr(last->subject, says));
    suite_free(&suite);
}

/* Checks without a subject, without figures for all subjects or for one, one that skips all, and
 * one that rejects no mutant. */
TEST(measures_nothing)
{
    struct check silent = failing;
    silent.subjects = nothing_subject;
    expect_one_failure(&silent, false, "nothing at all");
    silent.subjects = no_subjects;
    expect_one_failure(&silent, false, "nothing at all");
    silent.subjects = something_and_nothing;
    expect_one_failure(&silent, false, "subject 2 of 2");
    silent = good;
    silent.measure = skips;
    expect_one_failure(&silent, false, "skipped all 1");
    expect_one_failure(&vacuous, true, "vacuous");
}

/* More subjects than any array of a plausible fixed size. */
static void many_subjects(struct check_run *run)
{
    for (int i = 0; i < 5000; i++) {
        const double value = i / 1e4;
        check_subject(run, &value, sizeof value);
    }
}

static void measure_one(struct check_run *run, const void *subject)
{
    check_measure(run, *(const double *)subject, 1, 0, "%g", *(const double *)subject);
}

TEST(checks_of_many_subjects)
{
    struct check many = failing;
    many.subjects = many_subjects;
    many.measure = measure_one;
    struct suite suite = run(&many, false, STATUS_OK);
    assert_int_equal(suite.passed, 5000);
    for (int i = 0; i < 5000; i++) assert_true(suite.figures[i].value == i / 1e4);
    suite_free(&suite);
}

TEST(worst_figures)
{
    double worst = 0;
    worst_keep(&worst, 2);
    worst_keep(&worst, 1);
    near_absolute(worst, 2, 0);
    worst_keep(&worst, (double)NAN);
    worst_keep(&worst, 3);
    assert_true(isnan(worst));
}

static void below_floor(struct check_run *run, const void *subject)
{
    (void)subject;
    check_measure(run, 0, 1e-16, 1e-15, "bound below its floor");
    check_skip(run, "not %s", "here");
}

TEST(floor_and_skip)
{
    struct check check = good;
    check.measure = below_floor;
    struct suite suite = run(&check, false, STATUS_CHECK_FAILED);
    assert_int_equal(suite.failed, 1);
    assert_int_equal(suite.skipped, 1);
    suite_free(&suite);
}

TEST(groups_are_chosen)
{
    const struct check *const checks[] = {&good, &bare};
    const char *const groups[] = {"b"};
    const struct suite_choice choice = {.groups = groups, .group_count = 1};
    struct suite suite;
    assert_int_equal(suite_run(&suite, checks, 2, &choice, NULL), STATUS_OK);
    assert_int_equal(suite.figure_count, 1);
    assert_ptr_equal(suite.figures[0].check, &bare);
    suite_free(&suite);
}

/* Slow checks run only on request; progress is the number of checks done of all. */
static void note_progress(void *context, const struct check *check, size_t done, size_t total)
{
    char *text = context;
    const size_t used = strlen(text);
    snprintf(text + used, 64 - used, "%s %zu/%zu;", check->name, done, total);
}

TEST(slow_and_progress)
{
    struct check slow = bare;
    slow.slow = true;
    const struct check *const checks[] = {&good, &slow, &bare};
    for (int asked = 0; asked < 2; asked++) {
        char text[64] = "";
        const struct suite_choice choice = {
            .slow = asked, .progress = note_progress, .context = text};
        struct suite suite;
        assert_int_equal(suite_run(&suite, checks, 3, &choice, NULL), STATUS_OK);
        assert_int_equal(suite.passed, 2 + asked);
        assert_string_equal(text, asked ? "good 0/3;bare 1/3;bare 2/3;" : "good 0/3;bare 2/3;");
        suite_free(&suite);
    }
}

/* A mutant of several checks counts once, and is detected if all of them detect it. */
TEST(mutants_are_distinct)
{
    const struct check *const checks[] = {&good, &leaky};
    const struct suite_choice choice = {.mutants = true};
    struct suite suite;
    assert_int_equal(suite_run(&suite, checks, 2, &choice, NULL), STATUS_CHECK_FAILED);
    assert_int_equal(suite.outcome_count, 4);
    assert_int_equal(suite.mutants, 3); /* two, nan, one */
    assert_int_equal(suite.mutants_detected, 2);
    suite_free(&suite);
}

static void equally_far(struct check_run *run, const void *subject)
{
    if (!subject) {
        check_measure(run, 0, 1, 0, "right");
        return;
    }
    check_skip(run, "not this");
    check_measure(run, 1, 2, 0, "nearer");
    check_measure(run, 4, 2, 0, "first");
    check_measure(run, 6, 3, 0, "as far");
}

/* Of figures that fail by equal factors the first one is named. */
TEST(mutant_value)
{
    struct check check = good;
    check.measure = equally_far;
    struct suite suite = run(&check, true, STATUS_OK);
    assert_true(suite.outcomes[0].value == 4 && suite.outcomes[0].bound == 2);
    suite_free(&suite);
}

TEST(groups_are_listed_once)
{
    const struct check *const checks[] = {&bare, &good, &leaky, &failing};
    size_t n;
    const char **names = suite_groups(checks, 4, &n);
    assert_non_null(names);
    assert_int_equal(n, 2);
    assert_string_equal(names[0], "b");
    assert_string_equal(names[1], "a");
    free(names);
    names = suite_groups(checks + 1, 1, &n);
    assert_int_equal(n, 1);
    free(names);
}

static void two_figures(struct check_run *run, const void *subject)
{
    static const double x[] = {1};
    (void)subject;
    check_measure(run, 2, 1, 0, "fails");
    check_measure(run, 0, 1, 0, "passes");
    check_skip(run, "skipped");
    check_skip(run, "skipped");
    check_series(run, "data", 1, x, x);
}

/* With --first no check runs after the first failure, but the failing one is completed. */
TEST(first_failure)
{
    struct check both = bare;
    both.measure = two_figures;
    const struct check *const checks[] = {&bare, &both, &bare};
    for (int first = 0; first < 2; first++) {
        const struct suite_choice choice = {.first = first};
        struct suite suite;
        assert_int_equal(suite_run(&suite, checks, 3, &choice, NULL), STATUS_CHECK_FAILED);
        assert_int_equal(suite.figure_count, first ? 5 : 6);
        assert_true(suite.failed == 1 && suite.skipped == 2 && suite.passed == (first ? 2 : 3));
        assert_int_equal(suite.series_count, 1);
        near_inside(suite.seconds, 1e-12, 60);
        for (size_t i = 0; i < suite.figure_count; i++)
            near_inside(suite.figures[i].seconds, 0, 60);
        suite_free(&suite);
    }
}

/* The first failure is that of the check of least rank, and among equal ranks the first in
 * order. */
TEST(first_failure_names_the_cause)
{
    struct check follows = bare, cause = bare, later = bare;
    follows.measure = cause.measure = later.measure = two_figures;
    follows.rank = 150, cause.rank = later.rank = 101;
    const struct check *const checks[] = {&follows, &cause, &later};
    for (int first = 0; first < 2; first++) {
        const struct suite_choice choice = {.first = first};
        struct suite suite;
        assert_int_equal(suite_run(&suite, checks, 3, &choice, NULL), STATUS_CHECK_FAILED);
        assert_int_equal(suite.failed, first ? 1 : 3);
        assert_ptr_equal(suite.figures[0].check, first ? &cause : &follows);
        suite_free(&suite);
    }
}

static void skips_then_measures(struct check_run *run, const void *subject)
{
    (void)subject;
    check_skip(run, "not this");
    check_measure(run, 0, 1, 0, "but this");
}

/* One measured figure suffices. */
TEST(one_figure)
{
    struct check late = bare;
    late.measure = skips_then_measures;
    struct suite suite = run(&late, false, STATUS_OK);
    assert_true(suite.passed == 1 && suite.skipped == 1);
    suite_free(&suite);
}

static const double zero = 0;
static const struct check_mutant unharmed[] = {
    {"none", "", &zero}, {"one", "", &values[1]}, {"two", "", &values[2]}, {0}};

/* For a missed mutant its figure is reported, however far below the bound. */
TEST(value_of_a_miss)
{
    struct check check = leaky;
    check.mutants = unharmed;
    struct suite suite = run(&check, true, STATUS_CHECK_FAILED);
    for (int i = 0; i < 3; i++)
        assert_true(suite.outcomes[i].value == i && suite.outcomes[i].bound == 1);
    suite_free(&suite);
}

TEST(names_ratios_and_costs)
{
    static const struct {
        const char *name;
        bool is;
    } rows[] = {{"a", true},        {"a/good", true}, {"a/goods", false}, {"a/goo", false},
                {"b", false},       {"", false},      {"b/good", false},  {"ab", false},
                {"aa/good", false}, {"a/", false},    {"good", false}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        assert_int_equal(suite_names(rows[k].name, &good), rows[k].is);
    const char *const groups[] = {"c", "a/other", "a/good", "d"};
    assert_true(suite_chosen(&good, &(struct suite_choice){.groups = groups, .group_count = 4}));
    assert_false(suite_chosen(&good, &(struct suite_choice){.groups = groups, .group_count = 2}));
    struct check costly = good;
    near_relative(suite_cost(&good), 0.03, 1e-15);
    costly.cost = 0.001;
    assert_true(suite_cost(&costly) == 0.001);
    costly.cost = -1;
    near_relative(suite_cost(&costly), 0.03, 1e-15);
}

/* As many groups as there are checks. */
TEST(many_groups)
{
    enum { N = 5000 };
    static char names[N][16];
    static struct check checks[N];
    static const struct check *list[N];
    size_t n;
    for (int i = 0; i < N; i++) {
        snprintf(names[i], sizeof names[i], "g%d", i);
        checks[i].group = names[i];
        list[i] = &checks[i];
    }
    const char **groups = suite_groups(list, N, &n);
    void *behind = malloc(64);
    assert_int_equal(n, N);
    assert_true(groups[0] == names[0] && groups[N - 1] == names[N - 1]);
    free(behind);
    free(groups);
}

TEST(registered_checks)
{
    for (size_t i = 0; i < check_registry_count; i++) {
        const struct check *c = check_registry[i];
        assert_true(c->mutants && c->mutants[0].name && c->property[0]);
        for (size_t j = 0; j < i; j++)
            assert_false(strcmp(c->group, check_registry[j]->group) == 0 &&
                         strcmp(c->name, check_registry[j]->name) == 0);
    }
    size_t n;
    const char **names = suite_groups(check_registry, check_registry_count, &n);
    assert_non_null(names);
    assert_true(test_word((int)n) && !test_word((int)n + 1));
    for (size_t i = 0; i < n; i++) {
        int j = 1;
        while (test_word(j) && strcmp(names[i], test_word(j)) != 0) j++;
        assert_non_null(test_word(j));
    }
    free(names);
}
