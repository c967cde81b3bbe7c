/* SPDX-License-Identifier: GPL-3.0-or-later
 * Where particles start: arrays, lattices, balls, pairs, jitter, particles of equal masses and
 * glasses, each worked out a second time. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <gsl/gsl_qrng.h>
#include <gsl/gsl_rng.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "equal_masses.h"
#include "initial_create.h"
#include "initial_fill.h"
#include "lattice.h"
#include "near.h"
#include "regularity.h"
#include "relax.h"

/* A gas that jumps, and is nowhere the same. */
static double density(const double x[3])
{
    return (x[0] < 0.3 ? 3 : 1) + 0.01 * x[0] + 0.5 * x[1] * x[1] + 0.25 * x[2];
}

static double energy(const double x[3])
{
    return 3 + x[1] + 0.1 * x[0];
}

static void sample(const struct prepared *p, const double x[3], double t, struct problem_state *s)
{
    (void)p;
    *s = (struct problem_state){.rho = density(x) * (1 + t),
                                .v = {x[0], 2 * x[0] - x[1] + t, 5 + x[2]},
                                .P = 1 + t,
                                .u = energy(x) + t};
}

static struct settings settings_of(int n, char **keys)
{
    struct settings settings;
    struct error error;
    settings_init(&settings);
    if (settings_apply(&settings, n, keys, &error)) fail_msg("%s", error.message);
    return settings;
}

static void arrays_lie_apart(void **state)
{
    (void)state;
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
                /* all of them in the room that was asked for */
                assert_true(arrays[k] + i >= initial.storage &&
                            arrays[k] + i < initial.storage + count * N);
            }
        for (int k = 0; k < count; k++)
            for (int i = 0; i < N; i++) assert_true(arrays[k][i] == 10 * k + i);
        initial_free(&initial);
        assert_true(!initial.storage && initial.n == 0 && initial.dim == 0);
    }
}

static void seeds_matter_to_some(void **state)
{
    (void)state;
    static const struct {
        char *key;
        bool shaken;
    } rows[] = {{"lattice=square", false}, {"lattice=jittered", false}, {"lattice=random", true},
                {"lattice=glass", true},   {"lattice=bcc", false},      {"jitter=0", false},
                {"jitter=0.01", true}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char *keys[] = {rows[k].key};
        const struct settings settings = settings_of(1, keys);
        assert_true(initial_is_shaken(&settings) == rows[k].shaken);
    }
}

static const struct problem plain = {.sample = sample, .smooth = false};

static bool left_of(const void *context, const double x[3])
{
    return x[0] + 0.01 * x[1] + 0.001 * x[2] < *(const double *)context;
}

/* A lattice behind what is there already, and some of it taken out again. */
static void lays_and_keeps(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        const struct prepared p = {.problem = &plain, .domain = {dim, {-1, 0, 2}, {1, 3, 4}}};
        const struct domain box = {dim, {-1, 1, 2}, {0, 2, 3}};
        struct settings settings = settings_of(0, NULL);
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
            assert_true(initial.u[i] == energy(x) && initial.rho[i] == density(x));
            near_relative(initial.m[i], density(x) / (double)n, 1e-15);
        }
        initial.n = n + first; /* the last one is nobody's */
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
            assert_true(initial.u[at] == energy(x) && initial.rho[at] == density(x));
            near_relative(initial.m[at], density(x) / (double)n, 1e-15);
            at++;
        }
        assert_int_equal(initial.n, at);
        assert_true(at > first + 4 && at < first + n - 4);
        for (size_t i = 0; i < first; i++) assert_true(initial.x[0][i] == -5);
        free(where);
        initial_free(&initial);
    }
}

