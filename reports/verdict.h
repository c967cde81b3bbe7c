/* SPDX-License-Identifier: GPL-3.0-or-later
 * The verdict on a report's results: what failed, by how much, and which command reproduces it. It
 * follows from the findings (findings.h); page, summary and JUnit file show it.
 *
 * results.json, a document of command "report" (each entry below is also what its own command
 * writes, see verify/schema; members that do not apply are left out):
 *   mode            "quick" or "nightly"; "code" of other codes (--code)
 *   runs            [run documents, and "label", "reproduce", "profile": {"x", "density",
 *                   "velocity", "pressure", "exact_density", ... at the particles of the window,
 *                   "exact": {"x", "density", "velocity", "pressure"}}, "through_time": {"time",
 *                   "mass", "momentum", "energy"}: what has changed since the start, relative]
 *   studies         [converge documents, and "label", "reproduce"]
 *   verify          verify document
 *   trouble         [{"name", "message"}]: steps without a result: crashed or refused
 *   kernels         [kernel documents, and "reproduce"]
 *   bench           [bench documents, and "reproduce"]
 *   gradients       {"rows": [{flat: operator, ...}], "reproduce"}
 *   faults          what verify/test/faults.py wrote: "date", "git", "faults": [{"fault", "part",
 *                   "exit", "status": "pass", "fail" or "skip", "detail", "message",
 *                   "command"}]
 *   history         see verify/report/history.h: nights, since, trends, changes; a run that
 *                   breaks down but did not the night before is a failure
 *   verdict         what verdict_make returned */
#pragma once

#include <jansson.h>

/* {"status": "pass" or "fail", "headline", "figures_passed", "figures_failed", "mutants",
 * "mutants_detected", "gates_passed", "gates_failed", "gates_smoke" (too coarse to judge),
 * "gates_undetermined" (the order's interval is wider than its gate), "gates_known" (fail as their
 * case says), "gates": their results in words, "runs", "broke_down", "faults",
 * "faults_right", "failures": [{"area", "name", "detail", "command"}]}. New reference, NULL: no
 * memory. */
json_t *verdict_make(const json_t *results);

/* The results with their verdict in a few lines of Markdown, for a pull request or a terminal.
 * Malloced; NULL: no memory. */
char *summary_text(const json_t *results);
