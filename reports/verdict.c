/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verdict.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "buffer.h"
#include "failure.h"
#include "html.h"

struct tally {
    struct failure_list failures;
    int figures_passed, figures_failed, figures_skipped;
    int mutants, detected;
    int gates_passed, gates_failed;
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

static void judge_figure(struct tally *tally, const json_t *figure, const char *verify)
{
    const char *status = html_string(figure, "status");
    if (!strcmp(status, "pass")) tally->figures_passed++;
    if (!strcmp(status, "skip")) tally->figures_skipped++;
    if (strcmp(status, "fail")) return;
    tally->figures_failed++;
    struct buffer detail = {0}, command = {0};
    double value = html_member(figure, "value"), bound = html_member(figure, "bound");
    buffer_format(&detail, "%s: ", html_string(figure, "subject"));
    html_number(&detail, value);
    buffer_add(&detail, " is not <= ");
    html_number(&detail, bound);
    if (bound > 0 && isfinite(value)) {
        buffer_add(&detail, " (");
        html_number(&detail, value / bound);
        buffer_add(&detail, " times the bound)");
    }
    buffer_format(&command, "%s %s", verify, html_string(figure, "group"));
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
        judge_figure(tally, entry, html_verify(verify));
    json_array_foreach(json_object_get(verify, "mutants"), i, entry)
    {
        if (json_is_true(json_object_get(entry, "detected"))) continue;
        struct buffer detail = {0}, command = {0};
        buffer_format(&command, "%s --mutants", html_verify(verify));
        buffer_format(&detail, "the wrong variant '%s' passes: value ",
                      html_string(entry, "mutant"));
        html_number(&detail, html_member(entry, "value"));
        buffer_add(&detail, ", bound ");
        html_number(&detail, html_member(entry, "bound"));
        if (command.data)
            fail(tally, "detection", html_string(entry, "check"), &detail, command.data);
        buffer_free(&command);
    }
}

static void judge_run(struct tally *tally, const json_t *run)
{
    tally->runs++;
    if (strcmp(html_string(run, "status"), "broke_down")) return;
    tally->broke_down++;
    struct buffer detail = {0};
    buffer_format(&detail, "broke down: %s", html_string(run, "message"));
    fail(tally, "run", html_string(run, "case"), &detail, html_string(run, "reproduce"));
}

static void judge_still_gas(struct tally *tally, const json_t *study, const json_t *still)
{
    const char *status = html_string(still, "status");
    if (!strcmp(status, "pass")) tally->gates_passed++;
    if (strcmp(status, "fail")) return;
    tally->gates_failed++;
    struct buffer detail = {0}, name = {0};
    buffer_format(&name, "%s, %s: still gas", html_string(study, "case"),
                  html_string(study, "label"));
    buffer_add(&detail, "gas that no wave has reached moves at ");
    html_number(&detail, html_member(still, "value"));
    buffer_add(&detail, " of its sound speed, allowed is ");
    html_number(&detail, html_member(still, "bound"));
    if (!name.failed) fail(tally, "budget", name.data, &detail, html_string(study, "reproduce"));
    buffer_free(&name);
}

/* What gave no result at all. */
static void judge_trouble(struct tally *tally, const json_t *trouble)
{
    struct buffer detail = {0};
    buffer_add(&detail, html_string(trouble, "message"));
    fail(tally, "harness", html_string(trouble, "name"), &detail, "sphproof report --force");
}

static void judge_study(struct tally *tally, const json_t *study)
{
    size_t i;
    const json_t *order;
    json_array_foreach(json_object_get(study, "orders"), i, order)
    {
        const char *status = html_string(order, "status");
        if (!strcmp(status, "pass")) tally->gates_passed++;
        if (strcmp(status, "fail")) continue;
        tally->gates_failed++;
        struct buffer detail = {0}, name = {0};
        buffer_format(&name, "%s, %s: order of %s(%s)", html_string(study, "case"),
                      html_string(study, "label"), html_string(order, "norm"),
                      html_string(order, "field"));
        html_number(&detail, html_member(order, "order"));
        buffer_add(&detail, " (95 % interval ");
        html_number(&detail, html_member(order, "low"));
        buffer_add(&detail, " to ");
        html_number(&detail, html_member(order, "high"));
        buffer_format(&detail, ") %s", html_string(order, "why"));
        if (!name.failed)
            fail(tally, "convergence", name.data, &detail, html_string(study, "reproduce"));
        buffer_free(&name);
    }
    json_array_foreach(json_object_get(study, "floors"), i, order)
    {
        if (!*html_string(order, "suspicion")) continue;
        struct buffer detail = {0};
        buffer_format(&detail, "too good to be true: %s", html_string(order, "suspicion"));
        fail(tally, "suspicion", html_string(study, "case"), &detail,
             html_string(study, "reproduce"));
    }
    json_array_foreach(json_object_get(study, "budgets"), i, order)
    {
        judge_still_gas(tally, study, json_object_get(order, "still_gas"));
    }
    if (*html_string(study, "suspicion")) {
        struct buffer detail = {0};
        buffer_format(&detail, "too good to be true: %s", html_string(study, "suspicion"));
        fail(tally, "suspicion", html_string(study, "case"), &detail,
             html_string(study, "reproduce"));
    }
    if (!strcmp(html_string(study, "status"), "broke_down")) {
        struct buffer detail = {0};
        tally->gates_failed++;
        buffer_format(&detail, "broke down: %s", html_string(study, "message"));
        fail(tally, "study", html_string(study, "case"), &detail, html_string(study, "reproduce"));
    }
}

static void judge_stress(struct tally *tally, const json_t *failure)
{
    struct buffer detail = {0};
    buffer_add(&detail, html_string(failure, "detail"));
    fail(tally, "stress", html_string(failure, "name"), &detail, html_string(failure, "command"));
}

/* What the world did to the program; a fault that could not be brought about does not count. */
static void judge_fault(struct tally *tally, const json_t *fault)
{
    const char *status = html_string(fault, "status");
    tally->faults += strcmp(status, "skip") != 0;
    tally->faults_right += !strcmp(status, "pass");
    if (strcmp(status, "fail")) return;
    struct buffer detail = {0};
    buffer_add(&detail, html_string(fault, "detail"));
    fail(tally, "fault", html_string(fault, "fault"), &detail, html_string(fault, "command"));
}

/* The failures' number and the first one: what it is and, of a check, of whom. */
static void headline(struct buffer *to, bool checked, const json_t *failures)
{
    size_t count = json_array_size(failures);
    const json_t *first = json_array_get(failures, 0);
    const char *area = html_string(first, "area"), *subject = html_string(first, "subject");
    /* these names say what they are about */
    bool plain = !strcmp(area, "check") || !strcmp(area, "convergence") || !strcmp(area, "budget");
    if (!count) {
        buffer_add(to, checked ? "All is well" : "Nothing was checked");
        return;
    }
    buffer_format(to, "%zu %s%s%s%s", count, count == 1 ? "failure: " : "failures; look first at ",
                  plain ? "" : area, plain ? "" : " ", html_string(first, "name"));
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
    json_array_foreach(json_object_get(json_object_get(results, "stress"), "failures"), i, entry)
    {
        judge_stress(&tally, entry);
    }
    json_array_foreach(json_object_get(json_object_get(results, "faults"), "faults"), i, entry)
    {
        judge_fault(&tally, entry);
    }

    struct buffer words = {0};
    bool checked = tally.figures_passed + tally.gates_passed + tally.runs > 0;
    json_t *failures = failure_take(&tally.failures);
    if (!failures) return NULL;
    size_t count = json_array_size(failures);
    headline(&words, checked, failures);
    char *line = buffer_take(&words);
    json_t *verdict = json_pack(
        "{s:s, s:s, s:i, s:i, s:i, s:i, s:i, s:i, s:i, s:i, s:i, s:i, s:i, s:o}", "status",
        count || !checked ? "fail" : "pass", "headline", line ? line : "", "figures_passed",
        tally.figures_passed, "figures_failed", tally.figures_failed, "figures_skipped",
        tally.figures_skipped, "mutants", tally.mutants, "mutants_detected", tally.detected,
        "gates_passed", tally.gates_passed, "gates_failed", tally.gates_failed, "runs", tally.runs,
        "broke_down", tally.broke_down, "faults", tally.faults, "faults_right", tally.faults_right,
        "failures", failures);
    free(line);
    return verdict;
}
