/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reading.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "result.h"

enum { PATH_MAX_LENGTH = 1024, NAME_MAX_LENGTH = 512 };

/* Timings below this are noise. */
static const double timing_least = 0.02;
/* A check's value: a factor that means nothing, and as many floors. */
static const double check_factor = 3, check_floors = 10;

const char *const reading_verdicts[] = {"same", "better", "worse", "incomparable"};

/* ---- what a figure is, by its name and where it stands ---- */

/* inside: a name on the way to the figure, "" for anywhere. name: the figure's own; "*x" ends in x,
 * "x*" begins with x. The first rule that fits counts. */
static const struct rule {
    const char *inside, *name;
    enum { SKIP = -1 } skip; /* SKIP or 0 */
    enum reading_kind kind;
    double noise, floor;
} rules[] = {
    {"cheapest", "*", SKIP, 0, 0, 0},        /* which scheme that is depends on timings */
    {"checks", "seconds", SKIP, 0, 0, 0},    /* of thousands some are always slow */
    {"", "wall_s", 0, READING_TIMING, 3, 0}, /* what else runs counts */
    {"", "*_s", 0, READING_TIMING, 1.5, 0},
    {"", "seconds", 0, READING_TIMING, 3, 0},
    {"", "ns_*", 0, READING_TIMING, 1.5, 0},
    {"", "figure_of_merit", 0, READING_TIMING, 1.5, 0},
    {"", "peak_rss_bytes", 0, READING_TIMING, 1.5, 0},
    {"", "steps", 0, READING_COUNT, 0.01, 0},
    {"", "particle_updates", 0, READING_COUNT, 0.01, 0},
    {"", "pair_interactions", 0, READING_COUNT, 0.01, 0},
    {"faults", "status", 0, READING_STATUS, 0, 0},
    {"faults", "*", SKIP, 0, 0, 0},
    {"", "status", 0, READING_STATUS, 0, 0},
    {"", "detected", 0, READING_STATUS, 0, 0},
    {"", "suspicion", 0, READING_STATUS, 0, 0},
    {"", "outcome", 0, READING_STATUS, 0, 0},
    {"orders", "class", 0, READING_STATUS, 0, 0},
    {"", "still", 0, READING_CHECK, 0, 1e-9},
    {"still_gas", "value", 0, READING_CHECK, 0, 1e-9},
    {"errors", "linf", 0, READING_PART, 1e-3, 1e-13}, /* of one particle at a jump */
    {"errors", "*", 0, READING_ERROR, 1e-3, 1e-13},
    {"budget", "*", 0, READING_PART, 1e-2, 1e-13},
    {"regions", "l1", 0, READING_PART, 1e-2, 1e-13},
    {"regions", "*", SKIP, 0, 0, 0},
    {"conservation", "*", 0, READING_ERROR, 0.1, 1e-12},
    {"floors", "density", 0, READING_CHECK, 0, 1e-13},
    {"floors", "gradient", 0, READING_CHECK, 0, 1e-13},
    {"floors", "*", SKIP, 0, 0, 0},
    {"checks", "value", 0, READING_CHECK, 0, 0},
    {"checks", "*", SKIP, 0, 0, 0},
    {"mutants", "*", SKIP, 0, 0, 0},
    {"functionals", "extrapolated", 0, READING_EXACT, 0.05, 1e-13},
    {"functionals", "*", SKIP, 0, 0, 0},
    {"functionals_exact", "*", SKIP, 0, 0, 0},
    {"verdict", "*_failed", 0, READING_ERROR, 0, 0.5},
    {"verdict", "broke_down", 0, READING_ERROR, 0, 0.5},
    {"verdict", "*", SKIP, 0, 0, 0},
    {"summary", "failed", 0, READING_ERROR, 0, 0.5},
    {"", "error", 0, READING_ERROR, 1e-3, 1e-13},
    {"", "error_*", 0, READING_ERROR, 1e-2, 1e-12},
    {"", "relative_error", 0, READING_ERROR, 1e-3, 1e-13},
    {"", "*momentum_defect", 0, READING_ERROR, 0.1, 1e-12},
    {"", "order", 0, READING_ORDER, 0.02, 0},
    {"", "order_*", 0, READING_ORDER, 0.05, 0},
    {"", "exact_degree_*", 0, READING_ORDER, 0.5, 0},
    {"", "normalisation", 0, READING_EXACT, 1, 1e-12},
    {"", "low", SKIP, 0, 0, 0},
    {"", "high", SKIP, 0, 0, 0},
    {"", "skipped_particle_updates", SKIP, 0, 0, 0},
    {"", "samples", SKIP, 0, 0, 0},
    {"", "spread", SKIP, 0, 0, 0},
    {"", "replicates", SKIP, 0, 0, 0},
    {"", "seed_plain_over_this", SKIP, 0, 0, 0},
    {"", "computations", SKIP, 0, 0, 0},
    {"", "found", SKIP, 0, 0, 0},
    {"", "failures", SKIP, 0, 0, 0},
    {"", "*", 0, READING_NEUTRAL, 1e-9, 1e-13},
};

