/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks of the exact solutions at positions and times: they must satisfy the conservation laws
 * over rectangles of x and t, including shocks, contacts and vacuum, and the equations where they
 * are smooth. */
#include <math.h>
#include <string.h>

#include "balance.h"
#include "check.h"
#include "riemann_property.h"
#include "simple_wave.h"
#include "worst.h"

/* ---- Riemann problems, off the origin ---- */

static const double x0 = 0.37;

static const struct tube {
    const char *name;
    struct riemann_problem problem;
} tubes[] = {
    {"Sod", {1.4, {1, 0, 1}, {0.125, 0, 0.1}}},
    {"Sod moving", {5. / 3, {1, 0.75, 1}, {0.125, 0.25, 0.1}}},
    {"123", {1.4, {1, -2, 0.4}, {1, 2, 0.4}}},
    {"strong", {1.4, {1, 0, 1000}, {1, 0, 0.01}}},
    {"collision", {1.4, {5.99924, 19.5975, 460.894}, {5.99242, -6.19633, 46.095}}},
    {"Lax mirrored", {1.4, {0.5, 0, 0.571}, {0.445, -0.698, 3.528}}},
    {"vacuum in the middle", {1.4, {1, -5, 0.4}, {0.5, 5, 0.9}}},
    {"vacuum on the right", {5. / 3, {1, 0, 1}, {0, 0, 0}}},
    {"vacuum on the left", {2, {0, 0, 0}, {1, -0.5, 1}}},
    {"heavy against light", {4. / 3, {1e3, 0.1, 1}, {1e-3, 0, 0.5}}},
};
enum { TUBES = sizeof tubes / sizeof *tubes };

struct tube_flow {
    const struct riemann_subject *solver;
    struct riemann_solution solution;
};

static struct riemann_state tube_at(const void *context, double x, double t)
{
    const struct tube_flow *tube = context;
    return tube->solver->sample(&tube->solution, x, x0, t);
}

/* Solves the problem and returns the time until which the fastest wave has crossed a length of 0.8
 * (NaN: no solution). speeds: wave speeds of the right solution, because a wrong one may report
 * wrong ones. */
static double tube_prepare(struct tube_flow *flow, const struct riemann_problem *p,
                           double speeds[5])
{
    struct riemann_solution right;
    double fastest = 0;
    if (flow->solver->solve(p->gamma, &p->left, &p->right, &flow->solution) ||
        riemann_solve(p->gamma, &p->left, &p->right, &right))
        return (double)NAN;
    const double all[5] = {right.left_head, right.left_tail, right.contact, right.right_tail,
                           right.right_head};
    memcpy(speeds, all, sizeof all);
    for (int i = 0; i < 5; i++) fastest = fmax(fastest, fabs(all[i]));
    return 0.8 / fastest;
}

static void measure_balance(struct check_run *run, const void *subject)
{
    /* all waves inside; across the waves; on either side of the diaphragm */
    static const double windows[][2] = {{-1, 1}, {-0.3, 0.25}, {0.05, 0.6}, {-0.5, -0.1}};
    for (size_t i = 0; i < TUBES; i++) {
        struct tube_flow flow = {.solver = subject ? subject : &riemann_reference};
        double speeds[5], worst = 0;
        const double end = tube_prepare(&flow, &tubes[i].problem, speeds);
        const struct flow gas = {tube_at, &flow, tubes[i].problem.gamma};
        const struct flow_paths paths = {x0, speeds, 5};
        worst_keep(&worst, end);
        for (size_t w = 0; isfinite(end) && w < sizeof windows / sizeof *windows; w++) {
            const double x[] = {x0 + windows[w][0], x0 + windows[w][1]};
            const double from_start[] = {0, end}, later[] = {0.3 * end, end};
            if (w == 0) worst = 0;
            worst_keep(&worst, balance_defect(&gas, x, from_start, &paths));
            worst_keep(&worst, balance_defect(&gas, x, later, &paths));
        }
        check_measure(run, worst, 2e-14, 1e-15, "%s: mass, momentum, energy in four windows",
                      tubes[i].name);
    }
}

static const struct check_mutant balance_mutants[] = {
    RIEMANN_MUTANT(fan_about_origin, "fan sampled at x/t instead of (x - x0)/t"),
    RIEMANN_MUTANT(fan_density, "exponent 2/(gamma+1) for 2/(gamma-1) of the density in a fan"),
    RIEMANN_MUTANT(fan_velocity, "the term (gamma-1)/2 v of the velocity in a fan left out"),
    RIEMANN_MUTANT(fan_linear, "density on a straight line between head and tail of a fan"),
    RIEMANN_MUTANT(fan_as_shock, "no fan: the star state begins at the head"),
    RIEMANN_MUTANT(no_contact, "left star density on both sides of the contact"),
    RIEMANN_MUTANT(late, "samples at 1.01 t"),
    RIEMANN_MUTANT(star_at_start, "at t = 0 the star state instead of the initial ones"),
    RIEMANN_MUTANT(swapped_velocity, "contact velocity with the two jumps of velocity exchanged"),
    {0},
};

