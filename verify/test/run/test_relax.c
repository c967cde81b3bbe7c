/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares glasses with a second implementation, and tests that large ones are stored. */
#include "test.h"

#include "gas.h"
#include "initial.h"
#include "own_folder.h"
#include "regularity.h"
#include "relax.h"

static size_t times_asked;

struct volumes {
    int dim;
    double all;
    size_t n;
};

static double volume_at(const void *context, const double x[3])
{
    const struct volumes *volumes = context;
    times_asked++;
    return volumes->all / (double)volumes->n * (1 + 0.2 * sin(2 * M_PI * (x[0] + x[1])));
}

/* Sixty sweeps over all pairs of images. */
static void relax_directly(const struct relax_region *region, size_t n, double *const x[3])
{
    const int dim = region->box.dim;
    double *width = malloc(4 * n * sizeof *width), *to = width + n, step = 0.06;
    for (int sweep = 0; sweep < 60; sweep++, step *= 0.95) {
        for (size_t i = 0; i < n; i++) {
            const double at[3] = {x[0][i], x[1][i], dim > 2 ? x[2][i] : 0};
            width[i] = 2.5 * pow(region->volume(region->context, at), 1. / dim);
        }
        for (size_t i = 0; i < 3 * n; i++) to[i] = 0;
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < i; j++) {
                const double reach = 0.5 * (width[i] + width[j]);
                double delta[3], square = 0;
                for (int d = 0; d < dim; d++) {
                    const double side = region->box.hi[d] - region->box.lo[d];
                    delta[d] = x[d][i] - x[d][j];
                    if (delta[d] > side / 2) delta[d] -= side;
                    if (delta[d] < -side / 2) delta[d] += side;
                    square += delta[d] * delta[d];
                }
                if (square == 0 || square >= reach * reach) continue;
                const double r = sqrt(square);
                for (int d = 0; d < dim; d++) {
                    const double push =
                        (1 / pow(r / reach + 0.1, 2) - 1 / pow(1.1, 2)) * delta[d] / r;
                    to[3 * i + (size_t)d] += push;
                    to[3 * j + (size_t)d] -= push;
                }
            }
        for (size_t i = 0; i < n; i++) {
            const double *push = to + 3 * i;
            const double size = sqrt(push[0] * push[0] + push[1] * push[1] + push[2] * push[2]);
            const double part = width[i] / 2.5 * (step * size < 0.3 ? step : 0.3 / size);
            for (int d = 0; d < dim; d++) {
                const double side = region->box.hi[d] - region->box.lo[d];
                x[d][i] += part * push[d];
                x[d][i] -= side * floor((x[d][i] - region->box.lo[d]) / side);
            }
        }
    }
    free(width);
}

TEST(glasses_are_pushed_apart)
{
    for (int dim = 2; dim <= 3; dim++) {
        enum { MOST = 250 };
        const size_t n = dim == 2 ? 100 : 250;
        struct volumes volumes = {dim, dim == 2 ? 1.2 : 1.32, n};
        const struct relax_region region = {
            {dim, {-0.3, 2.1, 0.2}, {0.7, 3.3, 1.3}}, volume_at, &volumes};
        double x[3][MOST], y[3][MOST];
        double *const moved[] = {x[0], x[1], x[2]}, *const direct[] = {y[0], y[1], y[2]};
        struct error error = {0};
        for (size_t i = 0; i < n; i++)
            for (int d = 0; d < 3; d++)
                x[d][i] = y[d][i] =
                    region.box.lo[d] +
                    (region.box.hi[d] - region.box.lo[d]) *
                        fmod((0.7548776662 + 0.0629 * d * d) * (double)(i + 1) + 0.1 * d, 1);
        /* two that nearly coincide are pushed by the largest step; two that coincide are not
         * pushed */
        for (int d = 0; d < 3; d++) {
            x[d][1] = y[d][1] = x[d][0] + 1e-5 * (d + 1);
            x[d][3] = y[d][3] = x[d][2];
        }
        if (relax_points(&region, n, moved, &error)) fail_msg("%s", error.message);
        relax_directly(&region, n, direct);
        for (size_t i = 0; i < n; i++)
            for (int d = 0; d < 3; d++) {
                near_absolute(x[d][i] + 9, y[d][i] + 9, 1e-9);
                if (d < dim) assert_true(x[d][i] >= region.box.lo[d] && x[d][i] < region.box.hi[d]);
            }
        volumes.n = 4;
        assert_int_equal(relax_points(&region, 4, moved, &error), STATUS_BAD_INPUT);
        assert_non_null(strstr(error.message, "n=4: a glass needs more particles"));
    }
}

