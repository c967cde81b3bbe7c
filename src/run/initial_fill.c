/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "initial.h"

#include <math.h>

#include "equal_masses.h"
#include "lattice.h"
#include "problem.h"

enum status initial_fill(const struct prepared *p, const struct settings *settings,
                         struct initial *initial, struct error *error)
{
    struct lattice_plan plan;
    const enum lattice kind = (enum lattice)settings_choice(settings, SETTING_lattice);
    const size_t n = (size_t)settings_real(settings, SETTING_n);
    if (settings_choice(settings, SETTING_equal_masses))
        return equal_masses_fill(p, settings, initial, error);
    if (lattice_plan_make(&plan, &p->domain, kind, n, error) ||
        initial_allocate(initial, p->domain.dim, plan.n, error))
        return error->status;
    return initial_lay(initial, p, &plan, 0, settings, error);
}

static bool in_window(const void *context, const double x[3])
{
    return window_contains(context, x);
}

enum status initial_fill_ball(const struct prepared *p, const struct settings *settings,
                              double radius, struct initial *initial, struct error *error)
{
    static const double parts[] = {0, 1, M_PI / 4, M_PI / 6}; /* of the bounding box */
    const int dim = p->domain.dim;
    const enum lattice kind = (enum lattice)settings_choice(settings, SETTING_lattice);
    const size_t n = (size_t)round(settings_real(settings, SETTING_n) / parts[dim]);
    struct domain around = p->domain;
    struct window ball = p->window;
    struct lattice_plan plan;
    ball.radius = radius;
    for (int d = 0; d < dim; d++) {
        around.lo[d] = ball.lo[d] = ball.centre[d] - radius;
        around.hi[d] = ball.hi[d] = ball.centre[d] + radius;
    }
    if (lattice_plan_make(&plan, &around, kind, n, error) ||
        initial_allocate(initial, dim, plan.n, error))
        return error->status;
    if (initial_lay(initial, p, &plan, 0, settings, error)) return error->status;
    initial_keep(initial, 0, in_window, &ball);
    return STATUS_OK;
}
