/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report.h"

#include <gsl/gsl_errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cases.h"
#include "check_registry.h"
#include "claims.h"
#include "clock.h"
#include "gates.h"
#include "list.h"
#include "pairing.h"
#include "pool.h"
#include "report_piece.h"
#include "result.h"
#include "stress.h"
#include "study.h"
#include "suite.h"
#include "value.h"
#include "verdict.h"

/* The default scheme, and in 1D the two gradients with all else equal; in 2D and 3D the default
 * with the other gradient, and SPH as textbooks have it. */
static const struct scheme_label {
    const char *label, *keys;
} line_schemes[] =
    {
        {"default", ""},
        {"standard", "kernel=cubic_spline eta=2 gradient=standard integrator=modified_leapfrog "
                     "energy=internal"},
        {"ia",
         "kernel=cubic_spline eta=2 gradient=ia integrator=modified_leapfrog energy=internal"},
},
  cloud_schemes[] = {
      {"default", ""},
      {"standard gradient", "gradient=standard"},
      {"textbook SPH", "kernel=cubic_spline eta=2.4 gradient=standard viscosity=constant"},
};
enum { SCHEMES = sizeof line_schemes / sizeof *line_schemes };
enum { KEYS_MAX = 16, COMMAND_TEXT = 1024 };
enum { COMPARED = 8000 }; /* particles by day up to which other schemes are compared */
enum { QUICK = 1000 };    /* particles by day of a case in 2D or 3D that says nothing else */

/* What a report has of a case. */
struct reported {
    const char *name;
    int dimension, schemes, studied; /* so many of the schemes have a run, and a study */
    char more[256]; /* what the command line of its studies has beside their keys */
    char size[32];  /* what that of its runs has: "n=48^2", or nothing */
    struct study studies[SCHEMES];
};

struct report {
    bool nightly;
    double began; /* of clock_wall */
    struct pool pool;
    struct reported *cases;
    struct report_piece **pieces; /* one by one: the pool keeps where they are */
    size_t case_count, piece_count;
    struct stress stress;
    struct claims claims;
    struct pairing pairing;
};

/* ---- what is to be computed ---- */

static const struct scheme_label *scheme_of(const struct reported *of, int s)
{
    return &(of->dimension > 1 ? cloud_schemes : line_schemes)[s];
}

/* The case with the scheme's keys. */
static enum status prepare(const struct reported *of, int s, struct run_settings *settings,
                           struct error *error)
{
    char text[512], *arguments[KEYS_MAX], *rest = text;
    int n = 0;
    snprintf(text, sizeof text, "%s %s", of->size, scheme_of(of, s)->keys);
    for (char *word; (word = strtok_r(rest, " ", &rest));) {
        if (n == KEYS_MAX)
            return error_set(error, STATUS_ENVIRONMENT, "scheme %s: more than %d keys",
                             scheme_of(of, s)->label, KEYS_MAX);
        arguments[n++] = word;
    }
    return run_prepare(settings, of->name, n, arguments, error);
}

/* The ladder of a case: its own, by day a smaller one if it has one, by night with more on top. */
static void take_ladder(const struct report *report, struct reported *of, struct study *study)
{
    const struct case_file *file = &study->settings.file;
    const bool day = !report->nightly && file->quick_count;
    const size_t *from = day ? file->quick : file->ladder;
    size_t *n = &study->level_count;
    memcpy(study->ladder, from, sizeof study->ladder);
    *n = day ? file->quick_count : file->ladder_count;
    if (report->nightly && file->night_count)
        for (size_t i = 0; i < file->night_count && *n < CASE_LADDER_MAX; i++)
            study->ladder[(*n)++] = file->night[i];
    else if (report->nightly && *n < CASE_LADDER_MAX)
        study->ladder[*n] = study->ladder[*n - 1] << file->dimension, ++*n;
    if (study->ladder[*n - 1] == file->ladder[file->ladder_count - 1] && !day) return;
    int used = snprintf(of->more, sizeof of->more, " --n ");
    for (size_t i = 0; i < *n && used < (int)sizeof of->more; i++)
        used += snprintf(of->more + used, sizeof of->more - (size_t)used, "%s%zu", i ? "," : "",
                         study->ladder[i]);
}

