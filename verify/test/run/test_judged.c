/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests which figures a case is judged by, in which order, and the error of a run relative to its
 * signal, on made-up results. */
#include "test.h"

#include "judged.h"
#include "keyed.h"

enum { N = 5 };
/* one more after the last, which must not count */
static const double x[2][N + 1] = {{0.1, 0.4, 0.5, 0.9, 0.7, 0.6}, {0.2, 0.3, 0.8, 0.1, 0.6, 0.5}};
static const double volume[N + 1] = {0.1, 0.25, 0.3, 0.15, 0.2, 9};
static const bool inside[N] = {true, true, true, false, true};
static bool still;   /* the exact velocity is uniform */
static double faint; /* > 0: the velocity's size, to the left and to the right, in gas with c = 2 */

static void sample(const struct prepared *p, const double at[3], double t, struct problem_state *s)
{
    if (faint > 0) {
        *s = (struct problem_state){.rho = 3, .v = {at[0] < 0.5 ? -faint : faint}, .P = 8, .u = 1};
        return;
    }
    (void)p;
    *s = (struct problem_state){
        .rho = 1 + 1e6 * at[2] + at[0] * at[0] + 2 * at[1],
        .v = {still ? 0 : at[0], still ? 3 : at[1] * at[1], still ? 1 : 2 * at[0]},
        .P = 3 + at[1] + t,
        .u = 2};
}

static struct problem problem; /* of the result; the names follow from the case file */

/* A result in 2D; four of its five particles lie in the window. */
static void make(struct run_settings *settings, struct run_result *result, const char *name)
{
    const struct run run = keyed_run(name, "");
    *settings = run.asked;
    *result = (struct run_result){.settings = run.settings, .problem = run.problem, .n = N};
    problem = *run.problem.problem;
    problem.sample = sample;
    result->problem.problem = &problem;
    result->problem.gamma = 1.5;
    result->problem.window =
        (struct window){.dim = 2, .lo = {0.05, 0.15}, .hi = {0.8, 0.9}, .centre = {0.425, 0.525}};
    result->time = 0.5;
    result->snapshot = (struct snapshot){.n = N, .x = {x[0], x[1]}, .volume = volume, .time = 0.5};
    for (int f = 0; f < FIELDS; f++)
        result->errors[f] = (struct norms){.l1 = 0.01 * (f + 1), .l1_whole = 0.1 * (f + 1)};
    result->azimuthal.l1 = 0.77;
    result->radial.l1 = 0.88;
}

static void names_are(const struct case_file *file, size_t count, const char *const *functionals,
                      const double *exact, size_t n, const char *const *want)
{
    const char *names[JUDGED_MAX];
    assert_int_equal(judged_names(file, count, functionals, exact, names), n);
    for (size_t i = 0; i < n; i++) assert_string_equal(names[i], want[i]);
}

/* Parts of a circular flow, fields with a gate, fields without one; functionals with an exact value
 * if no field is known. */
TEST(names_of_judged_figures)
{
    static const char *const functionals[] = {"growth_rate", "mode_noise", "mode_error"};
    static const double exact[] = {1.7, (double)NAN, 0};
    struct run_settings settings;
    struct run_result result;
    struct case_file *file = &settings.file;
    make(&settings, &result, "gresho");
    memset(file->fields, 0, sizeof file->fields);
    file->fields[FIELD_DENSITY] = file->fields[FIELD_VELOCITY] = true;
    file->fields[FIELD_INTERNAL_ENERGY] = true;
    file->gate_count = 3;
    file->gates[0] = (struct case_gate){.field = FIELD_INTERNAL_ENERGY, .norm = NORM_L2};
    file->gates[1] = (struct case_gate){.functional = "disc_error", .field = FIELD_DENSITY};
    for (int f = 0; f < FIELDS; f++) file->exact[f] = true; /* has no effect here */
    file->gates[2] = (struct case_gate){.field = FIELD_PRESSURE};
    names_are(
        file, 3, functionals, exact, 5,
        (const char *const[]){"azimuthal", "radial", "internal_energy", "density", "velocity"});
    file->gates[3] = (struct case_gate){.field = FIELD_DENSITY}; /* one too many */
    names_are(
        file, 0, NULL, NULL, 5,
        (const char *const[]){"azimuthal", "radial", "internal_energy", "density", "velocity"});
    file->gate_count = 0;
    file->dimension = 1;
    names_are(file, 3, functionals, exact, 3,
              (const char *const[]){"density", "velocity", "internal_energy"});
    make(&settings, &result, "noh_2d"); /* the flow is towards the middle, not around it */
    memset(file->fields, 0, sizeof file->fields);
    file->fields[FIELD_PRESSURE] = true;
    names_are(file, 3, functionals, exact, 1, (const char *const[]){"pressure"});
    make(&settings, &result, "kelvin_helmholtz_mode");
    names_are(file, 3, functionals, exact, 2, (const char *const[]){"growth_rate", "mode_error"});
    names_are(file, 1, functionals, exact, 1, (const char *const[]){"growth_rate"});
    names_are(file, 0, NULL, NULL, 0, NULL);
}

/* The mean absolute deviation of a field, by volume, over the particles in the window. */
static double signal_of(double value[N][3])
{
    double mean[3] = {0}, all = 0, sum = 0;
    for (int i = 0; i < N; i++)
        for (int d = 0; d < 3 && inside[i]; d++) mean[d] += volume[i] * value[i][d];
    for (int i = 0; i < N; i++) all += inside[i] ? volume[i] : 0;
    for (int i = 0; i < N; i++) {
        const double a = value[i][0] - mean[0] / all, b = value[i][1] - mean[1] / all,
                     c = value[i][2] - mean[2] / all;
        sum += inside[i] ? volume[i] * sqrt(a * a + b * b + c * c) : 0;
    }
    return sum / all;
}

