/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report.h"

#include <gsl/gsl_errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "buffer.h"
#include "cases.h"
#include "check_registry.h"
#include "claims.h"
#include "clock.h"
#include "gates.h"
#include "list.h"
#include "problem_list.h"
#include "report_piece.h"
#include "result.h"
#include "stress.h"
#include "study.h"
#include "suite.h"
#include "value.h"

/* The default scheme, and in 1D the two gradients with equal other settings; in 2D and 3D the
 * default with the other gradient, and textbook SPH. */
static const struct scheme_label {
    const char *label, *keys;
    const struct run_settings *other; /* the settings if another code computes it; */
    const char *option;               /* its option on a command line */
} line_schemes[] =
    {
        {.label = "default", .keys = ""},
        {.label = "standard",
         .keys = "kernel=cubic_spline eta=2 gradient=standard integrator=modified_leapfrog "
                 "energy=internal"},
        {.label = "ia",
         .keys =
             "kernel=cubic_spline eta=2 gradient=ia integrator=modified_leapfrog energy=internal"},
},
  cloud_schemes[] = {
      {.label = "default", .keys = ""},
      {.label = "standard gradient", .keys = "gradient=standard"},
      {.label = "textbook SPH",
       .keys = "kernel=cubic_spline eta=2.4 gradient=standard viscosity=constant"},
};
enum { SCHEMES = sizeof line_schemes / sizeof *line_schemes };
enum { ENTRIES = SCHEMES + REPORT_CODES_MAX };
enum { MORE = CASE_LADDER_MAX * sizeof ",18446744073709551615" + sizeof " --n " };
enum { COMPARED = 8000 }; /* largest number of particles by day for which other schemes run */

/* The schemes, runs and studies of one case. */
struct reported {
    const char *name;
    int dimension, schemes, studied; /* number of entries that have a run, and a study */
    struct scheme_label entries[ENTRIES];
    char more[ENTRIES][MORE]; /* additional words on the command lines of the studies */
    char size[32];            /* size on the command lines of the runs: "n=48^2", or nothing */
    struct study studies[ENTRIES];
};

struct report {
    bool nightly;
    double began; /* start, by clock_wall */
    struct pool pool;
    struct reported *cases;
    struct report_piece **pieces; /* allocated one by one: the pool keeps pointers to them */
    size_t case_count, piece_count;
    struct stress stress;
    struct claims claims;
    struct pairing pairing;
    const struct report_code *codes; /* set in a report of other codes */
    size_t code_count;
};

/* ---- plan ---- */

/* The case with the scheme's keys. In a report of other codes our own schemes are not judged. */
static enum status prepare(const struct reported *of, int s, struct run_settings *settings,
                           struct error *error)
{
    const struct scheme_label *scheme = &of->entries[s];
    const struct run_settings *other = of->entries[0].other;
    if (!other && run_prepare(settings, of->name, 0, NULL, error)) return error->status;
    if (other) *settings = scheme->other ? *scheme->other : *other;
    if (other && !scheme->other) settings->external = NULL, settings->file.gate_count = 0;
    char words[256];
    snprintf(words, sizeof words, "%s %s", of->size, scheme->keys);
    return settings_apply_words(&settings->settings, words, error);
}

/* Sets the ladder of a case: its own, by day the smaller one if there is one, by night with added
 * levels. */
static void take_ladder(const struct report *report, struct reported *of, int s)
{
    struct study *study = &of->studies[s];
    const struct case_file *file = &study->settings.file;
    const bool codes = report->codes, day = !report->nightly && file->quick_count && !codes;
    const size_t *from = day ? file->quick : file->ladder;
    size_t *n = &study->level_count;
    memcpy(study->ladder, from, sizeof study->ladder);
    *n = day ? file->quick_count : file->ladder_count;
    for (size_t i = 0; report->nightly && i < file->night_count; i++)
        study->ladder[(*n)++] = file->night[i];
    if (report->nightly && !file->night_count)
        study->ladder[*n] = study->ladder[*n - 1] << file->dimension, ++*n;
    if (codes ? of->entries[s].other != NULL : !day && !report->nightly) return;
    int used = 0;
    for (size_t i = 0; i < *n; i++)
        used += sprintf(of->more[s] + used, "%s%zu", i ? "," : " --n ", study->ladder[i]);
}

