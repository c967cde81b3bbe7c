/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "findings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "buffer.h"
#include "html.h"
#include "list.h"
#include "value.h"

static const char *const area_names[AREA_END - AREA_DETECTION] = {
    "detection", "suspicion", "harness", "convergence", "gate",
    "budget",    "study",     "run",     "stress",      "fault"};

/* ---- the list ---- */

static const char *copy(struct findings *of, const char *text)
{
    char *made = strdup(text ? text : "");
    if (!made) of->failed = true;
    return made;
}

void findings_add(struct findings *to, struct finding finding)
{
    if (!list_grow(&to->list, to->count, sizeof *to->list)) {
        to->failed = true;
        return;
    }
    if (finding.rank >= AREA_DETECTION) finding.group = area_names[finding.rank - AREA_DETECTION];
    finding.group = copy(to, finding.group);
    finding.what = copy(to, finding.what);
    finding.subject = copy(to, finding.subject);
    finding.reason = copy(to, finding.reason);
    finding.command = copy(to, finding.command);
    finding.plot = copy(to, finding.plot);
    to->list[to->count++] = finding;
}

void findings_free(struct findings *findings)
{
    while (findings->count) {
        const struct finding *f = &findings->list[--findings->count];
        free((char *)f->group), free((char *)f->what), free((char *)f->subject);
        free((char *)f->reason), free((char *)f->command), free((char *)f->plot);
    }
    free(findings->list);
    *findings = (struct findings){0};
}

/* Adds a finding; frees the buffers of its subject and reason, which may be NULL. */
static void add(struct findings *to, struct finding finding, struct buffer *subject,
                struct buffer *reason)
{
    if (subject) finding.subject = subject->data;
    if (reason) finding.reason = reason->data;
    if ((subject && subject->failed) || (reason && reason->failed)) to->failed = true;
    findings_add(to, finding);
    if (subject) buffer_free(subject);
    if (reason) buffer_free(reason);
}

/* ---- the findings of a report ---- */

/* A finding with "value", "bound", "floor" and "seconds" of an entry, which may be NULL. */
static struct finding figure(int rank, enum finding_status status, const char *what,
                             const char *command, const json_t *entry)
{
    return (struct finding){.rank = rank,
                            .status = status,
                            .what = what,
                            .command = command,
                            .value = value_member(entry, "value"),
                            .bound = value_member(entry, "bound"),
                            .floor = value_member(entry, "floor"),
                            .seconds = value_member(entry, "seconds")};
}

/* Adds a failure for results that cannot be read, so that they never count as good. */
static void unreadable(struct findings *to, const char *what, const char *message)
{
    struct buffer reason = {0};
    buffer_format(&reason, "results that cannot be read: %s", message);
    add(to, figure(AREA_HARNESS, FINDING_FAIL, what, "sphproof report --force", NULL), NULL,
        &reason);
}

/* The status of an entry, which with `skips` may be "skip", else "none". An unknown status adds a
 * failure, and the entry counts as skipped. */
static enum finding_status status_of(struct findings *to, const json_t *entry, bool skips,
                                     const char *what)
{
    const char *words[FINDING_SKIP + 2];
    char message[VALUE_MESSAGE];
    memcpy(words, finding_words, sizeof words);
    if (!skips) words[FINDING_SKIP] = NULL;
    const int word = value_need_word(entry, "status", words + skips, message);
    if (word >= 0) return (enum finding_status)(word + skips);
    unreadable(to, what, message);
    return FINDING_SKIP;
}

/* Writes "3 is not <= 0.5", for the value or for the floor. */
static void say_figure(struct buffer *to, const struct finding *finding)
{
    double beyond;
    const double excess = finding_excess(finding, &beyond);
    const bool floor = finding->value <= finding->bound && finding->floor > finding->bound;
    if (finding->status != FINDING_FAIL) {
        html_format(to, "%f, bound %f", finding->value, finding->bound);
        return;
    }
    html_format(to, "%s%f is not <= %f", floor ? "the floor " : "", beyond, finding->bound);
    if (excess > 1 && !isinf(excess)) html_format(to, " (%f times the bound)", excess);
}

