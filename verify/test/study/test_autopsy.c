/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests that an autopsy names planted errors: in schemes, in an exact solution, in figures. */
#include "test.h"

#include "autopsy_state.h"
#include "draw.h"
#include "keyed.h"

enum { LEVELS = 4 };

static void resolve(struct run *run, const char *case_name, size_t n, const char *keys)
{
    char words[200];
    snprintf(words, sizeof words, "n=%zu %s", n, keys);
    *run = keyed_run(case_name, words);
}

/* problem NULL: the case's own. */
static void examine(struct autopsy *autopsy, const char *case_name, const size_t ladder[LEVELS],
                    const char *keys, const struct problem *problem)
{
    struct error error = {0};
    *autopsy = (struct autopsy){.count = LEVELS};
    for (size_t l = 0; l < LEVELS; l++) {
        struct run run;
        resolve(&run, case_name, ladder[l], keys);
        autopsy->dim = run.problem.domain.dim;
        if (problem) run.problem.problem = problem;
        if (autopsy_check(&run, &error) || autopsy_measure(&run, &autopsy->levels[l], NULL, &error))
            fail_msg("%s", error.message);
        double sum = 0;
        for (size_t k = 0; k < AUTOPSY_PARTS; k++) {
            assert_true(autopsy->levels[l].share[k] >= 0);
            sum += autopsy->levels[l].share[k];
        }
        near_absolute(sum, 1, 1e-12);
    }
    if (autopsy_judge(autopsy, &error)) fail_msg("%s", error.message);
}

static void expect(const struct autopsy *autopsy, bool lost, enum autopsy_part cause,
                   const char *words)
{
    if (autopsy->lost != lost || autopsy->cause != cause || !strstr(autopsy->sentence, words))
        fail_msg("'%s' expected, said: %s", words, autopsy->sentence);
}

static const size_t line[LEVELS] = {32, 48, 64, 96}, plane[LEVELS] = {256, 400, 576, 784};

TEST(a_scheme_of_second_order_loses_nothing)
{
    struct autopsy autopsy;
    examine(&autopsy, "sound_wave", line, "", NULL);
    expect(&autopsy, false, AUTOPSY_OPERATOR, "No order is lost: it is 2.0");
    for (size_t l = 0; l < LEVELS; l++) {
        assert_true(autopsy.levels[l].size[AUTOPSY_MEASURE].rms == 0);
        assert_true(autopsy.levels[l].size[AUTOPSY_REFERENCE].rms == 0);
    }
}

TEST(a_time_step_of_first_order_is_named)
{
    struct autopsy autopsy;
    examine(&autopsy, "sound_wave", line,
            "integrator=symplectic_euler energy=internal amplitude=1e-3", NULL);
    expect(&autopsy, true, AUTOPSY_TIME_STEP, "is lost to the time step from 32 on");
    near_inside(autopsy.orders[AUTOPSY_TIME_STEP].order, 0.9, 1.1);
    for (size_t l = 0; l < LEVELS; l++) {
        const double *error = autopsy.levels[l].error;
        near_inside(error[1] / error[0], 0.45, 0.55);
        near_inside(error[2] / error[0], 0.2, 0.3);
    }
}

TEST(a_viscosity_that_does_not_vanish_is_named)
{
    struct autopsy autopsy;
    examine(&autopsy, "sound_wave", line, "viscosity=constant alpha=1 amplitude=1e-3", NULL);
    expect(&autopsy, true, AUTOPSY_VISCOSITY, "is lost to viscosity from ");
    near_inside(autopsy.orders[AUTOPSY_VISCOSITY].order, 0.9, 1.1);
}

/* Viscosity is named although particles have lost their lattice: most of the error is smooth, as
 * that of viscosity is, and the displaced mass is not counted as disorder. */
TEST(a_viscosity_that_does_not_vanish_is_named_among_disorder)
{
    static const size_t finer[LEVELS] = {400, 576, 784, 1024};
    struct autopsy autopsy;
    examine(&autopsy, "yee", finer, "gradient=standard viscosity=constant", NULL);
    expect(&autopsy, true, AUTOPSY_VISCOSITY, "is lost to viscosity from ");
    for (size_t l = 0; l < LEVELS; l++) {
        const struct autopsy_level *level = &autopsy.levels[l];
        assert_true(level->regularity.spread > 0.03);
        assert_true(level->share[AUTOPSY_DISORDER] < 0.5 * level->share[AUTOPSY_VISCOSITY]);
        assert_true(level->size[AUTOPSY_DISORDER].rms < 0.6 * level->size[AUTOPSY_VISCOSITY].rms);
    }
}

