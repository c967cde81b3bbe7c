/* SPDX-License-Identifier: GPL-3.0-or-later
 * Functions shared by the files of the public library: they translate between its names and those
 * of the internal libraries. */
#pragma once

#include "kernel.h"
#include "simulation.h"
#include "sphproof/common.h"
#include "sphproof/kernels.h"
#include "sphproof/simulations.h"

struct sphproof_kernel {
    struct kernel kernel;
    int dim; /* the only dimension; 0: all */
    bool negative, single, found_class;
};

/* Copies an error to the caller's; theirs may be NULL. Returns the status. */
enum sphproof_status library_pass(enum status status, const struct error *ours,
                                  struct sphproof_error *theirs);

/* Sets an error of our own and returns its status. */
enum sphproof_status library_fail(struct sphproof_error *theirs, enum status status,
                                  const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Passes figures to the user's sink, counts failures and keeps the first one in error. */
struct library_figures {
    sphproof_figure_sink *sink; /* may be NULL */
    void *context;
    size_t failed;
    struct sphproof_error *error;
};
void library_figure(struct library_figures *figures, const struct sphproof_figure *figure);

/* Fills the solver's setup with the caller's arrays. rest: an array of n zeros, used for velocities
 * that are not given. */
enum sphproof_status library_setup(const struct sphproof_setup *theirs, bool sharp,
                                   const double *rest, struct setup *setup,
                                   struct sphproof_error *error);
