/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file
 * An exact solution of your own, for a case file of yours. Write one C file with the function
 * below, then
 *
 *     cc -O2 -shared -fPIC -I DIR_OF_THIS_HEADER F.c -o mine.so -lm
 *
 * and in the case file, in [case]
 *
 *     reference = ./mine.so speed=0.5 k=2
 *
 * where words after the path are parameters, numbers with names of your choice. Every command then
 * measures errors against this function. The initial state stays that of the case's kind; with
 * kind = particles and no file, particles are laid with the state of the function at t = 0.
 *
 * The function must be pure: same arguments, same state, however often it is called. It is first
 * tried in a process of its own: one that crashes, ends the process or does not return within a
 * second is refused. A crash later on, or a call that lasts 5 seconds, ends the command with a
 * message. With --threads several threads may call it at once. */
#ifndef SPHPROOF_REFERENCE_H
#define SPHPROOF_REFERENCE_H

#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The case, in code units; arrays have dim entries. */
struct sphproof_reference_case {
    int dim;                           /**< 1, 2 or 3 */
    double gamma;                      /**< ratio of specific heats */
    const double *lo, *hi;             /**< ends of the box */
    const double *gravity;             /**< constant acceleration */
    int parameter_count;               /**< words after the path */
    const char *const *parameter_name; /**< parameter_count names */
    const double *parameter_value;     /**< parameter_count numbers */
};

/** State of the gas at one position and time, in code units. All members are NaN at the call; a
 * member left as NaN is unknown, and a field that is unknown everywhere is not compared. If rho and
 * P are known and u is not, u is P/((gamma - 1) rho). */
struct sphproof_reference_state {
    double rho, v[3], P, u;
};

/** Required: the state at x (dim coordinates in the box) and t >= 0. Returns 0, or another value if
 * the state is unknown, which is an error inside the window where errors are measured. */
int sphproof_reference(const double *x, double t, const struct sphproof_reference_case *of,
                       struct sphproof_reference_state *state);

/** The value of a parameter, or fallback if the case file does not give it. */
static inline double sphproof_reference_parameter(const struct sphproof_reference_case *of,
                                                  const char *name, double fallback)
{
    for (int i = 0; i < of->parameter_count; i++)
        if (strcmp(of->parameter_name[i], name) == 0) return of->parameter_value[i];
    return fallback;
}

#ifdef __cplusplus
}
#endif

#endif
