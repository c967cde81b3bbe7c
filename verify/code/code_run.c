/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "code_run.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "buffer.h"
#include "code_call.h"
#include "code_check.h"
#include "code_process.h"
#include "code_snapshot.h"
#include "output.h"
#include "places.h"
#include "result.h"
#include "run_output.h"
#include "slab.h"
#include "value.h"

struct course {
    const struct run *run;
    const struct code_external *external;
    struct run_result start; /* of run_start */
    struct code_values values;
    char **words;
    char folder[CODE_PATH], ic[2 * CODE_PATH];
    struct code_matches before, now; /* files of the snapshots' name: before the run and after it */
    time_t began;                    /* time of the start by the file system's clock */
    const char *snapshot;            /* of now: the judged file */
    const char *first;         /* of now: first snapshot, possibly of the start; NULL: no other */
    struct snapshot_file read; /* the initial state as a reader of its file finds it */
    bool readable;             /* the initial state can be read */
    struct code_outcome outcome;
    struct judged judged;
    bool is_judged;
    struct trace trace;      /* from the initial state through all snapshots */
    enum code_reason reason; /* why there is no result */
    char message[400];
};

/* ---- before the run ---- */

static enum status make_folder(struct course *course, struct error *error)
{
    const char *work = course->external->work, *temporary = getenv("TMPDIR");
    if (work && output_folder(work, error)) return error->status;
    const int used = work ? snprintf(course->folder, sizeof course->folder, "%s/%s-n%zu-XXXXXX",
                                     work, course->run->asked.file.name, course->start.n)
                          : snprintf(course->folder, sizeof course->folder, "%s/sphproof-XXXXXX",
                                     temporary && *temporary ? temporary : "/tmp");
    if (used < (int)sizeof course->folder && mkdtemp(course->folder)) {
        snprintf(course->ic, sizeof course->ic, "%s/%s", course->folder,
                 course->values.of[CODE_WORD_IC]);
        return STATUS_OK;
    }
    course->folder[0] = '\0';
    return error_set(error, STATUS_ENVIRONMENT, "no folder for a run in %.200s: %s",
                     work ? work : "the folder of temporary files", strerror(errno));
}

/* Runs a command within the code file's limits of time and memory. */
static enum status call(struct course *course, char **words, struct error *error)
{
    const struct code_way *way = &course->external->of->way;
    const struct code_order order = {.words = (const char *const *)words,
                                     .folder = course->folder,
                                     .seconds = code_timeout(way),
                                     .bytes = code_memory(way),
                                     .remove = !course->external->work};
    struct code_outcome *outcome = &course->outcome;
    if (code_process(&order, outcome, error)) return error->status;
    if (outcome->ending == CODE_LATE) {
        course->reason = REASON_timeout;
        snprintf(course->message, sizeof course->message, "has not ended within %g s",
                 order.seconds);
    } else if (outcome->ending == CODE_LARGE) {
        course->reason = REASON_memory;
        snprintf(course->message, sizeof course->message, "takes more than %.4g MB of memory",
                 1e-6 * order.bytes);
    } else if (outcome->exit) {
        course->reason = REASON_exit_status;
        snprintf(course->message, sizeof course->message,
                 outcome->exit > 128 ? "ended by signal %d" : "exit status %d",
                 outcome->exit > 128 ? outcome->exit - 128 : outcome->exit);
    }
    return STATUS_OK;
}

/* Makes the initial state with the user's command. */
static enum status call_for_start(struct course *course, struct error *error)
{
    const char *command = course->external->of->way.value[CODE_ic];
    char **words = code_words_of(course->external, command, &course->values);
    if (!words) return error_set(error, STATUS_ENVIRONMENT, "no memory for a command");
    const enum status status = call(course, words, error);
    code_words_free(words);
    if (!status && !course->reason && access(course->ic, R_OK)) {
        course->reason = REASON_exit_status;
        snprintf(course->message, sizeof course->message, "the command of ic has made no %s",
                 course->values.of[CODE_WORD_IC]);
    }
    return status;
}

static enum status write_start(struct course *course, struct error *error)
{
    const struct start_format *format = code_format(&course->external->of->way);
    const struct snapshot_options options = {.here = false};
    struct error unread;
    if (format ? start_write(format, &course->start, course->ic, error)
               : call_for_start(course, error))
        return error->status;
    course->readable = !snapshot_read(course->ic, &options, &course->read, &unread);
    return STATUS_OK;
}

