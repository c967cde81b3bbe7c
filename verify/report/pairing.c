/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "claims.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "result.h"
#include "value.h"

enum { LADDER_MAX = 13 /* with a 0 at its end */, TEXT = 256 };

/* Particles start up to 0.4 spacings from a lattice and come to rest by plain viscosity. */
static const char *const usual = "jitter=0.4 viscosity=constant";
/* Largest share of particles with a neighbour closer than half a spacing. */
static const double bound = 0.01;

/* Runs of every kernel with one gradient in one dimension, from few neighbours to many. */
static const struct crowd {
    int dim;
    const char *gradient, *case_name;
    const char *day, *night;                      /* sizes */
    int by_day[LADDER_MAX], by_night[LADDER_MAX]; /* numbers of neighbours; 0 ends */
} crowds[] = {
    {2,
     "standard",
     "rest_2d",
     "n=16^2 t_end=3",
     "n=32^2 t_end=8",
     {16, 36, 54, 80, 110},
     {12, 16, 20, 24, 30, 36, 44, 54, 66, 80, 110, 140}},
    {3,
     "standard",
     "rest_3d",
     "n=8^3 t_end=1.5",
     "n=13^3 t_end=3",
     {60, 100, 160},
     {40, 60, 80, 110, 160, 220, 320, 450}},
    {2,
     "ia",
     "rest_2d",
     "n=16^2 t_end=3",
     "n=32^2 t_end=8",
     {36, 54, 80, 110},
     {16, 20, 24, 30, 36, 44, 54, 66, 80, 110, 140}},
    {3, "ia", "rest_3d", "", "n=13^3 t_end=3", {0}, {60, 110, 160, 220, 320, 450}},
    {2, "corrected", "rest_2d", "", "n=32^2 t_end=8", {0}, {16, 24, 36, 54, 80, 110, 140}},
};
enum { CROWDS = sizeof crowds / sizeof *crowds };

struct pairing_run {
    const struct crowd *crowd;
    const char *kernel; /* its name, a static string */
    int neighbours;
    struct claim_run run;
};

static enum status plan_run(struct pairing_run *of, bool nightly, struct pool *pool,
                            struct error *error)
{
    const struct crowd *crowd = of->crowd;
    const double eta =
        crowd->dim == 2 ? sqrt(of->neighbours / M_PI) : cbrt(0.75 * of->neighbours / M_PI);
    snprintf(of->run.keys, sizeof of->run.keys, "%s %s kernel=%s gradient=%s eta=%.4g",
             nightly ? crowd->night : crowd->day, usual, of->kernel, crowd->gradient, eta);
    return claim_run_add(&of->run, crowd->case_name, pool, error);
}

enum status pairing_plan(struct pairing *pairing, bool nightly, struct pool *pool,
                         struct error *error)
{
    pairing->runs = calloc(CROWDS * kernel_family.n * LADDER_MAX, sizeof *pairing->runs);
    if (!pairing->runs) return error_set(error, STATUS_ENVIRONMENT, "no memory for pairing");
    for (size_t c = 0; c < CROWDS; c++) {
        const struct crowd *crowd = &crowds[c];
        const int *ladder = nightly ? crowd->by_night : crowd->by_day;
        for (size_t k = 0; k < kernel_family.n; k++)
            for (const int *neighbours = ladder; *neighbours; neighbours++) {
                struct pairing_run *of = &pairing->runs[pairing->count++];
                of->crowd = crowd;
                of->kernel = kernel_family.members[k]->name;
                of->neighbours = *neighbours;
                if (plan_run(of, nightly, pool, error)) return error->status;
            }
    }
    return STATUS_OK;
}

/* ---- results ---- */

/* Results of one kernel in one crowd. */
struct ladder {
    const struct pairing_run *runs;
    size_t count, sound, first /* first with pairs; count: none */;
    double paired[LADDER_MAX], nearest[LADDER_MAX];
    bool known;                 /* predictions of the theory: */
    double predicted, negative; /* NaN: never or nowhere */
};

/* Reads a kernel's runs; behind the last of all there is an empty one. */
static struct ladder ladder_read(const struct pairing_run *runs, const struct pool *pool,
                                 const json_t *kernels)
{
    struct ladder ladder = {.runs = runs, .predicted = (double)NAN, .negative = (double)NAN};
    const json_t *kernel;
    size_t i;
    while (runs[ladder.count].crowd == runs->crowd &&
           strcmp(runs[ladder.count].kernel, runs->kernel) == 0) {
        const json_t *document = pool->jobs[runs[ladder.count].run.job].document;
        const json_t *found = json_object_get(document, "regularity");
        const bool sound = found && strcmp(value_text(document, "status"), "ok") == 0;
        ladder.paired[ladder.count] = sound ? value_member(found, "paired") : (double)NAN;
        ladder.nearest[ladder.count] = sound ? value_member(found, "nearest") : (double)NAN;
        ladder.sound += sound;
        if (ladder.first == ladder.count && !(ladder.paired[ladder.count] > bound)) ladder.first++;
        ladder.count++;
    }
    json_array_foreach(kernels, i, kernel) {
        if (strcmp(value_text(kernel, "kernel"), runs->kernel) != 0 ||
            (int)value_member(kernel, "dim") != runs->crowd->dim)
            continue;
        const json_t *fourier = json_object_get(kernel, "fourier");
        ladder.known = true;
        ladder.predicted = value_real(json_object_get(kernel, "pairing_neighbours"));
        ladder.negative = value_real(json_object_get(fourier, "first_negative_kh"));
    }
    return ladder;
}

