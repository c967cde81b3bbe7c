/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests profiles of runs in 2D and 3D on a made-up gas: maps, the particles of the window over the
 * coordinate that the solution depends on, the exact curve, and cases without one. */
#include "test.h"

#include "map.h"
#include "run_output.h"
#include "value.h"

enum { FEW = 7, MANY = 4505, CURVE = 201 };
static const double few[3][FEW] = {{-0.875, -0.25, -0.125, 0.25, 0.3125, 0.4375, 0.75},
                                   {0.125, 0.375, 0.25, -0.3125, 0.25, 0.875, 0},
                                   {0.5, -0.25, 0.75, 0.125, -0.125, 0.25, 0}};
static const double boost[3] = {0.5, -0.25, 0.125}, centre[3] = {0.0625, 0, 0.03125};
static const double now = 0.25;

/* ---- the gas ---- */

static bool around;              /* the flow is around the centre, not along x */
static bool even;                /* the flow is uniform */
static double mark[2], off[4];   /* near this x and y, add to rho, v[0], v[1], P */
static struct problem problem;   /* has a sample function only */
static struct run_result result; /* at time `now`, with a boost */

static const double behind = 0.4921875; /* a position in the window */

/* Fails at the position stored after the last particle, and if the problem has another boundary. */
static void sample(const struct prepared *p, const double at[3], double t, struct problem_state *s)
{
    const double x = at[0] - centre[0], y = at[1] - centre[1],
                 z = p->domain.dim > 2 ? at[2] - centre[2] : 0, R = sqrt(x * x + y * y + z * z);
    assert_true(isfinite(at[0]) && at[1] != behind);
    assert_true(t == now && p->boundary[0] == BOUNDARY_FIXED);
    *s = (struct problem_state){
        .rho = 2 + at[0], .v = {3 + at[0] * at[0], 0.5, 0.25}, .P = 5 - at[0]};
    const double turn = p->domain.dim == 2 ? 1 + R : 0; /* azimuthal; the radial one is 2 - R */
    if (around)
        *s = (struct problem_state){
            .rho = 2 + R,
            .v = {(-y * turn + x * (2 - R)) / R, (x * turn + y * (2 - R)) / R, z * (2 - R) / R},
            .P = 5 - R};
    if (around && y == 0 && z == 0 && x < 0)
        s->rho += 1; /* the curve lies on the half line with x > 0 */
    if (even) *s = (struct problem_state){.rho = 0x1p-10, .v = {around ? 0 : -1000}, .P = 1};
    if (!(fabs(at[0] - mark[0]) < 1e-6 && fabs(at[1] - mark[1]) < 1e-6)) return;
    s->rho += off[0], s->v[0] += off[1], s->v[1] += off[2], s->P += off[3];
}

static double x[3][MANY + 1], v[3][MANY + 1], rho[MANY + 1], P[MANY + 1], h[MANY + 1];

/* n particles at positions that include the boost, and one more element, which must not be read. */
static void make(int dim, bool circular, size_t n)
{
    around = circular;
    even = false;
    mark[0] = mark[1] = (double)NAN;
    problem =
        (struct problem){.circular = circular ? CIRCULAR_ROUND : CIRCULAR_NOT, .sample = sample};
    result = (struct run_result){.n = n, .time = now};
    result.problem =
        (struct prepared){.problem = &problem,
                          .domain = {dim, {-1, -1, -1}, {1, 1, 1}},
                          .window = {dim, {-0.375, -0.5, -0.5}, {0.5, 0.53125, 0.5625}, {0}, 0},
                          .boundary = {BOUNDARY_FIXED, BOUNDARY_FIXED, BOUNDARY_FIXED},
                          .gamma = 1.4};
    for (int d = 0; d < dim; d++) result.problem.boost[d] = boost[d];
    for (int d = 0; d < 3; d++) result.problem.window.centre[d] = centre[d];
    for (size_t i = 0; i < n; i++) {
        for (int d = 0; d < 3; d++) {
            x[d][i] = n == FEW ? few[d][i] : fmod(0.375 + (0.25 + 0.0625 * d) * (double)i, 0.75);
            x[d][i] += boost[d] * now - (n == FEW ? 0 : 0.25);
            v[d][i] = 1 + d + 0.125 * (double)(i % 5);
        }
        rho[i] = 2 + 0.5 * (double)i, P[i] = 3 + 0.25 * (double)i, h[i] = 9;
    }
    for (int d = 0; d < 3; d++)
        x[d][n] = boost[d] * now + (d == 1 ? behind : 0), v[d][n] = (double)NAN;
    rho[n] = P[n] = (double)NAN;
    result.snapshot = (struct snapshot){.n = n,
                                        .x = {x[0], x[1], dim > 2 ? x[2] : NULL},
                                        .v = {v[0], v[1], dim > 2 ? v[2] : NULL},
                                        .rho = rho,
                                        .P = P,
                                        .h = h,
                                        .time = now};
}

