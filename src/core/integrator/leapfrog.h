/* SPDX-License-Identifier: GPL-3.0-or-later
 * Kick-drift-kick leapfrog with prediction. */
#ifndef INTEGRATOR_LEAPFROG_H
#define INTEGRATOR_LEAPFROG_H

#include "integrator/leapfrog_kicks.h"

static enum status leapfrog_step(struct simulation *simulation, double dt, struct error *error)
{
    return leapfrog_kicks(simulation, dt, error);
}

#endif
INTEGRATOR(leapfrog, .member = {"leapfrog", "kick-drift-kick leapfrog", "Springel 2005"},
           .order = 2, .evaluations = 1, .cfl = 0.3, .keeps_start = true, .signal_pass = true)
