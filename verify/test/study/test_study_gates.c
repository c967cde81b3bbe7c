/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the gates of a case on a study: which pass, fail or are known to fail, how far a bound is
 * raised, and which errors the lattice-sum floor explains. */
#include "test.h"

#include "gates.h"
#include "measure.h"
#include "sample_study.h"

static double factor;

static void times_factor(json_t *run, size_t c, size_t l, size_t r)
{
    json_t *norms_of = json_object_get(json_object_get(run, "errors"), "density");
    (void)c;
    json_object_set_new(norms_of, "l1", json_real(factor * pow(spacing_of(l, r), 0.5)));
}

static struct study study;
static struct pool pool;
static struct error error;
static struct case_file *const file = &study.settings.file;

/* A study to which the test adds gates; its result is reset to the state before judging. */
static void begin(const char *name, const char *keys, size_t replicates, tamper *tampering)
{
    make(&study, &pool, name, keys, replicates, tampering, &error);
    struct study_result *result = study.results;
    *result = (struct study_result){.settings = result->settings, .scheme = result->scheme};
    study.status = STATUS_OK;
    file->gate_count = 1;
}

static const struct study_result *judged(void)
{
    assert_int_equal(study_judge(&study, &pool, &error), STATUS_OK);
    return study.results;
}

static void end(void)
{
    study_free(&study);
    pool_free(&pool);
}

/* The gate of a field on order and error; one on the finest error alone; orders explained by
 * lattice sums. */
TEST(gates_are_judged)
{
    const double open = (double)INFINITY;
    const struct {
        const char *name, *functional;
        struct order_gate gate; /* a bound of 0: the finest error itself */
        double factor;
        size_t coarse; /* the case's own finest n */
        enum finding_status outcome;
        double raised; /* factor by which the bound is raised */
        bool explains;
    } rows[] = {
        {"sod", NULL, {0.4, 0.6, 1}, 0.01, 0, FINDING_PASS, 1, false},
        {"sod", NULL, {0.6, 0.8, 1}, 0.01, 0, FINDING_FAIL, 1, false},
        {"sod", NULL, {0.6, 0.8, 1}, 0.01, 0, FINDING_KNOWN, 1, false},
        {"sod", NULL, {0.4, 0.6, 7e-4}, 0.01, 0, FINDING_FAIL, 1, false},
        {"sod", NULL, {0.4, 0.6, 7e-4}, 0.01, 640, FINDING_PASS, 1.3195079107728942, false},
        {"sod", NULL, {0.4, 0.6, 7e-4}, 0.01, 160, FINDING_FAIL, 1, false},
        {"sod", NULL, {1, open, 8e-4}, 0.01, 0, FINDING_PASS, 1, false},
        {"sod", NULL, {1, open, 7.9e-4}, 0.01, 0, FINDING_FAIL, 1, false},
        {"sod", NULL, {1, open, 0}, 0.01, 0, FINDING_PASS, 1, false},
        {"sod", "mean_pressure", {1, open, 1}, 0.01, 0, FINDING_NONE, 1, false},
        {"gresho", NULL, {1, open, 1e-12}, 1e-9, 0, FINDING_FAIL, 1, false},
        {"gresho", NULL, {0.4, 0.6, 1e-12}, 1e-9, 0, FINDING_FAIL, 1, false},
        {"gresho", NULL, {0.4, 0.6, 7e-4}, 0.01, 640, FINDING_PASS, 1.1486983549970351, false},
        {"gresho", NULL, {0.6, 0.8, 1}, 1e-9, 0, FINDING_FAIL, 1, true},
        {"gresho", "disc_error", {1, open, 1.2e-5}, 0.01, 0, FINDING_PASS, 1, false},
        {"gresho", "disc_error", {1, open, 1.1e-5}, 0.01, 0, FINDING_FAIL, 1, false},
        {"gresho", "peak_velocity", {1, open, 1.2e-5}, 0.01, 0, FINDING_PASS, 1, false},
        {"gresho", "peak_velocity", {1, open, 1.1e-5}, 0.01, 0, FINDING_FAIL, 1, false},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const char *functional = rows[k].functional;
        factor = rows[k].factor;
        begin(rows[k].name, NULL, 1, times_factor);
        const double finest = factor * pow(spacing_of(3, 0), 0.5);
        const double bound = rows[k].gate.bound > 0 ? rows[k].gate.bound : finest;
        file->gates[0] = (struct case_gate){.functional = functional, .gate = rows[k].gate};
        file->gates[0].gate.bound = bound;
        if (rows[k].outcome == FINDING_KNOWN)
            file->gates[0].known = (struct case_weakness){open, "why"};
        file->gates[1] = (struct case_gate){
            .field = FIELD_VELOCITY, .norm = NORM_L2, .gate = {.low = -9, .high = 9, .bound = 1e9}};
        file->gate_count = 2;
        file->ladder[0] = 5, file->ladder[1] = rows[k].coarse;
        file->ladder_count = rows[k].coarse ? 2 : 0;
        const struct study_result *result = judged();
        const struct study_order *order =
            functional ? &result->functional_errors[strcmp(functional, "disc_error") != 0]
                       : &result->orders[0][0];
        if (order->status != rows[k].outcome)
            fail_msg("row %zu: outcome %d, %s, bound %g, finest %g", k, order->status, order->why,
                     order->gate.bound, order->fit.finest);
        assert_int_equal(result->orders[FIELD_VELOCITY][NORM_L2].status, FINDING_PASS);
        if (rows[k].outcome != FINDING_NONE) {
            near_relative(order->gate.bound, bound * rows[k].raised, 1e-9);
            assert_true(!isfinite(rows[k].gate.high) == !(order->gate.low > -1e300));
            assert_string_equal(order->known, rows[k].outcome == FINDING_KNOWN ? "why" : "");
            assert_true(result->floor_explains == rows[k].explains);
            assert_int_equal(result->status,
                             rows[k].outcome == FINDING_FAIL ? STATUS_CHECK_FAILED : STATUS_OK);
            assert_int_equal(study.status, result->status);
            assert_true(!order->why[0] == (rows[k].outcome == FINDING_PASS));
        }
        end();
    }
}

