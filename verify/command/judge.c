/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof judge: errors of any code's snapshots against the solution of a case. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "findings.h"
#include "judge.h"
#include "output.h"
#include "page.h"
#include "picture.h"
#include "result.h"
#include "run_plot.h"
#include "table.h"
#include "text.h"
#include "value.h"

/* ---- what is asked ---- */

/* Reads the meaning of h: support radius, multiple of the kernel's standard deviation, or fraction
 * of the support. */
static enum status take_width(const char *text, struct width_meaning *width, struct error *error)
{
    double number;
    if (!text) return STATUS_OK;
    if (strcmp(text, "support") == 0)
        width->ratio = 1;
    else if (strcmp(text, "half") == 0)
        width->ratio = 2;
    else if (strcmp(text, "sigma") == 0)
        width->deviations = 1;
    else if (strcmp(text, "2sigma") == 0)
        width->deviations = 2;
    else if (text_real(text, &number) && number > 0 && number <= 100)
        width->ratio = number;
    else
        return error_set(
            error, STATUS_BAD_INPUT,
            "judge: --h-is '%.40s': allowed: support (H = h), half (H = 2 h), sigma or "
            "2sigma (of the kernel), or H/h as a number up to 100",
            text);
    return STATUS_OK;
}

/* A:B along x, or the radius of a disc or ball. */
static enum status take_window(const char *text, struct judge_request *request, struct error *error)
{
    if (!text) return STATUS_OK;
    request->window =
        text_reals(text, ":", 2, request->ends) && request->ends[0] < request->ends[1];
    if (request->window || (text_real(text, &request->radius) && request->radius > 0))
        return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "judge: --window '%.40s': allowed: A:B (A < B, along x), or the radius of a "
                     "disc about the middle of the box",
                     text);
}

static enum status take_request(const struct options *options, int n, struct judge_request *request,
                                struct error *error)
{
    request->case_name = options_value(options, "case");
    request->left = options_value(options, "left");
    request->right = options_value(options, "right");
    request->options.map = options_value(options, "map");
    request->box = options_value(options, "box");
    request->boundary = options_value(options, "boundary");
    if (request->boundary && strcmp(request->boundary, "periodic") != 0 &&
        strcmp(request->boundary, "open") != 0 && strcmp(request->boundary, "reflecting") != 0)
        return error_set(error, STATUS_BAD_INPUT,
                         "judge: --boundary '%.40s': allowed: periodic open reflecting",
                         request->boundary);
    request->allow_far = options_value(options, "allow-far");
    if (n < 1) return command_usage(options, error, "a snapshot is needed");
    if (n > JUDGE_SNAPSHOTS_MAX)
        return command_usage(options, error, "%d snapshots; allowed: up to %d", n,
                             JUDGE_SNAPSHOTS_MAX);
    if (!request->case_name && (request->left || request->right)) {
        if (!request->left || !request->right || !options_value(options, "gamma"))
            return command_usage(options, error,
                                 "--left and --right belong together, and need --gamma");
        request->case_name = "sod";
    }
    if (options_real(options, "gamma", &request->gamma, error) ||
        options_real(options, "x0", &request->x0, error) ||
        options_real(options, "time", &request->time, error) ||
        take_window(options_value(options, "window"), request, error) ||
        take_width(options_value(options, "h-is"), &request->width, error))
        return error->status;
    return options_kernel(options, &request->kernel, error);
}

/* ---- for a person ---- */

static void print_kernels(const struct conventions *c)
{
    enum { SHOWN = 4 };
    if (c->known || !c->count) return;
    printf("  candidates:");
    for (size_t k = 0; k < c->count && k < SHOWN; k++)
        printf("%s %s H = %.5g h (%.2g)", k ? "," : "", c->candidate[k].kernel.member.name,
               c->candidate[k].ratio, c->candidate[k].residual);
    printf("\n");
}

