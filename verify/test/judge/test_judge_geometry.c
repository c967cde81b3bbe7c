/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests how `judge` finds gamma, the time and the position of the case in a snapshot's box, how it
 * completes missing columns, and which options it refuses because they would have no effect. */
#include "test.h"

#include "sample_snapshot.h"

/* ---- gamma, time ---- */

TEST(sources_of_gamma)
{
    static const struct {
        double said, in_file, planted, scatter, want; /* 0: missing */
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
        {0, 1.40099, 0, 0, 1.40099, "the file says so"},
        {0, 1.40101, 0, 0, 1.40101, "the file says so"},
        {0, 1.5, 1.50009, 0, 1.5, "the file says so"},
        {0, 1.5, 1.49989, 0, 1.5, "the file says so; but the file's own P/(rho u)"},
        {0, 0, 1.25, 0, 1.25, "the file has none, but P = (gamma - 1) rho u of its particles"},
        {0, 0, 1.25, 9e-6, 1.25, "the file has none, but P = (gamma - 1) rho u"},
        {0, 0, 1.23456, 0, 1.23456, "the file has none, but P = (gamma - 1) rho u"},
        {0, 0, 1.25, 3e-5, 1.4, "the file has none: the case's"},
        {0, 0, 1.25, -3e-5, 1.4, "the file has none: the case's"},
        {0, 0, 1, 0, 1.4, "the file has none: the case's"}, /* pressures that are all but 0 */
        {0, 0, 0, 0, 1.4, "the file has none: the case's"}};
    for (size_t k = 0; k < 2 * (sizeof rows / sizeof *rows); k++) {
        const bool named = k % 2; /* by the user; else by the file */
        struct judge_request request = uniform_gas();
        plant(1, 0, named ? "" : "# case = sod\n");
        if (!named) request.case_name = NULL;
        gas.has_P = rows[k / 2].planted > 0;
        if (rows[k / 2].in_file > 0)
            sprintf(gas.head + strlen(gas.head), "# gamma = %.17g\n", rows[k / 2].in_file);
        for (int i = 0; i < N; i++) {
            gas.rho[i] = draw(1, 1.5), gas.u[i] = i == 5 ? 0 : draw(2, 3);
            gas.P[i] = fmax(1e-20, (rows[k / 2].planted - 1) * gas.rho[i] * gas.u[i]);
        }
        gas.P[5] = 1;                                      /* nor does an energy of 0 */
        gas.P[11] = 0;                                     /* a pressure of 0 determines no gamma */
        gas.P[9] *= 1 + rows[k / 2].scatter * 1.25 / 0.25; /* scatter of gamma itself */
        request.gamma = (struct snapshot_value){rows[k / 2].said > 0, rows[k / 2].said};
        struct judged judged = judges(&request);
        near_relative(judged.run.problem.gamma, rows[k / 2].want, 1e-14);
        const char *evidence = note(&judged, "gamma")->evidence;
        if (strncmp(evidence, rows[k / 2].evidence, strlen(rows[k / 2].evidence)) != 0 ||
            (!strstr(rows[k / 2].evidence, ";") && strstr(evidence, ";")))
            fail_msg("row %zu: %s", k / 2, evidence);
        const double want = rows[k / 2].want;
        const bool another = named && !(rows[k / 2].said > 0) && fabs(want - 1.4) > 1e-3;
        assert_true(judged.case_gamma == (another ? 1.4 : 0));
        judge_free(&judged);
    }
}

TEST(gamma_out_of_range)
{
    struct judge_request request = uniform_gas();
    request.gamma.known = false;
    plant(1, 0, "# gamma = 0.5\n");
    refuses(&request, "a.csv: gamma=0.5: allowed: ");
}

