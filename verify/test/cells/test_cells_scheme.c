/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the viscosity's beta in 2D and 3D, also for schemes without alpha. */
#include "test.h"

#include "sample_lattice.h"
#include "solver.h"

static void find_forces(struct simulation *simulation)
{
    double rate;
    assert_int_equal(cells_sums.forces(simulation, &rate, NULL), STATUS_OK);
}

/* Where alpha varies, beta is a multiple of it, the scheme's beta/alpha; 2 where the scheme has no
 * alpha. */
TEST(ratio_of_beta)
{
    static const double numbers[][2] = {{1, 2}, {0, 5}, {2, 4}, {0.5, 1.5}};
    static double F[N], de[N];
    for (int dim = 2; dim <= 3; dim++)
        for (int k = 0; k < 4; k++) {
            struct scheme scheme = plain_scheme();
            scheme.viscosity = VISCOSITY_TIME_DEPENDENT;
            scheme.alpha = numbers[k][0], scheme.beta = numbers[k][1];
            struct setup setup = lattice_of(dim, dim == 2 ? 9 : 6, 0.2, &scheme);
            for (size_t i = 0; i < setup.n; i++) v[0][i] = sin(2 * M_PI * x[0][i]);
            struct simulation *simulation = simulation_of(&setup);
            const struct particles *p = &simulation->particles;
            for (size_t i = 0; i < setup.n; i++) p->alpha[i] = 0.7;
            find_forces(simulation);
            const size_t bytes = setup.n * sizeof *F;
            if (k == 0) memcpy(F, p->F[0], bytes), memcpy(de, p->de, bytes);
            assert_int_equal(!memcmp(F, p->F[0], bytes) && !memcmp(de, p->de, bytes), k < 3);
            simulation_destroy(simulation);
        }
}
