/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a scheme's numbers do in 2D and 3D: beta where there is no alpha, Balsara's factor, signal
 * speeds, what is counted, and how far from a disturbance everybody is awake. */
#include "test.h"

#include <math.h>
#include <string.h>

#include "made_lattice.h"
#include "near.h"
#include "solver.h"

#include "cells/cells.h"

static void find_forces(struct simulation *simulation)
{
    double rate;
    assert_int_equal(cells_sums.forces(simulation, &rate, NULL), STATUS_OK);
}

/* Of an alpha that varies beta is a multiple, beta/alpha of the scheme; 2 where it has no alpha. */
TEST(test_beta)
{
    static const double numbers[][2] = {{1, 2}, {0, 5}, {2, 4}, {0.5, 1.5}};
    static double F[N], de[N];
    for (int dim = 2; dim <= 3; dim++)
        for (int k = 0; k < 4; k++) {
            struct scheme scheme = made_scheme();
            scheme.viscosity = VISCOSITY_TIME_DEPENDENT;
            scheme.alpha = numbers[k][0], scheme.beta = numbers[k][1];
            struct setup setup = lattice_of(dim, dim == 2 ? 9 : 6, 0.2, &scheme);
            for (size_t i = 0; i < setup.n; i++) v[0][i] = sin(2 * M_PI * x[0][i]);
            struct simulation *simulation = made_of(&setup);
            const struct particles *p = &simulation->particles;
            for (size_t i = 0; i < setup.n; i++) p->alpha[i] = 0.7;
            find_forces(simulation);
            const size_t bytes = setup.n * sizeof *F;
            if (k == 0) memcpy(F, p->F[0], bytes), memcpy(de, p->de, bytes);
            assert_int_equal(!memcmp(F, p->F[0], bytes) && !memcmp(de, p->de, bytes), k < 3);
            simulation_destroy(simulation);
        }
}

/* Gas that is drawn together and turned evenly, in its middle, where all have the same factor: so
 * much of the heat of friction is left. */
TEST(test_balsara)
{
    for (int dim = 2; dim <= 3; dim++)
        for (int k = 0; k < 3; k++) {
            static const double floors[] = {0, 1e-4, 0.3};
            static const double L[3][3] = {
                {-1e-3, 2e-3, 5e-4}, {-1.5e-3, -7e-4, 4e-4}, {1e-3, -3e-4, -4e-4}};
            double heat[3], expected = 0;
            for (int friction = 0; friction < 3; friction++) {
                struct scheme scheme = made_scheme();
                scheme.viscosity = friction ? VISCOSITY_CONSTANT : VISCOSITY_NONE;
                scheme.balsara = friction == 2 ? BALSARA_ON : BALSARA_OFF;
                scheme.balsara_floor = floors[k];
                const size_t side = dim == 2 ? 15 : 9;
                struct setup setup = lattice_of(dim, side, 0, &scheme);
                for (int a = 0; a < dim; a++) setup.boundary[a] = BOUNDARY_OPEN;
                for (size_t i = 0; i < setup.n; i++)
                    for (int a = 0; a < dim; a++)
                        for (int b = 0; b < dim; b++) v[a][i] += L[a][b] * x[b][i];
                struct simulation *simulation = made_of(&setup);
                const struct particles *p = &simulation->particles;
                size_t middle = 0;
                while (p->id[middle] != setup.n / 2) middle++;
                heat[friction] = p->de[middle];
                const double rate = p->c[middle] / p->h[middle];
                double div = 0, curl2 = 0;
                for (int a = 0; a < dim; a++) {
                    div += L[a][a];
                    for (int b = 0; b < a; b++) curl2 += pow(L[a][b] - L[b][a], 2);
                }
                expected = (fabs(div) + floors[k] * rate) /
                           (fabs(div) + sqrt(curl2) + (floors[k] + 1e-4) * rate);
                simulation_destroy(simulation);
            }
            near_relative((heat[2] - heat[0]) / (heat[1] - heat[0]), expected, 1e-8);
        }
}

