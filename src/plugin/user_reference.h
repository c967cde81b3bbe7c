/* SPDX-License-Identifier: GPL-3.0-or-later
 * A user's exact solution (sphproof/reference.h) from a shared object. The first calls belong into
 * a process of their own (guard.h). */
#pragma once

#include "sphproof/reference.h"
#include "status.h"

struct user_reference {
    void *library;
    int (*state)(const double *x, double t, const struct sphproof_reference_case *of,
                 struct sphproof_reference_state *state);
};

/* STATUS_BAD_INPUT: missing file, no shared object, no such function. It stays loaded until the
 * process ends. */
enum status user_reference_load(struct user_reference *user, const char *path, struct error *error);

/* The state at x and t; NaN where it is unknown, and all of it where the function says so. */
void user_reference_state(const struct user_reference *user, const double x[3], double t,
                          const struct sphproof_reference_case *of,
                          struct sphproof_reference_state *state);
