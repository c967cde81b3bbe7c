/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests which assumptions a reader notes. Include after test.h. */
#pragma once

#include "snapshot_file.h"

/* Fails unless the file has exactly one note `what`, with this value and with evidence that
 * contains these words, or no such note if value is NULL. */
static inline void noted(const struct snapshot_file *file, const char *what, const char *value,
                         const char *words)
{
    const struct snapshot_note *found = NULL;
    for (size_t k = 0; k < file->notes.count; k++)
        if (strcmp(file->notes.note[k].what, what) == 0) {
            if (found) fail_msg("%s is said twice", what);
            found = &file->notes.note[k];
        }
    if (!found != !value) fail_msg("%s is %ssaid", what, found ? "" : "not ");
    if (!value) return;
    if (strcmp(found->value, value) != 0 || !strstr(found->evidence, words))
        fail_msg("%s: '%s', '%s'; not '%s', '%s'", what, found->value, found->evidence, value,
                 words);
}
