/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fuzzes result documents as read by diff: two, separated by a NUL byte, or one compared with
 * itself, where nothing may be worse. */
#include <stdlib.h>
#include <string.h>

#include "diff.h"
#include "fuzz.h"
#include "result.h"

static json_t *load(const uint8_t *bytes, size_t size)
{
    json_t *document;
    struct error error = {0};
    const enum status status = result_load(&document, fuzz_file(bytes, size), &error);
    if (status) fuzz_refused(status, &error);
    FUZZ_PROMISE(!status == (document != NULL));
    return document;
}

static void compare(const json_t *old, const json_t *new)
{
    struct diff diff;
    struct error error = {0};
    const enum status status = diff_documents(old, new, DIFF_THRESHOLD, &diff, &error);
    if (status && status != STATUS_CHECK_FAILED) {
        fuzz_refused(status, &error);
        return;
    }
    FUZZ_PROMISE(diff.well == (status == STATUS_OK));
    FUZZ_PROMISE(old != new || !(diff.regressions || diff.verdicts[VERDICT_VANISHED]));
    FUZZ_PROMISE(old != new || diff.well || !diff.compared);
    json_t *document = json_object();
    diff_add_json(&diff, document);
    char *text = result_text(document);
    FUZZ_PROMISE(text);
    free(text);
    json_decref(document);
    diff_free(&diff);
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    const uint8_t *middle = size ? memchr(bytes, 0, size) : NULL;
    const size_t first = middle ? (size_t)(middle - bytes) : size;
    json_t *old = load(bytes, first);
    json_t *new = middle ? load(middle + 1, size - first - 1) : json_incref(old);
    if (old && new) compare(old, new);
    json_decref(old);
    json_decref(new);
}
