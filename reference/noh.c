/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "noh.h"

#include <math.h>

double noh_shock(double gamma, double t)
{
    return 0.5 * (gamma - 1) * t;
}

struct noh_state noh_sample(double gamma, int d, double r, double t)
{
    if (r < noh_shock(gamma, t)) {
        /* the kinetic energy has become heat, u = 1/2 */
        const double rho = pow((gamma + 1) / (gamma - 1), d);
        return (struct noh_state){rho, 0, 0.5 * (gamma - 1) * rho};
    }
    /* free fall: a shell of radius r had the radius r + t and the same thickness */
    return (struct noh_state){r > 0 ? pow(1 + t / r, d - 1) : 1, r > 0 ? -1 : 0, 0};
}
