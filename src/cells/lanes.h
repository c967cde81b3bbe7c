/* SPDX-License-Identifier: GPL-3.0-or-later
 * Inside of cells: one thread's arrays over the neighbours of one particle, and the records that
 * they are gathered from. */
#ifndef SPHPROOF_LANES_H
#define SPHPROOF_LANES_H

#include "cells.h"
#include "gather.h"
#include "shapes.h"
#include "width.h"

/* Values of a record by groups of four; which groups there are is the method's. */
enum lanes_group {
    GROUP_PLACE,      /* x y z m */
    GROUP_MOTION,     /* vx vy vz h */
    GROUP_GAS,        /* 1/h V P c */
    GROUP_VISCOSITY,  /* rho alpha balsara u */
    GROUP_LAGRANGIAN, /* b grad_h Z -; density with the energy element: U */
    GROUP_MATRIX,     /* symmetric, and how far it is used: 1, or 0 for the standard gradient */
    GROUP_MATRIX_2,
    GROUP_SLOPE,
    GROUP_SLOPE_2,
    GROUP_SLOPE_3,
    GROUP_PROJECTOR,
    GROUP_PROJECTOR_2,
    GROUP_ACCELERATION, /* ax ay az - */
    GROUPS
};

struct lanes_layout {
    int size;           /* doubles of a record */
    int offset[GROUPS]; /* of a group; -1: absent */
    gather_loop *gather;
};

/* Arrays of the lanes that loops make. */
enum lanes_array {
    LANE_DX, /* r_j - r_i */
    LANE_DY,
    LANE_DZ,
    LANE_R,
    LANE_R_INVERSE,
    LANE_Q,
    LANE_Q_J,
    LANE_W,
    LANE_W_J,
    LANE_GX, /* minus the pair gradient: forces are along it */
    LANE_GY,
    LANE_GZ,
    LANE_GX_I, /* at h_i and at h_j alone */
    LANE_GY_I,
    LANE_GZ_I,
    LANE_GX_J,
    LANE_GY_J,
    LANE_GZ_J,
    LANE_CLOSING,
    LANE_A_I,
    LANE_A_J,
    LANE_K,
    LANE_SLOPE_I,
    LANE_SLOPE_J,
    LANE_SPARE,
    LANES_OWN
};

struct lanes {
    double *block; /* LANES_OWN + records of GROUPS groups, stride each */
    ptrdiff_t stride;
    int64_t pairs;
};

/* A search for widths: what each thread reads of it. */
struct lanes_newton {
    const struct width_rule *rule;
    const double *radius;
    double *h, *h_inverse;
    unsigned char *outcome;
};

struct cells {
    struct cells_method method;
    int team; /* threads at work */
    struct grid *grid;
    struct shapes shapes;
    size_t points; /* particles and their mirror images: slots run over both */
    struct cells_images {
        size_t capacity, count;
        uint32_t *source;        /* the particle that an image is of */
        unsigned char *mirrored; /* bit a: along axis a */
        double *x[3], *radius;   /* of particles and images */
    } images;
    size_t capacity;                                   /* of records, in particles */
    double *records;                                   /* slot n is the sentinel's */
    struct lanes_layout density, matrix, force, shift; /* shift: of the switch */
    struct lanes *lanes;                               /* of each thread */
    struct lanes_newton newton;
};

/* An array of the thread's own, or a value of the gathered records. */
static inline double *lane(const struct lanes *lanes, int which)
{
    return lanes->block + which * lanes->stride;
}

static inline double *lane_of(const struct lanes *lanes, const struct lanes_layout *layout,
                              enum lanes_group group, int value)
{
    return lanes->block + (LANES_OWN + layout->offset[group] + value) * lanes->stride;
}

/* The particle at a slot; mirrored: the axes along which it is an image, as bits. */
static inline size_t lanes_source(const struct cells *cells, size_t n, size_t slot, int *mirrored)
{
    const size_t point = grid_order(cells->grid)[slot];
    *mirrored = point < n ? 0 : cells->images.mirrored[point - n];
    return point < n ? point : cells->images.source[point - n];
}

/* -1 along an axis that is mirrored, else 1; of an entry of a matrix the product of both axes'. */
static inline double lanes_sign(int mirrored, int axis)
{
    return mirrored >> axis & 1 ? -1 : 1;
}

/* Gathers the records of a slot's list and finds r_j - r_i, r and 1/r (for the density r alone).
 * Returns the number of lanes,
 * a multiple of GRID_LANES. */
int lanes_gather(const struct cells *cells, const struct lanes_layout *layout, size_t slot,
                 const struct lanes *lanes);

/* The same for a part of the list, from its lane `from` on, that stays in the first-level cache
 * with all its lanes; parts depend on the list and the layout alone. Returns its lanes. */
int lanes_gather_part(const struct cells *cells, const struct lanes_layout *layout, size_t slot,
                      int from, const struct lanes *lanes);

/* Room for lists of the grid's longest one. */
bool lanes_reserve(struct cells *cells);

/* Runs a pass over all parts of the grid, shared out among threads. */
typedef void lanes_pass(struct cells *cells, const struct cells_fields *fields, size_t slot,
                        struct lanes *lanes);
void lanes_all(struct cells *cells, const struct cells_fields *fields, lanes_pass *pass);

/* Eight lanes, then in pairs: the same order for every instruction set. */
#define TREE(s) (((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7])))

/* Sums of count values, count a multiple of GRID_LANES, in a fixed order. */
double lanes_sum(const double *values, int count);
double lanes_dot(const double *a, const double *b, int count);

/* q = r/h. */
void lanes_scale(int count, const double *r, double h_inverse, double *q);

/* Position of the entry (a, b) of a symmetric matrix. */
static inline int symmetric_at(int dim, int a, int b)
{
    const int low = a < b ? a : b, high = a < b ? b : a;
    return low * dim - low * (low - 1) / 2 + high - low;
}

#endif
