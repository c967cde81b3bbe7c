/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks of the exact flows of 2D and 3D: they satisfy Euler's equations at every position, also
 * with a boost; and known properties of the shear layers without an exact solution. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases.h"
#include "check.h"
#include "kelvin_helmholtz.h"
#include "noh.h"
#include "problem.h"
#include "problem_prepare.h"
#include "worst.h"

/* ---- dU/dt + div F = 0 ---- */

struct flow_subject {
    const char *case_name, *keys; /* keys: separated by | */
    void (*sample)(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state);
};

/* The problem's gas has a small pressure, which the exact solution neglects. */
static void noh_without_pressure(const struct prepared *p, const double x[3], double t,
                                 struct problem_state *state)
{
    problem_sample(p, x, t, state);
    if (problem_radius(p, x) > noh_shock(p->gamma, t)) state->P = state->u = 0;
}

static const struct flow_subject flows[] = {
    {"gresho", "", problem_sample},
    {"gresho", "boost=1 0.3", problem_sample},
    {"yee", "", problem_sample},
    {"yee", "gamma=1.6666666666666667|boost=-0.7 1", problem_sample},
    {"sound_wave_2d", "amplitude=0.2|direction=2 1|background=1.3 0.4 0.7", problem_sample},
    {"sound_wave_2d", "amplitude=0.1|direction=0 1|hi=2 3|boost=1 -2", problem_sample},
    {"sound_wave_3d", "amplitude=0.1|direction=1 -2 1|boost=1", problem_sample},
    {"rest_3d", "boost=1 2 3", problem_sample},
    {"sedov_2d", "", problem_sample},
    {"sedov_2d", "gamma=1.4", problem_sample},
    {"sedov_3d", "gamma=3", problem_sample},
    {"noh_2d", "", noh_without_pressure},
    {"noh_2d", "gamma=1.4", noh_without_pressure},
    {"noh_3d", "gamma=3", noh_without_pressure},
    {"rotation", "", problem_sample},
    {"shear", "", problem_sample},
    {"shear", "direction=2 1|boost=1 -0.3|hi=2 1", problem_sample},
};

static void add_flows(struct check_run *run)
{
    for (size_t i = 0; i < sizeof flows / sizeof *flows; i++) check_subject(run, &flows[i], 0);
}

enum { CONSERVED = 5, POINTS = 200 };

/* Densities of the conserved quantities, and their fluxes along an axis. */
static void conserved(const struct problem_state *s, double U[CONSERVED])
{
    U[0] = s->rho;
    U[4] = s->rho * s->u;
    for (int d = 0; d < 3; d++) {
        U[1 + d] = s->rho * s->v[d];
        U[4] += 0.5 * s->rho * s->v[d] * s->v[d];
    }
}

static void fluxes(const struct problem_state *s, int axis, double F[CONSERVED])
{
    conserved(s, F);
    F[4] += s->P;
    for (int k = 0; k < CONSERVED; k++) F[k] *= s->v[axis];
    F[1 + axis] += s->P;
}

/* Derivative of U in time (axis -1) or of F along an axis: fourth-order central differences. */
static void derivative(const struct flow_subject *flow, const struct prepared *p, const double x[3],
                       double t, int axis, double step, double D[CONSERVED])
{
    static const double weights[] = {1. / 12, -2. / 3, 0, 2. / 3, -1. / 12};
    memset(D, 0, CONSERVED * sizeof *D);
    for (int k = -2; k <= 2; k++) {
        double at[3] = {x[0], x[1], x[2]}, values[CONSERVED];
        struct problem_state state;
        if (axis >= 0) at[axis] += k * step;
        flow->sample(p, at, axis < 0 ? t + k * step : t, &state);
        if (axis < 0)
            conserved(&state, values);
        else
            fluxes(&state, axis, values);
        for (int c = 0; c < CONSERVED; c++) D[c] += weights[k + 2] * values[c] / step;
    }
}

