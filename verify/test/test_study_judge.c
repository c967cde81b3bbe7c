/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a study makes of the documents of its runs, on documents that are made here: means and
 * spreads, orders, gates, stillness, suspicions, and every line of its own document. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "judged.h"
#include "measure.h"
#include "near.h"
#include "problem_list.h"
#include "result.h"
#include "study.h"

enum { LEVELS = 4 };
static const size_t ladder[LEVELS] = {40, 80, 160, 320};

/* What a run of a level and replicate says. */
static double spacing_of(size_t l, size_t r)
{
    return 2. / (double)ladder[l] * (1 + 0.02 * (double)r);
}

/* Of order 1 + f/10 + m/100, and scattered by replicates. */
static double error_at(int f, int m, size_t l, size_t r)
{
    static const double scatter[] = {1, 1.1, 0.95, 1.02};
    return (0.01 + 0.001 * m) * pow(spacing_of(l, r), 1 + 0.1 * f + 0.01 * m) * scatter[r] *
           (1 + 0.01 * (double)(l % 2));
}

static json_t *norms(int f, size_t l, size_t r)
{
    json_t *object = json_object();
    for (int m = 0; m < NORMS; m++)
        json_object_set_new(object, field_norm_family.members[m]->name,
                            json_real(error_at(f, m, l, r)));
    return object;
}

static double functional_at(size_t l, size_t r)
{
    return 0.5 + 0.3 * pow(spacing_of(l, 0), 2) * (l == 0 ? 1.25 : 1) + 0.001 * (double)r;
}

static json_t *run_document(const struct study *study, size_t l, size_t r)
{
    const struct problem *problem = problem_of(&study->settings.settings);
    json_t *errors = json_object(), *functionals = json_array();
    for (int f = 0; f < FIELDS; f++)
        json_object_set_new(errors, field_family.members[f]->name, norms(f, l, r));
    json_object_set_new(errors, "binned_density_l1", json_real(error_at(7, 0, l, r)));
    if (problem->circular == CIRCULAR_ROUND) {
        json_object_set_new(errors, "azimuthal", norms(4, l, r));
        json_object_set_new(errors, "radial", norms(5, l, r));
    }
    for (int i = 0; problem->functionals[i]; i++)
        json_array_append_new(functionals,
                              json_pack("{s:s, s:f, s:o}", "name", problem->functionals[i]->name,
                                        "value", functional_at(l, r) + i, "reference",
                                        i == 2 ? json_null() : json_real(0.5 + i)));
    json_t *budget = json_null();
    if (problem->regions) {
        budget = json_pack("{s:f}", "still", 1e-6 * (double)(l + 1));
        for (int k = 0; problem->regions->names[k]; k++) {
            json_t *fields = json_object();
            for (int f = 0; f < FIELDS; f++)
                json_object_set_new(
                    fields, field_family.members[f]->name,
                    json_real(k == 1 && l == 2 ? 0 : (k + 1) * error_at(f, 0, l, r)));
            json_object_set_new(budget, problem->regions->names[k], fields);
        }
    }
    static const int away[] = {0, 4, -4, 2};
    return json_pack(
        "{s:I, s:f, s:f, s:o, s:{s:f}, s:o, s:o, s:s}", "n", (json_int_t)ladder[l] + away[r],
        "spacing", spacing_of(l, r), "h", 3 * spacing_of(l, r), "errors", errors, "cost", "cpu_s",
        10. * (double)l + (double)r, "budget", budget, "functionals", functionals, "suspicion", "");
}

typedef void tamper(json_t *run, size_t c, size_t l, size_t r);

/* A study of a case whose runs say what is written above. */
static enum status make(struct study *study, struct pool *pool, const char *name, const char *vary,
                        size_t replicates, tamper *tampering, struct error *error)
{
    *study = (struct study){.level_count = LEVELS, .replicates = replicates};
    memcpy(study->ladder, ladder, sizeof ladder);
    if (run_prepare(&study->settings, name, 0, NULL, error) ||
        sweep_parse(&study->sweep, vary, error))
        fail_msg("%s", error->message);
    study->settings.file.ladder_count = 0; /* bounds are those of the gates */
    const size_t runs = study->sweep.count * LEVELS * replicates;
    study->results = calloc(study->sweep.count, sizeof *study->results);
    study->runs = calloc(runs, sizeof *study->runs);
    study->jobs = calloc(runs, sizeof *study->jobs);
    *pool = (struct pool){.jobs = calloc(runs, sizeof *pool->jobs), .count = runs};
    for (size_t c = 0; c < study->sweep.count; c++) {
        struct run_settings settings = study->settings;
        struct run run;
        assert_int_equal(sweep_apply(&study->sweep, c, &settings, error), STATUS_OK);
        study->results[c].excluded = run_resolve(&run, &settings, error);
        if (study->results[c].excluded) continue;
        study->results[c].settings = run.settings;
        study->results[c].scheme = run.scheme;
        for (size_t l = 0; l < LEVELS; l++)
            for (size_t r = 0; r < replicates; r++) {
                const size_t k = (c * LEVELS + l) * replicates + r, job = runs - 1 - k;
                study->jobs[k] = job; /* in any order */
                pool->jobs[job] = (struct pool_job){
                    .name = strdup("run"), .done = true, .document = run_document(study, l, r)};
                if (tampering) tampering(pool->jobs[job].document, c, l, r);
            }
    }
    *error = (struct error){0};
    return study_judge(study, pool, error);
}

