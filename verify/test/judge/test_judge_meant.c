/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests which other case `judge` names for a snapshot that is far from the one asked for: gas
 * between two cases, gas at the limits of what a candidate may differ by, and cases without
 * fields. */
#include "test.h"

#include "sample_snapshot.h"

/* The gas of the first case, or this part of it with the rest from the second, exact at this time;
 * the particles are spaced evenly in the box [lo, hi] of the cases. */
static void mix(const char *first, const char *second, double part, double time)
{
    const struct run runs[] = {keyed_run(first, ""), keyed_run(second, "")};
    const struct prepared *p = &runs[0].problem;
    const double lo = p->domain.lo[0], length = domain_length(&p->domain, 0);
    plant(1, lo, "");
    snprintf(gas.head, sizeof gas.head,
             "# time = %.17g\n# gamma = %.17g\n# box = %.17g:%.17g\n# boundary = periodic\n", time,
             p->gamma, lo, lo + length);
    for (int i = 0; i < N; i++) {
        struct problem_state s[2];
        gas.x[0][i] = lo + length * (i + 0.5) / N;
        for (int k = 0; k < 2; k++)
            problem_sample(&runs[k].problem, (double[3]){gas.x[0][i]}, time, &s[k]);
        gas.rho[i] = part * s[0].rho + (1 - part) * s[1].rho;
        gas.v[0][i] = part * s[0].v[0] + (1 - part) * s[1].v[0];
        gas.u[i] = (part * s[0].P + (1 - part) * s[1].P) / ((p->gamma - 1) * gas.rho[i]);
        gas.m[i] = gas.rho[i] * length / N;
    }
}

/* Distance of the planted gas from a case's solution. */
static double distance(const char *name)
{
    const struct judge_request request = {.case_name = name, .kernel = -1};
    struct judged judged;
    struct error error;
    if (judge_as(put("a.csv"), &request, true, &judged, &error)) fail_msg("%s", error.message);
    const double wrong = judged.wrong;
    judge_free(&judged);
    return wrong;
}

/* Mixes the two cases so that the distance from the first is `ratio` times that from the second. */
static void mix_at(const char *first, const char *second, double ratio, double time)
{
    double low = 0, high = 1;
    for (int k = 0; k < 30; k++) {
        const double part = 0.5 * (low + high);
        mix(first, second, part, time);
        *(distance(first) > ratio * distance(second) ? &low : &high) = part;
    }
}

/* True if the planted gas, asked to be one case, is said to be the other, which is near, or nearer
 * though far as well. */
static bool is_said_to_be(const char *asked, const char *name, bool far)
{
    const struct judge_request request = {.case_name = asked, .kernel = -1};
    char says[120];
    struct judged judged = judges(&request);
    snprintf(says, sizeof says,
             far ? "; nearer, though far as well, is %s (" : "; did you mean %s? (", name);
    const bool said = strstr(judged.verdict, says);
    if (said != (!far && strcmp(judged.meant, name) == 0)) assert_true(far && !*judged.meant);
    judge_free(&judged);
    return said;
}

/* Of two cases whose misfits differ by less than 0.1 % the one is meant whose end time is nearer,
 * otherwise the one with the smaller misfit. */
