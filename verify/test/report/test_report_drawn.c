/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares what a report plans by day and by night, and what it makes of random results drawn from
 * data/drawn/pieces.json, with data/drawn/reports.txt, byte for byte. verify/test/keep renews that
 * file. Also computes some cheap pieces. */
#include "test.h"

#include <gsl/gsl_errno.h>

#include "buffer.h"
#include "claims.h"
#include "drawn_pieces.h"
#include "own_folder.h"
#include "report.h"
#include "result.h"
#include "value.h"

static void compare(struct digests *kept, const char *what, size_t number, struct buffer *text)
{
    char name[64], *all = buffer_take(text);
    assert_non_null(all);
    snprintf(name, sizeof name, "%s-%zu", what, number);
    digests_compare(kept, name, all);
    free(all);
}

/* Adds numbers to nine digits; members that depend on the build and the day are left out. */
static void add_document(struct buffer *to, json_t *document)
{
    static const char *const heads[] = {"version", "git",  "compiler", "flags",
                                        "machine", "date", "seconds"};
    const char *key;
    json_t *value;
    for (size_t i = 0; i < sizeof heads / sizeof *heads; i++) json_object_del(document, heads[i]);
    json_object_foreach(document, key, value)
        for (size_t i = 0; i < sizeof heads / sizeof *heads; i++)
            if (json_is_object(value)) json_object_del(value, heads[i]);
    size_t k;
    json_array_foreach(json_object_get(document, "studies"), k, value)
        for (size_t i = 0; i < sizeof heads / sizeof *heads; i++) json_object_del(value, heads[i]);
    char *text = json_dumps(document, JSON_INDENT(1) | JSON_REAL_PRECISION(9));
    assert_non_null(text);
    for (char *at = text; (at = strstr(at, own_folder)); at++) memset(at, '~', strlen(own_folder));
    buffer_add(to, text);
    free(text);
}

