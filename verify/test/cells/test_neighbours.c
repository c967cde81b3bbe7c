/* SPDX-License-Identifier: GPL-3.0-or-later
 * The neighbour search of clouds: the order along the Hilbert curve against Skilling's algorithm as
 * he wrote it and against what makes a curve of Hilbert's, boxes and candidates against all blocks,
 * what is refused word for word. */
#include "test.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "draw.h"
#include "near.h"
#include "neighbours.h"

enum { POINTS_MAX = 5000, BLOCK = NEIGHBOURS_BLOCK };

static double place[3][POINTS_MAX];

static struct points points_of(int dim, size_t n)
{
    return (struct points){.dim = dim, .n = n, .x = {place[0], place[1], place[2]}};
}

static struct neighbours *made(const struct points *points)
{
    struct neighbours *nb;
    struct error error;
    if (neighbours_create(points, &nb, &error)) fail_msg("%s", error.message);
    assert_non_null(nb);
    return nb;
}

/* Skilling 2004, AxesToTranspose, and the transposed bits in one number. */
static uint64_t hilbert(int dim, int bits, uint64_t c[])
{
    if (dim == 1) return c[0];
    const uint64_t top = (uint64_t)1 << (bits - 1);
    for (uint64_t q = top; q > 1; q >>= 1)
        for (int a = 0; a < dim; a++) {
            if (c[a] & q) {
                c[0] ^= q - 1;
            } else {
                const uint64_t t = (c[0] ^ c[a]) & (q - 1);
                c[0] ^= t;
                c[a] ^= t;
            }
        }
    for (int a = 1; a < dim; a++) c[a] ^= c[a - 1];
    uint64_t t = 0, key = 0;
    for (uint64_t q = top; q > 1; q >>= 1)
        if (c[dim - 1] & q) t ^= q - 1;
    for (int b = bits - 1; b >= 0; b--)
        for (int a = 0; a < dim; a++) key = key << 1 | ((c[a] ^ t) >> b & 1);
    return key;
}

static const int bits_of[4] = {0, 52, 31, 21};

static double last_cell(int dim)
{
    return ldexp(1, bits_of[dim]) - 1;
}

/* Points on whole numbers that fill the curve's cube: sorted by its key, equal ones as they came.
 */
TEST(test_order)
{
    static uint64_t key[POINTS_MAX];
    for (int trial = 0; trial < 30; trial++) {
        const int dim = 1 + trial % 3, bits = bits_of[dim];
        const size_t n = 900;
        const int shift = (int)(draw_bits() % 8); /* how far their cells lie apart */
        for (size_t i = 0; i < n; i++) {
            uint64_t c[3];
            for (int a = 0; a < dim; a++) {
                c[a] = draw_bits() & (((uint64_t)1 << bits) - 1);
                if (i % 3 == 0) c[a] = c[a] >> (bits - 4) << shift; /* close together, some equal */
                if (i == 7) c[a] = 0;
                if (i == 8) c[a] = (uint64_t)last_cell(dim);
                place[a][i] = (double)c[a];
            }
            key[i] = hilbert(dim, bits, c);
        }
        const struct points points = points_of(dim, n);
        struct neighbours *nb = made(&points);
        for (size_t s = 0; s + 1 < n; s++) {
            const uint32_t i = nb->order[s], j = nb->order[s + 1];
            assert_true(key[i] < key[j] || (key[i] == key[j] && i < j));
        }
        for (size_t s = 0; s < nb->blocks * BLOCK; s++)
            for (int a = 0; a < dim; a++)
                assert_true(nb->x[a][s] == (s < n ? place[a][nb->order[s]] : HUGE_VAL));
        neighbours_destroy(nb);
    }
}

/* A cube of 2^k cells each way, anywhere in the box and of cells of any size, is passed through
 * without a pause, each step to the next cell. */
