/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "autopsy_state.h"
#include "initial.h"
#include "rate_table.h"

/* Particles at given positions with the exact fields of one time; arrays of n. */
struct scene {
    const struct run *run;
    size_t n;
    double time, spacing;
    double *x[3]; /* not owned, not changed */
    double *m, *rho;
    double *v[3], *u, *P;
    double *exact[3];   /* acceleration -grad P/rho + g */
    double *inertia[3]; /* dv/dt of the exact solution along its own flow */
    double *weight;     /* volume in the window */
    double *storage;
    struct autopsy_cells cells;
};

/* ---- exact fields ---- */

/* Fourth-order difference quotient of four values at -2, -1, 1 and 2 steps. */
static double slope(const double f[4], double step)
{
    return (8 * (f[2] - f[1]) - (f[3] - f[0])) / (12 * step);
}

static const double steps[4] = {-2, -1, 1, 2};

static double pressure_slope(const struct scene *s, const double x[3], int d, double step)
{
    double P[4];
    for (int k = 0; k < 4; k++) {
        struct problem_state state;
        double place[3] = {x[0], x[1], x[2]};
        place[d] += steps[k] * step;
        problem_sample(&s->run->problem, place, s->time, &state);
        P[k] = state.P;
    }
    return slope(P, step);
}

/* Differentiates along the flow; the time step is the one in which sound travels the step in
 * space. */
static void inertia(const struct scene *s, size_t i, const double x[3],
                    const struct problem_state *here, double step)
{
    const struct prepared *p = &s->run->problem;
    const double dt = step / sqrt(p->gamma * here->P / here->rho);
    double v[3][4];
    for (int k = 0; k < 4; k++) {
        struct problem_state state;
        double place[3] = {x[0], x[1], x[2]};
        for (int d = 0; d < p->domain.dim; d++) place[d] += steps[k] * dt * here->v[d];
        problem_sample(p, place, s->time + steps[k] * dt, &state);
        for (int d = 0; d < 3; d++) v[d][k] = state.v[d];
    }
    for (int d = 0; d < p->domain.dim; d++) s->inertia[d][i] = slope(v[d], dt);
}

/* Steps are small against the spacing, so that few particles are affected by a kink of the
 * solution, and large against round-off. At t = 0 there is no earlier state, and inertia stays
 * unset. */
static void fill_exact(const struct scene *s)
{
    const struct prepared *p = &s->run->problem;
    const double step = 1e-3 * s->spacing;
    for (size_t i = 0; i < s->n; i++) {
        struct problem_state state;
        double x[3] = {0};
        for (int d = 0; d < p->domain.dim; d++) x[d] = s->x[d][i];
        problem_sample(p, x, s->time, &state);
        s->u[i] = state.u;
        s->P[i] = state.P;
        s->rho[i] = state.rho;
        for (int d = 0; d < p->domain.dim; d++) {
            s->v[d][i] = state.v[d];
            s->exact[d][i] = p->gravity[d] - pressure_slope(s, x, d, step) / state.rho;
        }
        if (s->time > 0) inertia(s, i, x, &state, step);
        const struct snapshot one = {.n = 1,
                                     .x = {&x[0], &x[1], &x[2]},
                                     .m = &s->m[i],
                                     .rho = &state.rho,
                                     .volume = &(double){s->m[i] / state.rho},
                                     .time = s->time};
        s->weight[i] = problem_window_part(p, &one, 0);
    }
}

