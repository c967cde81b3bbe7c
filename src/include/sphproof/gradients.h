/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file
 * Gradient operators on a cloud of points in 1, 2 or 3 dimensions, ours and yours. */
#ifndef SPHPROOF_PUBLIC_GRADIENTS_H
#define SPHPROOF_PUBLIC_GRADIENTS_H

#include <sphproof/kernels.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Points that carry volumes. Neighbours of i: |r_j - r_i| < h_i, itself included. */
struct sphproof_cloud {
    int dim;              /**< 1, 2, 3 */
    size_t n;             /**< points */
    const double *x[3];   /**< n each: coordinates */
    const double *volume; /**< n, > 0; units: length^dim */
    const double *h;      /**< n, > 0: support radii */
    bool periodic;        /**< in all directions, with the box lo to hi */
    double lo[3];         /**< of the box; where periodic only */
    double hi[3];         /**< of the box */
};

/** Gradients of f (n values) by the operator called name (`sphproof list operators`): "standard",
 * "ia", "linear_exact" ... into gradient[0..dim-1], n each. A point whose matrix has no inverse
 * gets NaN. SPHPROOF_BAD_INPUT: no such operator, or h, volume or a coordinate out of range. */
enum sphproof_status sphproof_gradients_apply(const char *name,
                                              const struct sphproof_kernel *kernel,
                                              const struct sphproof_cloud *cloud, const double *f,
                                              double *const gradient[],
                                              struct sphproof_error *error);

/** Densities of n points of masses m by the kernel sum, rho_i = sum_j m_j W(r_ij, h_i), with h_i =
 * eta (m_i/rho_i)^(1/dim) found together with them, to a relative 1e-10: h and rho, n each. volume
 * and h of the cloud are not read. SPHPROOF_BAD_INPUT: eta too small, a mass not above 0;
 * SPHPROOF_BROKE_DOWN: some point has no such h. */
enum sphproof_status sphproof_gradients_density(const struct sphproof_kernel *kernel, double eta,
                                                const struct sphproof_cloud *cloud, const double *m,
                                                double *h, double *rho,
                                                struct sphproof_error *error);

/** A gradient operator of your own: fills gradient[0..dim-1] (n each) from f (n) on the cloud,
 * which is open. True if it could. */
typedef bool sphproof_gradient_operator(void *context, const struct sphproof_cloud *cloud,
                                        const double *f, double *const gradient[]);

/** What your operator promises; what it does not promise is not asked of it. */
struct sphproof_gradient_promise {
    int exact;    /**< polynomials of degree below this are exact on any cloud: 0, 1 or 2 */
    double order; /**< at least, in the spacing, of a smooth field on disordered points */
    double eta;   /**< h = eta volume^(1/dim) on the clouds it is tried on: 2 to 3 is usual */
    bool turns;   /**< the gradient turns with the cloud (mirrors in 1D) */
    bool moves;   /**< does not depend on where the origin is */
    bool scales;  /**< does not depend on the unit of length */
    bool linear;  /**< that of a f + b g is a grad f + b grad g */
};

/** Tries an operator in dim dimensions on lattices, jittered, clustered and one-sided clouds of up
 * to some thousand points and hands a figure for each promised property to sink (may be NULL), of
 * points whose support lies inside the cloud; and whether the same input gives the same output.
 * SPHPROOF_CHECK_FAILED: a promise is not kept, or the operator says false; the error names the
 * first. */
enum sphproof_status sphproof_gradients_check(sphproof_gradient_operator *gradients, void *context,
                                              int dim,
                                              const struct sphproof_gradient_promise *promise,
                                              sphproof_figure_sink *sink, void *sink_context,
                                              struct sphproof_error *error);

#ifdef __cplusplus
}
#endif

#endif