TEST(test_curve)
{
    for (int trial = 0; trial < 60; trial++) {
        const int dim = 2 + trial % 2, k = dim == 2 ? 4 : 3, bits = bits_of[dim];
        const int level = (int)(draw_bits() % (uint64_t)(bits - k + 1));
        const size_t side = (size_t)1 << k, n = (size_t)1 << k * dim;
        double corner[3];
        for (int a = 0; a < dim; a++)
            corner[a] = ldexp((double)(draw_bits() >> (53 - bits + level + k)), level + k);
        for (size_t i = 0; i < n; i++)
            for (int a = 0; a < dim; a++) {
                const size_t c = i >> a * k & (side - 1);
                place[a][i] = corner[a] + ldexp((double)c, level);
            }
        for (int a = 0; a < dim; a++) place[a][n] = 0, place[a][n + 1] = last_cell(dim);
        const struct points points = points_of(dim, n + 2);
        struct neighbours *nb = made(&points);
        size_t met = 0, last = 0;
        for (size_t at = 0; at < n + 2; at++) {
            double moved = 0;
            bool inside = true;
            for (int a = 0; a < dim; a++) {
                moved += fabs(nb->x[a][at] - nb->x[a][last]);
                inside = inside && nb->x[a][at] >= corner[a] &&
                         nb->x[a][at] < corner[a] + ldexp((double)side, level);
            }
            if (nb->order[at] < n) {
                if (met++ > 0) assert_true(moved == ldexp(1, level));
                last = at;
            } else {
                assert_true(met == 0 || met == n || inside);
            }
        }
        assert_int_equal(met, n);
        neighbours_destroy(nb);
    }
}

/* Points that are moved and stretched, and some that coincide, are in the same order. */
TEST(test_order_is_of_shape)
{
    for (int trial = 0; trial < 30; trial++) {
        const int dim = 1 + trial % 3;
        const size_t n = 200;
        uint32_t order[200];
        for (size_t i = 0; i < n; i++)
            for (int a = 0; a < dim; a++) place[a][i] = (double)(draw_bits() % 1024);
        const struct points points = points_of(dim, n);
        struct neighbours *nb = made(&points);
        memcpy(order, nb->order, sizeof order);
        neighbours_destroy(nb);
        const double by = trial % 2 ? -512 : 4096;
        for (size_t i = 0; i < n; i++)
            for (int a = 0; a < dim; a++)
                place[a][i] = (place[a][i] + by) * ldexp(1, 5 * trial - 70);
        nb = made(&points);
        assert_memory_equal(order, nb->order, sizeof order);
        neighbours_destroy(nb);
    }
}

/* Clouds too narrow for cells whose size is a number keep the order in which they came. */
TEST(test_narrowest)
{
    static const struct {
        double factor;
        bool sorted;
    } limits[] = {{0.5, false}, {1 - 1e-7, false}, {1, true}, {1 + 1e-7, true}, {5, true}};
    for (int dim = 1; dim <= 3; dim++)
        for (size_t k = 0; k < sizeof limits / sizeof *limits; k++) {
            const double extent = ldexp(1 / 1e300 * limits[k].factor, bits_of[dim]);
            for (int a = 0; a < dim; a++)
                place[a][0] = extent, place[a][1] = extent / 2, place[a][2] = 0;
            const struct points points = points_of(dim, 3);
            struct neighbours *nb = made(&points);
            for (uint32_t s = 0; s < 3; s++)
                assert_int_equal(nb->order[s], limits[k].sorted ? 2 - s : s);
            neighbours_destroy(nb);
        }
    for (int a = 0; a < 3; a++) place[a][0] = place[a][1] = 3;
    struct points points = points_of(3, 2);
    struct neighbours *nb = made(&points);
    assert_true(nb->order[0] == 0 && nb->order[1] == 1);
    neighbours_destroy(nb);
    /* and as wide as numbers reach */
    for (int a = 0; a < 2; a++) place[a][0] = 1e308, place[a][1] = -1e308, place[a][2] = 0;
    points = points_of(2, 3);
    nb = made(&points);
    for (uint32_t s = 0; s < 3; s++) assert_int_equal(nb->order[s], s);
    neighbours_destroy(nb);
}

