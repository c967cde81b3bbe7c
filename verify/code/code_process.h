/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs a program in a process group of its own under a supervising process, which ends the group
 * when time or memory is exhausted, when the program has ended, or when this process ends in any
 * way. No process is left running. */
#pragma once

#include <stdbool.h>

#include "status.h"

struct code_order {
    const char *const *words; /* the program, a path or found by PATH, and its arguments; ends with
                               * NULL */
    const char *folder; /* the program starts there; its output goes to files stdout and stderr */
    double seconds, bytes; /* limits: of wall time; of the memory of all processes together */
    bool remove;           /* remove the folder if this process ends first */
};

enum code_ending { CODE_ENDED, CODE_LATE, CODE_LARGE };

struct code_outcome {
    enum code_ending ending;
    int exit;             /* its exit status; 128 + N: ended by signal N */
    double wall_s, cpu_s; /* of all of its processes */
};

/* STATUS_ENVIRONMENT: no process. */
enum status code_process(const struct code_order *order, struct code_outcome *outcome,
                         struct error *error);

/* Removes a folder and all that is in it. */
void code_remove(const char *folder);
