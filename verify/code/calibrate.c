/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "code_check.h"
#include "problem_list.h"

const char *const calibrate_sights[] = {"sees", "blind", "free"};

/* Another compiler or processor may change an error by this fraction. */
static const double least_floor = 1e-4;
/* Round-off of sums over particles and steps. */
static const double round_off = 1e-14;
/* A fault is seen if it exceeds the floor by this factor; the bound lies at the geometric mean. */
static const double apart = 9;
/* Width of a gate over its floor if the file has no faults. */
static const double free_width = 10;

/* ---- runs ---- */

/* Settings of run v; v = 0 is the run of a report. */
static enum status vary(struct run_settings *settings, struct code_external *external, size_t v,
                        struct error *error)
{
    enum { SEEDS_APART = 1000 }; /* replicates use the seeds in between */
    char seed[32];
    if (v == 0) return STATUS_OK;
    external->variation = v;
    settings->threads = 1 << (v % 3);
    snprintf(seed, sizeof seed, "%.0f",
             settings_real(&settings->settings, SETTING_seed) + SEEDS_APART * (double)v);
    return settings_set(&settings->settings, SETTING_seed, seed, SOURCE_USER, NULL, error);
}

static enum status plan_study(const struct calibrate *calibrate, struct calibrate_case *one,
                              size_t s, struct pool *pool, struct error *error)
{
    struct study *study = &one->studies[s];
    struct code_external *external = &one->externals[s];
    const struct case_file *file = &one->of->file;
    if (code_prepare(calibrate->code, file->asked, NULL, 0, NULL, external, &study->settings,
                     error) ||
        sweep_parse(&study->sweep, NULL, error))
        return error->status;
    if (s >= calibrate->runs) {
        external->of = &one->faulty[s - calibrate->runs];
        if (code_check_program(calibrate->code, &external->of->way, error)) return error->status;
    } else if (vary(&study->settings, external, s, error)) {
        return error->status;
    }
    memcpy(study->ladder, file->ladder, sizeof study->ladder);
    study->level_count = file->ladder_count;
    study->replicates = study_replicates(&study->settings);
    return study_plan(study, pool, error);
}

static enum status plan_case(const struct calibrate *calibrate, struct calibrate_case *one,
                             struct pool *pool, struct error *error)
{
    const struct code *code = calibrate->code;
    const size_t studies = calibrate->runs + code->fault_count;
    if (one->of->file.ladder_count < ORDER_LEVELS_MIN)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: [case %.60s] has no ladder; allowed: n = N1 N2 N3 N4 ...",
                         code->path, one->of->file.asked);
    one->faulty = calloc(code->fault_count, sizeof *one->faulty);
    one->externals = calloc(studies, sizeof *one->externals);
    one->studies = calloc(studies, sizeof *one->studies);
    if (!one->faulty || !one->externals || !one->studies)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu studies", studies);
    for (size_t f = 0; f < code->fault_count; f++)
        code_with_fault(one->of, &code->faults[f], &one->faulty[f]);
    for (size_t s = 0; s < studies; s++)
        if (plan_study(calibrate, one, s, pool, error)) return error->status;
    return STATUS_OK;
}

enum status calibrate_plan(struct calibrate *calibrate, const struct code *code, size_t runs,
                           size_t count, char *const *names, struct pool *pool, struct error *error)
{
    *calibrate = (struct calibrate){.code = code, .runs = runs};
    calibrate->cases = calloc(count ? count : code->case_count, sizeof *calibrate->cases);
    if (!calibrate->cases) return error_set(error, STATUS_ENVIRONMENT, "no memory for cases");
    for (size_t c = 0; c < (count ? count : code->case_count); c++) {
        struct calibrate_case *one = &calibrate->cases[calibrate->count++];
        one->of = count ? code_case_of(code, names[c], error) : &code->cases[c];
        if (!one->of) return error->status;
        for (size_t k = 0; k < c; k++)
            if (calibrate->cases[k].of == one->of)
                return error_set(error, STATUS_BAD_INPUT, "calibrate: %.60s is given twice",
                                 names[c]);
    }
    for (size_t c = 0; c < calibrate->count; c++)
        if (plan_case(calibrate, &calibrate->cases[c], pool, error)) return error->status;
    return STATUS_OK;
}

