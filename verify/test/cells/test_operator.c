/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gradient operators against brute force in long double; specialised against generic, threads, and
 * clouds that invite trouble. */
#include "test.h"

#include <gsl/gsl_linalg.h>
#include <gsl/gsl_rng.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "clouds.h"
#include "matrix.h"
#include "naive.h"
#include "near.h"
#include "summation.h"
#include "worst.h"

enum { FIELDS = 2 };

struct computed {
    double *gradient[FIELDS * 3], *f[FIELDS];
    struct operator_point *point;
    uint64_t pairs;
};

static double *numbers(size_t n)
{
    double *x = calloc(n + 1, sizeof *x);
    assert_non_null(x);
    return x;
}

static void compute(const struct operator_settings *settings, const struct cloud *cloud,
                    struct computed *out)
{
    const size_t n = cloud->points.n, dim = (size_t)cloud->points.dim;
    struct error error = {0};
    for (size_t k = 0; k < FIELDS; k++) out->f[k] = numbers(n);
    for (size_t k = 0; k < FIELDS * 3; k++) out->gradient[k] = numbers(n);
    for (size_t i = 0; i < n; i++) {
        double phase = 0.37;
        for (size_t a = 0; a < dim; a++)
            phase += (2.385 - 0.71 * (double)a) * cloud->points.x[a][i];
        out->f[0][i] = sin(phase) + 3.1415;
        out->f[1][i] = phase * phase - 0.21 * phase;
    }
    assert_non_null(out->point = calloc(n + 1, sizeof *out->point));
    const enum status status =
        operator_apply(settings, cloud, FIELDS, (const double *const *)out->f, out->gradient,
                       out->point, &out->pairs, &error);
    if (status) fail_msg("%s", error.message);
}

static void release(struct computed *c)
{
    for (size_t k = 0; k < FIELDS; k++) free(c->f[k]);
    for (size_t k = 0; k < FIELDS * 3; k++) free(c->gradient[k]);
    free(c->point);
}

static const struct operator_form *operator_at(size_t o)
{
    return (const struct operator_form *)operator_family.members[o];
}

static struct kernel kernel_named(const char *name)
{
    struct kernel kernel;
    assert_int_equal(kernel_select(&kernel, name, 5, NULL), STATUS_OK);
    return kernel;
}

/* Largest difference of the gradients, in units of |f|/h; NaN unless at most of the points they can
 * be compared. */
static double departure(const struct operator_settings *settings, const struct cloud *cloud,
                        const struct computed *c)
{
    double worst = 0;
    size_t compared = 0;
    const int dim = cloud->points.dim;
    for (size_t k = 0; k < FIELDS; k++) {
        double scale = 0;
        for (size_t i = 0; i < cloud->points.n; i++) scale = fmax(scale, fabs(c->f[k][i]));
        for (size_t i = 0; i < cloud->points.n; i++) {
            double exact[3];
            naive_gradient(settings->form, settings->kernel, NAIVE_NONE, cloud, c->f[k], i, exact);
            if (!(c->point[i].condition < 1e8)) continue;
            for (int a = 0; a < dim; a++) {
                const double error =
                    fabs(c->gradient[k * (size_t)dim + (size_t)a][i] - exact[a]) * cloud->h[i];
                worst_keep(&worst, error / scale);
            }
            compared++;
        }
    }
    return 2 * compared > FIELDS * cloud->points.n ? worst : (double)NAN;
}

TEST(test_brute_force)
{
    const size_t sides[] = {0, 97, 13, 6};
    for (int dim = 1; dim <= 3; dim++)
        for (size_t o = 0; o < operator_family.n; o++)
            for (size_t k = 0; k < kernel_family.n; k++) {
                const struct kernel kernel = kernel_named(kernel_family.members[k]->name);
                const struct clouds_settings how = {
                    (enum clouds_kind)((o + k) % CLOUDS_KINDS), dim, sides[dim], 0.3, 2.7, 11 + k};
                struct clouds_cloud cloud;
                struct computed c;
                assert_int_equal(clouds_make(&how, &cloud, NULL), STATUS_OK);
                const struct operator_settings settings = {operator_at(o), &kernel, false, 1};
                compute(&settings, &cloud.cloud, &c);
                near_below(departure(&settings, &cloud.cloud, &c), 1e-11);
                assert_true(c.pairs > cloud.cloud.points.n);
                release(&c);
                clouds_free(&cloud);
            }
}