/* True if x is near a shock, the edge of a disc or the centre, where derivatives jump or the
 * pressure dominates, or outside all gas. */
static bool near_front(const struct prepared *p, const double x[3], double t)
{
    const double r = problem_radius(p, x), far = 0.02 * domain_length(&p->domain, 0);
    struct problem_state state;
    problem_sample(p, x, t, &state);
    if (!(state.rho > 0)) return true;
    for (const struct functional *const *f = p->problem->functionals; *f; f++)
        if (strcmp((*f)->name, "shock_radius") == 0 || strcmp((*f)->name, "disc_radius") == 0)
            return r < 2 * far || fabs(r - (*f)->exact(p, t)) < far;
    return false;
}

/* Gresho's vortex has kinks at 0.2 and 0.4. */
static bool near_kink(const struct prepared *p, const double x[3], double t)
{
    double R2 = 0;
    for (int d = 0; d < p->domain.dim; d++) {
        const double length = domain_length(&p->domain, d);
        const double away = x[d] - p->boost[d] * t - p->window.centre[d];
        const double nearest = away - length * round(away / length);
        /* periodic images of smooth vortices meet at the edge of the box */
        if (fabs(nearest) > 0.48 * length && p->problem->circular) return true;
        R2 += nearest * nearest;
    }
    const double R = sqrt(R2);
    return fabs(R - 0.2) < 0.02 || fabs(R - 0.4) < 0.02;
}

/* Largest residual of all equations at a point, relative to the sum of the sizes of their terms. */
static double residual(const struct flow_subject *flow, const struct prepared *p, const double x[3],
                       double t)
{
    double sum[CONSERVED], size[CONSERVED], D[CONSERVED], worst = 0;
    struct problem_state state;
    const double length = domain_length(&p->domain, 0), step = 1e-4 * length;
    flow->sample(p, x, t, &state);
    const double c = sqrt(p->gamma * state.P / state.rho);
    const double signal = c + hypot(state.v[0], hypot(state.v[1], state.v[2]));
    const double dt = fmin(step / signal, 1e-3 * t), fastest = step / dt;
    derivative(flow, p, x, t, -1, dt, sum);
    for (int k = 0; k < CONSERVED; k++) size[k] = fabs(sum[k]);
    for (int axis = 0; axis < p->domain.dim; axis++) {
        derivative(flow, p, x, t, axis, step, D);
        for (int k = 0; k < CONSERVED; k++) {
            sum[k] += D[k];
            size[k] += fabs(D[k]);
        }
    }
    /* where the flow is uniform only round-off is left: terms are at least a fraction of c
     * U/length */
    const double current = state.rho * fastest;
    const double floors[CONSERVED] = {state.rho, current, current, current, current * fastest};
    for (int k = 0; k < CONSERVED; k++)
        worst_keep(&worst, fabs(sum[k]) / (size[k] + 1e-2 * fastest * floors[k] / length));
    return worst;
}

static void measure_flow(struct check_run *run, const void *subject)
{
    const struct flow_subject *flow = subject;
    struct case_file file;
    struct prepared p;
    struct error error;
    char text[128], *rest = NULL;
    bool ready = !case_load(&file, flow->case_name, &error);
    snprintf(text, sizeof text, "%s", flow->keys);
    for (char *key = strtok_r(text, "|", &rest); ready && key; key = strtok_r(NULL, "|", &rest))
        ready = !settings_apply(&file.settings, 1, &key, &error);
    ready = ready && !problem_prepare(&p, &file.settings, file.dimension, &error);
    double worst = ready ? 0 : (double)NAN;
    /* multiples of irrational numbers avoid symmetric points */
    static const double steps[3] = {0.7548776662466927, 0.5698402909980532, 0.3819660112501051};
    for (int i = 1; ready && i <= POINTS; i++) {
        double x[3] = {0};
        for (int d = 0; d < file.dimension; d++)
            x[d] = p.domain.lo[d] + fmod(i * steps[d], 1) * domain_length(&p.domain, d);
        const double t =
            0.01 + 0.1 * fmod(i * 0.6180339887498949, 1); /* differences also use earlier times */
        if (!near_kink(&p, x, t) && !near_front(&p, x, t))
            worst_keep(&worst, residual(flow, &p, x, t));
    }
    check_measure(run, worst, 1e-7, 1e-9, "%s %s: dU/dt + div F", flow->case_name, flow->keys);
}

