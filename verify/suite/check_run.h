/* SPDX-License-Identifier: GPL-3.0-or-later
 * Internal to the suite: the data that one run of a check collects. */
#pragma once

#include "suite.h"

/* A right subject; copy: set if the run owns it. */
struct subject {
    const void *given;
    void *copy;
};

struct check_run {
    const struct check *check;
    struct subject *subjects;
    struct figure *figures;
    struct series *series;
    size_t subject_count, figure_count, series_count;
    double began; /* of the figure being measured */
    bool no_memory;
    bool mutant, rejected;
};

/* Frees what the run still owns. */
void suite_run_free(struct check_run *run);
