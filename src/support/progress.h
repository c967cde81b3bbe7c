/* SPDX-License-Identifier: GPL-3.0-or-later
 * A progress line on standard error for anything over a second: what, done of total, time left. On
 * a terminal one line is rewritten; in a log a plain line is added now and then. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

struct progress {
    const char *what; /* one or two words; belongs to the caller */
    double began, spoke;
    double from, since; /* the share of the work from which time is reckoned, and when that was */
    bool silent, terminal;
};

/* quiet: nothing is ever said. */
void progress_begin(struct progress *progress, const char *what, bool quiet);
/* Only now, at this share of it, does the work go on as it will: what is left is reckoned from
 * here, without what was set up, or done by another process. */
void progress_from(struct progress *progress, double share);
/* done of total, in any unit; cheap enough to be called every step. */
void progress_update(struct progress *progress, double done, double total);
/* done of total pieces of unequal size: share of the work, 0..1, tells the time that is left. */
void progress_share(struct progress *progress, size_t done, size_t total, double share);
/* Clears the line. */
void progress_end(struct progress *progress);
