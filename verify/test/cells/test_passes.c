/* SPDX-License-Identifier: GPL-3.0-or-later
 * The pass over a small cloud that makes matrices, at the limit of what is allowed. */
#include "test.h"

#include "draw.h"

#include "cells/lanes.h"
#include "matrix.h"
#include "cells/pairs.h"

enum { N = 60 };

/* How the gas moves: anyhow; not at all; everything towards the middle, slowly, or so slowly that
 * squares vanish; cold, and away from it; anyhow, on lattice points of spacing 1/4 with widths that
 * are distances. */
enum setup { ANYHOW, STILL, TOGETHER, HARDLY, APART, LATTICE };

struct gas {
    struct cells_method method;
    struct kernel kernel;
    int n;
    double x[3][N], v[3][N], F[3][N], m[N], V[N], c[N], rho[N], h[N], h_inverse[N], radius[N];
    double found[64][N];
    unsigned char asleep[N];
    struct cells_fields fields;
};

static void lay(struct gas *gas, enum setup setup)
{
    const int dim = gas->method.box.dim, side = dim == 2 ? 7 : 3;
    int count = 0;
    gas->n = setup == LATTICE ? (dim == 2 ? 49 : 27) : N;
    for (int i = 0; i < gas->n; i++) {
        for (int a = 0, rest = i; a < dim; a++, rest /= side) {
            gas->x[a][i] = setup == LATTICE ? 0.25 * (rest % side) : draw(0, 1);
            const double inwards = 0.5 - gas->x[a][i];
            gas->v[a][i] = setup == STILL      ? 0
                           : setup == TOGETHER ? 1e-6 * inwards
                           : setup == HARDLY   ? 1e-170 * inwards
                           : setup == APART    ? -1e-6 * inwards
                                               : draw(-1, 1);
        }
        const double cold = setup == HARDLY || setup == APART ? 1e-6 : 1;
        gas->m[i] = draw(0.5, 2), gas->V[i] = draw(0.5, 2), gas->c[i] = cold * draw(0.1, 2);
        gas->rho[i] = 75 * draw(0.5, 2);
        for (int a = 0; a < dim; a++) {
            const double inwards = gas->m[i] * (0.5 - gas->x[a][i]);
            gas->F[a][i] = setup == TOGETHER || setup == HARDLY ? inwards
                           : setup == APART                     ? -inwards
                                                                : draw(-9, 9);
        }
        gas->h[i] = setup == LATTICE                           ? (i % 3 ? 0.5 : 0.25)
                    : gas->method.gradient == GRADIENT_BLENDED ? draw(0.36, 0.38)
                                                               : draw(0.28, 0.38);
        gas->asleep[i] = i % 11 == 0;
        count += gas->asleep[i];
    }
    if (setup == ANYHOW && !gas->method.box.periodic[1]) { /* alone; in a line with two others */
        for (int a = 0; a < dim; a++) gas->x[a][0] = 5, gas->x[a][1] = 6.5 + 0.1 * (a == 1);
        for (int k = 2; k < 4; k++)
            for (int a = 0; a < dim; a++) gas->x[a][k] = gas->x[a][1] + (k - 1) * 0.05 * (a == 0);
        gas->x[0][4] = gas->x[0][7], gas->x[1][4] = gas->x[1][7]; /* two at one place */
        if (dim == 3) gas->x[2][4] = gas->x[2][7];
    }
    for (int i = 0; i < gas->n; i++)
        gas->h_inverse[i] = 1 / gas->h[i], gas->radius[i] = 1.2 * gas->h[i];
    assert_true(count > 0);
}

static void point_fields(struct gas *gas)
{
    struct cells_fields *fields = &gas->fields;
    int used = 0;
    *fields = (struct cells_fields){.n = (size_t)gas->n,
                                    .m = gas->m,
                                    .h_inverse = gas->h_inverse,
                                    .c = gas->c,
                                    .rho = gas->rho,
                                    .V = gas->V};
    for (int a = 0; a < gas->method.box.dim; a++)
        fields->x[a] = gas->x[a], fields->v[a] = gas->v[a], fields->F[a] = gas->F[a];
    for (int k = 0; k < 64; k++)
        for (int i = 0; i < N; i++) gas->found[k][i] = 1234;
    for (int k = 0; k < CELLS_SYMMETRIC; k++) fields->matrix[k] = gas->found[used++];
    for (int k = 0; k < CELLS_SQUARE; k++) fields->slope[k] = gas->found[used++];
    fields->condition = gas->found[used++];
    fields->steep = gas->found[used++];
    fields->alpha_local = gas->found[used++];
    fields->decay = gas->found[used++];
}

/* The worst condition number that is allowed is allowed. */
TEST(test_worst)
{
    static struct gas gas;
    assert_int_equal(kernel_select(&gas.kernel, "quartic_spline", 5, NULL), STATUS_OK);
    gas.method = (struct cells_method){.box = {.dim = 2, .hi = {1, 1, 1}},
                                       .kernel = &gas.kernel,
                                       .gradient = GRADIENT_IA,
                                       .worst_condition = HUGE_VAL,
                                       .threads = 1};
    lay(&gas, ANYHOW);
    for (int round = 0; round < 2; round++) {
        point_fields(&gas);
        struct cells *cells = cells_create(&gas.method, (size_t)gas.n);
        assert_non_null(cells);
        assert_int_equal(cells_arrange(cells, &gas.fields, gas.radius, NULL, NULL), STATUS_OK);
        size_t beyond = 0;
        const size_t told = cells_matrix(cells, &gas.fields);
        for (int i = 0; i < gas.n; i++)
            if (!(gas.fields.condition[i] <= gas.method.worst_condition)) beyond++;
        assert_int_equal(told, beyond);
        assert_true(gas.fields.matrix[0][20] != 0);
        gas.method.worst_condition = gas.fields.condition[20];
        cells_destroy(cells);
    }
}
