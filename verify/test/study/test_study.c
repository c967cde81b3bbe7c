/* SPDX-License-Identifier: GPL-3.0-or-later
 * Studies: the same results in any number of processes and from the cache, replicates and what they
 * do to intervals, budgets that add up, still gas, settings without effect, broken levels. */
#include "test.h"

#include <stdlib.h>
#include <string.h>

#include "judged.h"
#include "near.h"
#include "result.h"
#include "run_measure.h"
#include "study.h"

/* Changes a run's document before it is judged: what the judges make of figures that a sound solver
 * does not have. */
typedef void tamper(json_t *run, size_t level);
static tamper *tampering;
/* What the case says of its first gate, see cases.h. */
static const char *known = "";
static double known_bound = INFINITY;

/* A study of a case with keys, over a small ladder; its pool is run with so many processes. */
static enum status make(struct study *study, const char *name, const char *keys, const char *vary,
                        size_t seeds, int jobs, struct error *error)
{
    static const size_t ladder[] = {40, 60, 80, 120};
    char text[256], *arguments[16], *rest = text;
    struct pool pool = {0};
    const struct pool_settings settings = {.jobs = jobs};
    int n = 0;
    *study = (struct study){.level_count = 4, .replicates = seeds};
    memcpy(study->ladder, ladder, sizeof ladder);
    strcpy(text, keys);
    for (char *word; (word = strtok_r(rest, " ", &rest));) arguments[n++] = word;
    enum status status = run_prepare(&study->settings, name, n, arguments, error);
    if (!status) status = sweep_parse(&study->sweep, vary, error);
    if (!status) status = study_plan(study, &pool, error);
    if (!status) status = pool_run(&pool, &settings, error);
    for (size_t l = 0; l < pool.count && tampering && !status; l++)
        tampering(pool.jobs[l].document, l);
    strcpy(study->settings.file.gates[0].known.why, known);
    study->settings.file.gates[0].known.bound = known_bound;
    if (!status) status = study_judge(study, &pool, error);
    pool_free(&pool);
    return status;
}

static struct study made(const char *name, const char *keys, const char *vary, size_t seeds,
                         int jobs)
{
    struct study study;
    struct error error = {0};
    if (make(&study, name, keys, vary, seeds, jobs, &error)) fail_msg("%s", error.message);
    return study;
}

static json_t *document(const struct study *study)
{
    json_t *result = json_object(), *level;
    size_t i;
    study_add_json(study, result);
    json_array_foreach(json_object_get(result, "levels"), i, level) json_object_del(level, "cpu_s");
    return result;
}

TEST(any_number_of_processes)
{
    struct study one = made("sod", "t_end=0.1", "gradient,eta=1.5,2", 1, 1),
                 three = made("sod", "t_end=0.1", "gradient,eta=1.5,2", 1, 3);
    json_t *a = document(&one), *b = document(&three);
    assert_int_equal(json_array_size(json_object_get(a, "levels")), 16);
    assert_true(json_equal(a, b));
    json_decref(a);
    json_decref(b);
    study_free(&one);
    study_free(&three);
}

static struct run_result ran(const char *name, int n, char **arguments)
{
    struct run_settings settings;
    struct run run;
    struct run_result result = {0};
    struct error error = {0};
    if (run_prepare(&settings, name, n, arguments, &error) ||
        run_resolve(&run, &settings, &error) || run_execute(&run, &result, &error))
        fail_msg("%s", error.message);
    return result;
}

/* Levels of a study are runs like any other. */
TEST(levels_are_runs)
{
    struct study study = made("sod", "t_end=0.1", NULL, 1, 2);
    struct run_result run = ran("sod", 2, (char *[]){"t_end=0.1", "n=80"});
    const struct study_level *level = &study.results[0].levels[2];
    for (int f = 0; f < FIELDS; f++)
        for (int m = 0; m < NORMS; m++)
            assert_true(level->errors[f][m] == run_error(&run, (enum field)f, (enum norm)m));
    assert_true(level->spacing == 2. / 80 &&
                level->spacing == run.spacing); /* of the box [-1, 1] */
    assert_true(level->h == run.h && level->binned_density_l1 == run.binned_density_l1);
    run_free(&run);
    study_free(&study);
}

