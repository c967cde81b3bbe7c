/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests `rates`: one evaluation in the order of the setup, and the comparison with another code's
 * rates, which reports differences and their likely causes. */
#include "test.h"

#include "oracle.h"
#include "rate_check.h"
#include "settings.h"

enum { MOST = 65, KEYS = 16 };

/* Distinct particles in no particular order. */
struct gas {
    double x[3][MOST], v[3][MOST], m[MOST], u[MOST];
    struct setup setup;
};

static struct gas gas; /* of the test */

static double noise(unsigned *random)
{
    *random = *random * 1664525u + 1013904223u;
    return (double)(*random >> 8) / (1 << 24);
}

/* The scheme of words such as "eta=2.4 beta=1"; gamma is a key as well. */
static void set_scheme(struct setup *setup, const char *words)
{
    char text[400], *rest = text, *keys[KEYS], *word;
    struct settings settings;
    struct error error;
    int n = 0;
    snprintf(text, sizeof text, "%s", words);
    while ((word = strtok_r(rest, " ", &rest)) && n < KEYS) keys[n++] = word;
    settings_init(&settings);
    settings.shared = true; /* scheme keys may have no effect */
    if (settings_apply(&settings, n, keys, &error) ||
        settings_scheme(&settings, setup->dim, &setup->scheme, &error))
        fail_msg("%s: %s", words, error.message);
    setup->gamma = settings_real(&settings, SETTING_gamma);
}

/* side^dim particles in the periodic unit box, displaced at random from a lattice. */
static void make(struct gas *made, int dim, size_t side, const char *words)
{
    unsigned random = 2385;
    size_t n = 1;
    for (int a = 0; a < dim; a++) n *= side;
    assert_true(n <= MOST);
    for (size_t k = 0; k < n; k++) {
        const size_t i = k * 5 % n; /* so that particles are not in the order of positions */
        size_t rest = k;
        for (int a = 0; a < 3; a++, rest /= side) {
            made->x[a][i] =
                ((double)(rest % side) + 0.5 + 0.3 * (noise(&random) - 0.5)) / (double)side;
            made->v[a][i] = noise(&random) - 0.5;
        }
        made->m[i] = (1 + 0.2 * noise(&random)) / (double)n;
        made->u[i] = 1 + 0.3 * noise(&random);
    }
    made->setup = (struct setup){.dim = dim,
                                 .hi = {1, 1, 1},
                                 .t_end = 1,
                                 .n = n,
                                 .x = {made->x[0], made->x[1], made->x[2]},
                                 .v = {made->v[0], made->v[1], made->v[2]},
                                 .m = made->m,
                                 .u = made->u,
                                 .threads = 1};
    set_scheme(&made->setup, words);
}

#define USUAL                                                                                      \
    "kernel=cubic_spline eta=2.4 viscosity=constant gradient=standard formulation=vanilla_ice "    \
    "volume_element=mass viscosity_form=mu alpha=1 beta=3 pair_width=mean balsara=off "            \
    "h_method=newton h_tolerance=1e-14 gamma=1.5"
#define SPACE USUAL " eta=1.7"
#define LINE                                                                                       \
    "kernel=cubic_spline eta=2.4 viscosity=constant gradient=standard alpha=1 beta=3 "             \
    "pair_width=mean h_method=newton h_tolerance=1e-14 gamma=1.5"

static const char *const schemes[] = {"", LINE, USUAL, SPACE};
static const size_t sides[] = {0, 32, 6, 4};

static struct rate_table table_of(const struct setup *setup)
{
    struct rate_table table;
    struct error error;
    if (rate_table_make(&table, setup, &error)) fail_msg("%s", error.message);
    return table;
}

/* ---- the table of rates ---- */

/* Rates are in the order of the setup, whatever the order of positions. */
TEST(rates_are_in_the_setups_order)
{
    static struct gas turned;
    for (int dim = 1; dim <= 3; dim++) {
        char words[400];
        snprintf(words, sizeof words, "%s gradient=ia", schemes[dim]);
        make(&gas, dim, sides[dim], words);
        make(&turned, dim, sides[dim], words);
        const size_t n = gas.setup.n;
        for (size_t i = 0; i < n; i++) {
            for (int a = 0; a < 3; a++) {
                turned.x[a][i] = gas.x[a][n - 1 - i];
                turned.v[a][i] = gas.v[a][n - 1 - i];
            }
            turned.m[i] = gas.m[n - 1 - i], turned.u[i] = gas.u[n - 1 - i];
        }
        struct rate_table a = table_of(&gas.setup), b = table_of(&turned.setup);
        double condition = 0, force[3] = {0}, power = 0, size = 0;
        assert_true(a.n == n && a.dim == dim);
        for (size_t i = 0; i < n; i++) {
            const size_t j = n - 1 - i;
            near_relative(b.h[j], a.h[i], 1e-12);
            near_relative(b.rho[j], a.rho[i], 1e-12);
            near_relative(a.P[i], 0.5 * a.rho[i] * gas.u[i], 1e-12);
            near_relative(b.P[j], a.P[i], 1e-12);
            near_absolute(1 + b.dU[j] - a.dU[i], 1, 1e-10);
            near_relative(b.described[j].condition, a.described[i].condition, 1e-9);
            assert_true(b.described[j].neighbours == a.described[i].neighbours);
            condition = fmax(condition, a.described[i].condition);
            power += a.dU[i];
            for (int d = 0; d < dim; d++) {
                near_absolute(1 + b.force[d][j] - a.force[d][i], 1, 1e-10);
                force[d] += a.force[d][i];
                power += gas.v[d][i] * a.force[d][i];
                size = fmax(size, fabs(a.force[d][i]));
            }
            for (int d = dim; d < 3; d++) assert_true(a.force[d][i] == 0);
        }
        assert_true(size > 1e-2);
        near_relative(a.matrix.condition_max, condition, 1e-9);
        for (int d = 0; d < 3; d++) near_absolute(a.sum_force[d] - force[d], 0, 1e-13);
        near_absolute(a.power - power, 0, 1e-13);
        rate_table_free(&a);
        rate_table_free(&b);
        assert_true(!a.h && !a.storage && !a.described && !a.n);
    }
}

