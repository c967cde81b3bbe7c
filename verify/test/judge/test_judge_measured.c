/* SPDX-License-Identifier: GPL-3.0-or-later
 * Judges random snapshots and compares the results with a plain calculation: the gas is that of the
 * file, in order and inside the box, and so is its distance from the solution. */
#include "test.h"

#include "judge_autopsy.h"
#include "sample_snapshot.h"

static const struct {
    const char *name;
    double time;
    int dim;
} cases[] = {{"sod", 0.2, 1},           {"lax", 0.1, 1},       {"two_rarefactions", 0.1, 1},
             {"sod_standard", 0.15, 1}, {"sod_2d", 0.1, 2},    {"gresho", 0.5, 2},
             {"noh_2d", 0.4, 2},        {"sedov_2d", 0.05, 2}, {"rest_2d", 0.1, 2},
             {"sound_wave", 0.1, 1},    {"noh_3d", 0.3, 3},    {"shear", 0.01, 2}};

/* The gas of the case at random positions in its box, with random errors. */
static void fill_in(size_t k, const struct prepared *p, double noise)
{
    const struct domain box = p->domain;
    const double off = draw(0, 1) < 0.5 ? 0 : draw(-noise, noise);
    const int field = (int)draw(0, FIELDS);
    char *head = gas.head + sprintf(gas.head, "# time = %.17g\n# box =", cases[k].time);
    for (int d = 0; d < box.dim; d++) head += sprintf(head, " %.17g:%.17g", box.lo[d], box.hi[d]);
    sprintf(head, "\n");
    gas.dim = cases[k].dim, gas.has_u = gas.has_P = gas.has_h = true;
    for (int i = 0; i < N; i++) {
        struct problem_state s;
        double x[3] = {0};
        const double part = i % 2 ? 0.15 : 1; /* half of them are near the middle */
        for (int d = 0; d < box.dim; d++)
            gas.x[d][i] = x[d] =
                0.5 * (box.lo[d] + box.hi[d]) + part * draw(-0.5, 0.5) * (box.hi[d] - box.lo[d]);
        problem_sample(p, x, cases[k].time, &s);
        double *of[] = {&s.rho, &s.v[0], &s.P, &s.u};
        if (field == FIELD_VELOCITY)
            s.v[0] += off;
        else
            *of[field] *= 1 + off;
        for (int d = 0; d < box.dim; d++) gas.v[d][i] = s.v[d] + noise * draw(-0.1, 0.1);
        gas.m[i] = noise > 0.1 ? draw(1, 2) / N : 1. / N;
        gas.rho[i] = s.rho * (1 + noise * draw(-0.1, 0.1)) + 1e-9;
        gas.u[i] = s.u * (1 + noise * draw(-0.1, 0.1)) + 1e-9;
        gas.P[i] = s.P * (1 + noise * draw(-0.1, 0.1)) + 1e-9;
        gas.h[i] = draw(0.05, 0.1) * (box.hi[0] - box.lo[0]);
    }
}

/* ---- the gas that is compared ---- */

static int before(int i, int j)
{
    return gas.x[0][i] < gas.x[0][j];
}

static void is_compared(const struct judged *judged, double ratio)
{
    const struct snapshot *s = &judged->result.snapshot;
    const int dim = gas.dim;
    assert_int_equal(s->n, N);
    assert_true(s->time == judged->file.time.value);
    for (int i = 0; i < N; i++) {
        int at = i;
        for (int j = 0; dim == 1 && j < N; j++) at += j == 0 ? before(j, i) - i : before(j, i);
        const size_t k = (size_t)at;
        for (int d = 0; d < dim; d++) {
            near_absolute(s->x[d][k], gas.x[d][i], 1e-14 * fabs(judged->file.box[d]));
            assert_true(s->v[d][k] == gas.v[d][i]);
        }
        for (int d = dim; d < 3; d++) assert_true(!s->x[d] && !s->v[d]);
        assert_true(s->m[k] == gas.m[i] && s->rho[k] == gas.rho[i] && s->u[k] == gas.u[i]);
        assert_true(s->P[k] == gas.P[i]);
        near_relative(s->volume[k], gas.m[i] / gas.rho[i], 1e-15);
        near_relative(s->h[k],
                      ratio > 0 ? ratio * gas.h[i] : 2 * pow(gas.m[i] / gas.rho[i], 1. / dim),
                      1e-14);
    }
}

