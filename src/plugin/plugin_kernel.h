/* SPDX-License-Identifier: GPL-3.0-or-later
 * A user's kernels in runs: the path of a shared object (plugin.h) may be given wherever a kernel
 * is named. It becomes a member of kernel_family in this process with the name PATH@HASH, from the
 * hash of the file's content, so that documents and caches distinguish contents. A user may also
 * give PATH@HASH, which requires that content. The kernel's certificate is made first, in a child
 * process (guard.h); then the kernel is called in this process, which is watched from the first
 * plug-in on (guard_watch). */
#pragma once

#include <jansson.h>
#include <stdbool.h>

#include "pieces.h"

/* Measures the certificate of a kernel in dim dimensions on these terms; failing: a new array with
 * the names of the failed checks. STATUS_ENVIRONMENT: no memory. */
typedef enum status plugin_certify(const struct kernel *kernel, int dim, const struct terms *terms,
                                   json_t **failing, struct error *error);

/* Allows plug-ins whose certificate passes, or with uncertified also others. Without this call
 * (tests, fuzzing) paths are not accepted. */
void plugin_allow(plugin_certify *certify, bool uncertified);

/* True if plug-ins are allowed. Other code of a user is not loaded before that either. */
bool plugin_allowed(void);

/* True if word is a path (PATH or PATH@HASH), not the name of a kernel. */
bool plugin_is_path(const char *word);

/* The index in kernel_family.members of the kernel at a path. STATUS_BAD_INPUT: no such file,
 * content other than HASH, or too many plug-ins. */
enum status plugin_find(const char *word, int *index, struct error *error);

/* Prepares the kernel if it is a plug-in, then calls kernel_select. STATUS_CHECK_FAILED: the
 * plug-in is refused, with the failed checks of its certificate; STATUS_BAD_INPUT: not a kernel. */
enum status plugin_select(struct kernel *kernel, int index, int sinc_order, int dim,
                          struct error *error);