TEST(sources_of_time)
{
    struct judge_request request = uniform_gas();
    plant(1, 0, "# time = 0.125\n");
    struct judged judged = judges(&request);
    assert_true(judged.result.time == 0.1 && judged.file.time.value == 0.1);
    assert_string_equal(note(&judged, "time")->evidence, "--time");
    judge_free(&judged);
    request.time.known = false;
    judged = judges(&request);
    assert_true(judged.result.time == 0.125 && judged.run.problem.problem);
    assert_string_equal(note(&judged, "time")->evidence, "the file says so");
    judge_free(&judged);
    gas.head[0] = '\0';
    refuses(&request, "says no time; a line '# time = T' of a text file helps");
    request.time = (struct snapshot_value){true, -1e-9};
    refuses(&request, "allowed: 0 or above");
    request.time.value = 0;
    judged = judges(&request);
    assert_true(judged.result.time == 0);
    judge_free(&judged);
    snprintf(gas.head, sizeof gas.head, "# time = -1\n");
    request.time.known = false;
    refuses(&request, "time = -1; allowed: 0 or above");
}

/* ---- position ---- */

TEST(positions_of_tubes)
{
    static const struct {
        double lo, hi; /* of the particles */
        const char *head;
        double x0; /* x0 of the user; 9: none */
        double want_lo, want_hi, window[2];
        bool periodic;
        const char *box;
    } rows[] = {
        {0, 2, "# box = 2\n", 9, 0, 2, {0.5, 1.5}, true, "positions lie in it"},
        {0, 2, "# box = 2\n", 0.75, -0.25, 1.75, {0.25, 1.25}, true, "positions lie in it"},
        {0.1, 1.9, "# box = 2\n", 9, 0, 2, {0.5, 1.5}, true, "positions lie in it"},
        {-1.5e-6, 2, "# box = 2\n", 9, 0, 2, {0.5, 1.5}, true, "positions lie in it"},
        {-2.5e-6,
         1.8,
         "# box = 2\n",
         9,
         -0.10000125,
         1.89999875,
         {0.39999875, 1.39999875},
         true,
         "about the middle of the particles"},
        {0.2, 2 + 1.5e-6, "# box = 2\n", 9, 0, 2, {0.5, 1.5}, true, "positions lie in it"},
        {0.2,
         2 + 2.5e-6,
         "# box = 2\n",
         9,
         0.10000125,
         2.10000125,
         {0.60000125, 1.60000125},
         true,
         "about the middle of the particles"},
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
        {-0.78,
         1.02,
         "# box = 2\n",
         9,
         -0.88,
         1.12,
         {-0.38, 0.62},
         true,
         "about the middle of the"},
        {0, 4, "# box = 4\n", 9, 0, 4, {1, 3}, true, "positions lie in it"},
        {0.5,
         2.4,
         "# box = 2\n",
         9,
         0.45,
         2.45,
         {0.95, 1.95},
         true,
         "about the middle of the particles"},
        {-1, 1, "", 9, -1, 1, {-0.5, 0.5}, true, "all positions lie in the case's and fill it"},
        {-0.8, 0.8, "", 9, -1, 1, {-0.5, 0.5}, true, "all positions lie in the case's and fill it"},
        {-0.79, 0.8, "", 9, -0.795, 0.795, {-0.3975, 0.3975}, false, "as far as particles reach"},
        {-1.01, 1, "", 9, -1.005, 1.005, {-0.5025, 0.5025}, false, "as far as particles reach"},
        {-1, 1.01, "", 9, -1.005, 1.005, {-0.5025, 0.5025}, false, "as far as particles reach"},
        {0, 2, "", 9, 0, 2, {0.5, 1.5}, false, "as far as particles reach"},
        {0, 2, "", 1.25, 0.25, 2.25, {0.75, 1.75}, false, "as far as particles reach"},
        {-1.5, 2.1, "", 9, -1.8, 1.8, {-0.9, 0.9}, false, "as far as particles reach"},
        {-1.5, 2.3, "", 9, -1.5, 2.3, {-0.55, 1.35}, false, "as far as particles reach"},
        {-0.9, 1, "# box = -0.95:1.05\n", 9, -0.95, 1.05, {-0.45, 0.55}, true, "the file says so"},
        {-1.1, 0.8, "# box = -1.1:0.9\n", 9, -1.1, 0.9, {-0.6, 0.4}, true, "the file says so"},
        /* the upper end, less the length, is a digit below the lower end */
        {-0.88, 0.72, "# box = -0.88:0.72\n", 9, -0.88, 0.72, {-0.48, 0.32}, true, "file says so"},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct judge_request request = uniform_gas();
        plant(1, 0, rows[k].head);
        for (int i = 0; i < N; i++) gas.m[i] /= 8; /* the volumes do not fill the line */
        for (int i = 0; i < N; i++)
            gas.x[0][i] = i == 0   ? rows[k].lo
                          : i == 1 ? rows[k].hi
                                   : rows[k].lo + (rows[k].hi - rows[k].lo) * (i + 0.5) / N;
        if (rows[k].x0 < 9) request.x0 = (struct snapshot_value){true, rows[k].x0};
        struct judged judged = judges(&request);
        const struct prepared *p = &judged.run.problem;
        const double middle = 0.5 * (rows[k].want_lo + rows[k].want_hi);
        for (int i = 0; i < N && rows[k].periodic; i++)
            assert_true(judged.result.snapshot.x[0][i] >= p->domain.lo[0]);
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
    for (int more = 0; more < 2; more++) /* x0 may be at an end of the box, and not beyond it */
        for (int end = 0; end < 2; end++) {
            plant(1, 0, "# box = 2\n");
            request.x0 = (struct snapshot_value){true, end ? 2 + 1e-9 * more : -1e-9 * more};
            if (more) {
                refuses(&request, "allowed: in its box, 0 to 2");
            } else {
                struct judged judged = judges(&request);
                assert_true(judged.run.problem.domain.lo[0] == (end ? 1 : -1));
                judge_free(&judged);
            }
        }
    request = uniform_gas();
    plant(1, 0, "# box = 1.999997\n");
    refuses(&request, "positions reach from 0 to 2");
    plant(2, 0, "# box = 2 0.99\n");
    refuses(&request, "long along y, but positions reach from 0 to 1");
}

/* If the volumes of a line of gas add up to the length of the case's box within 1 %, the box begins
 * at 0, or is centred on 0 or on the gas: the first of these that contains it. */
TEST(lines_as_long_as_the_box)
{
    static const struct {
        const char *name;
        double lo, length, corner; /* the corner of the box; 9: it ends where the volumes do */
    } rows[] = {{"sod", 0, 2, 0},
                {"sod", 0, 1.982, 0},
                {"sod", 0.018, 1.982, 0},
                {"sod", 0, 1.978, 9},
                /* the first particle lies at 0, and the last at 2 */
                {"sod", -17. / 4096, 17 * N / 2048., 0},
                {"sod", 2 - 17 * (N - 0.5) / 2048, 17 * N / 2048., 0},
                {"sod", 0.01, 2, 0.01},
                {"sod", -0.01, 2, -0.01},
                {"sod", 0, 2.018, 0.009},
                {"sod", 0, 2.022, 9},
                {"sod", 5, 2, 5},
                {"sod", -5, 2, -5},
                {"sod", -1.5, 2, -1.5},
                {"sound_wave", -0.5, 1, -0.5},
                {"sound_wave", 0.3, 1, 0.3},
                {"sound_wave", -0.3, 1, -0.3}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct judge_request request = {.case_name = rows[k].name, .time = {true, 0}, .kernel = -1};
        const double volume = rows[k].length / N, corner = rows[k].corner,
                     box = strcmp(rows[k].name, "sod") ? 1 : 2;
        plant(1, 0, "");
        for (int i = 0; i < N; i++) gas.x[0][i] = rows[k].lo + (i + 0.5) * volume;
        for (int i = 0; i < N; i++) gas.m[i] = volume;
        struct judged judged = judges(&request);
        const struct domain *domain = &judged.run.problem.domain;
        near_absolute(domain->lo[0] - (corner < 9 ? corner : rows[k].lo), 0, 1e-12);
        near_absolute(domain->hi[0] - domain->lo[0] - (corner < 9 ? box : rows[k].length), 0,
                      1e-12);
        assert_true(judged.file.boxed == (corner < 9));
        assert_true(judged.file.box[0] == (corner < 9 ? box : 0));
        assert_true(!strstr(note(&judged, "box")->evidence, "as long as the case's") ==
                    !(corner < 9));
        judge_free(&judged);
    }
}

/* If all other particles lie outside the extent of the gas, they are walls, and the gas does not
 * fill its box. If one of them lies within the extent, its ends included, they are not walls. */
TEST(walls)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int axis = 0; axis < dim; axis++)
            for (int k = 0; k < 6; k++) {
                static const double at[] = {-0.2, 0, 0.5, 0.5, 1, 1.2}; /* over the extent */
                const struct judge_request request = uniform_gas();
                plant(dim, 0, "# box = -1:3 -1:2 -1:2\n");
                gas.others = 2;
                for (int i = N - 2; i < N; i++)
                    for (int d = 0; d < dim; d++)
                        gas.x[d][i] = (d == axis ? at[k] : 0.5) * (d ? 1 : 2);
                if (k == 3) gas.x[axis][N - 2] = -0.5; /* one lies outside, the other within */
                struct judged judged = judges(&request);
                assert_true(judged.boxed == (k > 0 && k < 5));
                judge_free(&judged);
            }
}

