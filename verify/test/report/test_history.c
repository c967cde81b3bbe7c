/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the history of a report with generated nights: none, as many as are kept and more, and
 * nights that lack a figure; and in which direction a change is better. (test_diff_drawn.c tests
 * damaged lines and the line that a night adds.) */
#include "test.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "history.h"
#include "own_folder.h"
#include "result.h"
#include "value.h"

enum { NIGHTS_MOST = 500, KEPT = 120 };

static const char error_path[] = "studies[sod, ia].levels[n 400].errors.density.l1",
                  order_path[] = "studies[sod, ia].orders[density, l1].order",
                  steps_path[] = "studies[sod, ia].levels[n 400].cost.steps";

/* The results of a night; a field that is NULL or NaN is missing in its line, as are 0 steps. */
struct night {
    const char *mode;
    char git[16], date[16];
    double error, order, half; /* of the order's interval */
    int steps;
};

static json_t *results_of(const struct night *night)
{
    json_t *results = result_new("report");
    json_object_set_new(results, "git", json_string(night->git));
    json_object_set_new(results, "date", json_string(night->date));
    json_object_set_new(results, "mode", json_string(night->mode));
    json_object_set_new(results, "verdict", json_pack("{s:s, s:[]}", "status", "pass", "failures"));
    json_object_set_new(
        results, "studies",
        json_pack("[{s:s, s:s, s:s, s:[{s:i, s:{s:{s:f, s:f}}}], s:[{s:s, s:s, "
                  "s:f, s:f, s:f}], s:[s,s]}]",
                  "case", "sod", "label", "ia", "status", "pass", "levels", "n", 400, "errors",
                  "density", "l1", night->error, "l2", 2 * night->error, "orders", "field",
                  "density", "norm", "l1", "order", night->order, "low", night->order - night->half,
                  "high", night->order + night->half, "measured", "mode_amplitude", "density"));
    json_t *level = json_array_get(
        json_object_get(json_array_get(json_object_get(results, "studies"), 0), "levels"), 0);
    if (night->steps) json_object_set_new(level, "cost", json_pack("{s:i}", "steps", night->steps));
    return results;
}

static void write_night(FILE *file, const struct night *night)
{
    json_t *figures = json_object();
    if (!isnan(night->error)) json_object_set_new(figures, error_path, json_real(night->error));
    if (!isnan(night->order)) json_object_set_new(figures, order_path, json_real(night->order));
    if (night->steps) json_object_set_new(figures, steps_path, json_integer(night->steps));
    json_t *line = json_pack("{s:s, s:s, s:o}", "schema", "sphproof-history/1", "mode", night->mode,
                             "figures", figures);
    if (night->git[0]) json_object_set_new(line, "git", json_string(night->git));
    if (night->date[0]) json_object_set_new(line, "date", json_string(night->date));
    json_dumpf(line, file, JSON_COMPACT);
    fputc('\n', file);
    json_decref(line);
}

static json_t *reported(const struct night *now)
{
    struct error error = {0};
    json_t *history, *results = results_of(now);
    assert_int_equal(history_tell(results, path_of("history"), &history, &error), STATUS_OK);
    json_decref(results);
    return history;
}

static struct night usual_night(int number)
{
    struct night night = {.mode = "quick", .error = 1e-3, .order = 0.95, .half = 0.01};
    snprintf(night.git, sizeof night.git, "git%d", number);
    snprintf(night.date, sizeof night.date, "day%d", number);
    return night;
}

/* The trend is of the study's gated figure, and of the first study that has errors and orders. */
static const json_t *trend_of(const json_t *history, const char *what)
{
    const json_t *trends = json_object_get(history, "trends");
    assert_int_equal(json_array_size(trends), 1);
    assert_string_equal(value_text(json_array_get(trends, 0), "field"), "density");
    return json_object_get(json_array_get(trends, 0), what);
}

