/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scheme.h"

#include <math.h>
#include <stdio.h>

#include "gradient.h"
#include "integrator.h"
#include "viscosity.h"

#define CHOICE(symbol, key, label, paper, ...) [symbol] = &(const struct member){key, label, paper},
#define DESCRIBED(symbol, member_name, family) [symbol] = &family##_of[symbol].member,
#define FAMILY_OF(MEMBER, name, LIST, count, plural, title)                                        \
    static const struct member *const name##_members[count] = {LIST(MEMBER, name)};                \
    const struct family scheme_##name##_family = {plural, title, name##_members, count};
#define FAMILY_OF_FILES(...)   FAMILY_OF(DESCRIBED, __VA_ARGS__)
#define FAMILY_OF_CHOICES(...) FAMILY_OF(CHOICE, __VA_ARGS__)
FAMILY_FILE_LIST(FAMILY_OF_FILES)
FAMILY_CHOICE_LIST(FAMILY_OF_CHOICES)

/* An incompatible choice of another key. */
struct exclusion {
    bool excluded;
    const char *key, *name, *why;
};

/* Reports the first excluded combination. */
static enum status refuse_first(const char *choice, const struct exclusion *list, size_t n,
                                struct error *error)
{
    for (size_t k = 0; k < n; k++)
        if (list[k].excluded)
            return error_set(error, STATUS_BAD_INPUT, "%s and %s=%s exclude each other: %s", choice,
                             list[k].key, list[k].name, list[k].why);
    return STATUS_OK;
}

#define MEMBER(family) #family, scheme_##family##_family.members[scheme->family]->name

static enum status check_steps(const struct scheme *scheme, struct error *error)
{
    const struct exclusion list[] = {
        {!scheme->integrator->local, "integrator", scheme->integrator->member.name,
         "local steps are those of predicted_midpoint"},
        {scheme->h_method != H_PREDICTED, MEMBER(h_method),
         "widths are predicted between a particle's sums"},
        {scheme->formulation != FORMULATION_VANILLA_ICE, MEMBER(formulation),
         "grad-h factors cannot be predicted"},
        {scheme->volume_element == VOLUME_ENERGY, MEMBER(volume_element),
         "the volume does not follow from the width"},
        {viscosity_varies(scheme->viscosity), MEMBER(viscosity),
         "alpha evolves in global steps alone"},
    };
    if (scheme->steps != STEPS_LOCAL) return STATUS_OK;
    return refuse_first("steps=local", list, sizeof list / sizeof *list, error);
}

/* Shifting changes masses, and excludes everything that assumes constant masses. */
static enum status check_shifting(const struct scheme *scheme, struct error *error)
{
    const struct exclusion list[] = {
        {!scheme->integrator->shifts, "integrator", scheme->integrator->member.name,
         "masses advance with predicted_midpoint alone"},
        {scheme->steps != STEPS_GLOBAL, "steps",
         scheme_time_steps_family.members[scheme->steps]->name,
         "masses change in global steps alone"},
        {scheme->energy != ENERGY_TOTAL, MEMBER(energy), "particles exchange total energy"},
        {scheme->formulation != FORMULATION_VANILLA_ICE, MEMBER(formulation),
         "grad-h factors belong to constant masses"},
        {scheme->volume_element != VOLUME_NUMBER, MEMBER(volume_element),
         "volumes must not depend on what particles exchange, as those of number do"},
        {gradient_of[scheme->gradient].weight == WEIGHT_NONE, MEMBER(gradient),
         "particles shift along the gradient that a moment matrix makes of a constant"},
    };
    char chosen[40];
    if (scheme->shifting == SHIFTING_NONE) return STATUS_OK;
    snprintf(chosen, sizeof chosen, "shifting=%s",
             scheme_shifting_family.members[scheme->shifting]->name);
    return refuse_first(chosen, list, sizeof list / sizeof *list, error);
}

/* In 2D and 3D: a wide smooth kernel, ia, which removes the error for uniform pressure, and a
 * viscosity that damps noise but not shear: the only combination among the best both for vortices
 * and for Kelvin-Helmholtz (see the tables of cases/README.md). */
