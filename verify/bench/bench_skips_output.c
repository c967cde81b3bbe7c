/* SPDX-License-Identifier: GPL-3.0-or-later
 * Savings of skipped work as a table and as JSON. */
#include <math.h>
#include <stdio.h>

#include "bench_loops.h"
#include "bench_skips.h"
#include "result.h"

static const char *const promises[] = {
#define PROMISE(name, text) text,
    BENCH_PROMISE_LIST(PROMISE)
#undef PROMISE
};

/* Rows of time, columns along x. */
static json_t *map_json(const struct bench_shares *shares)
{
    json_t *map = json_array();
    for (int row = 0; row < BENCH_ROWS; row++) {
        json_t *values = json_array();
        for (int c = 0; c < shares->columns; c++)
            json_array_append_new(
                values, result_number_or_null(round(1000 * shares->asleep[row][c]) / 1000));
        json_array_append_new(map, values);
    }
    return map;
}

/* Errors and conservation without the work and with it. */
static void add_drift(json_t *entry, const struct bench_skip *skip)
{
    const struct {
        const char *name;
        const double *of;
    } pairs[] = {{"error", skip->error}, {"momentum", skip->momentum}, {"energy", skip->energy}};
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++)
        json_object_set_new(entry, pairs[k].name,
                            json_pack("[o, o]", result_number_or_null(pairs[k].of[BENCH_WITHOUT]),
                                      result_number_or_null(pairs[k].of[BENCH_WITH])));
    json_object_set_new(entry, "measured",
                        skip->measured ? json_string(skip->measured) : json_null());
}

void bench_skips_add_json(const struct bench_skips *result, bool maps, json_t *document)
{
    json_t *list = json_array();
    for (size_t s = 0; s < result->count; s++) {
        const struct bench_skip *skip = &result->skips[s];
        const struct bench_shares *shares = skip->shares;
        json_array_append_new(
            list, result_object(
                      "case=%s n=%zu skip=%s against=%s cpu_s=%g cpu_s_without_skip=%g saves=%g "
                      "spread=%g skipped_fraction=%g? possible_fraction=%g? "
                      "without_viscosity_fraction=%g? without_slope_fraction=%g? promise=%s "
                      "difference=%g? bound=%p status=%s",
                      result->cases[skip->case_index].file.name, result->n[skip->case_index],
                      skip->name, skip->keys, skip->cpu_s[BENCH_WITHOUT], skip->cpu_s[BENCH_WITH],
                      skip->cpu_s[BENCH_WITH] / skip->cpu_s[BENCH_WITHOUT], skip->spread,
                      shares ? shares->skipped : (double)NAN,
                      shares ? shares->possible : (double)NAN, skip->without_viscosity,
                      skip->without_slope, promises[skip->promise], skip->difference,
                      (void *)(skip->promise == PROMISE_UNUSED ? json_null()
                                                               : result_number(skip->bound)),
                      skip->kept && skip->enough ? "pass" : "fail"));
        json_t *entry = json_array_get(list, json_array_size(list) - 1);
        if (skip->promise != PROMISE_UNUSED) add_drift(entry, skip);
        if (!shares) continue;
        result_add(entry,
                   "allowed_fraction=%g? reached_fraction=%g layers_fraction=%g possible_by=%s",
                   shares->allowed, shares->reached, shares->layers,
                   shares->coarse ? "coarse threshold" : "exact solution");
        if (maps) json_object_set_new(entry, "asleep", map_json(shares));
    }
    json_object_set_new(document, "skips", list);
}

static void print_answer(const struct bench_skip *skip, const struct table_style *style)
{
    const bool compared = skip->promise == PROMISE_BITS || skip->promise == PROMISE_ROUND_OFF;
    if (skip->promise == PROMISE_UNUSED || (compared && !(skip->difference > 0))) {
        printf("  %s", promises[compared ? PROMISE_BITS : PROMISE_UNUSED]);
        return;
    }
    const bool of_error = skip->promise == PROMISE_ERROR;
    if (skip->kept)
        printf("  %s: ", promises[skip->promise]);
    else
        printf("  %s%s%s: ", style->bad, of_error ? "" : "NOT ",
               of_error ? "larger error" : promises[skip->promise]);
    if (of_error)
        printf("%s %.4e against %.4e", skip->measured ? skip->measured : "none known",
               skip->error[BENCH_WITHOUT], skip->error[BENCH_WITH]);
    else
        printf("%.1e", skip->difference);
    if (skip->promise != PROMISE_BITS) printf(" (bound %.0e)", skip->bound);
    if (!skip->kept) printf("%s", style->end);
}

