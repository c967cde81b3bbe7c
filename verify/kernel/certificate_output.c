/* SPDX-License-Identifier: GPL-3.0-or-later
 * A certificate as text, as JSON and as a plot. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "certificate.h"
#include "picture.h"
#include "result.h"
#include "value.h"

/* ---- text ---- */

static void print_measured(const struct certificate *c, double h, FILE *stream)
{
    const struct kernel *kernel = c->kernel;
    const int dim = c->dim;
    const double sigma = sqrt(c->moments.second);
    if (c->terms.single || c->looks_single)
        fprintf(stream, "  %-28s values are in %s precision; judged as %s, bounds at %g%s\n",
                "precision", c->looks_single ? "single" : "double",
                c->terms.single ? "single" : "double", c->terms.single ? TERMS_SINGLE_BOUND : 1e-13,
                c->terms.single == c->looks_single ? ""
                : c->looks_single                  ? ": see --precision single"
                                                   : ": --precision double asks more");
    fprintf(stream, "  %-28s %.17g\n", "constant C_d", kernel->constant[dim]);
    fprintf(stream, "  %-28s 1 %+.2g\n", "integral of W dV", c->moments.volume - 1);
    fprintf(stream, "  %-28s sigma^2 = %.10g h^2, sigma = %.10g\n", "second moment (per axis)",
            c->moments.second, sigma * h);
    fprintf(stream, "  %-28s %.10g h^4\n", "fourth moment (per axis)", c->moments.fourth);
    fprintf(stream, "  %-28s W(0) = %.10g, so eta must exceed %.6g\n", "self-term",
            kernel_value(kernel, 0, h, dim), kernel_least_eta(kernel, dim));
    fprintf(stream, "  %-28s ", "class");
    if (c->class.class < 0)
        fprintf(stream, "discontinuous");
    else
        fprintf(stream, "C%d%s", c->class.class,
                c->class.class == measure_class_limit(&c->pieces) ? " or higher" : "");
    if (c->class.class < measure_class_limit(&c->pieces) &&
        c->class.class != kernel->smoothness[dim])
        fprintf(stream, " (declared C%d)", kernel->smoothness[dim]);
    if (c->class.at == 0 || c->class.at == 1)
        fprintf(stream, ", limited by the %s", c->class.at == 0 ? "origin" : "edge");
    else if (c->class.at > 0)
        fprintf(stream, ", limited by the knot at q = %.6g", c->class.at);
    fprintf(stream, "\n  %-28s least %.3g at k h = %.4g\n", "Fourier transform", c->fourier.least,
            c->fourier.least_at);
    if (isnan(c->fourier.first_negative))
        fprintf(stream, "  %-28s none up to k h = %d\n", "first negative wavenumber",
                MEASURE_KAPPA_MAX);
    else
        fprintf(stream, "  %-28s k h = %.6g, k = %.6g\n", "first negative wavenumber",
                c->fourier.first_negative, c->fourier.first_negative / h);
    if (isnan(c->pairing))
        fprintf(stream, "  %-28s at any number of neighbours up to %d\n", "safe from pairing",
                MEASURE_NEIGHBOURS_MAX);
    else
        fprintf(stream, "  %-28s up to %.0f neighbours (eta %.3g)\n", "safe from pairing",
                c->pairing, pow(c->pairing * dim / measure_sphere(dim), 1. / dim));
}

static void print_lattice(const struct certificate *c, FILE *stream)
{
    fprintf(stream, "\nlattice sums (h = eta spacings), bias of the density and of a gradient:\n");
    fprintf(stream, "  %-10s", "eta");
    for (int i = 0; i < CERTIFICATE_WIDTHS; i++) fprintf(stream, " %9g", c->lattice[i].eta);
    fprintf(stream, "\n  %-10s", "density");
    for (int i = 0; i < CERTIFICATE_WIDTHS; i++) fprintf(stream, " %9.1e", c->lattice[i].density);
    fprintf(stream, "\n  %-10s", "gradient");
    for (int i = 0; i < CERTIFICATE_WIDTHS; i++) fprintf(stream, " %9.1e", c->lattice[i].gradient);
    fprintf(stream, "\n");
}

