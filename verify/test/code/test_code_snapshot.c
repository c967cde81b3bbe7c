/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests which file of another code's run is its result, and what shows that a snapshot does not
 * come from the initial state. */
#include "test.h"

#include "code_snapshot.h"
#include "own_folder.h"
#include "prepared.h"

/* ---- which file ---- */

TEST(matches_in_order)
{
    static const char *const names[] = {"s_10", "s_9", "s_2", "t_1", "s_100"};
    static const char *const order[] = {"s_2", "s_9", "s_10", "s_100"};
    struct code_matches found;
    for (size_t k = 0; k < 5; k++)
        assert_int_equal(output_text(path_of(names[k]), names[k], NULL), STATUS_OK);
    assert_true(code_match(path_of("s_*"), &found));
    assert_int_equal(found.n, 4);
    for (size_t k = 0; k < 4; k++) {
        assert_string_equal(found.path[k], path_of(order[k]));
        assert_int_equal(found.was[k].st_size, strlen(order[k]));
    }
    code_matches_free(&found);
    assert_true(code_match(path_of("u_*"), &found));
    assert_true(found.n == 0 && !found.path && !found.was);
    code_matches_free(&found);
}

/* A file is of the run unless it is older by more than 2 s, or was there and has not changed. */
TEST(files_of_the_run)
{
    enum { BEGAN = 1000, N = 4 };
    static char names[N][2] = {"a", "b", "c", "d"};
    char *path[N] = {names[0], names[1], names[2], names[3]};
    struct stat was[N] = {{0}}, old[2] = {{0}};
    const struct code_matches now = {N, path, was}, before = {2, path, old}, none = {0};
    enum code_reason reason;
    for (size_t k = 0; k < N; k++) was[k].st_mtime = BEGAN, was[k].st_ino = 10 + k;
    assert_string_equal(code_last(&now, &none, BEGAN, &reason), "d");
    assert_int_equal(reason, REASON_NONE);
    assert_string_equal(code_first(&now, &none, BEGAN, "d"), "a");
    assert_null(code_first(&now, &none, BEGAN, "a"));
    was[0].st_mtime = BEGAN - 3, was[1].st_mtime = BEGAN - 2, was[3].st_mtime = BEGAN - 3;
    assert_string_equal(code_last(&now, &none, BEGAN, &reason), "c");
    assert_string_equal(code_first(&now, &none, BEGAN, "c"), "b");
    assert_null(code_first(&now, &none, BEGAN, "b"));
    assert_true(!code_is_new(&now, 0, &none, BEGAN) && code_is_new(&now, 1, &none, BEGAN));
    was[1].st_mtime = was[2].st_mtime = BEGAN - 3;
    assert_null(code_last(&now, &none, BEGAN, &reason));
    assert_int_equal(reason, REASON_old_snapshot);
    assert_null(code_last(&none, &none, BEGAN, &reason));
    assert_int_equal(reason, REASON_no_snapshot);
    for (int change = 0; change <= 5; change++)
        for (size_t which = 0; which < 2; which++) {
            const struct stat same = {
                .st_ino = 3, .st_dev = 4, .st_size = 5, .st_mtim = {.tv_sec = BEGAN, .tv_nsec = 6}};
            was[2] = old[which] = same;
            old[1 - which] = (struct stat){0};
            if (change == 1) was[2].st_ino++;
            if (change == 2) was[2].st_dev++;
            if (change == 3) was[2].st_size++;
            if (change == 4) was[2].st_mtim.tv_sec++;
            if (change == 5) was[2].st_mtim.tv_nsec++;
            assert_int_equal(code_is_new(&now, 2, &before, BEGAN), change > 0);
        }
}

/* ---- contents ---- */

enum { N = 5 };

static const char moving[] = "kind=sound_wave|background=1 0.5 1|amplitude=1e-9|lo=-1|hi=3";
static const char drifting[] = "kind=rest|lo=-1 -2|hi=3 6|boost=0 0.25|background=1 0 1";

