/* SPDX-License-Identifier: GPL-3.0-or-later
 * A user's kernels in runs: wherever a kernel is named, the path of a shared object (plugin.h) may
 * stand. It becomes a plug-in of kernel_family for this process, called PATH@HASH after the content
 * of its file, so that documents and caches tell one from another; PATH@HASH may be typed as well
 * and then wants that content. Its certificate is made first, in a process of its own (guard.h);
 * then it is called in this one, which is watched from the first plug-in on (guard_watch). */
#pragma once

#include <jansson.h>
#include <stdbool.h>

#include "pieces.h"

/* Measures the certificate of a kernel in dim dimensions on these terms; failing: the names of the
 * checks that fail, a new array. STATUS_ENVIRONMENT: no memory. */
typedef enum status plugin_certify(const struct kernel *kernel, int dim, const struct terms *terms,
                                   json_t **failing, struct error *error);

/* Plug-ins may be used from here on, if their certificate passes; without this (tests, fuzzing) no
 * path is looked at. uncertified: also those whose certificate fails. */
void plugin_allow(plugin_certify *certify, bool uncertified);

/* Has plugin_allow been called? Nothing else of a user's is loaded before that either. */
bool plugin_allowed(void);

/* Is word a path (PATH or PATH@HASH), not the name of a kernel? */
bool plugin_is_path(const char *word);

/* The place of the kernel at that path in kernel_family.members. STATUS_BAD_INPUT: no such file,
 * other content than HASH says, too many plug-ins. */
enum status plugin_find(const char *word, int *index, struct error *error);

/* Makes the plug-in at that place ready for use in dim dimensions; built-in kernels are.
 * STATUS_CHECK_FAILED: it is refused, with the checks of its certificate that fail;
 * STATUS_BAD_INPUT: it is no kernel. */
enum status plugin_prepare(int index, int dim, struct error *error);

/* plugin_prepare, then kernel_select, of the kernel at that place. */
enum status plugin_select(struct kernel *kernel, int index, int sinc_order, int dim,
                          struct error *error);
