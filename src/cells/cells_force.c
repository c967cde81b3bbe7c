/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pair forces in 2D and 3D. The pair gradient is a vector: grad_i W(h_i) = -s_i x, where s_i is a
 * number (standard) or the matrix C_i w(q_i) (ia) and x = r_j - r_i. Forces are along G = s x, the
 * negative gradient, so the terms of pair.h are evaluated with G = 1:
 *   dp_i/dt = sum_j a_i G_i + a_j G_j + 2 K G,   dU_i/dt = -sum_j v_ij . (a_i G_i + K G). */
#include <math.h>

#include "pairs.h"
#include "shifting.h"
#include "specialise.h"

/* --- records ---------------------------------------------------------------------------------- */

static void fill_sentinel(struct cells *cells)
{
    const struct lanes_layout *layout = &cells->force;
    const int *at = layout->offset;
    double *record = lanes_sentinel(cells, layout);
    /* The sentinel is also outside its own kernel support. A density of 1 keeps quotients finite;
     * any matrix would do. */
    record[at[RECORD_H_INVERSE]] = 16 / (record[0] > 0 ? record[0] : 1);
    if (at[RECORD_DENSITY]) record[at[RECORD_DENSITY]] = 1;
    if (at[RECORD_MATRIX]) record[at[RECORD_MATRIX]] = 1;
}

/* Extrapolates values of an inactive particle from its last two evaluations. */
ALWAYS_INLINE void extrapolate(int count, double ratio, double *const *now, double *const *before,
                               size_t i, double *values)
{
    for (int k = 0; k < count; k++) values[k] = now[k][i] + ratio * (now[k][i] - before[k][i]);
}

/* Extrapolates the matrix, changing it by at most a quarter of its trace. If the current or the
 * previous matrix is unusable (trace 0), the current one is kept. */
ALWAYS_INLINE void extrapolate_matrix(int dim, double ratio, const struct cells_fields *fields,
                                      size_t i, double *C)
{
    const int count = dim * (dim + 1) / 2;
    double trace = 0, before = 0, change = 0;
    for (int k = 0; k < count; k++)
        change += ratio * fabs(fields->matrix[k][i] - fields->matrix_before[k][i]);
    for (int a = 0; a < dim; a++) {
        const int k = symmetric_at(dim, a, a);
        trace += fields->matrix[k][i];
        before += fields->matrix_before[k][i];
    }
    const bool both = trace > 0 && before > 0;
    if (change > 0.25 * trace) ratio *= 0.25 * trace / change;
    extrapolate(count, both ? ratio : 0, fields->matrix, fields->matrix_before, i, C);
}

/* Fills in the matrices of a particle or of its wall image. */
ALWAYS_INLINE void fill_matrices(int dim, int mirrored, const struct cells *cells,
                                 const struct cells_fields *fields, size_t i, double *record)
{
    const int *at = cells->force.offset, symmetric = dim * (dim + 1) / 2;
    const bool active = lanes_part(cells, i) == CELLS_ACTIVE;
    double projector[CELLS_SYMMETRIC] = {0}, C[CELLS_SYMMETRIC] = {0}, L[CELLS_SQUARE] = {0};
    for (int k = 0; at[RECORD_MATRIX] && active && k < symmetric; k++) C[k] = fields->matrix[k][i];
    if (at[RECORD_MATRIX] && !active) extrapolate_matrix(dim, fields->ratio[i], fields, i, C);
    for (int k = 0; at[RECORD_SLOPE] && active && k < dim * dim; k++) L[k] = fields->slope[k][i];
    if (at[RECORD_SLOPE] && !active)
        extrapolate(dim * dim, fields->ratio[i], fields->slope, fields->slope_before, i, L);
    if (at[RECORD_PROJECTOR]) cells_project(dim, L, projector);
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) {
            const double sign = lanes_sign(mirrored, a) * lanes_sign(mirrored, b);
            const int ab = symmetric_at(dim, a, b), full = a * dim + b;
            if (at[RECORD_SLOPE]) record[at[RECORD_SLOPE] + full] = sign * L[full];
            if (b < a) continue;
            if (at[RECORD_MATRIX]) record[at[RECORD_MATRIX] + ab] = sign * C[ab];
            if (at[RECORD_PROJECTOR]) record[at[RECORD_PROJECTOR] + ab] = sign * projector[ab];
        }
}

