/* SPDX-License-Identifier: GPL-3.0-or-later */

#include <stdio.h>
#include <stdlib.h>

#include "check_registry.h"
#include "sharing.h"

bool verify_shares_wanted(const struct options *options)
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

static enum status compute(const void *context, json_t **document, struct error *error)
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
        part->job = pool_add(pool, part->name, key, suite_cost(check), compute, part);
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

enum status verify_shares_run(struct suite *suite, const struct suite_choice *choice,
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
    if (sharing_take(&sharing, options, 1, NULL, false, error)) return error->status;
    struct part *parts = calloc(check_registry_count + 1, sizeof *parts);
    enum status status = parts ? plan(&pool, parts, choice, error)
                               : error_set(error, STATUS_ENVIRONMENT, "verify: no memory");
    if (!status) status = sharing_run(&sharing, &pool, options, whole, error);
    if (*whole) status = join(suite, &pool, parts, error);
    pool_free(&pool);
    free(parts);
    return status;
}
