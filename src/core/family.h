/* SPDX-License-Identifier: GPL-3.0-or-later
 * Families: kernels, gradients, formulations, integrators ... Every member is a const descriptor
 * whose first field is a struct member; a family lists pointers to its members. `sphproof list`,
 * lookup by name, error messages and checks all use these lists. */
#ifndef SPHPROOF_FAMILY_H
#define SPHPROOF_FAMILY_H

#include <stddef.h>

struct member {
    const char *name;  /* key in cases, options and results */
    const char *label; /* one line, for display */
    const char *paper; /* source, or "" */
};

struct family {
    const char *name;  /* plural, as in `sphproof list NAME` */
    const char *title; /* one line */
    const struct member *const *members;
    size_t n;
};

/* The member called name, or NULL. Cast it to its descriptor. */
const struct member *family_find(const struct family *family, const char *name);

/* Index of the member called name, or -1. */
int family_index(const struct family *family, const char *name);

#endif
