/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a change did: the metrics of two result documents of the same command, each judged against
 * its noise. */
#pragma once

#include "metric.h"

/* Worse by more than this part of the old value is a regression (of an order: beyond its interval;
 * of a word: it says fail). Timings and counts of work never are. */
#define DIFF_THRESHOLD 0.05

struct difference {
    const struct metric *old, *new; /* NULL: on the other side only */
    enum metric_verdict verdict;
    double amount; /* see metric_judge */
    bool regression;
};

struct diff {
    struct metrics old, new;
    struct difference *list; /* regressions first, then vanished, incomparable, worse, better ... */
    size_t count, verdicts[READING_VERDICTS], regressions;
    size_t compared; /* figures that both documents have and that say something about each other */
    size_t left_out; /* figures of runs that broke down: the breakdown is what is compared */
    size_t left_out_times; /* of two processors, which say nothing about each other */
    char
        problem[256]; /* "", or why no figures can be compared: two cases, nothing to compare ... */
    bool well;        /* no problem, no regression, nothing vanished, nothing incomparable */
};

/* STATUS_OK or STATUS_CHECK_FAILED (not well); STATUS_BAD_INPUT: documents of two commands, or a
 * figure that no rule covers. */
enum status diff_documents(const json_t *old, const json_t *new, double threshold,
                           struct diff *diff, struct error *error);
void diff_free(struct diff *diff);

/* [{"path", "old", "new", "exact", "ratio", "verdict", "regression"}], the first `most` of them. */
json_t *diff_figures_json(const struct diff *diff, size_t most);

/* Adds "figures", "summary", "problem" and "status". */
void diff_add_json(const struct diff *diff, json_t *document);

/* Why it is not well, if so; then a table of everything that is not the same, on standard output;
 * exact: with that column. */
void diff_print(const struct diff *diff, double threshold, bool exact, bool color);
