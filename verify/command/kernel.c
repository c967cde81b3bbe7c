/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof kernel: the certificate of a built-in kernel or of a user's plug-in. The latter is made
 * in a child process; here its text, document and curves are only passed on. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "certificate.h"
#include "command.h"
#include "guard.h"
#include "result.h"
#include "text.h"
#include "user_kernel.h"

/* The request of the command line. */
struct request {
    int dim, sinc_order, n;
    double h, limit; /* limit: seconds */
    double *q;       /* n of them */
    struct terms terms;
    const char *word; /* name or path */
    const struct options *options;
};

/* "0,0.25,1": one number or more, none negative. */
static enum status take_points(const struct options *options, struct request *request,
                               struct error *error)
{
    const char *text = options_value(options, "at");
    if (!text) return STATUS_OK;
    request->n = 1;
    for (const char *c = text; *c; c++) request->n += *c == ',';
    request->q = malloc((size_t)request->n * sizeof *request->q);
    if (!request->q) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    bool sound = text_reals(text, ",", (size_t)request->n, request->q);
    for (int i = 0; sound && i < request->n; i++) sound = request->q[i] >= 0;
    if (sound) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "kernel: --at '%.60s': allowed: numbers q = r/h >= 0 separated by commas",
                     text);
}

static enum status take_terms(const struct options *options, struct request *request,
                              struct error *error)
{
    const char *precision = options_value(options, "precision");
    double samples = CERTIFICATE_SAMPLES, seed = CERTIFICATE_SEED;
    if (precision && strcmp(precision, "single") != 0 && strcmp(precision, "double") != 0)
        return error_set(error, STATUS_BAD_INPUT,
                         "kernel: --precision '%.40s': allowed: double, single", precision);
    if (options_number(options, "samples", true, 1000, 1e9, &samples, error)) return error->status;
    if (options_number(options, "seed", true, 0, 1e15, &seed, error)) return error->status;
    request->terms = (struct terms){.single = precision && precision[0] == 's',
                                    .samples = (long)samples,
                                    .seed = (uint64_t)seed};
    return options_number(options, "limit", false, 1, 1e6, &request->limit, error);
}

static enum status take_request(const struct options *options, struct request *request,
                                struct error *error)
{
    double dim, sinc_order = 5;
    *request = (struct request){.h = 1, .limit = GUARD_LIMIT, .options = options};
    if (!options_value(options, "dim"))
        return command_usage(options, error, "--dim is needed: 1, 2 or 3");
    if (options_number(options, "dim", true, 1, 3, &dim, error)) return error->status;
    if (options_number(options, "sinc_n", true, 3, 12, &sinc_order, error)) return error->status;
    if (options_number(options, "h", false, 1e-30, 1e30, &request->h, error)) return error->status;
    request->dim = (int)dim;
    request->sinc_order = (int)sinc_order;
    if (take_terms(options, request, error)) return error->status;
    return take_points(options, request, error);
}

static enum status load(struct user_kernel *user, const struct request *request,
                        struct error *error)
{
    const char *word = request->word;
    if (options_value(request->options, "sinc_n") && strcmp(word, "sinc") != 0)
        return error_set(error, STATUS_BAD_INPUT,
                         "kernel: --sinc_n is for sinc alone, not for %.200s", word);
    if (user_kernel_is_path(word))
        return user_kernel_load(user, word, request->dim, &request->terms, error);
    if (family_index(&kernel_family, word) < 0)
        return text_unknown_member(error, "kernel", "kernel", word, &kernel_family);
    user->terms = request->terms;
    return kernel_select(&user->kernel, word, request->sinc_order, error);
}

static void print_derived(const struct user_kernel *user, FILE *stream)
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
    if (!user->library) return;
    for (size_t i = 0; i < sizeof list / sizeof *list; i++)
        fprintf(stream, "  %-28s %s%s\n", list[i].what,
                list[i].found ? "not supplied: found " : "supplied",
                list[i].found ? list[i].how : " and checked");
    fprintf(stream, "\n");
}

