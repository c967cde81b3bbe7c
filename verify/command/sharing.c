/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sharing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "text.h"

enum { JOBS_MAX = 1024, SHARES_MAX = 1000000 };

static enum status take_share(struct pool_share *share, const struct options *options,
                              struct error *error)
{
    const char *text = options_value(options, "shard");
    int end;
    if (text && (sscanf(text, "%6d/%7d%n", &share->number, &share->of, &end) != 2 || text[end] ||
                 share->number < 1 || share->number > share->of || share->of > SHARES_MAX))
        return error_set(error, STATUS_BAD_INPUT,
                         "%s: --shard '%.40s': allowed: I/N with 1 <= I <= N <= %d, as 3/8",
                         options->command->name, text, SHARES_MAX);
    return STATUS_OK;
}

/* Chooses who computes. Other machines need the cache to exchange results. */
static enum status take_engine(struct sharing *sharing, const struct options *options,
                               const char *folder, struct error *error)
{
    static const char *const engines[] = {"local", "slurm"};
    const char *name = options_value(options, "engine");
    const bool force = options_value(options, "force");
    double number = 0;
    sharing->slurm = name && strcmp(name, "slurm") == 0;
    if (name && !sharing->slurm && strcmp(name, "local") != 0)
        return text_unknown(error, "--engine", "engine", name, engines, 2);
    if (options_number(options, "engine-tasks", true, 1, SLURM_TASKS_MAX, &number, error))
        return error->status;
    sharing->tasks = (int)number;
    if (!sharing->slurm)
        return sharing->tasks || options_value(options, "engine-options")
                   ? error_set(error, STATUS_BAD_INPUT,
                               "%s: --engine-options and --engine-tasks need --engine slurm",
                               options->command->name)
                   : STATUS_OK;
    if (sharing->pool.share.of || force)
        return error_set(error, STATUS_BAD_INPUT, "%s: --engine slurm and --%s exclude each other",
                         options->command->name, force ? "force" : "shard");
    return folder ? STATUS_OK
                  : error_set(error, STATUS_BAD_INPUT,
                              "%s: --engine slurm needs --cache DIR, which all machines see",
                              options->command->name);
}

/* Refuses --only-build with another build, whose results would have other cache keys. */
static enum status check_build(const struct sharing *sharing, const struct options *options,
                               struct error *error)
{
    const char *build = options_value(options, "only-build");
    if (!build || !sharing->pool.cache || strcmp(build, sharing->cache.build) == 0)
        return STATUS_OK;
    return error_set(error, STATUS_ENVIRONMENT,
                     "%s: this is build %s, not %.40s: another program, C library, or processor "
                     "whose sin, exp and pow have other last bits",
                     options->command->name, sharing->cache.build, build);
}

/* Refuses options for files that are not written with --shard or --list. */
static enum status refuse_files(const struct sharing *sharing, const struct options *options,
                                struct error *error)
{
    static const char *const files[] = {"junit", "plot"};
    const char *asked = options->json ? "json" : NULL;
    if (!sharing->list && !sharing->pool.share.of) return STATUS_OK;
    for (size_t i = 0; !asked && i < sizeof files / sizeof *files; i++)
        if (options_value(options, files[i])) asked = files[i];
    if (!asked) return STATUS_OK;
    return error_set(
        error, STATUS_BAD_INPUT, "%s: --%s: not with --%s", options->command->name, asked,
        sharing->list ? "list, which computes nothing"
                      : "shard: the call without --shard, which collects the shares, writes it");
}

enum status sharing_take(struct sharing *sharing, const struct options *options, int jobs,
                         const char *folder, struct error *error)
{
    const bool force = options_value(options, "force");
    double number = jobs;
    *sharing = (struct sharing){.list = options_value(options, "list") != NULL};
    if (options_number(options, "jobs", true, 1, JOBS_MAX, &number, error)) return error->status;
    sharing->pool.jobs = (int)fmax(1, number);
    if (take_share(&sharing->pool.share, options, error) || refuse_files(sharing, options, error))
        return error->status;
    if (!folder) folder = options_value(options, "cache");
    if (sharing->pool.share.of && !folder)
        return error_set(error, STATUS_BAD_INPUT,
                         "%s: --shard needs --cache DIR: there the shares meet",
                         options->command->name);
    if (sharing->pool.share.of && force)
        return error_set(error, STATUS_BAD_INPUT,
                         "%s: --shard and --force exclude each other: begin with an empty cache",
                         options->command->name);
    if (!folder && options_value(options, "only-build"))
        return error_set(
            error, STATUS_BAD_INPUT,
            "%s: --only-build needs --cache DIR: it is results there that have a build",
            options->command->name);
    if (take_engine(sharing, options, folder, error)) return error->status;
    if (folder && sharing->list && access(folder, R_OK)) folder = NULL; /* not created */
    if (folder && cache_open(&sharing->cache, folder, force, error)) return error->status;
    if (folder) sharing->pool.cache = &sharing->cache;
    sharing->pool.again = !sharing->slurm && !sharing->pool.share.of;
    return check_build(sharing, options, error);
}

