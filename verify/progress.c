/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "progress.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

/* seconds: nothing before, then so often on a terminal and in a log */
static const double patience = 1, interval_terminal = 0.2, interval_log = 10;

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

void progress_begin(struct progress *progress, const char *what, const struct options *options)
{
    *progress = (struct progress){.what = what, .silent = options->quiet, .began = now()};
    progress->terminal = isatty(STDERR_FILENO);
}

void progress_update(struct progress *progress, double done, double total)
{
    if (progress->silent) return;
    const double time = now(), passed = time - progress->began;
    const double wait = progress->spoke > 0  ? progress->spoke
                        : progress->terminal ? progress->began + patience - interval_terminal
                                             : progress->began;
    if (time - wait < (progress->terminal ? interval_terminal : interval_log)) return;
    progress->spoke = time;
    const double left = done > 0 ? passed * (total - done) / done : 0;
    fprintf(stderr, "%s%s: %.3g of %.3g (%.0f %%), %.0f s, %.0f s left%s",
            progress->terminal ? "\r" : "", progress->what, done, total, 100 * done / total, passed,
            left, progress->terminal ? "\033[K" : "\n");
}

void progress_end(struct progress *progress)
{
    if (progress->spoke > 0 && progress->terminal) fputs("\r\033[K", stderr);
    progress->spoke = 0;
}