/* Compares the history with these nights, oldest first; the last one is tonight. */
static void same_nights(const json_t *history, const struct night *const *nights, size_t count)
{
    const json_t *heads = json_object_get(history, "nights"), *errors = trend_of(history, "error"),
                 *orders = trend_of(history, "order");
    assert_int_equal(json_array_size(heads), count);
    assert_int_equal(json_array_size(errors), count);
    assert_int_equal(json_array_size(orders), count);
    for (size_t i = 0; i < count; i++) {
        const double error = value_real(json_array_get(errors, i)),
                     order = value_real(json_array_get(orders, i));
        assert_string_equal(value_text(json_array_get(heads, i), "git"), nights[i]->git);
        assert_string_equal(value_text(json_array_get(heads, i), "date"), nights[i]->date);
        assert_int_equal(isnan(error), isnan(nights[i]->error));
        assert_int_equal(isnan(order), isnan(nights[i]->order));
        if (!isnan(error)) near_relative(error, nights[i]->error, 1e-12);
        if (!isnan(order)) near_relative(order, nights[i]->order, 1e-12);
    }
}

static void same_since(const json_t *history, const struct night *const *nights, size_t count)
{
    const json_t *since = json_object_get(history, "since");
    if (count < 2) {
        assert_true(json_is_null(since));
    } else {
        assert_string_equal(value_text(since, "git"), nights[count - 2]->git);
        assert_string_equal(value_text(since, "date"), nights[count - 2]->date);
    }
}

/* The newest 120 nights are kept, tonight the last of them. */
TEST(the_newest_are_kept)
{
    static const int counts[] = {0, 1, 2, 3, 118, 119, 120, 121, 122, 240, NIGHTS_MOST};
    static struct night made[NIGHTS_MOST + 1];
    const struct night *expected[NIGHTS_MOST + 1];
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        FILE *file = fopen(path_of("history"), "w");
        for (int i = 0; i <= counts[c]; i++) {
            made[i] = usual_night(i);
            made[i].error *= 1 + 1e-6 * i;
            made[i].order *= 1 + 1e-6 * i;
            expected[i] = &made[i];
            if (i < counts[c]) write_night(file, &made[i]);
        }
        fclose(file);
        const size_t count = (size_t)counts[c] + 1, kept = count < KEPT ? count : KEPT;
        json_t *history = reported(&made[counts[c]]);
        same_nights(history, expected + count - kept, kept);
        same_since(history, expected + count - kept, kept);
        near_absolute(value_member(history, "unreadable"), 0, 0);
        assert_int_equal(json_array_size(json_object_get(history, "changes")), 0);
        json_decref(history);
        unlink(path_of("history"));
    }
}

/* A history that cannot be opened: its path goes through a file. */
TEST(history_that_cannot_be_opened)
{
    const struct night night = usual_night(1);
    json_t *results = results_of(&night), *history;
    struct error error = {0};
    char path[300];
    fclose(fopen(path_of("history"), "w"));
    snprintf(path, sizeof path, "%s/night", path_of("history"));
    assert_int_equal(history_append(results, path, &error), STATUS_ENVIRONMENT);
    assert_non_null(strstr(error.message, "cannot write the history '"));
    assert_non_null(strstr(error.message, "history/night': Not a directory"));
    error = (struct error){0};
    assert_int_equal(history_tell(results, path, &history, &error), STATUS_ENVIRONMENT);
    assert_non_null(strstr(error.message, "history/night': Not a directory"));
    assert_null(history);
    unlink(path_of("history"));
    json_decref(results);
}

/* A line is cut off where the disk is full; the next one begins on a new line. Who may read and
 * write the file is up to the umask. */
