/* SPDX-License-Identifier: GPL-3.0-or-later
 * Ghosts at both ends of the arrays: copies of the periodic images, mirror images in walls, or
 * particles too far away to interact. */
#include "line.h"

void ghosts_fill(const struct particles *particles, double *array, ptrdiff_t count, double shift)
{
    const ptrdiff_t n = particles->n;
    /* in this order, so that for count > n the copies are copied in turn */
    for (ptrdiff_t k = 0; k < count; k++) array[n + k] = array[k] + shift;
    for (ptrdiff_t k = 1; k <= count; k++) array[-k] = array[n - k] - shift;
}

/* Image k = 0, 1, ... beyond an end: of the particle with index `from` counted from that end,
 * `turns` periods of two boxes away. Every other box of images is mirrored. */
struct image {
    ptrdiff_t from;
    double turns;
    bool mirrored;
};

static struct image image_of(ptrdiff_t n, ptrdiff_t k)
{
    const ptrdiff_t in_pair = k % (2 * n);
    return in_pair < n ? (struct image){in_pair, (double)(k / (2 * n)), true}
                       : (struct image){2 * n - 1 - in_pair, (double)(k / (2 * n)) + 1, false};
}

/* Position of a particle's image in the walls [0, length]; x: distance from the wall beyond which
 * the image is. */
static double mirrored_position(const struct image *image, double x, double length)
{
    return 2 * image->turns * length + (image->mirrored ? x : -x);
}

static void fill_mirrored(const struct simulation *simulation, double *array, ptrdiff_t count,
                          enum ghost_value value)
{
    const ptrdiff_t n = simulation->particles.n;
    const double length = simulation->particles.period[0];
    const double lo = simulation->lo[0], hi = lo + length;
    for (ptrdiff_t k = 0; k < count; k++) {
        const struct image image = image_of(n, k);
        const double right = array[n - 1 - image.from], left = array[image.from];
        if (value == GHOST_POSITION) {
            array[n + k] = hi + mirrored_position(&image, hi - right, length);
            array[-1 - k] = lo - mirrored_position(&image, left - lo, length);
        } else {
            const double sign = value == GHOST_VECTOR && image.mirrored ? -1 : 1;
            array[n + k] = sign * right;
            array[-1 - k] = sign * left;
        }
    }
}

/* Copies of the outermost particles, beyond any smoothing length. */
static void fill_far(const struct simulation *simulation, double *array, ptrdiff_t count,
                     enum ghost_value value)
{
    static const double far = 1e60;
    const ptrdiff_t n = simulation->particles.n;
    for (ptrdiff_t k = 0; k < count; k++) {
        const double away = value == GHOST_POSITION ? far * (double)(k + 1) : 0;
        array[n + k] = array[n - 1] + away;
        array[-1 - k] = array[0] - away;
    }
}

void ghosts_set(const struct simulation *simulation, double *array, ptrdiff_t count,
                enum ghost_value value)
{
    const struct particles *a = &simulation->particles;
    if (simulation->boundary[0] == BOUNDARY_PERIODIC)
        ghosts_fill(a, array, count, value == GHOST_POSITION ? a->period[0] : 0);
    else if (simulation->boundary[0] == BOUNDARY_REFLECTING)
        fill_mirrored(simulation, array, count, value);
    else
        fill_far(simulation, array, count, value);
}

enum status ghosts_of_density(struct simulation *simulation, ptrdiff_t count, struct error *error)
{
    struct particles *a = &simulation->particles;
    struct line *line = line_of(simulation);
    /* loops in whole vectors read beyond the last ghost */
    if (count + 8 > a->ghosts) {
        const enum status status = particles_grow_ghosts(a, count + count / 2 + 8, error);
        if (status) return status;
    }
    if (count > line->ghosts_filled) ghosts_set(simulation, a->m, count, GHOST_SCALAR);
    line->ghosts_filled = count;
    ghosts_set(simulation, a->x[0], count, GHOST_POSITION);
    if (simulation->plan.energy_sum) ghosts_set(simulation, a->U, count, GHOST_SCALAR);
    return STATUS_OK;
}

void ghosts_of_pairs(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    const struct plan *plan = &simulation->plan;
    const ptrdiff_t count = line_of(simulation)->reach + 1;
    double *const always[] = {a->h, a->h_inverse, a->V, a->P, a->c};
    ghosts_set(simulation, a->v[0], count, GHOST_VECTOR);
    for (size_t k = 0; k < sizeof always / sizeof *always; k++)
        ghosts_set(simulation, always[k], count, GHOST_SCALAR);
    if (plan->own_gradient) ghosts_set(simulation, a->g, count, GHOST_SCALAR);
    if (plan->viscosity) {
        ghosts_set(simulation, a->rho, count, GHOST_SCALAR);
        ghosts_set(simulation, a->alpha, count, GHOST_SCALAR);
    }
    if (plan->grad_h) {
        ghosts_set(simulation, a->b, count, GHOST_SCALAR);
        ghosts_set(simulation, a->grad_h, count, GHOST_SCALAR);
    }
}
