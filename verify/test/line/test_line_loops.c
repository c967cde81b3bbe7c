/* SPDX-License-Identifier: GPL-3.0-or-later
 * The sums in 1D, range by range, against the equations of CONVENTIONS in extended precision, on
 * particles whose every value is drawn: every kernel with every kind of density sum, matrix and
 * gradient, every formulation with every viscosity and energy. What was not asked for stays. */
#include "test.h"

#include <math.h>
#include <string.h>

#include "line/loops.h"
#include "draw.h"
#include "near.h"

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

static const struct {
    ptrdiff_t first;
    int len;
    ptrdiff_t D;
} ranges[] = {{0, 64, 2}, {64, 64, 5}, {67, 11, 4}, {128, 12, 1}, {139, 1, 6}};
enum { RANGES = sizeof ranges / sizeof *ranges };

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

TEST(density)
{
    const struct particles a = gas();
    for (size_t k = 0; k < kernel_family.n; k++)
        for (int terms = 0; terms < DENSITY_TERMS; terms++)
            for (int specialised = 0; specialised < 2; specialised++)
                for (int r = 0; r < RANGES; r++) {
                    const struct kernel kernel = kernel_of(k), asks = asking(&kernel, specialised);
                    double h_inverse[BATCH_MAX];
                    struct density_sums sums;
                    for (int i = 0; i < BATCH_MAX; i++)
                        h_inverse[i] = 1 / draw(1.5, 3.5), sums.Z[i] = sums.Z_dh[i] = untouched;
                    loop_density(specialised ? (int)k : -1, (enum density_terms)terms)(
                        &asks, &a, ranges[r].first, ranges[r].len, ranges[r].D, h_inverse, &sums);
                    for (int i = 0; i < ranges[r].len; i++) {
                        real want[4] = {0};
                        for (ptrdiff_t d = -ranges[r].D; d <= ranges[r].D; d++) {
                            const ptrdiff_t at = ranges[r].first + i, j = at + d;
                            const real q = fabsl((real)a.x[0][j] - a.x[0][at]) * h_inverse[i],
                                       w = w_of(&kernel, q), dh = w + q * dw_of(&kernel, q);
                            want[0] += a.m[j] * w, want[1] += a.m[j] * dh;
                            want[2] += a.U[j] * w, want[3] += a.U[j] * dh;
                        }
                        near_sum(sums.m[i], want[0], 1e-14);
                        near_sum(sums.m_dh[i], want[1], 3e-14);
                        if (terms == DENSITY_MASS) {
                            assert_true(sums.Z[i] == untouched && sums.Z_dh[i] == untouched);
                            continue;
                        }
                        near_sum(sums.Z[i], want[2], 1e-14);
                        near_sum(sums.Z_dh[i], want[3], 3e-14);
                    }
                }
    struct particles done = a;
    particles_destroy(&done);
}

