/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file
 * Kernels: W(r,h) = C_d h^-d w(q), q = r/h, in d = 1, 2, 3 dimensions, where h is the support
 * radius: w(q) = 0 for q >= 1. Built-in kernels by name, and your own from two functions. */
#ifndef SPHPROOF_PUBLIC_KERNELS_H
#define SPHPROOF_PUBLIC_KERNELS_H

#include <sphproof/common.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A kernel, created by sphproof_kernels_find or sphproof_kernels_own. */
struct sphproof_kernel;

/** A kernel of your own: pointers to the functions of a plug-in (see plugin.h), which must be
 * pure. */
struct sphproof_shape {
    double (*w)(double q, int dim);  /**< w(q) for q >= 0 */
    double (*dw)(double q, int dim); /**< dw/dq */
    int dim;                         /**< the only valid dimension; 0: all three */
    double constant[4];              /**< C_d at index d; 0: found by quadrature */
    const double *knots;             /**< ascending, 0 < q < 1; must outlive the kernel */
    int knot_count;   /**< number of knots; negative: not declared, found automatically */
    int smoothness;   /**< k of C^k over origin, knots and edge; negative: measured */
    bool negative;    /**< intended to have a negative lobe */
    bool single;      /**< computes in single precision */
    const char *name; /**< for messages; must outlive the kernel */
};

/** Finds a built-in kernel by name (`sphproof list kernels`): "cubic_spline", "wendland_c4" ...
 * SPHPROOF_BAD_INPUT: no such kernel. Free with sphproof_kernels_free. */
enum sphproof_status sphproof_kernels_find(const char *name, struct sphproof_kernel **kernel,
                                           struct sphproof_error *error);

/** Creates a kernel from your functions. SPHPROOF_BAD_INPUT: a value is not finite, w is 0
 * everywhere, or the knots do not increase. This does not check the kernel;
 * sphproof_kernels_certify does. */
enum sphproof_status sphproof_kernels_own(const struct sphproof_shape *shape,
                                          struct sphproof_kernel **kernel,
                                          struct sphproof_error *error);

/** Frees the kernel; may be NULL. */
void sphproof_kernels_free(struct sphproof_kernel *kernel);

/** W(r,h) in dim = 1, 2, 3 dimensions; r >= 0, h > 0. Units: length^-dim. */
double sphproof_kernels_value(const struct sphproof_kernel *kernel, double r, double h, int dim);
/** dW/dr. */
double sphproof_kernels_dr(const struct sphproof_kernel *kernel, double r, double h, int dim);
/** dW/dh at fixed r. */
double sphproof_kernels_dh(const struct sphproof_kernel *kernel, double r, double h, int dim);

/** Measures every property that a kernel must have in dim dimensions (normalisation, derivatives,
 * support, continuity, moments, transform, lattice sums ...) and passes each figure to sink (may be
 * NULL). Calls w and dw some million times. SPHPROOF_CHECK_FAILED: a property does not hold; the
 * error names the first. Unlike the command `kernel` it runs your functions in this process. */
enum sphproof_status sphproof_kernels_certify(const struct sphproof_kernel *kernel, int dim,
                                              sphproof_figure_sink *sink, void *context,
                                              struct sphproof_error *error);

#ifdef __cplusplus
}
#endif

#endif
