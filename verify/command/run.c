/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof run: one run with its errors, conservation and cost. */
#include "run.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cache.h"
#include "code_run.h"
#include "command.h"
#include "movie.h"
#include "output.h"
#include "picture.h"
#include "progress.h"
#include "result.h"
#include "run_job.h"
#include "run_output.h"
#include "run_plot.h"
#include "snapshot_writer.h"
#include "table.h"
#include "text.h"
#include "value.h"

/* Prints eta and the corresponding numbers that other codes use for the same width. */
static void print_width(const struct settings *settings)
{
    static const double unit_ball[] = {0, 2, M_PI, 4 * M_PI / 3};
    const double eta = settings_real(settings, SETTING_eta);
    const int dim = settings->dim;
    printf("width: the support radius is %.4g mean spacings, so it holds about %.0f neighbours; "
           "h/dx = %.4g where h is half of the support radius\n",
           eta, unit_ball[dim] * pow(eta, dim), eta / 2);
}

static void print_head(const struct run_settings *settings, const struct run_result *result,
                       const struct table_style *style)
{
    const char *const parts[] = {"kernel",         "eta",        "gradient", "formulation",
                                 "volume_element", "integrator", "cfl",      "energy",
                                 "viscosity",      "alpha",      "beta"};
    char line[16 * SETTING_TEXT_MAX]; /* more than all of them need */
    size_t used = 0;
    printf("%s%s%s: %s\n", style->bold, settings->file.name, style->end, settings->file.title);
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        char value[SETTING_TEXT_MAX];
        settings_text(&result->settings, (enum setting)setting_find(parts[i]), value);
        used += (size_t)snprintf(line + used, sizeof line - used, "%s%s=%s", i ? " " : "", parts[i],
                                 value);
    }
    table_wrap("", line);
    print_width(&result->settings);
}

static void print_start(const struct run_result *result)
{
    if (isnan(result->start.density)) return;
    printf("start: a glass; rms of its density (wendland_c4, eta 3.6) %.2g, of h grad 1 %.2g; "
           "distances of nearest neighbours +-%.2g %%\n",
           result->start.density, result->start.gradient, 100 * result->start.spread);
}

static void print_norms(const char *name, const struct norms *e, const char *unit)
{
    printf("%-16s %12.4e %12.4e %12.4e %14.4e  %s\n", name, e->l1, e->l2, e->linf, e->particle_mean,
           unit);
}

static void describe_window(const struct window *window, char *text, size_t size)
{
    int used = 0;
    if (window->radius > 0) used = snprintf(text, size, "|x - centre| <= %g in ", window->radius);
    for (int d = 0; d < window->dim; d++)
        used += snprintf(text + used, size - (size_t)used, "%s[%g, %g]", d ? " x " : "",
                         window->lo[d], window->hi[d]);
}

/* Prints functionals of the state and their exact values. */
static void print_functionals(const struct run_result *result, const struct table_style *style)
{
    bool unknown = false;
    if (result->functional_count == 0) return;
    printf("\n%s%-16s %14s %14s%s\n", style->bold, "at the end", "measured", "reference",
           style->end);
    for (size_t i = 0; i < result->functional_count; i++) {
        const struct run_functional *f = &result->functionals[i];
        char exact[24] = "unknown";
        if (!isnan(f->exact)) snprintf(exact, sizeof exact, "%.8g", f->exact);
        if (isnan(f->value))
            printf("%-16s %14s %14s\n", f->name, "-", exact);
        else
            printf("%-16s %14.8g %14s\n", f->name, f->value, exact);
        unknown |= isnan(f->value);
    }
    if (unknown)
        printf(
            "-: not measured, since there are too few particles where it is measured, or the run "
            "is too short\n");
}

