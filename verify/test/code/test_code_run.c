/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests parts of a run of another code: the varied start, the name of the snapshot, its box, the
 * log, the place of a profile, and a process that cannot begin. (The transcripts and other_codes.py
 * test whole runs.) */
#include "test.h"

#include <errno.h>
#include <stdbool.h>
#include <sys/socket.h>

#include "own_folder.h"

static bool no_sockets;

static int make_sockets(int domain, int type, int protocol, int ends[2])
{
    errno = EMFILE;
    return no_sockets ? -1 : socketpair(domain, type, protocol, ends);
}

#define socketpair make_sockets
#include "../../code/code_process.c"
#undef socketpair
/* the run itself, because its static functions are tested */
#include "../../code/code_run.c"

/* Each value changes by 2 units in the last place, up or down at random, except 0, and except where
 * a position would leave the box. */
TEST(varied_starts)
{
    enum { COLUMNS = 7, N = 6, SEEDS = 12 };
    static const double hi = 0.5, lo[3] = {-0.5, 0.25, 0};
    const struct start_format coarse = {.precision = "float32"}, fine = {0};
    double storage[COLUMNS * N], before[COLUMNS * N];
    for (int single = 0; single < 2; single++)
        for (uint64_t seed = 1; seed <= SEEDS; seed++) {
            struct run_result start = {
                .problem.domain = {.lo = {lo[0], lo[1], lo[2]}, .hi = {hi, hi, hi}},
                .snapshot = {.n = N},
                .storage = storage};
            struct snapshot *s = &start.snapshot;
            for (int d = 0; d < 3; d++) {
                const float down = nextafterf(nextafterf((float)hi, 0), 0);
                const double top = single ? (double)down : nextafter(nextafter(hi, 0), 0);
                const float up = nextafterf(nextafterf((float)lo[d], 1), 1);
                const double bottom = single ? (double)up : nextafter(nextafter(lo[d], 1), 1);
                const double x[N] = {lo[d], bottom, 0.3, 0.375, top, hi};
                memcpy(storage + d * N, x, sizeof x);
                s->x[d] = storage + d * N;
                s->v[d] = storage + (3 + d) * N;
                for (size_t i = 0; i < N; i++)
                    storage[(size_t)(3 + d) * N + i] = (double)(float)(0.1 * (double)i - 0.25);
            }
            s->u = storage + 6 * N;
            for (size_t i = 0; i < N; i++) storage[6 * N + i] = (double)i;
            memcpy(before, storage, sizeof before);
            vary_start(&start, single ? &coarse : seed % 2 ? &fine : NULL, seed);
            for (size_t k = 0; k < COLUMNS * N; k++) {
                const double old = before[k];
                const bool up = places_random(seed, k) < 0.5;
                const float of = (float)old, to = up ? INFINITY : -INFINITY;
                double want = single ? (double)nextafterf(nextafterf(of, to), to)
                                     : nextafter(nextafter(old, (double)to), (double)to);
                if (old == 0 || (k < 3 * N && !(want >= lo[k / N] && want < hi))) want = old;
                if (storage[k] != want)
                    fail_msg("single %d, seed %d, value %zu: %.17g, expected %.17g", single,
                             (int)seed, k, storage[k], want);
            }
        }
    /* a start in 1D has no other positions and velocities */
    double line[3] = {0.25, 1, 2};
    struct run_result start = {.problem.domain = {.hi = {1}}, .storage = line};
    start.snapshot = (struct snapshot){.n = 1, .x = {line}, .v = {line + 1}, .u = line + 2};
    vary_start(&start, NULL, 1);
    assert_true(line[0] != 0.25 && line[1] != 1 && line[2] != 2);
}

static void name_snapshot(struct code_case *of, struct course *course, const char *name)
{
    of->way.line[CODE_snapshot] = 1;
    snprintf(of->way.value[CODE_snapshot], sizeof of->way.value[CODE_snapshot], "%s", name);
    course->values.of[CODE_WORD_OUT] = "out";
    course->values.of[CODE_WORD_IC] = "ic.csv";
}

TEST(patterns_of_snapshots)
{
    static const struct {
        const char *folder, *name, *pattern;
    } rows[] = {{"runs/1", "@OUT@_*.csv", "runs/1/out_*.csv"},
                {"a*b?c[d]e\\f", "@OUT@_?.csv", "a\\*b\\?c\\[d]e\\\\f/out_?.csv"},
                {"runs/1", "/tmp/@OUT@*", "/tmp/out*"}};
    static struct code_case of;
    static struct course course;
    const struct code_external external = {.of = &of};
    course.external = &external;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        name_snapshot(&of, &course, rows[k].name);
        snprintf(course.folder, sizeof course.folder, "%s", rows[k].folder);
        char *pattern = pattern_of(&course);
        assert_string_equal(pattern, rows[k].pattern);
        free(pattern);
    }
}

