/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the gates, conservation and orders of several judged snapshots, on made-up results: they do
 * not depend on the order in which the snapshots are given. */
#include "test.h"

#include "judge.h"
#include "keyed.h"
#include "problem_list.h"
#include "value.h"

enum { MOST = 5 };
static struct problem problem; /* of all results */

static struct judged made(size_t n, double time, int dim)
{
    struct judged judged = {.path = "made"};
    judged.file.dim = dim;
    judged.result.n = n;
    judged.result.time = time;
    judged.result.problem.problem = &problem;
    /* all sums and errors follow from n and time, so that they identify the snapshot */
    const double mark = 1000. * (double)n + time;
    judged.sums = (struct conservation){.mass = mark,
                                        .momentum = {mark, 2, 3},
                                        .momentum_scale = 10 * mark,
                                        .sound_scale = mark,
                                        .energy = 4 * mark,
                                        .angular_momentum = {1, 2, 5 * mark},
                                        .angular_scale = 20 * mark,
                                        .turning_scale = mark};
    for (int f = 0; f < FIELDS; f++) judged.result.errors[f].l1 = mark * (f + 1);
    return judged;
}

/* The k-th permutation of n elements. */
static void permute(int n, int k, int *order)
{
    for (int i = 0; i < n; i++) order[i] = i;
    for (int i = n; i > 1; k /= i, i--) {
        const int j = k % i, old = order[i - 1];
        order[i - 1] = order[j], order[j] = old;
    }
}

static const struct {
    int count;
    struct {
        size_t n;
        double time;
    } shot[MOST];
    int main, start, end; /* index that is gated; indices that are compared, -1: none */
    int levels[MOST];     /* indices of the orders; -1: end of list */
} groups[] = {
    {1, {{50, 0.2}}, 0, -1, -1, {0, -1}},
    {2, {{50, 0.1}, {50, 0.2}}, 1, 0, 1, {1, -1}},
    {2, {{50, 0.2}, {60, 0.2001}}, 1, -1, -1, {0, 1, -1}},
    {2, {{50, 0.2}, {60, 0.2005}}, 1, -1, -1, {-1}},
    {3, {{50, 0}, {50, 0.1}, {50, 0.2}}, 2, 0, 2, {2, -1}},
    {4, {{50, 0}, {50, 0.2}, {60, 0.1}, {60, 0.2}}, 3, 2, 3, {1, 3, -1}},
    {4, {{50, 0}, {50, 0.1}, {50, 0.2}, {60, 0.2}}, 3, 0, 2, {2, 3, -1}},
    {4, {{50, 0}, {50, 0.2}, {60, 0.1}, {60, 0.3}}, 3, 2, 3, {-1}},
    {5, {{40, 0.6}, {50, 0.5}, {50, 0.6}, {60, 0.6}, {70, 0.6}}, 4, 1, 2, {0, 2, 3, 4, -1}},
    {5, {{40, 0.6}, {50, 0.5}, {50, 0.6}, {60, 0.2}, {70, 0.6}}, 4, 1, 2, {-1}},
    {5, {{50, 0.1}, {50, 0.2}, {50, 0.3}, {50, 0.4}, {50, 0.5}}, 4, 0, 4, {4, -1}},
};

