/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests in which order `sphproof bench` measures, prints and writes in each of its modes, what it
 * measures with which rules, and its status. Measurements are replaced; schema.py and exits.py run
 * real ones. */
#include "test.h"

#include <stdarg.h>

#include "own_folder.h"

/* the command itself, because its static functions are tested */
#define bench_kernels_add_json add_kernels
#define bench_kernels_free     free_kernels
#define bench_kernels_measure  measure_kernels
#define bench_kernels_print    print_kernels
#define bench_scaling_add_json add_scaling
#define bench_scaling_measure  measure_scaling
#define bench_scaling_plot     plot_scaling
#define bench_scaling_print    print_scaling
#define bench_skips_add_json   add_skips
#define bench_skips_free       free_skips
#define bench_skips_measure    measure_skips
#define bench_skips_pass       pass_skips
#define bench_skips_print      print_skips
#define bench_steps_print      print_steps
#define picture_probe          probe_picture
#define precision_add_json     add_precision
#define precision_conclude     conclude_precision
#define precision_free         free_precision
#define precision_measure      measure_precision
#define precision_plan         plan_precision
#define precision_plot         plot_precision
#define precision_print        print_precision
#define progress_begin         begin_progress
#define progress_end           end_progress
#define sharing_run            run_shares
#include "../../command/bench.c"

/* What the replaced functions find. */
static struct {
    enum status probe, measure, plan, run, conclude, plot;
    bool whole, fails, none;
    struct precision_scheme schemes[3];
    size_t scheme_count;
} planted;

static char calls[1000]; /* of replaced functions */
static const struct progress *progress;

static void note(const char *format, ...)
{
    const size_t length = strlen(calls);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(calls + length, sizeof calls - length, format, arguments);
    va_end(arguments);
}

static enum status end_with(enum status status, struct error *error, const char *format, ...)
{
    char text[300];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    note("%s; ", text);
    return status ? error_set(error, status, "planted") : STATUS_OK;
}

void begin_progress(struct progress *of, const char *what, bool quiet)
{
    progress = of;
    note("%s%s: ", what, quiet ? "" : ", aloud");
}

void end_progress(struct progress *of)
{
    assert_ptr_equal(of, progress);
    progress = NULL;
    note("end; ");
}

static const char *rules_text(const struct bench_rules *rules)
{
    static char text[64];
    assert_ptr_equal(rules->progress, progress);
    snprintf(text, sizeof text, "%d samples of %g to %g s", rules->samples, rules->least_s,
             rules->most_s);
    return text;
}

static const char *ladder_text(const size_t *ladder, size_t count)
{
    static char text[200];
    text[0] = '\0';
    for (size_t i = 0; i < count; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), " %zu", ladder[i]);
    return text;
}

/* ---- the replaced functions ---- */

enum status probe_picture(const char *path, struct error *error)
{
    return end_with(planted.probe, error, "probe %s", path);
}

enum status measure_kernels(const struct sweep *sweep, const struct bench_rules *rules,
                            struct bench_kernels *result, struct error *error)
{
    *result = (struct bench_kernels){0};
    return end_with(planted.measure, error, "kernels, %zu keys, %s", sweep->key_count,
                    rules_text(rules));
}
void add_kernels(const struct bench_kernels *result, json_t *document)
{
    (void)result;
    assert_int_equal(json_array_size(json_object_get(document, "points")), 0);
    note("json; ");
}
void print_kernels(const struct bench_kernels *result, const struct table_style *style)
{
    (void)result, (void)style;
    note("print; ");
}
void free_kernels(struct bench_kernels *result)
{
    (void)result;
    note("free; ");
}

enum status measure_skips(const struct run_settings *cases, size_t count,
                          const struct bench_rules *rules, enum bench_part part,
                          struct bench_skips *result, struct error *error)
{
    size_t clouds = 0;
    for (size_t k = 0; k < count; k++) {
        clouds += cases[k].file.dimension > 1;
        assert_int_equal(cases[k].threads, 3);
        for (size_t i = 0; i < k; i++)
            assert_string_not_equal(cases[i].file.name, cases[k].file.name);
    }
    *result = (struct bench_skips){.count = !planted.none};
    return end_with(planted.measure, error, "part %d of %zu in 1D, %zu more, %s", part,
                    count - clouds, clouds, rules_text(rules));
}
bool pass_skips(const struct bench_skips *result)
{
    (void)result;
    return !planted.fails;
}
void add_skips(const struct bench_skips *result, bool maps, json_t *document)
{
    (void)result;
    assert_false(maps);
    assert_int_equal(json_array_size(json_object_get(document, "points")), 0);
    note("json; ");
}
void print_skips(const struct bench_skips *result, const struct table_style *style)
{
    (void)result, (void)style;
    note("print skips; ");
}
void print_steps(const struct bench_skips *result, const struct table_style *style)
{
    (void)result, (void)style;
    note("print steps; ");
}
void free_skips(struct bench_skips *result)
{
    (void)result;
    note("free; ");
}