/* The acceleration has the error of the lattice sum at any n. */
TEST(a_kernel_with_too_few_neighbours_is_named)
{
    struct autopsy autopsy;
    examine(&autopsy, "sound_wave", line,
            "gradient=standard formulation=vanilla_ice kernel=cubic_spline eta=1.7", NULL);
    expect(&autopsy, true, AUTOPSY_OPERATOR, "is lost to the kernel's lattice sums");
    assert_true(autopsy.floor);
    near_inside(autopsy.orders[AUTOPSY_OPERATOR].order, -0.25, 0.05);
}

TEST(disorder_is_named)
{
    struct autopsy autopsy;
    examine(&autopsy, "yee", plane, "t_end=4 shifting=none", NULL);
    expect(&autopsy, true, AUTOPSY_DISORDER, "is lost to disorder");
    for (size_t l = 0; l < LEVELS; l++) {
        const struct autopsy_level *level = &autopsy.levels[l];
        assert_true(level->regular < level->own && level->own < level->jittered);
        assert_true(level->regularity.spread > 0.03);
        assert_true(level->size[AUTOPSY_MEASURE].rms == 0);
    }
}

/* A solution whose velocity is a hundredth too large. */
static const struct problem *honest;

static void sample_too_fast(const struct prepared *p, const double x[3], double t,
                            struct problem_state *state)
{
    honest->sample(p, x, t, state);
    if (t > 0) state->v[0] *= 1.01;
}

TEST(a_biased_solution_is_named)
{
    struct autopsy autopsy;
    struct run run;
    resolve(&run, "sound_wave", 32, "");
    honest = run.problem.problem;
    struct problem biased = *honest;
    biased.sample = sample_too_fast;
    examine(&autopsy, "sound_wave", line, "", &biased);
    expect(&autopsy, true, AUTOPSY_REFERENCE, "is lost to the exact solution itself from 32 on");
    for (size_t l = 0; l < LEVELS; l++)
        near_relative(autopsy.levels[l].size[AUTOPSY_REFERENCE].rms,
                      0.01 * autopsy.levels[l].acceleration, 1e-3);
}

/* A solution that is exact except at the positions where a run is measured. */
static const struct prepared *fair;

static void sample_unfairly(const struct prepared *p, const double x[3], double t,
                            struct problem_state *state)
{
    honest->sample(p, x, t, state);
    if (t > 0 && p != fair) state->v[0] *= 1.01;
}

TEST(a_biased_measure_is_named)
{
    struct autopsy autopsy = {.count = LEVELS, .dim = 1};
    struct run run;
    struct error error;
    for (size_t l = 0; l < LEVELS; l++) {
        resolve(&run, "sound_wave", line[l], "");
        honest = run.problem.problem;
        fair = &run.problem;
        struct problem biased = *honest;
        biased.sample = sample_unfairly;
        run.problem.problem = &biased;
        if (autopsy_measure(&run, &autopsy.levels[l], NULL, &error)) fail_msg("%s", error.message);
        near_inside(autopsy.levels[l].size[AUTOPSY_MEASURE].rms, 5e-7, 1e-6);
    }
    if (autopsy_judge(&autopsy, &error)) fail_msg("%s", error.message);
    expect(&autopsy, true, AUTOPSY_MEASURE, "is lost to the measure of the error from ");
}

/* In a wave conductivity changes the pressure, and not the velocity. */
TEST(a_conductivity_that_does_not_vanish_is_named)
{
    struct autopsy autopsy;
    examine(&autopsy, "sound_wave_2d", plane, "viscosity=none alpha_u=10", NULL);
    expect(&autopsy, true, AUTOPSY_CONDUCTION, "is lost to conductivity from ");
    near_inside(autopsy.losses[AUTOPSY_CONDUCTION].order, 1, 1.25);
}

/* Errors of the acceleration in a wave that crosses a lattice fluctuate and cancel: they do not
 * damp it. Without viscosity the damping is missing. */
