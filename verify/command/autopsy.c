/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof autopsy: finds which parts of a scheme cost its order, over a ladder of resolutions. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "autopsy.h"
#include "autopsy_plot.h"
#include "command.h"
#include "judge_autopsy.h"
#include "picture.h"
#include "result.h"
#include "table.h"
#include "text.h"
#include "value.h"

enum { BAR = 40 };

/* Letter of each part. */
static const char letters[AUTOPSY_PARTS + 1] = "tmegrdvnc";

static void print_bar(const struct autopsy_level *level)
{
    char bar[BAR + 1];
    double sum = 0;
    size_t end = 0;
    for (size_t k = 0; k < AUTOPSY_PARTS; k++) {
        sum += level->share[k];
        for (; (double)end + 0.5 < BAR * sum && end < BAR; end++) bar[end] = letters[k];
    }
    bar[end] = 0;
    printf("  %s", bar);
}

static void print_levels(const struct autopsy *autopsy, const struct table_style *style)
{
    printf("%s%10s %10s  %-*s%s\n", style->bold, "n", "L1(v)", BAR, "what the error is made of",
           style->end);
    for (size_t l = 0; l < autopsy->count; l++) {
        printf("%10zu %10.3e", autopsy->levels[l].n, autopsy->levels[l].error[0]);
        print_bar(&autopsy->levels[l]);
        printf("\n");
    }
}

static void print_order(const struct order_fit *order)
{
    if (isfinite(order->order))
        printf(" %7.2f [%5.2f, %5.2f]", order->order, order->low, order->high);
    else
        printf(" %7s %14s", "-", "");
}

/* True for parts that a snapshot does not show. */
static bool unseen(size_t part)
{
    return part == AUTOPSY_TIME_STEP || part >= AUTOPSY_VISCOSITY;
}

static void print_parts(const struct autopsy *autopsy, const struct table_style *style)
{
    const struct autopsy_level *finest = &autopsy->levels[autopsy->count - 1];
    printf("\n%s  %-44s %10s %6s %6s %22s%s\n", style->bold, "part, at the finest level", "size",
           "order", "share", "order, 95 % interval", style->end);
    for (size_t k = 0; k < AUTOPSY_PARTS; k++) {
        const struct autopsy_split *size = &finest->size[k];
        if (autopsy->theirs && unseen(k)) continue;
        printf("%c %-44s %10.2e", letters[k], autopsy_part_family.members[k]->label, size->rms);
        if (isfinite(autopsy->orders[k].order))
            printf(" %6.2f", autopsy->orders[k].order);
        else
            printf(" %6s", "-");
        printf(" %5.1f%%", 100 * finest->share[k]);
        print_order(&autopsy->losses[k]);
        printf("\n");
    }
    printf(
        "%sSizes are L1 of the velocity for the time step and the measure, and the rms of the "
        "acceleration for\nthe others (the exact acceleration has %.3g). What the first two do not "
        "explain of the error is shared\namong the others: noise by the squares of their noise, a "
        "smooth error by their smooth parts along it.\nThe first order is that of the size, the "
        "last that of the share of the error.%s\n",
        style->faint, finest->acceleration, style->end);
    if (!autopsy->theirs && finest->error[2] > 1.01 * finest->error[0])
        printf(
            "With a quarter of the time step the error is %.2f times as large: what the step costs "
            "cancels part of\nthe rest, and has no share.\n",
            finest->error[2] / finest->error[0]);
}

static void print_row(const char *what, double size, const struct order_fit *order)
{
    printf("  %-44s %10.2e %6s", what, size, "");
    print_order(order);
    printf("\n");
}

static void print_power(const struct autopsy_level *level, const struct table_style *style)
{
    printf("\n%s  %-44s %10s %10s %10s%s\n", style->bold, "power at t_end, of the run's own state",
           "work", "heat", "their sum", style->end);
    double largest = 0;
    for (size_t k = 0; k < AUTOPSY_TERMS; k++) largest = fmax(largest, level->power[k].scale);
    for (size_t k = 0; k < AUTOPSY_TERMS; k++) {
        const struct autopsy_power *power = &level->power[k];
        if (power->scale > 0)
            printf("  %-44s %10.2e %10.2e %10.1e\n", autopsy_term_family.members[k]->label,
                   power->work, power->heat, (power->work + power->heat) / largest);
    }
    printf("%swork is what a term does on the flow; the sum of work and heat is given relative to "
           "all\nthat the largest term gives and takes%s\n",
           style->faint, style->end);
}

