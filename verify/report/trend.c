/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "history.h"

#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

static const double scatters = 3, normal = 1.4826; /* MAD to standard deviation */

/* For an even number, the middle value closer to `other`, which favours "no change". */
static double median(const double *value, size_t n, double other)
{
    double sorted[TREND_WINDOW];
    memcpy(sorted, value, n * sizeof *value);
    gsl_sort(sorted, 1, n);
    const double low = sorted[(n - 1) / 2], high = sorted[n / 2];
    return fabs(low - other) <= fabs(high - other) ? low : high;
}

struct split {
    double before, after;
    double merit; /* jump minus mean residual; among equals the larger jump wins */
    bool accepted;
};

/* Tries a split before night k of first..end - 1. */
static struct split try_split(const double *value, size_t first, size_t end, size_t k, double noise)
{
    const size_t left = k - first < TREND_WINDOW ? k - first : TREND_WINDOW;
    const size_t right = end - k < TREND_WINDOW ? end - k : TREND_WINDOW;
    const double *a = value + k - left, *b = value + k;
    double residual[2 * TREND_WINDOW], sum = 0;
    const double step = fabs(value[k] - value[k - 1]);
    struct split split = {.accepted = false};
    split.before = median(a, left, value[k]);
    split.after = median(b, right, split.before);
    split.before = median(a, left, split.after);
    for (size_t i = 0; i < left; i++) sum += residual[i] = fabs(a[i] - split.before);
    for (size_t i = 0; i < right; i++) sum += residual[left + i] = fabs(b[i] - split.after);
    gsl_sort(residual, 1, left + right);
    const double scatter = normal * gsl_stats_median_from_sorted_data(residual, 1, left + right);
    const double jump = fabs(split.after - split.before);
    split.accepted = jump > noise + scatters * scatter;
    split.merit = jump - sum / (double)(left + right) + step / (2 * TREND_WINDOW);
    return split;
}

/* Splits first..end - 1 at the clearest change and searches both sides separately, so that levels
 * do not mix. Returns the number of changes. */
static size_t search(const double *value, size_t first, size_t end, double noise,
                     struct trend_change *changes)
{
    struct split best = {.accepted = false};
    size_t at = 0;
    for (size_t k = first + 1; k < end; k++) {
        const struct split split = try_split(value, first, end, k, noise);
        if (!split.accepted || (best.accepted && !(split.merit > best.merit))) continue;
        best = split;
        at = k;
    }
    if (!best.accepted) return 0;
    size_t count = search(value, first, at, noise, changes);
    changes[count++] = (struct trend_change){at, best.before, best.after};
    return count + search(value, at, end, noise, changes + count);
}

size_t trend_changes(size_t n, const double *value, double noise, struct trend_change *changes)
{
    return search(value, 0, n, noise, changes);
}
