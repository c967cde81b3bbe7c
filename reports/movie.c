/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "movie.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "list.h"
#include "output.h"
#include "process.h"

enum { PATIENCE = 3600 }; /* seconds */

bool movie_wanted(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && (!strcmp(dot, ".gif") || !strcmp(dot, ".mp4"));
}

static enum status call_ffmpeg(char *const *arguments, const struct buffer *input, const char *path,
                               struct error *error)
{
    struct buffer said = {0};
    char words[400] = "";
    const enum process_status status =
        process_filter(arguments, input ? input->data : "", input ? input->size : 0, PATIENCE,
                       &said, words, sizeof words);
    buffer_free(&said);
    if (status == PROCESS_OK) return STATUS_OK;
    return error_set(
        error, STATUS_ENVIRONMENT, "--plot '%.150s': a movie is made by ffmpeg%s: %.200s", path,
        status == PROCESS_NOT_FOUND ? " (Debian, Ubuntu: package ffmpeg; FILE.png leaves pictures)"
                                    : "",
        words);
}

enum status movie_probe(const char *path, struct error *error)
{
    char ffmpeg[] = "ffmpeg", version[] = "-version";
    char *const arguments[] = {ffmpeg, version, NULL};
    const enum status status = call_ffmpeg(arguments, NULL, path, error);
    return status ? status : output_probe(path, error);
}

static void keep_range(struct movie_range *range, struct plot_panel *panel, struct plot_heat *heat)
{
    if (panel->heat) {
        *heat = *panel->heat;
        list_range(heat->z, heat->nx * heat->ny, &range->low, &range->high);
        const double reach = fmax(fabs(range->low), fabs(range->high));
        panel->heat = heat;
        if (!(range->high - range->low > 1e-6 * reach)) return; /* uniform: default range */
        heat->low = heat->diverging ? -reach : range->low;
        heat->high = heat->diverging ? reach : range->high;
    } else if (panel->y_min == panel->y_max) {
        for (size_t k = 0; k < panel->series_count; k++)
            list_range(panel->series[k].y, panel->series[k].n, &range->low, &range->high);
        const double margin = 0.05 * (range->high - range->low);
        if (!(margin > 1e-6 * fmax(fabs(range->low), fabs(range->high)))) return;
        panel->y_min = range->low - margin, panel->y_max = range->high + margin;
    }
}

enum status movie_add(struct movie *movie, const struct plot *plot, struct error *error)
{
    struct plot_panel panels[MOVIE_PANELS];
    struct plot_heat heats[MOVIE_PANELS];
    struct plot wide = *plot;
    char *bytes, message[256] = "";
    size_t size;
    memcpy(panels, plot->panels, plot->panel_count * sizeof *panels);
    for (size_t k = 0; k < plot->panel_count; k++) {
        if (!movie->count) movie->range[k] = (struct movie_range){INFINITY, -INFINITY};
        keep_range(&movie->range[k], &panels[k], &heats[k]);
    }
    wide.panels = panels;
    if (plot_draw(&wide, PLOT_PNG, &bytes, &size, message, sizeof message) != PLOT_OK)
        return error_set(error, STATUS_ENVIRONMENT, "a picture of a movie: %.250s", message);
    buffer_add_bytes(&movie->pictures, bytes, size);
    movie->count++;
    free(bytes);
    if (!movie->pictures.failed) return STATUS_OK;
    return error_set(error, STATUS_ENVIRONMENT, "no memory for the pictures of a movie");
}

/* ffmpeg writes a temporary file, which replaces the movie when complete. */
enum status movie_write(const struct movie *movie, const char *path, struct error *error)
{
    const bool gif = !strcmp(strrchr(path, '.'), ".gif");
    char rate[12], to[4200], colors[] = "split[a][b];[a]palettegen[p];[b][p]paletteuse",
                             even[] = "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white,format=yuv420p";
    struct output output;
    snprintf(rate, sizeof rate, "%d", MOVIE_PICTURES_A_SECOND);
    if (output_open(&output, path, error)) return error->status;
    snprintf(to, sizeof to, "file:%s", output.temporary ? output.temporary : path);
    const char *const words[] = {"ffmpeg",     "-loglevel",
                                 "error",      "-y",
                                 "-f",         "image2pipe",
                                 "-framerate", rate,
                                 "-c:v",       "png",
                                 "-i",         "-",
                                 "-vf",        gif ? colors : even,
                                 "-f",         gif ? "gif" : "mp4",
                                 to,           NULL};
    enum status status = call_ffmpeg((char *const *)words, &movie->pictures, path, error);
    if (!status) return output_close(&output, error);
    output_discard(&output);
    return status;
}

void movie_free(struct movie *movie)
{
    buffer_free(&movie->pictures);
}
