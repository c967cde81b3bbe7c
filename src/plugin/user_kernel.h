/* SPDX-License-Identifier: GPL-3.0-or-later
 * Loads a user's kernel (plugin.h) as a struct kernel: checks that it is usable and determines what
 * it does not declare. Does not check that it is right. All of this runs foreign code and belongs
 * in a child process (guard.h). One plug-in at a time. */
#pragma once

#include <stdbool.h>

#include "pieces.h"
#include "sphproof/plugin.h"

struct user_kernel {
    struct kernel kernel; /* valid until user_kernel_unload */
    struct terms terms;   /* set by the user; see user_kernel_terms for class_found and negative */
    void *library;
    char name[64];
    bool found_constant, found_dh, found_knots, found_class; /* determined, not declared */
    bool negative[KERNEL_DIM_MAX + 1];                       /* declared to have a negative lobe */
    double *knots, *constants;
};

/* True if word is the path of a shared object (has a slash or ends in .so), not the name of a
 * kernel. */
bool user_kernel_is_path(const char *word);

/* The name of the kernel if the plug-in cannot be asked: that of the file. */
void user_kernel_file_name(const char *path, char *name, size_t size);

/* dim 1, 2, 3: only that dimension of the kernel is valid; 0: all. terms: precision, samples and
 * seed (NULL: pieces_terms_usual). STATUS_BAD_INPUT: missing file, not a shared object, missing
 * function, knots that do not increase in ]0, 1[, or a value that is not finite. */
enum status user_kernel_load(struct user_kernel *user, const char *path, int dim,
                             const struct terms *terms, struct error *error);
void user_kernel_unload(struct user_kernel *user);

/* The terms for judging the kernel in dim dimensions. */
struct terms user_kernel_terms(const struct user_kernel *user, int dim);
