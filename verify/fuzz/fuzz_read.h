/* SPDX-License-Identifier: GPL-3.0-or-later
 * What is promised of a snapshot that is read: it is refused, or its columns are sound numbers,
 * from which kernel and meaning of h are then sought. */
#pragma once

#include "snapshot_file.h"

/* Reads path, verifies the promises about the result, and returns the reader's status. seek: also
 * searches for the kernel and the meaning of h, which takes much longer. */
enum status fuzz_read(const char *path, const struct snapshot_options *options, bool seek);
