/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the library's certificate of a kernel with planted figures, and the messages about kernels
 * with wrong knots, constants, values or dimensions. */
#include "test.h"

#include "property.h"
/* the library's own source, with properties of this file */
#define property_list  planted_list
#define property_count planted_count
extern const struct property planted_list[];
extern const size_t planted_count;
#include "sphproof_kernels.c"

/* ---- planted figures ---- */

static const double values[] = {-1, 0, 0.5, 1, 2, (double)INFINITY, (double)NAN},
                    bounds[] = {0, 1, 1e-9, 1e-5}, floors[] = {0, 0.5, 1, 2, (double)NAN};

struct figure {
    double value, bound, floor;
    bool skipped;
};
static struct figure planted;
static int measured[2];

static void plant(const struct pieces *pieces, struct property_sink *sink)
{
    assert_non_null(pieces);
    measured[0]++;
    sink->take(sink, &(struct finding){.subject = "here",
                                       .value = planted.value,
                                       .bound = planted.bound,
                                       .floor = planted.floor,
                                       .status = planted.skipped
                                                     ? FINDING_SKIP
                                                     : finding_judge(planted.value, planted.bound,
                                                                     planted.floor)});
}

static void plant_good(const struct pieces *pieces, struct property_sink *sink)
{
    assert_non_null(pieces);
    measured[1]++;
    sink->take(sink, &(struct finding){.subject = "there", .bound = 1, .status = FINDING_PASS});
    sink->take(sink,
               &(struct finding){
                   .subject = "elsewhere", .value = 0.25, .bound = 1, .status = FINDING_PASS});
}

const struct property planted_list[] = {{"good", "0 = 0", plant_good}, {"bad", "a = b", plant}};
const size_t planted_count = 2;

static struct sphproof_figure seen[8];
static size_t seen_count;

static void see(void *context, const struct sphproof_figure *figure)
{
    assert_ptr_equal(context, &seen_count);
    assert_true(seen_count < 8);
    seen[seen_count++] = *figure;
}

/* The verdict, computed independently. */
static bool holds(const struct figure *figure, bool single)
{
    const double bound = single && figure->bound > 0 && figure->bound < 1e-6 ? 1e-6 : figure->bound;
    if (figure->skipped) return true;
    if (isnan(figure->value) || isnan(figure->floor)) return false;
    return !(figure->value > bound) && !(figure->floor > bound);
}

TEST(verdicts_on_planted_figures)
{
    struct sphproof_kernel *kernel;
    assert_int_equal(sphproof_kernels_find("cubic_spline", &kernel, NULL), SPHPROOF_OK);
    for (size_t v = 0; v < sizeof values / sizeof *values; v++)
        for (size_t b = 0; b < sizeof bounds / sizeof *bounds; b++)
            for (size_t f = 0; f < sizeof floors / sizeof *floors; f++)
                for (int how = 0; how < 4; how++) {
                    struct sphproof_error error = {.message = ""};
                    planted = (struct figure){values[v], bounds[b], floors[f], how & 1};
                    kernel->single = how & 2;
                    seen_count = 0;
                    const bool well = holds(&planted, kernel->single);
                    const enum sphproof_status status =
                        sphproof_kernels_certify(kernel, 1, see, &seen_count, &error);
                    assert_int_equal(status, well ? SPHPROOF_OK : SPHPROOF_CHECK_FAILED);
                    assert_int_equal(seen_count, 3);
                    for (size_t i = 0; i < 2; i++)
                        assert_true(seen[i].passed && !seen[i].skipped && seen[i].floor == 0 &&
                                    seen[i].bound == 1 && seen[i].value == 0.25 * (double)i);
                    assert_string_equal(seen[2].property, "bad");
                    assert_string_equal(seen[2].formula, "a = b");
                    assert_int_equal(seen[2].passed, well);
                    assert_int_equal(seen[2].skipped, planted.skipped);
                    assert_memory_equal(&seen[2].value, &planted.value, sizeof planted.value);
                    assert_memory_equal(&seen[2].floor, &planted.floor, sizeof planted.floor);
                    assert_true(seen[2].bound ==
                                (kernel->single && bounds[b] == 1e-9 ? 1e-6 : bounds[b]));
                    assert_int_equal(error.status, status);
                    assert_int_equal(strncmp(error.message, well ? "" : "bad: ", 5) == 0, true);
                    assert_int_equal(sphproof_kernels_certify(kernel, 1, NULL, NULL, NULL), status);
                }
    sphproof_kernels_free(kernel);
}