static void print_values(const struct kernel *kernel, const struct request *request, FILE *stream)
{
    if (!request->n) return;
    fprintf(stream, "\n%-12s %24s %24s %24s\n", "q", "W", "dW/dr", "dW/dh");
    for (int i = 0; i < request->n; i++) {
        const double r = request->q[i] * request->h;
        fprintf(stream, "%-12.9g %24.16e %24.16e %24.16e\n", request->q[i],
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
        json_array_append_new(list, result_object("q=%g r=%g w=%g dw_dr=%g dw_dh=%g", request->q[i],
                                                  r, kernel_value(kernel, r, h, request->dim),
                                                  kernel_dr(kernel, r, h, request->dim),
                                                  kernel_dh(kernel, r, h, request->dim)));
    }
    return list;
}

static json_t *document_of(const char *name, const struct request *request, const char *status)
{
    json_t *document = result_new("kernel");
    result_add(document, "kernel=%s dim=%d h=%g status=%s", name, request->dim, request->h, status);
    return document;
}

static json_t *certificate_document(const struct user_kernel *user,
                                    const struct certificate *certificate,
                                    const struct request *request)
{
    json_t *derived = json_array();
    json_t *document =
        document_of(user->kernel.member.name, request, certificate->failed ? "fail" : "pass");
    const char *const names[] = {"constant", "dw_dh", "knots", "class"};
    const bool found[] = {user->found_constant, user->found_dh, user->found_knots,
                          user->found_class};
    for (int i = 0; i < 4; i++)
        if (found[i]) json_array_append_new(derived, json_string(names[i]));
    if (user->kernel.order) result_add(document, "sinc_n=%d", user->kernel.order);
    json_object_set_new(document, "derived", derived);
    json_object_set_new(document, "values", values_json(&user->kernel, request));
    certificate_json(certificate, request->h, document);
    return document;
}

static json_t *certificate_text(const struct user_kernel *user,
                                const struct certificate *certificate,
                                const struct request *request)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) return NULL;
    certificate_print(certificate, request->h, stream, request->options->color);
    print_derived(user, stream);
    print_values(&user->kernel, request, stream);
    fclose(stream);
    json_t *string = json_string(text);
    free(text);
    return string;
}

/* {"text", "document", "curves"}; STATUS_CHECK_FAILED: the kernel is rejected. */
static enum status certify(const void *context, json_t **reply, struct error *error)
{
    const struct request *request = context;
    struct user_kernel user = {0};
    struct certificate *certificate = calloc(1, sizeof *certificate);
    if (!certificate) return error_set(error, STATUS_ENVIRONMENT, "no memory for a certificate");
    enum status status = load(&user, request, error);
    if (!status) {
        const struct terms terms = user_kernel_terms(&user, request->dim);
        status = certificate_measure(certificate, &user.kernel, request->dim, &terms, error);
    }
    if (!status) {
        *reply = result_object("text=%p document=%p curves=%p",
                               (void *)certificate_text(&user, certificate, request),
                               (void *)certificate_document(&user, certificate, request),
                               (void *)certificate_curves(certificate));
        if (!*reply) status = error_set(error, STATUS_ENVIRONMENT, "no memory for a certificate");
        if (!status && certificate->failed) status = STATUS_CHECK_FAILED;
        certificate_free(certificate);
    }
    user_kernel_unload(&user);
    free(certificate);
    return status;
}

/* The certificate of a plug-in that crashed or did not finish. */
static enum status certify_none(const struct request *request, const struct guard_verdict *verdict,
                                json_t **reply, struct error *error)
{
    static const char *const unknown[] = {"normalisation", "moments", "class", "fourier"};
    char name[64], text[600];
    user_kernel_file_name(request->word, name, sizeof name);
    json_t *document = document_of(name, request, "fail"), *checks = json_array();
    json_object_set_new(document, "values", json_array());
    for (size_t i = 0; i < sizeof unknown / sizeof *unknown; i++)
        json_object_set_new(document, unknown[i], json_null());
    snprintf(text, sizeof text, "%s, dim %d, %s", name, request->dim, verdict->reason);
    json_array_append_new(
        checks, result_object(
                    "group=%s name=%s subject=%s property=%s value=%d bound=%d floor=%d status=%s",
                    "kernels", "runs", text, "every call returns", 1, 0, 0, "fail"));
    json_object_set_new(document, "checks", checks);
    snprintf(text, sizeof text, "%s, %d dimension%s\n\nREJECTED: it %s\n", name, request->dim,
             request->dim > 1 ? "s" : "", verdict->reason);
    *reply = result_object("text=%s document=%p", text, (void *)document);
    return *reply ? STATUS_CHECK_FAILED
                  : error_set(error, STATUS_ENVIRONMENT, "no memory for a certificate");
}

