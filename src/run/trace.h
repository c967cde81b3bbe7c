/* SPDX-License-Identifier: GPL-3.0-or-later
 * Conservation through time: sums over all particles after steps of a run, thinned evenly so that
 * any number of steps fits; and how regular particles stand, at a few even times. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "regularity.h"
#include "simulation.h"

enum { TRACE_MAX = 128, TRACE_LOOKS = 16 };

/* Begins as {0}. */
struct trace {
    size_t count;
    uint64_t stride; /* steps between two entries; a power of two */
    double time[TRACE_MAX + 1];
    struct conservation sums[TRACE_MAX + 1]; /* the first is the start */
    size_t looks;
    double looked[TRACE_LOOKS + 2]; /* times: start, first steps at or after even ones, end */
    struct regularity seen[TRACE_LOOKS + 2];
};

/* Differences from the start, relative and >= 0: of mass and energy to their start; momentum in
 * units of sum |p| at the end or, where that vanishes, of mass times sound speed; angular momentum
 * in units of sum |r x p| or of the same. */
struct trace_drift {
    double mass, momentum, angular_momentum, energy;
};
struct trace_drift trace_drift(const struct conservation *start, const struct conservation *now,
                               const struct conservation *end);

/* What an error at the end does not show (CONVENTIONS.md, section 6). NaN: fewer than two entries,
 * or nothing moves at the start. */
struct trace_motion {
    double rebound; /* largest rise of the kinetic energy above its least before, over its start */
    double asymmetry; /* largest |K(t) - K(t_end - t)| over K(0) */
    double centre;    /* how far the centre of mass is away from where its first velocity leads it:
                         a length, the largest */
};
struct trace_motion trace_motion(const struct trace *trace);

/* The largest drift of all entries. */
struct trace_drift trace_worst(const struct trace *trace);

/* Names of what is conserved, as "conservation" in results has them, and each by its number. */
enum { TRACE_FIGURES = 7 };
extern const char *const trace_figures[TRACE_FIGURES];
/* The number of a name; TRACE_FIGURES: there is no such figure. */
size_t trace_figure(const char *name);

/* Is this step to be kept? The start is step 0. */
bool trace_wants(const struct trace *trace, uint64_t step);
void trace_add(struct trace *trace, double time, const struct conservation *sums);

/* Is regularity to be seen at this time of a run to t_end? The start and the end always are. */
bool trace_looks(const struct trace *trace, double time, double t_end);
void trace_see(struct trace *trace, double time, const struct regularity *regularity);