static void print_errors(const struct run_settings *settings, const struct run_result *result,
                         const struct table_style *style)
{
    const int dim = result->problem.domain.dim;
    const struct problem *problem = result->problem.problem;
    char window[160], interpolation[400];
    describe_window(&result->problem.window, window, sizeof window);
    if (problem->fieldless) {
        printf("\nno errors of fields: after the start nothing is exact\n");
        return;
    }
    printf("\n%s%-16s %12s %12s %12s %14s  %s%s\n", style->bold, "error", "L1", "L2", "Linf",
           "particle mean", "unit", style->end);
    for (int field = 0; field < FIELDS; field++) {
        const struct norms *e = &result->errors[field];
        if (!settings->file.fields[field] || !problem_knows(problem, (enum field)field)) continue;
        print_norms(field_family.members[field]->name, e, field_unit((enum field)field, dim));
    }
    if (problem_is_circular(&result->problem)) {
        print_norms("  azimuthal", &result->azimuthal, field_unit(FIELD_VELOCITY, dim));
        print_norms("  radial", &result->radial, field_unit(FIELD_VELOCITY, dim));
    }
    if (dim == 1 && problem_knows(problem, FIELD_DENSITY))
        printf("%-16s %12.4e  mean over %d bins of |mean density - mean exact density|\n",
               "density, binned", result->binned_density_l1, NORM_BINS);
    run_interpolation_text(result->interpolation, interpolation, sizeof interpolation);
    if (interpolation[0]) printf("%s\n", interpolation);
    printf(
        "%sL1 = sum V|q - exact|/sum V, V = volumes cut at the window's edge; L2 = sqrt(sum V (q - "
        "exact)^2/sum V), V whole;\nLinf = max |q - exact|, particle mean = sum |q - exact|/N: "
        "over the %zu particles in %s at t = %g; code units%s\n",
        style->faint, result->errors[0].n, window, result->time, style->end);
}

static void print_conservation(const struct run_result *result, const struct table_style *style)
{
    char turning[48] = "";
    if (result->problem.domain.dim > 1)
        snprintf(turning, sizeof turning, "angular momentum %.1e  ",
                 result->drift.angular_momentum);
    printf("\n%sconservation%s     mass %.1e  momentum %.1e  %senergy %.1e  (relative, t = %g "
           "against 0)\n",
           style->bold, style->end, result->drift.mass, result->drift.momentum, turning,
           result->drift.energy, result->time);
    const struct trace_motion *motion = &result->motion;
    if (result->problem.problem->steady && isfinite(motion->rebound))
        printf(
            "                 kinetic energy: regained %.1e, first and second half differ by %.1e "
            "(of the start's)\n",
            motion->rebound, motion->asymmetry);
}

static void print_rest(const struct run_result *result, const struct table_style *style)
{
    const struct simulation_cost *cost = &result->cost;
    char matrix[DESCRIPTION_TEXT];
    print_conservation(result, style);
    description_text(&result->matrix, result->n, matrix);
    if (result->problem.domain.dim > 1 && matrix[0])
        printf("%smatrices%s         %s\n", style->bold, style->end, matrix);
    if (cost->fallen_back_most > result->matrix.fallen_back)
        printf("                 in the course of the run up to %llu particles with the standard "
               "gradient\n",
               (unsigned long long)cost->fallen_back_most);
    printf("%scost%s             %.4g s wall, %.4g s CPU, %llu steps, %llu particle updates (%llu "
           "skipped),\n                 %llu pair interactions, %.1f MB\n",
           style->bold, style->end, cost->wall_s, cost->cpu_s, (unsigned long long)cost->steps,
           (unsigned long long)cost->particle_updates,
           (unsigned long long)cost->skipped_particle_updates,
           (unsigned long long)cost->pair_interactions, 1e-6 * result->peak_rss);
}

static void print_plan(const struct run_result *result, const struct table_style *style)
{
    printf("\n%s%-28s %-6s %s%s\n", style->bold, "pass", "runs", "why", style->end);
    for (size_t i = 0; i < result->plan_count; i++)
        printf("%-28s %-6s %s\n", result->plan[i].pass, result->plan[i].runs ? "yes" : "no",
               result->plan[i].why);
}

static void print_estimate(const struct run_result *result, const struct table_style *style)
{
    const struct estimate *e = &result->estimate;
    printf("\n%sit would take%s     about %.0f MB of memory, %.2g s of CPU time; %.2g steps if "
           "signals stayed as at the start\n",
           style->bold, style->end, 1e-6 * e->memory, e->cpu_s, e->steps);
}

