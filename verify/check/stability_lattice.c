/* SPDX-License-Identifier: GPL-3.0-or-later
 * Waves of lattices in 2D and 3D by differences of the solver's forces (lattice_waves.h): long
 * waves travel with the speed of sound in every direction. */
#include <math.h>
#include <stdio.h>

#include "check.h"
#include "lattice_waves.h"
#include "stress_part.h"

/* The greatest frequency of a wave is compared with that of sound, (gamma P/rho)^(1/2). */
struct lattice_subject {
    double speed; /* relative to the sound speed */
};

static const struct lattice_subject right = {1};

/* Measures a wave on a lattice of `side` particles a side. */
static void measure_wave(struct check_run *run, const struct lattice_subject *subject, int dim,
                         int side, const int whole[3], const char *gradient)
{
    char n[32], key[40];
    char *keys[] = {n,
                    "jitter=0",
                    "viscosity=none",
                    "energy=internal",
                    "kernel=wendland_c4",
                    "eta=2.4",
                    "h_method=newton",
                    dim == 2 ? "lattice=square" : "lattice=cubic",
                    key};
    struct run_settings settings;
    struct lattice_waves lattice;
    struct lattice_wave wave = {(double)NAN, (double)NAN};
    struct error error = {0};
    snprintf(n, sizeof n, "n=%d", dim == 2 ? side * side : side * side * side);
    snprintf(key, sizeof key, "gradient=%s", gradient);
    if (!run_prepare(&settings, dim == 2 ? "rest_2d" : "rest_3d", sizeof keys / sizeof *keys, keys,
                     &error)) {
        settings.threads = 1;
        if (!lattice_waves_begin(&lattice, &settings, &error))
            lattice_waves_at(&lattice, whole, &wave, &error);
        lattice_waves_free(&lattice);
    }
    const double k = 2 * M_PI / side * sqrt(whole[0] * whole[0] + whole[1] * whole[1]);
    check_measure(run, fabs(wave.frequency / (k * subject->speed) - 1), 0.06, 1e-6,
                  "%s, %dD, %d, %d wavelengths across the box: frequency over sound's", gradient,
                  dim, whole[0], whole[1]);
}

/* Runs noise with leapfrog: a short enough step does not amplify it. A step so long that the run
 * breaks down before the first measurement counts as growth, too. */
static void measure_noise(struct check_run *run, const char *cfl, bool grows)
{
    char *keys[] = {"n=10^2",         "jitter=1e-6",         "viscosity=none", "energy=internal",
                    "gamma=1.0001",   "kernel=cubic_spline", "eta=2.4",        "gradient=standard",
                    "lattice=square", "integrator=leapfrog", (char *)cfl};
    struct run_settings settings;
    struct error error = {0};
    if (run_prepare(&settings, "rest_2d", sizeof keys / sizeof *keys, keys, &error))
        check_measure(run, 1, 0, 0, "%s", error.message);
    settings.threads = 1;
    check_measure(run, stress_noise_grows(&settings, 40) != grows, 0, 0, "noise with %s %s", cfl,
                  grows ? "grows" : "does not grow");
}

static void measure(struct check_run *run, const void *subject)
{
    const struct lattice_subject *of = subject ? subject : &right;
    measure_wave(run, of, 2, 20, (const int[]){1, 0, 0}, "standard");
    measure_wave(run, of, 2, 20, (const int[]){1, 1, 0}, "standard");
    measure_wave(run, of, 2, 20, (const int[]){1, 0, 0}, "ia");
    measure_wave(run, of, 3, 12, (const int[]){1, 0, 0}, "standard");
    measure_noise(run, "cfl=0.5", false);
    measure_noise(run, "cfl=3", true);
}

static const struct lattice_subject isothermal = {0.7745966692414834}; /* (3/5)^(1/2) */

static const struct check_mutant mutants[] = {
    {"lattice_isothermal", "sound that does not warm the gas", &isothermal},
    {0},
};

CHECK_DEFINE(stability, lattice, 950,
             .property = "on lattices in 2D and 3D long waves run as fast as sound",
             .measure = measure, .mutants = mutants);
