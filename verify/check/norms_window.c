/* SPDX-License-Identifier: GPL-3.0-or-later
 * The part of each particle's volume in the window, in 1D, 2D and 3D and for all kinds of windows:
 * L1 must be continuous in all positions, even for columns of a lattice on the edge. */
#include <gsl/gsl_qrng.h>
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "norm.h"
#include "problem.h"

typedef double part_function(const struct prepared *p, const struct snapshot *s, size_t i);

struct part_subject {
    part_function *part;
};

static double part_of_window(const struct prepared *p, const struct snapshot *s, size_t i)
{
    return problem_window_part(p, s, i);
}

/* A lattice of `across` cells along each direction of the box [-1, 1]^dim and its window. */
struct setup_of_cells {
    const char *name;
    int dim, across;
    double half;   /* half width of the window along x; it spans the other directions */
    double radius; /* > 0: the window is a disc or ball instead */
    double
        roughness; /* |volume of all parts/volume of the window - 1| at most: cubes at a sphere */
};

/* Columns of unmoved cells lie on the window's edge (x = +-0.5, R = 0.625). */
static const struct setup_of_cells setups[] = {
    {"interval", 1, 80, 0.5 - 0.0125, 0, 1e-13},
    {"slab in 2D", 2, 40, 0.5 - 0.025, 0, 1e-13},
    {"slab in 3D", 3, 16, 0.5 - 0.0625, 0, 1e-13},
    {"disc", 2, 40, 1, 0.625, 4e-3},
    {"ball", 3, 16, 1, 0.625, 2.5e-2},
};
enum { CELLS_MOST = 4096 };

struct cells {
    struct prepared p;
    struct snapshot s;
    double x[3][CELLS_MOST], volume[CELLS_MOST], weight[CELLS_MOST], value[CELLS_MOST],
        exact[CELLS_MOST];
};

/* Makes the cells, moved by shift and wrapped; the error is 1 + x^2 with either sign. */
static void make_cells(struct cells *c, const struct setup_of_cells *setup, double shift)
{
    const double side = 2. / setup->across;
    size_t n = 1;
    c->p = (struct prepared){.domain.dim = setup->dim, .window.dim = setup->dim};
    c->p.window.radius = setup->radius;
    for (int d = 0; d < setup->dim; d++) {
        const double half = d == 0 ? setup->half : 1;
        c->p.domain.lo[d] = -1, c->p.domain.hi[d] = 1;
        c->p.window.lo[d] = -half, c->p.window.hi[d] = half;
        n *= (size_t)setup->across;
    }
    c->s = (struct snapshot){.n = n, .x = {c->x[0], c->x[1], c->x[2]}, .volume = c->volume};
    for (size_t i = 0; i < n; i++) {
        size_t rest = i;
        for (int d = 0; d < setup->dim; d++, rest /= (size_t)setup->across) {
            const double x = -1 + side * ((double)(rest % (size_t)setup->across) + 0.5) + shift;
            c->x[d][i] = x >= 1 ? x - 2 : x;
        }
        c->volume[i] = pow(side, setup->dim);
        c->exact[i] = 2.385;
        c->value[i] = 2.385 + (i % 2 ? 1 : -1) * (1 + c->x[0][i] * c->x[0][i]);
    }
}

static double l1_of(struct cells *c, part_function *part)
{
    for (size_t i = 0; i < c->s.n; i++) c->weight[i] = part(&c->p, &c->s, i);
    return norm_l1(c->s.n, c->weight, c->value, c->exact);
}

static double volume_of_window(const struct setup_of_cells *setup)
{
    if (setup->radius > 0)
        return setup->dim == 2 ? M_PI * pow(setup->radius, 2)
                               : 4 * M_PI / 3 * pow(setup->radius, 3);
    return 2 * setup->half * pow(2, setup->dim - 1);
}

