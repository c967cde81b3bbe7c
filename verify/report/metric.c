/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "metric.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "list.h"
#include "text.h"
#include "value.h"

enum { PATH_MAX_LENGTH = 1536, NAME_MAX_LENGTH = 900, KEYS_MAX = 64 };

/* A check's value below this many of its floors is noise. */
static const double check_floors = 10;

/* Members without figures: requests and how results are drawn. */
static const char *const closed[] = {"machine",  "profile", "plan",     "settings", "gate",
                                     "pairwise", "history", "failures", "excluded", "through_time"};

/* Members that identify an entry of a list, in this order: words, then numbers. */
static const char *const words[] = {
    "case",    "label", "scheme", "group",  "row",      "column",   "check", "name",
    "subject", "fault", "mutant", "kernel", "operator", "gradient", "of",    "what",
    "skip",    "field", "norm",   "region", "against",  "quantity", "part"};
static const char *const numbers[] = {"dim", "eta", "alpha", "n", "q", "x", "target", "threads"};
#define LENGTH(list) (sizeof(list) / sizeof *(list))

static bool one_of(const char *word, const char *const *list, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (strcmp(word, list[i]) == 0) return true;
    return false;
}

/* ---- document traversal ---- */

static void add(struct metrics *metrics, struct metric metric, const char *path)
{
    if (!list_grow(&metrics->list, metrics->count, sizeof *metrics->list)) {
        metrics->failed = true;
        return;
    }
    metric.path = strdup(path);
    const char *word = metric.word;
    metric.word = word ? strdup(word) : NULL;
    if (!metric.path || (word && !metric.word)) metrics->failed = true;
    metric.number = metrics->count;
    metrics->list[metrics->count++] = metric;
}

/* level: the enclosing entry of "levels", or NULL; field: its field. */
struct place {
    char path[PATH_MAX_LENGTH];
    const json_t *level;
    const char *field;
    double rank; /* of the enclosing entry of "checks"; infinite: none */
};

static double exact_of(const json_t *parent, const char *name)
{
    if (strcmp(name, "normalisation") == 0) return 1;
    return value_member(parent, strcmp(name, "value") ? "exact" : "reference");
}

/* Sets a figure's noise from other members of the same object. */
static void refine(struct metric *metric, const json_t *parent, const char *name)
{
    if (metric->kind == METRIC_ORDER) {
        const double half = (value_member(parent, "high") - value_member(parent, "low")) / 2;
        if (half > metric->noise) metric->noise = half;
    }
    if (metric->kind == METRIC_CHECK && value_member(parent, "floor") >= 0)
        metric->floor = fmax(metric->floor, check_floors * value_member(parent, "floor"));
    if (metric->kind == METRIC_PART && isfinite(value_member(parent, "predicted"))) {
        metric->kind = METRIC_EXACT;
        metric->exact = value_member(parent, "predicted");
    } else if (metric->kind == METRIC_EXACT) {
        metric->exact = exact_of(parent, name);
        if (!isfinite(metric->exact)) metric->kind = METRIC_NEUTRAL;
    }
}

/* Noise from replicates: two standard deviations of the mean; NaN: none. */
static double level_noise(const json_t *level, const char *field, const char *norm)
{
    const double spread =
        value_member(json_object_get(json_object_get(level, "spread"), field), norm);
    const double replicates = value_member(level, "replicates");
    return replicates > 1 ? 2 * spread / sqrt(replicates) : (double)NAN;
}

static void note_trouble(struct metrics *metrics, const char *path, const char *why)
{
    if (!metrics->trouble[0])
        snprintf(metrics->trouble, sizeof metrics->trouble, "%.200s: %s", path, why);
}

static bool is_headline(const struct place *at, const json_t *parent, const char *name,
                        const struct metric *metric)
{
    static const char *const minor[] = {"l1_whole",      "l2",    "linf",
                                        "particle_mean", "class", "suspicion"};
    const char *norm = json_string_value(json_object_get(parent, "norm"));
    return !one_of(name, minor, LENGTH(minor)) && (!norm || !strcmp(norm, "l1")) &&
           metric->kind != METRIC_NEUTRAL &&
           !metric_passes(at->path, "kernels verify budget budgets");
}