ALWAYS_INLINE void fill_record(int dim, const struct cells *cells,
                               const struct cells_fields *fields, size_t i, int mirrored,
                               double *record)
{
    const struct cells_method *method = &cells->method;
    const int *at = cells->force.offset;
    if (at[RECORD_WEIGHT]) record[at[RECORD_WEIGHT]] = fields->m[i];
    for (int a = 0; a < dim; a++)
        record[at[RECORD_VELOCITY] + a] = lanes_sign(mirrored, a) * fields->v[a][i];
    record[at[RECORD_H_INVERSE]] = fields->h_inverse[i];
    record[at[RECORD_VOLUME]] = fields->V[i];
    record[at[RECORD_PRESSURE]] = fields->P[i];
    record[at[RECORD_SOUND]] = fields->c[i];
    if (at[RECORD_DENSITY]) record[at[RECORD_DENSITY]] = fields->rho[i];
    if (at[RECORD_ALPHA]) record[at[RECORD_ALPHA]] = fields->alpha[i];
    if (at[RECORD_BALSARA]) {
        double f = fields->balsara[i];
        if (lanes_part(cells, i) != CELLS_ACTIVE)
            f = largest(0, least(1, f + fields->ratio[i] * (f - fields->balsara_before[i])));
        record[at[RECORD_BALSARA]] = f;
    }
    if (at[RECORD_HEAT]) record[at[RECORD_HEAT]] = fields->U[i] / fields->m[i];
    if (at[RECORD_LAGRANGIAN]) {
        double *group = record + at[RECORD_LAGRANGIAN];
        group[0] = fields->b[i];
        group[1] = fields->grad_h[i];
        group[2] = method->energy_element ? fields->U[i] : method->number ? 1 : fields->m[i];
    }
    if (at[RECORD_STEEP]) record[at[RECORD_STEEP]] = fields->steep[i];
    for (int a = 0; at[RECORD_SHIFT] && a < dim; a++)
        record[at[RECORD_SHIFT] + a] = lanes_sign(mirrored, a) * fields->shift[a][i];
    if (at[RECORD_POTENTIAL]) {
        double *potential = record + at[RECORD_POTENTIAL];
        for (int a = 0; a < dim; a++)
            potential[a] = lanes_sign(mirrored, a) * fields->potential[a][i];
        shifting_limit(dim, SHIFTING_POTENTIAL * fields->h_inverse[i], potential);
    }
    fill_matrices(dim, mirrored, cells, fields, i, record);
}

/* Sets, for each slot, the role and pace that the force pass needs with local steps. */
static void find_kinds(struct cells *cells, const struct cells_fields *fields)
{
    for (size_t s = 0; fields->local && s < cells->points; s++) {
        int mirrored;
        const size_t i = lanes_source(cells, fields->n, s, &mirrored);
        cells->kinds[s] = (unsigned char)lanes_part(cells, i);
        cells->paces[s] = fields->pace[i];
    }
}

static void fill_records(struct cells *cells, const struct cells_fields *fields)
{
    size_t count;
    const struct grid_run *runs = grid_runs(cells->grid, &count);
    find_kinds(cells, fields);
#pragma omp parallel for num_threads(cells->team) if (cells->team > 1)
    for (size_t r = 0; r < count; r++)
        for (size_t s = runs[r].begin; s < runs[r].end; s++) {
            double *record = lanes_record(cells, &cells->force, s);
            int mirrored;
            const size_t i = lanes_source(cells, fields->n, s, &mirrored);
            if (cells->method.box.dim == 2)
                fill_record(2, cells, fields, i, mirrored, record);
            else
                fill_record(3, cells, fields, i, mirrored, record);
        }
    fill_sentinel(cells);
}

/* --- sums ------------------------------------------------------------------------------------- */

struct totals {
    double F[3], de, div_v, signal, pace;
    double shocked; /* positive if the pressures of some pair of the last sums differ enough for the
                       conductivity of shocks */
    double gained[8]; /* by shifting: momentum, energy, mass; gradient of a constant */
    bool conducts;    /* some pair conducts heat */
};

