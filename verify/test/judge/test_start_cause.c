/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the sentences with which `judge` describes wrong particles: their number, positions and
 * values. The faults are planted here. (The transcripts test whole snapshots.) */
#include "test.h"

#include "start_gas.h"

enum { N = 20 };

static struct problem kind;
static struct prepared problem = {.problem = &kind, .gamma = 1.4};
static double x[N][3], v[3][N], m[N], rho[N], u[N], P[N];
static struct problem_state exact[N];
static unsigned wrong[N];
static struct snapshot snapshot = {.n = N, .m = m, .rho = rho, .u = u, .P = P};
static struct start_gas gas = {
    .problem = &problem, .snapshot = &snapshot, .exact = exact, .x = x, .wrong = wrong};

/* Makes distinct states of this speed, and particles that have them. */
static void plant(int dim, double speed)
{
    problem.domain.dim = dim;
    gas.speed = speed, gas.volume = 0.25, gas.mass = 0.3, gas.gases = 0;
    for (int i = 0; i < N; i++) {
        exact[i] = (struct problem_state){1 + 0.037 * i, {0}, 2 - 0.051 * i, 0};
        exact[i].u = exact[i].P / (0.4 * exact[i].rho);
        for (int d = 0; d < 3; d++) {
            snapshot.v[d] = v[d];
            x[i][d] = i + 0.1 * d;
            exact[i].v[d] =
                d < dim ? speed * (0.3 + 0.1 * ((i * (3 + d)) % 7)) * (d == 1 ? -1 : 1) : 0;
            v[d][i] = exact[i].v[d];
        }
        m[i] = exact[i].rho * gas.volume, rho[i] = exact[i].rho, u[i] = exact[i].u,
        P[i] = exact[i].P;
        wrong[i] = 0;
    }
}

TEST(shares)
{
    static const struct {
        size_t part, n;
        const char *words;
    } rows[] = {{20, 20, "all"},          {1, 20, "one"},         {1, 1, "one"},
                {3, 4, "three quarters"}, {2, 3, "two thirds"},   {1000, 2000, "half"},
                {2, 6, "a third"},        {25, 100, "a quarter"}, {2, 10, "a fifth"},
                {2, 16, "an eighth"},     {2, 20, "a tenth"},     {103, 1000, "a tenth"},
                {971, 10000, "a tenth"},  {1031, 10000, "10 %"},  {969, 10000, "9.7 %"},
                {4, 10, "40 %"},          {19, 20, "95 %"},       {3, 1000, "0.3 %"}};
    char text[64];
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        start_share(rows[k].part, rows[k].n, text, sizeof text);
        assert_string_equal(text, rows[k].words);
    }
}

/* `map` has a character for each particle along x, # if wrong; words are not about y or r. */
TEST(regions_along_x)
{
    static const struct {
        const char *map, *words;
        int dim;
        bool circular;
    } rows[] = {
        {"########------------", ", at x < 7.5", 1, false},
        {"--------############", ", at x > 7.5", 1, false},
        {"----####------------", ", at 3.5 < x < 7.5", 1, false},
        {"-------------------#", ", at x = 19", 1, false},
        {"#-------------------", ", at x = 0", 1, false},
        {"-----#--------------", ", at x = 5", 1, false},
        {"-----#--------------", ", at x = 5", 3, true},
        {"####################", "", 1, false},
        {"-#-#-#-#-#-#-#-#-#-#", ", each second in the file", 1, false},
        {"#-#-#-#-#-#-#-#-#-#-", ", each second in the file", 1, false},
        {"--#--#--#--#--#--#--", ", each third in the file", 1, false},
        {"---#---#---#---#---#", ", each 4th in the file", 1, false},
        {"-#-#-#-#-#-#-#-#-#--", ", scattered over the box", 1, false},
        {"#------------------#", ", each 19th in the file", 1, false},
        {"##----------------##", ", scattered over the box", 1, false},
        {"-#--#---------------", ", scattered over the box", 1, false},
        {"----####------------", ", at 3.5 < x < 7.5", 3, true},
    };
    char text[128];
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        plant(rows[k].dim, 1);
        kind.circular = rows[k].circular;
        for (int i = 0; i < N; i++) /* all energies are wrong, too, but do not matter here */
            wrong[i] = (rows[k].map[i] == '#' ? 1u << START_MASS : 0) | 1u << START_ENERGY;
        start_where(&gas, 1u << START_MASS, text, sizeof text);
        if (strcmp(text, rows[k].words) != 0) fail_msg("%s: '%s'", rows[k].map, text);
    }
}

