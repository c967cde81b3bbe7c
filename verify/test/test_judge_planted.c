/* SPDX-License-Identifier: GPL-3.0-or-later
 * A snapshot judged, with values planted whose answer is known: noise, sums, place in the box,
 * gamma and time, and what is far from the solution. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>
#include <string.h>
#include <cmocka.h>

#include "judge.h"
#include "made_place.h"
#include "near.h"

enum { N = 240 };

static uint64_t seed = 26;
static double uniform(double lo, double hi)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return lo + (hi - lo) * (double)(seed >> 11) / 9007199254740992.;
}

/* A snapshot as text: only those columns that are set. */
struct planted {
    int dim;
    char head[200];
    bool has_u, has_P, has_h;
    double x[3][N], v[3][N], m[N], rho[N], u[N], P[N], h[N];
};

static struct planted gas;

/* Gas at random places in [lo, lo + (2, 1, 1)], at rest and in equilibrium. */
static void plant(int dim, double lo, const char *head)
{
    gas = (struct planted){.dim = dim, .has_u = true};
    snprintf(gas.head, sizeof gas.head, "%s", head);
    for (int i = 0; i < N; i++) {
        for (int d = 0; d < dim; d++) gas.x[d][i] = uniform(lo, lo + (d ? 1 : 2));
        gas.m[i] = uniform(1, 2) / N;
        gas.rho[i] = 1, gas.u[i] = 2.5, gas.P[i] = 1;
    }
    for (int d = 0; d < dim; d++) gas.x[d][0] = lo, gas.x[d][1] = lo + (d ? 1 : 2);
}

static char *put(const char *name)
{
    char *path = path_of(name);
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fprintf(out, "%s", gas.head);
    for (int d = 0; d < gas.dim; d++) fprintf(out, "%c,v%c,", 'x' + d, 'x' + d);
    fprintf(out, "m%s%s%s,rho\n", gas.has_u ? ",u" : "", gas.has_P ? ",P" : "",
            gas.has_h ? ",h" : "");
    for (int i = 0; i < N; i++) {
        for (int d = 0; d < gas.dim; d++) fprintf(out, "%.17g,%.17g,", gas.x[d][i], gas.v[d][i]);
        fprintf(out, "%.17g", gas.m[i]);
        if (gas.has_u) fprintf(out, ",%.17g", gas.u[i]);
        if (gas.has_P) fprintf(out, ",%.17g", gas.P[i]);
        if (gas.has_h) fprintf(out, ",%.17g", gas.h[i]);
        fprintf(out, ",%.17g\n", gas.rho[i]);
    }
    fclose(out);
    return path;
}

/* Two gases that are the same. */
static struct judge_request uniform_gas(void)
{
    return (struct judge_request){.case_name = "sod",
                                  .left = "1 0 1",
                                  .right = "1 0 1",
                                  .gamma = {true, 1.4},
                                  .time = {true, 0.1},
                                  .kernel = -1};
}

static void judges(const struct judge_request *request, struct judged *judged)
{
    struct error error = {0};
    if (judge_snapshot(put("a.csv"), request, judged, &error)) fail_msg("%s", error.message);
}

static void refuses(const struct judge_request *request, const char *says)
{
    struct judged judged;
    struct error error = {0};
    const enum status status = judge_snapshot(put("a.csv"), request, &judged, &error);
    judge_free(&judged);
    if (status != STATUS_BAD_INPUT || !strstr(error.message, says))
        fail_msg("status %d, '%s' is not in: %s", (int)status, says, error.message);
}

static const struct snapshot_note *note(const struct judged *judged, const char *what)
{
    const struct snapshot_notes *notes = &judged->file.notes;
    for (size_t k = notes->count; k-- > 0;)
        if (strcmp(notes->note[k].what, what) == 0) return &notes->note[k];
    fail_msg("nothing is said about %s", what);
    return NULL;
}

static const char *const boxes[] = {"", "# box = 2\n", "# box = 2 1\n", "# box = 2 1 1\n"};

/* ---- noise ---- */

