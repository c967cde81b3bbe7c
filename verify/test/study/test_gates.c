/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests gates of one run with made-up documents: the bound at n, the bounds of compared schemes,
 * and which conserved quantities have gates for which scheme. */
#include "test.h"

#include "gates.h"
#include "value.h"

static const char text[] =
    "[case]\ntitle = A vortex\ndimension = 2\nreference = gresho\n[domain]\nlo = 0\nhi = 1\n"
    "[initial]\nkind = gresho\n[run]\nt_end = 1\n[converge]\nn = 64 100 144 400\n"
    "velocity_l1 = 0.5 3 0.125\ndisc_error = 1 0.25\npeak_velocity = 2 0.5 known: slow\n"
    "[compared]\nvelocity_l1 = 1.5 known: noise\ndisc_error = 0.375\n";

static struct case_file file_of(bool compared)
{
    struct case_file file;
    struct error error;
    if (case_parse(&file, "vortex.ini", text, strlen(text), &error)) fail_msg("%s", error.message);
    if (compared) gates_compare(&file);
    return file;
}

static json_t *run_of(double velocity, double disc_error, double peak)
{
    return json_pack("{s:i, s:{s:{s:f, s:f}}, s:[{s:s, s:f, s:f}, {s:s, s:f, s:f}]}", "n", 100,
                     "errors", "velocity", "l1", velocity, "l2", 1e-9, "functionals", "name",
                     "disc_error", "value", disc_error, "reference", 0., "name", "peak_velocity",
                     "value", peak, "reference", 1.);
}

static void says(const json_t *list, const char *name, double value, double bound,
                 const char *status)
{
    const json_t *gate = value_named(list, name);
    assert_non_null(gate);
    assert_true(fabs(value_member(gate, "value") - value) <= 1e-14);
    near_relative(value_member(gate, "bound"), bound, 1e-14);
    assert_string_equal(value_text(gate, "status"), status);
    assert_int_equal(!json_object_get(gate, "known"), strcmp(status, "known") != 0);
}

/* With a quarter of the finest number of particles (in 2D) spacings are twice as long. */
TEST(errors)
{
    static const struct {
        bool compared;
        double velocity, disc_error, peak, bounds[3];
        const char *status[3];
    } rows[] = {
        {false, 0.176, 0.49, -0.9, {0.125 * M_SQRT2, 0.5, 2}, {"pass", "pass", "smoke"}},
        {false, 0.177, 0.51, -1.1, {0.125 * M_SQRT2, 0.5, 2}, {"fail", "fail", "known"}},
        {true, 0.53, 0.74, -4.9, {0.375 * M_SQRT2, 0.75, 6}, {"pass", "pass", "smoke"}},
        {true, 0.54, 0.76, -5.1, {0.375 * M_SQRT2, 0.75, 6}, {"known", "fail", "known"}},
        {true, 2.12, 0.76, 1, {0.375 * M_SQRT2, 0.75, 6}, {"known", "fail", "smoke"}},
        {true, 2.13, 0.76, 1, {0.375 * M_SQRT2, 0.75, 6}, {"fail", "fail", "smoke"}},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct case_file file = file_of(rows[k].compared);
        json_t *run = run_of(rows[k].velocity, rows[k].disc_error, rows[k].peak),
               *list = json_array();
        gates_add_errors(&file, run, list);
        assert_int_equal(json_array_size(list), 3);
        says(list, "velocity_l1", rows[k].velocity, rows[k].bounds[0], rows[k].status[0]);
        says(list, "disc_error", rows[k].disc_error, rows[k].bounds[1], rows[k].status[1]);
        says(list, "peak_velocity", fabs(rows[k].peak - 1), rows[k].bounds[2], rows[k].status[2]);
        json_decref(list);
        json_decref(run);
    }
}

/* Above the case's own ladder another order and bound may hold; the bound of a compared scheme
 * holds at every n. */
TEST(beyond_the_ladder)
{
    static const char more[] = "[finer]\nvelocity_l1 = 0.25 1 0.25\ndisc_error = 0.5\n";
    char whole[sizeof text + sizeof more];
    struct case_file file;
    struct error error;
    snprintf(whole, sizeof whole, "%s%s", text, more);
    if (case_parse(&file, "vortex.ini", whole, strlen(whole), &error))
        fail_msg("%s", error.message);
    for (int compared = 0; compared < 2; compared++) {
        near_relative(gates_raise(&file, &file.gates[0], 401), 2, 1e-14);
        near_relative(gates_raise(&file, &file.gates[0], 400), 1, 1e-14);
        near_relative(gates_raise(&file, &file.gates[0], 100), M_SQRT2, 1e-14);
        near_relative(gates_raise(&file, &file.gates[1], 401), compared ? 1 : 2, 1e-14);
        const struct order_gate own = file.gates[0].gate;
        for (size_t n = 100; n < 402; n += n < 400 ? 300 : 1) {
            const struct order_gate at = gates_at(&file, &file.gates[0], n);
            assert_true(at.low == (n > 400 ? 0.25 : own.low));
            assert_true(at.high == (n > 400 ? 1 : own.high));
        }
        near_relative(gates_raise(&file, &file.gates[2], 401), 1, 1e-14);
        gates_compare(&file);
    }
}

