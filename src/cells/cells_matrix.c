/* SPDX-License-Identifier: GPL-3.0-or-later
 * The moment matrix T_i = sum_j V_j x x^T W and its inverse (Garcia-Senz, Cabezon & Escartin 2012),
 * for gradient=corrected with -W'/r in place of W (Bonet & Lok 1999), and the linear_exact velocity
 * gradient (grad v)_i = sum_j V_j (v_j - v_i) (x) C_i x W (Price 2004). C/h^d cancels between
 * matrix and gradient, so both are written with w(q) alone. x = r_j - r_i. */
#include <math.h>

#include "moments.h"
#include "pairs.h"
#include "specialise.h"
#include "traits.h"

static void fill_records(struct cells *cells, const struct cells_fields *fields)
{
    const struct lanes_layout *layout = &cells->matrix;
    const int dim = cells->method.box.dim, weight = layout->offset[FIELD_WEIGHT],
              velocity = layout->offset[FIELD_VELOCITY], width = layout->offset[FIELD_H];
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
    for (int k = 0; k < count; k++) q[k] = r[k] * h_inverse;
}

/* V times -w'(q)/q, the weight of gradient=corrected; 0 where points coincide. */
CLONES static void slope_weight(int count, double h, const struct lanes *lanes,
                                const double *restrict V)
{
    const double *restrict r_inverse = lane(lanes, LANE_R_INVERSE), *restrict dw =
                                                                        lane(lanes, LANE_W);
    double *restrict weight = lane(lanes, LANE_W_J);
#pragma omp simd
    for (int k = 0; k < count; k++) weight[k] = V[k] * (-dw[k] * (r_inverse[k] * h));
}

/* A A^T. */
ALWAYS_INLINE void times_transposed(int dim, const double A[CELLS_SQUARE],
                                    double product[CELLS_SQUARE])
{
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) {
            double sum = 0;
            for (int c = 0; c < dim; c++) sum += A[a * dim + c] * A[b * dim + c];
            product[a * dim + b] = sum;
        }
}

/* P = kappa M^2/tr M^2 with M = L L^T and kappa = smoothstep((s - 0.7)/0.25),
 * s = 2 tr M^2/(tr M)^2 - 1: 1 for simple shear, 0 for rotation. Where M is 0 so is P. */
ALWAYS_INLINE void project_body(int dim, const double L[CELLS_SQUARE],
                                double projector[CELLS_SYMMETRIC])
{
    double M[CELLS_SQUARE], M2[CELLS_SQUARE], trace = 0, trace2 = 0;
    times_transposed(dim, L, M);
    times_transposed(dim, M, M2);
    for (int a = 0; a < dim; a++) trace += M[a * dim + a], trace2 += M2[a * dim + a];
    for (int k = 0; k < CELLS_SYMMETRIC; k++) projector[k] = 0;
    if (!(trace2 > 0)) return;
    const double s = 2 * trace2 / (trace * trace) - 1;
    const double t = least(1, largest(0, (s - 0.7) / 0.25)), kappa = t * t * (3 - 2 * t);
    int k = 0;
    for (int a = 0; a < dim; a++)
        for (int b = a; b < dim; b++) projector[k++] = kappa * M2[a * dim + b] / trace2;
}

void cells_project(int dim, const double L[CELLS_SQUARE], double projector[CELLS_SYMMETRIC])
{
    if (dim == 2)
        project_body(2, L, projector);
    else
        project_body(3, L, projector);
}

static void velocity_gradient(struct cells *cells, const struct cells_fields *fields, size_t slot,
                              int count, struct lanes *lanes, const double *weight,
                              const double inverse[CELLS_SQUARE], bool sound)
{
    const struct lanes_layout *layout = &cells->matrix;
    const size_t i = cells->order[slot];
    const int dim = cells->method.box.dim;
    const double *own = cells->records + (ptrdiff_t)slot * layout->size +
                        layout->offset[FIELD_VELOCITY],
                 *v = lane_of(lanes, layout, FIELD_VELOCITY),
                 /* the direction of `projected` is that of the smallest slope, too */
        limit = cells->method.projected ? 0 : cells->method.still * fields->c[i];
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

/* The standard gradient's share, CONVENTIONS eq. 4.8: smoothstep((|grad h| - 0.05)/0.1), grad h by
 * linear_exact; all of it where there is none. */
static double find_steep(const struct cells *cells, size_t slot, int count,
                         const struct lanes *lanes, const double *weight,
                         const double inverse[CELLS_SQUARE], bool sound)
{
    const struct lanes_layout *layout = &cells->matrix;
    const double own = cells->records[(ptrdiff_t)slot * layout->size + layout->offset[FIELD_H]];
    if (!sound) return 1;
    const double slope = moments_steepness(cells->method.box.dim, count, lanes, weight, inverse,
                                           lane_of(lanes, layout, FIELD_H), own);
    const double t = least(1, largest(0, (slope - 0.05) / 0.1));
    return t * t * (3 - 2 * t);
}

static void matrix_pass(struct cells *cells, const struct cells_fields *fields, size_t slot,
                        struct lanes *lanes)
{
    const struct cells_method *method = &cells->method;
    const size_t i = cells->order[slot];
    if (lanes_part(cells, i) != CELLS_ACTIVE) return;
    const int dim = method->box.dim, count = lanes_gather(cells, &cells->matrix, slot, lanes);
    const double *V = lane_of(lanes, &cells->matrix, FIELD_WEIGHT),
                 h_inverse = fields->h_inverse[i];
    double *dw = lane(lanes, LANE_W), *weight = lane(lanes, LANE_W_J);
    double inverse[CELLS_SQUARE], condition;
    const struct gradient_traits *gradient = &traits_gradient[method->gradient];
    const bool by_w = gradient->matrix && !gradient->by_slope;
    bool sound = false;
    if (by_w || method->velocity_gradient) {
        moments_weigh(cells, count, lanes, h_inverse, V);
        sound = moments_invert(method, count, lanes, weight, inverse, &condition);
    }
    if (method->velocity_gradient)
        velocity_gradient(cells, fields, slot, count, lanes, weight, inverse, sound);
    if (!gradient->matrix) return;
    if (gradient->blends)
        fields->steep[i] = find_steep(cells, slot, count, lanes, weight, inverse, sound);
    if (gradient->by_slope) {
        double *q = lane(lanes, LANE_Q);
        scale(count, lane(lanes, LANE_R), h_inverse, q);
        cells->shapes.dw(method->kernel, (size_t)count, q, dw);
        slope_weight(count, 1 / h_inverse, lanes, V);
        sound = moments_invert(method, count, lanes, weight, inverse, &condition);
    }
    fields->condition[i] = condition;
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
    const bool matrix = traits_gradient[method->gradient].matrix;
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
