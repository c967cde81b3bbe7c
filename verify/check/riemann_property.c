/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "riemann_property.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

const struct riemann_subject riemann_reference = {"reference", riemann_solve, riemann_sample};

static double sound_speed(double gamma, double rho, double P)
{
    return rho > 0 ? sqrt(gamma * (P / rho)) : 0;
}

/* The larger, and NaN if either is NaN (fmax would drop it). */
static double larger(double a, double b)
{
    return a >= b || isnan(a) ? a : b;
}

/* ---- random problems ---- */

static double uniform(gsl_rng *random, double low, double high)
{
    return low + (high - low) * gsl_rng_uniform(random);
}

static double log_uniform(gsl_rng *random, double low, double high)
{
    return pow(10, uniform(random, low, high));
}

static struct riemann_state random_gas(gsl_rng *random, double decades)
{
    struct riemann_state state = {.rho = log_uniform(random, -decades / 2, decades / 2)};
    state.P = log_uniform(random, -decades / 2, decades / 2);
    return state;
}

struct riemann_problem riemann_random(gsl_rng *random, double decades)
{
    static const double gammas[] = {1.4, 5. / 3, 4. / 3, 2, 3, 1.1};
    struct riemann_problem p = {.gamma = gammas[gsl_rng_uniform_int(random, 6)],
                                .left = random_gas(random, decades),
                                .right = random_gas(random, decades)};
    if (gsl_rng_uniform(random) < 0.3) p.gamma = 1 + log_uniform(random, -2, 1);
    if (gsl_rng_uniform(random) < 0.2) p.right.P = p.left.P;
    const double c =
        sound_speed(p.gamma, p.left.rho, p.left.P) + sound_speed(p.gamma, p.right.rho, p.right.P);
    const double escape = 2 * c / (p.gamma - 1);
    double dv = 0; /* velocity of separation */
    switch (gsl_rng_uniform_int(random, 6)) {
    case 0:
        dv = uniform(random, -3, 1) * c;
        break;
    case 1:
        dv = -log_uniform(random, -6, 3) * c;
        break;
    case 2: /* close to vacuum, but not within a hundredth */
        dv = escape * (1 - log_uniform(random, -2, 0));
        break;
    case 3:
        dv = escape * (1 + log_uniform(random, -3, 1));
        break;
    case 4: /* weak waves */
        p.right.P = p.left.P * (1 + uniform(random, -1e-3, 1e-3));
        dv = uniform(random, -1e-3, 1e-3) * c;
        break;
    default:
        break;
    }
    const double share = gsl_rng_uniform(random), drift = uniform(random, -1, 1) * c;
    p.left.v = drift - share * dv;
    p.right.v = drift + (1 - share) * dv;
    if (gsl_rng_uniform(random) < 0.05)
        p.left = (struct riemann_state){0, 0, 0};
    else if (gsl_rng_uniform(random) < 0.05)
        p.right = (struct riemann_state){0, 0, 0};
    return p;
}

/* ---- defects of one side; the right one is mirrored ---- */

struct seen {
    double gamma, rho, v, P, c;      /* ahead of the wave */
    double rho_star, v_star, P_star; /* behind it */
    double head, tail;
    enum riemann_wave wave;
    bool vacuum;
};

static struct seen look(const struct riemann_solution *s, int right)
{
    const struct riemann_state *state = right ? &s->right : &s->left;
    const int sign = right ? -1 : 1;
    return (struct seen){
        .gamma = s->gamma,
        .rho = state->rho,
        .v = sign * state->v,
        .P = state->P,
        .c = sound_speed(s->gamma, state->rho, state->P),
        .rho_star = right ? s->rho_star_right : s->rho_star_left,
        .v_star = sign * s->v_star,
        .P_star = s->p_star,
        .head = sign * (right ? s->right_head : s->left_head),
        .tail = sign * (right ? s->right_tail : s->left_tail),
        .wave = right ? s->right_wave : s->left_wave,
        .vacuum = s->vacuum,
    };
}

