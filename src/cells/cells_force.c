/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pair forces in 2D and 3D. The gradient of a pair is a vector here: grad_i W(h_i) = -s_i x with a
 * number s_i (standard) or with the matrix C_i w(q_i) (ia) in place of it, x = r_j - r_i. Forces
 * are along G = s x, the negative gradient, so that the terms of pair.h are taken with G = 1:
 *   dp_i/dt = sum_j a_i G_i + a_j G_j + 2 K G,   dU_i/dt = -sum_j v_ij . (a_i G_i + K G). */
#include <math.h>

#include "lanes.h"

/* --- records ---------------------------------------------------------------------------------- */

static void fill_sentinel(struct cells *cells, size_t n)
{
    const struct lanes_layout *layout = &cells->force;
    double *record = cells->records + (ptrdiff_t)n * layout->size;
    for (int f = 0; f < layout->size; f++) record[f] = 0;
    for (int a = 0; a < 3; a++) record[a] = grid_positions(cells->grid)[n][a];
    /* far beyond its own width, too; a density keeps quotients finite */
    const double h_inverse = 16 / (record[0] > 0 ? record[0] : 1);
    record[layout->offset[GROUP_MOTION] + 3] = 1 / h_inverse;
    record[layout->offset[GROUP_GAS]] = h_inverse;
    if (layout->offset[GROUP_VISCOSITY] >= 0) record[layout->offset[GROUP_VISCOSITY]] = 1;
}

/* A symmetric matrix of a particle, or of its image. */
static void fill_symmetric(int dim, int mirrored, double *const matrix[CELLS_SYMMETRIC], size_t i,
                           double *group)
{
    for (int a = 0; a < dim; a++)
        for (int b = a; b < dim; b++) {
            const int k = symmetric_at(dim, a, b);
            group[k] = lanes_sign(mirrored, a) * lanes_sign(mirrored, b) * matrix[k][i];
        }
}

static void fill_record(const struct cells *cells, const struct cells_fields *fields, size_t i,
                        int mirrored, double *record)
{
    const struct cells_method *method = &cells->method;
    const struct lanes_layout *layout = &cells->force;
    const int *at = layout->offset, dim = method->box.dim;
    record[3] = fields->m[i];
    double *group = record + at[GROUP_MOTION];
    for (int a = 0; a < 3; a++) group[a] = a < dim ? lanes_sign(mirrored, a) * fields->v[a][i] : 0;
    group[3] = 1 / fields->h_inverse[i];
    group = record + at[GROUP_GAS];
    group[0] = fields->h_inverse[i];
    group[1] = fields->V[i];
    group[2] = fields->P[i];
    group[3] = fields->c[i];
    if (at[GROUP_VISCOSITY] >= 0) {
        group = record + at[GROUP_VISCOSITY];
        group[0] = fields->rho[i];
        group[1] = fields->alpha ? fields->alpha[i] : 0;
        group[2] = method->balsara ? fields->balsara[i] : 1;
        group[3] = fields->U[i] / fields->m[i];
    }
    if (at[GROUP_LAGRANGIAN] >= 0) {
        group = record + at[GROUP_LAGRANGIAN];
        group[0] = fields->b[i];
        group[1] = fields->grad_h[i];
        group[2] = method->energy_element ? fields->U[i] : method->number ? 1 : fields->m[i];
        group[3] = 0;
    }
    const int symmetric = dim * (dim + 1) / 2;
    if (at[GROUP_MATRIX] >= 0) {
        group = record + at[GROUP_MATRIX];
        fill_symmetric(dim, mirrored, fields->matrix, i, group);
        group[symmetric] = fields->condition[i] <= method->worst_condition;
        for (int k = symmetric + 1; k < (dim == 3 ? 8 : 4); k++) group[k] = 0;
    }
    if (at[GROUP_SLOPE] >= 0) {
        group = record + at[GROUP_SLOPE];
        for (int k = 0; k < (dim == 3 ? 12 : 4); k++)
            group[k] = k < dim * dim ? lanes_sign(mirrored, k / dim) *
                                           lanes_sign(mirrored, k % dim) * fields->slope[k][i]
                                     : 0;
    }
    if (at[GROUP_PROJECTOR] >= 0) {
        group = record + at[GROUP_PROJECTOR];
        for (int k = symmetric; k < (dim == 3 ? 8 : 4); k++) group[k] = 0;
        fill_symmetric(dim, mirrored, fields->projector, i, group);
    }
}

static void fill_records(struct cells *cells, const struct cells_fields *fields)
{
    const double(*place)[4] = grid_positions(cells->grid);
#pragma omp parallel for num_threads(cells->method.threads) if (cells->method.threads > 1)
    for (size_t s = 0; s < cells->points; s++) {
        double *record = cells->records + (ptrdiff_t)s * cells->force.size;
        for (int a = 0; a < 3; a++) record[a] = place[s][a];
        int mirrored;
        const size_t i = lanes_source(cells, fields->n, s, &mirrored);
        fill_record(cells, fields, i, mirrored, record);
    }
    fill_sentinel(cells, cells->points);
}

