/* SPDX-License-Identifier: GPL-3.0-or-later
 * Detects results that are too good, or good for the wrong reason: faults of a study or of the
 * harness itself, reported as failures. Each function returns true for a suspicious result and then
 * writes a sentence to why (SUSPICION_TEXT bytes; may be NULL). */
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum { SUSPICION_TEXT = 200 };

/* An error of exactly 0 at one of n levels: the solution was compared with itself. Not for cases
 * that are known to be exact. */
bool suspicion_zero(size_t n, const double *error, char *why);

/* The same error at two of n resolutions, to a relative 1e-12: a level was not run. */
bool suspicion_repeated(size_t n, const double *error, char *why);

/* Two runs with a different setting gave the same errors, all n of them bit for bit. */
bool suspicion_idle_setting(const char *setting, size_t n, const double *before,
                            const double *after, char *why);

/* A field that is closer to another field's exact solution than to its own, at less than half the
 * distance in the volume-weighted L1 norm over the n particles of the window, and that follows it:
 * at less than half of its mean deviation, closer than any constant. value[f], exact[f]: n numbers
 * of field f; those with a volume of 0 do not count. Fields whose exact solutions are equal, or
 * closer to each other than the errors, cannot be distinguished and are not suspected: by the
 * triangle inequality they are not that close. */
bool suspicion_swapped(size_t fields, const char *const *names, size_t n, const double *volume,
                       const double *const *value, const double *const *exact, char *why);
