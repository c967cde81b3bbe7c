/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "user_solution.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cache.h"
#include "guard.h"
#include "user_table.h"
#include "plugin_kernel.h"
#include "text.h"
#include "user_kernel.h"
#include "user_reference.h"

enum {
#define PROBLEM(name) PROBLEM_##name,
#include "problems.def"
#undef PROBLEM
    PROBLEMS
};

struct solution;

/* A problem of problem_family with another sample. `problem` comes first, since pointers to it are
 * converted back. */
struct user_solution_problem {
    struct problem problem;
    const struct problem *base;
    struct solution *solution;
};

struct solution {
    char path[512], name[1024];
    struct user_table *table; /* NULL: a shared object */
    struct user_reference user;
    int parameter_count;
    char words[USER_PARAMETERS_MAX][32];
    const char *parameter_names[USER_PARAMETERS_MAX];
    double parameters[USER_PARAMETERS_MAX];
    bool unknown[FIELDS];
    bool tried; /* the shared object was tried and is loaded */
    struct user_solution_problem problems[PROBLEMS];
};

static struct solution *solutions[USER_SOLUTIONS_MAX + 1];
static int solution_count;

static const char table_word[] = "table ";

bool user_solution_is_named(const char *text)
{
    char first[512] = "";
    const size_t length = strcspn(text, " \t");
    memcpy(first, text, length < sizeof first ? length : sizeof first - 1);
    return strncmp(text, table_word, strlen(table_word)) == 0 || strcmp(text, "table") == 0 ||
           user_kernel_is_path(first);
}

const char *user_solution_name(int number)
{
    return solutions[number]->name;
}

/* ---- values ---- */

static const struct user_solution_problem *solution_of(const struct prepared *p)
{
    return p->problem->user ? (const struct user_solution_problem *)p->problem : NULL;
}

static void sample_user(const struct solution *solution, const struct prepared *p,
                        const double x[3], double t, struct problem_state *state)
{
    const struct sphproof_reference_case of = {.dim = p->domain.dim,
                                               .gamma = p->gamma,
                                               .lo = p->domain.lo,
                                               .hi = p->domain.hi,
                                               .gravity = p->gravity,
                                               .parameter_count = solution->parameter_count,
                                               .parameter_name = solution->parameter_names,
                                               .parameter_value = solution->parameters};
    struct sphproof_reference_state s;
    user_reference_state(&solution->user, x, t, &of, &s);
    *state = (struct problem_state){s.rho, {0}, s.P, s.u};
    for (int d = 0; d < p->domain.dim; d++) state->v[d] = s.v[d];
    if (isnan(s.u)) state->u = s.P / ((p->gamma - 1) * s.rho);
}

static void sample(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state)
{
    const struct user_solution_problem *of = solution_of(p);
    if (!(t > 0) && !(of->base->filed && !of->solution->table))
        of->base->sample(p, x, t, state);
    else if (of->solution->table)
        user_table_sample(of->solution->table, p, x, state);
    else
        sample_user(of->solution, p, x, t, state);
}

void user_solution_error(const struct prepared *p, const struct snapshot *s, double miss[FIELDS])
{
    const struct user_solution_problem *of = solution_of(p);
    for (int f = 0; f < FIELDS; f++) miss[f] = (double)NAN;
    if (of && of->solution->table) user_table_error(of->solution->table, p, s, miss);
}

/* ---- times at which a table holds ---- */

static bool holds(const struct prepared *p, double t)
{
    const struct user_table *table = solution_of(p)->solution->table;
    return !table || !(t > 0) || fabs(t / user_table_time(table) - 1) <= 1e-6;
}

static enum status refuse(const struct prepared *p, double t, double longest, struct error *error)
{
    const struct solution *solution = solution_of(p)->solution;
    (void)longest;
    return error_set(error, STATUS_BAD_INPUT,
                     "t_end=%.10g: the table %.200s is of t = %.10g, and nothing is known at other "
                     "times",
                     t, solution->path, user_table_time(solution->table));
}

/* ---- trial calls of a shared object ---- */

struct errand {
    struct solution *solution;
    const struct prepared *p;
    double t;
};

/* A position in the window, the same for the same k. */
static void position_of(const struct prepared *p, int k, double x[3])
{
    /* multiples of irrational numbers avoid symmetric positions */
    static const double steps[3] = {0.7548776662466927, 0.5698402909980532, 0.3819660112501051};
    for (int d = 0; d < 3; d++) x[d] = 0;
    for (int d = 0; d < p->domain.dim; d++) {
        const bool round = p->window.radius > 0;
        const double lo = round ? p->window.centre[d] - 0.5 * p->window.radius : p->window.lo[d];
        const double hi = round ? p->window.centre[d] + 0.5 * p->window.radius : p->window.hi[d];
        x[d] = lo + (hi - lo) * fmod((k + 1) * steps[d], 1);
    }
}

