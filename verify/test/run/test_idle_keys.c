/* SPDX-License-Identifier: GPL-3.0-or-later
 * A key that is accepted has an effect: for schemes and starts drawn at random, another value of
 * one of the keys gives another result, in gas with shocks and disorder, where every term acts.
 * Only `skip` may change nothing: results must not depend on it. */
#include "test.h"

#include "keyed.h"

enum { DRAWS = 2500, WORDS = 5 };

static uint64_t drawn = 20260101;

static size_t draw(size_t n)
{
    drawn = drawn * 6364136223846793005u + 1442695040888963407u;
    return (size_t)(drawn >> 33) % n;
}

/* Values of keys; where there are none, any member of the key's family. */
static const struct {
    enum setting key;
    const char *values[3];
} keys[] = {
    {SETTING_kernel, {"cubic_spline", "wendland_c4", "sinc"}},
    {SETTING_sinc_n, {"4", "5", "7"}},
    {SETTING_eta, {"3.3", "3.5", "3.7"}},
    {SETTING_gradient, {0}},
    {SETTING_formulation, {0}},
    {SETTING_volume_element, {0}},
    {SETTING_integrator, {0}},
    {SETTING_cfl, {"0.1", "0.13", "0.2"}},
    {SETTING_energy, {0}},
    {SETTING_viscosity, {0}},
    {SETTING_viscosity_form, {0}},
    {SETTING_balsara, {0}},
    {SETTING_balsara_floor, {"0.1", "0.2", "0.3"}},
    {SETTING_noise, {"0.1", "0.2", "0.3"}},
    {SETTING_alpha_u, {"0.1", "0.2", "0.3"}},
    {SETTING_shock_conductivity, {"0.1", "0.2", "0.3"}},
    {SETTING_alpha, {"0.5", "0.7", "1.2"}},
    {SETTING_beta, {"0.5", "0.7", "1.3"}},
    {SETTING_alpha_min, {"0.2", "0.3", "0.4"}},
    {SETTING_alpha_max, {"0.6", "1", "1.4"}},
    {SETTING_pair_width, {0}},
    {SETTING_shifting, {0}},
    {SETTING_h_method, {0}},
    {SETTING_h_tolerance, {"1e-3", "1e-5", "1e-7"}},
    {SETTING_seed, {"2", "3", "4"}},
    {SETTING_jitter, {"0.05", "0.1", "0.2"}},
    {SETTING_grade, {"0.5", "0.7", "0.8"}},
    {SETTING_grade_ratio, {"1.1", "1.2", "1.3"}},
    {SETTING_gamma, {"1.3", "1.4", "1.6"}},
};
enum { KEYS = sizeof keys / sizeof *keys };

static const char *value_of(size_t k)
{
    const struct family *family = setting_keys[keys[k].key].family;
    return keys[k].values[0] ? keys[k].values[draw(3)] : family->members[draw(family->n)]->name;
}

/* Hashes of the result; false: refused, or broken down. */
static bool hash_of(const char *name, const char *line, uint64_t *hash)
{
    struct keyed_words words;
    struct run_settings settings;
    struct run run;
    struct run_result result;
    struct error error;
    keyed_words(&words, line, " ");
    if (run_prepare(&settings, name, words.n, words.word, &error) ||
        run_resolve(&run, &settings, &error))
        return false;
    const enum status status = run_execute(&run, &result, &error);
    if (status == STATUS_BROKE_DOWN) run_free(&result);
    if (status) return false;
    const struct snapshot *s = &result.snapshot;
    const double *const fields[] = {s->x[0], s->v[0], s->u, s->rho, s->h};
    *hash = result.cost.steps;
    for (size_t f = 0; f < sizeof fields / sizeof *fields; f++)
        for (size_t i = 0; i < s->n; i++) {
            uint64_t bits;
            memcpy(&bits, &fields[f][i], sizeof bits);
            *hash = (*hash ^ bits) * 1099511628211u;
        }
    run_free(&result);
    return true;
}

TEST(accepted_keys_have_effects)
{
    static const struct {
        const char *name, *keys;
    } cases[] = {
        {"sod", "n=40 t_end=0.03"},
        {"sod", "n=40 t_end=0.03 jitter=0.3 kernel=sinc viscosity=time_dependent"},
        {"sod", "n=40 t_end=0.03 grade=0.6"},
        {"sod_2d", "n=500 t_end=0.01 jitter=0.3 kernel=cubic_spline eta=2.4"},
        {"sod_2d",
         "n=500 t_end=0.01 jitter=0.3 kernel=cubic_spline eta=2.4 viscosity=constant balsara=on"}};
    size_t changed[KEYS] = {0};
    for (size_t trial = 0; trial < DRAWS; trial++) {
        const size_t c = draw(sizeof cases / sizeof *cases), count = 1 + draw(WORDS - 1);
        char line[2][512];
        size_t chosen[WORDS];
        snprintf(line[0], sizeof line[0], "%s", cases[c].keys);
        for (size_t w = 0; w < count; w++) {
            const size_t used = strlen(line[0]);
            chosen[w] = draw(KEYS);
            snprintf(line[0] + used, 60, " %.30s=%.25s", setting_keys[keys[chosen[w]].key].name,
                     value_of(chosen[w]));
        }
        /* the last value counts */
        const size_t k = chosen[count - 1];
        const char *before = strrchr(line[0], '=') + 1, *after = value_of(k);
        uint64_t hash[2];
        if (strcmp(before, after) == 0 || !hash_of(cases[c].name, line[0], &hash[0])) continue;
        snprintf(line[1], sizeof line[1], "%.400s %.30s=%.25s", line[0],
                 setting_keys[keys[k].key].name, after);
        if (!hash_of(cases[c].name, line[1], &hash[1])) continue;
        if (hash[0] == hash[1]) fail_msg("%s %s: no effect", cases[c].name, line[1]);
        changed[k]++;
    }
    for (size_t k = 0; k < KEYS; k++)
        if (!changed[k]) fail_msg("%s was never accepted", setting_keys[keys[k].key].name);
}