/* --- geometry: closing speed, slopes along the pair ------------------------------------------- */

/* closing = v_ij . x/r. */
CLONES static void find_closing(int count, const double *restrict dx, const double *restrict dy,
                                const double *restrict dz, const double *restrict vx,
                                const double *restrict vy, const double *restrict vz,
                                const double *v, const double *restrict r_inverse,
                                double *restrict closing)
{
    const double v0 = v[0], v1 = v[1], v2 = v[2];
#pragma omp simd
    for (int k = 0; k < count; k++)
        closing[k] =
            ((v0 - vx[k]) * dx[k] + (v1 - vy[k]) * dy[k] + (v2 - vz[k]) * dz[k]) * r_inverse[k];
}

/* x . L x/r^2 for the particle's own L, and for the neighbours'. */
CLONES static void slopes_along(int dim, int count, const struct lanes *lanes, const double *own,
                                const double *theirs)
{
    const ptrdiff_t stride = lanes->stride;
    const double *dx = lane(lanes, LANE_DX), *r_inverse = lane(lanes, LANE_R_INVERSE);
    double *restrict slope_i = lane(lanes, LANE_SLOPE_I), *restrict slope_j =
                                                              lane(lanes, LANE_SLOPE_J);
    for (int k = 0; k < count; k++) slope_i[k] = slope_j[k] = 0;
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) {
            const double *restrict xa = dx + a * stride, *restrict xb = dx + b * stride,
                                   *restrict L = theirs + (a * dim + b) * stride;
            const double L_own = own[a * dim + b];
#pragma omp simd
            for (int k = 0; k < count; k++) {
                const double xx = (xa[k] * r_inverse[k]) * (xb[k] * r_inverse[k]);
                slope_i[k] += L_own * xx;
                slope_j[k] += L[k] * xx;
            }
        }
}

/* --- pair gradients --------------------------------------------------------------------------- */

/* q at the particle's own width, at the neighbour's, or at a width of both. */
CLONES static void widths(enum pair_width width, int count, const double *restrict r,
                          double h_inverse, const double *restrict theirs, double *restrict q,
                          double *restrict q_j)
{
#pragma omp simd
    for (int k = 0; k < count; k++) {
        if (width == PAIR_WIDTH_MEAN) {
            q[k] = r[k] * h_inverse;
            q_j[k] = r[k] * theirs[k];
        } else {
            const double both = width == PAIR_WIDTH_MAX ? least(h_inverse, theirs[k])
                                                        : 0.5 * (h_inverse + theirs[k]);
            q[k] = r[k] * both;
            q_j[k] = both;
        }
    }
}

ALWAYS_INLINE double power(double x, int n)
{
    double y = x;
    for (int k = 1; k < n; k++) y *= x;
    return y;
}

/* s = C h^-(d+1) w'(q)/r (negative) from w'(q), in place; h_inverse of the particle where theirs is
 * NULL. */
CLONES static void standard_sizes(int dim, int count, double constant, double h_inverse,
                                  const double *restrict theirs, const double *restrict r_inverse,
                                  double *restrict dw)
{
#pragma omp simd
    for (int k = 0; k < count; k++) {
        const double inverse = theirs ? theirs[k] : h_inverse;
        dw[k] =
            constant * (dim == 2 ? power(inverse, 3) : power(inverse, 4)) * dw[k] * r_inverse[k];
    }
}

/* w(q), or -w'(q)/q from w' in place, as weight of a matrix. */
CLONES static void corrected_weight(int count, const double *restrict q, double *restrict dw)
{
#pragma omp simd
    for (int k = 0; k < count; k++) dw[k] = q[k] > 0 ? -dw[k] / q[k] : 0;
}

/* G = s x. */
CLONES static void along(int count, const double *restrict s, const double *restrict x,
                         double *restrict G)
{
#pragma omp simd
    for (int k = 0; k < count; k++) G[k] = s[k] * x[k];
}

/* Negative gradients by matrices along one axis: G_i = -C_i x w, G_j = -C_j x w_j. */
CLONES static void by_matrix(int dim, int count, const struct lanes *lanes, const double *own,
                             const double *theirs, const double *restrict w,
                             const double *restrict w_j, int axis)
{
    const ptrdiff_t stride = lanes->stride;
    double *restrict G_i = lane(lanes, LANE_GX_I + axis), *restrict G_j =
                                                              lane(lanes, LANE_GX_J + axis);
    const double *x = lane(lanes, LANE_DX);
    for (int k = 0; k < count; k++) G_i[k] = G_j[k] = 0;
    for (int b = 0; b < dim; b++) {
        const double *restrict xb = x + b * stride, *restrict C =
                                                        theirs +
                                                        symmetric_at(dim, axis, b) * stride;
        const double C_own = own[symmetric_at(dim, axis, b)];
#pragma omp simd
        for (int k = 0; k < count; k++) {
            G_i[k] -= C_own * xb[k];
            G_j[k] -= C[k] * xb[k];
        }
    }
#pragma omp simd
    for (int k = 0; k < count; k++) {
        G_i[k] *= w[k];
        G_j[k] *= w_j[k];
    }
}

