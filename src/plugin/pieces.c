/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pieces.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "list.h"
#include "places.h"

enum { N = PIECES_NODES, TAIL = N / 4, LEAVES_MAX = 1 << 15 };

const struct terms pieces_terms_usual = {.samples = 1 << 13, .seed = 1};

/* For double and single precision: a series is resolved when its tail is below this fraction of the
 * largest value; intervals with a singularity are bisected down to this width. */
static const double tolerances[] = {4e-14, 4e-6}, widths[] = {1e-11, 1e-3};

struct leaves {
    const struct pieces *pieces;
    double *edge;
    int n;
};

void pieces_fit(const struct pieces *pieces, const double values[PIECES_NODES],
                struct series_fit *fit)
{
    double largest = 0, tail = 0, sum[N] = {0};
    for (int j = 0; j < N; j++) {
        largest = fmax(largest, fabs(values[j]));
        for (int k = 0; k < N; k++) sum[k] += values[j] * pieces->cosine[j][k];
    }
    for (int k = 0; k < N; k++) {
        fit->c[k] = (k ? 2. : 1.) / N * sum[k];
        if (!(largest <= DBL_MAX)) fit->c[k] = (double)NAN; /* propagate Inf and NaN */
        if (k >= N - TAIL) tail = fmax(tail, fabs(fit->c[k]));
    }
    fit->noise = isnan(fit->c[0]) ? fit->c[0] : fmax(tail, 0.5 * pieces->epsilon * largest);
    fit->n = N;
    while (fit->n > 1 && fabs(fit->c[fit->n - 1]) <= 2 * fit->noise) fit->n--;
    /* a tail above round-off indicates a break point that is only nearly right */
    fit->reach = tail > 4 * pieces->epsilon * largest ? N : fit->n + 2;
}

double pieces_series_value(const struct series_fit *fit, double x)
{
    double next = 0, following = 0; /* Clenshaw */
    for (int j = fit->n - 1; j > 0; j--) {
        const double b = 2 * x * next - following + fit->c[j];
        following = next;
        next = b;
    }
    return x * next - following + fit->c[0];
}

double pieces_series_slope(const struct series_fit *fit, double x, double *floor)
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
        values[j] = shape(pieces->kernel, a + (b - a) / 2 * (1 + pieces->node[j]), pieces->dim);
    pieces_fit(pieces, values, fit);
}

static void sample_both(const struct pieces *pieces, double a, double b, struct series_fit *w,
                        struct series_fit *dw)
{
    sample(pieces, pieces->kernel->w, a, b, w);
    sample(pieces, pieces->kernel->dw, a, b, dw);
}

void pieces_series(const struct pieces *pieces, int p, struct series_fit *w, struct series_fit *dw)
{
    sample_both(pieces, pieces->edge[p], pieces->edge[p + 1], w, dw);
}

static bool resolved_nearly(const struct pieces *pieces, double a, double b, double factor)
{
    struct series_fit w, dw;
    sample_both(pieces, a, b, &w, &dw);
    return w.noise <= factor * pieces->tolerance * pieces->max_w &&
           dw.noise <= factor * pieces->tolerance * pieces->max_dw;
}

static bool resolved(const struct pieces *pieces, double a, double b)
{
    return resolved_nearly(pieces, a, b, 1);
}

/* Bisects ]a, b[ until every interval is resolved or too narrow; appends their right ends. */
static void bisect(struct leaves *leaves, double a, double b)
{
    if (leaves->pieces->n + leaves->n >= LEAVES_MAX) return;
    if (b - a > leaves->pieces->width_min && !resolved(leaves->pieces, a, b)) {
        bisect(leaves, a, (a + b) / 2);
        bisect(leaves, (a + b) / 2, b);
    } else {
        leaves->edge[leaves->n++] = b;
    }
}

/* Joins adjacent intervals that are resolved together, and shrinks intervals too narrow to be a
 * piece (a singular point) to that point, or to the end b. Returns the number of pieces on ]a, b[.
 */
static int join(const struct pieces *pieces, double a, double *edge, int n)
{
    int m = 0;
    for (int i = 0; i < n;) {
        int last = i;
        while (last + 1 < n && resolved(pieces, a, edge[last + 1])) last++;
        const bool point =
            edge[last] - a < 1e3 * pieces->width_min && !resolved(pieces, a, edge[last]);
        if (point && m > 0)
            edge[m - 1] = last + 1 < n ? (a + edge[last]) / 2 : edge[last];
        else if (!point || last + 1 == n)
            edge[m++] = edge[last];
        a = edge[m ? m - 1 : 0];
        i = last + 1;
    }
    return m;
}