/* The box of a liquid between plates is that of the file or of the user if its corner is known,
 * else the case's; particles may lie outside. */
TEST(boxes_of_liquids)
{
    static const struct {
        const char *head, *asked;
        double lo[2], hi[2];
        const char *value, *evidence;
    } rows[] = {
        {"", NULL, {0, 0}, {1, 1}, "0 to 1 along y", "the case's: the file does not say where its"},
        {"# box = 2 3\n",
         NULL,
         {0, 0},
         {1, 1},
         "0 to 1 along y",
         "the case's: the file does not say"},
        {"# box = 0:2 -1:2\n", NULL, {0, -1}, {2, 2}, "-1 to 2 along y", "the file says so"},
        {"# box = 0:2 -1:2\n",
         "0.25:1 0.5:1.25",
         {0.25, 0.5},
         {1, 1.25},
         "0.5 to 1.25 along y",
         "--box"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct judge_request request = {
            .case_name = "poiseuille", .time = {true, 0}, .kernel = -1, .box = rows[k].asked};
        plant(2, 0, rows[k].head);
        gas.has_u = k % 2, gas.has_P = !gas.has_u;
        struct judged judged = judges(&request);
        for (int d = 0; d < 2; d++) {
            near_absolute(judged.run.problem.domain.lo[d], rows[k].lo[d], 1e-14);
            near_absolute(judged.run.problem.domain.hi[d], rows[k].hi[d], 1e-14);
            near_absolute(judged.file.box[d], rows[k].hi[d] - rows[k].lo[d], 1e-14);
        }
        assert_true(judged.boxed && judged.start.mass == 0);
        assert_true(judged.file.box[2] == 0); /* a flow in a plane */
        for (int i = 0; i < N; i++)
            if (gas.has_u)
                assert_true(isnan(judged.file.column[SNAPSHOT_P][i]));
            else
                assert_true(judged.file.column[SNAPSHOT_U][i] == 0);
        assert_string_equal(note(&judged, "box")->value, rows[k].value);
        if (!strstr(note(&judged, "box")->evidence, rows[k].evidence))
            fail_msg("row %zu: %s", k, note(&judged, "box")->evidence);
        judge_free(&judged);
    }
}

/* Layers of a flow in 2D are as thick as the box says, or else their volumes over their area. */
TEST(slabs)
{
    static const struct {
        const char *box;
        double thick, speed, along; /* thick: 0: as the volumes say */
    } rows[] = {{NULL, 0, 2, 0.5},
                {"2 1", 0, 0, 0},
                {"-0.5:1.5 0:1 0:1.25", 1.25, 0.5, 1},
                {"-0.5:1.5 0:1 0:1e-20", 1e-20, 0, 0},
                {NULL, 0, 1e-9, 5e-10}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct judge_request request = {
            .case_name = "shear", .time = {true, 0}, .kernel = -1, .box = rows[k].box};
        char text[80];
        double volume = 0;
        plant(3, 0, "");
        for (int i = 0; i < N; i++) {
            gas.x[0][i] -= 0.5;
            gas.rho[i] = draw(1, 2);
            volume += gas.m[i] / gas.rho[i];
            gas.v[0][i] = rows[k].speed * (i == 7 ? -0.6 : 0.3);
            gas.v[1][i] = rows[k].speed * (i == 7 ? 0.8 : 0.4);
            gas.v[2][i] = i == 9 ? -rows[k].along : 0;
        }
        struct judged judged = judges(&request);
        const double thick = rows[k].thick > 0 ? rows[k].thick : volume / 2;
        const double fastest = fmax(rows[k].speed, hypot(0.5 * rows[k].speed, rows[k].along));
        const double spacing = cbrt(2 * thick / N), in_plane = N * spacing / thick;
        assert_int_equal(judged.file.dim, 2);
        near_relative(judged.slab, thick, 1e-13);
        near_relative(judged.result.spacing, spacing, 1e-12);
        near_relative(judged.case_n, in_plane / 2, 1e-12); /* the case's box is half as large */
        assert_true(settings_real(&judged.run.settings, SETTING_n) == fmin(1e7, round(in_plane)));
        snprintf(text, sizeof text, "a slab in 3D, %.6g thick", thick);
        assert_string_equal(note(&judged, "plane")->value, text);
        snprintf(text, sizeof text, "velocities along z are at most %.2g of the greatest",
                 rows[k].along > 0 ? rows[k].along / fastest : 0);
        if (!strstr(note(&judged, "plane")->evidence, text))
            fail_msg("%s: %s", text, note(&judged, "plane")->evidence);
        for (size_t i = 0; i < N; i++) {
            near_relative(judged.result.snapshot.m[i], gas.m[i] / thick, 1e-13);
            near_relative(judged.result.snapshot.h[i], 2 * cbrt(gas.m[i] / gas.rho[i]), 1e-13);
        }
        judge_free(&judged);
    }
}

/* ---- missing values, and options without effect ---- */

/* If volumes fill a line, it extends half a volume beyond its outermost particles, also where these
 * are not the first and the last in the file; otherwise it ends at its particles. */
TEST(ends_of_volumes)
{
    for (int turn = 0; turn < 40; turn++) {
        const bool walls = turn % 8 == 7, fills = turn % 4 && !walls;
        const double lo = draw(1.5, 3);
        struct judge_request request = uniform_gas();
        double at = lo, first = 0, last = 0;
        plant(1, 0, "");
        for (int k = 0; k < N; k++) {
            const int i = (k + 7 * turn) % N;
            const double volume = draw(0.2, 3) / N;
            gas.rho[i] = draw(0.5, 2), gas.m[i] = volume * gas.rho[i] * (fills || walls ? 1 : 0.8);
            gas.x[0][i] = at + 0.5 * volume, at += volume;
            if (k == 0) first = gas.x[0][i];
            last = gas.x[0][i];
        }
        gas.others = walls ? 2 : 0; /* then volumes do not count */
        struct judged judged = judges(&request);
        const struct prepared *p = &judged.run.problem;
        near_absolute(p->domain.lo[0] - (fills ? lo : first), 0, 1e-13);
        near_absolute(p->domain.hi[0] - (fills ? at : last), 0, 1e-13);
        assert_non_null(
            strstr(note(&judged, "box")->evidence, fills ? "volumes of particles" : "as far as p"));
        judge_free(&judged);
    }
    const struct judge_request request = uniform_gas();
    plant(2, 0.3, "");
    for (int i = 0; i < N; i++) gas.m[i] = 2. / N; /* areas, which add up to the extent along x */
    struct judged judged = judges(&request);
    assert_non_null(strstr(note(&judged, "box")->evidence, "as far as particles reach"));
    judge_free(&judged);
}

TEST(completed)
{
    for (int which = 0; which < 4; which++) {
        struct judge_request request = uniform_gas();
        plant(1, 0, "# box = 2\n");
        gas.has_u = which != 1, gas.has_P = which != 0;
        for (int i = 0; i < N; i++) {
            gas.rho[i] = draw(1, 1.5), gas.u[i] = draw(2, 3);
            gas.P[i] = 0.4 * gas.rho[i] * gas.u[i];
        }
        if (which == 3) gas.P[7] *= 1 + 1e-3;
        for (int i = 0; i < N && which == 2; i++) gas.P[i] *= 1 + 2.3e-16 * (i % 3 - 1);
        struct judged judged = judges(&request);
        for (int i = 0; i < N; i++) {
            near_relative(judged.file.column[SNAPSHOT_P][i], gas.P[i], 1e-15);
            near_relative(judged.file.column[SNAPSHOT_U][i], gas.u[i], 1e-15);
            if (which == 2) /* recomputed */
                assert_true(judged.file.column[SNAPSHOT_P][i] == (1.4 - 1) * gas.rho[i] * gas.u[i]);
        }
        if (which == 1)
            assert_string_equal(note(&judged, "internal energy")->value, "P/((gamma - 1) rho)");
        else
            assert_string_equal(note(&judged, "pressure")->value,
                                which == 3 ? "as stored" : "(gamma - 1) rho u");
        judge_free(&judged);
    }
}

/* Fields written with seven digits are meant to 5e-7, and a pressure may be off by eight times
 * that, however precise the positions are. */
TEST(digits_as_written)
{
    for (int k = 0; k < 4; k++) {
        const bool above = k % 2;
        struct judge_request request = uniform_gas();
        request.left = request.right = "0.7 0 1.1", request.time.value = 0;
        plant(1, 0, "# box = 2\n");
        gas.has_P = true, gas.digits = 7;
        for (int i = 0; i < N; i++) {
            gas.m[i] = 1.4 / N, gas.rho[i] = 0.7, gas.u[i] = 1.1 / (0.4 * gas.rho[i]);
            gas.P[i] = 1.1;
        }
        gas.P[k < 2 ? 0 : N - 1] *= 1 - (above ? 4.3e-6 : 3.7e-6);
        struct judged judged = judges(&request);
        assert_string_equal(note(&judged, "pressure")->value,
                            above ? "as stored" : "(gamma - 1) rho u");
        assert_string_equal(note(&judged, "precision")->value, "7 digits");
        assert_string_equal(note(&judged, "precision")->evidence,
                            "as written; nothing below 5e-07 of a value is meant");
        assert_null(strstr(note(&judged, "start")->evidence, "single precision"));
        judge_free(&judged);
    }
}

TEST(options_without_effect)
{
    struct judge_request request = uniform_gas();
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
    request = uniform_gas();
    plant(1, 0, "# box = 2\n");
    for (int i = 2; i < N; i++) gas.x[0][i] = draw(0, 0.4);
    gas.x[0][1] = 0.4;
    refuses(&request, "no particle lies in the window, 0.5 1.5; ");
    request = (struct judge_request){
        .case_name = "gresho", .time = {true, 0}, .kernel = -1, .radius = 1e-7};
    plant(2, 0, "");
    for (int i = 0; i < N; i++) gas.x[0][i] = gas.x[0][i] / 2 - 0.5, gas.x[1][i] -= 0.5;
    refuses(&request, "no particle lies in the window, 1e-07 about the middle; ");
}