/* A ball: about n lattice points of the box around it, those within. */
static void balls_are_cut_from_lattices(void **state)
{
    (void)state;
    static const double part[] = {0, 1, 3.14159265358979323846 / 4, 3.14159265358979323846 / 6};
    for (int dim = 1; dim <= 3; dim++) {
        static char *keys[] = {"n=200", "lattice=uniform"};
        keys[1] = dim == 1 ? "lattice=uniform" : dim == 2 ? "lattice=hexagonal" : "lattice=bcc";
        const struct settings settings = settings_of(2, keys);
        const struct prepared p = {.problem = &plain,
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
            near_relative(initial.m[at++], density(place) * share, 1e-14);
        }
        assert_int_equal(initial.n, at);
        near_inside((double)at, 170, 230);
        free(where);
        initial_free(&initial);
    }
}

/* ---- what the settings do to what a problem has filled ---- */

enum { LINE = 8 };

static enum status fill_line(const struct prepared *p, const struct settings *settings,
                             struct initial *initial, struct error *error)
{
    static const double x[] = {0, 1.5, 2.5, 3, 4, 5, 6.5, 7.5}, rho[] = {1, 1, 2, 2, 2, 2, 2, 2},
                        m[] = {1, 1, 1, 1, 1.5, 1, 2, 2};
    (void)p, (void)settings;
    if (initial_allocate(initial, 1, LINE, error)) return error->status;
    for (int i = 0; i < LINE; i++) {
        initial->x[0][i] = x[i];
        initial->v[0][i] = 10 + i;
        initial->m[i] = m[i];
        initial->rho[i] = rho[i];
        initial->u[i] = 20 + i;
    }
    return STATUS_OK;
}

static const struct problem line = {.sample = sample, .fill = fill_line, .smooth = true};

static struct initial created(const struct prepared *p, const struct settings *settings)
{
    struct initial initial;
    struct error error = {0};
    if (initial_create(&initial, p, settings, &error)) fail_msg("%s", error.message);
    return initial;
}

