/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks the values of code files. */
#pragma once

#include "code_file.h"

/* Fails with the line of the key, or with file and line of a template. */
void code_check_value(const struct code *code, struct ini_text *at, enum code_key key,
                      const char *value);

/* The missing program of the command or of ic: the word that names it, its length and its key;
 * NULL: nothing is missing. way: complete. */
const char *code_missing_program(const struct code *code, const struct code_way *way,
                                 enum code_key *key, size_t *length);
/* STATUS_BAD_INPUT, with file and line, if a program is missing. */
enum status code_check_program(const struct code *code, const struct code_way *way,
                               struct error *error);

/* The path of the program that a word names, in CODE_PATH bytes: a file beside the code file, else
 * found by PATH; false: no such executable. */
bool code_find_program(const struct code *code, const char *word, size_t length,
                       char path[CODE_PATH]);

/* True for a regular file. */
bool code_is_file(const char *path);
