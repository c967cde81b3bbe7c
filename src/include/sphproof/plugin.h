/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file
 * A kernel of your own, checked by sphproof. Write one C file with the functions below, then
 *
 *     cc -O2 -shared -fPIC -I DIR_OF_THIS_HEADER my_kernel.c -o my_kernel.so -lm
 *     sphproof kernel ./my_kernel.so --dim 3          its certificate, exit status 1 if it is wrong
 *     sphproof verify kernels --kernel-plugin ./my_kernel.so
 *     sphproof run sod kernel=./my_kernel.so          and so wherever a kernel is named
 *
 * The kernel is W(r,h) = C_d h^-d w(q), q = r/h, where h is the support radius and d = dim = 1, 2
 * or 3. A dimension that is not asked for is not called. What you supply is checked; what you leave
 * out is derived, and the certificate says so. The functions must be pure: same arguments, same
 * value, however often they are called. They run in a process of their own: one that crashes, ends
 * the process or does not return within a second is a kernel that fails (exit status 1), or no
 * kernel (2) if it does so in its first calls; what it prints is kept apart from results. If w and
 * dw are computed in single precision, say so: sphproof kernel F.so --precision single. In runs
 * with
 * --threads several threads call w and dw at once. */
#ifndef SPHPROOF_PLUGIN_H
#define SPHPROOF_PLUGIN_H

#ifdef __cplusplus
extern "C" {
#endif

/** Most knots in one dimension. */
enum { SPHPROOF_KERNEL_KNOTS_MAX = 4096 };

/** Required: the shape w(q) for q >= 0, exactly 0 for q >= 1. */
double sphproof_kernel_w(double q, int dim);
/** Required: its derivative dw/dq, exactly 0 for q >= 1 (that of a kernel declared C0 may have its
 * one-sided value at q = 1 itself). */
double sphproof_kernel_dw(double q, int dim);

/** Optional: the constant C_d to full precision; else found by quadrature. */
double sphproof_kernel_constant(int dim);

/** Optional: the whole dW/dh; else -C_d h^-(d+1) (d w + q dw). */
double sphproof_kernel_dw_dh(double r, double h, int dim);

/** Optional: the points 0 < q < 1 where some derivative of w jumps, ascending, written to knots;
 * their number is returned. Else they are found by bisection. */
int sphproof_kernel_knots(int dim, double *knots);

/** Optional: the class k of C^k, the least over the origin (w continued as an even function), the
 * knots and the edge q = 1; else it is measured. */
int sphproof_kernel_class(int dim);

/** Optional: 1 if the kernel is meant to have a negative lobe. Its sign and monotony are then
 * reported, not required; 0, or no such function: W >= 0 and dW/dr <= 0 are required. */
int sphproof_kernel_negative(int dim);

/** Optional: a name for the results; else that of the file. */
const char *sphproof_kernel_name(void);

#ifdef __cplusplus
}
#endif

#endif
