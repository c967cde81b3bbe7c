/* SPDX-License-Identifier: GPL-3.0-or-later
 * Extreme particle distributions in 2D and 3D against the oracle: two coincident particles, one far
 * from all others, all in one cell of the box, most of them in a plane, a density contrast of 1e6,
 * positions at 1e8 box lengths; their rates, and a step. Each particle is judged by its own scales,
 * so thin gas beside dense gas counts, too. (test_cells_workspace tests what is refused, such as
 * widths beyond half of the box.) */
#include <math.h>
#include <stdio.h>

#include "check.h"
#include "hydro_setup.h"
#include "integrator.h"
#include "oracle.h"
#include "worst.h"

typedef void place(struct hydro_state *cloud);

struct hostile_subject {
    void (*spoil)(struct setup *setup);
    place *place;
    const char *name;
    enum boundary boundary;
    double grain; /* resolution of positions, in box lengths */
    int dim, scheme;
};

/* --- positions -------------------------------------------------------------------------------- */

static void in_one_place(struct hydro_state *cloud)
{
    for (int a = 0; a < cloud->dim; a++) cloud->x[a][5] = cloud->x[a][2];
    cloud->m[5] = cloud->m[2]; /* with unequal masses the lighter one may have no h */
}

/* Moves the particles from `first` on towards the middle of the box. */
static void press(struct hydro_state *cloud, size_t first, double factor)
{
    for (int a = 0; a < cloud->dim; a++) {
        const double middle = 0.5 * (cloud->lo[a] + cloud->hi[a]);
        for (size_t i = first; i < cloud->n; i++)
            cloud->x[a][i] = middle + factor * (cloud->x[a][i] - middle);
    }
}

static void in_one_cell(struct hydro_state *cloud)
{
    press(cloud, 0, 1e-3);
}

static void one_alone(struct hydro_state *cloud)
{
    press(cloud, 0, 1e-3);
    cloud->x[0][3] +=
        0.1; /* the oracle's box is periodic and must be larger than twice the reach */
}

static void contrast(struct hydro_state *cloud)
{
    const size_t first = 3 * cloud->n / 4;
    press(cloud, first, pow(1e-6, 1. / cloud->dim));
    for (size_t i = first; i < cloud->n; i++) cloud->u[i] *= 1e-6; /* avoids an explosion */
}

static void in_a_plane(struct hydro_state *cloud)
{
    const double length = cloud->hi[0] - cloud->lo[0];
    for (size_t i = 0; i < cloud->n; i++) {
        const double s = (cloud->x[0][i] - cloud->lo[0]) / length;
        if (s > 0.3) cloud->x[0][i] = cloud->lo[0] + length * (0.6 + 1e-4 * (s - 0.6));
    }
}

static void far_off(struct hydro_state *cloud)
{
    for (int a = 0; a < cloud->dim; a++) {
        cloud->lo[a] += 1e8, cloud->hi[a] += 1e8;
        for (size_t i = 0; i < cloud->n; i++)
            cloud->x[a][i] = fmin(fmax(cloud->x[a][i] + 1e8, cloud->lo[a]), cloud->hi[a]);
    }
}

/* --- subjects --------------------------------------------------------------------------------- */

static struct scheme scheme_of(int dim, int c)
{
    struct scheme s = hydro_cloud_scheme(dim);
    s.cfl = 0.2;
    if (c == 0) { /* forces along r_ij, each particle with its own width */
        s.formulation = FORMULATION_LAGRANGIAN;
        s.viscosity = VISCOSITY_TIME_DEPENDENT;
        return s;
    }
    s.gradient = c == 1 ? GRADIENT_IA : GRADIENT_CORRECTED;
    s.volume_element = c == 1 ? VOLUME_NUMBER : VOLUME_MASS;
    s.integrator = hydro_integrator("predicted_midpoint");
    s.cfl = 0.15;
    s.energy = ENERGY_TOTAL;
    s.balsara = BALSARA_ON;
    return s;
}

