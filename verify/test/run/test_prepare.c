/* SPDX-License-Identifier: GPL-3.0-or-later
 * From keys to a prepared problem: what is refused, with the words that help, and what becomes of
 * the rest; what problems share: boosts, circles, directions, times up to which they hold. */
#include "test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "functional.h"
#include "near.h"
#include "prepared.h"

TEST(what_cannot_be_is_refused)
{
    static const struct {
        int dim;
        const char *keys, *words; /* NULL: allowed */
    } rows[] = {
        /* directions */
        {2, "kind=rest|lo=0 0", NULL},
        {3, "kind=rest|lo=0 0",
         "lo=\"0 0\": one number for all directions or one each is needed, "
         "and the case has 3 of them"},
        {2, "kind=rest|hi=1 1 1", "hi=\"1 1 1\": one number"},
        {2, "kind=rest|boost=1 1 1", "boost=\"1 1 1\""},
        {2, "kind=shear|direction=1 1 1", "direction=\"1 1 1\""},
        {2, "kind=rest|boundary=fixed fixed fixed", "boundary=\"fixed fixed fixed\": one word"},
        {2, "kind=particles|gravity=1 1 1", "gravity=\"1 1 1\""},
        {3, "kind=rest|boundary=fixed fixed fixed", NULL},
        /* boxes */
        {2, "kind=rest|lo=0 0|hi=1 0", "lo=0 hi=0: lo < hi is needed"},
        {2, "kind=rest|lo=0 0|hi=0 1", "lo=0 hi=0: lo < hi is needed"},
        {2, "kind=rest|lo=0 2|hi=1 1", "lo=2 hi=1"},
        {2, "kind=rest|lo=0 2|hi=1 2.1", NULL},
        {1, "lo=-1|hi=1|window=-1 1", NULL},
        {1, "lo=-1|hi=1|window=-1.01 0.5",
         "window=\"-1.01 0.5\": two rising numbers in the box [-1, 1]"},
        {1, "lo=-1|hi=1|window=0.5 1.01", "window=\"0.5 1.01\""},
        {1, "lo=-1|hi=1|window=0.5 0.5", "window=\"0.5 0.5\""},
        {1, "lo=-1|hi=1|window=0.5 0.25", "window=\"0.5 0.25\""},
        {1, "lo=-1|hi=1|window=0.25 0.5", NULL},
        /* dimensions */
        {1, "kind=rest", "rest has no form in 1 dimensions; allowed: 2 to 3"},
        {3, "kind=gresho", "gresho has no form in 3 dimensions; allowed: 2 to 2"},
        {3, "kind=rest", NULL},
        {1, "balsara=on", "key balsara and dimension=1 exclude each other: it is for 2 and 3"},
        {2, "grade=0.5", "key grade and dimension=2 exclude each other: it is for 1"},
        {3, "grade_ratio=1.25", "key grade_ratio and dimension=3 exclude each other"},
        {2, "kind=rest|left=1 0 1",
         "key left and an initial state of kind rest exclude each other"},
        {1, "background=1 0 1", "key background and an initial state of kind riemann"},
        /* boosts */
        {2, "kind=noh|boost=0 1", "key boost and an initial state of kind noh exclude each other"},
        {2, "kind=noh|boost=0 0", NULL},
        {2, "kind=noh|boost=1 0", "key boost and an initial state of kind noh"},
        {1, "boost=1", "key boost and dimension=1"},
        {1, "window_radius=1", "key window_radius and dimension=1"},
        {2, "kind=rest|boost=0 1", NULL},
        {2, "kind=rest|boost=0 1|boundary=periodic fixed",
         "boost=1 along y and boundary=fixed exclude each other"},
        {2, "kind=rest|boost=-2 0|boundary=fixed periodic", "boost=-2 along x and boundary=fixed"},
        {2, "kind=rest|boost=0 1|boundary=fixed periodic", NULL},
        /* ends */
        {2, "kind=rest|boundary=open",
         "boundary=open along x and an initial state of kind rest exclude each other: its solution "
         "would not hold; allowed: periodic reflecting fixed"},
        {2, "kind=rest|boundary=fixed open", "boundary=open along y and"},
        {3, "kind=rest|boundary=fixed reflecting open", "boundary=open along z and"},
        {2, "kind=noh|boundary=fixed", "allowed: periodic open"},
        {2, "kind=noh|boundary=open", NULL},
        {2, "kind=shear|boundary=fixed", "allowed: periodic"},
        {2, "kind=rayleigh_taylor_mode|boundary=periodic fixed", NULL},
        {2, "kind=rayleigh_taylor_mode|boundary=periodic reflecting", NULL},
        {2, "kind=rayleigh_taylor_mode|boundary=periodic",
         "boundary=periodic along y and an initial state of kind rayleigh_taylor_mode exclude each "
         "other: its solution would not hold; allowed: reflecting fixed|"},
        /* gravity */
        {2, "kind=rest|gravity=0 1", "gravity=1 along y and an initial state of kind rest exclude"},
        {2, "kind=rest|gravity=-1 0", "gravity=-1 along x"},
        {2, "kind=rest|gravity=0", NULL},
        /* lattices */
        {1, "lattice=clustered", NULL},
        {1, "lattice=coincident", NULL},
        {1, "lattice=uniform", NULL},
        {1, "lattice=square", "lattice=square has no form in 1 dimension|"},
        {1, "lattice=glass", "lattice=glass has no form in 1 dimension"},
        {2, "kind=rest|lattice=uniform", "lattice=uniform has no form in 2 dimensions|"},
        {2, "kind=rest|lattice=clustered", "lattice=clustered has no form in 2 dimensions"},
        {2, "kind=rest|lattice=coincident", "lattice=coincident has no form in 2 dimensions"},
        {2, "kind=rest|lattice=square", NULL},
        {3, "kind=rest|lattice=square", "lattice=square has no form in 3"},
        {2, "kind=rest|lattice=cubic", "lattice=cubic has no form in 2"},
        {3, "kind=rest|lattice=cubic", NULL},
        {2, "kind=rest|lattice=hexagonal", NULL},
        {3, "kind=rest|lattice=hexagonal", NULL},
        {2, "kind=rest|lattice=fcc", "lattice=fcc has no form in 2"},
        {3, "kind=rest|lattice=fcc", NULL},
        {2, "kind=rest|lattice=bcc", "lattice=bcc has no form in 2"},
        {3, "kind=rest|lattice=bcc", NULL},
        {2, "kind=rest|lattice=jittered", NULL},
        {3, "kind=rest|lattice=jittered", NULL},
        {1, "lattice=jittered", "lattice=jittered has no form in 1"},
        {2, "kind=rest|lattice=random", NULL},
        {3, "kind=rest|lattice=random", NULL},
        {1, "lattice=random", "lattice=random has no form in 1"},
        {2, "kind=rest|lattice=glass", NULL},
        {3, "kind=rest|lattice=glass", NULL},
        {2, "kind=yee|equal_masses=yes|lattice=square",
         "lattice=square and equal_masses=yes exclude each other"},
        {2, "kind=yee|equal_masses=yes|lattice=random", NULL},
        {2, "kind=yee|equal_masses=yes|lattice=glass", NULL},
        {2, "kind=yee|equal_masses=no|lattice=square", NULL},
        {2, "kind=square|equal_masses=yes|lattice=square", NULL}, /* has lattices of its own */
        /* files */
        {2, "kind=yee|file=p.csv|n=100",
         "key n and file=p.csv exclude each other: its particles are as they are"},
        {2, "kind=yee|file=p.csv|lattice=square", "key lattice and file=p.csv"},
        {2, "kind=yee|file=p.csv|jitter=0.1", "key jitter and file=p.csv"},
        {2, "kind=yee|file=p|n=100", "key n and file=p exclude"},
        {2, "kind=square|file=p.csv|equal_masses=yes", "key equal_masses and file=p.csv"},
        {2, "kind=square|file=p.csv|contrast=2", NULL},
        {2, "kind=yee|file=p.csv|seed=2", "key seed and file=p.csv"},
        {2, "kind=yee|file=p.csv|equal_masses=yes", "key equal_masses and file=p.csv"},
        {2, "kind=rest|file=p.csv|background=1 0 1", NULL},
        {2, "kind=yee|n=100|lattice=square|jitter=0.1|seed=2", NULL},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct prepared p;
        struct settings settings;
        struct error error;
        const enum status status = prepared_try(&p, &settings, rows[k].dim, rows[k].keys, &error);
        if (!rows[k].words && status) fail_msg("%s: %s", rows[k].keys, error.message);
        if (!rows[k].words) continue;
        strcat(error.message, "|"); /* its end */
        if (status != STATUS_BAD_INPUT || !strstr(error.message, rows[k].words))
            fail_msg("%s: '%s' expected, said: %s", rows[k].keys, rows[k].words, error.message);
    }
}

