/* SPDX-License-Identifier: GPL-3.0-or-later
 * Finds the kernel and the meaning of h in a file from the file itself: recomputes the density of
 * some particles with every kernel and every ratio of support radius to h. The right pair agrees to
 * the precision of the file; on disordered particles wrong pairs are off by 1e-4 or more. A pair
 * that is not ten times better than the best of every other kernel is no proof, since any kernel
 * fits a lattice. */
#pragma once

#include "kernel.h"
#include "snapshot_file.h"

enum { CONVENTIONS_SAMPLE = 60, CONVENTIONS_CANDIDATES = 24 };
#define CONVENTIONS_BETTER 10.  /* least ratio of another kernel's residual to the best */
#define CONVENTIONS_WORST  1e-3 /* a larger residual proves nothing */

enum density_sum {
    DENSITY_MASSES, /* rho_i = sum m_j W_ij(h_i) */
    DENSITY_NUMBER, /* rho_i = m_i sum W_ij(h_i), as in GIZMO's MFM */
    DENSITY_SUMS
};

/* The meaning of h according to the user; all 0 if not given. */
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
    char why[200];                                       /* reason for the result */
    struct convention candidate[CONVENTIONS_CANDIDATES]; /* best first */
    size_t count;
    bool same_masses;
    bool any_sum; /* the other sum with the best kernel fits about as well */
    size_t sample;
};

/* box: periods along the dimensions of the file, 0: none. only: the kernel named by the user, or
 * NULL; meaning: of h according to the user. STATUS_ENVIRONMENT: no memory. */
enum status conventions_find(const struct snapshot_file *file, const double box[3],
                             const struct kernel *only, const struct width_meaning *meaning,
                             struct conventions *found, struct error *error);
