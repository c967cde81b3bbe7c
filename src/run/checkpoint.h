/* SPDX-License-Identifier: GPL-3.0-or-later
 * The state of a run in a file, from which it goes on to the last bit: all that the next step
 * depends on, as it lies in memory, with a checksum, for the same build of the program and the same
 * settings only. (Snapshots are for other programs; they do not hold what a step needs.) */
#pragma once

#include <stdbool.h>

#include "growth.h"
#include "simulation.h"
#include "trace.h"

struct checkpoint {
    const char *path;
    const char *build;   /* of the program; of no more than CHECKPOINT_WORD letters */
    const char *run;     /* JSON object, one line: all that decides the run's result */
    double every;        /* seconds of wall time between two writes */
    bool resume;         /* begin with what the file has, if there is one */
    double snapshot;     /* goes with the state: time of the last snapshot on the way; < 0: none */
    struct trace *trace; /* likewise: the run's so far; NULL: none is kept */
    /* kept by the functions below: */
    bool begun;           /* written holds a time */
    double written;       /* when the file was last written, or the first question was asked */
    struct error trouble; /* why the last write failed: the file is then the one before */
};

enum { CHECKPOINT_WORD = 63 };

/* Is it time to write? */
bool checkpoint_due(struct checkpoint *checkpoint);

/* Writes the file: whole, or it stays as it was (trouble). */
void checkpoint_save(struct checkpoint *checkpoint, struct simulation *simulation,
                     struct growth *growth);

/* Puts the simulation, just created, where the file left off; does nothing where there is no file.
 * STATUS_BAD_INPUT: it is damaged, of another build or of another run (the message names the key
 * that differs); the simulation may then only be destroyed. */
enum status checkpoint_load(struct checkpoint *checkpoint, struct simulation *simulation,
                            struct growth *growth, struct error *error);
