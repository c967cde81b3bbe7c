/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fuzzes case files; for accepted ones also makes the plan of the run. */
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
