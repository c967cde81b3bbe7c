/* SPDX-License-Identifier: GPL-3.0-or-later
 * Copies of the periodic images at both ends of the arrays. */
#include "line.h"

void ghosts_fill(const struct particles *particles, double *array, ptrdiff_t count, double shift)
{
    const ptrdiff_t n = particles->n;
    /* counted upwards and downwards from the ends: images of images where count > n */
    for (ptrdiff_t k = 0; k < count; k++) array[n + k] = array[k] + shift;
    for (ptrdiff_t k = 1; k <= count; k++) array[-k] = array[n - k] - shift;
}

enum status ghosts_of_density(struct simulation *simulation, ptrdiff_t count, struct error *error)
{
    struct particles *a = &simulation->particles;
    struct line *line = line_of(simulation);
    /* loops in whole vectors read a little beyond, and drop it */
    if (count + 8 > a->ghosts) {
        const enum status status = particles_grow_ghosts(a, count + count / 2 + 8, error);
        if (status) return status;
    }
    if (count > line->ghosts_filled) ghosts_fill(a, a->m, count, 0);
    line->ghosts_filled = count;
    ghosts_fill(a, a->x[0], count, a->period[0]);
    if (simulation->plan.energy_sum) ghosts_fill(a, a->U, count, 0);
    return STATUS_OK;
}

void ghosts_of_pairs(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    const struct plan *plan = &simulation->plan;
    const ptrdiff_t count = line_of(simulation)->reach + 1;
    double *const always[] = {a->v[0], a->h, a->h_inverse, a->V, a->P, a->c};
    for (size_t k = 0; k < sizeof always / sizeof *always; k++) ghosts_fill(a, always[k], count, 0);
    if (plan->own_gradient) ghosts_fill(a, a->g, count, 0);
    if (plan->viscosity) {
        ghosts_fill(a, a->rho, count, 0);
        ghosts_fill(a, a->alpha, count, 0);
    }
    if (plan->grad_h) {
        ghosts_fill(a, a->b, count, 0);
        ghosts_fill(a, a->grad_h, count, 0);
    }
}
