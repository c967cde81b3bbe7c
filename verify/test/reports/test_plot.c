/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests plots: SVG for a page is well-formed, has prefixed ids and needs no other file; each
 * failure of gnuplot gives a status. */
#include "test.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <time.h>

#include "autopsy_plot.h"
#include "layout.h"
#include "markup.h"
#include "movie.h"
#include "output.h"
#include "own_folder.h"
#include "page_plot.h"
#include "picture.h"
#include "plot.h"
#include "process.h"
#include "script.h"

static const double x[] = {100, 200, 400, 800}, y[] = {1e-2, 5.1e-3, NAN, 1.3e-3},
                    low[] = {9e-3, 4e-3, 2e-3, 1e-3}, high[] = {2e-2, 6e-3, 3e-3, 2e-3};

static const struct plot_series series[] = {
    {.label = "a & <b> 'c'", .kind = PLOT_LINES_POINTS, .n = 4, .x = x, .y = y},
    {.label = "band", .kind = PLOT_BAND, .n = 4, .x = x, .low = low, .high = high},
    {.label = "bars", .kind = PLOT_BARS, .n = 4, .x = x, .low = low, .high = high, .size = 1.1},
    {.label = "nothing", .kind = PLOT_LINES, .n = 0, .x = x, .y = y},
};
static const struct plot_slope slope = {100, 800, 1e-2, -1, "first order"};
static const struct plot_mark mark = {300, false, "here"};
static const struct plot_heat heat = {
    .nx = 4, .ny = 1, .x = x, .y = low, .z = high, .label = "rate"};
static const struct plot_panel panels[] = {
    {.y_label = "L1",
     .x_log = true,
     .y_log = true,
     .key = PLOT_KEY_END,
     .series = series,
     .series_count = 4,
     .slopes = &slope,
     .slope_count = 1,
     .marks = &mark,
     .mark_count = 1},
    {.x_label = "particles n",
     .y_label = "y",
     .x_log = true,
     .key = PLOT_KEY_TOP,
     .series = series,
     .series_count = 4},
};
static const struct plot_panel map = {.x_label = "x", .y_label = "y", .heat = &heat};

static const struct plot stack = {.name = "stack-of_2",
                                  .title = "two & panels",
                                  .show_title = true,
                                  .panels = panels,
                                  .panel_count = 2};
static const struct plot heated = {
    .name = "heated", .title = "a map", .panels = &map, .panel_count = 1};

static bool have_gnuplot(void)
{
    struct buffer output = {0};
    char message[256], program[] = "gnuplot", version[] = "--version";
    char *const arguments[] = {program, version, NULL};
    enum process_status status =
        process_filter(arguments, "", 0, 20, &output, message, sizeof message);
    buffer_free(&output);
    return status == PROCESS_OK;
}

static size_t occurrences(const char *text, const char *what)
{
    size_t n = 0;
    for (; (text = strstr(text, what)); text += strlen(what)) n++;
    return n;
}

TEST(inline_svg)
{
    if (!have_gnuplot()) skip();
    const struct plot *const plots[] = {&stack, &heated};
    for (size_t k = 0; k < 2; k++) {
        char *svg, message[512] = "", fault[256] = "", prefix[64];
        enum plot_status status = plot_svg(NULL, plots[k], &svg, message, sizeof message);
        if (status) fail_msg("%s", message);
        assert_int_equal(strncmp(svg, "<svg ", 5), 0);
        if (!markup_well_formed(svg, fault, sizeof fault)) fail_msg("%s", fault);
        assert_null(markup_network(svg));
        snprintf(prefix, sizeof prefix, " id=\"%s-", plots[k]->name);
        assert_true(occurrences(svg, " id=\"") > 3);
        assert_int_equal(occurrences(svg, " id=\""), occurrences(svg, prefix));
        snprintf(prefix, sizeof prefix, " href=\"#%s-", plots[k]->name);
        assert_int_equal(occurrences(svg, "href="), occurrences(svg, prefix));
        /* text and axes have the page's colours */
        assert_null(strstr(svg, "\"black\""));
        assert_non_null(strstr(svg, "fill=\"currentColor\""));
        free(svg);
    }
}

