/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gradient operators at the limits of numbers: clouds in any units, one quantity extreme and the
 * others not, what leaves the range of double, what cannot be computed, distances that differ from
 * h in the last digits, what is refused word for word, and promises that are kept. */
#include "test.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "draw.h"
#include "naive.h"
#include "near.h"
#include "operator.h"

enum { POINTS_MAX = 200, FIELDS = 2 };

static struct kernel kernel;

/* A cloud with fields and what was made of them; behind the last point of each array a mark. */
struct made {
    struct cloud cloud;
    double x[3][POINTS_MAX], V[POINTS_MAX], h[POINTS_MAX], f[FIELDS][POINTS_MAX];
    double gradient[FIELDS * 3][POINTS_MAX + 1];
    struct operator_point point[POINTS_MAX];
    uint64_t pairs;
};

static const double mark = 0.71;

static void connect(struct made *made, int dim, size_t n, bool periodic)
{
    struct points *points = &made->cloud.points;
    *points = (struct points){.dim = dim, .n = n, .periodic = periodic};
    for (int a = 0; a < dim; a++) points->x[a] = made->x[a], points->hi[a] = 1;
    made->cloud.volume = made->V;
    made->cloud.h = made->h;
}

static void fill(struct made *made, int dim, size_t n, bool periodic)
{
    connect(made, dim, n, periodic);
    for (size_t i = 0; i < n; i++) {
        for (int a = 0; a < dim; a++) made->x[a][i] = draw(0, 1);
        made->V[i] = draw(0.5, 1) / (double)n;
        made->h[i] = draw(0.9, 1) * pow((double)n / 12, -1. / dim);
        for (int k = 0; k < FIELDS; k++) made->f[k][i] = draw(-1, 1);
    }
}

static const struct operator_form *form_at(size_t o)
{
    return (const struct operator_form *)operator_family.members[o];
}

static enum status apply(struct made *made, const struct operator_form *form, struct error *error)
{
    const struct operator_settings settings = {form, &kernel, false, 1};
    const double *f[FIELDS];
    double *gradient[FIELDS * 3];
    const size_t n = made->cloud.points.n;
    for (int k = 0; k < FIELDS; k++) f[k] = made->f[k];
    for (int k = 0; k < FIELDS * 3; k++) gradient[k] = made->gradient[k], gradient[k][n] = mark;
    const enum status status = operator_apply(&settings, &made->cloud, FIELDS, f, gradient,
                                              made->point, &made->pairs, error);
    for (int k = 0; k < FIELDS * 3; k++) assert_true(gradient[k][n] == mark);
    return status;
}

static void apply_well(struct made *made, const struct operator_form *form)
{
    struct error error;
    if (apply(made, form, &error)) fail_msg("%s", error.message);
}

static struct made one, other;

/* The cloud in units of 2^length, its volumes in units of 2^volume, each field in its own. */
static void in_units(const struct made *from, int length, int volume, const int *field,
                     struct made *to)
{
    const struct points *points = &from->cloud.points;
    connect(to, points->dim, points->n, points->periodic);
    for (int a = 0; a < points->dim; a++) to->cloud.points.hi[a] = ldexp(1, length);
    for (size_t i = 0; i < points->n; i++) {
        for (int a = 0; a < points->dim; a++) to->x[a][i] = ldexp(from->x[a][i], length);
        to->V[i] = ldexp(from->V[i], volume);
        to->h[i] = ldexp(from->h[i], length);
        for (int k = 0; k < FIELDS; k++) to->f[k][i] = ldexp(from->f[k][i], field[k]);
    }
}

/* The state after gradients have left the range: that of the first one that does. */
static enum operator_state state_in(const struct made *made, int dim, size_t i, const int *e)
{
    if (made->point[i].state != OPERATOR_OK) return made->point[i].state;
    for (int k = 0; k < FIELDS; k++)
        for (int a = 0; a < dim; a++) {
            const double g = made->gradient[k * dim + a][i], given = ldexp(g, e[k]);
            if (isinf(given)) return OPERATOR_OVERFLOW;
            if (g != 0 && fabs(given) < DBL_MIN) return OPERATOR_UNDERFLOW;
        }
    return OPERATOR_OK;
}

