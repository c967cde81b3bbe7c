/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pieces.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

enum { N = PIECES_NODES, TAIL = N / 4, LEAVES_MAX = 1 << 15 };

/* A series is resolved when its tail is below this part of the largest value. */
static const double tolerance = 4e-14;
/* Intervals with a singularity are bisected down to this width. */
static const double width_min = 1e-11;

struct leaves {
    const struct pieces *pieces;
    double *edge;
    int n;
};

double pieces_node(const struct pieces *pieces, int j)
{
    return pieces->cosine[2 * j + 1];
}

void pieces_fit(const struct pieces *pieces, const double values[PIECES_NODES],
                struct series_fit *fit)
{
    double largest = 0, tail = 0;
    for (int j = 0; j < N; j++) largest = fmax(largest, fabs(values[j]));
    for (int k = 0; k < N; k++) {
        double sum = 0;
        for (int j = 0; j < N; j++) sum += values[j] * pieces->cosine[k * (2 * j + 1) % (4 * N)];
        fit->c[k] = (k ? 2. : 1.) / N * sum;
        if (!(largest <= DBL_MAX)) fit->c[k] = (double)NAN; /* an Inf or a NaN is passed on */
        if (k >= N - TAIL) tail = fmax(tail, fabs(fit->c[k]));
    }
    fit->noise = isnan(fit->c[0]) ? fit->c[0] : fmax(tail, 0.5 * DBL_EPSILON * largest);
    fit->n = N;
    while (fit->n > 1 && fabs(fit->c[fit->n - 1]) <= 2 * fit->noise) fit->n--;
    /* a tail above round-off is the trace of a break point that was found only nearly */
    fit->reach = tail > 4 * DBL_EPSILON * largest ? N : fit->n + 2;
}

double series_slope(const struct series_fit *fit, double x, double *floor)
{
    double u = 0, next = 1, sum = 0, amplified = 0; /* u = U_(j-2), next = U_(j-1) */
    for (int j = 1; j < N; j++) {
        if (j < fit->n) sum += fit->c[j] * j * next;
        if (j < fit->reach) amplified += j * fabs(next);
        const double following = 2 * x * next - u;
        u = next;
        next = following;
    }
    *floor = fit->noise * amplified;
    return sum;
}

static void sample(const struct pieces *pieces, kernel_shape *shape, double a, double b,
                   struct series_fit *fit)
{
    double values[N];
    for (int j = 0; j < N; j++)
        values[j] =
            shape(pieces->kernel, a + (b - a) / 2 * (1 + pieces_node(pieces, j)), pieces->dim);
    pieces_fit(pieces, values, fit);
}

static bool resolved(const struct pieces *pieces, double a, double b)
{
    struct series_fit w, dw;
    sample(pieces, pieces->kernel->w, a, b, &w);
    sample(pieces, pieces->kernel->dw, a, b, &dw);
    return w.noise <= tolerance * pieces->max_w && dw.noise <= tolerance * pieces->max_dw;
}

/* Bisects ]a, b[ until every leaf is resolved or too narrow; appends the leaves' right ends. */
static void bisect(struct leaves *leaves, double a, double b)
{
    if (leaves->pieces->n + leaves->n >= LEAVES_MAX) return;
    if (b - a > width_min && !resolved(leaves->pieces, a, b)) {
        bisect(leaves, a, (a + b) / 2);
        bisect(leaves, (a + b) / 2, b);
    } else {
        leaves->edge[leaves->n++] = b;
    }
}

/* Joins neighbouring leaves that are resolved together, and shrinks those too narrow to be a piece
 * (a singular point) to that point; returns the number of pieces on ]a, b[. */
static int join(const struct pieces *pieces, double a, double *edge, int n)
{
    int m = 0;
    for (int i = 0; i < n;) {
        int last = i;
        while (last + 1 < n && resolved(pieces, a, edge[last + 1])) last++;
        const bool point = edge[last] - a < 1e3 * width_min && !resolved(pieces, a, edge[last]);
        if (point && m > 0)
            edge[m - 1] = (a + edge[last]) / 2;
        else if (!point || last + 1 == n)
            edge[m++] = edge[last];
        a = edge[m ? m - 1 : 0];
        i = last + 1;
    }
    return m;
}