TEST(full_disk)
{
    const struct night night = usual_night(1);
    json_t *results = results_of(&night), *history;
    struct error error = {0};
    struct rlimit usual, limit;
    const mode_t mask = umask(0);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &usual), 0);
    for (int lines = 0; lines < 2; lines++) {
        struct stat is = {0};
        const char *path = path_of("history");
        for (int k = 0; k < lines; k++)
            assert_int_equal(history_append(results, path, &error), STATUS_OK);
        if (lines) assert_int_equal(stat(path, &is), 0);
        if (lines) assert_int_equal(is.st_mode & 0777, 0666);
        limit = usual, limit.rlim_cur = (rlim_t)is.st_size + 20;
        signal(SIGXFSZ, SIG_IGN);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
        assert_int_equal(history_append(results, path, &error), STATUS_ENVIRONMENT);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &usual), 0);
        assert_non_null(strstr(error.message, "history': No space left on device"));
        assert_int_equal(stat(path, &is), 0);
        assert_int_equal(is.st_size, limit.rlim_cur);
        assert_int_equal(history_append(results, path, &error), STATUS_OK);
        assert_int_equal(history_tell(results, path, &history, &error), STATUS_OK);
        assert_true(value_member(history, "unreadable") == 1);
        assert_int_equal(json_array_size(json_object_get(history, "nights")), lines + 2);
        json_decref(history);
        unlink(path);
    }
    umask(mask);
    json_decref(results);
}

/* A line is on its own behind any other, of one character too; without a standard input the file
 * has its number. */
TEST(lines_of_their_own)
{
    static const char *const before[] = {"", "x", "x\n", "\n", "long line", "long line\n"};
    for (size_t k = 0; k < 2 * sizeof before / sizeof *before; k++) {
        const struct night night = usual_night(1);
        const char *text = before[k / 2], *path = path_of("history");
        const bool ends = !*text || text[strlen(text) - 1] == '\n';
        json_t *results = results_of(&night);
        struct error error = {0};
        char line[40] = "", expected[40];
        FILE *file = fopen(path, "w");
        fputs(text, file);
        fclose(file);
        const int input = k % 2 ? dup(0) : -1;
        if (input >= 0) close(0);
        const enum status status = history_append(results, path, &error);
        if (input >= 0) dup2(input, 0), close(input);
        assert_int_equal(status, STATUS_OK);
        file = fopen(path, "r");
        const size_t n = fread(line, 1, strlen(text) + !ends + 10, file);
        fclose(file);
        snprintf(expected, sizeof expected, "%s%s{\"schema\":", text, ends ? "" : "\n");
        assert_int_equal(n, strlen(expected));
        assert_string_equal(line, expected);
        json_decref(results);
        unlink(path);
    }
}

/* The change of one figure from `before` to `after` at night `at` of `count`, as the document has
 * it. */
static json_t *changed(const char *path, double before, double after, double half, int at,
                       int count)
{
    FILE *file = fopen(path_of("history"), "w");
    struct night night;
    for (int i = 0; i < count; i++) {
        night = usual_night(i);
        night.half = half;
        *(path == error_path ? &night.error : &night.order) = i < at ? before : after;
        if (i < count - 1) write_night(file, &night);
    }
    fclose(file);
    json_t *history = reported(&night);
    unlink(path_of("history"));
    return history;
}

/* A smaller error and a larger order are better, before and after the oldest nights are left out.
 */
TEST(which_way_is_better)
{
    static const struct {
        const char *path;
        double before, after;
        const char *verdict;
    } rows[] = {
        {error_path, 1e-3, 2e-3, "worse"},    {error_path, 2e-3, 1e-3, "better"},
        {error_path, 1e-3, 1.05e-3, "worse"}, {error_path, 1.05e-3, 1e-3, "better"},
        {order_path, 0.95, 0.80, "worse"},    {order_path, 0.80, 0.95, "better"},
        {order_path, 0.95, 1.95, "better"},   {order_path, 1.95, 0.95, "worse"},
        {order_path, 0.50, -0.5, "worse"},    {order_path, -0.5, 0.50, "better"},
    };
    static const int counts[] = {2, 12, 119, 120, 121, 150};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++)
        for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
            const int count = counts[c], at = count - (count > 2 ? 6 : 1);
            const int first = count > KEPT ? count - KEPT : 0;
            json_t *history = changed(rows[r].path, rows[r].before, rows[r].after, 0.01, at, count);
            const json_t *changes = json_object_get(history, "changes"),
                         *change = json_array_get(changes, 0);
            char git[32];
            assert_int_equal(json_array_size(changes), 1);
            assert_string_equal(value_text(change, "path"), rows[r].path);
            assert_string_equal(value_text(change, "verdict"), rows[r].verdict);
            near_absolute(value_member(change, "night"), at - first, 0);
            near_relative(value_member(change, "before"), rows[r].before, 1e-12);
            near_relative(value_member(change, "after"), rows[r].after, 1e-12);
            near_relative(value_member(change, "ratio"), rows[r].after / rows[r].before, 1e-12);
            snprintf(git, sizeof git, "git%d", at);
            assert_string_equal(value_text(change, "git"), git);
            snprintf(git, sizeof git, "day%d", at);
            assert_string_equal(value_text(change, "date"), git);
            snprintf(git, sizeof git, "git%d", at - 1);
            assert_string_equal(value_text(change, "git_before"), git);
            json_decref(history);
        }
}