/* rms over the volume in the window, of the velocities across the flow alone. */
static void noise(void **state)
{
    (void)state;
    for (int dim = 1; dim <= 3; dim++)
        for (int only = 0; only <= dim; only++) { /* which velocity there is; dim: all */
            struct judged judged;
            const struct judge_request request = uniform_gas();
            double sum = 0, volume = 0;
            plant(dim, 0, boxes[dim]);
            for (int i = 0; i < N; i++) {
                gas.rho[i] = uniform(1, 1.5);
                for (int d = 0; d < dim; d++)
                    if (only == d || only == dim) gas.v[d][i] = uniform(-1e-3, 1e-3);
            }
            for (int i = 0; i < N; i++) {
                if (!(fabs(gas.x[0][i] - 1) <= 0.5)) continue;
                const double V = gas.m[i] / gas.rho[i];
                for (int d = 1; d < dim; d++) sum += V * gas.v[d][i] * gas.v[d][i];
                volume += V;
            }
            judges(&request, &judged);
            if (dim == 1)
                assert_true(isnan(judged.transverse));
            else if (only == 0)
                assert_true(judged.transverse == 0);
            else
                near_relative(judged.transverse, sqrt(sum / volume), 1e-13);
            judge_free(&judged);
        }
    /* a vortex: the radial one */
    struct judged judged;
    struct judge_request request = {.case_name = "gresho", .time = {true, 0}, .kernel = -1};
    plant(2, 0, "");
    for (int i = 0; i < N; i++) {
        gas.x[0][i] = gas.x[0][i] / 2 - 0.5, gas.x[1][i] -= 0.5;
        const double r = hypot(gas.x[0][i], gas.x[1][i]);
        for (int d = 0; d < 2; d++) gas.v[d][i] = 0.01 * gas.x[d][i] / r;
    }
    judges(&request, &judged);
    near_relative(judged.transverse, 0.01, 1e-12);
    judge_free(&judged);
}

/* ---- sums ---- */

static void sums(void **state)
{
    (void)state;
    for (int dim = 1; dim <= 3; dim++)
        for (int shifted = 0; shifted < 2; shifted++) {
            struct judged judged;
            const struct judge_request request = uniform_gas();
            struct conservation want = {0};
            plant(dim, 0, boxes[dim]);
            for (int d = 0; d < dim; d++) gas.x[d][1] -= 1e-6; /* the end is the beginning */
            for (int i = 0; i < N; i++) {
                gas.rho[i] = uniform(1, 1.5), gas.u[i] = uniform(2, 3);
                for (int d = 0; d < dim; d++) gas.v[d][i] = uniform(-1e-2, 2e-2);
            }
            for (int i = 0; i < N; i++) {
                const double c = sqrt(1.4 * 0.4 * gas.u[i]), m = gas.m[i];
                double p[3] = {0}, r[3] = {0}, speed = 0, distance = 0, turning = 0;
                for (int d = 0; d < dim; d++) {
                    p[d] = m * gas.v[d][i];
                    r[d] = gas.x[d][i] - (d ? 0.5 : 1);
                    speed = hypot(speed, gas.v[d][i]), distance = hypot(distance, r[d]);
                    want.momentum[d] += p[d];
                }
                want.mass += m;
                want.energy += m * gas.u[i] + 0.5 * m * speed * speed;
                want.momentum_scale += m * speed;
                want.sound_scale += m * c;
                want.turning_scale += distance * m * c;
                if (dim == 1) continue;
                const double L[3] = {r[1] * p[2] - r[2] * p[1], r[2] * p[0] - r[0] * p[2],
                                     r[0] * p[1] - r[1] * p[0]};
                for (int d = 0; d < 3; d++)
                    want.angular_momentum[d] += L[d], turning = hypot(turning, L[d]);
                want.angular_scale += turning;
            }
            /* as seen from elsewhere in the periodic box: wrapped back */
            for (int i = 2; i < N && shifted; i++)
                if (gas.x[0][i] > 1.5) gas.x[0][i] -= 2;
            if (shifted) gas.x[0][0] = 0, gas.x[0][1] = 0;
            if (shifted) snprintf(gas.head, sizeof gas.head, "# box = 2 1 1\n");
            judges(&request, &judged);
            const struct conservation *got = &judged.sums;
            if (!shifted) near_relative(got->turning_scale, want.turning_scale, 1e-13);
            near_relative(got->mass, want.mass, 1e-13);
            near_relative(got->energy, want.energy, 1e-13);
            near_relative(got->momentum_scale, want.momentum_scale, 1e-13);
            near_relative(got->sound_scale, want.sound_scale, 1e-13);
            for (int d = 0; d < 3; d++) {
                near_absolute(got->momentum[d], want.momentum[d], 1e-14);
                if (!shifted)
                    near_absolute(got->angular_momentum[d], want.angular_momentum[d], 1e-14);
            }
            if (!shifted && dim > 1) near_relative(got->angular_scale, want.angular_scale, 1e-13);
            if (dim == 1) assert_true(got->angular_scale == 0);
            judge_free(&judged);
        }
}

