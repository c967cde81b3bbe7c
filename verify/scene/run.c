/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "functional.h"
#include "growth.h"
#include "initial.h"
#include "initial_create.h"
#include "plain.h"
#include "problem_prepare.h"

enum status run_prepare(struct run_settings *settings, const char *case_name, int n,
                        char *const *arguments, struct error *error)
{
    *settings = (struct run_settings){.threads = 1};
    if (case_load(&settings->file, case_name, error)) return error->status;
    settings->settings = settings->file.settings;
    return settings_apply(&settings->settings, n, arguments, error);
}

static double peak_rss(void)
{
    struct rusage usage;
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

struct scene run_scene(const struct run *run, const struct initial *initial)
{
    const struct prepared *problem = &run->problem;
    const struct domain *domain = &problem->domain;
    return (struct scene){
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
        .unstamped = run->asked.unstamped,
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

static void add_snapshots(const struct run *run, const struct scene *scene,
                          struct estimate *estimate)
{
    if (run->asked.snapshots)
        estimate->memory += snapshots_memory(run->asked.snapshots, scene->dim, (double)scene->n);
}

/* Before there is an array of n numbers; a file's particles are as many as they are. */
static enum status check_size(const struct run *run, struct error *error)
{
    const struct initial none = {.n = (size_t)settings_real(&run->settings, SETTING_n)};
    const struct scene scene = run_scene(run, &none);
    struct estimate estimate = estimate_size(&scene);
    add_snapshots(run, &scene, &estimate);
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
    *initial = (struct initial){0};
    if ((!run->asked.any_window && (status = problem_check_time(&run->problem, t_end, error))) ||
        (status = check_size(run, error)) ||
        (status = initial_create(initial, &run->problem, &run->settings, error)))
        return status;
    const struct scene scene = run_scene(run, initial);
    result->n = initial->n;
    result->estimate = estimate_run(&scene);
    add_snapshots(run, &scene, &result->estimate);
    if (run->settings.file[0]) result->settings.value[SETTING_n].real[0] = (double)initial->n;
    result->plan_count =
        plan_explain(&scene, result->plan, RUN_PLAN_MAX, result->warnings, sizeof result->warnings);
    if ((status = measure_start(result, initial, error))) return status;
    if (initial->ignored[0]) {
        const size_t used = strlen(result->warnings);
        snprintf(result->warnings + used, sizeof result->warnings - used,
                 "%scolumns of %.80s that are not read: %s", used ? "; " : "", run->settings.file,
                 initial->ignored);
    }
    if (result->plan_count <= RUN_PLAN_MAX) return STATUS_OK;
    return error_set(error, STATUS_ENVIRONMENT, "a plan of %zu passes, more than %d",
                     result->plan_count, RUN_PLAN_MAX);
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
    result->spacing =
        domain->dim == 1 ? volume / (double)seen.n : pow(volume / (double)seen.n, 1. / domain->dim);
    kept->time = result->time = seen.time;
    return STATUS_OK;
}

/* What errors are measured of, n numbers each. */
struct comparison {
    double *exact[FIELDS];            /* of the fields at the particles; velocity: along x */
    double *place;                    /* 0 in the window, 2 beside it, NaN nowhere */
    double *none;                     /* 0 */
    double *jump;                     /* |v - exact v| */
    double *azimuthal[2], *radial[2]; /* measured, exact */
    double *storage;
};

static bool compare(struct comparison *of, const struct run_result *result)
{
    const struct prepared *p = &result->problem;
    const struct snapshot *s = &result->snapshot;
    double *next = of->storage = calloc((FIELDS + 7) * s->n, sizeof *next);
    double **const arrays[] = {&of->place,        &of->none,      &of->jump,     &of->azimuthal[0],
                               &of->azimuthal[1], &of->radial[0], &of->radial[1]};
    if (!next) return false;
    for (int f = 0; f < FIELDS; f++, next += s->n) of->exact[f] = next;
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++, next += s->n) *arrays[k] = next;
    for (size_t i = 0; i < s->n; i++) {
        struct problem_state state;
        double x[3] = {0}, place[3], v[3], exact_v[3] = {0}, squares = 0, nowhere = 0;
        for (int d = 0; d < p->domain.dim; d++) x[d] = s->x[d][i], nowhere += 0 * x[d];
        problem_sample(p, x, result->time, &state);
        for (int f = 0; f < FIELDS; f++) of->exact[f][i] = problem_field(&state, (enum field)f);
        problem_place(p, s, i, place);
        problem_velocity(p, s, i, v);
        for (int d = 0; d < p->domain.dim; d++) {
            exact_v[d] = state.v[d] - p->boost[d];
            squares += (v[d] - exact_v[d]) * (v[d] - exact_v[d]);
        }
        of->place[i] = nowhere + (window_contains(&p->window, place) ? 0 : 2);
        of->jump[i] = sqrt(squares);
        if (!problem_is_circular(p)) continue;
        problem_circular(p, place, v, &of->azimuthal[0][i], &of->radial[0][i]);
        problem_circular(p, place, exact_v, &of->azimuthal[1][i], &of->radial[1][i]);
    }
    return true;
}

/* Is a field nearer another one's exact values than its own? */
static enum status suspect(struct run_result *result, const double *const *measured,
                           const struct comparison *of, struct error *error)
{
    static const char *const names[] = {"density", "velocity", "pressure", "energy"};
    const struct snapshot *s = &result->snapshot;
    double *inside = malloc((2 * FIELDS + 1) * s->n * sizeof *inside); /* the window's particles */
    double *volume = inside + 2 * FIELDS * s->n;
    const double *value[FIELDS], *exact[FIELDS];
    size_t n = 0;
    if (!inside) return error_set(error, STATUS_ENVIRONMENT, "no memory for the errors");
    for (size_t field = 0; field < FIELDS; field++) {
        value[field] = inside + field * s->n;
        exact[field] = inside + (FIELDS + field) * s->n;
    }
    for (size_t i = 0; i < s->n; i++) {
        if (of->place[i] > 1) continue;
        for (size_t field = 0; field < FIELDS; field++) {
            inside[field * s->n + n] = measured[field][i];
            inside[(FIELDS + field) * s->n + n] = of->exact[field][i];
        }
        volume[n++] = s->volume[i];
    }
    /* about a point-like explosion the energy a mass has grows without bound */
    const size_t bounded = result->problem.problem->singular ? FIELD_INTERNAL_ENERGY : FIELDS;
    suspicion_swapped(bounded, names, n, volume, value, exact, result->suspicion);
    free(inside);
    return STATUS_OK;
}

static const struct norms no_norms = {.l1 = (double)NAN,
                                      .l2 = (double)NAN,
                                      .linf = (double)NAN,
                                      .particle_mean = (double)NAN,
                                      .l1_cut = (double)NAN};

/* On a line: also what bins and regions say. */
static void measure_line(struct run_result *result, const double *const *measured,
                         const struct comparison *of)
{
    const struct snapshot *s = &result->snapshot;
    const double window[2] = {result->problem.window.lo[0], result->problem.window.hi[0]};
    double means[NORM_BINS];
    for (int field = 0; field < FIELDS; field++)
        result->errors[field] =
            norm_errors(s->n, s->x[0], window, s->volume, measured[field], of->exact[field]);
    for (int field = 0; field < FIELDS; field++)
        result->errors[field].l1_cut =
            norm_l1_cut(s->n, s->x[0], window, domain_length(&result->problem.domain, 0), s->volume,
                        measured[field], of->exact[field]);
    problem_means(&result->problem, FIELD_DENSITY, result->time, NORM_BINS, means);
    result->binned_density_l1 =
        norm_binned_l1(s->n, s->x[0], window, s->volume, s->rho, NORM_BINS, means);
}

static void measure_cloud(struct run_result *result, const double *const *measured,
                          const struct comparison *of)
{
    static const double window[2] = {-1, 1};
    const struct snapshot *s = &result->snapshot;
    for (int field = 0; field < FIELDS; field++) {
        const bool vector = field == FIELD_VELOCITY;
        result->errors[field] =
            norm_errors(s->n, of->place, window, s->volume, vector ? of->jump : measured[field],
                        vector ? of->none : of->exact[field]);
    }
    result->binned_density_l1 = (double)NAN;
    if (!problem_is_circular(&result->problem)) return;
    result->azimuthal =
        norm_errors(s->n, of->place, window, s->volume, of->azimuthal[0], of->azimuthal[1]);
    result->radial = norm_errors(s->n, of->place, window, s->volume, of->radial[0], of->radial[1]);
}

static enum status measure_errors(struct run_result *result, struct error *error)
{
    const struct snapshot *s = &result->snapshot;
    const double *const measured[FIELDS] = {s->rho, s->v[0], s->P, s->u};
    struct comparison of;
    result->azimuthal = result->radial = no_norms;
    if (result->problem.problem->fieldless) {
        for (int field = 0; field < FIELDS; field++) result->errors[field] = no_norms;
        result->binned_density_l1 = (double)NAN;
        return STATUS_OK;
    }
    if (!compare(&of, result))
        return error_set(error, STATUS_ENVIRONMENT, "no memory for the errors");
    (result->problem.domain.dim == 1 ? measure_line : measure_cloud)(result, measured, &of);
    const enum status status = suspect(result, measured, &of, error);
    budget_measure(&result->problem, s, (const double *const *)of.exact, &result->budget);
    free(of.storage);
    return status;
}

static void measure_functionals(struct run_result *result)
{
    const struct prepared *p = &result->problem;
    const struct growing *growing = p->problem->growing;
    result->h = functional_window_mean(p, &result->snapshot, result->snapshot.h);
    for (const struct functional *const *f = p->problem->functionals; *f; f++) {
        if ((*f)->present && !(*f)->present(p)) continue;
        result->functionals[result->functional_count++] = (struct run_functional){
            .name = (*f)->name,
            .value = (*f)->measure(p, &result->snapshot),
            .exact = (*f)->exact ? (*f)->exact(p, result->time) : (double)NAN};
    }
    if (!growing) return;
    result->functionals[result->functional_count++] =
        (struct run_functional){growing->name, growth_rate(&result->growth), growing->rate(p)};
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

/* What a solver leaves behind; the snapshot's arrays are still the solver's. */
struct outcome {
    enum status status; /* of the run */
    struct error reason;
    struct conservation start, end;
    struct snapshot snapshot;
};

static enum status finish(struct run_result *result, const struct outcome *outcome,
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
    result->binned_density_l1 = (double)NAN;
    result->mass = result->momentum = result->angular_momentum = result->energy = (double)NAN;
    result->azimuthal = result->radial = no_norms;
    for (int field = 0; field < FIELDS; field++) result->errors[field] = no_norms;
    return STATUS_OK;
}

struct watch {
    const struct run *run;
    struct simulation *simulation;
    struct run_result *result;
    double until; /* where the present call of simulation_run ends */
};

/* Sums of what a run shall conserve: no momentum along a direction where walls, layers or gravity
 * push. */
static void take_sums(const struct run *run, const struct simulation *simulation,
                      struct conservation *sums)
{
    const struct prepared *p = &run->problem;
    simulation_conservation(simulation, sums);
    for (int d = 0; d < p->domain.dim; d++)
        if (p->boundary[d] == BOUNDARY_REFLECTING || p->boundary[d] == BOUNDARY_FIXED ||
            p->gravity[d] != 0)
            sums->momentum[d] = 0;
}

static void keep_trace(const struct watch *watch, double time)
{
    struct conservation sums;
    take_sums(watch->run, watch->simulation, &sums);
    trace_add(watch->run->asked.trace, time, &sums);
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
    /* a step is always to follow: what it leaves beside the state describes the end */
    if (checkpoint && time < watch->until && checkpoint_due(checkpoint)) {
        checkpoint->snapshot = settings->snapshots ? snapshots_last(settings->snapshots) : -1;
        checkpoint_save(checkpoint, watch->simulation, &watch->result->growth);
    }
    if (settings->snapshots && time < watch->until &&
        snapshots_keep(settings->snapshots, watch->simulation, time, watch->until))
        return false;
    if (settings->trace && trace_wants(settings->trace, steps)) keep_trace(watch, time);
    if (settings->trace && trace_looks(settings->trace, time, t_end)) keep_look(watch, time);
    if (!settings->progress || (steps % STEPS_BETWEEN && !settings->each_step)) return true;
    return settings->progress(settings->progress_context, time, steps);
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
    const struct run_settings *asked = &watch->run->asked;
    simulation_progress *progress =
        asked->progress || asked->trace || asked->checkpoint || asked->snapshots ? after_step
                                                                                 : NULL;
    double times[2] = {0, 0};
    if (growing) growing->during(p, times);
    /* a run that is resumed has seen some of it */
    for (int i = (int)result->growth.n; growing && i < STOPS; i++) {
        const double stop = times[0] + (times[1] - times[0]) * i / (STOPS - 1);
        struct snapshot seen;
        if (!(stop < t_end)) break;
        const enum status status = run_until(watch, stop, progress, error);
        simulation_snapshot(simulation, &seen);
        if (status || seen.time < stop) return status;
        growth_see(&result->growth, stop, growing->amplitude(p, &seen));
    }
    return run_until(watch, t_end, progress, error);
}

static enum status simulate(const struct run *run, struct run_result *result,
                            struct initial *initial, struct error *error)
{
    const struct run_settings *asked = &run->asked;
    struct simulation *simulation = NULL;
    struct outcome outcome = {0};
    const struct scene scene = run_scene(run, initial);
    enum status status = simulation_create(&scene, &simulation, &outcome.reason);
    initial_free(initial); /* the solver has copied it */
    if (status == STATUS_BROKE_DOWN) return broke_down_at_start(result, &outcome.reason);
    if (status) {
        *error = outcome.reason;
        return status;
    }
    struct watch watch = {run, simulation, result, 0};
    take_sums(run, simulation, &outcome.start);
    if (asked->checkpoint && asked->checkpoint->resume &&
        checkpoint_load(asked->checkpoint, simulation, &result->growth, error)) {
        simulation_destroy(simulation);
        return error->status;
    }
    if (asked->trace) {
        keep_trace(&watch, 0);
        keep_look(&watch, 0);
    }
    if (asked->snapshots) {
        simulation_snapshot(simulation, &outcome.snapshot);
        snapshots_begin(asked->snapshots, outcome.snapshot.time,
                        asked->checkpoint ? asked->checkpoint->snapshot : -1, scene.t_end);
    }
    outcome.status = steps(&watch, simulation, result, scene.t_end, &outcome.reason);
    simulation_cost(simulation, &result->cost);
    if (!outcome.status) result->matrix = description_sum(simulation);
    take_sums(run, simulation, &outcome.end);
    simulation_snapshot(simulation, &outcome.snapshot);
    if (asked->trace) {
        trace_add(asked->trace, outcome.snapshot.time, &outcome.end);
        keep_look(&watch, outcome.snapshot.time);
    }
    status = finish(result, &outcome, error);
    simulation_destroy(simulation); /* its memory serves for the errors */
    return status ? status : measure_errors(result, error);
}

static enum status simulate_plainly(const struct run *run, struct run_result *result,
                                    struct initial *initial, struct error *error)
{
    struct plain plain;
    struct outcome outcome = {0};
    const struct scene scene = run_scene(run, initial);
    outcome.status = plain_run(&plain, &scene, &outcome.reason);
    outcome.start = plain.start;
    outcome.end = plain.end;
    result->cost = plain.cost;
    plain_snapshot(&plain, &outcome.snapshot);
    const enum status status = finish(result, &outcome, error);
    plain_free(&plain);
    return status ? status : measure_errors(result, error);
}

enum status run_execute(const struct run *run, struct run_result *result, struct error *error)
{
    struct initial initial;
    enum status status = begin(run, result, &initial, error);
    if (!status)
        status = (run->asked.plain ? simulate_plainly : simulate)(run, result, &initial, error);
    initial_free(&initial);
    if (status) {
        run_free(result);
        return status;
    }
    measure_functionals(result);
    result->regularity = regularity_of(&result->problem, &result->scheme.kernel, &result->snapshot);
    result->peak_rss = peak_rss();
    if (result->status == STATUS_BROKE_DOWN)
        error_set(error, STATUS_BROKE_DOWN, "%s", result->message);
    return result->status;
}

enum status run_judge(const struct run *run, const struct snapshot *snapshot,
                      struct run_result *result, struct error *error)
{
    *result = (struct run_result){.settings = run->settings,
                                  .scheme = run->scheme,
                                  .problem = run->problem,
                                  .matrix = no_matrix};
    result->n = snapshot->n;
    enum status status = problem_check_time(&run->problem, snapshot->time, error);
    if (!status) status = keep_snapshot(result, snapshot, error);
    if (!status) status = measure_errors(result, error);
    if (status)
        run_free(result);
    else
        measure_functionals(result);
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
                                  errors->l1_cut};
    return values[norm];
}