enum { TRIES = 64 };

/* Creates {"field": [number or null, ...], ...}: the number of known samples of each field at t. */
static enum status try_calls(const void *context, json_t **reply, struct error *error)
{
    const struct errand *errand = context;
    int known[FIELDS] = {0};
    if (user_reference_load(&errand->solution->user, errand->solution->path, error))
        return error->status;
    guard_begun();
    for (int k = 0; k < TRIES; k++) {
        struct problem_state state;
        double x[3];
        position_of(errand->p, k, x);
        sample_user(errand->solution, errand->p, x, errand->t, &state);
        for (int f = 0; f < FIELDS; f++) known[f] += isfinite(problem_field(&state, (enum field)f));
    }
    *reply = json_array();
    for (int f = 0; f < FIELDS; f++) json_array_append_new(*reply, json_integer(known[f]));
    return STATUS_OK;
}

static enum status judge_tries(struct solution *solution, const json_t *known, double t,
                               struct error *error)
{
    bool any = false;
    for (int f = 0; f < FIELDS; f++) {
        const int count = (int)json_integer_value(json_array_get(known, (size_t)f));
        if (count && count < TRIES)
            return error_set(error, STATUS_BAD_INPUT,
                             "reference '%.150s': at t = %.6g %s is not finite at %d of %d places "
                             "in the window; allowed: finite values there, or NaN everywhere of a "
                             "field that is unknown",
                             solution->path, t, field_family.members[f]->name, TRIES - count,
                             TRIES);
        any |= count > 0;
        solution->unknown[f] = !count;
        for (int k = 0; k < PROBLEMS; k++) solution->problems[k].problem.unknown[f] = !count;
    }
    if (any) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT, "reference '%.150s': nothing is known at t = %.6g",
                     solution->path, t);
}

/* Calls the shared object in a child process first, then loads it into this process. */
static enum status try_user(struct solution *solution, const struct prepared *p, double t,
                            struct error *error)
{
    const struct errand errand = {solution, p, t};
    struct guard_verdict verdict;
    if (solution->tried) return STATUS_OK;
    enum status status = guard_run(try_calls, &errand, GUARD_LIMIT, &verdict, error);
    if (!verdict.ended && verdict.reason[0])
        status = error_set(error, STATUS_BAD_INPUT, "reference '%.150s' is refused: it %s",
                           solution->path, verdict.reason);
    if (!status && verdict.printed_bytes)
        status = error_set(error, STATUS_BAD_INPUT,
                           "reference '%.150s' is refused: it prints, which would mix with "
                           "results: %.80s",
                           solution->path, verdict.printed);
    if (!status) status = judge_tries(solution, verdict.reply, t, error);
    guard_free(&verdict);
    if (!status) status = guard_watch("reference", solution->path, error);
    if (!status) status = user_reference_load(&solution->user, solution->path, error);
    solution->tried = !status;
    return status;
}

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    const struct user_solution_problem *of = solution_of(p);
    const double t = settings_real(settings, SETTING_t_end);
    if (of->solution->table ? user_table_check(of->solution->table, p, error)
                            : try_user(of->solution, p, t, error))
        return error->status;
    return of->base->prepare(p, settings, error);
}

/* ---- loading ---- */

/* Derives the problem that has this reference as its solution. */
static void derive(struct solution *solution, const struct problem *base,
                   struct user_solution_problem *derived)
{
    struct problem *problem = &derived->problem;
    derived->base = base;
    derived->solution = solution;
    memcpy(problem, base, sizeof *problem);
    problem->user = solution->table ? USER_TABLE : USER_FUNCTION;
    problem->fieldless = false;
    memcpy(problem->unknown, solution->unknown, sizeof problem->unknown);
    problem->prepare = prepare;
    problem->sample = sample;
    problem->holds = holds;
    problem->refuse = refuse;
    /* these depend on the problem's own solution */
    problem->mean_energy = NULL;
    problem->ahead = NULL;
    problem->regions = NULL;
}

const struct problem *user_solution_problem(int number, const struct problem *base)
{
    struct solution *solution = solutions[number];
    int k = 0;
    while (solution->problems[k].base && solution->problems[k].base != base) k++;
    if (!solution->problems[k].base) derive(solution, base, &solution->problems[k]);
    return &solution->problems[k].problem;
}