enum { CELL = 24 };

/* Writes a number, or a dash for NaN. */
static const char *cell(char text[CELL], double value)
{
    snprintf(text, CELL, isnan(value) ? "-" : "%.6g", value);
    return text;
}

static void print_norms(const char *name, const struct norms *of)
{
    char text[4][CELL];
    printf("%-16s %12s %12s %12s %14s\n", name, cell(text[0], of->l1), cell(text[1], of->l2),
           cell(text[2], of->linf), cell(text[3], of->particle_mean));
}

static void print_one(const struct judged *judged, const struct table_style *style)
{
    const struct run_result *r = &judged->result;
    const struct snapshot_notes *notes = &judged->file.notes;
    char text[2][CELL], interpolation[400];
    printf("%s%s%s: %s, %s, %zu particles in %dD at t = %.6g\n", style->bold, judged->path,
           style->end, judged->file.layout, judged->file.code, r->n, judged->file.dim, r->time);
    printf("\nassumed:\n");
    for (size_t k = 0; k < notes->count; k++)
        printf("  %-16s %s  %s%s%s\n", notes->note[k].what, notes->note[k].value, style->faint,
               notes->note[k].evidence, style->end);
    print_kernels(&judged->conventions);
    if (!r->problem.problem->fieldless) {
        printf("\n%-16s %12s %12s %12s %14s\n", "errors", "l1", "l2", "linf", "particle_mean");
        for (int f = 0; f < FIELDS; f++)
            if (problem_knows(r->problem.problem, (enum field)f))
                print_norms(field_family.members[f]->name, &r->errors[f]);
        if (r->problem.problem->circular) print_norms("azimuthal", &r->azimuthal);
    }
    run_interpolation_text(r->interpolation, interpolation, sizeof interpolation);
    if (interpolation[0]) printf("%s\n", interpolation);
    if (r->problem.problem->fieldless) printf("\n");
    for (size_t k = 0; k < r->functional_count; k++)
        printf("%-24s %s (exact %s)\n", r->functionals[k].name,
               cell(text[0], r->functionals[k].value), cell(text[1], r->functionals[k].exact));
    const struct regions *regions = r->budget.regions;
    if (regions) printf("\nwhere the L1 of density comes from:");
    for (size_t k = 0; regions && regions->names[k]; k++)
        printf(" %s %.3g", regions->names[k], r->budget.l1[k][FIELD_DENSITY]);
    if (regions) printf("\n");
    if (judged->file.dim > 1)
        printf("noise across the flow: %s\n", cell(*text, judged->transverse));
    if (r->suspicion[0]) printf("suspicious: %s\n", r->suspicion);
    printf("\n%s%s%s\n\n", judged->foreign ? style->bad : style->bold, judged->verdict, style->end);
}

/* Prints the results for several snapshots, the gates and the headline. */
static void print_together(const json_t *document, const struct table_style *style)
{
    const json_t *order, *gate, *one, *drift = json_object_get(document, "conservation");
    const json_t *gates = json_object_get(document, "gates");
    size_t k, i;
    if (json_object_get(document, "no_orders"))
        printf("no orders: %s\n", value_text(document, "no_orders"));
    json_array_foreach(json_object_get(document, "orders"), k, order) {
        printf("order of %-16s", value_text(order, "field"));
        if (json_is_number(json_object_get(order, "order")))
            printf(" %.3f, 95 %% interval %.3f to %.3f;", value_member(order, "order"),
                   value_member(order, "low"), value_member(order, "high"));
        printf(" pairwise");
        json_array_foreach(json_object_get(order, "pairwise"), i, one)
            printf(" %.3f", value_real(one));
        printf("\n");
    }
    if (json_is_object(drift)) {
        const json_t *between = json_object_get(drift, "between");
        printf("from %s to %s: mass %.2g, momentum %.2g, energy %.2g have changed\n",
               json_string_value(json_array_get(between, 0)),
               json_string_value(json_array_get(between, 1)), value_member(drift, "mass"),
               value_member(drift, "momentum"), value_member(drift, "energy"));
    }
    json_array_foreach(gates, k, gate) {
        const char *status = value_text(gate, "status"), *why = value_text(gate, "why");
        const char *color = !strcmp(status, finding_words[FINDING_PASS])   ? style->good
                            : !strcmp(status, finding_words[FINDING_FAIL]) ? style->bad
                                                                           : style->faint;
        printf("gate %-28s %.6g %s %.6g: %s%s%s%s%s  %s%s%s\n", value_text(gate, "name"),
               value_member(gate, "value"), value_text(gate, "relation"),
               value_member(gate, "bound"), color, status, style->end, *why ? ", " : "", why,
               style->faint, value_text(gate, "source"), style->end);
    }
    if (json_array_size(gates)) {
        const bool well = !strcmp(value_text(document, "status"), finding_words[FINDING_PASS]);
        printf("%s%s%s\n", well ? style->good : style->bad, value_text(document, "headline"),
               style->end);
    }
}