/* A weakness is known up to a bound, which is raised for a coarser ladder; a larger error fails,
 * and the message gives the raised bound. */
TEST(beyond_what_is_known)
{
    char text[200];
    factor = 0.01;
    begin("sod", NULL, 1, times_factor);
    file->gates[0] =
        (struct case_gate){.gate = {0.6, 0.8, 1}, .known = {.bound = 1e-4, .why = "why"}};
    file->ladder_count = 1;
    file->ladder[0] = 640;
    const struct study_order *order = &judged()->orders[FIELD_DENSITY][NORM_L1];
    snprintf(text, sizeof text, "finest error %.3g exceeds 0.000152, up to which it is known",
             factor * pow(spacing_of(3, 0), 0.5)); /* 1e-4 times 2^0.6 */
    assert_int_equal(order->status, FINDING_FAIL);
    assert_string_equal(order->why, text);
    end();
}

/* A suspiciously small error fails only on the case's own ladder and with the case's settings. */
TEST(errors_too_small_are_suspicious)
{
    static const struct {
        double least; /* over the finest error */
        size_t coarse;
        enum setting key; /* set by the user; n: always set */
        bool known;
        enum finding_status outcome;
    } rows[] = {{0.99, 320, SETTING_n, false, FINDING_PASS},
                {1.01, 320, SETTING_n, false, FINDING_FAIL},
                {1.01, 320, SETTING_n, true, FINDING_KNOWN},
                {1.01, 320, SETTING_eta, false, FINDING_PASS},
                {1.01, 640, SETTING_n, false, FINDING_PASS},
                {1.01, 160, SETTING_n, false, FINDING_PASS},
                {1.01, 320, (enum setting)0, false, FINDING_PASS},
                {1.01, 320, (enum setting)(SETTINGS - 1), false, FINDING_PASS}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        factor = 0.01;
        begin("sod", NULL, 1, times_factor);
        const double finest = factor * pow(spacing_of(3, 0), 0.5);
        for (int i = 0; i < SETTINGS; i++) study.results[0].settings.value[i].source = SOURCE_CASE;
        study.results[0].settings.value[SETTING_n].source = SOURCE_USER;
        study.results[0].settings.value[rows[k].key].source = SOURCE_USER;
        file->gates[0] = (struct case_gate){.gate = {1, (double)INFINITY, 2 * finest},
                                            .known = {.bound = (double)INFINITY},
                                            .least = rows[k].least * finest};
        if (rows[k].known) strcpy(file->gates[0].known.why, "too good");
        file->ladder[0] = 5, file->ladder[1] = rows[k].coarse;
        file->ladder_count = 2;
        const struct study_order *order = &judged()->orders[0][0];
        assert_int_equal(order->status, rows[k].outcome);
        const bool own = rows[k].coarse == 320 && rows[k].key == SETTING_n;
        assert_true(order->least == (own ? rows[k].least * finest : 0));
        assert_true(!strstr(order->why, "strangely below") == (rows[k].outcome == FINDING_PASS));
        end();
    }
}

