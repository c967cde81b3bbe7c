/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests how the pieces of a kernel are found from its values alone: break points of every class,
 * alone and close together, singular points, rounding errors; the series on the pieces, the jumps
 * between them, and the places where faults are looked for. */
#include "test.h"

#include <float.h>

#include "measure.h"
#include "own_folder.h"
#include "places.h"

/* ---- kernels with break points that a test sets ---- */

enum { MOST = 4 };

/* (1 - q)^4 (1 + 4 q), of class C2, and for each bump a (q - at)^power behind `at`, up to the edge.
 */
static struct {
    struct {
        double at, power, a;
    } bump[MOST];
    bool both;          /* the bumps are on both sides of `at` */
    double edge;        /* times (1 - q)^(3/2) */
    bool single;        /* rounded to float */
    double noise, dead; /* relative noise; w is NaN beyond this q, 0: nowhere */
} set;

static double noise(double q)
{
    return set.noise * (2 * places_random(7, (uint64_t)(q * 0x1p50)) - 1);
}

static double rounded(double value, double q)
{
    value *= 1 + noise(q);
    if (set.dead > 0 && q > set.dead) return (double)NAN;
    return set.single ? (double)(float)value : value;
}

static double shape_w(const struct kernel *kernel, double q, int dim)
{
    (void)kernel, (void)dim;
    if (q >= 1) return 0;
    double w = pow(1 - q, 4) * (1 + 4 * q) + set.edge * pow(1 - q, 1.5);
    for (int i = 0; i < MOST; i++)
        if (q > set.bump[i].at || set.both)
            w += set.bump[i].a * pow(fabs(q - set.bump[i].at), set.bump[i].power);
    return rounded(w, q);
}

static double shape_dw(const struct kernel *kernel, double q, int dim)
{
    (void)kernel, (void)dim;
    if (q >= 1) return 0;
    double dw = -20 * q * pow(1 - q, 3) - set.edge * 1.5 * sqrt(1 - q);
    for (int i = 0; i < MOST; i++)
        if ((q > set.bump[i].at || set.both) && set.bump[i].a != 0)
            dw += (q > set.bump[i].at ? 1 : -1) * set.bump[i].a * set.bump[i].power *
                  pow(fabs(q - set.bump[i].at), set.bump[i].power - 1);
    return rounded(dw, q);
}

static struct kernel made(void)
{
    return (struct kernel){.member = {"made", "", ""},
                           .w = shape_w,
                           .dw = shape_dw,
                           .constant = {0, 1.5, 7 / M_PI, 10.5 / M_PI},
                           .knot_count = -1};
}

static void find(struct pieces *pieces, const struct kernel *kernel, int dim, bool single)
{
    struct terms terms = pieces_terms_usual;
    terms.single = single;
    assert_int_equal(pieces_find(pieces, kernel, dim, &terms, NULL), STATUS_OK);
}

/* ---- break points ---- */

