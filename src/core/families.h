/* SPDX-License-Identifier: GPL-3.0-or-later
 * Families whose members are choices in the equations. One list for each family defines its enum
 * (here), its descriptors (scheme.c) and its axis in the tables of specialised loops, so that these
 * always agree. Each gradient and viscosity has a file of its own; their lists are generated
 * (family_names.h).
 *
 * A member is CHOICE(symbol, name, label, paper). A list passes its further arguments to each
 * member, so that lists nest: FORMULATION_LIST(F, a) expands to F(symbol, name, label, paper, a)
 * for each member. */
#ifndef SPHPROOF_FAMILIES_H
#define SPHPROOF_FAMILIES_H

#include "family_names.h"

#define FORMULATION_LIST(CHOICE, ...)                                                              \
    CHOICE(FORMULATION_VANILLA_ICE, "vanilla_ice", "(P_i + P_j)/(rho_i rho_j), lambda = 1",        \
           "Wadsley, Keller & Quinn 2017", __VA_ARGS__)                                            \
    CHOICE(FORMULATION_LAGRANGIAN, "lagrangian", "f_i P_i/rho_i^2 + f_j P_j/rho_j^2 with grad-h",  \
           "Springel & Hernquist 2002", __VA_ARGS__)

#define VOLUME_ELEMENT_LIST(CHOICE, ...)                                                           \
    CHOICE(VOLUME_MASS, "mass", "Z = m: density, standard SPH", "Monaghan 1992", __VA_ARGS__)      \
    CHOICE(VOLUME_ENERGY, "energy", "Z = U: energy density, density-independent SPH",              \
           "Saitoh & Makino 2013", __VA_ARGS__)                                                    \
    CHOICE(VOLUME_NUMBER, "number", "Z = 1: number density, for unequal masses",                   \
           "Ritchie & Thomas 2001", __VA_ARGS__)

#define VISCOSITY_FORM_LIST(CHOICE, ...)                                                           \
    CHOICE(VISCOSITY_FORM_MU, "mu", "by mu = hbar v.r/(r^2 + 0.01 hbar^2)", "Monaghan 1992",       \
           __VA_ARGS__)                                                                            \
    CHOICE(VISCOSITY_FORM_SIGNAL, "signal", "by the signal velocity along the pair",               \
           "Monaghan 1997", __VA_ARGS__)

#define BALSARA_LIST(CHOICE, ...)                                                                  \
    CHOICE(BALSARA_OFF, "off", "viscosity in shear as in compression", "", __VA_ARGS__)            \
    CHOICE(BALSARA_ON, "on", "viscosity times |div v|/(|div v| + |curl v|)", "Balsara 1995",       \
           __VA_ARGS__)

/* Boundary condition at both ends of the box along an axis. */
#define BOUNDARY_LIST(CHOICE, ...)                                                                 \
    CHOICE(BOUNDARY_PERIODIC, "periodic", "the other end follows", "", __VA_ARGS__)                \
    CHOICE(BOUNDARY_OPEN, "open", "nothing: gas may leave into a vacuum", "", __VA_ARGS__)         \
    CHOICE(BOUNDARY_REFLECTING, "reflecting", "a wall: mirror images of the particles near it",    \
           "", __VA_ARGS__)                                                                        \
    CHOICE(BOUNDARY_FIXED, "fixed", "layers of particles whose state is kept", "", __VA_ARGS__)

#define ENERGY_LIST(CHOICE, ...)                                                                   \
    CHOICE(ENERGY_INTERNAL, "internal", "U = m u", "", __VA_ARGS__)                                \
    CHOICE(ENERGY_TOTAL, "total", "E = U + p^2/2m: conserved to round-off", "", __VA_ARGS__)

/* Smoothing length of a pair gradient. */
#define PAIR_WIDTH_LIST(CHOICE, ...)                                                               \
    CHOICE(PAIR_WIDTH_MEAN, "mean", "mean of the gradients at h_i and h_j", "", __VA_ARGS__)       \
    CHOICE(PAIR_WIDTH_MAX, "max", "one gradient at max(h_i, h_j)", "", __VA_ARGS__)                \
    CHOICE(PAIR_WIDTH_HARMONIC, "harmonic", "one gradient at the harmonic mean of h_i and h_j",    \
           "", __VA_ARGS__)