static void default_choices(struct scheme *scheme, const struct scheme_open *open, bool line)
{
    struct error none;
    if (open->kernel)
        kernel_select(&scheme->kernel, line ? "quadratic_spline" : "wendland_c4", 5, &none);
    if (open->gradient) scheme->gradient = line ? GRADIENT_STANDARD : GRADIENT_IA;
    if (open->viscosity) scheme->viscosity = line ? VISCOSITY_CONSTANT : VISCOSITY_PROJECTED;
    const struct viscosity_descriptor *viscosity = &viscosity_of[scheme->viscosity];
    if (open->volume_element) scheme->volume_element = viscosity->defaults.volume_element;
    if (open->viscosity_form)
        scheme->viscosity_form = line ? VISCOSITY_FORM_MU : viscosity->defaults.cloud_form;
    if (open->balsara) scheme->balsara = viscosity->defaults.balsara;
}

void scheme_default(struct scheme *scheme, const struct scheme_open *open, int dim)
{
    default_choices(scheme, open, dim == 1);
    const struct kernel *kernel = &scheme->kernel;
    const struct viscosity_descriptor *viscosity = &viscosity_of[scheme->viscosity];
    const struct integrator *integrator = scheme->integrator;
    const bool predicts = integrator->predicts, own = predicts && dim == 1,
               vanilla = scheme->formulation == FORMULATION_VANILLA_ICE,
               standard = gradient_of[scheme->gradient].weight == WEIGHT_NONE;
    if (open->eta)
        scheme->eta = dim > 1 && kernel->cloud_eta > 0 ? kernel->cloud_eta : kernel->default_eta;
    if (open->energy) scheme->energy = predicts ? ENERGY_TOTAL : ENERGY_INTERNAL;
    if (open->alpha)
        scheme->alpha = own && kernel->predicted.alpha > 0 ? kernel->predicted.alpha : 1;
    if (open->beta) scheme->beta = 2 * scheme->alpha;
    if (open->h_method) scheme->h_method = predicts && vanilla ? H_PREDICTED : H_NEWTON;
    if (open->pair_width)
        scheme->pair_width = !predicts || !vanilla           ? PAIR_WIDTH_MEAN
                             : viscosity->defaults.predicted ? viscosity->defaults.predicted
                             : own && standard               ? kernel->predicted.pair_width
                                                             : PAIR_WIDTH_MEAN;
    if (open->shifting && check_shifting(scheme, NULL)) scheme->shifting = SHIFTING_NONE;
    const bool inviscid = viscosity->none || (scheme->alpha == 0 && scheme->beta == 0);
    if (open->shock_conductivity && inviscid) scheme->shock_conductivity = 0;
    if (!open->cfl) return;
    /* long steps are stable up to this viscosity, and not worthwhile without any */
    const double most_alpha = viscosity->evolve ? scheme->alpha_max : scheme->alpha;
    const bool long_steps =
        own && standard && kernel->predicted.cfl > 0 && scheme->eta == kernel->default_eta &&
        !viscosity->none && most_alpha <= kernel->predicted.alpha &&
        scheme->h_method == H_PREDICTED && scheme->volume_element == VOLUME_MASS;
    /* mu grows as h/r when particles approach: in a strong shock (sedov_2d) longer steps would
     * leave cold gas ahead of it without internal energy */
    const bool bounded = viscosity->none || scheme->viscosity_form == VISCOSITY_FORM_SIGNAL;
    const double cloud_cfl =
        scheme->shifting == SHIFTING_CLOSED ? integrator->closed_cfl : integrator->cloud_cfl;
    scheme->cfl = long_steps                                        ? kernel->predicted.cfl
                  : dim > 1 && bounded && integrator->cloud_cfl > 0 ? cloud_cfl
                                                                    : integrator->cfl;
    if (integrator->cfl_per_width) scheme->cfl /= scheme->eta;
}

size_t scheme_members(const struct family *family, int dim)
{
    size_t n = 0;
    if (dim > 1) return family->n;
    if (family == &scheme_gradient_family) {
        while (n < GRADIENTS && gradient_of[n].least_dim == 1) n++;
        return n;
    }
    if (family == &scheme_viscosity_family) {
        while (n < VISCOSITIES && viscosity_of[n].least_dim == 1) n++;
        return n;
    }
    if (family == &scheme_volume_element_family) return VOLUME_NUMBER;
    if (family == &scheme_viscosity_form_family) return VISCOSITY_FORM_SIGNAL;
    if (family == &scheme_balsara_family) return BALSARA_ON;
    if (family == &scheme_time_steps_family) return STEPS_LOCAL;
    if (family == &scheme_shifting_family) return SHIFTING_FLUXES;
    return family->n;
}

