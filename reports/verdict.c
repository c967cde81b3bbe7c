/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verdict.h"

#include <stdlib.h>
#include <string.h>

#include "buffer.h"
#include "findings.h"
#include "result.h"
#include "value.h"

enum { STATUSES = FINDING_SKIP + 1 };

/* Number of findings by status. */
struct tally {
    int checks[STATUSES], gates[STATUSES], runs[STATUSES], faults[STATUSES];
};

static struct tally count(const struct findings *findings)
{
    struct tally tally = {0};
    for (size_t i = 0; i < findings->count; i++) {
        const struct finding *finding = &findings->list[i];
        const int area = finding->rank;
        int *counts = area < AREA_DETECTION ? tally.checks
                      : area == AREA_CONVERGENCE || area == AREA_GATE || area == AREA_BUDGET ||
                              area == AREA_STUDY
                          ? tally.gates
                      : area == AREA_RUN   ? tally.runs
                      : area == AREA_FAULT ? tally.faults
                                           : NULL;
        if (counts) counts[finding->status]++;
    }
    return tally;
}

/* Writes "271 judged, 30 too coarse to judge, 2 undetermined, 6 known weaknesses" for the orders
 * and errors of runs. */
static void gates_words(struct buffer *to, const struct tally *tally)
{
    const int *gates = tally->gates;
    buffer_format(to, "%d judged", gates[FINDING_PASS] + gates[FINDING_FAIL]);
    if (gates[FINDING_FAIL]) buffer_format(to, " (%d failed)", gates[FINDING_FAIL]);
    if (gates[FINDING_SMOKE]) buffer_format(to, ", %d too coarse to judge", gates[FINDING_SMOKE]);
    if (gates[FINDING_UNDETERMINED])
        buffer_format(to, ", %d undetermined", gates[FINDING_UNDETERMINED]);
    if (gates[FINDING_KNOWN])
        buffer_format(to, ", %d known weakness%s", gates[FINDING_KNOWN],
                      gates[FINDING_KNOWN] == 1 ? "" : "es");
}

/* Writes the number of failures and the first one: its name and, for a check, its subject. */
static void headline(struct buffer *to, const struct tally *tally, const json_t *failures)
{
    size_t count = json_array_size(failures);
    const json_t *first = json_array_get(failures, 0);
    const char *area = value_text(first, "area"), *subject = value_text(first, "subject");
    /* these names need no area */
    bool plain = !strcmp(area, "check") || !strcmp(area, "convergence") || !strcmp(area, "budget");
    if (!count) {
        const bool all = !tally->gates[FINDING_SMOKE] && !tally->gates[FINDING_UNDETERMINED] &&
                         !tally->gates[FINDING_KNOWN];
        buffer_add(to, all ? "All is well" : "All that could be judged is well: ");
        if (!all) gates_words(to, tally);
        return;
    }
    if (!strcmp(value_text(first, "name"), FINDINGS_NOTHING)) {
        buffer_add(to, FINDINGS_NOTHING);
        return;
    }
    buffer_format(to, "%zu %s%s%s%s", count, count == 1 ? "failure: " : "failures; look first at ",
                  plain ? "" : area, plain ? "" : " ", value_text(first, "name"));
    if (strstr(subject, "broke down")) return; /* it has no subject */
    enum { LONGEST = 64 };
    size_t length = strlen(subject), whole = length;
    if (length > LONGEST) /* cut at the end of a word */
        for (length = LONGEST; length && subject[length] != ' ';) length--;
    if (length && subject[length - 1] == ',') length--;
    if (length) buffer_format(to, " (%.*s%s)", (int)length, subject, length < whole ? " …" : "");
}

json_t *verdict_make(const json_t *results)
{
    const json_t *summary = json_object_get(json_object_get(results, "verify"), "summary");
    struct findings findings = {0};
    struct buffer words = {0};
    findings_of_report(&findings, results);
    const struct tally tally = count(&findings);
    json_t *failures = findings_failures(&findings);
    findings_free(&findings);
    if (!failures) return NULL;
    const int *checks = tally.checks, *gates = tally.gates, *runs = tally.runs;
    int ran = 0, faults = -tally.faults[FINDING_SKIP];
    for (int s = FINDING_PASS; s < STATUSES; s++) ran += runs[s], faults += tally.faults[s];
    headline(&words, &tally, failures);
    char *line = buffer_take(&words);
    gates_words(&words, &tally);
    char *judged = buffer_take(&words);
    json_t *verdict = NULL;
    if (line && judged)
        verdict = result_object(
            "status=%s headline=%s figures_passed=%d figures_failed=%d figures_skipped=%d "
            "mutants=%d mutants_detected=%d gates_passed=%d gates_failed=%d gates_smoke=%d "
            "gates_undetermined=%d gates_known=%d gates=%s runs=%d broke_down=%d faults=%d "
            "faults_right=%d failures=%p",
            json_array_size(failures) ? "fail" : "pass", line, checks[FINDING_PASS],
            checks[FINDING_FAIL], checks[FINDING_SKIP],
            (int)json_integer_value(json_object_get(summary, "mutants")),
            (int)json_integer_value(json_object_get(summary, "detected")), gates[FINDING_PASS],
            gates[FINDING_FAIL], gates[FINDING_SMOKE], gates[FINDING_UNDETERMINED],
            gates[FINDING_KNOWN], judged, ran, runs[FINDING_FAIL], faults,
            tally.faults[FINDING_PASS], (void *)failures);
    else
        json_decref(failures);
    free(line);
    free(judged);
    return verdict;
}
