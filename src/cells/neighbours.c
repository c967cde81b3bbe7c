/* SPDX-License-Identifier: GPL-3.0-or-later
 * Hilbert curve: Skilling 2004, AIP Conf. Proc. 707, 381. */
#include "neighbours.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "specialise.h"

enum { BLOCK = NEIGHBOURS_BLOCK, FAN = 8, IMAGES_MAX = 8 };

/* Spreads the lowest bits of x to a distance of stride. */
static uint64_t spread(uint64_t x, int stride)
{
    if (stride == 2) {
        x = (x | x << 16) & 0x0000ffff0000ffff;
        x = (x | x << 8) & 0x00ff00ff00ff00ff;
        x = (x | x << 4) & 0x0f0f0f0f0f0f0f0f;
        x = (x | x << 2) & 0x3333333333333333;
        x = (x | x << 1) & 0x5555555555555555;
    } else if (stride == 3) {
        x = (x | x << 32) & 0x001f00000000ffff;
        x = (x | x << 16) & 0x001f0000ff0000ff;
        x = (x | x << 8) & 0x100f00f00f00f00f;
        x = (x | x << 4) & 0x10c30c30c30c30c3;
        x = (x | x << 2) & 0x1249249249249249;
    }
    return x;
}

/* Index along the Hilbert curve of a cell with coordinates c of `bits` bits each: Skilling's
 * AxesToTranspose without branches, then the bits interleaved. */
ALWAYS_INLINE uint64_t hilbert_key(int dim, int bits, uint64_t c[])
{
    if (dim == 1) return c[0];
    for (int b = bits - 1; b > 0; b--) {
        const uint64_t below = ((uint64_t)1 << b) - 1;
        for (int a = 0; a < dim; a++) {
            const uint64_t set = -(c[a] >> b & 1), t = (c[0] ^ c[a]) & below & ~set;
            c[0] ^= (below & set) | t;
            c[a] ^= t;
        }
    }
    for (int a = 1; a < dim; a++) c[a] ^= c[a - 1];
    uint64_t t = 0, key = 0;
    for (int b = bits - 1; b > 0; b--) t ^= (((uint64_t)1 << b) - 1) & -(c[dim - 1] >> b & 1);
    for (int a = 0; a < dim; a++) key |= spread(c[a] ^ t, dim) << (dim - 1 - a);
    return key;
}

struct entry {
    uint64_t key;
    uint32_t index;
};

/* Stable radix sort of entries by key; other: work array of the same size. */
static void sort(struct entry *entries, struct entry *other, size_t n)
{
    for (int shift = 0; shift < 64; shift += 8) {
        size_t start[257] = {0};
        for (size_t i = 0; i < n; i++) start[(entries[i].key >> shift & 255) + 1]++;
        if (start[(entries[0].key >> shift & 255) + 1] == n) continue;
        for (int d = 0; d < 256; d++) start[d + 1] += start[d];
        for (size_t i = 0; i < n; i++) other[start[entries[i].key >> shift & 255]++] = entries[i];
        memcpy(entries, other, n * sizeof *entries);
    }
}

static double wrapped(double x, double lo, double length)
{
    const double y = x - length * floor((x - lo) / length);
    return y < lo + length ? y : lo; /* round-off may give the upper edge */
}

static double coordinate(const struct points *points, int axis, size_t i)
{
    const double x = points->x[axis][i];
    return points->periodic ? wrapped(x, points->lo[axis], points->hi[axis] - points->lo[axis]) : x;
}

static bool order_points(struct neighbours *nb, const struct points *points)
{
    const int dim = points->dim, bits = 63 / dim - (dim == 1);
    struct entry *entries = malloc(2 * points->n * sizeof *entries);
    if (!entries) return false;
    double lo[3] = {0}, extent = 0;
    for (int a = 0; a < dim; a++) {
        double hi = lo[a] = coordinate(points, a, 0);
        for (size_t i = 1; i < points->n; i++) {
            const double x = coordinate(points, a, i);
            if (x < lo[a]) lo[a] = x;
            if (x > hi) hi = x;
        }
        if (hi - lo[a] > extent) extent = hi - lo[a];
    }
    const double cells = (double)((uint64_t)1 << (bits < 52 ? bits : 52));
    const double scale = cells / extent <= 1e300 ? (cells - 1) / extent : 0;
    for (size_t i = 0; i < points->n; i++) {
        uint64_t c[3] = {0};
        for (int a = 0; scale > 0 && a < dim; a++) /* 0: extent too small or too large to sort */
            c[a] = (uint64_t)((coordinate(points, a, i) - lo[a]) * scale);
        entries[i] = (struct entry){hilbert_key(dim, bits, c), (uint32_t)i};
    }
    sort(entries, entries + points->n, points->n);
    for (size_t i = 0; i < points->n; i++) nb->order[i] = entries[i].index;
    free(entries);
    for (int a = 0; a < dim; a++)
        for (size_t i = 0; i < nb->blocks * BLOCK; i++)
            nb->x[a][i] = i < points->n ? coordinate(points, a, nb->order[i]) : HUGE_VAL;
    return true;
}

