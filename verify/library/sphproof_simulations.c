/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sphproof/simulations.h"

#include <stdlib.h>
#include <string.h>

#include "library.h"
#include "settings.h"

struct sphproof_simulation {
    struct simulation *simulation;
    int dim;
    double time;
};

/* Makes the scheme from the keys, which may set nothing but the scheme. */
static enum status take_keys(const struct sphproof_setup *theirs, bool sharp, struct scheme *scheme,
                             struct error *error)
{
    struct settings settings;
    settings_init(&settings);
    for (const char *const *key = theirs->keys; key && *key; key++) {
        char *argument = strdup(*key);
        if (!argument) return error_set(error, STATUS_ENVIRONMENT, "no memory");
        const enum status status = settings_apply(&settings, 1, &argument, error);
        free(argument);
        if (status) return status;
    }
    for (int k = 0; k < SETTINGS; k++)
        if (settings.value[k].source == SOURCE_USER && strcmp(setting_keys[k].section, "scheme"))
            return error_set(error, STATUS_BAD_INPUT,
                             "%s is no key of a scheme: the setup itself says what is computed",
                             setting_keys[k].name);
    enum status status = STATUS_OK;
    if (sharp && settings.value[SETTING_h_tolerance].source == SOURCE_FALLBACK)
        status =
            settings_set(&settings, SETTING_h_tolerance, "1e-14", SOURCE_FALLBACK, NULL, error);
    return status ? status : settings_scheme(&settings, theirs->dim, scheme, error);
}

static enum status take_boundary(const char *name, enum boundary *boundary, struct error *error)
{
    const int at = family_index(&scheme_boundary_family, name ? name : "periodic");
    if (at < 0 || at == BOUNDARY_FIXED)
        return error_set(
            error, STATUS_BAD_INPUT, "boundary '%.40s': allowed: periodic open reflecting%s", name,
            at == BOUNDARY_FIXED ? "; fixed layers need densities, which a setup does not have"
                                 : "");
    *boundary = (enum boundary)at;
    return STATUS_OK;
}

static enum status take_setup(const struct sphproof_setup *theirs, bool sharp, const double *rest,
                              struct setup *setup, struct error *error)
{
    *setup = (struct setup){.dim = theirs->dim,
                            .gamma = theirs->gamma,
                            .n = theirs->n,
                            .m = theirs->m,
                            .u = theirs->u,
                            .skip = !sharp,
                            .threads = theirs->threads};
    if (theirs->dim < 1 || theirs->dim > 3)
        return error_set(error, STATUS_BAD_INPUT, "dim = %d: allowed: 1, 2, 3", theirs->dim);
    if (!theirs->m || !theirs->u)
        return error_set(error, STATUS_BAD_INPUT, "a setup needs m and u of its particles");
    for (int a = 0; a < theirs->dim; a++) {
        if (!theirs->x[a])
            return error_set(error, STATUS_BAD_INPUT, "a setup in %dD needs x[%d]", theirs->dim, a);
        setup->x[a] = theirs->x[a];
        setup->v[a] = theirs->v[a] ? theirs->v[a] : rest;
        setup->lo[a] = theirs->lo[a], setup->hi[a] = theirs->hi[a];
        setup->gravity[a] = theirs->gravity[a];
        if (take_boundary(theirs->boundary[a], &setup->boundary[a], error)) return error->status;
        for (size_t i = 0; i < theirs->n && setup->boundary[a] != BOUNDARY_OPEN; i++)
            if (!(setup->x[a][i] >= setup->lo[a] && setup->x[a][i] <= setup->hi[a]))
                return error_set(error, STATUS_BAD_INPUT,
                                 "particle %zu: x[%d] = %.9g: allowed: in the box, %.9g to %.9g", i,
                                 a, setup->x[a][i], setup->lo[a], setup->hi[a]);
    }
    return take_keys(theirs, sharp, &setup->scheme, error);
}

enum sphproof_status library_setup(const struct sphproof_setup *theirs, bool sharp,
                                   const double *rest, struct setup *setup,
                                   struct sphproof_error *error)
{
    struct error ours;
    return library_pass(take_setup(theirs, sharp, rest, setup, &ours), &ours, error);
}

enum sphproof_status sphproof_simulations_create(const struct sphproof_setup *theirs,
                                                 struct sphproof_simulation **simulation,
                                                 struct sphproof_error *error)
{
    struct setup setup;
    struct error ours;
    double *rest = calloc(theirs->n, sizeof *rest);
    struct sphproof_simulation *made = calloc(1, sizeof *made);
    enum sphproof_status status = SPHPROOF_OK;
    *simulation = NULL;
    if (!rest || !made)
        status = library_fail(error, STATUS_ENVIRONMENT, "no memory for %zu particles", theirs->n);
    if (!status) status = library_setup(theirs, false, rest, &setup, error);
    if (!status)
        status = library_pass(simulation_create(&setup, &made->simulation, &ours), &ours, error);
    free(rest);
    if (status) {
        free(made);
        return status;
    }
    made->dim = setup.dim;
    *simulation = made;
    return SPHPROOF_OK;
}

enum sphproof_status sphproof_simulations_run(struct sphproof_simulation *simulation, double t,
                                              struct sphproof_error *error)
{
    struct error ours;
    struct snapshot s;
    if (!(t >= simulation->time) || !(t <= 1e300))
        return library_fail(error, STATUS_BAD_INPUT, "t = %g: allowed: %g or later", t,
                            simulation->time);
    const enum status status = simulation_run(simulation->simulation, t, NULL, NULL, &ours);
    simulation_snapshot(simulation->simulation, &s);
    simulation->time = s.time;
    return library_pass(status, &ours, error);
}

/* Copies from the solver's order to the setup's. */
static void put(double *to, const double *from, const struct snapshot *s)
{
    for (size_t k = 0; to && k < s->n; k++) to[s->id[k]] = from[k];
}

double sphproof_simulations_state(const struct sphproof_simulation *simulation,
                                  const struct sphproof_state *state)
{
    struct snapshot s;
    simulation_snapshot(simulation->simulation, &s);
    for (int a = 0; a < simulation->dim; a++) {
        put(state->x[a], s.x[a], &s);
        put(state->v[a], s.v[a], &s);
    }
    put(state->rho, s.rho, &s);
    put(state->u, s.u, &s);
    put(state->P, s.P, &s);
    put(state->h, s.h, &s);
    return s.time;
}

struct sphproof_sums sphproof_simulations_sums(const struct sphproof_simulation *simulation)
{
    struct conservation c;
    conservation_sums(simulation->simulation, &c);
    return (struct sphproof_sums){c.mass, {c.momentum[0], c.momentum[1], c.momentum[2]}, c.energy};
}

void sphproof_simulations_free(struct sphproof_simulation *simulation)
{
    if (!simulation) return;
    simulation_destroy(simulation->simulation);
    free(simulation);
}
