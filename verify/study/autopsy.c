/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "autopsy.h"

#include <math.h>
#include <stdio.h>

#include "result.h"
#include "run_output.h"

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
        MEMBER("density", "volume elements at regular positions"),
        MEMBER("disorder", "disorder"),
        MEMBER("viscosity", "viscosity"),
        MEMBER("noise_term", "the viscosity's term against noise"),
        MEMBER("conductivity", "conductivity"),
    },
    AUTOPSY_PARTS};

const struct family autopsy_share_family = {"shares", "what an error is shared among",
                                            (const struct member *const[]){
                                                MEMBER("operator", "gradient"),
                                                MEMBER("disorder", "disorder"),
                                                MEMBER("viscosity", "viscosity"),
                                                MEMBER("time_step", "time step"),
                                                MEMBER("volume", "volume elements"),
                                                MEMBER("measure", "measure"),
                                            },
                                            AUTOPSY_SHARES};

static const enum autopsy_share share_of[AUTOPSY_PARTS] = {
    [AUTOPSY_TIME_STEP] = AUTOPSY_OF_TIME_STEP, [AUTOPSY_MEASURE] = AUTOPSY_OF_MEASURE,
    [AUTOPSY_REFERENCE] = AUTOPSY_OF_MEASURE,   [AUTOPSY_OPERATOR] = AUTOPSY_OF_OPERATOR,
    [AUTOPSY_DENSITY] = AUTOPSY_OF_VOLUME,      [AUTOPSY_DISORDER] = AUTOPSY_OF_DISORDER,
    [AUTOPSY_VISCOSITY] = AUTOPSY_OF_VISCOSITY, [AUTOPSY_NOISE_TERM] = AUTOPSY_OF_VISCOSITY,
    [AUTOPSY_CONDUCTION] = AUTOPSY_OF_VISCOSITY};

double autopsy_share(const struct autopsy_level *level, enum autopsy_share share)
{
    double sum = 0;
    for (size_t k = 0; k < AUTOPSY_PARTS; k++)
        if (share_of[k] == share) sum += level->share[k];
    return sum;
}

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

/* Fits the order of one figure over the levels. Too few levels, or a zero, give no order. */
static enum status fit_sizes(const struct autopsy *autopsy, const double *size,
                             struct order_fit *order, struct error *error)
{
    double spacing[CASE_LADDER_MAX];
    bool any = false;
    for (size_t l = 0; l < autopsy->count; l++) {
        spacing[l] = autopsy->levels[l].spacing;
        any |= size[l] != 0;
    }
    *order = (struct order_fit){.order = (double)NAN, .low = (double)NAN, .high = (double)NAN};
    if (!any || autopsy->count < ORDER_LEVELS_MIN) return STATUS_OK;
    return order_fit(autopsy->count, spacing, size, NULL, order, error);
}

/* Fits the order of the figure at offset `at` of each level. */
static enum status fit(const struct autopsy *autopsy, size_t at, struct order_fit *order,
                       struct error *error)
{
    double size[CASE_LADDER_MAX];
    for (size_t l = 0; l < autopsy->count; l++)
        size[l] = *(const double *)((const char *)&autopsy->levels[l] + at);
    return fit_sizes(autopsy, size, order, error);
}

static enum status fit_shares(struct autopsy *autopsy, struct error *error)
{
    for (int k = 0; k < AUTOPSY_PARTS; k++) {
        double part[CASE_LADDER_MAX], share[CASE_LADDER_MAX];
        for (size_t l = 0; l < autopsy->count; l++) {
            const struct autopsy_level *level = &autopsy->levels[l];
            part[l] = level->share[k] * level->error[0];
            if (k < AUTOPSY_SHARES)
                share[l] = autopsy_share(level, (enum autopsy_share)k) * level->error[0];
        }
        if (fit_sizes(autopsy, part, &autopsy->losses[k], error) ||
            (k < AUTOPSY_SHARES && fit_sizes(autopsy, share, &autopsy->share_orders[k], error)))
            return error->status;
    }
    return STATUS_OK;
}