static void ladder_verdict(const struct ladder *ladder, char *verdict, size_t size)
{
    const bool pairs = ladder->first < ladder->count;
    const int first = pairs ? ladder->runs[ladder->first].neighbours : 0;
    const int last = ladder->runs[ladder->count - 1].neighbours;
    if (!ladder->sound)
        snprintf(verdict, size, "all runs broke down");
    else if (!pairs && ladder->sound < ladder->count)
        snprintf(verdict, size, "no pairs in %zu of %zu runs, others broke down", ladder->sound,
                 ladder->count);
    else if (!pairs)
        snprintf(verdict, size, "no pairs up to %d", last);
    else if (isnan(ladder->predicted))
        snprintf(verdict, size, "pairs from %d on, against its transform", first);
    else
        snprintf(verdict, size, "pairs from %d on%s", first,
                 first < ladder->predicted ? ", before theory has them" : "");
}

static json_t *ladder_json(const struct ladder *ladder, const char *verdict)
{
    const struct pairing_run *runs = ladder->runs;
    json_t *neighbours = json_array();
    char command[TEXT + 64];
    for (size_t i = 0; i < ladder->count; i++)
        json_array_append_new(neighbours, json_integer(runs[i].neighbours));
    const size_t shown = ladder->first < ladder->count ? ladder->first : ladder->count - 1;
    snprintf(command, sizeof command, "sphproof run %s %s", runs->crowd->case_name,
             runs[shown].run.keys);
    return result_object("kernel=%s dim=%d first_negative_kh=%g? predicted=%g? neighbours=%p "
                         "paired=%p nearest=%p verdict=%s reproduce=%s",
                         runs->kernel, runs->crowd->dim, ladder->negative, ladder->predicted,
                         (void *)neighbours, (void *)result_numbers(ladder->paired, ladder->count),
                         (void *)result_numbers(ladder->nearest, ladder->count), verdict, command);
}

/* What the ladders of a gradient say about the claim. */
struct balance {
    bool kept, broken, others; /* kernels without a negative transform, without and with pairs;
                                  others with pairs */
    bool unknown;              /* no negative transform and no pairs, but runs broke down */
    char worst[TEXT];          /* the first ladder that breaks the claim */
};

static void balance_add(struct balance *balance, const struct ladder *ladder)
{
    const bool pairs = ladder->first < ladder->count, whole = ladder->sound == ladder->count;
    if (!ladder->known) return;
    if (!isnan(ladder->negative)) {
        balance->others |= pairs;
    } else if (!pairs) {
        balance->kept |= whole;
        balance->unknown |= !whole;
    } else if (!balance->broken) {
        balance->broken = true;
        snprintf(balance->worst, TEXT, "%s in %dD has %.1f %% in pairs at %d neighbours",
                 ladder->runs->kernel, ladder->runs->crowd->dim,
                 100 * ladder->paired[ladder->first], ladder->runs[ladder->first].neighbours);
    }
}

static json_t *judge_gradient(const struct pairing *pairing, const char *gradient,
                              const struct pool *pool, const json_t *kernels)
{
    struct balance balance = {0};
    json_t *ladders = json_array();
    char name[64], text[TEXT], verdict[TEXT + 32];
    for (size_t i = 0; i < pairing->count;) {
        const struct ladder ladder = ladder_read(&pairing->runs[i], pool, kernels);
        i += ladder.count;
        if (strcmp(ladder.runs->crowd->gradient, gradient) != 0) continue;
        balance_add(&balance, &ladder);
        ladder_verdict(&ladder, verdict, sizeof verdict);
        json_array_append_new(ladders, ladder_json(&ladder, verdict));
    }
    snprintf(name, sizeof name, "wendland_pairing_%s", gradient);
    snprintf(text, sizeof text,
             "With the gradient %s, kernels whose Fourier transform is nowhere negative (Wendland "
             "functions) keep particles from pairing at any number of neighbours.",
             gradient);
    if (balance.broken)
        snprintf(verdict, sizeof verdict, "does not hold: %s", balance.worst);
    else if (balance.unknown)
        snprintf(verdict, sizeof verdict, "not shown: runs broke down");
    else
        snprintf(verdict, sizeof verdict, "%s",
                 !balance.kept     ? "not shown: no such kernel was certified"
                 : !balance.others ? "not shown: no other kernel has pairs"
                                   : "holds");
    return result_object("name=%s claim=%s verdict=%s bound=%g ladders=%p", name, text, verdict,
                         bound, (void *)ladders);
}

json_t *pairing_judge(const struct pairing *pairing, const struct pool *pool, const json_t *kernels)
{
    json_t *list = json_array();
    for (size_t i = 0; i < pairing->count; i++) {
        const char *gradient = pairing->runs[i].crowd->gradient;
        bool seen = false;
        for (size_t j = 0; j < i; j++)
            seen = seen || strcmp(pairing->runs[j].crowd->gradient, gradient) == 0;
        if (!seen) json_array_append_new(list, judge_gradient(pairing, gradient, pool, kernels));
    }
    return list;
}

void pairing_free(struct pairing *pairing)
{
    free(pairing->runs);
    *pairing = (struct pairing){0};
}