static void add_check(struct findings *to, const json_t *entry, const char *verify)
{
    struct buffer reason = {0}, command = {0};
    const double rank = value_member(entry, "rank");
    const char *name = value_text(entry, "name"), *subject = value_text(entry, "subject");
    buffer_format(&command, "%s %s", verify, value_text(entry, "group"));
    struct finding finding =
        figure(rank >= 0 && rank < AREA_DETECTION ? (int)rank : AREA_DETECTION - 1,
               status_of(to, entry, true, name), name, command.data, entry);
    finding.group = value_text(entry, "group");
    finding.subject = subject;
    if (finding.status == FINDING_SKIP)
        buffer_add(&reason, subject);
    else
        say_figure(&reason, &finding);
    add(to, finding, NULL, &reason);
    buffer_free(&command);
}

static void add_mutant(struct findings *to, const json_t *entry, const char *verify)
{
    struct buffer reason = {0}, command = {0};
    const bool detected = json_is_true(json_object_get(entry, "detected"));
    buffer_format(&command, "%s --mutants", verify);
    struct finding finding = figure(AREA_DETECTION, detected ? FINDING_PASS : FINDING_FAIL,
                                    value_text(entry, "check"), command.data, entry);
    finding.subject = value_text(entry, "mutant");
    buffer_format(&reason, "the wrong variant '%s' passes: ", finding.subject);
    html_format(&reason, "value %f, bound %f", finding.value, finding.bound);
    if (*value_text(entry, "fault")) buffer_format(&reason, "; %s", value_text(entry, "fault"));
    add(to, finding, NULL, &reason);
    buffer_free(&command);
}

void findings_of_verify(struct findings *to, const json_t *verify)
{
    const char *command = value_text_or(verify, "reproduce", "sphproof verify");
    const json_t *entry;
    size_t i;
    json_array_foreach(json_object_get(verify, "checks"), i, entry) add_check(to, entry, command);
    json_array_foreach(json_object_get(verify, "mutants"), i, entry) add_mutant(to, entry, command);
}

/* A finding about the case and the scheme of a run or a study. */
static struct finding finding_of(int rank, enum finding_status status, const json_t *document,
                                 const json_t *entry)
{
    struct finding finding = figure(rank, status, value_text(document, "case"),
                                    value_text(document, "reproduce"), entry);
    finding.subject = value_text(document, "label");
    return finding;
}

/* Adds a gate of a single run: a bound on an error or on conservation. */
static void add_gate(struct findings *to, const json_t *run, const json_t *gate)
{
    struct buffer subject = {0}, reason = {0};
    const struct finding finding =
        finding_of(AREA_GATE, status_of(to, gate, false, value_text(run, "case")), run, gate);
    buffer_format(&subject, "%s: %s", finding.subject, value_text(gate, "name"));
    const bool fails = finding.status == FINDING_FAIL;
    const char *why = value_text(gate, "why"), *known = value_text(gate, "known");
    html_format(&reason, fails ? "the error of the run, %f, is not <= %f" : "%f, bound %f",
                finding.value, finding.bound);
    if (*why || *known) buffer_format(&reason, "; %s%s", why, known);
    add(to, finding, &subject, &reason);
}

/* Adds what became of a run or a study: its status in words, and its message. */
static void add_outcome(struct findings *to, int rank, enum finding_status status,
                        const json_t *document)
{
    struct buffer reason = {0};
    const char *word = value_text(document, "status");
    buffer_format(&reason, "%s: %s", strcmp(word, "broke_down") ? word : "broke down",
                  value_text(document, "message"));
    add(to, finding_of(rank, status, document, NULL), NULL, &reason);
}

static void add_run(struct findings *to, const json_t *run)
{
    static const char *const words[] = {"ok", "broke_down", "failed", NULL};
    char message[VALUE_MESSAGE];
    const int word = value_need_word(run, "status", words, message);
    const json_t *gate;
    size_t i;
    if (word < 0) unreadable(to, value_text(run, "case"), message);
    add_outcome(to, AREA_RUN,
                word < 0    ? FINDING_SKIP
                : word == 0 ? FINDING_PASS
                            : FINDING_FAIL,
                run);
    json_array_foreach(json_object_get(run, "gates"), i, gate) add_gate(to, run, gate);
}

