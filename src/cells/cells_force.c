/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pair forces in 2D and 3D. The gradient of a pair is a vector here: grad_i W(h_i) = -s_i x with a
 * number s_i (standard) or with the matrix C_i w(q_i) (ia) in place of it, x = r_j - r_i. Forces
 * are along G = s x, the negative gradient, so that the terms of pair.h are taken with G = 1:
 *   dp_i/dt = sum_j a_i G_i + a_j G_j + 2 K G,   dU_i/dt = -sum_j v_ij . (a_i G_i + K G). */
#include <math.h>

#include "sides.h"
#include "stamp.h"

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
#pragma omp parallel for num_threads(cells->team) if (cells->team > 1)
    for (size_t s = 0; s < cells->points; s++) {
        double *record = cells->records + (ptrdiff_t)s * cells->force.size;
        for (int a = 0; a < 3; a++) record[a] = place[s][a];
        int mirrored;
        const size_t i = lanes_source(cells, fields->n, s, &mirrored);
        fill_record(cells, fields, i, mirrored, record);
    }
    fill_sentinel(cells, cells->points);
}

/* --- geometry ------------------------------------------- */

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

/* --- physics ---------------------------------------------------------------------------------- */

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

/* --- sums ------------------------------------------------------------------------------------- */

struct totals {
    double F[3], de, div_v, signal;
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

/* What the count neighbours in the lanes do to a particle; neighbours: those that are no
 * fillings. */
static void add_part(struct cells *cells, int count, int neighbours, const double *record,
                     struct lanes *lanes, struct totals *totals)
{
    const struct cells_method *method = &cells->method;
    const struct lanes_layout *layout = &cells->force;
    const int dim = method->box.dim;
    const double *v = record + layout->offset[GROUP_MOTION];
    const double *theirs = lane_of(lanes, layout, GROUP_MOTION, 0);
    const struct sides sides = find_sides(cells, lanes, record);
    struct totals part = {0};
    find_closing(count, lane(lanes, LANE_DX), lane(lanes, LANE_DY), lane(lanes, LANE_DZ), theirs,
                 theirs + lanes->stride, theirs + 2 * lanes->stride, v, lane(lanes, LANE_R_INVERSE),
                 lane(lanes, LANE_CLOSING));
    cells_pair_gradients(cells, count, neighbours, lanes, record);
    pressure(method->formulation, method->number, count, &sides, lane(lanes, LANE_A_I),
             lane(lanes, LANE_A_J));
    cells_viscosity(cells, count, lanes, &sides, record);
    if (method->formulation == FORMULATION_VANILLA_ICE)
        add_all(dim, method->energy, count, lanes, v, theirs, &part);
    else
        for (int a = 0; a < dim; a++)
            add_axis(method->energy, count, lanes, lane(lanes, LANE_GX + a),
                     lane(lanes, LANE_GX_I + a), lane(lanes, LANE_GX_J + a), v[a],
                     theirs + a * lanes->stride, &part.F[a], &part.de);
    if (method->conductivity > 0)
        part.de += cells_conduction(cells, count, &sides, lanes,
                                    record[layout->offset[GROUP_VISCOSITY] + 3],
                                    lane_of(lanes, layout, GROUP_VISCOSITY, 3));
    for (int a = 0; a < dim; a++) totals->F[a] += part.F[a];
    totals->de += part.de;
    if (method->div_v) totals->div_v += cells_divergence(dim, count, lanes, &sides, v, theirs);
    totals->signal = largest(totals->signal, find_signal(count, &sides, lanes, &lanes->pairs));
}

static void force_pass(struct cells *cells, const struct cells_fields *fields, size_t slot,
                       struct lanes *lanes)
{
    const struct lanes_layout *layout = &cells->force;
    const int neighbours = grid_lists(cells->grid)[slot].count;
    const double *record = cells->records + (ptrdiff_t)slot * layout->size;
    struct totals totals = {.signal = 2 * record[layout->offset[GROUP_GAS] + 3]};
    for (int from = 0, count; from < neighbours; from += count) {
        count = lanes_gather_part(cells, layout, slot, from, lanes);
        add_part(cells, count, neighbours - from, record, lanes, &totals);
    }
    const size_t i = grid_order(cells->grid)[slot];
    for (int a = 0; a < cells->method.box.dim; a++) fields->F[a][i] = totals.F[a];
    fields->de[i] = totals.de;
    if (cells->method.div_v) fields->div_v[i] = totals.div_v;
    fields->signal[i] = totals.signal;
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
