/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests a simulation apart from its integrator: which setups it accepts, its initial state, sums
 * over its particles, the length of a step, and the message of a breakdown. */
#include "test.h"

#include "draw.h"
#include "breakdown.h"
#include "sample_simulation.h"
#include "solver.h"

typedef long double real;

/* --- setups ----------------------------------------------------------------------------------- */

enum { SIDE = 8, N = SIDE * SIDE };

/* and one more that must not count */
static double x[3][N + 1], v[3][N + 1], m[N + 1], u[N + 1], rho[N + 1];

/* N particles on an uneven lattice of the box [-1, 3] x [0.5, 2.5], or along its first side. */
static struct setup plain(int dim, const char *keys)
{
    struct setup setup = {.dim = dim,
                          .lo = {-1, 0.5},
                          .hi = {3, 2.5},
                          .gamma = 1.5,
                          .t_end = 1,
                          .n = N,
                          .m = m,
                          .u = u,
                          .threads = 1};
    const int side = dim == 1 ? N : SIDE;
    for (int i = 0; i < N; i++) {
        for (int k = 0, rest = i; k < dim; k++, rest /= side) {
            const double part = ((rest % side) + 0.5 + draw(-0.1, 0.1)) / side;
            x[k][i] = setup.lo[k] + part * (setup.hi[k] - setup.lo[k]);
            v[k][i] = draw(-0.5, 0.5);
        }
        m[i] = draw(0.9, 1.1), u[i] = draw(0.8, 1.2), rho[i] = draw(3, 5);
    }
    for (int k = 0; k < dim; k++) setup.x[k] = x[k], setup.v[k] = v[k], x[k][N] = v[k][N] = 7;
    m[N] = u[N] = rho[N] = 7;
    setup.scheme = keyed_scheme(dim, keys);
    return setup;
}

static const char few_neighbours[] = "kernel=cubic_spline eta=2.4";

static struct simulation *created(const struct setup *setup)
{
    struct simulation *simulation = NULL;
    struct error error;
    if (simulation_create(setup, &simulation, &error)) fail_msg("%s", error.message);
    return simulation;
}

static void refused(const struct setup *setup, const char *message)
{
    struct simulation *simulation = (struct simulation *)(uintptr_t)1;
    struct error error = {0};
    assert_int_equal(simulation_create(setup, &simulation, &error), STATUS_BAD_INPUT);
    assert_string_equal(error.message, message);
    assert_null(simulation);
}

/* Sets a value of the setup for one attempt, which must be refused with this message. */
static void refused_with(const struct setup *setup, double *place, double value, const char *said)
{
    const double kept = *place;
    *place = value;
    refused(setup, said);
    *place = kept;
}

