/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares initial positions (lattices, balls, pairs, jitter) and their arrays with an independent
 * construction. */
#include "test.h"

#include <gsl/gsl_rng.h>

#include "gas.h"
#include "initial.h"
#include "lattice.h"

TEST(arrays_do_not_overlap)
{
    for (int dim = 1; dim <= 3; dim++) {
        enum { N = 5 };
        struct initial initial;
        struct error error = {0};
        assert_int_equal(initial_allocate(&initial, dim, N, &error), STATUS_OK);
        assert_true(initial.dim == dim && initial.n == N && !initial.ignored[0]);
        double *arrays[9] = {initial.m, initial.u, initial.rho};
        int count = 3;
        for (int d = 0; d < 3; d++) {
            assert_true(!initial.x[d] == (d >= dim) && !initial.v[d] == (d >= dim));
            if (d < dim) arrays[count++] = initial.x[d], arrays[count++] = initial.v[d];
        }
        for (int k = 0; k < count; k++)
            for (int i = 0; i < N; i++) {
                arrays[k][i] = 10 * k + i;
                /* all arrays lie in the allocated memory */
                assert_true(arrays[k] + i >= initial.storage &&
                            arrays[k] + i < initial.storage + count * N);
            }
        for (int k = 0; k < count; k++)
            for (int i = 0; i < N; i++) assert_true(arrays[k][i] == 10 * k + i);
        initial_free(&initial);
        assert_true(!initial.storage && initial.n == 0 && initial.dim == 0);
    }
}

TEST(seeds_change_random_starts_alone)
{
    static const struct {
        const char *key;
        bool shaken;
    } rows[] = {{"lattice=square", false}, {"lattice=jittered", true}, {"lattice=random", true},
                {"lattice=glass", true},   {"lattice=bcc", false},     {"jitter=0", false},
                {"jitter=0.01", true}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct settings settings = keyed_settings(rows[k].key);
        assert_true(settings_random_start(&settings) == rows[k].shaken);
    }
}

static bool left_of(const void *context, const double x[3])
{
    return x[0] + 0.01 * x[1] + 0.001 * x[2] < *(const double *)context;
}

/* A lattice is added after the particles already there, and some of it is removed again. */
TEST(lattices_are_added_and_cut)
{
    for (int dim = 2; dim <= 3; dim++) {
        const struct prepared p = {.problem = &gas_problem, .domain = {dim, {-1, 0, 2}, {1, 3, 4}}};
        const struct domain box = {dim, {-1, 1, 2}, {0, 2, 3}};
        struct settings settings = keyed_settings("");
        struct lattice_plan plan;
        struct initial initial;
        struct error error = {0};
        assert_int_equal(lattice_plan_make(&plan, &box, dim == 2 ? LATTICE_SQUARE : LATTICE_CUBIC,
                                           dim == 2 ? 16 : 64, &error),
                         STATUS_OK);
        const size_t n = plan.n, first = 3;
        assert_int_equal(n, dim == 2 ? 16 : 64);
        assert_int_equal(initial_allocate(&initial, dim, n + first + 1, &error), STATUS_OK);
        for (size_t i = 0; i < (size_t)(2 * dim + 3) * initial.n; i++) initial.storage[i] = -5;
        assert_int_equal(initial_lay(&initial, &p, &plan, first, &settings, &error), STATUS_OK);
        double *copy[3], *where = malloc(3 * n * sizeof *where);
        for (int d = 0; d < 3; d++) copy[d] = where + (size_t)d * n;
        assert_int_equal(lattice_points(&plan, 1, copy, &error), STATUS_OK);
        size_t at = first;
        for (size_t i = 0; i < n + first + 1; i++) {
            if (i < first || i == n + first) {
                assert_true(initial.m[i] == -5 && initial.x[0][i] == -5 && initial.rho[i] == -5);
                continue;
            }
            double x[3] = {0};
            for (int d = 0; d < dim; d++) {
                x[d] = copy[d][i - first];
                assert_true(initial.x[d][i] == x[d]);
            }
            assert_true(initial.v[0][i] == x[0] && initial.v[1][i] == 2 * x[0] - x[1]);
            assert_true(initial.u[i] == gas_energy(x) && initial.rho[i] == gas_density(x));
            near_relative(initial.m[i], gas_density(x) / (double)n, 1e-15);
        }
        initial.n = n + first; /* the last one must not count */
        const double edge = -0.4;
        double x[3] = {0};
        initial_keep(&initial, first, left_of, &edge);
        for (size_t i = 0; i < n; i++) {
            for (int d = 0; d < dim; d++) x[d] = copy[d][i];
            if (!left_of(&edge, x)) continue;
            for (int d = 0; d < dim; d++) assert_true(initial.x[d][at] == x[d]);
            for (int d = 0; d < dim; d++)
                assert_true(initial.v[d][at] == (d == 0   ? x[0]
                                                 : d == 1 ? 2 * x[0] - x[1]
                                                          : 5 + x[2]));
            assert_true(initial.u[at] == gas_energy(x) && initial.rho[at] == gas_density(x));
            near_relative(initial.m[at], gas_density(x) / (double)n, 1e-15);
            at++;
        }
        assert_int_equal(initial.n, at);
        assert_true(at > first + 4 && at < first + n - 4);
        for (size_t i = 0; i < first; i++) assert_true(initial.x[0][i] == -5);
        free(where);
        initial_free(&initial);
    }
}

