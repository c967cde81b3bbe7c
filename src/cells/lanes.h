/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to cells: one thread's arrays over the neighbours of one particle, and the records that
 * they are gathered from. */
#ifndef SPHPROOF_LANES_H
#define SPHPROOF_LANES_H

#include "cells.h"
#include "gather.h"
#include "reactions.h"
#include "shapes.h"
#include "team.h"
#include "width.h"

/* Fields of a particle's record; the method decides which of them exist. Records should be short:
 * they are read from the second-level cache again for every neighbour. */
enum lanes_field {
    RECORD_POSITION,  /* x y (z) */
    RECORD_WEIGHT,    /* density: m, or 1; matrix: V; forces: m; switch: m sign(div v) */
    RECORD_ENERGY,    /* density with the energy element: U */
    RECORD_VELOCITY,  /* vx vy (vz) */
    RECORD_H_INVERSE, /* 1/h */
    RECORD_H,         /* matrix pass only */
    RECORD_VOLUME,    /* V */
    RECORD_PRESSURE,
    RECORD_SOUND,      /* c */
    RECORD_DENSITY,    /* rho */
    RECORD_ALPHA,      /* of viscosity */
    RECORD_BALSARA,    /* Balsara factor */
    RECORD_HEAT,       /* u */
    RECORD_LAGRANGIAN, /* b grad_h Z */
    RECORD_MATRIX,     /* symmetric; all 0: unusable, the pair takes the standard gradient */
    RECORD_STEEP,      /* blended: weight of the standard gradient */
    RECORD_SLOPE,
    RECORD_PROJECTOR,    /* symmetric */
    RECORD_ACCELERATION, /* ax ay (az) */
    RECORD_SHIFT,        /* velocity relative to the flow */
    RECORD_POTENTIAL,    /* its differences change the pair gradients with shifting=closed */
    RECORD_FIELDS
};

/* Geometry computed for every pair when its records are gathered; each includes the previous one.
 */
enum lanes_geometry {
    LANES_DISTANCE,     /* r */
    LANES_DISPLACEMENT, /* and r_j - r_i */
    LANES_DIRECTION,    /* and 1/r */
    LANES_CLOSING       /* and the closing speed */
};

struct lanes_layout {
    enum lanes_geometry geometry;
    int used, size;            /* doubles of a record; rounded up to whole groups */
    int offset[RECORD_FIELDS]; /* 0: absent, except for the position, which comes first */
    gather_loop *gather;
};

/* Arrays of the lanes that loops compute. The reactions overwrite slopes, q and the gradients at
 * h_i and h_j, which are no longer needed then, or with vanilla_ice do not exist. */
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
    LANE_GX, /* minus the pair gradient: the direction of forces */
    LANE_GY,
    LANE_GZ,
    LANE_K,
    LANE_SLOPE_I,
    LANE_SLOPE_J,
    LANE_SPARE,
    LANE_Q,
    LANE_Q_J,
    LANE_GX_I, /* the same at h_i, and below at h_j */
    LANE_GY_I,
    LANE_GZ_I,
    LANE_GX_J,
    LANE_GY_J,
    LANE_GZ_J,
    LANE_REACTION_END, /* the longest reaction, closed in 3D, needs two more */
    LANES_OWN = LANE_REACTION_END + 2,
    LANE_REACTION = LANE_SLOPE_I /* reactions, see struct reactions */
};

/* Moments of several particles, one in each lane, and what their inverses are applied to. */
struct moments_batch {
    int count;
    size_t particle[GRID_LANES];
    bool sound[GRID_LANES]; /* the inverse is usable; otherwise it is 0 */
    double moments[CELLS_SYMMETRIC][GRID_LANES], inverse[CELLS_SYMMETRIC][GRID_LANES],
        condition[GRID_LANES];
    /* sums of weight x (f - own), then gradients of f: the velocity, 1/h_inverse, and 1 with own =
     * 0 */
    double velocity[CELLS_SQUARE][GRID_LANES], width[3][GRID_LANES], one[3][GRID_LANES];
};

struct lanes {
    /* LANES_OWN arrays and one for each value of the longest record, stride each */
    _Alignas(TEAM_APART) double *block;
    ptrdiff_t stride;
    int64_t pairs;
    struct cells_left_out left_out;
    struct grid_reader reader;
    int32_t *slots;     /* a filtered list, used instead of the grid's */
    ptrdiff_t capacity; /* capacity, for two such lists */
    struct reactions_chunk chunk;
    struct moments_batch by_w, by_gradient; /* moments with w(q), and with the gradient's weight */
};

/* Arguments of cells_widths, for its threads. */
struct lanes_newton {
    const struct width_rule *rule;
    const double *radius;
    double *h, *h_inverse;
    unsigned char *outcome;
};