/* Single precision raises bounds below 1e-6 to 1e-6, and changes nothing else. */
TEST(single_precision)
{
    struct sphproof_kernel *kernel;
    assert_int_equal(sphproof_kernels_find("cubic_spline", &kernel, NULL), SPHPROOF_OK);
    for (int single = 0; single < 2; single++) {
        kernel->single = single;
        planted = (struct figure){9e-7, 1e-9, 9e-7, false};
        assert_int_equal(sphproof_kernels_certify(kernel, 2, NULL, NULL, NULL),
                         single ? SPHPROOF_OK : SPHPROOF_CHECK_FAILED);
        planted = (struct figure){1.1e-6, 1e-9, 0, false};
        assert_int_equal(sphproof_kernels_certify(kernel, 2, NULL, NULL, NULL),
                         SPHPROOF_CHECK_FAILED);
        planted = (struct figure){9e-6, 1e-5, 0, false};
        assert_int_equal(sphproof_kernels_certify(kernel, 2, NULL, NULL, NULL), SPHPROOF_OK);
        planted = (struct figure){9e-7, 0, 0, false};
        assert_int_equal(sphproof_kernels_certify(kernel, 2, NULL, NULL, NULL),
                         SPHPROOF_CHECK_FAILED);
    }
    sphproof_kernels_free(kernel);
}

TEST(dimensions)
{
    static const int all[] = {-1, 0, 1, 2, 3, 4};
    struct sphproof_kernel *kernel;
    planted = (struct figure){0, 1, 0, false};
    assert_int_equal(sphproof_kernels_find("wendland_c2", &kernel, NULL), SPHPROOF_OK);
    for (int own = 0; own <= 3; own++)
        for (size_t d = 0; d < sizeof all / sizeof *all; d++) {
            struct sphproof_error error;
            const bool there = all[d] >= 1 && all[d] <= 3 && (own == 0 || own == all[d]);
            kernel->dim = own;
            measured[0] = measured[1] = 0;
            assert_int_equal(sphproof_kernels_certify(kernel, all[d], NULL, NULL, &error),
                             there ? SPHPROOF_OK : SPHPROOF_BAD_INPUT);
            assert_true(measured[0] == there && measured[1] == there);
            char text[100];
            snprintf(text, sizeof text, "kernel wendland_c2: dim = %d is not among its own",
                     all[d]);
            if (!there) assert_string_equal(error.message, text);
        }
    sphproof_kernels_free(kernel);
}

/* ---- shapes ---- */

enum odd { USUAL, NAN_W, NAN_DW, INF_W, INF_DW, NOTHING, HALF_NEGATIVE, TOO_LARGE };
static enum odd odd;
static double odd_at, odd_width;

static double parabola(double q, int dim)
{
    const double a = 1 - q * q;
    (void)dim;
    if (odd == NOTHING) return 0;
    if (odd == HALF_NEGATIVE) return q < 1 ? -a * a * a : 0;
    if (odd == TOO_LARGE) return q < 1 ? 1.5e308 : 0; /* its integral overflows */
    if (odd == NAN_W && fabs(q - odd_at) <= odd_width) return (double)NAN;
    if (odd == INF_W && fabs(q - odd_at) <= odd_width) return (double)INFINITY;
    return q < 1 ? a * a * a : 0;
}

static double parabola_slope(double q, int dim)
{
    const double a = 1 - q * q;
    (void)dim;
    if (odd == NOTHING || odd == TOO_LARGE) return 0;
    if (odd == NAN_DW && fabs(q - odd_at) <= odd_width) return (double)NAN;
    if (odd == INF_DW && fabs(q - odd_at) <= odd_width) return -(double)INFINITY;
    return q < 1 ? (odd == HALF_NEGATIVE ? 6 : -6) * q * a * a : 0;
}

