/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the arithmetic of `bench` on made-up data and clocks (only the first test reads a real
 * clock), and compares its baseline in plain C with the solver. */
#include "test.h"

#include <gsl/gsl_rng.h>
#include <sys/resource.h>

#include "bench.h"
#include "bench_cells.h"
#include "bench_limit.h"
#include "bench_loops.h"
#include "bench_scaling.h"
#include "bench_skips.h"
#include "precision.h"
#include "printed.h"
#include "worst.h"

/* The limit of CPU time that this test sets stays for the rest of the process. */
TEST(a_limit_of_cpu_time_leaves_the_clock_fine)
{
    struct rlimit limit;
    assert_int_equal(getrlimit(RLIMIT_CPU, &limit), 0);
    if (limit.rlim_cur > 3600) limit.rlim_cur = 3600;
    assert_int_equal(setrlimit(RLIMIT_CPU, &limit), 0);
    const double begin = clock_now().cpu_s;
    double before = begin;
    for (int changes = 0; changes < 500;) {
        const double now = clock_now().cpu_s;
        changes += now > before;
        before = now;
    }
    near_below(before - begin, 0.5);
}

static const struct bench_rules brief = {.least_s = 1e-6, .most_s = 1, .samples = 2};
static struct run_settings given; /* of the last measurement */

static void prepare(const char *name, int n, char *const *keys)
{
    struct error error;
    if (run_prepare(&given, name, n, keys, &error)) fail_msg("%s", error.message);
    given.threads = 1;
}

static struct bench_skips skips_of(const char *name, int n, char *const *keys, enum bench_part part)
{
    struct bench_skips skips;
    struct error error;
    prepare(name, n, keys);
    if (bench_skips_measure(&given, 1, &brief, part, &skips, &error)) fail_msg("%s", error.message);
    return skips;
}

/* With particle numbers ladder[0] and, unless it is 0, ladder[1]. */
static struct precision precision_of(const char *name, int n, char *const *keys, const char *vary,
                                     const size_t ladder[2])
{
    struct sweep sweep;
    struct precision precision = {0};
    struct error error;
    prepare(name, n, keys);
    if (sweep_parse(&sweep, vary, &error) ||
        precision_measure(&given, &sweep, ladder, 1 + (ladder[1] > 0), &brief, &precision, &error))
        fail_msg("%s", error.message);
    return precision;
}

/* --- timing, on a clock that the test controls ------------------------------------------------ */

struct fake {
    double once, warm_up, noise[BENCH_SAMPLES_MAX]; /* noise: a factor for each call */
    int calls;
    uint64_t times[BENCH_SAMPLES_MAX];
    int breaks_at; /* the call that fails; 0: none */
    enum status status;
};

static enum status fake_work(void *context, uint64_t times, struct clock_taken *taken,
                             struct error *error)
{
    struct fake *fake = context;
    const int call = fake->calls++;
    fake->times[call] = times;
    if (fake->calls == fake->breaks_at) return error_set(error, fake->status, "as arranged");
    const double factor = fake->noise[call] > 0 ? fake->noise[call] : 1;
    taken->cpu_s += (double)times * fake->once * factor + (call ? 0 : fake->warm_up);
    taken->wall_s += 2 * (double)times * fake->once * factor;
    return STATUS_OK;
}

static const struct bench_rules rules = {.least_s = 0.01, .most_s = 1e9, .samples = 5};

TEST(samples_double_until_they_are_long_enough)
{
    /* calls take 1, 2, 4, 8 ms after the warm-up; 16 ms is the first sample */
    struct fake fake = {.once = 1e-3, .warm_up = 0.1};
    fake.noise[6] = 1.5, fake.noise[7] = 3, fake.noise[8] = 1.25, fake.noise[9] = 1.75;
    struct bench_subject subject = {.work = fake_work, .context = &fake};
    fake.warm_up = 0;
    assert_int_equal(bench_measure(&subject, 1, &rules, NULL), STATUS_OK);
    assert_int_equal(subject.time.times, 16);
    assert_int_equal(subject.time.samples, 5);
    assert_int_equal(fake.calls, 10);
    for (int call = 6; call < 10; call++) assert_int_equal(fake.times[call], 16);
    near_relative(subject.time.cpu_s, 1e-3, 1e-12);
    near_relative(subject.time.wall_s, 2e-3, 1e-12);
    near_relative(subject.time.spread, 0.5, 1e-12); /* of 1 1.25 1.5 1.75 3 */
}

TEST(first_call_does_not_count)
{
    struct fake fake = {.once = 0.02, .warm_up = 0.05};
    struct bench_subject subject = {.work = fake_work, .context = &fake};
    fake.noise[0] = 0.1; /* a first call that is implausibly fast */
    assert_int_equal(bench_measure(&subject, 1, &rules, NULL), STATUS_OK);
    near_relative(subject.time.cpu_s, 0.02, 1e-12);
    assert_int_equal(fake.calls, 6);
}