static struct study made(const char *name, const char *vary, size_t replicates, tamper *tampering)
{
    struct study study;
    struct pool pool;
    struct error error;
    if (make(&study, &pool, name, vary, replicates, tampering, &error))
        fail_msg("%s", error.message);
    pool_free(&pool);
    return study;
}

static double mean_log(int f, int m, size_t l, size_t replicates)
{
    double sum = 0;
    for (size_t r = 0; r < replicates; r++) sum += log(error_at(f, m, l, r));
    return sum / (double)replicates;
}

static double mean_log_spacing(size_t l, size_t replicates)
{
    double sum = 0;
    for (size_t r = 0; r < replicates; r++) sum += log(spacing_of(l, r));
    return sum / (double)replicates;
}

/* Geometric means of errors and spacings, arithmetic ones of the rest, the range of n, and the
 * scatter about a line of the ladder's slope; orders are fitted to these. */
static void levels_are_means(void **state)
{
    (void)state;
    for (size_t replicates = 1; replicates <= 4; replicates++) {
        struct study study = made("sod", NULL, replicates, NULL);
        const struct study_result *result = &study.results[0];
        double spacing[LEVELS], errors[LEVELS], variance[LEVELS];
        const double n = (double)replicates;
        assert_int_equal(result->level_count, LEVELS);
        for (size_t l = 0; l < LEVELS; l++) {
            const struct study_level *level = &result->levels[l];
            assert_int_equal(level->n, ladder[l]);
            assert_int_equal(level->n_range[0], ladder[l] - (replicates > 2 ? 4 : 0));
            assert_int_equal(level->n_range[1], ladder[l] + (replicates > 1 ? 4 : 0));
            spacing[l] = exp(mean_log_spacing(l, replicates));
            near_relative(level->spacing, spacing[l], 1e-14);
            near_relative(level->h, 3 * spacing_of(l, 0) * (1 + 0.01 * (n - 1)), 1e-14);
            near_absolute(level->cpu_s + 1, 1 + 10. * (double)l + 0.5 * (n - 1), 1e-13);
            near_relative(level->binned_density_l1, exp(mean_log(7, 0, l, replicates)), 1e-14);
            if (replicates == 1) assert_true(level->spacing == spacing_of(l, 0));
            assert_true(isnan(level->parts[0][0]) && isnan(level->parts[1][0]));
            for (int f = 0; f < FIELDS; f++)
                for (int m = 0; m < NORMS; m++)
                    near_relative(level->errors[f][m], exp(mean_log(f, m, l, replicates)), 1e-13);
            for (size_t i = 0; i < 3; i++)
                near_relative(level->functionals[i],
                              functional_at(l, 0) + (double)i + 0.0005 * (n - 1), 1e-13);
            for (size_t k = 0; level->budget.regions->names[k]; k++)
                for (int f = 0; f < FIELDS; f++) {
                    double sum = 0;
                    for (size_t r = 0; r < replicates; r++) sum += error_at(f, 0, l, r) / n;
                    near_absolute(level->budget.l1[k][f] * 1e6 + 1,
                                  1 + 1e6 * (k == 1 && l == 2 ? 0 : (double)(k + 1) * sum), 1e-8);
                }
        }
        for (int f = 0; f < FIELDS; f++)
            for (int m = 0; m < NORMS; m++) {
                const double slope =
                    (mean_log(f, m, 0, replicates) - mean_log(f, m, 3, replicates)) /
                    (mean_log_spacing(0, replicates) - mean_log_spacing(3, replicates));
                for (size_t l = 0; l < LEVELS; l++) {
                    double squares = 0;
                    errors[l] = exp(mean_log(f, m, l, replicates));
                    for (size_t r = 0; r < replicates; r++)
                        squares += pow(
                            log(error_at(f, m, l, r)) - mean_log(f, m, l, replicates) -
                                slope * (log(spacing_of(l, r)) - mean_log_spacing(l, replicates)),
                            2);
                    const double spread = replicates > 1 ? sqrt(squares / (n - 1)) : 0;
                    if (replicates > 1)
                        near_relative(result->levels[l].spread[f][m], spread, 1e-9);
                    else
                        assert_true(result->levels[l].spread[f][m] == 0);
                    variance[l] = spread * spread / n;
                }
                const struct order_noise noise = {variance, replicates};
                struct order_fit want;
                assert_int_equal(
                    order_fit(LEVELS, spacing, errors, replicates > 1 ? &noise : NULL, &want, NULL),
                    STATUS_OK);
                const struct order_fit *fit = &result->orders[f][m].fit;
                near_relative(fit->order, want.order, 1e-9);
                near_relative(fit->high - fit->low, want.high - want.low, 1e-6);
            }
        /* a region that is nowhere at one level has no order */
        assert_true(result->regions[0].n == LEVELS && result->regions[1].n == 0 &&
                    result->regions[2].n == LEVELS);
        for (size_t l = 0; l < LEVELS; l++)
            errors[l] = result->levels[l].budget.l1[2][FIELD_DENSITY];
        struct order_fit want;
        assert_int_equal(order_fit(LEVELS, spacing, errors, NULL, &want, NULL), STATUS_OK);
        near_relative(result->regions[2].order, want.order, 1e-12);
        near_relative(result->regions[2].finest, errors[3], 1e-12);
        double floor_density, floor_gradient;
        measure_lattice(&result->scheme.kernel, 1, result->scheme.eta, &floor_density,
                        &floor_gradient);
        assert_true(result->floor_density == floor_density &&
                    result->floor_gradient == floor_gradient);
        near_relative(result->still, 4e-6, 1e-15);
        assert_int_equal(result->still_status, GATE_PASS);
        assert_int_equal(result->functional_count, 4);
        assert_true(isnan(result->functional_exact[2]) && result->functional_exact[1] == 1.5);
        assert_string_equal(result->functional_names[0], "mean_internal_energy");
        for (size_t i = 0; i < 2 && replicates == 1;
             i++) { /* of the three finest: they fall with the square */
            const struct order_extrapolation *e = &result->functionals[i];
            near_relative(e->order, 2, 1e-6);
            near_relative(e->value, 0.5 + (double)i, 1e-9);
        }
        study_free(&study);
    }
}