/* x belongs to the caller and must outlive the scene. */
static enum status scene_make(struct scene *s, const struct run *run, size_t n, double time,
                              double *const x[3], const double *m, struct error *error)
{
    enum { ARRAYS = 14 };
    const struct domain *domain = &run->problem.domain;
    double volume = 1, *next = calloc(ARRAYS * n, sizeof *next);
    for (int d = 0; d < domain->dim; d++) volume *= domain_length(domain, d);
    *s = (struct scene){.run = run, .n = n, .time = time, .storage = next};
    s->spacing = pow(volume / (double)n, 1. / domain->dim);
    if (!next) return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu particles", n);
    double **const arrays[ARRAYS] = {&s->m,          &s->rho,        &s->v[0],       &s->v[1],
                                     &s->v[2],       &s->exact[0],   &s->exact[1],   &s->exact[2],
                                     &s->inertia[0], &s->inertia[1], &s->inertia[2], &s->u,
                                     &s->P,          &s->weight};
    for (int k = 0; k < ARRAYS; k++, next += n) *arrays[k] = next;
    for (int d = 0; d < domain->dim; d++) s->x[d] = x[d];
    memcpy(s->m, m, n * sizeof *m);
    fill_exact(s);
    return autopsy_cells_make(&s->cells, &run->problem, n, s->x, s->weight, error);
}

static void scene_free(struct scene *s)
{
    autopsy_cells_free(&s->cells);
    free(s->storage);
    s->storage = NULL;
}

/* ---- evaluations ---- */

/* Evaluates the scene's particles once with the energies u; the table has accelerations in place of
 * forces. */
static enum status evaluate_as(const struct scene *s, const struct scheme *scheme, double *u,
                               struct rate_table *table, struct error *error)
{
    const struct initial initial = {.n = s->n,
                                    .x = {s->x[0], s->x[1], s->x[2]},
                                    .v = {s->v[0], s->v[1], s->v[2]},
                                    .m = s->m,
                                    .u = u};
    struct setup setup = run_setup(s->run, &initial);
    setup.scheme = *scheme;
    setup.skip = false;
    const enum status status = rate_table_make(table, &setup, error);
    for (int d = 0; !status && d < setup.dim; d++)
        for (size_t i = 0; i < s->n; i++) table->force[d][i] /= s->m[i];
    return status;
}

/* Evaluates without viscosity. */
static enum status evaluate(const struct scene *s, double *u, struct rate_table *table,
                            struct error *error)
{
    struct scheme scheme = s->run->scheme;
    scheme.viscosity = VISCOSITY_NONE;
    return evaluate_as(s, &scheme, u, table, error);
}

/* The size of one field after subtraction of another, independent one. */
static struct autopsy_split more(struct autopsy_split one, struct autopsy_split other)
{
    const double noise = fmax(0, one.noise * one.noise - other.noise * other.noise),
                 whole = fmax(noise, one.rms * one.rms - other.rms * other.rms);
    return (struct autopsy_split){sqrt(whole), sqrt(noise), fmax(0, one.along - other.along)};
}

/* ---- initial positions ---- */

/* Initial particles with this jitter, in spacings; random positions become a lattice first. */
static enum status lay(const struct run *run, const char *jitter, struct initial *initial,
                       struct error *error)
{
    struct run_settings asked = run->asked;
    struct run other;
    const enum lattice lattice = (enum lattice)settings_choice(&run->settings, SETTING_lattice);
    enum status status = STATUS_OK;
    asked.settings.shared = true; /* these positions may not depend on the seed */
    if (lattice == LATTICE_JITTERED || lattice == LATTICE_RANDOM || lattice == LATTICE_GLASS)
        status = settings_set(&asked.settings, SETTING_lattice, "auto", SOURCE_USER, NULL, error);
    if (!status)
        status = settings_set(&asked.settings, SETTING_jitter, jitter, SOURCE_USER, NULL, error);
    if (!status) status = run_resolve(&other, &asked, error);
    return status ? status : initial_create(initial, &other.problem, &other.settings, error);
}

/* Sets the energies so that the pressures are exact, times the mean ratio of the density to the
 * exact one at regular positions: no gradient depends on that factor. */
static void correct_energy(struct scene *s, const struct rate_table *table, double factor)
{
    for (size_t i = 0; i < s->n; i++) s->u[i] *= factor * s->P[i] / table->P[i];
}

