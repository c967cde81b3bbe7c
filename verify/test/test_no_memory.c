/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests initial states, files, checks and pools of which one allocation fails. */
#include "test.h"

#include <gsl/gsl_qrng.h>
#include <gsl/gsl_rng.h>
#include <unistd.h>

#include "cases.h"
#include "checkpoint.h"
#include "diff.h"
#include "drawn_document.h"
#include "failing_memory.h"
#include "findings.h"
#include "gas.h"
#include "history.h"
#include "initial.h"
#include "line/line.h"
#include "map.h"
#include "page.h"
#include "particle_file.h"
#include "plot.h"
#include "pool.h"
#include "rate_table.h"
#include "regularity.h"
#include "relax.h"
#include "run.h"
#include "snapshots.h"
#include "suite.h"
#include "suite_output.h"
#include "verdict.h"

/* GSL frees these itself, so that they do not count as blocks. */
WRAP(gsl_rng_alloc, (const gsl_rng_type *type), (type), false)
WRAP(gsl_qrng_alloc, (const gsl_qrng_type *type, unsigned dim), (type, dim), false)

/* ---- where particles start ---- */

enum { N = 100 };

static double positions[3][N], unit[N];

static void make_positions(void)
{
    for (int i = 0; i < N; i++) {
        unit[i] = 1;
        for (int d = 0; d < 3; d++)
            positions[d][i] = 10 * fmod((0.618034 + 0.0629 * d) * (i + 1), 1);
    }
}

static enum status fill(struct error *error)
{
    const struct prepared p = {.problem = &gas_problem, .domain = {2, {0, 0}, {1, 1}}};
    const struct settings settings = keyed_settings("n=16 lattice=square");
    struct initial initial = {0};
    const enum status status = initial_fill(&p, &settings, &initial, error);
    initial_free(&initial);
    return status;
}

/* A jittered lattice with equal masses. */
static enum status created(struct error *error)
{
    const struct problem problem = {.sample = gas_sample, .fill = initial_fill};
    const struct prepared p = {.problem = &problem, .domain = {2, {0, 0}, {1, 1}}};
    const struct settings settings = keyed_settings("n=16 lattice=square jitter=0.1");
    struct initial initial;
    const enum status status = initial_create(&initial, &p, &settings, error);
    assert_true(!status || !initial.storage);
    initial_free(&initial);
    return status;
}

static enum status equal(struct error *error)
{
    const struct prepared p = {.problem = &gas_problem, .domain = {2, {0, 0}, {1, 1}}};
    const struct settings settings = keyed_settings("n=4 lattice=random equal_masses=yes");
    struct initial initial = {0};
    const enum status status = initial_fill(&p, &settings, &initial, error);
    initial_free(&initial);
    return status;
}

static double volume(const void *context, const double x[3])
{
    (void)context, (void)x;
    return 1;
}

static enum status relaxed(struct error *error)
{
    const struct relax_region all = {{2, {0, 0}, {10, 10}}, volume, NULL};
    make_positions();
    return relax_points(&all, N, (double *const[]){positions[0], positions[1], positions[2]},
                        error);
}

static enum status relax_measured(struct error *error)
{
    const struct domain box = {2, {0, 0}, {10, 10}};
    struct regularity quality;
    make_positions();
    return relax_measure(&box, N, (const double *const[]){positions[0], positions[1], positions[2]},
                         unit, &quality, error);
}

static enum status regular(struct error *error)
{
    struct kernel kernel;
    struct regularity found;
    enum status status = kernel_select(&kernel, "cubic_spline", 0, error);
    make_positions();
    for (int dim = 1; !status && dim <= 2; dim++) {
        const struct regularity_cloud cloud = {.box = {dim, {0, 0}, {10, 10}},
                                               .n = N,
                                               .x = {positions[0], positions[1]},
                                               .volume = unit,
                                               .h = unit,
                                               .kernel = &kernel};
        status = regularity_measure(&cloud, &found, error);
    }
    return status;
}

/* Everything before a run's first step; the quality of a glass is measured. */
static enum status explained(struct error *error)
{
    static struct run run;
    static struct run_result result;
    if (!run.asked.threads) {
        struct run_settings settings;
        char *keys[] = {"n=8^2", "lattice=glass"};
        assert_int_equal(run_prepare(&settings, "rest_2d", 2, keys, error), STATUS_OK);
        assert_int_equal(run_resolve(&run, &settings, error), STATUS_OK);
    }
    return run_explain(&run, &result, error);
}