static void write_text(const char *name, const char *text)
{
    FILE *file = fopen(path_of(name), "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void has_content(const json_t *member)
{
    assert_true(json_object_size(member) || json_array_size(member) || json_string_length(member));
}

/* Computes some cheap pieces and verifies the kind and the length of their documents. */
static void compute_some(struct pool *pool)
{
    static const struct {
        const char *job, *command;
        size_t count; /* number of such pieces */
        const char *members[3];
    } cheap[] = {{"profile of sound_wave", "run", 3, {"profile", "through_time"}},
                 {"checks of riemann", "verify", 1, {"checks", "mutants"}},
                 {"kernel cubic_spline, dim 1", "kernel", 1, {"kernel", "checks", "reproduce"}},
                 {"kernel sinc, dim 1", "kernel", 1, {"kernel", "checks", "reproduce"}}};
    struct error error = {0};
    for (size_t c = 0; c < sizeof cheap / sizeof *cheap; c++) {
        size_t found = 0;
        for (size_t i = 0; i < pool->count; i++) {
            struct pool_job *job = &pool->jobs[i];
            json_t *document;
            if (strcmp(job->name, cheap[c].job)) continue;
            assert_int_equal(job->compute(job->context, &document, &error), STATUS_OK);
            assert_string_equal(value_text(document, "command"), cheap[c].command);
            if (!c) assert_string_equal(value_text(document, "status"), "ok");
            if (!c) has_content(json_object_get(json_object_get(document, "through_time"), "time"));
            struct kernel sinc;
            assert_int_equal(kernel_select(&sinc, "sinc", 5, &error), STATUS_OK);
            if (strstr(cheap[c].job, "sinc")) /* of the order that settings have by default */
                near_relative(value_member(document, "constant"), sinc.constant[1], 1e-12);
            if (strstr(cheap[c].job, "kernel")) { /* in units of h */
                const json_t *moments = json_object_get(document, "moments");
                assert_true(value_member(document, "h") == 1 &&
                            value_member(moments, "second") ==
                                value_member(moments, "second_over_h2"));
            }
            for (int k = 0; k < 3 && cheap[c].members[k]; k++) {
                has_content(json_object_get(document, cheap[c].members[k]));
            }
            json_decref(document);
            found++;
        }
        assert_int_equal(found, cheap[c].count);
    }
}

/* Expensive pieces of a report, made small: their documents, and the settings that they refuse. */
TEST(small_pieces)
{
    static const struct {
        struct report_piece piece;
        const char *key, *command, *reproduce, *members[2]; /* command NULL: the piece is refused */
        size_t ladder[2];                                   /* of a bench */
    } rows[] = {
        {{.kind = REPORT_AUTOPSY, .where = "yee", .keys = "eta=2.5", .sizes = "8^2,9^2,10^2,11^2"},
         "eta=2.5",
         "autopsy",
         "sphproof autopsy yee eta=2.5 --n 8^2,9^2,10^2,11^2",
         {"levels", "shares"},
         {0}},
        {{.kind = REPORT_AUTOPSY, .where = "yee", .sizes = "8^2"},
         "n=8^2",
         NULL,
         NULL,
         {NULL},
         {0}},
        {{.kind = REPORT_BENCH,
          .where = "sod",
          .rules = {.least_s = 1e-5, .most_s = 1, .samples = 1}},
         "cfl=0.3",
         "bench",
         "sphproof bench sod --vary kernel=quadratic_spline,cubic_spline,quartic_spline,gradient "
         "--time 1e-05 --samples 1",
         {"points", "cheapest"},
         {20, 30}},
        {{.kind = REPORT_BENCH,
          .where = "yee",
          .rules = {.least_s = 1e-5, .most_s = 1, .samples = 1}},
         "eta=2.4",
         "bench",
         "sphproof bench yee --vary kernel=cubic_spline,wendland_c2,wendland_c4,gradient,"
         "shifting=none,closed --time 1e-05 --samples 1",
         {"points", "cheapest"},
         {64, 81}},
        {{.kind = REPORT_BENCH, .where = "sod", .rules = {.samples = 1}},
         "cfl=0.3",
         NULL,
         NULL,
         {NULL},
         {1, 2}},
        {{.kind = REPORT_BENCH,
          .where = "sound_wave",
          .rules = {.least_s = 1e-5, .most_s = 1, .samples = 2}},
         "cfl=0.3",
         "bench",
         "sphproof bench sound_wave --vary kernel=quadratic_spline,cubic_spline,"
         "viscosity=none,constant,reconstructed,fading --time 1e-05 --samples 2",
         {"points", "cheapest"},
         {20, 30}},
        {{.kind = REPORT_SKIPS,
          .where = "sod",
          .keys = "n=60",
          .rules = {.least_s = 1e-5, .most_s = 1, .samples = 1}},
         "n=60",
         "bench",
         "sphproof bench sod n=60 --skips --samples 1",
         {"skips"},
         {0}},
        {{.kind = REPORT_SKIPS, .where = "sod", .rules = {.samples = 1}},
         "eta=0.1",
         NULL,
         NULL,
         {NULL},
         {0}},
        {{.kind = REPORT_KERNEL, .where = "sod", .dim = 1}, "n=60", NULL, NULL, {NULL}, {0}},
        {{.kind = REPORT_RUN, .where = "two_rarefactions"},
         "cfl=50",
         "run",
         "",
         {"through_time"},
         {0}},
        {{.kind = REPORT_AUTOPSY, .where = "sod", .sizes = "20,30,40,50"},
         "n=20",
         NULL,
         NULL,
         {NULL},
         {0}},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct report_piece piece = rows[k].piece;
        struct pool pool = {0};
        struct error error = {0};
        char key[40], end[] = "t_end=0.01", *keys[] = {key, end};
        json_t *document;
        snprintf(key, sizeof key, "%s", rows[k].key);
        if (run_prepare(&piece.settings, piece.where, 2, keys, &error))
            fail_msg("%s", error.message);
        piece.settings.file.ladder_count = 2;
        memcpy(piece.settings.file.ladder, rows[k].ladder, sizeof rows[k].ladder);
        if (report_piece_add(&pool, &piece, &error)) fail_msg("%s", error.message);
        const enum status status = pool.jobs[0].compute(&piece, &document, &error);
        if (rows[k].command) {
            if (status != (piece.kind == REPORT_RUN ? STATUS_BROKE_DOWN : STATUS_OK))
                fail_msg("row %zu: %s", k, error.message);
            assert_string_equal(value_text(document, "command"), rows[k].command);
            assert_string_equal(value_text(document, "reproduce"), rows[k].reproduce);
            for (int i = 0; i < 2 && rows[k].members[i]; i++)
                has_content(json_object_get(document, rows[k].members[i]));
            if (piece.kind == REPORT_SKIPS)
                assert_true(json_is_array(json_object_get(document, "points")));
            if (piece.kind == REPORT_RUN)
                assert_string_equal(value_text(document, "status"), "broke_down");
            json_decref(document);
        } else {
            assert_int_equal(status, STATUS_BAD_INPUT);
        }
        pool_free(&pool);
    }
}

/* The league table: in each dimension the highest degree of polynomials that an operator
 * differentiates exactly on a lattice and on disordered points; the order on a lattice, which is 2
 * where linear fields are exact; errors within a tenth of those once measured, in the interior and
 * at the edge; and whether a scheme of it conserves momentum and angular momentum. */
TEST(league)
{
    static const struct {
        const char *name;
        int lattice[3], disordered;
        double inside[3], edge[3];
        bool momentum, angular;
    } rows[] = {
        {"standard", {2, 0, 0}, -1, {0.36, 0.256, 0.17}, {1.33, 1.43, 1.36}, true, true},
        {"standard_difference",
         {2, 0, 0},
         0,
         {0.000479, 0.00399, 0.00636},
         {0.00656, 0.0831, 0.163},
         false,
         false},
        {"ia", {2, 2, 2}, -1, {0.455, 0.305, 0.213}, {2.87, 2.8, 2.83}, true, false},
        {"linear_exact",
         {2, 2, 2},
         1,
         {1.13e-5, 0.000416, 0.00111},
         {0.000152, 0.00583, 0.0273},
         false,
         false},
        {"normalised_corrected",
         {2, 2, 2},
         1,
         {1.99e-5, 0.000396, 0.00107},
         {0.000152, 0.00672, 0.0309},
         false,
         false},
        {"corrected", {2, 2, 2}, -1, {0.396, 0.262, 0.176}, {2.73, 2.73, 2.69}, true, false}};
    static const double neighbours[] = {4, 19.2, 54.2};
    enum { ROWS = sizeof rows / sizeof *rows };
    struct report_piece piece = {.kind = REPORT_LEAGUE, .where = "operators"};
    struct pool pool = {0};
    struct error error = {0};
    json_t *document, *row;
    size_t k;
    assert_int_equal(report_piece_add(&pool, &piece, &error), STATUS_OK);
    assert_int_equal(pool.jobs[0].compute(&piece, &document, &error), STATUS_OK);
    assert_int_equal(json_array_size(json_object_get(document, "rows")), 3 * ROWS);
    json_array_foreach(json_object_get(document, "rows"), k, row) {
        const size_t of = k % ROWS, d = k / ROWS;
        const double order = value_member(row, "order_lattice"),
                     disordered = value_member(row, "order_disordered"),
                     per_pair = value_member(row, "ns_per_pair");
        assert_string_equal(value_text(row, "operator"), rows[of].name);
        assert_true(value_member(row, "dim") == (double)d + 1 &&
                    value_member(row, "exact_degree_lattice") == rows[of].lattice[d] &&
                    value_member(row, "exact_degree_disordered") == rows[of].disordered);
        if (rows[of].lattice[d] == 2)
            near_inside(order, 1.9, 2.1);
        else
            near_inside(order, 0, 0.4);
        near_inside(disordered, rows[of].disordered - 0.3, rows[of].disordered + 0.3);
        near_relative(value_member(row, "error_disordered"), rows[of].inside[d], 0.1);
        near_relative(value_member(row, "error_edge"), rows[of].edge[d], 0.1);
        near_inside(value_member(row, "condition"), d ? 2 : 1, d ? 4 : 1);
        assert_int_equal(value_member(row, "momentum_defect") < 1e-14, rows[of].momentum);
        assert_int_equal(value_member(row, "angular_momentum_defect") < 1e-14,
                         d > 0 && rows[of].angular);
        near_relative(value_member(row, "neighbours"), neighbours[d], 0.01);
        assert_true(per_pair > 0);
        near_relative(value_member(row, "ns_per_point"), per_pair * neighbours[d], 0.02);
    }
    json_decref(document);
    pool_free(&pool);
}

/* The cost of errors, for studies of one case that measure a field or a value. */
TEST(cost_of_codes)
{
    json_t *results = json_pack(
        "{s:[{s:s, s:s, s:s, s:s, s:[s], s:[{s:i, s:f, s:{s:{s:f}}}]},"
        "    {s:s, s:s, s:s, s:s, s:[s], s:[{s:i, s:f}], s:[{s:s, s:f, s:[f]}]},"
        "    {s:s, s:[{s:i, s:f, s:{s:{s:f}}}]}]}",
        "studies", "case", "a", "title", "A", "label", "one", "reproduce", "r", "measured",
        "velocity", "levels", "n", 20, "cpu_s", 2., "errors", "velocity", "l1", 0.25, "case", "a",
        "title", "A", "label", "other", "reproduce", "r", "measured", "peak", "levels", "n", 30,
        "cpu_s", 3., "functionals", "name", "peak", "exact", 2., "values", 1.5, "case", "b",
        "levels", "n", 40, "cpu_s", 1., "errors", "density", "l1", 0.125);
    const double errors[] = {0.25, 0.5};
    code_cost_add(results);
    const json_t *bench = json_object_get(results, "bench"), *of = json_array_get(bench, 0);
    assert_int_equal(json_array_size(bench), 2);
    const json_t *other = json_array_get(bench, 1);
    assert_string_equal(value_text(other, "error_of"), "density");
    assert_true(value_member(json_array_get(json_object_get(other, "points"), 0), "error") ==
                0.125);
    assert_int_equal(json_array_size(json_object_get(of, "schemes")), 2);
    for (size_t k = 0; k < 2; k++) {
        const json_t *point = json_array_get(json_object_get(of, "points"), k);
        assert_true(value_member(point, "error") == errors[k] &&
                    value_member(point, "cpu_s") == 2 + (double)k &&
                    value_member(point, "n") == 20 + 10 * (double)k);
    }
    json_decref(results);
}

/* Adds the settings, to six digits, of runs of cases, claims and pairing (the many studies have
 * tests of their own). */
static void add_settings(struct buffer *to, const struct pool_job *job)
{
    static const char *const names[] = {"profile of ", "rest_", "square,", "kelvin_", "rayleigh_"};
    json_t *key = NULL;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!strncmp(job->name, names[i], strlen(names[i]))) key = json_loads(job->key, 0, NULL);
    char *settings = key ? json_dumps(json_object_get(key, "settings"),
                                      JSON_COMPACT | JSON_SORT_KEYS | JSON_REAL_PRECISION(6))
                         : NULL;
    buffer_format(to, "  %s\n", settings ? settings : "");
    free(settings);
    json_decref(key);
}

/* Adds the settings of a bench, skips or an autopsy, and the rules of what measures time. */
static void add_piece_settings(struct buffer *to, const struct pool_job *job)
{
    static const char *const names[] = {"work-precision ", "skips ", "autopsy "};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (strncmp(job->name, names[i], strlen(names[i])) != 0) continue;
        const struct report_piece *piece = job->context;
        const struct bench_rules *rules = &piece->rules;
        for (enum setting key = 0; key < SETTINGS; key++) {
            char text[SETTING_TEXT_MAX];
            settings_text(&piece->settings.settings, key, text);
            buffer_format(to, " %s", text);
        }
        buffer_format(to, "\n  %.9g s to %.9g s, %d samples\n", rules->least_s, rules->most_s,
                      rules->samples);
    }
}

