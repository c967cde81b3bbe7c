/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests sound waves as a problem: the wave that keys define, particles that carry its mass, its
 * mode, and how long the solution holds. (test_simple_wave.c tests the wave itself.) */
#include "test.h"

#include "lattice.h"
#include "prepared.h"
#include "simple_wave.h"

/* Waves in each dimension, and their parameters: gamma 1.6 and a background "1.3 0.4 0.7". */
static const struct row {
    int dim;
    const char *keys;
    double n[3], length, amplitude;
} rows[] = {
    {1, "lo=-1|hi=2|n=37|amplitude=0.5", {1}, 3, 0.5},
    {1, "lo=3|hi=52|n=64|amplitude=0.3|waves=3", {1}, 49 / 3., 0.3}, /* 1/(1/49) is not 49 */
    {2, "lo=-1 0|hi=1 1|n=128|amplitude=0.3|boost=0.5 -0.25", {1, 0}, 2, 0.3},
    {2,
     "lo=-1 0|hi=2 1|n=150|amplitude=0.5|direction=2 -1",
     {0.5547001962252291, -0.8320502943378437},
     0.8320502943378437,
     0.5},
    {2, "n=144|amplitude=0.2|direction=0 1|waves=2", {0, 1}, 1, 0.2},
    {3,
     "lo=0 0 0|hi=1 1 2|n=432|amplitude=0.4|direction=1 1 -2",
     {0.5773502691896258, 0.5773502691896258, -0.5773502691896258},
     0.5773502691896258,
     0.4},
};
enum { ROWS = sizeof rows / sizeof *rows };

static struct prepared made(const struct row *row, struct settings *settings)
{
    char keys[256];
    snprintf(keys, sizeof keys, "kind=sound_wave|gamma=1.6|background=1.3 0.4 0.7|%s", row->keys);
    return prepared_of(settings, row->dim, keys);
}

static struct simple_wave wave_of(const struct row *row)
{
    return (struct simple_wave){1.6, 1.3, 0.4, 0.7, row->amplitude, row->length};
}

static double along(const struct row *row, const struct prepared *p, const double x[3])
{
    double s = 0;
    for (int d = 0; d < row->dim; d++) s += row->n[d] * (x[d] - p->domain.lo[d]);
    return s;
}

TEST(samples_are_the_wave)
{
    for (const struct row *row = rows; row < rows + ROWS; row++) {
        struct settings s;
        const struct prepared p = made(row, &s);
        const struct simple_wave wave = wave_of(row);
        for (int i = 0; i < 30; i++) {
            double x[3] = {-0.7 + 0.21 * i, 0.3 * i, 1 - 0.1 * i};
            const double t = 0.01 * (i % 3);
            for (int d = row->dim; d < 3; d++) x[d] = (double)NAN; /* not a direction */
            const struct simple_wave_state want = simple_wave_sample(&wave, along(row, &p, x), t);
            struct problem_state have;
            p.problem->sample(&p, x, t, &have);
            if (row->dim == 1) { /* to the last bit */
                assert_true(have.rho == want.rho && have.v[0] == want.v && have.P == want.P);
                assert_true(have.u == want.u && have.v[1] == 0 && have.v[2] == 0);
            }
            near_relative(have.rho, want.rho, 1e-13);
            near_relative(have.P, want.P, 1e-13);
            near_relative(have.u, want.u, 1e-13);
            for (int d = 0; d < 3; d++) near_absolute(have.v[d] - (row->n[d] * want.v), 0, 1e-13);
        }
        const double breaks = simple_wave_breaking_time(&wave);
        assert_true(p.problem->holds(&p, breaks * (1 - 1e-12)));
        assert_false(p.problem->holds(&p, breaks * (1 + 1e-12)));
        if (row->dim == 1) assert_false(p.problem->holds(&p, breaks));
    }
}

/* All particles have the same mass. The mass from the corner to a particle along the wave is that
 * of uniform gas up to its lattice point. */
TEST(particles_carry_the_mass)
{
    for (const struct row *row = rows; row < rows + ROWS; row++) {
        struct settings s;
        const struct prepared p = made(row, &s);
        const struct initial initial = prepared_filled(&p, &s);
        const enum lattice kind = (enum lattice)settings_choice(&s, SETTING_lattice);
        const double k = 2 * M_PI / row->length;
        struct lattice_plan plan;
        struct error error;
        double *points[3], volume = 1;
        assert_int_equal(
            lattice_plan_make(&plan, &p.domain, kind, (size_t)settings_real(&s, SETTING_n), &error),
            0);
        const size_t n = plan.n;
        assert_true(initial.n == n && initial.dim == row->dim);
        for (int d = 0; d < 3; d++) points[d] = malloc(n * sizeof(double));
        assert_int_equal(lattice_points(&plan, 1, points, &error), 0);
        for (int d = 0; d < row->dim; d++) volume *= domain_length(&p.domain, d);
        for (size_t i = 0; i < n; i++) {
            double x[3] = {0}, point[3] = {0}, shift = 0;
            struct problem_state at;
            for (int d = 0; d < row->dim; d++) {
                x[d] = initial.x[d][i];
                point[d] = points[d][i];
                assert_true(x[d] >= p.domain.lo[d] && x[d] < p.domain.hi[d]);
            }
            p.problem->sample(&p, x, 0, &at);
            near_relative(initial.m[i], 1.3 * volume / (double)n, 1e-14);
            near_relative(initial.rho[i], at.rho, 1e-14);
            near_relative(initial.u[i], at.u, 1e-14);
            for (int d = 0; d < row->dim; d++) near_absolute(initial.v[d][i] - at.v[d], 0, 1e-14);
            /* the displacement from the lattice point, less whole boxes */
            for (int d = 0; d < row->dim; d++) {
                const double length = domain_length(&p.domain, d);
                double step = x[d] - point[d];
                step -= length * round(step / length);
                shift += row->n[d] * step;
            }
            const double at_point = along(row, &p, point), to = at_point + shift;
            near_absolute(to + row->amplitude * (1 - cos(k * to)) / k - at_point, 0,
                          1e-14 * (row->length + fabs(at_point)));
            for (int d = 0; d < row->dim; d++) { /* along the wave */
                const double length = domain_length(&p.domain, d);
                double across = x[d] - point[d] - shift * row->n[d];
                across -= length * round(across / length);
                near_absolute(across, 0, 1e-13 * length);
            }
        }
        for (int d = 0; d < 3; d++) free(points[d]);
        free(initial.storage);
    }
}

