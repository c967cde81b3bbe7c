/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the end of `sphproof report` on a small document: the files that it writes, what it prints,
 * its status, and which kept results it removes. (The transcripts and other_codes.py test whole
 * reports.) */
#include "test.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <time.h>

#include "own_folder.h"
#include "printed.h"
/* the command itself, because its static functions are tested */
#include "../../command/report.c"

static const char *values[sizeof report_options / sizeof *report_options];
static struct options options = {.command = &command_report, .values = values};
static struct paths paths;

static void set(const char *name, const char *value)
{
    for (size_t i = 0; report_options[i].name; i++)
        if (!strcmp(report_options[i].name, name)) values[i] = value;
}

/* Sets the paths of a report in this folder. */
static void go_to(const char *name)
{
    static char folder[256];
    struct error error = {0};
    snprintf(folder, sizeof folder, "%s", path_of(name));
    set("out", folder);
    assert_int_equal(take_paths(&options, &paths, &error), STATUS_OK);
    assert_int_equal(output_folder(paths.plots, &error), STATUS_OK);
}

static enum status tell_of(const char *verdict, char text[4096], struct error *error)
{
    json_t *results =
        json_pack("{s:s, s:f, s:f, s:f, s:{s:s, s:[]}}", "command", "report", "computations", 7.,
                  "found", 3., "seconds", 2.25, "verdict", "status", verdict, "lines");
    const struct printed printed = printed_begin();
    *error = (struct error){0};
    const enum status status = tell(&options, results, &paths, error);
    printed_end(&printed, text, 4096);
    json_decref(results);
    return status;
}

static const char *const files[] = {"results.json", "junit.xml",     "summary.md",
                                    "index.html",   "history.jsonl", "again.json"};
enum { FILES = sizeof files / sizeof *files };

static char *in_folder(const char *file)
{
    static char path[512];
    snprintf(path, sizeof path, "%s/%s", paths.folder, file);
    return path;
}

/* The verdict is the status, and every file is written. */
TEST(files_and_verdict)
{
    static const struct {
        const char *verdict;
        enum status status;
    } rows[] = {{"pass", STATUS_OK}, {"fail", STATUS_CHECK_FAILED}};
    static char json[512];
    for (int k = 0; k < 4; k++) {
        char text[4096], end[256], *last;
        struct error error;
        go_to(k ? "fail" : "pass");
        snprintf(json, sizeof json, "%s", in_folder("again.json"));
        options.json = json;
        options.speak = k > 1;
        assert_int_equal(tell_of(rows[k % 2].verdict, text, &error), rows[k % 2].status);
        for (int f = 0; f < FILES; f++) assert_int_equal(unlink(in_folder(files[f])), 0);
        if (!options.speak) {
            assert_string_equal(text, "");
            continue;
        }
        last = strstr(text, "\n7 computations, 3 of them found in ");
        assert_non_null(last);
        snprintf(end, sizeof end, "%.200s/index.html\n", strrchr(paths.folder, '/'));
        assert_non_null(strstr(last, "/cache; 2.2 s\nreport: /"));
        assert_string_equal(last + strlen(last) - strlen(end), end);
    }
}

/* A file that cannot be written, because a folder has its name, is named. */
TEST(a_file_that_cannot_be_written)
{
    options.speak = 1;
    for (int f = 0; f < FILES; f++) {
        char text[4096], json[512];
        struct error error;
        go_to("stands");
        snprintf(json, sizeof json, "%s", in_folder("again.json"));
        options.json = json;
        assert_int_equal(mkdir(in_folder(files[f]), 0700), 0);
        assert_int_equal(tell_of("pass", text, &error), STATUS_ENVIRONMENT);
        assert_non_null(strstr(error.message, in_folder(files[f])));
        assert_string_equal(text, "");
        assert_int_equal(rmdir(in_folder(files[f])), 0);
    }
    options.json = NULL;
}

/* A nightly report removes what nobody has used for a month. */
TEST(a_month)
{
    static const struct {
        bool nightly, speak;
        int days;
        bool stays;
    } rows[] = {{true, true, 31, false},
                {true, false, 31, false},
                {true, true, 29, true},
                {false, true, 31, true}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        char path[CACHE_PATH_MAX], text[4096], said[512];
        struct error error = {0};
        struct cache cache;
        go_to("kept");
        set("nightly", rows[r].nightly ? "" : NULL);
        options.speak = rows[r].speak;
        json_t *document = json_object();
        assert_int_equal(cache_open(&cache, paths.cache, false, &error), STATUS_OK);
        assert_int_equal(cache_store(&cache, "key", document, &error), STATUS_OK);
        json_decref(document);
        cache_path(&cache, "key", path);
        const struct timespec used = {time(NULL) - rows[r].days * 24 * 3600L, 0};
        assert_int_equal(utimensat(AT_FDCWD, path, (struct timespec[2]){used, used}, 0), 0);
        assert_int_equal(tell_of("fail", text, &error), STATUS_CHECK_FAILED);
        assert_int_equal(access(path, F_OK) == 0, rows[r].stays);
        snprintf(said, sizeof said,
                 "1 results that nobody has used for a month were removed from %.200s\n",
                 paths.cache);
        assert_int_equal(strstr(text, said) != NULL, !rows[r].stays && rows[r].speak);
        assert_int_equal(strstr(text, "nobody") != NULL, !rows[r].stays && rows[r].speak);
    }
    /* a cache that cannot be read */
    char text[4096];
    struct error error;
    go_to("none");
    set("nightly", "");
    assert_int_equal(tell_of("pass", text, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, paths.cache));
    set("nightly", NULL);
}

/* Paths in the folder of --out, up to the longest one. */
TEST(paths_of_a_report)
{
    char path[PATH_LENGTH];
    struct error error = {0};
    set("out", NULL);
    assert_int_equal(take_paths(&options, &paths, &error), STATUS_OK);
    assert_string_equal(paths.plots, "reports/out/plots");
    assert_string_equal(paths.cache, "reports/out/cache");
    assert_string_equal(paths.history, "reports/out/history.jsonl");
    set("history", "nights");
    assert_int_equal(take_paths(&options, &paths, &error), STATUS_OK);
    assert_string_equal(paths.history, "nights");
    set("history", NULL), set("out", path);
    memset(path, 'x', sizeof path);
    path[PATH_LENGTH - 64] = '\0';
    assert_int_equal(take_paths(&options, &paths, &error), STATUS_OK);
    path[PATH_LENGTH - 64] = 'x', path[PATH_LENGTH - 63] = '\0';
    assert_int_equal(take_paths(&options, &paths, &error), STATUS_BAD_INPUT);
    assert_string_equal(error.message, "report: --out: the path is too long");
}
