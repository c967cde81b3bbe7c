/* SPDX-License-Identifier: GPL-3.0-or-later
 * What sphproof run --plot draws: on a line profiles over the exact solution and the error of the
 * case's first field; in 2D maps of density, speed and the error of that field where it is known,
 * and beside them particles over the exact curve where the solution has one coordinate; in 3D the
 * same of a slice of two mean distances of particles through the middle of the box. */
#pragma once

#include "movie.h"
#include "run.h"

/* movie: gets the picture as its next frame; NULL: the picture goes to path. STATUS_ENVIRONMENT: no
 * gnuplot, no memory, or path cannot be written. */
enum status run_plot(const struct run_settings *settings, const struct run_result *result,
                     const char *path, struct movie *movie, struct error *error);
