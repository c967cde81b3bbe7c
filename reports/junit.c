/* SPDX-License-Identifier: GPL-3.0-or-later
 * The results as JUnit XML: a suite for the runs, one for the orders of convergence, one for each
 * group of checks, one for the deliberate faults and one for those of the world around. */
#include <string.h>

#include "html.h"
#include "page.h"

struct suite_writer {
    struct buffer cases;
    size_t tests, failures, skipped;
};

static void test_case(struct suite_writer *suite, const char *class, const char *name,
                      const char *status, const char *message)
{
    suite->tests++;
    buffer_add(&suite->cases, "    <testcase classname=\"");
    buffer_escape(&suite->cases, class);
    buffer_add(&suite->cases, "\" name=\"");
    buffer_escape(&suite->cases, name);
    bool skipped = !strcmp(status, "skip");
    if (!strcmp(status, "pass") || !strcmp(status, "ok")) {
        buffer_add(&suite->cases, "\"/>\n");
        return;
    }
    suite->skipped += skipped;
    suite->failures += !skipped;
    buffer_format(&suite->cases, "\"><%s message=\"", skipped ? "skipped" : "failure");
    buffer_escape(&suite->cases, message);
    buffer_add(&suite->cases, "\"/></testcase>\n");
}

static void suite_end(struct buffer *to, const char *name, struct suite_writer *suite)
{
    if (suite->tests) {
        buffer_add(to, "  <testsuite name=\"");
        buffer_escape(to, name);
        buffer_format(to, "\" tests=\"%zu\" failures=\"%zu\" skipped=\"%zu\">\n", suite->tests,
                      suite->failures, suite->skipped);
        if (suite->cases.data) buffer_add(to, suite->cases.data);
        buffer_add(to, "  </testsuite>\n");
    }
    if (suite->cases.failed) to->failed = true;
    buffer_free(&suite->cases);
    *suite = (struct suite_writer){0};
}

static void runs(struct buffer *to, const json_t *results)
{
    struct suite_writer suite = {0};
    size_t i, j;
    const json_t *entry, *order;
    json_array_foreach(json_object_get(results, "runs"), i, entry)
        test_case(&suite, html_string(entry, "case"), html_string(entry, "reproduce"),
                  html_string(entry, "status"), html_string(entry, "message"));
    suite_end(to, "runs", &suite);
    json_array_foreach(json_object_get(results, "studies"), i, entry)
    {
        json_array_foreach(json_object_get(entry, "orders"), j, order)
        {
            if (!json_is_object(json_object_get(order, "gate"))) continue;
            struct buffer name = {0}, message = {0};
            buffer_format(&name, "%s: %s of %s", html_string(entry, "label"),
                          html_string(order, "norm"), html_string(order, "field"));
            buffer_format(&message, "order %.3f, 95 %% interval %.3f to %.3f; %s",
                          html_member(order, "order"), html_member(order, "low"),
                          html_member(order, "high"), html_string(order, "why"));
            if (name.data && message.data)
                test_case(&suite, html_string(entry, "case"), name.data,
                          html_string(order, "status"), message.data);
            buffer_free(&name);
            buffer_free(&message);
        }
    }
    suite_end(to, "convergence", &suite);
}

static void checks(struct buffer *to, const json_t *verify)
{
    struct suite_writer suite = {0};
    size_t i;
    const json_t *entry;
    const char *group = "";
    json_array_foreach(json_object_get(verify, "checks"), i, entry)
    {
        if (strcmp(group, html_string(entry, "group"))) suite_end(to, group, &suite);
        group = html_string(entry, "group");
        struct buffer message = {0};
        buffer_add(&message, "value ");
        html_number(&message, html_member(entry, "value"));
        buffer_add(&message, ", bound ");
        html_number(&message, html_member(entry, "bound"));
        if (message.data)
            test_case(&suite, html_string(entry, "name"), html_string(entry, "subject"),
                      html_string(entry, "status"), message.data);
        buffer_free(&message);
    }
    suite_end(to, group, &suite);
    json_array_foreach(json_object_get(verify, "mutants"), i, entry)
        test_case(&suite, html_string(entry, "check"), html_string(entry, "mutant"),
                  json_is_true(json_object_get(entry, "detected")) ? "pass" : "fail",
                  "this deliberate fault was not caught");
    suite_end(to, "deliberate faults", &suite);
}

/* What the verdict has found beside what is a test case above or below. */
static void others(struct buffer *to, const json_t *verdict)
{
    static const char *const areas[] = {"suspicion", "harness", "budget", "study", "stress"};
    struct suite_writer suite = {0};
    size_t i;
    const json_t *failure;
    json_array_foreach(json_object_get(verdict, "failures"), i, failure)
    {
        const char *area = html_string(failure, "area");
        for (size_t k = 0; k < sizeof areas / sizeof *areas; k++)
            if (!strcmp(area, areas[k]))
                test_case(&suite, area, html_string(failure, "name"), "fail",
                          html_string(failure, "detail"));
    }
    suite_end(to, "report", &suite);
}

static void faults(struct buffer *to, const json_t *faults)
{
    struct suite_writer suite = {0};
    size_t i;
    const json_t *entry;
    json_array_foreach(json_object_get(faults, "faults"), i, entry)
    {
        const char *status = html_string(entry, "status");
        test_case(&suite, html_string(entry, "part"), html_string(entry, "fault"), status,
                  html_string(entry, strcmp(status, "fail") ? "message" : "detail"));
    }
    suite_end(to, "faults around it", &suite);
}

char *page_junit(const json_t *results)
{
    struct buffer to = {0};
    buffer_add(&to, "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<testsuites name=\"sphproof\">\n");
    runs(&to, results);
    checks(&to, json_object_get(results, "verify"));
    others(&to, json_object_get(results, "verdict"));
    faults(&to, json_object_get(results, "faults"));
    buffer_add(&to, "</testsuites>\n");
    return buffer_take(&to);
}
