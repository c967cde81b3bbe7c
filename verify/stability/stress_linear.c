/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stress_part.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "measure.h"
#include "result.h"
#include "stability.h"

#define ETA_MAX 9.5
enum { WAVES = 64, ETAS = 86, BISECTIONS = 7 };

/* --- limits of eta ---------------------------------------------------------------------------- */

static double growth_at(const struct scheme *scheme, double gamma, double eta)
{
    struct stability lattice;
    struct scheme wider = *scheme;
    struct error error;
    wider.eta = eta;
    if (stability_begin(&lattice, &wider, gamma, &error)) return (double)NAN;
    return fmax(0, stability_worst(&lattice, NULL));
}

static json_t *limit(const struct stress_cell *cell, const struct scheme *scheme)
{
    struct run_settings settings = cell->settings;
    struct stability_interval stable[4];
    char reason[256];
    const double gamma = settings_real(&settings.settings, SETTING_gamma);
    const int count = stability_intervals(scheme, gamma, ETA_MAX, stable, 4);
    const double predicted = count ? stable[0].to : (double)NAN;
    if (predicted >= ETA_MAX) {
        stress_noise_set(&settings, SETTING_eta, ETA_MAX);
        const bool grows = stress_noise_grows(&settings, 600);
        snprintf(reason, sizeof reason, "no limit up to eta = %g; noise there %s", ETA_MAX,
                 grows ? "grows" : "does not grow");
        return stress_outcome((double)NAN, grows ? ETA_MAX : (double)NAN,
                              grows ? "inaccurate" : "ok", reason);
    }
    /* beyond the limit but before the next stable interval, for long enough to show the growth */
    const double next = count > 1 ? stable[1].from : ETA_MAX;
    const double beyond = fmin(1.05 * predicted, 0.5 * (predicted + next));
    const double theory = growth_at(scheme, gamma, beyond), half = 5 / theory;
    const double slow = growth_at(scheme, gamma, 0.5 * (predicted + beyond));
    const double time = fmin(fmax(10 / slow, 200), 4000);
    double low = 0.9 * predicted, high = fmin(2 * beyond - predicted, 0.5 * (beyond + next));
    for (int i = 0; i < BISECTIONS; i++) {
        const double eta = 0.5 * (low + high);
        stress_noise_set(&settings, SETTING_eta, eta);
        *(stress_noise_grows(&settings, time) ? &high : &low) = eta;
    }
    const double measured = 0.5 * (low + high);
    stress_noise_set(&settings, SETTING_eta, beyond);
    const double rate =
        log(stress_noise_after(settings, 2 * half) / stress_noise_after(settings, half)) / half;
    int used = snprintf(reason, sizeof reason,
                        "growth at eta = %.3f: %.4f c/dx by theory, %.4f of the noise", beyond,
                        theory, rate);
    for (int i = 1; i < count && used < (int)sizeof reason; i++)
        used += snprintf(reason + used, sizeof reason - (size_t)used,
                         "; stable again from %.2f to %.2f", stable[i].from, stable[i].to);
    return stress_outcome(predicted, measured,
                          fabs(measured / predicted - 1) <= 0.05 ? "ok" : "inaccurate", reason);
}

/* --- largest time steps ----------------------------------------------------------------------- */

/* Viscosity acts on approaching pairs: on half of those in noise at rest, which the cells measure.
 * A sound wave switches it off in expanding gas, where rk2 and vl2, which need it (without it their
 * longest stable step is near zero), are stable only for shorter steps. Measured as the step at
 * which the velocity error is 1.5 times that of short steps (amplitude 1e-4, 64 particles, t = 10),
 * eta 2 and 4.8: rk2 0.49, 1.65; vl2 0.50, 1.64; rk3 0.93, 3.06; leapfrog 0.50, 1.57;
 * modified_leapfrog 0.75, 2.21. Noise at rest, by theory: rk2 0.59, 1.79. */