/* ---- the command ---- */

/* document: with profiles. */
static enum status write_page(const char *path, const json_t *document, struct error *error)
{
    struct page page = {0};
    if (!document || !page_make_judge(&page, document))
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
    const enum status status = output_text(path, page.html, error);
    page_free(&page);
    return status;
}

static enum status write_junit(const char *path, const json_t *document, struct error *error)
{
    char *text = findings_junit(findings_of_judge, document);
    if (!text) return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
    const enum status status = output_text(path, text, error);
    free(text);
    return status;
}

/* Writes the document to the terminal, as JSON, as JUnit and as a page; the picture shows the main
 * snapshot. Returns the document's status. */
static enum status tell(const struct options *options, const struct judged *judged, size_t count,
                        json_t *gates, struct error *error)
{
    const struct table_style style = table_style(options->color);
    const struct judged *main = judge_main(judged, count);
    const char *html = options_value(options, "html"), *plot = options_value(options, "plot"),
               *junit = options_value(options, "junit");
    json_t *content = judge_json(judged, count, gates, false);
    if (!content) return error_set(error, STATUS_ENVIRONMENT, "no memory for the result");
    for (size_t i = 0; i < count && options->speak; i++) print_one(&judged[i], &style);
    if (options->speak) print_together(content, &style);
    enum status status = options_write_members(options, json_incref(content), error);
    if (!status && junit) status = write_junit(junit, content, error);
    if (!status && html) {
        json_t *document = judge_json(judged, count, gates, true);
        status = write_page(html, document, error);
        json_decref(document);
    }
    if (!status && plot) status = run_plot(&main->run.asked, &main->result, plot, NULL, error);
    if (!status && strcmp(value_text(content, "status"), finding_words[FINDING_PASS]) != 0)
        status = STATUS_CHECK_FAILED;
    json_decref(content);
    return status;
}

static enum status probe(const struct options *options, struct error *error)
{
    const char *html = options_value(options, "html"), *plot = options_value(options, "plot"),
               *junit = options_value(options, "junit"), *gates = options_value(options, "gates");
    if (gates && strcmp(gates, "case") != 0)
        return error_set(error, STATUS_BAD_INPUT,
                         "judge: --gates '%.40s': allowed: case (--gate NAME=BOUND for your own)",
                         gates);
    if ((html && output_probe(html, error)) || (junit && output_probe(junit, error)) ||
        (plot && picture_probe(plot, error)))
        return error->status;
    return STATUS_OK;
}

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    struct judge_request request = {0};
    json_t *gates = NULL;
    size_t count = 0;
    enum status status = take_request(options, n, &request, error);
    if (!status) status = probe(options, error);
    if (status) return status;
    struct judged *judged = calloc((size_t)n, sizeof *judged);
    if (!judged) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    for (; count < (size_t)n && !status; count++)
        status = judge_snapshot(arguments[count], &request, &judged[count], error);
    if (!status)
        status = judge_gates(options_value(options, "gate"), options_value(options, "gates"),
                             judged, count, &gates, error);
    if (!status) status = tell(options, judged, count, gates, error);
    json_decref(gates);
    for (size_t i = 0; i < count; i++) judge_free(&judged[i]);
    free(judged);
    return status;
}

