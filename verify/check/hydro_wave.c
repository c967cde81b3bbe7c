/* SPDX-License-Identifier: GPL-3.0-or-later
 * A sound wave along, across and oblique to the lattice, in 2D and 3D: the error of its velocity
 * falls with order 2 and is the same along every axis and in both directions. Whole runs, started
 * as every command starts them, against the simple wave. */
#include <math.h>
#include <stdio.h>

#include "check.h"
#include "order.h"
#include "run.h"

enum { LEVELS = 4, KEYS_MAX = 12, KEY = 40 };

static const double amplitude = 1e-3, speed = 1.1832159566199232; /* (1.4)^(1/2) */

/* Runs of three sizes. */
struct wave {
    const char *direction, *hi; /* keys: a strip replaces the whole box and is cheaper */
    int dim;
    double volume;             /* of the box */
    int side[LEVELS];          /* particles per unit length */
    const char *const *kernel; /* kernel and width, as keys */
    /* allowed: deviation of the order from 2; bound: error of the last level, relative to the
     * wave's velocity. Oblique waves are shorter, so h is a larger fraction of them. */
    double allowed, bound;
};

static const char *const c2[] = {"kernel=wendland_c2", "eta=2.4"};
static const char *const c4[] = {"kernel=wendland_c4", "eta=3.6"};

static const struct wave quick_waves[] = {
    {"direction=1 0", "hi=1,0.25", 2, 0.25, {32, 40, 48, 64}, c4, 0.35, 2e-3},
    {"direction=1 1", "hi=1", 2, 1, {24, 28, 36, 48}, c2, 0.5, 5e-3},
    {"direction=1 0 0", "hi=1,0.5,0.5", 3, 0.25, {12, 14, 20, 24}, c2, 0.5, 2e-2},
};
static const struct wave fine_waves[] = {
    {"direction=1 1", "hi=1", 2, 1, {32, 40, 48, 64}, c4, 0.35, 3e-3},
    {"direction=2 1", "hi=1", 2, 1, {48, 64, 80, 96}, c4, 0.35, 6e-3},
    {"direction=1 0 0", "hi=1,0.5,0.5", 3, 0.25, {16, 20, 24, 32}, c2, 0.35, 8e-3},
    {"direction=1 1 0", "hi=1,1,0.5", 3, 0.5, {16, 20, 24, 32}, c2, 0.5, 2e-2},
    {"direction=1 1 1", "hi=1", 3, 1, {16, 20, 24, 32}, c2, 0.5, 2e-2},
};
enum { QUICK = sizeof quick_waves / sizeof *quick_waves };
enum { FINE = sizeof fine_waves / sizeof *fine_waves };

/* A mutant: an additional key, or another field's error. */
struct wave_subject {
    const char *key;
    enum field field;
};
static const struct wave_subject right = {"alpha_u=0", FIELD_VELOCITY};

/* L1 of the velocity at t = 0.1; NaN after noting the reason. */
static double error_of(struct check_run *run, const struct wave *wave,
                       const struct wave_subject *subject, int side, const char *direction,
                       const char *hi)
{
    char n[KEY], time[] = "t_end=0.1", size[] = "amplitude=1e-3";
    char *keys[KEYS_MAX] = {n,
                            time,
                            size,
                            (char *)direction,
                            (char *)hi,
                            (char *)wave->kernel[0],
                            (char *)wave->kernel[1],
                            (char *)subject->key};
    struct run_settings settings;
    struct run solved;
    struct run_result result;
    struct error error = {0};
    snprintf(n, sizeof n, "n=%.0f", round(wave->volume * pow(side, wave->dim)));
    enum status status =
        run_prepare(&settings, wave->dim == 2 ? "sound_wave_2d" : "sound_wave_3d", 8, keys, &error);
    settings.threads = 1;
    if (!status) status = run_resolve(&solved, &settings, &error);
    if (!status) status = run_execute(&solved, &result, &error);
    if (status && status != STATUS_BROKE_DOWN) {
        check_measure(run, 1, 0, 0, "%s: %s", direction, error.message);
        return (double)NAN;
    }
    const double found = status ? (double)NAN : run_error(&result, subject->field, NORM_L1);
    run_free(&result);
    return found / (amplitude * speed);
}