/* Compares every digit. Returns how many states are not OK. */
static size_t same_in(int length, int volume, const int *field, const struct operator_form *form)
{
    const int dim = one.cloud.points.dim;
    size_t lost = 0;
    int e[FIELDS];
    in_units(&one, length, volume, field, &other);
    apply_well(&other, form);
    assert_true(one.pairs == other.pairs);
    for (int k = 0; k < FIELDS; k++)
        e[k] = field[k] + (form->corrected ? -length : volume - (dim + 1) * length);
    for (size_t i = 0; i < one.cloud.points.n; i++) {
        for (int k = 0; k < FIELDS * dim; k++) {
            const double expected = ldexp(one.gradient[k][i], e[k / dim]);
            assert_true(other.gradient[k][i] == expected ||
                        (isnan(expected) && isnan(other.gradient[k][i])));
        }
        assert_int_equal(other.point[i].neighbours, one.point[i].neighbours);
        assert_int_equal(other.point[i].state, state_in(&one, dim, i, e));
        lost += other.point[i].state != OPERATOR_OK;
    }
    return lost;
}

/* Whatever is large or small, alone or together, no digit changes. */
TEST(test_units)
{
    static const struct {
        int length, volume, field[FIELDS];
    } units[] = {
        {-30, 0, {0, 0}},        {-30, -90, {7, -9}},       {0, -1012, {0, 0}},
        {-260, 0, {-120, -120}}, {10, 100, {1000, 0}},      {10, 100, {0, 1000}},
        {10, -100, {-1000, 0}},  {10, -100, {0, -1000}},    {300, 900, {0, 0}},
        {-300, -900, {90, -90}}, {-250, 0, {-1000, -1000}}, {100, 100, {1000, -1000}},
        {0, 1000, {0, 0}},       {-120, 120, {100, -100}},  {120, -120, {-100, 100}},
    };
    for (int dim = 1; dim <= 3; dim++)
        for (int periodic = 0; periodic < 2; periodic++)
            for (size_t o = 0; o < operator_family.n; o++) {
                fill(&one, dim, 70, periodic);
                if (!periodic) { /* one has no neighbours, and a constant has no gradient */
                    one.x[0][5] = 9;
                    for (size_t i = 0; i < 70; i++) one.f[1][i] = 0.375;
                }
                apply_well(&one, form_at(o));
                for (size_t u = 0; u < sizeof units / sizeof *units; u++)
                    same_in(units[u].length, units[u].volume, units[u].field, form_at(o));
            }
}

/* Units in which some gradients are no longer numbers, or only subnormal ones. */
TEST(test_lost)
{
    size_t lost = 0, kept = 0;
    for (int dim = 1; dim <= 3; dim++)
        for (size_t o = 0; o < operator_family.n; o++) {
            fill(&one, dim, 70, false);
            one.x[0][5] = 9;
            apply_well(&one, form_at(o));
            double large = 0;
            for (size_t i = 0; i < 70; i++)
                if (isfinite(one.gradient[0][i])) large = fmax(large, fabs(one.gradient[0][i]));
            int e;
            frexp(large, &e);
            for (int k = 0; k < 24; k++) {
                const int way = k % 2 ? 1 : -1, length = -300 * way;
                const int target = way > 0 ? 1022 - e + k / 6 : -1019 - e - k / 6;
                int field[FIELDS];
                for (int m = 0; m < FIELDS; m++) {
                    field[m] = target - (form_at(o)->corrected ? -length : -dim * length);
                    if (k / 2 % 3 == m) field[m] -= 60 * way; /* is far from the limit */
                }
                const size_t found = same_in(length, length, field, form_at(o));
                lost += found;
                kept += 70 - found;
            }
        }
    assert_true(lost > 300 && kept > 300);
}