/* Values that are equal, or differ by round-off, are a straight line in a plot, on either axis. */
TEST(constant_values)
{
    if (!have_gnuplot()) skip();
    const double nights[] = {1, 2, 3}, equal[] = {8.761e-4, 8.761e-4, 8.761e-4},
                 nearly[] = {8.761e-4, 8.761e-4 * (1 + 1e-13), 8.761e-4 * (1 - 1e-13)};
    for (int k = 0; k < 4; k++) {
        const struct plot_series line = {.label = "a",
                                         .kind = PLOT_LINES_POINTS,
                                         .n = 3,
                                         .x = nights,
                                         .y = k % 2 ? nearly : equal,
                                         .color = 1,
                                         .size = 1};
        const struct plot_panel alone = {.x_label = "x",
                                         .y_label = "y",
                                         .y_log = k < 2,
                                         .key = PLOT_KEY_NONE,
                                         .series = &line,
                                         .series_count = 1};
        const struct plot drawn = {
            .name = "one", .title = "one value", .panels = &alone, .panel_count = 1};
        char *svg, message[512] = "";
        if (plot_svg(NULL, &drawn, &svg, message, sizeof message)) fail_msg("%d: %s", k, message);
        free(svg);
    }
}

TEST(documents)
{
    if (!have_gnuplot()) skip();
    char *bytes, message[512] = "", fault[256] = "";
    size_t size;
    if (plot_draw(&stack, PLOT_SVG, &bytes, &size, message, sizeof message))
        fail_msg("%s", message);
    assert_int_equal(size, strlen(bytes));
    if (!markup_well_formed(bytes, fault, sizeof fault)) fail_msg("%s", fault);
    assert_non_null(strstr(bytes, "a &amp; &lt;b"));
    assert_non_null(strstr(bytes, "prefers-color-scheme"));
    free(bytes);
    if (plot_draw(&heated, PLOT_PNG, &bytes, &size, message, sizeof message))
        fail_msg("%s", message);
    assert_true(size > 1000 && !memcmp(bytes, "\x89PNG", 4));
    free(bytes);
}

/* A logarithmic axis ignores an invalid range and takes that of the data. */
TEST(ranges_of_logarithms)
{
    static const struct {
        double min, max;
        bool taken;
    } rows[] = {{0.5, 10, true},     {0, 10, false},         {-1, 1, false},
                {-5, -2, false},     {3, 3, false},          {1e-98, 1e98, true},
                {1e-100, 10, false}, {0.5, INFINITY, false}, {0.5, 1e200, false}};
    static const double far[] = {1e-200, 0.0013, 1e200, 0.5};
    static const struct plot_series beyond = {.label = "a", .n = 4, .x = far, .y = far};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int across = 0; across < 2; across++) {
            struct plot_panel panel = {
                .x_log = true, .y_log = true, .series = &beyond, .series_count = 1};
            const struct plot drawn = {.name = "range", .panels = &panel, .panel_count = 1};
            char *of_data, *script, *data, range[64];
            assert_true(plot_source(&drawn, &of_data, &data));
            free(data);
            *(across ? &panel.x_min : &panel.y_min) = rows[k].min;
            *(across ? &panel.x_max : &panel.y_max) = rows[k].max;
            assert_true(plot_source(&drawn, &script, &data));
            snprintf(range, sizeof range, "set %crange [%g:%g]\n", across ? 'x' : 'y', rows[k].min,
                     rows[k].max);
            assert_int_equal(occurrences(script, range), rows[k].taken);
            assert_int_equal(strcmp(script, of_data) == 0, !rows[k].taken);
            free(of_data);
            free(script);
            free(data);
        }
}