TEST(long_work_is_not_repeated_for_ever)
{
    struct fake fake = {.once = 3};
    struct bench_subject subject = {.work = fake_work, .context = &fake};
    const struct bench_rules short_of_time = {.least_s = 0.01, .most_s = 4, .samples = 5};
    assert_int_equal(bench_measure(&subject, 1, &short_of_time, NULL), STATUS_OK);
    assert_int_equal(fake.calls, 2); /* the first call is long enough for a sample */
    assert_int_equal(subject.time.samples, 2);
}

TEST(samples_are_taken_in_turn)
{
    struct fake fake = {.once = 0.02};
    struct bench_subject subjects[2] = {{.work = fake_work, .context = &fake},
                                        {.work = fake_work, .context = &fake}};
    /* two calls of each to calibrate, then alternating calls; b takes twice as long as a */
    for (int call = 0; call < 12; call++)
        fake.noise[call] = call == 3 || (call > 3 && call % 2 == 1) ? 2 : 1;
    assert_int_equal(bench_measure(subjects, 2, &rules, NULL), STATUS_OK);
    near_relative(subjects[1].time.cpu_s / subjects[0].time.cpu_s, 2, 1e-12);
    near_absolute(subjects[0].time.spread, 0, 1e-12);
    near_absolute(subjects[1].time.spread, 0, 1e-12);
}

TEST(breakdown_of_one_subject)
{
    struct error error = {0};
    struct fake sound = {.once = 0.02}, unsound = {.once = 0.02, .breaks_at = 4},
                hopeless = {.once = 0.02, .breaks_at = 1};
    unsound.status = hopeless.status = STATUS_BROKE_DOWN;
    struct bench_subject subjects[3] = {{.work = fake_work, .context = &unsound},
                                        {.work = fake_work, .context = &hopeless},
                                        {.work = fake_work, .context = &sound}};
    assert_int_equal(bench_measure(subjects, 3, &rules, &error), STATUS_OK);
    assert_int_equal(subjects[0].failure.status, STATUS_BROKE_DOWN);
    assert_int_equal(subjects[1].failure.status, STATUS_BROKE_DOWN);
    assert_string_equal(subjects[1].failure.message, "as arranged");
    assert_int_equal(subjects[2].failure.status, STATUS_OK);
    assert_int_equal(unsound.calls, 4);
    assert_int_equal(hopeless.calls, 1);
    near_relative(subjects[2].time.cpu_s, 0.02, 1e-12);

    struct fake wrong = {.once = 0.02, .breaks_at = 2, .status = STATUS_ENVIRONMENT};
    struct bench_subject subject = {.work = fake_work, .context = &wrong};
    assert_int_equal(bench_measure(&subject, 1, &rules, &error), STATUS_ENVIRONMENT);
    assert_string_equal(error.message, "as arranged");
}

/* --- Pareto front and paths along it ---------------------------------------------------------- */

TEST(pareto_front)
{
    static const double cost[] = {1, 2, 3, 4, 2, 1, 5, (double)NAN, 0.5, 4};
    static const double error[] = {8, 4, 5, 2, 4, 9, 2, 0.1, (double)INFINITY, 1.5};
    /* 2 costs more and has a larger error than 1; 1 and 4 tie; 3 and 6 are worse than 9 */
    static const bool expected[] = {true,  true,  false, false, true,
                                    false, false, false, false, true};
    enum { N = sizeof cost / sizeof *cost };
    bool front[N];
    precision_front(N, cost, error, front);
    for (size_t i = 0; i < N; i++) assert_int_equal(front[i], expected[i]);
    precision_front(0, cost, error, front);
}

TEST(cost_of_an_error)
{
    /* error = cost^-1/2 from 1e-1 to 1e-3 */
    const double cost[] = {1e2, 1e4, 1e6}, error[] = {1e-1, 1e-2, 1e-3};
    near_relative(precision_cost_of(3, cost, error, 2e-2), 2500, 1e-12);
    near_relative(precision_cost_of(3, cost, error, 2e-3), 250000, 1e-12);
    near_relative(precision_cost_of(3, cost, error, 1e-2), 1e4, 1e-12);
    near_relative(precision_cost_of(3, cost, error, 0.5), 1e2, 1e-12); /* the coarsest is enough */
    assert_true(isnan(precision_cost_of(3, cost, error, 9e-4)));       /* no extrapolation */
    assert_true(isnan(precision_cost_of(0, cost, error, 1)));
    /* an error that rises again: the first crossing is the cheapest */
    const double bumpy[] = {1e-1, 1e-3, 1e-2};
    near_relative(precision_cost_of(3, cost, bumpy, 1e-2), 1e3, 1e-12);
    const double broken[] = {1e-1, (double)NAN, 1e-3};
    near_relative(precision_cost_of(3, cost, broken, 1e-2), 1e6, 1e-12);
}

