/* SPDX-License-Identifier: GPL-3.0-or-later
 * Inside of cells: one thread's arrays over the neighbours of one particle, and the records that
 * they are gathered from. */
#ifndef SPHPROOF_LANES_H
#define SPHPROOF_LANES_H

#include "cells.h"
#include "gather.h"
#include "reactions.h"
#include "shapes.h"
#include "team.h"
#include "width.h"

/* What a record may hold of a particle; which of it there is, is the method's. Records are what
 * costs: they come from the second-level cache, again for every neighbour. */
enum lanes_field {
    RECORD_PLACE,     /* x y (z) */
    RECORD_WEIGHT,    /* density: m, or 1; matrix: V; forces: m; switch: m sign(div v) */
    RECORD_ENERGY,    /* density with the energy element: U */
    RECORD_VELOCITY,  /* vx vy (vz) */
    RECORD_H_INVERSE, /* 1/h */
    RECORD_H,         /* of the matrix pass alone */
    RECORD_VOLUME,    /* V */
    RECORD_PRESSURE,
    RECORD_SOUND,      /* c */
    RECORD_DENSITY,    /* rho */
    RECORD_ALPHA,      /* of the viscosity */
    RECORD_BALSARA,    /* factor of the viscosity */
    RECORD_HEAT,       /* u */
    RECORD_LAGRANGIAN, /* b grad_h Z */
    RECORD_MATRIX,     /* symmetric; all 0: not to be used, the pair has the standard gradient */
    RECORD_STEEP,      /* share of the standard gradient: blended */
    RECORD_SLOPE,
    RECORD_PROJECTOR,    /* symmetric */
    RECORD_ACCELERATION, /* ax ay (az) */
    RECORD_SHIFT,        /* velocity relative to the flow */
    RECORD_POTENTIAL,    /* its differences close pair gradients */
    RECORD_FIELDS
};

/* What is found of every pair when its records are gathered. */
enum lanes_geometry {
    LANES_DISTANCE,     /* r */
    LANES_DISPLACEMENT, /* and r_j - r_i */
    LANES_DIRECTION,    /* and 1/r */
    LANES_CLOSING       /* and how fast the pair closes */
};

struct lanes_layout {
    enum lanes_geometry geometry;
    int used, size;            /* doubles of a record; in whole groups */
    int offset[RECORD_FIELDS]; /* 0: absent, but for the place, which comes first */
    gather_loop *gather;
};

/* Arrays of the lanes that loops make. */
enum lanes_array {
    LANE_ONE,    /* 1 everywhere */
    LANE_NUMBER, /* 0, 1, 2 ... */
    LANE_DX,     /* r_j - r_i */
    LANE_DY,
    LANE_DZ,
    LANE_R,
    LANE_R_INVERSE, /* 0 where points coincide */
    LANE_CLOSING,   /* -v_ij . e_ij */
    LANE_W,
    LANE_W_J,
    LANE_GX, /* minus the pair gradient: forces are along it */
    LANE_GY,
    LANE_GZ,
    LANE_K,
    LANE_SLOPE_I,
    LANE_SLOPE_J,
    LANE_SPARE,
    LANE_Q,
    LANE_Q_J,
    LANE_GX_I, /* at h_i and at h_j alone */
    LANE_GY_I,
    LANE_GZ_I,
    LANE_GX_J,
    LANE_GY_J,
    LANE_GZ_J,
    LANE_REACTION_END, /* the longest reaction, closed in 3D, has two values more than lanes so far
                        */
    LANES_OWN = LANE_REACTION_END + 2,
    LANE_REACTION = LANE_SLOPE_I /* what neighbours get: force, energy, signal speed; once slopes, q
                                    and what is spare are not needed any more. Behind them what
                                    shifting gives: momentum, energy, mass, what gradients make of
                                    a constant; vanilla_ice has only one gradient */
};

struct lanes {
    /* LANES_OWN arrays and those of the longest record, stride each */
    _Alignas(TEAM_APART) double *block;
    ptrdiff_t stride;
    int64_t pairs;
    struct cells_left_out left_out;
    struct grid_reader reader;
    int32_t *slots; /* a list without inactive particles, used instead of the grid's */
    ptrdiff_t room; /* entries, of two such lists */
    struct reactions_chunk chunk;
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
    double own_w;               /* w(0) */
    const unsigned char *parts; /* enum cells_part of each particle; NULL: all are active */
    /* local steps, of the force pass: */
    unsigned char
        *kinds;     /* by slot: the part; while pairs are corrected, levels before and after */
    double *paces;  /* by slot */
    int pair_level; /* of the pairs that are corrected; -1: none are */
    bool halves;    /* forces by half loops */
    size_t points;  /* particles and their mirror images: slots run over both */
    /* of the grid's last search */
    const struct grid_list *lists;
    const double (*place)[3];
    const uint32_t *order;
    double side[3]; /* periods; HUGE_VAL: open */
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
    const struct cells_quiet *quiet; /* arguments of cells_wake and cells_lull, for their passes */
    unsigned char *asleep;
    struct reactions reactions;
};

