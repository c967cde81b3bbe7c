/* SPDX-License-Identifier: GPL-3.0-or-later
 * A kernel's shape as a piecewise smooth function: break points between which w and dw are resolved
 * by Chebyshev series to round-off. Declared knots are used; undeclared ones are found by
 * bisection, so that quadrature and differentiation never straddle a break point. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "kernel.h"

enum { PIECES_NODES = 32 }; /* of a series */

/* Terms for judging a kernel: its declarations, and the effort. */
struct terms {
    bool single;             /* values in single precision: bounds at TERMS_SINGLE_BOUND */
    bool negative;           /* declared to have a negative lobe */
    bool class_found;        /* smoothness was measured, not declared */
    long samples;            /* random positions, one in each of as many equal intervals of q */
    uint64_t seed;           /* of the random positions */
    const double *constants; /* numbers in ]0, 1[ from its code; not owned */
    int constant_count;
};

#define TERMS_SINGLE_BOUND 1e-6

/* Double precision, nothing declared, a few samples. */
extern const struct terms pieces_terms_usual;

/* Number of values stored from the first calls. */
enum { PIECES_FIRST = 64 };
struct pieces_first {
    double q, w, dw, dh;
};

struct pieces {
    const struct kernel *kernel; /* not owned */
    int dim;
    struct terms terms;
    double epsilon, tolerance, width_min; /* for the precision of the terms */
    int n;                                /* pieces */
    double *edge;                         /* n + 1 break points: 0, ..., 1 */
    bool *declared;                       /* n + 1: a declared knot, the origin or the edge */
    double *doubt;                        /* n + 1: uncertainty of a break point that was found */
    bool resolved; /* false: noise or a singularity somewhere, which error estimates include */
    double max_w, max_dw;     /* largest |w|, |dw| found in [0, 1] */
    double noise_w, noise_dw; /* noise of the series: round-off of the evaluation */
    double grain;             /* typical relative error of w, in units of max_w */
    double *places;           /* place_count, increasing; see places.h */
    int place_count;
    struct pieces_first first[PIECES_FIRST];
    double node[PIECES_NODES];                 /* of a series, on x in ]-1, 1[ */
    double cosine[PIECES_NODES][PIECES_NODES]; /* T_k(node j) at [j][k] */
};

/* Chebyshev series of a smooth function on an interval, chopped at the noise level. */
struct series_fit {
    double c[PIECES_NODES];
    int n;        /* terms kept */
    int reach;    /* terms that may have an error of the noise */
    double noise; /* of a coefficient */
};

/* Finds the pieces of a kernel in dim dimensions; terms NULL: pieces_terms_usual.
 * STATUS_ENVIRONMENT: no memory. Free with pieces_free; kernel must outlive pieces. */
enum status pieces_find(struct pieces *pieces, const struct kernel *kernel, int dim,
                        const struct terms *terms, struct error *error);
void pieces_free(struct pieces *pieces);

/* True if the kernel's values have rounding errors of single precision. */
bool pieces_look_single(const struct pieces *pieces);

/* The series of w (dw) on piece p. */
void pieces_series(const struct pieces *pieces, int p, struct series_fit *w, struct series_fit *dw);

/* The series through values[j] at the nodes. */
void pieces_fit(const struct pieces *pieces, const double values[PIECES_NODES],
                struct series_fit *fit);

/* The series at x. */
double pieces_series_value(const struct series_fit *fit, double x);

/* d/dx of the series at x; floor: its error due to noise. */
double pieces_series_slope(const struct series_fit *fit, double x, double *floor);

/* k-th derivative of w at q = at from the side of `to`, the far end of the piece. k = 0 uses w,
 * other k the (k-1)-th derivative of dw. floor: estimate of the error (not a bound). */
double pieces_derivative(const struct pieces *pieces, double at, double to, int k, double *floor);
