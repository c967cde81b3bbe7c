/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the JSON document of judged snapshots: one by one, and their orders and gates. */
#include "test.h"

#include "sample_snapshot.h"
#include "value.h"

/* Judges uniform gas in 2D with this density and total mass at this time. */
static void judged_of(double rho, double time, double mass, struct judged *judged)
{
    struct judge_request request = uniform_gas();
    static char names[4][256];
    static int next;
    struct error error = {0};
    plant(2, 0, "# box = 2 1\n");
    gas.has_P = gas.has_h = true;
    for (int i = 0; i < N; i++) {
        gas.m[i] = mass / N, gas.rho[i] = rho, gas.h[i] = 0.2;
        gas.u[i] = 1 / (0.4 * rho);
        gas.v[1][i] = 0.01;
    }
    request.time.value = time;
    snprintf(names[next], sizeof names[0], "%s",
             put(next == 0   ? "a.csv"
                 : next == 1 ? "b.csv"
                             : "c.csv"));
    if (judge_snapshot(names[next], &request, judged, &error)) fail_msg("%s", error.message);
    next++;
}

static const json_t *at(const json_t *from, const char *a, const char *b)
{
    const json_t *found = json_object_get(from, a);
    if (found && b) found = json_object_get(found, b);
    if (!found) fail_msg("no %s %s", a, b ? b : "");
    return found;
}

static void is_one(const json_t *one, const struct judged *judged, double rho)
{
    const struct conventions *c = &judged->conventions;
    assert_string_equal(value_text(one, "file"), judged->path);
    assert_string_equal(value_text(one, "layout"), "csv");
    assert_string_equal(value_text(one, "code"), "unknown");
    assert_string_equal(value_text(one, "verdict"), judged->verdict);
    assert_true(value_member(one, "n") == N && value_member(one, "dim") == 2);
    assert_true(value_member(one, "time") == judged->result.time);
    assert_true(value_inner(one, "precision", "positions") == judged->file.precision[0]);
    assert_true(value_inner(one, "precision", "fields") == judged->file.precision[1]);
    near_relative(value_member(at(one, "errors", "density"), "l1"), rho - 1, 1e-12);
    near_relative(value_inner(one, "noise", "transverse_velocity"), 0.01, 1e-12);
    assert_true(json_boolean_value(at(one, "foreign", NULL)) == judged->foreign);
    const json_t *notes = at(one, "assumptions", NULL);
    assert_int_equal(json_array_size(notes), judged->file.notes.count);
    for (size_t k = 0; k < json_array_size(notes); k++) {
        const struct snapshot_note *note_of = &judged->file.notes.note[k];
        const json_t *got = json_array_get(notes, k);
        assert_string_equal(value_text(got, "what"), note_of->what);
        assert_string_equal(value_text(got, "value"), note_of->value);
        assert_string_equal(value_text(got, "evidence"), note_of->evidence);
    }
    const json_t *kernel = at(one, "kernel", NULL), *candidates = at(kernel, "candidates", NULL);
    assert_string_equal(value_text(kernel, "name"), "not identifiable");
    assert_true(json_is_null(at(kernel, "ratio", NULL)) && json_is_null(at(kernel, "said", NULL)) &&
                json_is_null(at(kernel, "said_ratio", NULL)));
    assert_true(value_member(kernel, "residual") == c->candidate[0].residual);
    assert_string_equal(value_text(kernel, "why"), c->why);
    assert_int_equal(json_array_size(candidates), c->count);
    for (size_t k = 0; k < c->count; k++) {
        const json_t *got = json_array_get(candidates, k);
        assert_string_equal(value_text(got, "name"), c->candidate[k].kernel.member.name);
        assert_string_equal(value_text(got, "density"), "masses");
        assert_true(value_member(got, "ratio") == c->candidate[k].ratio);
        assert_true(value_member(got, "residual") == c->candidate[k].residual);
    }
}