/* Position of particle i without the boost. Returns true if it lies in the window. */
static bool place_of(size_t i, double at[3])
{
    const struct window *window = &result.problem.window;
    bool inside = true;
    for (int d = 0; d < 3; d++) {
        at[d] = d < window->dim ? x[d][i] - boost[d] * now : 0;
        if (d < window->dim) inside = inside && at[d] >= window->lo[d] && at[d] <= window->hi[d];
    }
    return inside;
}

/* ---- what is compared ---- */

static double number(const json_t *object, const char *name, size_t i)
{
    return value_real(json_array_get(json_object_get(object, name), i));
}

static size_t length(const json_t *object, const char *name)
{
    return json_array_size(json_object_get(object, name));
}

static void same(const json_t *object, const char *name, size_t i, double want)
{
    const double got = number(object, name, i);
    if (!(fabs(got - want) <= 1e-13 * fabs(want) || (isnan(got) && isnan(want))))
        fail_msg("%s %zu: %.17g, not %.17g", name, i, got, want);
}

static const char *const along_x[] = {"density", "velocity", "pressure", NULL}, *const over_R[] = {
                                                                                    "density",
                                                                                    "azimuthal",
                                                                                    "radial",
                                                                                    "pressure"};

/* Density, velocities and pressure of the gas at a position, as in the curve. */
static void exact_at(const double at[3], double values[4])
{
    double square = 0;
    for (int d = 0; d < result.problem.domain.dim; d++) square += pow(at[d] - centre[d], 2);
    const double R = sqrt(square);
    const double round[] = {2 + R, result.problem.domain.dim == 2 ? 1 + R : 0, 2 - R, 5 - R},
                 plain[] = {2 + at[0], 3 + at[0] * at[0], 5 - at[0], 0};
    for (int q = 0; q < 4; q++) values[q] = (around ? round : plain)[q];
}

TEST(maps)
{
    for (int k = 0; k < 4; k++) {
        const int dim = k < 2 ? 2 : 3;
        const size_t n = k % 2 ? MANY : FEW;
        struct map map;
        struct error error;
        double values[MANY], z[64 * 64];
        make(dim, false, n);
        json_t *profile = profile_json(&result), *made = json_object_get(profile, "map");
        assert_int_equal(map_create(&map, &result.problem.domain, &result.snapshot, 64, &error), 0);
        const size_t cells = map.nx * map.ny;
        assert_int_equal(map.nx, n == FEW ? (dim == 2 ? 3 : 2) : dim == 2 ? 64 : 17);
        assert_int_equal(json_object_size(made), dim == 2 ? 5 : 6);
        assert_true(length(made, "x") == map.nx && length(made, "y") == map.ny);
        for (size_t i = 0; i < map.nx; i++) same(made, "x", i, map.x[i]);
        for (size_t i = 0; i < map.ny; i++) same(made, "y", i, map.y[i]);
        assert_int_equal(length(made, "slice"), dim == 3 ? 2 : 0);
        for (size_t i = 0; i < 2 && dim == 3; i++) same(made, "slice", i, map.slice[i]);
        map_mean(&map, rho, z);
        for (size_t i = 0; i < cells; i++) same(made, "density", i, z[i]);
        for (size_t i = 0; i < n; i++)
            values[i] =
                sqrt(v[0][i] * v[0][i] + v[1][i] * v[1][i] + (dim == 3 ? v[2][i] * v[2][i] : 0));
        map_mean(&map, values, z);
        for (size_t i = 0; i < cells; i++) same(made, "speed", i, z[i]);
        for (size_t i = 0; i < n; i++) {
            double at[3], square = 0;
            const bool inside = place_of(i, at);
            const double exact[] = {3 + at[0] * at[0], 0.5, 0.25};
            for (int d = 0; d < dim; d++) square += pow(v[d][i] - boost[d] - exact[d], 2);
            values[i] = inside ? sqrt(square) : (double)NAN;
        }
        map_mean(&map, values, z);
        for (size_t i = 0; i < cells; i++) same(made, "error", i, z[i]);
        assert_true(length(made, "density") == cells && length(made, "speed") == cells &&
                    length(made, "error") == cells);
        map_free(&map);
        json_decref(profile);
    }
}

