/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares inverses and condition numbers of small matrices with quadruple precision and with
 * matrices whose singular values are known, and tests the weights of moment matrices. */
#include "test.h"

#include <float.h>
#include <sys/mman.h>
#include <unistd.h>

#include "matrix.h"
#include "cells/moments.h"
#include "kernel.h"

/* At least twice the digits of double. */
#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 real;
#else
typedef long double real;
#endif

static uint64_t state_of_draws = 1;

/* Uniform in [-1, 1). */
static double draw(void)
{
    state_of_draws = state_of_draws * 6364136223846793005u + 1442695040888963407u;
    return ldexp((double)(int64_t)(state_of_draws ^ state_of_draws >> 29), -63);
}

/* By cofactors in extended precision; returns the determinant. */
static real exact_inverse(int dim, const double *a, real *inverse)
{
    real determinant = 0;
    if (dim == 1) {
        inverse[0] = 1, determinant = a[0];
    } else if (dim == 2) {
        inverse[0] = a[3], inverse[1] = -a[1], inverse[2] = -a[2], inverse[3] = a[0];
        determinant = (real)a[0] * a[3] - (real)a[1] * a[2];
    } else {
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                const int p = (j + 1) % 3, q = (j + 2) % 3, r = (i + 1) % 3, s = (i + 2) % 3;
                inverse[3 * i + j] =
                    (real)a[3 * p + r] * a[3 * q + s] - (real)a[3 * p + s] * a[3 * q + r];
            }
        for (int j = 0; j < 3; j++) determinant += a[j] * inverse[3 * j];
    }
    for (int k = 0; k < dim * dim; k++) inverse[k] /= determinant;
    return determinant;
}

static real size_of(real x)
{
    return x < 0 ? -x : x;
}

/* Error of the inverse's elements in units of the error that rounding the elements of a may cause,
 * sum |inverse| |a| |inverse| epsilon. */
static double inverse_error(int dim, const double *a, const double *inverse)
{
    real exact[9];
    double worst = 0;
    exact_inverse(dim, a, exact);
    for (int i = 0; i < dim; i++)
        for (int j = 0; j < dim; j++) {
            real scale = 0;
            for (int p = 0; p < dim; p++)
                for (int q = 0; q < dim; q++)
                    scale += size_of(exact[i * dim + p] * a[p * dim + q] * exact[q * dim + j]);
            const double error =
                (double)(size_of(inverse[i * dim + j] - exact[i * dim + j]) / scale / DBL_EPSILON);
            if (!(error <= worst)) worst = error;
        }
    return worst;
}

/* The product of a rotation, a diagonal matrix and a rotation, both by random angles: singular
 * values 1, s, t; in 1D and 2D the first of them. */
static void with_singular_values(int dim, double s, double t, double *a)
{
    const double values[] = {1, s, t};
    real m[9] = {0};
    for (int i = 0; i < dim; i++) m[i * dim + i] = values[i];
    for (int side = 0; side < 2; side++)
        for (int p = 0; p < dim; p++)
            for (int q = p + 1; q < dim; q++) {
                const double angle = 3 * draw();
                const long double c = cosl(angle), d = sinl(angle);
                for (int k = 0; k < dim; k++) {
                    real *x = side ? &m[k * dim + p] : &m[p * dim + k];
                    real *y = side ? &m[k * dim + q] : &m[q * dim + k];
                    const real u = *x, v = *y;
                    *x = c * u - d * v, *y = d * u + c * v;
                }
            }
    for (int k = 0; k < dim * dim; k++) a[k] = (double)m[k];
}

/* Random matrices, ordinary and nearly singular; then with a unit of length along each axis that
 * differs by powers of 2, which must not matter to the inverse of a moment matrix. */
