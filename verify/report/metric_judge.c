/* SPDX-License-Identifier: GPL-3.0-or-later
 * Judges the change of a figure: better, worse, or the same within its noise. */
#include <math.h>
#include <string.h>

#include "metric.h"

/* Timings below this are noise. */
static const double timing_least = 0.02;
/* Changes of a check's value within this factor are noise. */
static const double check_factor = 3;

const char *const metric_verdicts[METRIC_VERDICTS] = {"same",         "better",   "worse",
                                                      "incomparable", "vanished", "new"};

/* Severity of a word; -1: unknown. From FAULT on it is a fault. */
enum { FAULT = 3 };
static int rank(const char *word, bool suspicion)
{
    static const struct {
        const char *word;
        int rank;
    } ranks[] = {{"", 0},           {"pass", 0},          {"ok", 0},       {"true", 0},
                 {"asymptotic", 0}, {"none", 1},          {"skip", 1},     {"oscillating", 1},
                 {"diverging", 2},  {"floor-limited", 1}, {"fail", FAULT}, {"false", FAULT},
                 {"inaccurate", 4}, {"broke_down", 5},    {"wrong", 6},    {"pre-asymptotic", 1},
                 {"smoke", 1},      {"undetermined", 1}};
    if (suspicion) return *word ? FAULT : 0;
    for (size_t i = 0; i < sizeof ranks / sizeof *ranks; i++)
        if (strcmp(ranks[i].word, word) == 0) return ranks[i].rank;
    return -1;
}

static bool is_suspicion(const struct metric *metric)
{
    const size_t length = strlen(metric->path), tail = strlen("suspicion");
    return length >= tail && strcmp(metric->path + length - tail, "suspicion") == 0;
}

static enum metric_verdict judge_word(const struct metric *old, const struct metric *new,
                                      double *amount, bool *fault)
{
    const bool suspicion = is_suspicion(new);
    const int before = rank(old->word, suspicion), after = rank(new->word, suspicion);
    if (strcmp(old->word, new->word) == 0) return VERDICT_SAME;
    if (before < 0 || after < 0) return VERDICT_INCOMPARABLE;
    if (after <= before) return after < before ? VERDICT_BETTER : VERDICT_SAME;
    *amount = (double)INFINITY;
    /* a passed test that is no longer judged is lost */
    *fault =
        after >= FAULT || (strcmp(old->word, "pass") == 0 &&
                           (!strcmp(new->word, "none") || !strcmp(new->word, "skip") ||
                            !strcmp(new->word, "smoke") || !strcmp(new->word, "undetermined")));
    return VERDICT_WORSE;
}

/* a: before, b: after; less is better. */
static enum metric_verdict judge_less(double a, double b, double noise, double floor,
                                      double *amount)
{
    if (a <= floor && b <= floor) return VERDICT_SAME;
    const double base = fmax(a, floor);
    const double change = (b - base) / base; /* infinite if the old value was 0 */
    if (fabs(b - a) <= noise * base) return VERDICT_SAME;
    if (change < 0) return VERDICT_BETTER;
    *amount = change;
    return VERDICT_WORSE;
}

static enum metric_verdict judge_number(const struct metric *old, const struct metric *new,
                                        double *amount, bool *fault)
{
    const double a = old->value, b = new->value, noise = fmax(old->noise, new->noise);
    const double floor = fmax(old->floor, new->floor);
    switch (new->kind) {
    case METRIC_ERROR:
        *fault = true;
        return judge_less(a, b, noise, floor, amount);
    case METRIC_CHECK:
        return judge_less(a, b, check_factor - 1, floor, amount) == VERDICT_WORSE ? VERDICT_WORSE
               : b * check_factor < a && a > floor                                ? VERDICT_BETTER
                                                                                  : VERDICT_SAME;
    case METRIC_EXACT:
        return judge_less(fabs(a - old->exact), fabs(b - new->exact), noise,
                          floor * (1 + fabs(new->exact)), amount);
    case METRIC_COUNT:
    case METRIC_PART:
        return judge_less(a, b, noise, floor, amount);
    case METRIC_TIMING:
        if (fabs(b - a) < timing_least || (b < noise * a && a < noise * b)) return VERDICT_SAME;
        if (b < a) return VERDICT_BETTER;
        *amount = b / a;
        return VERDICT_WORSE;
    case METRIC_ORDER:
        if (fabs(b - a) <= hypot(old->noise, new->noise)) return VERDICT_SAME;
        if (b > a) return VERDICT_BETTER;
        *amount = a - b;
        *fault = true;
        return VERDICT_WORSE;
    default:
        return fabs(b - a) <= fmax(floor, noise * fabs(a)) ? VERDICT_SAME : VERDICT_INCOMPARABLE;
    }
}

enum metric_verdict metric_judge(const struct metric *old, const struct metric *new, double *amount,
                                 bool *fault)
{
    *amount = 0;
    *fault = false;
    if (!old) return VERDICT_NEW;
    if (!new) return VERDICT_VANISHED;
    if (!old->word != !new->word) return VERDICT_INCOMPARABLE;
    if (new->word) return judge_word(old, new, amount, fault);
    const double a = old->value, b = new->value;
    if (a == b || (isnan(a) && isnan(b))) return VERDICT_SAME;
    if (isfinite(a) && isfinite(b)) return judge_number(old, new, amount, fault);
    if (new->kind == METRIC_NEUTRAL) return VERDICT_INCOMPARABLE;
    if (isfinite(b)) return VERDICT_BETTER;
    *amount = (double)INFINITY;
    *fault = new->kind == METRIC_ERROR;
    return VERDICT_WORSE;
}

bool metric_worse(const struct metric *a, const struct metric *b)
{
    if (!a->word != !b->word) return a->word != NULL;
    if (a->word) return rank(a->word, is_suspicion(a)) > rank(b->word, is_suspicion(b));
    if (isnan(a->value) || isnan(b->value)) return isnan(a->value) && !isnan(b->value);
    switch (a->kind) {
    case METRIC_NEUTRAL:
        return false;
    case METRIC_ORDER:
        return a->value < b->value;
    case METRIC_EXACT:
        return fabs(a->value - a->exact) > fabs(b->value - b->exact);
    default:
        return a->value > b->value;
    }
}
