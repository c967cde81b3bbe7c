/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares the regularity of points with its definition over all pairs of images, in 1D to 3D, in
 * periodic and open boxes, and with points exactly at a limit. */
#include "test.h"

#include "kernel.h"
#include "problem.h"
#include "regularity.h"
#include "run_output.h"

static struct kernel kernel_named(const char *name)
{
    struct kernel kernel;
    struct error error = {0};
    assert_int_equal(kernel_select(&kernel, name, 0, &error), STATUS_OK);
    return kernel;
}

/* Computed from the definitions. Two images a side suffice: h is less than half a side. */
static struct regularity directly(const struct regularity_cloud *cloud)
{
    const int dim = cloud->box.dim;
    double *distance = malloc(cloud->n * sizeof *distance), n = (double)cloud->n, widest = 0;
    double whole = 0, density = 0, gradient = 0, mean = 0, squares = 0, paired = 0;
    for (size_t i = 0; i < cloud->n; i++) widest = fmax(widest, cloud->h[i]);
    for (size_t i = 0; i < cloud->n; i++) {
        const double h = cloud->h[i];
        double nearest = widest, sum = 0, to[3] = {0};
        bool inside = true;
        for (int d = 0; d < dim; d++)
            inside = inside && (cloud->periodic[d] || (cloud->x[d][i] - h >= cloud->box.lo[d] &&
                                                       cloud->x[d][i] + h <= cloud->box.hi[d]));
        for (size_t j = 0; j < cloud->n; j++)
            for (int image = 0; image < 27; image++) {
                const int at[3] = {image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1};
                double delta[3] = {0}, square = 0;
                bool there = true;
                for (int d = 0; d < 3; d++)
                    there = there && (at[d] == 0 || (d < dim && cloud->periodic[d]));
                if (!there) continue;
                for (int d = 0; d < dim; d++) {
                    delta[d] = cloud->x[d][i] - cloud->x[d][j] +
                               at[d] * (cloud->box.hi[d] - cloud->box.lo[d]);
                    square += delta[d] * delta[d];
                }
                const double r = sqrt(square);
                if (i != j || image != 13) nearest = fmin(nearest, r);
                if (r >= h) continue;
                sum += cloud->volume[j] * kernel_value(cloud->kernel, r, h, dim);
                for (int d = 0; d < dim && r > 0; d++)
                    to[d] +=
                        cloud->volume[j] * h * kernel_dr(cloud->kernel, r, h, dim) * delta[d] / r;
            }
        distance[i] = nearest / pow(cloud->volume[i], 1. / dim);
        mean += distance[i] / n;
        paired += distance[i] < 0.5 ? 1 / n : 0;
        if (!inside) continue;
        whole++;
        density += (sum - 1) * (sum - 1);
        gradient += to[0] * to[0] + to[1] * to[1] + to[2] * to[2];
    }
    for (size_t i = 0; i < cloud->n; i++) squares += pow(distance[i] - mean, 2) / n;
    free(distance);
    return (struct regularity){mean, sqrt(squares) / mean, paired, sqrt(density / whole),
                               sqrt(gradient / whole)};
}

TEST(agrees_with_its_definition)
{
    enum { N = 90 };
    const struct kernel kernel = kernel_named("wendland_c4");
    static double x[3][N], volume[N], h[N];
    for (int dim = 1; dim <= 3; dim++)
        for (int ends = 0; ends < 4; ends++) {
            struct regularity_cloud cloud = {.box = {dim, {-1, 2, 0.5}, {0.5, 3, 2}},
                                             .n = N,
                                             .x = {x[0], x[1], x[2]},
                                             .volume = volume,
                                             .h = h,
                                             .kernel = &kernel};
            struct error error = {0};
            struct regularity found;
            double whole = 1;
            for (int d = 0; d < dim; d++) {
                cloud.periodic[d] = ends == 3 || ends == d;
                whole *= cloud.box.hi[d] - cloud.box.lo[d];
            }
            for (int i = 0; i < N; i++) {
                for (int d = 0; d < 3; d++)
                    x[d][i] =
                        cloud.box.lo[d] + (cloud.box.hi[d] - cloud.box.lo[d]) *
                                              fmod((0.7548776662 + 0.0629 * d * d) * (i + 1), 1);
                volume[i] = whole / N * (1 + 0.3 * sin(7 * i));
                h[i] = (dim == 1 ? 4 : dim == 2 ? 2.2 : 1.4) * pow(volume[i], 1. / dim);
            }
            /* a pair, two coincident points, and in 1D a point with a wide h */
            for (int d = 0; d < dim; d++) {
                x[d][3] = x[d][2] + 0.001 * (d + 1);
                x[d][41] = x[d][40];
            }
            if (dim == 1) h[50] = 0.7;
            const struct regularity want = directly(&cloud);
            assert_true(want.paired > 0 && want.paired < 1 && want.density > 0 &&
                        want.gradient > 0);
            if (regularity_measure(&cloud, &found, &error)) fail_msg("%s", error.message);
            near_relative(found.nearest, want.nearest, 1e-13);
            near_relative(found.spread, want.spread, 1e-12);
            near_relative(found.paired, want.paired, 1e-13);
            near_relative(found.density, want.density, 1e-12);
            near_relative(found.gradient, want.gradient, 1e-12);
        }
}

