/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particles at t = 0: functions for a problem's fill, and the initial state of a run. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "settings.h"
#include "status.h"

struct prepared;

struct initial {
    int dim;
    size_t n;
    double *x[3], *v[3]; /* n each for d < dim, else NULL; in 1D x increases unless it was read from
                            a file; code units */
    double *m, *u, *rho; /* n each */
    double *storage;
    char ignored[160]; /* ignored columns of a file, "a b c" */
};

/* For a problem's fill: allocates memory for n particles. STATUS_ENVIRONMENT: no memory. */
enum status initial_allocate(struct initial *initial, int dim, size_t n, struct error *error);

/* For a problem's fill: places particles on the planned lattice over a box in which the problem has
 * one gas, starting at index `first`; lattice_plan_make gives their number. The masses follow from
 * the sample's density and equal volumes. Returns as lattice_points. */
struct lattice_plan;
enum status initial_lay(struct initial *initial, const struct prepared *p,
                        const struct lattice_plan *plan, size_t first,
                        const struct settings *settings, struct error *error);

/* For a problem's fill: keeps the first `first` particles and, of the others, those that are
 * wanted, in order. Updates the number of particles. */
typedef bool initial_wanted(const void *context, const double x[3]);
void initial_keep(struct initial *initial, size_t first, initial_wanted *wanted,
                  const void *context);

/* Sets the initial guess of the state of particle i from the sample; does not change the mass. */
void initial_sample(struct initial *initial, const struct prepared *p, size_t i);

/* Implements a problem's fill for the whole domain: equal spacing and masses that follow the
 * density. With equal_masses=yes, for problems that read this key: equal masses and positions that
 * follow the density. */
enum status initial_fill(const struct prepared *p, const struct settings *settings,
                         struct initial *initial, struct error *error);

/* Implements a problem's fill for a ball (disc, interval) in the middle of the domain, of about n
 * particles. */
enum status initial_fill_ball(const struct prepared *p, const struct settings *settings,
                              double radius, struct initial *initial, struct error *error);

/* The particles of a prepared problem or of a file, displaced as the keys lattice and jitter ask;
 * settings: resolved. STATUS_BAD_INPUT: the problem cannot fill its domain with them. */
enum status initial_create(struct initial *initial, const struct prepared *p,
                           const struct settings *settings, struct error *error);

void initial_free(struct initial *initial);
