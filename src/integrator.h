/* SPDX-License-Identifier: GPL-3.0-or-later
 * Integrators: one file in integrator/ and one line in integrators.def each. */
#ifndef SPHPROOF_INTEGRATOR_H
#define SPHPROOF_INTEGRATOR_H

#include <stdbool.h>

#include "family.h"
#include "status.h"

struct simulation;

struct integrator {
    struct member member;
    int order;
    int evaluations;      /* of the right-hand side, a step */
    double cfl;           /* default of the key cfl, in support radii; see descriptor's comment */
    bool ends_evaluated;  /* the rates at the end of a step belong to its final state */
    /* Advances the state by dt. */
    enum status (*step)(struct simulation *simulation, double dt, struct error *error);
};

#endif
