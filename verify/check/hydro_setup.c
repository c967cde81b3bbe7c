/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "hydro_setup.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdio.h>

#include "integrator.h"
#include "worst.h"

void hydro_disordered(struct hydro_state *state, size_t n)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(rng, 2385);
    *state = (struct hydro_state){.dim = 1, .n = n, .lo = {-0.7}, .hi = {1.63}, .gamma = 1.4};
    double at = 0, x[HYDRO_MAX];
    for (size_t i = 0; i < n; i++) {
        const double dense = i > n / 3 && i < n / 2 ? 8 : 1;
        const double spacing = (0.6 + 0.8 * gsl_rng_uniform(rng)) / dense;
        x[i] = at + 0.5 * spacing;
        at += spacing;
    }
    for (size_t i = 0; i < n; i++) {
        const size_t k =
            i * (n % 7 ? 7 : 11) % n; /* a permutation, so that particles are not sorted by x */
        state->x[0][i] = state->lo[0] + (state->hi[0] - state->lo[0]) * x[k] / at;
        state->v[0][i] = 0.8 * (gsl_rng_uniform(rng) - 0.45);
        state->m[i] = (0.7 + 0.6 * gsl_rng_uniform(rng)) / (double)n;
        state->u[i] = 0.4 + 2 * gsl_rng_uniform(rng);
    }
    gsl_rng_free(rng);
}

void hydro_contact(struct hydro_state *state, size_t n)
{
    enum { FIRST = 64, END = 128 };
    double at = 0, x[HYDRO_MAX];
    hydro_disordered(state, n);
    for (size_t i = 0; i < n; i++) {
        const double depth = i >= FIRST && i < END ? (double)(i - FIRST + 1) / (END - FIRST) : 0;
        const double spacing = pow(20, -depth) * (1 + 0.3 * sin(7. * (double)i));
        x[i] = at + 0.5 * spacing;
        at += spacing;
    }
    for (size_t i = 0; i < n; i++)
        state->x[0][i] = state->lo[0] + (state->hi[0] - state->lo[0]) * x[i] / at;
}

void hydro_expanding(struct hydro_state *state, size_t n)
{
    hydro_disordered(state, n);
    const double middle = 0.5 * (state->lo[0] + state->hi[0]);
    for (size_t i = 0; i < n; i++) {
        state->v[0][i] = 0.9 * (state->x[0][i] - middle);
        if (fabs(state->x[0][i] - middle) > 0.4 * (state->hi[0] - state->lo[0]))
            state->u[i] *= 0.01;
    }
}

void hydro_coincident(struct hydro_state *state, size_t n)
{
    hydro_disordered(state, n);
    state->x[0][1] = state->x[0][0];
}

void hydro_wave(struct hydro_state *state, size_t n)
{
    *state = (struct hydro_state){.dim = 1, .n = n, .lo = {0}, .hi = {1}, .gamma = 1.4};
    for (size_t i = 0; i < n; i++) {
        const double phase = 2 * M_PI * ((double)i + 0.5) / (double)n;
        state->x[0][i] = ((double)i + 0.5) / (double)n - 0.1 / (2 * M_PI) * cos(phase);
        state->v[0][i] = 0.1 * sin(phase) + 0.05;
        state->m[i] = 1 / (double)n;
        state->u[i] = 2.5 * (1 + 0.1 * cos(phase));
    }
}

void hydro_tube(struct hydro_state *state, size_t n)
{
    *state = (struct hydro_state){.dim = 1, .n = n, .lo = {-1}, .hi = {1}, .gamma = 1.4};
    const size_t left = 8 * n / 9;
    for (size_t i = 0; i < n; i++) {
        const double part = (double)(i < left ? i : i - left) + 0.5;
        const double count = (double)(i < left ? left : n - left);
        state->x[0][i] = i < left ? part / count - 1 : part / count;
        state->m[i] = (i < left ? 1 : 0.125) / count;
        state->u[i] = (i < left ? 1 : 0.8) / 0.4;
    }
}

static const double low[3] = {-0.37, 1.213, 0.61}, high[3] = {0.681, 2.109, 1.572};

/* side^dim particles on a lattice whose spacing varies by a factor of 5/3 and whose points are
 * displaced at random; unequal masses, random velocities and energies, in random order; the sides
 * of the box differ, and none begins at 0. */