TEST(setups_that_are_refused)
{
    for (int dim = 1; dim <= 2; dim++) {
        struct setup setup = plain(dim, few_neighbours);
        setup.dim = 0;
        refused(&setup, "dimension = 0: the solver is for dimension 1");
        setup.dim = 4;
        refused(&setup, "dimension = 4: the solver is for dimension 1");
        setup.dim = dim;
        setup.n = 1;
        refused(&setup, "n = 1: at least 2 particles");
        setup.n = N;
        refused_with(&setup, &setup.gamma, 1, "gamma = 1: must be > 1");
        refused_with(&setup, &setup.gamma, INFINITY, "gamma = inf: must be > 1");
        refused_with(&setup, &setup.gamma, NAN, "gamma = nan: must be > 1");
        refused_with(&setup, &setup.hi[0], -1, "box [-1, -1]: must have a positive length");
        refused_with(&setup, &setup.lo[0], 5, "box [5, 3]: must have a positive length");
        refused_with(&setup, &setup.hi[0], INFINITY, "box [-1, inf]: must have a positive length");
        refused_with(&setup, &setup.hi[0], NAN, "box [-1, nan]: must have a positive length");
        refused_with(&setup, &x[0][7], nextafter(3, 4), "particle 7: x = 3 is outside the box");
        refused_with(&setup, &x[0][7], nextafter(-1, -2), "particle 7: x = -1 is outside the box");
        refused_with(&setup, &x[0][0], NAN, "particle 0: x = nan is outside the box");
        refused_with(&setup, &v[0][N - 1], NAN, "particle 63: velocity nan");
        refused_with(&setup, &v[0][N - 1], INFINITY, "particle 63: velocity inf");
        refused_with(&setup, &m[3], 0, "particle 3: mass 0 must be > 0");
        refused_with(&setup, &m[3], -2, "particle 3: mass -2 must be > 0");
        refused_with(&setup, &m[3], INFINITY, "particle 3: mass inf must be > 0");
        refused_with(&setup, &u[4], 0, "particle 4: specific internal energy 0 must be > 0");
        refused_with(&setup, &u[4], INFINITY,
                     "particle 4: specific internal energy inf must be > 0");
        refused_with(&setup, &setup.gravity[0], dim == 1 ? -9 : INFINITY,
                     dim == 1 ? "gravity = -9: finite, and 0 in 1 dimension, is needed"
                              : "gravity = inf: finite, and 0 in 1 dimension, is needed");
        refused_with(&setup, &setup.scheme.cfl, 0, "cfl = 0: cfl must be positive and finite");
    }
    struct setup plane = plain(2, few_neighbours);
    refused_with(&plane, &x[1][9], 2.75, "particle 9: y = 2.75 is outside the box");
    plane.boundary[1] = BOUNDARY_OPEN;
    refused_with(&plane, &x[1][9], INFINITY, "particle 9: y = inf is outside the box");
    refused_with(&plane, &x[0][9], 3.5, "particle 9: x = 3.5 is outside the box");
    x[1][9] = 2.75;
    simulation_destroy(created(&plane)); /* no position is outside of an open box */
}

/* The ends of a box belong to it; two particles are enough. */
TEST(setups_that_are_accepted)
{
    for (int dim = 1; dim <= 2; dim++) {
        struct setup setup = plain(dim, few_neighbours);
        x[0][0] = -1, x[0][7] = 3;
        setup.gamma = 1 + 1e-9;
        simulation_destroy(created(&setup));
    }
    struct setup two = plain(1, "");
    two.n = 2;
    simulation_destroy(created(&two));
}

/* The initial state of a simulation, and its threads. */
TEST(the_state_of_a_setup)
{
    static const char *const schemes[] = {
        "energy=total viscosity=constant",
        "energy=internal viscosity=constant",
        "energy=internal viscosity=time_dependent",
        "energy=internal viscosity=cullen_dehnen",
    };
    for (int dim = 1; dim <= 2; dim++)
        for (size_t k = 0; k < 4; k++) {
            if (dim == 1 && k == 3) continue;
            struct setup setup = plain(dim, schemes[k]);
            setup.threads = (int)k - 1;
            setup.boundary[1] = BOUNDARY_REFLECTING;
            setup.gravity[1] = -0.5;
            struct simulation *s = created(&setup);
            const struct particles *a = &s->particles;
            assert_true(s->team.most == (setup.threads > 1 ? setup.threads : 1));
            assert_true(s->team.size == s->team.most && s->gamma == 1.5);
            assert_true(s->lo[0] == -1 && a->period[0] == 4);
            if (dim == 2) {
                assert_true(s->lo[1] == 0.5 && a->period[1] == 2);
                assert_true(s->boundary[1] == BOUNDARY_REFLECTING && s->gravity[1] == -0.5);
            }
            for (int i = 0; i < N; i++) {
                const size_t id = a->id[i];
                double e = m[id] * u[id];
                for (int d = 0; d < dim; d++) {
                    assert_true(fabs(remainder(a->x[d][i] - x[d][id], 4)) < 1e-14);
                    assert_true(a->x_old[d][i] == a->x[d][i] && a->p[d][i] == m[id] * v[d][id]);
                    if (k == 0) e += 0.5 * m[id] * v[d][id] * v[d][id];
                }
                near_relative(a->e[i], e, 1e-15);
                assert_true(a->m[i] == m[id] && a->m_inverse[i] == 1 / m[id]);
                const double alpha = k >= 2     ? setup.scheme.alpha_min
                                     : dim == 1 ? setup.scheme.alpha
                                                : 0;
                assert_true(a->alpha[i] == alpha && a->alpha_old[i] == alpha);
            }
            if (dim == 2) assert_true(a->p[0][N] == 0 && a->e[N] == 0 && a->x_old[0][N] == 0);
            struct conservation sums;
            conservation_sums(s, &sums);
            assert_true(s->start_energy == sums.energy);
            simulation_destroy(s);
        }
}

