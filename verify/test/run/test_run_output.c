/* SPDX-License-Identifier: GPL-3.0-or-later
 * A run's result as a document and as a table, with made-up figures: every figure is in its place,
 * and null where there is none. */
#include "test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "run.h"

enum { N = 3 };
static double numbers[12][N];

/* As a run of the case leaves it, each figure another one. */
static void make(struct run_settings *settings, struct run_result *result, const char *name)
{
    struct error error;
    struct run run;
    if (run_prepare(settings, name, 0, NULL, &error) || run_resolve(&run, settings, &error))
        fail_msg("%s", error.message);
    *result = (struct run_result){
        .settings = run.settings,
        .scheme = run.scheme,
        .problem = run.problem,
        .n = 17,
        .time = 0.25,
        .azimuthal = {21, 22, 23, 24, 25, 7},
        .radial = {26, 27, 28, 29, 30, 7},
        .binned_density_l1 = 31,
        .regularity = {32, 33, 34, 35, 36},
        .estimate = {37.25, 38, 39},
        .start = {40, 41, 42},
        .spacing = 43,
        .h = 44,
        .mass = 45,
        .momentum = 46,
        .angular_momentum = 47,
        .energy = 48,
        .motion = {66, 67, 68},
        .cost = {49, 50, 51, 52, 53, 54, 55, 56, 65, 66},
        .matrix = {57, 58, 59, 60, 61},
        .peak_rss = 62,
        .plan = {{"density", true, "always"}, {"matrix", false, "none"}, {"one", true, "too many"}},
        .plan_count = 2,
        .warnings = "take care",
        .suspicion = "too good",
        .functionals = {{"a", 63, 64}, {"b", 65, (double)NAN}, {"c", 1, 1}},
        .functional_count = 2};
    for (int f = 0; f < FIELDS; f++) {
        const double first = 1 + 5 * f;
        result->errors[f] = (struct norms){first, first + 1, first + 2, first + 3, first + 4, 7};
    }
    for (int k = 0; k < 12; k++)
        for (int i = 0; i < N; i++) numbers[k][i] = k + 0.125 * i + 1. / 3;
    result->snapshot = (struct snapshot){.n = N,
                                         .x = {numbers[0], numbers[1], numbers[2]},
                                         .v = {numbers[3], numbers[4], numbers[5]},
                                         .m = numbers[6],
                                         .rho = numbers[7],
                                         .u = numbers[8],
                                         .P = numbers[9],
                                         .h = numbers[10],
                                         .volume = numbers[11]};
}

static json_t *norms(double first)
{
    return json_pack("{s:f, s:f, s:f, s:f, s:f}", "l1", first, "l2", first + 1, "linf", first + 2,
                     "particle_mean", first + 3, "l1_whole", first + 4);
}

static json_t *no_norms(void)
{
    return json_pack("{s:n, s:n, s:n, s:n, s:n}", "l1", "l2", "linf", "particle_mean", "l1_whole");
}

/* Takes want; known: what it is called in a message. */
static void is(const json_t *document, const char *name, json_t *want)
{
    const json_t *got = json_object_get(document, name);
    if (!json_equal(got, want)) {
        char *a = json_dumps(got, JSON_ENCODE_ANY), *b = json_dumps(want, JSON_ENCODE_ANY);
        fail_msg("%s: %s, not %s", name, a ? a : "nothing", b);
    }
    json_decref(want);
}

static json_t *errors(const struct run_result *result)
{
    const bool line = result->problem.domain.dim == 1;
    json_t *object = json_object();
    static const char *const fields[] = {"density", "velocity", "pressure", "internal_energy"};
    for (int f = 0; f < FIELDS; f++)
        json_object_set_new(object, fields[f],
                            result->problem.problem->fieldless ? no_norms() : norms(1 + 5 * f));
    json_object_set_new(object, "binned_density_l1", line ? json_real(31) : json_null());
    return object;
}

