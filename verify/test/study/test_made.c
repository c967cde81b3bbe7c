/* SPDX-License-Identifier: GPL-3.0-or-later
 * Studies of made-up runs: nothing is simulated, every run says numbers that a formula gives, and
 * all that a study makes of them (means, spreads, orders, gates, functionals, budgets, and each
 * number of its document) is computed here a second time. */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "measure.h"
#include "near.h"
#include "problem_list.h"
#include "result.h"
#include "study.h"
#include "value.h"

enum { LEVELS = 5, FUNCTIONALS = 2 };

/* A number of its own for everything that a run says: near 1, and no two alike. */
static double draw(unsigned a, unsigned b, unsigned c)
{
    const double x = sin(12.9898 * (a + 1.) + 78.233 * (b + 1.) + 37.719 * (c + 1.)) * 43758.5453;
    return 1 + 0.1 * (x - floor(x));
}

/* Which run: combination, level, replicate; what of it. */
struct which {
    size_t c, l, r, n;
};

static unsigned run_number(const struct which *at)
{
    return (unsigned)(100 * at->c + 10 * at->l + at->r);
}

static double spacing_of(const struct which *at)
{
    return 2 / (double)at->n;
}

/* The same error everywhere; 0: errors as they are. */
static double flat;

static double error_of(const struct which *at, unsigned field, unsigned norm)
{
    if (flat > 0) return flat * (1 + 1e-6 * draw(run_number(at), field, norm));
    return (0.3 + field + 0.1 * norm) * pow(spacing_of(at), 1 + 0.25 * field) *
           draw(run_number(at), field, norm);
}

static double region_of(const struct which *at, unsigned region, unsigned field)
{
    return (0.1 + region) * pow(spacing_of(at), 1.5) * draw(run_number(at), 20 + region, field);
}

static double still_of(const struct which *at)
{
    return 1e-4 * draw(run_number(at), 30, 0);
}

static const double exact_value[FUNCTIONALS] = {0.7, (double)NAN};

static double functional_of(const struct which *at, unsigned i)
{
    return 0.7 + (0.2 + i) * pow(spacing_of(at), 2) * (1 + 1e-3 * draw(run_number(at), 40, i));
}

static void put(json_t *object, const char *name, double value)
{
    json_object_set_new(object, name, result_number(value));
}

static json_t *norms_made(const struct which *at, unsigned what)
{
    json_t *norms = json_object();
    for (unsigned m = 0; m < NORMS; m++)
        put(norms, field_norm_family.members[m]->name, error_of(at, what, m));
    return norms;
}

static json_t *functionals_made(const struct which *at, const struct problem *problem)
{
    json_t *list = json_array();
    for (unsigned i = 0; i < FUNCTIONALS; i++)
        json_array_append_new(list,
                              json_pack("{s:s, s:o, s:o}", "name", problem->functionals[i]->name,
                                        "value", result_number(functional_of(at, i)), "reference",
                                        result_number(exact_value[i])));
    return list;
}

/* What `sphproof run` says, as far as a study reads it. */
static json_t *run_made(const struct which *at, const struct problem *problem, int dim)
{
    json_t *run = json_object(), *errors = json_object(), *cost = json_object();
    put(run, "n", (double)at->n);
    put(run, "spacing", spacing_of(at));
    put(run, "h", 2 * spacing_of(at) * draw(run_number(at), 50, 0));
    for (unsigned f = 0; f < FIELDS; f++)
        json_object_set_new(errors, field_family.members[f]->name, norms_made(at, f));
    for (unsigned part = 0; part < STUDY_PARTS && dim > 1; part++)
        json_object_set_new(errors, study_part_names[part], norms_made(at, 5 + part));
    put(errors, "binned_density_l1", dim > 1 ? (double)NAN : error_of(at, 8, 0));
    json_object_set_new(run, "errors", errors);
    put(cost, "cpu_s", draw(run_number(at), 51, 0));
    json_object_set_new(run, "cost", cost);
    json_t *budget = json_object();
    const struct regions *regions = problem->regions;
    for (unsigned r = 0; regions && regions->names[r]; r++) {
        json_t *region = json_object();
        for (unsigned f = 0; f < FIELDS; f++)
            put(region, field_family.members[f]->name, region_of(at, r, f));
        json_object_set_new(budget, regions->names[r], region);
    }
    put(budget, "still", still_of(at));
    json_object_set_new(run, "budget", budget);
    json_object_set_new(run, "functionals", functionals_made(at, problem));
    return run;
}

