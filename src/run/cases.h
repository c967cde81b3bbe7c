/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cases: what is to be computed, from a built-in text or a file of the user's, both in the same INI
 * format (cases/sod.ini shows it). Every key is checked; a message names file and line. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "field.h"
#include "ini_text.h"
#include "order.h"
#include "settings.h"
#include "status.h"

enum { CASE_LADDER_MAX = ORDER_LEVELS_MAX, CASE_GATES_MAX = FIELDS * NORMS + 16 /* functionals */ };

/* A gate of [converge]: `density_l1 = LOW HIGH BOUND`; where no order can be asked for, and of
 * functionals (`growth_rate = ORDER BOUND`, of |value - exact|; `momentum = ORDER BOUND` and the
 * other figures of "conservation", of the worst run of the finest level), of the finest error
 * alone: ORDER is then what the bound is raised by where a ladder ends before the case's. Errors
 * that hardly scatter may have LEAST:BOUND as their bound: on the case's own ladder, with its own
 * settings, an error below LEAST is too good and shows an unknown change. With `... known: WHY` of
 * a weakness that is shown and fails nothing. The schemes that a report compares with the default
 * have a bound thrice as wide, or their own, in a line of the same name in [compared]: `density_l1
 * = BOUND`. `density_l1 = BOUND known: WHY`: they are known to fail the gate, but their error is a
 * number up to BOUND. `density_l1 = none known: WHY`: there is nothing to be measured (no shock to
 * be found), their error is no number. What [finer] says, `velocity_l1 = LOW HIGH BOUND` or
 * `shock_radius = BOUND`, replaces what [converge] says where there are more particles than the
 * finest level of the case's own ladder has. */
struct case_weakness {
    double bound;  /* of the finest error; INFINITY: any number, NAN: none at all, 0: unsaid */
    char why[160]; /* "" if there is none */
};
struct case_gate {
    const char *functional; /* its name, static, or one of trace_figures; NULL: of a field's norm */
    enum field field;
    enum norm norm;
    struct order_gate gate; /* of the error alone: low = ORDER, high = INFINITY */
    struct case_weakness known, compared;
    double least; /* of the finest error; 0: as little as there may be */
    struct order_gate finer; /* beyond the case's own ladder; bound 0: the same */
};

struct case_file {
    char name[64];   /* "sod", also for .../sod.ini */
    char asked[256]; /* by what name or path case_load found it */
    char title[128];
    int dimension;
    struct settings settings; /* fallbacks and what the file says */
    bool fields[FIELDS];      /* the fields that tables for readers show */
    bool exact[FIELDS]; /* the fields that every scheme computes exactly, so that an error of 0 is
                           expected */
    size_t ladder[CASE_LADDER_MAX], ladder_count;
    /* What a quick report has in place of the ladder (a single n: one run, no study), and what a
     * nightly one has on top of it. */
    size_t quick[CASE_LADDER_MAX], quick_count, night[CASE_LADDER_MAX], night_count;
    struct case_gate gates[CASE_GATES_MAX];
    size_t gate_count;
    bool bench; /* a report measures what an error costs */
};

/* The built-in cases, in the order of a report; ends with a NULL name. */
struct case_builtin {
    const char *name, *text;
};
extern const struct case_builtin case_builtins[];

/* Reads a case: a path where name contains a slash or ends in .ini, else a built-in one, else one
 * in the folder of installed cases. STATUS_BAD_INPUT: no such case, or what is wrong with the file.
 */
enum status case_load(struct case_file *file, const char *name, struct error *error);

/* The same from a text of length bytes; path is used in messages and for the name. */
enum status case_parse(struct case_file *file, const char *path, const char *text, size_t length,
                       struct error *error);

/* Takes a key of [converge] from another file: n in place of the case's, or one gate more. at says
 * where it stands, and fails where the value is wrong. False: there is no such key. */
bool case_amend(struct case_file *file, struct ini_text *at, const char *name, const char *value);
