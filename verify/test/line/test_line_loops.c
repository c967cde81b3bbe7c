/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gradients of pairs in 1D, range by range, against the equations of CONVENTIONS in extended
 * precision, on particles whose every value is drawn; which loops plan and scheme choose. The sums
 * themselves are compared by the checks hydro/rates and hydro/specialised. */
#include "test.h"

#include "line/loops.h"
#include "draw.h"

typedef long double real;

enum { N = 140, GHOSTS = 16, FIRST_OF_ALL = -GHOSTS, END_OF_ALL = N + GHOSTS };

static const double untouched = 1234;

/* Positions in order, a spacing of 1 in the mean; widths of two and a half. */
static struct particles gas(void)
{
    struct particles a;
    struct error error;
    double x = -3;
    if (particles_create(&a, 1, N, GHOSTS, &error)) fail_msg("%s", error.message);
    for (ptrdiff_t i = FIRST_OF_ALL; i < END_OF_ALL; i++) {
        a.x[0][i] = x += draw(0.5, 1.5);
        a.v[0][i] = draw(-1, 1), a.m[i] = draw(0.5, 2), a.U[i] = draw(0.5, 2);
        a.h[i] = draw(1.5, 3.5), a.h_inverse[i] = 1 / draw(1.5, 3.5), a.V[i] = draw(0.5, 2);
        a.P[i] = draw(0.5, 2), a.rho[i] = draw(0.5, 2), a.c[i] = draw(0.1, 2);
        a.alpha[i] = draw(0.1, 1), a.b[i] = draw(0.5, 2), a.grad_h[i] = draw(-0.2, 0.2);
        a.g[i] = draw(0.5, 2), a.dv[i] = draw(-1, 1);
        a.F[0][i] = a.de[i] = a.div_v[i] = a.signal[i] = untouched;
    }
    return a;
}

static struct kernel kernel_of(size_t k)
{
    struct kernel kernel;
    struct error error;
    if (kernel_select(&kernel, kernel_family.members[k]->name, 6, &error))
        fail_msg("%s", error.message);
    return kernel;
}

static real w_of(const struct kernel *kernel, real q)
{
    return q < 1 ? kernel->w(kernel, (double)q, 1) : 0;
}

static real dw_of(const struct kernel *kernel, real q)
{
    return q < 1 ? kernel->dw(kernel, (double)q, 1) : 0;
}

static void near_sum(double got, real want, double bound)
{
    near_below(fabs(got - (double)want), bound);
}

/* A kernel of one dimension, for the loops that are not specialised. */
static const struct kernel *inner;

static double asked_w(const struct kernel *kernel, double q, int dim)
{
    assert_int_equal(dim, 1);
    return inner->w(kernel, q, dim);
}

static double asked_dw(const struct kernel *kernel, double q, int dim)
{
    assert_int_equal(dim, 1);
    return inner->dw(kernel, q, dim);
}

static struct kernel asking(const struct kernel *kernel, bool specialised)
{
    struct kernel asks = *kernel;
    inner = kernel;
    if (!specialised) asks.w = asked_w, asks.dw = asked_dw;
    return asks;
}

/* CONVENTIONS eqs. 4.1 and 4.3 at one width. */
static real gradient_at(const struct kernel *kernel, bool ia, real g, real r, real h_inverse)
{
    return g * (ia ? r * w_of(kernel, r * h_inverse) : -dw_of(kernel, r * h_inverse));
}