TEST(problems_have_their_dimensions)
{
    static const struct {
        const char *name;
        int least, most;
    } rows[] = {{"gresho", 2, 2},    {"kelvin_helmholtz", 2, 2},
                {"noh", 1, 3},       {"kelvin_helmholtz_mode", 2, 2},
                {"particles", 1, 3}, {"rayleigh_taylor_mode", 2, 2},
                {"rest", 2, 3},      {"riemann", 1, 3},
                {"rotation", 2, 2},  {"sedov", 2, 3},
                {"shear", 2, 3},     {"sound_wave", 1, 3},
                {"square", 2, 3},    {"yee", 2, 2}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct problem *p =
            (const struct problem *)family_find(&problem_family, rows[k].name);
        assert_true(p->least_dim == rows[k].least && p->most_dim == rows[k].most);
    }
}

TEST(what_is_left_open_is_chosen)
{
    struct settings s;
    struct prepared p =
        prepared_of(&s, 2, "kind=rest|lo=-1 2|hi=3 4|boost=0.5 -0.25|window_radius=0.75");
    assert_true(p.domain.dim == 2 && p.window.dim == 2 && s.dim == 2 &&
                p.gamma == settings_real(&s, SETTING_gamma));
    assert_true(p.domain.lo[0] == -1 && p.domain.lo[1] == 2 && p.domain.hi[0] == 3 &&
                p.domain.hi[1] == 4);
    assert_true(p.window.lo[0] == -1 && p.window.lo[1] == 2 && p.window.hi[0] == 3 &&
                p.window.hi[1] == 4);
    assert_true(p.window.centre[0] == 1 && p.window.centre[1] == 3 && p.window.radius == 0.75);
    assert_true(p.boost[0] == 0.5 && p.boost[1] == -0.25 && p.boost[2] == 0);
    assert_int_equal(settings_choice(&s, SETTING_lattice), LATTICE_SQUARE);
    assert_true(settings_real(&s, SETTING_jitter) == 0);
    assert_true(s.value[SETTING_gravity].given == 1 && s.value[SETTING_gravity].real[0] == 0);
    assert_true(s.value[SETTING_window].real[0] == -1 && s.value[SETTING_window].real[1] == 3);
    assert_true(s.value[SETTING_window_radius].real[0] == 0.75);
    assert_true(s.value[SETTING_boundary].given == 1 &&
                s.value[SETTING_boundary].choices[0] == BOUNDARY_PERIODIC);

    p = prepared_of(&s, 1, "window=-0.25 0.5");
    assert_true(p.window.lo[0] == -0.25 && p.window.hi[0] == 0.5 && p.window.radius == 0 &&
                p.boost[0] == 0);
    assert_int_equal(settings_choice(&s, SETTING_lattice), LATTICE_UNIFORM);
    p = prepared_of(&s, 3, "kind=rest|lattice=jittered");
    assert_true(settings_real(&s, SETTING_jitter) == 0.2);
    p = prepared_of(&s, 3, "kind=rest|lattice=jittered|jitter=0.1");
    assert_true(settings_real(&s, SETTING_jitter) == 0.1);
    p = prepared_of(&s, 3, "kind=rest");
    assert_int_equal(settings_choice(&s, SETTING_lattice), LATTICE_CUBIC);
    p = prepared_of(&s, 2, "kind=yee|equal_masses=yes");
    assert_int_equal(settings_choice(&s, SETTING_lattice), LATTICE_GLASS);
    p = prepared_of(&s, 2, "kind=square|equal_masses=yes");
    assert_int_equal(settings_choice(&s, SETTING_lattice), LATTICE_SQUARE);

    /* ends of each direction; one word where they are alike */
    p = prepared_of(&s, 3, "kind=rest|boundary=fixed periodic reflecting");
    const struct setting_value *ends = &s.value[SETTING_boundary];
    assert_true(p.boundary[0] == BOUNDARY_FIXED && p.boundary[1] == BOUNDARY_PERIODIC &&
                p.boundary[2] == BOUNDARY_REFLECTING);
    assert_true(ends->given == 3 && ends->choices[0] == BOUNDARY_FIXED &&
                ends->choices[1] == BOUNDARY_PERIODIC && ends->choices[2] == BOUNDARY_REFLECTING);
    p = prepared_of(&s, 3, "kind=rest|boundary=periodic periodic fixed");
    assert_int_equal(ends->given, 3);
    p = prepared_of(&s, 3, "kind=rest|boundary=fixed");
    assert_true(ends->given == 1 && p.boundary[2] == BOUNDARY_FIXED);
    p = prepared_of(&s, 2, "kind=particles|file=a.csv|gravity=0.5 -2");
    const struct setting_value *gravity = &s.value[SETTING_gravity];
    assert_true(p.gravity[0] == 0.5 && p.gravity[1] == -2 && p.gravity[2] == 0);
    assert_true(gravity->given == 2 && gravity->real[0] == 0.5 && gravity->real[1] == -2);
    p = prepared_of(&s, 3, "kind=particles|file=a.csv|gravity=0 0 1");
    assert_true(gravity->given == 3 && gravity->real[2] == 1 && gravity->real[1] == 0);
    p = prepared_of(&s, 3, "kind=particles|file=a.csv|gravity=0 1 0");
    assert_true(gravity->given == 3 && gravity->real[1] == 1);
    p = prepared_of(&s, 3, "kind=particles|file=a.csv|gravity=1 0 0");
    assert_true(gravity->given == 3 && gravity->real[0] == 1);
    p = prepared_of(&s, 2, "kind=particles|file=a.csv");
    assert_true(gravity->given == 1 && gravity->real[0] == 0);
    p = prepared_of(&s, 2, "kind=particles|file=a.csv|gravity=-1.5");
    assert_true(p.gravity[0] == -1.5 && p.gravity[1] == -1.5 && p.gravity[2] == 0);
    assert_true(gravity->given == 2 && gravity->real[1] == -1.5);
    p = prepared_of(&s, 2, "kind=rest|boundary=fixed");
    assert_true(p.boundary[1] == BOUNDARY_FIXED && p.boundary[2] == BOUNDARY_PERIODIC);
}