TEST(replicates)
{
    struct study study = made("sod", "t_end=0.1 jitter=0.1", NULL, 4, 2);
    const struct study_result *result = &study.results[0];
    const struct study_level *level = &result->levels[1];
    /* geometric mean and spread of four single runs */
    double sum = 0, squares = 0;
    for (int r = 0; r < 4; r++) {
        char seed[32];
        snprintf(seed, sizeof seed, "seed=%d", r + 1);
        struct run_result run = ran("sod", 4, (char *[]){"t_end=0.1", "jitter=0.1", "n=60", seed});
        const double value = log(run.errors[FIELD_DENSITY].l1);
        sum += value;
        squares += value * value;
        run_free(&run);
    }
    const double mean = sum / 4, variance = (squares - 4 * mean * mean) / 3;
    near_relative(level->errors[FIELD_DENSITY][NORM_L1], exp(mean), 1e-12);
    near_relative(level->spread[FIELD_DENSITY][NORM_L1], sqrt(variance), 1e-9);
    /* the interval is that of means of four */
    double spacing[4], errors[4], variances[4];
    const struct order_noise noise = {variances, 4};
    struct order_fit want;
    for (size_t l = 0; l < 4; l++) {
        const double s = result->levels[l].spread[FIELD_DENSITY][NORM_L1];
        spacing[l] = result->levels[l].spacing;
        errors[l] = result->levels[l].errors[FIELD_DENSITY][NORM_L1];
        variances[l] = s * s / 4;
    }
    assert_int_equal(order_fit(4, spacing, errors, &noise, &want, NULL), STATUS_OK);
    const struct order_fit *fit = &result->orders[FIELD_DENSITY][NORM_L1].fit;
    near_relative(fit->order, want.order, 1e-12);
    near_relative(fit->high - fit->low, want.high - want.low, 1e-12);
    assert_int_equal(result->still_status, FINDING_NONE); /* a random start is noisy */
    study_free(&study);
}

/* Where no seed makes a difference, replicates have other n: the same means and orders by hand. */
TEST(neighbours)
{
    static const size_t of_60[] = {60, 61, 59}, of_200[] = {200, 205, 195};
    for (size_t r = 0; r < 3; r++) {
        assert_int_equal(study_neighbour(200, 3, r), of_200[r]);
        assert_int_equal(study_neighbour(60, 9, r), of_60[r]);
    }
    assert_int_equal(study_neighbour(5, 9, 0), 5); /* never fewer than 4 particles */
    assert_int_equal(study_neighbour(5, 9, 8), 13);
    assert_int_equal(study_neighbour(8, 9, 8), 4);
    assert_int_equal(study_neighbour(200, 1, 0), 200);

    struct study study = made("sod", "t_end=0.1", NULL, 3, 2);
    const struct study_result *result = &study.results[0];
    const struct study_level *level = &result->levels[1], *coarsest = &result->levels[0],
                             *finest = &result->levels[3];
    assert_true(level->n == 60 && level->n_range[0] == 58 && level->n_range[1] == 62);
    double x[3], y[3], spacing = 0, error = 0;
    for (int r = 0; r < 3; r++) {
        char n[32];
        snprintf(n, sizeof n, "n=%d", (int[]){60, 62, 58}[r]);
        struct run_result run = ran("sod", 2, (char *[]){"t_end=0.1", n});
        x[r] = log(run.spacing);
        y[r] = log(run.errors[FIELD_VELOCITY].l1);
        spacing += x[r] / 3;
        error += y[r] / 3;
        run_free(&run);
    }
    near_relative(level->spacing, exp(spacing), 1e-13);
    near_relative(level->errors[FIELD_VELOCITY][NORM_L1], exp(error), 1e-13);
    const double slope =
        log(coarsest->errors[FIELD_VELOCITY][NORM_L1] / finest->errors[FIELD_VELOCITY][NORM_L1]) /
        log(coarsest->spacing / finest->spacing);
    double squares = 0;
    for (int r = 0; r < 3; r++) squares += pow(y[r] - error - slope * (x[r] - spacing), 2);
    near_relative(level->spread[FIELD_VELOCITY][NORM_L1], sqrt(squares / 2), 1e-6);
    study_free(&study);
    /* errors that fall with n and do nothing else do not scatter */
    struct study smooth = made("sound_wave", "t_end=0.1", NULL, 3, 2);
    near_below(smooth.results[0].levels[2].spread[FIELD_DENSITY][NORM_L1], 5e-3);
    study_free(&smooth);
}