static void disordered(struct hydro_state *state, int dim, size_t side)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    size_t n = 1, order[HYDRO_MAX];
    for (int a = 0; a < dim; a++) n *= side;
    gsl_rng_set(rng, 2385 + (unsigned)dim);
    *state = (struct hydro_state){.dim = dim, .n = n, .gamma = 1.413};
    for (size_t i = 0; i < n; i++) order[i] = i;
    gsl_ran_shuffle(rng, order, n, sizeof *order);
    for (size_t i = 0; i < n; i++) {
        size_t at = order[i];
        for (int a = 0; a < dim; a++, at /= side) {
            const double s =
                ((double)(at % side) + 0.5 + 0.6 * (gsl_rng_uniform(rng) - 0.5)) / (double)side;
            /* spacing proportional to 1 + cos(2 pi s)/4: from 3/4 to 5/4 */
            const double t = s + sin(2 * M_PI * s) / (8 * M_PI);
            state->x[a][i] = low[a] + (high[a] - low[a]) * t;
            state->v[a][i] = 0.9 * (gsl_rng_uniform(rng) - 0.45);
        }
        state->m[i] = (0.7 + 0.6 * gsl_rng_uniform(rng)) / (double)n;
        state->u[i] = 0.4 + 2 * gsl_rng_uniform(rng);
    }
    for (int a = 0; a < dim; a++) state->lo[a] = low[a], state->hi[a] = high[a];
    gsl_rng_free(rng);
}

void hydro_cloud_sheared(struct hydro_state *state, int dim, size_t side)
{
    disordered(state, dim, side);
    for (size_t i = 0; i < state->n; i++) {
        const double s = 2 * M_PI * (state->x[1][i] - low[1]) / (high[1] - low[1]),
                     t = 2 * M_PI * (state->x[0][i] - low[0]) / (high[0] - low[0]);
        state->v[0][i] = 0.7 * sin(s) - 0.3 * sin(t) + 0.05 * state->v[0][i];
        state->v[1][i] = 0.11 * sin(s) + 0.05 * state->v[1][i];
    }
}

struct setup hydro_setup(const struct hydro_state *state, const struct scheme *scheme)
{
    struct setup setup = {.dim = state->dim,
                          .gamma = state->gamma,
                          .n = state->n,
                          .m = state->m,
                          .u = state->u,
                          .scheme = *scheme,
                          .threads = 1};
    for (int a = 0; a < state->dim; a++) {
        setup.lo[a] = state->lo[a];
        setup.hi[a] = state->hi[a];
        setup.x[a] = state->x[a];
        setup.v[a] = state->v[a];
    }
    return setup;
}

const struct integrator *hydro_integrator(const char *name)
{
    return (const struct integrator *)family_find(&integrator_family, name);
}

void hydro_set_kernel(struct scheme *scheme, const char *name)
{
    kernel_select(&scheme->kernel, name, 5, NULL);
    scheme->eta = scheme->kernel.default_eta;
}

size_t hydro_combinations(void)
{
    return scheme_members(&scheme_gradient_family, 1) * scheme_formulation_family.n *
           scheme_members(&scheme_volume_element_family, 1) * scheme_energy_family.n *
           scheme_members(&scheme_viscosity_family, 1);
}

/* Removes the last digit of *c in base n and returns it. */
static int digit(size_t *c, size_t n)
{
    const size_t last = *c % n;
    *c /= n;
    return (int)last;
}

void hydro_combine(struct scheme *scheme, size_t c)
{
    scheme->gradient = (enum gradient)digit(&c, scheme_members(&scheme_gradient_family, 1));
    scheme->formulation =
        (enum formulation)digit(&c, scheme_members(&scheme_formulation_family, 1));
    scheme->volume_element =
        (enum volume_element)digit(&c, scheme_members(&scheme_volume_element_family, 1));
    scheme->energy = (enum energy)digit(&c, scheme_members(&scheme_energy_family, 1));
    scheme->viscosity = (enum viscosity)digit(&c, scheme_members(&scheme_viscosity_family, 1));
}

struct scheme hydro_scheme(void)
{
    struct scheme scheme = {.viscosity = VISCOSITY_CONSTANT,
                            .integrator = hydro_integrator("modified_leapfrog"),
                            .alpha = 1,
                            .beta = 2,
                            .alpha_min = 0.1,
                            .alpha_max = 1.5,
                            .cfl = 0.3,
                            .h_tolerance = 1e-14};
    hydro_set_kernel(&scheme, "cubic_spline");
    return scheme;
}

