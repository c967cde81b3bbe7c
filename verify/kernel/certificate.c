/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "certificate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <gsl/gsl_errno.h>

#include "list.h"
#include "places.h"

struct certificate_sink {
    struct property_sink sink;
    struct certificate *certificate;
    const struct property *property;
    bool no_memory;
};

static void take(struct property_sink *sink, double value, double bound, double floor,
                 const char *where, bool skipped)
{
    struct certificate_sink *context = (struct certificate_sink *)sink;
    struct certificate *certificate = context->certificate;
    if (!list_grow(&certificate->figures, certificate->figure_count,
                   sizeof *certificate->figures)) {
        context->no_memory = true;
        return;
    }
    if (certificate->terms.single && bound > 0) bound = fmax(bound, TERMS_SINGLE_BOUND);
    struct certificate_figure *figure = &certificate->figures[certificate->figure_count++];
    *figure = (struct certificate_figure){.property = context->property,
                                          .value = value,
                                          .bound = bound,
                                          .floor = floor,
                                          .skipped = skipped,
                                          .passed = skipped || (value <= bound && floor <= bound)};
    snprintf(figure->where, sizeof figure->where, "%s", where);
    certificate->failed += !figure->passed;
}

/* The widths people use: the kernel's own, the seed program's, and what lies between. */
static void measure_lattices(struct certificate *certificate)
{
    static const double usual[] = {1.5, 2, 2.4, 2.5, 3, 4, 4.8, 6};
    for (int i = 0; i < CERTIFICATE_WIDTHS; i++) {
        certificate->lattice[i].eta = usual[i];
        measure_lattice(certificate->kernel, certificate->dim, usual[i],
                        &certificate->lattice[i].density, &certificate->lattice[i].gradient);
    }
}

enum status certificate_measure(struct certificate *certificate, const struct kernel *kernel,
                                int dim, const struct terms *terms, struct error *error)
{
    struct places places;
    *certificate = (struct certificate){.kernel = kernel, .dim = dim};
    if (pieces_find(&certificate->pieces, kernel, dim, terms, error) ||
        measure_spectrum_make(&certificate->spectrum, &certificate->pieces, error)) {
        certificate_free(certificate);
        return STATUS_ENVIRONMENT;
    }
    certificate->terms = certificate->pieces.terms;
    certificate->looks_single = pieces_look_single(&certificate->pieces);
    places_make(&places, &certificate->pieces);
    certificate->places = places.n;
    places_free(&places);
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    measure_moments(&certificate->pieces, &certificate->moments);
    measure_class(&certificate->pieces, &certificate->class);
    measure_fourier(&certificate->spectrum, &certificate->fourier);
    certificate->pairing = measure_pairing(kernel, dim);
    measure_lattices(certificate);
    struct certificate_sink context = {.sink = {take}, .certificate = certificate};
    for (size_t i = 0; i < property_count; i++) {
        context.property = &property_list[i];
        property_list[i].measure(&certificate->pieces, &context.sink);
    }
    gsl_set_error_handler(handler);
    if (!context.no_memory) return STATUS_OK;
    certificate_free(certificate);
    return error_set(error, STATUS_ENVIRONMENT, "no memory for the figures of a kernel");
}

void certificate_free(struct certificate *certificate)
{
    pieces_free(&certificate->pieces);
    measure_spectrum_free(&certificate->spectrum);
    free(certificate->figures);
    certificate->figures = NULL;
}

enum status certificate_failing(const struct kernel *kernel, int dim, const struct terms *terms,
                                json_t **failing, struct error *error)
{
    struct certificate *certificate = calloc(1, sizeof *certificate);
    if (!certificate) return error_set(error, STATUS_ENVIRONMENT, "no memory for a certificate");
    const enum status status = certificate_measure(certificate, kernel, dim, terms, error);
    *failing = json_array();
    for (size_t k = 0; k < certificate->figure_count && !status; k++)
        if (!certificate->figures[k].passed)
            json_array_append_new(*failing, json_string(certificate->figures[k].property->name));
    if (!status) certificate_free(certificate);
    free(certificate);
    return status;
}