static void print_trace(const struct trace *trace, const struct table_style *style)
{
    enum { SHOWN = 6 };
    printf("\n%s  how regular particles stand: time%s", style->bold, style->end);
    const size_t step = (trace->looks + SHOWN - 3) / (SHOWN - 1);
    size_t rows[TRACE_LOOKS + 2], count = 0;
    for (size_t k = 0; k + 1 < trace->looks; k += step) rows[count++] = k;
    if (trace->looks) rows[count++] = trace->looks - 1;
    for (size_t k = 0; k < count; k++) printf(" %8.3g", trace->looked[rows[k]]);
    printf("\n  %-33s", "distances to nearest neighbours:");
    for (size_t k = 0; k < count; k++) printf(" %8.2e", trace->seen[rows[k]].spread);
    printf("\n  %-33s", "E0, h |sum V grad W|:");
    for (size_t k = 0; k < count; k++) printf(" %8.2e", trace->seen[rows[k]].gradient);
    printf("\n");
}

static void print_operator(const struct autopsy *autopsy, const struct table_style *style)
{
    const struct autopsy_level *finest = &autopsy->levels[autopsy->count - 1];
    printf("\n%s  %s%s\n", style->bold,
           "acceleration of exact fields, without viscosity: rms error", style->end);
    print_row("at regular positions", finest->regular, &autopsy->regular);
    print_row("at the run's own positions at t_end", finest->own, &autopsy->own);
    print_row("at positions of the start, moved by 0.2", finest->jittered, &autopsy->jittered);
    printf("\n%s%10s %10s %10s %10s %10s %10s %8s %8s %8s%s\n", style->bold, "n", "L1(v)", "dt/2",
           "dt/4", "L1(rho)", "regular", "noise", "spread", "E0", style->end);
    for (size_t l = 0; l < autopsy->count; l++) {
        const struct autopsy_level *level = &autopsy->levels[l];
        printf("%10zu %10.3e", level->n, level->error[0]);
        if (autopsy->theirs)
            printf(" %10s %10s", "-", "-");
        else
            printf(" %10.3e %10.3e", level->error[1], level->error[2]);
        printf(" %10.3e %10.3e %6.1f %% %8.2e %8.2e\n", level->density, level->density_regular,
               100 * pow(level->velocity.noise / level->velocity.rms, 2), level->regularity.spread,
               level->regularity.gradient);
    }
    printf("%sregular: at the positions of the start. noise: the share of the velocity's squared "
           "error "
           "that differs\nbetween neighbours. spread: of the distances to nearest neighbours, over "
           "their mean. E0: h |sum V grad W|.\nThe last two are taken at t_end.%s\n",
           style->faint, style->end);
}

/* files: one for each snapshot, finest last; NULL if the runs were ours. */
static enum status tell(const struct options *options, const struct run *run,
                        const struct autopsy *autopsy, json_t *files, struct error *error)
{
    const char *plot = options_value(options, "plot");
    const struct table_style style = table_style(options->color);
    json_t *document = result_new("autopsy");
    enum status status = STATUS_OK;
    autopsy_add_case(run, autopsy, document);
    if (files) json_object_set_new(document, "snapshots", files);
    if (options->speak) {
        printf("%s%s%s: %s\n", style.bold, run->asked.file.name, style.end, run->asked.file.title);
        print_levels(autopsy, &style);
        print_parts(autopsy, &style);
        print_operator(autopsy, &style);
        if (!files) {
            print_power(&autopsy->levels[autopsy->count - 1], &style);
            print_trace(&autopsy->trace, &style);
        }
        printf("\n");
        table_wrap("", autopsy->sentence);
    }
    if (plot) status = autopsy_plot_write(document, plot, error);
    const enum status written = options_write(options, document, error);
    return status ? status : written;
}

