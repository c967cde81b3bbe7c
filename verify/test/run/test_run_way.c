/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests whole runs: conservation, breakdowns, times of snapshots, growing amplitudes. (snapshots.py
 * tests that snapshots change nothing, checkpoint.py that runs can be resumed.) */
#include "test.h"

#include "initial.h"
#include "keyed.h"
#include "own_folder.h"
#include "precision.h"

/* Sums at the start and at the end agree with direct ones; errors and functionals are measured. */
TEST(what_is_conserved)
{
    for (int plain = 0; plain < 2; plain++) {
        struct run run = keyed_run("sod", "n=60 t_end=0.1 energy=internal gradient=ia "
                                          "integrator=leapfrog kernel=cubic_spline");
        struct initial initial;
        struct error error;
        run.asked.solver = plain ? precision_plain : NULL;
        assert_int_equal(initial_create(&initial, &run.problem, &run.settings, &error), STATUS_OK);
        double energy[2] = {0}, momentum[2] = {0}, size = 0;
        for (size_t i = 0; i < initial.n; i++) {
            const double v = initial.v[0][i];
            energy[0] += initial.m[i] * (initial.u[i] + 0.5 * v * v);
            momentum[0] += initial.m[i] * v;
        }
        initial_free(&initial);
        if (plain) {
            /* the plain solver has one scheme, and refuses others */
            struct run_result none = {0};
            assert_int_equal(run_execute(&run, &none, &error), STATUS_BAD_INPUT);
            assert_ptr_equal(strstr(error.message, "plain: only"), error.message);
            assert_null(none.storage);
            run =
                keyed_run("sod", "n=60 t_end=0.1 integrator=modified_leapfrog kernel=cubic_spline");
            run.asked.solver = precision_plain;
        }
        struct run_result result = keyed_result(&run);
        const struct snapshot *s = &result.snapshot;
        for (size_t i = 0; i < s->n; i++) {
            energy[1] += s->m[i] * (s->u[i] + 0.5 * s->v[0][i] * s->v[0][i]);
            momentum[1] += s->m[i] * s->v[0][i];
            size += s->m[i] * fabs(s->v[0][i]);
        }
        near_absolute(1 + result.drift.energy, 1 + fabs(energy[1] - energy[0]) / energy[0], 1e-12);
        near_absolute(1 + result.drift.momentum, 1 + fabs(momentum[1] - momentum[0]) / size, 1e-12);
        near_below(result.drift.mass, 1e-13);
        if (!plain) assert_true(result.drift.energy > 1e-9);
        assert_true(result.status == STATUS_OK && !result.message[0]);
        assert_true(result.time == 0.1 && result.cost.steps > 5 && result.functional_count > 0);
        assert_true(result.errors[FIELD_DENSITY].l1 > 0 && result.peak_rss > 1e6);
        if (!plain) assert_true(result.matrix.condition_max >= 1);
        assert_true(result.regularity.nearest > 0);
        run_free(&result);
    }
}

/* A run that breaks down reports that in its result and as an error, and leaves its last valid
 * state. */
TEST(breakdowns)
{
    const struct run run = keyed_run("two_rarefactions", "n=40 cfl=50");
    struct run_result result = {0};
    struct error error = {0};
    assert_int_equal(run_execute(&run, &result, &error), STATUS_BROKE_DOWN);
    assert_int_equal(result.status, STATUS_BROKE_DOWN);
    assert_true(result.message[0] && result.snapshot.n == 40);
    assert_string_equal(error.message, result.message);
    assert_int_equal(error.status, STATUS_BROKE_DOWN);
    assert_true(isnan(result.matrix.condition_max));
    run_free(&result);
}

static size_t text_of(const char *path, char *text, size_t most)
{
    FILE *file = fopen(path, "r");
    if (!file) return 0;
    const size_t n = fread(text, 1, most, file);
    fclose(file);
    return n;
}

/* Blocks of local steps do not step over the time of a snapshot. */
TEST(snapshots_within_blocks_of_steps)
{
    static char text[1024];
    char path[256];
    struct snapshots snapshots = {.path = path, .every = 0.01};
    struct run run =
        keyed_run("noh_2d", "n=1394 t_end=0.12 steps=local kernel=cubic_spline skip=none");
    snprintf(path, sizeof path, "%s", path_of("s.csv"));
    run.asked.snapshots = &snapshots;
    struct run_result result = keyed_result(&run);
    assert_int_equal(snapshots.trouble.status, STATUS_OK);
    assert_true(result.cost.skipped_particle_updates > 0);
    run_free(&result);
    for (size_t k = 0; k < 12; k++) {
        const struct snapshots_path file = snapshots_path(&snapshots, k);
        const size_t n = text_of(file.text, text, sizeof text - 1);
        text[n] = '\0';
        const char *time = strstr(text, "time = ");
        assert_non_null(time);
        assert_true(strtod(time + 7, NULL) == snapshots_time(&snapshots, k));
        unlink(file.text);
    }
}

/* The amplitude is sampled 17 times while it grows, within the time of the run. */
TEST(samples_of_a_growing_amplitude)
{
    struct run run = keyed_run("kelvin_helmholtz_mode", "n=12^2 t_end=1.84");
    double times[2];
    run.problem.problem->growing->during(&run.problem, times);
    assert_true(times[0] > 0 && times[1] < 1.84 + 1e-2 && times[0] < times[1]);
    for (int parts = 4; parts <= 16; parts += 6) {
        char words[64];
        /* the run ends between two samples */
        snprintf(words, sizeof words, "n=12^2 t_end=%.17g",
                 times[0] + (times[1] - times[0]) * (parts - 0.5) / 16);
        run = keyed_run("kelvin_helmholtz_mode", words);
        struct run_result result = keyed_result(&run);
        double t = 0, tt = 0;
        for (int i = 0; i < parts; i++) {
            const double stop = times[0] + (times[1] - times[0]) * i / 16;
            t += stop, tt += stop * stop;
        }
        assert_int_equal(result.growth.n, parts);
        near_relative(result.growth.t, t, 1e-13);
        near_relative(result.growth.tt, tt, 1e-13);
        assert_true(isfinite(result.growth.y) && isfinite(result.growth.ty));
        run_free(&result);
    }
}
