/* SPDX-License-Identifier: GPL-3.0-or-later
 * Suspicion rules: they must report results that are too good, and no others. */
#include "suspicion.h"

#include <math.h>

#include "check.h"

enum { LEVELS = 4, PARTICLES = 200 };

struct suspicion_subject {
    bool (*zero)(size_t n, const double *error, char *why);
    bool (*repeated)(size_t n, const double *error, char *why);
    bool (*idle)(const char *setting, size_t n, const double *before, const double *after,
                 char *why);
    bool (*swapped)(size_t fields, const char *const *names, size_t n, const double *volume,
                    const double *const *value, const double *const *exact, char *why);
};

static void expect(struct check_run *run, bool got, bool expected, const char *what)
{
    check_measure(run, got != expected, 0, 0, "%s: %s", what,
                  expected ? "must be suspected" : "must be left alone");
}

/* Three profiles of a tube, each 1 % off the exact solution; density and pressure may be
 * exchanged. */
static bool tube_suspected(const struct suspicion_subject *s, bool exchanged, double scale)
{
    static const char *const names[] = {"density", "velocity", "pressure"};
    double volume[PARTICLES], exact[3][PARTICLES], value[3][PARTICLES];
    for (int i = 0; i < PARTICLES; i++) {
        const double x = (i + 0.5) / PARTICLES;
        volume[i] = 1. / PARTICLES;
        exact[0][i] = x < 0.5 ? 1 : 0.25;
        exact[1][i] = x < 0.5 ? x : 0.7;
        exact[2][i] = scale * (x < 0.5 ? 1 : 0.1795);
        for (int f = 0; f < 3; f++) value[f][i] = exact[f][i] * (1 + 0.01 * sin(40 * x)) + 1e-3;
    }
    const double *const values[] = {value[exchanged ? 2 : 0], value[1], value[exchanged ? 0 : 2]};
    const double *const exacts[] = {exact[0], exact[1], exact[2]};
    return s->swapped(3, names, PARTICLES, volume, values, exacts, NULL);
}

/* A coarse run: the pressure's error is as large as its distance from the density, and has that
 * sign. */
static bool coarse_suspected(const struct suspicion_subject *s)
{
    static const char *const names[] = {"density", "pressure"};
    static const double volume[] = {1, 1}, rho[] = {1, 0.5}, P[] = {1, 0.4}, off[] = {1.05, 0.46};
    const double *const values[] = {rho, off}, *const exacts[] = {rho, P};
    return s->swapped(2, names, 2, volume, values, exacts, NULL);
}

/* Density at this fraction of the way from its own exact solution to that of pressure. Suspicious
 * beyond two thirds. */
static bool between_suspected(const struct suspicion_subject *s, double part)
{
    static const char *const names[] = {"density", "pressure"};
    static const double volume[] = {0.25, 0.5}, rho[] = {1, 1.25}, P[] = {0.75, 1.5};
    const double off[] = {rho[0] + part * (P[0] - rho[0]), rho[1] + part * (P[1] - rho[1])};
    const double *const values[] = {off, P}, *const exacts[] = {rho, P};
    return s->swapped(2, names, 2, volume, values, exacts, NULL);
}

/* A coarse blast whose shock has left the window: gas that should fall is at rest, and its velocity
 * 0 is close to the small energy ahead of the shock. difference: twice that of the two velocities;
 * at 0 the velocity is uniform and follows no field. */
static bool even_suspected(const struct suspicion_subject *s, double difference)
{
    static const char *const names[] = {"velocity", "energy"};
    static const double volume[] = {0.25, 0.75}, v[] = {0, 1}, e[] = {0.5, 0};
    const double even[] = {0.5 * difference, 0};
    const double *const values[] = {even, e}, *const exacts[] = {v, e};
    return s->swapped(2, names, 2, volume, values, exacts, NULL);
}

static void measure(struct check_run *run, const void *subject)
{
    static const struct suspicion_subject right = {suspicion_zero, suspicion_repeated,
                                                   suspicion_idle_setting, suspicion_swapped};
    const struct suspicion_subject *s = subject ? subject : &right;
    const double honest[LEVELS] = {1e-2, 5.1e-3, 2.4e-3, 1.3e-3};
    const double zero[LEVELS] = {1e-2, 5.1e-3, 0, 1.3e-3};
    const double tiny[LEVELS] = {1e-15, 4e-16, 2e-16, 3e-300};
    const double repeated[LEVELS] = {1e-2, 5.1e-3, 2.4e-3, 5.1e-3 * (1 + 1e-14)};
    const double close[LEVELS] = {1e-2, 5.1e-3, 5.1e-3 * (1 + 1e-9), 1.3e-3};
    expect(run, s->zero(LEVELS, zero, NULL), true, "an error of exactly 0");
    expect(run, s->zero(LEVELS, (const double[]){0, 3, 2, 1}, NULL), true,
           "0 at the coarsest level");
    expect(run, s->zero(LEVELS, (const double[]){3, 2, 1, 0}, NULL), true, "0 at the finest level");
    expect(run, s->repeated(LEVELS, (const double[]){2, 3, 1, 2}, NULL), true,
           "the same error at the ends");
    expect(run, s->idle("eta", 0, honest, honest, NULL), false, "nothing to compare");
    expect(run, s->zero(LEVELS, tiny, NULL), false, "errors of round-off");
    expect(run, s->repeated(LEVELS, repeated, NULL), true, "the same error at levels 1 and 3");
    expect(run, s->repeated(LEVELS, close, NULL), false, "errors near each other");
    expect(run, s->repeated(2, (const double[]){0, 0}, NULL), true, "no error at two levels");
    expect(run, s->repeated(LEVELS, honest, NULL), false, "an honest ladder");
    expect(run, s->idle("eta", LEVELS, honest, honest, NULL), true, "a setting without effect");
    expect(run, s->idle("eta", LEVELS, honest, close, NULL), false, "a setting with some effect");
    expect(run, tube_suspected(s, false, 1.1), false, "three fields in their places");
    expect(run, tube_suspected(s, true, 1.1), true, "density and pressure exchanged");
    expect(run, tube_suspected(s, false, 1), false, "density and pressure much alike");
    expect(run, coarse_suspected(s), false, "an error that points to another field");
    expect(run, between_suspected(s, 0.6666), false, "just over half as far from another field");
    expect(run, between_suspected(s, 0.6667), true, "just under half as far from another field");
    expect(run, even_suspected(s, 0), false, "a uniform field near a small one");
    expect(run, even_suspected(s, 0.249), false, "a field that hardly follows another");
    expect(run, even_suspected(s, 0.251), true, "a field that follows another");
}