TEST(snapshots_in_every_order)
{
    problem = (struct problem){0};
    for (size_t g = 0; g < sizeof groups / sizeof *groups; g++)
        for (int k = 0; k < 120; k++) {
            struct judged judged[MOST];
            struct trace_drift drift;
            size_t pair[2], levels = 0;
            int order[MOST], place[MOST];
            permute(groups[g].count, k, order);
            for (int i = 0; i < groups[g].count; i++) {
                judged[i] = made(groups[g].shot[order[i]].n, groups[g].shot[order[i]].time, 2);
                place[order[i]] = i;
            }
            const size_t n = (size_t)groups[g].count;
            assert_ptr_equal(judge_main(judged, n), &judged[place[groups[g].main]]);
            const bool drifts = judge_drift(judged, n, &drift, pair);
            assert_true(drifts == (groups[g].start >= 0));
            if (drifts) {
                assert_int_equal(pair[0], place[groups[g].start]);
                assert_int_equal(pair[1], place[groups[g].end]);
                const double a = judged[pair[0]].sums.mass, b = judged[pair[1]].sums.mass;
                near_relative(drift.mass, (b - a) / a, 1e-9);
                near_relative(drift.energy, (b - a) / a, 1e-9);
                near_relative(drift.momentum, (b - a) / (10 * b), 1e-9);
                near_relative(drift.angular_momentum, (b - a) / (4 * b), 1e-9);
                struct trace trace; /* of all snapshots between these two, in the order of time */
                size_t between = 0;
                json_decref(judge_conservation(judged, n, &trace));
                for (size_t i = 0; i < n; i++)
                    between += judged[i].result.n == judged[pair[0]].result.n;
                assert_int_equal(trace.count, between);
                for (size_t i = 1; i < between; i++) assert_true(trace.time[i] > trace.time[i - 1]);
            }
            while (levels < n && groups[g].levels[levels] >= 0) levels++;
            json_t *orders = judge_orders(judged, n);
            assert_int_equal(json_array_size(orders), levels > 1 ? FIELDS : 0);
            for (size_t f = 0; f < json_array_size(orders); f++) {
                const json_t *one = json_array_get(orders, f),
                             *pairwise = json_object_get(one, "pairwise");
                assert_string_equal(value_text(one, "field"), field_family.members[f]->name);
                assert_int_equal(json_array_size(pairwise), levels - 1);
                for (size_t i = 0; i + 1 < levels; i++) {
                    const struct judged *a = &judged[place[groups[g].levels[i]]],
                                        *b = &judged[place[groups[g].levels[i + 1]]];
                    near_relative(json_real_value(json_array_get(pairwise, i)),
                                  2 * log(a->sums.mass / b->sums.mass) /
                                      log((double)b->result.n / (double)a->result.n),
                                  1e-10);
                }
            }
            json_decref(orders);
        }
}

/* Of snapshots of the same time and n the one given first counts. */
TEST(snapshots_of_one_time)
{
    struct judged judged[4] = {made(50, 0.1, 2), made(50, 0.2, 2), made(50, 0.2, 2),
                               made(50, 0.1, 2)};
    struct trace_drift drift;
    size_t pair[2];
    assert_ptr_equal(judge_main(judged, 4), &judged[1]);
    assert_true(judge_drift(judged, 4, &drift, pair));
    assert_int_equal(pair[0], 0);
    assert_int_equal(pair[1], 1);
    for (int f = 0; f < FIELDS; f++)
        judged[0].result.errors[f].l1 = judged[2].result.errors[f].l1 = 1e9;
    struct judged levels[3] = {judged[1], judged[2], made(60, 0.2, 2)};
    json_t *of_three = judge_orders(levels, 3), *of_first = NULL;
    levels[1] = levels[2];
    of_first = judge_orders(levels, 2);
    assert_true(json_array_size(of_first) == FIELDS && json_equal(of_three, of_first));
    json_decref(of_three), json_decref(of_first);
    judged[2] = made(60, 0.2, 2);
    json_t *orders = judge_orders(judged, 4), *other = judge_orders(judged + 1, 3);
    assert_true(json_equal(orders, other)); /* orders leave out the snapshot of an earlier time */
    json_decref(orders);
    json_decref(other);
}