/* Combinations that say the same. */
static size_t own(size_t c)
{
    return c;
}
static size_t (*stands_for)(size_t c) = own;

static const size_t ladder[LEVELS] = {100, 180, 260, 400, 600};

static struct which at(const struct study *study, size_t c, size_t l, size_t r)
{
    const struct run *run = &study->runs[(c * LEVELS + l) * study->replicates + r];
    return (struct which){stands_for(c), l, r, (size_t)settings_real(&run->settings, SETTING_n)};
}

/* What a job says instead, at the second level's first run of a combination. */
static enum status trouble;
static const size_t troubled = 1;

static enum status make(struct study *study, const char *name, const char *vary, size_t replicates,
                        struct error *error)
{
    struct pool pool = {0};
    *study = (struct study){.level_count = LEVELS, .replicates = replicates};
    memcpy(study->ladder, ladder, sizeof ladder);
    if (run_prepare(&study->settings, name, 0, NULL, error) ||
        sweep_parse(&study->sweep, vary, error) || study_plan(study, &pool, error))
        fail_msg("%s", error->message);
    const struct problem *problem = problem_of(&study->settings.settings);
    size_t runs = 0;
    for (size_t c = 0; c < study->sweep.count; c++)
        for (size_t l = 0; l < LEVELS; l++)
            for (size_t r = 0; r < replicates && !study->results[c].excluded; r++, runs++) {
                const struct which which = at(study, c, l, r);
                struct pool_job *job = &pool.jobs[study->jobs[(c * LEVELS + l) * replicates + r]];
                assert_null(job->document);
                if (trouble && l == 1 && r == 0 && c == troubled)
                    error_set(&job->error, trouble, "trouble");
                else
                    job->document = run_made(&which, problem, study->settings.file.dimension);
            }
    assert_int_equal(pool.count, runs);
    const enum status status = study_judge(study, &pool, error);
    pool_free(&pool);
    return status;
}

static struct study made(const char *name, const char *vary, size_t replicates)
{
    struct study study;
    struct error error = {0};
    if (make(&study, name, vary, replicates, &error)) fail_msg("%s", error.message);
    return study;
}

/* Of the logarithms of x and y at the replicates of a level. */
struct sums {
    double x, y, xx, xy, yy;
};

static struct sums sums_of(const struct study *study, size_t c, size_t l, unsigned what,
                           unsigned norm)
{
    struct sums sums = {0};
    for (size_t r = 0; r < study->replicates; r++) {
        const struct which which = at(study, c, l, r);
        const double x = log(spacing_of(&which)), y = log(error_of(&which, what, norm));
        sums.x += x, sums.y += y, sums.xx += x * x, sums.xy += x * y, sums.yy += y * y;
    }
    return sums;
}

/* Variance of what the replicates scatter about a line of the ladder's slope. */
static double variance_of(const struct study *study, size_t c, size_t l, unsigned f, unsigned m)
{
    const double n = (double)study->replicates;
    const struct sums first = sums_of(study, c, 0, f, m), s = sums_of(study, c, l, f, m),
                      last = sums_of(study, c, LEVELS - 1, f, m);
    const double p = (last.y - first.y) / (last.x - first.x);
    const double xx = s.xx - s.x * s.x / n, xy = s.xy - s.x * s.y / n, yy = s.yy - s.y * s.y / n;
    return n > 1 ? (yy - 2 * p * xy + p * p * xx) / (n - 1) : 0;
}

static void same_fit(const struct order_fit *fit, const struct order_fit *want)
{
    near_relative(fit->order, want->order, 1e-9);
    near_relative(fit->low, want->low, 1e-6);
    near_relative(fit->high, want->high, 1e-6);
    assert_int_equal(fit->n, want->n);
    assert_int_equal(fit->class, want->class);
}

