/* SPDX-License-Identifier: GPL-3.0-or-later
 * A scheme: every choice of method that a run makes (the families) and its numbers. */
#ifndef SPHPROOF_SCHEME_H
#define SPHPROOF_SCHEME_H

#include "family.h"
#include "kernel.h"

enum gradient { GRADIENT_STANDARD, GRADIENT_IA };
enum formulation { FORMULATION_VANILLA_ICE, FORMULATION_LAGRANGIAN };
enum volume_element { VOLUME_MASS, VOLUME_ENERGY };
enum viscosity {
    VISCOSITY_NONE,
    VISCOSITY_CONSTANT,
    VISCOSITY_TIME_DEPENDENT,
    VISCOSITY_RECONSTRUCTED,
    VISCOSITY_FADING
};
enum energy { ENERGY_INTERNAL, ENERGY_TOTAL };
/* The width at which a pair's gradient is taken: the mean of both particles' gradients, or one
 * gradient at max(h_i, h_j) or at the harmonic mean of h_i and h_j. */
enum pair_width { PAIR_MEAN, PAIR_MAX, PAIR_HARMONIC };
/* How h is found: by Newton to h_tolerance at every evaluation, or predicted from the last steps
 * with a single density sum; corrected: what that sum asks for goes through a Newton step before
 * it predicts. At a jump of density that is needed with wide kernels: the error of 1/h is mapped by
 * s = -(h/rho) drho/dh from prediction to sum, and extrapolation is unstable where s < -1/3. */
enum h_method { H_NEWTON, H_PREDICTED, H_CORRECTED };

/* Families whose members have no functions of their own: a plain list; position = enum. */
extern const struct family gradient_family, formulation_family, volume_element_family,
    viscosity_family, energy_family, pair_width_family, h_method_family, integrator_family;

struct integrator; /* see integrator.h */

struct scheme {
    struct kernel kernel;
    enum gradient gradient;
    enum formulation formulation;
    enum volume_element volume_element;
    enum viscosity viscosity;
    enum energy energy;
    enum pair_width pair_width;
    enum h_method h_method;
    const struct integrator *integrator;
    double alpha, beta;          /* viscosity; time_dependent: beta/alpha is the ratio kept */
    double alpha_min, alpha_max; /* time_dependent only */
    double eta;                  /* h = eta (m/rho)^(1/d) */
    double cfl;                  /* dt = cfl min h / v_signal; h = support radius */
    double h_tolerance;          /* relative, of Newton's h */
};

/* Checks that the choices go together and the numbers are in range (eta against the existence limit
 * of the kernel in dim dimensions). STATUS_BAD_INPUT names the two that exclude each other. */
enum status scheme_check(const struct scheme *scheme, int dim, struct error *error);

#endif
