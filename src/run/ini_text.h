/* SPDX-License-Identifier: GPL-3.0-or-later
 * INI files whose keys are all checked: inih does the syntax, line by line from a reader of ours.
 * It cuts long lines, takes a folder for an empty file and does not tell its callback the line, so
 * text is checked before it. Messages name file and line. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "status.h"

enum { INI_TEXT_LINE = 180 }; /* the most characters of a line */

/* Begins with all but the last two, which are 0. */
struct ini_text {
    const char *path, *kind; /* for messages: kind is "case file" */
    const char *rest, *end;  /* what is left to read */
    struct error *error;
    bool sections; /* a section that begins is handed over, too: its name and value are NULL */
    int line;      /* of what is being read */
    bool failed;
};

/* A pair; its line is text->line. What it returns does not matter: ini_text_fail stops the file. */
typedef int ini_text_pair(void *context, const char *section, const char *name, const char *value);

/* Hands all pairs over. STATUS_BAD_INPUT: what is no INI text, or what ini_text_fail was told. */
enum status ini_text_read(struct ini_text *text, ini_text_pair *pair, void *context);

/* The bytes of a file, malloced, at most 64 KiB. STATUS_BAD_INPUT: why it cannot be one of its
 * kind. */
enum status ini_text_load(const char *path, const char *kind, char **bytes, size_t *length,
                          struct error *error);

/* STATUS_BAD_INPUT with "path:line: WHAT; allowed: ALLOWED"; allowed may be "". */
enum status ini_text_fail(struct ini_text *text, const char *what, const char *allowed);
/* The same for "KEY = VALUE". */
enum status ini_text_fail_value(struct ini_text *text, const char *key, const char *value,
                                const char *allowed);

/* True the first time, which *line (0) notes; else fails with the line of the first. */
bool ini_text_first(struct ini_text *text, int *line, const char *key);
