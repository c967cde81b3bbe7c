/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "suspicion.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

static bool __attribute__((format(printf, 2, 3))) suspect(char *why, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (why) vsnprintf(why, SUSPICION_TEXT, format, arguments);
    va_end(arguments);
    return true;
}

bool suspicion_zero(size_t n, const double *error, char *why)
{
    for (size_t i = 0; i < n; i++)
        if (error[i] == 0)
            return suspect(why, "the error at level %zu is exactly 0: compared with itself?", i);
    return false;
}

bool suspicion_repeated(size_t n, const double *error, char *why)
{
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < i; j++)
            if (fabs(error[i] - error[j]) <= 1e-12 * fabs(error[i]))
                return suspect(why,
                               "levels %zu and %zu have the same error %.10g: was one not run?", j,
                               i, error[i]);
    return false;
}

bool suspicion_idle_setting(const char *setting, size_t n, const double *before,
                            const double *after, char *why)
{
    for (size_t i = 0; i < n; i++)
        if (before[i] != after[i]) return false;
    return n > 0 && suspect(why, "changing %s changed nothing: is it read at all?", setting);
}

static double distance(size_t n, const double *volume, const double *a, const double *b)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        if (volume[i] != 0) sum += volume[i] * fabs(a[i] - b[i]);
    return sum;
}

/* Distance of a field from its own mean. */
static double spread(size_t n, const double *volume, const double *a)
{
    double whole = 0, mean = 0, sum = 0;
    for (size_t i = 0; i < n; i++)
        if (volume[i] != 0) whole += volume[i], mean += volume[i] * a[i];
    mean /= whole;
    for (size_t i = 0; i < n; i++)
        if (volume[i] != 0) sum += volume[i] * fabs(a[i] - mean);
    return sum;
}

bool suspicion_swapped(size_t fields, const char *const *names, size_t n, const double *volume,
                       const double *const *value, const double *const *exact, char *why)
{
    for (size_t f = 0; f < fields; f++)
        for (size_t g = 0; g < fields; g++) {
            const double near = 2 * distance(n, volume, value[f], exact[g]);
            if (near < distance(n, volume, value[f], exact[f]) &&
                near < spread(n, volume, exact[g]))
                return suspect(why, "%s is nearer the exact %s than its own exact solution",
                               names[f], names[g]);
        }
    return false;
}