/* ---- gamma, time ---- */

static void gammas(void **state)
{
    static const struct {
        double said, in_file, planted, scatter, want; /* 0: not there */
        const char *evidence;
    } rows[] = {
        {1.3, 1.5, 1.2, 0, 1.3, "--gamma; but the file's own P/(rho u)"},
        {1.3, 1.5, 1.3, 0, 1.3, "--gamma"},
        {0, 1.5, 1.2, 0, 1.5, "the file says so; but the file's own P/(rho u)"},
        {0, 1.5, 1.5, 0, 1.5, "the file says so"},
        {0, (double)1.4f, 0, 0, 1.4, "the file says so"},
        {0, (double)(5 / 3.f), 0, 0, 5 / 3., "the file says so"},
        {0, 1.4 * (1 + 1.4e-7), 0, 0, 1.4, "the file says so"},
        {0, 1.4 * (1 + 1.6e-7), 0, 0, 1.4 * (1 + 1.6e-7), "the file says so"},
        {0, 1.23456, 0, 0, 1.23456, "the file says so"},
        {0, 0, 1.25, 0, 1.25, "the file has none, but P = (gamma - 1) rho u of its particles"},
        {0, 0, 1.25, 9e-6, 1.25, "the file has none, but P = (gamma - 1) rho u"},
        {0, 0, 1.25, 3e-5, 1.4, "the file has none: the case's"},
        {0, 0, 0, 0, 1.4, "the file has none: the case's"}};
    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct judge_request request = uniform_gas();
        struct judged judged;
        plant(1, 0, "");
        gas.has_P = rows[k].planted > 0;
        if (rows[k].in_file > 0)
            snprintf(gas.head, sizeof gas.head, "# gamma = %.17g\n", rows[k].in_file);
        for (int i = 0; i < N; i++) {
            gas.rho[i] = uniform(1, 1.5), gas.u[i] = i == 5 ? 0 : uniform(2, 3);
            gas.P[i] = (rows[k].planted - 1) * gas.rho[i] * gas.u[i];
        }
        gas.P[9] *= 1 + rows[k].scatter * 1.25 / 0.25; /* of gamma itself */
        request.gamma = (struct snapshot_value){rows[k].said > 0, rows[k].said};
        judges(&request, &judged);
        near_relative(judged.run.problem.gamma, rows[k].want, 1e-15);
        const char *evidence = note(&judged, "gamma")->evidence;
        if (strncmp(evidence, rows[k].evidence, strlen(rows[k].evidence)) != 0 ||
            (!strstr(rows[k].evidence, ";") && strstr(evidence, ";")))
            fail_msg("row %zu: %s", k, evidence);
        judge_free(&judged);
    }
}

