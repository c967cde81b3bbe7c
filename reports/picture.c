/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"

/* False: neither .svg nor .png. */
static bool format_of(const char *path, enum plot_format *format)
{
    const char *dot = strrchr(path, '.');
    *format = dot && !strcmp(dot, ".png") ? PLOT_PNG : PLOT_SVG;
    return dot && (!strcmp(dot, ".svg") || !strcmp(dot, ".png"));
}

enum status picture_probe(const char *path, struct error *error)
{
    enum plot_format format;
    if (!format_of(path, &format))
        return error_set(error, STATUS_BAD_INPUT,
                         "--plot '%.150s': allowed: FILE.svg or FILE.png, of `run "
                         "--snapshot-every` also FILE.gif or FILE.mp4",
                         path);
    return output_probe(path, error);
}

enum status picture_write(const struct plot *plot, const char *path, struct error *error)
{
    enum plot_format format;
    struct output output;
    char *bytes, message[256] = "";
    size_t size;
    if (!format_of(path, &format)) return picture_probe(path, error);
    if (plot_draw(plot, format, &bytes, &size, message, sizeof message) != PLOT_OK)
        return error_set(error, STATUS_ENVIRONMENT, "--plot '%.150s': %.250s", path, message);
    enum status status = output_open(&output, path, error);
    if (!status) {
        fwrite(bytes, 1, size, output.stream); /* output_close reports failures */
        status = output_close(&output, error);
    }
    free(bytes);
    return status;
}

enum status picture_source(const struct plot *plot, const char *path, struct error *error)
{
    struct plot named = *plot;
    char *script = NULL, *data = NULL, *stem = strdup(path);
    if (!stem) return error_set(error, STATUS_ENVIRONMENT, "--plot %.150s: no memory", path);
    char *end = strrchr(stem, '.'), *slash = strrchr(stem, '/');
    *end = '\0';
    named.name = slash ? slash + 1 : stem;
    enum status status =
        plot_source(&named, &script, &data)
            ? STATUS_OK
            : error_set(error, STATUS_ENVIRONMENT, "--plot %.150s: no memory", path);
    strcpy(end, ".dat");
    if (!status) status = output_text(stem, data, error);
    strcpy(end, ".gp");
    if (!status) status = output_text(stem, script, error);
    free(script), free(data), free(stem);
    return status;
}