CHECK_DEFINE(
    exact, riemann_balance, 550,
    .property = "integral of U over x changes by the integral of F over t, across all waves",
    .measure = measure_balance, .mutants = balance_mutants);

static void measure_fans(struct check_run *run, const void *subject)
{
    const struct riemann_subject *solver = subject ? subject : &riemann_reference;
    for (size_t i = 0; i < TUBES; i++) {
        struct tube_flow flow = {.solver = solver};
        double speeds[5], residual = 0;
        const double end = tube_prepare(&flow, &tubes[i].problem, speeds);
        const struct flow gas = {tube_at, &flow, tubes[i].problem.gamma};
        bool fan = false;
        for (int head = 0; head < 5; head += 3) { /* left head and tail, right tail and head */
            const double range = speeds[head + 1] - speeds[head];
            if (!(range > 0)) continue;
            fan = true;
            const double x = x0 + (speeds[head] + 0.45 * range) * end;
            const double dx = 0.01 * range * end;
            worst_keep(&residual, balance_residual(&gas, x, end, dx, 0.002 * end));
        }
        if (!fan) {
            check_skip(run, "%s: no fan", tubes[i].name);
            continue;
        }
        check_measure(run, riemann_fan_defect(solver, &flow.solution, x0, end), 1e-14, 1e-15,
                      "%s: v -+ c = (x - x0)/t, v +- 2c/(gamma-1), P/rho^gamma", tubes[i].name);
        check_measure(run, residual, 1e-8, 1e-10, "%s: dU/dt + dF/dx by differences",
                      tubes[i].name);
    }
}

static const struct check_mutant fans_mutants[] = {
    RIEMANN_MUTANT(fan_about_origin, "fan sampled at x/t instead of (x - x0)/t"),
    RIEMANN_MUTANT(fan_density, "exponent 2/(gamma+1) for 2/(gamma-1) of the density in a fan"),
    RIEMANN_MUTANT(fan_velocity, "the term (gamma-1)/2 v of the velocity in a fan left out"),
    RIEMANN_MUTANT(fan_linear, "density on a straight line between head and tail of a fan"),
    RIEMANN_MUTANT(late, "samples at 1.01 t"),
    {0},
};

CHECK_DEFINE(
    exact, riemann_fans, 550,
    .property = "inside a fan: characteristics, Riemann invariant, isentrope, dU/dt + dF/dx = 0",
    .measure = measure_fans, .mutants = fans_mutants);

/* ---- simple wave ---- */

struct wave_subject {
    struct simple_wave_state (*sample)(const struct simple_wave *wave, double x, double t);
    double (*breaking_time)(const struct simple_wave *wave);
};

struct wave_flow {
    const struct wave_subject *subject;
    const struct simple_wave *wave;
};

static struct riemann_state wave_at(const void *context, double x, double t)
{
    const struct wave_flow *flow = context;
    const struct simple_wave_state s = flow->subject->sample(flow->wave, x, t);
    return (struct riemann_state){s.rho, s.v, s.P};
}

/* Time at which neighbouring characteristics first cross, from their speeds at t = 0 on a fine
 * grid. */
static double first_crossing(const struct wave_subject *subject, const struct simple_wave *wave)
{
    enum { GRID = 4000 };
    double steepest = 0, last = 0;
    for (int i = 0; i <= GRID; i++) {
        const struct simple_wave_state s = subject->sample(wave, wave->length * i / GRID, 0);
        const double speed = s.v + sqrt(wave->gamma * s.P / s.rho);
        if (i) steepest = fmax(steepest, (last - speed) * GRID / wave->length);
        last = speed;
    }
    return 1 / steepest;
}

static void measure_wave(struct check_run *run, const void *subject)
{
    static const struct wave_subject right = {simple_wave_sample, simple_wave_breaking_time};
    static const struct simple_wave waves[] = {
        {1.4, 1, 0, 1 / 1.4, 1e-3, 1},
        {1.4, 1, 0, 1 / 1.4, 0.05, 2},
        {5. / 3, 2.385, -0.3, 0.7, 0.3, 1.7},
        {3, 0.5, 1.1, 2, -0.6, 0.9},
        {1.1, 1, 5, 1, 0.2, 1},
    };
    for (size_t i = 0; i < sizeof waves / sizeof *waves; i++) {
        const struct simple_wave *wave = &waves[i];
        const struct wave_flow context = {subject ? subject : &right, wave};
        const struct flow flow = {wave_at, &context, wave->gamma};
        const double breaks = simple_wave_breaking_time(wave), end = 0.4 * breaks;
        const double L = wave->length, c0 = sqrt(wave->gamma * wave->P0 / wave->rho0);
        const double t[] = {0.1 * end, end}, x[] = {0.13 * L, 0.71 * L};
        double start = 0, residual = 0, balance = 0;
        for (int k = 0; k < 8; k++) {
            const struct riemann_state s = wave_at(&context, k * L / 8, 0);
            const double rho = wave->rho0 * (1 + wave->amplitude * sin(k * M_PI / 4));
            worst_keep(&start, fabs(s.rho / rho - 1));
            worst_keep(&start, fabs(s.P / (wave->P0 * pow(rho / wave->rho0, wave->gamma)) - 1));
        }
        /* time slices that are short compared with a wave's passage */
        for (int slice = 0; slice < 4; slice++) {
            const double passage = fmin(L / (fabs(wave->v0) + c0), end - t[0]);
            const double from = t[0] + (end - t[0] - passage) * slice / 3;
            worst_keep(&balance, balance_defect(&flow, x, (double[]){from, from + passage},
                                                &(struct flow_paths){0}));
            worst_keep(&residual, balance_residual(&flow, (0.11 + 0.23 * slice) * L, from + passage,
                                                   1e-2 * L, 1e-2 * L / (fabs(wave->v0) + c0)));
        }
        check_measure(run, start, 1e-14, 1e-15, "amplitude %g, gamma %.4g: as prescribed at t = 0",
                      wave->amplitude, wave->gamma);
        check_measure(run, balance, 2e-14, 1e-15, "amplitude %g, gamma %.4g: conservation laws",
                      wave->amplitude, wave->gamma);
        check_measure(run, residual, 1e-7, 1e-9, "amplitude %g, gamma %.4g: dU/dt + dF/dx",
                      wave->amplitude, wave->gamma);
        check_measure(
            run,
            fabs(context.subject->breaking_time(wave) / first_crossing(context.subject, wave) - 1),
            1e-5, 1e-6, "amplitude %g, gamma %.4g: breaks when characteristics cross",
            wave->amplitude, wave->gamma);
    }
}