static void times(void **state)
{
    struct judge_request request = uniform_gas();
    struct judged judged;
    (void)state;
    plant(1, 0, "# time = 0.125\n");
    judges(&request, &judged);
    assert_true(judged.result.time == 0.1 && judged.file.time.value == 0.1);
    assert_string_equal(note(&judged, "time")->evidence, "--time");
    judge_free(&judged);
    request.time.known = false;
    judges(&request, &judged);
    assert_true(judged.result.time == 0.125 && judged.run.problem.problem);
    assert_string_equal(note(&judged, "time")->evidence, "the file says so");
    judge_free(&judged);
    gas.head[0] = '\0';
    refuses(&request, "says no time; --time T helps");
    request.time = (struct snapshot_value){true, -1e-9};
    refuses(&request, "allowed: 0 or above");
    request.time.value = 0;
    judges(&request, &judged);
    assert_true(judged.result.time == 0);
    judge_free(&judged);
    snprintf(gas.head, sizeof gas.head, "# time = -1\n");
    request.time.known = false;
    refuses(&request, "time = -1; allowed: 0 or above");
}

/* ---- place ---- */

static void places(void **state)
{
    static const struct {
        double lo, hi; /* of the particles */
        const char *head;
        double x0; /* asked; 9: not */
        double want_lo, want_hi, window[2];
        bool periodic;
        const char *box;
    } rows[] = {
        {0, 2, "# box = 2\n", 9, 0, 2, {0.5, 1.5}, true, "positions lie in it"},
        {0, 2, "# box = 2\n", 0.75, -0.25, 1.75, {0.25, 1.25}, true, "positions lie in it"},
        {0.1, 1.9, "# box = 2\n", 9, 0, 2, {0.5, 1.5}, true, "positions lie in it"},
        {-1e-6, 2, "# box = 2\n", 9, 0, 2, {0.5, 1.5}, true, "positions lie in it"},
        {-1, 1, "# box = 2\n", 9, -1, 1, {-0.5, 0.5}, true, "about the middle of the particles"},
        {-0.9, 1, "# box = 2\n", 9, -1, 1, {-0.5, 0.5}, true, "about the middle of the particles"},
        {-0.7,
         1.1,
         "# box = 2\n",
         9,
         -0.8,
         1.2,
         {-0.3, 0.7},
         true,
         "about the middle of the particles"},
        {0, 4, "# box = 4\n", 9, 0, 4, {1, 3}, true, "positions lie in it"},
        {-1, 1, "", 9, -1, 1, {-0.5, 0.5}, true, "all positions lie in the case's and fill it"},
        {-0.8, 0.8, "", 9, -1, 1, {-0.5, 0.5}, true, "all positions lie in the case's and fill it"},
        {-0.79, 0.8, "", 9, -0.795, 0.795, {-0.3975, 0.3975}, false, "as far as particles reach"},
        {-1.01, 1, "", 9, -1.005, 1.005, {-0.5025, 0.5025}, false, "as far as particles reach"},
        {-1, 1.01, "", 9, -1.005, 1.005, {-0.5025, 0.5025}, false, "as far as particles reach"},
        {0, 2, "", 9, 0, 2, {0.5, 1.5}, false, "as far as particles reach"},
        {0, 2, "", 1.25, 0.25, 2.25, {0.75, 1.75}, false, "as far as particles reach"},
        {-1.5, 2.1, "", 9, -1.8, 1.8, {-0.9, 0.9}, false, "as far as particles reach"},
        {-1.5, 2.3, "", 9, -1.5, 2.3, {-0.55, 1.35}, false, "as far as particles reach"},
    };
    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct judge_request request = uniform_gas();
        struct judged judged;
        plant(1, 0, rows[k].head);
        for (int i = 0; i < N; i++)
            gas.x[0][i] = i == 0   ? rows[k].lo
                          : i == 1 ? rows[k].hi
                                   : rows[k].lo + (rows[k].hi - rows[k].lo) * (i + 0.5) / N;
        if (rows[k].x0 < 9) request.x0 = (struct snapshot_value){true, rows[k].x0};
        judges(&request, &judged);
        const struct prepared *p = &judged.run.problem;
        const double middle = 0.5 * (rows[k].want_lo + rows[k].want_hi);
        near_absolute(p->domain.lo[0] - rows[k].want_lo, 0, 1e-14);
        near_absolute(p->domain.hi[0] - rows[k].want_hi, 0, 1e-14);
        near_absolute(p->window.lo[0] - rows[k].window[0], 0, 1e-14);
        near_absolute(p->window.hi[0] - rows[k].window[1], 0, 1e-14);
        if (!strstr(note(&judged, "box")->evidence, rows[k].box))
            fail_msg("row %zu: %s", k, note(&judged, "box")->evidence);
        near_absolute(atof(note(&judged, "x0")->value) - middle, 0, 1e-8);
        judge_free(&judged);
    }
    struct judge_request request = uniform_gas();
    for (int more = 0; more < 2; more++) /* ends are allowed, what lies beyond is not */
        for (int end = 0; end < 2; end++) {
            plant(1, 0, "# box = 2\n");
            request.x0 = (struct snapshot_value){true, end ? 2 + 1e-9 * more : -1e-9 * more};
            if (more) {
                refuses(&request, "allowed: in its box, 0 to 2");
            } else {
                struct judged judged;
                judges(&request, &judged);
                assert_true(judged.run.problem.domain.lo[0] == (end ? 1 : -1));
                judge_free(&judged);
            }
        }
    request = uniform_gas();
    plant(1, 0, "# box = 1.99\n");
    refuses(&request, "positions reach from 0 to 2");
    plant(2, 0, "# box = 2 0.99\n");
    refuses(&request, "long along y, but positions reach from 0 to 1");
}