/* Members that hold no figures: what was asked for, how it was drawn. */
static const char *const closed[] = {"machine",  "profile",  "plan",        "settings",
                                     "gate",     "spread",   "pairwise",    "history",
                                     "failures", "excluded", "through_time"};

/* Members that say what an entry of a list is about, in this order. */
static const char *const names[] = {"case",     "label",   "scheme", "group",  "check",
                                    "name",     "subject", "fault",  "mutant", "kernel",
                                    "operator", "dim",     "field",  "norm",   "region",
                                    "eta",      "n",       "q",      "target", "reference"};

static bool one_of(const char *word, const char *const *list, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (strcmp(word, list[i]) == 0) return true;
    return false;
}

static bool fits(const char *pattern, const char *name)
{
    const size_t length = strlen(pattern), own = strlen(name);
    if (pattern[0] == '*')
        return own + 1 >= length && strcmp(name + own - (length - 1), pattern + 1) == 0;
    if (length && pattern[length - 1] == '*') return strncmp(name, pattern, length - 1) == 0;
    return strcmp(pattern, name) == 0;
}

/* Is name one of the path's parts outside brackets? */
static bool passes(const char *path, const char *name)
{
    const size_t length = strlen(name);
    int depth = 0;
    bool start = true;
    for (const char *c = path; *c; c++) {
        if (start && depth == 0 && strncmp(c, name, length) == 0 &&
            (c[length] == '.' || c[length] == '[' || !c[length]))
            return true;
        depth += (*c == '[') - (*c == ']');
        start = *c == '.';
    }
    return false;
}

static const struct rule *rule_of(const char *path, const char *name)
{
    const struct rule *rule = rules;
    while (!((!*rule->inside || passes(path, rule->inside)) && fits(rule->name, name))) rule++;
    return rule;
}

/* ---- walking through a document ---- */

static void add(struct readings *readings, struct reading reading, const char *path)
{
    if (readings->count == readings->room) {
        const size_t room = readings->room ? 2 * readings->room : 256;
        struct reading *list = realloc(readings->list, room * sizeof *list);
        if (!list) {
            readings->failed = true;
            return;
        }
        readings->list = list;
        readings->room = room;
    }
    reading.path = strdup(path);
    reading.word = reading.word ? strdup(reading.word) : NULL;
    if (!reading.path) readings->failed = true;
    reading.number = readings->count;
    readings->list[readings->count++] = reading;
}

static double member(const json_t *object, const char *name)
{
    return result_real(json_object_get(object, name));
}

static bool is_number(const json_t *value)
{
    const char *word = json_string_value(value);
    return json_is_number(value) ||
           (word && (!strcmp(word, "nan") || !strcmp(word, "inf") || !strcmp(word, "-inf")));
}

/* What the figure's neighbours know about its noise. */
static void refine(struct reading *reading, const json_t *parent, const char *name)
{
    if (reading->kind == READING_ORDER) {
        const double half = (member(parent, "high") - member(parent, "low")) / 2;
        if (half > reading->noise) reading->noise = half;
    }
    if (reading->kind == READING_CHECK && member(parent, "floor") >= 0)
        reading->floor = fmax(reading->floor, check_floors * member(parent, "floor"));
    if (reading->kind == READING_EXACT)
        reading->exact = strcmp(name, "normalisation") ? member(parent, "exact") : 1;
    if (reading->kind == READING_EXACT && !isfinite(reading->exact))
        reading->kind = READING_NEUTRAL;
}

