/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "diff.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "problem.h"
#include "problem_list.h"
#include "value.h"

/* Settings that change the solved problem, in addition to the problem's own keys; results that
 * differ only in other settings are compared. */
static const enum setting problem_keys[] = {
    SETTING_kind,   SETTING_gamma,         SETTING_t_end, SETTING_lo,      SETTING_hi,
    SETTING_window, SETTING_window_radius, SETTING_boost, SETTING_gravity, SETTING_boundary,
    SETTING_jitter, SETTING_seed,          SETTING_n};

/* Members of a document that also define the problem; command "": of every document. */
static const struct {
    const char *command, *member;
} problem_members[] = {
    {"", "case"},        {"", "mode"},         {"kernel", "kernel"},     {"kernel", "dim"},
    {"kernel", "h"},     {"gradient", "dim"},  {"gradient", "operator"}, {"gradient", "kernel"},
    {"riemann", "left"}, {"riemann", "right"}, {"riemann", "gamma"},     {"riemann", "time"},
    {"riemann", "x0"},   {"judge", "n"},       {"judge", "time"},        {"judge", "window"},
};

static bool differs(const json_t *a, const json_t *b)
{
    return a && b && !json_equal(a, b);
}

/* The key's name if the settings of two documents differ in it, else NULL. */
static const char *differing(const json_t *old, const json_t *new, enum setting key)
{
    const char *name = setting_keys[key].name;
    const json_t *before = json_object_get(json_object_get(old, "settings"), name);
    return differs(before, json_object_get(json_object_get(new, "settings"), name)) ? name : NULL;
}

static const char *differing_problem(const json_t *old, const json_t *new)
{
    const char *what = NULL;
    for (size_t i = 0; i < problem_family.n && !what; i++) {
        const struct problem *problem = (const struct problem *)problem_family.members[i];
        for (size_t k = 0; k < problem->key_count && !what; k++)
            if (problem->keys[k].role != ROLE_PARTICLES)
                what = differing(old, new, problem->keys[k].key);
    }
    for (size_t i = 0; i < sizeof problem_keys / sizeof *problem_keys && !what; i++)
        what = differing(old, new, problem_keys[i]);
    return what;
}

/* Sets diff->problem if the documents solve different problems. Missing information counts as
 * equal. */
static void compare_problems(const json_t *old, const json_t *new, struct diff *diff)
{
    const char *what = NULL, *command = json_string_value(json_object_get(new, "command"));
    for (size_t i = 0; i < sizeof problem_members / sizeof *problem_members && !what; i++) {
        const char *member = problem_members[i].member, *of = problem_members[i].command;
        if ((!*of || strcmp(of, command) == 0) &&
            differs(json_object_get(old, member), json_object_get(new, member)))
            what = member;
    }
    if (!what) what = differing_problem(old, new);
    if (what)
        snprintf(diff->problem, sizeof diff->problem,
                 "the documents differ in %s: two problems, whose figures say nothing about each "
                 "other",
                 what);
}

static int severity(const struct difference *d)
{
    static const int order[] = {
        [VERDICT_VANISHED] = 1, [VERDICT_INCOMPARABLE] = 2, [VERDICT_WORSE] = 3,
        [VERDICT_BETTER] = 4,   [VERDICT_NEW] = 5,          [VERDICT_SAME] = 6};
    return d->regression ? 0 : order[d->verdict];
}

static bool is_timing(const struct difference *d)
{
    return d->new && d->new->kind == METRIC_TIMING;
}

static int worst_first(const void *a, const void *b)
{
    const struct difference *x = a, *y = b;
    const int i = severity(x), j = severity(y);
    if (i != j) return i - j;
    /* a failed check names the cause; a broken run, which has no rank, is its consequence */
    const double a_rank = x->any->rank, b_rank = y->any->rank;
    if (i == 0 && a_rank != b_rank) return (a_rank > b_rank) - (a_rank < b_rank);
    const bool a_time = is_timing(x), b_time = is_timing(y);
    if (a_time != b_time) return a_time ? 1 : -1;
    const bool a_head = x->new && x->new->headline, b_head = y->new && y->new->headline;
    if (a_head != b_head) return a_head ? -1 : 1;
    if (x->amount != y->amount) return x->amount > y->amount ? -1 : 1;
    return strcmp(x->any->path, y->any->path);
}

static void judge(struct diff *diff, const struct metric *old, const struct metric *new,
                  double threshold)
{
    struct difference *d = &diff->list[diff->count++];
    bool fault = false;
    *d = (struct difference){.old = old, .new = new, .any = new ? new : old};
    if (diff->problem[0] && old && new)
        d->verdict = VERDICT_INCOMPARABLE;
    else
        d->verdict = metric_judge(old, new, &d->amount, &fault);
    const bool order = new &&new->kind == METRIC_ORDER; /* an order has its interval as threshold */
    d->regression = d->verdict == VERDICT_WORSE && fault && (order || d->amount > threshold);
}

/* ---- related figures ---- */

/* Length of the path of the object that contains the figure at path. */
static size_t object_length(const char *path)
{
    size_t end = 0;
    int depth = 0;
    for (const char *c = path; *c; c++) {
        depth += (*c == '[') - (*c == ']');
        if (*c == '.' && depth == 0) end = (size_t)(c - path);
    }
    return end;
}

/* True if the other figure is in the object of the figure at path. */
static bool within(const char *path, size_t object, const char *other)
{
    return other != path && strncmp(path, other, object) == 0 && (!object || other[object] == '.');
}