/* ---- cause ---- */

static size_t largest(const struct autopsy_level *level, const bool suspected[AUTOPSY_PARTS])
{
    size_t best = AUTOPSY_PARTS;
    for (size_t k = 0; k < AUTOPSY_PARTS; k++)
        if (suspected[k] && (best == AUTOPSY_PARTS || level->share[k] > level->share[best]))
            best = k;
    return best;
}

/* If the order is lost, suspects only the parts with an order below AUTOPSY_ORDER, if there are
 * any; else all parts. A part that vanishes at a level has no order. */
static void suspect(const struct autopsy *autopsy, bool suspected[AUTOPSY_PARTS])
{
    bool any = false;
    for (size_t k = 0; k < AUTOPSY_PARTS; k++) {
        suspected[k] = !autopsy->lost || autopsy->losses[k].order < AUTOPSY_ORDER;
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

/* A number of particles as users write it: 64^2. */
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
                 own = autopsy->losses[autopsy->cause].order;
    char from[32], at[32], order[48] = "";
    const char *seen = autopsy->theirs ? ", as far as snapshots tell, which do not show the time "
                                         "step and the viscosity"
                                       : "";
    number_text(autopsy->levels[autopsy->from].n, autopsy->dim, from);
    number_text(finest->n, autopsy->dim, at);
    if (isfinite(own) && own < 0) snprintf(order, sizeof order, " and does not fall itself");
    if (own >= 0) snprintf(order, sizeof order, " and falls with order %.2f itself", own);
    if (autopsy->theirs && !isfinite(autopsy->order.order))
        snprintf(autopsy->sentence, sizeof autopsy->sentence,
                 "The largest part of the error from %s on that a snapshot can tell is %s: %.0f %% "
                 "at %s (it shows neither the time step nor the viscosity; orders need %d of "
                 "different n).",
                 from, cause, part, at, ORDER_LEVELS_MIN);
    else if (autopsy->lost)
        snprintf(autopsy->sentence, sizeof autopsy->sentence,
                 "The order, %.2f, is lost to %s from %s on: it is %.0f %% of the error at %s%s%s.",
                 autopsy->order.order, cause, from, part, at, order, seen);
    else
        snprintf(autopsy->sentence, sizeof autopsy->sentence,
                 "No order is lost: it is %.2f. The largest part of the error from %s on is %s: "
                 "%.0f %% at %s%s%s%s.",
                 autopsy->order.order, from, cause, part, at, *order ? "; it" : "",
                 *order ? order + 4 : "", seen);
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
    if (fit_shares(autopsy, error)) return error->status;
    autopsy->lost = !(autopsy->order.order >= AUTOPSY_ORDER);
    blame(autopsy);
    speak(autopsy);
    return STATUS_OK;
}

/* ---- a ladder ---- */

static enum status resolve(const struct run_settings *settings, size_t n, struct run *run,
                           struct error *error)
{
    struct run_settings asked = *settings;
    char text[32];
    snprintf(text, sizeof text, "%zu", n);
    enum status status = settings_set(&asked.settings, SETTING_n, text, SOURCE_USER, NULL, error);
    if (!status) status = run_resolve(run, &asked, error);
    return status ? status : autopsy_check(run, error);
}

enum status autopsy_ladder(const struct run_settings *settings, const size_t *ladder, size_t count,
                           struct autopsy *autopsy, struct run *last, struct error *error)
{
    *autopsy = (struct autopsy){.dim = settings->file.dimension, .count = count};
    for (size_t l = 0; l < count; l++)
        if (resolve(settings, ladder[l], last, error)) return error->status;
    for (size_t l = 0; l < count; l++)
        if (resolve(settings, ladder[l], last, error) ||
            autopsy_measure(last, &autopsy->levels[l], l + 1 == count ? &autopsy->trace : NULL,
                            error))
            return error->status;
    return autopsy_judge(autopsy, error);
}

/* ---- output ---- */

static json_t *order_json(const struct order_fit *fit)
{
    return result_object("order=%g? low=%g? high=%g?", fit->order, fit->low, fit->high);
}

static json_t *parts_json(const struct autopsy_level *level)
{
    json_t *parts = json_object();
    for (size_t k = 0; k < AUTOPSY_PARTS; k++)
        json_object_set_new(parts, autopsy_part_family.members[k]->name,
                            result_object("size=%g noise=%g along=%g share=%g", level->size[k].rms,
                                          level->size[k].noise, level->size[k].along,
                                          level->share[k]));
    return parts;
}

static json_t *power_json(const struct autopsy_power power[AUTOPSY_TERMS])
{
    json_t *terms = json_object();
    for (size_t k = 0; k < AUTOPSY_TERMS; k++)
        json_object_set_new(terms, autopsy_term_family.members[k]->name,
                            result_object("work=%g heat=%g scale=%g", power[k].work, power[k].heat,
                                          power[k].scale));
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
    json_t *object = result_object("n=%d parts=%p power=%p regularity=%p", (int)level->n,
                                   (void *)parts_json(level), (void *)power_json(level->power),
                                   (void *)trace_regularity_json(&level->regularity));
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        json_object_set_new(object, numbers[k].name, result_number(numbers[k].value));
    return object;
}

/* Shares level by level, by n; for snapshots without the unknown ones. */
static json_t *shares_json(const struct autopsy *autopsy)
{
    json_t *shares = json_array();
    for (size_t l = 0; l < autopsy->count; l++)
        for (int k = 0; k < AUTOPSY_SHARES; k++) {
            const struct autopsy_level *level = &autopsy->levels[l];
            const double share = autopsy_share(level, (enum autopsy_share)k);
            if (autopsy->theirs && (k == AUTOPSY_OF_VISCOSITY || k == AUTOPSY_OF_TIME_STEP))
                continue;
            json_t *entry = order_json(&autopsy->share_orders[k]);
            result_add(entry, "part=%s n=%zu share=%g error=%g",
                       autopsy_share_family.members[k]->name, level->n, share,
                       share * level->error[0]);
            json_array_append_new(shares, entry);
        }
    return shares;
}

void autopsy_add_case(const struct run *finest, const struct autopsy *autopsy, json_t *document)
{
    json_t *levels = json_array(), *orders = json_object();
    result_add(document, "case=%s title=%s settings=%p", finest->asked.file.name,
               finest->asked.file.title, (void *)settings_json(&finest->settings));
    for (size_t l = 0; l < autopsy->count; l++)
        json_array_append_new(levels, level_json(&autopsy->levels[l]));
    json_object_set_new(orders, "error", order_json(&autopsy->order));
    json_object_set_new(orders, "regular", order_json(&autopsy->regular));
    json_object_set_new(orders, "own", order_json(&autopsy->own));
    json_object_set_new(orders, "jittered", order_json(&autopsy->jittered));
    for (size_t k = 0; k < AUTOPSY_PARTS; k++)
        json_object_set_new(orders, autopsy_part_family.members[k]->name,
                            order_json(&autopsy->orders[k]));
    result_add(document, "dim=%d shares=%p levels=%p orders=%p", autopsy->dim,
               (void *)shares_json(autopsy), (void *)levels, (void *)orders);
    if (!autopsy->theirs)
        json_object_set_new(document, "trace", trace_json(&autopsy->trace, autopsy->dim));
    result_add(document, "lost=%d? cause=%s floor=%d? from=%zu sentence=%s", autopsy->lost,
               autopsy_part_family.members[autopsy->cause]->name, autopsy->floor,
               autopsy->levels[autopsy->from].n, autopsy->sentence);
}
