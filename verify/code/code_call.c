/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "code_call.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "buffer.h"
#include "code_check.h"
#include "output.h"
#include "text.h"

/* ---- values ---- */

/* The name of a filled-in template. */
static void template_name(const char *word, size_t length, char name[CODE_PATH])
{
    const char *base = word;
    for (size_t i = 0; i < length; i++)
        if (word[i] == '/') base = word + i + 1;
    length -= (size_t)(base - word);
    if (length > 3 && strncmp(base + length - 3, ".in", 3) == 0) length -= 3;
    snprintf(name, CODE_PATH, "%.*s", (int)length, base);
}

/* Writes a number with 15 digits, or with 17 if those do not read back equal. */
static size_t write_real(char *text, size_t size, double value)
{
    double read;
    const int used = snprintf(text, size, "%.15g", value);
    return text_real(text, &read) && read == value ? (size_t)used
                                                   : (size_t)snprintf(text, size, "%.17g", value);
}

/* Ends of the box in the coordinates of the initial state's format. */
static void ends_text(const struct code_external *external, const struct run_result *start,
                      bool upper, char text[CODE_TEXT])
{
    const struct start_format *format = code_format(&external->of->way);
    const struct domain *box = &start->problem.domain;
    size_t used = 0;
    for (int d = 0; d < box->dim && used < CODE_TEXT; d++) {
        const double corner = format && format->writer->from_corner ? box->lo[d] : 0;
        if (d) text[used++] = ' ';
        used +=
            write_real(text + used, CODE_TEXT - used, (upper ? box->hi[d] : box->lo[d]) - corner);
    }
}

static void set_real(struct code_values *values, enum code_word word, double value)
{
    write_real(values->text[word], CODE_TEXT, value);
    values->of[word] = values->text[word];
}

void code_values(struct code_values *values, const struct code_external *external,
                 const struct run *run, const struct run_result *start)
{
    const struct code_way *way = &external->of->way;
    const struct start_format *format = code_format(way);
    const char *endings = format && format->writer->endings ? format->writer->endings : "",
               *rest = way->value[CODE_parameters];
    size_t length;
    *values = (struct code_values){.of[CODE_WORD_OUT] = "out",
                                   .of[CODE_WORD_HERE] = external->code->folder,
                                   .of[CODE_WORD_PARAMETERS] = values->parameters};
    snprintf(values->text[CODE_WORD_IC], CODE_TEXT, "ic%.*s", (int)strcspn(endings, " "), endings);
    values->of[CODE_WORD_IC] = values->text[CODE_WORD_IC];
    const char *word = code_next_word(&rest, &length);
    if (word) template_name(word, length, values->parameters);
    values->of[CODE_WORD_CASE] = run->asked.file.name;
    set_real(values, CODE_WORD_T_END, settings_real(&run->settings, SETTING_t_end));
    set_real(values, CODE_WORD_DIM, run->asked.layers ? 3 : run->asked.file.dimension);
    set_real(values, CODE_WORD_GAMMA, run->problem.gamma);
    set_real(values, CODE_WORD_THREADS, run->asked.threads);
    set_real(values, CODE_WORD_SEED, settings_real(&run->settings, SETTING_seed));
    if (!start) return;
    set_real(values, CODE_WORD_N, (double)start->n);
    set_real(values, CODE_WORD_SPACING, start->spacing);
    ends_text(external, start, false, values->text[CODE_WORD_LO]);
    ends_text(external, start, true, values->text[CODE_WORD_HI]);
    values->of[CODE_WORD_LO] = values->text[CODE_WORD_LO];
    values->of[CODE_WORD_HI] = values->text[CODE_WORD_HI];
}

/* ---- the command ---- */

void code_words_free(char **words)
{
    for (size_t i = 0; words && words[i]; i++) free(words[i]);
    free(words);
}

/* The path of the file that a word names, or the word itself. */
static void word_file(const struct code *code, const char *word, size_t length, bool program,
                      char path[CODE_PATH])
{
    if (program && code_find_program(code, word, length, path)) return;
    if (code_beside(code, word, length, path) && code_is_file(path)) return;
    snprintf(path, CODE_PATH, "%.*s", (int)length, word);
}

