/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bench_kernels.h"

#include <assert.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_cells.h"
#include "bench_limit.h"
#include "bench_loops.h"
#include "gradient_study.h"
#include "plugin_kernel.h"
#include "run.h"

enum { VARIANTS = 3, LIST = 1024 };
enum { SOLVER_ROWS_MAX = 4 }; /* rows of a kernel and a gradient, see add_solver */
enum { CELLS_ROWS = 10 };     /* rows of a kernel in 2D or 3D, see add_cells */
enum variant { SPECIALISED, GENERIC, LIMIT };

/* A measurement, from which a column of a row is made. */
struct job {
    enum { JOB_NONE, JOB_LOOPS, JOB_CELLS, JOB_STEP, JOB_OPERATOR, JOB_LIMIT, JOB_NEAR } kind;
    double pairs, particles; /* of the work, done once */
    struct bench_loops loops;
    struct bench_cells cells;
    struct run *run;
    struct operator_settings settings;
    const struct clouds_cloud *cloud;
    const double *field;
    double *gradient[3]; /* into the bench's scratch */
    bench_limit_loop *limit;
    const struct bench_neighbours *list;
    const float *places[3]; /* LIST of them */
    int dim;
    size_t near; /* neighbours found; stored so that the compiler keeps the work */
};

struct bench {
    struct kernel *kernels;
    size_t kernel_count, row_count, row_max;
    struct job *jobs; /* VARIANTS a row */
    struct clouds_settings cloud_settings[KERNEL_DIM_MAX];
    struct clouds_cloud clouds[KERNEL_DIM_MAX];
    double *fields[KERNEL_DIM_MAX], *scratch;
    struct bench_neighbours lists[KERNEL_DIM_MAX];
    double *list_memory;
    float places[3][LIST]; /* positions in cells around the ball of radius 1 */
    struct bench_kernels *result;
};

/* --- the work --------------------------------------------------------------------------------- */

static enum status step_work(struct job *job, uint64_t times, struct clock_taken *taken,
                             struct error *error)
{
    for (uint64_t i = 0; i < times; i++) {
        struct run_result result;
        const enum status status = run_execute(job->run, &result, error);
        if (!status) {
            taken->wall_s += result.cost.wall_s;
            taken->cpu_s += result.cost.cpu_s;
            job->pairs = (double)result.cost.pair_interactions;
            job->particles = (double)result.cost.particle_updates;
        }
        if (!status || status == STATUS_BROKE_DOWN) run_free(&result);
        if (status) return status;
    }
    return STATUS_OK;
}

static enum status work(void *context, uint64_t times, struct clock_taken *taken,
                        struct error *error)
{
    struct job *job = context;
    if (job->kind == JOB_LOOPS) return bench_loops_work(&job->loops, times, taken, error);
    if (job->kind == JOB_CELLS) return bench_cells_work(&job->cells, times, taken, error);
    if (job->kind == JOB_STEP) return step_work(job, times, taken, error);
    enum status status = STATUS_OK;
    const struct clock_taken start = clock_now();
    for (uint64_t i = 0; i < times && !status; i++) {
        double sums[BENCH_LIMIT_SUMS];
        uint64_t pairs;
        if (job->kind == JOB_LIMIT) {
            job->limit(job->settings.kernel, job->list, sums);
        } else if (job->kind == JOB_NEAR) {
            job->near += bench_limit_near(job->dim, LIST, job->places);
        } else {
            status = operator_apply(&job->settings, &job->cloud->cloud, 1, &job->field,
                                    job->gradient, NULL, &pairs, error);
            job->pairs = (double)pairs;
        }
    }
    clock_add(taken, &start);
    return status;
}

/* --- set-up ----------------------------------------------------------------------------------- */

/* Random neighbours inside the ball of radius 1. */
static void make_list(struct bench *bench, int dim, gsl_rng *rng)
{
    struct bench_neighbours *list = &bench->lists[dim - 1];
    double *memory = bench->list_memory + (size_t)(dim - 1) * 5 * LIST;
    for (size_t m = 0; m < LIST; m++) {
        double x[3], r2;
        do {
            r2 = 0;
            for (int a = 0; a < dim; a++) {
                x[a] = 2 * gsl_rng_uniform(rng) - 1;
                r2 += x[a] * x[a];
            }
        } while (r2 >= 1);
        for (int a = 0; a < dim; a++) memory[(size_t)a * LIST + m] = x[a];
        memory[3 * LIST + m] = 1. / LIST;
        memory[4 * LIST + m] = gsl_rng_uniform(rng);
    }
    *list = (struct bench_neighbours){.n = LIST,
                                      .x = {memory, memory + LIST, memory + 2 * LIST},
                                      .volume = memory + 3 * LIST,
                                      .f = memory + 4 * LIST};
}