/* Level 0 has the boxes of blocks of points, each further level the boxes of eight boxes below. */
static bool build_boxes(struct neighbours *nb)
{
    const size_t dim = (size_t)nb->dim;
    for (size_t count = nb->blocks;; count = (count + FAN - 1) / FAN) {
        const int l = nb->levels++;
        const size_t stride = (count + FAN - 1) / FAN * FAN;
        nb->count[l] = count;
        nb->stride[l] = stride;
        nb->lo[l] = malloc(stride * dim * sizeof(double));
        nb->hi[l] = malloc(stride * dim * sizeof(double));
        if (!nb->lo[l] || !nb->hi[l]) return false;
        for (size_t a = 0; a < dim; a++) {
            const size_t end = l ? nb->count[l - 1] : nb->n;
            const double *from = l ? nb->lo[l - 1] + a * nb->stride[l - 1] : nb->x[a];
            const double *to = l ? nb->hi[l - 1] + a * nb->stride[l - 1] : nb->x[a];
            for (size_t b = 0; b < stride; b++) {
                double lo = HUGE_VAL, hi = -HUGE_VAL;
                for (size_t k = b * FAN; k < end && k < (b + 1) * FAN; k++) {
                    lo = from[k] < lo ? from[k] : lo;
                    hi = to[k] > hi ? to[k] : hi;
                }
                nb->lo[l][a * stride + b] = lo;
                nb->hi[l][a * stride + b] = hi;
            }
        }
        if (count == 1) return true;
    }
}
_Static_assert((int)FAN == (int)BLOCK, "one loop makes the boxes of every level");

static enum status check(const struct points *points, struct error *error)
{
    if (points->n > (size_t)1 << 31)
        return error_set(error, STATUS_BAD_INPUT, "%zu points: at most 2^31 are allowed",
                         points->n);
    for (int a = 0; a < points->dim; a++) {
        if (points->periodic &&
            !(points->lo[a] < points->hi[a] && points->hi[a] <= 1e300 && points->lo[a] >= -1e300))
            return error_set(error, STATUS_BAD_INPUT, "periodic box from %g to %g in %c is empty",
                             points->lo[a], points->hi[a], "xyz"[a]);
        for (size_t i = 0; i < points->n; i++)
            if (!isfinite(points->x[a][i]))
                return error_set(error, STATUS_BAD_INPUT, "point %zu: %c = %g is not finite", i,
                                 "xyz"[a], points -> x[a][i]);
    }
    return STATUS_OK;
}

enum status neighbours_create(const struct points *points, struct neighbours **neighbours,
                              struct error *error)
{
    *neighbours = NULL;
    if (check(points, error)) return STATUS_BAD_INPUT;
    struct neighbours *nb = calloc(1, sizeof *nb);
    if (!nb) goto no_memory;
    nb->dim = points->dim;
    nb->n = points->n;
    nb->blocks = (points->n + BLOCK - 1) / BLOCK;
    nb->periodic = points->periodic;
    for (int a = 0; a < nb->dim; a++) nb->length[a] = points->hi[a] - points->lo[a];
    if (nb->n > 0) {
        for (int a = 0; a < nb->dim; a++)
            if (!(nb->x[a] = malloc(nb->blocks * BLOCK * sizeof(double)))) goto no_memory;
        if (!(nb->order = malloc(nb->n * sizeof *nb->order))) goto no_memory;
        if (!order_points(nb, points) || !build_boxes(nb)) goto no_memory;
    }
    *neighbours = nb;
    return STATUS_OK;
no_memory:
    neighbours_destroy(nb);
    return error_set(error, STATUS_ENVIRONMENT, "no memory for the neighbour search of %zu points",
                     points->n);
}

void neighbours_destroy(struct neighbours *nb)
{
    if (!nb) return;
    for (int a = 0; a < 3; a++) free(nb->x[a]);
    free(nb->order);
    for (int l = 0; l < NEIGHBOURS_LEVELS; l++) free(nb->lo[l]), free(nb->hi[l]);
    free(nb);
}

static bool grow(double **array, size_t n)
{
    double *larger = realloc(*array, n * sizeof *larger);
    if (larger) *array = larger;
    return larger != NULL;
}