/* Changes a value by two units in the last place of the format's precision; 0 stays. */
static double vary(double value, bool up, bool single)
{
    const double to = up ? INFINITY : -INFINITY;
    if (value == 0) return value;
    if (single) return nextafterf(nextafterf((float)value, (float)to), (float)to);
    return nextafter(nextafter(value, to), to);
}

/* Varies positions, within the box, velocities and energies. */
static void vary_start(struct run_result *start, const struct start_format *format, uint64_t seed)
{
    const bool single = format && format->precision;
    const struct snapshot *s = &start->snapshot;
    const struct domain *box = &start->problem.domain;
    const double *const columns[] = {s->x[0], s->x[1], s->x[2], s->v[0], s->v[1], s->v[2], s->u};
    for (size_t k = 0; k < sizeof columns / sizeof *columns; k++) {
        if (!columns[k]) continue;
        double *column = start->storage + (columns[k] - start->storage);
        for (size_t i = 0; i < s->n; i++) {
            const bool up = places_random(seed, k * s->n + i) < 0.5;
            const double other = vary(column[i], up, single);
            if (k >= 3 || (other >= box->lo[k] && other < box->hi[k])) column[i] = other;
        }
    }
}

/* Checks that the program exists before anything is written. */
static void check_program(struct course *course)
{
    const struct code_external *external = course->external;
    enum code_key key;
    size_t length;
    const char *word = code_missing_program(external->code, &external->of->way, &key, &length);
    if (!word) return;
    course->reason = REASON_no_program;
    snprintf(course->message, sizeof course->message, "the program %.*s is not there", (int)length,
             word);
}

static enum status prepare(struct course *course, struct error *error)
{
    const struct code_external *external = course->external;
    const struct start_format *format = code_format(&external->of->way);
    if ((format && start_possible(format, course->run, error)) ||
        run_start(course->run, &course->start, error))
        return error->status;
    code_values(&course->values, external, course->run, &course->start);
    if (external->variation) vary_start(&course->start, format, external->variation);
    course->words = code_words_of(external, external->of->way.value[CODE_command], &course->values);
    if (!course->words) return error_set(error, STATUS_ENVIRONMENT, "no memory for a command");
    check_program(course);
    if (course->reason) return STATUS_OK;
    if (make_folder(course, error) || write_start(course, error)) return error->status;
    return code_write_templates(external, &course->values, course->folder, error);
}

/* ---- the snapshot ---- */

/* The pattern of the snapshot's name, in the run's folder unless it is absolute; malloced. */
static char *pattern_of(const struct course *course)
{
    char *name = code_fill(course->external->of->way.value[CODE_snapshot], course->values.of);
    struct buffer pattern = {.failed = !name};
    for (const char *c = course->folder; name && *name != '/' && *c; c++) {
        if (strchr("\\*?[", *c)) buffer_add(&pattern, "\\");
        buffer_add_bytes(&pattern, c, 1);
    }
    if (name && *name != '/') buffer_add(&pattern, "/");
    if (name) buffer_add(&pattern, name);
    free(name);
    return buffer_take(&pattern);
}

/* Sets the message for a missing snapshot: its name with @WORDS@ filled in, and the reason. */
static void tell_missing(struct course *course)
{
    char *name = code_fill(course->external->of->way.value[CODE_snapshot], course->values.of);
    snprintf(course->message, sizeof course->message,
             course->reason == REASON_old_snapshot
                 ? "%.200s: all files of this name are older than the run"
                 : "%.200s: the run has written no file of this name",
             name ? name : "");
    free(name);
}

static bool all_in(const struct snapshot_file *file, const double *lo, const double *hi, int dim)
{
    for (int d = 0; d < dim; d++)
        for (size_t i = 0; file->column[d] && i < file->n; i++)
            if (!(file->column[d][i] >= lo[d] && file->column[d][i] <= hi[d])) return false;
    return true;
}

