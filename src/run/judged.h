/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a case is judged by, and the one error of a run where there is room for one. Code units. */
#pragma once

#include "run.h"

enum { JUDGED_MAX = FIELDS + 2 + PROBLEM_FUNCTIONALS_MAX };

/* What errors of a case are worth most, the first first: of a flow round a middle the azimuthal and
 * the radial velocity; those of the case's fields that have a gate, then its others; where no field
 * is known, functionals whose exact values are finite. The names are static; returns how many. */
size_t judged_names(const struct case_file *file, size_t functional_count,
                    const char *const *functionals, const double *exact,
                    const char *names[JUDGED_MAX]);

/* The same of a run. */
size_t judged_names_of(const struct case_file *file, const struct run_result *result,
                       const char *names[JUDGED_MAX]);

struct judged {
    const char *name; /* static: of the field, part or functional; "" where nothing is exact */
    double error;     /* L1 of a field; |value - exact| of a functional */
    double signal;    /* what it may be compared with: in 2D and 3D the mean distance of the exact
                         field from its mean over the particles of the window (of a velocity that
                         is uniform the sound speed), |exact| of a functional, 1 where that is 0 */
};

/* The first of judged_names; in 1D density, and the signal is NaN: bench finds it by integration.
 */
void judged_of(const struct case_file *file, const struct run_result *result,
               struct judged *judged);
