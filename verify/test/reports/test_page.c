/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the report's list of failing figures. (test_page_drawn.c tests the rest.) */
#include "test.h"

#include "case_state.h"
#include "markup.h"
#include "page.h"
#include "page_part.h"
#include "result.h"
#include "style.h"
#include "verdict.h"

/* The page of these results, which it takes over, made without gnuplot. */
static struct page made_of(json_t *results)
{
    struct page made;
    setenv("PATH", "/nowhere", 1);
    json_object_set_new(results, "verdict", verdict_make(results));
    assert_true(page_make(&made, results));
    json_decref(results);
    return made;
}

static char *page_of(json_t *results)
{
    struct page made = made_of(results);
    size_t sealed;
    char fault[256];
    char *whole = markup_unsealed(made.html, &sealed);
    if (!markup_well_formed(whole, fault, sizeof fault)) fail_msg("%s", fault);
    page_free(&made);
    return whole;
}

/* The page begins with all parts of the style sheet, then the colours of plots. */
TEST(style_sheet)
{
    char *whole = page_of(json_object());
    const char *at = strstr(whole, "<style>") + strlen("<style>");
    for (size_t k = 0; page_styles[k]; at += strlen(page_styles[k++]))
        assert_int_equal(strncmp(at, page_styles[k], strlen(page_styles[k])), 0);
    assert_int_equal(strncmp(at, style_css(), strlen(style_css())), 0);
    assert_int_equal(strncmp(at + strlen(style_css()), "</style>", 8), 0);
    free(whole);
}

/* A list of labels ends with the most that a page has room for. */
TEST(most_labels)
{
    const char *labels[PAGE_SCHEMES + 1] = {NULL};
    json_t *list = json_array();
    for (int k = 0; k < PAGE_SCHEMES + 2; k++) {
        const char name[] = {(char)('a' + k), '\0'};
        json_array_append_new(list, json_pack("{s:s}", "label", name));
    }
    assert_int_equal(case_state_labels(list, 1, 1, labels), PAGE_SCHEMES);
    assert_string_equal(labels[0], "a");
    assert_null(labels[PAGE_SCHEMES]);
    json_decref(list);
}

/* For a failed check the page shows the worst figure and 20 more, then the number of figures. */
TEST(failing_figures)
{
    for (int failing = 1; failing < 24; failing++) {
        json_t *checks = json_array();
        size_t shown = 0;
        char more[64];
        for (int i = 0; i <= failing; i++)
            json_array_append_new(checks,
                                  json_pack("{s:s, s:s, s:s, s:s, s:f, s:f, s:f, s:s}", "group",
                                            "kernels", "name", "support", "property", "ends",
                                            "subject", "a", "value", i ? 2. : 0.5, "bound", 1.,
                                            "floor", 0., "status", i ? "fail" : "pass"));
        char *whole = page_of(json_pack("{s:{s:o}}", "verify", "checks", checks));
        for (const char *at = whole; (at = strstr(at, "… and</td>")); at++) shown++;
        snprintf(more, sizeof more, "… and %d more failing figures", failing - 21);
        assert_int_equal(shown, failing < 21 ? failing - 1 : 20);
        assert_int_equal(strstr(whole, more) != NULL, failing > 21);
        assert_int_equal(strstr(whole, "more failing figures") != NULL, failing > 21);
        assert_non_null(strstr(whole, ">1 of "));
        free(whole);
    }
}

