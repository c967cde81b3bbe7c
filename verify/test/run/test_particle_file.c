/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the reader of particle files: which columns it reads, and the complete message about each
 * bad file. */
#include "test.h"

#include "initial.h"
#include "keyed.h"
#include "own_folder.h"
#include "particle_file.h"
#include "problem.h"

static char path[256];

static const char *written(const char *text)
{
    snprintf(path, sizeof path, "%s", path_of("particles.csv"));
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
    return path;
}

/* Fails unless the message ends with these words after the path. */
static void says(const struct error *error, const char *words)
{
    assert_int_equal(error->status, STATUS_BAD_INPUT);
    assert_int_equal(strncmp(error->message, path, strlen(path)), 0);
    if (strcmp(error->message + strlen(path), words) != 0)
        fail_msg("'%s' is not '%s'", error->message + strlen(path), words);
}

TEST(columns)
{
    static const struct {
        const char *text;
        int dim;
        const char *ignored;
    } good[] = {
        {"x,vx,m,u\n1,2,3,4\n5,6,7,8\n", 1, ""},
        {"u,m,vx,x\n4,3,2,1\n8,7,6,5\n", 1, ""},
        {"x,vx,m,u,y,vy\n1,2,3,4,9,10\n5,6,7,8,11,12\n", 2, ""},
        {"P,x,vx,m,u\n9,1,2,3,4\n9,5,6,7,8\n", 1, "P"},
        {"rho,z,x,vx,m,u,y,vy,vz\n15,13,1,2,3,4,9,10,14\n17,15,5,6,7,8,11,12,16\n", 3, "rho"},
        {"x,vx,m,u,y,vy,z,vz,P,a b,rho\n1,2,3,4,9,10,13,14,0,0,15\n5,6,7,8,11,12,15,16,0,0,17\n", 3,
         "P a b rho"},
    };
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        struct particle_file file;
        struct error error = {0};
        memset(&file, 0x55, sizeof file);
        if (particle_file_read(written(good[k].text), &file, &error)) fail_msg("%s", error.message);
        for (int d = good[k].dim; d < 3; d++) assert_true(!file.x[d] && !file.v[d]);
        assert_true(file.dim == good[k].dim && file.csv.rows == 2);
        assert_true(file.x[0][0] == 1 && file.v[0][0] == 2 && file.m[0] == 3 && file.u[0] == 4);
        assert_true(file.x[0][1] == 5 && file.v[0][1] == 6 && file.m[1] == 7 && file.u[1] == 8);
        if (file.dim > 1)
            assert_true(file.x[1][0] == 9 && file.v[1][0] == 10 && file.x[1][1] == 11);
        if (file.dim > 2)
            assert_true(file.x[2][0] == 13 && file.v[2][1] == 16 && file.rho[1] == 17);
        else
            assert_null(file.rho);
        assert_string_equal(file.ignored, good[k].ignored);
        particle_file_free(&file);
    }
    static const struct {
        const char *text, *words;
    } bad[] = {
        {"x,m,u\n1,1,1\n1,1,1\n",
         ":1: no column 'vx': allowed: x[,y[,z]], vx[,vy[,vz]], m, u, in any order"},
        {"vx,m,u\n1,1,1\n1,1,1\n",
         ":1: no column 'x': allowed: x[,y[,z]], vx[,vy[,vz]], m, u, in any order"},
        {"x,vx,u\n1,1,1\n1,1,1\n",
         ":1: no column 'm': allowed: x[,y[,z]], vx[,vy[,vz]], m, u, in any order"},
        {"x,vx,m\n1,1,1\n1,1,1\n",
         ":1: no column 'u': allowed: x[,y[,z]], vx[,vy[,vz]], m, u, in any order"},
        {"x,vx,m,u,y\n1,1,1,1,1\n1,1,1,1,1\n",
         ":1: no column 'vy': allowed: x[,y[,z]], vx[,vy[,vz]], m, u, in any order"},
        {"x,vx,m,u,vy\n1,1,1,1,1\n1,1,1,1,1\n",
         ":1: no column 'y': allowed: x[,y[,z]], vx[,vy[,vz]], m, u, in any order"},
        {"x,vx,m,u,z\n1,1,1,1,1\n1,1,1,1,1\n",
         ":1: no column 'y': allowed: x[,y[,z]], vx[,vy[,vz]], m, u, in any order"},
        {"x,vx,m,u,vz\n1,1,1,1,1\n1,1,1,1,1\n",
         ":1: no column 'y': allowed: x[,y[,z]], vx[,vy[,vz]], m, u, in any order"},
        {"z,x,vx,m,u\n1,1,1,1,1\n1,1,1,1,1\n",
         ":1: no column 'y': allowed: x[,y[,z]], vx[,vy[,vz]], m, u, in any order"},
        {"vz,x,vx,m,u\n1,1,1,1,1\n1,1,1,1,1\n",
         ":1: no column 'y': allowed: x[,y[,z]], vx[,vy[,vz]], m, u, in any order"},
        {"y,x,vx,m,u\n1,1,1,1,1\n1,1,1,1,1\n",
         ":1: no column 'vy': allowed: x[,y[,z]], vx[,vy[,vz]], m, u, in any order"},
        {"vy,x,vx,m,u\n1,1,1,1,1\n1,1,1,1,1\n",
         ":1: no column 'y': allowed: x[,y[,z]], vx[,vy[,vz]], m, u, in any order"},
        {"x,vx,m,u\n", ": 0 particles: allowed: 2 or more"},
        {"x,vx,m,u\n1,1,1,1\n", ": 1 particles: allowed: 2 or more"},
        {"x,vx,m,u\n1,1,1,1\n1,1,0,1\n", ":3: m = 0: allowed: above 0"},
        {"x,vx,m,u\n1,1,-2,0\n1,1,0,1\n", ":2: m = -2: allowed: above 0"},
        {"x,vx,m,u\n1,1,1,1\n\n1,1,1,0\n", ":4: u = 0: allowed: above 0"},
        {"x,vx,m,u\n1,1,3,-5\n1,1,1,1\n", ":2: u = -5: allowed: above 0"},
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        struct particle_file file;
        struct error error = {0};
        memset(&file, 0x55, sizeof file);
        assert_int_equal(particle_file_read(written(bad[k].text), &file, &error), STATUS_BAD_INPUT);
        says(&error, bad[k].words);
        particle_file_free(&file);
    }
}

