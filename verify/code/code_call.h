/* SPDX-License-Identifier: GPL-3.0-or-later
 * The call of another code: the values of @WORDS@, the words of its command, its filled-in
 * templates, and the files that decide its result. */
#pragma once

#include "code_run.h"
#include "sha256.h"

enum { CODE_TEXT = 160 };

struct code_values {
    const char *of[CODE_WORDS]; /* NULL: not known yet, stays as it is */
    char text[CODE_WORDS][CODE_TEXT];
    char parameters[CODE_PATH];
};

/* start: of run_start; NULL: values that depend on the particles stay unknown. */
void code_values(struct code_values *values, const struct code_external *external,
                 const struct run *run, const struct run_result *start);

/* The arguments of a command: @WORDS@ are filled in, and files beside the code file become paths;
 * with the key shell `sh -c COMMAND`. Malloced, ends with NULL; NULL: no memory. */
char **code_words_of(const struct code_external *external, const char *command,
                     const struct code_values *values);
void code_words_free(char **words);
/* The words as one line, malloced; NULL: no memory. */
char *code_words_line(char **words);

/* Writes the templates into a folder, filled in. */
enum status code_write_templates(const struct code_external *external,
                                 const struct code_values *values, const char *folder,
                                 struct error *error);

/* Refuses keys of the scheme, which apply to our solver only. */
enum status code_check_keys(const struct code_external *external, const struct run *run,
                            struct error *error);

/* Adds to a cache key the filled texts and checksums of the files that decide what the code
 * computes. */
enum status code_add_key(const struct run_external *external, const struct run *run, json_t *key,
                         struct error *error);

/* The checksum of the command's program; "" if it cannot be read. */
void code_program_sum(const struct code_external *external, char sum[SHA256_TEXT]);
