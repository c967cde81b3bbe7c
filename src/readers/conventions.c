/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "conventions.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "list.h"
#include "measure.h"

#define RATIO_LEAST 0.8
#define RATIO_MOST  4.6
/* Of a search for a ratio; residuals below it, as on a lattice, are equal. */
#define PRECISION 1e-9
enum { RATIO_STEPS = 60, GOLDEN_STEPS = 44, NEIGHBOURS_MAX = 4096 };

/* A particle of the sample and its neighbours, each with distance over h and mass. */
struct near {
    double rho, m, h;
    size_t i;
    size_t count;
    struct neighbour {
        double s, m;
    } * neighbour; /* nearest first */
};

struct sample {
    int dim;
    size_t n;
    double reach; /* over h: all neighbours up to here are known */
    struct near near[CONVENTIONS_SAMPLE];
};

static double distance(const struct snapshot_file *file, const double box[3], size_t i, size_t j)
{
    double squares = 0;
    for (int d = 0; d < file->dim; d++) {
        double dx = file->column[d][i] - file->column[d][j];
        if (box[d] > 0) dx -= box[d] * round(dx / box[d]);
        squares += dx * dx;
    }
    return sqrt(squares);
}

static int nearer(const void *a, const void *b)
{
    const double x = ((const struct neighbour *)a)->s, y = ((const struct neighbour *)b)->s;
    return (x > y) - (x < y);
}

/* Ends the reach at the first neighbour that no longer counts, since no code sums over more than
 * NEIGHBOURS_MAX. */
static void limit_reach(struct sample *sample, struct near *near)
{
    qsort(near->neighbour, near->count, sizeof *near->neighbour, nearer);
    if (near->count <= NEIGHBOURS_MAX) return;
    sample->reach = fmin(sample->reach, near->neighbour[NEIGHBOURS_MAX].s);
}

/* True if the particle is more than margin h from non-periodic ends. */
static bool inside(const struct snapshot_file *file, const double box[3], const double lo[3],
                   const double hi[3], size_t i, double margin)
{
    for (int d = 0; d < file->dim; d++) {
        const double x = file->column[d][i], gap = margin * file->column[SNAPSHOT_H][i];
        if (box[d] == 0 && !(fmin(x - lo[d], hi[d] - x) > gap)) return false;
    }
    return true;
}

/* Picks particles well inside, by a golden-ratio sequence that avoids the period of a lattice. */
static void choose(const struct snapshot_file *file, const double box[3], struct sample *sample)
{
    static const double margins[] = {3, 1, -INFINITY};
    double lo[3], hi[3];
    for (int d = 0; d < file->dim; d++) {
        lo[d] = INFINITY, hi[d] = -INFINITY;
        for (size_t i = 0; i < file->n; i++) {
            lo[d] = fmin(lo[d], file->column[d][i]);
            hi[d] = fmax(hi[d], file->column[d][i]);
        }
    }
    for (size_t m = 0; m < sizeof margins / sizeof *margins && !sample->n; m++)
        for (size_t k = 0; k < 8 * CONVENTIONS_SAMPLE && sample->n < CONVENTIONS_SAMPLE; k++) {
            const size_t i =
                (size_t)((double)file->gas * fmod(0.5 + (double)k * 0.6180339887498949, 1));
            if (!inside(file, box, lo, hi, i, margins[m])) continue;
            sample->near[sample->n++] = (struct near){.rho = file->column[SNAPSHOT_RHO][i],
                                                      .m = file->column[SNAPSHOT_M][i],
                                                      .h = file->column[SNAPSHOT_H][i],
                                                      .i = i};
        }
}

static enum status gather(const struct snapshot_file *file, const double box[3], double reach,
                          struct sample *sample, struct error *error)
{
    sample->dim = file->dim;
    sample->reach = reach;
    choose(file, box, sample);
    for (size_t k = 0; k < sample->n; k++) {
        struct near *near = &sample->near[k];
        for (size_t j = 0; j < file->n; j++) {
            const double s = distance(file, box, near->i, j) / near->h;
            if (!(s <= reach)) continue;
            if (!list_grow(&near->neighbour, near->count, sizeof *near->neighbour))
                return error_set(error, STATUS_ENVIRONMENT, "no memory for neighbours");
            near->neighbour[near->count].s = s;
            near->neighbour[near->count++].m = file->column[SNAPSHOT_M][j];
        }
        limit_reach(sample, near);
    }
    return STATUS_OK;
}

