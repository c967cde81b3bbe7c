/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run_part.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "growth.h"
#include "initial.h"

static enum status finish(struct run_result *result, const struct run_outcome *outcome,
                          struct error *error)
{
    if (outcome->status != STATUS_OK && outcome->status != STATUS_BROKE_DOWN) {
        *error = outcome->reason;
        return error->status;
    }
    result->status = outcome->status;
    snprintf(result->message, sizeof result->message, "%s", outcome->reason.message);
    result->drift = trace_drift(&outcome->start, &outcome->end, &outcome->end);
    return run_keep(result, &outcome->snapshot, error);
}

/* A state without density or smoothing length cannot be measured. */
static enum status broke_down_at_start(struct run_result *result, const struct error *reason)
{
    result->status = STATUS_BROKE_DOWN;
    snprintf(result->message, sizeof result->message, "%s", reason->message);
    const struct trace none = {.count = 0};
    result->drift = trace_worst(&none);
    result->motion = trace_motion(&none);
    run_measure_nothing(result);
    return STATUS_OK;
}

struct watch {
    const struct run *run;
    struct simulation *simulation;
    struct run_result *result;
    struct trace *trace;
    double until; /* end of the current call of simulation_run */
};

/* Sums that a run should conserve; the kinetic energy excludes the boost. Momentum along a
 * direction with walls or gravity is set to 0, and all momentum beside fixed layers, which also
 * drag gas that flows along them. */
static void take_sums(const struct run *run, const struct simulation *simulation,
                      struct conservation *sums)
{
    const struct prepared *p = &run->problem;
    bool layers = false;
    conservation_sums(simulation, sums);
    for (int d = 0; d < p->domain.dim; d++)
        sums->kinetic -= p->boost[d] * (sums->momentum[d] - 0.5 * sums->mass * p->boost[d]);
    for (int d = 0; d < p->domain.dim; d++) layers |= p->boundary[d] == BOUNDARY_FIXED;
    for (int d = 0; d < p->domain.dim; d++)
        if (layers || p->boundary[d] == BOUNDARY_REFLECTING || p->gravity[d] != 0)
            sums->momentum[d] = 0;
}

static void keep_trace(const struct watch *watch, double time)
{
    struct conservation sums;
    take_sums(watch->run, watch->simulation, &sums);
    trace_add(watch->trace, time, &sums);
}

static void keep_look(const struct watch *watch, double time)
{
    struct snapshot seen;
    simulation_snapshot(watch->simulation, &seen);
    const struct regularity regularity = regularity_of(
        &watch->run->problem, &watch->run->scheme.kernel, &seen, watch->run->asked.threads);
    trace_see(watch->run->asked.trace, time, &regularity);
}

static bool after_step(void *context, double time, uint64_t steps)
{
    enum { STEPS_BETWEEN = 32 };
    const struct watch *watch = context;
    const struct run_settings *settings = &watch->run->asked;
    const double t_end = settings_real(&watch->run->settings, SETTING_t_end);
    struct checkpoint *checkpoint = settings->checkpoint;
    if (trace_wants(watch->trace, steps)) keep_trace(watch, time); /* part of a checkpoint */
    /* not after the last step, so that a checkpoint always has a next step */
    if (checkpoint && time < watch->until && checkpoint_due(checkpoint)) {
        checkpoint->snapshot = settings->snapshots ? snapshots_last(settings->snapshots) : -1;
        checkpoint_save(checkpoint, watch->simulation, &watch->result->growth);
    }
    if (settings->trace && trace_looks(settings->trace, time, t_end)) keep_look(watch, time);
    if (settings->progress && (steps % STEPS_BETWEEN == 0 || settings->each_step) &&
        !settings->progress(settings->progress_context, time, steps))
        return false;
    return !(settings->snapshots && time < watch->until &&
             snapshots_keep(settings->snapshots, watch->simulation, time, watch->until));
}

/* Writes an intermediate snapshot. A failure does not end the run. */
static void make_snapshot(const struct watch *watch, size_t number)
{
    struct snapshots *snapshots = watch->run->asked.snapshots;
    struct run_result moment = *watch->result; /* without measurements */
    struct snapshot seen;
    struct error error = {0};
    simulation_snapshot(watch->simulation, &seen);
    if (!run_keep(&moment, &seen, &error))
        run_write_snapshot(&moment, snapshots_path(snapshots, number).text, &error);
    if (!error.status && snapshots->show)
        snapshots->show(snapshots->context, &moment, number, &error);
    if (error.status) snapshots_fail(snapshots, &error);
    run_free(&moment);
}

/* Runs from the saved state to each snapshot that is due, then restores the saved state. */
static void make_due_snapshots(const struct watch *watch)
{
    struct snapshots *snapshots = watch->run->asked.snapshots;
    for (; snapshots->next < snapshots->count; snapshots->next++) {
        const double time = snapshots_time(snapshots, snapshots->next);
        struct error error;
        if (time > snapshots->reach) break;
        snapshots_return(snapshots, watch->simulation);
        if (simulation_run(watch->simulation, time, NULL, NULL, &error))
            snapshots_fail(snapshots, &error);
        else
            make_snapshot(watch, snapshots->next);
    }
    snapshots_return(snapshots, watch->simulation);
    snapshots_go_on(snapshots);
}

