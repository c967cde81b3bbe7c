/* SPDX-License-Identifier: GPL-3.0-or-later
 * The moment matrix T_i = sum_j V_j x x^T W and its inverse (Garcia-Senz, Cabezon & Escartin 2012),
 * with the gradient's weight in place of W, and the linear_exact velocity gradient (grad v)_i =
 * sum_j V_j (v_j - v_i) (x) C_i x W (Price 2004). C/h^d cancels between matrix and gradient, so
 * both are written with w(q). x = r_j - r_i. */
#include <math.h>

#include "moments.h"
#include "pairs.h"
#include "shifting.h"
#include "specialise.h"

static void fill_records(struct cells *cells, const struct cells_fields *fields)
{
    const struct lanes_layout *layout = &cells->matrix;
    const int dim = cells->method.box.dim, weight = layout->offset[RECORD_WEIGHT],
              velocity = layout->offset[RECORD_VELOCITY], width = layout->offset[RECORD_H];
    size_t count;
    const struct grid_run *runs = grid_runs(cells->grid, &count);
#pragma omp parallel for num_threads(cells->team) if (cells->team > 1)
    for (size_t r = 0; r < count; r++)
        for (size_t s = runs[r].begin; s < runs[r].end; s++) {
            double *record = lanes_record(cells, layout, s);
            int mirrored;
            const size_t i = lanes_source(cells, fields->n, s, &mirrored);
            record[weight] = fields->V[i];
            if (width) record[width] = 1 / fields->h_inverse[i];
            for (int a = 0; velocity && a < dim; a++)
                record[velocity + a] = lanes_sign(mirrored, a) * fields->v[a][i];
        }
    lanes_sentinel(cells, layout);
}

/* q = r/h. */
CLONES static void scale(int count, const double *restrict r, double h_inverse, double *restrict q)
{
#pragma omp simd
    for (int k = 0; k < whole_vectors(count); k++) q[k] = r[k] * h_inverse;
}

/* Writes V times the gradient's weight to LANE_W_J, from w'(q) in LANE_W and w(q) in LANE_SPARE;
 * -w'(q)/q is 0 where points coincide. */
ALWAYS_INLINE void weigh_body(enum gradient gradient, int count, double h,
                              const struct lanes *lanes, const double *restrict V)
{
    const double *restrict r_inverse = lane(lanes, LANE_R_INVERSE),
                           *restrict dw = lane(lanes, LANE_W),
                           *restrict w = lane(lanes, LANE_SPARE);
    const bool by_both = gradient_of[gradient].weight == WEIGHT_BOTH;
    double *restrict weight = lane(lanes, LANE_W_J);
#pragma omp simd
    for (int k = 0; k < whole_vectors(count); k++)
        weight[k] =
            V[k] * gradient_weight(gradient, by_both ? w[k] : 0, -dw[k] * (r_inverse[k] * h));
}

#define WEIGH(symbol, name, ...)                                                                   \
    case symbol:                                                                                   \
        if (gradient_of[symbol].weight > WEIGHT_W) weigh_body(symbol, count, h, lanes, V);         \
        break;
CLONES static void weigh_matrix(enum gradient gradient, int count, double h,
                                const struct lanes *lanes, const double *restrict V)
{
    switch (gradient) {
        GRADIENT_LIST(WEIGH, )
    }
}

void cells_project(int dim, const double L[CELLS_SQUARE], double projector[CELLS_SYMMETRIC])
{
    if (dim == 2)
        projected_projector(2, L, projector);
    else
        projected_projector(3, L, projector);
}

static void velocity_gradient(struct cells *cells, const struct cells_fields *fields, size_t slot,
                              int count, struct lanes *lanes, const double *weight,
                              const double inverse[CELLS_SQUARE], bool sound)
{
    const struct lanes_layout *layout = &cells->matrix;
    const size_t i = cells->order[slot];
    const int dim = cells->method.box.dim;
    const double *own = cells->records + (ptrdiff_t)slot * layout->size +
                        layout->offset[RECORD_VELOCITY],
                 *v = lane_of(lanes, layout, RECORD_VELOCITY),
                 /* `projected` needs the direction of arbitrarily small slopes */
        limit =
            viscosity_of[cells->method.viscosity].noise ? 0 : cells->method.still * fields->c[i];
    double L[CELLS_SQUARE] = {0};
    if (fabs(*v - *own) < limit &&
        lanes_agree(dim, cells->lists[slot].count, lanes->stride, own, v, limit))
        lanes->left_out.slope++;
    else if (sound)
        moments_gradient(dim, count, lanes, weight, inverse, v, own, L);
    for (int k = 0; k < dim * dim; k++) {
        if (fields->local) fields->slope_before[k][i] = fields->slope[k][i];
        fields->slope[k][i] = L[k];
    }
}

