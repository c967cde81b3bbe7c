/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file
 * One evaluation of the rates, without motion. */
#ifndef SPHPROOF_PUBLIC_RATES_H
#define SPHPROOF_PUBLIC_RATES_H

#include <sphproof/simulations.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Output arrays: n values each, in the order of the setup; NULL: not needed. */
struct sphproof_rates {
    double *h;          /**< support radii; by default to a relative 1e-14, see key h_tolerance */
    double *rho;        /**< densities */
    double *P;          /**< pressures */
    double *force[3];   /**< dp/dt = m dv/dt */
    double *dU;         /**< dU/dt of U = m u */
    double *neighbours; /**< particles within h, including itself and images */
};

/** Evaluates the setup once. Errors as for sphproof_simulations_create. */
enum sphproof_status sphproof_rates_evaluate(const struct sphproof_setup *setup,
                                             const struct sphproof_rates *rates,
                                             struct sphproof_error *error);

#ifdef __cplusplus
}
#endif

#endif
