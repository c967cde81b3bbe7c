/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares density, smoothing length, force, heating and time step of disordered clouds in 2D and
 * 3D with the oracle, for the choices that enter the sums: every geometry of a pair with one
 * physics, and every physics with one geometry, in turn; in 3D a part of them. The slow suite
 * combines every geometry with every physics in 2D, and takes all of these turns in 3D. */
#include "check.h"
#include "hydro_against.h"
#include "hydro_setup.h"

/* Particles per side: boxes of three to four kernel widths in 2D, hardly more than two in 3D. */
static size_t side_of(int dim)
{
    return dim == 2 ? 9 : 6;
}

/* A scheme in a dimension, or a mutant's change of the solver's setup with hydro_cloud_scheme() and
 * a geometry and physics of its own. */
struct cloud_subject {
    struct hydro_fault fault;
    int dim;
    struct scheme scheme;
};

static void add(struct check_run *run, int dim, struct scheme scheme)
{
    const struct cloud_subject subject = {{0}, dim, scheme};
    check_subject(run, &subject, sizeof subject);
}

/* Adds every step-th geometry for each kernel. The steps here and below are coprime to the sizes of
 * the families, so that every member is used. */
static void add_kernels(struct check_run *run, int dim, size_t step)
{
    for (size_t k = 0; k < kernel_family.n; k++)
        for (size_t g = 0; g < hydro_cloud_geometries(); g += step) {
            struct scheme s = hydro_cloud_scheme(dim);
            const double eta = s.eta;
            hydro_set_kernel(&s, kernel_family.members[k]->name);
            s.eta = eta;
            hydro_cloud_geometry(&s, g + k % 7);
            if (s.formulation == FORMULATION_LAGRANGIAN) s.pair_width = PAIR_WIDTH_MEAN;
            add(run, dim, s);
        }
}

/* Adds every step-th geometry and physics. */
static void add_turns(struct check_run *run, int dim, size_t step)
{
    const size_t geometries = hydro_cloud_geometries(), physics = hydro_cloud_physics();
    const size_t of_mean = geometries / PAIR_WIDTHS; /* geometries with the mean width come first */
    for (size_t g = 0; g < geometries; g += step) {
        struct scheme s = hydro_cloud_scheme(dim);
        hydro_cloud_geometry(&s, g);
        hydro_cloud_physic(&s, g % physics);
        add(run, dim, s);
    }
    for (size_t p = 0; of_mean > 0 && p < physics; p += step) {
        struct scheme s = hydro_cloud_scheme(dim);
        hydro_cloud_geometry(&s, p * 5 % of_mean);
        hydro_cloud_physic(&s, p);
        add(run, dim, s);
    }
}

static struct scheme shifting_scheme(int dim, enum shifting shifting, enum gradient gradient)
{
    struct scheme s = hydro_cloud_scheme(dim);
    s.shifting = shifting;
    s.gradient = gradient;
    s.formulation = FORMULATION_VANILLA_ICE;
    s.volume_element = VOLUME_NUMBER;
    s.energy = ENERGY_TOTAL;
    s.steps = STEPS_GLOBAL;
    s.integrator = hydro_integrator("predicted_midpoint");
    return s;
}

/* The oracle is four times slower in 3D. */
static void subjects(struct check_run *run)
{
    add(run, 2, shifting_scheme(2, SHIFTING_FLUXES, GRADIENT_CORRECTED));
    add(run, 2, shifting_scheme(2, SHIFTING_CLOSED, GRADIENT_BLENDED));
    add(run, 3, shifting_scheme(3, SHIFTING_CLOSED, GRADIENT_IA));
    add_turns(run, 2, 1);
    add_kernels(run, 2, 7);
    add_turns(run, 3, 13);
    add_kernels(run, 3, 37);
}

static void all_subjects(struct check_run *run)
{
    add_turns(run, 3, 1);
    add_kernels(run, 3, 7);
    for (size_t g = 0; g < hydro_cloud_geometries(); g++)
        for (size_t p = 0; p < hydro_cloud_physics(); p++) {
            struct scheme s = hydro_cloud_scheme(2);
            hydro_cloud_geometry(&s, g);
            hydro_cloud_physic(&s, p);
            add(run, 2, s);
        }
}

static struct cloud_subject of_mutant(const struct cloud_subject *mutant);

static void measure(struct check_run *run, const void *subject)
{
    const struct cloud_subject *given = subject;
    const struct cloud_subject s = given->fault.size ? of_mutant(given) : *given;
    static struct hydro_state cloud;
    hydro_cloud_sheared(&cloud, s.dim, side_of(s.dim));
    char where[HYDRO_TEXT];
    hydro_cloud_describe(&s.scheme, s.dim, where);
    hydro_against_rates(run, hydro_setup(&cloud, &s.scheme), &s.fault, where);
}