/* --- the practical limit ---------------------------------------------------------------------- */

/* On contiguous arrays the gradient is the one that the operators find with a neighbour search. */
static void compare_limit(const struct kernel *kernel, const struct operator_form *form, int dim)
{
    enum { N = 64 };
    double x[3][N], r[3][N], volume[N], f[N], h[N], sums[BENCH_LIMIT_SUMS], out[3][N], limit[3];
    const double width = 0.37;
    for (size_t i = 0; i < N; i++) {
        for (size_t a = 0; a < 3; a++) { /* far from each other, but near the first point */
            r[a][i] = i ? 0.55 * sin(12.9898 * (double)(i + 1) * (double)(a + 1)) : 0;
            x[a][i] = 1.7 + width * r[a][i];
        }
        volume[i] = 0.6 + 0.3 * cos(3.1 * (double)i);
        f[i] = 2.385 + sin(0.7 * (double)i);
        h[i] = width;
    }
    struct cloud cloud = {.points = {.dim = dim, .n = N, .x = {x[0], x[1], x[2]}}, .h = h};
    double physical[N];
    for (size_t i = 0; i < N; i++) physical[i] = volume[i] * pow(width, dim);
    cloud.volume = physical;
    const struct operator_settings settings = {form, kernel, false, 1};
    struct error error = {0};
    assert_int_equal(operator_apply(&settings, &cloud, 1, (const double *const[]){f},
                                    (double *const[]){out[0], out[1], out[2]}, NULL, NULL, &error),
                     STATUS_OK);
    const struct bench_neighbours list = {N, {r[0], r[1], r[2]}, volume, f};
    bench_limit_find(kernel, form, dim)(kernel, &list, sums);
    assert_true(bench_limit_gradient(kernel, form, dim, sums, f[0], width, limit));
    double scale = 0, wrong = 0;
    for (int a = 0; a < dim; a++) {
        scale = fmax(scale, fabs(out[a][0]));
        wrong = fmax(wrong, fabs(out[a][0] - limit[a]));
    }
    near_below(wrong / scale, 1e-10);
}

TEST(limit_has_the_operators_gradient)
{
    for (size_t k = 0; k < kernel_family.n; k++) {
        struct kernel kernel;
        assert_int_equal(kernel_select(&kernel, kernel_family.members[k]->name, 5, NULL), 0);
        for (size_t o = 0; o < operator_family.n; o++)
            for (int dim = 1; dim <= 3; dim++)
                compare_limit(&kernel, (const struct operator_form *)operator_family.members[o],
                              dim);
    }
}

/* Neighbours by definition agree with the search's, and there are neighbours and others. */
TEST(neighbours_of_the_search)
{
    enum { PLACES = 192 };
    float x[3][PLACES];
    const float *const at[3] = {x[0], x[1], x[2]};
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int a = 0; a < 3; a++)
        for (int k = 0; k < PLACES; k++) x[a][k] = (float)(2 * gsl_rng_uniform(rng) - 1);
    for (int dim = 2; dim <= 3; dim++) {
        size_t near = 0;
        for (int k = 0; k < PLACES; k++) {
            double r2 = 0;
            for (int a = 0; a < dim; a++) r2 += (double)x[a][k] * (double)x[a][k];
            near += sqrt(r2) < 1;
        }
        assert_true(near > PLACES / 3 && near < PLACES - 10);
        assert_int_equal(bench_limit_near(dim, PLACES, at), near);
    }
    /* a ball fills pi/6 of its cube; the search looks at 27 cubes of a third of its width */
    near_relative(bench_limit_candidates(3) * M_PI / 6, 27. / 8, 1e-14);
    near_relative(bench_limit_candidates(2) * M_PI / 4, 9. / 4, 1e-14);
    gsl_rng_free(rng);
}

/* However often the loops are repeated, their numbers stay ordinary: none overflows, and none
 * decays to zero, where arithmetic would be cheap. */