/* If only functionals are known there is neither an error nor a curve. */
TEST(nothing_to_compare_with)
{
    make(2, false, FEW);
    problem.fieldless = true;
    json_t *profile = profile_json(&result), *made = json_object_get(profile, "map");
    assert_true(json_object_size(profile) == 2 && json_object_size(made) == 4);
    assert_true(value_member(profile, "dim") == 2);
    assert_null(json_object_get(made, "error"));
    json_decref(profile);
}

/* Particles of the window in order, and the curve from end to end of it, or from the centre. */
TEST(particles_and_the_curve)
{
    for (int k = 0; k < 4; k++) {
        const int dim = 2 + k / 2;
        make(dim, k % 2, FEW);
        json_t *profile = profile_json(&result), *exact = json_object_get(profile, "exact");
        const char *const *names = around ? over_R : along_x;
        const size_t count = around ? 4 : 3;
        size_t shown = 0;
        assert_true(value_member(profile, "dim") == dim);
        assert_string_equal(value_text(profile, "over"), around ? "R" : "x");
        assert_int_equal(length(profile, "quantities"), count);
        assert_int_equal(json_object_size(profile), 5 + 1 + 2 * count);
        assert_int_equal(json_object_size(exact), 1 + count);
        for (size_t q = 0; q < count; q++)
            assert_string_equal(
                json_string_value(json_array_get(json_object_get(profile, "quantities"), q)),
                names[q]);
        for (size_t i = 0; i < FEW; i++) {
            double at[3], want[4], square = 0, out = 0, squares = 0, w[3];
            if (!place_of(i, at)) continue;
            exact_at(at, want);
            for (int d = 0; d < dim; d++) {
                w[d] = v[d][i] - boost[d];
                square += pow(at[d] - centre[d], 2);
                out += (at[d] - centre[d]) * w[d];
                squares += w[d] * w[d];
            }
            const double R = sqrt(square);
            const double round = dim == 2 ? ((at[0] - centre[0]) * w[1] - at[1] * w[0]) / R
                                          : sqrt(squares - out * out / square);
            const double mine[] = {rho[i], round, out / R, P[i]}, plain[] = {rho[i], w[0], P[i], 0};
            same(profile, "x", shown, around ? R : at[0]);
            for (size_t q = 0; q < count; q++) {
                char name[32];
                snprintf(name, sizeof name, "exact_%s", names[q]);
                near_relative(number(profile, names[q], shown), (around ? mine : plain)[q], 1e-12);
                near_absolute(1 + number(profile, name, shown), 1 + want[q], 1e-12);
            }
            shown++;
        }
        assert_int_equal(shown, 4 - (dim == 3));
        assert_int_equal(length(profile, "x"), shown);
        assert_int_equal(length(exact, "x"), CURVE);
        const double from = around ? 0 : -0.375, to = around ? 0.5 - centre[0] : 0.5;
        for (size_t i = 0; i < CURVE; i++) {
            const double at = from + (to - from) * ((double)i + 0.5) / CURVE;
            const double place[3] = {around ? centre[0] + at : at, centre[1],
                                     dim > 2 ? centre[2] : 0};
            double want[4];
            exact_at(place, want);
            near_relative(number(exact, "x", i), at, 1e-12);
            for (size_t q = 0; q < count; q++)
                near_absolute(1 + number(exact, names[q], i), 1 + want[q], 1e-12);
        }
        json_decref(profile);
    }
}

