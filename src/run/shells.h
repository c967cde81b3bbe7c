/* SPDX-License-Identifier: GPL-3.0-or-later
 * Density in shells round the window's centre, of flows that run towards it or from it: where a
 * shock is, how high it stands. Means over all directions, since single particles scatter. */
#pragma once

#include "problem.h"

enum { SHELLS_MAX = 512 };

struct shells {
    size_t n;
    double width;
    double density[SHELLS_MAX]; /* mass over volume of the particles in a shell; NaN: none */
};

/* Shells as thick as the particles in the window are apart in the mean, from the centre to the
 * nearest end of the domain. */
void shells_make(struct shells *shells, const struct prepared *p, const struct snapshot *s);

/* The greatest density of a shell. */
double shells_peak(const struct shells *shells);

/* Radius at which the density, seen from outside, first comes up to the level: straight lines
 * between the middles of shells. NaN: nowhere. */
double shells_crossing(const struct shells *shells, double level);

/* Mass over volume of all particles with lo <= r < hi; NaN: none. */
double shells_mean(const struct prepared *p, const struct snapshot *s, double lo, double hi);
