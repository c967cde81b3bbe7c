/* SPDX-License-Identifier: GPL-3.0-or-later
 * Studies as JSON. */
#include "problem_list.h"
#include "study.h"

#include <math.h>

#include "judged.h"
#include "result.h"

static json_t *norms_json(const double values[NORMS], bool known)
{
    json_t *norms = json_object();
    for (int m = 0; m < NORMS; m++)
        json_object_set_new(norms, field_norm_family.members[m]->name,
                            known ? result_number(values[m]) : json_null());
    return norms;
}

static json_t *level_json(const struct study *study, const struct study_level *level)
{
    const struct problem *problem = problem_of(&study->settings.settings);
    const bool line = study->settings.file.dimension == 1;
    json_t *errors = json_object(), *spread = json_object();
    for (int f = 0; f < FIELDS; f++) {
        const char *name = field_family.members[f]->name;
        json_object_set_new(errors, name,
                            norms_json(level->errors[f], problem_knows(problem, (enum field)f)));
        json_object_set_new(spread, name,
                            norms_json(level->spread[f], problem_knows(problem, (enum field)f)));
    }
    for (int part = 0; part < STUDY_PARTS; part++)
        if (isfinite(level->parts[part][NORM_L1]))
            json_object_set_new(errors, study_part_names[part],
                                norms_json(level->parts[part], true));
    json_object_set_new(errors, "binned_density_l1",
                        line && problem_knows(problem, FIELD_DENSITY)
                            ? result_number(level->binned_density_l1)
                            : json_null());
    json_t *item = result_object("n=%zu h=%g spacing=%g errors=%p cpu_s=%g budget=%p", level->n,
                                 level->h, level->spacing, (void *)errors, level->cpu_s,
                                 (void *)run_budget_json(&level->budget));
    result_add(item, "replicates=%zu", study->replicates);
    if (study->replicates > 1) {
        json_object_set(item, "spread", spread);
        json_object_set_new(
            item, "n_range",
            json_pack("[I, I]", (json_int_t)level->n_range[0], (json_int_t)level->n_range[1]));
    }
    json_decref(spread);
    return item;
}

static json_t *order_json(const struct study_order *order, const char *what, const char *norm)
{
    json_t *gate = json_null();
    json_t *pairwise = result_numbers(order->fit.pairwise, order->fit.n ? order->fit.n - 1 : 0);
    if (order->status != FINDING_NONE)
        gate = result_object("low=%g high=%g bound=%g", order->gate.low, order->gate.high,
                             order->gate.bound);
    if (order->status != FINDING_NONE && order->least > 0)
        result_add(gate, "least=%g", order->least);
    json_t *item = result_object(
        "field=%s norm=%s order=%g low=%g high=%g pairwise=%p class=%s gate=%p status=%s", what,
        norm, order->fit.order, order->fit.low, order->fit.high, (void *)pairwise,
        order_class_name(order->fit.class), (void *)gate, finding_words[order->status]);
    if (order->status != FINDING_NONE && order->status != FINDING_PASS)
        result_add(item, "why=%s", order->why);
    if (order->status == FINDING_KNOWN) result_add(item, "known=%s", order->known);
    return item;
}

static json_t *functional_json(const struct study_result *result, size_t i)
{
    const struct order_extrapolation *e = &result->functionals[i];
    json_t *values = json_array();
    for (size_t l = 0; l < result->level_count; l++)
        json_array_append_new(values, result_number(result->levels[l].functionals[i]));
    return result_object(
        "name=%s values=%p extrapolated=%g gci=%g gci_coarse=%g order=%g class=%s exact=%g",
        result->functional_names[i], (void *)values, e->value, e->gci_fine, e->gci_coarse, e->order,
        order_class_name(e->class), result->functional_exact[i]);
}

static json_t *floor_json(const struct study_result *result)
{
    return result_object("kernel=%s eta=%g density=%g gradient=%g explains=%d? suspicion=%s",
                         result->scheme.kernel.member.name, result->scheme.eta,
                         result->floor_density, result->floor_gradient, result->floor_explains,
                         result->suspicion);
}

