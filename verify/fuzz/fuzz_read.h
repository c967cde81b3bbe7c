/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reads a fuzzed snapshot: it must be refused or have columns of valid numbers, for which the
 * kernel and the meaning of h are then searched. */
#pragma once

#include "snapshot_file.h"

/* Reads path, verifies the promises about the result, and returns the reader's status. seek: also
 * searches for the kernel and the meaning of h, which takes much longer. */
enum status fuzz_read(const char *path, const struct snapshot_options *options, bool seek);
