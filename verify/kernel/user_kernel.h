/* SPDX-License-Identifier: GPL-3.0-or-later
 * Loads a user's kernel (plugin.h) as a struct kernel: checks that it can be used at all, derives
 * what is missing. Whether it is right is for the properties to tell. */
#ifndef SPHPROOF_USER_KERNEL_H
#define SPHPROOF_USER_KERNEL_H

#include <stdbool.h>

#include "kernel.h"
#include "plugin.h"

struct user_kernel {
    struct kernel kernel; /* valid until user_kernel_unload */
    void *library;
    char name[64];
    bool found_constant, found_dh, found_knots, found_class; /* derived, not supplied */
    double *knots;
};

/* Is word the path of a shared object (has a slash or ends in .so), not a kernel's name? */
bool user_kernel_is_path(const char *word);

/* dim 1, 2, 3: only that dimension of the kernel is valid; 0: all. STATUS_BAD_INPUT: missing file,
 * not a shared object, missing function, knots that are not ascending in ]0, 1[, a value that is
 * not finite, a crash or an endless loop in a function (tried in a process of its own first). */
enum status user_kernel_load(struct user_kernel *user, const char *path, int dim,
                             struct error *error);
void user_kernel_unload(struct user_kernel *user);

#endif
