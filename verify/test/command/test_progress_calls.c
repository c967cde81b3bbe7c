/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the line of progress of every command whose work may be long: begun once, quiet on request,
 * brought forward to the end of the work, and cleared before anything is printed. (studies.py looks
 * at a line on a terminal.) Needs the linker's --wrap of progress_begin, progress_from,
 * progress_update, progress_share and progress_end. */
#include "test.h"

#include <fcntl.h>

#include "command.h"
#include "own_folder.h"
#include "progress.h"

static struct {
    const struct progress *line; /* that is begun */
    char name[80];
    bool quiet;
    int begun, froms, updates;
    double from, first, last; /* shares of the work */
} seen;

void __wrap_progress_begin(struct progress *progress, const char *what, bool quiet);
void __wrap_progress_begin(struct progress *progress, const char *what, bool quiet)
{
    assert_null(seen.line);
    *progress = (struct progress){.what = what, .silent = quiet};
    snprintf(seen.name, sizeof seen.name, "%s", what);
    seen.line = progress;
    seen.quiet = quiet;
    seen.begun++;
}

void __wrap_progress_from(struct progress *progress, double share);
void __wrap_progress_from(struct progress *progress, double share)
{
    assert_ptr_equal(progress, seen.line);
    assert_int_equal(seen.updates, 0);
    seen.from = share;
    seen.froms++;
}

static void update(const struct progress *progress, double done, double total)
{
    assert_ptr_equal(progress, seen.line);
    assert_true(progress->what && total > 0 && done <= total);
    assert_true(done / total >= seen.last);
    seen.last = done / total;
    if (!seen.updates++) seen.first = seen.last;
}

void __wrap_progress_update(struct progress *progress, double done, double total);
void __wrap_progress_update(struct progress *progress, double done, double total)
{
    update(progress, done, total);
}

void __wrap_progress_share(struct progress *progress, size_t done, size_t total, double share);
void __wrap_progress_share(struct progress *progress, size_t done, size_t total, double share)
{
    assert_true(share >= 0 && share <= 1);
    update(progress, (double)done, (double)total);
}

void __wrap_progress_end(struct progress *progress);
void __wrap_progress_end(struct progress *progress)
{
    assert_ptr_equal(progress, seen.line);
    assert_int_equal(ftell(stdout), 0);
    seen.line = NULL;
}

/* Calls the command; returns its exit status. What it prints is thrown away. */
static int call(const char *line, bool quiet)
{
    char text[400], *words[40] = {(char *)"sphproof"}, *rest = text;
    int n = 1;
    snprintf(text, sizeof text, "%s%s", line, quiet ? "|--quiet" : "");
    while ((words[n] = strsep(&rest, "|"))) n++;
    memset(&seen, 0, sizeof seen);
    fflush(NULL);
    const int out = dup(1), file = open("printed", O_RDWR | O_CREAT | O_TRUNC, 0600);
    dup2(file, 1);
    const int status = command_main(n, words);
    fflush(NULL);
    dup2(out, 1);
    close(out), close(file);
    assert_null(seen.line);
    return status;
}

TEST(progress_of_every_command)
{
    static const struct {
        const char *name, *line; /* words between bars */
        bool steps;              /* the work begins with the first step, after the set-up */
    } rows[] = {
        {"sod", "run|sod|n=20|t_end=0.01", true},
        {"checks", "verify|norms", false},
        {"verify", "verify|norms|--jobs|1", false},
        {"compare", "compare|sod n=20 t_end=0.01|sod n=20 t_end=0.01 eta=3|--draws|2", false},
        {"converge", "converge|sound_wave|--n|10,14,20,28|t_end=0.005", false},
        {"bench", "bench|sod|--n|16,20|t_end=0.01|--time|1e-9|--samples|1", false},
        {"bench", "bench|sod|--n|16,20|t_end=0.01|--time|1e-9|--samples|1|--cache|kept", false},
        {"bench --skips", "bench|--skips|sod|n=20|t_end=0.01|--time|1e-9|--samples|1", false},
        {"bench --scaling", "bench|--scaling|--n|16,20|t_end=0.01|--time|1e-9|--samples|1", false},
        {"stress", "stress|few", false},
    };
    char here[4096];
    assert_non_null(getcwd(here, sizeof here));
    assert_int_equal(chdir(own_folder), 0);
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++)
        for (int quiet = 0; quiet < 2; quiet++) {
            const int status = call(rows[r].line, quiet);
            if (status > 1) fail_msg("%s: exit %d", rows[r].line, status);
            assert_int_equal(seen.begun, 1);
            assert_string_equal(seen.name, rows[r].name);
            assert_int_equal(seen.quiet, quiet);
            if (quiet && strstr(rows[r].line, "kept")) continue; /* nothing is left to do */
            assert_true(seen.updates > 1);
            if (seen.last < 0.8) fail_msg("%s: only %g was done", rows[r].line, seen.last);
            assert_int_equal(seen.froms, rows[r].steps);
            assert_true(!rows[r].steps || seen.from == seen.first);
        }
    assert_int_equal(chdir(here), 0);
}
