/* SPDX-License-Identifier: GPL-3.0-or-later
 * The passes over small clouds that make matrices, slopes, projectors and the switch of Cullen &
 * Dehnen, against direct sums over all particles and their images in extended precision. */
#include "test.h"

#include "draw.h"
#include "near.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "cells/lanes.h"
#include "matrix.h"
#include "cells/pairs.h"

typedef long double real;

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

/* What a direct sum sees of another particle: itself or one of its images. */
struct other {
    int j;
    real x[3], r, sign[3]; /* x: from here to there */
};

/* Calls see for every particle and image that is another place. */
static void visit(const struct gas *gas, int i,
                  void (*see)(const struct gas *, int, const struct other *, void *), void *context)
{
    const struct cells_method *method = &gas->method;
    const int dim = method->box.dim;
    for (int j = 0; j < gas->n; j++)
        for (int image = 0; image < (dim == 2 ? 9 : 27); image++) {
            struct other o = {.j = j};
            real r2 = 0;
            bool there = true;
            for (int a = 0, rest = image; a < dim; a++, rest /= 3) {
                const int which = rest % 3;
                real at = gas->x[a][j];
                o.sign[a] = 1;
                if (which && method->box.periodic[a])
                    at += which == 1 ? 1 : -1;
                else if (which && method->wall[a])
                    at = (which == 1 ? 0 : 2) - at, o.sign[a] = -1;
                else
                    there = there && !which;
                o.x[a] = at - gas->x[a][i];
                r2 += o.x[a] * o.x[a];
            }
            o.r = sqrtl(r2);
            if (there && !(j == i && image == 0)) see(gas, i, &o, context);
        }
}

struct sums {
    real T[2][9];                   /* with w, with -w'/q */
    real of_v[9], of_a[9], of_h[3]; /* differences of v, F/m and h, with w */
    real R, signal;
};

static void add(const struct gas *gas, int i, const struct other *o, void *context)
{
    struct sums *sums = context;
    const int dim = gas->method.box.dim, j = o->j;
    const double q = (double)(o->r / gas->h[i]);
    if (o->r < fmaxl(gas->h[i], gas->h[j])) {
        real closing = 0;
        for (int a = 0; a < dim && o->r > 0; a++)
            closing += (gas->v[a][i] - o->sign[a] * gas->v[a][j]) * o->x[a] / o->r;
        sums->signal = fmaxl(sums->signal, ((real)gas->c[i] + gas->c[j]) / 2 + fmaxl(closing, 0));
    }
    if (!(q < 1)) return;
    const real w = gas->kernel.w(&gas->kernel, q, dim),
               slope = o->r > 0 ? -gas->kernel.dw(&gas->kernel, q, dim) / q : 0;
    real divergence = 0;
    for (int a = 0; a < dim; a++) divergence += gas->fields.slope[a * dim + a][j];
    sums->R += (divergence > 0 ? 1 : divergence < 0 ? -1 : 0) * gas->m[j] * w;
    for (int a = 0; a < dim; a++)
        sums->of_h[a] += gas->V[j] * w * o->x[a] * ((real)gas->h[j] - gas->h[i]);
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) {
            const real weight = gas->V[j] * o->x[a] * o->x[b];
            sums->T[0][a * dim + b] += weight * w;
            sums->T[1][a * dim + b] += weight * slope;
            sums->of_v[a * dim + b] +=
                gas->V[j] * w * o->x[b] * (o->sign[a] * gas->v[a][j] - gas->v[a][i]);
            sums->of_a[a * dim + b] +=
                gas->V[j] * w * o->x[b] *
                (o->sign[a] * gas->F[a][j] / gas->m[j] - gas->F[a][i] / gas->m[i]);
        }
}

/* Whether T may be used, its inverse, and the condition number that is told: Frobenius' where it
 * suffices. */
static bool solve(const struct gas *gas, const real *T, double *inverse, double *condition)
{
    const int dim = gas->method.box.dim;
    double t[9] = {0}, norm = 0, norm_inverse = 0;
    for (int k = 0; k < dim * dim; k++) t[k] = (double)T[k];
    *condition = HUGE_VAL;
    if (!matrix_invert(dim, t, inverse)) return false;
    for (int k = 0; k < dim * dim; k++)
        norm += t[k] * t[k], norm_inverse += inverse[k] * inverse[k];
    *condition = sqrt(norm * norm_inverse);
    if (*condition > gas->method.worst_condition) *condition = matrix_condition(dim, t);
    return *condition <= gas->method.worst_condition;
}

