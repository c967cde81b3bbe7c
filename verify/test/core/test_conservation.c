/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares the sums of conserved quantities over random particles with sums in extended precision.
 * Momenta nearly cancel, so that a sum in double precision would be wrong by much more than the
 * bound. */
#include "test.h"

#include "draw.h"
#include "solver.h"

enum { MOST = 41 };

static double x[3][MOST], p[3][MOST], m[MOST], c[MOST], e[MOST];

static void draw_particles(struct simulation *simulation, int dim, int n)
{
    *simulation = (struct simulation){.particles = {.dim = dim, .n = n, .m = m, .c = c, .e = e},
                                      .team.size = 1};
    simulation->scheme.energy = draw(0, 1) < 0.5 ? ENERGY_TOTAL : ENERGY_INTERNAL;
    for (int k = 0; k < dim; k++) {
        simulation->lo[k] = draw(-1, 1);
        simulation->particles.period[k] = draw(0.5, 2);
        simulation->boundary[k] = draw(0, 1) < 0.5 ? BOUNDARY_PERIODIC : BOUNDARY_OPEN;
        simulation->gravity[k] = draw(0, 1) < 0.5 ? 0 : draw(-1, 1);
        simulation->particles.x[k] = x[k];
        simulation->particles.p[k] = p[k];
        for (int i = 0; i < n; i++) {
            x[k][i] = simulation->lo[k] + draw(-1, 2) * simulation->particles.period[k];
            p[k][i] = i % 2 ? -p[k][i - 1] * (1 + 1e-9 * draw(-1, 1)) : draw(-1e3, 1e3);
        }
    }
    for (int i = 0; i < n; i++) m[i] = draw(1, 2), c[i] = draw(0.1, 3), e[i] = draw(1, 2);
}

static void near_sum(double value, long double expected, long double size)
{
    near_below((double)fabsl(value - expected), (double)(1e-18L * size + 1e-15L * fabsl(expected)));
}

TEST(sums_without_round_off)
{
    for (int trial = 0; trial < 3000; trial++) {
        const int dim = 1 + trial % 3, n = draw_count(1, MOST - 1);
        struct simulation simulation;
        struct conservation sums;
        long double mass = 0, sound = 0, energy = 0, kinetic = 0, size = 0, momentum[3] = {0},
                    of_momentum[3] = {0}, L[3] = {0}, of_L = 0, turning = 0;
        draw_particles(&simulation, dim, n);
        for (int i = 0; i < n; i++) {
            long double r[3] = {0}, q[3] = {0}, square = 0, distance = 0;
            for (int k = 0; k < dim; k++) {
                const long double side = simulation.particles.period[k];
                r[k] = x[k][i] - simulation.lo[k];
                if (simulation.boundary[k] == BOUNDARY_PERIODIC) r[k] -= side * floorl(r[k] / side);
                r[k] -= 0.5L * side;
                q[k] = p[k][i];
                momentum[k] += q[k];
                of_momentum[k] += fabsl(q[k]);
                square += q[k] * q[k];
                distance += r[k] * r[k];
                energy -= (long double)m[i] * simulation.gravity[k] * x[k][i];
            }
            const long double l[] = {r[1] * q[2] - r[2] * q[1], r[2] * q[0] - r[0] * q[2],
                                     r[0] * q[1] - r[1] * q[0]};
            for (int k = 0; k < 3; k++) L[k] += l[k];
            of_L += sqrtl(l[0] * l[0] + l[1] * l[1] + l[2] * l[2]);
            turning += sqrtl(distance) * m[i] * c[i];
            mass += m[i];
            sound += (long double)m[i] * c[i];
            size += sqrtl(square);
            kinetic += square / m[i] / 2;
            energy += e[i] + (simulation.scheme.energy == ENERGY_TOTAL ? 0 : square / m[i] / 2);
        }
        conservation_sums(&simulation, &sums);
        near_sum(sums.mass, mass, 0);
        near_sum(sums.sound_scale, sound, 0);
        near_sum(sums.momentum_scale, size, 0);
        near_sum(sums.kinetic, kinetic, 0);
        near_sum(sums.energy, energy, 1e4L * kinetic);
        for (int k = 0; k < 3; k++) near_sum(sums.momentum[k], momentum[k], of_momentum[k]);
        for (int k = 0; k < 3; k++)
            near_sum(sums.angular_momentum[k], dim > 1 ? L[k] : 0, 1e4L * of_L);
        near_sum(sums.angular_scale, dim > 1 ? of_L : 0, 1e4L * of_L);
        near_sum(sums.turning_scale, dim > 1 ? turning : 0, 1e4L * turning);
    }
}
