/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cases.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "list.h"
#include "place.h"
#include "text.h"

static enum status load_path(struct case_file *file, const char *path, struct error *error)
{
    char *text;
    size_t length;
    if (ini_text_load(path, "case file", &text, &length, error)) return error->status;
    const enum status status = case_parse(file, path, text, length, error);
    free(text);
    return status;
}

static enum status unknown_case(const char *name, struct error *error)
{
    const char **names = NULL;
    size_t n = 0;
    enum status status = STATUS_OK;
    for (const struct case_builtin *builtin = case_builtins; builtin->name; builtin++) {
        if (!list_grow(&names, n, sizeof *names))
            status = error_set(error, STATUS_ENVIRONMENT, "no memory");
        else
            names[n++] = builtin->name;
    }
    if (!status) status = text_unknown(error, NULL, "case", name, names, n);
    free(names);
    return status;
}

/* Loads a case that the user has added to the folder of installed cases. The built-in cases have
 * copies there, for reading only. */
static enum status load_installed(struct case_file *file, const char *name, struct error *error)
{
    char wanted[128], path[PLACE_LENGTH];
    const int length = snprintf(wanted, sizeof wanted, "cases/%s.ini", name);
    if (length < (int)sizeof wanted && place_find(wanted, path))
        return load_path(file, path, error);
    return unknown_case(name, error);
}

static enum status load(struct case_file *file, const char *name, struct error *error)
{
    if (strchr(name, '/') || text_ends(name, ".ini")) return load_path(file, name, error);
    for (const struct case_builtin *builtin = case_builtins; builtin->name; builtin++) {
        char path[80];
        snprintf(path, sizeof path, "cases/%s.ini", builtin->name);
        if (strcmp(builtin->name, name) == 0)
            return case_parse(file, path, builtin->text, strlen(builtin->text), error);
    }
    return load_installed(file, name, error);
}

enum status case_load(struct case_file *file, const char *name, struct error *error)
{
    const enum status status = load(file, name, error);
    if (!status) snprintf(file->asked, sizeof file->asked, "%s", name);
    return status;
}
