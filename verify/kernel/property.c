/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "property.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

/* Powers of h are exact at 1 only: a wrong power hides there. */
const double property_width[PROPERTY_WIDTHS] = {1, 0.0371, 2.385, 41.7};

static void pass_on(struct property_sink *sink, double value, double bound, double floor,
                    const char *where)
{
    sink->take(sink, &(struct finding){.subject = where,
                                       .value = value,
                                       .bound = bound,
                                       .floor = floor,
                                       .status = finding_judge(value, bound, floor)});
}

struct finding property_single(const struct finding *figure)
{
    struct finding single = *figure;
    if (single.bound > 0) single.bound = fmax(single.bound, TERMS_SINGLE_BOUND);
    if (single.status != FINDING_SKIP)
        single.status = finding_judge(single.value, single.bound, single.floor);
    return single;
}

void property_take(struct property_sink *sink, double value, double bound, double floor,
                   const char *where, ...)
{
    char text[128];
    va_list arguments;
    va_start(arguments, where);
    vsnprintf(text, sizeof text, where, arguments);
    va_end(arguments);
    pass_on(sink, value, bound, floor, text);
}

void property_skip(struct property_sink *sink, const char *why, ...)
{
    char text[128];
    va_list arguments;
    va_start(arguments, why);
    vsnprintf(text, sizeof text, why, arguments);
    va_end(arguments);
    const double nan = (double)NAN;
    sink->take(
        sink,
        &(struct finding){
            .subject = text, .value = nan, .bound = nan, .floor = nan, .status = FINDING_SKIP});
}

/* Value over bound; infinite if it fails a bound of 0. */
static double property_ratio(double value, double bound)
{
    if (bound > 0) return value / bound;
    return value <= bound ? 0 : (double)INFINITY;
}

void property_keep(struct property_worst *worst, double value, double bound, double floor,
                   const char *where, ...)
{
    const double ratio = property_ratio(value, bound);
    const double largest = property_ratio(worst->value, worst->bound);
    const bool larger = ratio > largest || (ratio == largest && value > worst->value);
    if (worst->where[0] && !isnan(value) && !larger) return;
    if (isnan(worst->value)) return;
    *worst = (struct property_worst){.value = value, .bound = bound, .floor = floor};
    va_list arguments;
    va_start(arguments, where);
    vsnprintf(worst->where, sizeof worst->where, where, arguments);
    va_end(arguments);
}

void property_take_worst(struct property_sink *sink, const struct property_worst *worst)
{
    const bool compared = worst->where[0];
    pass_on(sink, compared ? worst->value : (double)NAN, worst->bound, worst->floor,
            compared ? worst->where : "nothing was compared");
}

double property_bound(double base, double floor)
{
    return fmax(base, fmin(20 * floor, PROPERTY_BOUND_MAX));
}
