/* SPDX-License-Identifier: GPL-3.0-or-later
 * Small checks for tests of the harness: some pass, one fails, one misses a mutant, some are
 * vacuous. Each measures a given number. */
#pragma once

#include "suite.h"

static const double values[] = {0.5, 1, 2, (double)NAN};

/* The figure is the number that the subject points to; the bound is 1. */
static inline void measure(struct check_run *run, const void *subject)
{
    const double *value = subject ? subject : &values[0];
    const double x[] = {1, 2}, y[] = {3, *value};
    if (*value == 0.25) return;
    check_measure(run, *value, 1, 0, "value <%g>", *value);
    check_series(run, "data", 2, x, y);
}

static const struct check_mutant caught[] = {{"two", "", &values[2]}, {"nan", "", &values[3]}, {0}};
static const struct check_mutant slipped[] = {
    {"one", "", &values[1]}, {"two", "", &values[2]}, {0}};
static const struct check_mutant idle[] = {{"one", "", &values[1]}, {0}};

static inline void failing_subjects(struct check_run *run)
{
    for (size_t i = 1; i < 4; i++) check_subject(run, &values[i], sizeof values[i]);
}

static const struct check good = {
    .group = "a", .name = "good", .property = "p", .measure = measure, .mutants = caught};
static const struct check leaky = {
    .group = "b", .name = "leaky", .property = "p", .measure = measure, .mutants = slipped};
static const struct check vacuous = {
    .group = "b", .name = "vacuous", .property = "p", .measure = measure, .mutants = idle};
static const struct check bare = {
    .group = "b", .name = "bare", .property = "p", .measure = measure};
static const struct check failing = {.group = "a",
                                     .name = "failing",
                                     .property = "p",
                                     .subjects = failing_subjects,
                                     .measure = measure,
                                     .mutants = caught};
