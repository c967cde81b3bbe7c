/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "autopsy.h"

#include <math.h>
#include <stdio.h>

#include "result.h"

#define MEMBER(name, label)                                                                        \
    &(const struct member)                                                                         \
    {                                                                                              \
        name, label, ""                                                                            \
    }

const struct family autopsy_part_family = {
    "parts", "what an error is made of",
    (const struct member *const[]){
        MEMBER("time_step", "the time step"),
        MEMBER("measure", "the measure of the error"),
        MEMBER("reference", "the exact solution itself"),
        MEMBER("operator", "the gradient at regular positions"),
        MEMBER("density", "the density at regular positions"),
        MEMBER("disorder", "disorder"),
        MEMBER("viscosity", "viscosity"),
    },
    AUTOPSY_PARTS};

const struct family autopsy_term_family = {"terms", "what moves energy between flow and heat",
                                           (const struct member *const[]){
                                               MEMBER("pressure", "pressure"),
                                               MEMBER("viscosity", "viscosity"),
                                               MEMBER("noise", "viscosity, its noise term"),
                                               MEMBER("conductivity", "conductivity"),
                                           },
                                           AUTOPSY_TERMS};

enum status autopsy_check(const struct run *run, struct error *error)
{
    const struct problem *problem = run->problem.problem;
    if (problem->smooth && !problem->fieldless) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "%s: an autopsy needs an exact solution without jumps: allowed: cases of the "
                     "kinds gresho, rest, shear, sound_wave and yee",
                     run->asked.file.name);
}

/* ---- orders ---- */

/* Of a figure of each level that stands `at` bytes behind its beginning. */
static enum status fit(const struct autopsy *autopsy, size_t at, struct order_fit *order,
                       struct error *error)
{
    double spacing[CASE_LADDER_MAX], size[CASE_LADDER_MAX];
    bool any = false;
    for (size_t l = 0; l < autopsy->count; l++) {
        spacing[l] = autopsy->levels[l].spacing;
        size[l] = *(const double *)((const char *)&autopsy->levels[l] + at);
        any |= size[l] != 0;
    }
    *order = (struct order_fit){.order = (double)NAN, .low = (double)NAN, .high = (double)NAN};
    return any ? order_fit(autopsy->count, spacing, size, NULL, order, error) : STATUS_OK;
}

/* ---- what is to blame ---- */

/* The largest part of those that are suspected. */
static size_t largest(const struct autopsy_level *level, const bool suspected[AUTOPSY_PARTS])
{
    size_t best = AUTOPSY_PARTS;
    for (size_t k = 0; k < AUTOPSY_PARTS; k++)
        if (suspected[k] && (best == AUTOPSY_PARTS || level->share[k] > level->share[best]))
            best = k;
    return best;
}

/* Where the order is lost: only parts that fall as slowly, if there are any. An order that is none
 * (the part vanishes at a level) tells nothing about it. */
static void suspect(const struct autopsy *autopsy, bool suspected[AUTOPSY_PARTS])
{
    bool any = false;
    for (size_t k = 0; k < AUTOPSY_PARTS; k++) {
        suspected[k] = !autopsy->lost || autopsy->orders[k].order < AUTOPSY_ORDER;
        any |= suspected[k];
    }
    for (size_t k = 0; !any && k < AUTOPSY_PARTS; k++) suspected[k] = true;
}

static void blame(struct autopsy *autopsy)
{
    bool suspected[AUTOPSY_PARTS];
    const size_t finest = autopsy->count - 1;
    suspect(autopsy, suspected);
    autopsy->cause = (enum autopsy_part)largest(&autopsy->levels[finest], suspected);
    autopsy->from = finest;
    while (autopsy->from > 0 &&
           largest(&autopsy->levels[autopsy->from - 1], suspected) == autopsy->cause)
        autopsy->from--;
    autopsy->floor = (autopsy->cause == AUTOPSY_OPERATOR || autopsy->cause == AUTOPSY_DENSITY) &&
                     autopsy->orders[autopsy->cause].order < AUTOPSY_FLOOR;
}

/* A number of particles as people write it: 64^2. */
static void number_text(size_t n, int dim, char text[32])
{
    const double root = round(pow((double)n, 1. / dim));
    if (dim > 1 && (size_t)pow(root, dim) == n)
        snprintf(text, 32, "%.0f^%d", root, dim);
    else
        snprintf(text, 32, "%zu", n);
}

static void speak(struct autopsy *autopsy)
{
    const struct autopsy_level *finest = &autopsy->levels[autopsy->count - 1];
    const char *cause = autopsy->floor ? "the kernel's lattice sums, a floor at regular positions,"
                                       : autopsy_part_family.members[autopsy->cause]->label;
    const double part = 100 * finest->share[autopsy->cause],
                 own = autopsy->orders[autopsy->cause].order;
    char from[32], at[32], order[48] = "";
    number_text(autopsy->levels[autopsy->from].n, autopsy->dim, from);
    number_text(finest->n, autopsy->dim, at);
    if (isfinite(own)) snprintf(order, sizeof order, " and falls with order %.2f itself", own);
    if (autopsy->lost)
        snprintf(autopsy->verdict, sizeof autopsy->verdict,
                 "The order, %.2f, is lost to %s from %s on: it is %.0f %% of the error at %s%s.",
                 autopsy->order.order, cause, from, part, at, order);
    else
        snprintf(autopsy->verdict, sizeof autopsy->verdict,
                 "No order is lost: it is %.2f. The largest part of the error from %s on is %s: "
                 "%.0f %% at %s%s%s.",
                 autopsy->order.order, from, cause, part, at, *order ? "; it" : "",
                 *order ? order + 4 : "");
}

