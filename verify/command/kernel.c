/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof kernel: the certificate of a built-in kernel or of a user's own. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "certificate.h"
#include "command.h"
#include "picture.h"
#include "result.h"
#include "text.h"
#include "user_kernel.h"

enum { POINTS_MAX = 10000 };

/* What the command line asks for. */
struct request {
    int dim, sinc_order, n;
    double h;
    double *q; /* n of them */
};

static enum status take_number(const struct options *options, const char *name, double low,
                               double high, bool whole, double *value, struct error *error)
{
    const char *text = options_value(options, name);
    if (!text) return STATUS_OK;
    const bool number = whole ? text_integer(text, value) : text_real(text, value);
    if (number && *value >= low && *value <= high) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT, "kernel: --%s '%.40s': allowed: %s from %g to %g",
                     name, text, whole ? "an integer" : "a number", low, high);
}

/* "0,0.25,1": one number or more, none negative. */
static enum status take_points(const struct options *options, struct request *request,
                               struct error *error)
{
    const char *text = options_value(options, "at");
    if (!text) return STATUS_OK;
    request->n = 1;
    for (const char *c = text; *c; c++) request->n += *c == ',';
    if (request->n > POINTS_MAX)
        return error_set(error, STATUS_BAD_INPUT, "kernel: --at has %d values; allowed: 1 to %d",
                         request->n, POINTS_MAX);
    request->q = malloc((size_t)request->n * sizeof *request->q);
    if (!request->q) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    bool sound = text_reals(text, ",", (size_t)request->n, request->q);
    for (int i = 0; sound && i < request->n; i++) sound = request->q[i] >= 0;
    if (sound) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "kernel: --at '%.60s': allowed: numbers q = r/h >= 0 separated by commas",
                     text);
}

static enum status take_request(const struct options *options, struct request *request,
                                struct error *error)
{
    double dim = 0, sinc_order = 5;
    *request = (struct request){.h = 1};
    if (!options_value(options, "dim"))
        return command_usage(options, error, "--dim is needed: 1, 2 or 3");
    if (take_number(options, "dim", 1, 3, true, &dim, error)) return error->status;
    if (take_number(options, "sinc_n", 3, 12, true, &sinc_order, error)) return error->status;
    if (take_number(options, "h", 1e-30, 1e30, false, &request->h, error)) return error->status;
    request->dim = (int)dim;
    request->sinc_order = (int)sinc_order;
    return take_points(options, request, error);
}

static enum status load(struct user_kernel *user, const char *word, const struct request *request,
                        struct error *error)
{
    if (user_kernel_is_path(word)) return user_kernel_load(user, word, request->dim, error);
    if (family_index(&kernel_family, word) < 0)
        return text_unknown_member(error, "kernel", "kernel", word, &kernel_family);
    return kernel_select(&user->kernel, word, request->sinc_order, error);
}

static void print_derived(const struct user_kernel *user)
{
    const struct {
        bool found;
        const char *what, *how;
    } list[] = {
        {user->found_constant, "constant", "by quadrature"},
        {user->found_dh, "dW/dh", "from w and dw"},
        {user->found_knots, "knots", "by bisection"},
        {user->found_class, "class", "by measurement"},
    };
    for (size_t i = 0; user->library && i < sizeof list / sizeof *list; i++)
        printf("  %-28s %s%s\n", list[i].what, list[i].found ? "not supplied: found " : "supplied",
               list[i].found ? list[i].how : " and checked");
    if (user->library) printf("\n");
}

static void print_values(const struct kernel *kernel, const struct request *request)
{
    if (!request->n) return;
    printf("\n%-12s %24s %24s %24s\n", "q", "W", "dW/dr", "dW/dh");
    for (int i = 0; i < request->n; i++) {
        const double r = request->q[i] * request->h;
        printf("%-12.9g %24.16e %24.16e %24.16e\n", request->q[i],
               kernel_value(kernel, r, request->h, request->dim),
               kernel_dr(kernel, r, request->h, request->dim),
               kernel_dh(kernel, r, request->h, request->dim));
    }
}

