/* SPDX-License-Identifier: GPL-3.0-or-later
 * Change points of a figure's history, by medians: one odd night is not one, unless it is the last
 * (what is new must be seen at once); a level that stays is. */
#ifndef SPHPROOF_TREND_H
#define SPHPROOF_TREND_H

#include <stddef.h>

enum { TREND_NIGHTS_MAX = 400 };

struct trend_change {
    size_t at;            /* first night of the new level */
    double before, after; /* medians of the nights on either side, at most TREND_WINDOW each */
};

#define TREND_WINDOW 5

/* value: n <= TREND_NIGHTS_MAX nights, oldest first, all finite (logarithms of what varies
 * relatively). A change point is where the medians differ by more than noise plus three times the
 * scatter (1.4826 median |residual|) about them. Rising order; returns their number, <= most. */
size_t trend_changes(size_t n, const double *value, double noise, struct trend_change *changes,
                     size_t most);

#endif