/* Errors proportional to a power of the spacing have that order, in any dimension. */
TEST(orders)
{
    enum { SLAB = 4 }; /* a flow in 2D in a slab with as many layers as rows */
    for (int dim = 1; dim <= SLAB; dim++)
        for (int count = 2; count <= MOST; count++) {
            struct judged judged[MOST];
            for (int i = 0; i < count; i++) {
                const size_t side = (size_t)(10 + 3 * i);
                judged[i] = made(dim == 1   ? side
                                 : dim == 2 ? side * side
                                            : side * side * side,
                                 0.2, dim == SLAB ? 2 : dim);
                judged[i].slab = dim == SLAB;
                judged[i].case_n = dim == SLAB ? (double)(side * side) : -1;
                for (int f = 0; f < FIELDS; f++)
                    judged[i].result.errors[f].l1 = pow((double)side, -0.5 * (f + 1));
            }
            json_t *found = judge_orders(judged, (size_t)count);
            assert_int_equal(json_array_size(found), FIELDS);
            for (int f = 0; f < FIELDS; f++) {
                const json_t *one = json_array_get(found, (size_t)f);
                const json_t *pairwise = json_object_get(one, "pairwise");
                for (int i = 0; i + 1 < count; i++)
                    near_relative(json_real_value(json_array_get(pairwise, (size_t)i)),
                                  0.5 * (f + 1), 1e-12);
                assert_string_equal(value_text(one, "norm"), "l1");
                if (count < 4) {
                    assert_true(json_is_null(json_object_get(one, "order")));
                    assert_true(json_is_null(json_object_get(one, "low")));
                    assert_true(json_is_null(json_object_get(one, "high")));
                    assert_string_equal(value_text(one, "class"), "too few levels");
                    continue;
                }
                near_relative(value_member(one, "order"), 0.5 * (f + 1), 1e-12);
                near_relative(value_member(one, "low"), 0.5 * (f + 1), 1e-6);
                near_relative(value_member(one, "high"), 0.5 * (f + 1), 1e-6);
                assert_string_equal(value_text(one, "class"), "asymptotic");
            }
            json_decref(found);
            problem.fieldless = true;
            found = judge_orders(judged, (size_t)count);
            assert_int_equal(json_array_size(found), 0);
            json_decref(found);
            char why[JUDGE_WHY] = "";
            judged[0].result.time = 7; /* there are no orders to refuse */
            assert_true(judge_one_ladder(judged, (size_t)count, why));
            problem.fieldless = false;
            assert_false(judge_one_ladder(judged, (size_t)count, why));
            static struct problem bare = {.fieldless = true}; /* of the fewest particles alone */
            judged[0].result.problem.problem = &bare;
            assert_true(judge_one_ladder(judged, (size_t)count, why));
            found = judge_orders(judged, (size_t)count);
            assert_int_equal(json_array_size(found), 0);
            json_decref(found);
        }
}

/* ---- gates ---- */

/* Returns the findings; NULL if refused with this message. */
static json_t *gate(const char *text, const struct judged *judged, size_t n, const char *says)
{
    struct error error = {0};
    json_t *found = NULL;
    const enum status status = judge_gates(text, false, judged, n, &found, &error);
    if (!says && status) fail_msg("%s: %s", text ? text : "none", error.message);
    if (says && (status != STATUS_BAD_INPUT || !strstr(error.message, says)))
        fail_msg("%s: '%s' is not in: %s", text ? text : "none", says, error.message);
    if (!says) return found;
    json_decref(found);
    return NULL;
}

/* Snapshots of different problems have neither orders nor a conservation error. */
static const struct {
    const char *of_case;
    enum setting key; /* that differs from the first */
    const char *value;
    int dim;
    double gamma, time;
    const char *says; /* NULL: the same problem as the first */
} problems[] = {
    {"sod", SETTING_left, "1 0 1", 1, 1.4, 0.2, NULL},
    {"sod", SETTING_seed, "2", 1, 1.4001, 0.2001, NULL}, /* the seed only sets positions */
    {"sod", SETTING_eta, "3", 1, 1.4, 0.2, NULL},
    {"sod", SETTING_boundary, "open", 1, 1.4, 0.2, NULL},
    {"lax", SETTING_left, "1 0 1", 1, 1.4, 0.2, "the case is sod in made and lax in other"},
    {"sod", SETTING_left, "1 0 1", 2, 1.4, 0.2,
     "the number of dimensions is 1 in made and 2 in other"},
    {"sod", SETTING_left, "1 0 1", 1, 1.6, 0.2, "gamma is 1.4 in made and 1.6 in other"},
    {"sod", SETTING_left, "1 0 2", 1, 1.4, 0.2, "left is 1 0 1 in made and 1 0 2 in other"},
    {"sod", SETTING_gravity, "1 0", 1, 1.4, 0.2, "gravity is 0 in made and 1 0 in other"},
    {"sod", SETTING_file, "a.csv", 1, 1.4, 0.2, "file is  in made and a.csv in other"},
    {"sod", SETTING_boost, "1 0", 1, 1.4, 0.2, "boost is 0 in made and 1 0 in other"},
    {"sod", SETTING_left, "1 0 1", 1, 1.4, 0.14, "the time is 0.2 in made and 0.14 in other"},
};