/* What a problem chooses is written where it was asked for, over what was there. */
TEST(choices_are_written_back)
{
    struct settings s;
    struct error error;
    struct prepared p = prepared_of(&s, 2, "kind=rayleigh_taylor_mode|hi=1 3");
    struct setting_value *gravity = &s.value[SETTING_gravity], *ends = &s.value[SETTING_boundary];
    assert_true(gravity->automatic && gravity->given == 2 && gravity->real[0] == 0 &&
                gravity->real[1] == -0.125);
    assert_true(ends->automatic && ends->given == 2 && ends->choices[0] == BOUNDARY_PERIODIC &&
                ends->choices[1] == BOUNDARY_REFLECTING);
    p = prepared_of(&s, 2, "kind=noh");
    assert_true(p.window.radius > 0 && s.value[SETTING_window_radius].real[0] == p.window.radius);
    assert_true(s.value[SETTING_window].real[0] == p.window.lo[0] && p.window.lo[0] > -1);
    prepared_of(&s, 2, "kind=rest");
    gravity->real[0] = gravity->real[1] = 5; /* of another problem before */
    struct problem closed = *(const struct problem *)family_find(&problem_family, "rest");
    closed.ends[0].usual = BOUNDARY_FIXED;
    assert_int_equal(problem_prepare_as(&p, &closed, &s, 2, &error), STATUS_OK);
    assert_true(p.gravity[0] == 0 && p.gravity[1] == 0);
    assert_true(gravity->given == 1 && gravity->real[0] == 0);
    assert_true(ends->given == 2 && ends->choices[0] == BOUNDARY_FIXED &&
                ends->choices[1] == BOUNDARY_PERIODIC);
}