TEST(inverses_of_matrices)
{
    double worst[4] = {0}, in_units[4] = {0};
    for (int trial = 0; trial < 6000; trial++) {
        const int dim = 1 + trial % 3;
        double a[9], b[9], inverse[9], other[9];
        if (trial < 3000)
            for (int k = 0; k < dim * dim; k++) a[k] = draw();
        else
            with_singular_values(dim, pow(10, -6 * fabs(draw())), pow(10, -12 * fabs(draw())), a);
        assert_true(matrix_invert(dim, a, inverse));
        worst[dim] = fmax(worst[dim], inverse_error(dim, a, inverse));
        int axis[3];
        for (int i = 0; i < 3; i++) axis[i] = (int)(10 * draw());
        for (int i = 0; i < dim; i++)
            for (int j = 0; j < dim; j++) {
                double sum = 0;
                for (int k = 0; k < dim; k++) sum += a[i * dim + k] * a[j * dim + k];
                b[i * dim + j] = sum;
            }
        if (!(matrix_condition(dim, b) < 1e12)) continue;
        double c[9];
        for (int i = 0; i < dim; i++)
            for (int j = 0; j < dim; j++) c[i * dim + j] = ldexp(b[i * dim + j], axis[i] + axis[j]);
        assert_true(matrix_invert(dim, c, other));
        for (int i = 0; i < dim; i++)
            for (int j = 0; j < dim; j++)
                other[i * dim + j] = ldexp(other[i * dim + j], axis[i] + axis[j]);
        in_units[dim] = fmax(in_units[dim], inverse_error(dim, b, other));
    }
    for (int dim = 1; dim <= 3; dim++) {
        near_below(worst[dim], 3);
        near_below(in_units[dim], dim < 3 ? 3 : 200);
    }
}

/* The condition number is as accurate for columns of very different size. */
TEST(condition_numbers)
{
    double worst[2] = {0};
    for (int trial = 0; trial < 3000; trial++) {
        const int dim = 1 + trial % 3;
        double a[9], high = 0, low = HUGE_VAL;
        with_singular_values(dim, 1, 1, a);
        for (int j = 0; j < dim; j++) {
            const double size = pow(10, 60 * draw());
            for (int i = 0; i < dim; i++) a[i * dim + j] *= size;
            high = fmax(high, size), low = fmin(low, size);
        }
        const double found = matrix_condition(dim, a);
        worst[0] = fmax(worst[0], fabs(found / (high / low) - 1) / DBL_EPSILON);
        const double s = pow(10, -5 * fabs(draw())), t = s * pow(10, -4 * fabs(draw()));
        with_singular_values(dim, s, t, a);
        const double condition = dim == 1 ? 1 : dim == 2 ? 1 / s : 1 / t;
        worst[1] = fmax(worst[1],
                        fabs(matrix_condition(dim, a) / condition - 1) / (condition * DBL_EPSILON));
    }
    near_below(worst[0], 4);
    near_below(worst[1], 4);
    near_relative(matrix_condition(2, (double[]){1, 0, 0, 1e-300}), 1e300, 1e-15);
    assert_true(matrix_condition(3, (double[]){1, 0, 0, 0, 1, 0, 0, 0, 1}) == 1);
    assert_true(matrix_condition(3, (double[]){1, 0, 0, 0, 0, 0, 0, 0, 0}) == HUGE_VAL);
    assert_true(matrix_condition(1, (double[]){-DBL_MAX}) == 1);
    assert_true(matrix_condition(1, (double[]){DBL_TRUE_MIN}) == 1);
    assert_true(matrix_condition(2, (double[]){1, 0, 0, 0}) == HUGE_VAL);
    assert_true(matrix_condition(3, (double[9]){0}) == HUGE_VAL);
}

/* A NaN or infinity in any element, an overflow, or a singular matrix: no inverse and no condition
 * number; the caller's array is not written. */
