/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "growth.h"
#include "initial.h"
#include "initial_create.h"
#include "problem_prepare.h"
#include "run_measure.h"
#include "snapshot_writer.h"

enum status run_prepare(struct run_settings *settings, const char *case_name, int n,
                        char *const *arguments, struct error *error)
{
    *settings = (struct run_settings){.threads = 1};
    if (case_load(&settings->file, case_name, error)) return error->status;
    settings->settings = settings->file.settings;
    return settings_apply(&settings->settings, n, arguments, error);
}

/* Of this program: what getrusage says on Linux is also that of the process that started it. */
static double peak_rss(void)
{
    struct rusage usage;
    double kib = 0;
    char line[128];
    FILE *status = fopen("/proc/self/status", "r");
    while (status && kib == 0 && fgets(line, sizeof line, status))
        if (strncmp(line, "VmHWM:", 6) == 0) kib = strtod(line + 6, NULL);
    if (status) fclose(status);
    if (kib > 0) return 1024 * kib;
    getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
    return (double)usage.ru_maxrss;
#else
    return 1024. * (double)usage.ru_maxrss;
#endif
}

enum status run_resolve(struct run *run, const struct run_settings *asked, struct error *error)
{
    const int dim = asked->file.dimension;
    run->asked = *asked;
    run->settings = asked->settings;
    const enum status status = problem_prepare(&run->problem, &run->settings, dim, error);
    return status ? status : settings_scheme(&run->settings, dim, &run->scheme, error);
}

struct setup run_setup(const struct run *run, const struct initial *initial)
{
    const struct prepared *problem = &run->problem;
    const struct domain *domain = &problem->domain;
    return (struct setup){
        .dim = domain->dim,
        .lo = {domain->lo[0], domain->lo[1], domain->lo[2]},
        .hi = {domain->hi[0], domain->hi[1], domain->hi[2]},
        .boundary = {problem->boundary[0], problem->boundary[1], problem->boundary[2]},
        .gravity = {problem->gravity[0], problem->gravity[1], problem->gravity[2]},
        .gamma = problem->gamma,
        .t_end = settings_real(&run->settings, SETTING_t_end),
        .n = initial->n,
        .x = {initial->x[0], initial->x[1], initial->x[2]},
        .v = {initial->v[0], initial->v[1], initial->v[2]},
        .m = initial->m,
        .u = initial->u,
        .rho = initial->rho,
        .scheme = run->scheme,
        .skip = settings_choice(&run->settings, SETTING_skip) == SKIP_AUTO,
        .generic = run->asked.generic,
        .threads = run->asked.threads,
    };
}

/* Nothing is known of matrices. */
static const struct description_sums no_matrix = {(double)NAN, (double)NAN, (double)NAN,
                                                  (double)NAN, 0};

/* How good a glass is that fills a periodic box. */
static enum status measure_start(struct run_result *result, const struct initial *initial,
                                 struct error *error)
{
    const struct prepared *p = &result->problem;
    bool good = settings_choice(&result->settings, SETTING_lattice) == LATTICE_GLASS &&
                !result->settings.file[0];
    for (int d = 0; d < p->domain.dim; d++) good &= p->boundary[d] == BOUNDARY_PERIODIC;
    result->start = (struct relax_quality){(double)NAN, (double)NAN, (double)NAN};
    if (!good) return STATUS_OK;
    const double *const x[3] = {initial->x[0], initial->x[1], initial->x[2]};
    double *volume = malloc(initial->n * sizeof *volume);
    if (!volume) return error_set(error, STATUS_ENVIRONMENT, "no memory for a start");
    for (size_t i = 0; i < initial->n; i++) volume[i] = initial->m[i] / initial->rho[i];
    const enum status status =
        relax_measure(&p->domain, initial->n, x, volume, &result->start, error);
    free(volume);
    return status;
}

static void add_snapshots(const struct run *run, const struct setup *setup,
                          struct estimate *estimate)
{
    const struct snapshots *snapshots = run->asked.snapshots;
    const double n = (double)setup->n;
    if (snapshots)
        estimate->memory +=
            snapshots_memory(setup->dim, n) + n * snapshot_writer_memory(snapshots->path);
}

/* Before there is an array of n numbers; a file's particles are as many as they are. */
static enum status check_size(const struct run *run, struct error *error)
{
    const struct initial none = {.n = (size_t)settings_real(&run->settings, SETTING_n)};
    const struct setup setup = run_setup(run, &none);
    struct estimate estimate = estimate_size(&setup);
    add_snapshots(run, &setup, &estimate);
    return run->settings.file[0] ? STATUS_OK : estimate_check(&estimate, none.n, error);
}

