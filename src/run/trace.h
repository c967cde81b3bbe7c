/* SPDX-License-Identifier: GPL-3.0-or-later
 * Time series of a run: conservation sums after steps, thinned evenly so that any number of steps
 * fits, and the regularity of the particles at a few evenly spaced times. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "regularity.h"
#include "simulation.h"

enum { TRACE_MAX = 128, TRACE_LOOKS = 16 };

/* Starts as {0}. */
struct trace {
    size_t count;
    uint64_t stride; /* steps between entries; a power of two */
    double time[TRACE_MAX + 1];
    struct conservation sums[TRACE_MAX + 1]; /* the first is that of the start */
    size_t looks;
    double looked[TRACE_LOOKS + 2]; /* times: the start, the first steps at or after evenly spaced
                                       times, the end */
    struct regularity seen[TRACE_LOOKS + 2];
};

/* Relative differences from the start, >= 0: mass and energy over their initial values; momentum
 * over sum |p| at the end, angular momentum over sum |r x p|, or, where such a sum vanishes, the
 * same with the sound speed for the velocity. */
struct trace_drift {
    double mass, momentum, angular_momentum, energy;
};
struct trace_drift trace_drift(const struct conservation *start, const struct conservation *now,
                               const struct conservation *end);

/* Errors of the motion that the final error does not show (CONVENTIONS.md, section 6). NaN: fewer
 * than two entries; the first two also if nothing moves at the start. */
struct trace_motion {
    double rebound;   /* largest rise of the kinetic energy above its previous minimum, over its
                         initial value */
    double asymmetry; /* largest |K(t) - K(t_end - t)| over K(0) */
    double centre;    /* largest distance of the centre of mass from its initial uniform motion; a
                         length */
};
struct trace_motion trace_motion(const struct trace *trace);

/* The largest drift of all entries; NaN: fewer than two. */
struct trace_drift trace_worst(const struct trace *trace);

/* Names of the conserved quantities in "conservation" of results; the number of a figure is its
 * index. */
enum { TRACE_FIGURES = 7 };
extern const char *const trace_figures[TRACE_FIGURES];
/* The number of a figure by name; TRACE_FIGURES: no such figure. */
size_t trace_figure(const char *name);

/* True if this step is to be recorded. The start is step 0. */
bool trace_wants(const struct trace *trace, uint64_t step);
void trace_add(struct trace *trace, double time, const struct conservation *sums);

/* True if regularity is to be measured at this time of a run to t_end, always so at the start and
 * the end. */
bool trace_looks(const struct trace *trace, double time, double t_end);
void trace_see(struct trace *trace, double time, const struct regularity *regularity);
