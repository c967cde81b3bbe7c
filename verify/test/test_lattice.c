/* SPDX-License-Identifier: GPL-3.0-or-later
 * Lattices and quasi-random points of the whole box, worked out a second time. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <gsl/gsl_qrng.h>
#include <gsl/gsl_rng.h>

#include "gas.h"
#include "initial_fill.h"
#include "lattice.h"
#include "near.h"

static void the_whole_box_is_laid(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        static char *keys[] = {"n=64", "lattice=random", "seed=3"};
        const struct prepared p = {.problem = &gas_problem, .domain = {dim, {-1, 0, 1}, {1, 3, 2}}};
        for (int random = 0; random < 2; random++) {
            keys[1] = random ? "lattice=random" : "lattice=hexagonal";
            const struct settings settings = gas_settings(3, keys);
            struct lattice_plan plan;
            struct initial initial;
            struct error error = {0};
            assert_int_equal(initial_fill(&p, &settings, &initial, &error), STATUS_OK);
            assert_int_equal(lattice_plan_make(&plan, &p.domain,
                                               random ? LATTICE_RANDOM : LATTICE_HEXAGONAL, 64,
                                               &error),
                             STATUS_OK);
            double y[3][100], shift[3];
            double *const x[] = {y[0], y[1], y[2]};
            assert_true(plan.n == initial.n && plan.n < 100);
            gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
            gsl_qrng *sequence = gsl_qrng_alloc(gsl_qrng_sobol, (unsigned)dim);
            gsl_rng_set(rng, 3);
            for (int d = 0; d < 3; d++) shift[d] = gsl_rng_uniform(rng);
            if (!random) assert_int_equal(lattice_points(&plan, 3, x, &error), STATUS_OK);
            for (size_t i = 0; i < plan.n; i++) {
                double part[3], place[3] = {0};
                gsl_qrng_get(sequence, part);
                for (int d = 0; d < dim; d++) {
                    part[d] += shift[d];
                    if (random)
                        y[d][i] = p.domain.lo[d] +
                                  (p.domain.hi[d] - p.domain.lo[d]) * (part[d] - floor(part[d]));
                    near_absolute(initial.x[d][i] + 9, y[d][i] + 9, 1e-14);
                    place[d] = initial.x[d][i];
                }
                near_relative(initial.m[i], 6. / (double)plan.n * gas_density(place), 1e-14);
            }
            gsl_qrng_free(sequence);
            gsl_rng_free(rng);
            initial_free(&initial);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_whole_box_is_laid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
