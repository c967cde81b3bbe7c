/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof verify: runs the checks, and with --mutants reports which mutants they reject. */
#include <gsl/gsl_errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "check_registry.h"
#include "command.h"
#include "output.h"
#include "progress.h"
#include "result.h"
#include "sharing.h"
#include "suite.h"
#include "suite_output.h"
#include "text.h"
#include "user_figures.h"

enum { FOLDER_LENGTH = 1000 };

static const struct command_option verify_options[] = {
    {"mutants", NULL, "also run the mutants: wrong variants that the checks must reject"},
    {"slow", NULL, "also run the checks that take more than a few seconds"},
    {"details", NULL, "show every figure that fails, not only what it comes to"},
    {"first", NULL, "the checks that name a cause first; stop after the first check that fails"},
    {"kernel-plugin", "F.so", "check a kernel of your own as well (see `sphproof kernel --help`)"},
    {"junit", "FILE", "write a JUnit file"},
    {"failures", "DIR", "where failing checks leave data (default: failures/ beside the program)"},
    {"jobs", "J", "checks side by side (default 1), each in a process of its own"},
    SHARING_OPTIONS,
    {NULL, NULL, NULL},
};

/* The folder `failures` beside the program or, if that is read-only, in the working directory. */
static void default_folder(char *folder, size_t size)
{
    char program[FOLDER_LENGTH - 10] = ""; /* stays empty without /proc */
    (void)!readlink("/proc/self/exe", program, sizeof program - 1);
    char *slash = strrchr(program, '/');
    if (slash) slash[1] = '\0';
    snprintf(folder, size, "%sfailures", access(program, W_OK) ? "" : program);
}

/* Refuses a name: lists the groups or, if the group exists, its checks. */
static enum status refuse_name(const char *name, const char *const *groups, size_t group_count,
                               struct error *error)
{
    const size_t length = strcspn(name, "/");
    const char **names = malloc(check_registry_count * sizeof *names);
    size_t count = 0;
    if (!names) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    for (size_t i = 0; i < check_registry_count; i++)
        if (strlen(check_registry[i]->group) == length &&
            strncmp(name, check_registry[i]->group, length) == 0)
            names[count++] = check_registry[i]->name;
    if (count) {
        char where[80];
        snprintf(where, sizeof where, "verify: group %.*s", (int)length, name);
        text_unknown(error, where, "check", name + length + 1, names, count);
    } else {
        text_unknown(error, "verify", "group", name, groups, group_count);
    }
    free(names);
    return error->status;
}

static enum status choose_groups(int n, char **arguments, struct error *error)
{
    size_t count;
    const char **names = suite_groups(check_registry, check_registry_count, &count);
    enum status status = names ? STATUS_OK : error_set(error, STATUS_ENVIRONMENT, "no memory");
    for (int i = 0; i < n && !status; i++) {
        bool known = false;
        for (size_t j = 0; j < check_registry_count; j++)
            known = known || suite_names(arguments[i], check_registry[j]);
        if (!known) status = refuse_name(arguments[i], names, count, error);
    }
    free(names);
    return status;
}

static void show_progress(void *progress, const struct check *check, size_t done, size_t total)
{
    struct progress *p = progress;
    p->what = check->name;
    progress_update(p, (double)done, (double)total);
}

static enum status write_results(const struct suite *suite, const struct options *options,
                                 struct error *error)
{
    const char *junit = options_value(options, "junit");
    enum status status = junit ? suite_output_junit(suite, junit, error) : STATUS_OK;
    if (status || !options->json) return status;
    json_t *document = result_new("verify"), *failures = headline_list(suite);
    suite_output_json(suite, document);
    json_object_set_new(document, "failures", failures);
    if (!failures) {
        json_decref(document);
        return error_set(error, STATUS_ENVIRONMENT, "no memory for the failures");
    }
    return options_write(options, document, error);
}

static void keep_failures(const struct suite *suite, const struct options *options)
{
    char folder[FOLDER_LENGTH];
    struct error error = {0};
    const char *given = options_value(options, "failures");
    if (!given) default_folder(folder, sizeof folder);
    if (suite_output_failures(suite, given ? given : folder, options->quiet ? NULL : stderr,
                              &error))
        fprintf(stderr, "sphproof: %s\n", error.message);
}

/* Prints and writes the results of the suite, and frees it. */
static enum status present(const struct options *options, struct suite *suite, enum status status,
                           struct error *error)
{
    if (options->speak)
        suite_output_table(suite, stdout, options->color, options_value(options, "details"));
    keep_failures(suite, options);
    const enum status written = write_results(suite, options, error);
    suite_free(suite);
    return written ? written : status;
}

/* Runs the checks one after another, with those of a kernel of the user's own. */
static enum status run_here(struct suite *suite, const struct suite_choice *choice,
                            const struct options *options, struct error *error)
{
    struct user_figures user = {0};
    const char *plugin = options_value(options, "kernel-plugin");
    if (plugin && user_figures_measure(&user, plugin, error)) return error->status;
    check_kernel_plugin = plugin ? &user : NULL;
    progress_begin(choice->context, "checks", options->quiet);
    const enum status status =
        suite_run(suite, check_registry, check_registry_count, choice, error);
    progress_end(choice->context);
    check_kernel_plugin = NULL;
    user_figures_free(&user);
    return status;
}