/* rms of sum/rho - 1 over the sample. INFINITY as soon as the particles so far show that it exceeds
 * `most`. */
static double residual(const struct sample *sample, const struct kernel *kernel,
                       enum density_sum sum, double ratio, double most)
{
    double squares = 0;
    for (size_t k = 0; k < sample->n; k++) {
        if (squares > most * most * (double)sample->n) return INFINITY;
        const struct near *near = &sample->near[k];
        double rho = 0;
        for (size_t j = 0; j < near->count && near->neighbour[j].s < ratio; j++)
            rho += (sum == DENSITY_MASSES ? near->neighbour[j].m : near->m) *
                   kernel->w(kernel, near->neighbour[j].s / ratio, sample->dim);
        rho *= kernel->constant[sample->dim] * pow(near->h * ratio, -sample->dim);
        squares += (rho / near->rho - 1) * (rho / near->rho - 1);
    }
    return sqrt(squares / (double)sample->n);
}

/* Finds the ratio with the smallest residual: by a scan, then by golden section. */
static struct convention fit(const struct sample *sample, const struct kernel *kernel,
                             enum density_sum sum, double given)
{
    const double step = pow(RATIO_MOST / RATIO_LEAST, 1. / RATIO_STEPS),
                 golden = 0.6180339887498949;
    struct convention best = {.kernel = *kernel, .sum = sum, .residual = INFINITY};
    if (given > 0) {
        best.ratio = given;
        if (given <= sample->reach) best.residual = residual(sample, kernel, sum, given, INFINITY);
        return best;
    }
    for (int k = 0;; k++) {
        const double ratio = RATIO_LEAST * pow(step, k);
        if (ratio > sample->reach) break;
        const double value = residual(sample, kernel, sum, ratio, best.residual);
        if (value < best.residual) best.ratio = ratio, best.residual = value;
    }
    if (!(best.ratio > 0)) return best;
    double lo = best.ratio / step, hi = fmin(best.ratio * step, sample->reach);
    double a = hi - golden * (hi - lo), b = lo + golden * (hi - lo);
    double at_a = residual(sample, kernel, sum, a, INFINITY),
           at_b = residual(sample, kernel, sum, b, INFINITY);
    for (int k = 0; k < GOLDEN_STEPS && fabs(at_a - at_b) > PRECISION * at_a; k++) {
        if (at_a < at_b) {
            hi = b, b = a, at_b = at_a, a = hi - golden * (hi - lo);
            at_a = residual(sample, kernel, sum, a, INFINITY);
        } else {
            lo = a, a = b, at_a = at_b, b = lo + golden * (hi - lo);
            at_b = residual(sample, kernel, sum, b, INFINITY);
        }
    }
    best.ratio = at_a < at_b ? a : b;
    best.residual = fmin(at_a, at_b);
    return best;
}

static void insert(struct conventions *found, const struct convention *candidate)
{
    size_t at = found->count;
    if (found->count == CONVENTIONS_CANDIDATES || !isfinite(candidate->residual)) return;
    for (; at > 0 && found->candidate[at - 1].residual > fmax(candidate->residual, PRECISION); at--)
        found->candidate[at] = found->candidate[at - 1];
    found->candidate[at] = *candidate;
    found->count++;
}

/* True if the kernels are equal, whatever their names: a plug-in may repeat a built-in kernel. */
static bool same_kernel(const struct kernel *a, const struct kernel *b, int dim)
{
    enum { POINTS = 64 };
    const double top = a->constant[dim] * a->w(a, 0, dim);
    bool same = true;
    for (int k = 0; k < POINTS && same; k++) {
        const double q = (k + 0.5) / POINTS;
        same = fabs(a->constant[dim] * a->w(a, q, dim) - b->constant[dim] * b->w(b, q, dim)) <=
               1e-9 * fabs(top);
    }
    return same;
}

/* The best fit of another kernel or, with other_sum, of the same kernel by another sum; NULL:
 * none. */
