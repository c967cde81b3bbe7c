/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests problems of gas at rest, sheared or rotating: which boxes and gases they accept, their
 * samples and particles, and what is measured on states made by hand. (The check `exact flow` tests
 * that the solutions are exact.) */
#include "test.h"

#include "drawn_cloud.h"
#include "kelvin_helmholtz.h"
#include "lattice.h"
#include "vortex.h"

/* Position relative to the middle of the box, and velocity, of particle i without the boost. */
static void at_rest(const struct cloud *cloud, const struct prepared *p, int i, double x[3],
                    double v[3])
{
    for (int d = 0; d < 3; d++) {
        const double length = domain_length(&p->domain, d);
        x[d] = v[d] = 0;
        if (d >= p->domain.dim) continue;
        x[d] = cloud->x[d][i] - p->boost[d] * cloud->snapshot.time -
               0.5 * (p->domain.lo[d] + p->domain.hi[d]);
        x[d] -= length * round(x[d] / length);
        v[d] = cloud->v[d][i] - p->boost[d];
    }
}

static struct problem_state state_at(const struct prepared *p, double x, double y, double z,
                                     double t)
{
    struct problem_state state;
    p->problem->sample(p, (double[3]){x, y, z}, t, &state);
    return state;
}

/* ---- vortices ---- */

TEST(vortices_turn_round_the_middle)
{
    static const char *const names[] = {"gresho", "yee"};
    for (int k = 0; k < 2; k++) {
        char keys[64];
        struct settings s;
        snprintf(keys, sizeof keys, "kind=%s|lo=-1 2|hi=2 4|gamma=1.6", names[k]);
        const struct prepared p = prepared_of(&s, 2, keys);
        for (int i = 0; i <= 40; i++) {
            const double R = 0.02 * i, x = 0.5 + 0.6 * R, y = 3 + 0.8 * R;
            const double r = hypot(x - 0.5, y - 3);
            const struct vortex_state want = k ? vortex_yee(r, 5, 1.6) : vortex_gresho(r);
            const struct problem_state have = state_at(&p, x, y, 7, 0.3);
            assert_true(have.rho == want.rho && have.P == want.P && have.v[2] == 0);
            near_relative(have.u, want.P / (0.6 * want.rho), 1e-14);
            if (i == 0 || want.v == 0) {
                assert_true(have.v[0] == 0 && have.v[1] == 0);
                continue;
            }
            near_relative(have.v[0], -0.8 * want.v, 1e-12);
            near_relative(have.v[1], 0.6 * want.v, 1e-12);
        }
    }
    struct settings s;
    prepared_of(&s, 2, "kind=gresho|lo=0|hi=0.8"); /* an exact fit */
    prepared_of(&s, 2, "kind=yee|gamma=100");
    prepared_refused(2, "kind=gresho|lo=0|hi=0.7999999 1",
                     "lo=0 hi=0.8: the vortex has a diameter of 0.8 and does not fit");
    prepared_refused(2, "kind=gresho|lo=0 -2|hi=1 -1.5", "lo=-2 hi=-1.5: the vortex");
}

TEST(vortex_is_measured)
{
    struct settings s;
    struct cloud cloud;
    const struct prepared p =
        prepared_of(&s, 2, "kind=gresho|lo=-0.5 1.5|hi=1.5 3.5|boost=0.5 -0.25");
    scatter(&cloud, &p, 0.7);
    /* the particle after the last turns around the middle, and is the fastest */
    cloud.v[0][N] = 50 * (p.window.centre[1] - cloud.x[1][N]);
    cloud.v[1][N] = 50 * (cloud.x[0][N] - p.window.centre[0]);
    double sum = 0, peak = 0;
    int n = 0;
    for (int i = 0; i < N; i++) {
        double x[3], v[3];
        at_rest(&cloud, &p, i, x, v);
        const double R = hypot(x[0], x[1]), along = (x[0] * v[1] - x[1] * v[0]) / R;
        peak = fmax(peak, along);
        if (R >= 0.5) continue;
        sum += fabs(along - vortex_gresho(R).v);
        n++;
    }
    assert_true(n > 5 && n < N - 5);
    near_relative(measured(&p, "disc_error", &cloud.snapshot), sum / n, 1e-12);
    near_relative(measured(&p, "peak_velocity", &cloud.snapshot), peak, 1e-12);
    assert_true(exactly(&p, "disc_error", 1) == 0 && exactly(&p, "peak_velocity", 1) == 1);
    /* two particles, the second on the edge, R = 1/2, which is outside; both turn backwards */
    const struct prepared still = prepared_of(&s, 2, "kind=gresho|lo=-1|hi=1");
    const double x[] = {0.25, 0.5}, y[] = {0, 0}, v[] = {0, 0}, w[] = {-0.5, -2};
    const struct snapshot two = {.n = 2, .x = {x, y}, .v = {v, w}};
    near_relative(measured(&still, "disc_error", &two), 0.5 + 0.75, 1e-14);
    assert_true(measured(&still, "peak_velocity", &two) == 0);
    const double up[] = {0.75, 0.25};
    const struct snapshot first = {.n = 2, .x = {x, y}, .v = {v, up}};
    assert_true(measured(&still, "peak_velocity", &first) == 0.75);
}