static const struct sphproof_shape usual = {.w = parabola,
                                            .dw = parabola_slope,
                                            .constant = {0, 35. / 32, 4 / M_PI, 315 / (64 * M_PI)},
                                            .smoothness = 2,
                                            .name = "bump"};

static enum sphproof_status own(const struct sphproof_shape *shape, const char *message)
{
    struct sphproof_kernel *kernel = (struct sphproof_kernel *)1;
    struct sphproof_error error = {.message = ""};
    const enum sphproof_status status = sphproof_kernels_own(shape, &kernel, &error);
    assert_int_equal(kernel != NULL, status == SPHPROOF_OK);
    assert_int_equal(error.status, status);
    if (!strstr(error.message, message)) print_error("%s, not %s\n", error.message, message);
    assert_non_null(strstr(error.message, message));
    sphproof_kernels_free(kernel);
    assert_int_equal(sphproof_kernels_own(shape, &kernel, NULL), status);
    sphproof_kernels_free(kernel);
    return status;
}

/* Knots must ascend within ]0, 1[. */
TEST(knots)
{
    static const struct {
        int count, wrong; /* number of the first wrong knot; 0: none */
        double knots[3];
    } rows[] = {
        {0, 0, {0}},
        {1, 0, {0.5}},
        {1, 0, {1e-3}},
        {1, 0, {5e-7}},
        {1, 0, {1 - 1e-3}},
        {2, 0, {0.3, 0.7}},
        {3, 0, {0.2, 0.5, 0.9}},
        {1, 1, {0}},
        {1, 1, {-0.0}},
        {1, 1, {1}},
        {1, 1, {-0.5}},
        {1, 1, {1.5}},
        {1, 1, {(double)NAN}},
        {1, 1, {(double)INFINITY}},
        {1, 1, {-(double)INFINITY}},
        {2, 2, {0.3, 0.3}},
        {2, 2, {0.7, 0.3}},
        {2, 2, {0.5, 1}},
        {2, 1, {0, 0.5}},
        {2, 1, {1, 0.5}},
        {2, 2, {0.5, (double)NAN}},
        {2, 1, {(double)NAN, 0.5}},
        {3, 2, {0.5, 0.2, 0.9}},
        {3, 3, {0.2, 0.5, 0.5}},
        {3, 3, {0.2, 0.9, 0.5}},
        {3, 3, {0.2, 0.5, 1}},
        {-1, 0, {7}}, /* -1: the library finds the knots */
    };
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        struct sphproof_shape shape = usual;
        char text[100] = "";
        shape.dim = 1;
        shape.knots = rows[r].knots;
        shape.knot_count = rows[r].count;
        if (rows[r].wrong)
            snprintf(text, sizeof text, "knot %d of %d is %.17g; allowed: ascending in ]0, 1[",
                     rows[r].wrong, rows[r].count, rows[r].knots[rows[r].wrong - 1]);
        assert_int_equal(own(&shape, text), rows[r].wrong ? SPHPROOF_BAD_INPUT : SPHPROOF_OK);
    }
}

TEST(what_a_shape_needs)
{
    static const double knot = 0.5;
    static const char needs[] = "a kernel needs w, dw, its knots (";
    struct sphproof_shape shape = usual;
    assert_int_equal(own(&shape, ""), SPHPROOF_OK);
    shape.w = NULL;
    assert_int_equal(own(&shape, needs), SPHPROOF_BAD_INPUT);
    shape = usual, shape.dw = NULL;
    assert_int_equal(own(&shape, needs), SPHPROOF_BAD_INPUT);
    shape = usual, shape.knot_count = 1;
    assert_int_equal(own(&shape, needs), SPHPROOF_BAD_INPUT);
    shape.knots = &knot;
    assert_int_equal(own(&shape, ""), SPHPROOF_OK);
    shape.knots = NULL, shape.knot_count = -1;
    assert_int_equal(own(&shape, ""), SPHPROOF_OK);
    for (int dim = -2; dim <= 5; dim++) {
        shape = usual, shape.dim = dim;
        const bool well = dim >= 0 && dim <= 3;
        assert_int_equal(own(&shape, well ? "" : needs), well ? SPHPROOF_OK : SPHPROOF_BAD_INPUT);
    }
}

