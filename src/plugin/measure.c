/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure.h"

#include <float.h>
#include <math.h>

#include <gsl/gsl_integration.h>

/* Orders whose nodes GSL tabulates to full precision. */
enum { FINE = 32, COARSE = 20 };

double measure_sphere(int dim)
{
    return dim == 1 ? 2 : 2 * M_PI * (dim - 1);
}

static double power(double x, int n)
{
    double y = 1;
    for (int i = 0; i < n; i++) y *= x;
    return y;
}

static double gauss(const struct pieces *pieces, measure_function *f, int exponent, double h,
                    double a, double b, size_t order)
{
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(order);
    double sum = 0;
    for (size_t i = 0; table && i < order; i++) {
        double q, weight;
        gsl_integration_glfixed_point(a, b, i, &q, &weight, table);
        sum += weight * power(q, exponent) * f(pieces->kernel, q * h, h, pieces->dim);
    }
    if (table) gsl_integration_glfixed_table_free(table);
    return table ? sum * power(h, exponent + 1) : (double)NAN;
}

double measure_between(const struct pieces *pieces, measure_function *f, int exponent, double h,
                       double a, double b, double *floor)
{
    double sum = 0;
    for (int i = 0; i < pieces->n; i++) {
        const double lo = fmax(a, pieces->edge[i]), hi = fmin(b, pieces->edge[i + 1]);
        if (!(lo < hi)) continue;
        const double fine = gauss(pieces, f, exponent, h, lo, hi, FINE);
        if (floor)
            *floor += fabs(fine - gauss(pieces, f, exponent, h, lo, hi, COARSE)) +
                      DBL_EPSILON * fabs(fine);
        sum += fine;
    }
    return sum;
}

double measure_support(const struct pieces *pieces, measure_function *f, int exponent, double h,
                       double *floor)
{
    return measure_between(pieces, f, exponent, h, 0, 1, floor);
}

double measure_constant(const struct pieces *pieces)
{
    struct kernel unit = *pieces->kernel;
    struct pieces copy = *pieces;
    copy.kernel = &unit;
    unit.constant[copy.dim] = 1;
    return 1 /
           (measure_sphere(copy.dim) * measure_support(&copy, kernel_value, copy.dim - 1, 1, NULL));
}

void measure_moments(const struct pieces *pieces, struct measure_moments *moments)
{
    const int dim = pieces->dim;
    const double sphere = measure_sphere(dim);
    moments->volume = sphere * measure_support(pieces, kernel_value, dim - 1, 1, NULL);
    moments->second = sphere / dim * measure_support(pieces, kernel_value, dim + 1, 1, NULL);
    moments->fourth =
        3 * sphere / (dim * (dim + 2)) * measure_support(pieces, kernel_value, dim + 3, 1, NULL);
}

double measure_deviation(const struct kernel *kernel, int dim)
{
    enum { STEPS = 2000 }; /* for Simpson's rule */
    double moment = 0, volume = 0;
    for (int k = 0; k <= STEPS; k++) {
        const double q = (double)k / STEPS;
        const double w = (k == 0 || k == STEPS ? 1
                          : k % 2              ? 4
                                               : 2) *
                         kernel->w(kernel, q, dim) * pow(q, dim - 1);
        moment += w * q * q;
        volume += w;
    }
    return sqrt(moment / volume / dim);
}

const double measure_significant = 30;

/* A table of n intervals gives slope and curvature of the spline with errors of (1/n)^3 and
 * (1/n)^2. They appear only at its ends, where w is continued with zero slope and curvature. */
static double end_error(const struct pieces *pieces, int i, int k)
{
    enum { FEW = 8 };
    if (pieces->n <= FEW || (i > 0 && i < pieces->n) || k < 1 || k > 2) return 0;
    return (k == 1 ? 0.3 : 0.7) * pow(pieces->n, k - 4) * pieces->max_dw;
}

/* The jump of derivative k at break point i: even extension at the origin, zero beyond the edge. */
static struct measure_jump plain_jump(const struct pieces *pieces, int i, int k)
{
    const double *edge = pieces->edge;
    double left = 0, right = 0, left_floor = 0, right_floor = 0;
    if (i > 0) left = pieces_derivative(pieces, edge[i], edge[i - 1], k, &left_floor);
    if (i < pieces->n) right = pieces_derivative(pieces, edge[i], edge[i + 1], k, &right_floor);
    if (i == 0) {
        left = k % 2 ? -right : right;
        left_floor = right_floor;
    }
    return (struct measure_jump){edge[i], fabs(right - left),
                                 left_floor + right_floor + end_error(pieces, i, k)};
}

/* If a break point is off by delta, derivative k differs by delta times the jump of derivative k +
 * 1. */
static struct measure_jump jump_at(const struct pieces *pieces, int i, int k)
{
    struct measure_jump jump = plain_jump(pieces, i, k);
    if (pieces->doubt[i] > 0) jump.floor += pieces->doubt[i] * plain_jump(pieces, i, k + 1).jump;
    return jump;
}

int measure_class_limit(const struct pieces *pieces)
{
    return pieces->terms.single || pieces_look_single(pieces) ? 2 : MEASURE_CLASS_MAX;
}

/* Records jumps of w, w' or w'' by less than 1e-4 as mistakes if there are few, since no kernel has
 * them intentionally. Tables with many points do have such small jumps. */
static void note_accident(const struct pieces *pieces, int i, int k, double jump,
                          struct measure_class *result)
{
    enum { FEW = 8, HIGHEST = 2 };
    const double size = jump / (k == 0 ? pieces->max_w : pieces->max_dw);
    if (pieces->declared[i] || pieces->n > FEW || k > HIGHEST || size > 1e-4) return;
    result->accident.count++;
    if (size < result->accident.jump) return;
    result->accident.at = pieces->edge[i];
    result->accident.jump = size;
    result->accident.k = k;
}

void measure_class(const struct pieces *pieces, struct measure_class *result)
{
    const int limit = measure_class_limit(pieces);
    *result = (struct measure_class){.class = limit, .at = (double)NAN};
    for (int i = 0; i <= pieces->n; i++)
        for (int k = 0; k <= limit + 1; k++) {
            const struct measure_jump jump = jump_at(pieces, i, k);
            struct measure_jump *worst = &result->jump[k];
            if (i == 0 || !(jump.jump * worst->floor <= worst->jump * jump.floor)) *worst = jump;
            if (jump.jump <= measure_significant * jump.floor) continue;
            if (!pieces->declared[i] && result->extra++ == 0) result->extra_at = jump.at;
            note_accident(pieces, i, k, jump.jump, result);
            if (k - 1 < result->class) {
                result->class = k - 1;
                result->at = jump.at;
            }
            break; /* higher derivatives give no more information */
        }
}

void measure_lattice(const struct kernel *kernel, int dim, double eta, double *density,
                     double *gradient)
{
    const int reach = (int)ceil(eta), last[3] = {reach, dim > 1 ? reach : 0, dim > 2 ? reach : 0};
    double rho = 0, slope = 0; /* spacing 1, h = eta */
    for (int i = -last[0]; i <= last[0]; i++)
        for (int j = -last[1]; j <= last[1]; j++)
            for (int k = -last[2]; k <= last[2]; k++) {
                const double r = sqrt(i * i + j * j + k * k);
                rho += kernel_value(kernel, r, eta, dim);
                slope += r * kernel_dr(kernel, r, eta, dim);
            }
    *density = rho - 1;
    *gradient = -slope / dim - 1; /* mean over the equivalent axes */
}