static const struct command_option own_options[] = {
    {"case", "CASE", "case or case file to compare with (default: what the file says)"},
    {"left", "\"RHO V P\"", "gas left of x0 at t = 0, in place of a case or of its states"},
    {"right", "\"RHO V P\"", "gas right of it"},
    {"gamma", "G", "ratio of specific heats (default: the file's, or the case's)"},
    {"x0", "X",
     "position of the first contact, in the file's coordinates (default: the middle of its box)"},
    {"time", "T", "time of the snapshot (default: the file's)"},
    {"box", "LO:HI[,LO:HI...]", "ends of the box along x, y, z (default: the file's, or found)"},
    {"boundary", "WORD", "periodic, open or reflecting ends along x (default: found)"},
    {"window", "A:B|R",
     "where errors are measured: from A to B along x, or in a disc of radius R (default: as for "
     "`run`)"},
    {"map", "NAME=THEIRS,...", "text: which column is x, vx, m, rho, u, P, h"},
    {"kernel", "K", "the code's kernel (default: found)"},
    {"h-is", "MEANING",
     "meaning of h in the file: support, half, sigma, 2sigma, or a number, the support radius over "
     "h (default: found)"},
    {"gate", "NAME=BOUND,...",
     "exit 1 if a figure that is printed exceeds its bound: density_l1=2e-3, disc_error=0.03 "
     "(error of a value), energy=1e-3 (its change), order.density>=0.9"},
    {"gates", "case", "the case's own bounds, for this many particles, and conservation"},
    {"allow-far", NULL,
     "do not exit 1 because a snapshot is far from the solution, or of another gas"},
    {"junit", "F.xml", "write a JUnit file for a CI server"},
    {"html", "F.html", "write a page: verdict, gates, orders, assumptions, errors, profiles"},
    {"plot", "FILE.svg|.png",
     "draw the snapshot as `sphproof run --plot` does; of several the finest"},
    {NULL, NULL, NULL},
};

const struct command command_judge = {
    .name = "judge",
    .synopsis = "SNAPSHOT... [--case CASE | --left \"RHO V P\" --right \"RHO V P\" --gamma G]",
    .help =
        "errors of ANY code's snapshots against the exact solution of a case\n"
        "Reads HDF5 of GADGET, AREPO, GIZMO, SWIFT, SPH-EXA and Phantom, binaries of GADGET\n"
        "(formats 1 and 2, either byte order), XML of VTK, SPLASH's ASCII and CSV, also "
        "compressed\n"
        "(`sphproof list snapshots`). The kernel and the meaning of h are found by summing the\n"
        "density again. Everything that had to be assumed is said, with the evidence for it.\n"
        "Snapshots of `sphproof run` name their case, and need no option.\n"
        "Several snapshots of one problem: orders where only numbers of particles differ,\n"
        "conservation where only times do; gates look at the one of most particles.\n"
        "Exit status 1: a gate failed, a snapshot is far from the case's solution or of another "
        "gas, "
        "or\nnothing is known at its time that it could be compared with.",
    .run = run,
    .options = own_options,
    .examples =
        "sphproof judge snapshot_010.hdf5 --case sod\n"
        "sphproof judge run.csv --case sod --map rho=Density,h=hsml --gate density_l1=2e-3\n"
        "sphproof judge s.hdf5 --left \"1 0 1\" --right \"0.125 0 0.1\" --gamma 1.4 --x0 1",
};
