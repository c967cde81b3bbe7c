/* SPDX-License-Identifier: GPL-3.0-or-later
 * All properties of a user's kernel in 1, 2 and 3 dimensions, measured in a process of its own: the
 * checks take the figures from here and never call foreign code. */
#pragma once

#include "findings.h"
#include "status.h"

struct user_figures {
    char name[64];
    struct findings figures; /* what: a property's name; subject: kernel, dimension and where */
};

/* A kernel that crashes, never returns and so on has one failed figure of property `runs`.
 * STATUS_BAD_INPUT: it cannot be loaded. Release with user_figures_free. */
enum status user_figures_measure(struct user_figures *figures, const char *path,
                                 struct error *error);
void user_figures_free(struct user_figures *figures);
