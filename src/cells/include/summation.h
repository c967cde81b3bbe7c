/* SPDX-License-Identifier: GPL-3.0-or-later
 * Densities and volumes from the kernel sum, in 1, 2 and 3 dimensions: solves rho_i = sum_j m_j
 * W(r_ij, h_i) together with h_i = eta (m_i/rho_i)^(1/d); the volume is m_i/rho_i. */
#ifndef SPHPROOF_SUMMATION_H
#define SPHPROOF_SUMMATION_H

#include "kernel.h"
#include "neighbours.h"

struct summation {
    struct points points;
    const struct kernel *kernel;
    const double *m;  /* n: masses (or any weight), > 0 */
    double eta;       /* above kernel_least_eta */
    double tolerance; /* relative, of h; 1e-10 is usual */
    int threads;      /* >= 1; the result does not depend on it */
};

/* Fills h and rho (n each). The left side of C sum_j m_j w(r_j/h) = m_i eta^d rises with h; it is
 * solved by Newton's method inside a bracket. STATUS_BAD_INPUT: eta too small, a mass not positive;
 * STATUS_BROKE_DOWN: no root at some point (too little mass in the cloud, or coincident points),
 * which the message names; STATUS_ENVIRONMENT: no memory. */
enum status summation_solve(const struct summation *summation, double *h, double *rho,
                            struct error *error);

#endif
