/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gradient operators in other units. */
#include "test.h"

#include <float.h>

#include "clouds.h"
#include "summation.h"

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
