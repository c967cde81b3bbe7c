/* SPDX-License-Identifier: GPL-3.0-or-later
 * A test of my own code: its time integrator, leapfrog on an orbit, is of second order, and the
 * gate says so. With -DTYPO the last half kick is missing, and it is not. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include <sphproof/convergence.h>

/* The error after one circular orbit of radius 1 around a mass of 1, in this number of steps. */
static double my_error(int steps)
{
    const double dt = 2 * 3.14159265358979323846 / steps;
    double x = 1, y = 0, u = 0, v = 1;
    for (int i = 0; i < steps; i++) {
        double r3 = pow(x * x + y * y, 1.5);
        u -= 0.5 * dt * x / r3, v -= 0.5 * dt * y / r3;
        x += dt * u, y += dt * v;
        r3 = pow(x * x + y * y, 1.5);
#ifndef TYPO
        u -= 0.5 * dt * x / r3, v -= 0.5 * dt * y / r3;
#endif
    }
    return hypot(x - 1, y);
}

static void leapfrog_is_of_second_order(void **state)
{
    (void)state;
    static const int steps[] = {50, 100, 200, 400, 800};
    const struct sphproof_gate gate = {.low = 1.9, .high = 2.1, .bound = 1e-3};
    double spacing[5], error_at[5];
    struct sphproof_order order;
    struct sphproof_error error;
    for (int l = 0; l < 5; l++) {
        spacing[l] = 1. / steps[l];
        error_at[l] = my_error(steps[l]);
    }
    assert_int_equal(sphproof_convergence_order(5, spacing, error_at, &order, &error), SPHPROOF_OK);
    print_message("order %.3f, 95 %% between %.3f and %.3f\n", order.order, order.low, order.high);
    if (sphproof_convergence_gate(&order, &gate, &error)) fail_msg("%s", error.message);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(leapfrog_is_of_second_order)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
