/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares loops that visit each pair once with loops that visit it from both sides, on random
 * setups of several chunks: boxes of any shape, boundaries, widths, schemes, inactive particles. */
#include "test.h"

#include "draw.h"

#include "cells/lanes.h"

enum { N = 9000, FOUND = 5, DRAWS = 24 };

static struct scene {
    struct cells_method method;
    struct kernel kernel;
    size_t n;
    double x[3][N + 8], v[3][N + 8], m[N + 8], U[N + 8], V[N + 8], P[N + 8], c[N + 8], rho[N + 8],
        h_inverse[N + 8], radius[N + 8], b[N + 8], grad_h[N + 8], balsara[N + 8];
    double matrix[CELLS_SYMMETRIC][N + 8], slope[CELLS_SQUARE][N + 8], condition[N + 8];
    double sum[2][N + 8];
    unsigned char asleep[N];
    bool sleeps;
    struct cells_fields fields;
} scene;

/* Results: force, energy, signal speed. */
struct found {
    double of[FOUND][N + 8];
    uint64_t pairs;
};

static struct found full, half, again;

static void draw_method(int trial)
{
    static const enum gradient gradients[] = {GRADIENT_STANDARD, GRADIENT_IA, GRADIENT_CORRECTED};
    static const enum viscosity viscosities[] = {VISCOSITY_CONSTANT, VISCOSITY_PROJECTED,
                                                 VISCOSITY_NONE, VISCOSITY_RECONSTRUCTED};
    static const char *const kernels[] = {"cubic_spline", "wendland_c4"};
    struct cells_method *method = &scene.method;
    assert_int_equal(kernel_select(&scene.kernel, kernels[draw_count(0, 1)], 5, NULL), STATUS_OK);
    *method = (struct cells_method){.kernel = &scene.kernel,
                                    .specialised = draw_count(0, 3) > 0,
                                    .gradient = gradients[draw_count(0, 2)],
                                    .viscosity = viscosities[draw_count(0, 3)],
                                    .formulation = draw_count(0, 2) ? FORMULATION_VANILLA_ICE
                                                                    : FORMULATION_LAGRANGIAN,
                                    .energy = draw_count(0, 1) ? ENERGY_TOTAL : ENERGY_INTERNAL,
                                    .number = draw_count(0, 1),
                                    .balsara = draw_count(0, 1),
                                    .conductivity = draw_count(0, 1) ? 0.7 : 0,
                                    .worst_condition = 1e8,
                                    .numbers = {1, 2, 2, 0.25, 0.4}, /* many neighbours */
                                    .threads = 1};
    method->box.dim = 2 + trial % 2;
    method->signal_form = viscosity_of[method->viscosity].noise || draw_count(0, 1);
    method->velocity_gradient = viscosity_needs_slope(method->viscosity) || method->balsara;
}

/* As many neighbours as in runs; the sides of the box differ by a factor of 8. */
static void draw_scene(int trial)
{
    memset(&scene, 0, sizeof scene);
    draw_method(trial);
    struct grid_box *box = &scene.method.box;
    const int dim = box->dim;
    scene.n = (size_t)draw_count(3500, N);
    double volume = 1, least = HUGE_VAL;
    for (int a = 0; a < dim; a++) {
        const int boundary = trial % 3 ? draw_count(0, 3) : 2;
        box->periodic[a] = boundary > 1;
        scene.method.wall[a] = boundary == 1;
        box->lo[a] = draw(-1, 1);
        const double side = draw(1, dim == 2 ? 8 : 3);
        box->hi[a] = box->lo[a] + side;
        volume *= side;
        least = fmin(least, side);
    }
    const double spacing = pow(volume / (double)scene.n, 1. / dim),
                 h = fmin(spacing * draw(1.6, 2.4), 0.35 * least);
    scene.sleeps = trial % 5 > 2;
    for (size_t i = 0; i < scene.n; i++) {
        const double mass = draw(0.5, 1.5);
        for (int a = 0; a < dim; a++) {
            scene.x[a][i] = draw(box->lo[a], box->hi[a]);
            scene.v[a][i] = draw(-1, 1);
        }
        scene.m[i] = mass, scene.U[i] = draw(0.5, 1.5), scene.V[i] = draw(0.5, 1.5);
        scene.P[i] = draw(0.5, 1.5), scene.c[i] = draw(0.5, 1.5), scene.rho[i] = draw(0.5, 1.5);
        scene.b[i] = draw(0.5, 1.5), scene.grad_h[i] = draw(-0.2, 0.2);
        scene.balsara[i] = draw(0, 1);
        scene.radius[i] = h * draw(0.8, 1.3);
        scene.h_inverse[i] = 1 / scene.radius[i];
        scene.asleep[i] =
            scene.sleeps && scene.x[0][i] > box->lo[0] + 0.7 * (box->hi[0] - box->lo[0])
                ? CELLS_IDLE
                : CELLS_ACTIVE;
    }
    for (int a = 0; a < dim; a++) scene.x[a][1] = scene.x[a][0]; /* two at one position */
}

