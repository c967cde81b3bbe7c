/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "code_check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "slab.h"
#include "text.h"

bool code_is_file(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISREG(info.st_mode);
}

static bool can_execute(const char *path)
{
    return code_is_file(path) && access(path, X_OK) == 0;
}

bool code_find_program(const struct code *code, const char *word, size_t length,
                       char path[CODE_PATH])
{
    const char *folders = getenv("PATH");
    if (code_beside(code, word, length, path) && can_execute(path)) return true;
    if (memchr(word, '/', length) || !folders) return false;
    for (const char *at = folders; *at;) {
        const size_t n = strcspn(at, ":");
        const int used = snprintf(path, CODE_PATH, "%.*s/%.*s", (int)n, at, (int)length, word);
        if (n && used < CODE_PATH && can_execute(path)) return true;
        at += n + (at[n] == ':');
    }
    return false;
}

/* Fails if @WORD@ is unknown; file and line: of a template, else NULL. */
static bool words_known(struct ini_text *at, const char *text, const char *file, int line)
{
    const char *names[CODE_WORDS];
    char spelled[CODE_WORDS][CODE_NAME], unknown[CODE_NAME], where[CODE_PATH];
    if (!code_unknown_word(text, unknown)) return true;
    for (int w = 0; w < CODE_WORDS; w++) {
        snprintf(spelled[w], CODE_NAME, "@%s@", code_words[w]->name);
        names[w] = spelled[w];
    }
    snprintf(where, sizeof where, "%.200s:%d", file ? file : at->path, file ? line : at->line);
    text_unknown(at->error, where, "word", unknown, names, CODE_WORDS);
    at->failed = true;
    return false;
}

static bool template_known(struct ini_text *at, const char *path)
{
    char *line = NULL;
    size_t capacity = 0;
    bool known = true;
    FILE *file = fopen(path, "r");
    if (!file) {
        ini_text_fail_value(at, "parameters", path, "files that can be read");
        return false;
    }
    for (int number = 1; known && getline(&line, &capacity, file) >= 0; number++)
        known = words_known(at, line, path, number);
    free(line);
    fclose(file);
    return known;
}

static void check_files(const struct code *code, struct ini_text *at, enum code_key key,
                        const char *value)
{
    char path[CODE_PATH];
    size_t length;
    const char *rest = value;
    for (const char *word; !at->failed && (word = code_next_word(&rest, &length));)
        if (!code_beside(code, word, length, path) || !code_is_file(path)) {
            snprintf(path, sizeof path, "%.*s", (int)length, word);
            ini_text_fail_value(at, code_keys[key].name, path,
                                "files that are there, relative to the code file");
        } else if (key == CODE_parameters) {
            template_known(at, path);
        }
}

static void check_ic(struct ini_text *at, const char *value)
{
    struct error reason;
    char where[CODE_PATH];
    if (strchr(value, '@')) {
        if (words_known(at, value, NULL, 0) && !strstr(value, "@IC@"))
            ini_text_fail_value(at, "ic", value, code_keys[CODE_ic].allowed);
        return;
    }
    if (start_format_of(value, &reason)) return;
    snprintf(where, sizeof where, "%.200s:%d: ic", at->path, at->line);
    text_unknown_member(at->error, where, "format", value, &start_format_family);
    at->failed = true;
}

static bool one_of(const char *words, const char *value)
{
    size_t length;
    for (const char *rest = words, *word; (word = code_next_word(&rest, &length));)
        if (strlen(value) == length && strncmp(word, value, length) == 0) return true;
    return false;
}

void code_check_value(const struct code *code, struct ini_text *at, enum code_key key,
                      const char *value)
{
    struct code_way way = {.line[CODE_memory] = 1, .line[CODE_timeout] = 1};
    snprintf(way.value[key], sizeof way.value[key], "%s", value);
    const char *allowed = code_keys[key].allowed;
    bool good = true;
    switch (key) {
    case CODE_title:
    case CODE_command:
    case CODE_snapshot:
        good = *value;
        if (good) words_known(at, value, NULL, 0);
        break;
    case CODE_ic:
        check_ic(at, value);
        break;
    case CODE_parameters:
    case CODE_depends:
        check_files(code, at, key, value);
        break;
    case CODE_timeout:
        good = code_timeout(&way) > 0;
        break;
    case CODE_memory:
        good = code_memory(&way) > 0;
        break;
    case CODE_as_3d:
        good = strcmp(value, "no") == 0 || slab_layers(value);
        break;
    default:
        good = one_of(allowed, value);
    }
    if (!good) ini_text_fail_value(at, code_keys[key].name, value, allowed);
}

/* The first word of a command if there is no such program; NULL: it exists, or the shell finds
 * it. */
static const char *missing(const struct code *code, const struct code_way *way, enum code_key key,
                           size_t *length)
{
    char path[CODE_PATH];
    const char *rest = way->value[key];
    const char *word = code_is(way, CODE_shell, "yes") ? NULL : code_next_word(&rest, length);
    const bool there =
        !word || memchr(word, '@', *length) || code_find_program(code, word, *length, path);
    return there ? NULL : word;
}

const char *code_missing_program(const struct code *code, const struct code_way *way,
                                 enum code_key *key, size_t *length)
{
    const char *word = missing(code, way, *key = CODE_command, length);
    return word || code_format(way) ? word : missing(code, way, *key = CODE_ic, length);
}

enum status code_check_program(const struct code *code, const struct code_way *way,
                               struct error *error)
{
    enum code_key key;
    size_t length;
    struct ini_text at = {.path = code->path, .error = error};
    if (!code_missing_program(code, way, &key, &length)) return STATUS_OK;
    at.line = way->line[key];
    return ini_text_fail_value(&at, code_keys[key].name, way->value[key],
                               "a program beside the code file, or in PATH");
}
