/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "riemann_property.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* ---- wrong solvers ---- */

#define SOLVE(name)                                                                                \
    static const char *name(double gamma, const struct riemann_state *left,                        \
                            const struct riemann_state *right, struct riemann_solution *s)

/* The textbook's jump of velocity and its slope (Toro eqs 4.6, 4.7, 4.37). */
static double jump(double gamma, const struct riemann_state *k, double p, bool shock, double *slope)
{
    const double c = sqrt(gamma * k->P / k->rho), z = (gamma - 1) / (2 * gamma);
    if (shock) {
        const double A = 2 / ((gamma + 1) * k->rho), B = (gamma - 1) / (gamma + 1) * k->P;
        *slope = sqrt(A / (B + p)) * (1 - (p - k->P) / (2 * (B + p)));
        return (p - k->P) * sqrt(A / (p + B));
    }
    *slope = pow(p / k->P, -(gamma + 1) / (2 * gamma)) / (k->rho * c);
    return 2 * c / (gamma - 1) * (pow(p / k->P, z) - 1);
}

/* Completes a solution from its star pressure (Toro section 4.5). */
static void complete(struct riemann_solution *s, double p, bool only_shocks)
{
    const double gamma = s->gamma, g = (gamma - 1) / (gamma + 1);
    double jumps[2], head[2], tail[2], rho[2], slope;
    enum riemann_wave wave[2];
    for (int i = 0; i < 2; i++) {
        const struct riemann_state *k = i ? &s->right : &s->left;
        const double c = sqrt(gamma * k->P / k->rho), r = p / k->P, sign = i ? 1 : -1;
        wave[i] = only_shocks || p > k->P ? RIEMANN_SHOCK : RIEMANN_RAREFACTION;
        jumps[i] = jump(gamma, k, p, wave[i] == RIEMANN_SHOCK, &slope);
        rho[i] = k->rho * (wave[i] == RIEMANN_SHOCK ? (r + g) / (g * r + 1) : pow(r, 1 / gamma));
        head[i] = k->v + sign * (wave[i] == RIEMANN_SHOCK ? c * sqrt((r + g) / (1 + g)) : c);
        tail[i] = wave[i] == RIEMANN_SHOCK
                      ? head[i]
                      : k->v + sign * (jumps[i] + c * pow(r, (gamma - 1) / (2 * gamma)));
    }
    s->p_star = p;
    s->v_star = s->contact = (s->left.v + s->right.v) / 2 + (jumps[1] - jumps[0]) / 2;
    s->rho_star_left = rho[0], s->rho_star_right = rho[1];
    s->left_wave = wave[0], s->right_wave = wave[1];
    s->left_head = head[0], s->left_tail = tail[0];
    s->right_head = head[1], s->right_tail = tail[1];
}

/* The seed program's loop: no guard, and a measure of convergence that can be negative. */
SOLVE(negative_pressure)
{
    const char *why = riemann_solve(gamma, left, right, s);
    if (why || s->vacuum) return why;
    double p = (left->P + right->P) / 2, change = 1;
    for (int i = 0; i < 100 && change > 1e-14; i++) {
        double a, b;
        const double f = jump(gamma, left, p, p > left->P, &a) +
                         jump(gamma, right, p, p > right->P, &b) + right->v - left->v;
        const double next = p - f / (a + b);
        change = 2 * fabs(next - p) / (next + p);
        p = next;
    }
    complete(s, p, false);
    return NULL;
}

SOLVE(loose_root)
{
    const char *why = riemann_solve(gamma, left, right, s);
    if (!why && !s->vacuum) complete(s, s->p_star * (1 + 1e-6), false);
    return why;
}

SOLVE(swapped_velocity)
{
    const char *why = riemann_solve(gamma, left, right, s);
    if (why || s->vacuum) return why;
    s->v_star = s->contact = left->v + right->v - s->v_star;
    return NULL;
}

SOLVE(two_shocks)
{
    const char *why = riemann_solve(gamma, left, right, s);
    if (why || s->vacuum) return why;
    double low = log(s->p_star) - 20, high = log(s->p_star) + 20, slope;
    for (int i = 0; i < 60; i++) {
        const double y = (low + high) / 2;
        const double f = jump(gamma, left, exp(y), true, &slope) +
                         jump(gamma, right, exp(y), true, &slope) + right->v - left->v;
        *(f > 0 ? &high : &low) = y;
    }
    complete(s, exp(low), true);
    return NULL;
}

SOLVE(gamma_fixed)
{
    const char *why = riemann_solve(1.4, left, right, s);
    if (!why) s->gamma = gamma;
    return why;
}

