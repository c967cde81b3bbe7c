/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof list: the names that can be used, one line each. */
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "kernel.h"
#include "result.h"
#include "text.h"

static const struct family *const families[] = {
    &kernel_family,
};
enum { FAMILIES = sizeof families / sizeof *families };

static void print_family(const struct family *family)
{
    printf("%s: %s\n", family->name, family->title);
    for (size_t i = 0; i < family->n; i++)
        printf("  %-24s %s\n", family->members[i]->name, family->members[i]->label);
}

static json_t *family_json(const struct family *family)
{
    json_t *list = json_array();
    for (size_t i = 0; i < family->n; i++)
        json_array_append_new(list, json_pack("{s:s, s:s, s:s}", "name", family->members[i]->name,
                                              "label", family->members[i]->label, "paper",
                                              family->members[i]->paper));
    return list;
}

static enum status choose(const char *word, const struct family **chosen, struct error *error)
{
    const char *names[FAMILIES];
    for (size_t i = 0; i < FAMILIES; i++) {
        names[i] = families[i]->name;
        if (strcmp(word, names[i]) == 0) *chosen = families[i];
    }
    return *chosen ? STATUS_OK : text_unknown(error, "list", "family", word, names, FAMILIES);
}

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    const struct family *chosen = NULL;
    if (n > 1) return command_usage(options, error, "one family at a time");
    if (n == 1 && choose(arguments[0], &chosen, error)) return error->status;
    json_t *document = result_new("list"), *lists = json_object();
    for (size_t i = 0; i < FAMILIES; i++) {
        if (chosen && chosen != families[i]) continue;
        if (options->speak) print_family(families[i]);
        json_object_set_new(lists, families[i]->name, family_json(families[i]));
    }
    json_object_set_new(document, "families", lists);
    const enum status status =
        options->json ? result_write(document, options->json, error) : STATUS_OK;
    json_decref(document);
    return status;
}

const struct command command_list = {
    .name = "list",
    .synopsis = "[FAMILY]",
    .help = "the names of cases, kernels, gradients ..., one line each",
    .run = run,
    .examples = "sphproof list\nsphproof list kernels",
};