/* --- mutants ---------------------------------------------------------------------------------- */

#define TIMES(member, factor, d, ...)                                                              \
    (&(const struct cloud_subject){HYDRO_TIMES(member, factor), d, {__VA_ARGS__}})
#define SET(member, value, d, ...)                                                                 \
    (&(const struct cloud_subject){HYDRO_SET(member, value), d, {__VA_ARGS__}})
static const struct check_mutant mutants[] = {
    {"cloud_kernel_constant", "kernel's constant off by 1e-9",
     TIMES(scheme.kernel.constant[2], 1 + 1e-9, 2, .alpha_u = 0)},
    {"cloud_eta", "h too large by 1e-9", TIMES(scheme.eta, 1 + 1e-9, 3, .alpha_u = 0)},
    {"cloud_loose_h", "h solved to 1e-5 only", SET(scheme.h_tolerance, 1e-5, 2, .alpha_u = 0)},
    {"cloud_gradient", "corrected where ia is asked for",
     SET(scheme.gradient, GRADIENT_CORRECTED, 3, .gradient = GRADIENT_IA)},
    {"cloud_blended", "ia where blended is asked for",
     SET(scheme.gradient, GRADIENT_IA, 2, .gradient = GRADIENT_BLENDED)},
    {"cloud_formulation", "vanilla_ice where lagrangian is asked for",
     SET(scheme.formulation, FORMULATION_VANILLA_ICE, 3, .formulation = FORMULATION_LAGRANGIAN)},
    {"cloud_element", "mass element where number is asked for",
     SET(scheme.volume_element, VOLUME_MASS, 2, .volume_element = VOLUME_NUMBER)},
    {"cloud_form", "viscosity by mu where the signal form is asked for",
     SET(scheme.viscosity_form, VISCOSITY_FORM_MU, 2, .viscosity_form = VISCOSITY_FORM_SIGNAL)},
    {"cloud_balsara", "no Balsara factor",
     SET(scheme.balsara, BALSARA_OFF, 3, .balsara = BALSARA_ON)},
    {"cloud_balsara_floor", "Balsara factor without its floor",
     SET(scheme.balsara_floor, 0, 2, .balsara = BALSARA_ON)},
    {"cloud_noise", "projected: nu off by 1e-7",
     TIMES(scheme.noise, 1 - 1e-7, 3, .viscosity = VISCOSITY_PROJECTED)},
    {"cloud_projected", "reconstructed for projected",
     SET(scheme.viscosity, VISCOSITY_RECONSTRUCTED, 2, .viscosity = VISCOSITY_PROJECTED)},
    {"cloud_conductivity", "alpha_u off by 1e-9",
     TIMES(scheme.alpha_u, 1 - 1e-9, 2, .alpha_u = 0.71)},
    {"cloud_shock_conductivity", "shock_conductivity off by 1e-8",
     TIMES(scheme.shock_conductivity, 1 - 1e-8, 3, .shock_conductivity = 1.3)},
    {"cloud_beta_float", "beta off in the seventh digit",
     SET(scheme.beta, (double)2.17F, 3, .alpha_u = 0)},
    {0},
};

static struct cloud_subject of_mutant(const struct cloud_subject *mutant)
{
    struct cloud_subject s = {mutant->fault, mutant->dim, hydro_cloud_scheme(mutant->dim)};
    s.scheme.gradient = mutant->scheme.gradient;
    s.scheme.formulation = mutant->scheme.formulation;
    s.scheme.volume_element = mutant->scheme.volume_element;
    s.scheme.viscosity_form = mutant->scheme.viscosity_form;
    s.scheme.balsara = mutant->scheme.balsara;
    s.scheme.alpha_u = mutant->scheme.alpha_u;
    s.scheme.shock_conductivity = mutant->scheme.shock_conductivity;
    if (mutant->scheme.viscosity) s.scheme.viscosity = mutant->scheme.viscosity;
    return s;
}

#define PROPERTY "rho, h, P, dp/dt, de/dt, dalpha/dt, dt in 2D and 3D equal the oracle's"

CHECK_DEFINE(clouds, rates, 808, .cost = 3, .property = PROPERTY, .subjects = subjects,
             .measure = measure, .mutants = mutants);

CHECK_DEFINE(clouds, rates_all, 850, .cost = 33,
             .property = PROPERTY ", for every combination in 2D and every choice in 3D",
             .slow = true, .subjects = all_subjects, .measure = measure, .mutants = mutants);
