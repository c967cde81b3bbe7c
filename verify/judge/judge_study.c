/* SPDX-License-Identifier: GPL-3.0-or-later
 * Results from several snapshots: orders, conservation. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "judge.h"
#include "order.h"
#include "problem_list.h"
#include "problem_prepare.h"
#include "result.h"

/* Largest relative difference of times and gammas that count as equal. */
static const double same_number = 1e-3;

/* True if a has more particles than b, or as many and a later time. */
static bool better(const struct judged *a, const struct judged *b)
{
    return a->result.n > b->result.n ||
           (a->result.n == b->result.n && a->result.time > b->result.time);
}

const struct judged *judge_main(const struct judged *judged, size_t n)
{
    const struct judged *best = judged;
    for (size_t i = 1; i < n; i++)
        if (better(&judged[i], best)) best = &judged[i];
    return best;
}

static bool same(double a, double b)
{
    return fabs(a - b) <= same_number * fmax(fabs(a), fabs(b));
}

bool judge_key_of_problem(enum setting key)
{
    return key == SETTING_gravity || strcmp(setting_keys[key].section, "initial") == 0;
}

/* True if both have the same case, dimension, gamma, gravity and initial states. Otherwise `why`
 * names the difference. */
static bool same_problem(const struct judged *a, const struct judged *b, char why[JUDGE_WHY])
{
    const struct run_settings *one = &a->run.asked, *other = &b->run.asked;
    char mine[SETTING_TEXT_MAX], theirs[SETTING_TEXT_MAX];
    const char *what = NULL;
    snprintf(mine, sizeof mine, "%s", one->file.name);
    snprintf(theirs, sizeof theirs, "%s", other->file.name);
    if (strcmp(mine, theirs)) what = "the case";
    if (!what && a->file.dim != b->file.dim) {
        what = "the number of dimensions";
        snprintf(mine, sizeof mine, "%d", a->file.dim);
        snprintf(theirs, sizeof theirs, "%d", b->file.dim);
    }
    if (!what && !same(a->result.problem.gamma, b->result.problem.gamma)) {
        what = "gamma";
        snprintf(mine, sizeof mine, "%.6g", a->result.problem.gamma);
        snprintf(theirs, sizeof theirs, "%.6g", b->result.problem.gamma);
    }
    for (int key = 0; key < SETTINGS && !what; key++) {
        if (!judge_key_of_problem((enum setting)key) ||
            problem_lays_particles(problem_of(&one->settings), (enum setting)key))
            continue;
        settings_text(&one->settings, (enum setting)key, mine);
        settings_text(&other->settings, (enum setting)key, theirs);
        if (strcmp(mine, theirs)) what = setting_keys[key].name;
    }
    if (!what) return true;
    snprintf(why, JUDGE_WHY, "%s is %.60s in %.100s and %.60s in %.100s", what, mine, a->path,
             theirs, b->path);
    return false;
}

/* Finds the first and the last snapshot with one number of particles, the largest that has two
 * times. */
bool judge_drift(const struct judged *judged, size_t n, struct trace_drift *drift, size_t pair[2])
{
    const struct judged *start = NULL, *end = NULL;
    char why[JUDGE_WHY];
    for (size_t a = 0; a < n; a++)
        for (size_t b = 0; b < n; b++) {
            const struct judged *first = &judged[a], *last = &judged[b];
            if (first->result.n != last->result.n || !(first->result.time < last->result.time) ||
                !same_problem(first, last, why))
                continue;
            if (end && (better(end, last) ||
                        (end->result.n == last->result.n && end->result.time == last->result.time &&
                         start->result.time <= first->result.time)))
                continue;
            start = first, end = last;
        }
    if (!end) return false;
    *drift = trace_drift(&start->sums, &end->sums, &end->sums);
    pair[0] = (size_t)(start - judged), pair[1] = (size_t)(end - judged);
    return true;
}

/* Takes the snapshots from the first to the last of the pair with the same number of particles,
 * each time once. */
static void take_trace(const struct judged *judged, size_t n, const size_t pair[2],
                       struct trace *trace)
{
    const struct judged *next = &judged[pair[0]], *last = &judged[pair[1]];
    char why[JUDGE_WHY];
    while (next) {
        const struct judged *now = next;
        trace_add(trace, now->result.time, &now->sums);
        next = NULL;
        for (size_t i = 0; i < n; i++)
            if (judged[i].result.n == last->result.n && judged[i].result.time > now->result.time &&
                judged[i].result.time <= last->result.time && same_problem(&judged[i], last, why) &&
                (!next || judged[i].result.time < next->result.time))
                next = &judged[i];
    }
}

