/* SPDX-License-Identifier: GPL-3.0-or-later
 * What is promised of a snapshot that is read: it is refused, or its columns are sound numbers,
 * from which kernel and meaning of h are then sought. */
#pragma once

#include "snapshot_file.h"

/* Reads path and looks whether the promise holds; the status of the reader. seek: kernel and
 * meaning of h are sought in what is read, too, which takes much longer. */
enum status fuzz_read(const char *path, const struct snapshot_options *options, bool seek);
