/* SPDX-License-Identifier: GPL-3.0-or-later
 * Toro (2009), sections 4.2-4.6. The unknown is y = ln(p/p_scale): the jump of velocity across each
 * wave, written with exp and expm1 of y, keeps its digits for weak and for very strong waves, and p
 * cannot become negative. All is done in long double, hence Newton's method with its own bracket
 * and not one of GSL's double precision solvers. The right side is the left one's mirror image, and
 * the sums are written so that mirrored problems give mirrored bits. */
#include "riemann.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

/* Widening double to long double is intended. */
#pragma GCC diagnostic ignored "-Wdouble-promotion"
typedef long double real;

static const double undefined = (double)NAN;

/* One side's gas; v > 0 is motion towards the other side. l = ln(P/p_scale). */
struct side {
    real gamma, rho, v, P, c, l;
};

static struct side side_make(double gamma, const struct riemann_state *state, int sign)
{
    struct side side = {.gamma = gamma, .rho = state->rho, .v = sign * state->v, .P = state->P};
    side.c = side.rho > 0 ? sqrtl(side.gamma * (side.P / side.rho)) : 0;
    return side;
}

/* ---- the jump of velocity across a wave (Toro eqs 4.6, 4.7) as a function of y ---- */

/* A wave into cold gas, l = -infinity, is always a shock. */
static bool is_shock(const struct side *side, real y)
{
    return !(y <= side->l);
}

static real rarefaction_jump(const struct side *side, real y)
{
    const real gamma = side->gamma, z = (gamma - 1) / (2 * gamma);
    return side->c > 0 ? 2 * side->c / (gamma - 1) * expm1l(z * (y - side->l)) : 0;
}

/* The velocity jump across the wave into the star region, and its derivative in y. */
static real velocity_jump(const struct side *side, real scale, real y, real *slope)
{
    const real gamma = side->gamma, z = (gamma - 1) / (2 * gamma);
    if (is_shock(side, y)) {
        const real ratio = expl(side->l - y); /* P/p */
        const real missing = -expm1l(side->l - y);
        const real d = gamma + 1 + (gamma - 1) * ratio;
        const real speed = sqrtl(scale / side->rho) * expl(y / 2) * sqrtl(2 / d);
        *slope = speed * (1 - (gamma + 1) * missing / (2 * d));
        return speed * missing;
    }
    *slope = side->c / gamma * expl(z * (y - side->l));
    return rarefaction_jump(side, y);
}

/* ---- star pressure ---- */

struct problem {
    struct side side[2];
    real scale; /* of the pressure */
    real dv;    /* v_R - v_L */
};

static real residual(const struct problem *problem, real y, real *slope)
{
    real slopes[2];
    const real jumps = velocity_jump(&problem->side[0], problem->scale, y, &slopes[0]) +
                       velocity_jump(&problem->side[1], problem->scale, y, &slopes[1]);
    *slope = slopes[0] + slopes[1];
    return jumps + problem->dv;
}

/* Two rarefactions (Toro eq. 4.46) without the cancellation of its numerator for gamma -> 1. */
static real two_rarefactions(const struct problem *problem)
{
    const struct side *a = &problem->side[0], *b = &problem->side[1];
    const real gamma = a->gamma, z = (gamma - 1) / (2 * gamma);
    const real excess = rarefaction_jump(a, 0) + rarefaction_jump(b, 0) + problem->dv;
    const real sum = a->c * expl(-z * a->l) + b->c * expl(-z * b->l);
    return log1pl(fmaxl(-(gamma - 1) / 2 * excess / sum, -1)) / z;
}

/* The root of the residual, which grows with y: bracketed by doubling steps, then Newton's method,
 * bisecting where that leaves the bracket or does not halve the last step. */
static real bracketed_newton(const struct problem *problem)
{
    real slope, y = 0, step = 1;
    real f = residual(problem, y, &slope);
    real low = 0, high = 0;
    if (f < 0)
        for (; f < 0 && high < 1e5L; step *= 2) f = residual(problem, high = low + step, &slope);
    else
        for (; f > 0 && low > -1e5L; step *= 2) f = residual(problem, low = high - step, &slope);
    y = low + (high - low) / 2;
    step = high - low;
    for (int i = 0; i < 300; i++) {
        f = residual(problem, y, &slope);
        if (f > 0)
            high = y;
        else
            low = y;
        const real newton = -f / slope, last = step;
        const bool inside = y + newton > low && y + newton < high;
        step = inside && fabsl(newton) < fabsl(last) / 2 ? newton : low + (high - low) / 2 - y;
        const real next = y + step;
        if (f == 0 || next == y) break;
        y = next;
        if (fabsl(step) <= 2 * LDBL_EPSILON * fmaxl(1, fabsl(y))) break;
    }
    return y;
}

