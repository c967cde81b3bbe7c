/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares pages of random results, drawn from data/drawn/report.json, and the files beside them
 * with data/drawn/pages.txt, byte for byte. Instead of gnuplot's pictures its scripts and data are
 * compared, so that gnuplot is not needed. verify/test/keep renews that file. */
#include "test.h"

#include "drawn_document.h"
#include "findings.h"
#include "markup.h"
#include "page.h"
#include "verdict.h"

enum { PAGES = 100 };

/* The unfolded page without its style sheet and script, and the files beside it. */
static char *whole(struct page *page)
{
    size_t sealed;
    struct buffer text = {0};
    char *html = markup_unsealed(page->html, &sealed), fault[256];
    const char *style = strstr(html, "<style>"), *body = strstr(html, "</style>"),
               *end = strstr(html, "<noscript>");
    if (!markup_well_formed(html, fault, sizeof fault)) fail_msg("%s", fault);
    buffer_add_bytes(&text, html, (size_t)(style - html));
    buffer_add_bytes(&text, body, end ? (size_t)(end - body) : strlen(body));
    for (size_t k = 0; k < page->plots.file_count; k++)
        buffer_format(&text, "--- %s\n%s", page->plots.files[k].name, page->plots.files[k].bytes);
    free(html);
    page_free(page);
    return buffer_take(&text);
}

static void compare(struct digests *kept, const char *what, size_t number, char *text)
{
    char name[64];
    assert_non_null(text);
    snprintf(name, sizeof name, "%s-%zu", what, number);
    digests_compare(kept, name, text);
    free(text);
}

/* The verdict as JSON, for JUnit, and in short. */
static char *verdict_in_words(const json_t *results)
{
    struct buffer text = {0};
    char *parts[] = {json_dumps(json_object_get(results, "verdict"), JSON_INDENT(1)),
                     findings_junit(findings_of_report, results), summary_text(results)};
    for (int k = 0; k < 3; k++) {
        assert_non_null(parts[k]);
        buffer_add(&text, parts[k]);
        free(parts[k]);
    }
    return buffer_take(&text);
}

TEST(pages)
{
    json_t *template = read_template(test_word(1), "report.json");
    char *path = strdup(getenv("PATH") ? getenv("PATH") : "");
    struct digests kept;
    struct page page;
    digests_open(&kept, test_word(1), "pages.txt");
    setenv("PATH", "/nowhere", 1);
    for (size_t k = 0; k < PAGES; k++) {
        struct drawing draw = {k, template};
        json_t *results = drawn_document(&draw, json_object_get(template, "report"));
        json_object_set_new(results, "verdict", verdict_make(results));
        assert_true(page_make(&page, results));
        compare(&kept, "page", k, whole(&page));
        compare(&kept, "verdict", k, verdict_in_words(results));
        json_decref(results);
        json_t *judged = drawn_document(&draw, json_object_get(template, "judge"));
        assert_true(page_make_judge(&page, judged));
        compare(&kept, "judge", k, whole(&page));
        json_decref(judged);
        if (k % 4) continue;
        json_t *compared = drawn_document(&draw, json_object_get(template, "compare"));
        assert_true(page_make_compare(&page, compared));
        compare(&kept, "compare", k, whole(&page));
        json_decref(compared);
        json_t *codes = drawn_document(&draw, json_object_get(template, "codes"));
        json_object_set_new(codes, "verdict", verdict_make(codes));
        assert_true(page_make(&page, codes));
        compare(&kept, "codes", k, whole(&page));
        json_decref(codes);
    }
    setenv("PATH", path, 1);
    free(path);
    json_decref(template);
    digests_close(&kept);
}

/* Verdict, list of failures and JUnit file agree for any results; failures are in the order of
 * ranks, with each check once. */
TEST(one_verdict)
{
    json_t *template = read_template(test_word(1), "report.json");
    size_t well = 0, bad = 0;
    for (size_t k = 0; k < 4 * PAGES; k++) {
        struct drawing draw = {1000 + k, template};
        json_t *results = drawn_document(&draw, json_object_get(template, "report"));
        static const char *const words[] = {"none",  "pass",         "fail", "known",
                                            "smoke", "undetermined", "skip", "odd"};
        if (k % 2) { /* so few results that none may fail */
            json_decref(results);
            results = json_pack("{s:[{s:s, s:s, s:[{s:s}]}]}", "runs", "case", "a", "status",
                                k % 3 ? "ok" : "broke_down", "gates", "status",
                                words[drawn_below(&draw, 8)]);
        }
        json_t *verdict = verdict_make(results);
        const json_t *failures = json_object_get(verdict, "failures");
        char *junit = findings_junit(findings_of_report, results);
        const bool fails = strstr(junit, "<failure ") != NULL;
        assert_true(fails == (json_array_size(failures) > 0));
        assert_string_equal(json_string_value(json_object_get(verdict, "status")),
                            fails ? "fail" : "pass");
        *(fails ? &bad : &well) += 1;
        for (size_t i = 0; i < json_array_size(failures); i++)
            for (size_t j = 0; j < i; j++) {
                const json_t *a = json_array_get(failures, j), *b = json_array_get(failures, i);
                const json_t *one = json_object_get(a, "area"), *other = json_object_get(b, "area");
                const bool check = !strcmp(json_string_value(other), "check");
                /* checks come first, and the name of each check once */
                assert_true(!check || json_equal(one, other));
                assert_false(check &&
                             json_equal(json_object_get(a, "name"), json_object_get(b, "name")));
            }
        free(junit);
        json_decref(verdict);
        json_decref(results);
    }
    assert_true(well > 10 && bad > 10);
    json_decref(template);
}