/* ---- the layers of McNally, Lyra & Passy ---- */

TEST(layers_fill_a_square)
{
    struct settings s;
    const struct prepared p =
        prepared_of(&s, 2, "kind=kelvin_helmholtz|lo=-1 2|hi=1 4|gamma=1.6|boost=0.5 0.75");
    for (int i = 0; i < 20; i++) {
        const double x = 0.013 + 0.047 * i, y = 0.02 + 0.05 * i;
        const struct kelvin_helmholtz_state want = kelvin_helmholtz_start(x, y);
        const struct problem_state have = state_at(&p, -1 + 2 * x, 2 + 2 * y, 7, 0.3);
        near_relative(have.rho, want.rho, 1e-13);
        near_relative(have.v[0], want.v[0], 1e-12);
        near_absolute(have.v[1] - want.v[1], 0, 1e-15);
        assert_true(have.P == want.P && have.v[2] == 0);
        near_relative(have.u, want.P / (0.6 * want.rho), 1e-13);
    }
    /* sides that differ by rounding count as equal */
    for (int part = -3; part <= 3; part += 2) {
        struct prepared q;
        struct error error;
        char keys[128];
        snprintf(keys, sizeof keys, "kind=kelvin_helmholtz|lo=0|hi=2 %.17g",
                 2 + 2 * 0.5e-12 * part);
        assert_int_equal(prepared_try(&q, &s, 2, keys, &error),
                         abs(part) > 1 ? STATUS_BAD_INPUT : STATUS_OK);
    }
    /* sides that differ by exactly 1e-12 of a side, as few doubles do */
    prepared_of(&s, 2, "kind=kelvin_helmholtz|lo=0|hi=1.000088900582341 1.000088900583341");
    prepared_refused(2, "kind=kelvin_helmholtz|lo=0|hi=2 2.5",
                     "the layers lie in a square box, and this one has sides of 2 and 2.5");

    struct cloud cloud;
    scatter(&cloud, &p, 0.3);
    double sine = 0, cosine = 0, weight = 0;
    for (int i = 0; i < N; i++) {
        double at[3], v[3];
        at_rest(&cloud, &p, i, at, v);
        const double x = at[0] / 2 + 0.5, y = at[1] / 2 + 0.5;
        const double E = cloud.volume[i] * exp(-4 * M_PI * fmin(fabs(y - 0.25), fabs(y - 0.75)));
        sine += v[1] * sin(4 * M_PI * x) * E;
        cosine += v[1] * cos(4 * M_PI * x) * E;
        weight += E;
    }
    near_relative(measured(&p, "mode_amplitude", &cloud.snapshot),
                  2 * sqrt(sine * sine + cosine * cosine) / weight, 1e-12);
    struct snapshot vast = cloud.snapshot;
    vast.n = (size_t)1 << 50; /* too large to be copied */
    assert_true(isnan(measured(&p, "mode_amplitude", &vast)));

    /* the side along x is the unit of length */
    const struct prepared long_side = prepared_of(
        &s, 2, "kind=kelvin_helmholtz|lo=0|hi=2 2.0000000000019|gamma=1.6666666666666667");
    assert_true(exactly(&long_side, "mode_amplitude", 2.4) == kelvin_helmholtz_reference(1.2));
    static const struct {
        const char *gamma;
        bool known;
    } rows[] = {{"1.6666666666666667", true},
                {"1.6666676", true},
                {"1.6666657", true},
                {"1.6666678", false},
                {"1.6666655", false}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char keys[128];
        snprintf(keys, sizeof keys, "kind=kelvin_helmholtz|lo=0|hi=2|gamma=%s", rows[k].gamma);
        const struct prepared q = prepared_of(&s, 2, keys);
        if (rows[k].known) /* twice the side, twice the time */
            near_relative(exactly(&q, "mode_amplitude", 2.4), kelvin_helmholtz_reference(1.2),
                          1e-13);
        else
            assert_true(isnan(exactly(&q, "mode_amplitude", 2.4)));
    }
}