/* At regular positions: mean ratio of the density to the exact one, and L1 of the density. */
static void look_at_density(const struct scene *s, const struct rate_table *table, double *factor,
                            double *l1)
{
    double sum = 0, off = 0, weight = 0;
    for (size_t i = 0; i < s->n; i++) {
        sum += s->weight[i] * table->P[i] / s->P[i];
        off += s->weight[i] * fabs(table->rho[i] - s->rho[i]);
        weight += s->weight[i];
    }
    *factor = sum / weight;
    *l1 = off / weight;
}

static enum status look_at_regular(struct scene *s, struct autopsy_level *level,
                                   struct error *error)
{
    struct rate_table table = {0}, corrected = {0};
    enum status status = evaluate(s, s->u, &table, error);
    if (!status) {
        look_at_density(s, &table, &level->compression, &level->density_regular);
        correct_energy(s, &table, level->compression);
        status = evaluate(s, s->u, &corrected, error);
    }
    if (!status) {
        level->size[AUTOPSY_DENSITY] = autopsy_split(&s->cells, table.force, corrected.force);
        level->size[AUTOPSY_OPERATOR] = autopsy_split(&s->cells, corrected.force, s->exact);
        level->regular = level->size[AUTOPSY_OPERATOR].rms;
    }
    rate_table_free(&table);
    rate_table_free(&corrected);
    return status;
}

/* Error of the acceleration without viscosity for exact velocities, pressures and, through changed
 * masses, densities: only the positions are those of the run. */
static enum status look_at_positions(struct scene *s, double compression, struct rate_table *table,
                                     struct autopsy_split *size, struct error *error)
{
    struct rate_table first = {0}, second = {0};
    enum status status = evaluate(s, s->u, &first, error);
    for (size_t i = 0; !status && i < s->n; i++) s->m[i] *= compression * s->rho[i] / first.rho[i];
    if (!status) status = evaluate(s, s->u, &second, error);
    if (!status) correct_energy(s, &second, compression);
    rate_table_free(&first);
    rate_table_free(&second);
    if (!status) status = evaluate(s, s->u, table, error);
    if (!status) *size = autopsy_split(&s->cells, table->force, s->exact);
    return status;
}

static enum status look_at_jittered(struct scene *s, struct autopsy_level *level,
                                    struct error *error)
{
    struct rate_table table = {0};
    struct autopsy_split size = {0};
    const enum status status = look_at_positions(s, level->compression, &table, &size, error);
    level->jittered = size.rms;
    rate_table_free(&table);
    return status;
}

typedef enum status look(struct scene *s, struct autopsy_level *level, struct error *error);

static enum status look_at_start(const struct run *run, const char *jitter, look *look_at,
                                 struct autopsy_level *level, struct error *error)
{
    struct initial initial = {0};
    struct scene scene = {0};
    enum status status = lay(run, jitter, &initial, error);
    if (!status) status = scene_make(&scene, run, initial.n, 0, initial.x, initial.m, error);
    if (!status) status = look_at(&scene, level, error);
    scene_free(&scene);
    initial_free(&initial);
    return status;
}

/* ---- the run's own positions ---- */

/* The error that the run's own measure finds for exact velocities at its particles. */
static enum status judge_exact(const struct scene *s, const struct snapshot *end, double *l1,
                               struct error *error)
{
    struct run_result judged;
    struct snapshot exact = *end;
    size_t *id = malloc(s->n * sizeof *id);
    if (!id) return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu particles", s->n);
    for (size_t i = 0; i < s->n; i++) id[i] = i;
    exact.id = id;
    for (int d = 0; d < s->run->problem.domain.dim; d++) exact.v[d] = s->v[d];
    const enum status status = run_judge(s->run, &exact, &judged, error);
    free(id);
    if (status) return status;
    *l1 = judged.errors[FIELD_VELOCITY].l1;
    run_free(&judged);
    return STATUS_OK;
}

/* Fractions of the acceleration below which an error is round-off: of sums, and of difference
 * quotients. */
static const double round_off = 1e-9, quotient = 1e-6;

static double mean_energy(const struct scene *s)
{
    double sum = 0;
    for (size_t i = 0; i < s->n; i++) sum += s->u[i];
    return sum / (double)s->n;
}

