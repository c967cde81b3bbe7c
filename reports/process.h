/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs a program as a filter: bytes in, bytes out, exit status checked. */
#ifndef SPHPROOF_PROCESS_H
#define SPHPROOF_PROCESS_H

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

#endif
