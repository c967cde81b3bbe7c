/* SPDX-License-Identifier: GPL-3.0-or-later
 * Three-stage, third-order SSP Runge-Kutta in two registers. */
#ifndef INTEGRATOR_RK3_H
#define INTEGRATOR_RK3_H

#include "integrator/runge_kutta.h"

static enum status rk3_step(struct simulation *simulation, double dt, struct error *error)
{
    runge_kutta_begin(simulation);
    enum status status = runge_kutta_stage(simulation, 0, 1, dt, error);
    if (!status) status = runge_kutta_stage(simulation, 0.25, 0.75, 0.25 * dt, error);
    if (!status) status = runge_kutta_stage(simulation, 2. / 3, 1. / 3, 2. / 3 * dt, error);
    return status;
}

#endif
INTEGRATOR(rk3, .member = {"rk3", "Runge-Kutta, three stages, SSP", "Ketcheson 2010"}, .order = 3,
           .evaluations = 3, .cfl = 0.3, .keeps_start = true, .ends_evaluated = true)