TEST(replicates_by_default)
{
    static const struct {
        const char *name, *key;
        size_t replicates;
    } cases[] = {{"sod", "n=100", 9}, {"sound_wave", "n=100", 1}, {"sod", "jitter=0.1", 3}};
    for (size_t i = 0; i < 3; i++) {
        struct run_settings settings;
        assert_int_equal(
            run_prepare(&settings, cases[i].name, 1, (char *[]){(char *)cases[i].key}, NULL),
            STATUS_OK);
        assert_int_equal(study_replicates(&settings), cases[i].replicates);
    }
}

/* A mirrored tube is the same problem, also of graded masses: the particles are those of the tube
 * mirrored, and so is what becomes of them, to round-off and what the steps make of it. */
TEST(mirrored)
{
    static const char *const tubes[][2][3] = {
        {{"left=1,0,1", "right=0.125,0,0.1", "t_end=0.1"},
         {"right=1,0,1", "left=0.125,0,0.1", "t_end=0.1"}},
        {{"left=0.445,0.698,3.528", "right=0.5,0,0.571", "t_end=0.05"},
         {"right=0.445,-0.698,3.528", "left=0.5,0,0.571", "t_end=0.05"}},
        {{"left=1,0,1000", "right=1,0,0.01", "t_end=0.006"},
         {"right=1,0,1000", "left=1,0,0.01", "t_end=0.006"}},
    };
    for (size_t t = 0; t < 3; t++) {
        struct run_result run[2];
        for (int k = 0; k < 2; k++) {
            char *const *keys = (char *const *)tubes[t][k];
            run[k] = ran("sod", 5, (char *[]){keys[0], keys[1], keys[2], "grade=0.5", "n=300"});
        }
        near_relative(settings_real(&run[0].settings, SETTING_mass_ratio) *
                          settings_real(&run[1].settings, SETTING_mass_ratio),
                      1, 1e-12);
        assert_int_equal(run[0].n, run[1].n);
        for (size_t i = 0; i < run[0].n; i++)
            near_relative(run[0].snapshot.m[i], run[1].snapshot.m[run[1].n - 1 - i], 1e-12);
        for (int f = 0; f < FIELDS; f++)
            near_relative(run[0].errors[f].l1, run[1].errors[f].l1, 1e-6);
        run_free(&run[0]);
        run_free(&run[1]);
    }
}

TEST(budgets_add_up)
{
    struct study study = made("sod", "", NULL, 1, 2);
    const struct study_result *result = &study.results[0];
    for (size_t l = 0; l < result->level_count; l++)
        for (int f = 0; f < FIELDS; f++) {
            const struct budget *budget = &result->levels[l].budget;
            double sum = 0;
            assert_non_null(budget->regions);
            for (size_t r = 0; budget->regions->names[r]; r++) {
                assert_true(budget->l1[r][f] >= 0);
                sum += budget->l1[r][f];
            }
            near_relative(sum, result->levels[l].errors[f][NORM_L1], 1e-12);
        }
    assert_int_equal(result->still_status, FINDING_PASS);
    study_free(&study);

    struct study wave = made("sound_wave", "t_end=0.1", NULL, 1, 2);
    assert_null(wave.results[0].levels[0].budget.regions);
    assert_int_equal(wave.results[0].still_status, FINDING_NONE);
    study_free(&wave);
}

