/* SPDX-License-Identifier: GPL-3.0-or-later
 * INI files whose keys are all checked. inih parses the syntax, line by line. Because inih
 * truncates long lines, reads a directory as an empty file and does not pass the line number to its
 * callback, this module reads and checks the text first. Messages name file and line. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "status.h"

enum { INI_TEXT_LINE = 180 }; /* longest line, in bytes */

/* The caller sets all members except `line` and `failed`, which start as 0. */
struct ini_text {
    const char *path, *kind; /* for messages; kind: "case file", for example */
    const char *rest, *end;  /* remaining text */
    struct error *error;
    bool sections; /* also pass each section to the callback, with name and value NULL */
    int line;      /* number of the current line */
    bool failed;
};

/* Receives one pair, found in line text->line. The return value is ignored: ini_text_fail stops the
 * file. */
typedef int ini_text_pair(void *context, const char *section, const char *name, const char *value);

/* Passes all pairs to the callback. STATUS_BAD_INPUT: a syntax error, or the callback called
 * ini_text_fail. */
enum status ini_text_read(struct ini_text *text, ini_text_pair *pair, void *context);

/* Reads a file of at most 64 KiB; the caller frees the bytes. STATUS_BAD_INPUT: why the file cannot
 * be of this kind. */
enum status ini_text_load(const char *path, const char *kind, char **bytes, size_t *length,
                          struct error *error);

/* Fails with STATUS_BAD_INPUT and "path:line: WHAT; allowed: ALLOWED"; allowed may be "". */
enum status ini_text_fail(struct ini_text *text, const char *what, const char *allowed);
/* The same with "KEY = VALUE". */
enum status ini_text_fail_value(struct ini_text *text, const char *key, const char *value,
                                const char *allowed);

/* Returns true the first time and stores the line in *line, initially 0. Else fails and names the
 * line of the first pair. */
bool ini_text_first(struct ini_text *text, int *line, const char *key);
