/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof autopsy: which part of a scheme its order is lost to, over a ladder of resolutions. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "autopsy.h"
#include "command.h"
#include "result.h"
#include "settings_output.h"
#include "sweep.h"
#include "table.h"

enum { BAR = 40 };

/* One letter for each part. */
static const char letters[AUTOPSY_PARTS + 1] = "tmegrdv";

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

static void print_parts(const struct autopsy *autopsy, const struct table_style *style)
{
    const struct autopsy_level *finest = &autopsy->levels[autopsy->count - 1];
    printf("\n%s  %-44s %10s %6s %22s%s\n", style->bold, "part, at the finest level", "size",
           "share", "order, 95 % interval", style->end);
    for (size_t k = 0; k < AUTOPSY_PARTS; k++) {
        printf("%c %-44s %10.2e %5.1f%%", letters[k], autopsy_part_family.members[k]->label,
               finest->size[k].rms, 100 * finest->share[k]);
        print_order(&autopsy->orders[k]);
        printf("\n");
    }
    printf(
        "%sthe time step and the measure: in L1 of the velocity; the others: rms of the "
        "acceleration, of\nwhich the exact one has %.3g. What the first two leave of the error the "
        "others share as squares:\na smooth error as what is smooth in them, noise as their "
        "noise%s\n",
        style->faint, finest->acceleration, style->end);
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
    printf("%swork is done on the flow; their sum: over all that the largest gives and takes%s\n",
           style->faint, style->end);
}

static void print_trace(const struct trace *trace, const struct table_style *style)
{
    enum { SHOWN = 6 };
    printf("\n%s  how regular particles stand: time%s", style->bold, style->end);
    const size_t step = trace->looks > SHOWN ? (trace->looks - 1 + SHOWN - 2) / (SHOWN - 1) : 1;
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
    printf("\n%s%10s %11s %11s %11s %11s %11s %8s %8s%s\n", style->bold, "n", "L1(v)", "dt/2",
           "dt/4", "L1(rho)", "regular", "noise", "spread", style->end);
    for (size_t l = 0; l < autopsy->count; l++) {
        const struct autopsy_level *level = &autopsy->levels[l];
        printf("%10zu %11.4e %11.4e %11.4e %11.4e %11.4e %6.1f %% %8.2e\n", level->n,
               level->error[0], level->error[1], level->error[2], level->density,
               level->density_regular, 100 * pow(level->velocity.noise / level->velocity.rms, 2),
               level->regularity.spread);
    }
    printf(
        "%sregular: of the positions of the start; noise: of the square of the velocity's error, "
        "what "
        "differs\nbetween neighbours; spread: of distances to nearest neighbours over their mean, "
        "at t_end%s\n",
        style->faint, style->end);
}

static enum status take_ladder(const struct options *options, const struct run_settings *settings,
                               size_t ladder[CASE_LADDER_MAX], size_t *count, struct error *error)
{
    const char *text = options_value(options, "n");
    const struct case_file *file = &settings->file;
    if (settings->settings.value[SETTING_n].source == SOURCE_USER)
        return error_set(error, STATUS_BAD_INPUT,
                         "autopsy: the key n and a ladder exclude each other; allowed: --n "
                         "N1,N2,N3,N4,...");
    if (text) return sweep_ladder(text, ORDER_LEVELS_MIN, file->dimension, ladder, count, error);
    if (file->ladder_count == 0)
        return error_set(error, STATUS_BAD_INPUT,
                         "autopsy: the case %s has no ladder; give one: --n 100,200,400,800",
                         file->name);
    memcpy(ladder, file->ladder, sizeof file->ladder);
    *count = file->ladder_count;
    return STATUS_OK;
}

static enum status resolve(const struct run_settings *settings, size_t n, struct run *run,
                           struct error *error)
{
    struct run_settings asked = *settings;
    char text[32];
    snprintf(text, sizeof text, "%zu", n);
    enum status status = settings_set(&asked.settings, SETTING_n, text, SOURCE_USER, NULL, error);
    if (!status) status = run_resolve(run, &asked, error);
    return status ? status : autopsy_check(run, error);
}

static enum status write_json(const struct options *options, const struct run *run,
                              const struct autopsy *autopsy, struct error *error)
{
    json_t *document = result_new("autopsy");
    json_object_set_new(document, "case", json_string(run->asked.file.name));
    json_object_set_new(document, "settings", settings_json(&run->settings));
    autopsy_add_json(autopsy, document);
    const enum status status = result_write(document, options->json, error);
    json_decref(document);
    return status;
}

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    struct run_settings settings;
    struct run level;
    struct autopsy autopsy = {0};
    size_t ladder[CASE_LADDER_MAX];
    if (n < 1) return command_usage(options, error, "a case is needed (`sphproof list cases`)");
    if (run_prepare(&settings, arguments[0], n - 1, arguments + 1, error) ||
        take_ladder(options, &settings, ladder, &autopsy.count, error))
        return error->status;
    settings.threads = options->threads;
    autopsy.dim = settings.file.dimension;
    for (size_t l = 0; l < autopsy.count; l++)
        if (resolve(&settings, ladder[l], &level, error)) return error->status;
    for (size_t l = 0; l < autopsy.count; l++)
        if (resolve(&settings, ladder[l], &level, error) ||
            autopsy_measure(&level, &autopsy.levels[l],
                            l + 1 == autopsy.count ? &autopsy.trace : NULL, error))
            return error->status;
    if (autopsy_judge(&autopsy, error)) return error->status;
    if (options->speak) {
        const struct table_style style = table_style(options->color);
        printf("%s%s%s: %s\n", style.bold, settings.file.name, style.end, settings.file.title);
        print_levels(&autopsy, &style);
        print_parts(&autopsy, &style);
        print_operator(&autopsy, &style);
        print_power(&autopsy.levels[autopsy.count - 1], &style);
        print_trace(&autopsy.trace, &style);
        printf("\n");
        table_wrap("", autopsy.verdict);
    }
    return options->json ? write_json(options, &level, &autopsy, error) : STATUS_OK;
}

static const struct command_option own_options[] = {
    {"n", "N1,N2,...", "numbers of particles, at least four distinct ones (default: the case's)"},
    {NULL, NULL, NULL},
};

const struct command command_autopsy = {
    .name = "autopsy",
    .synopsis = "CASE [KEY=VALUE ...]",
    .help = "which part of a scheme its order is lost to, on flows without jumps\n"
            "Each resolution is run with the time step, half and a quarter of it; then the "
            "acceleration is\nevaluated where every particle has the exact velocity and energy: at "
            "regular positions, at those\nof the run at its end, at jittered ones, with and "
            "without viscosity. The error of the velocity is\nshared among the parts, each with "
            "its own order, and a sentence names the one that costs the order.",
    .run = run,
    .options = own_options,
    .examples = "sphproof autopsy yee\n"
                "sphproof autopsy gresho gradient=standard --n 16^2,24^2,32^2,48^2\n"
                "sphproof autopsy sound_wave --json autopsy.json",
};
