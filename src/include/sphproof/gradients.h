/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file
 * Gradient operators on a cloud of points in 1, 2 or 3 dimensions, built-in or your own. */
#ifndef SPHPROOF_PUBLIC_GRADIENTS_H
#define SPHPROOF_PUBLIC_GRADIENTS_H

#include <sphproof/kernels.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Points with volumes. Neighbours of i: |r_j - r_i| < h_i, including i. */
struct sphproof_cloud {
    int dim;              /**< 1, 2, 3 */
    size_t n;             /**< points */
    const double *x[3];   /**< n each: coordinates */
    const double *volume; /**< n, > 0; units: length^dim */
    const double *h;      /**< n, > 0: support radii */
    bool periodic;        /**< periodic in all directions with the box lo to hi */
    double lo[3];         /**< of the box; only if periodic */
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

/** Densities of n points of masses m by the kernel sum, rho_i = sum_j m_j W(r_ij, h_i), solved
 * together with h_i = eta (m_i/rho_i)^(1/dim) to a relative 1e-10. h and rho receive n values each.
 * volume and h of the cloud are not read. SPHPROOF_BAD_INPUT: eta too small, or a mass <= 0;
 * SPHPROOF_BROKE_DOWN: no such h exists for some point. */
enum sphproof_status sphproof_gradients_density(const struct sphproof_kernel *kernel, double eta,
                                                const struct sphproof_cloud *cloud, const double *m,
                                                double *h, double *rho,
                                                struct sphproof_error *error);

/** A gradient operator of your own: computes gradient[0..dim-1] (n each) from f (n) on a cloud that
 * is not periodic. Returns false on failure. */
typedef bool sphproof_gradient_operator(void *context, const struct sphproof_cloud *cloud,
                                        const double *f, double *const gradient[]);

/** What your operator promises; nothing else is checked. */
struct sphproof_gradient_promise {
    int exact;    /**< exact on any cloud for polynomials of degree below this: 0, 1 or 2 */
    double order; /**< least order in the spacing, for a smooth field on disordered points */
    double eta;   /**< h = eta volume^(1/dim) on the test clouds; usually 2 to 3 */
    bool turns;   /**< the gradient rotates with the cloud (is mirrored in 1D) */
    bool moves;   /**< independent of the origin */
    bool scales;  /**< independent of the unit of length */
    bool linear;  /**< grad(a f + b g) = a grad f + b grad g */
};

/** Tests an operator in dim dimensions on lattices and on jittered, clustered and one-sided clouds
 * of up to some thousand points. Passes a figure for each promised property, measured on points
 * whose support lies inside the cloud, to sink (may be NULL), and one for repeatability: equal
 * input must give equal output. SPHPROOF_CHECK_FAILED: a promise is broken or the operator returned
 * false; the error names the first. */
enum sphproof_status sphproof_gradients_check(sphproof_gradient_operator *gradients, void *context,
                                              int dim,
                                              const struct sphproof_gradient_promise *promise,
                                              sphproof_figure_sink *sink, void *sink_context,
                                              struct sphproof_error *error);

#ifdef __cplusplus
}
#endif

#endif