static enum status add_study(struct report *report, struct reported *of, int s,
                             const struct run_settings *settings, struct error *error)
{
    struct study *study = &of->studies[s];
    study->settings = *settings;
    study->sweep.count = 1; /* without a key that varies */
    if (s && !report->codes) gates_compare(&study->settings.file);
    take_ladder(report, of, s);
    study->replicates = study_replicates(settings);
    return study_plan(study, &report->pool, error);
}

static enum status add_piece(struct report *report, struct report_piece piece, struct error *error)
{
    struct report_piece *kept = malloc(sizeof *kept);
    if (!kept || !list_grow(&report->pieces, report->piece_count, sizeof *report->pieces)) {
        free(kept);
        return error_set(error, STATUS_ENVIRONMENT, "no memory for a piece of the report");
    }
    piece.slow = report->nightly;
    *kept = piece;
    report->pieces[report->piece_count++] = kept;
    return report_piece_add(&report->pool, kept, error);
}

/* Plans a case from its file, which has a ladder. By day in 2D and 3D a run is as large as the
 * ladder's finest level and part of the ladder; only the default scheme has a ladder. */
static void plan_case(const struct report *report, const struct case_file *file,
                      struct reported *of)
{
    const size_t *ladder = file->quick_count ? file->quick : file->ladder;
    const size_t levels = file->quick_count ? file->quick_count : file->ladder_count;
    const size_t n = ladder[levels - 1];
    of->dimension = file->dimension;
    of->studied = of->schemes = SCHEMES;
    if (report->nightly || file->dimension == 1) return;
    snprintf(of->size, sizeof of->size, "n=%zu", n);
    of->studied = levels >= ORDER_LEVELS_MIN;
    /* expensive cases run with one scheme */
    if (n > COMPARED) of->schemes = 1;
}

static enum status find_cases(struct report *report, struct error *error)
{
    for (const struct case_builtin *builtin = case_builtins; builtin->name; builtin++) {
        struct case_file file;
        if (case_load(&file, builtin->name, error)) return error->status;
        if (problem_of(&file.settings)->liquid) continue; /* our solver runs the others */
        if (!list_grow(&report->cases, report->case_count, sizeof *report->cases))
            return error_set(error, STATUS_ENVIRONMENT, "no memory for the cases");
        struct reported *of = &report->cases[report->case_count++];
        *of = (struct reported){.name = builtin->name};
        memcpy(of->entries, file.dimension > 1 ? cloud_schemes : line_schemes, sizeof line_schemes);
        plan_case(report, &file, of);
    }
    return STATUS_OK;
}

/* Adds the runs first: a study reuses them as levels. */
static enum status add_case(struct report *report, size_t c, struct error *error)
{
    struct reported *of = &report->cases[c];
    struct run_settings settings;
    for (int s = 0; s < of->schemes; s++) {
        struct report_piece run = {
            .kind = REPORT_RUN, .where = of->name, .case_number = c, .scheme = s};
        if (prepare(of, s, &run.settings, error) || add_piece(report, run, error))
            return error->status;
    }
    for (int s = 0; s < of->studied; s++)
        if (prepare(of, s, &settings, error) || add_study(report, of, s, &settings, error))
            return error->status;
    return STATUS_OK;
}

/* Adds every case with every scheme, and cost against error for cases with a ladder, in 2D and 3D
 * only at night. */
