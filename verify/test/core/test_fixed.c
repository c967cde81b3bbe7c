/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests fixed layers of particles at the ends of a box, in a simulation that makes no steps and
 * whose particles are in another order than the setup's. */
#include "test.h"

#include "fixed.h"
#include "keyed.h"
#include "solver.h"

enum { N = 16 };

/* Particle i, whose number in the setup is N - 1 - i, is at i/N of the box along each direction; h
 * = 1/8 of its length 2, and every other value is distinct. */
static void made(struct simulation *s, int dim, enum volume_element element, enum energy energy)
{
    struct error error;
    memset(s, 0, sizeof *s);
    s->gamma = 1.4;
    s->plan.grad_h = true;
    s->scheme.eta = 2;
    s->scheme.volume_element = element;
    s->scheme.energy = energy;
    if (particles_create(&s->particles, dim, N, 0, &error)) fail_msg("%s", error.message);
    struct particles *a = &s->particles;
    for (int k = 0; k < dim; k++) s->lo[k] = -1, a->period[k] = 2;
    for (int i = 0; i < N; i++) {
        a->id[i] = (size_t)(N - 1 - i);
        a->h[i] = 0.25;
        a->m[i] = 1 + 0.1 * i;
        a->m_inverse[i] = 1 / a->m[i];
        a->e[i] = 100 + i;
        a->U[i] = 3 + 0.2 * i;
        a->dalpha[i] = a->de[i] = 5;
        a->rho[i] = a->V[i] = a->P[i] = a->c[i] = a->b[i] = 7;
        a->h_inverse[i] = a->h_inverse_found[i] = a->h_inverse_old[i] = 7;
        for (int k = 0; k < dim; k++)
            a->x[k][i] = -1 + 2. * i / N, a->p[k][i] = 0.5 + 0.1 * i + k, a->F[k][i] = 5;
    }
}

static void unmade(struct simulation *s)
{
    fixed_free(s);
    particles_destroy(&s->particles);
}

/* Distance from the nearest end in smoothing lengths. */
static double depth_of(int i)
{
    return fmin(2. * i / N, 2 - 2. * i / N) / 0.25;
}

TEST(nothing_where_no_end_is_fixed)
{
    static const enum boundary others[] = {BOUNDARY_PERIODIC, BOUNDARY_OPEN, BOUNDARY_REFLECTING};
    for (int k = 0; k < 3; k++) {
        struct simulation s;
        struct error error;
        made(&s, 2, VOLUME_MASS, ENERGY_TOTAL);
        s.boundary[0] = s.boundary[1] = others[k];
        assert_int_equal(fixed_begin(&s, &error), STATUS_OK);
        assert_null(s.held);
        fixed_state(&s);
        fixed_rates(&s);
        for (int i = 0; i < N; i++)
            assert_true(s.particles.rho[i] == 7 && s.particles.F[0][i] == 5 &&
                        s.particles.p[1][i] == 1.5 + 0.1 * i && s.particles.e[i] == 100 + i);
        unmade(&s);
    }
}

