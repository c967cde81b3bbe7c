/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the variations of `--vary`: every combination once, the last key fastest, in settings,
 * labels and documents; ladders; and what is refused. */
#include "test.h"

#include "keyed.h"
#include "sweep.h"
#include "value.h"

/* Compares the words of these keys in combination i. */
static void says(const struct sweep *sweep, size_t i, size_t n, const char *const *keys,
                 const char *const *words)
{
    struct run_settings settings = keyed_case("sod", "");
    struct error error = {0};
    char label[SWEEP_LABEL], want[SWEEP_LABEL] = "", text[SETTING_TEXT_MAX];
    json_t *json = sweep_json(sweep, i);
    sweep_label(sweep, i, label);
    assert_int_equal(sweep_apply(sweep, i, &settings, &error), STATUS_OK);
    assert_int_equal(json_object_size(json), n);
    for (size_t k = 0; k < n; k++) {
        const size_t used = strlen(want);
        snprintf(want + used, sizeof want - used, "%s%s=%s", k ? " " : "", keys[k], words[k]);
        assert_string_equal(value_text(json, keys[k]), words[k]);
        settings_text(&settings.settings, (enum setting)setting_find(keys[k]), text);
        assert_string_equal(text, words[k]);
    }
    assert_string_equal(label, want);
    json_decref(json);
}

TEST(every_combination)
{
    static const char *const keys[] = {"alpha", "gradient", "eta", "skip"};
    static const char *const alphas[] = {"1", "1.5"}, *const etas[] = {"1.5", "2", "2.5"};
    struct sweep sweep;
    struct error error = {0};
    const struct family *gradients = setting_keys[SETTING_gradient].family,
                        *skips = setting_keys[SETTING_skip].family;
    assert_int_equal(sweep_parse(&sweep, "alpha=1,1.5,gradient,eta=1.5,2,2.5,skip", &error),
                     STATUS_OK);
    assert_int_equal(sweep.key_count, 4);
    assert_int_equal(sweep.count, 2 * gradients->n * 3 * skips->n);
    size_t i = 0;
    for (size_t a = 0; a < 2; a++)
        for (size_t g = 0; g < gradients->n; g++)
            for (size_t e = 0; e < 3; e++)
                for (size_t s = 0; s < skips->n; s++)
                    says(&sweep, i++, 4, keys,
                         (const char *const[]){alphas[a], gradients->members[g]->name, etas[e],
                                               skips->members[s]->name});
}

/* A word of a family that follows another key's value is a key; a number, or a word that is not a
 * key, is a value. */
TEST(words_and_keys)
{
    struct sweep sweep;
    struct error error = {0};
    static const char *const one[] = {"kernel"}, *const two[] = {"kernel", "energy"};
    assert_int_equal(sweep_parse(&sweep, "kernel=cubic_spline,sinc", &error), STATUS_OK);
    assert_int_equal(sweep.count, 2);
    says(&sweep, 1, 1, one, (const char *const[]){"sinc"});
    assert_int_equal(sweep_parse(&sweep, "kernel=sinc,energy", &error), STATUS_OK);
    assert_int_equal(sweep.count, setting_keys[SETTING_energy].family->n);
    says(&sweep, 0, 2, two,
         (const char *const[]){"sinc", setting_keys[SETTING_energy].family->members[0]->name});
    assert_int_equal(sweep_parse(&sweep, NULL, &error), STATUS_OK);
    assert_true(sweep.count == 1 && sweep.key_count == 0);
    says(&sweep, 0, 0, one, one);
}

/* The very first key, an empty value, and a value kept as it was written. */
TEST(any_key)
{
    struct sweep sweep;
    struct error error = {0};
    static const char *const lo[] = {"lo"};
    assert_int_equal(sweep_parse(&sweep, "lo=-1,-2", &error), STATUS_OK);
    says(&sweep, 1, 1, lo, (const char *const[]){"-2"});
    assert_int_equal(sweep_parse(&sweep, "file=", &error), STATUS_OK);
    assert_true(sweep.count == 1 && sweep.keys[0].count == 1 && !sweep.keys[0].values[0][0]);
    char label[SWEEP_LABEL];
    assert_int_equal(sweep_parse(&sweep, "eta=2.0,2", &error), STATUS_OK);
    sweep_label(&sweep, 0, label);
    assert_string_equal(label, "eta=2.0");
}

static void refused(const char *text, const char *why)
{
    struct sweep sweep;
    struct error error = {0};
    assert_int_equal(sweep_parse(&sweep, text, &error), STATUS_BAD_INPUT);
    if (!strstr(error.message, why)) fail_msg("%s: '%s' lacks '%s'", text, error.message, why);
}

