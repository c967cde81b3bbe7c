/* SPDX-License-Identifier: GPL-3.0-or-later
 * Values of code files, @NAME@ in texts, and lists that blanks separate. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "buffer.h"
#include "code_file.h"
#include "text.h"

const struct code_key_text code_keys[CODE_KEYS] = {
#define KEY(name, fallback, allowed, meaning) {#name, fallback, allowed, meaning},
    CODE_KEY_LIST(KEY)
#undef KEY
};

/* ---- values ---- */

const char *code_value(const struct code_way *way, enum code_key key)
{
    return way->line[key] ? way->value[key] : code_keys[key].fallback;
}

double code_timeout(const struct code_way *way)
{
    double seconds = 0;
    return text_real(code_value(way, CODE_timeout), &seconds) ? seconds : 0;
}

double code_memory(const struct code_way *way)
{
    const char *text = code_value(way, CODE_memory);
    char number[INI_TEXT_LINE + 1];
    double value = 0;
    if (strcmp(text, "none") == 0) return INFINITY;
    snprintf(number, sizeof number, "%s", text);
    char *unit = strpbrk(number, "MG");
    if (!unit || strcmp(unit + 1, "B") != 0) return 0;
    const double bytes = *unit == 'M' ? 1e6 : 1e9;
    while (unit > number && unit[-1] == ' ') unit--;
    *unit = '\0';
    return text_real(number, &value) ? bytes * value : 0;
}

bool code_is(const struct code_way *way, enum code_key key, const char *word)
{
    return strcmp(code_value(way, key), word) == 0;
}

const struct start_format *code_format(const struct code_way *way)
{
    struct error ignored;
    return start_format_of(code_value(way, CODE_ic), &ignored);
}

bool code_beside(const struct code *code, const char *name, size_t length, char path[CODE_PATH])
{
    const int n = *name == '/'
                      ? snprintf(path, CODE_PATH, "%.*s", (int)length, name)
                      : snprintf(path, CODE_PATH, "%s/%.*s", code->folder, (int)length, name);
    return n < CODE_PATH;
}

/* ---- words ---- */

#define WORD(name, meaning) static const struct member word_##name = {#name, meaning, ""};
CODE_WORD_LIST(WORD)
#undef WORD
const struct member *const code_words[CODE_WORDS] = {
#define WORD(name, meaning) &word_##name,
    CODE_WORD_LIST(WORD)
#undef WORD
};

/* The length of @WORD@ at text, 0: none begins there. */
static size_t word_at(const char *text)
{
    if (*text != '@') return 0;
    const size_t length = strspn(text + 1, "ABCDEFGHIJKLMNOPQRSTUVWXYZ_");
    return length && text[1 + length] == '@' ? length + 2 : 0;
}

static enum code_word find_word(const char *text, size_t length)
{
    int word = 0;
    while (word < CODE_WORDS && (strlen(code_words[word]->name) != length - 2 ||
                                 strncmp(code_words[word]->name, text + 1, length - 2) != 0))
        word++;
    return (enum code_word)word;
}

bool code_unknown_word(const char *text, char word[CODE_NAME])
{
    for (size_t length; *text; text += length ? length : 1) {
        length = word_at(text);
        if (!length || find_word(text, length) < CODE_WORDS) continue;
        snprintf(word, CODE_NAME, "%.*s", (int)length, text);
        return true;
    }
    return false;
}

char *code_fill(const char *text, const char *const *values)
{
    struct buffer filled = {0};
    buffer_add(&filled, "");
    for (size_t length; *text; text += length ? length : 1) {
        length = word_at(text);
        const enum code_word word = length ? find_word(text, length) : CODE_WORDS;
        if (word < CODE_WORDS && values[word])
            buffer_add(&filled, values[word]);
        else
            buffer_add_bytes(&filled, text, length ? length : 1);
    }
    return buffer_take(&filled);
}

const char *code_next_word(const char **rest, size_t *length)
{
    const char *at = *rest + strspn(*rest, " \t");
    const bool quoted = *at == '"';
    at += quoted;
    *length = strcspn(at, quoted ? "\"" : " \t");
    *rest = at + *length + (quoted && at[*length]);
    return *at || quoted ? at : NULL;
}
