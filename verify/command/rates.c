/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof rates: one evaluation of the particles of a file or a case, and the comparison with
 * rates that another code computed. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "command.h"
#include "initial.h"
#include "output.h"
#include "particle_file.h"
#include "rate_check.h"
#include "result.h"
#include "run.h"
#include "run_output.h"
#include "snapshot_csv.h"
#include "text.h"

enum { ROWS_SHOWN = 20, ROWS_CHECKED = 5 };

struct request {
    const char *source;
    bool from_file;
    struct settings settings;
    struct particle_file file;
    struct initial initial;
    struct setup setup;
    struct csv theirs;
    double tolerance;
    struct snapshot_file snapshot; /* snapshot of the particles, if any */
    char widths[200];              /* how its h was interpreted */
    char unknown[200];             /* names of columns without a known quantity */
};

/* ---- input ---- */

static enum status take_numbers(const char *key, const char *text, int dim, double values[3],
                                struct error *error)
{
    if (text_reals(text, " \t,", 1, values)) {
        for (int a = 1; a < dim; a++) values[a] = values[0];
        return STATUS_OK;
    }
    if (text_reals(text, " \t,", (size_t)dim, values)) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT, "%s=%.60s: allowed: one number or %d", key, text,
                     dim);
}

static enum status take_boundaries(const char *text, int dim, struct setup *setup,
                                   struct error *error)
{
    char words[64];
    int count = 0;
    const bool cut = snprintf(words, sizeof words, "%s", text) >= (int)sizeof words;
    for (char *rest = words, *word; (word = strtok_r(rest, " \t,", &rest)); count++) {
        const int member = family_index(&scheme_boundary_family, word);
        if (member < 0)
            return error_set(error, STATUS_BAD_INPUT,
                             "rates: boundary=%.40s: allowed: periodic open reflecting", word);
        if (member == BOUNDARY_FIXED)
            return error_set(error, STATUS_BAD_INPUT,
                             "boundary=fixed: a file does not say which particles are kept: "
                             "allowed: periodic open reflecting");
        if (count == dim) { /* too many */
            count = 0;
            break;
        }
        setup->boundary[count] = (enum boundary)member;
    }
    for (int a = 1; count == 1 && a < 3; a++) setup->boundary[a] = setup->boundary[0];
    if (cut || (count != 1 && count != dim))
        return error_set(error, STATUS_BAD_INPUT, "boundary=%.60s: allowed: one word or %d", text,
                         dim);
    return STATUS_OK;
}

/* Takes the file's box unless keys set another. */
static enum status take_said(struct request *r, bool boxed, bool bounded, struct error *error)
{
    const struct snapshot_file *said = &r->snapshot;
    if (!bounded && *said->boundary &&
        take_boundaries(said->boundary, r->file.dim, &r->setup, error))
        return error->status;
    for (int a = 0; a < 3 && said->boxed && !boxed; a++) {
        r->setup.lo[a] = said->corner[a];
        r->setup.hi[a] = said->corner[a] + said->box[a];
    }
    return STATUS_OK;
}

static bool is_key(const char *word, size_t length, const char *key)
{
    return strlen(key) == length && strncmp(word, key, length) == 0;
}

/* Takes the keys of the box and leaves others in rest. */
static enum status take_box(struct request *r, int n, char **arguments, char **rest, int *left,
                            struct error *error)
{
    const int dim = r->file.dim;
    bool lo = false, hi = false, boundary = false;
    *left = 0;
    for (int k = 0; k < n; k++) {
        const char *text = strchr(arguments[k], '=');
        const size_t length = text ? (size_t)(text++ - arguments[k]) : 0;
        enum status status = STATUS_OK;
        if (is_key(arguments[k], length, "lo"))
            status = take_numbers("lo", text, dim, r->setup.lo, error), lo = true;
        else if (is_key(arguments[k], length, "hi"))
            status = take_numbers("hi", text, dim, r->setup.hi, error), hi = true;
        else if (is_key(arguments[k], length, "gravity"))
            status = take_numbers("gravity", text, dim, r->setup.gravity, error);
        else if (is_key(arguments[k], length, "boundary"))
            status = take_boundaries(text, dim, &r->setup, error), boundary = true;
        else
            rest[(*left)++] = arguments[k];
        if (status) return status;
    }
    if (take_said(r, lo || hi, boundary, error)) return error->status;
    if (r->snapshot.boxed && !lo && !hi) lo = hi = true;
    for (int a = 0; a < dim; a++)
        if ((!lo || !hi) && r->setup.boundary[a] != BOUNDARY_OPEN)
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s: lo and hi are needed: the box of boundary=%s, such as lo=0 "
                             "hi=1",
                             r->source, scheme_boundary_family.members[r->setup.boundary[a]]->name);
    for (int a = 0; a < dim; a++)
        if ((lo || hi) && !(r->setup.lo[a] < r->setup.hi[a]))
            return error_set(error, STATUS_BAD_INPUT, "lo = %g, hi = %g: allowed: lo < hi",
                             r->setup.lo[a], r->setup.hi[a]);
    return STATUS_OK;
}

