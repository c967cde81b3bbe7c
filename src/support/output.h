/* SPDX-License-Identifier: GPL-3.0-or-later
 * Files that appear whole or not at all: written under a temporary name in the same folder, renamed
 * when complete. An interrupt or an error removes the temporary. */
#pragma once

#include <stdio.h>

#include "status.h"

struct output {
    FILE *stream;      /* write here; NULL when closed */
    const char *given; /* the path as the caller names it, for messages */
    char *path, *temporary;
    int slot; /* in the list of temporaries that an interrupt removes; -1: none */
};

/* Opens path for writing ("-": standard output; a device or a pipe is written directly).
 * STATUS_ENVIRONMENT: it cannot be written; nothing is left behind. The path must stay valid until
 * the output is closed. */
enum status output_open(struct output *output, const char *path, struct error *error);

/* Flushes the file and renames it to its path. On an error the old file is unchanged. */
enum status output_close(struct output *output, struct error *error);

/* Writes a file with this text. */
enum status output_text(const char *path, const char *text, struct error *error);

/* Discards the output: the old file is unchanged. Allowed after output_close. */
void output_discard(struct output *output);

/* Tests whether path can be written, so that an error is reported before hours of work. */
enum status output_probe(const char *path, struct error *error);

/* Creates a folder and its parents, unless they exist. */
enum status output_folder(const char *path, struct error *error);

/* A file without a name, in $TMPDIR if set, otherwise in the system's folder for temporary files;
 * NULL: see errno. */
FILE *output_temporary(void);

/* Sets the process group that an interrupt also ends; 0: none. */
void output_guard(int group);

/* For the start of a program: interrupts remove temporaries, a full disk or a closed pipe is an
 * error, not a signal; files cannot take the numbers of closed standard streams. */
void output_prepare_process(void);

/* For the end of a program: reports whether standard output was written completely. STATUS_OK also
 * if its reader has closed the pipe. */
enum status output_finish_process(struct error *error);
