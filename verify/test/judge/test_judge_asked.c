/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests how `judge` finds the case, its keys, the box, the window and the ends of a tube, from the
 * snapshot or from options, and which requests it refuses. */
#include "test.h"

#include "riemann.h"
#include "sample_snapshot.h"

#define TIMED "# time = 0.1\n# box = 2\n"
#define KEYED "# keys = left=1 0 1; right=0.9 0 0.9\n" TIMED

static void noted(const struct judged *judged, const char *what, const char *value,
                  const char *evidence)
{
    const struct snapshot_note *found = note(judged, what);
    assert_string_equal(found->value, value);
    if (!strstr(found->evidence, evidence)) fail_msg("%s: %s", what, found->evidence);
}

static bool is_noted(const struct judged *judged, const char *what)
{
    bool found = false;
    for (size_t k = 0; k < judged->file.notes.count; k++)
        found = found || strcmp(judged->file.notes.note[k].what, what) == 0;
    return found;
}

/* ---- case and keys ---- */

TEST(case_and_keys_of_the_file)
{
    static const struct {
        const char *head, *name;
        bool x0;
        double right; /* pressure of the gas on the right */
        bool keys;
    } rows[] = {{"# case = sod\n" TIMED, NULL, false, 0.1, false},
                {"# case = lax\n" TIMED, NULL, false, 0.571, false},
                {"# case = sod\n" KEYED, NULL, false, 0.9, true},
                {"# case = sod\n" KEYED, "sod", false, 0.9, true},
                {"# case = sod\n" KEYED, "lax", false, 0.571, false},
                {"# case = sod\n" KEYED, NULL, true, 0.1, false}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct judge_request request = {
            .case_name = rows[k].name, .kernel = -1, .x0 = {rows[k].x0, 1}};
        plant(1, 0, rows[k].head);
        struct judged judged = judges(&request);
        const struct setting_value *value = judged.run.settings.value;
        near_relative(value[SETTING_right].real[2], rows[k].right, 1e-14);
        assert_true(value[SETTING_left].real[1] ==
                    (value[SETTING_right].real[2] > 0.5 && !rows[k].keys ? 0.698 : 0));
        assert_true(is_noted(&judged, "keys") == rows[k].keys);
        if (rows[k].keys)
            noted(&judged, "keys", "of its run", "the file says left=1 0 1; right=0.9 0 0.9");
        assert_true(is_noted(&judged, "case") == !rows[k].name);
        if (!rows[k].name)
            noted(&judged, "case", strstr(rows[k].head, "lax") ? "lax" : "sod", "the file says so");
        judge_free(&judged);
    }
}

/* Keys of the initial state, and gravity, make it another flow than the case's; no other keys do.
 */
TEST(altered_initial_states)
{
    static const struct {
        const char *name, *keys;
        bool altered;
    } rows[] = {{"sod", "mass_ratio=2", true},         {"sod", "kernel=cubic_spline", false},
                {"sod", "left=1 0 1", true},           {"sod", "boundary=open", false},
                {"poiseuille", "gravity=0.4 0", true}, {"sod", "window=0.5 1.5", false}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct judge_request request = {.kernel = -1};
        char head[200];
        snprintf(head, sizeof head, "# case = %s\n# keys = %s\n" TIMED, rows[k].name, rows[k].keys);
        plant(strcmp(rows[k].name, "sod") ? 2 : 1, 0, head);
        struct judged judged = judges(&request);
        assert_true(judged.altered == rows[k].altered);
        judge_free(&judged);
    }
}