void calibrate_free(struct calibrate *calibrate)
{
    for (size_t c = 0; calibrate->cases && c < calibrate->count; c++) {
        struct calibrate_case *one = &calibrate->cases[c];
        for (size_t s = 0; one->studies && s < calibrate->runs + calibrate->code->fault_count; s++)
            study_free(&one->studies[s]);
        free(one->faulty);
        free(one->externals);
        free(one->studies);
    }
    free(calibrate->cases);
    calibrate->cases = NULL;
}

/* ---- gates ---- */

/* The kind of quantity that a gate bounds. */
enum kind { OF_FIELD, OF_FUNCTIONAL, OF_KEPT };

static const struct study_order *order_of(const struct study_result *result, enum kind kind,
                                          size_t i)
{
    return kind == OF_FIELD        ? &result->orders[i][NORM_L1]
           : kind == OF_FUNCTIONAL ? &result->functional_errors[i]
                                   : &result->kept[i];
}

static bool broke(const struct study *study)
{
    return study->results[0].status == STATUS_BROKE_DOWN;
}

/* Measures the floor from the runs, and the change by each fault. */
static void measure(const struct calibrate *calibrate, const struct calibrate_case *one,
                    enum kind kind, size_t i, struct calibrate_gate *gate)
{
    const bool sized = kind == OF_KEPT;
    gate->value = order_of(&one->studies[0].results[0], kind, i)->fit.finest;
    for (size_t s = 0; s < calibrate->runs; s++) {
        const double value = order_of(&one->studies[s].results[0], kind, i)->fit.finest;
        gate->spread = fmax(gate->spread, sized ? value : fabs(value - gate->value));
    }
    gate->floor = fmax(gate->spread, sized ? round_off : least_floor * gate->value);
    for (size_t f = 0; f < calibrate->code->fault_count; f++) {
        const struct study *study = &one->studies[calibrate->runs + f];
        if (broke(study)) continue;
        const double value = order_of(&study->results[0], kind, i)->fit.finest;
        gate->change[f] = sized ? value : fabs(value - gate->value);
        if (!isfinite(gate->change[f])) gate->change[f] = (double)INFINITY;
    }
}

/* Sets the bounds from the floor and the smallest change by a fault that is well above it. */
static void find_bounds(const struct calibrate *calibrate, enum kind kind,
                        struct calibrate_gate *gate)
{
    double smallest = (double)INFINITY, width = free_width * gate->floor;
    bool any = false;
    gate->sight = calibrate->code->fault_count ? CALIBRATE_BLIND : CALIBRATE_FREE;
    for (size_t f = 0; f < calibrate->code->fault_count; f++) {
        if (!(gate->change[f] >= apart * gate->floor)) continue; /* 0: of a fault that breaks */
        any = true;
        smallest = fmin(smallest, gate->change[f]);
    }
    if (any) {
        gate->sight = CALIBRATE_SEES;
        if (isinf(smallest)) smallest = fmax(gate->value, apart * gate->floor);
        width = sqrt(gate->floor * smallest);
    }
    gate->least = gate->bound = (double)NAN;
    if (gate->sight == CALIBRATE_BLIND) return;
    gate->bound = kind == OF_KEPT ? width : gate->value + width;
    gate->least = kind == OF_KEPT || gate->floor > gate->value / 6
                      ? 0
                      : gate->value - fmin(width, gate->value / 2);
}

/* Keeps the code file's gate on the order if all runs pass it. */
static void keep_order(const struct calibrate *calibrate, const struct calibrate_case *one,
                       enum kind kind, size_t i, struct calibrate_gate *gate)
{
    const struct case_file *file = &one->of->file;
    gate->low = gate->high = (double)NAN;
    for (size_t g = 0; kind == OF_FIELD && g < file->gate_count; g++) {
        const struct case_gate *asked = &file->gates[g];
        if (asked->functional || asked->field != (enum field)i || asked->norm != NORM_L1) continue;
        if (!isfinite(asked->gate.high)) continue;
        const struct order_gate order = {asked->gate.low, asked->gate.high, (double)INFINITY};
        bool all = true;
        for (size_t s = 0; s < calibrate->runs; s++)
            all = all &&
                  order_passes(&order_of(&one->studies[s].results[0], kind, i)->fit, &order, NULL);
        if (all) gate->low = order.low, gate->high = order.high;
        gate->order_lost = !all;
    }
}

