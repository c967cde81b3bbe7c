/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "equal_masses.h"
#include "initial.h"
#include "problem_list.h"
#include "problem_prepare.h"
#include "run_part.h"
#include "slab.h"
#include "snapshot_writer.h"

enum status run_prepare(struct run_settings *settings, const char *case_name, int n,
                        char *const *arguments, struct error *error)
{
    *settings = (struct run_settings){.threads = 1};
    if (case_load(&settings->file, case_name, error)) return error->status;
    settings->settings = settings->file.settings;
    return settings_apply(&settings->settings, n, arguments, error);
}

/* Of this program only: on Linux getrusage includes the parent process before exec. */
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
    enum status status = problem_prepare(&run->problem, &run->settings, dim, error);
    if (!status) status = settings_scheme(&run->settings, dim, &run->scheme, error);
    if (status) return status;
    const struct setup setup = run_setup(run, &(struct initial){0});
    return simulation_check_shifting(&setup, error);
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

/* A result that contains only the input of the run. */
static void start_result(const struct run *run, struct run_result *result)
{
    const double none = (double)NAN;
    *result = (struct run_result){.settings = run->settings,
                                  .scheme = run->scheme,
                                  .problem = run->problem,
                                  .matrix = {none, none, none, none, 0}};
    snprintf(result->case_name, sizeof result->case_name, "%s", run->asked.file.asked);
}

