/* SPDX-License-Identifier: GPL-3.0-or-later
 * Symbols of Kamm & Timmes 2007 with omega = 0 (uniform gas), j = d: x1 to x4 are linear in V,
 * which rises from 2/((d + 2) gamma) at the centre to 4/((d + 2)(gamma + 1)) at the shock. The
 * sample asks for a place and solves for x2, by its logarithm: near the centre it falls below any
 * double. */
#include "sedov.h"

#include <math.h>
#include <stddef.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_roots.h>

/* All values relative to those immediately behind the shock. */
struct profile {
    double rho, v, P;
};

struct exponents {
    double a0, a1, a2, a3, a4, a5;
};

static struct exponents exponents_of(double gamma, double j)
{
    struct exponents e = {.a0 = 2 / (j + 2),
                          .a2 = -(gamma - 1) / (2 * (gamma - 1) + j),
                          .a3 = j / (2 * (gamma - 1) + j),
                          .a5 = -2 / (2 - gamma)};
    e.a1 = (j + 2) * gamma / (2 + j * (gamma - 1)) *
           (2 * j * (2 - gamma) / (gamma * (j + 2) * (j + 2)) - e.a2);
    e.a4 = (j + 2) / (2 - gamma) * e.a1;
    return e;
}

/* The profile where ln x2 = s <= 0; log_lambda gets ln(r/R). */
static struct profile profile_at(double gamma, double j, double s, double *log_lambda)
{
    const struct exponents e = exponents_of(gamma, j);
    const double strong = (gamma + 1) / (gamma - 1),
                 V = (1 + exp(s) / strong) * 2 / ((j + 2) * gamma);
    const double front = (j + 2) * (gamma + 1), half = 0.5 * (2 + j * (gamma - 1));
    const double x1 = 0.25 * front * V, x3 = front / (front - 4 * half) * (1 - half * V);
    const double x4 = strong * (1 - 0.5 * (j + 2) * V);
    const double log1 = log(x1), log3 = log(x3), log4 = log(x4);
    *log_lambda = -e.a0 * log1 - e.a2 * s - e.a1 * log3;
    return (struct profile){
        .rho = exp(e.a3 * s + e.a4 * log3 + e.a5 * log4),
        .v = x1 * exp(*log_lambda),
        .P = exp(e.a0 * j * log1 + (e.a4 - 2 * e.a1) * log3 + (1 + e.a5) * log4)};
}

struct place {
    double gamma, j, log_lambda;
};

static double miss(double s, void *parameters)
{
    const struct place *place = parameters;
    double log_lambda;
    profile_at(place->gamma, place->j, s, &log_lambda);
    return log_lambda - place->log_lambda;
}

/* The profile at lambda = r/R < 1; constant within the innermost 1e-12. */
static struct profile profile_of(double gamma, int d, double lambda)
{
    struct place place = {gamma, d, log(fmax(lambda, 1e-12))};
    gsl_function f = {miss, &place};
    const double low = 2 * place.log_lambda / -exponents_of(gamma, d).a2 - 10, high = 0;
    double unused;
    if (!(miss(high, &place) > 0 && miss(low, &place) < 0)) return (struct profile){1, 1, 1};
    gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
    struct profile profile = {(double)NAN, (double)NAN, (double)NAN};
    if (!solver) return profile;
    /* ends: at what is no number, or with Brent's bracket, which closes to GSL_DBL_EPSILON |root|
     */
    if (gsl_root_fsolver_set(solver, &f, low, high) == GSL_SUCCESS)
        while (gsl_root_fsolver_iterate(solver) == GSL_SUCCESS) {
            const double s = gsl_root_fsolver_x_lower(solver);
            profile = profile_at(gamma, d, gsl_root_fsolver_root(solver), &unused);
            if (!(gsl_root_fsolver_x_upper(solver) - s > 4 * GSL_DBL_EPSILON * (1 + fabs(s))))
                break;
        }
    gsl_root_fsolver_free(solver);
    return profile;
}

/* Energy per volume over rho_1 D^2, by x = lambda^d; rho_1 ahead of the shock, D its speed. */
static double energy_density(double x, void *parameters)
{
    const struct place *place = parameters;
    const double gamma = place->gamma, behind = 2 / (gamma + 1);
    const struct profile s = profile_of(gamma, (int)place->j, pow(x, 1 / place->j));
    return 0.5 * (gamma + 1) / (gamma - 1) * s.rho * behind * behind * s.v * s.v +
           behind * s.P / (gamma - 1);
}