/* Solves for h to round-off, since rates are compared, unless the user sets h_tolerance. */
static enum status sharpen(struct settings *settings, struct error *error)
{
    if (settings->value[SETTING_h_tolerance].source != SOURCE_FALLBACK) return STATUS_OK;
    return settings_set(settings, SETTING_h_tolerance, "1e-14", SOURCE_FALLBACK, NULL, error);
}

static bool is_csv(const char *path)
{
    return text_ends(path, ".csv");
}

/* A case is a name, or a path of an .ini file; a file that is neither is a snapshot. */
static bool is_snapshot(const char *path)
{
    struct stat about;
    return !is_csv(path) && !text_ends(path, ".ini") && stat(path, &about) == 0 &&
           S_ISREG(about.st_mode);
}

static enum status take_theirs(struct request *r, const char *path, bool tolerance,
                               struct error *error)
{
    enum { SINGLE = 1 };
    struct snapshot_file file = {0};
    if (is_csv(path)) return snapshot_csv_named(path, &file, &r->theirs, r->unknown, error);
    const enum status status = snapshot_csv(path, &file, &r->theirs, r->widths, error);
    /* single precision limits the agreement of rates */
    if (!status && !tolerance && file.precision[SINGLE] > r->tolerance) r->tolerance = 1e-5;
    snapshot_file_free(&file);
    return status;
}

static enum status take_file(struct request *r, int n, char **arguments, struct error *error)
{
    char *rest[n + 1], unknown[200]; /* unknown: the same names as in file.ignored */
    int left;
    enum status status =
        is_csv(r->source)
            ? snapshot_csv_named(r->source, &r->snapshot, &r->file.csv, unknown, error)
            : snapshot_csv(r->source, &r->snapshot, &r->file.csv, r->widths, error);
    if (!status) status = particle_file_of(r->source, &r->file, error);
    if (!status) status = take_box(r, n, arguments, rest, &left, error);
    if (status) return status;
    settings_init(&r->settings);
    if ((status = settings_apply(&r->settings, left, rest, error))) return status;
    for (int k = 0; k < SETTINGS; k++)
        if (r->settings.value[k].source == SOURCE_USER && k != SETTING_gamma &&
            strcmp(setting_keys[k].section, "scheme") != 0)
            return error_set(error, STATUS_BAD_INPUT,
                             "%s says nothing about the particles of a file: allowed: the keys of "
                             "the scheme, gamma, lo, hi, boundary, gravity",
                             setting_keys[k].name);
    struct setting_value *conductivity = &r->settings.value[SETTING_shock_conductivity];
    if (conductivity->source == SOURCE_USER && conductivity->automatic && r->file.dim > 1)
        conductivity->real[0] = 1; /* auto given by the user, as in a run */
    if ((status = sharpen(&r->settings, error)) ||
        (status = settings_scheme(&r->settings, r->file.dim, &r->setup.scheme, error)))
        return status;
    if (r->snapshot.gamma.known && r->settings.value[SETTING_gamma].source != SOURCE_USER) {
        char gamma[32];
        snprintf(gamma, sizeof gamma, "%.17g", r->snapshot.gamma.value);
        status = settings_set(&r->settings, SETTING_gamma, gamma, SOURCE_CASE, r->source, error);
        if (status) return status;
    }
    r->setup.gamma = settings_real(&r->settings, SETTING_gamma);
    return particle_file_fill(&r->file, r->source, &r->setup, error);
}

