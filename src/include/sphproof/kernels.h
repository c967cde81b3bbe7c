/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file
 * Kernels: W(r,h) = C_d h^-d w(q), q = r/h, in d = 1, 2, 3 dimensions, where h is the support
 * radius: w(q) = 0 for q >= 1. The built-in ones by name, and yours from its two functions. */
#ifndef SPHPROOF_PUBLIC_KERNELS_H
#define SPHPROOF_PUBLIC_KERNELS_H

#include <sphproof/common.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A kernel; made by sphproof_kernels_find or sphproof_kernels_own. */
struct sphproof_kernel;

/** A kernel of your own: the functions of a plug-in (see plugin.h), as pointers. They are pure. */
struct sphproof_shape {
    double (*w)(double q, int dim);  /**< w(q) for q >= 0 */
    double (*dw)(double q, int dim); /**< dw/dq */
    int dim;                         /**< the only dimension it is for; 0: all three */
    double constant[4];              /**< C_d at index d; 0: found by quadrature */
    const double *knots; /**< 0 < q < 1 where a derivative jumps, ascending; must outlive the kernel
                          */
    int knot_count;      /**< their number; negative: not declared, they are found */
    int smoothness;      /**< k of C^k over origin, knots and edge; negative: measured */
    bool negative;       /**< it is meant to have a negative lobe */
    bool single;         /**< computes in single precision */
    const char *name;    /**< for messages; must outlive the kernel */
};

/** The built-in kernel called name (`sphproof list kernels`): "cubic_spline", "wendland_c4" ...
 * SPHPROOF_BAD_INPUT: none is. Free it with sphproof_kernels_free. */
enum sphproof_status sphproof_kernels_find(const char *name, struct sphproof_kernel **kernel,
                                           struct sphproof_error *error);

/** A kernel from your functions. SPHPROOF_BAD_INPUT: a value is not finite, w is 0 everywhere, or
 * the knots do not ascend. Whether it is right is for sphproof_kernels_certify to tell. */
enum sphproof_status sphproof_kernels_own(const struct sphproof_shape *shape,
                                          struct sphproof_kernel **kernel,
                                          struct sphproof_error *error);

/** Releases it; NULL will do. */
void sphproof_kernels_free(struct sphproof_kernel *kernel);

/** W(r,h) in dim = 1, 2, 3 dimensions; r >= 0, h > 0. Units: length^-dim. */
double sphproof_kernels_value(const struct sphproof_kernel *kernel, double r, double h, int dim);
/** dW/dr. */
double sphproof_kernels_dr(const struct sphproof_kernel *kernel, double r, double h, int dim);
/** dW/dh at fixed r. */
double sphproof_kernels_dh(const struct sphproof_kernel *kernel, double r, double h, int dim);

/** Measures every property that a kernel must have in dim dimensions (normalisation, derivatives,
 * support, continuity, moments, transform, lattice sums ...) and hands each figure to sink (may be
 * NULL). It calls w and dw some million times. SPHPROOF_CHECK_FAILED: a property does not hold;
 * the error names the first. Unlike the program's command `kernel` it runs your functions here, in
 * this process. */
enum sphproof_status sphproof_kernels_certify(const struct sphproof_kernel *kernel, int dim,
                                              sphproof_figure_sink *sink, void *context,
                                              struct sphproof_error *error);

#ifdef __cplusplus
}
#endif

#endif