TEST(no_inverse)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int k = 0; k < dim * dim; k++)
            for (int kind = 0; kind < 3; kind++) {
                double a[9], inverse[9], kept[9];
                with_singular_values(dim, 0.7, 0.4, a);
                a[k] = kind ? (kind == 1 ? HUGE_VAL : -HUGE_VAL) : nan("");
                for (int i = 0; i < 9; i++) inverse[i] = kept[i] = i + 0.5;
                assert_false(matrix_invert(dim, a, inverse));
                assert_memory_equal(inverse, kept, sizeof kept);
                assert_true(isnan(matrix_condition(dim, a)));
            }
    static const struct {
        int dim;
        double a[9];
    } singular[] = {
        {1, {0}},
        {2, {0, 1, 0, 1}},
        {2, {1, 1, 0, 0}},
        {2, {0, 0, 1, 1}},
        {2, {3, 1, 3, 1}},
        {2, {1, 0, 1, 0}},
        {3, {1, 2, 3, 4, 5, 6, 7, 8, 9}},
        {3, {0, 1, 1, 0, 1, 2, 0, 1, 3}},
        {3, {1, 1, 0, 1, 2, 0, 1, 3, 0}},
        {3, {1, 1, 1, 1, 1, 1, 1, 1, 2}},
    };
    for (size_t i = 0; i < sizeof singular / sizeof *singular; i++) {
        double inverse[9] = {7, 7, 7, 7, 7, 7, 7, 7, 7}, kept[9];
        memcpy(kept, inverse, sizeof kept);
        assert_false(matrix_invert(singular[i].dim, singular[i].a, inverse));
        assert_memory_equal(inverse, kept, sizeof kept);
        assert_true(matrix_condition(singular[i].dim, singular[i].a) > 1e15);
    }
}

/* Like matrix_invert's elimination of a matrix whose rows and columns have largest elements of 1
 * and whose determinant is small, but with rows exchanged before, not during it. */
static void eliminated(int dim, const double *a, double *inverse)
{
    int row[3] = {0, 1, 2}, column[3] = {0, 1, 2};
    double work[9], left[9];
    memcpy(left, a, sizeof left);
    for (int k = 0; k < dim; k++) { /* the order of the pivots, by plain Gauss elimination */
        int p = k, q = k;
        for (int i = k; i < dim; i++)
            for (int j = k; j < dim; j++)
                if (fabs(left[dim * row[i] + column[j]]) > fabs(left[dim * row[p] + column[q]]))
                    p = i, q = j;
        const int r = row[k], c = column[k];
        row[k] = row[p], row[p] = r, column[k] = column[q], column[q] = c;
        const double reciprocal = 1 / left[dim * row[k] + column[k]];
        for (int i = k + 1; i < dim; i++)
            for (int j = k + 1; j < dim; j++)
                left[dim * row[i] + column[j]] -=
                    left[dim * row[i] + column[k]] * (left[dim * row[k] + column[j]] * reciprocal);
    }
    for (int i = 0; i < dim; i++)
        for (int j = 0; j < dim; j++) work[dim * i + j] = a[dim * row[i] + column[j]];
    for (int k = 0; k < dim; k++) {
        const double reciprocal = 1 / work[dim * k + k];
        for (int j = 0; j < dim; j++)
            work[dim * k + j] = (j == k ? 1 : work[dim * k + j]) * reciprocal;
        for (int i = 0; i < dim; i++) {
            const double factor = work[dim * i + k];
            for (int j = 0; j < dim && i != k; j++)
                work[dim * i + j] = (j == k ? 0 : work[dim * i + j]) - factor * work[dim * k + j];
        }
    }
    for (int i = 0; i < dim; i++)
        for (int j = 0; j < dim; j++) inverse[dim * column[i] + row[j]] = work[dim * i + j];
}

static double norm_of(int n, const double *a)
{
    double sum = 0;
    for (int k = 0; k < n; k++) sum += a[k] * a[k];
    return sqrt(sum);
}

/* A matrix is singular from a scaled condition number of 1/(16 epsilon) in Frobenius' norm on; that
 * of (1 1; 1 1 + e) is a little less than 4/e. */
