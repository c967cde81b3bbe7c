/* SPDX-License-Identifier: GPL-3.0-or-later
 * Formats in which the state of a run is written: a family, one file in writer/ and one line in
 * writers.def each. A file's name says by its ending which one is meant. Code units, double
 * precision; each file appears whole or not at all. */
#pragma once

#include "family.h"
#include "run.h"
#include "snapshots.h"

struct snapshot_writer {
    struct member member;
    const char *endings; /* of the names of its files: ".hdf5 .h5" */
    bool from_corner;    /* positions count from the lower corner of the box */
    double memory;       /* bytes for each particle that writing takes beside the state */
    /* NULL: always possible. STATUS_ENVIRONMENT: this program was built without it. */
    enum status (*possible)(const char *path, struct error *error);
    /* STATUS_ENVIRONMENT: it cannot be written. */
    enum status (*write)(const struct run_result *result, const char *path, struct error *error);
    /* Writes what lists the files of a series, those on the way and the one at the end; NULL: this
     * format has no such file. STATUS_ENVIRONMENT: it cannot be written. */
    enum status (*collect)(const struct run_result *result, const struct snapshots *snapshots,
                           struct error *error);
};
extern const struct family snapshot_writer_family;

/* The one that path means; csv for "-" and a name without an ending. NULL: STATUS_BAD_INPUT in
 * error, which names the endings that there are. */
const struct snapshot_writer *snapshot_writer_of(const char *path, struct error *error);

/* Its bytes for each particle; 0 where path means none. */
double snapshot_writer_memory(const char *path);

/* What a snapshot of ours says about its run, so that its reader needs no other source. */

enum { SNAPSHOT_REMARKS = 6, SNAPSHOT_REMARK_TEXT = 1024 };

struct snapshot_remark {
    const char *key;
    char value[SNAPSHOT_REMARK_TEXT];
};

/* Returns how many there are, at most SNAPSHOT_REMARKS: `case` (left out where its name is not
 * known), `time`, `gamma`, `box` (LO:HI for each direction), `boundary` (one word for all
 * directions, or one each), and `keys`: the measure window and the keys that the user gave and that
 * change the exact solution, KEY=VALUE separated by "; ". */
size_t snapshot_remarks(const struct run_result *result,
                        struct snapshot_remark remarks[SNAPSHOT_REMARKS]);
