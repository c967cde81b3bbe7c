/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares the equation of state and the update of widths, particle by particle and for random
 * sums, with CONVENTIONS in extended precision. Nothing outside of the given range is written. */
#include "test.h"

#include "draw.h"
#include "state.h"

typedef long double real;

enum { N = 150 };

static const double untouched = 1234;

static struct particles gas(int dim)
{
    struct particles a;
    struct error error;
    if (particles_create(&a, dim, N, 0, &error)) fail_msg("%s", error.message);
    for (ptrdiff_t i = 0; i < N; i++) {
        a.m[i] = draw(0.5, 2), a.m_inverse[i] = 1 / a.m[i], a.U[i] = draw(0.5, 2);
        a.h_inverse[i] = 1 / draw(0.5, 2), a.c[i] = draw(0.5, 2), a.e[i] = draw(1, 2);
        a.alpha[i] = draw(0, 2), a.div_v[i] = draw(-1, 1), a.signal[i] = draw(0.5, 2);
        a.h[i] = draw(0.5, 2);
        for (int k = 0; k < dim; k++) a.p[k][i] = draw(-1, 1);
    }
    return a;
}

/* v, U and the number of particles without internal energy: exactly 0, a negative one and NaN all
 * count. */
TEST(primitives)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int total = 0; total < 2; total++) {
            struct particles a = gas(dim);
            int unsound = 0;
            for (int k = 0; k < dim; k++) a.p[k][7] = a.p[k][77] = 0;
            a.e[7] = 0, a.e[8] = -3, a.e[77] = 5e-324, a.e[149] = (double)NAN;
            const double found = state_primitives(&a, total ? 0.5 : 0);
            for (int i = 0; i < N; i++) {
                real U = a.e[i];
                for (int k = 0; k < dim; k++) {
                    near_below(fabs(a.v[k][i] - a.p[k][i] / a.m[i]), 4e-16);
                    U -= total ? (real)a.p[k][i] * a.p[k][i] / 2 / a.m[i] : 0;
                }
                unsound += !(U > 0);
                if (i < 149) near_below(fabs(a.U[i] - (double)U), 2e-15);
            }
            assert_true(found == unsound && unsound >= 3);
            particles_destroy(&a);
        }
}

/* Errors of the widths, and the Newton step that follows: small errors, a derivative that makes the
 * step useless, and errors so large that the step is limited to a factor of 2, up or down. */
enum { LITTLE, STEEP, MUCH_LESS, MUCH_MORE, CASES };

static void draw_sums(struct density_sums *sums, const struct gas *gas, const struct particles *a,
                      ptrdiff_t i, int k, int which)
{
    const double off = which == MUCH_LESS   ? draw(0.01, 0.05)
                       : which == MUCH_MORE ? draw(20, 100)
                                            : draw(0.8, 1.25);
    /* so that eta (m/rho)^(1/d) = off h */
    const double s = a->h_inverse[i];
    sums->m[k] = a->m[i] * pow(gas->eta / off, a->dim) / gas->constant;
    sums->m_dh[k] = (which == STEEP ? draw(1.5, 2) : draw(-0.5, 0.5)) * a->dim * sums->m[k] * off;
    sums->Z[k] = draw(0.5, 2) * s, sums->Z_dh[k] = draw(-1, 1);
}