/* The folder of a run is in that of --work, in TMPDIR, or in /tmp. */
TEST(folders_of_runs)
{
    static struct code_case of;
    static struct course course;
    static struct run run;
    static char deep[CODE_PATH];
    struct code_external external = {.of = &of};
    struct error error = {0};
    char begins[300];
    memset(deep, 'd', sizeof deep - 20);
    for (size_t k = 100; k < sizeof deep - 20; k += 100) deep[k] = '/';
    snprintf(run.asked.file.name, sizeof run.asked.file.name, "sod");
    course.run = &run, course.external = &external, course.start.n = 40;
    name_snapshot(&of, &course, "@OUT@");
    for (int k = 0; k < 4; k++) {
        if (k == 0)
            snprintf(begins, sizeof begins, "/tmp/sphproof-");
        else
            snprintf(begins, sizeof begins, k < 3 ? "%s/sphproof-" : "%s/sod-n40-", own_folder);
        external.work = k == 3 ? own_folder : NULL;
        if (k == 1)
            unsetenv("TMPDIR"), snprintf(begins, sizeof begins, "/tmp/sphproof-");
        else
            setenv("TMPDIR", k ? own_folder : "", 1);
        assert_int_equal(make_folder(&course, &error), STATUS_OK);
        if (strncmp(course.folder, begins, strlen(begins)))
            fail_msg("%s, not %s...", course.folder, begins);
        assert_memory_equal(course.ic, course.folder, strlen(course.folder));
        assert_string_equal(course.ic + strlen(course.folder), "/ic.csv");
        assert_int_equal(rmdir(course.folder), 0);
    }
    external.work = NULL;
    for (int k = 0; k < 2; k++) {
        setenv("TMPDIR", k ? deep : "no_such_folder", 1);
        assert_int_equal(make_folder(&course, &error), STATUS_ENVIRONMENT);
        assert_string_equal(course.folder, "");
        assert_non_null(strstr(error.message, "no folder for a run in the folder of temporary"));
    }
    unsetenv("TMPDIR");
}

/* A file that does not tell its box has the case's if all particles are in that, else one from
 * 0. */
TEST(boxes_of_snapshots)
{
    static const struct {
        double x[3], y[3];
        bool boxed;
        const char *box; /* NULL: that of the file */
    } rows[] = {{{-1, 0, 2}, {0.5, 0.75, 1.5}, false, "-1:2,0.5:1.5"},
                {{-1, 0, 2}, {0.5, 0.75, 1.5}, true, NULL},
                {{-1.5, 0, 2}, {0.5, 0.75, 1.5}, false, "0:3,0:1"},
                {{-1, 0, 2.5}, {0.5, 0.75, 1.5}, false, "0:3,0:1"},
                {{-1, 0, 2}, {0.25, 0.75, 1.5}, false, "0:3,0:1"},
                {{-1, 0, 2}, {0.5, 0.75, 1.75}, false, "0:3,0:1"},
                {{-1, (double)NAN, 2}, {0.5, 0.75, 1.5}, false, "0:3,0:1"}};
    static struct course course;
    course.start.problem.domain = (struct domain){.dim = 2, .lo = {-1, 0.5}, .hi = {2, 1.5}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char text[160] = "";
        double x[3], y[3];
        struct snapshot_file file = {.n = 3, .dim = 2, .boxed = rows[k].boxed};
        memcpy(x, rows[k].x, sizeof x), memcpy(y, rows[k].y, sizeof y);
        file.column[SNAPSHOT_X] = x, file.column[SNAPSHOT_X + 1] = y;
        assert_int_equal(box_of(&course, &file, text, sizeof text), rows[k].box != NULL);
        assert_string_equal(text, rows[k].box ? rows[k].box : "");
    }
    /* a file in 1D of a case in 2D */
    char text[160];
    double x[1] = {0};
    struct snapshot_file file = {.n = 1, .dim = 1, .column = {x}};
    assert_true(box_of(&course, &file, text, sizeof text));
    assert_string_equal(text, "-1:2,0.5:1.5");
}