static void shock_defects(const struct seen *k, struct riemann_defects *d)
{
    const double S = k->head, w = k->v - S, w_star = k->v_star - S;
    const double a = fabs(k->v) + fabs(S), b = fabs(k->v_star) + fabs(S);
    const double h = k->gamma / (k->gamma - 1);
    d->mass =
        larger(d->mass, fabs(k->rho * w - k->rho_star * w_star) / (k->rho * a + k->rho_star * b));
    d->momentum = larger(d->momentum,
                         fabs(k->rho * w * w + k->P - k->rho_star * w_star * w_star - k->P_star) /
                             (k->rho * a * a + k->P + k->rho_star * b * b + k->P_star));
    const double before = h * k->P / k->rho, behind = h * k->P_star / k->rho_star;
    d->energy = larger(d->energy, fabs(w * w / 2 + before - w_star * w_star / 2 - behind) /
                                      (a * a / 2 + before + b * b / 2 + behind));
    d->order = larger(d->order, k->P_star >= k->P * (1 - 4 * DBL_EPSILON) ? 0 : 1);
    d->speeds = larger(d->speeds, fabs(k->head - k->tail));
}

static void rarefaction_defects(const struct seen *k, struct riemann_defects *d)
{
    const double scale = fabs(k->v) + k->c, to_v = 2 / (k->gamma - 1);
    const double c_star = sound_speed(k->gamma, k->rho_star, k->P_star);
    const double v_star = k->vacuum ? k->tail : k->v_star;
    /* a subnormal star state has too few digits to be tested */
    const bool digits = k->P_star > DBL_MIN && k->rho_star > DBL_MIN;
    if (digits) {
        const double fall = log(k->P_star / k->P);
        d->isentrope = larger(d->isentrope, fabs(fall - k->gamma * log(k->rho_star / k->rho)) /
                                                (1 + k->gamma + fabs(fall)));
    }
    if (digits || k->vacuum) {
        d->invariant = larger(d->invariant, fabs(k->v + to_v * k->c - v_star - to_v * c_star) /
                                                (scale + to_v * k->c + fabs(v_star)));
        d->speeds =
            larger(d->speeds, fabs(k->tail - (v_star - c_star)) / (scale + fabs(v_star) + c_star));
    }
    d->speeds = larger(d->speeds, fabs(k->head - (k->v - k->c)) / scale);
    d->order = larger(d->order, k->P_star <= k->P * (1 + 4 * DBL_EPSILON) ? 0 : 1);
    const double out_of_order = (k->head - k->tail) / (scale + fabs(v_star) + to_v * k->c);
    d->order = larger(d->order, larger(out_of_order, 0));
}

struct riemann_defects riemann_defects_of(const struct riemann_solution *s)
{
    struct riemann_defects d = {0};
    for (int right = 0; right < 2; right++) {
        const struct seen k = look(s, right);
        if (k.wave == RIEMANN_SHOCK) shock_defects(&k, &d);
        if (k.wave == RIEMANN_RAREFACTION) rarefaction_defects(&k, &d);
        const bool idle = k.wave == RIEMANN_NONE;
        if (idle && k.rho > 0 && !(k.rho_star == k.rho && k.P_star == k.P && k.v_star == k.v))
            d.order = larger(d.order, 1);
        if (!s->vacuum && !idle && !(k.tail <= k.v_star + 4 * DBL_EPSILON * (k.c + fabs(k.v))))
            d.order = larger(d.order, 1);
    }
    if (!s->vacuum) d.speeds = larger(d.speeds, fabs(s->contact - s->v_star));
    return d;
}

double riemann_vacuum_defect(const struct riemann_solution *s)
{
    const double cl = sound_speed(s->gamma, s->left.rho, s->left.P);
    const double cr = sound_speed(s->gamma, s->right.rho, s->right.P);
    const double dv = s->right.v - s->left.v, escape = 2 * (cl + cr) / (s->gamma - 1);
    const bool empty_side = s->left.rho <= 0 || s->right.rho <= 0;
    const bool expected = empty_side || dv >= escape;
    if (!empty_side && fabs(dv - escape) < 1e-12 * (fabs(dv) + escape)) return 0;
    if (s->vacuum != expected) return 1;
    const bool zero = s->p_star == 0 && s->rho_star_left == 0 && s->rho_star_right == 0;
    if (expected) return zero && isnan(s->v_star) && isnan(s->contact) ? 0 : 1;
    return s->p_star >= 0 && isfinite(s->p_star) && isfinite(s->v_star) ? 0 : 1;
}

/* ---- fans ---- */

