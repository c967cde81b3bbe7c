/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests one evaluation of the rates with given sums: gravity, and the limit of the time step. */
#include "test.h"

#include "draw.h"
#include "solver.h"

enum { N = 9 };

/* The calls, a letter for each, and what forces() returns. */
static struct {
    char calls[16];
    double rate, F[3][N + 1], de[N + 1];
} seen;

static enum status arrange(struct simulation *simulation, struct error *error)
{
    (void)simulation, (void)error;
    seen.calls[strlen(seen.calls)] = 'a';
    return STATUS_OK;
}

static enum status widths(struct simulation *simulation, bool newton, double ratio,
                          struct error *error)
{
    (void)simulation, (void)newton, (void)ratio, (void)error;
    seen.calls[strlen(seen.calls)] = 'w';
    return STATUS_OK;
}

static enum status forces(struct simulation *simulation, double *rate, struct error *error)
{
    const struct particles *a = &simulation->particles;
    (void)error;
    for (int i = 0; i <= N; i++) {
        for (int k = 0; k < a->dim; k++) a->F[k][i] = seen.F[k][i];
        a->de[i] = seen.de[i];
    }
    *rate = seen.rate;
    seen.calls[strlen(seen.calls)] = 'f';
    return STATUS_OK;
}

static double signal_speed(struct simulation *simulation)
{
    (void)simulation;
    seen.calls[strlen(seen.calls)] = 's';
    return seen.rate;
}

static const struct sums known = {
    .arrange = arrange, .widths = widths, .forces = forces, .signal = signal_speed};

/* N particles that are all different, and one more that must not count. */
static void begin(struct simulation *s, int dim, bool total)
{
    struct error error;
    memset(s, 0, sizeof *s);
    memset(&seen, 0, sizeof seen);
    seen.rate = 2;
    if (particles_create(&s->particles, dim, N, 0, &error)) fail_msg("%s", error.message);
    struct particles *a = &s->particles;
    s->plan = (struct plan){.dim = dim, .sums = &known, .newton = true};
    s->scheme.energy = total ? ENERGY_TOTAL : ENERGY_INTERNAL;
    s->scheme.cfl = 0.25;
    s->time = 0.5, s->time_step = -1, s->dt = 0.125;
    for (int i = 0; i <= N; i++) {
        a->m[i] = draw(0.5, 2), a->m_inverse[i] = 1 / a->m[i], a->e[i] = draw(20, 30);
        if (i < N) a->id[i] = (size_t)(10 + i);
        a->h_inverse_found[i] = draw(1, 2), a->h_inverse_old[i] = draw(3, 4);
        a->v[0][i] = a->U[i] = 77;
        for (int k = 0; k < dim; k++) {
            a->p[k][i] = draw(-1, 1), a->x[k][i] = draw(-1, 1);
            seen.F[k][i] = draw(-1, 1);
        }
        seen.de[i] = draw(-1, 1);
    }
}

/* Force m g, and its work where the total energy is integrated: with the velocity p/m, or with the
 * mean velocity of the step if it is advanced from its midpoint. */
TEST(gravity_adds_force_and_work)
{
    static const struct integrator at_once = {.predicts = false}, midpoint = {.predicts = true};
    for (int dim = 1; dim <= 3; dim++)
        for (int total = 0; total < 2; total++)
            for (int gravity = 0; gravity < 4; gravity++) {
                struct simulation s;
                struct error error;
                begin(&s, dim, total);
                const struct particles *a = &s.particles;
                s.plan.gravity = gravity > 0;
                s.scheme.integrator = gravity == 1 ? &at_once : &midpoint;
                s.steps.level = gravity == 3 ? 0 : -1; /* 3: a level of local steps */
                for (int k = 0; k < 3; k++) s.gravity[k] = draw(-9, 9);
                assert_int_equal(evaluate_rates(&s, &error), STATUS_OK);
                for (int i = 0; i <= N; i++) {
                    double power = seen.de[i];
                    for (int k = 0; k < dim; k++) {
                        const double weight = gravity && i < N ? a->m[i] * s.gravity[k] : 0;
                        const double gained = gravity == 2 ? 0.5 * 0.125 * a->F[k][i] : 0;
                        near_below(fabs(a->F[k][i] - (seen.F[k][i] + weight)), 1e-14);
                        power += total ? weight * (a->p[k][i] + gained) / a->m[i] : 0;
                    }
                    near_below(fabs(a->de[i] - power), 1e-14);
                }
                particles_destroy(&s.particles);
            }
}

/* The limit is cfl over the largest signal speed / h; inactive particles count. */
TEST(time_step_is_limited_by_signals)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int asleep = 0; asleep < 2; asleep++) {
            struct simulation s;
            struct error error;
            begin(&s, dim, false);
            const struct particles *a = &s.particles;
            s.sleep.rate = asleep ? 8 : 1;
            assert_int_equal(evaluate_rates(&s, &error), STATUS_OK);
            assert_true(s.time_step == 0.25 / (asleep ? 8 : 2));
            for (int i = 0; i <= N; i++)
                for (int k = 0; k < dim; k++) a->p[k][i] = draw(-1, 1), a->v[k][i] = 77;
            seen.rate = 4;
            evaluate_signal(&s);
            assert_string_equal(seen.calls, "awfs");
            assert_true(s.time_step == 0.25 / (asleep ? 8 : 4));
            for (int i = 0; i < N; i++)
                for (int k = 0; k < dim; k++)
                    near_relative(a->v[k][i], a->p[k][i] / a->m[i], 1e-15);
            for (int k = 0; k < dim; k++) assert_true(a->v[k][N] == 77);
            particles_destroy(&s.particles);
        }
}