TEST(break_points)
{
    static const struct {
        double at[MOST], power[MOST];
        int n; /* number of break points within: of the first bumps */
    } rows[] = {{{0}, {0}, 0},
                {{0.4}, {0}, 1},
                {{0.6}, {0}, 1},
                {{0.4}, {1}, 1},
                {{0.4, 0.4}, {0, 1}, 1},
                {{0.123, 0.7, 0.123}, {0, 1, 2}, 2},
                {{0.4}, {2}, 1},
                {{0.4}, {3}, 1},
                {{1. / 3}, {4}, 1},
                {{0.7}, {5}, 1},
                {{0.3, 0.7}, {2, 3}, 2},
                {{0.5, 0.52}, {3, 3}, 2},
                {{0.123, 0.5, 0.9}, {2, 4, 3}, 3}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int dim = 1; dim <= 3; dim++)
            for (int declared = 0; declared < 2; declared++) {
                struct kernel kernel = made();
                struct pieces pieces;
                struct measure_class class;
                memset(&set, 0, sizeof set);
                for (int i = 0; i < MOST; i++)
                    set.bump[i].at = rows[k].at[i], set.bump[i].power = rows[k].power[i],
                    set.bump[i].a = !(rows[k].at[i] > 0) ? 0
                                    : k == 2             ? 1e-11
                                                         : 1;
                if (declared) kernel.knots = rows[k].at, kernel.knot_count = rows[k].n;
                find(&pieces, &kernel, dim, false);
                if (pieces.n != rows[k].n + 1) {
                    for (int i = 0; i <= pieces.n; i++) print_error("%.17g\n", pieces.edge[i]);
                    fail_msg("row %zu, %d: %d pieces", k, declared, pieces.n);
                }
                assert_true(pieces.resolved && !pieces_look_single(&pieces));
                assert_true(pieces.edge[0] == 0 && pieces.edge[pieces.n] == 1);
                for (int i = 0; i <= pieces.n; i++)
                    assert_true(pieces.declared[i] == (declared || i == 0 || i == pieces.n));
                for (int i = 0; i < rows[k].n; i++) {
                    const double off = fabs(pieces.edge[i + 1] - rows[k].at[i]),
                                 doubt = pieces.doubt[i + 1];
                    if (!(off <= (declared ? 0 : 1e-12) && off <= 1e-15 + doubt &&
                          doubt <= (declared ? 0 : 1e-10)))
                        fail_msg("row %zu: off %g, doubt %g", k, off, doubt);
                }
                measure_class(&pieces, &class);
                assert_int_equal(class.class, rows[k].n ? -1 : 2); /* bumps do not end at 0 */
                assert_int_equal(class.extra, declared ? 0 : rows[k].n);
                if (class.extra) near_absolute(class.extra_at, rows[k].at[0], 1e-12);
                if (rows[k].n)
                    near_absolute(class.at, rows[k].power[0] == 0 ? rows[k].at[0] : 1, 1e-12);
                pieces_free(&pieces);
            }
}

/* A piece between declared knots stays, however short it is and whatever is in it. */
TEST(close_knots)
{
    static const double knots[] = {0.4, 0.4 + 8e-12};
    struct kernel kernel = made();
    struct pieces pieces;
    memset(&set, 0, sizeof set);
    set.bump[0].at = 0.4 + 3e-12, set.bump[0].a = 1;
    kernel.knots = knots, kernel.knot_count = 2;
    find(&pieces, &kernel, 1, false);
    assert_true(pieces.n == 3 && pieces.edge[1] == knots[0] && pieces.edge[2] == knots[1]);
    assert_false(pieces.resolved);
    pieces_free(&pieces);
}

/* Splines whose knots are not declared, and mistakes too small to be intended. */
TEST(classes)
{
    static const struct {
        const char *name;
        int n, class;
        double knots[2];
    } rows[] = {{"quadratic_spline", 2, 1, {1. / 3}},
                {"cubic_spline", 2, 2, {0.5}},
                {"quartic_spline", 3, 3, {0.2, 0.6}},
                {"quintic_spline", 3, 4, {1. / 3, 2. / 3}},
                {"wendland_c6", 1, 6, {0}}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int dim = rows[k].n == 1 ? 2 : 1; dim <= 3; dim++) {
            struct kernel kernel;
            struct pieces pieces;
            struct measure_class class;
            assert_int_equal(kernel_select(&kernel, rows[k].name, 5, NULL), STATUS_OK);
            kernel.knot_count = -1;
            find(&pieces, &kernel, dim, false);
            assert_int_equal(pieces.n, rows[k].n);
            for (int i = 1; i < pieces.n; i++)
                near_absolute(pieces.edge[i], rows[k].knots[i - 1], 1e-11);
            measure_class(&pieces, &class);
            assert_int_equal(class.class, rows[k].class);
            assert_int_equal(class.accident.count, 0);
            assert_int_equal(measure_class_limit(&pieces), MEASURE_CLASS_MAX);
            pieces_free(&pieces);
        }
    for (int k = 0; k < 3; k++) {
        const bool large = k == 1, first = k == 2; /* the larger one comes first */
        const struct kernel kernel = made();
        struct pieces pieces;
        struct measure_class class;
        const double size = large ? 1.1e-4 : 0.9e-4;
        memset(&set, 0, sizeof set);
        set.bump[0].at = first ? 0.7 : 0.4, set.bump[0].power = 2;
        set.bump[1].at = first ? 0.4 : 0.7, set.bump[1].power = 2;
        set.bump[1].a = size * 2.109375 / 2; /* of the largest |dw| */
        set.bump[0].a = set.bump[1].a / 8;
        find(&pieces, &kernel, 1, false);
        near_relative(pieces.max_dw, 2.109375, 1e-4);
        measure_class(&pieces, &class);
        assert_int_equal(class.extra, 2);
        assert_int_equal(class.accident.count, large ? 1 : 2);
        near_absolute(class.accident.at, large || first ? 0.4 : 0.7, 1e-6);
        near_relative(class.accident.jump, large ? size / 8 : size, 1e-3);
        assert_int_equal(class.accident.k, 2);
        pieces_free(&pieces);
    }
}

