/* SPDX-License-Identifier: GPL-3.0-or-later
 * JSON documents for tests of diff. Include after test.h. */
#pragma once

#include "diff.h"

static inline json_t *run_with(double l1, double cpu_s)
{
    return json_pack("{s:s, s:{s:{s:f}}, s:{s:f, s:f}}", "command", "run", "errors", "density",
                     "l1", l1, "cost", "cpu_s", cpu_s, "wall_s", cpu_s);
}

/* Takes over both documents. */
static inline enum status differ(json_t *old, json_t *new, struct diff *diff)
{
    struct error error = {0};
    const enum status status = diff_documents(old, new, DIFF_THRESHOLD, diff, &error);
    if (status == STATUS_BAD_INPUT) assert_int_equal(error.status, status);
    return status;
}

static inline const struct difference *find(const struct diff *diff, const char *path)
{
    for (size_t i = 0; i < diff->count; i++) {
        const struct difference *d = &diff->list[i];
        if (strcmp(d->new ? d->new->path : d->old->path, path) == 0) return d;
    }
    return NULL;
}

/* Sets member `name` of `inside` (NULL: of the document itself) to the value in the JSON text. */
static inline void put(json_t *document, const char *inside, const char *name, const char *text)
{
    json_t *object = document;
    if (!text) return;
    if (inside) {
        object = json_object_get(document, inside);
        if (!object) json_object_set_new(document, inside, object = json_object());
    }
    json_object_set_new(object, name, json_loads(text, JSON_DECODE_ANY, NULL));
}