json_t *judge_conservation(const struct judged *judged, size_t n, struct trace *trace)
{
    const struct judged *main = judge_main(judged, n);
    const char *from = "the case's initial state", *to = main->path;
    struct trace_drift drift;
    size_t pair[2];
    *trace = (struct trace){.count = 0};
    if (judge_drift(judged, n, &drift, pair)) {
        main = &judged[pair[1]];
        from = judged[pair[0]].path, to = main->path;
        take_trace(judged, n, pair, trace);
        drift = trace_worst(trace);
    } else if (main->start.mass > 0) { /* at t = 0 the second entry replaces the first */
        trace_add(trace, 0, &main->start);
        trace_add(trace, main->result.time, &main->sums);
        drift = trace_drift(&main->start, &main->sums, &main->sums);
    } else {
        return json_null();
    }
    const struct trace_motion motion = trace_motion(trace);
    json_t *conservation = run_drift_json(main->file.dim, &drift);
    json_object_set_new(conservation, "between", json_pack("[s, s]", from, to));
    run_add_motion(&main->result, &motion, conservation);
    return conservation;
}

/* ---- orders ---- */

/* The last snapshot of each number of particles, fewest first; of two of one time the first. */
static size_t levels_of(const struct judged *judged, size_t n, const struct judged **levels)
{
    size_t count = 0;
    for (size_t i = 0; i < n; i++) {
        size_t k = 0;
        while (k < count && levels[k]->result.n < judged[i].result.n) k++;
        if (k == count || levels[k]->result.n > judged[i].result.n) {
            memmove(&levels[k + 1], &levels[k], (count++ - k) * sizeof *levels);
            levels[k] = &judged[i];
        } else if (better(&judged[i], levels[k])) {
            levels[k] = &judged[i];
        }
    }
    return count;
}

bool judge_one_ladder(const struct judged *judged, size_t n, char why[JUDGE_WHY])
{
    const struct judged *levels[JUDGE_SNAPSHOTS_MAX];
    const size_t count = levels_of(judged, n, levels);
    for (size_t i = 1; i < count && !levels[0]->result.problem.problem->fieldless; i++) {
        if (!same_problem(levels[0], levels[i], why)) return false;
        if (same(levels[0]->result.time, levels[i]->result.time)) continue;
        snprintf(why, JUDGE_WHY, "the time is %.6g in %.100s and %.6g in %.100s",
                 levels[0]->result.time, levels[0]->path, levels[i]->result.time, levels[i]->path);
        return false;
    }
    return true;
}

static json_t *order_json(const char *field, size_t n, const double *spacing, const double *value)
{
    struct order_fit fit = {.order = (double)NAN, .low = (double)NAN, .high = (double)NAN};
    struct error ignored = {0};
    json_t *pairwise = json_array();
    const bool fitted = !order_fit(n, spacing, value, NULL, &fit, &ignored);
    for (size_t i = 0; i + 1 < n; i++)
        json_array_append_new(pairwise, result_number(log(value[i] / value[i + 1]) /
                                                      log(spacing[i] / spacing[i + 1])));
    return result_object("field=%s norm=%s order=%p low=%p high=%p pairwise=%p class=%s", field,
                         "l1", (void *)(fitted ? result_number(fit.order) : json_null()),
                         (void *)(fitted ? result_number(fit.low) : json_null()),
                         (void *)(fitted ? result_number(fit.high) : json_null()), (void *)pairwise,
                         fitted ? order_class_name(fit.class) : "too few levels");
}

json_t *judge_orders(const struct judged *judged, size_t n)
{
    const struct judged *levels[JUDGE_SNAPSHOTS_MAX];
    double spacing[JUDGE_SNAPSHOTS_MAX], value[JUDGE_SNAPSHOTS_MAX];
    json_t *orders = json_array();
    const size_t count = levels_of(judged, n, levels);
    char why[JUDGE_WHY];
    if (count < 2 || levels[0]->result.problem.problem->fieldless ||
        !judge_one_ladder(judged, n, why))
        return orders;
    for (int field = 0; field < FIELDS; field++) {
        for (size_t i = 0; i < count; i++) {
            const bool slab = levels[i]->slab > 0; /* its layers may differ in number */
            const double in_plane = slab ? levels[i]->case_n : (double)levels[i]->result.n;
            spacing[i] = pow(in_plane, -1. / levels[i]->file.dim);
            value[i] = levels[i]->result.errors[field].l1;
        }
        json_array_append_new(orders,
                              order_json(field_family.members[field]->name, count, spacing, value));
    }
    return orders;
}