/* dU/dt does not depend on which energy is integrated; with an external force sums do not
 * vanish. */
TEST(rates_do_not_depend_on_the_energy_integrated)
{
    make(&gas, 2, 6, USUAL " energy=internal");
    gas.setup.gravity[0] = 0.25, gas.setup.gravity[1] = -2;
    struct rate_table internal = table_of(&gas.setup);
    set_scheme(&gas.setup, USUAL " energy=total");
    struct rate_table total = table_of(&gas.setup);
    double mass = 0, power = 0, size = 0;
    for (size_t i = 0; i < gas.setup.n; i++) {
        near_absolute(1 + total.dU[i] - internal.dU[i], 1, 1e-13);
        size = fmax(size, fabs(internal.dU[i]));
        mass += gas.m[i];
        power += gas.m[i] * (0.25 * gas.v[0][i] - 2 * gas.v[1][i]);
    }
    assert_true(size > 1e-3 && fabs(power) > 1e-3);
    const struct rate_table *const both[] = {&internal, &total};
    for (int k = 0; k < 2; k++) {
        near_absolute(both[k]->power, power, 1e-13);
        near_relative(both[k]->sum_force[0], 0.25 * mass, 1e-12);
        near_relative(both[k]->sum_force[1], -2 * mass, 1e-12);
        assert_true(both[k]->sum_force[2] == 0);
    }
    rate_table_free(&internal);
    rate_table_free(&total);
}

TEST(no_setup_no_table)
{
    struct rate_table table;
    struct error error = {0};
    make(&gas, 2, 6, USUAL);
    gas.m[7] = -1;
    assert_int_equal(rate_table_make(&table, &gas.setup, &error), STATUS_BAD_INPUT);
    assert_true(error.message[0] && !table.storage && !table.described);
    rate_table_free(&table);
}

/* ---- the comparison ---- */

static const char *const names[] = {"h", "rho", "P", "ax", "ay", "az", "du"};

static double value(const struct rate_table *table, int column, size_t i)
{
    const double of[] = {table->h[i],        table->rho[i],      table->P[i], table->force[0][i],
                         table->force[1][i], table->force[2][i], table->dU[i]};
    return of[column] / (column > 2 ? gas.m[i] : 1);
}

/* A table as if read from a file. */
struct file {
    struct csv csv;
    double values[7][MOST];
};

static struct file file; /* of the test */

static void write_file(const struct rate_table *table, unsigned columns)
{
    file.csv = (struct csv){.rows = table->n};
    for (int c = 0; c < 7; c++) {
        if (!(columns >> c & 1)) continue;
        for (size_t i = 0; i < table->n; i++) file.values[c][i] = value(table, c, i);
        file.csv.names[file.csv.columns] = (char *)(uintptr_t)names[c];
        file.csv.values[file.csv.columns++] = file.values[c];
    }
}

static struct rate_check checked(const struct setup *setup, const struct rate_table *ours,
                                 double tolerance)
{
    struct rate_check check;
    struct error error;
    if (rate_check_make(&check, "theirs.csv", &file.csv, setup, ours, tolerance, &error))
        fail_msg("%s", error.message);
    return check;
}

TEST(equal_tables_are_good)
{
    struct error error = {0};
    for (int dim = 1; dim <= 3; dim++) {
        make(&gas, dim, sides[dim], schemes[dim]);
        struct rate_table ours = table_of(&gas.setup);
        write_file(&ours, 0x7f);
        struct rate_check check = checked(&gas.setup, &ours, 0);
        assert_true(check.good);
        assert_int_equal(check.count, 4 + dim); /* columns of other directions are not compared */
        for (size_t k = 0; k < check.count; k++) {
            const struct rate_comparison *c = &check.columns[k];
            assert_string_equal(c->quantity,
                                names[k + (k == check.count - 1 ? 3 - (size_t)dim : 0)]);
            assert_true(c->good && c->worst == 0 && c->rms == 0 && c->particle == 0 &&
                        !c->cause[0]);
        }
        write_file(&ours, dim < 3 ? 0x20 : 0); /* only az, or no rate */
        assert_int_equal(
            rate_check_make(&check, "theirs.csv", &file.csv, &gas.setup, &ours, 0, &error),
            STATUS_BAD_INPUT);
        assert_non_null(strstr(error.message, "theirs.csv:1: nothing to compare"));
        for (int more = -1; more <= 1; more += 2) {
            write_file(&ours, 1);
            file.csv.rows += (size_t)more;
            assert_int_equal(
                rate_check_make(&check, "theirs.csv", &file.csv, &gas.setup, &ours, 0, &error),
                STATUS_BAD_INPUT);
            assert_non_null(strstr(error.message, "one for each of the"));
        }
        rate_table_free(&ours);
    }
}

