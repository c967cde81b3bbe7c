/* SPDX-License-Identifier: GPL-3.0-or-later
 * The smoothing length h = eta (m/rho(h))^(1/d) (CONVENTIONS eq. 3.4), d = 1, 2, 3, with rho the
 * kernel sum of mass: Newton's method (eq. 3.10) inside a bracket, for up to BATCH_MAX particles
 * that are worked on together. Who knows geometry computes the sums at the widths that are asked
 * for. */
#ifndef SPHPROOF_WIDTH_H
#define SPHPROOF_WIDTH_H

#include <stdbool.h>

#include "particles.h"

enum {
    BATCH_MAX = 64, /* particles that are worked on together at most: whole vectors */
    WIDTH_STEPS_MAX = 200
};

/* Kernel sums of a batch at the width h, without the factor C_d/h^d:
 * m = sum m w, m_dh = sum m (d w + q w') = -h d/dh of what m gives, Z and Z_dh the same with Z. */
struct density_sums {
    double m[BATCH_MAX], m_dh[BATCH_MAX], Z[BATCH_MAX], Z_dh[BATCH_MAX];
};

struct simulation;

struct width_rule {
    int dim;
    double eta, constant; /* C_d of the kernel */
    double tolerance;     /* relative, of |h - eta (m/rho(h))^(1/d)| */
};

struct width_bracket {
    double low[BATCH_MAX], high[BATCH_MAX];
};

/* That of a simulation at its present step. The start is solved to 1e-10 at least, whatever
 * h_tolerance says: gas that sleeps keeps its widths, and those awake beside it must not find
 * better ones later. */
struct width_rule width_rule_of(const struct simulation *simulation);

/* eta (m/rho)^(1/d). */
double width_of(const struct width_rule *rule, double m, double rho);

/* How many particles at even spacing are within h, eta spacings, of one: volume of a ball. */
double width_neighbours(int dim, double eta);

/* Starts with the bracket (0, high) around each of len widths; high may be INFINITY. */
void width_begin(struct width_bracket *bracket, int len, double high);

/* One step of Newton's method from the sums at h; where that leaves the bracket, or the slope is
 * no good, half of the bracket (twice h where it has no end). A width that has converged stays as
 * it is. Sets h_inverse with h. Returns whether any has not converged. */
bool width_step(const struct width_rule *rule, int len, const double *m,
                const struct density_sums *sums, struct width_bracket *bracket, double *h,
                double *h_inverse);

/* After WIDTH_STEPS_MAX steps: the first whose width is not even good to 1e-6, -1 for none. */
int width_without_root(const struct width_rule *rule, int len, const double *m,
                       const struct density_sums *sums, const double *h, const double *h_inverse);

/* 1/h for the next density sum (eq. 3.11): as last found, extrapolated by ratio times its last
 * change, no further than a quarter of itself: clumps that fly apart in their first steps (jittered
 * starts) would else be given widths, and time steps, far too long. */
void width_predict(const struct particles *particles, ptrdiff_t first, int len, double ratio);

#endif