static struct judged judged_of(size_t k, size_t n)
{
    struct judged judged = made(n, problems[k].time, problems[k].dim);
    struct settings *settings = &judged.run.asked.settings;
    struct error error = {0};
    settings_init(settings);
    if (settings_set(settings, SETTING_left, "1 0 1", SOURCE_USER, NULL, &error) ||
        settings_set(settings, problems[k].key, problems[k].value, SOURCE_USER, NULL, &error))
        fail_msg("%s", error.message);
    strcpy(judged.run.asked.file.name, problems[k].of_case);
    judged.result.problem.gamma = problems[k].gamma;
    if (k) judged.path = "other";
    return judged;
}

TEST(other_problems)
{
    problem = (struct problem){0};
    for (size_t k = 0; k < sizeof problems / sizeof *problems; k++)
        for (size_t other = 1; other < 4; other++) {
            struct judged judged[4];
            struct trace_drift drift;
            size_t pair[2];
            char why[JUDGE_WHY] = "";
            for (size_t i = 0; i < 4; i++) judged[i] = judged_of(i == other ? k : 0, 100u << i);
            assert_true(judge_one_ladder(judged, 4, why) == !problems[k].says);
            assert_string_equal(why, problems[k].says ? problems[k].says : "");
            json_t *orders = judge_orders(judged, 4);
            assert_int_equal(json_array_size(orders), problems[k].says ? 0 : FIELDS);
            json_decref(orders);
            if (!problems[k].says) continue;
            gate("order.density>=0.1", judged, 4, problems[k].says);
            judged[other].result.n = judged[0].result.n;
            judged[other].result.time = 0.3;
            assert_true(judge_drift(judged, 4, &drift, pair) == (problems[k].time < 0.2));
        }
}

static const char *status_at(const json_t *gates, size_t k)
{
    return value_text(json_array_get(gates, k), "status");
}