/* What is the same of all. */
static void common(const json_t *document, const struct run_result *result)
{
    const bool line = result->problem.domain.dim == 1;
    is(document, "n", json_integer(17));
    is(document, "time", json_real(0.25));
    is(document, "start",
       json_pack("{s:f, s:f, s:f}", "density_rms", 40., "gradient_rms", 41., "spread", 42.));
    is(document, "plan",
       json_pack("[{s:s, s:b, s:s}, {s:s, s:b, s:s}]", "pass", "density", "runs", 1, "why",
                 "always", "pass", "matrix", "runs", 0, "why", "none"));
    is(document, "estimate",
       json_pack("{s:f, s:f, s:f}", "memory_bytes", 38., "steps", 38., "cpu_s", 39.));
    is(document, "warnings", json_string("take care"));
    is(document, "suspicion", json_string("too good"));
    is(document, "conservation",
       json_pack("{s:f, s:f, s:o, s:f, s:o, s:o, s:f}", "mass", 45., "momentum", 46.,
                 "angular_momentum", line ? json_null() : json_real(47), "energy", 48.,
                 "ke_rebound", result->problem.problem->steady ? json_real(66) : json_null(),
                 "ke_asymmetry", result->problem.problem->steady ? json_real(67) : json_null(),
                 "centre", 68 / 43.));
    is(document, "regularity",
       json_pack("{s:f, s:f, s:f, s:f, s:f}", "nearest", 32., "spread", 33., "paired", 34.,
                 "density", 35., "gradient", 36.));
    is(document, "cost",
       json_pack("{s:f, s:f, s:i, s:i, s:i, s:i, s:i, s:i, s:i}", "wall_s", 49., "cpu_s", 50.,
                 "steps", 51, "particle_updates", 52, "pair_interactions", 53,
                 "skipped_particle_updates", 54, "without_slope", 65, "without_viscosity", 66,
                 "peak_rss_bytes", 62));
    is(document, "matrix",
       json_pack("{s:{s:f, s:f}, s:{s:f, s:f}, s:i, s:i}", "condition", "max", 57., "mean", 58.,
                 "angle", "max", 59., "mean", 60., "fallen_back", 61, "fallen_back_most", 56));
    is(document, "functionals",
       json_pack("[{s:s, s:f, s:f}, {s:s, s:f, s:s}]", "name", "a", "value", 63., "reference", 64.,
                 "name", "b", "value", 65., "reference", "nan"));
    is(document, "spacing", json_real(43));
    is(document, "h", json_real(44));
    assert_int_equal(json_object_size(json_object_get(document, "settings")) > 20, true);
}

TEST(documents)
{
    static const struct {
        const char *name, *title, *window, *measured;
    } rows[] = {
        {"sod", "Sod's shock tube", "[-0.5, 0.5]", NULL},
        {"gresho", "Gresho & Chan's vortex", "{\"lo\": [0.0, 0.0], \"hi\": [1.0, 1.0]}",
         "[\"azimuthal\", \"radial\", \"velocity\", \"pressure\"]"},
        {"kelvin_helmholtz_mode", "Growing mode of Kelvin & Helmholtz", NULL, "[\"a\"]"},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct run_settings settings;
        struct run_result result;
        make(&settings, &result, rows[k].name);
        json_t *document = json_object(), *want = errors(&result);
        run_add_json(&settings, &result, document);
        common(document, &result);
        if (k == 1) {
            json_object_set_new(want, "azimuthal", norms(21));
            json_object_set_new(want, "radial", norms(26));
        }
        is(document, "errors", want);
        is(document, "case", json_string(rows[k].name));
        is(document, "status", json_string("ok"));
        assert_null(json_object_get(document, "message"));
        is(document, "budget", json_null());
        if (rows[k].title) is(document, "title", json_string(rows[k].title));
        if (rows[k].window) is(document, "window", json_loads(rows[k].window, 0, NULL));
        if (rows[k].measured) is(document, "measured", json_loads(rows[k].measured, 0, NULL));
        json_decref(document);
    }
}

/* A run from a glass says how it started, a run that broke down says how, and a run without a
 * matrix has no figures of it. */