/* In 2D the boundaries are those that the file names, or else the case's. */
TEST(boundaries)
{
    static const struct {
        const char *said;
        enum boundary want[2];
    } rows[] = {{"reflecting reflecting", {BOUNDARY_REFLECTING, BOUNDARY_REFLECTING}},
                {"periodic reflecting", {BOUNDARY_PERIODIC, BOUNDARY_REFLECTING}},
                {"", {BOUNDARY_PERIODIC, BOUNDARY_PERIODIC}}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct judge_request request = {.kernel = -1};
        char head[200];
        snprintf(head, sizeof head, "# case = rest_2d\n# boundary = %s\n# time = 0\n# box = 2 1\n",
                 rows[k].said);
        plant(2, 0, head);
        struct judged judged = judges(&request);
        for (int d = 0; d < 2; d++)
            assert_int_equal(judged.run.problem.boundary[d], rows[k].want[d]);
        judge_free(&judged);
    }
    const struct judge_request request = {.kernel = -1}; /* one word is for all directions */
    plant(2, 0, "# case = rayleigh_taylor_mode\n# boundary = periodic\n# time = 0\n# box = 2 1\n");
    refuses(&request, "boundary=periodic along y");
}

TEST(refused_requests)
{
    static const struct {
        int dim;
        const char *head, *name, *left, *right, *box, *says;
    } rows[] = {
        {1, TIMED, NULL, NULL, NULL, NULL,
         "what should it be? It names no case; a line '# case = CASE'"},
        {1, TIMED, "no_such", NULL, NULL, NULL, "no_such"},
        {1, TIMED, "sod", "1 0", NULL, NULL, "--left"},
        {1, TIMED, "sod", NULL, "1 0 1 2 3", NULL, "--right"},
        {1, TIMED, "sod", "1 0 -1", NULL, NULL, "a.csv: "},
        {1, TIMED, "sod", NULL, "0 0 0", NULL, "particles cannot fill a vacuum"},
        {1, TIMED, "sod", NULL, NULL, "1 2 3 4", "judge: --box '1 2 3 4': allowed: LO:HI"},
        {1, TIMED, "sod", NULL, NULL, "", "judge: --box '': allowed: LO:HI"},
        {1, "# case = sod\n# keys = fancy=1\n" TIMED, NULL, NULL, NULL, NULL,
         "a.csv: what it says of its run: "},
        {1, "# case = sod\n# keys = left=1 0 1; fancy=1; n=100\n" TIMED, NULL, NULL, NULL, NULL,
         "fancy"},
        {2, "# case = rest_2d\n# boundary = sideways\n# box = 2 1\n", NULL, NULL, NULL, NULL,
         "what it says of its run: "},
        {1, "# time = 0.1\n# box = 0.01:2.01\n", "sod", NULL, NULL, NULL,
         "a.csv: the file's box reaches from 0.01 to 2.01 along x, but positions from 0 to 2"},
        {2, "# time = 0.1\n# box = 0:2 0.01:1.01\n", "sod", NULL, NULL, NULL,
         "a.csv: the file's box reaches from 0.01 to 1.01 along y, but positions from 0 to 1"},
        {1, "# time = 50\n# box = 2\n", "sod", NULL, NULL, NULL, "(t_end: the snapshot's time)"},
        {1, "# time = 0.1\n# box = -0.01:1.99\n", "sod", NULL, NULL, NULL,
         "a.csv: the file's box reaches from -0.01 to 1.99 along x, but positions from 0 to 2"},
        {1, "# time = 0.1 s\n# box = 2\n", "sod", NULL, NULL, NULL,
         "judge --time T; not taken: '# time = 0.1 s'; allowed: a number, and no unit"},
        {1, "# gamma = 0.5\n" TIMED, "sod", NULL, NULL, NULL,
         "gamma=0.5: allowed: a number above 1"},
        {2, TIMED, "noh_3d", NULL, NULL, NULL,
         "a.csv: particles in 2 dimensions; the case noh_3d has 3"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct judge_request request = {.case_name = rows[k].name,
                                              .left = rows[k].left,
                                              .right = rows[k].right,
                                              .box = rows[k].box,
                                              .kernel = -1};
        plant(rows[k].dim, 0, rows[k].head);
        refuses(&request, rows[k].says);
    }
    struct judge_request request = uniform_gas();
    request.left = "1 0 -1", request.boundary = "open";
    plant(1, 0, "");
    refuses(&request, "a.csv: its tube has no exact solution");
    request.left = "1 0 1", request.right = "0 0 0";
    refuses(&request, "particles cannot fill a vacuum");
}

/* ---- box and window ---- */

/* A case file whose window is not centred in its box; the box does not begin at 0. */
static char *own_case(int dim, const char *domain, const char *initial, const char *window)
{
    static char path[256];
    snprintf(path, sizeof path, "%s", path_of("own.ini"));
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fprintf(out,
            "[case]\ntitle = Own\ndimension = %d\nreference = riemann\n[domain]\nlo = 1\nhi = 3\n"
            "%s[initial]\nkind = riemann\nleft = 1 0 1\nright = 1 0 1\n%s[run]\nt_end = 0.1\n"
            "%s[measure]\n%sfields = density velocity pressure\n"
            "[converge]\nn = 100 200 400 800\ndensity_l1 = 0 1\n",
            dim, domain, initial, strstr(initial, "file") ? "" : "n = 100\n", window);
    fclose(out);
    return path;
}

#define WINDOW "window = 1.5 2.25\n"

TEST(windows)
{
    static const struct {
        const char *head, *asked, *name;
        double lo, hi, want[2];
        const char *note, *value, *evidence; /* NULL: no note about the window */
    } rows[] = {
        {"# box = 2\n", NULL, NULL, 0, 2, {0.5, 1.25}, NULL, NULL, NULL},
        {"# box = -2:0\n", NULL, NULL, -2, 0, {-1.5, -0.75}, NULL, NULL, NULL},
        {"# box = 2.001\n",
         NULL,
         NULL,
         0,
         2.001,
         {0.50025, 1.50075},
         "window",
         "the middle half",
         "the case's box is 2 long, the file's 2.001"},
        {"# box = 4\n",
         NULL,
         NULL,
         0,
         4,
         {1, 3},
         "window",
         "the middle half",
         "the case's box is 2 long, the file's 4"},
        {"# box = 2.000001\n", NULL, NULL, 0, 2.000001, {0.5000005, 1.2500005}, NULL, NULL, NULL},
        {"# box = 2\n", "0.7 1.9", NULL, 0, 2, {0.7, 1.9}, "window", NULL, "--window"},
        {"# box = 9\n", "0.7 1.9", NULL, 0, 9, {0.7, 1.9}, "window", NULL, "--window"},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct judge_request request = {
            .case_name = own_case(1, "", "", WINDOW), .time = {true, 0}, .kernel = -1};
        char text[80];
        if (rows[k].asked) {
            request.window = true;
            sscanf(rows[k].asked, "%lf %lf", &request.ends[0], &request.ends[1]);
        }
        plant(1, rows[k].lo, rows[k].head);
        gas.x[0][1] = rows[k].lo + fmin(2, rows[k].hi - rows[k].lo);
        struct judged judged = judges(&request);
        const struct prepared *p = &judged.run.problem;
        near_absolute(p->window.lo[0], rows[k].want[0], 1e-12);
        near_absolute(p->window.hi[0], rows[k].want[1], 1e-12);
        near_absolute(p->domain.lo[0], rows[k].lo, 1e-12);
        near_absolute(p->domain.hi[0], rows[k].hi, 1e-12);
        near_relative(judged.case_n, N * 2 / (p->domain.hi[0] - p->domain.lo[0]), 1e-12);
        assert_true(is_noted(&judged, "window") == !!rows[k].note);
        snprintf(text, sizeof text, "%.17g %.17g", request.ends[0], request.ends[1]);
        if (rows[k].note)
            noted(&judged, "window", rows[k].value ? rows[k].value : text, rows[k].evidence);
        judge_free(&judged);
    }
}

/* The ends and the window of a tube are those of the case, if it has any, unless the user asks for
 * others; its box is then also the case's if particles fill only a part of it. */
TEST(tubes_whose_case_has_ends)
{
    static const struct {
        const char *boundary, *window;
        bool asked;
        double first, want[2]; /* position of the first particle */
        const char *box, *evidence;
    } rows[] = {
        {"boundary = open\n", WINDOW, false, 2, {1.5, 2.25}, "lie in the case's", "--window or"},
        {"boundary = open\n", WINDOW, true, 2, {1.75, 2.5}, "lie in the case's", "--window or"},
        {"boundary = open\n", "", false, 2, {1, 3}, "lie in the case's", "from end to end"},
        {"boundary = open\n", "", true, 2, {1.75, 2.5}, "lie in the case's", "--window or"},
        {"", WINDOW, false, 1.2, {1.5, 2.25}, "lie in the case's and fill it", NULL},
        {"", WINDOW, false, 2, {2.25, 2.75}, "as far as particles reach", "the case's box is 2"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct judge_request request = {.case_name =
                                            own_case(1, rows[k].boundary, "", rows[k].window),
                                        .time = {true, 0},
                                        .kernel = -1,
                                        .window = rows[k].asked,
                                        .ends = {1.75, 2.5}};
        plant(1, 0, "");
        for (int i = 0; i < N; i++)
            gas.x[0][i] = rows[k].first + (3 - rows[k].first) * i / (N - 1), gas.m[i] /= 8;
        struct judged judged = judges(&request);
        if (!strstr(note(&judged, "box")->evidence, rows[k].box))
            fail_msg("row %zu: %s", k, note(&judged, "box")->evidence);
        near_absolute(judged.run.problem.window.lo[0], rows[k].want[0], 1e-12);
        near_absolute(judged.run.problem.window.hi[0], rows[k].want[1], 1e-12);
        assert_true(is_noted(&judged, "window") == !!rows[k].evidence);
        if (rows[k].evidence && !strstr(note(&judged, "window")->evidence, rows[k].evidence))
            fail_msg("row %zu: %s", k, note(&judged, "window")->evidence);
        assert_true(is_noted(&judged, "ends") == !!*rows[k].boundary);
        judge_free(&judged);
    }
}

/* The sums of the start are those of the case's own lattice or file, whatever lattice the file's
 * run had; they are unknown if the case starts from a glass. */
TEST(sums_of_the_start)
{
    static const char *const keys[] = {"", "# keys = lattice=random\n",
                                       "# keys = equal_masses=no\n"},
                             *const starts[] = {"", "lattice = glass\n", "file = p.csv\n"};
    struct conservation first = {0};
    for (int k = 0; k < 6; k++) {
        const char *name = k < 3 ? "square" : own_case(2, "", starts[k - 3], WINDOW);
        const struct judge_request request = {.time = {true, 0}, .kernel = -1};
        char head[200];
        double mass = 0;
        snprintf(head, sizeof head,
                 k < 3 ? "# case = %s\n%s# box = 0:2 0:1\n" : "# case = %s\n%s# box = 1:3 1:2\n",
                 name, k < 3 ? keys[k] : "");
        plant(2, k < 3 ? 0 : 1, head);
        put("p.csv");
        for (int i = 0; i < N; i++) mass += gas.m[i];
        struct judged judged = judges(&request);
        const struct conservation *start = &judged.start;
        if (k == 0) first = judged.start;
        if (k < 3)
            assert_true(start->mass == first.mass && start->energy == first.energy);
        else
            near_absolute(start->mass, k == 3 ? 2 : k == 4 ? 0 : mass, 1e-12);
        assert_true(settings_real(&judged.run.settings, SETTING_n) == N);
        judge_free(&judged);
    }
}

/* A case of particles from a file says nothing about a later snapshot. */
TEST(cases_without_a_solution)
{
    FILE *out = fopen(path_of("parts.ini"), "w");
    fputs("[case]\ntitle = Own\ndimension = 1\nreference = none\n[domain]\nlo = 0\nhi = 2\n"
          "[initial]\nkind = particles\nfile = a.csv\n[run]\nt_end = 0.1\n",
          out);
    fclose(out);
    for (int allowed = 0; allowed < 2; allowed++) {
        char path[256];
        snprintf(path, sizeof path, "%s", path_of("parts.ini"));
        const struct judge_request request = {
            .case_name = path, .kernel = -1, .allow_far = allowed};
        plant(1, 0, TIMED);
        struct judged judged = judges(&request);
        assert_true(judged.passes && !judged.far && judged.silent == !allowed);
        assert_true(judged.wrong == 0);
        const char *begin = "nothing of this case is known at t = 0.1, so nothing was compared; ";
        assert_int_equal(strncmp(judged.verdict, begin, strlen(begin)), 0);
        judge_free(&judged);
    }
    /* how a mode grows is known for one gamma */
    const struct judge_request request = {
        .case_name = "kelvin_helmholtz", .time = {true, 1}, .gamma = {true, 1.4}, .kernel = -1};
    plant(2, 0, "# box = 1\n");
    for (int i = 0; i < N; i++) gas.x[0][i] /= 2;
    struct judged judged = judges(&request);
    assert_true(judged.wrong == 0);
    judge_free(&judged);
}

/* In 1D a radius gives a window of twice that length about the middle of the box, wherever the
 * box's ends are. */
TEST(radius_of_a_line)
{
    for (int open = 0; open < 2; open++) {
        struct judge_request request = uniform_gas();
        request.radius = 0.25, request.x0 = (struct snapshot_value){true, 1.125};
        request.boundary = open ? "open" : NULL;
        plant(1, 0, "# box = 2\n");
        struct judged judged = judges(&request);
        near_absolute(judged.run.problem.window.lo[0], 0.75, 1e-15);
        near_absolute(judged.run.problem.window.hi[0], 1.25, 1e-15);
        judge_free(&judged);
    }
}

/* The window of a disc or a ball; the size of the box is noted if it is not the case's. */
TEST(windows_of_discs_and_balls)
{
    for (int k = 0; k < 4; k++) {
        const double length = k == 0 ? 1 : k == 1 ? 1 + 5e-7 : k == 2 ? 1 + 1e-4 : 2;
        struct judge_request request = {
            .case_name = "gresho", .time = {true, 0}, .kernel = -1, .radius = k % 2 ? 0.3125 : 0};
        char head[80], says[80];
        snprintf(head, sizeof head, k < 3 ? "# box = %.17g\n" : "# box = -0.25:1.75 -0.25:1.75\n",
                 length);
        plant(2, 0, head);
        for (int i = 0; i < N; i++) gas.x[0][i] /= 2;
        struct judged judged = judges(&request);
        if (request.radius > 0) {
            assert_true(judged.run.problem.window.radius == 0.3125);
            noted(&judged, "window", "radius 0.3125", "--window");
        }
        assert_true(is_noted(&judged, "size") == (k > 1));
        snprintf(says, sizeof says, "the case's box is 1 long, the file's %.6g", length);
        if (k > 1) noted(&judged, "size", "not the case's", says);
        judge_free(&judged);
    }
}

/* A flow along x is judged in any number of dimensions, whichever its case is written in. Only in
 * 1D do volumes tell where the box ends. */
TEST(dimensions_of_flows_along_x)
{
    for (int k = 0; k < 9; k++) {
        static const char *const names[] = {"sod", "sod_2d", "sod_3d"};
        const int dim = 1 + k / 3, written = 1 + k % 3;
        struct judge_request request = uniform_gas();
        char value[40], evidence[80];
        request.case_name = names[k % 3];
        plant(dim, 0, "");
        for (int i = 0; i < N && dim > 1; i++) gas.m[i] = 2. / N; /* the extent along x */
        struct judged judged = judges(&request);
        assert_int_equal(judged.run.problem.domain.dim, dim);
        for (int d = 0; d < dim; d++)
            near_absolute(judged.run.problem.domain.hi[d], d ? 1 : 2, 1e-15);
        assert_true(is_noted(&judged, "case") == (dim != written));
        snprintf(value, sizeof value, "in %d dimensions", dim);
        snprintf(evidence, sizeof evidence, "it is written in %d, but its solution varies along x",
                 written);
        if (dim != written) noted(&judged, "case", value, evidence);
        judge_free(&judged);
    }
}

/* Particles that are wrapped back into the box are sorted along the line. */
TEST(wrapped_particles_are_sorted)
{
    struct judge_request request = uniform_gas();
    request.x0 = (struct snapshot_value){true, 0.5};
    request.box = "-0.25:2.25";
    plant(1, 0, "");
    struct judged judged = judges(&request);
    noted(&judged, "box", "-0.25 to 2.25 along x", "--box");
    noted(&judged, "x0", "0.5", "--x0");
    const struct snapshot *s = &judged.result.snapshot;
    int beyond = 0;
    for (size_t i = 0; i < N; i++) {
        if (i) assert_true(s->x[0][i] >= s->x[0][i - 1]);
        assert_true(s->x[0][i] >= -0.75 && s->x[0][i] < 1.75);
        beyond += s->x[0][i] < 0;
    }
    assert_true(beyond > 10);
    judge_free(&judged);
}

/* ---- ends of a tube ---- */

static void put_tube(const struct riemann_state sides[2], double x0)
{
    for (int i = 0; i < N; i++) {
        const struct riemann_state *side = &sides[gas.x[0][i] > x0];
        gas.rho[i] = side->rho, gas.v[0][i] = side->v, gas.u[i] = side->P / (0.4 * side->rho);
    }
}

#define USUAL                                                                                      \
    {                                                                                              \
        {1, 0.25, 1},                                                                              \
        {                                                                                          \
            0.125, 0.25, 0.1                                                                       \
        }                                                                                          \
    }

/* Open ends or walls are recognised if the gas beside both ends has its initial state. */
TEST(open_ends_are_recognised)
{
    static const struct {
        struct riemann_state sides[2];
        double time, at[2]; /* distance of two particles from either end, over the length */
        double rho, v;      /* error of one of them, over its density and sound speed */
        bool ended;
    } rows[] = {
        {USUAL, 0.1, {0.0101, 0.0399}, 0, 0, true},
        {USUAL, 0.1, {0.0099, 0.0399}, 0, 0, false},
        {USUAL, 0.1, {0.0101, 0.0401}, 0, 0, false},
        /* the limit is half of the error of one particle */
        {USUAL, 0.1, {0.02, 0.03}, 0.0599, 0, true},
        {USUAL, 0.1, {0.02, 0.03}, 0.0601, 0, false},
        {USUAL, 0.1, {0.02, 0.03}, -0.0599, 0, true},
        {USUAL, 0.1, {0.02, 0.03}, -0.0601, 0, false},
        {USUAL, 0.1, {0.02, 0.03}, 0, 0.0599, true},
        {USUAL, 0.1, {0.02, 0.03}, 0, 0.0601, false},
        {USUAL, 0.1, {0.02, 0.03}, 0, -0.0599, true},
        {USUAL, 0.1, {0.02, 0.03}, 0, -0.0601, false},
        /* sound in the slower gas must have travelled 0.05 of the length */
        {USUAL, 0.0946, {0.02, 0.03}, 0, 0, true},
        {USUAL, 0.0944, {0.02, 0.03}, 0, 0, false},
        /* gases whose density or pressure differ by more than a tenth are two gases */
        {{{1, 0.25, 1}, {1, 0.25, 0.89}}, 0.2, {0.02, 0.03}, 0, 0, true},
        {{{1, 0.25, 1}, {1, 0.25, 0.905}}, 0.2, {0.02, 0.03}, 0, 0, false},
        {{{1, 0.25, 0.89}, {1, 0.25, 1}}, 0.2, {0.02, 0.03}, 0, 0, true},
        {{{1, 0.25, 0.905}, {1, 0.25, 1}}, 0.2, {0.02, 0.03}, 0, 0, false},
        {{{1, 0.25, 1}, {0.89, 0.25, 1}}, 0.2, {0.02, 0.03}, 0, 0, true},
        {{{1, 0.25, 1}, {0.905, 0.25, 1}}, 0.2, {0.02, 0.03}, 0, 0, false},
        {{{0.89, 0.25, 1}, {1, 0.25, 1}}, 0.2, {0.02, 0.03}, 0, 0, true},
        {{{0.905, 0.25, 1}, {1, 0.25, 1}}, 0.2, {0.02, 0.03}, 0, 0, false},
        {{{1, 0.25, 4}, {1, 0.25, 3.56}}, 0.15, {0.02, 0.03}, 0, 0, true},
        {{{1, 0.25, 4}, {1, 0.25, 3.62}}, 0.15, {0.02, 0.03}, 0, 0, false},
        {{{4, 0.25, 1}, {3.56, 0.25, 1}}, 0.2, {0.02, 0.03}, 0, 0, true},
        {{{4, 0.25, 1}, {3.62, 0.25, 1}}, 0.2, {0.02, 0.03}, 0, 0, false},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int side = 0; side < 2; side++) {
            const struct riemann_state *sides = rows[k].sides;
            char left[80], right[80];
            struct judge_request request = uniform_gas();
            request.left = left, request.right = right, request.time.value = rows[k].time;
            snprintf(left, 80, "%.17g %.17g %.17g", sides[0].rho, sides[0].v, sides[0].P);
            snprintf(right, 80, "%.17g %.17g %.17g", sides[1].rho, sides[1].v, sides[1].P);
            plant(1, 1, "# box = 1:3\n");
            for (int i = 0; i < N; i++) gas.x[0][i] = draw(1.1, 2.9);
            for (int end = 0; end < 2; end++)
                for (int i = 0; i < 2; i++)
                    gas.x[0][2 * end + i] = end ? 3 - 2 * rows[k].at[i] : 1 + 2 * rows[k].at[i];
            put_tube(sides, 2);
            const struct riemann_state *gas_there = &sides[side];
            gas.rho[2 * side + 1] *= 1 + rows[k].rho;
            gas.v[0][2 * side + 1] += rows[k].v * sqrt(1.4 * gas_there->P / gas_there->rho);
            struct judged judged = judges(&request);
            if (is_noted(&judged, "ends") != rows[k].ended) fail_msg("row %zu, %d", k, side);
            /* the box of a tube with ends extends beyond them */
            assert_int_equal(judged.run.problem.domain.lo[0] < 1, rows[k].ended);
            if (rows[k].ended)
                noted(&judged, "ends", "open or walls", "the gas at both is undisturbed");
            judge_free(&judged);
        }
    /* a boundary that the user or the file names takes precedence */
    struct judge_request request = uniform_gas();
    request.right = "0.125 0 0.1", request.boundary = "periodic";
    plant(1, 0, "# box = 2\n# boundary = open\n");
    struct judged judged = judges(&request);
    noted(&judged, "ends", "periodic", "--boundary");
    assert_true(judged.run.problem.domain.lo[0] == 0 && judged.run.problem.domain.hi[0] == 2);
    judge_free(&judged);
    request.boundary = NULL;
    judged = judges(&request);
    assert_false(is_noted(&judged, "ends"));
    judge_free(&judged);
}

/* The fastest signal is 1.5 times the largest speed or speed plus sound speed. */
static double fastest(const struct riemann_state sides[2], bool mirrored)
{
    struct riemann_solution s;
    assert_null(riemann_solve(1.4, &sides[mirrored], &sides[!mirrored], &s));
    const double speeds[] = {s.left_head, s.left_tail, s.right_head, s.right_tail};
    double most = 0;
    for (int k = 0; k < 2; k++)
        most = fmax(most, fabs(sides[k].v) + sqrt(1.4 * sides[k].P / sides[k].rho));
    if (!s.vacuum) {
        most = fmax(most, fabs(s.v_star) + sqrt(1.4 * s.p_star / s.rho_star_left));
        most = fmax(most, fabs(s.v_star) + sqrt(1.4 * s.p_star / s.rho_star_right));
    }
    for (int k = 0; k < 4; k++) most = fmax(most, fabs(speeds[k]));
    return 1.5 * most;
}

/* The window leaves out what waves from the ends may have reached; all particles are in the box. At
 * either end of gas at rest these are the tube's own waves, which come back. */
TEST(windows_of_random_tubes)
{
    int clean = 0, cut = 0, spoilt = 0, came_back[2] = {0, 0};
    for (int k = 0; k < 90; k++) {
        struct judge_request request = uniform_gas();
        struct riemann_state sides[2];
        struct riemann_solution solution;
        struct judged judged;
        char texts[2][100], head[80], value[80];
        const double lo = draw(-1, 1), length = draw(1, 2), time = draw(0.01, 0.3);
        const double ends[2] = {lo, lo + length}, x0 = lo + length * draw(0.05, 0.95);
        for (int side = 0; side < 2; side++) {
            sides[side] = (struct riemann_state){
                draw(0.1, 1), k % 3 ? 0 : draw(-1, 1) * (k % 2 ? 20 : 0.5), draw(0.1, 1)};
            snprintf(texts[side], sizeof texts[side], "%.17g %.17g %.17g", sides[side].rho,
                     sides[side].v, sides[side].P);
        }
        request.left = texts[0], request.right = texts[1], request.time.value = time;
        request.boundary = "open", request.x0 = (struct snapshot_value){true, x0};
        request.window = k % 7 == 6;
        request.ends[0] = lo + 0.1 * length, request.ends[1] = lo + 0.9 * length;
        snprintf(head, sizeof head, "# box = %.17g:%.17g\n", lo, lo + length);
        plant(1, 0, head);
        for (int i = 0; i < N; i++) gas.x[0][i] = draw(ends[0], ends[1]);
        put_tube(sides, x0);
        assert_null(riemann_solve(1.4, &sides[0], &sides[1], &solution));
        const double speed = fmax(fastest(sides, false), fastest(sides, true));
        double window[2], from[2];
        for (int side = 0; side < 2; side++) {
            const double head_speed = side ? solution.right_head : -solution.left_head;
            const double c = sqrt(1.4 * sides[side].P / sides[side].rho);
            const bool waits = fabs(sides[side].v) <= 1e-9 * c && !isnan(head_speed);
            const double arrival = !waits           ? 0
                                   : head_speed > 0 ? fabs(ends[side] - x0) / head_speed
                                                    : (double)INFINITY;
            from[side] = speed * fmax(0, time - arrival);
            window[side] = ends[side] + (side ? -from[side] : from[side]);
            if (request.window) window[side] = request.ends[side];
        }
        if (!(window[0] < window[1])) {
            refuses(&request, "waves may have come back from the ends to everywhere in [");
            snprintf(value, sizeof value, "at t = %g waves", time);
            refuses(&request, value);
            snprintf(value, sizeof value, "[%g, %g]; --window", ends[0], ends[1]);
            refuses(&request, value);
            spoilt++;
            continue;
        }
        struct error error = {0};
        if (judge_snapshot(put("a.csv"), &request, &judged, &error)) {
            judge_free(&judged); /* a window without particles */
            if (!strstr(error.message, "no particle lies in the window"))
                fail_msg("%s", error.message);
            continue;
        }
        const struct prepared *p = &judged.run.problem;
        const double half = fmax(x0 - ends[0], ends[1] - x0) +
                            fmax(fabs(window[0] - x0), fabs(window[1] - x0)) + 4 * speed * time;
        near_absolute(p->domain.lo[0] - (x0 - half), 0, 1e-12 * half);
        near_absolute(p->domain.hi[0] - (x0 + half), 0, 1e-12 * half);
        near_absolute(p->window.lo[0] - window[0], 0, 1e-12 * half);
        near_absolute(p->window.hi[0] - window[1], 0, 1e-12 * half);
        snprintf(value, sizeof value, "%.6g to %.6g", window[0], window[1]);
        noted(&judged, "window", value,
              request.window          ? "--window"
              : from[0] + from[1] > 0 ? "but for what waves from the ends may have reached"
                                      : "from end to end: no wave has reached one");
        noted(&judged, "ends", "open", "--boundary");
        if (!request.window) from[0] + from[1] > 0 ? cut++ : clean++;
        for (int side = 0; side < 2 && k % 3 && !request.window; side++)
            came_back[side] += from[side] > 0;
        judge_free(&judged);
    }
    if (clean < 5 || cut < 5 || spoilt < 3 || came_back[0] < 3 || came_back[1] < 3)
        fail_msg("%d, %d, %d, %d, %d", clean, cut, spoilt, came_back[0], came_back[1]);
}