/* Values that are not finite at the origin, inside and at the edge, in each dimension. */
TEST(values_of_a_shape)
{
    static const double at[] = {0, 0.25, 0.5, 0.75, 1};
    static const enum odd kinds[] = {NAN_W, NAN_DW, INF_W, INF_DW};
    for (size_t k = 0; k < 4; k++)
        for (size_t i = 0; i < 5; i++)
            for (int dim = 0; dim <= 3; dim++) {
                struct sphproof_shape shape = usual;
                odd = kinds[k], odd_at = at[i], odd_width = 0.003;
                shape.dim = dim;
                char text[60];
                snprintf(text, sizeof text, "kernel bump: dim %d, q = ", dim ? dim : 1);
                assert_int_equal(own(&shape, text), SPHPROOF_BAD_INPUT);
            }
    odd = NOTHING;
    assert_int_equal(own(&usual, "kernel bump: dim 1: w is 0 everywhere"), SPHPROOF_BAD_INPUT);
    odd = USUAL;
    struct sphproof_shape shape = usual;
    shape.name = NULL, odd = NOTHING;
    assert_int_equal(own(&shape, "kernel yours: "), SPHPROOF_BAD_INPUT);
    odd = USUAL;
}

/* A constant is declared or computed; it is finite and above 0. */
TEST(constants)
{
    static const double wrong[] = {-1, (double)NAN, (double)INFINITY, -(double)INFINITY};
    for (int dim = 1; dim <= 3; dim++) {
        struct sphproof_shape shape = usual;
        struct sphproof_kernel *kernel;
        char text[60];
        shape.dim = dim;
        for (size_t i = 0; i < 4; i++) {
            shape.constant[dim] = wrong[i];
            snprintf(text, sizeof text, "kernel bump: dim %d: the constant is ", dim);
            assert_int_equal(own(&shape, text), SPHPROOF_BAD_INPUT);
        }
        shape.constant[dim] = 0;
        assert_int_equal(sphproof_kernels_own(&shape, &kernel, NULL), SPHPROOF_OK);
        assert_true(fabs(sphproof_kernels_value(kernel, 0, 1, dim) / usual.constant[dim] - 1) <
                    1e-10);
        sphproof_kernels_free(kernel);
        shape.constant[dim] = 2 * usual.constant[dim]; /* the declared constant is used */
        assert_int_equal(sphproof_kernels_own(&shape, &kernel, NULL), SPHPROOF_OK);
        assert_true(sphproof_kernels_value(kernel, 0, 1, dim) == 2 * usual.constant[dim]);
        sphproof_kernels_free(kernel);
    }
    struct sphproof_shape shape = usual;
    memset(shape.constant, 0, sizeof shape.constant);
    odd = HALF_NEGATIVE;
    assert_int_equal(own(&shape, "the constant is -"), SPHPROOF_BAD_INPUT);
    odd = TOO_LARGE;
    assert_int_equal(own(&shape, "the constant is 0; allowed: above 0"), SPHPROOF_BAD_INPUT);
    odd = USUAL;
}

/* Declared values reach the properties; a class that is not declared is measured. */
TEST(what_is_declared)
{
    for (int how = 0; how < 16; how++) {
        struct sphproof_shape shape = usual;
        struct sphproof_kernel *kernel;
        const int declared = how & 8 ? 1 : 0;
        shape.dim = 2;
        shape.negative = how & 1, shape.single = how & 2;
        shape.smoothness = how & 4 ? -1 : declared;
        assert_int_equal(sphproof_kernels_own(&shape, &kernel, NULL), SPHPROOF_OK);
        const struct terms terms = terms_of(kernel, 77);
        assert_int_equal(terms.negative, how & 1);
        assert_int_equal(terms.single, (how & 2) != 0);
        assert_int_equal(terms.class_found, (how & 4) != 0);
        assert_int_equal(terms.samples, 77);
        assert_int_equal(kernel->kernel.smoothness[2], how & 4 ? 2 : declared);
        sphproof_kernels_free(kernel);
    }
}

