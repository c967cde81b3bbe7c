/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "page.h"

#include <stdlib.h>
#include <string.h>

#include "html.h"
#include "page_part.h"
#include "style.h"
#include "value.h"

static void tile(struct buffer *to, const char *label, double good, double all, const char *anchor)
{
    if (!(all > 0)) return;
    buffer_format(to,
                  "<a class=\"tile %s\" href=\"#%s\"><b>%.0f</b><span> of %.0f</span><br/>%s</a>\n",
                  good < all ? "bad" : "good", anchor, good, all, label);
}

/* Writes how many of the judged orders and errors are as expected, and the states of the others. */
static void gates_tile(struct buffer *to, const json_t *verdict)
{
    static const char *const others[][2] = {{"gates_smoke", "too coarse to judge"},
                                            {"gates_undetermined", "undetermined"},
                                            {"gates_known", "known"}};
    const double good = value_member(verdict, "gates_passed");
    struct buffer label = {0};
    buffer_add(&label, "orders and errors of runs as expected");
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        const double count = value_member(verdict, others[k][0]);
        if (count > 0) buffer_format(&label, "%s%.0f %s", k ? ", " : "; ", count, others[k][1]);
    }
    tile(to, buffer_text(&label, to), good, good + value_member(verdict, "gates_failed"), "cases");
    buffer_free(&label);
}

static void head(struct buffer *to, const json_t *results, const json_t *verdict)
{
    bool well = !strcmp(value_text(verdict, "status"), "pass");
    struct buffer title = {0};
    buffer_format(&title, ": %s", value_text(verdict, "headline"));
    page_head(to, buffer_text(&title, to));
    buffer_free(&title);
    html_format(to,
                "<header class=\"%s\"><p class=\"kind\">sphproof %s report</p><h1>%s</h1>\n"
                "<p class=\"facts\">%s · git %s",
                well ? "well" : "unwell", value_text(results, "mode"),
                value_text(verdict, "headline"), value_text(results, "date"),
                value_text(results, "git"));
    double seconds = value_member(results, "seconds");
    if (seconds > 0) buffer_format(to, " · computed in %.0f s", seconds);
    buffer_add(to, "</p>\n");
    page_since(to, results);
    buffer_add(to, "<p class=\"tiles\">");
    double passed = value_member(verdict, "figures_passed");
    double runs = value_member(verdict, "runs");
    tile(to, "figures within their bounds", passed,
         passed + value_member(verdict, "figures_failed"), "checks");
    gates_tile(to, verdict);
    tile(to, "runs sound", runs - value_member(verdict, "broke_down"), runs, "cases");
    tile(to, "deliberate faults caught", value_member(verdict, "mutants_detected"),
         value_member(verdict, "mutants"), "detection");
    tile(to, "faults around it answered rightly", value_member(verdict, "faults_right"),
         value_member(verdict, "faults"), "faults");
    buffer_add(to, "</p></header>\n");
}

static void failures(struct buffer *to, const json_t *verdict)
{
    const json_t *list = json_object_get(verdict, "failures"), *entry;
    if (!json_array_size(list)) return;
    enum { SHOWN = 60 };
    buffer_add(to, "<section id=\"failures\"><h2>What is wrong</h2><ol class=\"failures\">\n");
    size_t i;
    json_array_foreach(list, i, entry) {
        if (i == SHOWN) break;
        html_format(to, "<li><p><span class=\"area\">%s</span> <b>%s</b><br/>%s</p>",
                    value_text(entry, "area"), value_text(entry, "name"),
                    value_text(entry, "detail"));
        html_command(to, "see it again:", value_text(entry, "command"));
        buffer_add(to, "</li>\n");
    }
    buffer_add(to, "</ol>");
    if (json_array_size(list) > SHOWN)
        buffer_format(to, "<p>… and %zu more, all in results.json.</p>",
                      json_array_size(list) - SHOWN);
    buffer_add(to, "</section>\n");
}

