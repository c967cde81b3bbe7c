/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the messages with which the neighbour search refuses a cloud. */
#include "test.h"

#include "draw.h"
#include "neighbours.h"

enum { POINTS_MAX = 9 };

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

static void refused(const struct points *points, const char *message)
{
    struct neighbours *nb = (struct neighbours *)(void *)place;
    struct error error;
    assert_int_equal(neighbours_create(points, &nb, &error), STATUS_BAD_INPUT);
    assert_null(nb);
    assert_string_equal(error.message, message);
}

TEST(refusals)
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
    points.n = (size_t)1 << 31; /* the largest number allowed: the first point is refused */
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
    points.lo[1] = -1e300, points.hi[1] = 1e300; /* wide, but allowed */
    neighbours_destroy(made(&points));
    points.hi[1] = 1e300 * (1 + 1e-7);
    refused(&points, "periodic box from -1e+300 to 1e+300 in y is empty");
    points.lo[1] = -1e300 * (1 + 1e-7), points.hi[1] = 1e300;
    refused(&points, "periodic box from -1e+300 to 1e+300 in y is empty");
    neighbours_destroy(NULL);
}
