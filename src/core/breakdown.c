/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "breakdown.h"

#include <stdio.h>

#include "solver.h"

enum status breakdown_of(const struct simulation *simulation, ptrdiff_t i, const char *quantity,
                         double value, struct error *error)
{
    const struct particles *a = &simulation->particles;
    char position[96] = "";
    size_t used = 0;
    for (int k = 0; k < a->dim; k++)
        used += (size_t)snprintf(position + used, sizeof position - used, "%s%c = %.9g",
                                 k ? ", " : "", "xyz"[k], a -> x[k][i]);
    return error_set(error, STATUS_BROKE_DOWN,
                     "broke down at t = %.9g: %s of particle %zu at %s is %.9g", simulation->time,
                     quantity, a->id[i], position, value);
}
