/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine.h"

#include <string.h>

#include "text.h"

const struct engine engine_local = {.name = "local", .label = "processes on this machine"};

static const struct engine *const engines[] = {
#define ENGINE(name) &engine_##name,
#include "engines.def"
#undef ENGINE
};
enum { ENGINES = sizeof engines / sizeof *engines };

const struct engine *engine_find(const char *name, struct error *error)
{
    const char *names[ENGINES];
    for (size_t i = 0; i < ENGINES; i++) {
        names[i] = engines[i]->name;
        if (strcmp(name, names[i]) == 0) return engines[i];
    }
    text_unknown(error, "--engine", "engine", name, names, ENGINES);
    return NULL;
}