/* ---- shear ---- */

TEST(layers_slide_past_each_other)
{
    static const struct {
        int dim;
        const char *keys;
        double n[3], flow[3], length; /* directions of the change and of v; wave length */
    } rows[] = {
        {2, "", {1, 0}, {0, 1}, 2},
        {2, "|direction=0 -1", {0, -1}, {1, 0}, 2},
        {2, "|hi=2 1|direction=2 1|boost=0.5 0.25", {0.8, 0.6}, {-0.6, 0.8}, 1.2},
        {3, "|direction=0 0 1|boost=0 0 1", {0, 0, 1}, {1, 0, 0}, 2},
        {3, "|direction=1 0 0", {1, 0, 0}, {0, 1, 0}, 2},
        {3,
         "|direction=1 1 1",
         {0.5773502691896258, 0.5773502691896258, 0.5773502691896258},
         {-M_SQRT1_2, M_SQRT1_2, 0},
         2 / 1.7320508075688772},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char keys[160];
        struct settings s;
        struct cloud cloud;
        snprintf(keys, sizeof keys, "kind=shear|lo=-1|background=1.3 0 0.7|gamma=1.6%s",
                 rows[k].keys);
        struct prepared p = prepared_of(&s, rows[k].dim, keys);
        memset(p.own.bytes, 0x5a, sizeof p.own.bytes); /* arbitrary bytes before */
        assert_int_equal(p.problem->prepare(&p, &s, NULL), STATUS_OK);
        scatter(&cloud, &p, 0.4);
        double along = 0, whole = 0;
        for (int i = 0; i < N; i++) {
            double x[3], v[3], phase = 0, speed = 0;
            at_rest(&cloud, &p, i, x, v);
            for (int d = 0; d < rows[k].dim; d++) { /* measured from the corner */
                phase += 2 * M_PI * rows[k].n[d] * (x[d] + 0.5 * domain_length(&p.domain, d)) /
                         rows[k].length;
                speed += v[d] * rows[k].flow[d];
            }
            along += cloud.volume[i] * speed * sin(phase);
            whole += 0.5 * cloud.volume[i] * sin(phase) * sin(phase);
            const double *middle = p.window.centre;
            const struct problem_state have =
                state_at(&p, middle[0] + x[0], middle[1] + x[1],
                         rows[k].dim > 2 ? middle[2] + x[2] : (double)NAN, 0.3);
            for (int d = 0; d < 3; d++)
                near_absolute(have.v[d] - 0.5 * sin(phase) * rows[k].flow[d], 0, 1e-14);
            assert_true(have.rho == 1.3 && have.P == 0.7);
            near_relative(have.u, 0.7 / (0.6 * 1.3), 1e-14);
        }
        if (!(along / whole > 0)) { /* so that its logarithm exists */
            along = -along;
            for (int d = 0; d < rows[k].dim; d++)
                for (int i = 0; i < N; i++)
                    cloud.v[d][i] = p.boost[d] - (cloud.v[d][i] - p.boost[d]);
        }
        near_relative(measured(&p, "shear_amplitude", &cloud.snapshot), along / whole, 1e-11);
        const double wave_number = 2 * M_PI / rows[k].length;
        near_relative(measured(&p, "shear_viscosity", &cloud.snapshot),
                      -log(along / whole) / (wave_number * wave_number * 0.4), 1e-11);
        assert_true(exactly(&p, "shear_amplitude", 1) == 1 &&
                    exactly(&p, "shear_viscosity", 1) == 0);
        cloud.snapshot.time = 0;
        assert_true(measured(&p, "shear_viscosity", &cloud.snapshot) == 0);
    }
    prepared_refused(
        2, "kind=shear|background=1 0.5 2",
        "background=\"1 0.5 2\": layers have a mean velocity of 0; `boost` moves them");
    prepared_refused(2, "kind=shear|background=0 0 1", "rho v P with rho > 0 and P > 0");
    prepared_refused(2, "kind=shear|direction=0 0", "the wave runs nowhere");
}

/* ---- gas at rest, and particles of a file ---- */