/* The scale of an error: the largest acceleration or heating rate of all particles; for h, rho and
 * P the particle's own value. */
static double scale_of(const struct rate_table *t, int column, size_t i)
{
    double most = 0;
    if (column < 3) return fabs(value(t, column, i));
    for (size_t k = 0; k < t->n; k++)
        most = fmax(most, column == 6 ? fabs(value(t, 6, k))
                                      : sqrt(pow(value(t, 3, k), 2) + pow(value(t, 4, k), 2) +
                                             pow(value(t, 5, k), 2)));
    return most;
}

/* Rows in another order, or of other particles, are refused if positions show it. */
TEST(rows_of_other_particles)
{
    static const struct {
        double shift; /* of all rows along the last axis, in boxes */
        bool swapped; /* exchange rows 3 and 7 */
        enum boundary boundary;
        bool good;
    } rows[] = {{0, false, BOUNDARY_PERIODIC, true},      {1, false, BOUNDARY_PERIODIC, true},
                {-3, false, BOUNDARY_PERIODIC, true},     {1, false, BOUNDARY_OPEN, false},
                {0.5e-5, false, BOUNDARY_OPEN, true},     {2e-5, false, BOUNDARY_OPEN, false},
                {-2e-5, false, BOUNDARY_PERIODIC, false}, {0, true, BOUNDARY_PERIODIC, false},
                {0, true, BOUNDARY_OPEN, false}};
    for (int dim = 1; dim <= 3; dim++)
        for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
            struct error error;
            double x[3][MOST];
            static char letters[3][2] = {"x", "y", "z"};
            make(&gas, dim, sides[dim], "eta=2.4");
            for (int a = 0; a < dim; a++) {
                gas.setup.lo[a] = -0.25, gas.setup.hi[a] = 1.75;
                gas.setup.boundary[a] = BOUNDARY_PERIODIC;
                memcpy(x[a], gas.x[a], sizeof x[a]);
            }
            gas.setup.boundary[dim - 1] = rows[k].boundary;
            for (size_t i = 0; i < gas.setup.n; i++) x[dim - 1][i] += 2 * rows[k].shift;
            for (int a = 0; a < dim && rows[k].swapped; a++)
                x[a][3] = gas.x[a][7], x[a][7] = gas.x[a][3];
            struct csv theirs = {.rows = gas.setup.n + 1, .columns = (size_t)dim};
            for (int a = 0; a < dim; a++) theirs.names[a] = letters[a], theirs.values[a] = x[a];
            for (int a = 0; a < dim; a++) x[a][gas.setup.n] = 0.7; /* of no particle */
            assert_int_equal(rate_check_positions("theirs.csv", &theirs, &gas.setup, &error),
                             rows[k].good ? STATUS_OK : STATUS_BAD_INPUT);
            if (rows[k].swapped)
                assert_non_null(strstr(error.message, "the row of particle 3 is at x="));
            theirs.rows = 3; /* what is not there is not compared */
            assert_int_equal(rate_check_positions("theirs.csv", &theirs, &gas.setup, &error),
                             rows[k].good || rows[k].swapped ? STATUS_OK : STATUS_BAD_INPUT);
            theirs.columns = 0; /* without positions */
            assert_int_equal(rate_check_positions("theirs.csv", &theirs, &gas.setup, &error),
                             STATUS_OK);
        }
}

/* The check reports the larger of two errors, its particle and its quantity; also if all rates are
 * tiny, and if those of particle 0 are by far the largest. */
TEST(reported_errors)
{
    static const size_t who[2][2] = {{3, 11}, {11, 0}};
    for (int dim = 2; dim <= 3; dim++) {
        make(&gas, dim, sides[dim], schemes[dim]);
        struct rate_table ours = table_of(&gas.setup);
        for (int round = 0; round < 2; round++) {
            const size_t first = who[round][0], second = who[round][1];
            for (size_t i = 0; i < gas.setup.n && round; i++) {
                for (int a = 0; a < dim; a++) ours.force[a][i] *= i ? 1e-9 : 1e-7;
                ours.dU[i] *= i ? 1e-9 : 1e-7;
            }
            for (int c = 0; c < 7; c++) {
                if (dim == 2 && c == 5) continue;
                write_file(&ours, 0x7f);
                file.values[c][first] -= 0.25 * scale_of(&ours, c, first);
                file.values[c][second] += 0.5 * scale_of(&ours, c, second);
                struct rate_check check = checked(&gas.setup, &ours, 1e-9);
                assert_false(check.good);
                for (size_t k = 0; k < check.count; k++) {
                    const struct rate_comparison *r = &check.columns[k];
                    const bool wrong = strcmp(r->quantity, names[c]) == 0;
                    assert_true(r->good == !wrong);
                    if (!wrong) continue;
                    near_relative(r->worst, 0.5, 1e-12);
                    near_relative(r->rms, sqrt((0.0625 + 0.25) / (double)gas.setup.n), 1e-12);
                    assert_int_equal(r->particle, second);
                    if (c % 2) continue;
                    /* a tolerance equal to the error suffices, and no smaller one */
                    assert_true(checked(&gas.setup, &ours, r->worst).good);
                    assert_false(checked(&gas.setup, &ours, nextafter(r->worst, 0)).good);
                }
                file.values[c][5] = (double)NAN;
                check = checked(&gas.setup, &ours, 1);
                assert_false(check.good);
            }
        }
        rate_table_free(&ours);
    }
}

