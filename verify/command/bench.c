/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof bench: work-precision, costs of kernels, scaling, and savings by skips. */
#include "bench.h"

#include <stdlib.h>
#include <string.h>

#include "bench_kernels.h"
#include "bench_scaling.h"
#include "bench_skips.h"
#include "code_run.h"
#include "command.h"
#include "picture.h"
#include "precision.h"
#include "progress.h"
#include "result.h"
#include "sharing.h"
#include "text.h"

/* The arguments of all benchmarks. */
struct request {
    const struct options *options;
    struct bench_rules rules;
    struct progress progress;
    struct table_style style;
    int n; /* arguments after the case */
    char **arguments;
    const char *case_name; /* NULL: not named */
};

static enum status read_rules(struct request *request, struct error *error)
{
    const char *least = options_value(request->options, "time");
    const char *samples = options_value(request->options, "samples");
    double value;
    request->rules = bench_usual;
    request->rules.progress = &request->progress;
    if (least) {
        if (!text_real(least, &value) || !(value > 0 && value <= 60))
            return command_usage(request->options, error,
                                 "--time %.40s: allowed: seconds, above 0 up to 60", least);
        request->rules.least_s = value;
    }
    if (samples) {
        if (!text_integer(samples, &value) || !(value >= 1 && value <= BENCH_SAMPLES_MAX))
            return command_usage(request->options, error,
                                 "--samples %.40s: allowed: an integer from 1 to %d", samples,
                                 BENCH_SAMPLES_MAX);
        request->rules.samples = (int)value;
    }
    return STATUS_OK;
}

/* --- work-precision --------------------------------------------------------------------------- */

/* Prepares the case, sod if none is named. Refuses the key n, as --n gives the resolutions. */
static enum status prepare_case(const struct request *request, struct code *code,
                                struct code_external *external, struct run_settings *settings,
                                struct error *error)
{
    const char *name = request->case_name ? request->case_name : "sod";
    if (options_case(request->options, name, request->n, request->arguments, code, external,
                     settings, error))
        return error->status;
    if (settings->settings.value[SETTING_n].source != SOURCE_USER) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "bench: the key n and a ladder exclude each other; allowed: --n N1,N2,...");
}

/* The first requested scheme, if none of the requested schemes ran; else NULL. */
static const struct precision_scheme *broken(const struct precision *precision)
{
    const struct precision_scheme *first = NULL;
    for (size_t i = precision->scheme_count; i-- > 0;) {
        const struct precision_scheme *scheme = &precision->schemes[i];
        if (scheme->reference) continue;
        if (scheme->count) return NULL;
        first = scheme;
    }
    return first;
}

static enum status present(struct request *request, struct precision *precision, const char *plot,
                           struct error *error)
{
    const struct precision_scheme *failed = broken(precision);
    enum status status = plot ? precision_plot(precision, plot, error) : STATUS_OK;
    if (!status) {
        json_t *document = result_new("bench");
        result_add(document, "status=%s", failed ? "broke_down" : "ok");
        precision_add_json(precision, document);
        status = options_write(request->options, document, error);
    }
    if (!status && request->options->speak) precision_print(precision, &request->style);
    if (!status && failed)
        status = error_set(error, STATUS_BROKE_DOWN, "bench: no scheme asked for ran: %s: %s",
                           failed->label, failed->excluded);
    return status;
}

/* Measures each n as a separate job, for several machines. */
static enum status in_shares(struct request *request, const struct run_settings *settings,
                             const struct sweep *sweep, const size_t *ladder, size_t count,
                             struct sharing *sharing, struct error *error)
{
    struct precision precision;
    struct pool pool = {0};
    const char *plot = options_value(request->options, "plot");
    bool whole = false;
    enum status status =
        precision_plan(settings, sweep, ladder, count, &request->rules, &precision, &pool, error);
    if (!status) status = sharing_run(sharing, &pool, request->options, &whole, error);
    if (whole) status = precision_conclude(&precision, &pool, error);
    if (whole && !status) status = present(request, &precision, plot, error);
    precision_free(&precision);
    pool_free(&pool);
    return status;
}

static enum status measure(struct request *request, struct code *code, struct error *error)
{
    static struct code_external external;
    static struct run_settings settings;
    static struct sharing sharing;
    struct sweep sweep;
    struct precision precision;
    size_t ladder[CASE_LADDER_MAX], count;
    const char *plot = options_value(request->options, "plot");
    if (prepare_case(request, code, &external, &settings, error) ||
        sweep_parse(&sweep, options_value(request->options, "vary"), error) ||
        options_ladder(request->options, &settings, 1, ladder, &count, error) ||
        (plot && picture_probe(plot, error)) ||
        sharing_take(&sharing, request->options, 0, NULL, error))
        return error->status;
    if (sharing.list || sharing.pool.cache)
        return in_shares(request, &settings, &sweep, ladder, count, &sharing, error);
    progress_begin(&request->progress, "bench", request->options->quiet);
    enum status status =
        precision_measure(&settings, &sweep, ladder, count, &request->rules, &precision, error);
    progress_end(&request->progress);
    if (!status) status = present(request, &precision, plot, error);
    precision_free(&precision);
    return status;
}