static void find_scale(struct pieces *pieces)
{
    enum { SAMPLES = 512 };
    for (int i = 0; i < SAMPLES; i++) {
        const double q = (i + 0.5) / SAMPLES;
        pieces->max_w =
            fmax(pieces->max_w, fabs(pieces->kernel->w(pieces->kernel, q, pieces->dim)));
        pieces->max_dw =
            fmax(pieces->max_dw, fabs(pieces->kernel->dw(pieces->kernel, q, pieces->dim)));
    }
}

/* The plateaus of all pieces; whether all are resolved. */
static void find_noise(struct pieces *pieces)
{
    pieces->resolved = true;
    for (int i = 0; i < pieces->n; i++) {
        struct series_fit w, dw;
        sample(pieces, pieces->kernel->w, pieces->edge[i], pieces->edge[i + 1], &w);
        sample(pieces, pieces->kernel->dw, pieces->edge[i], pieces->edge[i + 1], &dw);
        pieces->noise_w = !(w.noise <= pieces->noise_w) ? w.noise : pieces->noise_w;
        pieces->noise_dw = !(dw.noise <= pieces->noise_dw) ? dw.noise : pieces->noise_dw;
    }
    pieces->resolved = pieces->noise_w <= tolerance * pieces->max_w &&
                       pieces->noise_dw <= tolerance * pieces->max_dw;
}

/* Noise everywhere: nothing to be found, even pieces will do. */
static int even(double a, double b, double *edge)
{
    enum { EVEN = 32 };
    for (int i = 0; i < EVEN; i++) edge[i] = i + 1 < EVEN ? a + (b - a) * (i + 1) / EVEN : b;
    return EVEN;
}

enum status pieces_find(struct pieces *pieces, const struct kernel *kernel, int dim,
                        struct error *error)
{
    *pieces = (struct pieces){.kernel = kernel, .dim = dim};
    for (int i = 0; i < 4 * N; i++) pieces->cosine[i] = cos(M_PI * i / (2 * N));
    find_scale(pieces);
    const int knots = kernel->knot_count > 0 ? kernel->knot_count : 0;
    const size_t room = (size_t)LEAVES_MAX + 64 * (size_t)(knots + 2);
    pieces->edge = calloc(room, sizeof *pieces->edge);
    pieces->declared = calloc(room, sizeof *pieces->declared);
    if (!pieces->edge || !pieces->declared) {
        pieces_free(pieces);
        return error_set(error, STATUS_ENVIRONMENT, "no memory for the pieces of a kernel");
    }
    pieces->declared[0] = true;
    for (int i = 0; i <= knots; i++) {
        const double a = pieces->edge[pieces->n];
        const double b = i < knots ? kernel->knots[i] : 1;
        struct leaves leaves = {pieces, pieces->edge + pieces->n + 1, 0};
        bisect(&leaves, a, b);
        pieces->n += pieces->n + leaves.n < LEAVES_MAX ? join(pieces, a, leaves.edge, leaves.n)
                                                       : even(a, b, leaves.edge);
        pieces->declared[pieces->n] = true;
    }
    find_noise(pieces);
    return STATUS_OK;
}

void pieces_free(struct pieces *pieces)
{
    free(pieces->edge);
    free(pieces->declared);
    *pieces = (struct pieces){0};
}

/* T_j^(k)(1) */
static double end_slope(int j, int k)
{
    double product = 1;
    for (int i = 0; i < k; i++) product *= (double)(j * j - i * i) / (2 * i + 1);
    return product;
}

double pieces_derivative(const struct pieces *pieces, double at, double to, int k, double *floor)
{
    kernel_shape *shape = k ? pieces->kernel->dw : pieces->kernel->w;
    const int m = k ? k - 1 : 0;
    double best = (double)NAN;
    *floor = (double)INFINITY;
    /* the noise falls with wide windows, the truncation with narrow ones: take the best */
    for (double length = to - at; fabs(length) > fabs(to - at) / 1000; length /= 2) {
        struct series_fit fit;
        sample(pieces, shape, at, at + length, &fit); /* x = -1 at `at` */
        double sum = 0, amplified = 0;
        const double stretch = pow(2 / length, m);
        const int terms =
            fit.reach > m + 2 ? fit.reach : m + 2; /* the chopped ones are errors as well */
        for (int j = 0; j < terms && j < N; j++) {
            const double slope = end_slope(j, m) * ((j + m) % 2 ? -1 : 1);
            if (j < fit.n) sum += fit.c[j] * slope;
            amplified += fabs(slope);
        }
        const double error = fit.noise * amplified * fabs(stretch);
        if (isnan(error) || error < *floor) {
            *floor = error;
            best = sum * stretch;
        }
    }
    return best;
}