static enum status examine(const struct options *options, int n, char **arguments,
                           struct error *error)
{
    struct run_settings settings;
    struct run level;
    struct autopsy autopsy;
    size_t ladder[CASE_LADDER_MAX], count;
    if (run_prepare(&settings, arguments[0], n - 1, arguments + 1, error) ||
        options_ladder(options, &settings, ORDER_LEVELS_MIN, ladder, &count, error))
        return error->status;
    settings.threads = options->threads;
    return autopsy_ladder(&settings, ladder, count, &autopsy, &level, error)
               ? error->status
               : tell(options, &level, &autopsy, NULL, error);
}

/* ---- snapshots of another code ---- */

/* Prints whose particles they are, and with which kernel exact fields are evaluated. */
static void print_files(const struct options *options, const json_t *files, const struct run *used)
{
    char gradient[SETTING_TEXT_MAX];
    size_t k;
    const json_t *file;
    settings_text(&used->settings, SETTING_gradient, gradient);
    json_array_foreach(files, k, file) {
        if (!options->speak) return;
        printf("%s: %s\n  looked at with gradient=%s kernel=%s eta=%.5s, %s\n",
               value_text(file, "file"), value_text(file, "verdict"), gradient,
               value_text(file, "kernel"), value_text(file, "eta"),
               json_is_true(json_object_get(file, "proved")) ? "which the file proves"
                                                             : "which the file does not show");
    }
    if (options->speak) printf("\n");
}

struct theirs {
    struct run_settings settings;
    struct judge_request request;
    size_t count;
    const char *path[CASE_LADDER_MAX];
    struct judged *judged; /* count, by n */
};

static int by_number(const void *a, const void *b)
{
    const struct judged *one = a, *other = b;
    return (one->result.n > other->result.n) - (one->result.n < other->result.n);
}

/* The first snapshot is the option's argument; all arguments that are not keys are further ones. */
static enum status take_theirs(const struct options *options, int n, char **arguments,
                               struct theirs *theirs, struct error *error)
{
    char *keys[n];
    int count = 0;
    if (options_value(options, "n"))
        return error_set(error, STATUS_BAD_INPUT,
                         "autopsy: --n and --rates exclude each other; allowed: as many snapshots "
                         "as there are numbers of particles");
    theirs->path[theirs->count++] = options_value(options, "rates");
    for (int k = 1; k < n; k++)
        if (strchr(arguments[k], '=') && !strchr(arguments[k], '/'))
            keys[count++] = arguments[k];
        else if (theirs->count < CASE_LADDER_MAX)
            theirs->path[theirs->count++] = arguments[k];
        else
            return error_set(error, STATUS_BAD_INPUT, "autopsy: --rates: allowed: up to %d files",
                             CASE_LADDER_MAX);
    theirs->request = (struct judge_request){.case_name = arguments[0],
                                             .asked = &theirs->settings,
                                             .kernel = -1,
                                             .options = {.map = options_value(options, "map")}};
    if (options_real(options, "time", &theirs->request.time, error)) return error->status;
    return run_prepare(&theirs->settings, arguments[0], count, keys, error);
}

static enum status read_theirs(struct theirs *theirs, struct error *error)
{
    enum status status = STATUS_OK;
    theirs->judged = calloc(theirs->count, sizeof *theirs->judged);
    if (!theirs->judged) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    for (size_t k = 0; k < theirs->count && !status; k++)
        status = judge_snapshot(theirs->path[k], &theirs->request, &theirs->judged[k], error);
    if (status) return status;
    qsort(theirs->judged, theirs->count, sizeof *theirs->judged, by_number);
    for (size_t k = 1; k < theirs->count; k++)
        if (theirs->judged[k].result.n == theirs->judged[k - 1].result.n)
            return error_set(error, STATUS_BAD_INPUT,
                             "autopsy: %.150s and %.150s have %zu particles each; allowed: one "
                             "snapshot for each n",
                             theirs->judged[k - 1].path, theirs->judged[k].path,
                             theirs->judged[k].result.n);
    return STATUS_OK;
}