/* What a snapshot that has been tampered with shows: particles far ahead of every wave. */
TEST(still_gas_that_moves)
{
    struct run_result run = ran("sod", 1, (char *[]){"n=800"});
    struct budget budget;
    const double *none[FIELDS] = {run.snapshot.rho, run.snapshot.v[0], run.snapshot.P,
                                  run.snapshot.u};
    near_below(run.budget.still, 1e-6);
    double *v = (double *)run.snapshot.v[0];
    for (size_t i = 0; i < run.n; i++)
        if (fabs(run.snapshot.x[0][i] + 0.5) < 0.01) v[i] = 0.05;
    run_measure_budget(&run.problem, &run.snapshot, none, &budget);
    near_relative(budget.still, 0.05 / sqrt(1.4), 1e-12);
    /* behind the shock gas may move as it likes */
    for (size_t i = 0; i < run.n; i++) {
        if (fabs(run.snapshot.x[0][i] + 0.5) < 0.01) v[i] = 0;
        if (fabs(run.snapshot.x[0][i] - 0.25) < 0.01) v[i] = 9;
    }
    run_measure_budget(&run.problem, &run.snapshot, none, &budget);
    near_below(budget.still, 1e-6);
    run_free(&run);
}

TEST(settings_without_effect)
{
    /* read, but the scheme cannot tell the values apart: viscous constants of still gas */
    struct study idle = made("sod", "left=1,0,1 right=1,0,0.999999999999999 t_end=0.05",
                             "alpha=1,1.0000000000000002", 1, 2);
    assert_string_not_equal(idle.suspicion, "");
    assert_int_equal(idle.status, STATUS_CHECK_FAILED);
    study_free(&idle);
    /* not read by this scheme: no wonder */
    struct study unread = made("sod", "t_end=0.1 kernel=cubic_spline", "sinc_n=3,5", 1, 2);
    assert_string_equal(unread.suspicion, "");
    study_free(&unread);
    struct study read = made("sod", "t_end=0.1 kernel=sinc", "sinc_n=3,5", 1, 2);
    assert_string_equal(read.suspicion, "");
    study_free(&read);
    struct study skip = made("sod", "t_end=0.1", "skip=auto,none", 1, 2);
    assert_string_equal(skip.suspicion, "");
    study_free(&skip);
}

/* An error of 0 is suspicious; a broken level ends the ladder; an excluded combination is none. */
TEST(what_is_not_well)
{
    struct study zero = made("sod", "left=1,0,1 right=1,0,1 t_end=0.05", NULL, 1, 2);
    assert_string_not_equal(zero.results[0].suspicion, "");
    assert_int_equal(zero.status, STATUS_CHECK_FAILED);
    study_free(&zero);
    struct study broken = made("two_rarefactions", "cfl=50", NULL, 1, 2);
    assert_int_equal(broken.status, STATUS_BROKE_DOWN);
    assert_non_null(strstr(broken.results[0].message, "n = 40"));
    assert_int_equal(broken.results[0].level_count, 0);
    study_free(&broken);
    struct study some = made("sod", "t_end=0.1", "eta=0.5,1.5", 1, 2);
    assert_true(some.results[0].excluded);
    assert_int_equal(some.results[1].level_count, 4);
    study_free(&some);
    struct error error = {0};
    assert_int_equal(make(&some, "sod", "eta=0.5", NULL, 1, 1, &error), STATUS_BAD_INPUT);
    study_free(&some);
    assert_int_equal(make(&some, "sod", "t_end=5", NULL, 1, 1, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "mirrored tube"));
    study_free(&some);
}

static void set_error(json_t *run, const char *field, const char *norm, double value)
{
    json_t *errors = json_object_get(json_object_get(run, "errors"), field);
    json_object_set_new(errors, norm, result_number(value));
}

static void of_first_order(json_t *run, size_t level)
{
    (void)level;
    set_error(run, "density", "l1", 1e-3 * json_number_value(json_object_get(run, "spacing")));
}

