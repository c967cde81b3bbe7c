/* SPDX-License-Identifier: GPL-3.0-or-later
 * Solves the Riemann problem of a tube that keys define, for tests of tubes. Include after test.h.
 */
#pragma once

#include "prepared.h"
#include "riemann.h"

/* The two gases of a tube, solved as they are and mirrored. */
struct gases {
    struct riemann_state left, right;
    struct riemann_solution main, mirror;
};

static inline struct gases gases_of(double gamma, const struct settings *settings)
{
    const double *l = settings->value[SETTING_left].real, *r = settings->value[SETTING_right].real;
    struct gases gases = {.left = {l[0], l[1], l[2]}, .right = {r[0], r[1], r[2]}};
    assert_null(riemann_solve(gamma, &gases.left, &gases.right, &gases.main));
    assert_null(riemann_solve(gamma, &gases.right, &gases.left, &gases.mirror));
    return gases;
}