static double nearness(const struct finding *figure)
{
    if (figure->status == FINDING_SKIP) return -1;
    if (!(figure->value <= figure->bound)) return (double)INFINITY;
    return figure->bound > 0 ? figure->value / figure->bound : 0;
}

static void print_figure(const struct finding *figure, FILE *stream, bool color)
{
    const bool failed = figure->status == FINDING_FAIL, skipped = figure->status == FINDING_SKIP;
    fprintf(stream, "  %s%-4s%s %-18s", color ? failed ? "\033[31m" : "\033[32m" : "",
            failed    ? "FAIL"
            : skipped ? "-"
                      : "ok",
            color ? "\033[0m" : "", figure->what);
    if (skipped)
        fprintf(stream, " %9s %9s %9s  %s\n", "", "", "", figure->subject);
    else
        fprintf(stream, " %9.2e %9.1e %9.1e  %s\n", figure->value, figure->bound, figure->floor,
                figure->subject);
}

/* One line per property (the figure nearest to its bound), and every failed figure. */
static void print_properties(const struct certificate *c, FILE *stream, bool color)
{
    fprintf(stream, "\n  %-4s %-18s %9s %9s %9s\n", "", "property", "value", "bound", "floor");
    for (size_t p = 0; p < property_count; p++) {
        const struct finding *nearest = NULL;
        for (size_t i = 0; i < c->figures.count; i++) {
            const struct finding *figure = &c->figures.list[i];
            if (strcmp(figure->what, property_list[p].name) != 0) continue;
            if (figure->status == FINDING_FAIL) print_figure(figure, stream, color);
            if (!nearest || nearness(figure) > nearness(nearest)) nearest = figure;
        }
        if (nearest && nearest->status != FINDING_FAIL) print_figure(nearest, stream, color);
    }
}

/* Prints the size of faults that could have been missed. */
static void print_resolution(const struct certificate *c, FILE *stream)
{
    const double width = 1. / (double)c->terms.samples;
    const int decades = c->terms.single ? 6 : 30;
    fprintf(stream,
            "\nresolution: w and dw at %ld random places (one in each %.2g of q, seed %llu), again "
            "around the worst of\n"
            "them, and at %d places where formulas like to change, to the last digit; W, dW/dr and "
            "dW/dh at %ld\n"
            "random h from 1e-%d to 1e%d. A fault narrower than %.2g in q that begins at none of "
            "these places may be missed.\n",
            c->terms.samples, width, (unsigned long long)c->terms.seed, c->pieces.place_count,
            c->terms.samples / 4, decades, decades, 2 * width);
}

void certificate_print(const struct certificate *c, double h, FILE *stream, bool color)
{
    fprintf(stream, "%s (%s), %d dimension%s, support radius h = %g\n\n", c->kernel->member.name,
            c->kernel->member.label, c->dim, c->dim > 1 ? "s" : "", h);
    print_measured(c, h, stream);
    print_lattice(c, stream);
    print_properties(c, stream, color);
    print_resolution(c, stream);
    fprintf(stream, "\n%s: ", c->failed ? "REJECTED" : "accepted");
    if (c->failed) {
        fprintf(stream, "%zu of %zu figures beyond their bound, in", c->failed, c->figures.count);
        const char *last = "";
        for (size_t i = 0; i < c->figures.count; i++) {
            const struct finding *figure = &c->figures.list[i];
            if (figure->status != FINDING_FAIL || strcmp(figure->what, last) == 0) continue;
            fprintf(stream, "%s %s", *last ? "," : "", figure->what);
            last = figure->what;
        }
        fprintf(stream, "\n");
    } else
        fprintf(stream, "%zu figures within their bounds\n", c->figures.count);
}

/* ---- JSON ---- */

static const char *formula_of(const char *property)
{
    size_t p = 0;
    while (p + 1 < property_count && strcmp(property_list[p].name, property) != 0) p++;
    return property_list[p].formula;
}