static json_t *describe(const struct judged *judged, const struct run *used)
{
    char kernel[SETTING_TEXT_MAX], eta[SETTING_TEXT_MAX];
    settings_text(&used->settings, SETTING_kernel, kernel);
    settings_text(&used->settings, SETTING_eta, eta);
    return result_object("file=%s code=%s verdict=%s kernel=%s eta=%s proved=%d?", judged->path,
                         judged->file.code, judged->verdict, kernel, eta,
                         judged->conventions.known);
}

static enum status examine_theirs(const struct options *options, int n, char **arguments,
                                  struct error *error)
{
    struct theirs theirs = {0};
    struct autopsy autopsy = {.theirs = true};
    struct run used;
    json_t *files = json_array();
    enum status status = take_theirs(options, n, arguments, &theirs, error);
    if (!status) status = read_theirs(&theirs, error);
    for (; !status && autopsy.count < theirs.count; autopsy.count++) {
        const struct judged *judged = &theirs.judged[autopsy.count];
        status = judge_autopsy(judged, &autopsy.levels[autopsy.count], &used, error);
        if (!status) json_array_append_new(files, describe(judged, &used));
    }
    if (!status) {
        autopsy.dim = theirs.judged->file.dim;
        status = autopsy_judge(&autopsy, error);
    }
    if (!status) print_files(options, files, &used);
    if (!status) status = tell(options, &used, &autopsy, json_incref(files), error);
    for (size_t k = 0; theirs.judged && k < theirs.count; k++) judge_free(&theirs.judged[k]);
    free(theirs.judged);
    json_decref(files);
    return status;
}

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    const char *plot = options_value(options, "plot");
    if (n < 1) return command_usage(options, error, "a case is needed (`sphproof list cases`)");
    const bool theirs = options_value(options, "rates");
    if (!theirs && (options_value(options, "map") || options_value(options, "time")))
        return error_set(error, STATUS_BAD_INPUT, "autopsy: --map and --time need --rates");
    if (plot && picture_probe(plot, error)) return error->status;
    return (theirs ? examine_theirs : examine)(options, n, arguments, error);
}

static const struct command_option own_options[] = {
    {"n", "N1,N2,...", "numbers of particles, at least four distinct ones (default: the case's)"},
    {"plot", "FILE.svg|.png", "draw the shares of the error, and how each falls (needs gnuplot)"},
    {"rates", "SNAPSHOT",
     "snapshots of another code: the errors that the operator of the keys makes of exact fields at "
     "their positions, beside their own errors"},
    {"map", "NAME=THEIRS,...", "text: which column is x, vx, m, rho, u, P, h"},
    {"time", "T", "time of the snapshots (default: the files')"},
    {NULL, NULL, NULL},
};

const struct command command_autopsy = {
    .name = "autopsy",
    .synopsis = "CASE [KEY=VALUE ...] [--rates SNAPSHOT ...]",
    .help = "which part of a scheme its order is lost to, on flows without jumps\nEach resolution "
            "is run with the usual time step, half of it and a quarter of it. Then "
            "the\nacceleration is evaluated for particles with exact velocities and energies at "
            "regular positions,\nat the final positions of the run and at jittered ones, with and "
            "without viscosity. The error of\nthe velocity is shared among these parts, each with "
            "its own order, and a sentence names the part\nthat limits the order. Snapshots of "
            "another code, one for each number of particles, are read as by\n`sphproof judge`. "
            "They show positions and densities alone: time step and viscosity get no share.",
    .run = run,
    .options = own_options,
    .examples = "sphproof autopsy yee\n"
                "sphproof autopsy gresho gradient=standard --n 16^2,24^2,32^2,48^2\n"
                "sphproof autopsy sound_wave --json autopsy.json --plot autopsy.png\n"
                "sphproof autopsy gresho --rates theirs_16.hdf5 theirs_24.hdf5 theirs_32.hdf5 "
                "theirs_48.hdf5",
};