char **code_words_of(const struct code_external *external, const char *command,
                     const struct code_values *values)
{
    enum { MOST = INI_TEXT_LINE + 2 };
    char **words = calloc(MOST, sizeof *words), path[CODE_PATH];
    const char *rest = command;
    size_t n = 0, length;
    bool sound = words != NULL;
    if (sound && code_is(&external->of->way, CODE_shell, "yes")) {
        words[n++] = strdup("sh");
        words[n++] = strdup("-c");
        words[n++] = code_fill(command, values->of);
        rest = "";
    }
    for (const char *word; sound && (word = code_next_word(&rest, &length)); n++) {
        word_file(external->code, word, length, n == 0, path);
        words[n] = code_fill(path, values->of);
        sound = words[n] != NULL;
    }
    for (size_t i = 0; sound && i < n; i++) sound = words[i] != NULL;
    if (sound) return words;
    for (size_t i = 0; words && i < n; i++) free(words[i]);
    free(words);
    return NULL;
}

char *code_words_line(char **words)
{
    struct buffer line = {0};
    for (size_t i = 0; words[i]; i++) buffer_format(&line, "%s%s", i ? " " : "", words[i]);
    return buffer_take(&line);
}

/* ---- templates ---- */

/* The template that a word names, filled in; malloced. NULL: it cannot be read, or no memory. */
static char *fill_template(const struct code *code, const char *word, size_t length,
                           const struct code_values *values)
{
    struct buffer text = {0};
    char path[CODE_PATH], bytes[4096], *filled = NULL;
    FILE *file = code_beside(code, word, length, path) ? fopen(path, "r") : NULL;
    if (!file) return NULL;
    buffer_add(&text, "");
    for (size_t got; (got = fread(bytes, 1, sizeof bytes, file)) > 0;)
        buffer_add_bytes(&text, bytes, got);
    fclose(file);
    char *whole = buffer_take(&text);
    if (whole) filled = code_fill(whole, values->of);
    free(whole);
    return filled;
}

enum status code_write_templates(const struct code_external *external,
                                 const struct code_values *values, const char *folder,
                                 struct error *error)
{
    const char *rest = external->of->way.value[CODE_parameters];
    char path[CODE_PATH], name[CODE_PATH], to[2 * CODE_PATH];
    enum status status = STATUS_OK;
    size_t length;
    for (const char *word; !status && (word = code_next_word(&rest, &length));) {
        char *text = fill_template(external->code, word, length, values);
        template_name(word, length, name);
        snprintf(to, sizeof to, "%s/%s", folder, name);
        code_beside(external->code, word, length, path);
        status =
            text ? output_text(to, text, error)
                 : error_set(error, STATUS_BAD_INPUT, "%.200s: it cannot be read any more", path);
        free(text);
    }
    return status;
}

/* ---- cache key ---- */

/* Checksum of a file; keeps sums so that each file is read once. */
static const char *sum_of(const char *path)
{
    enum { KEPT = 64 };
    static struct {
        char path[CODE_PATH], sum[SHA256_TEXT];
    } kept[KEPT];
    static size_t count;
    size_t i = 0;
    while (i < count && strcmp(kept[i].path, path) != 0) i++;
    if (i < count) return kept[i].sum;
    if (count < KEPT) count++;
    i = count - 1; /* the last entry is reused for files beyond the limit */
    snprintf(kept[i].path, sizeof kept[i].path, "%s", path);
    if (!sha256_file(path, kept[i].sum)) kept[i].sum[0] = '\0';
    return kept[i].sum;
}

/* Adds the checksums of files that are named by words of a command or of `depends`. In a command
 * for a shell, characters such as ; and | also separate words. */