TEST(places_of_particles)
{
    without_memory(fill, 1, true);
    without_memory(created, 2, true);
    without_memory(equal, 3, true);
    without_memory(relaxed, 4, true);
    struct error error;
    assert_int_equal(explained(&error), STATUS_OK); /* fills what stays allocated */
    without_memory(explained, 8, true);
    without_memory(relax_measured, 4, true);
    without_memory(regular, 4, true);
}

/* ---- files and maps ---- */

static char path[] = "sphproof_memory_XXXXXX.ini";

static enum status mapped(struct error *error)
{
    const struct domain domain = {2, {0, 0}, {10, 10}};
    const struct snapshot s = {.n = N, .x = {positions[0], positions[1]}, .h = positions[0]};
    struct map map;
    make_positions();
    const enum status status = map_create(&map, &domain, &s, 8, error);
    if (!status) map_free(&map);
    return status;
}

static enum status loaded(struct error *error)
{
    static struct case_file file;
    return case_load(&file, path, error);
}

/* The message lists the cases, which needs memory. */
static enum status unknown(struct error *error)
{
    static struct case_file file;
    const enum status status = case_load(&file, "no_such_case", error);
    return status == STATUS_BAD_INPUT ? STATUS_OK : status;
}

TEST(files)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    for (const struct case_builtin *builtin = case_builtins; builtin->name; builtin++)
        if (strcmp(builtin->name, "sod") == 0) fputs(builtin->text, file);
    fclose(file);
    without_memory(mapped, 1, true);
    without_memory(loaded, 1, false);
    without_memory(unknown, 5, false);
}

/* ---- checks ---- */

static void measure(struct check_run *run, const void *subject)
{
    static const double x[] = {1, 2};
    check_measure(run, subject ? 2 : 0.5, 1, 0, "figure");
    check_skip(run, "not this");
    check_series(run, "data", 2, x, x);
}

static void subjects(struct check_run *run)
{
    check_subject(run, &unit, sizeof *unit);
    check_subject(run, &unit, sizeof *unit);
}

static const struct check_mutant mutants[] = {{"two", "", unit}, {"three", "", unit}, {0}};
static const struct check check = {.group = "a",
                                   .name = "check",
                                   .property = "p",
                                   .subjects = subjects,
                                   .measure = measure,
                                   .mutants = mutants};
static const struct check *const checks[] = {&check};
static json_t *kept;

static enum status checked(struct error *error)
{
    struct suite suite;
    const struct suite_choice choice = {.mutants = true};
    const enum status status = suite_run(&suite, checks, 1, &choice, error);
    if (status == STATUS_ENVIRONMENT) {
        assert_null(suite.figures);
        return status;
    }
    assert_int_equal(status, STATUS_CHECK_FAILED);
    assert_true(suite.figure_count == 4 && suite.failed == 2 && suite.skipped == 2);
    assert_true(suite.series_count == 2 && suite.outcome_count == 2);
    if (!kept) kept = suite_keep(&suite);
    suite_free(&suite);
    return STATUS_OK;
}

static enum status joined(struct error *error)
{
    struct suite suite;
    const json_t *const documents[] = {kept};
    const enum status status = suite_join(&suite, checks, documents, 1, error);
    if (status == STATUS_ENVIRONMENT) {
        assert_null(suite.figures);
        return status;
    }
    assert_int_equal(status, STATUS_CHECK_FAILED);
    assert_true(suite.figure_count == 4 && suite.series_count == 2 && suite.outcome_count == 2);
    json_t *headlines = headline_list(&suite);
    suite_free(&suite);
    if (!headlines) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    json_decref(headlines);
    return STATUS_OK;
}

static json_t *two_runs(void)
{
    static json_t *results;
    if (!results)
        results = json_pack("{s:[{s:s, s:s, s:s}, {s:s, s:s, s:s, s:s}]}", "runs", "status", "ok",
                            "case", "a", "reproduce", "b", "status", "broke_down", "case", "c",
                            "reproduce", "d", "message", "e");
    return results;
}

static enum status as_failures(struct error *error)
{
    struct findings findings = {0};
    findings_of_report(&findings, two_runs());
    json_t *list = findings_failures(&findings);
    findings_free(&findings);
    if (!list) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    assert_int_equal(json_array_size(list), 1);
    json_decref(list);
    return STATUS_OK;
}

static enum status as_junit(struct error *error)
{
    char *text = findings_junit(findings_of_report, two_runs());
    if (!text) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    assert_non_null(strstr(text, "tests=\"2\" failures=\"1\""));
    free(text);
    return STATUS_OK;
}

