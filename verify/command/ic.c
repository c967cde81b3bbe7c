/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof ic: the initial state of a case in a file that another code reads. */
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "output.h"
#include "result.h"
#include "slab.h"
#include "snapshot_writer.h"
#include "start_format.h"

/* Prints the values that the format lacks, and where the user of the code sets them. */
static void print_missing(const struct start_format *format, const struct run_result *result)
{
    struct snapshot_remark remarks[SNAPSHOT_REMARKS];
    const size_t count = snapshot_remarks(result, remarks);
    char gamma[40], dimension[8], t_end[40];
    const char *box = "", *boundary = "";
    for (size_t k = 0; k < count; k++) {
        if (!strcmp(remarks[k].key, "box")) box = remarks[k].value;
        if (!strcmp(remarks[k].key, "boundary")) boundary = remarks[k].value;
    }
    snprintf(gamma, sizeof gamma, "%.17g", result->problem.gamma);
    snprintf(dimension, sizeof dimension, "%d", result->problem.domain.dim);
    snprintf(t_end, sizeof t_end, "%.17g", settings_real(&result->settings, SETTING_t_end));
    const struct {
        const char *what, *value, *place;
    } lines[] = {{"gamma", gamma, format->gamma},
                 {"dimension", dimension, format->dimension},
                 {"box", box, format->box},
                 {"boundary", boundary, format->boundary},
                 {"end time", t_end, format->t_end}};
    if (format->precision) printf("positions and fields: %s\n", format->precision);
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++)
        if (lines[k].place)
            printf("set %-12s %s  (%s)\n", lines[k].what, lines[k].value, lines[k].place);
}

static enum status write_document(const struct options *options, const char *format,
                                  const char *out, const struct run_settings *settings,
                                  const struct run_result *result, struct error *error)
{
    json_t *document = result_new("ic");
    run_add_plan(settings, result, document);
    result_add(document, "format=%s file=%s", format, out);
    return options_write(options, document, error);
}

static enum status ask_shape(const struct options *options, struct run_settings *settings,
                             struct error *error)
{
    const char *layers = options_value(options, "as-3d");
    if (layers && slab_ask(settings, layers, "ic: --as-3d", error)) return error->status;
    return options_value(options, "equal-masses") ? run_ask_equal_masses(settings, error)
                                                  : STATUS_OK;
}

static enum status write_ic(const struct options *options, int n, char **arguments,
                            struct error *error)
{
    const char *name = options_value(options, "format"), *out = options_value(options, "out");
    struct run_settings settings;
    struct run_result result;
    struct run run;
    if (n < 1) return command_usage(options, error, "a case is needed (`sphproof list cases`)");
    if (!name || !out)
        return command_usage(options, error, "--%s is needed", name ? "out FILE" : "format FORMAT");
    const struct start_format *format = start_format_of(name, error);
    if (!format) return error->status;
    const bool streamed = strcmp(out, "-") == 0;
    if (options->json && strcmp(options->json, out) == 0)
        return error_set(error, STATUS_BAD_INPUT, "--json and --out name the same file '%.150s'",
                         out);
    if (run_prepare(&settings, arguments[0], n - 1, arguments + 1, error)) return error->status;
    settings.threads = options->threads;
    if (ask_shape(options, &settings, error)) return error->status;
    if (run_resolve(&run, &settings, error) || start_possible(format, &run, error))
        return error->status;
    if (format->writer->possible && format->writer->possible(out, error)) return error->status;
    if (!streamed && output_probe(out, error)) return error->status;
    enum status status = run_start(&run, &result, error);
    if (status) return status;
    status = start_write(format, &result, out, error);
    if (!status && options->speak && !streamed) {
        printf("%s: %zu particles of %s at t = 0\n", out, result.n, settings.file.name);
        print_missing(format, &result);
    }
    if (!status) status = write_document(options, name, out, &settings, &result, error);
    run_free(&result);
    return status;
}

static const struct command_option own_options[] = {
    {"format", "FORMAT", "one of `sphproof list formats`"},
    {"out", "FILE", "the file"},
    {"equal-masses", NULL, "particles of equal masses, for codes that only know one mass"},
    {"as-3d", "LAYERS",
     "a case in 2D as so many periodic layers in 3D, for codes that only know 3D"},
    {NULL, NULL, NULL},
};

const struct command command_ic = {
    .name = "ic",
    .synopsis = "CASE [KEY=VALUE ...]",
    .help = "the initial state of a case for another code: the particles that `run` starts "
            "from\nSettings that the format cannot hold are printed with the code's own names: set "
            "them there.",
    .run = write_ic,
    .options = own_options,
    .examples = "sphproof ic gresho n=64^2 --format swift --out gresho.hdf5\n"
                "sphproof ic gresho n=32^2 --as-3d 8 --format sph_exa --out gresho.h5\n"
                "sphproof ic sod lattice=uniform --format csv --out sod.csv",
};
