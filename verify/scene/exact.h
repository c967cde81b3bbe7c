/* SPDX-License-Identifier: GPL-3.0-or-later
 * The exact solution that belongs to a run's settings, and how long its measure window stays free
 * of the mirrored tube that starts at the ends of the periodic box. */
#ifndef SPHPROOF_EXACT_H
#define SPHPROOF_EXACT_H

#include "cases.h"
#include "riemann.h"
#include "settings.h"
#include "simple_wave.h"
#include "status.h"

struct exact {
    enum kind kind;
    double lo, hi, x0; /* box; start of the main Riemann problem */
    struct riemann_solution tube, mirror;
    struct simple_wave wave;
};

/* settings: resolved. STATUS_BAD_INPUT: no exact solution exists, with the reason. */
enum status exact_prepare(struct exact *exact, const struct settings *settings,
                          struct error *error);

/* All fields at x and time t, in the order of enum field. Where the exact gas is a vacuum: density,
 * pressure and internal energy 0, and the velocity that joins its edges, (x - x0)/t. */
void exact_sample(const struct exact *exact, double x, double t, double values[FIELDS]);

/* Means of a field over each of bins equal parts of the window at t, to 1e-10. */
void exact_means(const struct exact *exact, enum field field, double t, const double window[2],
                 size_t bins, double *means);

/* STATUS_BAD_INPUT where the window is not free at t: names where the mirrored tube's waves are and
 * the longest time that is allowed (or that a simple wave has broken by then). */
enum status exact_check_window(const struct exact *exact, const double window[2], double t,
                               struct error *error);

#endif
