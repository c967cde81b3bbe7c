/* SPDX-License-Identifier: GPL-3.0-or-later
 * Formats in which the initial state of a run is written for other codes: a family, one file in
 * start/ and one line in starts.def each. The snapshot writers write the files; the descriptors
 * here give the conventions that differ and say where the user of the code sets values that the
 * file cannot hold. */
#pragma once

#include <stdbool.h>

#include "run.h"
#include "snapshot_writer.h"

struct start_format {
    struct member member;
    const struct snapshot_writer *writer;
    /* Where the user of the code sets these values, in the code's own terms; NULL: the file
     * contains the value. */
    const char *gamma, *dimension, *box, *boundary, *t_end;
    const char *precision; /* NULL: float64, which needs no setting */
    int dim;               /* of the code; 0: any */
    bool no_walls;         /* the code supports only periodic and open boxes */
    /* The code's smoothing length divided by the support radius, which snapshots contain; 0: the
     * same, or the factor from `width`. */
    double h_over_support;
    enum status (*width)(const struct run_result *result, double *factor, struct error *error);
};
extern const struct family start_format_family;

/* NULL: unknown name, STATUS_BAD_INPUT in error, which lists the formats. */
const struct start_format *start_format_of(const char *name, struct error *error);

/* STATUS_BAD_INPUT: the code cannot run the problem; the message says why. */
enum status start_possible(const struct start_format *format, const struct run *run,
                           struct error *error);

/* Writes a result of run_start to a file. STATUS_ENVIRONMENT: it cannot be written. */
enum status start_write(const struct start_format *format, const struct run_result *result,
                        const char *path, struct error *error);