CLONES static void mean(int count, const double *restrict a, const double *restrict b,
                        double *restrict m)
{
#pragma omp simd
    for (int k = 0; k < count; k++) m[k] = 0.5 * (a[k] + b[k]);
}

/* Where either matrix is not to be used, the pair's gradient is the standard one. */
CLONES static void fall_back(int count, double own, const double *restrict theirs,
                             const double *restrict s, const double *restrict x, double *restrict G)
{
#pragma omp simd
    for (int k = 0; k < count; k++) G[k] = own * theirs[k] > 0 ? G[k] : s[k] * x[k];
}

/* w(q), w'(q) or what the gradient needs of them, in place of w. */
static void pair_shapes(const struct cells *cells, int count, const double *q, double *w)
{
    const struct cells_method *method = &cells->method;
    if (method->gradient == GRADIENT_IA) {
        cells->shapes.w(method->kernel, (size_t)count, q, w);
        return;
    }
    cells->shapes.dw(method->kernel, (size_t)count, q, w);
    if (method->gradient != GRADIENT_STANDARD) corrected_weight(count, q, w);
}

/* The standard pair gradient's s, at both widths. */
static void standard_pair(const struct cells *cells, int count, const struct lanes *lanes,
                          double h_inverse, const double *theirs, double *s, double *s_j)
{
    const struct cells_method *method = &cells->method;
    const int dim = method->box.dim;
    const double C = method->kernel->constant[dim], *r_inverse = lane(lanes, LANE_R_INVERSE);
    const bool mean_width = method->pair_width == PAIR_WIDTH_MEAN;
    double *q = lane(lanes, LANE_Q), *q_j = lane(lanes, LANE_Q_J);
    widths(method->pair_width, count, lane(lanes, LANE_R), h_inverse, theirs, q, q_j);
    cells->shapes.dw(method->kernel, (size_t)count, q, s);
    standard_sizes(dim, count, C, h_inverse, mean_width ? NULL : q_j, r_inverse, s);
    if (!mean_width) {
        for (int k = 0; k < count; k++) s_j[k] = s[k];
        return;
    }
    cells->shapes.dw(method->kernel, (size_t)count, q_j, s_j);
    standard_sizes(dim, count, C, h_inverse, theirs, r_inverse, s_j);
}

static bool all_sound(int count, double own, const double *theirs, int padding_from)
{
    double least_of = own;
    for (int k = 0; k < count; k++)
        if (k < padding_from) least_of = least(least_of, theirs[k]);
    return least_of > 0;
}

/* G_i, G_j and their mean G of every pair, along every axis. */
static void pair_gradients(const struct cells *cells, int count, int neighbours,
                           const struct lanes *lanes, const double *record)
{
    const struct cells_method *method = &cells->method;
    const struct lanes_layout *layout = &cells->force;
    const int dim = method->box.dim;
    const double h_inverse = record[layout->offset[GROUP_GAS]];
    const double *theirs = lane_of(lanes, layout, GROUP_GAS, 0);
    double *w = lane(lanes, LANE_W), *w_j = lane(lanes, LANE_W_J);
    const bool both = method->formulation == FORMULATION_LAGRANGIAN;
    if (method->gradient == GRADIENT_STANDARD) {
        standard_pair(cells, count, lanes, h_inverse, theirs, w, w_j);
        double *s = lane(lanes, LANE_SPARE);
        mean(count, w, w_j, s);
        for (int a = 0; a < dim; a++) {
            const double *x = lane(lanes, LANE_DX + a);
            along(count, s, x, lane(lanes, LANE_GX + a));
            if (!both) continue;
            along(count, w, x, lane(lanes, LANE_GX_I + a));
            along(count, w_j, x, lane(lanes, LANE_GX_J + a));
        }
        return;
    }
    double *q = lane(lanes, LANE_Q), *q_j = lane(lanes, LANE_Q_J);
    widths(method->pair_width, count, lane(lanes, LANE_R), h_inverse, theirs, q, q_j);
    pair_shapes(cells, count, q, w);
    if (method->pair_width == PAIR_WIDTH_MEAN)
        pair_shapes(cells, count, q_j, w_j);
    else
        for (int k = 0; k < count; k++) w_j[k] = w[k];
    const double *own = record + layout->offset[GROUP_MATRIX];
    for (int a = 0; a < dim; a++) {
        by_matrix(dim, count, lanes, own, lane_of(lanes, layout, GROUP_MATRIX, 0), w, w_j, a);
        mean(count, lane(lanes, LANE_GX_I + a), lane(lanes, LANE_GX_J + a),
             lane(lanes, LANE_GX + a));
    }
    const int symmetric = dim * (dim + 1) / 2;
    const double *use = lane_of(lanes, layout, GROUP_MATRIX, symmetric);
    if (all_sound(count, own[symmetric], use, neighbours)) return;
    standard_pair(cells, count, lanes, h_inverse, theirs, w, w_j);
    double *s = lane(lanes, LANE_SPARE);
    mean(count, w, w_j, s);
    for (int a = 0; a < dim; a++) {
        const double *x = lane(lanes, LANE_DX + a);
        fall_back(count, own[symmetric], use, s, x, lane(lanes, LANE_GX + a));
        fall_back(count, own[symmetric], use, w, x, lane(lanes, LANE_GX_I + a));
        fall_back(count, own[symmetric], use, w_j, x, lane(lanes, LANE_GX_J + a));
    }
}