/* An initial state of gas and what it is compared with. */
static struct {
    struct settings settings;
    struct prepared problem;
    struct snapshot_file ic, file;
    double column[2][SNAPSHOT_COLUMNS][N];
    struct code_origin origin;
    char message[200];
} made;

static void make(int dim, const char *keys)
{
    made.problem = prepared_of(&made.settings, dim, keys);
    made.origin = (struct code_origin){.ic = &made.ic, .problem = &made.problem, .t_end = 1};
    struct snapshot_file *const files[] = {&made.ic, &made.file};
    for (int f = 0; f < 2; f++) {
        *files[f] = (struct snapshot_file){.n = N + 1, .gas = N, .dim = dim};
        files[f]->time = (struct snapshot_value){true, f};
        for (int c = 0; c < SNAPSHOT_COLUMNS; c++) {
            const bool there = c < dim || (c >= SNAPSHOT_VX && c < SNAPSHOT_VX + dim) ||
                               c == SNAPSHOT_M || c == SNAPSHOT_U;
            files[f]->column[c] = there ? made.column[f][c] : NULL;
            for (size_t i = 0; i < N; i++)
                made.column[f][c][i] =
                    c < SNAPSHOT_VX
                        ? made.problem.domain.lo[c] + ((double)i + 0.5) / N * (double)(1 << c) * 4
                        : 1;
        }
    }
    made.message[0] = '\0';
}

static enum code_reason compared(void)
{
    return code_compare(&made.file, &made.origin, made.message, sizeof made.message);
}

TEST(wrong_times_and_gammas)
{
    static const struct {
        double time, gamma;
        enum code_reason reason;
    } rows[] = {{2, 1.4, REASON_NONE},
                {2.0019, 1.4, REASON_NONE},
                {1.9981, 1.4, REASON_NONE},
                {2.0021, 1.4, REASON_wrong_time},
                {1.9979, 1.4, REASON_wrong_time},
                {(double)NAN, 1.4, REASON_wrong_time},
                {2, 1.40009, REASON_NONE},
                {2, 1.39991, REASON_NONE},
                {2, 1.40011, REASON_wrong_gamma},
                {2, 1.39989, REASON_wrong_gamma}};
    for (int known = 0; known < 4; known++)
        for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
            make(1, moving);
            made.problem.gamma = 1.4;
            made.origin.ic = NULL;
            made.origin.t_end = 2;
            made.file.time = (struct snapshot_value){known & 1, rows[k].time};
            made.file.gamma = (struct snapshot_value){known & 2, rows[k].gamma};
            const bool seen = rows[k].reason == REASON_wrong_time ? known & 1 : known & 2;
            assert_int_equal(compared(), seen ? rows[k].reason : REASON_NONE);
        }
    assert_string_equal(made.message, "its gamma is 1.39989; the case has 1.4");
}

static void move_all(int d, double by)
{
    for (size_t i = 0; i < N; i++) made.file.column[d][i] += by;
}

TEST(other_particles)
{
    make(1, moving);
    move_all(0, 0.5);
    assert_int_equal(compared(), REASON_NONE);
    made.file.gas = N - 1;
    assert_int_equal(compared(), REASON_wrong_particles);
    assert_string_equal(made.message, "4 particles of gas; the initial state has 5");
    make(2, drifting);
    made.file.dim = 1;
    assert_int_equal(compared(), REASON_wrong_particles);
    assert_string_equal(made.message, "particles in 1D; the case is in 2D");
    static const struct {
        double factor[N]; /* of masses */
        bool cells;
        enum code_reason reason;
    } rows[] = {
        {{1 + 0.9e-5, 1 + 0.9e-5, 1 + 0.9e-5, 1 + 0.9e-5, 1 + 0.9e-5}, false, REASON_NONE},
        {{1 + 1.1e-5, 1 + 1.1e-5, 1 + 1.1e-5, 1 + 1.1e-5, 1 + 1.1e-5}, false, REASON_ignored_ic},
        {{1 + 1.1e-5, 1 + 1.1e-5, 1 + 1.1e-5, 1 + 1.1e-5, 1 + 1.1e-5}, true, REASON_NONE},
        {{0.4, 1, 1, 1, 1.6}, false, REASON_NONE},
        {{0.92, 0.92, 1, 1.08, 1.08}, false, REASON_NONE},
        {{0.88, 0.88, 0.88, 1.18, 1.18}, false, REASON_ignored_ic}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        make(1, moving);
        move_all(0, 0.5);
        made.origin.cells = rows[k].cells;
        for (size_t i = 0; i < N; i++) made.file.column[SNAPSHOT_M][i] = rows[k].factor[i];
        if (compared() != rows[k].reason) fail_msg("row %zu: %s", k, made.message);
    }
}