static void add_order(struct findings *to, const json_t *study, const json_t *order)
{
    struct buffer subject = {0}, reason = {0};
    struct finding finding = finding_of(
        AREA_CONVERGENCE, status_of(to, order, false, value_text(study, "case")), study, NULL);
    finding.value = value_member(order, "order");
    buffer_format(&subject, "%s: order of %s(%s)", finding.subject, value_text(order, "norm"),
                  value_text(order, "field"));
    html_format(&reason, "%f (95 %% interval %f to %f) ", finding.value, value_member(order, "low"),
                value_member(order, "high"));
    buffer_add(&reason, value_text(order, "why"));
    add(to, finding, &subject, &reason);
}

static void add_still_gas(struct findings *to, const json_t *study, const json_t *still)
{
    struct buffer subject = {0}, reason = {0};
    const struct finding finding =
        finding_of(AREA_BUDGET, status_of(to, still, false, "still gas"), study, still);
    buffer_format(&subject, "%s: still gas", finding.subject);
    html_format(&reason,
                "gas that no wave has reached moves at %f of its sound speed, allowed is %f",
                finding.value, finding.bound);
    add(to, finding, &subject, &reason);
}

static void add_suspicion(struct findings *to, const json_t *study, const char *suspicion)
{
    struct buffer reason = {0};
    if (!*suspicion) return;
    buffer_format(&reason, "too good to be true: %s", suspicion);
    add(to, finding_of(AREA_SUSPICION, FINDING_FAIL, study, NULL), NULL, &reason);
}

static void add_study(struct findings *to, const json_t *study)
{
    const char *status = value_text(study, "status");
    const json_t *entry;
    size_t i;
    json_array_foreach(json_object_get(study, "orders"), i, entry) add_order(to, study, entry);
    json_array_foreach(json_object_get(study, "floors"), i, entry)
        add_suspicion(to, study, value_text(entry, "suspicion"));
    json_array_foreach(json_object_get(study, "budgets"), i, entry)
        add_still_gas(to, study, json_object_get(entry, "still_gas"));
    add_suspicion(to, study, value_text(study, "suspicion"));
    if (!strcmp(status, "broke_down") || !strcmp(status, "failed"))
        add_outcome(to, AREA_STUDY, FINDING_FAIL, study);
}

static void add_stress(struct findings *to, const json_t *failure)
{
    struct finding finding = figure(AREA_STRESS, FINDING_FAIL, value_text(failure, "name"),
                                    value_text(failure, "command"), NULL);
    finding.reason = value_text(failure, "detail");
    findings_add(to, finding);
}

/* Adds a failure if something broke down that did not in the previous report, since no bound limits
 * the number of breakdowns. */
static void add_since(struct findings *to, const json_t *change)
{
    struct buffer reason = {0};
    if (strcmp(value_text(change, "new"), "broke_down") ||
        strcmp(value_text(change, "verdict"), "worse"))
        return;
    buffer_format(&reason, "it was '%s' in the report before, and breaks down now",
                  value_text(change, "old"));
    add(to, figure(AREA_STRESS, FINDING_FAIL, value_text(change, "path"), "sphproof stress", NULL),
        NULL, &reason);
}

/* Adds the reaction of the program to a fault of its environment; a fault that could not be
 * produced is skipped. */
static void add_fault(struct findings *to, const json_t *fault)
{
    struct finding finding = figure(AREA_FAULT, status_of(to, fault, true, "faults.json"),
                                    value_text(fault, "part"), value_text(fault, "command"), NULL);
    finding.subject = value_text(fault, "fault");
    finding.reason = value_text(fault, finding.status == FINDING_FAIL ? "detail" : "message");
    findings_add(to, finding);
}

