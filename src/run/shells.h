/* SPDX-License-Identifier: GPL-3.0-or-later
 * Density in spherical shells around the window's centre, to find the position and height of a
 * shock in radial flows. Averages over all directions, since single particles scatter. */
#pragma once

#include "problem.h"

enum { SHELLS_MAX = 512 };

struct shells {
    size_t n;
    double width;
    double density[SHELLS_MAX]; /* mass over volume of the particles in a shell; NaN: no particle */
};

/* Shells as thick as the mean particle spacing in the window, from the centre to the nearest end of
 * the domain. */
void shells_make(struct shells *shells, const struct prepared *p, const struct snapshot *s);

/* The largest density of any shell. */
double shells_peak(const struct shells *shells);

/* The outermost radius at which the density reaches the level, by linear interpolation between the
 * middles of shells. NaN: nowhere. */
double shells_crossing(const struct shells *shells, double level);

/* Mass over volume of the particles with lo <= r < hi; NaN: no particle. */
double shells_mean(const struct prepared *p, const struct snapshot *s, double lo, double hi);