TEST(repeated_loops_stay_finite)
{
    static char *const keys[][2] = {{"kernel=quadratic_spline", "gradient=standard"},
                                    {"kernel=quintic_spline", "gradient=ia"}};
    for (size_t k = 0; k < 2; k++) {
        struct bench_loops loops;
        struct scheme scheme;
        struct error error = {0};
        struct clock_taken taken = {0};
        prepare("sod", 2, keys[k]);
        assert_int_equal(settings_scheme(&given.settings, 1, &scheme, &error), 0);
        const unsigned all = 1u << PASS_STATE | 1u << PASS_DENSITY | 1u << PASS_MATRIX |
                             1u << PASS_FORCE | 1u << PASS_SIGNAL;
        assert_int_equal(bench_loops_create(&loops, &scheme, 200, true, all, &error), 0);
        assert_int_equal(bench_loops_work(&loops, 300, &taken, &error), 0);
        const struct particles *a = &loops.particles;
        double force = 0;
        for (ptrdiff_t i = 0; i < a->n; i++) {
            near_relative(a->h[i], scheme.eta, 0.1);
            near_relative(a->rho[i], 1, 0.1);
            near_inside(a->U[i], 2, 3);
            near_inside(a->x[0][i] - (double)i, -0.03, 0.03);
            near_below(fabs(a->F[0][i]), 1);
            force = fmax(force, fabs(a->F[0][i]));
        }
        near_inside(force, 1e-3, 1);
        assert_true(loops.rate > 0);
        bench_loops_free(&loops);
    }
}

/* --- the baseline ----------------------------------------------------------------------------- */

static void compare_plain(const char *name, int n, char *const *more)
{
    static char *const keys[] = {"kernel=cubic_spline",
                                 "eta=4.8",
                                 "gradient=standard",
                                 "formulation=vanilla_ice",
                                 "energy=internal",
                                 "integrator=modified_leapfrog",
                                 "cfl=0.3",
                                 "alpha=1",
                                 "skip=none",
                                 "h_tolerance=1e-13"};
    struct run run;
    struct run_result fast, plain;
    struct error error = {0};
    prepare(name, sizeof keys / sizeof *keys, keys);
    assert_int_equal(settings_apply(&given.settings, n, more, &error), 0);
    given.settings.shared = true; /* alpha is of the cases with viscosity */
    assert_int_equal(run_resolve(&run, &given, &error), STATUS_OK);
    assert_int_equal(run_execute(&run, &fast, &error), STATUS_OK);
    run.asked.solver = precision_plain;
    assert_int_equal(run_execute(&run, &plain, &error), STATUS_OK);
    assert_int_equal(plain.n, fast.n);
    assert_int_equal(plain.cost.steps, fast.cost.steps);
    near_relative(plain.time, fast.time, 1e-15);
    double worst = 0, moved = 0;
    /* the solver's order is cyclic: begin with its leftmost particle */
    size_t first = 0;
    for (size_t i = 1; i < fast.n; i++)
        if (fast.snapshot.x[0][i] < fast.snapshot.x[0][first]) first = i;
    for (size_t i = 0; i < fast.n; i++) {
        const size_t k = (first + i) % fast.n;
        const struct snapshot *a = &plain.snapshot, *b = &fast.snapshot;
        const double wrong[] = {a->x[0][i] - b->x[0][k],         a->v[0][i] - b->v[0][k],
                                a->rho[i] / b->rho[k] - 1,       a->u[i] / b->u[k] - 1,
                                a->h[i] / b->h[k] - 1,           a->P[i] / b->P[k] - 1,
                                a->volume[i] / b->volume[k] - 1, a->m[i] / b->m[k] - 1};
        for (size_t q = 0; q < sizeof wrong / sizeof *wrong; q++)
            worst_keep(&worst, fabs(wrong[q]));
        moved = fmax(moved, fabs(b->v[0][k]));
    }
    near_below(worst, 1e-9);
    near_inside(moved, 1e-5, 1e3); /* the particles have moved */
    near_below(plain.drift.momentum, 1e-12);
    near_relative(plain.errors[FIELD_DENSITY].l1, fast.errors[FIELD_DENSITY].l1, 1e-8);
    run_free(&fast);
    run_free(&plain);
}

TEST(plain_agrees_with_the_solver)
{
    compare_plain("sod", 2, (char *[]){"n=126", "t_end=0.15"});
    compare_plain("sod_standard", 3, (char *[]){"n=100", "eta=2", "cfl=0.15"});
    compare_plain("strong_shock", 3, (char *[]){"n=80", "t_end=0.006", "jitter=0.1"});
    compare_plain("sound_wave", 3, (char *[]){"n=48", "background=1 0.7 1", "viscosity=none"});
}

TEST(plain_refuses_other_schemes)
{
    static char *const keys[] = {"n=60", "kernel=wendland_c2"};
    struct run run;
    struct run_result result;
    struct error error = {0};
    prepare("sod", 2, keys);
    given.solver = precision_plain;
    assert_int_equal(run_resolve(&run, &given, &error), STATUS_OK);
    assert_int_equal(run_execute(&run, &result, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "cubic_spline"));
}

/* --- left-out work ---------------------------------------------------------------------------- */