/* A row in an open box: points whose support ends exactly at an end are complete; a neighbour half
 * a spacing away is not a pair; a neighbour further away than every h counts as if it were at that
 * distance. */
TEST(points_exactly_at_limits)
{
    const struct kernel kernel = kernel_named("cubic_spline");
    static const double x[] = {0.5, 1, 1.75, 3.5}, volume[] = {1, 1, 1, 1},
                        h[] = {0.5, 1, 0.25, 0.5};
    const struct regularity_cloud cloud = {
        .box = {1, {0}, {4}}, .n = 4, .x = {x}, .volume = volume, .h = h, .kernel = &kernel};
    struct regularity found;
    struct error error;
    assert_int_equal(regularity_measure(&cloud, &found, &error), STATUS_OK);
    near_relative(found.nearest, (0.5 + 0.5 + 0.75 + 1) / 4, 1e-15); /* the widest h is 1 */
    assert_true(found.paired == 0);
    double density = 0, gradient = 0;
    for (int i = 0; i < 4; i++) { /* all are complete; only the second one has neighbours */
        double sum = kernel_value(&kernel, 0, h[i], 1), to = 0;
        if (i == 1) {
            sum += kernel_value(&kernel, 0.5, 1, 1) + kernel_value(&kernel, 0.75, 1, 1);
            to = kernel_dr(&kernel, 0.5, 1, 1) - kernel_dr(&kernel, 0.75, 1, 1);
        }
        density += (sum - 1) * (sum - 1) / 4;
        gradient += to * to / 4;
    }
    near_relative(found.density, sqrt(density), 1e-14);
    near_relative(found.gradient, sqrt(gradient), 1e-14);
    /* in 2D a point whose support ends one bit outside does not count */
    static const double px[] = {1, 1, 3, 3}, py[] = {1, 1.5, 1, 3}, one[] = {1, 1, 1, 1};
    for (int end = 0; end < 5; end++) {
        struct regularity_cloud plane = {.box = {2, {0, 0}, {4, 4}},
                                         .n = 4,
                                         .x = {px, py},
                                         .volume = one,
                                         .h = one,
                                         .kernel = &kernel};
        if (end == 1 || end == 2) plane.box.lo[end - 1] = 1e-15;
        if (end == 3 || end == 4) plane.box.hi[end - 3] = nextafter(4, 0);
        assert_int_equal(regularity_measure(&plane, &found, &error), STATUS_OK);
        /* the number of points that count, of the two half a spacing apart and of the others */
        static const int near[] = {2, 0, 1, 2, 2}, alone[] = {2, 2, 1, 0, 1};
        const double self = kernel_value(&kernel, 0, 1, 2), all = near[end] + alone[end],
                     two = self + kernel_value(&kernel, 0.5, 1, 2);
        near_relative(found.density,
                      sqrt((near[end] * pow(two - 1, 2) + alone[end] * pow(self - 1, 2)) / all),
                      1e-14);
        if (near[end] == 0)
            assert_true(found.gradient == 0);
        else
            near_relative(found.gradient,
                          sqrt(near[end] / all) * fabs(kernel_dr(&kernel, 0.5, 1, 2)), 1e-14);
    }
}

