/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "width.h"

#include <math.h>

#include "solver.h"
#include "specialise.h"

static const double start_tolerance = 1e-10;

double width_neighbours(int dim, double eta)
{
    static const double ball[] = {0, 2, 3.14159265358979, 4.18879020478639};
    return ball[dim] * pow(eta, dim);
}

struct width_rule width_rule_of(const struct simulation *simulation)
{
    const struct scheme *scheme = &simulation->scheme;
    const int dim = simulation->particles.dim;
    const double tolerance = scheme->h_tolerance;
    return (struct width_rule){dim, scheme->eta, scheme->kernel.constant[dim],
                               simulation->dt > 0 ? tolerance : least(tolerance, start_tolerance)};
}

double width_of(const struct width_rule *rule, double m, double rho)
{
    /* not pow, whose result differs between processors with and without FMA */
    if (rule->dim == 1) return rule->eta * m / rho;
    return rule->eta * (rule->dim == 2 ? sqrt(m / rho) : cbrt(m / rho));
}

/* The smoothing length that belongs to the density sum at 1/h. */
static double target_of(const struct width_rule *rule, double m, double sum, double h_inverse)
{
    double scale = rule->constant * h_inverse;
    for (int k = 1; k < rule->dim; k++) scale *= h_inverse;
    return width_of(rule, m, scale * sum);
}

void width_begin(struct width_bracket *bracket, int len, double high)
{
    for (int i = 0; i < len; i++) {
        bracket->low[i] = 0;
        bracket->high[i] = high;
    }
}

bool width_step(const struct width_rule *rule, int len, const double *m,
                const struct density_sums *sums, struct width_bracket *bracket, double *h,
                double *h_inverse)
{
    double *low = bracket->low, *high = bracket->high;
    const double tolerance = rule->tolerance;
    bool open = false;
    for (int i = 0; i < len; i++) {
        const double target = target_of(rule, m[i], sums->m[i], h_inverse[i]);
        const double residual = h[i] - target;
        if (fabs(residual) <= tolerance * h[i]) continue;
        open = true;
        if (residual < 0)
            low[i] = h[i];
        else
            high[i] = h[i];
        /* CONVENTIONS eq. 3.10 */
        const double slope = 1 - target / h[i] * (sums->m_dh[i] / (rule->dim * sums->m[i]));
        double next = h[i] - residual / slope;
        if (!(slope > 0 && next > low[i] && next < high[i]))
            next = isinf(high[i]) ? 2 * h[i] : 0.5 * (low[i] + high[i]);
        /* a bracket of two adjacent doubles counts as a root */
        if (next == low[i] || next == high[i]) low[i] = high[i] = next;
        h[i] = least(next, 2 * h[i]);
        h_inverse[i] = 1 / h[i];
    }
    return open;
}

int width_without_root(const struct width_rule *rule, int len, const double *m,
                       const struct density_sums *sums, const double *h, const double *h_inverse)
{
    for (int i = 0; i < len; i++) {
        const double target = target_of(rule, m[i], sums->m[i], h_inverse[i]);
        if (!(fabs(h[i] - target) <= 1e-6 * h[i])) return i;
    }
    return -1;
}

ALWAYS_INLINE void predict(const struct particles *particles, ptrdiff_t first, int len,
                           double ratio)
{
    const double *restrict found = particles->h_inverse_found + first;
    double *restrict h_inverse = particles->h_inverse + first, *restrict last =
                                                                   particles->h_inverse_old + first;
#pragma omp simd
    for (int i = 0; i < len; i++) {
        const double next = found[i] + ratio * (found[i] - last[i]);
        h_inverse[i] = largest(0.8 * found[i], least(1.25 * found[i], next));
        last[i] = found[i];
    }
}

/* CLONES functions are static, and public functions call them: clang 14 renames the dispatched
 * symbol, so that other files would not find it. Nearly all batches are full, and a constant trip
 * count needs no remainder loop. */
CLONES static void predict_specialised(const struct particles *particles, ptrdiff_t first, int len,
                                       double ratio)
{
    if (len == BATCH_MAX)
        predict(particles, first, BATCH_MAX, ratio);
    else
        predict(particles, first, len, ratio);
}

void width_predict(const struct particles *particles, ptrdiff_t first, int len, double ratio)
{
    predict_specialised(particles, first, len, ratio);
}
