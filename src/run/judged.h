/* SPDX-License-Identifier: GPL-3.0-or-later
 * The errors by which a case is judged, and the one error that represents a run. Code units. */
#pragma once

#include "run.h"

enum { JUDGED_MAX = FIELDS + 2 + PROBLEM_FUNCTIONALS_MAX };

/* Names of the errors of a case, most important first: azimuthal and radial velocity of a circular
 * flow; the case's fields with a gate; its other fields; without known fields, the functionals with
 * finite exact values. The names are static; returns their number. */
size_t judged_names(const struct case_file *file, size_t functional_count,
                    const char *const *functionals, const double *exact,
                    const char *names[JUDGED_MAX]);

/* The same for a run. */
size_t judged_names_of(const struct case_file *file, const struct run_result *result,
                       const char *names[JUDGED_MAX]);

struct judged {
    const char *name; /* of the field, part or functional, static; "" if nothing is exact */
    double error;     /* L1 of a field; |value - exact| of a functional */
    double signal; /* scale of the error: in 2D and 3D the mean distance of the exact field from its
                      mean over the window's particles (sound speed for a uniform velocity); for a
                      functional |exact|, or 1 if that is 0 */
};

/* The first of judged_names; in 1D the density, with a NaN signal, which bench computes by
 * integration. */
void judged_of(const struct case_file *file, const struct run_result *result,
               struct judged *judged);