TEST(limit_of_singular)
{
    for (int e = 60; e < 69; e++) {
        double inverse[4];
        const double a[] = {1, 1, 1, 1 + e * DBL_EPSILON};
        assert_true(matrix_invert(2, a, inverse) == (e >= 64));
    }
    const double limit = 1 / (16 * DBL_EPSILON), e = 80 * DBL_EPSILON;
    double t = sqrt((sqrt(236) - 14) / 4); /* where (5 + t^2) (4 + 2 t^2) = (e limit)^2 */
    int at_limit = 0;
    for (int step = -300; step < 300; step++) {
        const double near_t = t * (1 + step * (abs(step) < 280 ? DBL_EPSILON : 1e-10));
        const double a[] = {1, 0, 0, 0, 1, 1, near_t, 1, 1 - e};
        double inverse[9], expected[9];
        eliminated(3, a, expected);
        const double norms = norm_of(9, a) * norm_of(9, expected);
        assert_true(matrix_invert(3, a, inverse) == (norms < limit));
        if (abs(step) >= 280) assert_true((norms < limit) == (step < 0));
        at_limit += norms == limit;
    }
    assert_true(at_limit > 0);
}

/* The last bits show which method is used: in 1D elimination gives 1/a, correctly rounded, and
 * cofactors give 1/(a/|a| |a|); for diag(1, d) elimination gives 1 and 1/d, cofactors d (1/d). */
TEST(choice_of_method)
{
    int plain[2] = {0};
    for (int trial = 0; trial < 4000; trial++) {
        const double a = pow(10, trial % 2 ? 110 * draw() : copysign(100, draw()) + 2 * draw()),
                     d = pow(10, 3 * (draw() - 1));
        const bool usual = a > 1e-100 && a<1e100, far = d> 1e-2;
        double inverse[4];
        assert_true(matrix_invert(1, &a, inverse));
        assert_true(inverse[0] == (usual ? 1 / (a * (1 / a) * a) : 1 / a));
        plain[0] += usual && inverse[0] != 1 / a;
        assert_true(matrix_invert(2, (double[]){1, 0, 0, d}, inverse));
        assert_true(inverse[0] == (far ? d * (1 / d) : 1));
        plain[1] += far && inverse[0] != 1;
    }
    assert_true(plain[0] > 100 && plain[1] > 50);
    const double d =
        0.027000000000000007; /* where the methods differ at either limit, and which is beyond it */
    for (int sign = -1; sign <= 1; sign += 2) {
        const double scale = sign < 0 ? 1e-100 : 1e100;
        double inverse[4];
        assert_true(d * (1 / (d * scale)) != 1 / scale);
        assert_true(matrix_invert(2, (double[]){scale, 0, 0, d * scale}, inverse));
        assert_true(inverse[0] == 1 / scale);
    }
    const double p = 0.10200000000000001, q = 0.098039215686274508;
    double inverse[9];
    assert_true(p * q == 1e-2 && q * (1 / 1e-2) != 1 / p);
    assert_true(matrix_invert(3, (double[]){1, 0, 0, 0, p, 0, 0, 0, q}, inverse));
    assert_true(inverse[4] == 1 / p);
    assert_true(matrix_invert(2, (double[]){DBL_MAX, 0, 0, 1}, inverse));
    assert_true(inverse[0] == 1 / DBL_MAX && inverse[3] == 1);
    const double small = 0x1p-24; /* after the first pivot the rest is off the diagonal */
    const double beside[] = {1, 1, 1, 1, 1, 1 + small, 1, 1 + small, 1};
    assert_true(matrix_invert(3, beside, inverse));
    near_below(inverse_error(3, beside, inverse), 3);
}

/* Nothing behind the last element of the matrix is read, and nothing behind the inverse is
 * written. */
