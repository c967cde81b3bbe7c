/* SPDX-License-Identifier: GPL-3.0-or-later
 * What is at the ends of a box in 1D: between walls gas runs as in the periodic box that its mirror
 * image completes, and keeps its energy; nothing acts across open ends; fixed layers stay. Gases
 * and schemes are drawn at random. */
#include "test.h"

#include <gsl/gsl_rng.h>

#include "integrator.h"
#include "simulation.h"

enum { MOST = 400, DRAWS = 60 };

struct gas {
    size_t n;
    double x[MOST], v[MOST], m[MOST], u[MOST], rho[MOST], energy, start;
    uint64_t steps, skipped;
};

static gsl_rng *rng;

static double draw(double lo, double hi)
{
    return lo + (hi - lo) * gsl_rng_uniform(rng);
}

static struct scheme draw_scheme(void)
{
    struct error error;
    struct scheme scheme = {
        .gradient = (enum gradient)gsl_rng_uniform_int(rng, 2),
        .formulation = draw(0, 1) < 0.3 ? FORMULATION_LAGRANGIAN : FORMULATION_VANILLA_ICE,
        .volume_element = (enum volume_element)gsl_rng_uniform_int(rng, 2),
        .viscosity = (enum viscosity)gsl_rng_uniform_int(rng, VISCOSITY_CULLEN_DEHNEN),
        .energy = (enum energy)gsl_rng_uniform_int(rng, ENERGIES),
        .h_method = H_NEWTON,
        .integrator = (const struct integrator *)
                          integrator_family.members[gsl_rng_uniform_int(rng, integrator_family.n)],
        .alpha = 1,
        .beta = 2,
        .alpha_min = 0.1,
        .alpha_max = 1.5,
        .noise = 0.4,
        .eta = 2.4,
        .cfl = 0.1,
        .h_tolerance = 1e-13,
    };
    static const char *const kernels[] = {"wendland_c2", "wendland_c4", "quartic_spline"};
    const char *kernel = kernels[gsl_rng_uniform_int(rng, 3)];
    assert_int_equal(kernel_select(&scheme.kernel, kernel, 5, &error), STATUS_OK);
    if (scheme_check(&scheme, 1, &error)) fail_msg("%s", error.message);
    return scheme;
}

/* Gas in [0.25, 1.75], uneven everywhere, that moves throughout or only in its middle. */
static void draw_gas(struct gas *gas, size_t n, bool still)
{
    gas->n = n;
    for (size_t i = 0; i < n; i++) {
        const double at = ((double)i + 0.5) / (double)n;
        const bool moves = !still || fabs(at - 0.5) < 0.05;
        gas->x[i] = 0.25 + 1.5 * (at + (still ? 0 : draw(-0.2, 0.2) / (double)n));
        gas->v[i] = moves ? draw(-0.4, 0.4) : 0;
        gas->m[i] = 1.5 / (double)n * (still ? 1 : draw(1, 1.3));
        gas->u[i] = 1, gas->rho[i] = 1;
    }
}

static void run(struct gas *gas, const struct scheme *scheme, enum boundary boundary, bool skip,
                double lo, double hi, double t_end)
{
    struct setup setup = {.dim = 1,
                          .lo = {lo},
                          .hi = {hi},
                          .boundary = {boundary},
                          .gamma = 1.4,
                          .t_end = t_end,
                          .n = gas->n,
                          .x = {gas->x},
                          .v = {gas->v},
                          .m = gas->m,
                          .u = gas->u,
                          .rho = gas->rho,
                          .scheme = *scheme,
                          .skip = skip,
                          .threads = 1 + (int)gsl_rng_uniform_int(rng, 3)};
    struct simulation *simulation;
    struct error error = {0};
    struct conservation sums;
    struct snapshot s;
    struct simulation_cost cost;
    if (simulation_create(&setup, &simulation, &error)) fail_msg("%s", error.message);
    simulation_conservation(simulation, &sums);
    gas->start = sums.energy;
    if (simulation_run(simulation, t_end, NULL, NULL, &error)) fail_msg("%s", error.message);
    simulation_conservation(simulation, &sums);
    gas->energy = sums.energy;
    simulation_snapshot(simulation, &s);
    simulation_cost(simulation, &cost);
    gas->steps = cost.steps, gas->skipped = cost.skipped_particle_updates;
    for (size_t i = 0; i < s.n; i++) {
        const size_t id = s.id[i];
        gas->x[id] = s.x[0][i], gas->v[id] = s.v[0][i];
        gas->u[id] = s.u[i], gas->rho[id] = s.rho[i];
    }
    simulation_destroy(simulation);
}

static void same(const struct gas *a, const struct gas *b, double tolerance)
{
    for (size_t i = 0; i < a->n; i++) {
        near_below(fabs(a->x[i] - b->x[i]), tolerance);
        near_below(fabs(a->v[i] - b->v[i]), tolerance);
        near_below(fabs(a->u[i] - b->u[i]), tolerance);
        near_below(fabs(a->rho[i] - b->rho[i]), tolerance);
    }
}

