/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the verdict of diff on figures of every kind, in both directions. (test_diff_drawn.c tests
 * totals and parts, and the order of figures.) */
#include "test.h"

#include "sample_diff.h"

/* ---- figures, in both directions ---- */

/* A figure of each kind with a good and a bad value. */
static const struct kind {
    const char *path, *inside, *good, *bad;
    enum metric_verdict worse, better; /* verdict from good to bad, and back */
    bool fault;                        /* a regression */
} kinds[] = {
    {"error", NULL, "1e-3", "2e-3", VERDICT_WORSE, VERDICT_BETTER, true},
    {"error_rms", NULL, "1e-3", "\"nan\"", VERDICT_WORSE, VERDICT_BETTER, true},
    {"error_worst", NULL, "1", "\"inf\"", VERDICT_WORSE, VERDICT_BETTER, true},
    {"order", NULL, "2", "1", VERDICT_WORSE, VERDICT_BETTER, true},
    {"order_fine", NULL, "2", "\"nan\"", VERDICT_WORSE, VERDICT_BETTER, false},
    {"cost.cpu_s", "cost", "1", "4", VERDICT_WORSE, VERDICT_BETTER, false},
    {"cost.wall_s", "cost", "1", "40", VERDICT_WORSE, VERDICT_BETTER, false},
    {"cost.steps", "cost", "100", "200", VERDICT_WORSE, VERDICT_BETTER, false},
    /* a normalisation's noise is its distance from 1, and covers a change towards 1 */
    {"normalisation", NULL, "1", "1.5", VERDICT_WORSE, VERDICT_SAME, false},
    {"p_star", NULL, "1", "2", VERDICT_INCOMPARABLE, VERDICT_INCOMPARABLE, false},
    {"signal", NULL, "1", "\"nan\"", VERDICT_INCOMPARABLE, VERDICT_INCOMPARABLE, false},
    {"regularity.spread", "regularity", "0.1", "0.3", VERDICT_WORSE, VERDICT_BETTER, false},
    {"outcome", NULL, "\"ok\"", "\"wrong\"", VERDICT_WORSE, VERDICT_BETTER, true},
    {"state", NULL, "\"pass\"", "\"none\"", VERDICT_WORSE, VERDICT_BETTER, true},
    {"state", NULL, "\"pass\"", "\"skip\"", VERDICT_WORSE, VERDICT_BETTER, true},
    {"state", NULL, "\"pass\"", "\"smoke\"", VERDICT_WORSE, VERDICT_BETTER, true},
    {"state", NULL, "\"pass\"", "\"diverging\"", VERDICT_WORSE, VERDICT_BETTER, false},
    {"state", NULL, "\"ok\"", "\"none\"", VERDICT_WORSE, VERDICT_BETTER, false},
    {"status", NULL, "\"pass\"", "\"undetermined\"", VERDICT_WORSE, VERDICT_BETTER, true},
    {"same_bits", NULL, "true", "false", VERDICT_WORSE, VERDICT_BETTER, true},
    {"left_wave", NULL, "\"shock\"", "\"rarefaction\"", VERDICT_INCOMPARABLE, VERDICT_INCOMPARABLE,
     false},
    {"suspicion", NULL, "\"\"", "\"too good\"", VERDICT_WORSE, VERDICT_BETTER, true},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

static void add_figure(json_t *document, const struct kind *kind, const char *text)
{
    const char *dot = strrchr(kind->path, '.');
    put(document, kind->inside, dot ? dot + 1 : kind->path, text);
}

/* Each kind alone, for each pair of: missing, null, good, bad. */
TEST(verdict_on_each_kind)
{
    for (size_t f = 0; f < KINDS; f++) {
        const char *const texts[] = {NULL, "null", kinds[f].good, kinds[f].bad};
        for (int i = 0; i < 4; i++)
            for (int k = 0; k < 4; k++) {
                json_t *old = json_pack("{s:s, s:f}", "command", "run", "error_l1", 1.),
                       *new = json_deep_copy(old);
                struct diff diff;
                add_figure(old, &kinds[f], texts[i]);
                add_figure(new, &kinds[f], texts[k]);
                const enum status status = differ(old, new, &diff);
                const struct difference *d = find(&diff, kinds[f].path);
                const bool worse = i == 2 && k == 3;
                const enum metric_verdict verdict = i < 2    ? VERDICT_NEW
                                                    : k < 2  ? VERDICT_VANISHED
                                                    : i == k ? VERDICT_SAME
                                                    : worse  ? kinds[f].worse
                                                             : kinds[f].better;
                assert_int_equal(d == NULL, i < 2 && k < 2);
                if (d) {
                    assert_int_equal(d->verdict, verdict);
                    assert_int_equal(d->regression, worse && kinds[f].fault);
                    assert_int_equal(d->amount > 0, verdict == VERDICT_WORSE);
                    assert_int_equal(diff.verdicts[verdict], verdict == VERDICT_SAME ? 2 : 1);
                }
                assert_int_equal(diff.regressions, worse && kinds[f].fault);
                const bool nan_in_both = i == 3 && k == 3 && strstr(kinds[f].bad, "nan");
                assert_int_equal(diff.compared, i >= 2 && k >= 2 && !nan_in_both ? 2 : 1);
                const bool well = !d || verdict == VERDICT_NEW || verdict == VERDICT_SAME ||
                                  verdict == VERDICT_BETTER ||
                                  (verdict == VERDICT_WORSE && !kinds[f].fault);
                assert_int_equal(diff.well, well);
                assert_int_equal(status, well ? STATUS_OK : STATUS_CHECK_FAILED);
                diff_free(&diff);
                json_decref(old), json_decref(new);
            }
    }
    json_t *none = json_pack("{s:s}", "command", "run");
    struct diff diff;
    assert_int_equal(differ(none, none, &diff), STATUS_CHECK_FAILED);
    assert_string_equal(diff.problem,
                        "nothing was compared: no figure is a number or a word in both documents");
    diff_free(&diff);
    json_decref(none);
    json_t *nans = json_pack("{s:s, s:s}", "command", "run", "error_l1", "nan");
    assert_int_equal(differ(nans, nans, &diff), STATUS_CHECK_FAILED);
    diff_free(&diff);
    json_decref(nans);
}

/* Values exactly at a limit. */
TEST(limits)
{
    static const struct {
        enum metric_kind kind;
        double a, b, noise, other, floor, exact;
        enum metric_verdict verdict;
        double worse; /* by so much */
    } rows[] = {
        {METRIC_ERROR, 1, 0.5, 0, 0, 1, 0, VERDICT_SAME, 0},
        {METRIC_ERROR, 0.5, 1, 0, 0, 1, 0, VERDICT_SAME, 0},
        {METRIC_ERROR, 1, 1.5, 0.5, 0, 0, 0, VERDICT_SAME, 0},
        {METRIC_ERROR, 1, 1.75, 0.5, 0, 0, 0, VERDICT_WORSE, 0.75},
        {METRIC_CHECK, 1, 0.25, 0, 0, 1, 0, VERDICT_SAME, 0},
        {METRIC_CHECK, 1, 0.25, 0, 0, 0.5, 0, VERDICT_BETTER, 0},
        {METRIC_CHECK, 3, 1, 0, 0, 0, 0, VERDICT_SAME, 0},
        {METRIC_CHECK, 1, 3, 0, 0, 0, 0, VERDICT_SAME, 0},
        {METRIC_ERROR, 2, 5, 0.5, 0, 1, 0, VERDICT_WORSE, 1.5},
        {METRIC_ERROR, 0.5, 5, 0.5, 0, 2, 0, VERDICT_WORSE, 1.5},
        {METRIC_CHECK, 2, 7, 0, 0, 0, 0, VERDICT_WORSE, 2.5},
        {METRIC_PART, 2, 3, 0.25, 0, 0, 0, VERDICT_WORSE, 0.5},
        {METRIC_COUNT, 2, 3, 0.25, 0, 0, 0, VERDICT_WORSE, 0.5},
        {METRIC_EXACT, 4, 6, 0.5, 0, 0, 3, VERDICT_WORSE, 2},
        {METRIC_EXACT, 7, 4, 0, 0, 1, 3, VERDICT_SAME, 0},
        {METRIC_EXACT, 7.5, 4, 0, 0, 1, 3, VERDICT_BETTER, 0},
        {METRIC_TIMING, 2, 3, 1.5, 0, 0, 0, VERDICT_WORSE, 1.5},
        {METRIC_TIMING, 3, 2, 1.5, 0, 0, 0, VERDICT_BETTER, 0},
        {METRIC_TIMING, 2, 2.5, 1.5, 0, 0, 0, VERDICT_SAME, 0},
        {METRIC_TIMING, 2.5, 2, 1.5, 0, 0, 0, VERDICT_SAME, 0},
        {METRIC_TIMING, 0.01, 0.029, 1.5, 0, 0, 0, VERDICT_SAME, 0},
        {METRIC_TIMING, 0.01, 0.031, 1.5, 0, 0, 0, VERDICT_WORSE, 0.031 / 0.01},
        {METRIC_ORDER, 2, 1.375, 0.375, 0.5, 0, 0, VERDICT_SAME, 0},
        {METRIC_ORDER, 2, 1.25, 0.375, 0.5, 0, 0, VERDICT_WORSE, 0.75},
        {METRIC_NEUTRAL, -2, -1, 0.5, 0, 0, 0, VERDICT_SAME, 0},
        {METRIC_NEUTRAL, -2, -1, 0, 0, 1, 0, VERDICT_SAME, 0},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        for (int floors = 0; floors < 3; floors++) { /* of either or both */
            const struct metric old = {.kind = rows[k].kind,
                                       .value = rows[k].a,
                                       .noise = rows[k].noise,
                                       .floor = floors == 1 ? 0 : rows[k].floor,
                                       .exact = rows[k].exact};
            struct metric new = old;
            double amount;
            bool fault;
            new.value = rows[k].b, new.noise = rows[k].other;
            new.floor = floors == 2 ? 0 : rows[k].floor;
            if (metric_judge(&old, &new, &amount, &fault) != rows[k].verdict ||
                amount != rows[k].worse)
                fail_msg("row %zu: worse by %g", k, amount);
        }
    }
    /* among equal verdicts a word is worse than a number */
    const struct metric number = {.kind = METRIC_PART, .value = 1},
                        word = {.path = "status", .word = "pass"};
    assert_true(metric_worse(&word, &number) && !metric_worse(&number, &word));
    const struct metric nan = {.kind = METRIC_PART, .value = NAN};
    assert_true(metric_worse(&nan, &number) && !metric_worse(&number, &nan));
    assert_false(metric_worse(&nan, &nan));
}

/* Words by rising severity; those of a row are equal. */
TEST(severity_of_words)
{
    static const char *const rows[][8] = {
        {"", "pass", "ok", "true", "asymptotic"},
        {"none", "skip", "oscillating", "floor-limited", "pre-asymptotic", "smoke", "undetermined"},
        {"diverging"},
        {"fail", "false"},
        {"inaccurate"},
        {"broke_down"},
        {"wrong"}};
    enum { ROWS = sizeof rows / sizeof *rows };
    for (size_t a = 0; a < 8 * ROWS; a++)
        for (size_t b = 0; b < 8 * ROWS; b++) {
            const char *const words[] = {rows[a / 8][a % 8], rows[b / 8][b % 8]};
            if (!words[0] || !words[1]) continue;
            const struct metric one = {.path = "outcome", .word = (char *)words[0]},
                                other = {.path = "outcome", .word = (char *)words[1]};
            double amount;
            bool fault;
            assert_int_equal(metric_worse(&one, &other), a / 8 > b / 8);
            assert_int_equal(metric_judge(&one, &other, &amount, &fault),
                             a / 8 == b / 8  ? VERDICT_SAME
                             : a / 8 > b / 8 ? VERDICT_BETTER
                                             : VERDICT_WORSE);
        }
}

/* Errors are not below 0, other figures may be. */
TEST(negative_figures)
{
    static const struct {
        const char *inside, *name;
        bool refused;
    } rows[] = {{"errors", "l1", true},    {"conservation", "energy", true},
                {NULL, "error_rms", true}, {NULL, "order", false},
                {NULL, "p_star", false},   {NULL, "normalisation", false}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int of = 0; of < 4; of++) {
            json_t *documents[] = {run_with(1e-3, 1), run_with(1e-3, 1)};
            struct diff diff;
            for (int i = 0; i < 2; i++)
                put(documents[i], rows[k].inside, rows[k].name, of & (1 << i) ? "-1e-30" : "0");
            assert_int_equal(differ(documents[0], documents[1], &diff) == STATUS_BAD_INPUT,
                             of && rows[k].refused);
            diff_free(&diff);
            json_decref(documents[0]), json_decref(documents[1]);
        }
}

/* ---- names ---- */

/* A document with a list `key` of one entry whose name has this many characters. */
static json_t *called(const char *key, int letters, const char *command)
{
    char name[1000];
    snprintf(name, sizeof name, "%0*d", letters, 0);
    return json_pack("{s:s, s:f, s:[{s:s, s:s, s:f}, {s:s, s:s, s:f}]}", "command", "run",
                     "error_l1", 1., key, "label", name, "reproduce", command, "error", 2., "label",
                     "b", "reproduce", "b", "error", 3.);
}

/* Compares a document with itself; it is refused with this message, or NULL. */
static void read_or_refused(json_t *document, const char *message)
{
    struct diff diff;
    struct error error = {0};
    json_t *same = json_deep_copy(document);
    const enum status status = diff_documents(document, same, 0, &diff, &error);
    if (status != (message ? STATUS_BAD_INPUT : STATUS_OK) ||
        strcmp(error.message, message ? message : "") != 0)
        fail_msg("%s", error.message);
    diff_free(&diff);
    json_decref(document), json_decref(same);
}

/* An entry of a list is identified by its name, of at most 898 characters, and an object by its
 * path. */
TEST(names)
{
    struct diff diff;
    for (int more = 0; more < 2; more++) {
        json_t *old, *new;
        read_or_refused(called("errors", 898 + more, "a"),
                        more ? "old document: errors: an entry whose name is too long" : NULL);
        /* two names, of which the first fills the field */
        for (int letters = 895; letters < 900; letters++) {
            old = called("errors", letters, "a"), new = json_deep_copy(old);
            json_object_set_new(json_array_get(json_object_get(new, "errors"), 0), "name",
                                json_string("x"));
            assert_int_equal(differ(old, new, &diff),
                             letters > 895 ? STATUS_BAD_INPUT : STATUS_CHECK_FAILED);
            diff_free(&diff);
            json_decref(old), json_decref(new);
        }
        /* a path of 1535 characters and more, of an object or of an entry of a list */
        for (int listed = 0; listed < 2; listed++) {
            char key[120], message[200];
            old = json_pack("{s:s, s:f, s:{}}", "command", "run", "error_l1", 1., "e");
            json_t *inside = json_object_get(old, "e");
            for (int level = 0; level < 16 - listed; level++) {
                snprintf(key, sizeof key, "%0*d", level ? 101 : 18 + more, level);
                json_object_set_new(inside, key, json_pack("{s:f}", "error", 1.));
                inside = json_object_get(inside, key);
            }
            if (listed) {
                snprintf(key, sizeof key, "%080d", 0);
                json_object_set_new(
                    inside, key,
                    json_pack("[{s:s, s:f}]", "label", "a name of 17 signs", "error", 1.));
            }
            snprintf(message, sizeof message, "old document: %s: %s", key,
                     listed ? "an entry whose name is too long" : "a name that is too long");
            read_or_refused(old, more ? message : NULL);
        }
    }
    /* entries of skips and autopsies of the same case are identified by the command that computes
     * them */
    static const char *const keys[] = {"skips", "autopsies", "errors"};
    for (int k = 0; k < 3; k++) {
        char path[64];
        json_t *old = called(keys[k], 1, "run sod"), *new = json_deep_copy(old);
        assert_int_equal(differ(old, new, &diff), STATUS_OK);
        snprintf(path, sizeof path, "%s[0%s].error", keys[k], k < 2 ? ", run sod" : "");
        assert_non_null(find(&diff, path));
        diff_free(&diff);
        json_decref(old), json_decref(new);
    }
}

/* Snapshots of one run have the same number of particles: they are told apart by their times, in
 * any order. */
TEST(snapshots_of_one_run)
{
    json_t *old = json_pack("{s:s, s:[{s:i, s:f, s:f}, {s:i, s:f, s:f}]}", "command", "judge",
                            "snapshots", "n", 400, "time", 0.5, "error", 2., "n", 400, "time", 0.25,
                            "error", 1.),
           *new = json_pack("{s:s, s:[{s:i, s:f, s:f}, {s:i, s:f, s:f}]}", "command", "judge",
                            "snapshots", "n", 400, "time", 0.25, "error", 1.5, "n", 400, "time",
                            0.5, "error", 2.);
    struct diff diff;
    assert_int_equal(differ(old, new, &diff), STATUS_CHECK_FAILED);
    assert_int_equal(diff.count, 2);
    assert_int_equal(find(&diff, "snapshots[n 400, time 0.25].error")->verdict, VERDICT_WORSE);
    assert_int_equal(find(&diff, "snapshots[n 400, time 0.5].error")->verdict, VERDICT_SAME);
    diff_free(&diff);
    json_decref(old), json_decref(new);
}

/* Settings are part of a name, if they are words, at most 64. */
TEST(settings_in_names)
{
    for (int most = 1; most <= 65; most += most < 64 ? 63 : 1)
        for (int number = 0; number < 2; number++) {
            json_t *settings = json_object();
            for (int k = 0; k < most; k++) {
                char key[16];
                snprintf(key, sizeof key, "k%02d", 99 - k);
                json_object_set_new(settings, key,
                                    number && k == most - 1 ? json_integer(1) : json_string("v"));
            }
            json_t *document = json_pack("{s:s, s:[{s:s, s:f, s:o}]}", "command", "run", "errors",
                                         "label", "a", "error", 2., "settings", settings);
            struct diff diff;
            assert_int_equal(differ(document, document, &diff), STATUS_OK);
            const char *path = diff.list[0].new->path;
            const bool named = !number && most <= 64;
            assert_int_equal(strstr(path, "k99=v") != NULL, named);
            if (named && most == 64) assert_non_null(strstr(path, "errors[a, k36=v, k37=v, "));
            diff_free(&diff);
            json_decref(document);
        }
}

/* Figures are left out of the object of a breakdown, and not of one whose name begins likewise. */
TEST(figures_of_a_breakdown)
{
    json_t *old = json_pack("{s:s, s:{s:s, s:f}, s:{s:f}}", "command", "run", "part", "outcome",
                            "ok", "error", 1., "parts", "error", 1.),
           *new = json_pack("{s:s, s:{s:s, s:f}, s:{s:f}}", "command", "run", "part", "outcome",
                            "broke_down", "error", 2., "parts", "error", 2.);
    struct diff diff;
    assert_int_equal(differ(old, new, &diff), STATUS_CHECK_FAILED);
    assert_int_equal(diff.left_out, 1);
    assert_int_equal(diff.count, 2);
    assert_non_null(find(&diff, "parts.error"));
    diff_free(&diff);
    json_decref(old), json_decref(new);
}

/* Each breakdown counts, whatever became of the figures that were left out, be it the first figure
 * or the last. */
TEST(two_breakdowns)
{
    json_t *old = json_pack("{s:s, s:{s:s, s:f}, s:{s:s, s:f}}", "command", "run", "a", "outcome",
                            "ok", "steps", 1., "b", "outcome", "ok", "error", 1.),
           *new = json_pack("{s:s, s:{s:s, s:f}, s:{s:s, s:f}}", "command", "run", "a", "outcome",
                            "broke_down", "steps", 2., "b", "outcome", "broke_down", "error", 2.);
    struct diff diff;
    assert_int_equal(differ(old, new, &diff), STATUS_CHECK_FAILED);
    assert_int_equal(diff.left_out, 2);
    assert_int_equal(diff.regressions, 2);
    diff_free(&diff);
    json_decref(old), json_decref(new);
}

/* ---- totals and parts ---- */

/* A total that fails because its part fails is not a regression of its own, be it the first figure
 * or the last; one that fails alone is. */
TEST(totals_and_parts)
{
    static const char *const wholes[] = {"outcome", "status"}, *const parts[] = {"studies", "runs"};
    for (int w = 0; w < 2; w++)
        for (int p = 0; p < 2; p++)
            for (int fails = 0; fails < 2; fails++) {
                json_t *old = json_pack("{s:s, s:s, s:[{s:s, s:s}]}", "command", "run", wholes[w],
                                        "ok", parts[p], "label", "a", "outcome", "ok"),
                       *new = json_pack("{s:s, s:s, s:[{s:s, s:s}]}", "command", "run", wholes[w],
                                        "fail", parts[p], "label", "a", "outcome",
                                        fails ? "wrong" : "ok");
                struct diff diff;
                char part[64];
                snprintf(part, sizeof part, "%s[a].outcome", parts[p]);
                assert_int_equal(differ(old, new, &diff), STATUS_CHECK_FAILED);
                assert_int_equal(diff.regressions, 1);
                assert_int_equal(find(&diff, wholes[w])->regression, !fails);
                assert_int_equal(find(&diff, part)->regression, fails);
                diff_free(&diff);
                json_decref(old), json_decref(new);
            }
}

/* A failed check names the cause: the one with the lower rank comes first. */
TEST(rank_of_checks)
{
    for (int first = 1; first < 3; first++) {
        json_t *old = json_pack("{s:s, s:[{s:s, s:i, s:s}, {s:s, s:i, s:s}]}", "command", "verify",
                                "checks", "check", "a", "rank", first, "status", "pass", "check",
                                "b", "rank", 3 - first, "status", "pass"),
               *new = json_deep_copy(old), *check;
        struct diff diff;
        size_t i;
        json_array_foreach(json_object_get(new, "checks"), i, check)
            json_object_set_new(check, "status", json_string("fail"));
        assert_int_equal(differ(old, new, &diff), STATUS_CHECK_FAILED);
        assert_int_equal(diff.regressions, 2);
        assert_string_equal(diff.list[0].any->path,
                            first == 1 ? "checks[a].status" : "checks[b].status");
        diff_free(&diff);
        json_decref(old), json_decref(new);
    }
}

/* An error is a regression if it rises by more than the threshold. */
TEST(threshold_of_errors)
{
    for (int more = 0; more < 2; more++) {
        json_t *old = json_pack("{s:s, s:f}", "command", "run", "error_l1", 1.),
               *new = json_pack("{s:s, s:f}", "command", "run", "error_l1", more ? 1.501 : 1.5);
        struct diff diff;
        struct error error = {0};
        assert_int_equal(diff_documents(old, new, 0.5, &diff, &error),
                         more ? STATUS_CHECK_FAILED : STATUS_OK);
        assert_int_equal(diff.verdicts[VERDICT_WORSE], 1);
        assert_int_equal(diff.regressions, more);
        diff_free(&diff);
        json_decref(old), json_decref(new);
    }
}

/* A number in the place of a word is no figure. */
TEST(numbers_for_words)
{
    json_t *old = json_pack("{s:s, s:f, s:i}", "command", "run", "error_l1", 1., "outcome", 5);
    struct diff diff;
    assert_int_equal(differ(old, old, &diff), STATUS_OK);
    assert_int_equal(diff.count, 1);
    diff_free(&diff);
    json_decref(old);
}
