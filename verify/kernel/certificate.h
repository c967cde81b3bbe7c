/* SPDX-License-Identifier: GPL-3.0-or-later
 * The certificate of a kernel in one dimension: what was measured, and whether every property
 * holds. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

#include "findings.h"
#include "measure.h"
#include "property.h"

enum { CERTIFICATE_WIDTHS = 8 };

struct certificate {
    const struct kernel *kernel; /* not owned */
    int dim;
    struct pieces pieces;
    struct measure_spectrum spectrum;
    struct measure_moments moments;
    struct measure_class class;
    struct measure_fourier fourier;
    struct terms terms;
    bool looks_single;
    double pairing; /* see measure_pairing */
    struct {        /* lattice sums against width: multiples of the mean spacing */
        double eta, density, gradient;
    } lattice[CERTIFICATE_WIDTHS];
    struct findings figures; /* what: the property's name */
    size_t failed;
};

/* Samples and seed for a single kernel. */
enum { CERTIFICATE_SAMPLES = 1 << 20, CERTIFICATE_SEED = 1 };

/* Measures all properties of a kernel in dim dimensions on these terms (NULL: pieces_terms_usual).
 * STATUS_ENVIRONMENT: no memory. A failed property is no error, see failed. Release with
 * certificate_free; kernel must outlive it. */
enum status certificate_measure(struct certificate *certificate, const struct kernel *kernel,
                                int dim, const struct terms *terms, struct error *error);
void certificate_free(struct certificate *certificate);

/* The names of the failed checks, a new array, for plugin_certify. */
enum status certificate_failing(const struct kernel *kernel, int dim, const struct terms *terms,
                                json_t **failing, struct error *error);

/* Prints the certificate; h: support radius, which scales lengths. */
void certificate_print(const struct certificate *certificate, double h, FILE *stream, bool color);

/* Adds "normalisation", "moments", "class", "fourier" ... and "checks" to document. */
void certificate_json(const struct certificate *certificate, double h, json_t *document);

/* The figures as a list of checks, see `sphproof verify`; new reference. */
json_t *certificate_checks(const struct certificate *certificate);

/* The curves of W, W', W'' and the transform, for certificate_plot; new reference. */
json_t *certificate_curves(const struct certificate *certificate);

/* Draws the curves to path (.svg or .png). */
enum status certificate_plot(const json_t *curves, const char *path, struct error *error);