/* Axes of up to five decades, this included, have small ticks between the decades. */
TEST(small_ticks)
{
    static const double ends[] = {9e4, 1e5, 1.1e5, 1e7};
    for (size_t k = 0; k < sizeof ends / sizeof *ends; k++) {
        const double from = 1, both[] = {from, ends[k]};
        const struct plot_series line = {.label = "a", .n = 2, .x = both, .y = both};
        const struct plot_panel panel = {
            .y_log = true, .y_min = from, .y_max = ends[k], .series = &line, .series_count = 1};
        const struct plot drawn = {.name = "ticks", .panels = &panel, .panel_count = 1};
        char *script, *data;
        assert_true(plot_source(&drawn, &script, &data));
        assert_int_equal(occurrences(script, "'' 30 1") > 0, ends[k] <= 1e5);
        free(script);
        free(data);
    }
}

static enum process_status shell(const char *command, const char *input, size_t size, int seconds,
                                 struct buffer *output, char *message, size_t n)
{
    char sh[] = "sh", c[] = "-c";
    char *copy = strdup(command);
    char *const arguments[] = {sh, c, copy, NULL};
    enum process_status status =
        process_filter(arguments, input, size, seconds, output, message, n);
    free(copy);
    return status;
}

enum { FILES = 64 };

/* The number of open files; *above is one more than the largest descriptor. */
static int open_files(int *above)
{
    int count = 0;
    for (int k = 0; k < FILES; k++)
        if (fcntl(k, F_GETFD) >= 0) count++, *above = k + 1;
    return count;
}

/* A filter that answers while it reads, reads nothing, fails, is killed, hangs or is missing. */
TEST(processes)
{
    int above = 0;
    const int files = open_files(&above);
    const size_t size = 1 << 20;
    char *input = malloc(size), message[512];
    assert_non_null(input);
    for (size_t i = 0; i < size; i++)
        input[i] = (char)('a' + i % 23); /* no part is like the next */
    struct buffer output = {0};
    assert_int_equal(shell("cat", input, size, 60, &output, message, sizeof message), PROCESS_OK);
    assert_int_equal(output.size, size);
    assert_memory_equal(output.data, input, size);
    buffer_free(&output);
    assert_int_equal(shell("cat", input, 1, 60, &output, message, sizeof message), PROCESS_OK);
    assert_string_equal(output.data, "a");
    buffer_free(&output);
    assert_int_equal(
        shell("exec 2>&-; sleep 0.1; echo late", "", 0, 60, &output, message, sizeof message),
        PROCESS_OK);
    assert_string_equal(output.data, "late\n");
    buffer_free(&output);
    assert_int_equal(shell("exit 0", input, size, 60, &output, message, sizeof message),
                     PROCESS_OK);
    assert_int_equal(
        shell("echo no 1>&2; exit 3", input, size, 60, &output, message, sizeof message),
        PROCESS_FAILED);
    assert_non_null(strstr(message, "status 3"));
    assert_non_null(strstr(message, "no"));
    assert_int_equal(shell("kill -9 $$", input, size, 60, &output, message, sizeof message),
                     PROCESS_FAILED);
    assert_non_null(strstr(message, "signal 9"));
    signal(SIGPIPE, SIG_IGN); /* for this process; the filter dies of it */
    assert_int_equal(shell("kill -PIPE $$", "", 0, 60, &output, message, sizeof message),
                     PROCESS_FAILED);
    assert_string_equal(message, "sh was ended by signal 13: ");
    signal(SIGPIPE, SIG_DFL);
    static const char *const missing_too[][2] = {
        {"exit 127", "sh cannot be run"},
        {"echo; echo ' no' 1>&2; exit 127", "sh cannot be run: no\n"}};
    for (size_t k = 0; k < 2; k++) {
        assert_int_equal(
            shell(missing_too[k][0], input, size, 60, &output, message, sizeof message),
            PROCESS_NOT_FOUND);
        assert_string_equal(message, missing_too[k][1]);
    }
    time_t before = time(NULL);
    assert_int_equal(shell("exec sleep 50", input, size, 1, &output, message, sizeof message),
                     PROCESS_TOO_SLOW);
    assert_true(time(NULL) - before < 20);
    assert_non_null(strstr(message, "no answer"));
    char missing[] = "no-such-program-anywhere";
    char *const arguments[] = {missing, NULL};
    struct process none = {0};
    for (int k = 0; k < 2; k++) {
        assert_int_equal(
            process_ask(&none, arguments, -1, "a", 1, "end", 5, &output, message, sizeof message),
            PROCESS_NOT_FOUND);
        assert_int_equal(none.pid, 0);
    }
    buffer_free(&output);
    struct buffer full = {.failed = true};
    assert_int_equal(shell("echo a", "", 0, 60, &full, message, sizeof message), PROCESS_FAILED);
    assert_string_equal(message, "no memory for what sh wrote");
    /* with descriptors for some of its pipes only */
    enum process_status status = PROCESS_FAILED;
    for (int spare = 0; status; spare++) {
        struct rlimit usual, limit;
        assert_int_equal(getrlimit(RLIMIT_NOFILE, &usual), 0);
        limit = usual, limit.rlim_cur = (rlim_t)(above + spare);
        assert_int_equal(setrlimit(RLIMIT_NOFILE, &limit), 0);
        status = shell("exit 0", input, size, 60, &output, message, sizeof message);
        assert_int_equal(setrlimit(RLIMIT_NOFILE, &usual), 0);
        if (!status) assert_true(above - files + spare >= 7); /* smaller descriptors may be free */
        if (status) assert_string_equal(message, "sh cannot be run: Too many open files");
        assert_int_equal(status, status ? PROCESS_FAILED : PROCESS_OK);
        assert_int_equal(open_files(&above), files);
    }
    /* this process handles a broken pipe as before, and one that came before is still there */
    sigset_t mask, blocked;
    sigprocmask(SIG_BLOCK, NULL, &mask);
    assert_false(sigismember(&mask, SIGPIPE));
    sigemptyset(&blocked);
    sigaddset(&blocked, SIGPIPE);
    sigprocmask(SIG_BLOCK, &blocked, &mask);
    raise(SIGPIPE);
    assert_int_equal(shell("exit 0", input, size, 60, &output, message, sizeof message),
                     PROCESS_OK);
    sigset_t pending;
    int number = 0;
    assert_int_equal(sigpending(&pending), 0);
    assert_true(sigismember(&pending, SIGPIPE));
    assert_int_equal(sigwait(&blocked, &number), 0);
    sigprocmask(SIG_SETMASK, &mask, NULL);
    free(input);
}