/* ---- causes ---- */

/* The cause that the check names for a quantity; "" for none. */
static const char *cause_of(const struct rate_check *check, const char *quantity)
{
    for (size_t k = 0; k < check->count; k++)
        if (strcmp(check->columns[k].quantity, quantity) == 0) return check->columns[k].cause;
    fail_msg("no %s", quantity);
    return NULL;
}

TEST(each_choice_is_named)
{
    static const struct {
        const char *ours, *theirs, *quantity, *cause;
    } rows[] = {
        {"", "viscosity=none", "ax", "viscosity: they have none"},
        {"viscosity=reconstructed", "viscosity=constant", "ax", "viscosity: theirs is constant"},
        {"", "beta=0", "ax", "viscosity: theirs has no quadratic term (beta = 0)"},
        {"", "beta=1", "ay", "viscosity: beta = alpha in theirs"},
        {"", "alpha=2", "ax", "viscosity: alpha is twice ours"},
        {"", "alpha=0.5", "du", "viscosity: alpha is half of ours"},
        {"", "alpha=2 beta=6", "ax", "viscosity: alpha and beta are twice ours"},
        {"", "alpha=0.5 beta=1.5", "du", "viscosity: alpha and beta are half of ours"},
        {"viscosity_form=signal", "viscosity_form=mu", "ax", "viscosity: theirs is of the form mu"},
        {"", "viscosity_form=signal", "ax", "viscosity: theirs is of the form signal"},
        {"", "balsara=on", "ax", "viscosity: theirs has a Balsara factor"},
        {"balsara=on", "balsara=off", "ax", "viscosity: theirs has no Balsara factor"},
        {"", "pair_width=max", "ax", "pair width: theirs is max(h_i, h_j)"},
        {"pair_width=max", "pair_width=mean", "ax",
         "pair width: theirs is the mean of both gradients"},
        {"", "pair_width=harmonic", "ax", "pair width: theirs is the harmonic mean"},
        {"gradient=ia", "gradient=standard", "ax", "gradient: theirs is standard"},
        {"", "gradient=ia", "ax", "gradient: theirs is ia"},
        {"", "gradient=corrected", "ax", "gradient: theirs is corrected"},
        {"", "gradient=blended", "ax", "gradient: theirs is blended"},
        {"formulation=lagrangian", "formulation=vanilla_ice", "ax",
         "pressure: their formulation is vanilla_ice"},
        {"", "formulation=lagrangian", "ax",
         "pressure: their formulation is lagrangian, with grad-h factors"},
        {"volume_element=energy", "volume_element=mass", "rho", "volume element: theirs is mass"},
        {"", "volume_element=energy", "rho", "volume element: theirs is energy"},
        {"", "volume_element=number", "rho", "volume element: theirs is number"},
        {"alpha_u=1", "alpha_u=0", "du", "conductivity: they have none"},
        {"", "shock_conductivity=1", "du",
         "conductivity: theirs is 1 in strong shocks (shock_conductivity=1)"},
        {"", "gamma=1.6666666666666667", "P", "gamma: theirs is 5/3"},
        {"", "gamma=1.4", "P", "gamma: theirs is 1.4"},
        {"eta=2.8", "eta=1.4", "h", "eta: theirs is half of ours (h is the support radius here)"},
        {"eta=1.4", "eta=2.8", "h", "eta: theirs is twice ours (h is the support radius here)"},
        {"", "eta=2.75", "h", "eta: theirs is 2.75"},
        {"", "eta=2.4001", "h", "eta: theirs is 2.4001"},
        {"", "kernel=wendland_c6", "h", "kernel: theirs is wendland_c6"},
        {"kernel=wendland_c6", "kernel=cubic_spline", "h", "kernel: theirs is cubic_spline"},
        {"kernel=cubic_spline", "kernel=sinc", "rho", "kernel: theirs is sinc"},
        {"", "kernel=quartic_spline eta=2.6", "ax",
         "kernel: theirs is quartic_spline, with eta 2.6"},
    };
    char words[400];
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        snprintf(words, sizeof words, "%s %s", USUAL, rows[k].ours);
        make(&gas, 2, 7, words);
        struct rate_table ours = table_of(&gas.setup);
        struct setup changed = gas.setup;
        snprintf(words, sizeof words, "%s %s %s", USUAL, rows[k].ours, rows[k].theirs);
        set_scheme(&changed, words);
        struct rate_table theirs = table_of(&changed);
        write_file(&theirs, 0x5f);
        const struct rate_check check = checked(&gas.setup, &ours, 1e-9);
        if (strcmp(cause_of(&check, rows[k].quantity), rows[k].cause) != 0)
            fail_msg("%s: '%s', not '%s'", rows[k].theirs, cause_of(&check, rows[k].quantity),
                     rows[k].cause);
        rate_table_free(&ours);
        rate_table_free(&theirs);
    }
    for (int dim = 1; dim <= 3; dim++) {
        make(&gas, dim, sides[dim], schemes[dim]);
        struct rate_table ours = table_of(&gas.setup);
        struct setup changed = gas.setup;
        if (dim > 1) {
            for (int a = 0; a < dim; a++) changed.boundary[a] = BOUNDARY_OPEN;
            struct rate_table theirs = table_of(&changed);
            write_file(&theirs, 0x5f);
            const struct rate_check check = checked(&gas.setup, &ours, 1e-9);
            assert_string_equal(cause_of(&check, "rho"), "boundary: theirs is open");
            rate_table_free(&theirs);
        }
        rate_table_free(&ours);
    }
}