TEST(no_access_beyond_the_arrays)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    char *pages = mmap(NULL, 2 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    assert_true(pages != MAP_FAILED);
    assert_int_equal(mprotect(pages + page, page, PROT_NONE), 0);
    for (int trial = 0; trial < 6; trial++) {
        const int dim = 1 + trial % 3;
        double inverse[16], *a = (double *)(void *)(pages + page) - dim * dim;
        with_singular_values(dim, trial < 3 ? 1e-3 : 0.9, trial < 3 ? 1e-6 : 0.8, a);
        for (int k = 0; k < 16; k++) inverse[k] = 1234;
        assert_true(matrix_invert(dim, a, inverse));
        for (int k = dim * dim; k < 16; k++) assert_true(inverse[k] == 1234);
        assert_true(matrix_condition(dim, a) >= 1);
    }
    munmap(pages, 2 * page);
}

/* Equal pivots give the same bits: the first of them is taken. */
TEST(choice_of_pivots)
{
    static const double elements[] = {1, -1, 0.999, -0.999, 0.3, 0};
    int met = 0;
    for (int trial = 0; trial < 20000; trial++) {
        const int dim = 2 + trial % 2;
        double a[9] = {0}, inverse[9], expected[9];
        for (int k = 0; k < dim * dim; k++) {
            const int which = (int)(3 + 3 * draw());
            a[k] = elements[which] - (which > 1 && which < 5 ? 1e-4 * (int)(4 * draw()) : 0);
        }
        bool full = true;
        for (int i = 0; i < dim; i++) {
            bool one[2] = {false, false};
            for (int k = 0; k < dim; k++)
                one[0] = one[0] || fabs(a[dim * i + k]) == 1,
                one[1] = one[1] || fabs(a[dim * k + i]) == 1;
            full = full && one[0] && one[1];
        }
        real exact[9];
        if (!full || size_of(exact_inverse(dim, a, exact)) > 0.0099 ||
            !(size_of(exact_inverse(dim, a, exact)) > 1e-9))
            continue;
        met++;
        eliminated(dim, a, expected);
        assert_true(matrix_invert(dim, a, inverse));
        for (int k = 0; k < dim * dim; k++) assert_true(inverse[k] == expected[k]);
    }
    assert_true(met > 100);
}

enum { NEIGHBOURS = 3 * GRID_LANES };

/* Lanes of random neighbours: if `flat` is small, close to a line (2D) or to a plane (3D). */
struct drawn {
    double block[LANES_OWN * NEIGHBOURS], weight[NEIGHBOURS];
    struct lanes lanes;
};

static void draw_neighbours(int dim, double flat, struct drawn *drawn)
{
    drawn->lanes = (struct lanes){.block = drawn->block, .stride = NEIGHBOURS};
    for (int k = 0; k < LANES_OWN * NEIGHBOURS; k++) drawn->block[k] = 1e3 * draw();
    for (int k = 0; k < NEIGHBOURS; k++) {
        for (int a = 0; a < dim; a++) lane(&drawn->lanes, LANE_DX)[a * NEIGHBOURS + k] = draw();
        lane(&drawn->lanes, LANE_DX)[(dim - 1) * NEIGHBOURS + k] *= flat;
        lane(&drawn->lanes, LANE_R)[k] = fabs(draw());
        drawn->weight[k] = fabs(draw());
    }
}

/* A symmetric positive matrix, half of them with a condition above 1e4, and now and then one that
 * is not finite or too small or too large. */
static void draw_moments(int dim, double *a)
{
    const double scale = pow(10, (draw() > 0.5 ? 160 : 10) * draw());
    double half[9];
    with_singular_values(dim, pow(10, 4 * draw() - 3), pow(10, 4 * draw() - 3), half);
    for (int i = 0; i < dim; i++)
        for (int j = 0; j < dim; j++) {
            a[i * dim + j] = 0;
            for (int k = 0; k < dim; k++)
                a[i * dim + j] += scale * half[i * dim + k] * half[j * dim + k];
        }
    static const double odd[] = {NAN, INFINITY, 0, 1e-200, 1e200};
    if (draw() > 0.8)
        for (int k = 0, which = (int)(2.5 + 2.5 * draw()); k < dim * dim; k++) a[k] *= odd[which];
}

/* Batches of moment matrices give the inverses, conditions and gradients that matrix_invert and
 * matrix_condition give one by one, and nothing where these give no usable inverse. */