static void levels_and_orders(const struct study *study, size_t c)
{
    const struct study_result *result = &study->results[c];
    const double replicates = (double)study->replicates;
    double spacing[LEVELS];
    assert_int_equal(result->level_count, LEVELS);
    for (size_t l = 0; l < LEVELS; l++) spacing[l] = exp(sums_of(study, c, l, 0, 0).x / replicates);
    for (unsigned f = 0; f < FIELDS; f++)
        for (unsigned m = 0; m < NORMS; m++) {
            double errors[LEVELS], variance[LEVELS];
            const struct order_noise noise = {variance, study->replicates};
            struct order_fit want;
            for (size_t l = 0; l < LEVELS; l++) {
                const struct study_level *level = &result->levels[l];
                errors[l] = exp(sums_of(study, c, l, f, m).y / replicates);
                variance[l] = variance_of(study, c, l, f, m) / replicates;
                near_relative(level->spacing, spacing[l], 1e-12);
                near_relative(level->errors[f][m], errors[l], 1e-12);
                if (replicates > 1)
                    near_relative(level->spread[f][m], sqrt(replicates * variance[l]), 1e-6);
                else
                    assert_true(level->spread[f][m] == 0);
            }
            assert_int_equal(
                order_fit(LEVELS, spacing, errors, replicates > 1 ? &noise : NULL, &want, NULL),
                STATUS_OK);
            same_fit(&result->orders[f][m].fit, &want);
        }
}

static void means(const struct study *study, size_t c)
{
    for (size_t l = 0; l < LEVELS; l++) {
        const struct study_level *level = &study->results[c].levels[l];
        const bool line = study->settings.file.dimension == 1;
        const double replicates = (double)study->replicates;
        double h = 0, cpu = 0, binned = 0, functionals[FUNCTIONALS] = {0};
        size_t least = SIZE_MAX, most = 0;
        for (size_t r = 0; r < study->replicates; r++) {
            const struct which which = at(study, c, l, r);
            h += 2 * spacing_of(&which) * draw(run_number(&which), 50, 0) / replicates;
            cpu += draw(run_number(&which), 51, 0) / replicates;
            binned += log(error_of(&which, 8, 0)) / replicates;
            for (unsigned i = 0; i < FUNCTIONALS; i++)
                functionals[i] += functional_of(&which, i) / replicates;
            least = which.n < least ? which.n : least;
            most = which.n > most ? which.n : most;
        }
        near_relative(level->h, h, 1e-12);
        near_relative(level->cpu_s, cpu, 1e-12);
        if (line) near_relative(level->binned_density_l1, exp(binned), 1e-12);
        for (unsigned i = 0; i < FUNCTIONALS; i++)
            near_relative(level->functionals[i], functionals[i], 1e-13);
        assert_int_equal(level->n, at(study, c, l, 0).n);
        assert_true(level->n_range[0] == least && level->n_range[1] == most);
    }
}

static void budgets(const struct study *study, size_t c)
{
    const struct study_result *result = &study->results[c];
    const struct regions *regions = problem_of(&result->settings)->regions;
    double spacing[LEVELS], still = 0;
    for (size_t l = 0; l < LEVELS; l++)
        spacing[l] = exp(sums_of(study, c, l, 0, 0).x / (double)study->replicates);
    for (unsigned region = 0; regions && regions->names[region]; region++) {
        double part[LEVELS] = {0};
        struct order_fit want;
        for (size_t l = 0; l < LEVELS; l++) {
            for (size_t r = 0; r < study->replicates; r++) {
                const struct which which = at(study, c, l, r);
                part[l] += region_of(&which, region, FIELD_DENSITY) / (double)study->replicates;
                still = fmax(still, still_of(&which));
            }
            near_relative(result->levels[l].budget.l1[region][FIELD_DENSITY], part[l], 1e-12);
        }
        assert_int_equal(order_fit(LEVELS, spacing, part, NULL, &want, NULL), STATUS_OK);
        same_fit(&result->regions[region], &want);
    }
    if (regions) assert_true(result->still == still && result->still_status == FINDING_PASS);
}