/* A change of scheme is a cause if it makes the error a thousand times smaller, or as small as the
 * tolerance. */
TEST(when_a_change_is_a_cause)
{
    make(&gas, 2, 6, USUAL);
    struct rate_table ours = table_of(&gas.setup);
    struct setup changed = gas.setup;
    changed.scheme.viscosity = VISCOSITY_NONE;
    struct rate_table theirs = table_of(&changed);
    const double scale = scale_of(&theirs, 3, 0);
    write_file(&theirs, 1 << 3);
    const struct rate_check plain = checked(&gas.setup, &ours, 1e-9);
    const double worst = plain.columns[0].worst;
    const size_t other = plain.columns[0].particle == 2 ? 3 : 2;
    assert_string_equal(plain.columns[0].cause, "viscosity: they have none");
    for (int side = -1; side <= 1; side += 2) {
        const double much = worst * 1e-3 * (1 + side * 4e-7) * scale;
        file.values[3][other] = value(&theirs, 3, other) + much;
        struct rate_check check = checked(&gas.setup, &ours, 1e-9);
        assert_true(check.columns[0].worst == worst);
        assert_string_equal(check.columns[0].cause, side < 0 ? "viscosity: they have none" : "");
        /* the remaining error may equal the tolerance, and no more */
        check = checked(&gas.setup, &ours, 1e-9);
        const double left = checked(&changed, &theirs, 1).columns[0].worst;
        if (side > 0) {
            check = checked(&gas.setup, &ours, left);
            assert_string_equal(check.columns[0].cause, "viscosity: they have none");
            check = checked(&gas.setup, &ours, nextafter(left, 0));
            assert_string_equal(check.columns[0].cause, "");
        }
        /* a larger tolerance still gives a cause; an error within the tolerance has none */
        check = checked(&gas.setup, &ours, 2e-3 * worst);
        assert_string_equal(check.columns[0].cause, "viscosity: they have none");
        check = checked(&gas.setup, &ours, worst);
        assert_string_equal(check.columns[0].cause, "");
    }
    rate_table_free(&ours);
    rate_table_free(&theirs);
}

/* A small difference, too, is explained by no more than a thousandth of it. */
TEST(rest_of_a_small_difference)
{
    make(&gas, 2, 6, USUAL " gamma=1.4001");
    struct rate_table ours = table_of(&gas.setup);
    struct setup changed = gas.setup;
    changed.gamma = 1.4;
    struct rate_table theirs = table_of(&changed);
    for (int off = 0; off < 2; off++) {
        write_file(&theirs, 1 << 2);
        file.values[2][3] *= off ? 1 + 6e-7 : 1;
        assert_string_equal(checked(&gas.setup, &ours, 1e-9).columns[0].cause,
                            off ? "" : "gamma: theirs is 1.4");
    }
    rate_table_free(&ours);
    rate_table_free(&theirs);
}

/* Smoothing lengths of other codes scatter a little: the nearest kernel is named, with the common
 * eta, unless they scatter by more than two parts in a thousand. */
TEST(scattered_widths)
{
    make(&gas, 2, sides[2], schemes[2]);
    struct rate_table ours = table_of(&gas.setup);
    for (size_t k = 0; k < kernel_family.n; k++)
        for (int wide = 0; wide < 2; wide++) {
            const char *name = kernel_family.members[k]->name;
            struct setup changed = gas.setup;
            char expected[80] = "eta: theirs is 2.6"; /* the other code's kernel is the same */
            if (kernel_select(&changed.scheme.kernel, name, 5, NULL)) continue;
            changed.scheme.eta = 2.64;
            struct rate_table theirs = table_of(&changed);
            for (size_t i = 0; i < theirs.n; i++)
                theirs.h[i] *= 1 + (wide ? 2.2e-3 * (i == 0) : 1e-3 * ((double)(i % 2) - 0.5));
            write_file(&theirs, 3);
            const struct rate_check check = checked(&gas.setup, &ours, 1e-9);
            if (strcmp(name, "cubic_spline") != 0)
                snprintf(expected, sizeof expected, "kernel: theirs is %s, with eta 2.6", name);
            for (int c = 0; c < 2; c++) {
                const char *cause = check.columns[c].cause;
                if (wide ? *cause != '\0' : strncmp(cause, expected, strlen(expected)) != 0)
                    fail_msg("%s, %s: '%s'", name, names[c], cause);
            }
            rate_table_free(&theirs);
        }
    rate_table_free(&ours);
}