TEST(gates)
{
    static const char *const fields[] = {"density",         "velocity",  "pressure",
                                         "internal_energy", "azimuthal", "radial"},
                             *const norms[] = {"l1", "l2", "linf", "particle_mean", "l1_whole"};
    struct judged judged = made(50, 0.2, 2);
    for (int f = 0; f < 6; f++) {
        struct norms *of = f < FIELDS    ? &judged.result.errors[f]
                           : f == FIELDS ? &judged.result.azimuthal
                                         : &judged.result.radial;
        *of = (struct norms){f + 1.1, f + 1.2, f + 1.3, f + 1.4, f + 1.5, 7};
    }
    for (int circular = 0; circular < 2; circular++)
        for (int f = 0; f < 6; f++)
            for (int k = 0; k < 5; k++) {
                const double value = f + 1.1 + 0.1 * k;
                char text[600], name[60];
                problem.circular = circular ? CIRCULAR_ROUND : CIRCULAR_NOT;
                snprintf(name, sizeof name, "%s_%s", fields[f], norms[k]);
                snprintf(text, sizeof text, "%s=%.17g", name, value);
                if (f >= FIELDS && !circular) {
                    gate(text, &judged, 1, "nothing here is called so");
                    continue;
                }
                json_t *found = gate(text, &judged, 1, NULL);
                assert_int_equal(json_array_size(found), 1);
                const json_t *one = json_array_get(found, 0);
                assert_string_equal(value_text(one, "name"), name);
                assert_string_equal(value_text(one, "source"), "--gate");
                const double exact = value_member(one, "value");
                near_relative(exact, value, 1e-15);
                json_decref(found);
                const double less = nextafter(exact, 0), more = nextafter(exact, 10);
                snprintf(text, sizeof text, "%s=%.17g,%s<=%.17g,%s=%.17g,%s>=%.17g,%s>=%.17g", name,
                         exact, name, less, name, less, name, exact, name, more);
                found = gate(text, &judged, 1, NULL);
                for (size_t g = 0; g < 5; g++)
                    assert_string_equal(status_at(found, g), g == 0 || g == 3 ? "pass" : "fail");
                json_decref(found);
            }
    judged.result.errors[0].l1 = (double)NAN;
    json_t *found = gate("density_l1=1e300,density_l1>=1e-300", &judged, 1, NULL);
    for (size_t g = 0; g < 2; g++) assert_string_equal(status_at(found, g), "fail");
    json_decref(found);
    found = gate(NULL, &judged, 1, NULL);
    assert_int_equal(json_array_size(found), 0);
    json_decref(found);
    static const struct {
        const char *text, *says;
    } wrong[] = {
        {"", "NAME=BOUND,..."}, /* an empty variable in a script must not pass as a gate */
        {"density_l1", "NAME=BOUND,..."},
        {"density_l1,velocity_l1=1", "NAME=BOUND,..."},
        {"velocity_l1=1,,pressure_l1=1", "NAME=BOUND,..."},
        {"velocity_l1=1,x", "NAME=BOUND,..."},
        {"density_l1<==1", "NAME=BOUND,..."},
        {"=1", "nothing here is called so; allowed: density_l1 velocity_l1 pressure_l1"},
        {"l1=1", "nothing here"},
        {"density=1", "nothing here"},
        {"density_l3=1", "nothing here"},
        {"density_l1x=1", "nothing here"},
        {"order.density>=1", "several numbers of particles"},
        {"density_l1<1", "allowed: = <= >="},
        {"density_l1=>1", "allowed: = <= >="},
        {"order.density=1", "gated by >= or <="},
        {"order.density>=x", "allowed: a number"},
        {"density_l1=0", "allowed: above 0"},
        {"density_l1=-1", "allowed: above 0"},
        {"density_l1=", "allowed: above 0"},
        {"density_l1=a", "allowed: above 0"},
        {"density_l1=nan", "allowed: above 0"},
        {"density_l1>=inf", "allowed: above 0"},
        {"velocity_l1=1,density_l1=1x", "allowed: above 0"},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++)
        gate(wrong[k].text, &judged, 1, wrong[k].says);
    /* the longest names and bounds */
    char text[200];
    snprintf(text, sizeof text, "velocity_l1=1.%0*d", 37, 0); /* a bound of 39 characters */
    json_decref(gate(text, &judged, 1, NULL));
    snprintf(text, sizeof text, "velocity_l1=1.%0*d", 38, 0);
    gate(text, &judged, 1, "NAME=BOUND,...");
    snprintf(text, sizeof text, "%047d=1", 0);
    gate(text, &judged, 1, "nothing here");
    snprintf(text, sizeof text, "%048d=1", 0);
    gate(text, &judged, 1, "NAME=BOUND,...");
}

/* Gates on other figures: values, parts of an error, noise, conserved quantities. */
TEST(gates_on_other_figures)
{
    static const struct regions regions = {.names = {"fan", "shock"}};
    struct judged judged = made(50, 0.2, 2);
    problem.circular = CIRCULAR_NOT;
    judged.result.functional_count = 2;
    judged.result.functionals[0] = (struct run_functional){"peak", 3, 3.5};
    judged.result.functionals[1] = (struct run_functional){"middle", 7, (double)NAN};
    judged.result.budget.regions = &regions;
    judged.result.budget.l1[0][FIELD_DENSITY] = 0.5, judged.result.budget.l1[1][FIELD_DENSITY] = 2;
    judged.transverse = 0.125;
    judged.start = judged.sums;
    judged.start.mass *= 0.5;
    judged.start.energy *= 0.8;
    judged.start.momentum[0] = 0, judged.start.angular_momentum[2] = 0;
    static const struct {
        const char *name;
        double value;
    } known[] = {{"peak", 0.5},           {"middle", 7},     {"density_l1.fan", 0.5},
                 {"density_l1.shock", 2}, {"noise", 0.125},  {"mass", 1},
                 {"energy", 0.25},        {"momentum", 0.1}, {"angular_momentum", 0.25}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        char text[200];
        snprintf(text, sizeof text, "%s=%.17g,%s=%.17g", known[k].name, known[k].value * 1.0001,
                 known[k].name, known[k].value * 0.9999);
        json_t *found = gate(text, &judged, 1, NULL);
        assert_string_equal(status_at(found, 0), "pass");
        assert_string_equal(status_at(found, 1), "fail");
        json_decref(found);
    }
    judged.start.mass = 0; /* the start is unknown */
    gate("mass=1", &judged, 1, "nothing here");
    judged.file.dim = 1;
    gate("noise=1", &judged, 1, "nothing here");
}