enum status autopsy_judge(struct autopsy *autopsy, struct error *error)
{
    const struct {
        size_t at;
        struct order_fit *order;
    } figures[] = {{offsetof(struct autopsy_level, error), &autopsy->order},
                   {offsetof(struct autopsy_level, regular), &autopsy->regular},
                   {offsetof(struct autopsy_level, own), &autopsy->own},
                   {offsetof(struct autopsy_level, jittered), &autopsy->jittered}};
    for (size_t k = 0; k < sizeof figures / sizeof *figures; k++)
        if (fit(autopsy, figures[k].at, figures[k].order, error)) return error->status;
    for (size_t k = 0; k < AUTOPSY_PARTS; k++)
        if (fit(autopsy,
                offsetof(struct autopsy_level, size[0].rms) + k * sizeof(struct autopsy_split),
                &autopsy->orders[k], error))
            return error->status;
    autopsy->lost = !(autopsy->order.order >= AUTOPSY_ORDER);
    blame(autopsy);
    speak(autopsy);
    return STATUS_OK;
}

/* ---- output ---- */

static json_t *order_json(const struct order_fit *fit)
{
    return json_pack("{s:o, s:o, s:o}", "order", result_number_or_null(fit->order), "low",
                     result_number_or_null(fit->low), "high", result_number_or_null(fit->high));
}

static json_t *parts_json(const struct autopsy_level *level)
{
    json_t *parts = json_object();
    for (size_t k = 0; k < AUTOPSY_PARTS; k++)
        json_object_set_new(parts, autopsy_part_family.members[k]->name,
                            json_pack("{s:o, s:o, s:o}", "size", result_number(level->size[k].rms),
                                      "noise", result_number(level->size[k].noise), "share",
                                      result_number(level->share[k])));
    return parts;
}

static json_t *power_json(const struct autopsy_power power[AUTOPSY_TERMS])
{
    json_t *terms = json_object();
    for (size_t k = 0; k < AUTOPSY_TERMS; k++)
        json_object_set_new(terms, autopsy_term_family.members[k]->name,
                            json_pack("{s:o, s:o, s:o}", "work", result_number(power[k].work),
                                      "heat", result_number(power[k].heat), "scale",
                                      result_number(power[k].scale)));
    return terms;
}

static json_t *level_json(const struct autopsy_level *level)
{
    const struct {
        const char *name;
        double value;
    } numbers[] = {{"spacing", level->spacing},
                   {"error", level->error[0]},
                   {"error_half_step", level->error[1]},
                   {"error_quarter_step", level->error[2]},
                   {"error_rms", level->velocity.rms},
                   {"noise_rms", level->velocity.noise},
                   {"acceleration", level->acceleration},
                   {"regular", level->regular},
                   {"own", level->own},
                   {"jittered", level->jittered},
                   {"density", level->density},
                   {"density_regular", level->density_regular}};
    json_t *object =
        json_pack("{s:i, s:o, s:o, s:o}", "n", (int)level->n, "parts", parts_json(level), "power",
                  power_json(level->power), "regularity", regularity_json(&level->regularity));
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        json_object_set_new(object, numbers[k].name, result_number(numbers[k].value));
    return object;
}

void autopsy_add_json(const struct autopsy *autopsy, json_t *document)
{
    json_t *levels = json_array(), *orders = json_object();
    for (size_t l = 0; l < autopsy->count; l++)
        json_array_append_new(levels, level_json(&autopsy->levels[l]));
    json_object_set_new(orders, "error", order_json(&autopsy->order));
    json_object_set_new(orders, "regular", order_json(&autopsy->regular));
    json_object_set_new(orders, "own", order_json(&autopsy->own));
    json_object_set_new(orders, "jittered", order_json(&autopsy->jittered));
    for (size_t k = 0; k < AUTOPSY_PARTS; k++)
        json_object_set_new(orders, autopsy_part_family.members[k]->name,
                            order_json(&autopsy->orders[k]));
    json_object_set_new(document, "levels", levels);
    json_object_set_new(document, "orders", orders);
    json_object_set_new(document, "trace", trace_json(&autopsy->trace, autopsy->dim));
    json_object_set_new(document, "lost", json_boolean(autopsy->lost));
    json_object_set_new(document, "cause",
                        json_string(autopsy_part_family.members[autopsy->cause]->name));
    json_object_set_new(document, "floor", json_boolean(autopsy->floor));
    json_object_set_new(document, "from",
                        json_integer((json_int_t)autopsy->levels[autopsy->from].n));
    json_object_set_new(document, "verdict", json_string(autopsy->verdict));
}
