/* SPDX-License-Identifier: GPL-3.0-or-later
 * One step of each integrator, with rates that are another set of numbers at each evaluation: the
 * states at which it evaluates and the one it ends with, against its scheme in extended precision;
 * and what an integrator that has predicted the next step does when there is none. */
#include "test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "draw.h"
#include "near.h"
#include "solver.h"

typedef long double real;

enum { N = 64 * WORTH_A_THREAD + 5, STAGES = 4 };

/* x and p of each direction, e and alpha. */
struct point {
    real x[3], p[3], e, alpha;
};

struct slope {
    real F[3], de, dalpha;
};

static double masses[N];
static struct slope slopes[STAGES + 1][N];
static struct point starts[N], seen_state[STAGES][N];
static double seen_v[STAGES][3][N], seen_U[STAGES][N];
static int stage, fails_at; /* which evaluation; 0: none */

static enum status arrange(struct simulation *simulation, struct error *error)
{
    (void)simulation, (void)error;
    return STATUS_OK;
}

static enum status widths(struct simulation *simulation, bool newton, double ratio,
                          struct error *error)
{
    (void)simulation, (void)newton, (void)ratio, (void)error;
    return STATUS_OK;
}

static struct point state_of(const struct simulation *s, ptrdiff_t i)
{
    const struct particles *a = &s->particles;
    struct point at = {.e = a->e[i], .alpha = a->alpha[i]};
    for (int k = 0; k < a->dim; k++) at.x[k] = a->x[k][i], at.p[k] = a->p[k][i];
    return at;
}

static void give_rates(const struct simulation *s, int of)
{
    const struct particles *a = &s->particles;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        for (int k = 0; k < a->dim; k++) a->F[k][i] = (double)slopes[of][i].F[k];
        a->de[i] = (double)slopes[of][i].de, a->dalpha[i] = (double)slopes[of][i].dalpha;
    }
}

static enum status forces(struct simulation *simulation, double *rate, struct error *error)
{
    const struct particles *a = &simulation->particles;
    assert_true(stage < STAGES);
    for (ptrdiff_t i = 0; i < a->n; i++) {
        seen_state[stage][i] = state_of(simulation, i);
        for (int k = 0; k < a->dim; k++) seen_v[stage][k][i] = a->v[k][i];
        seen_U[stage][i] = a->U[i];
    }
    give_rates(simulation, ++stage);
    *rate = 2;
    return stage == fails_at ? error_set(error, STATUS_BROKE_DOWN, "as was wished") : STATUS_OK;
}

static const struct sums known = {.arrange = arrange, .widths = widths, .forces = forces};

static void begin(struct simulation *s, const char *integrator, int dim, ptrdiff_t n, bool total,
                  bool evolves)
{
    struct error error;
    memset(s, 0, sizeof *s);
    if (particles_create(&s->particles, dim, n, 0, &error)) fail_msg("%s", error.message);
    struct particles *a = &s->particles;
    s->plan = (struct plan){.dim = dim, .sums = &known, .alpha = evolves, .newton = true};
    s->scheme.energy = total ? ENERGY_TOTAL : ENERGY_INTERNAL;
    s->scheme.cfl = 0.3;
    s->scheme.integrator = (const struct integrator *)family_find(&integrator_family, integrator);
    s->integrator_state = calloc(1, s->scheme.integrator->keeps + 1);
    s->team.size = s->team.most = 1;
    s->t_end = 0.25, s->dt = 0.25;
    for (ptrdiff_t i = 0; i < n; i++) {
        masses[i] = a->m[i] = draw(0.5, 2), a->m_inverse[i] = 1 / a->m[i];
        a->id[i] = (size_t)i;
        for (int k = 0; k < dim; k++)
            a->x[k][i] = a->x_old[k][i] = draw(-1, 1), a->p[k][i] = draw(-1, 1);
        a->e[i] = draw(20, 30), a->alpha[i] = a->alpha_old[i] = draw(0.1, 1);
        starts[i] = state_of(s, i);
        for (int of = 0; of <= STAGES; of++) {
            for (int k = 0; k < 3; k++) slopes[of][i].F[k] = draw(-1, 1);
            slopes[of][i].de = draw(-1, 1), slopes[of][i].dalpha = draw(-1, 1);
        }
    }
    give_rates(s, 0);
    stage = 0;
}

