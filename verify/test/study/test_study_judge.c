/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests how a study evaluates the documents of its runs: means and spreads, orders, missing runs,
 * gas that should be at rest, suspiciously small errors, settings without effect. */
#include "test.h"

#include "measure.h"
#include "sample_study.h"

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

/* Levels have geometric means of errors and spacings, arithmetic means of other values, the range
 * of n, and the scatter about a line with the ladder's slope; orders are fitted to these. */
TEST(levels_are_means)
{
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
        /* a region that is empty at one level has no order */
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
        assert_int_equal(result->still_status, FINDING_PASS);
        assert_int_equal(result->functional_count, 4);
        assert_true(isnan(result->functional_exact[2]) && result->functional_exact[1] == 1.5);
        assert_string_equal(result->functional_names[0], "mean_internal_energy");
        for (size_t i = 0; i < 2 && replicates == 1;
             i++) { /* of the three finest levels: errors fall with the square */
            const struct order_extrapolation *e = &result->functionals[i];
            near_relative(e->order, 2, 1e-6);
            near_relative(e->value, 0.5 + (double)i, 1e-9);
        }
        study_free(&study);
    }
}

/* For a circular flow in 2D: orders of the velocity's parts, and of functionals with exact
 * values. */
TEST(clouds_have_more_orders)
{
    for (size_t replicates = 1; replicates <= 2; replicates++) {
        struct study study = made("gresho", NULL, replicates, NULL);
        const struct study_result *result = &study.results[0];
        double spacing[LEVELS], errors[LEVELS];
        struct order_fit want;
        for (int part = 0; part < STUDY_PARTS; part++) {
            for (size_t l = 0; l < LEVELS; l++) {
                spacing[l] = exp(mean_log_spacing(l, replicates));
                errors[l] = exp(mean_log(4 + part, NORM_L1, l, replicates));
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
        assert_true(isnan(result->still) && result->still_status == FINDING_NONE);
        study_free(&study);
    }
    struct study line = made("sod", NULL, 1, NULL);
    assert_true(line.results[0].functional_errors[0].fit.n == 0 && line.results[0].parts[0].n == 0);
    study_free(&line);
}

TEST(broken_and_missing_runs)
{
    for (int kind = 0; kind < 3; kind++) {
        struct study study;
        struct pool pool;
        struct error error;
        assert_int_equal(make(&study, &pool, "sod", NULL, 1, NULL, &error), STATUS_OK);
        struct pool_job *job = &pool.jobs[1]; /* at the level before the finest */
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

/* ---- undisturbed gas, and errors that are too small ---- */

static double still_of[LEVELS];
static int fault_field, fault_kind;

static void set_still(json_t *run, size_t c, size_t l, size_t r)
{
    (void)c, (void)r;
    json_object_set_new(json_object_get(run, "budget"), "still", json_real(still_of[l]));
}

TEST(gas_that_does_not_stay)
{
    static const struct {
        double still[LEVELS], most;
        enum finding_status outcome;
    } rows[] = {{{5e-4, 1e-6, 1e-6, 1e-6}, 5e-4, FINDING_PASS},
                {{1e-6, 1e-6, 1e-6, 1e-3}, 1e-3, FINDING_PASS},
                {{1e-6, 1.0000001e-3, 0, 0}, 1.0000001e-3, FINDING_FAIL}};
    for (size_t k = 0; k < 3; k++) {
        memcpy(still_of, rows[k].still, sizeof still_of);
        struct study study = made("sod", "jitter=0", 1, set_still);
        study_free(&study);
        study = made("sod", NULL, 1, set_still);
        assert_true(study.results[0].still == rows[k].most);
        assert_int_equal(study.results[0].still_status, rows[k].outcome);
        if (rows[k].outcome == FINDING_FAIL)
            assert_int_equal(study.results[0].status, STATUS_CHECK_FAILED);
        study_free(&study);
        study = made("sod", "jitter=0.1", 1, set_still); /* noise that the settings ask for */
        assert_int_equal(study.results[0].still_status, FINDING_NONE);
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

TEST(errors_that_are_too_good)
{
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
            /* an error of 0 is no suspicion if the solution is exact */
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

/* Results are the same if their errors are, at all levels that both have, in all fields that are
 * known. */
TEST(same_at_all_levels)
{
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
    a.levels[1].errors[2][NORM_L1] = NAN;
    assert_false(study_suspect_same("eta", &a, &b, why));
    b.levels[1].errors[2][NORM_L1] = NAN;
    assert_true(study_suspect_same("eta", &a, &b, why));
    for (size_t l = 0; l < 2; l++)
        for (int f = 0; f < FIELDS; f++)
            a.levels[l].errors[f][NORM_L1] = b.levels[l].errors[f][NORM_L1] = NAN;
    assert_false(study_suspect_same("eta", &a, &b, why));
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

/* Of two keys that one is named which changes no result; keys that the scheme does not use are not
 * named. */
TEST(idle_settings_are_suspected)
{
    static const struct {
        const char *vary, *words;
        tamper *tampering;
    } rows[] = {
        {"eta=1.5,2,alpha=0.5,1", "alpha", differ_by_eta},
        {"alpha=0.5,1,eta=1.5,2", "eta", differ_by_eta},
        {"eta=1.5,2", "eta", NULL},
        {"eta=0.5,1.5,2", "eta", NULL}, /* eta = 0.5 is excluded */
        {"eta=1.5,2,0.5", "eta", NULL},
        {"eta=1.5,2,2.5", NULL, last_differs}, /* it has an effect */
        {"skip=auto,none", NULL, NULL},
        {"sinc_n=3,5", NULL, NULL},
        {"alpha_min=0.1,0.2", NULL, NULL},
        {"alpha_max=1,2", NULL, NULL},
        {"viscosity=none,alpha=1,2", NULL, NULL},
        {"viscosity=none,beta=1,2", NULL, NULL},
        {"viscosity=cullen_dehnen,alpha=1,2", NULL, NULL},
        {"viscosity=time_dependent,beta=1,2", "beta", NULL},
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
        const char *name = strstr(rows[k].vary, "cullen") ? "kelvin_helmholtz" : "sod";
        struct study study = made(name, rows[k].vary, 1, rows[k].tampering);
        if (!rows[k].words != !study.suspicion[0] ||
            (rows[k].words && !strstr(study.suspicion, rows[k].words)))
            fail_msg("%s: '%s'", rows[k].vary, study.suspicion);
        assert_int_equal(study.status, rows[k].words ? STATUS_CHECK_FAILED : STATUS_OK);
        study_free(&study);
    }
}

/* ---- largest numbers ---- */

/* A ladder with the largest number of levels. */
TEST(the_most_levels)
{
    static const char *const cases[] = {"sod", "gresho"};
    size_t kept[LEVELS];
    memcpy(kept, ladder, sizeof kept);
    level_count = CASE_LADDER_MAX;
    for (size_t l = 0; l < CASE_LADDER_MAX; l++) ladder[l] = 40 + 5 * l;
    for (int k = 0; k < 2; k++) {
        struct study study = made(cases[k], NULL, 1, NULL);
        const struct study_result *result = &study.results[0];
        double spacing[CASE_LADDER_MAX], errors[CASE_LADDER_MAX];
        struct order_fit want;
        assert_int_equal(result->level_count, CASE_LADDER_MAX);
        for (int f = 0; f < FIELDS; f++)
            for (int m = 0; m < NORMS; m++) {
                for (size_t l = 0; l < CASE_LADDER_MAX; l++) {
                    spacing[l] = spacing_of(l, 0);
                    errors[l] = error_at(f, m, l, 0);
                }
                assert_int_equal(order_fit(CASE_LADDER_MAX, spacing, errors, NULL, &want, NULL),
                                 STATUS_OK);
                near_relative(result->orders[f][m].fit.order, want.order, 1e-12);
                assert_true(result->orders[f][m].fit.finest == errors[CASE_LADDER_MAX - 1]);
            }
        study_free(&study);
    }
    level_count = LEVELS;
    memcpy(ladder, kept, sizeof kept);
}

static void many_functionals(json_t *run, size_t c, size_t l, size_t r)
{
    json_t *list = json_object_get(run, "functionals");
    (void)c, (void)l, (void)r;
    while (json_array_size(list) < PROBLEM_FUNCTIONALS_MAX + 4)
        json_array_append_new(list, json_pack("{s:s, s:f, s:f}", "name", "mean_pressure", "value",
                                              1e300, "reference", 1.));
}

/* If a document has too many functionals, the first ones are read. */
TEST(too_many_functionals)
{
    struct study study = made("sod", NULL, 1, many_functionals);
    const struct study_result *result = &study.results[0];
    assert_int_equal(result->functional_count, PROBLEM_FUNCTIONALS_MAX);
    near_relative(result->levels[2].errors[3][4], error_at(3, 4, 2, 0), 1e-14);
    assert_true(result->levels[1].n == ladder[1] && result->levels[3].n == ladder[3]);
    study_free(&study);
}

static void no_error(json_t *run, size_t c, size_t l, size_t r)
{
    (void)c, (void)r;
    if (l == 0)
        json_object_set_new(json_object_get(json_object_get(run, "errors"), "density"), "l1",
                            json_real(0));
}

/* If a ladder has no slope, the scatter is that of the errors themselves. */
TEST(scatter_without_slope)
{
    struct study study = made("sod", NULL, 2, no_error);
    const struct study_result *result = &study.results[0];
    for (size_t l = 1; l < LEVELS; l++)
        near_relative(result->levels[l].spread[0][0],
                      fabs(log(error_at(0, 0, l, 0) / error_at(0, 0, l, 1))) / sqrt(2), 1e-9);
    study_free(&study);
}

static void same_spacing(json_t *run, size_t c, size_t l, size_t r)
{
    (void)c, (void)r;
    if (l == 2) json_object_set_new(run, "spacing", json_real(spacing_of(1, 0)));
}

/* Two levels with the same spacing have no order. */
TEST(levels_of_equal_spacing)
{
    struct study study;
    struct pool pool;
    struct error error;
    assert_int_equal(make(&study, &pool, "sod", NULL, 1, same_spacing, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "resolutions must be distinct"));
    pool_free(&pool);
    study_free(&study);
}

static void suspected_already(json_t *run, size_t c, size_t l, size_t r)
{
    too_good(run, c, l, r);
    if (l == 1) json_object_set_new(run, "suspicion", json_string("x"));
}

static void same_bins(json_t *run, size_t c, size_t l, size_t r)
{
    (void)c, (void)l, (void)r;
    json_object_set_new(json_object_get(run, "errors"), "binned_density_l1", json_real(0.125));
}

/* A run's own suspicion comes first; means over bins are not suspected. */
TEST(suspicions)
{
    fault_kind = fault_field = 0;
    struct study study = made("sod", NULL, 1, suspected_already);
    assert_string_equal(study.results[0].suspicion, "x");
    assert_int_equal(study.results[0].status, STATUS_CHECK_FAILED);
    study_free(&study);
    study = made("sod", NULL, 1, same_bins);
    assert_string_equal(study.results[0].suspicion, "");
    study_free(&study);
}

static void first_combination_stops(json_t *run, size_t c, size_t l, size_t r)
{
    (void)r;
    if (c == 0 && l == 2) json_object_set_new(run, "suspicion", json_string("odd"));
    if (c == 1 && l == 1) json_object_set_new(run, "suspicion", json_string("odd, too"));
    if (c == 1 && l == 2) json_object_set_new(run, "suspicion", json_string("odder"));
}

/* The first of several suspicions counts. (Documents: test_converge_drawn.c.) */
TEST(first_suspicions)
{
    struct study study = made("sod", "eta=1.5,2", 1, first_combination_stops);
    assert_string_equal(study.results[0].suspicion, "odd");
    assert_string_equal(study.results[1].suspicion, "odd, too");
    assert_int_equal(study.status, STATUS_CHECK_FAILED);
    study_free(&study);
}