static enum status in_verdict(struct error *error)
{
    json_t *verdict = verdict_make(two_runs());
    if (!verdict) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    assert_string_equal(json_string_value(json_object_get(verdict, "status")), "fail");
    json_decref(verdict);
    return STATUS_OK;
}

static enum status compared(struct error *error)
{
    struct diff diff;
    json_t *documents[2];
    for (int k = 0; k < 2; k++)
        documents[k] = json_pack("{s:s, s:[{s:s, s:s}, {s:s, s:s}, {s:s, s:s}]}", "command",
                                 "report", "runs", "case", "a", "status", "ok", "case", "a",
                                 "status", k ? "broke_down" : "ok", "case", "b", "status", "ok");
    const enum status status = diff_documents(documents[0], documents[1], 0.05, &diff, error);
    if (status != STATUS_ENVIRONMENT) {
        assert_int_equal(status, STATUS_CHECK_FAILED);
        diff_free(&diff);
    }
    for (int k = 0; k < 2; k++) json_decref(documents[k]);
    return status == STATUS_CHECK_FAILED ? STATUS_OK : status;
}

static enum status told(struct error *error)
{
    json_t *history;
    const enum status status = history_tell(two_runs(), "no/such/folder", &history, error);
    json_decref(history);
    return status;
}

static enum status scripted(struct error *error)
{
    static const double x[] = {1, 2};
    static const struct plot_series line = {.label = "a", .n = 2, .x = x, .y = x};
    static const struct plot_panel panel = {.series = &line, .series_count = 1};
    static const struct plot plot = {.name = "a", .panels = &panel, .panel_count = 1};
    char *script, *data;
    if (!plot_source(&plot, &script, &data))
        return error_set(error, STATUS_ENVIRONMENT, "no memory");
    free(script);
    free(data);
    return STATUS_OK;
}

/* ---- pages ---- */

/* The template, a document drawn from it, and how its page is made. */
static json_t *template, *shown;
static bool (*make)(struct page *page, const json_t *document);

static enum status paged(struct error *error)
{
    struct page page;
    if (!make(&page, shown)) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    const bool told = strstr(page.plots.message, "no memory"); /* for one of the missing plots */
    page_free(&page);
    return told ? error_set(error, STATUS_ENVIRONMENT, "no memory") : STATUS_OK;
}

static void pages(const char *kind, bool of(struct page *page, const json_t *document), int least)
{
    for (size_t k = 0; k < 2; k++) {
        struct drawing draw = {k, template};
        shown = drawn_document(&draw, json_object_get(template, kind)), make = of;
        if (of == page_make) json_object_set_new(shown, "verdict", verdict_make(shown));
        without_memory(paged, least, true);
        json_decref(shown);
    }
}

/* A page is never without one of its parts. (There is no gnuplot: plots are their data.) */
TEST(whole_pages)
{
    char *programs = strdup(getenv("PATH") ? getenv("PATH") : "");
    template = read_template(test_word(1), "report.json");
    setenv("PATH", "/nowhere", 1);
    pages("report", page_make, 100);
    pages("codes", page_make, 20);
    pages("judge", page_make_judge, 5);
    pages("compare", page_make_compare, 5);
    setenv("PATH", programs, 1);
    json_decref(template);
    free(programs);
}

TEST(reports)
{
    without_memory(as_failures, 3, true);
    without_memory(in_verdict, 3, true);
    without_memory(compared, 10, true);
    spared = 1; /* changes are not sorted */
    without_memory(told, 3, true);
    without_memory(scripted, 5, true);
}

TEST(checks_and_suites)
{
    without_memory(as_junit, 3, true);
    without_memory(checked, 10, true);
    without_memory(joined, 10, true);
    json_decref(kept);
}

/* ---- jobs, tables of rates, snapshots on the way ---- */

static enum status say_nothing(const void *context, json_t **document, struct error *error)
{
    (void)context, (void)document, (void)error;
    return STATUS_OK;
}

static enum status add_jobs(struct pool *pool, size_t n, struct error *error)
{
    for (size_t i = 0; i < n; i++) {
        char key[24];
        snprintf(key, sizeof key, "%zu", i);
        if (pool_add(pool, "job", key, 1, say_nothing, NULL) != i)
            return error_set(error, STATUS_ENVIRONMENT, "no memory for a job");
    }
    return STATUS_OK;
}

/* More jobs than the first capacity. */
static enum status divided(struct error *error)
{
    struct pool pool = {0};
    int shares[70];
    enum status status = add_jobs(&pool, 70, error);
    if (!status) status = pool_divide(&pool, 2, shares, error);
    pool_free(&pool);
    return status;
}

