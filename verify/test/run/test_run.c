/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests a run apart from its physics: its setup, final particles in their initial order, conserved
 * quantities, progress callbacks; and states of other codes. */
#include "test.h"

#include <sys/resource.h>

#include "initial.h"
#include "keyed.h"
#include "own_folder.h"
#include "run_part.h"

/* ---- before the run ---- */

TEST(setups_of_runs)
{
    static const char *const cases[] = {"sod", "rayleigh_taylor_mode", "rest_3d"};
    static const char *const keys[] = {"n=40 t_end=0.01 skip=none", "n=16^2 t_end=0.01 skip=auto",
                                       "n=4^3 skip=auto boundary=periodic,periodic,reflecting"};
    for (int k = 0; k < 3; k++) {
        struct run run = keyed_run(cases[k], keys[k]);
        assert_int_equal(run.asked.threads, 1);
        assert_string_equal(run.asked.file.name, cases[k]);
        double arrays[9][1];
        const struct initial initial = {.n = 5,
                                        .x = {arrays[0], arrays[1], arrays[2]},
                                        .v = {arrays[3], arrays[4], arrays[5]},
                                        .m = arrays[6],
                                        .u = arrays[7],
                                        .rho = arrays[8]};
        run.asked.threads = 3;
        run.asked.generic = k == 1;
        const struct setup setup = run_setup(&run, &initial);
        assert_true(setup.dim == run.problem.domain.dim && setup.n == 5 && setup.threads == 3);
        for (int d = 0; d < 3; d++) {
            assert_true(setup.lo[d] == run.problem.domain.lo[d] &&
                        setup.hi[d] == run.problem.domain.hi[d]);
            assert_true(setup.boundary[d] == run.problem.boundary[d] &&
                        setup.gravity[d] == run.problem.gravity[d]);
            assert_true(setup.x[d] == arrays[d] && setup.v[d] == arrays[3 + d]);
        }
        assert_true(setup.m == arrays[6] && setup.u == arrays[7] && setup.rho == arrays[8]);
        assert_true(setup.gamma == run.problem.gamma && setup.skip == (k > 0) &&
                    setup.generic == (k == 1));
        assert_true(setup.t_end == settings_real(&run.settings, SETTING_t_end));
        assert_true(setup.scheme.eta == run.scheme.eta);
    }
    assert_true(keyed_run(cases[1], keys[1]).problem.gravity[1] != 0);
    assert_int_equal(keyed_run(cases[2], keys[2]).problem.boundary[2], BOUNDARY_REFLECTING);
    struct run_settings settings;
    struct error error = {0};
    assert_int_equal(run_prepare(&settings, "no_such", 0, NULL, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "no_such"));
}

static struct run_result explained(const struct run *run)
{
    struct run_result result;
    struct error error;
    if (run_explain(run, &result, &error)) fail_msg("%s", error.message);
    return result;
}

/* Snapshots during the run take memory, too; a glass reports its quality if the box is periodic. */
TEST(explanations)
{
    struct snapshots snapshots = {.path = "a.csv", .every = 0.1};
    for (int dense = 0; dense < 2; dense++) {
        struct run run = keyed_run("rest_2d", dense ? "n=10^2 lattice=glass background=4,0,1"
                                                    : "n=10^2 lattice=glass");
        const size_t n = 100;
        const struct run_result plain = explained(&run);
        run.asked.snapshots = &snapshots;
        const struct run_result with = explained(&run);
        assert_int_equal(plain.n, n);
        assert_true(with.estimate.memory == plain.estimate.memory + snapshots_memory(2, (double)n));
        assert_true(plain.estimate.memory > 0 && plain.estimate.steps > 0);
        assert_true(plain.plan_count > 3 && plain.plan_count <= RUN_PLAN_MAX);
        assert_int_equal(plain.crossed, 0);
        struct initial initial;
        struct error error;
        struct regularity want;
        assert_int_equal(initial_create(&initial, &run.problem, &run.settings, &error), STATUS_OK);
        double volume[100];
        for (size_t i = 0; i < n; i++) volume[i] = initial.m[i] / initial.rho[i];
        const double *const x[3] = {initial.x[0], initial.x[1], initial.x[2]};
        assert_int_equal(relax_measure(&run.problem.domain, n, x, volume, &want, &error),
                         STATUS_OK);
        initial_free(&initial);
        assert_true(plain.start.density == want.density && plain.start.gradient == want.gradient &&
                    plain.start.spread == want.spread && want.spread > 0);
    }
    static const char *const none[] = {"n=10^2", "n=10^2 lattice=glass boundary=reflecting",
                                       "n=10^2 lattice=glass boundary=periodic,reflecting",
                                       "n=10^2 lattice=glass boundary=reflecting,periodic"};
    for (int k = 0; k < 4; k++) {
        const struct run run = keyed_run("rest_2d", none[k]);
        const struct run_result plain = explained(&run);
        assert_true(isnan(plain.start.density));
    }
}