static void add_files(const struct code_external *external, const struct code_values *values,
                      const char *words, bool command, json_t *files)
{
    char line[INI_TEXT_LINE + 1], path[CODE_PATH], name[CODE_PATH];
    const bool shell = command && code_is(&external->of->way, CODE_shell, "yes");
    bool program = command; /* the next word is that */
    size_t length;
    snprintf(line, sizeof line, "%s", words);
    for (char *at = line; shell && *(at += strcspn(at, ";|&<>()'\"`=")); at++) *at = ' ';
    const char *rest = line;
    for (const char *word; (word = code_next_word(&rest, &length)); program = false) {
        snprintf(name, sizeof name, "%.*s", (int)length, word);
        char *filled = code_fill(name, values->of);
        if (!filled) continue;
        word_file(external->code, filled, strlen(filled), program, path);
        if (code_is_file(path)) json_object_set_new(files, name, json_string(sum_of(path)));
        free(filled);
    }
}

static json_t *template_sums(const struct code_external *external, const struct code_values *values)
{
    const char *rest = external->of->way.value[CODE_parameters];
    char sum[SHA256_TEXT];
    json_t *list = json_array();
    size_t length;
    for (const char *word; (word = code_next_word(&rest, &length));) {
        struct sha256 of;
        char *text = fill_template(external->code, word, length, values);
        sha256_begin(&of);
        if (text) sha256_add(&of, text, strlen(text));
        sha256_end(&of, sum);
        json_array_append_new(list, json_string(sum));
        free(text);
    }
    return list;
}

enum status code_check_keys(const struct code_external *external, const struct run *run,
                            struct error *error)
{
    for (int key = 0; key < SETTINGS; key++)
        if (run->asked.settings.value[key].source == SOURCE_USER &&
            strcmp(setting_keys[key].section, "scheme") == 0)
            return error_set(
                error, STATUS_BAD_INPUT,
                "the key %s is of our solver, and %.80s computes; allowed with --code: "
                "keys of the sections [domain], [initial], [run] and [measure]",
                setting_keys[key].name, external->base.title);
    return STATUS_OK;
}

enum status code_add_key(const struct run_external *base, const struct run *run, json_t *key,
                         struct error *error)
{
    const struct code_external *external = (const struct code_external *)base;
    const struct code_way *way = &external->of->way;
    const char *command = way->value[CODE_command];
    struct code_values values;
    if (code_check_keys(external, run, error)) return error->status;
    code_values(&values, external, run, NULL);
    json_t *files = json_object();
    char *filled = code_fill(command, values.of);
    add_files(external, &values, way->value[CODE_depends], false, files);
    add_files(external, &values, command, true, files);
    if (!code_format(way)) add_files(external, &values, way->value[CODE_ic], true, files);
    json_t *code =
        json_pack("{s:s*, s:s, s:s, s:s, s:b, s:o, s:o}", "command", filled, "ic",
                  code_value(way, CODE_ic), "snapshot", way->value[CODE_snapshot], "elements",
                  code_value(way, CODE_elements), "shell", code_is(way, CODE_shell, "yes"), "files",
                  files, "templates", template_sums(external, &values));
    free(filled);
    if (code && run->asked.layers)
        json_object_set_new(code, "as_3d", json_integer(run->asked.layers));
    if (code && run->asked.equal_masses) json_object_set_new(code, "equal_masses", json_true());
    if (code && external->variation)
        json_object_set_new(code, "variation", json_integer((json_int_t)external->variation));
    if (code && !json_object_set_new(key, "code", code)) return STATUS_OK;
    return error_set(error, STATUS_ENVIRONMENT, "no memory for a run's key");
}

void code_program_sum(const struct code_external *external, char sum[SHA256_TEXT])
{
    const char *const here[CODE_WORDS] = {[CODE_WORD_HERE] = external->code->folder};
    const char *rest = external->of->way.value[CODE_command];
    char path[CODE_PATH], name[CODE_PATH];
    size_t length;
    const char *word = code_next_word(&rest, &length);
    sum[0] = '\0';
    if (!word || code_is(&external->of->way, CODE_shell, "yes")) return;
    snprintf(name, sizeof name, "%.*s", (int)length, word);
    char *filled = code_fill(name, here);
    if (filled) {
        word_file(external->code, filled, strlen(filled), true, path);
        snprintf(sum, SHA256_TEXT, "%s", sum_of(path));
    }
    free(filled);
}
