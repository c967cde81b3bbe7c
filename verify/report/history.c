/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "history.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/uio.h>
#include <unistd.h>

#include "diff.h"
#include "metric.h"
#include "result.h"
#include "value.h"

/* Noise of figures: relative for an error, absolute for an order. */
static const double error_noise = 0.01, order_noise = 0.03;
enum { PATH_LENGTH = 1024 };

/* ---- this night's line ---- */

/* Thousands of figures of checks are too many for the history: keeps the one closest to its bound
 * of each check, or one that is not a number. */
static void add_checks(const json_t *checks, json_t *figures)
{
    const json_t *check;
    size_t i;
    json_array_foreach(checks, i, check) {
        const double value = value_member(check, "value"), bound = value_member(check, "bound"),
                     ratio = value / bound;
        char path[PATH_LENGTH];
        if (!(bound > 0) || strcmp(value_text(check, "status"), "skip") == 0) continue;
        snprintf(path, sizeof path, "verify[%s, %s].value_over_bound", value_text(check, "group"),
                 value_text(check, "name"));
        const json_t *kept = json_object_get(figures, path);
        if (!kept || (!isnan(value_real(kept)) && !(ratio <= value_real(kept))))
            json_object_set_new(figures, path, result_number(ratio));
    }
}

static json_t *value_of(const struct metric *metric)
{
    return metric->word ? json_string(metric->word) : result_number(metric->value);
}

/* {path: value} of the headline metrics. */
static json_t *figures_of(const struct metrics *metrics, const json_t *results)
{
    json_t *figures = json_object();
    for (size_t i = 0; i < metrics->count; i++)
        if (metrics->list[i].headline)
            json_object_set_new(figures, metrics->list[i].path, value_of(&metrics->list[i]));
    add_checks(json_object_get(json_object_get(results, "verify"), "checks"), figures);
    return figures;
}

static json_t *line_of(const json_t *results, struct error *error)
{
    struct metrics metrics;
    const json_t *verdict = json_object_get(results, "verdict");
    if (metric_collect(results, &metrics, error)) return NULL;
    json_t *line = result_object(
        "schema=%s date=%s git=%s mode=%s processor=%s verdict=%s failures=%zu figures=%p",
        "sphproof-history/1", value_text(results, "date"), value_text(results, "git"),
        value_text(results, "mode"), value_text(json_object_get(results, "machine"), "processor"),
        value_text(verdict, "status"), json_array_size(json_object_get(verdict, "failures")),
        (void *)figures_of(&metrics, results));
    metric_free(&metrics);
    if (!line) error_set(error, STATUS_ENVIRONMENT, "no memory for the history");
    return line;
}

static enum status cannot_write(const char *path, int code, struct error *error)
{
    return error_set(error, STATUS_ENVIRONMENT, "cannot write the history '%.200s': %s", path,
                     strerror(code));
}