/* The quality is the regularity of a cloud with this width. */
TEST(quality_of_a_cloud)
{
    enum { N = 500 };
    const struct domain box = {3, {0, 1, 2}, {1, 2, 3}};
    static double x[3][N], volume[N], h[N];
    struct kernel kernel;
    struct regularity found;
    struct regularity quality;
    struct error error = {0};
    for (int i = 0; i < N; i++) {
        for (int d = 0; d < 3; d++)
            x[d][i] = d + fmod((0.6180339887 + 0.0629 * d * d) * (i + 1), 1);
        volume[i] = (1 + 0.0001 * i) / N;
        h[i] = 3.6 * cbrt(volume[i]);
    }
    const struct regularity_cloud cloud = {.box = box,
                                           .periodic = {true, true, true},
                                           .n = N,
                                           .x = {x[0], x[1], x[2]},
                                           .volume = volume,
                                           .h = h,
                                           .kernel = &kernel};
    const double *const places[] = {x[0], x[1], x[2]};
    assert_int_equal(kernel_select(&kernel, "wendland_c4", 0, &error), STATUS_OK);
    assert_int_equal(regularity_measure(&cloud, &found, &error), STATUS_OK);
    assert_int_equal(relax_measure(&box, N, places, volume, &quality, &error), STATUS_OK);
    near_relative(quality.density, found.density, 1e-12);
    near_relative(quality.gradient, found.gradient, 1e-12);
    near_relative(quality.spread, found.spread, 1e-12);
    volume[0] = 1; /* reaches beyond half of the box */
    assert_int_equal(relax_measure(&box, 3, places, volume, &quality, &error), STATUS_BAD_INPUT);
}

/* A glass: random points that are pushed apart according to the volume of each; with equal masses
 * the volume follows from the density. */
static double volume_of_mass(const void *context, const double x[3])
{
    return *(const double *)context / gas_density(x);
}

static double volume_of_all(const void *context, const double x[3])
{
    (void)x;
    return *(const double *)context;
}

TEST(glasses_of_random_points)
{
    enum { N = 300 };
    for (int equal = 0; equal < 2; equal++) {
        const struct prepared p = {.problem = &gas_problem, .domain = {2, {-1, 0}, {1, 2}}};
        const struct settings random = keyed_settings(
            equal ? "n=300 lattice=random equal_masses=yes" : "n=300 lattice=random");
        const struct settings glass =
            keyed_settings(equal ? "n=300 lattice=glass equal_masses=yes" : "n=300 lattice=glass");
        struct initial one, two;
        struct error error = {0};
        assert_int_equal(initial_fill(&p, &random, &one, &error), STATUS_OK);
        assert_int_equal(initial_fill(&p, &glass, &two, &error), STATUS_OK);
        const double mass = one.m[0], share = 4. / N;
        const struct relax_region region = {p.domain, equal ? volume_of_mass : volume_of_all,
                                            equal ? &mass : &share};
        assert_int_equal(relax_points(&region, N, one.x, &error), STATUS_OK);
        for (int i = 0; i < N; i++) {
            const double x[3] = {two.x[0][i], two.x[1][i]};
            near_absolute(one.x[0][i] + 9, x[0] + 9, 1e-11);
            near_absolute(one.x[1][i] + 9, x[1] + 9, 1e-11);
            near_relative(two.m[i], equal ? mass : gas_density(x) * share, 1e-14);
            near_relative(two.rho[i], gas_density(x), 1e-14);
        }
        initial_free(&one);
        initial_free(&two);
    }
}

/* A uniform volume, or one that rises from x = 0 or y = 0. */
struct plain_volume {
    double volume, rise;
};

static double plain_volume_at(const void *context, const double x[3])
{
    const struct plain_volume *region = context;
    times_asked++;
    return region->volume * (1 + region->rise * x[0] * x[1]);
}

/* Large glasses are stored, and read again if everything that determines their points is equal. */
TEST(large_glasses_are_kept)
{
    enum { N = 1000 };
    static double x[3][N];
    setenv("XDG_CACHE_HOME", whole_path_of("kept"), 1);
    double *const places[] = {x[0], x[1], x[2]};
    static double kept[2][N];
    static const struct {
        double lo, hi, first, last, volume, rise;
        bool read;
    } rows[] = {
        {0, 1, 0, 0, 1e-3, 0, false},    {0, 1, 0, 0, 1e-3, 0, true},
        {-0.5, 1, 0, 0, 1e-3, 0, false}, {0, 1.5, 0, 0, 1e-3, 0, false},
        {0, 1, 1e-9, 0, 1e-3, 0, false}, {0, 1, 0, 1e-9, 1e-3, 0, false},
        {0, 1, 0, 0, 1.1e-3, 0, false},  {0, 1, 0, 0, 1e-3, 1e-3, false},
        {0, 1, 0, 0, 1e-3, 0, true},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct plain_volume plain_volume = {rows[k].volume, rows[k].rise};
        const struct relax_region region = {
            {2, {0, rows[k].lo}, {1, rows[k].hi}}, plain_volume_at, &plain_volume};
        struct error error = {0};
        for (int i = 0; i < N; i++)
            for (int d = 0; d < 2; d++)
                x[d][i] = 0.001 + 0.99 * fmod((0.618034 + 0.0629 * d) * (i + 1), 1);
        x[0][0] += rows[k].first;
        x[1][N - 1] += rows[k].last;
        times_asked = 0;
        assert_int_equal(relax_points(&region, N, places, &error), STATUS_OK);
        if ((times_asked == N) != rows[k].read)
            fail_msg("row %zu: asked %zu times", k, times_asked);
        for (int d = 0; d < 2; d++)
            if (k == 0)
                memcpy(kept[d], x[d], sizeof kept[d]);
            else if (rows[k].read)
                assert_memory_equal(kept[d], x[d], sizeof kept[d]);
    }
}
