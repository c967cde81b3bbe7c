/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs a program as a filter: writes its input, reads its output, checks its exit status; or keeps
 * it running for one request after another. */
#pragma once

#include "buffer.h"

enum process_status {
    PROCESS_OK,
    PROCESS_NOT_FOUND, /* no such program on the PATH */
    PROCESS_TOO_SLOW,  /* stopped */
    PROCESS_FAILED     /* message: exit status or signal, and its last words */
};

/* Writes input to the program (argv[0], found on the PATH) and reads its standard output. Whatever
 * the program does (closing its input early, hanging, crashing), the call returns a status: no
 * SIGPIPE, no zombie; the program is killed after `seconds`. message (n bytes) is for the user. */
enum process_status process_filter(char *const argv[], const char *input, size_t size, int seconds,
                                   struct buffer *output, char *message, size_t n);

/* A program that answers one request after another; {0}: not running. */
struct process {
    int pid, in, out, err; /* our ends of the pipes */
};

/* As process_filter with a program that keeps running: the answer is its output up to `mark`, or
 * all output if it ends. Starts the program if necessary; a failure ends it, and the next request
 * starts it again. `file` becomes its descriptor 3 (-1: none). */
enum process_status process_ask(struct process *process, char *const argv[], int file,
                                const char *input, size_t size, const char *mark, int seconds,
                                struct buffer *output, char *message, size_t n);

/* Kills the program if it is running. */
void process_end(struct process *process);