json_t *certificate_checks(const struct certificate *c)
{
    json_t *list = json_array();
    char subject[256];
    for (size_t i = 0; i < c->figures.count; i++) {
        const struct finding *figure = &c->figures.list[i];
        snprintf(subject, sizeof subject, "%s, dim %d, %s", c->kernel->member.name, c->dim,
                 figure->subject);
        json_array_append_new(
            list,
            result_object(
                "group=%s name=%s subject=%s property=%s value=%g bound=%g floor=%g status=%s",
                "kernels", figure->what, subject, formula_of(figure->what), figure->value,
                figure->bound, figure->floor, finding_words[figure->status]));
    }
    return list;
}

static json_t *lattice_json(const struct certificate *c)
{
    json_t *list = json_array();
    for (int i = 0; i < CERTIFICATE_WIDTHS; i++)
        json_array_append_new(list,
                              result_object("eta=%g density=%g gradient=%g", c->lattice[i].eta,
                                            c->lattice[i].density, c->lattice[i].gradient));
    return list;
}

static json_t *resolution_json(const struct certificate *c)
{
    const double decades = c->terms.single ? 6 : 30;
    return json_pack("{s:I, s:o, s:i, s:I, s:[f,f], s:I}", "samples", (json_int_t)c->terms.samples,
                     "width", result_number(2. / (double)c->terms.samples), "places",
                     c->pieces.place_count, "widths", (json_int_t)(c->terms.samples / 4),
                     "width_range", pow(10, -decades), pow(10, decades), "seed",
                     (json_int_t)c->terms.seed);
}

void certificate_json(const struct certificate *c, double h, json_t *document)
{
    const struct kernel *kernel = c->kernel;
    const struct measure_moments *m = &c->moments;
    const double first = c->fourier.first_negative;
    result_add(
        document, "constant=%g normalisation=%g moments=%p class=%d class_declared=%d",
        kernel->constant[c->dim], m->volume,
        (void *)result_object("second=%g fourth=%g sigma=%g second_over_h2=%g fourth_over_h4=%g",
                              m->second * h * h, m->fourth * pow(h, 4), sqrt(m->second) * h,
                              m->second, m->fourth),
        c->class.class, kernel->smoothness[c->dim]);
    const int knots = kernel->knot_count > 0 ? kernel->knot_count : 0; /* -1: unknown */
    result_add(document,
               "knots=%p fourier=%p pairing_neighbours=%g? self_term=%g least_eta=%g lattice=%p",
               (void *)result_numbers(kernel->knots, (size_t)knots),
               (void *)result_object("min=%g min_kh=%g first_negative_k=%g? first_negative_kh=%g?",
                                     c->fourier.least, c->fourier.least_at, first / h, first),
               c->pairing, kernel_value(kernel, 0, h, c->dim), kernel_least_eta(kernel, c->dim),
               (void *)lattice_json(c));
    result_add(document, "precision=%p negative=%d? resolution=%p checks=%p",
               (void *)result_object("values=%s judged=%s", c->looks_single ? "single" : "double",
                                     c->terms.single ? "single" : "double"),
               c->terms.negative, (void *)resolution_json(c), (void *)certificate_checks(c));
}

/* ---- plot ---- */

enum { CURVE_MAX = 4096, WAVES = 600 };

struct curves {
    double q[CURVE_MAX], w[CURVE_MAX], dw[CURVE_MAX], ddw[CURVE_MAX];
    double kappa[WAVES], transform[WAVES];
    size_t n;
};

/* At the nodes of each piece, so that the jumps of w'' at the knots are drawn as jumps. */
static void fill(struct curves *curves, const struct certificate *c)
{
    const struct pieces *pieces = &c->pieces;
    const double unit = c->kernel->constant[c->dim];
    const int stride = 1 + pieces->n * PIECES_NODES / (CURVE_MAX - 2 * PIECES_NODES);
    for (int p = 0; p < pieces->n; p++) {
        const double a = pieces->edge[p], half = (pieces->edge[p + 1] - a) / 2;
        double values[PIECES_NODES];
        struct series_fit fit;
        for (int j = 0; j < PIECES_NODES; j++)
            values[j] = c->kernel->dw(c->kernel, a + half * (1 + pieces->node[j]), c->dim);
        pieces_fit(pieces, values, &fit);
        for (int j = PIECES_NODES - 1; j >= 0 && curves->n < CURVE_MAX; j -= stride) {
            double floor;
            const double x = pieces->node[j], q = a + half * (1 + x);
            curves->q[curves->n] = q;
            curves->w[curves->n] = unit * c->kernel->w(c->kernel, q, c->dim);
            curves->dw[curves->n] = unit * values[j];
            curves->ddw[curves->n++] = unit * pieces_series_slope(&fit, x, &floor) / half;
        }
    }
    for (int i = 0; i < WAVES; i++) {
        curves->kappa[i] = 0.1 * i;
        curves->transform[i] = fabs(measure_transform(&c->spectrum, curves->kappa[i]));
    }
}