/* snapshots: intermediate ones; path NULL: none. */
static enum status check_files(const struct options *options, const struct snapshots *snapshots,
                               struct error *error)
{
    const char *plot = options_value(options, "plot");
    const char *snapshot = options_value(options, "snapshot");
    if (snapshot && options->json && strcmp(snapshot, options->json) == 0)
        return error_set(error, STATUS_BAD_INPUT,
                         "--json and --snapshot name the same file '%.150s'", snapshot);
    const struct snapshot_writer *writer = snapshot ? snapshot_writer_of(snapshot, error) : NULL;
    if (snapshot && !writer) return error->status;
    if (writer && writer->possible && writer->possible(snapshot, error)) return error->status;
    const bool movie = plot && movie_wanted(plot);
    if (movie && !snapshots->path)
        return error_set(error, STATUS_BAD_INPUT,
                         "--plot '%.150s': a movie needs --snapshot-every TIME and --snapshot FILE",
                         plot);
    if (plot && (movie ? movie_probe : picture_probe)(plot, error)) return error->status;
    if (snapshot && output_probe(snapshot, error)) return error->status;
    if (!snapshots->path) return STATUS_OK;
    return output_probe(snapshots_path(snapshots, 0).text, error);
}

struct progress_of_run {
    struct progress progress;
    bool stepping;
    double t_end;
};

static bool show_progress(void *context, double time, uint64_t steps)
{
    struct progress_of_run *of_run = context;
    (void)steps;
    if (!of_run->stepping) progress_from(&of_run->progress, time / of_run->t_end);
    of_run->stepping = true;
    progress_update(&of_run->progress, time, of_run->t_end);
    return true;
}

static enum status write_json(const struct options *options, const struct run_settings *settings,
                              const struct run_result *result, struct error *error)
{
    json_t *document = result_new("run");
    run_add_json(settings, result, document);
    return options_write(options, document, error);
}

static void remark(const struct options *options, const char *text)
{
    if (text[0] && !options->quiet) fprintf(stderr, "sphproof: note: %s\n", text);
}

/* Remarks that a plain number counts all particles, not those along one side. */
static void remark_count(const struct options *options, const struct settings *settings)
{
    const struct setting_value *n = &settings->value[SETTING_n];
    const int dim = settings->dim;
    char text[120];
    if (dim < 2 || n->source != SOURCE_USER || n->exponent || n->real[0] > 200) return;
    snprintf(text, sizeof text,
             "n=%.0f is the number of all particles, about %.0f along each side; did you mean "
             "n=%.0f^%d?",
             n->real[0], pow(n->real[0], 1.0 / dim), n->real[0], dim);
    remark(options, text);
}

static enum status explain(const struct options *options, const struct run *run,
                           struct error *error)
{
    const struct run_settings *settings = &run->asked;
    struct run_result result;
    const struct table_style style = table_style(options->color);
    enum status status = run_explain(run, &result, error);
    if (status) return status;
    remark(options, result.warnings);
    remark_count(options, &result.settings);
    if (options->speak) {
        print_head(settings, &result, &style);
        printf("n=%zu; nothing has been run\n", result.n);
        print_plan(&result, &style);
        print_estimate(&result, &style);
    }
    json_t *document = result_new("run");
    run_add_plan(settings, &result, document);
    return options_write(options, document, error);
}

static void print_snapshots(const struct snapshots *snapshots, double t_end)
{
    const size_t count = snapshots_count(snapshots, t_end);
    printf("snapshots        %s to %s, t = 0 to %.9g in steps of %.9g; %s at the end\n",
           snapshots_path(snapshots, 0).text, snapshots_path(snapshots, count - 1).text,
           snapshots_time(snapshots, count - 1), snapshots->every, snapshots->path);
}

/* A picture of each intermediate snapshot: F_0000.svg, F_0001.svg ... for F.svg, or a frame of a
 * movie. */
struct pictures {
    const struct run_settings *settings;
    const char *path;
    struct movie movie;
};

static void show_moment(void *context, const struct run_result *moment, size_t number,
                        struct error *error)
{
    struct pictures *pictures = context;
    const struct snapshots named = {.path = pictures->path};
    if (movie_wanted(pictures->path))
        run_plot(pictures->settings, moment, NULL, &pictures->movie, error);
    else
        run_plot(pictures->settings, moment, snapshots_path(&named, number).text, NULL, error);
}