/* The exact solution must hold until the end, unless the user allows any window. */
TEST(windows_beyond_the_exact_solution)
{
    struct run run = keyed_run("sod", "n=40 t_end=5");
    struct run_result result;
    struct error error = {0};
    assert_int_equal(run_explain(&run, &result, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "mirrored tube"));
    run.asked.any_window = true;
    assert_int_equal(run_explain(&run, &result, &error), STATUS_OK);
}

/* A run larger than the available memory is refused before any array of its size is allocated. */
TEST(runs_larger_than_memory)
{
    struct run_result result;
    struct error error = {0};
    struct rlimit usual, few;
    const struct run run = keyed_run("rest_3d", "n=215^3");
    assert_int_equal(getrlimit(RLIMIT_AS, &usual), 0);
    few = usual;
    few.rlim_cur = (rlim_t)1 << 31;
    assert_int_equal(setrlimit(RLIMIT_AS, &few), 0);
    const enum status status = run_explain(&run, &result, &error);
    assert_int_equal(setrlimit(RLIMIT_AS, &usual), 0);
    assert_int_equal(status, STATUS_ENVIRONMENT);
    assert_non_null(strstr(error.message, "9938375"));
}

/* A run of a file has the file's number of particles, and reports columns that are not read. */
TEST(from_a_file)
{
    char path[256], words[400];
    struct run_result result;
    snprintf(path, sizeof path, "%s", path_of("p.csv"));
    /* with another warning, and alone; a column with a name of one letter */
    static const char *const more[] = {"colour,age", "q,q2", "q"}, *const ignored[] = {"colour age",
                                                                                       "q q2", "q"};
    static const char *const keys[] = {"", "energy=total viscosity=none", ""};
    size_t warned = 0;
    for (int k = 0; k < 3; k++) {
        FILE *file = fopen(path, "w");
        assert_non_null(file);
        fprintf(file, "x,y,vx,vy,m,u,%s\n", more[k]);
        for (int i = 0; i < 64; i++)
            fprintf(file, "%g,%g,0,0,0.015625,1,3%s\n", (i % 8 + 0.5) / 8, (i / 8 + 0.5) / 8,
                    k < 2 ? ",4" : "");
        fclose(file);
        snprintf(words, sizeof words, "file=%s kernel=cubic_spline eta=2.3 gradient=standard %s",
                 path, keys[k]);
        const struct run run = keyed_run("rest_2d", words);
        result = explained(&run);
        assert_int_equal(result.n, 64);
        assert_true(settings_real(&result.settings, SETTING_n) == 64);
        snprintf(words, sizeof words, "columns of %s that are not read: %s", path, ignored[k]);
        const char *said = strstr(result.warnings, "columns of");
        assert_non_null(said);
        assert_string_equal(said, words);
        if (said != result.warnings) assert_memory_equal(said - 2, "; ", 2);
        warned += said != result.warnings;
    }
    assert_int_equal(warned, 1);
}

/* ---- states of other codes ---- */

enum { N = 8 };

/* In 1D particles are sorted by position, also those carried across the end; the number of
 * neighbours that are no longer adjacent is reported. */