/* Writes a box for a file that has none: the case's if all particles are in it, else from 0 on. */
static bool box_of(const struct course *course, const struct snapshot_file *file, char *text,
                   size_t size)
{
    const struct domain *box = &course->start.problem.domain;
    const bool ours = all_in(file, box->lo, box->hi, box->dim);
    size_t used = 0;
    if (file->boxed) return false;
    for (int d = 0; d < box->dim && used < size; d++)
        used += (size_t)snprintf(text + used, size - used, "%s%.17g:%.17g", d ? "," : "",
                                 ours ? box->lo[d] : 0, box->hi[d] - (ours ? 0 : box->lo[d]));
    return true;
}

/* Conserved sums of the initial state in the coordinates of the judged box; for a slab those per
 * unit of its thickness. */
static enum status sum_start(const struct course *course, struct conservation *sums,
                             struct error *error)
{
    const struct run_result *result = &course->judged.result;
    const struct domain *ours = &course->run->problem.domain, *theirs = &result->problem.domain;
    const double slab = course->judged.slab > 0 ? course->judged.slab : 1;
    struct snapshot start = course->start.snapshot;
    double shift[3] = {0}, *m = malloc(start.n * sizeof *m);
    if (!m) return error_set(error, STATUS_ENVIRONMENT, "no memory for an initial state");
    for (size_t i = 0; i < start.n; i++) m[i] = start.m[i] / slab;
    for (int d = 0; d < ours->dim; d++) shift[d] = theirs->lo[d] - ours->lo[d];
    start.m = m;
    judge_sum(&result->problem, &start, shift, sums);
    free(m);
    return STATUS_OK;
}

/* Adds sums of the start, regularity (with the kernel found, else the case's) and cost. */
static enum status complete(struct course *course, struct error *error)
{
    const struct run *run = course->run;
    struct run_result *result = &course->judged.result;
    const struct conventions *found = &course->judged.conventions;
    const double unknown = (double)NAN;
    struct conservation start = {0};
    if (!code_format(&course->external->of->way))
        start = course->judged.start;
    else if (sum_start(course, &start, error))
        return error->status;
    if (start.mass > 0) trace_add(&course->trace, 0, &start);
    result->settings = run->settings;
    if (run->asked.layers) result->n /= (size_t)run->asked.layers;
    result->regularity =
        run->asked.layers
            ? (struct regularity){unknown, unknown, unknown, unknown, unknown}
            : regularity_of(&result->problem,
                            found->known ? &found->candidate[0].kernel : &run->scheme.kernel,
                            &result->snapshot, 1);
    result->cost.wall_s = course->outcome.wall_s;
    result->cost.cpu_s = course->outcome.cpu_s;
    return STATUS_OK;
}

/* Checks that a snapshot of the start equals the initial state; else sets course->reason. */
static void check_start(struct course *course, const struct code_origin *origin)
{
    const struct snapshot_options options = {.here = false};
    struct snapshot_file file;
    struct error ignored;
    char what[200];
    if (!course->first || snapshot_read(course->first, &options, &file, &ignored)) return;
    if (!code_is_start(&file, origin, what, sizeof what)) {
        course->reason = REASON_ignored_ic;
        snprintf(course->message, sizeof course->message,
                 "%.100s: %.200s of the initial state: the code starts from particles of its own",
                 strrchr(course->first, '/') + 1, what);
    }
    snapshot_file_free(&file);
}

static struct judge_request request_of(const struct course *course)
{
    return (struct judge_request){.case_name = course->run->asked.file.asked,
                                  .asked = &course->run->asked,
                                  .gamma = {true, course->run->problem.gamma},
                                  .kernel = -1};
}

