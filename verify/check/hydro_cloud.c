/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "hydro_cloud.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdio.h>

#include "hydro_setup.h"
#include "integrator.h"

static const double low[3] = {-0.37, 1.213, 0.61}, high[3] = {0.681, 2.109, 1.572};

void hydro_cloud_disordered(struct hydro_cloud *cloud, int dim, size_t side)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    size_t n = 1, order[CLOUD_MAX];
    for (int a = 0; a < dim; a++) n *= side;
    gsl_rng_set(rng, 2385 + (unsigned)dim);
    *cloud = (struct hydro_cloud){.dim = dim, .n = n, .gamma = 1.413};
    for (size_t i = 0; i < n; i++) order[i] = i;
    gsl_ran_shuffle(rng, order, n, sizeof *order);
    for (size_t i = 0; i < n; i++) {
        size_t at = order[i];
        for (int a = 0; a < dim; a++, at /= side) {
            const double s =
                ((double)(at % side) + 0.5 + 0.6 * (gsl_rng_uniform(rng) - 0.5)) / (double)side;
            /* spacing proportional to 1 + cos(2 pi s)/4: from 3/4 to 5/4 */
            const double t = s + sin(2 * M_PI * s) / (8 * M_PI);
            cloud->x[a][i] = low[a] + (high[a] - low[a]) * t;
            cloud->v[a][i] = 0.9 * (gsl_rng_uniform(rng) - 0.45);
        }
        cloud->m[i] = (0.7 + 0.6 * gsl_rng_uniform(rng)) / (double)n;
        cloud->u[i] = 0.4 + 2 * gsl_rng_uniform(rng);
    }
    for (int a = 0; a < dim; a++) cloud->lo[a] = low[a], cloud->hi[a] = high[a];
    gsl_rng_free(rng);
}

void hydro_cloud_sheared(struct hydro_cloud *cloud, int dim, size_t side)
{
    hydro_cloud_disordered(cloud, dim, side);
    for (size_t i = 0; i < cloud->n; i++) {
        const double s = 2 * M_PI * (cloud->x[1][i] - low[1]) / (high[1] - low[1]),
                     t = 2 * M_PI * (cloud->x[0][i] - low[0]) / (high[0] - low[0]);
        cloud->v[0][i] = 0.7 * sin(s) - 0.3 * sin(t) + 0.05 * cloud->v[0][i];
        cloud->v[1][i] = 0.11 * sin(s) + 0.05 * cloud->v[1][i];
    }
}

struct setup hydro_cloud_setup(const struct hydro_cloud *cloud, const struct scheme *scheme)
{
    struct setup setup = {.dim = cloud->dim,
                          .gamma = cloud->gamma,
                          .n = cloud->n,
                          .m = cloud->m,
                          .u = cloud->u,
                          .scheme = *scheme,
                          .threads = 1};
    for (int a = 0; a < cloud->dim; a++) {
        setup.lo[a] = cloud->lo[a];
        setup.hi[a] = cloud->hi[a];
        setup.x[a] = cloud->x[a];
        setup.v[a] = cloud->v[a];
    }
    return setup;
}

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

/* The last digit of *c in the base n, which is taken off. */
static int digit(size_t *c, size_t n)
{
    const size_t last = *c % n;
    *c /= n;
    return (int)last;
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

void hydro_cloud_describe(const struct scheme *s, int dim, char text[CLOUD_TEXT])
{
    snprintf(text, CLOUD_TEXT,
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