/* An order passes if its whole interval does, and fails if no part of it does. */
TEST(gates_of_orders)
{
    struct judged judged[MOST];
    char text[200];
    for (int i = 0; i < MOST; i++) {
        judged[i] = made((size_t)(100 << i), 0.2, 1);
        for (int f = 0; f < FIELDS; f++)
            judged[i].result.errors[f].l1 = (1 + 0.05 * (i % 2)) * pow(2, -i);
    }
    json_t *orders = judge_orders(judged, MOST);
    const json_t *one = json_array_get(orders, FIELD_VELOCITY);
    const double low = value_member(one, "low"), high = value_member(one, "high");
    assert_true(low < 0.99 && high > 1);
    for (int least = 0; least < 2; least++) {
        const char *sign = least ? ">=" : "<=";
        snprintf(text, sizeof text,
                 "order.velocity%s%.17g,order.velocity%s%.17g,"
                 "order.velocity%s%.17g,order.velocity%s%.17g",
                 sign, low - 0.01, sign, low + 0.01, sign, high - 0.01, sign, high + 0.01);
        json_t *found = gate(text, judged, MOST, NULL);
        assert_string_equal(status_at(found, 0), least ? "pass" : "fail");
        assert_string_equal(status_at(found, 1), "undetermined");
        assert_string_equal(status_at(found, 2), "undetermined");
        assert_string_equal(status_at(found, 3), least ? "fail" : "pass");
        const json_t *first = json_array_get(found, 1);
        assert_true(value_member(first, "low") == low && value_member(first, "high") == high);
        assert_non_null(strstr(value_text(first, "why"), "interval"));
        json_decref(found);
        snprintf(text, sizeof text, "order.velocity%s%.17g,order.velocity%s%.17g", sign, low, sign,
                 high);
        found = gate(text, judged, MOST, NULL);
        assert_string_equal(status_at(found, !least), "pass"); /* at one end of the interval */
        assert_string_equal(status_at(found, (size_t)least), "undetermined");
        json_decref(found);
    }
    judged[2].result.errors[0].l1 = 0;
    for (size_t n = 3; n <= 4; n++) {
        json_t *found = gate("order.density>=0.1", judged, n, NULL);
        assert_string_equal(status_at(found, 0), "undetermined");
        assert_string_equal(value_text(json_array_get(found, 0), "why"),
                            n < 4 ? "an interval needs 4 numbers of particles, there are 3"
                                  : "an error is 0 or unknown");
        json_decref(found);
    }
    json_decref(orders);
}

