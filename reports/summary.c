/* SPDX-License-Identifier: GPL-3.0-or-later
 * The results in a few lines of Markdown, for a pull request or a terminal. */
#include <string.h>

#include "html.h"
#include "page.h"

static void failures(struct buffer *to, const json_t *list)
{
    enum { SHOWN = 20 };
    size_t i;
    const json_t *entry;
    json_array_foreach(list, i, entry)
    {
        if (i == SHOWN) {
            buffer_format(to, "- … and %zu more\n", json_array_size(list) - SHOWN);
            break;
        }
        buffer_format(to, "- **%s** %s (`%s`)\n", html_string(entry, "name"),
                      html_string(entry, "detail"), html_string(entry, "command"));
    }
    if (json_array_size(list)) buffer_add(to, "\n");
}

static void orders(struct buffer *to, const json_t *studies)
{
    size_t i, j;
    const json_t *study, *order;
    if (!json_array_size(studies)) return;
    buffer_add(to, "| case | scheme | order of L1(density) | 95 % interval | finest error |\n"
                   "|---|---|---:|---:|---:|\n");
    json_array_foreach(studies, i, study)
    {
        const json_t *levels = json_object_get(study, "levels");
        const json_t *finest = json_array_get(levels, json_array_size(levels) - 1);
        json_array_foreach(json_object_get(study, "orders"), j, order)
        {
            if (strcmp(html_string(order, "field"), "density") ||
                strcmp(html_string(order, "norm"), "l1"))
                continue;
            buffer_format(to, "| %s | %s | %.2f | %.2f to %.2f | ", html_string(study, "case"),
                          html_string(study, "label"), html_member(order, "order"),
                          html_member(order, "low"), html_member(order, "high"));
            html_number(to, html_member2(json_object_get(finest, "errors"), "density", "l1"));
            buffer_add(to, " |\n");
        }
    }
    buffer_add(to, "\n");
}

char *page_summary(const json_t *results)
{
    struct buffer to = {0};
    const json_t *verdict = json_object_get(results, "verdict");
    buffer_format(&to, "## sphproof: %s\n\n", html_string(verdict, "headline"));
    failures(&to, json_object_get(verdict, "failures"));
    double passed = html_member(verdict, "figures_passed");
    double gates = html_member(verdict, "gates_passed");
    buffer_format(
        &to,
        "%.0f of %.0f figures within bounds, %.0f of %.0f orders as expected, %.0f of %.0f "
        "deliberate faults caught, %.0f runs.\n\n",
        passed, passed + html_member(verdict, "figures_failed"), gates,
        gates + html_member(verdict, "gates_failed"), html_member(verdict, "mutants_detected"),
        html_member(verdict, "mutants"), html_member(verdict, "runs"));
    orders(&to, json_object_get(results, "studies"));
    buffer_format(&to, "git %s, %s, %s\n", html_string(results, "git"),
                  html_string(results, "compiler"), html_string(results, "date"));
    return buffer_take(&to);
}
