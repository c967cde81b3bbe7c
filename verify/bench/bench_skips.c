/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bench_skips.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_cells.h"
#include "bench_loops.h"
#include "integrator.h"

/* Work that keys restore; a case whose scheme does not skip it has no entry. */
enum when { ALWAYS, PREDICTED, INVISCID, UNIFORM, LOCAL };
static const struct {
    /* ALPHA and CFL: the values of the scheme, as automatic values depend on the viscosity */
    const char *name, *keys[BENCH_SIDES];
    enum when when;
    enum bench_promise promise;
    double bound;
} switches[] = {
    {"particles no signal has reached",
     {"skip=auto", "skip=none"},
     ALWAYS,
     PROMISE_ROUND_OFF,
     1e-8},
    {"the shortest step for all",
     {"steps=local shifting=none", "steps=global shifting=none"},
     LOCAL,
     PROMISE_ERROR,
     0.05},
    {"h by Newton", {"", "h_method=newton"}, PREDICTED, PROMISE_ERROR, 0.05},
    {"viscosity of none",
     {"", "viscosity=constant alpha=0 beta=0 cfl=CFL"},
     INVISCID,
     PROMISE_BITS,
     0},
    {"evolution of alpha",
     {"", "viscosity=time_dependent alpha_min=ALPHA alpha_max=ALPHA cfl=CFL"},
     UNIFORM,
     PROMISE_ROUND_OFF,
     1e-10},
};
enum { SWITCHES = sizeof switches / sizeof *switches };

/* Single passes: the loops of another scheme, minus those that the case runs instead. */
enum extra {
    EXTRA_ORDER,
    EXTRA_REACH,
    EXTRA_MATRIX,
    EXTRA_SLOPE,
    EXTRA_GRAD_H,
    EXTRA_ENERGY_SUM,
    EXTRA_SIGNAL,
    EXTRAS
};
static const struct {
    const char *name, *keys;
    enum bench_pass pass, instead;
} extras[EXTRAS] = {
    [EXTRA_ORDER] = {"order of neighbours", "sorted at every step", PASS_SORT, PASS_ORDER},
    [EXTRA_REACH] = {"neighbour ranges", "searched at every step", PASS_SEARCH, PASS_REACH},
    [EXTRA_MATRIX] = {"moment matrix", "the pass alone", PASS_MATRIX, PASS_NONE},
    [EXTRA_SLOPE] = {"velocity gradient", "the pass alone", PASS_MATRIX, PASS_NONE},
    [EXTRA_GRAD_H] = {"grad-h factors", "in the density sum", PASS_DENSITY, PASS_DENSITY},
    [EXTRA_ENERGY_SUM] = {"energy sum", "in the density sum", PASS_DENSITY, PASS_DENSITY},
    [EXTRA_SIGNAL] = {"time step by itself", "the pass alone", PASS_SIGNAL, PASS_NONE},
};

/* --- comparing -------------------------------------------------------------------------------- */

double bench_skips_difference(const struct snapshot *a, const struct snapshot *b, double period)
{
    const double *const of_a[] = {a->x[0], a->x[1], a->x[2], a->v[0], a->v[1],
                                  a->v[2], a->rho,  a->u,    a->P,    a->h};
    const double *const of_b[] = {b->x[0], b->x[1], b->x[2], b->v[0], b->v[1],
                                  b->v[2], b->rho,  b->u,    b->P,    b->h};
    double worst = 0;
    if (a->n != b->n || a->n == 0) return (double)INFINITY;
    for (size_t k = 0; k < sizeof of_a / sizeof *of_a; k++) {
        double largest = 0, difference = 0;
        if (!of_a[k] || !of_b[k]) continue; /* no such axis */
        if (memcmp(of_a[k], of_b[k], a->n * sizeof(double)) == 0) continue;
        for (size_t i = 0; i < a->n; i++) {
            double here = fabs(of_a[k][i] - of_b[k][i]);
            if (isnan(here)) return (double)INFINITY;
            if (k < 3) here = fmin(here, fabs(period - here));
            difference = fmax(difference, here);
            largest = fmax(largest, fabs(of_a[k][i]));
        }
        /* zeros of different sign are a difference, too */
        worst = fmax(worst, difference > 0 ? difference / largest : 1e-300);
    }
    return worst;
}

/* --- one measurement -------------------------------------------------------------------------- */

struct job {
    struct run *run;           /* or */
    struct bench_loops *loops; /* or */
    struct bench_cells *cells;
    struct run_result last; /* of the run */
};