/* --- physics ---------------------------------------------------------------------------------- */

/* The particle's own side, and the arrays that its neighbours' sides come from. */
struct sides {
    struct pair_side own;
    const double *m, *h, *h_inverse, *V, *P, *c, *rho, *alpha, *balsara, *b, *grad_h, *Z, *slope;
    double own_balsara;
    const double *own_slope;
};

static struct sides find_sides(const struct cells *cells, const struct lanes *lanes,
                               const double *record)
{
    const struct lanes_layout *layout = &cells->force;
    const int *at = layout->offset;
    struct sides sides = {
        .own = {.m = record[3],
                .h = record[at[GROUP_MOTION] + 3],
                .h_inverse = record[at[GROUP_GAS]],
                .V = record[at[GROUP_GAS] + 1],
                .P = record[at[GROUP_GAS] + 2],
                .c = record[at[GROUP_GAS] + 3]},
        .m = lane_of(lanes, layout, GROUP_PLACE, 3),
        .h = lane_of(lanes, layout, GROUP_MOTION, 3),
        .h_inverse = lane_of(lanes, layout, GROUP_GAS, 0),
        .V = lane_of(lanes, layout, GROUP_GAS, 1),
        .P = lane_of(lanes, layout, GROUP_GAS, 2),
        .c = lane_of(lanes, layout, GROUP_GAS, 3),
        .own_balsara = 1,
    };
    if (at[GROUP_VISCOSITY] >= 0) {
        const double *own = record + at[GROUP_VISCOSITY];
        sides.own.rho = own[0];
        sides.own.alpha = own[1];
        sides.own_balsara = own[2];
        sides.rho = lane_of(lanes, layout, GROUP_VISCOSITY, 0);
        sides.alpha = lane_of(lanes, layout, GROUP_VISCOSITY, 1);
        sides.balsara = lane_of(lanes, layout, GROUP_VISCOSITY, 2);
    }
    if (at[GROUP_LAGRANGIAN] >= 0) {
        const double *own = record + at[GROUP_LAGRANGIAN];
        sides.own.b = own[0];
        sides.own.grad_h = own[1];
        sides.own.Z = own[2];
        sides.b = lane_of(lanes, layout, GROUP_LAGRANGIAN, 0);
        sides.grad_h = lane_of(lanes, layout, GROUP_LAGRANGIAN, 1);
        sides.Z = lane_of(lanes, layout, GROUP_LAGRANGIAN, 2);
    }
    return sides;
}

/* a_i and a_j of the pressure, for G = 1. With the number element 1 stands in place of the mass in
 * f_ij = 1 - (m_j/Z_j)(1 - f_i), too: h follows the sum that it adds up. */
CLONES static void pressure(enum formulation formulation, bool number, int count,
                            const struct sides *sides, double *restrict a_i, double *restrict a_j)
{
    struct pair_side own = sides->own;
    if (number) own.m = own.Z;
    const double *restrict V = sides->V, *restrict P = sides->P, *restrict b = sides->b,
                           *restrict grad_h = sides->grad_h, *restrict Z = sides->Z,
                           *restrict m = number ? sides->Z : sides->m;
    if (formulation == FORMULATION_VANILLA_ICE) {
#pragma omp simd
        for (int k = 0; k < count; k++) {
            const struct pair_side j = {.V = V[k], .P = P[k]};
            const struct pair_terms a = pair_pressure_vanilla_ice(&own, &j, 1);
            a_i[k] = a.i;
            a_j[k] = a.j;
        }
    } else {
#pragma omp simd
        for (int k = 0; k < count; k++) {
            const struct pair_side j = {.m = m[k], .Z = Z[k], .b = b[k], .grad_h = grad_h[k]};
            const struct pair_terms a = pair_pressure_lagrangian(&own, &j, 1, 1);
            a_i[k] = a.i;
            a_j[k] = a.j;
        }
    }
}

