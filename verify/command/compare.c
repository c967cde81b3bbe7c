/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof compare: two schemes, or results, side by side on one case, with the scatter of draws.
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "command.h"
#include "judge.h"
#include "list.h"
#include "output.h"
#include "page.h"
#include "paired.h"
#include "problem_list.h"
#include "progress.h"
#include "result.h"
#include "run_output.h"
#include "study.h"
#include "table.h"
#include "text.h"

enum { WORDS_MAX = 64, FIGURES_MAX = FIELDS + PROBLEM_FUNCTIONALS_MAX, DRAWS = 5, TIMED_DRAWS = 4 };
#define LEVEL 0.05 /* of all figures together */

struct side {
    const char *name; /* "a", "b" */
    const char *text; /* the argument */
    bool is_snapshot;
    struct run_settings asked; /* of runs */
    struct run first;          /* of the first draw, or of the snapshot */
    char *figures[FIGURES_MAX];
    double error[FIGURES_MAX][STUDY_REPLICATES_MAX], cpu_s[STUDY_REPLICATES_MAX];
    size_t n[STUDY_REPLICATES_MAX], count; /* particles of each draw; figures */
    json_t *result;                        /* of the first draw, for pages */
};

struct comparison {
    struct side sides[2];
    size_t asked, draws; /* requested draws; those that differ in their particles */
    struct paired of[FIGURES_MAX];
    double cpu, cpu_low, cpu_high; /* b over a: median, least, most; NaN: a side is a snapshot */
    char verdict[1024];
};

/* ---- arguments ---- */

/* Splits at blanks outside quotes; the words lie in text. False: an open quote, or more than
 * WORDS_MAX words. */
static bool split(char *text, char *words[WORDS_MAX], int *count)
{
    char *to = text, quote = 0;
    *count = 0;
    for (char *from = text; *from;) {
        while (*from == ' ') from++;
        if (!*from) break;
        if (*count == WORDS_MAX) return false;
        words[(*count)++] = to;
        for (; *from && (quote || *from != ' '); from++) {
            if (quote ? *from == quote : *from == '"' || *from == '\'')
                quote = quote ? 0 : *from;
            else
                *to++ = *from;
        }
        const bool more = *from != '\0';
        *to++ = '\0';
        from += more;
    }
    return !quote;
}

static bool is_file(const char *text)
{
    struct stat of;
    return stat(text, &of) == 0 && S_ISREG(of.st_mode) && !text_ends(text, ".ini");
}

static enum status take_side(struct side *side, int threads, struct error *error)
{
    char *words[WORDS_MAX], *text = strdup(side->text);
    int count;
    enum status status = STATUS_OK;
    side->is_snapshot = is_file(side->text);
    if (!text)
        status = error_set(error, STATUS_ENVIRONMENT, "no memory for arguments");
    else if (side->is_snapshot)
        ;
    else if (!split(text, words, &count) || count < 1)
        status = error_set(error, STATUS_BAD_INPUT,
                           "compare: %s, '%.200s': allowed: \"CASE [KEY=VALUE ...]\" of at most %d "
                           "words with quotes in pairs, or the path of a snapshot",
                           side->name, side->text, WORDS_MAX);
    else if (!run_prepare(&side->asked, words[0], count - 1, words + 1, error)) {
        side->asked.threads = threads;
        status = run_resolve(&side->first, &side->asked, error);
    } else
        status = error->status;
    free(text);
    return status;
}

/* Keys that define the problem, besides a problem's own; the others are compared. */
static const enum setting problem_keys[] = {
    SETTING_kind,   SETTING_gamma,         SETTING_t_end, SETTING_lo,      SETTING_hi,
    SETTING_window, SETTING_window_radius, SETTING_boost, SETTING_gravity, SETTING_boundary};

static enum status differ(const struct comparison *c, enum setting key, struct error *error)
{
    char text[2][SETTING_TEXT_MAX];
    for (int s = 0; s < 2; s++) settings_text(&c->sides[s].first.settings, key, text[s]);
    if (strcmp(text[0], text[1]) == 0) return STATUS_OK;
    const double x = settings_real(&c->sides[0].first.settings, key),
                 y = settings_real(&c->sides[1].first.settings, key);
    const bool by_file = c->sides[0].is_snapshot || c->sides[1].is_snapshot;
    if (by_file && key != SETTING_gamma && key != SETTING_t_end) return STATUS_OK;
    if (by_file && fabs(x - y) <= 1e-6 * fabs(x)) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "compare: a has %s=%.80s, b has %s=%.80s: two problems, whose errors say "
                     "nothing about each other; allowed: the same on both sides",
                     setting_keys[key].name, text[0], setting_keys[key].name, text[1]);
}