/* Everything before the first step. On an error nothing is left to free. */
static enum status begin(const struct run *run, struct run_result *result, struct initial *initial,
                         struct error *error)
{
    const double t_end = settings_real(&run->settings, SETTING_t_end);
    enum status status;
    *result = (struct run_result){.settings = run->settings,
                                  .scheme = run->scheme,
                                  .problem = run->problem,
                                  .matrix = no_matrix};
    snprintf(result->case_name, sizeof result->case_name, "%s", run->asked.file.asked);
    *initial = (struct initial){0};
    if ((!run->asked.any_window && (status = problem_check_time(&run->problem, t_end, error))) ||
        (status = check_size(run, error)) ||
        (status = initial_create(initial, &run->problem, &run->settings, error)))
        return status;
    const struct setup setup = run_setup(run, initial);
    result->n = initial->n;
    result->estimate = estimate_run(&setup);
    add_snapshots(run, &setup, &result->estimate);
    if (run->settings.file[0]) result->settings.value[SETTING_n].real[0] = (double)initial->n;
    result->plan_count =
        plan_explain(&setup, result->plan, RUN_PLAN_MAX, result->warnings, sizeof result->warnings);
    if ((status = measure_start(result, initial, error))) return status;
    if (initial->ignored[0]) {
        const size_t used = strlen(result->warnings);
        snprintf(result->warnings + used, sizeof result->warnings - used,
                 "%scolumns of %.80s that are not read: %s", used ? "; " : "", run->settings.file,
                 initial->ignored);
    }
    assert(result->plan_count <= RUN_PLAN_MAX);
    return STATUS_OK;
}

enum status run_explain(const struct run *run, struct run_result *result, struct error *error)
{
    struct initial initial;
    const enum status status = begin(run, result, &initial, error);
    initial_free(&initial);
    return status;
}

/* On a line particles start in the order of their numbers, round the box. */
static size_t count_crossed(const struct snapshot *snapshot)
{
    size_t crossed = 0;
    for (size_t i = 0; snapshot->id && i < snapshot->n; i++)
        crossed += snapshot->id[(i + 1) % snapshot->n] != (snapshot->id[i] + 1) % snapshot->n;
    return crossed;
}

/* Particles that were carried through the end of the box come last: positions shall rise. */
static void copy_line(const struct snapshot *seen, const double *from, double *to)
{
    size_t first = 0;
    for (size_t i = 1; i < seen->n; i++)
        if (seen->x[0][i] < seen->x[0][i - 1]) first = i;
    memcpy(to, from + first, (seen->n - first) * sizeof(double));
    memcpy(to + seen->n - first, from, first * sizeof(double));
}

/* In the order of their numbers, as they have started. */
static void copy_cloud(const struct snapshot *seen, const double *from, double *to)
{
    for (size_t i = 0; i < seen->n; i++) to[seen->id[i]] = from[i];
}

static enum status keep_snapshot(struct run_result *result, const struct snapshot *snapshot,
                                 struct error *error)
{
    const struct snapshot seen = *snapshot;
    struct snapshot *kept = &result->snapshot;
    const struct domain *domain = &result->problem.domain;
    const double *from[12];
    const double **to[12];
    size_t arrays = 0;
    double volume = 1;
    for (int d = 0; d < domain->dim; d++) {
        from[arrays] = seen.x[d], to[arrays++] = &kept->x[d];
        from[arrays] = seen.v[d], to[arrays++] = &kept->v[d];
        volume *= domain_length(domain, d);
    }
    const double *const scalars[] = {seen.m, seen.rho, seen.u, seen.P, seen.h, seen.volume};
    const double **const places[] = {&kept->m, &kept->rho, &kept->u,
                                     &kept->P, &kept->h,   &kept->volume};
    for (size_t k = 0; k < sizeof scalars / sizeof *scalars; k++)
        from[arrays] = scalars[k], to[arrays++] = places[k];
    result->storage = malloc(arrays * seen.n * sizeof(double));
    if (!result->storage) return error_set(error, STATUS_ENVIRONMENT, "no memory for a snapshot");
    for (size_t i = 0; i < arrays; i++) {
        double *copy = result->storage + i * seen.n;
        (domain->dim == 1 ? copy_line : copy_cloud)(&seen, from[i], copy);
        *to[i] = copy;
    }
    kept->n = seen.n;
    result->crossed = domain->dim == 1 ? count_crossed(snapshot) : 0;
    result->spacing = pow(volume / (double)seen.n, 1. / domain->dim);
    kept->time = result->time = seen.time;
    return STATUS_OK;
}

