/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>

#include "judge.h"
#include "cloud_profile.h"
#include "profile.h"
#include "result.h"
#include "settings_output.h"

static json_t *kernel_json(const struct judged *judged)
{
    const struct conventions *c = &judged->conventions;
    json_t *candidates = json_array();
    for (size_t k = 0; k < c->count; k++)
        json_array_append_new(candidates,
                              json_pack("{s:s, s:s, s:o, s:o}", "name",
                                        c->candidate[k].kernel.member.name, "density",
                                        c->candidate[k].sum == DENSITY_MASSES ? "masses" : "number",
                                        "ratio", result_number(c->candidate[k].ratio), "residual",
                                        result_number(c->candidate[k].residual)));
    return json_pack("{s:s, s:o, s:o, s:s, s:s?, s:o, s:o}", "name",
                     c->known ? c->candidate[0].kernel.member.name : "not identifiable", "ratio",
                     c->known ? result_number(c->candidate[0].ratio) : json_null(), "residual",
                     c->count ? result_number(c->candidate[0].residual) : json_null(), "why",
                     c->why, "said", judged->file.kernel[0] ? judged->file.kernel : NULL,
                     "said_ratio",
                     judged->file.ratio > 0 ? result_number(judged->file.ratio) : json_null(),
                     "candidates", candidates);
}

static json_t *notes_json(const struct snapshot_notes *notes)
{
    json_t *list = json_array();
    for (size_t k = 0; k < notes->count; k++)
        json_array_append_new(list,
                              json_pack("{s:s, s:s, s:s}", "what", notes->note[k].what, "value",
                                        notes->note[k].value, "evidence", notes->note[k].evidence));
    return list;
}

static json_t *one_json(const struct judged *judged, bool profiles)
{
    const struct run_result *r = &judged->result;
    const struct snapshot_file *file = &judged->file;
    const bool plane = judged->file.dim > 1;
    json_t *one = json_pack(
        "{s:s, s:s, s:s, s:o, s:I, s:o, s:i, s:{s:o, s:o}, s:o, s:o, s:o, s:o, s:o, s:{s:o, s:o}, "
        "s:b, s:s}",
        "file", judged->path, "layout", file->layout, "code", file->code, "assumptions",
        notes_json(&file->notes), "n", (json_int_t)r->n, "time", result_number(r->time), "dim",
        file->dim, "precision", "positions", result_number(file->precision[0]), "fields",
        result_number(file->precision[1]), "kernel", kernel_json(judged), "window",
        window_json(&r->problem.window), "errors", run_errors_json(r), "functionals",
        run_functionals_json(r), "budget", budget_json(&r->budget), "noise", "transverse_velocity",
        plane ? result_number(judged->transverse) : json_null(), "undisturbed",
        r->budget.regions ? result_number(r->budget.still) : json_null(), "foreign",
        judged->foreign, "verdict", judged->verdict);
    if (one && profiles)
        json_object_set_new(one, "profile", plane ? cloud_profile_json(r) : profile_json(r));
    return one;
}

/* What it comes to: "fail" where a gate does, or a snapshot does not pass; and in words, gates that
 * fail first. */
static void add_conclusion(json_t *document, const struct judged *judged, size_t n,
                           const struct judge_gate *gates, size_t gate_count)
{
    char text[1024] = "";
    size_t failed = 0, used = 0;
    bool pass = true;
    for (size_t i = 0; i < n; i++) pass &= judged[i].passes;
    for (size_t k = 0; k < gate_count; k++) failed += !gates[k].good;
    if (failed)
        used = (size_t)snprintf(text, sizeof text, "%zu of %zu gate%s failed: ", failed, gate_count,
                                gate_count == 1 ? "" : "s");
    for (size_t k = 0, said = 0; k < gate_count && used < sizeof text; k++) {
        if (gates[k].good) continue;
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%s %.3g is not <= %.3g",
                                 said++ ? ", " : "", gates[k].name, gates[k].value, gates[k].bound);
    }
    if (used < sizeof text)
        snprintf(text + used, sizeof text - used, "%s%s", failed ? "; " : "",
                 judge_main(judged, n)->verdict);
    json_object_set_new(document, "status", json_string(failed || !pass ? "fail" : "pass"));
    json_object_set_new(document, "headline", json_string(text));
}

json_t *judge_json(const struct judged *judged, size_t n, const struct judge_gate *gates,
                   size_t gate_count, bool profiles)
{
    struct trace_drift drift;
    size_t pair[2];
    const struct judged *main = judge_main(judged, n);
    json_t *document = one_json(main, profiles), *list = json_array();
    if (!document || !list) return NULL;
    json_object_set_new(document, "case", json_string(main->run.asked.file.name));
    json_object_set_new(document, "settings", settings_json(&main->run.settings));
    json_object_set_new(
        document, "conservation",
        !judge_drift(judged, n, &drift, pair)
            ? json_null()
            : json_pack("{s:o, s:o, s:o, s:o, s:[s, s]}", "mass", result_number(drift.mass),
                        "momentum", result_number(drift.momentum), "angular_momentum",
                        main->file.dim == 1 ? json_null() : result_number(drift.angular_momentum),
                        "energy", result_number(drift.energy), "between", judged[pair[0]].path,
                        judged[pair[1]].path));
    json_object_set_new(document, "orders", judge_orders(judged, n));
    for (size_t k = 0; k < gate_count; k++)
        json_array_append_new(list, json_pack("{s:s, s:o, s:o, s:s}", "name", gates[k].name,
                                              "value", result_number(gates[k].value), "bound",
                                              result_number(gates[k].bound), "status",
                                              gates[k].good ? "pass" : "fail"));
    json_object_set_new(document, "gates", list);
    add_conclusion(document, judged, n, gates, gate_count);
    if (n > 1) {
        json_t *all = json_array();
        for (size_t i = 0; i < n; i++) json_array_append_new(all, one_json(&judged[i], profiles));
        json_object_set_new(document, "snapshots", all);
    }
    return document;
}
