/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs other programs. */
#pragma once

#include "status.h"

struct child_said {
    int exit;            /* exit status; 128 + N: ended by signal N */
    char *output;        /* standard output; malloced, never NULL if child_run succeeded */
    char complaint[400]; /* first line of standard error, cleaned */
};

/* Runs a program (words[0], found in PATH; words ends with NULL) without standard input, and waits
 * for it. It does not receive interrupts from the terminal. STATUS_ENVIRONMENT: no such program, or
 * no process; child_free is then not needed. */
enum status child_run(const char *const *words, struct child_said *said, struct error *error);
void child_free(struct child_said *said);
