/* SPDX-License-Identifier: GPL-3.0-or-later
 * Writes a plot to a file, completely or not at all. */
#pragma once

#include "plot.h"
#include "status.h"

/* STATUS_BAD_INPUT: path does not end in .svg or .png. STATUS_ENVIRONMENT: it cannot be written. */
enum status picture_probe(const char *path, struct error *error);

/* Draws plot to path. STATUS_ENVIRONMENT: no gnuplot, it failed, or the file cannot be written. */
enum status picture_write(const struct plot *plot, const char *path, struct error *error);

/* Writes NAME.dat and NAME.gp beside a picture NAME.svg or NAME.png; `gnuplot NAME.gp` in that
 * folder draws NAME.svg again. STATUS_ENVIRONMENT: they cannot be written. */
enum status picture_source(const struct plot *plot, const char *path, struct error *error);