static int power;

static double edge(double q, int dim)
{
    (void)dim;
    return q < 1 ? pow(1 - q * q, power) : 0;
}

static double edge_slope(double q, int dim)
{
    (void)dim;
    return q < 1 && power ? -2 * power * q * pow(1 - q * q, power - 1) : 0;
}

/* (1 - q^2)^p has p - 1 continuous derivatives at its edge; a jump counts as 0. */
TEST(measured_classes)
{
    for (power = 0; power <= 4; power++) {
        const struct sphproof_shape shape = {
            .w = edge, .dw = edge_slope, .smoothness = -1, .dim = 1};
        struct sphproof_kernel *kernel;
        struct sphproof_error error = {.message = ""};
        if (sphproof_kernels_own(&shape, &kernel, &error)) fail_msg("%s", error.message);
        assert_int_equal(kernel->kernel.smoothness[1], power ? power - 1 : 0);
        sphproof_kernels_free(kernel);
    }
}

static void own_handler(const char *reason, const char *file, int line, int code)
{
    (void)reason, (void)file, (void)line, (void)code;
}

/* The user's handler of errors stays. */
TEST(error_handler)
{
    gsl_error_handler_t *const before = gsl_set_error_handler(own_handler);
    struct sphproof_kernel *kernel;
    assert_int_equal(sphproof_kernels_find("wendland_c2", &kernel, NULL), SPHPROOF_OK);
    sphproof_kernels_certify(kernel, 1, NULL, NULL, NULL);
    assert_true(gsl_set_error_handler(before) == own_handler);
    sphproof_kernels_free(kernel);
}

/* W, dW/dr and dW/dh of a plug-in and of a built-in kernel, from w and dw. */
TEST(values_and_slopes)
{
    static const double r[] = {0, 0.3, 1, 1.9, 2, 2.5}, h = 2;
    struct sphproof_kernel *kernel;
    assert_int_equal(sphproof_kernels_own(&usual, &kernel, NULL), SPHPROOF_OK);
    for (int dim = 1; dim <= 3; dim++)
        for (size_t i = 0; i < sizeof r / sizeof *r; i++) {
            const double q = r[i] / h, unit = usual.constant[dim] / pow(h, dim);
            const double w = parabola(q, dim), dw = parabola_slope(q, dim);
            assert_true(fabs(sphproof_kernels_value(kernel, r[i], h, dim) - unit * w) < 1e-15);
            assert_true(fabs(sphproof_kernels_dr(kernel, r[i], h, dim) - unit / h * dw) < 1e-15);
            assert_true(fabs(sphproof_kernels_dh(kernel, r[i], h, dim) +
                             unit / h * (dim * w + q * dw)) < 1e-15);
        }
    sphproof_kernels_free(kernel);
    assert_int_equal(sphproof_kernels_find("sinc", &kernel, NULL), SPHPROOF_OK);
    assert_true(kernel->negative && kernel->kernel.order == 5);
    sphproof_kernels_free(kernel);
    assert_int_equal(sphproof_kernels_find("cubic_spline", &kernel, NULL), SPHPROOF_OK);
    assert_false(kernel->negative);
    sphproof_kernels_free(kernel);
    static const char *const none[] = {NULL, "", "cubic", "Cubic_spline"};
    for (size_t i = 0; i < 4; i++) {
        struct sphproof_error error = {.message = ""};
        assert_int_equal(sphproof_kernels_find(none[i], &kernel, &error), SPHPROOF_BAD_INPUT);
        assert_true(kernel == NULL && error.status == SPHPROOF_BAD_INPUT);
        assert_non_null(strstr(error.message, "cubic_spline"));
        assert_int_equal(sphproof_kernels_find(none[i], &kernel, NULL), SPHPROOF_BAD_INPUT);
    }
}