static enum status work(void *context, uint64_t times, struct clock_taken *taken,
                        struct error *error)
{
    struct job *job = context;
    if (job->loops) return bench_loops_work(job->loops, times, taken, error);
    if (job->cells) return bench_cells_work(job->cells, times, taken, error);
    for (uint64_t i = 0; i < times; i++) {
        run_free(&job->last);
        const enum status status = run_execute(job->run, &job->last, error);
        if (status == STATUS_BROKE_DOWN) run_free(&job->last);
        if (status) return status;
        taken->wall_s += job->last.cost.wall_s;
        taken->cpu_s += job->last.cost.cpu_s;
    }
    return STATUS_OK;
}

struct bench {
    struct bench_skips *result;
    size_t max;
    enum bench_part part;
    struct job *jobs; /* BENCH_SIDES per skip; then one whole step of each case */
};

/* Applies keys, with ALPHA and CFL replaced. own: NULL if neither occurs. */
static enum status apply(struct run_settings *settings, const char *keys, const struct scheme *own,
                         struct error *error)
{
    char text[256], *rest = text;
    snprintf(text, sizeof text, "%s", keys);
    for (char *word; (word = strtok_r(rest, " ", &rest));) {
        char key[80], *arguments[] = {key};
        const char *alpha = strstr(word, "=ALPHA"), *cfl = strstr(word, "=CFL");
        if (alpha)
            snprintf(key, sizeof key, "%.*s=%.17g", (int)(alpha - word), word, own->alpha);
        else if (cfl)
            snprintf(key, sizeof key, "%.*s=%.17g", (int)(cfl - word), word, own->cfl);
        else
            snprintf(key, sizeof key, "%s", word);
        if (settings_apply(&settings->settings, 1, arguments, error)) return error->status;
    }
    return STATUS_OK;
}

static bool applies(enum when when, const struct scheme *scheme, int dim)
{
    struct scheme local = *scheme;
    struct error ignored;
    local.steps = STEPS_LOCAL;
    local.shifting = SHIFTING_NONE;
    switch (when) {
    case PREDICTED:
        return scheme->h_method != H_NEWTON;
    case INVISCID:
        return scheme->viscosity == VISCOSITY_NONE;
    case UNIFORM:
        return scheme->viscosity == VISCOSITY_CONSTANT;
    case LOCAL:
        return scheme_check(&local, dim, &ignored) == STATUS_OK;
    default:
        return true;
    }
}

static struct bench_skip *new_skip(struct bench *bench, size_t c, const char *name,
                                   const char *keys)
{
    struct bench_skip *skip = &bench->result->skips[bench->result->count++];
    *skip = (struct bench_skip){.case_index = c,
                                .name = name,
                                .keys = keys,
                                .promise = PROMISE_UNUSED,
                                .difference = (double)NAN,
                                .error = {(double)NAN, (double)NAN},
                                .without_viscosity = (double)NAN,
                                .without_slope = (double)NAN,
                                .kept = true,
                                .enough = true};
    return skip;
}

static struct job *jobs_of(const struct bench *bench, const struct bench_skip *skip)
{
    return &bench->jobs[(size_t)(skip - bench->result->skips) * BENCH_SIDES];
}

/* A run with additional keys; malloced. NULL: invalid keys, or no memory. */
static struct run *run_with(const struct run_settings *from, const char *keys,
                            const struct scheme *own, struct error *error)
{
    struct run_settings asked = *from;
    asked.settings.shared |= own != NULL; /* keys that belong to the case's own scheme */
    if (apply(&asked, keys, own, error)) return NULL;
    struct run *run = malloc(sizeof *run);
    if (!run) error_set(error, STATUS_ENVIRONMENT, "no memory");
    if (!run || !run_resolve(run, &asked, error)) return run;
    free(run);
    return NULL;
}

static enum status add_switches(struct bench *bench, size_t c, const struct scheme *scheme,
                                struct error *error)
{
    for (size_t s = 0; s < SWITCHES; s++) {
        const int dim = bench->result->cases[c].file.dimension;
        const enum bench_part part = s == 0                      ? BENCH_SLEEP
                                     : switches[s].when == LOCAL ? BENCH_STEPS
                                                                 : BENCH_WORK;
        if (bench->part != BENCH_WORK && part != bench->part) continue;
        if (!applies(switches[s].when, scheme, dim)) continue;
        struct bench_skip *skip =
            new_skip(bench, c, switches[s].name, switches[s].keys[BENCH_WITH]);
        skip->promise = switches[s].promise;
        skip->bound = switches[s].bound;
        for (int side = BENCH_WITHOUT; side <= BENCH_WITH; side++) {
            struct job *job = &jobs_of(bench, skip)[side];
            job->run = run_with(&bench->result->cases[c], switches[s].keys[side], scheme, error);
            if (!job->run) return error->status;
        }
    }
    return STATUS_OK;
}

