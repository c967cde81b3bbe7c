/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report.h"

#include <gsl/gsl_errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "check_registry.h"
#include "clock.h"
#include "pool.h"
#include "report_piece.h"
#include "result.h"
#include "stress.h"
#include "study.h"
#include "suite.h"
#include "verdict.h"

/* compared: the schemes below get the case's gates too, with a wider bound of the error; not where
 * one of them is known to have no order yet at these resolutions. benched: what an error costs.
 * deeper: a night adds a level; not where the case says why its ladder ends. */
static const struct {
    const char *name;
    bool compared, benched, deeper;
} cases[] = {{"sod", true, true, true},           {"sod_standard", true, true, true},
             {"strong_shock", false, true, true}, {"two_rarefactions", true, false, false},
             {"lax", true, false, true},          {"sound_wave", true, true, true}};

/* The default scheme, and the two gradients with all else equal. */
static const struct {
    const char *label, *keys;
} schemes[] = {
    {"default", ""},
    {"standard", "kernel=cubic_spline eta=2 gradient=standard integrator=modified_leapfrog "
                 "energy=internal"},
    {"ia", "kernel=cubic_spline eta=2 gradient=ia integrator=modified_leapfrog energy=internal"},
};
/* Of the bound on the finest error, for schemes other than the default. */
static const double compared_bound = 3;

enum { CASES = sizeof cases / sizeof *cases, SCHEMES = sizeof schemes / sizeof *schemes };
enum { KEYS_MAX = 16, PIECES_MAX = 256, COMMAND_TEXT = 1024 };

struct report {
    bool nightly;
    struct pool pool;
    struct study studies[CASES][SCHEMES];
    struct report_piece pieces[PIECES_MAX];
    size_t piece_count;
    struct stress stress;
    char more[CASES][256]; /* what the command line of a study has beside its keys */
};

/* ---- what is to be computed ---- */

/* The case with the scheme's keys. */
static enum status prepare(int c, int s, struct run_settings *settings, struct error *error)
{
    char text[512], *arguments[KEYS_MAX], *rest = text;
    int n = 0;
    snprintf(text, sizeof text, "%s", schemes[s].keys);
    for (char *word; (word = strtok_r(rest, " ", &rest));) {
        if (n == KEYS_MAX)
            return error_set(error, STATUS_ENVIRONMENT, "scheme %s: more than %d keys",
                             schemes[s].label, KEYS_MAX);
        arguments[n++] = word;
    }
    return run_prepare(settings, cases[c].name, n, arguments, error);
}

static enum status add_study(struct report *report, int c, int s, struct error *error)
{
    struct study *study = &report->studies[c][s];
    struct case_file *file = &study->settings.file;
    if (prepare(c, s, &study->settings, error) || sweep_parse(&study->sweep, NULL, error))
        return error->status;
    if (s && !cases[c].compared) file->gate_count = 0;
    for (size_t i = 0; i < file->gate_count && s; i++) file->gates[i].gate.bound *= compared_bound;
    memcpy(study->ladder, file->ladder, sizeof study->ladder);
    study->level_count = file->ladder_count;
    study->seeds = 1;
    if (report->nightly && cases[c].deeper &&
        study->level_count < CASE_LADDER_MAX) { /* one level more */
        char *more = report->more[c];
        study->ladder[study->level_count] = 2 * study->ladder[study->level_count - 1];
        study->level_count++;
        int used = snprintf(more, sizeof report->more[c], " --n ");
        for (size_t i = 0; i < study->level_count && used < (int)sizeof report->more[c]; i++)
            used += snprintf(more + used, sizeof report->more[c] - (size_t)used, "%s%zu",
                             i ? "," : "", study->ladder[i]);
    }
    return study_plan(study, &report->pool, error);
}

static enum status add_piece(struct report *report, struct report_piece piece, struct error *error)
{
    if (report->piece_count == PIECES_MAX)
        return error_set(error, STATUS_ENVIRONMENT, "a report of more than %d pieces", PIECES_MAX);
    struct report_piece *kept = &report->pieces[report->piece_count++];
    piece.slow = report->nightly;
    *kept = piece;
    return report_piece_add(&report->pool, kept, error);
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
    for (int c = 0; c < CASES; c++)
        for (int s = 0; s < SCHEMES; s++) {
            struct report_piece run = {.kind = REPORT_RUN, .where = cases[c].name};
            if (add_study(report, c, s, error) || prepare(c, s, &run.settings, error) ||
                add_piece(report, run, error))
                return error->status;
        }
    for (int c = 0; c < CASES; c++) {
        struct report_piece bench = {.kind = REPORT_BENCH, .where = cases[c].name};
        if (cases[c].benched &&
            (prepare(c, 0, &bench.settings, error) || add_piece(report, bench, error)))
            return error->status;
    }
    if (add_checks(report, error)) return error->status;
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
    return stress_plan(&report->stress, report->nightly, 0, NULL, &report->pool, error);
}