void bench_skips_print(const struct bench_skips *result, const struct table_style *style)
{
    printf("%s%-16s %6s  %-32s %8s %7s %9s %9s %9s %9s %9s %9s %9s  %s%s\n", style->bold, "case",
           "n", "left out", "saves", "spread", "updates", "allowed", "possible", "reached",
           "layers", "viscosity", "slopes", "the answer", style->end);
    for (size_t s = 0; s < result->count; s++) {
        const struct bench_skip *skip = &result->skips[s];
        printf("%-16s %6zu  %-32s %7.2fx %6.0f%%", result->cases[skip->case_index].file.name,
               result->n[skip->case_index], skip->name,
               skip->cpu_s[BENCH_WITH] / skip->cpu_s[BENCH_WITHOUT], 100 * skip->spread);
        if (skip->shares)
            printf(" %8.0f%% %8.0f%% %7.0f%%%s %8.0f%% %8.0f%%", -100 * skip->shares->skipped,
                   -100 * skip->shares->allowed, -100 * skip->shares->possible,
                   skip->shares->coarse ? "*" : " ", 100 * skip->shares->reached,
                   100 * skip->shares->layers);
        else
            printf(" %9s %9s %9s %9s %9s", "", "", "", "", "");
        const double shares[] = {skip->without_viscosity, skip->without_slope};
        for (size_t k = 0; k < sizeof shares / sizeof *shares; k++)
            if (isnan(shares[k]))
                printf(" %9s", "");
            else
                printf(" %8.0f%%", 0 - 100 * shares[k]);
        print_answer(skip, style);
        if (!skip->enough)
            printf("  %sTOO FEW UPDATES LEFT OUT: fewer than four fifths of those allowed%s",
                   style->bad, style->end);
        printf("\n");
    }
    printf(
        "%ssaves: CPU time with the work over that without, both runs of one benchmark; passes "
        "that the plan\ndoes not contain are timed by themselves (n = %d; in 2D and 3D 1600 and "
        "1728) on top of a "
        "particle's whole update. updates: particle\nupdates left out; allowed: of gas that a run "
        "without skips leaves as it was to the tolerance of skips,\nas well as all within a "
        "smoothing length; possible: of gas three "
        "smoothing lengths and more ahead of all waves of the\nexact solution; *: there is no such "
        "front, and it is gas that changes by less than 1e-7 in the\ntime h/c;\nreached: of what "
        "is possible, done where a precursor above the tolerance has come; layers: "
        "done for such neighbours;\nviscosity, slopes: "
        "of the updates that are done, those without. Differences: "
        "largest of "
        "any field at t_end over the field's largest value;\nbound of round-off: 1e-8, or "
        "what moving the start by the tolerance of skips (in spacings) changes%s\n",
        style->faint, BENCH_LOOPS_PARTICLES, style->end);
}

void bench_steps_print(const struct bench_skips *result, const struct table_style *style)
{
    printf("%s%-22s %6s %9s %7s  %-16s %10s %10s %9s %9s %9s %9s%s\n", style->bold, "case", "n",
           "CPU ratio", "spread", "error of", "local", "global", "momentum", "global", "energy",
           "global", style->end);
    for (size_t s = 0; s < result->count; s++) {
        const struct bench_skip *skip = &result->skips[s];
        printf("%-22s %6zu %9.2f %6.0f%%  %-16s %s%10.3e%s %10.3e %9.1e %9.1e %9.1e %9.1e\n",
               result->cases[skip->case_index].file.name, result->n[skip->case_index],
               skip->cpu_s[BENCH_WITHOUT] / skip->cpu_s[BENCH_WITH], 100 * skip->spread,
               skip->measured ? skip->measured : "nothing exact", skip->kept ? "" : style->bad,
               skip->error[BENCH_WITHOUT], skip->kept ? "" : style->end, skip->error[BENCH_WITH],
               skip->momentum[BENCH_WITHOUT], skip->momentum[BENCH_WITH],
               skip->energy[BENCH_WITHOUT], skip->energy[BENCH_WITH]);
    }
    printf("%sCPU ratio: time with local steps over that with global ones, both runs of one "
           "benchmark. momentum, energy:\nhow far they are not conserved, relative, with local "
           "steps and with global ones%s\n",
           style->faint, style->end);
}
