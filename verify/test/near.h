/* SPDX-License-Identifier: GPL-3.0-or-later
 * Comparisons of floating-point numbers for cmocka. They are written as !(error <= bound), so that
 * any NaN fails (cmocka's own float asserts pass NaN == 1). A failure prints value, expected, error
 * and bound. test.h includes this after cmocka.h; NEAR_FAIL may be defined before (as in
 * test_near.c). */
#pragma once

#include <math.h>

#ifndef NEAR_FAIL
#define NEAR_FAIL(file, line, ...)                                                                 \
    do {                                                                                           \
        print_error(__VA_ARGS__);                                                                  \
        _fail(file, line);                                                                         \
    } while (0)
#endif

/* |value - expected| <= bound. A bound that would also accept 0 for a nonzero expected value is
 * refused: it tests nothing. */
#define near_absolute(value, expected, bound)                                                      \
    near_absolute_at((value), (expected), (bound), #value, __FILE__, __LINE__)

/* |value - expected| <= bound |expected|; expected != 0, bound < 1/2. */
#define near_relative(value, expected, bound)                                                      \
    near_relative_at((value), (expected), (bound), #value, __FILE__, __LINE__)

/* value <= bound: for errors, residuals, ratios. */
#define near_below(value, bound) near_below_at((value), (bound), #value, __FILE__, __LINE__)

/* lo <= value <= hi. */
#define near_inside(value, lo, hi) near_inside_at((value), (lo), (hi), #value, __FILE__, __LINE__)

static inline void near_absolute_at(double value, double expected, double bound, const char *text,
                                    const char *file, int line)
{
    const double error = fabs(value - expected);
    if (!(bound < 0.5 * fabs(expected) || expected == 0))
        NEAR_FAIL(file, line, "%s: the bound %.3g does not tell %.17g from 0\n", text, bound,
                  expected);
    else if (!(error <= bound))
        NEAR_FAIL(file, line, "%s: got %.17g, expected %.17g, error %.3g > bound %.3g\n", text,
                  value, expected, error, bound);
}

static inline void near_relative_at(double value, double expected, double bound, const char *text,
                                    const char *file, int line)
{
    const double error = fabs(value - expected) / fabs(expected);
    if (!(bound < 0.5))
        NEAR_FAIL(file, line, "%s: the relative bound %.3g does not tell %.17g from 0\n", text,
                  bound, expected);
    else if (!(error <= bound))
        NEAR_FAIL(file, line, "%s: got %.17g, expected %.17g, relative error %.3g > bound %.3g\n",
                  text, value, expected, error, bound);
}

static inline void near_below_at(double value, double bound, const char *text, const char *file,
                                 int line)
{
    if (!(value <= bound))
        NEAR_FAIL(file, line, "%s: got %.17g > bound %.3g\n", text, value, bound);
}

static inline void near_inside_at(double value, double lo, double hi, const char *text,
                                  const char *file, int line)
{
    if (!(lo <= value && value <= hi))
        NEAR_FAIL(file, line, "%s: got %.17g, allowed [%.17g, %.17g]\n", text, value, lo, hi);
}
