/* SPDX-License-Identifier: GPL-3.0-or-later
 * Text for a user's own program; comment lines contain the metadata. */
#include "start_format.h"

extern const struct snapshot_writer writer_csv;

const struct start_format start_csv = {
    .member = {"csv", "text, a line a particle; h is the support radius", ""},
    .writer = &writer_csv,
};
