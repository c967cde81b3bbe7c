/* SPDX-License-Identifier: GPL-3.0-or-later
 * Plots one after the other as a movie, made by ffmpeg. Axes and colours without a range of their
 * own reach as far as in any picture so far, so that they widen but never jump back. */
#pragma once

#include "buffer.h"
#include "plot.h"
#include "status.h"

enum { MOVIE_PANELS = 8, MOVIE_PICTURES_A_SECOND = 10 };

struct movie_range {
    double low, high;
    bool known;
};

struct movie { /* begins as zeros */
    struct buffer pictures;
    size_t count;
    struct movie_range range[MOVIE_PANELS];
};

/* Does the name end in .gif or .mp4? */
bool movie_wanted(const char *path);

/* Could path become a movie: is ffmpeg there, can it be written? STATUS_ENVIRONMENT. */
enum status movie_probe(const char *path, struct error *error);

/* One more picture; all plots of a movie have the same size. STATUS_ENVIRONMENT: it cannot be
 * drawn. */
enum status movie_add(struct movie *movie, const struct plot *plot, struct error *error);

/* STATUS_ENVIRONMENT: ffmpeg failed, or the file cannot be written. */
enum status movie_write(const struct movie *movie, const char *path, struct error *error);
void movie_free(struct movie *movie);
