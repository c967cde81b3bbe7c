/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "particles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 8 }; /* doubles in a cache line */

#define FIELD(name, meaning) +1
enum { FIELD_COUNT = 0 PARTICLE_FIELDS(FIELD) };
#undef FIELD

static ptrdiff_t stride(ptrdiff_t n, ptrdiff_t ghosts)
{
    /* an odd number of cache lines, so that the arrays do not fall on the same cache sets */
    const ptrdiff_t lines = (n + 2 * ghosts + LINE - 1) / LINE + 1;
    return LINE * (lines | 1);
}

static enum status allocate(struct particles *particles, struct error *error)
{
    particles->ghosts = (particles->ghosts + LINE - 1) / LINE * LINE;
    const ptrdiff_t length = stride(particles->n, particles->ghosts);
    const size_t bytes = (size_t)length * (FIELD_COUNT + 1) * sizeof(double);
    particles->block = aligned_alloc(64, bytes);
    if (!particles->block)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %td particles (%zu MiB)",
                         particles->n, bytes >> 20);
    memset(particles->block, 0, bytes);
    double *next = particles->block + particles->ghosts;
#define FIELD(name, meaning)                                                                       \
    particles->name = next;                                                                        \
    next += length;
    PARTICLE_FIELDS(FIELD)
#undef FIELD
    particles->spare = next;
    return STATUS_OK;
}

enum status particles_create(struct particles *particles, ptrdiff_t n, ptrdiff_t ghosts,
                             struct error *error)
{
    *particles = (struct particles){.n = n, .ghosts = ghosts};
    const enum status status = allocate(particles, error);
    if (status) return status;
    particles->id = malloc((size_t)n * sizeof *particles->id);
    particles->order = malloc((size_t)n * sizeof *particles->order);
    if (particles->id && particles->order) return STATUS_OK;
    particles_destroy(particles);
    return error_set(error, STATUS_ENVIRONMENT, "no memory for %td particles", n);
}

void particles_destroy(struct particles *particles)
{
    free(particles->block);
    free(particles->id);
    free(particles->order);
    *particles = (struct particles){0};
}

enum status particles_grow_ghosts(struct particles *particles, ptrdiff_t ghosts,
                                  struct error *error)
{
    struct particles grown = *particles;
    grown.ghosts = ghosts;
    const enum status status = allocate(&grown, error);
    if (status) return status;
    const size_t bytes = (size_t)particles->n * sizeof(double);
#define FIELD(name, meaning) memcpy(grown.name, particles->name, bytes);
    PARTICLE_FIELDS(FIELD)
#undef FIELD
    free(particles->block);
    *particles = grown;
    return STATUS_OK;
}

void particles_fill_ghosts(const struct particles *particles, double *array, ptrdiff_t count,
                           double shift)
{
    const ptrdiff_t n = particles->n;
    /* counted upwards and downwards from the ends: images of images where count > n */
    for (ptrdiff_t k = 0; k < count; k++) array[n + k] = array[k] + shift;
    for (ptrdiff_t k = 1; k <= count; k++) array[-k] = array[n - k] - shift;
}

static void permute(struct particles *particles, double *array)
{
    for (ptrdiff_t i = 0; i < particles->n; i++) particles->spare[i] = array[particles->order[i]];
    memcpy(array, particles->spare, (size_t)particles->n * sizeof *array);
}

bool particles_sort(struct particles *particles)
{
    const ptrdiff_t n = particles->n;
    double *x = particles->x, *x_old = particles->x_old;
    for (ptrdiff_t i = 0; i < n; i++)
        if (!isfinite(x[i])) return false;

    /* All into one period that starts at the first particle, then a stable insertion sort: the
     * order is nearly right. */
    const double start = x[0];
    for (ptrdiff_t i = 0; i < n; i++) {
        const double shift = -particles->period * floor((x[i] - start) / particles->period);
        x[i] += shift;
        x_old[i] += shift;
        particles->order[i] = (size_t)i;
    }
    for (ptrdiff_t i = 1; i < n; i++) {
        const size_t moving = particles->order[i];
        ptrdiff_t k = i;
        for (; k > 0 && x[particles->order[k - 1]] > x[moving]; k--)
            particles->order[k] = particles->order[k - 1];
        particles->order[k] = moving;
    }
#define FIELD(name, meaning) permute(particles, particles->name);
    PARTICLE_FIELDS(FIELD)
#undef FIELD
    for (ptrdiff_t i = 0; i < n; i++) particles->order[i] = particles->id[particles->order[i]];
    memcpy(particles->id, particles->order, (size_t)n * sizeof *particles->id);
    return true;
}