/* The rate at which conductivity, the difference between two evaluations, changes pressures, over
 * rho c: a wave loses velocity at this rate in whichever direction it travels. */
static enum status look_at_conductivity(const struct scene *s, const struct rate_table *with,
                                        const struct rate_table *without,
                                        struct autopsy_level *level, struct error *error)
{
    const double gamma = s->run->problem.gamma, c = sqrt(gamma * (gamma - 1) * mean_energy(s));
    double *rate = calloc(2 * s->n, sizeof *rate);
    if (!rate) return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu particles", s->n);
    double *const none = rate + s->n, *const rates[3] = {rate, none, none};
    struct autopsy_split *size = &level->size[AUTOPSY_CONDUCTION];
    for (size_t i = 0; i < s->n; i++)
        rate[i] = (gamma - 1) * (with->dU[i] - without->dU[i]) / (s->m[i] * c);
    *size = autopsy_split(&s->cells, rates, NULL);
    size->along = sqrt(size->rms * size->rms - size->noise * size->noise);
    free(rate);
    return STATUS_OK;
}

/* Measures the dissipative terms one by one. plain: rates without any of them. */
static enum status look_at_dissipation(const struct scene *s, const struct rate_table *plain,
                                       struct autopsy_level *level, struct error *error)
{
    struct scheme scheme = s->run->scheme;
    const bool conducts = scheme_conducts(&scheme);
    struct rate_table whole = {0}, calm = {0}, quiet = {0};
    enum status status = evaluate_as(s, &scheme, s->u, &whole, error);
    scheme.alpha_u = scheme.shock_conductivity = 0;
    if (!status && conducts) status = evaluate_as(s, &scheme, s->u, &calm, error);
    if (!status && conducts) status = look_at_conductivity(s, &whole, &calm, level, error);
    scheme.noise = 0;
    if (!status) status = evaluate_as(s, &scheme, s->u, &quiet, error);
    if (!status) {
        level->size[AUTOPSY_VISCOSITY] = autopsy_split(&s->cells, plain->force, quiet.force);
        level->size[AUTOPSY_NOISE_TERM] = autopsy_split(&s->cells, quiet.force, whole.force);
    }
    rate_table_free(&whole);
    rate_table_free(&calm);
    rate_table_free(&quiet);
    return status;
}

static enum status look_at_own(struct scene *s, const struct snapshot *end,
                               struct autopsy_level *level, struct error *error)
{
    struct rate_table table = {0};
    struct autopsy_split own = {0}, *reference = &level->size[AUTOPSY_REFERENCE];
    double *const v[3] = {(double *)end->v[0], (double *)end->v[1], (double *)end->v[2]};
    enum status status = judge_exact(s, end, &level->size[AUTOPSY_MEASURE].rms, error);
    level->velocity = autopsy_split(&s->cells, v, s->v);
    level->round_off = 1e-13 * mean_energy(s) / s->spacing;
    level->acceleration = autopsy_split(&s->cells, s->exact, NULL).rms;
    *reference = autopsy_split(&s->cells, s->inertia, s->exact);
    if (reference->rms < quotient * level->acceleration) *reference = (struct autopsy_split){0};
    autopsy_cells_aim(&s->cells, v, s->v);
    if (!status) status = look_at_positions(s, level->compression, &table, &own, error);
    if (!status) status = look_at_dissipation(s, &table, level, error);
    level->own = own.rms;
    level->size[AUTOPSY_DISORDER] = more(own, level->size[AUTOPSY_OPERATOR]);
    rate_table_free(&table);
    return status;
}

static enum status look_at_end(const struct run *run, const struct run_result *result,
                               struct autopsy_level *level, struct error *error)
{
    const struct snapshot *end = &result->snapshot;
    struct scene scene = {0};
    double *const x[3] = {(double *)end->x[0], (double *)end->x[1], (double *)end->x[2]};
    enum status status = scene_make(&scene, run, end->n, end->time, x, end->m, error);
    if (!status) status = look_at_own(&scene, end, level, error);
    scene_free(&scene);
    return status;
}

