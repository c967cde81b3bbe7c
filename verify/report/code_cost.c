/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report_piece.h"

#include <string.h>

#include "case_state.h"
#include "result.h"
#include "value.h"

static void add_points(const json_t *study, const char *what, json_t *points)
{
    const json_t *level;
    size_t l;
    json_array_foreach(json_object_get(study, "levels"), l, level)
        json_array_append_new(points,
                              result_object("scheme=%s n=%p error=%g cpu_s=%g on_front=%p",
                                            value_text(study, "label"),
                                            (void *)json_incref(json_object_get(level, "n")),
                                            case_state_level_error(study, what, l),
                                            value_member(level, "cpu_s"), (void *)json_false()));
}

/* The bench document of the study's case. */
static json_t *bench_of(json_t *bench, const json_t *study, const char *what)
{
    const char *name = value_text(study, "case");
    json_t *document;
    size_t i;
    json_array_foreach(bench, i, document)
        if (strcmp(value_text(document, "case"), name) == 0) return document;
    document = json_pack("{s:s, s:s, s:s, s:s, s:s, s:[], s:[]}", "command", "bench", "case", name,
                         "title", value_text(study, "title"), "error_of", what, "reproduce",
                         value_text(study, "reproduce"), "schemes", "points");
    json_array_append_new(bench, document);
    return document;
}

void code_cost_add(json_t *results)
{
    json_t *bench = json_array(), *study;
    size_t i;
    json_array_foreach(json_object_get(results, "studies"), i, study) {
        const char *what = case_state_measured(study);
        json_t *document = bench_of(bench, study, what);
        json_array_append_new(json_object_get(document, "schemes"),
                              result_object("scheme=%s", value_text(study, "label")));
        add_points(study, what, json_object_get(document, "points"));
    }
    json_object_set_new(results, "bench", bench);
}