/* Derivative m of the series at x, which may be slightly outside [-1, 1], by differentiating the
 * coefficients m times. */
static double series_derivative(const struct series_fit *fit, double x, int m)
{
    double c[N + 2] = {0};
    for (int j = 0; j < fit->n; j++) c[j] = fit->c[j];
    for (int i = 0; i < m; i++) {
        double d[N + 2] = {0};
        for (int j = N - 1; j >= 0; j--) d[j] = (j + 2 < N ? d[j + 2] : 0) + 2 * (j + 1) * c[j + 1];
        d[0] /= 2;
        for (int j = 0; j < N + 2; j++) c[j] = d[j];
    }
    double t = 1, next = x, sum = 0;
    for (int j = 0; j < N; j++) {
        sum += c[j] * t;
        const double following = 2 * x * next - t;
        t = next;
        next = following;
    }
    return sum;
}

/* T_j^(k)(1) */
static double end_slope(int j, int k)
{
    double product = 1;
    for (int i = 0; i < k; i++) product *= (double)(j * j - i * i) / (2 * i + 1);
    return product;
}

/* The series to the left and right of a break point. Their difference is a power of the distance
 * from the exact break point. */
struct junction {
    struct series_fit left, right;
    double at, margin, half; /* the series cover at -+ (margin ... margin + 2 half) */
};

/* Error of derivative m at the end of a series due to its noise. */
static double end_noise(const struct series_fit *fit, int m)
{
    double amplified = 0;
    for (int j = 0; j < fit->reach && j < N; j++) amplified += end_slope(j, m);
    return fit->noise * amplified;
}

static double difference(const struct junction *junction, double q, int m)
{
    const double x = q - junction->at, shift = junction->margin + junction->half;
    return (series_derivative(&junction->left, (x + shift) / junction->half, m) -
            series_derivative(&junction->right, (x - shift) / junction->half, m)) *
           pow(junction->half, -m);
}

static void sample_beside(const struct pieces *pieces, kernel_shape *shape,
                          struct junction *junction)
{
    const double at = junction->at, near = junction->margin, far = near + 2 * junction->half;
    sample(pieces, shape, at - far, at - near, &junction->left);
    sample(pieces, shape, at + near, at + far, &junction->right);
}

/* Error of a series due to its noise at x > 1. */
static double noise_beyond(const struct series_fit *fit, double x)
{
    return fit->noise * cosh(fit->reach * acosh(x));
}

/* Bisects for the place where the values leave the left series for the right one. True if the
 * function jumps there, which `difference` has no zero at. */
static bool find_jump(const struct pieces *pieces, kernel_shape *shape, struct junction *junction,
                      double *q, double *doubt)
{
    const double near = junction->margin, half = junction->half, edge = 1 + near / half;
    double low = junction->at - near, high = junction->at + near, middle;
    sample_beside(pieces, shape, junction);
    while ((middle = (low + high) / 2) > low && middle < high) {
        const double x = middle - junction->at + near + half;
        const double left = pieces_series_value(&junction->left, x / half) -
                            shape(pieces->kernel, middle, pieces->dim);
        *(fabs(left) < fabs(left - difference(junction, middle, 0)) ? &low : &high) = middle;
    }
    *q = high;
    *doubt = high - low;
    return fabs(difference(junction, high, 0)) >
           1e2 * (noise_beyond(&junction->left, edge) + noise_beyond(&junction->right, edge));
}

/* Refines a break point found by bisection, whose error is limited only by the tolerance. Where
 * neither w nor dw jumps: with D the difference of the two series of dw, D/D' = (q - break)/s,
 * where s is the order of the first derivative of dw that jumps; derivative s - 1 of D has a simple
 * zero at the break. */
