/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares the estimate of a run's memory and steps with an independent one. */
#include "test.h"

#include "allowance.h"
#include "estimate.h"
#include "integrator.h"
#include "memory.h"

enum { N = 3 };

static const double v[3][N + 1] = {{1, 2, 6, 99}, {0, 4, 2, 99}, {3, 3, 9, 99}},
                             m[N + 1] = {1, 8, 0.125, 1e-9}, u[N + 1] = {2, 1, 0.5, 1e9},
                             rho[N + 1] = {1, 1, 4, 1e9};

/* The cheapest scheme: density and force with predicted widths. */
static struct setup plain_setup(int dim)
{
    struct setup setup = {.dim = dim,
                          .hi = {1, 1, 1},
                          .gamma = 1.5,
                          .t_end = 0.75e8,
                          .n = N,
                          .v = {v[0], v[1], v[2]},
                          .m = m,
                          .u = u,
                          .rho = rho,
                          .threads = 1};
    struct error error;
    assert_int_equal(kernel_select(&setup.scheme.kernel, "cubic_spline", 0, &error), STATUS_OK);
    setup.scheme.integrator =
        (const struct integrator *)family_find(&integrator_family, "leapfrog");
    assert_non_null(setup.scheme.integrator);
    scheme_default(&setup.scheme, &(struct scheme_open){0}, dim);
    setup.scheme.gradient = GRADIENT_STANDARD;
    setup.scheme.viscosity = VISCOSITY_CONSTANT;
    setup.scheme.balsara = BALSARA_OFF;
    setup.scheme.h_method = H_PREDICTED;
    setup.scheme.eta = 2.5;
    setup.scheme.cfl = 0.2;
    return setup;
}

TEST(estimate_of_memory_and_steps)
{
    static const double ball[] = {0, 2, M_PI, 4 * M_PI / 3};
    for (int dim = 1; dim <= 3; dim++) {
        struct setup setup = plain_setup(dim);
        /* in 2D and 3D the copy of the snapshot reuses the memory of the neighbours */
        const double memory = 7e6 + memory_bytes(&setup) + (dim == 1 ? 8. * N * 8 : 0);
        struct estimate found = estimate_size(&setup);
        near_relative(found.memory, memory, 1e-15);
        assert_true(found.steps == 0 && found.cpu_s == 0);
        /* signal speed: twice the sound speed after motion relative to the mean has become heat */
        double fastest = 0;
        for (int i = 0; i < N; i++) {
            double square = 0;
            for (int d = 0; d < dim; d++)
                square += pow(v[d][i] - (v[d][0] + v[d][1] + v[d][2]) / 3, 2);
            const double h = 2.5 * pow(m[i] / rho[i], 1. / dim);
            fastest = fmax(fastest, 2 * sqrt(1.5 * 0.5 * (u[i] + square / 2)) / h);
        }
        const double steps = ceil(0.75e8 * fastest / 0.2), neighbours = ball[dim] * pow(2.5, dim);
        assert_true(steps > 1e8); /* enough of them to resolve 1e-8 */
        static const struct {
            enum gradient gradient;
            enum viscosity viscosity;
            enum balsara balsara;
            enum h_method h_method;
            double pair; /* ns */
        } rows[] = {
            {GRADIENT_STANDARD, VISCOSITY_CONSTANT, BALSARA_OFF, H_PREDICTED, 12},
            {GRADIENT_IA, VISCOSITY_CONSTANT, BALSARA_OFF, H_PREDICTED, 18},
            {GRADIENT_STANDARD, VISCOSITY_RECONSTRUCTED, BALSARA_OFF, H_PREDICTED, 18},
            {GRADIENT_STANDARD, VISCOSITY_PROJECTED, BALSARA_OFF, H_PREDICTED, 18},
            {GRADIENT_STANDARD, VISCOSITY_CULLEN_DEHNEN, BALSARA_OFF, H_PREDICTED, 18},
            {GRADIENT_STANDARD, VISCOSITY_CONSTANT, BALSARA_ON, H_PREDICTED, 18},
            {GRADIENT_STANDARD, VISCOSITY_CONSTANT, BALSARA_OFF, H_NEWTON, 24},
            {GRADIENT_IA, VISCOSITY_PROJECTED, BALSARA_ON, H_NEWTON, 36},
        };
        for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
            setup.scheme.gradient = rows[k].gradient;
            setup.scheme.viscosity = rows[k].viscosity;
            setup.scheme.balsara = rows[k].balsara;
            setup.scheme.h_method = rows[k].h_method;
            const double step = dim == 1 ? 5 + neighbours : 100 + rows[k].pair * neighbours;
            found = estimate_run(&setup);
            assert_true(found.steps == steps && found.memory == estimate_size(&setup).memory);
            near_relative(found.cpu_s,
                          1e-9 * N * step * (4 + steps * setup.scheme.integrator->evaluations),
                          1e-14);
        }
        setup.n = 1;
        assert_true(estimate_run(&setup).steps > 1);
        setup.n = N;
        setup.rho = NULL;
        found = estimate_run(&setup);
        assert_true(found.steps == 0 && found.cpu_s == 0 && found.memory > 7e6);
        setup.rho = rho;
        setup.n = 0;
        found = estimate_run(&setup);
        assert_true(found.steps == 0 && found.cpu_s == 0 && found.memory >= 7e6);
    }
}

