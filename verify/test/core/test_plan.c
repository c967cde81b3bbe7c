/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the plan of a run: it lists each pass once, runs those that the scheme needs, gives reasons
 * that are true of the scheme, and warns where it should. */
#include "test.h"

#include "integrator.h"
#include "keyed.h"
#include "plan.h"
#include "value.h"

/* Words that the reason of each pass must contain, if it runs and if it is skipped. */
static void speaks_of_its_pass(const struct run *run, const struct plan_line *line)
{
    const struct scheme *s = &run->scheme;
    const bool jump = s->viscosity == VISCOSITY_CULLEN_DEHNEN,
               skip = settings_choice(&run->settings, SETTING_skip) == SKIP_AUTO;
    const struct {
        const char *pass, *runs, *skipped;
    } reasons[] = {
        {"order", "sorted anew only if particles cross", ""},
        {"ghost copies", "periodic images", ""},
        {"neighbour lists", "a list for each particle", ""},
        {"mirror images", "boundary=reflecting", "no reflecting wall"},
        {"smoothing length by Newton", "h_tolerance at every evaluation", "h_method=predicted"},
        {"energy sum", "volume_element=energy", "pressure from density"},
        {"grad-h factors", "formulation=lagrangian", "has none"},
        {"moment matrix", "by the inverse of", "gradient=standard needs none"},
        {"velocity gradient",
         s->balsara == BALSARA_ON ? "for the Balsara factor"
         : jump                   ? "for the switch"
                                  : "for the midpoint velocities",
         "no viscosity needs it"},
        {"artificial viscosity", "inside the pair loop", "viscosity=none"},
        {"evolution of alpha", jump ? "gradient of the acceleration" : "with div v",
         "alpha is constant"},
        {"signal speed", "after the last force", "comes with the pair forces"},
        {"local steps", "by powers of two", "steps=global"},
        {"conductivity", "inside the pair loop", "alpha_u=0, shock_conductivity=0"},
        {"gravity", "added to the forces", "gravity=0"},
        {"particle shifting", "inside the pair loop", "shifting=none"},
        {"sleep", "no sums where no signal has been",
         !skip                     ? "every particle at every step"
         : s->steps == STEPS_LOCAL ? "steps=local"
                                   : "gravity: no particle is at rest"},
        {"final state", "once more at t_end", "the last evaluation was at t_end"},
    };
    for (size_t k = 0; k < sizeof reasons / sizeof *reasons; k++)
        if (strcmp(reasons[k].pass, line->pass) == 0 &&
            !strstr(line->why, line->runs ? reasons[k].runs : reasons[k].skipped))
            fail_msg("%s: %s", line->pass, line->why);
}

/* KEY=WORD and KEY=NUMBER of a reason agree with the settings. */
static void is_true(const struct run *run, const struct plan_line *line)
{
    char why[sizeof line->why];
    strcpy(why, line->why);
    for (char *rest = why, *word; (word = strtok_r(rest, " ,:;", &rest));) {
        char text[SETTING_TEXT_MAX], *value = strchr(word, '=');
        if (!value || value == word) continue;
        *value++ = '\0';
        const int key = setting_find(word);
        if (key < 0) fail_msg("%s: %s is no key", line->pass, word);
        settings_text(&run->settings, (enum setting)key, text);
        if (strcmp(text, value) != 0 && !strstr(text, value))
            fail_msg("%s: %s=%s is said, it is %s", line->pass, word, value, text);
    }
    if (strcmp(line->pass, "density sum") == 0)
        assert_string_equal(line->why, run->scheme.h_method == H_NEWTON
                                           ? "inside the Newton iteration"
                                           : "one a step");
    if (strcmp(line->pass, "pair forces") == 0)
        assert_string_equal(line->why,
                            run->asked.file.dimension == 1
                                ? "half loop, antisymmetric fluxes"
                                : "most pairs once, for both particles, opposite to the last bit");
    if (strstr(line->why, "alpha is constant"))
        assert_true(run->scheme.viscosity != VISCOSITY_TIME_DEPENDENT &&
                    run->scheme.viscosity != VISCOSITY_CULLEN_DEHNEN);
}

/* 1 if the pass should run with this scheme, 0 if not, -1 if there is no such pass in this number
 * of dimensions. */
