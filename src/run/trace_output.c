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
    static const char *const names[] = {"time",   "mass",    "momentum", "angular_momentum",
                                        "energy", "kinetic", "potential"};
    enum { SERIES = sizeof names / sizeof *names };
    const struct conservation *start = &trace->sums[0];
    json_t *object = json_object();
    for (size_t i = 0; i < SERIES; i++) json_object_set_new(object, names[i], json_array());
    for (size_t k = 0; k < trace->count; k++) {
        const struct trace_drift drift =
            trace_drift(start, &trace->sums[k], &trace->sums[trace->count - 1]);
        const double gained = trace->sums[k].kinetic - start->kinetic,
                     potential = trace->sums[k].energy - start->energy - gained,
                     values[SERIES] = {trace->time[k],
                                       drift.mass,
                                       drift.momentum,
                                       drift.angular_momentum,
                                       drift.energy,
                                       gained / fabs(start->energy),
                                       potential / fabs(start->energy)};
        for (size_t i = 0; i < SERIES; i++)
            json_array_append_new(json_object_get(object, names[i]), result_number(values[i]));
    }
    if (dim == 1) json_object_set_new(object, "angular_momentum", json_null());
    json_object_set_new(object, "regularity", seen_json(trace));
    return object;
}