static bool says_broke_down(const struct metric *metric)
{
    return metric && metric->word && strcmp(metric->word, "broke_down") == 0;
}

/* Removes the figures that are left out; returns their number. */
static size_t leave_out(struct diff *diff)
{
    const size_t before = diff->count;
    diff->count = 0;
    for (size_t i = 0; i < before; i++)
        if (!diff->list[i].left_out) diff->list[diff->count++] = diff->list[i];
    return before - diff->count;
}

/* If a run broke down, before or now, its figures belong to other times or are missing: only the
 * breakdown is compared. */
static void mark_broken(struct diff *diff)
{
    struct difference *list = diff->list;
    for (size_t i = 0; i < diff->count; i++) {
        if (!says_broke_down(list[i].old) && !says_broke_down(list[i].new)) continue;
        const char *path = list[i].any->path;
        const size_t object = object_length(path);
        for (size_t k = 0; k < diff->count; k++)
            list[k].left_out = list[k].left_out || within(path, object, list[k].any->path);
    }
}

static void mark_times(struct diff *diff)
{
    for (size_t i = 0; i < diff->count; i++)
        diff->list[i].left_out = diff->list[i].any->kind == METRIC_TIMING;
}

/* True if the documents name two different processors. */
static bool of_two_processors(const json_t *old, const json_t *new)
{
    const char *before = value_text(json_object_get(old, "machine"), "processor");
    const char *after = value_text(json_object_get(new, "machine"), "processor");
    return *before && *after && strcmp(before, after) != 0;
}

/* A status that fails because a part fails is not a regression of its own. */
static void count_causes(struct diff *diff)
{
    for (size_t i = 0; i < diff->count; i++) {
        struct difference *whole = &diff->list[i];
        if (!whole->regression || !whole->new->word) continue;
        const char *path = whole->any->path;
        const size_t object = strcmp(path, "verdict.status") ? object_length(path) : 0;
        for (size_t k = 0; k < diff->count && whole->regression; k++)
            if (diff->list[k].regression && within(path, object, diff->list[k].any->path))
                whole->regression = false;
    }
}

/* True if both documents have the figure and it is a number in one of them. */
static bool is_compared(const struct difference *d)
{
    return d->old && d->new &&
           (d->new->word || d->old->word || !isnan(d->old->value) || !isnan(d->new->value));
}

static void conclude(struct diff *diff)
{
    for (size_t i = 0; i < diff->count; i++) {
        diff->verdicts[diff->list[i].verdict]++;
        diff->regressions += diff->list[i].regression;
        diff->compared += is_compared(&diff->list[i]);
    }
    if (diff->problem[0]) diff->compared = 0;
    if (!diff->compared && !diff->problem[0])
        snprintf(diff->problem, sizeof diff->problem,
                 "nothing was compared: no figure is a number or a word in both documents");
    diff->well = !diff->problem[0] && !diff->regressions && !diff->verdicts[VERDICT_VANISHED] &&
                 !diff->verdicts[VERDICT_INCOMPARABLE];
}

enum status diff_documents(const json_t *old, const json_t *new, double threshold,
                           struct diff *diff, struct error *error)
{
    const char *before = json_string_value(json_object_get(old, "command"));
    const char *after = json_string_value(json_object_get(new, "command"));
    *diff = (struct diff){.count = 0};
    if (!before || !after || strcmp(before, after) != 0)
        return error_set(error, STATUS_BAD_INPUT,
                         "documents of two commands, '%.40s' and '%.40s': allowed: two of one",
                         before ? before : "", after ? after : "");
    compare_problems(old, new, diff);
    if (metric_collect(old, &diff->old, error) || metric_collect(new, &diff->new, error)) {
        diff_free(diff);
        return error->status;
    }
    if (diff->old.trouble[0] || diff->new.trouble[0]) {
        error_set(error, STATUS_BAD_INPUT, "%s document: %.300s",
                  diff->old.trouble[0] ? "old" : "new",
                  diff->old.trouble[0] ? diff->old.trouble : diff->new.trouble);
        diff_free(diff);
        return error->status;
    }
    const struct metrics *a = &diff->old, *b = &diff->new;
    diff->list = calloc(a->count + b->count, sizeof *diff->list);
    if (!diff->list) {
        diff_free(diff);
        return error_set(error, STATUS_ENVIRONMENT, "no memory for the differences");
    }
    for (size_t i = 0, j = 0; i < a->count || j < b->count;) {
        const int order = i == a->count   ? 1
                          : j == b->count ? -1
                                          : strcmp(a->list[i].path, b->list[j].path);
        judge(diff, order <= 0 ? &a->list[i] : NULL, order >= 0 ? &b->list[j] : NULL, threshold);
        i += order <= 0;
        j += order >= 0;
    }
    mark_broken(diff);
    diff->left_out = leave_out(diff);
    if (of_two_processors(old, new)) mark_times(diff);
    diff->left_out_times = leave_out(diff);
    count_causes(diff);
    conclude(diff);
    qsort(diff->list, diff->count, sizeof *diff->list, worst_first);
    return diff->well ? STATUS_OK : STATUS_CHECK_FAILED;
}

void diff_free(struct diff *diff)
{
    metric_free(&diff->old);
    metric_free(&diff->new);
    free(diff->list);
    *diff = (struct diff){.count = 0};
}