/* Replicates say themselves how far an error may move: two standard deviations of the mean. */
static double level_noise(const json_t *level, const char *field, const char *norm)
{
    const double spread = member(json_object_get(json_object_get(level, "spread"), field), norm);
    const double replicates = member(level, "replicates");
    return spread > 0 && replicates > 1 ? 2 * spread / sqrt(replicates) : 0;
}

/* level: the entry of "levels" that encloses this object, or NULL; field: its field. */
struct place {
    char path[PATH_MAX_LENGTH];
    const json_t *level;
    const char *field;
};

static void take(struct readings *readings, const struct place *at, const json_t *parent,
                 const char *name, const json_t *value)
{
    char path[PATH_MAX_LENGTH + NAME_MAX_LENGTH];
    const struct rule *rule = rule_of(at->path, name);
    if (rule->skip) return;
    struct reading reading = {
        .kind = rule->kind, .value = NAN, .noise = rule->noise, .floor = rule->floor};
    if (rule->kind == READING_STATUS) {
        const char *word = json_string_value(value);
        if (json_is_boolean(value)) word = json_is_true(value) ? "true" : "false";
        if (!word) return;
        reading.word = (char *)word;
    } else if (is_number(value)) {
        reading.value = result_real(value);
        refine(&reading, parent, name);
        if (at->level && at->field && rule->kind == READING_ERROR)
            reading.noise = fmax(reading.noise, level_noise(at->level, at->field, name));
    } else {
        return;
    }
    snprintf(path, sizeof path, "%s%s%s", at->path, *at->path ? "." : "", name);
    static const char *const minor[] = {"l2", "linf", "particle_mean", "class"};
    const char *norm = json_string_value(json_object_get(parent, "norm"));
    reading.headline = !one_of(name, minor, sizeof minor / sizeof *minor) &&
                       (!norm || !strcmp(norm, "l1")) && reading.kind != READING_NEUTRAL &&
                       !passes(at->path, "kernels") && !passes(at->path, "verify") &&
                       !passes(at->path, "budget") && !passes(at->path, "budgets") &&
                       strcmp(name, "suspicion") != 0;
    add(readings, reading, path);
}

/* Numbers of five digits and more behind the point say where something was found ("q 0.564762"),
 * and that moves with what was found: they are no part of a name. */
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

/* "sod, default" of an entry; its number where nothing names it. */
static void name_entry(const json_t *entry, size_t number, char name[NAME_MAX_LENGTH])
{
    size_t used = 0;
    const json_t *settings = json_object_get(entry, "settings"), *value;
    const char *key;
    name[0] = '\0';
    for (size_t i = 0; i < sizeof names / sizeof *names && used < NAME_MAX_LENGTH; i++) {
        value = json_object_get(entry, names[i]);
        const char *comma = used ? ", " : "";
        if (json_is_string(value)) {
            const size_t begin = used;
            used += (size_t)snprintf(name + used, NAME_MAX_LENGTH - used, "%s%s", comma,
                                     json_string_value(value));
            if (strcmp(names[i], "subject") != 0 || used >= NAME_MAX_LENGTH) continue;
            leave_out_places(name + begin);
            used = strlen(name);
        } else if (json_is_number(value))
            used += (size_t)snprintf(name + used, NAME_MAX_LENGTH - used, "%s%s %.10g", comma,
                                     names[i], json_number_value(value));
    }
    /* what varies in a study; whole settings say nothing more than the names above */
    if (json_object_size(settings) <= 8) json_object_foreach((json_t *)settings, key, value)
        {
            if (used < NAME_MAX_LENGTH && json_is_string(value))
                used += (size_t)snprintf(name + used, NAME_MAX_LENGTH - used, "%s%s=%s",
                                         used ? ", " : "", key, json_string_value(value));
        }
    if (!used) snprintf(name, NAME_MAX_LENGTH, "%zu", number);
}

