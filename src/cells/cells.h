/* SPDX-License-Identifier: GPL-3.0-or-later
 * The particle sums in 2D and 3D (density, moment matrix, velocity gradient, pair forces) over the
 * neighbour lists of a grid. Each particle gathers its own sums in the order of its list, in eight
 * lanes that are added in a fixed order; the forces of most pairs are computed once for both
 * particles (reactions.h). Results depend neither on the number of threads nor on the instruction
 * set, and the forces of a pair are opposite to the last bit. Each sum runs in short stages over
 * arrays that fit into the first-level cache: gather the neighbours, geometry, kernel, physics. */
#ifndef SPHPROOF_CELLS_H
#define SPHPROOF_CELLS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "description.h"
#include "gradient.h"
#include "grid.h"
#include "kernel.h"
#include "pair.h"
#include "scheme.h"
#include "width.h"

/* Entries of a symmetric matrix xx, xy, (xz,) yy, (yz, zz): 3 in 2D, 6 in 3D. */
enum { CELLS_SYMMETRIC = 6, CELLS_SQUARE = 9 };

/* Settings of the sums; constant over a run. */
struct cells_method {
    struct grid_box box;
    bool wall[3];                /* reflecting walls at both ends of an axis that is not periodic */
    const struct kernel *kernel; /* must outlive the cells */
    bool specialised;            /* use specialised loops if the kernel is built in */
    enum gradient gradient;
    enum formulation formulation;
    enum pair_width pair_width;
    enum energy energy;
    bool energy_element; /* Z = U, else Z = m */
    bool number;         /* Z = 1 */
    enum viscosity viscosity;
    bool signal_form;       /* of viscosity; otherwise the mu form */
    bool balsara;           /* viscosity is multiplied by the pair's mean Balsara factor */
    bool velocity_gradient; /* compute grad v */
    bool div_v;             /* compute div v with the pair gradient */
    bool shift;             /* particle shifting, with fluxes */
    bool closed;            /* pair gradients give 0 for a constant field */
    double conductivity, shock_conductivity; /* 0: none */
    double worst_condition;      /* largest condition number of a usable moment matrix; pairs with a
                                    worse one take the standard gradient */
    bool local;                  /* local steps may be taken */
    double alpha_min, alpha_max; /* if each particle has its own alpha */
    struct pair_numbers numbers;
    double still; /* in units of the sound speed: viscosity and velocity gradient are skipped if the
                     velocities of all neighbours agree within this; 0: never */
    int threads;  /* maximum number */
};

/* True if the scheme has artificial conductivity. */
static inline bool cells_conduct(const struct cells_method *method)
{
    return method->conductivity > 0 || method->shock_conductivity > 0;
}

/* The settings for a scheme with this plan; box, walls, threads and still are left 0. */
struct plan;
struct cells_method cells_method_of(const struct scheme *scheme, const struct plan *plan);

/* Role of a particle in an evaluation of only some particles. Values are those of grid_flag. */
enum cells_part {
    CELLS_ACTIVE = GRID_LISTED,   /* its sums and forces are computed */
    CELLS_IDLE = GRID_UNLISTED,   /* is only a neighbour of active particles */
    CELLS_RECEIVES = GRID_BESIDE, /* also receives impulses from its pairs with active particles */
    CELLS_SUMMED = GRID_UNLISTED + 2 /* counted in sums, but exerts no forces */
};

/* Arrays of the particles, n each, in the caller's order; NULL if the method does not need them. */
struct cells_fields {
    size_t n;
    const double *x[3], *v[3], *m, *U, *alpha, *balsara;
    const double *h_inverse;
    const double *P, *c, *rho, *V; /* of the equation of state, V = Z/y */
    const double *b, *grad_h;      /* lagrangian */
    /* results, without the factor C/h^d */
    double *sum_m, *sum_m_dh;        /* sum m w and sum m (d w + q w'), number: m = 1 */
    double *sum_Z, *sum_Z_dh;        /* energy element */
    double *matrix[CELLS_SYMMETRIC]; /* C h^-d times C of eq. ia: gradient = matrix x w(q) */
    double *condition;               /* of the moment matrix */
    double *steep;                   /* blended: weight of the standard gradient */
    double *slope[CELLS_SQUARE];     /* (grad v): d v_a/d x_b at a dim + b */
    double *alpha_local, *decay;     /* of the viscosity switch */
    bool local;                      /* the evaluation belongs to local time steps; then: */
    const double *level;
    const double *pace; /* cfl over the particle's own time step */
    /* values of inactive particles are extrapolated: ratio times the last change is added */
    const double *ratio, *balsara_before;
    double *matrix_before[CELLS_SYMMETRIC], *slope_before[CELLS_SQUARE];
    double *near_pace;               /* largest pace of the neighbours */
    double coarsest;                 /* coarsest level allowed for neighbours of active particles */
    unsigned char *woken, wake_to;   /* 0, or the new level of a particle that wakes */
    double *impulse[3], *heat, span; /* CELLS_RECEIVES: span times the rates is added */
    double *F[3], *de, *div_v, *signal; /* signal: largest signal speed of the particle's pairs */
    /* shifting: velocity relative to the flow, and rates of exchange, which are not included in the
     * rates above */
    double *shift[3], *potential[3], *dm, *dp_shift[3], *de_shift;
};