/* Values of a reaction. */
static inline int cells_reaction_values(const struct cells_method *method)
{
    const int dim = method->box.dim;
    return (dim + 2) * (method->shift ? 2 : 1) + (method->closed ? dim : 0);
}

/* An array of the thread's own, or a value of the gathered records. */
static inline double *lane(const struct lanes *lanes, int which)
{
    return lanes->block + which * lanes->stride;
}

static inline double *lane_of(const struct lanes *lanes, const struct lanes_layout *layout,
                              enum lanes_field field)
{
    return lane(lanes, LANES_OWN + layout->offset[field]);
}

/* The particle at a slot; mirrored: the axes along which it is an image, as bits. */
static inline size_t lanes_source(const struct cells *cells, size_t n, size_t slot, int *mirrored)
{
    const size_t point = cells->order[slot];
    *mirrored = point < n ? 0 : cells->images.mirrored[point - n];
    return point < n ? point : cells->images.source[point - n];
}

/* -1 along an axis that is mirrored, else 1; of an entry of a matrix the product of both axes'. */
static inline double lanes_sign(int mirrored, int axis)
{
    return mirrored >> axis & 1 ? -1 : 1;
}

/* The record of a slot; its place is filled in. */
static inline double *lanes_record(const struct cells *cells, const struct lanes_layout *layout,
                                   size_t slot)
{
    double *record = cells->records + (ptrdiff_t)slot * layout->size;
    for (int a = 0; a < cells->method.box.dim; a++) record[a] = cells->place[slot][a];
    return record;
}

/* The record of the sentinel: its place, and all else 0. */
static inline double *lanes_sentinel(const struct cells *cells, const struct lanes_layout *layout)
{
    double *record = lanes_record(cells, layout, cells->points);
    for (int f = cells->method.box.dim; f < layout->size; f++) record[f] = 0;
    return record;
}

/* Are the first count of each axis' values within the limit of the particle's own? Axes of theirs
 * are a stride apart. Where they are not, the first vector mostly tells. */
bool lanes_agree(int axes, int count, ptrdiff_t stride, const double *own, const double *theirs,
                 double limit);

/* Gathers the records of a slot's list and finds the geometry of its pairs. Returns the number of
 * lanes, a multiple of GRID_LANES. */
int lanes_gather(const struct cells *cells, const struct lanes_layout *layout, size_t slot,
                 struct lanes *lanes);

/* A list of slots, and sentinels up to whole vectors. */
struct lanes_list {
    const int32_t *slots;
    int count;
    int reacting; /* the first ones, which get a reaction; with half loops alone */
};

/* Those of a slot's list that it has forces with. */
struct lanes_list lanes_partners(const struct cells *cells, size_t slot, struct lanes *lanes);

/* Gathers a part of a slot's list, from its lane `from` on, that stays in the first-level cache
 * with all its lanes; parts depend on the list and the layout alone. Returns its lanes. */
int lanes_gather_part(const struct cells *cells, const struct lanes_layout *layout, size_t slot,
                      const struct lanes_list *list, int from, struct lanes *lanes);

static inline enum cells_part lanes_part(const struct cells *cells, size_t i)
{
    if (cells->pair_level >= 0) return CELLS_RECEIVES;
    return cells->parts ? (enum cells_part)cells->parts[i] : CELLS_ACTIVE;
}

/* Doubles of the longest record of all layouts. */
int lanes_longest_record(const struct cells *cells);

/* Room for lists of the grid's longest one. */
bool lanes_reserve(struct cells *cells);

/* Runs a pass over all parts of the grid, shared out among threads. */
typedef void lanes_pass(struct cells *cells, const struct cells_fields *fields, size_t slot,
                        struct lanes *lanes);
void lanes_all(struct cells *cells, const struct cells_fields *fields, lanes_pass *pass);

/* Sums of count values, count a multiple of GRID_LANES, in a fixed order. */
double lanes_sum(const double *values, int count);
double lanes_dot(const double *a, const double *b, int count);

/* Position of the entry (a, b) of a symmetric matrix. */
static inline int symmetric_at(int dim, int a, int b)
{
    const int low = a < b ? a : b, high = a < b ? b : a;
    return low * dim - low * (low - 1) / 2 + high - low;
}

#endif