TEST(what_shakes_a_wave_is_not_what_damps_it)
{
    struct run run;
    struct run_result result;
    struct error error;
    struct autopsy_level level;
    for (int off = 0; off < 2; off++) {
        resolve(&run, "sound_wave_2d", 1024,
                off ? "direction=2,1 viscosity=none" : "direction=2,1");
        if (off ? run_execute(&run, &result, &error) : autopsy_measure(&run, &level, NULL, &error))
            fail_msg("%s", error.message);
    }
    const double missed = 1 - result.errors[FIELD_VELOCITY].l1 / level.error[0];
    assert_true(level.size[AUTOPSY_DISORDER].rms > level.size[AUTOPSY_VISCOSITY].rms);
    assert_true(level.share[AUTOPSY_DISORDER] < 0.1);
    near_inside(level.share[AUTOPSY_VISCOSITY], 0.5 * missed, 1.2 * missed);
    run_free(&result);
}

/* Our own particles, treated as another code's. */
TEST(snapshots_tell_the_same_of_positions)
{
    enum { N = 576 };
    struct run run;
    struct run_result result, judged;
    struct error error;
    struct autopsy_level own, theirs;
    resolve(&run, "gresho", N, "t_end=0.5 shifting=none");
    if (autopsy_measure(&run, &own, NULL, &error) || run_execute(&run, &result, &error))
        fail_msg("%s", error.message);
    struct snapshot snapshot = result.snapshot;
    size_t id[N];
    for (size_t i = 0; i < N; i++) id[i] = i;
    snapshot.id = id;
    if (run_judge(&run, &snapshot, &judged, &error) ||
        autopsy_measure_theirs(&run, &judged, &theirs, &error))
        fail_msg("%s", error.message);
    static const enum autopsy_part seen[] = {AUTOPSY_OPERATOR, AUTOPSY_DENSITY, AUTOPSY_DISORDER};
    for (size_t k = 0; k < 3; k++)
        near_absolute(theirs.size[seen[k]].rms, own.size[seen[k]].rms, 1e-12);
    near_relative(theirs.share[AUTOPSY_OPERATOR] / theirs.share[AUTOPSY_DISORDER],
                  own.share[AUTOPSY_OPERATOR] / own.share[AUTOPSY_DISORDER], 0.3);
    near_absolute(theirs.regularity.spread, own.regularity.spread, 1e-12);
    near_absolute(theirs.regularity.gradient, own.regularity.gradient, 1e-12);
    assert_true(theirs.share[AUTOPSY_TIME_STEP] == 0 && theirs.share[AUTOPSY_VISCOSITY] == 0 &&
                theirs.share[AUTOPSY_NOISE_TERM] == 0 && own.share[AUTOPSY_NOISE_TERM] > 0);
    run_free(&judged);
    run_free(&result);
}

/* Figures in which one part is the largest and falls slowly, from level `from` on. */
static void make(struct autopsy *autopsy, size_t part, size_t from)
{
    *autopsy = (struct autopsy){.count = LEVELS, .dim = 2};
    for (size_t l = 0; l < LEVELS; l++) {
        struct autopsy_level *level = &autopsy->levels[l];
        const double x = pow(2, -(double)l);
        *level =
            (struct autopsy_level){.n = (size_t)256 << 2 * l, .spacing = x, .error = {x, x, x}};
        for (size_t k = 0; k < AUTOPSY_PARTS; k++) {
            level->size[k].rms = draw(0.9, 1.1) * pow(x, 2.5);
            level->share[k] = 0.01 * pow(x, 1.5);
        }
        level->size[part].rms = x;
        level->share[0] = l < from ? 0.7 : 0.3;
        level->share[part] = l < from ? 0.2 : 0.6;
    }
}

TEST(the_largest_part_that_falls_slowly_is_named_whichever_it_is)
{
    for (size_t part = 1; part < AUTOPSY_PARTS; part++)
        for (size_t from = 1; from < LEVELS; from++) {
            struct autopsy autopsy;
            struct error error;
            char words[64];
            make(&autopsy, part, from);
            for (size_t l = 0; l < LEVELS; l++)
                autopsy.levels[l].size[0].rms = autopsy.levels[l].spacing;
            if (autopsy_judge(&autopsy, &error)) fail_msg("%s", error.message);
            snprintf(words, sizeof words, "is lost to %s from %d^2 on: it is 60 %%",
                     autopsy_part_family.members[part]->label, 16 << from);
            expect(&autopsy, true, (enum autopsy_part)part, words);
        }
}