/* The change of L1 for displacements of +-1e-7, over 1e-7. */
static double steepness(struct cells *c, part_function *part)
{
    enum { DRAWS = 4 };
    const double step = 1e-7, before = l1_of(c, part);
    double most = 0;
    gsl_qrng *sobol = gsl_qrng_alloc(gsl_qrng_sobol, 3);
    for (int draw = 0; draw < DRAWS; draw++) {
        struct cells *moved = malloc(sizeof *moved);
        if (!moved) break;
        *moved = *c;
        for (int d = 0; d < 3; d++) moved->s.x[d] = moved->x[d];
        moved->s.volume = moved->volume;
        for (size_t i = 0; i < c->s.n; i++) {
            double u[3];
            gsl_qrng_get(sobol, u);
            /* all particles of a draw in one direction, by slightly different amounts */
            for (int d = 0; d < c->p.domain.dim; d++)
                moved->x[d][i] += step * ((draw % 2 ? 0.5 : -0.5) + (u[d] - 0.5));
        }
        most = fmax(most, fabs(l1_of(moved, part) - before) / step);
        free(moved);
    }
    gsl_qrng_free(sobol);
    return most;
}

static void measure_setup(struct check_run *run, const struct setup_of_cells *setup,
                          struct cells *c, part_function *part)
{
    double filled = 0;
    /* unmoved, the edge halves a column; moved, it cuts elsewhere */
    for (int moved = 0; moved < 2; moved++) {
        double sum = 0;
        make_cells(c, setup, moved ? 0.37 * 2 / setup->across : 0);
        l1_of(c, part);
        for (size_t i = 0; i < c->s.n; i++) sum += c->weight[i];
        filled = fmax(filled, fabs(sum / volume_of_window(setup) - 1));
    }
    check_measure(run, filled, setup->roughness, setup->roughness / 10,
                  "%s: cells side by side fill the window", setup->name);
    make_cells(c, setup, 0);
    check_measure(run, steepness(c, part), 1, 0.1, "%s: change of L1 over displacements of 1e-7",
                  setup->name);
}

static double one_dimension(struct cells *c, part_function *part, size_t n, const double *x,
                            const double *volume, const double *value, double lo, double hi)
{
    c->s = (struct snapshot){.n = n, .x = {x}, .volume = volume};
    c->p.window.lo[0] = lo, c->p.window.hi[0] = hi;
    for (size_t i = 0; i < n; i++) c->weight[i] = part(&c->p, &c->s, i);
    return norm_l1(n, c->weight, value, (double[]){0, 0, 0});
}

static double off(double value, double expected)
{
    return fabs(value / expected - 1);
}

static void measure_by_hand(struct check_run *run, struct cells *c, part_function *part)
{
    const double nan = (double)NAN, volume[] = {1, 0.5, 1}, value[] = {2, 0.5, 70};
    c->p = (struct prepared){.domain = {1, {0}, {10}}, .window.dim = 1};
    /* cells: a quarter inside [0, 1], wholly inside, outside */
    const double got = one_dimension(c, part, 3, (double[]){0.5, 1.25, 8}, volume, value, 0.75, 2);
    check_measure(run, off(got, (0.25 * 2 + 0.5 * 0.5) / 0.75), 1e-14, 4e-16,
                  "a quarter of one cell, the whole of another");
    const double ends[] = {0.1, 9.9};
    check_measure(
        run, off(one_dimension(c, part, 2, ends, volume, value, 0, 10), (1 * 2 + 0.5 * 0.5) / 1.5),
        1e-14, 4e-16, "a window that is the whole box cuts nothing");
    check_measure(
        run,
        off(one_dimension(c, part, 2, ends, volume, value, 0, 5), (0.6 * 2 + 0.15 * 0.5) / 0.75),
        1e-14, 4e-16, "a cell goes on at the other end of a periodic box");
    c->p.boundary[0] = BOUNDARY_OPEN;
    check_measure(
        run,
        off(one_dimension(c, part, 2, ends, volume, value, 0, 10), (0.6 * 2 + 0.35 * 0.5) / 0.95),
        1e-14, 4e-16, "what has left an open box does not count");
    c->p.boundary[0] = BOUNDARY_PERIODIC;
    check_measure(run,
                  !isnan(one_dimension(c, part, 2, (double[]){nan, 1}, volume, value, 0.75, 2)) +
                      !isnan(one_dimension(c, part, 2, ends, (double[]){nan, 1}, value, 0.75, 2)) +
                      !isnan(one_dimension(c, part, 2, ends, volume, (double[]){nan, 1}, 0, 5)) +
                      !isnan(one_dimension(c, part, 2, ends, volume, value, 4, 5)),
                  0, 0, "a NaN, or nothing in the window, is NaN");
}