static void add_faults(struct findings *to, const json_t *faults)
{
    char message[VALUE_MESSAGE];
    const json_t *list = faults ? value_need_list(faults, "faults", message) : NULL, *entry;
    size_t i;
    if (faults && !list) unreadable(to, "faults.json", message);
    json_array_foreach(list, i, entry) add_fault(to, entry);
}

/* Adds a step of the report that gave no result. */
static void add_trouble(struct findings *to, const json_t *trouble)
{
    struct finding finding = figure(AREA_HARNESS, FINDING_FAIL, value_text(trouble, "name"),
                                    "sphproof report --force", NULL);
    finding.reason = value_text(trouble, "message");
    findings_add(to, finding);
}

static void for_each(struct findings *to, const json_t *list,
                     void (*each)(struct findings *, const json_t *))
{
    const json_t *entry;
    size_t i;
    json_array_foreach(list, i, entry) each(to, entry);
}

void findings_of_report(struct findings *to, const json_t *results)
{
    for_each(to, json_object_get(results, "runs"), add_run);
    for_each(to, json_object_get(results, "studies"), add_study);
    for_each(to, json_object_get(results, "trouble"), add_trouble);
    findings_of_verify(to, json_object_get(results, "verify"));
    for_each(to, html_member(results, "stress/failures"), add_stress);
    for_each(to, html_member(results, "history/since/figures"), add_since);
    add_faults(to, json_object_get(results, "faults"));
    for (size_t i = 0; i < to->count; i++) {
        const struct finding *f = &to->list[i];
        if (f->status == FINDING_FAIL ||
            (f->status == FINDING_PASS && f->rank != AREA_DETECTION && f->rank != AREA_FAULT))
            return;
    }
    struct finding nothing =
        figure(AREA_HARNESS, FINDING_FAIL, FINDINGS_NOTHING, "sphproof report --force", NULL);
    nothing.reason = "no figure, no gate and no run was judged";
    findings_add(to, nothing);
}

void findings_of_judge(struct findings *to, const json_t *document)
{
    const json_t *entry;
    size_t i;
    json_array_foreach(json_object_get(document, "findings"), i, entry) {
        const char *name = value_text(entry, "name");
        struct finding finding = figure(AREA_GATE, status_of(to, entry, false, name),
                                        value_text(document, "case"), NULL, NULL);
        finding.subject = name;
        finding.reason = value_text(entry, "message");
        findings_add(to, finding);
    }
}

/* ---- failures ---- */

/* The figure of a check that exceeds its bound most; other findings are listed one by one. */
struct failure {
    const struct finding *finding;
    double excess;
    size_t number, more; /* position in the list; other failed figures of the same check */
};

static int most_specific_first(const void *a, const void *b)
{
    const struct failure *x = a, *y = b;
    if (x->finding->rank != y->finding->rank) return x->finding->rank < y->finding->rank ? -1 : 1;
    if (x->excess != y->excess) return (x->excess < y->excess) - (x->excess > y->excess);
    return (int)x->number - (int)y->number;
}

/* True if a is a figure of the check of which b is one. */
static bool same_check(const struct finding *a, const struct finding *b)
{
    return a->rank < AREA_DETECTION && !strcmp(a->group, b->group) && !strcmp(a->what, b->what);
}

static size_t collect(const struct findings *findings, struct failure *failures)
{
    size_t count = 0;
    for (size_t i = 0; i < findings->count; i++) {
        const struct finding *finding = &findings->list[i];
        const bool check = finding->rank < AREA_DETECTION;
        struct failure failure = {.finding = finding, .number = i};
        size_t k = 0;
        double beyond;
        if (finding->status != FINDING_FAIL) continue;
        if (check) failure.excess = finding_excess(finding, &beyond);
        while (k < count && !(check && same_check(failures[k].finding, finding))) k++;
        if (k == count) {
            failures[count++] = failure;
            continue;
        }
        failures[k].more++;
        if (failure.excess > failures[k].excess)
            failures[k].finding = finding, failures[k].excess = failure.excess;
    }
    return count;
}