/* Particles that should move by more than 1 % of the box, apart from whole rounds, have not moved
 * if none has moved by more than 1e-7 of it. */
TEST(particles_that_have_not_moved)
{
    static const struct {
        double way, moved; /* in box lengths; moved: of one particle */
        bool resting;
    } rows[] = {{0.011, 0, true},    {0.0098, 0, false},  {-0.011, 0, true},  {0.9898, 0, true},
                {0.9902, 0, false},  {3.011, 0, true},    {3.0098, 0, false}, {0.3, 0, true},
                {0.3, 0.9e-7, true}, {0.3, 1.1e-7, false}};
    for (int d = 0; d < 2; d++)
        for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
            make(1 + d, d ? drifting : moving);
            const double length = d ? 8 : 4, v = d ? 0.25 : 0.5;
            made.origin.t_end = fabs(rows[k].way) * length / v;
            made.file.time.known = false;
            if (d) move_all(0, 1);
            made.file.column[d][d ? 0 : N - 1] += rows[k].moved * length;
            assert_int_equal(compared(), rows[k].resting ? REASON_ignored_ic : REASON_NONE);
            if (rows[k].resting && !strstr(made.message, d ? "start along y" : "start along x"))
                fail_msg("%s", made.message);
        }
}

/* Without an exact solution it is not known how far particles should move. Where they should move
 * is taken at their places in the case, wherever the file counts positions from. */
TEST(motion_that_is_expected)
{
    make(2, "kind=kelvin_helmholtz");
    assert_int_equal(compared(), REASON_NONE);
    make(1, "kind=riemann|left=1 0 1|right=0.125 0 0.1|lo=-1|hi=1");
    made.origin.t_end = 0.2;
    made.file.time.value = 0.2;
    for (int place = 0; place < 2; place++) { /* in gas that no wave has reached, and in others */
        for (size_t i = 0; i < N; i++)
            made.ic.column[0][i] = made.file.column[0][i] = (place ? 0.5 : 0.02) * (double)i;
        assert_int_equal(compared(), place ? REASON_ignored_ic : REASON_NONE);
    }
}

/* ---- the start ---- */

static bool starts(void)
{
    made.message[0] = '\0';
    return code_is_start(&made.file, &made.origin, made.message, sizeof made.message);
}

TEST(snapshots_of_the_start)
{
    make(1, moving);
    made.file.gas = N - 1;
    made.origin.t_end = 2;
    made.file.time.value = 1.9e-6;
    assert_false(starts());
    assert_string_equal(made.message, "4 particles of gas, not the 5");
    made.file.time.value = -1.9e-6;
    assert_false(starts());
    made.file.time.value = 2.1e-6;
    assert_true(starts());
    made.file.time = (struct snapshot_value){false, 0};
    assert_true(starts());
    made.file.time.known = true;
    made.origin.cells = true;
    assert_true(starts());
    made.origin.cells = false, made.origin.ic = NULL;
    assert_true(starts());
    make(2, drifting);
    made.file.time.value = 0, made.file.dim = 1;
    assert_false(starts());
    assert_string_equal(made.message, "particles in 1D, not the 2D");
}

/* Positions may differ by a thousandth of a spacing, and may count from the case's corner or from
 * 0; most velocities and energies by 1 % of the greatest. */
