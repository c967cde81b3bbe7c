/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests which numbers the macros of near.h accept and, above all, which they refuse. */

static int refused;
static char message[256];
#define NEAR_FAIL(file, line, ...)                                                                 \
    do {                                                                                           \
        (void)(file), (void)(line);                                                                \
        snprintf(message, sizeof message, __VA_ARGS__);                                            \
        refused++;                                                                                 \
    } while (0)
#include "test.h"

#define REFUSES(comparison)                                                                        \
    do {                                                                                           \
        refused = 0;                                                                               \
        comparison;                                                                                \
        assert_int_equal(refused, 1);                                                              \
    } while (0)
#define ACCEPTS(comparison)                                                                        \
    do {                                                                                           \
        refused = 0;                                                                               \
        comparison;                                                                                \
        assert_int_equal(refused, 0);                                                              \
    } while (0)

TEST(accepts)
{
    ACCEPTS(near_absolute(1 + 1e-9, 1, 1e-8));
    ACCEPTS(near_absolute(-1e-17, 0, 1e-16));
    ACCEPTS(near_relative(2e-18, 2e-18 * (1 + 1e-12), 1e-10));
    ACCEPTS(near_below(0, 0));
    ACCEPTS(near_inside(2, 2, 2));
}

TEST(refuses_far)
{
    REFUSES(near_absolute(1 + 5e-8, 1, 1e-8));
    REFUSES(near_relative(1e-18, 2e-18, 1e-10));
    REFUSES(near_below(1e-16, 0));
    REFUSES(near_inside(1, 2, 3));
    REFUSES(near_inside(4, 2, 3));
}

TEST(refuses_nan)
{
    REFUSES(near_absolute((double)NAN, 1, 1e-8));
    REFUSES(near_absolute(1, (double)NAN, 1e-8));
    REFUSES(near_absolute(1, 1, (double)NAN));
    REFUSES(near_absolute((double)INFINITY, (double)INFINITY, 1e-8));
    REFUSES(near_relative((double)NAN, 1, 1e-8));
    REFUSES(near_relative(0, 0, 1e-8));
    REFUSES(near_below((double)NAN, 1));
    REFUSES(near_inside((double)NAN, 0, 1));
}

TEST(refuses_idle_bounds)
{
    REFUSES(near_absolute(1e-18, 1e-18, 1e-10));
    REFUSES(near_relative(1, 1, 1));
}

TEST(messages)
{
    const double rho = 1.5;
    REFUSES(near_absolute(rho, 1, 0.125));
    assert_non_null(strstr(message, "rho: got 1.5, expected 1, error 0.5 > bound 0.125"));
}
