/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares two result documents of one command: each metric's change is judged against its noise.
 */
#pragma once

#include "metric.h"

/* A figure that is worse by more than this fraction of the old value is a regression (an order: by
 * more than its interval; a word: if it is a failure). Timings and counts of work never are. */
#define DIFF_THRESHOLD 0.05

struct difference {
    const struct metric *old, *new; /* NULL: only in the other document */
    const struct metric *any;       /* the new one if there is one, else the old one */
    enum metric_verdict verdict;
    double amount; /* see metric_judge */
    bool regression;
    bool left_out; /* a figure of a run that broke down, or a timing of another processor */
};

struct diff {
    struct metrics old, new;
    struct difference *list; /* regressions first, then vanished, incomparable, worse, better ... */
    size_t count, verdicts[METRIC_VERDICTS], regressions;
    size_t compared;       /* comparable figures that both documents have */
    size_t left_out;       /* figures of broken runs: only the breakdown is compared */
    size_t left_out_times; /* timings of different processors */
    char problem[256]; /* "", or why nothing can be compared: two cases, no common figures ... */
    bool well;         /* no problem, regression, vanished or incomparable figure */
};

/* Returns STATUS_OK or STATUS_CHECK_FAILED (not well); STATUS_BAD_INPUT: documents of two commands,
 * or a figure without a rule. */
enum status diff_documents(const json_t *old, const json_t *new, double threshold,
                           struct diff *diff, struct error *error);
void diff_free(struct diff *diff);

/* [{"path", "old", "new", "exact", "ratio", "verdict", "regression"}], the first `most` of them. */
json_t *diff_figures_json(const struct diff *diff, size_t most);

/* Adds "figures", "summary", "problem" and "status". */
void diff_add_json(const struct diff *diff, json_t *document);

/* Prints why the comparison fails, if it does, and a table of all changes on standard output;
 * exact: with the column of exact values. */
void diff_print(const struct diff *diff, double threshold, bool exact, bool color);