/* ---- what has come out ---- */

static void describe(const char *command, int c, int s, const char *more, json_t *document)
{
    char reproduce[COMMAND_TEXT];
    const char *keys = schemes[s].keys;
    snprintf(reproduce, sizeof reproduce, "sphproof %s %s%s%s%s", command, cases[c].name, more,
             *keys ? " " : "", keys);
    json_object_set_new(document, "label", json_string(schemes[s].label));
    json_object_set_new(document, "reproduce", json_string(reproduce));
}

static json_t *study_document(const struct report *report, int c, int s)
{
    const struct study *study = &report->studies[c][s];
    json_t *document = result_new("converge");
    json_object_set_new(document, "case", json_string(study->settings.file.name));
    json_object_set_new(document, "title", json_string(study->settings.file.title));
    json_object_set_new(document, "status",
                        json_string(study->status == STATUS_BROKE_DOWN ? "broke_down"
                                    : study->status                    ? "fail"
                                                                       : "pass"));
    study_add_json(study, document);
    describe("converge", c, s, report->more[c], document);
    return document;
}

/* Two schemes of a case with the same errors to the last bit: one setting was not read. */
static void suspect_same(const struct report *report, int c, json_t *documents[SCHEMES])
{
    for (int s = 1; s < SCHEMES; s++) {
        const struct study_result *a = &report->studies[c][s - 1].results[0],
                                  *b = &report->studies[c][s].results[0];
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

/* Runs are listed by case and scheme, as they were added. */
static void add_documents(struct report *report, json_t *results)
{
    json_t *runs = json_array(), *kernels = json_array(), *bench = json_array(), *verify = NULL;
    size_t run = 0;
    for (size_t k = 0; k < report->piece_count; k++) {
        const struct report_piece *piece = &report->pieces[k];
        const struct pool_job *job = &report->pool.jobs[piece->job];
        const int c = (int)(run / SCHEMES), s = (int)(run % SCHEMES);
        run += piece->kind == REPORT_RUN;
        if (!job->document) {
            add_trouble(results, piece->where, job->error.message);
            continue;
        }
        switch (piece->kind) {
        case REPORT_RUN:
            describe("run", c, s, "", job->document);
            json_array_append(runs, job->document);
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
}

/* The table of faults, if somebody has written one. */
static void add_faults(json_t *results, const char *path)
{
    struct error error;
    json_t *faults;
    if (!path || access(path, F_OK)) return;
    if (!result_load(&faults, path, &error))
        json_object_set_new(results, "faults", faults);
    else
        add_trouble(results, "faults", error.message);
}

static json_t *collect(struct report *report, const char *faults, double seconds)
{
    json_t *results = result_new("report"), *studies = json_array();
    json_object_set_new(results, "mode", json_string(report->nightly ? "nightly" : "quick"));
    json_object_set_new(results, "seconds", result_number(seconds));
    json_object_set_new(results, "computations", json_integer((json_int_t)report->pool.count));
    json_object_set_new(results, "found", json_integer((json_int_t)report->pool.found));
    for (int c = 0; c < CASES; c++) {
        json_t *documents[SCHEMES];
        for (int s = 0; s < SCHEMES; s++) {
            documents[s] = study_document(report, c, s);
            json_array_append_new(studies, documents[s]);
        }
        suspect_same(report, c, documents);
    }
    json_object_set_new(results, "studies", studies);
    add_documents(report, results);
    json_t *stress = result_new("stress");
    stress_judge(&report->stress, &report->pool, stress);
    json_object_set_new(results, "stress", stress);
    add_faults(results, faults);
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

enum status report_compute(const struct report_settings *settings, json_t **results,
                           struct error *error)
{
    *results = NULL;
    const double began = clock_wall();
    const struct pool_settings how = {.jobs = settings->jobs,
                                      .cache = settings->cache,
                                      .progress = settings->progress,
                                      .progress_context = settings->context};
    struct report *report = calloc(1, sizeof *report);
    if (!report) return error_set(error, STATUS_ENVIRONMENT, "no memory for a report");
    report->nightly = settings->mode == REPORT_NIGHTLY;
    gsl_set_error_handler_off();
    enum status status = add_all(report, error);
    if (!status) status = pool_run(&report->pool, &how, error);
    if (!status) status = sound(&report->pool, error);
    for (int k = 0; k < CASES * SCHEMES && !status; k++)
        status = study_judge(&report->studies[k / SCHEMES][k % SCHEMES], &report->pool, error);
    if (!status) {
        *results = collect(report, settings->faults, clock_wall() - began);
        if (report->pool.note[0])
            json_object_set_new(*results, "note", json_string(report->pool.note));
    }
    for (int k = 0; k < CASES * SCHEMES; k++)
        study_free(&report->studies[k / SCHEMES][k % SCHEMES]);
    stress_free(&report->stress);
    pool_free(&report->pool);
    free(report);
    return status;
}