/* Reads NAME=NUMBER. */
static enum status read_parameter(struct solution *solution, const char *word, struct error *error)
{
    const char *equals = strchr(word, '=');
    const size_t length = equals ? (size_t)(equals - word) : 0;
    const int i = solution->parameter_count;
    if (i == USER_PARAMETERS_MAX || !length || length >= sizeof solution->words[0] ||
        !text_real(equals + 1, &solution->parameters[i]))
        return error_set(error, STATUS_BAD_INPUT,
                         "'%.40s' after the shared object: allowed: up to %d parameters "
                         "NAME=NUMBER",
                         word, USER_PARAMETERS_MAX);
    snprintf(solution->words[i], sizeof solution->words[i], "%.*s", (int)length, word);
    solution->parameter_names[i] = solution->words[i];
    for (int k = 0; k < i; k++)
        if (strcmp(solution->words[k], solution->words[i]) == 0)
            return error_set(error, STATUS_BAD_INPUT,
                             "parameter %s stands twice after the shared object",
                             solution->words[i]);
    solution->parameter_count++;
    return STATUS_OK;
}

/* Resolves a path relative to the folder of another file. */
static enum status take_path(struct solution *solution, const char *word, const char *beside,
                             struct error *error)
{
    const char *slash = *word == '/' ? NULL : strrchr(beside, '/');
    struct stat is;
    const int length = snprintf(solution->path, sizeof solution->path, "%.*s%s",
                                slash ? (int)(slash + 1 - beside) : 0, beside, word);
    if (length >= (int)sizeof solution->path)
        return error_set(error, STATUS_BAD_INPUT, "a path of %d characters; allowed: up to %zu",
                         length, sizeof solution->path - 1);
    if (stat(solution->path, &is) == 0 && S_ISREG(is.st_mode) && cache_hash_file(solution->path))
        return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT, "'%.200s' is no file that can be read",
                     solution->path);
}

static enum status read_words(struct solution *solution, const char *text, const char *beside,
                              struct error *error)
{
    char copy[1024], *rest = copy;
    const bool table = strncmp(text, "table", 5) == 0;
    if (snprintf(copy, sizeof copy, "%s", text) >= (int)sizeof copy)
        return error_set(error, STATUS_BAD_INPUT, "it is too long");
    if (table) strtok_r(rest, " \t", &rest);
    char *word = strtok_r(rest, " \t", &rest);
    if (!word) return error_set(error, STATUS_BAD_INPUT, "allowed: table FILE.csv");
    if (take_path(solution, word, beside, error)) return error->status;
    size_t used =
        (size_t)snprintf(solution->name, sizeof solution->name, "%s%s@%016" PRIx64,
                         table ? table_word : "", solution->path, cache_hash_file(solution->path));
    while ((word = strtok_r(rest, " \t", &rest))) {
        if (table)
            return error_set(error, STATUS_BAD_INPUT,
                             "'%.40s' after the table's path; allowed: "
                             "nothing",
                             word);
        if (read_parameter(solution, word, error)) return error->status;
        if (used < sizeof solution->name)
            used +=
                (size_t)snprintf(solution->name + used, sizeof solution->name - used, " %s", word);
    }
    if (table && !(solution->table = user_table_read(solution->path, error))) return error->status;
    return STATUS_OK;
}

static void discard(struct solution *solution)
{
    if (solution && solution->table) user_table_free(solution->table);
    free(solution);
}

enum status user_solution_load(const char *text, const char *beside, int *number,
                               struct error *error)
{
    struct solution *solution = plugin_allowed() ? calloc(1, sizeof *solution) : NULL;
    if (!plugin_allowed())
        return error_set(error, STATUS_BAD_INPUT, "files of a user's are not read here");
    enum status status = solution
                             ? read_words(solution, text, beside, error)
                             : error_set(error, STATUS_ENVIRONMENT, "no memory for a reference");
    for (int k = 1; k <= solution_count && !status; k++) {
        if (strcmp(solutions[k]->name, solution->name) != 0) continue;
        *number = k;
        discard(solution);
        return STATUS_OK;
    }
    if (!status && solution_count == USER_SOLUTIONS_MAX)
        status =
            error_set(error, STATUS_BAD_INPUT, "allowed: up to %d references", USER_SOLUTIONS_MAX);
    if (status) {
        discard(solution);
        return status;
    }
    for (int f = 0; f < FIELDS && solution->table; f++)
        solution->unknown[f] = !user_table_knows(solution->table, (enum field)f);
    solutions[ *number = ++solution_count] = solution;
    return STATUS_OK;
}