/* K, what viscosity adds to a_i and a_j alike, for G = 1. */
ALWAYS_INLINE void viscous_body(enum viscosity viscosity, bool signal_form, int count,
                                const struct pair_numbers *numbers, const struct sides *sides,
                                const struct lanes *lanes)
{
    const struct pair_numbers n = *numbers;
    const double own_m = sides->own.m, own_h = sides->own.h, own_h_inverse = sides->own.h_inverse,
                 own_c = sides->own.c, own_rho = sides->own.rho, own_alpha = sides->own.alpha;
    const double *restrict m = sides->m, *restrict h = sides->h,
                           *restrict h_inverse = sides->h_inverse, *restrict c = sides->c,
                           *restrict rho = sides->rho, *restrict alpha = sides->alpha,
                           *restrict slope_i = lane(lanes, LANE_SLOPE_I),
                           *restrict slope_j = lane(lanes, LANE_SLOPE_J),
                           *restrict r = lane(lanes, LANE_R),
                           *restrict closing = lane(lanes, LANE_CLOSING);
    const bool varying = viscosity == VISCOSITY_TIME_DEPENDENT;
    const bool sloped = viscosity == VISCOSITY_RECONSTRUCTED;
    double *restrict K = lane(lanes, LANE_K);
#pragma omp simd
    for (int k = 0; k < count; k++) {
        const struct pair_side i = {.m = own_m,
                                    .h = own_h,
                                    .h_inverse = own_h_inverse,
                                    .c = own_c,
                                    .rho = own_rho,
                                    .alpha = own_alpha,
                                    .slope = sloped ? slope_i[k] : 0};
        const struct pair_side j = {.m = m[k],
                                    .h = h[k],
                                    .h_inverse = h_inverse[k],
                                    .c = c[k],
                                    .rho = rho[k],
                                    .alpha = varying ? alpha[k] : 0,
                                    .slope = sloped ? slope_j[k] : 0};
        K[k] = signal_form ? pair_viscous_signal(viscosity, &n, &i, &j, r[k], closing[k], 1)
                           : pair_viscous(viscosity, &n, &i, &j, r[k], closing[k], 1);
    }
}

/* Times the mean Balsara factor of the pair, or its square. */
CLONES static void limit_viscosity(int count, bool squared, double own,
                                   const double *restrict theirs, double *restrict K)
{
#pragma omp simd
    for (int k = 0; k < count; k++) {
        const double f = 0.5 * (own + theirs[k]);
        K[k] *= squared ? f * f : f;
    }
}

#define VISCOUS_CASE(symbol, name, label, paper, signal_form)                                      \
    case symbol:                                                                                   \
        viscous_body(symbol, signal_form, count, numbers, sides, lanes);                           \
        break;

#define VISCOUS(name, signal_form)                                                                 \
    CLONES static void name(enum viscosity viscosity, int count,                                   \
                            const struct pair_numbers *numbers, const struct sides *sides,         \
                            const struct lanes *lanes)                                             \
    {                                                                                              \
        switch (viscosity) {                                                                       \
            VISCOSITY_LINE_LIST(VISCOUS_CASE, signal_form)                                         \
        case VISCOSITY_CULLEN_DEHNEN: /* comes as time_dependent */                                \
        case VISCOSITY_PROJECTED:     /* comes as reconstructed */                                 \
            break;                                                                                 \
        }                                                                                          \
    }
VISCOUS(viscous_mu, false)
VISCOUS(viscous_signal, true)

/* minus v_ij . G, which heats where it is positive: v_ij . Gbar. */
CLONES static void find_approach(int dim, int count, const struct lanes *lanes, const double *v,
                                 const double *theirs, double *restrict approach)
{
    const ptrdiff_t stride = lanes->stride;
    const double *G = lane(lanes, LANE_GX);
    for (int k = 0; k < count; k++) approach[k] = 0;
    for (int a = 0; a < dim; a++) {
        const double *restrict Ga = G + a * stride, *restrict va = theirs + a * stride;
        const double own = v[a];
#pragma omp simd
        for (int k = 0; k < count; k++) approach[k] -= (own - va[k]) * Ga[k];
    }
}

/* Viscosity that would cool is left out: with a matrix a pair may approach against its gradient. */
CLONES static void never_cool(int count, const double *restrict approach, double *restrict K)
{
#pragma omp simd
    for (int k = 0; k < count; k++) K[k] = approach[k] > 0 ? K[k] : 0;
}

/* The linear term of viscosity=projected, of both signs (CONVENTIONS, projected):
 * PI = -nu cbar e . (1 - P_ij) u_ij/rhobar, u_ij = v_ij + (L_i + L_j) x/2, e = -x/r. */