static void look(const struct calibrate *calibrate, struct calibrate_case *one, enum kind kind,
                 size_t i, struct calibrate_gate *gate)
{
    const struct order_gate asked = {gate->low, gate->high, gate->bound};
    gate->smallest = -1;
    for (size_t f = 0; f < calibrate->code->fault_count; f++) {
        const struct study *study = &one->studies[calibrate->runs + f];
        if (one->breaks[f] || isnan(gate->bound)) continue;
        const struct order_fit *fit = &order_of(&study->results[0], kind, i)->fit;
        gate->sees[f] = !(fit->finest <= gate->bound && fit->finest >= gate->least) ||
                        (isfinite(asked.low) && !order_passes(fit, &asked, NULL));
        one->seen[f] |= gate->sees[f];
        if (gate->sees[f] && (gate->smallest < 0 || gate->change[f] < gate->change[gate->smallest]))
            gate->smallest = (int)f;
    }
}

static void add_gate(const struct calibrate *calibrate, struct calibrate_case *one, enum kind kind,
                     size_t i, const char *name, const char *norm)
{
    struct calibrate_gate *gate = &one->gates[one->gate_count];
    *gate = (struct calibrate_gate){.smallest = -1};
    snprintf(gate->name, sizeof gate->name, "%s%s", name, norm);
    measure(calibrate, one, kind, i, gate);
    if (!isfinite(gate->value) || !isfinite(gate->floor)) return;
    if (kind != OF_KEPT && !(gate->value > 0)) return; /* an exact value has no scale */
    find_bounds(calibrate, kind, gate);
    keep_order(calibrate, one, kind, i, gate);
    look(calibrate, one, kind, i, gate);
    one->gate_count++;
}

static void find_gates(const struct calibrate *calibrate, struct calibrate_case *one)
{
    const struct study_result *first = &one->studies[0].results[0];
    const struct case_file *file = &one->of->file;
    const bool fields = !problem_of(&first->settings)->fieldless;
    for (size_t f = 0; f < FIELDS && fields; f++)
        if (!file->exact[f])
            add_gate(calibrate, one, OF_FIELD, f, field_family.members[f]->name, "_l1");
    for (size_t i = 0; i < first->functional_count; i++)
        if (first->functional_errors[i].fit.n)
            add_gate(calibrate, one, OF_FUNCTIONAL, i, first->functional_names[i], "");
    for (size_t k = 0; k < TRACE_FIGURES; k++)
        add_gate(calibrate, one, OF_KEPT, k, trace_figures[k], "");
}

static enum status judge_case(const struct calibrate *calibrate, struct calibrate_case *one,
                              const struct pool *pool, struct error *error)
{
    const size_t faults = calibrate->code->fault_count;
    for (size_t s = 0; s < calibrate->runs + faults; s++) {
        struct study *study = &one->studies[s];
        if (study_judge(study, pool, error)) return error->status;
        if (s >= calibrate->runs)
            one->breaks[s - calibrate->runs] = one->seen[s - calibrate->runs] = broke(study);
        else if (broke(study))
            return error_set(error, STATUS_BROKE_DOWN, "%.60s, run %zu: %.400s",
                             one->of->file.asked, s + 1, study->results[0].message);
    }
    find_gates(calibrate, one);
    const char *suspicion = one->studies[0].results[0].suspicion;
    if (*suspicion) snprintf(one->trouble, sizeof one->trouble, "suspicious: %.140s", suspicion);
    return STATUS_OK;
}

enum status calibrate_judge(struct calibrate *calibrate, const struct pool *pool,
                            struct error *error)
{
    bool sound = true;
    for (size_t c = 0; c < calibrate->count; c++) {
        struct calibrate_case *one = &calibrate->cases[c];
        if (judge_case(calibrate, one, pool, error)) return error->status;
        sound = sound && !one->trouble[0];
        for (size_t f = 0; f < calibrate->code->fault_count; f++) sound = sound && one->seen[f];
    }
    return sound ? STATUS_OK : STATUS_CHECK_FAILED;
}