static void end(struct simulation *s)
{
    particles_destroy(&s->particles);
    free(s->integrator_state);
}

/* a from + b with + step (p of this one/m, F, de, dalpha). */
static struct point moved(ptrdiff_t i, const struct point *old, real b, const struct point *now,
                          real step, const struct slope *slope)
{
    struct point next = {.e = (1 - b) * old->e + b * now->e + step * slope->de,
                         .alpha = (1 - b) * old->alpha + b * now->alpha + step * slope->dalpha};
    for (int k = 0; k < 3; k++) {
        next.x[k] = (1 - b) * old->x[k] + b * now->x[k] + step * now->p[k] / masses[i];
        next.p[k] = (1 - b) * old->p[k] + b * now->p[k] + step * slope->F[k];
    }
    return next;
}

/* The states at the evaluations of a step and, last, the one it ends with; returns how many
 * evaluations there are. Rates of the start are slopes[0], of evaluation k slopes[k + 1]. */
static int scheme(const char *name, ptrdiff_t i, real dt, struct point states[STAGES + 1])
{
    const struct point *old = &starts[i];
    const struct slope *f[] = {&slopes[0][i], &slopes[1][i], &slopes[2][i]};
    if (strcmp(name, "rk2") == 0) {
        states[0] = moved(i, old, 1, old, dt, f[0]);
        states[1] = states[2] = moved(i, old, 0.5L, &states[0], dt / 2, f[1]);
        return 2;
    }
    if (strcmp(name, "vl2") == 0) {
        states[0] = moved(i, old, 1, old, dt / 2, f[0]);
        states[1] = states[2] = moved(i, old, 0, &states[0], dt, f[1]);
        return 2;
    }
    if (strcmp(name, "rk3") == 0) {
        states[0] = moved(i, old, 1, old, dt, f[0]);
        states[1] = moved(i, old, 0.25L, &states[0], dt / 4, f[1]);
        states[2] = states[3] = moved(i, old, 2 / 3.0L, &states[1], dt * 2 / 3, f[2]);
        return 3;
    }
    states[0] = moved(i, old, 1, old, dt, f[0]);
    if (strcmp(name, "symplectic_euler") == 0) {
        for (int k = 0; k < 3; k++) states[0].x[k] = old->x[k] + dt * states[0].p[k] / masses[i];
        states[1] = states[0];
        return 1;
    }
    for (int k = 0; k < 3; k++) /* leapfrogs drift with the half-kicked momentum */
        states[0].x[k] = old->x[k] + dt * (old->p[k] + dt / 2 * f[0]->F[k]) / masses[i];
    states[1] = states[0];
    for (int k = 0; k < 3; k++) states[1].p[k] += dt / 2 * (f[1]->F[k] - f[0]->F[k]);
    states[1].e += dt / 2 * (f[1]->de - f[0]->de);
    states[1].alpha += dt / 2 * (f[1]->dalpha - f[0]->dalpha);
    states[2] = states[1];
    return strcmp(name, "leapfrog") == 0 ? 1 : 2;
}

static void alike(const struct point *got, const struct point *want, int dim, bool evolves)
{
    for (int k = 0; k < dim; k++) {
        near_below(fabs((double)(got->x[k] - want->x[k])), 2e-15);
        near_below(fabs((double)(got->p[k] - want->p[k])), 2e-15);
    }
    near_below(fabs((double)(got->e - want->e)), 3e-14);
    if (evolves) near_below(fabs((double)(got->alpha - want->alpha)), 2e-15);
}

/* v and U of a state are what the evaluation has seen. */
static void primitives(const struct point *at, int evaluation, ptrdiff_t i, int dim, bool total)
{
    real U = at->e;
    for (int k = 0; k < dim; k++) {
        near_below(fabs((double)(seen_v[evaluation][k][i] - at->p[k] / masses[i])), 4e-15);
        if (total) U -= at->p[k] * at->p[k] / (2 * (real)masses[i]);
    }
    near_below(fabs((double)(seen_U[evaluation][i] - U)), 4e-14);
}

