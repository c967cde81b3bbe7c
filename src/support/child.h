/* SPDX-License-Identifier: GPL-3.0-or-later
 * Other programs, run to their end. */
#pragma once

#include "status.h"

struct child_said {
    int exit;            /* its exit status; 128 + N: ended by signal N */
    char *output;        /* what it printed; malloced, never NULL where child_run was well */
    char complaint[400]; /* the beginning of what it said on standard error, cleaned */
};

/* Runs a program (words[0], found by PATH; words ends with NULL) without standard input, and waits
 * for it. An interrupt from the terminal does not reach it. STATUS_ENVIRONMENT: there is no such
 * program, or no process; said then needs no child_free. */
enum status child_run(const char *const *words, struct child_said *said, struct error *error);
void child_free(struct child_said *said);