static void functionals(const struct study *study, size_t c)
{
    const struct study_result *result = &study->results[c];
    const struct study_level *last = &result->levels[LEVELS - 3];
    assert_int_equal(result->functional_count, FUNCTIONALS);
    for (size_t i = 0; i < FUNCTIONALS; i++) {
        const struct order_extrapolation want = order_extrapolate(
            (double[]){last[0].spacing, last[1].spacing, last[2].spacing},
            (double[]){last[0].functionals[i], last[1].functionals[i], last[2].functionals[i]},
            exact_value[i]);
        assert_string_equal(result->functional_names[i],
                            problem_of(&result->settings)->functionals[i]->name);
        near_relative(result->functionals[i].value, want.value, 1e-14);
        near_relative(result->functionals[i].gci_coarse, want.gci_coarse, 1e-14);
        assert_int_equal(result->functionals[i].class, ORDER_ASYMPTOTIC);
    }
}

/* A gate's bound belongs to the case's own finest level; with fewer particles it is raised by what
 * the least order that is allowed makes of their distance. */
static void gates(const struct study *study, size_t c)
{
    const struct case_file *file = &study->settings.file;
    bool gated[FIELDS][NORMS] = {0};
    for (size_t i = 0; i < file->gate_count; i++) {
        const struct case_gate *gate = &file->gates[i];
        const bool scalar = gate->functional != NULL; /* the first is exact, see exact_value */
        const struct study_result *result = &study->results[c];
        const struct study_order *order =
            scalar ? &result->functional_errors[0] : &result->orders[gate->field][gate->norm];
        if (scalar && strcmp(gate->functional, result->functional_names[0]) != 0) {
            assert_int_equal(result->functional_errors[1].status, FINDING_NONE); /* nothing exact */
            continue;
        }
        const double finest = (double)at(study, c, LEVELS - 1, 0).n,
                     cases = (double)file->ladder[file->ladder_count - 1],
                     wider = pow(cases / finest, 1. / file->dimension);
        if (!scalar) gated[gate->field][gate->norm] = true;
        near_relative(order->gate.bound, gate->gate.bound * pow(fmax(1, wider), gate->gate.low),
                      1e-12);
        assert_true(order->gate.low == (scalar ? (double)-INFINITY : gate->gate.low) &&
                    order->gate.high == gate->gate.high);
        if (scalar)
            assert_int_equal(order->fit.finest <= order->gate.bound, order->status != FINDING_FAIL);
        else
            assert_int_equal(order_passes(&order->fit, &order->gate, NULL),
                             order->status != FINDING_FAIL);
    }
    for (int f = 0; f < FIELDS; f++)
        for (int m = 0; m < NORMS; m++)
            assert_int_equal(!gated[f][m], study->results[c].orders[f][m].status == FINDING_NONE);
}

/* ---- the document ---- */

static void is(const json_t *object, const char *name, double value)
{
    const double got = value_member(object, name);
    if (!(got == value || (isnan(got) && isnan(value))))
        fail_msg("%s is %.17g, not %.17g", name, got, value);
}

static void norms_are(const json_t *norms, const double *values)
{
    assert_int_equal(json_object_size(norms), NORMS);
    for (int m = 0; m < NORMS; m++) is(norms, field_norm_family.members[m]->name, values[m]);
}

