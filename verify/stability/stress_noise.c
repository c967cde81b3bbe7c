/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stress_part.h"

#include <math.h>

void stress_noise_set(struct run_settings *settings, enum setting key, double value)
{
    settings->settings.value[key].real[0] = value;
    settings->settings.value[key].automatic = false;
}

static bool within_budget(void *context, double time, uint64_t steps)
{
    (void)time;
    return (double)steps < *(const double *)context;
}

double stress_noise_after(struct run_settings settings, double time)
{
    struct run run;
    struct run_result result;
    struct error error;
    const double gamma = settings_real(&settings.settings, SETTING_gamma), c = sqrt(gamma);
    const double spacing =
        pow(settings_real(&settings.settings, SETTING_n), -1. / settings.file.dimension);
    stress_noise_set(&settings, SETTING_t_end, time / c * spacing);
    /* collapsing time steps count as growth */
    double budget = 500 + 8 * time;
    settings.progress = within_budget;
    settings.progress_context = &budget;
    enum status status = run_resolve(&run, &settings, &error);
    if (!status) status = run_execute(&run, &result, &error);
    const bool whole =
        status == STATUS_OK && result.time >= settings_real(&settings.settings, SETTING_t_end);
    const double noise = whole ? run_error(&result, FIELD_VELOCITY, NORM_L2) / c : (double)INFINITY;
    if (status == STATUS_OK || status == STATUS_BROKE_DOWN) run_free(&result);
    return noise;
}

enum { EARLY = 20 }; /* spacings/c, until motion and pressure of the noise balance */

/* Noise from a jitter of 1e-6 above this has already grown and need not double again. */
static const double much = 1e-3;

bool stress_noise_grows(const struct run_settings *settings, double time)
{
    const double early = stress_noise_after(*settings, EARLY);
    return !(early <= much) || !(stress_noise_after(*settings, time) <= 2 * early);
}
