/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sums of conserved quantities over all particles. The round-off of every addition is found exactly
 * (Knuth's two-sum) and summed as well, so that it does not count as a lack of conservation.
 * Particles are added in eight lanes, in the same order for every instruction set and any number of
 * threads. */
#include <math.h>

#include "solver.h"
#include "specialise.h"
#include "width.h"

enum { LANES = 8 };

/* The sum of each lane is total + rest. */
struct lanes_sum {
    double total[LANES], rest[LANES];
};

ALWAYS_INLINE void add(struct lanes_sum *sum, int l, double x)
{
    const double before = sum->total[l], after = before + x, added = after - before;
    sum->total[l] = after;
    sum->rest[l] += (before - (after - added)) + (x - added);
}

static double sum_of(const struct lanes_sum *a, const struct lanes_sum *b)
{
    long double sum = 0;
    for (int l = 0; l < LANES; l++)
        sum += (long double)a->total[l] + a->rest[l] + b->total[l] + b->rest[l];
    return (double)sum;
}

/* Sums of mass, energy and momentum, and the sizes |p| and m c that momentum is compared with. */
struct linear {
    struct lanes_sum mass, energy, kinetic, momentum[3], size, sound;
};

/* Sums of angular momentum L about the middle of the box, of |L| and of |r| m c. */
struct angular {
    struct lanes_sum momentum[3], size, sound;
};

/* Adds the particles k to k + count - 1, at most LANES. */
ALWAYS_INLINE void add_linear(int dim, const struct simulation *simulation, ptrdiff_t k, int count,
                              struct linear *sums)
{
    const struct particles *a = &simulation->particles;
    const double *restrict m = a->m + k, *restrict c = a->c + k, *restrict e = a->e + k;
#pragma omp simd
    for (int l = 0; l < count; l++) {
        double square = 0;
        for (int axis = 0; axis < dim; axis++) {
            const double p = a->p[axis][k + l];
            square += p * p;
            add(&sums->momentum[axis], l, p);
        }
        const double motion = 0.5 * square / m[l];
        add(&sums->mass, l, m[l]);
        add(&sums->energy, l, e[l]);
        add(&sums->kinetic, l, motion);
        add(&sums->size, l, dim > 1 ? sqrt(square) : fabs(a->p[0][k + l]));
        add(&sums->sound, l, m[l] * c[l]);
    }
}

/* Position along an axis from the middle of the box, wrapped into a periodic box. */
ALWAYS_INLINE double from_middle(double x, double lo, double period, double wraps)
{
    const double inside = x - lo;
    return inside - period * (wraps * floor(inside / period) + 0.5);
}

ALWAYS_INLINE void add_angular(int dim, const struct simulation *simulation, ptrdiff_t k, int count,
                               struct angular *sums)
{
    const struct particles *a = &simulation->particles;
    const double *lo = simulation->lo, *period = a->period, *m = a->m + k, *c = a->c + k;
    double wraps[3];
    for (int axis = 0; axis < dim; axis++)
        wraps[axis] = simulation->boundary[axis] == BOUNDARY_PERIODIC ? 1 : 0;
#pragma omp simd
    for (int l = 0; l < count; l++) {
        const double x = from_middle(a->x[0][k + l], lo[0], period[0], wraps[0]),
                     y = from_middle(a->x[1][k + l], lo[1], period[1], wraps[1]),
                     z = dim > 2 ? from_middle(a->x[2][k + l], lo[2], period[2], wraps[2]) : 0;
        const double px = a->p[0][k + l], py = a->p[1][k + l], pz = dim > 2 ? a->p[2][k + l] : 0;
        const double Lx = y * pz - z * py, Ly = z * px - x * pz, Lz = x * py - y * px;
        if (dim > 2) add(&sums->momentum[0], l, Lx);
        if (dim > 2) add(&sums->momentum[1], l, Ly);
        add(&sums->momentum[2], l, Lz);
        add(&sums->size, l, dim > 2 ? sqrt(Lx * Lx + Ly * Ly + Lz * Lz) : fabs(Lz));
        add(&sums->sound, l, sqrt(x * x + y * y + z * z) * m[l] * c[l]);
    }
}

/* Whole vectors, then the end: two structures, so that the former stays in registers. */
#define ALL(name, kind, ...)                                                                       \
    CLONES static void name(const struct simulation *simulation, struct kind sums[2])              \
    {                                                                                              \
        struct kind vectors = {0}, end = {0};                                                      \
        const ptrdiff_t n = simulation->particles.n, left = n % LANES;                             \
        for (ptrdiff_t k = 0; k < n - left; k += LANES)                                            \
            add_##kind(__VA_ARGS__, simulation, k, LANES, &vectors);                               \
        add_##kind(__VA_ARGS__, simulation, n - left, (int)left, &end);                            \
        sums[0] = vectors;                                                                         \
        sums[1] = end;                                                                             \
    }
ALL(linear_1, linear, 1)
ALL(linear_2, linear, 2)
ALL(linear_3, linear, 3)
ALL(angular_2, angular, 2)
ALL(angular_3, angular, 3)

/* The sum of the potential energies -m g x. */
static double gravitational(const struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    long double sum = 0;
    for (int axis = 0; axis < a->dim; axis++)
        for (ptrdiff_t i = 0; simulation->gravity[axis] != 0 && i < a->n; i++)
            sum -= (long double)a->m[i] * simulation->gravity[axis] * a->x[axis][i];
    return (double)sum;
}

static void find_linear(const struct simulation *simulation, struct conservation *sums)
{
    const int dim = simulation->particles.dim;
    struct linear of[2];
    (dim == 1 ? linear_1 : dim == 2 ? linear_2 : linear_3)(simulation, of);
    sums->mass = sum_of(&of[0].mass, &of[1].mass);
    for (int k = 0; k < dim; k++)
        sums->momentum[k] = sum_of(&of[0].momentum[k], &of[1].momentum[k]);
    sums->momentum_scale = sum_of(&of[0].size, &of[1].size);
    sums->sound_scale = sum_of(&of[0].sound, &of[1].sound);
    sums->kinetic = sum_of(&of[0].kinetic, &of[1].kinetic);
    sums->energy = sum_of(&of[0].energy, &of[1].energy) + gravitational(simulation);
    if (simulation->scheme.energy == ENERGY_INTERNAL) sums->energy += sums->kinetic;
}

static void find_angular(const struct simulation *simulation, struct conservation *sums)
{
    struct angular of[2];
    (simulation->particles.dim == 2 ? angular_2 : angular_3)(simulation, of);
    for (int k = 0; k < 3; k++)
        sums->angular_momentum[k] = sum_of(&of[0].momentum[k], &of[1].momentum[k]);
    sums->angular_scale = sum_of(&of[0].size, &of[1].size);
    sums->turning_scale = sum_of(&of[0].sound, &of[1].sound);
}

/* Two threads compute whole sums each, so that the order of addition is the same as with one. */
void conservation_sums(const struct simulation *simulation, struct conservation *sums)
{
    const struct particles *a = &simulation->particles;
    const bool shared = simulation->team.size > 1 && a->n >= WORTH_A_THREAD * BATCH_MAX;
    *sums = (struct conservation){0};
#pragma omp parallel sections num_threads(2) if (shared && a->dim > 1)
    {
        find_linear(simulation, sums);
#pragma omp section
        if (a->dim > 1) find_angular(simulation, sums);
    }
}