/* Of a circular flow in 2D: orders of the parts, and of functionals that are known. */
static void clouds_have_more_orders(void **state)
{
    (void)state;
    for (size_t replicates = 1; replicates <= 2; replicates++) {
        struct study study = made("gresho", NULL, replicates, NULL);
        const struct study_result *result = &study.results[0];
        double spacing[LEVELS], errors[LEVELS];
        struct order_fit want;
        for (int part = 0; part < STUDY_PARTS; part++) {
            for (size_t l = 0; l < LEVELS; l++) {
                spacing[l] = exp(mean_log_spacing(l, replicates));
                errors[l] = exp(mean_log(4 + part, NORM_L1_CUT, l, replicates));
                for (int m = 0; m < NORMS; m++)
                    near_relative(result->levels[l].parts[part][m],
                                  exp(mean_log(4 + part, m, l, replicates)), 1e-13);
            }
            assert_int_equal(order_fit(LEVELS, spacing, errors, NULL, &want, NULL), STATUS_OK);
            near_relative(result->parts[part].order, want.order, 1e-12);
            near_relative(result->parts[part].finest, errors[3], 1e-12);
        }
        for (size_t i = 0; i < 2; i++) {
            for (size_t l = 0; l < LEVELS; l++)
                errors[l] = functional_at(l, 0) - 0.5 + 0.0005 * (double)(replicates - 1);
            assert_int_equal(order_fit(LEVELS, spacing, errors, NULL, &want, NULL), STATUS_OK);
            near_relative(result->functional_errors[i].fit.order, want.order, 1e-9);
            near_relative(result->functional_errors[i].fit.coarsest, errors[0], 1e-9);
        }
        assert_true(isnan(result->still) && result->still_status == GATE_NONE);
        study_free(&study);
    }
    struct study line = made("sod", NULL, 1, NULL);
    assert_true(line.results[0].functional_errors[0].fit.n == 0 && line.results[0].parts[0].n == 0);
    study_free(&line);
}

/* ---- the document ---- */

static json_t *pack_norms(const double values[NORMS])
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o}", "l1", result_number(values[0]), "l2",
                     result_number(values[1]), "linf", result_number(values[2]), "particle_mean",
                     result_number(values[3]), "l1_cut", result_number(values[4]));
}

static json_t *pack_fields(const double values[FIELDS][NORMS])
{
    return json_pack("{s:o, s:o, s:o, s:o}", "density", pack_norms(values[0]), "velocity",
                     pack_norms(values[1]), "pressure", pack_norms(values[2]), "internal_energy",
                     pack_norms(values[3]));
}

static json_t *pack_level(const struct study *study, const struct study_level *level)
{
    json_t *errors = pack_fields(level->errors);
    const bool line = study->settings.file.dimension == 1;
    if (!line) {
        json_object_set_new(errors, "azimuthal", pack_norms(level->parts[0]));
        json_object_set_new(errors, "radial", pack_norms(level->parts[1]));
    }
    json_object_set_new(errors, "binned_density_l1",
                        line ? result_number(level->binned_density_l1) : json_null());
    json_t *packed =
        json_pack("{s:I, s:o, s:o, s:o, s:o, s:o, s:I}", "n", (json_int_t)level->n, "h",
                  result_number(level->h), "spacing", result_number(level->spacing), "errors",
                  errors, "cpu_s", result_number(level->cpu_s), "budget",
                  budget_json(&level->budget), "replicates", (json_int_t)study->replicates);
    if (study->replicates > 1) {
        json_object_set_new(packed, "spread", pack_fields(level->spread));
        json_object_set_new(
            packed, "n_range",
            json_pack("[I, I]", (json_int_t)level->n_range[0], (json_int_t)level->n_range[1]));
    }
    return packed;
}

static json_t *pack_order(const struct order_fit *fit, const char *what, const char *norm,
                          const struct study_order *judged)
{
    static const char *const words[] = {"none", "pass", "fail", "known"};
    const enum study_gate status = judged ? judged->status : GATE_NONE;
    json_t *packed =
        json_pack("{s:s, s:s, s:o, s:o, s:o, s:[o, o, o], s:s, s:s}", "field", what, "norm", norm,
                  "order", result_number(fit->order), "low", result_number(fit->low), "high",
                  result_number(fit->high), "pairwise", result_number(fit->pairwise[0]),
                  result_number(fit->pairwise[1]), result_number(fit->pairwise[2]), "class",
                  order_class_name(fit->class), "status", words[status]);
    json_object_set_new(packed, "gate",
                        status == GATE_NONE
                            ? json_null()
                            : json_pack("{s:o, s:o, s:o}", "low", result_number(judged->gate.low),
                                        "high", result_number(judged->gate.high), "bound",
                                        result_number(judged->gate.bound)));
    if (status == GATE_FAIL || status == GATE_KNOWN)
        json_object_set_new(packed, "why", json_string(judged->why));
    if (status == GATE_KNOWN) json_object_set_new(packed, "known", json_string(judged->known));
    return packed;
}