/* Takes the member `name` of parent. */
static void take(struct metrics *metrics, const struct place *at, const json_t *parent,
                 const char *name, const json_t *value)
{
    char path[PATH_MAX_LENGTH + 128];
    const char *word = json_string_value(value);
    const bool number = value_is_real(value), truth = json_is_boolean(value);
    const struct metric_rule *rule = metric_rule(at->path, name);
    if (json_is_null(value) || (rule && rule->use == RULE_LEFT_OUT)) return;
    snprintf(path, sizeof path, "%s%s%.100s", at->path, *at->path ? "." : "", name);
    if (!rule) {
        if (number || truth) note_trouble(metrics, path, "a figure of a kind that is not known");
        return;
    }
    struct metric metric = {.kind = rule->kind,
                            .value = NAN,
                            .noise = rule->noise,
                            .floor = rule->floor,
                            .rank = at->rank};
    if (rule->kind == METRIC_STATUS) {
        if (truth) word = json_is_true(value) ? "true" : "false";
        if (!word) return;
        metric.word = (char *)word;
    } else if (number) {
        metric.value = value_real(value);
        if (rule->kind == METRIC_ERROR && metric.value < 0)
            note_trouble(metrics, path, "a negative error");
        refine(&metric, parent, name);
        if (at->level && at->field && rule->kind == METRIC_ERROR)
            metric.noise = fmax(metric.noise, level_noise(at->level, at->field, name));
    } else {
        return;
    }
    metric.headline = is_headline(at, parent, name, &metric);
    add(metrics, metric, path);
}

/* Takes the components of a vector that is itself a figure. */
static void take_vector(struct metrics *metrics, const struct place *at, const char *name,
                        const json_t *list)
{
    static const char *const components[] = {"x", "y", "z"};
    struct place inside = *at;
    if (!json_array_size(list) || json_array_size(list) > 3 ||
        !(metric_passes(at->path, "gradients") || strcmp(name, "force") == 0))
        return;
    const size_t length = strlen(at->path);
    snprintf(inside.path + length, sizeof inside.path - length, "%s%.100s", length ? "." : "",
             name);
    for (size_t i = 0; i < json_array_size(list); i++)
        take(metrics, &inside, list, components[i], json_array_get(list, i));
}

/* Removes numbers with five or more decimals from a name: they are positions of extrema ("q
 * 0.564762"), which move when the results change. */
static void leave_out_places(char *name)
{
    char *to = name;
    for (const char *from = name; *from;) {
        const size_t whole = strspn(from, "0123456789");
        const size_t places = from[whole] == '.' ? strspn(from + whole + 1, "0123456789") : 0;
        size_t length = whole + (places ? places + 1 : 0);
        if (places >= 5) {
            *to++ = '~';
        } else {
            length += length == 0;
            memmove(to, from, length);
            to += length;
        }
        from += length;
    }
    *to = '\0';
}

/* Appends ", text" to a name; replaces brackets, which delimit names in a path. */
static void add_name(char name[NAME_MAX_LENGTH], const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static void add_name(char name[NAME_MAX_LENGTH], const char *format, ...)
{
    const size_t begin = strlen(name);
    if (begin) text_add(name, NAME_MAX_LENGTH, ", ");
    const size_t used = strlen(name);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(name + used, NAME_MAX_LENGTH - used, format, arguments);
    va_end(arguments);
    for (char *c = name + begin; *c; c++) {
        if (*c == '[') *c = '(';
        if (*c == ']') *c = ')';
    }
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Appends settings that are all words. The settings of a whole run add nothing to the other names,
 * and change with defaults. */
static void add_settings(char name[NAME_MAX_LENGTH], const json_t *settings)
{
    const char *key, *keys[KEYS_MAX];
    const json_t *value;
    size_t n = 0;
    json_object_foreach((json_t *)settings, key, value) {
        if (!json_is_string(value) || n == KEYS_MAX) return;
        keys[n++] = key;
    }
    if (n) qsort(keys, n, sizeof *keys, by_name);
    for (size_t i = 0; i < n; i++)
        add_name(name, "%s=%s", keys[i], json_string_value(json_object_get(settings, keys[i])));
}

/* Names an entry by its members ("sod, default"), never by its index. */
static void name_entry(const json_t *entry, char name[NAME_MAX_LENGTH])
{
    const json_t *value;
    size_t k;
    name[0] = '\0';
    for (size_t i = 0; i < LENGTH(words); i++) {
        const char *word = json_string_value(json_object_get(entry, words[i]));
        const size_t begin = strlen(name);
        if (!word) continue;
        add_name(name, "%s", word);
        if (strcmp(words[i], "subject") == 0) leave_out_places(name + begin);
    }
    for (size_t i = 0; i < LENGTH(numbers); i++) {
        const json_t *number = json_object_get(entry, numbers[i]);
        if (json_is_number(number))
            add_name(name, "%s %.10g", numbers[i], json_number_value(number));
        json_array_foreach(number, k, value)
            add_name(name, "%s %.10g", numbers[i], json_number_value(value));
    }
    add_settings(name, json_object_get(entry, "settings"));
}

static bool is_name(const char *key, const json_t *value)
{
    return json_is_string(value) ? one_of(key, words, LENGTH(words))
                                 : one_of(key, numbers, LENGTH(numbers));
}

static void walk(struct metrics *metrics, const struct place *at, const json_t *object);

static void walk_list(struct metrics *metrics, const struct place *at, const char *key,
                      const json_t *list)
{
    const json_t *entry;
    size_t i;
    json_array_foreach(list, i, entry) {
        char name[NAME_MAX_LENGTH];
        struct place inside = *at;
        if (!json_is_object(entry)) continue; /* raw data */
        name_entry(entry, name);
        if (strcmp(key, "snapshots") == 0) /* usually of one run at different times */
            add_name(name, "time %.10g", value_member(entry, "time"));
        const char *computed = json_string_value(json_object_get(entry, "reproduce"));
        if (computed &&
            (!strcmp(key, "skips") || !strcmp(key, "autopsies"))) /* a case may occur twice */
            add_name(name, "%s", computed);
        const int length = snprintf(inside.path, sizeof inside.path, "%s%s%.80s[%s]", at->path,
                                    *at->path ? "." : "", key, name);
        if (length >= (int)sizeof inside.path || strlen(name) + 1 >= sizeof name) {
            note_trouble(metrics, key, "an entry whose name is too long");
            continue;
        }
        if (strcmp(key, "levels") == 0) inside.level = entry;
        if (strcmp(key, "checks") == 0)
            inside.rank = fmin(value_member(entry, "rank"), HUGE_VAL); /* NaN: infinite */
        walk(metrics, &inside, entry);
    }
}

static void walk_object(struct metrics *metrics, const struct place *at, const char *key,
                        const json_t *object)
{
    struct place inside = *at;
    const int length = snprintf(inside.path, sizeof inside.path, "%s%s%.100s", at->path,
                                *at->path ? "." : "", key);
    if (length >= (int)sizeof inside.path) {
        note_trouble(metrics, key, "a name that is too long");
        return;
    }
    inside.field = key;
    walk(metrics, &inside, object);
}

static void walk(struct metrics *metrics, const struct place *at, const json_t *object)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)object, key, value) {
        if (one_of(key, closed, LENGTH(closed)) || is_name(key, value)) continue;
        if (json_is_array(value)) {
            walk_list(metrics, at, key, value);
            take_vector(metrics, at, key, value);
        } else if (json_is_object(value)) {
            walk_object(metrics, at, key, value);
        } else {
            take(metrics, at, object, key, value);
        }
    }
}

