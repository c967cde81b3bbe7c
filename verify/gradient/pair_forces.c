/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pair_forces.h"

#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>

#include "summation.h"

/* ---- a disordered state ---- */

bool pair_forces_state(struct pair_forces_state *s, const struct kernel *kernel, int dim,
                       unsigned long seed)
{
    const size_t side[] = {0, 50, 7, 4};
    const struct clouds_settings settings = {CLOUDS_JITTERED, dim, side[dim], 0.45, 2.6, seed};
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    *s = (struct pair_forces_state){.dim = dim};
    bool ok = rng && !clouds_make(&settings, &s->cloud, NULL);
    if (ok) gsl_rng_set(rng, seed + 1);
    s->n = ok ? s->cloud.cloud.points.n : 0;
    for (size_t i = 0; i < s->n; i++) {
        s->m[i] = s->cloud.volume[i] * (0.6 + 0.8 * gsl_rng_uniform(rng));
        s->P[i] = 2.385 * (0.3 + gsl_rng_uniform(rng));
        for (int a = 0; a < dim; a++) s->v[a][i] = 2 * gsl_rng_uniform(rng) - 0.7;
    }
    if (rng) gsl_rng_free(rng);
    const struct summation sum = {s->cloud.cloud.points, kernel, s->m, settings.eta, 1e-13, 1};
    ok = ok && !summation_solve(&sum, s->cloud.h, s->rho, NULL);
    for (size_t i = 0; ok && i < s->n; i++) {
        double slope = 0; /* d rho/dh */
        for (size_t j = 0; j < s->n; j++) {
            double r = 0;
            for (int a = 0; a < dim; a++) r = hypot(r, s->cloud.x[a][j] - s->cloud.x[a][i]);
            slope += s->m[j] * kernel_dh(kernel, r, s->cloud.h[i], dim);
        }
        s->f[i] = 1 / (1 + s->cloud.h[i] / (dim * s->rho[i]) * slope);
        s->cloud.volume[i] = s->m[i] / s->rho[i];
    }
    return ok;
}

/* G_ij for all pairs: the operator applied to the n fields delta_ij / V_j at once. */
bool pair_forces_gradients(struct pair_forces_state *s, const struct gradient_subject *subject,
                           const struct kernel *kernel)
{
    struct operator_point point[FORCES_MAX];
    for (size_t j = 0; j < s->n; j++) {
        double unit[FORCES_MAX] = {0}, g[3][FORCES_MAX], *const gradient[3] = {g[0], g[1], g[2]};
        unit[j] = 1 / s->cloud.volume[j];
        if (gradient_study_apply(subject, kernel, &s->cloud.cloud, unit, gradient, point, NULL))
            return false;
        for (size_t i = 0; i < s->n; i++) {
            s->condition = fmax(s->condition, point[i].condition);
            for (int a = 0; a < s->dim; a++) s->G[i][j][a] = i == j ? 0 : g[a][i];
        }
    }
    return true;
}

/* ---- forces ---- */

/* Force on i by j and heating of i by j. */
static void pair_force(const struct pair_forces_state *s, const struct pair_forces_subject *subject,
                       size_t i, size_t j, double *force, double *heating)
{
    const double mm = s->m[i] * s->m[j], *rho = s->rho, *P = s->P;
    const bool lagrangian = subject->formulation == FORMULATION_LAGRANGIAN;
    const enum pair_fault fault = subject->fault;
    *heating = 0;
    for (int a = 0; a < s->dim; a++) {
        const double own = s->G[i][j][a];
        double other = -s->G[j][i][a], v = s->v[a][i] - s->v[a][j];
        if (fault == FORCES_PLUS) other = -other;
        if (fault == FORCES_GATHER) other = own;
        if (fault == FORCES_OWN_MATRIX) other *= s->cloud.volume[j] / s->cloud.volume[i];
        if (fault == FORCES_HEATING_SIGN && i % 10 == 3) v = -v;
        const double mean = 0.5 * (own + other);
        if (lagrangian) {
            const double fi = s->f[i], fj = fault == FORCES_OWN_F ? fi : s->f[j];
            const double A = fi * P[i] / (rho[i] * rho[i]), B = fj * P[j] / (rho[j] * rho[j]);
            force[a] = -mm * (A * own + B * other);
            *heating += mm * (fault == FORCES_NO_F ? A / fi : A) * v * own;
        } else {
            const double pressure = P[i] + (fault == FORCES_OWN_PRESSURE ? P[i] : P[j]);
            force[a] = -mm * pressure / (rho[i] * rho[j]) *
                       (fault == FORCES_HALF_IN_FORCE ? 2 * mean : mean);
            *heating += mm * P[i] / (rho[i] * rho[j]) * v * mean;
        }
    }
}

/* The momentum equation rho dv/dt = -grad P with a difference operator: no pair forces. */
static void difference_force(const struct pair_forces_state *s, size_t i, size_t j, double *force,
                             double *heating)
{
    const double V = s->cloud.volume[i], Vj = s->cloud.volume[j];
    *heating = 0;
    for (int a = 0; a < s->dim; a++) {
        force[a] = -V * Vj * (s->P[j] - s->P[i]) * s->G[i][j][a];
        *heating -= V * s->P[i] * Vj * (s->v[a][j] - s->v[a][i]) * s->G[i][j][a];
    }
}

static struct pair_forces_rates state_rates(const struct pair_forces_state *s,
                                            const struct pair_forces_subject *subject)
{
    double p[3] = {0}, L[3] = {0}, E = 0, p_scale = 0, L_scale = 0, E_scale = 0;
    for (size_t i = 0; i < s->n; i++)
        for (size_t j = 0; j < s->n; j++) {
            double force[3] = {0}, x[3] = {0}, heating, work = 0, size = 0, r = 0;
            if (i == j) continue;
            if (subject->gradient.form->difference)
                difference_force(s, i, j, force, &heating);
            else
                pair_force(s, subject, i, j, force, &heating);
            for (int a = 0; a < s->dim; a++) {
                x[a] = s->cloud.x[a][i];
                p[a] += force[a], work += s->v[a][i] * force[a];
                size = hypot(size, force[a]), r = hypot(r, x[a]);
            }
            for (int a = 0; a < 3; a++)
                L[a] += x[(a + 1) % 3] * force[(a + 2) % 3] - x[(a + 2) % 3] * force[(a + 1) % 3];
            E += work + heating;
            p_scale += size, L_scale += r * size, E_scale += fabs(work) + fabs(heating);
        }
    return (struct pair_forces_rates){hypot(hypot(p[0], p[1]), p[2]) / p_scale,
                                      hypot(hypot(L[0], L[1]), L[2]) / L_scale, fabs(E) / E_scale};
}

bool pair_forces_rates(const struct pair_forces_subject *subject, int dim, unsigned long seed,
                       struct pair_forces_rates *rates)
{
    struct kernel kernel;
    struct pair_forces_state *s = calloc(1, sizeof *s);
    bool ok = s && !kernel_select(&kernel, dim == 2 ? "wendland_c4" : "cubic_spline", 5, NULL);
    ok = ok && pair_forces_state(s, &kernel, dim, seed) &&
         pair_forces_gradients(s, &subject->gradient, &kernel);
    if (ok) *rates = state_rates(s, subject);
    if (s) clouds_free(&s->cloud);
    free(s);
    return ok;
}
