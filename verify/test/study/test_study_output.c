/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests every member of a study's JSON document. */
#include "test.h"

#include "judged.h"
#include "result.h"
#include "sample_study.h"

static json_t *pack_norms(const double values[NORMS])
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o}", "l1", result_number(values[0]), "l2",
                     result_number(values[1]), "linf", result_number(values[2]), "particle_mean",
                     result_number(values[3]), "l1_whole", result_number(values[4]));
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
                  run_budget_json(&level->budget), "replicates", (json_int_t)study->replicates);
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
    static const char *const words[] = {"none", "pass", "fail", "known", "smoke", "undetermined"};
    const enum finding_status status = judged ? judged->status : FINDING_NONE;
    json_t *packed =
        json_pack("{s:s, s:s, s:o, s:o, s:o, s:[o, o, o], s:s, s:s}", "field", what, "norm", norm,
                  "order", result_number(fit->order), "low", result_number(fit->low), "high",
                  result_number(fit->high), "pairwise", result_number(fit->pairwise[0]),
                  result_number(fit->pairwise[1]), result_number(fit->pairwise[2]), "class",
                  order_class_name(fit->class), "status", words[status]);
    json_object_set_new(packed, "gate",
                        status == FINDING_NONE
                            ? json_null()
                            : json_pack("{s:o, s:o, s:o}", "low", result_number(judged->gate.low),
                                        "high", result_number(judged->gate.high), "bound",
                                        result_number(judged->gate.bound)));
    if (status == FINDING_FAIL || status == FINDING_KNOWN)
        json_object_set_new(packed, "why", json_string(judged->why));
    if (status == FINDING_KNOWN) json_object_set_new(packed, "known", json_string(judged->known));
    return packed;
}

static json_t *pack_budget(const struct study_result *result)
{
    const struct study_level *finest = &result->levels[LEVELS - 1];
    static const char *const words[] = {"none", "pass", "fail", "known", "smoke", "undetermined"};
    json_t *regions = json_array();
    double whole = 0;
    for (size_t k = 0; finest->budget.regions->names[k]; k++) whole += finest->budget.l1[k][0];
    for (size_t k = 0; finest->budget.regions->names[k]; k++) {
        json_t *region = json_pack("{s:s, s:o, s:o}", "region", finest->budget.regions->names[k],
                                   "l1", result_number(finest->budget.l1[k][0]), "share",
                                   result_number(finest->budget.l1[k][0] / whole));
        if (k != 1) { /* the region is empty at one level */
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

/* Compares entry i with the expected value, and frees the latter. */
static void same(const json_t *list, size_t i, json_t *expected)
{
    const json_t *item = json_array_get(list, i);
    if (!json_equal(item, expected))
        fail_msg("%zu: %s\n  is not %s", i, json_dumps(item, JSON_SORT_KEYS | JSON_COMPACT),
                 json_dumps(expected, JSON_SORT_KEYS | JSON_COMPACT));
    json_decref(expected);
}

TEST(documents_have_it_all)
{
    for (int k = 0; k < 3; k++) {
        const size_t replicates = k == 1 ? 1 : k ? 2 : 3;
        struct study study = made(k == 1 ? "gresho" : "sod", NULL, replicates, NULL);
        struct study_result *result = &study.results[0];
        json_t *document = json_object();
        for (int m = 0; m < 4; m++) { /* one gate of each outcome */
            struct study_order *of = &result->orders[0][m];
            of->status = (enum finding_status)m;
            of->gate = (struct order_gate){0.5 + m, 1.5 + m, 2.5 + m};
            strcpy(of->why, "too low");
            of->known = "it jumps";
        }
        result->functional_errors[0].status = FINDING_FAIL;
        result->still_status = (enum finding_status)k;
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
                     pack_order(&result->parts[part], part ? "radial" : "azimuthal", "l1", NULL));
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

static void first_combination_stops(json_t *run, size_t c, size_t l, size_t r)
{
    (void)r;
    if (c == 0 && l == 2) json_object_set_new(run, "suspicion", json_string("odd"));
    if (c == 1 && l == 1) json_object_set_new(run, "suspicion", json_string("odd, too"));
    if (c == 1 && l == 2) json_object_set_new(run, "suspicion", json_string("odder"));
}

/* Each combination has its own settings; the first of several suspicions counts. */
TEST(combinations_are_told_apart)
{
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
    json_array_foreach(levels, i, level)
        assert_string_equal(
            json_string_value(json_object_get(json_object_get(level, "settings"), "eta")), "2");
    assert_int_equal(json_array_size(json_object_get(document, "orders")), 0);
    assert_int_equal(json_array_size(json_object_get(document, "floors")), 0);
    assert_null(json_object_get(document, "budgets"));
    assert_string_equal(json_string_value(json_object_get(document, "message")), "n = 160: broken");
    json_decref(document);
    study.results[1].level_count = 0; /* all lists are present nevertheless */
    document = json_object();
    study_add_json(&study, document);
    static const char *const lists[] = {"levels", "orders", "functionals", "floors", "excluded"};
    for (size_t k = 0; k < 5; k++) assert_true(json_is_array(json_object_get(document, lists[k])));
    json_decref(document);
    study_free(&study);
}

/* The figures of a case are those of the first combination; no element after a list's end is
 * read. */
TEST(the_first_combination_counts)
{
    struct study study = made("kelvin_helmholtz_mode", "eta=2.2,0.5", 1, NULL);
    struct study_result *result = &study.results[0];
    assert_true(!result->excluded && study.results[1].excluded);
    json_t *document = json_object(), *want = json_array();
    const size_t n = result->functional_count;
    assert_true(n > 1 && n < PROBLEM_FUNCTIONALS_MAX);
    result->functional_names[n] = "none";
    result->functional_exact[n] = 1;
    result->functional_errors[n].fit.n = 4;
    for (size_t i = 0; i < n; i++)
        if (isfinite(result->functional_exact[i]))
            json_array_append_new(want, json_string(result->functional_names[i]));
    study_add_json(&study, document);
    assert_true(json_array_size(want) > 0);
    assert_true(json_equal(json_object_get(document, "measured"), want));
    assert_int_equal(json_array_size(json_object_get(document, "functionals")), n);
    char *text = json_dumps(json_object_get(document, "orders"), 0);
    assert_null(strstr(text, "none\", \"norm\": \"error\""));
    free(text);
    json_decref(want);
    json_decref(document);
    study_free(&study);
}
