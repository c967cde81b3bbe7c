/* SPDX-License-Identifier: GPL-3.0-or-later
 * Text for a program of one's own; its comment lines say everything. */
#include "start_format.h"

extern const struct snapshot_writer writer_csv;

const struct start_format start_csv = {
    .member = {"csv", "text, a line a particle; h is the support radius", ""},
    .writer = &writer_csv,
};