static void compare_plan(struct digests *kept, size_t number, struct report *report)
{
    struct buffer text = {0};
    const struct pool *pool = report_pool(report);
    for (size_t i = 0; i < pool->count; i++) {
        buffer_format(&text, "%s: %.4g\n", pool->jobs[i].name, pool->jobs[i].weight);
        add_settings(&text, &pool->jobs[i]);
        add_piece_settings(&text, &pool->jobs[i]);
    }
    compare(kept, "plan", number, &text);
}

static struct report *planned(struct digests *kept, bool nightly)
{
    struct error error = {0};
    struct report *report;
    if (report_create(nightly, NULL, 0, &report, &error)) fail_msg("%s", error.message);
    compare_plan(kept, nightly, report);
    return report;
}

/* Two codes with common cases; cases in 1D and 2D, one with the longest ladder, one without a
 * ladder. */
static void report_codes(struct digests *kept, struct drawing *draw)
{
    static const char *const names[] = {"sod", "yee", "square", "yee", "sod"};
    static struct run_settings cases[5];
    const struct report_code codes[] = {{"A", " --code a.ini", 2, cases},
                                        {"B", " --code b.ini", 3, cases + 2}};
    struct report *report;
    struct error error = {0};
    struct buffer text = {0}, command = {0};
    json_t *results;
    for (size_t k = 0; k < 5; k++)
        assert_int_equal(run_prepare(&cases[k], names[k], 0, NULL, &error), STATUS_OK);
    cases[0].file.ladder_count = CASE_LADDER_MAX;
    buffer_add(&command, "sphproof converge sod --n ");
    for (size_t i = 0; i < CASE_LADDER_MAX; i++) {
        cases[0].file.ladder[i] = 1000000 + i;
        buffer_format(&command, "%s%zu", i ? "," : "", cases[0].file.ladder[i]);
    }
    cases[2].file.ladder_count = 0;
    if (report_create(false, codes, 2, &report, &error)) fail_msg("%s", error.message);
    compare_plan(kept, 2, report);
    drawn_pieces(draw, report_pool(report), 150);
    if (report_judge(report, NULL, &results, &error)) fail_msg("%s", error.message);
    const json_t *ours = json_array_get(json_object_get(results, "studies"), 2);
    assert_string_equal(value_text(ours, "label"), "default");
    assert_string_equal(value_text(ours, "reproduce"), command.data);
    add_document(&text, results);
    compare(kept, "codes", 0, &text);
    buffer_free(&command);
    json_decref(results);
    report_destroy(report);
    cases[3].file.ladder[0] = 1;
    assert_int_equal(report_create(false, codes, 2, &report, &error), STATUS_BAD_INPUT);
    assert_null(report);
    assert_non_null(strstr(error.message, "n=1: allowed: "));
}

