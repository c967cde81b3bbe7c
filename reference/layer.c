/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "layer.h"

#include <math.h>
#include <stddef.h>

const char *layer_fault(const struct layer *layer)
{
    if (!(layer->gamma > 1 && layer->k > 0 && layer->width > 0 && layer->P > 0))
        return "gamma > 1, k > 0, width > 0 and P > 0 are needed";
    if (!(layer->rho > fabs(layer->rho_step))) return "density has to be positive everywhere";
    if (layer->periodic) return layer->g == 0 ? NULL : "gravity needs walls";
    if (!(layer->wall > 0)) return "walls at y = -wall and wall > 0 are needed";
    return layer_base(layer, layer->wall).P > 0 && layer_base(layer, -layer->wall).P > 0
               ? NULL
               : "gravity is too strong: pressure has to be positive everywhere";
}

/* ln cosh without overflow. */
static double ln_cosh(double z)
{
    return fabs(z) + log1p(exp(-2 * fabs(z))) - M_LN2;
}

struct layer_base layer_base(const struct layer *layer, double y)
{
    const double a = layer->width;
    const double z = layer->periodic ? sin(2 * M_PI * y) / (2 * M_PI * a) : y / a;
    const double T = tanh(z), slope = layer->periodic ? cos(2 * M_PI * y) / a : 1 / a;
    const double T_dy = slope / (cosh(z) * cosh(z));
    struct layer_base base = {.rho = layer->rho + layer->rho_step * T,
                              .U = layer->U * T,
                              .P = layer->P,
                              .rho_dy = layer->rho_step * T_dy,
                              .U_dy = layer->U * T_dy};
    if (layer->g != 0) base.P -= layer->g * (layer->rho * y + layer->rho_step * a * ln_cosh(y / a));
    base.c2 = layer->gamma * base.P / base.rho;
    return base;
}
