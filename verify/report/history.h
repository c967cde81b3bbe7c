/* SPDX-License-Identifier: GPL-3.0-or-later
 * The history of a report: one line of JSON per night with all its headline figures (date, git,
 * mode, processor, verdict, {path: value}), the changes since last night, and the night at which
 * each figure reached its level. */
#pragma once

#include <jansson.h>
#include <stddef.h>

#include "status.h"

/* The newest nights of a mode, up to this number, are read. */
enum { HISTORY_NIGHTS_MAX = 120 };

/* The results' place in the history at path (which need not be there yet; lines that cannot be
 * read are counted and left alone):
 *   "nights"      [{"date", "git"}], oldest first; the last is this one
 *   "unreadable"  lines
 *   "since"       against the night before: {"date", "git", "worse", "better", "same",
 *                 "incomparable", "figures": as in a diff, what is not the same}, timings left
 *                 out; or null
 *   "trends"      [{"case", "label", "error": [...], "order": [...]}]: of L1(density), per night
 *   "changes"     [{"path", "date", "git", "git_before", "before", "after", "ratio", "verdict"}],
 *                 newest first: change points of errors and orders
 * New reference in *history. STATUS_ENVIRONMENT: no memory, or the file cannot be read. */
enum status history_tell(const json_t *results, const char *path, json_t **history,
                         struct error *error);

/* Appends this night's line. If the disk is full, a part of it may stay there, which history_tell
 * counts as unreadable. */
enum status history_append(const json_t *results, const char *path, struct error *error);

/* Change points of a figure's history, from medians: a single odd night is none, unless it is the
 * last one (new changes must show at once); a lasting change of level is one. */

struct trend_change {
    size_t at;            /* first night of the new level */
    double before, after; /* medians of the nights on either side, at most TREND_WINDOW each */
};

#define TREND_WINDOW 5

/* value: n nights, oldest first, all finite (logarithms of figures with relative noise). At a
 * change point the medians differ by more than noise plus three times the scatter (1.4826 median
 * |residual|) about them. Writes them in rising order, fewer than n; returns their number. */
size_t trend_changes(size_t n, const double *value, double noise, struct trend_change *changes);
