/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "norm.h"

#include <assert.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <math.h>
#include <stdbool.h>

struct norms norm_errors(size_t n, const double *x, const double window[2], const double *volume,
                         const double *value, const double *exact)
{
    struct norms norms = {0};
    double weight = 0;
    bool lost = false; /* a particle with a NaN position must not be ignored */
    for (size_t i = 0; i < n; i++) {
        if (!(window[0] <= x[i] && x[i] <= window[1])) {
            lost |= !isfinite(x[i]);
            continue;
        }
        const double error = fabs(value[i] - exact[i]);
        norms.l1 += volume[i] * error;
        norms.l2 += volume[i] * error * error;
        norms.linf = fmax(norms.linf, error);
        norms.particle_mean += error;
        weight += volume[i];
        norms.n++;
    }
    if (lost || !norms.n || !isfinite(norms.l1)) { /* fmax ignores NaN */
        norms.l1 = norms.l1_whole = norms.l2 = norms.linf = norms.particle_mean = (double)NAN;
        return norms;
    }
    norms.l1 /= weight;
    norms.l1_whole = norms.l1;
    norms.l2 = sqrt(norms.l2 / weight);
    norms.particle_mean /= (double)norms.n;
    return norms;
}

double norm_l1(size_t n, const double *weight, const double *value, const double *exact)
{
    double sum = 0, whole = 0;
    for (size_t i = 0; i < n; i++) {
        if (weight[i] == 0) continue;
        sum += weight[i] * fabs(value[i] - exact[i]);
        whole += weight[i];
    }
    return sum / whole;
}

struct field_call {
    norm_field *field;
    const void *context;
};

static double field_value(double x, void *call)
{
    const struct field_call *c = call;
    return c->field(c->context, x);
}

void norm_bin_means(norm_field *field, const void *context, const double window[2], size_t bins,
                    double *means)
{
    enum { INTERVALS = 400 }; /* a jump needs one halving per binary digit, so this is enough */
    struct field_call call = {field, context};
    gsl_function function = {field_value, &call};
    gsl_integration_workspace *workspace = gsl_integration_workspace_alloc(INTERVALS);
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    const double width = (window[1] - window[0]) / (double)bins;
    for (size_t k = 0; k < bins; k++) {
        const double lo = window[0] + (double)k * width;
        double integral, error;
        gsl_integration_qag(&function, lo, lo + width, 0, 1e-11, INTERVALS, GSL_INTEG_GAUSS15,
                            workspace, &integral, &error);
        means[k] = integral / width;
    }
    gsl_set_error_handler(handler);
    gsl_integration_workspace_free(workspace);
}

double norm_binned_l1(size_t n, const double *x, const double window[2], const double *volume,
                      const double *value, size_t bins, const double *exact_means)
{
    assert(bins <= NORM_BINS_MAX);
    double weight[NORM_BINS_MAX] = {0}, sum[NORM_BINS_MAX] = {0};
    for (size_t i = 0; i < n; i++) {
        if (isnan(x[i])) return NAN;
        if (!(window[0] <= x[i] && x[i] <= window[1])) continue;
        size_t k = (size_t)((x[i] - window[0]) / (window[1] - window[0]) * (double)bins);
        if (k >= bins) k = bins - 1;
        weight[k] += volume[i];
        sum[k] += volume[i] * value[i];
    }
    double error = 0;
    size_t used = 0;
    for (size_t k = 0; k < bins; k++)
        if (weight[k] != 0) {
            error += fabs(exact_means[k] - sum[k] / weight[k]);
            used++;
        }
    return used ? error / (double)used : (double)NAN;
}
