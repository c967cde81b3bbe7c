/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gates of a case beside its orders: the bound of an error at any number of particles, what schemes
 * that a report compares with the default are held to, and what one run alone can be judged by. */
#pragma once

#include <jansson.h>

#include "cases.h"
#include "finding.h"

/* Of a gate that passes: PASS, SMOKE or UNDETERMINED. Too coarse is a bound that was raised for a
 * run no finer than the coarsest level of the case's own ladder, and one that allows more than a
 * quarter of the exact value. n: particles; gate: as gates_at has it; exact: the value, NaN of a
 * field; fit: NULL of one run alone. why: of GATE_WHY bytes, "" for PASS. */
enum { GATE_WHY = ORDER_GATE_TEXT };
enum finding_status gates_weigh(const struct case_file *file, const struct order_gate *gate,
                                size_t n, double exact, const struct order_fit *fit, char *why);

/* What a gate's bound is multiplied by for a level of n particles: at the case's own finest level
 * 1, beyond it what [finer] says (else 1), below it as the least order allows. */
double gates_raise(const struct case_file *file, const struct case_gate *gate, size_t n);

/* The gate for a finest level of n particles: its bound is raised, its order what [finer] says. */
struct order_gate gates_at(const struct case_file *file, const struct case_gate *gate, size_t n);

/* Is an error that fails a gate the weakness that is known? raise: of its bound, see gates_raise.
 * An error that is no number is known only where none can be measured. */
bool gates_know(const struct case_weakness *known, double raise, double error);

/* The gates for a compared scheme: what [compared] says, else bounds of errors thrice as wide, as
 * other kernels and gradients have other errors. */
void gates_compare(struct case_file *file);

/* What one gate says of a run's document ("n", "errors", "functionals"): {"name", "value", "bound",
 * "status": pass, fail, known, smoke, "known": WHY, "why": WHY (smoke)}. An error that is no number
 * fails. New reference; NULL: of a functional without an exact value. */
json_t *gates_error(const struct case_file *file, const struct case_gate *gate, const json_t *run);

/* Adds those of all gates to list. */
void gates_add_errors(const struct case_file *file, const json_t *run, json_t *list);

/* Likewise what a run in 2D or 3D conserves to round-off: mass, momentum in all directions unless
 * something pushes from outside, energy where total energy is integrated and nothing falls. */
void gates_add_conserved(const json_t *run, json_t *list);