static enum status take_case(struct request *r, int n, char **arguments, struct error *error)
{
    struct run_settings asked;
    struct run run;
    enum status status = run_prepare(&asked, r->source, n, arguments, error);
    if (!status) status = sharpen(&asked.settings, error);
    if (!status) status = run_resolve(&run, &asked, error);
    if (!status) status = initial_create(&r->initial, &run.problem, &run.settings, error);
    if (status) return status;
    r->settings = run.settings;
    r->setup = run_setup(&run, &r->initial);
    return STATUS_OK;
}

static enum status take_request(const struct options *options, int n, char **arguments,
                                struct request *r, struct error *error)
{
    const char *check = options_value(options, "check");
    const bool tolerance = options_value(options, "tolerance");
    if (n < 1) return command_usage(options, error, "particles are needed: a file or a case");
    r->source = arguments[0];
    r->tolerance = 1e-9;
    if (tolerance && !check)
        return error_set(error, STATUS_BAD_INPUT, "rates: --tolerance belongs to --check");
    if (options_positive(options, "tolerance", &r->tolerance, error)) return error->status;
    r->from_file = is_csv(r->source) || is_snapshot(r->source);
    enum status status = (r->from_file ? take_file : take_case)(r, n - 1, arguments + 1, error);
    if (!status && check) status = take_theirs(r, check, tolerance, error);
    r->setup.threads = options->threads;
    r->setup.skip = false;
    return status;
}

/* ---- output ---- */

static void print_table(const struct request *r, const struct rate_table *t, size_t rows)
{
    char matrix[DESCRIPTION_TEXT];
    printf("%s, %dD, %zu particles; one evaluation, code units\n", r->source, t->dim, t->n);
    if (r->from_file)
        printf("gamma = %g, shock_conductivity = %g\n", r->setup.gamma,
               r->setup.scheme.shock_conductivity);
    if (r->setup.scheme.shifting != SHIFTING_NONE)
        printf("forces and heating are without what particles exchange as they shift\n");
    if (r->widths[0]) printf("h of the snapshot: %s\n", r->widths);
    if (r->file.ignored[0]) printf("columns that are not read: %s\n", r->file.ignored);
    printf("\n%8s %13s %13s %13s", "particle", "h", "rho", "P");
    for (int a = 0; a < t->dim; a++) printf("        dp%c/dt", "xyz"[a]);
    printf(" %13s %6s %9s %6s\n", "dU/dt", "neighb", "condition", "angle");
    for (size_t i = 0; i < t->n && i < rows; i++) {
        printf("%8zu %13.6g %13.6g %13.6g", i, t->h[i], t->rho[i], t->P[i]);
        for (int a = 0; a < t->dim; a++) printf(" %13.6g", t->force[a][i]);
        printf(" %13.6g %6.0f", t->dU[i], t->described[i].neighbours);
        if (!isnan(t->described[i].condition)) printf(" %9.3g", t->described[i].condition);
        if (!isnan(t->described[i].angle)) printf(" %6.2f", t->described[i].angle);
        printf("\n");
    }
    if (t->n > rows) printf("     ... %zu more; all of them with --csv or --json\n", t->n - rows);
    printf("\nsums: force (");
    for (int a = 0; a < t->dim; a++) printf("%s%.3g", a ? ", " : "", t->sum_force[a]);
    printf("), power %.3g\n", t->power);
    description_text(&t->matrix, t->n, matrix);
    if (matrix[0]) printf("matrices: %s\n", matrix);
}

/* The verdict in one sentence. It names the first quantity that departs and whose cause is known,
 * or else the first one that departs. */
static void print_verdict(const struct rate_check *check, double tolerance)
{
    const struct rate_comparison *told = NULL;
    size_t failed = 0;
    for (size_t k = 0; k < check->count; k++) {
        const struct rate_comparison *c = &check->columns[k];
        if (c->good) continue;
        failed++;
        if (!told || (!told->cause[0] && c->cause[0] && !c->follows)) told = c;
    }
    if (!failed)
        printf("\nAll %zu quantities agree within %g.\n", check->count, tolerance);
    else if (told->cause[0])
        printf("\n%zu of %zu quantities depart by more than %g; likely cause, from %s: %s.\n",
               failed, check->count, tolerance, told->quantity, told->cause);
    else
        printf(
            "\n%zu of %zu quantities depart by more than %g, %s by %.3g at particle %zu; no single "
            "choice of the scheme that was tried explains it.\n",
            failed, check->count, tolerance, told->quantity, told->worst, told->particle);
}

