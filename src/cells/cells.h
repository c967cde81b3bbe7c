/* SPDX-License-Identifier: GPL-3.0-or-later
 * The particle sums in 2D and 3D: density, moment matrix and velocity gradient, pair forces, over
 * the neighbour lists of a grid. Every particle gathers its own sums in the order of its list, in
 * eight lanes that are added in a fixed order; most pairs have their forces worked out once
 * (reactions.h). Results depend neither on threads nor on instruction sets, and what two particles
 * do to each other is opposite to the last bit. Each sum runs in short stages over arrays that stay
 * in the first-level cache: neighbours gathered, geometry, kernel, physics. */
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

/* What the sums are asked for; constant over a run. */
struct cells_method {
    struct grid_box box;
    bool wall[3]; /* mirrors particles at both ends of a direction that is not periodic */
    const struct kernel *kernel; /* must outlive the cells */
    bool specialised;            /* kernel loops of its own, where it is a built-in one */
    enum gradient gradient;
    enum formulation formulation;
    enum pair_width pair_width;
    enum energy energy;
    bool energy_element; /* Z = U, else Z = m */
    bool number;         /* Z = 1 */
    enum viscosity viscosity;
    bool signal_form;       /* of viscosity: else the mu form */
    bool balsara;           /* viscosity times the mean factor of the pair */
    bool velocity_gradient; /* something needs it */
    bool div_v;             /* and the divergence by the pair gradient */
    bool shift;             /* particle shifting, with fluxes */
    bool closed;            /* and pair gradients that make nothing of a constant */
    double conductivity, shock_conductivity; /* 0: none */
    double
        worst_condition; /* of a moment matrix; beyond it the pair's gradient is the standard one */
    bool local;          /* local steps may be taken */
    double alpha_min, alpha_max; /* where each particle has its own alpha */
    struct pair_numbers numbers;
    double still; /* in sound speeds: viscosity and velocity gradients of neighbours that move
                     together to this are left out; 0: none are */
    int threads;  /* at most */
};

/* Does heat flow between neighbours? */
static inline bool cells_conduct(const struct cells_method *method)
{
    return method->conductivity > 0 || method->shock_conductivity > 0;
}

/* What a scheme with this plan asks for; what it does not know (box, walls, threads, still) is 0.
 */
struct plan;
struct cells_method cells_method_of(const struct scheme *scheme, const struct plan *plan);

/* What a particle has to do with an evaluation that is of some particles alone. Its value is the
 * grid's. */
enum cells_part {
    CELLS_ACTIVE = GRID_LISTED,      /* has sums and forces */
    CELLS_IDLE = GRID_UNLISTED,      /* is seen by active particles */
    CELLS_RECEIVES = GRID_BESIDE,    /* and receives the impulses of its pairs with active ones */
    CELLS_SUMMED = GRID_UNLISTED + 2 /* is seen by their sums, but has no forces with them */
};

/* Arrays of the particles, n each, in the caller's order; NULL where the method needs none. */
struct cells_fields {
    size_t n;
    const double *x[3], *v[3], *m, *U, *alpha, *balsara;
    const double *h_inverse;
    const double *P, *c, *rho, *V; /* of the equation of state, V = Z/y */
    const double *b, *grad_h;      /* lagrangian */
    /* found: without the factor C/h^d */
    double *sum_m, *sum_m_dh;        /* sum m w and sum m (d w + q w'), number: m = 1 */
    double *sum_Z, *sum_Z_dh;        /* energy element */
    double *matrix[CELLS_SYMMETRIC]; /* C h^-d times C of eq. ia: gradient = matrix x w(q) */
    double *condition;               /* of the moment matrix */
    double *steep;                   /* blended: the standard gradient's share */
    double *slope[CELLS_SQUARE];     /* (grad v): d v_a/d x_b at a dim + b */
    double *alpha_local, *decay;     /* of the switch */
    bool local;                      /* the evaluation is one of local steps: */
    const double *level;
    const double *pace; /* cfl over the step that a particle asks for */
    /* what inactive particles show is extrapolated: by ratio times the last change */
    const double *ratio, *balsara_before;
    double *matrix_before[CELLS_SYMMETRIC], *slope_before[CELLS_SQUARE];
    double *near_pace;                  /* the largest of its pairs */
    double coarsest;                    /* level that active particles have beside them */
    unsigned char *woken, wake_to;      /* 0, or the level that a particle wakes to */
    double *impulse[3], *heat, span;    /* receivers gain span times their rates */
    double *F[3], *de, *div_v, *signal; /* signal: largest speed of the particle's pairs */
    /* shifting: velocity relative to the flow, and rates of what it exchanges, in none of the above
     */
    double *shift[3], *potential[3], *dm, *dp_shift[3], *de_shift;
};