CLONES static void project_noise(int dim, int count, double nu, const struct sides *sides,
                                 const struct lanes *lanes, const double *const own[3],
                                 const double *const theirs[3])
{
    const ptrdiff_t stride = lanes->stride;
    const double *x = lane(lanes, LANE_DX), *restrict r_inverse = lane(lanes, LANE_R_INVERSE);
    const double *restrict m = sides->m, *restrict c = sides->c, *restrict rho = sides->rho;
    double *restrict s = lane(lanes, LANE_SPARE), *restrict K = lane(lanes, LANE_K);
    double *restrict u = lane(lanes, LANE_W), *restrict e = lane(lanes, LANE_W_J);
    const double own_m = sides->own.m, own_c = sides->own.c, own_rho = sides->own.rho;
    for (int k = 0; k < count; k++) s[k] = 0;
    for (int a = 0; a < dim; a++) {
        const double *restrict va = theirs[0] + a * stride;
        const double own_v = own[0][a];
#pragma omp simd
        for (int k = 0; k < count; k++) u[k] = own_v - va[k];
        for (int b = 0; b < dim; b++) {
            const double *restrict L = theirs[1] + (a * dim + b) * stride, *restrict xb =
                                                                               x + b * stride;
            const double own_L = own[1][a * dim + b];
#pragma omp simd
            for (int k = 0; k < count; k++) u[k] += 0.5 * (own_L + L[k]) * xb[k];
        }
        /* e - P e along this axis, with P symmetric */
        const double *restrict xa = x + a * stride;
#pragma omp simd
        for (int k = 0; k < count; k++) e[k] = xa[k];
        for (int b = 0; b < dim; b++) {
            const double *restrict P = theirs[2] + symmetric_at(dim, a, b) * stride, *restrict xb =
                                                                                         x +
                                                                                         b * stride;
            const double own_P = own[2][symmetric_at(dim, a, b)];
#pragma omp simd
            for (int k = 0; k < count; k++) e[k] -= 0.5 * (own_P + P[k]) * xb[k];
        }
#pragma omp simd
        for (int k = 0; k < count; k++) s[k] += e[k] * u[k];
    }
    /* K = m_i m_j PI/2, and e . (1 - P) u = -s/r */
#pragma omp simd
    for (int k = 0; k < count; k++)
        K[k] +=
            own_m * m[k] * (0.5 * nu) * (own_c + c[k]) * (s[k] * r_inverse[k]) / (own_rho + rho[k]);
}

/* Conductivity (Price 2008), into heat: sum_j m_i m_j alpha_u v_u (u_i - u_j)/rhobar e_ij . Gbar.
 */
CLONES static double conducted(int dim, int count, double alpha_u, const struct sides *sides,
                               const struct lanes *lanes, double own_u, const double *restrict u)
{
    const ptrdiff_t stride = lanes->stride;
    const double *x = lane(lanes, LANE_DX),
                 *G = lane(lanes, LANE_GX), *restrict r_inverse = lane(lanes, LANE_R_INVERSE);
    const double *restrict m = sides->m, *restrict rho = sides->rho, *restrict P = sides->P;
    const double own_m = sides->own.m, own_P = sides->own.P, own_rho = sides->own.rho;
    double *restrict s = lane(lanes, LANE_SPARE);
    for (int k = 0; k < count; k++) s[k] = 0;
    for (int a = 0; a < dim; a++) {
        const double *restrict xa = x + a * stride, *restrict Ga = G + a * stride;
#pragma omp simd
        for (int k = 0; k < count; k++) s[k] += xa[k] * Ga[k];
    }
#pragma omp simd
    for (int k = 0; k < count; k++) {
        const double rho_bar = 0.5 * (own_rho + rho[k]);
        const double speed = sqrt(fabs(own_P - P[k]) / rho_bar);
        const double along_pair = least(s[k] * r_inverse[k], 0);
        s[k] = own_m * m[k] * alpha_u * speed * (own_u - u[k]) / rho_bar * along_pair;
    }
    return lanes_sum(s, count);
}

/* --- sums ------------------------------------------------------------------------------------- */

struct totals {
    double F[3], de, div_v;
};

/* One axis of the sums: force, and of the energy what moves along this axis. */
CLONES static void add_axis(enum energy energy, int count, const struct lanes *lanes,
                            const double *restrict G, const double *restrict G_i,
                            const double *restrict G_j, double own_v, const double *restrict v,
                            double *F, double *de)
{
    const double *restrict a_i = lane(lanes, LANE_A_I), *restrict a_j = lane(lanes, LANE_A_J),
                           *restrict K = lane(lanes, LANE_K);
    double f[GRID_LANES] = {0}, e[GRID_LANES] = {0};
    for (int k = 0; k < count; k += GRID_LANES)
#pragma omp simd
        for (int l = 0; l < GRID_LANES; l++) {
            const int n = k + l;
            const double viscous = K[n] * G[n];
            const struct pair_terms a = {a_i[n] * G_i[n] + viscous, a_j[n] * G_j[n] + viscous};
            f[l] += a.i + a.j;
            e[l] += energy == ENERGY_TOTAL ? pair_energy_flux(a, own_v, v[n])
                                           : pair_heating(a, v[n] - own_v).i;
        }
    *F = TREE(f);
    *de += TREE(e);
}

