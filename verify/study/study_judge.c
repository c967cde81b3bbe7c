/* SPDX-License-Identifier: GPL-3.0-or-later
 * Orders, extrapolated values, gates and suspicions of a study whose runs are done. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gates.h"
#include "measure.h"
#include "problem_list.h"
#include "study.h"

/* The lattice sums explain a lost order up to a relative error of this many floors. */
static const double floor_reach = 20;

static enum status fit_orders(const struct study *study, struct study_result *result,
                              struct error *error)
{
    double spacing[CASE_LADDER_MAX], errors[CASE_LADDER_MAX], variance[CASE_LADDER_MAX];
    const struct order_noise noise = {variance, study->replicates};
    const size_t n = result->level_count;
    for (size_t l = 0; l < n; l++) spacing[l] = result->levels[l].spacing;
    for (int f = 0; f < FIELDS; f++)
        for (int m = 0; m < NORMS; m++) {
            for (size_t l = 0; l < n; l++) {
                const double spread = result->levels[l].spread[f][m];
                errors[l] = result->levels[l].errors[f][m];
                variance[l] = spread * spread / (double)study->replicates;
            }
            /* a single run has variance 0, which is not a noise estimate */
            if (order_fit(n, spacing, errors, &noise, &result->orders[f][m].fit, error))
                return error->status;
        }
    const struct regions *regions = problem_of(&result->settings)->regions;
    for (size_t r = 0; regions && regions->names[r]; r++) {
        bool everywhere = true;
        for (size_t l = 0; l < n; l++) {
            errors[l] = result->levels[l].budget.l1[r][FIELD_DENSITY];
            everywhere = everywhere && errors[l] > 0;
        }
        if (everywhere && order_fit(n, spacing, errors, NULL, &result->regions[r], error))
            return error->status;
    }
    return STATUS_OK;
}

/* Orders that exist only in 2D and 3D: of velocity components and of functionals with an exact
 * value. (In 1D the error of a mean changes sign and has no order.) */
static enum status fit_cloud_orders(struct study_result *result, struct error *error)
{
    double spacing[CASE_LADDER_MAX], errors[CASE_LADDER_MAX];
    const size_t n = result->level_count;
    for (size_t l = 0; l < n; l++) spacing[l] = result->levels[l].spacing;
    for (int part = 0; part < STUDY_PARTS; part++) {
        for (size_t l = 0; l < n; l++) errors[l] = result->levels[l].parts[part][NORM_L1];
        if (isfinite(errors[0]) && order_fit(n, spacing, errors, NULL, &result->parts[part], error))
            return error->status;
    }
    for (size_t i = 0; i < result->functional_count; i++) {
        const double exact = result->functional_exact[i];
        for (size_t l = 0; l < n; l++) errors[l] = fabs(result->levels[l].functionals[i] - exact);
        if (isfinite(exact) &&
            order_fit(n, spacing, errors, NULL, &result->functional_errors[i].fit, error))
            return error->status;
    }
    return STATUS_OK;
}

/* Conserved quantities have an error and no order. */
static void take_kept(struct study_result *result)
{
    const struct study_level *finest = &result->levels[result->level_count - 1];
    for (size_t k = 0; k < TRACE_FIGURES; k++) {
        struct order_fit *fit = &result->kept[k].fit;
        fit->order = fit->low = fit->high = (double)NAN;
        fit->n = result->level_count;
        for (size_t l = 0; l + 1 < fit->n; l++) fit->pairwise[l] = (double)NAN;
        fit->finest = finest->kept[k];
    }
}

static void extrapolate(struct study_result *result)
{
    const struct study_level *last = &result->levels[result->level_count - 3];
    const double spacing[3] = {last[0].spacing, last[1].spacing, last[2].spacing};
    for (size_t i = 0; i < result->functional_count; i++) {
        const double values[3] = {last[0].functionals[i], last[1].functionals[i],
                                  last[2].functionals[i]};
        result->functionals[i] = order_extrapolate(spacing, values, result->functional_exact[i]);
    }
}

/* The index of a gate's functional; for a field's gate the number of functionals. */
static size_t functional_of(const struct study_result *result, const struct case_gate *gate)
{
    size_t i = gate->functional ? 0 : result->functional_count;
    while (i < result->functional_count &&
           strcmp(result->functional_names[i], gate->functional) != 0)
        i++;
    return i;
}