TEST(setups_get_a_box)
{
    struct particle_file file;
    struct error error = {0};
    const char *text = "x,y,vx,vy,m,u\n-5,7,2,1,3,4\n1,7,6,1,7,8\n3,7,0,0,1,1\n";
    assert_int_equal(particle_file_read(written(text), &file, &error), STATUS_OK);
    struct setup setup = {.boundary = {BOUNDARY_OPEN, BOUNDARY_OPEN}};
    assert_int_equal(particle_file_fill(&file, path, &setup, &error), STATUS_OK);
    assert_true(setup.dim == 2 && setup.n == 3 && setup.m == file.m && setup.u == file.u);
    for (int d = 0; d < 2; d++) assert_true(setup.x[d] == file.x[d] && setup.v[d] == file.v[d]);
    near_relative(setup.lo[0], -5.08, 1e-15);
    near_relative(setup.hi[0], 3.08, 1e-15);
    assert_true(setup.lo[1] == 6 && setup.hi[1] == 8);
    particle_file_free(&file); /* the outermost particle may be the first or the last one */
    assert_int_equal(
        particle_file_read(written("x,vx,m,u\n5,0,1,1\n1,0,1,1\n-3,0,1,1\n"), &file, &error),
        STATUS_OK);
    setup = (struct setup){.boundary = {BOUNDARY_OPEN}};
    assert_int_equal(particle_file_fill(&file, path, &setup, &error), STATUS_OK);
    near_relative(setup.lo[0], -3.08, 1e-15);
    near_relative(setup.hi[0], 5.08, 1e-15);
    particle_file_free(&file);
    assert_int_equal(particle_file_read(written(text), &file, &error), STATUS_OK);
    /* a given box is kept; both its ends are inside */
    setup = (struct setup){
        .lo = {-5, 6.5}, .hi = {3, 7}, .boundary = {BOUNDARY_OPEN, BOUNDARY_PERIODIC}};
    assert_int_equal(particle_file_fill(&file, path, &setup, &error), STATUS_OK);
    assert_true(setup.lo[0] == -5 && setup.hi[0] == 3 && setup.lo[1] == 6.5 && setup.hi[1] == 7);
    setup.hi[0] = 2.5;
    assert_int_equal(particle_file_fill(&file, path, &setup, &error), STATUS_BAD_INPUT);
    says(&error, ":4: x = 3: allowed: inside of the box, -5 to 2.5");
    setup.hi[0] = 3, setup.lo[1] = 7.5, setup.hi[1] = 9;
    assert_int_equal(particle_file_fill(&file, path, &setup, &error), STATUS_BAD_INPUT);
    says(&error, ":2: y = 7: allowed: inside of the box, 7.5 to 9");
    setup = (struct setup){.boundary = {BOUNDARY_PERIODIC, BOUNDARY_OPEN}}; /* no box is derived */
    assert_int_equal(particle_file_fill(&file, path, &setup, &error), STATUS_BAD_INPUT);
    says(&error, ":2: x = -5: allowed: inside of the box, 0 to 0");
    for (int open = 0; open < 2; open++) { /* one axis has a given box, one a derived one */
        setup = (struct setup){.boundary = {open ? BOUNDARY_PERIODIC : BOUNDARY_OPEN,
                                            open ? BOUNDARY_OPEN : BOUNDARY_PERIODIC}};
        setup.lo[!open] = -9, setup.hi[!open] = 9;
        assert_int_equal(particle_file_fill(&file, path, &setup, &error), STATUS_OK);
        near_relative(setup.lo[open], open ? 6 : -5.08, 1e-15);
        assert_true(setup.lo[!open] == -9 && setup.hi[!open] == 9);
    }
    particle_file_free(&file);
}

