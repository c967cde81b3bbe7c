/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checkpoints: a file with the state of a run, from which the run continues to the last bit. The
 * file has all that the next step depends on, as it is in memory, with a checksum. It is valid only
 * for the same build of the program and the same settings. (Snapshots are for other programs and do
 * not contain all that a step needs.) */
#pragma once

#include <stdbool.h>

#include "growth.h"
#include "simulation.h"
#include "trace.h"

struct checkpoint {
    const char *path;
    const char *build; /* of the program; at most CHECKPOINT_WORD letters */
    const char *run;   /* JSON object on one line: everything that decides the result of the run */
    double every;      /* seconds of wall time between two writes */
    bool resume;       /* start from the file if it exists */
    double snapshot;   /* saved with the state: time of the last intermediate snapshot; < 0: none */
    struct trace *trace; /* saved with the state: the time series so far; NULL: none is kept */
    /* set by the functions below: */
    bool begun;           /* `written` is set */
    double written;       /* when the file was last written, or checkpoint_due first called */
    struct error trouble; /* why the last write failed, which leaves the previous file */
};

enum { CHECKPOINT_WORD = 63 };

/* True if it is time to write the file. */
bool checkpoint_due(struct checkpoint *checkpoint);

/* Writes the file. A failure leaves the previous file and sets checkpoint->trouble. */
void checkpoint_save(struct checkpoint *checkpoint, struct simulation *simulation,
                     struct growth *growth);

/* Restores a simulation that was just created; does nothing if there is no file. STATUS_BAD_INPUT:
 * the file is damaged, or of another build or run (the message names the key that differs); the
 * caller must then destroy the simulation. */
enum status checkpoint_load(struct checkpoint *checkpoint, struct simulation *simulation,
                            struct growth *growth, struct error *error);
