/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares smoothing lengths of clouds with a second implementation of the search for their roots,
 * to the last digits: with coarse tolerances the result depends on where the search starts and how
 * its reach grows. Also tests the messages about clouds without a root. */
#include "test.h"

#include <float.h>

#include "draw.h"
#include "summation.h"
#include "width.h"

enum { N = 300, BLOCK = NEIGHBOURS_BLOCK };

static double x[3][N], m[N], h[N], rho[N];
static struct kernel kernel;

static struct summation cloud_of(int dim, size_t n, bool periodic, double eta, double tolerance)
{
    struct summation sum = {
        {dim, n, {x[0], x[1], x[2]}, periodic, {0}, {0}}, &kernel, m, eta, tolerance, 1};
    for (int a = 0; a < dim; a++) sum.points.hi[a] = 1 + 0.25 * a;
    for (size_t i = 0; i < n; i++) {
        for (int a = 0; a < dim; a++) x[a][i] = draw(0, sum.points.hi[a]);
        m[i] = draw(0.7, 1);
    }
    return sum;
}

/* The first reach of a block: the width that its eight points would have if they were evenly spread
 * in their bounding box; if they coincide, if all points were evenly spread in theirs or in the
 * periodic box. */
static double first_reach(const struct summation *sum, const struct neighbours *nb, size_t block)
{
    const int dim = sum->points.dim;
    double side = 0, whole = 0;
    for (int a = 0; a < dim; a++) {
        double lo[2] = {HUGE_VAL, HUGE_VAL}, hi[2] = {-HUGE_VAL, -HUGE_VAL};
        for (size_t s = 0; s < nb->n; s++)
            for (int k = s / BLOCK == block ? 0 : 1; k < 2; k++)
                lo[k] = fmin(lo[k], nb->x[a][s]), hi[k] = fmax(hi[k], nb->x[a][s]);
        side = fmax(side, hi[0] - lo[0]);
        whole = fmax(whole, hi[1] - lo[1]);
    }
    if (!(whole > 0) && sum->points.periodic) whole = sum->points.hi[0];
    const double spacing =
        side > 0 ? side / (pow(8, 1. / dim) - 0.5) : whole * pow((double)sum->points.n, -1. / dim);
    return 1.3 * sum->eta * spacing;
}

/* Sums at this width over all points and images within reach. */
static struct density_sums sums_at(const struct summation *sum, size_t i, double reach,
                                   double width)
{
    const int dim = sum->points.dim;
    long double of_m = 0, slope = 0;
    int images[3] = {0};
    for (int a = 0; sum->points.periodic && a < dim; a++)
        images[a] = (int)ceil(reach / sum->points.hi[a]) + 1;
    for (size_t j = 0; j < sum->points.n; j++)
        for (int p = -images[0]; p <= images[0]; p++)
            for (int q = -images[1]; q <= images[1]; q++)
                for (int r = -images[2]; r <= images[2]; r++) {
                    const int shift[3] = {p, q, r};
                    double r2 = 0;
                    for (int a = 0; a < dim; a++) {
                        const double d = x[a][j] + shift[a] * sum->points.hi[a] - x[a][i];
                        r2 += d * d;
                    }
                    if (!(r2 < reach * reach)) continue;
                    const double at = sqrt(r2) / width;
                    const long double w = (long double)kernel.w(&kernel, at, dim),
                                      dw = (long double)kernel.dw(&kernel, at, dim),
                                      mass = (long double)m[j];
                    of_m += mass * w;
                    slope += mass * ((long double)dim * w + (long double)at * dw);
                }
    return (struct density_sums){.m = {(double)of_m}, .m_dh = {(double)slope}};
}

/* The width of point i, where the search of its block begins at this reach. Returns how often the
 * reach had to grow. */
static int width_from(const struct summation *sum, size_t i, double reach, double *width)
{
    const int dim = sum->points.dim;
    const struct width_rule rule = {dim, sum->eta, kernel.constant[dim], sum->tolerance};
    int grown = 0;
    for (; sums_at(sum, i, reach, reach).m[0] < m[i] * pow(sum->eta, dim) / kernel.constant[dim];
         grown++)
        reach *= grown < 7 ? 1.5 : 4; /* the first seven times */
    struct width_bracket bracket;
    struct density_sums sums;
    double inverse = 1 / (0.7 * reach);
    *width = 0.7 * reach;
    width_begin(&bracket, 1, reach);
    do sums = sums_at(sum, i, reach, *width);
    while (width_step(&rule, 1, &m[i], &sums, &bracket, width, &inverse));
    return grown;
}