/* ---- the start of a run ---- */

static double known_density;

static void sample(const struct prepared *p, const double x[3], double t, struct problem_state *s)
{
    (void)p;
    *s =
        (struct problem_state){.rho = known_density > 0 ? known_density + x[0] + 10 * x[1] + t : 0};
}

static const struct problem problem = {.sample = sample, .smooth = true};

#define PLANE "x,y,vx,vy,m,u"

TEST(starts_of_runs)
{
    const struct prepared p = {
        .problem = &problem, .domain = {2, {0, 0}, {2, 4}}, .boost = {0.5, 0.25}};
    struct initial initial;
    struct error error = {0};
    /* the problem's density if it has one, else the file's, else the mean density */
    for (int kind = 0; kind < 3; kind++) {
        const char *text = kind < 2 ? PLANE
                               ",rho,P\n1,2,3,4,5,6,7,0\n0,3,8,9,10,11,12,0\n1,1,1,1,1,1,1,0\n"
                                    : PLANE ",P\n1,2,3,4,5,6,0\n0,3,8,9,10,11,0\n";
        known_density = kind ? 0 : 3;
        if (particle_file_start(written(text), &p, &initial, &error)) fail_msg("%s", error.message);
        assert_true(initial.dim == 2 && initial.n == (kind < 2 ? 3 : 2));
        assert_true(initial.x[0][0] == 1 && initial.x[1][0] == 2 && initial.x[0][1] == 0 &&
                    initial.x[1][1] == 3);
        assert_true(initial.v[0][0] == 3 && initial.v[1][0] == 4 && initial.v[0][1] == 8 &&
                    initial.v[1][1] == 9);
        assert_true(initial.m[0] == 5 && initial.m[1] == 10 && initial.u[0] == 6 &&
                    initial.u[1] == 11);
        near_relative(initial.rho[0], kind == 0 ? 24 : kind == 1 ? 7 : 15 / 8., 1e-15);
        near_relative(initial.rho[1], kind == 0 ? 33 : kind == 1 ? 12 : 15 / 8., 1e-15);
        assert_string_equal(initial.ignored, "P");
        initial_free(&initial);
    }
    known_density = 0; /* all columns are read */
    assert_int_equal(particle_file_start(written(PLANE ",rho\n1,2,3,4,5,6,7\n0,3,8,9,10,11,12\n"),
                                         &p, &initial, &error),
                     STATUS_OK);
    assert_string_equal(initial.ignored, "");
    initial_free(&initial);
    /* settings apply: a boost, but no jitter */
    char keys[300];
    snprintf(keys, sizeof keys, "file=%s jitter=0.3 lattice=random",
             written(PLANE "\n1,2,3,4,5,6\n0,3,8,9,10,11\n"));
    const struct settings settings = keyed_settings(keys);
    assert_int_equal(initial_create(&initial, &p, &settings, &error), STATUS_OK);
    assert_true(initial.x[0][0] == 1 && initial.x[1][1] == 3);
    assert_true(initial.v[0][0] == 3.5 && initial.v[1][0] == 4.25 && initial.v[1][1] == 9.25);
    initial_free(&initial);
    unlink(path);
    assert_int_equal(initial_create(&initial, &p, &settings, &error), STATUS_BAD_INPUT);
    struct particle_file file;
    assert_int_equal(particle_file_read(path, &file, &error), STATUS_BAD_INPUT);
    particle_file_free(&file);
}

