/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cases.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "list.h"
#include "place.h"
#include "text.h"

enum { SIZE_MAX_FILE = 65536 };

static enum status cannot_read(const char *path, const char *why, struct error *error)
{
    return error_set(error, STATUS_BAD_INPUT, "case file '%.200s': %s", path, why);
}

static enum status load_path(struct case_file *file, const char *path, struct error *error)
{
    static const char too_large[] = "larger than 64 KiB: not a case file";
    enum status status;
    struct stat info;
    /* a pipe must not hold us up */
    const int descriptor = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return cannot_read(path, strerror(errno), error);
    char *text = NULL;
    if (fstat(descriptor, &info) || S_ISDIR(info.st_mode))
        status = cannot_read(path, strerror(EISDIR), error);
    else if (!S_ISREG(info.st_mode))
        status = cannot_read(path, "not a regular file", error);
    else if (info.st_size > SIZE_MAX_FILE)
        status = cannot_read(path, too_large, error);
    else if (!(text = malloc(SIZE_MAX_FILE + 1)))
        status = error_set(error, STATUS_ENVIRONMENT, "no memory to read '%.200s'", path);
    else {
        size_t length = 0;
        ssize_t got;
        while (length <= SIZE_MAX_FILE &&
               (got = read(descriptor, text + length, SIZE_MAX_FILE + 1 - length)) > 0)
            length += (size_t)got;
        status = length > SIZE_MAX_FILE ? cannot_read(path, too_large, error)
                                        : case_parse(file, path, text, length, error);
    }
    free(text);
    close(descriptor);
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

/* A case that the user has put beside the installed ones, whose copies there are for reading. */
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
    const char *dot = strrchr(name, '.');
    if (strchr(name, '/') || (dot && strcmp(dot, ".ini") == 0)) return load_path(file, name, error);
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
