/* SPDX-License-Identifier: GPL-3.0-or-later
 * Hilbert curve: Skilling 2004, AIP Conf. Proc. 707, 381. */
#include "neighbours.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK = NEIGHBOURS_BLOCK, FAN = 8, IMAGES_MAX = 8 };

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Position along the Hilbert curve of a cell with coordinates c, bits each (Skilling's
 * AxesToTranspose, then the bits interleaved). */
static uint64_t hilbert_key(int dim, int bits, uint64_t c[])
{
    const uint64_t top = (uint64_t)1 << (bits - 1);
    uint64_t t, key = 0;
    for (uint64_t q = top; q > 1; q >>= 1)
        for (int a = 0; a < dim; a++)
            if (c[a] & q)
                c[0] ^= q - 1;
            else
                t = (c[0] ^ c[a]) & (q - 1), c[0] ^= t, c[a] ^= t;
    for (int a = 1; a < dim; a++) c[a] ^= c[a - 1];
    t = 0;
    for (uint64_t q = top; q > 1; q >>= 1)
        if (c[dim - 1] & q) t ^= q - 1;
    for (int b = bits - 1; b >= 0; b--)
        for (int a = 0; a < dim; a++) key = key << 1 | ((c[a] ^ t) >> b & 1);
    return key;
}

struct entry {
    uint64_t key;
    uint32_t index;
};

/* Stable radix sort by key; the result is in entries, other is as large. */
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
    return y < lo + length ? y : lo; /* round-off may end at the upper edge */
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
    const double scale = extent > 0 && cells / extent <= 1e300 ? (cells - 1) / extent : 0;
    for (size_t i = 0; i < points->n; i++) {
        uint64_t c[3] = {0};
        for (int a = 0; a < dim; a++) c[a] = (uint64_t)((coordinate(points, a, i) - lo[a]) * scale);
        entries[i] = (struct entry){hilbert_key(dim, bits, c), (uint32_t)i};
    }
    sort(entries, entries + points->n, points->n);
    for (size_t i = 0; i < points->n; i++) nb->order[i] = entries[i].index;
    free(entries);
    for (int a = 0; a < dim; a++)
        for (size_t i = 0; i < nb->blocks * BLOCK; i++)
            nb->x[a][i] = coordinate(points, a, nb->order[smaller(i, points->n - 1)]);
    return true;
}

static void box_include(int dim, double *lo, double *hi, const double *from, const double *to)
{
    for (int a = 0; a < dim; a++) {
        if (from[a] < lo[a]) lo[a] = from[a];
        if (to[a] > hi[a]) hi[a] = to[a];
    }
}

static bool build_boxes(struct neighbours *nb)
{
    const size_t dim = (size_t)nb->dim;
    for (size_t count = nb->blocks;; count = (count + FAN - 1) / FAN) {
        const int l = nb->levels++;
        nb->count[l] = count;
        nb->lo[l] = malloc(count * dim * sizeof(double));
        nb->hi[l] = malloc(count * dim * sizeof(double));
        if (!nb->lo[l] || !nb->hi[l]) return false;
        const size_t below = l ? nb->count[l - 1] : nb->blocks * BLOCK;
        for (size_t b = 0; b < count; b++) {
            double *lo = nb->lo[l] + b * dim, *hi = nb->hi[l] + b * dim;
            for (size_t a = 0; a < dim; a++) lo[a] = HUGE_VAL, hi[a] = -HUGE_VAL;
            for (size_t k = b * FAN; k < smaller((b + 1) * FAN, below); k++) {
                double at[3] = {0};
                for (size_t a = 0; a < dim; a++) at[a] = nb->x[a][smaller(k, nb->n)];
                if (l)
                    box_include(nb->dim, lo, hi, nb->lo[l - 1] + k * dim, nb->hi[l - 1] + k * dim);
                else
                    box_include(nb->dim, lo, hi, at, at);
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

static bool reserve(struct candidates *c, size_t n)
{
    if (n <= c->capacity) return true;
    const size_t capacity = 2 * n;
    for (int a = 0; a < 3; a++) {
        double *x = realloc(c->x[a], capacity * sizeof *x);
        if (!x) return false;
        c->x[a] = x;
    }
    uint32_t *j = realloc(c->j, capacity * sizeof *j);
    if (!j) return false;
    c->j = j;
    c->capacity = capacity;
    return true;
}

void neighbours_candidates_free(struct candidates *candidates)
{
    for (int a = 0; a < 3; a++) free(candidates->x[a]);
    free(candidates->j);
    *candidates = (struct candidates){0};
}

struct query {
    const double *lo, *hi; /* the block's box */
    double radius2;
    double shift[3]; /* added to every point */
};

static bool near(const struct neighbours *nb, int level, size_t box, const struct query *query)
{
    const double *lo = nb->lo[level] + box * (size_t)nb->dim;
    const double *hi = nb->hi[level] + box * (size_t)nb->dim;
    double d2 = 0;
    for (int a = 0; a < nb->dim; a++) {
        const double below = lo[a] + query->shift[a] - query->hi[a];
        const double above = query->lo[a] - (hi[a] + query->shift[a]);
        const double gap = fmax(fmax(below, above), 0);
        d2 += gap * gap;
    }
    return !(d2 > query->radius2);
}

static bool visit(const struct neighbours *nb, int level, size_t box, const struct query *query,
                  struct candidates *c)
{
    if (!near(nb, level, box, query)) return true;
    if (level > 0) {
        const size_t end = smaller((box + 1) * FAN, nb->count[level - 1]);
        for (size_t b = box * FAN; b < end; b++)
            if (!visit(nb, level - 1, b, query, c)) return false;
        return true;
    }
    if (!reserve(c, c->n + BLOCK)) return false;
    for (int a = 0; a < nb->dim; a++)
        for (size_t l = 0; l < BLOCK; l++)
            c->x[a][c->n + l] = nb->x[a][box * BLOCK + l] + query->shift[a];
    for (size_t l = 0; l < BLOCK; l++) c->j[c->n + l] = (uint32_t)(box * BLOCK + l);
    c->n += smaller(BLOCK, nb->n - box * BLOCK);
    return true;
}

enum status neighbours_gather(const struct neighbours *nb, size_t block, double radius,
                              struct candidates *c, struct error *error)
{
    const size_t first = block * (size_t)nb->dim;
    /* a little more than asked for, so that round-off in the box distance loses nobody */
    struct query query = {nb->lo[0] + first, nb->hi[0] + first, radius * radius * (1 + 1e-12), {0}};
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
                if (!visit(nb, nb->levels - 1, 0, &query, c))
                    return error_set(error, STATUS_ENVIRONMENT, "no memory for neighbour lists");
            }
    return STATUS_OK;
}