TEST(starts_that_are_refused)
{
    static const struct {
        const char *text, *words; /* NULL: allowed */
        enum boundary ends[2];
    } rows[] = {
        {"x,vx,m,u\n1,1,1,1\n1,1,1,1\n",
         ":1: particles in 1D, but the case has dimension = 2",
         {0, 0}},
        {PLANE "\n1,1,1,1,1,1\n2.5,1,1,1,1,1\n",
         ":3: x = 2.5: allowed: inside of the box, 0 to 2",
         {0, 0}},
        {PLANE "\n1,1,1,1,1,1\n2.5,1,1,1,1,1\n", NULL, {BOUNDARY_OPEN, BOUNDARY_PERIODIC}},
        {PLANE "\n1,1,1,1,1,1\n-0.5,1,1,1,1,1\n",
         ":3: x = -0.5: allowed: inside of the box, 0 to 2",
         {0, 0}},
        {PLANE "\n1,1,1,1,1,1\n1,-1.5,1,1,1,1\n",
         ":3: y = -1.5: allowed: inside of the box, -1 to 4",
         {BOUNDARY_OPEN, BOUNDARY_REFLECTING}},
        {PLANE "\n0,4,1,1,1,1\n2,-1,1,1,1,1\n", NULL, {0, 0}},
        {PLANE "\n1,1,1,1,1,1\n1,1,1,1,1,1\n",
         ":1: no column 'rho': boundary=fixed keeps particles at their density",
         {0, BOUNDARY_FIXED}},
        {PLANE "\n1,1,1,1,1,1\n1,1,1,1,1,1\n",
         ":1: no column 'rho': boundary=fixed keeps particles at their density",
         {BOUNDARY_FIXED, 0}},
        {PLANE "\n2.5,1,1,1,1,1\n1,1,1,1,1,1\n",
         ":2: x = 2.5: allowed: inside of the box, 0 to 2",
         {0, BOUNDARY_OPEN}},
        {PLANE ",rho\n1,1,1,1,1,1,1\n1,1,1,1,1,1,1\n", NULL, {0, BOUNDARY_FIXED}},
        {PLANE ",rho\n1,1,1,1,1,1,1\n1,1,1,1,1,1,0\n", ":3: rho = 0: allowed: above 0", {0, 0}},
        {PLANE ",rho\n1,1,1,1,1,1,-3\n1,1,1,1,1,1,0\n", ":2: rho = -3: allowed: above 0", {0, 0}},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct prepared p = {.problem = &problem,
                                   .domain = {2, {0, -1}, {2, 4}},
                                   .boundary = {rows[k].ends[0], rows[k].ends[1]}};
        struct initial initial = {0};
        struct error error = {0};
        const enum status status = particle_file_start(written(rows[k].text), &p, &initial, &error);
        if (rows[k].words)
            says(&error, rows[k].words);
        else if (status)
            fail_msg("row %zu: %s", k, error.message);
        assert_true(!status == !rows[k].words);
        initial_free(&initial);
    }
}