static json_t *pack_budget(const struct study_result *result)
{
    const struct study_level *finest = &result->levels[LEVELS - 1];
    static const char *const words[] = {"none", "pass", "fail", "known"};
    json_t *regions = json_array();
    double whole = 0;
    for (size_t k = 0; finest->budget.regions->names[k]; k++) whole += finest->budget.l1[k][0];
    for (size_t k = 0; finest->budget.regions->names[k]; k++) {
        json_t *region = json_pack("{s:s, s:o, s:o}", "region", finest->budget.regions->names[k],
                                   "l1", result_number(finest->budget.l1[k][0]), "share",
                                   result_number(finest->budget.l1[k][0] / whole));
        if (k != 1) { /* it is empty at one level */
            json_object_set_new(region, "order", result_number(result->regions[k].order));
            json_object_set_new(region, "low", result_number(result->regions[k].low));
            json_object_set_new(region, "high", result_number(result->regions[k].high));
        }
        json_array_append_new(regions, region);
    }
    return json_pack("{s:o, s:{s:o, s:f, s:s}}", "regions", regions, "still_gas", "value",
                     isnan(result->still) ? json_null() : result_number(result->still), "bound",
                     1e-3, "status", words[result->still_status]);
}

/* Takes the expected one. */
static void same(const json_t *list, size_t i, json_t *expected)
{
    const json_t *item = json_array_get(list, i);
    if (!json_equal(item, expected))
        fail_msg("%zu: %s\n  is not %s", i, json_dumps(item, JSON_SORT_KEYS | JSON_COMPACT),
                 json_dumps(expected, JSON_SORT_KEYS | JSON_COMPACT));
    json_decref(expected);
}

static void documents_have_it_all(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        const size_t replicates = k == 1 ? 1 : k ? 2 : 3;
        struct study study = made(k == 1 ? "gresho" : "sod", NULL, replicates, NULL);
        struct study_result *result = &study.results[0];
        json_t *document = json_object();
        for (int m = 0; m < 4; m++) { /* one gate of each outcome */
            struct study_order *of = &result->orders[0][m];
            of->status = (enum study_gate)m;
            of->gate = (struct order_gate){0.5 + m, 1.5 + m, 2.5 + m};
            strcpy(of->why, "too low");
            of->known = "it jumps";
        }
        result->functional_errors[0].status = GATE_FAIL;
        result->still_status = (enum study_gate)k;
        if (k == 2) result->still = (double)NAN;
        if (k == 2) strcpy(study.suspicion, "alpha changes nothing");
        study_add_json(&study, document);
        assert_int_equal(json_integer_value(json_object_get(document, "dimension")),
                         k == 1 ? 2 : 1);
        const json_t *levels = json_object_get(document, "levels"),
                     *orders = json_object_get(document, "orders"),
                     *functionals = json_object_get(document, "functionals"),
                     *budgets = json_object_get(document, "budgets");
        assert_int_equal(json_array_size(levels), LEVELS);
        for (size_t l = 0; l < LEVELS; l++) same(levels, l, pack_level(&study, &result->levels[l]));
        size_t n = 0;
        for (int f = 0; f < FIELDS; f++)
            for (int m = 0; m < NORMS; m++)
                same(orders, n++,
                     pack_order(&result->orders[f][m].fit, field_family.members[f]->name,
                                field_norm_family.members[m]->name, &result->orders[f][m]));
        if (k == 1) {
            for (int part = 0; part < 2; part++)
                same(orders, n++,
                     pack_order(&result->parts[part], part ? "radial" : "azimuthal", "l1_cut",
                                NULL));
            for (size_t i = 0; i < 2; i++)
                same(orders, n++,
                     pack_order(&result->functional_errors[i].fit, result->functional_names[i],
                                "error", &result->functional_errors[i]));
        }
        assert_int_equal(json_array_size(orders), n);
        assert_int_equal(json_array_size(functionals), k == 1 ? 2 : 4);
        for (size_t i = 0; i < result->functional_count; i++) {
            const struct order_extrapolation *e = &result->functionals[i];
            json_t *values = json_array();
            for (size_t l = 0; l < LEVELS; l++)
                json_array_append_new(values, result_number(result->levels[l].functionals[i]));
            same(functionals, i,
                 json_pack("{s:s, s:o, s:o, s:o, s:o, s:o, s:s, s:o}", "name",
                           result->functional_names[i], "values", values, "extrapolated",
                           result_number(e->value), "gci", result_number(e->gci_fine), "gci_coarse",
                           result_number(e->gci_coarse), "order", result_number(e->order), "class",
                           order_class_name(e->class), "exact",
                           result_number(result->functional_exact[i])));
        }
        same(json_object_get(document, "floors"), 0,
             json_pack("{s:s, s:o, s:o, s:o, s:b, s:s}", "kernel",
                       result->scheme.kernel.member.name, "eta", result_number(result->scheme.eta),
                       "density", result_number(result->floor_density), "gradient",
                       result_number(result->floor_gradient), "explains", result->floor_explains,
                       "suspicion", ""));
        if (k == 1)
            assert_null(budgets);
        else
            same(budgets, 0, pack_budget(result));
        assert_int_equal(json_array_size(json_object_get(document, "excluded")), 0);
        assert_null(json_object_get(document, "message"));
        const json_t *measured = json_object_get(document, "measured");
        const char *names[JUDGED_MAX];
        const size_t count =
            judged_names(&study.settings.file, result->functional_count, result->functional_names,
                         result->functional_exact, names);
        assert_int_equal(json_array_size(measured), count);
        for (size_t i = 0; i < count; i++)
            assert_string_equal(json_string_value(json_array_get(measured, i)), names[i]);
        assert_true(json_is_array(json_object_get(document, "excluded")));
        assert_true(!json_object_get(document, "suspicion") == (k < 2));
        json_decref(document);
        study_free(&study);
        assert_null(study.results);
    }
}

