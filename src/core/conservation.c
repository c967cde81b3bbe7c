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

/* Sums of the motion along straight lines, and, below, of the rotation about the box's middle. */
struct straight {
    struct lanes_sum mass, energy, kinetic, momentum[3], momentum_size, sound;
};

struct turning {
    struct lanes_sum angular[3], size, sound;
};

/* Adds the particles k to k + count - 1, at most LANES. */
ALWAYS_INLINE void add_straight(int dim, const struct simulation *simulation, ptrdiff_t k,
                                int count, struct straight *sums)
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
        add(&sums->momentum_size, l, dim > 1 ? sqrt(square) : fabs(a->p[0][k + l]));
        add(&sums->sound, l, m[l] * c[l]);
    }
}

/* Position along an axis from the middle of the box, wrapped into a periodic box. */
ALWAYS_INLINE double from_middle(double x, double lo, double period, double wraps)
{
    const double inside = x - lo;
    return inside - period * (wraps * floor(inside / period) + 0.5);
}

ALWAYS_INLINE void add_turning(int dim, const struct simulation *simulation, ptrdiff_t k, int count,
                               struct turning *sums)
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
        if (dim > 2) add(&sums->angular[0], l, Lx);
        if (dim > 2) add(&sums->angular[1], l, Ly);
        add(&sums->angular[2], l, Lz);
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
ALL(straight_1, straight, 1)
ALL(straight_2, straight, 2)
ALL(straight_3, straight, 3)
ALL(turning_2, turning, 2)
ALL(turning_3, turning, 3)

static double gravitational(const struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    long double sum = 0;
    for (int axis = 0; axis < a->dim; axis++)
        for (ptrdiff_t i = 0; simulation->gravity[axis] != 0 && i < a->n; i++)
            sum -= (long double)a->m[i] * simulation->gravity[axis] * a->x[axis][i];
    return (double)sum;
}

static void find_straight(const struct simulation *simulation, struct conservation *sums)
{
    const int dim = simulation->particles.dim;
    struct straight of[2];
    (dim == 1 ? straight_1 : dim == 2 ? straight_2 : straight_3)(simulation, of);
    sums->mass = sum_of(&of[0].mass, &of[1].mass);
    for (int k = 0; k < dim; k++)
        sums->momentum[k] = sum_of(&of[0].momentum[k], &of[1].momentum[k]);
    sums->momentum_scale = sum_of(&of[0].momentum_size, &of[1].momentum_size);
    sums->sound_scale = sum_of(&of[0].sound, &of[1].sound);
    sums->kinetic = sum_of(&of[0].kinetic, &of[1].kinetic);
    sums->energy = sum_of(&of[0].energy, &of[1].energy) + gravitational(simulation);
    if (simulation->scheme.energy == ENERGY_INTERNAL) sums->energy += sums->kinetic;
}

static void find_turning(const struct simulation *simulation, struct conservation *sums)
{
    struct turning of[2];
    (simulation->particles.dim == 2 ? turning_2 : turning_3)(simulation, of);
    for (int k = 0; k < 3; k++)
        sums->angular_momentum[k] = sum_of(&of[0].angular[k], &of[1].angular[k]);
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
        find_straight(simulation, sums);
#pragma omp section
        if (a->dim > 1) find_turning(simulation, sums);
    }
}