static void measure_parts(struct check_run *run, const void *subject)
{
    static const struct part_subject right = {part_of_window};
    part_function *part = (subject ? (const struct part_subject *)subject : &right)->part;
    struct cells *c = calloc(1, sizeof *c);
    if (!c) {
        check_measure(run, (double)NAN, 0, 0, "no memory");
        return;
    }
    for (size_t k = 0; k < sizeof setups / sizeof *setups; k++)
        measure_setup(run, &setups[k], c, part);
    measure_by_hand(run, c, part);
    free(c);
}

/* ---- wrong part functions ---- */

static double not_cut(const struct prepared *p, const struct snapshot *s, size_t i)
{
    double x[3];
    problem_position(p, s, i, x);
    return window_contains(&p->window, x) ? s->volume[i] : 0;
}

/* Cuts a cube with a wrong side. */
static double with_side(const struct prepared *p, const struct snapshot *s, size_t i, double side)
{
    const double cube = pow(side, p->domain.dim);
    struct snapshot other = *s;
    double *volume = calloc(i + 1, sizeof *volume);
    if (!volume) return (double)NAN;
    volume[i] = cube;
    other.volume = volume;
    const double part = problem_window_part(p, &other, i) / cube * s->volume[i];
    free(volume);
    return part;
}

static double half_width(const struct prepared *p, const struct snapshot *s, size_t i)
{
    return with_side(p, s, i, 2 * pow(s->volume[i], 1. / p->domain.dim));
}

static double volume_for_side(const struct prepared *p, const struct snapshot *s, size_t i)
{
    return with_side(p, s, i, s->volume[i]);
}

static double no_images(const struct prepared *p, const struct snapshot *s, size_t i)
{
    struct prepared other = *p;
    for (int d = 0; d < 3; d++)
        if (p->boundary[d] == BOUNDARY_PERIODIC) other.boundary[d] = BOUNDARY_REFLECTING;
    return problem_window_part(&other, s, i);
}

static double sharp_ball(const struct prepared *p, const struct snapshot *s, size_t i)
{
    struct prepared other = *p;
    double x[3];
    problem_position(p, s, i, x);
    other.window.radius = 0;
    return p->window.radius > 0 && problem_radius(p, x) > p->window.radius
               ? 0
               : problem_window_part(&other, s, i);
}

static const struct check_mutant part_mutants[] = {
    {"window_cuts_nothing", "whole volumes of whatever lies inside",
     &(struct part_subject){not_cut}},
    {"window_no_images", "cells do not go on at the other end of the box",
     &(struct part_subject){no_images}},
    {"window_half_width", "sides taken for half widths", &(struct part_subject){half_width}},
    {"window_volume_is_side", "volumes taken for sides", &(struct part_subject){volume_for_side}},
    {"window_sharp_ball", "only plane edges cut", &(struct part_subject){sharp_ball}},
    {0},
};

CHECK_DEFINE(norms, window_parts, 650,
             .property = "L1 with volumes cut at the window's edge is continuous in all positions",
             .measure = measure_parts, .mutants = part_mutants);