/* With an order, too, a gate bounds the error from below and from above. */
TEST(ordered_gates_have_two_sides)
{
    static const struct {
        double least, bound; /* over the finest error */
        enum finding_status outcome;
    } rows[] = {{0.99, 1.01, FINDING_PASS}, {1.01, 1.02, FINDING_FAIL}, {0.98, 0.99, FINDING_FAIL}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        factor = 0.01;
        begin("sod", NULL, 1, times_factor);
        const double finest = factor * pow(spacing_of(3, 0), 0.5);
        for (int i = 0; i < SETTINGS; i++) study.results[0].settings.value[i].source = SOURCE_CASE;
        file->gates[0] = (struct case_gate){.gate = {0.4, 0.6, rows[k].bound * finest},
                                            .known = {.bound = (double)INFINITY},
                                            .least = rows[k].least * finest};
        file->ladder[0] = 5, file->ladder[1] = study.ladder[study.level_count - 1];
        file->ladder_count = 2;
        assert_int_equal(judged()->orders[0][0].status, rows[k].outcome);
        end();
    }
}

/* Conservation: the worst replicate of the finest level counts. */
static double drifts[LEVELS][2];

static void set_drifts(json_t *run, size_t c, size_t l, size_t r)
{
    (void)c;
    json_object_set_new(run, "conservation",
                        json_pack("{s:f, s:n}", "momentum", drifts[l][r], "angular_momentum"));
}

TEST(what_is_conserved_has_gates)
{
    static const struct {
        double first, second, bound;
        enum finding_status outcome;
    } rows[] = {{1e-9, 2e-9, 3e-9, FINDING_PASS},
                {1e-9, 4e-9, 3e-9, FINDING_FAIL},
                {4e-9, 1e-9, 3e-9, FINDING_FAIL},
                {(double)NAN, 1e-9, 3e-9, FINDING_FAIL},
                {0, 0, 3e-9, FINDING_PASS}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const bool nothing = isnan(rows[k].first);
        drifts[LEVELS - 1][0] = rows[k].first, drifts[LEVELS - 1][1] = rows[k].second;
        begin("sod", NULL, 2, nothing ? NULL : set_drifts);
        file->gates[0] = (struct case_gate){.functional = trace_figures[1],
                                            .gate = {0, (double)INFINITY, rows[k].bound}};
        file->gates[1] =
            (struct case_gate){.functional = trace_figures[2], .gate = {0, (double)INFINITY, 1}};
        file->gate_count = 2;
        const struct study_result *result = judged();
        assert_int_equal(result->kept[1].status, rows[k].outcome);
        assert_int_equal(result->kept[2].status, FINDING_FAIL); /* null is not a number */
        assert_int_equal(result->kept[0].status, FINDING_NONE);
        json_t *run = json_pack("{s:i, s:{s:f}}", "n", 320, "conservation", "momentum",
                                fmax(rows[k].first, rows[k].second));
        json_t *gate = gates_error(file, &file->gates[0], run);
        assert_string_equal(json_string_value(json_object_get(gate, "status")),
                            finding_words[nothing ? FINDING_PASS : rows[k].outcome]);
        json_decref(gate);
        json_decref(run);
        end();
    }
}