static enum status add_cases(struct report *report, struct error *error)
{
    if (find_cases(report, error)) return error->status;
    for (size_t c = 0; c < report->case_count; c++)
        if (add_case(report, c, error)) return error->status;
    for (size_t c = 0; c < report->case_count; c++) {
        const struct reported *of = &report->cases[c];
        struct report_piece bench = {.kind = REPORT_BENCH,
                                     .where = of->name,
                                     .rules = {.least_s = 0.01, .most_s = 1, .samples = 3}};
        if (prepare(of, 0, &bench.settings, error)) return error->status;
        if (of->studied && bench.settings.file.bench && (of->dimension == 1 || report->nightly) &&
            add_piece(report, bench, error))
            return error->status;
    }
    return STATUS_OK;
}

/* Measures what skipped work saves in tubes and blasts, early and late, and in converging
 * inflow. */
static enum status add_skips(struct report *report, struct error *error)
{
    static const struct {
        const char *name, *keys;
    } setups[] = {{"sod", "n=1600"},
                  {"noh_1d", "n=800"},
                  {"sod_2d", "n=5600 t_end=0.03"},
                  {"sod_2d", "n=5600"},
                  {"sedov_2d", "n=64^2 t_end=0.01"},
                  {"sedov_2d", "n=64^2"},
                  {"sedov_3d", "n=24^3 t_end=0.002"},
                  {"noh_2d", "n=40^2"}};
    for (size_t k = 0; k < sizeof setups / sizeof *setups; k++) {
        struct report_piece skips = {.kind = REPORT_SKIPS,
                                     .where = setups[k].name,
                                     .rules = {.least_s = 0.01, .most_s = 2, .samples = 3}};
        snprintf(skips.keys, sizeof skips.keys, "%s", setups[k].keys);
        if (run_prepare(&skips.settings, skips.where, 0, NULL, error) ||
            settings_apply_words(&skips.settings.settings, skips.keys, error) ||
            add_piece(report, skips, error))
            return error->status;
    }
    return STATUS_OK;
}

/* Autopsies of lost orders in vortices and in waves oblique to the lattice. */
static enum status add_autopsies(struct report *report, struct error *error)
{
    static const struct {
        const char *name, *key, *words, *day, *night;
    } looked_at[] = {
        {"yee", "", "", "20^2,24^2,32^2,40^2", "32^2,48^2,64^2,96^2"},
        {"gresho", "", "", "16^2,20^2,24^2,32^2", "32^2,48^2,64^2,96^2"},
        {"sound_wave_2d", "direction=2 1", "direction=\"2 1\"", "24^2,32^2,40^2,48^2",
         "32^2,48^2,64^2,96^2"},
        {"sound_wave_2d", "direction=1 1", "direction=\"1 1\"", NULL, "32^2,48^2,64^2,96^2"},
        {"sound_wave_3d", "", "", NULL, "14^3,16^3,20^3,24^3"}};
    for (size_t k = 0; k < sizeof looked_at / sizeof *looked_at; k++) {
        struct report_piece piece = {.kind = REPORT_AUTOPSY,
                                     .where = looked_at[k].name,
                                     .sizes =
                                         report->nightly ? looked_at[k].night : looked_at[k].day};
        char key[32], *keys[] = {key};
        if (!piece.sizes) continue;
        snprintf(key, sizeof key, "%s", looked_at[k].key);
        snprintf(piece.keys, sizeof piece.keys, "%s", looked_at[k].words);
        if (run_prepare(&piece.settings, piece.where, *key != 0, keys, error) ||
            add_piece(report, piece, error))
            return error->status;
    }
    return STATUS_OK;
}

static enum status add_checks(struct report *report, struct error *error)
{
    size_t count;
    const char **groups = suite_groups(check_registry, check_registry_count, &count);
    enum status status = groups ? STATUS_OK : error_set(error, STATUS_ENVIRONMENT, "no memory");
    for (size_t g = 0; g < count && !status; g++)
        status = add_piece(report, (struct report_piece){.kind = REPORT_CHECKS, .where = groups[g]},
                           error);
    free(groups);
    return status;
}

