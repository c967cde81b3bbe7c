/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particles from a CSV file: columns x[,y[,z]], vx[,vy[,vz]], m, u in any order; the header
 * determines the dimension. */
#pragma once

#include "csv.h"
#include "simulation.h"

struct initial;
struct prepared;

struct particle_file {
    struct csv csv;
    int dim;
    const double *x[3], *v[3], *m, *u; /* csv.rows each; point into csv */
    const double *rho;                 /* the same; NULL: no such column */
    char ignored[160];                 /* other columns, "a b c" */
};

/* STATUS_BAD_INPUT: the message names file, line and column. Free with particle_file_free, also
 * after a failure. */
enum status particle_file_read(const char *path, struct particle_file *file, struct error *error);

/* The same from the columns of file->csv. */
enum status particle_file_of(const char *path, struct particle_file *file, struct error *error);
void particle_file_free(struct particle_file *file);

/* Fills a setup whose box and boundary are set. An open direction with lo = hi gets a box around
 * the particles. STATUS_BAD_INPUT: a particle is outside the box. */
enum status particle_file_fill(const struct particle_file *file, const char *path,
                               struct setup *setup, struct error *error);

/* Uses the particles of the settings' file as the initial state of a problem. rho, the initial
 * guess and the density of layers at fixed ends, comes from the problem, else from a column rho,
 * else, without layers, from the mean. STATUS_BAD_INPUT: another dimension, a particle outside the
 * box, or layers without rho. */
enum status particle_file_start(const char *path, const struct prepared *p, struct initial *initial,
                                struct error *error);