static void level_says(const struct study *study, const json_t *json,
                       const struct study_level *level)
{
    const json_t *errors = json_object_get(json, "errors");
    const json_t *budget = json_object_get(json, "budget"),
                 *spread = json_object_get(json, "spread");
    const bool line = study->settings.file.dimension == 1;
    is(json, "n", (double)level->n);
    is(json, "h", level->h);
    is(json, "spacing", level->spacing);
    is(json, "cpu_s", level->cpu_s);
    is(json, "replicates", (double)study->replicates);
    for (int f = 0; f < FIELDS; f++) {
        norms_are(json_object_get(errors, field_family.members[f]->name), level->errors[f]);
        if (spread)
            norms_are(json_object_get(spread, field_family.members[f]->name), level->spread[f]);
    }
    assert_int_equal(!spread, study->replicates == 1);
    for (int part = 0; part < STUDY_PARTS; part++) {
        const json_t *norms = json_object_get(errors, study_part_names[part]);
        assert_int_equal(!norms, line);
        if (norms) norms_are(norms, level->parts[part]);
    }
    assert_int_equal(json_is_null(json_object_get(errors, "binned_density_l1")), !line);
    if (line) is(errors, "binned_density_l1", level->binned_density_l1);
    if (spread)
        for (size_t i = 0; i < 2; i++)
            assert_int_equal(
                json_integer_value(json_array_get(json_object_get(json, "n_range"), i)),
                level->n_range[i]);
    const struct regions *regions = level->budget.regions;
    assert_int_equal(json_is_null(budget), !regions);
    for (size_t r = 0; regions && regions->names[r]; r++)
        for (int f = 0; f < FIELDS; f++)
            is(json_object_get(budget, regions->names[r]), field_family.members[f]->name,
               level->budget.l1[r][f]);
}

static void fit_says(const json_t *json, const struct order_fit *fit, const char *what,
                     const char *norm)
{
    const json_t *pairwise = json_object_get(json, "pairwise");
    assert_string_equal(value_text(json, "field"), what);
    assert_string_equal(value_text(json, "norm"), norm);
    is(json, "order", fit->order);
    is(json, "low", fit->low);
    is(json, "high", fit->high);
    assert_string_equal(value_text(json, "class"), order_class_name(fit->class));
    assert_int_equal(json_array_size(pairwise), LEVELS - 1);
    for (size_t i = 0; i + 1 < LEVELS; i++)
        assert_true(value_real(json_array_get(pairwise, i)) == fit->pairwise[i]);
}

static void order_says(const json_t *json, const struct study_order *order, const char *what,
                       const char *norm)
{
    static const char *const names[] = {"none", "pass", "fail", "known", "smoke", "undetermined"};
    const json_t *gate = json_object_get(json, "gate"), *why = json_object_get(json, "why");
    fit_says(json, &order->fit, what, norm);
    assert_string_equal(value_text(json, "status"), names[order->status]);
    assert_int_equal(json_is_null(gate), order->status == FINDING_NONE);
    if (order->status != FINDING_NONE) {
        is(gate, "low", order->gate.low);
        is(gate, "high", order->gate.high);
        is(gate, "bound", order->gate.bound);
    }
    assert_int_equal(!why, order->status == FINDING_NONE || order->status == FINDING_PASS);
    if (why) assert_string_equal(json_string_value(why), order->why);
    assert_int_equal(!json_object_get(json, "known"), order->status != FINDING_KNOWN);
}

static void budget_says(const json_t *json, const struct study_result *result)
{
    const struct study_level *finest = &result->levels[LEVELS - 1];
    const struct regions *regions = finest->budget.regions;
    const json_t *still = json_object_get(json, "still_gas");
    double whole = 0;
    size_t count = 0;
    for (; regions->names[count]; count++) whole += finest->budget.l1[count][FIELD_DENSITY];
    assert_int_equal(json_array_size(json_object_get(json, "regions")), count);
    for (size_t r = 0; r < count; r++) {
        const json_t *region = json_array_get(json_object_get(json, "regions"), r);
        assert_string_equal(value_text(region, "region"), regions->names[r]);
        is(region, "l1", finest->budget.l1[r][FIELD_DENSITY]);
        near_relative(value_member(region, "share"), finest->budget.l1[r][FIELD_DENSITY] / whole,
                      1e-14);
        is(region, "order", result->regions[r].order);
        is(region, "low", result->regions[r].low);
        is(region, "high", result->regions[r].high);
    }
    is(still, "value", result->still);
    is(still, "bound", STUDY_STILL_BOUND);
    assert_string_equal(value_text(still, "status"), "pass");
}