TEST(documents)
{
    struct judged judged[2];
    static const char *const statuses[] = {"pass", "fail"};
    const double values[] = {0.25, 3}, bounds[] = {0.5, 2};
    json_t *gates = json_pack("[{s:s,s:s,s:f,s:f,s:s,s:s},{s:s,s:s,s:f,s:f,s:s,s:s}]", "name",
                              "density_l1", "relation", "<=", "value", 0.25, "bound", 0.5, "status",
                              "pass", "source", "x", "name", "velocity_l2", "relation",
                              "<=", "value", 3., "bound", 2., "status", "fail", "source", "x");
    judged_of(1.01, 0.05, 2, &judged[0]);
    judged_of(1.02, 0.1, 2.1, &judged[1]);
    for (size_t n = 1; n <= 2; n++) {
        json_t *document = judge_json(judged, n, gates, n == 2);
        assert_non_null(document);
        is_one(document, &judged[n - 1], n == 1 ? 1.01 : 1.02);
        assert_string_equal(value_text(document, "case"), "sod");
        assert_true(value_inner(document, "settings", "gamma") == 1.4);
        assert_int_equal(json_array_size(at(document, "orders", NULL)), 0);
        const json_t *list = at(document, "gates", NULL);
        assert_int_equal(json_array_size(list), 2);
        for (size_t k = 0; k < 2; k++) {
            const json_t *one = json_array_get(list, k);
            assert_true(value_member(one, "value") == values[k] &&
                        value_member(one, "bound") == bounds[k]);
            /* findings of gates follow those of the snapshots */
            const json_t *finding = json_array_get(at(document, "findings", NULL), n + k);
            assert_string_equal(value_text(finding, "status"), statuses[k]);
            assert_string_equal(value_text(finding, "message"),
                                k ? "velocity_l2 3 is not <= 2" : "density_l1 0.25 is <= 0.5");
        }
        assert_string_equal(value_text(document, "status"), "fail");
        const char *headline = value_text(document, "headline");
        assert_true(strstr(headline, "1 of 2 gates failed: velocity_l2 3 is not <= 2; ") ==
                    headline);
        assert_true(!json_object_get(document, "profile") == (n == 1));
        assert_true(!json_object_get(document, "snapshots") == (n == 1));
        const json_t *conservation = at(document, "conservation", NULL);
        if (n == 1) { /* compared with the case's start: a box of 2 by 1 with P = 1 */
            assert_string_equal(
                json_string_value(json_array_get(at(conservation, "between", NULL), 0)),
                "the case's initial state");
            near_relative(judged[0].start.mass, 2, 1e-12);
            near_relative(judged[0].start.energy, 5, 1e-12);
            near_relative(value_member(conservation, "energy"), fabs(judged[0].sums.energy / 5 - 1),
                          1e-9);
        }
        if (n == 2) {
            near_relative(value_member(conservation, "mass"), 0.05, 1e-12);
            near_relative(value_member(conservation, "momentum"), 0.1 / 2.1, 1e-9);
            assert_true(value_member(conservation, "angular_momentum") >= 0);
            near_relative(value_member(conservation, "energy"),
                          fabs(judged[1].sums.energy / judged[0].sums.energy - 1), 1e-9);
            const json_t *between = at(conservation, "between", NULL);
            assert_string_equal(json_string_value(json_array_get(between, 0)), judged[0].path);
            assert_string_equal(json_string_value(json_array_get(between, 1)), judged[1].path);
            const json_t *all = at(document, "snapshots", NULL);
            assert_int_equal(json_array_size(all), 2);
            for (size_t k = 0; k < 2; k++) {
                is_one(json_array_get(all, k), &judged[k], k ? 1.02 : 1.01);
                assert_non_null(json_object_get(json_array_get(all, k), "profile"));
            }
        }
        assert_null(json_object_get(document, "no_orders"));
        json_decref(document);
    }
    json_decref(gates);
    judged[1].result.n = N + 1; /* other numbers of particles at other times */
    json_t *orderless = judge_json(judged, 2, NULL, false);
    char no_orders[400];
    snprintf(no_orders, sizeof no_orders, "the time is 0.05 in %.100s and 0.1 in %.100s",
             judged[0].path, judged[1].path);
    assert_string_equal(value_text(orderless, "no_orders"), no_orders);
    json_decref(orderless);
    judged[1].result.n = N;
    gates = json_array();
    for (size_t silent = 1; silent <= 2; silent++) { /* one, then both, without exact solution */
        static const char *const says[] = {"pass", "smoke", "undetermined", "fail"},
                                 *const first[] = {"", "0 of 1 gates pass, 1 cannot tell; ",
                                                   "0 of 1 gates pass, 1 cannot tell; ",
                                                   "1 of 1 gate failed: mass 0 is not <= 1; "};
        judged[silent - 1].silent = judged[silent - 1].passes = true;
        for (size_t k = 0; k < 4; k++) { /* the result of the only gate */
            json_t *gate =
                json_pack("[{s:s, s:s, s:f, s:f, s:s, s:s}]", "name", "mass", "relation",
                          "<=", "value", 0., "bound", 1., "status", says[k], "source", "x");
            json_t *document = judge_json(judged, 2, gate, false);
            char headline[1600];
            snprintf(headline, sizeof headline, "%s%s", first[k], judged[1].verdict);
            assert_string_equal(value_text(document, "headline"), headline);
            assert_string_equal(value_text(document, "status"),
                                k == 3 || (silent == 2 && k == 2) ? "fail" : "pass");
            json_decref(document);
            json_decref(gate);
        }
        json_t *document = judge_json(judged, 2, gates, false);
        const json_t *findings = at(document, "findings", NULL);
        assert_int_equal(json_array_size(findings), 1 + silent);
        for (size_t k = 0; k < silent; k++)
            assert_string_equal(value_text(json_array_get(findings, k), "status"), "undetermined");
        if (silent == 2)
            assert_string_equal(value_text(json_array_get(findings, 2), "message"),
                                "nothing could be compared");
        json_decref(document);
    }
    json_decref(gates);
    assert_string_equal(note(&judged[0], "kernel")->value, "not identifiable");
    assert_string_equal(note(&judged[0], "kernel")->evidence, judged[0].conventions.why);
    assert_string_equal(note(&judged[0], "precision")->value, "float64");
    assert_string_equal(note(&judged[0], "precision")->evidence,
                        "as stored; nothing below 1e-16 of a value is meant");
    /* a known kernel, and what the file says about it */
    judged[0].conventions.known = true;
    judged[0].conventions.candidate[0].sum = DENSITY_NUMBER;
    strcpy(judged[0].file.kernel, "a spline");
    judged[0].file.ratio = 1.75;
    json_t *document = judge_json(judged, 1, NULL, false);
    const json_t *kernel = at(document, "kernel", NULL);
    assert_string_equal(value_text(kernel, "name"),
                        judged[0].conventions.candidate[0].kernel.member.name);
    assert_true(value_member(kernel, "ratio") == judged[0].conventions.candidate[0].ratio);
    assert_string_equal(value_text(kernel, "said"), "a spline");
    assert_true(value_member(kernel, "said_ratio") == 1.75);
    assert_string_equal(value_text(json_array_get(at(kernel, "candidates", NULL), 0), "density"),
                        "number");
    assert_int_equal(json_array_size(at(document, "gates", NULL)), 0);
    judged[0].conventions.count = 0;
    json_decref(document);
    document = judge_json(judged, 1, NULL, false);
    assert_true(json_is_null(at(document, "kernel", "residual")));
    assert_int_equal(json_array_size(at(document, "kernel", "candidates")), 0);
    json_decref(document);
    for (int k = 0; k < 2; k++) judge_free(&judged[k]);
}

/* In 1D there is neither noise nor angular momentum. */
TEST(documents_in_1d)
{
    const struct judge_request request = uniform_gas();
    struct judged judged[2];
    for (int k = 0; k < 2; k++) {
        struct judge_request later = request;
        later.time.value = 0.1 + 0.1 * k;
        plant(1, 0, "# box = 2\n");
        judged[k] = judges(&later);
    }
    json_t *document = judge_json(judged, 2, NULL, false);
    assert_true(json_is_null(at(document, "noise", "transverse_velocity")));
    assert_true(json_is_null(at(document, "conservation", "angular_momentum")));
    json_decref(document);
    for (int k = 0; k < 2; k++) judge_free(&judged[k]);
}