/* Measures the quality of a glass in a periodic box. */
static enum status measure_start(struct run_result *result, const struct initial *initial,
                                 struct error *error)
{
    const struct prepared *p = &result->problem;
    bool good = settings_choice(&result->settings, SETTING_lattice) == LATTICE_GLASS &&
                !result->settings.file[0];
    for (int d = 0; d < p->domain.dim; d++) good &= p->boundary[d] == BOUNDARY_PERIODIC;
    result->start.density = (double)NAN;
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

/* Checks the memory before any array of n numbers is allocated. The number of particles in a file
 * is not known yet. */
static enum status check_size(const struct run *run, struct error *error)
{
    const struct initial none = {.n = (size_t)settings_real(&run->settings, SETTING_n)};
    const struct setup setup = run_setup(run, &none);
    struct estimate estimate = estimate_size(&setup);
    add_snapshots(run, &setup, &estimate);
    return run->settings.file[0] ? STATUS_OK : estimate_check(&estimate, none.n, error);
}

/* Does everything before the first step. After an error nothing is left to free. */
static enum status begin(const struct run *run, struct run_result *result, struct initial *initial,
                         struct error *error)
{
    const double t_end = settings_real(&run->settings, SETTING_t_end);
    enum status status;
    start_result(run, result);
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
    enum status status = begin(run, result, &initial, error);
    if (!status) {
        const struct setup setup = run_setup(run, &initial);
        status = estimate_check_reach(&setup, error);
        if (status) run_free(result);
    }
    initial_free(&initial);
    return status;
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
    if (!status) {
        const struct setup setup = run_setup(run, &initial);
        status = run_simulate(run, &setup, &initial, result, error);
    }
    initial_free(&initial);
    if (status) {
        run_free(result);
        return status;
    }
    run_measure_functionals(result);
    result->regularity = regularity_of(&result->problem, &result->scheme.kernel, &result->snapshot,
                                       run->asked.threads);
    result->peak_rss = peak_rss();
    if (result->status == STATUS_BROKE_DOWN)
        error_set(error, STATUS_BROKE_DOWN, "%s", result->message);
    return result->status;
}

enum status run_ask_equal_masses(struct run_settings *asked, struct error *error)
{
    static const struct {
        enum setting key;
        const char *value;
    } ways[] = {{SETTING_equal_masses, "yes"}, {SETTING_mass_ratio, "1"}};
    struct settings *settings = &asked->settings;
    asked->equal_masses = true;
    for (size_t k = 0; k < sizeof ways / sizeof *ways; k++)
        if (problem_reads(problem_of(settings), ways[k].key) &&
            settings->value[ways[k].key].source != SOURCE_USER &&
            settings_set(settings, ways[k].key, ways[k].value, SOURCE_USER, NULL, error))
            return error->status;
    return STATUS_OK;
}

/* As `begin`, with equal masses. Lattices of two spacings, or parts of a line, give equal masses
 * only for some numbers of particles; takes the nearest of those. */
static enum status begin_equal(struct run *run, struct run_result *result, struct initial *initial,
                               struct error *error)
{
    enum { TRIES = 200 }; /* up to half of n away, first in steps of 1 */
    const double n = settings_real(&run->settings, SETTING_n);
    struct run_settings asked = run->asked;
    struct error reason;
    enum status status = begin(run, result, initial, error);
    if (!status) status = equal_masses_check(initial, error);
    for (int k = 2; status == STATUS_BAD_INPUT && k < 2 * TRIES; k++) {
        const double away = k / 2 + floor(n / 2 * pow((k / 2) / (double)TRIES, 3));
        char text[32];
        snprintf(text, sizeof text, "%.17g", fmax(4, n + (k % 2 ? -away : away)));
        initial_free(initial);
        if (!settings_set(&asked.settings, SETTING_n, text, SOURCE_USER, NULL, &reason) &&
            !run_resolve(run, &asked, &reason) && !begin(run, result, initial, &reason) &&
            !equal_masses_check(initial, &reason))
            status = STATUS_OK;
    }
    return status;
}

/* As `begin`, with layers if asked for: run then becomes that of the slab. */
static enum status begin_start(struct run *run, struct run_result *result, struct initial *initial,
                               struct error *error)
{
    enum status status = run->asked.equal_masses ? begin_equal(run, result, initial, error)
                                                 : begin(run, result, initial, error);
    if (status || !run->asked.layers) return status;
    status = slab_lay(run, initial, error);
    result->problem = run->problem;
    result->scheme = run->scheme;
    result->n = initial->n;
    return status;
}

/* Replaces the gas pressure from the simulation by that of the liquid. */
static void give_liquid_pressure(struct run_result *result)
{
    const struct snapshot *s = &result->snapshot;
    double *P = (double *)s->P; /* points into result->storage */
    struct problem_state state;
    for (size_t i = 0; i < s->n; i++) {
        problem_sample_particle(&result->problem, s, i, &state);
        P[i] = state.P;
    }
}

enum status run_start(const struct run *asked, struct run_result *result, struct error *error)
{
    struct run run = *asked;
    struct initial initial;
    struct simulation *simulation = NULL;
    enum status status = begin_start(&run, result, &initial, error);
    if (!status) {
        const struct setup setup = run_setup(&run, &initial);
        status = simulation_take(&setup, &simulation, error);
    }
    initial_free(&initial);
    if (!status) status = simulation_begin(simulation, error);
    /* no step, but the evaluation at the end of a run, so that a snapshot at t = 0 has the same
     * bits */
    if (!status) status = simulation_run(simulation, 0, NULL, NULL, error);
    if (!status) {
        struct snapshot seen;
        simulation_snapshot(simulation, &seen);
        status = run_keep(result, &seen, error);
        if (!status && run.problem.problem->liquid) give_liquid_pressure(result);
    }
    simulation_destroy(simulation);
    if (status) run_free(result);
    return status;
}

enum status run_judge(const struct run *run, const struct snapshot *snapshot,
                      struct run_result *result, struct error *error)
{
    start_result(run, result);
    result->n = snapshot->n;
    enum status status = problem_check_time(&run->problem, snapshot->time, error);
    if (!status) status = run_keep(result, snapshot, error);
    if (!status) status = run_measure_errors(result, error);
    if (status)
        run_free(result);
    else
        run_measure_functionals(result);
    return status;
}

double run_error(const struct run_result *result, enum field field, enum norm norm)
{
    const struct norms *errors = &result->errors[field];
    const double values[NORMS] = {errors->l1, errors->l2, errors->linf, errors->particle_mean,
                                  errors->l1_whole};
    return values[norm];
}