static const int place[2][3][3] = {{{0, 1}, {1, 2}}, {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};

/* P = kappa M^2/tr M^2, M = L L^T. */
static void check_projector(const struct gas *gas, int i)
{
    const int dim = gas->method.box.dim;
    double L[CELLS_SQUARE], projector[CELLS_SYMMETRIC];
    real M[9] = {0}, trace = 0, square = 0;
    for (int k = 0; k < dim * dim; k++) L[k] = gas->fields.slope[k][i];
    cells_project(dim, L, projector);
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++)
            for (int c = 0; c < dim; c++)
                M[a * dim + b] +=
                    (real)gas->fields.slope[a * dim + c][i] * gas->fields.slope[b * dim + c][i];
    for (int k = 0; k < dim * dim; k++) square += M[k] * M[k], trace += k % (dim + 1) ? 0 : M[k];
    const real s = trace > 0 ? 2 * square / (trace * trace) - 1 : 0,
               t = fminl(1, fmaxl(0, (s - 0.7L) / 0.25L)), kappa = t * t * (3 - 2 * t);
    for (int a = 0; a < dim; a++)
        for (int b = a; b < dim; b++) {
            real sum = 0;
            for (int c = 0; c < dim; c++) sum += M[a * dim + c] * M[c * dim + b];
            near_below(fabs(projector[place[dim - 2][a][b]] -
                            (double)(trace > 0 ? kappa * sum / square : 0)),
                       1e-13);
        }
}

/* The standard gradient's share, CONVENTIONS eq. 4.8. Returns whether it is a part. */
static bool check_share(const struct gas *gas, int i, const struct sums *sums, bool sound,
                        const double *inverse)
{
    const int dim = gas->method.box.dim;
    real square = 0;
    for (int a = 0; sound && a < dim; a++) {
        real slope = 0;
        for (int b = 0; b < dim; b++) slope += inverse[a * dim + b] * sums->of_h[b];
        square += slope * slope;
    }
    const real t = fminl(1, fmaxl(0, (sqrtl(square) - 0.05L) / 0.1L)),
               share = sound ? t * t * (3 - 2 * t) : 1;
    near_below(fabs(gas->fields.steep[i] - (double)share), 1e-10);
    return share > 0 && share < 1;
}

static size_t shares; /* that are neither 0 nor 1 */

static void check_matrix(const struct gas *gas, int i, size_t *fallen_back)
{
    const struct cells_method *method = &gas->method;
    const int dim = method->box.dim;
    struct sums sums = {0};
    double inverse[9], condition;
    visit(gas, i, add, &sums);
    if (method->velocity_gradient) {
        const bool sound = solve(gas, sums.T[0], inverse, &condition);
        for (int a = 0; a < dim; a++)
            for (int b = 0; b < dim; b++) {
                real slope = 0, size = 0;
                for (int c = 0; sound && c < dim; c++)
                    slope += inverse[b * dim + c] * sums.of_v[a * dim + c],
                        size += fabsl(inverse[b * dim + c] * sums.of_v[a * dim + c]);
                near_below(fabs(gas->fields.slope[a * dim + b][i] - (double)slope),
                           sound ? 3e-14 * condition * (double)(size + 0.1L) : 0);
            }
    }
    if (method->viscosity == VISCOSITY_PROJECTED) check_projector(gas, i);
    if (method->gradient == GRADIENT_STANDARD) return;
    const bool sound =
        solve(gas, sums.T[method->gradient == GRADIENT_CORRECTED], inverse, &condition);
    *fallen_back += !sound;
    if (method->gradient == GRADIENT_BLENDED) shares += check_share(gas, i, &sums, sound, inverse);
    if (condition < 1e11)
        near_relative(gas->fields.condition[i], condition, 1e-12 * fmax(1, condition));
    else
        assert_true(gas->fields.condition[i] > 1e10);
    for (int a = 0; a < dim; a++)
        for (int b = a; b < dim; b++)
            near_below(fabs(gas->fields.matrix[place[dim - 2][a][b]][i] -
                            (sound ? inverse[a * dim + b] : 0)),
                       sound ? 1e-14 * condition * (fabs(inverse[0]) + fabs(inverse[dim * dim - 1]))
                             : 0);
}

