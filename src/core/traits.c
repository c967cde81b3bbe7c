/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traits.h"

const struct gradient_traits traits_gradient[GRADIENTS] = {
    [GRADIENT_IA] = {.matrix = true},
    [GRADIENT_CORRECTED] = {.matrix = true, .by_slope = true},
    [GRADIENT_BLENDED] = {.matrix = true, .blends = true},
};

const struct viscosity_traits traits_viscosity[VISCOSITIES] = {
    [VISCOSITY_NONE] = {.none = true},
    [VISCOSITY_TIME_DEPENDENT] = {.evolves = true},
    [VISCOSITY_RECONSTRUCTED] = {.midpoint = true, .slope = true},
    [VISCOSITY_CULLEN_DEHNEN] = {.jumps = true, .slope = true},
    [VISCOSITY_PROJECTED] = {.midpoint = true, .noise = true, .slope = true},
};