static void print_check(const struct rate_check *check, const char *unknown)
{
    if (*unknown) printf("\ncolumns of theirs that are not compared: %s\n", unknown);
    printf("\n%-8s %10s %10s %9s  %-4s  %s\n", "quantity", "worst", "rms", "particle", "",
           "likely cause");
    for (size_t k = 0; k < check->count; k++) {
        const struct rate_comparison *c = &check->columns[k];
        printf("%-8s %10.3g %10.3g %9zu  %-4s  %s\n", c->quantity, c->worst, c->rms, c->particle,
               c->good ? "pass" : "FAIL", c->cause);
    }
}

static enum status write_csv(const char *path, const struct request *r, const struct rate_table *t,
                             struct error *error)
{
    struct output output;
    if (output_open(&output, path, error)) return error->status;
    fprintf(output.stream, "h,rho,P");
    for (int a = 0; a < t->dim; a++) fprintf(output.stream, ",a%c", "xyz"[a]);
    fprintf(output.stream, ",du\n");
    for (size_t i = 0; i < t->n; i++) {
        fprintf(output.stream, "%.17g,%.17g,%.17g", t->h[i], t->rho[i], t->P[i]);
        for (int a = 0; a < t->dim; a++)
            fprintf(output.stream, ",%.17g", t->force[a][i] / r->setup.m[i]);
        fprintf(output.stream, ",%.17g\n", t->dU[i] / r->setup.m[i]);
    }
    return output_close(&output, error);
}

static json_t *vector(int dim, const double *const *values, size_t i)
{
    json_t *array = json_array();
    for (int a = 0; a < dim; a++) json_array_append_new(array, result_number(values[a][i]));
    return array;
}

static json_t *particles_json(const struct request *r, const struct rate_table *t)
{
    json_t *particles = json_array();
    const double *const force[3] = {t->force[0], t->force[1], t->force[2]};
    for (size_t i = 0; i < t->n; i++)
        json_array_append_new(
            particles,
            result_object(
                "x=%p h=%g rho=%g P=%g force=%p dU=%g neighbours=%d condition=%g? angle=%g?",
                (void *)vector(t->dim, r->setup.x, i), t->h[i], t->rho[i], t->P[i],
                (void *)vector(t->dim, force, i), t->dU[i], (int)t->described[i].neighbours,
                t->described[i].condition, t->described[i].angle));
    return particles;
}

/* The scheme as used; of a file's particles the box and gamma, too. */
static json_t *used_settings(const struct request *r)
{
    json_t *all = settings_json(&r->settings), *used = json_object(), *boundary = json_array();
    const double *const ends[] = {r->setup.lo, r->setup.hi, r->setup.gravity};
    static const char *const names[] = {"lo", "hi", "gravity"};
    if (!r->from_file) {
        json_decref(used), json_decref(boundary);
        return all;
    }
    for (int k = 0; k < SETTINGS; k++)
        if (k == SETTING_gamma || strcmp(setting_keys[k].section, "scheme") == 0)
            json_object_set(used, setting_keys[k].name, json_object_get(all, setting_keys[k].name));
    for (int k = 0; k < 3; k++) {
        json_t *values = json_array();
        for (int a = 0; a < r->setup.dim; a++) json_array_append_new(values, json_real(ends[k][a]));
        json_object_set_new(used, names[k], values);
    }
    for (int a = 0; a < r->setup.dim; a++)
        json_array_append_new(
            boundary, json_string(scheme_boundary_family.members[r->setup.boundary[a]]->name));
    json_object_set_new(used, "boundary", boundary);
    json_decref(all);
    return used;
}

static json_t *comparison_json(const struct rate_check *check)
{
    json_t *comparison = json_array();
    for (size_t k = 0; k < check->count; k++) {
        const struct rate_comparison *c = &check->columns[k];
        json_array_append_new(
            comparison, json_pack("{s:s, s:o, s:o, s:i, s:s?}", "quantity", c->quantity, "worst",
                                  result_number(c->worst), "rms", result_number(c->rms), "particle",
                                  (int)c->particle, "likely_cause", c->cause[0] ? c->cause : NULL));
    }
    return comparison;
}