/* The order that a gate judges; NULL: a functional without an exact value for these settings. */
static struct study_order *gated(struct study_result *result, const struct case_gate *gate)
{
    const size_t i = functional_of(result, gate),
                 kept = gate->functional ? trace_figure(gate->functional) : TRACE_FIGURES;
    if (!gate->functional) return &result->orders[gate->field][gate->norm];
    if (kept < TRACE_FIGURES) return &result->kept[kept];
    return i < result->functional_count && result->functional_errors[i].fit.n
               ? &result->functional_errors[i]
               : NULL;
}

/* The exact value of a gate's functional; NaN for a field. */
static double exact_of(const struct study_result *result, const struct case_gate *gate)
{
    const size_t i = functional_of(result, gate);
    return i < result->functional_count ? result->functional_exact[i] : (double)NAN;
}

/* True if the case is unchanged and on its own ladder. */
static bool is_untouched(const struct study *study, const struct study_result *result)
{
    const struct case_file *file = &study->settings.file;
    for (int i = 0; i < SETTINGS; i++)
        if (i != SETTING_n && result->settings.value[i].source == SOURCE_USER) return false;
    return file->ladder_count &&
           study->ladder[study->level_count - 1] == file->ladder[file->ladder_count - 1];
}

static bool passes(const struct case_gate *gate, struct study_order *order)
{
    const bool small = order->fit.finest < order->least;
    if (isfinite(gate->gate.high)) {
        if (!order_passes(&order->fit, &order->gate, order->why)) return false;
    } else {
        order->gate.low = -(double)INFINITY;
    }
    if (order->fit.finest <= order->gate.bound && !small) return true;
    snprintf(order->why, sizeof order->why, "finest error %.3g %s %.3g", order->fit.finest,
             small ? "is strangely below" : "exceeds", small ? order->least : order->gate.bound);
    return false;
}

/* True if the failure of a gate is a known weakness of the case, and the error is within it. A
 * failed measurement is not. */
static bool is_known(const struct case_file *file, const struct case_gate *gate, size_t n,
                     struct study_order *order)
{
    const double raise = gates_raise(file, gate, n), bound = gate->known.bound * raise;
    if (!*gate->known.why) return false;
    if (isfinite(gate->gate.high) && isnan(order->fit.order)) return false;
    if (gates_know(&gate->known, raise, order->fit.finest)) return true;
    if (isfinite(bound))
        snprintf(order->why, sizeof order->why,
                 "finest error %.3g exceeds %.3g, up to which it is known", order->fit.finest,
                 bound);
    return false;
}

static void judge_gates(const struct study *study, struct study_result *result)
{
    const struct case_file *file = &study->settings.file;
    const bool of_ours = !study->settings.external; /* our own runs have a known kernel */
    const struct study_level *finest = &result->levels[result->level_count - 1];
    const bool standard = result->scheme.gradient == GRADIENT_STANDARD;
    measure_lattice(&result->scheme.kernel, file->dimension, result->scheme.eta,
                    &result->floor_density, &result->floor_gradient);
    const double floor =
        fmax(fabs(result->floor_density), standard ? fabs(result->floor_gradient) : 0);
    for (size_t i = 0; i < file->gate_count; i++) {
        const struct case_gate *gate = &file->gates[i];
        struct study_order *order = gated(result, gate);
        if (!order) continue;
        const struct order_gate at = order->gate = gates_at(file, gate, finest->n);
        order->least = is_untouched(study, result) ? gate->least : 0;
        order->status =
            passes(gate, order)
                ? gates_weigh(file, &at, finest->n, exact_of(result, gate), &order->fit, order->why)
                : FINDING_FAIL;
        order->known = gate->known.why;
        if (order->status == FINDING_FAIL && is_known(file, gate, finest->n, order))
            order->status = FINDING_KNOWN;
        if (order->status != FINDING_FAIL) continue;
        result->status = STATUS_CHECK_FAILED;
        result->floor_explains |= of_ours && isfinite(gate->gate.high) &&
                                  !(order->fit.order >= order->gate.low) &&
                                  finest->errors[gate->field][gate->norm] <= floor_reach * floor;
    }
}

/* Judges gas that no wave has reached; initial noise does not count. The bound holds for our
 * schemes; for other codes the value is only reported. */