/* Sets scale and l of both sides. */
static real star_pressure(struct problem *problem)
{
    struct side *a = &problem->side[0], *b = &problem->side[1];
    problem->scale = fmaxl(a->P, b->P);
    if (!(problem->scale > 0)) problem->scale = fminl(a->rho, b->rho) * problem->dv * problem->dv;
    a->l = logl(a->P / problem->scale);
    b->l = logl(b->P / problem->scale);
    real slope;
    const real lowest = fminl(a->l, b->l);
    if (isfinite(lowest) && residual(problem, lowest, &slope) >= 0)
        return two_rarefactions(problem);
    return bracketed_newton(problem);
}

/* ---- the state behind a wave and its speeds, seen from its own side ---- */

struct wave {
    enum riemann_wave kind;
    real rho, head, tail;
};

static struct wave wave_make(const struct side *side, real y, real p, real v_star)
{
    const real gamma = side->gamma;
    if (is_shock(side, y)) {
        const real ratio = expl(side->l - y);
        const real flux = ((gamma + 1) * p + (gamma - 1) * side->P) / 2;
        const real speed = fminl(side->v - sqrtl(flux / side->rho), v_star);
        const real compression =
            (gamma + 1 + (gamma - 1) * ratio) / (gamma - 1 + (gamma + 1) * ratio);
        return (struct wave){RIEMANN_SHOCK, side->rho * compression, speed, speed};
    }
    const real head = fminl(side->v - side->c, v_star);
    const real c_star = side->c * expl((gamma - 1) / (2 * gamma) * (y - side->l));
    return (struct wave){RIEMANN_RAREFACTION, side->rho * expl((y - side->l) / gamma), head,
                         fmaxl(v_star - c_star, head)};
}

/* Velocity between the waves, from the side whose jump depends less on the star pressure. */
static real star_velocity(const struct problem *problem, real y)
{
    real v[2], slope[2];
    for (int i = 0; i < 2; i++) {
        const struct side *side = &problem->side[i];
        v[i] = side->v - velocity_jump(side, problem->scale, y, &slope[i]);
    }
    if (slope[0] == slope[1]) return (v[0] - v[1]) / 2;
    return slope[0] < slope[1] ? v[0] : -v[1];
}

/* Expansion into vacuum; a side without gas has no wave. */
static struct wave wave_into_vacuum(const struct side *side)
{
    if (!(side->rho > 0)) return (struct wave){RIEMANN_NONE, 0, undefined, undefined};
    return (struct wave){RIEMANN_RAREFACTION, 0, side->v - side->c,
                         side->v + 2 * side->c / (side->gamma - 1)};
}

/* ---- public ---- */

const char *riemann_wave_name(enum riemann_wave wave)
{
    static const char *const names[] = {"none", "shock", "rarefaction"};
    return names[wave];
}

static const char *fault(double gamma, const struct riemann_state *left,
                         const struct riemann_state *right)
{
    if (!isfinite(gamma) || !(gamma > 1)) return "gamma must be finite and above 1";
    for (int i = 0; i < 2; i++) {
        const struct riemann_state *state = i ? right : left;
        if (!isfinite(state->rho) || !isfinite(state->v) || !isfinite(state->P))
            return "density, velocity and pressure must be finite";
        if (state->rho < 0 || state->P < 0) return "density and pressure must not be negative";
        if (state->rho <= 0 && state->P > 0)
            return "density 0 with a pressure above 0 (vacuum has both 0)";
    }
    return NULL;
}

/* Speeds may be NaN, for waves that do not exist. */
static bool representable(const struct riemann_solution *s)
{
    const double speeds[] = {s->left_head, s->left_tail, s->right_tail, s->right_head};
    for (unsigned i = 0; i < sizeof speeds / sizeof *speeds; i++)
        if (isinf(speeds[i])) return false;
    return isfinite(s->p_star) && isfinite(s->rho_star_left) && isfinite(s->rho_star_right) &&
           (s->vacuum || isfinite(s->v_star));
}

