/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs in 2D and 3D against each other: what must be the same with and without sleep, for any
 * number of threads, in a walled box and in the periodic one that its mirror image completes, with
 * and without a constant acceleration. Setups are drawn at random. */
#include "test.h"

#include <gsl/gsl_rng.h>

#include "integrator.h"
#include "simulation.h"

enum { POINTS_MAX = 4096, DRAWS = 6 };

struct particles_of {
    size_t n;
    double longer; /* side of the box along x */
    double x[3][POINTS_MAX], v[3][POINTS_MAX], m[POINTS_MAX], u[POINTS_MAX], rho[POINTS_MAX];
};

/* The end of a run, by number in the setup. */
struct end {
    double x[3][POINTS_MAX], v[3][POINTS_MAX], rho[POINTS_MAX], u[POINTS_MAX];
    uint64_t skipped, steps;
    double energy, momentum;
};

static struct scheme draw_scheme(gsl_rng *rng, int dim)
{
    static const char *const kernels[] = {"cubic_spline", "wendland_c2", "wendland_c4"};
    static const double widths[] = {2.2, 2.4, 2.8};
    static const enum viscosity viscosities[] = {VISCOSITY_PROJECTED, VISCOSITY_CULLEN_DEHNEN,
                                                 VISCOSITY_CONSTANT};
    const size_t k = gsl_rng_uniform_int(rng, 3);
    struct scheme scheme = {
        .gradient = (enum gradient)gsl_rng_uniform_int(rng, GRADIENTS),
        .formulation =
            gsl_rng_uniform(rng) < 0.3 ? FORMULATION_LAGRANGIAN : FORMULATION_VANILLA_ICE,
        .volume_element = (enum volume_element)gsl_rng_uniform_int(rng, VOLUME_ELEMENTS),
        .viscosity = viscosities[gsl_rng_uniform_int(rng, 3)],
        .balsara = (enum balsara)gsl_rng_uniform_int(rng, BALSARAS),
        .energy = (enum energy)gsl_rng_uniform_int(rng, ENERGIES),
        .h_method = H_NEWTON,
        .integrator = (const struct integrator *)
                          integrator_family.members[gsl_rng_uniform_int(rng, integrator_family.n)],
        .alpha = 1,
        .beta = 2,
        .alpha_min = 0.1,
        .alpha_max = 1.5,
        .noise = 0.4,
        .eta = widths[k],
        .cfl = 0.1,
        .h_tolerance = 1e-13,
    };
    if (scheme.formulation == FORMULATION_VANILLA_ICE && gsl_rng_uniform(rng) < 0.5) {
        scheme.integrator =
            (const struct integrator *)family_find(&integrator_family, "predicted_midpoint");
        scheme.h_method = H_PREDICTED;
    }
    struct error error;
    assert_int_equal(kernel_select(&scheme.kernel, kernels[k], 5, &error), STATUS_OK);
    assert_int_equal(scheme_check(&scheme, dim, &error), STATUS_OK);
    return scheme;
}

/* A lattice at rest: `side` points each way in a box of sides 1, but `longer` times that along x.
 */
static void lattice(struct particles_of *p, int dim, size_t side, size_t longer)
{
    const size_t sides[3] = {side * longer, side, side};
    p->n = longer * (dim == 2 ? side * side : side * side * side);
    p->longer = (double)longer;
    assert_true(p->n <= POINTS_MAX);
    for (size_t i = 0; i < p->n; i++) {
        size_t at = i;
        for (int a = 0; a < 3; at /= sides[a], a++) {
            p->x[a][i] = ((double)(at % sides[a]) + 0.5) / (double)side;
            p->v[a][i] = 0;
        }
        p->m[i] = p->longer / (double)p->n;
        p->u[i] = 1;
        p->rho[i] = 1;
    }
}

static struct setup setup_of(const struct particles_of *p, int dim, const struct scheme *scheme)
{
    struct setup setup = {.dim = dim,
                          .gamma = 1.4,
                          .t_end = 1,
                          .n = p->n,
                          .m = p->m,
                          .u = p->u,
                          .rho = p->rho,
                          .scheme = *scheme,
                          .threads = 1};
    for (int a = 0; a < dim; a++) {
        setup.hi[a] = a == 0 ? p->longer : 1;
        setup.x[a] = p->x[a];
        setup.v[a] = p->v[a];
    }
    return setup;
}