static void judged_is(const struct run_settings *settings, const struct run_result *result,
                      const char *name, double error, double signal)
{
    struct judged judged;
    judged_of(&settings->file, result, &judged);
    assert_string_equal(judged.name, name);
    near_relative(judged.error, error, 1e-15);
    near_relative(judged.signal, signal, 1e-14);
}

TEST(errors_and_signals_of_fields)
{
    struct run_settings settings;
    struct run_result result;
    double rho[N][3] = {{0}}, v[N][3], P[N][3] = {{0}}, sound = 0, all = 0;
    still = false;
    make(&settings, &result, "square");
    memset(settings.file.fields, 0, sizeof settings.file.fields);
    settings.file.gate_count = 0;
    for (int i = 0; i < N; i++) {
        rho[i][0] = 1 + x[0][i] * x[0][i] + 2 * x[1][i];
        v[i][0] = x[0][i], v[i][1] = x[1][i] * x[1][i], v[i][2] = 2 * x[0][i];
        P[i][0] = 3.5 + x[1][i];
        if (!inside[i]) continue;
        sound += volume[i] * sqrt(1.5 * P[i][0] / rho[i][0]);
        all += volume[i];
    }
    settings.file.fields[FIELD_PRESSURE] = true;
    judged_is(&settings, &result, "pressure", 0.03, signal_of(P));
    settings.file.fields[FIELD_VELOCITY] = true;
    judged_is(&settings, &result, "velocity", 0.02, signal_of(v));
    settings.file.fields[FIELD_DENSITY] = true;
    judged_is(&settings, &result, "density", 0.01, signal_of(rho));
    /* the signal of a uniform field is its value, of a uniform velocity the mean sound speed */
    memset(settings.file.fields, 0, sizeof settings.file.fields);
    settings.file.fields[FIELD_INTERNAL_ENERGY] = true;
    judged_is(&settings, &result, "internal_energy", 0.04, 2);
    settings.file.fields[FIELD_VELOCITY] = still = true;
    judged_is(&settings, &result, "velocity", 0.02, sound / all);
    still = false;
    make(&settings, &result, "gresho");
    judged_is(&settings, &result, "azimuthal", 0.77, signal_of(v));
    /* in 1D cases are judged by density, and the signal is left to bench */
    struct judged judged;
    result.problem.domain.dim = 1;
    judged_of(&settings.file, &result, &judged);
    assert_string_equal(judged.name, "density");
    assert_true(judged.error == 0.01 && isnan(judged.signal));
}

/* A velocity that is only round-off relative to the sound speed is uniform. */
TEST(faint_signals)
{
    static const double places[2][2] = {{0.25, 0.75}, {0.5, 0.5}}, halves[2] = {0.5, 0.5};
    struct run_settings settings;
    struct run_result result;
    make(&settings, &result, "square");
    memset(settings.file.fields, 0, sizeof settings.file.fields);
    settings.file.gate_count = 0;
    settings.file.fields[FIELD_VELOCITY] = true;
    result.snapshot =
        (struct snapshot){.n = 2, .x = {places[0], places[1]}, .volume = halves, .time = 0.5};
    faint = 2e-12;
    judged_is(&settings, &result, "velocity", 0.02, 2);
    faint = nextafter(2e-12, 1);
    judged_is(&settings, &result, "velocity", 0.02, faint);
    faint = 0;
}

TEST(errors_and_signals_of_functionals)
{
    struct run_settings settings;
    struct run_result result;
    struct judged judged;
    make(&settings, &result, "kelvin_helmholtz_mode");
    result.functionals[0] = (struct run_functional){"mode_noise", 5, (double)NAN};
    result.functionals[1] = (struct run_functional){"growth_rate", 1.5, -2};
    result.functionals[2] = (struct run_functional){"mode_error", 7, 6};
    result.functional_count = 3;
    judged_is(&settings, &result, "growth_rate", 3.5, 2);
    result.functionals[1].exact = 2;
    judged_is(&settings, &result, "growth_rate", 0.5, 2);
    result.functionals[1].exact = 0;
    judged_is(&settings, &result, "growth_rate", 1.5, 1);
    result.functional_count = 1; /* no exact values */
    judged_of(&settings.file, &result, &judged);
    assert_string_equal(judged.name, "");
    assert_true(isnan(judged.error) && isnan(judged.signal));
    result.functionals[0] = (struct run_functional){"growth_rate", 1.5, -2};
    judged_is(&settings, &result, "growth_rate", 3.5, 2);
    /* an error of a field is not that of a functional with the same name */
    make(&settings, &result, "square");
    memset(settings.file.fields, 0, sizeof settings.file.fields);
    for (int f = 0; f < FIELDS; f += FIELDS - 1) {
        settings.file.fields[f] = true;
        settings.file.fields[FIELDS - 1 - f] = false;
        settings.file.gate_count = 0;
        result.functionals[0] = (struct run_functional){field_family.members[f]->name, 9000, 4000};
        result.functional_count = 1;
        struct judged got;
        judged_of(&settings.file, &result, &got);
        assert_string_equal(got.name, field_family.members[f]->name);
        assert_true(got.error == 0.01 * (f + 1) && got.signal < 100);
    }
}
