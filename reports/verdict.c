/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verdict.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "buffer.h"
#include "failure.h"
#include "html.h"
#include "value.h"

/* What became of a figure or a gate. Only FAIL fails anything, and only PASS and FAIL are judged.
 */
enum answer { FAIL, PASS, SKIP, KNOWN, SMOKE, UNDETERMINED };
enum { GATE_ANSWERS = UNDETERMINED + 1 };

struct tally {
    struct failure_list failures;
    int figures_passed, figures_failed, figures_skipped;
    int mutants, detected;
    int gates[GATE_ANSWERS];
    int runs, broke_down;
    int faults, faults_right;
};

/* Takes detail. */
static void fail(struct tally *tally, const char *area, const char *name, struct buffer *detail,
                 const char *command)
{
    char *text = buffer_take(detail);
    failure_add(&tally->failures, area, name, text, command);
    free(text);
}

/* Where the results are not what a report holds, nothing may pass for well. */
static void unreadable(struct tally *tally, const char *what, const char *message)
{
    struct buffer detail = {0};
    buffer_format(&detail, "results that cannot be read: %s", message);
    fail(tally, "harness", what, &detail, "sphproof report --force");
}

/* The status of an entry; `skip` is its word for neither. One that is none of these is a failure of
 * its own and counts as SKIP. */
static enum answer answer_of(struct tally *tally, const json_t *entry, const char *skip,
                             const char *what)
{
    const char *const words[] = {"fail", "pass", skip, "known", "smoke", "undetermined", NULL};
    char message[VALUE_MESSAGE];
    const int word = value_need_word(entry, "status", words, message);
    if (word >= 0) return (enum answer)word;
    unreadable(tally, what, message);
    return SKIP;
}

static void judge_figure(struct tally *tally, const json_t *figure, const char *verify)
{
    const enum answer answer = answer_of(tally, figure, "skip", value_text(figure, "name"));
    tally->figures_passed += answer == PASS;
    tally->figures_skipped += answer == SKIP;
    tally->figures_failed += answer == FAIL;
    if (answer != FAIL) return;
    struct buffer detail = {0}, command = {0};
    double value = value_member(figure, "value"), bound = value_member(figure, "bound");
    buffer_format(&detail, "%s: ", value_text(figure, "subject"));
    html_number(&detail, value);
    buffer_add(&detail, " is not <= ");
    html_number(&detail, bound);
    if (bound > 0 && isfinite(value)) {
        buffer_add(&detail, " (");
        html_number(&detail, value / bound);
        buffer_add(&detail, " times the bound)");
    }
    buffer_format(&command, "%s %s", verify, value_text(figure, "group"));
    double excess = isfinite(value) && bound > 0 ? value / bound : (double)INFINITY;
    failure_add_check(&tally->failures, figure, excess, detail.data, command.data);
    buffer_free(&detail);
    buffer_free(&command);
}

static void judge_verify(struct tally *tally, const json_t *verify)
{
    const json_t *summary = json_object_get(verify, "summary");
    tally->mutants = (int)json_integer_value(json_object_get(summary, "mutants"));
    tally->detected = (int)json_integer_value(json_object_get(summary, "detected"));
    size_t i;
    const json_t *entry;
    json_array_foreach(json_object_get(verify, "checks"), i, entry)
        judge_figure(tally, entry, value_text_or(verify, "reproduce", "sphproof verify"));
    json_array_foreach(json_object_get(verify, "mutants"), i, entry) {
        if (json_is_true(json_object_get(entry, "detected"))) continue;
        struct buffer detail = {0}, command = {0};
        buffer_format(&command, "%s --mutants",
                      value_text_or(verify, "reproduce", "sphproof verify"));
        buffer_format(&detail, "the wrong variant '%s' passes: value ",
                      value_text(entry, "mutant"));
        html_number(&detail, value_member(entry, "value"));
        buffer_add(&detail, ", bound ");
        html_number(&detail, value_member(entry, "bound"));
        if (command.data)
            fail(tally, "detection", value_text(entry, "check"), &detail, command.data);
        buffer_free(&command);
    }
}

/* What a run alone has to keep: errors below bounds, conservation. */
static void judge_gate(struct tally *tally, const json_t *run, const json_t *gate)
{
    const enum answer answer = answer_of(tally, gate, "none", value_text(run, "case"));
    tally->gates[answer]++;
    if (answer != FAIL) return;
    struct buffer detail = {0}, name = {0};
    buffer_format(&name, "%s, %s: %s", value_text(run, "case"), value_text(run, "label"),
                  value_text(gate, "name"));
    buffer_add(&detail, "the error of the run, ");
    html_number(&detail, value_member(gate, "value"));
    buffer_add(&detail, ", is not <= ");
    html_number(&detail, value_member(gate, "bound"));
    if (!name.failed) fail(tally, "gate", name.data, &detail, value_text(run, "reproduce"));
    buffer_free(&name);
}