static enum status computed(struct error *error)
{
    struct pool pool = {0};
    const struct pool_settings settings = {.jobs = 1, .share = {1, 2}};
    enum status status = add_jobs(&pool, 2, error);
    if (!status) status = pool_run(&pool, &settings, error);
    if (!status && pool.jobs[0].error.status) { /* its reply was not received */
        *error = pool.jobs[0].error;
        status = error->status;
    }
    pool_free(&pool);
    return status;
}

/* Eight particles in 1D. */
static struct setup line_setup(double arrays[4][8])
{
    struct setup setup = {.dim = 1,
                          .hi = {1, 1, 1},
                          .gamma = 1.4,
                          .t_end = 1,
                          .n = 8,
                          .x = {arrays[0]},
                          .v = {arrays[1]},
                          .m = arrays[2],
                          .u = arrays[3],
                          .threads = 1};
    for (int i = 0; i < 8; i++) {
        arrays[0][i] = (i + 0.5) / 8;
        arrays[1][i] = 0;
        arrays[2][i] = 0.125, arrays[3][i] = 1;
    }
    setup.scheme = keyed_scheme(1, "");
    return setup;
}

static enum status rated(struct error *error)
{
    double arrays[4][8];
    const struct setup setup = line_setup(arrays);
    struct rate_table table;
    const enum status status = rate_table_make(&table, &setup, error);
    rate_table_free(&table);
    return status;
}

/* A snapshot without memory is skipped; the next one is tried again. */
static enum status set_aside(struct error *error)
{
    double arrays[4][8];
    const struct setup setup = line_setup(arrays);
    struct simulation *simulation;
    struct snapshots snapshots = {.path = "a.csv", .every = 0.5};
    enum status status = simulation_create(&setup, &simulation, error);
    if (status) return status;
    snapshots_begin(&snapshots, 0, -1, 1);
    const bool aside = snapshots_keep(&snapshots, simulation, 0, 1);
    assert_true(aside == (snapshots.trouble.status == STATUS_OK));
    assert_int_equal(snapshots.next, aside ? 0 : 1);
    if (!aside) *error = snapshots.trouble;
    snapshots_go_on(&snapshots);
    simulation_destroy(simulation);
    return error->status;
}

/* Widths that reach over many boxes need more ghosts, and pairs more work memory. A request that
 * failed may be repeated. */
static enum status widened(struct error *error)
{
    double arrays[4][8], rate;
    const struct setup setup = line_setup(arrays);
    struct simulation *simulation;
    enum status status = simulation_create(&setup, &simulation, error);
    if (status) return status;
    const struct particles *a = &simulation->particles;
    const struct line *line = line_of(simulation);
    assert_true(a->ghosts == 64);
    for (ptrdiff_t i = 0; i < 8; i++) a->h_inverse_found[i] = a->h_inverse_old[i] = 1. / 30;
    simulation->scheme.eta = 60; /* a width below the limit of runaway */
    status = widths_find(simulation, false, 0, error);
    if (!status) status = forces_sum(simulation, &rate, error);
    if (status) {
        assert_int_equal(forces_reserve_scratch(simulation, 250, error), STATUS_OK);
        assert_true(line->scratch && line->scratch_size >= loop_force_scratch(250));
    } else {
        assert_true(a->ghosts > 64 && line->reach == 239);
    }
    simulation_destroy(simulation);
    return status;
}

static struct simulation *to_resume;
static struct checkpoint checkpoint = {.path = path, .build = "one", .run = "a run"};

static enum status resumed(struct error *error)
{
    struct growth growth;
    return checkpoint_load(&checkpoint, to_resume, &growth, error);
}

/* If memory is short, a valid file is not reported as damaged. */
static void resume(void)
{
    double arrays[4][8];
    const struct setup setup = line_setup(arrays);
    struct growth growth = {0};
    struct error error;
    assert_int_equal(simulation_create(&setup, &to_resume, &error), STATUS_OK);
    checkpoint_save(&checkpoint, to_resume, &growth);
    assert_int_equal(checkpoint.trouble.status, STATUS_OK);
    without_memory(resumed, 2, true);
    simulation_destroy(to_resume);
}

TEST(jobs_and_tables)
{
    resume();
    without_memory(divided, 100, true);
    without_memory(computed, 13, false); /* the reply is complete when its end is looked for */
    without_memory(rated, 3, true);
    without_memory(set_aside, 3, true);
    without_memory(widened, 10, true);
}

static int make_file(void **state)
{
    (void)state;
    return close(mkstemps(path, 4));
}

static int remove_file(void **state)
{
    (void)state;
    return unlink(path);
}

TEST_BETWEEN(make_file, remove_file);
