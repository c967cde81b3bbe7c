/* SPDX-License-Identifier: GPL-3.0-or-later
 * Commands: one file in command/ and one line in commands.def each. */
#ifndef SPHPROOF_COMMAND_H
#define SPHPROOF_COMMAND_H

#include "status.h"

/* Options common to all commands, taken out of the arguments before a command sees them. */
struct options {
    const char *json; /* file, "-" for standard output, NULL for none */
    int threads;      /* >= 1 */
    int quiet;
    int color; /* resolved: 1 where stdout may be coloured */
};

struct command {
    const char *name;
    const char *synopsis; /* the arguments, one line */
    const char *help;     /* what it does, its options, examples */
    /* arguments[0..n-1]: those after the command's name, without the common options.
     * Returns the exit status; on anything but STATUS_OK and STATUS_CHECK_FAILED error is set and
     * nothing has been written. */
    enum status (*run)(const struct options *options, int n, char **arguments, struct error *error);
};

/* The whole program: finds the command, runs it, prints the error, returns the exit status. */
int command_main(int argc, char **argv);

#endif
