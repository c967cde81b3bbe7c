/* SPDX-License-Identifier: GPL-3.0-or-later
 * Parts of the report's page that drawn results (test_page_drawn) do not have: what is skipped, and
 * what orders are lost to; and a page without gnuplot. */
#include "test.h"

#include "markup.h"
#include "page.h"
#include "verdict.h"

/* The page is well-formed, needs nothing from elsewhere, and says this; *plots: of its plots. */
static void judge_page(const json_t *results, const char *const *contents, size_t n,
                       struct page *page)
{
    size_t sealed;
    char fault[256] = "";
    assert_true(page_make(page, results));
    char *whole = markup_unsealed(page->html, &sealed);
    assert_non_null(whole);
    if (!markup_well_formed(whole, fault, sizeof fault)) fail_msg("%s", fault);
    assert_null(markup_network(whole));
    for (size_t k = 0; k < n; k++)
        if (!strstr(whole, contents[k])) fail_msg("the page lacks: %s", contents[k]);
    free(whole);
}

static json_t *nothing(void)
{
    json_t *results = json_object();
    json_object_set_new(results, "verdict", verdict_make(results));
    return results;
}

/* What is skipped: shares, whose source they name, the ratio of CPU times, and a map. */
TEST(skips)
{
    static const char *const contents[] = {"id=\"skips\"",
                                           "<code>sod n=8</code>",
                                           "<td class=\"n\">25 %</td>",
                                           "<td class=\"n\">50 %*</td>",
                                           "<td class=\"n\">0.80</td>",
                                           "plots/sod-asleep-1.dat",
                                           "sphproof bench sod n=8 --skips --samples 3"};
    json_t *results = nothing();
    json_object_set_new(
        results, "skips",
        json_pack("[{s:s, s:[{s:s, s:f, s:f, s:s, s:f, s:f, s:f, s:f, s:s, s:[[f,f],[f,n]]}]}]",
                  "reproduce", "sphproof bench sod n=8 --skips --samples 3", "skips", "case", "sod",
                  "skipped_fraction", 0.25, "possible_fraction", 0.5, "possible_by",
                  "coarse threshold", "saves", 1.25, "spread", 0.03, "difference", 1e-12, "bound",
                  1e-8, "status", "pass", "asleep", 0., 0.5, 1.));
    struct page made;
    judge_page(results, contents, sizeof contents / sizeof *contents, &made);
    size_t map = 0;
    const size_t files = made.plots.file_count;
    while (map < files && strcmp(made.plots.files[map].name, "sod-asleep-1.dat") != 0) map++;
    assert_true(map < files);
    assert_non_null(strstr(made.plots.files[map].bytes, "\n 0 0.5\n 1 NaN\n"));
    page_free(&made);
    json_decref(results);
}

/* Of a check that fails the worst figure and 20 more are shown, then how many there are. */
TEST(failing_figures)
{
    for (int failing = 1; failing < 24; failing++) {
        json_t *results = json_object(), *checks = json_array();
        struct page made;
        size_t sealed, shown = 0;
        char more[64];
        for (int i = 0; i <= failing; i++)
            json_array_append_new(checks,
                                  json_pack("{s:s, s:s, s:s, s:s, s:f, s:f, s:f, s:s}", "group",
                                            "kernels", "name", "support", "property", "ends",
                                            "subject", "a", "value", i ? 2. : 0.5, "bound", 1.,
                                            "floor", 0., "status", i ? "fail" : "pass"));
        json_object_set_new(results, "verify", json_pack("{s:o}", "checks", checks));
        json_object_set_new(results, "verdict", verdict_make(results));
        assert_true(page_make(&made, results));
        char *whole = markup_unsealed(made.html, &sealed);
        assert_non_null(whole);
        for (const char *at = whole; (at = strstr(at, "… and</td>")); at++) shown++;
        snprintf(more, sizeof more, "… and %d more failing figures", failing - 21);
        assert_int_equal(shown, failing < 21 ? failing - 1 : 20);
        assert_int_equal(strstr(whole, more) != NULL, failing > 21);
        assert_int_equal(strstr(whole, "more failing figures") != NULL, failing > 21);
        assert_non_null(strstr(whole, ">1 of "));
        free(whole);
        page_free(&made);
        json_decref(results);
    }
}

/* What orders are lost to: the sentence, the shares of the finest level, and a picture. */
TEST(autopsies)
{
    static const char *const contents[] = {"id=\"autopsies\"",
                                           "href=\"#autopsies\"",
                                           "The order, 1, is lost to disorder from 8^2 on: it is",
                                           "<td class=\"n\">0.750</td>",
                                           "<td class=\"n\">1.25</td>",
                                           "plots/yee-autopsy-1.dat",
                                           "sphproof autopsy yee --n 8^2,16^2"};
    static const char *const share = "{s:s, s:i, s:f, s:f, s:f, s:n, s:n}";
    json_t *results = nothing(), *list = json_array();
    for (int n = 64; n <= 256; n *= 4)
        for (int k = 0; k < 2; k++)
            json_array_append_new(list, json_pack(share, "part", k ? "time_step" : "disorder", "n",
                                                  n, "share",
                                                  n == 64 ? 0.5
                                                  : k     ? 0.25
                                                          : 0.75,
                                                  "error", 0.1, "order", 1.25, "low", "high"));
    json_object_set_new(
        results, "autopsies",
        json_pack("[{s:s, s:s, s:i, s:s, s:o, s:s, s:[{s:i,s:f,s:f},{s:i,s:f,s:f}]}]", "case",
                  "yee", "title", "A vortex", "dim", 2, "sentence",
                  "The order, 1, is lost to disorder from 8^2 on: it is 75 % of the error",
                  "shares", list, "reproduce", "sphproof autopsy yee --n 8^2,16^2", "levels", "n",
                  64, "spacing", 0.125, "error", 0.2, "n", 256, "spacing", 0.0625, "error", 0.1));
    struct page made;
    judge_page(results, contents, sizeof contents / sizeof *contents, &made);
    size_t sealed;
    char *page = markup_unsealed(made.html, &sealed);
    assert_null(strstr(page, "<td class=\"n\">0.500</td>")); /* of the finest level alone */
    free(page);
    page_free(&made);
    /* without gnuplot all but the picture is there */
    char *path = strdup(getenv("PATH") ? getenv("PATH") : "");
    setenv("PATH", "/nowhere", 1);
    judge_page(results, contents, 5, &made);
    setenv("PATH", path, 1);
    free(path);
    assert_int_equal(made.plots.missing, 1);
    assert_non_null(strstr(made.plots.message, "gnuplot"));
    assert_null(strstr(made.html, "<svg class=\"plot\""));
    page_free(&made);
    json_decref(results);
}
