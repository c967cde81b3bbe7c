/* SPDX-License-Identifier: GPL-3.0-or-later
 * Rayleigh-Taylor instability from an exact mode of linear theory: dense gas over thin gas in
 * hydrostatic equilibrium between walls, joined by a smooth layer in the middle of the box, and
 * `waves` wavelengths of the fastest growing mode. Lengths and times scale with the height of the
 * box, gravity with its inverse. Particles of equal spacing whose masses follow the density. */
#include <math.h>

#include "initial.h"
#include "mode.h"

/* In the middle of the layer; rho_step is the change to either side. */
static const struct layer usual = {
    .width = 0.05, .rho = 1.5, .rho_step = 0.5, .P = 2.5, .g = 0.5, .wall = 0.5};

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    const double width = domain_length(&p->domain, 0), height = domain_length(&p->domain, 1);
    const double origin[2] = {p->domain.lo[0], p->domain.lo[1] + 0.5 * height};
    struct layer layer = usual;
    if (settings->value[SETTING_gravity].automatic) p->gravity[1] = -usual.g / height;
    if (p->gravity[0] != 0 || !(p->gravity[1] < 0))
        return error_set(error, STATUS_BAD_INPUT,
                         "gravity=\"%g %g\": the dense gas is above, and gravity has to pull it "
                         "down: 0 along x and less than 0 along y",
                         p->gravity[0], p->gravity[1]);
    layer.gamma = p->gamma;
    layer.g = -p->gravity[1] * height;
    layer.k = 2 * M_PI * settings_real(settings, SETTING_waves) * height / width;
    /* speed of free fall over a wavelength */
    const double speed = sqrt(2 * M_PI * layer.g / layer.k);
    return mode_prepare(p, &layer, origin, height, speed, settings, error);
}

const struct problem problem_rayleigh_taylor_mode = {
    .member = {"rayleigh_taylor_mode", "dense gas over thin gas and its growing mode",
               "Chandrasekhar 1961"},
    .reference = "linear_mode",
    .least_dim = 2,
    .most_dim = 2,
    .fieldless = true,
    .heavy = true,
    .smooth = true,
    .ends = {{0}, {.usual = BOUNDARY_REFLECTING, .also = PROBLEM_END(FIXED)}},
    PROBLEM_KEYS({SETTING_amplitude, ROLE_OPTIONAL}, {SETTING_waves, ROLE_OPTIONAL}),
    .prepare = prepare,
    .sample = mode_sample,
    .fill = initial_fill,
    .functionals = {&mode_amplitude, &mode_error, &mode_noise},
    .growing = &mode_growing,
};
