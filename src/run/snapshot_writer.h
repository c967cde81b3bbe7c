/* SPDX-License-Identifier: GPL-3.0-or-later
 * Formats for the state of a run: a family, one file in writer/ and one line in writers.def each.
 * The suffix of a file name selects the format. Code units, double precision; a file is written
 * completely or not at all. */
#pragma once

#include "family.h"
#include "run.h"
#include "snapshots.h"

struct snapshot_writer {
    struct member member;
    const char *endings; /* suffixes of file names: ".hdf5 .h5" */
    bool from_corner;    /* positions are relative to the lower corner of the box */
    double memory;       /* bytes per particle needed for writing, beside the state */
    /* STATUS_ENVIRONMENT: the program was built without the format. NULL: always possible. */
    enum status (*possible)(const char *path, struct error *error);
    /* STATUS_ENVIRONMENT: the file cannot be written. */
    enum status (*write)(const struct run_result *result, const char *path, struct error *error);
    /* Writes a file that lists a series of snapshots: the intermediate ones and the final one.
     * NULL: the format has no such file. STATUS_ENVIRONMENT: it cannot be written. */
    enum status (*collect)(const struct run_result *result, const struct snapshots *snapshots,
                           struct error *error);
};
extern const struct family snapshot_writer_family;

/* The writer for path; csv for "-" and for names without a suffix. NULL: unknown suffix,
 * STATUS_BAD_INPUT in error, which lists the known ones. */
const struct snapshot_writer *snapshot_writer_of(const char *path, struct error *error);

/* The writer's bytes per particle; 0 for an unknown suffix. */
double snapshot_writer_memory(const char *path);

/* Metadata of a run in its snapshots, sufficient to judge them without other sources. */

enum { SNAPSHOT_REMARKS = 6, SNAPSHOT_REMARK_TEXT = 1024 };

struct snapshot_remark {
    const char *key;
    char value[SNAPSHOT_REMARK_TEXT];
};

/* Returns their number, at most SNAPSHOT_REMARKS: `case` (omitted if the name is unknown), `time`,
 * `gamma`, `box` (LO:HI per direction), `boundary` (one word, or one per direction), and `keys`:
 * the measure window and the keys given by the user that change the exact solution, KEY=VALUE
 * separated by "; ". */
size_t snapshot_remarks(const struct run_result *result,
                        struct snapshot_remark remarks[SNAPSHOT_REMARKS]);