TEST(difference_of_states)
{
    double x[2][3] = {{-0.999999999, 0.1, 0.4}, {0.999999999, 0.1, 0.4}}, v[3] = {0, -4, 2},
           w[3] = {0, -4, 2 + 4e-9}, one[3] = {1, 1, 1};
    struct snapshot a = {.n = 3, .x = {x[0]}, .v = {v}, .rho = one, .u = one, .P = one, .h = one},
                    b = a;
    assert_true(bench_skips_difference(&a, &b, 2) == 0);
    b.v[0] = w;
    near_relative(bench_skips_difference(&a, &b, 2), 1e-9, 1e-6);
    b.v[0] = v;
    b.x[0] = x[1]; /* the same position on the other side of the box, but for 2e-9 */
    near_relative(bench_skips_difference(&a, &b, 2), 2e-9, 1e-6);
    b.x[0] = x[0];
    double negative[3] = {-0., -4, 2};
    b.v[0] = negative;
    near_inside(bench_skips_difference(&a, &b, 2), 1e-310, 1e-290); /* the bits differ */
    double broken[3] = {0, (double)NAN, 2};
    b.v[0] = broken;
    assert_true(isinf(bench_skips_difference(&a, &b, 2)));
    b.n = 2;
    assert_true(isinf(bench_skips_difference(&a, &b, 2)));
    const struct snapshot nothing = {0};
    assert_true(isinf(bench_skips_difference(&nothing, &nothing, 2)));
    double y[3] = {0.1, 0.5, 0.9}, z[3] = {0.1, 0.5, 0.900001}; /* along another axis */
    a.x[1] = a.v[1] = y;
    for (int k = 0; k < 2; k++) {
        b = a;
        *(k ? &b.v[1] : &b.x[1]) = z;
        near_relative(bench_skips_difference(&a, &b, 2), 1e-6 / 0.9, 1e-6);
    }
}

TEST(skips_keep_their_promises)
{
    struct bench_skips skips = skips_of("sod", 2, (char *[]){"t_end=0.1", "n=180"}, BENCH_WORK);
    assert_true(skips.count >= 6);
    near_inside(skips.skips[0].shares->skipped, 0.2, 0.9); /* at t = 0.1 */
    for (size_t i = 0; i < skips.count; i++) {
        const struct bench_skip *skip = &skips.skips[i];
        assert_true(skip->kept);
        assert_true(skip->enough);
        assert_true(isnan(skip->difference) == (skip->promise == PROMISE_UNUSED));
    }
    assert_true(bench_skips_pass(&skips));
    for (size_t i = 0; i < skips.count; i++) { /* a single failure fails all */
        bool *const said[] = {&skips.skips[i].kept, &skips.skips[i].enough};
        for (size_t k = 0; k < 2; k++) {
            *said[k] = false;
            assert_false(bench_skips_pass(&skips));
            *said[k] = true;
        }
    }
    skips.skips[0].enough = false;
    json_t *document = json_object();
    bench_skips_add_json(&skips, false, document);
    const json_t *list = json_object_get(document, "skips");
    for (size_t i = 0; i < skips.count; i++)
        assert_string_equal(json_string_value(json_object_get(json_array_get(list, i), "status")),
                            i ? "pass" : "fail");
    json_decref(document);
    bench_skips_free(&skips);
}

/* A blast amplifies what sleep changes beyond 1e-8. The bound is then what a start changes whose
 * particles are moved by the tolerance of sleep; longer steps keep the symmetry of the lattice, and
 * would change less than sleep does. */
TEST(the_bound_of_sleep_follows_what_the_flow_amplifies)
{
    struct bench_skips skips = skips_of("sedov_2d", 1, (char *[]){"n=24^2"}, BENCH_WORK);
    const struct bench_skip *sleep = &skips.skips[0];
    assert_non_null(sleep->shares);
    near_inside(sleep->difference, 1e-8, 1e-7);
    assert_true(sleep->kept);
    near_inside(sleep->bound, sleep->difference, 1e-6);
    bench_skips_free(&skips);
}

/* A run without viscosity and one with viscosity of strength 0 have the same bits and time
 * steps. */
TEST(no_viscosity_equals_strength_0)
{
    static char *keys[][4] = {{"t_end=0.1", "n=40"}, {"t_end=0.02", "n=16^2", "viscosity=none"}};
    for (int k = 0; k < 2; k++) {
        const char *name = k ? "gresho" : "sound_wave";
        struct bench_skips skips = skips_of(name, 2 + k, keys[k], BENCH_WORK);
        int met = 0;
        for (size_t i = 0; i < skips.count; i++) {
            assert_true(skips.skips[i].kept);
            if (strcmp(skips.skips[i].name, "viscosity of none")) continue;
            assert_true(skips.skips[i].difference == 0);
            met++;
        }
        assert_int_equal(met, 1);
        bench_skips_free(&skips);
    }
}

/* Local time steps beside global ones: errors are of quantities with an exact value, and sums are
 * conserved. */