static void measure_wave(struct check_run *run, const struct wave *wave,
                         const struct wave_subject *subject)
{
    double spacing[LEVELS], error[LEVELS];
    struct order_fit fit;
    struct error failure = {0};
    for (int l = 0; l < LEVELS; l++) {
        spacing[l] = 1. / wave->side[l];
        error[l] = error_of(run, wave, subject, wave->side[l], wave->direction, wave->hi);
    }
    if (order_fit(LEVELS, spacing, error, NULL, &fit, &failure)) {
        check_measure(run, 1, 0, 0, "%s: %s", wave->direction, failure.message);
        return;
    }
    check_series(run, wave->direction, LEVELS, spacing, error);
    check_measure(run, fabs(fit.order - 2), wave->allowed, 0.02, "%s: order %.3f against 2",
                  wave->direction, fit.order);
    check_measure(run, fit.finest, wave->bound, 1e-6, "%s: error of the velocity at the finest n",
                  wave->direction);
}

/* Exchanging the axes, or left and right, must not change the result. */
static void measure_same(struct check_run *run, const struct wave_subject *subject)
{
    static const struct wave wave = {NULL, NULL, 2, 0.5, {24}, c4, 0, 0};
    const double one = error_of(run, &wave, subject, 24, "direction=1 0", "hi=1,0.5");
    const double across = error_of(run, &wave, subject, 24, "direction=0 1", "hi=0.5,1");
    const double left = error_of(run, &wave, subject, 24, "direction=-1 0", "hi=1,0.5");
    check_measure(run, fabs(across / one - 1), 1e-8, 1e-11, "along y against along x");
    check_measure(run, fabs(left / one - 1), 1e-8, 1e-11, "to the left against to the right");
}

static void measure_quick(struct check_run *run, const void *subject)
{
    const struct wave_subject *of = subject ? subject : &right;
    measure_same(run, of);
    for (int w = 0; w < QUICK && !check_decided(run); w++) measure_wave(run, &quick_waves[w], of);
}

static void measure_fine(struct check_run *run, const void *subject)
{
    const struct wave_subject *of = subject ? subject : &right;
    for (int w = 0; w < FINE && !check_decided(run); w++) measure_wave(run, &fine_waves[w], of);
}

static const struct wave_subject viscous = {"viscosity=constant", FIELD_VELOCITY},
                                 dense = {"alpha_u=0", FIELD_DENSITY},
                                 leaning = {"jitter=1e-3", FIELD_VELOCITY};

static const struct check_mutant quick_mutants[] = {
    {"wave_viscous", "a viscosity of first order in smooth flow", &viscous},
    {"wave_of_density", "the error of the density, which has the floor of the kernel's sums",
     &dense},
    {"wave_leaning", "particles a thousandth of the spacing beside the lattice", &leaning},
    {0},
};

static const struct check_mutant fine_mutants[] = {
    {"wave_fine_viscous", "a viscosity of first order in smooth flow", &viscous},
    {"wave_fine_of_density", "the error of the density, which has the floor of the kernel's sums",
     &dense},
    {0},
};

CHECK_DEFINE(
    hydro, waves_of_clouds, 750, .cost = 0.4,
    .property =
        "sound along, across and along the diagonal of lattices: order 2, no axis preferred",
    .measure = measure_quick, .mutants = quick_mutants);

CHECK_DEFINE(hydro, waves_of_clouds_fine, 750, .cost = 3,
             .property = "sound along, diagonal and oblique to lattices in 2D and 3D: order 2",
             .slow = true, .measure = measure_fine, .mutants = fine_mutants);