static void of_half_order(json_t *run, size_t level)
{
    (void)level;
    const double spacing = json_number_value(json_object_get(run, "spacing"));
    set_error(run, "density", "l1", 1e-3 * sqrt(spacing));
}

static void too_large(json_t *run, size_t level)
{
    (void)level;
    set_error(run, "density", "l1", 9 * json_number_value(json_object_get(run, "spacing")));
}

static void nan_at_one_level(json_t *run, size_t level)
{
    of_first_order(run, level);
    if (level == 1) set_error(run, "density", "l1", (double)NAN);
}

static void nan_at_the_finest(json_t *run, size_t level)
{
    of_half_order(run, level);
    if (level == 3) set_error(run, "density", "l1", (double)NAN);
}

static void zero_at_one_level(json_t *run, size_t level)
{
    of_first_order(run, level);
    if (level == 3) set_error(run, "velocity", "l1", 0);
}

static void same_at_two_levels(json_t *run, size_t level)
{
    of_first_order(run, level);
    if (level == 0 || level == 3) set_error(run, "pressure", "l1", 0.125);
}

static void moved_gas(json_t *run, size_t level)
{
    of_first_order(run, level);
    json_object_set_new(json_object_get(run, "budget"), "still", result_number(level ? 0 : 2e-3));
}

static void suspected_run(json_t *run, size_t level)
{
    of_first_order(run, level);
    if (level == 2) json_object_set_new(run, "suspicion", json_string("a run suspects itself"));
}

TEST(judges_see)
{
    static const struct {
        const char *what;
        tamper *tamper;
        enum status status;
        enum finding_status gate, still;
        const char *suspicion;
    } cases[] = {
        {"first order", of_first_order, STATUS_OK, FINDING_SMOKE, FINDING_PASS, ""},
        {"half an order", of_half_order, STATUS_CHECK_FAILED, FINDING_FAIL, FINDING_PASS, ""},
        {"half an order, known", of_half_order, STATUS_OK, FINDING_KNOWN, FINDING_PASS, ""},
        {"half an order, known up to less", of_half_order, STATUS_CHECK_FAILED, FINDING_FAIL,
         FINDING_PASS, ""},
        {"first order, known to fail", of_first_order, STATUS_OK, FINDING_SMOKE, FINDING_PASS, ""},
        {"too large", too_large, STATUS_CHECK_FAILED, FINDING_FAIL, FINDING_PASS, ""},
        {"a NaN", nan_at_one_level, STATUS_CHECK_FAILED, FINDING_FAIL, FINDING_PASS, ""},
        {"a NaN, known", nan_at_one_level, STATUS_CHECK_FAILED, FINDING_FAIL, FINDING_PASS, ""},
        {"a NaN at last, known", nan_at_the_finest, STATUS_CHECK_FAILED, FINDING_FAIL, FINDING_PASS,
         ""},
        {"an error of 0", zero_at_one_level, STATUS_CHECK_FAILED, FINDING_SMOKE, FINDING_PASS,
         "velocity: the error at level 3 is exactly 0"},
        {"twice the same", same_at_two_levels, STATUS_CHECK_FAILED, FINDING_SMOKE, FINDING_PASS,
         "pressure: levels 0 and 3"},
        {"still gas", moved_gas, STATUS_CHECK_FAILED, FINDING_SMOKE, FINDING_FAIL, ""},
        {"a suspected run", suspected_run, STATUS_CHECK_FAILED, FINDING_SMOKE, FINDING_PASS,
         "a run suspects itself"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        tampering = cases[i].tamper;
        known = strstr(cases[i].what, "known") ? "why" : "";
        known_bound = strstr(cases[i].what, "less") ? 1e-9 : (double)INFINITY;
        struct study study = made("sod", "t_end=0.1", NULL, 1, 2);
        tampering = NULL;
        known = "";
        const struct study_result *result = &study.results[0];
        const struct study_order *order = &result->orders[FIELD_DENSITY][NORM_L1];
        if (study.status != cases[i].status || result->status != cases[i].status ||
            order->status != cases[i].gate || result->still_status != cases[i].still ||
            strncmp(result->suspicion, cases[i].suspicion, strlen(cases[i].suspicion)) != 0 ||
            !*result->suspicion != !*cases[i].suspicion)
            fail_msg("%s: status %d, gate %d, still gas %d, '%s'", cases[i].what, study.status,
                     order->status, result->still_status, result->suspicion);
        /* the bound belongs to the case's own finest level, 1584: farther up it is wider */
        near_relative(order->gate.bound, 1.5e-3 * pow(1584. / 120, 0.85), 1e-12);
        assert_true(order->gate.low == 0.85 && order->gate.high == 1.1);
        assert_int_equal(result->orders[FIELD_VELOCITY][NORM_L1].status, FINDING_NONE);
        study_free(&study);
    }
    /* one bad combination of many is not lost */
    tampering = of_half_order;
    struct study study = made("sod", "t_end=0.1", "eta=0.5,1.5,2", 1, 2);
    tampering = NULL;
    assert_int_equal(study.status, STATUS_CHECK_FAILED);
    study_free(&study);
}

/* What every case is judged by: nothing that its flow does not have, and gated fields first. */
TEST(judged_by)
{
    static const struct {
        const char *name, *first;
    } cases[] = {{"sod", "density"},           {"gresho", "azimuthal"},
                 {"rotation", "azimuthal"},    {"sedov_2d", "pressure"},
                 {"noh_3d", "density"},        {"sound_wave_2d", "velocity"},
                 {"kelvin_helmholtz", "known"}};
    const char *const functionals[] = {"unknown", "known"};
    const double exact[] = {(double)NAN, 0.5};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct case_file file;
        struct error error;
        const char *names[JUDGED_MAX];
        if (case_load(&file, cases[i].name, &error)) fail_msg("%s", error.message);
        const size_t n = judged_names(&file, 2, functionals, exact, names);
        assert_true(n >= 1 && n <= JUDGED_MAX);
        assert_string_equal(names[0], cases[i].first);
    }
}

