/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests gradient operators at the limits of double precision: clouds in extreme units, one extreme
 * quantity, results that overflow, and the messages about clouds that are refused. */
#include "test.h"

#include <float.h>

#include "draw.h"
#include "operator.h"

enum { POINTS_MAX = 200, FIELDS = 2 };

static struct kernel kernel;

/* A cloud with fields and its results; a sentinel follows the last point of each array. */
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

/* The cloud in units of 2^length, its volumes in units of 2^volume, each field in its own unit. */
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

/* The state of point i in these units: that of the first gradient that over- or underflows. */
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

/* Compares every bit. Returns the number of states that are not OK. */
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

/* Units of length, volume and fields, extreme alone or together, change no bit. */
TEST(other_units)
{
    static const struct {
        int length, volume, field[FIELDS];
    } units[] = {
        {-30, 0, {0, 0}},        {-30, -90, {7, -9}},       {0, -1012, {0, 0}},
        {-260, 0, {-120, -120}}, {10, 100, {1000, 0}},      {10, 100, {0, 1000}},
        {10, -100, {-1000, 0}},  {10, -100, {0, -1000}},    {300, 900, {0, 0}},
        {-300, -900, {90, -90}}, {-250, 0, {-1000, -1000}}, {100, 100, {1000, -1000}},
        {0, 1000, {0, 0}},       {-120, 120, {100, -100}},  {120, -120, {-100, 100}},
        {500, 500, {400, 400}},  {-990, -990, {-400, 400}},
    };
    for (int dim = 1; dim <= 3; dim++)
        for (int periodic = 0; periodic < 2; periodic++)
            for (size_t o = 0; o < operator_family.n; o++) {
                fill(&one, dim, 70, periodic);
                if (!periodic) { /* a point without neighbours, and a constant field */
                    one.x[0][5] = 9;
                    for (size_t i = 0; i < 70; i++) one.f[1][i] = 0.375;
                }
                apply_well(&one, form_at(o));
                for (size_t u = 0; u < sizeof units / sizeof *units; u++)
                    same_in(units[u].length, units[u].volume, units[u].field, form_at(o));
            }
}

/* The smallest normal number counts as normal. */
TEST(smallest_normal_number)
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

static void refused(const char *message)
{
    struct error error;
    one.pairs = 99;
    assert_int_equal(apply(&one, form_at(1), &error), STATUS_BAD_INPUT);
    assert_string_equal(error.message, message);
    assert_true(one.pairs == 0);
    assert_int_equal(apply(&one, form_at(1), NULL), STATUS_BAD_INPUT);
}

TEST(refusals)
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
    one.V[19] = 1e300; /* in other units the same value is refused */
    assert_int_equal(apply(&one, form_at(1), &error), STATUS_BAD_INPUT);
    one.x[1][19] = 0.5, one.h[19] = 8.5;
    assert_int_equal(apply(&one, form_at(1), &error), STATUS_BAD_INPUT);
}

static int select_kernel(void **state)
{
    (void)state;
    return kernel_select(&kernel, "wendland_c4", 5, NULL) != STATUS_OK;
}

TEST_BETWEEN(select_kernel, NULL);