static const struct hostile_subject all[] = {
    {NULL, in_one_place, "two in one place", BOUNDARY_PERIODIC, 1e-16, 0, 0},
    {NULL, contrast, "contrast of 1e6", BOUNDARY_PERIODIC, 1e-16, 0, 1},
    {NULL, in_a_plane, "in a plane", BOUNDARY_PERIODIC, 1e-16, 0, 1},
    {NULL, one_alone, "one alone", BOUNDARY_OPEN, 1e-16, 0, 2},
    {NULL, in_one_cell, "all in one cell", BOUNDARY_PERIODIC, 1e-16, 0, 0},
    {NULL, in_one_cell, "all in one cell", BOUNDARY_OPEN, 1e-16, 0, 2},
    {NULL, far_off, "at 1e8", BOUNDARY_PERIODIC, 3e-8, 0, 1},
};
enum { PLACES = sizeof all / sizeof *all, SCHEMES = 3 };

static void add(struct check_run *run, size_t k, int dim, int more)
{
    struct hostile_subject s = all[k];
    s.dim = dim;
    s.scheme = (s.scheme + more) % SCHEMES;
    check_subject(run, &s, sizeof s);
}

/* In 3D, where the oracle is slow, only the first ones. */
static void subjects(struct check_run *run)
{
    for (size_t k = 0; k < PLACES; k++) add(run, k, 2, 0);
    for (size_t k = 0; k < 2; k++) add(run, k, 3, 0);
}

static void all_subjects(struct check_run *run)
{
    for (int dim = 2; dim <= 3; dim++)
        for (size_t k = 0; k < PLACES; k++)
            for (int more = 0; more < SCHEMES; more++) add(run, k, dim, more);
}

/* --- judging ---------------------------------------------------------------------------------- */

struct scales {
    double h, force, power;
};

/* Scales of a particle: the contribution of one equal neighbour. */
static struct scales scales_of(const struct oracle *oracle, const struct oracle_particle *p)
{
    const double F = (double)(p->P * p->V / p->h);
    double worst = 0;
    for (int a = 0; a < oracle->dim; a++) worst = fmax(worst, (double)fabsl(p->F[a]));
    return (struct scales){(double)p->h, F + worst,
                           (double)(F * p->c + fabsl(p->de) + worst * fabsl(p->v[0]))};
}

static void judge_rates(struct check_run *run, const struct simulation *simulation,
                        const struct oracle *oracle, const char *where)
{
    struct snapshot got;
    struct rates rates;
    double h = 0, rho = 0, F = 0, de = 0;
    simulation_snapshot(simulation, &got);
    simulation_rates(simulation, &rates);
    for (size_t i = 0; i < got.n; i++) {
        const struct oracle_particle *want = &oracle->particles[got.id[i]];
        const struct scales scales = scales_of(oracle, want);
        worst_keep(&h, (double)fabsl(got.h[i] / want->h - 1));
        worst_keep(&rho, (double)fabsl(got.rho[i] / want->rho - 1));
        for (int a = 0; a < oracle->dim; a++)
            worst_keep(&F, (double)fabsl(rates.force[a][i] - want->F[a]) / scales.force);
        worst_keep(&de, (double)fabsl(rates.energy[i] - want->de) / scales.power);
    }
    if (got.n != oracle->n) h = (double)NAN;
    check_measure(run, h, 1e-12, 2e-14, "smoothing length, %s", where);
    check_measure(run, rho, 1e-12, 2e-14, "density, %s", where);
    check_measure(run, F, 1e-10, 2e-12, "force, %s", where);
    check_measure(run, de, 1e-10, 2e-12, "rate of energy, %s", where);
}