/* For each lane: the largest signal speed and the number of pairs within max(h_i, h_j). */
struct signals {
    double top[GRID_LANES], inside[GRID_LANES];
};

ALWAYS_INLINE double add_signal(struct signals *signals, int l, double weight, double r,
                                double own_h_inverse, double h_inverse, double own_c, double c,
                                double closing)
{
    const double near = pair_within(r, own_h_inverse, h_inverse) ? 1 : 0,
                 signal = near * pair_signal_speed(own_c, c, closing);
    signals->top[l] = largest(signals->top[l], signal);
    signals->inside[l] += weight * near;
    return signal;
}

static double largest_signal(const struct signals *signals, double own_c, int64_t *pairs)
{
    double most = 2 * own_c, number = 0;
    for (int l = 0; l < GRID_LANES; l++) {
        most = largest(most, signals->top[l]);
        number += signals->inside[l];
    }
    *pairs += (int64_t)number;
    return most;
}

/* The values from which the pressure terms a_i and a_j (with G = 1) follow, of the particle and of
 * its neighbours. With the number element, 1 also replaces the mass in f_ij = 1 - (m_j/Z_j)(1 -
 * f_i), because h follows from a sum of ones. */
struct pressure {
    struct pair_side own;
    const double *V, *P, *m, *b, *grad_h, *Z;
};

ALWAYS_INLINE struct pressure find_pressure(enum formulation formulation, bool number,
                                            const struct pairs *pairs)
{
    if (formulation == FORMULATION_VANILLA_ICE)
        return (struct pressure){
            .own = {.V = *pairs_own(pairs, RECORD_VOLUME), .P = *pairs_own(pairs, RECORD_PRESSURE)},
            .V = pairs_others(pairs, RECORD_VOLUME),
            .P = pairs_others(pairs, RECORD_PRESSURE)};
    const double *own = pairs_own(pairs, RECORD_LAGRANGIAN),
                 *b = pairs_others(pairs, RECORD_LAGRANGIAN), *grad_h = b + pairs->lanes->stride,
                 *Z = grad_h + pairs->lanes->stride;
    return (struct pressure){.own = {.b = own[0],
                                     .grad_h = own[1],
                                     .Z = own[2],
                                     .m = number ? own[2] : *pairs_own(pairs, RECORD_WEIGHT)},
                             .b = b,
                             .grad_h = grad_h,
                             .Z = Z,
                             .m = number ? Z : pairs_others(pairs, RECORD_WEIGHT)};
}

/* Adds force, energy rate and signal speed of all neighbours in the lanes. With vanilla_ice both
 * particles of a pair have the same gradient. reacts: some neighbours receive reactions. */