/* Leaves this job without a result. */
static void lose(struct pool *pool, const char *name, enum status status, const char *message)
{
    struct pool_job *job = pool->jobs;
    while (strcmp(job->name, name)) job++;
    json_decref(job->document);
    job->document = NULL;
    error_set(&job->error, status, "%s", message);
}

/* Studies of one case with equal errors are suspicious, except for the first. */
TEST(equal_schemes)
{
    json_t *template = read_template(test_word(1), "pieces.json"), *results, *study;
    struct drawing draw = {0, template};
    struct report *report;
    struct error error = {0};
    const char *before = "";
    size_t k, later = 0;
    if (report_create(false, NULL, 0, &report, &error)) fail_msg("%s", error.message);
    const struct pool *pool = report_pool(report);
    drawn_pieces(&draw, report_pool(report), SIZE_MAX);
    for (size_t i = 0; i < pool->count; i++)
        if (json_object_get(pool->jobs[i].document, "errors"))
            json_object_set_new(pool->jobs[i].document, "errors",
                                json_pack("{s:{s:f}}", "density", "l1", 1.));
    if (report_judge(report, NULL, &results, &error)) fail_msg("%s", error.message);
    json_array_foreach(json_object_get(results, "studies"), k, study) {
        const char *name = value_text(study, "case");
        const bool first = strcmp(name, before) != 0;
        later += !first;
        assert_string_equal(value_text(study, "suspicion"),
                            first ? "" : "changing the scheme changed nothing: is it read at all?");
        before = name;
    }
    assert_true(later > 10);
    near_inside(value_member(results, "seconds"), 0, 1000);
    json_decref(results);
    report_destroy(report);
    json_decref(template);
}

