/* SPDX-License-Identifier: GPL-3.0-or-later
 * Files of particles: columns in any order, what is not read by name, boxes put around, and of bad
 * ones the whole message; and what pages show of particles over an exact curve. */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cloud_profile.h"
#include "initial.h"
#include "near.h"
#include "particle_file.h"
#include "profile.h"
#include "value.h"

static char path[] = "sphproof_particles_XXXXXX";

static void written(const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

TEST(good_files)
{
    static const struct {
        const char *text, *ignored;
        int dim;
        bool rho;
    } files[] = {
        {"x,vx,m,u\n1,2,3,4\n5,6,7,8\n", "", 1, false},
        {"u,id,m,vx,x,h\n4,0,3,2,1,9\n8,1,7,6,5,9\n", "id h", 1, false},
        {"rho,u,m,vx,x\n9,4,3,2,1\n9,8,7,6,5\n", "rho", 1, true},
        {"vy,y,x,vx,m,u,P\n0,0,1,2,3,4,5\n0,0,5,6,7,8,5\n", "P", 2, false},
        {"vz,z,vy,y,x,vx,m,u\n0,0,0,0,1,2,3,4\n0,0,0,0,5,6,7,8\n", "", 3, false},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        struct particle_file file;
        struct error error;
        written(files[i].text);
        if (particle_file_read(path, &file, &error)) fail_msg("%s", error.message);
        assert_int_equal(file.dim, files[i].dim);
        assert_string_equal(file.ignored, files[i].ignored);
        assert_int_equal(file.csv.rows, 2);
        for (size_t k = 0; k < 2; k++) {
            const double first = 4. * (double)k;
            assert_true(file.x[0][k] == first + 1 && file.v[0][k] == first + 2 &&
                        file.m[k] == first + 3 && file.u[k] == first + 4);
            for (int a = 1; a < file.dim; a++) assert_true(file.x[a][k] == 0 && file.v[a][k] == 0);
        }
        assert_int_equal(file.rho != NULL, files[i].rho);
        if (file.rho) assert_true(file.rho[0] == 9 && file.rho[1] == 9);
        particle_file_free(&file);
    }
}

static void said(const char *message, const char *want)
{
    char whole[300];
    snprintf(whole, sizeof whole, "%s:%s", path, want);
    if (strcmp(message, whole) != 0) fail_msg("'%s'\n   is not '%s'", message, whole);
}

TEST(bad_files)
{
#define COLUMNS "allowed: x[,y[,z]], vx[,vy[,vz]], m, u, in any order"
    static const struct {
        const char *text, *message;
    } files[] = {
        {"x,m,u\n1,1,1\n2,1,1\n", "1: no column 'vx': " COLUMNS},
        {"x,vx,y,m,u\n1,1,1,1,1\n", "1: no column 'vy': " COLUMNS},
        {"x,vx,vz,m,u\n1,1,1,1,1\n", "1: no column 'y': " COLUMNS},
        {"x,vx,y,vy,vz,m,u\n1,1,1,1,1,1,1\n", "1: no column 'z': " COLUMNS},
        {"x,vx,u\n1,1,1\n", "1: no column 'm': " COLUMNS},
        {"x,vx,m\n1,1,1\n", "1: no column 'u': " COLUMNS},
        {"x,vx,m,u\n1,1,1,1\n", " 1 particles: allowed: 2 or more"},
        {"x,vx,m,u\n1,1,1,1\n1,1,0,2\n", "3: m = 0: allowed: above 0"},
        {"x,vx,m,u\n1,1,1,-3\n1,1,1,2\n", "2: u = -3: allowed: above 0"},
        {"x,vx,m,u\n1,1,-2,-3\n1,1,1,2\n", "2: m = -2: allowed: above 0"},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        struct particle_file file;
        struct error error;
        written(files[i].text);
        assert_int_equal(particle_file_read(path, &file, &error), STATUS_BAD_INPUT);
        said(error.message, files[i].message);
        particle_file_free(&file);
    }
}

/* A setup's box: its own, or where a direction is open and has none, one a hundredth wider than the
 * particles; who is outside is named by line and coordinate. */
TEST(boxes)
{
    struct particle_file file;
    struct error error;
    written("x,vx,y,vy,m,u\n1,0,5,0,1,1\n3,0,5,0,1,1\n2,0,5,0,1,1\n");
    assert_int_equal(particle_file_read(path, &file, &error), STATUS_OK);
    struct setup setup = {.boundary = {BOUNDARY_OPEN, BOUNDARY_OPEN, BOUNDARY_PERIODIC}};
    assert_int_equal(particle_file_fill(&file, path, &setup, &error), STATUS_OK);
    assert_true(setup.dim == 2 && setup.n == 3 && setup.m == file.m && setup.u == file.u);
    assert_true(setup.x[1] == file.x[1] && setup.v[1] == file.v[1] && !setup.x[2]);
    near_relative(setup.lo[0], 0.98, 1e-15);
    near_relative(setup.hi[0], 3.02, 1e-15);
    assert_true(setup.lo[1] == 4 && setup.hi[1] == 6);
    setup = (struct setup){.lo = {1, 5}, .hi = {3, 5.5}};
    assert_int_equal(particle_file_fill(&file, path, &setup, &error), STATUS_OK);
    setup.hi[0] = 2.5;
    assert_int_equal(particle_file_fill(&file, path, &setup, &error), STATUS_BAD_INPUT);
    said(error.message, "3: x = 3: allowed: inside of the box, 1 to 2.5");
    setup = (struct setup){.lo = {1, 5.25}, .hi = {3, 5.5}};
    assert_int_equal(particle_file_fill(&file, path, &setup, &error), STATUS_BAD_INPUT);
    said(error.message, "2: y = 5: allowed: inside of the box, 5.25 to 5.5");
    particle_file_free(&file);
}

static struct run resolved(const char *name, int n, const char *const *words)
{
    struct run_settings settings;
    struct run run = {0};
    struct error error = {0};
    if (run_prepare(&settings, name, n, (char *const *)(uintptr_t)words, &error) ||
        run_resolve(&run, &settings, &error))
        fail_msg("%s: %s", name, error.message);
    return run;
}

/* The start of a run: the file's particles; a density that the problem knows, or the file's. */
TEST(starts)
{
    struct initial initial;
    struct error error;
    const struct run run = resolved("gresho", 0, NULL);
    written("x,vx,y,vy,m,u,rho,id\n0.25,1,0.5,2,3,4,5,6\n0.75,7,0.5,8,9,10,11,12\n");
    assert_int_equal(particle_file_start(path, &run.problem, &initial, &error), STATUS_OK);
    assert_string_equal(initial.ignored, "id");
    assert_true(initial.n == 2 && initial.dim == 2);
    assert_true(initial.x[0][1] == 0.75 && initial.x[1][1] == 0.5 && initial.v[0][1] == 7 &&
                initial.v[1][1] == 8 && initial.m[1] == 9 && initial.u[1] == 10);
    assert_true(initial.rho[0] == 1 && initial.rho[1] == 1); /* Gresho's */
    initial_free(&initial);
    written("x,vx,m,u\n0.25,1,3,4\n0.75,7,9,10\n");
    assert_int_equal(particle_file_start(path, &run.problem, &initial, &error), STATUS_BAD_INPUT);
    said(error.message, "1: particles in 1D, but the case has dimension = 2");
    written("x,vx,y,vy,m,u\n0.25,1,0.5,2,3,4\n0.75,7,1.5,8,9,10\n");
    assert_int_equal(particle_file_start(path, &run.problem, &initial, &error), STATUS_BAD_INPUT);
    said(error.message, "3: y = 1.5: allowed: inside of the box, 0 to 1");
    written("x,vx,y,vy,m,u,rho\n0.25,1,0.5,2,3,4,1\n0.75,7,0.5,8,9,10,0\n");
    assert_int_equal(particle_file_start(path, &run.problem, &initial, &error), STATUS_BAD_INPUT);
    said(error.message, "3: rho = 0: allowed: above 0");
}

/* ---- what pages show ---- */

static struct run_result ran(const char *name, int n, const char *const *words)
{
    const struct run run = resolved(name, n, words);
    struct run_result result = {0};
    struct error error = {0};
    if (run_execute(&run, &result, &error)) fail_msg("%s: %s", name, error.message);
    return result;
}

static double at(const json_t *object, const char *name, size_t i)
{
    return value_real(json_array_get(json_object_get(object, name), i));
}

/* Each particle that is shown is one of the window's, with its own values; few enough to be seen.
 */
static void shown(const struct run_result *run, const json_t *profile, bool around)
{
    const struct prepared *p = &run->problem;
    const struct snapshot *s = &run->snapshot;
    const size_t n = json_array_size(json_object_get(profile, "x"));
    size_t inside = 0, k = 0;
    for (size_t i = 0; i < s->n; i++) {
        struct problem_state exact;
        double place[3] = {0}, v[3] = {0}, x[3] = {0}, square = 0;
        problem_place(p, s, i, place);
        problem_velocity(p, s, i, v);
        if (!window_contains(&p->window, place)) continue;
        inside++;
        for (int d = 0; d < p->domain.dim; d++) {
            square += pow(place[d] - p->window.centre[d], 2);
            x[d] = s->x[d][i];
        }
        const double abscissa = around ? sqrt(square) : place[0];
        if (k >= n || at(profile, "x", k) != abscissa || at(profile, "density", k) != s->rho[i])
            continue;
        problem_sample(p, x, run->time, &exact);
        near_relative(at(profile, "exact_density", k), exact.rho, 1e-9);
        assert_true(at(profile, "pressure", k) == s->P[i]);
        near_relative(at(profile, "exact_pressure", k), exact.P, 1e-9);
        const double dx = place[0] - p->window.centre[0], dy = place[1] - p->window.centre[1];
        if (around)
            near_below(fabs(at(profile, "azimuthal", k) - (dx * v[1] - dy * v[0]) / abscissa),
                       1e-12);
        else
            assert_true(at(profile, "velocity", k) == v[0]);
        k++;
    }
    assert_int_equal(k, n); /* all of them, in their order */
    if (inside < 500)
        assert_int_equal(n, inside);
    else
        near_inside((double)n, 300, 800);
}

static void curve_is_exact(const struct run_result *run, const json_t *profile, bool around)
{
    const struct prepared *p = &run->problem;
    const json_t *exact = json_object_get(profile, "exact");
    const size_t n = json_array_size(json_object_get(exact, "x"));
    const double middle = p->window.centre[0], from = around ? 0 : p->window.lo[0],
                 to = p->window.hi[0] - (around ? middle : 0);
    assert_true(n > 100);
    for (size_t i = 0; i < n; i++) {
        struct problem_state state;
        const double x = from + (to - from) * ((double)i + 0.5) / (double)n;
        double place[3] = {around ? middle + x : x, p->window.centre[1], p->window.centre[2]};
        for (int d = 0; d < 3; d++) place[d] += p->boost[d] * run->time;
        near_relative(at(exact, "x", i), x, 1e-12);
        problem_sample(p, place, run->time, &state);
        near_relative(at(exact, "density", i), state.rho, 1e-9);
        near_relative(at(exact, "pressure", i), state.P, 1e-9);
        if (around) near_below(fabs(at(exact, "azimuthal", i) - (state.v[1] - p->boost[1])), 1e-9);
        if (around) near_below(fabs(at(exact, "radial", i) - (state.v[0] - p->boost[0])), 1e-9);
        if (!around) near_below(fabs(at(exact, "velocity", i) - (state.v[0] - p->boost[0])), 1e-9);
    }
}

TEST(curves)
{
    static const struct {
        const char *name, *words[3], *over;
    } cases[] = {
        {"gresho", {"n=16^2", "t_end=0.02", "boost=0.25"}, "R"},
        {"yee", {"n=40^2", "t_end=0.01", "cfl=1"}, "R"},
        {"sound_wave_2d", {"n=16^2", "t_end=0.02", "direction=1 0"}, "x"},
        {"sound_wave_2d", {"n=16^2", "t_end=0.02", "direction=1 1"}, NULL},
        {"kelvin_helmholtz", {"n=16^2", "t_end=0.02", "boost=0.25"}, NULL},
    };
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        struct run_result run = ran(cases[c].name, 3, cases[c].words);
        json_t *profile = cloud_profile_json(&run);
        const json_t *map = json_object_get(profile, "map");
        assert_true(value_member(profile, "dim") == 2);
        assert_int_equal(json_object_get(map, "error") != NULL, !run.problem.problem->fieldless);
        const size_t cells =
            json_array_size(json_object_get(map, "x")) * json_array_size(json_object_get(map, "y"));
        assert_true(json_array_size(json_object_get(map, "density")) == cells && cells >= 64);
        for (size_t i = 0; i < cells; i++) {
            near_inside(at(map, "density", i), 0.1, 2.5);
            near_inside(at(map, "speed", i), 0, 2);
        }
        if (cases[c].over) {
            const bool around = *cases[c].over == 'R';
            assert_string_equal(value_text(profile, "over"), cases[c].over);
            shown(&run, profile, around);
            curve_is_exact(&run, profile, around);
        } else {
            assert_null(json_object_get(profile, "over"));
            assert_null(json_object_get(profile, "exact"));
        }
        json_decref(profile);
        run_free(&run);
    }
}

