/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verdict.h"

#include "html.h"
#include "page_part.h"
#include "value.h"

static void failures(struct buffer *to, const json_t *list)
{
    enum { SHOWN = 20 };
    size_t i;
    const json_t *entry;
    json_array_foreach(list, i, entry) {
        if (i == SHOWN) {
            buffer_format(to, "- … and %zu more\n", json_array_size(list) - SHOWN);
            break;
        }
        buffer_format(to, "- **%s** %s (`%s`)\n", value_text(entry, "name"),
                      value_text(entry, "detail"), value_text(entry, "command"));
    }
    if (json_array_size(list)) buffer_add(to, "\n");
}

static void orders(struct buffer *to, const json_t *studies)
{
    size_t i;
    const json_t *study;
    if (!json_array_size(studies)) return;
    buffer_add(to, "| case | scheme | error | order | 95 % interval | at the finest level |\n"
                   "|---|---|---|---:|---:|---:|\n");
    json_array_foreach(studies, i, study) {
        const json_t *order = page_study_main(study);
        if (!order) continue;
        buffer_format(to, "| %s | %s | ", value_text(study, "case"), value_text(study, "label"));
        page_study_name(to, order);
        buffer_format(to, " | %.2f | %.2f to %.2f | ", value_member(order, "order"),
                      value_member(order, "low"), value_member(order, "high"));
        html_number(to, page_study_finest(study));
        buffer_add(to, " |\n");
    }
    buffer_add(to, "\n");
}

char *summary_text(const json_t *results)
{
    struct buffer to = {0};
    const json_t *verdict = json_object_get(results, "verdict");
    buffer_format(&to, "## sphproof: %s\n\n", value_text(verdict, "headline"));
    failures(&to, json_object_get(verdict, "failures"));
    double passed = value_member(verdict, "figures_passed");
    buffer_format(&to,
                  "%.0f of %.0f figures within bounds; orders and errors of runs: %s; %.0f of %.0f "
                  "deliberate faults caught; %.0f runs.\n\n",
                  passed, passed + value_member(verdict, "figures_failed"),
                  value_text(verdict, "gates"), value_member(verdict, "mutants_detected"),
                  value_member(verdict, "mutants"), value_member(verdict, "runs"));
    page_since_plain(&to, results);
    orders(&to, json_object_get(results, "studies"));
    buffer_format(&to, "git %s, %s, %s\n", value_text(results, "git"),
                  value_text(results, "compiler"), value_text(results, "date"));
    return buffer_take(&to);
}
