/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particle shifting in 2D and 3D, pair by pair. With shifting=closed the gradients are changed
 * before the forces; the exchange follows after them. */
#include "shifting.h"

#include "pairs.h"

ALWAYS_INLINE void close_body(int dim, const struct pairs *pairs)
{
    const struct lanes *lanes = pairs->lanes;
    const ptrdiff_t stride = lanes->stride;
    const double *restrict x = lane(lanes, LANE_DX), *restrict potential =
                                                         pairs_others(pairs, RECORD_POTENTIAL);
    const double *own = pairs_own(pairs, RECORD_POTENTIAL);
    double *restrict G = lane(lanes, LANE_GX);
#pragma omp simd
    for (int n = 0; n < whole_vectors(pairs->count); n++) {
        double along = 0;
        for (int a = 0; a < dim; a++) along += G[a * stride + n] * x[a * stride + n];
        for (int a = 0; a < dim; a++)
            G[a * stride + n] -= shifting_closure(dim, along, own[a], potential[a * stride + n]);
    }
}

CLONES static void close_pairs(int dim, const struct pairs *pairs)
{
    if (dim == 2)
        close_body(2, pairs);
    else
        close_body(3, pairs);
}

void cells_close(const struct cells *cells, const struct pairs *pairs)
{
    close_pairs(cells->method.box.dim, pairs);
}

ALWAYS_INLINE void exchange_body(int dim, bool closed, const struct pairs *pairs, double *gained)
{
    const struct lanes *lanes = pairs->lanes;
    const ptrdiff_t stride = lanes->stride;
    const double *restrict G = lane(lanes, LANE_GX),
                           *restrict V = pairs_others(pairs, RECORD_VOLUME),
                           *restrict rho = pairs_others(pairs, RECORD_DENSITY),
                           *restrict u = pairs_others(pairs, RECORD_HEAT),
                           *restrict v = pairs_others(pairs, RECORD_VELOCITY),
                           *restrict shift = pairs_others(pairs, RECORD_SHIFT);
    const double *own_v = pairs_own(pairs, RECORD_VELOCITY),
                 *own_shift = pairs_own(pairs, RECORD_SHIFT);
    const double own_V = *pairs_own(pairs, RECORD_VOLUME),
                 own_rho = *pairs_own(pairs, RECORD_DENSITY),
                 own_u = *pairs_own(pairs, RECORD_HEAT);
    double *restrict reaction = lane(lanes, LANE_REACTION + dim + 2);
    double p[3][GRID_LANES] = {{0}}, e[GRID_LANES] = {0}, m[GRID_LANES] = {0},
           of_one[3][GRID_LANES] = {{0}};
    for (int k = 0; k < pairs->count; k += GRID_LANES)
#pragma omp simd
        for (int l = 0; l < GRID_LANES; l++) {
            const ptrdiff_t n = k + l;
            double along = 0, v_dot_v = 0;
            for (int a = 0; a < dim; a++) {
                along += G[a * stride + n] * (own_shift[a] + shift[a * stride + n]);
                v_dot_v += own_v[a] * v[a * stride + n];
            }
            /* A = -2 V_i V_j G: G is minus the gradient */
            const double mass = shifting_mass(-(own_V * V[n]) * along, own_rho, rho[n]);
            const double energy = shifting_energy(mass, own_u, u[n], v_dot_v);
            for (int a = 0; a < dim; a++) {
                const double momentum = 0.5 * mass * (own_v[a] + v[a * stride + n]);
                p[a][l] += momentum;
                reaction[a * stride + n] = -momentum;
            }
            e[l] += energy;
            reaction[dim * stride + n] = -energy;
            m[l] += mass;
            reaction[(dim + 1) * stride + n] = -mass;
            for (int a = 0; closed && a < dim; a++) {
                of_one[a][l] += V[n] * G[a * stride + n];
                reaction[(dim + 2 + a) * stride + n] = -own_V * G[a * stride + n];
            }
        }
    for (int a = 0; a < dim; a++) gained[a] += TREE(p[a]);
    gained[dim] += TREE(e);
    gained[dim + 1] += TREE(m);
    for (int a = 0; closed && a < dim; a++) gained[dim + 2 + a] += TREE(of_one[a]);
}

CLONES static void exchange(int dim, bool closed, const struct pairs *pairs, double *gained)
{
    if (dim == 2 && closed)
        exchange_body(2, true, pairs, gained);
    else if (dim == 2)
        exchange_body(2, false, pairs, gained);
    else if (closed)
        exchange_body(3, true, pairs, gained);
    else
        exchange_body(3, false, pairs, gained);
}

void cells_exchange(const struct cells *cells, const struct pairs *pairs, double *gained)
{
    exchange(cells->method.box.dim, cells->method.closed, pairs, gained);
}