static enum status make_clouds(struct bench *bench, struct error *error)
{
    static const size_t side[] = {4096, 64, 16};
    size_t most = 0;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    bench->list_memory = calloc((size_t)KERNEL_DIM_MAX * 5 * LIST, sizeof(double));
    if (!bench->list_memory) goto no_memory;
    for (int dim = 1; dim <= KERNEL_DIM_MAX; dim++) {
        struct clouds_settings *settings = &bench->cloud_settings[dim - 1];
        struct clouds_cloud *cloud = &bench->clouds[dim - 1];
        *settings = gradient_study_cloud(CLOUDS_JITTERED, dim);
        settings->side = side[dim - 1];
        settings->jitter = 0.2;
        if (clouds_make(settings, cloud, error)) goto failed;
        const size_t n = cloud->cloud.points.n;
        double *field = bench->fields[dim - 1] = malloc(n * sizeof *field);
        if (!field) goto no_memory;
        for (size_t i = 0; i < n; i++) {
            double x[3] = {0}, gradient[3];
            for (int a = 0; a < dim; a++) x[a] = cloud->x[a][i];
            field[i] = gradient_study_field(FUNCTION_SMOOTH, dim, x, gradient);
        }
        make_list(bench, dim, rng);
        if (n > most) most = n;
    }
    for (int a = 0; a < 3; a++)
        for (size_t m = 0; m < LIST; m++)
            bench->places[a][m] = (float)(3 * gsl_rng_uniform(rng) - 1.5);
    bench->scratch = malloc(3 * most * sizeof(double));
    if (!bench->scratch) goto no_memory;
    for (size_t k = 0; k < bench->row_max * VARIANTS; k++)
        for (size_t a = 0; a < 3; a++) bench->jobs[k].gradient[a] = bench->scratch + a * most;
    gsl_rng_free(rng);
    return STATUS_OK;
no_memory:
    error_set(error, STATUS_ENVIRONMENT, "no memory for clouds of points");
failed:
    gsl_rng_free(rng);
    return error->status;
}

static struct job *new_row(struct bench *bench, const char *kernel, const char *what, int dim,
                           bool on_cloud)
{
    assert(bench->row_count < bench->row_max);
    const size_t row = bench->row_count++;
    bench->result->rows[row] = (struct bench_kernel_row){.kernel = kernel,
                                                         .what = what,
                                                         .dim = dim,
                                                         .on_cloud = on_cloud,
                                                         .whole = row,
                                                         .share = (double)NAN,
                                                         .error = (double)NAN};
    return &bench->jobs[row * VARIANTS];
}

static enum status prepare_loops(struct job *job, const struct scheme *scheme, bool specialised,
                                 unsigned passes, struct error *error)
{
    job->kind = JOB_LOOPS;
    if (bench_loops_create(&job->loops, scheme, BENCH_LOOPS_PARTICLES, specialised, passes, error))
        return error->status;
    job->pairs = (double)job->loops.pairs;
    job->particles = BENCH_LOOPS_PARTICLES;
    return STATUS_OK;
}

/* Adds jobs for the solver with one kernel and gradient: each loop, and whole steps of a sound
 * wave. */