static enum status work_precision(struct request *request, struct error *error)
{
    struct code code = {0};
    const enum status status = measure(request, &code, error);
    code_free(&code);
    return status;
}

/* --- what a pair costs ------------------------------------------------------------------------ */

static enum status refuse_case(const struct request *request, const char *mode, struct error *error)
{
    return command_usage(request->options, error, "%s takes neither a case nor keys; '%.60s' given",
                         mode, request->case_name ? request->case_name : request->arguments[0]);
}

static enum status refuse_option(const struct request *request, const char *mode, const char *name,
                                 struct error *error)
{
    return options_value(request->options, name)
               ? command_usage(request->options, error, "%s and --%s exclude each other", mode,
                               name)
               : STATUS_OK;
}

static enum status kernels(struct request *request, struct error *error)
{
    struct sweep sweep;
    struct bench_kernels result;
    if (request->case_name || request->n) return refuse_case(request, "--kernels", error);
    if (refuse_option(request, "--kernels", "n", error) ||
        refuse_option(request, "--kernels", "plot", error) ||
        sweep_parse(&sweep, options_value(request->options, "vary"), error))
        return error->status;
    progress_begin(&request->progress, "bench --kernels", request->options->quiet);
    enum status status = bench_kernels_measure(&sweep, &request->rules, &result, error);
    progress_end(&request->progress);
    if (!status) {
        json_t *document = result_new("bench");
        json_object_set_new(document, "points", json_array());
        bench_kernels_add_json(&result, document);
        status = options_write(request->options, document, error);
    }
    if (!status && request->options->speak) bench_kernels_print(&result, &request->style);
    bench_kernels_free(&result);
    return status;
}

/* --- what is left out ------------------------------------------------------------------------- */

/* The k-th of the cases asked for; NULL: there are no more. */
static const char *case_at(const struct request *request, size_t k)
{
    if (!request->case_name) return case_builtins[k].name;
    return k ? NULL : request->case_name;
}

/* Settings of the named case, or of all built-in cases in 1D or, with clouds, in 2D and 3D. The
 * caller frees them. */
static struct run_settings *all_cases(const struct request *request, size_t *count, bool clouds,
                                      struct error *error)
{
    size_t most = 0;
    *count = 0;
    while (case_at(request, most)) most++;
    struct run_settings *cases = calloc(most, sizeof *cases);
    if (!cases) error_set(error, STATUS_ENVIRONMENT, "no memory for %zu cases", most);
    for (size_t k = 0; cases && k < most; k++) {
        const size_t c = *count;
        if (run_prepare(&cases[c], case_at(request, k), request->n, request->arguments, error)) {
            free(cases);
            return NULL;
        }
        cases[c].threads = request->options->threads;
        *count += request->case_name || (cases[c].file.dimension > 1) == clouds;
    }
    return cases;
}

static enum status leave_out(struct request *request, enum bench_part part, const char *option,
                             struct error *error)
{
    const bool steps = part == BENCH_STEPS;
    struct bench_skips result;
    size_t count;
    if (refuse_option(request, option, "n", error) ||
        refuse_option(request, option, "vary", error) ||
        refuse_option(request, option, "plot", error))
        return error->status;
    struct run_settings *cases = all_cases(request, &count, steps, error);
    if (!cases) return error->status;
    progress_begin(&request->progress, steps ? "bench --steps" : "bench --skips",
                   request->options->quiet);
    enum status status = bench_skips_measure(cases, count, &request->rules, part, &result, error);
    progress_end(&request->progress);
    if (!status && result.count == 0)
        status = error_set(error, STATUS_BAD_INPUT,
                           "bench: --steps: %s has no local steps; allowed: cases in 2D and 3D "
                           "with a scheme that steps=local goes with",
                           request->case_name);
    const bool passes = bench_skips_pass(&result);
    if (!status) {
        json_t *document = result_new("bench");
        json_object_set_new(document, "points", json_array());
        bench_skips_add_json(&result, false, document);
        status = options_write(request->options, document, error);
    }
    if (!status && request->options->speak)
        (steps ? bench_steps_print : bench_skips_print)(&result, &request->style);
    bench_skips_free(&result);
    free(cases);
    return status || passes ? status : STATUS_CHECK_FAILED;
}

static enum status skips(struct request *request, struct error *error)
{
    return leave_out(request, BENCH_WORK, "--skips", error);
}

static enum status steps(struct request *request, struct error *error)
{
    return leave_out(request, BENCH_STEPS, "--steps", error);
}

/* --- how cost grows --------------------------------------------------------------------------- */

static const char usual_sizes[] = "100,316,1000,3162,10000,31623,100000,316228,1000000";