/* More points than are processed at once: a lattice, and some points beside lattice points. */
TEST(blocks_of_points)
{
    enum { SIDE = 256, EXTRA = 64, N = SIDE * SIDE + EXTRA };
    const struct kernel kernel = kernel_named("cubic_spline");
    double *x = malloc(4 * N * sizeof *x), *y = x + N, *volume = y + N, *h = volume + N;
    for (int i = 0; i < N; i++) {
        const int at = i < SIDE * SIDE ? i : 900 * (i - SIDE * SIDE);
        x[i] = at % SIDE + (i < SIDE * SIDE ? 0.5 : 0.625);
        y[i] = at / SIDE + 0.5;
        volume[i] = 1;
        h[i] = 1.25;
    }
    struct regularity_cloud cloud = {.box = {2, {0, 0}, {SIDE, SIDE}},
                                     .periodic = {true, true},
                                     .n = N,
                                     .x = {x, y},
                                     .volume = volume,
                                     .h = h,
                                     .kernel = &kernel};
    struct regularity found, shared;
    struct error error;
    assert_int_equal(regularity_measure(&cloud, &found, &error), STATUS_OK);
    cloud.threads = 3;
    assert_int_equal(regularity_measure(&cloud, &shared, &error), STATUS_OK);
    assert_memory_equal(&found, &shared, sizeof found);
    /* a pair is an eighth apart; the next lattice point is nearer to the other one */
    near_relative(found.paired, 2. * EXTRA / N, 1e-14);
    near_relative(found.nearest, (N - 3. * EXTRA + EXTRA * (2 * 0.125 + 0.875)) / N, 1e-12);
    free(x);
}

/* States of runs use their widths and volumes; an empty state has no regularity. */
TEST(regularity_of_a_run)
{
    const struct kernel kernel = kernel_named("cubic_spline");
    static const double x[] = {0.25, 0.75, 1.75}, volume[] = {0.5, 0.5, 1}, h[] = {0.8, 0.8, 0.5};
    struct snapshot s = {.n = 3, .x = {x}, .volume = volume, .h = h};
    for (int periodic = 0; periodic < 2; periodic++) {
        const struct prepared p = {.domain = {1, {0}, {2}},
                                   .boundary = {periodic ? BOUNDARY_PERIODIC : BOUNDARY_OPEN}};
        const struct regularity_cloud cloud = {.box = p.domain,
                                               .periodic = {periodic},
                                               .n = 3,
                                               .x = {x},
                                               .volume = volume,
                                               .h = h,
                                               .kernel = &kernel};
        const struct regularity found = regularity_of(&p, &kernel, &s, 1), want = directly(&cloud);
        near_relative(found.nearest, want.nearest, 1e-15);
        near_relative(found.spread, want.spread, 1e-14);
        assert_true(found.paired == 0);
        if (periodic) {
            near_relative(found.density, want.density, 1e-14);
            near_relative(found.gradient, want.gradient, 1e-14);
        } else
            assert_true(isnan(found.density) && isnan(found.gradient)); /* no point is complete */
    }
    for (int dim = 2; dim <= 3; dim++) { /* ends along each direction */
        static const double y[] = {0.5, 0.875, 1}, z[] = {1, 0.75, 0.5};
        s.x[1] = y;
        s.x[2] = z;
        for (int d = 0; d < dim; d++) {
            struct prepared p = {.domain = {dim, {0}, {2, 2, 2}},
                                 .boundary = {BOUNDARY_OPEN, BOUNDARY_OPEN, BOUNDARY_OPEN}};
            struct regularity_cloud cloud = {.box = p.domain,
                                             .n = 3,
                                             .x = {x, y, z},
                                             .volume = volume,
                                             .h = h,
                                             .kernel = &kernel};
            p.boundary[d] = BOUNDARY_PERIODIC;
            cloud.periodic[d] = true;
            const struct regularity found = regularity_of(&p, &kernel, &s, 1),
                                    want = directly(&cloud);
            near_relative(found.nearest, want.nearest, 1e-15);
            near_relative(found.spread, want.spread, 1e-14);
        }
    }
    s.n = 0;
    const struct prepared p = {.domain = {1, {0}, {2}}};
    const struct regularity none = regularity_of(&p, &kernel, &s, 1);
    assert_true(isnan(none.nearest) && isnan(none.spread) && isnan(none.paired) &&
                isnan(none.density) && isnan(none.gradient));
    json_t *json = trace_regularity_json(&(struct regularity){1, 2, 3, 4, NAN});
    char *text = json_dumps(json, JSON_COMPACT | JSON_SORT_KEYS);
    assert_string_equal(text,
                        "{\"density\":4.0,\"gradient\":\"nan\",\"nearest\":1.0,\"paired\":3.0,"
                        "\"spread\":2.0}");
    free(text);
    json_decref(json);
}