static enum status add_solver(struct bench *bench, const char *kernel, const char *gradient,
                              struct error *error)
{
    static const struct {
        const char *name;
        unsigned passes;
        bool ia, both; /* only with ia; with both gradients, and named after the gradient */
    } loops[SOLVER_ROWS_MAX - 1] = {
        {"density", 1u << PASS_DENSITY, false, false},
        {"matrix", 1u << PASS_MATRIX, true, false},
        {"force", 1u << PASS_FORCE, false, true},
    };
    const bool ia = strcmp(gradient, "ia") == 0;
    char keys[2][SETTING_TEXT_MAX + 16];
    snprintf(keys[0], sizeof keys[0], "kernel=%s", kernel);
    snprintf(keys[1], sizeof keys[1], "gradient=%s", gradient);
    char *arguments[] = {keys[0],  keys[1],     "viscosity=constant",
                         "n=1600", "skip=none", "t_end=0.1"};
    struct run_settings asked;
    struct run *run = malloc(sizeof *run);
    if (!run) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    struct job *step = new_row(bench, kernel, ia ? "step ia" : "step standard", 1, false);
    step[SPECIALISED].run = run; /* owned by the first job */
    if (run_prepare(&asked, "sound_wave", sizeof arguments / sizeof *arguments, arguments, error) ||
        run_resolve(run, &asked, error))
        return error->status;
    for (enum variant v = SPECIALISED; v <= GENERIC; v++) {
        step[v].kind = JOB_STEP;
        if (v == GENERIC && !(step[v].run = malloc(sizeof *run)))
            return error_set(error, STATUS_ENVIRONMENT, "no memory");
        *step[v].run = *run;
        step[v].run->asked.generic = v == GENERIC;
    }
    const unsigned all =
        1u << PASS_STATE | 1u << PASS_DENSITY | 1u << PASS_MATRIX | 1u << PASS_FORCE;
    if (prepare_loops(&step[LIMIT], &run->scheme, true, all, error)) return error->status;
    for (size_t l = 0; l < sizeof loops / sizeof *loops; l++) {
        if (loops[l].ia != ia && !loops[l].both) continue;
        const char *name = !loops[l].both ? loops[l].name : ia ? "force ia" : "force standard";
        struct job *job = new_row(bench, kernel, name, 1, false);
        for (enum variant v = SPECIALISED; v <= GENERIC; v++)
            if (prepare_loops(&job[v], &run->scheme, v == SPECIALISED, loops[l].passes, error))
                return error->status;
    }
    return STATUS_OK;
}

/* A lower limit for a pass: the arithmetic of a gradient operator on one contiguous array, `times`
 * times. */
static void set_limit(const struct bench *bench, struct job *limit, const struct kernel *kernel,
                      const char *form, int dim, double times)
{
    for (size_t o = 0; o < operator_family.n; o++) {
        if (strcmp(operator_family.members[o]->name, form) != 0) continue;
        limit->settings = (struct operator_settings){.kernel = kernel, .threads = 1};
        limit->list = &bench->lists[dim - 1];
        limit->limit =
            bench_limit_find(kernel, (const struct operator_form *)operator_family.members[o], dim);
        limit->kind = limit->limit ? JOB_LIMIT : JOB_NONE;
        limit->pairs = LIST / times;
    }
}

/* Textbook SPH; with the Integral Approach; the solver's defaults. */
enum cells_scheme { CELLS_STANDARD, CELLS_IA, CELLS_DEFAULT };

/* An evaluation in 2D or 3D and its parts; the first row of a scheme is the whole evaluation. */
static const struct {
    const char *what;
    unsigned passes;
    enum cells_scheme scheme;
    const char *limit; /* the operator, and how often; NULL: of the search, or of all parts */
    double times;
} cells_rows[CELLS_ROWS] = {
    {"evaluation standard", CELLS_EVALUATION, CELLS_STANDARD, NULL, 0},
    {"search", CELLS_SEARCH, CELLS_STANDARD, NULL, 0},
    {"density", CELLS_DENSITY, CELLS_STANDARD, "standard", 1},
    {"force standard", CELLS_FORCE, CELLS_STANDARD, "standard", 2},
    {"evaluation ia", CELLS_EVALUATION, CELLS_IA, NULL, 0},
    {"matrix", CELLS_MATRIX, CELLS_IA, "linear_exact", 1},
    {"force ia", CELLS_FORCE, CELLS_IA, "standard", 2},
    {"evaluation default", CELLS_EVALUATION, CELLS_DEFAULT, NULL, 0},
    {"matrix default", CELLS_MATRIX, CELLS_DEFAULT, "linear_exact", 1},
    {"force default", CELLS_FORCE, CELLS_DEFAULT, "standard", 2},
};

/* The solver's defaults with a kernel, and for the first two a gradient and viscosity=constant. */
static enum status cloud_scheme(const struct kernel *kernel, enum cells_scheme which, int dim,
                                struct scheme *scheme, struct error *error)
{
    char key[64];
    char *arguments[] = {key, which == CELLS_IA ? "gradient=ia" : "gradient=standard",
                         "viscosity=constant"};
    const int given = which == CELLS_DEFAULT ? 1 : 3;
    struct run_settings asked;
    struct run *run = malloc(sizeof *run);
    if (!run) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    snprintf(key, sizeof key, "kernel=%s", kernel->member.name);
    enum status status =
        run_prepare(&asked, dim == 2 ? "sound_wave_2d" : "sound_wave_3d", given, arguments, error);
    if (!status) status = run_resolve(run, &asked, error);
    if (!status) *scheme = run->scheme;
    free(run);
    return status;
}

