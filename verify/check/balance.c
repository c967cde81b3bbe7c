/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "balance.h"

#include <math.h>

#include <gsl/gsl_deriv.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_sort.h>

#include "worst.h"

enum { LAWS = 3, POINTS = 64 }; /* GSL tabulates the 64-point rule to 27 digits */

/* Densities and fluxes of mass, momentum and energy (Toro eq. 3.2). */
static void conserved(double gamma, struct riemann_state s, double U[LAWS], double F[LAWS])
{
    if (s.rho == 0) s.v = 0;
    U[0] = s.rho;
    U[1] = s.rho * s.v;
    U[2] = s.rho * s.v * s.v / 2 + s.P / (gamma - 1);
    F[0] = U[1];
    F[1] = U[1] * s.v + s.P;
    F[2] = (U[2] + s.P) * s.v;
}

/* One side of a rectangle: the integral of a density over x at a time, or of a flux over t. */
struct side {
    const struct flow *flow;
    const struct flow_paths *paths;
    double fixed; /* the time, or the position */
    bool in_time;
};

/* Writes the ends and the kinks between them, sorted; returns their number. */
static size_t break_points(const struct side *side, const double range[2], double *points)
{
    const struct flow_paths *paths = side->paths;
    size_t n = 0;
    points[n++] = range[0];
    points[n++] = range[1];
    for (size_t i = 0; i < paths->n; i++) {
        const double s = paths->speeds[i];
        const double kink =
            side->in_time ? (side->fixed - paths->x0) / s : paths->x0 + s * side->fixed;
        if (kink > range[0] && kink < range[1]) points[n++] = kink;
    }
    gsl_sort(points, 1, n);
    return n;
}

/* Adds sign times the integrals, and the integrals of the magnitudes. */
static void integrate(const struct side *side, const gsl_integration_glfixed_table *rule,
                      const double range[2], double sign, double sum[LAWS], double size[LAWS])
{
    double points[BALANCE_PATHS + 2];
    const size_t n = break_points(side, range, points);
    for (size_t k = 0; k + 1 < n; k++)
        for (size_t i = 0; i < POINTS; i++) {
            double at, weight, U[LAWS], F[LAWS];
            gsl_integration_glfixed_point(points[k], points[k + 1], i, &at, &weight, rule);
            const struct flow *flow = side->flow;
            conserved(flow->gamma,
                      side->in_time ? flow->at(flow->context, side->fixed, at)
                                    : flow->at(flow->context, at, side->fixed),
                      U, F);
            for (size_t law = 0; law < LAWS; law++) {
                const double value = weight * (side->in_time ? F[law] : U[law]);
                sum[law] += sign * value;
                size[law] += fabs(value);
            }
        }
}

double balance_defect(const struct flow *flow, const double x[2], const double t[2],
                      const struct flow_paths *paths)
{
    double sum[LAWS] = {0}, size[LAWS] = {0}, worst = 0;
    gsl_integration_glfixed_table *rule = gsl_integration_glfixed_table_alloc(POINTS);
    if (!rule || paths->n > BALANCE_PATHS) worst = (double)NAN;
    for (int end = 0; end < 2 && !isnan(worst); end++) {
        const double sign = end ? 1 : -1;
        integrate(&(struct side){flow, paths, t[end], false}, rule, x, sign, sum, size);
        integrate(&(struct side){flow, paths, x[end], true}, rule, t, sign, sum, size);
    }
    if (rule) gsl_integration_glfixed_table_free(rule);
    for (size_t law = 0; law < LAWS; law++) {
        const double defect = size[law] == 0 ? 0 : fabs(sum[law]) / size[law];
        worst_keep(&worst, defect);
    }
    return worst;
}

/* ---- differential form ---- */

struct line {
    const struct flow *flow;
    double fixed;
    size_t law;
    bool in_time;
};

static double along(double at, void *parameters)
{
    const struct line *line = parameters;
    const struct flow *flow = line->flow;
    double U[LAWS], F[LAWS];
    conserved(flow->gamma,
              line->in_time ? flow->at(flow->context, line->fixed, at)
                            : flow->at(flow->context, at, line->fixed),
              U, F);
    return line->in_time ? U[line->law] : F[line->law];
}

double balance_residual(const struct flow *flow, double x, double t, double dx, double dt)
{
    double worst = 0;
    for (size_t law = 0; law < LAWS; law++) {
        struct line in_time = {flow, x, law, true}, in_space = {flow, t, law, false};
        const gsl_function U = {along, &in_time}, F = {along, &in_space};
        double dU, dF, error;
        gsl_deriv_central(&U, t, dt, &dU, &error);
        gsl_deriv_central(&F, x, dx, &dF, &error);
        const double residual = fabs(dU + dF) / (fabs(dU) + fabs(dF));
        worst_keep(&worst, residual);
    }
    return worst;
}
