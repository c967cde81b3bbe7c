/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exact.h"

#include <math.h>

#include "norm.h"

static enum status solve(struct riemann_solution *solution, double gamma, const double *left,
                         const double *right, struct error *error)
{
    const struct riemann_state l = {left[0], left[1], left[2]}, r = {right[0], right[1], right[2]};
    const char *fault = riemann_solve(gamma, &l, &r, solution);
    return fault ? error_set(error, STATUS_BAD_INPUT, "no exact solution: %s", fault) : STATUS_OK;
}

enum status exact_prepare(struct exact *exact, const struct settings *settings, struct error *error)
{
    const double gamma = settings_real(settings, SETTING_gamma);
    const double *left = settings->value[SETTING_left].real;
    const double *right = settings->value[SETTING_right].real;
    *exact = (struct exact){.kind = (enum kind)settings_choice(settings, SETTING_kind),
                            .lo = settings_real(settings, SETTING_lo),
                            .hi = settings_real(settings, SETTING_hi)};
    exact->x0 = 0.5 * (exact->lo + exact->hi);
    if (exact->kind == KIND_RIEMANN) {
        if (solve(&exact->tube, gamma, left, right, error)) return error->status;
        return solve(&exact->mirror, gamma, right, left, error);
    }
    const double *gas = settings->value[SETTING_background].real;
    exact->wave = (struct simple_wave){.gamma = gamma,
                                       .rho0 = gas[0],
                                       .v0 = gas[1],
                                       .P0 = gas[2],
                                       .amplitude = settings_real(settings, SETTING_amplitude),
                                       .length = (exact->hi - exact->lo) /
                                                 settings_real(settings, SETTING_waves)};
    const char *fault = simple_wave_fault(&exact->wave);
    return fault ? error_set(error, STATUS_BAD_INPUT, "no exact solution: %s", fault) : STATUS_OK;
}

void exact_sample(const struct exact *exact, double x, double t, double values[FIELDS])
{
    if (exact->kind == KIND_SOUND_WAVE) {
        const struct simple_wave_state s = simple_wave_sample(&exact->wave, x - exact->lo, t);
        values[FIELD_DENSITY] = s.rho;
        values[FIELD_VELOCITY] = s.v;
        values[FIELD_PRESSURE] = s.P;
        values[FIELD_INTERNAL_ENERGY] = s.u;
        return;
    }
    const struct riemann_state s = riemann_sample(&exact->tube, x, exact->x0, t);
    values[FIELD_DENSITY] = s.rho;
    values[FIELD_VELOCITY] = s.rho > 0 ? s.v : (x - exact->x0) / t;
    values[FIELD_PRESSURE] = s.P;
    values[FIELD_INTERNAL_ENERGY] = s.rho > 0 ? s.P / ((exact->tube.gamma - 1) * s.rho) : 0;
}

/* The greatest of v + mach c over a solution's constant states: no signal that is mach times as
 * fast as sound where it enters overtakes this inside. */
static double fastest(const struct riemann_solution *s, double mach, double sign)
{
    const struct riemann_state states[] = {s->left,
                                           s->right,
                                           {s->rho_star_left, s->v_star, s->p_star},
                                           {s->rho_star_right, s->v_star, s->p_star}};
    double speed = 0;
    for (size_t i = 0; i < (s->vacuum ? 2 : 4); i++) {
        const double c = sqrt(s->gamma * states[i].P / states[i].rho);
        speed = fmax(speed, sign * states[i].v + mach * c);
    }
    /* an edge of vacuum runs ahead of all */
    if (s->vacuum) speed = fmax(speed, sign > 0 ? s->right_tail : -s->left_tail);
    return speed;
}

/* How far the mirrored tube's front has come at t, from the box's end towards the middle; gas: the
 * state it runs into; sign: its direction. The bound is sharp until the front meets the waves of
 * the main tube and safe from there on. */
static double front(const struct exact *exact, double sign, double t)
{
    const struct riemann_solution *tube = &exact->tube, *mirror = &exact->mirror;
    const struct riemann_state *gas = sign > 0 ? &tube->left : &tube->right;
    const double length = exact->x0 - exact->lo;
    const double c = sqrt(tube->gamma * gas->P / gas->rho);
    const double head = sign > 0 ? mirror->right_head : -mirror->left_head;
    const double ahead = sign > 0 ? -tube->left_head : tube->right_head;
    const double speed = isnan(head) ? sign * gas->v + c : head;
    const double other = isnan(ahead) ? c - sign * gas->v : ahead;
    const double meet = speed + other > 0 ? length / (speed + other) : (double)INFINITY;
    if (t <= meet) return speed * t;
    const double mach = fmax(1, (speed - sign * gas->v) / c);
    return speed * meet + fmax(speed, fastest(tube, mach, sign)) * (t - meet);
}

static bool window_is_free(const struct exact *exact, const double window[2], double t)
{
    if (exact->kind == KIND_SOUND_WAVE) return t < simple_wave_breaking_time(&exact->wave);
    return exact->lo + front(exact, 1, t) <= window[0] &&
           exact->hi - front(exact, -1, t) >= window[1];
}

enum status exact_check_window(const struct exact *exact, const double window[2], double t,
                               struct error *error)
{
    if (window_is_free(exact, window, t)) return STATUS_OK;
    double free = 0, reached = t;
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (free + reached);
        *(window_is_free(exact, window, middle) ? &free : &reached) = middle;
    }
    free *= 1 - 1e-3; /* as printed it shall still be allowed */
    if (exact->kind == KIND_SOUND_WAVE)
        return error_set(error, STATUS_BAD_INPUT,
                         "t_end=%g: the wave breaks at %.6g and has no exact solution from there "
                         "on; allowed: t_end below that",
                         t, free);
    return error_set(error, STATUS_BAD_INPUT,
                     "t_end=%g: by then the mirrored tube at the ends of the periodic box has "
                     "reached x = %.4g and %.4g, inside the window [%g, %g]; allowed: t_end <= "
                     "%.4g, or a narrower window",
                     t, exact->lo + front(exact, 1, t), exact->hi - front(exact, -1, t), window[0],
                     window[1], free);
}

struct field_at {
    const struct exact *exact;
    double time;
    enum field field;
};

static double field_value(const void *context, double x)
{
    const struct field_at *at = context;
    double values[FIELDS];
    exact_sample(at->exact, x, at->time, values);
    return values[at->field];
}

void exact_means(const struct exact *exact, enum field field, double t, const double window[2],
                 size_t bins, double *means)
{
    const struct field_at at = {exact, t, field};
    norm_bin_means(field_value, &at, window, bins, means);
}
