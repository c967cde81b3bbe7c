/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof riemann: the exact solution of a Riemann problem, as a table and as JSON. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "result.h"
#include "riemann.h"
#include "text.h"

enum { NUMBERS = 6, SAMPLES_MAX = 1000000 };

static const char *const number_names[NUMBERS] = {"RHOL", "VL", "PL", "RHOR", "VR", "PR"};

struct sampling {
    double from, to, time, x0;
    int n; /* 0: no samples wanted */
};

/* ---- input ---- */

static enum status take_real(const struct options *options, const char *name, double *value,
                             struct error *error)
{
    const char *text = options_value(options, name);
    if (text && !text_real(text, value))
        return error_set(error, STATUS_BAD_INPUT,
                         "riemann: --%s '%.40s' is not a number; allowed: a finite decimal number",
                         name, text);
    return STATUS_OK;
}

static enum status take_sampling(const struct options *options, struct sampling *s,
                                 struct error *error)
{
    if (take_real(options, "time", &s->time, error)) return error->status;
    if (take_real(options, "x0", &s->x0, error)) return error->status;
    if (s->time < 0)
        return error_set(error, STATUS_BAD_INPUT,
                         "riemann: --time %g: allowed: 0 (the initial states) or later", s->time);
    const char *text = options_value(options, "sample");
    if (!text && (options_value(options, "time") || options_value(options, "x0")))
        return error_set(
            error, STATUS_BAD_INPUT,
            "riemann: --time and --x0 say where and when to sample: they need --sample");
    if (!text) return STATUS_OK;
    double v[3];
    if (!text_reals(text, ":", 3, v))
        return error_set(error, STATUS_BAD_INPUT,
                         "riemann: --sample '%.60s': allowed: X0:X1:N, three numbers", text);
    if (!(v[2] >= 1 && v[2] <= SAMPLES_MAX) || v[2] != floor(v[2]))
        return error_set(error, STATUS_BAD_INPUT,
                         "riemann: --sample '%.60s': N = %g, allowed: an integer from 1 to %d",
                         text, v[2], SAMPLES_MAX);
    if (!(v[0] <= v[1]) || (v[2] < 2 && v[0] < v[1]))
        return error_set(error, STATUS_BAD_INPUT,
                         "riemann: --sample '%.60s': allowed: X0 < X1 with N >= 2 (both ends are "
                         "sampled), or X0 = X1",
                         text);
    s->from = v[0], s->to = v[1], s->n = (int)v[2];
    return STATUS_OK;
}

static double sample_x(const struct sampling *s, int i)
{
    if (i == s->n - 1) return s->to;
    const long double from = (long double)s->from, to = (long double)s->to;
    return (double)(from + (to - from) * i / (s->n - 1));
}

/* ---- output ---- */

static json_t *samples_json(const struct riemann_solution *s, const struct sampling *sampling)
{
    json_t *samples = json_array();
    for (int i = 0; i < sampling->n; i++) {
        const double x = sample_x(sampling, i);
        const struct riemann_state state = riemann_sample(s, x, sampling->x0, sampling->time);
        json_array_append_new(samples, result_object("x=%g? density=%g? velocity=%g? pressure=%g?",
                                                     x, state.rho, state.v, state.P));
    }
    return samples;
}

static json_t *state_json(const struct riemann_state *state)
{
    return json_pack("[o, o, o]", result_number_or_null(state->rho),
                     result_number_or_null(state->v), result_number_or_null(state->P));
}

static json_t *solution_json(const struct riemann_solution *s, const struct sampling *sampling)
{
    json_t *speeds =
        result_object("left_head=%g? left_tail=%g? contact=%g? right_tail=%g? right_head=%g?",
                      s->left_head, s->left_tail, s->contact, s->right_tail, s->right_head);
    return result_object(
        "gamma=%g left=%p right=%p p_star=%g? v_star=%g? rho_star_left=%g? rho_star_right=%g? "
        "underflow=%d? left_wave=%s right_wave=%s speeds=%p time=%g x0=%g samples=%p",
        s->gamma, (void *)state_json(&s->left), (void *)state_json(&s->right), s->p_star, s->v_star,
        s->rho_star_left, s->rho_star_right, s->underflow, riemann_wave_name(s->left_wave),
        riemann_wave_name(s->right_wave), (void *)speeds, sampling->time, sampling->x0,
        (void *)samples_json(s, sampling));
}

static void print_state(const char *name, double rho, double v, double P)
{
    char velocity[32] = "-"; /* of a vacuum */
    if (!isnan(v)) snprintf(velocity, sizeof velocity, "%.11g", v);
    printf("%-12s %18.11g %18s %18.11g\n", name, rho, velocity, P);
}