/* ---- side by side, or in shares ---- */

/* True if --jobs or one of SHARING_OPTIONS is given. */
static bool in_shares(const struct options *options)
{
    static const char *const names[] = {"jobs",         "cache",  "shard",          "list",
                                        "engine-tasks", "engine", "engine-options", "only-build"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (options_value(options, names[i])) return true;
    return false;
}

/* One check with its mutants, in a process of its own. */
struct part {
    const struct check *check;
    char name[128];
    bool mutants;
    size_t job;
};

static enum status compute_part(const void *context, json_t **document, struct error *error)
{
    const struct part *part = context;
    const struct suite_choice choice = {.slow = true, .mutants = part->mutants};
    struct suite suite;
    const enum status status = suite_run(&suite, &part->check, 1, &choice, error);
    if (status != STATUS_OK && status != STATUS_CHECK_FAILED) return status;
    *document = suite_keep(&suite);
    suite_free(&suite);
    return status;
}

/* Adds the chosen checks to the pool. The part after the last one stays without a check. */
static enum status plan(struct pool *pool, struct part *part, const struct suite_choice *choice,
                        struct error *error)
{
    for (size_t i = 0; i < check_registry_count; i++) {
        const struct check *check = check_registry[i];
        char key[sizeof part->name + 32];
        if (!suite_chosen(check, choice)) continue;
        *part = (struct part){.check = check, .mutants = choice->mutants};
        snprintf(part->name, sizeof part->name, "%s/%s", check->group, check->name);
        snprintf(key, sizeof key, "check %s, mutants %d", part->name, part->mutants);
        part->job = pool_add(pool, part->name, key, suite_cost(check), compute_part, part);
        if (part->job == (size_t)-1)
            return error_set(error, STATUS_ENVIRONMENT, "verify: no memory for a check");
        part++;
    }
    return STATUS_OK;
}

static enum status join(struct suite *suite, const struct pool *pool, const struct part *part,
                        struct error *error)
{
    const struct check *checks[check_registry_count];
    const json_t *documents[check_registry_count];
    size_t count = 0;
    for (; part->check; part++) {
        const struct pool_job *job = &pool->jobs[part->job];
        if (!job->document) {
            *error = job->error;
            return error->status;
        }
        checks[count] = part->check;
        documents[count++] = job->document;
    }
    return suite_join(suite, checks, documents, count, error);
}

/* Each of the chosen checks in a process of its own. *whole, false before: there is a suite, unlike
 * with --shard or --list. */
static enum status run_shares(struct suite *suite, const struct suite_choice *choice,
                              const struct options *options, bool *whole, struct error *error)
{
    static const char *const others[] = {"first", "kernel-plugin"};
    struct sharing sharing;
    struct pool pool = {0};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (options_value(options, others[i]))
            return error_set(error, STATUS_BAD_INPUT,
                             "verify: --%s and checks side by side or in shares exclude each other",
                             others[i]);
    if (sharing_take(&sharing, options, 0, NULL, error)) return error->status;
    struct part *parts = calloc(check_registry_count, sizeof *parts);
    enum status status = parts ? plan(&pool, parts, choice, error)
                               : error_set(error, STATUS_ENVIRONMENT, "verify: no memory");
    if (!status) status = sharing_run(&sharing, &pool, options, whole, error);
    if (*whole) status = join(suite, &pool, parts, error);
    pool_free(&pool);
    free(parts);
    return status;
}

/* ---- the command ---- */

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    const char *junit = options_value(options, "junit");
    enum status status = choose_groups(n, arguments, error);
    if (!status && junit) status = output_probe(junit, error);
    if (status) return status;

    struct progress progress;
    struct suite suite;
    const struct suite_choice choice = {
        .groups = (const char *const *)arguments,
        .group_count = (size_t)n,
        .slow = options_value(options, "slow"),
        .mutants = options_value(options, "mutants"),
        .first = options_value(options, "first"),
        .progress = show_progress,
        .context = &progress,
    };
    gsl_set_error_handler_off();
    bool whole = !in_shares(options);
    status = whole ? run_here(&suite, &choice, options, error)
                   : run_shares(&suite, &choice, options, &whole, error);
    return whole && (status == STATUS_OK || status == STATUS_CHECK_FAILED)
               ? present(options, &suite, status, error)
               : status;
}

const struct command command_verify = {
    .name = "verify",
    .synopsis = "[GROUP|GROUP/CHECK ...] [--mutants] [--slow] [--first] [--details]",
    .help =
        "check kernels, gradients, solver, exact solutions and norms\n\n"
        "Every check states a property, the measured value, its bound and the noise floor.\n"
        "Without a GROUP all groups run; GROUP/CHECK is one of its checks. Exit status 1 if a\n"
        "figure is beyond its bound or, with --mutants, if a deliberately wrong variant is not\n"
        "rejected.",
    .run = run,
    .options = verify_options,
    .examples = "sphproof verify\nsphproof verify kernels gradients\n"
                "sphproof verify hydro/time_stepping\n"
                "sphproof verify --mutants --cache shared --shard 2/3\n"
                "sphproof verify --mutants --json verify.json --junit verify.xml",
};
