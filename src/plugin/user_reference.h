/* SPDX-License-Identifier: GPL-3.0-or-later
 * A user's exact solution (sphproof/reference.h) from a shared object. The first calls belong in a
 * child process (guard.h). */
#pragma once

#include "sphproof/reference.h"
#include "status.h"

struct user_reference {
    void *library;
    int (*state)(const double *x, double t, const struct sphproof_reference_case *of,
                 struct sphproof_reference_state *state);
};

/* STATUS_BAD_INPUT: missing file, not a shared object, or no such function. The object stays loaded
 * until the process ends. */
enum status user_reference_load(struct user_reference *user, const char *path, struct error *error);

/* The state at x and t; NaN where unknown, and all NaN if the function reports that. */
void user_reference_state(const struct user_reference *user, const double x[3], double t,
                          const struct sphproof_reference_case *of,
                          struct sphproof_reference_state *state);