/* All axes at once, where both sides of a pair share its gradient. */
ALWAYS_INLINE void add_all_body(int dim, enum energy energy, int count, const struct lanes *lanes,
                                const double *v, const double *theirs, struct totals *totals)
{
    const ptrdiff_t stride = lanes->stride;
    const double *restrict a_i = lane(lanes, LANE_A_I), *restrict a_j = lane(lanes, LANE_A_J),
                           *restrict K = lane(lanes, LANE_K), *restrict G = lane(lanes, LANE_GX);
    double f[3][GRID_LANES] = {{0}}, e[GRID_LANES] = {0};
    for (int k = 0; k < count; k += GRID_LANES)
#pragma omp simd
        for (int l = 0; l < GRID_LANES; l++) {
            const int n = k + l;
            const struct pair_terms a = {a_i[n] + K[n], a_j[n] + K[n]};
            double moved = 0;
            for (int axis = 0; axis < dim; axis++) {
                const double g = G[axis * stride + n], v_j = theirs[axis * stride + n];
                f[axis][l] += (a.i + a.j) * g;
                moved += energy == ENERGY_TOTAL ? pair_energy_flux(a, v[axis], v_j) * g
                                                : pair_heating(a, v_j - v[axis]).i * g;
            }
            e[l] += moved;
        }
    for (int axis = 0; axis < dim; axis++) totals->F[axis] = TREE(f[axis]);
    totals->de = TREE(e);
}

CLONES static void add_all(int dim, enum energy energy, int count, const struct lanes *lanes,
                           const double *v, const double *theirs, struct totals *totals)
{
    if (dim == 2) {
        if (energy == ENERGY_TOTAL)
            add_all_body(2, ENERGY_TOTAL, count, lanes, v, theirs, totals);
        else
            add_all_body(2, ENERGY_INTERNAL, count, lanes, v, theirs, totals);
    } else {
        if (energy == ENERGY_TOTAL)
            add_all_body(3, ENERGY_TOTAL, count, lanes, v, theirs, totals);
        else
            add_all_body(3, ENERGY_INTERNAL, count, lanes, v, theirs, totals);
    }
}

/* The largest signal speed among pairs within max(h_i, h_j), and how many there are. */
CLONES static double find_signal(int count, const struct sides *sides, const struct lanes *lanes,
                                 int64_t *pairs)
{
    const double *restrict r = lane(lanes, LANE_R), *restrict closing = lane(lanes, LANE_CLOSING),
                           *restrict c = sides->c, *restrict h = sides->h;
    const double own_c = sides->own.c, own_h = sides->own.h;
    double top[GRID_LANES] = {0}, inside[GRID_LANES] = {0};
    for (int k = 0; k < count; k += GRID_LANES)
#pragma omp simd
        for (int l = 0; l < GRID_LANES; l++) {
            const int n = k + l;
            const double near = r[n] < largest(own_h, h[n]) ? 1 : 0;
            top[l] = largest(top[l], near * pair_signal_speed(own_c, c[n], closing[n]));
            inside[l] += near;
        }
    double most = 2 * own_c, number = 0;
    for (int l = 0; l < GRID_LANES; l++) {
        most = largest(most, top[l]);
        number += inside[l];
    }
    *pairs += (int64_t)number;
    return most;
}

static void add_viscosity(const struct cells *cells, int count, const struct lanes *lanes,
                          const struct sides *sides, const double *record)
{
    const struct cells_method *method = &cells->method;
    const struct lanes_layout *layout = &cells->force;
    const int dim = method->box.dim;
    double *K = lane(lanes, LANE_K);
    if (method->viscosity == VISCOSITY_NONE) {
        for (int k = 0; k < count; k++) K[k] = 0;
        return;
    }
    if (method->viscosity == VISCOSITY_RECONSTRUCTED)
        slopes_along(dim, count, lanes, record + layout->offset[GROUP_SLOPE],
                     lane_of(lanes, layout, GROUP_SLOPE, 0));
    (method->signal_form ? viscous_signal : viscous_mu)(method->viscosity, count, &method->numbers,
                                                        sides, lanes);
    if (method->balsara)
        limit_viscosity(count, method->projected, sides->own_balsara, sides->balsara, K);
    if (method->viscosity == VISCOSITY_RECONSTRUCTED) {
        double *approach = lane(lanes, LANE_SPARE);
        find_approach(dim, count, lanes, record + layout->offset[GROUP_MOTION],
                      lane_of(lanes, layout, GROUP_MOTION, 0), approach);
        never_cool(count, approach, K);
    }
    if (method->projected)
        project_noise(dim, count, method->noise, sides, lanes,
                      (const double *const[3]){record + layout->offset[GROUP_MOTION],
                                               record + layout->offset[GROUP_SLOPE],
                                               record + layout->offset[GROUP_PROJECTOR]},
                      (const double *const[3]){lane_of(lanes, layout, GROUP_MOTION, 0),
                                               lane_of(lanes, layout, GROUP_SLOPE, 0),
                                               lane_of(lanes, layout, GROUP_PROJECTOR, 0)});
}