TEST(gradients)
{
    struct particles a = gas();
    for (size_t k = 0; k < kernel_family.n; k++)
        for (int ia = 0; ia < 2; ia++)
            for (int width = 0; width < PAIR_GRADIENTS; width++)
                for (int specialised = 0; specialised < 2; specialised++)
                    for (ptrdiff_t d = 1; d < 4; d++) {
                        const struct kernel kernel = kernel_of(k),
                                            asks = asking(&kernel, specialised);
                        const ptrdiff_t first = 60 - 20 * d;
                        const int pairs = 16 + (int)d;
                        double G[32], G_j[32];
                        for (int i = 0; i < 32; i++) G[i] = G_j[i] = untouched;
                        loop_gradient(specialised ? (int)k : -1,
                                      ia ? GRADIENT_IA : GRADIENT_STANDARD,
                                      width)(&asks, &a, first, pairs, d, G, G_j);
                        for (int p = 0; p < 32; p++) {
                            const ptrdiff_t i = first + p, j = i + d;
                            const real r = (real)a.x[0][j] - a.x[0][i], s = a.h_inverse[i],
                                       t = a.h_inverse[j],
                                       at_i = gradient_at(&kernel, ia, a.g[i], r, s),
                                       at_j = gradient_at(&kernel, ia, a.g[j], r, t),
                                       one = width == PAIR_WIDTH_MAX ? fminl(s, t) : (s + t) / 2,
                                       scale = ia ? ((real)a.g[i] + a.g[j]) / 2
                                                  : kernel.constant[1] * one * one;
                            const bool own = width == PAIR_WIDTH_OWN;
                            if (p < pairs)
                                near_sum(G[p],
                                         own ? at_i
                                         : width == PAIR_WIDTH_MEAN
                                             ? (at_i + at_j) / 2
                                             : gradient_at(&kernel, ia, scale, r, one),
                                         1e-13);
                            else if (p >= 24)
                                assert_true(G[p] == untouched);
                            if (p < pairs && own)
                                near_sum(G_j[p], at_j, 1e-13);
                            else if (p >= 24 || !own)
                                assert_true(G_j[p] == untouched);
                        }
                    }
    particles_destroy(&a);
}

/* --- choosing --------------------------------------------------------------------------------- */

TEST(chosen_by_plan_and_scheme)
{
    for (size_t k = 0; k < kernel_family.n; k++)
        for (int way = 0; way < 128; way++) {
            const struct plan plan = {.specialised = way & 1,
                                      .energy_sum = way & 2,
                                      .matrix = way & 4,
                                      .slope = way & 8,
                                      .grad_h = way & 16,
                                      .alpha = way & 32};
            const struct scheme scheme = {.kernel = kernel_of(k),
                                          .gradient = way & 64 ? GRADIENT_IA : GRADIENT_STANDARD,
                                          .formulation = FORMULATION_LAGRANGIAN,
                                          .viscosity = VISCOSITY_FADING,
                                          .energy = ENERGY_TOTAL,
                                          .pair_width = PAIR_WIDTH_MAX,
                                          .alpha = way & 64 ? 0 : 0.5,
                                          .beta = 1.25,
                                          .eta = 1.6};
            const int specialisation = way & 1 ? (int)k : -1;
            struct loops loops;
            loops_choose(&plan, &scheme, &loops);
            assert_true(loops.kernel == &scheme.kernel);
            assert_int_equal(loops.formulation, FORMULATION_LAGRANGIAN);
            assert_int_equal(loops.viscosity, VISCOSITY_FADING);
            assert_int_equal(loops.energy, ENERGY_TOTAL);
            assert_true(loops.energy_element == plan.energy_sum && loops.div_v == plan.alpha);
            assert_true(loops.numbers.alpha == scheme.alpha && loops.numbers.beta == 1.25);
            assert_true(loops.numbers.near == 1 / 1.6);
            assert_true(loops.numbers.beta_ratio == (!plan.alpha ? 0 : way & 64 ? 2 : 2.5));
            assert_true(loops.density ==
                        loop_density(specialisation, way & 2 ? DENSITY_ENERGY : DENSITY_MASS));
            matrix_loop *const matrices_of[] = {NULL,
                                                loop_matrix(specialisation, scheme.gradient, false),
                                                loop_matrix(specialisation, scheme.gradient, true),
                                                loop_matrix(specialisation, scheme.gradient, true)};
            assert_true(loops.matrix == matrices_of[way / 4 % 4]);
            assert_true(loops.gradient ==
                        loop_gradient(specialisation, scheme.gradient,
                                      plan.grad_h ? PAIR_WIDTH_OWN : (int)PAIR_WIDTH_MAX));
            assert_true(loops.force == loop_force(way & 1, FORMULATION_LAGRANGIAN, VISCOSITY_FADING,
                                                  ENERGY_TOTAL));
        }
}