/* Pairs of like neighbours, a tenth of their distance apart, or none. */
static void pairs_of_a_line(void **state)
{
    (void)state;
    const struct prepared p = {.problem = &line, .domain = {1, {0}, {8}}, .boost = {100}};
    static const struct {
        char *key;
        double x[LINE];
    } rows[] = {{"lattice=uniform", {0, 1.5, 2.5, 3, 4, 5, 6.5, 7.5}},
                {"lattice=clustered", {0.675, 0.825, 2.725, 2.775, 4, 5, 6.95, 7.05}},
                {"lattice=coincident", {0.75, 0.75, 2.75, 2.75, 4, 5, 7, 7}}};
    for (size_t k = 0; k < 3; k++) {
        char *keys[] = {rows[k].key};
        const struct settings settings = settings_of(1, keys);
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

/* Points near the ends of each direction, with room of their own; two exactly there. */
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

/* Each place is moved by up to jitter times its spacing; round the box, back from an end that is
 * none, and on a line no further than the end. Flows without a jump are sampled again. */
static void jitter_moves_all(void **state)
{
    (void)state;
    for (int dim = 1; dim <= 3; dim++)
        for (int smooth = 0; smooth < 2; smooth++) {
            static char *keys[] = {"jitter=0.4", "seed=77"};
            const struct problem problem = {.sample = sample, .fill = fill_cloud, .smooth = smooth};
            const struct prepared p = {
                .problem = &problem,
                .domain = {dim, {-1, -1.5, -2}, {2, 2.5, 3}},
                .boundary = {BOUNDARY_PERIODIC, BOUNDARY_REFLECTING, BOUNDARY_FIXED},
                .boost = {0.5, -2, 3}};
            const struct settings settings = settings_of(2, keys), none = settings_of(0, NULL);
            struct initial before = created(&p, &none), after = created(&p, &settings);
            gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
            gsl_rng_set(random, 77);
            int over[3] = {0};
            for (int i = 0; i < CLOUD; i++) {
                double x[3] = {0};
                const double room = pow(before.m[i] / before.rho[i], 1. / dim);
                for (int d = 0; d < dim; d++) {
                    const double lo = low[d], hi = high[d];
                    x[d] = before.x[d][i] + 0.4 * room * (2 * gsl_rng_uniform(random) - 1);
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
                sample(&p, x, 0, &s);
                const bool again = dim > 1 && smooth;
                for (int d = 0; d < dim; d++)
                    near_absolute(after.v[d][i] + 99,
                                  99 + (again ? s.v[d] : 10 * d + i) + (dim > 1 ? p.boost[d] : 0),
                                  1e-12);
                assert_true(after.u[i] == (again ? s.u : 20 + i));
                assert_true(after.rho[i] == (again ? s.rho : before.rho[i]));
                assert_true(after.m[i] == before.m[i]);
                assert_true(before.u[i] == 20 + i); /* without jitter all stays */
            }
            for (int d = 0; d < dim; d++) assert_true(over[d] > 3);
            gsl_rng_free(random);
            initial_free(&before);
            initial_free(&after);
        }
}

/* A lower end belongs to the box, an upper one is the lower one of the next box. */
static void ends_of_the_box(void **state)
{
    (void)state;
    static char *keys[] = {"jitter=1e-30"};
    const struct problem problem = {.sample = sample, .fill = fill_cloud};
    const struct prepared p = {.problem = &problem,
                               .domain = {2, {-1, -1.5}, {2, 2.5}},
                               .boundary = {BOUNDARY_PERIODIC, BOUNDARY_REFLECTING}};
    const struct settings settings = settings_of(1, keys);
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

static void failures_are_passed_on(void **state)
{
    (void)state;
    const struct problem problem = {.sample = sample, .fill = fill_nothing};
    const struct prepared p = {.problem = &problem, .domain = {2, {0, 0}, {1, 1}}};
    const struct settings settings = settings_of(0, NULL);
    struct initial initial = {.storage = (double *)8}; /* nobody's */
    struct error error = {0};
    assert_int_equal(initial_create(&initial, &p, &settings, &error), STATUS_BAD_INPUT);
    assert_null(initial.storage);
    static char *few[] = {"n=9", "lattice=glass", "equal_masses=yes"};
    for (int n = 2; n <= 3; n++) { /* too few for a glass */
        const struct settings glass = settings_of(n, few);
        assert_int_equal(initial_fill(&p, &glass, &initial, &error), STATUS_BAD_INPUT);
        assert_non_null(strstr(error.message, "a glass needs more particles"));
        initial_free(&initial);
    }
    struct lattice_plan plan;
    assert_int_equal(lattice_plan_make(&plan, &p.domain, LATTICE_FCC, 100, &error),
                     STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "lattice=fcc has no form in 2 dimensions"));
}

/* ---- lattices of the whole box ---- */

static void the_whole_box_is_laid(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        static char *keys[] = {"n=64", "lattice=random", "seed=3"};
        const struct prepared p = {.problem = &plain, .domain = {dim, {-1, 0, 1}, {1, 3, 2}}};
        for (int random = 0; random < 2; random++) {
            keys[1] = random ? "lattice=random" : "lattice=hexagonal";
            const struct settings settings = settings_of(3, keys);
            struct lattice_plan plan;
            struct initial initial;
            struct error error = {0};
            assert_int_equal(initial_fill(&p, &settings, &initial, &error), STATUS_OK);
            assert_int_equal(lattice_plan_make(&plan, &p.domain,
                                               random ? LATTICE_RANDOM : LATTICE_HEXAGONAL, 64,
                                               &error),
                             STATUS_OK);
            double y[3][100], shift[3];
            double *const x[] = {y[0], y[1], y[2]};
            assert_true(plan.n == initial.n && plan.n < 100);
            gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
            gsl_qrng *sequence = gsl_qrng_alloc(gsl_qrng_sobol, (unsigned)dim);
            gsl_rng_set(rng, 3);
            for (int d = 0; d < 3; d++) shift[d] = gsl_rng_uniform(rng);
            if (!random) assert_int_equal(lattice_points(&plan, 3, x, &error), STATUS_OK);
            for (size_t i = 0; i < plan.n; i++) {
                double part[3], place[3] = {0};
                gsl_qrng_get(sequence, part);
                for (int d = 0; d < dim; d++) {
                    part[d] += shift[d];
                    if (random)
                        y[d][i] = p.domain.lo[d] +
                                  (p.domain.hi[d] - p.domain.lo[d]) * (part[d] - floor(part[d]));
                    near_absolute(initial.x[d][i] + 9, y[d][i] + 9, 1e-14);
                    place[d] = initial.x[d][i];
                }
                near_relative(initial.m[i], 6. / (double)plan.n * density(place), 1e-14);
            }
            gsl_qrng_free(sequence);
            gsl_rng_free(rng);
            initial_free(&initial);
        }
    }
}

/* ---- equal masses ---- */

/* Sobol's sequence, shifted, each point with the density's probability. */
static void equal_masses_follow_the_density(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        enum { N = 50 };
        static char *keys[] = {"n=50", "lattice=random", "seed=5", "equal_masses=yes"};
        const struct settings settings = settings_of(4, keys);
        const struct prepared p = {.problem = &plain, .domain = {dim, {-1, 0, 1}, {1, 3, 2}}};
        const int side = dim == 2 ? 512 : 96;
        double mass = 0, most = 0, shift[4];
        for (int k = 0; k < (dim == 2 ? 1 : side); k++)
            for (int j = 0; j < side; j++)
                for (int i = 0; i < side; i++) {
                    const double x[] = {-1 + 2 * (i + 0.5) / side, 3 * (j + 0.5) / side,
                                        dim == 2 ? 0 : 1 + (k + 0.5) / side};
                    mass += density(x);
                    most = fmax(most, density(x));
                }
        mass *= 6 / pow(side, dim);
        most *= 1.01;
        struct initial initial;
        struct error error = {0};
        if (initial_fill(&p, &settings, &initial, &error)) fail_msg("%s", error.message);
        assert_int_equal(initial.n, N);
        gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
        gsl_qrng *sequence = gsl_qrng_alloc(gsl_qrng_sobol, (unsigned)dim + 1);
        gsl_rng_set(random, 5);
        for (int d = 0; d < 4; d++) shift[d] = gsl_rng_uniform(random);
        int refused = 0;
        for (int i = 0; i < N;) {
            double part[4], x[3] = {0};
            gsl_qrng_get(sequence, part);
            for (int d = 0; d <= dim; d++) part[d] += shift[d], part[d] -= part[d] >= 1;
            for (int d = 0; d < dim; d++)
                x[d] = p.domain.lo[d] + (p.domain.hi[d] - p.domain.lo[d]) * part[d];
            if (part[dim] * most >= density(x)) {
                refused++;
                continue;
            }
            for (int d = 0; d < dim; d++) near_absolute(initial.x[d][i] + 9, x[d] + 9, 1e-14);
            near_relative(initial.m[i], mass / N, 1e-11);
            assert_true(initial.rho[i] == density(x) ||
                        fabs(initial.rho[i] / density(x) - 1) < 1e-13);
            i++;
        }
        assert_true(refused > 20);
        gsl_qrng_free(sequence);
        gsl_rng_free(random);
        initial_free(&initial);
    }
}

/* ---- glasses ---- */

static size_t times_asked;

struct rooms {
    int dim;
    double all;
    size_t n;
};

static double room_at(const void *context, const double x[3])
{
    const struct rooms *rooms = context;
    times_asked++;
    return rooms->all / (double)rooms->n * (1 + 0.2 * sin(2 * M_PI * (x[0] + x[1])));
}

/* Sixty sweeps over all pairs of images. */
static void relax_directly(const struct relax_room *room, size_t n, double *const x[3])
{
    const int dim = room->box.dim;
    double *width = malloc(4 * n * sizeof *width), *to = width + n, step = 0.06;
    for (int sweep = 0; sweep < 60; sweep++, step *= 0.95) {
        for (size_t i = 0; i < n; i++) {
            const double at[3] = {x[0][i], x[1][i], dim > 2 ? x[2][i] : 0};
            width[i] = 2.5 * pow(room->volume(room->context, at), 1. / dim);
        }
        for (size_t i = 0; i < 3 * n; i++) to[i] = 0;
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < n; j++) {
                double delta[3], square = 0;
                for (int d = 0; d < dim; d++) {
                    const double side = room->box.hi[d] - room->box.lo[d];
                    delta[d] = remainder(x[d][i] - x[d][j], side);
                    square += delta[d] * delta[d];
                }
                const double r = sqrt(square), q = r / (0.5 * (width[i] + width[j]));
                if (i == j || r == 0 || q >= 1) continue;
                for (int d = 0; d < dim; d++)
                    to[3 * i + (size_t)d] += (1 / pow(q + 0.1, 2) - 1 / pow(1.1, 2)) * delta[d] / r;
            }
        for (size_t i = 0; i < n; i++) {
            const double *push = to + 3 * i;
            const double size = sqrt(push[0] * push[0] + push[1] * push[1] + push[2] * push[2]);
            const double part = width[i] / 2.5 * (step * size < 0.3 ? step : 0.3 / size);
            for (int d = 0; d < dim; d++) {
                const double side = room->box.hi[d] - room->box.lo[d];
                x[d][i] += part * push[d];
                x[d][i] -= side * floor((x[d][i] - room->box.lo[d]) / side);
            }
        }
    }
    free(width);
}