static enum status write_json(const struct options *options, const struct request *r,
                              const struct rate_table *t, const struct rate_check *check,
                              struct error *error)
{
    const double *const sums[3] = {&t->sum_force[0], &t->sum_force[1], &t->sum_force[2]};
    json_t *content = json_pack("{s:i, s:o, s:o, s:{s:o, s:o}}", "dim", t->dim, "settings",
                                used_settings(r), "particles", particles_json(r, t), "sums",
                                "force", vector(t->dim, sums, 0), "power", result_number(t->power));
    json_object_set_new(content, "matrix", description_json(&t->matrix));
    if (check->count)
        result_add(content, "comparison=%p status=%s", (void *)comparison_json(check),
                   check->good ? "pass" : "fail");
    return options_write_members(options, content, error);
}

/* ---- the command ---- */

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    struct request r = {0};
    struct rate_table table = {0};
    struct rate_check check = {.good = true};
    const char *csv = options_value(options, "csv"), *theirs = options_value(options, "check");
    enum status status = take_request(options, n, arguments, &r, error);
    if (!status && csv) status = output_probe(csv, error);
    if (!status) status = rate_table_make(&table, &r.setup, error);
    if (!status && theirs && is_csv(theirs))
        status = rate_check_positions(theirs, &r.theirs, &r.setup, error);
    if (!status && theirs)
        status = rate_check_make(&check, theirs, &r.theirs, &r.setup, &table, r.tolerance, error);
    if (!status) {
        if (options->speak) {
            print_table(&r, &table, theirs ? ROWS_CHECKED : ROWS_SHOWN);
            if (theirs) print_check(&check, r.unknown), print_verdict(&check, r.tolerance);
        }
        if (csv) status = write_csv(csv, &r, &table, error);
        if (!status && options->json) status = write_json(options, &r, &table, &check, error);
        if (!status && !check.good) status = STATUS_CHECK_FAILED;
    }
    rate_table_free(&table);
    csv_free(&r.theirs);
    particle_file_free(&r.file);
    snapshot_file_free(&r.snapshot);
    initial_free(&r.initial);
    return status;
}

static const struct command_option own_options[] = {
    {"csv", "F.csv", "write h,rho,P,ax[,ay[,az]],du of every particle, in their order"},
    {"check", "THEIRS", "compare with what another code computed: any of these columns"},
    {"tolerance", "T",
     "tolerance of --check, relative; for a and du relative to their largest value (default 1e-9)"},
    {NULL, NULL, NULL},
};

const struct command command_rates = {
    .name = "rates",
    .synopsis = "PARTICLES.csv|SNAPSHOT|CASE [KEY=VALUE ...]",
    .help =
        "one evaluation, nothing moves: h, rho, P, dp/dt, dU/dt of every particle\n"
        "A file has the columns x[,y[,z]], vx[,vy[,vz]], m, u in any order, whose number gives "
        "the\n"
        "dimension; other usual names (acceleration_x) are known, too, and so are snapshots (see\n"
        "judge). Keys are those of the scheme, gamma (default: the file's, or 1.4) and, unless "
        "the\n"
        "file says its box (# box = 0:1), lo and hi (one number, or one for each direction),\n"
        "boundary (periodic, open or reflecting; one word or one each) and gravity.\n"
        "shock_conductivity is 0 unless given, since few codes have it. h is found to 1e-14 "
        "unless\n"
        "h_tolerance says otherwise. With --check (a CSV file, or a snapshot with accelerations; "
        "in\n"
        "single precision the tolerance is 1e-5) the exit status is 1 if a column departs by more\n"
        "than the tolerance; choices of the scheme are then changed one by one to see which of "
        "them\n"
        "explains it.",
    .run = run,
    .options = own_options,
    .examples = "sphproof rates particles.csv lo=0 hi=1 kernel=cubic_spline eta=2.4\n"
                "sphproof rates particles.csv lo=0 hi=1 --csv ours.csv\n"
                "sphproof rates particles.csv lo=0 hi=1 --check theirs.csv --tolerance 1e-8\n"
                "sphproof rates sod n=450 --json rates.json",
};