/* Refuses choices that need two dimensions. */
static enum status check_members(const struct scheme *scheme, int dim, struct error *error)
{
    const struct {
        const char *key;
        const struct family *family;
        size_t member;
    } choices[] = {{"gradient", &scheme_gradient_family, scheme->gradient},
                   {"volume_element", &scheme_volume_element_family, scheme->volume_element},
                   {"viscosity", &scheme_viscosity_family, scheme->viscosity},
                   {"viscosity_form", &scheme_viscosity_form_family, scheme->viscosity_form},
                   {"balsara", &scheme_balsara_family, scheme->balsara},
                   {"steps", &scheme_time_steps_family, scheme->steps},
                   {"shifting", &scheme_shifting_family, scheme->shifting}};
    for (size_t k = 0; k < sizeof choices / sizeof *choices; k++)
        if (choices[k].member >= scheme_members(choices[k].family, dim))
            return error_set(error, STATUS_BAD_INPUT,
                             "%s=%s and dimension=%d exclude each other: it is for 2 and 3 "
                             "dimensions",
                             choices[k].key, choices[k].family->members[choices[k].member]->name,
                             dim);
    if (dim == 1 && scheme_conducts(scheme))
        return error_set(error, STATUS_BAD_INPUT,
                         "%s=%g and dimension=1 exclude each other: conductivity is for 2 and 3 "
                         "dimensions",
                         scheme->alpha_u > 0 ? "alpha_u" : "shock_conductivity",
                         scheme->alpha_u > 0 ? scheme->alpha_u : scheme->shock_conductivity);
    return STATUS_OK;
}

/* Reports a value that is not in (least, most]. */
static enum status out_of_range(struct error *error, const char *key, double value,
                                const char *allowed)
{
    return error_set(error, STATUS_BAD_INPUT, "%s = %g: %s must be %s", key, value, key, allowed);
}

enum status scheme_check(const struct scheme *scheme, int dim, struct error *error)
{
    const double least_eta = kernel_least_eta(&scheme->kernel, dim);
    const enum status members = check_members(scheme, dim, error);
    if (members) return members;
    if (!(scheme->eta > least_eta) || !isfinite(scheme->eta))
        return error_set(error, STATUS_BAD_INPUT,
                         "eta = %g: h = eta (m/rho)^(1/%d) has no root with the kernel %s unless "
                         "eta > %.6g",
                         scheme->eta, dim, scheme->kernel.member.name, least_eta);
    if (!(scheme->cfl > 0) || !isfinite(scheme->cfl))
        return out_of_range(error, "cfl", scheme->cfl, "positive and finite");
    if (!(scheme->h_tolerance >= 1e-15 && scheme->h_tolerance <= 1e-2))
        return out_of_range(error, "h_tolerance", scheme->h_tolerance, "in [1e-15, 1e-2]");
    if (!(scheme->alpha >= 0) || !isfinite(scheme->alpha))
        return out_of_range(error, "alpha", scheme->alpha, ">= 0 and finite");
    if (!(scheme->beta >= 0) || !isfinite(scheme->beta))
        return out_of_range(error, "beta", scheme->beta, ">= 0 and finite");
    const bool switched = viscosity_varies(scheme->viscosity);
    if (switched && !(scheme->alpha_min >= 0 && scheme->alpha_max >= scheme->alpha_min &&
                      isfinite(scheme->alpha_max)))
        return error_set(error, STATUS_BAD_INPUT,
                         "alpha_min = %g, alpha_max = %g: 0 <= alpha_min <= alpha_max is needed",
                         scheme->alpha_min, scheme->alpha_max);
    if (scheme->pair_width != PAIR_WIDTH_MEAN && scheme->formulation == FORMULATION_LAGRANGIAN)
        return error_set(error, STATUS_BAD_INPUT,
                         "pair_width=%s and formulation=lagrangian exclude each other: the "
                         "lagrangian form needs both particles' own gradients",
                         scheme_pair_width_family.members[scheme->pair_width]->name);
    const enum status steps = check_steps(scheme, error);
    return steps ? steps : check_shifting(scheme, error);
}