static enum status look_at_result(const struct run *run, const struct run_result *result,
                                  const struct regularity *regularity, struct autopsy_level *level,
                                  struct error *error)
{
    level->n = result->n;
    level->spacing = result->spacing;
    level->density = result->errors[FIELD_DENSITY].l1;
    level->regularity = *regularity;
    enum status status = look_at_start(run, "0", look_at_regular, level, error);
    if (!status) status = look_at_start(run, "0.2", look_at_jittered, level, error);
    return status ? status : look_at_end(run, result, level, error);
}

/* ---- a level ---- */

/* Time step and measure have their shares of the error itself. The other parts divide the rest: the
 * error's noise in proportion to the squares of their noise, as for independent errors; the smooth
 * error in proportion to their smooth components, along it where the error moves with the flow, as
 * for errors that add up. */
static void divide(struct autopsy_level *level)
{
    double *share = level->share, noise = 0, smooth = 0;
    const double error = level->error[0];
    const double least = fmax(round_off * level->acceleration, level->round_off);
    struct autopsy_split *size = level->size;
    size[AUTOPSY_TIME_STEP].rms = fmax(0, error - level->error[2]);
    share[AUTOPSY_MEASURE] = fmin(1, size[AUTOPSY_MEASURE].rms / error);
    share[AUTOPSY_TIME_STEP] =
        fmin(1 - share[AUTOPSY_MEASURE], size[AUTOPSY_TIME_STEP].rms / error);
    for (int k = AUTOPSY_REFERENCE; k < AUTOPSY_PARTS; k++) {
        if (size[k].rms < least) size[k] = (struct autopsy_split){0};
        noise += size[k].noise * size[k].noise;
        smooth += size[k].along;
    }
    const double rest = 1 - share[AUTOPSY_MEASURE] - share[AUTOPSY_TIME_STEP],
                 part = level->velocity.noise / level->velocity.rms,
                 noisy = !(noise > 0)    ? 0
                         : !(smooth > 0) ? 1
                                         : part * part;
    for (int k = AUTOPSY_REFERENCE; k < AUTOPSY_PARTS; k++) {
        const double own = size[k].noise * size[k].noise;
        share[k] = rest * ((noise > 0 ? noisy * own / noise : 0) +
                           (smooth > 0 ? (1 - noisy) * size[k].along / smooth : 0));
    }
}

enum status autopsy_measure(const struct run *run, struct autopsy_level *level, struct trace *trace,
                            struct error *error)
{
    enum status status = STATUS_OK;
    *level = (struct autopsy_level){0};
    for (int k = 2; !status && k >= 0; k--) {
        struct run finer = *run;
        struct run_result result;
        finer.scheme.cfl /= 1 << k;
        finer.asked.trace = k == 0 ? trace : NULL;
        status = run_execute(&finer, &result, error);
        if (status && status != STATUS_BROKE_DOWN) return status;
        level->error[k] = result.errors[FIELD_VELOCITY].l1;
        if (!status && k == 0)
            status = look_at_result(run, &result, &result.regularity, level, error);
        if (!status && k == 0) status = autopsy_power(run, &result.snapshot, level->power, error);
        run_free(&result);
    }
    if (!status) divide(level);
    return status;
}

enum status autopsy_measure_theirs(const struct run *run, const struct run_result *result,
                                   struct autopsy_level *level, struct error *error)
{
    struct run plain = *run;
    plain.scheme.viscosity = VISCOSITY_NONE;
    plain.scheme.alpha_u = plain.scheme.shock_conductivity = 0;
    *level = (struct autopsy_level){0};
    for (int k = 0; k < 3; k++) level->error[k] = result->errors[FIELD_VELOCITY].l1;
    const struct regularity seen =
        regularity_of(&run->problem, &run->scheme.kernel, &result->snapshot, run->asked.threads);
    const enum status status = look_at_result(&plain, result, &seen, level, error);
    if (!status) divide(level);
    return status;
}
