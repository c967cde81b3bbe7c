/* SPDX-License-Identifier: GPL-3.0-or-later
 * Loads a user's kernel (plugin.h) as a struct kernel: checks that it can be used at all, derives
 * what is missing. Whether it is right is for the properties to tell. All of this runs foreign
 * code: it belongs into a process of its own (guard.h). One plug-in at a time. */
#pragma once

#include <stdbool.h>

#include "pieces.h"
#include "sphproof/plugin.h"

struct user_kernel {
    struct kernel kernel; /* valid until user_kernel_unload */
    struct terms terms;   /* class_found and negative: see user_kernel_terms */
    void *library;
    char name[64];
    bool found_constant, found_dh, found_knots, found_class; /* derived, not supplied */
    bool negative[KERNEL_DIM_MAX + 1];                       /* declared to have a negative lobe */
    double *knots, *constants;
};

/* Is word the path of a shared object (has a slash or ends in .so), not a kernel's name? */
bool user_kernel_is_path(const char *word);

/* The name for results where the plug-in itself cannot be asked: that of the file. */
void user_kernel_file_name(const char *path, char *name, size_t size);

/* dim 1, 2, 3: only that dimension of the kernel is valid; 0: all. terms: precision, samples and
 * seed of the judgement (NULL: pieces_terms_usual). STATUS_BAD_INPUT: missing file, not a shared
 * object, missing function, knots that are not ascending in ]0, 1[, a value that is not finite. */
enum status user_kernel_load(struct user_kernel *user, const char *path, int dim,
                             const struct terms *terms, struct error *error);
void user_kernel_unload(struct user_kernel *user);

/* The terms on which the kernel is judged in dim dimensions. */
struct terms user_kernel_terms(const struct user_kernel *user, int dim);