TEST(one_step)
{
    static const char *const names[] = {
        "symplectic_euler", "leapfrog", "modified_leapfrog", "rk2", "vl2", "rk3"};
    assert_int_equal(integrator_family.n, sizeof names / sizeof *names + 1);
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        for (int dim = 1; dim <= 3; dim++)
            for (int way = 0; way < 4; way++) {
                const bool total = way & 1, evolves = way & 2;
                struct simulation s;
                struct error error;
                begin(&s, names[k], dim, 9, total, evolves);
                for (ptrdiff_t i = 0; i < 9; i++) { /* nobody knows the start of the step before */
                    for (int d = 0; d < dim; d++)
                        s.particles.x_old[d][i] = s.particles.p_old[d][i] = 55;
                    s.particles.e_old[i] = 55;
                    if (evolves) s.particles.alpha_old[i] = 55;
                }
                assert_int_equal(s.scheme.integrator->step(&s, 0.25, &error), STATUS_OK);
                for (ptrdiff_t i = 0; i < 9; i++) {
                    struct point states[STAGES + 1] = {{{0}, {0}, 0, 0}};
                    const int evaluations = scheme(names[k], i, 0.25L, states);
                    assert_int_equal(stage, evaluations);
                    assert_int_equal(s.scheme.integrator->evaluations, evaluations);
                    for (int at = 0; at < evaluations; at++) {
                        alike(&seen_state[at][i], &states[at], dim, evolves);
                        primitives(&states[at], at, i, dim, total);
                    }
                    const struct point final = state_of(&s, i);
                    alike(&final, &states[evaluations], dim, evolves);
                    if (!evolves) assert_true(final.alpha == starts[i].alpha);
                }
                assert_true(s.time_step == 0.3 / 2);
                end(&s);
            }
}

/* Whichever evaluation fails, the step says so and goes no further. */
TEST(evaluations_that_fail)
{
    for (size_t k = 0; k < integrator_family.n; k++) {
        const struct integrator *integrator =
            (const struct integrator *)integrator_family.members[k];
        for (int at = 1; at <= integrator->evaluations; at++) {
            struct simulation s;
            struct error error = {0};
            begin(&s, integrator->member.name, 2, 9, false, false);
            fails_at = at;
            assert_int_equal(integrator->step(&s, 0.25, &error), STATUS_BROKE_DOWN);
            assert_string_equal(error.message, "as was wished");
            assert_int_equal(stage, at);
            fails_at = 0;
            end(&s);
        }
    }
}

/* --- predicted_midpoint ----------------------------------------------------------------------- */

/* The middle of a step from a state, as the evaluation sees it: x, v and U, and alpha. */
static void middle(int evaluation, ptrdiff_t i, const struct point *from, const struct slope *slope,
                   real dt, int dim, bool total, bool evolves)
{
    real U = from->e, U_half = from->e + dt / 2 * slope->de;
    for (int k = 0; k < dim; k++) {
        const real p = from->p[k] + dt / 2 * slope->F[k];
        near_below(fabs((double)(seen_v[evaluation][k][i] - p / masses[i])), 4e-15);
        near_below(fabs((double)(seen_state[evaluation][i].x[k] - from->x[k] -
                                 dt / 2 * from->p[k] / masses[i])),
                   2e-15);
        if (!total) continue;
        U -= from->p[k] * from->p[k] / (2 * (real)masses[i]);
        U_half -= p * p / (2 * (real)masses[i]);
    }
    near_below(fabs((double)(seen_U[evaluation][i] - fmaxl(U_half, U / 2))), 4e-14);
    if (evolves)
        near_below(
            fabs((double)(seen_state[evaluation][i].alpha - from->alpha - dt / 2 * slope->dalpha)),
            2e-15);
}

