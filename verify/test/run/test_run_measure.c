/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the end of a run is measured by, on gas and particles that are made here: errors of the
 * particles in the window against the exact state where they are, fields that look like another
 * one, budgets and functionals. */
#include "test.h"

#include <math.h>
#include <string.h>

#include "functional.h"
#include "near.h"
#include "run.h"
#include "run_part.h"

enum { N = 7 }; /* and one behind the last, which is none of them */
static const double x[2][N + 1] = {{-0.9, -0.3, -0.1, 0.15, 0.3, 0.45, 0.8, 0.2},
                                   {0.1, 0.4, 0.2, -0.3, 0.25, 0.9, 0, 0.1}};
static double v[2][N + 1], m[N + 1], rho[N + 1], u[N + 1], P[N + 1], h[N + 1], volume[N + 1];
static struct problem problem;

static void sample(const struct prepared *p, const double at[3], double t, struct problem_state *s)
{
    (void)p;
    *s = (struct problem_state){.rho = 2 + at[0] + 1e6 * at[2],
                                .v = {5 + at[0] * at[0] + at[1], 0.5 - at[1], 1e6 * at[2]},
                                .P = 10 + at[0] + t,
                                .u = 20 - at[0]};
}

/* Of a case with another gas; density and so on are off by a few per cent. */
static void make(struct run_result *result, const char *name, int dim)
{
    struct run_settings settings;
    struct run run;
    struct error error;
    if (run_prepare(&settings, name, 0, NULL, &error) || run_resolve(&run, &settings, &error))
        fail_msg("%s", error.message);
    *result = (struct run_result){.settings = run.settings, .problem = run.problem, .n = N};
    problem = *run.problem.problem;
    problem.sample = sample;
    problem.regions = NULL;
    result->problem.problem = &problem;
    result->problem.window =
        (struct window){.dim = dim, .lo = {-0.35, -0.5}, .hi = {0.5, 0.5}, .centre = {0.075, 0}};
    result->problem.domain = (struct domain){dim, {-1, -1}, {1, 1}};
    result->time = 0.25;
    for (int i = 0; i <= N; i++) {
        struct problem_state s;
        sample(NULL, (double[3]){x[0][i], dim > 1 ? x[1][i] : 0}, 0.25, &s);
        rho[i] = s.rho + 0.01 * i, P[i] = s.P - 0.02 * i, u[i] = s.u + 0.03 * i * i;
        v[0][i] = s.v[0] - 0.01 * i * i, v[1][i] = s.v[1] + 0.02 * i;
        m[i] = 1 + i, h[i] = 0.1 * (i + 1), volume[i] = 0.1 + 0.03 * i;
    }
    result->snapshot = (struct snapshot){.n = N,
                                         .x = {x[0], x[1]},
                                         .v = {v[0], v[1]},
                                         .m = m,
                                         .rho = rho,
                                         .u = u,
                                         .P = P,
                                         .h = h,
                                         .volume = volume,
                                         .time = 0.25};
}

static void same_norms(const struct norms *a, const struct norms *b)
{
    assert_true(a->l1_whole == b->l1_whole && a->l2 == b->l2 && a->linf == b->linf &&
                a->particle_mean == b->particle_mean && a->n == b->n && a->n > 0);
}

/* What of [at - side/2, at + side/2] lies in [lo, hi], over side. */
static double share(double at, double side, double lo, double hi)
{
    const double length = fmin(at + side / 2, hi) - fmax(at - side / 2, lo);
    return length > 0 ? length / side : 0;
}

static void exact_fields(int dim, double exact[FIELDS][N])
{
    for (int i = 0; i < N; i++) {
        struct problem_state s;
        sample(NULL, (double[3]){x[0][i], dim > 1 ? x[1][i] : 0}, 0.25, &s);
        exact[0][i] = s.rho, exact[1][i] = s.v[0], exact[2][i] = s.P, exact[3][i] = s.u;
    }
}

TEST(on_a_line)
{
    struct run_result result;
    struct error error = {0};
    double exact[FIELDS][N], means[NORM_BINS];
    const double window[2] = {-0.35, 0.5};
    make(&result, "sod", 1);
    exact_fields(1, exact);
    assert_int_equal(run_measure_errors(&result, &error), STATUS_OK);
    const double *const measured[] = {rho, v[0], P, u};
    for (int f = 0; f < FIELDS; f++) {
        const struct norms want = norm_errors(N, x[0], window, volume, measured[f], exact[f]);
        same_norms(&result.errors[f], &want);
        double part[N];
        for (int i = 0; i < N; i++)
            part[i] = volume[i] * share(x[0][i], volume[i], window[0], window[1]);
        near_relative(result.errors[f].l1, norm_l1(N, part, measured[f], exact[f]), 1e-13);
        assert_true(result.errors[f].l1 > 0 && result.errors[f].l1 != want.l1_whole);
    }
    problem_means(&result.problem, FIELD_DENSITY, 0.25, NORM_BINS, means);
    assert_true(result.binned_density_l1 ==
                norm_binned_l1(N, x[0], window, volume, rho, NORM_BINS, means));
    assert_true(isnan(result.azimuthal.l1) && isnan(result.radial.l1));
    assert_true(!result.budget.regions && !result.suspicion[0]);
}