/* Appends with one write, on a new line even if an earlier write was cut off. */
static enum status append(char *body, const char *path, struct error *error)
{
    const int file = open(path, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (file < 0) return cannot_write(path, errno, error);
    char last = '\n';
    const bool cut_off =
        lseek(file, -1, SEEK_END) >= 0 && read(file, &last, 1) == 1 && last != '\n';
    const struct iovec parts[] = {{"\n", cut_off}, {body, strlen(body)}, {"\n", 1}};
    const size_t total = cut_off + parts[1].iov_len + 1;
    errno = ENOSPC; /* of a line that was written in part */
    const bool whole = writev(file, parts, 3) == (ssize_t)total;
    const int code = errno;
    close(file);
    return whole ? STATUS_OK : cannot_write(path, code, error);
}

enum status history_append(const json_t *results, const char *path, struct error *error)
{
    json_t *line = line_of(results, error);
    char *body = line ? json_dumps(line, JSON_COMPACT | JSON_REAL_PRECISION(15)) : NULL;
    json_decref(line);
    if (!body) return error_set(error, STATUS_ENVIRONMENT, "no memory for the history");
    const enum status status = append(body, path, error);
    free(body);
    return status;
}

/* ---- earlier nights ---- */

/* Reads the newest lines of this mode, oldest first; counts lines that are not valid. */
static enum status read_nights(const char *path, const char *mode, json_t *nights,
                               size_t *unreadable, struct error *error)
{
    char *text = NULL;
    size_t room = 0;
    *unreadable = 0;
    FILE *file = fopen(path, "r");
    if (!file && errno == ENOENT) return STATUS_OK;
    if (!file)
        return error_set(error, STATUS_ENVIRONMENT, "cannot read the history '%.200s': %s", path,
                         strerror(errno));
    for (ssize_t length; (length = getline(&text, &room, file)) != -1;) {
        json_t *line = json_loadb(text, (size_t)length, 0, NULL);
        if (!line || strcmp(value_text(line, "schema"), "sphproof-history/1") != 0)
            *unreadable += text[0] != '\n';
        else if (strcmp(value_text(line, "mode"), mode) == 0)
            json_array_append(nights, line);
        json_decref(line);
        if (json_array_size(nights) >= HISTORY_NIGHTS_MAX) json_array_remove(nights, 0);
    }
    free(text);
    fclose(file);
    return STATUS_OK;
}

/* ---- order ---- */

/* Relative change of a figure, up or down; infinite for a word or a value that was not finite. */
static double distance(const json_t *entry)
{
    const double change = fabs(log(value_member(entry, "ratio")));
    return isnan(change) ? (double)INFINITY : change;
}

static bool is(const json_t *entry, const char *key)
{
    return json_is_true(json_object_get(entry, key));
}

static int larger_first(double a, double b)
{
    return (a < b) - (a > b);
}

/* Failures first, then by change; counts of work after figures of quality. */
static int worst_first(const void *a, const void *b)
{
    const json_t *x = *(json_t *const *)a, *y = *(json_t *const *)b;
    int order = larger_first(is(x, "fault"), is(y, "fault"));
    if (!order) order = larger_first(is(y, "work"), is(x, "work"));
    if (!order) order = larger_first(distance(x), distance(y));
    return order ? order : strcmp(value_text(x, "path"), value_text(y, "path"));
}

/* Replaces the list by a sorted one, or leaves it as it is if there is no memory. */
static json_t *sorted(json_t *list, int compare(const void *, const void *))
{
    const size_t n = json_array_size(list);
    json_t **items = malloc(n * sizeof(json_t *));
    if (!items) return list;
    json_t *result = json_array();
    for (size_t i = 0; i < n; i++) items[i] = json_array_get(list, i);
    qsort(items, n, sizeof(json_t *), compare);
    for (size_t i = 0; i < n; i++) json_array_append(result, items[i]);
    free(items);
    json_decref(list);
    return result;
}

static json_t *since_last(const json_t *nights, const struct metrics *now)
{
    const size_t count = json_array_size(nights);
    if (count < 2) return json_null();
    const json_t *last = json_array_get(nights, count - 2),
                 *figures = json_object_get(last, "figures");
    json_t *moved = json_array();
    size_t verdicts[METRIC_VERDICTS] = {0};
    for (size_t i = 0; i < now->count; i++) {
        const struct metric *new = &now->list[i];
        if (!new->headline || new->kind == METRIC_TIMING) continue;
        const json_t *value = json_object_get(figures, new->path);
        struct metric old = *new;
        double amount;
        bool fault;
        old.value = value_real(value);
        old.word = new->word ? (char *)json_string_value(value) : NULL;
        const enum metric_verdict verdict = metric_judge(value ? &old : NULL, new, &amount, &fault);
        verdicts[verdict]++;
        if (verdict == VERDICT_SAME) continue;
        const double ratio = new->value / old.value; /* NaN of words */
        fault = fault && (new->kind == METRIC_ORDER || amount > DIFF_THRESHOLD);
        json_array_append_new(
            moved,
            result_object("path=%s old=%p new=%p ratio=%p verdict=%s fault=%d? work=%d?", new->path,
                          (void *)(value ? value_of(&old) : json_null()), (void *)value_of(new),
                          (void *)(isfinite(ratio) ? result_number(ratio) : json_null()),
                          metric_verdicts[verdict], fault, new->kind == METRIC_COUNT));
    }
    json_t *since = result_object("date=%s git=%s figures=%p", value_text(last, "date"),
                                  value_text(last, "git"), (void *)sorted(moved, worst_first));
    for (int v = 0; v < METRIC_VERDICTS; v++)
        json_object_set_new(since, metric_verdicts[v], json_integer((json_int_t)verdicts[v]));
    return since;
}

/* ---- trends ---- */

static json_t *series_of(const json_t *nights, const char *path)
{
    json_t *series = json_array();
    for (size_t i = 0; i < json_array_size(nights); i++) {
        const json_t *figures = json_object_get(json_array_get(nights, i), "figures");
        json_array_append_new(series, result_number(value_member(figures, path)));
    }
    return series;
}

/* True if a curve has at least one finite point. */
static bool has_points(const json_t *series)
{
    size_t i;
    const json_t *value;
    json_array_foreach(series, i, value)
        if (isfinite(value_real(value))) return true;
    return false;
}

/* The trend of the first field that judges the study and of which the nights have error and
 * order. */
static json_t *trend_of(const json_t *nights, const json_t *study)
{
    const char *name = value_text(study, "case"), *label = value_text(study, "label");
    const json_t *levels = json_object_get(study, "levels"), *field,
                 *finest = json_array_get(levels, json_array_size(levels) - 1);
    const double n = value_member(finest, "n");
    size_t i;
    json_array_foreach(json_object_get(study, "measured"), i, field) {
        const char *what = json_string_value(field);
        char path[PATH_LENGTH];
        snprintf(path, sizeof path, "studies[%s, %s].levels[n %.10g].errors.%s.l1", name, label, n,
                 what);
        json_t *error = series_of(nights, path);
        snprintf(path, sizeof path, "studies[%s, %s].orders[%s, l1].order", name, label, what);
        json_t *order = series_of(nights, path);
        if (has_points(error) && has_points(order))
            return result_object("case=%s label=%s field=%s n=%g error=%p order=%p", name, label,
                                 what, n, (void *)error, (void *)order);
        json_decref(error);
        json_decref(order);
    }
    return NULL;
}

static json_t *trends(const json_t *nights, const json_t *results)
{
    json_t *list = json_array();
    const json_t *study;
    size_t i;
    json_array_foreach(json_object_get(results, "studies"), i, study) {
        json_t *trend = trend_of(nights, study);
        if (trend) json_array_append_new(list, trend);
    }
    return list;
}

static json_t *change_json(const struct metric *metric, const json_t *nights, const size_t *night,
                           const struct trend_change *change)
{
    const bool order = metric->kind == METRIC_ORDER;
    const double before = order ? change->before : exp(change->before),
                 after = order ? change->after : exp(change->after);
    const json_t *at = json_array_get(nights, night[change->at]),
                 *last = json_array_get(nights, night[change->at - 1]);
    return result_object(
        "path=%s night=%zu date=%s git=%s git_before=%s before=%g after=%g ratio=%g verdict=%s",
        metric->path, night[change->at], value_text(at, "date"), value_text(at, "git"),
        value_text(last, "git"), before, after, after / before,
        (after > before) == order ? "better" : "worse");
}

/* Adds the change points of one figure; nights without it are left out. */
static void add_changes(const struct metric *metric, const json_t *nights, json_t *changes)
{
    double value[HISTORY_NIGHTS_MAX];
    size_t night[HISTORY_NIGHTS_MAX], n = 0;
    struct trend_change found[HISTORY_NIGHTS_MAX]; /* at most one per night */
    const bool order = metric->kind == METRIC_ORDER;
    for (size_t i = 0; i < json_array_size(nights); i++) {
        const json_t *figures = json_object_get(json_array_get(nights, i), "figures");
        const double now = value_member(figures, metric->path);
        if (!isfinite(now)) continue;
        value[n] = order ? now : log(fmax(now, metric->floor));
        night[n++] = i;
    }
    const double noise = fmax(order ? order_noise : error_noise, metric->noise);
    const size_t count = trend_changes(n, value, noise, found);
    for (size_t c = 0; c < count; c++)
        json_array_append_new(changes, change_json(metric, nights, night, &found[c]));
}

static int newest_first(const void *a, const void *b)
{
    const json_t *x = *(json_t *const *)a, *y = *(json_t *const *)b;
    int order = larger_first(value_member(x, "night"), value_member(y, "night"));
    if (!order) order = larger_first(distance(x), distance(y));
    return order ? order : strcmp(value_text(x, "path"), value_text(y, "path"));
}

static json_t *heads(const json_t *nights)
{
    json_t *list = json_array();
    for (size_t i = 0; i < json_array_size(nights); i++) {
        const json_t *night = json_array_get(nights, i);
        json_array_append_new(list, result_object("date=%s git=%s", value_text(night, "date"),
                                                  value_text(night, "git")));
    }
    return list;
}

enum status history_tell(const json_t *results, const char *path, json_t **history,
                         struct error *error)
{
    struct metrics metrics;
    size_t unreadable;
    json_t *nights = json_array(), *changes = json_array();
    *history = NULL;
    enum status status = read_nights(path, value_text(results, "mode"), nights, &unreadable, error);
    json_t *line = status ? NULL : line_of(results, error);
    if (!status && (!line || metric_collect(results, &metrics, error))) status = error->status;
    if (!status) {
        json_array_append(nights, line);
        for (size_t i = 0; i < metrics.count; i++) {
            const struct metric *metric = &metrics.list[i];
            if (metric->headline && (metric->kind == METRIC_ERROR || metric->kind == METRIC_ORDER))
                add_changes(metric, nights, changes);
        }
        *history =
            result_object("nights=%p unreadable=%zu since=%p trends=%p changes=%p",
                          (void *)heads(nights), unreadable, (void *)since_last(nights, &metrics),
                          (void *)trends(nights, results), (void *)sorted(changes, newest_first));
        changes = NULL;
        metric_free(&metrics);
        if (!*history) status = error_set(error, STATUS_ENVIRONMENT, "no memory for the history");
    }
    json_decref(changes);
    json_decref(line);
    json_decref(nights);
    return status;
}