/* Judges the snapshot, or sets course->reason if it contains no result. */
static enum status judge(struct course *course, struct error *error)
{
    const struct code_origin origin = {
        .ic = course->readable ? &course->read : NULL,
        .problem = &course->run->problem,
        .t_end = settings_real(&course->run->settings, SETTING_t_end),
        .cells = code_is(&course->external->of->way, CODE_elements, "cells")};
    struct judge_request request = request_of(course);
    const char *path = course->snapshot;
    struct snapshot_file file;
    struct error said = {0};
    char box[160];
    enum status status = snapshot_read(path, &request.options, &file, &said);
    if (!status && !course->run->problem.problem->liquid)
        status = snapshot_check_gas(path, &file, &said);
    if (status == STATUS_BAD_INPUT)
        course->reason = file.impossible ? REASON_not_a_number : REASON_truncated;
    if (!status)
        course->reason = code_compare(&file, &origin, course->message, sizeof course->message);
    if (!status && !course->reason) check_start(course, &origin);
    if (!status && !file.time.known) request.time = (struct snapshot_value){true, origin.t_end};
    if (!status && box_of(course, &file, box, sizeof box)) request.box = box;
    snapshot_file_free(&file);
    if (!status && !course->reason) {
        course->is_judged = true;
        status = judge_as(path, &request, false, &course->judged, &said);
        if (status == STATUS_BAD_INPUT) course->reason = REASON_wrong_particles;
    }
    if (!status && !course->reason) status = complete(course, &said);
    if (status == STATUS_BAD_INPUT)
        snprintf(course->message, sizeof course->message, "%.390s",
                 said.message + (strncmp(said.message, course->folder, strlen(course->folder))
                                     ? 0
                                     : strlen(course->folder) + 1));
    else
        *error = said;
    return status == STATUS_BAD_INPUT ? STATUS_OK : status;
}

/* Adds the sums of an intermediate snapshot, if it can be read; called in order of the names. */
static void add_moment(struct course *course, const char *path)
{
    const double last = course->trace.time[course->trace.count - 1];
    struct judge_request request = request_of(course);
    struct snapshot_file file;
    struct judged judged;
    struct error ignored = {0};
    char box[160];
    bool boxed = false;
    request.allow_far = true;
    if (snapshot_read(path, &request.options, &file, &ignored)) return;
    const bool between =
        file.time.known && file.time.value > last && file.time.value < course->judged.result.time;
    if (between) boxed = box_of(course, &file, box, sizeof box);
    snapshot_file_free(&file);
    if (boxed) request.box = box;
    if (!between || judge_as(path, &request, true, &judged, &ignored)) return;
    if (judged.result.snapshot.n == course->judged.result.snapshot.n)
        trace_add(&course->trace, judged.result.time, &judged.sums);
    judge_free(&judged);
}

/* Traces conservation and motion through all snapshots of the run. */
static void follow(struct course *course)
{
    struct run_result *result = &course->judged.result;
    const struct code_matches *now = &course->now;
    for (size_t i = 0; course->trace.count && i < now->n; i++)
        if (now->path[i] != course->snapshot && code_is_new(now, i, &course->before, course->began))
            add_moment(course, now->path[i]);
    if (course->trace.count) trace_add(&course->trace, result->time, &course->judged.sums);
    result->drift = trace_worst(&course->trace);
    result->motion = trace_motion(&course->trace);
}

static enum status execute(struct course *course, struct error *error)
{
    struct code_matches *before = &course->before, *now = &course->now;
    struct stat start = {0};
    char *pattern = pattern_of(course);
    enum status status = STATUS_OK;
    if (stat(course->ic, &start))
        status = error_set(error, STATUS_ENVIRONMENT, "%.300s: %s", course->ic, strerror(errno));
    else if (!pattern || !code_match(pattern, before))
        status = error_set(error, STATUS_ENVIRONMENT, "no memory for names of snapshots");
    course->began = start.st_mtime;
    if (!status) status = call(course, course->words, error);
    if (!status && !course->reason && !code_match(pattern, now))
        status = error_set(error, STATUS_ENVIRONMENT, "no memory for names of snapshots");
    if (!status && !course->reason) {
        course->snapshot = code_last(now, before, course->began, &course->reason);
        if (course->snapshot) {
            course->first = code_first(now, before, course->began, course->snapshot);
            status = judge(course, error);
        } else {
            tell_missing(course);
        }
    }
    if (!status && course->is_judged && !course->reason) follow(course);
    free(pattern);
    return status;
}

/* ---- document ---- */

/* Adds the last lines of an output stream. */
static void add_lines(const char *folder, const char *stream, struct buffer *log)
{
    enum { LAST = 1500, LINES = 8 };
    char path[2 * CODE_PATH], bytes[LAST + 1];
    snprintf(path, sizeof path, "%s/%s", folder, stream);
    FILE *file = fopen(path, "rb");
    if (!file) return;
    if (fseek(file, -LAST, SEEK_END)) rewind(file);
    size_t n = fread(bytes, 1, LAST, file);
    fclose(file);
    while (n && (bytes[n - 1] == '\n' || bytes[n - 1] == ' ')) n--;
    size_t from = n;
    for (int lines = 0; from; from--)
        if (bytes[from - 1] == '\n' && ++lines == LINES) break;
    for (size_t i = from; i < n; i++)
        if (!bytes[i]) bytes[i] = '?';
    bytes[n] = '\0';
    for (char *rest = bytes + from, *line; (line = strtok_r(rest, "\n", &rest));) {
        status_clean(line);
        buffer_format(log, "%s%s", log->size ? "\n" : "", line);
    }
}

