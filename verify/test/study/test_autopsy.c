/* SPDX-License-Identifier: GPL-3.0-or-later
 * The autopsy names what has been planted: into schemes, into an exact solution, into figures. */
#include "test.h"

#include <math.h>
#include <string.h>

#include "autopsy.h"
#include "draw.h"
#include "near.h"
#include "problem_list.h"

enum { LEVELS = 4, KEYS = 8 };

static void resolve(struct run *run, const char *case_name, size_t n, const char *keys)
{
    struct run_settings asked;
    struct error error;
    char text[256], *words[KEYS], *rest = text;
    int count = 0;
    snprintf(text, sizeof text, "n=%zu %s", n, keys);
    for (char *word; (word = strtok_r(rest, " ", &rest));) {
        assert_true(count < KEYS);
        words[count++] = word;
    }
    if (run_prepare(&asked, case_name, count, words, &error) || run_resolve(run, &asked, &error))
        fail_msg("%s: %s", text, error.message);
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
        if (autopsy_check(&run, &error) || autopsy_measure(&run, &autopsy->levels[l], &error))
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
    if (autopsy->lost != lost || autopsy->cause != cause || !strstr(autopsy->verdict, words))
        fail_msg("'%s' expected, said: %s", words, autopsy->verdict);
}

static const size_t line[LEVELS] = {32, 48, 64, 96}, plane[LEVELS] = {256, 400, 576, 784};

TEST(a_scheme_of_second_order_loses_nothing)
{
    struct autopsy autopsy;
    examine(&autopsy, "sound_wave", line, "", NULL);
    expect(&autopsy, false, AUTOPSY_OPERATOR, "No order is lost: it is 2.0");
    for (size_t l = 0; l < LEVELS; l++) {
        assert_true(autopsy.levels[l].size[AUTOPSY_MEASURE] == 0);
        assert_true(autopsy.levels[l].size[AUTOPSY_REFERENCE] == 0);
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

/* The acceleration is wrong by the lattice sum, whatever n. */
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
    examine(&autopsy, "yee", plane, "t_end=4", NULL);
    expect(&autopsy, true, AUTOPSY_DISORDER, "is lost to disorder");
    for (size_t l = 0; l < LEVELS; l++) {
        const struct autopsy_level *level = &autopsy.levels[l];
        assert_true(level->regular < level->own && level->own < level->jittered);
        assert_true(level->regularity.spread > 0.03);
        assert_true(level->size[AUTOPSY_MEASURE] == 0);
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
        near_relative(autopsy.levels[l].size[AUTOPSY_REFERENCE],
                      0.01 * autopsy.levels[l].acceleration, 1e-3);
}

/* Figures of any levels in which one part is the largest and falls slowly. */
static void make(struct autopsy *autopsy, size_t part, size_t from)
{
    *autopsy = (struct autopsy){.count = LEVELS, .dim = 2};
    for (size_t l = 0; l < LEVELS; l++) {
        struct autopsy_level *level = &autopsy->levels[l];
        const double x = pow(2, -(double)l);
        *level = (struct autopsy_level){.n = 256 << 2 * l, .spacing = x, .error = {x, x, x}};
        for (size_t k = 0; k < AUTOPSY_PARTS; k++) {
            level->size[k] = draw(0.9, 1.1) * pow(x, 2.5);
            level->share[k] = k == 0 && l < from ? 0.5 : 0.01;
        }
        level->size[part] = x;
        if (l >= from) level->share[part] = 0.6;
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
                autopsy.levels[l].size[0] = autopsy.levels[l].spacing;
            if (autopsy_judge(&autopsy, &error)) fail_msg("%s", error.message);
            snprintf(words, sizeof words, "is lost to %s from %d^2 on: it is 60 %%",
                     autopsy_part_family.members[part]->label, 16 << from);
            expect(&autopsy, true, (enum autopsy_part)part, words);
        }
}

/* It cannot cost the order, however large it is. */
TEST(a_part_that_falls_fast_is_not_named)
{
    struct autopsy autopsy;
    struct error error;
    make(&autopsy, AUTOPSY_VISCOSITY, 0);
    for (size_t l = 0; l < LEVELS; l++) autopsy.levels[l].share[AUTOPSY_OPERATOR] = 0.9;
    if (autopsy_judge(&autopsy, &error)) fail_msg("%s", error.message);
    expect(&autopsy, true, AUTOPSY_VISCOSITY, "is lost to viscosity from 16^2 on");
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