/* A program gets no descriptors but its own three and those that any program gets. */
TEST(descriptors_of_a_program)
{
    struct buffer output = {0};
    char expected[64] = "", message[512] = "";
    for (int k = 3; k < 10; k++) {
        const int flags = fcntl(k, F_GETFD);
        if (flags >= 0 && !(flags & FD_CLOEXEC))
            snprintf(expected + strlen(expected), sizeof expected - strlen(expected), "%d\n", k);
    }
    assert_int_equal(shell("for k in 3 4 5 6 7 8 9; do (: >&$k) 2>/dev/null && echo $k; done; :",
                           "", 0, 60, &output, message, sizeof message),
                     PROCESS_OK);
    assert_string_equal(output.data ? output.data : "", expected);
    buffer_free(&output);
}

static void nothing(int number)
{
    (void)number;
}

/* Signals may interrupt all waiting: for data, for room, and for the end of the program. */
TEST(interrupted_processes)
{
    const struct sigaction action = {.sa_handler = nothing};
    const struct itimerval often = {{0, 500}, {0, 500}}, never = {{0, 0}, {0, 0}};
    struct sigaction before;
    struct buffer output = {0};
    const size_t size = 1 << 20;
    char *input = malloc(size), message[512] = "";
    assert_non_null(input);
    for (size_t i = 0; i < size; i++)
        input[i] = (char)('a' + i % 23); /* no part is like the next */
    assert_int_equal(sigaction(SIGALRM, &action, &before), 0);
    setitimer(ITIMER_REAL, &often, NULL);
    const enum process_status status = shell("sleep 0.1; cat; exec >&- 2>&-; sleep 0.1; exit 3",
                                             input, size, 60, &output, message, sizeof message);
    setitimer(ITIMER_REAL, &never, NULL);
    sigaction(SIGALRM, &before, NULL);
    assert_int_equal(status, PROCESS_FAILED);
    assert_string_equal(message, "sh ended with status 3: ");
    assert_int_equal(output.size, size);
    assert_memory_equal(output.data, input, size);
    buffer_free(&output);
    free(input);
}