enum status measure_scaling(const struct run_settings *settings, const size_t *ladder, size_t count,
                            int threads, const struct bench_rules *rules, struct scaling *scaling,
                            struct error *error)
{
    *scaling = (struct scaling){.settings = settings};
    return end_with(planted.measure, error, "%s, n =%s, %d threads, %s", settings->file.name,
                    ladder_text(ladder, count), threads, rules_text(rules));
}
enum status plot_scaling(const struct scaling *scaling, const char *path, struct error *error)
{
    (void)scaling;
    return end_with(planted.plot, error, "plot %s", path);
}
void add_scaling(const struct scaling *scaling, json_t *document)
{
    (void)scaling, (void)document;
    note("json; ");
}
void print_scaling(const struct scaling *scaling, const struct table_style *style)
{
    (void)scaling, (void)style;
    note("print; ");
}

static enum status precision_of(const struct run_settings *settings, const struct sweep *sweep,
                                const size_t *ladder, size_t count, struct precision *precision)
{
    *precision =
        (struct precision){.scheme_count = planted.scheme_count, .schemes = planted.schemes};
    note("%s, %d threads, %zu keys, n =%s, ", settings->file.name, settings->threads,
         sweep->key_count, ladder_text(ladder, count));
    return STATUS_OK;
}
enum status measure_precision(const struct run_settings *settings, const struct sweep *sweep,
                              const size_t *ladder, size_t count, const struct bench_rules *rules,
                              struct precision *precision, struct error *error)
{
    precision_of(settings, sweep, ladder, count, precision);
    return end_with(planted.measure, error, "%s", rules_text(rules));
}
enum status plan_precision(const struct run_settings *settings, const struct sweep *sweep,
                           const size_t *ladder, size_t count, const struct bench_rules *rules,
                           struct precision *precision, struct pool *pool, struct error *error)
{
    assert_int_equal(pool->count, 0);
    precision_of(settings, sweep, ladder, count, precision);
    return end_with(planted.plan, error, "plan %d samples", rules->samples);
}
enum status run_shares(struct sharing *sharing, struct pool *pool, const struct options *options,
                       bool *whole, struct error *error)
{
    (void)pool, (void)options;
    *whole = planted.whole && !planted.run;
    return end_with(planted.run, error, "shares of %d", sharing->pool.jobs);
}
enum status conclude_precision(struct precision *precision, const struct pool *pool,
                               struct error *error)
{
    (void)precision, (void)pool;
    return end_with(planted.conclude, error, "conclude");
}
enum status plot_precision(const struct precision *precision, const char *path, struct error *error)
{
    (void)precision;
    return end_with(planted.plot, error, "plot %s", path);
}
void add_precision(const struct precision *precision, json_t *document)
{
    (void)precision;
    note("json %s; ", json_string_value(json_object_get(document, "status")));
}
void print_precision(const struct precision *precision, const struct table_style *style)
{
    (void)precision, (void)style;
    note("print; ");
}
void free_precision(struct precision *precision)
{
    (void)precision;
    note("free; ");
}

/* ---- calls ---- */

static const char *values[sizeof own_options / sizeof *own_options];
static struct options options = {
    .command = &command_bench, .values = values, .threads = 3, .quiet = 1, .speak = 1};

static void set(const char *name, const char *value)
{
    for (size_t i = 0; own_options[i].name; i++)
        if (!strcmp(own_options[i].name, name)) values[i] = value;
}

