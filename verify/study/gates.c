/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gates.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "result.h"
#include "trace.h"
#include "value.h"

static const double compared_bound = 3;
/* Round-off of sums over particles and steps is about 1e-14. */
static const double conserved_bound = 1e-12;
/* A bound above this fraction of the exact value would pass a wrong solution. */
static const double coarse_part = 0.25;

double gates_raise(const struct case_file *file, const struct case_gate *gate, size_t n)
{
    return gates_at(file, gate, n).bound / gate->gate.bound;
}

struct order_gate gates_at(const struct case_file *file, const struct case_gate *gate, size_t n)
{
    struct order_gate at = gate->gate;
    if (!file->ladder_count) return at;
    const size_t finest = file->ladder[file->ladder_count - 1];
    if (n > finest && gate->finer.bound > 0) return gate->finer;
    const double coarser = (double)finest / (double)n;
    at.bound *= pow(fmax(1, coarser), at.low / file->dimension);
    return at;
}

bool gates_know(const struct case_weakness *known, double raise, double error)
{
    if (!*known->why) return false;
    return isnan(known->bound) ? isnan(error) : error <= known->bound * raise;
}

enum finding_status gates_weigh(const struct case_file *file, const struct order_gate *gate,
                                size_t n, double exact, const struct order_fit *fit, char *why)
{
    const double asked = gate->low;
    const bool ordered = isfinite(gate->high);
    why[0] = '\0';
    if (file->ladder_count && n <= file->ladder[0] && (ordered || asked > 0)) {
        snprintf(why, GATE_WHY, "too coarse to say: n = %zu, and the case's ladder begins at %zu",
                 n, file->ladder[0]);
        return FINDING_SMOKE;
    }
    if (fabs(exact) > 0 && gate->bound > coarse_part * fabs(exact)) {
        snprintf(why, GATE_WHY, "too coarse to say: an error of %.2g of the exact value is allowed",
                 gate->bound / fabs(exact));
        return FINDING_SMOKE;
    }
    const double allowed = gate->high - asked;
    if (!fit || !ordered || fit->high - fit->low <= allowed) return FINDING_PASS;
    snprintf(why, GATE_WHY, "the order is known to +-%.2g only, the gate is +-%.2g wide",
             (fit->high - fit->low) / 2, allowed / 2);
    return FINDING_UNDETERMINED;
}

void gates_compare(struct case_file *file)
{
    for (size_t i = 0; i < file->gate_count; i++) {
        struct case_gate *gate = &file->gates[i];
        if (*gate->compared.why) gate->known = gate->compared;
        if (gate->compared.bound > 0 && !*gate->compared.why) {
            gate->gate.bound = gate->compared.bound;
            gate->finer.bound = 0; /* bounds of [compared] hold at every n */
        } else {
            gate->gate.bound *= compared_bound;
            gate->finer.bound *= compared_bound;
        }
    }
}

/* Takes ownership of the name. weighed, why: status and reason of an error that passes. */
static json_t *weighed_json(json_t *name, double value, double bound,
                            const struct case_weakness *known, enum finding_status weighed,
                            const char *why)
{
    const enum finding_status status = value <= bound                ? weighed
                                       : gates_know(known, 1, value) ? FINDING_KNOWN
                                                                     : FINDING_FAIL;
    json_t *gate = result_object("name=%p value=%g bound=%g status=%s", (void *)name, value, bound,
                                 finding_words[status]);
    if (status == FINDING_KNOWN) result_add(gate, "known=%s", known->why);
    if (status == FINDING_SMOKE) result_add(gate, "why=%s", why);
    return gate;
}

/* Reads value, exact value and name (owned by the caller) of a gate; NaN if the run lacks them, or
 * for a field's exact value. NULL: a functional without an exact value. */
static json_t *read_error(const struct case_gate *gate, const json_t *run, double *value,
                          double *exact)
{
    const char *field = field_family.members[gate->field]->name,
               *norm = field_norm_family.members[gate->norm]->name;
    const json_t *functionals = json_object_get(run, "functionals");
    *exact = (double)NAN;
    if (gate->functional && trace_figure(gate->functional) < TRACE_FIGURES) {
        *value = value_member(json_object_get(run, "conservation"), gate->functional);
        return json_string(gate->functional);
    }
    if (gate->functional) {
        const json_t *entry = value_named(functionals, gate->functional);
        *exact = value_member(entry, "reference");
        *value = fabs(value_member(entry, "value") - *exact);
        if (entry && !isfinite(*exact)) return NULL;
        return json_string(gate->functional);
    }
    *value = value_inner(json_object_get(run, "errors"), field, norm);
    return json_sprintf("%s_%s", field, norm);
}

json_t *gates_error(const struct case_file *file, const struct case_gate *gate, const json_t *run)
{
    const size_t n = (size_t)value_member(run, "n");
    const struct order_gate at = gates_at(file, gate, n);
    struct case_weakness known = gate->known;
    double value, exact;
    char why[GATE_WHY];
    json_t *name = read_error(gate, run, &value, &exact);
    known.bound *= gates_raise(file, gate, n);
    const enum finding_status weighed = gates_weigh(file, &at, n, exact, NULL, why);
    return name ? weighed_json(name, value, at.bound, &known, weighed, why) : NULL;
}

void gates_add_errors(const struct case_file *file, const json_t *run, json_t *list)
{
    for (size_t i = 0; i < file->gate_count; i++) {
        json_t *gate = gates_error(file, &file->gates[i], run);
        if (gate) json_array_append_new(list, gate);
    }
}

/* True if a setting, or a member of its list, is this word. */
static bool says(const json_t *run, const char *key, const char *word)
{
    const json_t *value = json_object_get(json_object_get(run, "settings"), key), *entry;
    size_t i;
    if (json_is_string(value)) return strcmp(json_string_value(value), word) == 0;
    json_array_foreach(value, i, entry) {
        if (json_is_string(entry) && strcmp(json_string_value(entry), word) == 0) return true;
    }
    return false;
}

static bool is_heavy(const json_t *run)
{
    const json_t *gravity = json_object_get(json_object_get(run, "settings"), "gravity"), *g;
    size_t i;
    json_array_foreach(gravity, i, g) {
        if (fabs(json_number_value(g)) > 0) return true;
    }
    return false;
}

static void add_conserved(const char *name, const json_t *run, json_t *list)
{
    const struct case_weakness none = {.bound = 0};
    const double value = value_member(json_object_get(run, "conservation"), name);
    json_array_append_new(
        list, weighed_json(json_string(name), value, conserved_bound, &none, FINDING_PASS, ""));
}

void gates_add_conserved(const json_t *run, json_t *list)
{
    const bool walls = says(run, "boundary", "reflecting") || says(run, "boundary", "fixed");
    add_conserved("mass", run, list);
    if (!walls && !is_heavy(run)) add_conserved("momentum", run, list);
    /* fixed layers exchange energy with the gas; the work of gravity is exact in global steps of
     * the default integrator, and in others to their order */
    const bool exact = !is_heavy(run) || (says(run, "integrator", "predicted_midpoint") &&
                                          says(run, "steps", "global"));
    if (says(run, "energy", "total") && exact && !says(run, "boundary", "fixed"))
        add_conserved("energy", run, list);
}