static enum status add_kernels(struct report *report, struct error *error)
{
    for (size_t k = 0; k < kernel_family.n; k++)
        for (int dim = 1; dim <= 3; dim++) {
            const struct report_piece kernel = {
                .kind = REPORT_KERNEL, .where = kernel_family.members[k]->name, .dim = dim};
            if (add_piece(report, kernel, error)) return error->status;
        }
    return STATUS_OK;
}

static enum status add_all(struct report *report, struct error *error)
{
    const struct report_piece league = {.kind = REPORT_LEAGUE, .where = "operators"};
    if (add_cases(report, error) || add_skips(report, error) || add_autopsies(report, error) ||
        add_checks(report, error) || add_piece(report, league, error) ||
        add_kernels(report, error) ||
        claims_plan(&report->claims, report->nightly, &report->pool, error) ||
        pairing_plan(&report->pairing, report->nightly, &report->pool, error))
        return error->status;
    return stress_plan(&report->stress, report->nightly, 0, NULL, &report->pool, error);
}

/* ---- results ---- */

/* more: text after the keys, beginning with a blank, or "". */
static void describe(const char *command, const struct reported *of, int s, const char *more,
                     json_t *document)
{
    struct buffer reproduce = {0};
    const struct scheme_label *scheme = &of->entries[s];
    buffer_format(&reproduce, "sphproof %s %s%s%s%s%s", command, of->name, more,
                  *scheme->keys ? " " : "", scheme->keys, scheme->option ? scheme->option : "");
    result_add(document, "label=%s reproduce=%s", scheme->label,
               reproduce.data ? reproduce.data : "");
    buffer_free(&reproduce);
}

static json_t *study_document(const struct reported *of, int s)
{
    const struct study *study = &of->studies[s];
    const struct run_external *external = study->settings.external;
    json_t *document = result_new("converge");
    result_add(document, "case=%s title=%s status=%s", study->settings.file.name,
               study->settings.file.title,
               study->status == STATUS_BROKE_DOWN ? (external ? "failed" : "broke_down")
               : study->status                    ? "fail"
                                                  : "pass");
    study_add_json(study, document);
    if (external) external->describe(external, document);
    describe("converge", of, s, of->more[s], document);
    return document;
}

/* Two schemes of a case with bitwise equal errors suggest that a setting was not read. */
static void suspect_same(const struct reported *of, json_t *documents[ENTRIES])
{
    for (int s = 1; s < of->studied; s++) {
        const struct study_result *a = &of->studies[s - 1].results[0],
                                  *b = &of->studies[s].results[0];
        char why[SUSPICION_TEXT];
        if (study_suspect_same("the scheme", a, b, why))
            result_add(documents[s], "suspicion=%s", why);
    }
}

/* Records a piece without a result: its process crashed, or it was refused. */
static void add_trouble(json_t *results, const char *name, const char *message)
{
    json_t *list = json_object_get(results, "trouble");
    if (!list) json_object_set_new(results, "trouble", list = json_array());
    json_array_append_new(list, result_object("name=%s message=%s", name, message));
}

/* In 2D and 3D: gates on what every run conserves, and on errors of cases without a ladder. */
static void add_gates(const struct reported *of, const struct report_piece *piece, json_t *document)
{
    struct case_file file = piece->settings.file;
    const bool external = piece->settings.external;
    json_t *gates = json_array();
    if (piece->scheme && !external) gates_compare(&file);
    if (piece->scheme >= of->studied) gates_add_errors(&file, document, gates);
    if (!external) gates_add_conserved(document, gates);
    json_object_set_new(document, "gates", gates);
}

static json_t *run_document(const struct report *report, const struct report_piece *piece,
                            const struct pool_job *job)
{
    const struct reported *of = &report->cases[piece->case_number];
    json_t *document = json_copy(job->document);
    char size[40] = "";
    if (*of->size) snprintf(size, sizeof size, " %s", of->size);
    describe("run", of, piece->scheme, size, document);
    result_add(document, "dimension=%d", of->dimension);
    if (of->dimension > 1 && strcmp(value_text(document, "status"), "ok") == 0)
        add_gates(of, piece, document);
    return document;
}