/* A ball has about n points: those points of the surrounding box's lattice that lie within it. */
TEST(balls_are_cut_from_lattices)
{
    static const double part[] = {0, 1, 3.14159265358979323846 / 4, 3.14159265358979323846 / 6};
    for (int dim = 1; dim <= 3; dim++) {
        const struct settings settings = keyed_settings(dim == 1   ? "n=200 lattice=uniform"
                                                        : dim == 2 ? "n=200 lattice=hexagonal"
                                                                   : "n=200 lattice=bcc");
        const struct prepared p = {.problem = &gas_problem,
                                   .domain = {dim, {-1, -1, -1}, {5, 5, 5}},
                                   .window = {.dim = dim, .centre = {0.25, 0.5, 1}}};
        const double r = 1.25;
        struct domain around = {.dim = dim};
        struct lattice_plan plan;
        struct initial initial;
        struct error error = {0};
        for (int d = 0; d < dim; d++)
            around.lo[d] = p.window.centre[d] - r, around.hi[d] = p.window.centre[d] + r;
        assert_int_equal(
            lattice_plan_make(&plan, &around,
                              (enum lattice)settings_choice(&settings, SETTING_lattice),
                              (size_t)(200 / part[dim] + 0.5), &error),
            STATUS_OK);
        double *x[3], *where = malloc(3 * plan.n * sizeof *where), share = 1. / (double)plan.n;
        for (int d = 0; d < 3; d++) x[d] = where + (size_t)d * plan.n;
        for (int d = 0; d < dim; d++) share *= 2 * r;
        assert_int_equal(lattice_points(&plan, 1, x, &error), STATUS_OK);
        if (initial_fill_ball(&p, &settings, r, &initial, &error)) fail_msg("%s", error.message);
        size_t at = 0;
        for (size_t i = 0; i < plan.n; i++) {
            double squares = 0, place[3] = {0};
            for (int d = 0; d < dim; d++) {
                place[d] = x[d][i];
                squares += pow(x[d][i] - p.window.centre[d], 2);
            }
            if (squares > r * r) continue;
            for (int d = 0; d < dim; d++) assert_true(initial.x[d][at] == x[d][i]);
            near_relative(initial.m[at++], gas_density(place) * share, 1e-14);
        }
        assert_int_equal(initial.n, at);
        near_inside((double)at, 170, 230);
        free(where);
        initial_free(&initial);
    }
}

/* ---- settings applied to a filled problem ---- */

enum { LINE = 10 };

/* Neighbours with the same state, some that differ only in density or mass, three equal ones, and
 * one after the last. */
static enum status fill_line(const struct prepared *p, const struct settings *settings,
                             struct initial *initial, struct error *error)
{
    static const double x[] = {0, 1.5, 2.5, 3, 4, 5, 6, 6.5, 7.5, 8, 8.5},
                        rho[] = {1, 1, 2, 2, 2, 3, 3, 3, 3, 3, 3},
                        m[] = {1, 1, 1, 1, 1.5, 1.5, 1, 2, 2, 2, 2};
    (void)p, (void)settings;
    if (initial_allocate(initial, 1, LINE + 1, error)) return error->status;
    for (int i = 0; i <= LINE; i++) {
        initial->x[0][i] = x[i];
        initial->v[0][i] = 10 + i;
        initial->m[i] = m[i];
        initial->rho[i] = rho[i];
        initial->u[i] = 20 + i;
    }
    initial->n = LINE;
    return STATUS_OK;
}