static enum status run_until(struct watch *watch, double until, simulation_progress *progress,
                             struct error *error)
{
    struct snapshots *snapshots = watch->run->asked.snapshots;
    struct snapshot seen;
    watch->until = until;
    if (snapshots) {
        simulation_snapshot(watch->simulation, &seen);
        snapshots_keep(snapshots, watch->simulation, seen.time, until);
    }
    for (;;) {
        if (snapshots && snapshots->state) make_due_snapshots(watch);
        const enum status status = simulation_run(watch->simulation, until, progress, watch, error);
        if (!snapshots || !snapshots->state) return status;
    }
}

/* Runs to t_end, stopping at times at which a growing amplitude is measured. */
static enum status steps(struct watch *watch, struct simulation *simulation,
                         struct run_result *result, double t_end, struct error *error)
{
    enum { STOPS = 17 };
    const struct prepared *p = &result->problem;
    const struct growing *growing = p->problem->growing;
    double times[2] = {0, 0};
    if (growing) growing->during(p, times);
    /* a resumed run has already measured some */
    for (int i = (int)result->growth.n; growing && i < STOPS; i++) {
        const double stop = times[0] + (times[1] - times[0]) * i / (STOPS - 1);
        struct snapshot seen;
        if (!(stop < t_end)) break;
        const enum status status = run_until(watch, stop, after_step, error);
        simulation_snapshot(simulation, &seen);
        if (status || seen.time < stop) return status;
        growth_see(&result->growth, stop, growing->amplitude(p, &seen));
    }
    return run_until(watch, t_end, after_step, error);
}

static enum status simulate(const struct run *run, const struct setup *setup,
                            struct initial *initial, struct run_result *result, struct error *error)
{
    const struct run_settings *asked = &run->asked;
    struct simulation *simulation = NULL;
    struct run_outcome outcome = {0};
    enum status status = simulation_take(setup, &simulation, &outcome.reason);
    initial_free(initial); /* the solver has copied it */
    if (!status) status = simulation_begin(simulation, &outcome.reason);
    if (status) simulation_destroy(simulation);
    if (status == STATUS_BROKE_DOWN) return broke_down_at_start(result, &outcome.reason);
    if (status) {
        *error = outcome.reason;
        return status;
    }
    struct trace own = {0};
    struct watch watch = {.run = run,
                          .simulation = simulation,
                          .result = result,
                          .trace = asked->trace ? asked->trace : &own};
    take_sums(run, simulation, &outcome.start);
    keep_trace(&watch, 0);
    if (asked->checkpoint) asked->checkpoint->trace = watch.trace;
    if (asked->checkpoint && asked->checkpoint->resume &&
        checkpoint_load(asked->checkpoint, simulation, &result->growth, error)) {
        asked->checkpoint->trace = NULL;
        simulation_destroy(simulation);
        return error->status;
    }
    if (asked->trace) keep_look(&watch, 0);
    if (asked->snapshots) {
        simulation_snapshot(simulation, &outcome.snapshot);
        snapshots_begin(asked->snapshots, outcome.snapshot.time,
                        asked->checkpoint ? asked->checkpoint->snapshot : -1, setup->t_end);
    }
    outcome.status = steps(&watch, simulation, result, setup->t_end, &outcome.reason);
    simulation_cost(simulation, &result->cost);
    if (!outcome.status) result->matrix = description_sum(simulation);
    simulation_end(simulation); /* the snapshot reuses the memory of the neighbour lists */
    take_sums(run, simulation, &outcome.end);
    simulation_snapshot(simulation, &outcome.snapshot);
    trace_add(watch.trace, outcome.snapshot.time, &outcome.end);
    result->motion = trace_motion(watch.trace);
    if (asked->trace) keep_look(&watch, outcome.snapshot.time);
    if (asked->checkpoint) asked->checkpoint->trace = NULL;
    status = finish(result, &outcome, error);
    simulation_destroy(simulation); /* frees memory for the errors */
    return status ? status : run_measure_errors(result, error);
}

static enum status simulate_otherwise(const struct run *run, const struct setup *setup,
                                      struct run_result *result, struct error *error)
{
    struct run_outcome outcome = {0};
    run->asked.solver(setup, &outcome);
    result->motion = trace_motion(&(struct trace){.count = 0});
    result->cost = outcome.cost;
    const enum status status = finish(result, &outcome, error);
    if (outcome.release) outcome.release(outcome.owned);
    return status ? status : run_measure_errors(result, error);
}

enum status run_simulate(const struct run *run, const struct setup *setup, struct initial *initial,
                         struct run_result *result, struct error *error)
{
    return run->asked.solver ? simulate_otherwise(run, setup, result, error)
                             : simulate(run, setup, initial, result, error);
}
