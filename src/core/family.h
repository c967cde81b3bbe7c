/* SPDX-License-Identifier: GPL-3.0-or-later
 * Families: kernels, gradients, formulations, integrators ... Every member is a const descriptor
 * whose first field is a struct member; a family lists pointers to them. `sphproof list`, the
 * lookup by name, error messages and the checks all read these lists. */
#ifndef SPHPROOF_FAMILY_H
#define SPHPROOF_FAMILY_H

#include <stddef.h>

struct member {
    const char *name;  /* key in cases, options and results */
    const char *label; /* one line for a person */
    const char *paper; /* source; "" where there is none */
};

struct family {
    const char *name;  /* plural, as in `sphproof list NAME` */
    const char *title; /* one line */
    const struct member *const *members;
    size_t n;
};

/* The member called name, or NULL. Cast it back to its descriptor. */
const struct member *family_find(const struct family *family, const char *name);

/* Position of the member called name, or -1. */
int family_index(const struct family *family, const char *name);

#endif