static enum status check_problem(const struct comparison *c, struct error *error)
{
    const struct run *a = &c->sides[0].first, *b = &c->sides[1].first;
    if (strcmp(a->asked.file.name, b->asked.file.name) != 0 ||
        a->asked.file.dimension != b->asked.file.dimension)
        return error_set(error, STATUS_BAD_INPUT,
                         "compare: a is of the case %s in %dD, b of %s in %dD; allowed: the same "
                         "case on both sides",
                         a->asked.file.name, a->asked.file.dimension, b->asked.file.name,
                         b->asked.file.dimension);
    const struct problem *problem = problem_of(&a->settings);
    for (size_t k = 0; k < problem->key_count; k++)
        if (problem->keys[k].role != ROLE_PARTICLES && differ(c, problem->keys[k].key, error))
            return error->status;
    for (size_t k = 0; k < sizeof problem_keys / sizeof *problem_keys; k++)
        if (differ(c, problem_keys[k], error)) return error->status;
    return STATUS_OK;
}

/* ---- draws ---- */

/* Least difference of n between draws in 1D: at small n errors of a tube oscillate with n, with a
 * period of about eight particles. */
enum { APART = 4 };

/* Resolves draw r: another seed for a random start, else another number of particles
 * (study_neighbour). */
static enum status draw(const struct side *side, size_t r, size_t draws, struct run *run,
                        struct error *error)
{
    struct run_settings asked = side->asked;
    const struct settings *settings = &side->first.settings;
    const bool random = settings_random_start(settings);
    const enum setting key = random ? SETTING_seed : SETTING_n;
    const int dim = side->asked.file.dimension;
    double value = settings_real(settings, key);
    char text[32];
    value =
        random ? value + (double)r : (double)study_neighbour((size_t)value, dim, draws, APART, r);
    snprintf(text, sizeof text, "%.0f", value);
    if (r && settings_set(&asked.settings, key, text, SOURCE_USER, NULL, error))
        return error->status;
    return run_resolve(run, &asked, error);
}

static json_t *result_json(const struct side *side, const struct run_result *r)
{
    return result_object("label=%s n=%zu time=%g errors=%p functionals=%p profile=%p", side->name,
                         r->n, r->time, (void *)run_errors_json(r), (void *)run_functionals_json(r),
                         (void *)profile_json(r));
}

/* Errors of the fields, or of functionals if no field has an exact solution. */
static enum status read_figures(struct side *side, const struct run_result *r, size_t draw,
                                struct error *error)
{
    side->count = 0;
    for (int f = 0; f < FIELDS; f++) {
        if (!problem_knows(r->problem.problem, (enum field)f)) continue;
        side->figures[side->count] = (char *)field_family.members[f]->name;
        side->error[side->count++][draw] = r->errors[f].l1;
    }
    for (size_t k = 0; k < r->functional_count && r->problem.problem->fieldless; k++) {
        if (!isfinite(r->functionals[k].exact)) continue;
        side->figures[side->count] = (char *)r->functionals[k].name;
        side->error[side->count++][draw] = fabs(r->functionals[k].value - r->functionals[k].exact);
    }
    side->n[draw] = r->n;
    side->cpu_s[draw] = side->is_snapshot ? (double)NAN : r->cost.cpu_s;
    if (draw == 0) side->result = result_json(side, r);
    if (!side->count)
        return error_set(error, STATUS_BAD_INPUT, "compare: nothing of the case %s is exact",
                         side->first.asked.file.name);
    return STATUS_OK;
}

/* Runs draw r of `draws` and stores it as the side's draw `to`. */
static enum status one_run(struct side *side, size_t r, size_t draws, size_t to,
                           struct error *error)
{
    struct run run;
    struct run_result result;
    struct error reason = {0};
    if (draw(side, r, draws, &run, error)) return error->status;
    enum status status = run_execute(&run, &result, &reason);
    if (status && status != STATUS_BROKE_DOWN)
        return error_set(error, status, "%.480s", reason.message);
    if (status)
        error_set(error, status, "%s, '%.160s', n=%zu: %.280s", side->name, side->text, result.n,
                  result.message);
    else
        status = read_figures(side, &result, to, error);
    run_free(&result);
    return status;
}