static int expected(const struct run *run, const char *pass)
{
    const struct scheme *s = &run->scheme;
    const bool line = run->asked.file.dimension == 1,
               skip = settings_choice(&run->settings, SETTING_skip) == SKIP_AUTO;
    const bool switched = s->viscosity == VISCOSITY_CULLEN_DEHNEN;
    bool gravity = false, walls = false;
    for (int d = 0; d < run->asked.file.dimension; d++) {
        gravity |= run->problem.gravity[d] != 0;
        walls |= run->problem.boundary[d] == BOUNDARY_REFLECTING;
    }
    const struct {
        const char *pass;
        int runs;
    } passes[] = {
        {"order", line ? 1 : -1},
        {"ghost copies", line ? 1 : -1},
        {"neighbour lists", line ? -1 : 1},
        {"mirror images", line ? -1 : walls},
        {"smoothing length by Newton", s->h_method == H_NEWTON},
        {"density sum", 1},
        {"energy sum", s->volume_element == VOLUME_ENERGY},
        {"grad-h factors", s->formulation == FORMULATION_LAGRANGIAN},
        {"moment matrix", s->gradient != GRADIENT_STANDARD},
        {"velocity gradient", s->viscosity == VISCOSITY_RECONSTRUCTED || switched ||
                                  s->viscosity == VISCOSITY_PROJECTED || s->balsara == BALSARA_ON},
        {"pair forces", 1},
        {"artificial viscosity", s->viscosity != VISCOSITY_NONE},
        {"evolution of alpha", switched || s->viscosity == VISCOSITY_TIME_DEPENDENT},
        {"signal speed", s->integrator->signal_pass},
        {"local steps", line ? -1 : s->steps == STEPS_LOCAL},
        {"conductivity", line ? -1 : s->alpha_u > 0 || s->shock_conductivity > 0},
        {"gravity", line ? -1 : gravity},
        {"particle shifting", line ? -1 : s->shifting != SHIFTING_NONE},
        {"sleep", skip && !gravity && s->steps == STEPS_GLOBAL},
        {"final state", !s->integrator->ends_evaluated},
    };
    for (size_t i = 0; i < sizeof passes / sizeof *passes; i++)
        if (strcmp(passes[i].pass, pass) == 0) return passes[i].runs;
    fail_msg("what is the pass '%s'?", pass);
    return 0;
}

enum { PASSES = 20 };

static void plan_is_right(const struct run *run)
{
    struct run_result plan;
    struct error error = {0};
    int wanted = 0;
    if (run_explain(run, &plan, &error)) fail_msg("%s", error.message);
    for (size_t i = 0; i < plan.plan_count; i++) {
        const struct plan_line *line = &plan.plan[i];
        if (line->runs != (bool)expected(run, line->pass) || expected(run, line->pass) < 0)
            fail_msg("%s: %s", line->pass, line->runs ? "runs" : "does not run");
        for (size_t k = 0; k < i; k++) assert_string_not_equal(line->pass, plan.plan[k].pass);
        assert_string_not_equal(line->why, "");
        is_true(run, line);
        speaks_of_its_pass(run, line);
        wanted++;
    }
    assert_int_equal(wanted, run->asked.file.dimension == 1 ? PASSES - 6 : PASSES - 2);
}

/* Tries each choice of each key, one at a time. */
static void every_choice(const char *name, int dim, const char *size)
{
    static const enum setting keys[] = {
        SETTING_gradient,   SETTING_formulation, SETTING_viscosity, SETTING_volume_element,
        SETTING_integrator, SETTING_balsara,     SETTING_skip,      SETTING_h_method};
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) {
        const struct family *family = setting_keys[keys[k]].family;
        if (dim == 1 && keys[k] == SETTING_balsara) continue; /* 1D has no such key */
        for (size_t i = 0; i < scheme_members(family, dim); i++) {
            char words[128];
            snprintf(words, sizeof words, "%s %s=%s", size, setting_keys[keys[k]].name,
                     family->members[i]->name);
            const struct run run = keyed_run(name, words);
            plan_is_right(&run);
        }
    }
}

TEST(plan_of_every_choice)
{
    every_choice("sod", 1, "n=40");
    every_choice("gresho", 2, "n=10^2");
    every_choice("rest_3d", 3, "n=10^3");
    const struct run heated = keyed_run("gresho", "alpha_u=0.5 viscosity=constant n=10^2"),
                     heavy = keyed_run("rayleigh_taylor_mode", "n=16^2");
    plan_is_right(&heated);
    plan_is_right(&heavy);
}

