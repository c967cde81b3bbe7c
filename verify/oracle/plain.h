/* SPDX-License-Identifier: GPL-3.0-or-later
 * The baseline of the benchmark: the corrected method of the seed program (cubic spline, standard
 * gradient, vanilla_ice, constant or no viscosity, energy internal, h by Newton, modified leapfrog)
 * as one writes it first: double precision, one particle after the other, neighbours left and right
 * in sorted order, nothing vectorised or left out. Shares types with src, but no code. */
#pragma once

#include "simulation.h"

struct plain_particle;

struct plain {
    struct plain_particle *all, *particles; /* with images at both ends; without */
    double *arrays;                         /* of the snapshot */
    size_t n, ghosts;
    double lo, period, gamma, time, time_step;
    const struct scheme *scheme; /* the setup's */
    struct simulation_cost cost;
    struct conservation start, end; /* 1D; sums at t = 0 and now */
};

/* Runs a 1D setup to its t_end, counting costs as src does. STATUS_BAD_INPUT: a scheme other than
 * the above; STATUS_BROKE_DOWN: no sound state. Free with plain_free, also after a failure; the
 * setup must live as long. */
enum status plain_run(struct plain *plain, const struct setup *setup, struct error *error);
void plain_free(struct plain *plain);

/* The state: arrays belong to plain, positions wrapped into the box, rising; id is NULL. */
void plain_snapshot(const struct plain *plain, struct snapshot *snapshot);