/* A million particles with the best scheme in 3D fit into a GiB. */
TEST(memory_of_a_million_particles)
{
    struct setup setup = plain_setup(3);
    setup.n = 1000000;
    setup.scheme.integrator =
        (const struct integrator *)family_find(&integrator_family, "predicted_midpoint");
    assert_non_null(setup.scheme.integrator);
    setup.scheme.shock_conductivity = 1;
    scheme_default(&setup.scheme,
                   &(struct scheme_open){true, true, true, true, true, true, true, true, true, true,
                                         true, true, true, true, true},
                   3);
    assert_true(setup.scheme.viscosity == VISCOSITY_PROJECTED && setup.scheme.eta == 3.6);
    assert_true(estimate_size(&setup).memory < 0x1p30);
}

/* Gas as cold as possible makes few steps; each step has at least one evaluation. */
TEST(estimate_of_few_steps)
{
    static const double cold[N] = {1e-30, 1e-30, 1e-30}, still[N] = {0};
    struct setup setup = plain_setup(1);
    struct integrator lazy = *setup.scheme.integrator;
    setup.u = cold;
    setup.v[0] = still;
    setup.t_end = 1e6;
    lazy.evaluations = 0;
    setup.scheme.integrator = &lazy;
    const struct estimate found = estimate_run(&setup);
    assert_true(found.steps == 1);
    near_relative(found.cpu_s, 1e-9 * N * 10 * (4 + 1), 1e-14);
    lazy.evaluations = 3;
    near_relative(estimate_run(&setup).cpu_s, 1e-9 * N * 10 * (4 + 3), 1e-14);
}

/* Runs in 2D or 3D refuse kernels too wide for the box; in 1D and in open boxes a particle may
 * reach further. */
TEST(kernels_too_wide_for_the_box)
{
    for (int dim = 1; dim <= 3; dim++) {
        struct setup setup = plain_setup(dim);
        struct error error;
        const double widest = 2.5 * pow(8, 1. / dim); /* of the second particle */
        for (int a = 0; a < dim; a++)
            for (int wide = 0; wide < 2; wide++)
                for (int open = 0; open < 2; open++) {
                    for (int b = 0; b < 3; b++)
                        setup.lo[b] = 1, setup.hi[b] = 100, setup.boundary[b] = BOUNDARY_PERIODIC;
                    setup.hi[a] = 1 + 2 * widest * (wide ? 1 + 1e-9 : 1 - 1e-9);
                    setup.boundary[a] = open ? BOUNDARY_OPEN : BOUNDARY_PERIODIC;
                    const bool refused = dim > 1 && !wide && !open;
                    assert_int_equal(estimate_check_reach(&setup, &error),
                                     refused ? STATUS_BAD_INPUT : STATUS_OK);
                    if (refused) assert_non_null(strstr(error.message, "particle 1 reaches"));
                }
        setup.rho = NULL; /* unknown density */
        assert_int_equal(estimate_check_reach(&setup, &error), STATUS_OK);
    }
}

/* A run may use all memory that is available. */
TEST(more_than_there_is)
{
    const double there = allowance_memory("");
    struct error error;
    char said[160];
    assert_true(there > 0 && isfinite(there));
    assert_int_equal(estimate_check(&(struct estimate){.memory = there}, 7, &error), STATUS_OK);
    assert_int_equal(estimate_check(&(struct estimate){.memory = 2 * there}, 7, &error),
                     STATUS_ENVIRONMENT);
    snprintf(said, sizeof said,
             "n=7 takes about %.3g GB of memory, more than the %.3g GB that there are",
             2 * there / 1e9, there / 1e9);
    assert_string_equal(error.message, said);
}