/* The smallest normal number is one. */
TEST(test_least_normal)
{
    size_t found = 0;
    for (int trial = 0; trial < 40; trial++) {
        const double step = draw(0.2, 0.4);
        connect(&one, 1, 3, false);
        for (size_t i = 0; i < 3; i++) {
            one.x[0][i] = ((double)i - 1) * step, one.V[i] = 0.5, one.h[i] = 1;
            one.f[0][i] = one.x[0][i], one.f[1][i] = 0;
        }
        apply_well(&one, form_at(3));
        if (one.gradient[0][1] != 1 || one.gradient[0][0] != 1 || one.gradient[0][2] != 1) continue;
        found++;
        assert_int_equal(same_in(100, 0, (int[]){-922, 0}, form_at(3)), 0);
        assert_true(other.gradient[0][1] == DBL_MIN);
        assert_int_equal(same_in(100, 0, (int[]){-923, 0}, form_at(3)), 3);
    }
    assert_true(found > 0);
}

static double departure(const struct operator_form *form, size_t i)
{
    const int dim = one.cloud.points.dim;
    double worst = 0;
    for (int k = 0; k < FIELDS; k++) {
        double exact[3], scale = 0;
        naive_gradient(form, &kernel, NAIVE_NONE, &one.cloud, one.f[k], i, exact);
        for (int a = 0; a < dim; a++) scale = fmax(scale, fabs(exact[a]));
        for (int a = 0; a < dim; a++) {
            const double error = fabs(one.gradient[k * dim + a][i] - exact[a]) / scale;
            if (!(error <= worst)) worst = error;
        }
    }
    return worst;
}

/* A neighbour that is very near pulls as hard as its field is large. */
TEST(test_close)
{
    for (int dim = 1; dim <= 3; dim++)
        for (size_t o = 0; o < operator_family.n; o++) {
            fill(&one, dim, 60, false);
            for (int a = 0; a < dim; a++) one.x[a][1] = one.x[a][0] + 3e-7 * one.h[0];
            one.f[0][1] = 1e6, one.f[1][1] = -3e5;
            apply_well(&one, form_at(o));
            for (size_t i = 0; i < 60; i++)
                if (one.point[i].condition < 1e3) near_below(departure(form_at(o), i), 1e-9);
        }
}

/* Who is nearer than h by one part in 1e13 is a neighbour, and who is as much further is none; with
 * as many neighbours as fill whole lanes, or not. */
TEST(test_edge)
{
    for (size_t n = 3; n < 40; n++) {
        fill(&one, 2, n, false);
        for (size_t i = 0; i < n; i++) one.x[0][i] *= 0.5, one.x[1][i] *= 0.5, one.h[i] = 1;
        one.x[0][0] = one.x[1][0] = 0;
        one.x[1][1] = one.x[1][2] = 0;
        one.x[0][1] = 1 - 1e-13, one.x[0][2] = 1 + 1e-13;
        apply_well(&one, form_at(0));
        assert_int_equal(one.point[0].neighbours, n - 1);
        uint64_t pairs = 0;
        for (size_t i = 0; i < n; i++) {
            uint32_t near = 0;
            for (size_t j = 0; j < n; j++)
                near += hypot(one.x[0][i] - one.x[0][j], one.x[1][i] - one.x[1][j]) < 1;
            assert_int_equal(one.point[i].neighbours, near);
            pairs += near;
        }
        assert_true(one.pairs == pairs);
    }
}

/* Where a neighbour's field is no number no gradient is one, and that is said; elsewhere it is. */
TEST(test_no_number)
{
    for (int dim = 1; dim <= 3; dim++)
        for (size_t o = 0; o < operator_family.n; o++)
            for (int k = 0; k < FIELDS; k++) {
                size_t touched = 0;
                fill(&one, dim, 70, false);
                apply_well(&one, form_at(o));
                memcpy(&other, &one, sizeof one);
                one.f[k][30] = (double)NAN;
                apply_well(&one, form_at(o));
                for (size_t i = 0; i < 70; i++) {
                    double r = 0;
                    for (int a = 0; a < dim; a++) r = hypot(r, one.x[a][i] - one.x[a][30]);
                    const bool sees = r < one.h[i] || i == 30;
                    if (other.point[i].state != OPERATOR_OK) continue;
                    touched += sees;
                    assert_int_equal(one.point[i].state, sees ? OPERATOR_OVERFLOW : OPERATOR_OK);
                }
                assert_true(touched > 3 && touched < 60);
            }
}

