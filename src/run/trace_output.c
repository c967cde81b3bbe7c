/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run_output.h"

#include <math.h>

#include "result.h"

json_t *trace_regularity_json(const struct regularity *regularity)
{
    return result_object("nearest=%g spread=%g paired=%g density=%g gradient=%g",
                         regularity->nearest, regularity->spread, regularity->paired,
                         regularity->density, regularity->gradient);
}

static json_t *seen_json(const struct trace *trace)
{
    json_t *lists = json_pack("{s:[]}", "time");
    for (size_t k = 0; k < trace->looks; k++) {
        json_t *one = trace_regularity_json(&trace->seen[k]), *value;
        const char *name;
        json_array_append_new(json_object_get(lists, "time"), result_number(trace->looked[k]));
        json_object_foreach(one, name, value) {
            if (!json_object_get(lists, name)) json_object_set_new(lists, name, json_array());
            json_array_append(json_object_get(lists, name), value);
        }
        json_decref(one);
    }
    return lists;
}

json_t *trace_json(const struct trace *trace, int dim)
{
    json_t *time = json_array(), *mass = json_array(), *momentum = json_array(),
           *turning = json_array(), *energy = json_array(), *kinetic = json_array(),
           *potential = json_array();
    const struct conservation *start = &trace->sums[0];
    for (size_t k = 0; k < trace->count; k++) {
        const struct trace_drift drift =
            trace_drift(&trace->sums[0], &trace->sums[k], &trace->sums[trace->count - 1]);
        json_array_append_new(time, result_number(trace->time[k]));
        json_array_append_new(mass, result_number(drift.mass));
        json_array_append_new(momentum, result_number(drift.momentum));
        json_array_append_new(turning, result_number(drift.angular_momentum));
        json_array_append_new(energy, result_number(drift.energy));
        const double gained = trace->sums[k].kinetic - start->kinetic;
        json_array_append_new(kinetic, result_number(gained / fabs(start->energy)));
        json_array_append_new(
            potential,
            result_number((trace->sums[k].energy - start->energy - gained) / fabs(start->energy)));
    }
    json_t *trace_of = json_pack("{s:o, s:o, s:o, s:O, s:o, s:o, s:o, s:o}", "time", time, "mass",
                                 mass, "momentum", momentum, "angular_momentum",
                                 dim > 1 ? turning : json_null(), "energy", energy, "kinetic",
                                 kinetic, "potential", potential, "regularity", seen_json(trace));
    json_decref(turning);
    return trace_of;
}