/* Lattice sums: what floor there is, and whether it is what has taken the order away. */
TEST(floors)
{
    struct study lost = made("sound_wave", "t_end=0.1 kernel=cubic_spline eta=4.8", NULL, 1, 2);
    const struct study_result *result = &lost.results[0];
    near_inside(result->floor_density, 5.1e-4, 5.2e-4);
    near_inside(result->floor_gradient, 3.0e-3, 3.2e-3);
    assert_true(result->floor_explains);
    assert_int_equal(result->orders[FIELD_DENSITY][NORM_L1].fit.class, ORDER_FLOOR_LIMITED);
    bool seen = false;
    for (size_t i = 0; i < result->functional_count; i++)
        if (strcmp(result->functional_names[i], "mean_pressure") == 0) {
            assert_int_equal(result->functionals[i].class, ORDER_FLOOR_LIMITED);
            seen = true;
        }
    assert_true(seen);
    study_free(&lost);
    /* an order that is lost for another reason, where the sums are exact */
    tampering = of_half_order;
    struct study other = made("sod", "t_end=0.1", NULL, 1, 2);
    tampering = NULL;
    near_below(fabs(other.results[0].floor_density), 1e-13);
    assert_false(other.results[0].floor_explains);
    study_free(&other);
}

TEST(functionals_know_their_exact_values)
{
    struct study study = made("sod", "", NULL, 1, 2);
    const struct study_result *result = &study.results[0];
    assert_int_equal(result->functional_count, 3);
    for (size_t i = 0; i < result->functional_count; i++) {
        near_relative(result->levels[3].functionals[i], result->functional_exact[i], 0.05);
        if (strcmp(result->functional_names[i], "shock_position") == 0)
            near_relative(result->functional_exact[i], 0.2 * 1.7521557320301779, 1e-12);
    }
    study_free(&study);
}