ALWAYS_INLINE void add_body(enum formulation formulation, int dim, bool reacts,
                            const struct cells_method *method, enum energy energy,
                            const struct pairs *pairs, struct totals *totals, int64_t *inside)
{
    const bool vanilla = formulation == FORMULATION_VANILLA_ICE;
    const struct pressure pressure = find_pressure(formulation, method->number, pairs);
    const struct lanes *lanes = pairs->lanes;
    const ptrdiff_t stride = lanes->stride;
    const struct pair_side own = pressure.own;
    const double *restrict V = pressure.V, *restrict P = pressure.P, *restrict m = pressure.m,
                           *restrict b = pressure.b, *restrict grad_h = pressure.grad_h,
                           *restrict Z = pressure.Z;
    const double *restrict K = lane(lanes, LANE_K), *restrict G = lane(lanes, LANE_GX),
                           *restrict G_i = lane(lanes, LANE_GX_I),
                           *restrict G_j = lane(lanes, LANE_GX_J),
                           *restrict r = lane(lanes, LANE_R),
                           *restrict closing = lane(lanes, LANE_CLOSING),
                           *restrict v = pairs_others(pairs, RECORD_VELOCITY),
                           *restrict c = pairs_others(pairs, RECORD_SOUND),
                           *restrict h_inverse = pairs_others(pairs, RECORD_H_INVERSE);
    double *restrict reaction = lane(lanes, LANE_REACTION);
    const double *own_v = pairs_own(pairs, RECORD_VELOCITY);
    const double own_c = *pairs_own(pairs, RECORD_SOUND),
                 own_h_inverse = *pairs_own(pairs, RECORD_H_INVERSE);
    const double reacting = pairs->reacting, *restrict number = lane(lanes, LANE_NUMBER);
    double f[3][GRID_LANES] = {{0}}, e[GRID_LANES] = {0};
    const double own_P = *pairs_own(pairs, RECORD_PRESSURE),
                 *restrict all_V = pairs_others(pairs, RECORD_VOLUME),
                 *restrict all_P = pairs_others(pairs, RECORD_PRESSURE);
    double shocked[GRID_LANES] = {0}; /* the sentinel has no volume */
    struct signals signals = {{0}, {0}};
    for (int k = 0; k < pairs->count; k += GRID_LANES)
#pragma omp simd
        for (int l = 0; l < GRID_LANES; l++) {
            const ptrdiff_t n = k + l;
            shocked[l] += pair_shocked(own_P, all_P[n]) ? all_V[n] : 0;
            const struct pair_side j =
                vanilla ? (struct pair_side){.V = V[n], .P = P[n]}
                        : (struct pair_side){.m = m[n], .Z = Z[n], .b = b[n], .grad_h = grad_h[n]};
            const struct pair_terms p = vanilla ? pair_pressure_vanilla_ice(&own, &j, 1)
                                                : pair_pressure_lagrangian(&own, &j, 1, 1);
            double moved = 0, moved_j = 0;
            for (int axis = 0; axis < dim; axis++) {
                const double g = G[axis * stride + n], v_j = v[axis * stride + n];
                const struct pair_terms a =
                    vanilla ? (struct pair_terms){p.i + K[n], p.j + K[n]}
                            : (struct pair_terms){p.i * G_i[axis * stride + n] + K[n] * g,
                                                  p.j * G_j[axis * stride + n] + K[n] * g};
                const bool total = energy == ENERGY_TOTAL;
                const struct pair_terms heating = pair_heating(a, v_j - own_v[axis]);
                const double flux = total ? pair_energy_flux(a, own_v[axis], v_j) : heating.i;
                const double force = vanilla ? (a.i + a.j) * g : a.i + a.j;
                f[axis][l] += force;
                if (reacts) reaction[axis * stride + n] = -force;
                moved += vanilla ? flux * g : flux;
                if (!total) moved_j += vanilla ? heating.j * g : heating.j;
            }
            e[l] += moved;
            const double signal =
                add_signal(&signals, l, reacts && number[n] < reacting ? 2 : 1, r[n], own_h_inverse,
                           h_inverse[n], own_c, c[n], closing[n]);
            if (!reacts) continue;
            reaction[dim * stride + n] = energy == ENERGY_TOTAL ? -moved : moved_j;
            reaction[(dim + 1) * stride + n] = signal;
        }
    for (int axis = 0; axis < dim; axis++) totals->F[axis] += TREE(f[axis]);
    totals->de += TREE(e);
    totals->shocked = TREE(shocked);
    totals->signal = largest(totals->signal, largest_signal(&signals, own_c, inside));
}

#define ADD(name, formulation, dim)                                                                \
    CLONES static void name(const struct cells_method *method, const struct pairs *pairs,          \
                            struct totals *totals, int64_t *inside)                                \
    {                                                                                              \
        const bool reacts = pairs->reacting > 0;                                                   \
        if (method->energy == ENERGY_TOTAL && reacts)                                              \
            add_body(formulation, dim, true, method, ENERGY_TOTAL, pairs, totals, inside);         \
        else if (method->energy == ENERGY_TOTAL)                                                   \
            add_body(formulation, dim, false, method, ENERGY_TOTAL, pairs, totals, inside);        \
        else if (reacts)                                                                           \
            add_body(formulation, dim, true, method, ENERGY_INTERNAL, pairs, totals, inside);      \
        else                                                                                       \
            add_body(formulation, dim, false, method, ENERGY_INTERNAL, pairs, totals, inside);     \
    }
