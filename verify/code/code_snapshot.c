/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "code_snapshot.h"

#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "list.h"

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

/* A file is old if it is unchanged since before the run, or clearly older than the run: clocks of
 * file systems differ slightly. */
bool code_is_new(const struct code_matches *now, size_t i, const struct code_matches *before,
                 time_t began)
{
    enum { SECONDS = 2 };
    const struct stat *is = &now->was[i];
    if (is->st_mtime < began - SECONDS) return false;
    for (size_t k = 0; k < before->n; k++) {
        const struct stat *was = &before->was[k];
        if (was->st_ino == is->st_ino && was->st_dev == is->st_dev && was->st_size == is->st_size &&
            was->st_mtim.tv_sec == is->st_mtim.tv_sec &&
            was->st_mtim.tv_nsec == is->st_mtim.tv_nsec)
            return false;
    }
    return true;
}

const char *code_last(const struct code_matches *now, const struct code_matches *before,
                      time_t began, enum code_reason *reason)
{
    *reason = now->n ? REASON_old_snapshot : REASON_no_snapshot;
    for (size_t i = now->n; i-- > 0;)
        if (code_is_new(now, i, before, began)) {
            *reason = REASON_NONE;
            return now->path[i];
        }
    return NULL;
}

const char *code_first(const struct code_matches *now, const struct code_matches *before,
                       time_t began, const char *last)
{
    for (size_t i = 0; i < now->n && strcmp(now->path[i], last) != 0; i++)
        if (code_is_new(now, i, before, began)) return now->path[i];
    return NULL;
}

/* ---- contents ---- */

/* Difference of two columns, each sorted, relative to `scale` or, if that is 0, to the values; the
 * greatest in the given share of the rows. NaN: no memory. */
static double differ(const double *a, const double *b, size_t n, double scale, double share)
{
    double *sorted = malloc(2 * n * sizeof *sorted), found = (double)NAN;
    for (size_t i = 0; sorted && i < n; i++) sorted[i] = a[i], sorted[n + i] = b[i];
    for (size_t k = 0; sorted && k < 2; k++) list_sort(sorted + k * n, n);
    for (size_t i = 0; sorted && i < n; i++)
        sorted[i] = fabs(sorted[i] - sorted[n + i]) / (scale > 0 ? scale : fabs(sorted[i]));
    if (sorted && n) {
        list_sort(sorted, n);
        found = sorted[(size_t)(share * (double)(n - 1))];
    }
    free(sorted);
    return found;
}

/* True if the masses differ: particles may exchange mass but not lose it, and most keep about
 * theirs. */
static bool masses_differ(const double *theirs, const double *ours, size_t n)
{
    long double sum = 0, difference = 0;
    for (size_t i = 0; i < n; i++) sum += theirs[i], difference += ours[i] - theirs[i];
    return fabsl(difference) > 1e-5L * sum || differ(theirs, ours, n, 0, 0.5) > 0.1;
}

/* Mean displacement along each direction by t_end, in box lengths, with the exact velocity at that
 * time, modulo whole rounds of the box. */
static void find_way(const struct snapshot_file *ic, const struct prepared *p, double t_end,
                     double way[3])
{
    const struct domain *box = &p->domain;
    double shift[3]; /* from the file's coordinates to the case's, within a spacing */
    for (int d = 0; d < box->dim; d++) {
        double least = (double)INFINITY;
        for (size_t i = 0; i < ic->gas; i++) least = fmin(least, ic->column[SNAPSHOT_X + d][i]);
        shift[d] = box->lo[d] - least, way[d] = 0;
    }
    for (size_t i = 0; i < ic->gas; i++) {
        struct problem_state state;
        double x[3] = {0};
        for (int d = 0; d < box->dim; d++) x[d] = ic->column[SNAPSHOT_X + d][i] + shift[d];
        problem_sample(p, x, t_end, &state);
        for (int d = 0; d < box->dim; d++) {
            const double moved = state.v[d] * t_end / (box->hi[d] - box->lo[d]);
            way[d] += fabs(moved - round(moved)) / (double)ic->gas;
        }
    }
}

static enum code_reason compare_start(const struct snapshot_file *file,
                                      const struct code_origin *origin, char *message, size_t size)
{
    enum { PER_CENT = 100 };
    const struct snapshot_file *ic = origin->ic;
    const struct prepared *p = origin->problem;
    const size_t n = file->gas;
    if (n != ic->gas) {
        snprintf(message, size, "%zu particles of gas; the initial state has %zu", n, ic->gas);
        return REASON_wrong_particles;
    }
    if (file->dim < p->domain.dim) {
        snprintf(message, size, "particles in %dD; the case is in %dD", file->dim, p->domain.dim);
        return REASON_wrong_particles;
    }
    if (origin->cells) return REASON_NONE;
    if (masses_differ(ic->column[SNAPSHOT_M], file->column[SNAPSHOT_M], n)) {
        snprintf(message, size,
                 "masses are not those of the initial state: the code has not read it");
        return REASON_ignored_ic;
    }
    double way[3];
    if (p->problem->fieldless) return REASON_NONE;
    find_way(ic, p, origin->t_end, way);
    for (int d = 0; d < p->domain.dim; d++) {
        const double length = p->domain.hi[d] - p->domain.lo[d];
        const double *before = ic->column[SNAPSHOT_X + d], *after = file->column[SNAPSHOT_X + d];
        if (!(way[d] * PER_CENT > 1 && differ(before, after, n, length, 1) < 1e-7)) continue;
        snprintf(message, size, "all particles are where they were at the start along %c", 'x' + d);
        return REASON_ignored_ic;
    }
    return REASON_NONE;
}

