/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests how keys become a prepared problem: which are refused with which message, which values the
 * problem chooses, and how long its solution holds. */
#include "test.h"

#include "functional.h"
#include "prepared.h"

TEST(impossible_settings_are_refused)
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
        {1, "boost=0.5 0", "key boost and dimension=1"},
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
        {2, "kind=square|equal_masses=yes|lattice=square", NULL}, /* it makes its own lattices */
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
        strcat(error.message, "|"); /* marks the end */
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

TEST(automatic_values_are_chosen)
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

    /* ends of each direction; one word if they are the same */
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

/* Choices that a problem makes are written to settings that were `auto`. */
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
    gravity->real[0] = gravity->real[1] = 5; /* left by another problem */
    struct problem closed = *(const struct problem *)family_find(&problem_family, "rest");
    closed.ends[0].usual = BOUNDARY_FIXED;
    assert_int_equal(problem_prepare_as(&p, &closed, &s, 2, &error), STATUS_OK);
    assert_true(p.gravity[0] == 0 && p.gravity[1] == 0);
    assert_true(gravity->given == 1 && gravity->real[0] == 0);
    assert_true(ends->given == 2 && ends->choices[0] == BOUNDARY_FIXED &&
                ends->choices[1] == BOUNDARY_PERIODIC);
}

/* ---- functions that problems share ---- */

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
    last = 1.5; /* also far below t */
    assert_int_equal(problem_check_time(&p, 0x1p60, &error), STATUS_BAD_INPUT);
    near_relative(longest_seen, 1.5 * 0.999, 1e-15);
    last = 0;
    assert_int_equal(problem_check_time(&p, 1, &error), STATUS_BAD_INPUT);
    assert_true(longest_seen == 0);
    struct problem for_ever = problem;
    for_ever.holds = NULL;
    p.problem = &for_ever;
    assert_int_equal(problem_check_time(&p, 1e9, &error), STATUS_OK);
}