TEST(reports)
{
    json_t *template = read_template(test_word(1), "pieces.json"), *results;
    struct digests kept;
    struct drawing draw = {0, template};
    struct buffer text = {0};
    struct error error = {0};
    digests_open(&kept, test_word(1), "reports.txt");
    write_text("faults.json",
               "{\"schema\": \"sphproof/1\", \"command\": \"faults\", \"faults\": []}");
    write_text("score.json", "{");
    gsl_set_error_handler(NULL);
    struct report *report = planned(&kept, false);
    assert_non_null(gsl_set_error_handler_off()); /* errors of GSL do not end the program */
    struct pool *pool = report_pool(report);
    compute_some(pool);
    drawn_pieces(&draw, pool, 150);
    if (report_judge(report, own_folder, &results, &error)) fail_msg("%s", error.message);
    add_document(&text, results);
    compare(&kept, "report", 0, &text);
    json_decref(results);
    lose(pool, "league of operators", STATUS_ENVIRONMENT, "no process"); /* without a result */
    assert_int_equal(report_judge(report, NULL, &results, &error), STATUS_ENVIRONMENT);
    assert_string_equal(error.message, "league of operators: no process");
    assert_null(results);
    lose(pool, "league of operators", STATUS_BAD_INPUT, "refused"); /* the others are judged */
    assert_int_equal(report_judge(report, path_of("nowhere"), &results, &error), STATUS_OK);
    json_t *trouble;
    size_t k, reported = 0;
    json_array_foreach(json_object_get(results, "trouble"), k, trouble) {
        reported += strcmp(value_text(trouble, "message"), "refused") == 0;
        assert_string_not_equal(value_text(trouble, "name"), "faults");
    }
    assert_int_equal(reported, 1);
    json_decref(results);
    /* a run of a study, which has no order without this run */
    lose(pool, "sod, n = 198", STATUS_BAD_INPUT, "refused");
    assert_int_equal(report_judge(report, NULL, &results, &error), STATUS_BAD_INPUT);
    assert_null(results);
    report_destroy(report);
    report = planned(&kept, true);
    drawn_pieces(&draw, report_pool(report), 150);
    if (report_judge(report, NULL, &results, &error)) fail_msg("%s", error.message);
    add_document(&text, results);
    compare(&kept, "report", 1, &text);
    json_decref(results);
    report_destroy(report);
    report_codes(&kept, &draw);
    digests_close(&kept);
    json_decref(template);
}