/* The last lines of standard error, or of the output if that is empty; malloced. */
static char *log_of(const struct course *course)
{
    struct buffer log = {0};
    if (course->folder[0]) add_lines(course->folder, "stderr", &log);
    if (course->folder[0] && !log.size) add_lines(course->folder, "stdout", &log);
    buffer_add(&log, "");
    return buffer_take(&log);
}

static json_t *code_json(const struct code_external *external, const char *command)
{
    char sum[SHA256_TEXT];
    code_program_sum(external, sum);
    return result_object("title=%s command=%s sha256=%s ic=%s", external->base.title, command, sum,
                         code_value(&external->of->way, CODE_ic));
}

static void add_code(const struct course *course, const char *log, json_t *document)
{
    char *command = code_words_line(course->words);
    json_t *code = code_json(course->external, command ? command : "");
    const struct code_outcome *outcome = &course->outcome;
    result_add(code, "log=%s exit_status=%d wall_s=%g cpu_s=%g", log, outcome->exit,
               outcome->wall_s, outcome->cpu_s);
    if (course->external->work && course->folder[0]) result_add(code, "folder=%s", course->folder);
    json_object_set_new(document, "code", code);
    free(command);
}

/* Removes the keys of our solver's scheme from "settings". */
static void forget_scheme(json_t *document)
{
    json_t *settings = json_object_get(document, "settings");
    for (int key = 0; settings && key < SETTINGS; key++)
        if (strcmp(setting_keys[key].section, "scheme") == 0)
            json_object_del(settings, setting_keys[key].name);
}

static void describe(const struct run_external *base, json_t *document)
{
    const struct code_external *external = (const struct code_external *)base;
    forget_scheme(document);
    json_object_set_new(document, "code",
                        code_json(external, external->of->way.value[CODE_command]));
}

/* Removes or sets to null the members that only a run of our solver has. */
static void forget(json_t *document)
{
    static const char *const counts[] = {
        "steps",         "particle_updates",  "pair_interactions",    "skipped_particle_updates",
        "without_slope", "without_viscosity", "without_conductivity", "peak_rss_bytes"};
    json_t *cost = json_object_get(document, "cost");
    json_object_set_new(document, "plan", json_array());
    json_object_del(document, "estimate");
    for (size_t k = 0; cost && k < sizeof counts / sizeof *counts; k++)
        json_object_set_new(cost, counts[k], json_null());
    forget_scheme(document);
}

static void add_judged(const struct judged *judged, json_t *document)
{
    static const char *const names[] = {"layout", "code", "assumptions", "kernel", "precision"};
    json_t *one = judge_one_json(judged, false), *found = json_object();
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        json_object_set(found, names[k], json_object_get(one, names[k]));
    json_object_set_new(document, "judged", found);
    json_decref(one);
}

static void tell_sound(const struct course *course, json_t *document)
{
    char *log = log_of(course);
    run_add_json(&course->run->asked, &course->judged.result, document);
    forget(document);
    add_judged(&course->judged, document);
    if (course->trace.count)
        json_object_set_new(document, "through_time",
                            trace_json(&course->trace, course->judged.file.dim));
    add_code(course, log ? log : "", document);
    free(log);
}

static enum status tell_failed(const struct course *course, json_t *document, struct error *error)
{
    char *log = log_of(course);
    const char *last = log && strrchr(log, '\n') ? strrchr(log, '\n') + 1 : log ? log : "";
    error_set(error, STATUS_BROKE_DOWN, "%.80s: %s: %.180s%s%.160s%s", course->external->base.title,
              code_reason_names[course->reason], course->message,
              *last ? "; its log ends with: " : "", last,
              course->external->work || !course->folder[0] ? "" : " (--work DIR keeps its files)");
    struct run_result start = course->start;
    if (course->run->asked.layers) start.n /= (size_t)course->run->asked.layers;
    run_add_plan(&course->run->asked, &start, document);
    forget(document);
    result_add(document, "status=%s reason=%s message=%s", "failed",
               code_reason_names[course->reason], error->message);
    add_code(course, log ? log : "", document);
    free(log);
    return STATUS_BROKE_DOWN;
}