/* Widths of three coincident particles are guessed as if they were a thousandth of their spacing
 * apart; the spacing is that of the setup's density or, without one, of the mean density. */
TEST(the_first_guess_of_widths)
{
    for (int known = 0; known < 3; known++) {
        struct setup setup = plain(1, "kernel=quadratic_spline eta=1.5");
        double mass = 0;
        for (int i = 0; i < N; i++) m[i] = 0.5 + i % 3, mass += m[i];
        x[0][11] = x[0][12] = x[0][10];
        rho[10] = known == 2 ? 0 : 1e3;
        if (known) setup.rho = rho;
        struct simulation *s = created(&setup);
        const double *at = s->particles.x[0];
        int first = 0;
        while (s->particles.id[first] != 10) first++;
        const double apart = 1e-3 * m[10] / (known == 1 ? 1e3 : mass / 4);
        near_relative(at[first + 2] - at[first], 2 * apart, 2e-9);
        simulation_destroy(s);
    }
}

/* --- sums over the particles ------------------------------------------------------------------ */

/* A simulation of n particles at arbitrary positions, with all values that the sums read. */
static void scattered(struct simulation *s, int dim, ptrdiff_t n)
{
    struct error error;
    memset(s, 0, sizeof *s);
    if (particles_create(&s->particles, dim, n, 0, &error)) fail_msg("%s", error.message);
    struct particles *a = &s->particles;
    s->plan.dim = dim;
    s->time = 0.375;
    for (int k = 0; k < dim; k++) {
        s->lo[k] = draw(-1, 1), a->period[k] = draw(1, 2), s->gravity[k] = draw(-1, 1);
        s->wrapped[k] = malloc((size_t)(n + 1) * sizeof(double));
        for (ptrdiff_t i = 0; i < n; i++) {
            a->x[k][i] = draw(-9, 9), a->v[k][i] = draw(-1, 1), a->p[k][i] = draw(-1, 1);
            a->F[k][i] = draw(-1, 1);
        }
    }
    for (ptrdiff_t i = 0; i < n; i++) {
        a->m[i] = draw(0.5, 2), a->m_inverse[i] = 1 / a->m[i], a->h[i] = draw(0.5, 2);
        a->h_inverse[i] = 1 / a->h[i], a->c[i] = draw(1, 2), a->e[i] = draw(1, 2);
        a->U[i] = draw(1, 2), a->id[i] = (size_t)(n - i);
    }
}

static void gone(struct simulation *s)
{
    particles_destroy(&s->particles);
    for (int k = 0; k < 3; k++) free(s->wrapped[k]);
}

static void near_sum(double got, real want, real size)
{
    near_below(fabs(got - (double)want), 4e-16 * (double)size);
}

