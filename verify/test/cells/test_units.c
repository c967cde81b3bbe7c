/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests which arrays are copied into other units before sums over clouds, into which units, and the
 * copies; and that kernel loops are only used for the kernel that they are made for. */
#include "test.h"

#include "shapes.h"
#include "cells/units.h"

TEST(ordinary_numbers_are_not_scaled)
{
    static const struct {
        double value;
        bool ordinary;
    } cases[] = {{0, true},
                 {-0.0, true},
                 {1, true},
                 {0x1p128, true},
                 {-0x1p128, true},
                 {0x1.0000000000001p128, false},
                 {-0x1.0000000000001p128, false},
                 {0x1p-128, true},
                 {-0x1p-128, true},
                 {0x1.fffffffffffffp-129, false},
                 {-0x1.fffffffffffffp-129, false},
                 {0x1p-1074, false},
                 {HUGE_VAL, false}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        for (size_t n = 1; n < 4; n++)
            for (size_t at = 0; at < n; at++) {
                double values[4] = {1, 1, 1, 0x1p200}; /* values beyond n do not count */
                for (size_t i = n; i < 4; i++) values[i] = 0x1p200;
                values[at] = cases[k].value;
                assert_int_equal(units_ordinary(n, values), cases[k].ordinary);
            }
    assert_true(units_ordinary(0, (double[]){0x1p200}));
}

TEST(exponents)
{
    for (int e = -1073; e <= 1024; e++) {
        const double largest = ldexp(e < -1021 ? 0.5 : 0.7, e);
        assert_int_equal(units_exponent(3, (double[]){0, -largest, largest / 2, 1e308}), e);
        assert_int_equal(units_exponent(4, (double[]){HUGE_VAL, (double)NAN, -HUGE_VAL, largest}),
                         e);
        assert_int_equal(units_exponent(1, (double[]){largest}), e);
    }
    assert_int_equal(units_exponent(2, (double[]){0, 0, 5}), 0);
    assert_int_equal(units_exponent(0, (double[]){5}), 0);
    assert_int_equal(units_exponent(1, (double[]){0.5}), 0);
    assert_int_equal(units_exponent(1, (double[]){1}), 1);
}

TEST(copies_of_units)
{
    const double x[] = {3, -0.1, 0x1p900, 0}, y[] = {5, 7, -0x1p901, 1};
    struct points copy, points = {2, 4, {x, y}, true, {-2, 3}, {4, 5}};
    double *values = units_copy(4, x, 17);
    for (int i = 0; i < 4; i++) assert_true(values[i] == ldexp(x[i], -17));
    free(values);
    assert_non_null(values = units_copy(0, x, 3));
    free(values);
    for (int e = -20; e <= 900; e += 230) {
        assert_true(units_points(&points, e, &copy));
        assert_true(copy.dim == 2 && copy.n == 4 && copy.periodic);
        for (int i = 0; i < 4; i++)
            assert_true(copy.x[0][i] == ldexp(x[i], -e) && copy.x[1][i] == ldexp(y[i], -e));
        for (int a = 0; a < 2; a++)
            assert_true(copy.lo[a] == ldexp(points.lo[a], -e) &&
                        copy.hi[a] == ldexp(points.hi[a], -e));
        units_points_free(&copy);
        assert_true(!copy.x[0] && !copy.x[1]);
    }
}

/* A plug-in with a kernel's function or derivative alone has no specialised loops. */
TEST(loops_of_plugins)
{
    for (size_t k = 0; k < kernel_family.n; k++)
        for (int dim = 1; dim <= 3; dim++) {
            struct kernel kernel, half;
            assert_int_equal(kernel_select(&kernel, kernel_family.members[k]->name, 5, NULL),
                             STATUS_OK);
            half = kernel;
            half.dw = half.w;
            assert_true(shapes_of(&half, dim, true).w == shapes_of(&kernel, dim, false).w);
            assert_true((shapes_of(&kernel, dim, true).w == shapes_of(&kernel, dim, false).w) ==
                        (kernel_specialisation(&kernel) < 0));
        }
}
