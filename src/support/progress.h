/* SPDX-License-Identifier: GPL-3.0-or-later
 * A progress line on standard error for work of more than a second: name, done of total, time left.
 * On a terminal one line is rewritten; in a log a line is added from time to time. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

struct progress {
    const char *what; /* one or two words; owned by the caller */
    double began, spoke;
    double from, since; /* where the extrapolation of the time left starts: share, time */
    bool silent, terminal;
};

/* quiet: no output. */
void progress_begin(struct progress *progress, const char *what, bool quiet);
/* Extrapolates the time left from here on, with this share of the work done, without work of the
 * set-up or of another process. */
void progress_from(struct progress *progress, double share);
/* done of total, in any unit; cheap enough for every step. */
void progress_update(struct progress *progress, double done, double total);
/* done of total pieces of unequal size; share: of the work, 0..1, from which the time left follows.
 */
void progress_share(struct progress *progress, size_t done, size_t total, double share);
/* Clears the line. */
void progress_end(struct progress *progress);
