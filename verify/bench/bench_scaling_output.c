/* SPDX-License-Identifier: GPL-3.0-or-later
 * A scaling study as tables, JSON and a plot. */
#include <math.h>
#include <stdio.h>

#include "bench_scaling.h"
#include "picture.h"
#include "result.h"
#include "run_output.h"

static json_t *exponent_json(const char *of, const struct order_fit *fit)
{
    return result_object("of=%s exponent=%g low=%g high=%g", of, -fit->order, -fit->high,
                         -fit->low);
}

void bench_scaling_add_json(const struct scaling *scaling, json_t *document)
{
    json_t *points = json_array(), *levels = json_array(), *threads = json_array(),
           *exponents = json_array();
    for (size_t i = 0; i < scaling->level_count; i++) {
        const struct scaling_level *level = &scaling->levels[i];
        json_array_append_new(levels,
                              result_object("n=%zu step_cpu_s=%g ns_per_particle=%g "
                                            "set_up_cpu_s=%g spread=%g peak_rss_bytes=%g",
                                            level->n, level->step_cpu_s,
                                            1e9 * level->step_cpu_s / (double)level->n,
                                            level->set_up_cpu_s, level->spread, level->peak_rss));
        if (!isfinite(level->run_cpu_s)) continue;
        json_array_append_new(points, result_object("settings=%p n=%zu error=%g wall_s=%g cpu_s=%g "
                                                    "pair_interactions=%g steps=%zu on_front=%d?",
                                                    (void *)settings_json(&level->settings),
                                                    level->n, level->error, level->run_wall_s,
                                                    level->run_cpu_s, level->run_pairs,
                                                    (size_t)level->run_steps, level->on_front));
    }
    for (size_t i = 0; i < scaling->thread_count; i++) {
        const struct scaling_threads *t = &scaling->threads[i];
        json_array_append_new(
            threads,
            result_object(
                "n=%zu threads=%d step_wall_s=%g gain=%g gain_of_processes=%g same_bits=%d?", t->n,
                t->threads, t->wall_s, t->gain, t->gain_of_processes, t->same_bits));
    }
    if (scaling->step.n)
        json_array_append_new(exponents, exponent_json("step_cpu_s", &scaling->step));
    if (scaling->run.n) json_array_append_new(exponents, exponent_json("cpu_s", &scaling->run));
    result_add(document, "case=%s points=%p scaling=%p", scaling->settings->file.name,
               (void *)points,
               (void *)result_object("levels=%p exponents=%p threads=%p bytes_per_particle=%g",
                                     (void *)levels, (void *)exponents, (void *)threads,
                                     scaling->bytes_per_particle));
}

static void print_exponent(const char *what, const struct order_fit *fit)
{
    if (fit->n)
        printf("  %-34s n^%.3f   95 %% interval [%.3f, %.3f]\n", what, -fit->order, -fit->high,
               -fit->low);
    else
        printf("  %-34s (at least %d resolutions are needed)\n", what, ORDER_LEVELS_MIN);
}

void bench_scaling_print(const struct scaling *scaling, const struct table_style *style)
{
    printf("%s%s%s: %s: how cost grows\n", style->bold, scaling->settings->file.name, style->end,
           scaling->settings->file.title);
    printf("%s%10s %12s %12s %12s %7s %12s %9s %10s%s\n", style->bold, "n", "step CPU s",
           "ns/particle", "set-up CPU s", "spread", "run CPU s", "steps", "peak MB", style->end);
    for (size_t i = 0; i < scaling->level_count; i++) {
        const struct scaling_level *level = &scaling->levels[i];
        printf("%10zu", level->n);
        if (isfinite(level->step_cpu_s))
            printf(" %12.3e %12.3g", level->step_cpu_s, 1e9 * level->step_cpu_s / (double)level->n);
        else
            printf(" %12s %12s", "-", "-");
        printf(" %12.3e %6.0f%%", level->set_up_cpu_s, 100 * level->spread);
        if (isfinite(level->run_cpu_s))
            printf(" %12.3e %9llu", level->run_cpu_s, (unsigned long long)level->run_steps);
        else
            printf(" %12s %9s", "-", "-");
        printf(" %10.1f\n", 1e-6 * level->peak_rss);
    }
    printf("%sstep: of the start, all particles awake, one thread; run: as given, to t_end (up to "
           "n = 10000)%s\n",
           style->faint, style->end);
    printf("%sexponents%s\n", style->bold, style->end);
    print_exponent("CPU time of a step", &scaling->step);
    print_exponent("CPU time of a whole run", &scaling->run);
    if (isfinite(scaling->bytes_per_particle))
        printf("%smemory%s\n  %.0f bytes a particle (slope of the peak; set-up, solver, snapshot "
               "and errors)\n",
               style->bold, style->end, scaling->bytes_per_particle);
    if (!scaling->thread_count) return;
    printf("%sthreads%s (wall time of a step, against one thread of the same benchmark)\n",
           style->bold, style->end);
    for (size_t i = 0; i < scaling->thread_count; i++) {
        const struct scaling_threads *t = &scaling->threads[i];
        printf("  n = %-8zu %d threads: %.3e s, %.2f times as fast, %s; processes %.2f\n", t->n,
               t->threads, t->wall_s, t->gain, t->same_bits ? "same bits" : "OTHER BITS",
               t->gain_of_processes);
    }
    printf(
        "%sprocesses: what as many runs of one thread gain, at once, each in a process of its own, "
        "whose start counts%s\n",
        style->faint, style->end);
}

enum status bench_scaling_plot(const struct scaling *scaling, const char *path, struct error *error)
{
    double n[CASE_LADDER_MAX], step[CASE_LADDER_MAX], run[CASE_LADDER_MAX];
    size_t runs = 0;
    for (size_t i = 0; i < scaling->level_count; i++) {
        n[i] = (double)scaling->levels[i].n;
        step[i] = scaling->levels[i].step_cpu_s;
        run[i] = scaling->levels[i].run_cpu_s;
        runs += isfinite(run[i]) ? 1u : 0u;
    }
    char titles[2][64];
    snprintf(titles[0], sizeof titles[0], "a step, n^%.2f", -scaling->step.order);
    snprintf(titles[1], sizeof titles[1], "a whole run, n^%.2f", -scaling->run.order);
    const struct plot_series series[] = {
        {.label = scaling->step.n ? titles[0] : "a step",
         .kind = PLOT_LINES_POINTS,
         .n = scaling->level_count,
         .x = n,
         .y = step},
        {.label = scaling->run.n ? titles[1] : "a whole run",
         .kind = PLOT_LINES_POINTS,
         .n = runs,
         .x = n,
         .y = run},
    };
    const struct plot_panel panel = {.x_label = "number of particles",
                                     .y_label = "CPU time (s)",
                                     .x_log = true,
                                     .y_log = true,
                                     .key = PLOT_KEY_END,
                                     .series = series,
                                     .series_count = runs ? 2 : 1};
    char title[256];
    snprintf(title, sizeof title, "%.200s: how cost grows", scaling->settings->file.title);
    const struct plot plot = {.name = "scaling",
                              .title = title,
                              .show_title = true,
                              .width = 680,
                              .height = 420,
                              .panels = &panel,
                              .panel_count = 1};
    return picture_write(&plot, path, error);
}