TEST(what_may_be_absent)
{
    struct run_settings settings;
    struct run_result result;
    make(&settings, &result, "gresho");
    result.start.density = (double)NAN;
    result.status = STATUS_BROKE_DOWN;
    snprintf(result.message, sizeof result.message, "particle 3");
    result.matrix.condition_max = (double)NAN;
    result.matrix.fallen_back = 0;
    result.energy = HUGE_VAL;
    json_t *document = json_object();
    run_add_json(&settings, &result, document);
    assert_null(json_object_get(document, "start"));
    is(document, "status", json_string("broke_down"));
    is(document, "message", json_string("particle 3"));
    is(document, "matrix", json_null());
    is(json_object_get(document, "conservation"), "energy", json_string("inf"));
    json_decref(document);
    document = json_object(); /* before a run */
    run_add_plan(&settings, &result, document);
    assert_int_equal(json_object_size(document), 8);
    json_decref(document);
}

TEST(tables)
{
    static const char *const cases[] = {"sod", "gresho", "rest_3d"};
    static const char *const heads[] = {"x,vx,m,rho,u,P,h\n", "x,y,vx,vy,m,rho,u,P,h\n",
                                        "x,y,z,vx,vy,vz,m,rho,u,P,h\n"};
    /* then what it is of: of the last one, the case, the keys and the directions of the box vary */
    static const char *const said[] = {
        "# case = sod\n# time = 0.25\n# gamma = 1.3999999999999999\n# box = -1:1\n"
        "# boundary = periodic\n# keys = window=-0.5 0.5\n",
        "# case = gresho\n# time = 0.25\n# gamma = 1.6666666666666667\n# box = 0:1 0:1\n"
        "# boundary = periodic reflecting\n"
        "# keys = window=0 1; window_radius=0.375; boost=0.5 0\n",
        "# time = 0.25\n# gamma = 1.6666666666666667\n# box = 0:1 0:1 0:1\n"
        "# boundary = periodic periodic periodic\n# keys = window=0 1\n"};
    char folder[] = "run_output.XXXXXX", path[64], text[4096], want[4096];
    struct error error = {0};
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/end.csv", folder);
    for (size_t dim = 1; dim <= 3; dim++) {
        struct run_settings settings;
        struct run run;
        struct run_result result;
        make(&settings, &result, cases[dim - 1]);
        if (dim < 3) strcpy(result.case_name, cases[dim - 1]); /* else nobody said */
        if (dim == 2) {
            char *const words[] = {"window_radius=0.375", "boost=0.5 0", "lattice=hexagonal",
                                   "boundary=periodic reflecting", "alpha=0.5"};
            assert_int_equal(settings_apply(&settings.settings, 5, words, &error), STATUS_OK);
            assert_int_equal(run_resolve(&run, &settings, &error), STATUS_OK);
            result.settings = run.settings, result.problem = run.problem;
        }
        assert_int_equal(run_write_snapshot(&result, path, &error), STATUS_OK);
        FILE *file = fopen(path, "r");
        assert_non_null(file);
        text[fread(text, 1, sizeof text - 1, file)] = '\0';
        fclose(file);
        size_t used = (size_t)snprintf(want, sizeof want, "%s", heads[dim - 1]);
        used += (size_t)snprintf(want + used, sizeof want - used, "%s", said[dim - 1]);
        for (int i = 0; i < N; i++)
            for (size_t k = 0; k <= 10; k++) {
                if ((k < 3 && k >= dim) || (k >= 3 && k < 6 && k - 3 >= dim)) continue;
                used += (size_t)snprintf(want + used, sizeof want - used, "%.17g%s", numbers[k][i],
                                         k < 10 ? "," : "\n");
            }
        assert_string_equal(text, want);
        unlink(path);
        snprintf(want, sizeof want, "%s/no/such.csv", folder);
        assert_int_equal(run_write_snapshot(&result, want, &error), STATUS_ENVIRONMENT);
    }
    rmdir(folder);
}

/* One of each kind of norm. */
TEST(single_errors)
{
    struct run_settings settings;
    struct run_result result;
    make(&settings, &result, "sod");
    for (int f = 0; f < FIELDS; f++)
        for (int m = 0; m < NORMS; m++)
            assert_true(run_error(&result, (enum field)f, (enum norm)m) == 1 + 5 * f + m);
}