static enum status scaling(struct request *request, struct error *error)
{
    static struct run_settings settings;
    static struct scaling result;
    size_t ladder[CASE_LADDER_MAX], count, first = 0;
    const char *sizes = options_value(request->options, "n");
    const char *plot = options_value(request->options, "plot");
    const int threads = request->options->threads == 1 ? 2 : request->options->threads;
    if (refuse_option(request, "--scaling", "vary", error) ||
        prepare_case(request, NULL, NULL, &settings, error) ||
        sweep_ladder(sizes ? sizes : usual_sizes, 1, settings.file.dimension, ladder, &count,
                     error) ||
        (plot && picture_probe(plot, error)))
        return error->status;
    /* with fewer particles than on its own ladder, a case may have smoothing lengths that its box
     * does not hold */
    while (!sizes && first + 1 < count && ladder[first] < settings.file.ladder[0]) first++;
    progress_begin(&request->progress, "bench --scaling", request->options->quiet);
    enum status status = bench_scaling_measure(&settings, ladder + first, count - first, threads,
                                               &request->rules, &result, error);
    progress_end(&request->progress);
    if (!status && plot) status = bench_scaling_plot(&result, plot, error);
    if (!status) {
        json_t *document = result_new("bench");
        bench_scaling_add_json(&result, document);
        status = options_write(request->options, document, error);
    }
    if (!status && request->options->speak) bench_scaling_print(&result, &request->style);
    return status;
}

/* --- which of them ---------------------------------------------------------------------------- */

static const struct {
    const char *flag;
    enum status (*run)(struct request *request, struct error *error);
} modes[] = {
    {"kernels", kernels},
    {"skips", skips},
    {"steps", steps},
    {"scaling", scaling},
};
enum { MODES = sizeof modes / sizeof *modes };

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    struct request request = {
        .options = options, .style = table_style(options->color), .n = n, .arguments = arguments};
    enum status (*chosen)(struct request *, struct error *) = work_precision;
    for (int m = 0; m < MODES; m++) {
        if (!options_value(options, modes[m].flag)) continue;
        if (chosen != work_precision)
            return command_usage(options, error,
                                 "--kernels, --skips, --steps and --scaling exclude each other");
        chosen = modes[m].run;
    }
    static const char *const of_shares[] = {"shard", "list", "cache", "engine", "code", "work"};
    for (size_t i = 0; chosen != work_precision && i < sizeof of_shares / sizeof *of_shares; i++)
        if (refuse_option(&request, "--kernels, --skips, --steps or --scaling", of_shares[i],
                          error))
            return error->status;
    if (read_rules(&request, error)) return error->status;
    if (n > 0 && !strchr(arguments[0], '=')) {
        request.case_name = arguments[0];
        request.n--;
        request.arguments++;
    }
    return chosen(&request, error);
}

static const struct command_option own_options[] = {
    {"n", "N1,N2,...", "numbers of particles (default: the case's ladder)"},
    {"vary", "KEY[=A,B][,...]",
     "schemes: every member of a family, or these values; all combinations"},
    {"plot", "FILE.svg|.png", "draw error against CPU time (needs gnuplot)"},
    {"kernels", NULL, "ns per pair: kernels x solver loops and gradient operators x dimension"},
    {"skips", NULL, "what each kind of work that is left out saves, and how much results differ"},
    {"steps", NULL, "2D, 3D: local time steps beside global ones: CPU time, error, conservation"},
    {"scaling", NULL, "time and memory against n, with exponents; gain of threads"},
    {"time", "S", "CPU time of a sample, at least (default 0.02 s)"},
    {"samples", "N", "samples of each measurement (default 5); the least counts"},
    {"code", "CODE.ini", "also show another program, which this file describes"},
    {"work", "DIR", CODE_WORK_HELP},
    SHARING_OPTIONS,
    {NULL, NULL, NULL},
};

const struct command command_bench = {
    .name = "bench",
    .synopsis = "[CASE] [KEY=VALUE ...]",
    .help =
        "what an error costs: CPU time and pair interactions against the L1 error of density, or "
        "of\n"
        "the azimuthal velocity in flows that turn\n"
        "For every scheme of --vary and every resolution of --n (default case: sod): the Pareto\n"
        "front, the cheapest way to 1 %, 0.3 % and 0.1 % of the signal (the exact density's mean\n"
        "distance from its mean), and L1^(2/p) x CPU time at the case's order p against the seed\n"
        "program's corrected method. Samples of all schemes are taken in turn, so that ratios "
        "hold\n"
        "on a busy machine, too; the least sample counts and the spread is shown.",
    .run = run,
    .options = own_options,
    .examples = "sphproof bench\n"
                "sphproof bench sod --vary kernel,gradient --n 200,400,800 --plot front.svg\n"
                "sphproof bench strong_shock --vary "
                "integrator=predicted_midpoint,rk3,viscosity --json -\n"
                "sphproof bench --kernels --vary kernel=cubic_spline,quintic_spline\n"
                "sphproof bench --skips\n"
                "sphproof bench --scaling --n 100,1000,10000,100000 --threads 2\n"
                "sphproof bench sod_standard kernel=quartic_spline --vary "
                "viscosity=constant,reconstructed",
};