/* In 1D: every particle of the window in its place, and the exact curve to both ends of it, with
 * all its bends. */
TEST(line)
{
    static const char *const fields[] = {"density", "velocity", "pressure"};
    struct run_result run = ran("sod", 2, (const char *const[]){"n=120", "window=-0.3,0.45"});
    const struct snapshot *s = &run.snapshot;
    json_t *profile = profile_json(&run);
    const json_t *exact = json_object_get(profile, "exact");
    size_t k = 0;
    for (size_t i = 0; i < s->n; i++) {
        struct problem_state state_there;
        if (!(s->x[0][i] >= -0.3 && s->x[0][i] <= 0.45)) continue;
        problem_sample(&run.problem, (double[3]){s->x[0][i]}, run.time, &state_there);
        const double got[] = {s->rho[i], s->v[0][i], s->P[i]};
        const double want[] = {state_there.rho, state_there.v[0], state_there.P};
        assert_true(at(profile, "x", k) == s->x[0][i]);
        for (size_t f = 0; f < 3; f++) {
            char name[40];
            snprintf(name, sizeof name, "exact_%s", fields[f]);
            assert_true(at(profile, fields[f], k) == got[f]);
            near_below(fabs(at(profile, name, k) - want[f]), 1e-14);
        }
        k++;
    }
    assert_int_equal(json_array_size(json_object_get(profile, "x")), k);
    const size_t n = json_array_size(json_object_get(exact, "x"));
    near_relative(at(exact, "x", 0), -0.3, 1e-12);
    near_relative(at(exact, "x", n - 1), 0.45, 1e-12);
    size_t next = 1;
    for (int i = 0; i <= 1000; i++) { /* straight lines between its points are the solution */
        struct problem_state state_there;
        const double x = -0.3 + 0.75 * (i + 0.5) / 1001;
        while (next + 1 < n && at(exact, "x", next) < x) next++;
        const double x0 = at(exact, "x", next - 1), x1 = at(exact, "x", next);
        const double part = (x - x0) / (x1 - x0);
        problem_sample(&run.problem, (double[3]){x}, run.time, &state_there);
        if (fabs(x / 0.2 - 1.7521557) < 0.05 || fabs(x / 0.2 - 0.92745) < 0.05)
            continue; /* jumps */
        near_below(fabs((1 - part) * at(exact, "density", next - 1) +
                        part * at(exact, "density", next) - state_there.rho),
                   2e-3);
    }
    json_decref(profile);
    run_free(&run);
}

int main(void)
{
    const int file = mkstemp(path);
    if (file < 0) return 1;
    close(file);
    const int failed = test_run(NULL, NULL);
    unlink(path);
    return failed;
}