static void judge_run(struct check_run *run, const struct simulation *simulation,
                      const struct oracle *oracle, double grain, const char *where)
{
    struct snapshot got;
    double x = 0, v = 0, u = 0;
    const long double kinetic = oracle->scheme.energy == ENERGY_TOTAL ? 0.5L : 0;
    simulation_snapshot(simulation, &got);
    for (size_t i = 0; i < got.n; i++) {
        const struct oracle_particle *want = &oracle->particles[got.id[i]];
        long double p2 = 0;
        for (int a = 0; a < oracle->dim; a++) {
            const long double away = got.x[a][i] - want->x[a], period = oracle->period[a];
            worst_keep(&x, (double)(fabsl(away - period * roundl(away / period)) / want->h));
            worst_keep(&v, (double)(fabsl(got.v[a][i] - want->p[a] / want->m) / want->c));
            p2 += want->p[a] * want->p[a];
        }
        const long double energy = (want->e - kinetic * p2 / want->m) / want->m;
        worst_keep(&u, (double)fabsl(got.u[i] / energy - 1));
    }
    if (got.n != oracle->n) x = (double)NAN;
    const double bound = 1e-9 + 1e3 * grain, floor = 2e-11 + 20 * grain;
    check_measure(run, x, bound, floor, "position, %s", where);
    check_measure(run, v, bound, floor, "velocity, %s", where);
    check_measure(run, u, bound, floor, "internal energy, %s", where);
}

static void measure(struct check_run *run, const void *subject)
{
    static struct hydro_state cloud;
    struct hostile_subject s = *(const struct hostile_subject *)subject;
    struct oracle oracle;
    struct simulation *simulation = NULL;
    struct error error = {0};
    char where[HYDRO_TEXT + 60], scheme_text[HYDRO_TEXT];
    const struct scheme scheme = scheme_of(s.dim, s.scheme);
    hydro_cloud_sheared(&cloud, s.dim, s.dim == 2 ? 8 : 6);
    s.place(&cloud);
    struct setup setup = hydro_setup(&cloud, &scheme);
    for (int a = 0; a < s.dim; a++) setup.boundary[a] = s.boundary;
    hydro_cloud_describe(&scheme, s.dim, scheme_text);
    snprintf(where, sizeof where, "%s, %s", s.name, scheme_text);
    enum status status = oracle_create(&oracle, &setup, &error);
    if (!status) {
        status = oracle_evaluate(&oracle, &error);
        const double t_end = (double)oracle_time_step(&oracle) * 0.5;
        if (s.spoil) s.spoil(&setup);
        if (!status) status = simulation_create(&setup, &simulation, &error);
        if (!status) judge_rates(run, simulation, &oracle, where);
        if (!status) status = oracle_run(&oracle, t_end, &error);
        if (!status) status = simulation_run(simulation, t_end, NULL, NULL, &error);
        if (!status) judge_run(run, simulation, &oracle, s.grain, where);
        simulation_destroy(simulation);
        oracle_free(&oracle);
    }
    if (status) check_measure(run, 1, 0, 0, "%s: %s", where, error.message);
}

static void wider(struct setup *setup)
{
    setup->scheme.eta *= 1 + 1e-9;
}

static void warmer(struct setup *setup)
{
    ((double *)setup->u)[0] *= 1 + 1e-8;
}

/* Mutant: rounds positions to single precision. */
static void coarse(struct setup *setup)
{
    double *x = (double *)setup->x[0];
    x[0] = (double)(float)x[0];
}

#define SPOIL(how, where)                                                                          \
    (&(const struct hostile_subject){how, where, "", BOUNDARY_PERIODIC, 1e-16, 2, 1})
static const struct check_mutant mutants[] = {
    {"hostile_eta", "eta too large by 1e-9, density contrast", SPOIL(wider, contrast)},
    {"hostile_energy", "a particle warmer by 1e-8, all in one cell", SPOIL(warmer, in_one_cell)},
    {"hostile_coarse", "one position in single precision, at 1e8", SPOIL(coarse, far_off)},
    {0},
};

#define PROPERTY "rates and a step of hostile clouds equal the oracle's, particle by particle"

CHECK_DEFINE(clouds, hostile, 850, .cost = 0.6, .property = PROPERTY, .subjects = subjects,
             .measure = measure, .mutants = mutants);

CHECK_DEFINE(clouds, hostile_all, 850, .cost = 4, .property = PROPERTY ", for more schemes",
             .slow = true, .subjects = all_subjects, .measure = measure, .mutants = mutants);
