/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stress_part.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "result.h"

json_t *stress_outcome(double predicted, double measured, const char *outcome, const char *reason)
{
    return result_object("predicted=%g? measured=%g? outcome=%s reason=%s", predicted, measured,
                         outcome, reason);
}

const char *stress_outcome_breakdown(const char *message)
{
    static const char *const kinds[][2] = {{"internal energy", "negative energy"},
                                           {"smoothing length", "h without root"},
                                           {"time step", "time step collapse"},
                                           {"pair interactions", "too much work"},
                                           {"position", "NaN"},
                                           {"crashed", "crash"}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strstr(message, kinds[i][0])) return kinds[i][1];
    return "broke down";
}

static bool watch_steps(void *context, double time, uint64_t steps)
{
    struct stress_watch *watch = context;
    watch->last_step = (time - watch->last_time) / 32;
    if (watch->first_step <= 0) watch->first_step = watch->last_step;
    watch->last_time = time;
    watch->out_of_steps = steps >= watch->budget;
    return !watch->out_of_steps;
}

static bool all_finite(const struct snapshot *s, int dim)
{
    for (size_t i = 0; i < s->n; i++) {
        double sum = s->rho[i] + s->u[i] + s->P[i] + s->h[i] + s->volume[i];
        for (int d = 0; d < dim; d++) sum += s->x[d][i] + s->v[d][i];
        if (!isfinite(sum)) return false;
    }
    return true;
}

json_t *stress_unsound(const struct run_result *result, const struct stress_watch *watch,
                       double measured)
{
    char reason[768] = "";
    if (result->status == STATUS_BROKE_DOWN) {
        snprintf(reason, sizeof reason, "%s: %s", stress_outcome_breakdown(result->message),
                 result->message);
        return stress_outcome((double)NAN, (double)NAN, "broke_down", reason);
    }
    if (!all_finite(&result->snapshot, result->problem.domain.dim))
        return stress_outcome((double)NAN, (double)NAN, "broke_down",
                              "silent NaN: the run did not notice");
    if (!watch->out_of_steps) return NULL;
    const bool collapse = watch->last_step < 1e-3 * watch->first_step;
    snprintf(reason, sizeof reason, "%s: t = %.4g of %.4g after %llu steps, dt %.2g, first %.2g",
             collapse ? "time step collapse" : "budget", result->time,
             settings_real(&result->settings, SETTING_t_end),
             (unsigned long long)result->cost.steps, watch->last_step, watch->first_step);
    return stress_outcome((double)NAN, measured, collapse ? "broke_down" : "inaccurate", reason);
}

int stress_conserved(const struct run_result *result, char reason[STRESS_REASON], int used)
{
    const double momentum_bound = 1e-9, energy_bound = 0.05;
    if (!(result->drift.energy <= energy_bound))
        used += snprintf(reason + used, STRESS_REASON - (size_t)used, "energy error %.2g; ",
                         result->drift.energy);
    if (!(result->drift.momentum <= momentum_bound))
        used += snprintf(reason + used, STRESS_REASON - (size_t)used, "momentum error %.2g; ",
                         result->drift.momentum);
    return used;
}

/* Mean of the exact density over the window. */
static double mean_density(const struct run_result *result)
{
    enum { POINTS = 200 };
    const struct window *window = &result->problem.window;
    double sum = 0;
    for (int i = 0; i < POINTS; i++) {
        struct problem_state state;
        const double x = window->lo[0] + (i + 0.5) / POINTS * (window->hi[0] - window->lo[0]);
        problem_sample(&result->problem, (double[3]){x}, result->time, &state);
        sum += state.rho / POINTS;
    }
    return sum;
}

static json_t *judge_run(const struct stress_cell *cell, const struct run_result *result,
                         const struct stress_watch *watch)
{
    char reason[STRESS_REASON] = "";
    const bool drift = cell->group->kind == STRESS_DRIFT;
    const double error = result->errors[FIELD_DENSITY].l1 / mean_density(result);
    const double measured = drift ? result->drift.energy : error;
    const size_t crossed = result->crossed;
    json_t *unsound = stress_unsound(result, watch, measured);
    if (unsound) return unsound;
    int used = 0;
    if (!(measured <= cell->group->bound))
        used += snprintf(reason + used, sizeof reason - (size_t)used, "%s %.2g above %.2g; ",
                         drift ? "energy error" : "density error", measured, cell->group->bound);
    /* in gas that comes to rest the scale of momentum vanishes */
    if (!drift) used = stress_conserved(result, reason, used);
    const bool good = used == 0;
    if (crossed)
        used += snprintf(reason + used, sizeof reason - (size_t)used,
                         "%zu neighbours are no longer next to each other; ", crossed);
    if (drift)
        used += snprintf(reason + used, sizeof reason - (size_t)used,
                         "momentum error %.2g, largest speed %.2g; ", result->drift.momentum,
                         result->errors[FIELD_VELOCITY].linf);
    if (used) reason[used - 2] = '\0';
    return stress_outcome((double)NAN, measured, good ? "ok" : "inaccurate", reason);
}

enum status stress_execute(const struct stress_cell *cell, stress_judge_run *judge,
                           json_t **document, struct error *error)
{
    struct run run;
    struct run_result result;
    struct stress_watch watch = {.budget = cell->step_budget};
    enum status status = run_resolve(&run, &cell->settings, error);
    run.asked.progress = watch_steps;
    run.asked.progress_context = &watch;
    if (!status) status = run_execute(&run, &result, error);
    if (status == STATUS_OK || status == STATUS_BROKE_DOWN) {
        *document = judge(cell, &result, &watch);
        run_free(&result);
        return STATUS_OK;
    }
    if (status != STATUS_BAD_INPUT) return status;
    *document = stress_outcome((double)NAN, (double)NAN, "refused", error->message);
    return STATUS_OK;
}

enum status stress_run(const struct stress_cell *cell, json_t **document, struct error *error)
{
    return stress_execute(cell, judge_run, document, error);
}