static void course_free(struct course *course)
{
    if (course->folder[0] && !course->external->work) code_remove(course->folder);
    if (course->is_judged) judge_free(&course->judged);
    snapshot_file_free(&course->read);
    code_words_free(course->words);
    code_matches_free(&course->before);
    code_matches_free(&course->now);
    run_free(&course->start);
}

enum status code_run(const struct run *run, struct judged *judged, json_t **document,
                     struct error *error)
{
    struct course *course = calloc(1, sizeof *course);
    *document = NULL;
    if (!course) return error_set(error, STATUS_ENVIRONMENT, "no memory for a run of another code");
    course->run = run;
    course->external = (const struct code_external *)run->asked.external;
    enum status status = code_check_keys(course->external, run, error);
    if (!status) status = prepare(course, error);
    if (!status && !course->reason) status = execute(course, error);
    if (!status) {
        *document = result_new("run");
        if (course->reason)
            status = tell_failed(course, *document, error);
        else
            tell_sound(course, *document);
    }
    if (!status) {
        *judged = course->judged;
        judged->path = run->asked.external->title; /* the file will be removed */
        course->is_judged = false;
    }
    course_free(course);
    free(course);
    return status;
}

/* ---- interface for pool and study ---- */

/* Adds `by` to every number of a list. */
static void move(json_t *list, double by)
{
    for (size_t i = 0; i < json_array_size(list); i++)
        json_array_set_new(list, i, result_number(value_real(json_array_get(list, i)) + by));
}

/* Moves a profile into the coordinates of the case. */
static json_t *placed(json_t *profile, const struct domain *ours, const struct domain *theirs)
{
    json_t *map = json_object_get(profile, "map"), *over = json_object_get(profile, "over");
    const double along_x = ours->lo[0] - theirs->lo[0];
    if (!over || strcmp(json_string_value(over), "x") == 0) { /* else a radius */
        move(json_object_get(profile, "x"), along_x);
        move(json_object_get(json_object_get(profile, "exact"), "x"), along_x);
    }
    move(json_object_get(map, "x"), along_x);
    move(json_object_get(map, "y"), ours->lo[1] - theirs->lo[1]);
    return profile;
}

static enum status compute(const struct run_external *external, const struct run *run, bool profile,
                           json_t **document, struct error *error)
{
    struct judged judged;
    (void)external;
    const enum status status = code_run(run, &judged, document, error);
    if (status) return status;
    const struct run_result *result = &judged.result;
    if (profile)
        json_object_set_new(
            *document, "profile",
            placed(profile_json(result), &run->problem.domain, &result->problem.domain));
    judge_free(&judged);
    return STATUS_OK;
}

enum status code_plan(const struct code *code, const char *case_name, const char *work, int n,
                      char *const *arguments, struct code_external *external,
                      struct run_settings *settings, struct error *error)
{
    const struct code_case *of = code_case_of(code, case_name, error);
    if (!of) return error->status;
    *external = (struct code_external){
        .base = {code->way.value[CODE_title], code_add_key, compute, describe},
        .code = code,
        .of = of,
        .work = work};
    *settings = (struct run_settings){
        .file = of->file, .settings = of->file.settings, .threads = 1, .external = &external->base};
    settings->settings.shared = true; /* the code alone may read a key, as by @SEED@ */
    if (settings_apply(&settings->settings, n, arguments, error) ||
        (code_is(&of->way, CODE_equal_masses, "yes") && run_ask_equal_masses(settings, error)))
        return error->status;
    const char *layers = code_value(&of->way, CODE_as_3d);
    return of->file.dimension == 2 && strcmp(layers, "no") != 0
               ? slab_ask(settings, layers, "as_3d", error)
               : STATUS_OK;
}

enum status code_prepare(const struct code *code, const char *case_name, const char *work, int n,
                         char *const *arguments, struct code_external *external,
                         struct run_settings *settings, struct error *error)
{
    if (code_plan(code, case_name, work, n, arguments, external, settings, error))
        return error->status;
    return code_check_program(code, &external->of->way, error);
}