static void run(const struct setup *setup, double t_end, struct end *end)
{
    struct simulation *simulation;
    struct error error = {0};
    struct snapshot s;
    struct conservation sums;
    struct simulation_cost cost;
    memset(end, 0, sizeof *end);
    if (simulation_create(setup, &simulation, &error)) fail_msg("%s", error.message);
    if (simulation_run(simulation, t_end, NULL, NULL, &error)) fail_msg("%s", error.message);
    simulation_snapshot(simulation, &s);
    simulation_conservation(simulation, &sums);
    simulation_cost(simulation, &cost);
    for (size_t i = 0; i < s.n; i++) {
        const size_t id = s.id[i];
        for (int a = 0; a < setup->dim; a++) {
            end->x[a][id] = s.x[a][i];
            end->v[a][id] = s.v[a][i];
        }
        end->rho[id] = s.rho[i];
        end->u[id] = s.u[i];
    }
    end->skipped = cost.skipped_particle_updates;
    end->steps = cost.steps;
    end->energy = sums.energy;
    end->momentum = 0;
    for (int a = 0; a < setup->dim; a++) end->momentum += fabs(sums.momentum[a]);
    simulation_destroy(simulation);
}

/* Warm gas somewhere in the lattice: most of it has heard nothing at the end. */
static void heat(struct particles_of *p, gsl_rng *rng)
{
    const double at = p->longer * gsl_rng_uniform(rng), height = gsl_rng_uniform(rng);
    for (size_t i = 0; i < p->n; i++) {
        const double dx = (p->x[0][i] - at) / p->longer, dy = p->x[1][i] - height;
        if (hypot((dx - round(dx)) * p->longer, dy - round(dy)) < 0.3) p->u[i] = 2;
    }
}

static struct particles_of p;
static struct end plain, other;

TEST(sleep_changes_nothing)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    uint64_t skipped = 0;
    gsl_rng_set(rng, 2385);
    for (int k = 0; k < DRAWS; k++) {
        const int dim = 2 + k % 2;
        const struct scheme scheme = draw_scheme(rng, dim);
        lattice(&p, dim, dim == 2 ? 12 : 6, dim == 2 ? 16 : 10);
        heat(&p, rng);
        struct setup setup = setup_of(&p, dim, &scheme);
        const double t_end = 0.2;
        run(&setup, t_end, &plain);
        assert_int_equal(plain.skipped, 0);
        setup.skip = true;
        run(&setup, t_end, &other);
        assert_int_equal(plain.steps, other.steps);
        skipped += other.skipped;
        for (size_t i = 0; i < p.n; i++) {
            for (int a = 0; a < dim; a++) {
                near_below(fabs(plain.x[a][i] - other.x[a][i]), 1e-8);
                near_below(fabs(plain.v[a][i] - other.v[a][i]), 1e-8);
            }
            near_below(fabs(plain.rho[i] - other.rho[i]), 1e-8);
        }
        if (scheme.energy == ENERGY_TOTAL) near_relative(other.energy, plain.energy, 1e-12);
    }
    assert_true(skipped > 10000);
    gsl_rng_free(rng);
}

TEST(threads_change_no_bit)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(rng, 317);
    for (int k = 0; k < DRAWS / 2; k++) {
        const int dim = 2 + k % 2;
        const struct scheme scheme = draw_scheme(rng, dim);
        lattice(&p, dim, dim == 2 ? 33 : 11, 1);
        double momentum = 0;
        for (size_t i = 0; i < p.n; i++)
            for (int a = 0; a < dim; a++) {
                p.x[a][i] += 0.2 / (dim == 2 ? 33 : 11) * (gsl_rng_uniform(rng) - 0.5);
                p.v[a][i] = i % 2 ? -p.v[a][i - 1] : 0.3 * (gsl_rng_uniform(rng) - 0.5);
                if (i + 1 == p.n && p.n % 2) p.v[a][i] = 0;
                momentum += fabs(p.m[i] * p.v[a][i]);
            }
        struct setup setup = setup_of(&p, dim, &scheme);
        run(&setup, 0.02, &plain);
        setup.threads = 2 + k % 2;
        run(&setup, 0.02, &other);
        assert_memory_equal(plain.x, other.x, sizeof plain.x);
        assert_memory_equal(plain.v, other.v, sizeof plain.v);
        assert_memory_equal(plain.u, other.u, sizeof plain.u);
        near_below(plain.momentum, 1e-13 * momentum);
    }
    gsl_rng_free(rng);
}

