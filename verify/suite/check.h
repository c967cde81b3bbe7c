/* SPDX-License-Identifier: GPL-3.0-or-later
 * A check: a property, measured on subjects (kernels, operators, solvers, norms ...), each figure
 * against a bound with the noise floor beside it; and the mutants, wrong subjects that the same
 * code must reject. Adding a check: one file and one line in checks.def, both in check/. */
#ifndef SPHPROOF_CHECK_H
#define SPHPROOF_CHECK_H

#include <stdbool.h>
#include <stddef.h>

struct kernel;
struct check_run; /* collects the figures of one check on one subject; see check.c */

/* One figure. subject: where (kernel, dimension, h, point ...), printf-like; passes if value <=
 * bound (a NaN fails). floor: the noise below which the figure means nothing (0: exact). */
void check_measure(struct check_run *run, double value, double bound, double floor,
                   const char *subject, ...) __attribute__((format(printf, 5, 6)));

/* The figure could not be measured here, and why; neither passes nor fails. */
void check_skip(struct check_run *run, const char *why, ...) __attribute__((format(printf, 2, 3)));

/* True once a mutant has been rejected: long loops over subjects may stop there. Never true for a
 * right subject. */
bool check_decided(const struct check_run *run);

/* Data behind the figures (n points), kept with a failure and plotted there: y over x. */
void check_series(struct check_run *run, const char *label, size_t n, const double *x,
                  const double *y);

/* The kernel of `verify --kernel-plugin`, or NULL: kernel checks add it to their subjects. */
extern const struct kernel *check_kernel_plugin;

struct check_mutant {
    const char *name;    /* distinct over the program */
    const char *fault;   /* one line: what is wrong with it */
    const void *subject; /* what the check gets instead of a right one */
};

struct check {
    const char *group; /* kernels gradients conservation riemann exact hydro norms ... */
    const char *name;
    const char *property; /* one line, a formula where it helps */
    bool slow;            /* not in the quick suite */
    /* The right subjects, index 0..subject_count-1. Without these two, measure is called once with
     * NULL as the right subject. */
    size_t (*subject_count)(void);
    const void *(*subject)(size_t i);
    void (*measure)(struct check_run *run, const void *subject);
    const struct check_mutant *mutants; /* ends with a NULL name; must not be empty */
};

#endif
