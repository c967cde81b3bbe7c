/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "memory.h"

#include "solver.h"

/* Arrays of the particles that a run writes to: the others take no room. */
static double arrays_of(const struct simulation *simulation)
{
    const struct plan *plan = &simulation->plan;
    const bool line = plan->dim == 1;
    enum { VECTORS = 5, SCALARS = 12, ORDERS = 3 }; /* x x_old p v F; id, order, spare */
    double count = VECTORS * plan->dim + SCALARS + ORDERS;
    if (!plan->newton) count++;                                             /* h_inverse_old */
    if (simulation->scheme.integrator->keeps_start) count += plan->dim + 1; /* p_old e_old */
    if (plan->grad_h) count += 2;                                           /* grad_h b */
    if (line || plan->alpha || plan->jump) count += 2;                      /* alpha alpha_old */
    if (plan->alpha) count += 2;                                            /* dalpha div_v */
    if (plan->own_gradient || (line && plan->matrix)) count++;              /* g */
    if (line && plan->slope) count++;                                       /* dv */
    if (!line || plan->signal_pass || plan->sleep) count++;                 /* signal */
    return count + plan->dim; /* those of a snapshot */
}

double memory_bytes(const struct setup *setup)
{
    struct simulation simulation = {.scheme = setup->scheme, .plan = plan_of_setup(setup)};
    const double n = (double)setup->n;
    return sizeof(double) * n * arrays_of(&simulation) +
           simulation.plan.sums->bytes(&simulation, n);
}
