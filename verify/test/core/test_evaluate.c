/* SPDX-License-Identifier: GPL-3.0-or-later
 * An evaluation with sums that do nothing but say what they were asked for: what is called, in
 * which order, with what; gravity, the limit of the time step, and who is named where something is
 * not sound. */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "draw.h"
#include "near.h"
#include "solver.h"

enum { N = 9 };

/* A letter for each call; what widths were asked for; where it fails; what forces find. */
static struct {
    char calls[16];
    bool newton;
    double ratio, rate;
    char fails;
    double F[3][N + 1], de[N + 1];
} seen;

static enum status called(char letter, struct error *error)
{
    seen.calls[strlen(seen.calls)] = letter;
    return letter == seen.fails ? error_set(error, STATUS_BROKE_DOWN, "%c", letter) : STATUS_OK;
}

static enum status arrange(struct simulation *simulation, struct error *error)
{
    (void)simulation;
    return called('a', error);
}

static enum status widths(struct simulation *simulation, bool newton, double ratio,
                          struct error *error)
{
    (void)simulation;
    seen.newton = newton, seen.ratio = ratio;
    return called('w', error);
}

static void matrix(struct simulation *simulation)
{
    (void)simulation;
    called('m', NULL);
}

static enum status forces(struct simulation *simulation, double *rate, struct error *error)
{
    const struct particles *a = &simulation->particles;
    for (int i = 0; i <= N; i++) {
        for (int k = 0; k < a->dim; k++) a->F[k][i] = seen.F[k][i];
        a->de[i] = seen.de[i];
    }
    *rate = seen.rate;
    return called('f', error);
}

static double signal_speed(struct simulation *simulation)
{
    (void)simulation;
    called('s', NULL);
    return seen.rate;
}

static void find_switch(struct simulation *simulation)
{
    (void)simulation;
    called('j', NULL);
}

static const struct sums known = {.arrange = arrange,
                                  .widths = widths,
                                  .matrix = matrix,
                                  .forces = forces,
                                  .signal = signal_speed,
                                  .find_switch = find_switch};

/* N particles that are all different, and one more that is nobody's. */
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

TEST(primitives_of_a_state)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int total = 0; total < 2; total++)
            for (int rates = 0; rates < 2; rates++) {
                struct simulation s;
                struct error error;
                begin(&s, dim, total);
                const struct particles *a = &s.particles;
                s.plan.newton = rates;
                s.plan.gravity = true, s.gravity[0] = 5; /* of rates only */
                assert_int_equal((rates ? evaluate_rates : evaluate_state)(&s, &error), STATUS_OK);
                assert_string_equal(seen.calls, rates ? "awf" : "aw");
                assert_true(seen.newton);
                for (int i = 0; i < N; i++) {
                    double U = a->e[i];
                    for (int k = 0; k < dim; k++) {
                        near_relative(a->v[k][i], a->p[k][i] / a->m[i], 1e-15);
                        U -= total ? 0.5 * a->p[k][i] * a->p[k][i] / a->m[i] : 0;
                    }
                    near_relative(a->U[i], U, 1e-15);
                    assert_true(rates || a->F[0][i] == 0);
                }
                assert_true(a->v[0][N] == 77 && a->U[N] == 77);
                assert_true(s.time_step == (rates ? 0.125 : -1));
                particles_destroy(&s.particles);
            }
}

/* The first one without internal energy is named, and nothing is computed of it. */
TEST(without_energy)
{
    static const double left[] = {0, -3.25, (double)NAN};
    for (int first = 0; first < N; first += 4)
        for (int k = 0; k < 3; k++)
            for (int rates = 0; rates < 2; rates++) {
                struct simulation s;
                struct error error;
                char said[120];
                begin(&s, 1, false);
                s.particles.e[first] = left[k], s.particles.e[N - 1] = -1;
                if (first == N - 1) s.particles.e[first] = left[k];
                assert_int_equal((rates ? evaluate_rates : evaluate_state)(&s, &error),
                                 STATUS_BROKE_DOWN);
                snprintf(said, sizeof said,
                         "broke down at t = 0.5: internal energy of particle %d at x = %.9g is %g",
                         10 + first, s.particles.x[0][first], left[k]);
                assert_string_equal(error.message, said);
                assert_string_equal(seen.calls, "");
                particles_destroy(&s.particles);
            }
}

