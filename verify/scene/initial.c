/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "initial.h"

#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>

/* Mass of particle i of n on one side over the usual one: min(1, g q^k), k counted from the nearer
 * jump (the main one or the mirrored one). */
struct grading {
    double g, q;
};

static double grading_weight(const struct grading *grading, size_t i, size_t n)
{
    const size_t k = i < n - 1 - i ? i : n - 1 - i;
    return grading->g < 1 ? fmin(1, grading->g * pow(grading->q, (double)k)) : 1;
}

/* The sum of all weights of a side of n particles. */
static double grading_sum(const struct grading *grading, size_t n)
{
    double sum = 0;
    size_t k = 0;
    for (; 2 * k < n; k++) {
        const double weight = grading_weight(grading, k, n);
        if (weight == 1) break;
        sum += 2 * k + 1 == n ? weight : 2 * weight;
    }
    return sum + (2 * k < n ? (double)(n - 2 * k) : 0);
}

/* Particles on the left so that the usual mass is nearly the same on both sides: round(n rho_L /
 * (rho_L + rho_R)) for equal masses. */
static size_t left_share(const struct grading *grading, size_t n, double rho_left, double rho_right)
{
    const double fraction = rho_left / (rho_left + rho_right);
    size_t lo = 1, hi = n - 1;
    if (grading->g == 1)
        lo = (size_t)fmin(fmax(round((double)n * fraction), 1), (double)(n - 1));
    else
        while (lo < hi) { /* the share of the left side's weights rises with its number */
            const size_t middle = (lo + hi) / 2;
            const double left = grading_sum(grading, middle);
            const double right = grading_sum(grading, n - middle);
            const double next_left = grading_sum(grading, middle + 1);
            const double next_right = grading_sum(grading, n - middle - 1);
            const double here = left / (left + right), next = next_left / (next_left + next_right);
            if (fabs(here - fraction) <= fabs(next - fraction))
                hi = middle;
            else
                lo = middle + 1;
        }
    return lo;
}

static void fill_side(struct initial *initial, size_t first, size_t n, double lo, double length,
                      const double *state, double gamma, const struct grading *grading)
{
    const double unit = state[0] * length / grading_sum(grading, n);
    double edge = lo;
    for (size_t i = 0; i < n; i++) {
        const size_t at = first + i;
        const double mass = unit * grading_weight(grading, i, n);
        initial->m[at] = mass;
        /* equal masses: no sum of rounded widths */
        initial->x[at] = grading->g < 1 ? edge + 0.5 * mass / state[0]
                                        : lo + ((double)i + 0.5) * (length / (double)n);
        edge += mass / state[0];
        initial->v[at] = state[1];
        initial->u[at] = state[2] / ((gamma - 1) * state[0]);
        initial->rho[at] = state[0];
    }
}

static void fill_riemann(struct initial *initial, const struct settings *settings,
                         const struct exact *exact)
{
    const double *left = settings->value[SETTING_left].real;
    const double *right = settings->value[SETTING_right].real;
    const double gamma = settings_real(settings, SETTING_gamma);
    const struct grading grading = {settings_real(settings, SETTING_grade),
                                    settings_real(settings, SETTING_grade_ratio)};
    const size_t n_left = left_share(&grading, initial->n, left[0],
                                     right[0] / settings_real(settings, SETTING_mass_ratio));
    fill_side(initial, 0, n_left, exact->lo, exact->x0 - exact->lo, left, gamma, &grading);
    fill_side(initial, n_left, initial->n - n_left, exact->x0, exact->hi - exact->x0, right, gamma,
              &grading);
}

/* Position x (from lo) with mass between lo and x equal to `mass`: Newton on
 * rho0 (x + A (1 - cos k x)/k), which rises by at least rho0 (1 - A). */
static double wave_position(const struct simple_wave *wave, double mass)
{
    const double k = 2 * M_PI / wave->length;
    double x = mass / wave->rho0;
    for (int i = 0; i < 50; i++) {
        const double excess = x + wave->amplitude * (1 - cos(k * x)) / k - mass / wave->rho0;
        const double step = excess / (1 + wave->amplitude * sin(k * x));
        x -= step;
        if (fabs(step) <= 1e-16 * wave->length) break;
    }
    return x;
}

static void fill_wave(struct initial *initial, const struct exact *exact)
{
    const double length = exact->hi - exact->lo;
    const double mass = exact->wave.rho0 * length / (double)initial->n;
    for (size_t i = 0; i < initial->n; i++) {
        double values[FIELDS];
        initial->m[i] = mass;
        initial->x[i] = exact->lo + wave_position(&exact->wave, ((double)i + 0.5) * mass);
        exact_sample(exact, initial->x[i], 0, values);
        initial->v[i] = values[FIELD_VELOCITY];
        initial->u[i] = values[FIELD_INTERNAL_ENERGY];
        initial->rho[i] = values[FIELD_DENSITY];
    }
}

/* Brings every second particle close to its neighbour on the same side of the jump. */
static void pair_up(struct initial *initial, const struct settings *settings)
{
    const int lattice = settings_choice(settings, SETTING_lattice);
    if (lattice == LATTICE_UNIFORM) return;
    const double part = lattice == LATTICE_CLUSTERED ? 0.05 : 0;
    double *x = initial->x;
    for (size_t i = 0; i + 1 < initial->n; i++) {
        if (initial->rho[i] != initial->rho[i + 1] || initial->m[i] != initial->m[i + 1]) continue;
        const double middle = 0.5 * (x[i] + x[i + 1]), half = part * (x[i + 1] - x[i]);
        x[i] = middle - half;
        x[i + 1] = middle + half;
        i++;
    }
}

/* Moves each particle by up to jitter times its share of the space, so that their order stays. */
static enum status shake(struct initial *initial, const struct settings *settings,
                         const struct exact *exact)
{
    const double jitter = settings_real(settings, SETTING_jitter);
    if (jitter == 0) return STATUS_OK;
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    if (!random) return STATUS_ENVIRONMENT;
    gsl_rng_set(random, (unsigned long)settings_real(settings, SETTING_seed));
    for (size_t i = 0; i < initial->n; i++) {
        const double spacing = initial->m[i] / initial->rho[i];
        initial->x[i] += jitter * spacing * (2 * gsl_rng_uniform(random) - 1);
        initial->x[i] = fmin(fmax(initial->x[i], exact->lo), nextafter(exact->hi, exact->lo));
    }
    gsl_rng_free(random);
    return STATUS_OK;
}

enum status initial_create(struct initial *initial, const struct settings *settings,
                           const struct exact *exact, struct error *error)
{
    const size_t n = (size_t)settings_real(settings, SETTING_n);
    *initial = (struct initial){.n = n, .storage = malloc(5 * n * sizeof(double))};
    if (!initial->storage)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for n=%zu particles", n);
    double **const arrays[] = {&initial->x, &initial->v, &initial->m, &initial->u, &initial->rho};
    for (size_t i = 0; i < 5; i++) *arrays[i] = initial->storage + i * n;
    if (exact->kind == KIND_RIEMANN)
        fill_riemann(initial, settings, exact);
    else
        fill_wave(initial, exact);
    pair_up(initial, settings);
    if (shake(initial, settings, exact)) {
        initial_free(initial);
        return error_set(error, STATUS_ENVIRONMENT, "no memory for random numbers");
    }
    return STATUS_OK;
}

void initial_free(struct initial *initial)
{
    free(initial->storage);
    *initial = (struct initial){0};
}