static double flat(const struct kernel *kernel, double q, int dim)
{
    (void)kernel, (void)dim;
    return q < 1;
}

static double nothing(const struct kernel *kernel, double q, int dim)
{
    (void)kernel, (void)q, (void)dim;
    return 0;
}

/* A top hat, of which no value has an error. */
TEST(constant)
{
    struct kernel kernel = made();
    struct pieces pieces;
    kernel.w = flat, kernel.dw = nothing;
    find(&pieces, &kernel, 3, false);
    assert_true(pieces.n == 1 && pieces.resolved && pieces.noise_dw == 0 && pieces.max_w == 1);
    near_relative(measure_constant(&pieces), 3 / (4 * M_PI), 1e-14);
    pieces_free(&pieces);
}

/* Pieces shrink towards a singular point by factors of 4 or 8, down to where it makes no
 * difference. */
TEST(singular_points)
{
    static const double at[] = {0, 0.4, 0.4, 0.375, 1, 0.4}; /* the last one is declared */
    for (int k = 0; k < 6; k++) {
        struct kernel kernel = made();
        struct pieces pieces;
        double nearest = 1;
        memset(&set, 0, sizeof set);
        set.bump[0].at = at[k], set.bump[0].power = 1.5, set.bump[0].a = k != 4;
        set.both = k > 1, set.edge = k == 4;
        if (k == 5) kernel.knots = &at[5], kernel.knot_count = 1;
        find(&pieces, &kernel, 1, false);
        assert_true(pieces.edge[0] == 0 && pieces.edge[pieces.n] == 1);
        if (pieces.n >= 150) fail_msg("%g: %d pieces", at[k], pieces.n);
        for (int i = 1; i < pieces.n; i++) {
            assert_true(pieces.edge[i] > pieces.edge[i - 1]);
            nearest = fmin(nearest, fabs(pieces.edge[i] - at[k]));
        }
        if (k == 0) assert_true(pieces.n == 16 && pieces.edge[1] == 0x1p-34);
        for (int i = 1; i < pieces.n && k == 0; i++)
            assert_true(pieces.edge[i + 1] == (i < 5 ? 8 : 4) * pieces.edge[i]);
        for (int i = 1; i < pieces.n && k == 0; i++) /* nothing there is refined */
            near_relative(pieces.doubt[i],
                          0.2 * fmin(pieces.edge[i] - pieces.edge[i - 1],
                                     pieces.edge[i + 1] - pieces.edge[i]),
                          1e-12);
        if (k == 1) assert_int_equal(pieces.n, 8); /* beside a smooth left side it is seen late */
        if (k > 1) near_below(nearest, k == 5 ? 0 : 1e-8);
        pieces_free(&pieces);
    }
}

/* ---- rounding errors ---- */