ADD(add_vanilla_ice_2, FORMULATION_VANILLA_ICE, 2)
ADD(add_vanilla_ice_3, FORMULATION_VANILLA_ICE, 3)
ADD(add_lagrangian_2, FORMULATION_LAGRANGIAN, 2)
ADD(add_lagrangian_3, FORMULATION_LAGRANGIAN, 3)

/* The largest pace among the particles of a list. */
static double find_pace(const struct cells *cells, const int32_t *slots, int count)
{
    double most = 0;
    for (int k = 0; k < count; k++) most = largest(most, cells->paces[slots[k]]);
    return most;
}

/* Adds the reactions to the neighbours. */
ALWAYS_INLINE void react_body(int dim, int values, const struct pairs *pairs, double *restrict of)
{
    const ptrdiff_t stride = pairs->lanes->stride;
    const double *restrict reaction = lane(pairs->lanes, LANE_REACTION);
    for (int k = 0; k < pairs->reacting; k++) {
        double *to = of + (ptrdiff_t)pairs->slots[k] * values;
        for (int a = 0; a < dim + 1; a++) to[a] += reaction[a * stride + k];
        to[dim + 1] = largest(to[dim + 1], reaction[(dim + 1) * stride + k]);
        for (int a = dim + 2; a < values; a++) to[a] += reaction[a * stride + k];
    }
}

CLONES static void react(const struct cells_method *method, const struct pairs *pairs, double *of)
{
    const int dim = method->box.dim, values = cells_reaction_values(method);
    if (dim == 2 && values == 4) /* constant numbers of values unroll the loops over them */
        react_body(2, 4, pairs, of);
    else if (dim == 2 && values == 10)
        react_body(2, 10, pairs, of);
    else if (dim == 2)
        react_body(2, values, pairs, of);
    else if (values == 5)
        react_body(3, 5, pairs, of);
    else if (values == 13)
        react_body(3, 13, pairs, of);
    else
        react_body(3, values, pairs, of);
}

/* Adds the forces of the neighbours in the lanes to a particle. Returns whether viscosity was
 * computed. */
static bool add_part(struct cells *cells, const struct pairs *pairs, int64_t *inside,
                     struct totals *totals)
{
    const struct cells_method *method = &cells->method;
    cells_pair_gradients(cells, pairs);
    if (method->closed) cells_close(cells, pairs);
    const bool viscous = cells_viscosity(cells, pairs);
    const bool plane = method->box.dim == 2;
    (method->formulation == FORMULATION_VANILLA_ICE
         ? (plane ? add_vanilla_ice_2 : add_vanilla_ice_3)
         : (plane ? add_lagrangian_2 : add_lagrangian_3))(method, pairs, totals, inside);
    if (method->shift) cells_exchange(cells, pairs, totals->gained);
    if (method->conductivity > 0 || (method->shock_conductivity > 0 && totals->shocked > 0)) {
        totals->de += cells_conduction(cells, pairs);
        totals->conducts = true;
    }
    if (method->div_v) totals->div_v += cells_divergence(cells, pairs);
    return viscous;
}

/* A particle on a coarser time-step level receives the forces of these pairs multiplied by the
 * pairs' time step. */
static void receive(const struct cells *cells, const struct cells_fields *fields, size_t i,
                    const struct totals *totals)
{
    for (int a = 0; a < cells->method.box.dim; a++)
        fields->impulse[a][i] += fields->span * totals->F[a];
    fields->heat[i] += fields->span * totals->de;
    fields->signal[i] = largest(fields->signal[i], totals->signal);
    fields->near_pace[i] = largest(fields->near_pace[i], totals->pace);
}

static void add_received(const struct cells_method *method, const double *received,
                         struct totals *totals)
{
    const int dim = method->box.dim, values = cells_reaction_values(method);
    for (int a = 0; a < dim; a++) totals->F[a] += received[a];
    totals->de += received[dim];
    totals->signal = largest(totals->signal, received[dim + 1]);
    for (int a = dim + 2; a < values; a++) totals->gained[a - dim - 2] += received[a];
}

