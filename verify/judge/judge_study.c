/* SPDX-License-Identifier: GPL-3.0-or-later
 * What several snapshots say together: orders, conservation; and gates. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "judge.h"
#include "order.h"
#include "result.h"
#include "text.h"

/* More particles; of as many, later; of one time, whichever comes first. */
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

/* The first and the last of as many particles; of several numbers, the most that have two times. */
bool judge_drift(const struct judged *judged, size_t n, struct trace_drift *drift, size_t pair[2])
{
    const struct judged *start = NULL, *end = NULL;
    for (size_t a = 0; a < n; a++)
        for (size_t b = 0; b < n; b++) {
            const struct judged *first = &judged[a], *last = &judged[b];
            if (first->result.n != last->result.n || !(first->result.time < last->result.time))
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

/* ---- gates ---- */

static bool error_called(const struct judged *judged, const char *name, double *value)
{
    const struct run_result *r = &judged->result;
    const struct norms *of[FIELDS + 2];
    const char *names[FIELDS + 2];
    for (int f = 0; f < FIELDS; f++)
        of[f] = &r->errors[f], names[f] = field_family.members[f]->name;
    of[FIELDS] = &r->azimuthal, names[FIELDS] = "azimuthal";
    of[FIELDS + 1] = &r->radial, names[FIELDS + 1] = "radial";
    for (int f = 0; f < FIELDS + 2; f++) {
        const double values[NORMS] = {of[f]->l1, of[f]->l2, of[f]->linf, of[f]->particle_mean,
                                      of[f]->l1_whole};
        for (int norm = 0; norm < NORMS; norm++) {
            char full[64];
            snprintf(full, sizeof full, "%s_%s", names[f], field_norm_family.members[norm]->name);
            if (strcmp(full, name) != 0) continue;
            *value = values[norm];
            return f < FIELDS || r->problem.problem->circular;
        }
    }
    for (size_t k = 0; k < r->functional_count; k++)
        if (strcmp(r->functionals[k].name, name) == 0 && isfinite(r->functionals[k].exact)) {
            *value = fabs(r->functionals[k].value - r->functionals[k].exact);
            return true;
        }
    return false;
}

static enum status no_such_error(const struct judged *judged, const char *name, struct error *error)
{
    const struct run_result *r = &judged->result;
    char values[200] = "";
    for (size_t k = 0, used = 0; k < r->functional_count && used < sizeof values; k++)
        if (isfinite(r->functionals[k].exact))
            used += (size_t)snprintf(values + used, sizeof values - used, "%s%s",
                                     used ? " " : ", or one of ", r->functionals[k].name);
    return error_set(error, STATUS_BAD_INPUT,
                     "--gate %.48s: no such error; FIELD: density velocity pressure "
                     "internal_energy%s, NORM: l1 l2 linf particle_mean l1_whole%s",
                     name, r->problem.problem->circular ? " azimuthal radial" : "", values);
}

enum status judge_gates(const char *text, const struct judged *judged, struct judge_gate *gates,
                        size_t *count, struct error *error)
{
    *count = 0;
    for (const char *at = text; at && *at;) {
        const size_t length = strcspn(at, ","), name = strcspn(at, "=");
        char bound[40];
        if (*count == JUDGE_GATES_MAX)
            return error_set(error, STATUS_BAD_INPUT, "--gate: allowed: at most %d",
                             JUDGE_GATES_MAX);
        struct judge_gate *gate = &gates[(*count)++];
        *gate = (struct judge_gate){0};
        if (name >= length || name >= sizeof gate->name || length - name - 1 >= sizeof bound)
            return error_set(error, STATUS_BAD_INPUT,
                             "--gate %.80s: allowed: FIELD_NORM=BOUND,..., such as density_l1=2e-3",
                             text);
        memcpy(gate->name, at, name);
        memcpy(bound, at + name + 1, length - name - 1);
        bound[length - name - 1] = '\0';
        if (!text_real(bound, &gate->bound) || !(gate->bound > 0))
            return error_set(error, STATUS_BAD_INPUT, "--gate %.48s=%.40s: allowed: above 0",
                             gate->name, bound);
        if (!error_called(judged, gate->name, &gate->value))
            return no_such_error(judged, gate->name, error);
        gate->good = gate->value <= gate->bound;
        at += length + (at[length] == ',');
    }
    return STATUS_OK;
}

/* ---- orders ---- */

/* Fewest first; of as many, the last one. */
static int by_number(const void *a, const void *b)
{
    const struct judged *one = *(const struct judged *const *)a,
                        *other = *(const struct judged *const *)b;
    if (one->result.n != other->result.n) return one->result.n > other->result.n ? 1 : -1;
    return better(one, other) ? -1 : better(other, one) ? 1 : (one > other) - (one < other);
}

/* The last one of each number of particles, fewest first. */
static size_t levels_of(const struct judged *judged, size_t n, const struct judged **levels)
{
    size_t count = 0;
    for (size_t i = 0; i < n; i++) levels[i] = &judged[i];
    qsort(levels, n, sizeof *levels, by_number);
    for (size_t i = 0; i < n; i++)
        if (!count || levels[count - 1]->result.n != levels[i]->result.n)
            levels[count++] = levels[i];
    return count;
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
    return json_pack("{s:s, s:s, s:o, s:o, s:o, s:o, s:s}", "field", field, "norm", "l1", "order",
                     fitted ? result_number(fit.order) : json_null(), "low",
                     fitted ? result_number(fit.low) : json_null(), "high",
                     fitted ? result_number(fit.high) : json_null(), "pairwise", pairwise, "class",
                     fitted ? order_class_name(fit.class) : "too few levels");
}

json_t *judge_orders(const struct judged *judged, size_t n)
{
    const struct judged *levels[JUDGE_SNAPSHOTS_MAX];
    double spacing[JUDGE_SNAPSHOTS_MAX], value[JUDGE_SNAPSHOTS_MAX];
    json_t *orders = json_array();
    const size_t count = levels_of(judged, n, levels);
    if (count < 2 || levels[0]->result.problem.problem->fieldless) return orders;
    for (int field = 0; field < FIELDS; field++) {
        for (size_t i = 0; i < count; i++) {
            spacing[i] = pow((double)levels[i]->result.n, -1. / levels[i]->file.dim);
            value[i] = levels[i]->result.errors[field].l1;
        }
        json_array_append_new(orders,
                              order_json(field_family.members[field]->name, count, spacing, value));
    }
    return orders;
}