/* Surfaces of the unit sphere. */
static const double spheres[] = {0, 2, 2 * M_PI, 4 * M_PI};

/* E = S_d R^d rho D^2 integral dx/d, S_d the unit sphere, D = 2 R/((d + 2) t). */
static double find_xi0(double gamma, int d)
{
    struct place place = {gamma, d, 0};
    gsl_function f = {energy_density, &place};
    gsl_integration_workspace *room = gsl_integration_workspace_alloc(200);
    double integral, error;
    if (!room) return NAN;
    const int status =
        gsl_integration_qag(&f, 0, 1, 0, 1e-11, 200, GSL_INTEG_GAUSS31, room, &integral, &error);
    gsl_integration_workspace_free(room);
    const double speed = 2. / (d + 2);
    return status && status != GSL_EROUND
               ? (double)NAN
               : pow(spheres[d] * speed * speed * integral / d, -1. / (d + 2));
}

const char *sedov_solve(double gamma, int d, double rho, double E, struct sedov *sedov)
{
    if (!(d >= 1 && d <= 3)) return "d must be 1, 2 or 3";
    if (!(rho > 0) || !isfinite(rho)) return "rho must be finite and above 0";
    if (!(E > 0) || !isfinite(E)) return "E must be finite and above 0";
    if (!(gamma > 1) || !(gamma < (d == 3 ? 7 : 100))) return "gamma must be above 1 and below 7";
    if (fabs(gamma - 2) < 1e-3) return "gamma must be no nearer to 2 than 1e-3";
    gsl_error_handler_t *const handler = gsl_set_error_handler_off();
    const double xi0 = find_xi0(gamma, d);
    gsl_set_error_handler(handler);
    if (!(xi0 > 0)) return "the energy's integral does not converge";
    *sedov = (struct sedov){gamma, rho, E, d, xi0};
    return NULL;
}

double sedov_shock(const struct sedov *sedov, double t)
{
    return sedov->xi0 * pow(sedov->E * t * t / sedov->rho, 1. / (sedov->d + 2));
}

struct sedov_state sedov_sample(const struct sedov *sedov, double r, double t)
{
    const double gamma = sedov->gamma, R = sedov_shock(sedov, t);
    if (!(r < R)) return (struct sedov_state){sedov->rho, 0, 0};
    const double speed = 2 * R / ((sedov->d + 2) * t), behind = 2 / (gamma + 1);
    const struct profile s = profile_of(gamma, sedov->d, r / R);
    return (struct sedov_state){sedov->rho * (gamma + 1) / (gamma - 1) * s.rho,
                                behind * speed * s.v, behind * sedov->rho * speed * speed * s.P};
}

struct integrand {
    const struct sedov *sedov;
    double t;
    double (*of)(double r, const struct sedov_state *state);
};

/* By x = r^d/d: r^(d - 1) dr = dx. */
static double integrand_at(double x, void *parameters)
{
    const struct integrand *in = parameters;
    const double r = pow(x * in->sedov->d, 1. / in->sedov->d);
    const struct sedov_state state = sedov_sample(in->sedov, r, in->t);
    return in->of(r, &state);
}

double sedov_integral(const struct sedov *sedov, double r, double t,
                      double (*of)(double r, const struct sedov_state *state))
{
    struct integrand in = {sedov, t, of};
    gsl_function f = {integrand_at, &in};
    gsl_integration_workspace *room = gsl_integration_workspace_alloc(200);
    if (!room) return NAN;
    gsl_error_handler_t *const handler = gsl_set_error_handler_off();
    const double front = sedov_shock(sedov, t);
    const double ends[] = {0, fmin(r, front), r};
    double sum = 0;
    for (int k = 0; k < 2; k++) { /* on either side of the shock */
        double part, error;
        const int status = gsl_integration_qag(&f, pow(ends[k], sedov->d) / sedov->d,
                                               pow(ends[k + 1], sedov->d) / sedov->d, 0, 1e-10, 200,
                                               GSL_INTEG_GAUSS31, room, &part, &error);
        sum += status && status != GSL_EROUND ? (double)NAN : part;
    }
    gsl_set_error_handler(handler);
    gsl_integration_workspace_free(room);
    return spheres[sedov->d] * sum;
}
