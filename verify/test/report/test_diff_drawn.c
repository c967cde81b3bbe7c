/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares what diff and history print of random result documents, drawn from
 * data/drawn/figures.json, and where series of figures change, with data/drawn/diffs.txt, byte for
 * byte. verify/test/keep renews that file. */
#include "test.h"

#include "buffer.h"
#include "diff.h"
#include "drawn_document.h"
#include "history.h"
#include "output.h"
#include "own_folder.h"
#include "report_piece.h"

enum { DOCUMENTS = 150, HISTORIES = 12, SERIES = 400, KEPT_TOGETHER = 10 };

static void keep(struct digests *kept, const char *what, size_t number, struct buffer *text)
{
    char name[64], *all = buffer_take(text);
    assert_non_null(all);
    snprintf(name, sizeof name, "%s-%zu", what, number);
    digests_compare(kept, name, all);
    free(all);
}

static void add_json(struct buffer *to, json_t *document)
{
    char *text = json_dumps(document, JSON_INDENT(1) | JSON_REAL_PRECISION(12) | JSON_ENCODE_ANY);
    buffer_format(to, "%s\n", text);
    free(text);
    json_decref(document);
}

/* A changed copy of a document: figures change not at all, little or much, words are replaced,
 * members removed. */
static json_t *changed(struct drawing *draw, const json_t *of, const char *name)
{
    static const double factors[] = {1,         1,      1,      1,    1,   1.0000000005,
                                     1.0000005, 1.0005, 1.0015, 1.04, 1.3, 0.9985,
                                     0.9,       0.6667, 1.06,   2.9,  3.2, 0.3};
    static const char *const words[] = {"pass", "ok",         "fail", "skip",
                                        "none", "broke_down", "odd",  "smoke"};
    const char *key;
    json_t *member, *made;
    size_t i;
    if (json_is_array(of)) {
        made = json_array();
        json_array_foreach(of, i, member)
            if (drawn_below(draw, 20)) json_array_append_new(made, changed(draw, member, name));
        return made;
    }
    if (json_is_object(of)) {
        made = json_object();
        json_object_foreach((json_t *)of, key, member)
            if (drawn_below(draw, 40)) json_object_set_new(made, key, changed(draw, member, key));
        return made;
    }
    if (json_is_real(of) && !drawn_below(draw, 3))
        return json_real(json_real_value(of) *
                         factors[drawn_below(draw, sizeof factors / sizeof *factors)]);
    if (json_is_integer(of) && !drawn_below(draw, 8) && strcmp(name, "n") && strcmp(name, "dim"))
        return json_integer(json_integer_value(of) + 1);
    if (json_is_string(of) &&
        (!strcmp(name, "status") || !strcmp(name, "outcome") || !strcmp(name, "state") ||
         !strcmp(name, "processor")) &&
        !drawn_below(draw, 4))
        return json_string(words[drawn_below(draw, sizeof words / sizeof *words)]);
    return json_deep_copy(of);
}

/* Adds the printed output of diff to a text. */
static void add_printed(struct buffer *to, const struct diff *diff, bool exact, bool color)
{
    char text[4096];
    fflush(stdout);
    const int before = dup(1);
    FILE *file = output_temporary();
    dup2(fileno(file), 1);
    diff_print(diff, DIFF_THRESHOLD, exact, color);
    fflush(stdout);
    dup2(before, 1);
    close(before);
    rewind(file);
    for (size_t n; (n = fread(text, 1, sizeof text, file));) buffer_add_bytes(to, text, n);
    fclose(file);
}

static void add_metrics(struct buffer *to, const json_t *document)
{
    struct metrics metrics;
    struct error error = {0};
    assert_int_equal(metric_collect(document, &metrics, &error), STATUS_OK);
    for (size_t i = 0; i < metrics.count; i++) {
        const struct metric *r = &metrics.list[i];
        buffer_format(to, "%s %d %.10g %.6g %.6g %.10g %s %d\n", r->path, r->kind, r->value,
                      r->noise, r->floor, r->exact, r->word ? r->word : "-", r->headline);
    }
    buffer_format(to, "%s\n", metrics.trouble);
    metric_free(&metrics);
}

