/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particles at t = 0: what problems lay them with, and those that a run begins with. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "settings.h"
#include "status.h"

struct prepared;

struct initial {
    int dim;
    size_t n;
    double *x[3], *v[3]; /* n each where d < dim, else NULL; in 1D x rises unless it comes from a
                            file; code units */
    double *m, *u, *rho; /* n each */
    double *storage;
    char ignored[160]; /* columns of a file that are not read, "a b c" */
};

/* Room for n particles, for a problem's fill. STATUS_ENVIRONMENT: no memory. */
enum status initial_allocate(struct initial *initial, int dim, size_t n, struct error *error);

/* For a problem's fill: about n particles on the lattice of the settings over a box with one gas's
 * sample, from initial->x[.][first] on; their number is that of lattice_plan_make. Masses carry the
 * sample's density at equal volumes. STATUS_*: see lattice_points. */
struct lattice_plan;
enum status initial_lay(struct initial *initial, const struct prepared *p,
                        const struct lattice_plan *plan, size_t first,
                        const struct settings *settings, struct error *error);

/* For a problem's fill: keeps the first `first` particles and those after them that are wanted, in
 * their order; what is left is the new number. */
typedef bool initial_wanted(const void *context, const double x[3]);
void initial_keep(struct initial *initial, size_t first, initial_wanted *wanted,
                  const void *context);

/* Its first guess of the state of particle i: the sample's; the mass stays. */
void initial_sample(struct initial *initial, const struct prepared *p, size_t i);

/* A problem's whole fill, where all of the domain is laid so: equal spacing, masses that follow the
 * density; or, with equal_masses=yes of a problem that reads the key, equal masses at places that
 * follow it. */
enum status initial_fill(const struct prepared *p, const struct settings *settings,
                         struct initial *initial, struct error *error);

/* A problem's whole fill with a ball (a disc, an interval) in the middle of the domain: about n
 * particles. */
enum status initial_fill_ball(const struct prepared *p, const struct settings *settings,
                              double radius, struct initial *initial, struct error *error);

/* The particles of a prepared problem, its own or those of a file, moved as the keys lattice and
 * jitter ask; settings: resolved. STATUS_BAD_INPUT: the problem cannot fill its domain with them.
 */
enum status initial_create(struct initial *initial, const struct prepared *p,
                           const struct settings *settings, struct error *error);

void initial_free(struct initial *initial);

/* Are particles moved at random? Then the seed makes a difference. */
bool initial_is_shaken(const struct settings *settings);