/* In a plane: those of the vector, of particles in the window; parts of a flow that goes round. */
TEST(in_a_plane)
{
    static const char *const cases[] = {"square", "gresho"};
    for (int round = 0; round < 2; round++) {
        struct run_result result;
        struct error error = {0};
        double exact[FIELDS][N], places[N], none[N] = {0}, jump[N], parts[4][N], part[N];
        const double inside[2] = {-1, 1};
        make(&result, cases[round], 2);
        exact_fields(2, exact);
        for (int i = 0; i < N; i++) {
            struct problem_state s;
            const double dx = x[0][i] - 0.075, dy = x[1][i], R = hypot(dx, dy);
            sample(NULL, (double[3]){x[0][i], x[1][i]}, 0.25, &s);
            places[i] = x[0][i] >= -0.35 && x[0][i] <= 0.5 && fabs(x[1][i]) <= 0.5 ? 0 : 2;
            const double a = v[0][i] - s.v[0], b = v[1][i] - s.v[1];
            jump[i] = sqrt(a * a + b * b);
            const double side = sqrt(volume[i]); /* no image reaches into the window */
            part[i] =
                volume[i] * share(x[0][i], side, -0.35, 0.5) * share(x[1][i], side, -0.5, 0.5);
            parts[0][i] = (dx * v[1][i] - dy * v[0][i]) / R;
            parts[1][i] = (dx * s.v[1] - dy * s.v[0]) / R;
            parts[2][i] = dx / R * v[0][i] + dy / R * v[1][i];
            parts[3][i] = dx / R * s.v[0] + dy / R * s.v[1];
        }
        assert_int_equal(run_measure_errors(&result, &error), STATUS_OK);
        const double *const measured[] = {rho, jump, P, u};
        for (int f = 0; f < FIELDS; f++) {
            const struct norms want =
                norm_errors(N, places, inside, volume, measured[f], f == 1 ? none : exact[f]);
            same_norms(&result.errors[f], &want);
            assert_int_equal(want.n, 4);
            near_relative(result.errors[f].l1,
                          norm_l1(N, part, measured[f], f == 1 ? none : exact[f]), 1e-13);
        }
        assert_true(isnan(result.binned_density_l1));
        if (round == 1) {
            const struct norms azimuthal =
                                   norm_errors(N, places, inside, volume, parts[0], parts[1]),
                               radial = norm_errors(N, places, inside, volume, parts[2], parts[3]);
            near_relative(result.azimuthal.l1, norm_l1(N, part, parts[0], parts[1]), 1e-13);
            near_relative(result.azimuthal.l1_whole, azimuthal.l1, 1e-13);
            near_relative(result.radial.l1, norm_l1(N, part, parts[2], parts[3]), 1e-13);
            near_relative(result.radial.l2, radial.l2, 1e-13);
        } else {
            assert_true(isnan(result.azimuthal.l1) && isnan(result.radial.l1));
        }
        /* a particle that is nowhere has no error that is a number */
        double lost[N];
        memcpy(lost, x[1], sizeof lost);
        lost[6] = (double)NAN;
        result.snapshot.x[1] = lost;
        assert_int_equal(run_measure_errors(&result, &error), STATUS_OK);
        assert_true(isnan(result.errors[FIELD_DENSITY].l1) &&
                    isnan(result.errors[FIELD_VELOCITY].linf));
    }
}

/* What lies in a large volume counts for more, also where fields have changed places. */
TEST(large_ones_count)
{
    for (int large = 0; large < 2; large++) {
        struct run_result result;
        struct error error = {0};
        make(&result, "sod", 1);
        result.problem.window.lo[0] = -1; /* the first one, too */
        for (int i = 0; i < 5; i += 4) {
            const double kept = rho[i];
            rho[i] = P[i], P[i] = kept;
            volume[i] = large ? 1000 : 1e-3;
        }
        assert_int_equal(run_measure_errors(&result, &error), STATUS_OK);
        assert_int_equal(result.suspicion[0] != 0, large);
    }
}