/* ---- what goes wrong ---- */

static void first_combination_stops(json_t *run, size_t c, size_t l, size_t r)
{
    (void)r;
    if (c == 0 && l == 2) json_object_set_new(run, "suspicion", json_string("odd"));
    if (c == 1 && l == 1) json_object_set_new(run, "suspicion", json_string("odd, too"));
    if (c == 1 && l == 2) json_object_set_new(run, "suspicion", json_string("odder"));
}

/* Each combination with its own settings; of suspicions the first one counts. */
static void combinations_are_told_apart(void **state)
{
    (void)state;
    struct study study = made("sod", "eta=1.5,2", 1, first_combination_stops);
    json_t *document = json_object();
    assert_string_equal(study.results[0].suspicion, "odd");
    assert_string_equal(study.results[1].suspicion, "odd, too");
    assert_int_equal(study.status, STATUS_CHECK_FAILED);
    study.results[0].excluded = true;
    strcpy(study.results[0].message, "not so");
    study.results[1].status = STATUS_BROKE_DOWN;
    study.results[1].level_count = 2;
    strcpy(study.results[1].message, "n = 160: broken");
    study_add_json(&study, document);
    same(json_object_get(document, "excluded"), 0,
         json_pack("{s:s, s:{s:s}}", "reason", "not so", "settings", "eta", "1.5"));
    const json_t *levels = json_object_get(document, "levels"), *level;
    size_t i;
    assert_int_equal(json_array_size(levels), 2);
    json_array_foreach(levels, i, level) assert_string_equal(
        json_string_value(json_object_get(json_object_get(level, "settings"), "eta")), "2");
    assert_int_equal(json_array_size(json_object_get(document, "orders")), 0);
    assert_int_equal(json_array_size(json_object_get(document, "floors")), 0);
    assert_null(json_object_get(document, "budgets"));
    assert_string_equal(json_string_value(json_object_get(document, "message")), "n = 160: broken");
    json_decref(document);
    study.results[1].level_count = 0; /* all lists are there all the same */
    document = json_object();
    study_add_json(&study, document);
    static const char *const lists[] = {"levels", "orders", "functionals", "floors", "excluded"};
    for (size_t k = 0; k < 5; k++) assert_true(json_is_array(json_object_get(document, lists[k])));
    json_decref(document);
    study_free(&study);
}

static void broken_and_missing_runs(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        struct study study;
        struct pool pool;
        struct error error;
        assert_int_equal(make(&study, &pool, "sod", NULL, 1, NULL, &error), STATUS_OK);
        struct pool_job *job = &pool.jobs[1]; /* of the level before the finest */
        memset(&study.results[0].levels, 0, sizeof study.results[0].levels);
        study.results[0].level_count = 0;
        study.results[0].status = study.status = STATUS_OK;
        if (kind < 2)
            error_set(&job->error, kind ? STATUS_ENVIRONMENT : STATUS_BROKE_DOWN, "no good");
        else {
            json_decref(job->document);
            job->document = NULL;
        }
        error = (struct error){0};
        const enum status status = study_judge(&study, &pool, &error);
        assert_int_equal(status, kind ? STATUS_ENVIRONMENT : STATUS_OK);
        if (kind == 1) assert_string_equal(error.message, "no good");
        if (!kind) {
            assert_int_equal(study.status, STATUS_BROKE_DOWN);
            assert_string_equal(study.results[0].message, "n = 160: no good");
            assert_int_equal(study.results[0].level_count, 2);
        }
        study_free(&study);
        pool_free(&pool);
    }
}

/* ---- gates ---- */

static double factor;

static void times_factor(json_t *run, size_t c, size_t l, size_t r)
{
    json_t *norms_of = json_object_get(json_object_get(run, "errors"), "density");
    (void)c;
    json_object_set_new(norms_of, "l1", json_real(factor * pow(spacing_of(l, r), 0.5)));
}

