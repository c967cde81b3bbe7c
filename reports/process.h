/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs a program as a filter: bytes in, bytes out, exit status checked; or keeps it running, for
 * one question after another. */
#pragma once

#include "buffer.h"

enum process_status {
    PROCESS_OK,
    PROCESS_NOT_FOUND, /* no such program on the PATH */
    PROCESS_TOO_SLOW,  /* stopped */
    PROCESS_FAILED     /* message says how: exit status, signal, its last words */
};

/* Feeds input to the program (argv[0], found on the PATH) and collects what it writes to standard
 * output. Whatever the program does (closing its input early, hanging, dying) ends here with a
 * status: no SIGPIPE, no zombie, killed after `seconds`. message (of n bytes) is for a person. */
enum process_status process_filter(char *const argv[], const char *input, size_t size, int seconds,
                                   struct buffer *output, char *message, size_t n);

/* A program that answers one question after another; {0}: it does not run. */
struct process {
    int pid, in, out, err; /* our ends of its pipes */
};

/* The same with a program that goes on running: its answer is what it writes up to `mark`, or all
 * that it writes if it ends without. It is started where it does not run; whatever fails ends it,
 * and the next question starts it again. `file` is its descriptor 3 (-1: none). */
enum process_status process_ask(struct process *process, char *const argv[], int file,
                                const char *input, size_t size, const char *mark, int seconds,
                                struct buffer *output, char *message, size_t n);

/* Ends the program, if it runs. */
void process_end(struct process *process);
