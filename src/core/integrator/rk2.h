/* SPDX-License-Identifier: GPL-3.0-or-later
 * Two-stage Runge-Kutta (Heun). */
#ifndef INTEGRATOR_RK2_H
#define INTEGRATOR_RK2_H

#include "integrator/runge_kutta.h"

static enum status rk2_step(struct simulation *simulation, double dt, struct error *error)
{
    runge_kutta_begin(simulation);
    const enum status status = runge_kutta_stage(simulation, 0, 1, dt, error);
    return status ? status : runge_kutta_stage(simulation, 0.5, 0.5, 0.5 * dt, error);
}

#endif
INTEGRATOR(rk2, .member = {"rk2", "Runge-Kutta, Heun, SSP", "Shu & Osher 1988"}, .order = 2,
           .evaluations = 2, .cfl = 0.3, .keeps_start = true, .ends_evaluated = true)