TEST(local_time_steps)
{
    static const struct {
        const char *name, *measured;
    } cases[] = {
        {"noh_2d", "L1 of density"}, {"kelvin_helmholtz", "mode_amplitude"}, {"sod", NULL}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char *keys[] = {"t_end=0.05", "n=256"};
        struct bench_skips skips = skips_of(cases[k].name, 2, keys, BENCH_STEPS);
        assert_int_equal(skips.count, cases[k].measured ? 1 : 0);
        for (size_t i = 0; i < skips.count; i++) {
            const struct bench_skip *skip = &skips.skips[i];
            assert_true(skip->kept && skip->promise == PROMISE_ERROR);
            assert_string_equal(skip->measured, cases[k].measured);
            for (int side = 0; side < BENCH_SIDES; side++) {
                near_inside(skip->error[side], 1e-9, 1e3);
                near_absolute(skip->momentum[side], 0, 1e-13);
                near_absolute(skip->energy[side], 0, 1e-12);
            }
        }
        bench_skips_free(&skips);
    }
}

TEST(skips_keep_their_promises_in_2d)
{
    char *keys[] = {"t_end=0.02", "n=16^2", "gradient=standard", "viscosity=constant"};
    struct bench_skips skips = skips_of("gresho", 4, keys, BENCH_WORK);
    bool matrix = false, slope = false, line = false;
    for (size_t i = 0; i < skips.count; i++) {
        const struct bench_skip *skip = &skips.skips[i];
        assert_true(skip->kept);
        matrix |= strcmp(skip->name, "moment matrix") == 0;
        slope |= strcmp(skip->name, "velocity gradient") == 0;
        line |= strcmp(skip->name, "order of neighbours") == 0;
    }
    assert_true(matrix && slope && !line);
    bench_skips_free(&skips);
}

/* --- sums in 2D and 3D ------------------------------------------------------------------------ */

/* Pairs are counted over all pairs; each pass does what its name says and no more. */
TEST(pairs_of_each_pass)
{
    struct run_settings asked;
    static struct run run;
    static struct bench_cells bench;
    struct error error;
    struct clock_taken taken = {0};
    char *keys[] = {"gradient=ia", "viscosity=constant"};
    assert_int_equal(run_prepare(&asked, "sound_wave_2d", 2, keys, &error), 0);
    assert_int_equal(run_resolve(&run, &asked, &error), 0);
    assert_int_equal(bench_cells_create(&bench, &run.scheme, 2, 12, true, CELLS_DENSITY, &error),
                     0);
    const struct cells_fields *f = &bench.fields;
    double pairs = 0, force = 0, size = 0;
    for (size_t i = 0; i < f->n; i++) {
        for (size_t j = 0; j < f->n; j++) {
            const double dx = f->x[0][i] - f->x[0][j], dy = f->x[1][i] - f->x[1][j];
            pairs += i != j && hypot(dx - round(dx), dy - round(dy)) * f->h_inverse[i] < 1;
        }
        force += f->F[0][i], size += fabs(f->F[0][i]);
        const double rho = run.scheme.kernel.constant[2] * pow(f->h_inverse[i], 2) * f->sum_m[i];
        near_inside(rho, 0.9, 1.1);
        near_inside(f->condition[i], 1, 10);
    }
    assert_true(pairs == bench.pairs && size > 0 && fabs(force) <= 1e-12 * size);
    const double before = f->sum_m[3], F = f->F[0][3];
    f->sum_m[3] = f->F[0][3] = f->condition[3] = -1;
    assert_int_equal(bench_cells_work(&bench, 2, &taken, &error), 0);
    assert_true(f->sum_m[3] == before && f->F[0][3] == -1 && f->condition[3] == -1);
    bench.passes = CELLS_MATRIX | CELLS_FORCE;
    assert_int_equal(bench_cells_work(&bench, 1, &taken, &error), 0);
    assert_true(f->F[0][3] == F && f->condition[3] > 0 && taken.cpu_s > 0);
    bench_cells_free(&bench);
}

/* Schemes that compute more per particle have the arrays that they need: forces add up to 0. */
TEST(forces_of_schemes_balance)
{
    static const char *const schemes[] = {"shifting=fluxes", "shifting=closed", "gradient=blended",
                                          "viscosity=cullen_dehnen", "formulation=lagrangian"};
    for (size_t k = 0; k < 2 * sizeof schemes / sizeof *schemes; k++) {
        struct run_settings asked;
        static struct run run;
        static struct bench_cells bench;
        struct error error;
        char words[40], *keys[] = {words};
        const int dim = k % 2 ? 3 : 2;
        snprintf(words, sizeof words, "%s", schemes[k / 2]);
        assert_int_equal(run_prepare(&asked, dim == 2 ? "rest_2d" : "rest_3d", 1, keys, &error), 0);
        assert_int_equal(run_resolve(&run, &asked, &error), 0);
        assert_int_equal(
            bench_cells_create(&bench, &run.scheme, dim, 12, true, CELLS_DENSITY, &error), 0);
        double force = 0, size = 0;
        for (size_t i = 0; i < bench.fields.n; i++)
            force += bench.fields.F[0][i], size += fabs(bench.fields.F[0][i]);
        assert_true(size > 0 && fabs(force) <= 1e-12 * size);
        bench_cells_free(&bench);
    }
}