static enum status add_cells(struct bench *bench, const struct kernel *kernel, int dim,
                             struct error *error)
{
    static const size_t side[] = {0, 0, 64, 16};
    size_t whole = 0;
    for (size_t r = 0; r < CELLS_ROWS; r++) {
        struct scheme scheme;
        if (cloud_scheme(kernel, cells_rows[r].scheme, dim, &scheme, error)) return error->status;
        struct job *job = new_row(bench, kernel->member.name, cells_rows[r].what, dim, false);
        if (cells_rows[r].passes == CELLS_EVALUATION) whole = bench->row_count - 1;
        bench->result->rows[bench->row_count - 1].whole = whole;
        for (enum variant v = SPECIALISED; v <= GENERIC; v++) {
            job[v].kind = JOB_CELLS;
            if (bench_cells_create(&job[v].cells, &scheme, dim, side[dim], v == SPECIALISED,
                                   cells_rows[r].passes, error))
                return error->status;
            job[v].pairs = job[v].cells.pairs;
            job[v].particles = (double)job[v].cells.fields.n;
        }
        if (cells_rows[r].limit)
            set_limit(bench, &job[LIMIT], kernel, cells_rows[r].limit, dim, cells_rows[r].times);
        if (cells_rows[r].passes == CELLS_SEARCH)
            job[LIMIT] =
                (struct job){.kind = JOB_NEAR,
                             .pairs = LIST / bench_limit_candidates(dim),
                             .places = {bench->places[0], bench->places[1], bench->places[2]},
                             .dim = dim};
    }
    return STATUS_OK;
}

static enum status add_operator(struct bench *bench, const struct kernel *kernel,
                                const struct operator_form *form, int dim, struct error *error)
{
    struct job *job = new_row(bench, kernel->member.name, form->member.name, dim, true);
    struct bench_kernel_row *row = &bench->result->rows[bench->row_count - 1];
    const struct gradient_subject subject = {.form = form};
    const struct clouds_cloud *cloud = &bench->clouds[dim - 1];
    struct gradient_errors errors;
    if (gradient_study_errors(&subject, kernel, &bench->cloud_settings[dim - 1], cloud,
                              FUNCTION_SMOOTH, &errors, error))
        return error->status;
    row->error = errors.interior_rms;
    for (enum variant v = SPECIALISED; v <= LIMIT; v++) {
        job[v].kind = v == LIMIT ? JOB_LIMIT : JOB_OPERATOR;
        job[v].settings = (struct operator_settings){
            .form = form, .kernel = kernel, .generic = v == GENERIC, .threads = 1};
        job[v].cloud = cloud;
        job[v].field = bench->fields[dim - 1];
        job[v].particles = (double)cloud->cloud.points.n;
    }
    job[LIMIT].list = &bench->lists[dim - 1];
    job[LIMIT].limit = bench_limit_find(kernel, form, dim);
    if (!job[LIMIT].limit) job[LIMIT].kind = JOB_NONE;
    job[LIMIT].pairs = LIST;
    return STATUS_OK;
}

static enum status choose_kernels(struct bench *bench, const struct sweep *sweep,
                                  struct error *error)
{
    if (sweep->key_count > 1 || (sweep->key_count && sweep->keys[0].key != SETTING_kernel))
        return error_set(error, STATUS_BAD_INPUT,
                         "bench --kernels: --vary %s: allowed: kernel or kernel=A,B,...",
                         setting_keys[sweep->keys[sweep->key_count - 1].key].name);
    bench->kernel_count = sweep->key_count ? sweep->keys[0].count : kernel_family.n;
    bench->kernels = calloc(bench->kernel_count, sizeof *bench->kernels);
    if (!bench->kernels) return error_set(error, STATUS_ENVIRONMENT, "no memory for kernels");
    for (size_t k = 0; k < bench->kernel_count; k++) {
        const char *name =
            sweep->key_count ? sweep->keys[0].values[k] : kernel_family.members[k]->name;
        const int index = kernel_index(name);
        for (int dim = 1; dim <= KERNEL_DIM_MAX; dim++)
            if (plugin_select(&bench->kernels[k], index, 5, dim, error)) return error->status;
    }
    bench->row_max =
        bench->kernel_count * ((KERNEL_DIM_MAX - 1) * CELLS_ROWS +
                               SOLVER_ROWS_MAX * scheme_members(&scheme_gradient_family, 1) +
                               KERNEL_DIM_MAX * operator_family.n);
    bench->jobs = calloc(bench->row_max * VARIANTS, sizeof *bench->jobs);
    bench->result->rows = calloc(bench->row_max, sizeof *bench->result->rows);
    if (bench->jobs && bench->result->rows) return STATUS_OK;
    return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu measurements", bench->row_max);
}

