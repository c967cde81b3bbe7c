/* SPDX-License-Identifier: GPL-3.0-or-later
 * What can be measured on a kernel: integrals, moments, class, Fourier transform, lattice sums.
 * In units of the support radius: q = r/h, kappa = k h. */
#pragma once

#include "pieces.h"

/* kernel_value, kernel_dr or kernel_dh. */
typedef double measure_function(const struct kernel *kernel, double r, double h, int dim);

/* Area of the unit sphere: 2, 2 pi, 4 pi. */
double measure_sphere(int dim);

/* Integral of r^power f(r, h) over a h < r < b h, and over the whole support, by Gauss-Legendre
 * between the break points; *floor is raised by the difference of two rules. */
double measure_between(const struct pieces *pieces, measure_function *f, int power, double h,
                       double a, double b, double *floor);
double measure_support(const struct pieces *pieces, measure_function *f, int power, double h,
                       double *floor);

/* C_d that makes the integral of W one. */
double measure_constant(const struct pieces *pieces, double *floor);

struct measure_moments {
    double volume; /* integral of W dV, should be 1 */
    double second; /* integral of x^2 W dV / h^2: per axis, sigma^2/h^2 */
    double fourth; /* integral of x^4 W dV / h^4: per axis */
};

void measure_moments(const struct pieces *pieces, struct measure_moments *moments);

enum { MEASURE_CLASS_MAX = 9 }; /* classes above are reported as this one */

/* The highest class that the kernel's rounding errors let anyone tell. */
int measure_class_limit(const struct pieces *pieces);

/* Where the k-th derivative of w jumps most, in units of the estimate of its own error. */
struct measure_jump {
    double at, jump, floor;
};

struct measure_class {
    int class;       /* C^class measured, at most measure_class_limit; -1: w itself jumps */
    double at;       /* the point that limits it (0 origin, 1 edge), NaN if none does */
    int extra;       /* break points with a jump that are not among the declared knots */
    double extra_at; /* the first of them */
    struct { /* undeclared break points, with a jump in w, w' or w'' too small to be intended */
        int count, k; /* the number; derivative, place and size of the largest jump */
        double at, jump;
    } accident;
    struct measure_jump jump[MEASURE_CLASS_MAX + 2]; /* of derivative k, the most significant */
};

/* A jump counts if it exceeds its floor by this factor. */
extern const double measure_significant;

void measure_class(const struct pieces *pieces, struct measure_class *result);

/* Lattice sums of a Cartesian lattice of spacing h/eta: sum W dV - 1 and -sum x dW/dx dV - 1. */
void measure_lattice(const struct kernel *kernel, int dim, double eta, double *density,
                     double *gradient);

enum { MEASURE_NEIGHBOURS_MAX = 700 };

/* Number of neighbours (volume of the support in units of a particle's) from which coincident pairs
 * on the densest lattice have less energy than single particles; NaN: none up to
 * MEASURE_NEIGHBOURS_MAX. Beyond it particles pair. */
double measure_pairing(const struct kernel *kernel, int dim);

struct measure_fourier {
    double least;          /* least transform for 0 < kappa <= MEASURE_KAPPA_MAX, W^(0) = 1 */
    double least_at;       /* its kappa */
    double first_negative; /* least kappa beyond which it becomes negative; NaN: none */
    double floor;          /* values between -floor and 0 count as 0 */
};

enum { MEASURE_KAPPA_MAX = 200 };

/* Nodes and weights of a quadrature that carries the transform up to MEASURE_KAPPA_MAX. */
struct measure_spectrum {
    int dim, n;
    double *q, *weight; /* weight includes C_d, the sphere's area, q^(d-1) and w(q) */
};

enum status measure_spectrum_make(struct measure_spectrum *spectrum, const struct pieces *pieces,
                                  struct error *error);
void measure_spectrum_free(struct measure_spectrum *spectrum);

/* Transform of W at kappa (d-dimensional, 1 at 0 for a normalised kernel). */
double measure_transform(const struct measure_spectrum *spectrum, double kappa);

void measure_fourier(const struct measure_spectrum *spectrum, struct measure_fourier *result);
