/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture.h"

#include <stdlib.h>

#include "output.h"

enum status picture_probe(const char *path, struct error *error)
{
    enum plot_format format;
    if (!plot_format_of(path, &format))
        return error_set(error, STATUS_BAD_INPUT, "--plot '%.150s': allowed: FILE.svg or FILE.png",
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
        fwrite(bytes, 1, size, output.stream); /* output_close tells whether it worked */
        status = output_close(&output, error);
    }
    free(bytes);
    return status;
}
