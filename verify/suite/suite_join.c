/* SPDX-License-Identifier: GPL-3.0-or-later
 * Writes the result of a check as a document and adds it to another suite. */
#include <stdlib.h>
#include <string.h>

#include "list.h"
#include "suite.h"
#include "suite_output.h"
#include "value.h"

json_t *suite_keep(const struct suite *suite)
{
    json_t *document = json_object();
    suite_output_json(suite, document);
    json_object_set_new(document, "series", suite_output_series(suite, NULL));
    json_object_set_new(document, "seconds", json_real(suite->seconds));
    return document;
}

static bool is_of(const json_t *entry, const char *name, const struct check *check)
{
    return strcmp(value_text(entry, "group"), check->group) == 0 &&
           strcmp(value_text(entry, name), check->name) == 0;
}

static bool join_figure(struct suite *suite, const struct check *check, const json_t *entry)
{
    char message[VALUE_MESSAGE];
    const int status = value_need_word(entry, "status", finding_words, message);
    struct figure figure = {.check = check,
                            .value = value_member(entry, "value"),
                            .bound = value_member(entry, "bound"),
                            .floor = value_member(entry, "floor"),
                            .seconds = value_member(entry, "seconds"),
                            .status = (enum finding_status)status};
    if ((status != FINDING_PASS && status != FINDING_FAIL && status != FINDING_SKIP) ||
        !is_of(entry, "name", check) ||
        !list_grow(&suite->figures, suite->figure_count, sizeof figure) ||
        !(figure.subject = strdup(value_text(entry, "subject"))))
        return false;
    suite->figures[suite->figure_count++] = figure;
    return true;
}

static bool join_outcome(struct suite *suite, const struct check *check, const json_t *entry)
{
    const struct check_mutant *mutant = check->mutants;
    const char *name = value_text(entry, "mutant");
    while (mutant && mutant->name && strcmp(mutant->name, name) != 0) mutant++;
    if (!mutant || !mutant->name || !is_of(entry, "check", check) ||
        !list_grow(&suite->outcomes, suite->outcome_count, sizeof *suite->outcomes))
        return false;
    suite->outcomes[suite->outcome_count++] = (struct mutant_outcome){
        .check = check,
        .mutant = mutant,
        .value = value_member(entry, "value"),
        .bound = value_member(entry, "bound"),
        .detected = json_is_true(json_object_get(entry, "detected")),
    };
    return true;
}

static bool join_series(struct suite *suite, const struct check *check, const json_t *entry)
{
    size_t n, m;
    struct series series = {.check = check,
                            .label = strdup(value_text(entry, "label")),
                            .x = value_numbers(json_object_get(entry, "x"), &n),
                            .y = value_numbers(json_object_get(entry, "y"), &m)};
    series.n = n;
    if (n == m && series.label && list_grow(&suite->series, suite->series_count, sizeof series)) {
        suite->series[suite->series_count++] = series;
        return true;
    }
    free(series.label), free(series.x), free(series.y);
    return false;
}

static bool join_all(struct suite *suite, const struct check *check, const json_t *list,
                     bool (*join)(struct suite *, const struct check *, const json_t *))
{
    for (size_t i = 0; i < json_array_size(list); i++)
        if (!join(suite, check, json_array_get(list, i))) return false;
    return json_is_array(list);
}

enum status suite_join(struct suite *suite, const struct check *const *checks,
                       const json_t *const *documents, size_t count, struct error *error)
{
    *suite = (struct suite){0};
    for (size_t i = 0; i < count; i++) {
        const json_t *from = documents[i];
        if (json_array_size(json_object_get(from, "checks")) == 0 || /* suite_run leaves no such */
            !join_all(suite, checks[i], json_object_get(from, "checks"), join_figure) ||
            !join_all(suite, checks[i], json_object_get(from, "mutants"), join_outcome) ||
            !join_all(suite, checks[i], json_object_get(from, "series"), join_series)) {
            suite_free(suite);
            return error_set(error, STATUS_ENVIRONMENT,
                             "verify: what is kept of %s/%s is not of this program, or there is no "
                             "memory for it",
                             checks[i]->group, checks[i]->name);
        }
        suite->seconds += value_member(from, "seconds");
    }
    return suite_count(suite);
}