static void glasses_are_pushed_apart(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        enum { MOST = 250 };
        const size_t n = dim == 2 ? 100 : 250;
        struct rooms rooms = {dim, dim == 2 ? 1.2 : 1.32, n};
        const struct relax_room room = {{dim, {-0.3, 2.1, 0.2}, {0.7, 3.3, 1.3}}, room_at, &rooms};
        double x[3][MOST], y[3][MOST], volume[MOST];
        double *const moved[] = {x[0], x[1], x[2]}, *const direct[] = {y[0], y[1], y[2]};
        struct error error = {0};
        for (size_t i = 0; i < n; i++)
            for (int d = 0; d < 3; d++)
                x[d][i] = y[d][i] =
                    room.box.lo[d] +
                    (room.box.hi[d] - room.box.lo[d]) *
                        fmod((0.7548776662 + 0.0629 * d * d) * (double)(i + 1) + 0.1 * d, 1);
        /* two of them at nearly one place are pushed as far as is allowed; two at one place not */
        for (int d = 0; d < 3; d++) {
            x[d][1] = y[d][1] = x[d][0] + 1e-5 * (d + 1);
            x[d][3] = y[d][3] = x[d][2];
        }
        if (relax_points(&room, n, moved, &error)) fail_msg("%s", error.message);
        relax_directly(&room, n, direct);
        for (size_t i = 0; i < n; i++)
            for (int d = 0; d < 3; d++) {
                near_absolute(x[d][i] + 9, y[d][i] + 9, 1e-9);
                if (d < dim) assert_true(x[d][i] >= room.box.lo[d] && x[d][i] < room.box.hi[d]);
            }
        /* as good as the regularity of a cloud with this width says */
        struct relax_quality quality;
        struct regularity found;
        struct kernel kernel;
        double h[MOST];
        for (size_t i = 0; i < n; i++) {
            volume[i] = (1 + 0.001 * (double)i) / (double)n;
            h[i] = 3.6 * pow(volume[i], 1. / dim);
        }
        const struct regularity_cloud cloud = {.box = room.box,
                                               .periodic = {true, true, true},
                                               .n = n,
                                               .x = {x[0], x[1], x[2]},
                                               .volume = volume,
                                               .h = h,
                                               .kernel = &kernel};
        assert_int_equal(kernel_select(&kernel, "wendland_c4", 0, &error), STATUS_OK);
        const double *const places[] = {x[0], x[1], x[2]};
        if (dim == 2) {
            assert_int_equal(regularity_measure(&cloud, &found, &error), STATUS_OK);
            assert_int_equal(relax_measure(&room.box, n, places, volume, &quality, &error),
                             STATUS_OK);
            near_relative(quality.density, found.density, 1e-12);
            near_relative(quality.gradient, found.gradient, 1e-12);
            near_relative(quality.spread, found.spread, 1e-12);
            near_below(quality.spread, 0.2);
        }
        rooms.n = 4;
        assert_int_equal(relax_points(&room, 4, moved, &error), STATUS_BAD_INPUT);
        assert_non_null(strstr(error.message, "n=4: a glass needs more particles"));
    }
}

