/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "code_snapshot.h"

#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const code_reason_names[REASONS] = {"",
#define REASON(name) #name,
                                                CODE_REASON_LIST(REASON)
#undef REASON
};

/* ---- which file ---- */

static int by_name(const void *a, const void *b)
{
    const char *x = *(const char *const *)a, *y = *(const char *const *)b;
    const size_t m = strlen(x), n = strlen(y);
    return m != n ? (m > n) - (m < n) : strcmp(x, y);
}

bool code_match(const char *pattern, struct code_matches *matches)
{
    glob_t found = {0};
    bool sound = true;
    *matches = (struct code_matches){0};
    const int trouble = glob(pattern, GLOB_NOSORT, NULL, &found);
    if (trouble == GLOB_NOSPACE) return false;
    if (!trouble && found.gl_pathc) {
        matches->path = calloc(found.gl_pathc, sizeof *matches->path);
        matches->was = calloc(found.gl_pathc, sizeof *matches->was);
        sound = matches->path && matches->was;
        for (size_t i = 0; sound && i < found.gl_pathc; i++)
            sound = (matches->path[matches->n++] = strdup(found.gl_pathv[i])) != NULL;
        if (sound) qsort(matches->path, matches->n, sizeof *matches->path, by_name);
        for (size_t i = 0; sound && i < matches->n; i++)
            if (stat(matches->path[i], &matches->was[i])) matches->was[i] = (struct stat){0};
    }
    globfree(&found);
    if (!sound) code_matches_free(matches);
    return sound;
}

void code_matches_free(struct code_matches *matches)
{
    for (size_t i = 0; matches->path && i < matches->n; i++) free(matches->path[i]);
    free(matches->path);
    free(matches->was);
    *matches = (struct code_matches){0};
}

/* A file is old if it is as it was before, or from well before the run: clocks of file systems
 * differ by little. */
static bool is_old(const struct code_matches *now, size_t i, const struct code_matches *before,
                   const struct stat *began)
{
    enum { SECONDS = 2 };
    const struct stat *is = &now->was[i];
    if (is->st_mtime < began->st_mtime - SECONDS) return true;
    for (size_t k = 0; k < before->n; k++) {
        const struct stat *was = &before->was[k];
        if (was->st_ino == is->st_ino && was->st_dev == is->st_dev && was->st_size == is->st_size &&
            was->st_mtim.tv_sec == is->st_mtim.tv_sec &&
            was->st_mtim.tv_nsec == is->st_mtim.tv_nsec)
            return true;
    }
    return false;
}

const char *code_last(const struct code_matches *now, const struct code_matches *before,
                      const char *began, enum code_reason *reason)
{
    struct stat start = {0};
    *reason = now->n ? REASON_old_snapshot : REASON_no_snapshot;
    if (stat(began, &start)) return NULL;
    for (size_t i = now->n; i-- > 0;)
        if (!is_old(now, i, before, &start)) {
            *reason = REASON_NONE;
            return now->path[i];
        }
    return NULL;
}

/* ---- what it holds ---- */

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The greatest difference of two columns, each in its own order, over `scale` or, where that is 0,
 * over the values. NaN: no memory. */
static double differ(const double *a, const double *b, size_t n, double scale)
{
    double *sorted = malloc(2 * n * sizeof *sorted), worst = sorted ? 0 : (double)NAN;
    for (size_t i = 0; sorted && i < n; i++) sorted[i] = a[i], sorted[n + i] = b[i];
    for (size_t k = 0; sorted && k < 2; k++) qsort(sorted + k * n, n, sizeof *sorted, ascending);
    for (size_t i = 0; sorted && i < n; i++)
        worst =
            fmax(worst, fabs(sorted[i] - sorted[n + i]) / (scale > 0 ? scale : fabs(sorted[i])));
    free(sorted);
    return worst;
}

/* How far particles get by t_end with the exact velocity that they then have, in box lengths; what
 * leads round a box leads nowhere. The mean along x. */
static double way_along_x(const struct snapshot_file *ic, const struct prepared *p, double t_end)
{
    const double length = p->domain.hi[0] - p->domain.lo[0];
    double sum = 0, least = INFINITY;
    for (size_t i = 0; i < ic->gas; i++) least = fmin(least, ic->column[SNAPSHOT_X][i]);
    for (size_t i = 0; i < ic->gas; i++) {
        struct problem_state state;
        double x[3] = {0};
        for (int d = 0; d < p->domain.dim; d++) x[d] = ic->column[SNAPSHOT_X + d][i];
        x[0] += p->domain.lo[0] - least; /* as the case counts it, to a spacing */
        problem_sample(p, x, t_end, &state);
        const double way = state.v[0] * t_end / length;
        sum += fabs(way - round(way));
    }
    return sum / (double)ic->gas;
}

static enum code_reason compare_start(const struct snapshot_file *file,
                                      const struct snapshot_file *ic, const struct prepared *p,
                                      double t_end, char *message, size_t size)
{
    enum { PER_CENT = 100 };
    const size_t n = file->gas;
    if (n != ic->gas) {
        snprintf(message, size, "%zu particles of gas; the initial state has %zu", n, ic->gas);
        return REASON_wrong_particles;
    }
    if (differ(ic->column[SNAPSHOT_M], file->column[SNAPSHOT_M], n, 0) > 1e-5) {
        snprintf(message, size,
                 "masses are not those of the initial state: the code has not read it");
        return REASON_ignored_ic;
    }
    const double length = p->domain.hi[0] - p->domain.lo[0];
    if (!p->problem->fieldless && way_along_x(ic, p, t_end) * PER_CENT > 1 &&
        differ(ic->column[SNAPSHOT_X], file->column[SNAPSHOT_X], n, length) < 1e-7) {
        snprintf(message, size, "all particles are where they were at the start");
        return REASON_ignored_ic;
    }
    return REASON_NONE;
}

enum code_reason code_compare(const struct snapshot_file *file, const struct snapshot_file *ic,
                              const struct prepared *problem, double t_end, char *message,
                              size_t size)
{
    if (file->time.known && !(fabs(file->time.value - t_end) <= 0.01 * t_end)) {
        snprintf(message, size, "its time is %.6g; allowed: %.6g to a hundredth", file->time.value,
                 t_end);
        return REASON_wrong_time;
    }
    return ic ? compare_start(file, ic, problem, t_end, message, size) : REASON_NONE;
}