/* ---- what is not there, what is asked for in vain ---- */

static void completed(void **state)
{
    (void)state;
    for (int which = 0; which < 4; which++) {
        struct judge_request request = uniform_gas();
        struct judged judged;
        plant(1, 0, "# box = 2\n");
        gas.has_u = which != 1, gas.has_P = which != 0;
        for (int i = 0; i < N; i++) {
            gas.rho[i] = uniform(1, 1.5), gas.u[i] = uniform(2, 3);
            gas.P[i] = 0.4 * gas.rho[i] * gas.u[i];
        }
        if (which == 3) gas.P[7] *= 1 + 1e-3;
        if (which == 2) gas.P[7] *= 1 + 2e-16;
        judges(&request, &judged);
        for (int i = 0; i < N; i++) {
            near_relative(judged.file.column[SNAPSHOT_P][i], gas.P[i], 1e-15);
            near_relative(judged.file.column[SNAPSHOT_U][i], gas.u[i], 1e-15);
        }
        if (which == 1)
            assert_string_equal(note(&judged, "internal energy")->value, "P/((gamma - 1) rho)");
        else
            assert_string_equal(note(&judged, "pressure")->value,
                                which == 3 ? "as stored" : "(gamma - 1) rho u");
        judge_free(&judged);
    }
}

static void in_vain(void **state)
{
    struct judge_request request = uniform_gas();
    (void)state;
    plant(2, 0, "# box = 2 1\n");
    request.case_name = "gresho", request.left = request.right = NULL;
    request.x0 = (struct snapshot_value){true, 0};
    refuses(&request, "belong to two gases that meet");
    request.x0.known = false, request.left = "1 0 1";
    refuses(&request, "belong to two gases that meet");
    request.left = NULL, request.right = "1 0 1";
    refuses(&request, "belong to two gases that meet");
    plant(1, 0, "# box = 2\n");
    request.right = NULL;
    refuses(&request, "particles in 1 dimensions; the case gresho has 2");
    plant(3, 0, "# box = 2 1 1\n");
    refuses(&request, "particles in 3 dimensions; the case gresho has 2");
    request = uniform_gas();
    plant(1, 0, "# box = 2\n");
    for (int i = 2; i < N; i++) gas.x[0][i] = uniform(0, 0.4);
    gas.x[0][1] = 0.4;
    refuses(&request, "no particle lies in the window; --x0");
}

/* ---- far from the solution ---- */

/* Uniform gas has nothing to go by but means: of a fifth of its value, of velocities the sound
 * speed, 0.2 are too much. */
