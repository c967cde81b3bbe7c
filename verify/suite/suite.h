/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs checks on all their right subjects and, if requested, on their mutants. A check that rejects
 * none of its mutants is vacuous: a failure of the harness, reported as a figure. */
#pragma once

#include <jansson.h>

#include "check.h"
#include "finding.h"
#include "status.h"

struct figure {
    const struct check *check;
    char *subject; /* of a skipped figure: why */
    double value, bound, floor, seconds;
    enum finding_status status; /* PASS, FAIL or SKIP */
};

struct series {
    const struct check *check;
    char *label;
    size_t n;
    double *x, *y;
};

struct mutant_outcome {
    const struct check *check;
    const struct check_mutant *mutant;
    double value, bound; /* of the clearest failure, else of the largest figure; NaN: none */
    bool detected;
};

struct suite {
    struct figure *figures;
    struct mutant_outcome *outcomes; /* one for each check and mutant of it */
    struct series *series;           /* of failing checks only */
    size_t figure_count, outcome_count, series_count;
    size_t passed, failed, skipped;   /* figures */
    size_t mutants, mutants_detected; /* distinct names; a mutant counts as detected if every check
                                         that lists it detects it */
    double seconds;
};

struct suite_choice {
    const char *const *groups; /* GROUP or GROUP/NAME; NULL: all */
    size_t group_count;
    bool slow, mutants;
    bool first; /* run the checks by rank, and stop after the first that fails */
    void (*progress)(void *context, const struct check *check, size_t done, size_t total);
    void *context;
};

/* Runs the chosen checks of checks[0..count-1]. STATUS_CHECK_FAILED if a figure failed or a mutant
 * was not detected (suite is complete); STATUS_ENVIRONMENT: no memory (suite is empty). Free a
 * suite with suite_free. */
enum status suite_run(struct suite *suite, const struct check *const *checks, size_t count,
                      const struct suite_choice *choice, struct error *error);
void suite_free(struct suite *suite);

/* suite_keep: the result of suite_run for one check as a document. suite_join: the suite of several
 * checks from their documents in the order of the checks. STATUS_*: as suite_run, and
 * STATUS_ENVIRONMENT if a document does not belong to its check; the suite is then empty. */
json_t *suite_keep(const struct suite *suite);
enum status suite_join(struct suite *suite, const struct check *const *checks,
                       const json_t *const *documents, size_t count, struct error *error);

/* Estimated seconds of a check including its mutants, above 0. */
double suite_cost(const struct check *check);

bool suite_chosen(const struct check *check, const struct suite_choice *choice);

/* Counts figures and outcomes when the suite is complete. STATUS_OK or STATUS_CHECK_FAILED. */
enum status suite_count(struct suite *suite);

/* True if GROUP or GROUP/NAME means this check. */
bool suite_names(const char *name, const struct check *check);

/* The distinct groups of checks[0..count-1], in order, and their number; to be freed. NULL: no
 * memory. */
const char **suite_groups(const struct check *const *checks, size_t count, size_t *total);