json_t *certificate_curves(const struct certificate *c)
{
    struct curves *curves = calloc(1, sizeof *curves);
    if (!curves) return NULL;
    fill(curves, c);
    const size_t n = curves->n;
    char title[160];
    snprintf(title, sizeof title, "%s in %d dimension%s, h = 1", c->kernel->member.name, c->dim,
             c->dim > 1 ? "s" : "");
    json_t *packed = result_object(
        "title=%s q=%p w=%p dw=%p ddw=%p kappa=%p transform=%p first_negative=%g", title,
        (void *)result_numbers(curves->q, n), (void *)result_numbers(curves->w, n),
        (void *)result_numbers(curves->dw, n), (void *)result_numbers(curves->ddw, n),
        (void *)result_numbers(curves->kappa, WAVES),
        (void *)result_numbers(curves->transform, WAVES), c->fourier.first_negative);
    free(curves);
    return packed;
}

static enum status draw(const struct curves *curves, const char *title, double first_negative,
                        const char *path, struct error *error)
{
    const struct plot_series w = {
        .kind = PLOT_LINES, .n = curves->n, .x = curves->q, .y = curves->w};
    const struct plot_series dw = {
        .kind = PLOT_LINES, .n = curves->n, .x = curves->q, .y = curves->dw};
    const struct plot_series ddw = {
        .kind = PLOT_LINES, .n = curves->n, .x = curves->q, .y = curves->ddw};
    const struct plot_series transform = {
        .kind = PLOT_LINES, .n = WAVES, .x = curves->kappa, .y = curves->transform};
    const struct plot_mark negative = {first_negative, false, "negative from here"};
    const struct plot_panel panels[] = {
        {.y_label = "W", .key = PLOT_KEY_NONE, .series = &w, .series_count = 1},
        {.y_label = "W′", .key = PLOT_KEY_NONE, .series = &dw, .series_count = 1},
        {.y_label = "W″",
         .x_label = "q = r/h",
         .key = PLOT_KEY_NONE,
         .series = &ddw,
         .series_count = 1},
        {.y_label = "|transform|",
         .x_label = "k h",
         .y_log = true,
         .own_x = true,
         .key = PLOT_KEY_NONE,
         .series = &transform,
         .series_count = 1,
         .marks = &negative,
         .mark_count = first_negative < 0.1 * WAVES}};
    const struct plot plot = {.name = "kernel",
                              .title = title,
                              .show_title = true,
                              .panels = panels,
                              .panel_count = sizeof panels / sizeof *panels};
    return picture_write(&plot, path, error);
}

enum status certificate_plot(const json_t *json, const char *path, struct error *error)
{
    struct curves *curves = calloc(1, sizeof *curves);
    if (!curves) return error_set(error, STATUS_ENVIRONMENT, "no memory for a plot");
    value_reals(json_object_get(json, "w"), curves->w, CURVE_MAX);
    value_reals(json_object_get(json, "dw"), curves->dw, CURVE_MAX);
    value_reals(json_object_get(json, "ddw"), curves->ddw, CURVE_MAX);
    value_reals(json_object_get(json, "kappa"), curves->kappa, WAVES);
    value_reals(json_object_get(json, "transform"), curves->transform, WAVES);
    curves->n = value_reals(json_object_get(json, "q"), curves->q, CURVE_MAX);
    const enum status status = draw(curves, value_text_or(json, "title", "kernel"),
                                    value_member(json, "first_negative"), path, error);
    free(curves);
    return status;
}