static struct simple_wave_state wave_rigid(const struct simple_wave *wave, double x, double t)
{
    const double c0 = sqrt(wave->gamma * wave->P0 / wave->rho0);
    return simple_wave_sample(wave, x - (wave->v0 + c0) * t, 0);
}

/* State of a wave whose values travel with the speed a v + b c. */
static struct simple_wave_state carried(const struct simple_wave *wave, double x, double t,
                                        double a, double b)
{
    const double reach = 9 * (fabs(wave->v0) + sqrt(wave->gamma * wave->P0 / wave->rho0)) * t;
    double low = x - reach, high = x + reach;
    struct simple_wave_state s = {0};
    for (int i = 0; i < 60; i++) {
        const double start = (low + high) / 2;
        s = simple_wave_sample(wave, start, 0);
        const double now = start + (a * s.v + b * sqrt(wave->gamma * s.P / s.rho)) * t;
        *(now > x ? &high : &low) = start;
    }
    return s;
}

static struct simple_wave_state wave_without_flow(const struct simple_wave *wave, double x,
                                                  double t)
{
    return carried(wave, x, t, 0, 1);
}

static struct simple_wave_state wave_leftward(const struct simple_wave *wave, double x, double t)
{
    return carried(wave, x, t, 1, -1);
}

static struct simple_wave_state wave_isothermal(const struct simple_wave *wave, double x, double t)
{
    struct simple_wave_state s = simple_wave_sample(wave, x, t);
    s.P = wave->P0 * s.rho / wave->rho0;
    return s;
}

static struct simple_wave_state wave_velocity(const struct simple_wave *wave, double x, double t)
{
    struct simple_wave_state s = simple_wave_sample(wave, x, t);
    s.v = wave->v0 + (s.v - wave->v0) * (wave->gamma - 1) / (wave->gamma + 1);
    return s;
}

static double breaks_late(const struct simple_wave *wave)
{
    return simple_wave_breaking_time(wave) * (wave->gamma + 1) / 2;
}

static double breaks_as_small(const struct simple_wave *wave)
{
    const double c0 = sqrt(wave->gamma * wave->P0 / wave->rho0);
    return wave->length / (M_PI * (wave->gamma + 1) * c0 * fabs(wave->amplitude));
}

#define WAVE(sample)                                                                               \
    &(struct wave_subject)                                                                         \
    {                                                                                              \
        sample, simple_wave_breaking_time                                                          \
    }
#define BREAKING(time)                                                                             \
    &(struct wave_subject)                                                                         \
    {                                                                                              \
        simple_wave_sample, time                                                                   \
    }
static const struct check_mutant wave_mutants[] = {
    {"wave_rigid", "the wave does not steepen: every value travels with v0 + c0", WAVE(wave_rigid)},
    {"wave_without_flow", "values travel with c instead of v + c", WAVE(wave_without_flow)},
    {"wave_leftward", "values travel with v - c", WAVE(wave_leftward)},
    {"wave_isothermal", "pressure proportional to density", WAVE(wave_isothermal)},
    {"wave_velocity", "v = 2 (c - c0)/(gamma + 1)", WAVE(wave_velocity)},
    {"wave_breaks_late", "breaking time without the factor (gamma + 1)/2", BREAKING(breaks_late)},
    {"wave_breaks_as_small", "breaking time of an infinitesimal wave", BREAKING(breaks_as_small)},
    {0},
};

CHECK_DEFINE(exact, simple_wave, 550, .cost = 1,
             .property = "initial state, conservation laws, dU/dt + dF/dx = 0, time of breaking",
             .measure = measure_wave, .mutants = wave_mutants);