static double far_more(const struct prepared *p, double r, double t)
{
    return p->domain.dim * 100 + r + t;
}

/* Where an energy has no bound: a particle whose own ball holds the middle is compared with the
 * mean over that ball; who only touches it is not. */
TEST(means_round_the_middle)
{
    for (int dim = 1; dim <= 2; dim++) {
        struct run_result result;
        struct error error = {0};
        double want[N], places[N];
        const double window[2] = {-1, 1};
        int inside = 0;
        make(&result, dim == 1 ? "sod" : "square", dim);
        problem.mean_energy = far_more;
        result.problem.window.centre[0] = 0;
        for (int i = 0; i < N; i++) {
            volume[i] = dim == 1 ? 0.25 * (i + 1) : 0.125 * (i + 1);
            if (dim == 1 && i == 3) volume[i] = 2 * x[0][i];
            struct problem_state s;
            sample(NULL, (double[3]){x[0][i], dim > 1 ? x[1][i] : 0}, 0.25, &s);
            const double r = dim == 1 ? fabs(x[0][i]) : hypot(x[0][i], x[1][i]);
            const double reach = dim == 1 ? volume[i] / 2 : sqrt(volume[i] / M_PI);
            want[i] = r < reach ? 100 * dim + reach + 0.25 : s.u;
            places[i] =
                window_contains(&result.problem.window, (double[3]){x[0][i], dim > 1 ? x[1][i] : 0})
                    ? 0
                    : 2;
            inside += places[i] < 1 && r < reach;
        }
        assert_in_range(inside, 1, 3);
        assert_int_equal(run_measure_errors(&result, &error), STATUS_OK);
        const struct norms of = norm_errors(N, places, window, volume, u, want);
        near_relative(result.errors[FIELD_INTERNAL_ENERGY].l1_whole, of.l1, 1e-13);
        near_relative(result.errors[FIELD_INTERNAL_ENERGY].linf, of.linf, 1e-13);
    }
}

/* Where no field is known there are no errors. */
TEST(nothing)
{
    struct run_result result;
    struct error error = {0};
    make(&result, "kelvin_helmholtz_mode", 2);
    result.binned_density_l1 = 1;
    assert_int_equal(run_measure_errors(&result, &error), STATUS_OK);
    for (int f = 0; f < FIELDS; f++)
        for (int k = 0; k < NORMS; k++)
            assert_true(isnan(run_error(&result, (enum field)f, (enum norm)k)));
    assert_true(isnan(result.binned_density_l1) && isnan(result.azimuthal.l2) &&
                isnan(result.radial.linf));
}

static double measure_two(const struct prepared *p, const struct snapshot *s)
{
    (void)p;
    return 2 * s->rho[0];
}

static double exact_three(const struct prepared *p, double t)
{
    (void)p;
    return 3 + t;
}

static bool absent(const struct prepared *p)
{
    (void)p;
    return false;
}

static bool present(const struct prepared *p)
{
    (void)p;
    return true;
}

static double four(const struct prepared *p)
{
    (void)p;
    return 4;
}

/* Those that the problem has with these settings, in their order; at last the rate of growth. */
TEST(functionals)
{
    static const struct functional known = {"known", present, measure_two, exact_three},
                                   missing = {"missing", absent, measure_two, NULL},
                                   unknown = {"unknown", NULL, measure_two, NULL};
    static const struct growing growing = {.name = "rate", .rate = four};
    struct run_result result;
    for (int grows = 0; grows < 2; grows++) {
        make(&result, "sod", 1);
        memset(problem.functionals, 0, sizeof problem.functionals);
        problem.functionals[0] = &missing;
        problem.functionals[1] = &known;
        problem.functionals[2] = &unknown;
        problem.growing = grows ? &growing : NULL;
        for (int k = 0; k < 4; k++) growth_see(&result.growth, k, exp(1.5 * k));
        run_measure_functionals(&result);
        const struct run_functional *f = result.functionals;
        assert_int_equal(result.functional_count, 2 + grows);
        assert_string_equal(f[0].name, "known");
        assert_string_equal(f[1].name, "unknown");
        assert_true(f[0].value == 2 * rho[0] && f[0].exact == 3.25);
        assert_true(f[1].value == 2 * rho[0] && isnan(f[1].exact));
        if (grows) {
            assert_string_equal(f[2].name, "rate");
            near_relative(f[2].value, 1.5, 1e-12);
            assert_true(f[2].exact == 4);
        }
        assert_true(result.h ==
                    functional_window_mean(&result.problem, &result.snapshot, result.snapshot.h));
        assert_true(result.h > 0);
    }
}
