/* SPDX-License-Identifier: GPL-3.0-or-later
 * Conservation through time: sums over all particles after steps of a run, thinned evenly so that
 * any number of steps fits. */
#ifndef SPHPROOF_TRACE_H
#define SPHPROOF_TRACE_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "simulation.h"

enum { TRACE_MAX = 128 };

/* Begins as {0}. */
struct trace {
    size_t count;
    uint64_t stride; /* steps between two entries; a power of two */
    double time[TRACE_MAX + 1];
    struct conservation sums[TRACE_MAX + 1]; /* the first is the start */
};

/* Differences from the start, relative and >= 0: of mass and energy to their start; momentum in
 * units of sum |p| at the end or, where that vanishes, of mass times sound speed; angular momentum
 * in units of sum |r x p| or of the same. */
struct trace_drift {
    double mass, momentum, angular_momentum, energy;
};
struct trace_drift trace_drift(const struct conservation *start, const struct conservation *now,
                               const struct conservation *end);

/* Is this step to be kept? The start is step 0. */
bool trace_wants(const struct trace *trace, uint64_t step);
void trace_add(struct trace *trace, double time, const struct conservation *sums);

/* {"time", "mass", "momentum", "energy": arrays of the drift}. New reference. */
json_t *trace_json(const struct trace *trace);

#endif
