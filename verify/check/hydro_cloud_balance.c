/* SPDX-License-Identifier: GPL-3.0-or-later
 * Conservation by one evaluation in 2D and 3D, for every choice of a scheme: momentum and energy
 * always, angular momentum if forces are along r_ij; also with planes of particles, whose matrices
 * cannot be used. And the specialised loops give the same results as generic ones. */
#include <math.h>

#include "check.h"
#include "description.h"
#include "hydro_setup.h"
#include "worst.h"

/* A state and its scheme; a mutant's change of the solver's results (see corrupt). */
enum corruption { NONE, ONE_FORCE, ONE_HEAT, TURNED, OTHER_KERNEL };

struct balance_subject {
    enum corruption corruption;
    void (*state)(struct hydro_state *cloud, int dim, size_t side);
    int dim;
    enum boundary boundary;
    struct scheme scheme;
};

/* More than half of the particles in a plane without neighbours outside it. */
static void planes(struct hydro_state *cloud, int dim, size_t side)
{
    hydro_cloud_sheared(cloud, dim, side);
    for (size_t i = 0; i < cloud->n; i++) {
        const double length = cloud->hi[0] - cloud->lo[0],
                     s = (cloud->x[0][i] - cloud->lo[0]) / length;
        if (s > 0.2) cloud->x[0][i] = cloud->lo[0] + length * (0.6 + 1e-4 * (s - 0.6));
    }
}

static void add(struct check_run *run, struct balance_subject subject)
{
    struct error error;
    if (!scheme_check(&subject.scheme, subject.dim, &error))
        check_subject(run, &subject, sizeof subject);
}

static void subjects(struct check_run *run)
{
    const size_t geometries = hydro_cloud_geometries(), physics = hydro_cloud_physics();
    for (int dim = 2; dim <= 3; dim++)
        for (size_t g = 0; g < geometries; g++)
            for (size_t p = g % 5; p < physics; p += dim == 2 ? 5 : 37) {
                struct balance_subject s = {NONE, hydro_cloud_sheared, dim, BOUNDARY_PERIODIC,
                                            hydro_cloud_scheme(dim)};
                hydro_cloud_geometry(&s.scheme, g);
                hydro_cloud_physic(&s.scheme, p);
                add(run, s);
                if (p % 3) continue;
                s.state = planes;
                if (dim == 2) add(run, s); /* in 3D h exceeds half of the box */
                s.boundary = BOUNDARY_OPEN;
                add(run, s);
            }
}

struct balance {
    double force[3], size, torque[3], torque_size, power, power_size;
};

static void corrupt(enum corruption corruption, size_t i, double F[3], double *dE)
{
    if (i == 1 && corruption == ONE_FORCE) F[0] *= 1 + 1e-10;
    if (i == 1 && corruption == ONE_HEAT) *dE *= 1 + 1e-8;
    if (corruption == TURNED) F[1] += 1e-10 * F[0];
}

static void add_particle(struct balance *b, const double x[3], const double F[3], double dE,
                         double parts)
{
    double size = 0, r = 0;
    for (int a = 0; a < 3; a++) {
        b->force[a] += F[a];
        size = hypot(size, F[a]);
        r = hypot(r, x[a]);
        b->torque[a] += x[(a + 1) % 3] * F[(a + 2) % 3] - x[(a + 2) % 3] * F[(a + 1) % 3];
    }
    b->size += size;
    b->torque_size += r * size;
    b->power += dE;
    b->power_size += parts;
}

static struct balance sum_up(const struct simulation *simulation,
                             const struct balance_subject *subject)
{
    const bool total = subject->scheme.energy == ENERGY_TOTAL;
    struct balance b = {0};
    struct snapshot s;
    struct rates rates;
    simulation_snapshot(simulation, &s);
    simulation_rates(simulation, &rates);
    for (size_t i = 0; i < s.n; i++) {
        double x[3] = {0}, F[3] = {0}, work = 0, dE = rates.energy[i];
        for (int a = 0; a < subject->dim; a++) {
            x[a] = s.x[a][i];
            F[a] = rates.force[a][i];
            work += s.v[a][i] * F[a];
        }
        corrupt(subject->corruption, i, F, &dE);
        if (!total) dE += work;
        add_particle(&b, x, F, dE, fabs(work) + fabs(dE - work));
    }
    return b;
}

static double length(const double v[3])
{
    return hypot(hypot(v[0], v[1]), v[2]);
}

static void judge(struct check_run *run, const struct simulation *simulation,
                  const struct balance_subject *subject, const char *where)
{
    const struct balance b = sum_up(simulation, subject);
    check_measure(run, length(b.force) / b.size, 1e-13, 2e-15, "momentum, %s", where);
    check_measure(run, fabs(b.power) / b.power_size, 1e-13, 2e-15, "energy, %s", where);
    if (subject->boundary != BOUNDARY_OPEN || subject->scheme.gradient != GRADIENT_STANDARD) return;
    check_measure(run, length(b.torque) / b.torque_size, 1e-13, 2e-15, "angular momentum, %s",
                  where);
}

static void count_one(void *context, size_t particle, const struct description *of)
{
    (void)particle;
    if (of->condition > 1000) ++*(double *)context;
}

/* Number of matrices that cannot be used. */
static double count_ill(const struct simulation *simulation)
{
    double count = 0;
    description_each(simulation, count_one, &count);
    return count;
}