/* ---- what problems share ---- */

static double longest_seen, last = 0.625;

static void sample(const struct prepared *p, const double x[3], double t, struct problem_state *s)
{
    (void)p;
    *s = (struct problem_state){.rho = x[0], .v = {x[1], x[2], 7}, .P = t, .u = 5};
}

static bool holds(const struct prepared *p, double t)
{
    (void)p;
    return t <= last;
}

static enum status refuse(const struct prepared *p, double t, double longest, struct error *error)
{
    (void)p;
    longest_seen = longest;
    return error_set(error, STATUS_BAD_INPUT, "%g", t);
}

static const struct problem problem = {.sample = sample, .holds = holds, .refuse = refuse};

TEST(boosts_carry_places)
{
    const struct prepared p = {.problem = &problem,
                               .domain = {2, {-1, 2.5}, {1, 6.5}},
                               .boost = {0, 3, 0}},
                          both = {.problem = &problem,
                                  .domain = {2, {-1, 2.5}, {1, 6.5}},
                                  .boost = {0.5, 3, 0}};
    struct problem_state s;
    problem_sample(&p, (double[]){9, 3, 4}, 0.5, &s);
    assert_true(s.rho == 9 && s.v[0] == 5.5 && s.v[1] == 7 && s.v[2] == 7 && s.P == 0.5);
    problem_sample(&p, (double[]){9, 5.5, 4}, 0.5, &s);
    assert_true(s.v[0] == 4);
    problem_sample(&p, (double[]){9, 4, 4}, 0.5, &s); /* the lower end, not the upper one */
    assert_true(s.v[0] == 2.5);
    problem_sample(&both, (double[]){9, 3, 4}, 0.5, &s);
    assert_true(s.rho == 0.75 && s.v[0] == 6 && s.v[1] == 7);
    const double x[3][2] = {{1, -3}, {2, 5}, {8, 8}}, v[3][2] = {{1, 2}, {3, 4}, {8, 8}};
    const struct snapshot snapshot = {
        .n = 2, .x = {x[0], x[1], x[2]}, .v = {v[0], v[1], v[2]}, .time = 0.25};
    double place[4] = {9, 9, 9, -7}, velocity[4] = {9, 9, 9, -7};
    problem_place(&p, &snapshot, 1, place);
    problem_velocity(&p, &snapshot, 1, velocity);
    assert_true(place[0] == -3 && place[1] == 4.25 && place[2] == 0 && place[3] == -7);
    assert_true(velocity[0] == 2 && velocity[1] == 1 && velocity[2] == 0 && velocity[3] == -7);
    for (int f = 0; f < FIELDS; f++)
        assert_true(problem_field(&(struct problem_state){1, {2, 9, 9}, 3, 4}, (enum field)f) ==
                    f + 1);
}