/* The scheme whose loops contain the work; false if the case itself needs that work. */
static bool scheme_with(enum extra extra, struct scheme *scheme)
{
    const struct scheme own = *scheme;
    switch (extra) {
    case EXTRA_MATRIX:
        scheme->gradient = GRADIENT_IA;
        scheme->viscosity = VISCOSITY_CONSTANT;
        return own.gradient != GRADIENT_IA;
    case EXTRA_SLOPE:
        scheme->viscosity = VISCOSITY_RECONSTRUCTED;
        scheme->gradient = GRADIENT_STANDARD;
        return own.viscosity != VISCOSITY_RECONSTRUCTED;
    case EXTRA_GRAD_H:
        scheme->formulation = FORMULATION_LAGRANGIAN;
        return own.formulation != FORMULATION_LAGRANGIAN && own.volume_element == VOLUME_MASS;
    case EXTRA_ENERGY_SUM:
        scheme->volume_element = VOLUME_ENERGY;
        return own.volume_element != VOLUME_ENERGY;
    case EXTRA_SIGNAL:
        return !own.integrator->signal_pass;
    default:
        return true;
    }
}

static enum status add_loops(struct job *job, const struct scheme *scheme, enum bench_pass pass,
                             struct error *error)
{
    job->loops = calloc(1, sizeof *job->loops);
    if (!job->loops) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    return bench_loops_create(job->loops, scheme, BENCH_LOOPS_PARTICLES, true, 1u << pass, error);
}

static enum status add_cells(struct job *job, const struct scheme *scheme, int dim, unsigned pass,
                             struct error *error)
{
    job->cells = calloc(1, sizeof *job->cells);
    if (!job->cells) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    return bench_cells_create(job->cells, scheme, dim, dim == 2 ? 40 : 12, true, pass, error);
}

/* In 2D and 3D: adds the sums of another scheme, minus those of the case's own. */
static enum status add_cloud_extras(struct bench *bench, size_t c, int dim,
                                    const struct scheme *scheme, struct error *error)
{
    static const struct {
        enum extra extra;
        unsigned pass;
    } passes[] = {{EXTRA_MATRIX, CELLS_MATRIX},
                  {EXTRA_SLOPE, CELLS_MATRIX},
                  {EXTRA_ENERGY_SUM, CELLS_DENSITY}};
    const struct plan own = plan_make(scheme, dim, false, true);
    for (size_t k = 0; k < sizeof passes / sizeof *passes; k++) {
        struct scheme with = *scheme;
        const enum extra e = passes[k].extra;
        if (!scheme_with(e, &with) || (e == EXTRA_MATRIX && own.matrix) ||
            (e == EXTRA_SLOPE && own.slope))
            continue;
        if (e == EXTRA_MATRIX) with.viscosity = scheme->viscosity;
        if (e == EXTRA_SLOPE) with.gradient = scheme->gradient;
        struct job *job = jobs_of(bench, new_skip(bench, c, extras[e].name, extras[e].keys));
        if (add_cells(&job[BENCH_WITH], &with, dim, passes[k].pass, error) ||
            add_cells(&job[BENCH_WITHOUT], scheme, dim, passes[k].pass, error))
            return error->status;
    }
    return STATUS_OK;
}

static enum status add_extras(struct bench *bench, size_t c, const struct scheme *scheme,
                              struct error *error)
{
    const int dim = bench->result->cases[c].file.dimension;
    if (dim > 1) return add_cloud_extras(bench, c, dim, scheme, error);
    for (enum extra e = 0; e < EXTRAS; e++) {
        struct scheme with = *scheme;
        if (!scheme_with(e, &with)) continue;
        struct job *job = jobs_of(bench, new_skip(bench, c, extras[e].name, extras[e].keys));
        if (add_loops(&job[BENCH_WITH], &with, extras[e].pass, error)) return error->status;
        if (extras[e].instead == PASS_NONE) continue;
        if (add_loops(&job[BENCH_WITHOUT], scheme, extras[e].instead, error)) return error->status;
    }
    return STATUS_OK;
}

static enum status add_case(struct bench *bench, size_t c, struct error *error)
{
    const struct run_settings *settings = &bench->result->cases[c];
    struct job *whole = &bench->jobs[bench->max * BENCH_SIDES + c];
    whole->run = run_with(settings, "skip=none", NULL, error);
    if (!whole->run || add_switches(bench, c, &whole->run->scheme, error) ||
        (bench->part == BENCH_WORK && add_extras(bench, c, &whole->run->scheme, error)))
        return error->status;
    return STATUS_OK;
}