static void walk(struct readings *readings, const struct place *at, const json_t *object);

static void walk_list(struct readings *readings, const struct place *at, const char *key,
                      const json_t *list)
{
    for (size_t i = 0; i < json_array_size(list); i++) {
        const json_t *entry = json_array_get(list, i);
        char name[NAME_MAX_LENGTH];
        struct place inside = *at;
        if (!json_is_object(entry)) continue; /* raw data */
        name_entry(entry, i, name);
        snprintf(inside.path, sizeof inside.path, "%.400s%s%.80s[%.480s]", at->path,
                 *at->path ? "." : "", key, name);
        if (strcmp(key, "levels") == 0) inside.level = entry;
        walk(readings, &inside, entry);
    }
}

static void walk(struct readings *readings, const struct place *at, const json_t *object)
{
    static const char *const heads[] = {"schema", "command", "version",     "git",
                                        "date",   "flags",   "computations"};
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)object, key, value)
    {
        if (one_of(key, closed, sizeof closed / sizeof *closed)) continue;
        if (!*at->path && one_of(key, heads, sizeof heads / sizeof *heads)) continue;
        if (json_is_array(value)) {
            walk_list(readings, at, key, value);
        } else if (json_is_object(value)) {
            struct place inside = *at;
            snprintf(inside.path, sizeof inside.path, "%.900s%s%.100s", at->path,
                     *at->path ? "." : "", key);
            inside.field = key;
            walk(readings, &inside, value);
        } else if (!one_of(key, names, sizeof names / sizeof *names)) {
            take(readings, at, object, key, value);
        }
    }
}

static int by_path(const void *a, const void *b)
{
    const struct reading *x = a, *y = b;
    const int order = strcmp(x->path, y->path);
    return order ? order : (x->number > y->number) - (x->number < y->number);
}

/* Entries that nothing tells apart are numbered. Sorted, they stand together. */
static void number_doubles(struct readings *readings)
{
    for (size_t i = 0, next; i < readings->count; i = next)
        for (next = i + 1; next < readings->count &&
                           strcmp(readings->list[next].path, readings->list[i].path) == 0;
             next++) {
            char path[PATH_MAX_LENGTH + NAME_MAX_LENGTH + 24];
            snprintf(path, sizeof path, "%s #%zu", readings->list[next].path, next - i + 1);
            char *copy = strdup(path);
            if (!copy) {
                readings->failed = true;
                return;
            }
            free(readings->list[next].path);
            readings->list[next].path = copy;
        }
}

enum status reading_collect(const json_t *document, struct readings *readings, struct error *error)
{
    const struct place top = {.path = ""};
    *readings = (struct readings){0};
    walk(readings, &top, document);
    if (!readings->failed && readings->count) {
        qsort(readings->list, readings->count, sizeof *readings->list, by_path);
        number_doubles(readings);
        qsort(readings->list, readings->count, sizeof *readings->list, by_path);
    }
    if (!readings->failed) return STATUS_OK;
    reading_free(readings);
    return error_set(error, STATUS_ENVIRONMENT, "no memory for the figures of a document");
}

void reading_free(struct readings *readings)
{
    for (size_t i = 0; i < readings->count; i++) {
        free(readings->list[i].path);
        free(readings->list[i].word);
    }
    free(readings->list);
    *readings = (struct readings){0};
}

static int path_of(const void *path, const void *reading)
{
    return strcmp(path, ((const struct reading *)reading)->path);
}

const struct reading *reading_find(const struct readings *readings, const char *path)
{
    return readings->count
               ? bsearch(path, readings->list, readings->count, sizeof *readings->list, path_of)
               : NULL;
}

/* ---- judging ---- */

/* How bad a word is; -1: not known. */
static int rank(const char *word, bool suspicion)
{
    static const struct {
        const char *word;
        int rank;
    } ranks[] = {{"", 0},          {"pass", 0},          {"ok", 0},   {"true", 0},
                 {"none", 0},      {"asymptotic", 0},    {"skip", 1}, {"oscillating", 1},
                 {"diverging", 2}, {"floor-limited", 1}, {"fail", 3}, {"false", 3},
                 {"broke_down", 4}};
    if (suspicion) return *word ? 3 : 0;
    for (size_t i = 0; i < sizeof ranks / sizeof *ranks; i++)
        if (strcmp(ranks[i].word, word) == 0) return ranks[i].rank;
    return -1;
}