static void gresho_pressure(const struct prepared *p, const double x[3], double t,
                            struct problem_state *state)
{
    problem_sample(p, x, t, state);
    const double R = hypot(x[0] - p->window.centre[0], x[1] - p->window.centre[1]);
    if (R > 0.2 && R < 0.4) state->P += log(R / 0.2) * 1e-3;
    state->u = state->P / ((p->gamma - 1) * state->rho);
}

static void yee_temperature(const struct prepared *p, const double x[3], double t,
                            struct problem_state *state)
{
    problem_sample(p, x, t, state);
    const double R = hypot(x[0] - p->window.centre[0], x[1] - p->window.centre[1]);
    const double T = 1 - (p->gamma - 1) * 25 / (8 * M_PI * M_PI) * exp(1 - R * R);
    state->rho = pow(T, 1 / (p->gamma - 1));
    state->P = state->rho * T;
    state->u = T / (p->gamma - 1);
}

/* Mutant: a boost of the velocity without the displacement that it causes. */
static void not_carried(const struct prepared *p, const double x[3], double t,
                        struct problem_state *state)
{
    struct prepared still = *p;
    memset(still.boost, 0, sizeof still.boost);
    problem_sample(&still, x, t, state);
    for (int d = 0; d < p->domain.dim; d++) state->v[d] += p->boost[d];
}

static void carried_backwards(const struct prepared *p, const double x[3], double t,
                              struct problem_state *state)
{
    problem_sample(p, x, -t, state);
}

static void along_x(const struct prepared *p, const double x[3], double t,
                    struct problem_state *state)
{
    problem_sample(p, x, t, state);
    state->v[0] = hypot(state->v[0], state->v[1]);
    state->v[1] = 0;
}

#define FLOW(name, keys, sample)                                                                   \
    &(struct flow_subject)                                                                         \
    {                                                                                              \
        name, keys, sample                                                                         \
    }
static const struct check_mutant flow_mutants[] = {
    {"gresho_pressure", "4.001 ln(R/0.2) for 4 ln(R/0.2)", FLOW("gresho", "", gresho_pressure)},
    {"yee_temperature", "T without gamma below the line", FLOW("yee", "", yee_temperature)},
    {"flow_not_carried", "a boost that moves nothing", FLOW("yee", "boost=1 1", not_carried)},
    {"flow_carried_backwards", "a boost that moves the flow the other way",
     FLOW("gresho", "boost=1 0.3", carried_backwards)},
    {"wave_along_x", "an oblique wave whose gas moves along x",
     FLOW("sound_wave_2d", "amplitude=0.1|direction=2 1", along_x)},
    {0},
};

CHECK_DEFINE(
    exact, flow, 550,
    .property = "dU/dt + div F = 0 at 200 places of the flows in 2D and 3D, at rest and boosted",
    .subjects = add_flows, .measure = measure_flow, .mutants = flow_mutants);

/* ---- Kelvin & Helmholtz's mode ---- */

typedef double amplitude(unsigned long n, const double *x, const double *y, const double *vy,
                         const double *w);
struct mode_subject {
    amplitude *amplitude;
};

enum { SIDE = 400 };

/* The amplitude of v_y = 0.01 sin(4 pi x + phase) F(y) on a grid; F = 1 (flat), or the weight of
 * the lower layer alone. */