/* Into lo <= x < hi, also where round-off ends at hi. */
TEST(test_wrapped)
{
    static const double at[] = {-1.5, -1, -0.75, 0, 0.4, 0.5, 1.25, 2, -0x1p-60, 7.75};
    static const double into[] = {-1.5, 0.5 - 1.5, -0.75, -1.5, -1.1, -1, -0.25, -1, -1.5, -1.25};
    const size_t n = sizeof at / sizeof *at;
    for (int dim = 1; dim <= 3; dim++) {
        struct points points = points_of(dim, n);
        points.periodic = true;
        for (int a = 0; a < dim; a++) {
            points.lo[a] = -1.5 + a, points.hi[a] = 0.0 + a;
            for (size_t i = 0; i < n; i++) place[a][i] = at[i] + a;
        }
        struct neighbours *nb = made(&points);
        assert_true(nb->periodic);
        for (size_t s = 0; s < n; s++)
            for (int a = 0; a < dim; a++) {
                assert_true(nb->x[a][s] >= points.lo[a] && nb->x[a][s] < points.hi[a]);
                near_absolute(nb->x[a][s], into[nb->order[s]] + a, 1e-15);
            }
        for (int a = 0; a < dim; a++) assert_true(nb->length[a] == 1.5);
        neighbours_destroy(nb);
    }
}

static void cloud_of(struct points *points, int dim, size_t n, bool periodic)
{
    *points = points_of(dim, n);
    points->periodic = periodic;
    for (int a = 0; a < dim; a++) {
        points->lo[a] = draw(-2, 2);
        points->hi[a] = points->lo[a] + draw(0.5, 2);
        for (size_t i = 0; i < n; i++) place[a][i] = draw(points->lo[a], points->hi[a]);
    }
}

/* Every level's boxes are the smallest around what they enclose; those that enclose nothing are
 * empty. */
TEST(test_boxes)
{
    static const size_t numbers[] = {0, 1, 7, 8, 9, 63, 64, 65, 511, 512, 513, 4096, 4097, 5000};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        for (int dim = 1; dim <= 3; dim++) {
            struct points points;
            cloud_of(&points, dim, numbers[k], k % 2);
            struct neighbours *nb = made(&points);
            assert_int_equal(nb->n, points.n);
            assert_int_equal(nb->dim, dim);
            assert_int_equal(nb->blocks, (points.n + 7) / 8);
            size_t count = nb->blocks, size = 8;
            int levels = 0;
            for (; count > 0; levels++, size *= 8, count = count == 1 ? 0 : (count + 7) / 8) {
                assert_int_equal(nb->count[levels], count);
                assert_int_equal(nb->stride[levels], (count + 7) / 8 * 8);
                for (size_t b = 0; b < nb->stride[levels]; b++)
                    for (int a = 0; a < dim; a++) {
                        double lo = HUGE_VAL, hi = -HUGE_VAL;
                        for (size_t s = b * size; s < points.n && s < (b + 1) * size; s++)
                            lo = fmin(lo, nb->x[a][s]), hi = fmax(hi, nb->x[a][s]);
                        assert_true(nb->lo[levels][(size_t)a * nb->stride[levels] + b] == lo);
                        assert_true(nb->hi[levels][(size_t)a * nb->stride[levels] + b] == hi);
                    }
            }
            assert_int_equal(nb->levels, levels);
            neighbours_destroy(nb);
        }
}

static double gap2(const struct neighbours *nb, size_t block, size_t other, const double *shift)
{
    double sum = 0;
    for (int a = 0; a < nb->dim; a++) {
        const double *lo = nb->lo[0] + (size_t)a * nb->stride[0],
                     *hi = nb->hi[0] + (size_t)a * nb->stride[0];
        const double gap =
            fmax(lo[other] - (hi[block] - shift[a]), (lo[block] - shift[a]) - hi[other]);
        if (gap > 0) sum += gap * gap;
    }
    return sum;
}

/* The candidates of a block: those and no others whose boxes come within the radius, image by
 * image, along the curve. Returns how many blocks were compared. */
