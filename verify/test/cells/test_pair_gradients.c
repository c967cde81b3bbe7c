/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gradients of pairs in 2D and 3D, lane by lane, against their formulas in extended precision:
 * every gradient at every width, with matrices that are not to be used and shares of the standard
 * gradient. What lies behind the pairs, and what nobody asked for, stays as it is. */
#include "test.h"

#include "draw.h"

#include "cells/lanes.h"
#include "cells/pairs.h"

typedef long double real;

enum { COUNT = 24, STRIDE = 40, RECORD_MAX = 64 };

/* What stands in an array before anything is written to it. */
static double untouched(int array)
{
    return 1234 + 0.5 * array;
}

/* One particle and its neighbours. */
static struct drawn {
    struct cells_method method;
    struct kernel kernel;
    struct cells *cells;
    double block[(LANES_OWN + RECORD_MAX) * STRIDE], record[RECORD_MAX];
    struct lanes lanes;
    struct pairs pairs;
} drawn;

/* Which matrices are not to be used, and who has a share of the standard gradient. */
enum { SOUND, OWN_UNSOUND, ONE_UNSOUND, LAST_UNSOUND };
enum { NONE_STEEP, OWN_STEEP, LAST_STEEP, ALL_STEEP };

static double *theirs(enum lanes_field field)
{
    return drawn.block + (LANES_OWN + drawn.cells->force.offset[field]) * STRIDE;
}

static double *own(enum lanes_field field)
{
    return drawn.record + drawn.cells->force.offset[field];
}

static void draw_matrix(int dim, double *first, ptrdiff_t stride, bool sound)
{
    for (int k = 0; k < dim * (dim + 1) / 2; k++)
        first[k * stride] = !sound ? 0 : k == 0 ? draw(0.1, 2) : draw(-1, 2);
}

static void draw_pairs(int unsound, int steep)
{
    const int dim = drawn.method.box.dim;
    for (int k = 0; k < (LANES_OWN + RECORD_MAX) * STRIDE; k++)
        drawn.block[k] = untouched(k / STRIDE);
    drawn.lanes = (struct lanes){.block = drawn.block, .stride = STRIDE};
    drawn.pairs = (struct pairs){.count = COUNT,
                                 .neighbours = COUNT,
                                 .lanes = &drawn.lanes,
                                 .layout = &drawn.cells->force,
                                 .record = drawn.record};
    *own(RECORD_H_INVERSE) = draw(0.8, 1.5);
    for (int k = 0; k < COUNT; k++) {
        real r2 = 0;
        for (int a = 0; a < dim; a++) {
            double *x = lane(&drawn.lanes, LANE_DX + a) + k;
            *x = k == 5 ? 0 : draw(-0.9, 0.9);
            r2 += (real)*x * *x;
        }
        lane(&drawn.lanes, LANE_R)[k] = (double)sqrtl(r2);
        lane(&drawn.lanes, LANE_R_INVERSE)[k] = r2 > 0 ? 1 / (double)sqrtl(r2) : 0;
        theirs(RECORD_H_INVERSE)[k] = draw(0.8, 1.5);
    }
    if (drawn.method.gradient == GRADIENT_STANDARD) return;
    draw_matrix(dim, own(RECORD_MATRIX), 1, unsound != OWN_UNSOUND);
    for (int k = 0; k < COUNT; k++)
        draw_matrix(dim, theirs(RECORD_MATRIX) + k, STRIDE,
                    !(unsound == ONE_UNSOUND && k == 9) &&
                        !(unsound == LAST_UNSOUND && k == COUNT - 1));
    if (drawn.method.gradient != GRADIENT_BLENDED) return;
    *own(RECORD_STEEP) = steep == OWN_STEEP || steep == ALL_STEEP ? draw(0, 1) : 0;
    for (int k = 0; k < COUNT; k++)
        theirs(RECORD_STEEP)[k] =
            steep == ALL_STEEP || (steep == LAST_STEEP && k == COUNT - 1) ? draw(0, 1) : 0;
}

/* 1/h that the pair's gradient at one particle is taken at. */
static double width_at(double mine, double other)
{
    switch (drawn.method.pair_width) {
    case PAIR_WIDTH_MEAN:
        return mine;
    case PAIR_WIDTH_MAX:
        return fmin(mine, other);
    default:
        return 0.5 * (mine + other);
    }
}

/* The negative gradient of pair k along axis a at the width of one particle, with its matrix:
 * standard, and as the method has it where that is not fallen back on. */