static void draw_end(const struct run_settings *settings, const struct snapshots *snapshots,
                     const struct run_result *result, const char *path, struct error *error)
{
    struct pictures *pictures = snapshots ? snapshots->context : NULL;
    struct movie *movie = pictures && movie_wanted(path) ? &pictures->movie : NULL;
    const enum status status = run_plot(settings, result, path, movie, error);
    if (!status && movie) movie_write(movie, path, error);
}

/* snapshots: NULL where there is none. */
static enum status present(const struct options *options, const struct run_settings *settings,
                           const struct snapshots *snapshots, const struct run_result *result,
                           struct error *error)
{
    const char *plot = options_value(options, "plot");
    const char *snapshot = options_value(options, "snapshot");
    const struct table_style style = table_style(options->color);
    remark(options, result->warnings);
    remark_count(options, &result->settings);
    remark(options, result->suspicion);
    if (options->speak && result->status != STATUS_BROKE_DOWN) {
        print_head(settings, result, &style);
        printf("n=%zu t=%g\n", result->n, result->time);
        print_start(result);
        print_errors(settings, result, &style);
        if (result->problem.domain.dim > 1) print_functionals(result, &style);
        print_rest(result, &style);
        if (snapshots && !snapshots->trouble.status)
            print_snapshots(snapshots, settings_real(&result->settings, SETTING_t_end));
    }
    /* all other files are written even if one cannot be; the first error is reported */
    struct error later;
    *error = snapshots ? snapshots->trouble : (struct error){0};
    write_json(options, settings, result, error->status ? &later : error);
    if (snapshot) run_write_snapshot(result, snapshot, error->status ? &later : error);
    if (plot) draw_end(settings, snapshots, result, plot, error->status ? &later : error);
    const struct snapshot_writer *writer =
        snapshots ? snapshot_writer_of(snapshots->path, &later) : NULL;
    if (writer && writer->collect)
        writer->collect(result, snapshots, error->status ? &later : error);
    return error->status;
}

/* Prepares intermediate snapshots; snapshots->path is NULL if none are requested. */
static enum status take_snapshots(struct snapshots *snapshots, const struct options *options,
                                  const struct run *run, struct error *error)
{
    const char *every = options_value(options, "snapshot-every");
    struct error why = {0};
    *snapshots = (struct snapshots){0};
    if (!every) return STATUS_OK;
    snapshots->path = options_value(options, "snapshot");
    if (!snapshots->path || strcmp(snapshots->path, "-") == 0)
        return error_set(error, STATUS_BAD_INPUT,
                         "run: --snapshot-every needs --snapshot FILE, after which its files are "
                         "named");
    (void)text_real(every, &snapshots->every); /* stays 0 if it is no number */
    if (snapshots_check(snapshots, settings_real(&run->settings, SETTING_t_end), &why))
        return error_set(error, STATUS_BAD_INPUT, "run: --snapshot-every '%.40s': %s", every,
                         why.message);
    return STATUS_OK;
}

struct kept {
    bool wanted;
    struct checkpoint checkpoint;
    char build[CACHE_BUILD_MAX], *run;
};

/* The caller frees kept->run. */
static enum status take_checkpoint(struct kept *kept, const struct options *options,
                                   const struct run *run, struct error *error)
{
    const char *path = options_value(options, "checkpoint"),
               *every = options_value(options, "every");
    double seconds = 60;
    if (!path && (every || options_value(options, "resume")))
        return error_set(error, STATUS_BAD_INPUT, "run: --%s needs --checkpoint FILE",
                         every ? "every" : "resume");
    if (every && !(text_real(every, &seconds) && seconds >= 0))
        return error_set(error, STATUS_BAD_INPUT,
                         "run: --every '%.40s': allowed: seconds, a number >= 0", every);
    if (!path) return STATUS_OK;
    if (output_probe(path, error)) return error->status;
    if (!(kept->run = run_job_key(run, "checkpoint", error))) return error->status;
    cache_build(kept->build);
    kept->wanted = true;
    kept->checkpoint = (struct checkpoint){.path = path,
                                           .build = kept->build,
                                           .run = kept->run,
                                           .every = seconds,
                                           .snapshot = -1,
                                           .resume = options_value(options, "resume")};
    return STATUS_OK;
}