static size_t compare(const struct neighbours *nb, size_t block, double radius,
                      struct candidates *c)
{
    struct error error;
    if (neighbours_gather(nb, block, radius, c, &error)) fail_msg("%s", error.message);
    size_t at = 0, compared = 0;
    const int most[3] = {nb->periodic ? 9 : 0, nb->periodic && nb->dim > 1 ? 9 : 0,
                         nb->periodic && nb->dim > 2 ? 9 : 0};
    for (int i = -most[0]; i <= most[0]; i++)
        for (int j = -most[1]; j <= most[1]; j++)
            for (int k = -most[2]; k <= most[2]; k++) {
                const double shift[3] = {i * nb->length[0], j * nb->length[1], k * nb->length[2]};
                for (size_t m = 0; m < nb->stride[0]; m++) {
                    const size_t b = m / BLOCK * BLOCK + (BLOCK - 1 - m % BLOCK);
                    if (b >= nb->blocks) continue;
                    if (gap2(nb, block, b, shift) > radius * radius * (1 + 1e-12)) continue;
                    assert_true(at < c->n / BLOCK);
                    for (int a = 0; a < nb->dim; a++) {
                        const size_t box = (size_t)a * nb->stride[0] + b;
                        assert_true(c->lo[a][at] == nb->lo[0][box] + shift[a]);
                        assert_true(c->hi[a][at] == nb->hi[0][box] + shift[a]);
                        for (size_t l = 0; l < BLOCK; l++)
                            assert_true(c->x[a][at * BLOCK + l] ==
                                        nb->x[a][b * BLOCK + l] + shift[a]);
                    }
                    for (size_t l = 0; l < BLOCK; l++)
                        assert_int_equal(c->j[at * BLOCK + l], b * BLOCK + l);
                    at++;
                    compared++;
                }
            }
    assert_int_equal(c->n, at * BLOCK);
    assert_true(c->capacity >= c->n);
    return compared;
}

TEST(test_candidates)
{
    size_t compared = 0;
    for (int trial = 0; trial < 90; trial++) {
        static const size_t most[] = {0, 2000, 900, 700};
        const int dim = 1 + trial % 3;
        struct points points;
        struct candidates c = {0};
        cloud_of(&points, dim, 1 + draw_bits() % most[dim], trial % 2);
        struct neighbours *nb = made(&points);
        for (int k = 0; k < 4; k++) {
            const double radius = k == 3 ? (dim == 3 ? 0.6 : 1.7) : draw(0, 0.2);
            compared += compare(nb, draw_bits() % nb->blocks, radius, &c);
        }
        neighbours_candidates_free(&c);
        assert_true(!c.n && !c.capacity && !c.j);
        for (int a = 0; a < 3; a++) assert_true(!c.x[a] && !c.lo[a] && !c.hi[a]);
        neighbours_destroy(nb);
    }
    assert_true(compared > 10000);
}

/* Radii to the last digits: a block as far as the radius is in, and one a little further, which
 * round-off may have moved. Radii whose squares are no numbers take everybody, and no fillings. */
TEST(test_radius)
{
    for (size_t i = 0; i < 24; i++) place[0][i] = i < 8 ? -5 : i < 16 ? 0 : 3;
    const struct points points = points_of(1, 24);
    struct neighbours *nb = made(&points);
    struct candidates c = {0};
    static const struct {
        double radius;
        size_t blocks;
    } cases[] = {{3, 2},
                 {3 * (1 - 0.49e-12), 2},
                 {3 * (1 - 0.51e-12), 1},
                 {5, 3},
                 {0, 1},
                 {4.9, 2},
                 {0x1p1023, 3},
                 {1e200, 3}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct error error;
        assert_int_equal(neighbours_gather(nb, 1, cases[k].radius, &c, &error), STATUS_OK);
        assert_int_equal(c.n, cases[k].blocks * BLOCK);
    }
    neighbours_candidates_free(&c);
    neighbours_destroy(nb);
}