/* --- all of them ------------------------------------------------------------------------------ */

/* Difference caused by a start whose particles are moved by this fraction of their spacing, or, if
 * the case takes no jitter, by time steps longer by this fraction: strong shocks, the noise behind
 * them and blasts on a symmetric lattice amplify round-off, so no promise can be tighter. 0 if it
 * cannot be measured. */
static double sensitivity(const struct job *job, double nudge)
{
    struct error ignored = {0};
    struct run_result result = {0};
    double difference = 0;
    char key[40];
    const struct run_settings *asked = &job->run->asked;
    const double jitter = settings_real(&asked->settings, SETTING_jitter);
    snprintf(key, sizeof key, "jitter=%.17g", jitter > 0 ? jitter * (1 + nudge) : nudge);
    struct run *nudged = run_with(asked, key, NULL, &ignored);
    snprintf(key, sizeof key, "cfl=%.17g", job->run->scheme.cfl * (1 + nudge));
    if (!nudged) nudged = run_with(asked, key, NULL, &ignored);
    if (!nudged) return 0;
    if (!run_execute(nudged, &result, &ignored))
        difference = bench_skips_difference(&job->last.snapshot, &result.snapshot,
                                            domain_length(&job->last.problem.domain, 0));
    run_free(&result);
    free(nudged);
    return isfinite(difference) ? difference : 0;
}

/* Returns the quantity of the error; NULL: no exact solution, and the error is NaN. */
static const char *error_of(const struct run_result *result, double *error)
{
    *error = result->errors[FIELD_DENSITY].l1;
    if (isfinite(*error)) return "L1 of density";
    *error = result->errors[FIELD_VELOCITY].l1;
    if (isfinite(*error)) return "L1 of velocity";
    for (size_t k = 0; k < result->functional_count; k++) {
        const struct run_functional *functional = &result->functionals[k];
        *error = fabs(functional->value - functional->exact);
        if (isfinite(*error)) return functional->name;
    }
    *error = (double)NAN;
    return NULL;
}

static void judge(struct bench_skip *skip, const struct job *job)
{
    const struct run_result *a = &job[BENCH_WITHOUT].last, *b = &job[BENCH_WITH].last;
    skip->measured = error_of(a, &skip->error[BENCH_WITHOUT]);
    error_of(b, &skip->error[BENCH_WITH]);
    skip->momentum[BENCH_WITHOUT] = a->drift.momentum,
    skip->momentum[BENCH_WITH] = b->drift.momentum;
    skip->energy[BENCH_WITHOUT] = a->drift.energy, skip->energy[BENCH_WITH] = b->drift.energy;
    struct error ignored;
    if (skip->name == switches[0].name && (skip->shares = calloc(1, sizeof *skip->shares)) &&
        bench_possible(job[BENCH_WITHOUT].run, skip->shares, &ignored)) {
        free(skip->shares);
        skip->shares = NULL;
    }
    if (strcmp(skip->keys, "skip=none") == 0) {
        /* including the initial sums */
        const double sums =
            (double)a->n + a->scheme.integrator->evaluations * (double)a->cost.particle_updates;
        skip->without_viscosity = (double)a->cost.without_viscosity / sums;
        skip->without_slope = (double)a->cost.without_slope / sums;
    }
    const double *error = skip->error;
    skip->difference = skip->promise == PROMISE_ERROR
                           ? (error[BENCH_WITHOUT] == error[BENCH_WITH]
                                  ? 0
                                  : error[BENCH_WITHOUT] / error[BENCH_WITH] - 1)
                           : bench_skips_difference(&a->snapshot, &b->snapshot,
                                                    domain_length(&a->problem.domain, 0));
    if (skip->promise == PROMISE_ROUND_OFF && skip->difference > skip->bound)
        skip->bound =
            fmax(skip->bound,
                 sensitivity(&job[BENCH_WITH], skip->shares ? skip->shares->tolerance : 1e-11));
    skip->enough = !skip->shares || bench_shares_enough(skip->shares);
    skip->kept = skip->difference <= skip->bound ||
                 (skip->promise == PROMISE_ERROR &&
                  !skip->measured); /* without an exact solution nothing is judged */
}

