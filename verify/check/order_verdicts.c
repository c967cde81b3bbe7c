/* SPDX-License-Identifier: GPL-3.0-or-later
 * Verdicts on an order: whether it passes its gate, and the class of the errors. */
#include <math.h>

#include "check.h"
#include "order.h"

enum { LEVELS = 5 };

typedef bool gate_function(const struct order_fit *fit, const struct order_gate *gate, char *why);

struct gate_subject {
    gate_function *passes;
};

static void measure_gate(struct check_run *run, const void *subject)
{
    static const struct gate_subject right = {order_passes};
    gate_function *passes = (subject ? (const struct gate_subject *)subject : &right)->passes;
    const double nan = (double)NAN, inf = (double)INFINITY;
    const struct order_gate gate = {0.9, 1.05, 2e-3};
    const struct {
        const char *what;
        bool expected;
        struct order_fit fit;
    } cases[] = {
        {"inside, narrow, small", true, {.order = 1, .low = 0.95, .high = 1.05, .finest = 1e-3}},
        {"on every limit", true, {.order = 1.05, .low = 0.9, .high = 1.2, .finest = 2e-3}},
        {"order too low", false, {.order = 0.89, .low = 0.85, .high = 0.93, .finest = 1e-3}},
        {"order too high", false, {.order = 1.06, .low = 1.05, .high = 1.07, .finest = 1e-3}},
        {"order on its lower limit", true, {.order = 0.9, .high = 2 * ORDER_HALF_WIDTH_MAX}},
        {"interval a little too wide",
         false,
         {.order = 1, .high = 2.000001 * ORDER_HALF_WIDTH_MAX}},
        {"interval too wide", false, {.order = 1, .low = 0.84, .high = 1.16, .finest = 1e-3}},
        {"error too large", false, {.order = 1, .low = 0.99, .high = 1.01, .finest = 2.1e-3}},
        {"all NaN", false, {.order = nan, .low = nan, .high = nan, .finest = nan}},
        {"order NaN", false, {.order = nan, .low = 0.99, .high = 1.01, .finest = 1e-3}},
        {"interval NaN", false, {.order = 1, .low = nan, .high = 1.01, .finest = 1e-3}},
        {"error NaN", false, {.order = 1, .low = 0.99, .high = 1.01, .finest = nan}},
        {"interval infinite", false, {.order = 1, .low = -inf, .high = inf, .finest = 1e-3}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        check_measure(run, passes(&cases[i].fit, &gate, NULL) != cases[i].expected, 0, 0, "%s",
                      cases[i].what);
}

static bool gate_passes_nan(const struct order_fit *fit, const struct order_gate *gate, char *why)
{
    (void)why;
    return !(fit->order < gate->low || fit->order > gate->high ||
             fit->high - fit->low > 2 * ORDER_HALF_WIDTH_MAX || fit->finest > gate->bound);
}

static bool gate_without_width(const struct order_fit *fit, const struct order_gate *gate,
                               char *why)
{
    (void)why;
    return gate->low <= fit->order && fit->order <= gate->high && fit->finest <= gate->bound;
}

static bool gate_without_bound(const struct order_fit *fit, const struct order_gate *gate,
                               char *why)
{
    (void)why;
    return gate->low <= fit->order && fit->order <= gate->high &&
           fit->high - fit->low <= 2 * ORDER_HALF_WIDTH_MAX;
}

static bool gate_one_sided(const struct order_fit *fit, const struct order_gate *gate, char *why)
{
    struct order_gate open = *gate;
    open.high = (double)INFINITY;
    return order_passes(fit, &open, why);
}

static bool gate_by_overlap(const struct order_fit *fit, const struct order_gate *gate, char *why)
{
    (void)why;
    return fit->low <= gate->high && fit->high >= gate->low && fit->finest <= gate->bound;
}

static const struct check_mutant gate_mutants[] = {
    {"gate_passes_nan", "comparisons written so that NaN passes",
     &(struct gate_subject){gate_passes_nan}},
    {"gate_without_width", "any interval is good enough",
     &(struct gate_subject){gate_without_width}},
    {"gate_without_bound", "any error at the finest level is good enough",
     &(struct gate_subject){gate_without_bound}},
    {"gate_one_sided", "an order too high passes", &(struct gate_subject){gate_one_sided}},
    {"gate_by_overlap", "the interval only has to touch the gate",
     &(struct gate_subject){gate_by_overlap}},
    {0},
};

CHECK_DEFINE(norms, gate, 650,
             .property = "order inside AND half-width <= 0.15 AND finest error <= bound; NaN fails",
             .measure = measure_gate, .mutants = gate_mutants);

typedef enum status fit_function(size_t n, const double *spacing, const double *error,
                                 const struct order_noise *noise, struct order_fit *fit,
                                 struct error *failure);

struct class_subject {
    fit_function *fit;
};

static void measure_class(struct check_run *run, const void *subject)
{
    static const struct class_subject right = {order_fit};
    fit_function *fit = (subject ? (const struct class_subject *)subject : &right)->fit;
    static const double spacing[LEVELS] = {1, 0.5, 0.25, 0.125, 0.0625};
    static const struct {
        enum order_class class;
        double error[LEVELS];
    } cases[] = {
        {ORDER_ASYMPTOTIC, {16, 8, 4, 2, 1}},
        {ORDER_ASYMPTOTIC, {16, 11, 7.6, 5.2, 3.6}},
        {ORDER_FLOOR_LIMITED, {16, 8, 4, 3.6, 3.5}},
        {ORDER_FLOOR_LIMITED, {16, 8, 4, 3.6, 3.7}},
        {ORDER_FLOOR_LIMITED, {5.13, 5.12, 5.11, 5.1, 5.09}}, /* at the floor from the start */
        {ORDER_FLOOR_LIMITED, {5.13, 5.13, 5.13, 5.13, 5.13}},
        {ORDER_FLOOR_LIMITED, {5.13, 5.131, 5.13, 5.131, 5.1301}},
        {ORDER_OSCILLATING, {16, 4, 8, 1, 2}},
        {ORDER_DIVERGING, {1, 2, 4, 8, 16}},
        {ORDER_DIVERGING, {4, 2, 1, 0.5, (double)NAN}},
        {ORDER_DIVERGING, {4, (double)NAN, 1, 0.5, 0.25}},
        {ORDER_DIVERGING, {4, 2, 1, 0.5, 0}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const double *e = cases[k].error;
        struct order_fit got;
        fit(LEVELS, spacing, e, NULL, &got, NULL);
        check_measure(run, got.class != cases[k].class, 0, 0, "errors %g %g %g %g %g: %s", e[0],
                      e[1], e[2], e[3], e[4], order_class_name(cases[k].class));
    }
}

/* Mutant: every error that falls from level to level, however little, converges. */
static enum status floor_converges(size_t n, const double *spacing, const double *error,
                                   const struct order_noise *noise, struct order_fit *fit,
                                   struct error *failure)
{
    const enum status status = order_fit(n, spacing, error, noise, fit, failure);
    bool falls = true;
    for (size_t i = 1; i < n; i++) falls = falls && error[i] < error[i - 1] && error[i] > 0;
    if (falls) fit->class = ORDER_ASYMPTOTIC;
    return status;
}

static enum status constant_diverges(size_t n, const double *spacing, const double *error,
                                     const struct order_noise *noise, struct order_fit *fit,
                                     struct error *failure)
{
    const enum status status = order_fit(n, spacing, error, noise, fit, failure);
    if (!(error[n - 1] < error[0])) fit->class = ORDER_DIVERGING;
    return status;
}

static enum status nan_is_flat(size_t n, const double *spacing, const double *error,
                               const struct order_noise *noise, struct order_fit *fit,
                               struct error *failure)
{
    const enum status status = order_fit(n, spacing, error, noise, fit, failure);
    if (isnan(fit->order)) fit->class = ORDER_FLOOR_LIMITED;
    return status;
}

static const struct check_mutant class_mutants[] = {
    {"class_floor_converges", "errors that hardly fall are called asymptotic",
     &(struct class_subject){floor_converges}},
    {"class_constant_diverges", "errors that stay where they are are called diverging",
     &(struct class_subject){constant_diverges}},
    {"class_of_nan", "a NaN has a class of its own making", &(struct class_subject){nan_is_flat}},
    {0},
};

CHECK_DEFINE(norms, order_class, 650,
             .property = "errors that fall are asymptotic, those on a floor or NaN are not",
             .measure = measure_class, .mutants = class_mutants);