/* Newton's method makes at most fifty steps: for some particles the last steps alternate between
 * two numbers, and the bits of a run depend on where they stop. */
TEST(steps_are_counted)
{
    int restless = 0;
    for (const struct row *row = rows; row < rows + 2; row++) {
        struct settings s;
        const struct prepared p = made(row, &s);
        const struct initial initial = prepared_filled(&p, &s);
        const double lo = p.domain.lo[0], mass = 1.3 * (p.domain.hi[0] - lo) / (double)initial.n;
        const double length = domain_length(&p.domain, 0) / settings_real(&s, SETTING_waves);
        const double k = 2 * M_PI / length;
        for (size_t i = 0; i < initial.n; i++) {
            const double there = ((double)i + 0.5) * mass / 1.3;
            double x = there;
            int steps = 0;
            for (double step = 1; steps < 50 && fabs(step) > 1e-16 * length; steps++) {
                step = (x + row->amplitude * (1 - cos(k * x)) / k - there) /
                       (1 + row->amplitude * sin(k * x));
                x -= step;
            }
            restless += steps == 50;
            assert_true(initial.x[0][i] == lo + x);
        }
        free(initial.storage);
    }
    assert_true(restless > 0);
}

TEST(what_cannot_be_laid_is_said)
{
    for (int dim = 1; dim <= 3; dim++) {
        struct settings s;
        struct error error = {0};
        const struct prepared p = prepared_of(&s, dim, "kind=sound_wave");
        struct initial initial = {.n = 3}; /* from before */
        s.value[SETTING_n].real[0] = 0x1p53;
        assert_int_equal(p.problem->fill(&p, &s, &initial, &error), STATUS_ENVIRONMENT);
        s.value[SETTING_n].real[0] = 4;
        s.value[SETTING_lattice].choice = LATTICE_FCC;
        if (dim == 2) assert_int_equal(p.problem->fill(&p, &s, &initial, &error), STATUS_BAD_INPUT);
    }
}

/* ---- the wave's mode ---- */

/* Arbitrary points, and one more after the last; the boost is subtracted. */
TEST(modes_are_sums)
{
    enum { N = 40 };
    for (const struct row *row = rows; row < rows + ROWS; row++) {
        struct settings s;
        const struct prepared p = made(row, &s);
        const struct functional *mode = prepared_functional(&p, "mode_amplitude");
        double x[3][N + 1], rho[N + 1], volume[N + 1], a = 0, b = 0, sum = 0;
        const double t = 0.25;
        for (int i = 0; i <= N; i++) {
            double place[3] = {0};
            for (int d = 0; d < 3; d++) {
                const double lo = p.domain.lo[d],
                             length = d < row->dim ? domain_length(&p.domain, d) : 1;
                place[d] = x[d][i] = lo + length * fmod(0.37 * i * (d + 1) + 0.1, 1);
                place[d] -= p.boost[d] * t;
            }
            rho[i] = 1.3 * (1 + 0.2 * sin(5.1 * i));
            volume[i] = 1 + 0.3 * cos(7.7 * i);
            if (i == N) continue;
            const double phase = 2 * M_PI * along(row, &p, place) / row->length;
            a += volume[i] * (rho[i] - 1.3) * cos(phase);
            b += volume[i] * (rho[i] - 1.3) * sin(phase);
            sum += volume[i];
        }
        const struct snapshot of = {
            .n = N, .x = {x[0], x[1], x[2]}, .rho = rho, .volume = volume, .time = t};
        near_relative(mode->measure(&p, &of), 2 * sqrt(a * a + b * b) / sum / 1.3, 1e-12);
    }
}

/* The first coefficient of the wave's own Fourier series, whose initial value is the amplitude. */
TEST(modes_are_those_of_the_wave)
{
    enum { POINTS = 3000 };
    for (const struct row *row = rows; row < rows + ROWS; row++) {
        struct settings s;
        const struct prepared p = made(row, &s);
        const struct simple_wave wave = wave_of(row);
        const struct functional *mode = prepared_functional(&p, "mode_amplitude");
        const double t = 0.4 * simple_wave_breaking_time(&wave);
        double a = 0, b = 0;
        near_relative(mode->exact(&p, 0), row->amplitude, 1e-13);
        if (row->dim == 1 && row->length < domain_length(&p.domain, 0)) continue; /* > 1 wave */
        for (int i = 0; i < POINTS; i++) {
            const double way = i * row->length / POINTS, phase = 2 * M_PI * i / POINTS;
            const double swell = simple_wave_sample(&wave, way, t).rho / 1.3 - 1;
            a += 2 * swell * cos(phase) / POINTS;
            b += 2 * swell * sin(phase) / POINTS;
        }
        near_relative(mode->exact(&p, t), hypot(a, b), 1e-12);
    }
}
