/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particles from a CSV file: columns x[,y[,z]], vx[,vy[,vz]], m, u in any order; the header gives
 * the dimension. */
#pragma once

#include "csv.h"
#include "simulation.h"

struct initial;
struct prepared;

struct particle_file {
    struct csv csv;
    int dim;
    const double *x[3], *v[3], *m, *u; /* csv.rows each, into csv */
    const double *rho;                 /* the same; NULL: there is no such column */
    char ignored[160];                 /* other columns, "a b c" */
};

/* STATUS_BAD_INPUT: file, line and column of what is wrong. Free with particle_file_free, also
 * after a failure. */
enum status particle_file_read(const char *path, struct particle_file *file, struct error *error);

/* The same of columns that are there: file->csv. */
enum status particle_file_of(const char *path, struct particle_file *file, struct error *error);
void particle_file_free(struct particle_file *file);

/* The particles as a setup's, whose box and boundary are set: an open direction without a box (lo =
 * hi) gets one around them. STATUS_BAD_INPUT: one is outside. */
enum status particle_file_fill(const struct particle_file *file, const char *path,
                               struct setup *setup, struct error *error);

/* The particles of the settings' file as the start of a problem; rho, a first
 * guess and the density of layers at fixed ends: what the problem knows, else a column rho, else,
 * without layers, their mean. STATUS_BAD_INPUT:
 * another dimension, a particle outside of the box, no rho for layers. */
enum status particle_file_start(const char *path, const struct prepared *p, struct initial *initial,
                                struct error *error);
