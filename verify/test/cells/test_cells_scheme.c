/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a scheme's numbers do in 2D and 3D: beta where there is no alpha, and signal speeds. */
#include "test.h"

#include "made_lattice.h"
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