/* Judges a snapshot; if the other side is a run, as a snapshot of its case. */
static enum status one_snapshot(struct side *side, const struct side *other, bool allow_far,
                                struct error *error)
{
    struct judged judged;
    const struct judge_request request = {.case_name =
                                              other->is_snapshot ? NULL : other->asked.file.asked,
                                          .kernel = -1,
                                          .allow_far = allow_far};
    enum status status = judge_snapshot(side->text, &request, &judged, error);
    if (!status && !judged.passes)
        status =
            error_set(error, STATUS_CHECK_FAILED, "%.200s: %.280s", side->text, judged.verdict);
    if (!status) {
        side->first = judged.run;
        for (size_t r = 0; r < STUDY_REPLICATES_MAX && !status; r++)
            status = read_figures(side, &judged.result, r, error);
    }
    judge_free(&judged);
    return status;
}

/* True if an earlier draw has the same particles, so that both count as one draw: two snapshots
 * always do, and lattices for two numbers of particles may. */
static bool seen(const struct comparison *c, size_t r)
{
    for (int s = 0; s < 2; s++)
        if (!c->sides[s].is_snapshot && settings_random_start(&c->sides[s].first.settings))
            return false;
    for (size_t k = 0; k < r; k++)
        if (c->sides[0].n[k] == c->sides[0].n[r] && c->sides[1].n[k] == c->sides[1].n[r])
            return true;
    return false;
}

static enum status draw_all(struct comparison *c, const struct options *options,
                            struct error *error)
{
    struct progress progress;
    enum status status = STATUS_OK;
    double done = 0;
    for (int s = 0; s < 2 && !status; s++) {
        struct side *side = &c->sides[s];
        if (side->is_snapshot)
            status = one_snapshot(side, &c->sides[!s], options_value(options, "allow-far"), error);
    }
    if (!status) status = check_problem(c, error);
    progress_begin(&progress, "compare", options->quiet);
    for (size_t r = 0; r < c->asked && !status; r++) {
        for (int s = 0; s < 2 && !status; s++) {
            struct side *side = &c->sides[s];
            if (!side->is_snapshot) status = one_run(side, r, c->asked, c->draws, error);
            progress_update(&progress, ++done, 2 * (double)c->asked);
        }
        if (!status && !seen(c, c->draws)) c->draws++;
    }
    progress_end(&progress);
    return status;
}

/* ---- verdict ---- */

static void say(char *text, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
static void say(char *text, size_t size, const char *format, ...)
{
    const size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, size - used, format, arguments);
    va_end(arguments);
}

/* "12 % (9 to 15 %)": the change and its interval, with as many digits as that leaves. */
static void say_change(char *text, size_t size, const struct paired *of, bool sign)
{
    const double ratio = 1 + of->change, half = of->half / ratio; /* of its logarithm */
    const bool turned = !sign && of->change < 0;
    const double percent = turned ? -100 : 100;
    const double step = isnan(half) ? fabs(10 * of->change) : 100 * of->half;
    const int places = step > 0 ? (int)fmax(0, fmin(6, ceil(1 - log10(step)))) : 0;
    const char *format = sign ? "%+.*f" : "%.*f";
    const double low = percent * (ratio * exp(turned ? half : -half) - 1),
                 high = percent * (ratio * exp(turned ? -half : half) - 1);
    say(text, size, format, places, percent * of->change);
    say(text, size, " %%");
    if (isnan(half)) return;
    say(text, size, " (");
    say(text, size, format, places, low);
    say(text, size, " to ");
    say(text, size, format, places, high);
    say(text, size, " %%)");
}