static bool never_zero(size_t n, const double *error, char *why)
{
    (void)n, (void)error, (void)why;
    return false;
}

static bool near_zero(size_t n, const double *error, char *why)
{
    for (size_t i = 0; i < n; i++)
        if (fabs(error[i]) < 1e-14) return true;
    return suspicion_zero(n, error, why);
}

static bool neighbours_only(size_t n, const double *error, char *why)
{
    for (size_t i = 1; i < n; i++)
        if (suspicion_repeated(2, error + i - 1, why)) return true;
    return false;
}

static bool first_only(const char *setting, size_t n, const double *before, const double *after,
                       char *why)
{
    (void)n;
    return suspicion_idle_setting(setting, 1, before, after, why);
}

static bool never_swapped(size_t fields, const char *const *names, size_t n, const double *volume,
                          const double *const *value, const double *const *exact, char *why)
{
    (void)fields, (void)names, (void)n, (void)volume, (void)value, (void)exact, (void)why;
    return false;
}

static double distance(size_t n, const double *volume, const double *a, const double *b)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += volume[i] * fabs(a[i] - b[i]);
    return sum;
}

static bool any_nearer(size_t fields, const char *const *names, size_t n, const double *volume,
                       const double *const *value, const double *const *exact, char *why)
{
    for (size_t f = 0; f < fields; f++)
        for (size_t g = 0; g < fields; g++)
            if (distance(n, volume, value[f], exact[g]) < distance(n, volume, value[f], exact[f]))
                return true;
    return suspicion_swapped(fields, names, n, volume, value, exact, why);
}

static bool twice_nearer(size_t fields, const char *const *names, size_t n, const double *volume,
                         const double *const *value, const double *const *exact, char *why)
{
    (void)names, (void)why;
    for (size_t f = 0; f < fields; f++)
        for (size_t g = 0; g < fields; g++)
            if (2 * distance(n, volume, value[f], exact[g]) <
                distance(n, volume, value[f], exact[f]))
                return true;
    return false;
}

static const struct suspicion_subject no_zero = {never_zero, suspicion_repeated,
                                                 suspicion_idle_setting, suspicion_swapped};
static const struct suspicion_subject loose_zero = {near_zero, suspicion_repeated,
                                                    suspicion_idle_setting, suspicion_swapped};
static const struct suspicion_subject adjacent = {suspicion_zero, neighbours_only,
                                                  suspicion_idle_setting, suspicion_swapped};
static const struct suspicion_subject one_error = {suspicion_zero, suspicion_repeated, first_only,
                                                   suspicion_swapped};
static const struct suspicion_subject no_swap = {suspicion_zero, suspicion_repeated,
                                                 suspicion_idle_setting, never_swapped};
static const struct suspicion_subject near_swap = {suspicion_zero, suspicion_repeated,
                                                   suspicion_idle_setting, any_nearer};
static const struct suspicion_subject even_swap = {suspicion_zero, suspicion_repeated,
                                                   suspicion_idle_setting, twice_nearer};

static const struct check_mutant mutants[] = {
    {"suspicion_no_zero", "an error of 0 is welcome", &no_zero},
    {"suspicion_loose_zero", "round-off is taken for 0", &loose_zero},
    {"suspicion_adjacent_only", "only neighbouring levels compared", &adjacent},
    {"suspicion_first_error_only", "one equal error makes a setting idle", &one_error},
    {"suspicion_no_swap", "exchanged fields pass", &no_swap},
    {"suspicion_any_nearer", "a coarse run is taken for an exchange", &near_swap},
    {"suspicion_even", "a field that follows nothing is taken for an exchange", &even_swap},
    {0},
};

CHECK_DEFINE(
    norms, suspicion, 650,
    .property = "an error of 0, a repeated error, an idle setting, an exchanged field are noticed",
    .measure = measure, .mutants = mutants);