/* Where widths scatter alone, no kernel explains that. */
TEST(scattered_widths_alone)
{
    make(&gas, 2, sides[2], schemes[2]);
    struct rate_table ours = table_of(&gas.setup);
    write_file(&ours, 3);
    for (size_t i = 0; i < ours.n; i++) file.values[0][i] *= 1 + (i % 2 ? 7e-4 : -7e-4);
    assert_string_equal(checked(&gas.setup, &ours, 1e-9).columns[0].cause, "");
    rate_table_free(&ours);
}

/* Of several kernels that explain a difference to the tolerance the nearest is named. */
TEST(nearest_kernel)
{
    make(&gas, 2, sides[2], schemes[2]);
    struct rate_table ours = table_of(&gas.setup);
    for (size_t k = 0; k < kernel_family.n; k++) {
        const char *name = kernel_family.members[k]->name;
        struct setup changed = gas.setup;
        char expected[80];
        if (!strcmp(name, "cubic_spline") || kernel_select(&changed.scheme.kernel, name, 5, NULL))
            continue;
        struct rate_table theirs = table_of(&changed);
        write_file(&theirs, 2);
        const double worst = checked(&gas.setup, &ours, 0).columns[0].worst;
        const struct rate_check check = checked(&gas.setup, &ours, 0.9 * worst);
        snprintf(expected, sizeof expected, "kernel: theirs is %s", name);
        assert_string_equal(check.columns[0].cause, expected);
        rate_table_free(&theirs);
    }
    rate_table_free(&ours);
}

/* Widths that do not scatter leave no difference of other quantities open. */
TEST(equal_widths)
{
    make(&gas, 2, sides[2], schemes[2]);
    struct rate_table ours = table_of(&gas.setup);
    struct setup changed = gas.setup;
    changed.scheme.eta = 2.64;
    struct rate_table theirs = table_of(&changed);
    write_file(&theirs, 0xb);
    const struct rate_comparison plain = checked(&gas.setup, &ours, 1e-9).columns[2];
    assert_string_equal(plain.cause, "eta: theirs is 2.64");
    file.values[3][plain.particle == 2 ? 3 : 2] += 0.05 * plain.worst * scale_of(&theirs, 3, 0);
    const struct rate_check check = checked(&gas.setup, &ours, 1e-9);
    assert_string_equal(cause_of(&check, "h"), plain.cause);
    assert_string_equal(cause_of(&check, "ax"), "it follows from h, or there is more than one");
    rate_table_free(&ours);
    rate_table_free(&theirs);
}

/* Differences that no choice of a scheme makes. */
TEST(differences_that_no_scheme_makes)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int c = 0; c < 7; c++) {
            if (c >= 3 && c < 6 && c - 3 >= dim) continue;
            make(&gas, dim, sides[dim], schemes[dim]);
            struct rate_table ours = table_of(&gas.setup);
            const size_t n = gas.setup.n;
            char text[80];
            for (int k = 0; k < 2; k++) {
                static const double factors[] = {0.8125, -3};
                if (k && c >= 3) continue;
                write_file(&ours, 1u << c);
                for (size_t i = 0; i < n; i++) file.values[c][i] *= factors[k];
                const struct rate_check check = checked(&gas.setup, &ours, 1e-9);
                snprintf(text, sizeof text, "theirs is %.9g times ours everywhere", factors[k]);
                assert_string_equal(check.columns[0].cause, text);
            }
            write_file(&ours, 1u << c);
            for (size_t i = 0; i < n; i++) file.values[c][i] *= -1;
            struct rate_check check = checked(&gas.setup, &ours, 1e-9);
            assert_string_equal(check.columns[0].cause, c < 3 ? "theirs is -1 times ours everywhere"
                                                              : "the sign is the other one");
            write_file(&ours, 1u << c);
            for (size_t i = 0; i < n; i++) file.values[c][i] *= gas.m[i];
            check = checked(&gas.setup, &ours, 1e-9);
            snprintf(text, sizeof text, "they give %s: %s = that over m",
                     c == 6 ? "dU/dt" : "dp/dt", names[c]);
            assert_string_equal(check.columns[0].cause, c < 3 ? "" : text);
            /* cubic spline: W(0) = C/h^d, C = 4/3, 40/(7 pi), 8/pi */
            static const double C[] = {0, 4 / 3., 40 / (7 * M_PI), 8 / M_PI};
            write_file(&ours, 1u << c);
            for (size_t i = 0; i < n; i++)
                file.values[c][i] -= gas.m[i] * C[dim] / pow(ours.h[i], dim);
            check = checked(&gas.setup, &ours, 1e-9);
            assert_string_equal(check.columns[0].cause,
                                c == 1 ? "self-contribution: they leave out m W(0)" : "");
            gas.setup.scheme.volume_element = VOLUME_ENERGY;
            check = checked(&gas.setup, &ours, 1e-9);
            assert_null(strstr(check.columns[0].cause, "self"));
            rate_table_free(&ours);
        }
}