/* dW/dr. */
static double kernel_slope_of(const struct kernel *kernel, double r, double h, int dim)
{
    return r < h ? kernel->constant[dim] / pow(h, dim + 1) * kernel->dw(kernel, r / h, dim) : 0;
}

/* From particle i to j, the nearest image. Returns the distance. */
static double separation(const struct particles *p, size_t i, size_t j, double d[3])
{
    double r2 = 0;
    for (int a = 0; a < p->dim; a++) {
        d[a] = p->x[a][j] - p->x[a][i];
        d[a] -= p->period[a] * round(d[a] / p->period[a]);
        r2 += d[a] * d[a];
    }
    return sqrt(r2);
}

/* 2 c of everybody, and c_i + c_j + 3 times how fast the pair closes within the wider width; with
 * the forces and alone. */
TEST(test_signals)
{
    for (int k = 0; k < 4; k++) {
        const int dim = 2 + k % 2;
        const double unit = k < 2 ? 1 : 1e-10; /* of speeds: cold gas */
        const struct scheme scheme = made_scheme();
        struct setup setup = lattice_of(dim, dim == 2 ? 14 : 6, 0.2, &scheme);
        for (size_t i = 0; i < setup.n; i++) {
            u[i] = unit * unit * exp(2 * sin(5. * (double)i));
            for (int a = 0; a < dim; a++) v[a][i] = unit * 3 * sin(2 * M_PI * x[a][i] + a);
        }
        struct simulation *simulation = made_of(&setup);
        const struct particles *p = &simulation->particles;
        size_t own = 0;
        for (int alone = 0; alone < 2; alone++) {
            double rate = 0;
            for (size_t i = 0; i < setup.n; i++) p->signal[i] = -1;
            if (alone)
                cells_sums.signal(simulation);
            else
                find_forces(simulation);
            for (size_t i = 0; i < setup.n; i++) {
                double most = 2 * p->c[i];
                for (size_t j = 0; j < setup.n; j++) {
                    double d[3], closing = 0;
                    const double r = separation(p, i, j, d);
                    if (j == i || !(r < fmax(p->h[i], p->h[j]))) continue;
                    for (int a = 0; a < dim; a++) closing += (p->v[a][i] - p->v[a][j]) * d[a] / r;
                    most = fmax(most, p->c[i] + p->c[j] + 3 * fmax(closing, 0));
                }
                near_relative(p->signal[i], most, 1e-13);
                own += most == 2 * p->c[i];
                rate = fmax(rate, most / p->h[i]);
            }
            assert_true(rate > 0);
        }
        if (dim == 2) assert_true(own > 0);
        simulation_destroy(simulation);
    }
}

/* The pressure of the lagrangian form, CONVENTIONS eq. 5.3, of every volume element, from both
 * widths of a pair; heat by the particle's own. */
TEST(test_lagrangian)
{
    for (int dim = 2; dim <= 3; dim++)
        for (int e = 0; e < VOLUME_ELEMENTS; e++) {
            struct scheme scheme = made_scheme();
            scheme.viscosity = VISCOSITY_NONE;
            scheme.formulation = FORMULATION_LAGRANGIAN;
            scheme.volume_element = (enum volume_element)e;
            scheme.energy = ENERGY_INTERNAL;
            struct setup setup = lattice_of(dim, dim == 2 ? 9 : 6, 0.2, &scheme);
            for (size_t i = 0; i < setup.n; i++) {
                m[i] *= 1 + 0.2 * sin(3. * (double)i), u[i] = 1 + 0.3 * sin(5. * (double)i);
                for (int a = 0; a < dim; a++) v[a][i] = sin(11. * (double)i + a);
            }
            struct simulation *simulation = made_of(&setup);
            const struct particles *p = &simulation->particles;
            double Z[N], M[N], b[N];
            for (size_t i = 0; i < setup.n; i++) {
                Z[i] = e == VOLUME_NUMBER ? 1 : e == VOLUME_ENERGY ? p->U[i] : p->m[i];
                M[i] = e == VOLUME_NUMBER ? 1 : p->m[i];
                b[i] = p->P[i] * p->V[i] * p->V[i] / Z[i];
            }
            for (size_t i = 0; i < setup.n; i++) {
                double F[3] = {0}, heat = 0, size = 0;
                for (size_t j = 0; j < setup.n; j++) {
                    double d[3];
                    const double r = separation(p, i, j, d);
                    if (j == i) continue;
                    const double slope = kernel_slope_of(&scheme.kernel, r, p->h[i], dim),
                                 other = kernel_slope_of(&scheme.kernel, r, p->h[j], dim),
                                 own = b[i] * (Z[j] - M[j] * p->grad_h[i]) * slope / r,
                                 theirs = b[j] * (Z[i] - M[i] * p->grad_h[j]) * other / r;
                    for (int a = 0; a < dim; a++) {
                        F[a] += (own + theirs) * d[a];
                        heat += own * d[a] * (p->v[a][j] - p->v[a][i]);
                        size += fabs(own * d[a]) + fabs(theirs * d[a]);
                    }
                }
                for (int a = 0; a < dim; a++) near_below(fabs(p->F[a][i] - F[a]), 1e-11 * size);
                near_below(fabs(p->de[i] - heat), 1e-11 * size);
            }
            simulation_destroy(simulation);
        }
}