static int by_path(const void *a, const void *b)
{
    const struct metric *x = a, *y = b;
    const int order = strcmp(x->path, y->path);
    return order ? order : (x->number > y->number) - (x->number < y->number);
}

/* Joins indistinguishable entries into one with the worst value: pairing them by index would
 * compare different things as soon as one is missing. Their number becomes part of the name. */
static void join_alike(struct metrics *metrics)
{
    struct metric *list = metrics->list;
    size_t kept = 0;
    for (size_t i = 0, next; i < metrics->count; i = next, kept++) {
        size_t worst = i;
        for (next = i + 1; next < metrics->count; next++) {
            if (strcmp(list[next].path, list[i].path) != 0) break;
            if (list[worst].kind == METRIC_NEUTRAL)
                note_trouble(metrics, list[i].path, "nothing tells several entries apart");
            if (metric_worse(&list[next], &list[worst])) worst = next;
        }
        struct metric one = list[worst];
        for (size_t k = i; k < next; k++)
            if (k != worst) free(list[k].path), free(list[k].word);
        if (next - i > 1) {
            char path[PATH_MAX_LENGTH + 160];
            snprintf(path, sizeof path, "%s (%zu alike)", one.path, next - i);
            free(one.path);
            one.path = strdup(path);
            if (!one.path) metrics->failed = true;
        }
        list[kept] = one;
    }
    metrics->count = kept;
}

enum status metric_collect(const json_t *document, struct metrics *metrics, struct error *error)
{
    const struct place top = {.path = "", .rank = HUGE_VAL};
    *metrics = (struct metrics){0};
    walk(metrics, &top, document);
    if (!metrics->failed && metrics->count) {
        qsort(metrics->list, metrics->count, sizeof *metrics->list, by_path);
        join_alike(metrics);
    }
    if (!metrics->failed && metrics->count)
        qsort(metrics->list, metrics->count, sizeof *metrics->list, by_path);
    if (!metrics->failed) return STATUS_OK;
    metric_free(metrics);
    return error_set(error, STATUS_ENVIRONMENT, "no memory for the figures of a document");
}

void metric_free(struct metrics *metrics)
{
    for (size_t i = 0; i < metrics->count; i++) {
        free(metrics->list[i].path);
        free(metrics->list[i].word);
    }
    free(metrics->list);
    *metrics = (struct metrics){0};
}