/* ---- distance from the solution ---- */

static double size_of(const double v[3], int dim)
{
    double squares = 0;
    for (int d = 0; d < dim; d++) squares += v[d] * v[d];
    return sqrt(squares);
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The value of a field; for velocities beyond 1D their magnitude. */
static double value_of(const struct problem_state *s, int field, int dim)
{
    const double values[] = {s->rho, dim > 1 ? size_of(s->v, 3) : s->v[0], s->P, s->u};
    return values[field];
}

/* The median error of particles that the flow has changed, away from jumps, over the range; if
 * there are fewer than 8, of all particles away from jumps, unless the flow consists of jumps. */
static double part_of(const struct judged *judged, int field)
{
    const struct prepared *p = &judged->run.problem;
    const struct snapshot *s = &judged->result.snapshot;
    const struct regions *regions = p->problem->regions;
    const int dim = p->domain.dim;
    double errors[2][N], lo = INFINITY, hi = -INFINITY, sound = 0, motion = 0;
    size_t n[2] = {0, 0};
    for (size_t i = 0; i < N; i++) {
        struct problem_state now, start;
        double x[3] = {0}, v[3] = {0};
        for (int d = 0; d < dim; d++) x[d] = s->x[d][i];
        if (!window_contains(&p->window, x)) continue;
        problem_sample(p, x, judged->result.time, &now);
        problem_sample(p, x, 0, &start);
        const double value = value_of(&now, field, dim), speed = size_of(now.v, 3);
        const double found[] = {s->rho[i], 0, s->P[i], s->u[i]};
        lo = fmin(lo, value), hi = fmax(hi, value);
        sound = fmax(sound, sqrt(p->gamma * now.P / now.rho));
        motion = fmax(motion, (field == FIELD_PRESSURE ? now.rho : 1) * speed * speed);
        const char *where =
            regions ? regions->names[regions->at(p, x, 3 * s->h[i], judged->result.time)] : "";
        if (!strcmp(where, "shock") || !strcmp(where, "contact")) continue;
        for (int d = 0; d < dim; d++) v[d] = s->v[d][i] - now.v[d];
        const double error = field == FIELD_VELOCITY ? size_of(v, dim) : fabs(found[field] - value);
        errors[1][n[1]++] = error;
        if (fabs(value - value_of(&start, field, dim)) > 1e-3 * fabs(value))
            errors[0][n[0]++] = error;
    }
    const double size = fmax(fabs(lo), fabs(hi));
    double range = fmax(hi - lo, size * (hi - lo > 1e-9 * size ? 0.2 : 0.5));
    if (field == FIELD_VELOCITY && range == 0) range = sound;
    if (field == FIELD_PRESSURE || field == FIELD_INTERNAL_ENERGY) range = fmax(range, motion / 10);
    const int all = n[0] < 8;
    const double mean = judged->result.errors[field].l1 / range * 0.06 / 0.2;
    if (n[all] < 8 || (all && regions)) return mean;
    qsort(errors[all], n[all], sizeof **errors, by_size);
    return fmax(mean, errors[all][n[all] / 2] / range);
}

static void is_wrong_by(const struct judged *judged)
{
    double most = 0;
    int field = 0;
    for (int f = 0; f < FIELDS; f++) {
        const double part = part_of(judged, f);
        if (part > most) most = part, field = f;
    }
    near_relative(judged->wrong, most, 1e-12);
    assert_int_equal(judged->wrong_field, field);
    assert_true(judged->far == (most > 0.06));
    assert_true(judged->passes == !judged->foreign);
    for (size_t k = 0; k < judged->file.notes.count; k++) {
        const struct snapshot_note *note = &judged->file.notes.note[k];
        if (strcmp(note->what, "solution")) continue;
        char says[120];
        snprintf(says, sizeof says, "%s is off also away from jumps, by %.2g times",
                 field_family.members[field]->name, most / 0.06);
        assert_true(judged->far && strstr(note->evidence, says) == note->evidence);
        assert_string_equal(note->value, "far from this case's");
        return;
    }
    assert_false(judged->far);
}

static void verdict_is(const struct judged *judged, const char *kernel)
{
    char says[300];
    const struct run_result *r = &judged->result;
    snprintf(says, sizeof says, "%sL1 of density %.3g, velocity %.3g, pressure %.3g; %s",
             judged->far ? "far from the solution of this case: " : "", r->errors[FIELD_DENSITY].l1,
             r->errors[FIELD_VELOCITY].l1, r->errors[FIELD_PRESSURE].l1, kernel);
    /* for a foreign snapshot also the reason, and other cases that may fit */
    if (judged->foreign ? !strstr(judged->verdict, says) : strcmp(judged->verdict, says))
        fail_msg("%s: not: %s", judged->verdict, says);
}

TEST(random_snapshots)
{
    int far = 0, draws = 0;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        for (int twice = 0; twice < 2; twice++) {
            const double noise = pow(10, draw(-2, 0));
            const int kernel = (int)floor(draw(-1, 4));
            struct judge_request request = {.case_name = cases[k].name, .kernel = kernel};
            const struct run run = keyed_run(cases[k].name, "");
            char name[80] = "kernel not identifiable";
            fill_in(k, &run.problem, noise);
            if (kernel >= 0) request.width.ratio = 1 + 0.25 * kernel;
            struct judged judged = judges(&request);
            const struct convention *best = &judged.conventions.candidate[0];
            assert_true(judged.conventions.known == (kernel >= 0));
            if (kernel >= 0) {
                snprintf(name, sizeof name, "%s with H = %.6g h", best->kernel.member.name,
                         request.width.ratio);
                assert_true(best->ratio == request.width.ratio);
                assert_string_equal(best->kernel.member.name, kernel_family.members[kernel]->name);
            }
            is_compared(&judged, kernel >= 0 ? request.width.ratio : 0);
            is_wrong_by(&judged);
            verdict_is(&judged, name);
            snprintf(name, sizeof name, "%s, support radius %.6g h", best->kernel.member.name,
                     request.width.ratio);
            assert_string_equal(note(&judged, "kernel")->value,
                                kernel >= 0 ? name : "not identifiable");
            assert_string_equal(note(&judged, "kernel")->evidence, judged.conventions.why);
            if (kernel >= 0) {
                assert_string_equal(note(&judged, "density")->value,
                                    best->sum == DENSITY_MASSES ? "sum of m_j W_ij"
                                                                : "m_i times the sum of W_ij");
                assert_string_equal(note(&judged, "density")->evidence,
                                    noise <= 0.1 ? "masses are equal: the other sum is the same"
                                    : judged.conventions.any_sum
                                        ? "or the other sum: masses hardly differ, both fit"
                                        : judged.conventions.why);
            }
            far += judged.far, draws++;
            judge_free(&judged);
        }
    assert_true(far > 4 && far < draws - 4);
}

/* In cold and fast gas, errors of pressure and energy are relative to the values that stopping the
 * gas would give. */
TEST(cold_gas)
{
    struct judge_request request = uniform_gas();
    request.left = request.right = "4 3 0.001";
    plant(1, 0, boxes[1]);
    gas.has_P = true;
    for (int i = 0; i < N; i++) {
        gas.rho[i] = 4, gas.v[0][i] = 3, gas.P[i] = draw(0, 0.5);
        gas.u[i] = gas.P[i] / (0.4 * gas.rho[i]);
    }
    struct judged judged = judges(&request);
    is_wrong_by(&judged);
    assert_int_equal(judged.wrong_field, FIELD_INTERNAL_ENERGY);
    judge_free(&judged);
}

/* An autopsy takes the snapshot's widths in units of its particle spacings. */
TEST(widths_of_an_autopsy)
{
    static const struct {
        const char *name;
        int dim;
    } flows[] = {{"sound_wave", 1}, {"yee", 2}};
    for (size_t k = 0; k < sizeof flows / sizeof *flows; k++) {
        struct judge_request request = {.case_name = flows[k].name, .width.ratio = 1.5};
        struct autopsy_level level;
        const struct run run = keyed_run(flows[k].name, "");
        struct run used;
        struct error error = {0};
        char nine_digits[40];
        double eta = 0;
        const struct domain *box = &run.problem.domain;
        plant(flows[k].dim, 0, "# time = 0\n");
        gas.has_h = true;
        for (int i = 0; i < N; i++) {
            struct problem_state s;
            double x[3] = {0}, volume = 1. / N;
            for (int d = 0; d < gas.dim; d++) {
                x[d] = box->lo[d] + draw(0, 1) * domain_length(box, d);
                gas.x[d][i] = x[d], volume *= domain_length(box, d);
            }
            problem_sample(&run.problem, x, 0, &s);
            for (int d = 0; d < gas.dim; d++) gas.v[d][i] = s.v[d];
            gas.rho[i] = s.rho, gas.u[i] = s.u, gas.m[i] = s.rho * volume;
            gas.h[i] = draw(1.9, 2.1) * pow(volume, 1. / gas.dim);
            eta += 1.5 * gas.h[i] / pow(gas.m[i] / gas.rho[i], 1. / gas.dim) / N;
        }
        struct judged judged = judges(&request);
        assert_true(judged.conventions.known);
        judged.conventions.candidate[1].kernel.member.name = "wendland_c2"; /* fits less well */
        if (judge_autopsy(&judged, &level, &used, &error)) fail_msg("%s", error.message);
        snprintf(nine_digits, sizeof nine_digits, "%.9g", eta);
        assert_true(settings_real(&used.settings, SETTING_eta) == atof(nine_digits));
        assert_string_equal(
            kernel_family.members[settings_choice(&used.settings, SETTING_kernel)]->name,
            judged.conventions.candidate[0].kernel.member.name);
        judge_free(&judged);
    }
    /* a width that the file's run was asked for is kept */
    for (int key = 0; key < 2; key++) {
        static const char *const keys[] = {"eta=3", "kernel=wendland_c2"};
        const struct judge_request request = {.time = {true, 0}, .width.ratio = 1.5};
        struct autopsy_level level;
        struct run used;
        struct error error = {0};
        plant(2, 0, "");
        snprintf(gas.head, sizeof gas.head, "# case = yee\n# keys = %s\n# box = -5:5 -5:5\n",
                 keys[key]);
        gas.has_h = true;
        for (int i = 0; i < N; i++) {
            for (int d = 0; d < 2; d++) gas.x[d][i] = draw(-5, 5);
            gas.h[i] = 1;
        }
        struct judged judged = judges(&request);
        assert_true(judged.conventions.known);
        if (judge_autopsy(&judged, &level, &used, &error)) fail_msg("%s", error.message);
        if (key == 0) assert_true(settings_real(&used.settings, SETTING_eta) == 3);
        assert_string_equal(
            kernel_family.members[settings_choice(&used.settings, SETTING_kernel)]->name,
            key ? "wendland_c2" : "wendland_c4");
        judge_free(&judged);
    }
    const struct judge_request jumps = {.case_name = "sod", .time = {true, 0.1}, .kernel = -1};
    struct autopsy_level level;
    struct run used;
    struct error error = {0};
    plant(1, 0, boxes[1]);
    struct judged judged = judges(&jumps);
    assert_int_equal(judge_autopsy(&judged, &level, &used, &error), STATUS_BAD_INPUT);
    assert_true(*error.message);
    judge_free(&judged);
}
