/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gates of a case besides its orders: bounds of an error at any number of particles, gates for
 * schemes that a report compares with the default, and gates for a single run. */
#pragma once

#include <jansson.h>

#include "cases.h"
#include "finding.h"

/* For a gate that passes: PASS, SMOKE or UNDETERMINED. A bound is too coarse (SMOKE) if it was
 * raised for a run no finer than the coarsest level of the case's own ladder, or if it exceeds a
 * quarter of the exact value. An order is UNDETERMINED if its interval is wider than its gate; a
 * bound alone asks for no order. n: particles; gate: from gates_at; exact: the exact value, NaN for
 * a field; fit: NULL for a single run. why: GATE_WHY bytes, "" for PASS. */
enum { GATE_WHY = ORDER_GATE_TEXT };
enum finding_status gates_weigh(const struct case_file *file, const struct order_gate *gate,
                                size_t n, double exact, const struct order_fit *fit, char *why);

/* The factor on a gate's bound for a level of n particles: 1 at the case's own finest level, above
 * it from [finer] (else 1), below it from the least order. */
double gates_raise(const struct case_file *file, const struct case_gate *gate, size_t n);

/* The gate for a finest level of n particles: with its bound raised, or from [finer]. */
struct order_gate gates_at(const struct case_file *file, const struct case_gate *gate, size_t n);

/* True if an error that fails a gate is within the known weakness. raise: the bound's factor, see
 * gates_raise. A NaN is known only if the weakness says that nothing can be measured. */
bool gates_know(const struct case_weakness *known, double raise, double error);

/* Gates for a compared scheme: from [compared], else error bounds three times as wide, because
 * other kernels and gradients have other errors. */
void gates_compare(struct case_file *file);

/* Judges one gate on a run's document ("n", "errors", "functionals"): {"name", "value", "bound",
 * "status": pass, fail, known, smoke, "known": WHY, "why": WHY (smoke)}. A non-finite error fails.
 * New reference; NULL: a functional without an exact value. */
json_t *gates_error(const struct case_file *file, const struct case_gate *gate, const json_t *run);

/* Adds the results of all gates to list. */
void gates_add_errors(const struct case_file *file, const json_t *run, json_t *list);

/* Likewise for what a run in 2D or 3D conserves to round-off: mass, all components of momentum
 * without external forces, and energy where total energy is integrated and there is no gravity. */
void gates_add_conserved(const json_t *run, json_t *list);