static void warns(const char *name, const char *words, const char *what)
{
    const struct run run = keyed_run(name, words);
    struct run_result plan;
    struct error error = {0};
    if (run_explain(&run, &plan, &error)) fail_msg("%s", error.message);
    if (*what ? !strstr(plan.warnings, what) : plan.warnings[0] != '\0')
        fail_msg("%s: '%s', not '%s'", words, plan.warnings, what);
    json_t *document = json_object();
    run_add_plan(&run.asked, &plan, document);
    assert_string_equal(value_text(document, "warnings"), plan.warnings);
    json_decref(document);
}

/* Warnings: widths more than 3 % off those with exact sums, unstable widths, and boxes in which
 * positions lose digits. */
TEST(warnings)
{
    warns("sod", "n=40", "");
    warns("sod", "n=40 kernel=cubic_spline eta=2", "");
    warns("sod", "n=40 kernel=cubic_spline eta=4 gradient=ia", "");
    warns("sod", "n=40 kernel=cubic_spline eta=2.055", "");
    warns("sod", "n=40 kernel=cubic_spline eta=2.07", "off the partition-of-unity");
    warns("sod", "n=40 kernel=cubic_spline eta=1.95", "");
    warns("sod", "n=40 kernel=cubic_spline eta=1.93", "multiples of 2");
    warns("sod", "n=40 kernel=cubic_spline eta=3 gradient=ia", "off the partition-of-unity");
    warns("sod", "n=40 kernel=cubic_spline eta=6 gradient=ia",
          "eta = 6 is beyond 4, where cubic_spline with gradient=ia");
    warns("sod", "n=40 kernel=cubic_spline eta=6", "");
    warns("sod", "n=40 kernel=cubic_spline eta=5 gradient=ia", "floor; eta = 5 is beyond 4");
    warns("sod", "n=40 kernel=wendland_c2 eta=2.6", "");
    warns("sod", "n=40 viscosity=none energy=total", "loses digits");
    warns("sod", "n=40 viscosity=none energy=internal", "");
    warns("gresho", "n=8^2 kernel=cubic_spline eta=2.385", "");
    warns("gresho", "n=10^2 kernel=cubic_spline eta=5 gradient=ia", "");
}

/* A setup without a scheme's defaults: 1D, cubic spline, no viscosity, internal energy. */
static struct setup setup_of(double eta, enum gradient gradient)
{
    struct setup setup = {.dim = 1, .threads = 1};
    setup.scheme.eta = eta;
    setup.scheme.gradient = gradient;
    setup.scheme.viscosity = VISCOSITY_CONSTANT;
    setup.scheme.integrator = (const struct integrator *)integrator_family.members[0];
    assert_int_equal(kernel_select(&setup.scheme.kernel, "cubic_spline", 5, NULL), STATUS_OK);
    return setup;
}

static size_t explained(const struct setup *setup, char *warnings, size_t size)
{
    struct plan_line lines[PASSES];
    return plan_explain(setup, lines, PASSES, warnings, size);
}

/* A text that is too long is cut at its capacity; the number of lines is that of the whole text. */
TEST(long_texts_are_cut)
{
    const struct setup setup = setup_of(5, GRADIENT_IA);
    struct plan_line all[PASSES], some[PASSES];
    const size_t count = plan_explain(&setup, all, PASSES, NULL, 0);
    assert_int_equal(count, PASSES - 6);
    for (size_t most = 0; most <= count; most++) {
        memset(some, 'x', sizeof some);
        assert_int_equal(plan_explain(&setup, some, most, NULL, 9), count);
        for (size_t k = 0; k < most; k++) {
            assert_string_equal(some[k].pass, all[k].pass);
            assert_string_equal(some[k].why, all[k].why);
        }
        for (size_t k = 0; k < sizeof *some; k++)
            if (most < count) assert_int_equal(((char *)&some[most])[k], 'x');
    }
    char text[512], less[512];
    explained(&setup, text, sizeof text);
    const size_t length = strlen(text), second = (size_t)(strstr(text, "; eta") - text);
    assert_string_equal(text + second,
                        "; eta = 5 is beyond 4, where cubic_spline with gradient=ia "
                        "turns linearly unstable: noise grows unless viscosity hides it");
    assert_null(strstr(text + second + 2, "; "));
    for (size_t size = 0; size <= length + 1; size++) {
        memset(less, 'x', sizeof less);
        explained(&setup, less, size);
        for (size_t k = size; k < sizeof less; k++) assert_int_equal(less[k], 'x');
        if (size == 0) continue;
        const size_t fits = size <= 2 ? 0 : size <= second + 2 ? second : length;
        assert_int_equal(strlen(less), size - 1 < fits ? size - 1 : fits);
        assert_int_equal(strncmp(less, text, strlen(less)), 0);
    }
    assert_string_equal(less, text);
}