/* A persistent program answers each question; after a failure neither its output nor its end is
 * taken for the next answer. */
TEST(persistent_program)
{
    char sh[] = "sh", c[] = "-c", message[512];
    char loop[] = "while read -r a; do case $a in die) exit 3;; stop) echo bye; exit;; esac; "
                  "echo said 1>&2; echo $a; cat <&3; echo end; done";
    char *const arguments[] = {sh, c, loop, NULL};
    static const struct {
        const char *question, *answer;
        enum process_status status;
        bool goes_on;
    } asked[] = {{"1\n", "1\nfile\n", PROCESS_OK, true},
                 {"2\n", "2\n", PROCESS_OK, true}, /* the program reads from the file */
                 {"die\n", "", PROCESS_FAILED, false},
                 {"stop\n", "bye\n", PROCESS_OK, false},
                 {"3\n", "3\n", PROCESS_OK, true}};
    FILE *file = output_temporary();
    assert_non_null(file);
    fputs("file\n", file);
    rewind(file);
    struct process process = {0};
    int above;
    const int files = open_files(&above);
    for (size_t k = 0; k < sizeof asked / sizeof *asked; k++) {
        struct buffer output = {0};
        const int before = process.pid;
        const enum process_status status =
            process_ask(&process, arguments, fileno(file), asked[k].question,
                        strlen(asked[k].question), "end\n", 60, &output, message, sizeof message);
        assert_int_equal(status, asked[k].status);
        assert_string_equal(output.data ? output.data : "", asked[k].answer);
        assert_int_equal(process.pid != 0, asked[k].goes_on);
        if (before && asked[k].goes_on) assert_int_equal(process.pid, before);
        if (status) {
            assert_non_null(strstr(message, "status 3"));
            assert_null(strstr(message, "said"));
        }
        buffer_free(&output);
    }
    const int last = process.pid;
    process_end(&process);
    assert_int_equal(process.pid, 0);
    assert_int_equal(open_files(&above), files);
    assert_int_equal(kill(last, 0), -1);
    fclose(file);
    /* one that would go on */
    char goes_on[] = "read -r a; echo end; exec sleep 50";
    char *const asked_once[] = {sh, c, goes_on, NULL};
    struct buffer output = {0};
    const time_t before = time(NULL);
    assert_int_equal(process_ask(&process, asked_once, -1, "1\n", 2, "end\n", 60, &output, message,
                                 sizeof message),
                     PROCESS_OK);
    process_end(&process);
    assert_true(time(NULL) - before < 20);
    buffer_free(&output);
}

/* One gnuplot for many plots draws the same as one for each plot; a plot that fails does not affect
 * the others. */
TEST(one_gnuplot_for_many_plots)
{
    if (!have_gnuplot()) skip();
    static const struct plot_mark nowhere = {.at = (double)NAN};
    struct plot_panel wrong_panel = panels[1];
    wrong_panel.marks = &nowhere, wrong_panel.mark_count = 1;
    const struct plot_panel half_wrong[] = {panels[0], wrong_panel};
    const struct plot wrong = {.name = "wrong", .panels = &wrong_panel, .panel_count = 1},
                      half = {.name = "half", .panels = half_wrong, .panel_count = 2};
    const struct plot *const plots[] = {&stack, &heated, &wrong, &stack, &half, &heated};
    struct plot_pen pen = {0};
    for (size_t k = 0; k < sizeof plots / sizeof *plots; k++) {
        char *alone, *svg, why[512] = "", message[512] = "";
        const enum plot_status status = plot_svg(NULL, plots[k], &alone, why, sizeof why);
        assert_int_equal(plot_svg(&pen, plots[k], &svg, message, sizeof message), status);
        const bool fails = plots[k] == &wrong || plots[k] == &half;
        assert_int_equal(status, fails ? PLOT_FAILED : PLOT_OK);
        assert_int_equal(pen.gnuplot.pid != 0, status == PLOT_OK);
        if (status) {
            assert_non_null(strstr(message, plots[k]->name));
            assert_non_null(strstr(message, "gnuplot ended with status 1"));
        } else {
            assert_string_equal(svg, alone);
        }
        free(alone);
        free(svg);
    }
    const int last = pen.gnuplot.pid;
    plot_pen_free(&pen);
    assert_true(last > 0 && kill(last, 0) == -1);
    /* without /dev/fd/0 there is no file for the script */
    char *alone, *svg, message[512];
    const int input = dup(0);
    assert_int_equal(plot_svg(NULL, &stack, &alone, message, sizeof message), PLOT_OK);
    close(0);
    for (int k = 0; k < 2; k++) {
        const enum plot_status status = plot_svg(&pen, &stack, &svg, message, sizeof message);
        if (k) dup2(input, 0);
        assert_int_equal(status, PLOT_OK);
        assert_int_equal(pen.script, -1);
        assert_string_equal(svg, alone);
        free(svg);
    }
    plot_pen_free(&pen);
    close(input);
    free(alone);
}