/* A condition number of exactly the limit is well; the next larger one is not. */
TEST(test_limit)
{
    size_t at = 0, above = 0;
    connect(&one, 2, 5, false);
    for (size_t i = 0; i < 5; i++) {
        one.V[i] = one.h[i] = 1;
        one.x[0][i] = one.x[1][i] = one.f[0][i] = one.f[1][i] = 0;
    }
    for (int trial = 0; trial < 20; trial++) {
        const double s = draw(0.3, 0.5); /* w(t) is w(0) but for t^2 */
        double t = s * sqrt(kernel.w(&kernel, s, 2) / kernel.w(&kernel, 0, 2)) * 1e-3;
        one.x[0][1] = s, one.x[0][2] = -s;
        for (int k = 0; k < 12; k++, t = nextafter(t, k < 8 ? 1 : 0)) {
            one.x[1][3] = t, one.x[1][4] = -t;
            apply_well(&one, form_at(3));
            const double condition = one.point[0].condition;
            if (k < 4) t *= sqrt(condition / 1e6); /* and a step up; then steps down */
            at += condition == OPERATOR_CONDITION_MAX;
            above += condition > OPERATOR_CONDITION_MAX;
            assert_int_equal(one.point[0].state, condition <= OPERATOR_CONDITION_MAX
                                                     ? OPERATOR_OK
                                                     : OPERATOR_ILL_CONDITIONED);
        }
        near_relative(one.point[0].condition, 1e6, 1e-12);
    }
    assert_true(at > 0 && above > 0);
}

/* A field of any size is no width: where the last block is full its end is not one point further.
 */
TEST(test_last_block)
{
    for (size_t n = 8; n <= 64; n += 8)
        for (int dim = 1; dim <= 3; dim++) {
            fill(&one, dim, n, true);
            for (size_t i = 0; i < n; i++) one.f[0][i] = 1e10, one.h[i] = 0.4;
            apply_well(&one, form_at(3));
        }
}

static void refused(const char *message)
{
    struct error error;
    one.pairs = 99;
    assert_int_equal(apply(&one, form_at(1), &error), STATUS_BAD_INPUT);
    assert_string_equal(error.message, message);
    assert_true(one.pairs == 0);
    assert_int_equal(apply(&one, form_at(1), NULL), STATUS_BAD_INPUT);
}

TEST(test_refused)
{
    fill(&one, 2, 20, true);
    one.h[0] = -0.5;
    refused("point 0: support radius h = -0.5; it must be positive");
    one.h[0] = HUGE_VAL;
    refused("point 0: support radius h = inf; it must be positive");
    one.h[0] = 0.25, one.h[19] = 0;
    refused("point 19: support radius h = 0; it must be positive");
    one.h[19] = 8.5;
    struct error error;
    assert_int_equal(apply(&one, form_at(1), &error), STATUS_BAD_INPUT);
    assert_string_equal(error.message,
                        "support radius 8.5 exceeds 8 lengths of the periodic box (1 in x)");
    assert_int_equal(apply(&one, form_at(1), NULL), STATUS_BAD_INPUT);
    one.h[19] = 0.25, one.V[0] = -2;
    refused("point 0: volume = -2; it must be positive");
    one.V[0] = 1, one.V[19] = HUGE_VAL;
    refused("point 19: volume = inf; it must be positive");
    one.V[19] = 1, one.x[1][19] = (double)NAN;
    refused("point 19: y = nan is not finite");
    one.V[19] = 1e300; /* in other units the same is refused */
    assert_int_equal(apply(&one, form_at(1), &error), STATUS_BAD_INPUT);
    one.x[1][19] = 0.5, one.h[19] = 8.5;
    assert_int_equal(apply(&one, form_at(1), &error), STATUS_BAD_INPUT);
}