/* ---- conclusions on claims and pairing ---- */

static void all_say(json_t *list, const char *verdict)
{
    const json_t *claim;
    size_t i;
    json_array_foreach(list, i, claim)
        if (strncmp(value_text(claim, "verdict"), verdict, strlen(verdict)))
            fail_msg("%s: %s", value_text(claim, "name"), value_text(claim, "verdict"));
    assert_true(json_array_size(list) > 0);
    json_decref(list);
}

/* Jobs with the claimed scheme come last: they are better if errors fall with the job's number, and
 * no better if errors are equal. */
TEST(claims_in_words)
{
    static const char *const figures[] = {"growth_rate", "velocity_rms"};
    struct claims claims = {0};
    struct pool pool = {0};
    struct error error = {0};
    assert_int_equal(claims_plan(&claims, false, &pool, &error), STATUS_OK);
    all_say(claims_judge(&claims, &pool), "not shown: nothing to compare");
    for (int better = -1; better < 2; better++) {
        for (size_t i = 0; i < pool.count; i++) {
            const double off = ldexp(1, -better * (int)i);
            json_t *functionals = json_array();
            for (int k = 0; k < 2; k++)
                json_array_append_new(functionals, json_pack("{s:s, s:f, s:f}", "name", figures[k],
                                                             "value", 1 + off, "reference", 1.));
            json_decref(pool.jobs[i].document);
            pool.jobs[i].document =
                json_pack("{s:s, s:o}", "status", "ok", "functionals", functionals);
        }
        all_say(claims_judge(&claims, &pool), better > 0 ? "holds" : "does not hold");
    }
    claims_free(&claims);
    pool_free(&pool);
}

/* Each row of a claim is judged from the errors of two runs; the words about the claim count them.
 */