TEST(particles_in_1d_are_sorted)
{
    /* two coincident particles; the first ones in the order have crossed the end */
    static const double rising[N] = {-0.9, -0.7, -0.5, -0.2, 0, 0.3, 0.3, 0.9};
    static const int through[] = {0, 1, 5};
    double x[N];
    static const size_t id[3][N] = {
        {0, 1, 2, 3, 4, 5, 6, 7}, {3, 4, 5, 6, 7, 0, 1, 2}, {0, 2, 1, 3, 4, 5, 6, 7}};
    static const size_t crossed[] = {0, 0, 3};
    static double v[N], m[N], rho[N], u[N], P[N], h[N], volume[N];
    const struct run run = keyed_run("sod", "t_end=0.1");
    struct error error;
    for (int i = 0; i < N; i++) {
        v[i] = 1 + i, m[i] = 2 + i, rho[i] = 3 + i, u[i] = 4 + i, P[i] = 5 + i, h[i] = 6 + i;
        volume[i] = 0.25;
    }
    for (int k = 0; k < 9; k++) {
        const int turn = through[k / 3];
        for (int i = 0; i < N; i++) x[(i + turn) % N] = rising[i];
        const struct snapshot s = {.n = N,
                                   .x = {x},
                                   .v = {v},
                                   .m = m,
                                   .rho = rho,
                                   .u = u,
                                   .P = P,
                                   .h = h,
                                   .volume = volume,
                                   .id = id[k % 3],
                                   .time = 0.1};
        struct run_result result;
        assert_int_equal(run_judge(&run, &s, &result, &error), STATUS_OK);
        const struct snapshot *kept = &result.snapshot;
        assert_true(result.n == N && kept->n == N && result.time == 0.1 && kept->time == 0.1);
        assert_true(result.spacing == 0.25);
        assert_int_equal(result.crossed, crossed[k % 3]);
        for (int i = 0; i < N; i++) {
            const int from = (i + turn) % N;
            assert_true(kept->x[0][i] == rising[i] && kept->v[0][i] == v[from] &&
                        kept->m[i] == m[from] && kept->rho[i] == rho[from]);
            assert_true(kept->u[i] == u[from] && kept->P[i] == P[from] && kept->h[i] == h[from] &&
                        kept->volume[i] == 0.25);
        }
        assert_true(isnan(result.matrix.condition_max) && isnan(result.matrix.angle_mean) &&
                    result.matrix.fallen_back == 0);
        run_free(&result);
        assert_true(!result.storage && !result.snapshot.n && !result.snapshot.x[0]);
    }
}

/* In 2D and 3D they are sorted by number; errors are those of the particles in the window, by
 * volume. */
TEST(particles_in_2d_and_3d_are_sorted_by_number)
{
    static const size_t id[N] = {3, 0, 7, 1, 2, 6, 5, 4};
    static double x[3][N], v[3][N], rest[6][N];
    for (int dim = 2; dim <= 3; dim++) {
        const struct run run = keyed_run(dim == 2 ? "gresho" : "rest_3d",
                                         dim == 2 ? "t_end=0.1 boost=0.5" : "t_end=0.1");
        struct run_result result;
        struct error error;
        double azimuthal = 0, radial = 0, all = 0, jump = 0, density = 0;
        for (int i = 0; i < N; i++) {
            for (int d = 0; d < 3; d++) x[d][i] = 0.1 + 0.1 * ((i * (3 + 2 * d)) % N);
            for (int d = 0; d < 3; d++) v[d][i] = 0.1 * i - 0.2 * d;
            for (int k = 0; k < 6; k++) rest[k][i] = 1 + k + 0.125 * i;
        }
        const struct snapshot s = {.n = N,
                                   .x = {x[0], x[1], x[2]},
                                   .v = {v[0], v[1], v[2]},
                                   .m = rest[0],
                                   .rho = rest[1],
                                   .u = rest[2],
                                   .P = rest[3],
                                   .h = rest[4],
                                   .volume = rest[5],
                                   .id = id,
                                   .time = 0.1};
        assert_int_equal(run_judge(&run, &s, &result, &error), STATUS_OK);
        const struct snapshot *kept = &result.snapshot;
        for (int i = 0; i < N; i++) {
            for (int d = 0; d < dim; d++)
                assert_true(kept->x[d][id[i]] == x[d][i] && kept->v[d][id[i]] == v[d][i]);
            assert_true(kept->m[id[i]] == rest[0][i] && kept->rho[id[i]] == rest[1][i] &&
                        kept->u[id[i]] == rest[2][i] && kept->P[id[i]] == rest[3][i] &&
                        kept->h[id[i]] == rest[4][i] && kept->volume[id[i]] == rest[5][i]);
            /* against the exact state at the particle's position */
            struct problem_state exact;
            double place[3] = {x[0][i], x[1][i], dim > 2 ? x[2][i] : 0}, squares = 0;
            problem_sample(&run.problem, place, 0.1, &exact);
            for (int d = 0; d < dim; d++) squares += pow(v[d][i] - exact.v[d], 2);
            const double V = rest[5][i];
            all += V;
            jump += V * sqrt(squares);
            density += V * fabs(rest[1][i] - exact.rho);
            if (dim > 2) continue;
            double dx = x[0][i] - 0.5 * 0.1 - 0.5, dy = x[1][i] - 0.5 * 0.1 - 0.5;
            dx -= round(dx), dy -= round(dy);
            const double R = hypot(dx, dy), ex = exact.v[0] - v[0][i], ey = exact.v[1] - v[1][i];
            azimuthal += V * fabs(dx * ey - dy * ex) / R;
            radial += V * fabs(dx * ex + dy * ey) / R;
        }
        assert_int_equal(result.crossed, 0);
        near_relative(result.spacing, pow(1. / N, 1. / dim), 1e-14);
        near_relative(result.errors[FIELD_DENSITY].l1, density / all, 1e-13);
        near_relative(result.errors[FIELD_VELOCITY].l1, jump / all, 1e-13);
        assert_int_equal(result.errors[FIELD_VELOCITY].n, N);
        assert_true(isnan(result.binned_density_l1));
        struct run_result again = result;
        again.functional_count = 0;
        run_measure_functionals(&again);
        assert_int_equal(result.functional_count, again.functional_count);
        assert_true(again.h > 0 && result.h == again.h);
        if (dim == 2) {
            near_relative(result.azimuthal.l1, azimuthal / all, 1e-12);
            near_relative(result.radial.l1, radial / all, 1e-12);
        } else {
            assert_true(isnan(result.azimuthal.l1) && isnan(result.radial.l1));
        }
        run_free(&result);
    }
}