/* Who has no neighbours feels no force and has the signal speed of its own sound. */
TEST(test_alone)
{
    for (int dim = 2; dim <= 3; dim++) {
        const struct scheme scheme = made_scheme();
        const struct cells_method method = {
            .box = {dim, {0}, {1, 1, 1}, {false}}, .kernel = &scheme.kernel, .threads = 1};
        double at[2][3] = {{0.1, 0.9}, {0.2, 0.7}}, F[3][2], of[8][2];
        const double ones[] = {1, 1}, radius[] = {0.2, 0.2}, inverse[] = {5, 5}, c[] = {3, 0.7};
        const struct cells_fields fields = {.n = 2,
                                            .x = {at[0], at[1], at[1]},
                                            .v = {ones, ones, ones},
                                            .m = ones,
                                            .h_inverse = inverse,
                                            .P = ones,
                                            .c = c,
                                            .V = ones,
                                            .sum_m = of[0],
                                            .sum_m_dh = of[1],
                                            .F = {F[0], F[1], F[2]},
                                            .de = of[2],
                                            .signal = of[3]};
        struct cells *cells = cells_create(&method, 2);
        assert_int_equal(cells_arrange(cells, &fields, radius, NULL, NULL), STATUS_OK);
        cells_density(cells, &fields);
        assert_int_equal(cells_forces(cells, &fields), 0);
        for (int i = 0; i < 2; i++) {
            const double w = scheme.kernel.w(&scheme.kernel, 0, dim);
            near_relative(of[0][i], w, 1e-15);
            near_relative(of[1][i], dim * w, 1e-15);
            for (int a = 0; a < dim; a++) assert_true(F[a][i] == 0);
            assert_true(of[2][i] == 0 && of[3][i] == 2 * c[i]);
        }
        cells_destroy(cells);
    }
}

/* Where all masses are the same, numbers are as good as masses. */
TEST(test_equal_masses)
{
    static double of[5][N];
    for (int dim = 2; dim <= 3; dim++)
        for (int number = 0; number < 2; number++) {
            struct scheme scheme = made_scheme();
            scheme.formulation = FORMULATION_LAGRANGIAN;
            scheme.volume_element = number ? VOLUME_NUMBER : VOLUME_MASS;
            const struct setup setup = lattice_of(dim, dim == 2 ? 16 : 8, 0.2, &scheme);
            struct simulation *simulation = made_of(&setup);
            const struct particles *p = &simulation->particles;
            const double *const found[] = {p->F[0], p->F[1], p->de, p->h, p->grad_h};
            for (int k = 0; k < 5; k++)
                for (size_t i = 0; i < setup.n; i++)
                    if (number)
                        near_below(fabs(found[k][i] - of[k][i]), 1e-10 * (1 + fabs(of[k][i])));
                    else
                        of[k][i] = found[k][i];
            simulation_destroy(simulation);
        }
}

