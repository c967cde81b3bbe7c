/* SPDX-License-Identifier: GPL-3.0-or-later
 * The one error that a run is judged by, where there is room for one: in 1D that of density; in 2D
 * and 3D that of the velocity along the circles of a circular flow, else that of the case's first
 * field; where no field is known, the distance of its first exact functional. Code units. */
#ifndef SPHPROOF_JUDGED_H
#define SPHPROOF_JUDGED_H

#include "run.h"

struct judged {
    const char *name; /* static: of the field, part or functional; "" where nothing is exact */
    double error;     /* L1 of a field; |value - exact| of a functional */
    double signal;    /* what it may be compared with: in 2D and 3D the mean distance of the exact
                         field from its mean over the particles of the window (of a velocity that
                         is uniform the sound speed), |exact| of a functional, 1 where that is 0 */
};

/* In 1D the signal is NaN: bench finds it by integration. */
void judged_of(const struct case_file *file, const struct run_result *result,
               struct judged *judged);

#endif