/* Positions along y, z and the radius, and by row number alone. */
TEST(regions_along_other_directions)
{
    static const struct {
        int dim;
        bool circular;
        const char *words;
    } rows[] = {{2, false, ", at y < 7.5"},
                {3, false, ", at z > 7.5"},
                {2, true, ", at r < 7.5"},
                {2, false, ", at 3.5 < row < 11.5"},
                {1, false, ", scattered over the box"},
                {1, false, ", scattered over the box"}};
    char text[128];
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        plant(rows[k].dim, 1);
        kind.circular = rows[k].circular;
        for (int i = 0; i < N; i++) {
            const int turn = 7 * i % N;
            x[i][0] = k == 2 ? 0 : turn, x[i][1] = k == 0 || k == 2 ? i : turn;
            x[i][2] = i;
            if (k == 2) /* in four directions alternately */
                x[i][0] = i % 2 ? 0 : i % 4 ? -i : i, x[i][1] = i % 2 ? i % 4 == 1 ? i : -i : 0;
            const bool right[] = {i >= 8, i < 8, i >= 8, i < 4 || i > 11, i < 4, i < N - 2};
            wrong[i] = !right[k];
        }
        start_where(&gas, 1, text, sizeof text);
        if (strcmp(text, rows[k].words) != 0) fail_msg("row %zu: '%s'", k, text);
    }
    kind.circular = false;
}

static void cause_is(const char *of, enum start_field field, int dim, const char *words)
{
    char text[256] = "";
    for (int i = 0; i < N; i++) wrong[i] |= i % 3 ? 1u << field : 0;
    const bool found = start_cause(&gas, field, text, sizeof text);
    if (found != (*words != '\0') || (found && strcmp(text, words) != 0))
        fail_msg("%s in %dD: '%s'", of, dim, text);
}

/* Every third particle is right. */
TEST(velocities)
{
    static const struct {
        const char *of;
        int least;         /* least dimension */
        const char *words; /* "": no cause is found */
    } rows[] = {{"rest", 1, "it is 0"},
                {"mirror", 1, "it has the other sign"},
                {"double", 1, "it is 2 times the case's"},
                {"nearly mirror", 1, "it is -1.002 times the case's"},
                {"nearer mirror", 1, "it is -0.998 times the case's"},
                {"momentum", 1, "it is rho v, a momentum"},
                {"odd", 1, ""},
                {"no vx", 2, ""},
                {"xy", 2, "x and y are exchanged"},
                {"xz", 3, "x and z are exchanged"},
                {"yz", 3, "y and z are exchanged"}};
    static const char *const more[] = {"it is the case's and 0.5", "it is the case's and 0.5, 0.25",
                                       "it is the case's and 0.5, 0.25, 0.125"};
    const double speeds[] = {1, 1e-4};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int dim = rows[k].least; dim <= 3; dim++)
            for (size_t s = 0; s < 2; s++) {
                plant(dim, speeds[s]);
                for (int i = 0; i < N; i++) {
                    const double *w = exact[i].v;
                    if (i % 3 == 0) continue;
                    for (int d = 0; d < dim; d++)
                        v[d][i] = k == 0   ? 0
                                  : k == 1 ? -w[d]
                                  : k == 2 ? 2 * w[d]
                                  : k == 3 ? -1.002 * w[d]
                                  : k == 4 ? -0.998 * w[d]
                                  : k == 5 ? w[d] * exact[i].rho
                                  : k == 6 ? w[d] * (1 + 0.1 * i)
                                  : k == 7 ? (d ? w[d] : 0)
                                  : k == 8 ? w[d == 0   ? 1
                                               : d == 1 ? 0
                                                        : 2]
                                  : k == 9 ? w[2 - d]
                                           : w[d ? 3 - d : 0];
                }
                cause_is(rows[k].of, START_VELOCITY, dim, rows[k].words);
            }
    for (int dim = 1; dim <= 3; dim++) {
        plant(dim, 1);
        for (int i = 0; i < N; i++)
            for (int d = 0; d < dim; d++) v[d][i] += i % 3 ? ldexp(0.5, -d) : 0;
        cause_is("a sum", START_VELOCITY, dim, more[dim - 1]);
    }
}