TEST(rows_of_claims)
{
    static const struct {
        double without, with; /* infinite: the run broke down; NaN: it has no such figure */
        const char *verdict;
    } rows[] = {{1.25, 1, "no difference"},
                {1.2500005, 1, "holds"},
                {1, 1.25, "no difference"},
                {1, 1.2500005, "does not hold"},
                {HUGE_VAL, HUGE_VAL, "nothing to compare"},
                {HUGE_VAL, 1, "holds"},
                {1, HUGE_VAL, "does not hold"},
                {(double)NAN, 1, "nothing to compare"},
                {1, (double)NAN, "nothing to compare"},
                {-1.375, 1, "holds"}};
    static const char *const verdicts[] = {
        "holds in 2 of 6, the opposite in 1", "holds in 1 of 4, the opposite in 1",
        "holds in 1 of 4, the opposite in 1", "holds in 1 of 2, the opposite in 0"};
    enum { ROWS = sizeof rows / sizeof *rows };
    struct claims claims = {0};
    struct pool pool = {0};
    struct error error = {0};
    size_t c, r, all = 0;
    json_t *claim, *row;
    assert_int_equal(claims_plan(&claims, false, &pool, &error), STATUS_OK);
    for (size_t i = 0; i < pool.count; i++) {
        const double value = i % 2 ? rows[i / 2 % ROWS].with : rows[i / 2 % ROWS].without;
        json_t *functionals = json_array();
        for (int k = 0; k < 2 && !isnan(value); k++)
            json_array_append_new(functionals,
                                  result_object("name=%s value=%g reference=%g",
                                                k ? "growth_rate" : "velocity_rms", value, 0.));
        pool.jobs[i].document = result_object(
            "status=%s functionals=%p", isinf(value) ? "broke_down" : "ok", (void *)functionals);
    }
    json_t *list = claims_judge(&claims, &pool);
    assert_int_equal(json_array_size(list), 4);
    json_array_foreach(list, c, claim) {
        assert_string_equal(value_text(claim, "verdict"), verdicts[c]);
        json_array_foreach(json_object_get(claim, "rows"), r, row)
            assert_string_equal(value_text(row, "verdict"), rows[all++ % ROWS].verdict);
    }
    assert_int_equal(2 * all, pool.count);
    json_decref(list);
    claims_free(&claims);
    pool_free(&pool);
}

/* Verdicts on the claim that only kernels with negative values of their transforms form pairs. */
TEST(pairing_in_words)
{
    static const struct {
        double others, wendland; /* share of pairs; NaN: the runs broke down */
        const char *verdict, *of_cubic;
        bool uncertified; /* Wendland's functions */
    } rows[] = {
        {0.02, 0.01, "not shown: no such kernel was certified", "pairs from 16 on", true},
        {(double)NAN, (double)NAN, "not shown: runs broke down", "all runs broke down", false},
        {0.02, 0.01, "holds", "pairs from 16 on", false},
        {0.005, 0, "not shown: no other kernel has pairs", "no pairs up to ", false},
        {0.02, (double)NAN, "not shown: runs broke down", "pairs from 16 on", false},
        {0, 0.5004999996, "does not hold: wendland_c2 in 2D has 50.0 % in pairs at ",
         "no pairs up to ", false}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        struct pairing pairing = {0};
        struct pool pool = {0};
        struct error error = {0};
        json_t *kernels = json_array(), *list, *ladder;
        size_t k;
        assert_int_equal(pairing_plan(&pairing, false, &pool, &error), STATUS_OK);
        for (size_t i = 0; i < pool.count; i++) {
            const struct run *run = pool.jobs[i].context;
            char kernel[SETTING_TEXT_MAX];
            settings_text(&run->settings, SETTING_kernel, kernel);
            const bool wendland = strncmp(kernel, "wendland", 8) == 0;
            const double paired = wendland ? rows[r].wendland : rows[r].others;
            if (!isnan(paired))
                pool.jobs[i].document = json_pack("{s:s, s:{s:f, s:f}}", "status", "ok",
                                                  "regularity", "paired", paired, "nearest", 0.5);
            if (!wendland || !rows[r].uncertified)
                json_array_append_new(kernels, json_pack("{s:s, s:i, s:o, s:{s:o}}", "kernel",
                                                         kernel, "dim", 2, "pairing_neighbours",
                                                         wendland ? json_null() : json_real(16),
                                                         "fourier", "first_negative_kh",
                                                         wendland ? json_null() : json_real(5)));
        }
        list = pairing_judge(&pairing, &pool, kernels);
        json_array_foreach(json_object_get(json_array_get(list, 0), "ladders"), k, ladder)
            if (strcmp(value_text(ladder, "kernel"), "cubic_spline") == 0 &&
                value_member(ladder, "dim") == 2 &&
                (strncmp(value_text(ladder, "verdict"), rows[r].of_cubic,
                         strlen(rows[r].of_cubic)) ||
                 strstr(value_text(ladder, "verdict"), "before")))
                fail_msg("row %zu: %s", r, value_text(ladder, "verdict"));
        all_say(list, rows[r].verdict);
        json_decref(kernels);
        pairing_free(&pairing);
        pool_free(&pool);
    }
}