/* A cause leaves an error a thousand times smaller. */
TEST(when_a_difference_is_a_cause)
{
    static const char *const causes[] = {
        "theirs is 0.8125", "self-contribution", "theirs is 0.8125", "the sign", "", "",
        "they give dU/dt"};
    make(&gas, 2, 6, USUAL);
    struct rate_table ours = table_of(&gas.setup);
    const double n = (double)gas.setup.n;
    for (int c = 0; c < 7; c++)
        for (int side = -1; side <= 1 && causes[c][0]; side += 2) {
            write_file(&ours, 1u << c);
            for (size_t i = 0; i < gas.setup.n; i++) {
                if (c == 0 || c == 2) file.values[c][i] *= 0.8125;
                if (c == 1) file.values[c][i] -= gas.m[i] * 40 / (7 * M_PI) / pow(ours.h[i], 2);
                if (c == 3) file.values[c][i] *= -1;
                if (c == 6) file.values[c][i] *= gas.m[i];
            }
            struct rate_check check = checked(&gas.setup, &ours, 1e-9);
            const double worst = check.columns[0].worst;
            const size_t other = c == 2 ? 7 : check.columns[0].particle == 0;
            assert_ptr_equal(strstr(check.columns[0].cause, causes[c]), check.columns[0].cause);
            /* the factor is a mean: it absorbs part of one particle's difference */
            const double share = c == 0 || c == 2 ? 1 - 1 / n : 1;
            file.values[c][other] +=
                worst * 1e-3 * (1 + side * 4e-7) / share * scale_of(&ours, c, other);
            check = checked(&gas.setup, &ours, 1e-9);
            near_relative(check.columns[0].worst, worst, 1e-12);
            assert_true(!strstr(check.columns[0].cause, causes[c]) == (side > 0));
            check = checked(&gas.setup, &ours, 2e-3 * worst);
            assert_non_null(strstr(check.columns[0].cause, causes[c]));
        }
    rate_table_free(&ours);
}

/* A kernel that is not 1 at 0: 66 (7/478 pi) 3^2/h^2 is the quintic spline's W(0) in 2D. */
TEST(self_contribution)
{
    make(&gas, 2, 8, USUAL " kernel=quintic_spline eta=2.5");
    struct rate_table ours = table_of(&gas.setup);
    write_file(&ours, 1 << 1);
    for (size_t i = 0; i < gas.setup.n; i++)
        file.values[1][i] -= gas.m[i] * 66 * 7 * 9 / (478 * M_PI) / pow(ours.h[i], 2);
    const struct rate_check check = checked(&gas.setup, &ours, 1e-9);
    assert_string_equal(cause_of(&check, "rho"), "self-contribution: they leave out m W(0)");
    rate_table_free(&ours);
}

/* The remaining error of an acceleration is relative to the largest one, not to the particle's own;
 * here the smallest is off. */
TEST(factor_of_an_acceleration)
{
    size_t least = 0;
    make(&gas, 2, 6, USUAL);
    struct rate_table ours = table_of(&gas.setup);
    write_file(&ours, 1 << 3);
    for (size_t i = 0; i < gas.setup.n; i++) {
        if (fabs(file.values[3][i]) < fabs(file.values[3][least])) least = i;
        file.values[3][i] *= 0.8125;
    }
    const double worst = checked(&gas.setup, &ours, 1e-9).columns[0].worst;
    file.values[3][least] += 0.5e-3 * worst * scale_of(&ours, 3, least);
    const struct rate_check check = checked(&gas.setup, &ours, 1e-9);
    assert_non_null(strstr(cause_of(&check, "ax"), "times ours everywhere"));
    rate_table_free(&ours);
}

/* If all rates are 0, every difference is infinitely large, and no cause is named. */
TEST(rates_that_are_all_0)
{
    make(&gas, 2, 6, USUAL);
    struct rate_table ours = table_of(&gas.setup);
    write_file(&ours, 1 << 3);
    for (size_t i = 0; i < gas.setup.n; i++) {
        for (int a = 0; a < 2; a++) ours.force[a][i] = 0;
        file.values[3][i] *= 1 + 0.01 * (double)i;
    }
    const struct rate_check check = checked(&gas.setup, &ours, 1e-9);
    assert_true(isinf(check.columns[0].worst) && !check.columns[0].good);
    assert_string_equal(cause_of(&check, "ax"), "");
    rate_table_free(&ours);
}

