/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "command.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "plugin_kernel.h"
#include "result.h"
#include "sweep.h"
#include "text.h"

const char *options_value(const struct options *options, const char *name)
{
    const struct command_option *list = options->command->options;
    for (size_t i = 0; list[i].name; i++)
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

enum status options_number(const struct options *options, const char *name, bool whole, double low,
                           double high, double *value, struct error *error)
{
    const char *text = options_value(options, name);
    if (!text) return STATUS_OK;
    const bool number = whole ? text_integer(text, value) : text_real(text, value);
    if (number && *value >= low && *value <= high) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT, "%s: --%s '%.40s': allowed: %s from %g to %g",
                     options->command->name, name, text, whole ? "an integer" : "a number", low,
                     high);
}

enum status options_positive(const struct options *options, const char *name, double *value,
                             struct error *error)
{
    const char *text = options_value(options, name);
    if (!text || (text_real(text, value) && *value > 0)) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT, "%s: --%s '%.40s': allowed: a number above 0",
                     options->command->name, name, text);
}

enum status options_real(const struct options *options, const char *name,
                         struct snapshot_value *value, struct error *error)
{
    const char *text = options_value(options, name);
    if (!text) return STATUS_OK;
    value->known = text_real(text, &value->value);
    if (value->known) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT, "%s: --%s '%.40s': allowed: a number",
                     options->command->name, name, text);
}

enum status options_case(const struct options *options, const char *name, int n, char *const *keys,
                         struct code *code, struct code_external *external,
                         struct run_settings *settings, struct error *error)
{
    const char *path = options_value(options, "code"), *work = options_value(options, "work");
    if (work && !path)
        return error_set(error, STATUS_BAD_INPUT, "%s: --work needs --code FILE",
                         options->command->name);
    if (path ? code_load(code, path, error) ||
                   code_prepare(code, name, work, n, keys, external, settings, error)
             : run_prepare(settings, name, n, keys, error))
        return error->status;
    settings->threads = options->threads;
    return STATUS_OK;
}

enum status options_ladder(const struct options *options, const struct run_settings *settings,
                           size_t least, size_t ladder[CASE_LADDER_MAX], size_t *count,
                           struct error *error)
{
    const char *text = options_value(options, "n"), *name = options->command->name;
    const struct case_file *file = &settings->file;
    if (settings->settings.value[SETTING_n].source == SOURCE_USER)
        return error_set(error, STATUS_BAD_INPUT,
                         "%s: the key n and a ladder exclude each other; allowed: --n "
                         "N1,N2,N3,N4,...",
                         name);
    if (text) return sweep_ladder(text, least, file->dimension, ladder, count, error);
    memcpy(ladder, file->ladder, sizeof file->ladder);
    *count = file->ladder_count;
    if (*count) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "%s: the case %s has no ladder; give one: --n 100,200,400,800", name,
                     file->name);
}

enum status options_write(const struct options *options, json_t *document, struct error *error)
{
    enum status status = STATUS_OK;
    if (options->json)
        status = document ? result_write(document, options->json, error)
                          : error_set(error, STATUS_ENVIRONMENT, "no memory for the result");
    json_decref(document);
    return status;
}

enum status options_write_members(const struct options *options, json_t *members,
                                  struct error *error)
{
    json_t *document = result_new(options->command->name);
    if (json_object_update(document, members)) json_decref(document), document = NULL;
    json_decref(members);
    return options_write(options, document, error);
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