enum code_reason code_compare(const struct snapshot_file *file, const struct code_origin *origin,
                              char *message, size_t size)
{
    const double t_end = origin->t_end, gamma = origin->problem->gamma;
    if (file->time.known && !(fabs(file->time.value - t_end) <= 1e-3 * t_end)) {
        snprintf(message, size, "its time is %.6g; allowed: %.6g to a thousandth", file->time.value,
                 t_end);
        return REASON_wrong_time;
    }
    if (file->gamma.known && !(fabs(file->gamma.value - gamma) <= 1e-4)) {
        snprintf(message, size, "its gamma is %.6g; the case has %.6g", file->gamma.value, gamma);
        return REASON_wrong_gamma;
    }
    return origin->ic ? compare_start(file, origin, message, size) : REASON_NONE;
}

/* ---- the start ---- */

/* Differences are medians, because velocities in files of some codes are half a step ahead, which
 * is a large difference at a jump. */

/* Positions relative to a corner of the box, in [0, length) apart from round-off below its ends. */
static double *wrapped(const double *x, size_t n, double corner, double length)
{
    double *moved = malloc(n * sizeof *moved);
    for (size_t i = 0; moved && i < n; i++) {
        const double at = (x[i] - corner) / length + 1e-6;
        moved[i] = at - floor(at);
    }
    return moved;
}

/* The median difference of positions along d, in box lengths: each file may count them from 0 or
 * from the case's corner. */
static double apart(const struct snapshot_file *a, const struct snapshot_file *b,
                    const struct domain *box, int d)
{
    const double length = box->hi[d] - box->lo[d];
    double least = (double)INFINITY;
    double *x = wrapped(a->column[d], a->gas, 0, length);
    for (int k = -1; k <= 1; k++) {
        double *y = wrapped(b->column[d], b->gas, k * box->lo[d], length);
        if (x && y) least = fmin(least, differ(x, y, a->gas, 1, 0.5));
        free(y);
    }
    free(x);
    return least;
}

/* Difference of a column, relative to the greatest initial value. */
static double unlike(const struct snapshot_file *ic, const struct snapshot_file *file, int column,
                     double scale)
{
    const double *a = ic->column[column], *b = file->column[column];
    for (size_t i = 0; a && i < ic->gas; i++) scale = fmax(scale, fabs(a[i]));
    return a && b && scale > 0 ? differ(a, b, ic->gas, scale, 0.5) : 0;
}

bool code_is_start(const struct snapshot_file *file, const struct code_origin *origin,
                   char *message, size_t size)
{
    const struct snapshot_file *ic = origin->ic;
    const struct domain *box = &origin->problem->domain;
    double speed = 0;
    if (!ic || origin->cells || !file->time.known || fabs(file->time.value) > 1e-6 * origin->t_end)
        return true;
    if (file->gas != ic->gas) {
        snprintf(message, size, "%zu particles of gas, not the %zu", file->gas, ic->gas);
        return false;
    }
    if (file->dim < box->dim) {
        snprintf(message, size, "particles in %dD, not the %dD", file->dim, box->dim);
        return false;
    }
    const double spacing = pow((double)ic->gas, -1. / box->dim); /* in box lengths, about */
    for (int d = 0; d < box->dim; d++) {
        const double way = apart(ic, file, box, d);
        if (!(way <= 1e-3 * spacing + 1e-6)) {
            snprintf(message, size, "positions along %c are %.2g of the box from those", 'x' + d,
                     way);
            return false;
        }
    }
    for (size_t i = 0; ic->column[SNAPSHOT_U] && i < ic->gas; i++)
        speed = fmax(speed, sqrt(fabs(ic->column[SNAPSHOT_U][i])));
    for (int column = SNAPSHOT_VX; column <= SNAPSHOT_U; column++) {
        const bool velocity = column < SNAPSHOT_VX + box->dim;
        if (!velocity && column != SNAPSHOT_U) continue;
        const double off = unlike(ic, file, column, velocity ? speed : 0);
        if (!(off <= 1e-2)) {
            snprintf(message, size, "%s differs by %.2g of the greatest from that",
                     snapshot_column_names[column], off);
            return false;
        }
    }
    return true;
}