static void conclude(struct comparison *c)
{
    static const char *const open[] = {
        [PAIRED_NONE] = "no difference can be told in ",
        [PAIRED_BETTER] = "b is better in ",
        [PAIRED_WORSE] = "b is worse in ",
        [PAIRED_UNKNOWN] = "a single draw does not tell how much of the difference is chance: "};
    static const enum paired_verdict order[] = {PAIRED_BETTER, PAIRED_WORSE, PAIRED_UNKNOWN,
                                                PAIRED_NONE};
    const bool single = c->sides[0].is_snapshot != c->sides[1].is_snapshot;
    double ratio[STUDY_REPLICATES_MAX];
    char *text = c->verdict;
    const size_t size = sizeof c->verdict, count = c->sides[0].count;
    for (size_t k = 0; k < FIGURES_MAX; k++) /* of figures that there are not: no draws */
        c->of[k] = paired_compare(c->draws, c->sides[0].error[k], c->sides[1].error[k], single,
                                  LEVEL / (double)count);
    bool timed = true; /* a coarse clock may measure 0 */
    for (size_t r = 0; r < c->draws; r++) {
        ratio[r] = c->sides[1].cpu_s[r] / c->sides[0].cpu_s[r];
        timed = timed && isfinite(ratio[r]);
    }
    list_sort(ratio, c->draws);
    c->cpu = timed ? 0.5 * (ratio[(c->draws - 1) / 2] + ratio[c->draws / 2]) : (double)NAN;
    c->cpu_low = timed ? ratio[0] : (double)NAN;
    c->cpu_high = timed ? ratio[c->draws - 1] : (double)NAN;
    for (size_t v = 0; v < PAIRED_VERDICTS; v++) {
        size_t said = 0;
        for (size_t k = 0; k < FIGURES_MAX; k++) {
            if (!c->of[k].n || c->of[k].verdict != order[v]) continue;
            say(text, size, "%s", said ? ", " : *text ? "; " : "");
            say(text, size, "%s%s", said++ ? "" : open[order[v]], c->sides[0].figures[k]);
            if (order[v] == PAIRED_NONE) continue;
            say(text, size, order[v] == PAIRED_UNKNOWN ? " %s by " : " by ",
                c->of[k].change < 0 ? "less" : "more");
            say_change(text, size, &c->of[k], false);
        }
    }
    say(text, size, " (%zu draw%s)", c->draws, c->draws == 1 ? "" : "s");
    if (c->draws >= TIMED_DRAWS && (c->cpu_low > 1 || c->cpu_high < 1))
        say(text, size, "; b takes %.2g times the CPU time (%.2g to %.2g)", c->cpu, c->cpu_low,
            c->cpu_high);
}

static json_t *side_json(const struct side *side, bool pictures)
{
    json_t *run = json_copy(side->result);
    if (run && !pictures) json_object_del(run, "profile");
    return result_object("name=%s of=%s kind=%s settings=%p first=%p", side->name, side->text,
                         side->is_snapshot ? "snapshot" : "runs",
                         (void *)settings_json(&side->first.settings), (void *)run);
}

static json_t *compare_json(const struct comparison *c, bool pictures)
{
    json_t *document = result_new("compare"), *figures = json_array(), *sides = json_array();
    for (int s = 0; s < 2; s++) json_array_append_new(sides, side_json(&c->sides[s], pictures));
    for (size_t k = 0; k < c->sides[0].count; k++) {
        const struct paired *of = &c->of[k];
        json_array_append_new(
            figures, result_object("name=%s a=%g b=%g change=%g half=%g? draws=%zu verdict=%s",
                                   c->sides[0].figures[k], of->a, of->b, of->change, of->half,
                                   of->n, paired_verdicts[of->verdict]));
    }
    result_add(document, "case=%s dim=%d draws=%zu sides=%p comparisons=%p cpu=%p",
               c->sides[0].first.asked.file.name, c->sides[0].first.asked.file.dimension, c->draws,
               (void *)sides, (void *)figures,
               (void *)(isnan(c->cpu) ? json_null()
                                      : result_object("ratio=%g low=%g high=%g", c->cpu, c->cpu_low,
                                                      c->cpu_high)));
    result_add(document, "verdict=%s", c->verdict);
    return document;
}

