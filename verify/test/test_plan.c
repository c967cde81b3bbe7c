/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a run says that it will do, before it does: every pass once, running where the scheme needs
 * it, for reasons that are true of it; warnings where they are due. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "integrator.h"
#include "run.h"
#include "value.h"

static struct run resolved(const char *name, size_t n, char *const *words)
{
    struct run_settings settings;
    struct run run = {0};
    struct error error = {0};
    if (run_prepare(&settings, name, (int)n, words, &error) || run_resolve(&run, &settings, &error))
        fail_msg("%s", error.message);
    return run;
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
    if (strstr(line->why, "alpha_u > 0")) assert_true(run->scheme.alpha_u > 0);
    if (strstr(line->why, "alpha is constant"))
        assert_true(run->scheme.viscosity != VISCOSITY_TIME_DEPENDENT &&
                    run->scheme.viscosity != VISCOSITY_CULLEN_DEHNEN);
}

/* Does the pass run, by what the scheme is; -1: there is no such pass in so many dimensions. */
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
        {"conductivity", line ? -1 : s->alpha_u > 0},
        {"gravity", line ? -1 : gravity},
        {"sleep", skip && !gravity},
        {"final state", !s->integrator->ends_evaluated},
    };
    for (size_t i = 0; i < sizeof passes / sizeof *passes; i++)
        if (strcmp(passes[i].pass, pass) == 0) return passes[i].runs;
    fail_msg("what is the pass '%s'?", pass);
    return 0;
}

enum { PASSES = 18 };

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
        wanted++;
    }
    assert_int_equal(wanted, run->asked.file.dimension == 1 ? PASSES - 4 : PASSES - 2);
}

/* Each choice of each key, one at a time. */
static void every_choice(const char *name, int dim, const char *size)
{
    static const enum setting keys[] = {
        SETTING_gradient,   SETTING_formulation, SETTING_viscosity, SETTING_volume_element,
        SETTING_integrator, SETTING_balsara,     SETTING_skip,      SETTING_h_method};
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) {
        const struct family *family = setting_keys[keys[k]].family;
        if (dim == 1 && keys[k] == SETTING_balsara) continue; /* has no such key */
        for (size_t i = 0; i < scheme_members(family, dim); i++) {
            char word[96], resolution[16], *words[] = {resolution, word};
            snprintf(resolution, sizeof resolution, "%s", size);
            snprintf(word, sizeof word, "%s=%s", setting_keys[keys[k]].name,
                     family->members[i]->name);
            const struct run run = resolved(name, 2, words);
            plan_is_right(&run);
        }
    }
}

static void plans(void **state)
{
    (void)state;
    every_choice("sod", 1, "n=40");
    every_choice("gresho", 2, "n=8^2");
    every_choice("rest_3d", 3, "n=4^3");
    char alpha_u[] = "alpha_u=0.5", viscosity[] = "viscosity=constant", n[] = "n=8^2";
    const struct run heated = resolved("gresho", 3, (char *[]){alpha_u, viscosity, n}),
                     heavy = resolved("rayleigh_taylor_mode", 1, (char *[]){n});
    plan_is_right(&heated);
    plan_is_right(&heavy);
}

static void warns(const char *name, const char *words, const char *what)
{
    char text[128], *list[4], *rest = text;
    size_t n = 0;
    struct run_result plan;
    struct error error = {0};
    strcpy(text, words);
    for (char *word; (word = strtok_r(rest, " ", &rest));) list[n++] = word;
    const struct run run = resolved(name, n, list);
    if (run_explain(&run, &plan, &error)) fail_msg("%s", error.message);
    if (*what ? !strstr(plan.warnings, what) : plan.warnings[0] != '\0')
        fail_msg("%s: '%s', not '%s'", words, plan.warnings, what);
    json_t *document = json_object();
    run_add_plan(&run.asked, &plan, document);
    assert_string_equal(value_text(document, "warnings"), plan.warnings);
    json_decref(document);
}

/* Off the widths whose sums are exact by more than 3 %; beyond what is stable; what loses digits.
 */
static void warnings(void **state)
{
    (void)state;
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
    warns("gresho", "n=8^2 kernel=cubic_spline eta=5 gradient=ia", "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plans),
        cmocka_unit_test(warnings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
