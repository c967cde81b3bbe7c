/* SPDX-License-Identifier: GPL-3.0-or-later
 * Shared by problems of weakly compressible liquids. Their exact flows are incompressible:
 * velocities are known, density and pressure only for a hydrostatic state. The internal energy does
 * not matter; initial states have that of a gas with the liquid's sound speed. */
#pragma once

#include "functional.h"
#include "problem.h"

/* Keys of all liquid problems. */
#define LIQUID_KEYS                                                                                \
    {SETTING_rho0, ROLE_OPTIONAL},                                                                 \
    {                                                                                              \
        SETTING_sound, ROLE_OPTIONAL                                                               \
    }

/* Fields without exact values: all but the velocity. */
#define LIQUID_UNKNOWN                                                                             \
    {                                                                                              \
        [FIELD_DENSITY] = true, [FIELD_PRESSURE] = true, [FIELD_INTERNAL_ENERGY] = true            \
    }

struct liquid {
    double rho0, sound;
};
struct liquid liquid_of(const struct settings *settings);

/* The state at rest with density rho0. */
struct problem_state liquid_state(const struct liquid *liquid, double gamma);

/* For problems with a surface: sets automatic gravity, and checks that it is along -y. */
enum status liquid_check_gravity(struct prepared *p, const struct settings *settings,
                                 struct error *error);

/* Amplitude of a mode: sum v . mode over sum mode . mode, weighted with volume, over the window. */
typedef void liquid_mode(const struct prepared *p, const double x[3], double v[3]);
double liquid_amplitude(const struct prepared *p, const struct snapshot *s, liquid_mode *mode);
