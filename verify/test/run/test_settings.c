/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the table of keys: each key reads what it writes and refuses values out of range; `auto`
 * becomes the documented value; keys as text and in JSON. */
#include "test.h"

#include "certificate.h"
#include "integrator.h"
#include "plugin_kernel.h"
#include "problem.h"
#include "problem_prepare.h"
#include "run_output.h"
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

TEST(keys_read_what_they_write)
{
    struct settings settings, again;
    struct scheme scheme;
    struct error error;
    char text[SETTING_TEXT_MAX];
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

/* A key accepts both ends of its allowed range, unless the range says "above", and nothing
 * beyond. */
TEST(ends_of_allowed_ranges)
{
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

/* The allowed values of a key in words; a list that does not fit ends in dots. */
TEST(texts_of_allowed_values)
{
    static const struct {
        enum setting key;
        const char *want;
    } rows[] = {
        {SETTING_seed, "an integer from 0 to 4294967295"},
        {SETTING_n, "an integer, or 64^2, from 4 to 10000000"},
        {SETTING_jitter, "a number from 0 to 0.49, or auto"},
        {SETTING_eta, "a number above 0 up to 100, or auto"},
        {SETTING_gamma, "a number above 1 up to 100"},
        {SETTING_left, "3 numbers (rho v P) from -1e+30 to 1e+30"},
        {SETTING_window, "2 numbers (length) from -1e+30 to 1e+30, or auto"},
        {SETTING_lo, "1, 2 or 3 numbers from -1e+30 to 1e+30"},
        {SETTING_direction, "1, 2 or 3 numbers from -16 to 16, or auto"},
        {SETTING_boundary, "1, 2 or 3 of auto periodic open reflecting fixed"},
        {SETTING_skip, "one of auto none"},
        {SETTING_parity, "one of sinuous varicose"},
        {SETTING_h_method, "one of auto newton predicted"},
        {SETTING_file, "the path of a file, of up to 255 characters; nothing: no file"},
    };
    char text[300], cut[64];
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        setting_allowed(&setting_keys[rows[k].key], text, sizeof text);
        assert_string_equal(text, rows[k].want);
    }
    static const struct {
        size_t size;
        const char *want;
    } cuts[] = {{24, "one of sinuous varicose"},
                {23, "one of sinuous var ..."},
                {10, "one o ..."},
                {5, " ..."},
                {4, "one"}}; /* too small for dots */
    for (size_t k = 0; k < sizeof cuts / sizeof *cuts; k++) {
        memset(cut, '!', sizeof cut);
        setting_allowed(&setting_keys[SETTING_parity], cut, cuts[k].size);
        assert_string_equal(cut, cuts[k].want);
        for (size_t i = cuts[k].size; i < sizeof cut; i++) assert_int_equal(cut[i], '!');
    }
}

static void refused(const char *argument, const char *message)
{
    struct settings settings;
    struct error error = {0};
    char word[600], *arguments[] = {word};
    snprintf(word, sizeof word, "%s", argument);
    settings_init(&settings);
    const struct settings before = settings;
    assert_int_equal(settings_apply(&settings, 1, arguments, &error), STATUS_BAD_INPUT);
    if (strncmp(error.message, message, strlen(message)) != 0)
        fail_msg("'%s', not '%s'", error.message, message);
    assert_memory_equal(&before, &settings, sizeof before);
}

TEST(messages)
{
    char word[400], want[400];
    refused("eta=~ }\x7f\x1f\x80", "eta=~ }???: allowed: a number above 0 up to 100, or auto");
    for (int n = 63; n <= 64; n++) { /* long words are cut */
        snprintf(word, sizeof word, "eta=%.*s", n,
                 "zyxwvutsrqponmlkjihgfedcbazyxwvutsrqponmlkjihg"
                 "fedcbazyxwvutsrqponmlkjihgfedcba");
        snprintf(want, sizeof want, "%.67s: allowed: a number above 0 up to 100, or auto", word);
        refused(word, want);
    }
    refused("eta=\xc3\xa9", "eta=??: allowed: a number above 0"); /* an e with an accent */
    refused("eta=2 ", "eta=2 : allowed: a number above 0 up to 100, or auto");
    refused("seed=1.5", "seed=1.5: allowed: an integer from 0");
    refused("n=64.5", "n=64.5: allowed: an integer, or 64^2,");
    for (int i = 0; i < SETTINGS; i++) { /* for choices the message lists all allowed values */
        if (!setting_keys[i].family) continue;
        setting_allowed(&setting_keys[i], word, sizeof word);
        snprintf(want, sizeof want, "no %s './x.Q'; allowed:%s", setting_keys[i].name,
                 strstr(word, "of ") + 2);
        snprintf(word, sizeof word, "%s=./x.Q", setting_keys[i].name);
        if (i != SETTING_kernel) refused(word, want);
    }
    refused("kernel=./no/such.so", "kernel './no/such.so': ");
    refused("eta", "'eta': KEY=VALUE expected (`sphproof list keys` shows the keys)");
    snprintf(word, sizeof word, "%080d", 0);
    snprintf(want, sizeof want, "'%060d': KEY=VALUE expected (`sphproof list keys` shows the keys)",
             0);
    refused(word, want);
    refused("eta_=2", "no key 'eta_'; did you mean 'eta'? allowed: lo hi ");
    refused("boundary=", "boundary=: allowed: 1, 2 or 3 of auto periodic open reflecting fixed");
    refused("boundary= , ",
            "boundary= , : allowed: 1, 2 or 3 of auto periodic open reflecting fixed");
    refused(
        "boundary=open open open open",
        "boundary=open open open open: allowed: 1, 2 or 3 of auto periodic open reflecting fixed");
    refused("lo=1 2 3 4", "lo=1 2 3 4: allowed: 1, 2 or 3 numbers from -1e+30 to 1e+30");
    refused("lo=1 2e30", "lo=1 2e30: allowed: 1, 2 or 3 numbers from -1e+30 to 1e+30");
    refused("lo=1 2 -2e30", "lo=1 2 -2e30: allowed: 1, 2 or 3 numbers from -1e+30 to 1e+30");
    refused("left=1 0 1e31", "left=1 0 1e31: allowed: 3 numbers (rho v P) from -1e+30 to 1e+30");
    refused("left=1 0", "left=1 0: allowed: 3 numbers (rho v P) from -1e+30 to 1e+30");
    refused("skip=", "no skip ''; allowed: auto none");
    /* a list of words that does not fit */
    memset(word, ' ', sizeof word);
    memcpy(word, "boundary=open", 13);
    for (int n = SETTING_TEXT_MAX - 1; n <= SETTING_TEXT_MAX; n++) {
        struct settings settings;
        struct error error = {0};
        char *arguments[] = {word};
        word[9 + n] = '\0';
        settings_init(&settings);
        assert_int_equal(settings_apply(&settings, 1, arguments, &error),
                         n < SETTING_TEXT_MAX ? STATUS_OK : STATUS_BAD_INPUT);
        word[9 + n] = ' ';
    }
    memset(word, 'f', sizeof word);
    memcpy(word, "file=", 5);
    for (int n = SETTING_TEXT_MAX - 1; n <= SETTING_TEXT_MAX; n++) {
        struct settings settings;
        struct error error = {0};
        char *arguments[] = {word};
        word[5 + n] = '\0';
        settings_init(&settings);
        assert_int_equal(settings_apply(&settings, 1, arguments, &error),
                         n < SETTING_TEXT_MAX ? STATUS_OK : STATUS_BAD_INPUT);
        assert_string_equal(settings.file, n < SETTING_TEXT_MAX ? word + 5 : "");
        word[5 + n] = 'f';
    }
}

/* Every key of a scheme is stored, and defaults are written back as they are used. */
TEST(schemes)
{
    char *const words[] = {"kernel=sinc",
                           "sinc_n=6",
                           "gradient=ia",
                           "formulation=vanilla_ice",
                           "volume_element=number",
                           "viscosity=cullen_dehnen",
                           "viscosity_form=signal",
                           "balsara=on",
                           "energy=internal",
                           "pair_width=harmonic",
                           "h_method=newton",
                           "integrator=rk3",
                           "alpha=0.3",
                           "beta=0.7",
                           "alpha_min=0.2",
                           "alpha_max=2.5",
                           "balsara_floor=0.01",
                           "noise=0.6",
                           "alpha_u=0.9",
                           "shock_conductivity=1.7",
                           "eta=2.9",
                           "cfl=0.25",
                           "h_tolerance=1e-7"};
    static const enum setting open[] = {
        SETTING_kernel,         SETTING_gradient,   SETTING_volume_element,
        SETTING_viscosity,      SETTING_balsara,    SETTING_energy,
        SETTING_viscosity_form, SETTING_pair_width, SETTING_h_method};
    struct settings settings;
    struct scheme s;
    struct error error;
    settings_init(&settings);
    settings.shared = true; /* no viscosity has all these keys */
    if (settings_apply(&settings, sizeof words / sizeof *words, words, &error) ||
        settings_scheme(&settings, 2, &s, &error))
        fail_msg("%s", error.message);
    assert_true(strcmp(s.kernel.member.name, "sinc") == 0 && s.gradient == GRADIENT_IA &&
                s.formulation == FORMULATION_VANILLA_ICE && s.volume_element == VOLUME_NUMBER);
    assert_true(s.viscosity == VISCOSITY_CULLEN_DEHNEN && s.balsara == BALSARA_ON &&
                s.viscosity_form == VISCOSITY_FORM_SIGNAL && s.energy == ENERGY_INTERNAL);
    assert_true(s.pair_width == PAIR_WIDTH_HARMONIC && s.h_method == H_NEWTON &&
                strcmp(s.integrator->member.name, "rk3") == 0);
    assert_true(s.alpha == 0.3 && s.beta == 0.7 && s.alpha_min == 0.2 && s.alpha_max == 2.5);
    assert_true(s.balsara_floor == 0.01 && s.noise == 0.6 && s.alpha_u == 0.9 &&
                s.shock_conductivity == 1.7 && s.eta == 2.9);
    assert_true(s.cfl == 0.25 && s.h_tolerance == 1e-7);
    struct kernel other;
    assert_int_equal(kernel_select(&other, "sinc", 6, &error), STATUS_OK);
    assert_true(s.kernel.constant[2] == other.constant[2]);
    char *const bad[] = {"eta=0.5"};
    settings_init(&settings);
    assert_int_equal(settings_apply(&settings, 1, bad, &error), STATUS_OK);
    assert_int_equal(settings_scheme(&settings, 1, &s, &error), STATUS_BAD_INPUT);
    settings_init(&settings);
    settings.value[SETTING_sinc_n].real[0] = 99;
    settings.value[SETTING_kernel] =
        (struct setting_value){.choice = family_index(&kernel_family, "sinc")};
    assert_int_equal(settings_scheme(&settings, 1, &s, &error), STATUS_BAD_INPUT);
    for (int dim = 1; dim <= 3; dim++) {
        settings_init(&settings);
        assert_int_equal(settings_scheme(&settings, dim, &s, &error), STATUS_OK);
        const int used[] = {kernel_index(s.kernel.member.name),
                            (int)s.gradient,
                            (int)s.volume_element,
                            (int)s.viscosity,
                            (int)s.balsara,
                            (int)s.energy,
                            (int)s.viscosity_form,
                            (int)s.pair_width,
                            (int)s.h_method};
        for (size_t k = 0; k < sizeof open / sizeof *open; k++)
            assert_int_equal(settings_choice(&settings, open[k]), used[k]);
        assert_true(settings_real(&settings, SETTING_eta) == s.eta && s.eta > 1 &&
                    settings_real(&settings, SETTING_alpha) == s.alpha && s.alpha > 0);
        assert_true(settings_real(&settings, SETTING_beta) == s.beta && s.beta > 0 &&
                    settings_real(&settings, SETTING_cfl) == s.cfl && s.cfl > 0);
    }
}

/* As typed, and as in a document. */
TEST(keys_as_text_and_json)
{
    static const struct {
        const char *argument, *text, *json;
    } rows[] = {
        {"lo=0.1", "0.1", "0.1"},
        {"lo=0.1,2", "0.1 2", "[0.1, 2.0]"},
        {"hi=0.30000000000000004 1e-5 3", "0.30000000000000004 1e-05 3",
         "[0.30000000000000004, 1e-05, 3.0]"},
        {"n=64^2", "4096", "4096"},
        {"n=100000", "100000", "100000"},
        {"n=1e6", "1e+06", "1000000"},
        {"file=a", "a", "\"a\""},
        {"seed=4294967295", "4294967295", "4294967295"},
        {"boundary=open", "open", "\"open\""},
        {"boundary=open fixed", "open fixed", "[\"open\", \"fixed\"]"},
        {"file=a b.csv", "a b.csv", "\"a b.csv\""},
        {"gamma=1.25", "1.25", "1.25"},
        {"window=1 2", "1 2", "[1.0, 2.0]"},
        {"kernel=sinc", "sinc", "\"sinc\""},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct settings settings;
        struct error error;
        char word[64], text[SETTING_TEXT_MAX], *arguments[] = {word};
        snprintf(word, sizeof word, "%s", rows[k].argument);
        settings_init(&settings);
        if (settings_apply(&settings, 1, arguments, &error)) fail_msg("%s", error.message);
        *strchr(word, '=') = '\0';
        settings_text(&settings, (enum setting)setting_find(word), text);
        assert_string_equal(text, rows[k].text);
        json_t *json = settings_json(&settings),
               *want = json_loads(rows[k].json, JSON_DECODE_ANY, NULL);
        if (!json_equal(json_object_get(json, word), want))
            fail_msg("%s: not %s", rows[k].argument, rows[k].json);
        json_decref(json);
        json_decref(want);
    }
}

/* A document has the keys that have an effect on the problem in this number of dimensions. */
TEST(documents_have_what_is_read)
{
    struct settings settings;
    for (int dim = 1; dim <= 2; dim++) {
        settings_init(&settings);
        settings.dim = dim;
        json_t *json = settings_json(&settings);
        assert_null(json_object_get(json, "file"));
        assert_null(json_object_get(json, "contrast"));
        assert_true(json_is_array(json_object_get(json, "left")));
        assert_int_equal(json_object_get(json, "gravity") != NULL, dim > 1);
        assert_int_equal(json_object_get(json, "grade") != NULL, dim == 1);
        json_decref(json);
    }
}

/* A user's key that has no effect because of another key's value is refused; keys from other
 * sources are not. */
TEST(keys_without_effect_are_refused)
{
    static const struct {
        int dim;
        const char *keys[2];
        const char *message; /* NULL: allowed */
    } rows[] = {
        {1,
         {"sinc_n=7"},
         "sinc_n=7 and kernel=quadratic_spline exclude each other: sinc_n needs kernel sinc"},
        {1, {"sinc_n=7", "kernel=sinc"}, NULL},
        {1,
         {"alpha_max=9"},
         "alpha_max=9 and viscosity=constant exclude each other: alpha_max needs viscosity "
         "time_dependent cullen_dehnen"},
        {1, {"alpha_max=9", "viscosity=time_dependent"}, NULL},
        {2, {"alpha_min=0", "viscosity=cullen_dehnen"}, NULL},
        {1, {"viscosity=none", "alpha=3"}, "alpha=3 and viscosity=none exclude"},
        {1,
         {"viscosity=time_dependent", "alpha=3"},
         "alpha=3 and viscosity=time_dependent exclude each other: alpha needs viscosity constant "
         "reconstructed fading projected"},
        {2, {"viscosity=cullen_dehnen", "beta=3"}, NULL}, /* beside the default alpha */
        {1, {"alpha=1", "beta=3"}, NULL},
        {2,
         {"viscosity=constant", "noise=2"},
         "noise=2 and viscosity=constant exclude each other: noise needs viscosity projected"},
        {2, {"noise=2"}, NULL},
        {2,
         {"balsara=off", "balsara_floor=3"},
         "balsara_floor=3 and balsara=off exclude each other: balsara_floor needs balsara on"},
        {2, {"balsara=on", "balsara_floor=3"}, NULL},
        {2,
         {"viscosity=none", "balsara=on"},
         "balsara=on and viscosity=none exclude each other: balsara needs viscosity constant "
         "time_dependent reconstructed fading cullen_dehnen projected"},
        {3,
         {"viscosity=none", "viscosity_form=mu"},
         "viscosity_form=mu and viscosity=none exclude"},
        {2,
         {"viscosity=none", "balsara_floor=3"},
         "balsara_floor=3 and viscosity=none exclude each other: balsara_floor needs viscosity "
         "con"},
        {1,
         {"seed=3"},
         "seed=3 and lattice=uniform exclude each other: seed needs lattice jittered random glass, "
         "or jitter above 0"},
        {1, {"seed=3", "jitter=0.1"}, NULL},
        {2, {"seed=3", "lattice=jittered"}, NULL},
        {2, {"seed=3", "lattice=glass"}, NULL},
        {1,
         {"grade_ratio=1.5"},
         "grade_ratio=1.5 and grade=1 exclude each other: grade_ratio needs grade below 1"},
        {1, {"grade_ratio=1.5", "grade=0.5"}, NULL},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int source = SOURCE_CASE; source <= SOURCE_USER; source++) {
            struct settings settings;
            struct scheme scheme;
            struct error error = {0};
            settings_init(&settings);
            for (int i = 0; i < 2 && rows[k].keys[i]; i++)
                assert_int_equal(
                    settings_apply(&settings, 1, (char *const *)&rows[k].keys[i], &error),
                    STATUS_OK);
            for (int i = 0; i < SETTINGS && source == SOURCE_CASE; i++)
                settings.value[i].source = SOURCE_CASE;
            const bool refused = rows[k].message && source == SOURCE_USER;
            assert_int_equal(settings_scheme(&settings, rows[k].dim, &scheme, &error),
                             refused ? STATUS_BAD_INPUT : STATUS_OK);
            if (refused && !strstr(error.message, rows[k].message))
                fail_msg("row %zu: %s", k, error.message);
            settings.shared = true;
            assert_int_equal(settings_scheme(&settings, rows[k].dim, &scheme, &error), STATUS_OK);
        }
}

static int allow_plugins(void **state)
{
    (void)state;
    plugin_allow(certificate_failing, false);
    return 0;
}

TEST_BETWEEN(allow_plugins, NULL);
