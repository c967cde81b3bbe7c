/* SPDX-License-Identifier: GPL-3.0-or-later
 * Leapfrog with a second evaluation after the second kick, at unchanged positions, so that each
 * step begins with the rates of its own state. */
#ifndef INTEGRATOR_MODIFIED_LEAPFROG_H
#define INTEGRATOR_MODIFIED_LEAPFROG_H

#include "integrator/leapfrog_kicks.h"

static enum status modified_leapfrog_step(struct simulation *simulation, double dt,
                                          struct error *error)
{
    const enum status status = leapfrog_kicks(simulation, dt, error);
    return status ? status : evaluate_rates_in_place(simulation, error);
}

#endif
INTEGRATOR(modified_leapfrog,
           .member = {"modified_leapfrog", "leapfrog, evaluated again after the second kick", ""},
           .order = 2, .evaluations = 2, .cfl = 0.3, .keeps_start = true, .ends_evaluated = true)