/* --- how cost grows --------------------------------------------------------------------------- */

TEST(scaling)
{
    static struct scaling scaling;
    static const size_t ladder[] = {90, 180, 270, 810};
    struct error error = {0};
    prepare("sod", 1, (char *[]){"t_end=0.02"});
    assert_int_equal(bench_scaling_measure(&given, ladder, 4, 2, &brief, &scaling, &error), 0);
    for (size_t i = 0; i < 4; i++) {
        assert_int_equal(scaling.levels[i].n, ladder[i]);
        near_inside(scaling.levels[i].error, 1e-5, 0.1);
        assert_true(scaling.levels[i].run_steps > 0);
    }
    assert_int_equal(scaling.thread_count, 1);
    assert_true(scaling.threads[0].same_bits);
    assert_true(scaling.threads[0].gain_of_processes > 0 &&
                isfinite(scaling.threads[0].gain_of_processes));
    assert_int_equal(scaling.run.n, 4);
    /* a step whose time is lost in the machine's noise is printed as a dash */
    char text[4096];
    for (int lost = 0; lost < 2; lost++) {
        scaling.levels[0].step_cpu_s = lost ? (double)NAN : 1e-6;
        const struct printed printed = printed_begin();
        bench_scaling_print(&scaling, &(struct table_style){"", "", "", "", ""});
        printed_end(&printed, text, sizeof text);
        assert_true(strstr(text, lost ? "\n        90            -            - "
                                      : "\n        90    1.000e-06         11.1 "));
    }
    /* numbers of threads are only compared with as many particles as the ladder has */
    assert_int_equal(
        bench_scaling_measure(&given, (size_t[2]){801, 900}, 2, 2, &brief, &scaling, &error), 0);
    assert_int_equal(scaling.thread_count, 0);
    /* a blast that would meet its images soon after t_end */
    prepare("sedov_2d", 0, NULL);
    assert_int_equal(
        bench_scaling_measure(&given, (size_t[1]){400}, 1, 2, &brief, &scaling, &error), 0);
    near_inside(scaling.levels[0].step_cpu_s, 1e-5, 1);
}

/* --- a small study: order and consistency of its points --------------------------------------- */

TEST(study)
{
    struct precision precision =
        precision_of("sod", 1, (char *[]){"t_end=0.1"},
                     "kernel=quadratic_spline,cubic_spline,eta=2,1.1", (size_t[2]){45, 90});
    assert_int_equal(precision.scheme_count, 7);
    /* eta = 1.1 is below the existence limit of either kernel: excluded */
    assert_int_equal(precision.point_count, 10);
    near_relative(precision.mean_density, 0.5625, 1e-6);
    near_inside(precision.signal, 0.3, 0.45);
    assert_int_equal(precision.order, 1);
    size_t on_front = 0;
    for (size_t i = 0; i < precision.point_count; i++) {
        const struct precision_point *p = &precision.points[i];
        assert_true(precision.schemes[p->scheme].first <= i);
        if (i && p->scheme == p[-1].scheme) assert_true(p->n > p[-1].n);
        if (i) assert_true(p->scheme >= p[-1].scheme);
        near_inside(p->error, 1e-4, 0.1);
        near_relative(p->relative, p->error / precision.signal, 1e-6);
        assert_true(p->error_spread > 0);
        on_front += p->on_front;
        assert_false(p->on_front && precision.schemes[p->scheme].reference > REFERENCE_GRADED);
    }
    assert_true(on_front >= 1);
    for (size_t i = 0; i < precision.scheme_count; i++) {
        const struct precision_scheme *scheme = &precision.schemes[i];
        assert_int_equal(scheme->count, scheme->excluded[0] ? 0 : 2);
    }
    /* scheme 4: lighter particles near the jump */
    assert_int_equal(precision.schemes[4].reference, REFERENCE_GRADED);
    near_inside(precision.points[5].error, 1e-4, 0.8 * precision.points[1].error);
    near_inside(precision.points[5].settings.value[SETTING_mass_ratio].real[0], 0.666, 0.667);
    /* it has the least error, so that it is on the front and competes */
    assert_true(precision.points[5].on_front && precision_competes(&precision.schemes[4]));
    /* both seed references have the same errors */
    const struct precision_point *seed = &precision.points[6], *plain = &precision.points[8];
    for (size_t l = 0; l < 2; l++) near_relative(plain[l].error, seed[l].error, 1e-8);
    near_relative(precision.schemes[6].gain, 1, 1e-12);
    precision_free(&precision);
}