TEST(state_follows_from_widths)
{
    static const struct {
        ptrdiff_t first;
        int len;
    } ranges[] = {{0, 64}, {64, 64}, {71, 19}, {128, 22}, {149, 1}};
    for (int dim = 1; dim <= 3; dim++)
        for (int way = 0; way < 16; way++)
            for (int r = 0; r < 5; r++) {
                const struct plan plan = {
                    .energy_sum = way & 1, .own_gradient = way & 2, .grad_h = way & 4};
                const struct gas gas_of = {
                    .gamma = 1.6, .constant = 1.25, .eta = 2.2, .follow = way & 8 ? 1.5 : 0};
                struct particles a = gas(dim);
                double *const results[] = {a.h, a.h_inverse_found, a.V, a.rho, a.P, a.c,
                                           a.g, a.grad_h,          a.b};
                struct density_sums sums;
                const ptrdiff_t first = ranges[r].first, end = first + ranges[r].len;
                for (size_t k = 0; k < sizeof results / sizeof *results; k++)
                    for (int i = 0; i < N; i++) results[k][i] = untouched;
                for (int k = 0; k < ranges[r].len; k++)
                    draw_sums(&sums, &gas_of, &a, first + k, k, k % CASES);
                state_close(&a, first, ranges[r].len, &plan, &gas_of, &sums);
                for (ptrdiff_t i = 0; i < N; i++) {
                    const ptrdiff_t k = i - first;
                    if (i < first || i >= end) {
                        for (size_t j = 0; j < sizeof results / sizeof *results; j++)
                            assert_true(results[j][i] == untouched);
                        continue;
                    }
                    const real s = a.h_inverse[i], scale = 1.25L * powl(s, dim),
                               rho = scale * sums.m[k], y = scale * sums.Z[k],
                               u = (real)a.U[i] / a.m[i],
                               asked = powl(rho / a.m[i], 1.0L / dim) / 2.2L,
                               slope =
                                   fmaxl(1 - asked * sums.m_dh[k] / (dim * s * sums.m[k]), 0.25L),
                               V = way & 1 ? a.U[i] / y : a.m[i] / rho,
                               missed = 1 - powl(s / asked, dim),
                               P = way & 1 ? 0.6L * y
                                           : 0.6L * rho * u *
                                                 fmaxl(0.5L, 1 + gas_of.follow * 0.6L * missed),
                               Z = way & 1 ? a.U[i] : a.m[i],
                               dh = way & 1 ? sums.Z_dh[k] : sums.m_dh[k];
                    near_relative(a.h_inverse_found[i],
                                  (double)fmaxl(s / 2, fminl(2 * s, s + (asked - s) / slope)),
                                  4e-14);
                    near_relative(a.h[i], (double)(1 / asked), 4e-15);
                    near_relative(a.V[i], (double)V, 4e-15);
                    if (dim == 1 && !(way & 1)) assert_true(a.h[i] == gas_of.eta * a.V[i]);
                    near_relative(a.rho[i], (double)(way & 1 ? a.m[i] / V : rho), 4e-15);
                    near_relative(a.P[i], (double)P, 2e-14);
                    near_relative(a.c[i], (double)sqrtl(1.6L * 0.6L * u), 4e-15);
                    if (way & 2)
                        near_relative(a.g[i], (double)(scale * s), 4e-15);
                    else
                        assert_true(a.g[i] == untouched);
                    if (!(way & 4)) {
                        assert_true(a.grad_h[i] == untouched && a.b[i] == untouched);
                        continue;
                    }
                    near_relative(a.b[i], (double)(P * V * V / Z), 3e-14);
                    const real under = dim * (real)sums.m[k] - sums.m_dh[k];
                    const real factor = -dh / under, part = dim * sums.m[k] / under;
                    near_below(fabs(a.grad_h[i] - (double)factor),
                               1e-15 * (double)(fabsl(factor) * (1 + fabsl(part))));
                }
                particles_destroy(&a);
            }
}

/* The largest value is found at any index. */
TEST(largest_rates_at_any_index)
{
    struct particles a = gas(1);
    for (int len = 1; len <= 64; len++)
        for (int at = 0; at < len; at++) {
            const double kept = a.signal[40 + at];
            a.signal[40 + at] = 99, a.signal[39] = a.signal[40 + len] = 1e9;
            near_relative(state_rate(&a, 40, len), 99 * a.h_inverse[40 + at], 1e-15);
            for (int i = 0; i < len && at == 0; i++) a.signal[40 + i] = 1e-12; /* very cold */
            if (at == 0) near_inside(state_rate(&a, 40, len), 0.5e-12, 2e-12);
            a.signal[40 + at] = kept, a.signal[39] = a.signal[40 + len] = 1;
        }
    particles_destroy(&a);
}
