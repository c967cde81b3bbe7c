/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests whether an exact solution of one-dimensional gas dynamics satisfies the conservation laws:
 * in integral form over rectangles of x and t (shocks and contacts included), by Gauss-Legendre
 * quadrature between given paths of kinks, and in differential form where the solution is
 * smooth. */
#pragma once

#include <stddef.h>

#include "riemann.h"

/* The flow under test. A state with rho = 0 is vacuum and carries nothing, whatever its v. */
struct flow {
    struct riemann_state (*at)(const void *context, double x, double t);
    const void *context;
    double gamma;
};

/* The lines x = x0 + speeds[i] t on which the flow is not smooth. Ignores NaN and infinite speeds.
 * At most BALANCE_PATHS. */
struct flow_paths {
    double x0;
    const double *speeds;
    size_t n;
};
enum { BALANCE_PATHS = 16 };

/* |change of content + net outflow| of mass, momentum and energy over [x[0], x[1]] x [t[0], t[1]],
 * the worst of the three, each relative to the sum of the magnitudes of its terms. NaN: no memory,
 * too many paths, or the flow has a NaN. */
double balance_defect(const struct flow *flow, const double x[2], const double t[2],
                      const struct flow_paths *paths);

/* |dU/dt + dF/dx| at a smooth point, the worst of the three relative to its two terms. dx, dt:
 * steps of the numerical derivatives, well inside the smooth region. Round-off: some 1e-10. */
double balance_residual(const struct flow *flow, double x, double t, double dx, double dt);
