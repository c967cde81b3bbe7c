/* SPDX-License-Identifier: GPL-3.0-or-later
 * A plot into a file that appears whole or not at all. */
#ifndef SPHPROOF_PICTURE_H
#define SPHPROOF_PICTURE_H

#include "plot.h"
#include "status.h"

/* Could path become a picture: does it end in .svg or .png, can it be written? STATUS_BAD_INPUT,
 * STATUS_ENVIRONMENT. */
enum status picture_probe(const char *path, struct error *error);

/* Draws plot to path. STATUS_ENVIRONMENT: no gnuplot, it failed, or the file cannot be written. */
enum status picture_write(const struct plot *plot, const char *path, struct error *error);

/* Beside a picture NAME.svg or NAME.png what draws it again: NAME.dat, and NAME.gp, with which
 * `gnuplot NAME.gp` there makes NAME.svg. STATUS_ENVIRONMENT: they cannot be written. */
enum status picture_source(const struct plot *plot, const char *path, struct error *error);

#endif