/* Adds the exchange of shifting, and updates the potential for the next evaluation: the remaining
 * gradient of a constant is added to it. G is minus the gradient. */
static void add_gained(const struct cells_method *method, const struct cells_fields *fields,
                       size_t i, const double *gained)
{
    const int dim = method->box.dim;
    for (int a = 0; a < dim; a++) fields->dp_shift[a][i] += gained[a];
    fields->de_shift[i] += gained[dim];
    fields->dm[i] += gained[dim + 1];
    for (int a = 0; method->closed && a < dim; a++) fields->potential[a][i] -= gained[dim + 2 + a];
}

/* Adds the reactions that slots have received from the previous chunk. */
static void add_spilled(const struct cells *cells, const struct cells_fields *fields)
{
    const struct reactions *reactions = &cells->reactions;
    const int dim = cells->method.box.dim;
#pragma omp parallel for num_threads(cells->team) if (cells->team > 1)
    for (size_t c = 1; c < reactions->chunks; c++)
        for (size_t slot = reactions->begin[c]; slot < reactions->begin[c + 1]; slot++) {
            const double *spilled = reactions_spilled(reactions, c, slot);
            const size_t i = cells->order[slot];
            if (!spilled) continue;
            for (int a = 0; a < dim; a++) fields->F[a][i] += spilled[a];
            fields->de[i] += spilled[dim];
            fields->signal[i] = largest(fields->signal[i], spilled[dim + 1]);
            if (cells->method.shift) add_gained(&cells->method, fields, i, spilled + dim + 2);
        }
}

static void force_pass(struct cells *cells, const struct cells_fields *fields, size_t slot,
                       struct lanes *lanes)
{
    const struct lanes_layout *layout = &cells->force;
    const struct lanes_list list = lanes_partners(cells, slot, lanes);
    struct pairs pairs = {.lanes = lanes,
                          .layout = layout,
                          .record = cells->records + (ptrdiff_t)slot * layout->size};
    struct totals totals = {.signal = 2 * *pairs_own(&pairs, RECORD_SOUND)};
    bool viscous = list.count == 0;
    for (int from = 0; from < list.count; from += pairs.count) {
        pairs.count = lanes_gather_part(cells, layout, slot, &list, from, lanes);
        pairs.neighbours = list.count - from < pairs.count ? list.count - from : pairs.count;
        pairs.reacting = list.reacting - from < pairs.count ? list.reacting - from : pairs.count;
        pairs.slots = list.slots + from;
        viscous |= add_part(cells, &pairs, &lanes->pairs, &totals);
        react(&cells->method, &pairs, lanes->chunk.of);
    }
    const size_t i = cells->order[slot];
    const bool halves = lanes->chunk.of != NULL;
    if (halves)
        add_received(&cells->method, reactions_received(&cells->reactions, &lanes->chunk, slot),
                     &totals);
    if (fields->local && halves) /* over all neighbours, not only those of the half loop */
        totals.pace =
            find_pace(cells, grid_neighbours(cells->grid, &lanes->reader, cells->lists, slot),
                      cells->lists[slot].count);
    else if (fields->local)
        totals.pace = find_pace(cells, list.slots, list.count);
    if (lanes_part(cells, i) != CELLS_ACTIVE) {
        if (list.count > 0) receive(cells, fields, i, &totals);
        return;
    }
    if (fields->local) fields->near_pace[i] = totals.pace;
    if (!viscous) lanes->left_out.viscosity++;
    if (cells_conduct(&cells->method) && !totals.conducts) lanes->left_out.conductivity++;
    for (int a = 0; a < cells->method.box.dim; a++) fields->F[a][i] = totals.F[a];
    fields->de[i] = totals.de;
    if (cells->method.shift) {
        for (int a = 0; a < cells->method.box.dim; a++) fields->dp_shift[a][i] = 0;
        fields->de_shift[i] = fields->dm[i] = 0;
        for (int a = 0; cells->method.closed && a < cells->method.box.dim; a++)
            fields->potential[a][i] = pairs_own(&pairs, RECORD_POTENTIAL)[a];
        add_gained(&cells->method, fields, i, totals.gained);
    }
    if (cells->method.div_v) fields->div_v[i] = totals.div_v;
    fields->signal[i] = totals.signal;
}