/* As many images as a radius needs: whole boxes to the last digit, eight at most. */
TEST(test_images)
{
    struct candidates c = {0};
    for (int dim = 1; dim <= 2; dim++) {
        struct points points;
        cloud_of(&points, dim, 20, true);
        for (int a = 0; a < dim; a++) points.lo[a] = -0.25, points.hi[a] = a ? 0.375 : 0.25;
        for (int a = 0; a < dim; a++)
            for (size_t i = 0; i < 20; i++) place[a][i] = draw(points.lo[a], points.hi[a]);
        place[0][0] = points.lo[0], place[0][1] = nextafter(points.hi[0], -9);
        struct neighbours *nb = made(&points);
        static const double radii[] = {0.25, 0.49, 0.5, 0.51, 0.99, 1, 1.01, 3.9, 4};
        for (size_t k = 0; k < sizeof radii / sizeof *radii; k++)
            for (size_t b = 0; b < nb->blocks; b++) compare(nb, b, radii[k], &c);
        struct error error;
        assert_int_equal(neighbours_gather(nb, 0, nextafter(4, 5), &c, &error), STATUS_BAD_INPUT);
        assert_string_equal(error.message, "support radius 4 exceeds 8 lengths of the periodic box "
                                           "(0.5 in x)");
        assert_int_equal(neighbours_gather(nb, 0, (double)NAN, &c, &error), STATUS_BAD_INPUT);
        neighbours_destroy(nb);
        points.hi[0] = points.lo[0] + 1;
        nb = made(&points);
        const enum status status = neighbours_gather(nb, 0, 6, &c, &error);
        assert_int_equal(status, dim == 2 ? STATUS_BAD_INPUT : STATUS_OK);
        if (dim == 2)
            assert_string_equal(error.message, "support radius 6 exceeds 8 lengths of the periodic "
                                               "box (0.625 in y)");
        neighbours_destroy(nb);
    }
    neighbours_candidates_free(&c);
}

static void refused(const struct points *points, const char *message)
{
    struct neighbours *nb = (struct neighbours *)(void *)place;
    struct error error;
    assert_int_equal(neighbours_create(points, &nb, &error), STATUS_BAD_INPUT);
    assert_null(nb);
    assert_string_equal(error.message, message);
}

TEST(test_refused)
{
    struct points points;
    cloud_of(&points, 3, 9, false);
    place[2][8] = HUGE_VAL;
    refused(&points, "point 8: z = inf is not finite");
    place[1][0] = (double)NAN;
    refused(&points, "point 0: y = nan is not finite");
    points.dim = 1;
    struct neighbours *nb = made(&points);
    neighbours_destroy(nb);
    place[0][0] = -HUGE_VAL;
    refused(&points, "point 0: x = -inf is not finite");
    points.n = (size_t)1 << 31; /* as many as are allowed: it is the first one that is refused */
    refused(&points, "point 0: x = -inf is not finite");
    points.n++;
    refused(&points, "2147483649 points: at most 2^31 are allowed");
    cloud_of(&points, 2, 9, true);
    static const double ends[][2] = {{1, 1},        {1, 0.5},         {0, 1.5e300},
                                     {-1.5e300, 0}, {0, (double)NAN}, {(double)NAN, 0}};
    static const char *const messages[] = {"periodic box from 1 to 1 in y is empty",
                                           "periodic box from 1 to 0.5 in y is empty",
                                           "periodic box from 0 to 1.5e+300 in y is empty",
                                           "periodic box from -1.5e+300 to 0 in y is empty",
                                           "periodic box from 0 to nan in y is empty",
                                           "periodic box from nan to 0 in y is empty"};
    for (size_t k = 0; k < sizeof ends / sizeof *ends; k++) {
        points.lo[1] = ends[k][0], points.hi[1] = ends[k][1];
        refused(&points, messages[k]);
        points.periodic = false;
        neighbours_destroy(made(&points));
        points.periodic = true;
    }
    points.lo[1] = -1e300, points.hi[1] = 1e300; /* wide, and allowed */
    neighbours_destroy(made(&points));
    points.hi[1] = 1e300 * (1 + 1e-7);
    refused(&points, "periodic box from -1e+300 to 1e+300 in y is empty");
    points.lo[1] = -1e300 * (1 + 1e-7), points.hi[1] = 1e300;
    refused(&points, "periodic box from -1e+300 to 1e+300 in y is empty");
    neighbours_destroy(NULL);
}