static void find(bool halves, int threads, struct found *found)
{
    struct cells_fields *f = &scene.fields;
    struct error error = {0};
    scene.method.threads = threads;
    *f = (struct cells_fields){.n = scene.n,
                               .m = scene.m,
                               .U = scene.U,
                               .balsara = scene.balsara,
                               .h_inverse = scene.h_inverse,
                               .P = scene.P,
                               .c = scene.c,
                               .rho = scene.rho,
                               .V = scene.V,
                               .b = scene.b,
                               .grad_h = scene.grad_h,
                               .condition = scene.condition,
                               .sum_m = scene.sum[0],
                               .sum_m_dh = scene.sum[1],
                               .de = found->of[3],
                               .signal = found->of[4]};
    for (int a = 0; a < scene.method.box.dim; a++)
        f->x[a] = scene.x[a], f->v[a] = scene.v[a], f->F[a] = found->of[a];
    for (int k = 0; k < CELLS_SYMMETRIC; k++) f->matrix[k] = scene.matrix[k];
    for (int k = 0; k < CELLS_SQUARE; k++) f->slope[k] = scene.slope[k];
    struct cells *cells = cells_create(&scene.method, scene.n);
    assert_non_null(cells);
    assert_true(cells->halves);
    cells->halves = halves;
    if (cells_arrange(cells, f, scene.radius, scene.sleeps ? scene.asleep : NULL, &error))
        fail_msg("%s", error.message);
    cells_matrix(cells, f);
    for (int k = 0; k < 2; k++) { /* the second time the arrays are not empty */
        for (int v = 0; v < FOUND; v++)
            for (size_t i = 0; i < N; i++) found->of[v][i] = 1234;
        found->pairs = cells_forces(cells, f);
    }
    assert_true(!halves || cells->reactions.chunks >= 3);
    cells_destroy(cells);
}

/* Inactive particles keep their values. */
static void compare(void)
{
    const int dim = scene.method.box.dim;
    for (int v = 0; v < FOUND; v++) {
        double largest_of_all = 0;
        for (size_t i = 0; i < scene.n; i++)
            if (!scene.asleep[i]) largest_of_all = fmax(largest_of_all, fabs(full.of[v][i]));
        for (size_t i = 0; i < scene.n; i++) {
            const bool kept = scene.asleep[i] || (v == 2 && dim == 2);
            if (kept || v == 4)
                assert_true(half.of[v][i] == full.of[v][i]);
            else
                near_below(fabs(half.of[v][i] - full.of[v][i]), 1e-13 * largest_of_all);
        }
    }
    assert_int_equal(half.pairs, full.pairs);
    assert_true(full.pairs > 5 * scene.n / 2);
}

static bool all_periodic(void)
{
    bool all = !scene.sleeps;
    for (int a = 0; a < scene.method.box.dim; a++) all &= scene.method.box.periodic[a];
    return all;
}

/* What pairs exchange is conserved to the round-off of the sum. */
static void check_sum(int v)
{
    double sum = 0, sizes = 0;
    for (size_t i = 0; i < scene.n; i++) sum += half.of[v][i], sizes += fabs(half.of[v][i]);
    near_below(fabs(sum), 1e-13 * sizes);
}

TEST(half_loops_are_full_loops)
{
    int slept = 0, closed = 0;
    for (int trial = 0; trial < DRAWS; trial++) {
        draw_scene(trial);
        find(false, 1, &full);
        find(true, 1, &half);
        compare();
        slept += scene.sleeps;
        for (int threads = 2; threads <= 7; threads += 5) {
            find(true, threads, &again);
            for (int v = 0; v < FOUND; v++)
                assert_memory_equal(again.of[v], half.of[v], N * sizeof(double));
        }
        if (!all_periodic()) continue;
        closed++;
        for (int v = 0; v < scene.method.box.dim; v++) check_sum(v);
        if (scene.method.energy == ENERGY_TOTAL) check_sum(3);
    }
    assert_true(slept > 3 && closed > 3);
}