const char *riemann_solve(double gamma, const struct riemann_state *left,
                          const struct riemann_state *right, struct riemann_solution *solution)
{
    const char *why = fault(gamma, left, right);
    if (why) return why;
    struct riemann_solution s = {
        .gamma = gamma, .left = *left, .right = *right, .v_star = undefined, .contact = undefined};
    struct problem problem = {.side = {side_make(gamma, left, 1), side_make(gamma, right, -1)}};
    const struct side *a = &problem.side[0], *b = &problem.side[1];
    struct wave wave[2];
    problem.dv = (real)right->v - left->v;

    const bool at_rest = left->v == right->v && left->P == right->P;
    const bool gas = a->rho > 0 && b->rho > 0;
    s.vacuum = !gas || (!at_rest && problem.dv >= 2 * (a->c + b->c) / (a->gamma - 1));
    if (s.vacuum) {
        for (int i = 0; i < 2; i++) wave[i] = wave_into_vacuum(&problem.side[i]);
    } else if (at_rest) {
        const bool equal = left->rho == right->rho;
        for (int i = 0; i < 2; i++) {
            const struct side *side = &problem.side[i];
            const real head = equal ? undefined : side->v - side->c;
            wave[i] =
                (struct wave){equal ? RIEMANN_NONE : RIEMANN_RAREFACTION, side->rho, head, head};
        }
        s.p_star = left->P;
        s.v_star = left->v;
    } else {
        const real y = star_pressure(&problem), p = problem.scale * expl(y);
        const real v = star_velocity(&problem, y);
        wave[0] = wave_make(a, y, p, v);
        wave[1] = wave_make(b, y, p, -v);
        s.p_star = (double)p;
        s.v_star = (double)v;
        s.underflow = p < DBL_MIN || wave[0].rho < DBL_MIN || wave[1].rho < DBL_MIN;
    }
    s.contact = s.v_star;
    s.left_wave = wave[0].kind;
    s.right_wave = wave[1].kind;
    s.rho_star_left = (double)wave[0].rho;
    s.rho_star_right = (double)wave[1].rho;
    s.left_head = (double)wave[0].head;
    s.left_tail = (double)wave[0].tail;
    s.right_tail = (double)(0 - wave[1].tail);
    s.right_head = (double)(0 - wave[1].head);
    if (!representable(&s)) return "the solution leaves the range of double precision";
    *solution = s;
    return NULL;
}

/* Inside a fan (Toro eq. 4.56), xi = (x - x0)/t, seen from the fan's own side. */
static struct riemann_state fan(const struct side *side, real xi, int sign)
{
    const real gamma = side->gamma;
    const real depth = (xi - (side->v - side->c)) / (gamma + 1);
    const real log_c = log1pl(fmaxl(-(gamma - 1) * depth / side->c, -1)); /* ln(c/c_K) */
    return (struct riemann_state){
        .rho = (double)(side->rho * expl(2 / (gamma - 1) * log_c)),
        .v = (double)(sign * (side->v + 2 * depth)),
        .P = (double)(side->P * expl(2 * gamma / (gamma - 1) * log_c)),
    };
}

struct riemann_state riemann_sample(const struct riemann_solution *s, double x, double x0, double t)
{
    if (!(t > 0)) return x <= x0 ? s->left : s->right;
    const real xi = ((real)x - x0) / t;
    /* beside vacuum a side without gas has no tail */
    const bool on_left = xi <= (s->vacuum ? s->left_tail : s->contact);
    const bool on_right = s->vacuum ? xi >= s->right_tail : !on_left;
    if (on_left) {
        if (s->left_wave == RIEMANN_NONE || xi <= s->left_head) return s->left;
        if (xi >= s->left_tail)
            return (struct riemann_state){s->rho_star_left, s->v_star, s->p_star};
        const struct side side = side_make(s->gamma, &s->left, 1);
        return fan(&side, xi, 1);
    }
    if (on_right) {
        if (s->right_wave == RIEMANN_NONE || xi >= s->right_head) return s->right;
        if (xi <= s->right_tail)
            return (struct riemann_state){s->rho_star_right, s->v_star, s->p_star};
        const struct side side = side_make(s->gamma, &s->right, -1);
        return fan(&side, -xi, -1);
    }
    return (struct riemann_state){0, undefined, 0};
}