/* Runs the command with words as on the command line: --NAME[=VALUE] and arguments; "" ends. */
static enum status bench(const char *const *words, struct error *error)
{
    char text[8][80], *arguments[8];
    int n = 0;
    memset(values, 0, sizeof values);
    calls[0] = '\0';
    *error = (struct error){0};
    for (int k = 0; words[k]; k++) {
        snprintf(text[k], sizeof text[k], "%s", words[k]);
        char *value = strchr(text[k], '=');
        if (strncmp(text[k], "--", 2)) {
            arguments[n++] = text[k];
            continue;
        }
        if (value) *value++ = '\0';
        set(text[k] + 2, value ? value : "");
    }
    return run(&options, n, arguments, error);
}

static const struct {
    const char *words[8], *calls; /* all goes well */
} modes_called[] = {
    {{"--n=20,30"},
     "bench: sod, 3 threads, 0 keys, n = 20 30, 5 samples of 0.02 to 5 s; end; json ok; print; "
     "free; "},
    {{"gresho", "--n=100,196", "--vary=eta=2,3", "--samples=64", "--time=60", "--plot=p.svg"},
     "probe p.svg; bench: gresho, 3 threads, 1 keys, n = 100 196, 64 samples of 60 to 5 s; end; "
     "plot p.svg; json ok; print; free; "},
    {{"--kernels", "--samples=1"},
     "bench --kernels: kernels, 0 keys, 1 samples of 0.02 to 5 s; end; json; print; free; "},
    {{"--kernels", "--vary=kernel=sinc,cubic_spline"},
     "bench --kernels: kernels, 1 keys, 5 samples of 0.02 to 5 s; end; json; print; free; "},
    {{"--skips", "sod", "n=40"},
     "bench --skips: part 0 of 1 in 1D, 0 more, 5 samples of 0.02 to 5 s; end; json; print skips; "
     "free; "},
    {{"--skips", "gresho"},
     "bench --skips: part 0 of 0 in 1D, 1 more, 5 samples of 0.02 to 5 s; end; json; print skips; "
     "free; "},
    {{"--steps", "sod"},
     "bench --steps: part 2 of 1 in 1D, 0 more, 5 samples of 0.02 to 5 s; end; json; print steps; "
     "free; "},
    {{"--scaling", "--n=20,40"},
     "bench --scaling: sod, n = 20 40, 3 threads, 5 samples of 0.02 to 5 s; end; json; print; "},
    {{"--scaling", "--n=20"},
     "bench --scaling: sod, n = 20, 3 threads, 5 samples of 0.02 to 5 s; end; json; print; "},
    {{"--scaling", "gresho", "--time=1e-9", "--plot=p.svg"},
     "probe p.svg; bench --scaling: gresho, n = 316 1000 3162 10000 31623 100000 316228 "
     "1000000, 3 threads, 5 samples of 1e-09 to 5 s; end; plot p.svg; json; print; "},
    /* whose coarsest level has 9216 particles; its box cannot hold 3162 */
    {{"--scaling", "sod_3d"},
     "bench --scaling: sod_3d, n = 10000 31623 100000 316228 1000000, 3 threads, 5 samples of 0.02 "
     "to 5 s; end; json; print; "},
};

TEST(modes_in_order)
{
    struct error error;
    for (size_t k = 0; k < sizeof modes_called / sizeof *modes_called; k++) {
        assert_int_equal(bench(modes_called[k].words, &error), STATUS_OK);
        assert_string_equal(calls, modes_called[k].calls);
        /* silently */
        char silent[1000], *print;
        options.speak = 0;
        assert_int_equal(bench(modes_called[k].words, &error), STATUS_OK);
        options.speak = 1;
        snprintf(silent, sizeof silent, "%s", modes_called[k].calls);
        assert_non_null(print = strstr(silent, "print"));
        memmove(print, strchr(print, ';') + 2, strlen(strchr(print, ';') + 2) + 1);
        assert_string_equal(calls, silent);
        /* a document that cannot be written: nothing is printed */
        options.json = "/no/such/file";
        assert_int_equal(bench(modes_called[k].words, &error), STATUS_ENVIRONMENT);
        options.json = NULL;
        assert_string_equal(calls, silent);
        /* the measurement fails */
        planted.measure = STATUS_ENVIRONMENT;
        assert_int_equal(bench(modes_called[k].words, &error), STATUS_ENVIRONMENT);
        planted.measure = STATUS_OK;
        assert_string_equal(error.message, "planted");
        char *end = strstr(silent, "end; ") + 5;
        strcpy(end, strstr(silent, "free; ") ? "free; " : "");
        assert_string_equal(calls, silent);
        /* no gnuplot, or a picture that cannot be drawn */
        if (strncmp(silent, "probe", 5)) continue;
        planted.plot = STATUS_ENVIRONMENT;
        assert_int_equal(bench(modes_called[k].words, &error), STATUS_ENVIRONMENT);
        planted.plot = STATUS_OK;
        assert_non_null(strstr(calls, "plot p.svg; "));
        assert_null(strstr(calls, "print"));
        planted.probe = STATUS_ENVIRONMENT;
        assert_int_equal(bench(modes_called[k].words, &error), STATUS_ENVIRONMENT);
        planted.probe = STATUS_OK;
        assert_string_equal(calls, "probe p.svg; ");
    }
}