static void add_checks_of(const struct report *report, json_t *results, json_t *part)
{
    json_t *verify = json_object_get(results, "verify");
    if (!verify) {
        json_object_set_new(results, "verify", verify = result_new("verify"));
        result_add(verify, "reproduce=%s",
                   report->nightly ? "sphproof verify --slow" : "sphproof verify");
    }
    report_piece_join(verify, part);
}

static void add_documents(struct report *report, json_t *results)
{
    static const char *const lists[] = {[REPORT_RUN] = "runs",
                                        [REPORT_KERNEL] = "kernels",
                                        [REPORT_BENCH] = "bench",
                                        [REPORT_SKIPS] = "skips",
                                        [REPORT_AUTOPSY] = "autopsies"};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        if (lists[i]) json_object_set_new(results, lists[i], json_array());
    for (size_t k = 0; k < report->piece_count; k++) {
        const struct report_piece *piece = report->pieces[k];
        const struct pool_job *job = &report->pool.jobs[piece->job];
        if (!job->document)
            add_trouble(results, piece->where, job->error.message);
        else if (piece->kind == REPORT_LEAGUE)
            json_object_set(results, "gradients", job->document);
        else if (piece->kind == REPORT_CHECKS)
            add_checks_of(report, results, job->document);
        else /* of a run a copy: schemes with equal settings share the job */
            json_array_append_new(json_object_get(results, lists[piece->kind]),
                                  piece->kind == REPORT_RUN ? run_document(report, piece, job)
                                                            : json_incref(job->document));
    }
}

/* Adds FOLDER/NAME.json, which a script may have written. */
static void add_written(json_t *results, const char *name, const char *folder)
{
    struct error error;
    json_t *document;
    char path[1024];
    snprintf(path, sizeof path, "%.960s/%s.json", folder ? folder : "", name);
    if (!folder || access(path, F_OK)) return;
    if (!result_load(&document, path, &error))
        json_object_set_new(results, name, document);
    else
        add_trouble(results, name, error.message);
}

/* Adds the parts that only a report of our own program has. */
static void add_own(struct report *report, const char *folder, json_t *results)
{
    json_t *stress = result_new("stress");
    stress_judge(&report->stress, &report->pool, stress);
    json_object_set_new(results, "stress", stress);
    json_t *claims = claims_judge(&report->claims, &report->pool);
    json_t *pairing =
        pairing_judge(&report->pairing, &report->pool, json_object_get(results, "kernels"));
    json_array_extend(claims, pairing);
    json_decref(pairing);
    json_object_set_new(results, "claims", claims);
    add_written(results, "faults", folder);
    add_written(results, "score", folder);
}

static json_t *collect(struct report *report, const char *folder, double seconds)
{
    json_t *results = result_new("report"), *studies = json_array();
    result_add(results, "mode=%s seconds=%g computations=%zu found=%zu",
               report->codes     ? "code"
               : report->nightly ? "nightly"
                                 : "quick",
               seconds, report->pool.count, report->pool.found);
    for (size_t c = 0; c < report->case_count; c++) {
        const struct reported *of = &report->cases[c];
        json_t *documents[ENTRIES];
        for (int s = 0; s < of->studied; s++) {
            documents[s] = study_document(of, s);
            json_array_append_new(studies, documents[s]);
        }
        if (of->studied && !report->codes) suspect_same(of, documents);
    }
    json_object_set_new(results, "studies", studies);
    add_documents(report, results);
    if (report->codes)
        code_cost_add(results);
    else
        add_own(report, folder, results);
    return results;
}

/* Ends the report if memory or processes are lacking, since it may succeed later. A crash or a
 * refusal, which only a defect of this program can cause, is a result: see add_trouble. */
