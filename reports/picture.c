/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"

enum status picture_probe(const char *path, struct error *error)
{
    enum plot_format format;
    if (!plot_format_of(path, &format))
        return error_set(error, STATUS_BAD_INPUT,
                         "--plot '%.150s': allowed: FILE.svg or FILE.png, of `run "
                         "--snapshot-every` also FILE.gif or FILE.mp4",
                         path);
    return output_probe(path, error);
}

enum status picture_write(const struct plot *plot, const char *path, struct error *error)
{
    enum plot_format format = PLOT_SVG;
    struct output output;
    char *bytes, message[256] = "";
    size_t size;
    if (!plot_format_of(path, &format)) return picture_probe(path, error);
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

static enum status write_text(const char *stem, const char *end, const char *text,
                              struct error *error)
{
    char path[4096];
    if (snprintf(path, sizeof path, "%s%s", stem, end) >= (int)sizeof path)
        return error_set(error, STATUS_ENVIRONMENT, "--plot '%.150s...': too long a name", stem);
    return output_text(path, text, error);
}

enum status picture_source(const struct plot *plot, const char *path, struct error *error)
{
    struct plot named = *plot;
    char *script = NULL, *data = NULL, *stem = strdup(path);
    char *end = stem ? strrchr(stem, '.') : NULL;
    if (end) *end = '\0';
    const char *slash = stem ? strrchr(stem, '/') : NULL;
    named.name = slash ? slash + 1 : stem;
    enum status status = STATUS_OK;
    if (!stem || !plot_source(&named, &script, &data))
        status = error_set(error, STATUS_ENVIRONMENT, "--plot %.150s: no memory", path);
    if (!status) status = write_text(stem, ".dat", data, error);
    if (!status) status = write_text(stem, ".gp", script, error);
    free(script), free(data), free(stem);
    return status;
}
