/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a state implies without any neighbours: velocity and internal energy, equation of state,
 * what the pair terms need of it, limits of the time step. Plain loops over particles, specialised
 * over instruction sets like the sums. */
#ifndef SPHPROOF_STATE_H
#define SPHPROOF_STATE_H

#include "plan.h"
#include "width.h"

/* v = p/m and U = e (- p^2/2m where kinetic = 1/2; 0 where e is U already) of all particles.
 * Returns how many have no positive U (NaN counts). */
double state_primitives(const struct particles *particles, double kinetic);

/* The numbers of the equation of state: constant = C_d of the kernel; follow = how strongly the
 * pressure follows a volume that was predicted too small or too large (integrator.h). */
struct gas {
    double gamma, constant, eta, follow;
};

/* Computes the equation of state of len <= BATCH_MAX particles from their sums at h_inverse: P, c,
 * V, rho (CONVENTIONS eqs. 1.1, 3.1 to 3.3), h of the sum of mass, h_inverse_found, which is one
 * Newton step nearer to the root (eq. 3.11), and g, b and grad_h if the plan needs them. */
void state_close(const struct particles *particles, ptrdiff_t first, int len,
                 const struct plan *plan, const struct gas *gas, const struct density_sums *sums);

/* dalpha/dt by the scheme's viscosity, of those that let alpha evolve. */
void state_dalpha(const struct particles *particles, ptrdiff_t first, int len,
                  const struct scheme *scheme);

/* The largest signal speed / h of len <= BATCH_MAX particles. */
double state_rate(const struct particles *particles, ptrdiff_t first, int len);

#endif
