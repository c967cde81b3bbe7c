/* SPDX-License-Identifier: GPL-3.0-or-later
 * w and dw between the nodes of the Chebyshev series: compared with the series of their piece at
 * one random position in each of many equal intervals, repeatedly around the worst of them, and
 * where a formula is likely to change. Also tests whether equal arguments give equal values after
 * all those calls. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "places.h"
#include "property.h"

/* The error estimate of the series is a typical, not a largest error. */
static const double margin = 40;

/* Visits positions in ascending order; the series belong to the current piece. */
struct walk {
    const struct pieces *pieces;
    int piece; /* -1: before the first */
    struct series_fit w, dw;
    struct property_worst *value, *slope;
};

static void go_to(struct walk *walk, double q)
{
    const struct pieces *pieces = walk->pieces;
    int p = walk->piece < 0 || q < pieces->edge[walk->piece] ? 0 : walk->piece;
    while (p + 1 < pieces->n && q >= pieces->edge[p + 1]) p++;
    if (p == walk->piece) return;
    walk->piece = p;
    pieces_series(pieces, p, &walk->w, &walk->dw);
}

/* Compares at q; returns the larger ratio to the bound of w and dw. */
static double look(struct walk *walk, double q)
{
    const struct pieces *pieces = walk->pieces;
    const struct kernel *kernel = pieces->kernel;
    go_to(walk, q);
    const double a = pieces->edge[walk->piece], b = pieces->edge[walk->piece + 1];
    const double x = fmin(1, 2 * (q - a) / (b - a) - 1), cap = pieces->terms.single ? 1e-4 : 1e-7;
    const struct {
        const char *name;
        double got, scale;
        const struct series_fit *fit;
        struct property_worst *worst;
    } list[] = {
        {"w", kernel->w(kernel, q, pieces->dim), pieces->max_w, &walk->w, walk->value},
        {"dw", kernel->dw(kernel, q, pieces->dim), pieces->max_dw, &walk->dw, walk->slope},
    };
    double ratio = 0;
    for (int i = 0; i < 2; i++) {
        const struct series_fit *fit = list[i].fit;
        const double error = fabs(list[i].got - pieces_series_value(fit, x)) / list[i].scale;
        const double floor = fit->noise * fit->reach / list[i].scale + pieces->epsilon;
        const double bound = fmin(margin * floor, cap);
        ratio = fmax(ratio, isnan(error) ? (double)INFINITY : error / bound);
        property_keep(list[i].worst, error, bound, floor, "%s at q = %.17g", list[i].name, q);
    }
    return ratio;
}

enum { WORST = 16 };

/* The positions nearest to failing so far, one per interval. */
struct nearest {
    double q[WORST], ratio[WORST];
};

static void remember(struct nearest *nearest, double q, double ratio)
{
    int least = 0;
    for (int i = 1; i < WORST; i++)
        if (nearest->ratio[i] < nearest->ratio[least]) least = i;
    if (!(ratio > nearest->ratio[least])) return;
    nearest->q[least] = q;
    nearest->ratio[least] = ratio;
}

/* Searches closer and closer to q: the flanks of a narrow fault lead to it. */
static void close_in(struct walk *walk, double q, double width, uint64_t seed)
{
    enum { LEVELS = 8, TRIES = 64 };
    uint64_t count = 0;
    double best = 0;
    for (int level = 0; level < LEVELS; level++, width /= 8) {
        const double centre = q;
        for (int i = 0; i < TRIES; i++) {
            const double at = centre + width * (2 * places_random(seed, count++) - 1);
            if (!(at >= 0 && at < 1)) continue;
            const double ratio = look(walk, at);
            if (ratio > best) best = ratio, q = at;
        }
    }
}

static void look_at_random(struct walk *walk)
{
    const struct terms *terms = &walk->pieces->terms;
    struct nearest nearest = {0};
    const double width = 1. / (double)terms->samples;
    for (long i = 0; i < terms->samples; i++) {
        const double q = ((double)i + places_random(terms->seed, (uint64_t)i)) * width;
        if (q < 1) remember(&nearest, q, look(walk, q));
    }
    for (int i = 0; i < WORST; i++)
        close_in(walk, nearest.q[i], 2 * width, terms->seed + 1 + (uint64_t)i);
}

static void look_at_places(struct walk *walk)
{
    for (int i = 0; i < walk->pieces->place_count; i++) look(walk, walk->pieces->places[i]);
}

void property_between(const struct pieces *pieces, struct property_sink *sink)
{
    void (*const ways[])(struct walk *) = {look_at_random, look_at_places};
    for (int i = 0; i < 2; i++) {
        struct property_worst value = {0}, slope = {0};
        struct walk walk = {.pieces = pieces, .piece = -1, .value = &value, .slope = &slope};
        ways[i](&walk);
        property_take_worst(sink, &value);
        property_take_worst(sink, &slope);
    }
}

static double differs(double now, double then, double scale)
{
    uint64_t bits[2];
    memcpy(&bits[0], &now, sizeof now);
    memcpy(&bits[1], &then, sizeof then);
    return bits[0] != bits[1] ? fmax(fabs(now - then) / scale, DBL_TRUE_MIN) : 0;
}

void property_runs(const struct pieces *pieces, struct property_sink *sink)
{
    const struct kernel *kernel = pieces->kernel;
    const int dim = pieces->dim;
    const long rounds = 1 + pieces->terms.samples / (4 * PIECES_FIRST);
    struct property_worst worst = {0};
    for (long round = 0; round < rounds; round++)
        for (int i = 0; i < PIECES_FIRST; i++) {
            const struct pieces_first *then = &pieces->first[i];
            const double q = then->q;
            property_keep(&worst, differs(kernel->w(kernel, q, dim), then->w, pieces->max_w), 0, 0,
                          "w(%.6g) against its first value", q);
            property_keep(&worst, differs(kernel->dw(kernel, q, dim), then->dw, pieces->max_dw), 0,
                          0, "dw(%.6g) against its first value", q);
            property_keep(&worst, differs(kernel_dh(kernel, q, 1, dim), then->dh, pieces->max_w), 0,
                          0, "dW/dh(%.6g) at h = 1 against its first value", q);
        }
    property_take_worst(sink, &worst);
}
