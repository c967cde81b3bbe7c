/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sweep.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text.h"

static enum status add_key(struct sweep *sweep, const char *word, struct error *error)
{
    const int key = setting_find(word);
    if (key < 0) return setting_unknown("--vary", word, error);
    if (key == SETTING_n)
        return error_set(error, STATUS_BAD_INPUT, "--vary n: the resolutions belong to --n");
    for (size_t i = 0; i < sweep->key_count; i++)
        if (sweep->keys[i].key == (enum setting)key)
            return error_set(error, STATUS_BAD_INPUT, "--vary: key %s is given twice", word);
    if (sweep->key_count == SWEEP_KEYS_MAX)
        return error_set(error, STATUS_BAD_INPUT, "--vary: at most %d keys", SWEEP_KEYS_MAX);
    sweep->keys[sweep->key_count++].key = (enum setting)key;
    return STATUS_OK;
}

/* word: shorter than SETTING_TEXT_MAX. */
static enum status add_value(struct sweep *sweep, const char *word, struct error *error)
{
    struct sweep_key *key = &sweep->keys[sweep->key_count - 1];
    struct settings trial;
    settings_init(&trial);
    if (settings_set(&trial, key->key, word, SOURCE_USER, "--vary", error)) return error->status;
    for (size_t i = 0; i < key->count; i++)
        if (strcmp(key->values[i], word) == 0)
            return error_set(error, STATUS_BAD_INPUT, "--vary: %s=%s is given twice",
                             setting_keys[key->key].name, word);
    if (key->count == SWEEP_VALUES_MAX)
        return error_set(error, STATUS_BAD_INPUT, "--vary %s: at most %d values",
                         setting_keys[key->key].name, SWEEP_VALUES_MAX);
    if (key->key == SETTING_kernel)
        settings_text(&trial, key->key,
                      key->values[key->count++]); /* includes the hash of a plug-in */
    else
        strcpy(key->values[key->count++], word);
    return STATUS_OK;
}

/* A key without values takes all members of its family. */
static enum status complete(struct sweep *sweep, struct error *error)
{
    sweep->count = 1;
    for (size_t i = 0; i < sweep->key_count; i++) {
        struct sweep_key *key = &sweep->keys[i];
        const struct family *family = setting_keys[key->key].family;
        if (key->count == 0 && !family)
            return error_set(error, STATUS_BAD_INPUT,
                             "--vary %s: a number's values are needed: --vary %s=VALUE,VALUE",
                             setting_keys[key->key].name, setting_keys[key->key].name);
        if (key->count == 0 && family->n > SWEEP_VALUES_MAX)
            return error_set(error, STATUS_BAD_INPUT,
                             "--vary %s: %zu values, at most %d: --vary %s=VALUE,VALUE",
                             setting_keys[key->key].name, family->n, SWEEP_VALUES_MAX,
                             setting_keys[key->key].name);
        if (key->count == 0)
            for (size_t m = 0; m < family->n; m++)
                snprintf(key->values[key->count++], SETTING_TEXT_MAX, "%s",
                         family->members[m]->name);
        sweep->count *= key->count;
    }
    return STATUS_OK;
}

enum status sweep_parse(struct sweep *sweep, const char *text, struct error *error)
{
    char word[SETTING_TEXT_MAX];
    memset(sweep, 0, sizeof *sweep);
    for (const char *rest = text; rest;) {
        const size_t length = strcspn(rest, ",");
        if (length == 0 || length >= sizeof word)
            return error_set(error, STATUS_BAD_INPUT,
                             "--vary '%.60s': allowed: KEY[,KEY ...] or KEY=VALUE,VALUE[,KEY ...]",
                             text);
        memcpy(word, rest, length);
        word[length] = '\0';
        char *equals = strchr(word, '=');
        if (equals) *equals = '\0';
        const bool value = !equals && sweep->key_count && sweep->keys[sweep->key_count - 1].count &&
                           setting_find(word) < 0;
        enum status status = value ? add_value(sweep, word, error) : add_key(sweep, word, error);
        if (!status && equals) status = add_value(sweep, equals + 1, error);
        if (status) return status;
        rest = rest[length] ? rest + length + 1 : NULL;
    }
    return complete(sweep, error);
}

static const char *value_of(const struct sweep *sweep, size_t combination, size_t key)
{
    for (size_t i = sweep->key_count; i-- > key + 1;) combination /= sweep->keys[i].count;
    return sweep->keys[key].values[combination % sweep->keys[key].count];
}

enum status sweep_apply(const struct sweep *sweep, size_t i, struct run_settings *settings,
                        struct error *error)
{
    settings->settings.shared |= sweep->count > 1;
    for (size_t k = 0; k < sweep->key_count; k++)
        if (settings_set(&settings->settings, sweep->keys[k].key, value_of(sweep, i, k),
                         SOURCE_USER, "--vary", error))
            return error->status;
    return STATUS_OK;
}

void sweep_label(const struct sweep *sweep, size_t i, char label[SWEEP_LABEL])
{
    size_t used = 0;
    label[0] = '\0';
    for (size_t k = 0; k < sweep->key_count && used < SWEEP_LABEL; k++)
        used += (size_t)snprintf(label + used, SWEEP_LABEL - used, "%s%s=%s", k ? " " : "",
                                 setting_keys[sweep->keys[k].key].name, value_of(sweep, i, k));
}

json_t *sweep_json(const struct sweep *sweep, size_t i)
{
    json_t *object = json_object();
    for (size_t k = 0; k < sweep->key_count; k++)
        json_object_set_new(object, setting_keys[sweep->keys[k].key].name,
                            json_string(value_of(sweep, i, k)));
    return object;
}

static int ascending(const void *a, const void *b)
{
    const size_t x = *(const size_t *)a, y = *(const size_t *)b;
    return (x > y) - (x < y);
}

enum status sweep_ladder(const char *text, size_t least, int dim, size_t ladder[CASE_LADDER_MAX],
                         size_t *count, struct error *error)
{
    const struct setting_key *key = &setting_keys[SETTING_n];
    char word[32];
    size_t n = 0;
    for (const char *rest = text; rest;) {
        const size_t length = strcspn(rest, ",");
        double value;
        int exponent;
        snprintf(word, sizeof word, "%.*s", (int)length, rest);
        if (length >= sizeof word || !text_count(word, &value, &exponent) ||
            !(value >= key->lo && value <= key->hi))
            return error_set(
                error, STATUS_BAD_INPUT,
                "--n: '%.40s': allowed: integers (or 64^2) from %.10g to %.10g, separated by "
                "commas",
                word, key->lo, key->hi);
        if (setting_check_power("--n: ", word, exponent, dim, error)) return error->status;
        if (n == CASE_LADDER_MAX)
            return error_set(error, STATUS_BAD_INPUT, "--n: at most %d resolutions",
                             CASE_LADDER_MAX);
        ladder[n++] = (size_t)value;
        rest = rest[length] ? rest + length + 1 : NULL;
    }
    qsort(ladder, n, sizeof *ladder, ascending);
    *count = 0;
    for (size_t i = 0; i < n; i++)
        if (*count == 0 || ladder[*count - 1] != ladder[i]) ladder[(*count)++] = ladder[i];
    if (*count < least)
        return error_set(error, STATUS_BAD_INPUT,
                         "--n '%.100s': %zu distinct resolutions; allowed: at least %zu", text,
                         *count, least);
    return STATUS_OK;
}