/* The same bits, whatever the number of threads; the generic loop agrees to round-off. */
TEST(test_same_result)
{
    for (int dim = 1; dim <= 3; dim++)
        for (size_t o = 0; o < operator_family.n; o++) {
            const struct kernel kernel = kernel_named(kernel_family.members[o + 1]->name);
            const struct clouds_settings how = {
                CLOUDS_JITTERED, dim, dim == 1 ? 301 : dim == 2 ? 19 : 7, 0.4, 2.2, 5};
            struct clouds_cloud cloud;
            struct computed one, three, slow;
            assert_int_equal(clouds_make(&how, &cloud, NULL), STATUS_OK);
            struct operator_settings settings = {operator_at(o), &kernel, false, 1};
            compute(&settings, &cloud.cloud, &one);
            settings.threads = 3;
            compute(&settings, &cloud.cloud, &three);
            settings.generic = true;
            compute(&settings, &cloud.cloud, &slow);
            const size_t n = cloud.cloud.points.n;
            for (size_t g = 0; g < FIELDS * (size_t)dim; g++) {
                assert_memory_equal(one.gradient[g], three.gradient[g], n * sizeof(double));
                for (size_t i = 0; i < n; i++)
                    near_below(fabs(one.gradient[g][i] - slow.gradient[g][i]) * cloud.h[i], 1e-12);
            }
            release(&one), release(&three), release(&slow);
            clouds_free(&cloud);
        }
}

/* A periodic lattice looks the same from every point, also where h exceeds the box. */
TEST(test_periodic)
{
    const struct kernel kernel = kernel_named("cubic_spline");
    double x[16], y[16], V[16], h[16];
    for (size_t i = 0; i < 16; i++) {
        const size_t row = i / 4;
        x[i] = (double)(i % 4) * 0.25, y[i] = (double)row * 0.5 - 3;
        V[i] = 0.125, h[i] = 1.3;
    }
    const struct cloud cloud = {{2, 16, {x, y}, true, {0, 0}, {1, 2}}, V, h};
    const struct operator_settings settings = {operator_at(3), &kernel, false, 1};
    struct computed c;
    compute(&settings, &cloud, &c);
    uint32_t expected = 0; /* lattice points of spacing 1/4 x 1/2 within 1.3 */
    for (int i = -9; i <= 9; i++)
        for (int j = -9; j <= 9; j++) expected += hypot(0.25 * i, 0.5 * j) < 1.3;
    for (size_t i = 0; i < 16; i++) {
        assert_int_equal(c.point[i].neighbours, expected);
        near_relative(c.point[i].condition, c.point[0].condition, 1e-12);
    }
    release(&c);
    h[7] = 9;
    struct error error;
    double *none[1] = {NULL};
    assert_int_equal(operator_apply(&settings, &cloud, 0, NULL, none, NULL, NULL, &error),
                     STATUS_BAD_INPUT);
}

/* States at their limits: dim + 1 points including itself, condition number 1e6. */
TEST(test_states)
{
    const struct kernel kernel = kernel_named("quadratic_spline");
    const double V[] = {1, 1, 1, 1, 1}, h[] = {1, 1, 1, 1, 1};
    const struct operator_settings settings = {operator_at(3), &kernel, false, 1};
    for (int dim = 1; dim <= 3; dim++)
        for (size_t n = 1; n <= 5; n++) {
            const double x[] = {0, 0.4, 0, 0, 0.4}, y[] = {0, 0, 0.4, 0, 0.4};
            const double z[] = {0, 0, 0, 0.4, 0.4};
            struct computed c;
            const struct cloud cloud = {{.dim = dim, .n = n, .x = {x, y, z}}, V, h};
            compute(&settings, &cloud, &c);
            assert_int_equal(c.point[0].neighbours, n);
            assert_int_equal(c.point[0].state == OPERATOR_TOO_FEW_NEIGHBOURS, n < (size_t)dim + 1);
            assert_string_equal(operator_state_name(c.point[0].state),
                                n < (size_t)dim + 1 ? "too_few_neighbours" : "ok");
            release(&c);
        }
    for (int above = 0; above < 2; above++) { /* T = diag(1, 1e-6) but for a few per cent */
        const double s = 0.4,
                     root = sqrt(kernel_value(&kernel, s, 1, 2) / kernel_value(&kernel, 0, 1, 2));
        const double t = s * root * (above ? 0.97e-3 : 1.03e-3);
        const double x[] = {0, s, -s, 0, 0}, y[] = {0, 0, 0, t, -t};
        struct computed c;
        const struct cloud cloud = {{.dim = 2, .n = 5, .x = {x, y}}, V, h};
        compute(&settings, &cloud, &c);
        const double ratio = kernel_value(&kernel, s, 1, 2) / kernel_value(&kernel, t, 1, 2);
        near_relative(c.point[0].condition, s * s / (t * t) * ratio, 1e-12);
        assert_int_equal(c.point[0].state, above ? OPERATOR_ILL_CONDITIONED : OPERATOR_OK);
        release(&c);
    }
}