uint64_t cells_forces(struct cells *cells, const struct cells_fields *fields)
{
    fill_records(cells, fields);
    for (int t = 0; t < cells->method.threads; t++) cells->lanes[t].pairs = 0;
    /* with local steps a particle may interact with only some of its neighbours */
    if (cells->halves && !(fields->local && cells->parts)) {
        reactions_all(cells, fields, force_pass);
        add_spilled(cells, fields);
    } else {
        lanes_all(cells, fields, force_pass);
    }
    int64_t directed = 0;
    for (int t = 0; t < cells->method.threads; t++) directed += cells->lanes[t].pairs;
    return (uint64_t)directed / 2;
}

/* --- local steps ------------------------------------------------------------------------------ */

static void coarse_pass(struct cells *cells, const struct cells_fields *fields, size_t slot,
                        struct lanes *lanes)
{
    if (cells->parts[cells->order[slot]] != CELLS_ACTIVE) return;
    const int32_t *slots = grid_neighbours(cells->grid, &lanes->reader, cells->lists, slot);
    for (int32_t k = 0; k < cells->lists[slot].count; k++) {
        int mirrored;
        const size_t j = lanes_source(cells, fields->n, (size_t)slots[k], &mirrored);
        if (!(fields->level[j] < fields->coarsest)) continue;
#pragma omp atomic write
        fields->woken[j] = fields->wake_to; /* all threads write the same value */
    }
}

void cells_find_coarse(struct cells *cells, const struct cells_fields *fields)
{
    if (cells->parts) lanes_all(cells, fields, coarse_pass);
}

void cells_correct(struct cells *cells, const struct cells_fields *fields, int levels,
                   const double *spans)
{
    struct cells_fields of_level = *fields;
    cells->pair_level = 0;
    fill_records(cells, fields);
    for (size_t s = 0; s < cells->points; s++) {
        int mirrored;
        const size_t i = lanes_source(cells, fields->n, s, &mirrored);
        const unsigned before = (unsigned)fields->level[i],
                       after = fields->woken[i] ? fields->woken[i] : before;
        cells->kinds[s] = (unsigned char)(before | after << 4);
    }
    for (int level = 0; level < levels; level++) {
        cells->pair_level = level;
        of_level.span = spans[level];
        if (spans[level] != 0) lanes_all(cells, &of_level, force_pass);
    }
    cells->pair_level = -1;
}

/* --- the time step alone ---------------------------------------------------------------------- */

CLONES static double find_signal(const struct pairs *pairs)
{
    const struct lanes *lanes = pairs->lanes;
    const double *restrict r = lane(lanes, LANE_R), *restrict closing = lane(lanes, LANE_CLOSING),
                           *restrict c = pairs_others(pairs, RECORD_SOUND),
                           *restrict h_inverse = pairs_others(pairs, RECORD_H_INVERSE);
    const double own_c = *pairs_own(pairs, RECORD_SOUND),
                 own_h_inverse = *pairs_own(pairs, RECORD_H_INVERSE);
    struct signals signals = {{0}, {0}};
    int64_t inside = 0;
    for (int k = 0; k < pairs->count; k += GRID_LANES)
#pragma omp simd
        for (int l = 0; l < GRID_LANES; l++)
            add_signal(&signals, l, 1, r[k + l], own_h_inverse, h_inverse[k + l], own_c, c[k + l],
                       closing[k + l]);
    return largest_signal(&signals, own_c, &inside);
}

static void signal_pass(struct cells *cells, const struct cells_fields *fields, size_t slot,
                        struct lanes *lanes)
{
    const struct lanes_layout *layout = &cells->force;
    const struct pairs pairs = {.count = lanes_gather(cells, layout, slot, lanes),
                                .lanes = lanes,
                                .layout = layout,
                                .record = cells->records + (ptrdiff_t)slot * layout->size};
    fields->signal[cells->order[slot]] = find_signal(&pairs);
}

void cells_signal(struct cells *cells, const struct cells_fields *fields)
{
    fill_records(cells, fields);
    lanes_all(cells, fields, signal_pass);
}