TEST(times_that_hold)
{
    struct prepared p = {.problem = &problem};
    struct error error = {0};
    assert_int_equal(problem_check_time(&p, 0.625, &error), STATUS_OK);
    assert_int_equal(problem_check_time(&p, 2, &error), STATUS_BAD_INPUT);
    near_relative(longest_seen, 0.625 * 0.999, 1e-15);
    assert_string_equal(error.message, "2");
    assert_int_equal(problem_check_time(&p, 1e9, &error), STATUS_BAD_INPUT);
    near_relative(longest_seen, 0.625 * 0.999, 1e-8);
    last = 1.5; /* halved sixty times */
    assert_int_equal(problem_check_time(&p, 0x1p60, &error), STATUS_BAD_INPUT);
    near_relative(longest_seen, 0.999, 1e-15);
    last = 0;
    assert_int_equal(problem_check_time(&p, 1, &error), STATUS_BAD_INPUT);
    assert_true(longest_seen == 0);
    struct problem for_ever = problem;
    for_ever.holds = NULL;
    p.problem = &for_ever;
    assert_int_equal(problem_check_time(&p, 1e9, &error), STATUS_OK);
}

TEST(circles)
{
    struct problem round = problem;
    struct prepared p = {.problem = &round, .domain = {.dim = 2}, .window = {.centre = {1, 2, 3}}};
    double along, out;
    near_relative(problem_radius(&p, (double[]){4, 6, 99}), 5, 1e-15);
    problem_circular(&p, (double[]){4, 6, 99}, (double[]){2, -3, 5}, &along, &out);
    near_relative(out, (3 * 2 - 4 * 3) / 5., 1e-15);
    near_relative(along, (-3 * 3 - 4 * 2) / 5., 1e-15);
    problem_circular(&p, (double[]){1, 2, 99}, (double[]){2, 1, 0}, &along, &out);
    assert_true(along == 0 && out == 0);
    p.domain.dim = 3;
    near_relative(problem_radius(&p, (double[]){3, 5, 9}), 7, 1e-15);
    problem_circular(&p, (double[]){3, 5, 9}, (double[]){2, -1, 0.5}, &along, &out);
    near_relative(out, (2 * 2 - 3 + 6 * 0.5) / 7, 1e-15);
    near_relative(along, sqrt(5.25 - out * out), 1e-15);
    problem_circular(&p, (double[]){1, 2, 3}, (double[]){3, 0, 4}, &along, &out);
    assert_true(along == 5 && out == 0);
    problem_circular(&p, (double[]){3, 5, 9}, (double[]){0.2, 0.3, 0.6}, &along, &out);
    near_absolute(along, 0, 1e-15); /* of its own size, not of its root's */
    for (int dim = 1; dim <= 3; dim++)
        for (int kind = CIRCULAR_NOT; kind <= CIRCULAR_RADIAL; kind++) {
            p.domain.dim = dim;
            round.circular = (enum circular)kind;
            assert_true(problem_is_circular(&p) == (dim > 1 && kind != CIRCULAR_NOT));
        }
}

