/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run_output.h"

#include "user_solution.h"
#include "problem_list.h"
#include "result.h"

static json_t *choices_json(const struct setting_key *key, const struct setting_value *value)
{
    if (value->given == 1) return json_string(key->family->members[value->choices[0]]->name);
    json_t *words = json_array();
    for (int i = 0; i < value->given; i++)
        json_array_append_new(words, json_string(key->family->members[value->choices[i]]->name));
    return words;
}

json_t *settings_json(const struct settings *settings)
{
    json_t *object = json_object();
    for (int i = 0; i < SETTINGS; i++) {
        const struct setting_key *key = &setting_keys[i];
        const struct setting_value *value = &settings->value[i];
        json_t *item;
        if (problem_foreign(settings, (enum setting)i)) continue;
        if (key->type == SETTING_PATH && !settings->file[0]) continue;
        switch (key->type) {
        case SETTING_CHOICE:
            item = json_string(key->family->members[value->choice]->name);
            break;
        case SETTING_PATH:
            item = json_string(settings->file);
            break;
        case SETTING_CHOICES:
            item = choices_json(key, value);
            break;
        case SETTING_INTEGER:
        case SETTING_COUNT:
            item = json_integer((json_int_t)value->real[0]);
            break;
        default:
            if (value->given == 1 && key->type != SETTING_REALS) {
                item = json_real(value->real[0]);
                break;
            }
            item = json_array();
            for (int j = 0; j < value->given; j++)
                json_array_append_new(item, json_real(value->real[j]));
        }
        json_object_set_new(object, key->name, item);
    }
    if (settings->reference > 0)
        result_add(object, "reference=%s", user_solution_name(settings->reference));
    return object;
}