static enum reading_verdict judge_word(const struct reading *old, const struct reading *new,
                                       double *amount, bool *fault)
{
    const size_t length = strlen(new->path), tail = strlen("suspicion");
    const bool suspicion = length >= tail && !strcmp(new->path + length - tail, "suspicion");
    const int before = rank(old->word, suspicion), after = rank(new->word, suspicion);
    if (strcmp(old->word, new->word) == 0) return VERDICT_SAME;
    if (before < 0 || after < 0) return VERDICT_INCOMPARABLE;
    if (before == after) return VERDICT_SAME;
    if (after < before) return VERDICT_BETTER;
    *amount = (double)INFINITY;
    *fault = after >= 3;
    return VERDICT_WORSE;
}

/* a before, b after, less being better. */
static enum reading_verdict judge_less(double a, double b, double noise, double floor,
                                       double *amount)
{
    if (a <= floor && b <= floor) return VERDICT_SAME;
    const double base = fmax(a, floor);
    const double change = base > 0 ? (b - base) / base : (b > 0 ? (double)INFINITY : 0);
    if (fabs(b - a) <= noise * base || change == 0) return VERDICT_SAME;
    if (change < 0) return VERDICT_BETTER;
    *amount = change;
    return VERDICT_WORSE;
}

static enum reading_verdict judge_number(const struct reading *old, const struct reading *new,
                                         double *amount, bool *fault)
{
    const double a = old->value, b = new->value, noise = fmax(old->noise, new->noise);
    const double floor = fmax(old->floor, new->floor);
    switch (new->kind) {
    case READING_ERROR:
        *fault = true;
        return judge_less(a, b, noise, floor, amount);
    case READING_CHECK:
        return judge_less(a, b, check_factor - 1, floor, amount) == VERDICT_WORSE ? VERDICT_WORSE
               : b * check_factor < a && a > floor                                ? VERDICT_BETTER
                                                                                  : VERDICT_SAME;
    case READING_EXACT:
        return judge_less(fabs(a - old->exact), fabs(b - new->exact), noise,
                          floor * (1 + fabs(new->exact)), amount);
    case READING_COUNT:
    case READING_PART:
        return judge_less(a, b, noise, floor, amount);
    case READING_TIMING:
        if (fabs(b - a) < timing_least || (b < noise * a && a < noise * b)) return VERDICT_SAME;
        *amount = b > a ? b / a - 1 : 0;
        return b > a ? VERDICT_WORSE : VERDICT_BETTER;
    case READING_ORDER:
        if (fabs(b - a) <= hypot(old->noise, new->noise)) return VERDICT_SAME;
        *amount = fmax(0, a - b);
        *fault = b < a;
        return b < a ? VERDICT_WORSE : VERDICT_BETTER;
    default:
        return fabs(b - a) <= fmax(floor, noise * fabs(a)) ? VERDICT_SAME : VERDICT_INCOMPARABLE;
    }
}

enum reading_verdict reading_judge(const struct reading *old, const struct reading *new,
                                   double *amount, bool *fault)
{
    *amount = 0;
    *fault = false;
    if (!old || !new || !old->word != !new->word) return VERDICT_INCOMPARABLE;
    if (new->word) return judge_word(old, new, amount, fault);
    const double a = old->value, b = new->value;
    if (a == b || (isnan(a) && isnan(b))) return VERDICT_SAME;
    if (isfinite(a) && isfinite(b)) return judge_number(old, new, amount, fault);
    if (new->kind == READING_TIMING || new->kind == READING_NEUTRAL) return VERDICT_INCOMPARABLE;
    if (isfinite(b)) return VERDICT_BETTER;
    *amount = (double)INFINITY;
    *fault = new->kind == READING_ERROR;
    return VERDICT_WORSE;
}