/* Changes within the noise do not count: 1 % of an error, 0.03 of an order or half its interval,
 * and errors that are round-off. */
TEST(changes_within_noise)
{
    static const struct {
        const char *path;
        double before, after, half;
        size_t count;
    } rows[] = {
        {error_path, 1e-3, 1.009e-3, 0.01, 0}, {error_path, 1e-3, 0.991e-3, 0.01, 0},
        {error_path, 1e-3, 1.011e-3, 0.01, 1}, {error_path, 1e-20, 1e-16, 0.01, 0},
        {order_path, 0.95, 0.979, 0.01, 0},    {order_path, 0.95, 0.921, 0.01, 0},
        {order_path, 0.95, 0.981, 0.01, 1},    {order_path, 0.95, 0.919, 0.01, 1},
        {order_path, 0.95, 1.149, 0.20, 0},    {order_path, 0.95, 1.151, 0.20, 1},
    };
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        json_t *history = changed(rows[r].path, rows[r].before, rows[r].after, rows[r].half, 6, 12);
        assert_int_equal(json_array_size(json_object_get(history, "changes")), rows[r].count);
        json_decref(history);
    }
}

/* The newest change comes first, and of one night the largest. */
TEST(order_of_changes)
{
    static const struct {
        int error_at, order_at;
        double error, order; /* afterwards; before: 1e-3 and 0.95 */
        const char *first;
    } rows[] = {{4, 8, 9e-3, 1.9, order_path},  {8, 4, 2e-3, 9.5, error_path},
                {6, 6, 9e-3, 1.9, error_path},  {6, 6, 2e-3, 9.5, order_path},
                {6, 6, 1e-4, 1.9, error_path},  {6, 6, 2e-3, 0.095, order_path},
                {6, 6, 9e-3, 0.19, error_path}, {6, 6, 5e-4, 0.095, order_path}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        FILE *file = fopen(path_of("history"), "w");
        struct night night;
        for (int i = 0; i < 12; i++) {
            night = usual_night(i);
            if (i >= rows[r].error_at) night.error = rows[r].error;
            if (i >= rows[r].order_at) night.order = rows[r].order;
            if (i < 11) write_night(file, &night);
        }
        fclose(file);
        json_t *history = reported(&night);
        const json_t *changes = json_object_get(history, "changes");
        assert_int_equal(json_array_size(changes), 2);
        assert_string_equal(value_text(json_array_get(changes, 0), "path"), rows[r].first);
        json_decref(history);
    }
    unlink(path_of("history"));
}

/* Faults come first, then the largest changes, up or down, and figures without a ratio; counts of
 * work are last; equal changes are in the order of their paths. */
static void in_order_of_since(const json_t *figures)
{
    const json_t *figure, *last = NULL;
    size_t i;
    json_array_foreach(figures, i, figure) {
        int group[2] = {0};
        double moved[2];
        const json_t *const both[] = {last, figure};
        for (int k = last ? 0 : 1; k < 2; k++) {
            const double ratio = value_member(both[k], "ratio");
            group[k] = json_is_true(json_object_get(both[k], "fault"))  ? 0
                       : json_is_true(json_object_get(both[k], "work")) ? 2
                                                                        : 1;
            moved[k] = ratio > 0 ? fabs(log(ratio)) : HUGE_VAL;
        }
        if (last && (group[0] > group[1] || (group[0] == group[1] && moved[0] < moved[1]) ||
                     (group[0] == group[1] && moved[0] == moved[1] &&
                      strcmp(value_text(last, "path"), value_text(figure, "path")) >= 0)))
            fail_msg("%s stands before %s", value_text(last, "path"), value_text(figure, "path"));
        last = figure;
    }
}

