/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reads snapshots that a test has written, and tests what readers note and refuse. Include after
 * test.h. */
#pragma once

#include "own_folder.h"
#include "snapshot_file.h"

static inline void put_bytes(const char *name, const void *bytes, size_t size)
{
    FILE *out = fopen(path_of(name), "wb");
    assert_true(out && fwrite(bytes, 1, size, out) == size && fclose(out) == 0);
}

/* Reads the file of this name, and checks its gas. */
static inline enum status read_gas(const char *name, const struct snapshot_options *options,
                                   struct snapshot_file *file, struct error *error)
{
    *error = (struct error){0};
    const enum status status = snapshot_read(path_of(name), options, file, error);
    return status ? status : snapshot_check_gas(path_of(name), file, error);
}

/* The file of this name must be refused with these words. what: for a message. True if it has an
 * impossible value. */
static inline bool is_refused(const char *name, const struct snapshot_options *options,
                              const char *what, const char *says)
{
    struct snapshot_file file;
    struct error error;
    const enum status status = read_gas(name, options, &file, &error);
    snapshot_file_free(&file);
    if (status != STATUS_BAD_INPUT || !strstr(error.message, says))
        fail_msg("%s: status %d: '%s' is not in: %s", what, (int)status, says, error.message);
    return file.impossible;
}

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
