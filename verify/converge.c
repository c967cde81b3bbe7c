/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "converge.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "measure.h"
#include "result.h"

/* An order lost to the lattice sums shows a relative error of this many floors at most. */
static const double floor_reach = 20;

static double mean_width(const struct run_result *run)
{
    const struct snapshot *s = &run->snapshot;
    double sum = 0, volume = 0;
    for (size_t i = 0; i < s->n; i++)
        if (s->x[0][i] >= run->window[0] && s->x[0][i] <= run->window[1]) {
            sum += s->volume[i] * s->h[i];
            volume += s->volume[i];
        }
    return sum / volume;
}

static void keep_level(struct converge_result *result, const struct run_result *run)
{
    struct converge_level *level = &result->levels[result->level_count++];
    level->n = run->n;
    level->spacing = (run->exact.hi - run->exact.lo) / (double)run->n;
    level->h = mean_width(run);
    for (int field = 0; field < FIELDS; field++)
        for (int norm = 0; norm < NORMS; norm++)
            level->errors[field][norm] = run_error(run, (enum field)field, (enum norm)norm);
    level->binned_density_l1 = run->binned_density_l1;
    level->cpu_s = run->cost.cpu_s;
    memcpy(level->functionals, run->functionals, sizeof level->functionals);
    result->functional_count = run->functional_count;
    result->settings = run->settings;
    result->scheme = run->scheme;
}

static enum status fit_orders(struct converge_result *result, struct error *error)
{
    double spacing[CASE_LADDER_MAX], errors[CASE_LADDER_MAX];
    for (int field = 0; field < FIELDS; field++)
        for (int norm = 0; norm < NORMS; norm++) {
            for (size_t i = 0; i < result->level_count; i++) {
                spacing[i] = result->levels[i].spacing;
                errors[i] = result->levels[i].errors[field][norm];
            }
            if (order_fit(result->level_count, spacing, errors, NULL,
                          &result->orders[field][norm].fit, error))
                return error->status;
        }
    return STATUS_OK;
}

static void extrapolate(struct converge_result *result)
{
    const struct converge_level *last = &result->levels[result->level_count - 3];
    const double spacing[3] = {last[0].spacing, last[1].spacing, last[2].spacing};
    for (size_t i = 0; i < result->functional_count; i++) {
        const double values[3] = {last[0].functionals[i].value, last[1].functionals[i].value,
                                  last[2].functionals[i].value};
        result->functionals[i] = order_extrapolate(spacing, values);
    }
}

static void judge(struct converge_result *result, const struct case_file *file)
{
    const struct converge_level *finest = &result->levels[result->level_count - 1];
    const bool standard = result->scheme.gradient == GRADIENT_STANDARD;
    measure_lattice(&result->scheme.kernel, file->dimension, result->scheme.eta,
                    &result->floor_density, &result->floor_gradient);
    const double floor =
        fmax(fabs(result->floor_density), standard ? fabs(result->floor_gradient) : 0);
    for (size_t i = 0; i < file->gate_count; i++) {
        const struct case_gate *gate = &file->gates[i];
        struct converge_order *order = &result->orders[gate->field][gate->norm];
        order->gate = gate->gate;
        if (file->ladder_count) {
            const double coarser = (double)file->ladder[file->ladder_count - 1] / (double)finest->n;
            order->gate.bound *= pow(fmax(1, coarser), gate->gate.low);
        }
        order->status = order_passes(&order->fit, &order->gate, order->why) ? GATE_PASS : GATE_FAIL;
        if (order->status == GATE_PASS) continue;
        result->passed = false;
        result->floor_explains |= !(order->fit.order >= order->gate.low) &&
                                  finest->errors[gate->field][gate->norm] <= floor_reach * floor;
    }
}

static void suspect(struct converge_result *result)
{
    double errors[CASE_LADDER_MAX];
    char why[SUSPICION_TEXT];
    for (int field = 0; field < FIELDS && !result->suspicion[0]; field++) {
        for (size_t i = 0; i < result->level_count; i++)
            errors[i] = result->levels[i].errors[field][NORM_L1];
        if (suspicion_zero(result->level_count, errors, why) ||
            suspicion_repeated(result->level_count, errors, why))
            snprintf(result->suspicion, sizeof result->suspicion, "%s: %.160s",
                     field_family.members[field]->name, why);
    }
    if (result->suspicion[0]) result->passed = false;
}

