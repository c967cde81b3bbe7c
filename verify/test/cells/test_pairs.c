/* SPDX-License-Identifier: GPL-3.0-or-later
 * What dissipates between one particle and drawn neighbours, stage by stage, against the equations
 * of CONVENTIONS in extended precision. */
#include "test.h"

#include "draw.h"

#include "cells/pairs.h"

enum { COUNT = 2 * GRID_LANES, ROOM = COUNT + GRID_LANES };

/* One particle, its record drawn, and neighbours in lanes; behind the last one as many lanes that
 * nothing is to be written to. */
struct drawn {
    struct cells *cells;
    struct lanes lanes;
    struct pairs pairs;
    double record[64];
};

static double *values(const struct drawn *drawn, enum lanes_field field, bool own)
{
    if (!drawn->cells->force.offset[field]) return NULL;
    return own ? (double *)drawn->pairs.record + drawn->cells->force.offset[field]
               : lane_of(&drawn->lanes, &drawn->cells->force, field);
}

/* A value of neighbour k, or where k < 0 the particle's own; which: of a field with several. */
static double get(const struct drawn *drawn, enum lanes_field field, int which, int k)
{
    const double *at = values(drawn, field, k < 0);
    assert_non_null(at);
    return k < 0 ? at[which] : at[which * drawn->lanes.stride + k];
}

static void fill(struct drawn *drawn, enum lanes_field field, int n, double low, double high)
{
    double *own = values(drawn, field, true), *theirs = values(drawn, field, false);
    if (!own) return;
    for (int i = 0; i < n; i++) {
        own[i] = draw(low, high);
        for (int k = 0; k < ROOM; k++) theirs[i * ROOM + k] = draw(low, high);
    }
}

static void make(struct drawn *drawn, const struct cells_method *method)
{
    const int dim = method->box.dim;
    assert_non_null(drawn->cells = cells_create(method, 8));
    const size_t n = (size_t)(LANES_OWN + drawn->cells->force.size) * ROOM;
    assert_true(drawn->cells->force.size <= 64);
    assert_non_null(drawn->lanes.block = malloc(n * sizeof(double)));
    drawn->lanes.stride = ROOM;
    drawn->pairs = (struct pairs){.count = COUNT,
                                  .neighbours = COUNT,
                                  .lanes = &drawn->lanes,
                                  .layout = &drawn->cells->force,
                                  .record = drawn->record};
    for (size_t i = 0; i < n; i++) drawn->lanes.block[i] = draw(-1, 1);
    for (int i = 0; i < 64; i++) drawn->record[i] = draw(-1, 1);
    fill(drawn, RECORD_WEIGHT, 1, 0.5, 2);
    fill(drawn, RECORD_VELOCITY, dim, -1, 1);
    fill(drawn, RECORD_H_INVERSE, 1, 0.5, 2);
    fill(drawn, RECORD_VOLUME, 1, 0.5, 2);
    fill(drawn, RECORD_PRESSURE, 1, 0.5, 2);
    fill(drawn, RECORD_SOUND, 1, 0.1, 2);
    fill(drawn, RECORD_DENSITY, 1, 0.5, 2);
    fill(drawn, RECORD_ALPHA, 1, 0.1, 1);
    fill(drawn, RECORD_BALSARA, 1, 0, 1);
    fill(drawn, RECORD_HEAT, 1, 0.5, 2);
    for (int k = 0; k < ROOM; k++) {
        double r2 = 0, closing = 0;
        lane(&drawn->lanes, LANE_ONE)[k] = 1;
        for (int a = 0; a < dim; a++) {
            const double x = lane(&drawn->lanes, LANE_DX + a)[k];
            r2 += x * x;
            closing += (get(drawn, RECORD_VELOCITY, a, -1) - get(drawn, RECORD_VELOCITY, a, k)) * x;
        }
        lane(&drawn->lanes, LANE_R)[k] = sqrt(r2);
        lane(&drawn->lanes, LANE_R_INVERSE)[k] = 1 / sqrt(r2);
        lane(&drawn->lanes, LANE_CLOSING)[k] = closing / sqrt(r2);
    }
}