/* Returns the largest number of times that a reach had to grow. */
static int check(const struct summation *sum)
{
    struct neighbours *nb;
    struct error error;
    int most = 0;
    if (summation_solve(sum, h, rho, &error)) fail_msg("%s", error.message);
    assert_int_equal(neighbours_create(&sum->points, &nb, &error), STATUS_OK);
    for (size_t s = 0; s < nb->n; s++) {
        const size_t i = nb->order[s];
        double width;
        const int grown = width_from(sum, i, first_reach(sum, nb, s / BLOCK), &width);
        near_relative(h[i], width, 1e-11);
        near_relative(rho[i], m[i] * pow(sum->eta / width, sum->points.dim), 1e-10);
        most = grown > most ? grown : most;
    }
    neighbours_destroy(nb);
    return most;
}

static const double tolerances[] = {1e-12, 0.03, 0.4};

TEST(random_clouds)
{
    int grown = 0;
    for (int dim = 1; dim <= 3; dim++)
        for (int periodic = 0; periodic < 2; periodic++)
            for (int t = 0; t < 3; t++) {
                const struct summation sum =
                    cloud_of(dim, dim == 1 ? 90 : 130, periodic, 1.8, tolerances[t]);
                grown += check(&sum);
            }
    assert_true(grown > 0);
}

/* A cloud stretched along each axis in turn, so that this axis alone sets the distances. */
TEST(stretched_clouds)
{
    for (int dim = 2; dim <= 3; dim++)
        for (int along = 0; along < dim; along++)
            for (int t = 0; t < 3; t++) {
                const struct summation sum = cloud_of(dim, 80, false, 1.8, tolerances[t]);
                for (size_t i = 0; i < 80; i++)
                    for (int a = 0; a < dim; a++) x[a][i] *= a == along ? 1 : 1e-3;
                check(&sum);
            }
}

/* Eight or more points at one position or close together, and the others far away; all at one
 * position of a periodic box. */
TEST(coincident_points)
{
    int most = 0;
    for (int dim = 1; dim <= 3; dim++)
        for (int t = 0; t < 3; t++) {
            const double eta = dim == 1 ? 30 : dim == 2 ? 8 : 5;
            struct summation sum = cloud_of(dim, 160, false, eta, tolerances[t]);
            for (size_t i = 0; i < 17; i++)
                for (int a = 0; a < dim; a++) x[a][i] = -3;
            check(&sum);
            for (size_t i = 0; i < 17; i++)
                for (int a = 0; a < dim; a++) x[a][i] = -3 + 1e-4 * draw(0, 1);
            const int grown = check(&sum);
            most = grown > most ? grown : most;
            sum = cloud_of(dim, 9, true, dim == 1 ? 14 : dim == 2 ? 6 : 4, tolerances[t]);
            for (size_t i = 0; i < 9; i++)
                for (int a = 0; a < dim; a++) x[a][i] = 0.5;
            check(&sum);
        }
    assert_true(most > 10);
}

static void refused(const struct summation *sum, enum status status, const char *message)
{
    struct error error;
    assert_int_equal(summation_solve(sum, h, rho, &error), status);
    assert_string_equal(error.message, message);
    assert_int_equal(summation_solve(sum, h, rho, NULL), status);
}

TEST(refusals)
{
    char text[200];
    for (int dim = 1; dim <= 3; dim++) {
        const double least = kernel_least_eta(&kernel, dim);
        struct summation sum = cloud_of(dim, 20, false, least, 1e-10);
        snprintf(text, sizeof text,
                 "eta = %g; with kernel wendland_c2 in %dD it must be above %.6g", least, dim,
                 least);
        refused(&sum, STATUS_BAD_INPUT, text);
        sum.eta = HUGE_VAL;
        snprintf(text, sizeof text,
                 "eta = inf; with kernel wendland_c2 in %dD it must be above %.6g", dim, least);
        refused(&sum, STATUS_BAD_INPUT, text);
        sum.eta = 1.5;
        m[19] = 0;
        refused(&sum, STATUS_BAD_INPUT, "point 19: mass 0; it must be positive");
        m[0] = HUGE_VAL;
        refused(&sum, STATUS_BAD_INPUT, "point 0: mass inf; it must be positive");
        /* just enough mass, and a little less */
        for (size_t i = 0; i < 20; i++) m[i] = 1;
        m[7] = 2;
        sum.eta = least * pow(21 / 2., 1. / dim) * (1 + 1e-7);
        snprintf(text, sizeof text,
                 "point 7: no smoothing length: the cloud's mass is 21, eta = %g needs more than "
                 "%g",
                 sum.eta, 2 * pow(sum.eta / least, dim));
        refused(&sum, STATUS_BROKE_DOWN, text);
        sum.eta *= 1 - 2e-7;
        assert_int_equal(summation_solve(&sum, h, rho, NULL), STATUS_OK);
        if (dim == 1) { /* a mass equal to the least is not enough */
            const double two[] = {1, 1};
            struct summation pair = sum;
            pair.points.n = 2, pair.m = two, pair.eta = 2 * least;
            snprintf(
                text, sizeof text,
                "point 0: no smoothing length: the cloud's mass is 2, eta = %g needs more than "
                "2",
                pair.eta);
            refused(&pair, STATUS_BROKE_DOWN, text);
        }
        /* too many points at one position, and then all points */
        m[7] = 1;
        sum.eta = least * pow(3, 1. / dim) * (1 - 1e-9);
        for (size_t i = 4; i < 7; i++)
            for (int a = 0; a < dim; a++) x[a][i] = 3;
        struct error error;
        assert_int_equal(summation_solve(&sum, h, rho, &error), STATUS_BROKE_DOWN);
        assert_non_null(strstr(error.message, "no smoothing length: it coincides with others (mass "
                                              "3 there, own 1)"));
        sum.eta *= 1 + 2e-9;
        assert_int_equal(summation_solve(&sum, h, rho, NULL), STATUS_OK);
        sum.eta = least * 1.1;
        for (size_t i = 0; i < 20; i++)
            for (int a = 0; a < dim; a++) x[a][i] = 3;
        assert_int_equal(summation_solve(&sum, h, rho, &error), STATUS_BROKE_DOWN);
        assert_non_null(strstr(error.message, "(mass 20 there, own 1)"));
    }
}

