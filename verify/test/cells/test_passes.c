/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the pass that inverts matrices, at the largest condition number that is allowed. */
#include "test.h"

#include "draw.h"

#include "cells/lanes.h"

enum { N = 60 };

/* The largest condition number allowed is itself allowed. */
TEST(largest_condition_number)
{
    static double x[2][N], V[N], h_inverse[N], radius[N], condition[N], matrix[CELLS_SYMMETRIC][N];
    struct kernel kernel;
    assert_int_equal(kernel_select(&kernel, "quartic_spline", 5, NULL), STATUS_OK);
    struct cells_method method = {.box = {.dim = 2, .hi = {1, 1, 1}},
                                  .kernel = &kernel,
                                  .gradient = GRADIENT_IA,
                                  .worst_condition = HUGE_VAL,
                                  .threads = 1};
    struct cells_fields fields = {
        .n = N, .x = {x[0], x[1]}, .V = V, .h_inverse = h_inverse, .condition = condition};
    for (int k = 0; k < CELLS_SYMMETRIC; k++) fields.matrix[k] = matrix[k];
    for (int i = 0; i < N; i++) {
        const double h = draw(0.28, 0.38);
        x[0][i] = draw(0, 1), x[1][i] = draw(0, 1), V[i] = draw(0.5, 2);
        h_inverse[i] = 1 / h, radius[i] = 1.2 * h;
    }
    x[0][0] = x[1][0] = 5; /* a point without neighbours */
    for (int round = 0; round < 2; round++) {
        struct cells *cells = cells_create(&method, N);
        assert_non_null(cells);
        assert_int_equal(cells_arrange(cells, &fields, radius, NULL, NULL), STATUS_OK);
        size_t beyond = 0;
        matrix[0][20] = 0;
        const size_t reported = cells_matrix(cells, &fields);
        for (int i = 0; i < N; i++)
            if (!(condition[i] <= method.worst_condition)) beyond++;
        assert_int_equal(reported, beyond);
        assert_true(matrix[0][20] != 0);
        method.worst_condition = condition[20];
        cells_destroy(cells);
    }
}