/* Particles in the lower half of the box in the directions of `walls`, and all of their images. */
static size_t complete(struct particles_of *all, const struct particles_of *half, int dim,
                       const bool walls[3])
{
    *all = *half;
    for (int a = 0; a < dim; a++) {
        if (!walls[a]) continue;
        const size_t n = all->n;
        for (size_t i = 0; i < n; i++) {
            for (int b = 0; b < dim; b++) {
                all->x[b][n + i] = all->x[b][i];
                all->v[b][n + i] = all->v[b][i];
            }
            all->x[a][n + i] = 2 - all->x[a][i];
            all->v[a][n + i] = -all->v[a][i];
            all->m[n + i] = all->m[i];
            all->u[n + i] = all->u[i];
            all->rho[n + i] = all->rho[i];
        }
        all->n *= 2;
    }
    all->longer = walls[0] ? 2 : 1;
    return all->n;
}

TEST(walls_are_mirrors)
{
    static struct particles_of all;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(rng, 71);
    for (int k = 0; k < DRAWS; k++) {
        const int dim = 2 + k % 2;
        const size_t side = dim == 2 ? 14 : 7;
        const bool walls[3] = {true, k % 4 > 1, false};
        const struct scheme scheme = draw_scheme(rng, dim);
        lattice(&p, dim, side, 1);
        for (size_t i = 0; i < p.n; i++) {
            p.m[i] *= 1 + 0.3 * gsl_rng_uniform(rng);
            for (int a = 0; a < dim; a++) {
                p.x[a][i] += 0.3 / (double)side * (gsl_rng_uniform(rng) - 0.5);
                p.v[a][i] = 0.4 * (gsl_rng_uniform(rng) - 0.5);
            }
        }
        struct setup setup = setup_of(&p, dim, &scheme);
        for (int a = 0; a < dim; a++)
            if (walls[a]) setup.boundary[a] = BOUNDARY_REFLECTING;
        run(&setup, 0.05, &plain);
        complete(&all, &p, dim, walls);
        struct setup whole = setup_of(&all, dim, &scheme);
        for (int a = 0; a < dim; a++)
            if (walls[a]) whole.hi[a] = 2;
        run(&whole, 0.05, &other);
        assert_int_equal(plain.steps, other.steps);
        for (size_t i = 0; i < p.n; i++)
            for (int a = 0; a < dim; a++) {
                near_below(fabs(plain.x[a][i] - other.x[a][i]), 1e-11);
                near_below(fabs(plain.v[a][i] - other.v[a][i]), 1e-11);
            }
    }
    gsl_rng_free(rng);
}

/* In a periodic box everything falls alike: g t^2/2 and g t apart from the run without. */
TEST(gravity_is_a_fall)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(rng, 5);
    for (int k = 0; k < DRAWS; k++) {
        const int dim = 2 + k % 2;
        struct scheme scheme = draw_scheme(rng, dim);
        scheme.energy = ENERGY_INTERNAL;
        scheme.integrator = (const struct integrator *)family_find(&integrator_family, "leapfrog");
        lattice(&p, dim, dim == 2 ? 16 : 7, 1);
        for (size_t i = 0; i < p.n; i++)
            for (int a = 0; a < dim; a++) p.v[a][i] = 0.1 * (gsl_rng_uniform(rng) - 0.5);
        struct setup setup = setup_of(&p, dim, &scheme);
        run(&setup, 0.05, &plain);
        setup.gravity[1] = -0.7;
        run(&setup, 0.05, &other);
        assert_int_equal(plain.steps, other.steps);
        for (size_t i = 0; i < p.n; i++) {
            near_below(fabs(other.v[1][i] - plain.v[1][i] + 0.7 * 0.05), 1e-11);
            near_below(fabs(other.v[0][i] - plain.v[0][i]), 1e-11);
            const double fallen = other.x[1][i] - plain.x[1][i] + 0.5 * 0.7 * 0.05 * 0.05;
            near_below(fabs(fallen - round(fallen)), 1e-11);
        }
    }
    gsl_rng_free(rng);
}

