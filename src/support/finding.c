/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "finding.h"

#include <math.h>
#include <stddef.h>

const char *const finding_words[] = {"none",  "pass",         "fail", "known",
                                     "smoke", "undetermined", "skip", NULL};

enum finding_status finding_judge(double value, double bound, double floor)
{
    return value <= bound && floor <= bound ? FINDING_PASS : FINDING_FAIL;
}

double finding_ratio(double value, double bound)
{
    if (value <= bound) return value <= 0 ? 0 : value / bound;
    return bound > 0 && value > 0 ? value / bound : (double)INFINITY;
}

double finding_excess(const struct finding *finding, double *beyond)
{
    const double bound = finding->bound;
    *beyond = finding->value <= bound && finding->floor > bound ? finding->floor : finding->value;
    return finding_ratio(*beyond, bound);
}
