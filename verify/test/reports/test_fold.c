/* SPDX-License-Identifier: GPL-3.0-or-later
 * The closed page: what is folded opens to what it was, each case has a picture with its error, its
 * order and its state, and maps that stand side by side have one colour scale. */
#include "test.h"

#include "base64.h"
#include "fold.h"
#include "markup.h"
#include "page.h"
#include "case_state.h"
#include "verdict.h"

static json_t *loaded(const char *text)
{
    char *copy = strdup(text);
    for (char *c = copy; *c; c++)
        if (*c == '\'') *c = '"';
    json_error_t error;
    json_t *document = json_loads(copy, 0, &error);
    free(copy);
    if (!document) fail_msg("%s at %d", error.text, error.position);
    return document;
}

/* RFC 4648, section 10, and bytes beyond ASCII. */
TEST(base64)
{
    static const struct {
        const char *bytes, *text;
    } rows[] = {{"f", "Zg=="},          {"fo", "Zm8="},           {"foo", "Zm9v"},
                {"foobar", "Zm9vYmFy"}, {"\xff\xfe\x80", "//6A"}, {"\xfb\xff", "+/8="}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct buffer to = {0};
        base64_add(&to, (const unsigned char *)rows[k].bytes, strlen(rows[k].bytes));
        assert_string_equal(to.data, rows[k].text);
        buffer_free(&to);
    }
}

/* Sections of any length open to the same text; what stands before them stays, their heading is
 * seen. What is no section is left alone. */
TEST(sections_open_again)
{
    unsigned random = 7;
    for (size_t n = 0; n < 3000; n += 1 + n / 3) {
        struct buffer to = {0}, inside = {0}, expected = {0};
        for (size_t i = 0; i < n; i++) {
            random = random * 1664525u + 1013904223u;
            buffer_format(&inside, "%c", 'a' + (int)(random >> 24) % 26);
        }
        buffer_add(&inside, "<p>é</p>");
        buffer_add(&to, "before <section id=\"x\">");
        const size_t start = strlen("before ");
        buffer_format(&to, "<h2>Title</h2>%s</section>\n", inside.data);
        fold_section(&to, start);
        size_t sealed;
        char *whole = markup_unsealed(to.data, &sealed);
        assert_non_null(whole);
#ifdef HAVE_ZLIB
        assert_int_equal(sealed, 1);
        assert_null(strstr(to.data, inside.data));
        buffer_format(&expected,
                      "before <section id=\"x\"><details class=\"part\"><summary><h2>Title</h2>"
                      "</summary>\n<div class=\"opened\">%s</div>\n</details></section>\n",
                      inside.data);
        assert_string_equal(whole, expected.data);
#endif
        free(whole);
        buffer_free(&to), buffer_free(&inside), buffer_free(&expected);
    }
    struct buffer plain = {0};
    fold_section(&plain, 0);
    assert_null(plain.data);
    buffer_add(&plain, "<p>no section</p>");
    fold_section(&plain, 0);
    assert_string_equal(plain.data, "<p>no section</p>");
    buffer_free(&plain);
}

