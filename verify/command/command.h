/* SPDX-License-Identifier: GPL-3.0-or-later
 * Commands: one file and one line in commands.def each. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

#include "code_run.h"

/* The word for an argument that consists of options itself. */
#define COMMAND_OPTIONS "OPTIONS"

/* An option of one command; a list ends with a NULL name. */
struct command_option {
    const char *name;     /* without the dashes */
    const char *argument; /* name of its argument in the help; NULL: a flag; if it ends with " ..."
                             the option may be repeated, and its value has a line for each */
    const char *help;     /* one line */
};

/* Options, removed from the arguments before a command gets them. */
struct options {
    const char *json; /* file (known to be writable), "-" for standard output, NULL for none */
    int threads;      /* >= 1 */
    bool quiet;       /* no progress, no remarks */
    bool speak;       /* tables go to standard output */
    bool color;       /* resolved: standard output may be coloured */
    const struct command *command;
    const char **values; /* of the command's own options, see options_value */
    int count;           /* number of arguments, as passed to the command */
    char **arguments;
};

struct command {
    const char *name;
    const char *synopsis; /* the arguments, one line */
    const char *help;     /* first line: what it does; further lines if needed */
    /* arguments[0..n-1]: the arguments after the command's name, without options ("-1", "-" and
     * everything after "--" are arguments). Returns the exit status; sets error unless that is
     * STATUS_OK or STATUS_CHECK_FAILED. With STATUS_BAD_INPUT nothing has been written. */
    enum status (*run)(const struct options *options, int n, char **arguments, struct error *error);
    const struct command_option *options; /* of its own, at least one */
    const char *examples;                 /* complete command lines, one per line */
};

/* The argument of the command's option called name ("" for a flag), NULL where it was not given. */
const char *options_value(const struct options *options, const char *name);

/* The number that an option gives, between low and high; *value is unchanged without the option. */
enum status options_number(const struct options *options, const char *name, bool whole, double low,
                           double high, double *value, struct error *error);

/* Like options_number for a value that must be above 0. */
enum status options_positive(const struct options *options, const char *name, double *value,
                             struct error *error);

/* The number of an option that is any number; *value is unchanged without the option. */
enum status options_real(const struct options *options, const char *name,
                         struct snapshot_value *value, struct error *error);

/* The settings of a case with n keys, of our solver or of the program of --code, which the caller
 * frees; --work without --code is refused. code, external: unused without --code. */
enum status options_case(const struct options *options, const char *name, int n, char *const *keys,
                         struct code *code, struct code_external *external,
                         struct run_settings *settings, struct error *error);

/* The numbers of particles of --n, at least `least` distinct ones, else the case's own. */
enum status options_ladder(const struct options *options, const struct run_settings *settings,
                           size_t least, size_t ladder[CASE_LADDER_MAX], size_t *count,
                           struct error *error);

/* Writes the document to the file of --json, if given, and releases it. NULL: no memory for it. */
enum status options_write(const struct options *options, json_t *document, struct error *error);

/* Writes a document of this command with these members, whose reference is taken. NULL: no memory
 * for them. */
enum status options_write_members(const struct options *options, json_t *members,
                                  struct error *error);

/* Bad usage of this command: STATUS_BAD_INPUT with the message and the synopsis. */
enum status command_usage(const struct options *options, struct error *error, const char *format,
                          ...) __attribute__((format(printf, 3, 4)));

/* All commands and their common options, from which --help, the manual and shell completion are
 * made. */
extern const struct command *const command_table[];
extern const size_t command_count;
extern const struct command_option command_common[];

/* The index in kernel_family.members of the kernel of --kernel: built-in, or the path of a plug-in;
 * -1 without the option. */
enum status options_kernel(const struct options *options, int *index, struct error *error);

/* The whole program: finds the command, runs it, prints the error, returns the exit status. */
int command_main(int argc, char **argv);
