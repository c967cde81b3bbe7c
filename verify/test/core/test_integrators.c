/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the descriptors of integrators: exactly those that declare it write to the arrays of a
 * step's start, and each scheme writes to exactly the arrays that the estimate of memory counts,
 * never beyond the particles. A particle that loses its internal energy is named. */
#include "test.h"

#include "hydro_setup.h"
#include "keyed.h"
#include "memory.h"
#include "solver.h"

static bool is_used(const double *array, ptrdiff_t n)
{
    for (ptrdiff_t i = 0; i < n; i++)
        if (array[i] != 0) return true;
    return false;
}

TEST(start_of_a_step)
{
    size_t keep = 0;
    for (size_t k = 0; k < integrator_family.n; k++) {
        static struct hydro_state start;
        struct scheme scheme = hydro_scheme();
        struct simulation *simulation = NULL;
        struct error error;
        hydro_disordered(&start, 100);
        scheme.integrator = hydro_integrator(integrator_family.members[k]->name);
        const struct setup setup = hydro_setup(&start, &scheme);
        assert_int_equal(simulation_create(&setup, &simulation, &error), STATUS_OK);
        assert_int_equal(simulation_run(simulation, 1e-3, NULL, NULL, &error), STATUS_OK);
        const struct particles *a = &simulation->particles;
        assert_int_equal(is_used(a->p_old[0], a->n), scheme.integrator->keeps_start);
        assert_int_equal(is_used(a->e_old, a->n), scheme.integrator->keeps_start);
        keep += scheme.integrator->keeps_start;
        simulation_destroy(simulation);
    }
    assert_in_range(keep, 1, integrator_family.n - 1);
}

enum { SIDE = 12, N = SIDE * SIDE, ARRAYS_MOST = 64 };

/* Disordered gas in a periodic box in 1D or 2D, with these keys. */
static struct setup disordered(int dim, const char *keys)
{
    static double x[3][N], v[3][N], m[N], u[N];
    struct setup setup = {.dim = dim,
                          .hi = {1, 1, 1},
                          .gamma = 1.4,
                          .t_end = 1,
                          .n = N,
                          .m = m,
                          .u = u,
                          .threads = 1};
    const int side = dim == 1 ? N : SIDE;
    for (int i = 0; i < N; i++) {
        for (int k = 0, rest = i; k < dim; k++, rest /= side) {
            x[k][i] = (rest % side + 0.5 + 0.2 * sin(i * (i + k))) / side;
            v[k][i] = 0.3 * sin(5 * i + k);
        }
        m[i] = 1. / N, u[i] = 1 + 0.2 * sin(3 * i);
    }
    for (int k = 0; k < dim; k++) setup.x[k] = x[k], setup.v[k] = v[k];
    setup.scheme = keyed_scheme(dim, keys);
    return setup;
}

/* Gas at rest on a lattice in 1D, except for a few particles: most of it is inactive. */
static void lie_still(struct setup *setup)
{
    static double x[N], v[N], u[N];
    for (int i = 0; i < N; i++) x[i] = (i + 0.5) / N, v[i] = i % N < 9 ? 1e-3 * i : 0, u[i] = 1;
    setup->x[0] = x, setup->v[0] = v, setup->u = u, setup->skip = true;
}

static struct simulation *created(const struct setup *setup)
{
    struct simulation *simulation = NULL;
    struct error error;
    if (simulation_create(setup, &simulation, &error)) fail_msg("%s", error.message);
    return simulation;
}

/* The arrays of these uses. */
static size_t list(const struct particles *a, unsigned uses, double *arrays[ARRAYS_MOST])
{
    size_t count = 0;
#define SCALAR(name, use, meaning)                                                                 \
    if (uses & (use)) arrays[count++] = a->name;
#define VECTOR(name, use, meaning)                                                                 \
    for (int k = 0; k < a->dim && uses & (use); k++) arrays[count++] = a->name[k];
    PARTICLE_FIELDS(SCALAR, VECTOR)
#undef SCALAR
#undef VECTOR
    return count;
}