/* The first moment, which has no inverse matrix: sum V f x W, and with f_j - f_i. */
TEST(test_moment)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int difference = 0; difference < 2; difference++) {
            const struct operator_form moment = {.pair_vector = VECTOR_POSITION,
                                                 .difference = difference};
            fill(&one, dim, 60, false);
            apply_well(&one, &moment);
            for (size_t i = 0; i < 60; i++)
                for (int k = 0; k < FIELDS * dim; k++) {
                    const double *f = one.f[k / dim], *x = one.x[k % dim];
                    double sum = 0, size = 0;
                    for (size_t j = 0; j < 60; j++) {
                        double r = 0;
                        for (int a = 0; a < dim; a++) r = hypot(r, one.x[a][j] - one.x[a][i]);
                        const double weight = one.V[j] * kernel_value(&kernel, r, one.h[i], dim),
                                     term = weight * (f[j] - difference * f[i]) * (x[j] - x[i]);
                        sum += term, size += fabs(term);
                    }
                    near_below(fabs(one.gradient[k][i] - sum), 1e-13 * size);
                }
        }
}

/* (0.3 + sum c_a (x_a - 0.4))^degree and its slope, c = 1, 2, -1. */
static double polynomial(int degree, size_t i, double slope[3])
{
    static const double c[] = {1, 2, -1};
    double base = 0.3;
    for (int a = 0; a < one.cloud.points.dim; a++) base += c[a] * (one.x[a][i] - 0.4);
    for (int a = 0; a < 3; a++) slope[a] = degree * c[a] * pow(base, degree < 2 ? 0 : degree - 1);
    return pow(base, degree);
}

/* The largest error of these points' gradients of a polynomial. */
static double error_of(const struct operator_form *form, int degree, size_t first, size_t end)
{
    const int dim = one.cloud.points.dim;
    double worst = 0, slope[3];
    for (size_t i = 0; i < one.cloud.points.n; i++)
        one.f[0][i] = polynomial(degree, i, slope), one.f[1][i] = 0;
    apply_well(&one, form);
    for (size_t i = first; i < end; i++) {
        polynomial(degree, i, slope);
        for (int a = 0; one.point[i].condition < 1e3 && a < dim; a++)
            worst = fmax(worst, fabs(one.gradient[a][i] - slope[a]));
    }
    return worst;
}

/* An operator promises what it keeps, no more and no less: polynomials that are exact everywhere,
 * and on a lattice (where, by symmetry, squares are as exact as constants). */
TEST(test_promises)
{
    for (int dim = 1; dim <= 3; dim++)
        for (size_t o = 0; o < operator_family.n; o++) {
            const struct operator_form *form = form_at(o);
            fill(&one, dim, 70, false);
            for (int degree = 0; degree <= 2; degree++) {
                const double error = error_of(form, degree, 0, 70);
                assert_int_equal(error < 1e-10, degree < form->exact);
                assert_true(error < 1e-10 || error > 1e-3);
            }
            const size_t side = dim == 3 ? 5 : 7, n = (size_t)lround(pow((double)side, dim));
            connect(&one, dim, n, false);
            for (size_t i = 0, at = 0; i < n; at = ++i) {
                for (int a = 0; a < dim; a++, at /= side)
                    one.x[a][i] = ((double)(at % side) + 0.5) / (double)side;
                one.V[i] = pow((double)side, -dim), one.h[i] = 2.4 / (double)side;
            }
            for (int degree = 0; degree <= 1; degree++) {
                const double error = error_of(form, degree, n / 2, n / 2 + 1);
                assert_int_equal(error < 1e-10, degree < form->exact_on_lattice);
                assert_true(error < 1e-10 || error > 1e-3);
            }
            assert_true(form->exact_on_lattice <= 2);
        }
}

int main(void)
{
    if (kernel_select(&kernel, "wendland_c4", 5, NULL)) return 1;
    return test_run(NULL, NULL);
}