static const struct convention *second(const struct conventions *found, int dim, bool other_sum)
{
    const struct convention *best = &found->candidate[0];
    for (size_t k = 1; k < found->count; k++) {
        const struct convention *c = &found->candidate[k];
        const bool same = same_kernel(&best->kernel, &c->kernel, dim);
        if (same == other_sum && (!same || c->sum != best->sum)) return c;
    }
    return NULL;
}

/* True if this candidate misses the density so much more that the best is the right one. */
static bool is_worse(const struct convention *other, double best)
{
    return other->residual >= CONVENTIONS_BETTER * fmax(best, PRECISION);
}

static void decide(struct conventions *found, int dim, bool forced)
{
    const struct convention *best = &found->candidate[0];
    const struct convention *other = found->count ? second(found, dim, false) : NULL;
    const struct convention *sum = found->count ? second(found, dim, true) : NULL;
    found->any_sum = sum && !is_worse(sum, best->residual);
    if (found->count == 0) {
        snprintf(found->why, sizeof found->why, "no sum is finite");
        return;
    }
    if (forced) {
        found->known = true;
        snprintf(found->why, sizeof found->why, "as given; density is summed again to %.2g",
                 best->residual);
        return;
    }
    if (!(best->residual <= CONVENTIONS_WORST))
        snprintf(found->why, sizeof found->why,
                 "no kernel's sum agrees with the density: the best, %s, misses by %.2g",
                 best->kernel.member.name, best->residual);
    else if (other && !is_worse(other, best->residual))
        snprintf(found->why, sizeof found->why,
                 "%s misses the density by %.2g, %s by %.2g: not %g times more",
                 best->kernel.member.name, best->residual, other->kernel.member.name,
                 other->residual, CONVENTIONS_BETTER);
    else {
        found->known = true;
        int used = snprintf(found->why, sizeof found->why,
                            "the density of %zu particles summed again misses by %.2g",
                            found->sample, best->residual);
        if (other)
            snprintf(found->why + used, sizeof found->why - (size_t)used,
                     "; the next kernel, %s, by %.2g", other->kernel.member.name, other->residual);
    }
}

static bool masses_equal(const struct snapshot_file *file)
{
    const double *m = file->column[SNAPSHOT_M];
    for (size_t i = 1; i < file->n; i++)
        if (!(fabs(m[i] - m[0]) <= 1e-6 * m[0])) return false;
    return true;
}

enum status conventions_find(const struct snapshot_file *file, const double box[3],
                             const struct kernel *only, const struct width_meaning *meaning,
                             struct conventions *found, struct error *error)
{
    const size_t kernels = only ? 1 : kernel_family.n;
    struct sample *sample = calloc(1, sizeof *sample);
    *found = (struct conventions){.tried = file->column[SNAPSHOT_H] != NULL};
    if (!sample) return error_set(error, STATUS_ENVIRONMENT, "no memory for neighbours");
    found->same_masses = masses_equal(file);
    enum status status = STATUS_OK;
    if (!found->tried)
        snprintf(found->why, sizeof found->why, "the file has no smoothing lengths");
    else
        status = gather(file, box, fmax(meaning->ratio, RATIO_MOST), sample, error);
    found->sample = sample->n;
    for (size_t k = 0; k < kernels && found->tried && !status; k++) {
        struct kernel kernel;
        if (only)
            kernel = *only;
        else if ((status = kernel_select(&kernel, kernel_family.members[k]->name, 5, error)))
            break;
        const double ratio = meaning->deviations > 0
                                 ? 1 / (meaning->deviations * measure_deviation(&kernel, file->dim))
                                 : meaning->ratio;
        for (int sum = 0; sum < (found->same_masses ? 1 : DENSITY_SUMS); sum++) {
            const struct convention candidate = fit(sample, &kernel, (enum density_sum)sum, ratio);
            insert(found, &candidate);
        }
    }
    if (found->tried && !status)
        decide(found, file->dim, only && (meaning->ratio > 0 || meaning->deviations > 0));
    for (size_t k = 0; k < sample->n; k++) free(sample->near[k].neighbour);
    free(sample);
    return status;
}