/* sum_j V_j v_ij . G, which is div v of CONVENTIONS with the pair gradient. */
static double divergence(int dim, int count, const struct lanes *lanes, const struct sides *sides,
                         const double *v, const double *theirs)
{
    double *approach = lane(lanes, LANE_SPARE);
    find_approach(dim, count, lanes, v, theirs, approach);
    return -lanes_dot(sides->V, approach, count);
}

static void force_pass(struct cells *cells, const struct cells_fields *fields, size_t slot,
                       struct lanes *lanes)
{
    const struct cells_method *method = &cells->method;
    const struct lanes_layout *layout = &cells->force;
    const int dim = method->box.dim, count = lanes_gather(cells, layout, slot, lanes);
    const int neighbours = grid_lists(cells->grid)[slot].count;
    const double *record = cells->records + (ptrdiff_t)slot * layout->size;
    const double *v = record + layout->offset[GROUP_MOTION];
    const double *theirs = lane_of(lanes, layout, GROUP_MOTION, 0);
    const struct sides sides = find_sides(cells, lanes, record);
    find_closing(count, lane(lanes, LANE_DX), lane(lanes, LANE_DY), lane(lanes, LANE_DZ), theirs,
                 theirs + lanes->stride, theirs + 2 * lanes->stride, v, lane(lanes, LANE_R_INVERSE),
                 lane(lanes, LANE_CLOSING));
    pair_gradients(cells, count, neighbours, lanes, record);
    pressure(method->formulation, method->number, count, &sides, lane(lanes, LANE_A_I),
             lane(lanes, LANE_A_J));
    add_viscosity(cells, count, lanes, &sides, record);
    struct totals totals = {0};
    if (method->formulation == FORMULATION_VANILLA_ICE)
        add_all(dim, method->energy, count, lanes, v, theirs, &totals);
    else
        for (int a = 0; a < dim; a++)
            add_axis(method->energy, count, lanes, lane(lanes, LANE_GX + a),
                     lane(lanes, LANE_GX_I + a), lane(lanes, LANE_GX_J + a), v[a],
                     theirs + a * lanes->stride, &totals.F[a], &totals.de);
    if (method->conductivity > 0)
        totals.de += conducted(dim, count, method->conductivity, &sides, lanes,
                               record[layout->offset[GROUP_VISCOSITY] + 3],
                               lane_of(lanes, layout, GROUP_VISCOSITY, 3));
    const size_t i = grid_order(cells->grid)[slot];
    for (int a = 0; a < dim; a++) fields->F[a][i] = totals.F[a];
    fields->de[i] = totals.de;
    if (method->div_v) fields->div_v[i] = divergence(dim, count, lanes, &sides, v, theirs);
    fields->signal[i] = find_signal(count, &sides, lanes, &lanes->pairs);
}

uint64_t cells_forces(struct cells *cells, const struct cells_fields *fields)
{
    fill_records(cells, fields);
    for (int t = 0; t < cells->method.threads; t++) cells->lanes[t].pairs = 0;
    lanes_all(cells, fields, force_pass);
    int64_t directed = 0;
    for (int t = 0; t < cells->method.threads; t++) directed += cells->lanes[t].pairs;
    return (uint64_t)directed / 2;
}

/* --- the time step alone ---------------------------------------------------------------------- */

static void signal_pass(struct cells *cells, const struct cells_fields *fields, size_t slot,
                        struct lanes *lanes)
{
    const struct lanes_layout *layout = &cells->force;
    const int count = lanes_gather(cells, layout, slot, lanes);
    const double *record = cells->records + (ptrdiff_t)slot * layout->size;
    const double *theirs = lane_of(lanes, layout, GROUP_MOTION, 0);
    const struct sides sides = find_sides(cells, lanes, record);
    int64_t pairs = 0;
    find_closing(count, lane(lanes, LANE_DX), lane(lanes, LANE_DY), lane(lanes, LANE_DZ), theirs,
                 theirs + lanes->stride, theirs + 2 * lanes->stride,
                 record + layout->offset[GROUP_MOTION], lane(lanes, LANE_R_INVERSE),
                 lane(lanes, LANE_CLOSING));
    fields->signal[grid_order(cells->grid)[slot]] = find_signal(count, &sides, lanes, &pairs);
}

void cells_signal(struct cells *cells, const struct cells_fields *fields)
{
    fill_records(cells, fields);
    lanes_all(cells, fields, signal_pass);
}