TEST(diffs)
{
    static const char *const kinds[] = {"report", "report", "other", "other", "anything_else"};
    json_t *template = read_template(test_word(1), "figures.json");
    struct digests kept;
    struct buffer text = {0};
    digests_open(&kept, test_word(1), "diffs.txt");
    for (size_t k = 0; k < DOCUMENTS; k++) {
        struct drawing draw = {k, template};
        struct error error = {0};
        struct diff diff;
        const json_t *kind = json_object_get(template, kinds[drawn_below(&draw, 5)]);
        json_t *old = drawn_document(&draw, kind),
               *new = drawn_below(&draw, 6) ? changed(&draw, old, "") : drawn_document(&draw, kind);
        if (!drawn_below(&draw, 15)) json_object_set_new(new, "command", json_string("kernel"));
        add_metrics(&text, old);
        const enum status status = diff_documents(old, new, DIFF_THRESHOLD, &diff, &error);
        buffer_format(&text, "%d %s\n", status, error.message);
        if (status == STATUS_OK || status == STATUS_CHECK_FAILED) {
            json_t *document = json_object();
            diff_add_json(&diff, document);
            add_json(&text, document);
            add_json(&text, diff_figures_json(&diff, 2));
            add_printed(&text, &diff, k % 2, k % 3 == 0);
            diff_free(&diff);
        }
        json_decref(old);
        json_decref(new);
        if (k % KEPT_TOGETHER == KEPT_TOGETHER - 1) keep(&kept, "diffs", k / KEPT_TOGETHER, &text);
    }
    digests_close(&kept);
    json_decref(template);
}

/* Of more than 60 differences the first 60 are printed. */
TEST(lines)
{
    for (int count = 60; count < 62; count++) {
        json_t *old = json_pack("{s:s, s:{}}", "command", "run", "errors"),
               *new = json_deep_copy(old);
        struct diff diff;
        struct error error = {0};
        struct buffer text = {0};
        for (int i = 0; i < count; i++) {
            char name[16];
            snprintf(name, sizeof name, "f%02d", i);
            json_object_set_new(json_object_get(old, "errors"), name, json_pack("{s:f}", "l1", 1.));
            json_object_set_new(json_object_get(new, "errors"), name, json_pack("{s:f}", "l1", 2.));
        }
        assert_int_equal(diff_documents(old, new, DIFF_THRESHOLD, &diff, &error),
                         STATUS_CHECK_FAILED);
        assert_int_equal(diff.count, count);
        add_printed(&text, &diff, false, false);
        assert_non_null(strstr(text.data, "errors.f59.l1"));
        assert_null(strstr(text.data, "errors.f60.l1"));
        assert_int_equal(strstr(text.data, "\n... and 1 more ") != NULL, count == 61);
        assert_int_equal(strstr(text.data, "\n... and ") != NULL, count == 61);
        buffer_free(&text);
        diff_free(&diff);
        json_decref(old), json_decref(new);
    }
}