/* CONVENTIONS eqs. 6.6 and 6.7. Counts those between the limits of alpha. */
static void check_switch(const struct gas *gas, int i, int *between)
{
    const struct cells_method *method = &gas->method;
    const int dim = method->box.dim;
    const double *const *L = (const double *const *)gas->fields.slope;
    struct sums sums = {.signal = gas->c[i]};
    double inverse[9], condition;
    real change = 0, D = 0, shear = 0;
    visit(gas, i, add, &sums);
    for (int a = 0; a < dim; a++) D += L[a * dim + a][i];
    if (solve(gas, sums.T[0], inverse, &condition))
        for (int a = 0; a < dim; a++)
            for (int c = 0; c < dim; c++) change += inverse[a * dim + c] * sums.of_a[a * dim + c];
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) {
            const real S =
                ((real)L[a * dim + b][i] + L[b * dim + a][i]) / 2 - (a == b ? D / dim : 0);
            change -= (real)L[a * dim + b][i] * L[b * dim + a][i], shear += S * S;
        }
    sums.R += (D > 0 ? 1 : D < 0 ? -1 : 0) * gas->m[i] * gas->kernel.w(&gas->kernel, 0, dim);
    const real R = sums.R * gas->kernel.constant[dim] / gas->rho[i] / powl(gas->h[i], dim),
               t = 2 * powl(1 - R, 4) * D,
               xi = (double)t * (double)t > 0 ? t * t / (t * t + shear) : 0,
               A = xi * fmaxl(0, -change), rate = sums.signal / gas->h[i];
    const real alpha = fmaxl(method->alpha_min, method->alpha_max * A / (A + rate * rate));
    near_relative(gas->fields.alpha_local[i], (double)alpha, 1e-9);
    near_relative(gas->fields.decay[i], (double)(2 * 0.05L * rate), 1e-13);
    *between += alpha > method->alpha_min;
}

/* Who has been described, and how. */
struct described {
    struct gas *gas;
    int times[N];
    struct description of[N];
};

static void keep(void *context, size_t particle, const struct description *of)
{
    struct described *described = context;
    described->times[particle]++;
    described->of[particle] = *of;
}

/* Neighbours within h, and the largest angle between C x and x. */
struct around {
    int neighbours;
    real angle;
};

static void look(const struct gas *gas, int i, const struct other *o, void *context)
{
    struct around *around = context;
    const int dim = gas->method.box.dim;
    real Cx[3] = {0}, dot = 0, cross2 = 0;
    if (!(o->r < gas->h[i])) return;
    around->neighbours++;
    for (int a = 0; a < dim; a++) {
        for (int b = 0; b < dim; b++)
            Cx[a] += gas->fields.matrix[place[dim - 2][a][b]][i] * o->x[b];
        dot += Cx[a] * o->x[a];
        for (int b = 0; b < a; b++) {
            const real turn = Cx[a] * o->x[b] - Cx[b] * o->x[a];
            cross2 += turn * turn;
        }
    }
    around->angle = fmaxl(around->angle, atan2l(sqrtl(cross2), dot) * (180 / acosl(-1)));
}

/* Those who sleep have lost their neighbours. Returns how many others have used their matrices. */
static int check_described(const struct cells *cells, struct gas *gas, const unsigned char *asleep)
{
    struct described described = {.gas = gas};
    const int dim = gas->method.box.dim;
    int all = 0;
    cells_describe(cells, &gas->fields, keep, &described);
    for (int i = 0; i < gas->n; i++) {
        const struct description *of = &described.of[i];
        struct around around = {.neighbours = 1};
        double C[9];
        assert_int_equal(described.times[i], 1);
        if (!asleep || !asleep[i]) visit(gas, i, look, &around);
        assert_true(of->neighbours == around.neighbours);
        if (gas->method.gradient == GRADIENT_STANDARD) {
            assert_true(isnan(of->condition) && isnan(of->angle));
            continue;
        }
        const bool used = gas->fields.condition[i] <= gas->method.worst_condition;
        for (int a = 0; a < dim; a++)
            for (int b = 0; b < dim; b++)
                C[a * dim + b] = gas->fields.matrix[place[dim - 2][a][b]][i];
        assert_true(of->condition == (used ? matrix_condition(dim, C) : gas->fields.condition[i]));
        if (used && around.neighbours > 1)
            near_below(fabs(of->angle - (double)around.angle), 1e-6);
        else
            assert_true(isnan(of->angle));
        all += used && around.neighbours > 1;
    }
    return all;
}

/* Where there are walls: along x, with periodic ends along y, or along the last axis alone. */
enum walls { NO_WALLS, WALLS_FIRST, WALLS_LAST };