TEST(scalars)
{
    static const struct {
        const char *of;
        enum start_field field;
        const char *words;
    } rows[] = {{"P", START_ENERGY, "it is the pressure"},
                {"P/rho", START_ENERGY, "it is P/rho, a temperature"},
                {"P/rho^gamma", START_ENERGY, "it is P/rho^gamma, an entropy"},
                {"rho u", START_ENERGY, "it is rho u, the energy of a volume"},
                {"u + v^2/2", START_ENERGY, "it is the total energy, u + v^2/2"},
                {"3 rho", START_ENERGY, "it is the mass, or another multiple of the density"},
                {"1.25 u", START_ENERGY, "it is 1.25 times the case's"},
                {"0", START_ENERGY, "it is 0 times the case's"},
                {"u + 0.5", START_ENERGY, "it is 0.5 more than the case's"},
                {"u - 0.5", START_ENERGY, "it is 0.5 less than the case's"},
                {"odd", START_ENERGY, ""},
                {"rho", START_MASS, "it is the density"},
                {"u", START_MASS, "it is the internal energy"},
                {"1.25 m", START_MASS, "it is 1.25 times the case's"},
                {"m + 0.5", START_MASS, "it is 0.5 more than the case's"},
                {"odd", START_MASS, ""},
                {"1.25 P", START_PRESSURE, "it is 1.25 times (gamma - 1) rho u"},
                {"P + 0.5", START_PRESSURE, "it is 0.5 more than (gamma - 1) rho u"}};
    for (int k = 0; k < 3 * (int)(sizeof rows / sizeof *rows); k++) {
        const int row = k / 3, dim = 1 + k % 3;
        plant(dim, 1);
        for (int i = 0; i < N; i++) {
            const struct problem_state *e = &exact[i];
            const double values[] = {
                e->P,
                e->P / e->rho,
                e->P / pow(e->rho, 1.4),
                e->rho * e->u,
                e->u + 0.5 * (e->v[0] * e->v[0] + e->v[1] * e->v[1] + e->v[2] * e->v[2]),
                3 * e->rho,
                1.25 * e->u,
                0,
                e->u + 0.5,
                e->u - 0.5,
                e->u * (1 + 0.1 * i),
                e->rho,
                e->u,
                1.25 * m[i],
                m[i] + 0.5,
                m[i] * (1 + 0.1 * i),
                1.25 * P[i],
                P[i] + 0.5};
            double *of[START_FIELDS] = {NULL, u, m, P};
            if (i % 3) of[rows[row].field][i] = values[row];
        }
        cause_is(rows[row].of, rows[row].field, dim, rows[row].words);
    }
}

/* A factor is that of the wrong particles, be it a single one at either end of the file. */
TEST(factor_of_one_particle)
{
    for (int field = START_VELOCITY; field < START_FIELDS; field++)
        for (int end = 0; end < 2; end++) {
            char text[200] = "";
            const int i = end ? N - 1 : 0;
            plant(1, 1);
            v[0][i] *= 9.5, u[i] *= 9.5, m[i] *= 9.5, P[i] = 9.5 * 0.4 * rho[i] * exact[i].u;
            if (field == START_PRESSURE) u[i] = exact[i].u;
            wrong[i] = 1u << field;
            assert_true(start_cause(&gas, (enum start_field)field, text, sizeof text));
            assert_string_equal(text, field == START_PRESSURE ? "it is 9.5 times (gamma - 1) rho u"
                                                              : "it is 9.5 times the case's");
        }
}

/* One wrong value of cold gas, whose right value is 0, shows no sum or multiple, which two do. */
TEST(values_of_cold_gas)
{
    for (int count = 1; count <= 2; count++)
        for (int pressure = 0; pressure < 2; pressure++)
            for (int even = 0; even < 2; even++) {
                const enum start_field field = pressure ? START_PRESSURE : START_ENERGY;
                char text[200] = "";
                plant(1, 1);
                for (int i = 3; i < 3 + count; i++) {
                    exact[i].u = exact[i].P = u[i] = 0;
                    (pressure ? P : u)[i] = even ? 0.5 : 3 * exact[i].rho;
                    wrong[i] = 1u << field;
                }
                start_cause(&gas, field, text, sizeof text);
                assert_string_equal(text, count < 2  ? ""
                                          : even     ? pressure
                                                           ? "it is 0.5 more than (gamma - 1) rho u"
                                                           : "it is 0.5 more than the case's"
                                          : pressure ? ""
                                                     : "it is the mass, or another multiple of "
                                                       "the density");
            }
}

