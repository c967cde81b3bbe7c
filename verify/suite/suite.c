/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "suite.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check_run.h"
#include "clock.h"
#include "list.h"

static void free_figures(struct figure *figures, size_t n)
{
    for (size_t i = 0; i < n; i++) free(figures[i].subject);
    free(figures);
}

static void free_series(struct series *series, size_t n)
{
    for (size_t i = 0; i < n; i++) free(series[i].label), free(series[i].x), free(series[i].y);
    free(series);
}

void suite_free(struct suite *suite)
{
    free_figures(suite->figures, suite->figure_count);
    free_series(suite->series, suite->series_count);
    free(suite->outcomes);
    *suite = (struct suite){0};
}

/* Moves the run's figures into the suite, and its series if a figure failed. */
static bool take_figures(struct suite *suite, struct check_run *run)
{
    size_t failed = 0;
    for (size_t i = 0; i < run->figure_count; i++) {
        if (!list_grow(&suite->figures, suite->figure_count, sizeof *suite->figures)) return false;
        suite->figures[suite->figure_count++] = run->figures[i];
        failed += run->figures[i].status == FINDING_FAIL;
        run->figures[i].subject = NULL;
    }
    suite->failed += failed; /* callers may stop at the first failure */
    for (size_t i = 0; failed && i < run->series_count; i++) {
        if (!list_grow(&suite->series, suite->series_count, sizeof *suite->series)) return false;
        suite->series[suite->series_count++] = run->series[i];
        run->series[i] = (struct series){0};
    }
    return true;
}

void suite_run_free(struct check_run *run)
{
    for (size_t i = 0; i < run->subject_count; i++) free(run->subjects[i].copy);
    free(run->subjects);
    free_figures(run->figures, run->figure_count);
    free_series(run->series, run->series_count);
}

/* Fails a run without any measured figure. */
static void refuse_silence(struct check_run *run)
{
    size_t measured = 0;
    for (size_t i = 0; i < run->figure_count; i++)
        measured += run->figures[i].status != FINDING_SKIP;
    if (run->figure_count == 0)
        check_measure(run, 1, 0, 0, "harness: the check measured nothing at all");
    else if (measured == 0)
        check_measure(run, 1, 0, 0, "harness: the check measured nothing, it skipped all %zu",
                      run->figure_count);
}

static bool run_subjects(struct suite *suite, const struct check *check)
{
    struct check_run run = {.check = check};
    if (check->subjects)
        check->subjects(&run);
    else
        check_subject(&run, NULL, 0);
    for (size_t i = 0; i < run.subject_count; i++) {
        const struct subject *subject = &run.subjects[i];
        const size_t before = run.figure_count;
        run.began = clock_wall();
        check->measure(&run, subject->copy ? subject->copy : subject->given);
        if (run.figure_count == before && run.subject_count > 1)
            check_measure(
                &run, 1, 0, 0,
                "harness: nothing was measured on subject %zu of %zu, and no reason given", i + 1,
                run.subject_count);
    }
    refuse_silence(&run);
    const bool sound = !run.no_memory && take_figures(suite, &run);
    suite_run_free(&run);
    return sound;
}

static struct mutant_outcome judge_mutant(const struct check_run *run,
                                          const struct check_mutant *mutant)
{
    struct mutant_outcome outcome = {run->check, mutant, (double)NAN, (double)NAN, false};
    double worst = -1;
    for (size_t i = 0; i < run->figure_count; i++) {
        const struct figure *figure = &run->figures[i];
        const double ratio = finding_ratio(figure->value, figure->bound);
        outcome.detected = outcome.detected || figure->status == FINDING_FAIL;
        if (figure->status == FINDING_SKIP || !(ratio > worst)) continue;
        worst = ratio;
        outcome.value = figure->value;
        outcome.bound = figure->bound;
    }
    return outcome;
}