/* For every dimension, element and energy, with fixed ends along one direction. */
TEST(layers_keep_their_state)
{
    int outermost = 0, inner = 0, moving = 0;
    for (int dim = 1; dim <= 3; dim++)
        for (int fixed = 0; fixed < dim; fixed++)
            for (int element = 0; element < VOLUME_ELEMENTS; element++)
                for (int energy = 0; energy < ENERGIES; energy++) {
                    struct simulation s;
                    struct error error;
                    made(&s, dim, (enum volume_element)element, (enum energy)energy);
                    s.boundary[fixed] = BOUNDARY_FIXED;
                    assert_int_equal(fixed_begin(&s, &error), STATUS_OK);
                    assert_non_null(s.held);
                    fixed_state(&s);
                    fixed_rates(&s);
                    const struct particles *a = &s.particles;
                    for (int i = 0; i < N; i++) {
                        const bool kept = depth_of(i) < 3, whole = depth_of(i) >= 1;
                        double kinetic = 0;
                        for (int k = 0; k < dim; k++) {
                            const double p = 0.5 + 0.1 * i + k;
                            kinetic += p * p / (2 * a->m[i]);
                            assert_true(a->p[k][i] == (kept ? 0 : p));
                            assert_true(a->F[k][i] == (kept ? 0 : 5));
                        }
                        near_relative(a->e[i],
                                      100 + i - (kept && energy == ENERGY_TOTAL ? kinetic : 0),
                                      1e-14);
                        assert_true(a->de[i] == (kept ? 0 : 5) && a->dalpha[i] == (kept ? 0 : 5));
                        moving += !kept;
                        inner += kept && whole;
                        if (!kept || whole) {
                            assert_true(a->rho[i] == 7 && a->V[i] == 7 && a->P[i] == 7);
                            assert_true(a->c[i] == 7 && a->b[i] == 7 && a->h[i] == 0.25);
                            assert_true(a->h_inverse[i] == 7 && a->h_inverse_found[i] == 7);
                            assert_true(a->h_inverse_old[i] == 7);
                            continue;
                        }
                        outermost++;
                        /* h = eta (m/rho)^(1/d) = 1/4 */
                        const double u = a->U[i] / a->m[i];
                        const double rho = a->m[i] * pow(8, dim), V = pow(8, -dim);
                        const double Z = element == VOLUME_NUMBER   ? 1
                                         : element == VOLUME_ENERGY ? a->U[i]
                                                                    : a->m[i];
                        near_relative(a->rho[i], rho, 1e-14);
                        near_relative(a->V[i], V, 1e-14);
                        near_relative(a->P[i], 0.4 * rho * u, 1e-14);
                        near_relative(a->c[i], sqrt(1.4 * 0.4 * u), 1e-14);
                        near_relative(a->h[i], 0.25, 1e-14);
                        near_relative(a->h_inverse[i], 4., 1e-14);
                        assert_true(a->h_inverse_found[i] == a->h_inverse[i]);
                        assert_true(a->h_inverse_old[i] == a->h_inverse[i]);
                        near_relative(a->b[i], a->P[i] * V * V / Z, 1e-14);
                    }
                    unmade(&s);
                }
    assert_true(outermost > 100 && inner > 100 && moving > 100);
}

/* A run that has gained or lost half of its energy has broken down, except beside fixed layers,
 * which exchange energy with the gas. */
TEST(energy_of_layers)
{
    enum { SIDE = 32, ALL = SIDE * SIDE };
    static double x[2][ALL], v[2][ALL], m[ALL], u[ALL], rho[ALL];
    for (int i = 0; i < ALL; i++) {
        x[0][i] = (i % SIDE + 0.5) / SIDE, x[1][i] = ((double)(i / SIDE) + 0.5) / SIDE;
        v[0][i] = 0.1, v[1][i] = 0, m[i] = 1. / ALL, u[i] = 1, rho[i] = 1;
    }
    for (int fixed = 0; fixed < 2; fixed++) {
        struct setup setup = {
            .dim = 2,
            .hi = {1, 1, 1},
            .boundary = {BOUNDARY_PERIODIC, fixed ? BOUNDARY_FIXED : BOUNDARY_OPEN},
            .gamma = 1.4,
            .t_end = 1e-3,
            .n = ALL,
            .x = {x[0], x[1]},
            .v = {v[0], v[1]},
            .m = m,
            .u = u,
            .rho = rho,
            .threads = 1};
        struct simulation *simulation = NULL;
        struct error error = {0};
        setup.scheme = keyed_scheme(2, "kernel=cubic_spline eta=2");
        if (simulation_create(&setup, &simulation, &error)) fail_msg("%s", error.message);
        assert_true(!simulation->held == !fixed);
        simulation->start_energy *= 3;
        assert_int_equal(simulation_run(simulation, 1e-3, NULL, NULL, &error),
                         fixed ? STATUS_OK : STATUS_BROKE_DOWN);
        simulation_destroy(simulation);
    }
}
