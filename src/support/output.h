/* SPDX-License-Identifier: GPL-3.0-or-later
 * Files that appear whole or not at all: written beside their place under a temporary name, renamed
 * when complete. An interrupt or an error removes the temporary. */
#pragma once

#include <stdio.h>

#include "status.h"

struct output {
    FILE *stream; /* write here; NULL when closed */
    char *path, *temporary;
    int slot; /* in the list of what an interrupt removes; -1: none */
};

/* Opens path for writing ("-": standard output; a device or a pipe is written directly).
 * STATUS_ENVIRONMENT: it cannot be written; nothing has then been left behind. */
enum status output_open(struct output *output, const char *path, struct error *error);

/* Flushes, and puts the file in its place. On an error the file is as it was before. */
enum status output_close(struct output *output, struct error *error);

/* A file that holds this text. */
enum status output_text(const char *path, const char *text, struct error *error);

/* Gives up: the file is as it was before output_open. Harmless after output_close. */
void output_discard(struct output *output);

/* Could path be written now? For a clear answer before hours of work. */
enum status output_probe(const char *path, struct error *error);

/* Makes a folder and those above it; one that is there is fine. */
enum status output_folder(const char *path, struct error *error);

/* A file without a name, in $TMPDIR if that is set, else where the system has such files; NULL:
 * errno says why there is none. */
FILE *output_temporary(void);

/* An interrupt also ends this group of processes; 0: none. */
void output_guard(int group);

/* At start-up: interrupts remove temporaries, a full disk or a closed pipe is an error, not a
 * signal; closed standard streams cannot be taken by a file. */
void output_prepare_process(void);

/* At the end: is everything on standard output? STATUS_OK also where the reader has left. */
enum status output_finish_process(struct error *error);