TEST(gas_at_rest)
{
    struct settings s;
    const struct prepared p = prepared_of(&s, 3, "kind=rest|background=1.3 0 0.7|gamma=1.6");
    const struct problem_state have = state_at(&p, 0.1, 0.2, 0.3, 0.4);
    assert_true(have.rho == 1.3 && have.P == 0.7);
    assert_true(have.v[0] == 0 && have.v[1] == 0 && have.v[2] == 0);
    near_relative(have.u, 0.7 / (0.6 * 1.3), 1e-14);
    prepared_refused(2, "kind=rest|background=1 0.5 2",
                     "background=\"1 0.5 2\": gas at rest has no velocity; `boost` moves it");
    prepared_refused(2, "kind=rest|background=1 0 0", "rho v P with rho > 0 and P > 0");
}

TEST(nothing_is_known_of_a_file)
{
    struct settings s;
    struct initial initial = {0};
    struct error error = {0};
    prepared_refused(2, "kind=particles",
                     "an initial state of kind particles needs a file of them, file = "
                     "PARTICLES.csv in [initial], or a shared object that knows the state at t = "
                     "0, reference = ./mine.so in [case]");
    const struct prepared p = prepared_of(&s, 1, "kind=particles|file=a");
    const struct problem_state have = state_at(&p, 0.1, 0.2, 0.3, 0.4);
    assert_true(isnan(have.rho) && isnan(have.P) && isnan(have.u));
    assert_true(isnan(have.v[0]) && isnan(have.v[1]) && isnan(have.v[2]));
    assert_false(settings_random_start(&s));
    assert_int_equal(p.problem->fill(&p, &s, &initial, &error), STATUS_BAD_INPUT);
    assert_string_equal(error.message, "particles: no particles but those of a file");
}

/* ---- the square ---- */

static const char square_keys[] = "kind=square|lo=-1 2 0|hi=3 4 8|gamma=1.6|contrast=5";

/* Equal spacing: a lattice of 4 by 4 cells or multiples, with no cell on both sides of an edge. */
TEST(squares_share_a_lattice)
{
    /* few particles, and numbers above and below one at which the lattice gains a row */
    static const int wanted[][3] = {{0}, {0}, {4, 968, 950}, {4, 1320, 1300}};
    for (int dim = 2; dim <= 3; dim++)
        for (int k = 0; k < 3; k++) {
            char keys[128];
            struct settings s;
            snprintf(keys, sizeof keys, "%s|n=%d",
                     dim == 3 ? square_keys : "kind=square|lo=-1 2|hi=3 4|gamma=1.6|contrast=5",
                     wanted[dim][k]);
            const struct prepared p = prepared_of(&s, dim, keys);
            const struct initial initial = prepared_filled(&p, &s);
            struct domain quarter = p.domain;
            struct lattice_plan plan;
            struct error error;
            double volume = 1, mass = 0, parts = 1;
            size_t n = 1;
            for (int d = 0; d < dim; d++) {
                quarter.hi[d] = quarter.lo[d] + 0.25 * domain_length(&quarter, d);
                volume *= domain_length(&p.domain, d);
                parts *= 4;
            }
            const double asked = fmax(1, round((wanted[dim][k]) / parts));
            assert_int_equal(lattice_plan_make(&plan, &quarter,
                                               dim == 2 ? LATTICE_SQUARE : LATTICE_CUBIC,
                                               (size_t)asked, &error),
                             0);
            for (int d = 0; d < dim; d++) n *= 4 * plan.cells[d];
            assert_true(initial.n == n && initial.dim == dim);
            for (size_t i = 0; i < n; i++) {
                size_t rest = i;
                for (int d = 0; d < dim; d++) {
                    const size_t cells = 4 * plan.cells[d];
                    near_absolute(initial.x[d][i] - p.domain.lo[d] -
                                      domain_length(&p.domain, d) * ((double)(rest % cells) + 0.5) /
                                          (double)cells,
                                  0, 1e-14);
                    rest /= cells;
                }
                near_relative(initial.m[i], initial.rho[i] * volume / (double)n, 1e-14);
                mass += initial.m[i];
            }
            /* the dense part is exactly 1/4 or 1/8 of the box */
            near_relative(mass, volume * (1 + 4 / (dim == 2 ? 4. : 8.)), 1e-12);
            free(initial.storage);
        }
}

/* Equal masses: each gas has a lattice of its own, and the thin gas's has no particles in the
 * square. */