/* Codes sort particles by keys of their own; one value that is not ours is no other order. */
TEST(rows_in_another_order)
{
    for (int dim = 1; dim <= 3; dim++)
        /* 0: a value is not ours; 1: all are; 2: the least is less; 3, 4: all are off by a little
         * less and more than a thousandth of the difference */
        for (int how = 0; how < 5; how++) {
            const bool whole = how == 1 || how == 3;
            make(&gas, dim, sides[dim], schemes[dim]);
            struct rate_table ours = table_of(&gas.setup);
            write_file(&ours, 0x7f);
            for (int c = 0; c < 7; c++) {
                for (size_t i = 0; i + 1 < gas.setup.n; i++) {
                    const double kept = file.values[c][i];
                    file.values[c][i] = file.values[c][i + 1], file.values[c][i + 1] = kept;
                }
                size_t least = 0;
                for (size_t i = 0; i < gas.setup.n; i++)
                    if (file.values[c][i] < file.values[c][least]) least = i;
                if (how == 0) file.values[c][0] = 2 * file.values[c][1] + 1;
                if (how == 2) file.values[c][least] -= 1;
            }
            const struct rate_check before = checked(&gas.setup, &ours, 1e-9);
            for (size_t k = 0; k < before.count && how > 2; k++) {
                const struct rate_comparison *c = &before.columns[k];
                for (size_t i = 0; i < ours.n; i++) {
                    double *value = &file.values[c->column][i];
                    *value += (how == 3 ? 9e-4 : 1.1e-3) * c->worst *
                              (c->column < 3 ? *value : scale_of(&ours, c->column, 0));
                }
            }
            const struct rate_check check = checked(&gas.setup, &ours, 1e-9);
            for (size_t k = 0; k < check.count; k++) {
                const struct rate_comparison *c = &check.columns[k];
                assert_int_equal(!strncmp(c->cause, "rows: ", 6), whole);
                if (how < 3) assert_int_equal(c->follows, !whole && c->column > 1);
            }
            rate_table_free(&ours);
        }
}

/* Quantities after the first wrong one follow from it; those before it do not. */
TEST(order_of_causes)
{
    make(&gas, 2, 6, USUAL);
    struct rate_table ours = table_of(&gas.setup);
    for (int first = 0; first < 7; first++) {
        if (first == 5) continue;
        write_file(&ours, 0x5f);
        for (int c = first; c < 7; c++)
            for (size_t i = 0; i < gas.setup.n; i += 3)
                file.values[c][i] += 0.125 * (double)(i + 1);
        const struct rate_check check = checked(&gas.setup, &ours, 1e-9);
        for (int c = 0; c < 7; c++) {
            char text[80] = "";
            if (c == 5) continue;
            if (c > first && c >= 2 && first < 3)
                snprintf(text, sizeof text, "it follows from %s, or there is more than one",
                         names[first]);
            assert_string_equal(cause_of(&check, names[c]), text);
        }
    }
    rate_table_free(&ours);
}

/* Rates of the lagrangian formulation without its grad-h factors, in a periodic box without
 * external forces: only there the oracle has them. */
TEST(no_grad_h)
{
    static const char cause[] = "grad-h: their lagrangian formulation has no grad-h factors";
    for (int dim = 1; dim <= 3; dim++) {
        char words[400];
        snprintf(words, sizeof words, "%s formulation=lagrangian", schemes[dim]);
        make(&gas, dim, sides[dim], words);
        struct rate_table ours = table_of(&gas.setup);
        struct oracle oracle;
        const size_t n = gas.setup.n;
        assert_int_equal(oracle_create(&oracle, &gas.setup, NULL), STATUS_OK);
        oracle.without_grad_h = true;
        assert_int_equal(oracle_evaluate(&oracle, NULL), STATUS_OK);
        write_file(&ours, 0x7f);
        for (size_t i = 0; i < n; i++) {
            for (int a = 0; a < dim; a++)
                file.values[3 + a][i] = (double)oracle.particles[i].F[a] / gas.m[i];
            file.values[6][i] = (double)oracle.particles[i].dU / gas.m[i];
        }
        oracle_free(&oracle);
        static double before[4][MOST];
        const double *const rates[4] = {ours.force[0], ours.force[1], ours.force[2], ours.dU};
        for (int k = 0; k < 4; k++) memcpy(before[k], rates[k], n * sizeof(double));
        struct rate_check check = checked(&gas.setup, &ours, 1e-9);
        for (int k = 0; k < 4; k++) /* our own rates do not change */
            assert_memory_equal(before[k], rates[k], n * sizeof(double));
        for (int a = 0; a < dim; a++) assert_string_equal(cause_of(&check, names[3 + a]), cause);
        assert_string_equal(cause_of(&check, "du"), cause);
        for (int a = 0; a < dim && dim > 1; a++) {
            struct setup other = gas.setup;
            other.gravity[a] = 1e-3;
            check = checked(&other, &ours, 1e-9);
            assert_string_not_equal(cause_of(&check, "ax"), cause);
            other = gas.setup;
            other.boundary[a] = BOUNDARY_OPEN;
            check = checked(&other, &ours, 1e-9);
            assert_string_not_equal(cause_of(&check, "ax"), cause);
        }
        gas.setup.scheme.formulation = FORMULATION_VANILLA_ICE;
        check = checked(&gas.setup, &ours, 1e-9);
        assert_string_not_equal(cause_of(&check, "ax"), cause);
        rate_table_free(&ours);
    }
}
