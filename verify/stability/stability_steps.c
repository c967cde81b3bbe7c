/* SPDX-License-Identifier: GPL-3.0-or-later
 * One time step of a wave as a linear map: the integrators of src/integrator once more, from their
 * formulas, on amplitudes. What an integrator carries from step to step is part of the state: the
 * last rates and, where h is predicted, the last two density sums. */
#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_eigen.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "integrator.h"
#include "stability.h"
#include "worst.h"

enum { X, V, E, FORCE, HEAT, FOUND, LAST, STATES };
enum { WAVES = 64 };

struct wave_step {
    struct stability_response r;
    double h, dt, s[STATES];
    bool predicted;
    double follow; /* dU per error of the predicted volume: over h times the error of 1/h */
    double ratio;  /* extrapolation of the next width: 1; 0 in the first step */
};

static void evaluate(struct wave_step *w)
{
    double *s = w->s, H, U = s[E];
    if (w->predicted) {
        const double expected = s[FOUND] + w->ratio * (s[FOUND] - s[LAST]);
        H = -w->h * w->h * expected;
        s[LAST] = s[FOUND];
        s[FOUND] = w->r.found_x * s[X] + w->r.found_h * H;
        U += w->follow * w->h * (s[FOUND] - expected);
        s[FOUND] = expected + (s[FOUND] - expected) / fmax(1 + w->r.found_h * w->h * w->h, 0.25);
    } else {
        H = -w->r.found_x * s[X] / (1 / (w->h * w->h) + w->r.found_h);
    }
    s[FORCE] = w->r.force_x * s[X] + w->r.force_v * s[V] + w->r.force_u * U + w->r.force_h * H;
    s[HEAT] = w->r.energy_v * s[V];
}

static void leapfrog(struct wave_step *w)
{
    double *s = w->s;
    const double v_half = s[V] + 0.5 * w->dt * s[FORCE], e_half = s[E] + 0.5 * w->dt * s[HEAT];
    s[X] += w->dt * v_half;
    s[V] += w->dt * s[FORCE];
    s[E] += w->dt * s[HEAT];
    evaluate(w);
    s[V] = v_half + 0.5 * w->dt * s[FORCE];
    s[E] = e_half + 0.5 * w->dt * s[HEAT];
}

static void modified_leapfrog(struct wave_step *w)
{
    leapfrog(w);
    evaluate(w);
}

static void symplectic_euler(struct wave_step *w)
{
    double *s = w->s;
    s[V] += w->dt * s[FORCE];
    s[E] += w->dt * s[HEAT];
    s[X] += w->dt * s[V];
    evaluate(w);
}

static void stage(struct wave_step *w, const double *start, double now, double old, double weight)
{
    double *s = w->s;
    const double v = s[V];
    s[X] = now * s[X] + old * start[X] + weight * w->dt * v;
    s[V] = now * v + old * start[V] + weight * w->dt * s[FORCE];
    s[E] = now * s[E] + old * start[E] + weight * w->dt * s[HEAT];
    evaluate(w);
}

static void rk2(struct wave_step *w)
{
    const double start[] = {w->s[X], w->s[V], w->s[E]};
    stage(w, start, 0, 1, 1);
    stage(w, start, 0.5, 0.5, 0.5);
}

static void vl2(struct wave_step *w)
{
    const double start[] = {w->s[X], w->s[V], w->s[E]};
    stage(w, start, 0, 1, 0.5);
    stage(w, start, 0, 1, 1);
}

static void rk3(struct wave_step *w)
{
    const double start[] = {w->s[X], w->s[V], w->s[E]};
    stage(w, start, 0, 1, 1);
    stage(w, start, 0.25, 0.75, 0.25);
    stage(w, start, 2. / 3, 1. / 3, 2. / 3);
}

static void predicted_midpoint(struct wave_step *w)
{
    double *s = w->s;
    const double x = s[X], v = s[V], e = s[E];
    s[X] += 0.5 * w->dt * v;
    s[V] += 0.5 * w->dt * s[FORCE];
    s[E] += 0.5 * w->dt * s[HEAT];
    evaluate(w);
    s[V] = v + w->dt * s[FORCE];
    s[E] = e + w->dt * s[HEAT];
    s[X] = x + 0.5 * w->dt * (v + s[V]);
}