/* Where the density is 1 within a thousandth, both rho u and a constant factor may fit u: the
 * better fit is named, and rho u if both fit. */
TEST(nearest_cause)
{
    for (int k = 0; k < 3; k++) {
        plant(2, 1);
        for (int i = 0; i < N; i++) {
            exact[i].rho = k == 2 ? 1.25 : 1 + 5e-5 * (i % 5);
            wrong[i] = 1u << START_ENERGY;
            u[i] = exact[i].u * (k == 0 ? 1.0005 : exact[i].rho);
        }
        cause_is("near rho u", START_ENERGY, 2,
                 k ? "it is rho u, the energy of a volume" : "it is 1.0005 times the case's");
    }
}

/* A constant difference is named, too, if it is only 1.5e-5 of the largest values. */
TEST(small_sum_of_large_values)
{
    plant(1, 1);
    for (int i = 0; i < N; i++) {
        exact[i].u = i % 2 ? 1 : 4096;
        wrong[i] = 1u << START_ENERGY;
        u[i] = exact[i].u + 0.0625;
    }
    cause_is("a small sum", START_ENERGY, 1, "it is 0.0625 more than the case's");
}

/* One of 20 wrong particles may be an exception, and not two; the factor of velocities, a
 * least-squares fit, allows none. */
TEST(exceptions_from_a_cause)
{
    for (int otherwise = 0; otherwise <= 2; otherwise++) {
        for (int field = START_VELOCITY; field <= START_ENERGY; field++)
            for (int sum = 0; sum <= 1; sum++) {
                plant(1, 1);
                for (int i = 0; i < N; i++) {
                    double *value = field == START_ENERGY ? &u[i] : &v[0][i];
                    *value = i / 2 == 5 && i % 2 < otherwise ? 9 + i
                             : sum                           ? *value + 0.5
                                                             : 1.25 * *value;
                    wrong[i] = 1u << field;
                }
                cause_is("most", (enum start_field)field, 1,
                         otherwise == 2 || (field == START_VELOCITY && !sum && otherwise) ? ""
                         : !sum                    ? "it is 1.25 times the case's"
                         : field == START_VELOCITY ? "it is the case's and 0.5"
                                                   : "it is 0.5 more than the case's");
            }
    }
}

/* In gas of two densities the message gives both masses; in gas of any other density, density times
 * volume. */
TEST(masses)
{
    plant(1, 1);
    gas.gases = 2;
    gas.of[0].rho = 1, gas.of[0].mass = 7;
    gas.of[1].rho = 3, gas.of[1].mass = 5;
    assert_true(start_mass(&gas, 1) == 7 && start_mass(&gas, 3) == 5);
    assert_true(start_mass(&gas, 3 * (1 + 0.9e-9)) == 5 && start_mass(&gas, 2) == 0.5);
    near_relative(start_mass(&gas, 3 * (1 + 1.1e-9)), 0.75, 1e-8);
    gas.volume = 0;
    assert_true(start_mass(&gas, 2) == 0.3);
    assert_true(start_relative(3, 2) == 0.5 && start_relative(1, 2) == 0.5);
    assert_true(start_relative(1e-300, 0) == 1 && start_relative(0, 0) == 0);
}

TEST(differences)
{
    near_relative(start_apart((double[]){1, 6, 11}, (double[]){3, 9, 5}), 7, 1e-15);
    for (int dim = 1; dim <= 3; dim++) {
        plant(dim, 2);
        for (int d = 0; d < 3; d++) v[d][4] += d == 0 ? 2 : d == 1 ? 3 : 6;
        u[4] *= 1.25, m[4] *= 0.75, P[4] = 3 * 0.4 * rho[4] * u[4];
        near_relative(start_off(&gas, START_VELOCITY, 4, &exact[4]),
                      sqrt(dim == 1   ? 4
                           : dim == 2 ? 13
                                      : 49) /
                          2,
                      1e-14);
        near_relative(start_off(&gas, START_ENERGY, 4, &exact[4]), 0.25, 1e-13);
        near_relative(start_off(&gas, START_MASS, 4, &exact[4]), 0.25, 1e-13);
        near_relative(start_off(&gas, START_PRESSURE, 4, &exact[4]), 2, 1e-13);
        for (int field = 0; field < START_FIELDS; field++)
            near_below(start_off(&gas, (enum start_field)field, 5, &exact[5]), 1e-15);
    }
}