/* No gnuplot and no ffmpeg, and other programs under the name of gnuplot. */
TEST(wrong_gnuplot)
{
    static const struct {
        const char *program;
        enum plot_status status;
        const char *says;
        bool png; /* does it write something that passes for a PNG file? */
    } rows[] = {
        {NULL, PLOT_NO_GNUPLOT,
         "no plot: gnuplot cannot be run: No such file or directory (Debian, Ubuntu: "
         "package gnuplot-nox)",
         false},
        {"/bin/true", PLOT_FAILED, "plot stack-of_2: gnuplot drew nothing", false},
        {"/bin/false", PLOT_FAILED, "plot stack-of_2: gnuplot ended with status 1: ", false},
        {"/bin/echo", PLOT_FAILED, "plot stack-of_2: gnuplot's SVG is not understood", true}};
    char *path = strdup(getenv("PATH") ? getenv("PATH") : "");
    char gnuplot[300], picture[2][300];
    snprintf(gnuplot, sizeof gnuplot, "%s", path_of("gnuplot"));
    snprintf(picture[0], sizeof picture[0], "%s", path_of("a.svg"));
    snprintf(picture[1], sizeof picture[1], "%s", path_of("a.png"));
    setenv("PATH", own_folder, 1);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char *svg, message[512], says[1000];
        struct error error = {0};
        struct movie movie = {0};
        if (rows[k].program) assert_int_equal(symlink(rows[k].program, gnuplot), 0);
        assert_int_equal(plot_svg(NULL, &stack, &svg, message, sizeof message), rows[k].status);
        assert_null(svg);
        assert_string_equal(message, rows[k].says);
        for (int png = 0; png < 2; png++) {
            const bool drawn = png && rows[k].png;
            snprintf(says, sizeof says, "--plot '%s': %s", picture[png], rows[k].says);
            assert_int_equal(picture_write(&stack, picture[png], &error),
                             drawn ? STATUS_OK : STATUS_ENVIRONMENT);
            if (!drawn) assert_string_equal(error.message, says);
            assert_int_equal(access(picture[png], F_OK), drawn ? 0 : -1);
        }
        snprintf(says, sizeof says, "a picture of a movie: %s", rows[k].says);
        assert_int_equal(movie_add(&movie, &stack, &error),
                         rows[k].png ? STATUS_OK : STATUS_ENVIRONMENT);
        if (!rows[k].png) assert_string_equal(error.message, says);
        movie_free(&movie);
        unlink(gnuplot);
    }
    struct error error = {0};
    assert_int_equal(movie_probe("a.gif", &error), STATUS_ENVIRONMENT);
    assert_string_equal(error.message,
                        "--plot 'a.gif': a movie is made by ffmpeg (Debian, Ubuntu: package "
                        "ffmpeg; FILE.png leaves pictures): ffmpeg cannot be run: No such file or "
                        "directory");
    const struct movie none = {0};
    snprintf(gnuplot, sizeof gnuplot, "%s", path_of("a.mp4"));
    assert_int_equal(movie_write(&none, gnuplot, &error), STATUS_ENVIRONMENT);
    assert_non_null(strstr(error.message, "a movie is made by ffmpeg (Debian"));
    char command[300];
    snprintf(command, sizeof command, "ls -A %s | grep -q mp4", own_folder);
    setenv("PATH", path, 1);
    assert_int_not_equal(system(command), 0); /* nor a temporary file */
    free(path);
}