/* Method for h: Newton's method to h_tolerance at every evaluation, or prediction from the last
 * steps with a single density sum, followed by one Newton step before the next prediction. */
#define H_METHOD_LIST(CHOICE, ...)                                                                 \
    CHOICE(H_NEWTON, "newton", "root of h = eta (m/rho)^(1/d) at every evaluation", "",            \
           __VA_ARGS__)                                                                            \
    CHOICE(H_PREDICTED, "predicted",                                                               \
           "extrapolated from the last steps; one density sum, and a Newton step for the next",    \
           "", __VA_ARGS__)

#define STEPS_LIST(CHOICE, ...)                                                                    \
    CHOICE(STEPS_GLOBAL, "global", "one time step for all particles", "", __VA_ARGS__)             \
    CHOICE(STEPS_LOCAL, "local",                                                                   \
           "one for each particle, by powers of two; pairs exchange impulses and energy", "",      \
           __VA_ARGS__)

/* Particle shifting, in 2D and 3D: see shifting.h. */
#define SHIFTING_LIST(CHOICE, ...)                                                                 \
    CHOICE(SHIFTING_NONE, "none", "particles move with the flow", "", __VA_ARGS__)                 \
    CHOICE(SHIFTING_FLUXES, "fluxes",                                                              \
           "particles shift to where they are spread evenly, and exchange what they sweep over",   \
           "Nestor et al. 2009; Oger et al. 2016 with fluxes", __VA_ARGS__)                        \
    CHOICE(SHIFTING_CLOSED, "closed",                                                              \
           "as fluxes, with pair gradients that make nothing of a constant",                       \
           "Chiu, Wang, Hu & Jameson 2012; Trask, Bochev & Perego 2020", __VA_ARGS__)

/* FAMILY(name, list, number of members, plural, title) defines enum name and scheme_name_family.
 * First the families whose members have a file and a descriptor each (gradient.h, viscosity.h),
 * then those of plain choices, then all. */
#define FAMILY_FILE_LIST(FAMILY)                                                                   \
    FAMILY(gradient, GRADIENT_LIST, GRADIENTS, "gradients",                                        \
           "gradients of the equations of motion")                                                 \
    FAMILY(viscosity, VISCOSITY_LIST, VISCOSITIES, "viscosities", "artificial viscosities")
#define FAMILY_CHOICE_LIST(FAMILY)                                                                 \
    FAMILY(formulation, FORMULATION_LIST, FORMULATIONS, "formulations", "equations of motion")     \
    FAMILY(volume_element, VOLUME_ELEMENT_LIST, VOLUME_ELEMENTS, "volume_elements",                \
           "what the kernel sum adds up")                                                          \
    FAMILY(viscosity_form, VISCOSITY_FORM_LIST, VISCOSITY_FORMS, "viscosity_forms",                \
           "what artificial viscosity takes for the closing speed")                                \
    FAMILY(balsara, BALSARA_LIST, BALSARAS, "balsara_factors", "artificial viscosity in shear")    \
    FAMILY(boundary, BOUNDARY_LIST, BOUNDARIES, "boundaries", "what is at the ends of the box")    \
    FAMILY(energy, ENERGY_LIST, ENERGIES, "energies", "the energy that is integrated")             \
    FAMILY(pair_width, PAIR_WIDTH_LIST, PAIR_WIDTHS, "pair_widths",                                \
           "width at which a pair's gradient is taken")                                            \
    FAMILY(h_method, H_METHOD_LIST, H_METHODS, "h_methods", "how the smoothing length is found")   \
    FAMILY(time_steps, STEPS_LIST, TIME_STEPS, "time_steps", "whose time step it is")              \
    FAMILY(shifting, SHIFTING_LIST, SHIFTINGS, "shiftings", "what moves particles besides the flow")

#define FAMILY_LIST(FAMILY) FAMILY_FILE_LIST(FAMILY) FAMILY_CHOICE_LIST(FAMILY)

#define FAMILY_SYMBOL(symbol, ...) symbol,
#define FAMILY_COUNTED(...)        +1
#define FAMILY_ENUM(name, LIST, count, ...)                                                        \
    enum name { LIST(FAMILY_SYMBOL, ) };                                                           \
    enum { count = 0 LIST(FAMILY_COUNTED, ) };
FAMILY_LIST(FAMILY_ENUM)

#endif
