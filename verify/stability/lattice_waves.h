/* SPDX-License-Identifier: GPL-3.0-or-later
 * Linear stability of a scheme on a lattice in 2D or 3D, by differences of the solver's own
 * evaluation: a wave of displacements X e cos(k . x), with the internal energy changed as by the
 * scheme's own rates and with h that satisfies the density sum, causes forces -m (D e) X cos(k .
 * x), and the eigenvalues of D(k) are omega^2 of the d waves of that k. Exact for any Bravais
 * lattice that fits the periodic box, for every kernel, gradient and formulation without
 * viscosity. */
#pragma once

#include "initial.h"
#include "run.h"

struct lattice_waves {
    struct run run; /* of gas at rest, undisturbed: viscosity none, energy internal */
    struct initial at_rest;
    int dim;
    double spacing, c; /* (box/n)^(1/d), sound speed: the units of growth are c/spacing */
};

/* STATUS_BAD_INPUT: the settings have no such lattice. Call lattice_waves_free even after a
 * failure. */
enum status lattice_waves_begin(struct lattice_waves *lattice, const struct run_settings *settings,
                                struct error *error);
void lattice_waves_free(struct lattice_waves *lattice);

/* The wave with whole[d] wavelengths across the box in each direction: its fastest growth (0:
 * stable), and the greatest frequency among its d waves; in c/spacing. */
struct lattice_wave {
    double growth, frequency;
};
enum status lattice_waves_at(const struct lattice_waves *lattice, const int whole[3],
                             struct lattice_wave *wave, struct error *error);

/* The largest growth and the largest frequency of all waves in the box (for square and cubic
 * lattices one wave of each symmetric set); *where: the wave with the largest growth. */
enum status lattice_waves_worst(const struct lattice_waves *lattice, struct lattice_wave *worst,
                                int where[3], struct error *error);