static double refine(const struct pieces *pieces, double before, double at, double after,
                     double margin, double *doubt)
{
    const double length = fmin(at - before, after - at);
    struct junction junction = {
        .at = at, .margin = margin * length, .half = (0.5 - margin) * length};
    double q;
    if (find_jump(pieces, pieces->kernel->w, &junction, &q, doubt) ||
        find_jump(pieces, pieces->kernel->dw, &junction, &q, doubt))
        return q;
    const double a = at - length / 2, b = at - length / 4;
    const double ratio_a = difference(&junction, a, 0) / difference(&junction, a, 1);
    const double ratio_b = difference(&junction, b, 0) / difference(&junction, b, 1);
    const double order = round((a - b) / (ratio_a - ratio_b));
    *doubt = 0.2 * length;
    if (!(order >= 1 && order <= 8)) return at;
    const int m = (int)order - 1;
    q = at;
    for (int i = 0; i < 4; i++) q -= difference(&junction, q, m) / difference(&junction, q, m + 1);
    const double noise = end_noise(&junction.left, m) + end_noise(&junction.right, m);
    const double unsure = noise * pow(junction.half, -m) / fabs(difference(&junction, at, m + 1));
    if (!(fabs(q - at) <= junction.margin)) return at;
    *doubt = fabs(q - at) + 3 * unsure;
    return fabs(q - at) > 3 * unsure ? q : at;
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

/* Stores values that the same arguments must give later. */
static void remember(struct pieces *pieces)
{
    const struct kernel *kernel = pieces->kernel;
    for (int i = 0; i < PIECES_FIRST; i++) {
        const double q = 1.02 * (i + 0.385) / PIECES_FIRST; /* the last one is beyond the edge */
        pieces->first[i] = (struct pieces_first){q, kernel->w(kernel, q, pieces->dim),
                                                 kernel->dw(kernel, q, pieces->dim),
                                                 kernel_dh(kernel, q, 1, pieces->dim)};
    }
}

/* Measures rounding errors by second differences over a step on which a smooth function bends only
 * by 1e-13. Their upper quartile is insensitive to a few knots or faults. */
static void find_grain(struct pieces *pieces)
{
    enum { SAMPLES = 256 };
    const double step = 1e-7;
    double bend[SAMPLES];
    for (int i = 0; i < SAMPLES; i++) {
        const double q = (i + 0.385) / SAMPLES;
        double w[3];
        for (int j = 0; j < 3; j++)
            w[j] = pieces->kernel->w(pieces->kernel, q + j * step, pieces->dim);
        bend[i] = fabs(w[0] - 2 * w[1] + w[2]);
    }
    list_sort(bend, SAMPLES);
    pieces->grain = bend[3 * SAMPLES / 4] / pieces->max_w;
}

bool pieces_look_single(const struct pieces *pieces)
{
    return pieces->grain > 1e-10 && pieces->grain < 1e-5;
}

/* Finds the noise of all pieces, and whether all are resolved. */
static void find_noise(struct pieces *pieces)
{
    for (int i = 0; i < pieces->n; i++) {
        struct series_fit w, dw;
        pieces_series(pieces, i, &w, &dw);
        pieces->noise_w = !(w.noise <= pieces->noise_w) ? w.noise : pieces->noise_w;
        pieces->noise_dw = !(dw.noise <= pieces->noise_dw) ? dw.noise : pieces->noise_dw;
    }
    pieces->resolved = pieces->noise_w <= pieces->tolerance * pieces->max_w &&
                       pieces->noise_dw <= pieces->tolerance * pieces->max_dw;
}

/* Equal pieces, for a kernel that is noisy everywhere. */
static int even(double a, double b, double *edge)
{
    enum { EVEN = 32 };
    for (int i = 0; i < EVEN; i++) edge[i] = i + 1 < EVEN ? a + (b - a) * (i + 1) / EVEN : b;
    return EVEN;
}

/* Moves the break point to its refined position if both pieces are then resolved. They need only be
 * nearly resolved, since their other ends may still be off. */
static bool settle(const struct pieces *pieces, double before, double *at, double after,
                   double margin, double factor)
{
    double doubt;
    const double q = refine(pieces, before, *at, after, margin, &doubt);
    const bool sound =
        resolved_nearly(pieces, before, q, factor) && resolved_nearly(pieces, q, after, factor);
    if (sound) *at = q;
    return sound;
}

/* Refines the break points between n pieces. Two close ones, which bisection left around one, are
 * merged if that resolves the pieces. */
static int sharpen(const struct pieces *pieces, double *edge, int n)
{
    int m = 0;
    for (int i = 1; i < n; i++) {
        const double before = edge[m], gap = edge[i + 1] - edge[i];
        double middle = (edge[i] + edge[i + 1]) / 2;
        if (i + 1 < n && gap < 0.15 * fmin(edge[i] - before, edge[i + 2] - edge[i + 1]) &&
            settle(pieces, before, &middle, edge[i + 2], 1. / 8, 100)) {
            edge[++m] = middle;
            i++;
        } else {
            double at = edge[i];
            settle(pieces, before, &at, edge[i + 1], 1. / 8, 100);
            edge[++m] = at;
        }
    }
    edge[++m] = edge[n];
    for (double margin = 1. / 32; margin > 1e-3; margin /= 2)
        for (int i = 1; i < m; i++)
            settle(pieces, edge[i - 1], &edge[i], edge[i + 1], margin, 3200 * margin);
    return m;
}

/* The pieces of ]a, b[: edge[0] = a, ..., edge[n] = b; returns n. */
static int divide(const struct pieces *pieces, double a, double b, double *edge)
{
    struct leaves leaves = {pieces, edge + 1, 0};
    bisect(&leaves, a, b);
    if (pieces->n + leaves.n >= LEAVES_MAX) return even(a, b, edge + 1);
    int n = join(pieces, a, edge + 1, leaves.n);
    if (n == 1) return n;
    return sharpen(pieces, edge, n);
}

enum status pieces_find(struct pieces *pieces, const struct kernel *kernel, int dim,
                        const struct terms *terms, struct error *error)
{
    *pieces =
        (struct pieces){.kernel = kernel, .dim = dim, .terms = terms ? *terms : pieces_terms_usual};
    pieces->epsilon = pieces->terms.single ? (double)FLT_EPSILON : DBL_EPSILON;
    pieces->tolerance = tolerances[pieces->terms.single];
    pieces->width_min = widths[pieces->terms.single];
    for (int j = 0; j < N; j++) {
        pieces->node[j] = cos(M_PI * (2 * j + 1) / (2 * N));
        for (int k = 0; k < N; k++)
            pieces->cosine[j][k] = cos(M_PI * (k * (2 * j + 1) % (4 * N)) / (2 * N));
    }
    remember(pieces);
    find_scale(pieces);
    find_grain(pieces);
    const int knots = kernel->knot_count > 0 ? kernel->knot_count : 0;
    const size_t capacity = (size_t)LEAVES_MAX + 64 * (size_t)(knots + 2);
    pieces->edge = calloc(capacity, sizeof *pieces->edge);
    pieces->declared = calloc(capacity, sizeof *pieces->declared);
    pieces->doubt = calloc(capacity, sizeof *pieces->doubt);
    if (!pieces->edge || !pieces->declared || !pieces->doubt) {
        pieces_free(pieces);
        return error_set(error, STATUS_ENVIRONMENT, "no memory for the pieces of a kernel");
    }
    pieces->declared[0] = true;
    for (int i = 0; i <= knots; i++) {
        const double a = pieces->edge[pieces->n];
        const double b = i < knots ? kernel->knots[i] : 1;
        pieces->n += divide(pieces, a, b, pieces->edge + pieces->n);
        pieces->declared[pieces->n] = true;
    }
    for (int i = 1; i < pieces->n; i++)
        if (!pieces->declared[i])
            refine(pieces, pieces->edge[i - 1], pieces->edge[i], pieces->edge[i + 1], 1. / 128,
                   &pieces->doubt[i]);
    find_noise(pieces);
    const enum status status = places_find(pieces, error);
    if (status) pieces_free(pieces);
    return status;
}

void pieces_free(struct pieces *pieces)
{
    free(pieces->edge);
    free(pieces->declared);
    free(pieces->doubt);
    free(pieces->places);
    *pieces = (struct pieces){0};
}

double pieces_derivative(const struct pieces *pieces, double at, double to, int k, double *floor)
{
    kernel_shape *shape = k ? pieces->kernel->dw : pieces->kernel->w;
    const int m = k ? k - 1 : 0;
    double best = (double)NAN;
    *floor = (double)INFINITY;
    /* noise decreases with the width of the window, truncation increases: take the best */
    for (double length = to - at; fabs(length) > fabs(to - at) / 1000; length /= 2) {
        struct series_fit fit;
        sample(pieces, shape, at, at + length, &fit); /* x = -1 at `at` */
        double sum = 0, amplified = 0;
        const double stretch = pow(2 / length, m);
        const int terms =
            fit.reach > m + 2 ? fit.reach : m + 2; /* include the errors of chopped terms */
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