/* A field's gate on order and error; one of the finest error alone; what lattice sums explain. */
static void gates_are_judged(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        struct case_gate gate; /* a bound of 0: the finest error itself */
        double factor;
        size_t coarse; /* the case's own finest n */
        enum study_gate outcome;
        double bound;
        bool explains;
    } rows[] = {
        {"sod",
         {NULL, FIELD_DENSITY, NORM_L1, {0.4, 0.6, 1}, {0, ""}, {0, ""}},
         0.01,
         0,
         GATE_PASS,
         1,
         false},
        {"sod",
         {NULL, FIELD_DENSITY, NORM_L1, {0.6, 0.8, 1}, {0, ""}, {0, ""}},
         0.01,
         0,
         GATE_FAIL,
         1,
         false},
        {"sod",
         {NULL, FIELD_DENSITY, NORM_L1, {0.6, 0.8, 1}, {(double)INFINITY, "why"}, {0, ""}},
         0.01,
         0,
         GATE_KNOWN,
         1,
         false},
        {"sod",
         {NULL, FIELD_DENSITY, NORM_L1, {0.4, 0.6, 7e-4}, {0, ""}, {0, ""}},
         0.01,
         0,
         GATE_FAIL,
         7e-4,
         false},
        {"sod",
         {NULL, FIELD_DENSITY, NORM_L1, {0.4, 0.6, 7e-4}, {0, ""}, {0, ""}},
         0.01,
         640,
         GATE_PASS,
         7e-4 * 1.3195079107728942,
         false},
        {"sod",
         {NULL, FIELD_DENSITY, NORM_L1, {0.4, 0.6, 7e-4}, {0, ""}, {0, ""}},
         0.01,
         160,
         GATE_FAIL,
         7e-4,
         false},
        {"sod",
         {NULL, FIELD_DENSITY, NORM_L1, {1, (double)INFINITY, 8e-4}, {0, ""}, {0, ""}},
         0.01,
         0,
         GATE_PASS,
         8e-4,
         false},
        {"sod",
         {NULL, FIELD_DENSITY, NORM_L1, {1, (double)INFINITY, 0}, {0, ""}, {0, ""}},
         0.01,
         0,
         GATE_PASS,
         0,
         false},
        {"sod",
         {"mean_pressure", FIELD_DENSITY, NORM_L1, {1, (double)INFINITY, 1}, {0, ""}, {0, ""}},
         0.01,
         0,
         GATE_NONE,
         0,
         false},
        {"gresho",
         {NULL, FIELD_DENSITY, NORM_L1, {1, (double)INFINITY, 1e-12}, {0, ""}, {0, ""}},
         1e-9,
         0,
         GATE_FAIL,
         1e-12,
         false},
        {"gresho",
         {NULL, FIELD_DENSITY, NORM_L1, {0.4, 0.6, 1e-12}, {0, ""}, {0, ""}},
         1e-9,
         0,
         GATE_FAIL,
         1e-12,
         false},
        {"gresho",
         {"disc_error", FIELD_DENSITY, NORM_L1, {1, (double)INFINITY, 1.2e-5}, {0, ""}, {0, ""}},
         0.01,
         0,
         GATE_PASS,
         1.2e-5,
         false},
        {"gresho",
         {"disc_error", FIELD_DENSITY, NORM_L1, {1, (double)INFINITY, 1.1e-5}, {0, ""}, {0, ""}},
         0.01,
         0,
         GATE_FAIL,
         1.1e-5,
         false},
        {"sod",
         {NULL, FIELD_DENSITY, NORM_L1, {1, (double)INFINITY, 7.9e-4}, {0, ""}, {0, ""}},
         0.01,
         0,
         GATE_FAIL,
         7.9e-4,
         false},
        {"gresho",
         {NULL, FIELD_DENSITY, NORM_L1, {0.4, 0.6, 7e-4}, {0, ""}, {0, ""}},
         0.01,
         640,
         GATE_PASS,
         7e-4 * 1.1486983549970351,
         false},
        {"gresho",
         {NULL, FIELD_DENSITY, NORM_L1, {0.6, 0.8, 1}, {0, ""}, {0, ""}},
         1e-9,
         0,
         GATE_FAIL,
         1,
         true},
        {"gresho",
         {"peak_velocity", FIELD_DENSITY, NORM_L1, {1, (double)INFINITY, 1.2e-5}, {0, ""}, {0, ""}},
         0.01,
         0,
         GATE_PASS,
         1.2e-5,
         false},
        {"gresho",
         {"peak_velocity", FIELD_DENSITY, NORM_L1, {1, (double)INFINITY, 1.1e-5}, {0, ""}, {0, ""}},
         0.01,
         0,
         GATE_FAIL,
         1.1e-5,
         false},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct study study;
        struct pool pool;
        struct error error;
        factor = rows[k].factor;
        make(&study, &pool, rows[k].name, NULL, 1, times_factor, &error);
        struct study_result *result = &study.results[0];
        struct case_file *file = &study.settings.file;
        const struct settings settings = result->settings;
        const struct scheme scheme = result->scheme;
        *result = (struct study_result){.settings = settings, .scheme = scheme};
        study.status = STATUS_OK;
        file->gates[0] = rows[k].gate;
        const double finest = factor * pow(spacing_of(3, 0), 0.5);
        if (rows[k].gate.gate.bound == 0) file->gates[0].gate.bound = finest;
        file->gates[1] = (struct case_gate){
            NULL, FIELD_VELOCITY, NORM_L2, {.low = -9, .high = 9, .bound = 1e9}, {0, ""}, {0, ""}};
        file->gate_count = 2;
        file->ladder[0] = 5, file->ladder[1] = rows[k].coarse;
        file->ladder_count = rows[k].coarse ? 2 : 0;
        assert_int_equal(study_judge(&study, &pool, &error), STATUS_OK);
        const char *functional = rows[k].gate.functional;
        const struct study_order *order =
            functional ? &result->functional_errors[strcmp(functional, "disc_error") != 0]
                       : &result->orders[0][0];
        if (order->status != rows[k].outcome)
            fail_msg("row %zu: outcome %d, %s, bound %g, finest %g", k, order->status, order->why,
                     order->gate.bound, order->fit.finest);
        assert_int_equal(result->orders[FIELD_VELOCITY][NORM_L2].status, GATE_PASS);
        if (rows[k].outcome == GATE_NONE) {
            study_free(&study);
            pool_free(&pool);
            continue;
        }
        near_relative(order->gate.bound, rows[k].bound > 0 ? rows[k].bound : finest, 1e-9);
        assert_true(!isfinite(rows[k].gate.gate.high) == !(order->gate.low > -1e300));
        assert_string_equal(order->known, rows[k].gate.known.why);
        assert_true(result->floor_explains == rows[k].explains);
        assert_int_equal(result->status,
                         rows[k].outcome == GATE_FAIL ? STATUS_CHECK_FAILED : STATUS_OK);
        assert_int_equal(study.status, result->status);
        assert_true(!order->why[0] == (rows[k].outcome == GATE_PASS));
        study_free(&study);
        pool_free(&pool);
    }
}