static bool reserve(struct candidates *c, size_t n)
{
    if (n <= c->capacity) return true;
    const size_t capacity = 2 * n / BLOCK * BLOCK;
    for (int a = 0; a < 3; a++)
        if (!grow(&c->x[a], capacity) || !grow(&c->lo[a], capacity / BLOCK) ||
            !grow(&c->hi[a], capacity / BLOCK))
            return false;
    uint32_t *j = realloc(c->j, capacity * sizeof *j);
    if (!j) return false;
    c->j = j;
    c->capacity = capacity;
    return true;
}

void neighbours_candidates_free(struct candidates *candidates)
{
    for (int a = 0; a < 3; a++)
        free(candidates->x[a]), free(candidates->lo[a]), free(candidates->hi[a]);
    free(candidates->j);
    *candidates = (struct candidates){0};
}

struct query {
    double lo[3], hi[3]; /* the block's box */
    double radius2;
    double shift[3]; /* added to every point */
};

ALWAYS_INLINE void take_block(const struct neighbours *nb, size_t block, const double *shift,
                              struct candidates *c)
{
    const size_t at = c->n / BLOCK;
    for (int a = 0; a < nb->dim; a++) {
        const double *restrict from = nb->x[a] + block * BLOCK, by = shift[a];
        double *restrict x = c->x[a] + c->n;
#pragma omp simd
        for (size_t l = 0; l < BLOCK; l++) x[l] = from[l] + by;
        c->lo[a][at] = nb->lo[0][(size_t)a * nb->stride[0] + block] + by;
        c->hi[a][at] = nb->hi[0][(size_t)a * nb->stride[0] + block] + by;
    }
    uint32_t *restrict j = c->j + c->n;
#pragma omp simd
    for (size_t l = 0; l < BLOCK; l++) j[l] = (uint32_t)(block * BLOCK + l);
    c->n += BLOCK;
}

/* Adds the blocks near the query, eight boxes at a time from the top of the tree. False: no memory.
 */
CLONES static bool walk(const struct neighbours *nb, const struct query *query,
                        struct candidates *c)
{
    struct {
        int level;
        size_t first; /* of eight boxes */
    } stack[FAN * NEIGHBOURS_LEVELS] = {{nb->levels - 1, 0}};
    for (size_t depth = 1; depth > 0;) {
        const int level = stack[--depth].level;
        const size_t first = stack[depth].first;
        double d2[FAN] = {0};
        for (int a = 0; a < nb->dim; a++) {
            const double *restrict lo = nb->lo[level] + (size_t)a * nb->stride[level] + first;
            const double *restrict hi = nb->hi[level] + (size_t)a * nb->stride[level] + first;
            const double from = query->lo[a] - query->shift[a], to = query->hi[a] - query->shift[a];
#pragma omp simd
            for (int l = 0; l < FAN; l++) {
                const double below = lo[l] - to, above = from - hi[l];
                const double gap = below > above ? below : above;
                d2[l] += gap > 0 ? gap * gap : 0;
            }
        }
        if (level == 0 && !reserve(c, c->n + FAN * BLOCK)) return false;
        for (size_t l = FAN; l-- > 0;) {
            if (d2[l] > query->radius2) continue;
            if (level == 0)
                take_block(nb, first + l, query->shift, c);
            else
                stack[depth].level = level - 1, stack[depth++].first = (first + l) * FAN;
        }
    }
    return true;
}

enum status neighbours_gather(const struct neighbours *nb, size_t block, double radius,
                              struct candidates *c, struct error *error)
{
    /* a little more than asked for, so that round-off in the box distance loses no neighbour */
    struct query query = {.radius2 = fmin(radius * radius * (1 + 1e-12), DBL_MAX)};
    for (int a = 0; a < nb->dim; a++) {
        query.lo[a] = nb->lo[0][(size_t)a * nb->stride[0] + block];
        query.hi[a] = nb->hi[0][(size_t)a * nb->stride[0] + block];
    }
    int images[3] = {0};
    c->n = 0;
    for (int a = 0; nb->periodic && a < nb->dim; a++) {
        if (!(radius <= IMAGES_MAX * nb->length[a]))
            return error_set(error, STATUS_BAD_INPUT,
                             "support radius %g exceeds %d lengths of the periodic box (%g in %c)",
                             radius, IMAGES_MAX, nb->length[a], "xyz"[a]);
        images[a] = (int)ceil(radius / nb->length[a]);
    }
    for (int i = -images[0]; i <= images[0]; i++)
        for (int j = -images[1]; j <= images[1]; j++)
            for (int k = -images[2]; k <= images[2]; k++) {
                const int image[3] = {i, j, k};
                for (int a = 0; a < nb->dim; a++) query.shift[a] = image[a] * nb->length[a];
                if (!walk(nb, &query, c))
                    return error_set(error, STATUS_ENVIRONMENT, "no memory for neighbour lists");
            }
    return STATUS_OK;
}
