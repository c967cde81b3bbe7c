/* SPDX-License-Identifier: GPL-3.0-or-later
 * A check: a property, measured on subjects (kernels, operators, solvers, norms ...), each figure
 * against a bound with the noise floor beside it; and the mutants, wrong subjects that the same
 * code must reject. Adding a check: one file in check/ and one line in its checks.def. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

struct user_figures;
struct check_run; /* collects the subjects and figures of one check; see check_run.h */

/* One figure. subject: where (kernel, dimension, h, point ...), printf-like; passes if value <=
 * bound (a NaN fails). floor: the noise below which the figure means nothing (0: exact). */
void check_measure(struct check_run *run, double value, double bound, double floor,
                   const char *subject, ...) __attribute__((format(printf, 5, 6)));

/* Notes why the figure could not be measured; it neither passes nor fails. */
void check_skip(struct check_run *run, const char *why, ...) __attribute__((format(printf, 2, 3)));

/* Adds a right subject. size: bytes to copy for the check; 0: the subject itself, which must
 * outlive the suite. */
void check_subject(struct check_run *run, const void *subject, size_t size);

/* True once a mutant has been rejected: long loops over subjects may stop there. Never true for a
 * right subject. */
bool check_decided(const struct check_run *run);

/* Data behind the figures (n points), kept with a failure and plotted there: y over x. */
void check_series(struct check_run *run, const char *label, size_t n, const double *x,
                  const double *y);

/* Figures of the kernel of `verify --kernel-plugin`, or NULL: kernel checks add them to their own.
 */
extern const struct user_figures *check_kernel_plugin;

struct check_mutant {
    const char *name;    /* distinct over the program */
    const char *fault;   /* one line: what is wrong with it */
    const void *subject; /* replaces a right subject */
};

struct check {
    const char *group; /* kernels gradients conservation riemann exact hydro norms ... */
    const char *name;
    /* Of several failed checks the one of least rank names the cause and is reported first: from
     * 100 for kernels, 200 gradients, 300 conservation, 400 riemann, 500 exact, 600 norms, 700
     * hydro, 800 clouds, 900 stability; in each group +0 to +49 for checks of one formula, +50 for
     * those that follow from several. Ranks from 1000 on are no checks (see findings.h). */
    int rank;
    const char *says;     /* message of a failure; NULL: "NAME off by VALUE" */
    const char *property; /* one line, with a formula if it helps */
    bool slow;            /* not in the quick suite */
    double cost; /* estimated seconds including mutants, by which shares are balanced; 0: few */
    /* Adds the right subjects, in order. NULL: measure is called once, with NULL as the right one.
     */
    void (*subjects)(struct check_run *run);
    /* Measures at least one figure on a subject, or gives the reason (check_skip). A check that
     * does neither, or that skips everything, fails. */
    void (*measure)(struct check_run *run, const void *subject);
    const struct check_mutant *mutants; /* ends with a NULL name; must not be empty */
};

/* CHECK_DEFINE(group, name, rank, .property = ..., ...): the check is called as its symbol,
 * check_GROUP_NAME. */
#define CHECK_DEFINE(group_, name_, rank_, ...)                                                    \
    const struct check check_##group_##_##name_ = {                                                \
        .group = #group_, .name = #name_, .rank = rank_, __VA_ARGS__}
