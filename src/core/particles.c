/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "particles.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "pages.h"

enum { LINE = 8 /* doubles in a cache line */ };

#define SCALAR(name, use, meaning) +1
#define VECTOR(name, use, meaning) +3
enum { ARRAYS_MAX = 0 PARTICLE_FIELDS(SCALAR, VECTOR) };
#undef SCALAR
#undef VECTOR

/* Lists the addresses of the pointers to arrays of these uses; returns their number. */
static size_t list_arrays(struct particles *particles, unsigned uses, double **arrays[ARRAYS_MAX])
{
    size_t count = 0;
#define SCALAR(name, use, meaning)                                                                 \
    if (uses & (use)) arrays[count++] = &particles->name;
#define VECTOR(name, use, meaning)                                                                 \
    for (int k = 0; k < particles->dim && uses & (use); k++) arrays[count++] = &particles->name[k];
    PARTICLE_FIELDS(SCALAR, VECTOR)
#undef SCALAR
#undef VECTOR
    return count;
}

size_t particles_arrays(int dim, unsigned uses)
{
    double **arrays[ARRAYS_MAX];
    return list_arrays(&(struct particles){.dim = dim}, uses, arrays);
}

static ptrdiff_t stride(ptrdiff_t n, ptrdiff_t ghosts)
{
    /* an odd number of cache lines, so that the arrays do not fall on the same cache sets */
    const ptrdiff_t lines = (n + 2 * ghosts + LINE - 1) / LINE + 1;
    return LINE * (lines | 1);
}

static enum status allocate(struct particles *particles, struct error *error)
{
    double **arrays[ARRAYS_MAX];
    const size_t count = list_arrays(particles, USE_ALL, arrays);
    particles->ghosts = (particles->ghosts + LINE - 1) / LINE * LINE;
    const ptrdiff_t length = stride(particles->n, particles->ghosts);
    const size_t bytes = ((size_t)length * (count + 1) + LINE) * sizeof(double);
    /* arrays that the scheme does not use stay untouched and take no memory */
    particles->block = calloc(1, bytes);
    if (!particles->block)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %td particles (%zu MiB)",
                         particles->n, bytes >> 20);
    /* A pass reads a dozen arrays at once; with pages of 4 kB it needs new address translations and
     * restarts prefetching every 512 particles. Short arrays keep small pages: otherwise unused
     * arrays would share a page with others and take memory. */
    if ((size_t)length * sizeof(double) >= PAGES_LARGE) pages_ask_large(particles->block, bytes);
    const size_t beyond = (uintptr_t)particles->block / sizeof(double) % LINE;
    double *next = particles->block + (LINE - (ptrdiff_t)beyond) % LINE + particles->ghosts;
    for (size_t k = 0; k < count; k++, next += length) *arrays[k] = next;
    particles->spare = next;
    return STATUS_OK;
}

enum status particles_create(struct particles *particles, int dim, ptrdiff_t n, ptrdiff_t ghosts,
                             struct error *error)
{
    *particles = (struct particles){.dim = dim, .n = n, .ghosts = ghosts, .uses = USE_ALL};
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
    double **from[ARRAYS_MAX], **to[ARRAYS_MAX];
    const size_t count = list_arrays(particles, particles->uses, from);
    list_arrays(&grown, particles->uses, to);
    for (size_t k = 0; k < count; k++)
        memcpy(*to[k], *from[k], (size_t)particles->n * sizeof(double));
    free(particles->block);
    *particles = grown;
    return STATUS_OK;
}

void particles_serialise(struct particles *particles, struct serialiser *serialiser)
{
    ptrdiff_t ghosts = particles->ghosts;
    double **arrays[ARRAYS_MAX];
    const size_t count = list_arrays(particles, particles->uses, arrays);
    SERIALISE(serialiser, ghosts);
    if (serialiser->failed) return;
    if (ghosts > particles->ghosts && particles_grow_ghosts(particles, ghosts, NULL))
        serialiser->failed = true;
    for (size_t k = 0; k < count; k++)
        serialise(serialiser, *arrays[k] - ghosts,
                  (size_t)(particles->n + 2 * ghosts) * sizeof(double));
    serialise(serialiser, particles->id, (size_t)particles->n * sizeof *particles->id);
}

void particles_permute(struct particles *particles)
{
    const ptrdiff_t n = particles->n;
    double **arrays[ARRAYS_MAX];
    const size_t count = list_arrays(particles, particles->uses, arrays);
    for (size_t k = 0; k < count; k++) {
        double *array = *arrays[k];
        for (ptrdiff_t i = 0; i < n; i++) particles->spare[i] = array[particles->order[i]];
        memcpy(array, particles->spare, (size_t)n * sizeof *array);
    }
    for (ptrdiff_t i = 0; i < n; i++) particles->order[i] = particles->id[particles->order[i]];
    memcpy(particles->id, particles->order, (size_t)n * sizeof *particles->id);
}
