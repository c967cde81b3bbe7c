/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "disc.h"

#include <math.h>

double disc_radius(double spin, double Pc, double t)
{
    return sqrt(1 + (spin * spin + 2 * Pc) * t * t);
}

struct disc_state disc_sample(double spin, double Pc, double r, double t)
{
    const double a = disc_radius(spin, Pc, t), a2 = a * a;
    const double growth = (spin * spin + 2 * Pc) * t / a2; /* a'/a */
    const double inside = r <= a ? 1 : 0;
    return (struct disc_state){.rho = inside / a2,
                               .v_out = growth * r,
                               .v_along = spin * r / a2, /* each particle keeps r v */
                               .P = inside * Pc * (1 - r * r / a2) / (a2 * a2)};
}