/* Axes in another order give the same forces in that order, with walls and whatever the gradient.
 */
TEST(test_axes_are_alike)
{
    static double F[3][N];
    for (int dim = 2; dim <= 3; dim++)
        for (int g = 0; g < 2 * GRADIENTS; g++) {
            struct scheme scheme = made_scheme();
            scheme.gradient = (enum gradient)(g / 2);
            scheme.viscosity = g % 2 ? VISCOSITY_PROJECTED : VISCOSITY_CONSTANT;
            scheme.noise = 0.4;
            for (int turned = 0; turned < 2; turned++) {
                struct setup setup = lattice_of(dim, dim == 2 ? 9 : 6, 0.2, &scheme);
                for (int a = 0; a < dim; a++) {
                    setup.boundary[a] = BOUNDARY_REFLECTING;
                    for (size_t i = 0; i < setup.n; i++) v[a][i] = sin((2. + a) * x[0][i] + a);
                }
                for (int a = 0; a < dim; a++) {
                    setup.x[a] = x[(a + turned) % dim];
                    setup.v[a] = v[(a + turned) % dim];
                }
                struct simulation *simulation = made_of(&setup);
                const struct particles *p = &simulation->particles;
                for (size_t i = 0; i < setup.n; i++)
                    for (int a = 0; a < dim; a++) {
                        double *known = &F[(a + turned) % dim][p->id[i]];
                        if (turned)
                            near_below(fabs(p->F[a][i] - *known), 1e-10 * (0.1 + fabs(*known)));
                        else
                            *known = p->F[a][i];
                    }
                simulation_destroy(simulation);
            }
        }
}

/* Matrices of particles that lie in a line cannot be used: as many as they are, each time; at most
 * so many at once. */
TEST(test_fallen_back)
{
    struct scheme scheme = made_scheme();
    scheme.gradient = GRADIENT_IA;
    for (int dim = 2; dim <= 3; dim++) {
        struct setup setup = lattice_of(dim, 6, 0, &scheme);
        for (int a = 0; a < dim; a++) setup.boundary[a] = BOUNDARY_OPEN;
        setup.n = 20;
        for (size_t i = 0; i < setup.n; i++)
            for (int a = 0; a < dim; a++) x[a][i] = a == 0 ? ((double)i + 0.5) / 20 : 0.5;
        struct simulation *simulation = made_of(&setup);
        for (uint64_t times = 1; times <= 3; times++) {
            struct simulation_cost cost;
            simulation_cost(simulation, &cost);
            assert_int_equal(cost.fallen_back, 20 * times);
            assert_int_equal(cost.fallen_back_most, 20);
            cells_sums.matrix(simulation);
        }
        simulation_destroy(simulation);
    }
}

/* Adds whoever has a neighbour in the set. Returns how many are in it. */
static ptrdiff_t add_neighbours(const struct particles *p, const bool *set, bool *more)
{
    ptrdiff_t count = 0;
    for (ptrdiff_t i = 0; i < p->n; i++) {
        more[i] = set[i];
        for (ptrdiff_t j = 0; j < p->n && !more[i]; j++) {
            double d[3];
            if (!set[j]) continue;
            separation(p, (size_t)i, (size_t)j, d);
            more[i] = hypot(d[0], d[1]) < fmax(p->h[i], p->h[j]);
        }
        count += more[i];
    }
    return count;
}

/* Neighbours of the neighbours of a particle that feels a force are awake, wherever that is. */
TEST(test_awake)
{
    const struct scheme scheme = made_scheme();
    for (size_t row = 0; row < 30; row += 3) {
        bool pushed[1024], near[1024];
        const struct setup setup = long_box_of(&scheme);
        u[8 * row] = 3;
        struct simulation *simulation = made_of(&setup);
        const struct particles *p = &simulation->particles;
        for (size_t i = 0; i < setup.n; i++) pushed[i] = fabs(p->F[0][i]) + fabs(p->F[1][i]) > 1e-6;
        add_neighbours(p, pushed, near);
        const ptrdiff_t awake = add_neighbours(p, near, pushed);
        assert_true(awake > 32 && simulation->sleep.awake_count >= awake);
        assert_true(simulation->sleep.awake_count < 192);
        simulation_destroy(simulation);
    }
}