/* The log is the end of standard error, at most 8 lines and 1500 bytes; or of the output. */
TEST(ends_of_logs)
{
    static char longer[3000], end[1501];
    static const struct {
        const char *error, *output, *log; /* NULL: no file */
    } rows[] = {{"one\ntwo\n", "out\n", "one\ntwo"},
                {"", "out\n", "out"},
                {" \n\n", "out", "out"},
                {NULL, "out\n \n", "out"},
                {NULL, NULL, ""},
                {"1\n2\n3\n4\n5\n6\n7\n8\n", NULL, "1\n2\n3\n4\n5\n6\n7\n8"},
                {"1\n2\n3\n4\n5\n6\n7\n8\n9\n", NULL, "2\n3\n4\n5\n6\n7\n8\n9"},
                {"1\n\n\n4\n", NULL, "1\n4"},
                {longer, NULL, end}};
    static struct course course;
    memset(longer, 'a', sizeof longer - 1), memset(end, 'a', sizeof end - 1);
    longer[sizeof longer - 1501] = 'b', end[0] = 'b';
    snprintf(course.folder, sizeof course.folder, "%s", own_folder);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        for (int s = 0; s < 2; s++) {
            const char *text = s ? rows[k].output : rows[k].error;
            unlink(path_of(s ? "stdout" : "stderr"));
            if (text)
                assert_int_equal(output_text(path_of(s ? "stdout" : "stderr"), text, NULL), 0);
        }
        char *log = log_of(&course);
        assert_string_equal(log, rows[k].log);
        free(log);
    }
    FILE *file = fopen(path_of("stderr"), "wb"); /* bytes that are no text */
    fwrite("a\0b\033c\n", 1, 6, file);
    fclose(file);
    char *log = log_of(&course);
    assert_string_equal(log, "a?b?c");
    free(log);
    course.folder[0] = '\0';
    log = log_of(&course);
    assert_string_equal(log, "");
    free(log);
}

/* Positions of a profile and of a map move to the case's box, a radius does not. */
/* Without the file of the initial state nothing is run. */
TEST(no_initial_state)
{
    static struct code_case of;
    static struct course course;
    const struct code_external external = {.of = &of};
    struct error error = {0};
    course.external = &external;
    name_snapshot(&of, &course, "@OUT@*");
    snprintf(course.ic, sizeof course.ic, "%s", path_of("none.csv"));
    assert_int_equal(execute(&course, &error), STATUS_ENVIRONMENT);
    assert_non_null(strstr(error.message, "none.csv: No such file or directory"));
    assert_false(course.reason || course.is_judged);
}

/* Where no socket can be made there is no process. */
TEST(no_sockets_left)
{
    static const char *const words[] = {"true", NULL};
    const struct code_order order = {
        .words = words, .folder = own_folder, .seconds = 60, .bytes = (double)INFINITY};
    for (int none = 0; none < 2; none++) {
        struct code_outcome outcome = {.exit = 7};
        struct error error = {0};
        no_sockets = none;
        assert_int_equal(code_process(&order, &outcome, &error),
                         none ? STATUS_ENVIRONMENT : STATUS_OK);
        assert_int_equal(outcome.exit, none ? 7 : 0);
        assert_string_equal(error.message,
                            none ? "no process for another code: Too many open files" : "");
    }
    no_sockets = false;
}

TEST(places_of_profiles)
{
    static const struct {
        const char *profile, *placed;
    } rows[] = {
        {"{\"x\": [0, 2.5], \"density\": [1, 2], \"exact\": {\"x\": [1, 3], \"density\": [4]}}",
         "{\"x\": [-1, 1.5], \"density\": [1, 2], \"exact\": {\"x\": [0, 2], \"density\": [4]}}"},
        {"{\"over\": \"x\", \"x\": [1], \"exact\": {\"x\": [1]},"
         " \"map\": {\"x\": [1, 2], \"y\": [3, 4, 5]}}",
         "{\"over\": \"x\", \"x\": [0], \"exact\": {\"x\": [0]},"
         " \"map\": {\"x\": [0, 1], \"y\": [5, 6, 7]}}"},
        {"{\"over\": \"R\", \"x\": [1], \"exact\": {\"x\": [1]},"
         " \"map\": {\"x\": [1, 2], \"y\": [3]}}",
         "{\"over\": \"R\", \"x\": [1], \"exact\": {\"x\": [1]},"
         " \"map\": {\"x\": [0, 1], \"y\": [5]}}"}};
    const struct domain ours = {.dim = 2, .lo = {-1, 2.5}}, theirs = {.dim = 2, .lo = {0, 0.5}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        json_t *moved = placed(json_loads(rows[k].profile, 0, NULL), &ours, &theirs);
        char *text = json_dumps(moved, 0);
        json_t *found = json_loads(text, JSON_DECODE_INT_AS_REAL, NULL),
               *want = json_loads(rows[k].placed, JSON_DECODE_INT_AS_REAL, NULL);
        if (!json_equal(found, want)) fail_msg("%s, not %s", text, rows[k].placed);
        json_decref(moved), json_decref(found), json_decref(want);
        free(text);
    }
}