static void release(struct drawn *drawn)
{
    cells_destroy(drawn->cells);
    free(drawn->lanes.block);
}

/* x . L x/r^2 of neighbour k or of the particle itself; which: of the two. */
static long double slope_of(const struct drawn *drawn, int k, bool own)
{
    const int dim = drawn->cells->method.box.dim;
    long double sum = 0, r2 = 0;
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) {
            const long double x = lane(&drawn->lanes, LANE_DX + a)[k],
                              y = lane(&drawn->lanes, LANE_DX + b)[k];
            sum += get(drawn, RECORD_SLOPE, a * dim + b, own ? -1 : k) * x * y;
            r2 += a == b ? x * x : 0;
        }
    return sum / r2;
}

/* x/r . (1 - P_ij) (v_ij + (L_i + L_j) x/2), P_ij the mean of both: projected. */
static long double noise_of(const struct drawn *drawn, int k)
{
    const int dim = drawn->cells->method.box.dim;
    long double sum = 0;
    for (int a = 0; a < dim; a++) {
        long double moving = (long double)get(drawn, RECORD_VELOCITY, a, -1) -
                             get(drawn, RECORD_VELOCITY, a, k),
                    across = lane(&drawn->lanes, LANE_DX + a)[k];
        for (int b = 0; b < dim; b++) {
            const long double x = lane(&drawn->lanes, LANE_DX + b)[k];
            static const int place[2][3][3] = {{{0, 1}, {1, 2}}, {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};
            const int ab = place[dim - 2][a][b];
            moving += x / 2 *
                      ((long double)get(drawn, RECORD_SLOPE, a * dim + b, -1) +
                       get(drawn, RECORD_SLOPE, a * dim + b, k));
            across -= x / 2 *
                      ((long double)get(drawn, RECORD_PROJECTOR, ab, -1) +
                       get(drawn, RECORD_PROJECTOR, ab, k));
        }
        sum += across * moving;
    }
    return sum / lane(&drawn->lanes, LANE_R)[k];
}

/* v_ij . G, with which a pair heats. */
static long double approach_of(const struct drawn *drawn, int k)
{
    long double sum = 0;
    for (int a = 0; a < drawn->cells->method.box.dim; a++)
        sum -=
            ((long double)get(drawn, RECORD_VELOCITY, a, -1) - get(drawn, RECORD_VELOCITY, a, k)) *
            lane(&drawn->lanes, LANE_GX + a)[k];
    return sum;
}

/* Closing speed at the middle of the pair, CONVENTIONS eqs. 5.11 and 5.12. */
static long double at_midpoint(const struct drawn *drawn, int k, long double closing)
{
    const long double s = slope_of(drawn, k, true), t = slope_of(drawn, k, false),
                      r = lane(&drawn->lanes, LANE_R)[k],
                      narrow = fminl(get(drawn, RECORD_H_INVERSE, 0, -1),
                                     get(drawn, RECORD_H_INVERSE, 0, k)),
                      near_by = drawn->cells->method.numbers.near;
    const long double z = r * narrow < near_by ? fminl((near_by - r * narrow) / 0.2L, 2.6L) : 0;
    const long double phi = s * t > 0 ? 4 * s * t / ((s + t) * (s + t)) * expl(-z * z) : 0;
    const long double w = closing + phi / 2 * (s + t) * r;
    return closing > 0 && w > 0 ? w : 0;
}

/* m_i m_j PI/2, and what it is made of; *size: of its terms. */
static long double term_of(const struct drawn *drawn, int k, long double *size)
{
    const struct cells_method *method = &drawn->cells->method;
    const bool projected = method->viscosity == VISCOSITY_PROJECTED,
               sloped = projected || method->viscosity == VISCOSITY_RECONSTRUCTED;
    const long double
        r = lane(&drawn->lanes, LANE_R)[k],
        closing = lane(&drawn->lanes, LANE_CLOSING)[k],
        m2 = (long double)get(drawn, RECORD_WEIGHT, 0, -1) * get(drawn, RECORD_WEIGHT, 0, k),
        c = ((long double)get(drawn, RECORD_SOUND, 0, -1) + get(drawn, RECORD_SOUND, 0, k)) / 2,
        rho =
            ((long double)get(drawn, RECORD_DENSITY, 0, -1) + get(drawn, RECORD_DENSITY, 0, k)) / 2;
    const long double w = sloped ? at_midpoint(drawn, k, closing) : fmaxl(closing, 0);
    long double alpha = method->numbers.alpha, beta = method->numbers.beta, f = 1;
    if (method->viscosity == VISCOSITY_TIME_DEPENDENT ||
        method->viscosity == VISCOSITY_CULLEN_DEHNEN) {
        alpha = ((long double)get(drawn, RECORD_ALPHA, 0, -1) + get(drawn, RECORD_ALPHA, 0, k)) / 2;
        beta = alpha * method->numbers.beta_ratio;
    }
    const long double seen = method->viscosity == VISCOSITY_FADING ? fminl(c, 100 * w) : c;
    long double pi;
    if (method->signal_form) {
        pi = (alpha * seen + beta / 2 * w) * w / rho;
    } else {
        const long double h = (1 / (long double)get(drawn, RECORD_H_INVERSE, 0, -1) +
                               1 / (long double)get(drawn, RECORD_H_INVERSE, 0, k)) /
                              4,
                          mu = h * w * r / (r * r + 0.01L * h * h);
        pi = (alpha * seen * mu + beta * mu * mu) / rho;
    }
    if (method->balsara)
        f = ((long double)get(drawn, RECORD_BALSARA, 0, -1) + get(drawn, RECORD_BALSARA, 0, k)) / 2;
    if (projected) f *= f;
    if (sloped && approach_of(drawn, k) <= 0) f = 0;
    long double K = m2 / 2 * pi * f;
    *size = fabsl(K);
    if (projected) {
        const long double mach = closing / c, linear = m2 / 2 * (long double)method->numbers.noise *
                                                       c / rho * fmaxl(0, 1 - mach * mach);
        K += linear * noise_of(drawn, k);
        *size += linear * 10;
    }
    return K;
}

/* Every viscosity in both forms, with and without Balsara's factor. The damping of close pairs has
 * seven digits (reconstructed.h), the rest all. */
TEST(test_viscosity)
{
    static const enum viscosity all[] = {VISCOSITY_CONSTANT,      VISCOSITY_TIME_DEPENDENT,
                                         VISCOSITY_RECONSTRUCTED, VISCOSITY_FADING,
                                         VISCOSITY_CULLEN_DEHNEN, VISCOSITY_PROJECTED};
    enum { ALL = sizeof all / sizeof *all };
    struct kernel kernel;
    assert_int_equal(kernel_select(&kernel, "wendland_c4", 5, NULL), STATUS_OK);
    int zero = 0, other = 0;
    for (int trial = 0; trial < 2 * ALL * 2 * 2 * 2 * 4; trial++) {
        const int which = trial / 2 % ALL, round = trial / (8 * ALL);
        const bool projected = all[which] == VISCOSITY_PROJECTED;
        const struct cells_method method = {.box = {.dim = 2 + trial % 2, .hi = {1, 1, 1}},
                                            .kernel = &kernel,
                                            .viscosity = all[which],
                                            .signal_form = projected || trial / (2 * ALL) % 2,
                                            .balsara = trial / (4 * ALL) % 2,
                                            .numbers = {.alpha = 0.9,
                                                        .beta = 1.7,
                                                        .beta_ratio = 2.1,
                                                        .near = round % 2 ? 0.6 : 1e-3,
                                                        .noise = 0.7},
                                            .threads = 1};
        struct drawn drawn;
        make(&drawn, &method);
        static const enum lanes_array made[] = {LANE_K, LANE_SLOPE_I, LANE_SLOPE_J, LANE_SPARE};
        const double *K = lane(&drawn.lanes, LANE_K);
        double behind[4];
        for (int a = 0; a < 4; a++) behind[a] = lane(&drawn.lanes, (int)made[a])[COUNT];
        for (int a = 0; a < 3; a++) lane(&drawn.lanes, LANE_GX + a)[3] = 0; /* heats nobody */
        cells_viscosity(drawn.cells, &drawn.pairs);
        for (int k = 0; k < COUNT; k++) {
            long double size;
            const long double expected = term_of(&drawn, k, &size);
            near_below((double)fabsl(K[k] - expected), (round % 2 ? 3e-6 : 1e-12) * (double)size);
            zero += expected == 0, other += expected != 0;
        }
        for (int a = 0; a < 4; a++)
            assert_true(lane(&drawn.lanes, (int)made[a])[COUNT] == behind[a]);
        release(&drawn);
    }
    assert_true(zero > 400 && other > 400);
}

/* None at all is 0 for every pair, and for no lane behind them. */
TEST(test_no_viscosity)
{
    struct kernel kernel;
    assert_int_equal(kernel_select(&kernel, "wendland_c4", 5, NULL), STATUS_OK);
    const struct cells_method method = {.box = {.dim = 2, .hi = {1, 1, 1}},
                                        .kernel = &kernel,
                                        .numbers = {.alpha = 1, .beta = 2},
                                        .threads = 1};
    struct drawn drawn;
    make(&drawn, &method);
    double *K = lane(&drawn.lanes, LANE_K);
    const double behind = K[COUNT];
    cells_viscosity(drawn.cells, &drawn.pairs);
    for (int k = 0; k < COUNT; k++) assert_true(K[k] == 0);
    assert_true(K[COUNT] == behind);
    release(&drawn);
}

/* Heat that is conducted (Price 2008), and the divergence by the pair gradient. */
TEST(test_sums)
{
    struct kernel kernel;
    assert_int_equal(kernel_select(&kernel, "wendland_c4", 5, NULL), STATUS_OK);
    for (int trial = 0; trial < 20; trial++) {
        const int dim = 2 + trial % 2;
        const struct cells_method method = {.box = {.dim = dim, .hi = {1, 1, 1}},
                                            .kernel = &kernel,
                                            .conductivity = 0.8,
                                            .threads = 1};
        struct drawn drawn;
        make(&drawn, &method);
        long double heat = 0, divergence = 0, size = 0;
        for (int k = 0; k < COUNT; k++) {
            const long double rho = ((long double)get(&drawn, RECORD_DENSITY, 0, -1) +
                                     get(&drawn, RECORD_DENSITY, 0, k)) /
                                    2,
                              speed = sqrtl(fabsl((long double)get(&drawn, RECORD_PRESSURE, 0, -1) -
                                                  get(&drawn, RECORD_PRESSURE, 0, k)) /
                                            rho);
            long double along = 0;
            for (int a = 0; a < dim; a++)
                along += (long double)lane(&drawn.lanes, LANE_DX + a)[k] *
                         lane(&drawn.lanes, LANE_GX + a)[k] / lane(&drawn.lanes, LANE_R)[k];
            const long double term =
                (long double)get(&drawn, RECORD_WEIGHT, 0, -1) * get(&drawn, RECORD_WEIGHT, 0, k) *
                (long double)method.conductivity * speed *
                ((long double)get(&drawn, RECORD_HEAT, 0, -1) - get(&drawn, RECORD_HEAT, 0, k)) /
                rho * fminl(along, 0);
            heat += term, size += fabsl(term);
            divergence -= get(&drawn, RECORD_VOLUME, 0, k) * approach_of(&drawn, k);
        }
        const double last = lane(&drawn.lanes, LANE_SPARE)[COUNT];
        double gained = 0;
        assert_true(cells_conduction(drawn.cells, &drawn.pairs, &gained));
        near_below((double)fabsl(gained - heat), 1e-13 * (double)size);
        near_below((double)fabsl(cells_divergence(drawn.cells, &drawn.pairs) - divergence), 1e-12);
        assert_true(lane(&drawn.lanes, LANE_SPARE)[COUNT] == last);
        release(&drawn);
    }
}

/* Where the fields of a record lie, in the order of their names, and as many values of each as in
 * `values`: none beside them, in whole groups. */
static void expect_layout(const struct lanes_layout *layout, const int values[RECORD_FIELDS])
{
    int used = 0;
    for (int field = 0; field < RECORD_FIELDS; field++) {
        assert_int_equal(layout->offset[field], values[field] ? used : 0);
        used += values[field];
    }
    assert_int_equal(layout->used, used);
    assert_int_equal(layout->size, (used + GATHER_GROUP - 1) / GATHER_GROUP * GATHER_GROUP);
}

/* Records hold what their passes read, and nothing else. */
TEST(test_records)
{
    struct kernel kernel;
    assert_int_equal(kernel_select(&kernel, "cubic_spline", 5, NULL), STATUS_OK);
    for (int dim = 2; dim <= 3; dim++)
        for (int trial = 0; trial < 200; trial++) {
            struct cells_method method = {.box.dim = dim,
                                          .kernel = &kernel,
                                          .gradient = (enum gradient)(int)draw(0, GRADIENTS),
                                          .viscosity = (enum viscosity)(int)draw(0, VISCOSITIES),
                                          .formulation = draw(0, 1) < 0.5 ? FORMULATION_LAGRANGIAN
                                                                          : FORMULATION_VANILLA_ICE,
                                          .energy_element = draw(0, 1) < 0.5,
                                          .velocity_gradient = draw(0, 1) < 0.5,
                                          .balsara = draw(0, 1) < 0.5,
                                          .conductivity = draw(0, 1) < 0.5 ? 0.1 : 0,
                                          .threads = 1};
            const bool blended = method.gradient == GRADIENT_BLENDED,
                       lagrangian = method.formulation == FORMULATION_LAGRANGIAN,
                       projected = method.viscosity == VISCOSITY_PROJECTED,
                       sloped = projected || method.viscosity == VISCOSITY_RECONSTRUCTED,
                       jumps = method.viscosity == VISCOSITY_CULLEN_DEHNEN,
                       dissipates = method.viscosity != VISCOSITY_NONE || method.conductivity > 0;
            const int symmetric = dim == 2 ? 3 : 6;
            struct cells *cells = cells_create(&method, 8);
            assert_non_null(cells);
            expect_layout(&cells->density,
                          (int[RECORD_FIELDS]){[RECORD_PLACE] = dim,
                                               [RECORD_WEIGHT] = 1,
                                               [RECORD_ENERGY] = method.energy_element});
            expect_layout(
                &cells->matrix,
                (int[RECORD_FIELDS]){[RECORD_PLACE] = dim,
                                     [RECORD_WEIGHT] = 1,
                                     [RECORD_VELOCITY] = method.velocity_gradient ? dim : 0,
                                     [RECORD_H] = blended});
            expect_layout(
                &cells->force,
                (int[RECORD_FIELDS]){
                    [RECORD_PLACE] = dim,
                    [RECORD_WEIGHT] = dissipates || lagrangian,
                    [RECORD_VELOCITY] = dim,
                    [RECORD_H_INVERSE] = 1,
                    [RECORD_VOLUME] = 1,
                    [RECORD_PRESSURE] = 1,
                    [RECORD_SOUND] = 1,
                    [RECORD_DENSITY] = dissipates,
                    [RECORD_ALPHA] = jumps || method.viscosity == VISCOSITY_TIME_DEPENDENT,
                    [RECORD_BALSARA] = method.balsara,
                    [RECORD_HEAT] = method.conductivity > 0,
                    [RECORD_LAGRANGIAN] = lagrangian ? 3 : 0,
                    [RECORD_MATRIX] = method.gradient == GRADIENT_STANDARD ? 0 : symmetric,
                    [RECORD_STEEP] = blended,
                    [RECORD_SLOPE] = sloped ? dim * dim : 0,
                    [RECORD_PROJECTOR] = projected ? symmetric : 0});
            expect_layout(&cells->shift, jumps ? (int[RECORD_FIELDS]){[RECORD_PLACE] = dim,
                                                                      [RECORD_WEIGHT] = 1,
                                                                      [RECORD_VELOCITY] = dim,
                                                                      [RECORD_H_INVERSE] = 1,
                                                                      [RECORD_VOLUME] = 1,
                                                                      [RECORD_SOUND] = 1,
                                                                      [RECORD_ACCELERATION] = dim}
                                               : (int[RECORD_FIELDS]){0});
            assert_true(method.gradient != GRADIENT_CORRECTED ||
                        cells->matrix.geometry == LANES_DIRECTION);
            cells_destroy(cells);
        }
}
