/* SPDX-License-Identifier: GPL-3.0-or-later
 * Kernels (CONVENTIONS section 2): W(r,h) = C_d h^-d w(q), q = r/h, with h the support radius (w =
 * 0 for q >= 1). A kernel is one file in kernel/ (its mathematics and one KERNEL line) and one line
 * in kernels.def. */
#ifndef SPHPROOF_KERNEL_H
#define SPHPROOF_KERNEL_H

#include <stdbool.h>

#include "families.h"
#include "family.h"
#include "status.h"

enum { KERNEL_DIM_MAX = 3 };

struct kernel;

/* A kernel's shape function of q >= 0; must be exactly 0 for q >= 1. dim = 1, 2, 3. */
typedef double kernel_shape(const struct kernel *kernel, double q, int dim);

struct kernel {
    struct member member;
    kernel_shape *w;                     /* w(q) */
    kernel_shape *dw;                    /* dw/dq */
    double constant[KERNEL_DIM_MAX + 1]; /* C_d at index d; 0: computed by kernel_select */
    int knot_count;                      /* number of interior knots of w; -1: not declared */
    const double *knots;                 /* ascending; not owned */
    int smoothness[KERNEL_DIM_MAX + 1];  /* class C^k: minimum over origin, knots and edge */
    double unity_width;                  /* smallest eta with exact lattice sums in 1D; 0: none */
    /* Largest eta at which the uniform 1D lattice is linearly stable without viscosity,
     * vanilla_ice, gamma 1.4; 0: no limit was found. */
    double stable_eta[GRADIENTS];
    /* Measured defaults in 1D (see scheme_default); 0: as for other kernels. */
    double default_eta;
    double cloud_eta;               /* the same in 2D and 3D; 0: default_eta */
    struct {                        /* with integrators that predict h */
        double alpha;               /* sufficient viscosity */
        double cfl;                 /* times eta: stable with this viscosity */
        enum pair_width pair_width; /* for the standard gradient */
    } predicted;
    int order; /* n of sinc_n; 0 for the others */
    /* Functions of a plug-in (see src/include/sphproof/plugin.h); NULL for built-in kernels. */
    double (*plugin_w)(double q, int dim);
    double (*plugin_dw)(double q, int dim);
    double (*plugin_dw_dh)(double r, double h, int dim);
};

extern const struct family kernel_family;

/* Plug-ins: kernels that a program adds to those of kernels.def. They follow the n members in
 * kernel_family.members: iteration skips them, lookup by name finds them. They have no specialised
 * loops, and they set plugin_w and all constants. */
enum { KERNEL_PLUGINS_MAX = 16 };

/* Adds a plug-in, which the caller keeps and which must have a new name. Returns its index, or -1
 * if the table is full. */
int kernel_add(const struct kernel *plugin);

/* Index in kernel_family.members of the kernel or plug-in called name, or -1. */
int kernel_index(const char *name);

/* Copies the kernel called name to *kernel and completes it: sinc_order (3..12) applies to sinc
 * only; constants without a closed form are computed by a fixed Gauss-Legendre rule.
 * STATUS_BAD_INPUT: no such kernel, or sinc_order out of range. */
enum status kernel_select(struct kernel *kernel, const char *name, int sinc_order,
                          struct error *error);

/* Index in kernels.def of the built-in kernel with the same shape functions, which is also the
 * index of its specialised loops in every table; -1 for plug-ins. */
int kernel_specialisation(const struct kernel *kernel);

/* W(r,h), dW/dr and dW/dh in dim dimensions; r >= 0, h > 0. */
double kernel_value(const struct kernel *kernel, double r, double h, int dim);
double kernel_dr(const struct kernel *kernel, double r, double h, int dim);
double kernel_dh(const struct kernel *kernel, double r, double h, int dim);

/* The lower bound of eta for which h = eta (m/rho)^(1/d) has a root: eta^d > C_d w(0). */
double kernel_least_eta(const struct kernel *kernel, int dim);

#endif