/* Random differences of 5e-4 are wrong, but no rule describes them, not even "1 times". */
TEST(noise_has_no_cause)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int field = 0; field < START_FIELDS; field++) {
            plant(dim, 1);
            for (int i = 0; i < N; i++) {
                const double times = 1 + (i % 3 == 1 ? 5e-4 : -5e-4);
                for (int d = 0; d < dim; d++) v[d][i] *= times;
                m[i] *= times, u[i] *= times, P[i] *= times * times * times;
            }
            cause_is("noise", (enum start_field)field, dim, "");
        }
}

enum { MANY = 191 }; /* every second one of them fills a trial */

/* One particle in 50 within a range of wrong ones may be right. */
TEST(exceptions_from_a_region)
{
    static const struct {
        int end, right; /* the range from 10 on, and how many in it are right */
        const char *words;
    } rows[] = {{170, 3, ", at 9.5 < x < 169.5"}, {170, 4, ", scattered over the box"},
                {60, 1, ", at 9.5 < x < 59.5"},   {59, 1, ", scattered over the box"},
                {110, 2, ", at 9.5 < x < 109.5"}, {109, 2, ", scattered over the box"}};
    static double many_x[MANY][3];
    static unsigned off[MANY];
    const struct snapshot particles = {.n = MANY};
    const struct start_gas many = {
        .problem = &problem, .snapshot = &particles, .x = many_x, .wrong = off};
    problem.domain.dim = 1;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char text[128];
        for (int i = 0; i < MANY; i++) {
            many_x[i][0] = i;
            off[i] = i >= 10 && i < rows[k].end && (i % 30 || i / 30 > rows[k].right);
        }
        start_where(&many, 1, text, sizeof text);
        assert_string_equal(text, rows[k].words);
    }
}

/* ---- states of other positions ---- */

/* A flow without any symmetry but that of its box, whose sides differ. In 1D and 2D it
 * has several waves along the last axis, so that a shift is found only from a start that is near.
 */
static void wave(const struct prepared *p, const double at[3], double t,
                 struct problem_state *state)
{
    const int waves = p->domain.dim == 1 ? 40 : p->domain.dim == 2 ? 5 : 1;
    double a[3] = {0};
    (void)t;
    if (p->domain.dim == 1) /* x and y exchanged may be beyond the box */
        assert_true(at[0] > p->domain.lo[0] - 1e-9 && at[0] < p->domain.hi[0] + 1e-9);
    for (int d = 0; d < p->domain.dim; d++)
        a[d] = 2 * M_PI * (at[d] - p->domain.lo[d]) / domain_length(&p->domain, d);
    *state = (struct problem_state){.rho = 1, .P = 1};
    state->u = 4 + sin(a[0] + 0.5) + 0.7 * cos(a[1] + 0.3) + 0.4 * sin(a[2] + 0.1);
    for (int d = 0; d < p->domain.dim; d++)
        state->v[d] = sin(a[0] + d) + 0.2 * cos(a[1] + d) +
                      0.5 * cos(waves * a[p->domain.dim > 1] + 2 * d) + 0.3 * sin(a[2] + 0.7 * d);
}

static double no_energy(const struct prepared *p, double r, double t)
{
    (void)p, (void)r, (void)t;
    return 1;
}

/* Particles that have the states of other positions: with x and y exchanged, mirrored, or shifted;
 * one in 20 may be an exception. The box is large, since steps of the search are shares of it. */