static enum status sound(const struct pool *pool, struct error *error)
{
    for (size_t k = 0; k < pool->count; k++) {
        const struct error *said = &pool->jobs[k].error;
        if (said->status == STATUS_ENVIRONMENT)
            return error_set(error, said->status, "%s: %.400s", pool->jobs[k].name, said->message);
    }
    return STATUS_OK;
}

static enum status judge_studies(struct report *report, struct error *error)
{
    enum status status = STATUS_OK;
    for (size_t c = 0; c < report->case_count; c++)
        for (int s = 0; s < ENTRIES && !status; s++) /* empty ones have nothing to judge */
            status = study_judge(&report->cases[c].studies[s], &report->pool, error);
    return status;
}

void report_destroy(struct report *report)
{
    if (!report) return;
    for (size_t c = 0; report->cases && c < report->case_count; c++)
        for (int s = 0; s < ENTRIES; s++) study_free(&report->cases[c].studies[s]);
    for (size_t k = 0; k < report->piece_count; k++) free(report->pieces[k]);
    stress_free(&report->stress);
    claims_free(&report->claims);
    pairing_free(&report->pairing);
    pool_free(&report->pool);
    free(report->cases), free(report->pieces);
    free(report);
}

/* ---- other codes ---- */

static struct reported *reported_of(struct report *report, const struct case_file *file)
{
    for (size_t c = 0; c < report->case_count; c++)
        if (strcmp(report->cases[c].name, file->asked) == 0) return &report->cases[c];
    if (!list_grow(&report->cases, report->case_count, sizeof *report->cases)) return NULL;
    struct reported *of = &report->cases[report->case_count++];
    *of = (struct reported){.name = file->asked, .dimension = file->dimension};
    if (file->ladder_count)
        snprintf(of->size, sizeof of->size, "n=%zu", file->ladder[file->ladder_count - 1]);
    return of;
}

/* Adds the codes before our schemes, because the first entry of a case judges it. */
static enum status add_codes(struct report *report, struct error *error)
{
    for (size_t k = 0; k < report->code_count; k++)
        for (size_t c = 0; c < report->codes[k].count; c++) {
            const struct report_code *code = &report->codes[k];
            struct reported *of = reported_of(report, &code->cases[c].file);
            if (!of) return error_set(error, STATUS_ENVIRONMENT, "no memory for the cases");
            of->entries[of->schemes++] =
                (struct scheme_label){code->title, "", &code->cases[c], code->option};
        }
    for (size_t c = 0; c < report->case_count; c++) {
        struct reported *of = &report->cases[c];
        const struct scheme_label *ours = of->dimension > 1 ? cloud_schemes : line_schemes;
        of->entries[of->schemes++] = ours[0];
        of->entries[of->schemes] = of->dimension > 1 ? ours[2] : ours[1];
        of->entries[of->schemes++].label = "textbook SPH";
        of->studied = *of->size ? of->schemes : 0;
        if (add_case(report, c, error)) return error->status;
    }
    return STATUS_OK;
}

enum status report_create(bool nightly, const struct report_code *codes, size_t count,
                          struct report **report, struct error *error)
{
    *report = calloc(1, sizeof **report);
    if (!*report) return error_set(error, STATUS_ENVIRONMENT, "no memory for a report");
    (*report)->nightly = nightly;
    (*report)->codes = codes;
    (*report)->code_count = count;
    (*report)->began = clock_wall();
    gsl_set_error_handler_off();
    const enum status status = (codes ? add_codes : add_all)(*report, error);
    if (status) {
        report_destroy(*report);
        *report = NULL;
    }
    return status;
}

struct pool *report_pool(struct report *report)
{
    return &report->pool;
}

enum status report_judge(struct report *report, const char *folder, json_t **results,
                         struct error *error)
{
    *results = NULL;
    if (sound(&report->pool, error) || judge_studies(report, error)) return error->status;
    *results = collect(report, folder, clock_wall() - report->began);
    return STATUS_OK;
}