TEST(conserved_sums)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int total = 0; total < 2; total++)
            for (int walls = 0; walls < 2; walls++) {
                struct simulation s;
                struct conservation sums;
                scattered(&s, dim, 40);
                const struct particles *a = &s.particles;
                s.scheme.energy = total ? ENERGY_TOTAL : ENERGY_INTERNAL;
                if (walls) s.boundary[dim - 1] = BOUNDARY_REFLECTING;
                conservation_sums(&s, &sums);
                real mass = 0, energy = 0, p[3] = {0}, L[3] = {0}, size = 0, sound = 0, turning = 0,
                     far = 0;
                for (int i = 0; i < 40; i++) {
                    real r[3] = {0}, q[3] = {0}, square = 0, away = 0;
                    mass += a->m[i], sound += (real)a->m[i] * a->c[i], energy += a->e[i];
                    for (int k = 0; k < dim; k++) {
                        const bool wraps = !walls || k < dim - 1;
                        r[k] = (real)a->x[k][i] - s.lo[k];
                        if (wraps) r[k] -= a->period[k] * floorl(r[k] / a->period[k]);
                        r[k] -= (real)a->period[k] / 2;
                        q[k] = a->p[k][i];
                        p[k] += q[k], square += q[k] * q[k], away += r[k] * r[k];
                        energy -= (real)a->m[i] * s.gravity[k] * a->x[k][i];
                    }
                    if (!total) energy += square / 2 / a->m[i];
                    size += sqrtl(square), far += sqrtl(away) * a->m[i] * a->c[i];
                    real l[3], moment = 0;
                    for (int k = 0; k < 3; k++) {
                        l[k] = r[(k + 1) % 3] * q[(k + 2) % 3] - r[(k + 2) % 3] * q[(k + 1) % 3];
                        L[k] += l[k], moment += l[k] * l[k];
                    }
                    turning += sqrtl(moment);
                }
                near_sum(sums.mass, mass, mass);
                near_sum(sums.sound_scale, sound, sound);
                near_sum(sums.momentum_scale, size, size);
                near_sum(sums.energy, energy, 1e3);
                for (int k = 0; k < 3; k++) near_sum(sums.momentum[k], p[k], size);
                if (dim == 1) far = turning = L[0] = L[1] = L[2] = 0;
                near_sum(sums.angular_scale, turning, 20 * turning);
                near_sum(sums.turning_scale, far, 20 * far);
                for (int k = 0; k < 3; k++) near_sum(sums.angular_momentum[k], L[k], 40 * turning);
                gone(&s);
            }
}

TEST(snapshots_are_wrapped)
{
    for (int dim = 1; dim <= 3; dim++) {
        struct simulation s;
        struct snapshot snapshot;
        scattered(&s, dim, 40);
        struct particles *a = &s.particles;
        s.boundary[dim - 1] = dim > 1 ? BOUNDARY_OPEN : BOUNDARY_PERIODIC;
        s.lo[0] = 0, a->period[0] = 0.75;
        a->x[0][0] = 0, a->x[0][1] = -1e-20, a->x[0][2] = 0.75;
        a->spare[40] = 77;
        for (int k = 0; k < dim; k++) s.wrapped[k][40] = 77;
        simulation_snapshot(&s, &snapshot);
        assert_true(snapshot.n == 40 && snapshot.time == 0.375 && snapshot.id == a->id);
        assert_true(snapshot.m == a->m && snapshot.rho == a->rho && snapshot.P == a->P);
        assert_true(snapshot.h == a->h && snapshot.volume == a->V);
        for (int k = 0; k < 3; k++) {
            assert_true(snapshot.v[k] == a->v[k] && (snapshot.x[k] != NULL) == (k < dim));
            for (int i = 0; k < dim && i < 40; i++) {
                if (s.boundary[k] == BOUNDARY_OPEN) {
                    assert_true(snapshot.x[k][i] == a->x[k][i]);
                    continue;
                }
                const double past = snapshot.x[k][i] - s.lo[k];
                assert_true(past >= 0 && past < a->period[k]);
                near_below(fabs(remainder(snapshot.x[k][i] - a->x[k][i], a->period[k])), 1e-14);
            }
        }
        for (int i = 0; i < 3; i++) assert_true(snapshot.x[0][i] == 0);
        assert_true(a->spare[40] == 77); /* beyond the particles */
        for (int k = 0; k < dim; k++) assert_true(s.wrapped[k][40] == 77);
        for (int i = 0; i < 40; i++) assert_true(snapshot.u[i] == a->U[i] * a->m_inverse[i]);
        for (int evolves = 0; evolves < 2; evolves++) {
            struct rates rates;
            s.plan.alpha = evolves;
            s.time_step = 0.625;
            simulation_rates(&s, &rates);
            for (int k = 0; k < 3; k++) assert_true(rates.force[k] == a->F[k]);
            assert_true(rates.energy == a->de && rates.time_step == 0.625);
            assert_true(rates.alpha == (evolves ? a->dalpha : NULL));
        }
        gone(&s);
    }
}