/* Where nothing but gravity acts, what is lost in height is won in speed, and no heat is made. */
TEST(gravity_keeps_energy)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(rng, 13);
    for (size_t k = 0; k < integrator_family.n; k++) {
        const int dim = 2 + (int)k % 2;
        struct scheme scheme = draw_scheme(rng, dim);
        const double g = -0.7;
        double before = 0;
        scheme.energy = ENERGY_TOTAL;
        scheme.integrator = (const struct integrator *)integrator_family.members[k];
        lattice(&p, dim, dim == 2 ? 16 : 7, 1);
        for (size_t i = 0; i < p.n; i++) {
            p.v[1][i] = 0.3;
            before += p.m[i] * (p.u[i] + 0.5 * 0.3 * 0.3 - g * p.x[1][i]);
        }
        struct setup setup = setup_of(&p, dim, &scheme);
        setup.gravity[1] = g;
        run(&setup, 0.5, &plain);
        /* symplectic Euler falls a whole last step ahead, to first order */
        const double order = scheme.integrator->order == 1 ? 1e-2 : 1e-11;
        near_relative(plain.energy, before, order);
        for (size_t i = 0; i < p.n; i++) near_relative(plain.u[i], 1, order);
    }
    gsl_rng_free(rng);
}

/* Gas at rest between layers of kept state stays at rest, and the layers do not move when it does
 * not. */
TEST(layers_hold)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    size_t held = 0, moved = 0;
    gsl_rng_set(rng, 9);
    const struct scheme scheme = draw_scheme(rng, 2);
    lattice(&p, 2, 30, 1);
    struct setup setup = setup_of(&p, 2, &scheme);
    setup.boundary[1] = BOUNDARY_FIXED;
    run(&setup, 0.1, &plain);
    for (size_t i = 0; i < p.n; i++) {
        near_below(fabs(plain.v[1][i]), 1e-10);
        near_relative(plain.rho[i], 1, 0.02); /* the outermost do not see the emptiness outside */
    }
    for (size_t i = 0; i < p.n; i++) p.v[1][i] = 0.1 * sin(2 * M_PI * p.x[1][i]);
    run(&setup, 0.1, &plain);
    for (size_t i = 0; i < p.n; i++) {
        const bool kept = plain.x[1][i] == p.x[1][i] && plain.v[1][i] == 0;
        const double from_end = fmin(p.x[1][i], 1 - p.x[1][i]);
        if (from_end < 3 * scheme.eta / 30 * (1 - 1e-9)) assert_true(kept);
        if (from_end > 3 * scheme.eta / 30 * (1 + 1e-9)) assert_false(kept);
        held += kept;
        moved += !kept;
    }
    assert_true(held > 200 && moved > 200);
    gsl_rng_free(rng);
}

/* Where h changes by less than 0.05 over its own length, blended forces are those of ia to the last
 * bit, and only there. */
TEST(blended_is_ia_at_even_widths)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(rng, 77);
    for (int k = 0; k < 2 * DRAWS; k++) {
        const int dim = 2 + k / 2 % 2;
        const bool even = k % 2 == 0;
        const size_t side = dim == 2 ? 16 : 8;
        const double spread = (even ? 0.02 : 0.6) / (double)side;
        struct scheme scheme = draw_scheme(rng, dim);
        lattice(&p, dim, side, 1);
        for (size_t i = 0; i < p.n; i++)
            for (int a = 0; a < dim; a++) p.x[a][i] += spread * (gsl_rng_uniform(rng) - 0.5);
        scheme.gradient = GRADIENT_IA;
        struct setup setup = setup_of(&p, dim, &scheme);
        run(&setup, 1e-3, &plain);
        setup.scheme.gradient = GRADIENT_BLENDED;
        run(&setup, 1e-3, &other);
        assert_true(plain.v[0][0] != 0);
        if (even)
            assert_memory_equal(plain.v, other.v, sizeof plain.v);
        else
            assert_memory_not_equal(plain.v, other.v, sizeof plain.v);
    }
    gsl_rng_free(rng);
}
