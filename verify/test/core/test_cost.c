/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares the counts of pairs and updates of a run with counts by hand, on lattices. */
#include "test.h"

#include "keyed.h"

enum { SIDE = 16, MOST = SIDE * SIDE * SIDE };

/* Gas at rest on a square or cubic lattice of the periodic unit box. */
static struct simulation *lattice(int dim, int threads, bool sleep)
{
    static double x[3][MOST], v[MOST], m[MOST], u[MOST];
    const size_t n = dim == 2 ? SIDE * SIDE : MOST;
    struct simulation *simulation = NULL;
    struct error error = {0};
    for (size_t i = 0; i < n; i++) {
        size_t rest = i;
        for (int a = 0; a < dim; a++, rest /= SIDE) x[a][i] = ((double)(rest % SIDE) + 0.5) / SIDE;
        m[i] = 1. / (double)n, u[i] = 1;
    }
    struct setup setup = {.dim = dim,
                          .hi = {1, 1, 1},
                          .gamma = 1.4,
                          .t_end = 1,
                          .n = n,
                          .m = m,
                          .u = u,
                          .skip = sleep,
                          .threads = threads};
    for (int a = 0; a < dim; a++) setup.x[a] = x[a], setup.v[a] = v;
    setup.scheme = keyed_scheme(dim, "kernel=cubic_spline eta=2.4 gradient=standard");
    if (simulation_create(&setup, &simulation, &error)) fail_msg("%s", error.message);
    return simulation;
}

/* Points of the lattice within 2.4 spacings of a point, without the point itself. */
static uint64_t neighbours(int dim)
{
    uint64_t count = 0;
    for (int i = -2; i <= 2; i++)
        for (int j = -2; j <= 2; j++)
            for (int k = dim == 3 ? -2 : 0; k <= (dim == 3 ? 2 : 0); k++)
                count += i * i + j * j + k * k < 2.4 * 2.4;
    return count - 1;
}

/* Each pair is counted once per evaluation, whatever the number of threads; if all particles are
 * inactive, only the pairs of the start are counted. */
TEST(counts_of_pairs_and_updates)
{
    for (int dim = 2; dim <= 3; dim++)
        for (int threads = 1; threads <= 2; threads++)
            for (int sleep = 0; sleep < 2; sleep++) {
                struct simulation *simulation = lattice(dim, threads, sleep);
                const uint64_t n = dim == 2 ? SIDE * SIDE : MOST, pairs = n * neighbours(dim) / 2;
                struct simulation_cost start, end;
                struct error error;
                simulation_cost(simulation, &start);
                assert_int_equal(start.pair_interactions, pairs);
                assert_int_equal(start.steps + start.particle_updates, 0);
                if (simulation_run(simulation, 0.02, NULL, NULL, &error))
                    fail_msg("%s", error.message);
                simulation_cost(simulation, &end);
                assert_true(end.steps > 0);
                assert_int_equal(end.particle_updates, sleep ? 0 : n * end.steps);
                assert_int_equal(end.skipped_particle_updates, sleep ? n * end.steps : 0);
                assert_int_equal(end.pair_interactions, pairs * (sleep ? 1 : 1 + end.steps));
                simulation_destroy(simulation);
            }
}