/* Sums at the end against t = 0. */
static void measure_conservation(struct run_result *result, const struct conservation *start,
                                 const struct conservation *end)
{
    const struct trace_drift drift = trace_drift(start, end, end);
    result->mass = drift.mass;
    result->momentum = drift.momentum;
    result->angular_momentum = drift.angular_momentum;
    result->energy = drift.energy;
}

static enum status finish(struct run_result *result, const struct run_outcome *outcome,
                          struct error *error)
{
    if (outcome->status != STATUS_OK && outcome->status != STATUS_BROKE_DOWN) {
        *error = outcome->reason;
        return error->status;
    }
    result->status = outcome->status;
    snprintf(result->message, sizeof result->message, "%s", outcome->reason.message);
    measure_conservation(result, &outcome->start, &outcome->end);
    return keep_snapshot(result, &outcome->snapshot, error);
}

/* A state without density or smoothing length: there is nothing to measure. */
static enum status broke_down_at_start(struct run_result *result, const struct error *reason)
{
    result->status = STATUS_BROKE_DOWN;
    snprintf(result->message, sizeof result->message, "%s", reason->message);
    result->mass = result->momentum = result->angular_momentum = result->energy = (double)NAN;
    result->motion = trace_motion(&(struct trace){.count = 0});
    run_measure_nothing(result);
    return STATUS_OK;
}

struct watch {
    const struct run *run;
    struct simulation *simulation;
    struct run_result *result;
    struct trace *trace;
    double until; /* where the present call of simulation_run ends */
};

/* Sums of what a run shall conserve, kinetic energy without that of the boost: no momentum along a
 * direction where walls or gravity push, and none at all beside layers that are kept: they also
 * drag what flows along them. */
static void take_sums(const struct run *run, const struct simulation *simulation,
                      struct conservation *sums)
{
    const struct prepared *p = &run->problem;
    bool layers = false;
    simulation_conservation(simulation, sums);
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
    const struct regularity regularity =
        regularity_of(&watch->run->problem, &watch->run->scheme.kernel, &seen);
    trace_see(watch->run->asked.trace, time, &regularity);
}

static bool after_step(void *context, double time, uint64_t steps)
{
    enum { STEPS_BETWEEN = 32 };
    const struct watch *watch = context;
    const struct run_settings *settings = &watch->run->asked;
    const double t_end = settings_real(&watch->run->settings, SETTING_t_end);
    struct checkpoint *checkpoint = settings->checkpoint;
    if (trace_wants(watch->trace, steps)) keep_trace(watch, time); /* a checkpoint has it */
    /* not after the last step: a checkpoint always has a step to go on with */
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

/* A snapshot on the way; what cannot be written or kept does not end the run. */
static void leave_snapshot(const struct watch *watch, size_t number)
{
    struct snapshots *snapshots = watch->run->asked.snapshots;
    struct run_result moment = *watch->result; /* of which nothing is measured yet */
    struct snapshot seen;
    struct error error = {0};
    char *path = snapshots_path(snapshots, number);
    simulation_snapshot(watch->simulation, &seen);
    if (!path)
        error_set(&error, STATUS_ENVIRONMENT, "no memory for a path");
    else if (!keep_snapshot(&moment, &seen, &error))
        run_write_snapshot(&moment, path, &error);
    if (!error.status && snapshots->show)
        snapshots->show(snapshots->context, &moment, number, &error);
    if (error.status) snapshots_fail(snapshots, &error);
    run_free(&moment);
    free(path);
}

/* From the state that was kept to each snapshot that is due, and back. */
static void go_aside(const struct watch *watch)
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
            leave_snapshot(watch, snapshots->next);
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
        if (snapshots && snapshots->state) go_aside(watch);
        const enum status status = simulation_run(watch->simulation, until, progress, watch, error);
        if (!snapshots || !snapshots->state) return status;
    }
}