static enum status set_up(struct bench *bench, const struct sweep *sweep, struct error *error)
{
    if (choose_kernels(bench, sweep, error) || make_clouds(bench, error)) return error->status;
    for (size_t k = 0; k < bench->kernel_count; k++) {
        const struct kernel *kernel = &bench->kernels[k];
        for (size_t g = 0; g < scheme_members(&scheme_gradient_family, 1); g++)
            if (add_solver(bench, kernel->member.name, scheme_gradient_family.members[g]->name,
                           error))
                return error->status;
        for (int dim = 2; dim <= KERNEL_DIM_MAX; dim++)
            if (add_cells(bench, kernel, dim, error)) return error->status;
        for (int dim = 1; dim <= KERNEL_DIM_MAX; dim++)
            for (size_t o = 0; o < operator_family.n; o++)
                if (add_operator(bench, kernel,
                                 (const struct operator_form *)operator_family.members[o], dim,
                                 error))
                    return error->status;
    }
    return STATUS_OK;
}

static void clean_up(struct bench *bench)
{
    for (size_t k = 0; bench->jobs && k < bench->row_max * VARIANTS; k++) {
        if (bench->jobs[k].kind == JOB_LOOPS) bench_loops_free(&bench->jobs[k].loops);
        if (bench->jobs[k].kind == JOB_CELLS) bench_cells_free(&bench->jobs[k].cells);
        free(bench->jobs[k].run);
    }
    for (int dim = 0; dim < KERNEL_DIM_MAX; dim++) {
        clouds_free(&bench->clouds[dim]);
        free(bench->fields[dim]);
    }
    free(bench->jobs), free(bench->scratch), free(bench->list_memory), free(bench->kernels);
}

/* The limit of an evaluation is the sum over its parts; with ia it also includes the search and the
 * density. */
static void add_limits(struct bench_kernels *result)
{
    double parts = 0;
    for (size_t r = 0; r < result->count; r++) {
        const struct bench_kernel_row *row = &result->rows[r];
        if (row->whole == r) continue;
        double *limit = &result->rows[row->whole].limit.ns_per_pair;
        const bool first = row->whole + 1 == r;
        if (first) *limit = strcmp(row->what, "search") == 0 ? 0 : parts;
        *limit += row->limit.ns_per_pair;
        if (strcmp(row->what, "density") == 0) parts = *limit;
    }
}

static struct bench_cost cost_of(const struct job *job, const struct bench_subject *subject)
{
    if (job->kind == JOB_NONE || subject->failure.status)
        return (struct bench_cost){(double)NAN, (double)NAN};
    return (struct bench_cost){1e9 * subject->time.cpu_s / job->pairs, subject->time.spread};
}

enum status bench_kernels_measure(const struct sweep *sweep, const struct bench_rules *rules,
                                  struct bench_kernels *result, struct error *error)
{
    struct bench bench = {.result = result};
    struct bench_subject *subjects = NULL;
    *result = (struct bench_kernels){0};
    enum status status = set_up(&bench, sweep, error);
    if (status) goto end;
    subjects = calloc(bench.row_count * VARIANTS, sizeof *subjects);
    if (!subjects) {
        status = error_set(error, STATUS_ENVIRONMENT, "no memory");
        goto end;
    }
    size_t count = 0;
    for (size_t k = 0; k < bench.row_count * VARIANTS; k++)
        if (bench.jobs[k].kind != JOB_NONE)
            subjects[count++] = (struct bench_subject){.work = work, .context = &bench.jobs[k]};
    if ((status = bench_measure(subjects, count, rules, error))) goto end;
    result->count = bench.row_count;
    const struct bench_subject *next = subjects;
    for (size_t r = 0; r < bench.row_count; r++) {
        struct bench_kernel_row *row = &result->rows[r];
        const struct job *job = &bench.jobs[r * VARIANTS];
        struct bench_cost *const costs[] = {&row->specialised, &row->generic, &row->limit};
        row->pairs = job->pairs / job->particles;
        row->ns_per_particle = 1e9 * next->time.cpu_s / job->particles;
        for (size_t v = 0; v < VARIANTS; v++) {
            *costs[v] = cost_of(&job[v], next);
            next += job[v].kind != JOB_NONE;
        }
        if (row->whole < r)
            row->share = row->ns_per_particle / result->rows[row->whole].ns_per_particle;
    }
    add_limits(result);
end:
    clean_up(&bench);
    free(subjects);
    return status;
}

void bench_kernels_free(struct bench_kernels *result)
{
    free(result->rows);
    *result = (struct bench_kernels){0};
}