/* The source of a bound says how it follows from the case's, and its ladder if there is one. */
TEST(sources_of_bounds)
{
    static const struct {
        double n, finer; /* over the finest n; over the bound */
        bool no_ladder;
        double low, raised; /* the order; the bound over the case's */
        const char *says;
    } rows[] = {
        {1, 0, false, 1, 1, "case leblanc: 0.0375 at n = 1600"},
        {0.25, 0, false, 1, 4, "case leblanc: 0.0375 at n = 1600, raised by order 1 to n = 400"},
        {0.25, 0, false, 0, 1, "case leblanc: 0.0375 at n = 1600"},
        {2, 0, false, 1, 1, "case leblanc: 0.0375 at n = 1600"},
        {2, 0.5, false, 1, 0.5, "case leblanc: 0.0375 at n = 1600, beyond it 0.0187"},
        {2, 2, false, 1, 2, "case leblanc: 0.0375 at n = 1600, beyond it 0.075"},
        {0.25, 0, true, 1, 1, "case leblanc: 0.0375"}};
    struct judged judged = {.path = "made", .case_dim = 1, .file = {.layout = "made", .dim = 1}};
    struct run_settings *asked = &judged.run.asked;
    struct error error = {0};
    *asked = keyed_case("leblanc", "");
    struct case_file *file = &asked->file;
    struct case_gate *gate = &file->gates[1];
    const size_t levels = file->ladder_count;
    *gate = file->gates[0];
    file->ladder[levels - 1] = 1600, gate->gate.bound = 0.0375;
    file->gates[0] = (struct case_gate){.functional = "peak"}; /* has no exact value: no gate */
    file->gate_count = 2;
    judged.result.problem.problem = problem_of(&asked->settings);
    judged.result.time = settings_real(&asked->settings, SETTING_t_end);
    judged.result.functional_count = 1;
    judged.result.functionals[0] = (struct run_functional){"peak", 3, (double)NAN};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        json_t *gates;
        file->ladder_count = rows[k].no_ladder ? 0 : levels;
        gate->gate.low = rows[k].low;
        gate->finer = gate->gate, gate->finer.bound *= rows[k].finer;
        judged.case_n = 1600 * rows[k].n, judged.result.n = (size_t)judged.case_n;
        if (judge_gates(NULL, true, &judged, 1, &gates, &error)) fail_msg("%s", error.message);
        assert_int_equal(json_array_size(gates), 1);
        const json_t *one = json_array_get(gates, 0);
        assert_string_equal(value_text(one, "source"), rows[k].says);
        near_relative(value_member(one, "bound"), 0.0375 * rows[k].raised, 1e-12);
        json_decref(gates);
    }
}

/* With several n the case's gates of orders of L1 apply as well; a known weakness excuses those
 * that do not pass. Conservation of angular momentum is gated in round flows only. */
TEST(orders_of_a_case)
{
    enum { LEVELS = 4 };
    static const struct {
        double order;
        enum norm norm;
        const char *functional, *known;
        bool no_order, round; /* no_order: the case gates the error alone */
        const char *says;     /* status of the order; NULL: it is not gated */
    } rows[] = {{0.95, NORM_L1, NULL, "", false, false, "pass"},
                {0.85, NORM_L1, NULL, "", false, true, "fail"},
                {0.95, NORM_L1, NULL, "why not", false, false, "pass"},
                {0.85, NORM_L1, NULL, "why not", false, false, "known"},
                {0.95, NORM_L2, NULL, "", false, false, NULL},
                {0.95, NORM_L1, "peak", "", false, false, NULL},
                {0.95, NORM_L1, NULL, "", true, false, NULL}};
    static struct problem flow;
    static struct judged judged[LEVELS];
    struct error error = {0};
    struct run_settings asked = keyed_case("leblanc", "");
    flow = *problem_of(&asked.settings);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct case_gate *gate = &asked.file.gates[0];
        asked.file.gate_count = 1;
        gate->norm = rows[k].norm, gate->functional = rows[k].functional;
        gate->gate.low = 0.9, gate->gate.high = rows[k].no_order ? (double)INFINITY : 1.1;
        snprintf(gate->known.why, sizeof gate->known.why, "%s", rows[k].known);
        flow.circular = rows[k].round ? CIRCULAR_ROUND : CIRCULAR_NOT;
        for (int i = 0; i < LEVELS; i++) {
            judged[i] = (struct judged){.path = "made", .case_dim = 2};
            judged[i].file = (struct snapshot_file){.layout = "made", .dim = 2};
            judged[i].run.asked = asked;
            judged[i].result.problem.problem = &flow;
            judged[i].result.time = settings_real(&asked.settings, SETTING_t_end);
            judged[i].result.n = (size_t)(100 << 2 * i), judged[i].case_n = 100 << 2 * i;
            judged[i].result.errors[FIELD_DENSITY].l1 = pow(2, -rows[k].order * i);
            judged[i].sums = judged[i].start = (struct conservation){.mass = 1,
                                                                     .energy = 1,
                                                                     .momentum_scale = 1,
                                                                     .sound_scale = 1,
                                                                     .angular_scale = 1,
                                                                     .turning_scale = 1};
            judged[i].sums.mass = 1.0025; /* more than other starts may differ by */
        }
        json_t *gates;
        if (judge_gates(NULL, true, judged, LEVELS, &gates, &error)) fail_msg("%s", error.message);
        const char *order = NULL, *mass = NULL, *energy = NULL, *angular = NULL;
        for (size_t g = 0; g < json_array_size(gates); g++) {
            const json_t *one = json_array_get(gates, g);
            const char *name = value_text(one, "name");
            const double bound = value_member(one, "bound");
            if (!strcmp(name, "order.density")) order = status_at(gates, g);
            if (!strcmp(name, "order.density")) assert_true(bound == 0.9);
            if (!strcmp(name, "mass")) mass = status_at(gates, g);
            if (!strcmp(name, "mass")) assert_true(bound == 2e-3);
            if (!strcmp(name, "energy")) energy = status_at(gates, g);
            if (!strcmp(name, "angular_momentum")) angular = status_at(gates, g);
            if (!strcmp(name, "angular_momentum")) assert_true(bound == 0.02);
            if (!strcmp(name, "order.density") && !strcmp(order, "known"))
                assert_string_equal(value_text(one, "why"), "why not");
        }
        if (!rows[k].says != !order || (order && strcmp(order, rows[k].says)))
            fail_msg("row %zu: %s", k, order ? order : "none");
        assert_string_equal(mass, "fail");
        assert_string_equal(energy, "pass");
        assert_true(!angular == !rows[k].round);
        json_decref(gates);
    }
    judged[1].result.time *= 1.01;
    json_t *gates;
    assert_int_equal(judge_gates(NULL, true, judged, LEVELS, &gates, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "--gates case: no orders: the time is "));
    json_decref(gates);
}