static double exact_errors[LEVELS];

static void set_errors(json_t *run, size_t c, size_t l, size_t r)
{
    (void)c, (void)r;
    json_object_set_new(json_object_get(json_object_get(run, "errors"), "density"), "l1",
                        json_real(exact_errors[l]));
}

/* A missed order is explained by errors up to twenty floors: that of the density and, with the
 * standard gradient, that of the gradient. */
TEST(floors_explain_up_to_a_point)
{
    for (int standard = 0; standard < 2; standard++)
        for (int side = -1; side <= 2; side++) {
            const char *keys = standard ? "kernel=cubic_spline,eta=4.8,gradient=standard"
                                        : "kernel=cubic_spline,eta=4.8,gradient=ia";
            struct kernel kernel;
            double density, gradient;
            assert_int_equal(kernel_select(&kernel, "cubic_spline", 0, &error), STATUS_OK);
            measure_lattice(&kernel, 1, 4.8, &density, &gradient);
            assert_true(fabs(gradient) > 2 * fabs(density));
            const double most = 20 * fabs(standard ? gradient : density);
            /* side 2: an order at its limit, and an error that is too large */
            for (size_t l = 0; l < LEVELS; l++)
                exact_errors[l] = most * (1 + 1e-9 * (side % 2)) * pow(2, 0.5 * (double)(3 - l));
            begin("sod", keys, 1, set_errors);
            const double order = judged()->orders[0][0].fit.order;
            end();
            begin("sod", keys, 1, set_errors);
            file->gates[0] = (struct case_gate){.gate = {0.6, 0.7, 1}};
            if (side == 2)
                file->gates[0].gate = (struct order_gate){order, order + 0.1, exact_errors[3] / 2};
            const struct study_result *result = judged();
            assert_int_equal(result->orders[0][0].status, FINDING_FAIL);
            assert_true(result->floor_explains == (side < 1));
            end();
        }
}

/* A floor of 0 explains nothing, however small the error. */
TEST(floor_of_0_explains_nothing)
{
    for (size_t l = 0; l < LEVELS; l++) exact_errors[l] = 1e-8 * pow(2, 0.5 * (double)(3 - l));
    begin("sod", "kernel=quadratic_spline,eta=1.5,gradient=ia", 1, set_errors);
    file->gates[0] = (struct case_gate){.gate = {0.6, 0.7, 1}};
    const struct study_result *result = judged();
    assert_true(fabs(result->floor_density) < 1e-10);
    assert_int_equal(result->orders[0][0].status, FINDING_FAIL);
    assert_false(result->floor_explains);
    end();
}

/* A passed gate is reported as a pass only if the run is fine enough and the order is known well
 * enough: not at the coarsest level of the case's ladder with a raised bound, nor with a bound
 * above a quarter of the exact value, nor with an interval of the order wider than its gate. A
 * bound alone asks for no order. */
