/* SPDX-License-Identifier: GPL-3.0-or-later
 * What problems of weakly compressible liquids share. Their exact flows are incompressible: of
 * velocities known, of density and pressure only where gravity alone makes them. What a code takes
 * for internal energy does not matter; initial states carry that of a gas with the liquid's speed
 * of sound. */
#pragma once

#include "functional.h"
#include "problem.h"

/* Keys of all of them. */
#define LIQUID_KEYS                                                                                \
    {SETTING_rho0, ROLE_OPTIONAL},                                                                 \
    {                                                                                              \
        SETTING_sound, ROLE_OPTIONAL                                                               \
    }

/* Only the velocity is known. */
#define LIQUID_UNKNOWN                                                                             \
    {                                                                                              \
        [FIELD_DENSITY] = true, [FIELD_PRESSURE] = true, [FIELD_INTERNAL_ENERGY] = true            \
    }

struct liquid {
    double rho0, sound;
};
struct liquid liquid_of(const struct settings *settings);

/* At rest, with the liquid's density rho0. */
struct problem_state liquid_state(const struct liquid *liquid, double gamma);

/* By volume over the window, sum v . mode over sum mode . mode: how much of the mode there is. */
typedef void liquid_mode(const struct prepared *p, const double x[3], double v[3]);
double liquid_amplitude(const struct prepared *p, const struct snapshot *s, liquid_mode *mode);