double riemann_fan_defect(const struct riemann_subject *subject, const struct riemann_solution *s,
                          double x0, double t)
{
    enum { POINTS = 9 };
    double worst = 0;
    bool fan = false, compared = false;
    for (int right = 0; right < 2; right++) {
        const struct seen k = look(s, right);
        const double to_v = 2 / (k.gamma - 1), scale = fabs(k.v) + (1 + to_v) * k.c + fabs(x0) / t;
        if (k.wave != RIEMANN_RAREFACTION || !(k.tail - k.head > 1e-6 * scale)) continue;
        fan = true;
        /* up to the tail, except in vacuum, where the rounding of x decides whether there is gas */
        for (int i = 0; i <= POINTS + !s->vacuum; i++) {
            const double xi = k.head + (k.tail - k.head) * i / (POINTS + 1);
            const double x = x0 + (right ? -xi : xi) * t;
            const struct riemann_state state = subject->sample(s, x, x0, t);
            if (!isnan(state.rho) && !(state.rho > DBL_MIN && state.P > DBL_MIN)) continue;
            const double c = sound_speed(k.gamma, state.rho, state.P);
            const double v = right ? -state.v : state.v;
            worst = larger(worst, fabs(v - c - xi) / scale);
            worst = larger(worst, fabs(v + to_v * c - k.v - to_v * k.c) / scale);
            const double fall = log(state.P / k.P);
            compared = true;
            worst = larger(worst, fabs(fall - k.gamma * log(state.rho / k.rho)) /
                                      (1 + k.gamma + fabs(fall)));
        }
    }
    return compared || !fan ? worst : (double)NAN;
}

/* ---- symmetries ---- */

struct riemann_problem riemann_mirrored(const struct riemann_problem *p)
{
    return (struct riemann_problem){.gamma = p->gamma,
                                    .left = {p->right.rho, -p->right.v, p->right.P},
                                    .right = {p->left.rho, -p->left.v, p->left.P}};
}

struct riemann_problem riemann_boosted(const struct riemann_problem *p, double dv)
{
    struct riemann_problem boosted = *p;
    boosted.left.v += dv;
    boosted.right.v += dv;
    return boosted;
}

struct riemann_solution riemann_solution_mirrored(const struct riemann_solution *s)
{
    struct riemann_solution m = *s;
    m.v_star = -s->v_star, m.contact = -s->contact;
    m.rho_star_left = s->rho_star_right, m.rho_star_right = s->rho_star_left;
    m.left_wave = s->right_wave, m.right_wave = s->left_wave;
    m.left_head = -s->right_head, m.right_head = -s->left_head;
    m.left_tail = -s->right_tail, m.right_tail = -s->left_tail;
    return m;
}

struct riemann_solution riemann_solution_boosted(const struct riemann_solution *s, double dv)
{
    struct riemann_solution b = *s;
    b.v_star += dv, b.contact += dv;
    b.left_head += dv, b.left_tail += dv, b.right_tail += dv, b.right_head += dv;
    return b;
}

static double relative(double a, double b)
{
    return a == b || (isnan(a) && isnan(b)) ? 0 : fabs(a - b) / larger(fabs(a), fabs(b));
}

double riemann_difference(const struct riemann_solution *a, const struct riemann_solution *b,
                          double speed)
{
    if (a->left_wave != b->left_wave || a->right_wave != b->right_wave || a->vacuum != b->vacuum)
        return 1;
    const double speeds[][2] = {{a->v_star, b->v_star},         {a->contact, b->contact},
                                {a->left_head, b->left_head},   {a->left_tail, b->left_tail},
                                {a->right_tail, b->right_tail}, {a->right_head, b->right_head}};
    double worst = larger(relative(a->p_star, b->p_star),
                          larger(relative(a->rho_star_left, b->rho_star_left),
                                 relative(a->rho_star_right, b->rho_star_right)));
    for (size_t i = 0; i < sizeof speeds / sizeof *speeds; i++) {
        const bool absent = isnan(speeds[i][0]) && isnan(speeds[i][1]);
        worst = larger(worst, absent ? 0 : fabs(speeds[i][0] - speeds[i][1]) / speed);
    }
    return worst;
}

double riemann_speed_scale(const struct riemann_problem *p)
{
    const double cl = sound_speed(p->gamma, p->left.rho, p->left.P);
    const double cr = sound_speed(p->gamma, p->right.rho, p->right.P);
    return larger(larger(fabs(p->left.v), fabs(p->right.v)), larger(cl, cr));
}