enum status converge_execute(const struct run_settings *settings, const size_t *ladder,
                             size_t count, struct converge_result *result,
                             converge_progress *progress, void *context, struct error *error)
{
    double total = 0, done = 0;
    *result = (struct converge_result){.passed = true};
    for (size_t i = 0; i < count; i++) total += (double)ladder[i] * (double)ladder[i];
    for (size_t i = 0; i < count; i++) {
        struct run_settings level = *settings;
        struct run_result run;
        char n[32];
        snprintf(n, sizeof n, "%zu", ladder[i]);
        enum status status = settings_set(&level.settings, SETTING_n, n, SOURCE_USER, NULL, error);
        if (status) return status;
        status = run_execute(&level, &run, error);
        if (status == STATUS_BROKE_DOWN) {
            error_set(error, status, "n = %zu: %.480s", ladder[i], run.message);
            run_free(&run);
        }
        if (status) return status;
        keep_level(result, &run);
        if (run.suspicion[0] && !result->suspicion[0])
            memcpy(result->suspicion, run.suspicion, sizeof result->suspicion);
        run_free(&run);
        done += (double)ladder[i] * (double)ladder[i];
        if (progress) progress(context, done, total);
    }
    if (fit_orders(result, error)) return error->status;
    extrapolate(result);
    judge(result, &settings->file);
    suspect(result);
    return STATUS_OK;
}

static json_t *with_settings(json_t *item, json_t *varied)
{
    if (varied) json_object_set(item, "settings", varied);
    return item;
}

static json_t *level_json(const struct converge_level *level)
{
    json_t *errors = json_object();
    for (int field = 0; field < FIELDS; field++) {
        json_t *norms = json_object();
        for (int norm = 0; norm < NORMS; norm++)
            json_object_set_new(norms, norm_family.members[norm]->name,
                                result_number(level->errors[field][norm]));
        json_object_set_new(errors, field_family.members[field]->name, norms);
    }
    json_object_set_new(errors, "binned_density_l1", result_number(level->binned_density_l1));
    return json_pack("{s:I, s:o, s:o, s:o, s:o}", "n", (json_int_t)level->n, "h",
                     result_number(level->h), "spacing", result_number(level->spacing), "errors",
                     errors, "cpu_s", result_number(level->cpu_s));
}

static json_t *order_json(const struct converge_order *order, int field, int norm)
{
    static const char *const names[] = {"none", "pass", "fail"};
    json_t *pairwise = json_array();
    for (size_t i = 0; i + 1 < order->fit.n; i++)
        json_array_append_new(pairwise, result_number(order->fit.pairwise[i]));
    json_t *gate = json_null();
    if (order->status != GATE_NONE)
        gate =
            json_pack("{s:o, s:o, s:o}", "low", result_number(order->gate.low), "high",
                      result_number(order->gate.high), "bound", result_number(order->gate.bound));
    json_t *item = json_pack(
        "{s:s, s:s, s:o, s:o, s:o, s:o, s:s, s:o, s:s}", "field", field_family.members[field]->name,
        "norm", norm_family.members[norm]->name, "order", result_number(order->fit.order), "low",
        result_number(order->fit.low), "high", result_number(order->fit.high), "pairwise", pairwise,
        "class", order_class_name(order->fit.class), "gate", gate, "status", names[order->status]);
    if (order->status == GATE_FAIL) json_object_set_new(item, "why", json_string(order->why));
    return item;
}

static json_t *functional_json(const struct converge_result *result, size_t i)
{
    const struct order_extrapolation *e = &result->functionals[i];
    json_t *values = json_array();
    for (size_t l = 0; l < result->level_count; l++)
        json_array_append_new(values, result_number(result->levels[l].functionals[i].value));
    return json_pack("{s:s, s:o, s:o, s:o, s:o, s:s}", "name",
                     result->levels[0].functionals[i].name, "values", values, "extrapolated",
                     result_number(e->value), "gci", result_number(e->gci_fine), "order",
                     result_number(e->order), "class", order_class_name(e->class));
}

static json_t *array_of(json_t *document, const char *name)
{
    json_t *array = json_object_get(document, name);
    if (!array) json_object_set_new(document, name, array = json_array());
    return array;
}

void converge_add_json(const struct converge_result *result, json_t *varied, json_t *document)
{
    json_t *levels = array_of(document, "levels"), *orders = array_of(document, "orders"),
           *functionals = array_of(document, "functionals"), *floors = array_of(document, "floors");
    for (size_t i = 0; i < result->level_count; i++)
        json_array_append_new(levels, with_settings(level_json(&result->levels[i]), varied));
    for (int field = 0; field < FIELDS && result->orders[0][0].fit.n; field++)
        for (int norm = 0; norm < NORMS; norm++)
            json_array_append_new(
                orders,
                with_settings(order_json(&result->orders[field][norm], field, norm), varied));
    for (size_t i = 0; i < result->functional_count && result->level_count >= 3; i++)
        json_array_append_new(functionals, with_settings(functional_json(result, i), varied));
    json_t *floor = json_pack(
        "{s:s, s:o, s:o, s:o, s:b, s:s}", "kernel", result->scheme.kernel.member.name, "eta",
        result_number(result->scheme.eta), "density", result_number(result->floor_density),
        "gradient", result_number(result->floor_gradient), "explains", result->floor_explains,
        "suspicion", result->suspicion);
    json_array_append_new(floors, with_settings(floor, varied));
}