/* What fails with any scheme fails the case; what is open counts of the first scheme alone. */
TEST(states_of_cases)
{
    static const struct {
        const char *first, *second, *gate, *state;
    } rows[] = {{"pass", "pass", "pass", "ok"},
                {"none", "none", "pass", "ok"},
                {"smoke", "pass", "pass", "smoke"},
                {"undetermined", "pass", "pass", "undetermined"},
                {"known", "pass", "pass", "known"},
                {"known", "pass", "smoke", "smoke"},
                {"undetermined", "pass", "known", "undetermined"},
                {"pass", "smoke", "pass", "ok"},
                {"pass", "known", "pass", "ok"},
                {"smoke", "fail", "pass", "fail"},
                {"fail", "pass", "smoke", "fail"},
                {"pass", "pass", "fail", "fail"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        json_t *results = json_pack(
            "{s:[{s:s, s:s, s:s, s:[{s:s}]}], s:[{s:s, s:s, s:[{s:s}, {s:s}]}, {s:s, s:s, "
            "s:[{s:s}]}, {s:s, s:s, s:[{s:s}]}]}",
            "runs", "case", "sod", "label", "a", "status", "ok", "gates", "status", rows[k].gate,
            "studies", "case", "sod", "label", "a", "orders", "status", "pass", "status",
            rows[k].first, "case", "sod", "label", "b", "orders", "status", rows[k].second, "case",
            "lax", "label", "a", "orders", "status", "fail");
        assert_string_equal(case_state(results, "sod"), rows[k].state);
        json_object_set_new(json_array_get(json_object_get(results, "runs"), 0), "status",
                            json_string("broke_down"));
        assert_string_equal(case_state(results, "sod"), "broke_down");
        json_decref(results);
    }
}

static const char flow[] =
    "{'mode': 'quick', 'runs': [{'case': 'flow', 'label': 'one', 'dimension': 2, 'status': 'ok',"
    " 'n': 4, 'time': 1, 'measured': ['velocity'], 'errors': {'velocity': {'l1': 0.375}}, 'gates':"
    " [{'name': 'velocity_l1', 'value': 0.375, 'bound': 1, 'status': 'smoke', 'why': 'coarse'}],"
    " 'profile': {'map': {'x': [0.25, 0.75], 'y': [0.25, 0.75], 'density': [1, 2, 3, 4], 'speed':"
    " [0, 1, 0, 1], 'error': [0.125, 0.25, 0.5, 'nan']}}},"
    " {'case': 'flow', 'label': 'two', 'dimension': 2, 'status': 'ok', 'n': 4, 'time': 1,"
    " 'profile': {'map': {'x': [0.25, 0.75], 'y': [0.25, 0.75], 'density': [1, 2, 3, 4], 'speed':"
    " [0, 1, 0, 1], 'error': [0.75, 0.5, 0.5, 0.5]}}},"
    " {'case': 'tube', 'label': 'one', 'dimension': 1, 'status': 'ok', 'n': 3, 'profile': {'x': [0,"
    " 1, 2], 'density': [1, 1, 2], 'exact': {'x': [0, 2], 'density': [1, 2]}}}],"
    " 'studies': [{'case': 'tube', 'label': 'one', 'status': 'pass', 'levels': [{'n': 100,"
    " 'errors': {'density': {'l1': 0.0625}}}], 'orders': [{'field': 'density', 'norm': "
    "'l1',"
    " 'order': 1.25, 'low': 1, 'high': 1.5, 'gate': {'low': 1}, 'status': 'pass'}]}]}";

static struct page page; /* of flow */

static int make_page(void **state)
{
    (void)state;
    json_t *results = loaded(flow);
    json_object_set_new(results, "verdict", verdict_make(results));
    const bool made = page_make(&page, results);
    json_decref(results);
    return !made;
}

static int free_page(void **state)
{
    (void)state;
    page_free(&page);
    return 0;
}

/* Closed, each case has its picture in the page itself, with what a reader asks first. */
TEST(closed_page)
{
    char fault[256] = "";
    if (!markup_well_formed(page.html, fault, sizeof fault)) fail_msg("%s", fault);
    const char *card = strstr(page.html, "<a class=\"card ok\" href=\"#case-tube\">");
    const char *coarse = strstr(page.html, "<a class=\"card smoke\" href=\"#case-flow\">");
    const char *end = strstr(page.html, "</section>");
    assert_true(card && coarse && coarse < card && card < end);
    assert_true(strstr(card, "<svg class=\"mini\"") < end);
    assert_true(strstr(card, "<path class=\"exact\" d=\"M3 ") < end);
    assert_true(strstr(card, "0.0625 L1(density)") < end);
    assert_true(strstr(card, "order 1.25 ± 0.25") < end);
    assert_true(strstr(coarse, "<image ") < card && strstr(coarse, "0.375 off in velocity") < card);
    assert_true(strstr(coarse, "base64,Qk0") < card); /* "BM": a bitmap */
#ifdef HAVE_ZLIB
    size_t sealed;
    char *whole = markup_unsealed(page.html, &sealed);
    assert_non_null(whole);
    assert_true(sealed >= 3);
    assert_null(strstr(page.html, "<svg class=\"plot\""));
    assert_non_null(strstr(whole, "<svg class=\"plot\""));
    assert_non_null(strstr(whole, "White: no particles, or outside the measure window."));
    free(whole);
#endif
}

/* Both schemes' errors, from 0.125 to 0.75, have one scale of colours. */
TEST(one_scale)
{
    size_t found = 0;
    for (size_t k = 0; k < page.plots.file_count; k++) {
        const struct page_file *file = &page.plots.files[k];
        if (strcmp(file->name, "flow-scheme-error-1.gp") &&
            strcmp(file->name, "flow-scheme-error-2.gp"))
            continue;
        found++;
        if (!strstr(file->bytes, "set cbrange [0.125:0.75]")) fail_msg("%s", file->bytes);
    }
    assert_int_equal(found, 2);
}

int main(void)
{
    return test_run(make_page, free_page);
}
