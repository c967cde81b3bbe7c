/* SPDX-License-Identifier: GPL-3.0-or-later
 * Density in 2D and 3D: sum_j Z_j w(r_ij/h_i) and its derivative in h, sum_j Z_j (d w + q w'),
 * without the factors C/h^d and -C/h^(d+1); j = i is included. */
#include <math.h>

#include "lanes.h"

static void fill_records(struct cells *cells, const struct cells_fields *fields)
{
    const struct lanes_layout *layout = &cells->density;
    const int weight = layout->offset[RECORD_WEIGHT], energy = layout->offset[RECORD_ENERGY];
    size_t count;
    const struct grid_run *runs = grid_runs(cells->grid, &count);
#pragma omp parallel for num_threads(cells->team) if (cells->team > 1)
    for (size_t r = 0; r < count; r++)
        for (size_t s = runs[r].begin; s < runs[r].end; s++) {
            double *record = lanes_record(cells, layout, s);
            int mirrored;
            const size_t i = lanes_source(cells, fields->n, s, &mirrored);
            record[weight] = cells->method.number ? 1 : fields->m[i];
            if (energy) record[energy] = fields->U[i];
        }
    lanes_sentinel(cells, layout);
}

/* The sums over the gathered lanes at a given smoothing length. */
static void sum_at(const struct cells *cells, const struct lanes *lanes, int count, double m,
                   double U, double h_inverse, double sums[4])
{
    const struct kernel *kernel = cells->method.kernel;
    const struct lanes_layout *layout = &cells->density;
    const double dim = cells->method.box.dim, own = cells->own_w, *r = lane(lanes, LANE_R);
    cells->shapes.sums(kernel, (size_t)count, r, h_inverse, lane_of(lanes, layout, RECORD_WEIGHT),
                       sums);
    sums[0] += m * own;
    sums[1] += m * (dim * own);
    sums[2] = sums[3] = 0;
    if (!cells->method.energy_element) return;
    cells->shapes.sums(kernel, (size_t)count, r, h_inverse, lane_of(lanes, layout, RECORD_ENERGY),
                       sums + 2);
    sums[2] += U * own;
    sums[3] += U * (dim * own);
}

static void put_sums(const struct cells *cells, const struct cells_fields *fields, size_t i,
                     const double sums[4])
{
    fields->sum_m[i] = sums[0];
    fields->sum_m_dh[i] = sums[1];
    if (!cells->method.energy_element) return;
    fields->sum_Z[i] = sums[2];
    fields->sum_Z_dh[i] = sums[3];
}

static void density_pass(struct cells *cells, const struct cells_fields *fields, size_t slot,
                         struct lanes *lanes)
{
    const size_t i = cells->order[slot];
    double sums[4];
    if (lanes_part(cells, i) != CELLS_ACTIVE) return;
    const int count = lanes_gather(cells, &cells->density, slot, lanes);
    sum_at(cells, lanes, count, cells->method.number ? 1 : fields->m[i],
           cells->method.energy_element ? fields->U[i] : 0, fields->h_inverse[i], sums);
    put_sums(cells, fields, i, sums);
}

void cells_density(struct cells *cells, const struct cells_fields *fields)
{
    fill_records(cells, fields);
    lanes_all(cells, fields, density_pass);
}

/* --- smoothing lengths ------------------------------------------------------------------------ */

/* Solves for the smoothing length of one particle. With the number element the sum of ones replaces
 * the sum of m/m_i. */
static enum cells_outcome solve(const struct cells *cells, const struct lanes *lanes, int count,
                                size_t i, double m, double U, double sums[4])
{
    const struct lanes_newton *newton = &cells->newton;
    const double radius = newton->radius[i];
    double *h = &newton->h[i], *h_inverse = &newton->h_inverse[i];
    struct width_bracket bracket;
    struct density_sums one;
    width_begin(&bracket, 1, INFINITY);
    for (int step = 0; step < WIDTH_STEPS_MAX; step++) {
        const bool at_radius = !(*h < radius);
        if (at_radius) *h = radius;
        *h_inverse = 1 / *h;
        sum_at(cells, lanes, count, m, U, *h_inverse, sums);
        one.m[0] = sums[0];
        one.m_dh[0] = sums[1];
        if (!width_step(newton->rule, 1, &m, &one, &bracket, h, h_inverse)) return CELLS_SOLVED;
        if (at_radius && *h > radius) return CELLS_WIDER;
    }
    return width_without_root(newton->rule, 1, &m, &one, h, h_inverse) < 0 ? CELLS_SOLVED
                                                                           : CELLS_NO_ROOT;
}

static void width_pass(struct cells *cells, const struct cells_fields *fields, size_t slot,
                       struct lanes *lanes)
{
    const size_t i = cells->order[slot];
    unsigned char *outcome = &cells->newton.outcome[i];
    double sums[4];
    if (*outcome != CELLS_OPEN) return;
    const int count = lanes_gather(cells, &cells->density, slot, lanes);
    *outcome = (unsigned char)solve(cells, lanes, count, i, cells->method.number ? 1 : fields->m[i],
                                    cells->method.energy_element ? fields->U[i] : 0, sums);
    put_sums(cells, fields, i, sums);
}

void cells_widths(struct cells *cells, const struct cells_fields *fields,
                  const struct width_rule *rule, const double *radius, double *h, double *h_inverse,
                  unsigned char *outcome)
{
    cells->newton = (struct lanes_newton){
        .rule = rule, .radius = radius, .h = h, .h_inverse = h_inverse, .outcome = outcome};
    fill_records(cells, fields);
    lanes_all(cells, fields, width_pass);
}