/* Masses near the smallest normal number are summed like others. */
TEST(tiny_masses)
{
    for (int dim = 1; dim <= 3; dim++) {
        struct summation sum = cloud_of(dim, 40, false, 1.8, 1e-12);
        double all = 0, heaviest = 0;
        for (size_t i = 0; i < 40; i++) {
            m[i] *= 1e-12;
            all += m[i], heaviest = fmax(heaviest, m[i]);
        }
        check(&sum);
        const double least = kernel_least_eta(&kernel, dim);
        sum.eta = least * pow(all / heaviest, 1. / dim) * (1 + 1e-7);
        struct error error;
        assert_int_equal(summation_solve(&sum, h, rho, &error), STATUS_BROKE_DOWN);
        assert_non_null(strstr(error.message, "no smoothing length: the cloud's mass is"));
    }
}

/* A cloud without points is solved. */
TEST(cloud_without_points)
{
    for (int periodic = 0; periodic < 2; periodic++) {
        const struct summation sum = cloud_of(2, 0, periodic, 2, 1e-10);
        h[0] = rho[0] = 5;
        assert_int_equal(summation_solve(&sum, h, rho, NULL), STATUS_OK);
        assert_true(h[0] == 5 && rho[0] == 5);
    }
}

/* In extreme units widths and densities are the same as long as they are normal numbers. */
TEST(other_units)
{
    static const int lengths[] = {-600, -129, 0, 129, 600}, weights[] = {-900, 0, 900};
    static double plain_h[N], plain_rho[N], plain_x[3][N], plain_m[N];
    size_t lost = 0, kept = 0;
    for (int dim = 1; dim <= 3; dim++)
        for (int periodic = 0; periodic < 2; periodic++) {
            struct summation sum = cloud_of(dim, 60, periodic, 1.8, 1e-12);
            const struct points points = sum.points;
            assert_int_equal(summation_solve(&sum, plain_h, plain_rho, NULL), STATUS_OK);
            memcpy(plain_x, x, sizeof x);
            memcpy(plain_m, m, sizeof m);
            for (int l = 0; l < 5; l++)
                for (int w = 0; w < 3; w++) {
                    bool normal = true;
                    struct error error;
                    for (int a = 0; a < dim; a++)
                        sum.points.hi[a] = ldexp(points.hi[a], lengths[l]);
                    for (size_t i = 0; i < 60; i++) {
                        for (int a = 0; a < dim; a++) x[a][i] = ldexp(plain_x[a][i], lengths[l]);
                        m[i] = ldexp(plain_m[i], weights[w]);
                        const double density = ldexp(plain_rho[i], weights[w] - dim * lengths[l]);
                        normal = normal && density >= DBL_MIN && density <= DBL_MAX;
                    }
                    const enum status status = summation_solve(&sum, h, rho, &error);
                    assert_int_equal(status, normal ? STATUS_OK : STATUS_BROKE_DOWN);
                    if (!normal)
                        assert_non_null(
                            strstr(error.message,
                                   "beyond the range of double precision; other units help"));
                    for (size_t i = 0; normal && i < 60; i++) {
                        near_relative(h[i], ldexp(plain_h[i], lengths[l]), 1e-14);
                        near_relative(rho[i], ldexp(plain_rho[i], weights[w] - dim * lengths[l]),
                                      1e-13);
                    }
                    kept += normal, lost += !normal;
                }
        }
    assert_true(lost > 10 && kept > 10);
}

static int select_kernel(void **state)
{
    (void)state;
    return kernel_select(&kernel, "wendland_c2", 5, NULL) != STATUS_OK;
}

TEST_BETWEEN(select_kernel, NULL);
