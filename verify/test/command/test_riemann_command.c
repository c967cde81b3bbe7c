/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof riemann as other programs see it: JSON, samples, exit status. Argument: the program. */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <jansson.h>

#include "near.h"

static const char *program;

/* Runs `program riemann ARGUMENTS`; its output (cut at size) and exit status. */
static int run(const char *arguments, const char *redirect, char *output, size_t size)
{
    char command[1024];
    snprintf(command, sizeof command, "'%s' riemann %s %s", program, arguments, redirect);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    const size_t n = fread(output, 1, size - 1, pipe);
    output[n] = '\0';
    const int status = pclose(pipe);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static json_t *solve(const char *arguments)
{
    static char output[1 << 16];
    char with_json[512];
    snprintf(with_json, sizeof with_json, "%s --json -", arguments);
    assert_int_equal(run(with_json, "", output, sizeof output), 0);
    json_error_t error;
    json_t *document = json_loads(output, 0, &error);
    if (!document) print_error("%s: %s\n", arguments, error.text);
    assert_non_null(document);
    return document;
}

static double number(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    if (!json_is_real(value)) print_error("%s is not a real number\n", key);
    assert_true(json_is_real(value));
    return json_real_value(value);
}

TEST(test_sod)
{
    json_t *document = solve("1 0 1 0.125 0 0.1 --sample -0.25:0.75:5 --time 0.2 --x0 0.25");
    assert_string_equal(json_string_value(json_object_get(document, "schema")), "sphproof/1");
    assert_string_equal(json_string_value(json_object_get(document, "command")), "riemann");
    near_relative(number(document, "p_star"), 0.30313017805064682, 1e-14);
    near_relative(number(document, "v_star"), 0.92745262004894995, 1e-14);
    near_relative(number(document, "rho_star_left"), 0.42631942817849519, 1e-14);
    near_relative(number(document, "rho_star_right"), 0.26557371170530706, 1e-14);
    assert_string_equal(json_string_value(json_object_get(document, "left_wave")), "rarefaction");
    assert_string_equal(json_string_value(json_object_get(document, "right_wave")), "shock");
    const json_t *speeds = json_object_get(document, "speeds");
    near_relative(number(speeds, "left_head"), -1.1832159566199232, 1e-14);
    near_relative(number(speeds, "left_tail"), -0.070272812561183270, 1e-14);
    near_relative(number(speeds, "contact"), 0.92745262004894995, 1e-14);
    near_relative(number(speeds, "right_tail"), 1.7521557320301782, 1e-14);
    near_relative(number(speeds, "right_head"), 1.7521557320301782, 1e-14);
    const json_t *samples = json_object_get(document, "samples");
    assert_int_equal(json_array_size(samples), 5);
    const double x[] = {-0.25, 0, 0.25, 0.5, 0.75};
    for (size_t i = 0; i < 5; i++) assert_true(number(json_array_get(samples, i), "x") == x[i]);
    near_relative(number(json_array_get(samples, 0), "density"), 1, 1e-15);
    near_relative(number(json_array_get(samples, 2), "pressure"), 0.30313017805064682, 1e-14);
    near_relative(number(json_array_get(samples, 3), "density"), 0.26557371170530706, 1e-14);
    near_relative(number(json_array_get(samples, 4), "pressure"), 0.1, 1e-15);
    json_decref(document);
}

TEST(test_fan_off_origin)
{
    /* inside the fan v = 2/(gamma+1) (c_L + (x - x0)/t) */
    json_t *document = solve("1 0 1 0.125 0 0.1 --sample 0.1:0.1:1 --time 0.2 --x0 0.25");
    const json_t *sample = json_array_get(json_object_get(document, "samples"), 0);
    const double c = sqrt(1.4), v = (c - 0.15 / 0.2) / 1.2;
    near_relative(number(sample, "velocity"), v, 1e-14);
    near_relative(number(sample, "density"), pow(1 - 0.2 * v / c, 5), 1e-14);
    near_relative(number(sample, "pressure"), pow(1 - 0.2 * v / c, 7), 1e-14);
    json_decref(document);
}

TEST(test_vacuum)
{
    json_t *document = solve("1 -5 0.4 1 5 0.4 --sample -1:1:3 --time 1");
    const json_t *speeds = json_object_get(document, "speeds");
    assert_true(number(document, "p_star") == 0 && number(document, "rho_star_left") == 0);
    assert_true(number(document, "rho_star_right") == 0);
    assert_true(json_is_null(json_object_get(document, "v_star")));
    assert_true(json_is_null(json_object_get(speeds, "contact")));
    near_relative(number(speeds, "left_tail"), -1.2583426132260586, 1e-14);
    const json_t *sample = json_array_get(json_object_get(document, "samples"), 1);
    assert_true(number(sample, "density") == 0 && number(sample, "pressure") == 0);
    assert_true(json_is_null(json_object_get(sample, "velocity")));
    json_decref(document);

    document = solve("0 0 0 1 0 1 --gamma 1.4");
    speeds = json_object_get(document, "speeds");
    assert_string_equal(json_string_value(json_object_get(document, "left_wave")), "none");
    assert_true(json_is_null(json_object_get(speeds, "left_head")));
    near_relative(number(speeds, "right_tail"), -5.9160797830996160, 1e-14);
    assert_int_equal(json_array_size(json_object_get(document, "samples")), 0);
    json_decref(document);
}

TEST(test_start_and_gamma)
{
    json_t *document =
        solve("1 -2 3 4 5 -0 --gamma=1.6666666666666667 --sample -1:1:2 --time 0 --x0 0");
    const json_t *samples = json_object_get(document, "samples");
    assert_true(number(json_array_get(samples, 0), "velocity") == -2);
    assert_true(number(json_array_get(samples, 0), "pressure") == 3);
    assert_true(number(json_array_get(samples, 1), "density") == 4);
    json_decref(document);
}

TEST(test_table)
{
    char output[4096];
    assert_int_equal(run("1 0 1 0.125 0 0.1", "", output, sizeof output), 0);
    assert_non_null(strstr(output, "left star         0.42631942818"));
    assert_non_null(strstr(output, "right shock        speed 1.752155732"));
    assert_int_equal(run("1 0 1 0.125 0 0.1 --quiet", "", output, sizeof output), 0);
    assert_string_equal(output, "");
}

TEST(test_bad_input)
{
    static const struct {
        const char *arguments, *word;
    } cases[] = {
        {"", "six numbers"},
        {"1 0 1 0.125 0", "5 given"},
        {"1 0 1 0.125 0 0.1 7", "7 given"},
        {"1 0 one 0.125 0 0.1", "PL 'one'"},
        {"1 0 1 0.125 0 0.1x", "PR '0.1x'"},
        {"nan 0 1 0.125 0 0.1", "RHOL 'nan'"},
        {"1 0 1 0.125 inf 0.1", "VR 'inf'"},
        {"1 0 1 0.125 0 1e999", "PR '1e999'"},
        {"-1 0 1 0.125 0 0.1", "negative"},
        {"1 0 1 0.125 0 -0.1", "negative"},
        {"0 0 1 0.125 0 0.1", "density 0"},
        {"1 0 1 0.125 0 0.1 --gamma 1", "gamma"},
        {"1 0 1 0.125 0 0.1 --gamma nan", "--gamma 'nan'"},
        {"1 0 1 0.125 0 0.1 --gamma", "--gamma"},
        {"1 0 1 0.125 0 0.1 --sample 0:1", "X0:X1:N"},
        {"1 0 1 0.125 0 0.1 --sample 0:1:2:3", "X0:X1:N"},
        {"1 0 1 0.125 0 0.1 --sample a:1:5", "X0:X1:N"},
        {"1 0 1 0.125 0 0.1 --sample 0:1:0", "N = 0"},
        {"1 0 1 0.125 0 0.1 --sample 0:1:2.5", "N = 2.5"},
        {"1 0 1 0.125 0 0.1 --sample 0:1:1e12", "N = 1e+12"},
        {"1 0 1 0.125 0 0.1 --sample 1:0:5", "X0 < X1"},
        {"1 0 1 0.125 0 0.1 --time -1", "--time -1"},
        {"1 0 1 0.125 0 0.1 --x0 here", "--x0 'here'"},
        {"1 0 1 0.125 0 0.1 --smaple 0:1:5", "--sample"},
        {"1e308 1e308 1e308 1 -1e308 1", "range"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char output[4096];
        const int status = run(cases[i].arguments, "2>/dev/null", output, sizeof output);
        if (status != 2 || *output) print_error("%s: %d\n", cases[i].arguments, status);
        assert_int_equal(status, 2);
        assert_string_equal(output, "");
        run(cases[i].arguments, "2>&1 >/dev/null", output, sizeof output);
        if (!strstr(output, cases[i].word)) print_error("%s: %s\n", cases[i].arguments, output);
        assert_non_null(strstr(output, cases[i].word));
    }
}

int main(int argc, char **argv)
{
    if (argc < 2) return 1;
    program = argv[1];
    return test_run(NULL, NULL);
}
