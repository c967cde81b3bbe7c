/* SPDX-License-Identifier: GPL-3.0-or-later
 * Van Leer's midpoint predictor-corrector. */
#ifndef INTEGRATOR_VL2_H
#define INTEGRATOR_VL2_H

#include "integrator/runge_kutta.h"

static enum status vl2_step(struct simulation *simulation, double dt, struct error *error)
{
    runge_kutta_begin(simulation);
    const enum status status = runge_kutta_stage(simulation, 0, 1, 0.5 * dt, error);
    return status ? status : runge_kutta_stage(simulation, 0, 1, dt, error);
}

#endif
INTEGRATOR(vl2, .member = {"vl2", "van Leer midpoint", "Stone & Gardiner 2009"}, .order = 2,
           .evaluations = 2, .cfl = 0.3, .keeps_start = true, .ends_evaluated = true)