static void print_all(const struct comparison *c, const struct options *options)
{
    const struct table_style style = table_style(options->color);
    for (int s = 0; s < 2; s++)
        printf("%s%s%s  %s, n=%zu\n", style.bold, c->sides[s].name, style.end, c->sides[s].text,
               c->sides[s].n[0]);
    printf("\n%s%-18s %12s %12s %32s  %s%s\n", style.bold, "error", "a", "b", "b/a - 1", "b is",
           style.end);
    for (size_t k = 0; k < FIGURES_MAX; k++) {
        const struct paired *of = &c->of[k];
        char change[64] = "";
        if (!of->n) continue;
        say_change(change, sizeof change, of, true);
        printf("%-18s %12.4e %12.4e %32s  %s%s%s\n", c->sides[0].figures[k], of->a, of->b, change,
               of->verdict == PAIRED_BETTER  ? style.good
               : of->verdict == PAIRED_WORSE ? style.bad
                                             : style.faint,
               of->verdict == PAIRED_NONE ? "not told apart" : paired_verdicts[of->verdict],
               style.end);
    }
    printf(
        "%sgeometric means, of fields L1, of values |found - exact|; the intervals hold all of the "
        "changes with 95 %% (Student, pairs of draws)%s\n",
        style.faint, style.end);
    if (!isnan(c->cpu))
        printf("%-18s b/a = %.3g (%.3g to %.3g)\n", "CPU time", c->cpu, c->cpu_low, c->cpu_high);
    else if (!c->sides[0].is_snapshot && !c->sides[1].is_snapshot)
        printf("%-18s too short for this clock\n", "CPU time");
    printf("\n%s", style.bold);
    table_wrap("", c->verdict);
    printf("%s", style.end);
}

static enum status write_page(const char *path, const struct comparison *c, struct error *error)
{
    struct page page = {0};
    json_t *document = compare_json(c, true);
    const bool made = document && page_make_compare(&page, document);
    json_decref(document);
    if (!made) return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
    const enum status status = output_text(path, page.html, error);
    page_free(&page);
    return status;
}

static enum status tell(const struct options *options, const struct comparison *c,
                        struct error *error)
{
    const char *html = options_value(options, "html");
    enum status status = STATUS_OK;
    if (options->speak) print_all(c, options);
    if (options->json) status = options_write(options, compare_json(c, false), error);
    return status || !html ? status : write_page(html, c, error);
}

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    double draws = DRAWS;
    const char *text = options_value(options, "draws"), *html = options_value(options, "html");
    if (n != 2)
        return command_usage(options, error, "two sides are needed, each in quotes, not %d", n);
    if (options_number(options, "draws", true, 1, STUDY_REPLICATES_MAX, &draws, error))
        return error->status;
    struct comparison *c = calloc(1, sizeof *c);
    if (!c) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    enum status status = html ? output_probe(html, error) : STATUS_OK;
    c->asked = (size_t)draws;
    for (int s = 0; s < 2 && !status; s++) {
        c->sides[s].name = s ? "b" : "a", c->sides[s].text = arguments[s];
        status = take_side(&c->sides[s], options->threads, error);
    }
    if (!status && text && c->sides[0].is_snapshot && c->sides[1].is_snapshot)
        status = error_set(error, STATUS_BAD_INPUT,
                           "compare: --draws is for runs: of two snapshots there is one draw each");
    if (!status) status = draw_all(c, options, error);
    if (!status) {
        conclude(c);
        status = tell(options, c, error);
    }
    for (int s = 0; s < 2; s++) json_decref(c->sides[s].result);
    free(c);
    return status;
}

static const struct command_option own_options[] = {
    {"draws", "N",
     "runs of each side (default 5): other seeds of a random start, else other n within 2.5 % and "
     "at least 4 apart, or lattices with one more, one less ... along each side; both sides draw "
     "alike"},
    {"allow-far", NULL, "take also a snapshot that is far from the solution"},
    {"html", "F.html", "write a page: verdict, table, both over the exact solution or as maps"},
    {NULL, NULL, NULL},
};

const struct command command_compare = {
    .name = "compare",
    .synopsis = "\"CASE [KEY=VALUE ...]\"|SNAPSHOT \"CASE [KEY=VALUE ...]\"|SNAPSHOT",
    .help = "two schemes, or snapshots, of one case side by side, with scatter and one "
            "verdict\nEach side is the words of a run in quotes, or a snapshot of any code as for "
            "`sphproof judge`.\nRuns are drawn several times, both sides alike; errors are "
            "compared draw by draw, and what\nis within their scatter is no difference. A snapshot "
            "is a single draw: beside runs\nit is assumed to scatter as they do, beside another "
            "snapshot chance cannot be estimated.\nExit status 0 whoever is better; 1: a snapshot "
            "is far from the solution; 3: a run broke down.",
    .run = run,
    .options = own_options,
    .examples = "sphproof compare \"sod n=400\" \"sod n=400 kernel=wendland_c4 gradient=ia\"\n"
                "sphproof compare \"gresho n=32^2\" \"gresho n=32^2 viscosity=constant\" --draws 9 "
                "--html F.html\n"
                "sphproof compare theirs.hdf5 \"sod n=400\"",
};