/* The state after a step with these rates, from a state. */
static struct point after(ptrdiff_t i, const struct point *from, const struct slope *slope, real dt)
{
    struct point next = moved(i, from, 1, from, dt, slope);
    for (int k = 0; k < 3; k++)
        next.x[k] = from->x[k] + dt * (from->p[k] + next.p[k]) / (2 * (real)masses[i]);
    return next;
}

/* One step that is the last, then one whose successor is predicted with it, then the last again; or
 * one that turns out to be shorter than was predicted. Also where others share the work. */
TEST(from_middle_to_middle)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int way = 0; way < 16; way++) {
            const bool total = way & 1, evolves = way & 2, shorter = way & 4, many = way & 8;
            const ptrdiff_t n = many ? N : 9;
            const double later = shorter ? 0.125 : 0.25;
            struct simulation s;
            struct error error;
            if (many && dim == 2) continue;
            begin(&s, "predicted_midpoint", dim, n, total, evolves);
            const struct integrator *integrator = s.scheme.integrator;
            if (many) s.team.size = s.team.most = 2;
            for (ptrdiff_t i = 0; i < n; i += 5) slopes[0][i].de = -500; /* half is what is left */
            give_rates(&s, 0);
            s.t_end = 0.5;
            s.scheme.cfl = 0.5;
            assert_int_equal(integrator->step(&s, 0.25, &error), STATUS_OK);
            s.time = 0.25;
            s.t_end = 0.25 + later;
            assert_int_equal(integrator->step(&s, later, &error), STATUS_OK);
            assert_int_equal(stage, 2);
            for (ptrdiff_t i = 0; i < n; i++) {
                const struct slope *f[] = {&slopes[0][i], &slopes[1][i], &slopes[2][i]};
                const struct point first = after(i, &starts[i], f[1], 0.25L),
                                   second = after(i, &first, f[2], later), final = state_of(&s, i);
                middle(0, i, &starts[i], f[0], 0.25L, dim, total, evolves);
                middle(1, i, &first, f[1], later, dim, total, evolves);
                alike(&final, &second, dim, evolves);
                if (!evolves) assert_true(final.alpha == starts[i].alpha);
            }
            end(&s);
        }
}

/* Synchronised, a state that was ahead is at the present time. */
TEST(back_from_the_middle)
{
    for (int evolves = 0; evolves < 2; evolves++) {
        struct simulation s;
        struct error error;
        begin(&s, "predicted_midpoint", 2, 9, false, evolves);
        s.t_end = 0.5;
        s.scheme.cfl = 0.5;
        assert_int_equal(s.scheme.integrator->step(&s, 0.25, &error), STATUS_OK);
        for (int again = 0; again < 2; again++) {
            s.scheme.integrator->synchronise(&s);
            for (ptrdiff_t i = 0; i < 9; i++) {
                const struct point first = after(i, &starts[i], &slopes[1][i], 0.25L),
                                   now = state_of(&s, i);
                alike(&now, &first, 2, evolves);
            }
            for (ptrdiff_t i = 0; i < 9; i++) s.particles.x_old[0][i] += again ? 0 : 1;
        }
        end(&s);
    }
}

/* Where others sleep at rest, only who is awake moves; sleepers in moving gas drift. */
TEST(sleepers_stay)
{
    for (int way = 0; way < 3; way++) {
        struct span spans[] = {{2, 3}, {7, 2}};
        struct simulation s;
        struct error error;
        begin(&s, "predicted_midpoint", 1, 12, false, false);
        s.sleep = (struct sleep){
            .on = way != 0, .at_rest = way != 1, .spans = spans, .span_count = 2, .awake_count = 5};
        assert_int_equal(s.scheme.integrator->step(&s, 0.25, &error), STATUS_OK);
        for (ptrdiff_t i = 0; i < 12; i++) {
            const bool awake = way != 2 || (i >= 2 && i < 5) || i == 7 || i == 8;
            const struct point next = after(i, &starts[i], &slopes[1][i], 0.25L),
                               now = state_of(&s, i);
            alike(&now, awake ? &next : &starts[i], 1, false);
        }
        end(&s);
    }
}