TEST(rounding_errors)
{
    static const struct {
        bool rounds, single; /* the values to float; the terms */
        double noise;
        bool looks, resolved;
        int n;
    } rows[] = {{false, false, 0, false, true, 1},      {true, false, 0, true, false, 32},
                {true, true, 0, true, true, 1},         {false, false, 1e-11, false, false, 32},
                {false, false, 1e-3, false, false, 32}, {false, true, 1e-7, true, true, 1}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct kernel kernel = made();
        struct pieces pieces;
        memset(&set, 0, sizeof set);
        set.single = rows[k].rounds, set.noise = rows[k].noise;
        find(&pieces, &kernel, 2, rows[k].single);
        assert_int_equal(pieces.n, rows[k].n);
        assert_int_equal(pieces_look_single(&pieces), rows[k].looks);
        assert_int_equal(pieces.resolved, rows[k].resolved);
        assert_int_equal(measure_class_limit(&pieces),
                         rows[k].looks || rows[k].single ? 2 : MEASURE_CLASS_MAX);
        for (int i = 0; i <= pieces.n; i++)
            near_absolute(pieces.edge[i], (double)i / pieces.n, 1e-15);
        pieces_free(&pieces);
    }
}

/* ---- series ---- */

/* The series of a polynomial is that polynomial, of which it has no more terms. */
TEST(series)
{
    const struct kernel kernel = made();
    struct pieces pieces;
    memset(&set, 0, sizeof set);
    find(&pieces, &kernel, 1, false);
    for (int degree = 0; degree <= 12; degree++) {
        struct series_fit fit;
        double values[PIECES_NODES], floor;
        for (int j = 0; j < PIECES_NODES; j++) {
            assert_true(fabs(pieces.node[j]) < 1);
            values[j] = 3 * cos(degree * acos(pieces.node[j])) + 0.5;
        }
        pieces_fit(&pieces, values, &fit);
        assert_int_equal(fit.n, degree + 1);
        assert_int_equal(fit.reach, degree + 3);
        near_inside(fit.noise, DBL_EPSILON, 20 * DBL_EPSILON);
        for (int k = 0; k < PIECES_NODES; k++)
            near_absolute(fit.c[k], (k == degree ? 3 : 0) + (k == 0 ? 0.5 : 0), 1e-14);
        for (double x = -0.95; x < 1; x += 0.1) {
            const double a = acos(x);
            near_absolute(pieces_series_value(&fit, x), 3 * cos(degree * a) + 0.5, 1e-13);
            near_absolute(pieces_series_slope(&fit, x, &floor),
                          3 * degree * sin(degree * a) / sin(a), 1e-12 * (1 + degree * degree));
            near_inside(floor, fit.noise, fit.noise * 3 * pow(degree + 3, 3));
        }
        values[7] = degree % 2 ? (double)INFINITY : (double)NAN; /* no number makes others */
        pieces_fit(&pieces, values, &fit);
        assert_true(isnan(fit.noise) && isnan(fit.c[0]) && isnan(fit.c[PIECES_NODES - 1]));
    }
    /* one-sided derivatives of w = 1 - 10 q^2 + 20 q^3 - 15 q^4 + 4 q^5 */
    static const double origin[] = {1, 0, -20, 120, -360, 480}, edge[] = {0, 0, 0, 0, 120, 480};
    for (int k = 0; k <= 5; k++)
        for (int end = 0; end < 2; end++) {
            double floor;
            const double found = pieces_derivative(&pieces, end, 1 - end, k, &floor);
            near_below(fabs(found - (end ? edge[k] : origin[k])), 1e-14 + 20 * floor);
            near_below(floor, 1e-15 * pow(30, k));
        }
    pieces_free(&pieces);
}

/* ---- places ---- */

static bool has_place(const struct pieces *pieces, double q)
{
    for (int i = 0; i < pieces->place_count; i++)
        if (pieces->places[i] == q) return true;
    return false;
}

