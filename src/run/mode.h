/* SPDX-License-Identifier: GPL-3.0-or-later
 * Shared by problems that start from a growing mode of a layer (layer_mode.h): a base state plus
 * the real part of the mode with a small amplitude. For t > 0 the fields are those of linear
 * theory, exact up to the square of the amplitude. The growth rate and the shape of the mode are
 * judged. The amplitude of the mode in a state is the projection of v_y,
 *   c = 2 sum V conj(f) v_y/sum V |f|^2,  f = v(y) exp(i k x),
 * which excludes the opposite parity in a periodic layer. */
#pragma once

#include "layer_mode.h"
#include "problem.h"

/* The private part of a prepared problem. Multiply lengths and times of the mode by `length` to get
 * those of the problem; velocities, densities and pressures are equal. */
struct mode_start {
    struct layer_mode mode;
    double origin[2], length;
    double amplitude; /* largest |v_y| at the start */
};

/* Fills p->own. speed: the unit of the key amplitude. STATUS_BAD_INPUT: no such layer, no growing
 * mode, or a mode that does not double before it stops being small. */
enum status mode_prepare(struct prepared *p, const struct layer *layer, const double origin[2],
                         double length, double speed, struct settings *settings,
                         struct error *error);

/* Implements the problems' sample. */
void mode_sample(const struct prepared *p, const double x[3], double t,
                 struct problem_state *state);

/* Functionals: |c|; the rms error of the eigenfunction, from the part of v_y with the mode's
 * wavelength relative to c v(y), in 32 bins of the height; the rms of v_y without the mode,
 * relative to the mode; for periodic layers, the amplitude of the opposite parity over |c|. */
extern const struct functional mode_amplitude, mode_error, mode_noise, mode_other_parity;

/* growth_rate, measured from twice the initial amplitude until the layer is displaced by a tenth of
 * its width. */
extern const struct growing mode_growing;