/* Since last night: the verdict of each figure, faults first, and the number of each verdict. */
TEST(verdicts_since_last_night)
{
    static const struct {
        double error, order; /* last night's; tonight's are 1e-3 and 0.95 */
        const char *of_error, *of_order;
    } rows[] = {
        {1e-3, 0.95, "same", "same"},       {2e-3, 0.95, "better", "same"},
        {0.97e-3, 0.95, "worse", "same"},   {0.94e-3, 0.95, "worse", "same"},
        {5e-4, 0.95, "worse", "same"},      {1e-3, 0.50, "same", "better"},
        {1e-3, 1.50, "same", "worse"},      {5e-4, 0.50, "worse", "better"},
        {2e-3, 1.50, "better", "worse"},    {5e-4, 1.50, "worse", "worse"},
        {2e-3, 0.50, "better", "better"},   {(double)NAN, 0.95, "new", "same"},
        {1e-3, (double)NAN, "same", "new"}, {1.2e-3, 0.20, "better", "better"},
        {9e-3, 0.50, "better", "better"},   {8e-4, 4, "worse", "worse"},
        {1e-4, 1.50, "worse", "worse"},     {9e-3, -0.95, "better", "better"},
        {1e-3, 0.98, "same", "worse"},
    };
    static const char *const words[] = {"same", "better", "worse", "new"};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        struct night last = usual_night(0), now = usual_night(1);
        FILE *file = fopen(path_of("history"), "w");
        last.error = rows[r].error, last.order = rows[r].order;
        last.steps = 1000, now.steps = 100; /* a change larger than those of most errors */
        write_night(file, &last);
        fclose(file);
        json_t *history = reported(&now);
        const json_t *since = json_object_get(history, "since"),
                     *figures = json_object_get(since, "figures"), *figure;
        const char *of_error = "same", *of_order = "same", *of_steps = "same";
        bool fault_ended = false;
        size_t i;
        json_array_foreach(figures, i, figure) {
            const char *path = value_text(figure, "path");
            const bool fault = json_is_true(json_object_get(figure, "fault"));
            assert_false(fault && fault_ended);
            fault_ended = !fault;
            if (strcmp(path, error_path) == 0) {
                of_error = value_text(figure, "verdict");
                if (!isnan(last.error))
                    near_relative(value_member(figure, "old"), last.error, 1e-12);
                near_relative(value_member(figure, "new"), now.error, 1e-12);
                if (!isnan(last.error))
                    near_relative(value_member(figure, "ratio"), now.error / last.error, 1e-12);
            }
            if (strcmp(path, order_path) == 0) of_order = value_text(figure, "verdict");
            if (strcmp(path, steps_path) == 0) of_steps = value_text(figure, "verdict");
            assert_string_not_equal(value_text(figure, "verdict"), "same");
            const bool grown = strcmp(path, error_path) || now.error > 1.05 * last.error;
            assert_int_equal(fault, grown && !strcmp(value_text(figure, "verdict"), "worse"));
        }
        in_order_of_since(figures);
        assert_string_equal(of_error, rows[r].of_error);
        assert_string_equal(of_order, rows[r].of_order);
        assert_string_equal(of_steps, "better");
        for (size_t w = 1; w < sizeof words / sizeof *words; w++) {
            size_t count = 0;
            if (w < 3) /* "new" also counts statuses, which the earlier line lacks */
                json_array_foreach(figures, i, figure)
                    count += strcmp(value_text(figure, "verdict"), words[w]) == 0;
            if (w < 3) near_absolute(value_member(since, words[w]), (double)count, 0);
        }
        json_decref(history);
    }
    unlink(path_of("history"));
}