TEST(directions)
{
    const struct prepared p = {.problem = &problem, .domain = {3, {-1, 0, 1}, {1, 3, 5}}};
    struct settings settings;
    struct error error;
    double n[4] = {0, 0, 0, -7}, length = 0;
    settings_init(&settings);
    assert_int_equal(problem_direction(&p, &settings, n, &length, &error), STATUS_OK);
    assert_true(n[0] == 1 && n[1] == 0 && n[2] == 0 && length == 2);
    const struct setting_value *given = &settings.value[SETTING_direction];
    assert_true(given->given == 3 && given->real[0] == 1 && given->real[1] == 0 &&
                given->real[2] == 0);
    char *keys[] = {"direction=1 -2 3"};
    assert_int_equal(settings_apply(&settings, 1, keys, &error), STATUS_OK);
    assert_int_equal(problem_direction(&p, &settings, n, &length, &error), STATUS_OK);
    const double k[3] = {1 / 2., -2 / 3., 3 / 4.}, size = sqrt(0.25 + 4 / 9. + 9 / 16.);
    near_relative(length, 1 / size, 1e-15);
    for (int d = 0; d < 3; d++) near_relative(n[d], k[d] / size, 1e-15);
    assert_true(n[3] == -7);
    keys[0] = "direction=1 0 0.5";
    assert_int_equal(settings_apply(&settings, 1, keys, &error), STATUS_OK);
    assert_int_equal(problem_direction(&p, &settings, n, &length, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "0.5 is no integer"));
    keys[0] = "direction=0";
    assert_int_equal(settings_apply(&settings, 1, keys, &error), STATUS_OK);
    assert_int_equal(problem_direction(&p, &settings, n, &length, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "runs nowhere"));
}