/* ---- of another code ---- */

static void print_other(const struct run_settings *settings, const struct judged *judged,
                        const json_t *document, const struct options *options)
{
    const struct table_style style = table_style(options->color);
    const struct run_result *result = &judged->result;
    const struct snapshot_notes *notes = &judged->file.notes;
    printf("%s%s%s: %s\ncomputed by %s: %s\n", style.bold, settings->file.name, style.end,
           settings->file.title, settings->external->title,
           value_text(json_object_get(document, "code"), "command"));
    printf("n=%zu t=%g\n\nassumed:\n", result->n, result->time);
    for (size_t k = 0; k < notes->count; k++)
        printf("  %-16s %s  %s%s%s\n", notes->note[k].what, notes->note[k].value, style.faint,
               notes->note[k].evidence, style.end);
    print_errors(settings, result, &style);
    if (result->problem.domain.dim > 1) print_functionals(result, &style);
    print_conservation(result, &style);
    printf("%scost%s             %.4g s wall, %.4g s CPU\n", style.bold, style.end,
           result->cost.wall_s, result->cost.cpu_s);
}

static enum status present_other(const struct options *options, const struct run_settings *settings,
                                 const struct judged *judged, const json_t *document,
                                 struct error *error)
{
    const char *plot = options_value(options, "plot");
    if (judged) remark(options, judged->result.suspicion);
    if (judged && options->speak) print_other(settings, judged, document, options);
    if (options->json && result_write(document, options->json, error)) return error->status;
    return plot && judged ? run_plot(&judged->run.asked, &judged->result, plot, NULL, error)
                          : STATUS_OK;
}

/* Refuses snapshots, checkpoints and plans, which only our solver makes. */
static enum status check_other(const struct options *options, struct error *error)
{
    static const char *const ours[] = {"snapshot", "snapshot-every", "checkpoint",
                                       "every",    "resume",         "explain"};
    const char *plot = options_value(options, "plot");
    for (size_t k = 0; k < sizeof ours / sizeof *ours; k++)
        if (options_value(options, ours[k]))
            return error_set(error, STATUS_BAD_INPUT,
                             "run: --%s and --code exclude each other (--work DIR keeps what the "
                             "code writes)",
                             ours[k]);
    if (plot && movie_wanted(plot))
        return error_set(error, STATUS_BAD_INPUT, "run: --plot '%.150s': no movie with --code",
                         plot);
    return plot ? picture_probe(plot, error) : STATUS_OK;
}

static enum status run_other(const struct options *options, int n, char **arguments,
                             struct error *error)
{
    struct code code;
    struct code_external external;
    struct run_settings settings;
    struct judged *judged = calloc(1, sizeof *judged);
    struct run *run = calloc(1, sizeof *run);
    struct error trouble;
    json_t *document = NULL;
    enum status status = STATUS_OK;
    if (!judged || !run) status = error_set(error, STATUS_ENVIRONMENT, "no memory for a run");
    if (!status) status = check_other(options, error);
    if (!status) status = code_load(&code, options_value(options, "code"), error);
    if (status) goto end;
    status = code_prepare(&code, arguments[0], options_value(options, "work"), n - 1, arguments + 1,
                          &external, &settings, error);
    settings.threads = options->threads;
    if (!status) status = run_resolve(run, &settings, error);
    if (!status) status = code_run(run, judged, &document, error);
    if (document && present_other(options, &settings, status ? NULL : judged, document, &trouble)) {
        *error = trouble;
        status = trouble.status;
    }
    if (document && !json_object_get(document, "reason")) judge_free(judged);
    code_free(&code);
end:
    json_decref(document);
    free(judged), free(run);
    return status;
}

