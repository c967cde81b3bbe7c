/* SPDX-License-Identifier: GPL-3.0-or-later
 * Draws random JSON documents from a template, and hashes the pages made from them, so that a list
 * of hashes shows whether any byte of hundreds of pages has changed.
 *
 * A template is JSON. "@NAME": the template's member NAME. "#": a number, often a special one (0,
 * 1e200, NaN). "#n": an integer from 1 to 12. "#t": text that HTML has to escape. ["|", a, b, ...]:
 * one of them. ["*", low, high, a]: a list of low to high times a. A member "NAME?" is left out in
 * one draw of four. All other values are copied. */
#pragma once

#include <inttypes.h>
#include <jansson.h>
#include <stdbool.h>

struct drawing {
    uint64_t state;
    const json_t *template;
};

/* A random number below n by SplitMix64 (Steele, Lea & Flood 2014). */
static inline size_t drawn_below(struct drawing *draw, size_t n)
{
    uint64_t z = draw->state += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return (size_t)((z ^ (z >> 31)) >> 16) % n;
}

/* A binary fraction, so that sums of two are exact; one in five is a special value. */
static inline double drawn_real(struct drawing *draw)
{
    static const double odd[] = {0,      0,      1,     1,    -1,      -0.5, 2,
                                 0.01,   0.009,  1e-17, 1e-6, 99999,   1e5,  12345,
                                 3.5e-9, 0.9995, 1024,  0.25, 1.0e200, 0.03};
    const size_t which = drawn_below(draw, 5 * sizeof odd / sizeof *odd);
    return which < sizeof odd / sizeof *odd ? odd[which]
                                            : (double)(1 + drawn_below(draw, 255)) / 64;
}

static inline json_t *drawn_number(struct drawing *draw)
{
    static const char *const words[] = {"nan", "inf", "-inf"};
    const size_t which = drawn_below(draw, 40);
    return which < 3 ? json_string(words[which]) : json_real(drawn_real(draw));
}

static inline json_t *drawn_document(struct drawing *draw, const json_t *of)
{
    static const char *const texts[] = {"",         "plain", "two_words", "a <b> & 'c' \"d\"",
                                        "\x01 odd", "W ≥ 0"};
    const char *text = json_string_value(of), *first = json_string_value(json_array_get(of, 0)),
               *name;
    json_t *made, *member;
    if (text && *text == '@')
        return drawn_document(draw, json_object_get(draw->template, text + 1));
    if (text && !strcmp(text, "#")) return drawn_number(draw);
    if (text && !strcmp(text, "#n")) return json_integer((json_int_t)(1 + drawn_below(draw, 12)));
    if (text && !strcmp(text, "#t"))
        return json_string(texts[drawn_below(draw, sizeof texts / sizeof *texts)]);
    if (first && !strcmp(first, "|"))
        return drawn_document(draw,
                              json_array_get(of, 1 + drawn_below(draw, json_array_size(of) - 1)));
    if (first && !strcmp(first, "*")) {
        const size_t low = (size_t)json_integer_value(json_array_get(of, 1));
        size_t n =
            low + drawn_below(draw, (size_t)json_integer_value(json_array_get(of, 2)) - low + 1);
        for (made = json_array(); n > 0; n--)
            json_array_append_new(made, drawn_document(draw, json_array_get(of, 3)));
        return made;
    }
    if (json_is_array(of)) {
        made = json_array();
        for (size_t i = 0; i < json_array_size(of); i++)
            json_array_append_new(made, drawn_document(draw, json_array_get(of, i)));
        return made;
    }
    if (!json_is_object(of)) return json_deep_copy(of);
    made = json_object();
    json_object_foreach((json_t *)of, name, member) {
        const size_t length = strlen(name), optional = length && name[length - 1] == '?';
        char key[64];
        if (optional && !drawn_below(draw, 4)) continue;
        snprintf(key, sizeof key, "%.*s", (int)(length - optional), name);
        json_object_set_new(made, key, drawn_document(draw, member));
    }
    return made;
}

/* FNV-1a of a text, continuing from the digest before. */
static inline uint64_t text_digest(uint64_t before, const char *text)
{
    uint64_t hash = before ? before : 0xcbf29ce484222325;
    for (; *text; text++) hash = (hash ^ (unsigned char)*text) * 0x100000001b3;
    return hash;
}

/* Digests as kept in data/drawn: "NAME-DRAW NUMBER", those of a draw in one line. With
 * SPHPROOF_KEEP=FOLDER in the environment the texts are written there instead, to be compared with
 * those of another build, and so are the new lists for data/drawn. */
struct digests {
    FILE *file;
    const char *folder;
    char draw[16]; /* the last one written */
};

static inline void digests_open(struct digests *kept, const char *data, const char *list)
{
    char path[4096];
    *kept = (struct digests){.folder = getenv("SPHPROOF_KEEP")};
    snprintf(path, sizeof path, "%s/%s", kept->folder ? kept->folder : data, list);
    kept->file = fopen(path, kept->folder ? "w" : "r");
    assert_non_null(kept->file);
}

/* Compares a text with the digest kept under this name. Calls follow the order of the list. */
static inline void digests_compare(struct digests *kept, const char *name, const char *text)
{
    char path[4096], there[64] = "";
    uint64_t found = text_digest(0, text), expected = 0;
    if (kept->folder) {
        const char *draw = strrchr(name, '-') + 1;
        if (*kept->draw) fputs(strcmp(draw, kept->draw) ? "\n" : " ", kept->file);
        fprintf(kept->file, "%s %016" PRIx64, name, found);
        snprintf(kept->draw, sizeof kept->draw, "%s", draw);
        snprintf(path, sizeof path, "%s/%s", kept->folder, name);
        FILE *whole = fopen(path, "w");
        assert_non_null(whole);
        fputs(text, whole);
        fclose(whole);
        return;
    }
    const bool read = fscanf(kept->file, "%63s %" SCNx64, there, &expected) == 2;
    if (!read || strcmp(there, name) || found != expected)
        fail_msg("%s is another text than before (see verify/test/keep)", name);
}

static inline void digests_close(struct digests *kept)
{
    char more[64];
    const bool all = kept->folder || fscanf(kept->file, "%63s", more) != 1;
    if (kept->folder) fputs("\n", kept->file);
    fclose(kept->file);
    assert_true(all);
}

static inline json_t *read_template(const char *folder, const char *name)
{
    char path[4096];
    json_error_t error;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    json_t *template = json_load_file(path, 0, &error);
    if (!template) fail_msg("%s:%d: %s", path, error.line, error.text);
    return template;
}
