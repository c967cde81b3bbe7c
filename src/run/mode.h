/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the problems share that start from a growing mode of a layer (layer_mode.h): a base state
 * and the real part of the mode, as small as asked. Fields of t > 0 are those of linear theory,
 * exact to the square of the amplitude; judged are the rate at which the mode grows, and its shape.
 * The amplitude of the mode in a state is the projection of v_y on it,
 *   c = 2 sum V conj(f) v_y/sum V |f|^2,  f = v(y) exp(i k x),
 * in which nothing of the other parity of a periodic layer is left. */
#pragma once

#include "layer_mode.h"
#include "problem.h"

/* The own part of a prepared problem. Lengths and times of the mode times `length` are those of the
 * problem; its velocities, densities and pressures are the same. */
struct mode_start {
    struct layer_mode mode;
    double origin[2], length;
    double amplitude; /* the greatest |v_y| at the start */
};

/* Fills p->own. speed: what the key amplitude is a part of. STATUS_BAD_INPUT: no such layer, no
 * growing mode, or one that does not grow to twice its start while it is small. */
enum status mode_prepare(struct prepared *p, const struct layer *layer, const double origin[2],
                         double length, double speed, struct settings *settings,
                         struct error *error);

/* The problems' sample. */
void mode_sample(const struct prepared *p, const double x[3], double t,
                 struct problem_state *state);

/* Functionals: |c|; the error of the eigenfunction, of the part of v_y with the mode's wavelength,
 * relative to c v(y), rms over 32 parts of the height; all of v_y that is not the mode, over the
 * mode, rms; the part of the other parity over |c|, of periodic layers. */
extern const struct functional mode_amplitude, mode_error, mode_noise, mode_other_parity;

/* growth_rate, from twice the start until the layer is displaced by a tenth of its width. */
extern const struct growing mode_growing;
