/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "budget.h"

#include <math.h>

#include "result.h"

const char *const budget_regions[REGIONS] = {
#define REGION(name, text) text,
    BUDGET_REGION_LIST(REGION)
#undef REGION
};

/* A wave that is nowhere has NaN for a place and is near nothing. */
static bool near(double x, double place, double reach)
{
    return fabs(x - place) <= reach;
}

static enum region region_at(const struct riemann_solution *tube, double x, double reach, double t)
{
    const double speeds[2][2] = {{tube->left_head, tube->left_tail},
                                 {tube->right_tail, tube->right_head}};
    const enum riemann_wave waves[2] = {tube->left_wave, tube->right_wave};
    for (int side = 0; side < 2; side++)
        if (waves[side] == RIEMANN_SHOCK && near(x, speeds[side][0] * t, reach))
            return REGION_SHOCK;
    if (near(x, tube->contact * t, reach)) return REGION_CONTACT;
    for (int side = 0; side < 2; side++)
        if (waves[side] == RIEMANN_RAREFACTION && x >= speeds[side][0] * t - reach &&
            x <= speeds[side][1] * t + reach)
            return REGION_FAN;
    return x < tube->left_head * t || x > tube->right_head * t ? REGION_UNDISTURBED
                                                               : REGION_PLATEAU;
}

/* Speed of the foremost edge that a solution sends to one side, sign 1 for the right. */
static double edge(const struct riemann_solution *tube, double sign)
{
    return sign > 0 ? fmax(tube->right_head, tube->right_tail)
                    : -fmin(tube->left_head, tube->left_tail);
}

/* Is a place so far ahead of a wave, which has run a way (backwards: < 0)? */
static bool far_ahead(double place, double way, double h)
{
    return place - way > fmax(BUDGET_STILL_WIDTHS * h, BUDGET_STILL_WAY * fabs(way));
}

/* Undisturbed gas lies between the main tube's wave and the one that comes from the box's end. */
static double stillness(const struct exact *exact, const struct snapshot *s)
{
    const struct riemann_solution *tube = &exact->tube;
    double moved = NAN;
    for (size_t i = 0; i < s->n; i++) {
        const double x = s->x[0][i], sign = x > exact->x0 ? 1 : -1;
        const struct riemann_state *gas = sign > 0 ? &tube->right : &tube->left;
        const double from_end = sign > 0 ? exact->hi - x : x - exact->lo;
        if (!far_ahead(sign * (x - exact->x0), edge(tube, sign) * s->time, s->h[i]) ||
            !far_ahead(from_end, edge(&exact->mirror, -sign) * s->time, s->h[i]))
            continue;
        const double c = sqrt(tube->gamma * gas->P / gas->rho);
        moved = fmax(moved, fabs(s->v[0][i] - gas->v) / c);
    }
    return moved;
}

void budget_measure(const struct exact *exact, const double window[2], const struct snapshot *s,
                    const double *const *exact_values, struct budget *budget)
{
    *budget = (struct budget){.known = exact->kind == KIND_RIEMANN, .still = NAN};
    if (!budget->known) return;
    const double *const measured[FIELDS] = {s->rho, s->v[0], s->P, s->u};
    double volume = 0;
    for (size_t i = 0; i < s->n; i++) {
        const double x = s->x[0][i];
        if (x < window[0] || x > window[1]) continue;
        const enum region region =
            region_at(&exact->tube, x - exact->x0, BUDGET_REACH * s->h[i], s->time);
        volume += s->volume[i];
        for (int f = 0; f < FIELDS; f++)
            budget->l1[region][f] += s->volume[i] * fabs(measured[f][i] - exact_values[f][i]);
    }
    for (int r = 0; r < REGIONS; r++)
        for (int f = 0; f < FIELDS; f++) budget->l1[r][f] /= volume;
    budget->still = stillness(exact, s);
}

void budget_add(struct budget *budget, const json_t *json, double weight)
{
    if (!json_is_object(json)) return;
    if (!budget->known) *budget = (struct budget){.known = true, .still = NAN};
    for (int r = 0; r < REGIONS; r++)
        for (int f = 0; f < FIELDS; f++)
            budget->l1[r][f] +=
                weight * result_real(json_object_get(json_object_get(json, budget_regions[r]),
                                                     field_family.members[f]->name));
    budget->still = fmax(budget->still, result_real(json_object_get(json, "still")));
}

json_t *budget_json(const struct budget *budget)
{
    if (!budget->known) return json_null();
    json_t *object = json_object();
    for (int r = 0; r < REGIONS; r++) {
        json_t *fields = json_object();
        for (int f = 0; f < FIELDS; f++)
            json_object_set_new(fields, field_family.members[f]->name,
                                result_number(budget->l1[r][f]));
        json_object_set_new(object, budget_regions[r], fields);
    }
    json_object_set_new(object, "still",
                        isnan(budget->still) ? json_null() : result_number(budget->still));
    return object;
}
