/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "command.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "plugin_kernel.h"
#include "text.h"

const char *options_value(const struct options *options, const char *name)
{
    const struct command_option *list = options->command->options;
    for (size_t i = 0; list && list[i].name; i++)
        if (strcmp(list[i].name, name) == 0) return options->values[i];
    return NULL;
}

enum status command_usage(const struct options *options, struct error *error, const char *format,
                          ...)
{
    char what[300];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    return error_set(error, STATUS_BAD_INPUT, "%s: %s (usage: sphproof %s %s)",
                     options->command->name, what, options->command->name,
                     options->command->synopsis);
}

enum status options_kernel(const struct options *options, int *index, struct error *error)
{
    const char *word = options_value(options, "kernel");
    *index = -1;
    if (!word) return STATUS_OK;
    if (plugin_is_path(word)) return plugin_find(word, index, error);
    *index = kernel_index(word);
    return *index >= 0
               ? STATUS_OK
               : text_unknown_member(error, options->command->name, "kernel", word, &kernel_family);
}