/* A state at a time when the exact solution no longer holds cannot be judged. */
TEST(states_after_the_exact_solution)
{
    const struct run run = keyed_run("sod", "t_end=0.1");
    const double x[2] = {-0.5, 0.5}, one[2] = {1, 1};
    const struct snapshot s = {.n = 2,
                               .x = {x},
                               .v = {one},
                               .m = one,
                               .rho = one,
                               .u = one,
                               .P = one,
                               .h = one,
                               .volume = one,
                               .time = 5};
    struct run_result result;
    struct error error = {0};
    assert_int_equal(run_judge(&run, &s, &result, &error), STATUS_BAD_INPUT);
    assert_true(!result.storage && !result.snapshot.n);
}

/* ---- during the run ---- */

struct reported {
    size_t calls;
    uint64_t steps[1000], stop;
    double time[1000];
};

static bool tell(void *context, double time, uint64_t steps)
{
    struct reported *reported = context;
    assert_true(reported->calls < 1000);
    reported->time[reported->calls] = time;
    reported->steps[reported->calls++] = steps;
    return steps < reported->stop;
}

TEST(progress_callbacks)
{
    static struct reported reported;
    struct run run = keyed_run("sod", "n=400 t_end=0.2");
    run.asked.progress = tell;
    run.asked.progress_context = &reported;
    for (int each = 0; each < 2; each++) {
        reported = (struct reported){.stop = 1000};
        run.asked.each_step = each;
        struct run_result result = keyed_result(&run);
        const uint64_t stride = each ? 1 : 32;
        assert_true(result.cost.steps > 64 && result.cost.steps % 32 && result.time == 0.2);
        assert_int_equal(reported.calls, result.cost.steps / stride);
        for (size_t k = 0; k < reported.calls; k++) {
            assert_int_equal(reported.steps[k], (k + 1) * stride);
            assert_true(k == 0 || reported.time[k] > reported.time[k - 1]);
        }
        run_free(&result);
    }
    reported = (struct reported){.stop = 5}; /* a callback that returns false stops the run */
    struct run_result result = keyed_result(&run);
    assert_true(result.cost.steps == 5 && result.time < 0.2 && result.time == reported.time[4]);
    run_free(&result);
}

/* Every step reports sums and progress, also when a snapshot is due; there is a snapshot at each
 * time before the end. A snapshot that cannot be written is reported, and the run is the same. */