static void functional_says(const json_t *json, const struct study_result *result, size_t i)
{
    const struct order_extrapolation *e = &result->functionals[i];
    const json_t *values = json_object_get(json, "values");
    assert_string_equal(value_text(json, "name"), result->functional_names[i]);
    assert_int_equal(json_array_size(values), LEVELS);
    for (size_t l = 0; l < LEVELS; l++)
        assert_true(value_real(json_array_get(values, l)) == result->levels[l].functionals[i]);
    is(json, "extrapolated", e->value);
    is(json, "gci", e->gci_fine);
    is(json, "gci_coarse", e->gci_coarse);
    is(json, "order", e->order);
    is(json, "exact", result->functional_exact[i]);
    assert_string_equal(value_text(json, "class"), order_class_name(e->class));
}

static void floor_says(const json_t *json, const struct study_result *result)
{
    double density, gradient;
    measure_lattice(&result->scheme.kernel, result->settings.dim, result->scheme.eta, &density,
                    &gradient);
    assert_string_equal(value_text(json, "kernel"), result->scheme.kernel.member.name);
    is(json, "eta", result->scheme.eta);
    is(json, "density", density);
    is(json, "gradient", gradient);
    assert_int_equal(json_is_true(json_object_get(json, "explains")), result->floor_explains);
    assert_string_equal(value_text(json, "suspicion"), result->suspicion);
}

/* Every number of the document, in the order of combinations; what varies stands at each entry. */
static void document(const struct study *study)
{
    json_t *json = json_object();
    study_add_json(study, json);
    const json_t *orders = json_object_get(json, "orders");
    const bool cloud = study->settings.file.dimension > 1;
    size_t order = 0, budget = 0;
    is(json, "dimension", study->settings.file.dimension);
    for (size_t c = 0; c < study->sweep.count; c++) {
        const struct study_result *result = &study->results[c];
        json_t *varied = sweep_json(&study->sweep, c);
        for (size_t l = 0; l < LEVELS; l++) {
            const json_t *level = json_array_get(json_object_get(json, "levels"), c * LEVELS + l);
            level_says(study, level, &result->levels[l]);
            if (study->sweep.key_count)
                assert_true(json_equal(json_object_get(level, "settings"), varied));
            else
                assert_null(json_object_get(level, "settings"));
        }
        for (int f = 0; f < FIELDS; f++)
            for (int m = 0; m < NORMS; m++)
                order_says(json_array_get(orders, order++), &result->orders[f][m],
                           field_family.members[f]->name, field_norm_family.members[m]->name);
        for (int part = 0; part < STUDY_PARTS && cloud; part++)
            fit_says(json_array_get(orders, order++), &result->parts[part], study_part_names[part],
                     "l1");
        if (cloud)
            fit_says(json_array_get(orders, order++), &result->functional_errors[0].fit,
                     result->functional_names[0], "error");
        for (size_t i = 0; i < FUNCTIONALS; i++)
            functional_says(
                json_array_get(json_object_get(json, "functionals"), c * FUNCTIONALS + i), result,
                i);
        floor_says(json_array_get(json_object_get(json, "floors"), c), result);
        if (problem_of(&result->settings)->regions)
            budget_says(json_array_get(json_object_get(json, "budgets"), budget++), result);
        json_decref(varied);
    }
    assert_int_equal(json_array_size(orders), order);
    assert_int_equal(json_array_size(json_object_get(json, "budgets")), budget);
    assert_int_equal(json_array_size(json_object_get(json, "excluded")), 0);
    assert_null(json_object_get(json, "message"));
    assert_null(json_object_get(json, "suspicion"));
    json_decref(json);
}

static void everything(const char *name, const char *vary, size_t replicates)
{
    struct study study = made(name, vary, replicates);
    for (size_t c = 0; c < study.sweep.count; c++) {
        levels_and_orders(&study, c);
        means(&study, c);
        budgets(&study, c);
        functionals(&study, c);
        gates(&study, c);
    }
    document(&study);
    study_free(&study);
}

TEST(one_scheme)
{
    everything("sod", NULL, 1);
}

TEST(replicates)
{
    everything("sod", NULL, 4);
}

TEST(combinations)
{
    everything("sod", "alpha=1,1.5,eta=1.5,2,2.5", 2);
}

