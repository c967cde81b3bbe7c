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

/* Puts the sums of the velocity gradient into a lane, zeros if all velocities agree. */
static void put_velocities(const struct cells *cells, const struct cells_fields *fields,
                           size_t slot, int count, struct lanes *lanes, const double *weight,
                           int lane)
{
    const struct lanes_layout *layout = &cells->matrix;
    const int dim = cells->method.box.dim;
    const double *own = cells->records + (ptrdiff_t)slot * layout->size +
                        layout->offset[RECORD_VELOCITY],
                 *v = lane_of(lanes, layout, RECORD_VELOCITY),
                 /* `projected` needs the direction of arbitrarily small slopes */
        limit = viscosity_of[cells->method.viscosity].noise
                    ? 0
                    : cells->method.still * fields->c[cells->order[slot]];
    if (!(fabs(*v - *own) < limit &&
          lanes_agree(dim, cells->lists[slot].count, lanes->stride, own, v, limit))) {
        moments_put_differences(dim, dim, count, lanes, weight, v, own, lane, lanes->by_w.velocity);
        return;
    }
    lanes->left_out.slope++;
    for (int k = 0; k < dim * dim; k++) lanes->by_w.velocity[k][lane] = 0;
}

/* Sets the velocity gradients of the particles in a batch with weight w(q), and the weights of the
 * standard gradient: 1 if the matrix is unusable. */
static void find_slopes(const struct cells *cells, const struct cells_fields *fields,
                        struct moments_batch *batch)
{
    const struct cells_method *method = &cells->method;
    const struct gradient_descriptor *gradient = &gradient_of[method->gradient];
    const int dim = method->box.dim;
    if (method->velocity_gradient) moments_apply(dim, dim, batch, batch->velocity);
    if (gradient->share) moments_apply(dim, 1, batch, batch->width);
    for (int l = 0; l < batch->count; l++) {
        const size_t i = batch->particle[l];
        for (int k = 0; method->velocity_gradient && k < dim * dim; k++) {
            if (fields->local) fields->slope_before[k][i] = fields->slope[k][i];
            fields->slope[k][i] = batch->velocity[k][l];
        }
        if (!gradient->share) continue;
        double square = 0;
        for (int a = 0; a < dim; a++) square += batch->width[a][l] * batch->width[a][l];
        fields->steep[i] = batch->sound[l] ? gradient->share(sqrt(square)) : 1;
    }
}

/* Sets the matrices and shifts of the particles in a batch with the gradient's weight. Without a
 * usable matrix the shift is 0. */
static void find_matrices(const struct cells *cells, const struct cells_fields *fields,
                          struct moments_batch *batch)
{
    const struct cells_method *method = &cells->method;
    const int dim = method->box.dim;
    if (method->shift) moments_apply(dim, 1, batch, batch->one);
    for (int l = 0; l < batch->count; l++) {
        const size_t i = batch->particle[l];
        fields->condition[i] = batch->condition[l];
        for (int k = 0; k < dim * (dim + 1) / 2; k++) {
            if (fields->local) fields->matrix_before[k][i] = fields->matrix[k][i];
            fields->matrix[k][i] = batch->inverse[k][l];
        }
        if (!method->shift) continue;
        double of_one[3] = {0}, shift[3];
        for (int a = 0; a < dim; a++) of_one[a] = batch->one[a][l], shift[a] = fields->shift[a][i];
        shifting_velocity(dim, of_one, 1 / method->numbers.near, 1 / fields->h_inverse[i],
                          fields->c[i], shift);
        for (int a = 0; a < dim; a++) fields->shift[a][i] = shift[a];
    }
}

/* Solves the particles of both batches and empties these. */
static void solve(const struct cells *cells, const struct cells_fields *fields, struct lanes *lanes)
{
    const enum gradient_weight weight = gradient_of[cells->method.gradient].weight;
    moments_solve(&cells->method, &lanes->by_w);
    moments_solve(&cells->method, &lanes->by_gradient);
    find_slopes(cells, fields, &lanes->by_w);
    if (weight != WEIGHT_NONE)
        find_matrices(cells, fields, weight == WEIGHT_W ? &lanes->by_w : &lanes->by_gradient);
    lanes->by_w.count = lanes->by_gradient.count = 0;
}

static void matrix_pass(struct cells *cells, const struct cells_fields *fields, size_t slot,
                        struct lanes *lanes)
{
    const struct cells_method *method = &cells->method;
    const struct lanes_layout *layout = &cells->matrix;
    const size_t i = cells->order[slot];
    if (lanes_part(cells, i) != CELLS_ACTIVE) return;
    const int dim = method->box.dim, count = lanes_gather(cells, layout, slot, lanes);
    const double *V = lane_of(lanes, layout, RECORD_WEIGHT), h_inverse = fields->h_inverse[i],
                 none = 0;
    const struct gradient_descriptor *gradient = &gradient_of[method->gradient];
    double *weight = lane(lanes, LANE_W_J);
    struct moments_batch *batch = &lanes->by_w;
    int put = 0;
    if (gradient->weight == WEIGHT_W || method->velocity_gradient) {
        moments_weigh(cells, count, lanes, h_inverse, V);
        put = moments_put(method, count, lanes, weight, i, batch);
        if (method->velocity_gradient)
            put_velocities(cells, fields, slot, count, lanes, weight, put);
        if (gradient->share)
            moments_put_differences(dim, 1, count, lanes, weight, lane_of(lanes, layout, RECORD_H),
                                    cells->records + (ptrdiff_t)slot * layout->size +
                                        layout->offset[RECORD_H],
                                    put, batch->width);
    }
    if (gradient->weight > WEIGHT_W) {
        double *q = lane(lanes, LANE_Q);
        scale(count, lane(lanes, LANE_R), h_inverse, q);
        cells->shapes.dw(method->kernel, (size_t)count, q, lane(lanes, LANE_W));
        if (gradient->weight == WEIGHT_BOTH)
            cells->shapes.w(method->kernel, (size_t)count, q, lane(lanes, LANE_SPARE));
        weigh_matrix(method->gradient, count, 1 / h_inverse, lanes, V);
        batch = &lanes->by_gradient;
        put = moments_put(method, count, lanes, weight, i, batch);
    }
    if (method->shift)
        moments_put_differences(dim, 1, count, lanes, weight, lane(lanes, LANE_ONE), &none, put,
                                batch->one);
    if (put == GRID_LANES - 1) solve(cells, fields, lanes);
}

size_t cells_matrix(struct cells *cells, const struct cells_fields *fields)
{
    const struct cells_method *method = &cells->method;
    const bool matrix = gradient_of[method->gradient].weight != WEIGHT_NONE;
    if (!matrix && !method->velocity_gradient) return 0;
    fill_records(cells, fields);
    lanes_all(cells, fields, matrix_pass);
    for (int t = 0; t < method->threads; t++) solve(cells, fields, &cells->lanes[t]);
    size_t fallen_back = 0;
    for (size_t i = 0; matrix && i < fields->n; i++) {
        if (lanes_part(cells, i) != CELLS_ACTIVE) continue;
        if (!(fields->condition[i] <= method->worst_condition)) fallen_back++;
    }
    cells->all_sound = fallen_back == 0 && !cells->parts;
    return fallen_back;
}
