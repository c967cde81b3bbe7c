/* SPDX-License-Identifier: GPL-3.0-or-later
 * The gradient of a Fourier mode sin(k.x) in a periodic box: its projection on the exact k
 * cos(k.x), which determines the speed of a wave (1: exact), and the rest, which is noise. */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "gradient_forms.h"

struct response {
    double projection; /* of the part in phase with cos(k.x): component along k over |k| */
    double noise;      /* rms of the rest over that of k cos(k.x) */
};

static const int mode[3] = {1, 2, -1}; /* k / 2 pi */

static bool response_of(const struct gradient_subject *subject, const struct kernel *kernel,
                        const struct clouds_settings *settings, struct response *response)
{
    struct clouds_cloud cloud;
    if (clouds_make(settings, &cloud, NULL)) return false;
    const int dim = settings->dim;
    const size_t n = cloud.cloud.points.n;
    double *m = calloc(4 * n, sizeof *m);
    struct operator_point *point = calloc(n, sizeof *point);
    double *const f = m, *const g[3] = {m + n, m + 2 * n, m + 3 * n};
    bool ok = m && point;
    cloud.cloud.points.periodic = true;
    for (int a = 0; a < dim; a++) cloud.cloud.points.hi[a] = 1;
    double norm = 0, amplitude[3] = {0}, rest = 0, k2 = 0;
    for (size_t i = 0; ok && i < n; i++) {
        double phase = 0;
        for (int a = 0; a < dim; a++) phase += 2 * M_PI * mode[a] * cloud.x[a][i];
        f[i] = sin(phase);
    }
    ok = ok && !gradient_study_apply(subject, kernel, &cloud.cloud, f, g, point, NULL);
    for (int pass = 0; ok && pass < 2; pass++)
        for (size_t i = 0; i < n; i++) {
            double phase = 0;
            for (int a = 0; a < dim; a++) phase += 2 * M_PI * mode[a] * cloud.x[a][i];
            for (int a = 0; a < dim; a++) {
                if (pass == 0) {
                    amplitude[a] += g[a][i] * cos(phase);
                } else {
                    const double left = g[a][i] - amplitude[a] / norm * cos(phase);
                    rest += left * left;
                }
            }
            if (pass == 0) norm += cos(phase) * cos(phase);
        }
    response->projection = 0;
    for (int a = 0; a < dim; a++) {
        response->projection += 2 * M_PI * mode[a] * amplitude[a] / norm;
        k2 += 4 * M_PI * M_PI * mode[a] * mode[a];
    }
    response->projection /= k2;
    response->noise = sqrt(rest / norm / k2);
    free(m), free(point);
    clouds_free(&cloud);
    return ok;
}

/* The projection on a lattice from the lattice sum itself: k.sum V p sin(k.x)/k^2, over sum V p_0
 * x_0 if the operator is corrected. */
static double symbol(const struct gradient_subject *subject, const struct kernel *kernel,
                     const struct clouds_settings *settings)
{
    const double spacing = 1 / (double)settings->side, h = settings->eta * spacing;
    const int reach = (int)ceil(settings->eta), dim = settings->dim;
    double sum = 0, matrix = 0, k2 = 0;
    for (int a = 0; a < dim; a++) k2 += 4 * M_PI * M_PI * mode[a] * mode[a];
    for (int i = -reach; i <= reach; i++)
        for (int j = dim > 1 ? -reach : 0; j <= (dim > 1 ? reach : 0); j++)
            for (int l = dim > 2 ? -reach : 0; l <= (dim > 2 ? reach : 0); l++) {
                const double x[3] = {i * spacing, j * spacing, l * spacing};
                const double r = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
                if (!(r > 0)) continue;
                const double size = (subject->form->pair_vector == VECTOR_POSITION
                                         ? kernel_value(kernel, r, h, dim)
                                         : -kernel_dr(kernel, r, h, dim) / r) *
                                    pow(spacing, dim);
                double kx = 0;
                for (int a = 0; a < dim; a++) kx += 2 * M_PI * mode[a] * x[a];
                sum += size * kx * sin(kx) / k2;
                matrix += size * x[0] * x[0];
            }
    return subject->form->corrected ? sum / matrix : sum;
}

static void measure_fourier(struct check_run *run, const void *subject)
{
    static const size_t side[] = {0, 40, 18, 9};
    const struct gradient_subject *s = subject;
    const char *name = s->form->member.name;
    struct kernel kernel = {0};
    kernel_select(&kernel, "wendland_c4", 5, NULL);
    for (int dim = 1; dim <= 3; dim++) {
        struct clouds_settings settings = {CLOUDS_LATTICE, dim, side[dim], 0.2, 2.9, 9};
        struct response lattice = {0}, jittered = {0};
        if (!response_of(s, &kernel, &settings, &lattice)) lattice.projection = (double)NAN;
        settings.kind = CLOUDS_JITTERED;
        if (!response_of(s, &kernel, &settings, &jittered)) jittered.projection = (double)NAN;
        const double expected = symbol(s, &kernel, &settings);
        check_measure(run, fabs(lattice.projection - expected), 1e-12, 1e-13,
                      "%s, %dD, lattice: projection %.6f against the lattice sum", name, dim,
                      lattice.projection);
        check_measure(run, lattice.noise, 1e-12, 1e-13, "%s, %dD, lattice: noise", name, dim);
        check_measure(run, fabs(jittered.projection - expected), 0.05, 1e-4,
                      "%s, %dD, jitter 0.2: projection %.4f against the lattice's", name, dim,
                      jittered.projection);
        check_measure(run, jittered.noise, s->form->difference ? 0.15 : 2, 1e-4,
                      "%s, %dD, jitter 0.2: noise", name, dim);
    }
}

static const struct check_mutant fourier_mutants[] = {
    {"fourier_sign", "gradient with respect to r_j", SUBJECT(standard, SIGN)},
    {"fourier_half", "each pair once", SUBJECT(standard, HALF)},
    {"fourier_identity", "identity for the IA matrix", SUBJECT(ia, IDENTITY)},
    {"fourier_short_support", "neighbours up to 0.9 h", SUBJECT(linear_exact, SHORT_SUPPORT)},
    {"fourier_power_of_h", "h^-d in dW/dr", SUBJECT(difference, POWER_OF_H)},
    {"fourier_shepard_only", "normalised kernel without gradient correction",
     SUBJECT(normalised, NO_GRADIENT_CORRECTION)},
    {0},
};

CHECK_DEFINE(
    gradients, fourier, 250, .cost = 0.2,
    .property = "grad sin(k.x): projection on k cos(k.x) equal to the lattice sum, and the noise",
    .subjects = gradient_subjects, .measure = measure_fourier, .mutants = fourier_mutants);
