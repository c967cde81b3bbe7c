/* SPDX-License-Identifier: GPL-3.0-or-later
 * The table of keys: every key reads what it writes, refuses what is out of range; `auto` stands
 * for what the documentation says; case files in good and bad shape. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "cases.h"
#include "integrator.h"
#include "near.h"
#include "problem.h"
#include "problem_prepare.h"
#include "settings.h"

static void resolve(struct settings *settings, struct scheme *scheme, int n, ...)
{
    char *arguments[16];
    struct prepared problem;
    struct error error = {0};
    va_list list;
    va_start(list, n);
    for (int i = 0; i < n; i++) arguments[i] = va_arg(list, char *);
    va_end(list);
    settings_init(settings);
    assert_int_equal(settings_apply(settings, n, arguments, &error), STATUS_OK);
    assert_int_equal(problem_prepare(&problem, settings, 1, &error), STATUS_OK);
    assert_int_equal(settings_scheme(settings, 1, scheme, &error), STATUS_OK);
}

static void defaults_are_the_fastest_scheme(void **state)
{
    struct settings settings;
    struct scheme s;
    (void)state;
    resolve(&settings, &s, 0);
    assert_string_equal(s.kernel.member.name, "quadratic_spline");
    assert_string_equal(s.integrator->member.name, "predicted_midpoint");
    near_relative(s.eta, 1.5, 1e-15);
    near_relative(s.cfl, 1.1 / 1.5, 1e-15);
    near_relative(s.alpha, 0.75, 1e-15);
    near_relative(s.beta, 1.5, 1e-15);
    assert_int_equal(s.energy, ENERGY_TOTAL);
    assert_int_equal(s.pair_width, PAIR_WIDTH_MAX);
    assert_int_equal(s.h_method, H_PREDICTED);
    resolve(&settings, &s, 2, "gradient=ia", "viscosity=reconstructed");
    assert_int_equal(s.pair_width, PAIR_WIDTH_HARMONIC);
    resolve(&settings, &s, 1, "formulation=lagrangian");
    assert_int_equal(s.pair_width, PAIR_WIDTH_MEAN);
}

static void textbook_scheme_has_no_surprises(void **state)
{
    struct settings settings;
    struct scheme s;
    (void)state;
    resolve(&settings, &s, 3, "integrator=modified_leapfrog", "kernel=cubic_spline", "eta=4.8");
    near_relative(s.cfl, s.integrator->cfl, 1e-15);
    near_relative(s.alpha, 1, 1e-15);
    near_relative(s.beta, 2, 1e-15);
    assert_int_equal(s.energy, ENERGY_INTERNAL);
    assert_int_equal(s.pair_width, PAIR_WIDTH_MEAN);
    assert_int_equal(s.h_method, H_NEWTON);
    resolve(&settings, &s, 2, "alpha=1.5", "alpha=0.5"); /* the last one counts */
    near_relative(s.beta, 1, 1e-15);
}

static void keys_read_what_they_write(void **state)
{
    struct settings settings, again;
    struct scheme scheme;
    struct error error;
    char text[SETTING_TEXT_MAX];
    (void)state;
    resolve(&settings, &scheme, 3, "eta=2.3849999999999998", "gamma=1.6666666666666667", "n=1e5");
    settings_init(&again);
    for (int i = 0; i < SETTINGS; i++) {
        settings_text(&settings, (enum setting)i, text);
        assert_int_equal(settings_set(&again, (enum setting)i, text, SOURCE_USER, NULL, &error),
                         STATUS_OK);
        assert_int_equal(again.value[i].choice, settings.value[i].choice);
        assert_memory_equal(again.value[i].real, settings.value[i].real,
                            sizeof again.value[i].real);
    }
}

static void keys_refuse_the_rest(void **state)
{
    static const char *const never[] = {"", " ", "nan", "inf", "1e3x", "0x1", "1e300", "-1e300"};
    (void)state;
    for (int i = 0; i < SETTINGS; i++)
        for (size_t j = 0; j < sizeof never / sizeof *never; j++) {
            struct settings settings;
            struct error error = {0};
            if (setting_keys[i].type == SETTING_PATH) continue; /* a file may have any name */
            settings_init(&settings);
            const struct setting_value before = settings.value[i];
            assert_int_equal(
                settings_set(&settings, (enum setting)i, never[j], SOURCE_USER, "f:7", &error),
                STATUS_BAD_INPUT);
            assert_memory_equal(&before, &settings.value[i], sizeof before);
            assert_ptr_equal(strstr(error.message, "f:7"), error.message);
            assert_non_null(strstr(error.message, setting_keys[i].name));
            assert_non_null(strstr(error.message, "allowed"));
        }
}