static void finish(struct bench *bench, const struct bench_subject *of_job[])
{
    for (size_t s = 0; s < bench->result->count; s++) {
        struct bench_skip *skip = &bench->result->skips[s];
        const struct job *job = jobs_of(bench, skip);
        const struct bench_subject *const *times = &of_job[s * BENCH_SIDES];
        if (job[BENCH_WITH].loops || job[BENCH_WITH].cells) {
            /* a particle's update of the whole run, and what the pass adds to it */
            const size_t whole = bench->max * BENCH_SIDES + skip->case_index;
            const struct run_result *run = &bench->jobs[whole].last;
            const double update = of_job[whole]->time.cpu_s / (double)run->cost.particle_updates;
            const double without = times[BENCH_WITHOUT] ? times[BENCH_WITHOUT]->time.cpu_s : 0;
            skip->cpu_s[BENCH_WITHOUT] = update;
            const double n = job[BENCH_WITH].cells ? (double)job[BENCH_WITH].cells->fields.n
                                                   : (double)BENCH_LOOPS_PARTICLES;
            skip->cpu_s[BENCH_WITH] = update + (times[BENCH_WITH]->time.cpu_s - without) / n;
            skip->spread = fmax(of_job[whole]->time.spread, times[BENCH_WITH]->time.spread);
            continue;
        }
        for (int side = BENCH_WITHOUT; side <= BENCH_WITH; side++) {
            skip->cpu_s[side] = times[side]->time.cpu_s;
            skip->spread = fmax(skip->spread, times[side]->time.spread);
        }
        judge(skip, job);
    }
    for (size_t c = 0; c < bench->result->case_count; c++)
        bench->result->n[c] = bench->jobs[bench->max * BENCH_SIDES + c].last.n;
}

static enum status measure(struct bench *bench, const struct bench_rules *rules,
                           struct error *error)
{
    const size_t all = bench->max * BENCH_SIDES + bench->result->case_count;
    const struct bench_subject **of_job = calloc(all, sizeof *of_job);
    struct bench_subject *subjects = calloc(all, sizeof *subjects);
    enum status status = STATUS_OK;
    size_t count = 0;
    if (!of_job || !subjects) {
        status = error_set(error, STATUS_ENVIRONMENT, "no memory");
        goto end;
    }
    for (size_t k = 0; k < all; k++) {
        if (!bench->jobs[k].run && !bench->jobs[k].loops && !bench->jobs[k].cells) continue;
        subjects[count] = (struct bench_subject){.work = work, .context = &bench->jobs[k]};
        of_job[k] = &subjects[count++];
    }
    status = bench_measure(subjects, count, rules, error);
    for (size_t k = 0; k < count && !status; k++)
        if (subjects[k].failure.status) {
            *error = subjects[k].failure;
            status = error->status;
        }
    if (!status) finish(bench, of_job);
end:
    free(of_job), free(subjects);
    return status;
}

enum status bench_skips_measure(const struct run_settings *cases, size_t count,
                                const struct bench_rules *rules, enum bench_part part,
                                struct bench_skips *result, struct error *error)
{
    struct bench bench = {.result = result, .part = part, .max = count * (SWITCHES + EXTRAS)};
    *result = (struct bench_skips){.case_count = count,
                                   .cases = malloc(count * sizeof *cases),
                                   .n = calloc(count, sizeof(size_t)),
                                   .skips = calloc(bench.max, sizeof *result->skips)};
    bench.jobs = calloc(bench.max * BENCH_SIDES + count, sizeof *bench.jobs);
    enum status status = STATUS_OK;
    if (!result->cases || !result->n || !result->skips || !bench.jobs)
        status = error_set(error, STATUS_ENVIRONMENT, "no memory");
    for (size_t c = 0; c < count && !status; c++) {
        result->cases[c] = cases[c];
        status = add_case(&bench, c, error);
    }
    if (!status) status = measure(&bench, rules, error);
    for (size_t k = 0; bench.jobs && k < bench.max * BENCH_SIDES + count; k++) {
        free(bench.jobs[k].run);
        run_free(&bench.jobs[k].last);
        if (bench.jobs[k].loops) bench_loops_free(bench.jobs[k].loops);
        free(bench.jobs[k].loops);
        if (bench.jobs[k].cells) bench_cells_free(bench.jobs[k].cells);
        free(bench.jobs[k].cells);
    }
    free(bench.jobs);
    return status;
}

bool bench_skips_pass(const struct bench_skips *result)
{
    bool passes = true;
    for (size_t s = 0; s < result->count; s++)
        passes = passes && result->skips[s].kept && result->skips[s].enough;
    return passes;
}

void bench_skips_free(struct bench_skips *result)
{
    for (size_t s = 0; s < result->count; s++) free(result->skips[s].shares);
    free(result->cases), free(result->n), free(result->skips);
    *result = (struct bench_skips){0};
}