/* Matrices before the forces, the switch after them; nothing after what fails. */
TEST(what_is_called)
{
    for (int way = 0; way < 8; way++)
        for (const char *fails = "_awf"; *fails; fails++) {
            struct simulation s;
            struct error error;
            begin(&s, 2, false);
            s.plan.matrix = way & 1, s.plan.slope = way & 2, s.plan.jump = way & 4;
            seen.fails = *fails;
            const enum status status = evaluate_rates_of_primitives(&s, &error);
            const bool well = *fails == '_';
            char want[16];
            snprintf(want, sizeof want, "aw%sf%s", way & 3 ? "m" : "", way & 4 ? "j" : "");
            if (!well) strchr(want, *fails)[1] = 0;
            assert_int_equal(status, well ? STATUS_OK : STATUS_BROKE_DOWN);
            assert_string_equal(seen.calls, want);
            assert_true(s.time_step == (well ? 0.125 : -1) && s.particles.U[3] == 77);
            particles_destroy(&s.particles);
        }
}

/* Widths are predicted over half of the step before and half of this one; by Newton where there is
 * no step yet, and then the change of 1/h is none. */
TEST(widths_are_predicted)
{
    static const struct {
        double before, dt, ratio;
    } rows[] = {{0, 0, 0}, {0, 0.5, 0}, {0.5, 0.5, 1}, {0.5, 0.25, 0.75}, {0.25, 1, 2.5}};
    for (int always = 0; always < 2; always++)
        for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
            struct simulation s;
            struct error error;
            begin(&s, 1, false);
            const struct particles *a = &s.particles;
            double old[N + 1];
            memcpy(old, a->h_inverse_old, sizeof old);
            s.dt_before = rows[k].before, s.dt = rows[k].dt, s.plan.newton = always;
            assert_int_equal(evaluate_rates_of_primitives(&s, &error), STATUS_OK);
            const bool first = rows[k].dt == 0;
            assert_true(seen.ratio == rows[k].ratio && seen.newton == (always || first));
            for (int i = 0; i <= N; i++)
                assert_true(a->h_inverse_old[i] ==
                            (first && !always && i < N ? a->h_inverse_found[i] : old[i]));
            particles_destroy(&s.particles);
        }
}

/* Force m g, and its work where the total energy is integrated. */
TEST(gas_falls)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int total = 0; total < 2; total++)
            for (int gravity = 0; gravity < 2; gravity++) {
                struct simulation s;
                struct error error;
                begin(&s, dim, total);
                const struct particles *a = &s.particles;
                s.plan.gravity = gravity;
                for (int k = 0; k < 3; k++) s.gravity[k] = draw(-9, 9);
                assert_int_equal(evaluate_rates(&s, &error), STATUS_OK);
                for (int i = 0; i <= N; i++) {
                    double power = seen.de[i];
                    for (int k = 0; k < dim; k++) {
                        const double weight = gravity && i < N ? a->m[i] * s.gravity[k] : 0;
                        near_below(fabs(a->F[k][i] - (seen.F[k][i] + weight)), 1e-14);
                        power += total ? weight * a->p[k][i] / a->m[i] : 0;
                    }
                    near_below(fabs(a->de[i] - power), 1e-14);
                }
                particles_destroy(&s.particles);
            }
}

/* Who is held has the density that it began with, and no rates; where all went well so far. */
TEST(some_are_held)
{
    for (const char *fails = "_wf"; *fails; fails++) {
        struct simulation s;
        struct error error;
        double held[10 + N] = {0};
        begin(&s, 2, false);
        const struct particles *a = &s.particles;
        s.held = held, s.scheme.eta = 2, s.gamma = 1.5;
        held[14] = 2.5;
        seen.fails = *fails;
        evaluate_rates(&s, &error);
        for (int i = 0; i < N; i++) {
            assert_true(a->rho[i] == (i == 4 && *fails != 'w' ? 2.5 : 0));
            const bool moves = *fails != 'w' && (i != 4 || *fails == 'f');
            assert_true(a->F[0][i] == (moves ? seen.F[0][i] : 0));
            assert_true(a->de[i] == (moves ? seen.de[i] : 0));
        }
        particles_destroy(&s.particles);
    }
}

/* cfl over the largest signal speed / h, of those who sleep, too. */
TEST(time_is_limited)
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