/* Weight of the standard gradient, from grad h by linear_exact; 1 if the matrix is unusable. */
static double find_steep(const struct cells *cells, size_t slot, int count,
                         const struct lanes *lanes, const double *weight,
                         const double inverse[CELLS_SQUARE], bool sound)
{
    const struct lanes_layout *layout = &cells->matrix;
    const double own = cells->records[(ptrdiff_t)slot * layout->size + layout->offset[RECORD_H]];
    double slope[3];
    if (!sound) return 1;
    return gradient_of[cells->method.gradient].share(
        moments_slope(cells->method.box.dim, count, lanes, weight, inverse,
                      lane_of(lanes, layout, RECORD_H), own, slope));
}

/* Without a usable matrix the shift is 0. */
static void find_shift(const struct cells *cells, const struct cells_fields *fields, size_t i,
                       int count, const struct lanes *lanes, const double *weight,
                       const double inverse[CELLS_SQUARE], bool sound)
{
    const int dim = cells->method.box.dim;
    double of_one[3] = {0}, shift[3];
    if (sound) moments_slope(dim, count, lanes, weight, inverse, lane(lanes, LANE_ONE), 0, of_one);
    for (int a = 0; a < dim; a++) shift[a] = fields->shift[a][i];
    shifting_velocity(dim, of_one, 1 / cells->method.numbers.near, 1 / fields->h_inverse[i],
                      fields->c[i], shift);
    for (int a = 0; a < dim; a++) fields->shift[a][i] = shift[a];
}

static void matrix_pass(struct cells *cells, const struct cells_fields *fields, size_t slot,
                        struct lanes *lanes)
{
    const struct cells_method *method = &cells->method;
    const size_t i = cells->order[slot];
    if (lanes_part(cells, i) != CELLS_ACTIVE) return;
    const int dim = method->box.dim, count = lanes_gather(cells, &cells->matrix, slot, lanes);
    const double *V = lane_of(lanes, &cells->matrix, RECORD_WEIGHT),
                 h_inverse = fields->h_inverse[i];
    double *dw = lane(lanes, LANE_W), *weight = lane(lanes, LANE_W_J);
    double inverse[CELLS_SQUARE], condition;
    const struct gradient_descriptor *gradient = &gradient_of[method->gradient];
    bool sound = false;
    if (gradient->weight == WEIGHT_W || method->velocity_gradient) {
        moments_weigh(cells, count, lanes, h_inverse, V);
        sound = moments_invert(method, count, lanes, weight, inverse, &condition);
    }
    if (method->velocity_gradient)
        velocity_gradient(cells, fields, slot, count, lanes, weight, inverse, sound);
    if (gradient->weight == WEIGHT_NONE) return;
    if (gradient->share)
        fields->steep[i] = find_steep(cells, slot, count, lanes, weight, inverse, sound);
    if (gradient->weight > WEIGHT_W) {
        double *q = lane(lanes, LANE_Q);
        scale(count, lane(lanes, LANE_R), h_inverse, q);
        cells->shapes.dw(method->kernel, (size_t)count, q, dw);
        if (gradient->weight == WEIGHT_BOTH)
            cells->shapes.w(method->kernel, (size_t)count, q, lane(lanes, LANE_SPARE));
        weigh_matrix(method->gradient, count, 1 / h_inverse, lanes, V);
        sound = moments_invert(method, count, lanes, weight, inverse, &condition);
    }
    fields->condition[i] = condition;
    if (method->shift) find_shift(cells, fields, i, count, lanes, weight, inverse, sound);
    int k = 0;
    for (int a = 0; a < dim; a++)
        for (int b = a; b < dim; b++, k++) {
            if (fields->local) fields->matrix_before[k][i] = fields->matrix[k][i];
            fields->matrix[k][i] = sound ? 0.5 * (inverse[a * dim + b] + inverse[b * dim + a]) : 0;
        }
}

size_t cells_matrix(struct cells *cells, const struct cells_fields *fields)
{
    const struct cells_method *method = &cells->method;
    const bool matrix = gradient_of[method->gradient].weight != WEIGHT_NONE;
    if (!matrix && !method->velocity_gradient) return 0;
    fill_records(cells, fields);
    lanes_all(cells, fields, matrix_pass);
    size_t fallen_back = 0;
    for (size_t i = 0; matrix && i < fields->n; i++) {
        if (lanes_part(cells, i) != CELLS_ACTIVE) continue;
        if (!(fields->condition[i] <= method->worst_condition)) fallen_back++;
    }
    return fallen_back;
}