/* Shares compute each n separately; on two processors each processor has its own front. */
TEST(front_of_each_processor)
{
    static const size_t ladder[] = {40, 60};
    static const char *const processors[] = {"this", "that"};
    struct sweep sweep;
    struct error error = {0};
    const struct pool_settings how = {.jobs = 1};
    prepare("sod", 1, (char *[]){"t_end=0.1"});
    assert_int_equal(sweep_parse(&sweep, NULL, &error), 0);
    for (int two = 0; two < 2; two++) {
        struct precision precision;
        struct pool pool = {0};
        size_t on_front[2] = {0};
        assert_int_equal(
            precision_plan(&given, &sweep, ladder, 2, &brief, &precision, &pool, &error), 0);
        assert_int_equal(pool.count, 2);
        assert_int_equal(pool_run(&pool, &how, &error), 0);
        for (size_t l = 0; l < 2; l++)
            json_object_set_new(json_object_get(pool.jobs[l].document, "machine"), "processor",
                                json_string(processors[two * (int)l]));
        /* coarse runs at a high price: on the same processor none of them is on the front */
        json_t *points = json_object_get(pool.jobs[0].document, "points"), *point;
        size_t k;
        json_array_foreach(points, k, point) json_object_set_new(point, "cpu_s", json_real(1000));
        assert_int_equal(precision_conclude(&precision, &pool, &error), 0);
        assert_int_equal(precision.point_count, 8);
        for (size_t i = 0; i < 8; i++) on_front[i % 2] += precision.points[i].on_front;
        assert_true(on_front[1] > 0);
        assert_int_equal(on_front[0] > 0, two);
        precision_free(&precision);
        pool_free(&pool);
    }
}

/* A sound wave: errors are relative to the wave, not to the gas that carries it; second order. */
TEST(errors_relative_to_the_wave)
{
    struct precision precision =
        precision_of("sound_wave", 2, (char *[]){"t_end=0.1", "amplitude=1e-4"},
                     "kernel=quadratic_spline", (size_t[2]){32, 64});
    near_relative(precision.signal, 2e-4 / 3.14159265358979, 1e-2); /* means over bins */
    assert_int_equal(precision.order, 2);
    near_relative(precision.points[0].relative, precision.points[0].error / precision.signal,
                  1e-12);
    assert_true(isnan(precision.points[0].error_spread)); /* one run has no spread */
    /* a quarter of the error for four times the work: the merit L1 x CPU is the same at any
     * resolution */
    const struct precision_point *finest = &precision.points[1];
    near_relative(precision.schemes[0].merit, finest->error * finest->time.cpu_s, 1e-12);
    for (int t = 0; t < PRECISION_TARGETS; t++)
        near_relative(precision.cheapest[t].error, precision_targets[t] * precision.signal, 1e-12);
    precision_free(&precision);
}

/* A scheme that the case's gravity excludes is reported, and the others are measured. */
TEST(schemes_excluded_by_gravity)
{
    struct precision precision = precision_of("rayleigh_taylor_mode", 1, (char *[]){"t_end=0.001"},
                                              "shifting=none,closed", (size_t[2]){288});
    assert_int_equal(precision.schemes[0].count, 1);
    assert_int_equal(precision.schemes[1].count, 0);
    assert_non_null(strstr(precision.schemes[1].excluded, "gravity=-0.5 exclude each other"));
    precision_free(&precision);
}

/* A vortex in 2D: errors are of the velocity along its circles, relative to its distance from a
 * uniform one; work grows as n^(3/2), and the merit at order 2 is error^(3/2) x CPU. */
TEST(vortex_in_2d)
{
    struct precision precision =
        precision_of("gresho", 1, (char *[]){"t_end=0.02"}, "gradient=ia", (size_t[2]){144, 256});
    assert_string_equal(precision.error_of, "azimuthal");
    /* the integral of |v_phi| over the box: 2 pi (5 0.2^3/3 + 0.4^2 - 0.2^2 - 5 (0.4^3 - 0.2^3)/3)
     */
    near_relative(precision.signal, 0.25133, 3e-2);
    assert_int_equal(precision.scheme_count, 2);
    assert_int_equal(precision.schemes[1].reference, REFERENCE_SEED);
    near_relative(precision.schemes[1].gain, 1, 1e-12);
    const struct precision_point *finest = &precision.points[1];
    near_relative(precision.schemes[0].merit, pow(finest->error, 1.5) * finest->time.cpu_s, 1e-12);
    near_relative(precision.cheapest[0].error, 0.1 * precision.signal, 1e-12);
    precision_free(&precision);
}
