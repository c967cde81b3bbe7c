/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "certificate.h"

#include <math.h>
#include <stdlib.h>

#include <gsl/gsl_errno.h>

struct certificate_sink {
    struct property_sink sink;
    struct certificate *certificate;
    const struct property *property;
};

static void take(struct property_sink *sink, const struct finding *given)
{
    struct certificate_sink *context = (struct certificate_sink *)sink;
    struct certificate *certificate = context->certificate;
    struct finding figure = certificate->terms.single ? property_single(given) : *given;
    figure.what = context->property->name;
    findings_add(&certificate->figures, figure);
    certificate->failed += figure.status == FINDING_FAIL;
}

/* Usual widths: the kernel's own, the seed program's, and those in between. */
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
    *certificate = (struct certificate){.kernel = kernel, .dim = dim};
    if (pieces_find(&certificate->pieces, kernel, dim, terms, error) ||
        measure_spectrum_make(&certificate->spectrum, &certificate->pieces, error)) {
        certificate_free(certificate);
        return STATUS_ENVIRONMENT;
    }
    certificate->terms = certificate->pieces.terms;
    certificate->looks_single = pieces_look_single(&certificate->pieces);
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
    if (!certificate->figures.failed) return STATUS_OK;
    certificate_free(certificate);
    return error_set(error, STATUS_ENVIRONMENT, "no memory for the figures of a kernel");
}

void certificate_free(struct certificate *certificate)
{
    pieces_free(&certificate->pieces);
    measure_spectrum_free(&certificate->spectrum);
    findings_free(&certificate->figures);
}

enum status certificate_failing(const struct kernel *kernel, int dim, const struct terms *terms,
                                json_t **failing, struct error *error)
{
    struct certificate *certificate = calloc(1, sizeof *certificate);
    if (!certificate) return error_set(error, STATUS_ENVIRONMENT, "no memory for a certificate");
    const enum status status = certificate_measure(certificate, kernel, dim, terms, error);
    *failing = json_array();
    for (size_t k = 0; k < certificate->figures.count && !status; k++)
        if (certificate->figures.list[k].status == FINDING_FAIL)
            json_array_append_new(*failing, json_string(certificate->figures.list[k].what));
    if (!status) certificate_free(certificate);
    free(certificate);
    return status;
}