static void print_wave(const char *side, enum riemann_wave wave, double head, double tail)
{
    if (wave == RIEMANN_NONE) printf("%-5s no wave\n", side);
    if (wave == RIEMANN_SHOCK) printf("%-5s %-12s speed %.11g\n", side, "shock", head);
    if (wave == RIEMANN_RAREFACTION)
        printf("%-5s %-12s head %.11g, tail %.11g\n", side, "rarefaction", head, tail);
}

static void print_solution(const struct riemann_solution *s, const struct sampling *sampling)
{
    printf("Riemann problem of an ideal gas, gamma = %.11g (any consistent units)\n\n", s->gamma);
    printf("%-12s %18s %18s %18s\n", "", "density", "velocity", "pressure");
    print_state("left", s->left.rho, s->left.v, s->left.P);
    if (s->vacuum) {
        printf("%-12s %18d %18s %18d\n", "vacuum", 0, "-", 0);
    } else {
        print_state("left star", s->rho_star_left, s->v_star, s->p_star);
        print_state("right star", s->rho_star_right, s->v_star, s->p_star);
    }
    print_state("right", s->right.rho, s->right.v, s->right.P);
    if (s->underflow)
        printf("note: a star value is below %.3g: 0, or with few digits; other units help\n",
               DBL_MIN);
    printf("\n");
    print_wave("left", s->left_wave, s->left_head, s->left_tail);
    if (!s->vacuum) printf("%-18s speed %.11g\n", "contact", s->contact);
    print_wave("right", s->right_wave, s->right_head, s->right_tail);
    if (!sampling->n) return;
    printf("\nat time %g, diaphragm at x = %g\n%-12s %18s %18s %18s\n", sampling->time,
           sampling->x0, "x", "density", "velocity", "pressure");
    for (int i = 0; i < sampling->n; i++) {
        const double x = sample_x(sampling, i);
        const struct riemann_state state = riemann_sample(s, x, sampling->x0, sampling->time);
        char name[24];
        snprintf(name, sizeof name, "%.9g", x);
        print_state(name, state.rho, state.v, state.P);
    }
}

/* ---- the command ---- */

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    double values[NUMBERS], gamma = 1.4;
    struct sampling sampling = {.time = 1};
    struct riemann_solution solution;
    if (n != NUMBERS) return command_usage(options, error, "six numbers are needed, %d given", n);
    for (int i = 0; i < NUMBERS; i++)
        if (!text_real(arguments[i], &values[i]))
            return error_set(
                error, STATUS_BAD_INPUT,
                "riemann: %s '%.40s' is not a number; allowed: a finite decimal number",
                number_names[i], arguments[i]);
    if (take_real(options, "gamma", &gamma, error)) return error->status;
    if (take_sampling(options, &sampling, error)) return error->status;

    const struct riemann_state left = {values[0], values[1], values[2]};
    const struct riemann_state right = {values[3], values[4], values[5]};
    const char *why = riemann_solve(gamma, &left, &right, &solution);
    if (why)
        return error_set(error, STATUS_BAD_INPUT,
                         "riemann: %s; got gamma %g, left (rho v P) %g %g %g, right %g %g %g", why,
                         gamma, left.rho, left.v, left.P, right.rho, right.v, right.P);
    if (options->speak) print_solution(&solution, &sampling);
    if (!options->json) return STATUS_OK;
    return options_write_members(options, solution_json(&solution, &sampling), error);
}

static const struct command_option own_options[] = {
    {"gamma", "G", "ratio of specific heats, above 1 (default 1.4)"},
    {"sample", "X0:X1:N", "also print the solution at N equidistant positions, both ends included"},
    {"time", "T", "time of the samples; 0: the initial states (default 1)"},
    {"x0", "X", "position of the diaphragm (default 0)"},
    {NULL, NULL, NULL},
};

const struct command command_riemann = {
    .name = "riemann",
    .synopsis = "RHOL VL PL RHOR VR PR",
    .help = "the exact solution of a Riemann problem of an ideal gas\n"
            "Density, velocity and pressure left and right of a diaphragm that vanishes at t = 0.\n"
            "A side with density 0 and pressure 0 is vacuum. In vacuum there is no velocity.",
    .run = run,
    .options = own_options,
    .examples = "sphproof riemann 1 0 1 0.125 0 0.1\n"
                "sphproof riemann 1 -2 0.4 1 2 0.4 --sample -0.5:0.5:11 --time 0.15\n"
                "sphproof riemann 1 0 1 0 0 0 --gamma 1.6667 --json -",
};
