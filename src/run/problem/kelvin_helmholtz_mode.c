/* SPDX-License-Identifier: GPL-3.0-or-later
 * Kelvin & Helmholtz's instability from an exact mode of its linear theory: two smooth shear layers
 * in a periodic box, at a quarter and at three quarters of its height, and `waves` wavelengths of
 * the mode that grows fastest. In a box of another side than 1 all takes as many times as long.
 * Particles of equal spacing, whose masses follow the density. */
#include <math.h>

#include "initial.h"
#include "mode.h"

/* Density and speed on either side of the layers, and their half width. */
static const struct layer usual = {
    .width = 0.05, .rho = 1.5, .rho_step = 0.5, .U = 0.5, .P = 2.5, .periodic = true};

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    const double width = domain_length(&p->domain, 0), height = domain_length(&p->domain, 1);
    struct layer layer = usual;
    if (fabs(width - height) > 1e-12 * width)
        return error_set(
            error, STATUS_BAD_INPUT,
            "lo, hi: the layers lie in a square box, and this one has sides of %g and %g", width,
            height);
    layer.gamma = p->gamma;
    layer.k = 2 * M_PI * settings_real(settings, SETTING_waves);
    layer.pressure_node = settings_choice(settings, SETTING_parity) == PARITY_SINUOUS;
    const double origin[2] = {p->domain.lo[0], p->domain.lo[1] + 0.25 * height};
    return mode_prepare(p, &layer, origin, height, layer.U, settings, error);
}

static const struct problem_key keys[] = {{SETTING_amplitude, ROLE_OPTIONAL},
                                          {SETTING_waves, ROLE_OPTIONAL},
                                          {SETTING_parity, ROLE_OPTIONAL}};

const struct problem problem_kelvin_helmholtz_mode = {
    .member = {"kelvin_helmholtz_mode", "smooth shear layers and their growing mode",
               "Chandrasekhar 1961"},
    .reference = "linear_mode",
    .least_dim = 2,
    .most_dim = 2,
    .carried = true,
    .fieldless = true,
    .smooth = true,
    .keys = keys,
    .key_count = sizeof keys / sizeof *keys,
    .prepare = prepare,
    .sample = mode_sample,
    .fill = initial_fill,
    .random = initial_is_shaken,
    .functionals = {&mode_amplitude, &mode_error, &mode_noise, &mode_other_parity},
    .growing = &mode_growing,
};