/* Share of each region in the finest level's L1(density), and its order. */
static json_t *budget_orders_json(const struct study_result *result)
{
    const struct study_level *finest = &result->levels[result->level_count - 1];
    json_t *regions = json_array();
    double whole = 0; /* a sum of arithmetic means; errors of the whole are geometric ones */
    for (size_t r = 0; finest->budget.regions->names[r]; r++)
        whole += finest->budget.l1[r][FIELD_DENSITY];
    for (size_t r = 0; finest->budget.regions->names[r]; r++) {
        const struct order_fit *fit = &result->regions[r];
        const double part = finest->budget.l1[r][FIELD_DENSITY];
        json_t *region = result_object("region=%s l1=%g share=%g", finest->budget.regions->names[r],
                                       part, part / whole);
        if (fit->n) result_add(region, "order=%g low=%g high=%g", fit->order, fit->low, fit->high);
        json_array_append_new(regions, region);
    }
    return json_pack("{s:o, s:{s:o, s:o, s:s}}", "regions", regions, "still_gas", "value",
                     result_number_or_null(result->still), "bound",
                     result_number(STUDY_STILL_BOUND), "status",
                     finding_words[result->still_status]);
}

static void add(json_t *document, const char *list, json_t *item, const json_t *varied)
{
    json_t *array = json_object_get(document, list);
    if (!array) json_object_set_new(document, list, array = json_array());
    if (json_object_size(varied)) json_object_set_new(item, "settings", json_deep_copy(varied));
    json_array_append_new(array, item);
}

/* Adds an order that has no gate, if there is one. */
static void add_fit(json_t *document, const struct order_fit *fit, const char *what,
                    const char *norm, const json_t *varied)
{
    const struct study_order order = {.fit = *fit, .status = FINDING_NONE};
    if (fit->n) add(document, "orders", order_json(&order, what, norm), varied);
}

static json_t *measured_json(const struct study *study)
{
    const struct study_result *result = &study->results[0];
    const char *names[JUDGED_MAX];
    const size_t n = judged_names(&study->settings.file, result->functional_count,
                                  result->functional_names, result->functional_exact, names);
    json_t *list = json_array();
    for (size_t i = 0; i < n; i++) json_array_append_new(list, json_string(names[i]));
    return list;
}

static void add_result(const struct study *study, const struct study_result *result,
                       const json_t *varied, json_t *document)
{
    for (size_t l = 0; l < result->level_count; l++)
        add(document, "levels", level_json(study, &result->levels[l]), varied);
    if (result->status == STATUS_BROKE_DOWN) return;
    for (int f = 0; f < FIELDS; f++)
        for (int m = 0; m < NORMS && problem_knows(problem_of(&result->settings), (enum field)f);
             m++)
            add(document, "orders",
                order_json(&result->orders[f][m], field_family.members[f]->name,
                           field_norm_family.members[m]->name),
                varied);
    for (int part = 0; part < STUDY_PARTS; part++)
        add_fit(document, &result->parts[part], study_part_names[part], "l1", varied);
    for (size_t i = 0; i < result->functional_count; i++)
        if (result->functional_errors[i].fit.n)
            add(document, "orders",
                order_json(&result->functional_errors[i], result->functional_names[i], "error"),
                varied);
    for (size_t k = 0; k < TRACE_FIGURES; k++)
        if (result->kept[k].status != FINDING_NONE)
            add(document, "orders", order_json(&result->kept[k], trace_figures[k], "drift"),
                varied);
    for (size_t i = 0; i < result->functional_count; i++)
        add(document, "functionals", functional_json(result, i), varied);
    if (!study->settings.external)
        add(document, "floors", floor_json(result), varied);
    else if (result->suspicion[0])
        add(document, "floors", result_object("suspicion=%s", result->suspicion), varied);
    if (result->levels[0].budget.regions)
        add(document, "budgets", budget_orders_json(result), varied);
}

void study_add_json(const struct study *study, json_t *document)
{
    static const char *const lists[] = {"levels", "orders", "functionals", "floors", "excluded"};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        json_object_set_new(document, lists[i], json_array());
    result_add(document, "dimension=%d measured=%p", study->settings.file.dimension,
               (void *)measured_json(study));
    for (size_t c = 0; c < study->sweep.count; c++) {
        const struct study_result *result = &study->results[c];
        json_t *varied = sweep_json(&study->sweep, c);
        if (result->excluded) {
            add(document, "excluded", result_object("reason=%s", result->message), varied);
        } else {
            add_result(study, result, varied, document);
            if (result->status == STATUS_BROKE_DOWN && !json_object_get(document, "message"))
                result_add(document, "message=%s", result->message);
        }
        json_decref(varied);
    }
    if (study->suspicion[0]) result_add(document, "suspicion=%s", study->suspicion);
}
