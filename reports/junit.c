/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "junit.h"

#include <string.h>

#include "html.h"
#include "value.h"

void junit_case(struct junit_suite *suite, const char *class, const char *name, double seconds,
                const char *status, const char *message)
{
    suite->tests++;
    buffer_add(&suite->cases, "    <testcase classname=\"");
    buffer_escape(&suite->cases, class);
    buffer_add(&suite->cases, "\" name=\"");
    buffer_escape(&suite->cases, name);
    if (seconds >= 0) buffer_format(&suite->cases, "\" time=\"%.6f", seconds);
    bool skipped = !strcmp(status, "skip") || !strcmp(status, "known") ||
                   !strcmp(status, "smoke") || !strcmp(status, "undetermined");
    if (!strcmp(status, "pass") || !strcmp(status, "ok")) {
        buffer_add(&suite->cases, "\"/>\n");
        return;
    }
    suite->skipped += skipped;
    suite->failures += !skipped;
    buffer_format(&suite->cases, "\"><%s message=\"", skipped ? "skipped" : "failure");
    if (skipped && strcmp(status, "skip")) buffer_format(&suite->cases, "%s: ", status);
    buffer_escape(&suite->cases, message);
    buffer_add(&suite->cases, "\"/></testcase>\n");
}

void junit_suite_end(struct buffer *to, const char *name, struct junit_suite *suite)
{
    if (suite->tests) {
        buffer_add(to, "  <testsuite name=\"");
        buffer_escape(to, name);
        buffer_format(to, "\" tests=\"%zu\" failures=\"%zu\" skipped=\"%zu\" errors=\"0\">\n",
                      suite->tests, suite->failures, suite->skipped);
        if (suite->cases.data) buffer_add(to, suite->cases.data);
        buffer_add(to, "  </testsuite>\n");
    }
    if (suite->cases.failed) to->failed = true;
    buffer_free(&suite->cases);
    *suite = (struct junit_suite){0};
}

void junit_begin(struct buffer *to)
{
    buffer_add(to, "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<testsuites name=\"sphproof\">\n");
}

char *junit_take(struct buffer *to)
{
    buffer_add(to, "</testsuites>\n");
    return buffer_take(to);
}

/* What the page does not time. */
static void test_case(struct junit_suite *suite, const char *class, const char *name,
                      const char *status, const char *message)
{
    junit_case(suite, class, name, -1, status, message);
}

/* Of a run alone: its errors and what it conserves, each against a bound. */
static void gates_of(struct junit_suite *suite, const json_t *run)
{
    size_t i;
    const json_t *gate;
    json_array_foreach(json_object_get(run, "gates"), i, gate) {
        struct buffer name = {0}, message = {0};
        if (!strcmp(value_text(gate, "status"), "none")) continue; /* not gated */
        buffer_format(&name, "%s: %s", value_text(run, "label"), value_text(gate, "name"));
        buffer_format(&message, "%.3g, bound %.3g; %s%s", value_member(gate, "value"),
                      value_member(gate, "bound"), value_text(gate, "why"),
                      value_text(gate, "known"));
        if (name.data && message.data)
            test_case(suite, value_text(run, "case"), name.data, value_text(gate, "status"),
                      message.data);
        buffer_free(&name);
        buffer_free(&message);
    }
}