/* In 2D: parts of the velocity, orders of functionals that are known, no bins and no budget. */
TEST(circular)
{
    struct study study = made("gresho", "alpha=1,1.5", 2);
    for (size_t c = 0; c < 2; c++) {
        const struct study_result *result = &study.results[c];
        double spacing[LEVELS], errors[LEVELS];
        struct order_fit want;
        levels_and_orders(&study, c);
        means(&study, c);
        functionals(&study, c);
        gates(&study, c);
        for (size_t l = 0; l < LEVELS; l++) spacing[l] = exp(sums_of(&study, c, l, 0, 0).x / 2);
        for (unsigned part = 0; part < STUDY_PARTS; part++) {
            for (unsigned m = 0; m < NORMS; m++)
                for (size_t l = 0; l < LEVELS; l++)
                    near_relative(result->levels[l].parts[part][m],
                                  exp(sums_of(&study, c, l, 5 + part, m).y / 2), 1e-12);
            for (size_t l = 0; l < LEVELS; l++)
                errors[l] = exp(sums_of(&study, c, l, 5 + part, NORM_L1).y / 2);
            assert_int_equal(order_fit(LEVELS, spacing, errors, NULL, &want, NULL), STATUS_OK);
            same_fit(&result->parts[part], &want);
        }
        for (size_t l = 0; l < LEVELS; l++)
            errors[l] = result->levels[l].functionals[0] - exact_value[0];
        assert_int_equal(order_fit(LEVELS, spacing, errors, NULL, &want, NULL), STATUS_OK);
        same_fit(&result->functional_errors[0].fit, &want);
        assert_int_equal(result->functional_errors[1].fit.n, 0);
    }
    document(&study);
    study_free(&study);
}

/* ---- settings without effect, combinations that are not allowed, runs that fail ---- */

static size_t by_eta(size_t c) /* of alpha=,, eta=,, */
{
    return c % 3;
}

static size_t by_alpha(size_t c)
{
    return c / 3;
}

static size_t by_eta_but_once(size_t c)
{
    return c == 3 ? 9 : c % 3;
}

static size_t all_alike(size_t c)
{
    (void)c;
    return 0;
}

/* A key is suspected where no pair of combinations that differ in it alone differs in its errors.
 */
TEST(idle_keys)
{
    static const struct {
        size_t (*same)(size_t c);
        const char *vary, *idle;
    } cases[] = {
        {own, "alpha=1,1.5,eta=1.5,2,2.5", ""},
        {by_eta, "alpha=1,1.5,eta=1.5,2,2.5", "changing alpha "},
        {by_alpha, "alpha=1,1.5,eta=1.5,2,2.5", "changing eta "},
        {by_eta_but_once, "alpha=1,1.5,eta=1.5,2,2.5", ""},
        /* nothing is compared with a combination that the scheme does not allow */
        {by_eta, "alpha=1,1.5,eta=0.5,2,2.5", "changing alpha "},
        {by_alpha, "alpha=1,1.5,eta=1.5,0.5,2.5", ""},
        {by_alpha, "alpha=1,1.5,eta=1.5,2,0.5", "changing eta "},
        /* keys that no such scheme reads */
        {all_alike, "skip=auto,none", ""},
        {all_alike, "viscosity=none,alpha=1,1.5", ""},
        {all_alike, "viscosity=time_dependent,alpha=1,1.5", ""},
        {all_alike, "viscosity=time_dependent,alpha_max=1,1.5", "changing alpha_max "},
        {all_alike, "alpha_max=1,1.5", ""},
        {all_alike, "beta=1,1.5", "changing beta "},
        {all_alike, "kernel=sinc,sinc_n=3,5", "changing sinc_n "},
        {all_alike, "kernel=cubic_spline,sinc_n=3,5", ""},
        {all_alike, "grade_ratio=1.1,1.2", ""},
        {all_alike, "grade=0.5,grade_ratio=1.1,1.2", "changing grade_ratio "},
        {all_alike, "h_method=newton,h_tolerance=1e-9,1e-8", "changing h_tolerance "},
        {all_alike, "h_method=predicted,h_tolerance=1e-9,1e-8", ""},
        {all_alike, "seed=1,2", ""},
        {all_alike, "jitter=0.1,seed=1,2", "changing seed "},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        stands_for = cases[i].same;
        struct study study = made("sod", cases[i].vary, 1);
        stands_for = own;
        if (strncmp(study.suspicion, cases[i].idle, strlen(cases[i].idle)) != 0 ||
            !*study.suspicion != !*cases[i].idle)
            fail_msg("%s: '%s', not '%s'", cases[i].vary, study.suspicion, cases[i].idle);
        json_t *json = json_object();
        study_add_json(&study, json);
        assert_string_equal(value_text(json, "suspicion"), study.suspicion);
        if (*study.suspicion) assert_int_equal(study.status, STATUS_CHECK_FAILED);
        json_decref(json);
        study_free(&study);
    }
}