static void judge_run(struct tally *tally, const json_t *run)
{
    static const char *const words[] = {"ok", "broke_down", "failed", NULL};
    char message[VALUE_MESSAGE];
    const int word = value_need_word(run, "status", words, message);
    size_t i;
    const json_t *gate;
    tally->runs++;
    json_array_foreach(json_object_get(run, "gates"), i, gate) judge_gate(tally, run, gate);
    if (word < 0) unreadable(tally, value_text(run, "case"), message);
    if (word < 1) return;
    tally->broke_down++;
    struct buffer detail = {0};
    buffer_format(&detail, "%s: %s", word == 1 ? "broke down" : words[word],
                  value_text(run, "message"));
    fail(tally, "run", value_text(run, "case"), &detail, value_text(run, "reproduce"));
}

static void judge_still_gas(struct tally *tally, const json_t *study, const json_t *still)
{
    const enum answer answer = answer_of(tally, still, "none", "still gas");
    tally->gates[answer]++;
    if (answer != FAIL) return;
    struct buffer detail = {0}, name = {0};
    buffer_format(&name, "%s, %s: still gas", value_text(study, "case"),
                  value_text(study, "label"));
    buffer_add(&detail, "gas that no wave has reached moves at ");
    html_number(&detail, value_member(still, "value"));
    buffer_add(&detail, " of its sound speed, allowed is ");
    html_number(&detail, value_member(still, "bound"));
    if (!name.failed) fail(tally, "budget", name.data, &detail, value_text(study, "reproduce"));
    buffer_free(&name);
}

/* What gave no result at all. */
static void judge_trouble(struct tally *tally, const json_t *trouble)
{
    struct buffer detail = {0};
    buffer_add(&detail, value_text(trouble, "message"));
    fail(tally, "harness", value_text(trouble, "name"), &detail, "sphproof report --force");
}

static void judge_study(struct tally *tally, const json_t *study)
{
    size_t i;
    const json_t *order;
    json_array_foreach(json_object_get(study, "orders"), i, order) {
        const enum answer answer = answer_of(tally, order, "none", value_text(study, "case"));
        tally->gates[answer]++;
        if (answer != FAIL) continue;
        struct buffer detail = {0}, name = {0};
        buffer_format(&name, "%s, %s: order of %s(%s)", value_text(study, "case"),
                      value_text(study, "label"), value_text(order, "norm"),
                      value_text(order, "field"));
        html_number(&detail, value_member(order, "order"));
        buffer_add(&detail, " (95 % interval ");
        html_number(&detail, value_member(order, "low"));
        buffer_add(&detail, " to ");
        html_number(&detail, value_member(order, "high"));
        buffer_format(&detail, ") %s", value_text(order, "why"));
        if (!name.failed)
            fail(tally, "convergence", name.data, &detail, value_text(study, "reproduce"));
        buffer_free(&name);
    }
    json_array_foreach(json_object_get(study, "floors"), i, order) {
        if (!*value_text(order, "suspicion")) continue;
        struct buffer detail = {0};
        buffer_format(&detail, "too good to be true: %s", value_text(order, "suspicion"));
        fail(tally, "suspicion", value_text(study, "case"), &detail,
             value_text(study, "reproduce"));
    }
    json_array_foreach(json_object_get(study, "budgets"), i, order) {
        judge_still_gas(tally, study, json_object_get(order, "still_gas"));
    }
    if (*value_text(study, "suspicion")) {
        struct buffer detail = {0};
        buffer_format(&detail, "too good to be true: %s", value_text(study, "suspicion"));
        fail(tally, "suspicion", value_text(study, "case"), &detail,
             value_text(study, "reproduce"));
    }
    const bool failed = !strcmp(value_text(study, "status"), "failed");
    if (failed || !strcmp(value_text(study, "status"), "broke_down")) {
        struct buffer detail = {0};
        tally->gates[FAIL]++;
        buffer_format(&detail, "%s: %s", failed ? "failed" : "broke down",
                      value_text(study, "message"));
        fail(tally, "study", value_text(study, "case"), &detail, value_text(study, "reproduce"));
    }
}

static void judge_stress(struct tally *tally, const json_t *failure)
{
    struct buffer detail = {0};
    buffer_add(&detail, value_text(failure, "detail"));
    fail(tally, "stress", value_text(failure, "name"), &detail, value_text(failure, "command"));
}

/* What survived in the report before and breaks down now. That more breaks down than ever is seen
 * in no bound. */
static void judge_since(struct tally *tally, const json_t *figure)
{
    if (strcmp(value_text(figure, "new"), "broke_down") ||
        strcmp(value_text(figure, "verdict"), "worse"))
        return;
    struct buffer detail = {0};
    buffer_format(&detail, "it was '%s' in the report before", value_text(figure, "old"));
    buffer_add(&detail, ", and breaks down now");
    fail(tally, "stress", value_text(figure, "path"), &detail, "sphproof stress");
}

/* What the world did to the program; a fault that could not be brought about does not count. */
static void judge_fault(struct tally *tally, const json_t *fault)
{
    const enum answer answer = answer_of(tally, fault, "skip", "faults.json");
    tally->faults += answer != SKIP;
    tally->faults_right += answer == PASS;
    if (answer != FAIL) return;
    struct buffer detail = {0};
    buffer_add(&detail, value_text(fault, "detail"));
    fail(tally, "fault", value_text(fault, "fault"), &detail, value_text(fault, "command"));
}