struct cells {
    struct cells_method method;
    int team; /* number of threads */
    struct grid *grid;
    struct shapes shapes;
    double own_w;               /* w(0) */
    bool all_sound;             /* every particle has a usable matrix */
    const unsigned char *parts; /* enum cells_part of each particle; NULL: all are active */
    /* for the force pass with local steps: */
    unsigned char *kinds; /* by slot: the role; in cells_correct, levels before and after */
    double *paces;        /* by slot */
    int pair_level;       /* level of the pairs that cells_correct works on; -1: none */
    bool halves;          /* each pair force is computed once (reactions.h) */
    size_t points;        /* particles and wall images: the number of slots */
    /* results of the grid's last search: */
    const struct grid_list *lists;
    const double (*position)[3];
    const uint32_t *order;
    double side[3]; /* periods; HUGE_VAL: open */
    struct cells_images {
        size_t capacity, count;
        uint32_t *source;        /* particle of each image */
        unsigned char *mirrored; /* bit a: mirrored along axis a */
        double *x[3], *radius;   /* of particles and images */
    } images;
    size_t capacity;                                   /* in records */
    double *records;                                   /* by slot; the last is the sentinel's */
    struct lanes_layout density, matrix, force, shift; /* shift: viscosity switch */
    struct lanes *lanes;                               /* one for each thread */
    struct lanes_newton newton;
    const struct cells_quiet *quiet; /* arguments of cells_wake and cells_fall_asleep */
    unsigned char *asleep;
    struct reactions reactions;
};

/* Number of values of a reaction. */
static inline int cells_reaction_values(const struct cells_method *method)
{
    const int dim = method->box.dim;
    return (dim + 2) * (method->shift ? 2 : 1) + (method->closed ? dim : 0);
}

/* An array of the thread, or (lane_of) the gathered values of a field. */
static inline double *lane(const struct lanes *lanes, int which)
{
    return lanes->block + which * lanes->stride;
}

static inline double *lane_of(const struct lanes *lanes, const struct lanes_layout *layout,
                              enum lanes_field field)
{
    return lane(lanes, LANES_OWN + layout->offset[field]);
}

/* The particle at a slot; mirrored: bit mask of the axes along which the slot is its wall image. */
static inline size_t lanes_source(const struct cells *cells, size_t n, size_t slot, int *mirrored)
{
    const size_t point = cells->order[slot];
    *mirrored = point < n ? 0 : cells->images.mirrored[point - n];
    return point < n ? point : cells->images.source[point - n];
}

/* -1 along a mirrored axis, otherwise 1; an entry of a matrix changes sign by the product for both
 * axes. */
static inline double lanes_sign(int mirrored, int axis)
{
    return mirrored >> axis & 1 ? -1 : 1;
}

/* The record of a slot, with the position filled in. */
static inline double *lanes_record(const struct cells *cells, const struct lanes_layout *layout,
                                   size_t slot)
{
    double *record = cells->records + (ptrdiff_t)slot * layout->size;
    for (int a = 0; a < cells->method.box.dim; a++) record[a] = cells->position[slot][a];
    return record;
}

/* The record of the sentinel, with the position filled in and all else 0. */
static inline double *lanes_sentinel(const struct cells *cells, const struct lanes_layout *layout)
{
    double *record = lanes_record(cells, layout, cells->points);
    for (int f = cells->method.box.dim; f < layout->size; f++) record[f] = 0;
    return record;
}

/* True if the first count values along each axis agree with the particle's own value within the
 * limit. The values of the neighbours along each axis are `stride` doubles apart. Where they
 * disagree, the first vector usually shows it, so the loop ends early. */
bool lanes_agree(int axes, int count, ptrdiff_t stride, const double *own, const double *others,
                 double limit);

/* Gathers the records of a slot's list and computes the geometry of its pairs. Returns the number
 * of lanes, a multiple of GRID_LANES. */
int lanes_gather(const struct cells *cells, const struct lanes_layout *layout, size_t slot,
                 struct lanes *lanes);

/* A list of slots, then sentinels up to whole vectors. */
struct lanes_list {
    const int32_t *slots;
    int count;
    int reacting; /* the first slots, which receive a reaction; half loops only */
};

/* The entries of a slot's list that it interacts with. */
struct lanes_list lanes_partners(const struct cells *cells, size_t slot, struct lanes *lanes);

/* Gathers a part of a slot's list, starting at lane `from`, such that all its lanes fit into the
 * first-level cache; the parts depend only on the list and the layout. Returns the number of lanes.
 */
int lanes_gather_part(const struct cells *cells, const struct lanes_layout *layout, size_t slot,
                      const struct lanes_list *list, int from, struct lanes *lanes);

static inline enum cells_part lanes_part(const struct cells *cells, size_t i)
{
    if (cells->pair_level >= 0) return CELLS_RECEIVES;
    return cells->parts ? (enum cells_part)cells->parts[i] : CELLS_ACTIVE;
}

/* Size of the longest record of all layouts, in doubles. */
int lanes_longest_record(const struct cells *cells);

/* Ensures capacity for the grid's longest list. false: no memory. */
bool lanes_reserve(struct cells *cells);

/* Calls a pass for every slot with a list, with the parts of the grid shared among threads. */
typedef void lanes_pass(struct cells *cells, const struct cells_fields *fields, size_t slot,
                        struct lanes *lanes);
void lanes_all(struct cells *cells, const struct cells_fields *fields, lanes_pass *pass);

/* Sums of count values in a fixed order; count is a multiple of GRID_LANES. */
double lanes_sum(const double *values, int count);
double lanes_dot(const double *a, const double *b, int count);

/* Index of the entry (a, b) of a symmetric matrix. */
static inline int symmetric_at(int dim, int a, int b)
{
    const int low = a < b ? a : b, high = a < b ? b : a;
    return low * dim - low * (low - 1) / 2 + high - low;
}

#endif