/* How much of its bound a check needs, in words and in colour. */
TEST(shares_of_a_bound)
{
    static const struct {
        double value;
        const char *words, *color;
    } rows[] = {{0, "0 %", ""},
                {0.0099, "&lt; 1 %", ""},
                {0.01, "1 %", ""},
                {0.5, "50 %", ""},
                {0.51, "51 %", "close"},
                {1, "100 %", "close"},
                {1.01, "101 %", "over"},
                {999, "99900 %", "over"},
                {1000, "> 1000 times", "over"},
                {(double)NAN, "—", "over"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char cell[120];
        char *whole = page_of(json_pack(
            "{s:{s:[{s:s, s:s, s:o, s:f, s:s}]}}", "verify", "checks", "group", "kernels", "name",
            "support", "value", result_number(rows[k].value), "bound", 1., "status", "pass"));
        snprintf(cell, sizeof cell, "<td class=\"n\">%s<span class=\"margin\"><i class=\"%s\"",
                 rows[k].words, rows[k].color);
        if (!strstr(whole, cell)) fail_msg("%g is not %s", rows[k].value, cell);
        free(whole);
    }
}

/* Changes of one subject since the last report share a row, which shows the largest: in whichever
 * order they are, up or down, and a change without a ratio is larger than any other. */
TEST(changes_of_one_subject)
{
    static const struct {
        const char *path;
        double ratio;
    } changes[] = {{"studies[sod, default].slight", 1.1},
                   {"studies[sod, default].up", 3},
                   {"studies[sod, default].down", 0.2},
                   {"studies[sod, default].word", (double)NAN}};
    static const int orders[][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1},
                                    {2, 1, 0}, {0, 1, 0}, {1, 0, 0}, {0, 3, 2}, {2, 0, 3}};
    for (size_t o = 0; o < sizeof orders / sizeof *orders; o++) {
        json_t *figures = json_array();
        int most = 0;
        for (int i = 0; i < 3; i++) {
            const int k = orders[o][i];
            most = k > most ? k : most;
            json_array_append_new(
                figures, result_object("path=%s old=%g new=%g ratio=%g verdict=%s", changes[k].path,
                                       1., 2., changes[k].ratio, "worse"));
        }
        char *whole = page_of(json_pack("{s:{s:{s:s, s:s, s:o, s:i, s:i, s:i}}}", "history",
                                        "since", "git", "abc", "date", "2026-01-31T12:00:00Z",
                                        "figures", figures, "worse", 3, "better", 0, "same", 0));
        for (int k = 0; k < 4; k++) {
            char row[120];
            snprintf(row, sizeof row, "<td>%s<br/>and 2 more of the same", changes[k].path);
            assert_int_equal(strstr(whole, row) != NULL, k == most);
        }
        free(whole);
    }
}

/* The largest error of pressure counts within 4 h of the contact, which is halfway between two
 * points of the exact solution. */
TEST(pressure_at_the_contact)
{
    char text[] = "{'runs': [{'case': 'sod', 'label': 'a', 'status': 'ok', 'h': 0.1, 'profile': "
                  "{'x': [0.05, 0.12, 0.98], 'density': [2, 2, 1], 'velocity': [0, 0, 0], "
                  "'pressure': [1.5, 1.1, 2], 'exact_density': [2, 2, 1], "
                  "'exact_velocity': [0, 0, 0], 'exact_pressure': [1, 1, 1], "
                  "'exact': {'x': [0, 0.4, 0.6, 1], 'density': [2, 2, 1, 1], "
                  "'velocity': [0, 0, 0, 0], 'pressure': [1, 1, 1, 1]}}}]}";
    for (char *c = text; *c; c++)
        if (*c == '\'') *c = '"';
    char *whole = page_of(json_loads(text, 0, NULL));
    assert_non_null(strstr(whole, "<td class=\"n\">10 %</td></tr>"));
    free(whole);
}

/* The cost of errors is drawn with all errors of other codes in the same case and field. */
TEST(errors_of_other_codes)
{
    static const struct {
        const char *case_name, *error_of;
        size_t drawn;
    } rows[] = {{"gresho", "azimuthal", 4},
                {"yee", "azimuthal", 3},
                {"sedov_2d", "pressure", 3},
                {"kelvin_helmholtz", "mode_amplitude", 4},
                {"yee", "density", 0}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct page made = made_of(
            json_pack("{s:[{s:s, s:s, s:[{s:s}], s:[{s:s, s:f, s:f}, {s:s, s:f, s:f}]}]}", "bench",
                      "case", rows[k].case_name, "error_of", rows[k].error_of, "schemes", "scheme",
                      "a", "points", "scheme", "a", "cpu_s", 1., "error", 1., "scheme", "a",
                      "cpu_s", 2., "error", 1e-5));
        const char *script = made.plots.files[0].bytes;
        size_t drawn = 0;
        for (; (script = strstr(script, "^2' at graph")); script++) drawn++;
        assert_int_equal(drawn, rows[k].drawn);
        page_free(&made);
    }
}