static double exact_errors[LEVELS];

static void set_errors(json_t *run, size_t c, size_t l, size_t r)
{
    (void)c, (void)r;
    json_object_set_new(json_object_get(json_object_get(run, "errors"), "density"), "l1",
                        json_real(exact_errors[l]));
}

/* An order that is missed is explained up to twenty floors: of the density, with the standard
 * gradient also of that. */
static void floors_explain_up_to_a_point(void **state)
{
    (void)state;
    for (int standard = 0; standard < 2; standard++)
        for (int side = -1; side <= 2; side++) {
            const char *keys = standard ? "kernel=cubic_spline,eta=4.8,gradient=standard"
                                        : "kernel=cubic_spline,eta=4.8,gradient=ia";
            struct study study;
            struct pool pool;
            struct error error;
            struct kernel kernel;
            double density, gradient;
            assert_int_equal(kernel_select(&kernel, "cubic_spline", 0, &error), STATUS_OK);
            measure_lattice(&kernel, 1, 4.8, &density, &gradient);
            assert_true(fabs(gradient) > 2 * fabs(density));
            const double most = 20 * fabs(standard ? gradient : density);
            /* side 2: an order that is met by its last bit, and an error that is too large */
            for (size_t l = 0; l < LEVELS; l++)
                exact_errors[l] = most * (1 + 1e-9 * (side % 2)) * pow(2, 0.5 * (double)(3 - l));
            make(&study, &pool, "sod", keys, 1, set_errors, &error);
            struct study_result *result = &study.results[0];
            const double order = result->orders[0][0].fit.order;
            const struct settings settings = result->settings;
            const struct scheme scheme = result->scheme;
            *result = (struct study_result){.settings = settings, .scheme = scheme};
            study.settings.file.gates[0] =
                (struct case_gate){NULL, FIELD_DENSITY, NORM_L1, {0.6, 0.7, 1}, {0, ""}, {0, ""}};
            if (side == 2)
                study.settings.file.gates[0].gate =
                    (struct order_gate){order, order + 0.1, exact_errors[3] / 2};
            study.settings.file.gate_count = 1;
            assert_int_equal(study_judge(&study, &pool, &error), STATUS_OK);
            assert_int_equal(result->orders[0][0].status, GATE_FAIL);
            assert_true(result->floor_explains == (side < 1));
            study_free(&study);
            pool_free(&pool);
        }
}

/* ---- still gas, and errors that are too good ---- */

static double still_of[LEVELS];
static int fault_field, fault_kind;

static void set_still(json_t *run, size_t c, size_t l, size_t r)
{
    (void)c, (void)r;
    json_object_set_new(json_object_get(run, "budget"), "still", json_real(still_of[l]));
}

static void gas_that_does_not_stay(void **state)
{
    (void)state;
    static const struct {
        double still[LEVELS], most;
        enum study_gate outcome;
    } rows[] = {{{5e-4, 1e-6, 1e-6, 1e-6}, 5e-4, GATE_PASS},
                {{1e-6, 1e-6, 1e-6, 1e-3}, 1e-3, GATE_PASS},
                {{1e-6, 1.0000001e-3, 0, 0}, 1.0000001e-3, GATE_FAIL}};
    for (size_t k = 0; k < 3; k++) {
        memcpy(still_of, rows[k].still, sizeof still_of);
        struct study study = made("sod", "jitter=0", 1, set_still);
        study_free(&study);
        study = made("sod", NULL, 1, set_still);
        assert_true(study.results[0].still == rows[k].most);
        assert_int_equal(study.results[0].still_status, rows[k].outcome);
        if (rows[k].outcome == GATE_FAIL)
            assert_int_equal(study.results[0].status, STATUS_CHECK_FAILED);
        study_free(&study);
        study = made("sod", "jitter=0.1", 1, set_still); /* noise that was put there */
        assert_int_equal(study.results[0].still_status, GATE_NONE);
        study_free(&study);
    }
}

static void too_good(json_t *run, size_t c, size_t l, size_t r)
{
    json_t *errors = json_object_get(run, "errors");
    (void)c, (void)r;
    for (int f = fault_field; f < FIELDS; f++) {
        json_t *of = json_object_get(errors, field_family.members[f]->name);
        if (fault_kind == 0 && l == 3) json_object_set_new(of, "l1", json_real(0));
        if (fault_kind == 1 && l % 3 == 0) json_object_set_new(of, "l1", json_real(0.125));
    }
}

static void errors_that_are_too_good(void **state)
{
    (void)state;
    static const char *const words[] = {"%s: the error at level 3", "%s: levels 0 and 3"};
    for (fault_kind = 0; fault_kind < 2; fault_kind++)
        for (fault_field = 0; fault_field < FIELDS; fault_field++) {
            char text[80];
            struct study study = made("sod", NULL, 1, too_good);
            struct study_result *result = &study.results[0];
            snprintf(text, sizeof text, words[fault_kind], field_family.members[fault_field]->name);
            if (strncmp(result->suspicion, text, strlen(text)) != 0)
                fail_msg("'%s', not '%s'", result->suspicion, text);
            assert_int_equal(result->status, STATUS_CHECK_FAILED);
            study_free(&study);
            /* where it is exact it is no wonder */
            struct pool pool;
            struct error error;
            make(&study, &pool, "sod", NULL, 1, too_good, &error);
            result = &study.results[0];
            const struct settings settings = result->settings;
            const struct scheme scheme = result->scheme;
            *result = (struct study_result){.settings = settings, .scheme = scheme};
            for (int f = fault_field; f < FIELDS; f++) study.settings.file.exact[f] = true;
            assert_int_equal(study_judge(&study, &pool, &error), STATUS_OK);
            assert_string_equal(result->suspicion, "");
            study_free(&study);
            pool_free(&pool);
            study = made("kelvin_helmholtz_mode", NULL, 1, too_good); /* no errors of fields */
            assert_string_equal(study.results[0].suspicion, "");
            study_free(&study);
        }
}