static json_t *failure_json(const struct failure *failure)
{
    const struct finding *f = failure->finding;
    const bool check = f->rank < AREA_DETECTION, both = *f->what && *f->subject;
    struct buffer name = {0}, detail = {0};
    if (check) {
        buffer_format(&name, "%s: %s", f->group, f->what);
        buffer_format(&detail, "%s: ", f->subject);
    } else {
        buffer_format(&name, "%s%s%s", f->what, both ? ", " : "", f->subject);
    }
    buffer_add(&detail, f->reason);
    if (failure->more)
        buffer_format(&detail, "; and %zu more %s of this check", failure->more,
                      failure->more == 1 ? "figure" : "figures");
    json_t *entry =
        name.failed || detail.failed
            ? NULL
            : json_pack("{s:s, s:s, s:s*, s:s, s:s}", "area", check ? "check" : f->group, "name",
                        name.data, "subject", check ? f->subject : NULL, "detail", detail.data,
                        "command", f->command);
    buffer_free(&name);
    buffer_free(&detail);
    return entry;
}

json_t *findings_failures(const struct findings *findings)
{
    struct failure *failures = calloc(findings->count + 1, sizeof *failures);
    json_t *list = json_array();
    bool sound = failures && !findings->failed;
    const size_t count = sound ? collect(findings, failures) : 0;
    if (count) qsort(failures, count, sizeof *failures, most_specific_first);
    for (size_t k = 0; k < count && sound; k++)
        sound = !json_array_append_new(list, failure_json(&failures[k]));
    free(failures);
    if (sound) return list;
    json_decref(list);
    return NULL;
}

/* ---- JUnit ---- */

static void test_case(struct buffer *to, const struct finding *f)
{
    const bool check = f->rank < AREA_DETECTION;
    html_format(to, "    <testcase classname=\"%s%s%s\" name=\"%s", check ? f->group : "",
                check ? "." : "", *f->subject || check ? f->what : f->group,
                *f->subject || check ? f->subject : f->what);
    if (f->seconds >= 0) buffer_format(to, "\" time=\"%.6f", f->seconds);
    if (f->status == FINDING_PASS) {
        buffer_add(to, "\"/>\n");
        return;
    }
    const bool fails = f->status == FINDING_FAIL;
    buffer_format(to, "\"><%s message=\"", fails ? "failure" : "skipped");
    if (!fails && f->status != FINDING_SKIP) buffer_format(to, "%s: ", finding_words[f->status]);
    html_format(to, "%s\"/></testcase>\n", f->reason);
}

static void test_suite(struct buffer *to, const struct findings *findings, const char *group)
{
    struct buffer cases = {0};
    size_t tests = 0, failures = 0, passes = 0;
    for (size_t i = 0; i < findings->count; i++) {
        const struct finding *finding = &findings->list[i];
        if (finding->status == FINDING_NONE || strcmp(finding->group, group)) continue;
        test_case(&cases, finding);
        tests++;
        failures += finding->status == FINDING_FAIL;
        passes += finding->status == FINDING_PASS;
    }
    if (tests) {
        html_format(to,
                    "  <testsuite name=\"%s\" tests=\"%zu\" failures=\"%zu\" skipped=\"%zu\" "
                    "errors=\"0\">\n",
                    group, tests, failures, tests - failures - passes);
        if (cases.data) buffer_add(to, cases.data);
        buffer_add(to, "  </testsuite>\n");
    }
    if (cases.failed) to->failed = true;
    buffer_free(&cases);
}

char *findings_junit(void (*of)(struct findings *, const json_t *), const json_t *document)
{
    struct findings found = {0};
    struct buffer to = {0};
    of(&found, document);
    buffer_add(&to, "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
                    "<testsuites name=\"sphproof\">\n");
    for (size_t i = 0; i < found.count && !found.failed; i++) {
        size_t k = 0;
        while (strcmp(found.list[k].group, found.list[i].group)) k++;
        if (k == i) test_suite(&to, &found, found.list[i].group);
    }
    buffer_add(&to, "</testsuites>\n");
    to.failed |= found.failed;
    findings_free(&found);
    return buffer_take(&to);
}
