/* SPDX-License-Identifier: GPL-3.0-or-later
 * Derived fields that need no neighbours: velocity and internal energy, equation of state, inputs
 * of the pair terms, limits of the time step. Plain loops over particles, specialised over
 * instruction sets like the sums. */
#ifndef SPHPROOF_STATE_H
#define SPHPROOF_STATE_H

#include "plan.h"
#include "width.h"

/* Computes v = p/m and U = e (- p^2/2m with kinetic = 1/2; 0 if e is U) of all particles. Returns
 * the number of particles whose U is not positive (NaN counts). */
double state_primitives(const struct particles *particles, double kinetic);

/* Parameters of the equation of state: constant = C_d of the kernel; follow = how strongly the
 * pressure follows the difference of the volume from its prediction (integrator.h). */
struct gas {
    double gamma, constant, eta, follow;
};

/* Computes the equation of state of len <= BATCH_MAX particles from their sums at h_inverse: P, c,
 * V, rho (CONVENTIONS eqs. 1.1, 3.1 to 3.3), h of the sum of mass, h_inverse_found, which is one
 * Newton step nearer to the root (eq. 3.11), and g, b and grad_h if the plan needs them. */
void state_close(const struct particles *particles, ptrdiff_t first, int len,
                 const struct plan *plan, const struct gas *gas, const struct density_sums *sums);

/* Computes dalpha/dt; only for viscosities with an evolving alpha. */
void state_dalpha(const struct particles *particles, ptrdiff_t first, int len,
                  const struct scheme *scheme);

/* The largest signal speed / h of len <= BATCH_MAX particles. */
double state_rate(const struct particles *particles, ptrdiff_t first, int len);

#endif
