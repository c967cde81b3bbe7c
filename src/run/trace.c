/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "trace.h"

#include <math.h>
#include <string.h>

const char *const trace_figures[TRACE_FIGURES] = {
    "mass", "momentum", "angular_momentum", "energy", "ke_rebound", "ke_asymmetry", "centre"};

size_t trace_figure(const char *name)
{
    size_t k = 0;
    while (k < TRACE_FIGURES && strcmp(trace_figures[k], name) != 0) k++;
    return k;
}

bool trace_wants(const struct trace *trace, uint64_t step)
{
    return trace->stride == 0 || step % trace->stride == 0;
}

/* Keeps every second entry, including the start. */
static void thin(struct trace *trace)
{
    size_t kept = 0;
    for (size_t k = 0; k < trace->count; k += 2) {
        trace->time[kept] = trace->time[k];
        trace->sums[kept++] = trace->sums[k];
    }
    trace->count = kept;
    trace->stride *= 2;
}

void trace_add(struct trace *trace, double time, const struct conservation *sums)
{
    if (trace->stride == 0) trace->stride = 1;
    /* the last step of a run and its end are both reported: keep one entry per time */
    if (trace->count && trace->time[trace->count - 1] == time) trace->count--;
    trace->time[trace->count] = time;
    trace->sums[trace->count++] = *sums;
    if (trace->count > TRACE_MAX) thin(trace);
}

/* |a - b| over scale, or over `other` if scale is negligible. */
static double change(const double a[3], const double b[3], double scale, double other)
{
    const double squares = (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]);
    const double first = fabs(a[0] - b[0]);
    const double size = squares > 0 ? sqrt(first * first + squares) : first;
    return size / (scale > 1e-12 * other ? scale : other);
}

struct trace_drift trace_drift(const struct conservation *start, const struct conservation *now,
                               const struct conservation *end)
{
    return (struct trace_drift){
        .mass = fabs(now->mass - start->mass) / start->mass,
        .momentum = change(now->momentum, start->momentum, end->momentum_scale, end->sound_scale),
        .angular_momentum = change(now->angular_momentum, start->angular_momentum,
                                   end->angular_scale, end->turning_scale),
        .energy = fabs(now->energy - start->energy) / fabs(start->energy),
    };
}

struct trace_drift trace_worst(const struct trace *trace)
{
    const double none = trace->count < 2 ? (double)NAN : 0;
    struct trace_drift worst = {none, none, none, none};
    for (size_t k = 1; k < trace->count; k++) {
        const struct trace_drift drift =
            trace_drift(&trace->sums[0], &trace->sums[k], &trace->sums[trace->count - 1]);
        worst.mass = fmax(worst.mass, drift.mass);
        worst.momentum = fmax(worst.momentum, drift.momentum);
        worst.angular_momentum = fmax(worst.angular_momentum, drift.angular_momentum);
        worst.energy = fmax(worst.energy, drift.energy);
    }
    return worst;
}

/* By linear interpolation between entries. */
static double kinetic_at(const struct trace *trace, double time)
{
    size_t k = 1;
    while (k + 1 < trace->count && trace->time[k] < time) k++;
    const double from = trace->time[k - 1], part = (time - from) / (trace->time[k] - from);
    return (1 - part) * trace->sums[k - 1].kinetic + part * trace->sums[k].kinetic;
}

struct trace_motion trace_motion(const struct trace *trace)
{
    const struct conservation *sums = trace->sums;
    const double *time = trace->time, start = sums[0].kinetic;
    struct trace_motion motion = {(double)NAN, (double)NAN, (double)NAN};
    double least = start, way[3] = {0};
    if (trace->count < 2) return motion;
    const bool moves = start > 1e-12 * fabs(sums[0].energy);
    motion.centre = 0;
    if (moves) motion.rebound = motion.asymmetry = 0;
    for (size_t k = 1; k < trace->count; k++) {
        const double mirrored = time[0] + time[trace->count - 1] - time[k];
        const double step = time[k] - time[k - 1];
        double squares = 0;
        for (int d = 0; d < 3; d++) {
            way[d] += step *
                      (0.5 * (sums[k].momentum[d] + sums[k - 1].momentum[d]) - sums[0].momentum[d]);
            squares += way[d] * way[d];
        }
        motion.centre = fmax(motion.centre, sqrt(squares) / sums[0].mass);
        if (!moves) continue;
        least = fmin(least, sums[k].kinetic);
        motion.rebound = fmax(motion.rebound, (sums[k].kinetic - least) / start);
        motion.asymmetry =
            fmax(motion.asymmetry, fabs(sums[k].kinetic - kinetic_at(trace, mirrored)) / start);
    }
    return motion;
}

bool trace_looks(const struct trace *trace, double time, double t_end)
{
    return trace->looks <= TRACE_LOOKS &&
           time >= t_end * (double)trace->looks / (double)TRACE_LOOKS;
}

void trace_see(struct trace *trace, double time, const struct regularity *regularity)
{
    /* as in trace_add */
    if (trace->looks && trace->looked[trace->looks - 1] == time) trace->looks--;
    trace->looked[trace->looks] = time;
    trace->seen[trace->looks++] = *regularity;
}
