/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stress_part.h"

#include <math.h>
#include <string.h>

#include "result.h"

json_t *stress_outcome(double predicted, double measured, const char *outcome, const char *reason)
{
    return result_object("predicted=%g? measured=%g? outcome=%s reason=%s", predicted, measured,
                         outcome, reason);
}

const char *stress_outcome_breakdown(const char *message)
{
    static const char *const kinds[][2] = {{"internal energy", "negative energy"},
                                           {"smoothing length", "h without root"},
                                           {"time step", "time step collapse"},
                                           {"pair interactions", "too much work"},
                                           {"position", "NaN"},
                                           {"crashed", "crash"}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strstr(message, kinds[i][0])) return kinds[i][1];
    return "broke down";
}