static void runs(struct buffer *to, const json_t *results)
{
    struct junit_suite suite = {0};
    size_t i, j;
    const json_t *entry, *order;
    json_array_foreach(json_object_get(results, "runs"), i, entry) {
        test_case(&suite, value_text(entry, "case"), value_text(entry, "reproduce"),
                  value_text(entry, "status"), value_text(entry, "message"));
        gates_of(&suite, entry);
    }
    junit_suite_end(to, "runs", &suite);
    json_array_foreach(json_object_get(results, "studies"), i, entry) {
        json_array_foreach(json_object_get(entry, "orders"), j, order) {
            if (!json_is_object(json_object_get(order, "gate"))) continue;
            struct buffer name = {0}, message = {0};
            buffer_format(&name, "%s: %s of %s", value_text(entry, "label"),
                          value_text(order, "norm"), value_text(order, "field"));
            buffer_format(&message, "order %.3f, 95 %% interval %.3f to %.3f; %s",
                          value_member(order, "order"), value_member(order, "low"),
                          value_member(order, "high"), value_text(order, "why"));
            if (name.data && message.data)
                test_case(&suite, value_text(entry, "case"), name.data, value_text(order, "status"),
                          message.data);
            buffer_free(&name);
            buffer_free(&message);
        }
    }
    junit_suite_end(to, "convergence", &suite);
}

static void checks(struct buffer *to, const json_t *verify)
{
    struct junit_suite suite = {0};
    size_t i;
    const json_t *entry;
    const char *group = "";
    json_array_foreach(json_object_get(verify, "checks"), i, entry) {
        if (strcmp(group, value_text(entry, "group"))) junit_suite_end(to, group, &suite);
        group = value_text(entry, "group");
        struct buffer message = {0};
        buffer_add(&message, "value ");
        html_number(&message, value_member(entry, "value"));
        buffer_add(&message, ", bound ");
        html_number(&message, value_member(entry, "bound"));
        if (message.data)
            test_case(&suite, value_text(entry, "name"), value_text(entry, "subject"),
                      value_text(entry, "status"), message.data);
        buffer_free(&message);
    }
    junit_suite_end(to, group, &suite);
    json_array_foreach(json_object_get(verify, "mutants"), i, entry)
        test_case(&suite, value_text(entry, "check"), value_text(entry, "mutant"),
                  json_is_true(json_object_get(entry, "detected")) ? "pass" : "fail",
                  "this deliberate fault was not caught");
    junit_suite_end(to, "deliberate faults", &suite);
}

/* What the verdict has found beside what is a test case above or below. */
static void others(struct buffer *to, const json_t *verdict)
{
    static const char *const areas[] = {"suspicion", "harness", "budget", "study", "stress"};
    struct junit_suite suite = {0};
    size_t i;
    const json_t *failure;
    json_array_foreach(json_object_get(verdict, "failures"), i, failure) {
        const char *area = value_text(failure, "area");
        for (size_t k = 0; k < sizeof areas / sizeof *areas; k++)
            if (!strcmp(area, areas[k]))
                test_case(&suite, area, value_text(failure, "name"), "fail",
                          value_text(failure, "detail"));
    }
    junit_suite_end(to, "report", &suite);
}

static void faults(struct buffer *to, const json_t *faults)
{
    struct junit_suite suite = {0};
    size_t i;
    const json_t *entry;
    json_array_foreach(json_object_get(faults, "faults"), i, entry) {
        const char *status = value_text(entry, "status");
        test_case(&suite, value_text(entry, "part"), value_text(entry, "fault"), status,
                  value_text(entry, strcmp(status, "fail") ? "message" : "detail"));
    }
    junit_suite_end(to, "faults around it", &suite);
}

char *junit_judge_text(const json_t *document)
{
    struct buffer to = {0};
    struct junit_suite suite = {0};
    size_t i;
    const json_t *finding;
    junit_begin(&to);
    json_array_foreach(json_object_get(document, "findings"), i, finding)
        test_case(&suite, value_text(document, "case"), value_text(finding, "name"),
                  value_text(finding, "status"), value_text(finding, "message"));
    junit_suite_end(&to, "judge", &suite);
    return junit_take(&to);
}

char *junit_text(const json_t *results)
{
    struct buffer to = {0};
    junit_begin(&to);
    runs(&to, results);
    checks(&to, json_object_get(results, "verify"));
    others(&to, json_object_get(results, "verdict"));
    faults(&to, json_object_get(results, "faults"));
    return junit_take(&to);
}