/* To t_end, with stops where the problem says that something grows. */
static enum status steps(struct watch *watch, struct simulation *simulation,
                         struct run_result *result, double t_end, struct error *error)
{
    enum { STOPS = 17 };
    const struct prepared *p = &result->problem;
    const struct growing *growing = p->problem->growing;
    double times[2] = {0, 0};
    if (growing) growing->during(p, times);
    /* a run that is resumed has seen some of it */
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

static enum status simulate(const struct run *run, struct run_result *result,
                            struct initial *initial, struct error *error)
{
    const struct run_settings *asked = &run->asked;
    struct simulation *simulation = NULL;
    struct run_outcome outcome = {0};
    const struct setup setup = run_setup(run, initial);
    enum status status = simulation_take(&setup, &simulation, &outcome.reason);
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
                        asked->checkpoint ? asked->checkpoint->snapshot : -1, setup.t_end);
    }
    outcome.status = steps(&watch, simulation, result, setup.t_end, &outcome.reason);
    simulation_cost(simulation, &result->cost);
    if (!outcome.status) result->matrix = description_sum(simulation);
    simulation_end(simulation); /* its neighbours' memory serves for the snapshot */
    take_sums(run, simulation, &outcome.end);
    simulation_snapshot(simulation, &outcome.snapshot);
    trace_add(watch.trace, outcome.snapshot.time, &outcome.end);
    result->motion = trace_motion(watch.trace);
    if (asked->trace) keep_look(&watch, outcome.snapshot.time);
    if (asked->checkpoint) asked->checkpoint->trace = NULL;
    status = finish(result, &outcome, error);
    simulation_destroy(simulation); /* its memory serves for the errors */
    return status ? status : run_measure_errors(result, error);
}

static enum status simulate_otherwise(const struct run *run, struct run_result *result,
                                      struct initial *initial, struct error *error)
{
    struct run_outcome outcome = {0};
    const struct setup setup = run_setup(run, initial);
    run->asked.solver(&setup, &outcome);
    result->motion = trace_motion(&(struct trace){.count = 0});
    result->cost = outcome.cost;
    const enum status status = finish(result, &outcome, error);
    if (outcome.release) outcome.release(outcome.owned);
    return status ? status : run_measure_errors(result, error);
}

enum status run_execute(const struct run *run, struct run_result *result, struct error *error)
{
    struct initial initial;
    if (run->problem.problem->liquid)
        return error_set(error, STATUS_BAD_INPUT,
                         "an initial state of kind %s is of a weakly compressible liquid, which "
                         "this solver of ideal gases does not run; allowed: judge, ic, and runs of "
                         "other codes by --code",
                         run->problem.problem->member.name);
    enum status status = begin(run, result, &initial, error);
    if (!status)
        status = (run->asked.solver ? simulate_otherwise : simulate)(run, result, &initial, error);
    initial_free(&initial);
    if (status) {
        run_free(result);
        return status;
    }
    run_measure_functionals(result);
    result->regularity = regularity_of(&result->problem, &result->scheme.kernel, &result->snapshot);
    result->peak_rss = peak_rss();
    if (result->status == STATUS_BROKE_DOWN)
        error_set(error, STATUS_BROKE_DOWN, "%s", result->message);
    return result->status;
}

enum status run_start(const struct run *run, struct run_result *result, struct error *error)
{
    struct initial initial;
    struct simulation *simulation = NULL;
    enum status status = begin(run, result, &initial, error);
    if (!status) {
        const struct setup setup = run_setup(run, &initial);
        status = simulation_take(&setup, &simulation, error);
    }
    initial_free(&initial);
    if (!status) status = simulation_begin(simulation, error);
    /* no step, but what a run evaluates where it stops: a snapshot at t = 0 has the same bits */
    if (!status) status = simulation_run(simulation, 0, NULL, NULL, error);
    if (!status) {
        struct snapshot seen;
        simulation_snapshot(simulation, &seen);
        status = keep_snapshot(result, &seen, error);
    }
    simulation_destroy(simulation);
    if (status) run_free(result);
    return status;
}

enum status run_judge(const struct run *run, const struct snapshot *snapshot,
                      struct run_result *result, struct error *error)
{
    *result = (struct run_result){.settings = run->settings,
                                  .scheme = run->scheme,
                                  .problem = run->problem,
                                  .matrix = no_matrix};
    snprintf(result->case_name, sizeof result->case_name, "%s", run->asked.file.asked);
    result->n = snapshot->n;
    enum status status = problem_check_time(&run->problem, snapshot->time, error);
    if (!status) status = keep_snapshot(result, snapshot, error);
    if (!status) status = run_measure_errors(result, error);
    if (status)
        run_free(result);
    else
        run_measure_functionals(result);
    return status;
}

void run_free(struct run_result *result)
{
    free(result->storage);
    result->storage = NULL;
    result->snapshot = (struct snapshot){0};
}

double run_error(const struct run_result *result, enum field field, enum norm norm)
{
    const struct norms *errors = &result->errors[field];
    const double values[NORMS] = {errors->l1, errors->l2, errors->linf, errors->particle_mean,
                                  errors->l1_whole};
    return values[norm];
}