/* A particle that loses all internal energy in a step is named with its remaining energy. */
TEST(particle_that_loses_its_energy)
{
    static const char *const energies[] = {
        "integrator=predicted_midpoint viscosity=none energy=internal",
        "integrator=predicted_midpoint viscosity=none energy=total"};
    for (int total = 0; total < 2; total++)
        for (int dim = 1; dim <= 2; dim++) {
            const struct setup setup = disordered(dim, energies[total]);
            struct simulation *simulation = created(&setup);
            const struct particles *a = &simulation->particles;
            struct error error;
            char said[80];
            a->e[100] = a->e[77] = -0.5;
            a->p[0][77] = 0.03; /* a share of its energy that can be distinguished */
            assert_int_equal(simulation_run(simulation, 1, NULL, NULL, &error), STATUS_BROKE_DOWN);
            double U = a->e[77];
            for (int d = 0; d < dim && total; d++) U -= 0.5 * a->p[d][77] * a->p[d][77] / a->m[77];
            snprintf(said, sizeof said, "internal energy of particle %zu at x = ", a->id[77]);
            assert_non_null(strstr(error.message, said));
            snprintf(said, sizeof said, " is %.9g", U);
            assert_string_equal(error.message + strlen(error.message) - strlen(said), said);
            simulation_destroy(simulation);
        }
}

/* The estimate counts the arrays that are written, those of the snapshot and three more; no
 * others. */
TEST(estimate_counts_arrays)
{
    static const char *const schemes[] = {
        "viscosity=constant gradient=standard formulation=vanilla_ice",
        "viscosity=time_dependent gradient=standard formulation=vanilla_ice",
        "viscosity=reconstructed gradient=standard formulation=vanilla_ice",
        "viscosity=constant gradient=ia formulation=vanilla_ice",
        "viscosity=constant gradient=standard formulation=lagrangian",
        "viscosity=time_dependent gradient=ia formulation=lagrangian",
        "viscosity=cullen_dehnen gradient=standard formulation=vanilla_ice",
        "viscosity=cullen_dehnen gradient=ia formulation=lagrangian",
    };
    for (int way = 0; way < 3; way++)
        for (size_t k = 0; k < sizeof schemes / sizeof *schemes; k++)
            for (size_t integrator = 0; integrator < integrator_family.n; integrator++) {
                const int dim = way < 2 ? 1 : 2;
                const bool still = way == 1;
                char keys[128];
                if (dim == 1 && strstr(schemes[k], "cullen_dehnen")) continue;
                snprintf(keys, sizeof keys, "%s integrator=%s", schemes[k],
                         integrator_family.members[integrator]->name);
                struct setup setup = disordered(dim, keys);
                if (still) lie_still(&setup);
                struct simulation *simulation = created(&setup),
                                  bare = {.scheme = setup.scheme, .plan = plan_of_setup(&setup)};
                double *arrays[ARRAYS_MOST];
                struct error error;
                assert_int_equal(simulation_run(simulation, 5e-3, NULL, NULL, &error), STATUS_OK);
                const struct particles *a = &simulation->particles;
                const size_t count = list(a, a->uses, arrays);
                size_t used = 3 + (size_t)dim;
                for (size_t i = 0; i < count; i++) used += is_used(arrays[i], N);
                for (size_t i = list(a, USE_ALL & ~a->uses, arrays); i-- > 0;)
                    assert_false(is_used(arrays[i], N));
                const double bytes = bare.plan.sums->bytes(&bare, N);
                if (memory_bytes(&setup) - bytes != 8. * N * (double)used)
                    fail_msg("%dD %s%s: %g arrays, not %zu", dim, keys, still ? ", sleeping" : "",
                             (memory_bytes(&setup) - bytes) / (8 * N), used);
                simulation_destroy(simulation);
            }
}
