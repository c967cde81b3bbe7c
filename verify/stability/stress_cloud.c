/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stress_part.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cases.h"
#include "lattice_waves.h"
#include "problem_list.h"

/* ---- columns: the available cases ---- */

enum { CASES_MAX = 64, KEYS = 64, USUAL = 1000, SMALL = 3000 };

const struct stress_entry *stress_clouds(void)
{
    static struct stress_entry entries[CASES_MAX + 1];
    static char keys[CASES_MAX][KEYS];
    size_t n = 0;
    if (entries[0].label) return entries;
    for (const struct case_builtin *builtin = case_builtins; builtin->name; builtin++) {
        struct case_file file;
        struct error error;
        if (n == CASES_MAX || case_load(&file, builtin->name, &error) || file.dimension == 1 ||
            problem_of(&file.settings)->liquid)
            continue;
        size_t size = (size_t)settings_real(&file.settings, SETTING_n);
        if (size > USUAL) size = USUAL;
        if (file.ladder_count) size = file.ladder[0];
        if (file.quick_count) size = file.quick[0];
        snprintf(keys[n], KEYS, "n=%zu", size);
        entries[n] = (struct stress_entry){builtin->name, keys[n], size > SMALL};
        n++;
    }
    return entries;
}

/* ---- runs of cases ---- */

/* Distance of the nearest neighbour, in the periodic box. */
static double nearest(const struct run_result *result, size_t i)
{
    const struct snapshot *s = &result->snapshot;
    const struct domain *domain = &result->problem.domain;
    double least = (double)INFINITY;
    for (size_t j = 0; j < s->n; j++) {
        double square = 0;
        if (j == i) continue;
        for (int d = 0; d < domain->dim; d++) {
            const double length = domain_length(domain, d);
            double x = s->x[d][j] - s->x[d][i];
            x -= length * nearbyint(x / length);
            square += x * x;
        }
        least = fmin(least, square);
    }
    return sqrt(least);
}

/* Fraction of particles whose nearest neighbour is closer than half the local spacing. */
static double paired(const struct run_result *result)
{
    const struct snapshot *s = &result->snapshot;
    const double dim = result->problem.domain.dim;
    size_t pairs = 0;
    for (size_t i = 0; i < s->n; i++)
        pairs += nearest(result, i) < 0.5 * pow(s->m[i] / s->rho[i], 1 / dim);
    return (double)pairs / (double)s->n;
}

static json_t *judge(const struct stress_cell *cell, const struct run_result *result,
                     const struct stress_watch *watch)
{
    char reason[STRESS_REASON] = "";
    json_t *unsound = stress_unsound(result, watch, (double)NAN);
    if (unsound) return unsound;
    const double pairs = paired(result);
    int used = 0;
    if (!(pairs <= cell->group->bound))
        used += snprintf(reason + used, sizeof reason - (size_t)used,
                         "%.2g of the particles are nearer to another one than half a spacing; ",
                         pairs);
    used = stress_conserved(result, reason, used);
    if (used) reason[used - 2] = '\0';
    return stress_outcome((double)NAN, pairs, used ? "inaccurate" : "ok", reason);
}

/* ---- lattices ---- */

/* Slower growth does not show in so short a noise run. */
const double stress_cloud_slowest = 0.02;

static enum status lattice_worst(const struct stress_cell *cell, struct lattice_wave *worst,
                                 int where[3], double *spacing, struct error *error)
{
    struct run_settings settings = cell->settings;
    struct lattice_waves lattice;
    stress_noise_set(&settings, SETTING_jitter, 0);
    settings.settings.value[SETTING_viscosity].choice = VISCOSITY_NONE;
    enum status status = lattice_waves_begin(&lattice, &settings, error);
    if (!status) status = lattice_waves_worst(&lattice, worst, where, error);
    *spacing = lattice.spacing;
    lattice_waves_free(&lattice);
    return status;
}

static enum status growth(const struct stress_cell *cell, json_t **document, struct error *error)
{
    struct lattice_wave worst;
    int where[3] = {0};
    double spacing;
    char reason[256];
    const struct run_settings *settings = &cell->settings;
    if (lattice_worst(cell, &worst, where, &spacing, error)) return error->status;
    if (worst.growth < stress_cloud_slowest) {
        const bool grows = stress_noise_grows(settings, 60);
        snprintf(reason, sizeof reason,
                 "no wave grows faster than %.2g c/dx; noise %s in 60 dx/c; greatest frequency "
                 "%.3f c/dx",
                 stress_cloud_slowest, grows ? "grows" : "does not grow", worst.frequency);
        *document = stress_outcome(worst.growth, (double)NAN, grows ? "inaccurate" : "ok", reason);
        return STATUS_OK;
    }
    const double half = 5 / worst.growth;
    const double early = stress_noise_after(*settings, half),
                 late = stress_noise_after(*settings, 2 * half);
    const double measured = log(late / early) / half;
    snprintf(reason, sizeof reason,
             "fastest with %d, %d, %d wavelengths across the box; noise grows from %.2g to %.2g c",
             where[0], where[1], where[2], early, late);
    *document =
        stress_outcome(worst.growth, measured,
                       fabs(measured / worst.growth - 1) <= 0.15 ? "ok" : "inaccurate", reason);
    return STATUS_OK;
}

/* Leapfrog's limit is 2/omega if forces depend on positions alone: without viscosity and with gamma
 * close to 1. Otherwise energies predicted with velocities let noise grow at a third of that step.
 * Noise runs measure the limits of all other schemes. */
static enum status time_step(const struct stress_cell *cell, json_t **document, struct error *error)
{
    enum { BISECTIONS = 6 };
    struct run_settings settings = cell->settings;
    struct lattice_wave worst;
    struct run run;
    int where[3];
    double spacing;
    char reason[256];
    if (lattice_worst(cell, &worst, where, &spacing, error) || run_resolve(&run, &settings, error))
        return error->status;
    const double h = run.scheme.eta * spacing; /* dt = cfl h/(2 c) in gas at rest */
    double low = 0, high = 5 / worst.frequency;
    for (int i = 0; i < BISECTIONS; i++) {
        const double middle = 0.5 * (low + high); /* c dt/dx */
        stress_noise_set(&settings, SETTING_cfl, 2 * middle * spacing / h);
        *(stress_noise_grows(&settings, 200) ? &high : &low) = middle;
    }
    const double measured = 0.5 * (low + high), limit = 2 / worst.frequency;
    const bool known = !strcmp(cell->row.label, "leapfrog") &&
                       run.scheme.viscosity == VISCOSITY_NONE &&
                       settings_real(&settings.settings, SETTING_gamma) < 1.001;
    const bool good = !known || fabs(measured / limit - 1) <= 0.1;
    snprintf(reason, sizeof reason,
             "c dt/dx; the greatest frequency of the lattice is %.3f c/dx, leapfrog's limit %.3f",
             worst.frequency, limit);
    *document =
        stress_outcome(known ? limit : (double)NAN, measured, good ? "ok" : "inaccurate", reason);
    return STATUS_OK;
}

enum status stress_cloud(const struct stress_cell *cell, json_t **document, struct error *error)
{
    if (cell->group->kind == STRESS_CLOUD) return stress_execute(cell, judge, document, error);
    return cell->group->kind == STRESS_LATTICE ? growth(cell, document, error)
                                               : time_step(cell, document, error);
}