static enum status set(enum setting key, double value, int count, struct settings *settings)
{
    char text[200] = "", number[40];
    struct error error;
    snprintf(number, sizeof number, "%s%.17g", setting_keys[key].type == SETTING_REALS ? " " : "",
             value);
    for (int i = 0; i < count; i++) strcat(text, number);
    settings_init(settings);
    return settings_set(settings, key, text, SOURCE_USER, NULL, &error);
}

/* A key takes both ends of what it says is allowed, unless it says above, and nothing beyond. */
static void keys_take_their_ends(void **state)
{
    (void)state;
    for (int i = 0; i < SETTINGS; i++) {
        const struct setting_key *key = &setting_keys[i];
        struct settings settings;
        const enum setting_type type = key->type;
        if (type == SETTING_CHOICE || type == SETTING_CHOICES || type == SETTING_PATH) continue;
        const bool whole = type == SETTING_INTEGER || type == SETTING_COUNT;
        const int n = type == SETTING_REALS ? key->count : 1;
        const double step = whole ? 1 : 0;
        const double below = whole ? key->lo - step : nextafter(key->lo, -HUGE_VAL),
                     beyond = whole ? key->hi + step : nextafter(key->hi, HUGE_VAL),
                     inside = whole ? key->lo + step : nextafter(key->lo, HUGE_VAL);
        const struct {
            double value;
            bool allowed;
        } tries[] = {{key->lo, !key->above},
                     {inside, true},
                     {key->hi, true},
                     {below, false},
                     {beyond, false}};
        for (size_t k = 0; k < 5; k++) {
            const bool taken = set((enum setting)i, tries[k].value, n, &settings) == STATUS_OK;
            if (taken != tries[k].allowed)
                fail_msg("%s = %.17g is %s", key->name, tries[k].value,
                         taken ? "taken" : "refused");
            if (taken)
                for (int r = 0; r < n; r++)
                    assert_true(settings.value[i].real[r] == tries[k].value);
        }
    }
}

static void built_in_cases_are_sound(void **state)
{
    struct case_file file;
    struct error error;
    size_t n = 0;
    (void)state;
    for (const struct case_builtin *b = case_builtins; b->name; b++, n++) {
        assert_int_equal(case_load(&file, b->name, &error), STATUS_OK);
        assert_string_equal(file.name, b->name);
        if (file.dimension == 1) assert_true(file.ladder_count >= 4 && file.gate_count >= 1);
    }
    assert_true(n >= 6);
}

/* Damaged case files: never a crash, always OK or a message. */
static void damaged_cases_are_survived(void **state)
{
    static const char noise[] = "\n[]=;:# \t\r0aZ.,-\"";
    unsigned random = 2385;
    size_t builtins = 1;
    (void)state;
    while (case_builtins[builtins].name) builtins++;
    for (int round = 0; round < 4000; round++) {
        const struct case_builtin *builtin = &case_builtins[(size_t)round % builtins];
        const size_t length = strlen(builtin->text);
        char *text = strdup(builtin->text);
        assert_non_null(text);
        for (int k = 0; k < 1 + round % 5; k++) {
            random = random * 1664525u + 1013904223u;
            const size_t at = (random >> 8) % length;
            text[at] =
                random >> 30 ? noise[(random >> 4) % (sizeof noise - 1)] : (char)(random >> 5);
        }
        struct case_file file;
        struct error error = {0};
        const enum status status =
            case_parse(&file, "damaged.ini", text, length - (size_t)(round % 7 ? 0 : 40), &error);
        assert_true(status == STATUS_OK || status == STATUS_BAD_INPUT);
        if (status) assert_ptr_equal(strstr(error.message, "damaged.ini"), error.message);
        free(text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_are_the_fastest_scheme),
        cmocka_unit_test(textbook_scheme_has_no_surprises),
        cmocka_unit_test(keys_read_what_they_write),
        cmocka_unit_test(keys_refuse_the_rest),
        cmocka_unit_test(keys_take_their_ends),
        cmocka_unit_test(built_in_cases_are_sound),
        cmocka_unit_test(damaged_cases_are_survived),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
