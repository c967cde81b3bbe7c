/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cases: what to compute, from a built-in text or a user's file, both in the same INI format (see
 * cases/sod.ini). Every key is checked; messages name file and line. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "field.h"
#include "ini_text.h"
#include "order.h"
#include "settings.h"
#include "status.h"

enum { CASE_LADDER_MAX = ORDER_LEVELS_MAX, CASE_GATES_MAX = FIELDS * NORMS + 16 /* functionals */ };

/* A gate of [converge]: `density_l1 = LOW HIGH BOUND` bounds the order and the finest error.
 * `growth_rate = ORDER BOUND` bounds the finest error alone, |value - exact|, where there is no
 * order, and for functionals. `momentum = ORDER BOUND`, and any other member of "conservation",
 * bounds the worst run of the finest level. If a ladder ends at a coarser level than the case's own
 * ladder, BOUND is raised in proportion to h^ORDER.
 * Errors that hardly scatter may have LEAST:BOUND in place of BOUND: on the case's own ladder and
 * with the case's own settings, an error below LEAST is too small and indicates an unknown change.
 * `... known: WHY` marks a known weakness, which is reported but does not fail.
 * The schemes that a report compares with the default have a bound three times as wide, or the
 * bound of the line with the same name in [compared]. There `density_l1 = BOUND known: WHY` says
 * that they are known to fail the gate with an error up to BOUND, and `density_l1 = none known:
 * WHY` that the error cannot be measured (for example, no shock is found).
 * `velocity_l1 = LOW HIGH BOUND` or `shock_radius = BOUND` in [finer] replaces the gate of
 * [converge] for more particles than on the finest level of the case's own ladder. */
struct case_weakness {
    double bound;  /* of the finest error; INFINITY: any, NaN: none is measured, 0: not given */
    char why[160]; /* "" if none */
};
struct case_gate {
    const char *functional; /* name, static, or one of trace_figures; NULL: norm of a field */
    enum field field;
    enum norm norm;
    struct order_gate gate; /* of an error alone: low = ORDER, high = INFINITY */
    struct case_weakness known, compared;
    double least;            /* lower bound of the finest error; 0: none */
    struct order_gate finer; /* beyond the case's own ladder; bound 0: the same gate */
};

struct case_file {
    char name[64];   /* "sod", also for .../sod.ini */
    char asked[256]; /* name or path given to case_load */
    char title[INI_TEXT_LINE + 1];
    int dimension;
    struct settings settings; /* defaults overridden by the file */
    bool fields[FIELDS];      /* fields to show in tables */
    bool exact[FIELDS];       /* fields that every scheme computes exactly, so that an error of 0 is
                                 expected */
    size_t ladder[CASE_LADDER_MAX], ladder_count;
    /* Levels of a quick report, in place of the ladder (a single n: one run, no study), and
     * additional levels of a nightly report. */
    size_t quick[CASE_LADDER_MAX], quick_count, night[CASE_LADDER_MAX], night_count;
    struct case_gate gates[CASE_GATES_MAX];
    size_t gate_count;
    bool bench; /* a report measures cost against error */
};

/* The built-in cases in the order of a report; the last entry has a NULL name. */
struct case_builtin {
    const char *name, *text;
};
extern const struct case_builtin case_builtins[];

/* Reads a case. name is a path if it contains a slash or ends in .ini, else a built-in case, else a
 * case in the folder of installed cases. STATUS_BAD_INPUT: no such case, or an error in the
 * file. */
enum status case_load(struct case_file *file, const char *name, struct error *error);

/* Parses a case from length bytes of text; path is used in messages and for the name. */
enum status case_parse(struct case_file *file, const char *path, const char *text, size_t length,
                       struct error *error);

/* Applies a key of [converge] from another file: n replaces the case's, a gate is added. at:
 * position for messages, failed if the value is wrong. Returns false if there is no such key. */
bool case_amend(struct case_file *file, struct ini_text *at, const char *name, const char *value);