/* Gas without viscosity, whose outermost particles run at the walls and past them. */
static void run_at_the_walls(struct gas *gas, struct scheme *scheme)
{
    scheme->eta = 3.4; /* two particles at one place have a root h */
    scheme->viscosity = VISCOSITY_NONE, scheme->formulation = FORMULATION_VANILLA_ICE;
    scheme->integrator = (const struct integrator *)family_find(&integrator_family, "leapfrog");
    struct error error;
    assert_int_equal(kernel_select(&scheme->kernel, "wendland_c2", 5, &error), STATUS_OK);
    for (size_t i = 0; i < gas->n; i++) gas->u[i] = 0.3;
    gas->v[0] = -4, gas->v[gas->n - 1] = 4;
}

TEST(walls_are_mirrors)
{
    for (int k = 0; k < DRAWS; k++) {
        static struct gas walled, whole;
        struct scheme scheme = draw_scheme();
        const size_t n = k < 10 ? 2 + (size_t)k : 30 + gsl_rng_uniform_int(rng, 150);
        draw_gas(&walled, n, false);
        if (n > 20 && k % 3 == 0) run_at_the_walls(&walled, &scheme);
        whole = walled;
        whole.n = 2 * n;
        for (size_t i = 0; i < n; i++) {
            whole.x[n + i] = 3.5 - whole.x[i], whole.v[n + i] = -whole.v[i];
            whole.m[n + i] = whole.m[i], whole.u[n + i] = whole.u[i], whole.rho[n + i] = 1;
        }
        run(&walled, &scheme, BOUNDARY_REFLECTING, false, 0.25, 1.75, 0.05);
        run(&whole, &scheme, BOUNDARY_PERIODIC, false, 0.25, 3.25, 0.05);
        assert_int_equal(walled.steps, whole.steps);
        for (size_t i = 0; i < n; i++) /* the two may have changed places */
            if (whole.x[i] > 1.75 || whole.x[i] < 0.25)
                whole.x[i] = whole.x[n + i], whole.v[i] = whole.v[n + i];
            else if (whole.x[i] > 3.25 - 1e-9)
                whole.x[i] -= 3;
        same(&walled, &whole, 1e-9);
        if (n > 20 && k % 3 == 0) assert_true(walled.v[0] > 2 && walled.v[n - 1] < -2);
        if (scheme.energy == ENERGY_TOTAL)
            near_below(fabs(walled.energy / walled.start - 1), 1e-12);
    }
}

TEST(sleep_between_ends)
{
    uint64_t skipped = 0;
    for (int k = 0; k < DRAWS / 2; k++) {
        static struct gas one, two;
        const struct scheme scheme = draw_scheme();
        draw_gas(&one, 380, true);
        two = one;
        run(&one, &scheme, BOUNDARY_REFLECTING, false, 0.25, 1.75, 0.1);
        run(&two, &scheme, BOUNDARY_REFLECTING, true, 0.25, 1.75, 0.1);
        same(&one, &two, 1e-8);
        skipped += two.skipped;
    }
    assert_true(skipped > 0);
}

/* Gas in an open box runs as it does in the middle of a periodic one that is much too wide. */
TEST(nothing_beyond_open_ends)
{
    for (int k = 0; k < DRAWS / 2; k++) {
        static struct gas open, wide;
        const struct scheme scheme = draw_scheme();
        draw_gas(&open, 60, false);
        wide = open;
        run(&open, &scheme, BOUNDARY_OPEN, false, 0.25, 1.75, 0.05);
        run(&wide, &scheme, BOUNDARY_PERIODIC, false, -20, 22, 0.05);
        same(&open, &wide, 1e-9);
    }
}

TEST(layers_stay)
{
    for (int k = 0; k < DRAWS / 2; k++) {
        static struct gas gas, before;
        const struct scheme scheme = draw_scheme();
        draw_gas(&gas, 150, true);
        before = gas;
        run(&gas, &scheme, BOUNDARY_FIXED, false, 0.25, 1.75, 0.05);
        for (size_t i = 0; i < 4; i++) {
            /* rk3 takes thirds of positions, which are not exact */
            near_below(fabs(gas.x[i] - before.x[i]), 1e-14);
            near_below(fabs(gas.x[149 - i] - before.x[149 - i]), 1e-14);
            assert_true(gas.v[i] == 0 && gas.v[149 - i] == 0);
        }
        for (size_t i = 0; i < 20; i++) near_below(fabs(gas.v[i]), 1e-6);
    }
}

static int begin(void **state)
{
    (void)state;
    rng = gsl_rng_alloc(gsl_rng_mt19937);
    return !rng;
}

static int end(void **state)
{
    (void)state;
    gsl_rng_free(rng);
    return 0;
}

TEST_BETWEEN(begin, end);