static enum status run_case(const struct options *options, int n, char **arguments,
                            struct error *error)
{
    struct run_settings settings;
    struct run_result result;
    struct run run;
    if (n < 1) return command_usage(options, error, "a case is needed (`sphproof list cases`)");
    if (options_value(options, "code")) return run_other(options, n, arguments, error);
    if (options_value(options, "work"))
        return error_set(error, STATUS_BAD_INPUT, "run: --work needs --code FILE");
    if (run_prepare(&settings, arguments[0], n - 1, arguments + 1, error)) return error->status;
    settings.threads = options->threads;
    if (run_resolve(&run, &settings, error)) return error->status;
    struct snapshots snapshots;
    if (take_snapshots(&snapshots, options, &run, error)) return error->status;
    if (snapshots.path) run.asked.snapshots = &snapshots;
    struct pictures pictures = {.settings = &settings, .path = options_value(options, "plot")};
    if (pictures.path) snapshots.show = show_moment, snapshots.context = &pictures;
    if (options_value(options, "explain")) return explain(options, &run, error);
    if (check_files(options, &snapshots, error)) return error->status;

    struct kept kept = {0};
    if (take_checkpoint(&kept, options, &run, error)) return error->status;
    if (kept.wanted) run.asked.checkpoint = &kept.checkpoint;
    struct progress_of_run of_run = {.t_end = settings_real(&run.settings, SETTING_t_end)};
    progress_begin(&of_run.progress, settings.file.name, options->quiet);
    run.asked.progress = show_progress;
    run.asked.progress_context = &of_run;
    run.asked.each_step = true;
    enum status status = run_execute(&run, &result, error);
    progress_end(&of_run.progress);
    if (kept.checkpoint.trouble.status) remark(options, kept.checkpoint.trouble.message);
    free(kept.run);
    if (status != STATUS_OK && status != STATUS_BROKE_DOWN) {
        movie_free(&pictures.movie);
        return status;
    }
    struct error trouble = {0};
    if (present(options, &settings, run.asked.snapshots, &result, &trouble)) {
        *error = trouble;
        status = trouble.status;
    }
    movie_free(&pictures.movie);
    run_free(&result);
    return status;
}

static const struct command_option own_options[] = {
    {"snapshot", "FILE",
     "write the particles at the end: x,vx,m,rho,u,P,h (x,y,vx,vy ...), one line each; F.hdf5 or "
     "F.h5: HDF5 in GADGET's layout; F.vtu: XML of VTK, for ParaView"},
    {"snapshot-every", "TIME",
     "write also F_0000.csv at the start, F_0001.csv after this simulation time, and so on, and "
     "for F.vtu a collection F.pvd; --plot P.png then draws P_0000.png ..., and --plot P.gif or "
     "P.mp4 makes a movie (needs ffmpeg)"},
    {"checkpoint", "FILE",
     "save the run's state there, from which --resume continues to the last bit"},
    {"every", "SECONDS", "time between two checkpoints (default 60)"},
    {"resume", NULL, "continue from the checkpoint; begin at the start if there is none"},
    {"plot", "FILE.svg|.png|.gif|.mp4",
     "draw profiles over the exact solution and the error, in 2D and 3D maps; FILE.dat and FILE.gp "
     "are written too, from which `gnuplot FILE.gp` draws FILE.svg again (needs gnuplot)"},
    {"code", "CODE.ini", CODE_OPTION_HELP},
    {"work", "DIR", CODE_WORK_HELP},
    {"explain", NULL,
     "run nothing; print the plan, its reasons, and the memory and time that the run would take"},
    {NULL, NULL, NULL},
};

const struct command command_run = {
    .name = "run",
    .synopsis = "CASE [KEY=VALUE ...]",
    .help = "one run: errors, conservation, cost\n"
            "CASE is a built-in name (`sphproof list cases`) or the path of a case file (with a "
            "slash,\nor ending in .ini). Keys and what they may be: `sphproof list keys`. Without "
            "keys the\ncase's own scheme is used.",
    .run = run_case,
    .options = own_options,
    .examples = "sphproof run sod\n"
                "sphproof run sod n=800 kernel=cubic_spline eta=2 gradient=ia --plot sod.svg\n"
                "sphproof run sod left=\"1 0.75 1\" t_end=0.15 --json -\n"
                "sphproof run ./my_tube.ini --snapshot end.csv\n"
                "sphproof run sedov_3d n=64^3 --checkpoint sedov.state --resume\n"
                "sphproof run gresho --snapshot gresho.hdf5 --snapshot-every 0.5\n"
                "sphproof run sod --code mine.ini --work runs\n"
                "sphproof run sound_wave --explain",
};
