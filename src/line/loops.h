/* SPDX-License-Identifier: GPL-3.0-or-later
 * The particle sums in 1D, over sorted particles: a loop over neighbour offsets d = 1..D, with an
 * inner loop over the particles of a range, which vectorises. Kernels are exactly 0 beyond their
 * support, so D only has to be sufficient, and the result depends neither on D nor on the range.
 * Every sum exists specialised for each kernel (run-time dispatch over instruction sets) and
 * generic, with the kernel behind a pointer: the oracle, also used for a user's plug-in. */
#pragma once

#include <stdbool.h>

#include "gradient.h"
#include "pair.h"
#include "particles.h"
#include "plan.h"
#include "width.h"

enum { FORCE_STRIPS = 6 }; /* strips in the work array of a pair force */

/* --- kernel sums of one range, at h = 1/h_inverse[i] ---------------------------------------- */

/* A list like those of families.h, for the enum and the table of specialised loops. */
#define DENSITY_LIST(TERMS, ...)                                                                   \
    TERMS(DENSITY_MASS, __VA_ARGS__)   /* sum m w, sum m (w + q w') */                             \
    TERMS(DENSITY_ENERGY, __VA_ARGS__) /* and the same with Z = U */
enum density_terms { DENSITY_LIST(FAMILY_SYMBOL, ) };
enum { DENSITY_TERMS = 0 DENSITY_LIST(FAMILY_COUNTED, ) };

/* h_inverse: len values, of the particles of the range. */
typedef void density_loop(const struct kernel *kernel, const struct particles *particles,
                          ptrdiff_t first, int len, ptrdiff_t D, const double *h_inverse,
                          struct density_sums *sums);

/* --- g = 1/sum V x^2 weight for gradients with a weight, and, with slopes,
 * dv = sum V (v_j - v_i) x w/sum V x^2 w ------------------------------------------------------- */

typedef void matrix_loop(const struct kernel *kernel, const struct particles *particles,
                         ptrdiff_t first, int len, ptrdiff_t D);

/* --- gradients of the pairs (i, i+d), i = first .. first+pairs-1 ------------------------------ */

/* Output of a gradient loop: one gradient of the pair, in G, at a pair width of enum pair_width;
 * or, with PAIR_WIDTH_OWN, the gradients at h_i in G and at h_j in G_j (lagrangian). */
enum { PAIR_WIDTH_OWN = PAIR_WIDTHS, PAIR_GRADIENTS };

typedef void gradient_loop(const struct kernel *kernel, const struct particles *particles,
                           ptrdiff_t first, int pairs, ptrdiff_t d, double *G, double *G_j);

/* --- dp/dt, de/dt, signal speed, div v ------------------------------------------------------- */

struct loops;

/* Returns the largest signal speed / h of both particles of the pairs of the range, and of its
 * particles alone. scratch: work array of loop_force_scratch(D) doubles. */
typedef double force_loop(const struct loops *loops, const struct particles *particles,
                          ptrdiff_t first, int len, ptrdiff_t D, double *scratch);
size_t loop_force_scratch(ptrdiff_t D);

/* --- choosing ------------------------------------------------------------------------------- */

struct loops {
    density_loop *density;
    matrix_loop *matrix; /* NULL if not needed */
    gradient_loop *gradient;
    force_loop *force;
    /* for ranges without approaching pairs: without velocity gradients, without viscosity */
    matrix_loop *matrix_receding;
    force_loop *force_receding;
    /* other inputs of the pair forces */
    const struct kernel *kernel;
    enum formulation formulation;
    enum viscosity viscosity;
    enum energy energy;
    bool energy_element; /* Z = U, else Z = m */
    bool div_v;          /* compute div v, for time-dependent viscosity */
    struct pair_numbers numbers;
};

/* Chooses the loops of a plan from the tables, once per simulation: specialised ones if the plan
 * allows it and the kernel is built in. They keep a pointer to the scheme's kernel. */
void loops_choose(const struct plan *plan, const struct scheme *scheme, struct loops *loops);

/* The tables, one in each of the four files; kernel: index in kernels.def, -1: generic. The files
 * that depend on the kernel are compiled once with the tables and once for each kernel
 * (specialise.c.in). */
density_loop *loop_density(int kernel, enum density_terms terms);
matrix_loop *loop_matrix(int kernel, enum gradient gradient, bool slopes);
gradient_loop *loop_gradient(int kernel, enum gradient gradient, int width);
force_loop *loop_force(bool specialised, enum formulation formulation, enum viscosity viscosity,
                       enum energy energy);

/* Computes only the signal speed of each particle of the range. */
void loops_signal(const struct particles *particles, ptrdiff_t first, int len, ptrdiff_t D);