static struct balance_subject of_mutant(const struct balance_subject *mutant)
{
    return (struct balance_subject){mutant->corruption, hydro_cloud_sheared, 2, BOUNDARY_OPEN,
                                    hydro_cloud_scheme(2)};
}

static void measure(struct check_run *run, const void *subject)
{
    const struct balance_subject *given = subject;
    const struct balance_subject s = given->corruption ? of_mutant(given) : *given;
    static struct hydro_state cloud;
    struct simulation *simulation;
    struct error error = {0};
    char where[HYDRO_TEXT];
    s.state(&cloud, s.dim, s.dim == 2 ? 9 : 6);
    struct setup setup = hydro_setup(&cloud, &s.scheme);
    for (int a = 0; a < s.dim; a++) setup.boundary[a] = s.boundary;
    hydro_cloud_describe(&s.scheme, s.dim, where);
    if (simulation_create(&setup, &simulation, &error)) {
        check_measure(run, 1, 0, 0, "%s: %s", where, error.message);
        return;
    }
    judge(run, simulation, &s, where);
    if (s.state == planes && s.scheme.gradient != GRADIENT_STANDARD) {
        struct simulation_cost cost;
        const double ill = count_ill(simulation);
        simulation_cost(simulation, &cost);
        check_measure(run, !(ill > 0), 0, 0, "some matrices cannot be used, %s", where);
        check_measure(run, fabs((double)cost.fallen_back - ill), 0, 0,
                      "matrices that were not used are counted, %s", where);
        const struct description_sums sums = description_sum(simulation);
        check_measure(run, fabs((double)sums.fallen_back - ill), 0, 0,
                      "and so are the sums' particles, %s", where);
    }
    simulation_destroy(simulation);
}

#define CORRUPT(how) (&(const struct balance_subject){.corruption = how})
static const struct check_mutant mutants[] = {
    {"balance_force", "one force too large by 1e-10", CORRUPT(ONE_FORCE)},
    {"balance_heat", "one particle heated too much by 1e-8", CORRUPT(ONE_HEAT)},
    {"balance_turned", "forces turned by 1e-10", CORRUPT(TURNED)},
    {0},
};

CHECK_DEFINE(clouds, balance, 850, .cost = 0.4,
             .property = "sum F = 0, total power = 0, with forces along r_ij sum r x F = 0",
             .subjects = subjects, .measure = measure, .mutants = mutants);

/* --- specialised loops
 * ---------------------------------------------------------------------------- */

static void specialised_subjects(struct check_run *run)
{
    for (int dim = 2; dim <= 3; dim++)
        for (size_t k = 0; k < kernel_family.n; k++)
            for (size_t g = k % 5; g < hydro_cloud_geometries(); g += 5) {
                struct balance_subject s = {NONE, hydro_cloud_sheared, dim, BOUNDARY_PERIODIC,
                                            hydro_cloud_scheme(dim)};
                const double eta = s.scheme.eta;
                hydro_set_kernel(&s.scheme, kernel_family.members[k]->name);
                s.scheme.eta = eta;
                hydro_cloud_geometry(&s.scheme, g);
                s.scheme.viscosity = g % 2 ? VISCOSITY_PROJECTED : VISCOSITY_TIME_DEPENDENT;
                add(run, s);
            }
}

static void measure_specialised(struct check_run *run, const void *subject)
{
    const struct balance_subject *given = subject;
    const struct balance_subject s = given->corruption ? of_mutant(given) : *given;
    static struct hydro_state cloud;
    struct simulation *simulation[2] = {NULL, NULL};
    struct rates rates[2];
    struct error error = {0};
    char where[HYDRO_TEXT];
    s.state(&cloud, s.dim, s.dim == 2 ? 9 : 6);
    struct setup setup = hydro_setup(&cloud, &s.scheme);
    hydro_cloud_describe(&s.scheme, s.dim, where);
    enum status status = simulation_create(&setup, &simulation[0], &error);
    setup.generic = true;
    if (s.corruption) hydro_set_kernel(&setup.scheme, "quartic_spline");
    setup.scheme.eta = s.scheme.eta;
    if (!status) status = simulation_create(&setup, &simulation[1], &error);
    if (status) {
        check_measure(run, 1, 0, 0, "%s: %s", where, error.message);
    } else {
        for (int k = 0; k < 2; k++) simulation_rates(simulation[k], &rates[k]);
        double worst = hydro_difference(cloud.n, rates[0].energy, rates[1].energy);
        for (int a = 0; a < s.dim; a++)
            worst_keep(&worst, hydro_difference(cloud.n, rates[0].force[a], rates[1].force[a]));
        check_measure(run, worst, 1e-12, 2e-14, "%s", where);
    }
    for (int k = 0; k < 2; k++) simulation_destroy(simulation[k]);
}

static const struct check_mutant specialised_mutants[] = {
    {"cloud_specialisation_kernel", "another kernel in the generic loops", CORRUPT(OTHER_KERNEL)},
    {0},
};

CHECK_DEFINE(clouds, specialised, 850, .cost = 0.2,
             .property = "specialised loops = generic loops in 2D and 3D, for every kernel",
             .subjects = specialised_subjects, .measure = measure_specialised,
             .mutants = specialised_mutants);