TEST(differences_from_the_start)
{
    const double spacing = 1. / N; /* in box lengths, in 1D */
    struct {
        double x, v, u; /* changes of all but `kept`, in box lengths, sound speeds and energies */
        size_t kept;
        const char *says; /* "": it is the start */
    } rows[] = {{0.99e-3 * spacing, 0, 0, 0, ""},
                {1.0025e-3 * spacing, 0, 0, 0, ""}, /* and a millionth of the box */
                {1.02e-3 * spacing, 0, 0, 0, "positions along x are 0.0002 of the box from those"},
                {-1.02e-3 * spacing, 0, 0, 0, "positions along x"},
                {0.25, 0, 0, 0, ""}, /* the corner is at -1 of 4 */
                {0.75, 0, 0, 0, ""},
                {0.5, 0, 0, 0, "positions along x"},
                {0.1, 0, 0, 3, ""}, /* the median decides */
                {0.1, 0, 0, 2, "positions along x"},
                {0, 0.0099, 0, 0, ""},
                {0, 0.0101, 0, 0, "vx differs by 0.01 of the greatest from that"},
                {0, 0.5, 0, 3, ""},
                {0, 0.5, 0, 2, "vx differs"},
                {0, 0, 0.0099, 0, ""},
                {0, 0, -0.0101, 0, "u differs by 0.01 of the greatest from that"},
                {0, 0, 0.5, 3, ""},
                {0, 0, 0.5, 2, "u differs"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        make(1, moving);
        made.file.time.value = 0;
        for (size_t i = 0; i < N; i++) {
            made.ic.column[SNAPSHOT_U][i] = made.file.column[SNAPSHOT_U][i] = i ? 4 : 1;
            if (i < rows[k].kept) continue;
            made.file.column[0][i] += 4 * rows[k].x;
            made.file.column[SNAPSHOT_VX][i] += 2 * rows[k].v;
            made.file.column[SNAPSHOT_U][i] += 4 * rows[k].u;
        }
        if (starts() != !*rows[k].says || !strstr(made.message, rows[k].says))
            fail_msg("row %zu: '%s'", k, made.message);
    }
    /* round-off below the origin, where positions are wrapped */
    make(1, moving);
    made.file.time.value = 0;
    for (size_t i = 0; i < N; i++)
        made.ic.column[0][i] = made.file.column[0][i] = 0.8 * ((double)i - 1);
    made.file.column[0][1] -= 1e-9;
    assert_true(starts());
    /* fast gas: the greatest speed is the scale */
    make(1, moving);
    made.file.time.value = 0;
    made.ic.column[SNAPSHOT_VX][4] = made.file.column[SNAPSHOT_VX][4] = -10;
    for (size_t i = 0; i < 4; i++) made.file.column[SNAPSHOT_VX][i] += 0.09;
    assert_true(starts());
    for (size_t i = 0; i < 4; i++) made.file.column[SNAPSHOT_VX][i] += 0.02;
    assert_false(starts());
    /* along y; velocities that a file lacks, and that of a third direction, do not count */
    make(2, drifting);
    made.file.time.value = 0;
    made.file.column[SNAPSHOT_VX + 1][0] = 9;
    for (size_t i = 0; i < N; i++) made.file.column[0][i] += 4 * 3e-4; /* spacing: N^(-1/2) */
    made.file.column[SNAPSHOT_VX + 2] = made.ic.column[SNAPSHOT_VX + 2] =
        made.column[0][SNAPSHOT_P];
    assert_true(starts());
    for (size_t i = 0; i < N; i++) made.file.column[SNAPSHOT_VX + 1][i] = 3;
    assert_false(starts());
    assert_non_null(strstr(made.message, "vy differs"));
    made.file.column[SNAPSHOT_VX + 1] = NULL;
    assert_true(starts());
    for (size_t i = 0; i < N; i++) made.file.column[1][i] += 0.16;
    assert_false(starts());
    assert_non_null(strstr(made.message, "positions along y are 0.02 of the box"));
}