/* Particles whose velocity gradient or viscosity was left out by method.still, and those whose
 * conductivity was, as all pressures around are nearly the same. */
struct cells_left_out {
    uint64_t slope, viscosity, conductivity;
};

struct cells;

/* Memory for n particles. NULL: none left. */
struct cells *cells_create(const struct cells_method *method, size_t n);
void cells_destroy(struct cells *cells);

/* What that comes to with lists of so many neighbours each, in bytes. */
double cells_bytes(const struct cells_method *method, double n, double neighbours);

/* Sets how many threads work from now on; at most the method's number. */
void cells_team(struct cells *cells, int size);

/* Finds the neighbours of every particle within max(radius_i, radius_j). parts: an enum cells_part
 * for each particle, or NULL if all are active; it must stay valid until the next call. Errors as
 * grid_search. */
enum status cells_arrange(struct cells *cells, const struct cells_fields *fields,
                          const double *radius, const unsigned char *parts, struct error *error);

/* Marks in woken the neighbours of active particles that are on a level below the coarsest. */
void cells_find_coarse(struct cells *cells, const struct cells_fields *fields);

/* Impulse and heat of the pairs that leave a level for a finer one, as particles wake: over
 * spans[level], levels of them, for what the level has given too little (> 0) or too much of. */
void cells_correct(struct cells *cells, const struct cells_fields *fields, int levels,
                   const double *spans);

/* sum_m ... at the widths 1/h_inverse. */
void cells_density(struct cells *cells, const struct cells_fields *fields);

/* What becomes of a particle whose width is looked for. */
enum cells_outcome {
    CELLS_SOLVED,
    CELLS_OPEN,   /* to be looked for */
    CELLS_WIDER,  /* its root lies beyond the radius of the search */
    CELLS_NO_ROOT /* no width fulfils the rule */
};

/* h = eta (m/rho(h))^(1/d) by Newton's method, from h on, for the particles whose outcome is
 * CELLS_OPEN; radius: of cells_arrange, which no width exceeds. Sets h, h_inverse, the sums at them
 * and the outcome. */
void cells_widths(struct cells *cells, const struct cells_fields *fields,
                  const struct width_rule *rule, const double *radius, double *h, double *h_inverse,
                  unsigned char *outcome);

/* matrix, condition, slope, shift, as the method needs them; slopes of a particle whose matrix
 * is not to be used are 0. Returns how many particles have no matrix for their gradient. */
size_t cells_matrix(struct cells *cells, const struct cells_fields *fields);

/* F, de, div_v, signal, and what shifting exchanges. Returns the number of pairs within max(h_i,
 * h_j). */
uint64_t cells_forces(struct cells *cells, const struct cells_fields *fields);

/* Computes alpha_local, the value that alpha jumps up to and decays to, and decay, its rate, from
 * slope and the forces of this evaluation. Inactive particles get alpha_min and 0. */
void cells_switch(struct cells *cells, const struct cells_fields *fields);

/* signal alone, from velocities that have changed since the forces. */
void cells_signal(struct cells *cells, const struct cells_fields *fields);

/* How far every particle is from rest; who sleeps, CELLS_AWAKE or not. */
enum { CELLS_AWAKE, CELLS_ASLEEP, CELLS_JUST_ASLEEP };
struct cells_quiet {
    const double *disturbance; /* of each particle, in tolerances; of sleepers 0 */
    double *arriving;          /* scratch of n: what arrives at each particle, in tolerances */
    double tolerance, sound;   /* neighbours that move against each other at more than tolerance
                                  times c, or times this where it is more, are not at rest */
    double calm;               /* times the tolerance: for particles that are to fall asleep */
};

/* Wakes the sleepers at which more than the tolerance arrives, or whose neighbours move against
 * them. */
void cells_wake(struct cells *cells, const struct cells_fields *fields,
                const struct cells_quiet *quiet, unsigned char *asleep);

/* Marks as CELLS_JUST_ASLEEP the awake particles that are calm and have calm neighbours. */
void cells_lull(struct cells *cells, const struct cells_fields *fields,
                const struct cells_quiet *quiet, unsigned char *asleep);

/* Square of the distance of the points at two slots. */
double cells_distance2(const struct cells *cells, size_t a, size_t b);

/* Visits the particles, slot by slot. */
void cells_describe(const struct cells *cells, const struct cells_fields *fields,
                    description_visit *visit, void *context);

/* Of all sums since the last call. */
struct cells_left_out cells_left_out(struct cells *cells);

/* Slots of the grid: particles, and their images in walls. */
size_t cells_points(const struct cells *cells);

const struct grid *cells_grid(const struct cells *cells);

#endif
