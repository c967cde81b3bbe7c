/* SPDX-License-Identifier: GPL-3.0-or-later
 * Kernel and meaning of h, proved by the file itself: the density of some particles is summed again
 * with every kernel and every ratio of support radius to h. The right pair agrees to the file's
 * precision; on disordered particles wrong ones miss by 1e-4 and more. A pair that is not ten times
 * better than every other kernel's is no proof: on a lattice any kernel fits. */
#pragma once

#include "kernel.h"
#include "snapshot_file.h"

enum { CONVENTIONS_SAMPLE = 60, CONVENTIONS_CANDIDATES = 24 };
#define CONVENTIONS_BETTER 10.  /* times, than the best of the other kernels */
#define CONVENTIONS_WORST  1e-3 /* a residual above this proves nothing */

enum density_sum {
    DENSITY_MASSES, /* rho_i = sum m_j W_ij(h_i) */
    DENSITY_NUMBER, /* rho_i = m_i sum W_ij(h_i), as GIZMO's MFM has it */
    DENSITY_SUMS
};

/* What the user says about a file's h; all 0 if nothing is said. */
struct width_meaning {
    double ratio;      /* support radius over h */
    double deviations; /* h over the kernel's standard deviation */
};

struct convention {
    struct kernel kernel;
    enum density_sum sum;
    double ratio;    /* support radius over h */
    double residual; /* rms of sum/rho - 1 over the sample */
};

struct conventions {
    bool tried; /* false: the file has no h */
    bool known;
    char why[200];                                       /* why, or why not */
    struct convention candidate[CONVENTIONS_CANDIDATES]; /* best first */
    size_t count;
    bool same_masses;
    bool any_sum; /* the best kernel's other sum fits about as well */
    size_t sample;
};

/* box: periods along the dimensions that the file has, 0: none. only: the kernel that the user
 * names, or NULL; meaning: of h as the user says it. STATUS_ENVIRONMENT: no memory. */
enum status conventions_find(const struct snapshot_file *file, const double box[3],
                             const struct kernel *only, const struct width_meaning *meaning,
                             struct conventions *found, struct error *error);

/* Standard deviation of a kernel over its support radius, along one direction. */
double conventions_deviation(const struct kernel *kernel, int dim);