static double amplitude_of(const struct mode_subject *mode, bool flat, double phase)
{
    enum { N = SIDE * SIDE };
    double *x = malloc(4 * (size_t)N * sizeof *x);
    if (!x) return NAN;
    double *y = x + N, *vy = y + N, *w = vy + N;
    for (int i = 0; i < N; i++) {
        const int row = i / SIDE;
        x[i] = (i % SIDE + 0.5) / SIDE;
        y[i] = (row + 0.5) / SIDE;
        w[i] = 1 + 0.5 * (i % 2); /* unequal volumes, evenly distributed over the wave */
        const double weight = y[i] < 0.5 ? exp(-4 * M_PI * fabs(y[i] - 0.25)) : 0;
        vy[i] = 0.01 * sin(4 * M_PI * x[i] + phase) * (flat ? 1 : weight);
    }
    const double M = mode->amplitude(N, x, y, vy, w);
    free(x);
    return M;
}

static void measure_mode(struct check_run *run, const void *subject)
{
    static const struct mode_subject right = {kelvin_helmholtz_amplitude};
    const struct mode_subject *mode = subject ? subject : &right;
    const double lower = 0.01 * (1 - exp(-2 * M_PI)) / (4 * (1 - exp(-M_PI)));
    double jump = 0;
    for (int k = 1; k < 4; k++) {
        const struct kelvin_helmholtz_state a = kelvin_helmholtz_start(0.1, 0.25 * k - 1e-12),
                                            b = kelvin_helmholtz_start(0.1, 0.25 * k + 1e-12);
        worst_keep(&jump, fabs(a.rho - b.rho) + fabs(a.v[0] - b.v[0]));
    }
    check_measure(run, fabs(amplitude_of(mode, true, 0.7) / 0.01 - 1), 1e-3, 1e-4,
                  "M of a field as in the start is 0.01");
    check_measure(run, fabs(amplitude_of(mode, false, 1.9) / lower - 1), 1e-3, 1e-4,
                  "M of a mode in one layer alone");
    check_measure(run, jump, 5e-3, 2e-4, "the layers join at y = 1/4, 1/2, 3/4");
    check_measure(run, fabs(kelvin_helmholtz_reference(0) / 0.01 - 1), 1e-12, 1e-15,
                  "the reference starts at 0.01");
    check_measure(run, isnan(kelvin_helmholtz_reference(1.6)) ? 0 : 1, 0, 0,
                  "the reference ends at 1.5");
}

static double without_two(unsigned long n, const double *x, const double *y, const double *vy,
                          const double *w)
{
    return 0.5 * kelvin_helmholtz_amplitude(n, x, y, vy, w);
}

static double sine_alone(unsigned long n, const double *x, const double *y, const double *vy,
                         const double *w)
{
    double sine = 0, weight = 0;
    for (unsigned long i = 0; i < n; i++) {
        const double E = w[i] * exp(-4 * M_PI * fabs(y[i] - (y[i] < 0.5 ? 0.25 : 0.75)));
        sine += vy[i] * sin(4 * M_PI * x[i]) * E;
        weight += E;
    }
    return 2 * fabs(sine) / weight;
}

static double unweighted(unsigned long n, const double *x, const double *y, const double *vy,
                         const double *w)
{
    double sine = 0, cosine = 0, weight = 0;
    for (unsigned long i = 0; i < n; i++) {
        sine += w[i] * vy[i] * sin(4 * M_PI * x[i]);
        cosine += w[i] * vy[i] * cos(4 * M_PI * x[i]);
        weight += w[i];
    }
    (void)y;
    return 2 * hypot(sine, cosine) / weight;
}

#define MODE(function)                                                                             \
    &(struct mode_subject)                                                                         \
    {                                                                                              \
        function                                                                                   \
    }
static const struct check_mutant mode_mutants[] = {
    {"mode_without_two", "M without the factor 2", MODE(without_two)},
    {"mode_sine_alone", "M of the sine alone", MODE(sine_alone)},
    {"mode_unweighted", "M of the whole box, without the weight E", MODE(unweighted)},
    {0},
};

CHECK_DEFINE(exact, kelvin_helmholtz, 550,
             .property = "amplitude of known modes; start and table of McNally, Lyra & Passy",
             .measure = measure_mode, .mutants = mode_mutants);
