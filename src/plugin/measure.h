/* SPDX-License-Identifier: GPL-3.0-or-later
 * Measurements of a kernel: integrals, moments, class, Fourier transform, lattice sums, in units of
 * the support radius: q = r/h, kappa = k h. */
#pragma once

#include "pieces.h"

/* kernel_value, kernel_dr or kernel_dh. */
typedef double measure_function(const struct kernel *kernel, double r, double h, int dim);

/* Area of the unit sphere: 2, 2 pi, 4 pi. */
double measure_sphere(int dim);

/* Integral of r^power f(r, h) over a h < r < b h, or over the whole support, by Gauss-Legendre
 * between the break points; adds the difference of two rules to *floor, unless floor is NULL. */
double measure_between(const struct pieces *pieces, measure_function *f, int power, double h,
                       double a, double b, double *floor);
double measure_support(const struct pieces *pieces, measure_function *f, int power, double h,
                       double *floor);

/* The C_d for which the integral of W is one. */
double measure_constant(const struct pieces *pieces);

struct measure_moments {
    double volume; /* integral of W dV, should be 1 */
    double second; /* integral of x^2 W dV / h^2: per axis, sigma^2/h^2 */
    double fourth; /* integral of x^4 W dV / h^4: per axis */
};

void measure_moments(const struct pieces *pieces, struct measure_moments *moments);

/* Standard deviation of a kernel over its support radius, along one direction, by Simpson's rule.
 */
double measure_deviation(const struct kernel *kernel, int dim);

enum { MEASURE_CLASS_MAX = 9 }; /* a higher class is reported as this one */

/* The highest class that can be determined with the kernel's rounding errors. */
int measure_class_limit(const struct pieces *pieces);

/* The largest jump of a derivative of w relative to its estimated error. */
struct measure_jump {
    double at, jump, floor;
};

struct measure_class {
    int class;       /* C^class measured, at most measure_class_limit; -1: w itself jumps */
    double at;       /* the point that limits it (0: origin, 1: edge), NaN: none */
    int extra;       /* undeclared break points with a jump */
    double extra_at; /* the first undeclared one */
    struct { /* undeclared break points with a jump in w, w' or w'' too small to be intended */
        int count, k; /* their number; derivative, position and size of the largest jump */
        double at, jump;
    } accident;
    struct measure_jump jump[MEASURE_CLASS_MAX + 2]; /* of derivative k, the most significant */
};

/* A jump counts if it exceeds its floor by this factor. */
extern const double measure_significant;

void measure_class(const struct pieces *pieces, struct measure_class *result);

/* Errors of lattice sums on a Cartesian lattice of spacing h/eta: sum W dV - 1 and -sum x dW/dx dV
 * - 1. */
void measure_lattice(const struct kernel *kernel, int dim, double eta, double *density,
                     double *gradient);

enum { MEASURE_NEIGHBOURS_MAX = 700 };

/* Number of neighbours (volume of the support over that of a particle) above which coincident pairs
 * on the densest lattice have less energy than single particles, so that particles pair; NaN: none
 * up to MEASURE_NEIGHBOURS_MAX. */
double measure_pairing(const struct kernel *kernel, int dim);

struct measure_fourier {
    double least;    /* minimum of the transform for 0 < kappa <= MEASURE_KAPPA_MAX, W^(0) = 1 */
    double least_at; /* its kappa */
    double first_negative; /* smallest kappa above which it is negative; NaN: none */
    double floor;          /* values between -floor and 0 count as 0 */
};

enum { MEASURE_KAPPA_MAX = 200 };

/* Nodes and weights of a quadrature that is accurate for the transform up to MEASURE_KAPPA_MAX. */
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