TEST(places)
{
    static const double constants[] = {0.3141, 0.36};
    struct kernel kernel = made();
    struct pieces pieces;
    struct terms terms = pieces_terms_usual;
    const double knot = 0.123456,
                 there[] = {0,           0.001,        0.999,      1. / 64,         63. / 64,
                            2. / 3,      0.3141,       1 - 0.3141, sqrt(0.3141),    0.36,
                            0.36 + 1e-6, 0.36 - 1e-16, 0.123456,   0.123456 + 1e-9, 1e-16,
                            1 - 1e-6};
    memset(&set, 0, sizeof set);
    kernel.knots = &knot, kernel.knot_count = 1;
    terms.constants = constants, terms.constant_count = 2;
    assert_int_equal(pieces_find(&pieces, &kernel, 1, &terms, NULL), STATUS_OK);
    assert_true(pieces.places[0] == 0);
    for (int i = 1; i < pieces.place_count; i++)
        assert_true(pieces.places[i] > pieces.places[i - 1] && pieces.places[i] < 1);
    for (size_t k = 0; k < sizeof there / sizeof *there; k++)
        if (!has_place(&pieces, there[k])) fail_msg("%.17g is missing", there[k]);
    assert_false(has_place(&pieces, 1. / 65) || has_place(&pieces, 0.123456 + 1e-5) ||
                 has_place(&pieces, 0.0005));
    pieces_free(&pieces);
}

/* The numbers between 0 and 1 in a file, doubles at any byte and floats at every fourth. */
TEST(constants_of_a_file)
{
    unsigned char bytes[200] = {0};
    const double doubles[] = {0.3141, -0.2718, 1.5, 1e-10, 0.577, 2e-9};
    const float single = 0.625f;
    static const size_t at[] = {8, 16, 24, 32, 43, 56};
    double *found;
    for (int k = 0; k < 6; k++) memcpy(bytes + at[k], &doubles[k], 8);
    memcpy(bytes + 100, &single, 4);
    memcpy(bytes + 110, &single, 4); /* at no fourth byte */
    memcpy(bytes + 192, &doubles[0], 8);
    FILE *out = fopen(path_of("constants"), "wb");
    assert_true(fwrite(bytes, 1, sizeof bytes, out) == sizeof bytes && fclose(out) == 0);
    const int n = places_constants(path_of("constants"), &found);
    bool all[5] = {false};
    for (int i = 0; i < n; i++) {
        assert_true(found[i] > 1e-9 && found[i] < 1 && (i == 0 || found[i] > found[i - 1]));
        all[0] |= found[i] == 0.3141, all[1] |= found[i] == 0.2718;
        all[2] |= found[i] == 0.577, all[3] |= found[i] == 0.625, all[4] |= found[i] == 2e-9;
    }
    for (int k = 0; k < 5; k++) assert_true(all[k]);
    free(found);
    static unsigned char many[8 * 5001]; /* floats, and one aligned double at the end */
    for (int k = 0; k < 5000; k++) {
        const float value = 0.008f + 4e-6f * (float)k;
        memcpy(many + 8 * k + 4, &value, 4);
    }
    memcpy(many + sizeof many - 8, &doubles[0], 8);
    out = fopen(path_of("constants"), "wb");
    assert_true(fwrite(many, 1, sizeof many, out) == sizeof many && fclose(out) == 0);
    const int most = places_constants(path_of("constants"), &found);
    near_inside(most, 4000, PLACES_CONSTANTS_MAX);
    bool there = false;
    for (int i = 0; i < most; i++) there |= found[i] == 0.3141;
    assert_true(there);
    free(found);
    assert_int_equal(places_constants(path_of("nothing"), &found), 0);
    free(found);
}

/* Random numbers of any seed are even, and the same every time. */
TEST(random_places)
{
    double sum = 0, squares = 0;
    for (uint64_t i = 0; i < 10000; i++) {
        const double q = places_random(3, i);
        assert_true(q >= 0 && q < 1 && q == places_random(3, i) && q != places_random(4, i));
        sum += q, squares += q * q;
    }
    near_absolute(sum / 10000, 0.5, 0.01);
    near_absolute(squares / 10000, 1. / 3, 0.01);
    assert_true(places_random(0, 0) ==
                (double)(0xe220a8397b1dcdafu >> 11) * 0x1p-53); /* Steele et al. */
}
