/* SPDX-License-Identifier: GPL-3.0-or-later
 * Case files; those that are accepted go on to the plan of their run. */
#include <stdlib.h>

#include "fuzz.h"

void fuzz_one(const uint8_t *bytes, size_t size)
{
    struct run_settings settings = {.threads = 1};
    struct error error = {0};
    char *text = fuzz_text(bytes, size);
    const enum status status = case_parse(&settings.file, "fuzz.ini", text, size, &error);
    free(text);
    if (status) {
        fuzz_refused(status, &error);
        return;
    }
    settings.settings = settings.file.settings;
    fuzz_plan(&settings);
}