TEST(positions)
{
    static double far[MANY][3], fast[3][MANY], energy[MANY], ones[MANY];
    static struct problem_state there[MANY];
    static unsigned off[MANY];
    static const struct problem flow = {.sample = wave};
    static struct problem energetic = {.sample = wave, .mean_energy = no_energy};
    static const struct {
        int least;      /* number of dimensions */
        int turn;       /* -1: x and y are exchanged; 1 to 3: this axis is mirrored */
        double by[3];   /* a shift */
        int each, odd;  /* each so many particles are right, 0: none; so many are exceptions */
        bool energetic; /* energies are those of a mean, which is not known */
        const char *words;
    } rows[] = {{2, -1, {0}, 0, 0, false, "x and y of their places are exchanged"},
                {2, -1, {0}, 0, 9, false, "x and y of their places are exchanged"},
                {2, -1, {0}, 0, 10, false, ""},
                {1, 1, {0}, 0, 0, false, "x of their places is mirrored"},
                {1, 1, {0}, 0, 9, false, "x of their places is mirrored"},
                {1, 1, {0}, 0, 10, false, ""},
                {2, 2, {0}, 3, 0, false, "y of their places is mirrored"},
                {3, 3, {0}, 0, 0, false, "z of their places is mirrored"},
                {1, 0, {24, -16, 8}, 0, 0, false, "all particles of the file are shifted by"},
                {1, 0, {-52, 36, -16}, 0, 8, false, "all particles of the file are shifted by"},
                {1, 0, {24, 0, 0}, 0, 0, false, "all particles of the file are shifted by"},
                {2, 0, {24, 0.016, 8}, 0, 0, false, "all particles of the file are shifted by"},
                {1, 0, {24, -16, 8}, 2, 0, false, "they are shifted by"},
                {1, 0, {24, -16, 8}, 3, 0, false, "they are shifted by"},
                {1, 0, {24, -16, 8}, 0, 0, true, "all particles of the file are shifted by"},
                {1, 0, {24, -16, 8}, 0, 30, false, ""},
                {1, 0, {0}, 0, 0, false, ""}, /* noise alone */
                {1, 0, {0}, 0, 0, true, ""}}; /* nothing that positions explain */
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int dim = rows[k].least; dim <= 3; dim++) {
            struct prepared box = {
                .problem = rows[k].energetic ? &energetic : &flow,
                .gamma = 1.4,
                .domain = {.dim = dim, .lo = {-64, 32, 128}, .hi = {64, 128, 192}}};
            const struct snapshot particles = {.n = MANY,
                                               .v = {fast[0], fast[1], fast[2]},
                                               .u = energy,
                                               .m = ones,
                                               .rho = ones,
                                               .P = ones};
            const struct start_gas many = {.problem = &box,
                                           .snapshot = &particles,
                                           .exact = there,
                                           .x = far,
                                           .wrong = off,
                                           .speed = 1};
            char text[200] = "", words[200];
            unsigned random = 5;
            int count = 0;
            for (int i = 0; i < MANY; i++) {
                struct problem_state got;
                double from[3];
                for (int d = 0; d < 3; d++) {
                    random = random * 1664525u + 1013904223u;
                    far[i][d] = box.domain.lo[d] +
                                domain_length(&box.domain, d) * (double)(random >> 8) / (1 << 24);
                    from[d] = far[i][d];
                }
                wave(&box, far[i], 0, &there[i]);
                const bool right = rows[k].each && i % rows[k].each == 0;
                for (int d = 0; d < 3 && !right; d++) {
                    if (rows[k].turn < 0) from[d] = far[i][d == 0 ? 1 : d == 1 ? 0 : 2];
                    if (rows[k].turn == d + 1)
                        from[d] = box.domain.lo[d] + box.domain.hi[d] - far[i][d];
                    const double length = domain_length(&box.domain, d);
                    from[d] -= rows[k].by[d];
                    from[d] -= length * floor((from[d] - box.domain.lo[d]) / length);
                }
                wave(&box, from, 0, &got);
                off[i] = right ? 0 : 1u << START_VELOCITY | 1u << START_ENERGY;
                const bool odd = !right && count < rows[k].odd;
                count += !right;
                const double noise = *rows[k].words || rows[k].odd || rows[k].energetic ? 0
                                     : i % 2                                            ? 5e-4
                                                                                        : -5e-4;
                for (int d = 0; d < 3; d++) fast[d][i] = got.v[d] + (odd ? 7 + i % 5 : noise);
                energy[i] = rows[k].energetic ? 50 + i : got.u;
                ones[i] = 1;
            }
            const bool found = start_cause_positions(&many, text, sizeof text);
            snprintf(words, sizeof words, "%s", rows[k].words);
            for (int d = 0; d < dim && strstr(words, "shifted"); d++)
                snprintf(words + strlen(words), sizeof words - strlen(words), "%s%g",
                         d ? ", " : " ", rows[k].by[d]);
            if (found != (*words != '\0') || strcmp(text, words) != 0)
                fail_msg("row %zu in %dD: '%s', not '%s'", k, dim, text, words);
        }
}