static void judge_stillness(struct study_result *result, bool ours)
{
    result->still = (double)NAN;
    for (size_t l = 0; l < result->level_count; l++)
        if (result->levels[l].budget.regions)
            result->still = fmax(result->still, result->levels[l].budget.still);
    if (isnan(result->still) || !ours || settings_random_start(&result->settings)) return;
    result->still_status = result->still <= STUDY_STILL_BOUND ? FINDING_PASS : FINDING_FAIL;
    if (result->still_status == FINDING_FAIL) result->status = STATUS_CHECK_FAILED;
}

static void suspect(struct study_result *result, const struct case_file *file)
{
    double errors[CASE_LADDER_MAX];
    char why[SUSPICION_TEXT];
    for (int field = 0; field < FIELDS && !result->suspicion[0]; field++) {
        if (file->exact[field] || !problem_knows(problem_of(&result->settings), (enum field)field))
            continue;
        for (size_t i = 0; i < result->level_count; i++)
            errors[i] = result->levels[i].errors[field][NORM_L1];
        if (suspicion_zero(result->level_count, errors, why) ||
            suspicion_repeated(result->level_count, errors, why))
            snprintf(result->suspicion, sizeof result->suspicion, "%s: %.160s",
                     field_family.members[field]->name, why);
    }
    if (result->suspicion[0]) result->status = STATUS_CHECK_FAILED;
}

/* ---- settings without effect ---- */

/* True if the solver reads this key with these settings. `skip` must not change results. */
static bool is_read(enum setting key, const struct settings *settings)
{
    switch (key) {
    case SETTING_skip:
        return false;
    case SETTING_h_tolerance:
        return settings_choice(settings, SETTING_h_method) == H_NEWTON;
    default:
        return settings_uses(settings, key);
    }
}

bool study_suspect_same(const char *what, const struct study_result *a,
                        const struct study_result *b, char *why)
{
    double before[CASE_LADDER_MAX * FIELDS], after[CASE_LADDER_MAX * FIELDS];
    size_t n = 0;
    for (size_t l = 0; l < a->level_count && l < b->level_count; l++)
        for (int f = 0; f < FIELDS; f++) {
            before[n] = a->levels[l].errors[f][NORM_L1];
            after[n] = b->levels[l].errors[f][NORM_L1];
            n += !isnan(before[n]) || !isnan(after[n]); /* both: the field is not known */
        }
    return suspicion_idle_setting(what, n, before, after, why);
}

/* Compares each pair of combinations that differ in one key. The key is suspicious if none of its
 * pairs differs in the results. */
static void suspect_idle(struct study *study)
{
    size_t stride = study->sweep.count;
    for (size_t k = 0; k < study->sweep.key_count; k++) {
        const struct sweep_key *key = &study->sweep.keys[k];
        char why[SUSPICION_TEXT] = "";
        size_t pairs = 0, same = 0;
        stride /= key->count;
        for (size_t c = 0; c < study->sweep.count; c++) {
            const struct study_result *a = &study->results[c], *b = a + stride;
            if ((c / stride) % key->count == key->count - 1) continue;
            if (a->excluded || b->excluded || !is_read(key->key, &a->settings) ||
                !is_read(key->key, &b->settings))
                continue;
            pairs++;
            same += study_suspect_same(setting_keys[key->key].name, a, b, why);
        }
        if (!pairs || same < pairs) continue;
        memcpy(study->suspicion, why, sizeof study->suspicion);
        study->status = STATUS_CHECK_FAILED;
    }
}

enum status study_judge(struct study *study, const struct pool *pool, struct error *error)
{
    for (size_t c = 0; c < study->sweep.count; c++) {
        struct study_result *result = &study->results[c];
        if (result->excluded) continue;
        if (study_read_levels(study, c, pool, error)) return error->status;
        if (result->status == STATUS_OK) {
            if (fit_orders(study, result, error) ||
                (study->settings.file.dimension > 1 && fit_cloud_orders(result, error)))
                return error->status;
            extrapolate(result);
            take_kept(result);
            judge_gates(study, result);
            judge_stillness(result, !study->settings.external);
            suspect(result, &study->settings.file);
        }
        if (result->status > study->status) study->status = result->status;
    }
    suspect_idle(study);
    return STATUS_OK;
}
