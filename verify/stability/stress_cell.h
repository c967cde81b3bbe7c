/* SPDX-License-Identifier: GPL-3.0-or-later
 * The groups of the stress test (stress_groups.c lists them) and their cells. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "run.h"

/* A row or column of a group's map: a label and "KEY=VALUE;KEY=VALUE". */
struct stress_entry {
    const char *label, *keys;
    bool nightly; /* not in the quick stress test */
};

enum stress_kind {
    STRESS_RUN,     /* a run against its exact solution: error of density, relative to its mean */
    STRESS_DRIFT,   /* many steps of a still box: drift of energy */
    STRESS_LIMIT,   /* limits of eta: predicted, and found by noise runs */
    STRESS_STEP,    /* largest c dt/dx of an integrator: predicted, and found by noise runs */
    STRESS_PAIRING, /* onset of pairing in 2D and 3D: predicted */
    STRESS_CLOUD,   /* a run in 2D or 3D: survival, fraction of particles in pairs */
    STRESS_LATTICE, /* growth of noise on a lattice in 2D or 3D: predicted, and found by runs */
    STRESS_CLOUD_STEP, /* the same on a lattice in 2D or 3D */
    STRESS_AMPLIFY,    /* growth of round-off: a run, and one with a displaced start */
};

struct stress_group {
    struct member member; /* name, what it does, paper */
    enum stress_kind kind;
    const char *case_name, *keys; /* of all cells; keys of the column and the row follow. case_name
                                     NULL: the label of the column */
    const char *row_title, *column_title; /* of the map */
    const struct family *row_family;      /* the rows are its members, with row_title as the key */
    const struct stress_entry *rows;      /* rows without a family; NULL: stress_schemes */
    const struct stress_entry *columns;   /* ends with a NULL label; NULL: see made */
    const struct stress_entry *(*made)(void); /* makes the columns */
    double bound;      /* of the measured value: above it a cell is inaccurate */
    const char *known; /* STRESS_AMPLIFY: why the default scheme may exceed it; NULL: it may not */
    bool survives;     /* no cell may break down */
};

extern const struct stress_group stress_groups[];
extern const size_t stress_group_count;

/* Schemes that a group without rows of its own compares: the first is the default scheme, the
 * second the seed program's method, corrected. */
extern const struct stress_entry stress_schemes[];

enum { STRESS_ARGUMENTS = 40, STRESS_TEXT = 64, STRESS_COMMAND = 1024 };

struct stress_cell {
    const struct stress_group *group;
    struct stress_entry row; /* keys: NULL for a member of the group's row_family */
    const struct stress_entry *column;
    char arguments[STRESS_ARGUMENTS][STRESS_TEXT]; /* KEY=VALUE */
    size_t argument_count;
    struct run_settings settings;
    uint64_t step_budget;
    size_t job; /* in the pool */
};