/* Measured also in space, of any points. */
static void quality_of_a_cloud(void **state)
{
    (void)state;
    enum { N = 500 };
    const struct domain box = {3, {0, 1, 2}, {1, 2, 3}};
    static double x[3][N], volume[N], h[N];
    struct kernel kernel;
    struct regularity found;
    struct relax_quality quality;
    struct error error = {0};
    for (int i = 0; i < N; i++) {
        for (int d = 0; d < 3; d++)
            x[d][i] = d + fmod((0.6180339887 + 0.0629 * d * d) * (i + 1), 1);
        volume[i] = (1 + 0.0001 * i) / N;
        h[i] = 3.6 * cbrt(volume[i]);
    }
    const struct regularity_cloud cloud = {.box = box,
                                           .periodic = {true, true, true},
                                           .n = N,
                                           .x = {x[0], x[1], x[2]},
                                           .volume = volume,
                                           .h = h,
                                           .kernel = &kernel};
    const double *const places[] = {x[0], x[1], x[2]};
    assert_int_equal(kernel_select(&kernel, "wendland_c4", 0, &error), STATUS_OK);
    assert_int_equal(regularity_measure(&cloud, &found, &error), STATUS_OK);
    assert_int_equal(relax_measure(&box, N, places, volume, &quality, &error), STATUS_OK);
    near_relative(quality.density, found.density, 1e-12);
    near_relative(quality.gradient, found.gradient, 1e-12);
    near_relative(quality.spread, found.spread, 1e-12);
    volume[0] = 1; /* reaches beyond half of the box */
    assert_int_equal(relax_measure(&box, 3, places, volume, &quality, &error), STATUS_BAD_INPUT);
}