/* What is exactly h away is no neighbour; pairs are those of the lists, with any number of threads;
 * and a volume that is none is refused by its point. */
TEST(test_edges)
{
    const struct kernel kernel = kernel_named("wendland_c4");
    const double x[] = {0, 0.5, 1, 0.75}, y[] = {0, 0, 0, 0.25}, h[] = {0.5, 0.50000001, 2, 0.4};
    double V[] = {1, 1, 1, 1};
    for (int threads = 1; threads <= 2; threads++)
        for (size_t o = 0; o < operator_family.n; o++) {
            const struct operator_settings settings = {operator_at(o), &kernel, false, threads};
            const struct cloud cloud = {{.dim = 2, .n = 4, .x = {x, y}}, V, h};
            static const uint32_t expected[] = {1, 4, 4, 3};
            struct computed c;
            compute(&settings, &cloud, &c);
            for (int i = 0; i < 4; i++) assert_int_equal(c.point[i].neighbours, expected[i]);
            assert_true(c.pairs == 12);
            release(&c);
        }
    static const double wrong[] = {0, -1, (double)NAN, (double)INFINITY};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        struct error error;
        V[2] = wrong[k];
        const struct operator_settings settings = {operator_at(0), &kernel, false, 1};
        const struct cloud cloud = {{.dim = 2, .n = 4, .x = {x, y}}, V, h};
        assert_int_equal(operator_apply(&settings, &cloud, 0, NULL, NULL, NULL, NULL, &error),
                         STATUS_BAD_INPUT);
        assert_non_null(strstr(error.message, "point 2: volume"));
    }
}

TEST(test_odd_clouds)
{
    const struct kernel kernel = kernel_named("wendland_c2");
    double zero[40] = {0}, line[40], V[40], h[40], far[40], flat[40];
    for (size_t i = 0; i < 40; i++) {
        line[i] = 0.1 * (double)i, V[i] = 0.1, h[i] = 0.35;
        far[i] = 1e8 + 0.125 * (double)(i * i % 41), flat[i] = 1e-9 * (double)(i * 7 % 40);
    }
    for (size_t o = 0; o < operator_family.n; o++)
        for (int dim = 1; dim <= 3; dim++) {
            const struct operator_settings settings = {operator_at(o), &kernel, false, 1};
            struct computed c;
            struct cloud cloud = {{.dim = dim, .n = 40, .x = {zero, zero, zero}}, V, h};
            compute(&settings, &cloud, &c); /* all at one place */
            assert_int_equal(c.point[3].state, OPERATOR_SINGULAR);
            assert_int_equal(c.point[3].neighbours, 40);
            assert_true(isnan(c.gradient[0][3]) == settings.form->corrected);
            release(&c);
            cloud.points.n = 1;
            compute(&settings, &cloud, &c);
            assert_int_equal(c.point[0].state, OPERATOR_TOO_FEW_NEIGHBOURS);
            release(&c);
            cloud.points.n = 0;
            compute(&settings, &cloud, &c);
            release(&c);
            if (dim == 1) continue;
            cloud = (struct cloud){{.dim = dim, .n = 40, .x = {line, line, line}}, V, h};
            compute(&settings, &cloud, &c); /* on a diagonal */
            assert_int_equal(c.point[20].state, OPERATOR_SINGULAR);
            release(&c);
            cloud = (struct cloud){{.dim = 2, .n = 40, .x = {line, flat}}, V, h};
            compute(&settings, &cloud, &c); /* thin, along an axis: invertible all the same */
            assert_int_equal(c.point[20].state, OPERATOR_ILL_CONDITIONED);
            assert_true(isfinite(c.gradient[1][20]));
            release(&c);
            for (size_t i = 0; i < 40; i++) h[i] = 30;
            cloud = (struct cloud){{.dim = 2, .n = 40, .x = {far, line}}, V, h};
            compute(&settings, &cloud, &c); /* far from the origin, every pair a neighbour */
            assert_int_equal(c.point[20].neighbours, 40);
            near_below(departure(&settings, &cloud, &c), 1e-9);
            release(&c);
            for (size_t i = 0; i < 40; i++) h[i] = 0.35;
        }
    h[17] = 0;
    struct error error;
    const struct operator_settings settings = {operator_at(0), &kernel, false, 1};
    const struct cloud cloud = {{.dim = 1, .n = 40, .x = {line}}, V, h};
    assert_int_equal(operator_apply(&settings, &cloud, 0, NULL, NULL, NULL, NULL, &error),
                     STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "point 17"));
}