/* Of many particles about 600 are kept, drawn by Knuth's generator instead of every k-th one. */
TEST(particles_that_are_kept)
{
    uint64_t drawn = 1;
    size_t shown = 0, nearest = 0;
    make(2, false, MANY);
    json_t *profile = profile_json(&result);
    for (size_t i = 0; i < MANY; i++) {
        double at[3];
        drawn = drawn * 6364136223846793005u + 1442695040888963407u;
        const double part = (double)(drawn >> 11) / 9007199254740992. * MANY;
        nearest += part > 600 - 5e-4 && part <= 600;
        if (part > 600) continue;
        assert_true(place_of(i, at));
        same(profile, "density", shown++, rho[i]);
    }
    assert_true(length(profile, "density") == shown && shown > 550 && shown < 650 && nearest);
    json_decref(profile);
}

static bool has_a_curve(void)
{
    json_t *profile = profile_json(&result);
    const bool curve = json_object_get(profile, "over") != NULL;
    json_decref(profile);
    return curve;
}

/* One particle of an otherwise uniform gas differs in one quantity, by a little less or more than
 * 1e-9, absolute and relative. */
TEST(flows_without_a_curve)
{
    for (int k = 0; k < 8; k++) {
        const int q = k % 4;
        const bool circular = k > 3;
        if (!circular && q == 2) continue; /* only the velocity along x counts */
        for (int sign = -1; sign <= 1; sign += 2)
            for (int more = -1; more <= 1; more += 2) {
                static const double rest[] = {0x1p-10, 0, 0, 1};
                make(2, circular, FEW);
                even = true;
                const double size = !circular && q == 1 ? 1000 : rest[q];
                x[0][1] = centre[0] + boost[0] * now; /* above the centre */
                mark[0] = centre[0], mark[1] = few[1][1];
                memset(off, 0, sizeof off);
                off[q] = sign * 1e-9 * (1 + size) * (1 + more * (size == 1000 ? 1e-5 : 2e-7));
                assert_int_equal(has_a_curve(), more < 0);
                mark[0] = few[0][0], mark[1] = few[1][0]; /* outside of the window */
                off[q] = 1;
                assert_true(has_a_curve());
            }
    }
    make(2, true, FEW); /* a difference equal to the bound is allowed */
    even = true;
    x[0][1] = centre[0] + boost[0] * now;
    mark[0] = centre[0], mark[1] = few[1][1];
    memset(off, 0, sizeof off);
    for (int k = 0; k < 9; k++) off[2] = 1e-9 * (1 + off[2]);
    assert_true(has_a_curve());
    off[2] = nextafter(off[2], 1);
    assert_false(has_a_curve());
    make(3, true, MANY); /* in 3D the azimuthal velocity is round-off */
    assert_true(has_a_curve());
    /* up to 96 particles are all compared, of more every second one, and so on */
    static const struct {
        size_t n, i;
        bool seen;
    } rows[] = {{96, 0, true},    {96, 1, true},   {96, 95, true},  {97, 1, false},
                {97, 2, true},    {97, 96, true},  {193, 1, false}, {193, 192, true},
                {194, 2, false},  {194, 3, true},  {970, 9, false}, {970, 11, true},
                {970, 968, true}, {970, 1, false}, {970, 0, true}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        make(2, false, rows[k].n);
        even = true;
        x[1][rows[k].i] = boost[1] * now + 0.46875; /* away from the other particles */
        mark[0] = x[0][rows[k].i] - boost[0] * now, mark[1] = 0.46875;
        memset(off, 0, sizeof off);
        off[0] = 1;
        assert_int_equal(has_a_curve(), !rows[k].seen);
    }
}