static void gradient_at(int k, int a, double h_inverse, const double *C, ptrdiff_t stride,
                        real found[2])
{
    static const int place[2][3][3] = {{{0, 1}, {1, 2}}, {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};
    const struct kernel *kernel = &drawn.kernel;
    const int dim = drawn.method.box.dim;
    const double r = lane(&drawn.lanes, LANE_R)[k], q = r * h_inverse;
    const real slope = r > 0 ? kernel->dw(kernel, q, dim) : 0;
    const real s = r > 0 ? kernel->constant[dim] * powl(h_inverse, dim + 1) * slope / r : 0;
    const real weight = drawn.method.gradient != GRADIENT_CORRECTED ? kernel->w(kernel, q, dim)
                        : r > 0                                     ? -slope / q
                                                                    : 0;
    found[0] = s * lane(&drawn.lanes, LANE_DX + a)[k];
    found[1] = 0;
    for (int b = 0; C && b < dim; b++)
        found[1] -= C[place[dim - 2][a][b] * stride] * weight * lane(&drawn.lanes, LANE_DX + b)[k];
}

static void near_lane(int which, int k, real expected, real size)
{
    const double found = lane(&drawn.lanes, which)[k];
    near_below((double)fabsl(found - expected), 1e-13 * (double)(1 + size));
}

static void check_pair(int k)
{
    const struct cells_method *method = &drawn.method;
    const bool both = method->formulation == FORMULATION_LAGRANGIAN,
               matrix = method->gradient != GRADIENT_STANDARD,
               blended = method->gradient == GRADIENT_BLENDED;
    const double *C = matrix ? own(RECORD_MATRIX) : NULL,
                 *C_j = matrix ? theirs(RECORD_MATRIX) + k : NULL;
    const bool used = matrix && C[0] > 0 && C_j[0] > 0;
    const real part = !used     ? 1
                      : blended ? ((real)*own(RECORD_STEEP) + theirs(RECORD_STEEP)[k]) / 2
                                : 0;
    const double mine = *own(RECORD_H_INVERSE), other = theirs(RECORD_H_INVERSE)[k];
    for (int a = 0; a < method->box.dim; a++) {
        real at_i[2], at_j[2];
        gradient_at(k, a, width_at(mine, other), C, 1, at_i);
        gradient_at(k, a, width_at(other, mine), C_j, STRIDE, at_j);
        const real G_i = (1 - part) * at_i[1] + part * at_i[0],
                   G_j = (1 - part) * at_j[1] + part * at_j[0], size = fabsl(G_i) + fabsl(G_j);
        near_lane(LANE_GX + a, k, (G_i + G_j) / 2, size);
        if (!both) continue;
        near_lane(LANE_GX_I + a, k, G_i, size);
        near_lane(LANE_GX_J + a, k, G_j, size);
    }
}

static bool is_untouched(int array)
{
    bool all = true;
    for (int k = 0; k < COUNT; k++) all &= drawn.block[array * STRIDE + k] == untouched(array);
    return all;
}

/* Nothing is written behind the pairs, and no arrays but those that are wanted: standard gradients
 * are not made where all matrices are used alone, nor one by one where their means are enough. */
static void check_rest(int unsound, int steep)
{
    const struct cells_method *method = &drawn.method;
    const bool both = method->formulation == FORMULATION_LAGRANGIAN,
               standard = method->gradient == GRADIENT_STANDARD;
    for (int f = 0; f < LANES_OWN + RECORD_MAX; f++)
        for (int k = COUNT; k < STRIDE; k++)
            assert_true(drawn.block[f * STRIDE + k] == untouched(f));
    for (int f = LANE_GX_I; f < LANES_OWN && !both; f++) assert_true(is_untouched(f));
    for (int a = method->box.dim; a < 3; a++) assert_true(is_untouched(LANE_GX + a));
    const bool single = standard ? both || method->pair_width != PAIR_WIDTH_MEAN
                                 : unsound != SOUND || steep != NONE_STEEP;
    assert_int_equal(is_untouched(LANE_SPARE), !single);
    assert_int_equal(is_untouched(LANE_K), standard || !single);
}

static void check(int unsound, int steep)
{
    draw_pairs(unsound, steep);
    cells_pair_gradients(drawn.cells, &drawn.pairs);
    for (int k = 0; k < COUNT; k++) check_pair(k);
    check_rest(unsound, steep);
}

static void make(int dim, enum gradient gradient, enum pair_width width,
                 enum formulation formulation, bool specialised)
{
    drawn.method = (struct cells_method){.box = {.dim = dim, .hi = {1, 1, 1}},
                                         .kernel = &drawn.kernel,
                                         .specialised = specialised,
                                         .gradient = gradient,
                                         .pair_width = width,
                                         .formulation = formulation,
                                         .threads = 1};
    assert_non_null(drawn.cells = cells_create(&drawn.method, COUNT));
    assert_true(drawn.cells->force.size <= RECORD_MAX);
}

TEST(test_gradients)
{
    assert_int_equal(kernel_select(&drawn.kernel, "quartic_spline", 5, NULL), STATUS_OK);
    for (int dim = 2; dim <= 3; dim++)
        for (int g = 0; g < GRADIENTS; g++)
            for (int w = 0; w < PAIR_WIDTHS; w++)
                for (int f = 0; f < 2; f++)
                    for (int specialised = 0; specialised < 2; specialised++) {
                        make(dim, (enum gradient)g, (enum pair_width)w,
                             f ? FORMULATION_LAGRANGIAN : FORMULATION_VANILLA_ICE, specialised);
                        check(SOUND, NONE_STEEP);
                        for (int k = 1; k < 4 && g != GRADIENT_STANDARD; k++) {
                            check(k, NONE_STEEP);
                            if (g != GRADIENT_BLENDED) continue;
                            check(SOUND, k);
                            check(k, ALL_STEEP);
                        }
                        cells_destroy(drawn.cells);
                    }
}