TEST(matrices)
{
    for (size_t k = 0; k < kernel_family.n; k++)
        for (int way = 1; way < 4; way++) /* bit 0: with a matrix; bit 1: with slopes */
            for (int specialised = 0; specialised < 2; specialised++)
                for (int r = 0; r < RANGES; r++) {
                    struct particles a = gas();
                    const struct kernel kernel = kernel_of(k), asks = asking(&kernel, specialised);
                    const ptrdiff_t first = ranges[r].first, end = first + ranges[r].len;
                    const ptrdiff_t alone = first + ranges[r].len / 2;
                    if (ranges[r].len > 1) a.h_inverse[alone] = 3; /* nobody is near */
                    for (ptrdiff_t i = FIRST_OF_ALL; i < END_OF_ALL; i++)
                        a.g[i] = a.dv[i] = untouched;
                    loop_matrix(specialised ? (int)k : -1,
                                way & 1 ? GRADIENT_IA : GRADIENT_STANDARD,
                                way & 2)(&asks, &a, first, ranges[r].len, ranges[r].D);
                    for (ptrdiff_t i = FIRST_OF_ALL; i < END_OF_ALL; i++) {
                        const bool inside = i >= first && i < end;
                        real second = 0, slope = 0;
                        for (ptrdiff_t d = -ranges[r].D; inside && d <= ranges[r].D; d++) {
                            const real x = (real)a.x[0][i + d] - a.x[0][i],
                                       w = w_of(&kernel, fabsl(x) * a.h_inverse[i]);
                            second += a.V[i + d] * x * x * w;
                            slope += a.V[i + d] * ((real)a.v[0][i + d] - a.v[0][i]) * x * w;
                        }
                        const real g = second > 0 ? 1 / second : 0;
                        const double bound = 1e-13 * fmax(1, (double)g);
                        if (inside && way & 1)
                            near_sum(a.g[i], g, bound);
                        else
                            assert_true(a.g[i] == untouched);
                        if (inside && way & 2)
                            near_sum(a.dv[i], g * slope, bound);
                        else
                            assert_true(a.dv[i] == untouched);
                        if (i == alone && ranges[r].len > 1) assert_true(inside && g == 0);
                    }
                    particles_destroy(&a);
                }
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

/* --- forces ----------------------------------------------------------------------------------- */

/* Gradients of a pair that are no kernel's. */
static double known_G(ptrdiff_t i, ptrdiff_t d)
{
    return 1 + 0.5 * sin((double)(7 * i + 3 * d));
}

static double known_G_j(ptrdiff_t i, ptrdiff_t d)
{
    return 1 + 0.5 * sin((double)(5 * i + 11 * d + 1));
}

static void known_gradient(const struct kernel *kernel, const struct particles *particles,
                           ptrdiff_t first, int pairs, ptrdiff_t d, double *G, double *G_j)
{
    (void)kernel, (void)particles;
    for (int i = 0; i < pairs; i++) G[i] = known_G(first + i, d), G_j[i] = known_G_j(first + i, d);
}

static real square(real x)
{
    return x * x;
}

/* CONVENTIONS eqs. 5.6 to 5.13: m_i m_j PI G/2 of the pair (i, j), j to the right. */
static real viscous(const struct loops *loops, const struct particles *a, ptrdiff_t i, ptrdiff_t j,
                    real G)
{
    const struct pair_numbers *numbers = &loops->numbers;
    const real r = (real)a->x[0][j] - a->x[0][i], hbar = ((real)a->h[i] + a->h[j]) / 4,
               rho = ((real)a->rho[i] + a->rho[j]) / 2, s = a->dv[i], t = a->dv[j],
               q = r * fminl(a->h_inverse[i], a->h_inverse[j]);
    real c = ((real)a->c[i] + a->c[j]) / 2, alpha = numbers->alpha, beta = numbers->beta,
         w = (real)a->v[0][i] - a->v[0][j];
    if (loops->viscosity == VISCOSITY_NONE || w <= 0) return 0;
    if (loops->viscosity == VISCOSITY_TIME_DEPENDENT) {
        alpha = ((real)a->alpha[i] + a->alpha[j]) / 2;
        beta = numbers->beta_ratio * alpha;
    }
    if (loops->viscosity == VISCOSITY_RECONSTRUCTED) {
        const real near = q < numbers->near ? expl(-square((numbers->near - q) / 0.2L)) : 1;
        w += fmaxl(0, 4 * s * t / square(s + t)) * near / 2 * (s + t) * r;
        if (w <= 0) return 0;
    }
    if (loops->viscosity == VISCOSITY_FADING) c *= fminl(1, w / (0.01L * c));
    const real mu = hbar * r * w / (r * r + 0.01L * hbar * hbar);
    return a->m[i] * (real)a->m[j] * G / 2 * (alpha * c * mu + beta * mu * mu) / rho;
}

/* What particle i gets from its pair with i + d, d of either sign. */
struct share {
    real F, de, div_v;
};

static struct share share_of(const struct loops *loops, const struct particles *a, ptrdiff_t i,
                             ptrdiff_t d)
{
    const bool vanilla = loops->formulation == FORMULATION_VANILLA_ICE;
    const ptrdiff_t l = d > 0 ? i : i + d, r = d > 0 ? i + d : i, apart = d > 0 ? d : -d;
    const double *Z = loops->energy_element ? a->U : a->m;
    const real G = known_G(l, apart), G_r = vanilla ? G : (real)known_G_j(l, apart),
               half = viscous(loops, a, l, r, (G + G_r) / 2),
               closing = (real)a->v[0][l] - a->v[0][r];
    const real of_l = half + (vanilla ? (real)a->V[l] * a->V[r] * G * a->P[l]
                                      : a->b[l] * (Z[r] - (real)a->m[r] * a->grad_h[l]) * G),
               of_r = half + (vanilla ? (real)a->V[l] * a->V[r] * G * a->P[r]
                                      : a->b[r] * (Z[l] - (real)a->m[l] * a->grad_h[r]) * G_r);
    const real flux = of_r * a->v[0][l] + of_l * a->v[0][r];
    return (struct share){.F = (d > 0 ? -1 : 1) * (of_l + of_r),
                          .de = loops->energy == ENERGY_TOTAL ? (d > 0 ? -1 : 1) * flux
                                                              : (d > 0 ? of_l : of_r) * closing,
                          .div_v = -a->V[i + d] * closing * (G + G_r) / 2};
}

/* Leaves nothing behind that a sum could begin with. */
__attribute__((noinline)) static void poison_the_stack(void)
{
    double deep[2000];
    memset(deep, 0xff, sizeof deep); /* not a number */
    __asm__ volatile("" : : "r"(deep) : "memory");
}

TEST(forces)
{
    const int viscosities = (int)scheme_members(&scheme_viscosity_family, 1);
    static double scratch[FORCE_STRIPS * (BATCH_MAX + 16)];
    for (int way = 0; way < 32; way++)
        for (int viscosity = 0; viscosity < viscosities; viscosity++)
            for (int r = 0; r < RANGES; r++) {
                struct particles a = gas();
                const ptrdiff_t first = ranges[r].first, end = first + ranges[r].len;
                const struct loops loops = {
                    .gradient = known_gradient,
                    .formulation = way & 1 ? FORMULATION_LAGRANGIAN : FORMULATION_VANILLA_ICE,
                    .energy = way & 2 ? ENERGY_TOTAL : ENERGY_INTERNAL,
                    .viscosity = (enum viscosity)viscosity,
                    .energy_element = way & 4,
                    .div_v = way & 8,
                    .numbers = {.alpha = 0.75, .beta = 1.7, .beta_ratio = 2.3, .near = 0.4}};
                if (viscosity == VISCOSITY_FADING) /* some below, some above a hundredth of c */
                    for (ptrdiff_t i = FIRST_OF_ALL; i < END_OF_ALL; i++) a.v[0][i] *= 0.02;
                assert_true(loop_force_scratch(ranges[r].D) <= sizeof scratch / sizeof *scratch);
                poison_the_stack();
                loop_force(way & 16, loops.formulation, loops.viscosity,
                           loops.energy)(&loops, &a, first, ranges[r].len, ranges[r].D, scratch);
                for (ptrdiff_t i = FIRST_OF_ALL; i < END_OF_ALL; i++) {
                    if (i < first || i >= end) {
                        assert_true(a.F[0][i] == untouched && a.de[i] == untouched &&
                                    a.div_v[i] == untouched);
                        continue;
                    }
                    struct share want = {0, 0, 0};
                    for (ptrdiff_t d = -ranges[r].D; d <= ranges[r].D; d++) {
                        const struct share one =
                            d ? share_of(&loops, &a, i, d) : (struct share){0, 0, 0};
                        want.F += one.F, want.de += one.de, want.div_v += one.div_v;
                    }
                    /* the damping of close pairs is known to 8e-7 */
                    const double bound = viscosity == VISCOSITY_RECONSTRUCTED ? 3e-6 : 3e-13;
                    near_sum(a.F[0][i], want.F, bound);
                    near_sum(a.de[i], want.de, bound);
                    if (loops.div_v)
                        near_sum(a.div_v[i], want.div_v, 3e-13);
                    else
                        assert_true(a.div_v[i] == untouched);
                }
                particles_destroy(&a);
            }
}

/* Where nobody is near, twice the speed of sound alone, however cold the gas is. */
TEST(rates_of_cold_gas)
{
    static double scratch[FORCE_STRIPS * (BATCH_MAX + 16)];
    struct particles a = gas();
    const struct loops loops = {.gradient = known_gradient};
    double want = 0;
    for (ptrdiff_t i = FIRST_OF_ALL; i < END_OF_ALL; i++) a.c[i] *= 1e-12, a.h_inverse[i] = 3;
    for (ptrdiff_t i = 20 - 4; i < 40; i++) want = fmax(want, 2 * a.c[i] * 3);
    for (int specialised = 0; specialised < 2; specialised++)
        near_relative(loop_force(specialised, loops.formulation, loops.viscosity,
                                 loops.energy)(&loops, &a, 20, 20, 4, scratch),
                      want, 1e-15);
    for (int mirrored = 0; mirrored < 2; mirrored++) { /* inside the wider width alone */
        a.h_inverse[30 + mirrored] = 3, a.h_inverse[31 - mirrored] = 0.5;
        a.x[0][31] = a.x[0][30] + 1, a.x[0][32] = a.x[0][30] + 1.5;
        for (ptrdiff_t i = FIRST_OF_ALL; i < END_OF_ALL; i++) a.v[0][i] = i <= 30 ? 1 : 0;
        near_relative(loop_force(false, loops.formulation, loops.viscosity,
                                 loops.energy)(&loops, &a, 20, 20, 1, scratch),
                      3 * (a.c[30] + a.c[31] + 3), 1e-15);
    }
    particles_destroy(&a);
}

/* CONVENTIONS eq. 5.14, of those within the wider of two widths, and twice the own speed of sound.
 */
TEST(signals)
{
    for (int r = 0; r < RANGES; r++) {
        struct particles a = gas();
        const ptrdiff_t first = ranges[r].first, end = first + ranges[r].len;
        for (ptrdiff_t i = FIRST_OF_ALL; i < END_OF_ALL; i++) a.signal[i] = -untouched;
        a.c[first + ranges[r].len / 2] = 9;
        a.x[0][first + 1] = a.x[0][first] + 0.25, a.h_inverse[first] = 4; /* exactly at its edge */
        a.h_inverse[first + 1] = 8;
        loops_signal(&a, first, ranges[r].len, ranges[r].D);
        for (ptrdiff_t i = FIRST_OF_ALL; i < END_OF_ALL; i++) {
            double want = -untouched;
            for (ptrdiff_t d = -ranges[r].D; i >= first && i < end && d <= ranges[r].D; d++) {
                const double apart = fabs(a.x[0][i + d] - a.x[0][i]),
                             closing = (d < 0 ? -1 : 1) * (a.v[0][i] - a.v[0][i + d]);
                if (want == -untouched) want = 2 * a.c[i];
                if (d && apart * fmin(a.h_inverse[i], a.h_inverse[i + d]) < 1)
                    want = fmax(want, a.c[i] + a.c[i + d] + 3 * fmax(closing, 0));
            }
            near_relative(a.signal[i], want, 1e-15);
        }
        for (ptrdiff_t i = FIRST_OF_ALL; i < END_OF_ALL; i++) a.c[i] *= 1e-12, a.v[0][i] = 0;
        loops_signal(&a, first, ranges[r].len, ranges[r].D); /* very cold */
        for (ptrdiff_t i = first; i < end; i++) near_inside(a.signal[i], 2 * a.c[i], 2e-11);
        particles_destroy(&a);
    }
}

/* --- choosing --------------------------------------------------------------------------------- */

/* Every kernel has its own, and so has none. */
TEST(specialised_ones_differ)
{
    const int kernels = (int)kernel_family.n;
    for (int k = -1; k < kernels; k++)
        for (int other = -1; other < k; other++) {
            assert_true(loop_density(k, DENSITY_MASS) != loop_density(other, DENSITY_MASS));
            assert_true(loop_matrix(k, GRADIENT_IA, true) != loop_matrix(other, GRADIENT_IA, true));
            assert_true(loop_gradient(k, GRADIENT_IA, PAIR_WIDTH_MEAN) !=
                        loop_gradient(other, GRADIENT_IA, PAIR_WIDTH_MEAN));
        }
    for (int one = 0; one < FORMULATIONS * ENERGIES; one++)
        for (int other = 0; other <= one; other++) {
            force_loop *const of_one = loop_force(true, (enum formulation)(one / ENERGIES),
                                                  VISCOSITY_FADING, (enum energy)(one % ENERGIES));
            assert_true((of_one == loop_force(true, (enum formulation)(other / ENERGIES),
                                              VISCOSITY_FADING, (enum energy)(other % ENERGIES))) ==
                        (one == other));
            assert_true(of_one != loop_force(false, 0, 0, 0));
        }
}

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
