/* SPDX-License-Identifier: GPL-3.0-or-later
 * A scheme: all choices of method of a run (the families) and their parameters. */
#ifndef SPHPROOF_SCHEME_H
#define SPHPROOF_SCHEME_H

#include "families.h"
#include "family.h"
#include "kernel.h"

/* scheme_gradient_family, scheme_formulation_family ...: index of a member = its enum. */
#define SCHEME_FAMILY(name, ...) extern const struct family scheme_##name##_family;
FAMILY_LIST(SCHEME_FAMILY)
#undef SCHEME_FAMILY

struct integrator; /* see integrator.h */

struct scheme {
    struct kernel kernel;
    enum gradient gradient;
    enum formulation formulation;
    enum volume_element volume_element;
    enum viscosity viscosity;
    enum viscosity_form viscosity_form;
    enum balsara balsara;
    enum energy energy;
    enum pair_width pair_width;
    enum h_method h_method;
    enum time_steps steps;
    enum shifting shifting;
    const struct integrator *integrator;
    double alpha, beta;          /* viscosity; time_dependent keeps the ratio beta/alpha */
    double alpha_min, alpha_max; /* time_dependent and cullen_dehnen only */
    double balsara_floor;        /* eps: keeps some viscosity in pure shear */
    double noise;                /* projected: nu, strength of the linear term */
    double alpha_u;              /* conductivity (Price 2008); 0: none */
    double shock_conductivity;   /* in strong shocks only; 0: none */
    double eta;                  /* h = eta (m/rho)^(1/d) */
    double cfl;                  /* dt = cfl min h / v_signal; h = support radius */
    double h_tolerance;          /* relative, of Newton's h */
};

/* The fields that are not set yet and take defaults. */
struct scheme_open {
    bool kernel, gradient, volume_element, viscosity, viscosity_form, balsara;
    bool eta, alpha, beta, cfl, energy, pair_width, h_method;
    /* the problem sets these two; a default replaces them if they are excluded */
    bool shifting, shock_conductivity;
};

/* True if the scheme has artificial conductivity. */
static inline bool scheme_conducts(const struct scheme *scheme)
{
    return scheme->alpha_u > 0 || scheme->shock_conductivity > 0;
}

/* Sets the open fields: choices from the best scheme measured in dim dimensions, then parameters
 * from the descriptors of the choices. */
void scheme_default(struct scheme *scheme, const struct scheme_open *open, int dim);

/* Number of members of a family that are defined in dim dimensions: the first ones of its list. */
size_t scheme_members(const struct family *family, int dim);

/* Checks that the choices are compatible and the parameters in range (eta against the existence
 * limit of the kernel in dim dimensions). STATUS_BAD_INPUT names both of two incompatible choices.
 */
enum status scheme_check(const struct scheme *scheme, int dim, struct error *error);

#endif