static void add_printed(const struct guard_verdict *verdict, json_t *reply)
{
    char note[400];
    if (!verdict->printed_bytes || !reply) return;
    json_object_set_new(
        json_object_get(reply, "document"), "printed",
        result_object("bytes=%zu text=%s", verdict->printed_bytes, verdict->printed));
    const char *text = json_string_value(json_object_get(reply, "text"));
    snprintf(note, sizeof note, "note: it printed %zu bytes: %s\n", verdict->printed_bytes,
             verdict->printed);
    json_object_set_new(reply, "text", json_sprintf("%s%s", text ? text : "", note));
}

static enum status certify_guarded(const struct request *request, json_t **reply,
                                   struct error *error)
{
    struct guard_verdict verdict;
    enum status status = guard_run(certify, request, request->limit, &verdict, error);
    *reply = json_incref(verdict.reply);
    if (status == STATUS_CHECK_FAILED && !verdict.ended)
        status = certify_none(request, &verdict, reply, error);
    if (status == STATUS_BAD_INPUT && !verdict.ended)
        error_set(error, status, "kernel '%.100s' %.300s", request->word, verdict.reason);
    add_printed(&verdict, *reply);
    guard_free(&verdict);
    return status;
}

static enum status show(const struct request *request, const json_t *reply, struct error *error)
{
    const struct options *options = request->options;
    const char *plot = options_value(options, "plot");
    const json_t *curves = json_object_get(reply, "curves");
    const char *text = json_string_value(json_object_get(reply, "text"));
    enum status status = STATUS_OK;
    if (plot && curves) status = certificate_plot(curves, plot, error);
    if (!status && options->speak) fputs(text ? text : "", stdout);
    if (!status && options->json)
        status = result_write(json_object_get(reply, "document"), options->json, error);
    return status;
}

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    struct request request;
    json_t *reply = NULL;
    if (n != 1) return command_usage(options, error, "one kernel or one F.so is needed");
    enum status status = take_request(options, &request, error);
    request.word = arguments[0];
    if (!status)
        status = user_kernel_is_path(request.word) ? certify_guarded(&request, &reply, error)
                                                   : certify(&request, &reply, error);
    if (status == STATUS_OK || status == STATUS_CHECK_FAILED) {
        const enum status shown = show(&request, reply, error);
        status = shown ? shown : status;
    }
    json_decref(reply);
    free(request.q);
    return status;
}

static const struct command_option own_options[] = {
    {"dim", "D", "dimension: 1, 2 or 3"},
    {"h", "H", "support radius (default 1)"},
    {"at", "Q1,Q2,...", "also print W, dW/dr and dW/dh at these q = r/h"},
    {"sinc_n", "N", "exponent of the kernel sinc, 3 to 12 (default 5)"},
    {"plot", "F.svg|F.png", "plot W, W', W'' and the transform"},
    {"precision", "double|single",
     "single: for a kernel that computes in single precision, with bounds of 1e-6"},
    {"samples", "N", "number of random q, one in each of N equal intervals (default 1048576)"},
    {"seed", "S", "seed of these random numbers (default 1)"},
    {"limit", "SECONDS", "time limit for a plug-in in all (default 300)"},
    {NULL, NULL, NULL},
};

const struct command command_kernel = {
    .name = "kernel",
    .synopsis = "NAME|F.so --dim D",
    .help =
        "the certificate of a kernel: all properties that a kernel must have, measured\nF.so is a "
        "kernel of your own: the header src/include/sphproof/plugin.h says how to write it.\nIt "
        "runs in a process of its own: one that crashes, never returns or ends the process is a "
        "kernel\nthat fails. The certificate says how narrow a fault it could have missed.\nExit "
        "status 1 if a property does not hold, 2 if F.so cannot be used at all.",
    .run = run,
    .options = own_options,
    .examples = "sphproof kernel cubic_spline --dim 3\n"
                "sphproof kernel wendland_c2 --dim 2 --h 0.1 --at 0,0.25,0.5,1 --json -\n"
                "sphproof kernel ./my_kernel.so --dim 1 --plot my_kernel.svg",
};
