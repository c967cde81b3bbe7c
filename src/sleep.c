/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sleep.h"

#include <float.h>
#include <math.h>

#include "solver.h"

/* Above the rounding of a lattice of n points: positions of order 1 are known to eps, spacings to
 * n eps. */
static double tolerance(const struct simulation *simulation)
{
    return fmax(1e-11, 30 * DBL_EPSILON * (double)simulation->particles.n);
}

bool sleep_disturbed(const struct simulation *simulation, ptrdiff_t first, ptrdiff_t len)
{
    const struct particles *a = &simulation->particles;
    const double limit = tolerance(simulation);
    bool disturbed = false;
    for (ptrdiff_t i = first; i < first + len; i++) {
        double area = 1;
        for (int k = 1; k < a->dim; k++) area *= a->h[i];
        disturbed |= !(particles_norm(a, a->F, i) <= limit * a->P[i] * area);
        disturbed |=
            !(fabs(a->de[i]) <= limit * a->P[i] * (a->c[i] + particles_norm(a, a->v, i)) * area);
        if (simulation->plan.alpha) disturbed |= !(fabs(a->dalpha[i]) * a->h[i] <= limit * a->c[i]);
    }
    return disturbed;
}

void sleep_begin(struct simulation *simulation, ptrdiff_t first, ptrdiff_t len)
{
    const struct particles *a = &simulation->particles;
    for (ptrdiff_t i = first; i < first + len; i++) {
        a->de[i] = a->dalpha[i] = 0;
        for (int k = 0; k < a->dim; k++) {
            a->F[k][i] = 0;
            simulation->sleep.at_rest &= a->p[k][i] == 0;
        }
    }
}