static double step_limit(struct stability *lattice, double approaching)
{
    lattice->approaching = approaching;
    return stability_time_step(lattice, 5);
}

static json_t *time_step(const struct stress_cell *cell, const struct scheme *scheme,
                         struct error *error)
{
    struct run_settings settings = cell->settings;
    struct stability lattice;
    char reason[256];
    const double gamma = settings_real(&settings.settings, SETTING_gamma);
    if (stability_begin(&lattice, scheme, gamma, error)) return NULL;
    const bool known = stability_knows(scheme->integrator);
    const double inviscid = step_limit(&lattice, 0), wave = step_limit(&lattice, 0.25),
                 predicted = step_limit(&lattice, 0.5);
    double low = 0, high = known ? 1.5 * predicted : 5;
    for (int i = 0; i < BISECTIONS + 1; i++) {
        const double step = 0.5 * (low + high);
        stress_noise_set(&settings, SETTING_cfl, 2 * step / lattice.h);
        *(stress_noise_grows(&settings, 600) ? &high : &low) = step;
    }
    const double measured = 0.5 * (low + high);
    if (!known)
        return stress_outcome((double)NAN, measured, "ok", "no theory of this integrator's steps");
    snprintf(reason, sizeof reason,
             "c dt/dx: theory %.3f with viscosity on half of the pairs (noise at rest), %.3f on a "
             "quarter (sound waves, which switch it off where gas expands), %.3f without",
             predicted, wave, inviscid);
    const bool good = measured >= 0.95 * inviscid && measured <= 1.05 * predicted;
    return stress_outcome(predicted, measured, good ? "ok" : "inaccurate", reason);
}

/* --- pairing ---------------------------------------------------------------------------------- */

static json_t *pairing(const struct stress_cell *cell, const struct scheme *scheme)
{
    const int dim = cell->column->label[0] - '0';
    const double onset = measure_pairing(&scheme->kernel, dim);
    char reason[128];
    if (isnan(onset))
        snprintf(reason, sizeof reason, "none up to %d neighbours", MEASURE_NEIGHBOURS_MAX);
    else
        snprintf(reason, sizeof reason, "pairs have less energy from %.0f neighbours on", onset);
    return stress_outcome(onset, (double)NAN, "ok", reason);
}

enum status stress_linear(const struct stress_cell *cell, json_t **document, struct error *error)
{
    struct run run;
    const struct scheme *scheme = &run.scheme;
    if (run_resolve(&run, &cell->settings, error)) return error->status;
    if (cell->group->kind == STRESS_LIMIT)
        *document = limit(cell, scheme);
    else if (cell->group->kind == STRESS_STEP)
        *document = time_step(cell, scheme, error);
    else
        *document = pairing(cell, scheme);
    return *document ? STATUS_OK : error->status;
}

/* --- the atlas -------------------------------------------------------------------------------- */

static struct scheme atlas_scheme(const char *kernel, enum gradient gradient, double eta)
{
    struct settings settings;
    struct scheme scheme;
    settings_init(&settings);
    settings_scheme(&settings, 1, &scheme, NULL);
    kernel_select(&scheme.kernel, kernel, 5, NULL);
    scheme.gradient = gradient;
    scheme.viscosity = VISCOSITY_NONE;
    scheme.h_method = H_NEWTON;
    scheme.eta = eta;
    return scheme;
}

static json_t *growth_row(const char *kernel, enum gradient gradient)
{
    json_t *growth = json_array();
    for (int i = 0; i < ETAS; i++) {
        const struct scheme scheme = atlas_scheme(kernel, gradient, 1 + 0.1 * i);
        const double rate = growth_at(&scheme, 1.4, scheme.eta);
        json_array_append_new(growth, result_number_or_null(rate));
    }
    return result_object("kernel=%s gradient=%s growth=%p", kernel,
                         scheme_gradient_family.members[gradient]->name, (void *)growth);
}

