/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "budget.h"

#include <math.h>

#include "result.h"
#include "value.h"

void budget_measure(const struct prepared *p, const struct snapshot *s,
                    const double *const *exact_values, struct budget *budget)
{
    const struct regions *regions = p->problem->regions;
    *budget = (struct budget){.regions = regions, .still = NAN};
    if (!regions) return;
    const double *const measured[FIELDS] = {s->rho, s->v[0], s->P, s->u};
    double volume = 0, x[3];
    for (size_t i = 0; i < s->n; i++) {
        const double part = problem_window_part(p, s, i);
        if (part == 0) continue;
        problem_place(p, s, i, x);
        const size_t region = regions->at(p, x, BUDGET_REACH * s->h[i], s->time);
        volume += part;
        for (int f = 0; f < FIELDS; f++)
            budget->l1[region][f] += part * fabs(measured[f][i] - exact_values[f][i]);
    }
    for (size_t r = 0; regions->names[r]; r++)
        for (int f = 0; f < FIELDS; f++) budget->l1[r][f] /= volume;
    budget->still = regions->still(p, s);
}

void budget_add(struct budget *budget, const struct regions *regions, const json_t *json,
                double weight)
{
    if (!regions || !json_is_object(json)) return;
    if (!budget->regions) *budget = (struct budget){.regions = regions, .still = NAN};
    for (size_t r = 0; regions->names[r]; r++)
        for (int f = 0; f < FIELDS; f++)
            budget->l1[r][f] +=
                weight * value_inner(json, regions->names[r], field_family.members[f]->name);
    budget->still = fmax(budget->still, value_member(json, "still"));
}

json_t *budget_json(const struct budget *budget)
{
    if (!budget->regions) return json_null();
    json_t *object = json_object();
    for (size_t r = 0; budget->regions->names[r]; r++) {
        json_t *fields = json_object();
        for (int f = 0; f < FIELDS; f++)
            json_object_set_new(fields, field_family.members[f]->name,
                                result_number(budget->l1[r][f]));
        json_object_set_new(object, budget->regions->names[r], fields);
    }
    json_object_set_new(object, "still",
                        isnan(budget->still) ? json_null() : result_number(budget->still));
    return object;
}