static double one_error(size_t l, int f)
{
    return 1 + (double)l + 10 * f;
}

/* Alike are results whose errors are at all levels that both have. */
static void same_at_all_levels(void **state)
{
    (void)state;
    static struct study_result a, b;
    char why[SUSPICION_TEXT];
    a.level_count = 3;
    b.level_count = 2;
    for (size_t l = 0; l < 3; l++)
        for (int f = 0; f < FIELDS; f++)
            a.levels[l].errors[f][NORM_L1] = b.levels[l].errors[f][NORM_L1] = one_error(l, f);
    b.levels[2].errors[0][0] = 77;
    assert_true(study_suspect_same("eta", &a, &b, why));
    assert_non_null(strstr(why, "eta"));
    assert_true(study_suspect_same("eta", &b, &a, why));
    for (size_t l = 0; l < 2; l++)
        for (int f = 0; f < FIELDS; f++) {
            b.levels[l].errors[f][NORM_L1] *= 1 + 1e-15;
            assert_false(study_suspect_same("eta", &a, &b, why));
            b.levels[l].errors[f][NORM_L1] = one_error(l, f);
        }
    b.level_count = 0;
    assert_false(study_suspect_same("eta", &a, &b, why));
}

/* ---- settings without effect ---- */

static void last_differs(json_t *run, size_t c, size_t l, size_t r)
{
    (void)r;
    if (c == 2)
        json_object_set_new(json_object_get(json_object_get(run, "errors"), "density"), "l1",
                            json_real(2 * error_at(0, 0, l, r)));
}

static void differ_by_eta(json_t *run, size_t c, size_t l, size_t r)
{
    json_t *of = json_object_get(json_object_get(run, "errors"), "pressure");
    json_object_set_new(of, "l1",
                        json_real(error_at(2, 0, l, r) * (1 + 0.1 * (double)(c / 2 % 2))));
}

/* Of two keys the one whose pairs are all alike; of one that nobody reads nothing is said. */
static void idle_settings_are_suspected(void **state)
{
    (void)state;
    static const struct {
        const char *vary, *words;
        tamper *tampering;
    } rows[] = {
        {"eta=1.5,2,alpha=0.5,1", "alpha", differ_by_eta},
        {"alpha=0.5,1,eta=1.5,2", "eta", differ_by_eta},
        {"eta=1.5,2", "eta", NULL},
        {"eta=0.5,1.5,2", "eta", NULL}, /* the first one is excluded */
        {"eta=1.5,2,0.5", "eta", NULL},
        {"eta=1.5,2,2.5", NULL, last_differs}, /* not in vain */
        {"skip=auto,none", NULL, NULL},
        {"sinc_n=3,5", NULL, NULL},
        {"alpha_min=0.1,0.2", NULL, NULL},
        {"alpha_max=1,2", NULL, NULL},
        {"viscosity=none,alpha=1,2", NULL, NULL},
        {"viscosity=none,beta=1,2", NULL, NULL},
        {"viscosity=cullen_dehnen,alpha=1,2", NULL, NULL},
        {"viscosity=time_dependent,beta=1,2", NULL, NULL},
        {"viscosity=time_dependent,alpha_min=0.1,0.2", "alpha_min", NULL},
        {"viscosity=cullen_dehnen,alpha_max=1,2", "alpha_max", NULL},
        {"kernel=sinc,sinc_n=3,5", "sinc_n", NULL},
        {"seed=1,2", NULL, NULL},
        {"jitter=0.1,seed=1,2", "seed", NULL},
        {"grade_ratio=1.1,1.2", NULL, NULL},
        {"grade=0.5,grade_ratio=1.1,1.2", "grade_ratio", NULL},
        {"h_tolerance=1e-9,1e-8", NULL, NULL},
        {"h_method=newton,h_tolerance=1e-9,1e-8", "h_tolerance", NULL},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const char *name = strstr(rows[k].vary, "cullen") ? "gresho" : "sod";
        struct study study = made(name, rows[k].vary, 1, rows[k].tampering);
        if (!rows[k].words != !study.suspicion[0] ||
            (rows[k].words && !strstr(study.suspicion, rows[k].words)))
            fail_msg("%s: '%s'", rows[k].vary, study.suspicion);
        assert_int_equal(study.status, rows[k].words ? STATUS_CHECK_FAILED : STATUS_OK);
        study_free(&study);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_are_means),
        cmocka_unit_test(clouds_have_more_orders),
        cmocka_unit_test(documents_have_it_all),
        cmocka_unit_test(combinations_are_told_apart),
        cmocka_unit_test(broken_and_missing_runs),
        cmocka_unit_test(gates_are_judged),
        cmocka_unit_test(floors_explain_up_to_a_point),
        cmocka_unit_test(gas_that_does_not_stay),
        cmocka_unit_test(errors_that_are_too_good),
        cmocka_unit_test(same_at_all_levels),
        cmocka_unit_test(idle_settings_are_suspected),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