/* It does not limit the order, however large it is. */
TEST(a_part_that_falls_fast_is_not_named)
{
    struct autopsy autopsy;
    struct error error;
    make(&autopsy, AUTOPSY_VISCOSITY, 0);
    for (size_t l = 0; l < LEVELS; l++)
        autopsy.levels[l].share[AUTOPSY_OPERATOR] = 99 * pow(autopsy.levels[l].spacing, 1.5);
    if (autopsy_judge(&autopsy, &error)) fail_msg("%s", error.message);
    expect(&autopsy, true, AUTOPSY_VISCOSITY, "is lost to viscosity from 16^2 on");
}

/* Noise of a known size on a function that is locally linear: both are found. */
static void split_noise(int dim)
{
    enum { SIDE = 64, N = SIDE * SIDE };
    static double x[3][N], weight[N], field[3][N], none[3][N];
    double *const places[3] = {x[0], x[1], x[2]}, *const fields[3] = {field[0], field[1], field[2]},
                  *const nothing[3] = {none[0], none[1], none[2]};
    struct prepared p = {.domain = {.dim = dim, .lo = {-1, 2, 0}, .hi = {1, 4, 1}}};
    struct autopsy_cells cells;
    struct error error;
    const double noise = draw(0.01, 0.1), slope = draw(1, 2);
    double squares = 0, sum = 0;
    for (size_t i = 0; i < N; i++) {
        double smooth = 0;
        weight[i] = draw(0.9, 1.1);
        sum += weight[i];
        for (int d = 0; d < dim; d++) smooth += x[d][i] = draw(p.domain.lo[d], p.domain.hi[d]);
        for (int d = 0; d < dim; d++) {
            none[d][i] = draw(-1, 1);
            field[d][i] =
                none[d][i] + (d + 1) * slope * smooth + sqrt(3. / dim) * noise * draw(-1, 1);
            squares += weight[i] * pow(field[d][i] - none[d][i], 2);
        }
    }
    if (autopsy_cells_make(&cells, &p, N, places, weight, &error)) fail_msg("%s", error.message);
    const struct autopsy_split split = autopsy_split(&cells, fields, nothing);
    const struct autopsy_split whole = autopsy_split(&cells, fields, NULL);
    autopsy_cells_free(&cells);
    near_relative(split.rms, sqrt(squares / sum), 1e-12);
    near_relative(split.noise, noise, 0.05);
    assert_true(whole.noise > 0.5);
}

TEST(noise_is_told_from_smooth_fields)
{
    for (int dim = 1; dim <= 2; dim++)
        for (int k = 0; k < 5; k++) split_noise(dim);
}

/* In any state, each term's work on the flow is the negative of its heating. */
TEST(the_power_of_each_term_closes)
{
    static const char *const keys[] = {"shock_conductivity=0",
                                       "viscosity=reconstructed shock_conductivity=50",
                                       "gradient=standard viscosity=none alpha_u=1"};
    static const bool there[][AUTOPSY_TERMS] = {
        {true, true, true, false}, {true, true, false, true}, {true, false, false, true}};
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) {
        struct run run;
        struct run_result result;
        struct error error;
        struct autopsy_power power[AUTOPSY_TERMS];
        char text[128];
        snprintf(text, sizeof text, "jitter=0.3 t_end=0.05 seed=%d %s", draw_count(1, 1000),
                 keys[k]);
        resolve(&run, "yee", 400, text);
        if (run_execute(&run, &result, &error) ||
            autopsy_power(&run, &result.snapshot, power, &error))
            fail_msg("%s", error.message);
        double largest = 0;
        for (size_t t = 0; t < AUTOPSY_TERMS; t++) largest = fmax(largest, power[t].scale);
        for (size_t t = 0; t < AUTOPSY_TERMS; t++) {
            assert_true((power[t].scale > 0) == there[k][t]);
            near_below(fabs(power[t].work + power[t].heat) / largest, 1e-12);
        }
        /* viscosity heats, and conduction does no work */
        if (there[k][AUTOPSY_VISCOUS]) assert_true(power[AUTOPSY_VISCOUS].heat > 0);
        near_below(fabs(power[AUTOPSY_CONDUCTIVITY].work) / largest, 1e-12);
        run_free(&result);
    }
}

TEST(only_smooth_solutions_that_are_known)
{
    static const char *const cases[] = {"sod", "kelvin_helmholtz", "noh_2d", "sedov_2d"};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct run run;
        struct error error;
        resolve(&run, cases[k], 64, "");
        assert_int_equal(autopsy_check(&run, &error), STATUS_BAD_INPUT);
        assert_non_null(strstr(error.message, "without jumps"));
    }
}