TEST(squares_have_equal_masses)
{
    static const struct {
        int dim;
        const char *keys;
        double n;
    } rows[] = {{2, "kind=square|lo=-1 2|hi=3 4|contrast=5|equal_masses=yes|n=700", 700},
                {2, "kind=square|contrast=0.001|equal_masses=yes|n=60", 60},
                {2, "kind=square|contrast=1000|equal_masses=yes|n=60", 60},
                {3, "kind=square|lo=-1 2 0|hi=3 4 8|contrast=3|equal_masses=yes|n=900", 900}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct settings s;
        const struct prepared p = prepared_of(&s, rows[k].dim, rows[k].keys);
        const struct initial initial = prepared_filled(&p, &s);
        const double contrast = settings_real(&s, SETTING_contrast);
        struct domain boxes[2] = {p.domain, p.domain}; /* the square, and the whole box */
        double volume = 1, inner = 1;
        for (int d = 0; d < p.domain.dim; d++) {
            const double length = domain_length(&p.domain, d);
            boxes[0].lo[d] += 0.25 * length;
            boxes[0].hi[d] -= 0.25 * length;
            volume *= length;
            inner *= 0.5 * length;
        }
        const double all = contrast * inner + volume - inner,
                     shares[2] = {contrast * inner / all, volume / all},
                     masses[2] = {contrast * inner, volume - inner};
        size_t at = 0;
        for (int g = 0; g < 2; g++) {
            const size_t first = at;
            struct lattice_plan plan;
            struct error error;
            double *x[3];
            assert_int_equal(lattice_plan_make(&plan, &boxes[g],
                                               p.domain.dim == 2 ? LATTICE_SQUARE : LATTICE_CUBIC,
                                               (size_t)fmax(1, round(rows[k].n * shares[g])),
                                               &error),
                             0);
            for (int d = 0; d < 3; d++) x[d] = malloc(plan.n * sizeof(double));
            assert_int_equal(lattice_points(&plan, 1, x, &error), 0);
            for (size_t i = 0; i < plan.n; i++) {
                bool within = true;
                for (int d = 0; d < p.domain.dim; d++)
                    within &= x[d][i] >= boxes[0].lo[d] && x[d][i] < boxes[0].hi[d];
                if (g && within) continue;
                assert_true(at < initial.n);
                for (int d = 0; d < p.domain.dim; d++)
                    assert_true(initial.x[d][at] == x[d][i] && initial.v[d][at] == 0);
                assert_true(initial.rho[at] == (g ? 1 : contrast));
                near_relative(initial.u[at], 2.5 / ((p.gamma - 1) * initial.rho[at]), 1e-14);
                at++;
            }
            for (size_t i = first; i < at; i++)
                assert_true(initial.m[i] == masses[g] / (double)(at - first));
            for (int d = 0; d < 3; d++) free(x[d]);
        }
        assert_int_equal(at, initial.n);
        free(initial.storage);
    }
}

TEST(squares_that_cannot_be_laid_are_refused)
{
    /* fcc in 2D, too many particles for memory, too few particles of a gas for a glass */
    static const struct {
        const char *keys;
        double n;
        enum lattice lattice;
        enum status status;
    } rows[] = {
        {"kind=square", 100, LATTICE_FCC, STATUS_BAD_INPUT},
        {"kind=square", 0x1p53, LATTICE_SQUARE, STATUS_ENVIRONMENT},
        {"kind=square", 16, LATTICE_GLASS, STATUS_BAD_INPUT},
        {"kind=square|equal_masses=yes", 100, LATTICE_FCC, STATUS_BAD_INPUT},
        {"kind=square|equal_masses=yes", 0x1p53, LATTICE_SQUARE, STATUS_ENVIRONMENT},
        {"kind=square|equal_masses=yes|contrast=0.001", 60, LATTICE_GLASS, STATUS_BAD_INPUT},
        {"kind=square|equal_masses=yes|contrast=1000", 60, LATTICE_GLASS, STATUS_BAD_INPUT},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct settings s;
        struct initial initial = {0};
        struct error error = {0};
        const struct prepared p = prepared_of(&s, 2, rows[k].keys);
        s.value[SETTING_lattice].choice = (int)rows[k].lattice;
        s.value[SETTING_n].real[0] = rows[k].n;
        const enum status status = p.problem->fill(&p, &s, &initial, &error);
        if (status != rows[k].status)
            fail_msg("row %zu: status %d: %s", k, (int)status, error.message);
        free(initial.storage);
    }
}
