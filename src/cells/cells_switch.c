/* SPDX-License-Identifier: GPL-3.0-or-later
 * Inputs of the viscosity switch for one particle (CONVENTIONS eqs. 6.6 and 6.7; the formula is in
 * the viscosity's file). The derivative of div v along the flow comes from the gradient of the
 * acceleration, d(div v)/dt = div a - tr(L L), so it belongs to the same time as the rates and
 * needs no previous step. */
#include <math.h>

#include "moments.h"
#include "specialise.h"

static double divergence_of(int dim, const struct cells_fields *fields, size_t i)
{
    double divergence = 0;
    for (int a = 0; a < dim; a++) divergence += fields->slope[a * dim + a][i];
    return divergence;
}

static void fill_records(struct cells *cells, const struct cells_fields *fields)
{
    const struct lanes_layout *layout = &cells->shift;
    const int dim = cells->method.box.dim, *at = layout->offset;
#pragma omp parallel for num_threads(cells->team) if (cells->team > 1)
    for (size_t s = 0; s <= cells->points; s++) {
        double *record = lanes_record(cells, layout, s);
        for (int f = dim; f < layout->size; f++) record[f] = 0;
        if (s == cells->points) {
            record[at[RECORD_H_INVERSE]] = HUGE_VAL;
            continue;
        }
        int mirrored;
        const size_t i = lanes_source(cells, fields->n, s, &mirrored);
        const double divergence = divergence_of(dim, fields, i);
        record[at[RECORD_WEIGHT]] = fields->m[i] * (divergence > 0 ? 1 : divergence < 0 ? -1 : 0);
        for (int a = 0; a < dim; a++) {
            const double sign = lanes_sign(mirrored, a);
            record[at[RECORD_VELOCITY] + a] = sign * fields->v[a][i];
            record[at[RECORD_ACCELERATION] + a] = sign * (fields->F[a][i] / fields->m[i]);
        }
        record[at[RECORD_H_INVERSE]] = fields->h_inverse[i];
        record[at[RECORD_VOLUME]] = fields->V[i];
        record[at[RECORD_SOUND]] = fields->c[i];
    }
}

/* v_sig of eq. 6.6: the largest cbar - min(0, v_ij . e_ij) over pairs within max(h_i, h_j),
 * including j = i. */
CLONES static double signal_of(int dim, int count, const struct lanes *lanes, double own_h_inverse,
                               double own_c, const double *own_v, const double *restrict v,
                               const double *restrict h_inverse, const double *restrict c)
{
    const ptrdiff_t stride = lanes->stride;
    const double *restrict r = lane(lanes, LANE_R),
                           *restrict r_inverse = lane(lanes, LANE_R_INVERSE),
                           *restrict x = lane(lanes, LANE_DX);
    double top[GRID_LANES] = {0};
    for (int k = 0; k < count; k += GRID_LANES)
#pragma omp simd
        for (int l = 0; l < GRID_LANES; l++) {
            const int n = k + l;
            double closing = (own_v[0] - v[n]) * x[n] + (own_v[1] - v[stride + n]) * x[stride + n];
            if (dim == 3) closing += (own_v[2] - v[2 * stride + n]) * x[2 * stride + n];
            const double speed = 0.5 * (own_c + c[n]) + largest(closing * r_inverse[n], 0);
            top[l] = largest(top[l], pair_within(r[n], own_h_inverse, h_inverse[n]) ? speed : 0);
        }
    double most = own_c;
    for (int l = 0; l < GRID_LANES; l++) most = largest(most, top[l]);
    return most;
}

static void switch_pass(struct cells *cells, const struct cells_fields *fields, size_t slot,
                        struct lanes *lanes)
{
    const struct cells_method *method = &cells->method;
    const struct lanes_layout *layout = &cells->shift;
    const size_t i = cells->order[slot];
    const int dim = method->box.dim, count = lanes_gather(cells, layout, slot, lanes);
    const double *record = cells->records + (ptrdiff_t)slot * layout->size,
                 *weight = lane(lanes, LANE_W_J), *w = lane(lanes, LANE_W);
    double inverse[CELLS_SQUARE], condition, A_of[CELLS_SQUARE], L[CELLS_SQUARE], change = 0;
    moments_weigh(cells, count, lanes, fields->h_inverse[i], lane_of(lanes, layout, RECORD_VOLUME));
    if (moments_invert(method, count, lanes, weight, inverse, &condition)) {
        moments_gradient(dim, count, lanes, weight, inverse,
                         lane_of(lanes, layout, RECORD_ACCELERATION),
                         record + layout->offset[RECORD_ACCELERATION], A_of);
        for (int a = 0; a < dim; a++) change += A_of[a * dim + a];
    }
    for (int k = 0; k < dim * dim; k++) L[k] = fields->slope[k][i];
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) change -= L[a * dim + b] * L[b * dim + a];
    const double h_inverse = fields->h_inverse[i];
    double scale = method->kernel->constant[dim] / fields->rho[i];
    for (int a = 0; a < dim; a++) scale *= h_inverse;
    const double R = scale * (record[layout->offset[RECORD_WEIGHT]] * cells->own_w +
                              lanes_dot(lane_of(lanes, layout, RECORD_WEIGHT), w, count));
    const double rate = h_inverse * signal_of(dim, count, lanes, h_inverse, fields->c[i],
                                              record + layout->offset[RECORD_VELOCITY],
                                              lane_of(lanes, layout, RECORD_VELOCITY),
                                              lane_of(lanes, layout, RECORD_H_INVERSE),
                                              lane_of(lanes, layout, RECORD_SOUND));
    const struct viscosity_goal goal = viscosity_of[method->viscosity].find_goal(
        &(const struct viscosity_flow){.dim = dim,
                                       .L = L,
                                       .divergence = divergence_of(dim, fields, i),
                                       .change = change,
                                       .R = R,
                                       .rate = rate,
                                       .alpha_min = method->alpha_min,
                                       .alpha_max = method->alpha_max});
    fields->alpha_local[i] = goal.alpha;
    fields->decay[i] = goal.decay;
}

void cells_switch(struct cells *cells, const struct cells_fields *fields)
{
    for (size_t i = 0; i < fields->n; i++) { /* sleeping particles keep these values */
        fields->alpha_local[i] = cells->method.alpha_min;
        fields->decay[i] = 0;
    }
    fill_records(cells, fields);
    lanes_all(cells, fields, switch_pass);
}