TEST(impossible_variations_are_refused)
{
    char text[600] = "alpha=1", longest[2 * SETTING_TEXT_MAX];
    refused("kernle", "did you mean 'kernel'?");
    refused("lo_", "did you mean 'lo'?");
    refused("window_radiu", "did you mean 'window_radius'?");
    refused("n=100,200", "--n");
    refused("eta=2,alpha=1,eta=3", "key eta is given twice");
    refused("eta=2,3,2", "eta=2 is given twice");
    refused("eta=2,alpha=1,alpha=3", "key alpha is given twice");
    refused("eta=2,3,3", "eta=3 is given twice");
    refused("eta=2,alphq=1", "did you mean 'alpha'?");
    refused("kernel=sinc,lo", "--vary lo: a number's values are needed: --vary lo=VALUE,VALUE");
    refused("eta=2,,3", "allowed: KEY");
    refused("", "allowed: KEY");
    refused("eta=2,", "allowed: KEY");
    refused("eta", "--vary eta: a number's values are needed");
    refused("kernel,eta", "--vary eta: a number's values are needed");
    refused("eta=wide", "wide");
    refused("kernel=sinc,eta=-1", "-1");
    memset(longest, '1', sizeof longest - 1);
    longest[sizeof longest - 1] = '\0';
    refused(longest, "allowed: KEY");
    longest[SETTING_TEXT_MAX] = '\0'; /* one too long */
    refused(longest, "allowed: KEY");
    longest[SETTING_TEXT_MAX - 1] = '\0';
    refused(longest, "no key");
    for (int i = 2; i <= SWEEP_VALUES_MAX; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), ",%d", i);
    struct sweep sweep;
    struct error error = {0};
    assert_int_equal(sweep_parse(&sweep, text, &error), STATUS_OK);
    assert_int_equal(sweep.count, SWEEP_VALUES_MAX);
    strcat(text, ",33");
    refused(text, "--vary alpha: at most 32 values");
    strcpy(text, "alpha=1,beta=1,eta=2,cfl=1,gamma=1.5,t_end=1,skip,energy");
    assert_int_equal(sweep_parse(&sweep, text, &error), STATUS_OK);
    assert_int_equal(sweep.key_count, SWEEP_KEYS_MAX);
    strcat(text, ",kernel");
    refused(text, "at most 8 keys");
}

/* If the settings refuse a combination, the message names the value. */
TEST(refused_combinations_name_the_value)
{
    struct run_settings settings = keyed_case("sod", "");
    struct sweep sweep;
    struct error error = {0};
    assert_int_equal(sweep_parse(&sweep, "alpha=1,eta=2,3", &error), STATUS_OK);
    strcpy(sweep.keys[1].values[1], "wide");
    assert_int_equal(sweep_apply(&sweep, 0, &settings, &error), STATUS_OK);
    assert_int_equal(sweep_apply(&sweep, 1, &settings, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "wide"));
}

/* A label that is too long is truncated. */
TEST(long_labels)
{
    struct sweep sweep = {.key_count = 3, .count = 1};
    char label[SWEEP_LABEL + 1];
    for (size_t k = 0; k < 3; k++) {
        sweep.keys[k].key = (enum setting)(SETTING_alpha + k);
        sweep.keys[k].count = 1;
        memset(sweep.keys[k].values[0], '7', 120);
    }
    label[SWEEP_LABEL] = '!';
    sweep_label(&sweep, 0, label);
    assert_int_equal(strlen(label), SWEEP_LABEL - 1);
    assert_int_equal(label[SWEEP_LABEL], '!');
}

static void ladder_is(const char *text, size_t n, const size_t *want)
{
    size_t ladder[CASE_LADDER_MAX], count;
    struct error error = {0};
    if (sweep_ladder(text, 1, 0, ladder, &count, &error)) fail_msg("%s", error.message);
    assert_int_equal(count, n);
    for (size_t i = 0; i < n; i++) assert_int_equal(ladder[i], want[i]);
}

static void no_ladder_in(int dim, const char *text, size_t least, const char *why)
{
    size_t ladder[CASE_LADDER_MAX], count;
    struct error error = {0};
    assert_int_equal(sweep_ladder(text, least, dim, ladder, &count, &error), STATUS_BAD_INPUT);
    if (!strstr(error.message, why)) fail_msg("%s: '%s' lacks '%s'", text, error.message, why);
}

static void no_ladder(const char *text, size_t least, const char *why)
{
    no_ladder_in(0, text, least, why);
}

TEST(ladders)
{
    char text[400] = "4", most[408];
    ladder_is("100,50,200,50,100,100", 3, (const size_t[]){50, 100, 200});
    ladder_is("8^2,65,64,1e2", 3, (const size_t[]){64, 65, 100});
    ladder_is("4", 1, (const size_t[]){4});
    no_ladder_in(2, "8^2,8^3", 1, "8^3: the case has 2 dimensions; allowed: 8^2");
    no_ladder_in(3, "8^2", 1, "8^2: the case has 3 dimensions; allowed: 8^3");
    ladder_is("10000000,4", 2, (const size_t[]){4, 10000000});
    ladder_is("300,299,298,297,4,5,6", 7, (const size_t[]){4, 5, 6, 297, 298, 299, 300});
    no_ladder("3", 1, "'3'");
    no_ladder("100,3", 1, "'3'");
    no_ladder("10000001", 1, "10000001");
    no_ladder("100,,200", 1, "''");
    no_ladder("100,200,", 1, "''");
    no_ladder("100,1.5", 1, "'1.5'");
    no_ladder("1000000000000000000000000000000", 1, "from 4 to 10000000");
    no_ladder("00000000000000000000000000000100", 1, "allowed"); /* 32 digits do not fit */
    ladder_is("0000000000000000000000000000100", 1, (const size_t[]){100});
    no_ladder("100,100,200,200", 3, "2 distinct resolutions; allowed: at least 3");
    for (int i = 1; i < CASE_LADDER_MAX; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), ",%d", 4 + i);
    size_t want[CASE_LADDER_MAX];
    for (size_t i = 0; i < CASE_LADDER_MAX; i++) want[i] = 4 + i;
    ladder_is(text, CASE_LADDER_MAX, want);
    snprintf(most, sizeof most, "%s,1000", text);
    no_ladder(most, 1, "at most 64 resolutions");
}