/* Numbers of particles whose velocity gradient or viscosity was skipped (cells_method.still), or
 * whose conductivity was skipped because the pressures of all neighbours nearly agree. */
struct cells_left_out {
    uint64_t slope, viscosity, conductivity;
};

struct cells;

/* Allocates for n particles. NULL: no memory. */
struct cells *cells_create(const struct cells_method *method, size_t n);
void cells_destroy(struct cells *cells);

/* Memory needed for n particles with this mean number of neighbours, in bytes. */
double cells_bytes(const struct cells_method *method, double n, double neighbours);

/* Sets the number of threads, at most method.threads. */
void cells_team(struct cells *cells, int size);

/* Finds the neighbours of every particle within max(radius_i, radius_j). parts: an enum cells_part
 * for each particle, or NULL if all are active; must stay valid until the next call. Errors as in
 * grid_search. */
enum status cells_arrange(struct cells *cells, const struct cells_fields *fields,
                          const double *radius, const unsigned char *parts, struct error *error);

/* Sets woken for neighbours of active particles whose level is coarser than `coarsest`. */
void cells_find_coarse(struct cells *cells, const struct cells_fields *fields);

/* Adds the impulse and heat of pairs that move from one of the first `levels` levels to a finer one
 * because a particle wakes: spans[level] times the rates; the span is positive where the level has
 * given too little, negative where too much. */
void cells_correct(struct cells *cells, const struct cells_fields *fields, int levels,
                   const double *spans);

/* Computes sum_m and its companions at the smoothing lengths 1/h_inverse. */
void cells_density(struct cells *cells, const struct cells_fields *fields);

/* State of the search for a particle's smoothing length. */
enum cells_outcome {
    CELLS_SOLVED,
    CELLS_OPEN,   /* not solved yet */
    CELLS_WIDER,  /* the root exceeds the search radius */
    CELLS_NO_ROOT /* no h satisfies the equation */
};

/* Solves h = eta (m/rho(h))^(1/d) by Newton's method, starting at h, for the particles whose
 * outcome is CELLS_OPEN. radius: as passed to cells_arrange; an upper bound of h. Sets h,
 * h_inverse, the sums at the new h, and outcome. */
void cells_widths(struct cells *cells, const struct cells_fields *fields,
                  const struct width_rule *rule, const double *radius, double *h, double *h_inverse,
                  unsigned char *outcome);

/* Computes matrix, condition, slope and shift, as the method needs them; the slopes of a particle
 * with an unusable matrix are 0. Returns the number of particles without a usable matrix for their
 * gradient. */
size_t cells_matrix(struct cells *cells, const struct cells_fields *fields);

/* Computes F, de, div_v, signal and the exchange of shifting. Returns the number of pairs within
 * max(h_i, h_j). */
uint64_t cells_forces(struct cells *cells, const struct cells_fields *fields);

/* Computes alpha_local, the value that alpha jumps up to and decays to, and decay, the decay rate,
 * from slope and the forces of this evaluation. Inactive particles get alpha_min and 0. */
void cells_switch(struct cells *cells, const struct cells_fields *fields);

/* Recomputes only signal, from velocities that have changed since cells_forces. */
void cells_signal(struct cells *cells, const struct cells_fields *fields);

/* Arguments of cells_wake and cells_fall_asleep. `asleep` holds CELLS_AWAKE or another of these
 * values for each particle. */
enum { CELLS_AWAKE, CELLS_ASLEEP, CELLS_JUST_ASLEEP };
struct cells_quiet {
    const double *disturbance; /* distance of each particle from equilibrium over the tolerance; 0
                                  if asleep */
    double *arriving;          /* work array of n: the disturbance that arrives */
    double tolerance, sound; /* neighbours with a relative speed above tolerance * max(c, sound) are
                                not at rest */
    double calm;             /* limit for falling asleep, in units of the tolerance */
};

/* Wakes sleeping particles at which a disturbance above the tolerance arrives or whose neighbours
 * move relative to them. */
void cells_wake(struct cells *cells, const struct cells_fields *fields,
                const struct cells_quiet *quiet, unsigned char *asleep);

/* Marks as CELLS_JUST_ASLEEP the awake particles that are calm and have calm neighbours. */
void cells_fall_asleep(struct cells *cells, const struct cells_fields *fields,
                       const struct cells_quiet *quiet, unsigned char *asleep);

/* Squared distance between the points at two slots. */
double cells_distance2(const struct cells *cells, size_t a, size_t b);

/* Calls visit for each particle, in the order of the slots. */
void cells_describe(const struct cells *cells, const struct cells_fields *fields,
                    description_visit *visit, void *context);

/* Counts since the last call, then resets them. */
struct cells_left_out cells_left_out(struct cells *cells);

/* Number of slots of the grid: particles and their wall images. */
size_t cells_points(const struct cells *cells);

const struct grid *cells_grid(const struct cells *cells);

#endif
