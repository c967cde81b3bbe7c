/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vortex.h"

#include <math.h>

struct vortex_state vortex_gresho(double R)
{
    const double squares = 12.5 * R * R;
    if (R < 0.2) return (struct vortex_state){1, 5 * R, 5 + squares};
    if (R < 0.4)
        return (struct vortex_state){1, 2 - 5 * R, 9 + squares - 20 * R + 4 * log(R / 0.2)};
    return (struct vortex_state){1, 0, 3 + 4 * log(2)};
}

struct vortex_state vortex_yee(double R, double beta, double gamma)
{
    const double turn = beta / (2 * M_PI), fall = exp(1 - R * R);
    const double T = 1 - (gamma - 1) / (2 * gamma) * turn * turn * fall;
    const double rho = pow(T, 1 / (gamma - 1));
    return (struct vortex_state){rho, turn * R * sqrt(fall), rho * T};
}