static void environment(struct page_writer *writer, const json_t *results)
{
    static const char *const rows[][2] = {{"program", "version"},
                                          {"git", "git"},
                                          {"compiler", "compiler"},
                                          {"flags", "flags"},
                                          {"system", "machine/system"},
                                          {"architecture", "machine/architecture"},
                                          {"processor", "machine/processor"}};
    struct buffer *to = &writer->to;
    buffer_add(to, "<section id=\"environment\"><h2>Environment and definitions</h2>"
                   "<div class=\"scroll\"><table class=\"facts\"><tbody>\n");
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const char *value = json_string_value(html_member(results, rows[k][1]));
        if (value && *value)
            html_format(to, "<tr><th>%s</th><td>%s</td></tr>\n", rows[k][0], value);
    }
    buffer_format(to, "<tr><th>cores</th><td>%.0f</td></tr></tbody></table></div>\n",
                  value_inner(results, "machine", "cores"));
    buffer_add(
        to, "<p>Norms over the particles i of a case's measure window, with volumes V: "
            "L1 = Σ V |q − q_exact| / Σ V, L2 = (Σ V (q − q_exact)² / Σ V)^½, "
            "L∞ = max |q − q_exact|; the particle mean is L1 with equal weights. An order is the "
            "least-squares slope of log(error) against log(n^(−1/d)) in d dimensions, with its 95 "
            "% interval. "
            "Conservation compares t_end with t = 0. All quantities are in code units.</p>\n"
            "<p>Each line can be seen again: the commands are for a shell in the project's folder, "
            "after <code>reports/run</code> has built the program there and <code>export "
            "PATH=$PWD/build:$PATH</code>.</p>\n"
            "<p>Everything on this page is in <a href=\"results.json\">results.json</a>; each "
            "plot's data and gnuplot script are in the folder <code>plots</code>.</p></section>\n");
}

void page_head(struct buffer *to, const char *title)
{
    html_format(
        to,
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>"
        "<meta name=\"color-scheme\" content=\"light dark\"/><title>sphproof%s</title><style>",
        title);
    for (size_t k = 0; page_styles[k]; k++) buffer_add(to, page_styles[k]);
    buffer_format(to, "%s</style></head><body>\n", style_css());
}

bool page_end(struct page_writer *writer, struct page *page)
{
    buffer_add(&writer->to, "</main></body></html>\n");
    plot_pen_free(&writer->pen);
    *page = (struct page){.html = buffer_take(&writer->to), .plots = writer->plots};
    if (!page->html) page_free(page);
    return page->html;
}

/* Folded sections in their order, each shown if the results have its member (not an empty list);
 * name NULL: without a link. */
static const struct section {
    const char *member, *id, *name;
    void (*write)(struct page_writer *writer, const json_t *results);
} sections[] = {
    {"history/since", "history", "Changes", page_history},
    {"studies", "overview", NULL, page_overview},
    {"bench", "cost", "Cost", page_bench},
    {"autopsies", "autopsies", "Lost orders", page_autopsies},
    {"skips", "skips", "Skips", page_skips},
    {"gradients", "gradients", "Gradients", page_gradients},
    {"stress", "stability", "Stability", page_stress},
    {"claims", "claims", "Claims", page_claims},
    {"faults", "faults", "Faults", page_faults},
    {"score", "score", "Score", page_score},
    {"kernels", "kernels", "Kernels", page_kernels},
    {"verify", "checks", "Checks", page_checks},
    {"verify", "detection", "Detection", page_detection},
    {NULL, "environment", "Environment", environment},
};
enum { SECTIONS = sizeof sections / sizeof *sections };

static bool is_shown(const struct section *section, const json_t *results)
{
    const json_t *member = html_member(results, section->member);
    return json_is_object(member) || json_array_size(member);
}

bool page_make(struct page *page, const json_t *results)
{
    struct page_writer writer = {.to = {0}};
    struct buffer *to = &writer.to;
    const json_t *verdict = json_object_get(results, "verdict");
    const bool of_codes = page_of_codes(results);
    head(to, results, verdict);
    buffer_add(to, "<nav>");
    for (size_t k = 0; k < SECTIONS; k++) {
        if (k == 1) buffer_add(to, "<a href=\"#cases\">Cases</a>");
        if (sections[k].name && is_shown(&sections[k], results))
            buffer_format(to, "%s<a href=\"#%s\">%s</a>%s", k ? " " : "", sections[k].id,
                          sections[k].name, k ? "" : " ");
    }
    buffer_add(to, "</nav>\n<main>\n");
    failures(to, verdict);
    (of_codes ? page_codes : page_strip)(&writer, results);
    page_cases(&writer, results);
    for (size_t k = 0; k < SECTIONS; k++) {
        const size_t start = to->size;
        if (!is_shown(&sections[k], results) || (of_codes && sections[k].write == page_overview))
            continue;
        sections[k].write(&writer, results);
        fold_section(to, start);
    }
    buffer_add(to, fold_script);
    return page_end(&writer, page);
}

void page_free(struct page *page)
{
    page_plots_free(&page->plots);
    free(page->html);
}