/* Widths 3 % off, exactly at the limit, below the least one, half way between two exact ones. */
TEST(limits_of_warnings)
{
    static const struct {
        double eta;
        enum gradient gradient;
        bool off, beyond;
    } cases[] = {
        {2, GRADIENT_IA, false, false},
        {2 / 0.97000001, GRADIENT_IA, false, false},
        {2 / 0.96999999, GRADIENT_IA, true, false},
        {2 / 1.02999999, GRADIENT_IA, false, false},
        {2 / 1.03000001, GRADIENT_IA, true, false},
        {1.2, GRADIENT_IA, true, false},
        {4, GRADIENT_IA, false, false},
        {4.000001, GRADIENT_IA, false, true},
        {4.999, GRADIENT_STANDARD, true, false},
        {5.001, GRADIENT_STANDARD, true, false},
        {4 / 0.96999999, GRADIENT_STANDARD, true, false},
        {6, GRADIENT_STANDARD, false, false},
        {6, GRADIENT_IA, false, true},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct setup setup = setup_of(cases[k].eta, cases[k].gradient);
        char text[512] = "old";
        explained(&setup, text, sizeof text);
        if ((strstr(text, "off the partition") != NULL) != cases[k].off ||
            (strstr(text, "is beyond 4") != NULL) != cases[k].beyond)
            fail_msg("eta = %g: '%s'", cases[k].eta, text);
        setup.dim = 2;
        explained(&setup, text, sizeof text);
        assert_string_equal(text, "");
    }
}

/* The passes that each choice needs; loops are specialised unless unspecialised ones are
 * requested. */
TEST(passes_that_choices_need)
{
    for (int choice = 0; choice < GRADIENTS * FORMULATIONS * PAIR_WIDTHS; choice++)
        for (int generic = 0; generic < 2; generic++) {
            struct setup setup = setup_of(2, (enum gradient)(choice % GRADIENTS));
            struct scheme *s = &setup.scheme;
            s->formulation = (enum formulation)(choice / GRADIENTS % FORMULATIONS);
            s->pair_width = (enum pair_width)(choice / GRADIENTS / FORMULATIONS);
            setup.generic = generic;
            const struct plan plan = plan_of_setup(&setup);
            const bool standard = s->gradient == GRADIENT_STANDARD,
                       lagrangian = s->formulation == FORMULATION_LAGRANGIAN;
            assert_int_equal(plan.own_gradient,
                             standard && (lagrangian || s->pair_width == PAIR_WIDTH_MEAN));
            assert_int_equal(plan.matrix, !standard);
            assert_int_equal(plan.grad_h, lagrangian);
            assert_int_equal(plan.specialised, !generic);
            assert_true(plan.dim == 1 && plan.sums == sums_find(1));
        }
}

/* Gravity along any axis counts, and no particle may then be inactive. */
TEST(gravity_excludes_sleep)
{
    for (int axis = 0; axis < 4; axis++)
        for (int dim = 2; dim <= 3; dim++)
            for (int skip = 0; skip < 2; skip++) {
                struct setup setup = setup_of(2, GRADIENT_IA);
                setup.dim = dim, setup.skip = skip;
                if (axis < 3) setup.gravity[axis] = -0.1;
                const struct plan plan = plan_of_setup(&setup);
                assert_int_equal(plan.gravity, axis < dim);
                assert_int_equal(plan.sleep, skip && axis >= dim);
                for (int wall = 0; wall < 4; wall++) {
                    struct plan_line lines[PASSES];
                    if (wall < 3) setup.boundary[wall] = BOUNDARY_REFLECTING;
                    plan_explain(&setup, lines, PASSES, NULL, 0);
                    for (size_t k = 0; k < PASSES - 2; k++)
                        if (strcmp(lines[k].pass, "mirror images") == 0)
                            assert_int_equal(lines[k].runs, wall < dim);
                    if (wall < 3) setup.boundary[wall] = BOUNDARY_PERIODIC;
                }
            }
}
