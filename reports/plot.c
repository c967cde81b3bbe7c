/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plot.h"

#include <ctype.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "layout.h"
#include "output.h"
#include "script.h"
#include "style.h"

enum { PATIENCE = 30 }; /* seconds for one plot */

static bool usable_name(const char *name)
{
    if (!name || !isalpha((unsigned char)*name)) return false;
    for (; *name; name++)
        if (!isalnum((unsigned char)*name) && *name != '_' && *name != '-') return false;
    return true;
}

/* Printed after each plot of a pen. An error in a loaded file does not end gnuplot by itself. */
static const char end_of_plot[] = "end of plot\n";
static const char next_plot[] = "if (GPVAL_ERRNO) exit status 1\nset output\nreset session\n"
                                "set print '-'\nprint 'end of plot'\n";

void plot_pen_free(struct plot_pen *pen)
{
    process_end(&pen->gnuplot);
    if (pen->begun) close(pen->script);
    *pen = (struct plot_pen){0};
}

static void begin(struct plot_pen *pen)
{
    FILE *file = access("/dev/fd/0", F_OK) ? NULL : output_temporary();
    pen->script = file ? fcntl(fileno(file), F_DUPFD_CLOEXEC, 3) : -1;
    if (file) fclose(file);
    pen->begun = true;
}

/* Moves the script to a file, since gnuplot reads standard input byte by byte. If there is no file
 * (the disk is full), the script stays in the input. */
static void set_aside(const struct plot_pen *pen, struct buffer *script)
{
    const int file = pen->script;
    if (file < 0 || script->failed || ftruncate(file, 0) || lseek(file, 0, SEEK_SET) ||
        write(file, script->data, script->size) != (ssize_t)script->size ||
        lseek(file, 0, SEEK_SET))
        return;
    buffer_free(script);
    buffer_add(script, "load '/dev/fd/3'\n");
}

static enum plot_status draw(struct plot_pen *pen, const struct plot *plot,
                             enum script_terminal terminal, struct buffer *picture, char *message,
                             size_t n)
{
    if (!usable_name(plot->name) || !plot->panel_count || plot->panel_count > LAYOUT_PANELS) {
        snprintf(message, n, "a plot needs a name of letters, digits, _ and - and 1 to %d panels",
                 LAYOUT_PANELS);
        return PLOT_FAILED;
    }
    char gnuplot[] = "gnuplot", defaults[] = "-d", dash[] = "-";
    char *const arguments[] = {gnuplot, defaults, dash, NULL};
    struct buffer script = {0};
    script_make(&script, plot, terminal, NULL, NULL);
    if (pen) {
        if (!pen->begun) begin(pen);
        set_aside(pen, &script);
        buffer_add(&script, next_plot);
    }
    char *bytes = buffer_take(&script);
    if (!bytes) {
        snprintf(message, n, "no memory for the plot %s", plot->name);
        return PLOT_FAILED;
    }
    char words[400] = "";
    const enum process_status status =
        pen ? process_ask(&pen->gnuplot, arguments, pen->script, bytes, strlen(bytes), end_of_plot,
                          PATIENCE, picture, words, sizeof words)
            : process_filter(arguments, bytes, strlen(bytes), PATIENCE, picture, words,
                             sizeof words);
    free(bytes);
    if (status == PROCESS_NOT_FOUND || status == PROCESS_TOO_SLOW) {
        snprintf(message, n, "no plot: %s%s", words,
                 status == PROCESS_NOT_FOUND ? " (Debian, Ubuntu: package gnuplot-nox)" : "");
        return PLOT_NO_GNUPLOT;
    }
    if (status != PROCESS_OK || !picture->size) {
        snprintf(message, n, "plot %s: %s", plot->name, *words ? words : "gnuplot drew nothing");
        return PLOT_FAILED;
    }
    return PLOT_OK;
}

bool plot_source(const struct plot *plot, char **script, char **data)
{
    struct buffer output = {0}, file = {0}, to = {0};
    buffer_format(&output, "%s.svg", plot->name);
    buffer_add(&file, "'"); /* in single quotes, in which a quote is doubled */
    for (const char *c = plot->name; *c; c++) {
        if (*c == '\'') buffer_add(&file, "'");
        buffer_add_bytes(&file, c, 1);
    }
    buffer_add(&file, ".dat'");
    if (output.failed || file.failed)
        to.failed = true;
    else
        script_make(&to, plot, SCRIPT_SVG, output.data, file.data);
    *script = buffer_take(&to);
    script_data(&to, plot);
    *data = buffer_take(&to);
    buffer_free(&output);
    buffer_free(&file);
    if (*script && *data) return true;
    free(*script);
    free(*data);
    *script = *data = NULL;
    return false;
}

enum plot_status plot_svg(struct plot_pen *pen, const struct plot *plot, char **svg, char *message,
                          size_t n)
{
    *svg = NULL;
    struct buffer raw = {0}, clean = {0};
    enum plot_status status = draw(pen, plot, SCRIPT_SVG, &raw, message, n);
    if (status == PLOT_OK) {
        if (svg_adapt(&clean, raw.data, plot->name, plot->title ? plot->title : plot->name))
            *svg = buffer_take(&clean);
        if (!*svg) {
            snprintf(message, n,
                     clean.failed ? "plot %s: no memory"
                                  : "plot %s: gnuplot's SVG is not understood",
                     plot->name);
            status = PLOT_FAILED;
        }
    }
    buffer_free(&raw);
    buffer_free(&clean);
    return status;
}

/* A standalone picture: with prolog and style sheet. */
static enum plot_status svg_document(const struct plot *plot, struct buffer *picture, char *message,
                                     size_t n)
{
    char *svg;
    enum plot_status status = plot_svg(NULL, plot, &svg, message, n);
    if (status != PLOT_OK) return status;
    const char *body = strchr(svg, '\n');
    buffer_add(picture, "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n");
    buffer_add_bytes(picture, svg, (size_t)(body - svg));
    buffer_format(picture, "\n<style>%s</style>", style_css());
    buffer_add(picture, body);
    buffer_add(picture, "\n");
    free(svg);
    if (!picture->failed) return PLOT_OK;
    snprintf(message, n, "no memory for the plot %s", plot->name);
    return PLOT_FAILED;
}

enum plot_status plot_draw(const struct plot *plot, enum plot_format format, char **bytes,
                           size_t *size, char *message, size_t n)
{
    struct buffer picture = {0};
    enum plot_status status = format == PLOT_SVG
                                  ? svg_document(plot, &picture, message, n)
                                  : draw(NULL, plot, SCRIPT_PNG, &picture, message, n);
    if (status != PLOT_OK) buffer_free(&picture);
    *size = picture.size;
    *bytes = picture.data;
    return status;
}