/* Without a case all of 1D, or with --steps all of 2D and 3D. */
TEST(all_built_in_cases)
{
    size_t line = 0, clouds = 0;
    char expected[400];
    struct error error;
    for (const struct case_builtin *one = case_builtins; one->name; one++) {
        struct case_file file;
        assert_int_equal(case_load(&file, one->name, &error), STATUS_OK);
        clouds += file.dimension > 1, line += file.dimension == 1;
    }
    static const char *const words[][2] = {{"--skips", NULL}, {"--steps", NULL}};
    for (int k = 0; k < 2; k++) {
        assert_int_equal(bench(words[k], &error), STATUS_OK);
        snprintf(expected, sizeof expected,
                 "bench %s: part %d of %zu in 1D, %zu more, 5 samples of 0.02 to 5 s; end; json; "
                 "print %s; free; ",
                 words[k][0], k ? BENCH_STEPS : BENCH_WORK, k ? 0 : line, k ? clouds : 0,
                 words[k][0] + 2);
        assert_string_equal(calls, expected);
    }
    static const char *const wrong[] = {"--skips", "cfl=x", NULL};
    assert_int_equal(bench(wrong, &error), STATUS_BAD_INPUT);
    assert_string_equal(calls, "");
}

TEST(skips_that_break_their_promise)
{
    struct error error;
    static const char *const words[] = {"--skips", "sod", NULL}, *const steps[] = {"--steps", "sod",
                                                                                   NULL};
    planted.fails = true;
    assert_int_equal(bench(words, &error), STATUS_CHECK_FAILED);
    assert_non_null(strstr(calls, "json; print skips; free; "));
    planted.measure = STATUS_BROKE_DOWN;
    assert_int_equal(bench(words, &error), STATUS_BROKE_DOWN);
    planted.measure = STATUS_OK, planted.fails = false, planted.none = true;
    assert_int_equal(bench(steps, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "bench: --steps: sod has no local steps; allowed: "));
    assert_non_null(strstr(calls, "end; free; "));
    planted.none = false;
}

/* The usual numbers of particles from the case's least on, but always the largest of them. */
TEST(sizes_of_scaling)
{
    static const struct {
        const char *ladder, *sizes;
    } rows[] = {{"316 400 500 600", "316 1000 3162 10000 31623 100000 316228 1000000"},
                {"317 400 500 600", "1000 3162 10000 31623 100000 316228 1000000"},
                {"1000000 2000000 3000000 4000000", "1000000"},
                {"1000001 2000000 3000000 4000000", "1000000"}};
    char *path = path_of("tube.ini"), sizes[200];
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct error error;
        FILE *file = fopen(path, "w");
        assert_non_null(file);
        fprintf(
            file,
            "[case]\ntitle = A tube\ndimension = 1\nreference = riemann\n[initial]\nkind = "
            "riemann\nleft = 1 0 1\nright = 0.1 0 0.1\n[run]\nt_end = 0.01\n[converge]\nn = %s\n",
            rows[k].ladder);
        fclose(file);
        assert_int_equal(bench((const char *[]){"--scaling", path, NULL}, &error), STATUS_OK);
        snprintf(sizes, sizeof sizes, "n = %s, ", rows[k].sizes);
        assert_non_null(strstr(calls, sizes));
    }
}

