/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gates.h"
#include "judge.h"
#include "result.h"
#include "run_output.h"
#include "value.h"

static json_t *kernel_json(const struct judged *judged)
{
    const struct conventions *c = &judged->conventions;
    json_t *candidates = json_array();
    for (size_t k = 0; k < c->count; k++)
        json_array_append_new(
            candidates, result_object("name=%s density=%s ratio=%g residual=%g",
                                      c->candidate[k].kernel.member.name,
                                      c->candidate[k].sum == DENSITY_MASSES ? "masses" : "number",
                                      c->candidate[k].ratio, c->candidate[k].residual));
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
                              result_object("what=%s value=%s evidence=%s", notes->note[k].what,
                                            notes->note[k].value, notes->note[k].evidence));
    return list;
}

/* Null unless the snapshot is of t = 0. */
static json_t *start_json(const struct judge_start *start)
{
    static const char *const names[START_FIELDS] = {"velocity", "internal_energy", "mass",
                                                    "pressure"};
    if (!start->looked) return json_null();
    json_t *of = result_object("wrong=%zu message=%s", start->wrong, start->message);
    for (int f = 0; f < START_FIELDS; f++)
        json_object_set_new(of, names[f], result_number(start->worst[f]));
    return of;
}

json_t *judge_one_json(const struct judged *judged, bool profiles)
{
    const struct run_result *r = &judged->result;
    const struct snapshot_file *file = &judged->file;
    const bool plane = judged->file.dim > 1;
    json_t *one = json_pack(
        "{s:s, s:s, s:s, s:o, s:I, s:o, s:i, s:{s:o, s:o}, s:o, s:o, s:o, s:o, s:o, s:{s:o, s:o}, "
        "s:b, s:s, s:s?, s:o}",
        "file", judged->path, "layout", file->layout, "code", file->code, "assumptions",
        notes_json(&file->notes), "n", (json_int_t)r->n, "time", result_number(r->time), "dim",
        file->dim, "precision", "positions", result_number(file->precision[0]), "fields",
        result_number(file->precision[1]), "kernel", kernel_json(judged), "window",
        run_window_json(&r->problem.window), "errors", run_errors_json(r), "functionals",
        run_functionals_json(r), "budget", run_budget_json(&r->budget), "noise",
        "transverse_velocity", plane ? result_number(judged->transverse) : json_null(),
        "undisturbed", r->budget.regions ? result_number(r->budget.still) : json_null(), "foreign",
        judged->foreign, "verdict", judged->verdict, "meant",
        judged->meant[0] ? judged->meant : NULL, "start", start_json(&judged->of_start));
    if (one && profiles) json_object_set_new(one, "profile", profile_json(r));
    return one;
}

/* Adds a finding: {"name", "status", "message"}. */
static void add_finding(json_t *findings, const char *name, const char *status, const char *message)
{
    json_array_append_new(findings,
                          result_object("name=%s status=%s message=%s", name, status, message));
}

/* Adds a gate's finding. A gate of the command line that cannot be decided fails. */
static void add_gate(json_t *findings, const json_t *gate)
{
    const char *name = value_text(gate, "name"), *why = value_text(gate, "why"),
               *relation = value_text(gate, "relation"), *status = value_text(gate, "status");
    const bool undecided = !strcmp(status, finding_words[FINDING_UNDETERMINED]),
               asked = !strcmp(value_text(gate, "source"), JUDGE_ASKED);
    char text[400];
    if (undecided)
        snprintf(text, sizeof text, "%s %s %.3g: %s", name, relation, value_member(gate, "bound"),
                 why);
    else
        snprintf(text, sizeof text, "%s %.3g is %s%s %.3g%s%s", name, value_member(gate, "value"),
                 strcmp(status, finding_words[FINDING_FAIL]) ? "" : "not ", relation,
                 value_member(gate, "bound"), *why ? "; " : "", why);
    add_finding(findings, name, undecided && asked ? finding_words[FINDING_FAIL] : status, text);
}

/* One finding for each snapshot and each gate, and one that fails if nothing could be compared. */
static json_t *findings_json(const struct judged *judged, size_t n, const json_t *gates)
{
    json_t *findings = json_array();
    const json_t *gate, *finding;
    bool decided = false;
    size_t i;
    for (i = 0; i < n; i++)
        add_finding(findings, judged[i].path,
                    finding_words[!judged[i].passes  ? FINDING_FAIL
                                  : judged[i].silent ? FINDING_UNDETERMINED
                                                     : FINDING_PASS],
                    judged[i].verdict);
    json_array_foreach(gates, i, gate) add_gate(findings, gate);
    json_array_foreach(findings, i, finding)
        decided |= strcmp(value_text(finding, "status"), finding_words[FINDING_UNDETERMINED]) != 0;
    if (!decided)
        add_finding(findings, "comparison", finding_words[FINDING_FAIL],
                    "nothing could be compared");
    return findings;
}

/* Adds status and headline: failed gates first, then the number of undecided ones. */
static void add_conclusion(json_t *document, const json_t *findings, size_t snapshots, size_t gates,
                           const struct judged *main)
{
    char failing[700] = "", text[1600];
    size_t failed = 0, silent = 0, used = 0, i;
    bool good = true;
    const json_t *finding;
    json_array_foreach(findings, i, finding) {
        const char *status = value_text(finding, "status");
        const bool fails = !strcmp(status, finding_words[FINDING_FAIL]);
        good &= !fails;
        if (i < snapshots || i >= snapshots + gates) continue;
        silent += !fails && strcmp(status, finding_words[FINDING_PASS]) != 0;
        if (fails && used < sizeof failing)
            used += (size_t)snprintf(failing + used, sizeof failing - used, "%s%s",
                                     failed ? ", " : "", value_text(finding, "message"));
        failed += fails;
    }
    used = 0;
    if (failed)
        used = (size_t)snprintf(text, sizeof text, "%zu of %zu gate%s failed: %s; ", failed, gates,
                                gates == 1 ? "" : "s", failing);
    else if (silent)
        used = (size_t)snprintf(text, sizeof text, "%zu of %zu gates pass, %zu cannot tell; ",
                                gates - silent, gates, silent);
    snprintf(text + used, sizeof text - used, "%s", main->verdict);
    result_add(document, "status=%s headline=%s", finding_words[good ? FINDING_PASS : FINDING_FAIL],
               text);
}

json_t *judge_json(const struct judged *judged, size_t n, json_t *gates, bool profiles)
{
    const struct judged *main = judge_main(judged, n);
    json_t *document = judge_one_json(main, profiles), *findings = findings_json(judged, n, gates);
    if (!document || !findings) return NULL;
    result_add(document, "case=%s settings=%p", main->run.asked.file.name,
               (void *)settings_json(&main->run.settings));
    struct trace trace;
    json_object_set_new(document, "conservation", judge_conservation(judged, n, &trace));
    if (trace.count)
        json_object_set_new(document, "through_time", trace_json(&trace, main->file.dim));
    json_object_set_new(document, "orders", judge_orders(judged, n));
    char why[JUDGE_WHY];
    if (!judge_one_ladder(judged, n, why)) result_add(document, "no_orders=%s", why);
    if (gates)
        json_object_set(document, "gates", gates);
    else
        json_object_set_new(document, "gates", json_array());
    add_conclusion(document, findings, n, json_array_size(gates), main);
    json_object_set_new(document, "findings", findings);
    if (n > 1) {
        json_t *all = json_array();
        for (size_t i = 0; i < n; i++)
            json_array_append_new(all, judge_one_json(&judged[i], profiles));
        json_object_set_new(document, "snapshots", all);
    }
    return document;
}
