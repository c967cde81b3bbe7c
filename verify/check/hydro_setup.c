/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "hydro_setup.h"

#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdio.h>

#include "integrator.h"

void hydro_disordered(struct hydro_state *state, size_t n)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(rng, 2385);
    *state = (struct hydro_state){.n = n, .lo = -0.7, .hi = 1.63, .gamma = 1.4};
    double at = 0, x[HYDRO_MAX];
    for (size_t i = 0; i < n; i++) {
        const double dense = i > n / 3 && i < n / 2 ? 8 : 1;
        const double spacing = (0.6 + 0.8 * gsl_rng_uniform(rng)) / dense;
        x[i] = at + 0.5 * spacing;
        at += spacing;
    }
    for (size_t i = 0; i < n; i++) {
        const size_t k = i * (n % 7 ? 7 : 11) % n; /* a permutation: not in the order of x */
        state->x[i] = state->lo + (state->hi - state->lo) * x[k] / at;
        state->v[i] = 0.8 * (gsl_rng_uniform(rng) - 0.45);
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
    for (size_t i = 0; i < n; i++) state->x[i] = state->lo + (state->hi - state->lo) * x[i] / at;
}

void hydro_expanding(struct hydro_state *state, size_t n)
{
    hydro_disordered(state, n);
    const double middle = 0.5 * (state->lo + state->hi);
    for (size_t i = 0; i < n; i++) {
        state->v[i] = 0.9 * (state->x[i] - middle);
        if (fabs(state->x[i] - middle) > 0.4 * (state->hi - state->lo)) state->u[i] *= 0.01;
    }
}

void hydro_coincident(struct hydro_state *state, size_t n)
{
    hydro_disordered(state, n);
    state->x[1] = state->x[0];
}

void hydro_wave(struct hydro_state *state, size_t n)
{
    *state = (struct hydro_state){.n = n, .lo = 0, .hi = 1, .gamma = 1.4};
    for (size_t i = 0; i < n; i++) {
        const double phase = 2 * M_PI * ((double)i + 0.5) / (double)n;
        state->x[i] = ((double)i + 0.5) / (double)n - 0.1 / (2 * M_PI) * cos(phase);
        state->v[i] = 0.1 * sin(phase) + 0.05;
        state->m[i] = 1 / (double)n;
        state->u[i] = 2.5 * (1 + 0.1 * cos(phase));
    }
}

void hydro_tube(struct hydro_state *state, size_t n)
{
    *state = (struct hydro_state){.n = n, .lo = -1, .hi = 1, .gamma = 1.4};
    const size_t left = 8 * n / 9;
    for (size_t i = 0; i < n; i++) {
        const double part = (double)(i < left ? i : i - left) + 0.5;
        const double count = (double)(i < left ? left : n - left);
        state->x[i] = i < left ? part / count - 1 : part / count;
        state->m[i] = (i < left ? 1 : 0.125) / count;
        state->u[i] = (i < left ? 1 : 0.8) / 0.4;
    }
}

struct setup hydro_setup(const struct hydro_state *state, const struct scheme *scheme)
{
    return (struct setup){.dim = 1,
                          .lo = {state->lo},
                          .hi = {state->hi},
                          .gamma = state->gamma,
                          .n = state->n,
                          .x = {state->x},
                          .v = {state->v},
                          .m = state->m,
                          .u = state->u,
                          .scheme = *scheme,
                          .threads = 1};
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

/* The last digit of *c in the base of a family in 1D, which is taken off. */
static int choice(size_t *c, const struct family *family)
{
    const size_t digit = *c % scheme_members(family, 1);
    *c /= scheme_members(family, 1);
    return (int)digit;
}

void hydro_combine(struct scheme *scheme, size_t c)
{
    scheme->gradient = (enum gradient)choice(&c, &scheme_gradient_family);
    scheme->formulation = (enum formulation)choice(&c, &scheme_formulation_family);
    scheme->volume_element = (enum volume_element)choice(&c, &scheme_volume_element_family);
    scheme->energy = (enum energy)choice(&c, &scheme_energy_family);
    scheme->viscosity = (enum viscosity)choice(&c, &scheme_viscosity_family);
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