/* Files beside a picture name each other without their folder; what has no levels has no picture.
 */
TEST(beside_a_picture)
{
    struct error error = {0};
    char text[4000] = "";
    assert_int_equal(picture_source(&stack, path_of("p.svg"), &error), STATUS_OK);
    FILE *in = fopen(path_of("p.gp"), "r");
    assert_non_null(in);
    text[fread(text, 1, sizeof text - 1, in)] = '\0';
    fclose(in);
    assert_non_null(strstr(text, "'p.dat'"));
    assert_non_null(strstr(text, "'p.svg'"));
    json_t *nothing = json_object();
    assert_int_equal(autopsy_plot_write(nothing, path_of("q.svg"), &error), STATUS_ENVIRONMENT);
    assert_non_null(strstr(error.message, "q.svg: nothing to draw"));
    json_decref(nothing);
}

/* The script of a map of these two values, in a plot of this height, must have this line. */
static void colors_of(double low_z, double high_z, bool diverging, int height, const char *says)
{
    const double z[] = {low_z, high_z};
    const struct plot_heat of = {.nx = 2, .ny = 1, .x = x, .y = y, .z = z, .diverging = diverging};
    const struct plot_panel panel = {.heat = &of};
    const struct plot plot = {.name = "a", .panels = &panel, .panel_count = 1, .height = height};
    char *script, *data;
    assert_true(plot_source(&plot, &script, &data));
    if (!strstr(script, says)) fail_msg("no '%s' in: %s", says, script);
    free(script), free(data);
}

/* With room for five labels on a colour bar they are at steps of 1/5 of its range, which is kept if
 * it is 2 or 5 times a power of ten. A map of zeros has no range. */
TEST(colors)
{
    colors_of(0, 1, false, 175, "\nset cbtics 0.2\n");
    colors_of(0, 2.5, false, 175, "\nset cbtics 0.5\n");
    colors_of(0, 2.6, false, 175, "\nset cbtics 1\n");
    colors_of(0, 0, true, 175, "\nset cbrange [*:*]\n");
    colors_of(0, -1, true, 175, "\nset cbrange [-1:1]\n");
}

/* What gnuplot does not write is refused, or left as it is. */
TEST(odd_svg)
{
    static const char *const dot =
        "<svg><use xlink:href='#gpPt6' transform='translate(1,2) scale(3)' color='%s'/></svg>";
    for (int known = 0; known < 2; known++) {
        struct buffer to = {0}, raw = {0};
        buffer_format(&raw, dot, known ? "black" : "#123456");
        assert_true(svg_adapt(&to, raw.data, "one", "a"));
        assert_true(!strstr(to.data, "<path") == !known);
        buffer_free(&raw);
        buffer_free(&to);
    }
    struct buffer to = {0}, full = {.failed = true};
    assert_false(svg_adapt(&to, "<svg><desc>no end</svg>", "one", "a"));
    buffer_free(&to);
    assert_false(svg_adapt(&full, "<svg><g></g></svg>", "one", "a"));
}