/* What sleepers do not get is shared out, and no more than the tolerance of each sleeper: a force
 * without its reaction, or work that nothing pays for, still shows in the sums. */
TEST(test_shared_out)
{
    const struct scheme scheme = made_scheme();
    for (int size = 0; size < 2; size++) {
        const struct setup setup = long_box_of(&scheme);
        u[8 * 20] = 3;
        struct simulation *simulation = made_of(&setup);
        const struct particles *p = &simulation->particles;
        const double c = simulation->sleep.sound; /* more than that of the gas at rest */
        const double most = simulation->sleep.tolerance * m[0] * c * c / p->h[8 * 64];
        const double planted = size ? 1e-3 : 10 * most;
        double force = 0, power = 0;
        ptrdiff_t pushed = 0;
        for (ptrdiff_t i = 1; i < p->n; i++)
            if (fabs(p->F[1][i]) > fabs(p->F[1][pushed])) pushed = i;
        p->F[1][pushed] += planted;
        p->de[pushed] += planted;
        sleep_balance(simulation);
        for (ptrdiff_t i = 0; i < p->n; i++) force += p->F[1][i], power += p->de[i];
        const ptrdiff_t awake = simulation->sleep.awake_count;
        assert_true(awake > 30 && awake < 300);
        near_inside(force, size ? 0.999 * planted : -1e-15, size ? planted : 1e-15);
        near_inside(power, size ? 0.999 * planted : -1e-15, size ? planted : 1e-15);
        simulation_destroy(simulation);
    }
}

/* Gas that moves as one sleeps; where it slides along other gas, however slowly, and feels no
 * force, neighbours on both sides are awake. */
TEST(test_awake_in_flow)
{
    const struct scheme scheme = made_scheme();
    for (int boosted = 0; boosted < 2; boosted++) {
        const struct setup setup = long_box_of(&scheme);
        for (size_t i = 0; i < setup.n; i++)
            v[0][i] = boosted + (i < setup.n / 2 ? 1e-8 : 0), v[1][i] = 2 * boosted;
        struct simulation *simulation = made_of(&setup);
        /* of two such layers at least the rows on either side */
        near_inside((double)simulation->sleep.awake_count, 4 * 8, 12 * 8);
        simulation_destroy(simulation);
    }
}

/* The step after which somebody slept for the first time; 0: nobody has. */
struct seen {
    struct simulation *simulation;
    uint64_t first;
};

static bool note_asleep(void *context, double time, uint64_t steps)
{
    struct seen *seen = context;
    (void)time;
    if (!seen->first && seen->simulation->sleep.awake_count < seen->simulation->particles.n)
        seen->first = steps;
    return true;
}

/* Gas in which neighbours move against each other is awake, and falls asleep once viscosity has
 * brought it to rest; with and without sleep it comes to the same. */
TEST(test_asleep_again)
{
    double ends[2][256];
    for (int skip = 0; skip < 2; skip++) {
        const struct scheme scheme = made_scheme();
        struct setup setup = lattice_of(2, 16, 0, &scheme);
        struct seen seen = {0};
        struct snapshot s;
        setup.skip = skip;
        for (size_t i = 0; i < 256; i++) {
            v[0][i] = (i + i / 16) % 2 ? 1e-9 : -1e-9;
        }
        seen.simulation = made_of(&setup);
        assert_int_equal(seen.simulation->sleep.awake_count, 256);
        assert_int_equal(simulation_run(seen.simulation, 2, note_asleep, &seen, NULL), STATUS_OK);
        assert_true(skip ? seen.first > 1 : seen.first == 0);
        simulation_snapshot(seen.simulation, &s);
        for (size_t i = 0; i < s.n; i++) ends[skip][s.id[i]] = s.x[0][i];
        simulation_destroy(seen.simulation);
    }
    for (size_t i = 0; i < 256; i++) near_below(fabs(ends[1][i] - ends[0][i]), 1e-11);
}