static bool run_mutants(struct suite *suite, const struct check *check)
{
    bool any = false, sound = true;
    for (const struct check_mutant *mutant = check->mutants; sound && mutant && mutant->name;
         mutant++) {
        struct check_run run = {.check = check, .began = clock_wall(), .mutant = true};
        check->measure(&run, mutant->subject);
        const struct mutant_outcome outcome = judge_mutant(&run, mutant);
        any = any || outcome.detected;
        sound = !run.no_memory && list_grow(&suite->outcomes, suite->outcome_count, sizeof outcome);
        if (sound) suite->outcomes[suite->outcome_count++] = outcome;
        suite_run_free(&run);
    }
    if (sound && !any) {
        struct check_run run = {.check = check, .began = clock_wall()};
        check_measure(&run, 1, 0, 0, "harness: the check is vacuous, it rejects no mutant");
        sound = !run.no_memory && take_figures(suite, &run);
        suite_run_free(&run);
    }
    return sound;
}

/* Distinct mutants; one that is listed by several checks must be rejected by each of them. */
static void count_mutants(struct suite *suite)
{
    for (size_t i = 0; i < suite->outcome_count; i++) {
        const char *name = suite->outcomes[i].mutant->name;
        bool first = true, detected = true;
        for (size_t j = 0; j < suite->outcome_count; j++)
            if (strcmp(suite->outcomes[j].mutant->name, name) == 0) {
                first = first && j >= i;
                detected = detected && suite->outcomes[j].detected;
            }
        suite->mutants += first;
        suite->mutants_detected += first && detected;
    }
}

enum status suite_count(struct suite *suite)
{
    suite->passed = suite->failed = suite->skipped = suite->mutants = suite->mutants_detected = 0;
    for (size_t i = 0; i < suite->figure_count; i++) {
        suite->passed += suite->figures[i].status == FINDING_PASS;
        suite->failed += suite->figures[i].status == FINDING_FAIL;
        suite->skipped += suite->figures[i].status == FINDING_SKIP;
    }
    count_mutants(suite);
    return suite->failed || suite->mutants_detected < suite->mutants ? STATUS_CHECK_FAILED
                                                                     : STATUS_OK;
}

bool suite_names(const char *name, const struct check *check)
{
    const size_t length = strcspn(name, "/");
    return strlen(check->group) == length && strncmp(name, check->group, length) == 0 &&
           (!name[length] || strcmp(name + length + 1, check->name) == 0);
}

double suite_cost(const struct check *check)
{
    const double few = 0.03; /* for a check without a cost */
    return check->cost > 0 ? check->cost : few;
}

bool suite_chosen(const struct check *check, const struct suite_choice *choice)
{
    if (check->slow && !choice->slow) return false;
    for (size_t i = 0; i < choice->group_count; i++)
        if (suite_names(choice->groups[i], check)) return true;
    return choice->group_count == 0;
}

/* The checks in the given order or, with by_rank, by increasing rank: the least names the cause. */
static const struct check **in_order(const struct check *const *checks, size_t count, bool by_rank)
{
    const struct check **ordered = malloc(count * sizeof *ordered);
    for (size_t i = 0; ordered && i < count; i++) {
        size_t k = i;
        for (; by_rank && k > 0 && ordered[k - 1]->rank > checks[i]->rank; k--)
            ordered[k] = ordered[k - 1];
        ordered[k] = checks[i];
    }
    return ordered;
}

enum status suite_run(struct suite *suite, const struct check *const *checks, size_t count,
                      const struct suite_choice *choice, struct error *error)
{
    const double began = clock_wall();
    const struct check **ordered = in_order(checks, count, choice->first);
    bool sound = ordered != NULL;
    *suite = (struct suite){0};
    for (size_t i = 0; i < count && sound && !(choice->first && suite->failed); i++) {
        const struct check *check = ordered[i];
        if (!suite_chosen(check, choice)) continue;
        if (choice->progress) choice->progress(choice->context, check, i, count);
        sound = run_subjects(suite, check) && (!choice->mutants || run_mutants(suite, check));
    }
    free(ordered);
    if (!sound) {
        suite_free(suite);
        return error_set(error, STATUS_ENVIRONMENT, "verify: no memory");
    }
    suite->seconds = clock_wall() - began;
    return suite_count(suite);
}

const char **suite_groups(const struct check *const *checks, size_t count, size_t *total)
{
    size_t n = 0;
    const char **names = malloc(count * sizeof *names);
    for (size_t i = 0; names && i < count; i++) {
        bool known = false;
        for (size_t j = 0; j < n; j++) known = known || strcmp(names[j], checks[i]->group) == 0;
        if (!known) names[n++] = checks[i]->group;
    }
    *total = n;
    return names;
}