/* A case's gates apply near its time and to its own initial state; a known weakness without a
 * number allows 1.5 times the bound. */
TEST(gates_of_a_case)
{
    static const struct {
        double error, late; /* error over the bound; difference of time over the time */
        bool altered, plane;
        const char *says; /* status of the gate, or a refusal */
    } rows[] = {{0.999, 0, false, false, "pass"},
                {1.4999999, 0.0099, false, false, "known"},
                {1.5000001, -0.0099, false, false, "fail"},
                {0.5, 0.0101, false, false, "are for t = "},
                {0.5, -0.0101, false, false, "are for t = "},
                {0.5, 0, true, false, "another initial state"},
                {0.5, 0, false, true, "is written in 1 dimensions and has no bounds for 2"}};
    struct judged judged = {.path = "made"};
    struct run_settings *asked = &judged.run.asked;
    struct error error = {0};
    *asked = keyed_case("leblanc", "");
    const struct case_gate *gate = &asked->file.gates[0];
    const double t_end = settings_real(&asked->settings, SETTING_t_end);
    assert_true(isinf(gate->known.bound) && gate->field == FIELD_DENSITY);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        json_t *gates;
        judged.file = (struct snapshot_file){.layout = "made", .dim = rows[k].plane ? 2 : 1};
        judged.case_dim = 1, judged.altered = rows[k].altered;
        judged.case_n = (double)asked->file.ladder[asked->file.ladder_count - 1];
        judged.result.problem.problem = problem_of(&asked->settings);
        judged.result.n = (size_t)judged.case_n;
        judged.result.time = t_end * (1 + rows[k].late);
        judged.result.errors[FIELD_DENSITY].l1 = rows[k].error * gate->gate.bound;
        const enum status status = judge_gates(NULL, true, &judged, 1, &gates, &error);
        const char *says = status ? error.message : status_at(gates, 0);
        if (status ? !strstr(says, rows[k].says) : strcmp(says, rows[k].says) != 0)
            fail_msg("row %zu: %s", k, says);
        json_decref(gates);
    }
}
