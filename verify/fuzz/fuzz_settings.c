/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fuzzes KEY=VALUE arguments, one a line, for a built-in case. Accepted ones are written as text
 * and read again, and the plan of the run is made. */
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"

enum { ARGUMENTS_MAX = 64 };

static void same_again(const struct settings *settings)
{
    for (int i = 0; i < SETTINGS; i++) {
        struct settings again = *settings;
        struct error error = {0};
        char text[SETTING_TEXT_MAX];
        if (settings->value[i].automatic) continue;
        settings_text(settings, (enum setting)i, text);
        FUZZ_PROMISE(!settings_set(&again, (enum setting)i, text, SOURCE_USER, NULL, &error));
        FUZZ_PROMISE(again.value[i].choice == settings->value[i].choice);
        for (int k = 0; k < SETTING_REALS_MAX; k++)
            FUZZ_PROMISE(again.value[i].real[k] == settings->value[i].real[k]);
    }
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    struct run_settings settings;
    struct error error = {0};
    char *text = fuzz_text(bytes, size), *arguments[ARGUMENTS_MAX], *rest = NULL;
    int n = 0;
    for (char *line = strtok_r(text, "\n", &rest); line && n < ARGUMENTS_MAX;
         line = strtok_r(NULL, "\n", &rest))
        arguments[n++] = line;
    const char *name = size && bytes[size - 1] == '~' ? "sound_wave" : "sod";
    const enum status status = run_prepare(&settings, name, n, arguments, &error);
    if (status)
        fuzz_refused(status, &error);
    else {
        same_again(&settings.settings);
        fuzz_plan(&settings);
    }
    free(text);
}