void hydro_describe(const struct scheme *s, char text[HYDRO_TEXT])
{
    snprintf(text, HYDRO_TEXT, "%s eta %g %s %s %s viscosity %s energy %s width %s h %s %s",
             s->kernel.member.name, s->eta, scheme_gradient_family.members[s->gradient]->name,
             scheme_formulation_family.members[s->formulation]->name,
             scheme_volume_element_family.members[s->volume_element]->name,
             scheme_viscosity_family.members[s->viscosity]->name,
             scheme_energy_family.members[s->energy]->name,
             scheme_pair_width_family.members[s->pair_width]->name,
             scheme_h_method_family.members[s->h_method]->name, s->integrator->member.name);
}

/* ---- schemes in 2D and 3D ---- */

struct scheme hydro_cloud_scheme(int dim)
{
    struct scheme scheme = {.viscosity = VISCOSITY_CONSTANT,
                            .integrator = hydro_integrator("modified_leapfrog"),
                            .alpha = 0.93,
                            .beta = 2.17,
                            .alpha_min = 0.13,
                            .alpha_max = 1.57,
                            .balsara_floor = 0.031,
                            .noise = 0.43,
                            .cfl = 0.27,
                            .h_tolerance = 1e-15};
    hydro_set_kernel(&scheme, "cubic_spline");
    scheme.eta = dim == 2 ? 2.385 : 2.0613;
    return scheme;
}

size_t hydro_cloud_geometries(void)
{
    return GRADIENTS * FORMULATIONS * VOLUME_ELEMENTS * PAIR_WIDTHS;
}

void hydro_cloud_geometry(struct scheme *scheme, size_t c)
{
    scheme->gradient = (enum gradient)digit(&c, GRADIENTS);
    scheme->formulation = (enum formulation)digit(&c, FORMULATIONS);
    scheme->volume_element = (enum volume_element)digit(&c, VOLUME_ELEMENTS);
    scheme->pair_width = (enum pair_width)digit(&c, PAIR_WIDTHS);
}

size_t hydro_cloud_physics(void)
{
    return VISCOSITIES * VISCOSITY_FORMS * BALSARAS * ENERGIES * 2;
}

void hydro_cloud_physic(struct scheme *scheme, size_t c)
{
    scheme->viscosity = (enum viscosity)digit(&c, VISCOSITIES);
    scheme->viscosity_form = (enum viscosity_form)digit(&c, VISCOSITY_FORMS);
    scheme->balsara = (enum balsara)digit(&c, BALSARAS);
    scheme->energy = (enum energy)digit(&c, ENERGIES);
    const bool shocks = digit(&c, 2);
    scheme->alpha_u = shocks ? 0 : 0.71;
    scheme->shock_conductivity = shocks ? 1.3 : 0;
}

void hydro_cloud_describe(const struct scheme *s, int dim, char text[HYDRO_TEXT])
{
    snprintf(text, HYDRO_TEXT,
             "%dD %s eta %g %s %s %s width %s viscosity %s %s balsara %s energy %s alpha_u %g "
             "shock_conductivity %g h %s %s",
             dim, s->kernel.member.name, s->eta, scheme_gradient_family.members[s->gradient]->name,
             scheme_formulation_family.members[s->formulation]->name,
             scheme_volume_element_family.members[s->volume_element]->name,
             scheme_pair_width_family.members[s->pair_width]->name,
             scheme_viscosity_family.members[s->viscosity]->name,
             scheme_viscosity_form_family.members[s->viscosity_form]->name,
             scheme_balsara_family.members[s->balsara]->name,
             scheme_energy_family.members[s->energy]->name, s->alpha_u, s->shock_conductivity,
             scheme_h_method_family.members[s->h_method]->name, s->integrator->member.name);
}

double hydro_difference(size_t n, const double *a, const double *b)
{
    double worst = 0, scale = 0;
    for (size_t i = 0; i < n; i++) {
        worst_keep(&worst, fabs(a[i] - b[i]));
        scale = fmax(scale, fabs(a[i]));
    }
    return worst == 0 ? 0 : worst / scale;
}
