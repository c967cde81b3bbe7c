/* SPDX-License-Identifier: GPL-3.0-or-later
 * Point clouds in the unit box [0,1]^d for the checks of gradient operators, with volumes that are
 * exact for the density the points are drawn from, and smoothing lengths h = eta V^(1/d). */
#pragma once

#include "operator.h"

#define CLOUDS_LIST(KIND)                                                                          \
    KIND(LATTICE, "lattice", "cell-centred cubic lattice")                                         \
    KIND(JITTERED, "jittered", "lattice, each point moved by up to jitter * spacing an axis")      \
    KIND(SOBOL, "quasi_random", "Sobol sequence (GSL)")                                            \
    KIND(CLUSTERED, "clustered", "jittered lattice drawn together towards one corner")             \
    KIND(ONE_SIDED, "one_sided", "jittered lattice cut off by an oblique plane")

enum clouds_kind {
#define KIND(name, key, text) CLOUDS_##name,
    CLOUDS_LIST(KIND)
#undef KIND
        CLOUDS_KINDS
};

const char *clouds_name(enum clouds_kind kind);

struct clouds_settings {
    enum clouds_kind kind;
    int dim;
    size_t side;   /* points along an axis: about side^dim in all */
    double jitter; /* in spacings */
    double eta;    /* h = eta V^(1/dim) */
    unsigned long seed;
};

struct clouds_cloud {
    struct cloud cloud; /* arrays owned */
    double *x[3], *volume, *h;
    double spacing; /* mean: side^-1 */
};

/* STATUS_ENVIRONMENT: no memory. Free with clouds_free, also after a failure. */
enum status clouds_make(const struct clouds_settings *settings, struct clouds_cloud *out,
                        struct error *error);
void clouds_free(struct clouds_cloud *cloud);

/* Replaces volumes and h by those of the kernel sum, with the exact volumes as masses. */
enum status clouds_sum_volumes(const struct clouds_settings *settings, const struct kernel *kernel,
                               struct clouds_cloud *cloud, struct error *error);

/* Turns the cloud by the rotation matrix (row-major, dim x dim) and moves it by shift. */
void clouds_transform(struct clouds_cloud *cloud, const double *rotation, const double *shift);

/* True if the support of point i is inside the region that the points fill. */
bool clouds_interior(const struct clouds_settings *settings, const struct clouds_cloud *cloud,
                     size_t i);
