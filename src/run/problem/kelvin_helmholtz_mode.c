/* SPDX-License-Identifier: GPL-3.0-or-later
 * Kelvin-Helmholtz instability from an exact mode of linear theory: two smooth shear layers at a
 * quarter and three quarters of the height of a periodic box, and `waves` wavelengths of the
 * fastest growing mode. Times scale with the side of the box. Particles of equal spacing whose
 * masses follow the density. */
#include <math.h>

#include "initial.h"
#include "mode.h"

/* Densities and speeds of the streams, and the half width of the layers. */
static const struct layer usual = {
    .width = 0.05, .rho = 1.5, .rho_step = 0.5, .U = 0.5, .P = 2.5, .periodic = true};

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    const double height = domain_length(&p->domain, 1);
    struct layer layer = usual;
    if (problem_check_square(p, error)) return error->status;
    layer.gamma = p->gamma;
    layer.k = 2 * M_PI * settings_real(settings, SETTING_waves);
    layer.pressure_node = settings_choice(settings, SETTING_parity) == PARITY_SINUOUS;
    const double origin[2] = {p->domain.lo[0], p->domain.lo[1] + 0.25 * height};
    return mode_prepare(p, &layer, origin, height, layer.U, settings, error);
}

const struct problem problem_kelvin_helmholtz_mode = {
    .member = {"kelvin_helmholtz_mode", "smooth shear layers and their growing mode",
               "Chandrasekhar 1961"},
    .reference = "linear_mode",
    .least_dim = 2,
    .most_dim = 2,
    .carried = true,
    .fieldless = true,
    .smooth = true,
    PROBLEM_KEYS({SETTING_amplitude, ROLE_OPTIONAL}, {SETTING_waves, ROLE_OPTIONAL},
                 {SETTING_parity, ROLE_OPTIONAL}),
    .prepare = prepare,
    .sample = mode_sample,
    .fill = initial_fill,
    .functionals = {&mode_amplitude, &mode_error, &mode_noise, &mode_other_parity},
    .growing = &mode_growing,
};