static const struct {
    const char *name;
    void (*step)(struct wave_step *w);
} steps[] = {{"leapfrog", leapfrog},
             {"modified_leapfrog", modified_leapfrog},
             {"symplectic_euler", symplectic_euler},
             {"rk2", rk2},
             {"vl2", vl2},
             {"rk3", rk3},
             {"predicted_midpoint", predicted_midpoint}};

/* Largest |eigenvalue| of a step. */
static double spectral_radius(struct wave_step *w, void (*step)(struct wave_step *w))
{
    double a[STATES * STATES], radius = 0;
    for (int column = 0; column < STATES; column++) {
        memset(w->s, 0, sizeof w->s);
        w->s[column] = 1;
        step(w);
        for (int row = 0; row < STATES; row++) a[row * STATES + column] = w->s[row];
    }
    gsl_matrix_view matrix = gsl_matrix_view_array(a, STATES, STATES);
    gsl_vector_complex *values = gsl_vector_complex_alloc(STATES);
    gsl_eigen_nonsymm_workspace *workspace = gsl_eigen_nonsymm_alloc(STATES);
    if (!values || !workspace || gsl_eigen_nonsymm(&matrix.matrix, values, workspace)) radius = NAN;
    for (size_t i = 0; values && i < STATES && !isnan(radius); i++)
        worst_keep(&radius, gsl_complex_abs(gsl_vector_complex_get(values, i)));
    if (values) gsl_vector_complex_free(values);
    if (workspace) gsl_eigen_nonsymm_free(workspace);
    return radius;
}

static void (*find_step(const struct stability *lattice))(struct wave_step *)
{
    const char *name = lattice->scheme.integrator->member.name;
    for (size_t k = 0; k < sizeof steps / sizeof *steps; k++)
        if (!strcmp(steps[k].name, name)) return steps[k].step;
    return NULL;
}

static struct wave_step begin(const struct stability *lattice, double dt)
{
    return (struct wave_step){.h = lattice->h,
                              .dt = dt,
                              .ratio = 1,
                              .follow = lattice->scheme.volume_element == VOLUME_MASS
                                            ? lattice->scheme.integrator->follow *
                                                  (lattice->gamma - 1) * lattice->u
                                            : 0,
                              .predicted = lattice->scheme.h_method != H_NEWTON};
}

bool stability_knows(const struct integrator *integrator)
{
    const struct stability lattice = {.scheme.integrator = integrator};
    return find_step(&lattice) != NULL;
}

void stability_follow(const struct stability *lattice, double kappa, double dt, int count,
                      double *x, double *v)
{
    struct wave_step w = begin(lattice, dt);
    void (*step)(struct wave_step *) = find_step(lattice);
    stability_response(lattice, kappa, &w.r);
    w.s[X] = 1;
    /* the first density sum solves for h, as if the prediction were exact */
    w.s[FOUND] = w.s[LAST] = w.r.found_x / (1 + w.h * w.h * w.r.found_h);
    w.predicted = false;
    evaluate(&w);
    w.predicted = lattice->scheme.h_method != H_NEWTON;
    for (int i = 0; step && i < count; i++) {
        w.ratio = i > 0;
        step(&w);
    }
    *x = step ? w.s[X] : (double)NAN;
    *v = step ? w.s[V] : (double)NAN;
}

/* Largest |eigenvalue| of one time step dt over all waves: the scheme's integrator with all its
 * memory (old rates, predicted widths). */
static double amplification(const struct stability *lattice, double dt)
{
    struct wave_step w = begin(lattice, dt);
    void (*step)(struct wave_step *) = find_step(lattice);
    double worst = step ? 0 : (double)NAN;
    for (int i = 1; step && i <= WAVES; i++) {
        stability_response(lattice, M_PI * i / WAVES, &w.r);
        const double radius = spectral_radius(&w, step);
        worst_keep(&worst, radius);
    }
    return worst;
}

double stability_time_step(const struct stability *lattice, double to)
{
    /* growth per step that a run would not show */
    const double tolerance = 1e-4;
    double stable = 0, unstable = to;
    enum { STEPS = 40 };
    for (int i = 1; i <= STEPS; i++) {
        const double dt = to * i / STEPS;
        if (!(amplification(lattice, dt) <= 1 + tolerance * dt)) {
            unstable = dt;
            break;
        }
        stable = dt;
    }
    for (int i = 0; i < 16 && stable < unstable; i++) {
        const double middle = 0.5 * (stable + unstable);
        const bool good = amplification(lattice, middle) <= 1 + tolerance * middle;
        *(good ? &stable : &unstable) = middle;
    }
    return stable;
}