/* h and rho solve their two equations (brute force), and a uniform cloud has density 1. */
TEST(test_summation)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int kind = 0; kind < CLOUDS_KINDS; kind++) {
            const struct kernel kernel = kernel_named("wendland_c4");
            const struct clouds_settings how = {
                (enum clouds_kind)kind, dim, dim == 1 ? 90 : dim == 2 ? 14 : 7, 0.3, 3, 3};
            struct clouds_cloud cloud;
            assert_int_equal(clouds_make(&how, &cloud, NULL), STATUS_OK);
            const size_t n = cloud.cloud.points.n;
            double *h = numbers(n), *rho = numbers(n);
            struct error error = {0};
            struct summation sum = {cloud.cloud.points, &kernel, cloud.volume, how.eta, 1e-12, 2};
            if (summation_solve(&sum, h, rho, &error)) fail_msg("%s", error.message);
            for (size_t i = 0; i < n; i++) {
                double expected = 0;
                for (size_t j = 0; j < n; j++) {
                    double r = 0;
                    for (int a = 0; a < dim; a++) r = hypot(r, cloud.x[a][j] - cloud.x[a][i]);
                    expected += cloud.volume[j] * kernel_value(&kernel, r, h[i], dim);
                }
                near_relative(rho[i], expected, 1e-11);
                near_relative(h[i], how.eta * pow(cloud.volume[i] / expected, 1. / dim), 1e-11);
                if (kind == CLOUDS_LATTICE && clouds_interior(&how, &cloud, i))
                    near_relative(rho[i], 1, 0.03);
            }
            sum.eta = 0.9;
            assert_int_equal(summation_solve(&sum, h, rho, &error), STATUS_BAD_INPUT);
            sum.eta = 1e4;
            assert_int_equal(summation_solve(&sum, h, rho, &error), STATUS_BROKE_DOWN);
            sum.eta = how.eta;
            for (size_t i = 20; i < 49; i++)
                for (int a = 0; a < dim; a++) cloud.x[a][i] = 0.5;
            assert_int_equal(summation_solve(&sum, h, rho, &error), STATUS_BROKE_DOWN);
            assert_non_null(strstr(error.message, "coincides"));
            sum.points.n = 1;
            assert_int_equal(summation_solve(&sum, h, rho, &error), STATUS_BROKE_DOWN);
            free(h), free(rho);
            clouds_free(&cloud);
        }
}

/* A cloud in units of 2^e, its fields in units of 2^g: the same gradients, densities and states but
 * for their exponents, to the last bit. */