SOLVE(isentropic_shock)
{
    const char *why = riemann_solve(gamma, left, right, s);
    if (why) return why;
    if (s->left_wave == RIEMANN_SHOCK)
        s->rho_star_left = left->rho * pow(s->p_star / left->P, 1 / gamma);
    if (s->right_wave == RIEMANN_SHOCK)
        s->rho_star_right = right->rho * pow(s->p_star / right->P, 1 / gamma);
    return NULL;
}

SOLVE(shock_speed)
{
    const char *why = riemann_solve(gamma, left, right, s);
    if (why) return why;
    const double a = (gamma - 1) / (2 * gamma), b = (gamma + 1) / (2 * gamma);
    if (s->left_wave == RIEMANN_SHOCK)
        s->left_head = s->left_tail =
            left->v - sqrt(gamma * left->P / left->rho) * sqrt(a * s->p_star / left->P + b);
    if (s->right_wave == RIEMANN_SHOCK)
        s->right_head = s->right_tail =
            right->v + sqrt(gamma * right->P / right->rho) * sqrt(a * s->p_star / right->P + b);
    return NULL;
}

SOLVE(isentrope_exponent)
{
    const char *why = riemann_solve(gamma, left, right, s);
    if (why || s->vacuum) return why;
    const double exponent = (gamma - 1) / gamma;
    if (s->left_wave == RIEMANN_RAREFACTION)
        s->rho_star_left = left->rho * pow(s->p_star / left->P, exponent);
    if (s->right_wave == RIEMANN_RAREFACTION)
        s->rho_star_right = right->rho * pow(s->p_star / right->P, exponent);
    return NULL;
}

SOLVE(tail_speed)
{
    const char *why = riemann_solve(gamma, left, right, s);
    if (why || s->vacuum) return why;
    if (s->left_wave == RIEMANN_RAREFACTION)
        s->left_tail = s->v_star - sqrt(gamma * left->P / left->rho);
    if (s->right_wave == RIEMANN_RAREFACTION)
        s->right_tail = s->v_star + sqrt(gamma * right->P / right->rho);
    return NULL;
}

/* Mutant: the plain formula applied to gases that separate fast enough to leave a vacuum. */
static void fill_vacuum(struct riemann_solution *s)
{
    if (!s->vacuum || !(s->left.rho > 0 && s->right.rho > 0)) return;
    const double gamma = s->gamma, z = (gamma - 1) / (2 * gamma);
    const double cl = sqrt(gamma * s->left.P / s->left.rho);
    const double cr = sqrt(gamma * s->right.P / s->right.rho);
    const double ratio = (cl + cr - (gamma - 1) / 2 * (s->right.v - s->left.v)) /
                         (cl / pow(s->left.P, z) + cr / pow(s->right.P, z));
    s->vacuum = false;
    complete(s, pow(fabs(ratio), 1 / z), false);
}

SOLVE(no_vacuum)
{
    const char *why = riemann_solve(gamma, left, right, s);
    if (!why) fill_vacuum(s);
    return why;
}

SOLVE(vacuum_limit)
{
    const char *why = riemann_solve(gamma, left, right, s);
    if (why || !(left->rho > 0 && right->rho > 0)) return why;
    const double c = sqrt(gamma * left->P / left->rho) + sqrt(gamma * right->P / right->rho);
    if (right->v - left->v < 4 * c / (gamma - 1)) fill_vacuum(s);
    return NULL;
}

SOLVE(vacuum_edge)
{
    const char *why = riemann_solve(gamma, left, right, s);
    if (why || !s->vacuum) return why;
    if (s->left_wave == RIEMANN_RAREFACTION)
        s->left_tail = left->v + sqrt(gamma * left->P / left->rho);
    if (s->right_wave == RIEMANN_RAREFACTION)
        s->right_tail = right->v - sqrt(gamma * right->P / right->rho);
    return NULL;
}

SOLVE(left_at_rest)
{
    const struct riemann_state still = {left->rho, 0, left->P};
    const char *why = riemann_solve(gamma, &still, right, s);
    if (!why) s->left = *left;
    return why;
}

SOLVE(right_not_mirrored)
{
    const char *why = riemann_solve(gamma, left, right, s);
    if (why) return why;
    s->right_head = 2 * right->v - s->right_head;
    s->right_tail = 2 * right->v - s->right_tail;
    return NULL;
}

/* ---- wrong samplers ---- */

#define SAMPLE(name)                                                                               \
    static struct riemann_state name(const struct riemann_solution *s, double x, double x0,        \
                                     double t)

/* The fan that contains (x - x0)/t; the right one is mirrored. */
struct fan {
    const struct riemann_state *gas;
    double sign, xi, v, c, head, tail;
};

