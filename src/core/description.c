/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "description.h"

#include <math.h>

#include "solver.h"

void description_each(const struct simulation *simulation, description_visit *visit, void *context)
{
    simulation->plan.sums->describe(simulation, visit, context);
}

struct adding {
    struct description_sums sums;
    double conditions, angles; /* numbers of values in the means */
};

static void add(void *context, size_t particle, const struct description *of)
{
    struct adding *to = context;
    struct description_sums *sums = &to->sums;
    (void)particle;
    if (!(of->condition <= DESCRIPTION_CONDITION)) {
        sums->fallen_back++;
        return;
    }
    sums->condition_max = fmax(sums->condition_max, of->condition);
    sums->condition_mean += of->condition;
    to->conditions++;
    if (isnan(of->angle)) return;
    sums->angle_max = fmax(sums->angle_max, of->angle);
    sums->angle_mean += of->angle;
    to->angles++;
}

struct description_sums description_sum(struct simulation *simulation)
{
    const double none = nan("");
    struct adding to = {.sums = {none, 0, none, 0, 0}};
    if (!simulation->plan.matrix) return (struct description_sums){none, none, none, none, 0};
    /* if the last evaluation did not compute rates, the matrices belong to an earlier stage */
    if (simulation->cost.steps > 0 && !simulation->scheme.integrator->ends_evaluated) {
        const struct simulation_cost cost = simulation->cost;
        simulation->plan.sums->matrix(simulation);
        simulation->cost = cost;
    }
    description_each(simulation, add, &to);
    to.sums.condition_mean /= to.conditions;
    to.sums.angle_mean /= to.angles;
    return to.sums;
}
