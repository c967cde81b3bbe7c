/* SPDX-License-Identifier: GPL-3.0-or-later
 * The reach of neighbours: the largest difference of their indices. */
#include "line.h"
#include "specialise.h"

ALWAYS_INLINE double count_inside(const struct particles *particles, ptrdiff_t first, int len,
                                  ptrdiff_t d)
{
    const double *restrict x = particles->x[0] + first, *restrict h_inverse =
                                                            particles->h_inverse + first;
    double inside = 0;
#pragma omp simd reduction(+ : inside)
    for (int i = 0; i < len; i++)
        inside += least(x[i + d] - x[i], x[i] - x[i - d]) * h_inverse[i] < 1 ? 1. : 0.;
    return inside;
}

CLONES static double inside_specialised(const struct particles *particles, ptrdiff_t first, int len,
                                        ptrdiff_t d)
{
    return len == BATCH_MAX ? count_inside(particles, first, BATCH_MAX, d)
                            : count_inside(particles, first, len, d);
}

double reach_inside(const struct particles *particles, ptrdiff_t first, int len, ptrdiff_t d)
{
    return inside_specialised(particles, first, len, d);
}

bool reach_cover(const struct simulation *simulation, struct range *range)
{
    const ptrdiff_t filled = line_of(simulation)->ghosts_filled;
    while (range->reach + 1 <= filled) {
        if (reach_inside(&simulation->particles, range->first, range->len, range->reach + 1) <= 0)
            return true;
        range->reach++;
    }
    return false;
}

void reach_tighten(const struct simulation *simulation, struct range *range)
{
    while (range->reach > 1 &&
           reach_inside(&simulation->particles, range->first, range->len, range->reach) <= 0)
        range->reach--;
}

ptrdiff_t reach_of_pairs(const struct simulation *simulation, const struct range *range)
{
    const struct line *line = line_of(simulation);
    const struct range *ranges = line->ranges;
    const ptrdiff_t count = line->range_count, b = range - ranges;
    ptrdiff_t reach = range->reach, gap = 0; /* particles between the two ranges */
    for (ptrdiff_t k = 1; k < count && gap < line->reach; k++) {
        const struct range *right = &ranges[(b + k) % count],
                           *left = &ranges[(b - k + count) % count];
        if (gap < right->reach && right->reach > reach) reach = right->reach;
        if (gap < left->reach && left->reach > reach) reach = left->reach;
        gap += right->len < left->len ? right->len : left->len;
    }
    return reach;
}