/* The names of plots are used as ids and as file names, and fit on one page. */
TEST(names)
{
    static const char *const made[][2] = {
        {"sod", "sod-x"}, {"a_B-9", "a_B-9-x"}, {"./my case.ini", "c_my_case_ini-x"},
        {"2d", "cd-x"},   {"0", "c-x"},         {"9", "c-x"},
        {"-", "c-x"},     {"_", "c-x"},         {":", "c-x"},
        {"", "cx"}};
    static const char *const bad[] = {NULL, "", "1a", "_a", "a b", "a/b", "a."};
    char name[64], *svg, message[512];
    for (size_t k = 0; k < sizeof made / sizeof *made; k++) {
        page_plot_name(name, sizeof name, made[k][0], "x");
        assert_string_equal(name, made[k][1]);
    }
    struct plot plot = stack;
    for (size_t k = 0; k < 2 + sizeof bad / sizeof *bad; k++) {
        plot.name = k < 2 ? "stack" : bad[k - 2];
        plot.panel_count = k == 0 ? 0 : k == 1 ? LAYOUT_PANELS + 1 : 2;
        assert_int_equal(plot_svg(NULL, &plot, &svg, message, sizeof message), PLOT_FAILED);
        assert_string_equal(message,
                            "a plot needs a name of letters, digits, _ and - and 1 to 8 panels");
    }
    struct plot_panel most[LAYOUT_PANELS] = {{0}};
    plot.name = "most", plot.panels = most, plot.panel_count = LAYOUT_PANELS, *message = '\0';
    plot_svg(NULL, &plot, &svg, message, sizeof message);
    assert_null(strstr(message, "a plot needs"));
    free(svg);
}

/* The checks of markup in these tests can fail. */
TEST(markup)
{
    char fault[256];
    assert_true(markup_well_formed("<!doctype html><a b='c'>&amp;<d/></a>", fault, sizeof fault));
    static const char *const bad[] = {
        "<a>",  "<a></b>",     "<a b=c></a>",    "<a b='1' b='2'/>",          "<a>&</a>",
        "</a>", "<a b='></a>", "<a><b></a></b>", "<a id='x'><b id='x'/></a>", "<a b></a>"};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        if (markup_well_formed(bad[k], fault, sizeof fault)) fail_msg("accepted: %s", bad[k]);
    assert_non_null(markup_network("<img src=\"https://example.org/\"/>"));
}

/* The line ends before a missing value, and begins again after it. */
TEST(missing_values)
{
    static const double at[] = {1, 2, 3, 4, 5}, gapped[] = {1, 2, NAN, 4, 5};
    const struct plot_series line = {.kind = PLOT_LINES, .n = 5, .x = at, .y = gapped};
    const struct plot_panel panel = {
        .x_label = "x", .y_label = "y", .series = &line, .series_count = 1};
    const struct plot plot = {.name = "gap", .title = "gap", .panels = &panel, .panel_count = 1};
    char *svg, message[256];
    if (!have_gnuplot()) skip();
    assert_int_equal(plot_svg(NULL, &plot, &svg, message, sizeof message), PLOT_OK);
    const char *end = strstr(svg, "class=\"plot_1\""), *path = end;
    assert_non_null(end);
    while (path > svg && strncmp(path, "<path", 5) != 0) path--;
    size_t moves = 0;
    for (; path < end; path++) moves += *path == 'M';
    assert_int_equal(moves, 2);
    free(svg);
}

/* An image has the same scale on both axes; panels beside each other do not overlap. */
TEST(images)
{
    static const double left[] = {0.5, 1.5, 2.5}, up[] = {1, 3}, z[] = {-1, 2, 3, 4, NAN, 6};
    const struct plot_heat image = {
        .nx = 3, .ny = 2, .x = left, .y = up, .z = z, .diverging = true};
    const struct plot_panel one = {.heat = &image, .equal = true, .own_x = true};
    const struct plot_panel two[] = {one, one};
    const struct plot plot = {.name = "image",
                              .title = "image",
                              .width = 900,
                              .height = 350,
                              .panels = two,
                              .panel_count = 2,
                              .beside = true};
    struct layout layout;
    layout_make(&layout, &plot);
    for (int k = 0; k < 2; k++) {
        const struct layout_panel *at = &layout.panels[k];
        assert_true(fabs((at->right - at->left) / 3 - (at->bottom - at->top) / 4) <= 1e-9);
    }
    assert_true(layout.panels[0].right < layout.panels[1].left);
    char *svg, message[256], fault[256];
    if (!have_gnuplot()) skip();
    assert_int_equal(plot_svg(NULL, &plot, &svg, message, sizeof message), PLOT_OK);
    if (!markup_well_formed(svg, fault, sizeof fault)) fail_msg("%s", fault);
    assert_int_equal(occurrences(svg, " href=\"data:image/png;base64,"), 2);
    assert_null(strstr(svg, "xlink"));
    free(svg);
}