static void uniform_is_far(void **state)
{
    static const struct {
        double rho, v, u;
        enum field field;
        double wrong; /* in units of what is allowed */
    } rows[] = {
        {0.039, 0, 0, FIELD_DENSITY, 0.975},         {0.041, 0, 0, FIELD_DENSITY, 1.025},
        {0, 0.19, 0, FIELD_VELOCITY, 0.95},          {0, 0.21, 0, FIELD_VELOCITY, 1.05},
        {0, 0, 0.039, FIELD_INTERNAL_ENERGY, 0.975}, {0, 0, -0.041, FIELD_INTERNAL_ENERGY, 1.025}};
    (void)state;
    for (int dim = 1; dim <= 3; dim++)
        for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
            const struct judge_request request = uniform_gas();
            struct judged judged;
            plant(dim, 0, boxes[dim]);
            for (int i = 0; i < N; i++) {
                gas.rho[i] *= 1 + rows[k].rho;
                gas.u[i] *= (1 + rows[k].u) / (1 + rows[k].rho);
                if (rows[k].u != 0) gas.rho[i] = 1;
                gas.v[dim - 1][i] = rows[k].v * sqrt(1.4);
            }
            judges(&request, &judged);
            near_relative(judged.wrong / 0.06, rows[k].wrong, 1e-6);
            assert_true(judged.foreign == (rows[k].wrong > 1));
            if (rows[k].rho > 0 || rows[k].v > 0)
                assert_int_equal(judged.wrong_field, rows[k].field);
            assert_true(!judged.foreign == !strstr(judged.verdict, "far from the solution"));
            judge_free(&judged);
        }
}

/* Sod's tube, exact but for one error everywhere: its median is that error. */
static void tube_is_far(void **state)
{
    (void)state;
    for (int field = 0; field < FIELDS; field++)
        for (int far = 0; far < 2; far++) {
            struct judge_request request = {.case_name = "sod", .time = {true, 0.2}, .kernel = -1};
            struct judged judged;
            double range[2] = {INFINITY, -INFINITY};
            plant(1, 0, "# box = 2\n");
            for (int i = 2; i < N; i++) gas.x[0][i] = 2 * (i + 0.5) / N;
            gas.has_P = true;
            judges(&request, &judged);
            const struct prepared problem = judged.run.problem;
            judge_free(&judged);
            for (int twice = 0; twice < 2; twice++) { /* the range is known after the first time */
                const double error = twice ? (range[1] - range[0]) * (far ? 0.062 : 0.058) : 0;
                for (int i = 0; i < N; i++) {
                    struct problem_state s;
                    problem_sample(&problem, (double[3]){gas.x[0][i]}, 0.2, &s);
                    gas.rho[i] = s.rho, gas.v[0][i] = s.v[0], gas.u[i] = s.u, gas.P[i] = s.P;
                    if (fabs(gas.x[0][i] - 1) <= 0.5) {
                        const double value = problem_field(&s, (enum field)field);
                        range[0] = fmin(range[0], value), range[1] = fmax(range[1], value);
                    }
                    double *of[] = {gas.rho, gas.v[0], gas.P, gas.u};
                    of[field][i] += i % 3 ? error : -0.9 * error;
                    if (i % 3 == 0 && i % 2) of[field][i] += 1.9 * error;
                    if (field == FIELD_PRESSURE) gas.P[3] *= 1 + 1e-9; /* as stored */
                }
            }
            judges(&request, &judged);
            near_relative(judged.wrong / 0.06, far ? 0.062 / 0.06 : 0.058 / 0.06, 2e-3);
            assert_true(judged.foreign == far);
            assert_int_equal(judged.wrong_field, field);
            judge_free(&judged);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise),   cmocka_unit_test(sums),           cmocka_unit_test(gammas),
        cmocka_unit_test(times),   cmocka_unit_test(places),         cmocka_unit_test(completed),
        cmocka_unit_test(in_vain), cmocka_unit_test(uniform_is_far), cmocka_unit_test(tube_is_far),
    };
    return cmocka_run_group_tests(tests, make_place, remove_place);
}