/* The computations, for --list. */
static enum status print_list(const struct sharing *sharing, const struct pool *pool,
                              struct error *error)
{
    const struct pool_share *share = &sharing->pool.share;
    int *shares = calloc(pool->count, sizeof *shares);
    if (!shares) return error_set(error, STATUS_ENVIRONMENT, "no memory for the list");
    const enum status status = pool_divide(pool, share->of ? share->of : 1, shares, error);
    for (size_t i = 0; i < pool->count && !status; i++) {
        const struct pool_job *job = &pool->jobs[i];
        if (share->of && shares[i] != share->number) continue;
        const bool kept = sharing->pool.cache && cache_has(&sharing->cache, job->key);
        printf("%.3g\t%d\t%s\t%s\n", job->weight, shares[i], kept ? "kept" : "-", job->name);
    }
    free(shares);
    return status;
}

static void show_progress(void *context, const char *what, size_t done, size_t total, double share)
{
    struct progress *progress = context;
    progress->what = what;
    progress_share(progress, done, total, share);
}

/* Reports the result of a share; a computation without any result is a failure. */
static enum status say_share(const struct sharing *sharing, const struct pool *pool,
                             const struct options *options, struct error *error)
{
    size_t mine = 0;
    for (size_t i = 0; i < pool->count; i++) {
        const struct pool_job *job = &pool->jobs[i];
        if (job->elsewhere) continue;
        mine++;
        if (job->crashed || job->error.status == STATUS_ENVIRONMENT ||
            job->error.status == STATUS_BAD_INPUT)
            return error_set(error, job->error.status, "%.100s: %.400s", job->name,
                             job->error.message);
    }
    if (pool->note[0]) return error_set(error, STATUS_ENVIRONMENT, "%.400s", pool->note);
    if (options->speak)
        printf("share %d of %d: %zu of %zu computations, %zu of them found in %s\n",
               sharing->pool.share.number, sharing->pool.share.of, mine, pool->count, pool->found,
               sharing->cache.folder);
    return STATUS_OK;
}

static enum status compute_elsewhere(struct sharing *sharing, const struct pool *pool,
                                     const struct options *options, struct error *error)
{
    const struct slurm_work work = {
        .options = options,
        .pool = pool,
        .cache = &sharing->cache,
        .jobs = options_value(options, "jobs") ? sharing->pool.jobs : 1,
        .tasks = sharing->tasks,
        .progress = &sharing->progress,
    };
    if (!sharing->slurm) return STATUS_OK;
    const enum status status = slurm_compute(&work, error);
    progress_end(&sharing->progress);
    progress_begin(&sharing->progress, options->command->name, options->quiet);
    return status;
}

enum status sharing_run(struct sharing *sharing, struct pool *pool, const struct options *options,
                        bool *whole, struct error *error)
{
    *whole = false;
    if (sharing->list) return print_list(sharing, pool, error);
    progress_begin(&sharing->progress, options->command->name, options->quiet);
    sharing->pool.progress = show_progress;
    sharing->pool.progress_context = &sharing->progress;
    enum status status = compute_elsewhere(sharing, pool, options, error);
    if (!status) status = pool_run(pool, &sharing->pool, error);
    progress_end(&sharing->progress);
    if (status) return status;
    if (pool->damaged && !options->quiet)
        fprintf(stderr, "sphproof: note: %zu kept results were damaged: computed again\n",
                pool->damaged);
    if (sharing->pool.share.of) return say_share(sharing, pool, options, error);
    if (pool->note[0] && !options->quiet) fprintf(stderr, "sphproof: note: %s\n", pool->note);
    *whole = true;
    return STATUS_OK;
}
