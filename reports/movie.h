/* SPDX-License-Identifier: GPL-3.0-or-later
 * Movies of plots, made by ffmpeg. Axes and colour scales without a fixed range cover all pictures
 * so far, so that they widen but never shrink. */
#pragma once

#include "buffer.h"
#include "plot.h"
#include "status.h"

enum { MOVIE_PANELS = 8, MOVIE_PICTURES_A_SECOND = 10 };

struct movie_range {
    double low, high;
};

struct movie { /* starts as zeros */
    struct buffer pictures;
    size_t count;
    struct movie_range range[MOVIE_PANELS];
};

/* True if the name ends in .gif or .mp4. */
bool movie_wanted(const char *path);

/* Checks that ffmpeg is installed and that path can be written. STATUS_ENVIRONMENT: one is not
 * so. */
enum status movie_probe(const char *path, struct error *error);

/* Adds a picture; all plots of a movie have the same size, and at most MOVIE_PANELS panels.
 * STATUS_ENVIRONMENT: it cannot be drawn. */
enum status movie_add(struct movie *movie, const struct plot *plot, struct error *error);

/* STATUS_ENVIRONMENT: ffmpeg failed, or the file cannot be written. */
enum status movie_write(const struct movie *movie, const char *path, struct error *error);
void movie_free(struct movie *movie);