static const struct problem line = {.sample = gas_sample, .fill = fill_line};
static const struct problem smooth_line = {.sample = gas_sample, .fill = fill_line, .smooth = true};

static struct initial created(const struct prepared *p, const struct settings *settings)
{
    struct initial initial;
    struct error error = {0};
    if (initial_create(&initial, p, settings, &error)) fail_msg("%s", error.message);
    return initial;
}

/* Equal neighbours become pairs a tenth of their distance apart; the others stay. In a smooth gas
 * those of equal masses do. */
TEST(pairs_of_a_line)
{
    static const struct {
        const char *key;
        const struct problem *problem;
        double x[LINE];
    } rows[] = {
        {"lattice=uniform", &line, {0, 1.5, 2.5, 3, 4, 5, 6, 6.5, 7.5, 8}},
        {"lattice=clustered", &line, {0.675, 0.825, 2.725, 2.775, 4, 5, 6, 6.95, 7.05, 8}},
        {"lattice=coincident", &line, {0.75, 0.75, 2.75, 2.75, 4, 5, 6, 7, 7, 8}},
        {"lattice=coincident", &smooth_line, {0.75, 0.75, 2.75, 2.75, 4.5, 4.5, 6, 7, 7, 8}}};
    for (size_t k = 0; k < 4; k++) {
        const struct prepared p = {
            .problem = rows[k].problem, .domain = {1, {0}, {9}}, .boost = {100}};
        const struct settings settings = keyed_settings(rows[k].key);
        struct initial initial = created(&p, &settings);
        assert_int_equal(initial.n, LINE);
        for (int i = 0; i < LINE; i++) {
            near_absolute(initial.x[0][i] + 1, rows[k].x[i] + 1, 1e-14);
            assert_true(initial.v[0][i] == 10 + i && initial.u[i] == 20 + i); /* no boost in 1D */
        }
        initial_free(&initial);
    }
}

enum { CLOUD = 40 };

static const double low[] = {-1, -1.5, -2}, high[] = {2, 2.5, 3};

/* Points near the ends of each direction, two exactly there, in separate memory. */
static enum status fill_cloud(const struct prepared *p, const struct settings *settings,
                              struct initial *initial, struct error *error)
{
    const int dim = p->domain.dim;
    (void)settings;
    if (initial_allocate(initial, dim, CLOUD, error)) return error->status;
    for (int i = 0; i < CLOUD; i++) {
        for (int d = 0; d < dim; d++) {
            const double away = 0.3 * pow(0.01, 1. / dim) * fmod(0.618 * (i + 1) * (d + 1), 1);
            initial->x[d][i] = i < 2          ? (i ? high[d] : low[d])
                               : (i >> d) % 2 ? low[d] + away
                                              : high[d] - away - 1e-9;
            initial->v[d][i] = 10 * d + i;
        }
        initial->m[i] = 1 + 0.01 * i;
        initial->rho[i] = 50 * (1 + i % 3);
        initial->u[i] = 20 + i;
    }
    return STATUS_OK;
}

/* Jitter moves each particle by up to jitter times its spacing: across the ends of a periodic box,
 * back from an end that is not periodic, and in 1D no further than the end. Flows without a jump
 * are then sampled again. */