/* Nights of one document that changes gradually; other modes and damaged lines between them. */
TEST(histories)
{
    json_t *template = read_template(test_word(1), "figures.json");
    struct digests kept;
    struct buffer text = {0};
    digests_open(&kept, test_word(1), "histories.txt");
    for (size_t k = 0; k < HISTORIES; k++) {
        static const char *const damage[] = {"\n", "damaged\n", "{\"schema\": \"other\"}\n",
                                             "{\"schema\": \"sphproof-his"};
        struct drawing draw = {k, template};
        struct error error = {0};
        char path[4096];
        snprintf(path, sizeof path, "%s", path_of("nights"));
        remove(path);
        const size_t nights = k % 3 ? 2 + drawn_below(&draw, 12)
                              : k   ? 119 + drawn_below(&draw, 4)
                                    : 0;
        json_t *results = drawn_document(&draw, json_object_get(template, "report")), *history;
        for (size_t i = 0; i < nights; i++) {
            if (!drawn_below(&draw, 3)) {
                json_t *next = changed(&draw, results, "");
                json_decref(results);
                results = next;
            }
            json_object_set_new(results, "mode",
                                json_string(drawn_below(&draw, 6) ? "quick" : "nightly"));
            assert_int_equal(history_append(results, path, &error), STATUS_OK);
            if (drawn_below(&draw, 12)) continue;
            FILE *file = fopen(path, "a");
            fputs(damage[drawn_below(&draw, 4)], file);
            fclose(file);
        }
        assert_int_equal(history_tell(results, path, &history, &error), STATUS_OK);
        add_json(&text, history);
        json_decref(results);
        FILE *file = fopen(path, "r");
        char lines[4096];
        for (size_t n; file && (n = fread(lines, 1, sizeof lines, file));)
            buffer_add_bytes(&text, lines, n);
        if (file) fclose(file);
        keep(&kept, "histories", k, &text);
    }
    digests_close(&kept);
    json_decref(template);
}

/* Levels with scatter, outliers and steps. */
TEST(series)
{
    struct digests kept;
    struct buffer text = {0};
    digests_open(&kept, test_word(1), "series.txt");
    for (size_t k = 0; k < SERIES; k++) {
        struct drawing draw = {k, NULL};
        struct trend_change changes[64];
        double value[64], level = 0;
        const size_t n = drawn_below(&draw, k % 2 ? 12 : 64);
        const double scatter = (double)drawn_below(&draw, 3) / 64;
        for (size_t i = 0; i < n; i++) {
            if (!drawn_below(&draw, 6)) level += (double)drawn_below(&draw, 33) / 16 - 1;
            value[i] = level + scatter * (double)drawn_below(&draw, 9);
            if (!drawn_below(&draw, 15)) value[i] += 1;
        }
        const size_t count = trend_changes(n, value, (double)drawn_below(&draw, 4) / 8, changes);
        for (size_t c = 0; c < count; c++)
            buffer_format(&text, "%zu %.10g %.10g\n", changes[c].at, changes[c].before,
                          changes[c].after);
        buffer_format(&text, "%zu\n", count);
        if (k % 50 == 49) keep(&kept, "series", k / 50, &text);
    }
    digests_close(&kept);
}

/* Parts of the checks, joined in any order of their mutants. */
TEST(joined)
{
    struct digests kept;
    struct buffer text = {0};
    static const char *const names[] = {"a", "b", "c"};
    digests_open(&kept, test_word(1), "joined.txt");
    for (size_t k = 0; k < 20; k++) {
        struct drawing draw = {k, NULL};
        json_t *all = json_object();
        for (size_t parts = drawn_below(&draw, 4); parts > 0; parts--) {
            const int passed = (int)drawn_below(&draw, 5), failed = (int)drawn_below(&draw, 3);
            json_t *part = json_pack("{s:[i], s:[], s:{s:i, s:i}}", "checks", (int)parts, "mutants",
                                     "summary", "passed", passed, "failed", failed);
            for (size_t m = drawn_below(&draw, 4); m > 0; m--) {
                const char *name = names[drawn_below(&draw, 3)];
                const int detected = drawn_below(&draw, 4) > 0;
                json_array_append_new(
                    json_object_get(part, "mutants"),
                    json_pack("{s:s, s:b}", "mutant", name, "detected", detected));
            }
            report_piece_join(all, part);
            json_decref(part);
        }
        add_json(&text, all);
    }
    keep(&kept, "joined", 0, &text);
    digests_close(&kept);
}