/* A glass: the random start, pushed apart with the room that each has; with masses alike as the
 * density leaves it. */
static double room_of_mass(const void *context, const double x[3])
{
    return *(const double *)context / density(x);
}

static double room_of_all(const void *context, const double x[3])
{
    (void)x;
    return *(const double *)context;
}

static void glasses_of_random_points(void **state)
{
    (void)state;
    enum { N = 300 };
    for (int equal = 0; equal < 2; equal++) {
        static char *keys[] = {"n=300", "lattice=random", "equal_masses=yes"};
        keys[1] = "lattice=random";
        keys[2] = equal ? "equal_masses=yes" : "equal_masses=no";
        const struct prepared p = {.problem = &plain, .domain = {2, {-1, 0}, {1, 2}}};
        const struct settings random = settings_of(3, keys);
        keys[1] = "lattice=glass";
        const struct settings glass = settings_of(3, keys);
        struct initial one, two;
        struct error error = {0};
        assert_int_equal(initial_fill(&p, &random, &one, &error), STATUS_OK);
        assert_int_equal(initial_fill(&p, &glass, &two, &error), STATUS_OK);
        const double mass = one.m[0], share = 4. / N;
        const struct relax_room room = {p.domain, equal ? room_of_mass : room_of_all,
                                        equal ? &mass : &share};
        assert_int_equal(relax_points(&room, N, one.x, &error), STATUS_OK);
        for (int i = 0; i < N; i++) {
            const double x[3] = {two.x[0][i], two.x[1][i]};
            near_absolute(one.x[0][i] + 9, x[0] + 9, 1e-11);
            near_absolute(one.x[1][i] + 9, x[1] + 9, 1e-11);
            near_relative(two.m[i], equal ? mass : density(x) * share, 1e-14);
            near_relative(two.rho[i], density(x), 1e-14);
        }
        initial_free(&one);
        initial_free(&two);
    }
}