static bool find_fan(const struct riemann_solution *s, double x, double x0, double t,
                     struct fan *fan)
{
    for (int right = 0; right < 2; right++) {
        const double sign = right ? -1 : 1, xi = sign * (x - x0) / t;
        const struct riemann_state *gas = right ? &s->right : &s->left;
        *fan = (struct fan){gas,
                            sign,
                            xi,
                            sign * gas->v,
                            sqrt(s->gamma * gas->P / gas->rho),
                            sign * (right ? s->right_head : s->left_head),
                            sign * (right ? s->right_tail : s->left_tail)};
        if (t > 0 && fan->xi > fan->head && fan->xi < fan->tail) return true;
    }
    return false;
}

/* c/c_K at xi (Toro eq. 4.56), with its velocity term or without. */
static double sound_ratio(double gamma, const struct fan *fan, double xi)
{
    return 2 / (gamma + 1) + (gamma - 1) / (gamma + 1) * (fan->v - xi) / fan->c;
}

SAMPLE(fan_about_origin)
{
    struct fan fan;
    struct riemann_state state = riemann_sample(s, x, x0, t);
    if (!find_fan(s, x, x0, t, &fan)) return state;
    const double gamma = s->gamma, xi = fan.sign * x / t, ratio = sound_ratio(gamma, &fan, xi);
    state.rho = fan.gas->rho * pow(ratio, 2 / (gamma - 1));
    state.v = fan.sign * 2 / (gamma + 1) * (fan.c + (gamma - 1) / 2 * fan.v + xi);
    state.P = fan.gas->P * pow(ratio, 2 * gamma / (gamma - 1));
    return state;
}

SAMPLE(fan_density)
{
    struct fan fan;
    struct riemann_state state = riemann_sample(s, x, x0, t);
    if (find_fan(s, x, x0, t, &fan))
        state.rho = fan.gas->rho * pow(sound_ratio(s->gamma, &fan, fan.xi), 2 / (s->gamma + 1));
    return state;
}

SAMPLE(fan_velocity)
{
    struct fan fan;
    struct riemann_state state = riemann_sample(s, x, x0, t);
    if (find_fan(s, x, x0, t, &fan)) state.v = fan.sign * 2 / (s->gamma + 1) * (fan.c + fan.xi);
    return state;
}

SAMPLE(fan_linear)
{
    struct fan fan;
    struct riemann_state state = riemann_sample(s, x, x0, t);
    if (!find_fan(s, x, x0, t, &fan)) return state;
    const double part = (fan.xi - fan.head) / (fan.tail - fan.head);
    state.rho = fan.gas->rho +
                part * ((fan.sign > 0 ? s->rho_star_left : s->rho_star_right) - fan.gas->rho);
    return state;
}

SAMPLE(fan_as_shock)
{
    struct fan fan;
    if (!find_fan(s, x, x0, t, &fan) || s->vacuum) return riemann_sample(s, x, x0, t);
    return (struct riemann_state){fan.sign > 0 ? s->rho_star_left : s->rho_star_right, s->v_star,
                                  s->p_star};
}

SAMPLE(no_contact)
{
    struct riemann_state state = riemann_sample(s, x, x0, t);
    if (t > 0 && state.rho == s->rho_star_right && state.P == s->p_star)
        state.rho = s->rho_star_left;
    return state;
}

SAMPLE(late)
{
    return riemann_sample(s, x, x0, 1.01 * t);
}

SAMPLE(star_at_start)
{
    return riemann_sample(s, x, x0, t > 0 ? t : 1e300);
}

/* ---- subjects ---- */

#define SOLVER(solver)                                                                             \
    const struct riemann_subject riemann_mutant_##solver = {#solver, solver, riemann_sample};
#define SAMPLER(sampler)                                                                           \
    const struct riemann_subject riemann_mutant_##sampler = {#sampler, riemann_solve, sampler};

SOLVER(negative_pressure)
SOLVER(loose_root)
SOLVER(swapped_velocity)
SOLVER(two_shocks)
SOLVER(gamma_fixed)
SOLVER(isentropic_shock)
SOLVER(shock_speed)
SOLVER(isentrope_exponent)
SOLVER(tail_speed)
SOLVER(no_vacuum)
SOLVER(vacuum_limit)
SOLVER(vacuum_edge)
SOLVER(left_at_rest)
SOLVER(right_not_mirrored)
SAMPLER(fan_about_origin)
SAMPLER(fan_density)
SAMPLER(fan_velocity)
SAMPLER(fan_linear)
SAMPLER(fan_as_shock)
SAMPLER(no_contact)
SAMPLER(late)
SAMPLER(star_at_start)
