/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "judge_autopsy.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Mean support radius in units of the particle spacing. */
static double mean_eta(const struct judged *judged)
{
    const struct snapshot *s = &judged->result.snapshot;
    double sum = 0;
    for (size_t i = 0; i < s->n; i++)
        sum += s->h[i] / pow(s->m[i] / s->rho[i], 1. / judged->file.dim);
    return sum / (double)s->n;
}

static enum status take_kernel(const struct judged *judged, struct settings *settings,
                               struct error *error)
{
    const struct convention *found = &judged->conventions.candidate[0];
    char eta[40];
    if (!judged->conventions.known || settings->value[SETTING_kernel].source == SOURCE_USER ||
        settings->value[SETTING_eta].source == SOURCE_USER)
        return STATUS_OK;
    snprintf(eta, sizeof eta, "%.9g", mean_eta(judged));
    const enum status status =
        settings_set(settings, SETTING_kernel, found->kernel.member.name, SOURCE_USER, NULL, error);
    return status ? status : settings_set(settings, SETTING_eta, eta, SOURCE_USER, NULL, error);
}

/* Measures the errors of the snapshot, with the smoothing lengths of our run at its particles,
 * because the file may have none. */
static enum status look(const struct judged *judged, const struct run *used,
                        struct autopsy_level *level, struct error *error)
{
    struct run_result result = judged->result;
    struct snapshot *s = &result.snapshot;
    const double eta = settings_real(&used->settings, SETTING_eta);
    double *h = malloc(s->n * sizeof *h);
    if (!h) return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu particles", s->n);
    for (size_t i = 0; i < s->n; i++) h[i] = eta * pow(s->m[i] / s->rho[i], 1. / judged->file.dim);
    s->h = h;
    const enum status status = autopsy_measure_theirs(used, &result, level, error);
    free(h);
    return status;
}

enum status judge_autopsy(const struct judged *judged, struct autopsy_level *level,
                          struct run *used, struct error *error)
{
    struct run_settings asked = judged->run.asked;
    if (take_kernel(judged, &asked.settings, error) || run_resolve(used, &asked, error) ||
        autopsy_check(used, error))
        return error->status;
    return look(judged, used, level, error);
}