TEST(coarse_passes_are_undetermined)
{
    const double open = (double)INFINITY, none = (double)NAN;
    const struct {
        double low, high, bound, exact, half; /* half: of the order's interval; < 0: one run */
        size_t n;
        enum finding_status outcome;
    } rows[] = {
        {0.9, 1.1, 1, none, 0.09, 101, FINDING_PASS},
        {0.9, 1.1, 1, none, 0.09, 100, FINDING_SMOKE},
        {0.9, 1.1, 1, none, 0.09, 50, FINDING_SMOKE},
        {0.9, 1.1, 1, none, 0.11, 101, FINDING_UNDETERMINED},
        {-0.1, 0.1, 1, none, 0.09, 101, FINDING_PASS},
        {-0.1, 0.1, 1, none, 0.09, 100, FINDING_SMOKE},
        {-0.1, 0.1, 1, none, 0.11, 101, FINDING_UNDETERMINED},
        {0.9, 1.1, 1, none, none, 101, FINDING_UNDETERMINED},
        {1, open, 1, none, 0.49, 101, FINDING_PASS},
        /* a bound alone, however badly the order is known */
        {1, open, 1, none, 3, 101, FINDING_PASS},
        {1, open, 1, none, none, 101, FINDING_PASS},
        {1, open, 1, none, 0.49, 100, FINDING_SMOKE},
        {1, open, 1, none, -1, 101, FINDING_PASS},
        {1, open, 1, none, -1, 100, FINDING_SMOKE},
        /* a bound for all n, without an order */
        {0, open, 1, none, 3, 100, FINDING_PASS},
        /* a bound and the exact value, of either sign; an exact value of 0 is not compared */
        {1, open, 1, 4.01, 0.1, 101, FINDING_PASS},
        {1, open, 1, -4.01, 0.1, 101, FINDING_PASS},
        {1, open, 1, 3.99, 0.1, 101, FINDING_SMOKE},
        {0, open, 1, -3.99, -1, 101, FINDING_SMOKE},
        {1, open, 1, 0, 0.1, 101, FINDING_PASS},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct case_file usual = {.ladder = {100, 200}, .ladder_count = 2};
        const struct case_file alone = {.dimension = 1};
        const struct order_gate gate = {rows[k].low, rows[k].high, rows[k].bound};
        const struct order_fit fit = {.low = 1 - rows[k].half, .high = 1 + rows[k].half};
        const struct order_fit *of = rows[k].half < 0 ? NULL : &fit;
        char why[GATE_WHY] = "?";
        const enum finding_status outcome =
            gates_weigh(&usual, &gate, rows[k].n, rows[k].exact, of, why);
        if (outcome != rows[k].outcome) fail_msg("row %zu: outcome %d, %s", k, outcome, why);
        assert_int_equal(!why[0], outcome == FINDING_PASS);
        if (outcome == FINDING_SMOKE) assert_non_null(strstr(why, "too coarse to say"));
        if (outcome == FINDING_UNDETERMINED) assert_non_null(strstr(why, "is known to"));
        /* a case without a ladder has no coarsest level */
        if (rows[k].n == 100 && rows[k].half < 0)
            assert_int_equal(gates_weigh(&alone, &gate, 100, rows[k].exact, of, why), FINDING_PASS);
    }
}

/* A study, and a single run, that are too coarse have status smoke, with the reason, and fail
 * nothing; an error beyond the bound fails at any n. */
TEST(coarse_runs_are_smoke)
{
    for (int beyond = 0; beyond < 2; beyond++) {
        factor = 0.01;
        begin("sod", NULL, 1, times_factor);
        file->gates[0] = (struct case_gate){.gate = {1, (double)INFINITY, beyond ? 1e-9 : 1}};
        file->ladder_count = 1;
        file->ladder[0] = 320; /* the finest of this study */
        const struct study_order *order = &judged()->orders[0][0];
        assert_int_equal(order->status, beyond ? FINDING_FAIL : FINDING_SMOKE);
        assert_int_equal(study.status, beyond ? STATUS_CHECK_FAILED : STATUS_OK);
        json_t *run = json_pack("{s:i, s:{s:{s:f}}}", "n", 320, "errors", "density", "l1", 0.5);
        json_t *list = json_array();
        gates_add_errors(file, run, list);
        json_t *gate = json_array_get(list, 0);
        assert_string_equal(json_string_value(json_object_get(gate, "status")),
                            beyond ? "fail" : "smoke");
        assert_int_equal(!json_object_get(gate, "why"), beyond);
        json_decref(list);
        /* one particle more than at the coarsest level: judged */
        json_object_set_new(run, "n", json_integer(321));
        list = json_array();
        gates_add_errors(file, run, list);
        assert_string_equal(json_string_value(json_object_get(json_array_get(list, 0), "status")),
                            beyond ? "fail" : "pass");
        json_decref(list);
        json_decref(run);
        end();
    }
}
