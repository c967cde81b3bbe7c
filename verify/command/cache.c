/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof cache: the contents of a folder of cached results, and its pruning. */
#include <dirent.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "cache.h"
#include "command.h"
#include "result.h"
#include "text.h"

/* True if the folder has entries other than those of a cache: two hexadecimal digits, and slurm. */
static bool has_others(const char *folder)
{
    DIR *opened = opendir(folder);
    bool found = false;
    for (struct dirent *entry; opened && !found && (entry = readdir(opened));) {
        const char *name = entry->d_name;
        const bool digits = strlen(name) == 2 && strspn(name, "0123456789abcdef") == 2;
        found = name[0] != '.' && !digits && strcmp(name, "slurm") != 0;
    }
    if (opened) closedir(opened);
    return found;
}

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    struct cache_census census;
    const char *text = options_value(options, "prune");
    double days = HUGE_VAL;
    if (n != 1) return command_usage(options, error, "one folder is needed");
    if (text && !(text_real(text, &days) && days >= 0))
        return error_set(error, STATUS_BAD_INPUT,
                         "cache: --prune '%.40s': allowed: days, a number >= 0", text);
    if (cache_prune(arguments[0], days * 24 * 3600, &census, error)) return error->status;
    if (!census.entries && !census.removed && has_others(arguments[0]))
        return error_set(error, STATUS_BAD_INPUT,
                         "cache: %.200s is no cache: it has other files, and no result",
                         arguments[0]);
    if (options->speak)
        printf("%zu results, %.3g MB; %zu removed\n", census.entries, census.bytes / 1e6,
               census.removed);
    json_t *document = result_new("cache");
    result_add(document, "folder=%s entries=%zu removed=%zu bytes=%p", arguments[0], census.entries,
               census.removed, (void *)json_real(census.bytes));
    return options_write(options, document, error);
}

static const struct command_option own_options[] = {
    {"prune", "DAYS", "delete results that nobody has used for so many days"},
    {NULL, NULL, NULL},
};

const struct command command_cache = {
    .name = "cache",
    .synopsis = "DIR",
    .help = "number and size of the results in a cache; deletes those that are not used\nDIR is "
            "the folder of --cache DIR, or cache in the folder of a report. `sphproof report "
            "--nightly`\ndeletes what is a month old.",
    .run = run,
    .options = own_options,
    .examples = "sphproof cache reports/out/cache\nsphproof cache shared --prune 30",
};