/* The same everywhere, or as much where x or y is 0. */
struct plain_room {
    double volume, rise;
};

static double plain_room_at(const void *context, const double x[3])
{
    const struct plain_room *room = context;
    times_asked++;
    return room->volume * (1 + room->rise * x[0] * x[1]);
}

/* Large glasses are kept: read again where all is the same that decides where points end. */
static void large_glasses_are_kept(void **state)
{
    (void)state;
    enum { N = 1000 };
    static double x[3][N];
    char folder[] = "/tmp/sphproof_glass_XXXXXX", command[64];
    assert_non_null(mkdtemp(folder));
    const char *old = getenv("XDG_CACHE_HOME");
    char *before = old ? strdup(old) : NULL;
    setenv("XDG_CACHE_HOME", folder, 1);
    double *const places[] = {x[0], x[1], x[2]};
    static double kept[2][N];
    static const struct {
        double lo, hi, first, last, volume, rise;
        bool read;
    } rows[] = {
        {0, 1, 0, 0, 1e-3, 0, false},    {0, 1, 0, 0, 1e-3, 0, true},
        {-0.5, 1, 0, 0, 1e-3, 0, false}, {0, 1.5, 0, 0, 1e-3, 0, false},
        {0, 1, 1e-9, 0, 1e-3, 0, false}, {0, 1, 0, 1e-9, 1e-3, 0, false},
        {0, 1, 0, 0, 1.1e-3, 0, false},  {0, 1, 0, 0, 1e-3, 1e-3, false},
        {0, 1, 0, 0, 1e-3, 0, true},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct plain_room plain_room = {rows[k].volume, rows[k].rise};
        const struct relax_room room = {
            {2, {0, rows[k].lo}, {1, rows[k].hi}}, plain_room_at, &plain_room};
        struct error error = {0};
        for (int i = 0; i < N; i++)
            for (int d = 0; d < 2; d++)
                x[d][i] = 0.001 + 0.99 * fmod((0.618034 + 0.0629 * d) * (i + 1), 1);
        x[0][0] += rows[k].first;
        x[1][N - 1] += rows[k].last;
        times_asked = 0;
        assert_int_equal(relax_points(&room, N, places, &error), STATUS_OK);
        if ((times_asked == N) != rows[k].read)
            fail_msg("row %zu: asked %zu times", k, times_asked);
        for (int d = 0; d < 2; d++)
            if (k == 0)
                memcpy(kept[d], x[d], sizeof kept[d]);
            else if (rows[k].read)
                assert_memory_equal(kept[d], x[d], sizeof kept[d]);
    }
    if (before)
        setenv("XDG_CACHE_HOME", before, 1);
    else
        unsetenv("XDG_CACHE_HOME");
    free(before);
    snprintf(command, sizeof command, "rm -r %s", folder);
    assert_int_equal(system(command), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrays_lie_apart),
        cmocka_unit_test(seeds_matter_to_some),
        cmocka_unit_test(lays_and_keeps),
        cmocka_unit_test(balls_are_cut_from_lattices),
        cmocka_unit_test(pairs_of_a_line),
        cmocka_unit_test(jitter_moves_all),
        cmocka_unit_test(equal_masses_follow_the_density),
        cmocka_unit_test(ends_of_the_box),
        cmocka_unit_test(failures_are_passed_on),
        cmocka_unit_test(the_whole_box_is_laid),
        cmocka_unit_test(glasses_are_pushed_apart),
        cmocka_unit_test(quality_of_a_cloud),
        cmocka_unit_test(glasses_of_random_points),
        cmocka_unit_test(large_glasses_are_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