TEST(batches)
{
    const struct cells_method methods[] = {{.box.dim = 2, .worst_condition = 1e4},
                                           {.box.dim = 3, .worst_condition = 1e4}};
    int usable = 0, plain = 0, unusable = 0;
    for (int trial = 0; trial < 4000; trial++) {
        const struct cells_method *method = &methods[trial % 2];
        const int dim = method->box.dim, symmetric = dim * (dim + 1) / 2;
        struct moments_batch batch = {.count = 1 + trial % GRID_LANES};
        double a[GRID_LANES][9], f[9][GRID_LANES], sums[9][GRID_LANES];
        for (int l = 0; l < batch.count; l++) {
            draw_moments(dim, a[l]);
            for (int i = 0, k = 0; i < dim; i++)
                for (int j = i; j < dim; j++, k++) batch.moments[k][l] = a[l][i * dim + j];
            for (int k = 0; k < 2 * dim; k++) f[k][l] = sums[k][l] = draw();
        }
        moments_solve(method, &batch);
        moments_apply(dim, 2, &batch, sums);
        for (int l = 0; l < batch.count; l++) {
            double inverse[9] = {0};
            const double condition = matrix_condition(dim, a[l]);
            const bool sound = matrix_invert(dim, a[l], inverse) && condition <= 1e4;
            if (fabs(condition / 1e4 - 1) > 1e-6) assert_true(batch.sound[l] == sound);
            if (!batch.sound[l]) {
                unusable++;
                for (int k = 0; k < symmetric; k++) assert_true(batch.inverse[k][l] == 0);
                for (int k = 0; k < 2 * dim; k++) assert_true(sums[k][l] == 0);
                continue;
            }
            /* first the Frobenius norm, at most `dim` times as large */
            assert_true(batch.condition[l] >= condition * (1 - 1e-9) &&
                        batch.condition[l] <= condition * dim);
            plain += batch.condition[l] > condition * (1 + 1e-9);
            usable++;
            double size = 0;
            for (int k = 0; k < dim * dim; k++) size = fmax(size, fabs(inverse[k]));
            for (int i = 0, k = 0; i < dim; i++)
                for (int j = i; j < dim; j++, k++)
                    near_below(fabs(batch.inverse[k][l] - inverse[i * dim + j]),
                               1e-14 * condition * size);
            for (int k = 0; k < 2 * dim; k++) {
                double expected = 0;
                for (int b = 0; b < dim; b++)
                    expected += inverse[k % dim * dim + b] * f[k / dim * dim + b][l];
                near_below(fabs(sums[k][l] - expected), 1e-13 * condition * size);
            }
        }
    }
    assert_true(usable > 1000 && plain > 1000 && unusable > 1000);
}

/* Compares w(q) and V w(q) of specialised and unspecialised kernel loops with the kernel. */
TEST(weights_of_neighbours)
{
    for (int trial = 0; trial < 40; trial++) {
        const int dim = 2 + trial % 2, count = GRID_LANES * (1 + trial % 3);
        struct drawn drawn;
        struct kernel kernel;
        draw_neighbours(dim, 1, &drawn);
        assert_int_equal(kernel_select(&kernel, "wendland_c4", 5, NULL), STATUS_OK);
        const struct cells cells = {.method = {.box.dim = dim, .kernel = &kernel},
                                    .shapes = shapes_of(&kernel, dim, trial % 4 < 2)};
        moments_weigh(&cells, count, &drawn.lanes, 1.25, drawn.weight);
        for (int k = 0; k < count; k++) {
            const double r = lane(&drawn.lanes, LANE_R)[k], h = 0.8;
            const double w = kernel_value(&kernel, r, h, dim) * pow(h, dim) / kernel.constant[dim];
            near_below(fabs(lane(&drawn.lanes, LANE_W)[k] - w), 1e-14);
            near_below(fabs(lane(&drawn.lanes, LANE_W_J)[k] - drawn.weight[k] * w), 1e-14);
        }
    }
}