/* alpha > 0: viscosity on half of the pairs, and negative growth is damping. */
static json_t *wave_row(const char *kernel, enum gradient gradient, double eta, double alpha)
{
    struct scheme scheme = atlas_scheme(kernel, gradient, eta);
    scheme.viscosity = alpha > 0 ? VISCOSITY_CONSTANT : VISCOSITY_NONE;
    scheme.alpha = alpha;
    struct stability lattice;
    struct error error;
    json_t *kappa = json_array(), *frequency = json_array(), *growth = json_array();
    const enum status status = stability_begin(&lattice, &scheme, 1.4, &error);
    for (int i = 1; i <= WAVES && !status; i++) {
        double omega;
        const double k = M_PI * i / WAVES, rate = stability_growth(&lattice, k, &omega);
        json_array_append_new(kappa, result_number(k));
        json_array_append_new(frequency, result_number(omega));
        json_array_append_new(growth, result_number(rate));
    }
    return result_object("kernel=%s gradient=%s eta=%g alpha=%g kappa=%p frequency=%p growth=%p",
                         kernel, scheme_gradient_family.members[gradient]->name, eta, alpha,
                         (void *)kappa, (void *)frequency, (void *)growth);
}

/* Growth over eta and wavenumber, row by row of the wavenumber. */
static json_t *map_of(const char *kernel, enum gradient gradient)
{
    enum { NX = 41, NY = 32 };
    json_t *eta = json_array(), *kappa = json_array(), *growth = json_array();
    double rates[NX][NY];
    for (int i = 0; i < NX; i++) {
        const struct scheme scheme = atlas_scheme(kernel, gradient, 2 + 0.1 * i);
        struct stability lattice;
        struct error error;
        const bool sound = !stability_begin(&lattice, &scheme, 1.4, &error);
        for (int j = 0; j < NY; j++)
            rates[i][j] = sound ? stability_growth(&lattice, M_PI * (j + 1) / NY, NULL) : 0;
        json_array_append_new(eta, result_number(scheme.eta));
    }
    for (int j = 0; j < NY; j++) {
        json_array_append_new(kappa, result_number(M_PI * (j + 1) / NY));
        for (int i = 0; i < NX; i++)
            json_array_append_new(growth, result_number(fmax(0, rates[i][j])));
    }
    return result_object("kernel=%s gradient=%s eta=%p kappa=%p growth=%p", kernel,
                         scheme_gradient_family.members[gradient]->name, (void *)eta, (void *)kappa,
                         (void *)growth);
}

/* It depends on nothing, and is found once. */
json_t *stress_linear_atlas(void)
{
    static json_t *kept;
    if (kept) return json_incref(kept);
    json_t *eta = json_array(), *rows = json_array(), *waves = json_array();
    for (int i = 0; i < ETAS; i++) json_array_append_new(eta, result_number(1 + 0.1 * i));
    for (int g = 0; g < 2; g++)
        for (size_t k = 0; k < kernel_family.n; k++)
            json_array_append_new(rows,
                                  growth_row(kernel_family.members[k]->name, (enum gradient)g));
    json_array_append_new(waves, wave_row("quadratic_spline", GRADIENT_STANDARD, 1.5, 0));
    json_array_append_new(waves, wave_row("cubic_spline", GRADIENT_STANDARD, 4.8, 0));
    json_array_append_new(waves, wave_row("cubic_spline", GRADIENT_IA, 2, 0));
    json_array_append_new(waves, wave_row("cubic_spline", GRADIENT_IA, 4.2, 0));
    json_array_append_new(waves, wave_row("cubic_spline", GRADIENT_IA, 4.8, 0));
    json_array_append_new(waves, wave_row("cubic_spline", GRADIENT_IA, 4.8, 1));
    kept = result_object("eta=%p rows=%p waves=%p map=%p", (void *)eta, (void *)rows, (void *)waves,
                         (void *)map_of("cubic_spline", GRADIENT_IA));
    return json_incref(kept);
}