static json_t *values_json(const struct kernel *kernel, const struct request *request)
{
    json_t *list = json_array();
    for (int i = 0; i < request->n; i++) {
        const double h = request->h, r = request->q[i] * h;
        json_array_append_new(
            list, json_pack("{s:o, s:o, s:o, s:o, s:o}", "q", result_number(request->q[i]), "r",
                            result_number(r), "w",
                            result_number(kernel_value(kernel, r, h, request->dim)), "dw_dr",
                            result_number(kernel_dr(kernel, r, h, request->dim)), "dw_dh",
                            result_number(kernel_dh(kernel, r, h, request->dim))));
    }
    return list;
}

static enum status write_json(const struct options *options, const struct user_kernel *user,
                              const struct certificate *certificate, const struct request *request,
                              struct error *error)
{
    json_t *document = result_new("kernel"), *derived = json_array();
    const char *const names[] = {"constant", "dw_dh", "knots", "class"};
    const bool found[] = {user->found_constant, user->found_dh, user->found_knots,
                          user->found_class};
    for (int i = 0; i < 4; i++)
        if (found[i]) json_array_append_new(derived, json_string(names[i]));
    json_object_set_new(document, "kernel", json_string(user->kernel.member.name));
    if (user->kernel.order)
        json_object_set_new(document, "sinc_n", json_integer(user->kernel.order));
    json_object_set_new(document, "dim", json_integer(request->dim));
    json_object_set_new(document, "h", result_number(request->h));
    json_object_set_new(document, "status", json_string(certificate->failed ? "fail" : "pass"));
    json_object_set_new(document, "derived", derived);
    json_object_set_new(document, "values", values_json(&user->kernel, request));
    certificate_json(certificate, request->h, document);
    const enum status status = result_write(document, options->json, error);
    json_decref(document);
    return status;
}

static enum status report(const struct options *options, const struct user_kernel *user,
                          const struct request *request, struct error *error)
{
    const char *plot = options_value(options, "plot");
    struct certificate certificate;
    enum status status = certificate_measure(&certificate, &user->kernel, request->dim, error);
    if (status) return status;
    if (plot) status = certificate_plot(&certificate, plot, error);
    if (!status && options->speak) {
        certificate_print(&certificate, request->h, stdout, options->color);
        print_derived(user);
        print_values(&user->kernel, request);
    }
    if (!status && options->json) status = write_json(options, user, &certificate, request, error);
    if (!status && certificate.failed) status = STATUS_CHECK_FAILED;
    certificate_free(&certificate);
    return status;
}

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    struct request request;
    struct user_kernel user = {0};
    if (n != 1) return command_usage(options, error, "one kernel or one F.so is needed");
    const char *plot = options_value(options, "plot");
    enum status status = take_request(options, &request, error);
    if (!status && plot) status = picture_probe(plot, error);
    if (!status) status = load(&user, arguments[0], &request, error);
    if (!status) status = report(options, &user, &request, error);
    user_kernel_unload(&user);
    free(request.q);
    return status;
}

static const struct command_option own_options[] = {
    {"dim", "D", "dimension: 1, 2 or 3"},
    {"h", "H", "support radius (default 1)"},
    {"at", "Q1,Q2,...", "also W, dW/dr and dW/dh at these q = r/h"},
    {"sinc_n", "N", "exponent of the kernel sinc, 3 to 12 (default 5)"},
    {"plot", "F.svg|F.png", "plot W, W', W'' and the transform"},
    {NULL, NULL, NULL},
};

const struct command command_kernel = {
    .name = "kernel",
    .synopsis = "NAME|F.so --dim D",
    .help =
        "the certificate of a kernel: everything that makes it a right one, measured\n"
        "F.so is a kernel of your own: the header verify/kernel/plugin.h says how to write it.\n"
        "Exit status 1 if a property does not hold.",
    .run = run,
    .options = own_options,
    .examples = "sphproof kernel cubic_spline --dim 3\n"
                "sphproof kernel wendland_c2 --dim 2 --h 0.1 --at 0,0.25,0.5,1 --json -\n"
                "sphproof kernel ./my_kernel.so --dim 1 --plot my_kernel.svg",
};
