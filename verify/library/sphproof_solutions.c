/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sphproof/solutions.h"

#include <math.h>

#include "library.h"
#include "noh.h"
#include "riemann.h"
#include "sedov.h"
#include "simple_wave.h"
#include "vortex.h"

/* Sets the error if there is a text. */
static enum sphproof_status fault(const char *text, struct sphproof_error *error)
{
    return text ? library_fail(error, STATUS_BAD_INPUT, "%s", text) : SPHPROOF_OK;
}

/* Checks that all positions are finite and not below `least`. */
static enum sphproof_status check(size_t n, const double *at, double least,
                                  struct sphproof_error *error)
{
    for (size_t i = 0; i < n; i++)
        if (!isfinite(at[i]) || at[i] < least)
            return library_fail(error, STATUS_BAD_INPUT, "position %zu is %g: allowed: finite%s", i,
                                at[i], least == 0 ? ", 0 or more" : "");
    return SPHPROOF_OK;
}

static const double anywhere = -(double)INFINITY, radius = 0;

static enum sphproof_status solve(double gamma, const double left[3], const double right[3],
                                  struct riemann_solution *solution, struct sphproof_error *error)
{
    const struct riemann_state l = {left[0], left[1], left[2]}, r = {right[0], right[1], right[2]};
    return fault(riemann_solve(gamma, &l, &r, solution), error);
}

enum sphproof_status sphproof_solutions_riemann(double gamma, const double left[3],
                                                const double right[3], double x0, double t,
                                                size_t n, const double *x, double *rho, double *v,
                                                double *P, struct sphproof_error *error)
{
    struct riemann_solution solution;
    if (!isfinite(x0)) return fault("x0: allowed: finite", error);
    if (!(t >= 0 && isfinite(t))) return fault("t: allowed: finite, 0 or more", error);
    if (solve(gamma, left, right, &solution, error) || check(n, x, anywhere, error))
        return SPHPROOF_BAD_INPUT;
    for (size_t i = 0; i < n; i++) {
        const struct riemann_state s = riemann_sample(&solution, x[i], x0, t);
        rho[i] = s.rho, v[i] = s.v, P[i] = s.P;
    }
    return SPHPROOF_OK;
}

enum sphproof_status sphproof_solutions_star(double gamma, const double left[3],
                                             const double right[3], struct sphproof_star *star,
                                             struct sphproof_error *error)
{
    struct riemann_solution s;
    if (solve(gamma, left, right, &s, error)) return SPHPROOF_BAD_INPUT;
    *star =
        (struct sphproof_star){s.p_star,
                               s.v_star,
                               s.rho_star_left,
                               s.rho_star_right,
                               {s.left_head, s.left_tail, s.contact, s.right_tail, s.right_head}};
    return SPHPROOF_OK;
}

enum sphproof_status sphproof_solutions_sedov(double gamma, int dim, double rho0, double E,
                                              double t, size_t n, const double *r, double *rho,
                                              double *v, double *P, double *shock,
                                              struct sphproof_error *error)
{
    struct sedov sedov;
    if (!(t > 0 && isfinite(t))) return fault("t: allowed: finite, above 0", error);
    if (fault(sedov_solve(gamma, dim, rho0, E, &sedov), error) || check(n, r, radius, error))
        return SPHPROOF_BAD_INPUT;
    if (shock) *shock = sedov_shock(&sedov, t);
    for (size_t i = 0; i < n; i++) {
        const struct sedov_state s = sedov_sample(&sedov, r[i], t);
        rho[i] = s.rho, v[i] = s.v, P[i] = s.P;
    }
    return SPHPROOF_OK;
}

enum sphproof_status sphproof_solutions_noh(double gamma, int dim, double t, size_t n,
                                            const double *r, double *rho, double *v, double *P,
                                            struct sphproof_error *error)
{
    if (!(gamma > 1 && isfinite(gamma)) || dim < 1 || dim > 3 || !(t >= 0 && isfinite(t)))
        return fault("allowed: gamma > 1, dim from 1 to 3, t of 0 or more, all finite", error);
    if (check(n, r, radius, error)) return SPHPROOF_BAD_INPUT;
    for (size_t i = 0; i < n; i++) {
        const struct noh_state s = noh_sample(gamma, dim, r[i], t);
        rho[i] = s.rho, v[i] = s.v, P[i] = s.P;
    }
    return SPHPROOF_OK;
}

enum sphproof_status sphproof_solutions_gresho(size_t n, const double *r, double *rho, double *v,
                                               double *P, struct sphproof_error *error)
{
    if (check(n, r, radius, error)) return SPHPROOF_BAD_INPUT;
    for (size_t i = 0; i < n; i++) {
        const struct vortex_state s = vortex_gresho(r[i]);
        rho[i] = s.rho, v[i] = s.v, P[i] = s.P;
    }
    return SPHPROOF_OK;
}

enum sphproof_status sphproof_solutions_yee(double gamma, double beta, size_t n, const double *r,
                                            double *rho, double *v, double *P,
                                            struct sphproof_error *error)
{
    if (!(gamma > 1) || !(vortex_yee(0, beta, gamma).P > 0))
        return fault("allowed: gamma > 1, and beta so small that the centre is not empty", error);
    if (check(n, r, radius, error)) return SPHPROOF_BAD_INPUT;
    for (size_t i = 0; i < n; i++) {
        const struct vortex_state s = vortex_yee(r[i], beta, gamma);
        rho[i] = s.rho, v[i] = s.v, P[i] = s.P;
    }
    return SPHPROOF_OK;
}

enum sphproof_status sphproof_solutions_wave(double gamma, double rho0, double v0, double P0,
                                             double amplitude, double length, double t, size_t n,
                                             const double *x, double *rho, double *v, double *P,
                                             struct sphproof_error *error)
{
    const struct simple_wave wave = {gamma, rho0, v0, P0, amplitude, length};
    if (fault(simple_wave_fault(&wave), error)) return SPHPROOF_BAD_INPUT;
    if (!(t >= 0 && t < simple_wave_breaking_time(&wave)))
        return library_fail(error, STATUS_BAD_INPUT, "t = %g: allowed: from 0 to below %g", t,
                            simple_wave_breaking_time(&wave));
    if (check(n, x, anywhere, error)) return SPHPROOF_BAD_INPUT;
    for (size_t i = 0; i < n; i++) {
        const struct simple_wave_state s = simple_wave_sample(&wave, x[i], t);
        rho[i] = s.rho, v[i] = s.v, P[i] = s.P;
    }
    return SPHPROOF_OK;
}