TEST(times_decide_between_equals)
{
    static const struct {
        double ratio, time; /* misfit of sod over that of sod_standard; ends are at 0.2 and 0.1 */
        const char *meant;
    } rows[] = {
        {0.9989, 0.1, "sod"},          {0.9991, 0.1, "sod_standard"},
        {1.0009, 0.1, "sod_standard"}, {1.0011, 0.1, "sod_standard"},
        {0.9991, 0.14, "sod"},         {1.0009, 0.14, "sod"}, /* as a part of the end time */
        {0.9989, 0.2, "sod"},          {0.9991, 0.2, "sod"},
        {1.0009, 0.2, "sod"},          {1.0011, 0.2, "sod_standard"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        mix_at("sod", "sod_standard", rows[k].ratio, rows[k].time);
        assert_true(is_said_to_be("sound_wave", rows[k].meant, distance(rows[k].meant) > 0.06));
    }
}

/* A case that is far as well is named if its misfit is below 0.3 of that of the case asked for. */
TEST(much_nearer_cases)
{
    mix_at("sod", "lax", 0.29, 0.1);
    assert_true(is_said_to_be("lax", "sod", true));
    mix_at("sod", "lax", 0.31, 0.1);
    assert_false(is_said_to_be("lax", "sod", true));
}

/* The mass of a candidate may differ by a tenth, its energy by a fifth. */
TEST(content_of_candidates)
{
    for (int k = 0; k < 8; k++) {
        const bool lacks = k & 1, too_much = k & 2, of_energy = k & 4;
        const double part = (of_energy ? 0.2 : 0.1) + (too_much ? 1e-4 : -1e-4);
        const double factor = lacks ? 1 - part : 1 + part;
        const struct judge_request request = {.case_name = "sod", .kernel = -1};
        mix("sod", "sod", 1, 0.1);
        struct judged judged = judges(&request);
        double mass = 0, energy = 0, outside = 0;
        for (int i = 0; i < N; i++) {
            const double thermal = gas.m[i] * gas.u[i];
            mass += gas.m[i];
            energy += thermal + 0.5 * gas.m[i] * gas.v[0][i] * gas.v[0][i];
            outside += fabs(gas.x[0][i]) > 0.6 ? thermal : 0; /* of the window */
        }
        for (int i = 0; i < N; i++)
            if (!of_energy)
                gas.m[i] *= factor * judged.start.mass / mass;
            else if (fabs(gas.x[0][i]) > 0.6)
                gas.u[i] *= 1 + (factor * judged.start.energy - energy) / outside;
        judge_free(&judged);
        assert_true(is_said_to_be("lax", "sod", false) == !too_much);
    }
    /* what a box would hold is unknown */
    mix("sod", "sod", 1, 0.1);
    snprintf(gas.head, sizeof gas.head, "# time = 0.1\n# gamma = 1.4\n");
    for (int i = 0; i < N; i++) gas.m[i] /= 4, gas.x[0][i] *= 1.01;
    assert_true(is_said_to_be("lax", "sod", false));
}

/* The box of a candidate is as long as that of the file, or 15 % longer than the extent of
 * particles; a tube may have any length. */
TEST(lengths_of_candidates)
{
    static const struct {
        double lo, length;
        bool boxed, meant;
    } rows[] = {{0, 1 + 9e-7, true, true}, {0, 1 + 1.1e-6, true, false},
                {0, 1 - 9e-7, true, true}, {0, 1 - 1.1e-6, true, false},
                {5, 0.851, false, true},   {5, 0.849, false, false},
                {5, 1.149, false, true},   {5, 1.151, false, false}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const double lo = rows[k].lo, length = rows[k].length;
        const struct judge_request request = {.case_name = "sound_wave", .kernel = -1};
        mix("sound_wave", "sound_wave", 1, 0.05);
        snprintf(gas.head, sizeof gas.head, "# time = 0.05\n# gamma = %.17g\n",
                 keyed_run("sound_wave", "").problem.gamma);
        if (rows[k].boxed)
            sprintf(gas.head + strlen(gas.head), "# box = %.17g:%.17g\n", lo, lo + length);
        for (int i = 0; i < N; i++) {
            gas.x[0][i] = lo + length * (rows[k].boxed ? (i + 0.5) / N : i / (N - 1.));
            if (!rows[k].boxed) gas.m[i] /= 4; /* volumes do not tell the length */
        }
        struct judged judged = judges(&request);
        for (int i = 0; i < N; i++) {
            struct problem_state s;
            problem_sample(&judged.run.problem, (double[3]){gas.x[0][i]}, 0.05, &s);
            gas.rho[i] = s.rho, gas.v[0][i] = s.v[0], gas.u[i] = s.u;
        }
        judge_free(&judged);
        assert_true(is_said_to_be("lax", "sound_wave", false) == rows[k].meant);
    }
}

/* The margin of a box is a part of the case's length, here 10, in each direction. */
TEST(lengths_of_a_longer_case)
{
    const struct judge_request request = {.case_name = "gresho", .time = {true, 0}, .kernel = -1};
    const struct run run = keyed_run("yee", "");
    for (int k = 0; k < 6; k++) {
        const double off = k % 3 == 0   ? 0
                           : k % 3 == 1 ? 9e-6
                                        : 1.1e-5,
                     lo = run.problem.domain.lo[0];
        plant(2, 0, "");
        snprintf(gas.head, sizeof gas.head, "# gamma = 1.4\n# box = %.17g:%.17g %.17g:%.17g\n", lo,
                 lo + 10 + (k < 3 ? off : 0), lo, lo + 10 + (k < 3 ? 0 : off));
        for (int i = 0; i < N; i++) {
            struct problem_state s;
            const double x[3] = {lo + 10 * (i % 16 + 0.5) / 16, lo + 10 * (i / 16 + 0.5) / 15};
            problem_sample(&run.problem, x, 0, &s);
            for (int d = 0; d < 2; d++) gas.x[d][i] = x[d], gas.v[d][i] = s.v[d];
            gas.rho[i] = s.rho, gas.u[i] = s.u, gas.m[i] = 100 * s.rho / N;
        }
        struct judged judged = judges(&request);
        assert_int_equal(strstr(judged.verdict, "did you mean yee? (") != NULL, k % 3 < 2);
        judge_free(&judged);
    }
}

/* Another case is looked for if the mass is wrong, and not if only gamma is another: then the
 * verdict says which. A time that is given is taken also where the file has none and the case asked
 * for has other dimensions. */
TEST(when_others_are_tried)
{
    const struct judge_request sod = {.case_name = "sod", .kernel = -1},
                               other = {.case_name = "gresho", .time = {true, 0.1}, .kernel = -1};
    mix("sod", "sod", 1, 0.1);
    for (int i = 0; i < N; i++) gas.m[i] *= 0.8;
    struct judged judged = judges(&sod);
    assert_non_null(strstr(judged.verdict, "; none of our other cases in 1D is near either"));
    judge_free(&judged);
    struct judge_request uniform = uniform_gas();
    uniform.gamma.known = false;
    plant(1, 0, "# gamma = 1.5\n# box = 0:2\n");
    for (int i = 0; i < N; i++) gas.x[0][i] = (i + 0.5) * 2 / N, gas.m[i] = 2. / N, gas.u[i] = 2;
    judged = judges(&uniform);
    assert_non_null(strstr(judged.verdict, "another gas: gamma = 1.5"));
    assert_null(strstr(judged.verdict, "other cases"));
    assert_null(strstr(judged.verdict, "did you mean"));
    judge_free(&judged);
    mix("sod", "sod", 1, 0.1);
    snprintf(gas.head, sizeof gas.head, "# gamma = 1.4\n# box = -1:1\n");
    refuses(&other, "; did you mean sod? (");
}

/* A case with one exact value only is named if no case with fields is near; never if it is far. */
TEST(candidates_without_fields)
{
    static const struct {
        const char *gas;
        double time, mass; /* the mode is sampled at this time */
        const char *says;
    } rows[] = {
        {"kelvin_helmholtz_mode", 1.84, 1.5,
         "; did you mean kelvin_helmholtz_mode? (its value is the case's)"},
        {"kelvin_helmholtz_mode", 0, 1.5, "; none of our other cases in 2D is near either"},
        /* its gas is that of the square, and it also has the amplitude of the mode */
        {"square", 1.84, 1.6, "; did you mean square? (velocity off by 0.0027 of its range"}};
    const struct run mode = keyed_run("kelvin_helmholtz_mode", "");
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct judge_request request = {.case_name = "gresho", .kernel = -1};
        const struct run run = keyed_run(rows[k].gas, "");
        double mass = 0;
        plant(2, 0, "# time = 1.84\n# gamma = 1.6666666666666667\n# box = 0:1 0:1\n");
        for (int i = 0; i < N; i++) {
            struct problem_state s, moved;
            const double x[3] = {(i % 16 + 0.5) / 16, (i / 16 + 0.5) / 15};
            problem_sample(&run.problem, x, rows[k].time, &s);
            problem_sample(&mode.problem, x, rows[k].time, &moved);
            gas.x[0][i] = x[0], gas.x[1][i] = x[1];
            gas.v[0][i] = s.v[0], gas.v[1][i] = moved.v[1];
            gas.rho[i] = gas.m[i] = s.rho, gas.u[i] = s.u;
            mass += s.rho;
        }
        for (int i = 0; i < N; i++) gas.m[i] *= rows[k].mass / mass;
        struct judged judged = judges(&request);
        if (!strstr(judged.verdict, rows[k].says)) fail_msg("row %zu: %s", k, judged.verdict);
        judge_free(&judged);
    }
}