/* A gate fails if the run lacks its figure, because nothing was compared, or if that is not a
 * number, even where a weakness is known that allows an error of any size. Figures without an exact
 * value are not gates. */
TEST(what_is_missing_fails)
{
    for (int missing = 0; missing < 2; missing++)
        for (int compared = 0; compared < 2; compared++) {
            const struct case_file file = file_of(compared);
            json_t *run = run_of(0.1, 0.1, 1), *list = json_array();
            json_t *velocity = json_object_get(json_object_get(run, "errors"), "velocity"),
                   *functionals = json_object_get(run, "functionals");
            if (missing) {
                json_object_clear(velocity);
                json_array_clear(functionals);
            } else {
                json_object_set_new(velocity, "l1", json_string("nan"));
                json_object_set_new(json_array_get(functionals, 0), "reference",
                                    json_string("nan"));
                json_object_set_new(json_array_get(functionals, 1), "value", json_string("nan"));
            }
            gates_add_errors(&file, run, list);
            assert_int_equal(json_array_size(list), missing ? 3 : 2);
            assert_string_equal(value_text(value_named(list, "velocity_l1"), "status"), "fail");
            assert_string_equal(value_text(value_named(list, "disc_error"), "status"),
                                missing ? "fail" : "");
            assert_string_equal(value_text(value_named(list, "peak_velocity"), "status"), "fail");
            json_decref(list);
            json_decref(run);
        }
}

/* A known weakness with the bound NaN excuses only a missing error, one with a finite bound errors
 * up to `raise` times that, one with an infinite bound any number. */
TEST(known_weaknesses_excuse_up_to_their_bound)
{
    const struct case_weakness absent = {(double)NAN, "no shock"}, any = {(double)INFINITY, "slow"},
                               some = {2, "slow"}, unsaid = {0, ""};
    assert_true(gates_know(&absent, 1, (double)NAN) && !gates_know(&absent, 1, 1e-9));
    assert_true(gates_know(&any, 1, 1e300) && !gates_know(&any, 1, (double)NAN));
    assert_true(gates_know(&some, 1.5, 3) && !gates_know(&some, 1.5, 3.1));
    assert_true(!gates_know(&some, 1, (double)NAN) && !gates_know(&unsaid, 1, 0));
}

/* Momentum is not gated where walls push or gravity acts, and energy is not if only heat is
 * integrated, or if gravity acts in steps that do its work only approximately. */
TEST(gates_on_conservation)
{
    static const struct {
        const char *boundary, *energy, *integrator, *steps;
        double g, lost;
        const char *momentum, *kept;
    } rows[] = {{"periodic", "total", "leapfrog", "global", 0, 1e-13, "pass", "pass"},
                {"periodic", "total", "rk2", "local", 0, 1e-11, "fail", "fail"},
                {"open", "internal", "rk3", "global", 0, 1e-11, "fail", ""},
                {"reflecting", "total", "rk3", "global", 0, 1e-13, "", "pass"},
                {"fixed", "total", "rk3", "global", 0, 1e-13, "", ""},
                {"periodic", "total", "leapfrog", "global", -0.5, 1e-13, "", ""},
                {"periodic", "total", "predicted_midpoint", "local", -0.5, 1e-13, "", ""},
                {"periodic", "total", "predicted_midpoint", "global", -0.5, 1e-13, "", "pass"},
                {"reflecting", "total", "predicted_midpoint", "global", -0.5, 1e-11, "", "fail"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        json_t *list = json_array(),
               *run = json_pack("{s:{s:[s,s], s:[f,f], s:s, s:s, s:s}, s:{s:f, s:f, s:f}}",
                                "settings", "boundary", "periodic", rows[k].boundary, "gravity", 0.,
                                rows[k].g, "energy", rows[k].energy, "integrator",
                                rows[k].integrator, "steps", rows[k].steps, "conservation", "mass",
                                0., "momentum", rows[k].lost, "energy", rows[k].lost);
        gates_add_conserved(run, list);
        says(list, "mass", 0, 1e-12, "pass");
        assert_string_equal(value_text(value_named(list, "momentum"), "status"), rows[k].momentum);
        assert_string_equal(value_text(value_named(list, "energy"), "status"), rows[k].kept);
        json_decref(list);
        json_decref(run);
    }
}