static void judge_faults(struct tally *tally, const json_t *faults)
{
    char message[VALUE_MESSAGE];
    const json_t *list = faults ? value_need_list(faults, "faults", message) : NULL, *entry;
    size_t i;
    if (faults && !list) unreadable(tally, "faults.json", message);
    json_array_foreach(list, i, entry) judge_fault(tally, entry);
}

/* "271 judged, 30 too coarse to judge, 2 undetermined, 6 known weaknesses": of orders and errors of
 * runs. */
static void gates_words(struct buffer *to, const struct tally *tally)
{
    const int *gates = tally->gates;
    buffer_format(to, "%d judged", gates[PASS] + gates[FAIL]);
    if (gates[FAIL]) buffer_format(to, " (%d failed)", gates[FAIL]);
    if (gates[SMOKE]) buffer_format(to, ", %d too coarse to judge", gates[SMOKE]);
    if (gates[UNDETERMINED]) buffer_format(to, ", %d undetermined", gates[UNDETERMINED]);
    if (gates[KNOWN])
        buffer_format(to, ", %d known weakness%s", gates[KNOWN], gates[KNOWN] == 1 ? "" : "es");
}

/* The number of failures and the first one: its name and, if it is a check, its subject. */
static void headline(struct buffer *to, const struct tally *tally, bool checked,
                     const json_t *failures)
{
    size_t count = json_array_size(failures);
    const json_t *first = json_array_get(failures, 0);
    const char *area = value_text(first, "area"), *subject = value_text(first, "subject");
    /* these names say what they are about */
    bool plain = !strcmp(area, "check") || !strcmp(area, "convergence") || !strcmp(area, "budget");
    if (!count) {
        const bool all =
            !tally->gates[SMOKE] && !tally->gates[UNDETERMINED] && !tally->gates[KNOWN];
        buffer_add(to, !checked ? "Nothing was checked"
                       : all    ? "All is well"
                                : "All that could be judged is well: ");
        if (checked && !all) gates_words(to, tally);
        return;
    }
    buffer_format(to, "%zu %s%s%s%s", count, count == 1 ? "failure: " : "failures; look first at ",
                  plain ? "" : area, plain ? "" : " ", value_text(first, "name"));
    if (strstr(subject, "broke down")) return; /* it says where, not of what */
    enum { LONGEST = 64 };
    size_t length = strlen(subject), whole = length;
    if (length > LONGEST) /* to the end of a word */
        for (length = LONGEST; length && subject[length] != ' ';) length--;
    if (length && subject[length - 1] == ',') length--;
    if (length) buffer_format(to, " (%.*s%s)", (int)length, subject, length < whole ? " …" : "");
}

json_t *verdict_make(const json_t *results)
{
    struct tally tally = {.runs = 0};
    size_t i;
    const json_t *entry;
    json_array_foreach(json_object_get(results, "runs"), i, entry) judge_run(&tally, entry);
    json_array_foreach(json_object_get(results, "studies"), i, entry) judge_study(&tally, entry);
    json_array_foreach(json_object_get(results, "trouble"), i, entry) judge_trouble(&tally, entry);
    judge_verify(&tally, json_object_get(results, "verify"));
    json_array_foreach(json_object_get(json_object_get(results, "stress"), "failures"), i, entry) {
        judge_stress(&tally, entry);
    }
    judge_faults(&tally, json_object_get(results, "faults"));

    const json_t *since = json_object_get(json_object_get(results, "history"), "since");
    json_array_foreach(json_object_get(since, "figures"), i, entry) judge_since(&tally, entry);

    struct buffer words = {0};
    bool checked = tally.figures_passed + tally.gates[PASS] + tally.runs > 0;
    json_t *failures = failure_take(&tally.failures);
    if (!failures) return NULL;
    size_t count = json_array_size(failures);
    headline(&words, &tally, checked, failures);
    char *line = buffer_take(&words);
    gates_words(&words, &tally);
    char *gates = buffer_take(&words);
    json_t *verdict = json_pack(
        "{s:s, s:s, s:i, s:i, s:i, s:i, s:i, s:i, s:i, s:i, s:i, s:i, s:s, s:i, s:i, s:i, s:i, "
        "s:o}",
        "status", count || !checked ? "fail" : "pass", "headline", line ? line : "",
        "figures_passed", tally.figures_passed, "figures_failed", tally.figures_failed,
        "figures_skipped", tally.figures_skipped, "mutants", tally.mutants, "mutants_detected",
        tally.detected, "gates_passed", tally.gates[PASS], "gates_failed", tally.gates[FAIL],
        "gates_smoke", tally.gates[SMOKE], "gates_undetermined", tally.gates[UNDETERMINED],
        "gates_known", tally.gates[KNOWN], "gates", gates ? gates : "", "runs", tally.runs,
        "broke_down", tally.broke_down, "faults", tally.faults, "faults_right", tally.faults_right,
        "failures", failures);
    free(line);
    free(gates);
    return verdict;
}
