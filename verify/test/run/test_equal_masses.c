/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares particles of equal masses with an independent construction. */
#include "test.h"

#include <gsl/gsl_qrng.h>
#include <gsl/gsl_rng.h>

#include "equal_masses.h"
#include "gas.h"
#include "initial.h"

/* A coordinate of Sobol's sequence scrambled by a seed, before its shift, computed independently:
 * its first 30 bits XOR those of a constant times (seed - 1). */
static double digits_added(double part, int d, uint64_t seed)
{
    static const uint64_t roots[] = {0x9e3779b9, 0x6a09e667, 0xbb67ae85, 0x3c6ef373};
    const uint64_t digits = (seed - 1) * roots[d] % (1 << 30);
    return (double)((uint64_t)ldexp(part, 30) ^ digits) / (1 << 30);
}

/* The construction: Sobol's sequence with scrambled digits, shifted; each point is kept with a
 * probability that follows from the density. */
TEST(equal_masses_follow_the_density)
{
    for (int dim = 2; dim <= 3; dim++) {
        enum { N = 50 };
        const struct settings settings =
            keyed_settings("n=50 lattice=random seed=5 equal_masses=yes");
        const struct prepared p = {.problem = &gas_problem, .domain = {dim, {-1, 0, 1}, {1, 3, 2}}};
        const int side = dim == 2 ? 512 : 96;
        double mass = 0, most = 0, shift[4];
        for (int k = 0; k < (dim == 2 ? 1 : side); k++)
            for (int j = 0; j < side; j++)
                for (int i = 0; i < side; i++) {
                    const double x[] = {-1 + 2 * (i + 0.5) / side, 3 * (j + 0.5) / side,
                                        dim == 2 ? 0 : 1 + (k + 0.5) / side};
                    mass += gas_density(x);
                    most = fmax(most, gas_density(x));
                }
        mass *= 6 / pow(side, dim);
        most *= 1.01;
        struct initial initial;
        struct error error = {0};
        if (initial_fill(&p, &settings, &initial, &error)) fail_msg("%s", error.message);
        assert_int_equal(initial.n, N);
        gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
        gsl_qrng *sequence = gsl_qrng_alloc(gsl_qrng_sobol, (unsigned)dim + 1);
        gsl_rng_set(random, 5);
        for (int d = 0; d < 4; d++) shift[d] = gsl_rng_uniform(random);
        int refused = 0;
        for (int i = 0; i < N;) {
            double part[4], x[3] = {0};
            gsl_qrng_get(sequence, part);
            for (int d = 0; d <= dim; d++)
                part[d] = digits_added(part[d], d, 5) + shift[d], part[d] -= part[d] >= 1;
            for (int d = 0; d < dim; d++)
                x[d] = p.domain.lo[d] + (p.domain.hi[d] - p.domain.lo[d]) * part[d];
            if (part[dim] * most >= gas_density(x)) {
                refused++;
                continue;
            }
            for (int d = 0; d < dim; d++) near_absolute(initial.x[d][i] + 9, x[d] + 9, 1e-14);
            near_relative(initial.m[i], mass / N, 1e-11);
            assert_true(initial.rho[i] == gas_density(x) ||
                        fabs(initial.rho[i] / gas_density(x) - 1) < 1e-13);
            i++;
        }
        assert_true(refused > 20);
        gsl_qrng_free(sequence);
        gsl_rng_free(random);
        initial_free(&initial);
    }
}
