/* SPDX-License-Identifier: GPL-3.0-or-later
 * A square of dense gas in a periodic box of thin gas at the same pressure (Saitoh & Makino 2013).
 * Nothing should move, and the corners should stay sharp. Particles of equal spacing whose masses
 * have the ratio of the densities, or of equal masses on lattices of two spacings. */
#include <math.h>
#include <stdlib.h>

#include "functional.h"
#include "initial.h"
#include "lattice.h"
#include "problem.h"

static const double thin = 1, pressure = 2.5;

struct square {
    double dense;
    struct domain inside;
};
PROBLEM_OWN(square)

/* The square has half the size of the box in each direction and is centred. */
static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    struct square *square = (struct square *)p->own.bytes;
    (void)error;
    square->dense = thin * settings_real(settings, SETTING_contrast);
    square->inside.dim = p->domain.dim;
    for (int d = 0; d < p->domain.dim; d++) {
        const double quarter = 0.25 * domain_length(&p->domain, d);
        square->inside.lo[d] = p->domain.lo[d] + quarter;
        square->inside.hi[d] = p->domain.hi[d] - quarter;
    }
    return STATUS_OK;
}

static bool is_inside(const struct square *square, const double x[3])
{
    for (int d = 0; d < square->inside.dim; d++)
        if (!(x[d] >= square->inside.lo[d] && x[d] < square->inside.hi[d])) return false;
    return true;
}

static void sample(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state)
{
    const struct square *square = square_of(p);
    const double rho = is_inside(square, x) ? square->dense : thin;
    (void)t;
    *state =
        (struct problem_state){.rho = rho, .P = pressure, .u = pressure / ((p->gamma - 1) * rho)};
}

/* ---- equal masses: each gas on its own lattice, the thin one with a hole ---- */

static bool is_around(const void *square, const double x[3])
{
    return !is_inside(square, x);
}

/* Scales the masses of a gas to its total mass. */
static void fill_up(struct initial *initial, size_t first, size_t end, double mass)
{
    for (size_t i = first; i < end; i++) initial->m[i] = mass / (double)(end - first);
}

static enum status fill_equal_masses(const struct prepared *p, const struct settings *settings,
                                     struct initial *initial, struct error *error)
{
    const struct square *square = square_of(p);
    const enum lattice kind = (enum lattice)settings_choice(settings, SETTING_lattice);
    struct lattice_plan dense, around;
    const double volume = domain_volume(&p->domain), inner = domain_volume(&square->inside);
    const double all = square->dense * inner + thin * (volume - inner);
    const double n = settings_real(settings, SETTING_n);
    if (lattice_plan_make(&dense, &square->inside, kind,
                          (size_t)fmax(1, round(n * square->dense * inner / all)), error) ||
        lattice_plan_make(&around, &p->domain, kind,
                          (size_t)fmax(1, round(n * thin * volume / all)), error) ||
        initial_allocate(initial, p->domain.dim, dense.n + around.n, error))
        return error->status;
    if (initial_lay(initial, p, &dense, 0, settings, error) ||
        initial_lay(initial, p, &around, dense.n, settings, error))
        return error->status;
    initial_keep(initial, dense.n, is_around, square);
    fill_up(initial, 0, dense.n, square->dense * inner);
    fill_up(initial, dense.n, initial->n, thin * (volume - inner));
    return STATUS_OK;
}

/* One lattice for both gases, with the edges of the square between its planes: four times as many
 * cells per direction as a lattice with a quarter of the particles per direction. */
static enum status fill_equal_spacing(const struct prepared *p, const struct settings *settings,
                                      struct initial *initial, struct error *error)
{
    const enum lattice kind = (enum lattice)settings_choice(settings, SETTING_lattice);
    const int dim = p->domain.dim;
    struct lattice_plan plan;
    const double n = settings_real(settings, SETTING_n) / (dim == 2 ? 16 : 64);
    if (lattice_plan_make(&plan, &p->domain, kind, (size_t)fmax(1, round(n)), error))
        return error->status;
    for (int d = 0; d < dim; d++) {
        plan.cells[d] *= 4;
        plan.n *= 4;
    }
    if (initial_allocate(initial, dim, plan.n, error)) return error->status;
    return initial_lay(initial, p, &plan, 0, settings, error);
}

static enum status fill(const struct prepared *p, const struct settings *settings,
                        struct initial *initial, struct error *error)
{
    const bool equal_masses = settings_choice(settings, SETTING_equal_masses);
    return (equal_masses ? fill_equal_masses : fill_equal_spacing)(p, settings, initial, error);
}

const struct problem problem_square = {
    .member = {"square", "a dense square in thin gas of the same pressure", "Saitoh & Makino 2013"},
    .reference = "square",
    .least_dim = 2,
    .most_dim = 3,
    .shifts = true,
    .carried = true,
    .steady = true,
    .ends = {PROBLEM_WALLS, PROBLEM_WALLS, PROBLEM_WALLS},
    PROBLEM_KEYS({SETTING_contrast, ROLE_OPTIONAL}, {SETTING_equal_masses, ROLE_PARTICLES}),
    .prepare = prepare,
    .sample = sample,
    .fill = fill,
    .functionals = {&functional_velocity_rms},
};
