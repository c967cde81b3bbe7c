/* SPDX-License-Identifier: GPL-3.0-or-later
 * Solves for the smoothing length h = eta (m/rho(h))^(1/d) (CONVENTIONS eq. 3.4), d = 1, 2, 3, with
 * rho the kernel sum of mass: Newton's method (eq. 3.10) inside a bracket, for batches of up to
 * BATCH_MAX particles. The caller computes the sums at the requested h. */
#ifndef SPHPROOF_WIDTH_H
#define SPHPROOF_WIDTH_H

#include <stdbool.h>

#include "particles.h"

enum {
    BATCH_MAX = 64, /* maximum number of particles in a batch; whole vectors */
    WIDTH_STEPS_MAX = 200
};

/* Kernel sums of a batch at h, without the factor C_d/h^d: m = sum m w, m_dh = sum m (d w + q w'),
 * where -m_dh C_d/h^(d+1) is the derivative of the density in h; Z and Z_dh the same with Z. */
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

/* The rule of a simulation at its current step. The start is solved to at least 1e-10,
 * independently of h_tolerance: sleeping particles keep their h, and their awake neighbours must
 * not find better values later. */
struct width_rule width_rule_of(const struct simulation *simulation);

/* eta (m/rho)^(1/d). */
double width_of(const struct width_rule *rule, double m, double rho);

/* Number of evenly spaced particles within h = eta spacings of one: the volume of a ball. */
double width_neighbours(int dim, double eta);

/* Sets the bracket of len particles to (0, high); high may be INFINITY. */
void width_begin(struct width_bracket *bracket, int len, double high);

/* One step of Newton's method from the sums at h. If it leaves the bracket, or the slope is not
 * positive, it bisects the bracket (or doubles h if the bracket has no upper end). Converged values
 * are not changed. Sets h_inverse with h. Returns whether any value has not converged. */
bool width_step(const struct width_rule *rule, int len, const double *m,
                const struct density_sums *sums, struct width_bracket *bracket, double *h,
                double *h_inverse);

/* For use after WIDTH_STEPS_MAX steps: the index of the first particle whose h is not accurate to
 * 1e-6, or -1. */
int width_without_root(const struct width_rule *rule, int len, const double *m,
                       const struct density_sums *sums, const double *h, const double *h_inverse);

/* Predicts 1/h for the next density sum (eq. 3.11): the last value, extrapolated by ratio times its
 * last change, at most by a quarter. Without this limit clumps that fly apart in the first steps
 * (jittered starts) would get far too large h and time steps. */
void width_predict(const struct particles *particles, ptrdiff_t first, int len, double ratio);

#endif