/* An error that has grown by more than 5 % is a fault. */
TEST(faults_since_last_night)
{
    static const struct {
        double now; /* last night's: 20 */
        bool fault;
    } rows[] = {{20.9, false}, {21, false}, {21.001, true}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        struct night last = usual_night(0), now = usual_night(1);
        FILE *file = fopen(path_of("history"), "w");
        last.error = 20, now.error = rows[r].now;
        write_night(file, &last);
        fclose(file);
        json_t *history = reported(&now);
        const json_t *figures = json_object_get(json_object_get(history, "since"), "figures"),
                     *figure;
        bool found = false;
        size_t i;
        json_array_foreach(figures, i, figure) {
            if (strcmp(value_text(figure, "path"), error_path) != 0) continue;
            assert_int_equal(json_is_true(json_object_get(figure, "fault")), rows[r].fault);
            found = true;
        }
        assert_true(found);
        json_decref(history);
    }
    unlink(path_of("history"));
}

/* A night without a figure is no change, and does not shift the night of a change. */
TEST(nights_that_lack_a_figure)
{
    for (int lacking = 0; lacking < 3; lacking++) { /* before the change, around it, at it */
        FILE *file = fopen(path_of("history"), "w");
        struct night night;
        for (int i = 0; i < 15; i++) {
            night = usual_night(i);
            night.error = i < 8 ? 1e-3 : 2e-3;
            if (lacking == 0 && (i == 2 || i == 5)) night.error = (double)NAN;
            if (lacking == 1 && (i == 6 || i == 9)) night.error = (double)NAN;
            if (lacking == 2 && (i == 7 || i == 8)) night.error = (double)NAN;
            if (i < 14) write_night(file, &night);
        }
        fclose(file);
        json_t *history = reported(&night);
        const json_t *changes = json_object_get(history, "changes"),
                     *change = json_array_get(changes, 0);
        assert_int_equal(json_array_size(changes), 1);
        assert_string_equal(value_text(change, "git"), lacking == 2 ? "git9" : "git8");
        assert_string_equal(value_text(change, "git_before"), lacking == 2 ? "git6" : "git7");
        near_absolute(value_member(change, "night"), lacking == 2 ? 9 : 8, 0);
        json_decref(history);
    }
    unlink(path_of("history"));
}

/* A night keeps the worst figure of each check, in whichever order they come; the worst is one that
 * is not a number. Skipped figures and those without a bound are not kept. */
TEST(worst_figure_of_a_check)
{
    static const char *const values[] = {"0.5", "\"nan\"", "2", "\"inf\"", "1"};
    enum { VALUES = sizeof values / sizeof *values };
    for (int which = 1; which < 1 << VALUES; which++)
        for (int turned = 0; turned < 2; turned++) {
            const char *path = path_of("history");
            const struct night night = usual_night(1);
            json_t *results = results_of(&night), *checks = json_array();
            struct error error = {0};
            for (int i = 0; i < VALUES; i++) {
                const int k = turned ? VALUES - 1 - i : i;
                if (which & 1 << k)
                    json_array_append_new(
                        checks, json_pack("{s:s, s:s, s:s, s:i, s:o}", "group", "g", "name", "c",
                                          "status", "pass", "bound", 2, "value",
                                          json_loads(values[k], JSON_DECODE_ANY, NULL)));
            }
            json_array_append_new(checks,
                                  json_pack("{s:s, s:s, s:s, s:i, s:i}", "group", "g", "name", "c",
                                            "status", "skip", "bound", 2, "value", 9));
            json_array_append_new(checks,
                                  json_pack("{s:s, s:s, s:s, s:i, s:i}", "group", "g", "name", "c",
                                            "status", "pass", "bound", 0, "value", 9));
            json_object_set_new(results, "verify", json_pack("{s:o}", "checks", checks));
            unlink(path);
            assert_int_equal(history_append(results, path, &error), STATUS_OK);
            json_decref(results);
            json_t *line = json_load_file(path, 0, NULL);
            const double kept =
                value_member(json_object_get(line, "figures"), "verify[g, c].value_over_bound");
            if (which & 2)
                assert_true(isnan(kept));
            else
                assert_true(kept == (which & 8    ? (double)INFINITY
                                     : which & 4  ? 1
                                     : which & 16 ? 0.5
                                                  : 0.25));
            json_decref(line);
        }
    unlink(path_of("history"));
}