/* Two threads at least, since one is what they are compared with. */
TEST(threads_of_scaling)
{
    static const char *const words[] = {"--scaling", "--n=20,40", NULL};
    for (int threads = 1; threads < 4; threads++) {
        char said[40];
        struct error error;
        options.threads = threads;
        assert_int_equal(bench(words, &error), STATUS_OK);
        snprintf(said, sizeof said, " %d threads, ", threads < 2 ? 2 : threads);
        assert_non_null(strstr(calls, said));
    }
    options.threads = 3;
}

/* A reference that ran does not make up for schemes that did not. */
TEST(schemes_that_broke_down)
{
    static const char *const words[] = {"--n=20,30", NULL};
    static const struct precision_scheme ran = {.label = "good", .count = 2},
                                         none = {.label = "bad", .excluded = "it went away"},
                                         worse = {.label = "worse", .excluded = "no"},
                                         reference = {.label = "seed",
                                                      .count = 2,
                                                      .reference = REFERENCE_SEED};
    const struct {
        struct precision_scheme schemes[3];
        const char *message; /* NULL: some ran */
    } rows[] = {
        {{ran, none, reference}, NULL},
        {{none, ran, reference}, NULL},
        {{none, worse, reference}, "bench: no scheme asked for ran: bad: it went away"},
        {{worse, none, reference}, "bench: no scheme asked for ran: worse: no"},
        {{worse, reference, none}, "bench: no scheme asked for ran: worse: no"},
    };
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        struct error error;
        memcpy(planted.schemes, rows[r].schemes, sizeof planted.schemes);
        planted.scheme_count = 3;
        assert_int_equal(bench(words, &error), rows[r].message ? STATUS_BROKE_DOWN : STATUS_OK);
        assert_string_equal(error.message, rows[r].message ? rows[r].message : "");
        assert_non_null(strstr(calls, rows[r].message ? "json broke_down; print; free; "
                                                      : "json ok; print; free; "));
    }
    planted.scheme_count = 0;
}

/* In shares: what follows a status, and only whole results are shown. */
TEST(in_shares_of_several_machines)
{
    static const char *const words[] = {"--n=20,30", "--list", NULL};
    static const struct {
        enum status plan, run, conclude, status;
        bool whole;
        const char *calls;
    } rows[] = {
        {0, 0, 0, 0, true, "plan 5 samples; shares of 1; conclude; json ok; print; free; "},
        {0, 0, 0, 0, false, "plan 5 samples; shares of 1; free; "},
        {STATUS_BAD_INPUT, 0, 0, STATUS_BAD_INPUT, true, "plan 5 samples; free; "},
        {0, STATUS_ENVIRONMENT, 0, STATUS_ENVIRONMENT, true, "plan 5 samples; shares of 1; free; "},
        {0, 0, STATUS_BROKE_DOWN, STATUS_BROKE_DOWN, true,
         "plan 5 samples; shares of 1; conclude; free; "},
    };
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        struct error error;
        planted.plan = rows[r].plan, planted.run = rows[r].run;
        planted.conclude = rows[r].conclude, planted.whole = rows[r].whole;
        assert_int_equal(bench(words, &error), rows[r].status);
        assert_string_equal(strstr(calls, "plan"), rows[r].calls);
        assert_int_equal(strncmp(calls, "sod, 3 threads, 0 keys, n = 20 30, plan", 39), 0);
    }
}

/* (The transcripts test most options that exclude each other.) */
TEST(refused_rules)
{
    static const struct {
        const char *words[6];
        bool sound;
    } rows[] = {{{"--samples=1"}, true},
                {{"--samples=64"}, true},
                {{"--samples=0"}, false},
                {{"--samples=65"}, false},
                {{"--samples=1.5"}, false},
                {{"--time=60"}, true},
                {{"--time=60.1"}, false},
                {{"--time=0"}, false},
                {{"--time=x"}, false},
                {{"--steps", "--scaling"}, false},
                {{"--steps", "--vary=eta=2"}, false},
                {{"--kernels", "--engine=local"}, false},
                {{"--kernels", "--code=c"}, false},
                {{"--kernels", "--work=w"}, false},
                {{"--scaling", "n=50"}, false},
                {{"--work=w"}, false}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        struct error error;
        const enum status status = bench(rows[r].words, &error);
        if (status != (rows[r].sound ? STATUS_OK : STATUS_BAD_INPUT))
            fail_msg("%s %s: %d", rows[r].words[0], rows[r].words[1], status);
        if (!rows[r].sound) assert_string_equal(calls, "");
    }
}
