/* SPDX-License-Identifier: GPL-3.0-or-later
 * Crystal lattices: Kittel 2005, ch. 1. */
#include "lattice.h"

#include <math.h>

#include "quasi_random.h"
#include "relax.h"

enum { BASE_MAX = 4 };

/* A conventional cell: sides relative to the first, and points in fractions of the sides; the
 * points of the 2D lattice come first. */
struct crystal {
    int least_dim, plane_count, count; /* number of points in 2D and in 3D */
    double side[3];
    double base[BASE_MAX][3];
};

#define ROOT_3       1.7320508075688772
#define CLOSE_PACKED 1.6329931618554521 /* sqrt(8/3) */

static const struct crystal line = {1, 0, 1, {1}, {{0.5}}};
static const struct crystal square = {2, 1, 1, {1, 1, 1}, {{0.5, 0.5, 0.5}}};
/* in 3D hexagonal close-packed: layers fill each other's gaps in the order ABAB */
static const struct crystal hexagonal = {2,
                                         2,
                                         4,
                                         {1, ROOT_3, CLOSE_PACKED},
                                         {{0.25, 0.25, 0.25},
                                          {0.75, 0.75, 0.25},
                                          {0.75, 0.25 + 1. / 6, 0.75},
                                          {0.25, 0.75 + 1. / 6, 0.75}}};
static const struct crystal fcc = {
    3,
    0,
    4,
    {1, 1, 1},
    {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.25}, {0.75, 0.25, 0.75}, {0.25, 0.75, 0.75}}};
static const struct crystal bcc = {3, 0, 2, {1, 1, 1}, {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}}};

/* NULL: not a crystal. Clustered and coincident particles are displaced from the uniform line. */
static const struct crystal *const crystals[LATTICES] = {
    [LATTICE_UNIFORM] = &line,        [LATTICE_CLUSTERED] = &line, [LATTICE_COINCIDENT] = &line,
    [LATTICE_SQUARE] = &square,       [LATTICE_CUBIC] = &square,   [LATTICE_JITTERED] = &square,
    [LATTICE_HEXAGONAL] = &hexagonal, [LATTICE_FCC] = &fcc,        [LATTICE_BCC] = &bcc};

enum status lattice_plan_make(struct lattice_plan *plan, const struct domain *box,
                              enum lattice kind, size_t n, struct error *error)
{
    const struct crystal *crystal = crystals[kind];
    const char *name = settings_lattice_family.members[kind]->name;
    *plan = (struct lattice_plan){.box = *box, .kind = kind, .n = n};
    if (!crystal) return STATUS_OK;
    if (box->dim < crystal->least_dim)
        return error_set(error, STATUS_BAD_INPUT, "lattice=%s has no form in %d dimensions", name,
                         box->dim);
    const double count = box->dim == 2 ? crystal->plane_count : crystal->count;
    double volume = 1, shape = 1;
    for (int d = 0; d < box->dim; d++) {
        volume *= domain_length(box, d);
        shape *= crystal->side[d];
    }
    /* first side of a cell, if cells filled the box without having to fit */
    const double side = pow(volume * count / ((double)n * shape), 1. / box->dim);
    plan->n = (size_t)count;
    for (int d = 0; d < 3; d++) {
        const double fit = d < box->dim ? domain_length(box, d) / (side * crystal->side[d]) : 1;
        plan->cells[d] = (size_t)fmax(1, round(fit));
        plan->n *= plan->cells[d];
    }
    return STATUS_OK;
}

static void crystal_points(const struct lattice_plan *plan, const struct crystal *crystal,
                           double *const x[3])
{
    const struct domain *box = &plan->box;
    const int count = box->dim == 2 ? crystal->plane_count : crystal->count;
    size_t i = 0;
    for (size_t cz = 0; cz < plan->cells[2]; cz++)
        for (size_t cy = 0; cy < plan->cells[1]; cy++)
            for (size_t cx = 0; cx < plan->cells[0]; cx++)
                for (int k = 0; k < count; k++, i++) {
                    const size_t cell[3] = {cx, cy, cz};
                    for (int d = 0; d < box->dim; d++)
                        x[d][i] = box->lo[d] + domain_length(box, d) *
                                                   ((double)cell[d] + crystal->base[k][d]) /
                                                   (double)plan->cells[d];
                }
}

static enum status random_points(const struct lattice_plan *plan, unsigned long seed,
                                 double *const x[3], struct error *error)
{
    const struct domain *box = &plan->box;
    struct quasi_random *random = quasi_random_create(box->dim, seed);
    double part[3];
    if (!random) return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu points", plan->n);
    for (size_t i = 0; i < plan->n; i++) {
        quasi_random_next(random, part);
        for (int d = 0; d < box->dim; d++) x[d][i] = box->lo[d] + domain_length(box, d) * part[d];
    }
    quasi_random_destroy(random);
    return STATUS_OK;
}

/* Volume of each of n equal points. */
static double equal_share(const void *context, const double x[3])
{
    const struct lattice_plan *plan = context;
    double share = 1. / (double)plan->n;
    (void)x;
    for (int d = 0; d < plan->box.dim; d++) share *= domain_length(&plan->box, d);
    return share;
}

enum status lattice_points(const struct lattice_plan *plan, unsigned long seed, double *const x[3],
                           struct error *error)
{
    const struct crystal *crystal = crystals[plan->kind];
    const struct relax_region region = {plan->box, equal_share, plan};
    enum status status = STATUS_OK;
    if (crystal)
        crystal_points(plan, crystal, x);
    else
        status = random_points(plan, seed, x, error);
    if (status || plan->kind != LATTICE_GLASS) return status;
    return relax_points(&region, plan->n, x, error);
}