TEST(jitter_moves_all)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int smooth = 0; smooth < 2; smooth++) {
            const struct problem problem = {
                .sample = gas_sample, .fill = fill_cloud, .smooth = smooth};
            const struct prepared p = {
                .problem = &problem,
                .domain = {dim, {-1, -1.5, -2}, {2, 2.5, 3}},
                .boundary = {BOUNDARY_PERIODIC, BOUNDARY_REFLECTING, BOUNDARY_FIXED},
                .boost = {0.5, -2, 3}};
            const struct settings settings = keyed_settings("jitter=0.4 seed=77"),
                                  none = keyed_settings("");
            struct initial before = created(&p, &none), after = created(&p, &settings);
            gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
            gsl_rng_set(random, 77);
            int over[3] = {0};
            for (int i = 0; i < CLOUD; i++) {
                double x[3] = {0};
                const double spacing = pow(before.m[i] / before.rho[i], 1. / dim);
                for (int d = 0; d < dim; d++) {
                    const double lo = low[d], hi = high[d];
                    x[d] = before.x[d][i] + 0.4 * spacing * (2 * gsl_rng_uniform(random) - 1);
                    over[d] += x[d] < lo || x[d] >= hi;
                    if (dim == 1)
                        x[d] = fmin(fmax(x[d], lo), nextafter(hi, 0));
                    else if (d == 0)
                        x[d] += x[d] < lo ? 3 : x[d] >= hi ? -3 : 0;
                    else
                        x[d] = x[d] < lo ? 2 * lo - x[d] : x[d] >= hi ? 2 * hi - x[d] : x[d];
                    near_absolute(after.x[d][i] + 9, x[d] + 9, 1e-14);
                    assert_true(after.x[d][i] >= lo && after.x[d][i] < hi);
                    if (i == 1) assert_true(before.x[d][i] == hi);
                }
                struct problem_state s;
                for (int d = 0; d < dim; d++) x[d] = after.x[d][i];
                gas_sample(&p, x, 0, &s);
                const bool again = dim > 1 && smooth;
                for (int d = 0; d < dim; d++)
                    near_absolute(after.v[d][i] + 99,
                                  99 + (again ? s.v[d] : 10 * d + i) + (dim > 1 ? p.boost[d] : 0),
                                  1e-12);
                assert_true(after.u[i] == (again ? s.u : 20 + i));
                assert_true(after.rho[i] == (again ? s.rho : before.rho[i]));
                assert_true(after.m[i] == before.m[i]);
                assert_true(before.u[i] == 20 + i); /* without jitter nothing changes */
            }
            for (int d = 0; d < dim; d++) assert_true(over[d] > 3);
            gsl_rng_free(random);
            initial_free(&before);
            initial_free(&after);
        }
}

/* The lower end belongs to the box, the upper one is the lower one of the next box. */
TEST(ends_belong_to_one_box)
{
    const struct problem problem = {.sample = gas_sample, .fill = fill_cloud};
    const struct prepared p = {.problem = &problem,
                               .domain = {2, {-1, -1.5, 9}, {2, 2.5, 10}},
                               .boundary = {BOUNDARY_PERIODIC, BOUNDARY_REFLECTING}};
    const struct settings settings = keyed_settings("jitter=1e-30");
    struct initial initial = created(&p, &settings);
    assert_true(initial.x[0][0] == -1 && initial.x[1][0] == -1.5);
    assert_true(initial.x[0][1] == -1 && initial.x[1][1] == nextafter(2.5, 0));
    initial_free(&initial);
}

static enum status fill_nothing(const struct prepared *p, const struct settings *settings,
                                struct initial *initial, struct error *error)
{
    (void)p, (void)settings, (void)initial;
    return error_set(error, STATUS_BAD_INPUT, "nothing");
}

TEST(failures_are_passed_on)
{
    const struct problem problem = {.sample = gas_sample, .fill = fill_nothing};
    const struct prepared p = {.problem = &problem, .domain = {2, {0, 0}, {1, 1}}};
    const struct settings settings = keyed_settings("");
    struct initial initial = {.storage = (double *)8}; /* a pointer that must not be freed */
    struct error error = {0};
    assert_int_equal(initial_create(&initial, &p, &settings, &error), STATUS_BAD_INPUT);
    assert_null(initial.storage);
    for (int equal = 0; equal < 2; equal++) { /* too few particles for a glass */
        const struct settings glass =
            keyed_settings(equal ? "n=9 lattice=glass equal_masses=yes" : "n=9 lattice=glass");
        assert_int_equal(initial_fill(&p, &glass, &initial, &error), STATUS_BAD_INPUT);
        assert_non_null(strstr(error.message, "a glass needs more particles"));
        initial_free(&initial);
    }
    struct settings of_ball = keyed_settings("n=9 lattice=glass");
    assert_int_equal(initial_fill_ball(&p, &of_ball, 0.5, &initial, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "a glass needs more particles"));
    initial_free(&initial);
    of_ball = keyed_settings("n=9 lattice=fcc"); /* in 2D */
    assert_int_equal(initial_fill_ball(&p, &of_ball, 0.5, &initial, &error), STATUS_BAD_INPUT);
    assert_int_equal(initial_fill(&p, &of_ball, &initial, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "lattice=fcc has no form in 2 dimensions"));
    struct lattice_plan plan;
    assert_int_equal(lattice_plan_make(&plan, &p.domain, LATTICE_FCC, 100, &error),
                     STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "lattice=fcc has no form in 2 dimensions"));
}
