/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "check.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check_run.h"
#include "clock.h"
#include "list.h"

const struct user_figures *check_kernel_plugin;

static void add_figure(struct check_run *run, struct figure figure)
{
    const double now = clock_wall();
    figure.check = run->check;
    figure.seconds = now - run->began;
    run->began = now;
    if (!figure.subject || !list_grow(&run->figures, run->figure_count, sizeof figure)) {
        run->no_memory = true;
        free(figure.subject);
        return;
    }
    run->rejected = run->rejected || (run->mutant && figure.status == FINDING_FAIL);
    run->figures[run->figure_count++] = figure;
}

static char *format_text(const char *format, va_list arguments)
{
    char text[400];
    vsnprintf(text, sizeof text, format, arguments);
    return strdup(text);
}

void check_measure(struct check_run *run, double value, double bound, double floor,
                   const char *subject, ...)
{
    va_list arguments;
    va_start(arguments, subject);
    char *text = format_text(subject, arguments);
    va_end(arguments);
    add_figure(run, (struct figure){.subject = text,
                                    .value = value,
                                    .bound = bound,
                                    .floor = floor,
                                    .status = finding_judge(value, bound, floor)});
}

void check_subject(struct check_run *run, const void *subject, size_t size)
{
    void *copy = size ? malloc(size) : NULL;
    if ((size && !copy) || !list_grow(&run->subjects, run->subject_count, sizeof *run->subjects)) {
        free(copy);
        run->no_memory = true;
        return;
    }
    if (size) memcpy(copy, subject, size);
    run->subjects[run->subject_count++] = (struct subject){subject, copy};
}

bool check_decided(const struct check_run *run)
{
    return run->rejected;
}

void check_skip(struct check_run *run, const char *why, ...)
{
    const double nan = (double)NAN;
    va_list arguments;
    va_start(arguments, why);
    char *text = format_text(why, arguments);
    va_end(arguments);
    add_figure(
        run,
        (struct figure){
            .subject = text, .value = nan, .bound = nan, .floor = nan, .status = FINDING_SKIP});
}

/* NULL: no memory, or no values. */
static double *copy_of(const double *values, size_t n)
{
    double *copy = malloc(n * sizeof *copy);
    if (copy) memcpy(copy, values, n * sizeof *copy);
    return copy;
}

void check_series(struct check_run *run, const char *label, size_t n, const double *x,
                  const double *y)
{
    const struct series series = {.check = run->check,
                                  .n = n,
                                  .label = strdup(label),
                                  .x = copy_of(x, n),
                                  .y = copy_of(y, n)};
    if (!series.label || (n && !(series.x && series.y)) ||
        !list_grow(&run->series, run->series_count, sizeof series)) {
        free(series.label), free(series.x), free(series.y);
        run->no_memory = true;
        return;
    }
    run->series[run->series_count++] = series;
}