TEST(states_of_gas)
{
    static const struct {
        const char *text, *words;
    } rows[] = {{"background=1 0 1", NULL},
                {"background=0 1 2", "background=\"0 1 2\": rho v P with rho > 0 and P > 0 is "
                                     "needed (particles cannot fill a vacuum)"},
                {"background=1 2 0", "is needed"}};
    for (size_t k = 0; k < 3; k++) {
        struct settings settings;
        struct error error = {0};
        char text[64], *keys[] = {text};
        settings_init(&settings);
        snprintf(text, sizeof text, "%s", rows[k].text);
        assert_int_equal(settings_apply(&settings, 1, keys, &error), STATUS_OK);
        assert_int_equal(problem_check_state(&settings, SETTING_background, &error),
                         rows[k].words ? STATUS_BAD_INPUT : STATUS_OK);
        if (rows[k].words) assert_non_null(strstr(error.message, rows[k].words));
        assert_true(!strstr(error.message, "vacuum") == (k != 1));
    }
}

/* Which keys and functionals belong to whom. */
TEST(lists)
{
    const struct problem *rest = (const struct problem *)family_find(&problem_family, "rest"),
                         *mode = (const struct problem *)family_find(&problem_family,
                                                                     "kelvin_helmholtz_mode");
    struct settings s;
    assert_true(problem_reads(rest, SETTING_background) && problem_reads(rest, SETTING_eta));
    assert_true(!problem_reads(rest, SETTING_left) && !problem_reads(rest, SETTING_equal_masses));
    static const enum setting plane[] = {
        SETTING_boost,         SETTING_viscosity_form, SETTING_balsara,
        SETTING_balsara_floor, SETTING_noise,          SETTING_alpha_u,
        SETTING_window_radius, SETTING_gravity,        SETTING_shifting};
    prepared_of(&s, 1, "");
    for (size_t k = 0; k < sizeof plane / sizeof *plane; k++)
        assert_true(problem_foreign(&s, plane[k]));
    assert_false(problem_foreign(&s, SETTING_grade) || problem_foreign(&s, SETTING_grade_ratio));
    prepared_of(&s, 1, "kind=sound_wave");
    assert_true(problem_foreign(&s, SETTING_direction));
    prepared_of(&s, 2, "");
    assert_true(problem_foreign(&s, SETTING_grade) && problem_foreign(&s, SETTING_grade_ratio));
    prepared_of(&s, 2, "kind=sound_wave");
    assert_false(problem_foreign(&s, SETTING_direction));
    for (size_t k = 0; k < sizeof plane / sizeof *plane; k++)
        assert_false(problem_foreign(&s, plane[k]));
    assert_true(problem_foreign(&s, SETTING_grade) && problem_foreign(&s, SETTING_grade_ratio));
    assert_string_equal(problem_functional(rest, "velocity_rms"), "velocity_rms");
    assert_null(problem_functional(rest, "growth_rate"));
    assert_null(problem_functional(mode, "velocity_rms"));
    assert_string_equal(problem_functional(mode, "growth_rate"), "growth_rate");
    assert_string_equal(problem_functional(mode, "mode_error"), "mode_error");
    assert_string_equal(problem_functional_name("growth_rate"), "growth_rate");
    assert_string_equal(problem_functional_name("velocity_rms"), "velocity_rms");
    assert_string_equal(problem_functional_name("shock_position"), "shock_position");
    assert_null(problem_functional_name("no such thing"));
}