TEST(not_allowed)
{
    struct study study = made("sod", "alpha=1,1.5,eta=0.5,2", 2);
    json_t *json = json_object();
    study_add_json(&study, json);
    const json_t *excluded = json_object_get(json, "excluded");
    assert_int_equal(json_array_size(json_object_get(json, "levels")), 2 * LEVELS);
    assert_int_equal(json_array_size(excluded), 2);
    for (size_t i = 0; i < 2; i++) {
        const json_t *entry = json_array_get(excluded, i);
        json_t *varied = sweep_json(&study.sweep, 2 * i);
        assert_true(study.results[2 * i].excluded && !study.results[2 * i + 1].excluded);
        assert_non_null(strstr(value_text(entry, "reason"), "eta"));
        assert_true(json_equal(json_object_get(entry, "settings"), varied));
        json_decref(varied);
    }
    json_decref(json);
    study_free(&study);
}

/* A lost order is the floor's doing where the finest error is at most 20 times the lattice sums are
 * off; of the standard gradient those of the gradient count, too. */
TEST(floors)
{
    for (int side = -1; side <= 1; side += 2)
        for (int standard = 0; standard < 2; standard++) {
            struct kernel kernel;
            double density, gradient;
            assert_int_equal(kernel_select(&kernel, "quadratic_spline", 5, NULL), STATUS_OK);
            measure_lattice(&kernel, 1, 1.75, &density, &gradient);
            assert_true(fabs(gradient) > 1.5 * fabs(density));
            const double floor = fabs(standard ? gradient : density);
            flat = 20 * floor * (1 + 1e-3 * side);
            struct study study =
                made("sod", standard ? "eta=1.75,gradient=standard" : "eta=1.75,gradient=ia", 1);
            flat = 0;
            const struct study_result *result = &study.results[0];
            near_relative(result->floor_density, density, 1e-14);
            near_relative(result->floor_gradient, gradient, 1e-14);
            assert_int_equal(result->orders[FIELD_DENSITY][NORM_L1].status, FINDING_FAIL);
            assert_int_equal(result->floor_explains, side < 0);
            study_free(&study);
        }
}

TEST(failing_runs)
{
    struct study study;
    struct error error = {0};
    trouble = STATUS_BROKE_DOWN;
    assert_int_equal(make(&study, "sod", "alpha=1,1.5,2", 2, &error), STATUS_OK);
    json_t *json = json_object();
    study_add_json(&study, json);
    assert_int_equal(study.status, STATUS_BROKE_DOWN);
    for (size_t c = 0; c < 3; c++) {
        assert_int_equal(study.results[c].level_count, c == troubled ? 1 : LEVELS);
        assert_int_equal(study.results[c].status == STATUS_BROKE_DOWN, c == troubled);
    }
    assert_string_equal(study.results[troubled].message, "n = 180: trouble");
    assert_string_equal(value_text(json, "message"), "n = 180: trouble");
    assert_int_equal(json_array_size(json_object_get(json, "levels")), 2 * LEVELS + 1);
    assert_int_equal(json_array_size(json_object_get(json, "orders")), 2 * FIELDS * NORMS);
    json_decref(json);
    study_free(&study);

    trouble = STATUS_ENVIRONMENT;
    assert_int_equal(make(&study, "sod", "alpha=1,1.5,2", 2, &error), STATUS_ENVIRONMENT);
    assert_string_equal(error.message, "trouble");
    study_free(&study);
    trouble = STATUS_OK;
}