TEST(test_units)
{
    static const int exponents[] = {-330, -200, 129, 300, 500, -990};
    for (int dim = 1; dim <= 3; dim++)
        for (size_t u = 0; u < sizeof exponents / sizeof *exponents; u++) {
            const int e = exponents[u], g = u % 2 ? 400 : -400;
            if (abs(e * dim) > 1000) continue; /* its volumes are no doubles */
            const struct kernel kernel = kernel_named("wendland_c4");
            const struct clouds_settings how = {
                CLOUDS_JITTERED, dim, dim == 1 ? 60 : dim == 2 ? 12 : 6, 0.3, 2.7, 5};
            struct clouds_cloud cloud, far;
            assert_int_equal(clouds_make(&how, &cloud, NULL), STATUS_OK);
            assert_int_equal(clouds_make(&how, &far, NULL), STATUS_OK);
            const size_t n = cloud.cloud.points.n;
            double *h[2] = {numbers(n), numbers(n)}, *rho[2] = {numbers(n), numbers(n)};
            for (size_t i = 0; i < n; i++) {
                for (int a = 0; a < dim; a++) far.x[a][i] = ldexp(far.x[a][i], e);
                far.volume[i] = ldexp(far.volume[i], dim * e);
                far.h[i] = ldexp(far.h[i], e);
            }
            for (size_t o = 0; o < operator_family.n; o++) {
                const struct operator_settings settings = {operator_at(o), &kernel, false, 1};
                struct computed c, d = {0};
                compute(&settings, &cloud.cloud, &c);
                for (size_t k = 0; k < FIELDS * 3; k++) d.gradient[k] = numbers(n);
                for (size_t k = 0; k < FIELDS; k++) {
                    d.f[k] = numbers(n);
                    for (size_t i = 0; i < n; i++) d.f[k][i] = ldexp(c.f[k][i], g);
                }
                assert_non_null(d.point = calloc(n, sizeof *d.point));
                assert_int_equal(operator_apply(&settings, &far.cloud, FIELDS,
                                                (const double *const *)d.f, d.gradient, d.point,
                                                &d.pairs, NULL),
                                 STATUS_OK);
                assert_true(c.pairs == d.pairs);
                for (size_t i = 0; i < n; i++) {
                    bool tiny = false, huge = false;
                    for (size_t k = 0; k < FIELDS * (size_t)dim; k++) {
                        const double expected = ldexp(c.gradient[k][i], g - e);
                        assert_true(d.gradient[k][i] == expected);
                        tiny = tiny || (fabs(expected) < DBL_MIN && c.gradient[k][i] != 0);
                        huge = huge || isinf(expected);
                    }
                    if (tiny || huge)
                        assert_true(d.point[i].state != OPERATOR_OK);
                    else
                        assert_true(d.point[i].state == c.point[i].state);
                }
                release(&c);
                release(&d);
            }
            struct summation sum = {cloud.cloud.points, &kernel, cloud.volume, how.eta, 1e-12, 1};
            struct summation far_sum = {far.cloud.points, &kernel, far.volume, how.eta, 1e-12, 1};
            assert_int_equal(summation_solve(&sum, h[0], rho[0], NULL), STATUS_OK);
            assert_int_equal(summation_solve(&far_sum, h[1], rho[1], NULL), STATUS_OK);
            for (size_t i = 0; i < n; i++) {
                near_relative(ldexp(h[1][i], -e), h[0][i], 1e-11);
                near_relative(rho[1][i], rho[0][i], 1e-11);
            }
            for (int i = 0; i < 2; i++) free(h[i]), free(rho[i]);
            clouds_free(&cloud);
            clouds_free(&far);
        }
}

/* Inverse and condition number against GSL's singular values, also badly scaled. */
TEST(test_matrix)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int trial = 0; trial < 600; trial++) {
        const int dim = 1 + trial % 3;
        const size_t d = (size_t)dim;
        double a[9], inverse[9], scale[3], product, values[3], v[9], work[3], copy[9];
        for (int i = 0; i < 3; i++) scale[i] = pow(10, 12 * gsl_rng_uniform(rng) - 6);
        for (int i = 0; i < dim * dim; i++) {
            a[i] = copy[i] = 2 * gsl_rng_uniform(rng) - 1;
            if (trial >= 300) a[i] = copy[i] = a[i] * scale[i / dim] * scale[i % dim];
        }
        gsl_matrix_view A = gsl_matrix_view_array(copy, d, d), V = gsl_matrix_view_array(v, d, d);
        gsl_vector_view S = gsl_vector_view_array(values, d);
        gsl_vector_view W = gsl_vector_view_array(work, d);
        gsl_linalg_SV_decomp(&A.matrix, &V.matrix, &S.vector, &W.vector);
        const double condition = values[0] / values[dim - 1];
        if (condition < 1e10) near_relative(matrix_condition(dim, a), condition, 1e-5);
        if (condition < 1e4) near_relative(matrix_condition(dim, a), condition, 1e-11);
        assert_true(matrix_invert(dim, a, inverse));
        for (int i = 0; i < dim; i++)
            for (int j = 0; j < dim; j++) {
                double size = 0;
                product = -(i == j);
                for (int k = 0; k < dim; k++) {
                    product += a[i * dim + k] * inverse[k * dim + j];
                    size += fabs(a[i * dim + k] * inverse[k * dim + j]);
                }
                near_below(fabs(product), 1e-13 * fmax(size, 1) * fmin(condition, 100));
            }
    }
    gsl_rng_free(rng);
    double inverse[9];
    assert_false(matrix_invert(2, (double[]){1, 2, 2, 4}, inverse));
    assert_false(matrix_invert(3, (double[]){1, 2, 3, 4, 5, 6, 7, 8, 9}, inverse));
    assert_false(matrix_invert(1, (double[]){0}, inverse));
    assert_false(matrix_invert(1, (double[]){(double)NAN}, inverse));
    assert_true(matrix_invert(2, (double[]){1, 0, 0, 1e-200}, inverse));
    near_relative(inverse[3], 1e200, 1e-15);
    assert_true(isinf(matrix_condition(2, (double[]){0, 0, 0, 0})));
    assert_true(isnan(matrix_condition(2, (double[]){(double)NAN, 0, 0, 1})));
}
