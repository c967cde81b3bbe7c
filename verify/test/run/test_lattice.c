/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the number of lattice cells that fit into a box, and that Sobol points are inside. */
#include "test.h"

#include "lattice.h"

/* The number of cells that fits best: 2.5, and a little more or less. */
TEST(cells_that_fit)
{
    for (int more = -1; more <= 1; more += 2) {
        const double fit = 2.5 * (1 + more * 2e-7);
        const struct domain box = {2, {0, 0}, {1, 10 / (fit * fit)}};
        struct lattice_plan plan;
        struct error error;
        assert_int_equal(lattice_plan_make(&plan, &box, LATTICE_SQUARE, 10, &error), STATUS_OK);
        assert_int_equal(plan.cells[0], more > 0 ? 3 : 2);
        assert_int_equal(plan.cells[1], 4);
    }
}

/* So many quasi-random points that some are within 1e-6 of an end: all lie inside. */
TEST(sobol_points_stay_inside)
{
    enum { N = (1 << 20) + 1 };
    const struct domain box = {2, {-1, 3}, {1, 4}};
    struct lattice_plan plan;
    struct error error;
    double *y = malloc(2 * N * sizeof *y);
    double *const x[] = {y, y + N, NULL};
    assert_int_equal(lattice_plan_make(&plan, &box, LATTICE_RANDOM, N, &error), STATUS_OK);
    assert_int_equal(lattice_points(&plan, 7, x, &error), STATUS_OK);
    for (int d = 0; d < 2; d++) {
        double lo = HUGE_VAL, hi = -HUGE_VAL;
        for (int i = 0; i < N; i++) lo = fmin(lo, x[d][i]), hi = fmax(hi, x[d][i]);
        const double side = box.hi[d] - box.lo[d];
        assert_true(lo >= box.lo[d] && lo < box.lo[d] + 1e-6 * side);
        assert_true(hi < box.hi[d] && hi > box.hi[d] - 1e-6 * side);
    }
    free(y);
}