/* --- the length of a step --------------------------------------------------------------------- */

TEST(steps_meet_the_end)
{
    struct simulation s;
    scattered(&s, 2, 40);
    s.time = 3, s.t_end = 5, s.dt = 0.5;
    static const struct {
        double limit, time, step;
    } rows[] = {
        {0.9999999, 3, 0.9999999},
        {0.25, 3, 0.25},
        {0.25, 4.5, 0.25},
        {0.25, 4.50001, 0.5 * (5 - 4.50001)},
        {1, 3, 1},
        {1.0001, 3, 1},
        {1.9, 3, 1},
        {2, 3, 2},
        {9, 3, 2},
        {9, 5, 0},
        {9, 6, 0},
        {0.1, 5, 0},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        s.time_step = rows[k].limit;
        assert_true(simulation_next_step(&s, rows[k].time) == rows[k].step);
    }
    assert_true(simulation_time_after(&s, 1.5) == 4.5 && simulation_time_after(&s, 2) == 5);
    assert_true(simulation_time_after(&s, 7) == 5);
    for (int k = 0; k < 99; k++) { /* exactly t_end, although t_end - time is rounded */
        s.time = draw(0, 1), s.t_end = draw(1, 9);
        assert_true(simulation_time_after(&s, s.t_end - s.time) == s.t_end);
    }
    gone(&s);
}

/* The first step is at most cfl sqrt(h/a) and, if the integrator sets first_step, at most that part
 * of the limit. */
TEST(the_first_step)
{
    for (int way = 0; way < 9; way++) {
        const int dim = 1 + way % 3, strong = way < 3 ? 20 : way < 6 ? 0 : 39;
        struct simulation s;
        scattered(&s, dim, 40);
        const struct particles *a = &s.particles;
        struct integrator integrator = {0};
        a->F[0][strong] = 50;
        a->F[0][40] = 1e9, a->m_inverse[40] = a->h_inverse[40] = 1; /* beyond the particles */
        real pull = 0;
        for (int i = 0; i < 40; i++) {
            real square = 0;
            for (int k = 0; k < dim; k++) square += (real)a->F[k][i] * a->F[k][i];
            pull = fmaxl(pull, sqrtl(square) / a->m[i] / a->h[i]);
        }
        const double most = 0.3 / sqrt((double)pull);
        s.t_end = 100, s.scheme.cfl = 0.3, s.scheme.integrator = &integrator;
        for (int part = 0; part < 2; part++) {
            integrator.first_step = 0.25 * part;
            const double of = part ? 0.25 : 1;
            s.time_step = 1.001 * most / of;
            near_relative(simulation_next_step(&s, 0), most, 1e-14);
            s.time_step = 0.999 * most / of;
            near_relative(simulation_next_step(&s, 0), 0.999 * most, 1e-14);
        }
        for (int i = 0; i < 40; i++) /* without forces */
            for (int k = 0; k < dim; k++) a->F[k][i] = 0;
        s.time_step = 4e8, s.t_end = 1e12;
        assert_true(simulation_next_step(&s, 0) == 1e8);
        gone(&s);
    }
}

TEST(positions_are_named_in_messages)
{
    static const char *const said[] = {
        "broke down at t = 0.375: heat of particle 35 at x = 0.5 is -3.25",
        "broke down at t = 0.375: heat of particle 35 at x = 0.5, y = -1.25 is -3.25",
        "broke down at t = 0.375: heat of particle 35 at x = 0.5, y = -1.25, z = 1e-300 is -3.25",
    };
    for (int dim = 1; dim <= 3; dim++) {
        struct simulation s;
        struct error error;
        const double at[] = {0.5, -1.25, 1e-300};
        scattered(&s, dim, 40);
        for (int k = 0; k < dim; k++) s.particles.x[k][5] = at[k];
        assert_int_equal(breakdown_of(&s, 5, "heat", -3.25, &error), STATUS_BROKE_DOWN);
        assert_string_equal(error.message, said[dim - 1]);
        gone(&s);
    }
}