static enum status add_study(struct report *report, struct reported *of, int s,
                             const struct run_settings *settings, struct error *error)
{
    struct study *study = &of->studies[s];
    study->settings = *settings;
    if (sweep_parse(&study->sweep, NULL, error)) return error->status;
    if (s) gates_compare(&study->settings.file);
    take_ladder(report, of, study);
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

/* What a report has of a case, from its file. By day in 2D and 3D runs are as large as the ladder's
 * finest level, of which they are then a part; and only the default scheme has a ladder. */
static void plan_case(const struct report *report, const struct case_file *file,
                      struct reported *of)
{
    const bool quick = !report->nightly, cloud = file->dimension > 1;
    const size_t *ladder = file->quick_count ? file->quick : file->ladder;
    const size_t levels = file->quick_count ? file->quick_count : file->ladder_count;
    of->dimension = file->dimension;
    of->schemes = SCHEMES;
    of->studied = file->ladder_count ? of->schemes : 0;
    if (!quick || !cloud) return;
    const size_t own = (size_t)settings_real(&file->settings, SETTING_n);
    const size_t n = levels ? ladder[levels - 1] : own < QUICK ? own : QUICK;
    snprintf(of->size, sizeof of->size, "n=%zu", n);
    of->studied = levels >= ORDER_LEVELS_MIN;
    /* what takes long has no time for other schemes */
    if (n > COMPARED) of->schemes = 1;
}

static enum status find_cases(struct report *report, struct error *error)
{
    for (const struct case_builtin *builtin = case_builtins; builtin->name; builtin++) {
        struct case_file file;
        if (case_load(&file, builtin->name, error)) return error->status;
        if (!list_grow(&report->cases, report->case_count, sizeof *report->cases))
            return error_set(error, STATUS_ENVIRONMENT, "no memory for the cases");
        struct reported *of = &report->cases[report->case_count++];
        *of = (struct reported){.name = builtin->name};
        plan_case(report, &file, of);
    }
    return STATUS_OK;
}

/* The runs first: a study takes what is there of its levels. */
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

/* Every case with every scheme; what an error costs in those that have a ladder, in 2D and 3D by
 * night. */
static enum status add_cases(struct report *report, struct error *error)
{
    if (find_cases(report, error)) return error->status;
    for (size_t c = 0; c < report->case_count; c++)
        if (add_case(report, c, error)) return error->status;
    for (size_t c = 0; c < report->case_count; c++) {
        const struct reported *of = &report->cases[c];
        struct report_piece bench = {.kind = REPORT_BENCH, .where = of->name};
        if (prepare(of, 0, &bench.settings, error)) return error->status;
        if (of->studied && bench.settings.file.bench && (of->dimension == 1 || report->nightly) &&
            add_piece(report, bench, error))
            return error->status;
    }
    return STATUS_OK;
}

/* What sleep saves in tubes and blasts, early and in full, and in inflow that converges. */
static enum status add_skips(struct report *report, struct error *error)
{
    static const struct {
        const char *name, *keys[2];
    } setups[] = {{"sod", {"n=1600"}},
                  {"noh_1d", {"n=800"}},
                  {"sod_2d", {"n=5600", "t_end=0.03"}},
                  {"sod_2d", {"n=5600"}},
                  {"sedov_2d", {"n=64^2", "t_end=0.01"}},
                  {"sedov_2d", {"n=64^2"}},
                  {"sedov_3d", {"n=24^3", "t_end=0.002"}},
                  {"noh_2d", {"n=40^2"}}};
    for (size_t k = 0; k < sizeof setups / sizeof *setups; k++) {
        struct report_piece skips = {.kind = REPORT_SKIPS, .where = setups[k].name};
        char words[2][40], *keys[] = {words[0], words[1]};
        int count = 0;
        for (; count < 2 && setups[k].keys[count]; count++)
            snprintf(words[count], sizeof words[count], "%s", setups[k].keys[count]);
        snprintf(skips.keys, sizeof skips.keys, "%s%s%s", words[0], count > 1 ? " " : "",
                 count > 1 ? words[1] : "");
        if (run_prepare(&skips.settings, skips.where, count, keys, error) ||
            add_piece(report, skips, error))
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

static enum status add_all(struct report *report, struct error *error)
{
    if (add_cases(report, error) || add_skips(report, error) || add_checks(report, error))
        return error->status;
    if (add_piece(report, (struct report_piece){.kind = REPORT_LEAGUE, .where = "operators"},
                  error))
        return error->status;
    for (size_t k = 0; k < kernel_family.n; k++)
        for (int dim = 1; dim <= 3; dim++) {
            const char *name = kernel_family.members[k]->name;
            if (add_piece(report,
                          (struct report_piece){.kind = REPORT_KERNEL, .where = name, .dim = dim},
                          error))
                return error->status;
        }
    if (claims_plan(&report->claims, report->nightly, &report->pool, error) ||
        pairing_plan(&report->pairing, report->nightly, &report->pool, error))
        return error->status;
    return stress_plan(&report->stress, report->nightly, 0, NULL, &report->pool, error);
}

/* ---- what has come out ---- */

/* more: beside the keys, with a blank before it, or "". */
static void describe(const char *command, const struct reported *of, int s, const char *more,
                     json_t *document)
{
    char reproduce[COMMAND_TEXT];
    const char *keys = scheme_of(of, s)->keys;
    snprintf(reproduce, sizeof reproduce, "sphproof %s %s%s%s%s", command, of->name, more,
             *keys ? " " : "", keys);
    json_object_set_new(document, "label", json_string(scheme_of(of, s)->label));
    json_object_set_new(document, "reproduce", json_string(reproduce));
}

static void describe_run(const struct reported *of, int s, json_t *document)
{
    char size[40] = "";
    if (*of->size) snprintf(size, sizeof size, " %s", of->size);
    describe("run", of, s, size, document);
    json_object_set_new(document, "dimension", json_integer(of->dimension));
}

static json_t *study_document(const struct reported *of, int s)
{
    const struct study *study = &of->studies[s];
    json_t *document = result_new("converge");
    json_object_set_new(document, "case", json_string(study->settings.file.name));
    json_object_set_new(document, "title", json_string(study->settings.file.title));
    json_object_set_new(document, "status",
                        json_string(study->status == STATUS_BROKE_DOWN ? "broke_down"
                                    : study->status                    ? "fail"
                                                                       : "pass"));
    study_add_json(study, document);
    describe("converge", of, s, of->more, document);
    return document;
}

/* Two schemes of a case with the same errors to the last bit: one setting was not read. */
static void suspect_same(const struct reported *of, json_t *documents[SCHEMES])
{
    for (int s = 1; s < of->studied; s++) {
        const struct study_result *a = &of->studies[s - 1].results[0],
                                  *b = &of->studies[s].results[0];
        char why[SUSPICION_TEXT];
        if (study_suspect_same("the scheme", a, b, why))
            json_object_set_new(documents[s], "suspicion", json_string(why));
    }
}

/* What gave no result: a piece whose process crashed. */
static void add_trouble(json_t *results, const char *name, const char *message)
{
    json_t *list = json_object_get(results, "trouble");
    if (!list) json_object_set_new(results, "trouble", list = json_array());
    json_array_append_new(list, json_pack("{s:s, s:s}", "name", name, "message", message));
}

/* In 2D and 3D: what every run conserves, and errors where no ladder is judged. */
static void add_gates(const struct reported *of, const struct report_piece *piece, json_t *document)
{
    struct case_file file = piece->settings.file;
    json_t *gates = json_array();
    if (piece->scheme) gates_compare(&file);
    if (piece->scheme >= of->studied) gates_add_errors(&file, document, gates);
    gates_add_conserved(document, gates);
    json_object_set_new(document, "gates", gates);
}

static json_t *run_document(const struct report *report, const struct report_piece *piece,
                            const struct pool_job *job)
{
    const struct reported *of = &report->cases[piece->case_number];
    json_t *document = json_copy(job->document);
    describe_run(of, piece->scheme, document);
    if (of->dimension > 1 && strcmp(value_text(document, "status"), "ok") == 0)
        add_gates(of, piece, document);
    return document;
}

static void add_documents(struct report *report, json_t *results)
{
    json_t *runs = json_array(), *kernels = json_array(), *bench = json_array(),
           *skips = json_array(), *verify = NULL;
    for (size_t k = 0; k < report->piece_count; k++) {
        const struct report_piece *piece = report->pieces[k];
        const struct pool_job *job = &report->pool.jobs[piece->job];
        if (!job->document) {
            add_trouble(results, piece->where, job->error.message);
            continue;
        }
        switch (piece->kind) {
        case REPORT_RUN:
            /* a copy: schemes that come to the same settings share the job */
            json_array_append_new(runs, run_document(report, piece, job));
            break;
        case REPORT_KERNEL:
            json_array_append(kernels, job->document);
            break;
        case REPORT_LEAGUE:
            json_object_set(results, "gradients", job->document);
            break;
        case REPORT_BENCH:
            json_array_append(bench, job->document);
            break;
        case REPORT_SKIPS:
            json_array_append(skips, job->document);
            break;
        case REPORT_CHECKS:
            if (!verify) {
                json_object_set_new(results, "verify", verify = result_new("verify"));
                json_object_set_new(
                    verify, "reproduce",
                    json_string(report->nightly ? "sphproof verify --slow" : "sphproof verify"));
            }
            report_piece_join(verify, job->document);
            break;
        }
    }
    json_object_set_new(results, "runs", runs);
    json_object_set_new(results, "kernels", kernels);
    json_object_set_new(results, "bench", bench);
    json_object_set_new(results, "skips", skips);
}

/* FOLDER/NAME.json, which a script may have written. */
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

static json_t *collect(struct report *report, const char *folder, double seconds)
{
    json_t *results = result_new("report"), *studies = json_array();
    json_object_set_new(results, "mode", json_string(report->nightly ? "nightly" : "quick"));
    json_object_set_new(results, "seconds", result_number(seconds));
    json_object_set_new(results, "computations", json_integer((json_int_t)report->pool.count));
    json_object_set_new(results, "found", json_integer((json_int_t)report->pool.found));
    for (size_t c = 0; c < report->case_count; c++) {
        const struct reported *of = &report->cases[c];
        json_t *documents[SCHEMES];
        for (int s = 0; s < of->studied; s++) {
            documents[s] = study_document(of, s);
            json_array_append_new(studies, documents[s]);
        }
        if (of->studied) suspect_same(of, documents);
    }
    json_object_set_new(results, "studies", studies);
    add_documents(report, results);
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
    json_object_set_new(results, "verdict", verdict_make(results));
    return results;
}

/* What is no result: no memory, no process. A crash is one, see add_trouble. */
static enum status sound(const struct pool *pool, struct error *error)
{
    for (size_t k = 0; k < pool->count; k++) {
        const struct error *said = &pool->jobs[k].error;
        if (said->status == STATUS_ENVIRONMENT || said->status == STATUS_BAD_INPUT)
            return error_set(error, said->status, "%s: %.400s", pool->jobs[k].name, said->message);
    }
    return STATUS_OK;
}

static enum status judge_studies(struct report *report, struct error *error)
{
    enum status status = STATUS_OK;
    for (size_t c = 0; c < report->case_count; c++)
        for (int s = 0; s < report->cases[c].studied && !status; s++)
            status = study_judge(&report->cases[c].studies[s], &report->pool, error);
    return status;
}

void report_destroy(struct report *report)
{
    if (!report) return;
    for (size_t c = 0; report->cases && c < report->case_count; c++)
        for (int s = 0; s < SCHEMES; s++) study_free(&report->cases[c].studies[s]);
    for (size_t k = 0; k < report->piece_count; k++) free(report->pieces[k]);
    stress_free(&report->stress);
    claims_free(&report->claims);
    pairing_free(&report->pairing);
    pool_free(&report->pool);
    free(report->cases), free(report->pieces);
    free(report);
}

enum status report_create(enum report_mode mode, struct report **report, struct error *error)
{
    *report = calloc(1, sizeof **report);
    if (!*report) return error_set(error, STATUS_ENVIRONMENT, "no memory for a report");
    (*report)->nightly = mode == REPORT_NIGHTLY;
    (*report)->began = clock_wall();
    gsl_set_error_handler_off();
    const enum status status = add_all(*report, error);
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
