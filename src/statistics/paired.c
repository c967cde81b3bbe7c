/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paired.h"

#include <gsl/gsl_cdf.h>
#include <math.h>

/* Smallest relative change that counts, however alike the draws are: the noise that `sphproof diff`
 * allows errors. */
static const double least = 1e-3;

const char *const paired_verdicts[PAIRED_VERDICTS] = {"none", "better", "worse", "unknown"};

struct paired paired_compare(size_t n, const double *a, const double *b, bool single, double level)
{
    struct paired of = {.a = NAN, .b = NAN, .change = NAN, .half = NAN};
    double mean[2] = {0}, ratio = 0, squares = 0;
    for (size_t i = 0; i < n; i++) { /* Welford 1962 */
        if (!(a[i] > 0 && b[i] > 0 && isfinite(a[i]) && isfinite(b[i]))) continue;
        const double one = log(b[i]) - log(a[i]), off = one - ratio, count = (double)++of.n;
        ratio += off / count;
        squares += off * (one - ratio);
        mean[0] += (log(a[i]) - mean[0]) / count;
        mean[1] += (log(b[i]) - mean[1]) / count;
    }
    if (!of.n) return of;
    const double count = (double)of.n, factor = exp(ratio);
    of.a = exp(mean[0]), of.b = exp(mean[1]), of.change = factor - 1;
    if (of.n < 2) {
        of.verdict = fabs(ratio) > least ? PAIRED_UNKNOWN : PAIRED_NONE;
        return of;
    }
    const double variance = squares / (count - 1) * (1 / count + (single ? 1 : 0));
    const double half = gsl_cdf_tdist_Pinv(1 - level / 2, count - 1) * sqrt(variance);
    of.half = factor * half;
    if (fabs(ratio) > fmax(half, least)) of.verdict = ratio < 0 ? PAIRED_BETTER : PAIRED_WORSE;
    return of;
}