static void check(enum setup setup, int dim, enum gradient gradient, enum walls walls,
                  bool velocity_gradient, bool projected, int threads, int *between)
{
    static struct gas gas;
    gas.method = (struct cells_method){
        .box = {.dim = dim, .hi = {1, 1, 1}, .periodic = {false, walls == WALLS_FIRST, false}},
        .wall = {walls == WALLS_FIRST, walls == WALLS_LAST && dim == 2,
                 walls == WALLS_LAST && dim == 3},
        .kernel = &gas.kernel,
        .specialised = true,
        .gradient = gradient,
        .viscosity = projected ? VISCOSITY_PROJECTED : VISCOSITY_CULLEN_DEHNEN,
        .velocity_gradient = velocity_gradient,
        .worst_condition = 1e3,
        .alpha_min = 0.02,
        .alpha_max = 1.5,
        .threads = threads};
    assert_int_equal(kernel_select(&gas.kernel, "quartic_spline", 5, NULL), STATUS_OK);
    lay(&gas, setup);
    point_fields(&gas);
    struct cells *cells = cells_create(&gas.method, (size_t)gas.n);
    assert_non_null(cells);
    struct error error = {0};
    /* few images at first, then many */
    for (int i = 0; i < gas.n; i++) gas.radius[i] *= 0.1;
    if (cells_arrange(cells, &gas.fields, gas.radius, NULL, &error)) fail_msg("%s", error.message);
    for (int i = 0; i < gas.n; i++) gas.radius[i] *= 10;
    if (cells_arrange(cells, &gas.fields, gas.radius, NULL, &error)) fail_msg("%s", error.message);
    size_t fallen_back = 0;
    const size_t told = cells_matrix(cells, &gas.fields);
    for (int i = 0; i < gas.n; i++) check_matrix(&gas, i, &fallen_back);
    assert_int_equal(told, fallen_back);
    const int described = check_described(cells, &gas, NULL);
    assert_true(described > gas.n / 4 || gradient == GRADIENT_STANDARD);
    if (gradient == GRADIENT_STANDARD) assert_true(gas.fields.condition[3] == 1234);
    if (!velocity_gradient) assert_true(gas.fields.slope[0][3] == 1234);
    if (!velocity_gradient || projected) { /* no switch */
        cells_destroy(cells);
        return;
    }
    for (size_t k = 0; k < cells->capacity * (size_t)lanes_longest_record(cells); k++)
        cells->records[k] = nan("");
    cells_switch(cells, &gas.fields);
    for (int i = 0; i < gas.n; i++) check_switch(&gas, i, between);
    if (cells_arrange(cells, &gas.fields, gas.radius, gas.asleep, &error))
        fail_msg("%s", error.message);
    for (int i = 0; i < N; i++) gas.fields.alpha_local[i] = gas.fields.decay[i] = 1234;
    cells_switch(cells, &gas.fields);
    for (int i = 0, none = 0; i < N; i++)
        if (i >= gas.n)
            assert_true(gas.fields.alpha_local[i] == 1234 && gas.fields.decay[i] == 1234);
        else if (gas.asleep[i])
            assert_true(gas.fields.alpha_local[i] == gas.method.alpha_min &&
                        gas.fields.decay[i] == 0);
        else
            check_switch(&gas, i, &none);
    check_described(cells, &gas, gas.asleep);
    cells_destroy(cells);
}

TEST(test_passes)
{
    static const enum gradient gradients[] = {GRADIENT_STANDARD, GRADIENT_IA, GRADIENT_CORRECTED};
    int between = 0;
    for (int round = 0; round < 12; round++)
        check(ANYHOW, 2 + round % 2, gradients[round % 3], (enum walls)(round / 2 % 3), true,
              round % 4 < 2, 1 + round % 3, &between);
    for (int dim = 2; dim <= 3; dim++) {
        check(LATTICE, dim, GRADIENT_IA, NO_WALLS, true, true, 1, &between);
        check(TOGETHER, dim, GRADIENT_CORRECTED, NO_WALLS, true, false, 1, &between);
        for (int g = 0; g < 3; g++)
            check(ANYHOW, dim, gradients[g], NO_WALLS, false, false, 1, &between);
    }
    assert_true(between > 100);
    for (int dim = 2; dim <= 3; dim++)
        for (int walls = 0; walls < 3; walls++)
            check(ANYHOW, dim, GRADIENT_BLENDED, (enum walls)walls, walls != 1, false, 1, &between);
    assert_true(shares > 30);
    int moving = 0;
    for (int dim = 2; dim <= 3; dim++) {
        check(STILL, dim, GRADIENT_IA, WALLS_FIRST, true, true, 1, &moving);
        check(APART, dim, GRADIENT_IA, NO_WALLS, true, true, 1, &moving);
        check(HARDLY, dim, GRADIENT_IA, NO_WALLS, true, true, 1, &moving);
    }
    assert_int_equal(moving, 0);
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
