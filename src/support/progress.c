/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "progress.h"

#include <stdio.h>
#include <unistd.h>

#include "clock.h"

/* in seconds: first output, then intervals on a terminal and in a log */
static const double patience = 1, interval_terminal = 0.2, interval_log = 10;

void progress_begin(struct progress *progress, const char *what, bool quiet)
{
    *progress = (struct progress){.what = what, .silent = quiet, .began = clock_wall()};
    progress->terminal = isatty(STDERR_FILENO);
    progress->since = progress->began;
}

void progress_from(struct progress *progress, double share)
{
    progress->from = share;
    progress->since = clock_wall();
}

/* True if the next output is due. */
static bool due(struct progress *progress, double time)
{
    const double wait = progress->spoke > 0  ? progress->spoke
                        : progress->terminal ? progress->began + patience - interval_terminal
                                             : progress->began;
    if (progress->silent || time - wait < (progress->terminal ? interval_terminal : interval_log))
        return false;
    progress->spoke = time;
    return true;
}

static void say(const struct progress *progress, double time, const char *count, double share)
{
    const double passed = time - progress->began;
    char left[40] = "";
    const double done = share - progress->from;
    if (done > 0)
        snprintf(left, sizeof left, ", %.0f s left", (time - progress->since) * (1 - share) / done);
    fprintf(stderr, "%s%s: %s, %.0f s%s%s", progress->terminal ? "\r" : "", progress->what, count,
            passed, left, progress->terminal ? "\033[K" : "\n");
}

void progress_update(struct progress *progress, double done, double total)
{
    const double time = clock_wall();
    char count[80];
    if (!due(progress, time)) return;
    snprintf(count, sizeof count, "%.3g of %.3g (%.0f %%)", done, total, 100 * done / total);
    say(progress, time, count, done / total);
}

void progress_share(struct progress *progress, size_t done, size_t total, double share)
{
    const double time = clock_wall();
    char count[80];
    if (!due(progress, time)) return;
    snprintf(count, sizeof count, "%zu of %zu (%.0f %%)", done, total, 100 * share);
    say(progress, time, count, share);
}

void progress_end(struct progress *progress)
{
    if (progress->spoke > 0 && progress->terminal) fputs("\r\033[K", stderr);
    progress->spoke = 0;
}