TEST(sums_and_snapshots_during_a_run)
{
    static struct trace trace;
    static struct reported reported = {.stop = 1000};
    char folder[] = "sphproof_run_XXXXXX", path[64], file[80];
    struct run run = keyed_run("sod", "n=40 t_end=0.06");
    struct run_result plain = keyed_result(&run);
    struct snapshots snapshots = {.path = path, .every = 0.001875};
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/a.csv", folder);
    run.asked.trace = &trace;
    run.asked.progress = tell, run.asked.progress_context = &reported, run.asked.each_step = true;
    run.asked.snapshots = &snapshots;
    struct run_result result = keyed_result(&run);
    assert_int_equal(snapshots.trouble.status, STATUS_OK);
    assert_int_equal(trace.count, result.cost.steps + 1);
    assert_int_equal(reported.calls, result.cost.steps);
    assert_true(trace.time[0] == 0 && trace.time[trace.count - 1] == 0.06);
    for (size_t k = 1; k < trace.count; k++) {
        assert_true(trace.time[k] > trace.time[k - 1]);
        near_relative(trace.sums[k].mass, trace.sums[0].mass, 1e-13);
    }
    assert_true(result.cost.steps == plain.cost.steps);
    for (size_t i = 0; i < result.n; i++)
        assert_true(result.snapshot.x[0][i] == plain.snapshot.x[0][i] &&
                    result.snapshot.u[i] == plain.snapshot.u[i]);
    run_free(&result);
    for (int k = 0; k <= 32; k++) { /* the last would be at the end */
        snprintf(file, sizeof file, "%s/a_%04d.csv", folder, k);
        assert_int_equal(unlink(file), k < 32 ? 0 : -1);
    }
    snprintf(path, sizeof path, "%s/none/a.csv", folder);
    snapshots = (struct snapshots){.path = path, .every = 0.001875};
    result = keyed_result(&run);
    assert_true(snapshots.trouble.status != STATUS_OK && snapshots.trouble.message[0]);
    assert_true(result.snapshot.u[7] == plain.snapshot.u[7]);
    run_free(&result);
    run_free(&plain);
    assert_int_equal(rmdir(folder), 0);
}

/* The peak memory of the process; on Linux it includes the process that started it. */
TEST(peak_memory)
{
    struct rusage after;
    const struct run run = keyed_run("sod", "n=40 t_end=0.01");
    enum { MORE = 1 << 24 };
    struct run_result result = keyed_result(&run);
    getrusage(RUSAGE_SELF, &after);
    near_inside(result.peak_rss, 2e6, 1024. * (double)after.ru_maxrss + 1e6);
    volatile char *more = malloc(MORE);
    for (int i = 0; i < MORE; i += 1024) more[i] = 1;
    free((void *)more);
    const double first = result.peak_rss;
    run_free(&result);
    result = keyed_result(&run);
    near_inside(result.peak_rss, first + 0.5 * MORE, first + 2 * MORE);
    assert_true(fmod(result.peak_rss, 1024) == 0);
    run_free(&result);
}

/* Momentum is not conserved along directions where walls push, and is along others. */
TEST(momentum_along_walls)
{
    static const struct {
        const char *boundary;
        bool pushed[2];
    } rows[] = {{"periodic", {false, false}},
                {"reflecting,periodic", {true, false}},
                {"periodic,reflecting", {false, true}},
                {"reflecting", {true, true}}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char words[128];
        snprintf(words, sizeof words, "n=10^2 t_end=0.05 jitter=0.2 boundary=%s", rows[k].boundary);
        const struct run run = keyed_run("rest_2d", words);
        struct run_result result = keyed_result(&run);
        const struct snapshot *s = &result.snapshot;
        double p[2] = {0, 0};
        for (size_t i = 0; i < s->n; i++)
            for (int d = 0; d < 2; d++) p[d] += s->m[i] * s->v[d][i];
        for (int d = 0; d < 2; d++) {
            if (rows[k].pushed[d])
                assert_true(fabs(p[d]) > 1e-8);
            else
                near_below(fabs(p[d]), 1e-14);
        }
        near_below(result.drift.momentum, 1e-11);
        if (k == 0) assert_true(result.drift.momentum > 0); /* round-off, so it was measured */
        near_below(result.drift.mass, 1e-13);
        run_free(&result);
    }
}
