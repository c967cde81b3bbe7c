/* SPDX-License-Identifier: GPL-3.0-or-later
 * Formats in which the initial state of a run is written for other codes: a family, one file in
 * start/ and one line in starts.def each. The files are those of the writers of snapshots; here
 * stands what a code understands differently, and where its user sets what no file says. */
#pragma once

#include <stdbool.h>

#include "run.h"
#include "snapshot_writer.h"

struct start_format {
    struct member member;
    const struct snapshot_writer *writer;
    /* Where the user of the code must set these, in the code's own terms; NULL: the file contains
     * it. */
    const char *gamma, *dimension, *box, *boundary, *t_end;
    const char *precision; /* NULL: as ours, float64 */
    int dim;               /* the code's; 0: any */
    bool no_walls;         /* the code knows periodic and open boxes alone */
    /* What the code calls the smoothing length, divided by the support radius, which is what
     * snapshots have; 0: the same, or what width finds. */
    double h_over_support;
    enum status (*width)(const struct run_result *result, double *factor, struct error *error);
};
extern const struct family start_format_family;

/* NULL: STATUS_BAD_INPUT in error, which names the formats that there are. */
const struct start_format *start_format_of(const char *name, struct error *error);

/* STATUS_BAD_INPUT: the code cannot be given such a problem; the message says why. */
enum status start_possible(const struct start_format *format, const struct run *run,
                           struct error *error);

/* The result of run_start in a file. STATUS_ENVIRONMENT: it cannot be written. */
enum status start_write(const struct start_format *format, const struct run_result *result,
                        const char *path, struct error *error);

/* Binaries of GADGET (Springel 2005, user guide section 6): records between two counts of their
 * bytes, in this machine's order; numbers in single precision, positions from the lower corner of
 * the box. */

/* named: format 2, in which a record before each block names it; else format 1.
 * STATUS_BAD_INPUT: more particles than a record can count; STATUS_ENVIRONMENT: no memory, or it
 * cannot be written. */
enum status gadget_binary_write(const struct run_result *result, const char *path, bool named,
                                struct error *error);
