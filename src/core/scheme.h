/* SPDX-License-Identifier: GPL-3.0-or-later
 * A scheme: every choice of method that a run makes (the families) and its numbers. */
#ifndef SPHPROOF_SCHEME_H
#define SPHPROOF_SCHEME_H

#include "families.h"
#include "family.h"
#include "kernel.h"

/* scheme_gradient_family, scheme_formulation_family ...: position of a member = its enum. */
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
    double alpha, beta;          /* viscosity; time_dependent: beta/alpha is the ratio kept */
    double alpha_min, alpha_max; /* time_dependent and cullen_dehnen only */
    double balsara_floor;        /* eps: keeps some viscosity in pure shear */
    double noise;                /* projected: nu, strength of the linear term */
    double alpha_u;              /* conductivity (Price 2008); 0: none */
    double shock_conductivity;   /* of strong shocks alone; 0: none */
    double eta;                  /* h = eta (m/rho)^(1/d) */
    double cfl;                  /* dt = cfl min h / v_signal; h = support radius */
    double h_tolerance;          /* relative, of Newton's h */
};

/* What the maker of a scheme leaves open. */
struct scheme_open {
    bool kernel, gradient, volume_element, viscosity, viscosity_form, balsara;
    bool eta, alpha, beta, cfl, energy, pair_width, h_method;
    /* the scheme has what a problem asks for, which may be excluded */
    bool shifting, shock_conductivity;
};

/* Does heat flow between neighbours? */
static inline bool scheme_conducts(const struct scheme *scheme)
{
    return scheme->alpha_u > 0 || scheme->shock_conductivity > 0;
}

/* Fills what is open: choices with those of the best scheme that was measured in so many
 * dimensions, then numbers from the descriptors of what has been chosen. */
void scheme_default(struct scheme *scheme, const struct scheme_open *open, int dim);

/* How many members of a family have a form in dim dimensions: they stand first in its list. */
size_t scheme_members(const struct family *family, int dim);

/* Checks that the choices go together and the numbers are in range (eta against the existence limit
 * of the kernel in dim dimensions). STATUS_BAD_INPUT names the two that exclude each other. */
enum status scheme_check(const struct scheme *scheme, int dim, struct error *error);

#endif
