/* SPDX-License-Identifier: GPL-3.0-or-later
 * omega of a layer's modes as eigenvalues of the linearised equations in rho_1, u, V = -i v and p,
 * which are real:
 *   omega rho_1 = k U rho_1 + k rho u + (rho V)',    omega u = k U u + U' V + k p/rho,
 *   omega V = k U V - (p' + g rho_1)/rho,            omega p = k U p + gamma P (k u + V') + P' V,
 * at Chebyshev points (Trefethen 2000, Spectral Methods in MATLAB, chapters 6 and 9). It shares the
 * base state with the shooting, and nothing else. */
#include "layer_collocation.h"

#include <gsl/gsl_eigen.h>
#include <math.h>
#include <stdlib.h>

/* Points in y, and the matrix D of the derivative there (points x points). */
struct grid {
    int points;
    double *y, *D;
};

static void make_grid(struct grid *grid, const struct layer *layer)
{
    const int n = grid->points - 1;
    const double end = layer->periodic ? 0.25 : layer->wall, b = asinh(2.5 * end / layer->width);
    for (int i = 0; i <= n; i++) {
        const double zeta = cos(M_PI * i / n), dy = end * b * cosh(b * zeta) / sinh(b);
        double *row = grid->D + i * grid->points, sum = 0;
        grid->y[i] = end * sinh(b * zeta) / sinh(b);
        for (int j = 0; j <= n; j++) {
            if (j == i) continue;
            const double ends = (i % n ? 1 : 2) / (j % n ? 1. : 2.);
            row[j] = ends * ((i + j) % 2 ? -1 : 1) / (zeta - cos(M_PI * j / n)) / dy;
            sum += row[j];
        }
        row[i] = -sum;
    }
}

enum unknown { DENSITY, ALONG, ACROSS, PRESSURE, UNKNOWNS };

/* The row of each unknown at each point, or -1 if a boundary condition sets it: V or p vanishes at
 * the ends. */
static int number(const struct layer *layer, int points, int *rows)
{
    const enum unknown zero = layer->periodic && layer->pressure_node ? PRESSURE : ACROSS;
    int count = 0;
    for (int f = 0; f < UNKNOWNS; f++)
        for (int i = 0; i < points; i++)
            rows[f * points + i] = f == (int)zero && i % (points - 1) == 0 ? -1 : count++;
    return count;
}

struct equations {
    const int *rows;
    int points;
    gsl_matrix *matrix;
};

static void add(const struct equations *of, enum unknown row, int i, enum unknown column, int j,
                double value)
{
    const int r = of->rows[(int)row * of->points + i], c = of->rows[(int)column * of->points + j];
    if (r < 0 || c < 0) return;
    *gsl_matrix_ptr(of->matrix, (size_t)r, (size_t)c) += value;
}

static void fill(const struct equations *of, const struct layer *layer, const struct grid *grid)
{
    const double k = layer->k, g = layer->g;
    for (int i = 0; i < of->points; i++) {
        const struct layer_base b = layer_base(layer, grid->y[i]);
        for (int f = 0; f < UNKNOWNS; f++) add(of, (enum unknown)f, i, (enum unknown)f, i, k * b.U);
        add(of, DENSITY, i, ALONG, i, k * b.rho);
        add(of, DENSITY, i, ACROSS, i, b.rho_dy);
        add(of, ALONG, i, ACROSS, i, b.U_dy);
        add(of, ALONG, i, PRESSURE, i, k / b.rho);
        add(of, ACROSS, i, DENSITY, i, -g / b.rho);
        add(of, PRESSURE, i, ALONG, i, layer->gamma * b.P * k);
        add(of, PRESSURE, i, ACROSS, i, -b.rho * g);
        for (int j = 0; j < of->points; j++) {
            const double D = grid->D[i * of->points + j];
            add(of, DENSITY, i, ACROSS, j, b.rho * D);
            add(of, ACROSS, i, PRESSURE, j, -D / b.rho);
            add(of, PRESSURE, i, ACROSS, j, layer->gamma * b.P * D);
        }
    }
}

/* The eigenvalue with the greatest imaginary part; 0 where none has one, NaN without memory. */
static double complex fastest(gsl_matrix *matrix)
{
    const size_t n = matrix->size1;
    gsl_vector_complex *values = gsl_vector_complex_alloc(n);
    gsl_eigen_nonsymm_workspace *space = gsl_eigen_nonsymm_alloc(n);
    double complex best = values && space ? 0 : (double)NAN;
    double growth = 0;
    if (values && space) {
        gsl_eigen_nonsymm_params(0, 1, space);
        if (gsl_eigen_nonsymm(matrix, values, space)) growth = (double)INFINITY;
    }
    for (size_t i = 0; values && space && i < n; i++) {
        const gsl_complex value = gsl_vector_complex_get(values, i);
        if (!(GSL_IMAG(value) > growth)) continue;
        growth = GSL_IMAG(value);
        best = GSL_REAL(value) + LAYER_I * GSL_IMAG(value);
    }
    if (values) gsl_vector_complex_free(values);
    if (space) gsl_eigen_nonsymm_free(space);
    return best;
}

double complex layer_mode_collocation(const struct layer *layer, int points)
{
    const size_t n = (size_t)points;
    double *room = malloc((n + n * n) * sizeof *room);
    int *rows = malloc(UNKNOWNS * n * sizeof *rows);
    double complex omega = (double)NAN;
    if (room && rows) {
        struct grid grid = {points, room, room + n};
        const int count = number(layer, points, rows);
        const struct equations of = {rows, points, gsl_matrix_calloc((size_t)count, (size_t)count)};
        if (of.matrix) {
            make_grid(&grid, layer);
            fill(&of, layer, &grid);
            omega = fastest(of.matrix);
            gsl_matrix_free(of.matrix);
        }
    }
    free(room);
    free(rows);
    return omega;
}
