/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "memory.h"

#include "solver.h"

unsigned memory_uses(const struct simulation *simulation)
{
    const struct plan *plan = &simulation->plan;
    const bool line = plan->dim == 1;
    unsigned uses = USE_ALWAYS;
    if (simulation->scheme.integrator->keeps_start) uses |= USE_START;
    if (!plan->newton) uses |= USE_PREDICTED_WIDTH;
    if (plan->grad_h) uses |= USE_GRAD_H;
    if (line || plan->alpha || plan->jump) uses |= USE_ALPHA;
    if (plan->alpha) uses |= USE_ALPHA_RATE;
    if (plan->own_gradient || (line && plan->matrix)) uses |= USE_PAIR_SCALE;
    if (line && plan->slope) uses |= USE_SLOPE;
    if (!line || plan->signal_pass || plan->sleep) uses |= USE_SIGNAL;
    if (plan->local) uses |= USE_LOCAL_STEPS;
    if (plan->shift) uses |= USE_SHIFT;
    return uses;
}

double memory_bytes(const struct setup *setup)
{
    struct simulation simulation = {.scheme = setup->scheme, .plan = plan_of_setup(setup)};
    const double n = (double)setup->n;
    enum { OTHERS = 3 }; /* id, order, spare; the wrapped positions of a snapshot are added below */
    const size_t arrays = particles_arrays(setup->dim, memory_uses(&simulation)) + OTHERS;
    return sizeof(double) * n * (double)(arrays + (size_t)setup->dim) +
           simulation.plan.sums->bytes(&simulation, n);
}
